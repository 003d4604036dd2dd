"""Steady motions near the start, and the family that one belongs to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import nearest_root
from eomgen.mechanics.equilibrium import StaticEquations, places_of_rest
from eomgen.mechanics.kinematics import Located
from eomgen.mechanics.linearization.reduction import LinearEquations, Reducing, dependent_speeds, floats, unsettled
from eomgen.mechanics.linearization.reference import Choice, Family, FirstOrder, ReferenceMotion, choice_of
from eomgen.mechanics.state import Exact, Numbers, Split
from eomgen.symbolic.exact import simplest, vanishes
from eomgen.symbolic.expression import Node, Scalar, State, depends_on, is_zero, operations, substituted
from eomgen.symbolic.numeric import Newton, NoValue, Work, evaluate, fifty_digits, tolerances
from eomgen.symbolic.print import text_size

# -------- steady ----------------------------------------------------------------------------------------------
# Reference near the start -> the speeds and places of a steady motion, by Newton's method.
#
# A motion is steady where the independent speeds stay and the coordinates on which anything depends stand still:
#
#     Z^T (M a - forcing) = 0  at  a_i = 0,      q_k' = 0, z_k' = 0 of what is seen in K or F
#
# States of first order are sought with them: those on which nothing depends, as a worn volume, may grow.
#
# Steady motions come in families (a top precesses at many angles). What the model states at the start is held where
# that leaves enough to move: `start` of a coordinate without `near`, `speed` of a coordinate without `near`.


STEADILY = Newton(still=tolerances.SUMMED, steps=40, smallest=tolerances.RANK, double=0.02, longest=0.3)
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
    if not choice.speeds.free:
        what = "the constraints leave no motion free, so none is steady"
        raise DerivationError(what, "linearize.about", 'leave a degree of freedom, or set about = "equilibrium"')
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
    values = {x.name: float(state[x]) for x in symbols.x}
    independent = (*_places(first, choice), *(symbols.u[k] for k in choice.speeds.free))
    return Steady(
        {name: 0.0 if abs(x) < tolerances.COORDINATE_AT_50 else x for name, x in values.items()},
        tuple(x for x, one in zip(independent, changed, strict=True) if one),
    )


def _places(first: FirstOrder, choice: Choice) -> tuple[Node, ...]:
    """The independent coordinates, and the states of first order."""
    symbols = first.system.symbols
    return (*(symbols.q[k] for k in choice.places.free), *symbols.z)


def _free(first: FirstOrder, choice: Choice) -> np.ndarray:
    """Rank of each independent coordinate, state and speed: how freely it may change, unstated ones before guesses."""
    symbols, model = first.system.symbols, first.system.scope.model
    places = [model.coordinates[symbols.q[k].name] for k in choice.places.free]
    found = [STATED if part.driven else _freedom(part.start, part.near) for part in places]
    found += [OPEN] * len(symbols.z)  # from where a state starts says nothing of the motion into which it settles
    for name in (symbols.u[k].name for k in choice.speeds.free):
        part = model.coordinates.get(name.removesuffix("'"))
        found.append(_freedom(model.speeds[name].start, None) if part is None else _freedom(part.speed, part.near))
    return np.array(found)


def _freedom(stated: object, near: object) -> int:
    return GUESSED if near is not None else STATED if stated is not None else OPEN


def _needed(here: Here, free: np.ndarray) -> np.ndarray:
    """Mask of the independent variables that suffice to solve the equations: the freest, none below STATED."""
    scaled = here.slopes * here.sizes / here.row_sizes[:, None]
    allowed = np.flatnonzero(free >= STATED)
    columns = Split.of(scaled[:, allowed], [int(free[k]) for k in allowed]).following
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
    """Residuals that are to vanish as functions of the variables in the mask; rows and columns free of units."""

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

    @property
    def equations(self) -> LinearEquations:
        return self.reducing.equations

    @cached_property
    def still(self) -> list[int]:
        """The independent coordinates and states that must not move: those seen in K, states seen in rates of states,
        and those on which their rates depend."""
        K, F = self._seen
        found: set[int] = set()
        seen = {int(j) for j in np.flatnonzero(np.any(K, axis=0))}
        n = len(self.choice.places.free)
        seen |= {n + int(j) for j in np.flatnonzero(np.any(F[n:, n:], axis=0))}
        while seen - found:
            found |= seen
            seen = {int(j) for j in np.flatnonzero(np.any(F[sorted(found)], axis=0))}
        return sorted(found)

    @property
    def _seen(self) -> tuple[np.ndarray, np.ndarray]:
        """Masks of the entries of K and F above rounding errors, compared with C w, M w^2 and E w of the fastest w."""
        e = self.equations
        w = max(abs(float(self.state[u])) for u in e.speeds)
        M, C, K, F, E = (abs(floats(x)) for x in (e.M, e.C, e.K, e.F, e.E))
        sizes = (max(K.max(), C.max() * w, M.max() * w * w), max(F.max(), E.max() * w))
        return K > tolerances.COMPUTED * sizes[0], F > tolerances.COMPUTED * sizes[1]

    @cached_property
    def rates(self) -> np.ndarray:
        """q_i' of the independent coordinates, and z'."""
        scope = self.first.system.scope
        a = dict(zip(scope.symbols.a, map(fifty_digits().number, self.reducing.at.a), strict=True))
        found = evaluate((*scope.rates, *scope.state_rates), {**self.state, **a}, fifty_digits())
        return np.array([float(found[k]) for k in (*self.choice.places.free, *range(len(scope.rates), len(found)))])

    @property
    def residuals(self) -> np.ndarray:
        return np.array([*map(float, self.reducing.at.unbalanced), *self.rates[self.still]])

    @property
    def slopes(self) -> np.ndarray:
        """Their derivatives by (q_i, z, u_i) along the constraints."""
        e = self.equations
        upper = np.hstack([floats(e.K), floats(e.C)])
        return np.vstack([upper, np.hstack([floats(e.F), floats(e.E)])[self.still]])

    @property
    def row_sizes(self) -> np.ndarray:
        """The largest of each row of the slopes; of one in which nothing but rounding is, what inertia makes."""
        w = self.sizes[-1]
        inertia = np.append(abs(floats(self.equations.M)).max(axis=1) * w * w, np.ones(len(self.still)))
        largest = (abs(self.slopes) * self.sizes).max(axis=1)
        return np.asarray(np.maximum(largest, tolerances.COMPUTED * inertia))

    @property
    def sizes(self) -> np.ndarray:
        """Unit of change of each variable: of a coordinate max(1, |q|), of a speed the fastest speed, at least 1; of a
        state its own size, or that with which all their rates would vanish beside everything else as it is."""
        symbols = self.first.system.symbols
        places = [max(1.0, abs(float(self.state[x]))) for x in _places(self.first, self.choice)]
        if m := len(symbols.z):
            n = len(places) - m
            settled = np.linalg.lstsq(floats(self.equations.F)[n:, n:], -self.rates[n:], rcond=tolerances.RANK)[0]
            places[n:] = np.maximum(places[n:], abs(settled)).tolist()
        speeds = [abs(float(self.state[symbols.u[k]])) for k in self.choice.speeds.free]
        return np.array(places + [max(1.0, *speeds, 0.0)] * len(self.choice.speeds.free))

    @property
    def is_balanced(self) -> bool:
        moving = abs(self.rates[self.still])
        return not unsettled(self.reducing, tolerances.ITERATED) and bool(
            np.all(moving <= tolerances.ITERATED * max(1.0, *abs(self.rates)))
        )

    def moved(self, step: np.ndarray) -> Here:
        """The state after a step of the independent variables, the dependent ones following.

        Raises:
            NoValue: the constraints cannot be satisfied there.
        """
        symbols, number = self.first.system.symbols, fifty_digits().number(1)
        n = len(self.equations.coordinates)
        dq = floats(self.equations.P) @ step[:n]
        state = {**self.state, **{q: self.state[q] + number * d for q, d in zip(self.equations.all, dq, strict=True)}}
        state |= {
            symbols.u[k]: state[symbols.u[k]] + number * d
            for k, d in zip(self.choice.speeds.free, step[n:], strict=True)
        }
        moved = self.first.system.constraints.movable
        following = [q for q in (symbols.q[k] for k in self.choice.places.following) if q in moved]
        found = nearest_root(self.first.relations, state, following) if following else state
        if found is None:
            raise NoValue("the constraints cannot be satisfied")
        return self.at(self.first, self.choice, self._with_speeds(found))

    def _with_speeds(self, state: State) -> State:
        """The dependent speeds by J u + sigma = 0."""
        number = fifty_digits().number(1)
        speeds = dependent_speeds(self.first, self.choice, Numbers(state))
        return {**state, **{u: number * x for u, x in speeds.items()}}


# -------- steady family ---------------------------------------------------------------------------------------
# A steady motion in numbers -> the family that it belongs to: its conditions, and what follows from what is held.
#
# The equations of a steady motion, with the coordinates and speeds that say which one it is as symbols, are
#
#     Z^T (M a - forcing) = 0  at  a_i = 0,   phi = 0,   q_k' = 0 of the coordinates that are seen
#
# multipliers, dependent speeds and accelerations eliminated, which stand in them linearly.


MOST_OPERATIONS = 600  # of the equations of motion that are written as conditions
MOST_OF_CONSTRAINTS = 250  # of the rows by which speeds are eliminated
MOST_FOLLOWING = 4  # dependent coordinates and speeds
LONGEST = 1_200  # characters of conditions that are solved
MOST_SOUGHT = 2  # unknowns of which all values are sought


def family_of(
    first: FirstOrder, reference: ReferenceMotion, wanted: Sequence[str], following: Sequence[Node]
) -> Family | None:
    """The family of a steady motion; None where its conditions are too long to be written.

    Args:
        reference: the motion in numbers, what is held of the start exact.
        wanted: coordinates that are to stay independent.
        following: independent coordinates and speeds that are not held.
    """
    choice = choice_of(first, reference, wanted)
    if not _is_small(first, choice):
        return None
    try:
        return _Writing(first, reference, choice, tuple(following)).family()
    except (DerivationError, NoValue, ZeroDivisionError):  # too large, or a pivot that is 0 as a formula
        return None


def _is_small(first: FirstOrder, choice: Choice) -> bool:
    """True if the conditions are small enough to be written in a second or two."""
    driven = sum(part.driven for part in first.system.scope.model.coordinates.values())
    following = len(choice.places.following) - driven + len(choice.speeds.following)
    if following > MOST_FOLLOWING or operations(first.residual).total > MOST_OPERATIONS:
        return False
    rows = [x for i in choice.speeds.rows for x in (*first.equations.J[i], first.equations.gamma[i])]
    return operations(rows).total <= MOST_OF_CONSTRAINTS


@dataclass(frozen=True)
class _Writing:
    """The conditions, and what they say.

    Args:
        first: the equations of motion.
        reference: the motion in numbers.
        choice: what stays independent there.
        moved: independent coordinates and speeds that are not held.
    """

    first: FirstOrder
    reference: ReferenceMotion
    choice: Choice
    moved: tuple[Node, ...]

    def family(self) -> Family | None:
        if self._fixed is None:
            return None
        held = tuple(x for x in self._independent if x not in self._unknowns and _any_depends(self._conditions, x))
        formulas = self._solved(self._conditions)
        family = Family(held, self._unknowns, self._conditions, formulas, self._state(held, formulas), self._zeros)
        return self._with_others(family)

    @property
    def _independent(self) -> tuple[Node, ...]:
        u = self.first.system.symbols.u
        return (*_places(self.first, self.choice), *(u[k] for k in self.choice.speeds.free))

    @cached_property
    def _seen(self) -> tuple[Node, ...]:
        """The independent coordinates that stand still."""
        places, here = _places(self.first, self.choice), Here.at(self.first, self.choice, self.reference.numbers)
        return tuple(places[j] for j in here.still)

    @property
    def _following(self) -> tuple[Node, ...]:
        """Dependent coordinates that are not driven."""
        symbols, coordinates = self.first.system.symbols, self.first.system.scope.model.coordinates
        return tuple(q for k in self.choice.places.following if not coordinates[(q := symbols.q[k]).name].driven)

    @property
    def _fixed(self) -> State | None:
        """Exact values that need not be sought: coordinates on which nothing depends, drives, inputs, zero speeds.

        None where the start does not give them exactly.
        """
        symbols, exact, numbers = self.first.system.symbols, self.reference.exact, self.reference.numbers
        still = {u: 0 for u in self._independent if u in symbols.u and numbers[u] == 0}
        sought = {*self._seen, *self._following, *symbols.u}
        others = [x for x in (*symbols.places, symbols.t, *symbols.inputs.values()) if x not in sought]
        if any(x not in exact for x in others):
            return None
        fixed = {x: exact[x] for x in others} | still
        return fixed | dependent_speeds(self.first, self.choice, self._at(fixed))

    def _at(self, state: State) -> Exact:
        return Exact(state, self.first.system.scope.positive, self.reference.numbers)

    @property
    def _unknowns(self) -> tuple[Node, ...]:
        fixed = self._fixed or {}
        return (*(x for x in self.moved if x not in fixed), *self._following)

    @property
    def _zeros(self) -> tuple[Node, ...]:
        """Held coordinates that are 0, if there are more conditions than unknowns: by symmetry they satisfy some."""
        if len(self._all) <= len(self._unknowns):
            return ()
        exact = self.reference.exact
        held = (x for x in self._independent if x not in self._unknowns and _any_depends(self._all, x))
        return tuple(x for x in held if x in exact and is_zero(exact[x]))

    @cached_property
    def _conditions(self) -> tuple[Scalar, ...]:
        """Expressions that vanish, with the zeros put in; those that are then identically 0 are left out."""
        if not self._zeros:
            return self._all
        left = substituted(self._all, dict.fromkeys(self._zeros, 0))
        positive = self.first.system.scope.positive
        return tuple(simplest(x, Work.VALUE, positive) for x in left if not is_zero(x) and not vanishes(x))

    @property
    def _all(self) -> tuple[Scalar, ...]:
        """Expressions that vanish in a steady motion: unbalanced forces, rates and relations."""
        first, choice = self.first, self.choice
        field = self._at(self._fixed or {})
        at, scope = Reducing(first, choice, field).at, first.system.scope
        by_place = dict(zip(scope.symbols.places, (*scope.rates, *scope.state_rates), strict=True))
        rates = [by_place[x] for x in self._seen]
        relations = [first.relations[i] for i in choice.places.rows if i < len(first.relations)]
        moving = field.with_values(dict(zip(scope.symbols.a, at.a, strict=True)))
        left = (*at.unbalanced, *moving.of((*rates, *relations)))
        return tuple(x for x in left if not is_zero(x))

    @property
    def _located(self) -> Located:
        numbers = {x: float(v) for x, v in self.reference.numbers.items()}
        return Located(numbers, self.first.system.scope.positive)

    def _solved(self, conditions: Sequence[Scalar], located: Located | None = None) -> State:
        """The unknowns in closed form; {} where there is none."""
        if sum(map(text_size, conditions)) > LONGEST:
            return {}
        try:
            found = (located or self._located).places(conditions, self._unknowns)
            left = substituted(tuple(conditions), found)
        except (DerivationError, NoValue, ZeroDivisionError):
            return {}
        return found if len(found) == len(self._unknowns) and all(map(vanishes, left)) else {}

    def _state(self, held: Sequence[Node], formulas: State) -> State:
        """Everything at the start's values of what is held; {} where that is not known in closed form."""
        exact, symbols = self.reference.exact, self.first.system.symbols
        if any(x not in exact for x in held) or self._fixed is None:
            return {}
        start = {x: exact[x] for x in self._independent if x in exact and x not in self._unknowns}
        found = formulas or self._solved(substituted(self._conditions, start))
        if not found:
            return {}
        at = start | dict(zip(found, substituted(tuple(found.values()), start), strict=True))
        whole = {**at, **dict(zip(self._fixed, substituted(tuple(self._fixed.values()), at), strict=True))}
        positive = self.first.system.scope.positive
        state = {x: simplest(whole[x], Work.VALUE, positive) for x in symbols.x if x in whole}
        return state if all(self._located.agrees(value, x) for x, value in state.items()) else {}

    def _with_others(self, family: Family) -> Family:
        """The family with every other motion found that has the same values held."""
        unknowns, conditions = self._unknowns, self._conditions
        states = not {*unknowns}.isdisjoint(self.first.system.symbols.z)  # no range is known in which they all lie
        if states or not unknowns or len(unknowns) != len(conditions) or len(unknowns) > MOST_SOUGHT:
            return family
        numbers = self.reference.numbers
        sought = StaticEquations(
            system=self.first.system, held=(), q=unknowns, given={}, Q=conditions, unbalanced=(), J=(), lam=(), phi=()
        )
        at = np.array([float(numbers[x]) for x in unknowns])
        places = places_of_rest(sought, {x: v for x, v in numbers.items() if x not in unknowns}, at)
        others = tuple(
            {x: float(v) if abs(v) > tolerances.BEST else 0.0 for x, v in zip(unknowns, z, strict=True)}
            for z in places.found
        )
        closed = tuple(self._solved(conditions, self._beside(at)) for at in others)
        return replace(family, others=others, closed=closed, complete=places.complete, where=places.where)

    def _beside(self, at: Mapping[Node, float]) -> Located:
        return Located({**self._located.numbers, **at}, self._located.positive)


def _any_depends(scalars: Sequence[Scalar], x: Node) -> bool:
    return any(depends_on(each, (x,)) for each in scalars)
