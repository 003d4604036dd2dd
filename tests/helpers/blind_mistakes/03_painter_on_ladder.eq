sin_cos | reaction_n(B)*L*cos(theta) = G*L/2*sin(theta) + W*s*sin(theta) | sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along
arm_along | N_B L \sin\theta = \frac{G L}{2} \cos\theta + W s | W*,painter+arm,lever,distance,point,place,where it acts,position,moment,sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along
normal_of_ladder | N_B*L = (G*L/2 + W*s)*cos(theta) | N_B,at B,wall,reaction,normal+arm,lever,distance,point,place,where it acts,position,moment,sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along
like_a_beam | A_y = G/2 + W*(1 - s/L) | A_y,N_B,floor,wall,weight,friction+share,half,beam,wall,moment,missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,instead,wrong,factor,replaced
limit_friction | A_x = mu*(G + W) | mu*,friction,limit
right | A_x = (G*L + 2*W*s)/(2*L*tan(theta))
right | A_y*L*cos(theta) - A_x*L*sin(theta) = G*L*cos(theta)/2 + W*(L - s)*cos(theta)
