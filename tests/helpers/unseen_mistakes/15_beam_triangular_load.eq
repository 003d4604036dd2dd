centroid | B_y = q*a/2 + 4*P/3 + M0/(3*a) | load,distributed,line load,triang,of q,in q,by q,at q,on q,for q,with q+centroid,lever,third,place,arm,where it acts,centre,resultant,point
rectangle | A_y = 3*q*a/2 - P/3 - M0/(3*a) | load,distributed,of q,in q,by q,at q,on q,for q,with q+factor,half,1/2,twice,double,times,halved,doubled,too large,too small,triang,area,rectang,resultant
couple | B_y = q a + \frac{4P}{3} | couple,moment,m0+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
lever | 3*a*B_y = 3*q*a^2 + P*a + M0 | tip,of p,in p,by p,at p,on p,for p,with p+lever,arm,distance,place,point
two | A_y = \frac{qa}{2} - \frac{4P}{3} + \frac{M_0}{3a} | couple,moment,m0+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+tip,of p,in p,by p,at p,on p,for p,with p+lever,arm,distance,length,geometry,where it acts,place,point,moment,factor
right | 3*a*B_y = 3*q*a^2 + 4*P*a + M0
right | A_y + B_y = P + \frac{3qa}{2}
