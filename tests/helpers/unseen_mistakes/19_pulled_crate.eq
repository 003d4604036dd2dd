normal | m x'' = F cos(beta) - mu m g | normal,friction,of n,in n,by n,at n,on n,for n,with n+rope,pull,f*sin,lift,missing,of f,in f,by f,at f,on f,for f,with f
press | m\ddot{x} = F\cos\beta - \mu(mg + F\sin\beta) | normal,friction,rope+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
frictionsign | x'' = F/m*cos(beta) + mu*(g - F/m*sin(beta)) | friction+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
incline | N = m*g*cos(beta) - F*sin(beta) | weight,gravity,m*g+cos,angle,component,factor
two | m \ddot x = F\sin\beta - \mu m g | sin,cos,component,axis,angle,swapped+normal,friction,lift,of n,in n,by n,at n,on n,for n,with n
right | \ddot{x} = \frac{F}{m}(\cos\beta + \mu\sin\beta) - \mu g
right | N + F*sin(beta) = m*g
