"""What every force promises: work and potential agree, inner forces balance, dampers take power."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from each import each
from moving import at, equal, state_of, written

import eomgen
from eomgen.errors import ModelError, NotYet
from eomgen.mechanics.dynamics import formulations as projection
from eomgen.mechanics.dynamics import formulations as recursive
from eomgen.mechanics.dynamics.system import (
    System,
)
from eomgen.mechanics.kinematics.inertia import SystemInertia
from eomgen.mechanics.kinematics.loads import Loads
from eomgen.mechanics.kinematics.scene import SystemScene
from eomgen.model.forces import ALL
from eomgen.model.forces.load import Couple, PointForce, UniformField
from eomgen.proof.declared_loads import Declared, acting_otherwise, declared_state_rates, working_otherwise
from eomgen.symbolic.expression.derivatives import gradient
from eomgen.symbolic.expression.node import Scalar
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import fifty_digits

PLANE, SPACE = "plane", "space"
SLIDING = 'points = ["upper.R", "lower.M"]'  # M slides in its body
TWO, GROUND = 'points = ["upper.R", "lower.P"]', 'points = ["G", "lower.P"]'
ONE = 'areas = 2, volumes = "l", retracted = "l/9"'
BOTH = 'areas = [3, "k/9"], volumes = ["l", 1], retracted = 0.1, stroke = 9'
GAS = 'conductance = "c", critical = 0.4, supply = "3*k", exhaust = "g/9"'
WARM = 'gas = "g", temperature = 3'
MAGIC = 'B = "l", C = "w", D = "k"'
ROLLS = 'longitudinal = { stiffness = "g", relaxation = "w" }'
RATED = 'flow = "c", drop = "w"'
INERTIAL = ("kinetic", "added_mass")
SQUARE = [["m" if i == j else (i + j) / 20 for j in range(6)] for i in range(6)]
EXAMPLES = {
    "gravity": {
        PLANE: [
            'acceleration = [0.1, "-g"]',
            'acceleration = ["g*sin(w*t)", "-g"]',
            'acceleration = [0, "-g"], bodies = ["lower"]',
        ],
        SPACE: ['acceleration = ["g/3", "g/5", "-g"]', 'acceleration = [0, 0, "-g"], bodies = ["upper"]'],
    },
    "force": {
        PLANE: [
            'point = "lower.P", force = ["k*l", "-c*b\'"]',
            'point = "lower.P", force = ["tau", 2], axes = "lower"',
            'point = "lower.P", force = ["k*a", 2], axes = "upper"',
            'point = "lower.M", force = ["k", 2]',
            'point = "lower.W", force = ["k", 2], axes = "lower"',
        ],
        SPACE: [
            'point = "lower.P", force = [1, "tau", "k*b"]',
            'point = "upper.P", force = [1, 2, 3], axes = "lower"',
            'point = "lower.M", force = [1, "k", 2]',
        ],
    },
    "couple": {
        PLANE: ['body = "lower", couple = "k - c*b\'"', 'body = "upper", couple = "tau"'],
        SPACE: ['body = "lower", couple = [1, "tau", "k*b"]', 'body = "lower", couple = [1, 2, 3], axes = "upper"'],
    },
    "distributed": {
        PLANE: [
            'body = "lower", between = ["origin", "P"], intensity = [1, "-k"]',
            'body = "lower", between = ["P", "R"], intensities = [[0, "-k"], [2, "c*a\'"]]',
        ],
        SPACE: ['body = "upper", between = ["origin", "P"], intensities = [[1, 2, "k"], [0, 0, 0]]'],
    },
    "spring": {
        PLANE: [
            f'{TWO}, stiffness = "k", length = "l"',
            f'{GROUND}, stiffness = "k", length = "start"',
            f'{TWO}, stiffness = "k", length = "l", along = [3, 4]',
            f'{TWO}, stiffness = "k*t", length = "l*t"',
            f'{SLIDING}, stiffness = "k", length = "l"',
        ],
        SPACE: [f'{TWO}, stiffness = "k", length = "l"', f'{GROUND}, stiffness = "k", length = 0, along = [1, 2, 2]'],
    },
    "damper": {
        PLANE: [
            f'{TWO}, damping = "c"',
            f'{GROUND}, damping = "c"',
            f'{TWO}, damping = "c", along = [3, 4]',
            f'{SLIDING}, damping = "c"',
        ],
        SPACE: [f'{TWO}, damping = "c"', f'{GROUND}, damping = "c", along = [1, 2, 2]', f'{SLIDING}, damping = "c"'],
    },
    "torsion_spring": {
        PLANE: ['bodies = ["upper", "lower"], stiffness = "k", rest = 0.1', 'body = "lower", stiffness = "k"'],
    },
    "torsion_damper": {
        PLANE: ['bodies = ["upper", "lower"], damping = "c"', 'body = "lower", damping = "c"'],
    },
    "between": {
        PLANE: [f'{TWO}, pull = "k*l^2/r^2"', f'{GROUND}, pull = "k*(r - l)"', f'{TWO}, pull = "c*r\'*r"'],
        SPACE: [f'{TWO}, pull = "k*l^2/r^2"', f'{TWO}, pull = "k*r + c*r\'"'],
    },
    "bumper": {
        PLANE: [
            f'{TWO}, stiffness = "k", length = "4*l"',
            f'{GROUND}, stiffness = "k", length = "7*l", damping = "c"',
            f'{TWO}, stiffness = "k", length = "4*l", exponent = "3/2", dissipation = "c"',
            f'{SLIDING}, stiffness = "k", length = "9*l", exponent = 2',
            f'{GROUND}, stiffness = "k", length = "9*l", along = [3, 4], damping = "c"',
        ],
        SPACE: [
            f'{TWO}, stiffness = "k", length = "9*l"',
            f'{TWO}, stiffness = "k", length = "9*l", dissipation = "c"',
        ],
    },
    "hydraulic_cylinder": {
        PLANE: [
            f'{GROUND}, {ONE}, bulk = "k", flows = "c*b\'", pressures = "k"',
            f'{TWO}, {BOTH}, bulk = "k", flows = ["c*z", "l*a"], leakage = "c/9", pressures = ["k", "g"]',
            f'{SLIDING}, {BOTH}, bulk = "k", valve = {{ opening = "z", {RATED}, supply = "k" }}',
            f'{TWO}, {BOTH}, bulk = "k", valve = {{ opening = "-l", {RATED}, supply = "k", tank = 1, smooth = "c" }}',
        ],
        SPACE: [f'{TWO}, {BOTH}, bulk = "k", flows = ["c*z", "l*a"], leakage = "c/9", pressures = ["k", "g"]'],
    },
    "pneumatic_cylinder": {
        PLANE: [
            f'{GROUND}, {ONE}, exponent = 1.4, pressures = "k", outside = "c"',
            f'{TWO}, {BOTH}, exponent = "w", pressures = ["k", "g"], outside = 1, length = "2*l"',
            f'{SLIDING}, {BOTH}, exponent = 1, pressures = ["k", "g"], length = "start"',
            f'{TWO}, {BOTH}, exponent = "w", pressures = ["k", "g"], flows = ["c*z", "F_p_1/k"], {WARM}',
            f'{TWO}, {BOTH}, exponent = "w", pressures = ["k", "g"], {WARM}, valve = {{ opening = "l", {GAS} }}',
            f'{TWO}, {BOTH}, exponent = 1, pressures = [1, 9], {WARM}, valve = {{ opening = "-z", {GAS}, smooth = 2 }}',
        ],
        SPACE: [f'{GROUND}, {BOTH}, exponent = "w", pressures = ["k", "g"], outside = 1, length = "2*l"'],
    },
    "rope": {
        PLANE: [
            'path = ["upper.R", "lower.P"], stiffness = "k", length = "l/9"',
            'path = ["G", "upper.R", "lower.P"], stiffness = "k", length = "l*t/9", damping = "c/9"',
        ],
        SPACE: ['path = ["G", "upper.R", "lower.P"], stiffness = "k", length = "l/9", damping = "c/9"'],
    },
    "gear_mesh": {
        PLANE: [
            'bodies = ["upper", "lower"], ratio = -2, stiffness = "k"',
            'bodies = ["upper", "lower"], ratio = "l", stiffness = "k", backlash = "w/40", damping = "c/9"',
            'bodies = ["lower", "upper"], ratio = 3, stiffness = "k", efficiency = "w*3/5"',
            'bodies = ["lower", "upper"], ratio = 3, stiffness = "k", backlash = "w/90", efficiency = 1, smooth = "l"',
        ],
    },
    "clutch": {
        PLANE: [
            'bodies = ["upper", "lower"], torque = "k + tau"',
            'bodies = ["lower", "clock"], normal = "k*t^2", coefficient = "w", radius = "l", faces = 2, static = 3',
            'bodies = ["upper", "lower"], torque = "k*l", smooth = "c"',
        ],
        SPACE: ['bodies = ["upper", "lower"], torque = "k*(2 + a)"'],
    },
    "brake": {
        PLANE: [
            'body = "lower", torque = "k*exp(z)"',
            'body = "upper", normal = "k*(4 + tau)", coefficient = "c", radius = "l"',
        ],
        SPACE: ['body = "lower", torque = "k*(2 + tau)", static = 90'],
    },
    "belt": {
        PLANE: [
            'bodies = ["upper", "clock"], radii = ["l/9", 0.2], tension = "k", coefficient = "c", wrap = "w"',
            'bodies = ["upper", "clock"], radii = [0.1, "l/7"], tension = "k*t", coefficient = "c", wrap = 2, '
            "crossed = true, smooth = 2",
        ],
    },
    "mass_flow": {
        PLANE: [
            'point = "lower.P", velocity = ["k", "c*b\'"], axes = "lower", rate = "tau"',
            'point = "lower.M", absolute = ["k", 2], axes = "upper", rate = "-c - l*t"',
            'point = "leaking.origin", velocity = [1, "k"]',
            'point = "leaking.origin", absolute = [1, "k"]',
        ],
        SPACE: [
            'point = "lower.P", velocity = [1, "k", "c*b\'"], rate = "tau"',
            'point = "leaking.origin", absolute = [1, 0, "k"], axes = "upper"',
        ],
    },
    "drag": {
        PLANE: [
            'point = "lower.P", density = "k", area = 2, coefficient = "c"',
            'point = "lower.M", density = "k", area = 2, coefficient = "c", medium = ["w*t", "z"], smooth = "l"',
        ],
        SPACE: ['point = "lower.M", density = "k", area = 2, coefficient = "c", medium = [1, "sin(t)", "l*a"]'],
    },
    "plate": {
        PLANE: [
            'point = "lower.P", density = "k", area = 2, lift = "w*sin(alpha)"',
            'point = "lower.P", density = "k", area = 2, lift = "w*alpha", drag = "c + alpha^2", chord = [3, 4]',
            'point = "upper.R", density = "k", area = 2, lift = "w*alpha + b", drag = "c", medium = ["w*t", 1]',
        ],
        SPACE: [
            'point = "lower.P", density = "k", area = 2, lift = "w*sin(2*alpha)", drag = "c", medium = [1, "t", 0]',
            'point = "upper.R", density = "k", area = 2, lift = 1, drag = "c", chord = [3, 4, 0], normal = [-4, 3, 0]',
        ],
    },
    "buoyancy": {
        PLANE: [
            'point = "lower.P", density = "k", volume = "c", acceleration = [0, "-g"]',
            'point = "lower.M", density = "k", volume = "c", acceleration = [0, "-g"], medium = ["l*sin(w*t)", "t^2"]',
        ],
        SPACE: ['point = "lower.P", density = "k", volume = "c", acceleration = [0, 1, "-g"], medium = [0, "t^3", 1]'],
    },
    "added_mass": {
        PLANE: [
            'point = "lower.P", diagonal = ["m", "3*m", "l"]',
            'point = "lower.M", matrix = [["m", "l", 0], ["l", "5*m", 1], [0, 1, "k"]], medium = ["l*sin(w*t)", "t^2"]',
        ],
        SPACE: [
            'point = "lower.P", diagonal = ["m", "3*m", 2, 1, "l", "k"], medium = [0, "t^3", 1]',
            f'point = "lower.M", matrix = {SQUARE}',
        ],
    },
    "tyre": {
        PLANE: [
            'point = "lower.P", lateral = { stiffness = "k*z" }',
            f'point = "lower.P", lateral = {{ {MAGIC}, E = "z" }}, heading = [3, 1], smooth = "l"',
            f'point = "upper.R", lateral = {{ {MAGIC}, relaxation = "l" }}, {ROLLS}, rolling = "w*t"',
            'point = "lower.M", radius = "l", longitudinal = { stiffness = "k" }',
            'point = "lower.P", lateral = { stiffness = "k", grip = "w*k/9" }',
            f'point = "lower.M", lateral = {{ {MAGIC} }}, {ROLLS}, combined = 0.1, rolling = "w*t"',
            f'point = "lower.P", radius = "l", longitudinal = {{ {MAGIC}, relaxation = "c" }}, up = [1, 2], smooth = 1',
        ],
        SPACE: [
            f'point = "lower.P", lateral = {{ {MAGIC}, relaxation = "l" }}, {ROLLS}, rolling = 2, heading = [1, 1, 0]',
            f'point = "lower.P", radius = "l", lateral = {{ {MAGIC} }}, {ROLLS}, axle = [1, 2, 2], up = [0, 3, 4]',
            'point = "lower.P", radius = "l", lateral = { stiffness = "k", relaxation = 1 }, combined = "c"',
        ],
    },
    "potential": {
        PLANE: ['energy = "k*a^2*cos(b)"', 'energy = "k*l*a*sin(w*t)"'],
        SPACE: ['energy = "k*l*(a - b)^4"'],
    },
    "kinetic": {
        PLANE: ["energy = \"k*l^2*(a'^2 + cos(b)*a'*b')\"", "energy = \"k*l*t*b'^2 + k*l*a'*sin(a - b)\""],
        SPACE: ['energy = "k*(l + a)^2*b\'^2"'],
    },
    "generalized": {
        PLANE: ['coordinate = "b", value = "tau - c*b\'^3"'],
        SPACE: ['coordinate = "a", value = "k*b"'],
    },
}
CASES = [(k, space, f) for k, spaces in EXAMPLES.items() for space, fields in spaces.items() for f in fields]
BUILT = {force.kind for force in ALL if force.works}
built = each("kind, space, fields", [c for c in CASES if c[0] in BUILT], by="kind")

HEAD = """
[parameters]
m = 1.2
l = 0.7
g = 9.81
k = 5.0
c = 0.4
w = 1.3
[coordinates]
a = 0.3
b = 0.5
[inputs]
tau = "sin(2*t)"
[states]
z = { start = 0.2, rate = "a' - z*w" }
"""
BODIES = {
    PLANE: """
