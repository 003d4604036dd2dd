"""The certificate holds for what is right, and turns red for any wrong sign, wherever it is planted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
import pytest
from derivations import equations as equations_of
from derivations import moving
from slow_run import sampled

import eomgen
from eomgen.equations import Equations
from eomgen.errors import DerivationError
from eomgen.mechanics.dynamics import formulations, tree
from eomgen.mechanics.dynamics import tree as recursion
from eomgen.mechanics.dynamics.accelerations import exact_accelerations
from eomgen.mechanics.dynamics.system import EquationsOfMotion
from eomgen.mechanics.free_bodies import balance, friction, reactions
from eomgen.mechanics.free_bodies import wrenches as components
from eomgen.mechanics.free_bodies import wrenches as effects
from eomgen.mechanics.free_bodies.balance import Balance, BodyEquation
from eomgen.mechanics.free_bodies.equilibrium import imbalance
from eomgen.mechanics.kinematics import motion as kinematics
from eomgen.mechanics.kinematics import scene as contacts
from eomgen.model.forces.elements import Reach
from eomgen.model.forces.weights import Gravity
from eomgen.proof.certificate import certify
from eomgen.proof.printed import Printed
from eomgen.proof.states import closed_state
from eomgen.symbolic.expression import Matrix, Vector
from eomgen.symbolic.expression.node import Scalar, linear_terms
from eomgen.symbolic.numeric.evaluation import fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

MODELS = Path(__file__).parents[2] / "models"
SMALL = (
    "double_pendulum",
    "elastic_pendulum",
    "cart_pole",
    "parallelogram_reactions",
    "bead_on_turning_hoop",
    "four_bar",
    "slider_crank",
)


def derived(name: str) -> Equations:
    return eomgen.derive(eomgen.load(next(MODELS.rglob(f"{name}.toml"))))


@sampled(3)
@pytest.mark.parametrize("path", moving(), ids=lambda path: path.stem)
def test_the_certificate_holds_for_every_model(path):
    """Three routes, the poses, the free bodies, the energy theorem and the emitted code agree."""
    certificate = equations_of(path.stem).certify()
    assert certificate.ok, str(certificate)


def with_one_sign_turned(entry: Scalar):
    """Every version of the expression in which one term of the sum has the other sign."""
    terms = linear_terms(entry)
    for turned in terms:
        total: Scalar = 0
        for atom, c in terms.items():
            sign = -1 if atom is turned else 1
            total = total + (sign * c if atom is None else sign * c * atom)
        yield total


def mutants(equations: EquationsOfMotion):
    """The equations with one sign turned in one entry: (what, equations)."""
    for field in ("c", "Q", "forcing", "sigma", "gamma", "nu"):
        row = getattr(equations, field)
        for i, entry in enumerate(row):
            for wrong in with_one_sign_turned(entry):
                yield f"{field}[{i}]", replace(equations, **{field: (*row[:i], wrong, *row[i + 1 :])})
    for field in ("M", "J", "N"):
        rows = getattr(equations, field)
        for i, row in enumerate(rows):
            for j, entry in enumerate(row):
                for wrong in with_one_sign_turned(entry):
                    changed = (*row[:j], wrong, *row[j + 1 :])
                    yield f"{field}[{i}][{j}]", replace(equations, **{field: (*rows[:i], changed, *rows[i + 1 :])})
    for field in ("T", "V"):
        for wrong in with_one_sign_turned(getattr(equations, field)):
            yield field, replace(equations, **{field: wrong})


@sampled(2)
@pytest.mark.parametrize("name", SMALL)
def test_a_wrong_sign_in_any_term_turns_it_red(name):
    """One term of one entry of M, c, Q, forcing, J, sigma, gamma, N, nu, T or V with the other sign."""
    equations = derived(name)
    planted = 0
    for what, mutant in mutants(equations.graph):
        planted += 1
        assert not certify(mutant).ok, f"a wrong sign in {what} was not seen"
    assert planted >= 7  # the parallelogram is short: M, c, Q, forcing, T and V of one crank


@pytest.mark.parametrize("method", ["projection", "kinetostatic"])
def test_a_method_goes_its_own_way_and_an_error_on_it_turns_it_red(monkeypatch, method):
    """M, c and Q by the method's own way are those that are held; by the energies nothing is asked of the wrenches."""
    right = formulations.PROJECTION

    def wrong(system):
        found = right.assemble(system)
        return replace(found, c=tuple(-x for x in found.c))

    monkeypatch.setitem(formulations.METHODS, method, replace(right, assemble=wrong))
    model = eomgen.load(MODELS / "double_pendulum.toml")
    found = eomgen.derive(model, method=method).certify()
    assert [c.name for c in found.checks if not c.ok] == ["M, c and Q of the derivation are those of the equations"]
    assert eomgen.derive(model, method="lagrange").certify().ok


