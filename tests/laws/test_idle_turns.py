"""Quaternions at an instant, starts of speeds that are partly declared, and turns that move no mass."""

from __future__ import annotations

import numpy as np
import pytest

import eomgen
from eomgen.errors import ModelError
from eomgen.mechanics.dynamics.wellposed import WellPosed

HEAD = 'eomgen = 1\nname = "unseen"\nspace = "space"\n'
ANGLES = '[coordinates]\na = "pi/2"\nb = 0\nc = 0\n', 'orientation = "xyz", angles = ["a", "b", "c"]'
QUATERNION = (
    "[coordinates]\ne0 = 1\ne1 = 1\ne2 = 0\ne3 = 0\n[speeds]\nw1 = {}\nw2 = {}\nw3 = {}\n",
    'orientation = "quaternion", quaternion = ["e0", "e1", "e2", "e3"], omega = ["w1", "w2", "w3"]',
)
GIVEN = """
[given]
velocity = ["vy(plate.A) = 2", "vz(plate.A) = 0", "omega_x(plate) = 3"]
acceleration = ["ay(plate.A) = 1", "az(plate.A) = 0", "epsilon_x(plate) = 0"]
[outputs]
vx = "vx(plate.C)"
vy = "vy(plate.C)"
vz = "vz(plate.C)"
ax = "ax(plate.C)"
ay = "ay(plate.C)"
az = "az(plate.C)"
"""


@pytest.mark.parametrize("coordinates, joint", [ANGLES, QUATERNION], ids=["angles", "quaternion"])
def test_given_velocities_of_a_turned_body(coordinates, joint):
    """v = w x r, a = e x r + w x (w x r), R = Rx(pi/2): A at (1, 0, 0) gives w = (3, 0, 2) and e = (0, 6, 1)."""
    body = f'[bodies.plate]\nmass = 2\ninertia = [3, 4, 5]\njoint = {{ kind = "spherical", {joint} }}\n'
    text = HEAD + coordinates + body + "points = { A = [1, 0, 0], C = [1, 2, 3] }\n" + GIVEN
    found = eomgen.solve(eomgen.loads(text))
    w, e, r = np.array([3, 0, 2]), np.array([0, 6, 1]), np.array([1, -3, 2])
    v = np.cross(w, r)
    a = np.cross(e, r) + np.cross(w, v)
    assert [found[name].value for name in ("vx", "vy", "vz")] == pytest.approx(v)
    assert [found[name].value for name in ("ax", "ay", "az")] == pytest.approx(a)


def test_given_velocities_of_a_quaternion_that_contradict():
    """vx of a point on the axis of x through a fixed point is 0; the norm of the quaternion is nobody's culprit."""
    body = f'[bodies.plate]\nmass = 2\ninertia = [3, 4, 5]\njoint = {{ kind = "spherical", {QUATERNION[1]} }}\n'
    points = "points = { A = [1, 0, 0], B = [0, 1, 0] }\n"
    given = '[given]\nvelocity = ["omega_z(plate) = 1", "vy(plate.A) = 2"]\n[outputs]\nv = "vx(plate.B)"\n'
    answer = eomgen.solve(eomgen.loads(HEAD + QUATERNION[0] + body + points + given))["v"]
    assert "'vy(plate.A) = 2' contradicts 'omega_z(plate) = 1'" in answer.message
    assert "norm" not in answer.message


# -- turns that move no mass -------------------------------------------------------------------------

COUPLER = """
[coordinates]
phi = { start = 0.4, speed = 2 }
s = { dependent = true, near = 0.3 }
a = 0
b = { dependent = true, near = 1 }
c = { dependent = true, near = -0.5 }
[bodies.crank]
shape = { kind = "rod", mass = 1, length = 0.1 }
joint = { kind = "revolute", axis = [0, 0, 1], angle = "phi" }
[bodies.slide]
mass = 1
joint = { kind = "prismatic", axis = [0, 1, 0], at = [0.05, 0, 0.15], displacement = "s" }
[bodies.coupler]
shape = { kind = "SHAPE", mass = 1, RADIUS length = 0.3 }
points = { far = FAR }
joint = { kind = "spherical", on = "crank.end", orientation = "xzy", angles = ["a", "b", "c"] }
[constraints.far]
kind = "pin"
points = ["coupler.far", "slide.origin"]
"""


def _coupler(shape: str, radius: str, far: str) -> eomgen.Model:
    return eomgen.loads(HEAD + COUPLER.replace("SHAPE", shape).replace("RADIUS", radius).replace("FAR", far))


