center | theta'' = 6*g/l*cos(theta) | Steiner,inertia,translation
axis | theta'' = 3*g/(2*l)*sin(theta) | -
particle | theta'' = g/l*cos(theta) | -
law | theta'^2 = 3*g/l*cos(theta) | sin,axis
law | theta'^2 = 6*g/l*sin(theta) | factor 2+weight
law | theta'^2 = 3*g/(2*l)*sin(theta) | factor 1/2,-
law | theta'^2 = 12*g/l*sin(theta) | missing+translation
law | theta' = 3*g/l*sin(theta) | square,root
react | reaction_y(bar) = m*g | missing,stood still
react | reaction_x(bar) = m*l/2*theta'^2*cos(theta) - m*l/2*theta''*sin(theta) | sign
react | reaction_x(bar) = -m*l*(theta'^2*cos(theta) + theta''*sin(theta)) | factor 2,end
react | reaction_x(bar) = -m*l/2*theta'^2*cos(theta) | theta'',missing
react | reaction_y(bar) = m*l/2*(theta'^2*sin(theta) - theta''*cos(theta)) | weight+missing
react | reaction_y(bar) = m*g - m*l/2*theta''*cos(theta) | theta'^2+missing
instant | theta' = sqrt(6*g/l) | factor 2,- | at:theta = pi/2
instant | reaction_y(bar) = 3*m*g | - | at:theta = pi/2
instant | reaction_y(bar) = m*g/2 | - | at:theta = 0
two | theta'' = -6*g/l*cos(theta) | sign+Steiner,translation
two | reaction_y(bar) = m*g + m*l*theta''*cos(theta) | -
right | \ddot\theta = \frac{3g}{2l}\cos\theta
right | \dot\theta^2 = \frac{3g}{l}\sin\theta
right | reaction_y(bar) = \frac{mg}{4}(10 - 9\cos^2\theta)
right | reaction_x(bar) = -\frac{9}{8} m g \sin 2\theta
right | reaction_y(bar) = 5/2 m g | at:theta = pi/2
right | \dot\theta = \sqrt{\frac{3g}{l}} | at:theta = pi/2
