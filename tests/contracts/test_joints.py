"""What every joint promises: its subspace is the rate of its pose, and its complement is all that it can carry."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from each import each
from moving import at, equal, rate, state_of, written

import eomgen
from eomgen.errors import NotYet
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.kinematics.motion import BodyLink, spin_between
from eomgen.model.joints import ALL
from eomgen.model.joints.ball import SEQUENCES
from eomgen.symbolic.expression.formula import cos, sin
from eomgen.symbolic.expression.spatial import Matrix

SEAT = 'at = [0.1, 0.2, 0.3], turned = { axis = [1, 1, 0], angle = "pi/3" }'
QUATERNION = 'orientation = "quaternion", quaternion = ["e0", "e1", "e2", "e3"], omega = ["w1", "w2", "w3"]'
PLANE, SPACE = "plane", "space"
EXAMPLES = {
    "fixed": [
        (PLANE, "angle = 0.3"),
        (SPACE, f'{SEAT}, angle = "pi/5", axis = [1, 2, 2]'),
    ],
    "revolute": [
        (PLANE, 'angle = "2*a - b", at = [1, 2]'),
        (SPACE, f'{SEAT}, angle = "a"'),
        (SPACE, 'angle = "a*b", axis = [1, 2, 2]'),
        (SPACE, 'angle = "a + w*t", axis = ["l", 1, 0]'),
    ],
    "prismatic": [
        (PLANE, 'displacement = "a + b^2", axis = [3, 4], angle = 0.4'),
        (SPACE, f'{SEAT}, displacement = "a", axis = [1, 1, 1], angle = 0.7'),
        (SPACE, 'displacement = "l*cos(a)", axis = [0, 0, 5]'),
    ],
    "cylindrical": [
        (SPACE, 'axis = [1, 2, 2], displacement = "a", angle = "b"'),
        (SPACE, f'{SEAT}, axis = [0, 0, -3], displacement = "l*sin(a) + w*t", angle = "a - b"'),
    ],
    "screw": [
        (SPACE, 'axis = [0, 3, 4], angle = "a", pitch = 0.1'),
        (SPACE, f'{SEAT}, axis = [1, 1, 1], angle = "a + b*c", pitch = "l"'),
        (SPACE, 'axis = [0, 0, 1], angle = "a", pitch = 0'),
    ],
    "universal": [
        (SPACE, 'axes = [[1, 0, 0], [0, 2, 0]], angles = ["a", "b"]'),
        (SPACE, f'{SEAT}, axes = [[1, 2, 2], [0, 3, 4]], angles = ["a + b", "b*c"]'),
        (SPACE, 'axes = [[0, 0, 1], [1, 0, "l"]], angles = ["w*t", "a"]'),
    ],
    "planar": [
        (PLANE, 'x = "a", y = "b - w*t", angle = "c"'),
        (SPACE, f'{SEAT}, x = "a", y = "b", angle = "c + a"'),
    ],
    "spherical": [
        *((SPACE, f'orientation = "{s}", angles = ["a", "b", "c"]') for s in SEQUENCES),
        (SPACE, f'{SEAT}, orientation = "zyx", angles = ["a*b", "w*t", "c - a"]'),
        (SPACE, QUATERNION),
        (SPACE, f"{SEAT}, {QUATERNION}"),
    ],
    "free": [
        (PLANE, 'x = "a", y = "b", angle = "c"'),
        *(
            (SPACE, f'position = ["a", "l*b", "c - w*t"], orientation = "{s}", angles = ["c", "a", "b"]')
            for s in SEQUENCES
        ),
        (SPACE, f'position = ["a", "l*b", "c - w*t"], {QUATERNION}'),
    ],
    "placed": [
        (PLANE, 'at = ["l*cos(a)", "b*w*t"], angle = "a - c"'),
        (SPACE, 'at = ["a", "b", "c"], angle = "a*b", axis = [1, 2, 2]'),
        *((SPACE, f'at = ["a", 0, "b"], orientation = "{s}", angles = ["a", "b", "c"]') for s in SEQUENCES),
        (SPACE, f'at = ["a", 0, "b"], {QUATERNION}'),
    ],
    "path": [
        (PLANE, 'along = "a", at = [0, 0], pieces = [{ line = 1.0 }, { arc = 0.5, turn = "cw", angle = 1 }]'),
        (PLANE, 'along = "a - w*t", at = [1, 2], heading = "pi/3", pieces = [{ line = "l" }]'),
        (PLANE, 'along = "a", turned = { angle = 1 }, pieces = [{ arc = "l", turn = "ccw", angle = "pi/2" }]'),
        (
            PLANE,
            'along = "a + b", heading = "-pi/6", pieces = [{ arc = 0.2, turn = "ccw", angle = 2 }, { line = 0.1 }, '
            '{ arc = "l/3", turn = "cw", angle = 3 }, { arc = 0.4, turn = "ccw", angle = 1.5 }]',
        ),
        (SPACE, 'along = "a", pieces = [{ line = 1.0 }]'),
    ],
}
CASES = [(kind, space, fields) for kind, cases in EXAMPLES.items() for space, fields in cases]


TURNING = """
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = {}
w2 = {}
w3 = {}
"""


def text(kind: str, space: str, fields: str) -> str:
    """A body on the joint, and others that use all three coordinates."""
    inertia = "1" if space == PLANE else "[1, 1, 1]"
    axis = ", axis = [1, 0, 0]" if space == SPACE else ", axis = [1, 0]"
    others = "".join(
        f'[bodies.{q}x]\nmass = 1\ninertia = {inertia}\njoint = {{ kind = "prismatic"{axis}, displacement = "{q}" }}\n'
        for q in "abc"
    )
    return f"""
