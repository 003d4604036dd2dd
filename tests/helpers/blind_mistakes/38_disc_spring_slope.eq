no_rotation | M \ddot{x} + k x = M g \sin\alpha | rotat,inertia,turn,roll,friction,moment of inertia+missing,forgot,left out,omitted,lacks,no part,factor,3/2,without,absent,not contain,not counted,lost,dropped,overlooked,times too,too large,too small,too much,too little
whole_weight | x = M*g/k | weight,gravity+component,sin,slope,projection,angle,alpha,direction | kind:equilibrium
hertz | frequency(1) = sqrt(2*k/(3*M))/(2*pi) | frequency,2 pi,2*pi,Hz,hertz,rad,cycles,circular,angular+factor,unit,Hz,hertz,rad,cycles,2 pi,2*pi,times too,too large,too small,too much,too little
ring_for_disc | reaction_t(plane) = -(M*g*sin(alpha) - k*x)/2 | inertia,moment of inertia,rotat,disc,M*R^2+factor,half,ring,hoop,1/2,twice,times too,too large,too small,too much,too little
inertia_about_contact | M*R^2/2*x''/R = R*(M*g*sin(alpha) - k*x) | inertia,moment of inertia,Steiner,parallel,translation,contact+contact,Steiner,centre,center,missing,point,factor,translation,3/2,left out,without,absent,not contain,not counted,lost,dropped,overlooked,times too,too large,too small,too much,too little
right | \frac{3}{2} M \ddot{x} + k x = M g \sin\alpha
right | x'^2 = 4*(M*g*x*sin(alpha) - k*x^2/2)/(3*M) | - | from_rest:1
