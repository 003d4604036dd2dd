notruck | v_x = u*cos(beta) - s*w*sin(beta) | truck,x',v0,v_0,support,base+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,relative
coriolis | a_x = -s w^2\cos\beta - u w\sin\beta | coriolis,product of,mixed,2*,r'*theta',rates,both rates,of u,in u,by u,at u,on u,for u,with u+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
coriolismissing | a_y = -s*w^2*sin(beta) | coriolis,product of,mixed,2*,r'*theta',rates,both rates,s',of u,in u,by u,at u,on u,for u,with u+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
sign | v_y = u \sin\beta - s w\cos\beta | sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
two | a_y = s*w^2*sin(beta) + u*w*cos(beta) | centripetal,centrifugal,normal accel,'^2,square,rate,w^2,s*w^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+coriolis,product of,mixed,2*,r'*theta',rates,both rates,of u,in u,by u,at u,on u,for u,with u+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
right | v_x^2 + v_y^2 = v0^2 + u^2 + s^2*w^2 + 2*v0*(u*cos(beta) - s*w*sin(beta))
right | a_y = 2 u w\cos\beta - s w^2\sin\beta
