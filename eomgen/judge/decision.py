"""Scalars of a system -> whether they vanish, and of which equations an equation is a combination, decided.

At random exact states of a prime field; where roots or functions have no meaning there, at real states of 50 digits in
the model's own domain: parameters that are sizes positive, coordinates and speeds of either sign; on the constraints
where these restrict the coordinates. What no state decides stays undecided: nothing is taken for true that was not.
What vanishes with 50 digits is looked at once more in balls: a kinetic energy of 1e-293 J is small, and is not 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import Extent, System
from eomgen.mechanics.free_bodies import where_in_pieces
from eomgen.symbolic.exact import combined, combines
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    gradient,
    linear_terms,
    symbols_of,
)
from eomgen.symbolic.numeric import (
    ARRAYS,
    FLOAT,
    NoValue,
    evaluate,
    fifty_digits,
    tolerances,
)

REAL_STATES = 6  # where roots and sizes may hold on one side only: signs are shared out among so many
TRIES = 40
FEW_FAILED = 3  # after which those that fail are told beforehand
STEPS = 30  # of Newton's method to the constraints
NumberRow = list[Any]


@dataclass(frozen=True)
class Follows:
    """The result for an equation: whether it holds, where, and by which rows.

    Args:
        holds: yes, no, or None: no state decided it.
        rows: which of the rows stand in the combination, by their places.
        way: "prime field" or "50 digits".
        on_constraints: it holds only where the constraints do.
        held: of what has pieces and does not hold in all of them, in which it does, where that was requested.
    """

    holds: bool | None
    rows: tuple[int, ...] = ()
    way: str = ""
    on_constraints: bool = False
    held: Extent = Extent(False)


def combination(
    system: System,
    row: Sequence[Scalar],
    rows: Sequence[Sequence[Scalar]],
    constrained: Sequence[Sequence[Scalar]] = (),
    *,
    within: bool = False,
) -> Follows:
    """True if a row is a combination of others, with functions of the state as factors, in every piece of the model.

    Args:
        row: its entries, scalars of the system's graph; with no others it is decided whether they vanish.
        constrained: further rows, which hold on the constraints alone: apart from these redundant ones contradict one
            another.
        within: the pieces are sought in which it does, of what does not hold in all.
    """
    found = _at_random(system, row, rows, constrained)
    if found.holds is not True and not (within and found.holds is False):
        return found
    held = _in_pieces(system, row, rows, constrained, on_constraints=found.on_constraints)
    if held is None or (held.everywhere and found.holds):
        return found
    return Follows(False, (), found.way, held=Extent(False) if held.everywhere else held)


def _in_pieces(
    system: System,
    row: Sequence[Scalar],
    rows: Sequence[Sequence[Scalar]],
    constrained: Sequence[Sequence[Scalar]],
    *,
    on_constraints: bool,
) -> Extent | None:
    """The pieces in which it is one; None: there are no pieces, or not all are known."""
    flat = [x for each in (row, *rows, *(constrained if on_constraints else ())) for x in each]
    width = len(row)

    def holds(there: Sequence[Scalar], inside: Mapping[Node, Any]) -> bool:
        table = [there[k : k + width] for k in range(0, len(there), width)]
        if not on_constraints:
            return _at_random(system, table[0], table[1:], ()).holds is True
        state = _at_constrained_speeds(system, dict(inside))
        if state is None:
            return True  # nothing contradicts it
        try:
            values = evaluate(there, state | _others(there, state), fifty_digits())
        except (NoValue, ZeroDivisionError):
            return True
        numbers = [values[k : k + width] for k in range(0, len(values), width)]
        return combines(numbers[0], numbers[1:])

    return where_in_pieces(system, flat, holds)


def _others(scalars: Sequence[Scalar], state: Mapping[Node, Any]) -> dict[Node, Any]:
    """Values of symbols that stand in scalars, and in no state of the system."""
    rng = Random(12)
    return {x: fifty_digits().number(_rational(rng.uniform(0.3, 2))) for x in symbols_of(scalars) if x not in state}


def _at_random(
    system: System, row: Sequence[Scalar], rows: Sequence[Sequence[Scalar]], constrained: Sequence[Sequence[Scalar]]
) -> Follows:
    """The same at random states."""
    if not row:
        return Follows(True)
    flat = [x for each in (row, *rows) for x in each]
    exact = combined(row, rows)
    found = Follows(exact.holds, exact.rows, exact.way)
    if found.holds is None:
        found = _combined_in_digits(system, row, rows, flat, on_constraints=False)
    closes = bool(system.constraints.J or _gaps(system, flat))
    if found.holds is True or not closes:
        return found
    flat += [x for each in constrained for x in each]
    held = _combined_in_digits(system, row, (*rows, *constrained), flat, on_constraints=True)
    return replace(held, on_constraints=held.holds is True)


def is_zero_everywhere(system: System, *scalars: Scalar) -> Follows:
    """True if the scalars are 0 at every state."""
    return combination(system, scalars, ())


def vanish_at(scalars: Sequence[Scalar], numbers: Mapping[Node, float]) -> bool | None:
    """True if scalars are 0 at one state whose numbers are rounded; None: one has no value there.

    |f| is held against sum |x df/dx|, what the numbers' last digits make of it.
    """
    state = {x: fifty_digits().number(Fraction(value)) for x, value in numbers.items()}
    held = [x for x in symbols_of(scalars) if x in state]
    if len(held) < len(symbols_of(scalars)):
        return None
    try:
        for f in scalars:
            value, *slopes = evaluate((f, *gradient(f, held)), state, fifty_digits())
            if abs(value) > tolerances.CARRIED * sum(
                abs(state[x] * slope) for x, slope in zip(held, slopes, strict=True)
            ):
                return False
    except (NoValue, ZeroDivisionError):
        return None
    return True


def vanish_nearly(system: System, scalars: Sequence[Scalar]) -> bool:
    """True if scalars that hold rounded numbers are 0 at real states on the constraints, measured by their terms."""
    arithmetic, found = fifty_digits(), 0
    for state in states_of(system, scalars, on_constraints=bool(system.constraints.J or _gaps(system, scalars))):
        try:
            for f in scalars:
                terms = linear_terms(f)
                value, *parts = evaluate((f, *(1 if x is None else x for x in terms)), state, arithmetic)
                if abs(value) > tolerances.CARRIED * sum(
                    abs(x * k) for x, k in zip(parts, terms.values(), strict=True)
                ):
                    return False
        except (NoValue, ZeroDivisionError):
            continue
        found += 1
        if found == REAL_STATES:
            return True
    return False


def linear_row(x: Scalar, symbols: Sequence[Node]) -> tuple[ScalarRow, bool]:
    """(slopes by the symbols and what is left where they are 0, whether it is linear in them)."""
    from eomgen.symbolic.expression import depends_on, substituted

    slopes = gradient(x, symbols)
    linear = not any(depends_on(slope, symbols) for slope in slopes)
    (rest,) = substituted((x,), dict.fromkeys(symbols, 0))
    return (*slopes, rest), linear


def _combined_in_digits(
    system: System,
    row: Sequence[Scalar],
    rows: Sequence[Sequence[Scalar]],
    flat: Sequence[Scalar],
    *,
    on_constraints: bool,
) -> Follows:
    """The same at real states."""
    moved = {*system.symbols.x} if on_constraints else set[Node]()
    states = partial(states_of, system, flat, on_constraints=on_constraints)
    found = combined(row, rows, states, moved)
    return Follows(found.holds, found.rows, found.way)


# -- states --------------------------------------------------------------------------------------


def states_of(
    system: System, flat: Sequence[Scalar] = (), *, on_constraints: bool, seed: int = 11
) -> Iterator[dict[Node, Any]]:
    """Random real states of a system with 50 digits, near the values of its file at first, then further away.

    Args:
        flat: whose other symbols get values too.
        on_ties: coordinates and speeds are such that the constraints hold.
    """
    if not on_constraints:
        yield from _drawn(system, flat, seed)
        return
    gaps, failed, hopeful = _gaps(system, flat), 0, [True] * TRIES
    key = (states_of, seed, system.symbols.t in symbols_of(flat), tuple(_others_in(system, flat)))
    for attempt, state in enumerate(_drawn(system, flat, seed, near=True)):
        if not hopeful[attempt]:
            continue
        if (*key, attempt) not in system.found:  # the key is all that the state depends on
            system.found[*key, attempt] = _constrained(system, state, gaps)
        if (closed := system.found[*key, attempt]) is not None:
            yield closed
        elif (failed := failed + 1) == FEW_FAILED:
            hopeful = _closing(system, [*_drawn(system, flat, seed, near=True)], gaps)


def _drawn(system: System, flat: Sequence[Scalar], seed: int, *, near: bool = False) -> Iterator[dict[Node, Any]]:
    """The states before they are moved onto the constraints; near the start for these."""
    rng, symbols, arithmetic = Random(seed), system.symbols, fifty_digits()
    own = _own_values(system)
    known, others = _start(system, own), _others_in(system, flat)
    for attempt in range(TRIES):
        spread = 0.1 if near and attempt < TRIES // 2 else 0.6
        state: dict[Node, Any] = {}
        for x in symbols.parameters.values():
            size = own.get(x, 1.0) or 1.0
            sign = 1 if x in system.scope.positive or own.get(x, 1.0) > 0 else -1
            state[x] = sign * abs(size) * rng.uniform(1 - spread, 1 + spread)
        for q in symbols.q:
            start = known.get(q, 0.0)
            state[q] = start + rng.uniform(-0.2, 0.2) * (1 + abs(start)) if near else _either(rng, start, attempt)
        moving = (*symbols.u, *symbols.a, *symbols.lam, *symbols.inputs.values(), *symbols.unknowns.values())
        for k, x in enumerate(moving):
            state[x] = rng.uniform(0.3, 2) * _sign(k, attempt)
        state[symbols.t] = rng.uniform(0.1, 3)
        state |= {x: rng.uniform(0.3, 2) for x in others if x not in state}
        for four in system.scope.quaternions:
            norm = sum(state[e] ** 2 for e in four) ** 0.5
            state |= {e: state[e] / norm for e in four}
        exact = {x: arithmetic.number(_rational(value)) for x, value in state.items()}
        for four in system.scope.quaternions:
            length = arithmetic.functions["sqrt"](sum(exact[e] ** 2 for e in four))
            exact |= {e: exact[e] / length for e in four}
        yield exact


def _own_values(system: System) -> dict[Node, float]:
    """The values of the parameters of the file."""
    symbols = system.symbols.parameters
    return {symbols[name]: float(x) for name, x in system.scope.model.exact_parameters().items()}


def _others_in(system: System, flat: Sequence[Scalar]) -> list[Node]:
    """The symbols in scalars that are no coordinates with a start."""
    known = system.scope.start_values()
    return [x for x in symbols_of(flat) if x not in known]


def _closing(system: System, states: Sequence[Mapping[Node, Any]], gaps: Sequence[Scalar]) -> list[bool]:
    """True for each state from which Newton's method in doubles closes the gaps: with 50 digits it is slow to fail."""
    q, n = system.symbols.q, len(gaps)
    flat = [*gaps, *(x for gap in gaps for x in gradient(gap, q))]
    known = {x: np.array([float(state[x]) for state in states]) for x in states[0]}
    closes = np.zeros(len(states), dtype=bool)
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            values = np.array([np.broadcast_to(x, len(states)) for x in evaluate(flat, known, ARRAYS)], dtype=float)
            left, slopes = values[:n].T, values[n:].T.reshape(-1, n, len(q))
            closes |= np.all(np.abs(left) < tolerances.CARRIED, axis=1)
            moves = ~closes & np.isfinite(values).all(axis=0)
            if not moves.any():
                break
            step = np.zeros((len(states), len(q)))
            step[moves] = np.einsum("sqn,sn->sq", np.linalg.pinv(slopes[moves]), left[moves])
            known |= {x: known[x] - dx for x, dx in zip(q, step.T, strict=True)}
    return [bool(x) for x in closes]


