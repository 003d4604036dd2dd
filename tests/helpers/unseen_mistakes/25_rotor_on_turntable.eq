sign | M_y = -C*phi'*psi' | sign,opposite,direction,reversed,other way,negative,turned round
half | M_y = (C - A)*phi'*psi' | transverse,across,moment of inertia,inertia,factor
noarm | (J + A)*psi'' = tau | rotor,m*l^2,translation,steiner,mass+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected
outward | F_x = m*L*psi'^2 | sign,opposite,direction,reversed,other way,negative,turned round
two | M_O = m*g*L - C*\dot\phi\,\dot\psi | sign,opposite,direction
right | M_O + m*g*L = C*phi'*psi'
right | T = \frac12(J + A + mL^2)\dot\psi^2 + \frac12 C\dot\phi^2
