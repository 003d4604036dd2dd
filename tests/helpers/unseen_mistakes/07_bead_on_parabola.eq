dTdq | (1 + 4 a^2 rho^2) rho'' + 8 a^2 rho rho'^2 + (2 g a - w^2) rho = 0 | rho'^2,square,dt/dq,dt/d,derivative,term with+twice,factor,double,missing,half,dt/dq,dt/d,sign
centrifugal | (1 + 4a^2\rho^2)\ddot\rho + 4a^2\rho\dot\rho^2 + (2ga + w^2)\rho = 0 | centrifugal,centripetal,w^2,turning,psi',rate,driven+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
flat | \ddot\rho + (2 g a - w^2)\rho = 0 | vertical,of z,in z,by z,at z,on z,for z,with z,height,slope,rise,4*a^2,up and down,kinetic+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,velocity
slope | (1 + 4*a^2*rho^2)*rho'' = w^2*rho - g*a*rho - 4*a^2*rho*rho'^2 | weight,gravity,gravit,m*g+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
two | (1 + 4 a^2 rho^2) rho'' - 4 a^2 rho rho'^2 + 2 g a rho = 0 | sign,opposite,wrong sign,twice,factor+centrifugal,w^2,turning,psi',driven,rate of
right | (1 + 4*a^2*rho^2)*rho'^2 + (2*g*a - w^2)*rho^2 = C
right | \ddot\rho = \frac{\rho\,(w^2 - 2ga - 4a^2\dot\rho^2)}{1 + (2a\rho)^2}
