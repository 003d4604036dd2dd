"""Constraints -> start values of the coordinates that they determine, and the forks where branches of motion meet.

phi(q) = 0        dependent coordinates from their guesses, then the nearest place of all others
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Sequence
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints.closure import Closure, bilateral
from eomgen.mechanics.constraints.rank import Rank
from eomgen.mechanics.constraints.rows import Constraints, Row
from eomgen.mechanics.kinematics import Located
from eomgen.mechanics.state import Numbers
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    State,
    depends_on,
    gradient,
    jacobian,
    order,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import (
    Newton,
    NoValue,
    all_roots,
    evaluate,
    fifty_digits,
    lengths_of,
    of_one_length,
    tolerances,
)


@dataclass(frozen=True)
class Assembly:
    """Positions and speeds that constraints put together from those given, and places where branches of motion meet."""

    SEEDS = (11, 12)  # of values for parameters that have none: what is no closed form agrees at one of them by chance

    constraints: Constraints

    def begun_places(self) -> dict[Node, Scalar]:
        """Start values that the constraints change from the declared ones, in closed form or else in numbers.

        Raises:
            DerivationError: a value has no closed form, and parameters have no value.
        """
        scope, rows = self.constraints.motion.scope, self.constraints.gaps
        if not rows:
            return {}
        declared = scope.with_unit_quaternions(scope.start_values()) | {scope.symbols.t: 0}
        drawn = any(name not in scope.model.exact_parameters() for name in scope.symbols.parameters)
        states = [
            _assembled(self.constraints, declared, seed) for seed in (Assembly.SEEDS if drawn else Assembly.SEEDS[:1])
        ]
        moved = [q for q in scope.symbols.q if any(_differs(declared[q], q, state) for state in states)]
        if not moved:
            return {}
        known = {x: value for x, value in declared.items() if x not in moved}
        equations = [x for x in substituted(rows, known) if depends_on(x, moved)]
        located = [Located({x: float(value) for x, value in state.items()}, scope.positive) for state in states]
        found = located[0].places(equations, moved)
        exact = {q: x for q, x in found.items() if q in moved and all(each.agrees(x, q) for each in located)}
        left = [q for q in moved if q not in exact or depends_on(exact[q], moved)]
        if left and drawn:
            what = f"the start of '{left[0].name}' has no closed form, and no number while parameters have no value"
            raise DerivationError(what, f"coordinates.{left[0].name}", "give the parameters values")
        return exact | {q: Fraction(str(states[0][q])) for q in left}

    def opened(
        self, pairs: Iterable[tuple[Row, Scalar | None]], symbols: Sequence[Node], state: State
    ) -> tuple[Constraints, tuple[str, ...]]:
        """(the constraints that stay, those of them of which a scalar ought to be zero and is not)."""
        named = ((row, x) for row, x in pairs if x is not None)
        apart = tuple(dict.fromkeys(row.constraint for row, x in named if open_by(x, symbols, state)))
        staying = self.that_stay(apart)
        return staying, tuple(name for name in apart if any(row.constraint == name for row in staying.rows))

    def with_gaps_closed(self, state: State, called: frozenset[str]) -> tuple[State, tuple[str, ...]]:
        """(the nearest state in which positions agree with the constraints, the constraints that did not hold).

        Args:
            called: coordinates whose start a person typed, or a caller gave: these are moved last.
        """
        scope = self.constraints.motion.scope
        pairs = ((row, row.gap) for row in self.constraints.rows if not row.identical)
        staying, opened = self.opened(pairs, scope.symbols.q, state)
        if not opened:
            return state, ()
        standing, sought = set(symbols_of(staying.gaps)), self.constraints.fixed_by_position
        own = [
            q
            for q in scope.symbols.q
            if q in standing and q not in sought and not scope.model.coordinates[q.name].driven
        ]
        silent, given, typed = self.tiers(own, called)
        return Closure(staying).nearest_places(
            state, ([*sought, *silent], given, typed), (*sought, *silent)
        ) or state, opened

    def that_stay(self, apart: Sequence[str]) -> Constraints:
        """All constraints but the contacts that are open and may be so."""
        ending = [contact.name for contact in self.constraints.motion.scope.model.contacts if contact.unilateral]
        return bilateral(self.constraints, ending, [name for name in ending if name not in apart])

    def fork_at(self, state: State) -> Fork | None:
        """The fork at a state where the rank of the constraint rows is less than elsewhere; None where it is not.

        Raises:
            MissingValues, DerivationError: the constraints cannot be satisfied near.
        """
        if not self.constraints.closing or not self.constraints.motion.scope.symbols.u:
            return None
        J = _matrix(self.constraints, state)
        lengths = lengths_of(J, 1, keepdims=True)
        U, sizes, _ = np.linalg.svd(of_one_length(J))
        here = int(np.sum(sizes > tolerances.RANK))
        if here == len(self.constraints.closing):
            return None
        more = Rank(self.constraints).rank() - here
        if more <= 0:
            return None
        shares = np.max(np.abs(U[:, here:]), axis=1)
        names = dict.fromkeys(
            row.constraint
            for row, share in zip(self.constraints.closing, shares, strict=True)
            if share > tolerances.SHARE
        )
        return Fork(tuple(names), more, U[:, here:].T / np.where(lengths > 0, lengths, 1.0).T)

    def leads_on(self, fork: Fork, state: State) -> bool:
        """True if accelerations exist with these speeds: J a + gamma = 0."""
        return bool(_Search(self.constraints, fork, state, ()).size(np.zeros(0)) <= tolerances.CARRIED)

    def is_at_rest(self, state: State) -> bool:
        """True if all speeds are 0 in the state."""
        return all(abs(state[u]) <= tolerances.SOLVED for u in self.constraints.motion.scope.symbols.u)

    def speeds_along(self, fork: Fork, state: State, tiers: Sequence[Sequence[Node]]) -> dict[Node, Any] | None:
        """The state with the nearest speeds that lead along a branch; None where none is found.

        Args:
            tiers: what may move, each with those before it.
        """
        free: list[Node] = []
        for tier in tiers:
            free += tier
            if tier:
                found = _Search(self.constraints, fork, state, tuple(free)).nearest()
                if found is not None:
                    return {**state, **{u: state[u] + float(d) for u, d in zip(free, found, strict=True)}}
        return None

    def tiers(self, own: Sequence[Node], called: frozenset[str]) -> tuple[list[Node], list[Node], list[Node]]:
        """Coordinates or speeds in the order in which they may change: not given, given by the model, by the caller."""
        model = self.constraints.motion.scope.model
        silent = [node for node in own if node.name not in called and model.is_guess(node.name)]
        typed = [node for node in own if node.name in called]
        return silent, [node for node in own if node not in silent and node not in typed], typed


def _assembled(constraints: Constraints, declared: dict[Node, Scalar], seed: int) -> State:
    """A state at t = 0 in which positions agree with the constraints."""
    scope = constraints.motion.scope
    state, guesses = Closure(constraints).still(Random(seed))
    state = state | dict(zip(declared, evaluate(tuple(declared.values()), state, fifty_digits()), strict=True))
    sought = constraints.fixed_by_position
    state |= {q: fifty_digits().number(guesses[q.name]) for q in sought}
    state = (Closure(constraints).closed(state, sought) or state) if sought else state
    called = frozenset(q.name for q in scope.symbols.q if scope.model.is_typed(q.name))
    return Assembly(constraints).with_gaps_closed(state, called)[0]


def _differs(declared: Scalar, q: Node, state: State) -> bool:
    """True if a coordinate differs from its declared start."""
    before = float(evaluate((declared,), state, fifty_digits())[0])
    return abs(float(state[q]) - before) > tolerances.COMPUTED * (1 + abs(before))


def open_by(x: Scalar, symbols: Sequence[Node], state: State) -> float:
    """|x|, where it is more than rounding: against its terms, and against what the symbols would have to move."""
    try:
        slopes = evaluate(gradient(x, symbols), state, fifty_digits())
        value, terms = _value_and_terms(x, state)
    except (NoValue, ZeroDivisionError):
        return float("inf")
    steepest = float(max((abs(slope) for slope in slopes), default=0))
    return value if value > tolerances.OPEN_GAP * terms and value > tolerances.COMPUTED * steepest else 0.0


def _value_and_terms(x: Scalar, state: State) -> tuple[float, float]:
    """(|x|, the same with every sum taken of absolute values): how large the terms are that cancel."""
    nodes = order((x,))
    values = dict(zip(nodes, evaluate(nodes, state, fifty_digits()), strict=True))
    terms = {node: abs(value) for node, value in values.items()}
    for node in nodes:
        if node.op in _OF_TERMS:
            terms[node] = _OF_TERMS[node.op](
                *(terms[a] if type(a) is Node else abs(fifty_digits().number(a)) for a in node.args)
            )
    return (float(abs(values[x])), float(terms[x])) if type(x) is Node else (abs(float(x)), 0.0)


_OF_TERMS: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.add,
    "mul": operator.mul,
    "neg": operator.pos,
}


# -------- bifurcations ----------------------------------------------------------------------------------------
# Constraints, a state -> whether branches meet there, and speeds that lead along one of them.
#
# Where rank J falls below its value elsewhere (a change point) more speeds satisfy J u + sigma = 0 than lead
# anywhere: accelerations with J a + gamma = 0 must exist too,
#
#     n^T gamma(u) = 0   for every n with n^T J = 0.


TRIES = 12  # places from which they are sought
ALONG_A_BRANCH = Newton(enough=tolerances.SOLVED, steps=50, smallest=tolerances.RANK)


@dataclass(frozen=True)
class Fork:
    """A position in which branches meet.

    Args:
        constraints: those whose rows depend on one another there alone.
        more: degrees of freedom that the constraints leave beyond those that they leave elsewhere.
        left: n, one a row.
    """

    constraints: tuple[str, ...]
    more: int
    left: np.ndarray

    @property
    def words(self) -> str:
        names = ", ".join(f"'{name}'" for name in self.constraints)
        do = "does" if len(self.constraints) == 1 else "do"
        return f"a change point, where {names} {do} not determine the motion"


@dataclass(frozen=True)
class _Search:
    """Newton's method for J u + sigma = 0, n^T gamma(u) = 0 in some of the speeds."""

    constraints: Constraints
    fork: Fork
    state: State
    free: tuple[Node, ...]

    def nearest(self) -> np.ndarray | None:
        """The least change of the free speeds that is found."""
        rng = Random(1)
        reach = max([1.0, *(abs(float(self.state[u])) for u in self.constraints.motion.scope.symbols.u)])
        starts = [np.zeros(len(self.free))]
        starts += [reach * np.array([rng.uniform(-1, 1) for _ in self.free]) for _ in range(TRIES)]
        found = all_roots(self._reached, starts, lambda d: float(np.linalg.norm(d)))
        return found[0] if found else None

    def _reached(self, start: np.ndarray) -> np.ndarray | None:
        root = ALONG_A_BRANCH.root(self, start)
        return root.x if root.met else None

    def size(self, d: np.ndarray) -> float:
        """Largest residual of both equations, relative to the size of the terms."""
        return float(np.max(np.abs(self.left(d)), initial=0.0))

    def left(self, d: np.ndarray) -> np.ndarray:
        """Both equations, each against the size of its terms."""
        f, sizes = self._left(d)
        return np.asarray(f / sizes)

    def slopes(self, d: np.ndarray) -> np.ndarray:
        """Their derivatives by the free speeds."""
        return np.asarray(self._slope(d) / self._left(d)[1][:, None])

    def moved(self, d: np.ndarray, step: Sequence[Any]) -> np.ndarray:
        return np.asarray(d + np.array(step, dtype=float))

    def _left(self, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(J u + sigma above n^T gamma, the size of the terms of each)."""
        k = len(self.constraints.closing)
        values = self._at(d, (*(row.velocity for row in self.constraints.closing), *self.constraints.gamma))
        u = np.array([float(self._moved(d)[x]) for x in self.constraints.motion.scope.symbols.u])
        J, fastest = np.abs(_matrix(self.constraints, self.state)), np.max(np.abs(u), initial=0.0)
        of_speed = max(np.max(J @ np.abs(u), initial=0.0), np.max(np.abs(values[:k]), initial=0.0), tolerances.TINIEST)
        own = np.abs(self.fork.left) @ (np.abs(values[k:]) + np.max(J, initial=0.0) * fastest**2)
        f = np.append(values[:k], self.fork.left @ values[k:])
        return f, np.append(np.full(k, of_speed), np.maximum(own, tolerances.TINIEST))

    def _slope(self, d: np.ndarray) -> np.ndarray:
        k = len(self.constraints.closing)
        rows: tuple[Scalar, ...] = (*(row.velocity for row in self.constraints.closing), *self.constraints.gamma)
        flat = tuple(x for row in jacobian(rows, self.free) for x in row)
        slope = self._at(d, flat).reshape(2 * k, len(self.free))
        return np.vstack([slope[:k], self.fork.left @ slope[k:]])

    def _moved(self, d: np.ndarray) -> State:
        return {**self.state, **{u: self.state[u] + float(x) for u, x in zip(self.free, d, strict=True)}}

    def _at(self, d: np.ndarray, scalars: Sequence[Scalar]) -> np.ndarray:
        return np.array(Numbers(self._moved(d)).of(scalars))


def _matrix(constraints: Constraints, state: State) -> np.ndarray:
    return Numbers(state).array(constraints.J, len(constraints.motion.scope.symbols.u))
