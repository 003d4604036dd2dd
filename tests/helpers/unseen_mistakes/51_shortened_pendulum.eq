coriolis | l theta'' - u theta' + g sin(theta) = 0 | coriolis,product of,mixed,2*,r'*theta',rates,both rates,l',of u,in u,by u,at u,on u,for u,with u+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
fixedlength | l*theta'' = -g*sin(theta) | coriolis,product of,mixed,2*,r'*theta',rates,both rates,l',of u,in u,by u,at u,on u,for u,with u,length,variable,changes+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
coriolissign | \ddot\theta = -\frac{2u\dot\theta + g\sin\theta}{l} | coriolis,product of,mixed,2*,r'*theta',rates,both rates,l',of u,in u,by u,at u,on u,for u,with u+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
tension | S = m*g*cos(theta) | centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
two | S = m g\sin\theta - m l\dot\theta^2 | weight,gravity,gravit,m*g+sin,cos,component,axis,swapped,projection+centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | \frac{d}{dt}\left(m l^2\dot\theta\right) = -m g l\sin\theta
right | S = m*(g*cos(theta) + l*theta'^2)
