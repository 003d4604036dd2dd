"""A parsed text as a value, and the operations and functions of the grammar over any scalar.

A parsed text as a value: Expression, and the Call and Reference that outputs are made of.

The tree is held in postfix order, so that a sum of a thousand terms is evaluated by a loop and two
texts with the same tree are equal. The place of each piece in the text is stored with it, for carets.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field
from hashlib import blake2b
from math import isqrt
from typing import Any, TypeVar, overload

from eomgen.errors import DerivationError, ExpressionError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression.graph import CONSTANTS
from eomgen.symbolic.expression.node import Node, Scalar, is_zero
from eomgen.symbolic.expression.numbers import Number
from eomgen.symbolic.expression.rational import EXACT, Fraction, known_to_sympy
from eomgen.symbolic.expression.splines import Sampled, Spline, number_of_sampled

# -------- scalar operations -----------------------------------------------------------------------------------
# The operations of the model file's grammar over any scalar, exact where their operands are.
#
# An exact number with an exact number gives an exact number; a function of exact numbers is taken in the arithmetic
# of `pi`, the one constant that every set of values must hold: a node of the graph, a sympy expression or a float.
# What has no value (1/0, sqrt(-1), a power beyond all size) raises `Undefined`.


AnyScalar = Any
LARGEST_MAGNITUDE = 1000  # in bits: an exact number still fits a double
MOST_BITS = 5_000  # of a numerator or denominator: 9^9^9 is refused, not computed


class Undefined(ArithmeticError):
    """The operation has no value at these operands, said in words."""


def is_exact(a: AnyScalar) -> bool:
    """True for whole numbers and fractions."""
    return isinstance(a, EXACT)


def bounded(a: AnyScalar) -> AnyScalar:
    """a itself; a fraction that is whole as an int; an exact number beyond all size raises Undefined."""
    if type(a) is int:
        if a.bit_length() > LARGEST_MAGNITUDE:
            raise Undefined("the number is too large")
    elif type(a) is Fraction:
        upper, lower = a.numerator.bit_length(), a.denominator.bit_length()
        if upper - lower > LARGEST_MAGNITUDE or max(upper, lower) > MOST_BITS:
            raise Undefined("the number is too large")
        if a.denominator == 1:
            return a.numerator
    return a


def add(a: AnyScalar, b: AnyScalar) -> AnyScalar:
    return bounded(a + b)


def subtract(a: AnyScalar, b: AnyScalar) -> AnyScalar:
    return bounded(a - b)


def multiply(a: AnyScalar, b: AnyScalar) -> AnyScalar:
    return bounded(a * b)


def divide(a: AnyScalar, b: AnyScalar) -> AnyScalar:
    if type(b) is not Node and b == 0:
        raise Undefined("division by zero")
    return bounded(over(a, b))


def power_value(a: AnyScalar, b: AnyScalar, pi: AnyScalar = None) -> AnyScalar:
    """a ^ b; of exact numbers it is exact where it can be (4^(1/2) = 2)."""
    if is_exact(b) and b.denominator == 1:
        return _whole_power(a, b.numerator)
    if is_exact(a):
        if type(b) is Fraction:
            return _root(a, b, pi)
        if type(b) is Node:
            return b.graph.pow(a, b)
        if not isinstance(b, float):  # Fraction ** sympy number would be a float
            a = a + (b - b)
    value = a**b
    if isinstance(value, complex):
        raise Undefined("a broken power of a negative number")
    return value


def _whole_power(a: AnyScalar, n: int) -> AnyScalar:
    if n < 0:
        return divide(1, _whole_power(a, -n))
    if is_exact(a) and a in (-1, 0, 1):
        return a**n
    bits = max(a.numerator.bit_length(), a.denominator.bit_length()) if is_exact(a) else 2
    if (bits - 1) * n > MOST_BITS or n > MOST_BITS:
        raise Undefined("the power is too large")
    return bounded(a**n)


def _root(a: int | Fraction, b: Fraction, pi: AnyScalar) -> AnyScalar:
    """a ^ (m/n) of an exact number, in the arithmetic of pi."""
    if a == 0 and b < 0:
        raise Undefined(f"division by zero in 0^({b})")
    if a < 0:
        raise Undefined("a broken power of a negative number")
    if type(pi) is Node:
        return pi.graph.pow(a, b)
    if b.denominator == 2:
        return _whole_power(function_value("sqrt", (a,), pi), b.numerator)
    if pi is None or isinstance(pi, float):
        try:
            return float(a) ** float(b)
        except OverflowError:
            raise Undefined("the number is too large") from None
    return (a + (pi - pi)) ** b


@overload
def through_samples(sampled: Sampled, t: Node, pi: Any = None) -> Scalar: ...
@overload
def through_samples(sampled: Sampled, t: Any, pi: Any = None) -> Any: ...
def through_samples(sampled: Sampled, t: AnyScalar, pi: AnyScalar = None) -> AnyScalar:
    """The value at t of a function through samples; in the graph it stays one operation."""
    if type(t) is Node:
        return t.graph.call("sampled", t, number_of_sampled(sampled))
    if is_exact(t) and t != 0 and sampled.measure[1]:  # an argument by pi is no rational number
        lifted: Any = math.pi if pi is None else pi
        if type(lifted) is Node:
            return lifted.graph.call("sampled", t, number_of_sampled(sampled))
        return through_samples(sampled, t + (lifted - lifted), lifted)
    if is_exact(t):
        value = sampled.spline.at(Fraction(t) * sampled.measure[0])
        return bounded(value) if sampled.pi_power == 0 else value * (math.pi if pi is None else pi) ** sampled.pi_power
    if isinstance(t, float):
        return sampled.at(t, float, math.pi)
    return sampled.chosen(t, selected, pi)


@dataclass(frozen=True)
class TableFunction:
    """A function that a model declares by a table of values, of an argument and with values in SI."""

    function: Sampled

    def at(self, x: Any, pi: Any) -> Any:
        """The value at any scalar; pi is one of its kind."""
        return through_samples(self.function, x, pi)

    @property
    def rate(self) -> TableFunction:
        """Its derivative."""
        return TableFunction(self.function.derivative())


class AsWritten(Mapping[str, TableFunction]):
    """Functions for the names in a text of our own: each a straight line of its own, which only its name tells."""

    def __getitem__(self, name: str) -> TableFunction:
        if name in NAMES:
            raise KeyError(name)
        slope = Fraction(int.from_bytes(blake2b(name.encode(), digest_size=2).digest()) + 1, 99)
        spline = Spline((Fraction(0),), (Fraction(0),) * 2, ((Fraction(0), slope),) * 2)
        return TableFunction(Sampled(name, spline, called=True))

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0


AS_WRITTEN = AsWritten()


def function_value(name: str, args: tuple[AnyScalar, ...], pi: AnyScalar = None) -> AnyScalar:
    """An elementary function at its arguments; min and max take two or more."""
    if name in ("min", "max"):
        value = args[0]
        for other in args[1:]:
            value = _function(name, (value, other), pi)
        return value
    return _function(name, args, pi)


def _function(name: str, args: tuple[AnyScalar, ...], pi: AnyScalar) -> AnyScalar:
    if not all(is_exact(a) for a in args):
        if all(is_exact(a) or isinstance(a, float) for a in args):
            return function(name, *(float(a) for a in args))
        return function(name, *args)
    exact = _exact_value(name, args)
    if exact is not None:
        return exact
    if type(pi) is Node:
        return pi.graph.call(name, *args)
    if pi is None or isinstance(pi, float):
        return function(name, *(float(a) for a in args))
    zero = pi - pi
    return function(name, *(a + zero for a in args))


def _exact_value(name: str, args: tuple[Number, ...]) -> Number | None:
    """The function's value where it is an exact number for every arithmetic, else None."""
    a = args[0]
    if name == "abs":
        return -a if a < 0 else a
    if name == "sign":
        return (a > 0) - (a < 0)
    if name in ("min", "max"):
        return min(args) if name == "min" else max(args)
    if name == "sqrt":
        if a < 0:
            raise Undefined(f"sqrt({a}) is not a real number")
        root = Fraction(isqrt(a.numerator), isqrt(a.denominator))
        return bounded(root) if root * root == a else None
    if a == 0 and name in ("sin", "tan", "asin", "atan", "sinh", "tanh"):
        return 0
    if a == 0 and name in ("cos", "cosh", "exp"):
        return 1
    return 0 if a == 1 and name in ("log", "acos") else None