def test_a_thin_rod_between_two_ball_joints_is_refused_by_name():
    """Its spin about its own axis has no inertia: M is singular, though no entry of its diagonal looks like 0."""
    with pytest.raises(ModelError, match=r"'coupler' can turn about an axis about which it has no inertia.*of 'a'"):
        eomgen.derive(_coupler("rod", "", "[0.3, 0, 0]")).rhs("numpy")


def test_a_coupler_with_an_inertia_about_its_axis_moves():
    """With J > 0 about its axis M is regular: the same coupler is derived, and proved by its free bodies."""
    moving = eomgen.derive(_coupler("cylinder", "radius = 0.01,", "[0.3, 0, 0]"))
    assert moving.certify().ok


def test_a_pendulum_of_one_rod_on_a_ball_joint_is_refused():
    """w along the rod has no energy: M u = 0 for a u in which all three angles take part."""
    coordinates, joint = ANGLES
    rod = '[bodies.rod]\nshape = { kind = "rod", mass = 1, length = 1 }\n'
    text = HEAD + coordinates.replace("= 0", "= 0.3") + rod + f'joint = {{ kind = "spherical", {joint} }}\n'
    with pytest.raises(ModelError, match="of 'a', 'b', 'c'"):
        eomgen.derive(eomgen.loads(text)).rhs()


# -- starts of speeds --------------------------------------------------------------------------------

PARTLY = """
[coordinates]
x = { start = 0, speed = 2 }
a = 0.1
b = 0.2
c = 0.3
[speeds]
v = "2*x'"
w1 = { rate = "a' + b'", start = 0.5 }
w2 = { rate = "b' - c'" }
w3 = { rate = "c'" }
[bodies.cart]
mass = 1
joint = { kind = "prismatic", axis = [1, 0, 0], displacement = "x" }
[bodies.top]
mass = 1
inertia = [1, 2, 3]
joint = { kind = "spherical", on = "cart", orientation = "xyz", angles = ["a", "b", "c"] }
"""


@pytest.mark.slow
def test_a_coordinate_keeps_its_start_speed_beside_speeds_of_other_rates():
    """v = 2 x' = 4 by the speed of x; w2 and w3, which share b' and c' with w1, begin as they say: at 0."""
    run = eomgen.simulate(eomgen.loads(HEAD + PARTLY), time=1e-3)
    assert [run[name][0] for name in ("v", "w1", "w2", "w3")] == [4, 0.5, 0, 0]


def test_a_start_speed_of_a_rate_that_a_begun_speed_reaches_through_another_is_refused():
    """w1 holds a' + b', w2 b' - c', w3 c': the start of w1 speaks for c' too."""
    with pytest.raises(ModelError, match="coordinate 'c' has a 'speed' at the start"):
        eomgen.loads(HEAD + PARTLY.replace("c = 0.3", "c = { start = 0.3, speed = 1 }"))


def test_two_coordinates_of_one_angle_are_refused():
    """a' = -b' turns nothing: M = I (1, 1; 1, 1) is singular."""
    bar = '[bodies.bar]\nshape = { kind = "rod", mass = 1, length = 1 }\n'
    turned = 'joint = { kind = "revolute", angle = "a + b" }\n'
    head = 'eomgen = 1\nspace = "plane"\n[coordinates]\na = 0.1\nb = 0.2\n'
    with pytest.raises(ModelError, match="'a', 'b' can move together without moving a mass"):
        eomgen.derive(eomgen.loads(head + bar + turned)).rhs("numpy")


@pytest.mark.parametrize("length", ["1e-200", "1", "1e200", "1e300"])
def test_a_length_of_any_size_is_no_idle_motion(length):
    """Two masses on arms of that length: M is as regular as with arms of 1 m, though no double holds its entries."""
    arm = 'shape = {{ kind = "particle", mass = 1 }}\njoint = {{ kind = "placed", at = ["{x}", "{y}"] }}\n'
    first, second = ("R*cos(a)", "R*sin(a)"), ("R*cos(a) + R*cos(a + b)", "R*sin(a) + R*sin(a + b)")
    bodies = "".join(f"[bodies.p{k}]\n" + arm.format(x=x, y=y) for k, (x, y) in enumerate((first, second)))
    text = (
        f'eomgen = 1\nname = "arms"\nspace = "plane"\nparameters.R = {length}\ncoordinates = {{ a = 0.3, b = 0.4 }}\n'
    )
    equations = eomgen.derive(eomgen.loads(text + bodies))
    assert WellPosed(equations.graph).massless_motions == ()
    with pytest.raises(ModelError, match="'b'"):  # one mass, two angles: one of them moves nothing
        one = bodies.split("[bodies.p1]")[0].replace("R*cos(a)", "R*cos(a + b)").replace("R*sin(a)", "R*sin(a + b)")
        eomgen.simulate(eomgen.loads(text + one), time=0.1)
