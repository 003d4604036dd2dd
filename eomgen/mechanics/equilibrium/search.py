"""System -> its equilibria: every place at which all forces balance."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure, Constraints, Row
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.equilibrium.equations import StaticEquations
from eomgen.mechanics.equilibrium.places import ANYWHERE, ClosedForms, Guess, Places, places_of_rest
from eomgen.mechanics.equilibrium.stability import (
    Chosen,
    Stability,
    chosen_coordinates,
    holds_velocities,
    stability_of,
    unheld,
)
from eomgen.mechanics.free_bodies import Indeterminate, Reactions
from eomgen.mechanics.kinematics import ContactMode, Located, Lock, Motion
from eomgen.mechanics.start import shown_numbers
from eomgen.mechanics.state import Doubles
from eomgen.symbolic.expression import Fraction, Node, Scalar, ScalarRows, State, depends_on, jacobian, symbols_of
from eomgen.symbolic.numeric import FLOAT, NoValue, evaluate, rank, tolerances

# -------- search ----------------------------------------------------------------------------------------------
# System -> its equilibria: every place at which all forces balance, exact where possible, and their stability.
#
# In numbers first: equations without jumps in at most three coordinates have all their roots isolated, linear ones
# have a single solution; of others those are found that many guesses lead to, and it is said that there may be more.
# Then in closed form, taken where it agrees with the numbers and the equations hold exactly.


@dataclass(frozen=True)
class Equilibrium:
    """One equilibrium.

    Args:
        statics: the equations that hold there.
        exact: coordinates, and multipliers of closing constraints, as scalars of the parameters; those that are known
            so.
        numbers: all of them as numbers; {} without values of all parameters.
        stability: the verdict on its stability.
        curve: of equilibria, of which it is one; None where it is alone.
    """

    statics: StaticEquations
    exact: State
    numbers: Mapping[Node, float]
    stability: Stability
    curve: Curve | None = None

    @property
    def is_exact(self) -> bool:
        """True if every coordinate and state is known in closed form."""
        return all(q in self.exact for q in self.statics.system.symbols.places)

    @cached_property
    def pulling(self) -> tuple[str, ...]:
        """The one-sided constraints that would have to pull there; () where that is not known."""
        system = self.statics.system
        state: dict[Node, Scalar] = {system.symbols.t: 0, **dict.fromkeys((*system.symbols.u, *system.symbols.a), 0)}
        state |= self.exact if self.is_exact else {q: Fraction(self.numbers[q]) for q in system.symbols.places}
        values = {node: float(x) for node, x in system.scope.values_of_parameters(None).items()}
        return pulling_contacts(system, state, values)

    @cached_property
    def passed(self) -> tuple[str, ...]:
        """The one-sided constraints behind which it lies; () where that is not known."""
        return passed_contacts(self.statics.system, self.numbers) if self.numbers else ()

    @property
    def contradicted(self) -> tuple[str, ...]:
        """The one-sided constraints that do not let the system rest there."""
        return (*self.pulling, *self.passed)

    def refuse_contradicted(self) -> None:
        """Refuse a place that a one-sided contact would have to hold, or does not let the system reach.

        Raises:
            DerivationError: one pulls, or is passed through.
        """
        if not self.contradicted:
            return
        name = self.contradicted[0]
        if name in self.pulling:
            what = f"'{name}' would have to pull where the other forces balance"
            fix = "without it the system rests elsewhere"
        else:
            what = f"the other forces balance behind '{name}', which lets nothing pass"
            fix = "start where it touches, or hold the system on this side of it"
        raise DerivationError(what, f"constraints.{name}", fix)

    @staticmethod
    def nearest(statics: StaticEquations, guess: Mapping[str, float] | None = None) -> Equilibrium:
        """The place at which static equations hold that is nearest to a guess (None: to the start).

        Raises:
            UsageError: a name in the guess that is no coordinate.
            DerivationError: there is none; the forces hold an unknown.
        """
        return _search(statics, guess).nearest()


@dataclass(frozen=True)
class Equilibria:
    """The equilibria of a system.

    Args:
        statics: the equations.
        found: each place.
        complete: whether there are no others, where `where` says.
        where: in which range they were sought, in words.
        indifferent: coordinates that no force holds anywhere: they stay where they start.
        chosen: coordinates that velocity constraints let it rest at any value of, near the start: they stay there.
    """

    statics: StaticEquations
    found: tuple[Equilibrium, ...]
    complete: bool
    where: str
    indifferent: tuple[Node, ...]
    chosen: tuple[Node, ...] = ()

    def nearest(self, guess: Mapping[str, float] | None = None) -> Equilibrium:
        """The equilibrium that is reached from a guess (None: from the start).

        Raises:
            DerivationError: there is none.
        """
        if not self.found:
            raise nowhere(self.complete, self.statics.system.constraints)
        return self.found[0]

    @staticmethod
    def of(statics: StaticEquations) -> Equilibria:
        """Every place that is found at which static equations hold, the nearest to the start first; it says if all are.

        Those that a one-sided contact does not hold, or does not let the system reach, come last.

        Raises:
            DerivationError: the forces hold an unknown; dry friction; a drive that turns steadily.
        """
        return _search(statics, None).equilibria()


NO_PLACE = "no place was found at which all forces balance"
MOST_NAMED = 4  # coordinates


def nowhere(complete: bool, constraints: Constraints) -> DerivationError:
    """Error: there is no equilibrium, none was found, or the constraints cannot be satisfied near the start."""
    try:
        Closure(constraints).generic()
    except DerivationError as error:
        return error
    except MissingValues:  # without values nobody can say if they can be satisfied
        pass
    free = [
        q.name
        for q in constraints.motion.scope.symbols.q
        if not constraints.motion.scope.model.coordinates[q.name].driven
    ]
    along = "".join(f" along '{name}'" for name in free) if len(free) == 1 else ""
    along = f" (of {', '.join(map(repr, free[:MOST_NAMED]))})" if free[1:] else along
    what = f"{NO_PLACE}{along}{': there is none' if complete else ''}"
    fix = "hold what nothing balances by a spring or a constraint, or give a first guess by `near`"
    return DerivationError(what, "coordinates", fix)


def _search(statics: StaticEquations, guess: Mapping[str, float] | None) -> _Search:
    if statics.loaded:
        what = f"the forces hold the unknown '{statics.loaded[0].name}': it is what holds the system where it starts"
        raise DerivationError(what, f"unknowns.{statics.loaded[0].name}", "give it a value to seek equilibria")
    return _Search(statics.at_the_values(), dict(guess or {}))


@dataclass(frozen=True)
class _Search:
    """Search for the equilibria of a system.

    Args:
        whole: the equations.
        guess: where, by name.
    """

    whole: StaticEquations
    guess: Mapping[str, float]

    @property
    def system(self) -> System:
        return self.whole.system

    @cached_property
    def statics(self) -> StaticEquations:
        """Static equations without the coordinates on which none depends, and without those that may be chosen."""
        found, open_ = self._held_by_forces, self._chosen.coordinates
        return found.holding({q: self._fixed[q] for q in open_}) if open_ else found

    @cached_property
    def _held_by_forces(self) -> StaticEquations:
        """Static equations without the coordinates on which none depends."""
        found, scope = self.whole.without(self.whole.indifferent), self.system.scope
        idle = unheld(found) if self._slides else ()
        return found.holding(scope.with_unit_quaternions(scope.start_values(idle))) if idle else found

    @property
    def _indifferent(self) -> tuple[Node, ...]:
        return tuple(q for q in self.whole.q if q not in self._held_by_forces.q)

    @cached_property
    def _chosen(self) -> Chosen:
        statics = self._held_by_forces
        if not self._slides:
            return Chosen()
        return replace(
            chosen_coordinates(statics, self.values, self._guess.of(statics.q)), indifferent=self._indifferent
        )

    @property
    def _slides(self) -> bool:
        """True if constraints restrict velocities without a relation between positions, as those of a knife edge."""
        return bool(self.whole.J) and holds_velocities(self.whole, self.values, self._guess.of(self.whole.q))

    @cached_property
    def valued(self) -> bool:
        """True if all parameters on which the equilibria depend have values."""
        known = self.system.scope.model.exact_parameters()
        needed = [x for name, x in self.system.symbols.parameters.items() if name not in known]
        return not depends_on((*self.whole.equations, *self._fixed.values()), needed)

    @cached_property
    def values(self) -> dict[Node, Any]:
        """Values of the parameters with 50 digits; a trial value for those that have none."""
        return self.system.scope.values_of_parameters(Random(3))

    @property
    def floats(self) -> dict[Node, float]:
        return {node: float(x) for node, x in self.values.items()}

    @property
    def _fixed(self) -> dict[Node, Scalar]:
        """Driven coordinates, those that nothing holds and those chosen, where they start; these at their guess."""
        scope, free = self.system.scope, {*self._held_by_forces.q} - {*self._chosen.coordinates}
        fixed = scope.with_unit_quaternions(scope.start_values(q for q in scope.symbols.places if q not in free))
        return fixed | {q: self._guess.exact(q) for q in self._chosen.coordinates}

    @cached_property
    def _guess(self) -> Guess:
        return Guess(self.system, self.values, self.guess)

    @cached_property
    def _places(self) -> Places:
        """Equilibria in numbers, the nearest to the guess first; places where angles lock and a moment is left go."""
        first = self._guess.of(self.statics.q)
        places = places_of_rest(self.statics, self.values, first)
        found = [z for z in places.found if is_balanced_in_locked(self.whole, self._at(z))]
        return replace(places, found=tuple(nearest_first(self.statics, found, first)))

    def _at(self, z: np.ndarray) -> dict[Node, float]:
        """Values of everything at a place."""
        fixed = dict(zip(self._fixed, evaluate(tuple(self._fixed.values()), self.floats, FLOAT), strict=True))
        return {**self.floats, **fixed, **dict(zip(self.statics.unknowns, map(float, z), strict=True))}

    def nearest(self) -> Equilibrium:
        """The place nearest to the guess, alone, of those at which the contacts hold, where there are any.

        Raises:
            DerivationError: there is none.
        """
        first: Equilibrium | None = None
        forms = ClosedForms(self.statics, self.values, self._places.turning)
        for z in self._places.found:
            place = self._equilibrium(z, forms)
            if place is not None and not place.contradicted:
                return place
            first = first or place
        if first is None:
            raise nowhere(self._places.complete, self.system.constraints)
        return first

    def equilibria(self) -> Equilibria:
        places = self._places
        places = replace(places, found=tuple(each_once(self.statics, places.found, self.floats)))
        curves = along_curves(self.statics, places.found, self.floats, places.turning)
        places = replace(places, found=tuple(z for z, _ in curves))
        forms = ClosedForms(self.statics, self.values, places.turning)
        pairs = [(self._equilibrium(z, forms), curve) for z, curve in curves]
        found = [replace(each, curve=curve) for each, curve in pairs if each is not None]
        found.sort(key=lambda place: bool(place.contradicted))
        complete = places.complete and (self.valued or len(found) == len(places.found))
        certain = self.valued or places.where == ANYWHERE
        where = places.where if certain else f"{places.where}, for values like those tried for the parameters"
        return Equilibria(
            self._held_by_forces, tuple(found), complete, where, self._indifferent, self._chosen.coordinates
        )

    def _equilibrium(self, z: np.ndarray, forms: ClosedForms) -> Equilibrium | None:
        """The place, exact where it can be; None where only trial values of the parameters lead to it."""
        numbers = {**self.floats, **dict(zip(self.statics.unknowns, map(float, z), strict=True))}
        located = Located(numbers, self.system.scope.positive)
        held = forms.at(located)
        if not self.valued and held is None:
            return None
        exact = {**self._fixed, **({} if held is None else held.state)}
        fixed = {q: located.value(x) for q, x in self._fixed.items()}
        stability = stability_of(
            self.whole if self._slides else self.statics,
            {**exact, **({} if held is None else held.particular)},
            {**fixed, **numbers},
            self.values if self.valued else None,
            self._chosen if self._slides else None,
        )
        own = fixed | self._determined(z)
        if self.valued:  # what is known in closed form has all its digits
            known = [q for q in own if q in exact]
            sure = shown_numbers([exact[q] for q in known], self.system.scope.known_exactly)
            own |= {q: x for q, x in zip(known, sure, strict=True) if x is not None and math.isfinite(x)}
        return Equilibrium(self.statics, exact, own if self.valued else {}, stability)

    def _determined(self, z: np.ndarray) -> dict[Node, float]:
        """Coordinates, and the multipliers that have a single value."""
        statics, whole, n, at = self.statics, self.whole, len(self.statics.q), self._at(z)
        J = whole.slopes(whole.J, np.array([at[q] for q in whole.q]), self.floats)
        single = [rank(np.delete(J, i, axis=0)) < rank(J) for i in range(len(J))]
        kept = dict(zip(statics.q, z[:n], strict=True))
        kept |= {lam: x for lam, x, one in zip(statics.lam, z[n:], single, strict=True) if one}
        return {node: 0.0 if abs(x) < tolerances.ZERO_AT_50 else float(x) for node, x in kept.items()}


# -------- locked ----------------------------------------------------------------------------------------------
# A place where three angles lock -> whether the body is in balance there, about the axis that they have lost too.
#
# Where two of the axes are one, the forces along the three angles vanish although a moment about a third direction
# may be left: their balance says nothing of it. Near that place the angles turn the body about that direction n too,
#
#     tau . n = f . dq,   dq = D^-1 W^-1 n     at q + d,   d -> 0
#
# W: the axes of the angles, D: the angles' derivatives by the coordinates, f: what is to vanish along these.


LEFT = 1e-3  # of the largest force nearby: a moment that is left


def is_balanced_in_locked(statics: StaticEquations, place: State) -> bool:
    """True if no moment is left where angles lock, or if none lock.

    Args:
        statics: of all coordinates.
        place: of these, of the multipliers and the parameters.
    """
    motion = (statics.system.free or statics.system).motion
    given = [(node, x) for node, x in statics.given.items() if node not in place]
    state = dict(place) | dict(zip((node for node, _ in given), _numbers([x for _, x in given], place), strict=True))
    return all(
        _is_free(statics, motion, lock, state)
        for lock in motion.locks
        if abs(_numbers([lock.determinant], state)[0]) < tolerances.DEGENERATE
    )


def _is_free(statics: StaticEquations, motion: Motion, lock: Lock, state: dict[Node, float]) -> bool:
    """True if no moment is left about the axis that a body's angles have lost, or it cannot turn about that axis."""
    link = motion.link(lock.body)
    axes = [x for w, _ in link.S[-3:] for x in w]
    slopes = [x for row in jacobian(link.s[-3:], statics.q) for x in row]
    lost = np.linalg.svd(_numbers(axes, state).reshape(3, 3).T)[0][:, 2]
    rng = np.random.default_rng(1)
    left, largest = np.inf, 0.0
    for _ in range(3):
        aside = rng.uniform(0.5, 1, len(statics.q))
        beside = _shifted(statics, state, tolerances.ASIDE_STEP * aside)
        W, D = _numbers(axes, beside).reshape(3, 3).T, _numbers(slopes, beside).reshape(3, -1)
        if np.linalg.matrix_rank(D) < 3:  # the angles are not free each: it cannot turn about n
            return True
        dq = np.linalg.pinv(D) @ np.linalg.solve(W, lost)
        left = min(left, abs(_numbers(statics.forces, beside) @ dq))
        largest = max(largest, np.max(np.abs(_numbers(statics.forces, _shifted(statics, state, aside)))))
    return bool(left <= LEFT * largest)


