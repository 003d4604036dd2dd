horizontal_speed_only | m \ddot{x} + \frac{m g}{p} x = 0 | velocity,vertical,speed,kinetic,bead,vy,inertia,theta'^2,x^2+missing,forgot,left out,omitted,lacks,no part,neglect,ignored,component,vertical,without,absent,not contain,not counted,lost,dropped,overlooked
no_dT_dx | m*(1 + x^2/p^2)*x'' + 2*m*x*x'^2/p^2 + m*g*x/p = 0 | x'^2,velocity,rate,square,dT/d,quadratic,kinetic,centripetal,centrifugal+missing,forgot,left out,omitted,lacks,no part,neglect,ignored,factor,twice,double,partial,half,derivative,without,absent,not contain,not counted,lost,dropped,overlooked,times too,too large,too small,too much,too little
sign_of_dT_dx | x'' = -(3*x*x'^2 + g*p*x)/(p^2 + x^2) | x'^2,velocity,rate,square,dT/d,quadratic,kinetic,centripetal,centrifugal+sign,direction,opposite,factor,three,triple,added,subtract,wrong way,reversed,other way,minus,wrong sense,times too,too large,too small,too much,too little
components_added | speed(bead.center)^2 = x'^2*(1 + x/p)^2 | velocity,component,speed,square,bead+sum,added,Pythagoras,square,root,cross,extra,product,mixed
stiffness_without_two | frequency(1) = sqrt(g/(2*p)) | stiffness,potential,gravity,spring,weight,restoring,frequency,inertia+factor,half,second derivative,twice,two,double,times too,too large,too small,too much,too little
right | (p^2 + x^2)*x'' + x*x'^2 + g*p*x = 0
right | x'^2*(1 + x^2/p^2) = g*(x0^2 - x^2)/p | - | from_rest:1
