noroll | (R + r) theta'' = g sin(theta) | rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,factor
spin | \left[m(R+r)^2 + \frac12 mR^2\right]\ddot\theta = m g (R+r)\sin\theta | roll,rotation,spin,angular,turn,inertia+radius,relative,rolling,contact,factor,(r,velocity,of r,in r,by r,at r,on r,for r,with r+of r,in r,by r,at r,on r,for r,with r,arm
radius | N = m*g*cos(theta) - m*R*theta'^2 | radius,of r,in r,by r,at r,on r,for r,with r+of r,in r,by r,at r,on r,for r,with r,distance,centre,path,factor,centripetal
energy | \dot\theta^2 = \frac{2g(\cos\theta_0 - \cos\theta)}{R + r} | rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,factor
two | N = m g\sin\theta + m(R + r)\dot\theta^2 | weight,gravity+sin,cos,component,axis,swapped+centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | N = \frac{m g}{3}(7\cos\theta - 4\cos\theta_0)
right | 3*(R + r)*theta'^2 = 4*g*(cos(theta_0) - cos(theta))
