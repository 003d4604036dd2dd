relative | L*theta'' + g*sin(theta) = 0 | relative,coupl,block,x'',support,translation,velocity,motion of+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected
T | T = \frac12 (m_A + m_B)\dot x^2 + \frac12 m_B L^2\dot\theta^2 | coupl,mixed,product,x'*theta',cross,cos+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected
centrifugal | (mA + mB) x'' + mB L theta'' cos(theta) + mB L theta'^2 sin(theta) + k x = 0 | theta'^2,centripetal,centrifugal+sign,opposite,direction,reversed,other way,negative,turned round
onlyblock | mA*x'' + mB*L*cos(theta)*theta'' - mB*L*sin(theta)*theta'^2 = -k*x | of b,in b,by b,at b,on b,for b,with b,ball,mb+x'',translation,mass,motion,missing
two | (m_A+m_B)\ddot{x} + m_B L\cos\theta\,\ddot\theta - k x = 0 | theta'^2,centripetal,centrifugal+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected+spring,stiffness,stretch,elastic,restoring,of k,in k,by k,at k,on k,for k,with k+sign,opposite,direction,reversed,other way,negative,turned round
right | (m_A + m_B\sin^2\theta)\ddot x = m_B\sin\theta\,(L\dot\theta^2 + g\cos\theta) - kx
right | kinetic_energy(B) = mB/2*(x'^2 + L^2*theta'^2) + mB*L*x'*theta'*cos(theta)
