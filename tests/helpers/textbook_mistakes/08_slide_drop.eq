spring energy without half | y'^2 = 2*g*y - 2*k*y^2/m | spring+factor
weight missing | y'^2 = -k*y^2/m | weight+missing
kinetic without half | m*y'^2 = m*g*y - k*y^2/2 | translation,kinetic+factor
sign of the spring | y'^2 = 2*g*y + k*y^2/m | spring+sign
right | y'^2 = 2*g*y - k*y^2/m