def _sign(k: int, attempt: int) -> int:
    """+1 or -1, so that among eight states any two of seven symbols have all four pairs of signs."""
    return -1 if ((k % 7 + 1) & attempt).bit_count() % 2 else 1


def _either(rng: Random, near: float, attempt: int) -> float:
    """A coordinate: of the size at the start and of either sign, beyond a right angle, near the start itself."""
    if attempt % 4 == 3:
        return near + rng.uniform(-0.3, 0.3)
    if attempt % 4 == 1:
        return rng.uniform(1.7, 3.1) * max(1.0, abs(near)) * rng.choice((-1, 1))
    return rng.uniform(0.2, 1.6) * max(1.0, abs(near) / 2) * rng.choice((-1, 1))


def _rational(x: float) -> Any:
    return Fraction(x)


def _start(system: System, own: Mapping[Node, float]) -> dict[Node, float]:
    """The starts of coordinates that are given by numbers."""

    values = {**dict.fromkeys(system.symbols.parameters.values(), 1.0), **own, system.symbols.t: 0.0}
    found = {}
    for q, x in system.scope.start_values().items():
        value = evaluate((x,), values, FLOAT)[0] if not set(symbols_of((x,))) - values.keys() else 0.0
        found[q] = float(value) if value == value else 0.0
    return found


