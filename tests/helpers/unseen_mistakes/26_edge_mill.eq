noroll | (A + m*b^2)*psi'' = tau | runner,of c,in c,by c,at c,on c,for c,with c,axle,roll,spin+rotation,missing,left out,inertia,spin
noown | \left(\frac{Cb^2}{r^2} + mb^2\right)\ddot\psi = \tau | runner,across,own,vertical,turn+rotation,rotat,turning,spin,inertia,missing
gyrosign | M_gyro = C*b*psi'^2/r | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
spinonly | w_run = b\dot\psi/r | shaft,psi',turn,precession,carried,vertical,own,component,vector,resultant
two | T = \frac12\left(\frac{Cb}{r} + mb^2\right)\dot\psi^2 | of c,in c,by c,at c,on c,for c,with c,roll,spin,rotation,runner+square,factor,ratio,dimension,radius,velocity+across,own,vertical,turn
right | T = \frac{\dot\psi^2}{2 r^2}\left(b^2 C + r^2 A + m b^2 r^2\right)
right | F_x = -m*b*psi'^2
