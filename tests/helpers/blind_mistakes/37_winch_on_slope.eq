drum_inertia | s = v0*t + t^2/2*(M0/(m*R) - g*(sin(alpha) + mu*cos(alpha))) | drum,rotat+missing,forgot,left out,omitted,lacks,no part,massless,neglect,inertia,without,absent,not contain,not counted,lost,dropped,overlooked | kind:law
friction_sign | (m + J/R^2)*s'' = M0/R - m*g*sin(alpha) + mu*m*g*cos(alpha) | friction,mu+sign,direction,opposite,against,wrong way,reversed,other way,minus,wrong sense
two_normal_force_and_drum | m*s'' = M0/R - m*g*sin(alpha) - mu*m*g | drum,friction,mu,normal+missing,forgot,left out,omitted,lacks,no part,massless,inertia,cos,normal,component,without,absent,not contain,not counted,lost,dropped,overlooked
tension_static | tension(rope) = M0/R | drum,inertia,rotat,acceler+missing,forgot,left out,omitted,lacks,no part,massless,neglect,static,balance,rest,equilibrium,without,absent,not contain,not counted,lost,dropped,overlooked
angular_acceleration | (m + J/R)*s'' = M0/R - m*g*(sin(alpha) + mu*cos(alpha)) | drum,angular,rotat+factor,kinematic,dimension,unit,radius,rolling,s'',times too,too large,too small,too much,too little
right | \ddot s = \frac{M_0/R - m g (\sin\alpha + \mu\cos\alpha)}{m + J/R^2}
right | m*s'' = tension(rope) - m*g*sin(alpha) - mu*N_slope
