centre | theta'' = 6*g/l*sin(theta) | steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
energy | \dot\theta^2 = \frac{6g}{l}(\cos\theta_0 - \cos\theta) | weight,gravity,height,centre,half,factor,twice,1/2,kinetic
nocentripetal | along = m*g*cos(theta) | centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
axial | across = m g \sin\theta | theta'',acceleration,tangential,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
two | along = m g\sin\theta + m\frac{l}{2}\dot\theta^2 | weight,gravity+sin,cos,component,axis,swapped+centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | \dot\theta = \sqrt{\frac{3g}{l}(\cos\theta_0 - \cos\theta)}
right | along = m*g/2*(5*cos(theta) - 3*cos(theta_0))
