"""What every formulation promises: the same equations of motion, whichever way they are derived."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from each import each
from maximal import free_body_accelerations
from moving import at, equal, state_of, written
from random_systems import random_model
from slow_run import sampled, usual_models

import eomgen
from eomgen.mechanics.dynamics import accelerations as articulated
from eomgen.mechanics.dynamics import formulations as recursive
from eomgen.mechanics.dynamics.accelerations import exact_accelerations
from eomgen.mechanics.dynamics.formulations import ALL, Formulation
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System
from eomgen.mechanics.dynamics.tree import branches_of
from eomgen.mechanics.kinematics.inertia import SystemInertia
from eomgen.symbolic.expression.derivatives import depends_on
from eomgen.symbolic.expression.graph import same_number
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.numeric.evaluation import NoValue

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

MODELS = {path.stem: path for path in sorted((Path(__file__).parents[2] / "models").rglob("*.toml"))}
RANDOM = [(space, seed) for space in ("plane", "space") for seed in range(100, 110)]

formulations = each("formulation", ALL)
others = each("formulation", ALL[1:])


@cache
def system_named(name: str) -> System | None:
    """A model of models/ (None: a part of it is not built yet)."""
    model = eomgen.load(MODELS[name])
    return None if model.unbuilt else System.of(model)


@cache
def assembled(formulation: Formulation, name: str) -> EquationsOfMotion:
    """The equations of a model of models/, derived once for all that is asked of them."""
    return formulation.assemble(system_named(name))


@pytest.fixture(params=[path.stem for path in usual_models(MODELS.values())])
def name(request) -> str:
    if system_named(request.param) is None:
        pytest.skip("a part of the model is not built in this version")
    return request.param


def accelerations(equations: EquationsOfMotion, system: System) -> np.ndarray:
    """a at the first random state with values."""
    for seed in range(1, 20):
        try:
            return np.array(exact_accelerations(equations, state_of(system, seed)), dtype=float)
        except NoValue:
            continue
    raise AssertionError("no state with values was found")


def close(a: np.ndarray, b: np.ndarray) -> bool:
    return a == pytest.approx(b, rel=1e-8, abs=1e-8 * (1 + np.abs(b).max(initial=0)))


def test_formulations_have_names_of_their_own():
    """name is what a user types, title what a certificate says."""
    assert len({formulation.name for formulation in ALL}) == len({formulation.title for formulation in ALL}) == len(ALL)


def test_most_models_are_derived():
    """A model that waits for a later version is the exception: what is skipped here is counted."""
    waiting = [name for name in MODELS if system_named(name) is None]
    assert len(waiting) <= 2, waiting


@sampled(2)
@others
def test_every_formulation_gives_the_same_accelerations(formulation, name):
    """a of M a = forcing + J^T lam, J a + gamma = 0, against those of the first formulation, at a random state."""
    system = system_named(name)
    reference = accelerations(assembled(ALL[0], name), system)
    assert close(accelerations(assembled(formulation, name), system), reference)


@sampled(2)
@pytest.mark.parametrize(("space", "seed"), RANDOM)
@others
def test_every_formulation_gives_the_same_accelerations_of_random_trees(formulation, space, seed):
    """As above, for systems that nobody has thought of."""
    system = System.of(eomgen.loads(random_model(space, seed)))
    reference = accelerations(ALL[0].assemble(system), system)
    assert close(accelerations(formulation.assemble(system), system), reference)


ROTORS = """
[parameters]
m = 1.2
l = 0.7
I = 0.3
[coordinates]
a = 0.3
b = 0.5
r = { motion = "l*t^3" }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "3*a", armature = "I" }
[bodies.hand]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "arm.end", angle = "b*a - 2*r", armature = "2*I", damping = 0.1 }
[bodies.slide]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "prismatic", on = "hand", axis = [3, 4], displacement = "b^2", armature = "m", stiffness = 2 }
"""


@others
def test_rotors_behind_gears_move_with_the_rate_of_their_joint(formulation):
    """T = armature s'^2 / 2 with s = s(q, t): M gets armature D^T D, c gets armature D^T (d/dt s' at a = 0)."""
    system = written(ROTORS)
    first, other = ALL[0].assemble(system), formulation.assemble(system)
    assert equal([*(x for row in other.M for x in row), *other.c], [*(x for row in first.M for x in row), *first.c])
    rotors = SystemInertia(system.motion).rotor_energy(system.motion.link("arm"))
    a_rate = system.symbols.u[0]
    assert equal((rotors,), (system.symbols.parameters["I"] * 9 * a_rate * a_rate / 2,))


@formulations
def test_an_assembly_has_the_shapes_that_it_promises(formulation, name):
    """N nq x nu; M nu x nu; c, Q, forcing nu; J k x nu; sigma, gamma, phi k."""
    system, equations = system_named(name), assembled(formulation, name)
    nq, nu, k = len(system.symbols.q), len(system.symbols.u), len(system.constraints.closing)
    assert [len(row) for row in equations.N] == [nu] * nq and len(equations.nu) == nq
    assert [len(row) for row in equations.M] == [nu] * nu
    assert [len(row) for row in (equations.c, equations.Q, equations.forcing)] == [nu] * 3
    assert [len(row) for row in equations.J] == [nu] * k
    assert [len(row) for row in (equations.sigma, equations.gamma, equations.phi, equations.symbols.lam)] == [k] * 4


@others
def test_every_formulation_gives_the_same_energies(formulation, name):
    """T and V are of the system, not of the way to its equations."""
    first, other = assembled(ALL[0], name), assembled(formulation, name)
    assert equal((first.T, first.V), (other.T, other.V))


def test_articulated_bodies_give_the_accelerations_of_the_mass_matrix(name):
    """a by O(n) elimination = M^-1 (Q - c), where no row closes and every speed belongs to one joint."""
    system = system_named(name)
    branches = branches_of(system.motion)
    if system.constraints.closing or not articulated.is_articulated(system.motion, branches):
        return
    a = articulated.accelerations(system.loads, branches)
    state = state_of(system)
    assert close(at(a, state), np.array(exact_accelerations(assembled(ALL[0], name), state), dtype=float))


@pytest.mark.parametrize("name", ["arm7", "puma560", "space_manipulator", "heavy_top"])
def test_second_moments_of_mass_are_symmetric_scalar_by_scalar(name):
    """J_ij is J_ji, moved and turned too: not two ways to write one number, which would be carried twice."""
    system = system_named(name)
    assert system is not None
    h = [system.scope.symbols.graph.symbol(x) for x in ("h_x", "h_y", "h_z")]
    for branch in branches_of(system.motion):
        own = branch.moments
        moved = replace(own, h=Vector(h)).moved(branch.p).turned(branch.E).J
        for J in (own.J, moved):
            assert all(same_number(J[i][j], J[j][i]) or J[i][j] is J[j][i] for i in range(3) for j in range(i))


def test_articulated_bodies_apply_to_chains_with_a_speed_for_each_joint():
    """The O(n) way is taken where it can be."""
    systems = [system_named(name) for name in ("chain20", "arm7", "arm3")]
    assert all(articulated.is_articulated(s.motion, branches_of(s.motion)) for s in systems if s is not None)


@pytest.mark.parametrize("name", ["double_pendulum", "arm3", "parallelogram_reactions", "cart_pole"])
def test_free_bodies_give_the_same_accelerations(name):
    """One dense system in the accelerations of all bodies, their joint wrenches, a and lam."""
    system = system_named(name)
    assert system is not None
    state = state_of(system)
    assert close(
        free_body_accelerations(system, state),
        np.array(exact_accelerations(ALL[0].assemble(system), state), dtype=float),
    )


SLOTTED = """
[parameters]
m = 1.2
l = 0.7
[coordinates]
a = 0.3
b = 0.5
s = 0.2
[bodies.bar]
mass = "m"
inertia = "m*l^2"
points = { M = ["l + s", "l*sin(t)"] }
joint = { kind = "revolute", angle = "a" }
[bodies.cart]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 2], displacement = "b" }
[bodies.slider]
shape = { kind = "particle", mass = "2*m" }
joint = { kind = "prismatic", on = "bar", axis = [1, 0], displacement = "s" }
[constraints]
constraint = { KIND }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""
CONSTRAINTS = [
    'kind = "pin", points = ["bar.M", "cart.center"]',
    'kind = "support", point = "bar.M", normal = [1, 2]',
    'kind = "equation", gap = "a*b - s"',
]


@pytest.mark.parametrize("constraint", CONSTRAINTS)
def test_free_bodies_move_alike_under_ties_at_points_that_slide_and_ties_without_bodies(constraint):
    """lam also does work on what no twist sees: the slide of a point in its body, a constraint of coordinates."""
    system = written(SLOTTED.replace("KIND", constraint))
    state = state_of(system)
    assert close(
        free_body_accelerations(system, state),
        np.array(exact_accelerations(ALL[0].assemble(system), state), dtype=float),
    )


def test_the_angle_of_a_body_of_revolution_about_its_axis_stands_nowhere():
    """A rotor's moments across its axis are one: R J R^T = R (J - A 1) R^T + A 1 holds no angle of it."""
    motion = system_named("dual_spin_satellite").motion
    sigma = next(q for q in motion.scope.symbols.q if q.name == "sigma")
    assert not depends_on([x for row in recursive.mass(motion) for x in row], (sigma,))
