relative | (M0/3*(a + r)^2 + m*(a + r)^2 + m*a^2/2)*phi'' = tau | planet,own rotation+relative,absolute,angular,spin,turn,rotation,arm
nospin | \left(\frac{M_0}{3} + m\right)(a+r)^2\ddot\varphi = \tau | planet,own,disc+rotation,rotat,turning,spin,inertia+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
armcentre | (M0 + 18 m) (a + r)^2 phi'' = 12 tau | arm,bar,rod+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation
omega | omega(planet) = a*phi'/r | arm,own turn,relative,carried,radius,distance,phi',factor,missing,lacks
two | \left(\frac{M_0}{12}+ 2m\right)(a+r)^2\ddot\varphi = \tau | arm,bar,rod+steiner,parallel,about the cent,about its cent,about the mass,mass centre,about the end,moment of inertia,translation+planet,disc+inertia,factor,ring,1/2,rotation
right | (2*M0 + 9*m)*(a + r)^2*phi'' = 6*tau
right | T = \frac{(a+r)^2}{12}(2M_0 + 9m)\,\dot\varphi^2
