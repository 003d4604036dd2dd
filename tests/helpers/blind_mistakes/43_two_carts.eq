coupling_sign | m1*x1'' + k1*x1 + k2*(x2 - x1) + c*(x2' - x1') = 0 | spring2,second spring,k2,damper,spring,coupling+sign,direction,opposite,pull,push,wrong way,reversed,other way,minus,wrong sense
spring_to_the_wall | x2'' = (F - k2*x2 - c*x2')/m2 | x1,first cart,spring2,k2,damper,relative,cart1+missing,forgot,left out,omitted,lacks,no part,neglect,ignored,relative,difference,absolute,without,absent,not contain,not counted,lost,dropped,overlooked
absolute_damper | m_1 \ddot{x}_1 + (k_1 + k_2) x_1 - k_2 x_2 + c \dot{x}_1 = 0 | damper,damping+relative,x2',difference,absolute,second cart,cart2,missing,forgot,left out,omitted,lacks,no part,neglect,ignored,without,absent,not contain,not counted,lost,dropped,overlooked
stretch_as_sum | V = k1*x1^2/2 + k2*(x1 + x2)^2/2 | spring2,second spring,k2,coupling,stretch,elongation+sign,direction,opposite,sum,difference,wrong way,reversed,other way,minus,wrong sense
two_force_and_damper | m1*x1'' + (k1 + k2)*x1 - k2*x2 = F | force,load,damper,push+extra,wrong body,does not act,not on,other,cart2,second,too much,missing,forgot,left out,omitted,lacks,no part,neglect,ignored,without,absent,not contain,not counted,lost,dropped,overlooked
right | m_1 \ddot{x}_1 = -k_1 x_1 + k_2 (x_2 - x_1) + c (\dot{x}_2 - \dot{x}_1)
right | m1*x1'' + m2*x2'' + k1*x1 = F
