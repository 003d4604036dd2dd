"""Loops that a moving body carries: rows that are redundant there in every state, whatever the base does.

The plane of the loop turns with its carrier. In ground axes d_x = d_r cos q and d_y = d_r sin q: which of the two rows
is redundant changes with q, and the one left over has J = 0 wherever the others hold.
"""

from __future__ import annotations

import numpy as np
import pytest
from bodies_apart import Closure, Machine, Part, closed, rates_that_stay, text_of
from slow_run import in_slow_run, sampled, usual

import eomgen
from eomgen.mechanics.constraints import elimination
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits, floats_of

A, B = 0.4, 0.9  # cranks and couplers [m]


def bar(on: str, at: tuple[float, ...], axis: tuple[float, ...], length: float, m: float = 1.3) -> Part:
    """A rod along its own x axis, hinged at its near end, which is its origin."""
    return Part(on, at, "revolute", axis, m, (0.06, 0.2, 0.25), com=(length / 2, 0, 0))


def parallelogram(on: str, axis: tuple[float, ...], *, name: str = "", at: tuple[float, ...] = (0.1, 0.2, 0.3)) -> dict:
    """Crank, coupler on the crank, rocker: three hinges of one axis on a body."""
    far = (at[0] + B, at[1], at[2])
    return {
        f"crank{name}": bar(on, at, axis, A),
        f"coupler{name}": bar(f"crank{name}", (A, 0, 0), axis, B),
        f"rocker{name}": bar(on, far, axis, A),
    }


def closing(name: str = "", axis: tuple[float, ...] | None = None) -> Closure:
    return Closure((f"rocker{name}", (A, 0, 0)), (f"coupler{name}", (B, 0, 0)), axis)


