"""Every field of every joint, constraint and force, in small models, by two routes: nothing is read and not derived."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from slow_run import ALL, sampled

import eomgen
from eomgen.mechanics.free_bodies.friction import SystemFriction
from eomgen.model import constraints, forces, joints
from eomgen.model.part import Part
from eomgen.proof import identities
from eomgen.proof.trials import Trials
from eomgen.robots.tables import toml_text

pytestmark = pytest.mark.slow

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
HEAD = """
eomgen = 1
space = "{}"
[parameters]
m = 1.3
l = 0.7
r = 0.2
k = 11
c = 0.4
mu = 0.2
"""
TENSOR = "mass = 'm'\ncenter = [0.1, -0.05, 0.2]\ninertia = [0.3, 0.4, 0.5, 0.02, -0.03, 0.01]\n"
YIELDING = "limits = ['inf', 0.1], stop = { stiffness = 'k', damping = 'c' }"
REBOUNDS = "restitution = 'mu'"
STOPS = "limits = [-1, 'l'], restitution = 'mu'"
ANGLES = "limits = { angles = [[-1, 'l'], ['-inf', 2]] }, restitution = 'mu'"
THREE = "limits = { angles = [[-3, 3], ['-inf', 3], ['-inf', 'inf']] }, restitution = 0.2"
RUBS = ", friction = { torque = 0.4, static = 0.5 }"
SLIDES = ", friction = { force = 0.7 }"
EFFORTS = "stiffness = 'k', damping = 'c', rest = 0.3, armature = 0.05"


def free(start: str = "") -> str:
    """A plate that nothing holds, in the plane."""
    return f"""
[coordinates]
x = {{ start = 0.4{start} }}
y = 1.1
d = 0.3
[bodies.plate]
shape = {{ kind = "disc", mass = "m", radius = "r" }}
points = {{ P = [0.3, 0.1], Q = [0, 0.1] }}
line = ["P", "Q"]
joint = {{ kind = "free", x = "x", y = "y", angle = "d" }}
"""


def loose(start: str = "") -> str:
    """A body that nothing holds, in space."""
    return f"""
[coordinates]
x = {{ start = 0.4{start} }}
y = 0.3
z = 0.5
a = 0.3
b = 0.2
d = -0.4
[bodies.plate]
{TENSOR}
points = {{ P = [0.3, 0.1, 0.2], Q = [0, 0.1, 0.4] }}
line = ["P", "Q"]
joint = {{ kind = "free", position = ["x", "y", "z"], orientation = "xyz", angles = ["a", "b", "d"] }}
"""


DRUM = """
[coordinates.e]
start = 0.1
[bodies.drum]
shape = { kind = "disc", mass = "m", radius = "l" }
points = { M = [0.3, 0] }
joint = { kind = "revolute", angle = "e" }
"""
ARMS = """
[inputs]
u = "sin(t)"
[coordinates]
a = { start = 0.4, speed = 0.3 }
b = { start = 1.1, speed = -0.6 }
[bodies.one]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "a"AXIS }
[bodies.two]
shape = { kind = "rod", mass = "m", length = "l" }
points = { Q = [0.5, 0.1ZERO] }
joint = { kind = "revolute", on = "one.end", angle = "b - a" }
"""
ARMS_3 = ARMS.replace("AXIS", ", axis = [1, 1, 0]").replace("ZERO", ", 0")
ARMS_2 = ARMS.replace("AXIS", "").replace("ZERO", "")
WHEEL = """
[coordinates.e]
start = 0.1
speed = 2
[coordinates.x]
start = 0.2
speed = -1
[bodies.wheel]
mass = 1
TENSOR
joint = { kind = "revolute", at = [9, 8ZERO], angle = "e"AXIS }
[bodies.block]
mass = 1
joint = { kind = "prismatic", axis = [1, 2ZERO], displacement = "x" }
"""
LEAKING = ARMS_2.replace('mass = "m", length = "l" }\npoints', 'mass = "m - c*t", length = "l" }\npoints')


def constraint(text: str, body: str) -> str:
    return f"[constraints.B]\n{text}\n" + body


def all_forces(**texts: str) -> str:
    return "".join(f"[forces.{name}]\n{text}\n" for name, text in texts.items())


def jointed(joint: str, *names: str, more: str = "") -> str:
    """A body of space by one joint, on a body that turns."""
    coordinates = "".join(f"{name} = {{ start = 0.{k + 4}, speed = {1.1 - k} }}\n" for k, name in enumerate(names))
    return f"""
