load_as_fast | s'' = g*(2*m2 - m1)/(m1 + 2*m2 + M) | load,m1,s''+half,kinematic,factor,speed,velocity,acceleration,s/2,rope,1/4,quarter,times too,too large,too small,too much,too little
massless_pulley | (m_2 + \frac{m_1}{4}) \ddot s = (m_2 - \frac{m_1}{2}) g | pulley,rotat+missing,forgot,left out,omitted,lacks,no part,massless,inertia,neglect,without,absent,not contain,not counted,lost,dropped,overlooked
static_tension | tension(rope, 1) = m1*g/2 | load,m1,inertia,acceleration+missing,forgot,left out,omitted,lacks,no part,static,rest,neglect,without,absent,not contain,not counted,lost,dropped,overlooked
one_strand | (m1/2 + m2 + M/2)*s'' = (m2 - m1)*g | load,m1,rope,strand,string,tension+two,twice,factor,half,second,both,times too,too large,too small,too much,too little
omega_without_radius | T = m2*s'^2/2 + m1*s'^2/8 + M*R^2*s'^2/4 | pulley,rotat+radius,angular,factor,dimension,unit,kinematic,times too,too large,too small,too much,too little
right | s'' = 2*g*(2*m2 - m1)/(4*m2 + m1 + 2*M)
right | m1*s''/2 = 2*tension(rope, 1) - m1*g
