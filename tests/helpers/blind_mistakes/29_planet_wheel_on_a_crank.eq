relative_spin | T = (m1/6 + m2/2)*(R + r)^2*phi'^2 + m2*R^2*phi'^2/4 | planet,omega,spin,rotation,angular+relative,absolute,crank,factor,radius,path
no_rotation | \left(\frac{m_1}{3} + m_2\right) (R + r)^2 \ddot\phi = M_0 | planet,rotation,spin,disc,friction,mesh+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,particle,point
law_half | phi = M0*t^2/((R + r)^2*(m1/3 + 3*m2/2)) | 1/2,half,factor 2,twice,factor,double
omega | omega(planet) = R*phi'/r | crank,relative,absolute,phi',transport,factor,radius,missing
two_length_rod | R^2*(m1/12 + 3*m2/2)*phi'' = M0 | length,radius,crank,factor,R instead,R^2+m1,rod,crank,inertia,1/12,parallel,steiner
right | phi'^2 = 12*M0*phi/((R + r)^2*(2*m1 + 9*m2))
right | reaction_t(mesh) = m2*(R + r)*phi''/2
