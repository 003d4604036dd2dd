right | E_kin = m l^2 φ˙^2 (1/3 + sin^2 φ)
right | v_C = \dot x_C = -2 l \dot\varphi \sin\varphi
right | U = m g l sin φ + P l sin φ + k/2 (2 l cos φ - l_0)^2
right | 2 m l (1 + 3 sin^2 φ) φ¨ + 3 m l φ˙^2 sin 2φ + 3 (m g + P) cos φ = 6 k (2 l cos φ - l_0) sin φ
right | a_C = -2 l (\ddot\varphi \sin\varphi + \dot\varphi^2 \cos\varphi)
second_rod_as_turning_about_its_end | T = 1/3 m l^2 phi'^2 | sin,BC,second,transl,velocity,centre,center
derivative_of_product | 2 m l^2 (1/3 + sin^2 φ) φ¨ + (m g + P) l cos φ - 2 k l sin φ (2 l cos φ - l0) = 0 | phi'^2,derivative,product,centripetal
spring_preload | 2 m l^2 (1/3 + sin^2 φ) φ¨ + m l^2 φ˙^2 sin 2φ + (m g + P) l cos φ - 4 k l^2 sin φ cos φ = 0 | l0,natural,unstretched,length,rest
heights_of_rods | U = 2 m g l sin φ + P l sin φ + k/2 (2 l cos φ - l0)^2 | half,factor,1/2,centre,center,twice,2 + m,weight,rod
factor_of_speed | v_C = -l \dot\varphi \sin\varphi | factor,2,half,twice
