"""What every constraint promises: its rows are the rates of its gaps, and its forces do no virtual work."""

from __future__ import annotations

import numpy as np
import pytest
from each import each
from moving import State, at, equal, solved, state_of, written

import eomgen
from eomgen.mechanics.constraints.rows import Row
from eomgen.mechanics.dynamics.system import System
from eomgen.model.constraints import ALL
from eomgen.symbolic.expression.derivatives import gradient, tangent
from eomgen.symbolic.expression.node import Scalar
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.numeric.evaluation import fifty_digits

pytestmark = pytest.mark.slow

PLANE, SPACE = "plane", "space"
EXAMPLES = {
    "pin": {
        PLANE: [
            'points = ["first.P"]',
            'points = ["first.P", "second.P"]',
            'points = ["first.P", "cart.P"]',
            'points = ["first.P", "second.P", "cart.P"]',
            'points = ["first.M", "cart.P"]',
        ],
        SPACE: [
            'points = ["first.P"]',
            'points = ["first.P", "second.P"]',
            'points = ["first.P"], axis = [0, 3, 4]',
            'points = ["first.P", "second.P"], axis = [0, 3, 4]',
        ],
    },
    "support": {
        PLANE: [
            'point = "first.P", normal = [3, 4], at = [1, 2]',
            'point = "second.P", normal = [0, 1]',
            'point = "cart.P", normal = ["l", "-2*l"], at = "G"',
            'point = "first.M", normal = [1, 0]',
        ],
        SPACE: [
            'point = "first.P", normal = [2, 1, 2], at = [1, 2, 3]',
            'point = "cart.P", normal = [1, 1, 1], at = "G"',
        ],
    },
    "clamp": {
        PLANE: ['point = "first.P"', 'points = ["first.P", "second.P"]', 'points = ["G", "first.P", "second.P"]'],
        SPACE: ['point = "second.P"', 'points = ["first.P", "second.P"]'],
    },
    "guide": {
        PLANE: ['point = "first.P", along = [1, 0]', 'point = "second.P", along = [-3, "4*l"]'],
        SPACE: ['point = "first.P", along = [1, 0, 0]', 'point = "second.P", along = [1, "2*l", -2]'],
    },
    "slider": {
        PLANE: ['point = "second.P", on = "first"', 'point = "first.M", on = "second"', 'point = "G", on = "second"'],
        SPACE: ['point = "second.P", on = "first"', 'point = "cart.P", on = "second"', 'point = "G", on = "first"'],
    },
    "link": {
        PLANE: [
            'points = ["first.P", "second.P"]',
            'points = ["first.P", "G"], length = "l"',
            'points = ["cart.P", "first.M"]',
        ],
        SPACE: ['points = ["first.P", "second.P"], length = "2*l"', 'points = ["cart.P", "G"]'],
    },
    "rolling": {
        PLANE: [
            'body = "second", line = { at = [0, 0], normal = [0, 1] }, radius = 0.3',
            'body = "second", line = { at = "G", normal = [-3, 4] }, center = "C"',
            'body = "second", on = "cart", line = { at = [0, "l"], normal = [1, 2] }, slip = true',
            'body = "second", on = "first", line = { at = [1, "l"], normal = [0, 1] }',
            'body = "second", circle = { at = "G", radius = 2 }',
            'body = "second", circle = { at = [0, 0], radius = "3*l", inside = true }, slip = true',
            'body = "second", on = "first", circle = { at = [0, 1], radius = "3*l", inside = true }',
            'body = "second", on = "wheel"',
            'body = "wheel", on = "second", radius = "l"',
        ],
        SPACE: [
            'body = "second", plane = { at = "G", normal = [2, -1, 2] }, radius = 0.3',
            'body = "second", plane = { at = [0, 0, 0], normal = [0, 0, 1] }, radius = 0.3, axis = [1, 2, 2]',
            'body = "second", on = "first", plane = { at = [0, "l", 0], normal = [0, 3, 4] }, radius = 2, '
            'axis = [1, 0, 0], tube = "l/5"',
            'body = "second", on = "cart", plane = { at = [0, 0, 1], normal = [1, 2, 2] }, ellipsoid = ["l", 0.4, 0.5]',
            'body = "first", on = "second", plane = { at = [0, 0, 1], normal = [0, 0, 1] }, ellipsoid = [1, 2, 3], '
            'center = "P", slip = true',
            'body = "second", circle = { at = "G", radius = 3, inside = true, axis = [0, 3, 4] }, radius = "l"',
            'body = "second", on = "first", circle = { at = [0, 0, 1], radius = 3 }, radius = 0.2',
        ],
    },
    "skate": {
        PLANE: ['point = "first.P", along = [1, 0]', 'point = "second.P", along = ["l", -1]'],
        SPACE: ['point = "second.P", along = [1, 0, 0]', 'point = "first.P", along = [1, 2, 2], normal = [2, 1, 2]'],
    },
    "string": {
        PLANE: [
            'path = ["first.P", { at = [0, 3], radius = 0, turn = "cw", slip = true }, "second.P"]',
            'path = ["first.P", "cart.P", "second.P", "G"]',
            'path = ["first.P", { body = "second", turn = "cw" }, "G"]',
            'path = ["G", { body = "second", turn = "ccw" }, { body = "wheel", turn = "ccw", slip = true }, "cart.P"]',
            'path = [{ body = "wheel", turn = "cw" }, { body = "second", radius = "l/2", turn = "ccw" }, "first.M"]',
            'path = ["first.P", { body = "wheel", turn = "cw" }, "second.P"], strands = ["up", [3, -4]]',
            'path = ["first.P", { body = "wheel", turn = "cw", slip = true }, "cart.P"], strands = ["up", "down"]',
        ],
        SPACE: [
            'path = ["first.P", "second.P", "G", "cart.P"]',
            'path = ["G", "cart.P"]',
            'path = ["first.P", "G", "second.P"], strands = [[1, 2, -2], [0, -3, 4]]',
            'path = ["wheel.P", { at = [0, 0, 0], radius = 0.3, turn = "cw" }]',
            'path = [{ body = "wheel", turn = "ccw", radius = "l" }, { at = [0, 1, 0], radius = 0.3, turn = "cw" }]',
            'path = [{ body = "cart", turn = "cw", radius = "l", axis = [0, 2, 0] }, '
            '{ at = [0, 0, 9], radius = 0, turn = "cw", slip = true }, "cart.C"]',
            'path = [{ body = "cart", turn = "ccw", radius = 0.2, axis = [0, 2, 0] }, '
            '{ at = [0, 0, 9], radius = 0.3, turn = "cw", axis = [0, -1, 0] }]',
        ],
    },
    "capstan": {
        PLANE: [
            'path = ["first.P", { body = "wheel", turn = "cw" }, "second.P"], coefficient = 0.3, angle = "w"',
            'path = ["first.P", { at = [0, 3], radius = "l", turn = "ccw" }, "second.P"], coefficient = 1, angle = 7',
        ],
        SPACE: [
            'path = ["wheel.P", { at = [0, 0, 0], radius = 0, turn = "cw" }, "G"], coefficient = "w", angle = 1',
        ],
    },
    "gear": {
        PLANE: ['bodies = ["first", "second"], ratio = -2', 'bodies = ["wheel", "first"], ratio = "l/w"'],
        SPACE: ['bodies = ["first", "second"], ratio = -2', 'bodies = ["tool", "wheel"], ratio = "l/w"'],
    },
    "equation": {
        PLANE: [
            'gap = "a*cos(b) - l"',
            'gap = "b - l*sin(w*t)"',
            "rate = \"a' - 2*b*b'\"",
            "rate = \"a'*cos(b) - b'*sin(b) - l*t\"",
            'gap = "x(first.P)^2 + l*y(second.C) - angle(second)*t"',
            'gap = "x(first.M, second) - y(cart.P)*d"',
            'rate = "vx(second.P)*y(first.P) - l*omega(wheel, first) + d"',
            'rate = "vy(first.M, second) - a*s\'"',
        ],
        SPACE: [
            'gap = "a^2 + b^2 - s^2"',
            'gap = "z(cart.P) - x(first.P, second)^2*l"',
            'gap = "y(second.P)*d - t"',
            'rate = "vz(second.P, first)*x(cart.P) - omega_y(wheel)"',
            'rate = "omega_x(second, first) + vx(G)"',
        ],
    },
    "motion": {PLANE: ['coordinate = "a", value = "l*sin(w*t)"'], SPACE: ['coordinate = "s", value = "l*w*t^2"']},
}
CASES = [(k, space, f) for k, spaces in EXAMPLES.items() for space, fields in spaces.items() for f in fields]
KINDS = {constraint.kind: constraint for constraint in ALL}
built = each("kind, space, fields", CASES, by="kind")
WITHOUT_GAP = {"rolling": ["t", "s"], "skate": ["n"]}
"""The components whose rows are of velocities alone."""

