rope_moment | tension(strut)*b*h/sqrt(b^2 + h^2) + W*(L + r) = 0 | rope,W,horizontal,tension,strand,pulley+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,arm,lever,distance,point,place,where it acts,position,moment
strut_sense | A_y = W + \frac{W L}{b} | strut,A_y,tension+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against
two_strands_down | A_y = 2*W + tension(strut)*h/sqrt(b^2 + h^2) | W,load,rope,strand,tension+factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large,direction,down,horizontal,extra
strut_arm | tension(strut) = -W*L/b | strut,tension+arm,lever,distance,point,place,where it acts,position,moment,sine,cosine,sin(,cos(,sin and cos,component,axis,projection,resolved,projected,angle,direction,across,along
like_a_clamp | A_x = W | strut,tension+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,clamp
right | h*A_x = W*(h + r) - W*(L + r)
right | A_y = W\left(1 - \frac{L}{b}\right)
