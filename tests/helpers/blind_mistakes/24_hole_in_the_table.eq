centripetal | (m1 + m2)*r'' = -m2*g | centrifugal,centripetal,phi'^2,dT/dr,r*phi+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop
centrifugal_sign | (m_1 + m_2) \ddot r + m_1 r \dot\phi^2 + m_2 g = 0 | centrifugal,centripetal,phi'^2,dT/dr,r*phi+sign,opposite,reversed,wrong way,other way,other direction,wrong direction,other side,turned round,against
as_a_circle | T_string = m1*r*phi'^2 | r'',radial,weight,load,m2,inertia,acceleration,gravity+missing,left out,leaves out,forgotten,forgot,absent,omitted,without,neglect,ignored,not counted,not taken,not there,lacks,lacking,dropped,factor 0,times 0,is not in,does not occur,lost,drop,circle,circular,constant,at rest,steady
coriolis_once | r*phi'' + r'*phi' = 0 | coriolis,r'*phi',phi'*r'+factor,half,halved,1/2,times 0.5,too little,too small,factor,twice,two times,doubled,double,times 2,2 times,counted 2,too much,too large
load_turns_too | T = (m_1 + m_2) \frac{\dot r^2 + r^2 \dot\phi^2}{2} | m2,load+extra,turns,phi',rotat,circ,too much,factor
right | r^2*phi' = 3
right | tension(string) = m1*m2*(g + r*phi'^2)/(m1 + m2)
