"""Two expressions -> equal or not, decided at random exact states.

A state gives every symbol a random value, and every sine and cosine values that belong together: with the half-angle
tau of an angle, sin = 2 tau / (1 + tau^2) and cos = (1 - tau^2) / (1 + tau^2), and sums of angles by their addition
theorems. Modulo a prime of 61 bits two different expressions agree there with a chance near degree / 2^61.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import accumulate
from math import lcm
from random import Random
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.resources import check_patience
from eomgen.symbolic.expression import Fraction, Node, Number, Scalar, linear_terms, order, united
from eomgen.symbolic.numeric import (
    PRIME,
    PRIME_FIELD,
    Arithmetic,
    NoMeaning,
    NoValue,
    evaluate,
    fifty_digits,
    in_balls,
    tolerances,
)

TRIES = 12  # states of the prime field to be tried for one with a value
REAL_TRIES = 60
RANGES = ((0.5, 2.0), (0.05, 0.6), (1.5, 6.0))  # of the symbols at a real state
NEAR = (0.3, 0.1, 0.03, 0.01, 0.001)  # of a symbol's own size and 1, how far from where it is held near: a start
EXPONENTS = (-4, 2)  # of their sizes in every other later state: a length of 0.08 occurs with a radius of 0.03
TOLERANCE = Fraction(1, 10**30)  # of a comparison at 50 digits, relative to the larger of the two and 1
CONFIRMED = (169, 1600)  # bits, of 50 and 480 digits, with which a difference is looked at in balls
Pair = tuple[Scalar, Scalar]
ALGEBRAIC = frozenset("symbol neg add sub mul div".split())


@dataclass(frozen=True)
class ExactState:
    """Values at which expressions can be evaluated exactly.

    Args:
        values: of every symbol, sine, cosine and function that the arithmetic cannot compute.
        independent: the values obey every relation among their nodes, so that a difference here is a difference.
    """

    values: dict[Node, Any]
    independent: bool


@dataclass(frozen=True)
class Equality:
    """Result of a comparison of pairs of expressions.

    Args:
        equal: True if all pairs are equal.
        arithmetic: "prime field" (exact) or "50 digits".
        culprit: index of the first pair that differs, or None.
        states: number of states at which the pairs were found equal.
    """

    equal: bool
    arithmetic: str
    culprit: int | None = None
    states: int = 0


def equal_at_random_states(pairs: Iterable[Pair], *, seed: int = 1, states: int = 2) -> Equality:
    """Decides if the two of each pair are the same function of the symbols.

    The pairs are compared in a prime field; where functions have no meaning there or the field cannot decide, at real
    states with 50 digits.

    Args:
        pairs: scalars of one graph.
        seed: of the random states; the same seed gives the same verdict.
        states: how many must agree.
    Raises:
        DerivationError: no real state was found at which the expressions have values.
    """
    pairs = tuple(pairs)
    (verdict,) = equal_in_field((pairs,), seed=seed, states=states)
    return equal_at_real_states(pairs, seed=seed, states=states) if verdict is None else verdict


def equal_in_field(groups: Sequence[Sequence[Pair]], *, seed: int = 1, states: int = 2) -> list[Equality | None]:
    """Equality of each group's pairs, decided in a prime field; None for a group that the field cannot decide.

    All groups are evaluated at once: their common parts are evaluated once.
    """
    rng, flat = Random(seed), [x for pairs in groups for pair in pairs for x in pair]
    _, flat = united(flat)
    nodes, sure = order(flat), True
    culprits: list[int | None] = [None] * len(groups)
    ends = list(accumulate(2 * len(pairs) for pairs in groups))
    try:
        for _ in range(states):
            state, values = _valued(flat, nodes, rng)
            sure = sure and state.independent
            parts = (values[end - 2 * len(pairs) : end] for pairs, end in zip(groups, ends, strict=True))
            culprits = [k if k is not None else _first_different(part) for k, part in zip(culprits, parts, strict=True)]
    except NoMeaning:
        return [None] if len(groups) == 1 else [equal_in_field((x,), seed=seed, states=states)[0] for x in groups]
    return [None if k is not None and not sure else Equality(k is None, PRIME_FIELD.name, k) for k in culprits]


def equal_at_real_states(
    pairs: Iterable[Pair], *, seed: int = 1, states: int = 2, given: Iterable[Iterable[Mapping[Node, Any]]] = ()
) -> Equality:
    """The same at real states with 50 digits.

    Args:
        given: states that come before the random ones; of each row the first at which the expressions have values.
    Raises:
        DerivationError: no real state was found at which the expressions have values.
    """
    arithmetic, rng = fifty_digits(), Random(seed)
    _, flat = united([x for pair in pairs for x in pair])
    found = 0
    for row in given:
        for state in row:
            values = _values_at(flat, state, arithmetic)
            culprit = None if values is None else _first_apart(values, flat, state)
            if values is None or (culprit is not None and rounding_decides(flat, state)):
                continue  # it says nothing: the next one of the row
            found += 1
            if culprit is not None:
                return Equality(False, arithmetic.name, culprit)
            break
    for _ in range(states):
        try:
            values = real_values(flat, rng, arithmetic)
        except DerivationError:
            if not found:
                raise
            break
        found += 1
        if (culprit := _first_apart(values)) is not None:
            return Equality(False, arithmetic.name, culprit)
    return Equality(True, arithmetic.name, states=found)


def rounding_decides(scalars: Sequence[Scalar], state: Mapping[Node, Any]) -> bool:
    """True if scalars change at a state 1e-30 away, as with 0/0 or 1/0: their values here are only rounding errors."""
    digits = fifty_digits()
    beside = {x: value + digits.number(Fraction(1, 10**30)) for x, value in state.items()}
    here, there = (_values_at(scalars, at, digits) for at in (state, beside))
    if here is None or there is None:
        return True
    size = max(map(abs, here), default=0)
    return any(
        abs(x - y) > tolerances.ZERO_AT_50 + tolerances.COMPUTED * size for x, y in zip(here, there, strict=True)
    )


def exact_state(outputs: Iterable[Scalar], rng: Random, arithmetic: Arithmetic = PRIME_FIELD) -> ExactState:
    """A random state for the outputs in an exact arithmetic.

    Angles are taken apart into numbers times atoms: symbols, or other nodes such as omega*t. An atom's sine is
    independent of the atom's own value, as it is in algebra. Functions that the arithmetic cannot compute (exp, abs,
    a comparison) get values of their own.

    Args:
        arithmetic: PRIME_FIELD or RATIONAL.
    Raises:
        NoMeaning: the root of something that is no constant (its sign would be lost), or the sine of pi/7.
        NoValue: a constant's root is not there.
    """
    return _exact_state(order(outputs), rng, arithmetic)


def _exact_state(nodes: Sequence[Node], rng: Random, arithmetic: Arithmetic) -> ExactState:
    """The same for nodes in evaluation order."""
    angles = {x.args[0]: linear_terms(x.args[0]) for x in nodes if x.op in ("sin", "cos")}
    circle = _Circle(arithmetic, rng, angles.values())
    values: dict[Node, Any] = {}
    independent = all(atom is None or atom.op in ("symbol", "pi") for terms in angles.values() for atom in terms)
    for x in nodes:
        if x.op in ("sin", "cos"):
            cosine, sine = circle.at(angles[x.args[0]])
            values[x] = sine if x.op == "sin" else cosine
        elif x.op == "symbol" or x.op == "pi":
            values[x] = _random(arithmetic, rng)
        elif x.op == "sqrt":
            if type(x.args[0]) is Node:
                raise NoMeaning("the sign of a root is lost")
        elif x.op not in ALGEBRAIC and not (x.op == "pow" and type(x.args[1]) is int):
            values[x] = _random(arithmetic, rng)
            independent = False
    for symbols in _unit_quaternions(nodes):
        values |= zip(symbols, _unit_vector(arithmetic, rng, len(symbols)), strict=True)
    return ExactState(values, independent)


def _unit_quaternions(nodes: Iterable[Node]) -> list[tuple[Node, ...]]:
    """The sets of symbols among them whose squares add up to 1."""
    graphs = {x.graph: None for x in nodes}
    return [symbols for graph in graphs for symbols in graph.unit_quaternions]


def _unit_vector(arithmetic: Arithmetic, rng: Random, size: int) -> list[Any]:
    """A random point of the unit sphere: (1 - r.r, 2 r) / (1 + r.r)."""
    f, one = arithmetic.functions, arithmetic.number(1)
    r = [_random(arithmetic, rng) for _ in range(size - 1)]
    square = arithmetic.number(0)
    for x in r:
        square = f["add"](square, f["mul"](x, x))
    below = f["div"](one, f["add"](one, square))
    return [f["mul"](f["sub"](one, square), below), *(f["mul"](f["add"](x, x), below) for x in r)]


class _Circle:
    """Points (cos, sin) of the unit circle for angles that are sums of numbers times atoms."""

    def __init__(self, arithmetic: Arithmetic, rng: Random, angles: Iterable[dict[Node | None, Number]]) -> None:
        self.arithmetic, self.rng = arithmetic, rng
        self.denominators: dict[Node | None, int] = {}
        for terms in angles:
            for atom, c in terms.items():
                self.denominators[atom] = lcm(self.denominators.get(atom, 1), c.denominator)
        self.points: dict[tuple[Node | None, Number], tuple[Any, Any]] = {}

    def at(self, terms: dict[Node | None, Number]) -> tuple[Any, Any]:
        """(cos, sin) of the angle sum c atom."""
        point = (self.arithmetic.number(1), self.arithmetic.number(0))
        for atom, c in sorted(terms.items(), key=lambda item: -1 if item[0] is None else item[0].index):
            point = self._turned(point, self._multiple(atom, c))
        return point

    def _multiple(self, atom: Node | None, c: Number) -> tuple[Any, Any]:
        if (atom, c) not in self.points:
            if atom is not None and atom.op == "pi":
                self.points[atom, c] = self._of_pi(Fraction(c))
            else:
                whole = int(c * self.denominators[atom])
                self.points[atom, c] = self._power(self._base(atom), whole)
        return self.points[atom, c]

    def _base(self, atom: Node | None) -> tuple[Any, Any]:
        """The random point of atom / (common denominator of its multiples), by its half-angle."""
        key = (atom, Fraction(1, self.denominators[atom]))
        if key not in self.points:
            f, one = self.arithmetic.functions, self.arithmetic.number(1)
            tau = _random(self.arithmetic, self.rng)
            square = f["mul"](tau, tau)
            below = f["div"](one, f["add"](one, square))
            self.points[key] = (f["mul"](f["sub"](one, square), below), f["mul"](f["add"](tau, tau), below))
        return self.points[key]

    def _of_pi(self, turn: Fraction) -> tuple[Any, Any]:
        """The point of turn * pi, turn a multiple of 1/4 or 1/6."""
        number, f = self.arithmetic.number, self.arithmetic.functions
        if 2 % turn.denominator == 0:
            return self._power((number(0), number(1)), int(2 * turn))
        half = number(Fraction(1, 2))
        if turn.denominator == 4:
            diagonal = f["mul"](f["sqrt"](number(2)), half)
            return self._power((diagonal, diagonal), int(4 * turn))
        if 6 % turn.denominator == 0:
            return self._power((f["mul"](f["sqrt"](number(3)), half), half), int(6 * turn))
        raise NoMeaning(f"the sine of {turn}*pi")

    def _power(self, point: tuple[Any, Any], n: int) -> tuple[Any, Any]:
        if n < 0:
            point, n = (point[0], self.arithmetic.functions["neg"](point[1])), -n
        result = (self.arithmetic.number(1), self.arithmetic.number(0))
        while n:
            if n % 2:
                result = self._turned(result, point)
            point = self._turned(point, point)
            n //= 2
        return result

    def _turned(self, a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
        f = self.arithmetic.functions
        add, sub, mul = f["add"], f["sub"], f["mul"]
        return sub(mul(a[0], b[0]), mul(a[1], b[1])), add(mul(a[1], b[0]), mul(a[0], b[1]))


def _random(arithmetic: Arithmetic, rng: Random) -> Any:
    if arithmetic is PRIME_FIELD:
        return rng.randrange(1, PRIME)
    return arithmetic.number(Fraction(rng.randint(1, 40), rng.randint(1, 40)))


def _valued(flat: Sequence[Scalar], nodes: Sequence[Node], rng: Random) -> tuple[ExactState, list[Any]]:
    """A state of the prime field at which everything has a value, and the values."""
    for _ in range(TRIES):
        try:
            state = _exact_state(nodes, rng, PRIME_FIELD)
            return state, evaluate_once(flat, nodes, state.values, PRIME_FIELD)
        except NoMeaning:
            raise
        except (NoValue, ValueError):  # ValueError: 1 + tau^2 has no inverse
            continue
    raise NoMeaning("no state of the prime field has values")


def _first_different(values: Sequence[Any]) -> int | None:
    return next((i for i in range(len(values) // 2) if values[2 * i] != values[2 * i + 1]), None)


def _values_at(flat: Sequence[Scalar], state: Mapping[Node, Any], arithmetic: Arithmetic) -> list[Any] | None:
    """The values at a state; None where there are none."""
    try:
        return evaluate(flat, state, arithmetic)
    except (NoValue, ZeroDivisionError):
        return None


def _first_apart(
    values: Sequence[Any], flat: Sequence[Scalar] = (), state: Mapping[Node, Any] | None = None
) -> int | None:
    """The first pair that differs by more than the rounding of 50 digits.

    Args:
        flat, state: what the values are of, where their rounding may be larger than they are: of 1e200 - 1e200.
    """
    tolerance = fifty_digits().number(TOLERANCE)
    for i, (a, b) in enumerate(zip(values[::2], values[1::2], strict=True)):
        if abs(a - b) > tolerance * max(1, abs(a), abs(b)) and not (
            state is not None and _may_be_equal(flat[2 * i], flat[2 * i + 1], state)
        ):
            return i
    return None


def _may_be_equal(a: Scalar, b: Scalar, state: Mapping[Node, Any]) -> bool:
    """True if 480 digits do not distinguish two scalars either; nor the usual ones, which are looked at first."""
    return all(x.overlaps(y) for x, y in (in_balls((a, b), state, bits=bits) for bits in CONFIRMED))


def real_values(flat: Sequence[Scalar], rng: Random, arithmetic: Arithmetic) -> list[Any]:
    """Values at a random real state.

    Symbols are positive (roots of parameters exist), rates of either sign; of one size at first, then near the numbers
    near which they are held (acos((s - 20)/3) has values about s = 21 alone), then each of its own size, so that
    sqrt(l^2 - x^2) and sqrt(0.08^2 - r^2) exist, and some of them negative.
    """
    symbols = [x for x in order(flat) if x.op == "symbol"]
    for attempt in range(REAL_TRIES):
        values = {x: arithmetic.number(_real(x, rng, attempt)) for x in symbols}
        for four in _unit_quaternions(symbols):
            values |= zip(four, _unit_vector(arithmetic, rng, len(four)), strict=True)
        try:
            return evaluate(flat, values, arithmetic)
        except NoValue:
            continue
    raise DerivationError(
        "no real state was found at which the expressions to be compared have values",
        fix="give a start, and parameters, at which they have values",
    )


def _real(symbol: Node, rng: Random, attempt: int) -> Fraction:
    """A random value of a symbol for the attempt-th real state."""
    if len(RANGES) <= attempt < len(RANGES) + 2 * len(NEAR) and (near := symbol.graph.near.get(symbol)) is not None:
        spread = NEAR[(attempt - len(RANGES)) // 2] * (1 if near == 0 else min(1.0, abs(near)))
        return Fraction(near + rng.uniform(-spread, spread))
    low, high = RANGES[attempt] if attempt < len(RANGES) else rng.choice(RANGES)
    either = symbol.name.endswith("'") or (attempt > REAL_TRIES // 3 and rng.random() < 0.3)
    any_size = attempt > len(RANGES) and attempt % 2 == 1
    size = 10 ** rng.uniform(*EXPONENTS) if any_size else rng.uniform(low, high)
    return Fraction(rng.choice((-1, 1)) * size if either else size)


# -------- combinations ----------------------------------------------------------------------------------------
# A row of scalars -> the rows of which it is a combination at random exact states, or at given ones.
#
#     row = sum of f_k row_k,   f_k any functions of the state
#
# In a prime field by whole numbers; at real states with 50 digits, and what these take for 0 once more in balls: a
# kinetic energy of 1e-293 J is small, and is not 0.


STATES = 3  # of the prime field at which a row is looked at
REAL_STATES = 6  # where roots and sizes may hold on one side only: signs are shared out among so many
FIELD_TRIES = 40  # states of the prime field to be tried for those with values
NumberRow = list[Any]


@dataclass(frozen=True)
class Combined:
    """Combination of rows that a row is, or is not.

    Args:
        holds: yes, no, or None: no state decided it.
        rows: which of the others stand in the combination, by their places.
        way: by which numbers, "prime field" or "50 digits".
    """

    holds: bool | None
    rows: tuple[int, ...] = ()
    way: str = ""


def combined(
    row: Sequence[Scalar],
    rows: Sequence[Sequence[Scalar]],
    states: Callable[[], Iterable[Mapping[Node, Any]]] | None = None,
    rounded: Collection[Node] = (),
) -> Combined:
    """Combination of rows that a row is; undecided where too few states give values.

    Args:
        states: values of all symbols with 50 digits, as many as are needed; None: states of the prime field.
        rounded: symbols whose values satisfy equations only as far as these digits go.
    """
    if states is None:
        return _combined(row, rows, _exact_states(row, rows), IN_FIELD)
    found = _combined(row, rows, _real_states(row, rows, states()), IN_DIGITS)
    if found.holds and _combined(row, rows, _sure_states(row, rows, states(), rounded), IN_BALLS).holds is False:
        return Combined(False, (), IN_BALLS.name)
    return found


def combines(row: NumberRow, rows: Sequence[NumberRow]) -> bool:
    """True if a row of numbers of 50 digits is a combination of others."""
    return _factors_in(rows, row, IN_DIGITS) is not None


@dataclass(frozen=True)
class NumberKind:
    """Calculating with exact numbers of one kind, as far as linear equations need it."""

    name: str
    inverse: Callable[[Any], Any]
    tidy: Callable[[Any], Any]
    is_zero: Callable[[Any, Any], bool]  # of a number, beside the size of what it was made of
    number: Callable[[Any], Any] = lambda x: x  # of a whole number
    states: int = STATES  # at how many it is looked at


IN_FIELD = NumberKind("prime field", lambda x: pow(x, -1, PRIME), lambda x: x % PRIME, lambda x, size: x % PRIME == 0)
IN_DIGITS = NumberKind(
    "50 digits",
    lambda x: 1 / x,
    lambda x: x,
    lambda x, size: abs(x) <= max(tolerances.ELIMINATED_AT_50 * size, tolerances.ZERO_AT_50),
    states=REAL_STATES,
)
IN_BALLS = NumberKind(
    "balls of 50 digits",
    lambda x: 1 / x,
    lambda x: x,
    lambda x, size: not (x > 0 or x < 0),
    states=1,
)


def _combined(
    row: Sequence[Scalar], rows: Sequence[Sequence[Scalar]], states: Iterable[NumberRow], numbers: NumberKind
) -> Combined:
    """The same at given states; undecided where there are none."""
    width, used = len(row), set[int]()
    for seen, values in enumerate(states, start=1):
        table = [values[k : k + width] for k in range(0, len(values), width)]
        factors = _factors_in(table[1:], table[0], numbers)
        if factors is None:
            return Combined(False, (), numbers.name)
        used |= {k for k, x in enumerate(factors) if not numbers.is_zero(x, 1)}
        if seen == numbers.states:
            return Combined(True, tuple(sorted(used)), numbers.name)
    return Combined(None)


def _factors_in(rows: Sequence[NumberRow], row: NumberRow, numbers: NumberKind) -> NumberRow | None:
    """The factors by which the rows make a row; None where none do."""
    pivots: list[tuple[int, NumberRow, NumberRow]] = []
    for k, each in enumerate((*rows, row)):
        size = max(map(abs, each), default=0)
        left, made = list(each), [numbers.number(int(j == k)) for j in range(len(rows) + 1)]
        for column, pivot, share in pivots:
            factor = left[column]
            if factor:
                left = [numbers.tidy(x - factor * y) for x, y in zip(left, pivot, strict=True)]
                made = [numbers.tidy(x - factor * y) for x, y in zip(made, share, strict=True)]
        free = [j for j, x in enumerate(left) if not numbers.is_zero(x, size)]
        if k == len(rows):
            return None if free else [numbers.tidy(-x) for x in made[:-1]]
        if free:
            column = max(free, key=lambda j: abs(left[j]))
            inverse = numbers.inverse(left[column])
            scaled = [numbers.tidy(x * inverse) for x in left]
            pivots.append((column, scaled, [numbers.tidy(x * inverse) for x in made]))
    return None


def _exact_states(row: Sequence[Scalar], rows: Sequence[Sequence[Scalar]]) -> Iterator[NumberRow]:
    """All entries at states of the prime field; none where it cannot tell a difference from none."""
    flat = _entries(row, rows)
    rng, found = Random(7), 0
    for _ in range(FIELD_TRIES):
        try:
            state = exact_state(flat, rng)
            if not state.independent:
                return
            yield evaluate(flat, state.values, PRIME_FIELD)
            found += 1
        except NoMeaning:
            return
        except (NoValue, ValueError):
            continue
        if found == STATES:
            return


def _real_states(
    row: Sequence[Scalar], rows: Sequence[Sequence[Scalar]], states: Iterable[Mapping[Node, Any]]
) -> Iterator[NumberRow]:
    """All entries at real states with 50 digits."""
    flat, arithmetic, found = _entries(row, rows), fifty_digits(), 0
    for state in states:
        try:
            yield evaluate(flat, state, arithmetic)
            found += 1
        except (NoValue, ZeroDivisionError):
            continue
        if found == REAL_STATES:
            return


def _sure_states(
    row: Sequence[Scalar],
    rows: Sequence[Sequence[Scalar]],
    states: Iterable[Mapping[Node, Any]],
    rounded: Collection[Node],
) -> Iterator[NumberRow]:
    """All entries in balls at the states where all have values."""
    flat = _entries(row, rows)
    for state in states:
        values = in_balls(flat, state, dict.fromkeys(rounded, tolerances.ZERO_AT_50), last=True)
        if not any(x.is_nan() for x in values):
            yield values


def _entries(row: Sequence[Scalar], rows: Sequence[Sequence[Scalar]]) -> tuple[Scalar, ...]:
    """All entries, of one graph."""
    return tuple(united([x for each in (row, *rows) for x in each])[1])


def evaluate_once(
    outputs: Sequence[Scalar], nodes: Sequence[Node], values: Mapping[Node, Any], arithmetic: Arithmetic
) -> list[Any]:
    """The same for a state or two, for which no plan is made.

    Args:
        nodes: all that the outputs need, arguments before results; values of their symbols are given.
    """
    check_patience()
    number, functions, known = arithmetic.number, arithmetic.functions, dict(values)
    for x in nodes:
        if x not in known:
            try:
                known[x] = functions[x.op](*[known[a] if type(a) is Node else number(a) for a in x.args])
            except (ValueError, ZeroDivisionError, OverflowError):
                known[x] = arithmetic.failed(x)
    return [known[x] if type(x) is Node else number(x) for x in outputs]
