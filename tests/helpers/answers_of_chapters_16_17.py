"""Chapters 16 and 17: what `eomgen solve` must answer, as text of the model file's grammar.

The answers of the solved exercises are the book's, its errata fixed, those of the unsolved ones by hand; all are
derived once more in oracle_of_chapters_16_17.py, and the tests compare the two. Where there is no closed form in the
grammar (the landing against the air's resistance needs Lambert's W) the number at the file's parameters stands here.
"""

from __future__ import annotations

V_B = "(v0^2 + 2*g*L*(sin(alpha) - mu*cos(alpha)))"  # squared, at the end of the plane
V_C = f"({V_B} + 2*g*R*(1 - cos(alpha)))"
V_D = f"({V_B} - 2*g*R*cos(alpha))"

DOWN_A_ROUGH_PLANE = {
    "v_B": f"sqrt({V_B})",
    "v_C": f"sqrt({V_C})",
    "v_D": f"sqrt({V_D})",
    "N_B_before": "m*g*cos(alpha)",
    "N_B_after": f"m*g*cos(alpha) + m/R*{V_B}",
    "N_C": f"m*g + m/R*{V_C}",
    "N_D": f"m/R*{V_D}",
}

ANSWERS: dict[str, dict[str, str]] = {
    "ch16_p1": {
        "t_B": "sqrt(2*H/g)",
        "x_B": "v0*sqrt(2*H/g)",
        "v_Bx": "v0",
        "v_By": "-sqrt(2*g*H)",
        "v_B": "sqrt(v0^2 + 2*g*H)",
    },
    "ch16_p2": {
        "t_max": "log(1 + k*v0*sin(alpha)/g)/k",
        "h_max": "v0*sin(alpha)/k - g/k^2*log(1 + k*v0*sin(alpha)/g)",
        "k_t_B": "0.53003631665405068643",
        "x_B": "29.091533064226928802",
        "v_Bx": "8.3238290108855647277",
        "v_By": "-11.856145708150235681",
    },
    "ch16_p3": {
        "h_max": "R*(v0^2 - g*R + sqrt(g^2*R^2 - v0^2*(2*g*R - v0^2)*cos(alpha)^2))/(2*g*R - v0^2)",
    },
    "ch16_p4": {
        "T": "3*m*g*cos(theta) - 2*m*g + m*v0^2/l",
        "theta_d_squared": "v0^2/l^2 - 2*g/l*(1 - cos(theta))",
        "v_60": "sqrt(v0^2 - g*l)",
        "T_60": "m*v0^2/l - m*g/2",
        "v0_full_circle": "sqrt(5*g*l)",
        "cos_theta_slack": "(2*g*l - v0^2)/(3*g*l)",
        "theta_dd": "-g/l*sin(theta)",
    },
    "ch16_p5": {name: text.replace(" - mu*cos(alpha)", "") for name, text in DOWN_A_ROUGH_PLANE.items()},
    "ch16_p6": {
        "x_dd_up": "-g*(sin(alpha) + mu*cos(alpha))",
        "t_stop": "v0/(g*(sin(alpha) + mu*cos(alpha)))",
        "x_stop": "v0^2/(2*g*(sin(alpha) + mu*cos(alpha)))",
        "F_f_max": "mu*m*g*cos(alpha)",
        "weight_component": "m*g*sin(alpha)",
        "stays": "1 - max(0, sign(sin(alpha) - mu*cos(alpha)))",
        "s_dd_down": "g*(sin(alpha) - mu*cos(alpha))",
        "v_return_to_A": "v0*sqrt((sin(alpha) - mu*cos(alpha))/(sin(alpha) + mu*cos(alpha)))",
    },
    "ch16_p7": DOWN_A_ROUGH_PLANE,
    "ch17_p1": {
        "x_C": "v0*t1*cos(alpha)",
        "y_C": "R + v0*t1*sin(alpha) - g*t1^2/2",
        "theta": "omega0*t1",
        "trajectory_y": "R + x1*tan(alpha) - g*x1^2/(2*v0^2*cos(alpha)^2)",
    },
    "ch17_p2": {
        "omega": "(v_B - v_A)/(2*l)",
        "v_C_y": "(v_A + v_B)/2 - 2*g",
        "v_B_x": "-(v_B - v_A)/2*sin((v_B - v_A)/l)",
        "v_B_y": "(v_A + v_B)/2 - 2*g + (v_B - v_A)/2*cos((v_B - v_A)/l)",
        "v_B": "sqrt(((v_B - v_A)/2)^2 + ((v_A + v_B)/2 - 2*g)^2"
        " + (v_B - v_A)*((v_A + v_B)/2 - 2*g)*cos((v_B - v_A)/l))",
    },
    "ch17_p3": {
        "theta_d_squared": "3*g/l*sin(theta)",
        "v_A": "sqrt(3*g*l)",
        "R_rho": "5/2*M*g*sin(theta)",
        "R_n": "M*g*cos(theta)/4",
        "R_rho_vertical": "5/2*M*g",
        "R_n_vertical": "0",
        "theta_dd": "3*g/(2*l)*cos(theta)",
    },
    "ch17_p4": {
        "theta_d_squared": "6*g*(1 - cos(theta))/(l*(1 + 3*sin(theta)^2))",
        "x_C": "0",
        "v_A_45": "sqrt(30 - 15*sqrt(2))/5*sqrt(g*l)",
        "N_A_45": "2/25*(11 - 6*sqrt(2))*M*g",
        "theta_dd_45": "(33*sqrt(2) - 36)/25*g/l",
        "N_A": "M*g*(4 - 6*cos(theta) + 3*cos(theta)^2)/(1 + 3*sin(theta)^2)^2",
    },
    "ch17_p5": {
        "theta_sep": "acos(2/3)",
        "theta_d_squared": "3*g/(2*l)*(1 - cos(theta))",
        "N_wall": "9/4*M*g*sin(theta)*(3*cos(theta) - 2)",
        "N_floor": "3/4*M*g*(1 - 3*cos(theta))^2",
        "theta_d_squared_at_sep": "g/(2*l)",
        "N_floor_at_sep": "3/4*M*g",
    },
    "ch17_p6": {
        "v_A": "sqrt(2*g*l)",
        "T1": "3*M*g",
        "T2": "3*M*g",
        "T_general": "3*M*g*sin(theta)",
        "theta_d_squared": "2*g/l*sin(theta)",
    },
}