def turned_rate_matrix(w, wd):
    U = recursion_rate_matrix(w, wd)
    return Matrix((-U[0], U[1], U[2]))


recursion_rate_matrix = recursion.rate_matrix
own_moments = tree._own_moments
spin_between = kinematics.spin_between
link_twist = kinematics._twist


def lighter(motion, link, plane):
    moments = own_moments(motion, link, plane)
    return replace(moments, h=-moments.h)


def swapped(w):
    return Vector((w[1], w[0], w[2]))


def backwards(scope, above, before, local, s_rate, S, point):
    return link_twist(scope, above, before, local, tuple(-rate for rate in s_rate), S, point)


ENGINE_ERRORS = [
    ("arm3", recursion, "rate_matrix", turned_rate_matrix),
    ("double_pendulum", recursion, "rate_matrix", turned_rate_matrix),
    ("double_pendulum", tree, "_own_moments", lighter),
    ("double_pendulum", kinematics, "_twist", backwards),
    ("arm3", kinematics, "spin_between", lambda R, rate: swapped(spin_between(R, rate))),
    ("simple_pendulum", Gravity, "potential", lambda self, scene: 0),
    ("two_mass_oscillator", Reach, "pulled", lambda self, tension: ()),
]


@pytest.mark.parametrize(("name", "place", "attribute", "wrong"), ENGINE_ERRORS)
def test_an_error_in_the_engine_turns_it_red(monkeypatch, name, place, attribute, wrong):
    """A wrong sign or a lost term in a law itself, not in its result."""
    monkeypatch.setattr(place, attribute, wrong)
    equations = derived(name)
    assert not certify(equations.graph).ok


# -- the balance of the bodies ---------------------------------------------------------------------

BALANCED = ("double_pendulum", "parallelogram_reactions", "ch22_p1", "ch18_p5", "ch16_p6", "four_bar", "ch17_p5")


def in_motion(equations: Equations):
    """A state on the constraints, the accelerations those of the equations."""
    state, _ = closed_state(equations.system, Random(7))
    a = np.array(exact_accelerations(equations.graph, state), dtype=float)
    return state | {s: fifty_digits().number(1) * float(x) for s, x in zip(equations.graph.symbols.a, a, strict=True)}


def turned(equation: BodyEquation):
    """Every version of a body's equation with one sign turned: of an entry, the load or the inertia."""
    for j, entry in equation.coefficients.items():
        for wrong in with_one_sign_turned(entry):
            yield replace(equation, coefficients={**equation.coefficients, j: wrong})
    for field in ("applied", "inertia"):
        for wrong in with_one_sign_turned(getattr(equation, field)):
            yield replace(equation, **{field: wrong})


def balance_mutants(right: Balance):
    """Every balance with one sign turned in one equation, or in what a component does to one of several bodies."""
    for i, equation in enumerate(right.equations):
        for wrong in turned(equation):
            equations = (*right.equations[:i], wrong, *right.equations[i + 1 :])
            yield f"{equation.body}, {i}", replace(right, equations=equations)
    for j, component in enumerate(right.components):
        for k, effect in enumerate(component.effects if len(component.effects) > 1 else ()):
            other = replace(effect, force=-effect.force, couple=-effect.couple)
            wrong = replace(component, effects=(*component.effects[:k], other, *component.effects[k + 1 :]))
            yield component.name, replace(right, components=(*right.components[:j], wrong, *right.components[j + 1 :]))


