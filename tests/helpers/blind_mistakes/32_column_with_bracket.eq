wind_lever | M_A = w*h^2 + F*(1 - c/b)*d | wind,distributed,line load+lever,arm,half,factor,h/2,resultant,middle,top,times too,too large,too small,too much,too little,moment arm,distance
bracket_forgotten | M_A = w*h^2/2 | hinge,pin,load,F*,bracket,force at B+missing,forgot,left out,lever,omitted,lacks,no part,moment,without,absent,not contain,not counted,lost,dropped,overlooked,moment arm,distance
moment_sign | M_A = w*h^2/2 - F*(1 - c/b)*d | hinge,pin,load,F*,bracket,force at B+sign,direction,sense,opposite,wrong way,reversed,other way,minus,wrong sense
roller_forgotten | reaction_couple(A) = w*h^2/2 + F*(d + c) | N_C,support C,roller,reaction of C,reaction at C,normal+missing,forgot,left out,omitted,lacks,no part,ignored,without,absent,not contain,not counted,lost,dropped,overlooked
two_lever_and_sign | M_A = w*h^2 - F*(1 - c/b)*d | wind,distributed,hinge,load,bracket+lever,arm,half,factor,sign,direction,sense,opposite,wrong way,reversed,other way,minus,wrong sense,times too,too large,too small,too much,too little,moment arm,distance
right | M_A - w*h^2/2 + N_C*(d + b) - F*(d + c) = 0
right | A_y = F \frac{b - c}{b}
