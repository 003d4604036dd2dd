upper_forgotten | reaction_n(floor) = G | upper,contact,G2,weight,second,tension+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,factor,half,halved,1/2,times 0.5,too little,too small
tan_cot | N_{\mathrm{right}} = G \tan\phi | sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along,tan(,tangent
both_weights | reaction_n(right) = 2*G/tan(phi) | G,G1,weight,lower,both+factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large,extra,both,added,not act
contact_is_weight | tension(contact) = -G | contact,tension,link+component,sin,angle,projection,factor,vertical,inclined,direction,instead,wrong,factor,replaced
weight_resolved | tension(contact) = -G*sin(phi) | wall,right,reaction,contact,tension,weight+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along,instead,factor
right | reaction_n(left)*tan(phi) = G
right | reaction_n(floor) = 800
