onestay | S_B = W*sqrt(L^2 + c^2 + h^2)/h | stay,two,both,half,factor,twice,other,a-c,of c,in c,by c,at c,on c,for c,with c
planar | S_B = \frac{W\sqrt{L^2 + h^2}}{2h} | geometry,length,of c,in c,by c,at c,on c,for c,with c,direction,distance,component,projection,space
tension | boom = W*L/h | boom,o-a,member,compression,tension+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
reaction | O_x = -W*L/h | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | S_B = \frac{W h}{\sqrt{L^2 + c^2 + h^2}} | component,direction,projection,cos,inver,geometry,length,factor+stay,two,both,half,factor,other
right | 2*h*S_B = W*sqrt(L^2 + c^2 + h^2)
right | boom + O_x = 0