BODIES = {
    PLANE: """
[points]
G = [2, 1]
[bodies.first]
mass = "m"
center = ["l/2", 0]
inertia = "m*l^2"
points = { P = ["l", "l/3"], M = ["l + d", "l*sin(w*t)"], A = [0, 0], B = ["l", 0] }
line = ["A", "B"]
joint = { kind = "revolute", angle = "a" }
[bodies.second]
shape = { kind = "disc", mass = "2*m", radius = "l/3" }
points = { P = ["l", "-l/5"], C = ["l/4", "l/7"], A = ["l", 0], B = ["l", "-2*l"] }
line = ["A", "B"]
joint = { kind = "planar", x = "s", y = "r", angle = "b" }
[bodies.wheel]
shape = { kind = "disc", mass = "m", radius = "l/2" }
joint = { kind = "revolute", at = [3, 4], angle = "e" }
[bodies.cart]
mass = "m"
inertia = 1
points = { P = ["l", "l"] }
joint = { kind = "prismatic", at = ["l*sin(w*t)", 0], axis = [3, 4], displacement = "d" }
""",
    SPACE: """
[points]
G = [2, 1, 0.5]
[bodies.first]
mass = "m"
center = ["l/2", 0, 0]
inertia = ["m*l^2", "m*l^2", "m*l^2"]
points = { P = ["l", "l/3", "l/4"], B = ["l", 0, 0] }
line = ["origin", "B"]
joint = { kind = "revolute", axis = [1, 2, 2], angle = "a" }
[bodies.second]
mass = "2*m"
inertia = ["m*l^2", "m*l^2", "m*l^2"]
points = { P = ["l", "-l/5", "l"], A = [0, 1, "l"] }
line = ["A", "P"]
joint = { kind = "placed", at = ["s", "r", "a*b"], angle = "b", axis = [0, 3, 4] }
[bodies.tool]
joint = { kind = "screw", on = "first.P", axis = [0, 3, 4], angle = "a*b", pitch = 0.2 }
[bodies.wheel]
mass = "m"
inertia = [1, 1, 1]
points = { P = ["l", "l/3", 0] }
joint = { kind = "revolute", at = [3, 4, 0], angle = "e" }
[bodies.cart]
mass = "m"
inertia = [1, 1, 1]
points = { P = ["l", "l", 0], C = [1, 0, "l"] }
joint = { kind = "prismatic", at = ["l*sin(w*t)", 0, 0], axis = [3, 0, 4], displacement = "d" }
""",
}
HEAD = """
[parameters]
m = 1.2
l = 0.7
w = 1.3
[coordinates]
a = 0.3
b = 0.5
s = 0.2
r = 0.4
d = 0.1
e = 0.6
"""


