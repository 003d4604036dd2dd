right | N_f = (m*g*a + F*h)/(a + b)
missing | N_f = m*g*a/(a + b) | motion,inertia,acceler,brake,lever+missing,wrong
sign | N_f = (m*g*a - F*h)/(a + b) | inertia,acceler,brake,motion+sign
lever | N_f = (m*g*b + F*h)/(a + b) | weight+lever,b stands,acts at
missing | N_r = m*g | front+missing