def _gaps(system: System, flat: Sequence[Scalar]) -> list[Scalar]:
    """Expressions of coordinates that vanish: on constraints, and by the laws of driven ones where time stands in the
    scalars too."""
    found = [row.gap for row in system.constraints.rows if row.gap is not None and not row.identical]
    if system.symbols.t in symbols_of(flat):
        driven = {q: system.scope.model.coordinates[q.name].motion for q in system.symbols.q}
        found += [q - system.scope.value(law) for q, law in driven.items() if law is not None]
    return found


def _constrained(system: System, state: dict[Node, Any], gaps: Sequence[Scalar]) -> dict[Node, Any] | None:
    """The state moved onto the constraints: first its coordinates, by Newton's method, then its speeds; None: it
    fails."""
    q, arithmetic = system.symbols.q, fifty_digits()
    slopes = [gradient(gap, q) for gap in gaps]
    flat = [*gaps, *(x for row in slopes for x in row)]
    state = dict(state)
    for _ in range(STEPS):
        try:
            values = evaluate(flat, state, arithmetic)
        except (NoValue, ZeroDivisionError):
            return None
        left = values[: len(gaps)]
        if max(map(abs, left), default=0) < tolerances.CLOSED_AT_50:
            return _at_constrained_speeds(system, state)
        matrix = [values[len(gaps) + k * len(q) : len(gaps) + (k + 1) * len(q)] for k in range(len(gaps))]
        step = _least_step(matrix, left)
        if step is None:
            return None
        state |= {x: state[x] - dx for x, dx in zip(q, step, strict=True)}
    return None


