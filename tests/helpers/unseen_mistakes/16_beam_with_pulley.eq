lever | S = W*(3*a + r)/(6*a/5) | rope_wall,rope,wall,pulley+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,lever,arm,moment
horizontal | A_x = 2 W | rope_wall,rope,wall,pulley+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
cosine | S = \frac{3W}{2\cdot\frac{4}{5}} | cable+lever,arm,component,sin,cos,angle,direction,geometry,distance
sign | A_y = W/2 | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | 8*a*S = 5*W*(3*a + r) | rope_wall,rope,wall,pulley+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,lever,arm,moment+cable,sin,cos,component,lever,arm,distance,direction,factor
right | 2*S = 5*W
right | A_x = W + \frac{4}{5} S
