rotating | kinetic_energy(rod) = mr/2*x'^2 | rod+crank,of e,in e,by e,at e,on e,for e,with e,pin,velocity,circle,relative,translation,cos
rodspin | T = \frac32 M_w\dot x^2 + \frac12 m_r\dot x^2\left(1 + \frac{e^2}{R^2} + \frac{2e}{R}\cos\frac{x}{R}\right) + \frac{1}{24}m_r b^2\frac{\dot x^2}{R^2} | rod+rotation,turn,translat,own,spin,inertia
nowheels | T = M_w\dot x^2 + \frac12 m_r\dot x^2\left(1 + \frac{e^2}{R^2} + \frac{2e}{R}\cos\frac{x}{R}\right) | wheel,front,rear,disc+rotation,rotat,turning,spin,inertia
halfderivative | (3*Mw + mr*(1 + e^2/R^2 + 2*e/R*cos(x/R)))*x'' - 2*mr*e/R^2*sin(x/R)*x'^2 - mr*g*e/R*sin(x/R) = F | rod+dt/dq,dt/dx,dt/d,twice,derivative,factor,double,half,x'^2
two | V = -m_r g e\sin\frac{x}{R} | sin,cos,component,swapped,axis,height+sign,opposite,negative,direction
right | (3 M_w + m_r(1 + \frac{e^2}{R^2} + \frac{2e}{R}\cos\frac{x}{R}))\ddot x = F + \frac{m_r e}{R^2}\sin\frac{x}{R}\,(\dot x^2 + g R)
right | speed(rod.center)^2 = x'^2*((1 - e/R)^2 + 4*e/R*cos(x/(2*R))^2)
