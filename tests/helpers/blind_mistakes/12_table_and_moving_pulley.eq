same_way | (m1 + m2)*x'' = m2*g - mu*m1*g | load,m2,rope,pulley,weight,tension,strand+twice,as far,ratio,factor,double,half,moves,speed,kinematic,lever
tension_once | (m_1 + 2 m_2) \ddot x = m_2 g - \mu m_1 g | rope,tension,strand,pulley,load,m2+twice,once,factor,two,double,half,strand
ratio_turned | (m1 + m2)*x'' = 2*m2*g - mu*m1*g | load,m2,ratio,inertia,speed,acceleration+twice,as far,ratio,factor,double,half,4
speed_of_load | T = \frac{m_1 \dot x^2}{2} + \frac{m_2 \dot x^2}{2} | load,m2+speed,velocity,twice,factor,double,half
acceleration_of_load | tension(rope) = m2*(g - x'') | load,m2,acceleration,inertia,x''+twice,factor,double,half
right | (m_1 + 4 m_2)\ddot x = (2 m_2 - \mu m_1) g
right | 2*tension(rope) = m1*(x'' + mu*g)
