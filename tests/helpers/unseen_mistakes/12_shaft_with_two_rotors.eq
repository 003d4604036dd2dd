absolute | J2*phi2'' + k2*phi2 = tau | shaft2,spring,relative,phi1,k2+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,relative
sign | J_1\ddot\phi_1 + (k_1 - k_2)\phi_1 + k_2\phi_2 = 0 | shaft2,spring,k2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
series | J1 phi1'' + k1 phi1 + k2 phi1 = 0 | shaft2,phi2,coupl,k2,spring+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
polar | J_1\ddot\phi_1 + \frac{\pi G d^4}{64 L_1}\phi_1 + k_2(\phi_1 - \phi_2) = 0 | shaft1,spring,stiffness,k1+factor,half,1/2,too small,twice
two | V = k1/2*phi1^2 + k2*(phi1 + phi2)^2 | shaft2,spring,k2+factor,half,1/2,twice+sign,sum,difference,opposite
right | \ddot\phi_2 = \frac{\tau}{J_2} + \frac{k_2}{J_2}(\phi_1 - \phi_2)
right | J1*phi1'' + J2*phi2'' + pi*G*d^4/(32*L1)*phi1 = tau