NUMBERS_ONLY = {("ch16_p2", name) for name in ("k_t_B", "x_B", "v_Bx", "v_By")}
"""Outputs without a closed form: their text above is the number at the file's parameters."""

OTHER_NUMBERS: dict[str, dict[str, float]] = {
    "ch16_p1": {"m": 2.5, "v0": 7.25, "H": 3.5, "g": 9.5},
    "ch16_p2": {"m": 1.75, "k": 0.35, "v0": 13.5, "alpha": 0.625, "g": 9.5},
    "ch16_p3": {"m": 2.5, "R": 1737000, "g": 1.625, "v0": 1600, "alpha": 0.75},
    "ch16_p4": {"m": 2.5, "l": 0.75, "v0": 5.75, "g": 9.5},
    "ch16_p5": {"m": 2.5, "v0": 3, "L": 4.25, "R": 0.75, "alpha": 0.625, "g": 9.5},
    "ch16_p6": {"m": 2.5, "v0": 3, "alpha": 0.625, "mu": 0.25, "g": 9.5},
    "ch16_p7": {"m": 2.5, "v0": 3, "L": 4.25, "R": 0.75, "alpha": 0.625, "mu": 0.25, "g": 9.5},
    "ch17_p1": {"M": 1.5, "R": 0.25, "v0": 8.5, "alpha": 0.75, "omega0": 11, "g": 9.5, "t1": 0.75, "x1": 1.5},
    "ch17_p2": {"M": 1.5, "l": 0.75, "v_A": 11, "v_B": 12.5, "g": 9.5},
    "ch17_p3": {"M": 1.5, "l": 0.75, "g": 9.5},
    "ch17_p4": {"M": 1.5, "l": 0.75, "g": 9.5},
    "ch17_p5": {"M": 1.5, "l": 0.75, "g": 9.5},
    "ch17_p6": {"M": 1.5, "l": 0.75, "g": 9.5},
}
"""Every parameter of each system with another value, for which the system does the same."""
