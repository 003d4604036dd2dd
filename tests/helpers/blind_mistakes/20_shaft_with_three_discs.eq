twist_sign | J2*phi2'' + k1*(phi1 - phi2) + k2*(phi2 - phi3) = 0 | k1,shaft1+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against
shaft_left_out | J2*phi2'' = k1*(phi1 - phi2) | k2,shaft2,second,third+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
absolute_twist | J_3 \ddot\phi_3 + c \dot\phi_3 + k_2 \phi_3 = 0 | k2,shaft2,phi2+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,relative,absolute,twist,difference
wrong_neighbour | V = k_1 \frac{(\phi_2 - \phi_1)^2}{2} + k_2 \frac{(\phi_3 - \phi_1)^2}{2} | k2,shaft2+phi1,phi2,disc,body,between,neighbour,instead,wrong,relative
two_series_brake | J1*phi1'' + c*phi1' = M0 - k1*k2/(k1 + k2)*(phi1 - phi3) | k1,k2,shaft,spring,stiffness+series,second,middle,phi2,phi3,factor+c*,brake,damp,extra
right | J1*phi1'' + J2*phi2'' + J3*phi3'' = M0 - c*phi3'
right | \ddot\phi_2 = \frac{k_1\phi_1 + k_2\phi_3 - (k_1 + k_2)\phi_2}{J_2}