@pytest.mark.parametrize("name", BALANCED)
def test_a_wrong_sign_in_any_equation_of_a_body_is_out_of_balance(name, monkeypatch):
    """One term of a coefficient, a load, an inertia force or couple, or one of two opposite forces."""
    equations = derived(name)
    system, state = equations.system, in_motion(equations)
    right = Balance.of(system)
    assert imbalance(reactions.Reactions.of(system), state, Random(1)) == ""
    planted = 0
    for what, wrong in balance_mutants(right):
        monkeypatch.setattr(Balance, "of", lambda *_, wrong=wrong: wrong)
        planted += 1
        try:
            seen = imbalance(reactions.Reactions.of(replace(system)), state, Random(1))
        except DerivationError as error:  # refused at once: a body would be held by nothing
            seen = error.what
        assert seen, f"a wrong sign in {what} was not seen"
    assert planted >= 7


def pushing(mode, law, value, sliding):
    factor = friction_factor(mode, law, value, sliding)
    return None if factor is None else -factor


def other_way(of_system, found):
    return [replace(contact, along=tuple(-x for x in contact.along)) for contact in friction_contacts(of_system, found)]


def without_parent(axes, link, force, couple):
    return joint_effects(axes, link, force, couple)[:1]


def to_the_other_side(axes, i, place):
    return -arm(axes, i, place)


friction_factor, friction_contacts = contacts.ContactMode.friction_factor, friction.SystemFriction.contacts
joint_effects, arm = effects.effects_at_joint, effects.Axes.arm
REACTION_ERRORS = [
    ("ch16_p6", contacts.ContactMode, "friction_factor", pushing),
    ("ch16_p6", friction.SystemFriction, "contacts", other_way),
    ("double_pendulum", components, "effects_at_joint", without_parent),
    ("arm3", components, "effects_at_joint", without_parent),
    ("double_pendulum", effects.Axes, "arm", to_the_other_side),
    ("ch22_p1", effects.Axes, "arm", to_the_other_side),
    ("arm3", effects, "_armatures", lambda motion, link: [(0, 1)] if link.joint.efforts() else []),
    ("elastic_pendulum", effects, "_effort_effects", lambda axes, effort: []),
    ("ch18_p3", balance, "_applied", lambda system, axes: [(0,) * 6 for _ in axes.motion.links]),
]


@pytest.mark.parametrize(("name", "place", "attribute", "wrong"), REACTION_ERRORS)
def test_an_error_in_reactions_or_friction_turns_it_red(monkeypatch, name, place, attribute, wrong):
    """A wrong sign or a lost term in what the balance of the bodies or the friction is made of."""
    monkeypatch.setattr(place, attribute, wrong)
    equations = derived(name)
    assert not certify(equations.graph).ok


def test_where_reactions_do_not_follow_the_balance_is_left_out():
    """A body that nothing holds has no reactions; the other checks stand."""
    equations = eomgen.derive(replace(eomgen.load(MODELS / "atwood.toml"), constraints={}, outputs={}))
    names = [check.name for check in certify(equations.graph).checks]
    assert "every body is in equilibrium with its reactions" not in names and len(names) >= 7


ROUGH = """
eomgen = 1
name = "rough"
space = "plane"
[parameters]
m = 1.2
mu = 0.3
g = 9.81
l = 0.7
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
BAR = """
[bodies.bar]
mass = "m"
inertia = "m*l^2"
points = { P = ["-l", 0], Q = ["l", 0] }
line = ["P", "Q"]
"""
WITH_FRICTION = {
    "a bar on a floor": """
[coordinates]
x = { start = 0.3, speed = 1 }
y = 0.4
a = 0.9
"""
    + BAR
    + """joint = { kind = "planar", x = "x", y = "y + l*sin(a) - 0.4", angle = "a" }
[constraints.floor]
kind = "support"
point = "bar.P"
normal = [0, 1]
friction = "mu"
""",
    "a pin in a slot": """
