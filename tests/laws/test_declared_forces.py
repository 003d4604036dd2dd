"""What is applied does the work that its fields declare: a load of any kind that is made otherwise is contradicted."""

from __future__ import annotations

from dataclasses import replace
from random import Random

import pytest

import eomgen
from eomgen.mechanics.free_bodies import names_of_reactions as named_reactions
from eomgen.mechanics.kinematics import scene as contact_modes
from eomgen.mechanics.statics import contacts as contacts_at_start
from eomgen.model import joints
from eomgen.model.forces import applied as couple
from eomgen.model.forces import applied as force
from eomgen.model.forces import applied as generalized
from eomgen.model.forces import energies as kinetic
from eomgen.model.forces import energies as potential
from eomgen.model.forces import weights as distributed
from eomgen.model.forces.load import Couple, GeneralizedForce, PointForce
from eomgen.model.joints.base import Effort
from eomgen.proof.check import Certificate
from eomgen.proof.declared_loads import acting_otherwise, working_otherwise
from eomgen.proof.states import real_state
from eomgen.symbolic.expression import splines

SPACE = """
eomgen = 1
space = "space"
parameters = { m = 2, g = 9.81, k = 40, c = 3, l = 0.6 }
inputs = { tau = "sin(2*t)" }
[coordinates]
a = { start = 0.4, speed = 0.6 }
d = { start = 0.2, speed = 0.5 }
b = { start = 0.7, speed = 1.5 }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", axis = [1, 2, 2], angle = "a", stiffness = "k/9", damping = "c", rest = 0.1 }
[bodies.sleeve]
mass = "m"
inertia = [0.1, 0.2, 0.3]
points = { P = ["l", "l/3", "l/4"] }
joint = { kind = "cylindrical", on = "arm.end", displacement = "d", angle = "b", force = "2 + tau", torque = "5*tau" }
[bodies.slide]
mass = "m"
inertia = [0.1, 0.2, 0.3]
joint = { kind = "prismatic", axis = [1, 0, 1], displacement = "d", stiffness = "k", damping = "c", force = "3*tau" }
[forces]
weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
push = { kind = "force", point = "sleeve.P", force = [1, "tau", "k*b"], axes = "sleeve" }
couple = { kind = "couple", body = "sleeve", couple = [1, 2, "tau"], axes = "arm" }
wind = { kind = "distributed", body = "arm", between = ["origin", "end"], intensities = [[1, 2, "k"], [0, 0, 1]] }
own = { kind = "generalized", coordinate = "a", value = "tau - c*a'^3" }
field = { kind = "potential", energy = "k*l^2*cos(a - b)/8" }
added = { kind = "kinetic", energy = "m*(l + d)^2*b'^2/9" }
"""
SAMPLES = """
eomgen = 1
space = "plane"
parameters = { m = 2, g = 9.81, l = 0.6 }
inputs = { F = { value = { samples = [[0, 0.1], [0.5, 0.2], [1.1, 0.7], [2, 0.3], [2.5, 0.2]]WAY } } }
coordinates = { phi = { start = 0.4, speed = 1.5 } }
[bodies.r]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "phi", torque = "F" }
"""
TILTED = """
eomgen = 1
space = "space"
parameters = { m = 2, g = 9.81, l = 0.6 }
coordinates = { a = { start = 0.4, speed = 0.6 } }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", axis = [1, 2, 2], angle = "a" }
[forces]
weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
"""
LIFTED = """
eomgen = 1
space = "plane"
parameters = { m = 2, g = 9.81, F = 50, mu = 0.3 }
coordinates = { x = { start = 0, speed = 1 } }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "path", at = [0, 0], pieces = [{ line = 10, friction = "mu" }], along = "x" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
up = { kind = "force", point = "block.origin", force = [0, "F"] }
"""


def proven(text: str) -> Certificate:
    return eomgen.derive(eomgen.loads(text)).certify("numpy")


def contradicted(text: str) -> str:
    """The names of the checks that fail."""
    return "; ".join(check.name for check in proven(text).checks if check.ok is False)


def test_the_declared_work_of_every_kind_of_force_is_that_of_the_equations():
    """sum F . dr + sum tau . w + sum Q_i dq_i + sum f ds - dV = Q . d"""
    found = proven(SPACE)
    assert found.ok and any("their fields declare" in c.name and c.ok for c in found.checks)


def turned(load):
    """The load with the other sign."""
    if isinstance(load, PointForce):
        return replace(load, force=-load.force)
    if isinstance(load, Couple):
        return replace(load, couple=-load.couple)
    return GeneralizedForce(load.coordinate, -load.value)


