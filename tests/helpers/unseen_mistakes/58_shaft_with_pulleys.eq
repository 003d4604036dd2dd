inverse | pull_size = W*r2/r1 | lever,arm,radius,radii,inver,ratio,swapped,factor
sign | A_y = \frac{W r_1}{3 r_2} | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
position | A_z = W/3 | lever,arm,place,distance,factor,swapped,of b,in b,by b,at b,on b,for b,with b,moment,other
sum | B = 4*W*r1/(3*r2) + W/3 | square,root,vector,component,sum,added,size,magnitude
two | B_y = -\frac{4 W r_2}{3 r_1} | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+lever,arm,radius,radii,inver,ratio,swapped,factor,r1,moment
right | B_y + A_y = \frac{W r_1}{r_2}
right | B = \frac{W}{3}\sqrt{1 + 16\frac{r_1^2}{r_2^2}}
