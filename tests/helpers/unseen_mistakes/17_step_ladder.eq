symmetric | N_B = m g + P/2 | person,load,of p,in p,by p,at p,on p,for p,with p+lever,arm,distance,length,geometry,where it acts,place,point,moment,factor,symmetr,half
ropelever | T = \frac{3 b (P + 2 m g)}{4 h} | rope,tension+lever,arm,distance,height,geometry,factor,place,moment,hinge
noweight | T*2*h/3 = (P/4 + m*g)*b | weight,gravity,right leg,right+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,sign
hingesign | C_y = P/4 | hinge,pin,of c,in c,by c,at c,on c,for c,with c,reaction,force,other body,action+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | T = \frac{3 b}{2h}\left(\frac{3P}{4} + m g\right) | person,load,of p,in p,by p,at p,on p,for p,with p+missing,left out,forgotten,own,lever,factor+weight,gravity+missing,left out,forgotten,lever,factor
right | 8*h*T = 3*b*(2*m*g + P)
right | N_A - N_B = \frac{P}{2}
