steiner | theta'' = 12*g*b*cos(theta)/L^2 | steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
static | A_y = m g | acceleration,a_g,theta'',inertia,mass+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,static
end | \left(\frac{L^2}{3} + b^2\right)\ddot\theta = g b\cos\theta | steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation,twice
energy | \dot\theta^2 = \frac{12 g b\sin\theta}{L^2 + 12 b^2} | weight,gravity,factor,twice,half,kinetic,1/2,double
two | A_x = m b (theta'^2 sin(theta) + theta'' cos(theta)) | sin,cos,component,axis,direction,swapped,angle+sign,opposite,direction,negative
right | \frac{L^2 + 12 b^2}{12}\,\ddot\theta - g b\cos\theta = 0
right | A_y = m*g - m*b*(theta''*cos(theta) - theta'^2*sin(theta))
