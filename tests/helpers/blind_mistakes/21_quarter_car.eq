damper_absolute | m2*x2'' + c*x2' + k2*(x2 - x1) = 0 | damp,c*,x1'+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,relative,absolute,velocity
damper_reaction | m1*x1'' + k1*(x1 - z) + k2*(x1 - x2) = 0 | damp,c*+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
road_forgotten | m_1 \ddot x_1 + c (\dot x_1 - \dot x_2) + k_2 (x_1 - x_2) + k_1 x_1 = 0 | road,k1,tyre,tire+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,relative,absolute,stretch
body_on_road | m2*x2'' + c*(x2' - x1') + k2*(x2 - z) = 0 | k2,spring,suspension,x1+road,wheel,x1,instead,point
two_mass_damper | (m_1 + m_2) \ddot x_1 + k_1 (x_1 - z) + k_2 (x_1 - x_2) - c (\dot x_1 - \dot x_2) = 0 | m2,mass,inertia,body,extra+damp,c*+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against
right | m1*x1'' + m2*x2'' = k1*(z - x1)
right | m_2 \ddot x_2 = -k_2 (x_2 - x_1) - c (\dot x_2 - \dot x_1)
