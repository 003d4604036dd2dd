radius | r'' - r phi'^2 + g cos(alpha) = 0 | centripetal,centrifugal,normal accel,'^2,square,rate,phi'^2+sin,factor,radius,distance,projection,component
polar | p = m*r^2*phi' | sin,radius,distance,factor,axis
cross | r\ddot\phi + \dot r\dot\phi = 0 | coriolis,product of,mixed,2*,r'*theta',rates,both rates,r'+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
weight | r_ddot = r*phi_dot^2*sin(alpha)^2 - g*sin(alpha) | weight,gravity,gravit,m*g+sin,cos,axis,component,angle,swapped,projection,direction
two | T = \frac12 m\left(\dot r^2\sin^2\alpha + r^2\dot\phi^2\right) | sin,height,vertical,r',radial,cos+radius,distance,sin,phi',factor
right | r'' = p^2/(m^2*r^3*sin(alpha)^2) - g*cos(alpha)
right | \frac12 m(\dot r^2 + r^2\sin^2\alpha\,\dot\phi^2) + mgr\cos\alpha = C
