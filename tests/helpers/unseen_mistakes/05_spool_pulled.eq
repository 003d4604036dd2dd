hubsign | m (1 + kG^2/R^2) x'' = F (cos(beta) + r/R) | cable,moment,couple+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
nomoment | \ddot{x} = \frac{F R^2\cos\beta}{m(R^2 + k_G^2)} | cable,moment,couple,r/r+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
norotation | m*x'' = F*cos(beta) - F*r/R | rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
weight | reaction_n(floor) = m*g | cable,pull,f*sin+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
two | m\left(1 + \frac{k_G^2}{r^2}\right)\ddot x = F\left(\sin\beta - \frac{r}{R}\right) | rotation,inertia,rolling,angular,spin+radius,roll,factor,of r,in r,by r,at r,on r,for r,with r,omega+sin,cos,component,axis,swapped
right | reaction_t(floor) = -F*(kG^2*cos(beta) + r*R)/(kG^2 + R^2)
right | (R^2 + kG^2)*x'' = F*R*(R*cos(beta) - r)/m