def system_with(kind: str, space: str, fields: str) -> System:
    """Three bodies, one of them on a seat that moves by itself, and the constraint."""
    return written(HEAD + BODIES[space] + f'[constraints]\ntie = {{ kind = "{kind}", {fields} }}\n', space)


def test_every_kind_of_tie_has_examples_here():
    """A constraint that is added to ALL is held to the contract."""
    kinds = {constraint.kind for constraint in ALL}
    lacking, left = sorted(kinds - EXAMPLES.keys()), sorted(EXAMPLES.keys() - kinds)
    assert not lacking, "write their fields into EXAMPLES of this file"
    assert not left


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_works_in_the_plane_and_in_space(kind):
    """All of the model file's kinds; each has examples for both."""
    assert all(KINDS[kind].works_in(space) and EXAMPLES[kind][space] for space in (PLANE, SPACE))


def row_times(row: tuple[Scalar, ...], x: tuple[Scalar, ...], start: Scalar) -> Scalar:
    return sum((a * b for a, b in zip(row, x, strict=True)), start=start)


@built
def test_the_tie_closes(kind, space, fields):
    """None of the examples is satisfied by the coordinates: every row closes and no row of J is 0."""
    constraints = system_with(kind, space, fields).constraints
    assert constraints.rows and constraints.closing == constraints.rows
    assert [row.label for row in constraints.closing] == [f"lam(tie, {k})" for k in range(1, len(constraints.rows) + 1)]