# -------- formula ---------------------------------------------------------------------------------------------


Value = TypeVar("Value")
Instruction = tuple[str, Any]
"""("number", value) | ("name", name) | ("neg", None) | ("+" "-" "*" "/" "^", None) | ("function", (name, count))
| ("call", Call) | ("sampled", Sampled): a function through samples, of what stands before it | ("part", n): once more
what stands n below the top, a part with a name | ("under", names): the parts that stand below the top are done with"""


@dataclass(frozen=True, slots=True)
class Reference:
    """A name as an argument: of a constraint (`B`), a body, a point (`arm.end`), a member (`n1-n2`), a coordinate."""

    name: str
    column: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Call:
    """A function of the outputs at its arguments: `speed(bar.end)`, `frequency(1)`."""

    name: str
    args: tuple[Reference | Expression, ...]
    column: int = field(default=0, compare=False)

    def __str__(self) -> str:
        return f"{self.name}({', '.join(a.name if isinstance(a, Reference) else a.text for a in self.args)})"

    def name_at(self, k: int) -> str:
        """The argument k of a call, a name.

        Raises:
            DerivationError: it is none.
        """
        argument = self.args[k]
        if not isinstance(argument, Reference):
            what = f"'{self}': names are needed as arguments"
            raise DerivationError(what, fix="give names of the model, not formulas")
        return argument.name

    @property
    def names(self) -> tuple[str, ...]:
        """The arguments of a call, all of them names.

        Raises:
            DerivationError: one is none.
        """
        return tuple(self.name_at(k) for k in range(len(self.args)))


