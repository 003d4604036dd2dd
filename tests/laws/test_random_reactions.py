"""Every reaction of random systems, by a second route: Newton's equations of all bodies in plain floats."""

from __future__ import annotations

import re
from math import cos, sin
from random import Random

import numpy as np
import pytest
from free_bodies import Tree, read
from random_systems import Writer
from slow_run import usual

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.inverse import DrivingForces
from eomgen.mechanics.free_bodies.reactions import Reactions
from eomgen.mechanics.free_bodies.solution import Indeterminate
from eomgen.symbolic.expression.node import Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

MOVED_INSIDE = ("S = ['l*", "A*t", 'kind = "placed"')  # seats and points that a coordinate moves: geometry, not bodies
AT_COORDINATES = ('kind = "potential"', 'kind = "generalized"')  # at no place: no reactions follow


class HeldWriter(Writer):
    """Writes models in which joints and constraints carry everything."""

    def body(self) -> None:
        kept = len(self.coordinates)
        while True:
            super().body()
            if not any(text in self.bodies[-1] for text in MOVED_INSIDE):
                return
            del self.coordinates[kept:], self.bodies[-1], self.names[-1]

    def force(self, k: int) -> None:
        while True:
            super().force(k)
            if not any(text in self.forces[-1] for text in AT_COORDINATES):
                return
            del self.forces[-1]

    def constraint(self, k: int) -> None:
        rng, body, other = self.rng, self.rng.choice(self.names), self.rng.choice(self.names)
        far = '"G"' if other == body else f'"{other}.P"'
        normal = '[1, "-2"]' if self.space == "plane" else '[2, 1, "-2"]'
        kinds = [
            f'kind = "support", point = "{body}.Z", normal = {normal}',
            f'kind = "link", points = ["{body}.Z", {far}]',
            f'kind = "pin", points = ["{body}.P"]',
        ]
        self.constraints.append(f"constraint{k} = {{ {rng.choice(kinds)} }}")


def held_model(space: str, seed: int, constraints: int = 0, spare: int = 3) -> str:
    """A model of at least four bodies, with `spare` more free coordinates for each constraint."""
    writer = HeldWriter(space, Random(seed))
    while len(writer.names) < 4 or sum("{" not in line for line in writer.coordinates) < 1 + spare * constraints:
        writer.body()
    for k in range(constraints):
        writer.constraint(k)
    for k in range(4):
        writer.force(k)
    couple = '"tau"' if space == "plane" else '["tau", 0, 0]'
    writer.forces.append(f'last = {{ kind = "couple", body = "B2", couple = {couple} }}')
    return writer.text()


def closed_model(space: str, seed: int, constraints: int, spare: int) -> str:
    """The first such model from a seed on whose constraints can hold beside what is given."""
    while not state(text := held_model(space, seed, constraints, spare), seed).holds:
        seed += 1000
    return text


def state(text: str, seed: int, t: float = 0.0) -> Tree:
    """The start of the model, with random rates that the constraints allow; given motions are where they are at t."""
    rng, table = Random(seed), read(text)
    A, w = (float(table["parameters"][name]) for name in ("A", "w"))
    laws = {
        "motion": (A * sin(w * t), A * w * cos(w * t)),
        "rate": (w * t * t / 2, w * t),
        "acceleration": (A / w**2 * (1 - cos(w * t)) + w * t, A / w * sin(w * t) + w),
    }
    given = {q: laws[next(iter(law))] for q, law in table["coordinates"].items() if isinstance(law, dict)}
    free = {q: float(value) for q, value in table["coordinates"].items() if q not in given}
    places = {q: given[q][0] if q in given else free[q] for q in table["coordinates"]}
    rates = {q: given[q][1] if q in given else rng.uniform(-1, 1) for q in table["coordinates"]}
    return Tree(table, places, rates, t).constrained()


def values(tree: Tree, system: System, scalars: tuple[Scalar, ...]) -> tuple[float, ...]:
    """At the tree's state and accelerations."""
    symbols = system.symbols
    known = {symbols.t: tree.t} | {s: tree.number(s.name) for s in symbols.parameters.values()}
    known |= {s: tree.q.get(s.name, 0.0) for s in symbols.q} | {s: tree.u[s.name[:-1]] for s in symbols.u}
    known |= {s: tree.number(s.name) for s in symbols.inputs.values()}
    known |= dict(zip(symbols.a, tree.balance.accelerations, strict=True))
    return evaluate(scalars, known, FLOAT)


