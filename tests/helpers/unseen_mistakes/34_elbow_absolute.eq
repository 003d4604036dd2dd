reaction | (m1/3 + m2) l1^2 th1'' + m2 l1 l2/2 (th2'' cos(th2 - th1) - th2'^2 sin(th2 - th1)) + (m1/2 + m2) g l1 cos(th1) = tau1 | tau2,motor,torque,elbow,drive,lower+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,reaction,opposite
sign | \frac{1}{3}m_2l_2^2 th2'' + \frac12 m_2l_1l_2 th1''\cos(th_2-th_1) - \frac12 m_2l_1l_2 th1'^2\sin(th_2-th_1) + \frac12 m_2gl_2\cos(th_2) = \tau_2 | th1'^2,centripetal,centrifugal+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
nocarry | m2*l2^2*th2''/3 = tau2 - m2*g*l2*cos(th2)/2 | th1,upper,coupl,translation,elbow,carried,support+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
noload | (m1/3 + m2)*l1^2*th1'' + m2*l1*l2/2*(th2''*cos(th2 - th1) - th2'^2*sin(th2 - th1)) + m1/2*g*l1*cos(th1) = tau1 - tau2 | weight,gravity,gravit,m*g+lower,m2,second
two | T = (m1/6 + m2/2) l1^2 th1'^2 + m2 l2^2 (th1' + th2')^2/6 + m2 l1 l2 th1' th2'/2 | relative,absolute,angle,rotation,angular,sum,turn+cos,coupl,mixed,product
right | 2*m2*l2*th2'' + 3*m2*l1*(th1''*cos(th1 - th2) + th1'^2*sin(th2 - th1)) = 6*tau2/l2 - 3*m2*g*cos(th2)
right | kinetic_energy(upper) = m1*l1^2*th1'^2/6
