supportsign | l phi'' + (g - y'') sin(phi) = 0 | support,y'',coupl,shak,translation,driven,of y,in y,by y,at y,on y,for y,with y+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
fixedsupport | \ddot\phi = -\frac{g}{l}\sin\phi | support,y'',coupl,shak,driven,of y,in y,by y,at y,on y,for y,with y+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
chain | l\ddot\phi + \left(g - a\gamma\cos(\gamma t)\right)\sin\phi = 0 | support,y'',shak,driven,gamma,of y,in y,by y,at y,on y,for y,with y+gamma,derivative,chain,square,factor
tension | S = m*g*cos(phi) + m*l*phi'^2 | support,y'',shak,driven,of y,in y,by y,at y,on y,for y,with y+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
two | S = m (g + y'') \sin(phi) - m l φ̇^2 | sin,cos,component,axis,swapped+centripetal,centrifugal,normal accel,'^2,square,rate,phi'^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | l\ddot\phi + (g - a\gamma^2\cos(\gamma t))\sin\phi = 0
right | T = \frac{m}{2}\left(l^2\dot\phi^2 + 2 l\dot\phi\dot y\sin\phi + \dot y^2\right)
