sign | m x1'' = -k (x1 + x2) | spring,bond,of k,in k,by k,at k,on k,for k,with k+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way,sum,difference
onespring | M*x2'' = -k*(x2 - x1) | spring,bond,of k,in k,by k,at k,on k,for k,with k,x3+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
factor | M\ddot x_2 + k(x_2 - x_1 - x_3) = 0 | spring,bond,of k,in k,by k,at k,on k,for k,with k,x2,x_2+factor,half,1/2,twice,double,times,halved,doubled,too large,too small,missing,both
frequency | frequency(3) = sqrt(k/m + k/M) | of m,in m,by m,at m,on m,for m,with m,middle,mass,spring,factor,two,twice,2*,both,double,half | kind:frequency
two | V = k (x2 - x1)^2 + \frac12 k (x2 + x3)^2 | bond12,spring,first,factor+factor,half,1/2,twice,double+sign,sum,difference,opposite
right | frequency(3) = sqrt(k*(M + 2*m)/(m*M)) | - | kind:frequency
right | m\dot x_1 + M\dot x_2 + m\dot x_3 = P_0
