noproduct | (1 + x^2/p^2)*x'' + g*x/p = 0 | x'^2,curvature,derivative,product,chain,centripetal,y''+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
slope | m\ddot{x} + \frac{2x}{p}m(\ddot y + g) = 0 | slope,normal,multiplier,reaction,wire,constraint,tie,factor,weight+factor,derivative,slope,twice,of 2,in 2,by 2,at 2,on 2,for 2,with 2,half
static | multiplier(wire) = m*g/(1 + x^2/p^2) | x'^2,centripetal,curvature,acceleration,velocity+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
weightsign | m x'' = -m (y'' - g) x/p | weight,gravity,gravit,m*g+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | (p^2 + x^2)\ddot x - x\dot x^2 + g x = 0 | x'^2,centripetal,curvature+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+weight,gravity,gravit,m*g+factor,of p,in p,by p,at p,on p,for p,with p,dimension,slope,missing
right | \ddot x = -\frac{x\,(\dot x^2 + g p)}{p^2 + x^2}
right | multiplier(wire) = m*p*(g*p + x'^2)/(p^2 + x^2)
