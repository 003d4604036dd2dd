"""A parsed text as a value: Expression, and the Call and Reference that outputs are made of.

The tree is held in postfix order, so that a sum of a thousand terms is evaluated by a loop and two
texts with the same tree are equal. Where in the text each piece stands is kept beside it, for carets.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import field
from typing import Any, TypeVar

from eomgen.errors import DerivationError, ExpressionError
from eomgen.records import dataclass
from eomgen.symbolic.expression import scalar_operations
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.scalar_operations import AnyScalar
from eomgen.symbolic.expression.splines import Sampled

Value = TypeVar("Value")
Instruction = tuple[str, Any]
"""("number", value) | ("name", name) | ("neg", None) | ("+" "-" "*" "/" "^", None) | ("function", (name, count))
| ("call", Call) | ("sampled", Sampled): a function through samples, of what stands before it | ("part", n): once more
what stands n below the top, a part with a name | ("under", names): the parts that stand below the top are done with"""


@dataclass(frozen=True, slots=True)
class Reference:
    """What an argument names: a tie (`B`), a body, a point (`arm.end`), a member (`n1-n2`), a coordinate."""

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


@dataclass(frozen=True, slots=True)
class Expression:
    """A formula of the model file, as a tree of our own that any scalar can evaluate.

    Args:
        text: what the user wrote (not compared: `a+b` equals `a + b`).
        code: the tree in postfix order.
        columns: of each piece of code, where it stands in the text, from 0 (-1: it stands nowhere).
        typed: whether a person typed it in place of what a model declares.
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
        """The function through samples that this is, or None."""
        return self.code[1][1] if len(self.code) == 2 and self.code[1][0] == "sampled" else None

    def named(self, name: str) -> Expression:
        """The same; a function through samples with a name by which it is printed."""
        return self if self.sampled is None else Expression.through_samples(self.sampled.named(name), self.text)

    @property
    def literal(self) -> int | Fraction | None:
        """The number that was written, or None where it is more than a number."""
        return self.code[0][1] if len(self.code) == 1 and self.code[0][0] == "number" else None

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

    def _called(self, what: Call, call: Callable[[Call], AnyScalar] | None) -> AnyScalar:
        if call is None:
            raise ExpressionError(f"'{what}' can only be asked in [outputs]", what.column, length=len(what.name))
        return call(what)

    def _operate(self, stack: list[AnyScalar], kind: str, what: Any, pi: AnyScalar, position: int) -> None:
        try:
            apply_operation(stack, kind, what, pi)
        except (scalar_operations.Undefined, DerivationError) as error:
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
    """An operand in parentheses, where it needs them beside the sign."""
    outermost, what = a.code[-1]
    if outermost == "number":
        alone = what >= 0 and type(what) is int
    elif outermost in "+-*/":
        alone = sign in "+-" and (outermost in "*/" or not last)
    else:
        alone = outermost in ("name", "function", "call")
    return a.text if alone else f"({a.text})"


_BINARY = {
    "+": scalar_operations.add,
    "-": scalar_operations.subtract,
    "*": scalar_operations.multiply,
    "/": scalar_operations.divide,
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
        stack[-1] = scalar_operations.through_samples(what, stack[-1], pi)
    elif kind == "function":
        name, count = what
        args = tuple(stack[-count:])
        stack[-count:] = [scalar_operations.function_value(name, args, pi)]
    else:
        b = stack.pop()
        stack[-1] = scalar_operations.power_value(stack[-1], b, pi) if kind == "^" else _BINARY[kind](stack[-1], b)


def unknown(kind: str, name: str, known: Iterable[str], column: int) -> ExpressionError:
    """The error for a name that is not known, with the nearest one that is."""
    near = difflib.get_close_matches(name, list(known), n=1)
    mend = f"did you mean '{near[0]}'?" if near else ""
    return ExpressionError(f"unknown {kind} '{name}'", column, mend, len(name))
