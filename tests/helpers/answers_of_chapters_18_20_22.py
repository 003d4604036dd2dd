"""What chapters 18, 20 and 22 of the seeds answer, exactly: text of the model file's grammar.

Checked by oracle_of_chapters_18_20_22.py (Newton and Euler); those of the solved systems are the book's, its errata
fixed.
"""

from __future__ import annotations

ANSWERS = {
    "ch18_p1": {
        "theta_dd": "g/(6*R)",
        "a_P": "g/6",
        "v_P_2s": "g/3",
        "y_P_2s": "g/3",
        "T1": "5/3*M*g",
        "T2": "7/6*M*g",
        "V_O": "53/6*M*g",
        "H_O": "0",
    },
    "ch18_p2": {
        "v_B": "2/5*sqrt(3*g*l*(8 + 3*sqrt(3)))",
        "v_B_squared": "12/25*g*l*(8 + 3*sqrt(3))",
        "theta": "pi/3",
        "theta_d_squared": "g/(25*l)*(8 + 3*sqrt(3))",
        "theta_d_squared_general": "g*(3*sin(theta) + 8*(1 - cos(theta)))/(2*l*(1 + 7*sin(theta)^2))",
    },
    "ch18_p3": {
        "a_P": "12/23*g",
        "T1": "44/23*M*g",
        "T2": "32/23*M*g",
        "T3": "26/23*M*g",
        "V_O": "122/23*M*g",
    },
    "ch18_p4": {
        "kinetic_energy": "M*(4*x'^2 + 6*l*cos(phi)*x'*phi' + 4*l^2*phi'^2)",
        "x_dd": "(24*M*l*sin(phi)*phi'^2 + 18*M*g*sin(phi)*cos(phi) - 4*k*(x - l0))/(M*(32 - 18*cos(phi)^2))",
        "phi_dd": "-3*(8*M*g*sin(phi) + 6*M*l*sin(phi)*cos(phi)*phi'^2 - k*(x - l0)*cos(phi))"
        "/(M*l*(32 - 18*cos(phi)^2))",
    },
    "ch18_p5": {
        "v_A": "sqrt(2*g*l*(2*sqrt(2) - 1))",
        "v_A_squared": "2*g*l*(2*sqrt(2) - 1)",
        "v_Q": "0",
    },
    "ch20_p1": {"theta_dd": "2*g/(3*R)", "a_C": "2/3*g", "T": "M*g/3"},
    "ch20_p2": {
        "theta_d_squared": "7*g/(6*l)*sin(theta)",
        "v_A": "sqrt(14/3*g*l)",
        "R1": "79/6*M*g*sin(theta)",
        "R2": "-11/12*M*g*cos(theta)",
        "R1_vertical": "79/6*M*g",
        "R3_vertical": "79/6*M*g",
        "R2_vertical": "0",
        "R4_vertical": "0",
    },
    "ch20_p3": {
        "theta_dd": "g/(28*R)",
        "phi_dd": "5*g/(7*R)",
        "a_P": "g/14",
        "D": "g/7",
        "a_C": "9/14*g",
        "T1": "13/14*M*g",
        "T2": "5/7*M*g",
        "V_O": "107/14*M*g",
    },
    "ch20_p4": {
        "theta_d_squared": "3*g*(1 - cos(theta))/(R*(3 + 10*cos(theta)^2))",
        "v_B": "0",
        "omega_disc_end": "sqrt(g/R)",
        "H_O": "-13/2*M*g",
        "V_O": "5*M*g",
        "N_B": "9/4*M*g",
    },
    "ch20_p5": {
        "a_P": "-g/13",
        "z_dd": "3/13*g",
        "T1": "56/13*M*g",
        "T2": "57/13*M*g",
        "T3": "15/13*M*g",
        "T4": "18/13*M*g",
        "V_O": "139/13*M*g",
    },
    "ch20_p6": {
        "y_dd": "g + 12*l*cos(phi)*phi'^2/(14 - 9*sin(phi)^2)",
        "phi_dd": "9*sin(phi)*cos(phi)*phi'^2/(14 - 9*sin(phi)^2)",
        "N_P": "-30*M*l*sin(phi)*phi'^2/(14 - 9*sin(phi)^2)",
    },
    "ch22_p1": {
        "kinetic_energy": "6*M*R^2*theta'^2 + 27/2*M*R^2*cos(theta)^2*theta'^2",
        "Q_theta": "6*M*g*R*sin(theta)",
        "theta_dd": "(2*g/R*sin(theta) + 9*theta'^2*sin(theta)*cos(theta))/(4 + 9*cos(theta)^2)",
        "omega_disc": "3*theta'*cos(theta)",
        "N_A": "30*M*sin(theta)*(g*cos(theta) - 2*R*theta'^2)/(4 + 9*cos(theta)^2)",
    },
    "ch22_p2": {
        "kinetic_energy": "2*M*l^2*theta'^2 + M*(r'^2 + r^2*theta'^2)",
        "Q_theta": "(3*l + 2*r)*M*g*cos(theta)",
        "Q_r": "2*M*g*sin(theta)",
        "N_P": "M*l*(g*cos(theta)*(4*l - 3*r) - 8*l*r'*theta')/(2*l^2 + r^2)",
    },
    "ch22_p3": {
        "kinetic_energy": "6*M*a^2*theta'^2 + 2*M*a^2*phi'^2",
        "Q_theta": "-a*(6*M*g*sin(theta) + k*a*sin(theta)*cos(theta) + 6*k*a*(3*sin(theta) + 2*sin(phi))*cos(theta))",
        "Q_phi": "-a*(3*M*g*sin(phi) + 4*k*a*(3*sin(theta) + 2*sin(phi))*cos(phi))",
    },
    "ch22_p4": {
        "kinetic_energy": "91/8*M*R^2*theta'^2",
        "theta_dd": "4/13*g/R",
        "a_P": "8/13*g",
        "v_P_of_h": "4*sqrt(g*h/13)",
        "v_P_of_t": "8/13*g*t1",
        "T1": "20/13*M*g",
        "T2": "16/13*M*g",
        "T3": "14/13*M*g",
    },
    "ch22_p5": {
        "kinetic_energy": "M*(3*x'^2 + 6*R*cos(theta)*x'*theta' + 8*R^2*theta'^2)",
        "x_dd": "sin(theta)*(8*R*theta'^2 + 3*g*cos(theta))/(8 - 3*cos(theta)^2)",
        "theta_dd": "-3*sin(theta)*(R*cos(theta)*theta'^2 + g)/(R*(8 - 3*cos(theta)^2))",
        "N_ground": "M*(30*R*cos(theta)*theta'^2 + 25*g - 3*g*sin(theta)^2)/(8 - 3*cos(theta)^2)",
        "F_friction": "-M*sin(theta)*(8*R*theta'^2 + 3*g*cos(theta))/(8 - 3*cos(theta)^2)",
    },
}
"""Every output that chapters 18, 20 and 22 ask for; theta'^2 and what hangs on it from rest, by the energy theorem."""

LINEARIZED = {
    "ch22_p3": {
        "K11": "6*M*g*a + 19*k*a^2",
        "K12": "12*k*a^2",
        "K22": "3*M*g*a + 8*k*a^2",
        "M11": "12*M*a^2",
        "M22": "4*M*a^2",
        "omega1_squared": "(15*M*g + 43*k*a - sqrt((3*M*g + 5*k*a)^2 + 1728*k^2*a^2))/(24*M*a)",
        "omega2_squared": "(15*M*g + 43*k*a + sqrt((3*M*g + 5*k*a)^2 + 1728*k^2*a^2))/(24*M*a)",
    },
    "ch22_p6": {
        "omega1_squared": "(5 - sqrt(7))/3*k/M",
        "omega2_squared": "(5 + sqrt(7))/3*k/M",
    },
}
"""Outputs of the small oscillations."""
