sign | m1 x1'' + (k1 - k2) x1 + k2 x2 = F | spring,k2,absorber,stiffness+sign,opposite,direction,reversed,other way,negative,turned round,minus,wrong way
missing | m_1\ddot x_1 + k_1 x_1 - k_2 x_2 = F | spring,k2,absorber,x1+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored
relativemass | m_2(\ddot x_1 + \ddot x_2) + k_2(x_2 - x_1) = 0 | absorber,m2,translation,x1''+relative,absolute,too much,coupl,translation,sum,no place,extra,acceleration
frequencysum | frequency(1)^2 + frequency(2)^2 = k1/m1 + k2/m2 | k2/m1,spring,k2,coupl,stiffness,machine+missing,left out,forgotten,lacks,omitted,without,not counted,absent,neglected,forgot,not there,is not in,nothing of,lost,dropped,ignored | kind:frequency
two | V = k1*x1^2/2 + k2*(x1^2 + x2^2)/4 | spring,k2,absorber+relative,difference,mixed,product,coupl,x1*x2+factor,half,1/2,1/4,twice
right | frequency(1)*frequency(2) = sqrt(k1*k2/(m1*m2)) | - | kind:frequency
right | \frac{d^2 x_2}{dt^2} + \frac{k_2}{m_2}(x_2 - x_1) = 0
