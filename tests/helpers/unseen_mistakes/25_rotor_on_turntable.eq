sign | M_y = -C*phi'*psi' | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
half | M_y = (C - A)*phi'*psi' | transverse,across,moment of inertia,inertia,factor
noarm | (J + A)*psi'' = tau | rotor,m*l^2,translation,steiner,mass+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
outward | F_x = m*L*psi'^2 | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | M_O = m g L + (C - A)\dot\phi\,\dot\psi | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+across,transverse,inertia,factor,rotation,spin
right | M_O + m*g*L = C*phi'*psi'
right | T = \frac12(J + A + mL^2)\dot\psi^2 + \frac12 C\dot\phi^2