def _shifted(statics: StaticEquations, state: dict[Node, float], by: np.ndarray) -> dict[Node, float]:
    return state | {q: state[q] + d for q, d in zip(statics.q, by.tolist(), strict=True)}


def _numbers(scalars: Any, state: State) -> np.ndarray:
    return np.array(Doubles(state).of(scalars))


# -------- one sided -------------------------------------------------------------------------------------------
# An equilibrium -> the contacts that would have to pull there, or behind which it lies: it is no equilibrium.


def pulling_contacts(system: System, state: Mapping[Node, Scalar], values: Mapping[Node, float]) -> tuple[str, ...]:
    """The one-sided constraints whose reaction is negative at a state.

    Args:
        state: exact scalars of everything that moves.
        values: of the parameters.
    """
    names = [
        contact.name
        for contact in system.scope.model.contacts
        if contact.unilateral and system.modes.get(contact.name, ContactMode()).closed
    ]
    if not names:
        return ()
    try:
        reactions = Reactions.of(system, state)
    except DerivationError:  # what acts at no place has no reactions
        return ()
    found = []
    for j, component in enumerate(reactions.components):
        if component.owner in names and component.label in ("n", "tension", "couple"):
            try:
                value = reactions.value(j)
            except Indeterminate:
                continue
            known = all(x in values for x in symbols_of((value,)))
            if known and evaluate((value,), values, FLOAT)[0] < -tolerances.COMPUTED:
                found.append(component.owner)
    return tuple(dict.fromkeys(found))


