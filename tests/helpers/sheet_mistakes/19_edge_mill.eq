right | N = m g + \frac{1}{2} m R \Omega^2
right | E_kin = m Ω^2 (3/4 a^2 + 1/8 R^2)
right | (N - m g) a = \frac{m R^2}{2}\cdot\frac{a\Omega}{R}\cdot\Omega
right | A_z = m g - N = -m R Ω^2/2
right | N = 5.36 kN
gyroscopic_moment_forgotten | N = m g | gyro,Omega,spin,angular momentum,inertia
gyroscopic_sign | N = m g - m R Ω^2/2 | sign,opposite
turning_about_the_vertical_forgotten | E_kin = 1/2 m a^2 Ω^2 + 1/4 m a^2 Ω^2 | R^2,vertical,diameter,turning,rotat,inertia
inertia_about_diameter | N = m g + m R Ω^2/4 | factor,2,half,inertia,twice
centrifugal_force_as_reaction | A_x = m a Ω^2 | sign,opposite,centri
