spin | [m (R-r)^2 + m R^2/2] theta'' + m g (R-r) sin(theta) = 0 | roll,rotation,spin,turning,angular,contact,omega+radius,radii,(r - r),r - r,slip,rolling,too large,factor,velocity,moment of inertia
norot | (R - r)*theta'' + g*sin(theta) = 0 | rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,factor
path | \frac{3}{2} R \ddot\theta + g\sin\theta = 0 | radius,radii,length,r - r,distance,lever,arm,centre
static | reaction_n(pipe) = m*g*cos(theta) | centripetal,centrifugal,normal accel,'^2,square,rate,acceleration+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
two | T = \frac{1}{2} m R^2\dot\theta^2 + \frac{1}{2} m r^2 \left(\frac{R-r}{r}\right)^2 \dot\theta^2 | transl,centre,velocity,path,distance,radius,motion+rotation,inertia,1/2,factor,ring,disc
right | 3 (R - r) theta'' = -2 g sin(theta)
right | reaction_t(pipe) = -m*(R - r)*theta''/2
