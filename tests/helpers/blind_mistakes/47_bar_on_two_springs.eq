no_tilt_in_springs | m \ddot{y} + (k_1 + k_2) y + m g = 0 | phi,tilt,turn,rotat,spring,coupling,angle+missing,forgot,left out,omitted,lacks,no part,neglect,ignored,without,absent,not contain,not counted,lost,dropped,overlooked
moment_sign | J*phi'' + k1*a*cos(phi)*(y - a*sin(phi)) + k2*b*cos(phi)*(y + b*sin(phi)) = 0 | left,k1,spring,moment+sign,direction,opposite,wrong way,reversed,other way,minus,wrong sense
even_sinking | y = -m*g/(k1 + k2) | phi,tilt,turn,rotat,spring,coupling,moment,angle,lever,moment arm,distance+missing,forgot,left out,omitted,lacks,no part,neglect,ignored,level,horizontal,without,absent,not contain,not counted,lost,dropped,overlooked | kind:equilibrium
levers_lost | J*phi'' - k1*cos(phi)*(y - a*sin(phi)) + k2*cos(phi)*(y + b*sin(phi)) = 0 | spring,k1,k2,left,right,moment+lever,arm,distance,dimension,unit,factor,times too,too large,too small,too much,too little,moment arm
ends_swapped | V = k1*(y + a*sin(phi))^2/2 + k2*(y - b*sin(phi))^2/2 + m*g*y | spring,k1,k2,left,right,phi,stretch,elongation+sign,direction,opposite,swap,wrong way,reversed,other way,minus,wrong sense
right | m \ddot{y} + (k_1 + k_2) y + (k_2 b - k_1 a) \sin\phi + m g = 0
right | J*phi'' + (k2*b - k1*a)*y*cos(phi) + (k1*a^2 + k2*b^2)*sin(2*phi)/2 = 0
