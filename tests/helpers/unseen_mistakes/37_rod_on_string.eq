norotation | a theta'' + b phi'' cos(theta - phi) - b phi'^2 sin(phi - theta) + g sin(theta) = 0 | rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,factor
steinertwice | \frac{7}{3} m a^2\ddot\theta + m a b\ddot\phi\cos(\phi-\theta) - m a b\dot\phi^2\sin(\phi-\theta) + m g a\sin\theta = 0 | bar,rod+steiner,twice,factor,moment of inertia,about the end,translation,inertia,double
sign | m*b*phi'' + m*a*theta''*cos(phi - theta) - m*a*theta'^2*sin(phi - theta) + m*g*sin(phi) = 0 | theta'^2,centripetal,centrifugal+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
uncoupled | b\ddot\phi + g\sin\phi = 0 | bar,theta'',coupl,rotation,product,turn+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
two | T = \frac12 m\left(b^2\dot\phi^2 + a^2\dot\theta^2 + 2ab\dot\phi\dot\theta\right) + \frac{1}{3}m a^2\dot\theta^2 | cos,angle,coupl,mixed,product+rotation,inertia,own,factor,1/3,1/6,centre
right | b\ddot\phi + a\ddot\theta\cos(\theta-\phi) = a\dot\theta^2\sin(\theta-\phi) - g\sin\phi
right | T = 1/2*m*b^2*phi'^2 + 2/3*m*a^2*theta'^2 + m*a*b*phi'*theta'*(cos(phi)*cos(theta) + sin(phi)*sin(theta))
