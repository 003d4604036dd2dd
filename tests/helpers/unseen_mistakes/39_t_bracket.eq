steiner | J_O = m1*a^2/3 + m2*b^2/3 + m3*r^2/2 | disc+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
crossend | J_O = \frac{4}{3}m_1 a^2 + \frac{1}{3} m_2 b^2 + m_3\left(\frac{r^2}{2} + b^2\right) | crossbar,rod,bar+about the end,end,centre,length,factor,steiner,half
diametral | J_x = \frac{1}{3} m_2 b^2 + m_3\left(\frac{1}{2}r^2 + b^2\right) | disc+axis,diameter,factor,polar,half,1/4
centre | J_O = m1*a^2/3 + m2*b^2/12 + m3*(r^2/2 + b^2) | upright,rod,bar+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
two | J_y = \frac{m_1 a^2}{12} + \frac{1}{2}m_3 r^2 | crossbar,rod,bar+length,factor,2*a,half,inertia+disc+axis,diameter,factor,polar,1/4,half
right | J_O = J_x + J_y
right | 12*J_y = 4*m1*a^2 + 3*m3*r^2
