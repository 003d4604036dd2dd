"""What the textbooks say: kinetic energies and equations of motion of the systems in models/, written by hand.

The equations of the solved systems are those of the book (SEED ids), each multiplied by the factor that makes it
Lagrange's; the rest was derived by hand. Everything is text of the model file's grammar.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

MODELS = Path(__file__).parent.parent.parent / "models"


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
    "rolling_disc_and_bar": Known(
        "6*M*R^2*theta'^2 + 27/2*M*R^2*cos(theta)^2*theta'^2",
        (
            (
                "(4 + 9*cos(theta)^2)*theta'' - 9*theta'^2*sin(theta)*cos(theta) - 2*g/R*sin(theta)",
                "3*M*R^2",
            ),
        ),
    ),
    "sliding_ladder": Known("m*l^2/6*theta'^2", (("theta'' - 3*g/(2*l)*sin(theta)", "m*l^2/3"),)),
    "rough_incline": Known("m/2*s'^2", (("s'' + g*sin(alpha) + mu*g*cos(alpha)*sign(s')", "m"),)),
    "loop_the_loop": Known(
        "m/2*s'^2",
        (("s'' - g*sin(alpha - min(max(0, s - L), R*(alpha + 2*pi))/R)", "m"),),
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
    "ch16_p5": Known("m/2*s'^2", (("s'' - g*sin(alpha - max(0, s - L)/R)", "m"),)),
    "ch16_p6": Known("m/2*x'^2", (("x'' + g*sin(alpha) + mu*g*cos(alpha)*sign(x')", "m"),)),
    "ch16_p7": Known(
        "m/2*s'^2",
        (("s'' - g*sin(alpha - max(0, s - L)/R) + mu*g*cos(alpha)*sign(s')*max(0, sign(L - s))", "m"),),
    ),
    "ch17_p1": Known(
        "M/2*(x'^2 + y'^2) + M*R^2/4*theta'^2",
        (("x''", "M"), ("y'' + g", "M"), ("theta''", "M*R^2/2")),
    ),
    "ch17_p2": Known(
        "M/2*(x'^2 + y'^2) + M*l^2/6*theta'^2",
        (("x''", "M"), ("y'' + g", "M"), ("theta''", "M*l^2/3")),
    ),
    "ch17_p3": Known("M*l^2/6*theta'^2", (("theta'' - 3*g/(2*l)*cos(theta)", "M*l^2/3"),)),
    "ch17_p4": Known(
        "M/2*x'^2 + M*l^2/6*(1 + 3*sin(theta)^2)*theta'^2",
        (
            ("x''", "M"),
            (
                "(1 + 3*sin(theta)^2)*theta'' + 3*sin(theta)*cos(theta)*theta'^2 - 3*g/l*sin(theta)",
                "M*l^2/3",
            ),
        ),
    ),
    "ch17_p5": Known("2*M*l^2*theta'^2", (("theta'' - 3*g/(4*l)*sin(theta)", "4*M*l^2"),)),
    "ch17_p6": Known("M*l^2*theta'^2", (("theta'' - g/l*cos(theta)", "2*M*l^2"),)),
    "ch18_p1": Known("3*M*R^2*theta'^2", (("theta'' - g/(6*R)", "6*M*R^2"),)),
    "ch18_p2": Known(
        "M*l^2*(4 + 28*sin(theta)^2)*theta'^2",
        (
            (
                "l*(4 + 28*sin(theta)^2)*theta'' + 28*l*sin(theta)*cos(theta)*theta'^2"
                " - g*(3*cos(theta) + 8*sin(theta))",
                "2*M*l",
            ),
        ),
    ),
    "ch18_p3": Known("23/8*M*s'^2", (("s'' - 12/23*g", "23/4*M"),)),
    "ch18_p4": Known(
        "4*M*x'^2 + 6*M*l*cos(phi)*x'*phi' + 4*M*l^2*phi'^2",
        (
            ("8*M*x'' + 6*M*l*(cos(phi)*phi'' - sin(phi)*phi'^2) + k*(x - l0)", "1"),
            ("4*l*phi'' + 3*cos(phi)*x'' + 3*g*sin(phi)", "2*M*l"),
        ),
    ),
    "ch18_p5": Known(
        "M*l^2*(3 - sin(theta))*theta'^2",
        (
            (
                "2*l*(3 - sin(theta))*theta'' - l*cos(theta)*theta'^2 - g*cos(theta)*(3 - 2/sqrt(2 + 2*sin(theta)))",
                "M*l",
            ),
        ),
    ),
    "ch20_p1": Known("3/4*M*R^2*theta'^2", (("theta'' - 2/3*g/R", "3/2*M*R^2"),)),
    "ch20_p2": Known("12*M*l^2*theta'^2", (("theta'' - 7/12*g/l*cos(theta)", "24*M*l^2"),)),
    "ch20_p3": Known(
        "M*R^2*(8*theta'^2 + (2*theta' - phi')^2 + phi'^2/2)",
        (("24*theta'' - 4*phi'' + 2*g/R", "M*R^2"), ("-4*theta'' + 3*phi'' - 2*g/R", "M*R^2")),
    ),
    "ch20_p4": Known(
        "M*R^2*(3/2 + 5*cos(theta)^2)*theta'^2",
        (
            (
                "(3 + 10*cos(theta)^2)*theta'' - 10*sin(theta)*cos(theta)*theta'^2 - 3/2*g/R*sin(theta)",
                "M*R^2",
            ),
        ),
    ),
    "ch20_p5": Known(
        "M/2*(7*s'^2 + (s' + z')^2 + 2*(s' - z')^2 + z'^2)",
        (("10*s'' - z'' + g", "M"), ("-s'' + 4*z'' - g", "M")),
    ),
    "ch20_p6": Known(
        "M*(7/2*y'^2 - 6*l*sin(phi)*y'*phi' + 4*l^2*phi'^2)",
        (
            ("7*y'' - 6*l*(sin(phi)*phi'' + cos(phi)*phi'^2) - 7*g", "M"),
            ("4*l*phi'' - 3*sin(phi)*y'' + 3*g*sin(phi)", "2*M*l"),
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
    "ch16_p5": "v_B v_C v_D N_B_before N_B_after N_C N_D",
    "ch16_p6": "x_dd_up t_stop x_stop F_f_max weight_component stays s_dd_down v_return_to_A",
    "ch16_p7": "v_B v_C v_D N_B_before N_B_after N_C N_D",
    "ch17_p1": "x_C y_C theta trajectory_y",
    "ch17_p2": "omega v_C_y v_B_x v_B_y v_B",
    "ch17_p3": "theta_d_squared v_A R_rho R_n R_rho_vertical R_n_vertical",
    "ch17_p4": "theta_d_squared x_C v_A_45 N_A_45 theta_dd_45",
    "ch17_p5": "theta_sep theta_d_squared N_wall N_floor theta_d_squared_at_sep N_floor_at_sep",
    "ch17_p6": "v_A T1 T2 T_general",
    "ch18_p1": "theta_dd a_P v_P_2s y_P_2s T1 T2 V_O H_O",
    "ch18_p2": "v_B v_B_squared theta theta_d_squared theta_d_squared_general",
    "ch18_p3": "a_P T1 T2 T3 V_O",
    "ch18_p4": "kinetic_energy x_dd phi_dd",
    "ch18_p5": "v_A v_A_squared v_Q",
    "ch20_p1": "theta_dd a_C T",
    "ch20_p2": "theta_d_squared v_A R1 R2 R1_vertical R3_vertical R2_vertical R4_vertical",
    "ch20_p3": "theta_dd phi_dd a_P D a_C T1 T2 V_O",
    "ch20_p4": "theta_d_squared v_B omega_disc_end H_O V_O N_B",
    "ch20_p5": "a_P z_dd T1 T2 T3 T4 V_O",
    "ch20_p6": "y_dd phi_dd N_P",
    "ch22_p1": "kinetic_energy Q_theta theta_dd omega_disc N_A",
    "ch22_p2": "kinetic_energy Q_theta Q_r N_P",
    "ch22_p3": "Q_theta Q_phi K11 K12 K22 M11 M22 kinetic_energy omega1_squared omega2_squared",
    "ch22_p4": "theta_dd a_P v_P_of_h v_P_of_t kinetic_energy T1 T2 T3",
    "ch22_p5": "kinetic_energy x_dd theta_dd N_ground F_friction",
    "ch22_p6": "omega1_squared omega2_squared",
}
"""What each system of the seeds asks for, by name."""
