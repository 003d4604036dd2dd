turning | (I + m l^2) theta'' + m g l sin(theta) = 0 | box,of i,in i,by i,at i,on i,for i,with i,inertia+rotation,turn,translat,own,inertia,no place,too much
longer | (l + h)\ddot\theta + g\sin\theta = 0 | length,distance,radius,of h,in h,by h,at h,on h,for h,with h,path,lever,translation,centre
equal | T1 = m*(g*cos(theta) + l*theta'^2)/2 | of h,in h,by h,at h,on h,for h,with h,moment,equal,lever,other,share,place,t2,missing,term
static | T1 + T2 = m*g | centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2,acceleration,speed+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored | at:theta = 0
two | T_1 + T_2 = m g\sin\theta - m l\dot\theta^2 | weight,gravity+sin,cos,component,axis,swapped+centripetal,centrifugal,normal accel,'^2,square,rate,theta'^2+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
right | T1 + T2 = m*g*(3 - 2*cos(theta_0)) | - | at:theta = 0
right | T_1 (c\cos\theta - h\sin\theta) = T_2 (c\cos\theta + h\sin\theta)
