right | \sum M_y = 0: F a - (S_B + S_C) \frac{b h}{\sqrt{b^2 + c^2 + h^2}} = 0
right | S_C = 8.75 kN
right | O_x = -F (1 - a/h)
right | S_B = \frac{\sqrt{b^2+c^2+h^2}}{2}\left(\frac{F a}{b h} - \frac{H}{c}\right)
right | O_z - m g = (S_B + S_C) h/\sqrt{b^2 + c^2 + h^2}
component_of_guy_forgotten | F a = (S_B + S_C) b | h,component,cos,sqrt,direction,lever,length,factor
weight_forgotten | O_z = F a/b | m*g,weight
one_guy_alone | F a = S_B b h/\sqrt{b^2 + c^2 + h^2} | S_C,C,second,other
sign_of_across | S_B - S_C = H \sqrt{b^2 + c^2 + h^2}/c | sign,opposite
push_taken_at_the_top | O_x = 0 | a,lever,height,F,push
