product | m*(r*phi'' + r'*phi') = F | coriolis,product of,mixed,2*,r'*theta',rates,both rates,r'+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
sign | \ddot r + r\dot\phi^2 + \frac{\mu}{r^2} = 0 | centripetal,centrifugal,normal accel,'^2,square,rate,phi'^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
power | r'' - r*phi'^2 + mu/r = 0 | attraction,gravity,gravit,potential,mu+factor,of r,in r,by r,at r,on r,for r,with r,square,power,derivative,distance
lever | Q(phi) = F | thrust,of f,in f,by f,at f,on f,for f,with f+lever,arm,radius,distance,factor,of r,in r,by r,at r,on r,for r,with r,moment
two | \frac{d}{dt}(r\dot\phi) = \frac{F r}{m} | coriolis,product of,mixed,2*,r'*theta',rates,both rates,r',radius,momentum,derivative,product+thrust,of f,in f,by f,at f,on f,for f,with f+factor,lever,arm,radius,of r,in r,by r,at r,on r,for r,with r
right | \frac{d}{dt}(m r^2\dot\phi) = F r
right | m*r'*r'' + m*r^2*phi'*phi'' + m*r*r'*phi'^2 + mu*m*r'/r^2 = F*r*phi'