@dataclass(frozen=True, slots=True)
class Expression:
    """A formula of the model file, as a tree of our own that any scalar can evaluate.

    Args:
        text: what the user wrote (not compared: `a+b` equals `a + b`).
        code: the tree in postfix order.
        columns: of each piece of code, where it stands in the text, from 0 (-1: it stands nowhere).
        typed: True if a person typed it in place of what a model declares.
    """

    text: str = field(compare=False)
    code: tuple[Instruction, ...]
    columns: tuple[int, ...] = field(compare=False, repr=False)
    typed: bool = field(default=False, repr=False)

    @staticmethod
    def number(value: int | Fraction) -> Expression:
        """The expression that is this exact number."""
        exact = Fraction(value)
        tidy = exact.numerator if exact.denominator == 1 else exact
        return Expression(str(tidy), (("number", tidy),), (0,))

    def __str__(self) -> str:
        return self.text

    @staticmethod
    def through_samples(sampled: Sampled, text: str) -> Expression:
        """A function of time through samples."""
        return Expression(text, (("name", "t"), ("sampled", sampled)), (-1, -1))

    @property
    def sampled(self) -> Sampled | None:
        """The function of time through samples that this is, or None."""
        of_time = len(self.code) == 2 and self.code[0] == ("name", "t") and self.code[1][0] == "sampled"
        return self.code[1][1] if of_time and not self.code[1][1].called else None

    def named(self, name: str) -> Expression:
        """The same; a function through samples with a name by which it is printed."""
        return self if self.sampled is None else Expression.through_samples(self.sampled.named(name), self.text)

    @property
    def literal(self) -> int | Fraction | None:
        """The number that was written, or None where it is more than a number."""
        return self.code[0][1] if len(self.code) == 1 and self.code[0][0] == "number" else None

    @property
    def is_plain(self) -> bool:
        """True if it is a number: no names but pi, and no function of an output."""
        return self.names <= {"pi"} and not self.calls

    @property
    def call(self) -> Call | None:
        """The function of the outputs that this is, or None where it is another expression."""
        calls = tuple(self.calls)
        return calls[0] if len(calls) == 1 and len(self.code) == 1 else None

    @property
    def occurrences(self) -> tuple[tuple[str, int], ...]:
        """Every (name, column) as written, those inside the arguments of calls too."""
        found: list[tuple[str, int]] = []
        for (kind, what), column in zip(self.code, self.columns, strict=True):
            if kind == "name" and column >= 0:
                found.append((what, column))
            elif kind == "call":
                found += [pair for a in what.args if isinstance(a, Expression) for pair in a.occurrences]
        return tuple(found)

    @property
    def names(self) -> frozenset[str]:
        """The names on which the value depends, with their primes; `t` and `pi` too, functions not."""
        found = {what for kind, what in self.code if kind == "name"}
        for call in self.calls:
            found.update(*(a.names for a in call.args if isinstance(a, Expression)))
        return frozenset(found)

    @property
    def parts(self) -> tuple[str, ...]:
        """The names that were given to parts of it: `a` in "a = sin(q); a^2"."""
        return tuple(name for kind, what in self.code if kind == "under" for name in what)

    @property
    def calls(self) -> tuple[Call, ...]:
        """The functions of outputs that stand in it, in the order written (those in their arguments not)."""
        return tuple(what for kind, what in self.code if kind == "call")

    @property
    def all_calls(self) -> tuple[Call, ...]:
        """The functions of outputs and of tables that stand in it, each before those in its arguments."""
        inner = (a for call in self.calls for a in call.args if isinstance(a, Expression))
        return (*self.calls, *(call for a in inner for call in a.all_calls))

    def evaluate(self, lookup: Mapping[str, Value], call: Callable[[Call], Value] | None = None) -> Value:
        """The value, in the arithmetic of the values given.

        Args:
            lookup: value of each name (`theta`, `theta'`, `t`), and of `pi`, whose kind of scalar is the
                one in which functions of plain numbers (sqrt(2)) are taken.
            call: value of a function of the outputs.
        Raises:
            ExpressionError: an unknown name; no value there (1/0); a call where none has a meaning. It
                carries the column.
        """
        stack: list[Value] = []
        pi = lookup.get("pi")
        for position, (kind, what) in enumerate(self.code):
            if kind == "number":
                stack.append(what)
            elif kind == "name":
                stack.append(self._looked_up(what, lookup, position))
            elif kind == "call" and f"{what.name}(" in lookup:
                stack.append(self._of_table(what, lookup, call, position))
            elif kind == "call":
                stack.append(self._called(what, call))
            else:
                self._operate(stack, kind, what, pi, position)
        return stack[0]

    def _looked_up(self, name: str, lookup: Mapping[str, AnyScalar], position: int) -> AnyScalar:
        try:
            return lookup[name]
        except KeyError:
            raise unknown("name", name, lookup, self.columns[position]) from None

    def _of_table(
        self, what: Call, lookup: Mapping[str, AnyScalar], call: Callable[[Call], AnyScalar] | None, position: int
    ) -> AnyScalar:
        """The value of a table of the model, which the mapping has under its name with a bracket: M( of M(n)."""
        if len(what.args) != 1:
            raise ExpressionError(
                f"'{what.name}' takes 1 argument", what.column, f"write {what.name}(x)", len(what.name)
            )
        (x,) = what.args
        table: Any = lookup[f"{what.name}("]
        name = x.name if isinstance(x, Reference) else ""
        inner = x.evaluate(lookup, call) if isinstance(x, Expression) else self._looked_up(name, lookup, position)
        found: AnyScalar = table.at(inner, lookup.get("pi"))
        return found

    def _called(self, what: Call, call: Callable[[Call], AnyScalar] | None) -> AnyScalar:
        if call is None:
            raise ExpressionError(f"'{what}' can only stand in [outputs]", what.column, length=len(what.name))
        return call(what)

    def _operate(self, stack: list[AnyScalar], kind: str, what: Any, pi: AnyScalar, position: int) -> None:
        try:
            apply_operation(stack, kind, what, pi)
        except (Undefined, DerivationError) as error:
            raise ExpressionError(str(error), self.columns[position]) from error
        except (ZeroDivisionError, OverflowError, ValueError) as error:
            shown = what[0] if kind == "function" else kind
            raise ExpressionError(f"'{shown}' has no value here: {error}", self.columns[position]) from error

    def scaled(self, factor: Fraction, pi_power: int = 0) -> Expression:
        """factor * pi^pi_power * this; the columns stay those of the source."""
        if factor == 1 and pi_power == 0:
            return self
        if self.sampled is not None:
            return Expression.through_samples(self.sampled.scaled(factor, pi_power), self.text)
        literal, code, columns = self.literal, list(self.code), list(self.columns)
        if literal is not None:
            scaled = Expression.number(literal * factor)
            text, code = scaled.text, list(scaled.code)
        else:
            text = f"{Fraction(factor)}*({self.text})"
            code += [("number", Expression.number(factor).literal), ("*", None)]
            columns += [-1, -1]
        if pi_power:
            text = f"{text}*pi" if pi_power == 1 else f"{text}*pi^({pi_power})"
            code += [("name", "pi"), ("number", pi_power), ("^", None), ("*", None)]
            columns += [-1] * 4
        return Expression(text, tuple(code), tuple(columns))

    # -- a scalar like any other: laws written over any scalar also write formulas ------------------

    def __add__(self, other: Operand) -> Expression:
        return _joined(self, "+", other)

    def __radd__(self, other: Operand) -> Expression:
        return _joined(other, "+", self)

    def __sub__(self, other: Operand) -> Expression:
        return _joined(self, "-", other)

    def __rsub__(self, other: Operand) -> Expression:
        return _joined(other, "-", self)

    def __mul__(self, other: Operand) -> Expression:
        return _joined(self, "*", other)

    def __rmul__(self, other: Operand) -> Expression:
        return _joined(other, "*", self)

    def __truediv__(self, other: Operand) -> Expression:
        return _joined(self, "/", other)

    def __rtruediv__(self, other: Operand) -> Expression:
        return _joined(other, "/", self)

    def scalar_sin(self) -> Expression | int:
        return 0 if self.literal == 0 else _applied("sin", self)

    def scalar_cos(self) -> Expression | int:
        return 1 if self.literal == 0 else _applied("cos", self)

    def value_at(self, values: Mapping[str, Number | float]) -> Number | float | None:
        """The value of an expression at these values (`pi` among them); None with other names, or without a value."""
        if not self.names <= values.keys():
            return None
        try:
            found: Number | float = self.evaluate(values)
        except ExpressionError:
            return None
        return found


