noload | (J + u*e^2)*theta'' = m*g*rho - u*g*e*sin(theta) - c*theta' | load+inertia,translation,mass,missing,m*rho,acceleration
trig | \left(J + m\rho^2 + ue^2\right)\ddot\theta + c\dot\theta = mg\rho - uge\cos\theta | spot,weight,gravity+sin,cos,axis,component,angle,swapped,projection,direction
rest | \sin\theta = \frac{m e}{u\rho} | lever,arm,radius,inver,distance,swapped,factor,rho,ratio | kind:equilibrium
tension | tension(rope) = m*(g + rho*theta'') | acceleration,inertia,theta'',load,translation+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | (J + m \rho^2 + u e) θ̈ = m g \rho + u g e \sin\theta - c θ̇ | spot+square,inertia,dimension,translation,factor,of e,in e,by e,at e,on e,for e,with e+weight,gravity+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | u e \sin\theta = m\rho | - | kind:equilibrium
right | Q(theta) = m*g*rho - c*theta' - u*g*e*sin(theta)
