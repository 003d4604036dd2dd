cordspeed | (3*m/2 + M)*x'' = (M - m*sin(alpha))*g | load+velocity,factor,twice,2*,half,geometry,double,of x,in x,by x,at x,on x,for x,with x
cosine | \left(\frac32 m + 4M\right)\frac{d^2x}{dt^2} = 2Mg - mg\cos\alpha | drum+sin,cos,component,axis,swapped,angle,projection
halfway | (3/2 m + 2 M) x'' = 2 M g - m g sin(alpha) | load+square,factor,of 2,in 2,by 2,at 2,on 2,for 2,with 2,velocity,half,translation
tension | S = M (g - x'') | acceleration,x'',velocity,load,translation+factor,half,1/2,twice,double,times,halved,doubled,too large,too small,of 2,in 2,by 2,at 2,on 2,for 2,with 2
two | \left(m + 4M\right)\ddot x = 2Mg - mg | drum+rotation,rotat,turning,spin,inertia+weight,gravity,component,sin
right | x'' = 2*g*(2*M - m*sin(alpha))/(3*m + 8*M)
right | S\,(3m + 8M) = M m g\,(3 + 4\sin\alpha)