[coordinates]
{coordinates}w = {{ start = 0.2, speed = 0.6 }}
[bodies.base]
{TENSOR}
points = {{ B = [0, "l", 0.3] }}
joint = {{ kind = "revolute", axis = [1, 1, 0], angle = "w" }}
[bodies.child]
{TENSOR}
points = {{ A = [0.1, 0.2, -0.1] }}
joint = {{ {joint} }}
{more}"""


SEAT = 'on = "base", at = [0.1, 0, "r"], point = "A", turned = { axis = [0, 1, 0], angle = 0.4 }'
POINT = 'on = "base.B", turned = [{ axis = [1, 0, 0], angle = "pi/5" }, { angle = 0.1 }]'
QUATERNION = (
    """
[coordinates]
e0 = 0.9
e1 = 0.1
e2 = -0.3
e3 = 0.2
[speeds]
w1 = { start = 0.3 }
w2 = { start = -0.2 }
w3 = { start = 1 }
[bodies.child]
"""
    + TENSOR
)
BY_QUATERNION = 'orientation = "quaternion", quaternion = ["e0", "e1", "e2", "e3"], omega = ["w1", "w2", "w3"]'
PIECES = '[{ name = "way", line = 0.5, friction = "mu" }, { arc = 1.2, turn = "cw", angle = 1 }]'

PLANE = {
    "joints": """
[coordinates]
q = { start = 0.2, speed = 1 }
s = { start = 0.3, speed = -0.4 }
x = 0.1
y = 0.2
d = { start = 0.3, speed = 0.5 }
[bodies.one]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = [0.1, 0.2], point = "end", angle = "q", torque = "2 - q'", STOPS, EFFORTS RUBS }
[bodies.two]
shape = { kind = "rectangle", mass = "m", width = "l", height = "r" }
joint = { kind = "prismatic", on = "one.start", axis = [1, 2], displacement = "s", angle = 0.4, force = "t", ALL }
[bodies.three]
shape = { kind = "disc", mass = "m", radius = "r" }
joint = { kind = "fixed", on = "two", at = ["r", 0], angle = 0.3 }
[bodies.four]
shape = { kind = "disc", mass = "m", radius = "r" }
joint = { kind = "planar", on = "two", x = "x", y = "y", angle = "d", WITH }
""".replace("WITH", 'limits = { x = [-1, "r"] }, restitution = 0.1, friction = { angle = { torque = 0.2 } }')
    .replace("ALL", "STOPS, EFFORTS" + SLIDES)
    .replace(" RUBS", RUBS)
    .replace("EFFORTS", EFFORTS)
    .replace("STOPS", STOPS),
    "placed": """
[coordinates]
q = { start = 0.2, speed = 1 }
[bodies.one]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "placed", at = ["l*q", "q^2"], point = "center", angle = "2*q" }
""",
    "path": f"""
