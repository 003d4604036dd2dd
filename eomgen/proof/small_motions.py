"""Modes -> checks of small motions: the printed matrices against differences of the equations of motion.

A motion beside the reference starts at q_0 + h d, u_0 + h e, inputs w_0 + h f in a random direction; the equations of
motion say how it goes on. What it does against the reference, over h, must satisfy what is printed:

    M dq'' + C dq' + K dq = B dw,      or  M du' + C du + K dq = B dw,  dq' = F dq + E du,      x' = A x + B_x w

M against the kinetic energy: d . M d is the second difference of T along d. Shared with what is proven: the state of
the reference, the equations of motion (proven by themselves) and the choice of coordinates; no derivative, nothing of
how ties are taken out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import product
from random import Random
from typing import Any

import numpy as np

from eomgen.mechanics.small_motions.linearization import SmallMotions
from eomgen.mechanics.small_motions.modes import Modes
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.mechanics.small_motions.spin_axes import NAME
from eomgen.model.joints.orientation import rotation_of
from eomgen.model.quaternions import quaternions_of
from eomgen.proof.check import Check, checked, unchecked
from eomgen.proof.in_numbers import STEP
from eomgen.proof.modes import mode_checks
from eomgen.proof.nearby import Going, Nearby, State
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.spatial import Matrix, apply, cross, plus, transposed, vector_of
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import (
    CARRIED,
    COMPUTED,
    DIFFERENCE_AT_50,
    ROUNDING,
    SLOW,
    ZERO_AT_50,
)

DIRECTIONS = 3  # random ones: a wrong entry is seen by each of them
BY_DIFFERENCES = "differences at 50 digits"

DigitColumn = Sequence[Any]


@dataclass(frozen=True)
class Beside:
    """What one motion does against the reference, over h.

    Args:
        q, q1, q2: of the coordinates that are printed, and their first and second rates.
        u, a: of the speeds and their rates.
        w: of the inputs.
    """

    q: DigitColumn
    q1: DigitColumn
    q2: DigitColumn
    u: DigitColumn
    a: DigitColumn
    w: DigitColumn


@dataclass(frozen=True)
class SmallTurn:
    """What a label of a small turn stands for.

    Args:
        four: the quaternion.
        speeds: its angular velocity, body axes.
        axis: 0, 1 or 2.
        standing: whether of axes that stand still; else of the body's own.
    """

    four: tuple[Node, ...]
    speeds: tuple[Node, ...]
    axis: int
    standing: bool


@dataclass(frozen=True)
class Differences:
    """Motions beside the reference of small motions.

    Args:
        small: the small motions.
    """

    small: SmallMotions

    @cached_property
    def nearby(self) -> Nearby:
        small, symbols = self.small, self.small.reference.system.symbols
        turned = {e for turn in self._turns.values() for e in turn.four}
        q = tuple(x for x in symbols.q if x in small.whole.coordinates or x in turned)
        first, numbers = small.first, small.reference.numbers
        named = {label: turn.speeds[turn.axis] for label, turn in self._spins.items()}
        u = tuple(named.get(x, x) for x in small.whole.speeds)
        return Nearby(first.equations, first.relations, numbers, q, u)

    @cached_property
    def origin(self) -> Going:
        """The reference, its ties closed to 50 digits."""
        return self.nearby.going(self.nearby.state({}))

    @cached_property
    def _turns(self) -> dict[Node, SmallTurn]:
        """What each label of a small turn among the coordinates stands for."""
        return self._named(self.small.whole.coordinates, "")

    @cached_property
    def _spins(self) -> dict[Node, SmallTurn]:
        """The same of the speeds: rates of turns about axes that stand still."""
        return self._named(self.small.whole.speeds, "'")

    def _named(self, labels: Sequence[Node], prime: str) -> dict[Node, SmallTurn]:
        system, known = self.small.reference.system, dict[str, SmallTurn]()
        speeds = {u.name: u for u in system.symbols.u}
        for four, part in zip(system.scope.quaternions, quaternions_of(system.scope.model), strict=True):
            own = tuple(speeds[name] for name in part.speeds if name in speeds)
            for axis, name in enumerate(part.speeds):
                known[f"{NAME}{name}{prime}"] = SmallTurn(four, own, axis, standing=False)
                known[f"{NAME}{'xyz'[axis]}_{part.body}{prime}"] = SmallTurn(four, own, axis, standing=True)
        own_names = {*system.symbols.q, *system.symbols.u}
        return {label: known[label.name] for label in labels if label not in own_names}

    @cached_property
    def moved(self) -> tuple[Node, ...]:
        """Every coordinate that carries the motion, those that are not asked too."""
        return tuple(x for x in self.small.whole.coordinates if x not in self.small.left_out)

    @property
    def is_part(self) -> bool:
        """Whether not all of them were asked."""
        return len(self.small.numbers.coordinates) < len(self.moved)

    def along(self, step: Mapping[Node, Any], h: Any = STEP) -> Beside:
        """The central difference in the direction of a step of coordinates, small turns, speeds and inputs."""
        late, early = (self.nearby.going(self.nearby.state(self._moved(step, sign * h))) for sign in (1, -1))
        e = self.small.numbers
        q, q1, q2 = ([(x - y) / (2 * h) for x, y in zip(*each, strict=True)] for each in self._read(late, early))
        both = [[self._speed(going, node) for node in e.speeds] for going in (late, early)]
        u, a = ([(x[k] - y[k]) / (2 * h) for x, y in zip(*both, strict=True)] for k in (0, 1))
        return Beside(q, q1, q2, u, a, [step.get(w, 0) for w in e.inputs])

    def _moved(self, step: Mapping[Node, Any], h: Any) -> dict[Node, Any]:
        """Independent coordinates, speeds and inputs h further along the step."""
        here = self.origin.state
        given = {x: here[x] + h * d for x, d in step.items() if x not in self._turns and x not in self._spins}
        for four in {turn.four for turn in self._turns.values()}:
            mine = {label: turn for label, turn in self._turns.items() if turn.four == four}
            arm, e = (1, *(step.get(label, 0) * h / 2 for label in mine)), [here[e] for e in four]
            standing = any(turn.standing for turn in mine.values())
            given |= dict(zip(four, _unit(_product(arm, e) if standing else _product(e, arm)), strict=True))
        for turn in {turn.four: turn for turn in self._spins.values()}.values():
            v = vector_of(step.get(label, 0) * h for label, own in self._spins.items() if own.four == turn.four)
            w = apply(transposed(self._axes(turn)), v)
            given |= {x: here[x] + d for x, d in zip(turn.speeds, w, strict=True)}
        return given

    def _axes(self, turn: SmallTurn) -> Matrix:
        """R of the reference."""
        return rotation_of("quaternion", tuple(self.origin.state[e] for e in turn.four))

    def _speed(self, going: Going, label: Node) -> tuple[Any, Any]:
        """A speed and its rate; about axes that stand still R_0 w, and R_0 (w_0 x w + w')."""
        if label not in self._spins:
            return going.state[label], going.a[label]
        turn = self._spins[label]
        w, rate, before = (vector_of(way[x] for x in turn.speeds) for way in (going.state, going.a, self.origin.state))
        R = self._axes(turn)
        return apply(R, w)[turn.axis], apply(R, plus(cross(before, w), rate))[turn.axis]

    def _read(self, late: Going, early: Going) -> Iterator[tuple[DigitColumn, DigitColumn]]:
        """Of the coordinates that are printed where they are, and their first and second rates."""
        labels = self.moved if self.is_part else self.small.numbers.coordinates
        readings = [[self._one(going, label) for label in labels] for going in (late, early)]
        for order in range(3):
            yield tuple([each[order] for each in reading] for reading in readings)  # type: ignore[misc]

    def _one(self, going: Going, label: Node) -> tuple[Any, Any, Any]:
        """A coordinate and its rates; a small turn is 2 vec(e_0* e), about axes that stand still 2 vec(e e_0*), e_0 the
        quaternion of the reference."""
        if label not in self._turns:
            return going.state[label], going.q1[label], going.q2[label]
        turn = self._turns[label]
        four = turn.four
        at = [[way[e] for e in four] for way in (going.state, going.q1, going.q2)]
        home = [_conjugate([way[e] for e in four]) for way in (self.origin.state, self.origin.q1, self.origin.q2)]

        def part(i: int, j: int) -> Any:
            return 2 * (_product(at[j], home[i]) if turn.standing else _product(home[i], at[j]))[turn.axis + 1]

        return part(0, 0), part(1, 0) + part(0, 1), part(2, 0) + 2 * part(1, 1) + part(0, 2)

    def whole(self) -> Callable[[complex], np.ndarray]:
        """The answers of all coordinates to forces along them, by s."""
        small, n = self.small, len(self.moved)
        units = [self.along({x: 1}) for x in (*self.moved, *small.whole.speeds)]
        X, rate = (
            np.array([[float(x) for x in (*a, *b)] for a, b in pairs]).T
            for pairs in ([(each.q, each.q1) for each in units], [(each.q1, each.q2) for each in units])
        )
        A = np.linalg.solve(X.T, rate.T).T
        pushed = np.vstack([np.zeros((n, n)), np.linalg.inv(self._masses)])

        def answers(s: complex) -> np.ndarray:
            found: np.ndarray = np.linalg.solve(s * np.eye(2 * n) - A, pushed.astype(complex))[:n]
            return found

        return answers

    @property
    def _masses(self) -> np.ndarray:
        """The second derivative of T along the rates of the coordinates."""
        u = self.small.whole.speeds
        along = [[self.energy_along({x: 1, y: 1} if x is not y else {x: 1})[:2] for y in u] for x in u]
        square = [[float(one[0]) for one in row] for row in along]
        n = range(len(u))
        M = np.array(
            [[square[i][i] if i == j else (square[i][j] - square[i][i] - square[j][j]) / 2 for j in n] for i in n]
        )
        E = np.array([[float(x) for x in along[i][i][1]] for i in n]).T
        back = np.linalg.inv(E)
        found: np.ndarray = back.T @ M @ back
        return found

    def energy_along(self, step: Mapping[Node, Any]) -> tuple[Any, DigitColumn, DigitColumn]:
        """(second difference of T, the rates of coordinates and the speeds along a step of the speeds)."""
        T, e = self.small.first.equations.T, self.small.numbers
        ways = [self._rates(self.nearby.state(self._moved(step, sign))) for sign in (1, -1)]
        here, late, early = (self.nearby.at((T,), way.state)[0] for way in (self.origin, *ways))
        labels = self.moved if self.is_part else e.coordinates
        q1 = [
            (x - y) / 2 for x, y in zip(*([self._one(way, label)[1] for label in labels] for way in ways), strict=True)
        ]
        u = [
            (x - y) / 2
            for x, y in zip(*([self._speed(way, node)[0] for node in e.speeds] for way in ways), strict=True)
        ]
        return late + early - 2 * here, q1, u

    def _rates(self, state: State) -> Going:
        """The rates of the coordinates at a state; of accelerations nothing is asked."""
        symbols, scope = self.nearby.equations.symbols, self.nearby.equations.system.scope
        q1 = dict(zip(symbols.q, self.nearby.at(scope.rates, state), strict=True))
        return Going(state, q1, dict.fromkeys(symbols.q, 0), dict.fromkeys(symbols.u, 0))


def _product(a: DigitColumn, b: DigitColumn) -> list[Any]:
    """Of quaternions."""
    a0, a1, a2, a3 = a
    b0, b1, b2, b3 = b
    return [
        a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3,
        a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2,
        a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1,
        a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0,
    ]


def _conjugate(e: DigitColumn) -> list[Any]:
    return [e[0], -e[1], -e[2], -e[3]]


def _unit(e: DigitColumn) -> list[Any]:
    size = fifty_digits().functions["sqrt"](sum(x * x for x in e))
    return [x / size for x in e]


# -- the matrices --------------------------------------------------------------------------------------------------


def small_motion_checks(modes: Modes) -> Iterator[Check]:
    """Of the reference, the matrices, and the modes."""
    small = modes.small
    differences = Differences(small)
    try:
        yield _reference(differences)
        yield from _matrices(differences)
        if small.is_second_order:
            yield checked("C = D + G and K = S + H, D and S symmetric, G and H skew", _wrong_parts(modes), "50 digits")
        yield from mode_checks(modes)
    except (NoValue, ZeroDivisionError) as error:
        yield unchecked("small motions are those of the equations of motion", str(error), BY_DIFFERENCES)


def _reference(differences: Differences) -> Check:
    """Nothing is accelerated there; at rest nothing moves."""
    small, origin = differences.small, differences.origin
    A = abs(small.state_matrix)
    state = [abs(float(origin.state.get(x, 0))) for x in (*small.numbers.coordinates, *small.numbers.speeds)]
    usual = dict(zip(small.numbers.speeds, A[-len(small.numbers.speeds) :] @ np.maximum(1.0, state), strict=True))
    most = max(usual.values())
    wrong = [
        f"{u.name} changes by {float(origin.a[u]):.3g}"
        for u in differences.nearby.u
        if abs(origin.a[u]) > COMPUTED * (usual.get(u) or most) + ZERO_AT_50  # of one that nothing asks: the others
    ]
    name = "the equations of motion hold at the reference, without acceleration"
    return checked(name, "; ".join(wrong), "50 digits")


def _matrices(differences: Differences) -> Iterator[Check]:
    """M, C, K, B (F, E) and the state matrix."""
    small, rng = differences.small, Random(11)
    if differences.is_part:
        yield _of_part(differences)
        return
    exact, tolerance = _entries(small), DIFFERENCE_AT_50 if small.exact is not None else COMPUTED
    wrong: dict[str, str] = {"motion": "", "state": "", "mass": ""}
    for _ in range(DIRECTIONS):
        beside = differences.along(_random((*small.whole.coordinates, *small.whole.speeds, *small.whole.inputs), rng))
        wrong["motion"] = wrong["motion"] or _in_equations(small, exact, beside, tolerance)
        wrong["state"] = wrong["state"] or _in_state_form(small, beside)
        wrong["mass"] = wrong["mass"] or _in_energy(differences, exact["M"], rng, tolerance)
    form = "M q'' + C q' + K q = B w" if small.is_second_order else "M u' + C u + K q = B w, q' = F q + E u"
    yield checked(f"motions beside the reference satisfy {form}", wrong["motion"], BY_DIFFERENCES)
    yield checked("they satisfy x' = A x + B w", wrong["state"], BY_DIFFERENCES)
    yield checked("M is the second derivative of the kinetic energy along them", wrong["mass"], BY_DIFFERENCES)


def _of_part(differences: Differences) -> Check:
    """Of the coordinates that are asked alone: they answer to forces on them as they do in the whole.

    (s^2 M + s C + K)^-1 is their part of the first rows of (s 1 - A)^-1 [0; M^-1] of the whole, A and M by differences.
    """
    small, e = differences.small, differences.small.numbers
    asked = [differences.moved.index(q) for q in e.coordinates]
    whole = differences.whole()
    wrong = ""
    for s in (0.7 + 0.9j, -0.4 + 2.3j):
        s *= abs(small.state_matrix).max() ** 0.5 or 1.0
        pencil = sum((s**k * np.array(A, dtype=float) for k, A in enumerate((e.K, e.C, e.M))))
        answer = np.linalg.inv(pencil)
        away = abs(answer - whole(s)[np.ix_(asked, asked)]).max() / abs(answer).max()
        wrong = wrong or ("" if away <= CARRIED else f"their answers differ by {away:.2g}")
    return checked("the coordinates that are asked move as they do in the whole", wrong, "differences, floating point")


def _entries(small: SmallMotions) -> dict[str, list[list[Any]]]:
    """The printed matrices in numbers: exact ones with 50 digits."""
    e: LinearEquations = small.exact or small.numbers
    return {letter: _numbers(small, getattr(e, letter)) for letter in "MCKBFE"}


def _numbers(small: SmallMotions, rows: Sequence[Sequence[Any]]) -> list[list[Any]]:
    flat: Sequence[Any] = [x for row in rows for x in row]
    if small.exact is not None:
        flat = evaluate(tuple(flat), small.reference.trial, fifty_digits())
    values = iter(flat)
    return [[next(values) for _ in row] for row in rows]


def _wrong_parts(modes: Modes) -> str:
    """Which of the printed parts of C and K is not what its letter says, or ""."""
    small = modes.small
    whole, parts = _entries(small), {name: _numbers(small, A) for name, A in modes.symmetric_parts.items()}
    tolerance = ZERO_AT_50 if small.exact is not None else ROUNDING
    for letter, even, odd in (("C", "D", "G"), ("K", "S", "H")):
        for i, j in product(range(len(whole[letter])), repeat=2):
            (a, b), (c, d) = ((parts[name][i][j], parts[name][j][i]) for name in (even, odd))
            left = max(abs(a + c - whole[letter][i][j]), abs(a - b), abs(c + d))
            if left > tolerance * (abs(a) + abs(c)):
                return f"entry {i + 1}, {j + 1} of {even} or {odd}"
    return ""


def _random(nodes: Sequence[Node], rng: Random) -> State:
    return {x: fifty_digits().number(rng.choice((-1, 1)) * rng.randint(50, 100)) / 100 for x in nodes}


def _in_equations(small: SmallMotions, A: Mapping[str, list[list[Any]]], at: Beside, tolerance: float) -> str:
    u, a = (at.q1, at.q2) if small.is_second_order else (at.u, at.a)
    for i, speed in enumerate(small.numbers.speeds):
        terms = [*_terms(A["M"][i], a), *_terms(A["C"][i], u), *_terms(A["K"][i], at.q), *_terms(A["B"][i], at.w, -1)]
        if wrong := _left(terms, tolerance, sum(map(abs, A["M"][i]))):
            return f"the equation of {speed.name.rstrip(chr(39))}: {wrong}"
    for i, q in enumerate(small.numbers.coordinates):
        if wrong := _left([-at.q1[i], *_terms(A["F"][i], at.q), *_terms(A["E"][i], u)], tolerance):
            return f"the rate of {q.name}: {wrong}"
    return ""


def _in_state_form(small: SmallMotions, at: Beside) -> str:
    u, a = (at.q1, at.q2) if small.is_second_order else (at.u, at.a)
    names = [x.name for x in (*small.numbers.coordinates, *small.numbers.speeds)]
    rows = zip(names, small.state_matrix, small.input_matrix, (*at.q1, *a), strict=True)
    for name, row, push, rate in rows:
        if wrong := _left([-rate, *_terms(row, (*at.q, *u)), *_terms(push, at.w)], COMPUTED):
            return f"the row of {name}: {wrong}"
    return ""


def _in_energy(differences: Differences, M: list[list[Any]], rng: Random, tolerance: float) -> str:
    small = differences.small
    T, q1, u = differences.energy_along(_random(small.whole.speeds, rng))
    d = q1 if small.is_second_order else u
    return _left(
        [-T, *(x * y * m for x, row in zip(d, M, strict=True) for y, m in zip(d, row, strict=True))], tolerance
    )


def _terms(row: DigitColumn, x: DigitColumn, sign: int = 1) -> list[Any]:
    return [sign * a * b for a, b in zip(row, x, strict=True)]


def _left(terms: DigitColumn, tolerance: float, unit: Any = 1) -> str:
    """What is left of terms that cancel one another; "" where it is rounding, of them or of a rate of one unit."""
    left, size = sum(terms), sum(map(abs, terms))
    return (
        ""
        if abs(left) <= tolerance * (size + SLOW * unit)
        else f"{float(left):.3g} is left, of terms of {float(size):.3g}"
    )
