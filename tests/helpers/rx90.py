"""The Staeubli RX-90 in the frames of Khalil & Dombre, Modeling, Identification and Control of Robots (2002), §9.4.4,
and its base inertial parameters as they are published there (Table 9.4)."""

ALPHA = ("0", "pi/2", "0", "-pi/2", "pi/2", "-pi/2")
AT = ("[0, 0, 0]", "[0, 0, 0]", '["D3", 0, 0]', '[0, "RL4", 0]', "[0, 0, 0]", "[0, 0, 0]")

PUBLISHED = {  # of each base parameter what is grouped with it
    "Izz(C1)": "Iyy(C2) Iyy(C3) D3^2*m(C3) D3^2*m(C4) D3^2*m(C5) D3^2*m(C6) armature(C1)",
    "Ixx(C2)": "-Iyy(C2) -D3^2*m(C3) -D3^2*m(C4) -D3^2*m(C5) -D3^2*m(C6)",
    "Ixy(C2)": "",
    "Izx(C2)": "-D3*mz(C3)",
    "Iyz(C2)": "",
    "Izz(C2)": "D3^2*m(C3) D3^2*m(C4) D3^2*m(C5) D3^2*m(C6) armature(C2)",
    "mx(C2)": "D3*m(C3) D3*m(C4) D3*m(C5) D3*m(C6)",
    "my(C2)": "",
    "Ixx(C3)": "-Iyy(C3) Iyy(C4) 2*RL4*mz(C4) RL4^2*m(C4) RL4^2*m(C5) RL4^2*m(C6)",
    "Ixy(C3)": "",
    "Izx(C3)": "",
    "Iyz(C3)": "",
    "Izz(C3)": "Iyy(C4) 2*RL4*mz(C4) RL4^2*m(C4) RL4^2*m(C5) RL4^2*m(C6)",
    "mx(C3)": "",
    "my(C3)": "mz(C4) RL4*m(C4) RL4*m(C5) RL4*m(C6)",
    "armature(C3)": "",
    "Ixx(C4)": "-Iyy(C4) Iyy(C5)",
    "Ixy(C4)": "",
    "Izx(C4)": "",
    "Iyz(C4)": "",
    "Izz(C4)": "Iyy(C5)",
    "mx(C4)": "",
    "my(C4)": "-mz(C5)",
    "armature(C4)": "",
    "Ixx(C5)": "-Iyy(C5) Iyy(C6)",
    "Ixy(C5)": "",
    "Izx(C5)": "",
    "Iyz(C5)": "",
    "Izz(C5)": "Iyy(C6)",
    "mx(C5)": "",
    "my(C5)": "mz(C6)",
    "armature(C5)": "",
    "Ixx(C6)": "-Iyy(C6)",
    "Ixy(C6)": "",
    "Izx(C6)": "",
    "Iyz(C6)": "",
    "Izz(C6)": "",
    "mx(C6)": "",
    "my(C6)": "",
    "armature(C6)": "",
}


def rx90() -> str:
    """A model file; masses and the like are any numbers."""
    lines = ['eomgen = 1\nspace = "space"', "parameters = { D3 = 0.45, RL4 = 0.4, g = 9.81 }", "[coordinates]"]
    lines += [f"q{j} = 0.{j}" for j in range(1, 7)]
    lines += ["[inputs]", *(f"tau{j} = 0" for j in range(1, 7))]
    for j, (alpha, at) in enumerate(zip(ALPHA, AT, strict=True), start=1):
        on = f'on = "C{j - 1}", ' if j > 1 else ""
        lines += [
            f"[bodies.C{j}]",
            f"mass = {9 - j}\ncenter = [0.0{j}, 0.02, -0.03]\ninertia = [0.3, 0.2, 0.4, 0.01, 0.02, 0.0{j}]",
            f'joint = {{ kind = "revolute", {on}at = {at}, turned = {{ axis = [1, 0, 0], angle = "{alpha}" }}, '
            f'axis = [0, 0, 1], angle = "q{j}", armature = 0.{j}, torque = "tau{j}" }}',
        ]
    return "\n".join([*lines, '[forces.weight]\nkind = "gravity"\nacceleration = [0, 0, "-g"]'])
