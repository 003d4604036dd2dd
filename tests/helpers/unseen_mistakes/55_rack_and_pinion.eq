noratio | (mR + J/r^2 + ml)*x'' + k*x + ml*g = 0 | load,ml,m_l+ratio,rho,radius,of r,in r,by r,at r,on r,for r,with r,velocity,geometry,factor
inverted | \left(m_R + \frac{J}{r^2} + m_l\frac{r^2}{\rho^2}\right)\ddot x + kx + m_l g\frac{r}{\rho} = 0 | load,ml,m_l+ratio,rho,radius,of r,in r,by r,at r,on r,for r,with r,inver,velocity,geometry,factor
drumradius | (mR + J/rho^2 + ml*rho^2/r^2)*x'' + k*x + ml*g*rho/r = 0 | shaft,pinion,drum,of j,in j,by j,at j,on j,for j,with j+radius,ratio,rho,rotation,angular,factor,moment of inertia
weightmass | (mR + J/r^2 + ml*g*rho^2/r^2)*x'' + k*x + ml*g*rho/r = 0 | load,ml,m_l+weight,mass,factor,dimension,unit,of g,by g
two | (mR r^2 + ml rho^2) x'' + k x r^2 - ml g rho r = 0 | shaft,pinion,drum,of j,in j,by j,at j,on j,for j,with j,rotation+load,weight,gravity+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | S = m_l\left(g + \frac{\rho}{r}\ddot x\right)
right | (m_R r^2 + J + m_l\rho^2)\,\ddot x = -r\,(k x r + m_l g\rho)
