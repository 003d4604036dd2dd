"""System, what else reacts -> Components: the wrenches that hold bodies which are placed by given motions.

What is `placed` is geometry: where its places hold free coordinates alone, ties that are named hold it. Where they move
with time, something moves it as given. That is a wrench which does no work along any free coordinate q,

    w = sum c_k d_k,   d_k the wrench that does work on the variable s_k alone,   sum c_k ds_k/dq = 0

and of these only those are unknown that no other reaction can make up for. A body of which all variables are given,
and that nothing else holds, takes any force and any couple: its reaction in its place. What hangs on it then reacts as
on a base that moves.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from eomgen.mechanics.balance.components import EACH_AXIS, Component, is_idle
from eomgen.mechanics.balance.unit_wrenches import Axes, Effect, effects_at_joint, scaled_axes
from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.constraints.closure import generic_state
from eomgen.mechanics.constraints.ways_of_bodies import is_placed
from eomgen.mechanics.equations.system import System
from eomgen.model.driven import driven_coordinates
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, derivative
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import SparseRow, State
from eomgen.symbolic.expression.spatial import ZERO, Vector, in_turned_axes, plus, transposed
from eomgen.symbolic.numeric.dense import rank
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits, floats_of
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY

WayWithSlopes = tuple[SparseRow, list[Scalar]]  # a way, and its slopes along the free coordinates


def placements_of(system: System, axes: Axes, others: Sequence[Component]) -> tuple[Component, ...]:
    """Those of every body that is placed by a given motion.

    Args:
        others: the reactions of all joints and ties.
    Raises:
        MissingValues, DerivationError: the ties do not close near the start.
    """
    given = {link.name: ways for link in axes.motion.links if (ways := _without_work(system, link))}
    if not given:
        return ()
    numbers = _Numbers(axes, generic_state(system.ties))
    held = numbers.columns([(*c.effects, *c.friction_effects) for c in others])
    found: list[Component] = []
    for name, ways in given.items():
        found += _of_body(system, axes.motion.link(name), ways, numbers, held)
    return tuple(found)


def _without_work(system: System, link: BodyLink) -> list[SparseRow]:
    """The {k: c_k} that do no work along any free coordinate, of a body that is placed and that time moves; else none.

    They are eliminated by slopes that are numbers: what other slopes would say of a variable is left out.
    """
    if link.joint is None or not is_placed(link):
        return []
    driven, symbols = driven_coordinates(system.scope.model), system.symbols
    clocks = (symbols.t, *(q for q in symbols.q if q.name in driven))
    if not any(depends_on(s, clocks) for s in link.s):
        return []
    free = [q for q in symbols.q if q.name not in driven]
    left: list[WayWithSlopes] = [({k: 1}, [derivative(s, q) for q in free]) for k, s in enumerate(link.s)]
    for j in range(len(free)):
        pivot = next((row for row in left if type(row[1][j]) is not Node and row[1][j] != 0), None)
        if pivot is not None:
            left = [_less(row, over(row[1][j], pivot[1][j]), pivot) for row in left if row is not pivot]
    return [way for way, slopes in left if all(is_zero(x) for x in slopes)]


def _less(row: WayWithSlopes, factor: Scalar, other: WayWithSlopes) -> WayWithSlopes:
    """A row less so many times the other."""
    if is_zero(factor):
        return row
    way = dict(row[0])
    for k, x in other[0].items():
        way[k] = way.get(k, 0) - factor * x
    return way, [x - factor * y for x, y in zip(row[1], other[1], strict=True)]


@dataclass(frozen=True)
class _Numbers:
    """What forces and couples do to the bodies at a state: rows of the balance."""

    axes: Axes
    state: State

    def columns(self, effects: Sequence[Sequence[Effect]]) -> np.ndarray:
        """Force, and moment about the mass centre, on every body, of each of these, rows x columns."""
        rows, several = self.axes.rows, [(j, e) for j, each in enumerate(effects) for e in each]
        flat = tuple(e.six[d] for _, e in several for d in rows)
        values = iter(floats_of(evaluate(flat, self.state, fifty_digits())))
        found = np.zeros((len(rows) * len(self.axes.motion.links), len(effects)))
        for j, e in several:
            for n in range(len(rows)):
                found[len(rows) * e.link + n, j] += next(values)
        return found

    def more(self, held: np.ndarray, effects: Sequence[Sequence[Effect]]) -> int:
        """By how much these raise the rank of what holds the bodies."""
        return _rank(np.hstack([held, self.columns(effects)])) - _rank(held)


def _rank(columns: np.ndarray) -> int:
    return rank(columns, smallest=RANK_NEARBY)


def _of_body(
    system: System, link: BodyLink, ways: Sequence[SparseRow], numbers: _Numbers, held: np.ndarray
) -> Iterator[Component]:
    axes = numbers.axes
    if len(ways) == len(link.s):
        wrench = list(_any_wrench(system, axes, link))
        effects = [effects_at_joint(axes, link, force, couple) for _, force, couple in wrench]
        if numbers.more(held, effects) == len(wrench):
            yield from _components(link, [label for label, _, _ in wrench], effects)
            return
    needed = [effects for effects in (_along(axes, link, way) for way in ways) if numbers.more(held, [effects])]
    yield from _components(link, [f"wrench {k}" for k in range(1, len(needed) + 1)], needed)


def _along(axes: Axes, link: BodyLink, way: SparseRow) -> list[Effect]:
    """Of the wrench sum c_k d_k."""
    force, couple = ZERO, ZERO
    for k, c in way.items():
        f, n = scaled_axes(axes, link.name, k, c)
        force, couple = plus(force, f), plus(couple, n)
    return effects_at_joint(axes, link, force, couple)


def _components(link: BodyLink, labels: Sequence[str], effects: Sequence[Sequence[Effect]]) -> Iterator[Component]:
    for number, (label, own) in enumerate(zip(labels, effects, strict=True), start=1):
        yield Component(link.name, "joint", label, number, tuple(own))


def _any_wrench(system: System, axes: Axes, link: BodyLink) -> Iterator[tuple[str, Vector, Vector]]:
    """(label, force, couple) along the axes of the body's equations, child's axes."""
    R_CE = transposed(axes.of_body(link))
    for k in range(2 if axes.plane else 3):
        yield "xyz"[k], in_turned_axes(R_CE, EACH_AXIS[k]), ZERO
    if not axes.plane:
        yield from ((f"couple {axis}", ZERO, e) for axis, e in zip("xyz", EACH_AXIS, strict=True))
    elif not is_idle(axes, link, system):
        yield "couple", ZERO, EACH_AXIS[2]