[parameters]
l = 0.7
w = 1.3
[coordinates]
a = 0.1
b = 0.2
c = 0.3
{TURNING if "quaternion" in fields else ""}
{others}
[bodies.child]
mass = 1
inertia = {inertia}
joint = {{ kind = "{kind}", {fields} }}
[bodies.clock]
mass = 1
inertia = {inertia}
joint = {{ kind = "prismatic"{axis}, displacement = "l*sin(w*t)" }}
"""


@cache
def works(kind: str, space: str, fields: str) -> bool:
    model = eomgen.loads(f'eomgen = 1\nname = "joint"\nspace = "{space}"\n{text(kind, space, fields)}')
    return model.bodies["child"].joint.works_in(space)


BUILT = [case for case in CASES if works(*case)]
UNBUILT = [case for case in CASES if not works(*case)]
built = each("kind, space, fields", BUILT, by="kind")


def system_with(kind: str, space: str, fields: str) -> tuple[System, BodyLink]:
    system = written(text(kind, space, fields), space)
    return system, system.motion.link("child")


def columns(found, state) -> np.ndarray:
    """The columns of S or W at a state, 6 x their number."""
    return np.array([at(column, state) for column in found]).reshape(len(found), 6).T


def test_every_kind_of_joint_has_examples_here():
    """A joint that is added to ALL is held to the contract."""
    kinds = {joint.kind for joint in ALL}
    lacking, left = sorted(kinds - EXAMPLES.keys()), sorted(EXAMPLES.keys() - kinds)
    assert not lacking, "write their fields into EXAMPLES of this file"
    assert not left
    assert {kind for kind, _, _ in BUILT} >= {joint.kind for joint in ALL}


@pytest.mark.parametrize(("kind", "space", "fields"), UNBUILT, ids=[f"{k}-{s}" for k, s, _ in UNBUILT])
def test_a_joint_that_is_not_built_ends_in_an_honest_message(kind, space, fields):
    """Exit 3 with the kind and the place, never a wrong answer."""
    with pytest.raises(NotYet, match=f"'{kind}' is not derived yet") as caught:
        written(text(kind, space, fields), space)
    assert caught.value.exit_code == 3
    assert caught.value.where == "bodies.child.joint"


@built
def test_the_subspace_is_the_rate_of_the_pose(kind, space, fields):
    """S s' = (vee(R^T R'), R^T p'): the twist of the child against the parent, child's axes, as exact functions."""
    system, link = system_with(kind, space, fields)
    scope, R, p = system.scope, link.relative.R, link.relative.p
    flat = scope.time_derivative(tuple(x for row in R for x in row))
    spin = spin_between(R, Matrix.of((flat[0:3], flat[3:6], flat[6:9])))
    velocity = R.T @ scope.rate_of(p)
    twist = [
        sum((column[k // 3][k % 3] * s for column, s in zip(link.S, link.s_rate, strict=True)), start=0)
        for k in range(6)
    ]
    assert equal(twist, (*spin, *velocity))


@built
def test_the_subspace_is_the_difference_of_neighbouring_poses(kind, space, fields):
    """S s' against central differences of the pose at 50 digits, without any derivative of expressions."""
    system, link = system_with(kind, space, fields)
    state = state_of(system)
    R = at([x for row in link.relative.R for x in row], state).reshape(3, 3)
    R_rate = rate(system, [x for row in link.relative.R for x in row], state).reshape(3, 3)
    turning = len(link.joint.spins) + 1 if link.joint.spins else 0  # the rates that the angular velocity stands for
    p_rate = rate(system, link.relative.p, state)
    s_rate = [*rate(system, link.s[: len(link.s) - turning], state), *at(link.s_rate[len(link.s) - turning :], state)]
    W = R.T @ R_rate
    expected = [W[2, 1], W[0, 2], W[1, 0], *(R.T @ p_rate)]
    S = columns([(*w, *v) for w, v in link.S], state)
    assert S @ s_rate == pytest.approx(expected, rel=1e-13, abs=1e-13)


