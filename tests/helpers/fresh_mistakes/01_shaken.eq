sign | l*theta'' + (g - y'')*sin(theta) = 0 | sign+y
missing | l*theta'' + g*sin(theta) = 0 | missing,left out,leaves out+y,translation
sign | l*theta'' + (g + a*W^2*cos(W*t))*sin(theta) = 0 | sign+y,W
chain | l*theta'' + (g - a*W*cos(W*t))*sin(theta) = 0 | W
axis | l*theta'' + g*cos(theta) + y''*sin(theta) = 0 | weight+other axis,cos
cross | T = m*(l^2*theta'^2 + y'^2)/2 | product,missing+theta'*y',y'*theta'
axis | T = m*(l^2*theta'^2 + 2*l*y'*theta'*cos(theta) + y'^2)/2 | cos,axis
L=T+V | l*theta'' + y''*sin(theta) = g*sin(theta) | sign+weight
two | l*theta'' - g*sin(theta) = 0 | sign+weight+y
two | l*theta'' - (g - 2*y'')*sin(theta) = 0 | sign+weight,y+factor,2
right | \ddot\theta + \left(\frac{g}{l} - \frac{a W^2}{l}\cos(W t)\right)\sin\theta = 0
right | \frac{d}{dt}\left(l\dot\theta + \dot y\sin\theta\right) = \dot y\,\dot\theta\cos\theta - g\sin\theta
right | l\ddot\varphi = (g + \ddot y)\sin\varphi
right | l θ̈ + 2(g + ÿ) sin(θ/2) cos(θ/2) = 0
right | \dfrac{\mathrm d}{\mathrm dt}\left(m l^2\dot\theta + m l\dot y\sin\theta\right) - m l \dot y\dot\theta\cos\theta + m g l \sin\theta = 0