[coordinates]
a = { start = 0.5, speed = 1 }
b = 0.9
[bodies.crank]
mass = "m"
inertia = "m*l^2"
points = { P = ["l", 0] }
joint = { kind = "revolute", angle = "a" }
"""
    + BAR
    + """joint = { kind = "revolute", at = [1.5, 0], angle = "b" }
[constraints.slot]
kind = "slider"
point = "crank.P"
on = "bar"
friction = { viscous = "mu" }
""",
}


@pytest.mark.parametrize("name", WITH_FRICTION)
def test_the_certificate_holds_where_a_closing_tie_has_friction(name):
    """N is its multiplier, solved together with the accelerations; friction is in Q, the balance and the energy."""
    certificate = eomgen.derive(eomgen.loads(ROUGH + WITH_FRICTION[name])).certify()
    assert certificate.ok, str(certificate)
    reported = {check.name for check in certificate.checks}
    assert {"friction takes power from sliding bodies", "every body is in equilibrium with its reactions"} <= reported


@pytest.mark.parametrize("law", ['motion = "w*t^2"', 'rate = "w*t^2"', 'acceleration = "w*t^2", speed = "w"'])
def test_what_is_driven_moves_as_given(law):
    """nu = f', f or f' = w + the integral of f: any other nu turns it red, at some t other than 0."""
    equations = eomgen.derive(eomgen.loads(DRIVEN.format(law=law))).graph
    name = "driven coordinates move as given"
    assert {check.name: check.ok for check in certify(equations).checks}[name]
    for wrong in (0, equations.nu[0] + equations.symbols.t, -equations.nu[0]):
        turned = replace(equations, nu=(wrong, *equations.nu[1:]))
        assert not {check.name: check.ok for check in certify(turned).checks}[name]


DRIVEN = """
eomgen = 1
space = "plane"
parameters = {{ m = 2, l = 1, w = 3 }}
[coordinates]
a = {{ {law} }}
b = 0.3
[bodies.crank]
shape = {{ kind = "rod", mass = "m", length = "l" }}
joint = {{ kind = "revolute", angle = "a" }}
[bodies.arm]
shape = {{ kind = "rod", mass = "m", length = "l" }}
joint = {{ kind = "revolute", on = "crank.end", angle = "b" }}
"""


ROPE = """
eomgen = 1
space = "plane"
parameters = { m1 = 3, m2 = 1, g = 9.81 }
coordinates = { y1 = { start = 0, speed = 1 }, y2 = 0 }
points = { A = [-1, 5], B = [1, 5] }
bodies.L.shape = { kind = "particle", mass = "m1" }
bodies.L.joint = { kind = "prismatic", axis = [0, -1], at = [-1, 0], displacement = "y1" }
bodies.R.shape = { kind = "particle", mass = "m2" }
bodies.R.joint = { kind = "prismatic", axis = [0, -1], at = [1, 0], displacement = "y2" }
constraints.rope = { kind = "string", path = ["L.center", "A", "B", "R.center"] }
forces.g = { kind = "gravity", acceleration = [0, "-g"] }
"""
FALLS = "(m1 - m2)*g/(2*(m1 + m2))*t^2"


@pytest.mark.parametrize(
    ("laws", "wrong"),
    [
        ((f"t + {FALLS}", f"-t - {FALLS}"), ""),
        ((f"t + {FALLS}", f"-{FALLS}"), "'rope' does not hold"),
        ((f"t + 2*{FALLS}", f"-t - 2*{FALLS}"), "y1 is accelerated by 9.81, not 4.905"),
    ],
)
def test_laws_of_motion_as_they_are_printed_are_the_motion_from_the_start(laws, wrong):
    """y1 = t + (m1 - m2) g t^2/2 (m1 + m2), y1 + y2 = const"""
    graph = eomgen.derive(eomgen.loads(ROPE)).graph
    checks = certify(graph, printed=Printed(laws=tuple(zip(("y1", "y2"), laws, strict=True)))).checks
    (found,) = [check for check in checks if "laws of motion" in check.name]
    assert bool(found.ok) == (not wrong) and wrong in found.detail
