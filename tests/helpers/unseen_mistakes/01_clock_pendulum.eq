steiner | (m l^2/3 + M R^2/2) theta'' + (m/2 + M) g l sin(theta) + kt theta = 0 | bob,disc+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
axis | \left(\frac{m l^2}{12} + M l^2 + \frac{1}{2} M R^2\right)\ddot\theta = -\left(\frac{m}{2}+M\right) g l \sin\theta - kt\,\theta | bar,rod+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
small | theta'' = -(6*kt*theta + 3*(m + 2*M)*g*l*theta)/(2*m*l^2 + 6*M*l^2 + 3*M*R^2) | small,linear,sin,approxim,theta for
springsign | (2 m l^2 + 6 M l^2 + 3 M R^2) theta'' + 3 (m + 2 M) g l sin(theta) - 6 kt theta = 0 | spring,stiffness,stretch,elastic,restoring,flexure+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | \left(\frac{1}{3}ml^2 + Ml^2 + MR^2\right)\ddot{\theta} + (m + M) g l \sin\theta + kt\theta = 0 | bob,disc+inertia,rotation,factor,ring,1/2+bar,rod+weight,gravity,centre,factor,lever
right | \ddot\theta = -\frac{3 g l (m + 2M)\sin\theta + 6\,kt\,\theta}{2 m l^2 + 3M(2l^2 + R^2)}
right | theta''*(2*m*l^2 + 6*M*l^2 + 3*M*R^2)/6 + kt*theta = -(m + 2*M)*g*l*sin(theta/2)*cos(theta/2)
