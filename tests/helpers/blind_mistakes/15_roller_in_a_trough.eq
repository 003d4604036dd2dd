spin | T = m (R - r)^2 \frac{\dot\theta^2}{2} + \frac{m R^2 \dot\theta^2}{4} | roller,rotation,spin,angular,omega,rolling+radius,relative,frame,R - r,velocity,factor
no_spin_energy | reaction_n(trough) = m*g*(3 - 2*cos(theta0)) | rotation,spin,inertia,roller,energy,rolling,friction,speed,velocity,theta'^2+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,slide,particle,point,factor,instead,wrong,factor,replaced | at:theta=0 | from_rest:theta=theta0
two_ring_sign | 2 (R - r) \ddot\theta - g \sin\theta = 0 | gravity,weight,sin(theta)+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against+rotation,inertia,roller,ring,hoop,factor,cylinder,disc
radius_of_path | frequency(1) = sqrt(2*g/(3*R)) | radius,length,R - r,distance,path,factor
centripetal | N_trough = m*g*cos(theta) | centripetal,theta'^2,normal acceleration,inertia,centrifugal,velocity+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
right | reaction_n(trough) = m*g*(7 - 4*cos(theta0))/3 | - | at:theta=0 | from_rest:theta=theta0
right | 3*(R - r)*theta'^2 = 4*g*(cos(theta) - cos(theta0))
