relative_acceleration | m*z'' + c*z' + k*z = 0 | housing,u'',ground,inertia,transport,motion+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,relative,absolute
damping_absolute | m \ddot z + c (\dot z + U w \cos(w t)) + k z = m U w^2 \sin(w t) | damp,dashpot,c*+absolute,relative,extra,u',housing,velocity,not belong,too much
inertia_sign | m*z'' + c*z' + k*z = -m*U*w^2*sin(w*t) | u'',housing,inertia,drive,excit,sin(w*t),transport,motion,term+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against
spring_stretch | m*(z'' + u'') + c*z' + k*(z - u) = 0 | spring,k*,stiffness+relative,absolute,stretch,extra,k*u,deflection,not belong,too much
energies_added | T = \frac{m \dot z^2}{2} + \frac{m \dot u^2}{2} | u'*z',z'*u',cross,product,mixed,square,velocit,relative,housing,coupl+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,square,sum,added,cross,product
right | T = m*(z' + u')^2/2
right | \ddot z + \frac{c}{m}\dot z + \frac{k}{m} z = U w^2 \sin(w t)
