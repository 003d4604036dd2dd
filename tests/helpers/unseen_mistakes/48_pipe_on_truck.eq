solid | \ddot s = -\frac{2}{3}A | pipe,rotation,inertia+factor,disc,ring,hoop,half,1/2,solid
norot | s'' = -A | rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,factor
notruck | 2*s'' = 0 | truck,relative,x'',acceleration+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
absolute | a_pipe = \ddot{s} | truck,x'',relative,absolute,acceleration+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,relative
two | friction = -\frac{mA}{3} | sign,opposite,direction+factor,inertia,rotation,disc,ring,solid,pipe
right | a_pipe = A/2
right | friction = -m\ddot{s}