@built
def test_the_rows_are_the_rates_of_the_gaps(kind, space, fields):
    """J u + sigma = dphi/dt, as exact functions."""
    system = system_with(kind, space, fields)
    constraints, u = system.constraints, system.symbols.u
    for row, sigma, phi in zip(constraints.J, constraints.sigma, constraints.phi, strict=True):
        if phi is not None:
            assert equal((row_times(row, u, sigma),), system.scope.time_derivative((phi,)))


@built
def test_gamma_is_what_stays_of_the_rate_of_the_rows(kind, space, fields):
    """J a + gamma = d/dt (J u + sigma), J' u and sigma' included."""
    system = system_with(kind, space, fields)
    constraints, symbols = system.constraints, system.symbols
    for J, sigma, gamma in zip(constraints.J, constraints.sigma, constraints.gamma, strict=True):
        velocity = row_times(J, symbols.u, sigma)
        assert equal((row_times(J, symbols.a, gamma),), system.scope.with_accelerations((velocity,)))


@built
def test_a_gap_is_left_out_only_where_no_configuration_says_whether_the_tie_holds(kind, space, fields):
    """phi is None for rates that were given, no slip, knife edges, and strands that turn on something round."""
    for row in system_with(kind, space, fields).constraints.rows:
        turning = kind == "string" and ("body" in fields or "radius = 0.3" in fields) and "strands" not in fields
        turning |= kind == "capstan" and "radius = 0," not in fields
        assert (row.gap is None) == ("rate" in fields or row.component in WITHOUT_GAP.get(kind, ()) or turning)


def power_row(system: System, row: Row) -> tuple[Scalar, ...]:
    """B^T W of a row, from its wrenches and the bodies' columns, and the work on points that slide in their bodies."""
    total: list[Scalar] = list(gradient(row.direct, system.symbols.u))
    for body, wrench in row.wrenches:
        B = system.motion.B[system.motion.index[body]]
        for k in range(len(total)):
            total[k] = total[k] + row_times((*wrench.tau, *wrench.f), tuple(line[k] for line in B), 0)
    return tuple(total)


@built
def test_the_force_of_a_tie_is_dual_to_the_motion_that_it_forbids(kind, space, fields):
    """J^T = sum over bodies of B^T W, J = (dphi/dq) N: what pushes along n forbids motion along n."""
    system = system_with(kind, space, fields)
    for row, J in zip(system.constraints.closing, system.constraints.J, strict=True):
        if row.wrenches:
            assert equal(J, power_row(system, row))
        if row.gap is not None:
            assert equal(J, gradient(row.gap, system.symbols.q))  # every coordinate is free here: N = 1


def virtual_velocities(system: System, state: State) -> np.ndarray:
    """A basis of the u with J u = 0, one in each column."""
    J = np.array([at(row, state) for row in system.constraints.J])
    _, values, V = np.linalg.svd(J)
    return V[np.sum(values > 1e-9) :].T


@built
def test_a_tie_does_no_virtual_work(kind, space, fields):
    """J u = 0 implies (J^T lam) . u = 0: the wrenches against twists of the bodies, for any lam."""
    system = system_with(kind, space, fields)
    state = state_of(system)
    free = virtual_velocities(system, state)
    assert free.shape[1] >= 1
    forces = np.array([at(power_row(system, row), state) for row in system.constraints.closing if row.wrenches])
    lam = np.random.default_rng(1).normal(size=len(forces))
    if len(forces):
        assert lam @ forces @ free == pytest.approx(np.zeros(free.shape[1]), abs=1e-13)


@built
def test_a_tie_that_moves_by_itself_has_the_power_of_its_own_motion(kind, space, fields):
    """sigma = dphi/dt at u = 0, so that J u + sigma = 0 gives (J^T lam) . u = - lam . sigma."""
    system = system_with(kind, space, fields)
    for sigma, phi in zip(system.constraints.sigma, system.constraints.phi, strict=True):
        if phi is not None:
            assert equal((sigma,), tangent((phi,), {system.symbols.t: 1}))


