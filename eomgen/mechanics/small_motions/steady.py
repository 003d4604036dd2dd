"""Reference near the start -> the speeds and places of a steady motion, by Newton's method.

A motion is steady where the independent speeds stay and the coordinates on which anything depends stand still:

    Z^T (M a - forcing) = 0  at  a_i = 0,      q_k' = 0 of the coordinates that are seen in K or F

Steady motions come in families (a top precesses at many angles). What the model states at the start is held where that
leaves enough to move: `start` of a coordinate without `near`, `speed` of a coordinate without `near`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.constraints.closure import movable, nearest_root
from eomgen.mechanics.small_motions.field import Numbers
from eomgen.mechanics.small_motions.first_order import Choice, FirstOrder, choice_of, determined
from eomgen.mechanics.small_motions.forms import floats
from eomgen.mechanics.small_motions.reduction import LinearEquations, Reducing, dependent_speeds, unsettled
from eomgen.mechanics.small_motions.reference import ReferenceMotion
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.newton import Newton
from eomgen.symbolic.numeric.tolerances import COMPUTED, COORDINATE_AT_50, ITERATED, RANK, SUMMED

STEADILY = Newton(still=SUMMED, steps=40, smallest=RANK, double=0.02, longest=0.3)
STATED, GUESSED, OPEN = 0, 1, 2  # by the model: held, marked by `near`, not said


@dataclass(frozen=True)
class Steady:
    """A steady motion in numbers.

    Args:
        values: coordinates and speeds by name.
        following: independent coordinates and speeds that were changed to reach it; the others say which motion it is.
    """

    values: dict[str, float]
    following: tuple[Node, ...]


def steady_start(first: FirstOrder, reference: ReferenceMotion, wanted: Sequence[str] = ()) -> Steady:
    """The steady motion nearest to the start.

    Args:
        reference: the start.
        wanted: coordinates that are to stay independent.
    Raises:
        DerivationError: none was found near the start.
    """
    choice = choice_of(first, reference, wanted)
    if not choice.u:
        what = "the ties leave no motion free, so none is steady"
        raise DerivationError(what, "linearize.about", 'leave a freedom, or ask about = "equilibrium"')
    free = _free(first, choice)
    for mask in (free > STATED, np.ones(len(free), dtype=bool)):
        found = _sought(first, choice, reference.numbers, mask) if np.any(mask) else None
        if found is not None:
            fewer = _needed(Here.at(first, choice, found), np.where(mask, free, -1))
            alone = _sought(first, choice, reference.numbers, fewer)
            return _steady(first, choice, found if alone is None else alone, fewer)
    raise DerivationError(
        "no steady motion was found near the start",
        "linearize.about",
        "start nearer to one; `near` marks what may change, with its speed",
    )


def _steady(first: FirstOrder, choice: Choice, state: Mapping[Node, Any], changed: np.ndarray) -> Steady:
    symbols = first.system.symbols
    values = {x.name: float(state[x]) for x in (*symbols.q, *symbols.u)}
    independent = (*(symbols.q[k] for k in choice.q), *(symbols.u[k] for k in choice.u))
    return Steady(
        {name: 0.0 if abs(x) < COORDINATE_AT_50 else x for name, x in values.items()},
        tuple(x for x, one in zip(independent, changed, strict=True) if one),
    )


def _free(first: FirstOrder, choice: Choice) -> np.ndarray:
    """Of the independent coordinates and speeds, how freely they may change: what nobody states before guesses."""
    symbols, model = first.system.symbols, first.system.scope.model
    places = [model.coordinates[symbols.q[k].name] for k in choice.q]
    found = [STATED if part.driven else _freedom(part.start, part.near) for part in places]
    for name in (symbols.u[k].name for k in choice.u):
        part = model.coordinates.get(name.removesuffix("'"))
        found.append(_freedom(model.speeds[name].start, None) if part is None else _freedom(part.speed, part.near))
    return np.array(found)


def _freedom(stated: object, near: object) -> int:
    return GUESSED if near is not None else STATED if stated is not None else OPEN


def _needed(here: Here, free: np.ndarray) -> np.ndarray:
    """Which of the independent ones suffice for the equations: the freest; none of those below STATED."""
    scaled = here.slopes * here.sizes / here.row_sizes[:, None]
    allowed = np.flatnonzero(free >= STATED)
    _, columns = determined(scaled[:, allowed], [(int(free[k]), 0.0) for k in allowed])
    needed = np.zeros(len(free), dtype=bool)
    needed[allowed[list(columns)]] = True
    return needed


def _sought(first: FirstOrder, choice: Choice, start: Mapping[Node, Any], mask: np.ndarray) -> State | None:
    """The state with all residuals zero, by steps of least size in what the mask frees; None where none is near."""
    try:
        found = STEADILY.root(_Residuals(mask), Here.at(first, choice, start))
        return dict(found.x.state) if found.met and found.x.is_balanced else None
    except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
        return None


@dataclass(frozen=True)
class _Residuals:
    """What is to vanish, rows and columns free of units, by what the mask frees."""

    mask: np.ndarray

    def left(self, here: Here) -> np.ndarray:
        return np.asarray(here.residuals / here.row_sizes)

    def slopes(self, here: Here) -> np.ndarray:
        return np.asarray(here.slopes[:, self.mask] * here.sizes[self.mask] / here.row_sizes[:, None])

    def moved(self, here: Here, step: Sequence[float]) -> Here:
        whole = np.zeros(len(self.mask))
        whole[self.mask] = here.sizes[self.mask] * np.array(step)
        return here.moved(whole)


@dataclass(frozen=True)
class Here:
    """One state of the search."""

    first: FirstOrder
    choice: Choice
    reducing: Reducing

    @classmethod
    def at(cls, first: FirstOrder, choice: Choice, state: Mapping[Node, Any]) -> Here:
        return cls(first, choice, Reducing(first, choice, Numbers(state)))

    @property
    def state(self) -> Mapping[Node, Any]:
        field = self.reducing.field
        assert isinstance(field, Numbers)
        return field.state

    @cached_property
    def equations(self) -> LinearEquations:
        return self.reducing.equations

    @cached_property
    def still(self) -> list[int]:
        """The independent coordinates that must not move: those seen in K, and those on which their rates depend."""
        K, F = self._seen
        found: set[int] = set()
        seen = {int(j) for j in np.flatnonzero(np.any(K, axis=0))}
        while seen - found:
            found |= seen
            seen = {int(j) for j in np.flatnonzero(np.any(F[sorted(found)], axis=0))}
        return sorted(found)

    @property
    def _seen(self) -> tuple[np.ndarray, np.ndarray]:
        """Where entries of K and F are more than rounding, beside C w, M w^2 and E w of the fastest speed w."""
        e = self.equations
        w = max(abs(float(self.state[u])) for u in e.speeds)
        M, C, K, F, E = (abs(floats(x)) for x in (e.M, e.C, e.K, e.F, e.E))
        sizes = (max(K.max(), C.max() * w, M.max() * w * w), max(F.max(), E.max() * w))
        return K > COMPUTED * sizes[0], F > COMPUTED * sizes[1]

    @cached_property
    def rates(self) -> np.ndarray:
        """q_i' of the independent coordinates."""
        found = evaluate(self.first.system.scope.rates, self.state, fifty_digits())
        return np.array([float(found[k]) for k in self.choice.q])

    @property
    def residuals(self) -> np.ndarray:
        return np.array([*map(float, self.reducing.unbalanced), *self.rates[self.still]])

    @property
    def slopes(self) -> np.ndarray:
        """Their derivatives by (q_i, u_i) along the ties."""
        e = self.equations
        upper = np.hstack([floats(e.K), floats(e.C)])
        return np.vstack([upper, np.hstack([floats(e.F), floats(e.E)])[self.still]])

    @property
    def row_sizes(self) -> np.ndarray:
        """The largest of each row of the slopes; of one in which nothing but rounding is, what inertia makes."""
        w = self.sizes[-1]
        inertia = np.append(abs(floats(self.equations.M)).max(axis=1) * w * w, np.ones(len(self.still)))
        largest = (abs(self.slopes) * self.sizes).max(axis=1)
        return np.asarray(np.maximum(largest, COMPUTED * inertia))

    @property
    def sizes(self) -> np.ndarray:
        """What counts as a change of 1: of a coordinate itself, if it is more; the speeds by how fast it moves."""
        symbols = self.first.system.symbols
        places = [max(1.0, abs(float(self.state[symbols.q[k]]))) for k in self.choice.q]
        speeds = [abs(float(self.state[symbols.u[k]])) for k in self.choice.u]
        return np.array(places + [max(1.0, *speeds, 0.0)] * len(self.choice.u))

    @property
    def is_balanced(self) -> bool:
        moving = abs(self.rates[self.still])
        return not unsettled(self.reducing, ITERATED) and bool(np.all(moving <= ITERATED * max(1.0, *abs(self.rates))))

    def moved(self, step: np.ndarray) -> Here:
        """After a step of the independent ones, the others following.

        Raises:
            NoValue: the ties do not close there.
        """
        symbols, number = self.first.system.symbols, fifty_digits().number(1)
        n = len(self.choice.q)
        dq = floats(self.equations.P) @ step[:n]
        state = {**self.state, **{q: self.state[q] + number * d for q, d in zip(symbols.q, dq, strict=True)}}
        state |= {symbols.u[k]: state[symbols.u[k]] + number * d for k, d in zip(self.choice.u, step[n:], strict=True)}
        moved = movable(self.first.system.ties)
        following = [q for q in (symbols.q[k] for k in self.choice.dq) if q in moved]
        found = nearest_root(self.first.relations, state, following) if following else state
        if found is None:
            raise NoValue("the ties do not close")
        return self.at(self.first, self.choice, self._with_speeds(found))

    def _with_speeds(self, state: State) -> State:
        """The dependent speeds by J u + sigma = 0."""
        number = fifty_digits().number(1)
        speeds = dependent_speeds(self.first, self.choice, Numbers(state))
        return {**state, **{u: number * x for u, x in speeds.items()}}
