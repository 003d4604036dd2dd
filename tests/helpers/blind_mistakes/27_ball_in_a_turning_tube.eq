relative_only | m*r'' + k*(r - l0) + m*g*sin(w*t) = 0 | centrifugal,centripetal,w^2,phi'^2,transport,dT/dr+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,relative
coriolis_along | m*r'' - m*r*w^2 + 2*m*w*r' + k*(r - l0) + m*g*sin(w*t) = 0 | coriolis,r'*w,w*r',2*m*w+extra,across,along,perpendicular,not belong,not act,too much,no part,does not,normal,direction,axis,should not
spring_from_zero | m*r'' - m*r*w^2 + k*r + m*g*sin(w*t) = 0 | l0,spring,rest,stretch,natural,length+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,rest,natural,stretch,unstretched
weight_component | m \ddot r - m r w^2 + k (r - l_0) + m g \cos(w t) = 0 | weight,gravity,m*g,g*+sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along
two_centrifugal_weight | m \ddot r + m r w^2 + k (r - l_0) = 0 | centrifugal,centripetal,w^2,phi'^2+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against,inward+weight,gravity,m*g
right | reaction_n(ball) = m*(2*w*r' + g*cos(w*t))
right | r'' = (w^2 - k/m)*r + k*l0/m - g*sin(w*t)
