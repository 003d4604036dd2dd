no_coriolis | (M*L^2/3 + m*r^2)*theta'' + (M*L/2 + m*r)*g*sin(theta) = 0 | Coriolis,r'*theta',r' theta',derivative,velocity,relative+missing,forgot,left out,omitted,lacks,no part,neglect,ignored,constant,without,absent,not contain,not counted,lost,dropped,overlooked
half_coriolis | ay(sleeve.center, ground, bar) = r*theta'' + r'*theta' | Coriolis,r'*theta',r' theta',acceleration+factor,half,two,twice,once,times too,too large,too small,too much,too little
no_centrifugal | m*r'' + k*(r - l0) - m*g*cos(theta) = 0 | centrifugal,centripetal,theta'^2,normal,rotat+missing,forgot,left out,omitted,lacks,no part,neglect,ignored,without,absent,not contain,not counted,lost,dropped,overlooked
rest_length | V = k*r^2/2 - (M*L/2 + m*r)*g*cos(theta) | spring,stretch,elongation+rest,natural,l0,length,unstretched,missing,forgot,left out,omitted,lacks,no part,neglect,ignored,without,absent,not contain,not counted,lost,dropped,overlooked
weight_component | m*r'' - m*r*theta'^2 + k*(r - l0) - m*g*sin(theta) = 0 | weight,gravity+sin,cos,component,swap,projection,angle
right | r'' = r*theta'^2 - k*(r - l0)/m + g*cos(theta)
right | (M*L^2 + 3*m*r^2)*theta'' + 6*m*r*r'*theta' = -3*g*(M*L + 2*m*r)*sin(theta)/2