INNER = [c for c in CASES if c[0] in ("pin", "clamp", "link") and c[2].count(".P") >= 2 and '"G"' not in c[2]]


@each("kind, space, fields", INNER)
def test_a_tie_between_bodies_pushes_equally_on_both(kind, space, fields):
    """sum F = 0, and the moments about the ground's origin differ by gap x F: none when the points meet."""
    system = system_with(kind, space, fields)
    for row in system.constraints.rows:
        F, M = Vector.ZERO, Vector.ZERO
        for body, wrench in row.wrenches:
            pose = system.motion.link(body).pose
            f = pose.R @ wrench.f
            F, M = F + f, M + (pose.R @ wrench.tau + pose.p.cross(f))
        assert equal(F, Vector.ZERO)
        places = [system.motion.position(system.motion.place(f"{body}.P")) for body, _ in row.wrenches]
        (body, wrench), gap = row.wrenches[0], [a - b for a, b in zip(*places, strict=True)]
        push = system.motion.link(body).pose.R @ wrench.f
        assert equal(M, Vector((gap[0], gap[1], gap[2])).cross(push))


ONE_PLACE = [c for c in CASES if (c[0] == "slider" and '"G"' not in c[2]) or (c[0] == "rolling" and "on =" in c[2])]


@each("kind, space, fields", ONE_PLACE)
def test_a_contact_of_two_bodies_pushes_both_at_one_place(kind, space, fields):
    """sum F = 0 and sum M = 0 about any point, of every row and of the friction: also where the contact is open."""
    system = system_with(kind, space, fields)
    for row in system.constraints.rows:
        pushed = [w for push in row.pushes if (w := system.motion.body_wrench(push)) is not None]
        assert equal(total(system, pushed), (0,) * 6)
        if kind == "rolling":
            friction = [w for push in row.tangent for w in [system.motion.body_wrench(push)] if w is not None]
            assert equal(total(system, friction), (0,) * 6)


def total(system: System, wrenches) -> tuple[Scalar, ...]:
    """Force and moment about the ground's origin of wrenches on bodies."""
    F, M = Vector.ZERO, Vector.ZERO
    for body, wrench in wrenches:
        pose = system.motion.link(body).pose
        f = pose.R @ wrench.f
        F, M = F + f, M + (pose.R @ wrench.tau + pose.p.cross(f))
    return (*F, *M)


SLOPE = """
[parameters]
m = 2.0
g = 10.0
[coordinates]
x = 0.0
y = 0.0
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.slope]
kind = "support"
point = "block.origin"
normal = [-3, 4]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_a_slope_pushes_along_its_normal_with_the_weights_share():
    """lam = m g cos(alpha) > 0, tan(alpha) = 3/4, and the block slides down with g sin(alpha)."""
    a, lam = solved(written(SLOPE), {"m": 2, "g": 10})
    assert lam == pytest.approx([2 * 10 * 4 / 5])
    assert a == pytest.approx([-10 * 3 / 5 * 4 / 5, -10 * 3 / 5 * 3 / 5])


def test_the_side_of_the_normal_turns_the_sign_of_the_push():
    """With the normal into the slope the same force is a push of - m g cos(alpha)."""
    _, lam = solved(written(SLOPE.replace("[-3, 4]", "[3, -4]")), {"m": 2, "g": 10})
    assert lam == pytest.approx([-2 * 10 * 4 / 5])


def test_only_the_direction_of_a_normal_counts():
    """A support pushes with a unit vector, so lam is a force in newtons."""
    _, lam = solved(written(SLOPE.replace("[-3, 4]", "[-30, 40]")), {"m": 2, "g": 10})
    assert lam == pytest.approx([2 * 10 * 4 / 5])


def test_a_pin_gives_the_force_on_the_first_body_named():
    """A mass hung on a held one: the hinge pulls the first-named lower mass up, lam_y = + m2 g."""
    system = written("""
