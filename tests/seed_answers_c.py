"""Chapters 9 and 10 and the turntable: what `eomgen solve` must answer, as text of the model file's grammar, in SI.

The answers of the solved exercises are the book's, its errata mended, those of the unsolved ones by hand; all are
derived once more, from positions alone, in seed_oracle_c.py, and the tests compare. PRINTED holds the book's decimals,
in the book's units.
"""

from __future__ import annotations

ROOT_9 = "(h^2 + (v_A*t1)^2)"  # squared, from A to C in ch9-p9
TURN_P = "(pi*t1^2/12)"  # of the radius AP in ch10-p3
TURN_4 = "(pi*u/(2*R*omega))"  # of the radius of the ring in ch10-p4
FROM_START = "(v_B0/(sqrt(2)*l) + epsilon*t1)"  # omega1 in ch9-p7
SWING = "sqrt(sin(t1)^2 + cos(t1)^4)"  # ch9-p6

ANSWERS: dict[str, dict[str, str]] = {
    "ch9_p1": {"v": "k*t1^2", "a": "2*k*t1", "omega_rod": "0", "omega_wheel": "k*t1^2/R"},
    "ch9_p2": {
        "theta1": "v_E*t1/l",
        "v": "v_E",
        "a": "v_E^2/l",
        "v_x": "v_E*cos(v_E*t1/l)",
        "v_y": "v_E*sin(v_E*t1/l)",
        "a_x": "-v_E^2/l*sin(v_E*t1/l)",
        "a_y": "v_E^2/l*cos(v_E*t1/l)",
    },
    "ch9_p3": {"v": "a_A*t1", "a": "a_A", "displacement": "a_A*t1^2/2"},
    "ch9_s9_p1": {"v": "R*omega", "a": "R*omega^2", "a_t": "0"},
    "ch9_p6": {
        "theta1": "sin(t1)",
        "omega1": "cos(t1)",
        "epsilon1": "-sin(t1)",
        "v_A": "b*cos(t1)",
        "a_A": f"b*{SWING}",
        "v_B": "sqrt(b^2 + h^2)*cos(t1)",
        "a_B": f"sqrt(b^2 + h^2)*{SWING}",
        "v_C": "h*cos(t1)",
        "a_C": f"h*{SWING}",
        "a_A_t": "b*sin(t1)",
        "a_A_n": "b*cos(t1)^2",
    },
    "ch9_p7": {
        "omega0": "v_B0/(sqrt(2)*l)",
        "omega1": FROM_START,
        "theta1": "v_B0*t1/(sqrt(2)*l) + epsilon*t1^2/2",
        **{f"v_{point}": f"{arm}*{FROM_START}" for point, arm in (("A", "l"), ("B", "sqrt(2)*l"), ("C", "l"))},
        **{
            f"a_{point}": f"{arm}*sqrt(epsilon^2 + {FROM_START}^4)"
            for point, arm in (("A", "l"), ("B", "sqrt(2)*l"), ("C", "l"))
        },
    },
    "ch9_p8": {
        "x_A": "v_A*t1",
        "omega1": "v_A/sqrt(l^2 - (v_A*t1)^2)",
        "epsilon1": "v_A^3*t1/(l^2 - (v_A*t1)^2)^(3/2)",
        "v_B_y": "v_A^2*t1/sqrt(l^2 - (v_A*t1)^2)",
        "a_A": "0",
        "a_B_y": "v_A^2*l^2/(l^2 - (v_A*t1)^2)^(3/2)",
        "a_B_t": "l*v_A^3*t1/(l^2 - (v_A*t1)^2)^(3/2)",
        "a_B_n": "l*v_A^2/(l^2 - (v_A*t1)^2)",
        "v_min": "v_A^2*t1/l",
    },
    "ch9_p9": {
        "omega": f"h*v_A/{ROOT_9}",
        "epsilon": f"-2*h*v_A^3*t1/{ROOT_9}^2",
        "v_B_x": f"v_A - l*h^2*v_A/{ROOT_9}^(3/2)",
        "v_B_y": f"-l*h*v_A^2*t1/{ROOT_9}^(3/2)",
        "v_B": f"v_A*sqrt((1 - l*h^2/{ROOT_9}^(3/2))^2 + (l*h*v_A*t1)^2/{ROOT_9}^3)",
        "a_B_x": f"3*l*h^2*v_A^3*t1/{ROOT_9}^(5/2)",
        "a_B_y": f"l*h*v_A^2*(2*(v_A*t1)^2 - h^2)/{ROOT_9}^(5/2)",
        "a_B": f"l*h*v_A^2*sqrt((3*h*v_A*t1)^2 + (2*(v_A*t1)^2 - h^2)^2)/{ROOT_9}^(5/2)",
        "v_min": f"v_A*(v_A*t1)/sqrt{ROOT_9}",  # of the bar's point at C, which slides along the bar
    },
    "ch9_p10": {
        "omega": "v_A/(2*R)",
        "epsilon": "0",
        "v_C": "v_A/sqrt(2)",
        "v_B": "v_A*sqrt(l^2 - 2*sqrt(2)*l*R + 4*R^2)/(2*R)",
        "v_B_x": "sqrt(2)*l*v_A/(4*R) - v_A",
        "v_B_y": "-sqrt(2)*l*v_A/(4*R)",
        "a_A": "v_A^2/R",
        "a_B": "v_A^2*sqrt(l^2 - 4*sqrt(2)*l*R + 16*R^2)/(4*R^2)",
        "a_B_x": "-sqrt(2)*l*v_A^2/(8*R^2)",
        "a_B_y": "v_A^2/R - sqrt(2)*l*v_A^2/(8*R^2)",
    },
    "ch9_p11": {
        "omega": "v/l",
        "epsilon": "(v/l)^2",
        "a_B": "v^2/l",
        "v_B_x": "v",
        "v_B_y": "v",
        "v_D_x": "0",
        "v_D_y": "0",
        "v_M_x": "v/2",
        "v_M_y": "v/2",
        "a_A_x": "v^2/l",
        "a_A_y": "0",
        "a_D_x": "0",
        "a_D_y": "-v^2/l",
        "a_M_x": "0",
        "a_M_y": "0",
    },
    "ch10_p1": {
        "v": "sqrt((v_t - v_r*cos(alpha))^2 + (v_r*sin(alpha))^2)",
        "v_x": "v_t - v_r*cos(alpha)",
        "v_y": "-v_r*sin(alpha)",
        "a": "sqrt((a_t - a_r*cos(alpha))^2 + (a_r*sin(alpha))^2)",
        "a_x": "a_t - a_r*cos(alpha)",
        "a_y": "-a_r*sin(alpha)",
        "a_coriolis": "0",
    },
    "ch10_p2": {
        "t1": "sqrt(l/(2*c))",
        "theta1": "k*l/(4*c)",
        "v_r": "sqrt(2*c*l)",
        "a_r": "2*c",
        "v_t": "k*l/2*sqrt(l/(2*c))",
        "a_t_tangential": "k*l/2",
        "a_t_normal": "k^2*l^2/(4*c)",
        "a_coriolis": "2*k*l",
        "v": "sqrt(2*c*l + k^2*l^3/(8*c))",
        "a_radial": "2*c - k^2*l^2/(4*c)",
        "a_transverse": "5*k*l/2",
        "a": "sqrt((2*c - k^2*l^2/(4*c))^2 + 25*k^2*l^2/4)",
    },
    "ch10_p3": {
        "v_x": f"2*a_0*t1 - pi*R*t1/6*sin{TURN_P}",
        "v_y": f"pi*R*t1/6*cos{TURN_P}",
        "v": f"sqrt((2*a_0*t1 - pi*R*t1/6*sin{TURN_P})^2 + (pi*R*t1/6*cos{TURN_P})^2)",
        "a_x": f"2*a_0 - pi*R/6*sin{TURN_P} - R*(pi*t1/6)^2*cos{TURN_P}",
        "a_y": f"pi*R/6*cos{TURN_P} - R*(pi*t1/6)^2*sin{TURN_P}",
        "a": f"sqrt((2*a_0 - pi*R/6*sin{TURN_P} - R*(pi*t1/6)^2*cos{TURN_P})^2"
        f" + (pi*R/6*cos{TURN_P} - R*(pi*t1/6)^2*sin{TURN_P})^2)",
    },
    "ch10_p4": {
        "t1": "pi/(2*omega)",
        "v_x": f"(omega*R + u)*sin{TURN_4}",
        "v_y": f"omega*R - (omega*R + u)*cos{TURN_4}",
        "v": f"sqrt((omega*R)^2 + (omega*R + u)^2 - 2*omega*R*(omega*R + u)*cos{TURN_4})",
        "a_x": f"-omega^2*R + (omega*R + u)^2/R*cos{TURN_4}",
        "a_y": f"(omega*R + u)^2/R*sin{TURN_4}",
        "a": f"sqrt((omega^2*R)^2 + (omega*R + u)^4/R^2 - 2*omega^2*(omega*R + u)^2*cos{TURN_4})",
        "a_coriolis": "2*omega*u",
    },
    "s1_rotating_frame": {
        "x": "a*(cos(Omega*t1) + Omega*t1*sin(Omega*t1))",
        "y": "a*(Omega*t1*cos(Omega*t1) - sin(Omega*t1))",
        "F_coriolis_x": "2*m*Omega*y'",
        "F_coriolis_y": "-2*m*Omega*x'",
        "F_centrifugal_x": "m*Omega^2*x",
        "F_centrifugal_y": "m*Omega^2*y",
        "euler_term_x": "m*alpha*eta",
        "euler_term_y": "-m*alpha*xi",
        "x_dd": "Omega^2*x + 2*Omega*y'",
        "y_dd": "Omega^2*y - 2*Omega*x'",
    },
}

