eulersign | I1*w1' = (I3 - I2)*w2*w3 - c*w1 | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
noeuler | I2*w2' = -c*w2 | gyroscop,product,w1*w3,w3*w1,euler,omega x,axes,turning,term+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
sum | I_3 \dot w_3 = (I_1 + I_2) w_1 w_2 - c w_3 | i2,i_2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way,sum,difference
energy | T = I1*w1^2 + I2*w2^2 + I3*w3^2 | factor,half,1/2,twice,double
two | I1*w1' - (I2 - I3)*w2*w3/2 = c*w1 | damp,dashpot,viscous,c*,drag+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+gyroscop,product,w2*w3,euler,inertia+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
right | \dot{w}_2 = \frac{(I_3 - I_1) w_1 w_3 - c w_2}{I_2}
right | I1*w1*w1' + I2*w2*w2' + I3*w3*w3' = -c*(w1^2 + w2^2 + w3^2)
