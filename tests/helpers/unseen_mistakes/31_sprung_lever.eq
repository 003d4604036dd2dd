lever | (mb/3 + mt) l^2 theta'' + c b^2 cos(theta)^2 theta' + k a sin(theta) cos(theta) = 0 | spring+lever,arm,factor,distance,length
small | \left(\frac{m_b}{3} + m_t\right) l^2\ddot\theta + c b^2\dot\theta + k a^2\theta = 0 | small,linear,sin,cos,approxim
centre | (mb/12 + mt)*l^2*theta'' = -(c*b^2*theta'*cos(theta) + k*a^2*sin(theta))*cos(theta) | bar,rod+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
damperplace | Q(theta) = -k*a^2*sin(theta)*cos(theta) - c*a^2*cos(theta)^2*theta' | dashpot,damp+lever,arm,distance,length,geometry,where it acts,place,point,moment,where
two | (m_b + 3m_t) l^2\ddot\theta = 3\cos\theta\,(c b^2\cos\theta\,\dot\theta - k a\sin\theta) | dashpot,damp+sign,opposite,direction+spring+lever,arm,factor,distance,length
right | (m_b + 3 m_t) l^2\ddot\theta + \frac{3}{2} k a^2\sin 2\theta + 3 c b^2\cos^2\theta\,\dot\theta = 0
right | theta'' = -3*cos(theta)*(k*a^2*sin(theta) + c*b^2*theta'*cos(theta))/(l^2*(mb + 3*mt))
