absoluteroll | 3*m/2*(x'' + s'') + k*s = 0 | rotation,roll,turn,spin,inertia+cart,relative,absolute,x'',of x,in x,by x,at x,on x,for x,with x,too much
relative | \frac{3}{2}m\ddot{s} + ks = 0 | cart,relative,x'',coupl,translation,support+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
springonce | (M + m)*x'' + m*s'' + k*s = F | spring,stiffness,stretch,elastic,restoring,of k,in k,by k,at k,on k,for k,with k+internal,both,cart,too much,reaction,left in,counted,twice,no place,does not,sign,extra
fixedcart | frequency(2) = sqrt(2*k/(3*m)) | cart,of m,in m,by m,at m,on m,for m,with m,coupl,moves,support,free,mass | kind:frequency
two | T = \frac12 M\dot x^2 + \frac12 m\dot s^2 + \frac12 m\dot s^2 | cart,relative,absolute,x',translation,coupl+rotation,inertia,factor,ring,half,1/2,1/4
right | \omega_2 = \sqrt{\frac{2k(M + m)}{m(3M + m)}} | - | kind:frequency
right | M*x'' - m*s''/2 - k*s = F
