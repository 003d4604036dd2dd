linear | (J1 + (J2 + m*rho^2)/n)*phi'' = tau - m*g*rho/n | drum,load,ratio,of n,in n,by n,at n,on n,for n,with n+square,ratio,factor,gear
unreduced | \left(J_1 + J_2 + \frac{m\rho^2}{n^2}\right)\ddot\phi = \tau - \frac{m g\rho}{n} | drum+ratio,gear,square,factor,of n,in n,by n,at n,on n,for n,with n,reduc,rotation
inverse | (J1 + (J2 + m rho^2) n^2) phi'' = tau - m g rho n | ratio,of n,in n,by n,at n,on n,for n,with n,gear,inver,factor
tension | tension(rope) = m*(g - rho/n*phi'') | acceleration,inertia,phi'',load,translation+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | (J_1 + \frac{J_2}{n^2})\ddot\phi = \tau - m g\rho | load+translation,inertia,mass,missing,left out+weight,gravity+ratio,factor,of n,in n,by n,at n,on n,for n,with n,lever,gear
right | (J_1 n^2 + J_2 + m\rho^2)\ddot\phi = n(n\tau - mg\rho)
right | T = phi_dot^2*(n^2*J1 + J2 + m*rho^2)/(2*n^2)