UNITS: dict[str, dict[str, str]] = {
    "ch9_p1": {"v": "cm/s", "a": "cm/s^2", "omega_rod": "rad/s", "omega_wheel": "rad/s"},
    "ch9_p2": {"theta1": "rad", "v": "m/s", "a": "m/s^2", "v_x": "m/s", "v_y": "m/s", "a_x": "m/s^2", "a_y": "m/s^2"},
    "ch9_p3": {"v": "cm/s", "a": "cm/s^2", "displacement": "cm"},
    "ch9_s9_p1": {"v": "cm/s", "a": "cm/s^2", "a_t": "cm/s^2"},
    "ch9_p6": {
        "theta1": "rad", "omega1": "rad/s", "epsilon1": "rad/s^2", "v_A": "cm/s", "a_A": "cm/s^2", "v_B": "cm/s",
        "a_B": "cm/s^2", "v_C": "cm/s", "a_C": "cm/s^2", "a_A_t": "cm/s^2", "a_A_n": "cm/s^2",
    },
    "ch9_p7": {
        "omega0": "rad/s", "omega1": "rad/s", "theta1": "rad", "v_A": "m/s", "a_A": "m/s^2", "v_B": "m/s",
        "a_B": "m/s^2", "v_C": "m/s", "a_C": "m/s^2",
    },
    "ch9_p8": {
        "x_A": "m", "omega1": "rad/s", "epsilon1": "rad/s^2", "v_B_y": "m/s", "a_A": "m/s^2", "a_B_y": "m/s^2",
        "a_B_t": "m/s^2", "a_B_n": "m/s^2", "v_min": "m/s",
    },
    "ch9_p9": {
        "omega": "rad/s", "epsilon": "rad/s^2", "v_B_x": "m/s", "v_B_y": "m/s", "v_B": "m/s", "a_B_x": "m/s^2",
        "a_B_y": "m/s^2", "a_B": "m/s^2", "v_min": "m/s",
    },
    "ch9_p10": {
        "omega": "rad/s", "epsilon": "rad/s^2", "v_C": "m/s", "v_B": "m/s", "v_B_x": "m/s", "v_B_y": "m/s",
        "a_A": "m/s^2", "a_B": "m/s^2", "a_B_x": "m/s^2", "a_B_y": "m/s^2",
    },
    "ch9_p11": {
        "omega": "rad/s", "epsilon": "rad/s^2", "a_B": "m/s^2", "v_B_x": "m/s", "v_B_y": "m/s", "v_D_x": "m/s",
        "v_D_y": "m/s", "v_M_x": "m/s", "v_M_y": "m/s", "a_A_x": "m/s^2", "a_A_y": "m/s^2", "a_D_x": "m/s^2",
        "a_D_y": "m/s^2", "a_M_x": "m/s^2", "a_M_y": "m/s^2",
    },
    "ch10_p1": {
        "v": "m/s", "v_x": "m/s", "v_y": "m/s", "a": "m/s^2", "a_x": "m/s^2", "a_y": "m/s^2", "a_coriolis": "m/s^2",
    },
    "ch10_p2": {
        "t1": "s", "theta1": "rad", "v_r": "cm/s", "a_r": "cm/s^2", "v_t": "cm/s", "a_t_tangential": "cm/s^2",
        "a_t_normal": "cm/s^2", "a_coriolis": "cm/s^2", "v": "cm/s", "a_radial": "cm/s^2", "a_transverse": "cm/s^2",
        "a": "cm/s^2",
    },
    "ch10_p3": {"v_x": "cm/s", "v_y": "cm/s", "v": "cm/s", "a_x": "cm/s^2", "a_y": "cm/s^2", "a": "cm/s^2"},
    "ch10_p4": {
        "t1": "s", "v_x": "cm/s", "v_y": "cm/s", "v": "cm/s", "a_x": "cm/s^2", "a_y": "cm/s^2", "a": "cm/s^2",
        "a_coriolis": "cm/s^2",
    },
    "s1_rotating_frame": dict.fromkeys(ANSWERS["s1_rotating_frame"], ""),
}  # fmt: skip
"""The units in which the answers come."""

