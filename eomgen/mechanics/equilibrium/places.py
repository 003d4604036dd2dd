"""Static equations -> equilibria in numbers, proof that those are all where possible, and closed forms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property, partial
from itertools import chain
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.equilibrium.equations import StaticEquations
from eomgen.mechanics.kinematics import Located, Motion
from eomgen.symbolic.exact import LinearSystem, Solution, cramer, has_period, readable, readable_all, simplest, vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Owner,
    Scalar,
    ScalarRow,
    State,
    depends_on,
    gradient,
    is_zero,
    jacobian,
    linear_terms,
    order,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import (
    FLOAT,
    Descent,
    Layers,
    NoValue,
    Work,
    evaluate,
    fifty_digits,
    isolated,
    rank,
    switches_of,
    tolerances,
)
from eomgen.symbolic.print import text_size

# -------- rest places -----------------------------------------------------------------------------------------
# Static equations -> the equilibria in numbers, and whether those are all.


MOST_ISOLATED = 3  # coordinates of equations whose roots are isolated
REACH = 1000.0  # how far from the guess a coordinate that is no angle is sought, against its size and 1
TURNS = 2.0  # how many half turns to each side an angle is sought that is not the same after a turn
ASIDE = 0.0123  # by which a range is shifted: roots at round numbers do not lie on its border
GUESSES = 400  # of few coordinates; of more they are fewer
FEW = 4
MOST_PLACES = 24  # that many guesses lead to
MOST_OF_LONG = 4  # of these where the equations are long
LONG = 500  # operations
MOST_OF_FAMILIES = 400  # where many of them are one family: bodies that turn freely
SIDE = 0.1  # of a guess, by which a place without slopes is left
MOST_PIECES = 120  # places in other pieces
UNDECIDED = 60  # boxes that may hold a root, from which one is sought
ANYWHERE = "anywhere"
CLUSTER = 3.0  # times as far from a root as those that belong to it so far, a box that may hold it does too


@dataclass(frozen=True)
class Places:
    """Equilibria in numbers.

    Args:
        found: coordinates and multipliers of each, the nearest to the guess first.
        complete: True if there are no others in the range.
        where: the range, in words.
        turning: the coordinates for which a whole turn changes nothing.
    """

    found: tuple[np.ndarray, ...]
    complete: bool
    where: str
    turning: frozenset[Node]


def places_of_rest(statics: StaticEquations, values: Mapping[Node, Any], guess: np.ndarray) -> Places:
    """Every equilibrium that is found.

    Args:
        values: of the parameters, with 50 digits.
        guess: of the coordinates.
    """
    return _Search(statics, values, guess).places()


def place_near(statics: StaticEquations, values: Mapping[Node, Any], guess: np.ndarray) -> np.ndarray | None:
    """One equilibrium, coordinates and multipliers: that reached from the guess, else from places about it."""
    return _Search(statics, values, guess).one()


@dataclass(frozen=True)
class _Search:
    statics: StaticEquations
    values: Mapping[Node, Any]
    guess: np.ndarray

    @property
    def floats(self) -> dict[Node, float]:
        return {node: float(x) for node, x in self.values.items()}

    def places(self) -> Places:
        statics = self.statics
        if not statics.unknowns:
            return self._sorted([np.zeros(0)], complete=True, where="")
        if self._is_linear:
            return self._linear()
        reduced = self._reduced
        boxed = None if reduced is None or len(statics.q) > MOST_ISOLATED else self._isolated(reduced)
        if boxed is not None:
            return boxed
        found = self._measured._from_guesses()
        return replace(found, found=tuple(z * self._units for z in found.found))

    def _from_guesses(self) -> Places:
        few = MOST_PLACES if len(order(self.statics.equations)) < LONG else MOST_OF_LONG
        most = few if not self.statics.norms else MOST_OF_FAMILIES
        guesses = np.concatenate([self._scattered(), self._in_other_pieces()])
        found = self._descent.roots_near(self._with_multipliers(guesses), most)
        found = [z for z in found if self._is_held(z)]
        return self._sorted(found, complete=False, where="from many guesses")

    def one(self) -> np.ndarray | None:
        """The place that is reached from the guess, else the nearest of those reached from places about it."""
        measured = self._measured
        for guesses in (measured.guess[None, :], measured._scattered(), measured._in_other_pieces()):
            found = measured._descent.roots_near(measured._with_multipliers(guesses), 1)
            if found:
                return np.asarray(found[0] * self._units)
        return None

    # -- lengths of the model's own size -----------------------------------------------------------

    @cached_property
    def _unit(self) -> dict[Node, Fraction]:
        """Unit of length of each coordinate that is no angle, size of each state, used while many guesses are tried."""
        statics, scope = self.statics, self.statics.system.scope
        state = self.floats | dict(zip(statics.q, map(float, self.guess), strict=True))
        unit = unit_of_length(statics.system.motion, state)
        plain = self._angles.union(*scope.quaternions, statics.system.symbols.z)
        sizes = {z: Fraction(f"{abs(state[z]):.0e}") for z in statics.system.symbols.z if state[z]}
        lengths = {} if unit == 1 else {q: unit for q in statics.q if q not in plain}
        return lengths | {z: size for z, size in sizes.items() if size != 1}

    @property
    def _units(self) -> np.ndarray:
        return np.array([float(self._unit.get(x, 1)) for x in self.statics.unknowns])

    @property
    def _measured(self) -> _Search:
        """The same in these units, in which a step of 1 is one of the model's own size, be it of mm or of km."""
        if not self._unit:
            return self
        return _Search(self.statics.measured(self._unit), self.values, self.guess / self._units[: len(self.guess)])

    @cached_property
    def _descent(self) -> Descent:
        equations = tuple(x for x in self.statics.equations if not is_zero(x))
        return Descent(equations, self.statics.unknowns, self.values, telling=len(self.statics.q) or None)

    # -- three ways --------------------------------------------------------------------------------

    @property
    def _is_linear(self) -> bool:
        slopes = [x for row in jacobian(self.statics.equations, self.statics.unknowns) for x in row]
        return not depends_on(slopes, self.statics.unknowns)

    def _linear(self) -> Places:
        """Linear equations have one solution, where they are regular."""
        found = self._descent.roots_near(self._with_multipliers(self.guess[None, :]))
        slopes = self._descent.at_one(found[0]) if found else np.zeros((0, 0))
        return self._sorted(found, complete=not found or rank(slopes.T) == len(self.statics.unknowns), where=ANYWHERE)

    @property
    def _reduced(self) -> tuple[Scalar, ...] | None:
        """System of as many equations as coordinates, without multipliers; None where there is none.

        Without constraints the forces; with one degree of freedom left, det [Q; J] = 0 (no force along it) and the
        relations.
        """
        statics = self.statics
        n, relations = len(statics.q), (*statics.phi, *statics.sigma)
        if statics.beside or statics.system.symbols.z:  # no range is known in which a state has all its roots
            return None
        if not statics.J:
            return statics.Q if not relations else None
        if len(statics.J) == len(relations) == n - 1:
            determinant = cramer.determinant((statics.Q, *statics.J))
            return (readable(determinant, Work.VALUE), *relations)
        return None

    def _isolated(self, equations: tuple[Scalar, ...]) -> Places | None:
        """All roots of the reduced equations in the range; None where they have jumps."""
        low, high = self._range
        boxes = isolated(equations, self.statics.q, self.floats, low, high)
        if boxes is None:
            return None
        found, guesses = [], boxes.undecided[:: 1 + len(boxes.undecided) // UNDECIDED]
        for z in self._with_multipliers(boxes.roots):
            polished = self._descent.polished(z)
            found += self._descent.roots_near(z[None, :]) if polished is None else [polished]
        found += self._descent.roots_near(self._with_multipliers(guesses))
        found = [z for z in found if self._is_held(z)]
        if not boxes.finished:
            found += self._descent.roots_near(self._with_multipliers(self._scattered()), MOST_PLACES)
        n = len(self.statics.q)
        size = high - low
        left, halves = boxes.undecided / size, boxes.halves / size
        for z in found:
            apart = ~_about(z[:n] / size, left, halves)
            left, halves = left[apart], halves[apart]
        inside = [z for z in found if np.all((z[:n] >= low) & (z[:n] <= high))]
        return self._sorted(inside, complete=boxes.finished and not len(left), where=self._where)

    # -- ranges and guesses ------------------------------------------------------------------------

    @property
    def _turning(self) -> frozenset[Node]:
        """Angles after a whole turn of which all equations are the same."""
        equations = [x for x in self.statics.equations if not is_zero(x)]
        outside = outside_of_turns(equations)
        return frozenset(
            q
            for q in self._angles
            if q not in outside or all(not depends_on(x, (q,)) or has_period(x, q, 2 * q.graph.pi) for x in equations)
        )

    @property
    def _angles(self) -> frozenset[Node]:
        """Coordinates in the argument of a sine or cosine."""
        waves = [node for node in order(self.statics.equations) if node.op in ("sin", "cos")]
        return frozenset(symbols_of(waves)).intersection(self.statics.q)

    @property
    def _range(self) -> tuple[np.ndarray, np.ndarray]:
        half = []
        for q, at in zip(self.statics.q, self.guess, strict=True):
            turning = q in self._turning
            half.append(math.pi * (1 if turning else TURNS) if q in self._angles else REACH * (1 + abs(at)))
        middle = np.where([q in self._turning for q in self.statics.q], 0.0, self.guess)
        reach = np.array(half)
        return middle - reach * (1 + ASIDE), middle + reach * (1 + ASIDE * 1.7)

    @property
    def _where(self) -> str:
        names = [q.name for q in self.statics.q if q not in self._turning]
        angles = [q.name for q in self.statics.q if q in self._angles and q not in self._turning]
        lengths = [name for name in names if name not in angles]
        parts = [f"{', '.join(angles)} within one turn of the start"] if angles else []
        model = self.statics.system.scope.model
        parts += [f"{name} within {model.in_own_unit(name, REACH)} of the start" for name in lengths]
        return " and ".join(parts) if parts else "in one turn"

    def _scattered(self) -> np.ndarray:
        """The guess, and many places about it."""
        rng = np.random.default_rng(5)
        n = len(self.statics.q)
        many = GUESSES if n <= FEW else GUESSES * FEW // n**2 + 8
        reach = 10 ** rng.uniform(-1.5, 1.0, (many, 1))
        about = self.guess + rng.uniform(-1, 1, (many, n)) * (1 + abs(self.guess)) * reach
        for k, q in enumerate(self.statics.q):
            if q in self._angles:
                about[::2, k] = rng.uniform(-math.pi, math.pi, len(about[::2]))
                about[1::2, k] = self.guess[k] + rng.uniform(-0.5, 0.5, len(about[1::2]))
        quarters = np.where([q in self._angles for q in self.statics.q], math.pi / 2, 0.0)
        round_ones = quarters * rng.integers(-1, 3, (32, n))
        return np.concatenate([self.guess[None, :], round_ones, about])

    def _in_other_pieces(self) -> np.ndarray:
        """Places near the guess in every piece of the laws: where ropes are taut, where springs touch."""
        places, number = self.statics.q, fifty_digits().number
        found: list[list[float]] = []
        for switch in switches_of(self.statics.equations, frozenset(places)):
            for aside in (0.0, SIDE, -SIDE):  # where a rope has no length its law has no slope
                about = self.guess + aside * (1 + abs(self.guess))
                state = {**self.values, **{q: number(Fraction(float(x))) for q, x in zip(places, about, strict=True)}}
                with suppress(NoValue, ZeroDivisionError):
                    moved = (switch.moved(state, x, frozenset(places)) for x in chain(*switch.targets(state)))
                    found += [[float(each[q]) for q in places] for each in moved if each is not None]
        return np.array(found[:MOST_PIECES]).reshape(-1, len(places))

    def _with_multipliers(self, q: np.ndarray) -> np.ndarray:
        """Places with the multipliers that balance them best."""
        if not self.statics.lam or not self.statics.q:
            return np.hstack([q, np.zeros((len(q), len(self.statics.lam)))])
        beside, lam = self.statics.beside, self.statics.lam
        more = tuple(zip(*jacobian(beside, lam), strict=True)) if beside else tuple(() for _ in lam)
        alone = substituted(beside, dict.fromkeys(lam, 0))
        J = self._at([(*row, *also) for row, also in zip(self.statics.J, more, strict=True)], q)
        Q = self._at(((*self.statics.Q, *alone),), q)
        rows = [np.append(x, _balancing(*each)) for x, *each in zip(q, J, Q[:, 0], strict=True)]
        return np.array(rows).reshape(len(q), len(self.statics.unknowns))

    def _at(self, rows: Sequence[Sequence[Scalar]], q: np.ndarray) -> np.ndarray:
        """Entries as numbers at many places, places x rows x columns."""
        found = Layers(tuple(x for row in rows for x in row), self.statics.q, self.floats).at(q)
        return found.reshape(len(q), len(rows), len(rows[0]) if rows else 0)

    def _is_held(self, z: np.ndarray) -> bool:
        """Test of a place: False where the constraints are nearly singular and would need unlimited forces."""
        n = len(self.statics.q)
        J = self.statics.slopes(self.statics.J, z[:n], self.floats)
        if not J.size or not np.all(np.isfinite(J)):
            return True
        Q, *others = (self.statics.slopes((self.statics.Q,), z[:n] + d, self.floats)[0] for d in (0, 0.3, -0.2))
        lam = np.linalg.lstsq(J.T, -Q, rcond=tolerances.NEARLY_SINGULAR)[0]
        return bool(np.all(abs(Q + J.T @ lam) <= tolerances.UNBALANCED * np.nanmax(np.abs([Q, *others]))))

    # -- in order ----------------------------------------------------------------------------------

    def _sorted(self, found: Sequence[np.ndarray], *, complete: bool, where: str) -> Places:
        """Places without repetition, angles in (-pi, pi], the nearest to the guess first."""
        n = len(self.statics.q)
        unique: list[tuple[np.ndarray, np.ndarray]] = []
        for z in found:
            z, reach = z.copy(), self._descent.reach(z)[:n] if n else np.zeros(0)
            for k, q in enumerate(self.statics.q):
                if q in self._turning:
                    z[k] = -((-z[k] + math.pi) % math.tau - math.pi)
                    z[k] = math.pi if abs(z[k] + math.pi) < tolerances.SAME_PLACE else z[k]
            if not any(np.all(abs(z - other)[:n] <= np.maximum(reach, more)) for other, more in unique):
                unique.append((z, reach))
        places = sorted((z for z, _ in unique), key=lambda z: self._distance(z[:n]))
        return Places(tuple(places), complete, where, self._turning if self.statics.q else frozenset())

    def _distance(self, q: np.ndarray) -> float:
        """Square of the scaled distance from the guess, angles the short way round."""
        away = np.abs(q - self.guess)
        turning = [x in self._turning for x in self.statics.q]
        away = np.where(turning, np.minimum(away % math.tau, math.tau - away % math.tau), away)
        return float(np.sum((away / (1 + np.abs(self.guess))) ** 2))


def _about(z: np.ndarray, boxes: np.ndarray, halves: np.ndarray) -> np.ndarray:
    """Mask of the undecided boxes that belong to the root at z: those that lie about it without a wide gap."""
    away = np.max(np.abs(boxes - z) - halves, axis=1, initial=0.0)
    ends = np.max(np.abs(boxes - z) + halves, axis=1, initial=0.0)
    kept, radius = np.zeros(len(boxes), dtype=bool), tolerances.NEAR_ROOT * tolerances.COMPUTED
    for k in np.argsort(away):
        if away[k] > CLUSTER * radius:
            break
        kept[k], radius = True, max(radius, ends[k])
    return kept


def _balancing(J: np.ndarray, Q: np.ndarray) -> np.ndarray:
    """The multipliers for which Q + J^T lam is least; 0 where it has no value."""
    if not (np.all(np.isfinite(J)) and np.all(np.isfinite(Q))):
        return np.zeros(len(J))
    return np.asarray(np.linalg.lstsq(J.T, -Q, rcond=tolerances.RANK)[0])


# -------- closed rest -----------------------------------------------------------------------------------------
# An equilibrium in numbers -> the same in closed form, where the equations hold there exactly.
#
# Tried are round places (quarter turns, zeros, the start), then what the constraints and the balance say of the other
# coordinates. What is found is taken only where all equations hold at it as functions of the parameters.


MOST_EXACT = 2  # coordinates of equations that are solved in closed form, those left out that constraints give at once
LONGEST = 600  # characters of these equations
PATIENCE = 2  # places without a closed form, before equations are no more tried at others
HALF = Fraction(1, 2)


@dataclass(frozen=True)
class Held:
    """A place at which all equations hold exactly.

    Args:
        state: coordinates, and the multipliers that have a single value.
        particular: values of all multipliers that hold it, those that may be chosen 0.
    """

    state: State
    particular: State


@dataclass(frozen=True)
class ClosedForms:
    """The equilibria of a system in closed form.

    Args:
        statics: the equations.
        values: of the parameters, with 50 digits.
        turning: the coordinates for which a whole turn changes nothing.
    """

    statics: StaticEquations
    values: Mapping[Node, Any]
    turning: frozenset[Node]

    def at(self, located: Located) -> Held | None:
        """Coordinates and multipliers as scalars of the parameters; None where the place has no closed form."""
        simple = self._simple(located)
        if len(simple) == len(self.statics.q) and (held := self._held(simple)) is not None:
            return held
        if len(simple) == len(self.statics.q):
            simple = self._simple(located, starts=False)
        for equations, unknowns, known in self._closed_ways(simple):
            way = (equations, unknowns, tuple(known.values()))
            if self._vain.get(way, 0) >= PATIENCE:
                continue
            try:
                found = {**known, **located.places(substituted(equations, known), unknowns)}
            except DerivationError:  # too large, or a value that is not real
                found = {}
            if all(q in found for q in self.statics.q):
                place = {q: _short_turn(found[q], located.value(found[q]), q in self.turning) for q in self.statics.q}
                if (held := self._held(place)) is not None:
                    return held
            self._vain[way] = self._vain.get(way, 0) + 1
        return None

    @cached_property
    def _vain(self) -> dict[tuple[Any, ...], int]:
        """Number of failed tries for a closed form, by the equations and unknowns tried."""
        return {}

    def _closed_ways(
        self, simple: Mapping[Node, Scalar]
    ) -> Iterator[tuple[ScalarRow, tuple[Node, ...], Mapping[Node, Scalar]]]:
        """(equations, unknowns, what is known): the constraints from coordinates at simple places, or all equations."""
        statics = self.statics
        left = tuple(q for q in statics.q if q not in simple)
        relations = (*statics.phi, *statics.sigma)
        if simple and relations and len(left) <= len(relations):
            yield relations, left, simple
        size = sum(text_size(x) for x in statics.equations)
        if simple and len(left) <= MOST_EXACT and size <= LONGEST:
            yield statics.equations, (*left, *statics.lam), simple
        linear = sum(any(_is_number(d) for d in gradient(x, statics.q)) for x in relations)
        if _entangled(statics) - linear <= MOST_EXACT and size <= LONGEST:
            yield statics.equations, statics.unknowns, {}

    def _simple(self, located: Located, *, starts: bool = True) -> dict[Node, Scalar]:
        """Quarter turns, zeros and start values near the coordinates, as candidates of exact values."""
        scope, found = self.statics.system.scope, dict[Node, Scalar]()
        turning = {e for four in scope.quaternions for e in four}
        for q in self.statics.q:
            number = located.numbers[q]
            quarters = round(number / (np.pi / 2))
            candidates: list[Scalar] = [0 if quarters == 0 else Fraction(quarters, 2) * q.graph.pi]
            if q in turning:
                candidates = [sign * x for x in _round_components(q.graph) for sign in (1, -1)]
            candidates += [scope.start_value(q)] * starts
            near = [x for x in candidates if abs(located.value(x) - number) <= tolerances.COMPUTED * (1 + abs(number))]
            if near:
                found[q] = near[0]
        return found

    def _held(self, q: Mapping[Node, Scalar]) -> Held | None:
        """The state with its multipliers where all equations hold there exactly; None where they do not."""
        statics = self.statics
        try:
            relations = substituted((*statics.phi, *statics.sigma), q)
            rows = [substituted(tuple(row[k] for row in statics.J), q) for k in range(len(statics.q))]
            rows += [substituted(row, q) for row in jacobian(statics.beside, statics.lam)]
            alone = substituted(statics.beside, dict.fromkeys(statics.lam, 0))
            right = tuple(-x for x in substituted((*statics.Q, *alone), q))
            if not all(map(_is_nothing, relations)):
                return None
            entries = readable_all([x for row in rows for x in row], Work.VALUE) if rows and statics.lam else ()
            n = len(statics.lam)
            lines = [{j: entries[n * k + j] for j in range(n)} for k in range(len(rows))]
            values = partial(evaluate, values=self.values, arithmetic=fifty_digits())
            solution = LinearSystem(lines, readable_all(right, Work.VALUE), n, values).solution()
        except (DerivationError, NoValue, ZeroDivisionError):
            return None
        if not all(map(_is_nothing, solution.left)) or not _satisfied(lines, right, solution):
            return None
        positive = self.statics.system.scope.positive
        lam = {statics.lam[j]: simplest(x, Work.VALUE, positive) for j, x in solution.constants.items()}
        single = {statics.lam[j] for j in solution.constants if solution.determined(j)}
        place = {node: simplest(x, Work.VALUE, positive) for node, x in q.items()}
        return Held(
            {**place, **{node: x for node, x in lam.items() if node in single}},
            {**dict.fromkeys(statics.lam, 0), **lam},
        )


def _satisfied(lines: Sequence[Mapping[int, Scalar]], right: Sequence[Scalar], solution: Solution) -> bool:
    """True if the solution satisfies the rows as functions of the parameters, free unknowns 0.

    An entry that vanishes only at the model's own parameters counts as 0 in the solution: sin(pi*q) at q = 3.
    """
    known = solution.constants
    left = (sum((x * known.get(j, 0) for j, x in line.items()), start=-b) for line, b in zip(lines, right, strict=True))
    return all(map(_is_nothing, left))


def _round_components(graph: Owner) -> tuple[Scalar, ...]:
    """Components of quaternions that turn by 0, 60, 90, 120 or 180 degrees."""
    return (0, 1, HALF, HALF * graph.sqrt(2), HALF * graph.sqrt(3))


def _entangled(statics: StaticEquations) -> int:
    """Largest number of coordinates that are coupled by equations."""
    groups: list[set[Node]] = []
    for x in statics.equations:
        held = {node for node in statics.unknowns if depends_on(x, (node,))}
        joined = [group for group in groups if group & held]
        groups = [group for group in groups if not group & held] + [held.union(*joined)]
    return max((sum(q in group for q in statics.q) for group in groups), default=0)


def _is_number(x: Scalar) -> bool:
    return type(x) is not Node and x != 0


def _is_nothing(x: Scalar) -> bool:
    return is_zero(x) or vanishes(x)


def _short_turn(x: Scalar, number: float, turning: bool) -> Scalar:
    """An angle of (-pi, pi] where whole turns do not matter."""
    turns = -round(number / (2 * np.pi)) if turning else 0
    return x + turns * 2 * x.graph.pi if turns and type(x) is Node else x


# -------- guesses ---------------------------------------------------------------------------------------------
# System, values by name -> where equilibria are sought first: as requested, else `near`, else the start.
#
# The unit of length used in the search is one of the model's own size.


@dataclass(frozen=True)
class Guess:
    """First values of the coordinates in the search for equilibria.

    Args:
        system: the system of these coordinates.
        values: of the parameters, with 50 digits.
        requested: coordinates by name, in place of `near` and `start`.
    """

    system: System
    values: Mapping[Node, Any]
    requested: Mapping[str, float]

    def of(self, coordinates: Sequence[Node]) -> np.ndarray:
        """First values of coordinates as numbers.

        Raises:
            UsageError: a requested name is no coordinate.
        """
        return np.array([float(self._numbers[q.name]) for q in coordinates])

    def exact(self, q: Node) -> Scalar:
        """First value of a coordinate as a scalar of the parameters."""
        scope = self.system.scope
        if q.name in self.requested:
            return Fraction(self.requested[q.name])
        near = None if q.name in scope.model.states else scope.model.coordinates[q.name].near
        return scope.start_value(q) if near is None else scope.value(near)

    @cached_property
    def _numbers(self) -> dict[str, float]:
        model = self.system.scope.model
        known = (*model.coordinates, *model.states)
        unknown = [name for name in self.requested if name not in known]
        if unknown:
            raise UsageError(f"no coordinate '{unknown[0]}'", fix=f"one of {', '.join(known)}")
        trial = {name: float(self.values[x]) for name, x in self.system.symbols.parameters.items()}
        begun, others = model.start_values(trial)
        states = {name: others[name] for name in model.states}
        return {**begun, **states, **model.first_guesses(trial), **self._near, **self.requested}

    @property
    def _near(self) -> dict[str, float]:
        """The first guesses of coordinates that are not dependent."""
        scope, found = self.system.scope, {}
        for name, part in scope.model.coordinates.items():
            if part.near is not None:
                found[name] = float(evaluate((scope.value(part.near),), self.values, fifty_digits())[0])
        return found


def unit_of_length(motion: Motion, state: Mapping[Node, float]) -> Fraction:
    """A length of the model's own size [m]: the largest distance of two of its points along an axis, to one digit.

    1 where there are no two such points.
    """
    scope, symbols = motion.scope, motion.scope.symbols
    places = [motion.position((body, r)) for body, points in motion.points.items() for r in points.values()]
    places += [scope.vector(r) for r in scope.model.points.values()]
    try:
        x = evaluate([x for p in places for x in p], dict.fromkeys((*symbols.q, symbols.t), 0.0) | {**state}, FLOAT)
    except NoValue:
        return Fraction(1)
    largest = float(np.max(np.ptp(np.array(x, dtype=float).reshape(-1, 3), axis=0), initial=0.0)) if places else 0.0
    return Fraction(f"{largest:.0e}" if 0 < largest < math.inf else 1)


def outside_of_turns(equations: Iterable[Scalar]) -> frozenset[Node]:
    """The symbols that stand elsewhere than in the argument of a sine or cosine, times a whole number.

    After a whole turn of any other, all of the equations are the same.
    """
    stack = [x for x in equations if type(x) is Node]
    seen = {*stack}
    while stack:
        x = stack.pop()
        inside: Iterable[Scalar | None] = x.args
        if x.op in ("sin", "cos"):
            terms = linear_terms(x.args[0])
            inside = (a for a, c in terms.items() if a is not None and (a.op != "symbol" or type(c) is not int))
        for a in inside:
            if type(a) is Node and a not in seen:
                seen.add(a)
                stack.append(a)
    return frozenset(x for x in seen if x.op == "symbol")
