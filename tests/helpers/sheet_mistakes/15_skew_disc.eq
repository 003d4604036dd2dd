right | J_x φ¨ = m R^2/4 (1 + cos^2 δ) φ¨ = M_0
right | A_z = \frac{m R^2 \dot\varphi^2 \sin 2\delta}{8 (a + b)}
right | A_z + B_z = 0
right | T = \frac12 \left(\frac{m R^2}{2}\cos^2\delta + \frac{m R^2}{4}\sin^2\delta\right)\dot\varphi^2
right | a A_z - b B_z = 1/4 m R^2 φ'^2 sin δ cos δ
disc_taken_as_straight | T = 1/4 m R^2 φ'^2 | cos,delta,tilt,incl,sin,skew
factor_of_sine_of_double_angle | A_z = m R^2 φ'^2 sin(2 δ)/(4 (a + b)) | factor,2,twice,half
sign_of_other_bearing | A_z = B_z | sign,opposite
sin_for_cos | m R^2/4 (1 + sin^2 δ) φ'' = M_0 | sin,cos
product_of_inertia_forgotten | A_z = 0 | deviation,product,inertia,gyro,Euler,phi'^2,omega,m*
