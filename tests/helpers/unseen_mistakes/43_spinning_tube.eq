radius | m s'' = m w^2 s - m g cos(beta) - c s' | centrifugal,centripetal,w^2,turning+radius,sin,distance,component,factor,axis,projection
component | \ddot{s} = w^2 s\sin\beta - g\cos\beta - \frac{c}{m}\dot s | centrifugal,centripetal,w^2,turning+sin,component,projection,factor,radius,distance
coriolis | N_side = m*w*s'*sin(beta) | coriolis,2*+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
trig | m*s'' + c*s' + m*g*sin(beta) - m*w^2*s*sin(beta)^2 = 0 | weight,gravity,gravit,m*g+sin,cos,axis,component,angle,swapped,projection,direction
two | m\ddot s + c\dot s + m g\cos\beta + m w^2 s\sin\beta = 0 | centrifugal,centripetal,w^2,turning+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+sin,component,projection,factor,radius,distance
right | \ddot s + \frac{c}{m}\dot s - \frac{w^2}{2}(1 - \cos 2\beta)\, s + g\cos\beta = 0
right | N_side = 2*m*w*s'*sin(beta)