PRINTED: dict[str, dict[str, str]] = {
    "ch9_p1": {"v": "27", "a": "18", "omega_rod": "0", "omega_wheel": "0.54"},
    "ch9_p2": {"theta1": "1", "v": "0.6", "a": "1.2"},
    "ch9_s9_p1": {"v": "20", "a": "10", "a_t": "0"},
    "ch9_p6": {
        "theta1": "0.8415", "omega1": "0.5403", "epsilon1": "-0.8415", "v_A": "21.612", "v_B": "27.015",
        "v_C": "16.209", "a_A": "35.627", "a_B": "44.534", "a_C": "26.720", "a_A_t": "33.659", "a_A_n": "11.677",
    },
    "ch9_p8": {
        "x_A": "0.16", "omega1": "1.6888", "epsilon1": "0.9633", "v_B_y": "0.2702", "a_A": "0", "a_B_y": "1.5052",
        "a_B_t": "0.4817", "a_B_n": "1.4260", "v_min": "0.256",
    },
    "ch9_p10": {"omega": "1", "epsilon": "0", "v_C": "0.7071", "v_B": "0.8619", "a_A": "2", "a_B": "1.4303"},
    "ch10_p1": {"v": "1.0353", "a": "1.2393", "a_coriolis": "0"},
    "ch10_p2": {
        "t1": "2", "v_r": "50", "v_t": "104.72", "v": "116.04", "a_r": "25", "a_t_tangential": "52.36",
        "a_t_normal": "219.32", "a_coriolis": "209.44", "a_radial": "-194.32", "a_transverse": "261.80", "a": "326.04",
    },
}  # fmt: skip
"""What the book prints of its solved exercises, mended; right to half a unit of the last digit."""

BOOK_SURDS = {
    ("ch9_p10", "v_B"): "sqrt(61 - 30*sqrt(2))/5",
    ("ch9_p10", "a_B"): "2/5*sqrt(34 - 15*sqrt(2))",
    ("ch9_p10", "v_C"): "sqrt(2)/2",
    ("ch10_p1", "v"): "sqrt(8 - 4*sqrt(3))",
    ("ch10_p1", "a"): "sqrt(5 - 2*sqrt(3))",
    ("ch10_p2", "v_t"): "100*pi/3",
    ("ch10_p2", "a_t_normal"): "200*pi^2/9",
    ("ch10_p2", "a_coriolis"): "200*pi/3",
}
"""What the book has in closed form at its numbers."""