@built
def test_the_columns_of_the_subspace_are_as_many_freedoms_as_variables(kind, space, fields):
    """rank S = f; a quaternion's four variables have three degrees of freedom."""
    system, link = system_with(kind, space, fields)
    S = columns([(*w, *v) for w, v in link.S], state_of(system))
    degrees_of_freedom = len(link.s) - (1 if link.joint.spins else 0)
    assert S.shape[1] == len(link.s_rate) == degrees_of_freedom == (np.linalg.matrix_rank(S) if link.s else 0)


@built
def test_the_complement_is_all_that_the_joint_can_carry(kind, space, fields):
    """S^T W = 0 as exact functions, rank S + rank W = 6; what is placed carries nothing."""
    system, link = system_with(kind, space, fields)
    W = link.joint.complement(link.s, system.scope.value)
    if not link.joint.carries_reaction:
        assert W == ()
        return
    S = [(*w, *v) for w, v in link.S]
    works = [sum((x * y for x, y in zip(s, w, strict=True)), start=0) for s in S for w in W]
    assert equal(works, [0] * len(works))
    both = np.hstack([columns(S, state_of(system)), columns(W, state_of(system))])
    assert both.shape == (6, 6) and np.linalg.matrix_rank(both) == 6


@built
def test_a_pose_turns_without_stretching(kind, space, fields):
    """R R^T = 1 for any length of the axis that was written."""
    _, link = system_with(kind, space, fields)
    R = link.local.R
    products = [sum((a * b for a, b in zip(x, y, strict=True)), start=0) for x in R for y in R]
    assert equal(products, [1, 0, 0, 0, 1, 0, 0, 0, 1])


@built
def test_every_drive_belongs_to_a_variable(kind, space, fields):
    """efforts() has one entry for each s, or none."""
    _, link = system_with(kind, space, fields)
    assert len(link.joint.efforts()) in (0, len(link.s))


@each("kind, space, fields", [case for case in BUILT if case[1] == PLANE])
def test_in_the_plane_the_turn_is_the_angle_of_the_pose(kind, space, fields):
    """R = Rot(z, turn)"""
    system, link = system_with(kind, space, fields)
    angle = link.joint.turn(link.s, system.scope.value)
    R = Matrix.rotation((0, 0, 1), cos(angle), sin(angle))
    assert equal([x for row in link.relative.R for x in row], [x for row in R for x in row])


@each("longer", ["[1, 2, 2]", "[10, 20, 20]", '["l", "2*l", "2*l"]'])
@each("kind", ["revolute", "prismatic"])
def test_only_the_direction_of_an_axis_counts(kind, longer):
    """axis and k axis, k > 0, give the same pose."""
    variable = "angle" if kind == "revolute" else "displacement"
    poses = []
    for axis in ('["1/3", "2/3", "2/3"]', longer):
        system, link = system_with(kind, SPACE, f'{variable} = "a", axis = {axis}')
        poses.append(at([*(x for row in link.pose.R for x in row), *link.pose.p], state_of(system)))
    assert poses[1] == pytest.approx(poses[0], rel=1e-14, abs=1e-14)


def test_an_angle_turns_the_child_counter_clockwise_against_the_parent():
    """Angle pi/2 about z: the child's x axis is the parent's y axis."""
    model = eomgen.loads("""
eomgen = 1
name = "quarter turn"
space = "plane"
[coordinates]
a = 0.1
[bodies.mover]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "a" }
[bodies.child]
mass = 1
inertia = 1
joint = { kind = "fixed", on = "mover", angle = "pi/2" }
""")
    R = System.of(model).motion.link("child").pose.R
    assert [row[0] for row in R] == [0, 1, 0]
