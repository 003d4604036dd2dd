wind_moment | N_C = P/2 | wind,H*,force H,horizontal force+missing,forgot,left out,omitted,lacks,no part,moment,ignored,without,absent,not contain,not counted,lost,dropped,overlooked
two_wind_and_lever | tension(T, D-E) = -P*a/(2*h) | wind,H*,force H,horizontal force,N_C,reaction of C,D-E,lever,moment arm,distance+missing,forgot,left out,omitted,lacks,no part,lever,arm,factor,half,without,absent,not contain,not counted,lost,dropped,overlooked,times too,too large,too small,too much,too little,moment arm,distance
cos_for_sin | tension(T, C-E) = -(P/2 + H*h/(4*a))*l/a | C-E,diagonal,member+sin,cos,component,angle,projection,swap,direction
by_symmetry | tension(T, B-D) = P*l/(2*h) | wind,H*,force H,horizontal force,symmetry,symmetric+missing,forgot,left out,omitted,lacks,no part,symmetr,ignored,without,absent,not contain,not counted,lost,dropped,overlooked
direction_of_reaction | A_x = H | A_x,reaction of A,reaction at A,hinge,pin,wind,horizontal,force H+sign,against,along with,direction,opposite,wrong way,reversed,other way,minus,wrong sense
right | tension(T, D-E)*h + 2*a*N_C = 0
right | tension(T, B-C) = (2*P*a + H*h)/(4*h)
