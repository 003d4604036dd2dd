one_strand | tension(rope) = W + G | rope,string,strand,tension+twice,two,factor,half,second,both,once,missing,forgot,left out,without,absent,not contain,not counted,lost,dropped,overlooked,times too,too large,too small,too much,too little
rope_does_not_lift_man | N_sole = W | rope,string,tension,strand+missing,forgot,left out,omitted,lacks,no part,without,absent,not contain,not counted,lost,dropped,overlooked
pull_on_man_sign | N_sole - tension(rope) = W | rope,string,tension+sign,direction,opposite,down,reaction,third law,wrong way,reversed,other way,minus,wrong sense
strands_on_platform | 3*tension(rope) = W + G | rope,string,tension,strand+twice,two,double,factor,counted,number,extra,times too,too large,too small,too much,too little
axle_one_strand | reaction_y(pulley) = (W + G)/2 + P | rope,string,tension,strand+twice,two,factor,half,second,both,once,missing,forgot,left out,without,absent,not contain,not counted,lost,dropped,overlooked,times too,too large,too small,too much,too little
right | 2*tension(rope) = W + G
right | N_sole = \frac{W - G}{2}
