vertical_roller | N_B = q*L/2 + F/3 | N_B,reaction of B,reaction at B,roller,support B,normal+direction,vertical,cos,projection,inclin,angle,beta,component
lever_of_load | N_B = (q*L + F)/(3*cos(beta)) | distributed,q*L,line load,floor_load,uniform+lever,arm,resultant,factor,L/3,centre,center,middle,point,place,times too,too large,too small,too much,too little,moment arm,distance
lever_from_wrong_end | A_y = q*L/2 + F/3 | load,force at C,force F,F*+lever,arm,distance,other end,factor,L/3,wrong point,2/3,times too,too large,too small,too much,too little,moment arm
sin_for_cos | N_B*L*sin(beta) - q*L^2/2 - F*L/3 = 0 | N_B,reaction of B,reaction at B,roller,support B,normal+sin,cos,component,swap,lever,projection,moment arm,distance
no_horizontal | A_x = 0 | A_x,horizontal,N_B,reaction of B,roller,hinge A,reaction at A+missing,forgot,left out,horizontal,component,no part,lacks,omitted,without,absent,not contain,not counted,lost,dropped,overlooked
right | reaction_n(B)*L*cos(beta) - q*L^2/2 - F*L/3 = 0
right | A_x = (3*q*L + 2*F)*tan(beta)/6
