right | 2 a B_y + a B_x - F a = 0
right | A_H + B_H + 2 w a = 0
right | B_y = 7.6 kN
right | 3a B_y - a B_x = 2 w a^2 + 2 F a
right | G_x = B_x = -\frac{F + 4 w a}{5}
feet_taken_as_level | 3a B_y - 2 w a^2 - 2 F a = 0 | B_x,horizontal,level,height,lever
lever_of_wind | 3a B_y - a B_x - 2 w a \cdot 2a - 2 F a = 0 | lever,arm,resultant,factor,2,twice,half,distance + w,wind
wind_taken_by_one_foot | A_x = -2 w a | B_x,B,F,factor,load
wind_forgotten_about_hinge | 2a A_x - a A_y = 0 | w,wind
sign_of_thrust | B_x = (F + 4 w a)/5 | sign,opposite
