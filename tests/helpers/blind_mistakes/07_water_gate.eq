triangle_size | N_B h = \rho g b d^2 \left(h - \frac{d}{3}\right) | water,load,distributed,rho,pressure+factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large,triang,1/2,half,uniform,mean
triangle_place | reaction_n(B) = rho*g*b*d^2/2*(h - 2*d/3)/h | water,load,distributed,rho,pressure,resultant+arm,lever,distance,point,place,where it acts,position,moment,third,centroid
arm_from_surface | reaction_n(B)*h = rho*g*b*d^2/2*(2*d/3) | water,load,distributed,rho,pressure,resultant+arm,lever,distance,point,place,where it acts,position,moment
rectangle_place | A_x*h + rho*g*b*d^2/2*d/2 = 0 | water,load,distributed,rho,pressure,resultant+arm,lever,distance,point,place,where it acts,position,moment,centroid,middle,half
wrong_depth | A_x + rho*g*b*h^2/2 = reaction_n(B) | water,load,distributed,rho,pressure,resultant,depth,surface+depth,length,size,height,h instead,for d,h^2,factor,instead of,wrong
right | A_x = -\frac{\rho g b d^3}{6 h}
right | reaction_n(B) - A_x = rho*g*b*d*d/2
