ridersign | (M a^2 + M rho^2/2 + m b^2) theta'' + (M a + m b) g sin(theta) + k theta = 0 | rider+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
bobpoint | \ddot\theta = \frac{(mb - Ma)g\sin\theta - k\theta}{Ma^2 + mb^2} | bob,disc+rotation,rotat,turning,spin,inertia
nospring | frequency(1) = sqrt((M*a - m*b)*g/(M*a^2 + M*rho^2/2 + m*b^2)) | spring,stiffness,elastic,torsion,needle,coil,of k,in k,by k,at k,on k,for k,with k+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored | kind:frequency
height | V = (M a - m b) g cos(theta) + k theta^2/2 | weight,gravity,height+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | (Ma^2 + M\rho^2 + mb^2)\ddot\theta + (Ma - mb)g\theta + k\theta = 0 | bob,disc+inertia,rotation,factor,ring,half,1/2+small,linear,sin
right | theta_ddot*(2*M*a^2 + M*rho^2 + 2*m*b^2) = 2*(m*b - M*a)*g*sin(theta) - 2*k*theta
right | frequency(1)^2 \left(Ma^2 + \frac{M\rho^2}{2} + mb^2\right) = (Ma - mb)g + k | - | kind:frequency
