spring_lever | m*l^2/3*phi'' + c*l^2*cos(phi)^2*phi' + k*a^2*sin(phi) - m*g*l/2*sin(phi) = 0 | spring+cos,lever,arm,angle,moment arm,distance
weight_restores | m*l^2/3*phi'' + c*l^2*cos(phi)^2*phi' + k*a^2*sin(phi)*cos(phi) + m*g*l/2*sin(phi) = 0 | weight,gravity+sign,direction,opposite,restor,upright,hanging,wrong way,reversed,other way,minus,wrong sense
two_spring_place_and_weight | m*l^2/3*phi'' + c*l^2*cos(phi)^2*phi' + k*l^2*sin(phi)*cos(phi) + m*g*l/2*sin(phi) = 0 | spring,weight,gravity+sign,direction,opposite,lever,arm,point,place,end,distance,wrong way,reversed,other way,minus,wrong sense,moment arm
damper_without_lever | Q(phi) = m*g*l/2*sin(phi) - k*a^2*sin(phi)*cos(phi) - c*l*cos(phi)*phi' | damp+lever,arm,factor,cos,moment,force,dimension,unit,times too,too large,too small,too much,too little,moment arm,distance
hinge_static | reaction_x(bar) = k*a*sin(phi) + c*l*cos(phi)*phi' | inertia,acceleration,m*a,mass+missing,forgot,left out,omitted,lacks,no part,static,neglect,without,absent,not contain,not counted,lost,dropped,overlooked
right | phi'' = 3*sin(phi)*(m*g*l - 2*k*a^2*cos(phi))/(2*m*l^2) - 3*c/m*cos(phi)^2*phi'
right | 2*m*l^2*phi'' + 3*c*l^2*(1 + cos(2*phi))*phi' + 3*k*a^2*sin(2*phi) - 3*m*g*l*sin(phi) = 0
