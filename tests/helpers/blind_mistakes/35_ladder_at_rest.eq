friction_at_limit | reaction_t(floor) = mu*N_floor | friction,mu,floor+limit,greatest,largest,at rest,sliding,stick,full,mu,only as large,maximum,static
sin_for_cos_in_levers | N_wall*l*cos(alpha) = (G*l/2 + W*s)*sin(alpha) | lever,N_wall,wall,moment,angle,moment arm,distance+sin,cos,swap,angle
friction_at_wall | N_floor + mu*N_wall = G + W | wall,friction,mu*N_wall,N_wall+extra,not there,no friction,smooth,added,too much,does not
weight_at_end | N_wall*l*sin(alpha) = (G*l + W*s)*cos(alpha) | weight+lever,arm,half,factor,l/2,middle,centre,center,mid,end,place,times too,too large,too small,too much,too little,moment arm,distance
as_on_an_incline | N_floor = (G + W)*cos(alpha) | N_floor,floor,normal,weight+cos,component,projection,incline,vertical,direction,angle
right | reaction_t(floor) = (G/2 + W*s/l)/tan(alpha)
right | N_{floor} = G + W