Operand = Expression | int | Fraction


def _joined(a: Operand, sign: str, b: Operand) -> Expression:
    """a sign b, written out; exact numbers are calculated, a zero that is added and a one that multiplies left out."""
    a, b = (x if isinstance(x, Expression) else Expression.number(x) for x in (a, b))
    if a.literal is not None and b.literal is not None and not (sign == "/" and b.literal == 0):
        return Expression.number(_BINARY[sign](a.literal, b.literal))
    if sign == "*" and 0 in (a.literal, b.literal):
        return Expression.number(0)
    neutral = 0 if sign in "+-" else 1
    if b.literal == neutral:
        return a
    if a.literal == neutral and sign in "+*":
        return b
    return _composed(f"{_enclosed(a, sign)} {sign} {_enclosed(b, sign, last=True)}", (a, b), (sign, None))


def _applied(function: str, a: Expression) -> Expression:
    return _composed(f"{function}({a.text})", (a,), ("function", (function, 1)))


def _composed(text: str, parts: tuple[Expression, ...], operation: Instruction) -> Expression:
    """The expression of an operation on others; it stands nowhere in a text."""
    code = (*(step for part in parts for step in part.code), operation)
    return Expression(text, code, (-1,) * len(code))


def _enclosed(a: Expression, sign: str, last: bool = False) -> str:
    """An operand in parentheses, where it needs them next to the sign."""
    outermost, what = a.code[-1]
    if outermost == "number":
        alone = what >= 0 and type(what) is int
    elif outermost in "+-*/":
        alone = sign in "+-" and (outermost in "*/" or not last)
    else:
        alone = outermost in ("name", "function", "call")
    return a.text if alone else f"({a.text})"


