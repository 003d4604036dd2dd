"""Systems of chapters 18, 20 and 22 as another user would write them: free bodies, closed by their constraints.

Outputs carry the names of the seeds, so that their answers can be asked for.
"""

from __future__ import annotations

HEAD = """
eomgen = 1
space = "plane"
[parameters]
M = 1.3
l = 0.6
R = 0.25
g = 9.81
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""

CRANK = """
[bodies.OA]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
joint = { kind = "revolute", at = [0, 0], angle = "-theta" }
[bodies.AB]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
joint = { kind = "revolute", on = "OA.end", angle = "phi + theta" }
[forces.P]
kind = "force"
point = "B.center"
force = ["-4*M*g", 0]
[outputs]
v_B = { value = "speed(B.center)", at = "x(B.center) = 2*l", from = "rest" }
v_B_squared = { value = "speed(B.center)^2", at = "x(B.center) = 2*l", from = "rest" }
theta = { value = "theta", at = "x(B.center) = 2*l", from = "rest" }
theta_d_squared = { value = "theta'^2", at = "x(B.center) = 2*l", from = "rest" }
theta_d_squared_general = { value = "theta'^2", from = "rest" }
"""

SLIDER_CRANK_BY_A_SUPPORT = """
[coordinates]
theta = 0
phi = { dependent = true, start = 0 }
[bodies.B]
shape = { kind = "particle", mass = "2*M" }
joint = { kind = "fixed", on = "AB.end" }
[constraints.guide]
kind = "support"
point = "B.center"
normal = [0, 1]
at = [0, 0]
"""

SLIDER_CRANK_BY_A_PIN = """
[coordinates]
theta = 0
phi = { dependent = true, near = 0 }
x = { dependent = true, near = "4*l" }
[bodies.B]
shape = { kind = "particle", mass = "2*M" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[constraints.hinge]
kind = "pin"
points = ["AB.end", "B.center"]
"""

SLIDER_CRANK_CLOSED = SLIDER_CRANK_BY_A_PIN.replace("{ dependent = true, near = 0 }", "0").replace(
    '{ dependent = true, near = "4*l" }', '{ start = "4*l" }'
)

PARALLELOGRAM = """
[bodies.OA]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
joint = { kind = "revolute", at = [0, 0], angle = "-theta" }
[bodies.CB]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
joint = { kind = "revolute", at = ["3*l", 0], angle = "-phi" }
[bodies.AB]
shape = { kind = "rod", mass = "4*M", length = "3*l" }
joint = { kind = "revolute", on = "OA.end", angle = "psi + theta" }
[constraints.B]
kind = "pin"
points = ["AB.end", "CB.end"]
[outputs]
v_A = { value = "speed(OA.end)", at = "theta = pi/2", from = "rest" }
R1_vertical = { value = "-reaction_x(OA, OA)", at = "theta = pi/2", from = "rest" }
R3_vertical = { value = "-reaction_x(CB, CB)", at = "theta = pi/2", from = "rest" }
R2_vertical = { value = "-reaction_y(OA, OA)", at = "theta = pi/2", from = "rest" }
R4_vertical = { value = "-reaction_y(CB, CB)", at = "theta = pi/2", from = "rest" }
"""

PARALLELOGRAM_OF_A_TRANSLATING_COUPLER = """
[coordinates]
theta = 0
[bodies.OA]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
joint = { kind = "revolute", at = [0, 0], angle = "-theta" }
[bodies.CB]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
joint = { kind = "revolute", at = ["3*l", 0], angle = "-theta" }
[bodies.AB]
shape = { kind = "rod", mass = "4*M", length = "3*l" }
joint = { kind = "placed", at = ["2*l*cos(theta)", "-2*l*sin(theta)"] }
[constraints]
A = { kind = "pin", points = ["OA.end", "AB.start"] }
B = { kind = "pin", points = ["CB.end", "AB.end"] }
[outputs]
theta_d_squared = { value = "theta'^2", from = "rest" }
R1 = { value = "-reaction_x(OA, OA)", from = "rest" }
R2 = { value = "-reaction_y(OA, OA)", from = "rest" }
R1_vertical = { value = "reaction_y(OA)", at = "theta = pi/2", from = "rest" }
"""

DISC_BAR_SLIDER = """
[bodies.disc]
shape = { kind = "disc", mass = "4*M", radius = "R" }
points = { A = [0, "R"] }
joint = { kind = "revolute", at = [0, 0], angle = "-theta" }
[bodies.AB]
shape = { kind = "rod", mass = "3*M", length = "R" }
joint = { kind = "revolute", on = "disc.A", angle = "phi + theta" }
[bodies.B]
shape = { kind = "particle", mass = "M" }
joint = { kind = "fixed", on = "AB.end" }
[constraints.rail]
kind = "support"
point = "B.center"
normal = [0, 1]
at = [0, 0]
[outputs]
theta_d_squared = { value = "theta'^2", from = "rest" }
v_B = { value = "vx(B.center)", at = "theta = pi/2", from = "rest" }
omega_disc_end = { value = "-omega(disc)", at = "theta = pi/2", from = "rest" }
H_O = { value = "reaction_x(disc)", at = "theta = pi/2", from = "rest" }
V_O = { value = "reaction_y(disc)", at = "theta = pi/2", from = "rest" }
N_B = { value = "reaction_y(rail)", at = "theta = pi/2", from = "rest" }
"""

ATWOOD = """
[bodies.pulley]
shape = { kind = "disc", mass = "6*M", radius = "R" }
joint = { kind = "revolute", at = [0, 0], angle = "theta" }
[bodies.P]
shape = { kind = "particle", mass = "2*M" }
joint = { kind = "placed", at = ["-R", "-1 - p"] }
[bodies.Q]
shape = { kind = "particle", mass = "M" }
joint = { kind = "placed", at = ["R", "-1 + q"] }
[constraints.wire]
kind = "string"
path = ["P.center", { body = "pulley", turn = "cw" }, "Q.center"]
strands = ["up", "down"]
[outputs]
theta_dd = "theta''"
a_P = "-ay(P.center)"
v_P_2s = { value = "p'", at = "t = 2" }
y_P_2s = { value = "p", at = "t = 2" }
T1 = "tension(wire, 1)"
T2 = "tension(wire, 2)"
V_O = "reaction_y(pulley)"
H_O = "reaction_x(pulley)"
"""

DOUBLE_ATWOOD = """
[coordinates]
s = 0
q2 = 0
turn_O = { dependent = true, start = 0 }
turn_C = { dependent = true, start = 0 }
c = { dependent = true, start = 0 }
q1 = { dependent = true, start = 0 }
[bodies.O]
shape = { kind = "disc", mass = "2*M", radius = "R" }
joint = { kind = "revolute", angle = "turn_O" }
[bodies.P]
shape = { kind = "particle", mass = "4*M" }
joint = { kind = "placed", at = ["-R", "-1 - s"] }
[bodies.C]
shape = { kind = "disc", mass = "2*M", radius = "R" }
joint = { kind = "placed", at = ["R", "-1 + c"], angle = "turn_C" }
[bodies.Q1]
shape = { kind = "particle", mass = "M" }
joint = { kind = "placed", at = [0, "-2 + q1"] }
[bodies.Q2]
shape = { kind = "particle", mass = "2*M" }
joint = { kind = "placed", at = ["2*R", "-2 + q2"] }
[constraints.first]
kind = "string"
path = ["P.center", { body = "O", turn = "cw" }, "C.center"]
strands = ["up", "down"]
[constraints.second]
kind = "string"
path = ["Q1.center", { body = "C", turn = "cw" }, "Q2.center"]
strands = ["up", "down"]
[outputs]
a_P = "s''"
z_dd = "-ay(Q2.center) + ay(C.center)"
T1 = "tension(first, 1)"
T2 = "tension(first, 2)"
T3 = "tension(second, 1)"
T4 = "tension(second, 2)"
V_O = "reaction_y(O)"
"""

UNROLLING_DISC = """
[coordinates]
theta = 0
y = { dependent = true, start = 0 }
[bodies.disc]
shape = { kind = "disc", mass = "M", radius = "R" }
joint = { kind = "planar", x = 0, y = "y", angle = "theta" }
[points]
A = ["R", 3]
[constraints.wire]
kind = "string"
path = ["A", { body = "disc", turn = "cw" }]
[outputs]
theta_dd = "theta''"
a_C = "-ay(disc.center)"
T = "tension(wire)"
"""

ROLLING_DISC_AND_BAR = """
[coordinates]
theta = { start = 0.2 }
phi = { dependent = true, start = 0 }
[bodies.bar]
shape = { kind = "rod", mass = "4*M", length = "3*R" }
joint = { kind = "placed", at = [0, "R + 3*R*cos(theta)"], angle = "theta - pi/2" }
[bodies.disc]
shape = { kind = "disc", mass = "2*M", radius = "R" }
joint = { kind = "revolute", on = "bar.end", angle = "phi" }
[constraints.wall]
kind = "support"
point = "bar.start"
normal = [1, 0]
[constraints.floor]
kind = "rolling"
body = "disc"
line = { at = [0, 0], normal = [0, 1] }
[outputs]
kinetic_energy = "kinetic_energy()"
Q_theta = "generalized_force(theta)"
theta_dd = "theta''"
omega_disc = "-omega(disc)"
N_A = "reaction_x(wall)"
"""

ROLLING_DISC_WITH_A_BAR = """
[coordinates]
x = 0
theta = 0.8
phi = { dependent = true, start = 0 }
[bodies.disc]
shape = { kind = "disc", mass = "2*M", radius = "R" }
joint = { kind = "planar", x = "x", y = "R", angle = "phi" }
[bodies.AB]
shape = { kind = "rod", mass = "3*M", length = "4*R" }
joint = { kind = "revolute", on = "disc", angle = "theta - pi/2 - phi" }
[constraints.floor]
kind = "rolling"
body = "disc"
line = { at = [0, 0], normal = [0, 1] }
[outputs]
kinetic_energy = "kinetic_energy()"
x_dd = "x''"
theta_dd = "theta''"
N_ground = "reaction_n(floor)"
F_friction = "reaction_x(floor)"
"""

SMOOTH_PEG = """
[coordinates]
theta = 0
z = { dependent = true, start = 0 }
[points]
O2 = [0, "2*l"]
[bodies.bar]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
joint = { kind = "revolute", angle = "-theta" }
[bodies.Q]
shape = { kind = "particle", mass = "M" }
joint = { kind = "prismatic", at = [0, "-l"], axis = [0, 1], displacement = "z" }
[constraints.wire]
kind = "string"
path = ["bar.end", { at = "O2", radius = 0, turn = "ccw", slip = true }, "Q.center"]
[outputs]
v_A = { value = "speed(bar.end)", at = "theta = pi/2", from = "rest" }
v_A_squared = { value = "speed(bar.end)^2", at = "theta = pi/2", from = "rest" }
v_Q = { value = "speed(Q.center)", at = "theta = pi/2", from = "rest" }
"""

COLLAR_BY_A_SLIDER = """
[coordinates]
theta = 0.1
r = 0.3
[bodies.OA]
shape = { kind = "rod", mass = "3*M", length = "2*l" }
line = ["start", "end"]
joint = { kind = "revolute", angle = "-theta" }
[bodies.P]
shape = { kind = "particle", mass = "2*M" }
joint = { kind = "placed", at = ["r*cos(theta)", "-r*sin(theta)"] }
[constraints.sleeve]
kind = "slider"
point = "P.center"
on = "OA"
[outputs]
kinetic_energy = "kinetic_energy()"
Q_theta = "generalized_force(theta)"
Q_r = "generalized_force(r)"
N_P = "reaction_n(sleeve)"
"""

FALLING_BAR_ON_A_SUPPORT = """
[coordinates]
y = 0
phi = { start = 0.6, speed = 2 }
[bodies.P]
shape = { kind = "particle", mass = "M" }
joint = { kind = "placed", at = [0, "-y"] }
[bodies.PA]
shape = { kind = "rod", mass = "6*M", length = "2*l" }
joint = { kind = "placed", point = "center", at = ["l*sin(phi)", "-y - l*cos(phi)"], angle = "phi - pi/2" }
[constraints.hinge]
kind = "pin"
points = ["P.center", "PA.start"]
[constraints.rod]
kind = "support"
point = "P.center"
normal = [1, 0]
[outputs]
y_dd = "y''"
phi_dd = "phi''"
N_P = "reaction_x(rod)"
"""

STEPPED_DRUM = """
[coordinates]
theta = 0
p = { dependent = true, start = 0 }
c = { dependent = true, start = 0 }
phi = { dependent = true, start = 0 }
[points]
ceiling = ["-3*R", "R"]
[bodies.drum]
mass = "4*M"
inertia = "6*M*R^2"
joint = { kind = "revolute", angle = "-theta" }
[bodies.P]
shape = { kind = "particle", mass = "4*M" }
joint = { kind = "placed", at = ["2*R", "-1 - p"] }
[bodies.C]
shape = { kind = "disc", mass = "2*M", radius = "R" }
joint = { kind = "placed", at = ["-2*R", "-1 + c"], angle = "phi" }
[constraints.outer]
kind = "string"
path = [{ body = "drum", radius = "2*R", turn = "cw" }, "P.center"]
strands = ["down"]
[constraints.inner]
kind = "string"
path = [{ body = "drum", radius = "R", turn = "ccw" }, { body = "C", turn = "cw" }, "ceiling"]
strands = ["down", "up"]
[outputs]
theta_dd = "theta''"
a_P = "p''"
kinetic_energy = "kinetic_energy()"
T1 = "tension(outer)"
T2 = "tension(inner, 1)"
T3 = "tension(inner, 2)"
"""


def closed(text: str) -> str:
    """The text with no dependent coordinate: closed by multipliers. T is then of all the rates, and is not asked."""
    free = text.replace("{ dependent = true, start = 0 }", "0")
    return free.replace('kinetic_energy = "kinetic_energy()"\n', "")


FREE = {"p = 0\nq = 0\n": "closing", "p = { dependent = true }\nq = { dependent = true }\n": "dependent"}

ALTERNATIVES = {
    "slider-crank by a support": ("ch18_p2", CRANK + SLIDER_CRANK_BY_A_SUPPORT),
    "slider-crank by a pin": ("ch18_p2", CRANK + SLIDER_CRANK_BY_A_PIN),
    "slider-crank closed by multipliers": ("ch18_p2", CRANK + SLIDER_CRANK_CLOSED),
    "parallelogram, dependent": (
        "ch20_p2",
        PARALLELOGRAM
        + "[coordinates]\ntheta = 0\nphi = { dependent = true, near = 0.1 }\npsi = { dependent = true, near = 0 }",
    ),
    "parallelogram of pins": ("ch20_p2", PARALLELOGRAM_OF_A_TRANSLATING_COUPLER),
    "disc, bar and slider": (
        "ch20_p4",
        DISC_BAR_SLIDER + "[coordinates]\ntheta = 0\nphi = { dependent = true, near = -1.2 }",
    ),
    **{f"two loads, {how}": ("ch18_p1", ATWOOD + "[coordinates]\ntheta = 0\n" + loads) for loads, how in FREE.items()},
    "loads over two discs": ("ch20_p5", DOUBLE_ATWOOD),
    "disc on a wire": ("ch20_p1", UNROLLING_DISC),
    "rolling disc and leaning bar": ("ch22_p1", ROLLING_DISC_AND_BAR),
    "rolling disc with a swinging bar": ("ch22_p5", ROLLING_DISC_WITH_A_BAR),
    "bar and weight over a peg": ("ch18_p5", SMOOTH_PEG),
    "stepped drum": ("ch22_p4", STEPPED_DRUM),
    "stepped drum closed by multipliers": ("ch22_p4", closed(STEPPED_DRUM)),
    "collar by a slider": ("ch22_p2", COLLAR_BY_A_SLIDER),
    "falling bar on a support": ("ch20_p6", FALLING_BAR_ON_A_SUPPORT),
    "rolling disc closed by multipliers": (  # its centre is free to rise too
        "ch22_p5",
        closed(ROLLING_DISC_WITH_A_BAR)
        .replace('y = "R"', 'y = "y"')
        .replace("phi = 0", 'phi = 0\ny = { start = "R" }'),
    ),
}
"""Name: (the seed that it is, its text without the head)."""

CLOSURES = {
    "ch18_p2": {"phi": "theta", "x": "4*l*cos(theta)"},
    "ch20_p2": {"phi": "theta", "psi": "0*theta"},
    "ch20_p4": {"phi": "theta - pi/2"},
}
"""What the constraints make of the other coordinates, on the branch that is meant."""