def ram(q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Of the slewing boom: a spring and damper in the ram, a damper in the boom's hinge."""
    return np.array([0, -5 * u[1], 0, -800 * (q[3] - 1.65) - 30 * u[3]])


BOOM = {
    "base": Part("ground", (0, 0, 0), "revolute", (0, 0, 1), 10, (1.5, 1.5, 2)),
    "boom": Part("base", (0.2, 0, 1), "revolute", (0, -1, 0), 3, (0.02, 2, 2), com=(1.5, 0, 0), more=", damping = 5"),
    "barrel": Part("base", (0.3, 0, 0.2), "revolute", (0, -1, 0), 4, (0.01, 0.1, 0.1)),
    "rod": Part(
        "barrel",
        (0, 0, 0),
        "prismatic",
        (1, 0, 0),
        3,
        (0.01, 0.1, 0.1),
        more=", stiffness = 800, rest = 1.65, damping = 30",
    ),
}
TURNTABLE = {"base": Part("ground", (0, 0, 0), "revolute", (0, 0, 1), 5, (0.5, 0.6, 0.7), com=(0.1, 0.2, 0))}
TILTED = {"base": Part("ground", (0, 0, 0), "revolute", (1, 2, 2), 5, (0.5, 0.6, 0.7), com=(0.1, 0.2, 0))}
FREE = {"base": Part("ground", (0, 0, 0), "free", (0, 0, 1), 5, (0.5, 0.6, 0.7), com=(0.1, 0.2, 0))}
UPPER = TURNTABLE | {"arm": Part("base", (0, 0, 1), "revolute", (0, 1, 0), 2, (0.1, 0.3, 0.3), com=(0.3, 0, 0))}
Y, Z, OBLIQUE = (0, 1, 0), (0, 0, 1), (1, 1, 0)
ON_ONE_ANOTHER = TURNTABLE | parallelogram("base", Y) | parallelogram("coupler", Y, name="2", at=(0, 0, 0.2))
BALLS = TILTED | {
    "crank": bar("base", (0, 0, 0.2), Y, A),
    "rod": Part("crank", (A, 0, 0), "spherical", Z, 1, (0.02, 0.1, 0.12), com=(B / 2, 0, 0)),
    "rocker": bar("base", (B, 0.2, 0.1), (1, 0, 0), A),
}

MACHINES = {  # name: (machine, coordinates, where they are sought, dependent ones)
    "a boom on a slewing base": (Machine(BOOM, [Closure(("rod", (0, 0, 0)), ("boom", (1.5, 0, 0)))], efforts=ram),
        "q a ga s", [-0.3, 0.6, 0.9, 1.9], "s ga"),
    "a gripper on a wrist": (Machine(TILTED | parallelogram("base", Z), [closing()]),
        "q f f3 f2", [0.3, 1, -1, 1], "f2 f3"),
    "a hinge closes a linkage whose plane is oblique": (
        Machine(TURNTABLE | parallelogram("base", OBLIQUE), [closing(axis=OBLIQUE)]),
        "q f f3 f2", [0.3, 1, -1, 1], "f2 f3"),
    "an arm with a parallelogram": (Machine(UPPER | parallelogram("arm", Y), [closing()]),
        "q p f f3 f2", [0.3, 0.4, 1, -1, 1], "f2 f3"),
    "a satellite with a linkage": (Machine(FREE | parallelogram("base", Y), [closing()]),
        "x y z al be ga f f3 f2", [0.1, 0, 0, 0.4, 0.5, 0.3, 1, -1, 1], "f2 f3"),
    "a linkage on the coupler of another": (Machine(ON_ONE_ANOTHER, [closing(), closing("2")]),
        "q f f3 f2 g g3 g2", [0.3, 1, -1, 1, 0.7, -0.7, 0.7], "f2 f3 g2 g3"),
    "a rod between balls on a tilting base": (Machine(BALLS, [Closure(("rod", (0.7, 0, 0)), ("rocker", (0, 0, A)))]),
        "q f a b c r", [0.3, 0.2, 0.1, 0.2, 0.3, 0.4], "b c r"),
}  # fmt: skip


def states_of(name: str) -> list[tuple[np.ndarray, np.ndarray]]:
    """Closed states in motion: the base at 0 and at a quarter turn, where rows in ground axes vanish, and elsewhere."""
    machine, names, near, dependent = MACHINES[name]
    kept = [k for k, x in enumerate(names.split()) if x not in dependent.split()]
    found = []
    for turned in (0.0, np.pi / 2, 0.7):
        q = np.array(near, float)
        q[0] = turned
        q = closed(machine, q, kept)
        found.append((q, rates_that_stay(machine, q, np.linspace(0.8, -0.6, len(q)), kept)))
    return found


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize("dependent", [False, True], ids=["multipliers", "dependent"])
@pytest.mark.parametrize("name", MACHINES)
def test_accelerations_of_loops_that_a_moving_body_carries_are_those_of_free_bodies(name, dependent):
    """q'' of M a = F + C^T lam, C a = -C' v in maximal coordinates, lam of least norm."""
    machine, names, _, follow = MACHINES[name]
    states = states_of(name)
    text = text_of(machine, names.split(), states[2][0], follow.split() if dependent else ())
    rhs = eomgen.derive(eomgen.loads(text)).rhs("numpy")
    own = [names.split().index(x) for x in rhs.coordinates]
    for q, u in states:
        right = machine.rates_of_rates(q, u)
        speeds = [names.split().index(x.removesuffix("'")) for x in rhs.speeds]
        found = rhs(0.0, [*q[own], *u[speeds]], rhs.p0)[len(q) :]
        assert np.allclose(found, right[speeds], rtol=2e-6, atol=2e-6 * np.max(abs(right)))


SLEWING = """
eomgen = 1
name = "Slewing loader"
space = "space"
[parameters]
g = 9.81
[coordinates]
q = { start = -0.3, speed = 1.5 }
a = 0.6
s = { start = 1.6 }
ga = 0.9
[bodies.base]
mass = 100
inertia = [15, 15, 20]
joint = { kind = "revolute", angle = "q" }
[bodies.boom]
shape = { kind = "box", mass = 30, size = [3, 0.1, 0.1] }
points = { near = [-1.5, 0, 0], mid = [0, 0, 0] }
[bodies.boom.joint]
kind = "revolute"
on = "base"
at = [0.2, 0, 1]
point = "near"
axis = [0, -1, 0]
angle = "a"
damping = 5
[bodies.barrel]
mass = 4
inertia = [0.01, 0.1, 0.1]
joint = { kind = "revolute", on = "base", at = [0.3, 0, 0.2], axis = [0, -1, 0], angle = "ga" }
[bodies.rod]
mass = 3
inertia = [0.01, 0.1, 0.1]
[bodies.rod.joint]
kind = "prismatic"
on = "barrel"
axis = [1, 0, 0]
displacement = "s"
stiffness = 8000
rest = 1.65
damping = 300
[constraints.C]
kind = "pin"
points = ["rod.origin", "boom.mid"]
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""  # fmt: skip
PIN = '[constraints.C]\nkind = "pin"\npoints = ["rod.origin", "boom.mid"]\n'
FOLLOWING = (
    "s = { start = 1.6 }\nga = 0.9",
    "s = { dependent = true, near = 1.9 }\nga = { dependent = true, near = 0.9 }",
)


def by_equations(axes: str, seen_from: str) -> str:
    """The pin's rows along some axes as equations."""
    gaps = [f'"{k}(rod.origin{seen_from}) - {k}(boom.mid{seen_from})"' for k in axes]
    return "".join(f'[constraints.C{k}]\nkind = "equation"\ngap = {gap}\n' for k, gap in zip(axes, gaps, strict=True))


REGULAR = SLEWING.replace(PIN, by_equations("xz", ", base"))
IN_GROUND_AXES = SLEWING.replace(PIN, by_equations("xyz", ""))
SUMS = (
    "reaction_z(base)",
    "reaction_couple_x(base)",
    "reaction_couple_z(base)",
    "reaction_z(boom)",
    "reaction_couple_y(rod)",
)
REQUESTED = "[outputs]\nqdd = \"q''\"\n" + "".join(f'r{k} = "{name}"\n' for k, name in enumerate(SUMS))


@pytest.mark.slow
@pytest.mark.parametrize(
    "text", [SLEWING.replace(*FOLLOWING), IN_GROUND_AXES.replace(*FOLLOWING)], ids=["pin", "ground"]
)
def test_a_slewing_base_with_a_dependent_loop_keeps_its_angular_momentum(text):
    """H_z' = 0 and a' = 0: q'' = 0, and the ground bears the weight of all that rises."""
    found = eomgen.solve(eomgen.loads(text + '[outputs]\nqdd = "q\'\'"\nN = "reaction_z(base)"\n'))
    assert abs(found["qdd"].value) < 1e-12
    assert found["N"].value == pytest.approx(489.24025, abs=1e-4)
    assert found.certify().ok


@in_slow_run
@pytest.mark.slow
@pytest.mark.parametrize("text", usual([SLEWING, IN_GROUND_AXES], 2))
def test_determinate_reactions_do_not_hang_on_redundant_rows(text):
    """The same machine without the row that follows has the same accelerations and determinate reactions."""
    found, right = (eomgen.solve(eomgen.loads(x + REQUESTED)) for x in (text, REGULAR))
    for name in ("qdd", *(f"r{k}" for k in range(len(SUMS)))):
        assert found[name].value == pytest.approx(right[name].value, rel=1e-10, abs=1e-8)
    derived = eomgen.derive(eomgen.loads(text))
    assert derived.certify().ok
    assert "reaction_y(boom)" in {c.name for c in derived.reactions.indeterminate}


def test_a_run_passes_the_place_at_which_a_redundant_row_vanishes_in_ground_axes():
    """q passes 0, where d_y = d_r sin q vanishes; q(2) is that of the machine without the row."""
    run = eomgen.simulate(eomgen.loads(SLEWING), time=2, samples=21, target="numpy")
    assert run.ok
    assert run.x[0, 0] < 0 < run.x[-1, 0]
    assert run.x[-1, 0] == pytest.approx(2.23095, abs=2e-5)


def test_a_closing_row_that_joints_hold_alone_is_named():
    """2 = 1 + 1: the count by formula is short of the rank by the rows that follow."""
    freedom = eomgen.freedom_of(eomgen.loads(SLEWING))
    assert [(row.constraint, row.number, row.by_joints) for row in freedom.redundant] == [("C", 2, True)]
    assert freedom.by_rank == freedom.by_formula + len(freedom.redundant) == 2


def test_the_second_hinge_of_a_door_is_named_as_redundant():
    """1 = -4 + 5: all five rows of the upper hinge follow from those of the lower."""
    door = """
eomgen = 1
space = "space"
[coordinates]
psi = { start = 0.3, speed = 1 }
[bodies.door]
shape = { kind = "box", mass = 20, size = [0.8, 0.04, 2] }
points = { low = [-0.4, 0, -0.5], high = [-0.4, 0, 0.5] }
joint = { kind = "placed", at = ["0.4*cos(psi)", "0.4*sin(psi)", 1], angle = "psi" }
[constraints.L]
kind = "pin"
points = ["door.low"]
axis = [0, 0, 1]
[constraints.H]
kind = "pin"
points = ["door.high"]
axis = [0, 0, 1]
"""
    freedom = eomgen.freedom_of(eomgen.loads(door))
    assert [(row.constraint, row.number, row.others) for row in freedom.redundant] == [
        ("H", k, ("L",)) for k in range(1, 6)
    ]
    assert freedom.by_rank == freedom.by_formula + len(freedom.redundant) == 1


@pytest.mark.parametrize("text", [SLEWING, IN_GROUND_AXES], ids=["pin", "ground"])
def test_inverse_dynamics_counts_freedoms_where_the_loops_are_closed(text):
    """Two degrees of freedom take two actuators: an entry that only vanishes where the others hold is no row of J."""
    found = eomgen.derive(eomgen.loads(text)).inverse_dynamics(actuated=("q", "s"))
    assert found.names == ("q", "s")


@pytest.mark.slow
def test_accelerations_by_a_row_that_vanishes_where_the_others_hold_are_contradicted(monkeypatch):
    """The error: d_y, whose J vanishes where d_x and d_z hold, taken for independent: q'' = -2 tan q q'^2.

    Slow: equations, answers and code are each proven.
    """

    class AsFound(elimination.Closure):
        def rows_at(self, state):
            values = floats_of(evaluate([x for row in self.constraints.J for x in row], state, fifty_digits()))
            return np.array(values).reshape(len(self.constraints.closing), -1)

    monkeypatch.setattr(elimination, "Closure", AsFound)
    model = eomgen.loads(IN_GROUND_AXES.replace(*FOLLOWING) + REQUESTED)
    derived = eomgen.derive(model)
    assert _failing(derived.certify())  # which check sees it depends on the last of the 50 digits, by luck 0 or not
    answers = eomgen.solve(model)
    assert _failing(answers.certify()) or all(answer.value is None for answer in answers.values())
    code = eomgen.generate(model, targets=("numpy",)).certify()
    assert any("numpy" in name for name in _failing(code))


def _failing(certificate) -> list[str]:
    return [check.name for check in certificate.checks if check.ok is False]


def test_code_holds_a_gap_by_the_longer_of_two_rows_that_share_it():
    """d cos q = 0 and d sin q = 0 at sin q = 1e-6, open by 1e-9 and opening: a is that of d = 0 all the same."""
    codes = [eomgen.derive(eomgen.loads(text)).rhs("numpy") for text in (IN_GROUND_AXES, REGULAR)]
    a, s, ga = 0.508800829, 1.95118272, 0.901883355
    for q in (1e-6, np.pi / 2 + 1e-6):
        x = np.array([q, a, s + 1e-9, ga, 1.5, 0.0, 1e-9, 0.0])
        found, right = (rhs(0.0, x, rhs.p0) for rhs in codes)
        assert np.allclose(found, right, rtol=1e-6, atol=1e-5)


def test_dependent_rates_by_rows_that_vanish_in_turns_are_determined_at_every_turn():
    """d cos q = 0 and d sin q = 0 give d' = 0 at q = pi/2 too, where the chosen one of them says nothing."""
    codes = [eomgen.derive(eomgen.loads(text.replace(*FOLLOWING))).rhs("numpy") for text in (IN_GROUND_AXES, REGULAR)]
    a, s, ga = 0.508800829, 1.951182719, 0.901883355
    for q in (0.0, np.pi / 2, 2.0):
        found, right = (rhs(0.0, [q, a, s, ga, 1.5, 0.3], rhs.p0) for rhs in codes)
        assert np.allclose(found, right, rtol=1e-6, atol=1e-6)