[parameters]
m = 2.0
g = 10.0
[coordinates]
x = 0.0
y = 0.0
[bodies.held]
shape = { kind = "particle", mass = "3*m" }
joint = { kind = "fixed" }
[bodies.lower]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.hook]
kind = "pin"
points = ["lower.origin", "held.origin"]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
""")
    a, lam = solved(system, {"m": 2, "g": 10})
    assert a == pytest.approx([0, 0]) and lam == pytest.approx([0, 2 * 10])


def test_a_pendulum_in_two_coordinates_pulls_with_weight_and_centripetal_force():
    """At the lowest point with speed v: lam = m (g + v^2/l) for a gap along the rod, phi = -y - l."""
    system = written("""
[parameters]
m = 2.0
g = 10.0
l = 0.5
[coordinates]
x = 0.0
y = -0.5
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.rod]
kind = "equation"
gap = "sqrt(x^2 + y^2) - l"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
""")
    a, lam = solved(system, {"m": 2, "g": 10, "l": 0.5, "y": -0.5, "x'": 3})
    assert a == pytest.approx([0, 9 / 0.5])
    assert lam == pytest.approx([-2 * (10 + 9 / 0.5)])  # phi grows outwards, the rod pulls inwards


IDENTICAL = """
[parameters]
m = 1.0
l = 0.7
[coordinates]
theta = 0.3
[bodies.ladder]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "placed", at = [0, "l*cos(theta)"], angle = "theta - pi/2" }
"""


def test_rows_that_the_coordinates_satisfy_carry_a_reaction_and_close_nothing():
    """A ladder placed on wall and floor: both supports are identical, J has no row."""
    system = written(
        IDENTICAL
        + """
[constraints.wall]
kind = "support"
point = "ladder.start"
normal = [1, 0]
[constraints.floor]
kind = "support"
point = "ladder.end"
normal = [0, 1]
at = [0, 0]
"""
    )
    assert [row.identical for row in system.constraints.rows] == [True, True]
    assert all(row.wrenches for row in system.constraints.rows)
    assert system.constraints.closing == () and system.constraints.J == () and system.symbols.lam == ()


def test_a_gap_that_stays_open_is_no_identical_row():
    """phi = const != 0 is not satisfied, though its rate is 0: the row must not be dropped in silence."""
    text = IDENTICAL + '[constraints.wall]\nkind = "support"\npoint = "ladder.start"\nnormal = [1, 0]\nat = [-1, 0]\n'
    (row,) = written(text).constraints.rows
    assert not row.identical


def test_a_tie_of_coordinates_has_no_wrench():
    """An equation gives dphi/dq directly; its lam is a generalized force."""
    system = system_with("equation", PLANE, 'gap = "a*cos(b) - l"')
    (row,) = system.constraints.rows
    assert row.wrenches == ()
    assert equal(system.constraints.J[0], gradient(row.gap, system.symbols.q))


def test_a_rate_that_is_not_linear_in_the_rates_is_a_wrong_model():
    """J u + sigma = 0 has no place for a'^2."""
    with pytest.raises(eomgen.ModelError, match="the rate of 'tie' is not linear in the rates"):
        _ = system_with("equation", PLANE, "rate = \"a'^2 - b'\"").constraints


def test_a_pin_of_n_bodies_is_n_minus_1_hinges():
    """2 (n - 1) rows in the plane, the first body in each of them."""
    system = system_with("pin", PLANE, EXAMPLES["pin"][PLANE][3])
    assert [[body for body, _ in row.wrenches] for row in system.constraints.rows] == [
        ["first", "second"],
        ["first", "second"],
        ["first", "cart"],
        ["first", "cart"],
    ]


def test_one_point_alone_is_held_where_it_stands_at_the_start():
    """phi = p - p(start), so phi = 0 at the start values whatever they are."""
    system = system_with("pin", PLANE, 'points = ["first.P"]')
    model = eomgen.loads(f'eomgen = 1\nname = "t"\nspace = "plane"\n{HEAD + BODIES[PLANE]}')
    starts = (model.coordinates[q.name].start for q in system.symbols.q)
    state = {q: fifty_digits().number(e.evaluate({})) for q, e in zip(system.symbols.q, starts, strict=True)}
    state |= {p: fifty_digits().number(3) for p in system.symbols.parameters.values()}
    state[system.symbols.t] = fifty_digits().number(0)
    assert at(system.constraints.phi, state) == pytest.approx([0, 0], abs=1e-15)
