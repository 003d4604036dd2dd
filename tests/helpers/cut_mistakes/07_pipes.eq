right | N = 2*G
right | N_r = G/tan(phi)
missing | N = G | G2,contact+missing
exchanged | N_r = G*tan(phi) | contact,G2+axis,exchanged,sin,cos,tan
taken in | N_l = 2*G/tan(phi) | G1,weight,G2
full | K = -G | contact+full,component,sin
exchanged | K = -G/cos(phi) | contact+axis,exchanged,sin,cos
sign | K = G/sin(phi) | sign,opposite
