"""Small motions -> motions near their reference, by differences of the equations of motion.

A motion starts at q_0 + h d, u_0 + h e, inputs w_0 + h f; the equations of motion say how it goes on. The elimination
of constraints and derivatives are not used.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.linearization import NAME, SmallMotions
from eomgen.proof.degrees_of_freedom import Going, Nearby, Numbers50
from eomgen.proof.states import STEP
from eomgen.symbolic.expression import Node, Vector
from eomgen.symbolic.numeric import fifty_digits

DigitColumn = Sequence[Any]


@dataclass(frozen=True)
class MotionDifference:
    """Difference of one motion from the reference motion, divided by h.

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
    """Meaning of a label of a small rotation.

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
    """Motions near the reference of small motions.

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
        """The reference, its constraints closed to 50 digits."""
        return self.nearby.going(self.nearby.state({}))

    @property
    def _turns(self) -> dict[Node, SmallTurn]:
        """Small rotation for each of its labels among the coordinates."""
        return self._named(self.small.whole.coordinates, "")

    @property
    def _spins(self) -> dict[Node, SmallTurn]:
        """Small rotation for each of its labels among the speeds: rates of rotations about fixed axes."""
        return self._named(self.small.whole.speeds, "'")

    def _named(self, labels: Sequence[Node], prime: str) -> dict[Node, SmallTurn]:
        system, known = self.small.reference.system, dict[str, SmallTurn]()
        speeds = {u.name: u for u in system.symbols.u}
        for four, part in zip(system.scope.quaternions, system.scope.model.quaternions, strict=True):
            own = tuple(speeds[name] for name in part.speeds if name in speeds)
            for axis, name in enumerate(part.speeds):
                known[f"{NAME}{name}{prime}"] = SmallTurn(four, own, axis, standing=False)
                known[f"{NAME}{'xyz'[axis]}_{part.body}{prime}"] = SmallTurn(four, own, axis, standing=True)
        own_names = {*system.symbols.x}
        return {label: known[label.name] for label in labels if label not in own_names}

    @property
    def moved(self) -> tuple[Node, ...]:
        """Every coordinate that carries the motion, those that are not requested too."""
        return tuple(x for x in self.small.whole.coordinates if x not in self.small.left_out)

    @property
    def is_part(self) -> bool:
        """True if only a part of the coordinates was requested."""
        return len(self.small.numbers.coordinates) < len(self.moved)

    def along(self, step: Mapping[Node, Any], h: Any = STEP) -> MotionDifference:
        """The central difference in the direction of a step of coordinates, small turns, speeds and inputs."""
        late, early = (self.nearby.going(self.nearby.state(self._moved(step, sign * h))) for sign in (1, -1))
        e = self.small.numbers
        q, q1, q2 = ([(x - y) / (2 * h) for x, y in zip(*each, strict=True)] for each in self._read(late, early))
        both = [[self._speed(going, node) for node in e.speeds] for going in (late, early)]
        u, a = ([(x[k] - y[k]) / (2 * h) for x, y in zip(*both, strict=True)] for k in (0, 1))
        return MotionDifference(q, q1, q2, u, a, [step.get(w, 0) for w in e.inputs])

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
            v = [step.get(label, 0) * h for label, own in self._spins.items() if own.four == turn.four]
            w = _turned(_conjugate([here[e] for e in turn.four]), v)
            given |= {x: here[x] + d for x, d in zip(turn.speeds, w, strict=True)}
        return given

    def _speed(self, going: Going, label: Node) -> tuple[Any, Any]:
        """Speed and its rate; about fixed axes R_0 w, and R_0 (w_0 x w + w')."""
        if label not in self._spins:
            return going.state[label], going.a[label]
        turn = self._spins[label]
        w, rate, before = (Vector(way[x] for x in turn.speeds) for way in (going.state, going.a, self.origin.state))
        e_0 = [self.origin.state[e] for e in turn.four]
        return _turned(e_0, w)[turn.axis], _turned(e_0, before.cross(w) + rate)[turn.axis]

    def _read(self, late: Going, early: Going) -> Iterator[tuple[DigitColumn, DigitColumn]]:
        """Values of the printed coordinates, and their first and second time derivatives."""
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

    def _rates(self, state: Numbers50) -> Going:
        """Rates of the coordinates at a state; accelerations are not needed."""
        symbols, scope = self.nearby.equations.symbols, self.nearby.equations.system.scope
        q1 = dict(zip(symbols.q, self.nearby.at(scope.rates, state), strict=True)) | dict.fromkeys(symbols.z, 0)
        return Going(state, q1, dict.fromkeys(symbols.places, 0), dict.fromkeys(symbols.u, 0))


def _product(a: DigitColumn, b: DigitColumn) -> list[Any]:
    """Product of two quaternions."""
    a0, a1, a2, a3 = a
    b0, b1, b2, b3 = b
    return [
        a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3,
        a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2,
        a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1,
        a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0,
    ]


def _turned(e: DigitColumn, v: Sequence[Any]) -> list[Any]:
    """The vector e v e*, turned as the quaternion says."""
    return _product(_product(e, [0, *v]), _conjugate(e))[1:]


def _conjugate(e: DigitColumn) -> list[Any]:
    return [e[0], -e[1], -e[2], -e[3]]


def _unit(e: DigitColumn) -> list[Any]:
    size = fifty_digits().functions["sqrt"](sum(x * x for x in e))
    return [x / size for x in e]
