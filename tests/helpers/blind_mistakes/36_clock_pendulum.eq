steiner_distance | inertia_point(O) = m1*l^2/3 + m2*R^2/2 + m2*(l + R)^2 | disc,m2+distance,Steiner,parallel,lever,wrong point,place,rim,radius,centre,center,moment arm
two_rod_inertia_and_weight | (m1*l^2/12 + m2*l^2 + m2*R^2/2)*theta'' + (m1 + m2)*g*l*sin(theta) = 0 | rod,m1+inertia,Steiner,about the hinge,moment of inertia,1/12,factor,lever,centre,center,half,weight,gravity,times too,too large,too small,too much,too little,moment arm,distance
as_simple_pendulum | frequency(1) = sqrt(g*(m1 + m2)/(l*(m1/2 + m2))) | inertia,moment of inertia,rod,disc,pendulum,rotation,m1,m2+missing,point mass,centre,center,simple,Steiner,concentrated,factor,particle,without,absent,not contain,not counted,lost,dropped,overlooked,times too,too large,too small,too much,too little
rod_height | V = -(m1 + m2)*g*l*cos(theta) | rod,m1+half,centre,center,factor,height,l/2,lever,end,middle,times too,too large,too small,too much,too little,moment arm,distance
no_centripetal_force | reaction_y(rod) = (m1 + m2)*g | centripetal,centrifugal,acceleration,inertia,theta'^2,normal,motion+missing,weight only,alone,forgot,left out,omitted,lacks,no part,static,neglect,ignored,without,absent,not contain,not counted,lost,dropped,overlooked | at:theta=0
right | J_O*theta'' + (m1/2 + m2)*g*l*sin(theta) = 0
right | theta'' = -3*g*(m1 + 2*m2)*sin(theta)/(2*m1*l + 6*m2*l + 3*m2*R^2/l)
