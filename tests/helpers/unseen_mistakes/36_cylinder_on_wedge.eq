relative | (3/2)*s'' = g*sin(alpha) | wedge,x'',relative,coupl,moves,translation,of x,in x,by x,at x,on x,for x,with x+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
norot | s'' + X'' cos(alpha) = g sin(alpha) | rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,factor
sign | (M + m)\ddot X - m\ddot s\cos\alpha = 0 | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
normal | reaction_n(face) = m*g*cos(alpha) | wedge,acceleration,x''+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
two | (M + m)\ddot X + m\ddot s\sin\alpha = m g\cos\alpha\sin\alpha | sin,cos,component,swapped,axis+weight,gravity,normal,internal,reaction,left in,m*g
right | \ddot{X} = -\frac{m g\sin 2\alpha}{3(M + m) - 2m\cos^2\alpha}
right | reaction_n(face) = m*(g*cos(alpha) + X''*sin(alpha))
