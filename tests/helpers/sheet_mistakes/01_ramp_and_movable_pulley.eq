right | m_1 \ddot{s} = S_1 - m_1 g \sin\alpha
right | E_kin = 1/2 m1 s'^2 + 1/4 M s'^2 + 1/8 m2 s'^2
right | 2 S_2 - m2 g = -m2 s''/2
right | s¨ = a = \frac{2 m_2 g - 4 m_1 g \sin\alpha}{4 m_1 + 2 M + m_2}
right | \frac{1}{2} M R^2 \cdot \frac{\ddot s}{R} = (S_2 - S_1) R
rope_ratio_forgotten | (m1 + M/2 + m2) s'' = m2 g - m1 g sin(alpha) | pulley,rope,ratio,half,1/2,1/4,factor,moves,velocity,speed + m2,load
pulley_inertia_forgotten | (m1 + m2/4) s'' = g (m2/2 - m1 sin α) | M,disc,pulley,rotat,inertia
cos_for_sin | S_1 = m1 s'' + m1 g \cos\alpha | sin,cos,component
same_tension_over_massive_pulley | S_1 = m_2 (g - s''/2)/2 | disc,M,pulley,strand,tension,S_2,rope
height_of_movable_pulley | E_pot = m1 g s sin(alpha) - m2 g s | half,1/2,factor,2,twice,double,height + m2,load
