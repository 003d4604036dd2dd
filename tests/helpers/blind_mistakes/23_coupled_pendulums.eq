spring_once | frequency(2) = sqrt(g/l + k*a^2/(m*l^2)) | spring,k*+factor,half,halved,1/2,times 0.5,too little,too small,factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large
spring_place | m l \ddot\theta_1 + m g \sin\theta_1 + k l (\sin\theta_1 - \sin\theta_2) \cos\theta_1 = 0 | spring,k*+arm,lever,distance,point,place,where it acts,position,moment,a instead,l instead,instead,wrong,factor,replaced
other_end_fixed | m*l^2*theta1'' + m*g*l*sin(theta1) + k*a^2*sin(theta1)*cos(theta1) = 0 | spring,theta2,k*+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,relative,fixed,other end,wall
potential_sign | V = m g l \cos\theta_1 + m g l \cos\theta_2 + k a^2 \frac{(\sin\theta_2 - \sin\theta_1)^2}{2} | weight,gravity,m*g,g*l+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against
hertz | frequency(1) = sqrt(g/l)/(2*pi) | 2*pi,2 pi,hz,hertz,rad/s,turns,cycle,unit,angular
right | frequency(2) = sqrt((m*g*l + 2*k*a^2)/(m*l^2))
right | m l^2 \ddot\theta_2 + m g l \sin\theta_2 = -k a^2 (\sin\theta_2 - \sin\theta_1)\cos\theta_2
