foot_moves_once | F = (P + G)/tan(theta) | F,push,foot,displacement,bar+factor,half,halved,1/2,times 0.5,too little,too small,factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large,displacement
bars_at_the_knee | F = \frac{P + 2 G}{2 \tan\theta} | G,G1,G2,weight,bar+factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large,arm,lever,distance,point,place,where it acts,position,moment,knee,middle,centre,center
not_differentiated | P*sin(theta) + G*sin(theta) - 2*F*cos(theta) = 0 | sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along,virtual,differentiat,derivative
bar_weights | F = P/(2*tan(theta)) | G,G1,G2,weight,bar+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
support_half_bar | reaction_n(C) = P/2 + G/2 | G,G1,G2,weight,bar+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,factor,half,halved,1/2,times 0.5,too little,too small
right | 2*F*l*sin(theta) = (P + G)*l*cos(theta)
right | reaction_x(left) = F
