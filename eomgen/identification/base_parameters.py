"""Y -> base parameters: the groups of parameters that the forces of motions tell apart.

The columns of Y at many states, one above the other, are W. Taken in order, a column that follows from those before
it is left out: W_j = sum K_ij W_i, and with it the parameter of each column i that stays becomes a group,

    pi_i + sum_j K_ij pi_j

Without closing ties the states are random points of a prime field: the rank is exact, and so is K, made of monomials
of the lengths of the model and then proven at further points. With closing ties the states keep the ties, with 50
digits, and W is what is left along the motions that they allow.
Source: Gautier & Khalil, Direct calculation of minimum set of inertial parameters of serial robots, 1990; Gautier,
Numerical calculation of the base inertial parameters of robots, 1991.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations_with_replacement
from math import isqrt
from random import Random
from typing import Any

import numpy as np

from eomgen.mechanics.constraints.closure import gaps_of, generic_state, movable, norms_of
from eomgen.mechanics.equations.system import System
from eomgen.model.values import exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.exact.equality import exact_state
from eomgen.symbolic.expression.derivative import jacobian, substituted, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow, State
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import PRIME, PRIME_FIELD, NoMeaning, NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import FOLLOWS_AT_50, ROUNDED_AWAY, SAME_EIGENVALUE

MORE = 6  # rows of W beyond its columns
FAR = (0.4,)  # from the start, of states at which columns are told apart: near to it they are nearly one
STEPS = 3  # of Newton's method from a root with 30 digits: each doubles them
MOST_LENGTHS = 8  # of a formula: more have too many monomials


@dataclass(frozen=True)
class Group:
    """A base parameter: one parameter of the model and what goes with it.

    Args:
        name: of the parameter that leads it.
        terms: of each parameter in it the factor, as a text in the model's lengths, else as a number.
        numbers: the factors for the model's own lengths.
    """

    name: str
    terms: dict[str, str]
    numbers: dict[str, float]

    @property
    def formula(self) -> str:
        """Izz(arm) + l^2*m(hand)"""
        pieces: list[str] = []
        for parameter, factor in self.terms.items():
            grouped = f"({factor})" if " " in factor else factor
            shown = parameter if factor == "1" else f"-{parameter}" if factor == "-1" else f"{grouped}*{parameter}"
            pieces.append(f"- {shown[1:]}" if pieces and shown.startswith("-") else f"+ {shown}" if pieces else shown)
        return " ".join(pieces)


@dataclass(frozen=True)
class BaseParameters:
    """What motions tell of the parameters.

    Args:
        groups: the base parameters, as many as the rank.
        without_effect: the parameters that no force depends on.
        arithmetic: in which the rank was found: "prime field" (exact) or "50 digits".
    """

    groups: tuple[Group, ...]
    without_effect: tuple[str, ...]
    arithmetic: str

    def __len__(self) -> int:
        return len(self.groups)

    def matrix(self, parameters: Sequence[str]) -> np.ndarray:
        """K of base = K pi, by the order of the parameters."""
        place = {name: j for j, name in enumerate(parameters)}
        K = np.zeros((len(self.groups), len(parameters)))
        for i, group in enumerate(self.groups):
            for name, factor in group.numbers.items():
                K[i, place[name]] = factor
        return K


def base_of(system: System, names: Sequence[str], rows: Sequence[ScalarRow], seed: int = 1) -> BaseParameters:
    """The base parameters of a regressor."""
    moving = [j for j in range(len(names)) if not all(is_zero(row[j]) for row in rows)]
    if system.ties.closing or system.scope.quaternions:
        return _in_digits(system, names, rows, moving, seed)
    try:
        return _in_field(system, names, rows, moving, seed)
    except (NoMeaning, NoValue, ValueError):  # a root, a sign or a curve that the field has no value of
        return _in_digits(system, names, rows, moving, seed)


def _in_field(
    system: System, names: Sequence[str], rows: Sequence[ScalarRow], moving: list[int], seed: int
) -> BaseParameters:
    """By random points of the prime field, exactly."""
    own = {system.symbols.parameters[name]: x for name, x in exact_parameters(system.scope.model).items()}
    values = {node: Fraction(x) for node, x in own.items()}
    entries = [rows[k][j] for k in range(len(rows)) for j in moving]
    W = _sampled(system, substituted(tuple(entries), values), len(moving), seed)
    kept, K = _echelon_form(W)
    lengths = [node for node in system.symbols.parameters.values() if node in set(symbols_of(entries))]
    texts: dict[tuple[int, int], str] = {}
    if lengths and len(lengths) <= MOST_LENGTHS:
        texts = _formulas(system, tuple(entries), lengths, kept, len(moving), seed)
    numbers = {place: _rational(x) for place, x in K.items()}
    return _grouped(names, moving, kept, numbers, texts, PRIME_FIELD.name)


def _sampled(system: System, entries: ScalarRow, width: int, seed: int, given: Any = None) -> list[list[int]]:
    """W modulo the prime: the entries at several states, in which the parameters are the same.

    The states are one: each has coordinates, speeds and accelerations of its own name.
    """
    symbols = system.symbols
    height = len(entries) // width
    copies = (width + MORE) // height + 2
    own = (symbols.t, *symbols.q, *symbols.u, *symbols.a)
    flat: list[Scalar] = []
    for k in range(copies):
        other = {x: symbols.graph.symbol(f"({x.name}, {k})") for x in own}
        flat += substituted(entries, other)
    state = exact_state(flat, Random(seed))
    values = {**state.values, **(given or {})}
    found = evaluate(flat, values, PRIME_FIELD)
    return [[int(x) % PRIME for x in found[i : i + width]] for i in range(0, len(found), width)]


def _echelon_form(W: Sequence[Sequence[int]]) -> tuple[list[int], dict[tuple[int, int], int]]:
    """(the columns that stay, K of the others by (column that stays, column)), modulo the prime."""
    left = [list(row) for row in W]
    kept: list[int] = []
    K: dict[tuple[int, int], int] = {}
    for j in range(len(left[0]) if left else 0):
        r = len(kept)
        pivot = next((i for i in range(r, len(left)) if left[i][j]), None)
        if pivot is None:
            K |= {(kept[i], j): left[i][j] for i in range(r) if left[i][j]}
            continue
        left[r], left[pivot] = left[pivot], left[r]
        inverse = pow(left[r][j], -1, PRIME)
        top = left[r] = [x * inverse % PRIME for x in left[r]]
        for i, row in enumerate(left):
            if i != r and row[j]:
                factor = row[j]
                left[i] = [(x - factor * y) % PRIME if y else x for x, y in zip(row, top, strict=True)]
        kept.append(j)
    return kept, K


def _rational(x: int) -> Fraction:
    """The fraction with small numerator and denominator that a residue is (Wang's algorithm)."""
    bound = isqrt(PRIME // 2)
    (a, b), (u, v) = (PRIME, x % PRIME), (0, 1)
    while b > bound:
        quotient = a // b
        (a, b), (u, v) = (b, a - quotient * b), (v, u - quotient * v)
    return Fraction(b, v)


def _formulas(
    system: System, entries: ScalarRow, lengths: list[Node], kept: list[int], width: int, seed: int
) -> dict[tuple[int, int], str]:
    """The entries of K as polynomials of second degree in the model's lengths; {} where other columns stay, or they
    are no such polynomials: proven at as many points more.
    """
    rng = Random(seed)
    monomials = [(), *((x,) for x in range(len(lengths))), *combinations_with_replacement(range(len(lengths)), 2)]
    points, found = [], []
    for k in range(len(monomials) + 2):
        point = [rng.randrange(1, PRIME) for _ in lengths]
        W = _sampled(system, entries, width, seed + k, dict(zip(lengths, point, strict=True)))
        own, K = _echelon_form(W)
        if own != kept:
            return {}
        points.append([_product(point, m) for m in monomials])
        found.append(K)
    texts: dict[tuple[int, int], str] = {}
    for place in {key for K in found for key in K}:
        rows = [[*row, K.get(place, 0)] for row, K in zip(points, found, strict=True)]
        own, solution = _echelon_form(rows)
        if len(monomials) in own:
            return {}
        factors = {j: _rational(x) for (j, last), x in solution.items() if last == len(monomials)}
        texts[place] = _polynomial([(factors[j], [lengths[i].name for i in monomials[j]]) for j in sorted(factors)])
    return texts


def _product(point: Sequence[int], places: Sequence[int]) -> int:
    value = 1
    for i in places:
        value = value * point[i] % PRIME
    return value


def _polynomial(terms: Sequence[tuple[Fraction, list[str]]]) -> str:
    pieces: list[str] = []
    for factor, names in terms:
        powers = [f"{name}^2" if names.count(name) == 2 else name for name in dict.fromkeys(names)]
        size = [] if abs(factor) == 1 and powers else [str(abs(factor))]
        text = "*".join([*size, *powers])
        sign = "-" if factor < 0 else "+"
        pieces.append(f"{sign} {text}" if pieces else f"-{text}" if sign == "-" else text)
    return " ".join(pieces) or "0"


def _in_digits(
    system: System, names: Sequence[str], rows: Sequence[ScalarRow], moving: list[int], seed: int
) -> BaseParameters:
    """By states that keep the ties, with 50 digits."""
    W = sampled_rows(system, rows, moving, seed)
    sizes = [max(map(abs, column)) for column in zip(*W, strict=True)]
    largest = max(sizes, default=0)
    scaled = np.array(W, dtype=object)
    for j, size in enumerate(sizes):
        scaled[:, j] = scaled[:, j] / size if size > ROUNDED_AWAY * largest else 0 * scaled[:, j]
    kept, K = _echelon_in_digits(scaled)
    numbers = {(i, j): float(x * sizes[j] / sizes[i]) for (i, j), x in K.items()}
    return _grouped(names, moving, kept, numbers, {}, "50 digits")


def sampled_rows(system: System, rows: Sequence[ScalarRow], columns: Sequence[int], seed: int) -> np.ndarray:
    """W at generic states that keep the ties, along the motions that these allow; 50 digits."""
    symbols, ties = system.symbols, system.ties
    size, rng, parts = len(rows), Random(seed), []
    entries = tuple(rows[k][j] for k in range(size) for j in columns)
    J = tuple(x for row in ties.J for x in row)
    have = 0
    while have < len(columns) + MORE:
        state = _closed_to_the_last_digit(system, generic_state(system.ties, rng, spreads=FAR))
        numbers = np.array(evaluate((*J, *ties.sigma), state, fifty_digits()), dtype=object)
        there, sigma = numbers[: len(J)].reshape(-1, size), numbers[len(J) :]
        along, u = _allowed(there, sigma, size, rng)
        state = state | dict(zip(symbols.u, u, strict=True))
        gamma = np.array(evaluate(ties.gamma, state, fifty_digits()), dtype=object)
        _, a = _allowed(there, gamma, size, rng)
        state = state | dict(zip(symbols.a, a, strict=True))
        Y = np.array(evaluate(entries, state, fifty_digits()), dtype=object).reshape(size, len(columns))
        parts.append(along.dot(Y))
        have += len(along)
        if not len(along):
            break
    return np.vstack(parts) if parts else np.zeros((0, len(columns)), dtype=object)


def _closed_to_the_last_digit(system: System, state: State) -> State:
    """A state whose gaps are closed, by Newton's method with 50 digits; of gaps that follow from others any."""
    gaps, free = (*gaps_of(system.ties), *norms_of(system.ties)), movable(system.ties)
    if not gaps:
        return state
    slopes = tuple(x for row in jacobian(gaps, free) for x in row)
    for _ in range(STEPS):
        found = np.array(evaluate((*slopes, *gaps), state, fifty_digits()), dtype=object)
        S, phi = found[: len(slopes)].reshape(-1, len(free)), found[len(slopes) :]
        step = _allowed(S, phi, len(free), None)[1]
        state = state | {q: state[q] + d for q, d in zip(free, step, strict=True)}
    return state


def _allowed(J: np.ndarray, right: np.ndarray, size: int, rng: Random | None) -> tuple[np.ndarray, list[Any]]:
    """(a motion that the ties allow in each row, an x with J x + right = 0, random where it is free)."""
    number = fifty_digits().number
    kept, K = _echelon_in_digits(J, right)
    free = [j for j in range(size) if j not in kept]
    along = np.full((len(free), size), number(0), dtype=object)
    for row, j in enumerate(free):
        along[row, j] = number(1)
        for i in kept:
            along[row, i] = -K.get((i, j), number(0))
    pushed = [number(Fraction(rng.randrange(-1000, 1000), 1000) if rng else 0) for _ in free]
    x = [sum((p * row[k] for p, row in zip(pushed, along, strict=True)), start=number(0)) for k in range(size)]
    for i in kept:
        x[i] = x[i] - K.get((i, size), number(0))
    return along, x


def _echelon_in_digits(W: np.ndarray, right: np.ndarray | None = None) -> tuple[list[int], dict[tuple[int, int], Any]]:
    """As `_echelon_form`, of numbers with 50 digits; of a right side the solution, as one more column."""
    width = W.shape[1]
    if not len(W):
        return [], {}
    left = W.copy() if right is None else np.column_stack([W, right])
    kept: list[int] = []
    K: dict[tuple[int, int], Any] = {}
    for j in range(width):
        r = len(kept)
        pivot = max(range(r, len(left)), key=lambda i: abs(left[i, j]), default=None)
        if pivot is None or not abs(left[pivot, j]) > FOLLOWS_AT_50:
            K |= {(kept[i], j): left[i, j] for i in range(r) if abs(left[i, j]) > FOLLOWS_AT_50}
            continue
        left[[r, pivot]] = left[[pivot, r]]
        left[r] = left[r] / left[r, j]
        for i in range(len(left)):
            if i != r and left[i, j] != 0:
                left[i] = left[i] - left[i, j] * left[r]
        kept.append(j)
    if right is not None:
        K |= {(kept[i], width): left[i, width] for i in range(len(kept))}
    return kept, K


def _grouped(
    names: Sequence[str],
    moving: Sequence[int],
    kept: Sequence[int],
    numbers: dict[tuple[int, int], Any],
    texts: dict[tuple[int, int], str],
    arithmetic: str,
) -> BaseParameters:
    groups = []
    for i in kept:
        leader = names[moving[i]]
        own: dict[str, str] = {leader: "1"}
        values: dict[str, float] = {leader: 1.0}
        for (k, j), value in numbers.items():
            if k == i:
                own[names[moving[j]]] = texts.get((k, j)) or _number(value)
                values[names[moving[j]]] = float(value)
        groups.append(Group(leader, own, values))
    still = tuple(name for j, name in enumerate(names) if j not in set(moving))
    seen = {parameter for group in groups for parameter in group.terms}
    return BaseParameters(tuple(groups), (*still, *(names[j] for j in moving if names[j] not in seen)), arithmetic)


def _number(value: Any) -> str:
    if isinstance(value, float):
        near = Fraction(value).limit_denominator(1000)
        return str(near) if abs(float(near) - value) < SAME_EIGENVALUE * max(1.0, abs(value)) else f"{value:.10g}"
    return str(value)
