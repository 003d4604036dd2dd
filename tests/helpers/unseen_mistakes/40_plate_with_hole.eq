steiner | J_O = m*(b^2 + h^2)/12 - mh*r^2/2 | hole,part 2,disc,second+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
added | J_O = \frac{m}{12}(b^2 + h^2) + m_h\left(\frac{r^2}{2} + c^2\right) | hole,part 2,disc,second+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
side | J_x = m*b^2/12 - mh*r^2/4 | rectangle,part 1,plate,first+axis,side,width,height,of b,in b,by b,at b,on b,for b,with b,swapped,other
mass | x_G = -\frac{m_h c}{m} | hole,mass,whole,net,denominator,m - mh,rest
two | J_x = \frac{m h^2}{3} - \frac{1}{2} m_h r^2 | rectangle,part 1,plate,first+edge,centre,steiner,factor,about,parallel+hole,part 2,disc,second+axis,diameter,factor,polar,1/4,half
right | J_G = J_O - (m - mh)*x_G^2
right | J_G = \frac{m(b^2+h^2)}{12} - \frac{m_h r^2}{2} - \frac{m\,m_h\,c^2}{m - m_h}
