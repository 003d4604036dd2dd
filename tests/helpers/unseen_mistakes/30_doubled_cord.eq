samespeed | (mA + mB)*x'' = mB*g - mu*mA*g | of b,in b,by b,at b,on b,for b,with b,weight,hanging,mb+twice,double,factor,half,of 2,in 2,by 2,at 2,on 2,for 2,with 2,velocity,ratio
reverse | \left(m_A + \frac{m_B}{4}\right)\ddot x = \frac{m_B g}{2} - \mu m_A g | of b,in b,by b,at b,on b,for b,with b,mb+twice,double,factor,half,ratio,velocity,too small
linear | (m_A + 2 m_B)\ddot x = 2 m_B g - \mu m_A g | of b,in b,by b,at b,on b,for b,with b,mb+square,factor,twice,half,translation,double
tensionweight | m_A\ddot x = 2 m_B g - \mu m_A g | of b,in b,by b,at b,on b,for b,with b,mb,tension+acceleration,inertia,translation,missing,x'',mass
two | S = m_B (g + \ddot x) | sign,opposite+factor,twice,of 2,in 2,by 2,at 2,on 2,for 2,with 2,half,velocity
right | S = mB*(g - 2*x'')
right | \frac{d^2 x}{dt^2} = \frac{(2 m_B - \mu m_A) g}{m_A + 4 m_B}
