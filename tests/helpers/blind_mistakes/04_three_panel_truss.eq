sense | tension(truss, A-E) = (2*P + Q)/3*sqrt(a^2 + h^2)/h | A-E,A_E,AE,member,tension+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against,compress,tension
slope | tension(truss, E-C) = (Q - P)/3*sqrt(a^2 + h^2)/a | E-C,EC,diagonal,member+sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along,slope,length,instead,factor
section_load | tension(truss, E-F)*h + reaction_y(A)*2*a = 0 | P,load,force+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
arm_from_other_end | reaction_y(D)*3*a = P*a + Q*a | Q,load+arm,lever,distance,point,place,where it acts,position,moment,factor,half,halved,1/2,times 0.5,too little,too small
diagonal_forgotten | tension(truss, C-F) = Q | E-C,EC,diagonal,member,tension+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
right | tension(truss, B-C)*h = reaction_y(A)*a
right | reaction_y(A) - P = tension(truss, E-C)*h/sqrt(a^2 + h^2)