def passed_contacts(system: System, numbers: Mapping[Node, float]) -> tuple[str, ...]:
    """The one-sided constraints that are open with a negative gap at a place.

    Args:
        numbers: of the coordinates.
    """
    open_ = [name for name, mode in system.modes.items() if not mode.closed]
    gaps = {name: Row.of_constraint(system.motion, name)[0].gap for name in open_}
    known = {node: float(x) for node, x in system.scope.values_of_parameters(None).items()}
    known |= {system.symbols.t: 0.0, **numbers}
    sought = {name: gap for name, gap in gaps.items() if gap is not None and known.keys() >= {*symbols_of((gap,))}}
    values = evaluate(tuple(sought.values()), known, FLOAT)
    return tuple(name for name, gap in zip(sought, values, strict=True) if gap < -tolerances.CARRIED)


# -------- families --------------------------------------------------------------------------------------------
# Equilibria -> each once: e and -e are one orientation, and of a body that may turn freely one place is enough.
#
# Where the second variation K vanishes in some direction, equilibria can make up a whole family: a body on a ball
# joint hangs at any angle about the vertical, a sleigh stands at any angle. Two places of one family have the same V
# and the same spectrum of K. A family that is a curve is followed in both directions:
#
#     F(z) = 0,   F'(z) t = 0:   z + h t, back onto F = 0 by the shortest way


