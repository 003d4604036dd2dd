norolling | C*psi'' = drive_torque | m*r^2,translation,rolling,mass,constraint,tie,friction,multiplier,x''+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
product | \ddot x = R\cos\phi\,\ddot\psi | product,phi',turning,centripetal,sin,derivative,rate+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
swap | y'' = R*sin(phi)*psi'' - R*cos(phi)*phi'*psi' | phi'*psi',product,derivative,rate,cos+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
factor | T = \frac12 m R^2\dot\psi^2 + \frac12 C\dot\psi^2 + \frac12 (A + mR^2)\dot\phi^2 | phi',heading,steer,vertical,turn+m*r^2,translation,steiner,twice,too much,rotation,inertia
two | (2*C + m*R^2)*psi'' = R*drive_torque | of c,in c,by c,at c,on c,for c,with c,rotation,inertia,spin+factor,twice,half,1/2,double+torque,drive,moment,force+factor,of r,in r,by r,at r,on r,for r,with r,lever,dimension,radius
right | (C + m R^2)\ddot\psi = drive_torque
right | x'' + R*psi'*phi'*sin(phi) = R*psi''*cos(phi)
