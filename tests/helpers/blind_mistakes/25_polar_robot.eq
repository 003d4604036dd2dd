coriolis_once | (J_1 + J_2 + m r^2) \ddot\theta + m r \dot r \dot\theta + m g r \cos\theta = \tau | coriolis,r'*theta',theta'*r'+factor,half,halved,1/2,times 0.5,too little,too small,factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large
centrifugal_sign | m*r'' + m*r*theta'^2 + m*g*sin(theta) = F | centrifugal,centripetal,theta'^2,dT/dr+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against
power_of_r | T = (J1 + J2)*theta'^2/2 + m*(r'^2 + r*theta'^2)/2 | hand,m*,r*theta,r^2,velocity+power,dimension,unit,square,r^2
drive_moment | (J1 + J2 + m*r^2)*theta'' + 2*m*r*r'*theta' + m*g*r*cos(theta) = tau - F*r | F*,drive,force+extra,no moment,not act,lever,arm,line,moment,not belong,too much,no work,should not,does not
two_inertia_coriolis | (J1 + m*r^2)*theta'' + m*g*r*cos(theta) = tau | J2,hand+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop+coriolis,r'*theta',theta'*r'
right | \ddot r = r\dot\theta^2 - g\sin\theta + \frac{F}{m}
right | (J1 + J2 + m*r^2)*theta'*theta'' + m*r*r'*theta'^2 + m*r'*r'' + m*g*(r'*sin(theta) + r*cos(theta)*theta') = tau*theta' + F*r'
