centroid | P = \frac{\gamma b d^3}{4 h} | water,load,distributed+centroid,lever,arm,third,place,centre,resultant,factor,where it acts
fromtop | P h = gamma*b*d^2/2 * 2*d/3 | water,load,distributed+lever,arm,distance,length,geometry,where it acts,place,point,moment,factor,centroid,third,twice
rectangle | P = gamma*b*d^3/(3*h) | water,load,distributed+factor,twice,triang,half,area,double,rectang,resultant
hinge | A_x = -\frac{\gamma b d^2}{2} - \frac{\gamma b d^3}{6h} | strut,of p,in p,by p,at p,on p,for p,with p+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | A_x = \gamma b d^2 + P | water,load,distributed+factor,twice,half,triang,double+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | A_x + \frac{\gamma b d^2}{2} = P
right | P = 15.36 kN
