whole_centrifugal | m*r'' = m*r*omega^2 - m*g*cos(beta) - k*(r - l0) | centrifugal,centripetal,omega,rotat+sin,component,projection,distance,axis,beta,angle,factor,radius,times too,too large,too small,too much,too little
two_projection_and_weight | m*r'' = m*r*omega^2*sin(beta) - m*g*sin(beta) - k*(r - l0) | centrifugal,centripetal,omega,rotat,weight,gravity+sin,cos,component,projection,distance,axis,beta,angle,factor,radius,times too,too large,too small,too much,too little
coriolis_along_tube | m \ddot{r} = m r \omega^2 \sin^2\beta - 2 m \omega \dot{r} \sin\beta - m g \cos\beta - k (r - l_0) | Coriolis,r'+extra,not there,across,perpendicular,direction,too much,does not,no part,axis,does no
relative_speed | speed(bead.center) = r' | omega,transport,turn,rotat,shaft,tube,psi+missing,forgot,left out,omitted,lacks,no part,neglect,ignored,relative,without,absent,not contain,not counted,lost,dropped,overlooked
half_coriolis_torque | drive(psi) = m*omega*r*r'*sin(beta)^2 | Coriolis,r'*,torque,drive,couple,angular momentum,moment+factor,half,two,twice,double,derivative,times too,too large,too small,too much,too little
right | r'' + (k/m - omega^2*sin(beta)^2)*r = k*l0/m - g*cos(beta)
right | T = m*(r'^2 + r^2*omega^2*(1 - cos(2*beta))/2)/2
