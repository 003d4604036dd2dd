load_arm | reaction_y(B)*L + M0 - q*(L/2)*(L/2) - F*sin(beta)*d = 0 | load,q*,distributed+arm,lever,distance,point,place,where it acts,position,moment,factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large
load_size | B_y = \frac{\frac{q L^2}{4} + F d \sin\beta - M_0}{L} | load,q*,distributed+factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large,whole,length,size,arm,lever,distance,point,place,where it acts,position,moment
degrees | A_x = -F*cos(60) | degree,radian,60,unit
couple_forgotten | A_y L = q \left(\frac{L}{2}\right) \left(\frac{3 L}{4}\right) + F \sin(\beta) (L - d) | couple,M0,moment,turn+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
two_section | bending_moment(beam, L/2) = A_y*L/2 - q*L*L/2 | load,q*,distributed+arm,lever,distance,point,place,where it acts,position,moment,factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large,factor 4,4 times,whole,size
right | A_y*d - q*(L/2)*(d - L/4) = M0 + B_y*(L - d)
right | A_y + B_y = \frac{q L}{2} + F \sin\beta