def compared(text: str, seed: int, t: float = 0.0, derived: str = "") -> tuple[int, int]:
    """Compares every component of every reaction; (how many, of them how many are indeterminate).

    Args:
        derived: the text that is derived, the same but for its parameters' values.
    """
    tree, system = state(text, seed, t), System.of(eomgen.loads(derived or text))
    size = max(1.0, float(np.max(np.abs(tree.balance.right))))
    assert tree.balance.residual < 1e-8 * size, "the reference itself is in balance"
    reactions = Reactions.of(system)
    along = (0, 1) if tree.plane else (0, 1, 2)
    many = unknown = 0
    for owner in dict.fromkeys(c.owner for c in reactions.components):
        joint = owner in tree.names
        parts = [("force", k) for k in along] + [("couple", k) for k in ((2,) if tree.plane else along) if joint]
        for what, k in parts:
            expected = tree.reaction(owner, what, k)
            many += 1
            try:
                (found,) = values(tree, system, (reactions.component(what, k, owner),))
            except Indeterminate:
                assert expected is None, f"{what} {k} of {owner} has one value, {expected}\n{text}"
                unknown += 1
                continue
            assert expected is not None, f"{what} {k} of {owner} is indeterminate\n{text}"
            close = abs(found - expected) < 1e-8 * max(size, abs(expected))
            assert close, f"{what} {k} of {owner}: {found}, not {expected}\n{text}"
    return many, unknown


SEAT = re.compile(r'on = "[^"]+", at = \[[^]]*\]|on = "[^"]+"|at = \[[^]]*\]')


def given_way(text: str, body: str, moves: str) -> str:
    """The model with a massless body between `body` and its seat, which lets it move with the coordinate d."""
    head, joint = text.split(f"[bodies.{body}]")[0], text.split(f"[bodies.{body}]")[1].split("joint = ")[1]
    found = SEAT.search(joint.split("\n")[0])
    assert found is not None, "every joint is seated somewhere"
    between = f"[bodies.between]\njoint = {{ {moves}, {found[0]} }}\n"
    rest = text[len(head) :].replace(found[0], 'on = "between"', 1)
    return head.replace("[coordinates]", '[coordinates]\nd = { motion = "0" }', 1) + between + rest


def held_joints(tree: Tree) -> list[str]:
    """Bodies whose joint is a hinge or rigid."""
    return [body for body in tree.names if tree.table["bodies"][body]["joint"]["kind"] in ("revolute", "fixed")]


@pytest.mark.parametrize("seed", usual(range(12), 4))
@pytest.mark.parametrize("space", ["plane", "space"])
def test_a_joint_that_gives_way_is_held_by_its_reaction(space, seed):
    """Virtual work: with d freed, Q_d = drive(d) keeps d = 0; by Lagrange it is the reaction along d."""
    seed += 3000
    while not held_joints(tree := state(held_model(space, seed), seed, 0.8)):
        seed += 1000
    text, rng = held_model(space, seed), Random(seed)
    body = rng.choice(held_joints(tree))
    R = tree.parent(tree.names.index(body)).R
    e = np.array(rng.choice([[1, 0, 0], [0, 1, 0]] + [[0, 0, 1]] * (space == "space")))
    along = f"axis = {[int(x) for x in e][: 2 if space == 'plane' else 3]}"
    turn = 'kind = "revolute", angle = "d"'
    for what, moves, way in [
        ("force", f'kind = "prismatic", displacement = "d", {along}', e),
        ("couple", turn if space == "plane" else f"{turn}, {along}", e if space == "space" else np.array([0, 0, 1])),
    ]:
        system = System.of(eomgen.loads(given_way(text, body, moves)))
        (found,) = values(tree, system, (DrivingForces(system).along("d"),))
        expected = sum((R @ way)[k] * tree.reaction(body, what, k) for k in range(3) if tree.carried(what, k))
        assert abs(found - expected) < 1e-8 * max(1.0, abs(expected)), f"{what} of {body} along {way}\n{text}"


@pytest.mark.parametrize("seed", usual(range(12), 4))
@pytest.mark.parametrize("space", ["plane", "space"])
def test_joints_of_random_trees_carry_what_newton_says(space, seed):
    """Inertia = applied + reactions, for each body; driven joints and rheonomic trees included."""
    _, unknown = compared(held_model(space, seed), seed, t=0.8)
    assert not unknown


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("space", ["plane", "space"])
def test_reactions_hold_for_other_parameters_than_those_of_the_file(space, seed):
    """Nothing is left out because it vanishes for the values in the file, or where given motions begin."""
    text = held_model(space, 100 + seed)
    zero = re.sub(r"^(h|A|c) = .*$", r"\1 = 0", text, flags=re.MULTILINE)
    compared(text, seed, t=0.8, derived=zero)


@pytest.mark.parametrize("seed", usual(range(12), 4))
@pytest.mark.parametrize("space", ["plane", "space"])
def test_joints_and_ties_of_random_loops_carry_what_newton_says(space, seed):
    """The same with a constraint that closes a loop or only reacts."""
    compared(closed_model(space, 500 + seed, constraints=1, spare=3), seed)


@pytest.mark.parametrize("seed", usual(range(12), 4))
@pytest.mark.parametrize("space", ["plane", "space"])
def test_what_redundant_ties_leave_open_is_what_the_null_space_touches(space, seed):
    """Three constraints on few degrees of freedom: what the balance determines agrees, the rest is reported
    indeterminate."""
    compared(closed_model(space, 900 + seed, constraints=3, spare=0), seed)
