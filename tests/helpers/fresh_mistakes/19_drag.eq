sign | m*x'' = c*x' | sign
square | m*x'' = -c*x'^2 | x'
missing | x'' = -c*x' | m
extra | m*x'' = -c*x' - m*g | g,weight
law | x = m*v0/c*exp(-c*t/m) | start,const
law | x = m*v0/c*(1 - exp(-c*t)) | m
law | x = m*v0/c*(1 - exp(c*t/m)) | sign
law | x = v0*t - c*v0*t^2/(2*m) | constant
law | x' = v0 - c*x | m
law | x' = v0 + c*x/m | sign
law | x' = v0*exp(-c*t/m)/2 | -
law | t = m*v0/c | - | at:x' = v0/2
law | t = m/c*log(1/2) | sign | at:x' = v0/2
react | reaction_n(block) = m*g + c*x' | c*x'
two | m*x'' = 2*c*x' | factor 2+sign
two | x'' = c*x' | m+sign
right | x = \frac{m v_0}{c}\left(1-e^{-ct/m}\right)
right | \dot{x} = v_0 - \frac{c}{m}x
right | \dot{x} = v_0\,\exp\left(-\frac{c}{m}t\right)
right | \frac{d}{dt}(m\dot x + c x) = 0
right | m\dot x + c x = m v_0
right | t = \frac{m}{c}\ln 2 | at:x' = v0/2
