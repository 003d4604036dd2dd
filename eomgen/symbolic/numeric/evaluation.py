"""Expressions, values of their symbols -> values, in the arithmetic that one chooses."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, cached_property, lru_cache, partial
from itertools import chain, count
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.resources import check_patience
from eomgen.symbolic.expression import (
    LARGEST_POWER,
    NAMES,
    Fraction,
    Graph,
    Node,
    Number,
    Sampled,
    Scalar,
    function,
    order,
    over,
    symbols_of,
)

WAYS_KEPT = 16  # of evaluations that may come again
NUMBERS_KEPT = 4096  # exact numbers cached with 50 digits
NONE = frozenset[Node]()
_Step = tuple[Node, str, tuple[int, ...]]
PRIME = 2305843009213682039  # 61 bits, 7 mod 8; 2, 3, 5, ..., 37 are squares modulo it


class NoValue(ArithmeticError):
    """This state has no value in this arithmetic (a root that is not there, a zero divisor): take another state."""


class NoMeaning(NoValue):
    """A function or constant has no meaning in this arithmetic at any state: take another arithmetic."""


@dataclass(frozen=True)
class Arithmetic:
    """Numbers of one kind.

    Args:
        name: for messages, "prime field".
        number: turns an exact number into one of this kind; in digits and balls a double too, as the number that it is.
        functions: the operation of each op, "pi" as a function of nothing.
        failed: the value of a node outside its domain; may raise NoValue instead.
        quickly: (values that are given, steps, places of the outputs) -> these, by a quicker way; None: not by that.
    """

    name: str
    number: Callable[[Any], Any]
    functions: Mapping[str, Callable[..., Any]]
    failed: Callable[[Node], Any]
    quickly: Callable[[Sequence[Any], Sequence[_Step], Sequence[int]], list[Any] | None] | None = None


def evaluate(outputs: Sequence[Scalar], values: Mapping[Node, Any], arithmetic: Arithmetic | None = None) -> list[Any]:
    """The outputs' values.

    Args:
        outputs: scalars of one graph, exact numbers among them.
        values: a value for every symbol in the outputs; any other node may be given too, and is then not computed.
        arithmetic: FLOAT (None), RATIONAL, PRIME_FIELD or fifty_digits().
    Raises:
        DerivationError: a symbol without a value; all are named.
        NoValue: outside the domain (floats give nan instead).
    """
    check_patience()
    outputs, arithmetic = tuple(outputs), arithmetic or FLOAT
    if Node not in map(type, outputs):
        return [arithmetic.number(x) for x in outputs if type(x) is not Node]
    way = _way(outputs, NONE)
    if not way.computed.isdisjoint(values):
        way = _way(outputs, frozenset(x for x in values if x.op != "symbol"))
    missing = [x.name for x in way.symbols if x not in values]
    if missing:
        raise DerivationError(f"no value for {', '.join(repr(name) for name in missing)}", fix="give it a value")
    number, functions = arithmetic.number, arithmetic.functions
    known = [number(x) for x in way.constants]
    known += [values[x] for x in way.symbols]
    known += [values[x] for x in way.given]
    if arithmetic.quickly is not None and (found := arithmetic.quickly(known, way.steps, way.outputs)) is not None:
        return found
    value = known.__getitem__
    for x, op, places in way.steps:
        try:
            known.append(functions[op](*map(value, places)))
        except (ValueError, ZeroDivisionError, OverflowError):
            known.append(arithmetic.failed(x))
    return [known[i] for i in way.outputs]


def floats_of(values: Iterable[Any]) -> list[float]:
    """Numbers of many digits as floats.

    Raises:
        NoValue: one is larger than floats are.
    """
    found = [float(x) for x in values]
    if not all(map(math.isfinite, found)):
        raise NoValue("a number beyond doubles")
    return found


@dataclass(frozen=True)
class _Way:
    """Order of evaluation: constants, symbols, nodes given, then each step from the values before it.

    Args:
        steps: a node, its operation, and the places of its arguments among all values.
        outputs: their places.
    """

    constants: tuple[Number, ...]
    symbols: tuple[Node, ...]
    given: tuple[Node, ...]
    steps: tuple[_Step, ...]
    outputs: tuple[int, ...]

    @cached_property
    def computed(self) -> frozenset[Node]:
        return frozenset([x for x, _, _ in self.steps])


@lru_cache(maxsize=WAYS_KEPT)
def _way(outputs: tuple[Scalar, ...], given: frozenset[Node]) -> _Way:
    """The way to the outputs, which is the same for all values."""
    symbols: list[Node] = []
    known: list[Node] = []
    computed: list[Node] = []
    for x in order(outputs, given):
        (known if x in given else symbols if x.op == "symbol" else computed).append(x)
    numbers = {a for x in computed for a in x.args if type(a) is not Node}
    constants = tuple(numbers.union(x for x in outputs if type(x) is not Node))
    at = dict(zip(chain(constants, symbols, known, computed), count(), strict=False)).__getitem__
    steps = tuple([(x, x.op, tuple(map(at, x.args))) for x in computed])
    return _Way(constants, tuple(symbols), tuple(known), steps, tuple(map(at, outputs)))


# -- the arithmetics ------------------------------------------------------------------------------


def _sign(a: Any) -> Any:
    return (a > 0) - (a < 0) if a == a else a


def _select(condition: Any, if_true: Any, if_false: Any) -> Any:
    if condition != condition:
        return condition
    return if_true if condition else if_false


def _of_two(function: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    """A choice or comparison of two numbers; where one of them is nan, so is the result."""
    return lambda a, b: function(a, b) if a == a and b == b else a + b


_RING: dict[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
}
_ORDERED: dict[str, Callable[..., Any]] = {
    "abs": abs,
    "sign": _sign,
    "min": _of_two(min),
    "max": _of_two(max),
    "less": _of_two(operator.lt),
    "less_equal": _of_two(operator.le),
    "select": _select,
}


def _no_value(x: Node) -> Any:
    raise NoValue(f"'{x.op}' outside its domain")


def _meaningless(op: str, arithmetic: str) -> Callable[..., Any]:
    def refuse(*_: Any) -> Any:
        raise NoMeaning(f"'{op}' has no meaning in {arithmetic}")

    return refuse


def _refusing(ops: str, arithmetic: str) -> dict[str, Callable[..., Any]]:
    return {op: _meaningless(op, arithmetic) for op in ops.split()}


def nearest(x: Number) -> float:
    """An exact number as a double; beyond all doubles it is inf."""
    try:
        return float(x)
    except OverflowError:
        return math.inf if x > 0 else -math.inf


FLOAT = Arithmetic(
    "floats",
    nearest,
    _RING
    | _ORDERED
    | {op: getattr(math, op) for op in "sqrt sin cos tan asin acos atan sinh cosh tanh exp log atan2".split()}
    | {"pow": math.pow, "pi": lambda: math.pi, "sampled": lambda t, k: Sampled.of(k).at(t, float, math.pi)},
    lambda x: math.nan,
)


def _rational_root(a: Fraction | int) -> Fraction:
    a = Fraction(a)
    if a < 0:
        raise NoValue("the root of a negative number")
    root = Fraction(math.isqrt(a.numerator), math.isqrt(a.denominator))
    if root * root != a:
        raise NoValue(f"{a} is not a square")
    return root


def _whole_power(a: Any, exponent: Any) -> Any:
    if Fraction(exponent).denominator != 1 or abs(exponent) > LARGEST_POWER:
        raise NoMeaning("a power that is not a small whole number")
    return a ** int(exponent)


def _rational_sample(t: Fraction, k: Fraction) -> Fraction:
    if Sampled.of(k).pi_power or (Sampled.of(k).measure[1] and t != 0):
        raise NoMeaning("pi is not rational")
    return Fraction(Sampled.of(k).spline.at(t * Sampled.of(k).measure[0]))


RATIONAL = Arithmetic(
    "rationals",
    Fraction,
    _RING
    | _ORDERED
    | {"sqrt": _rational_root, "pow": _whole_power, "sampled": _rational_sample}
    | _refusing("pi sin cos tan asin acos atan sinh cosh tanh exp log atan2", "the rationals"),
    _no_value,
)


@cache
def _residue(c: Number) -> int:
    return c.numerator * pow(c.denominator, -1, PRIME) % PRIME


def _root_modulo(a: int) -> int:
    """The root that is a square itself, so that sqrt(a) sqrt(b) = sqrt(a b) as over the positive reals."""
    root = pow(a, (PRIME + 1) // 4, PRIME)
    if root * root % PRIME != a % PRIME:
        raise NoValue("not a square modulo the prime")
    return root


def _power_modulo(a: int, exponent: int) -> int:
    if exponent > LARGEST_POWER:
        raise NoMeaning("a power that is not a small whole number")
    return pow(a, exponent, PRIME)


def _quotient_modulo(a: int, b: int) -> int:
    return a * pow(b, -1, PRIME) % PRIME  # ValueError where b is 0


_MODULAR: dict[str, Callable[..., Any]] = {
    "neg": lambda a: -a % PRIME,
    "add": lambda a, b: (a + b) % PRIME,
    "sub": lambda a, b: (a - b) % PRIME,
    "mul": lambda a, b: a * b % PRIME,
    "div": _quotient_modulo,
    "sqrt": _root_modulo,
    "pow": _power_modulo,
}

PRIME_FIELD = Arithmetic(
    "prime field",
    _residue,
    _MODULAR
    | _refusing("pi sin cos tan asin acos atan sinh cosh tanh exp log atan2", "a prime field")
    | _refusing("abs sign min max less less_equal select sampled", "a prime field"),
    _no_value,
)


@cache
def fifty_digits(partial: bool = False) -> Arithmetic:
    """Real numbers with 50 decimal digits; a function outside its real domain raises NoValue.

    So does one of a number beyond all size, whose value would take forever: exp(exp(exp(12))).

    Args:
        partial: outside its domain a function is nan, as in doubles, and so is what is made of that.
    """
    from eomgen.symbolic.numeric.digits import FUNCTIONS, NAN, by_balls, real

    def finite(function: Callable[..., Any]) -> Callable[..., Any]:
        def of(*arguments: Any) -> Any:
            value = function(*arguments)
            if value != value:
                raise NoValue("no finite real value")
            return value

        return of

    number = lru_cache(maxsize=NUMBERS_KEPT)(real)
    functions = FUNCTIONS if partial else {op: finite(function) for op, function in FUNCTIONS.items()}
    sampled = {"sampled": lambda t, k: Sampled.of(k).at(t, number, FUNCTIONS["pi"]())}
    failed = (lambda x: NAN) if partial else _no_value
    return Arithmetic("50 digits", number, _RING | _ORDERED | functions | sampled, failed, by_balls)


# -------- batch evaluation ------------------------------------------------------------------------------------
# Expressions -> their values at many states at once, layer after layer.
#
# A layer is all operations of one kind whose arguments are known from the layers before: so many thousand nodes are a
# few hundred operations on arrays.


_ON_ARRAYS: dict[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": np.true_divide,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "pow": np.float_power,
    "min": np.minimum,
    "max": np.maximum,
    "select": np.where,
    "pi": lambda: np.pi,
    "sampled": np.vectorize(lambda t, k: Sampled.of(k).at(t, nearest, np.pi), otypes=[float]),
    **{op: getattr(np, op) for op in "sqrt sin cos tan sinh cosh tanh exp log abs sign less less_equal".split()},
}
ARRAYS = Arithmetic("arrays", nearest, _ON_ARRAYS, lambda x: np.nan)
"""Floats, or arrays of them: many states at once."""

Layer = tuple[str, slice, tuple[np.ndarray, ...]]


@dataclass(frozen=True)
class Layers:
    """Expressions whose values are sought at many states.

    Args:
        outputs: the expressions.
        unknowns: the symbols that differ from state to state.
        values: of every other symbol.
    """

    outputs: tuple[Scalar, ...]
    unknowns: tuple[Node, ...]
    values: Mapping[Node, float]

    def at(self, x: np.ndarray) -> np.ndarray:
        """The outputs at each state, states x outputs; nan outside their domain.

        Args:
            x: states x unknowns.
        """
        known = np.empty((self._size, len(x)))
        first = len(self.unknowns)
        known[:first] = x.T
        known[first : first + len(self._fixed)] = self._fixed[:, None]
        with np.errstate(all="ignore"):
            for op, place, arguments in self._layers:
                known[place] = _ON_ARRAYS[op](*[known[a] for a in arguments])
        return np.asarray(known[self._outputs].T)

    @cached_property
    def _moving(self) -> list[Node]:
        """The operations that depend on the unknowns, arguments before results."""
        moving: dict[Node, None] = dict.fromkeys(self.unknowns)
        for x in order(self.outputs):
            if x.op != "symbol" and any(type(a) is Node and a in moving for a in x.args):
                moving[x] = None
        return list(moving)[len(self.unknowns) :]

    @cached_property
    def _constant(self) -> tuple[Scalar, ...]:
        """Arguments of the moving operations, and outputs, that are the same at all states."""
        moving = {*self._moving, *self.unknowns}
        taken = dict.fromkeys(a for x in self._moving for a in x.args) | dict.fromkeys(self.outputs)
        return tuple(x for x in taken if type(x) is not Node or x not in moving)

    @cached_property
    def _fixed(self) -> np.ndarray:
        with np.errstate(all="ignore"):
            return np.array([float(x) for x in evaluate(self._constant, self.values, ARRAYS)])

    @cached_property
    def _kinds(self) -> dict[tuple[int, str], list[Node]]:
        """The operations by depth and kind, the least deep first."""
        depth: dict[Scalar, int] = {}
        found: dict[tuple[int, str], list[Node]] = {}
        for x in self._moving:
            depth[x] = 1 + max(depth.get(a, 0) for a in x.args)
            found.setdefault((depth[x], x.op), []).append(x)
        return dict(sorted(found.items()))

    @cached_property
    def _places(self) -> dict[Scalar, int]:
        """{scalar: place of its value}: unknowns, constants, then layer by layer."""
        ordered = [*self.unknowns, *self._constant]
        for nodes in self._kinds.values():
            ordered += nodes
        return {x: i for i, x in enumerate(ordered)}

    @property
    def _size(self) -> int:
        return len(self._places)

    @cached_property
    def _layers(self) -> list[Layer]:
        places = self._places
        found: list[Layer] = []
        for (_, op), nodes in self._kinds.items():
            start = places[nodes[0]]
            columns = zip(*(x.args for x in nodes), strict=True)
            arguments = tuple(np.array([places[a] for a in column]) for column in columns)
            found.append((op, slice(start, start + len(nodes)), arguments))
        return found

    @cached_property
    def _outputs(self) -> np.ndarray:
        return np.array([self._places[x] for x in self.outputs], dtype=int)


# -------- transplant ------------------------------------------------------------------------------------------
# Scalars of one graph -> the same functions of the symbols of another.


_FUNCTIONS: dict[str, Callable[..., Any]] = {name: (lambda *args, name=name: function(name, *args)) for name in NAMES}
_ON_A_GRAPH: dict[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": over,
    "pow": operator.pow,
}


def transplanted(scalars: Sequence[Scalar], graph: Graph, meanings: Mapping[str, Scalar]) -> tuple[Scalar, ...]:
    """The scalars with each symbol replaced by what its name means in another graph.

    Raises:
        DerivationError: a symbol has no meaning there, or an operation cannot be carried over.
    """
    values: dict[Node, Scalar] = {}
    for symbol in symbols_of(scalars):
        if symbol.name not in meanings:
            raise DerivationError(f"'{symbol.name}' has no meaning here")
        values[symbol] = meanings[symbol.name]
    own: dict[str, Callable[..., Any]] = {"pi": lambda: graph.pi, "select": graph.select}
    own |= {name: partial(graph.call, name) for name in ("less", "less_equal", "sampled")}
    onto = Arithmetic("graph", lambda c: c, _ON_A_GRAPH | _FUNCTIONS | own, _refused)
    return tuple(evaluate(tuple(scalars), values, onto))


def _refused(node: Node) -> Scalar:
    raise DerivationError(f"'{node.op}' cannot be carried over")
