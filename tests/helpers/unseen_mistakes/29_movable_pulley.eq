ratio | (m1 + m2 + mp + Mf/2 + mp/2) s'' = (m1 - m2 - mp) g | load,movable,m2+half,factor,velocity,ratio,1/2,twice,s/2
nopulleys | \left(m_1 + \frac{m_2 + m_p}{4}\right)\ddot s = m_1 g - \frac{(m_2+m_p) g}{2} | pulley,fixed,movable,disc+rotation,rotat,turning,spin,inertia
tension | tension(rope, 1) = m1*g | acceleration,s'',inertia,accelerat+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
halfforce | (8 m1 + 2 m2 + 3 mp + 4 Mf) s'' = 8 g (m1 - m2 - mp) | weight,gravity+load,movable,m2+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
two | (m_1 + \frac{m_2 + m_p}{2} + \frac{M_f}{2} + \frac{m_p}{8})\ddot s = (\frac{m_2+m_p}{2} + m_1) g | load,movable,m2+weight,gravity+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+square,factor,translation,1/4,half,twice
right | s'' = 4*g*(2*m1 - m2 - mp)/(8*m1 + 2*m2 + 3*mp + 4*Mf)
right | tension(hook) = m_2\left(g + \frac{\ddot{s}}{2}\right)
