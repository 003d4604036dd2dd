"""What the textbooks say: kinetic energies and equations of motion of the systems in models/, written by hand.

The equations of the solved systems are those of the book (SEED ids), each multiplied by the factor that makes it
Lagrange's; the rest was derived by hand. Everything is text of the model file's grammar.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

MODELS = Path(__file__).parent.parent / "models"


@dataclass(frozen=True)
class Known:
    """The known answer of one system.

    Args:
        kinetic_energy: T [J].
        equations: for each speed (left side minus right side, factor): factor * (left - right) = M a - forcing.
    """

    kinetic_energy: str
    equations: tuple[tuple[str, str], ...]


CLASSICS = {
    "simple_pendulum": Known("m*l^2/2*theta'^2", (("theta'' + g/l*sin(theta)", "m*l^2"),)),
    "double_pendulum": Known(
        "(m1/6 + m2/2)*l1^2*theta1'^2 + m2/6*l2^2*theta2'^2 + m2/2*l1*l2*theta1'*theta2'*cos(theta1 - theta2)",
        (
            (
                "(m1/3 + m2)*l1*theta1'' + m2*l2/2*(cos(theta1 - theta2)*theta2'' + sin(theta1 - theta2)*theta2'^2)"
                " + (m1/2 + m2)*g*sin(theta1)",
                "l1",
            ),
            (
                "l2/3*theta2'' + l1/2*(cos(theta1 - theta2)*theta1'' - sin(theta1 - theta2)*theta1'^2)"
                " + g/2*sin(theta2)",
                "m2*l2",
            ),
        ),
    ),
    "spherical_pendulum": Known(
        "m*l^2/2*(theta'^2 + sin(theta)^2*phi'^2)",
        (
            ("theta'' - sin(theta)*cos(theta)*phi'^2 + g/l*sin(theta)", "m*l^2"),
            ("sin(theta)^2*phi'' + 2*sin(theta)*cos(theta)*theta'*phi'", "m*l^2"),
        ),
    ),
    "elastic_pendulum": Known(
        "m/2*(r'^2 + r^2*theta'^2)",
        (
            ("r'' - r*theta'^2 - g*cos(theta) + k/m*(r - l0)", "m"),
            ("r*theta'' + 2*r'*theta' + g*sin(theta)", "m*r"),
        ),
    ),
    "cart_pole": Known(
        "(M + m)/2*x'^2 - m*l/2*cos(theta)*x'*theta' + m*l^2/6*theta'^2",
        (
            ("(M + m)*x'' - m*l/2*(cos(theta)*theta'' - sin(theta)*theta'^2) - F", "1"),
            ("l/3*theta'' - cos(theta)/2*x'' - g/2*sin(theta)", "m*l"),
        ),
    ),
    "bead_on_turning_hoop": Known(
        "m*R^2/2*(theta'^2 + omega^2*sin(theta)^2)",
        (("theta'' - sin(theta)*(omega^2*cos(theta) - g/R)", "m*R^2"),),
    ),
    "atwood": Known("(m1 + m2 + M/2)/2*s'^2", (("(m1 + m2 + M/2)*s'' - (m1 - m2)*g", "1"),)),
    "two_mass_oscillator": Known(
        "m1/2*x1'^2 + m2/2*x2'^2",
        (
            ("m1*x1'' + (k1 + k2)*x1 - k2*x2", "1"),
            ("m2*x2'' - k2*x1 + (k2 + k3)*x2", "1"),
        ),
    ),
    "parallelogram_reactions": Known("12*M*l^2*theta'^2", (("theta'' - 7/12*g/l*cos(theta)", "24*M*l^2"),)),
}

SEEDS = {
    "ch16_p1": Known("m/2*(x'^2 + y'^2)", (("x''", "m"), ("y'' + g", "m"))),
    "ch16_p2": Known("m/2*(x'^2 + y'^2)", (("x'' + k*x'", "m"), ("y'' + k*y' + g", "m"))),
    "ch16_p3": Known(
        "m/2*(rho'^2 + rho^2*psi'^2)",
        (("rho'' - rho*psi'^2 + g*R^2/rho^2", "m"), ("rho*psi'' + 2*rho'*psi'", "m*rho")),
    ),
    "ch16_p4": Known("m*l^2/2*theta'^2", (("theta'' + g/l*sin(theta)", "m*l^2"),)),
    "ch17_p1": Known(
        "M/2*(x'^2 + y'^2) + M*R^2/4*theta'^2",
        (("x''", "M"), ("y'' + g", "M"), ("theta''", "M*R^2/2")),
    ),
    "ch17_p2": Known(
        "M/2*(x'^2 + y'^2) + M*l^2/6*theta'^2",
        (("x''", "M"), ("y'' + g", "M"), ("theta''", "M*l^2/3")),
    ),
    "ch17_p3": Known("M*l^2/6*theta'^2", (("theta'' - 3*g/(2*l)*cos(theta)", "M*l^2/3"),)),
    "ch18_p4": Known(
        "4*M*x'^2 + 6*M*l*cos(phi)*x'*phi' + 4*M*l^2*phi'^2",
        (
            ("8*M*x'' + 6*M*l*(cos(phi)*phi'' - sin(phi)*phi'^2) + k*(x - l0)", "1"),
            ("4*l*phi'' + 3*cos(phi)*x'' + 3*g*sin(phi)", "2*M*l"),
        ),
    ),
    "ch22_p1": Known(
        "6*M*R^2*theta'^2 + 27/2*M*R^2*cos(theta)^2*theta'^2",
        (
            (
                "(4 + 9*cos(theta)^2)*theta'' - 9*theta'^2*sin(theta)*cos(theta) - 2*g/R*sin(theta)",
                "3*M*R^2",
            ),
        ),
    ),
    "ch22_p2": Known(
        "2*M*l^2*theta'^2 + M*(r'^2 + r^2*theta'^2)",
        (
            ("(2*l^2 + r^2)*theta'' + 2*r*r'*theta' - g*(3/2*l + r)*cos(theta)", "2*M"),
            ("r'' - r*theta'^2 - g*sin(theta)", "2*M"),
        ),
    ),
    "ch22_p3": Known(
        "6*M*a^2*theta'^2 + 2*M*a^2*phi'^2",
        (
            (
                "12*M*a*theta'' + 6*M*g*sin(theta) + k*a*sin(theta)*cos(theta)"
                " + 6*k*a*(3*sin(theta) + 2*sin(phi))*cos(theta)",
                "a",
            ),
            ("4*M*a*phi'' + 3*M*g*sin(phi) + 4*k*a*(3*sin(theta) + 2*sin(phi))*cos(phi)", "a"),
        ),
    ),
    "ch22_p4": Known("91/8*M*R^2*theta'^2", (("theta'' - 4/13*g/R", "91/4*M*R^2"),)),
    "ch22_p5": Known(
        "3*M*x'^2 + 6*M*R*cos(theta)*x'*theta' + 8*M*R^2*theta'^2",
        (
            ("x'' + R*(cos(theta)*theta'' - sin(theta)*theta'^2)", "6*M"),
            ("8*R*theta'' + 3*cos(theta)*x'' + 3*g*sin(theta)", "2*M*R"),
        ),
    ),
    "ch22_p6": Known(
        "3*M*y'^2 + M*l^2*theta'^2",
        (
            ("6*M*y'' + 5*k*y + k*l*sin(theta)", "1"),
            ("2*M*l*theta'' + k*(y + 5*l*sin(theta))*cos(theta)", "l"),
        ),
    ),
}

OUTPUTS = {
    "ch16_p1": "t_B x_B v_Bx v_By v_B",
    "ch16_p2": "t_max h_max k_t_B x_B v_Bx v_By",
    "ch16_p3": "h_max",
    "ch16_p4": "T theta_d_squared v_60 T_60 v0_full_circle cos_theta_slack",
    "ch17_p1": "x_C y_C theta trajectory_y",
    "ch17_p2": "omega v_C_y v_B_x v_B_y v_B",
    "ch17_p3": "theta_d_squared v_A R_rho R_n R_rho_vertical R_n_vertical",
    "ch18_p4": "kinetic_energy x_dd phi_dd",
    "ch22_p1": "kinetic_energy Q_theta theta_dd omega_disc N_A",
    "ch22_p2": "kinetic_energy Q_theta Q_r N_P",
    "ch22_p3": "Q_theta Q_phi K11 K12 K22 M11 M22 kinetic_energy omega1_squared omega2_squared",
    "ch22_p4": "theta_dd a_P v_P_of_h v_P_of_t kinetic_energy T1 T2 T3",
    "ch22_p5": "kinetic_energy x_dd theta_dd N_ground F_friction",
    "ch22_p6": "omega1_squared omega2_squared",
}
"""What each system of the seeds asks for, by name."""

ANSWERS = {
    "ch18_p4": {
        "x_dd": "(24*M*l*sin(phi)*phi'^2 + 18*M*g*sin(phi)*cos(phi) - 4*k*(x - l0))/(M*(32 - 18*cos(phi)^2))",
    },
    "ch22_p1": {
        "Q_theta": "6*M*g*R*sin(theta)",
        "theta_dd": "(2*g/R*sin(theta) + 9*theta'^2*sin(theta)*cos(theta))/(4 + 9*cos(theta)^2)",
        "omega_disc": "3*theta'*cos(theta)",
    },
    "ch22_p2": {"Q_theta": "(3*l + 2*r)*M*g*cos(theta)", "Q_r": "2*M*g*sin(theta)"},
    "ch22_p3": {
        "Q_theta": "-a*(6*M*g*sin(theta) + k*a*sin(theta)*cos(theta)"
        " + 6*k*a*(3*sin(theta) + 2*sin(phi))*cos(theta))",
        "Q_phi": "-a*(3*M*g*sin(phi) + 4*k*a*(3*sin(theta) + 2*sin(phi))*cos(phi))",
    },
    "ch22_p4": {
        "theta_dd": "4/13*g/R",
        "a_P": "8/13*g",
        "T1": "20/13*M*g",
        "T2": "16/13*M*g",
        "T3": "14/13*M*g",
    },
    "ch22_p5": {
        "x_dd": "sin(theta)*(8*R*theta'^2 + 3*g*cos(theta))/(8 - 3*cos(theta)^2)",
        "theta_dd": "-3*sin(theta)*(R*cos(theta)*theta'^2 + g)/(R*(8 - 3*cos(theta)^2))",
        "N_ground": "M*(30*R*cos(theta)*theta'^2 + 25*g - 3*g*sin(theta)^2)/(8 - 3*cos(theta)^2)",
        "F_friction": "-M*sin(theta)*(8*R*theta'^2 + 3*g*cos(theta))/(8 - 3*cos(theta)^2)",
    },
}
"""Outputs of the seeds that are functions of coordinates and rates, by hand."""
