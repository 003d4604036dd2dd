"""Chapters 11, 13, 21 and the inertia of the notes: what `solve` must answer, as text of the model file's grammar.

The answers of the solved exercises are the book's, its errata mended and with pi in the place of its 3; those of the
others are by hand. tests/seed_oracle_d.py finds all of them once more, in numbers.
"""

from __future__ import annotations

CORNER = {"Ik_xx": "M*(b^2 + c^2)/3", "Ik_yy": "M*(a^2 + c^2)/3", "Ik_zz": "M*(a^2 + b^2)/3"}
NET = "M*a^2/(90 - pi)"  # ch13-p2: the mass of an area a^2 of the plate, times a^2

ANSWERS: dict[str, dict[str, str]] = {
    "ch11_p1": {
        "c01_x": "0", "c01_y": "0",
        "c12_x": "5", "c12_y": "3",
        "c02_x": "7", "c02_y": "21/5",
        "y2": "6/5",
        "omega2_over_omega1": "-5/2",
    },
    "ch11_p2": {
        "c01_x": "0", "c01_y": "0",
        "c02_x": "8", "c02_y": "0",
        "c12_x": "-10", "c12_y": "0",
        "omega2_over_omega1": "5/9",
    },
    "ch11_p3": {
        "y2": "15/2",
        "c02_x": "9", "c02_y": "27/2",
        "c13_x": "0", "c13_y": "6",
        "omega1": "-2", "omega2": "8/5", "omega3": "0",
        "v_A_x": "12", "v_A_y": "-8",
        "v_B_x": "12", "v_B_y": "0",
    },
    "ch11_p4": {
        "x2": "2", "y3": "2",
        "omega1": "4", "omega2": "-5", "omega3": "-10/3",
        "v_B_x": "-20", "v_B_y": "20",
        "v_C_x": "0", "v_C_y": "20",
        "v_D_x": "0", "v_D_y": "10",
        "v_E_x": "-20", "v_E_y": "0",
        "v_F_x": "-30", "v_F_y": "0",
    },
    "ch11_p5": {
        "c02_x": "9", "c02_y": "12",
        "omega2": "-3/2", "omega3": "3",
        "v_A_x": "-12", "v_A_y": "9",
        "v_B_x": "-12", "v_B_y": "0",
        "v_M_x": "-9", "v_M_y": "9/2",
    },
    "ch11_p6": {
        "omega2": "1", "omega3": "9/14", "omega4": "-6/7",
        "v_A_x": "4", "v_A_y": "-4",
        "v_B_x": "6", "v_B_y": "0",
        "v_C_x": "24/7", "v_C_y": "18/7",
    },
    "ch13_b1": {"J_x": "0", "J_y": "M*l^2/12", "J_C": "M*l^2/12", "J_xy": "0"},
    "ch13_b2": {"J_x": "M*h^2/12", "J_y": "M*b^2/12", "J_C": "M*(b^2 + h^2)/12", "J_xy": "0"},
    "ch13_b3": {
        "J_x1": "M*h^2/6", "J_y1": "M*b^2/6", "J_x1y1": "M*b*h/12",
        "J_x": "M*h^2/18", "J_y": "M*b^2/18", "J_xy": "-M*b*h/36", "J_C": "M*(b^2 + h^2)/18",
    },
    "ch13_b4": {"J_C": "M*R^2/2", "J_x": "M*R^2/4", "J_y": "M*R^2/4", "J_xy": "0"},
    "ch13_p1": {
        "M2": "72*m_plate/(72 - pi)",
        "M3": "pi*m_plate/(72 - pi)",
        "J_O": "10000*a^2*(12*m_bar + m_plate*(11448 - 451/2*pi)/(72 - pi))",
    },
    "ch13_p2": {
        "M1": "72*M/(90 - pi)", "M2": "18*M/(90 - pi)", "M3": "pi*M/(90 - pi)",
        "J_x": f"{NET}*(3888 - 37/4*pi)",
        "J_y": f"{NET}*(1755 - 37/4*pi)",
        "J_xy": f"{NET}*(9*pi - 1782)",
        "J_Delta": f"{NET}*(756 - 41/20*pi)",
    },
    "ch13_p3": {"J_O": "10000*(m_bar*l^2/3 + m_ring*((R^2 + r^2)/2 + d^2))"},
    "ch13_p4": {"J_x": "141/14*M*a^2", "J_y": "141/14*M*a^2", "J_xy": "27/4*M*a^2", "J_Delta": "93/28*M*a^2"},
    "ch21_p1": {"V_A": "-9*p*a", "V_B": "18*p*a", "V_E": "7*p*a", "M_E": "20*p*a^2", "H_E": "0"},
    "ch21_p2": {"V_A": "6*p*a", "M_A": "16*p*a^2", "V_C": "7*p*a", "V_E": "3*p*a"},
    "ch21_p3": {"V_A": "7*p*a", "H_A": "16/3*p*a", "V_B": "7*p*a", "H_B": "8/3*p*a", "M_B": "20*p*a^2"},
    "ch21_p4": {"V_A": "19/5*p*a", "H_A": "9/5*p*a", "V_B": "31/5*p*a", "H_B": "-24/5*p*a"},
    "ch21_p5": {
        "N79": "22*P",
        "N69": "-11/2*sqrt(2)*P",
        "N89": "-11/2*P",
        "N89_if_12P_at_joint9": "13/2*P",
        "N9_10": "55/4*P",
        "R1_x": "3*P", "R1_y": "11*P", "R13_y": "11*P",
    },
    "ch21_p6": {
        "N24": "-21/2*P", "N25": "5/2*P", "N35": "9*P", "N45": "0", "N56": "35/4*P",
        "R8_y": "7*P", "R1_y": "8*P", "R1_x": "-3*P",
    },
    "s1_inertia_tensor": {
        "Ic_xx": "M*(b^2 + c^2)/12", "Ic_yy": "M*(a^2 + c^2)/12", "Ic_zz": "M*(a^2 + b^2)/12",
        **CORNER,
        "Ik_xy": "-M*a*b/4", "Ik_xz": "-M*a*c/4", "Ik_yz": "-M*b*c/4",
    },
    "s1_particles": {
        "I_xx": "6*m*a^2", "I_yy": "5*m*a^2", "I_zz": "5*m*a^2",
        "I_xy": "-m*a^2", "I_xz": "-m*a^2", "I_yz": "-2*m*a^2",
        "L_x": "-m*a^2*omega0", "L_y": "-2*m*a^2*omega0", "L_z": "5*m*a^2*omega0",
        "T": "5/2*m*a^2*omega0^2",
    },
    "s1_parallel_axis": {"I_edge": "2/3*M*a^2", "I_diagonal": "M*a^2/6", "I_centre": "M*a^2/6"},
    "s1_principal_axes": {
        "I_xx": "M*a^2/3", "I_xy": "-M*a^2/4",
        "I_1": "M*a^2/12", "I_2": "7/12*M*a^2", "I_3": "2/3*M*a^2",
    },
}  # fmt: skip

AS_PRINTED = {  # where the shape of the text matters too: no float, no root of a square, nothing left to cancel
    ("ch11_p1", "c02_y"): "21/5",
    ("ch11_p4", "omega3"): "-10/3",
    ("ch21_p1", "M_E"): "20*p*a^2",
    ("ch21_p3", "H_A"): "16/3*p*a",
    ("ch21_p3", "V_A"): "7*p*a",
    ("ch21_p4", "V_A"): "19/5*p*a",
    ("ch21_p5", "N69"): "-11/2*sqrt(2)*P",
    ("ch21_p5", "N9_10"): "55/4*P",
    ("ch21_p6", "N45"): "0",
    ("s1_principal_axes", "I_2"): "7/12*M*a^2",
}
