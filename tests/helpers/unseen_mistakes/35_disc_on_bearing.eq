welded | (m L^2/3 + M L^2 + M R^2/2) theta'' + (m/2 + M) g L sin(theta) + c (theta' - phi') = 0 | disc+rotation,rotat,turning,spin,inertia
relative | \frac{1}{2} M R^2 (\ddot\theta + \ddot\phi) + c(\dot\phi - \dot\theta) = 0 | disc+relative,absolute,rotation,turn,theta'',angle
dampersign | M*R^2*phi''/2 = c*(phi' - theta') | damp,dashpot,viscous,c*,bearing,friction+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
absdamp | \left(\frac{m}{3}+M\right)L^2\ddot\theta + \left(\frac{m}{2}+M\right) g L \sin\theta + c\dot\theta = 0 | damp,dashpot,viscous,c*,bearing,friction+relative,phi',disc,missing,other body
two | (m L^2/12 + M L^2) theta'' + (m + M) g L sin(theta) + c (theta' - phi') = 0 | bar,rod+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation+weight,gravity,gravit,m*g+lever,arm,distance,length,geometry,where it acts,place,point,moment,factor,centre,twice
right | 2(m + 3M) L^2\ddot\theta + 3(m + 2M) g L\sin\theta = 6c(\dot\phi - \dot\theta)
right | (m/3 + M)*L^2*theta'' + (m/2 + M)*g*L*sin(theta) + M*R^2*phi''/2 = 0