[coordinates]
s = {{ start = 0.2, speed = 1 }}
[bodies.bead]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "path", at = [0, 1], along = "s", heading = 0.3, pieces = {PIECES} }}
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
""",
    "forces": LEAKING
    + all_forces(
        weight="kind = 'gravity'\nacceleration = ['sin(t)', -9.81]\nbodies = ['two']\naxis_down = true",
        force="kind = 'force'\npoint = 'two.Q'\nforce = ['u', \"-a'\"]\naxes = 'one'",
        couple="kind = 'couple'\nbody = 'two'\ncouple = 'u*a'\npoint = 'two.Q'",
        even="kind = 'distributed'\nbody = 'two'\nbetween = ['start', 'end']\nintensity = [0, -3]",
        ramp="kind = 'distributed'\nbody = 'one'\nbetween = ['start', 'end']\nintensities = [[0, 0], ['u', -3]]",
        spring="kind = 'spring'\npoints = ['two.Q', 'one.start']\nstiffness = 'k'\nlength = 0.3",
        level="kind = 'spring'\npoints = ['two.Q', 'one.start']\nstiffness = 'k'\nlength = 'start'\nalong = [1, 2]",
        damper="kind = 'damper'\npoints = ['two.Q', 'one.start']\ndamping = 'c'\nalong = [1, 2]",
        twist="kind = 'torsion_spring'\nbodies = ['one', 'two']\nstiffness = 'k'\nrest = 0.2",
        twist_1="kind = 'torsion_spring'\nbody = 'two'\nstiffness = 'k'",
        drag="kind = 'torsion_damper'\nbodies = ['one', 'two']\ndamping = 'c'",
        drag_1="kind = 'torsion_damper'\nbody = 'two'\ndamping = 'c'",
        pull="kind = 'between'\npoints = ['two.Q', 'one.start']\npull = \"k/r^2 - c*r'\"",
        field="kind = 'potential'\nenergy = 'k*cos(a - b)*t'",
        water="kind = 'kinetic'\nenergy = \"m*l^2*(a'^2 + cos(b)*a'*b'/2)\"",
        push="kind = 'generalized'\ncoordinate = 'a'\nvalue = \"u - c*a'\"",
        jet="kind = 'mass_flow'\npoint = 'two.Q'\nvelocity = ['u', \"-a'\"]\naxes = 'one'\nrate = 'c*u'",
        buffer="kind = 'bumper'\npoints = ['two.Q', 'one.start']\nstiffness = 'k'\nlength = 2\ndamping = 'c'",
        hertz="kind = 'bumper'\npoints = ['two.Q', 'one.start']\nstiffness = 'k'\nlength = 9\nexponent = 1.5\n"
        "dissipation = 'c'\nalong = [1, 2]",
        rope="kind = 'rope'\npath = ['two.Q', 'one.start']\nstiffness = 'k'\nlength = 0.1\ndamping = 'c'",
        teeth="kind = 'gear_mesh'\nbodies = ['one', 'two']\nratio = -2\nstiffness = 'k'\ndamping = 'c'\n"
        "backlash = 0.1\nefficiency = 0.9\nsmooth = 0.2",
        ram="kind = 'hydraulic_cylinder'\npoints = ['two.Q', 'one.start']\nareas = ['l', 0.2]\nvolumes = [1, 'm']\n"
        "retracted = 0.1\nstroke = 4\nbulk = 'k'\nleakage = 0.01\nflows = ['c*u', 0]\npressures = [1, 'k']\n"
        "valve = { opening = 'u', flow = 1, drop = 'c', supply = 'k', tank = 0.1, smooth = 0.2 }",
        gas="kind = 'pneumatic_cylinder'\npoints = ['two.Q', 'one.start']\nareas = ['l', 0.2]\nvolumes = [1, 'm']\n"
        "retracted = 0.1\nstroke = 4\nexponent = 1.4\npressures = [1, 'k']\noutside = 'c'\nlength = 0.3",
        air="kind = 'pneumatic_cylinder'\npoints = ['two.Q', 'one.start']\nareas = 0.2\nvolumes = 1\nretracted = 0.1\n"
        "exponent = 1.4\npressures = 'k'\nflows = 'c*u'\ngas = 2\ntemperature = 'l'\n"
        "valve = { opening = 'u', conductance = 'c', critical = 0.3, supply = 'k', exhaust = 0.1, smooth = 0.2 }",
        air_drag="kind = 'drag'\npoint = 'two.Q'\ndensity = 'm'\narea = 2\ncoefficient = 'c'\nmedium = ['u', 1]\n"
        "smooth = 0.3",
        wing="kind = 'plate'\npoint = 'two.Q'\ndensity = 'm'\narea = 2\nlift = '2*alpha'\ndrag = 'c + alpha^2'\n"
        "chord = [3, 4]\nmedium = [-7, 'u']",
        float="kind = 'buoyancy'\npoint = 'two.Q'\ndensity = 'm'\nvolume = 0.2\nacceleration = [0, -9]\n"
        "medium = ['sin(t)', 0]",
        hull="kind = 'added_mass'\npoint = 'two.Q'\nmatrix = [['m', 0.1, 0], [0.1, 'k', 0.2], [0, 0.2, 1]]\n"
        "medium = ['sin(t)', 't']",
        hull_1="kind = 'added_mass'\npoint = 'one.end'\ndiagonal = ['m', 'k', 0.2]",
        tyre="kind = 'tyre'\npoint = 'two.Q'\nlateral = { B = 2, C = 1.3, D = 'k', E = 'c', relaxation = 'l' }\n"
        "longitudinal = { stiffness = 'k', relaxation = 0.2 }\nheading = [1, 'u']\nrolling = 'u'\nsmooth = 0.2",
        wheel="kind = 'tyre'\npoint = 'one.end'\nradius = 'l'\nlongitudinal = { B = 2, C = 1.3, D = 'k' }\nup = [1, 2]",
        brush="kind = 'tyre'\npoint = 'two.Q'\nlateral = { stiffness = 'k', grip = 'm' }\n"
        "combined = 0.1\nrolling = 'u'",
        rain="kind = 'mass_flow'\npoint = 'two.end'\nabsolute = ['u', \"-a'\"]",
    ),
    "dry": ARMS_2
    + WHEEL.replace("AXIS", "").replace("ZERO", "").replace("TENSOR", "inertia = 1")
    + all_forces(
        lining="kind = 'clutch'\nbodies = ['one', 'two']\nnormal = 'u + k'\ncoefficient = 0.1\nradius = 'l'\n"
        "faces = 2\nstatic = 0.2",
        pads="kind = 'brake'\nbody = 'block'\nforce = 'k*t'\nstatic = 99",
        coupling="kind = 'clutch'\nbodies = ['one', 'two']\ntorque = 'k*t'\nsmooth = 0.5",
        shoe="kind = 'brake'\nbody = 'two'\ntorque = 'k*t'\nstatic = 90",
        shoes="kind = 'brake'\nbody = 'one'\nnormal = 'k*t'\ncoefficient = 0.2\nradius = 'l'\nfaces = 2\nsmooth = 1",
        flat="kind = 'belt'\nbodies = ['one', 'wheel']\nradii = [0.1, 0.2]\ntension = 'k'\ncoefficient = 0.3\n"
        "wrap = 3\ncrossed = true\nstatic = 0.4",
        vee="kind = 'belt'\nbodies = ['one', 'wheel']\nradii = [0.1, 0.2]\ntension = 'k'\ncoefficient = 0.3\n"
        "wrap = 3\nsmooth = 0.4",
    ),
    "capstan": constraint(
        "kind = 'capstan'\npath = ['plate.P', { body = 'drum', radius = 0.1, turn = 'cw' }, "
        "{ at = [2, 0], radius = 0.1, turn = 'ccw' }]\ncoefficient = 'mu'\nangle = 4\nunilateral = true",
        free(", speed = 1") + DRUM,
    ),
    "pin": constraint("kind = 'pin'\npoints = ['plate.P']", free()),
    "support": constraint(
        "kind = 'support'\npoint = 'plate.P'\nnormal = [1, 2]\nat = [0.7, 1]\nfriction = 'mu'", free(", speed = 1")
    ),
    "unilateral": constraint(
        "kind = 'support'\npoint = 'plate.P'\nnormal = [0, 1]\nunilateral = true\n" + REBOUNDS, free()
    ),
    "clamp": constraint("kind = 'clamp'\npoint = 'plate.P'", free()),
    "welded": constraint("kind = 'clamp'\npoints = ['plate.P', 'drum.M']", free() + DRUM),
    "guide": constraint("kind = 'guide'\npoint = 'plate.P'\nalong = [1, 2]", free()),
    "slider": constraint(
        "kind = 'slider'\npoint = 'drum.M'\non = 'plate'\nfriction = { viscous = 'c' }", free() + DRUM
    ),
    "pushing slider": constraint(
        "kind = 'slider'\npoint = 'drum.M'\non = 'plate'\nunilateral = true\n" + REBOUNDS, free() + DRUM
    ),
    "link": constraint(
        "kind = 'link'\npoints = ['plate.P', 'drum.M']\nlength = 1.26\nunilateral = true\n" + REBOUNDS,
        free() + DRUM,
    ),
    "rolling": constraint("kind = 'rolling'\nbody = 'plate'\nline = { at = [0, 0], normal = [-1, 3] }", free()),
    "slipping": constraint(
        "kind = 'rolling'\nbody = 'plate'\nline = { at = [0, 0], normal = [-1, 3] }\nslip = true\n"
        "friction = 'mu'\nradius = 0.3\ncenter = 'P'",
        free(", speed = 1"),
    ),
    "in a circle": constraint(
        "kind = 'rolling'\nbody = 'plate'\nunilateral = true\nrestitution = 'mu'\n"
        "circle = { at = [0, 1.5], radius = 0.765, inside = true }",
        free(),
    ),
    "on a body": constraint("kind = 'rolling'\nbody = 'plate'\non = 'drum'\nslip = true", free() + DRUM),
    "skate": constraint("kind = 'skate'\npoint = 'plate.P'\nalong = [1, 0.2]", free()),
    "string": constraint(
        "kind = 'string'\npath = ['plate.P', { at = [0.5, 2], radius = 0.1, turn = 'cw', slip = true }, "
        "{ body = 'drum', turn = 'cw' }]\nunilateral = true\n" + REBOUNDS,
        free() + DRUM,
    ),
    "straight strands": constraint(
        "kind = 'string'\npath = ['plate.P', { body = 'drum', turn = 'ccw' }]\nstrands = ['down']",
        free().replace("x = { start = 0.4 }", "x = 0.4").replace("d = 0.3", "d = 0") + DRUM,
    ),
    "gear": constraint("kind = 'gear'\nbodies = ['plate', 'drum']\nratio = -3.5", free() + DRUM),
    "equation": constraint("kind = 'equation'\ngap = 'y(plate.P, drum) - x(plate.P)^2 - 0.7'", free() + DRUM),
    "rate": constraint("kind = 'equation'\nrate = \"x' - r*d' - 0.3*omega(plate)\"", free()),
    "motion": constraint("kind = 'motion'\ncoordinate = 'x'\nvalue = '0.4 + sin(t)'", free(", speed = 1")),
}
DRUM_3 = """
[coordinates.e]
start = 0.1
[bodies.drum]
mass = 1
inertia = [0.3, 0.4, 0.5]
points = { M = [0.3, 0, 0] }
joint = { kind = "revolute", axis = [1, 2, 2], angle = "e" }
"""
FLOOR = "plane = { at = [0, 0, 0], normal = [0, 0.1, 1] }"
SPACE = {
    "fixed": jointed(f'kind = "fixed", {SEAT}, axis = [1, 2, 2], angle = 0.3'),
    "revolute": jointed(
        f'kind = "revolute", {SEAT}, axis = [1, -2, 2], angle = "a", torque = "2 - a\'", {YIELDING}, {EFFORTS}', "a"
    ),
    "prismatic": jointed(
        f'kind = "prismatic", {SEAT}, axis = [1, -2, 2], displacement = "a", force = "t", {YIELDING}, {EFFORTS}', "a"
    ),
    "cylindrical": jointed(
        f'kind = "cylindrical", {SEAT}, axis = [1, -2, "l"], displacement = "a", angle = "b", '
        'force = "-c*a\'", torque = "t", limits = { displacement = [-1, 2], angle = ["-inf", 3] }, restitution = "mu", '
        "friction = { displacement = { force = 0.6 }, angle = { torque = 0.3, smooth = 0.1 } }",
        "a",
        "b",
    ),
    "screw": jointed(
        f'kind = "screw", {SEAT}, axis = [1, -2, 2], angle = "a", pitch = 0.15, torque = "t", {STOPS}, {EFFORTS}{RUBS}',
        "a",
    ),
    "screw that yields": jointed(
        f'kind = "screw", {SEAT}, axis = [1, -2, 2], angle = "a", pitch = 0.2, {YIELDING}', "a"
    ),
    "universal": jointed(
        f'kind = "universal", {SEAT}, axes = [[1, 0, 0.2], [0, 1, 0]], angles = ["a", "b"], {ANGLES}', "a", "b"
    ),
    "planar": jointed(f'kind = "planar", {SEAT}, x = "a", y = "b", angle = "d"', "a", "b", "d"),
    "spherical": jointed(f'kind = "spherical", {SEAT}, orientation = "zxz", angles = ["a", "b", "d"], {THREE}', *"abd"),
    "path": jointed(f'kind = "path", {SEAT}, along = "a", heading = 0.3, pieces = {PIECES}', "a"),
    "placed": jointed(
        'kind = "placed", on = "base", at = ["a", 0, "b"], turned = { angle = 1 }, axis = [0, 1, 1], angle = "b"',
        "a",
        "b",
    ),
    "free": jointed(
        f'kind = "free", {SEAT}, position = ["a", "b", "d"], orientation = "xyz", angles = ["f", "h", "j"]',
        "a",
        "b",
        "d",
        "f",
        "h",
        "j",
    ),
    "placed by angles": jointed(
        'kind = "placed", on = "base", at = ["a", 0, "b"], orientation = "yxz", angles = ["b", "a", "2*b"]', "a", "b"
    ),
    "placed by a quaternion": QUATERNION + f'joint = {{ kind = "placed", at = ["t", 0, 1], {BY_QUATERNION} }}\n',
    "spherical by a quaternion": QUATERNION + f'joint = {{ kind = "spherical", {BY_QUATERNION} }}\n',
    "free by a quaternion": QUATERNION.replace("[speeds]", "x = 1\ny = 0\nz = { speed = 1 }\n[speeds]")
    + f'joint = {{ kind = "free", position = ["x", "y", "z"], {BY_QUATERNION} }}\n',
    "pin": constraint("kind = 'pin'\npoints = ['plate.P', 'drum.M']", loose() + DRUM_3),
    "hinge_in_a_body": constraint(
        "kind = 'pin'\npoints = ['plate.P', 'drum.M']\naxis = [1, 1, 0]\naxes = 'drum'", loose() + DRUM_3
    ),
    "hinge": constraint("kind = 'pin'\npoints = ['plate.P']\naxis = [1, 1, 0]", loose()),
    "support": constraint(
        "kind = 'support'\npoint = 'plate.P'\nnormal = [1, 2, 2]\nfriction = 'mu'", loose(", speed = 1")
    ),
    "clamp": constraint("kind = 'clamp'\npoints = ['plate.P', 'drum.M']", loose() + DRUM_3),
    "guide": constraint("kind = 'guide'\npoint = 'plate.P'\nalong = [1, 1, 0.3]", loose()),
    "slider": constraint(
        "kind = 'slider'\npoint = 'plate.P'\non = 'rail'\nfriction = 'mu'",
        """