@dataclass(frozen=True)
class Curve:
    """Curve of equilibria.

    Args:
        points: coordinates and multipliers along it, a row a place, the one that was found first among them.
        closed: True if it comes back to where it began, or goes on by whole turns.
    """

    points: np.ndarray
    closed: bool

    def holds(self, q: np.ndarray, turning: Sequence[bool]) -> bool:
        """True if a place lies on the curve, within the distance between its points."""
        away = np.abs(self.points[:, : len(q)] - q)
        away = np.where(turning, np.minimum(away % math.tau, math.tau - away % math.tau), away)
        return bool(np.min(np.max(away, axis=1)) <= STRIDE)


def nearest_first(statics: StaticEquations, found: Sequence[np.ndarray], guess: np.ndarray) -> list[np.ndarray]:
    """The places with that of e and -e which is nearer to the guess, of every quaternion; the nearest first."""
    if not statics.norms:
        return list(found)
    turned = (_turned(statics, z, guess) for z in found)
    return sorted(turned, key=lambda z: float(np.sum((z[: len(guess)] - guess) ** 2)))


def each_once(statics: StaticEquations, found: Sequence[np.ndarray], floats: Mapping[Node, float]) -> list[np.ndarray]:
    """The places, the first of those that are one, or one family.

    Args:
        found: coordinates and multipliers of each, the nearest to the guess first.
        floats: of the parameters.
    """
    if not statics.q or (not statics.norms and not statics.beside):
        return list(found)
    slopes = jacobian(statics.forces, statics.q)
    kept: list[tuple[np.ndarray, np.ndarray]] = []
    for z in found:
        values = {**floats, **dict(zip(statics.unknowns, map(float, z), strict=True))}
        marks = _marks(statics, slopes, z, values)
        if not any(_is_one(statics, (z, marks), other) for other in kept):
            kept.append((z, marks))
    return [z for z, _ in kept]


