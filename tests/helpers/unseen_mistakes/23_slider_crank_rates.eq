chain | v = -r*w*sin(phi) - 2*r^2*w*sin(phi)*cos(phi)/sqrt(l^2 - r^2*sin(phi)^2) | root,rod,second,half,factor,1/2,twice,derivative,chain,sqrt,term
norod | v = -r w sin(phi) | rod,sqrt,root,second,turn+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,constant
rodsign | \omega(conrod) = \frac{r w\cos\phi}{\sqrt{l^2 - r^2\sin^2\phi}} | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
rodangle | omega(conrod) = -r/l*w*cos(phi) | rod,cos,small,root,sqrt,inclin,length,of l,in l,by l,at l,on l,for l,with l,approxim
two | a = -r w^2 \cos\phi + \frac{r^2 w^2}{l}\cos\phi | term,second,rod+sign,opposite,negative,cos,double,2*phi,angle,small,approxim
right | v = -r w\sin\phi\left(1 + \frac{r\cos\phi}{\sqrt{l^2 - r^2\sin^2\phi}}\right)
right | a = -r*w^2*(1 + r/l) | - | at:phi = 2*pi