_BINARY = {
    "+": add,
    "-": subtract,
    "*": multiply,
    "/": divide,
}


def apply_operation(stack: list[AnyScalar], kind: str, what: Any, pi: AnyScalar) -> None:
    """Replaces the operands on top of the stack by the result of one operation."""
    if kind == "neg":
        stack[-1] = -stack[-1]
    elif kind == "part":
        stack.append(stack[-1 - what])
    elif kind == "under":
        del stack[-1 - len(what) : -1]
    elif kind == "sampled":
        stack[-1] = through_samples(what, stack[-1], pi)
    elif kind == "function":
        name, count = what
        args = tuple(stack[-count:])
        stack[-count:] = [function_value(name, args, pi)]
    else:
        b = stack.pop()
        stack[-1] = power_value(stack[-1], b, pi) if kind == "^" else _BINARY[kind](stack[-1], b)


def unknown(kind: str, name: str, known: Iterable[str], column: int) -> ExpressionError:
    """The error for a name that is not known, with the nearest one that is."""
    near = difflib.get_close_matches(name, list(known), n=1)
    fix = f"did you mean '{near[0]}'?" if near else ""
    return ExpressionError(f"unknown {kind} '{name}'", column, fix, len(name))


# -------- functions -------------------------------------------------------------------------------------------
# The elementary functions over any scalar: float, exact number, graph node, sympy expression.
#
# The laws of mechanics call these and never `math` or `sympy`, so one text of a law serves all scalars.


