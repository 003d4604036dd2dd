lever | m l^2 th1'' + m g l sin(th1) + k a (sin(th1) - sin(th2)) cos(th1) = 0 | spring+lever,arm,factor,distance,length
atend | \omega_2 = \sqrt{\frac{g}{l} + \frac{2k}{m}} | spring,of k,in k,by k,at k,on k,for k,with k+lever,arm,place,point,distance,length,factor | kind:frequency
halfmode | frequency(2) = sqrt(g/l + k*a^2/(m*l^2)) | spring,of k,in k,by k,at k,on k,for k,with k,stiffness+factor,half,1/2,twice,double,times,halved,doubled,too large,too small,missing,other end,both
sum | m*l^2*th2'' + m*g*l*sin(th2) + k*a^2*(sin(th1) + sin(th2))*cos(th2) = 0 | spring+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way,sum,difference
two | V = m g l (cos(th1) + cos(th2)) + 1/2 k a (sin(th2) - sin(th1))^2 | weight,gravity,height,bob+sign,opposite,direction,negative+spring+lever,factor,distance,arm
right | V = -m*g*l*(cos(th1) + cos(th2)) + 2*k*a^2*sin((th1 - th2)/2)^2*cos((th1 + th2)/2)^2
right | \frac{d}{dt}(m l^2 th1') = -m g l sin(th1) - k a^2 cos(th1) (sin(th1) - sin(th2))