[coordinates]
s = { start = 0.4, speed = 1 }
w = { motion = "t" }
[bodies.rail]
points = { A = [0, 0, 0], B = [1, 0, 0] }
line = ["A", "B"]
joint = { kind = "revolute", angle = "w" }
[bodies.plate]
shape = { kind = "particle", mass = "m" }
points = { P = [0, 0, 0] }
joint = { kind = "placed", on = "rail", at = ["s", 0, 0] }
""",
    ),
    "link": constraint("kind = 'link'\npoints = ['plate.P', 'drum.M']", loose() + DRUM_3),
    "ball": constraint(f"kind = 'rolling'\nbody = 'plate'\nradius = 0.3\n{FLOOR}", loose()),
    "slipping ball on a body": constraint(
        "kind = 'rolling'\nbody = 'plate'\nradius = 0.1\non = 'drum'\nslip = true\n"
        "friction = 'mu'\nplane = { at = [0, 0, 0.1], normal = [0, 0, 1] }",
        loose(", speed = 1") + DRUM_3,
    ),
    "ball in a pipe": constraint(
        "kind = 'rolling'\nbody = 'plate'\nradius = 0.1\n"
        "circle = { at = [0, 0, 0.1], radius = 0.7, axis = [1, 0, 0], inside = true }",
        loose(),
    ),
    "tyre": constraint(
        f"kind = 'rolling'\nbody = 'plate'\nradius = 0.3\ntube = 0.05\naxis = [0, 1, 0]\ncenter = 'P'\n{FLOOR}", loose()
    ),
    "wheel in a bowl": constraint(
        "kind = 'rolling'\nbody = 'plate'\nradius = 0.1\naxis = [0, 0, 1]\n"
        "circle = { at = [0, 0, 0.1], radius = 0.7, inside = true }",
        loose(),
    ),
    "ellipsoid": constraint(f"kind = 'rolling'\nbody = 'plate'\nellipsoid = [0.2, 0.3, 0.4]\n{FLOOR}", loose()),
    "skate": constraint("kind = 'skate'\npoint = 'plate.P'\nalong = [1, 0.3, 0.2]\nnormal = [0, 1, 3]", loose()),
    "string": constraint(
        "kind = 'string'\npath = ['plate.P', 'drum.M', "
        "{ at = [2, 0, 0], radius = 0.1, turn = 'cw', axis = [0, 1, 0] }]",
        loose() + DRUM_3.replace("axis = [1, 2, 2]", "axis = [0, 1, 0]"),
    ),
    "gear": constraint(
        "kind = 'gear'\nbodies = ['drum', 'wheel']\nratio = -3",
        DRUM_3
        + """
