right | \sum M_A = 0: 3a B - 4 q a^2 - H h = 0
right | A_y = \frac{2 q a}{3} - \frac{H h}{3 a}
right | M(2a) = B_y a - q a^2/2
right | M_r - M_l = H h
right | M_r = 12 kN m
lever_of_resultant | 3a B - 2 q a \cdot a - H h = 0 | lever,arm,resultant,centroid,distance,factor,2,twice,half + q,load
couple_forgotten | B_y = 4 q a/3 | H,h,couple,bracket,push
sign_of_couple | A_y = 2 q a/3 + H h/(3 a) | sign,opposite
load_not_halved | M(2a) = B_y a - q a^2 | factor,half,1/2,2,twice,lever,arm + q,load
jump_forgotten | M_r = M_l | H,h,couple,bracket,push,jump
