half | m x'' - m w y' - m w^2 x + c x' + k x = 0 | coriolis,product of,mixed,2*,r'*theta',rates,both rates,y',of w,in w,by w,at w,on w,for w,with w+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
corsign | m\ddot y - 2mw\dot x - mw^2y + c\dot y + ky = 0 | coriolis,product of,mixed,2*,r'*theta',rates,both rates,x'+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
inertial | m*x'' + c*x' + k*x = 0 | coriolis,product of,mixed,2*,r'*theta',rates,both rates,turning,relative,rotating,centrifugal,of w,in w,by w,at w,on w,for w,with w+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
centrifugal | m\ddot x = 2mw\dot y - mw^2 x - c\dot x - kx | centripetal,centrifugal,normal accel,'^2,square,rate,w^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | T = \frac{m}{2}(\dot x^2 + \dot y^2) + \frac{m}{2}w(x^2 + y^2) | coriolis,mixed,product,coupl,cross,relative,x*y',moment,y'+square,of w,in w,by w,at w,on w,for w,with w,factor,dimension,centrifugal,turning
right | T = \frac{m}{2}\left[(\dot x - w y)^2 + (\dot y + w x)^2\right]
right | y'' + c/m*y' + (k/m - w^2)*y + 2*w*x' = 0