[coordinates.f]
[bodies.wheel]
mass = 1
inertia = [1, 1, 1]
joint = { kind = "revolute", at = [1, 0, 0], angle = "f" }
""",
    ),
    "equation": constraint("kind = 'equation'\ngap = 'z(plate.P, drum) - x(plate.P)^2 - 0.3'", loose() + DRUM_3),
    "rate": constraint(
        "kind = 'equation'\nrate = 'vx(plate.P) - 0.2*omega_z(plate) - 0.1*vy(plate.Q, drum)'", loose() + DRUM_3
    ),
    "motion": constraint("kind = 'motion'\ncoordinate = 'x'\nvalue = '0.4 + sin(t)'", loose(", speed = 1")),
    "dry": ARMS_3.replace("axis = [1, 1, 0]", "axis = [0, 0, 2]")
    + WHEEL.replace("AXIS", "").replace("ZERO", ", 0").replace("TENSOR", "inertia = [1, 1, 1]")
    + all_forces(
        flat="kind = 'belt'\nbodies = ['one', 'wheel']\nradii = [0.1, 0.2]\ntension = 'k'\ncoefficient = 0.3\n"
        "wrap = 3\naxis = [0, 0, 3]",
        lining="kind = 'clutch'\nbodies = ['one', 'two']\ntorque = 'u + k'",
    ),
    "forces": ARMS_3
    + all_forces(
        weight="kind = 'gravity'\nacceleration = ['sin(t)', 0, -9.81]\nbodies = ['two']",
        wing="kind = 'plate'\npoint = 'two.Q'\ndensity = 'm'\narea = 2\nlift = '2*alpha'\ndrag = 'c'\n"
        "chord = [3, 4, 0]\nnormal = [0, 0, -1]\nmedium = [-7, 'sin(t)', 1]",
        wheel="kind = 'tyre'\npoint = 'one.end'\nradius = 'l'\nlongitudinal = { stiffness = 'k' }\naxle = [1, 0, 2]\n"
        "lateral = { stiffness = 'k', relaxation = 2 }\nsmooth = 1",
        force="kind = 'force'\npoint = 'two.Q'\nforce = ['u', \"-a'\", 1]\naxes = 'one'",
        couple="kind = 'couple'\nbody = 'two'\ncouple = ['u*a', 0, 1]\naxes = 'one'",
        ramp="kind = 'distributed'\nbody = 'one'\nbetween = ['start', 'end']\nintensities = [[0, 0, 1], ['u', -3, 0]]",
        spring="kind = 'spring'\npoints = ['two.Q', 'one.start']\nstiffness = 'k'\nlength = 'start'\nalong = [1, 2, 2]",
        damper="kind = 'damper'\npoints = ['two.Q', 'one.start']\ndamping = 'c'",
        pull="kind = 'between'\npoints = ['two.Q', 'one.start']\npull = \"k/r^2 - c*r'\"",
    ),
}
SEQUENCES = ("xyx", "xyz", "xzx", "xzy", "yxy", "yxz", "yzx", "yzy", "zxy", "zxz", "zyx", "zyz")
SPACE |= {
    f"spherical {axes}": jointed(
        f'kind = "spherical", {POINT}, orientation = "{axes}", angles = ["a", "b", "d"]', "a", "b", "d"
    )
    for axes in SEQUENCES
}
SAMPLES = {f"plane {name}": HEAD.format("plane") + text for name, text in PLANE.items()}
SAMPLES |= {f"space {name}": HEAD.format("space") + text for name, text in SPACE.items()}


@sampled(3)
@pytest.mark.parametrize("name", SAMPLES)
def test_every_field_of_every_kind_is_derived_by_two_routes(name):
    """M, c and Q by energies, by projection and by recursion are equal at random exact states; then the free bodies."""
    equations = eomgen.derive(eomgen.loads(SAMPLES[name]))
    system, graph = equations.system, equations.graph
    trials = Trials(graph)
    checks = [*identities.compared(list(identities.routes(graph))), *trials.balance(), trials.free_bodies()]
    checks += [trials.friction()] if SystemFriction(system).exists else []
    assert [(check.name, check.detail) for check in checks if not check.ok] == []


def spoiled(value: Any) -> Iterator[Any]:
    """The tables, with one field of a part left out, or of a type that no field has."""
    for key in value if isinstance(value, dict) else ():
        yield {k: x for k, x in value.items() if k != key}
        yield value | {key: []}
        yield from (value | {key: changed} for changed in spoiled(value[key]))
    if isinstance(value, list) and any(isinstance(x, dict) for x in value):
        yield from ([*value[:k], changed, *value[k + 1 :]] for k, x in enumerate(value) for changed in spoiled(x))


@pytest.mark.parametrize("part", range(4 if ALL else 1))
def test_a_field_that_cannot_be_read_is_reported_by_name(part):
    """Each example less one field, or with an empty list there: a model, or a ModelError that names places."""
    for path in sorted(EXAMPLES.glob("*.toml"))[part :: 4 if ALL else 12]:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
        for table in tables.keys() & {"bodies", "constraints", "forces", "states"}:
            for changed in spoiled(tables[table]):
                text = toml_text(tables | {table: changed})
                try:
                    eomgen.loads(text)
                except eomgen.ModelError as error:
                    assert error.problems, text
                except Exception as error:
                    raise AssertionError(text) from error


def parts_in(value: Any) -> Iterator[Part]:
    """Every part of a model, those in lists and tables included."""
    if isinstance(value, Part):
        yield value
        value = tuple(getattr(value, slot.name) for slot in type(value).slots())
    for x in value.values() if hasattr(value, "values") else value if isinstance(value, tuple) else ():
        yield from parts_in(x)


def test_no_field_of_a_joint_a_constraint_or_a_force_is_left_out():
    """Of each kind every field stands in a model above or in its example, with a value that is not its default.

    Examples are proven by the same routes (tests/test_kind_pages.py). A symbol is how something is printed, and no
    mechanics: tests/test_symbols.py.
    """
    used: set[tuple[type, str]] = set()
    examples = [path.read_text(encoding="utf-8") for path in sorted(EXAMPLES.glob("*.toml"))]
    for text in (*SAMPLES.values(), *examples):
        for part in parts_in(eomgen.loads(text)):
            used |= {(type(part), s.key) for s in type(part).slots() if getattr(part, s.name) != s.default}
    kinds = (*joints.ALL, *constraints.ALL, *forces.ALL)
    fields = [(kind, s.key) for kind in kinds for s in kind.slots() if s.key != "symbol"]
    left = [f"{key} of {kind.kind}: docs/examples/{kind.kind}.toml" for kind, key in fields if (kind, key) not in used]
    assert not left, "no model derives these fields: give them a value in the example, or in a model above"
