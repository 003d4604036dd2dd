"""The same mechanism said in another way is the same: what all routes to the equations share shows here.

By default a tenth of the models of models/; all of them by

    EOMGEN_ALL_MODELS=1 python -m pytest -q tests/laws/test_symmetries.py
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path
from random import Random

import numpy as np
import pytest
from derivations import loaded
from slow_run import sampled, usual, usual_models
from transformed_models import (
    SCALES,
    Tables,
    Unfit,
    factor_of,
    in_other_units,
    other_origins,
    reordered,
    shifted,
    tables_of,
    text_of,
    turned,
)

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
TRANSFORMATIONS = {"turned": turned, "ground shifted": shifted, "reordered": reordered, "origins moved": other_origins}
IN_UNITS = ("double_pendulum", "cart_pole", "elastic_pendulum", "simple_pendulum", "spherical_pendulum")


def with_motion() -> Iterable[Path]:
    """The models that move freely, with values of all their parameters."""
    for path in usual_models(sorted(MODELS.rglob("*.toml"))):
        if "coordinates" in tables_of(path):
            model = loaded(path)  # what other files of this process have read
            free = any(not (part.driven or part.dependent) for part in model.coordinates.values())
            if free and model.exact_parameters().keys() == model.parameters.keys():
                yield path


MOVING = list(with_motion())


def pairs() -> Iterable[tuple[Path, str]]:
    """(model, transformation) that can be said of it."""
    for path in usual(MOVING, 5, first=3):
        for how, change in TRANSFORMATIONS.items():
            try:
                change(tables_of(path))
            except Unfit:
                continue
            yield path, how


def accelerations(tables: Tables) -> dict[str, tuple[float, ...]]:
    """u' by name at the start and, where no constraint closes, at a random state beside it; by the model's own
    numbers."""
    equations = eomgen.derive(eomgen.loads(text_of(tables)))
    rhs = equations.rhs("numpy")
    names = tuple(node.name for node in equations.system.symbols.x)
    rng = Random(3)
    moved = {name: rng.uniform(-0.1, 0.1) for name in sorted(names)}
    constrained = bool(equations.graph.J) or any(c.dependent for c in equations.model.coordinates.values())
    states = [np.asarray(rhs.x0)]
    if not constrained:
        states.append(states[0] + np.array([moved[name] for name in names]))
    rows = [rhs(0.0, x, rhs.p0)[len(equations.coordinates) :][: len(equations.speeds)] for x in states]
    return dict(zip(equations.speeds, zip(*(map(float, row) for row in rows), strict=True), strict=True))


@cache
def plain(path: Path) -> dict[str, tuple[float, ...]]:
    return accelerations(tables_of(path))


def assert_same(there: dict[str, tuple[float, ...]], here: dict[str, tuple[float, ...]]) -> None:
    assert here.keys() == there.keys()
    scale = 1 + max(abs(x) for row in here.values() for x in row)
    for name, values in here.items():
        assert np.allclose(there[name], values, rtol=0, atol=1e-8 * scale), name


@sampled(3)
@pytest.mark.parametrize(("path", "how"), list(pairs()), ids=lambda x: x.stem if isinstance(x, Path) else x)
def test_the_same_mechanism_has_the_same_accelerations(path, how):
    """u'(R model) = u'(model): no law hangs on where the ground's origin and axes, or a body's, are."""
    assert_same(accelerations(TRANSFORMATIONS[how](tables_of(path))), plain(path))


@pytest.mark.parametrize("name", IN_UNITS)
def test_other_units_give_the_same_motion(name):
    """With lengths, masses and times in other units x'' comes out in them: x'' times length / time^2."""
    tables = tables_of(MODELS / f"{name}.toml")
    here = {
        u: tuple(
            x * float(factor_of(tables["coordinates"][u.rstrip("'")].get("unit")) / SCALES["time"] ** 2) for x in row
        )
        for u, row in plain(MODELS / f"{name}.toml").items()
    }
    start = {u: row[:1] for u, row in accelerations(in_other_units(tables)).items()}
    assert_same(start, {u: row[:1] for u, row in here.items()})


def is_conservative(path: Path) -> bool:
    """Whether nothing in the file takes or gives energy, or depends on time."""
    words = ("damp", "friction", "unilateral", "[inputs", "torque", "rate =", "motion =", 'acceleration = "', "couple")
    return not any(word in path.read_text(encoding="utf-8") for word in (*words, "[speeds", 'kind = "force"'))


REVERSIBLE = [path for path in MOVING if is_conservative(path)]


@pytest.mark.parametrize("path", usual(REVERSIBLE, 4, first=1), ids=lambda p: p.stem)
def test_a_conservative_motion_runs_backwards_on_its_own_path(path):
    """q(T) reached with u(T): from there with -u(T), the start comes back after T, with -u(0)."""
    model = eomgen.load(path)
    accuracy = {"time": 0.3, "rtol": 1e-11, "atol": 1e-11, "samples": 2}
    there = eomgen.simulate(model, **accuracy)
    assert there.ok
    rates = [f"{q}'" for q, part in model.coordinates.items() if not part.dependent]
    start = {q: there[q][-1] for q in model.coordinates} | {u: -there[u][-1] for u in rates}
    back = eomgen.simulate(model, start=start, **accuracy)
    for q in model.coordinates:
        assert abs(back[q][-1] - there[q][0]) < 1e-7 * (1 + abs(there[q][0])), q


PAIR = """
eomgen = 1
space = "plane"
[parameters]
m = 2
n = 3
l = 0.8
[coordinates]
x = 0.1
y = 0.2
p = { start = 0.3, speed = 2 }
r = { start = 0.9, speed = -1 }
[bodies.A]
mass = "m"
inertia = 0.1
points = { P = ["l", 0.1] }
joint = { JOINT_A }
[bodies.B]
mass = "n"
inertia = 0.2
points = { P = [-0.3, "l"] }
joint = { JOINT_B }
[forces.pull]
kind = "force"
point = "B.P"
force = [3, 4]
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
[outputs]
ax = "ax(A.P)"
ay = "ay(A.P)"
"""
ROOTED_AT = {
    "A": (
        'kind = "free", x = "x", y = "y", angle = "p", point = "P"',
        'kind = "revolute", on = "A.P", point = "P", angle = "r - p"',
    ),
    "B": (
        'kind = "revolute", on = "B.P", point = "P", angle = "p - r"',
        'kind = "free", x = "x", y = "y", angle = "r", point = "P"',
    ),
}


def test_it_does_not_matter_which_body_the_tree_begins_with():
    """Two bodies on one hinge that flies: the hinge's coordinates and both angles, hung from either body."""
    found = []
    for first, second in ROOTED_AT.values():
        equations = eomgen.derive(eomgen.loads(PAIR.replace("JOINT_A", first).replace("JOINT_B", second)))
        rhs = equations.rhs("numpy")
        found.append(dict(zip(equations.speeds, ((float(x),) for x in rhs(0.0, rhs.x0, rhs.p0)[4:]), strict=True)))
    assert_same(*found)


def test_it_does_not_matter_where_a_loop_is_cut():
    """A four-bar linkage closed by its pin at B, or at the rocker's foot: the crank accelerates alike."""
    tables = tables_of(MODELS / "four_bar.toml")
    there = tables_of(MODELS / "four_bar.toml")
    there["points"] = {"D": ["d", 0]}
    there["bodies"]["rocker"]["joint"] = {
        "kind": "revolute",
        "on": "coupler.end",
        "point": "end",
        "angle": "gamma - beta",
    }
    there["constraints"]["B"]["points"] = ["rocker.start", "D"]
    there.pop("outputs")
    assert_same(accelerations(there), accelerations(tables))


def test_a_wire_that_is_straight_in_no_axis_freezes_nothing():
    """L - |L - x| - x is zero for x < L, as at the start: the turned wire holds as the upright one does."""
    path = MODELS / "seeds" / "ch18_p5.toml"
    assert_same(accelerations(turned(tables_of(path))), plain(path))
