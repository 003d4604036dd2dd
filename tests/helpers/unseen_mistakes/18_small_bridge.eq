symmetry | A_v = \frac{3}{2}P | p1,load,lever,moment,place,distance,arm,factor,symmetr
topsign | top = 5*P*a/(2*h) | top,c-e,member,compress,tension,force+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
loadforgotten | top = -\frac{7Pa}{2h} | p1,load,of c,in c,by c,at c,on c,for c,with c+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
component | bottom = \frac{7P}{4}\cdot\frac{h}{a} | a-d,bottom,joint,component,sin,cos,inver,direction,geometry,slope,lever,axis
two | diagonal = -\frac{7P}{4}\cdot\frac{\sqrt{a^2+h^2}}{h} | p1,load,of c,in c,by c,at c,on c,for c,with c+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | 4*h*diagonal = 3*P*sqrt(a^2 + h^2)
right | top*h + A_v*2*a = P*a
