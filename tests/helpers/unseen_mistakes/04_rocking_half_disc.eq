steiner | (3/2 R^2 + e^2 - 2 R e cos(theta)) theta'' + R e sin(theta) theta'^2 + g e sin(theta) = 0 | steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation,inertia
sign | m\left(\frac{3}{2}R^2 + 2Re\cos\theta\right)\ddot\theta - mRe\sin\theta\,\dot\theta^2 + mge\sin\theta = 0 | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+cos,translation,mixed,velocity,position,centre,cross,coupl,2*r
nosquare | m*(3*R^2/2 - 2*R*e*cos(theta))*theta'' + m*g*e*sin(theta) = 0 | theta'^2,square,derivative,centripetal,product,rate+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
arc | T = \frac12 m\left(\frac32 R^2 - \frac{4R^2}{\pi}\cos\theta\right)\dot\theta^2 | centre,centroid,position,place,distance,4/(3,factor,translation,lever,arm,velocity
two | \left(\frac32R^2 - 2Re\right)\ddot\theta = g e\,\theta | small,linear,cos,sin,approxim+weight,gravity+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | frequency(1)^2 = 2*g*e/(R*(3*R - 4*e)) | - | kind:frequency
right | \left(\frac{3}{2}R^2 - \frac{8R^2}{3\pi}\cos\theta\right)\ddot\theta = -\frac{4R}{3\pi}(g + R\dot\theta^2)\sin\theta
