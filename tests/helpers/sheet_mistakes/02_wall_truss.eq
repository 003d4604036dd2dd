right | S_{AC} = S_{CE} = F
right | \sum M_A = 0: B_x \cdot a - P \cdot a - F \cdot 2a = 0
right | S_AD = \sqrt{2} (P + F) = 22.6 kN
right | S_CD + S_DE sin(45°) + S_AD sin(45°) = 0
right | S_BD a + 2 F a + P a = 0
compression_as_tension | S_DE = F \sqrt{2} | sign,opposite,compression,direction
load_forgotten_in_cut | S_AD sin 45° - F = 0 | P,load,middle
lever_wrong | B_x a - P a - F a = 0 | lever,arm,distance,moment,factor,2,half,twice + F,tip
bar_forgotten_at_node | S_BD = S_DE cos 45° | AD,A-D,member,bar
vertical_shared_by_roller | A_y = (P + F)/2 | half,factor,2,1/2,support,twice