NAMES = {
    "sin": 1,
    "cos": 1,
    "tan": 1,
    "asin": 1,
    "acos": 1,
    "atan": 1,
    "atan2": 2,
    "sinh": 1,
    "cosh": 1,
    "tanh": 1,
    "sqrt": 1,
    "exp": 1,
    "log": 1,
    "abs": 1,
    "sign": 1,
    "min": 2,
    "max": 2,
}
"""The functions of the model file's grammar and how many arguments each takes (min and max: two or more)."""


@overload
def function(name: str, *args: Scalar) -> Scalar: ...
@overload
def function(name: str, *args: Any) -> Any: ...
def function(name: str, *args: Any) -> Any:
    """The function of the table NAMES at its arguments, in the arithmetic of the arguments.

    At exact numbers it stays exact: sqrt(4) is 2, sqrt(2) a node of the graph CONSTANTS.
    """
    for a in args:
        if type(a) is Node:
            return a.graph.call(name, *args)
    if all(isinstance(a, EXACT) for a in args):
        return CONSTANTS.call(name, *args)
    if all(isinstance(a, (float, *EXACT)) for a in args):
        return _at_floats(name, *map(float, args))
    own = getattr(type(args[0]), f"scalar_{name}", None)
    if own is not None:
        return own(*args)
    return _sympy_function(name, *args)


def _at_floats(name: str, *args: float) -> float:
    if name in ("min", "max"):
        return min(args) if name == "min" else max(args)
    if name == "abs":
        return abs(args[0])
    if name == "sign":
        return float((args[0] > 0) - (args[0] < 0))
    return float(getattr(math, name)(*args))


def _sympy_function(name: str, *args: Any) -> Any:
    import sympy

    known_to_sympy()

    names = {"abs": "Abs", "min": "Min", "max": "Max"}
    return getattr(sympy, names.get(name, name))(*(sympy.sympify(a, strict=True) for a in args))


@overload
def sin(a: Scalar) -> Scalar: ...
@overload
def sin(a: Any) -> Any: ...
def sin(a: Any) -> Any:
    return 0 if type(a) is int and a == 0 else function("sin", a)


@overload
def cos(a: Scalar) -> Scalar: ...
@overload
def cos(a: Any) -> Any: ...
def cos(a: Any) -> Any:
    return 1 if type(a) is int and a == 0 else function("cos", a)


@overload
def sqrt(a: Scalar) -> Scalar: ...
@overload
def sqrt(a: Any) -> Any: ...
def sqrt(a: Any) -> Any:
    return function("sqrt", a)


@overload
def over(a: Scalar, b: Scalar) -> Scalar: ...
@overload
def over(a: Any, b: Any) -> Any: ...
def over(a: Any, b: Any) -> Any:
    """a / b, exact when both are exact (Python's int / int would be a float)."""
    if isinstance(a, int) and isinstance(b, int):
        quotient = Fraction(a, b)
        return quotient.numerator if quotient.denominator == 1 else quotient
    return a / b


@overload
def inner(a: Iterable[Scalar], b: Iterable[Scalar]) -> Scalar: ...
@overload
def inner(a: Iterable[Any], b: Iterable[Any]) -> Any: ...
def inner(a: Iterable[Any], b: Iterable[Any]) -> Any:
    """The sum of a_k b_k; what is multiplied by 0 is not looked at."""
    return sum((x * y for x, y in zip(a, b, strict=True) if not is_zero(x) and not is_zero(y)), start=0)


def selected(a: Any, bound: Any, if_below: Any, if_above: Any) -> Any:
    """if_below where a <= bound, else if_above: a piecewise law over any scalar."""
    for x in (a, bound):
        if type(x) is Node:
            return x.graph.select(x.graph.call("less_equal", a, bound), if_below, if_above)
    if all(isinstance(x, (float, *EXACT)) for x in (a, bound)):
        return if_below if a <= bound else if_above
    import sympy

    known_to_sympy()

    return sympy.Piecewise((if_below, a <= bound), (if_above, True))
