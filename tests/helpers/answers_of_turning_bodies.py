"""The bodies of the notes that turn in space: what `solve` must answer, as text of the model file's grammar, by hand.

Euler's equations have the right signs here (the notes print all gyroscopic terms with the wrong one). What is asked
later than the start has no text: tests/oracle_of_turning_bodies.py integrates it.
"""

from __future__ import annotations

SQUARED = "(I1*w1)^2 + (I2*w2)^2 + (I3*w3)^2"
ENERGY = "(I1*w1^2 + I2*w2^2 + I3*w3^2)/2"

ANSWERS: dict[str, dict[str, str | None]] = {
    "s1_euler": {
        "omega1_d": "(N1 - (I3 - I2)*w2*w3)/I1",
        "omega2_d": "(N2 - (I1 - I3)*w3*w1)/I2",
        "omega3_d": "(N3 - (I2 - I1)*w1*w2)/I3",
    },
    "s1_torque_free": {
        "L_squared": SQUARED,
        "T": ENERGY,
        "omega_at_5s": None,
        "omega1_at_5s": None,
        "omega2_at_5s": None,
        "omega3_at_5s": None,
        "L_squared_case": None,
        "T_case": None,
        "L_x_at_5s": None,
        "L_z_at_5s": None,
        "omega2_d_at_0": "(I3 - I1)*w3*w1/I2",
    },
    "s1_symmetric_top": {
        "Omega_body": "(I_3 - I_t)/I_t*w3",
        "precession_space": "sqrt(I_t^2*(w1^2 + w2^2) + I_3^2*w3^2)/I_t",
        "omega1": None,
        "omega2": None,
        "omega3": None,
    },
    "s1_dominant_spin": {
        "omega1_d": "(I2 - I3)/I1*w2*w3",
        "frequency_squared": "(I1 - I2)*(I1 - I3)/(I2*I3)*w1^2",
    },
    "s1_lagrange_top": {
        "p_phi": "I_t*sin(theta)^2*phi' + I_3*cos(theta)*(psi' + phi'*cos(theta))",
        "p_psi": "I_3*(psi' + phi'*cos(theta))",
        "omega3": "psi' + phi'*cos(theta)",
        "energy": "I_t/2*(theta'^2 + phi'^2*sin(theta)^2) + I_3/2*(psi' + phi'*cos(theta))^2 + M*g*d*cos(theta)",
        "theta_dd": "sin(theta)*(I_t*cos(theta)*phi'^2 - I_3*phi'*(psi' + phi'*cos(theta)) + M*g*d)/I_t",
        "p_psi_later": None,
    },
}
"""None: at an instant after the start, in numbers only."""

UNITS = {
    "s1_torque_free": {
        "omega_at_5s": "rad/s",
        "omega1_at_5s": "rad/s",
        "omega2_at_5s": "rad/s",
        "omega3_at_5s": "rad/s",
        "T_case": "J",
        "omega2_d_at_0": "rad/s^2",
    },
    "s1_symmetric_top": {"Omega_body": "rad/s", "precession_space": "rad/s"},
    "s1_dominant_spin": {"omega1_d": "rad/s^2", "frequency_squared": "rad^2/s^2"},
    "s1_lagrange_top": {"omega3": "rad/s", "energy": "J"},
}
"""That the files declare."""

INFERRED = {
    "s1_euler": {"omega1_d": "1/s^2", "omega2_d": "1/s^2", "omega3_d": "1/s^2"},
    "s1_torque_free": {
        "L_squared": "kg^2*m^4/s^2",
        "T": "J",
        "L_squared_case": "kg^2*m^4/s^2",
        "L_x_at_5s": "kg*m^2/s",
        "L_z_at_5s": "kg*m^2/s",
    },
    "s1_symmetric_top": {"omega1": "1/s", "omega2": "1/s", "omega3": "1/s"},
    "s1_lagrange_top": {
        "p_phi": "kg*m^2/s",
        "p_psi": "kg*m^2/s",
        "theta_dd": "1/s^2",
        "p_psi_later": "kg*m^2/s",
    },
}
"""Of every other output: that of its quantity, an angle being a number."""
