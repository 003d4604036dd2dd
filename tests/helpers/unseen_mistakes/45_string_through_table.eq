tensionweight | m r'' - m r phi'^2 = -M g | hanging,weight,tension,m*r'',mass+r'',acceleration,translation,tension,missing,inertia
coriolis | r\ddot\phi + \dot r\dot\phi = 0 | coriolis,product of,mixed,2*,r'*theta',rates,both rates,r'+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
sign | (m + M)*r'' + m*r*phi'^2 + M*g = 0 | centripetal,centrifugal,normal accel,'^2,square,rate,phi'^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
tension | tension(string) = M*(g - r'') | acceleration,r'',inertia+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | \frac12 (m+M)\dot r^2 + \frac12 m r\dot\phi^2 - M g r = E | phi'^2,puck,rotation,turn,radius,r^2,square,dimension,tangential+weight,gravity,potential,hanging+sign,opposite,direction
right | \frac{d}{dt}(r^2\dot\phi) = 0
right | tension(string)*(m + M) = m*M*(g + r*phi'^2)
