absolutedamper | m z'' + c z' + k (z - y - l0) = -m g | damp,shock+relative,y',road,wheel,missing,velocity
chain | m\ddot z + c\dot z + kz = cY\cos(wt) + kY\sin(wt) + kl_0 - mg | damp,shock,y',derivative,of w,in w,by w,at w,on w,for w,with w,chain+factor,of w,in w,by w,at w,on w,for w,with w,derivative,missing,y',rate,chain
nostretch | m*z'' + c*(z' - y') + k*(z - y) = -m*g | spring,strut+l0,natural,length,stretch,missing
roadsign | m*z'' = -c*(z' + y') - k*(z + y - l0) - m*g | of y,in y,by y,at y,on y,for y,with y,road,wheel+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way,sum,difference
two | m\ddot z = -c(\dot z - \dot y) + k(z - y - l_0) + mg | spring,strut+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way+weight,gravity
right | m z'' + c z' + k z = Y*(c*w*cos(w*t) + k*sin(w*t)) + k*l0 - m*g
right | \ddot z = \frac{k(l_0 + y - z) + c(\dot y - \dot z)}{m} - g