def along_curves(
    statics: StaticEquations, found: Sequence[np.ndarray], floats: Mapping[Node, float], turning: frozenset[Node]
) -> list[tuple[np.ndarray, Curve | None]]:
    """The places, the first of each curve of them alone, with that.

    Args:
        found: coordinates and multipliers of each, the nearest to the guess first.
        floats: of the parameters.
        turning: coordinates for which a whole turn changes nothing.
    """
    if len(found) < 2 or statics.norms or statics.beside or not statics.q:
        return [(z, None) for z in found]
    way = _Way(statics, floats, tuple(q in turning for q in statics.q))
    kept: list[tuple[np.ndarray, Curve | None]] = []
    n = len(statics.q)
    for z in found:
        if not any(curve is not None and curve.holds(z[:n], way.turning) for _, curve in kept):
            kept.append((z, way.curve(z) if len(kept) < MOST_CURVES else None))
    return kept


STRIDE = 0.1  # of a way along a curve, in radians or metres
STRIDES = 150  # in one direction
MOST_CURVES = 12  # places of which it is tried whether they lie on one
CORRECTIONS = 6  # back onto it


@dataclass(frozen=True)
class _Way:
    """Continuation along a curve of equilibria: F(z) = 0, in the direction t with F'(z) t = 0."""

    statics: StaticEquations
    floats: Mapping[Node, float]
    turning: tuple[bool, ...]

    @cached_property
    def _slopes(self) -> ScalarRows:
        return jacobian(self.statics.equations, self.statics.unknowns)

    def _at(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(F, F') of a place."""
        values = {**self.floats, **dict(zip(self.statics.unknowns, map(float, z), strict=True))}
        rows = [(*row, x) for row, x in zip(self._slopes, self.statics.equations, strict=True)]
        found = Doubles(values).array(rows, len(z) + 1)
        return found[:, -1], found[:, :-1]

    def _along(self, z: np.ndarray) -> np.ndarray | None:
        """t, its part of the coordinates 1 long; None where there is not one such direction."""
        _, slopes = self._at(z)
        slopes = slopes / np.maximum(np.max(np.abs(slopes), axis=1, keepdims=True), tolerances.TINIEST)
        _, sizes, axes = np.linalg.svd(slopes)
        rank = int(np.sum(sizes > tolerances.CARRIED * max(sizes, default=0.0)))
        null = axes[rank:, : len(self.statics.q)]
        _, moved, mixed = np.linalg.svd(null.T) if len(null) else (None, np.zeros(0), None)
        if mixed is None or int(np.sum(moved > tolerances.CARRIED)) != 1:
            return None
        t = mixed[0] @ axes[rank:]
        return np.asarray(t / np.linalg.norm(t[: len(self.statics.q)]))

    def _onto(self, z: np.ndarray, t: np.ndarray) -> np.ndarray | None:
        """The equilibrium that is reached across t; None where there is none."""
        start, n = z, len(self.statics.q)
        unit = np.where(np.arange(len(z)) < n, 1.0, np.maximum(np.abs(z), 1.0))  # multipliers change as they are large
        for _ in range(CORRECTIONS):
            F, slopes = self._at(z)
            size = np.maximum(np.max(np.abs(slopes), axis=1), tolerances.TINIEST)
            if np.all(np.abs(F) <= tolerances.SAME_PLACE * tolerances.CARRIED * size):
                return z if np.linalg.norm((z - start)[:n]) < STRIDE / 2 else None
            rows = np.vstack([slopes / size[:, None], np.append(t[:n], np.zeros(len(z) - n))]) * unit
            if not np.all(np.isfinite(rows)):
                return None
            z = z - unit * np.linalg.lstsq(rows, np.append(F / size, 0.0), rcond=tolerances.CARRIED)[0]
        return None

    def curve(self, z: np.ndarray) -> Curve | None:
        """The curve on which a place lies; None where it is alone, or one of more than a curve."""
        try:
            first = self._along(z)
            if first is None:
                return None
            ways, closed = [], False
            for sign in (1, -1):
                points, closed = ([], closed) if closed else self._gone(z, sign * first)
                ways.append(points)
        except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
            return None
        if not any(ways):
            return None
        return Curve(np.array([*reversed(ways[1]), z, *ways[0]]), closed)

    def _gone(self, z: np.ndarray, t: np.ndarray) -> tuple[list[np.ndarray], bool]:
        """(places along the curve in one direction, whether it comes back to the first)."""
        n, begun, points = len(self.statics.q), z, []
        for k in range(STRIDES):
            steps = (self._onto(z + step * t, t) for step in (STRIDE, STRIDE / 4))
            there = next((x for x in steps if x is not None), None)
            if there is None:
                break
            points.append(there)
            new = self._along(there)
            if new is None:
                break
            z, t = there, new if new[:n] @ t[:n] > 0 else -new
            away = np.abs((z - begun)[:n])
            away = np.where(self.turning, np.minimum(away % math.tau, math.tau - away % math.tau), away)
            if k > 2 and np.max(away) < STRIDE:
                return points, True
        return points, False


def _turned(statics: StaticEquations, z: np.ndarray, guess: np.ndarray) -> np.ndarray:
    """The place with that of e and -e which is nearer to the guess, of every quaternion."""
    z = z.copy()
    for four in statics.system.scope.quaternions:
        places = [statics.q.index(e) for e in four if e in statics.q]
        if len(places) == len(four) and float(z[places] @ guess[places]) < 0:  # else one that is held has its sign
            z[places] = -z[places]
        z[places] = np.where(abs(z[places]) < tolerances.ZERO_AT_50, 0.0, z[places])
    return z


def _marks(statics: StaticEquations, slopes: ScalarRows, z: np.ndarray, values: Mapping[Node, float]) -> np.ndarray:
    """V, and the eigenvalues of K along the constraints, by size."""
    n = len(statics.q)
    J = statics.slopes(statics.J, z[:n], values)
    H = -Doubles(values).array(slopes, n)
    _, sizes, axes = np.linalg.svd(J)
    Z = axes[int(np.sum(sizes > tolerances.CARRIED * sizes.max(initial=0.0))) :].T
    symbols = statics.system.symbols
    given = {**{x: 0.0 for x in symbols.x}, symbols.t: 0.0}
    (V,) = evaluate((statics.system.loads.potential_energy,), {**_given(statics, values), **given, **values}, FLOAT)
    spectrum = np.linalg.eigvals(Z.T @ H @ Z)
    return np.array([V, *sorted(spectrum.real)], dtype=float)


def _given(statics: StaticEquations, values: Mapping[Node, float]) -> dict[Node, float]:
    found = evaluate(tuple(statics.given.values()), values, FLOAT)
    return dict(zip(statics.given, map(float, found), strict=True))


def _is_one(statics: StaticEquations, one: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray]) -> bool:
    """True if two places are the same, or belong to one family."""
    (z, marks), (y, others) = one, other
    if np.all(abs(z - y)[: len(statics.q)] <= tolerances.SAME_PLACE):
        return True
    size = tolerances.TINIEST + np.max(abs(np.concatenate([marks, others])))
    flat = np.min(abs(marks[1:]), initial=np.inf) <= tolerances.CARRIED * size
    return bool(flat and np.all(abs(marks - others) <= tolerances.SAME_PLACE * size))