def in_ground_axes(load):
    return replace(load, axes=None)


KINDS = (
    (force.PointForce, turned),
    (force.PointForce, in_ground_axes),
    (couple.CoupleForce, turned),
    (couple.CoupleForce, in_ground_axes),
    (generalized.Generalized, turned),
    (distributed.Distributed, turned),
)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "wrong"), KINDS, ids=lambda x: x.__name__)
def test_a_load_that_is_made_otherwise_is_contradicted(kind, wrong, monkeypatch):
    """Sign, axes, place: both routes start from the load, its fields do not."""
    right = kind.loads
    monkeypatch.setattr(kind, "loads", lambda self, scene: tuple(map(wrong, right(self, scene))))
    assert "their fields declare" in contradicted(SPACE)


def test_the_ends_of_a_line_load_are_not_exchanged(monkeypatch):
    """(2 q_A + q_B) L / 6 at A, not at B."""
    right = distributed.Distributed.spread

    def wrong(self, scene):
        (line,) = right(self, scene)
        return (replace(line, at_start=line.at_end, at_end=line.at_start),)

    monkeypatch.setattr(distributed.Distributed, "spread", wrong)
    assert "their fields declare" in contradicted(SPACE)


def test_given_energies_are_those_of_the_file(monkeypatch):
    """V with the other sign moves Q, T counted twice moves T."""
    with monkeypatch.context() as patch:
        patch.setattr(potential.Potential, "potential", lambda self, scene: -scene.value(self.energy))
        assert "their fields declare" in contradicted(SPACE)
    monkeypatch.setattr(kinetic.Kinetic, "kinetic", property(lambda self: self.energy * 2))
    assert "energies of the bodies" in contradicted(SPACE)


@pytest.mark.parametrize("kind", [joints.Prismatic, joints.Revolute, joints.Cylindrical], ids=lambda x: x.__name__)
def test_what_acts_in_a_joint_is_that_of_its_fields(kind, monkeypatch):
    """Stiffness for damping, force for torque."""
    right = kind.efforts

    def wrong(self):
        first, *more = right(self)
        if more:
            return (*more, first)
        return (Effort(first.drive, first.damping, first.stiffness, first.rest, first.armature),)

    monkeypatch.setattr(kind, "efforts", wrong)
    assert "as they are declared" in contradicted(SPACE)


@pytest.mark.slow
@pytest.mark.parametrize("way", ["", ', ends = "natural"', ', ends = "rest"', ', between = "linear"'])
def test_functions_through_samples_are_those_of_the_samples(way, monkeypatch):
    """Another program's interpolation of the same samples."""
    text = SAMPLES.replace("WAY", way)
    assert proven(text).ok
    right = splines._piece

    def wrong(times, values, slopes):
        first, *others = right(times, values, slopes)
        return (first + splines.Fraction(1, 9), *others)

    monkeypatch.setattr(splines, "_piece", wrong)
    assert "through samples" in contradicted(text)


def test_friction_is_that_of_its_coefficient_and_of_the_push_at_the_start(monkeypatch):
    """F = mu |N| against v, N < 0 where a block is lifted in its guide."""
    assert proven(LIFTED).ok
    right = contact_modes.ContactMode.friction_factor
    with monkeypatch.context() as patch:
        patch.setattr(contact_modes.ContactMode, "friction_factor", lambda *args: 2 * right(*args))
        assert "friction takes power" in contradicted(LIFTED)
    monkeypatch.setattr(contacts_at_start._StartNumbers, "pushing", lambda *_: contacts_at_start.ContactsAtStart())
    assert "own pushes" in contradicted(LIFTED)


def test_reactions_in_space_are_named_along_the_axes_of_the_ground(monkeypatch):
    """reaction_x = (R f)_x"""
    assert proven(TILTED).ok
    monkeypatch.setattr(named_reactions, "_turned", lambda balance, on, vector: vector)
    assert "along the ground's axes" in contradicted(TILTED)


def test_the_work_is_taken_by_fields_alone():
    """Where a force is left out of the loads, or Q is halved, what is declared stays."""
    equations = eomgen.derive(eomgen.loads(SPACE)).graph
    state = real_state(equations.system, Random(3))
    assert not acting_otherwise(equations.system, state) and not working_otherwise(equations, state)
    loads = equations.system.loads
    fewer = replace(loads, applied=tuple(f for f in loads.applied if f.name != "push"))
    assert "push 'sleeve'" in acting_otherwise(replace(equations.system, loads=fewer), state)
    halved = replace(equations, Q=tuple(x / 2 for x in equations.Q))
    assert "the work" in working_otherwise(halved, state)
