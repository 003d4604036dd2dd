flatnormal | (mA + mB + mD/2) x'' = mB g - mA g sin(alpha) - mu mA g | normal,press,contact,friction+cos,component,factor,angle,weight
nodisc | \ddot x = \frac{m_B - m_A(\sin\alpha + \mu\cos\alpha)}{m_A + m_B}\,g | disc,pulley+rotation,rotat,turning,spin,inertia
weightmass | (m_A g + m_B g + \tfrac12 m_D g)\ddot x = m_B g - m_A g(\sin\alpha + \mu\cos\alpha) | translation,mass,inertia,factor,acceleration,kinetic+weight,factor,dimension,unit,of g,by g
frictionsign | (mA + mB + mD/2)*x'' = g*(mB - mA*sin(alpha) + mu*mA*cos(alpha)) | friction+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | (m_A + m_B + m_D)\ddot x = m_B g - m_A g\cos\alpha - \mu m_A g\sin\alpha | disc,pulley+inertia,factor,rotation,ring,half,1/2+sin,cos,component,axis,swapped,angle
right | S_B - S_A = \frac{m_D}{2}\ddot x
right | x'' = 2*g*(mB - mA*(sin(alpha) + mu*cos(alpha)))/(2*mA + 2*mB + mD)