[points]
G = [2, 1]
[bodies.upper]
mass = "m"
center = ["l/2", "l/9"]
inertia = "m*l^2"
points = { P = ["l", "l/3"], R = ["-l/2", "l"] }
joint = { kind = "revolute", angle = "a" }
[bodies.lower]
mass = "2*m"
center = ["l/3", 0]
inertia = "m*l^2"
points = { P = ["l", "-l/5"], R = [0, "l"], M = ["l + a", "l*b"], W = ["a", "l*sin(w*t)"] }
joint = { kind = "revolute", on = "upper.P", angle = "b" }
[bodies.clock]
mass = "m"
inertia = 1
joint = { kind = "placed", at = ["l*sin(w*t)", "g*t + k + c"] }
[bodies.leaking]
mass = "m*exp(-w*t)*(1 + z)"
inertia = 0
joint = { kind = "fixed", on = "upper.P" }
""",
    SPACE: """
[points]
G = [2, 1, 0.5]
[bodies.upper]
mass = "m"
center = ["l/2", "l/9", 0]
inertia = ["m*l^2", "m*l^2", "m*l^2"]
points = { P = ["l", "l/3", "l/4"], R = ["-l/2", "l", "l/5"] }
joint = { kind = "revolute", axis = [1, 2, 2], angle = "a" }
[bodies.lower]
mass = "2*m"
center = ["l/3", 0, "l/7"]
inertia = ["m*l^2", "m*l^2", "m*l^2"]
points = { P = ["l", "-l/5", 0], M = ["l + a", "l*b", "l"] }
joint = { kind = "revolute", on = "upper.P", axis = [0, 3, 4], angle = "b" }
[bodies.clock]
mass = "m"
inertia = [1, 1, 1]
joint = { kind = "placed", at = ["l*sin(w*t)", "g*t + k + c", 0] }
[bodies.leaking]
mass = "m*exp(-w*t)*(1 + z)"
inertia = [0, 0, 0]
joint = { kind = "fixed", on = "upper.P" }
""",
}
NO_FORCE = '[forces]\nnone = { kind = "generalized", coordinate = "a", value = "0*(tau + k + c)" }\n'  # names are used


def system_with(kind: str, space: str, fields: str) -> System:
    """Two bodies that hang on one another, and the force."""
    return written(HEAD + BODIES[space] + f'{NO_FORCE}F = {{ kind = "{kind}", {fields} }}\n', space)


def applied(system: System):
    """The force."""
    (force,) = (f for f in system.loads.applied if f.name == "F")
    return force


def work_row(loads: Loads, force) -> tuple[Scalar, ...]:
    """Q by virtual work of the loads, whether or not there is a potential."""
    rows = [loads.load_row(load) for load in force.loads]
    return (
        tuple(sum(column, start=0) for column in zip(*rows, strict=True))
        if rows
        else (0,) * len(loads.motion.scope.symbols.u)
    )


def test_every_kind_of_force_has_examples_here():
    """A force that is added to ALL is held to the contract."""
    kinds = {force.kind for force in ALL}
    lacking, left = sorted(kinds - EXAMPLES.keys()), sorted(EXAMPLES.keys() - kinds)
    assert not lacking, "write their fields into EXAMPLES of this file"
    assert not left


@pytest.mark.parametrize("kind", [force.kind for force in ALL if not force.works])
def test_a_force_that_is_not_built_ends_in_an_honest_message(kind):
    """Exit 3 with the kind and the place, never a wrong answer."""
    space, fields = next(iter(EXAMPLES[kind].items()))
    with pytest.raises(NotYet, match=f"'{kind}' are not derived yet") as caught:
        system_with(kind, space, fields[0])
    assert caught.value.exit_code == 3 and caught.value.where == "forces.F"


@built
def test_the_potential_and_the_work_of_the_loads_agree(kind, space, fields):
    """-N^T dV/dq = sum F . dp/dq + sum M . dw/du, where a force has a potential and a place."""
    system = system_with(kind, space, fields)
    force = applied(system)
    if force.potential is None or force.placeless:
        assert force.placeless or kind not in ("gravity", "spring", "torsion_spring")
        return
    assert equal(system.motion.scope.from_potential(force.potential), work_row(system.loads, force))


@built
def test_every_force_says_what_it_does_to_the_proof_too(kind, space, fields):
    """`acts` are not empty, and do the work of its loads: Q . d of the whole system."""
    system = system_with(kind, space, fields)
    equations = recursive.assembled_by_recursion(system)
    state = state_of(system)
    assert [*Declared(system, state).acts_of("F")]
    assert not acting_otherwise(system, state) and not working_otherwise(equations, state)
    rates, due = at(system.scope.state_rates, state), declared_state_rates(system, state)
    assert rates == pytest.approx([float(x) for x in due.values()], rel=1e-13)
    if kind not in INERTIAL:
        others = replace(system.loads, applied=tuple(f for f in system.loads.applied if f.name != "F"))
        less = recursive.assembled_by_recursion(replace(system, loads=others))
        assert working_otherwise(less, state)


@built
def test_virtual_work_and_wrenches_on_twists_agree(kind, space, fields):
    """Q_k = sum F . dp/dq_k = sum over bodies of B^T W"""
    system = system_with(kind, space, fields)
    assert equal(system.loads.generalized_forces, projection.force_side(system.loads))


@built
def test_a_force_acts(kind, space, fields):
    """Q is not 0 at a random state; of a kinetic energy M has entries of its own."""
    system = system_with(kind, space, fields)
    acts = system.loads.force_row(applied(system))
    if kind in INERTIAL:
        acts = tuple(value for _, _, value in SystemInertia(system.motion).added_mass)
    assert np.abs(at(acts, state_of(system))).max() > 1e-6


def test_a_system_of_energies_alone_is_proven():
    """M, c and Q of T(q, q', speeds, t), V and a force, with declared speeds, a knife edge and what is driven: by the
    energies, by the wrenches' way and body by body, with the energy theorem."""
    model = eomgen.loads("""
        eomgen = 1
        space = "plane"
        parameters = { m = 1.5, J = 0.3, l = 0.7, g = 9.81 }
        inputs = { F = "sin(t)" }
        constraints.blade = { kind = "equation", rate = "-x'*sin(th) + y'*cos(th) - l*th'" }
        forces.V = { kind = "potential", energy = "-2*m*g*l*cos(th + s) - m*g*l*cos(ph)" }
        forces.f = { kind = "generalized", coordinate = "th", value = "F - 0.1*w1" }
        [coordinates]
        x = 0
        y = { dependent = true }
        th = 0.4
        ph = 0.1
        s = { motion = "0.1*sin(t)" }
        [speeds]
        w1 = { rate = "th' + x'*cos(ph)", start = 1 }
        w2 = { rate = "ph' - 2*x'", start = 2 }
        w3 = { rate = "x' + th'*sin(s)", start = 0.5 }
        [forces.T]
        kind = "kinetic"
        energy = "m*(x'^2 + y'^2)/2 + J*w1^2/2 + J*(w2 + s'*sin(ph))^2/4 + J*cos(x)*w1*th'/10 + 0.1*ph'^2*(2 + sin(t))"
    """)
    equations = eomgen.derive(model)
    found = equations.certify()
    assert found.ok and all(check.status == "holds" for check in found.checks)


Resultant = tuple[Vector, Vector]


def resultant(system: System, loads, about: Vector) -> Resultant:
    """(force, moment about a point of the ground) of forces and couples, ground axes."""
    F, M = Vector.ZERO, Vector.ZERO
    for load in loads:
        if isinstance(load, Couple):
            M = M + system.motion.in_ground_axes(load.couple, load.axes)
        else:
            f = system.motion.in_ground_axes(load.force, load.axes)
            F = F + f
            M = M + (system.motion.position(load.place) - about).cross(f)
    return F, M


ABOUT = ("0.3*l", "-1.7", "g")


def ground_point(system: System) -> Vector:
    """Some point of the ground."""
    x, y, z = (parse(text).evaluate(system.scope.names) for text in ABOUT)
    return (x, y, z)


BETWEEN_POINTS = ("spring", "damper", "between", "bumper", "hydraulic_cylinder", "pneumatic_cylinder")
BETWEEN_BODIES = ("torsion_spring", "torsion_damper")
INNER = [case for case in CASES if case[0] in BETWEEN_POINTS or (case[0] in BETWEEN_BODIES and "bodies" in case[2])]


@each("kind, space, fields", INNER)
def test_inner_forces_sum_to_zero(kind, space, fields):
    """sum F = 0, and about any ground point sum (M + r x F) = 0: what acts between two acts on both."""
    system = system_with(kind, space, fields)
    loads = applied(system).loads
    F, M = resultant(system, loads, ground_point(system))
    assert equal(F, Vector.ZERO)
    if "along" in fields:  # the stretch is measured, and the pull acts, along a fixed direction: a couple stays
        first, second = (system.motion.position(load.place) for load in loads)
        M = M - (first - second).cross(loads[0].force)
    assert equal(M, Vector.ZERO)


EFFORTS = 'torque = "tau", stiffness = "k", rest = 0.2, damping = "c"'
TURNED = 'turned = { axis = [0, 1, 0], angle = "pi/4" }'
PUSHED = EFFORTS.replace("torque", "force")
JOINTS = [
    (PLANE, f'kind = "revolute", on = "base", at = [1, 2], angle = "b", {EFFORTS}'),
    (PLANE, f'kind = "prismatic", on = "base", axis = [3, 4], angle = 0.4, displacement = "b", {PUSHED}'),
    (SPACE, f'kind = "revolute", on = "base.P", axis = [1, 2, 2], angle = "b - a", point = "P", {TURNED}, {EFFORTS}'),
    (SPACE, f'kind = "prismatic", on = "base", axis = [0, 3, 4], angle = 0.3, displacement = "b", {TURNED}, {PUSHED}'),
]


def system_with_joint(space: str, joint: str) -> System:
    inertia, P, axis = ("1", "[1, 2]", "") if space == PLANE else ("[1, 1, 1]", "[1, 2, 3]", "axis = [2, 1, 2], ")
    return written(
        HEAD
        + f"""
[bodies.base]
mass = "m"
inertia = {inertia}
points = {{ P = {P} }}
joint = {{ kind = "revolute", {axis}angle = "a" }}
[bodies.child]
mass = "m*l*w*g"
inertia = {inertia}
points = {{ P = {P} }}
joint = {{ {joint} }}
{NO_FORCE}""",
        space,
    )


@each("space, joint", JOINTS)
def test_the_effort_of_a_joint_is_an_inner_force(space, joint):
    """Its wrenches on child and parent have no resultant and no moment about any ground point."""
    system = system_with_joint(space, joint)
    F, M = Vector.ZERO, Vector.ZERO
    for body, wrench in system.loads.efforts[0].wrenches(system.motion):
        pose = system.motion.link(body).pose
        f, tau = pose.R @ wrench.f, pose.R @ wrench.tau
        F, M = F + f, M + (tau + (pose.p - ground_point(system)).cross(f))
    assert equal((*F, *M), (*Vector.ZERO, *Vector.ZERO))


@each("space, joint", JOINTS)
def test_the_wrenches_of_a_joint_do_the_work_of_its_effort(space, joint):
    """sum of W . xi over child and parent = effort * s'; and Q = effort ds/dq."""
    system = system_with_joint(space, joint)
    (effort,) = system.loads.efforts
    link = system.motion.link("child")
    power = sum((system.motion.link(b).twist.power(W) for b, W in effort.wrenches(system.motion)), start=0)
    assert equal((power,), (effort.effort * link.s_rate[0],))
    u = system.symbols.u
    work = sum((Q * x for Q, x in zip(system.loads.effort_row(effort), u, strict=True)), start=0)
    assert equal((work,), (power,))


DAMPERS = [case for case in CASES if "damper" in case[0]]


@each("kind, space, fields", DAMPERS)
def test_dampers_take_power(kind, space, fields):
    """sum F . v + M . w <= 0 at every state, and < 0 where the damper moves."""
    system = system_with(kind, space, fields)
    row = system.loads.force_row(applied(system))
    power = sum((Q * u for Q, u in zip(row, system.symbols.u, strict=True)), start=0)
    taken = [at((power,), state_of(system, seed))[0] for seed in range(20)]
    assert max(taken) <= 0 and min(taken) < -1e-6


def test_a_straight_damper_takes_c_times_the_rate_squared():
    """P = -c l'^2, l the distance of its points, whatever moves its ends."""
    system = system_with("damper", PLANE, f'{TWO}, damping = "c"')
    scene = SystemScene(system.motion)
    ends = [load.place for load in applied(system).loads]
    gap = scene.position(ends[1]) - scene.position(ends[0])
    velocity = scene.velocity(ends[1]) - scene.velocity(ends[0])
    power = sum((load.force @ scene.velocity(load.place) for load in applied(system).loads), start=0)
    c = system.symbols.parameters["c"]
    assert equal((power * (gap @ gap),), (-c * (gap @ velocity) * (gap @ velocity),))


DISTRIBUTED = [(space, fields) for kind, space, fields in CASES if kind == "distributed"]


@pytest.mark.parametrize(("space", "fields"), DISTRIBUTED)
def test_a_distributed_load_has_the_resultant_of_its_integral(space, fields):
    """F = int q ds, M = int r x q ds from A to B, by quadrature that is exact for linear intensities."""
    system = system_with("distributed", space, fields)
    force = system.scope.model.forces["F"]
    scene, state = SystemScene(system.motion), state_of(system, 3)
    about = ground_point(system)
    A, B = (at(system.motion.position(scene.place(f"{force.body}.{name}")), state) for name in force.between)
    q = [at(scene.vector(x), state) for x in force.intensities or (force.intensity, force.intensity)]
    length, origin = np.linalg.norm(B - A), at(about, state)
    F, M = np.zeros(3), np.zeros(3)
    for node, weight in zip(*np.polynomial.legendre.leggauss(4), strict=True):
        x = (node + 1) / 2
        intensity = (1 - x) * q[0] + x * q[1]
        F += weight / 2 * length * intensity
        M += weight / 2 * length * np.cross((1 - x) * A + x * B - origin, intensity)
    found = resultant(system, applied(system).loads, about)
    assert at(found[0], state) == pytest.approx(F, rel=1e-12, abs=1e-12)
    assert at(found[1], state) == pytest.approx(M, rel=1e-12, abs=1e-12)


def test_the_weights_of_the_bodies_add_up_to_the_weight_of_all():
    """Gravity on upper, on lower and on the rest is gravity on all: V and Q alike."""
    whole = system_with("gravity", PLANE, 'acceleration = [0, "-g"]')
    names = ("upper", "lower", "clock", "leaking")
    some = [system_with("gravity", PLANE, f'acceleration = [0, "-g"], bodies = ["{name}"]') for name in names]

    def numbers(system: System) -> np.ndarray:
        force = applied(system)
        return at((*system.loads.force_row(force), force.potential), state_of(system))

    assert sum(numbers(system) for system in some) == pytest.approx(numbers(whole), rel=1e-13)


def test_gravity_is_a_force_m_g_at_the_centre_of_the_named_bodies():
    """F = m g, and no moment about the mass centre."""
    system = system_with("gravity", PLANE, 'acceleration = [0, "-g"], bodies = ["lower"]')
    (load,) = applied(system).loads
    p = system.symbols.parameters
    assert load.place[0] == "lower" and equal(load.place[1], (p["l"] / 3, 0, 0))
    assert equal(load.force, (0, -2 * p["m"] * p["g"], 0))


def test_gravity_on_all_is_a_field():
    """A uniform field, which formulations may put into the acceleration of the ground."""
    (load,) = applied(system_with("gravity", PLANE, 'acceleration = [0, "-g"]')).loads
    assert isinstance(load, UniformField)


@pytest.mark.parametrize("axes", ["upper", "lower"])
def test_a_force_in_the_axes_of_a_body_turns_with_it(axes):
    """f_ground = R f_body; at rest in the ground's axes otherwise."""
    system = system_with("force", PLANE, f'point = "lower.P", force = [3, "k"], axes = "{axes}"')
    (load,) = applied(system).loads
    k = system.symbols.parameters["k"]
    turned = system.motion.link(axes).pose.R @ Vector((3, k, 0))
    assert equal(system.motion.in_ground_axes(load.force, load.axes), turned)
    body, wrench = system.motion.body_wrench(load)
    assert body == "lower" and equal(system.motion.link(body).pose.R @ wrench.f, turned)


@pytest.mark.parametrize("axes", ["upper", "lower"])
@pytest.mark.parametrize("space", [PLANE, SPACE])
def test_a_couple_in_the_axes_of_a_body_turns_with_it(space, axes):
    """Q_k = (R c) . dw/du_k, R of the body in whose axes the couple is written."""
    plain = "[1, 2, 3]" if space == SPACE else '"k"'
    system = system_with("couple", space, f'body = "lower", couple = {plain}, axes = "{axes}"')
    (load,) = applied(system).loads
    lower = system.motion.link("lower")
    power = system.motion.link(axes).pose.R @ load.couple @ (lower.pose.R @ lower.twist.w)
    assert equal(system.loads.force_row(applied(system)), gradient(power, system.symbols.u))


@pytest.mark.parametrize("space", [PLANE, SPACE])
def test_a_linear_pull_between_two_points_is_a_spring(space):
    """between with f(r) = k (r - l) has the Q and the power of a spring of length l."""
    spring = system_with("spring", space, f'{TWO}, stiffness = "k", length = "l"')
    between = system_with("between", space, f'{TWO}, pull = "k*(r - l)"')
    rows = [at(work_row(s.loads, applied(s)), state_of(s)) for s in (spring, between)]
    assert rows[1] == pytest.approx(rows[0], rel=1e-13)


def test_a_pull_draws_its_points_together():
    """Attraction is positive: the force on the first point is along the line to the second."""
    system = system_with("between", PLANE, f'{TWO}, pull = "k"')
    first, second = applied(system).loads
    line = system.motion.position(second.place) - system.motion.position(first.place)
    state = state_of(system)
    assert at((first.force @ line,), state)[0] > 0 > at((second.force @ line,), state)[0]


@pytest.mark.parametrize("law", ["k*(r - l)", "k*l^2/r^2", "k*l/r"])
def test_a_pull_of_the_distance_alone_is_the_slope_of_its_potential(law):
    """V = int f dr, so that dV/dr = f: energy is conserved and is reported."""
    system = system_with("between", PLANE, f'{TWO}, pull = "{law}"')
    force = applied(system)
    assert force.potential is not None
    assert equal(system.motion.scope.from_potential(force.potential), work_row(system.loads, force))


@pytest.mark.parametrize("law", ["c*r'", "k*r*sin(w*t)", "k*a", "tau*r"])
def test_a_pull_of_anything_else_has_no_potential(law):
    """Rates, time, coordinates and inputs in the law: it may do work on a closed path."""
    assert applied(system_with("between", PLANE, f'{TWO}, pull = "{law}"')).potential is None


def test_a_spring_is_slack_at_its_start_when_its_length_says_so():
    """length = "start": no force at the start values."""
    system = system_with("spring", PLANE, f'{GROUND}, stiffness = "k", length = "start"')
    state = state_of(system)
    for q, start in zip(system.symbols.q, (Fraction(3, 10), Fraction(1, 2)), strict=True):
        state[q] = fifty_digits().number(start)
    (force, _) = (load.force for load in applied(system).loads)
    assert at(force, state) == pytest.approx([0, 0, 0], abs=1e-15)


@pytest.mark.parametrize("fields", ["along = [3, 4]", "along = [30, 40]", 'along = ["3*l", "4*l"]'])
def test_only_the_direction_of_along_counts(fields):
    """n = along / |along|; the stretch is n . (p2 - p1) - l, so V is the same for any length of `along`."""
    system = system_with("spring", PLANE, f'{TWO}, stiffness = "k", length = "l", {fields}')
    first, second = (system.motion.position(load.place) for load in applied(system).loads)
    p = system.symbols.parameters
    stretch = at(((second - first) @ Vector((3, 4, 0)), p["l"], p["k"]), state_of(system))
    expected = stretch[2] * (stretch[0] / 5 - stretch[1]) ** 2 / 2
    assert at((applied(system).potential,), state_of(system)) == pytest.approx([expected], rel=1e-13)


def test_torsion_acts_on_the_second_body_against_the_first():
    """Couple -k (theta2 - theta1 - rest) on the second, its opposite on the first, counter-clockwise positive."""
    system = system_with("torsion_spring", PLANE, 'bodies = ["upper", "lower"], stiffness = "k", rest = "1/7"')
    b, k = system.symbols.q[1], system.symbols.parameters["k"]
    couples = {load.body: load.couple[2] for load in applied(system).loads}
    stretch = b - Fraction(1, 7)
    assert equal((couples["lower"], couples["upper"]), (-k * stretch, k * stretch))


def test_a_force_in_a_fixed_direction_does_the_work_of_a_potential():
    """F . p: Q of a constant force at a point is the slope of F . p."""
    system = system_with("force", PLANE, 'point = "lower.P", force = [3, "-k"]')
    force = applied(system)
    (load,) = force.loads
    assert isinstance(load, PointForce)
    V = -(load.force @ system.motion.position(load.place))
    assert equal(system.motion.scope.from_potential(V), system.loads.force_row(force))


def test_a_force_that_needs_accelerations_is_refused_by_name():
    """A force may hold rates and time, not accelerations."""
    with pytest.raises(eomgen.EomgenError, match="an acceleration"):
        system_with("couple", PLANE, 'body = "lower", couple = "a\'\'"')


FLOOR = """
eomgen = 1
space = "plane"
parameters = { m = 2, g = 9.81, k = 1e4 }
coordinates = { y = { start = -0.001 } }
points = { G = [3, 0] }
bodies.ball.shape = { kind = "particle", mass = "m" }
bodies.ball.joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
forces.floor = { kind = "bumper", points = ["G", "ball.center"], along = [0, 1], stiffness = "k", length = 0 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
outputs = { P = "-pull(floor)", a = "y''" }
"""


def test_a_bumper_along_a_direction_may_be_a_floor_of_length_0():
    """m y'' = k max(0, -y) - m g; between points, whose distance is never below 0, it would not touch."""
    found = eomgen.solve(eomgen.loads(FLOOR))
    assert found["P"].value == pytest.approx(10) and found["a"].value == pytest.approx(10 / 2 - 9.81)
    with pytest.raises(ModelError, match="the bumper 'floor' of length 0 never touches"):
        eomgen.loads(FLOOR.replace("along = [0, 1], ", ""))
