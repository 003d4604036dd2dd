aboutA | v_P = p w | centre,about,point,translation,velocity,missing,sin,radius,distance
degrees | v_A = -2*0.5*sin(34.38) | degree,deg,rad,unit
centre | y_c = l\sin\theta/2 | factor,half,1/2,twice,double,centre,middle
acceleration | a_A = -l*w^2*sin(theta) | sin,cos,derivative,axis,swapped
two | v_A = l w\cos\theta | sign,opposite,negative,direction+sin,cos,axis,swapped,component
right | v_P^2 = w^2*((l - p)^2*sin(theta)^2 + p^2*cos(theta)^2)
right | v_A\cos\theta + v_B\sin\theta = 0