def _at_constrained_speeds(system: System, state: dict[Node, Any]) -> dict[Node, Any] | None:
    """The state with speeds that the constraint rows allow: J u + sigma = 0."""
    constraints, u = system.constraints, system.symbols.u
    if not constraints.J:
        return state
    try:
        values = evaluate([*(x for row in constraints.J for x in row), *constraints.sigma], state, fifty_digits())
    except (NoValue, ZeroDivisionError):
        return None
    n, k = len(u), len(constraints.J)
    rows, bias = [values[i * n : (i + 1) * n] for i in range(k)], values[k * n :]
    left = [b + sum(x * state[y] for x, y in zip(row, u, strict=True)) for row, b in zip(rows, bias, strict=True)]
    step = _least_step(rows, left)
    if step is None:
        return None
    return state | {x: state[x] - dx for x, dx in zip(u, step, strict=True)}


def _least_step(rows: list[NumberRow], left: NumberRow) -> NumberRow | None:
    """The least step that takes away what is left: J^T (J J^T)^-1 left, of the rows that are independent."""
    kept = _independent(np.array([[float(x) for x in row] for row in rows]))
    if not kept:
        return None
    square = [[sum(a * b for a, b in zip(rows[i], rows[j], strict=True)) for j in kept] for i in kept]
    solved = _solved([*square], [left[i] for i in kept])
    if solved is None:
        return None
    return [sum(rows[i][c] * y for i, y in zip(kept, solved, strict=True)) for c in range(len(rows[0]))]


def _independent(plain: np.ndarray) -> list[int]:
    """The rows that are no combination of those before them."""
    least = tolerances.COMPUTED * max(1.0, float(np.abs(plain).max(initial=0)))
    if len(plain) == 1:
        return [0] if math.hypot(*plain[0].tolist()) > least else []
    if np.linalg.matrix_rank(plain, tol=least) == len(plain):
        return [*range(len(plain))]
    kept: list[int] = []
    for k in range(len(plain)):
        if np.linalg.matrix_rank(plain[[*kept, k]], tol=least) == len(kept) + 1:
            kept.append(k)
    return kept


def _solved(matrix: list[NumberRow], right: NumberRow) -> NumberRow | None:
    """Linear equations in numbers of 50 digits."""
    rows = [[*row, b] for row, b in zip(matrix, right, strict=True)]
    n = len(rows)
    for k in range(n):
        best = max(range(k, n), key=lambda i: abs(rows[i][k]))
        if abs(rows[best][k]) < tolerances.CERTAIN_AT_50:
            return None
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(n):
            if i != k and rows[i][k]:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return [rows[k][n] / rows[k][k] for k in range(n)]
