coriolis | (J + 2 m r^2) theta'' + 2 m r u theta' = 0 | coriolis,product of,mixed,2*,r'*theta',rates,both rates,of u,in u,by u,at u,on u,for u,with u+factor,half,1/2,twice,double,times,halved,doubled,too large,too small,tip
fixed | \left(J + 2mr^2\right)\ddot\theta = 0 | coriolis,product of,mixed,2*,r'*theta',rates,both rates,of u,in u,by u,at u,on u,for u,with u,variable,changes+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
onetip | H = (J + m*r^2)*theta' | tip,m*r^2,mass+factor,half,1/2,twice,double,times,halved,doubled,too large,too small,missing,other
energy | (J + 2 m r^2)\,\dot\theta^2 = C | energy,momentum,conserv,work,integral,constant,not constant,drive,square,rate
two | side = m\left(r\ddot\theta - u\dot\theta\right) | coriolis,product of,mixed,2*,r'*theta',rates,both rates,of u,in u,by u,at u,on u,for u,with u+sign,opposite+factor,half,of 2,in 2,by 2,at 2,on 2,for 2,with 2,twice
right | (J + 2 m r^2)\dot\theta = (J + 2 m r_0^2)\cdot 2
right | side = m*(r*theta'' + 2*r'*theta')
