nocentrifugal | m*s'' + k*(s - s0) = 0 | centrifugal,centripetal,turning,omega^2,transport,disc,phi'+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
offset | reaction_n(slider) = 2*m*Omega*s' | centripetal,centrifugal,of b,in b,by b,at b,on b,for b,with b,offset,transport,omega^2+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
half | reaction_n(slider) = m\Omega\dot s - m\Omega^2 b | coriolis,2*+factor,half,1/2,twice,double,times,halved,doubled,too large,too small
stretch | m\ddot{s} = m\Omega^2 s - k s | spring,stretch,natural,rest,s0+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored,length,from
two | m s'' + m Omega^2 s + k (s + s0) = 0 | centrifugal,centripetal,omega^2,turning,transport+sign,opposite,direction+spring,natural,rest,s0,stretch
right | T = m/2*((s' - Omega*b)^2 + Omega^2*s^2)
right | \ddot{s} = \left(\Omega^2 - \frac{k}{m}\right)s + \frac{k}{m}s_0
