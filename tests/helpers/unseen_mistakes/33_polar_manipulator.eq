coriolis | (m1 lc^2 + I1 + I2 + m2 d^2) theta'' + m2 d d' theta' + (m1 lc + m2 d) g cos(theta) = tau | coriolis,product of,mixed,2*,r'*theta',rates,d'+factor,half,1/2,twice,double,times,halved,too large,too small
nocentri | m_2\ddot d + m_2 g\sin\theta = f | centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected
trig | (m1*lc^2 + I1 + I2 + m2*d^2)*theta'' = tau - 2*m2*d*d'*theta' - (m1*lc + m2*d)*g*sin(theta) | weight,gravity,gravit,m*g+sin,cos,axis,component,angle,swapped,projection,direction
noinertia | \left(m_1 l_c^2 + I_1 + m_2 d^2\right)\ddot\theta + 2m_2 d\dot d\dot\theta + (m_1 l_c + m_2 d)g\cos\theta = \tau | link2,i2,i_2,second+rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected
two | m_2\ddot{d} + m_2 d\,\dot\theta^2 + m_2 g\cos\theta = f | centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2+sign,opposite,direction,reversed,other way,negative,turned round+weight,gravity,gravit,m*g+sin,cos,axis,component,angle,swapped,projection,direction
right | \frac{d}{dt}\left[(I_1 + I_2 + m_1 l_c^2 + m_2 d^2)\dot\theta\right] = \tau - (m_1 l_c + m_2 d) g\cos\theta
right | d'' = d*theta'^2 - g*sin(theta) + f/m2
