sign | (1 + r^2/p^2)*r'' + r*r'^2/p^2 + W^2*r + g*r/p = 0 | sign+W,psi',centri
missing | (1 + r^2/p^2)*r'' - W^2*r + g*r/p = 0 | missing+r'^2
missing | r'' - W^2*r + g*r/p = 0 | height,vertical,slope,z+missing
factor | (1 + r^2/p^2)*r'' + 2*r*r'^2/p^2 - W^2*r + g*r/p = 0 | factor 2,twice+r'^2
partial | (1 + r^2/p^2)*r'' - r*r'^2/p^2 - W^2*r + g*r/p = 0 | sign+r'^2
missing | (1 + r^2/p^2)*r'' + r*r'^2/p^2 + g*r/p = 0 | missing,leaves out+W,psi'
factor | (1 + r^2/p^2)*r'' + r*r'^2/p^2 - W^2*r + g*r/(2*p) = 0 | factor 1/2+weight
missing | T = m*(r'^2 + r^2*W^2)/2 | missing+z,vertical,height,p
chain | T = m*(r'^2*(1 + r/p)^2 + r^2*W^2)/2 | r/p,cross,product,square
square | T = m*(r'^2*(1 + r^2/p^2) + r*W^2)/2 | r+factor,missing
L=T+V | (1 + r^2/p^2)*r'' + r*r'^2/p^2 - W^2*r - g*r/p = 0 | sign+weight
two | (1 + r^2/p^2)*r'' + r*r'^2/p^2 + W^2*r - g*r/p = 0 | sign+W,psi'+weight
two | r'' + W^2*r + g*r/p = 0 | -
right | \left(1+\frac{r^2}{p^2}\right)\ddot r + \frac{r\dot r^2}{p^2} = \left(W^2 - \frac{g}{p}\right) r
right | (p^2 + r^2) r̈ + r ṙ² + (p g − p² W²) r = 0
right | \frac{d}{dt}\left[m\dot r\left(1+r^2/p^2\right)\right] = m r\left(\frac{\dot r^2}{p^2} + W^2\right) - \frac{m g r}{p}
right | \frac12 \dot r^2(1 + r^2/p^2) + \frac12\left(\frac gp - W^2\right)r^2 = C
