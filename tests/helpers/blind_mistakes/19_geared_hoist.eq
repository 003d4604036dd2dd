ratio_once | \left(\frac{J_1 n}{R^2} + \frac{J_2}{R^2} + m\right) \ddot y = \frac{M_0 n}{R} - m g | motor,J1+square,n^2,ratio,power,factor,gear,instead,wrong,factor,replaced
motor_inertia | (J_2 + m R^2) \ddot y = R (n M_0 - m g R) | motor,J1+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
inner_couple | (J1*n^2 + J2 + m*R^2)*y'' = R*((n + 1)*M0 - m*g*R) | M0,torque,motor,couple,gear+twice,extra,inner,internal,factor,too much,not act,counted,not belong
ratio_turned | (J1/n^2 + J2 + m*R^2)*y'' = R*(M0/n - m*g*R) | gear,ratio,n^2,motor+ratio,inverse,invert,factor,square,power,divide,other way
two_torque_motor | (J2 + m*R^2)*y'' = R*(M0 - m*g*R) | J1,motor,inertia+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop+M0,torque,gear,ratio
right | J1*n^2*y'' + J2*y'' = R*(n*M0 - R*tension(rope))
right | T = \frac12\left(m + \frac{J_2 + n^2 J_1}{R^2}\right)\dot y^2
