"""sympy's functions of time -> names of a model and texts of its grammar."""

from __future__ import annotations

import math
import re
from collections.abc import Container, Mapping, Sequence
from contextlib import suppress
from dataclasses import field
from decimal import Decimal
from functools import cached_property
from random import Random
from typing import Any

import sympy
from sympy.physics.vector import dynamicsymbols

from eomgen.errors import DerivationError, ExpressionError
from eomgen.records import dataclass
from eomgen.robots.drawn_up import LegalNames
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.expressions import LONGEST, LONGEST_WITH_PARTS, parse
from eomgen.symbolic.expression.graph import Graph, Node, Scalar
from eomgen.symbolic.expression.rational import Fraction, fraction_of
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.sympy_form import scalar_from_sympy
from eomgen.symbolic.print.text import text_size, to_text, with_definitions

NAMED_PART = 400  # characters of a part that gets a name of its own
PLAIN = re.compile(r"[{}\\^]")  # of sympy's names, as in \dot{q}


@dataclass
class Words:
    """The names that sympy's symbols get, each the nearest that is legal.

    Args:
        q, u: coordinates and speeds, functions of time; a speed that is a rate is called as that.
        rates: {u: its coordinate} of speeds that are rates.
    """

    q: Sequence[Any]
    u: Sequence[Any] = ()
    rates: Mapping[Any, Any] = field(default_factory=dict)
    names: LegalNames = field(default_factory=LegalNames)
    parameters: dict[Any, str] = field(default_factory=dict)
    inputs: dict[Any, str] = field(default_factory=dict)
    graph: Graph = field(default_factory=Graph)

    @cached_property
    def moving(self) -> dict[Any, str]:
        """The names of q, q', q'', u and u'."""
        t = dynamicsymbols._t
        own = {q: self.names.new(_plain(q), "q") for q in self.q}
        found = {q.diff(t, k): name + k * "'" for q, name in own.items() for k in range(3)}
        for u in self.u:
            name = f"{own[self.rates[u]]}'" if u in self.rates else self.names.new(_plain(u), "u")
            found |= {u: name, u.diff(t): f"{name}'"}
        return found

    def of(self, symbol: Any) -> str:
        """The name of a coordinate, rate or speed."""
        return self.moving[symbol]

    @cached_property
    def nodes(self) -> dict[str, Node]:
        """The symbols of the graph by name; parameters and inputs come as they are met."""
        return {name: self.graph.symbol(name) for name in ("t", *self.moving.values())}

    def scalar(self, expression: Any) -> Scalar:
        """An expression in the symbols of the graph.

        Raises:
            DerivationError: what a model has no word for.
        """
        t = dynamicsymbols._t
        expression = sympy.sympify(expression, strict=True)
        moving = {x: sympy.Symbol(name) for x, name in self.moving.items()} | {t: sympy.Symbol("t")}
        standing = expression.xreplace(moving)
        for rate in sorted(standing.atoms(sympy.Derivative), key=str):
            what = f"the rate {rate} of a given function of time stands in the equations"
            raise DerivationError(what, mend="make it a coordinate, and give that its `motion` in the model")
        functions = expression.atoms(sympy.core.function.AppliedUndef) - moving.keys()
        known = moving | {x: sympy.Symbol(self._input(x)) for x in _sorted(functions)}
        parameters = expression.free_symbols - {t}  # before anything else is called as they are
        known |= {x: sympy.Symbol(self._parameter(x)) for x in _sorted(parameters)}
        return scalar_from_sympy(with_rationals(expression.xreplace(known)), self.nodes)

    def _input(self, function: Any) -> str:
        """Raises: DerivationError: it is no function of time alone."""
        if function.args != (dynamicsymbols._t,):
            raise DerivationError(f"{function} is a function that sympy does not know", mend="put its formula in")
        if function not in self.inputs:
            self.inputs[function] = self._new(_plain(function), "input")
        return self.inputs[function]

    def _parameter(self, symbol: Any) -> str:
        if symbol not in self.parameters:
            self.parameters[symbol] = self._new(_plain(symbol), "p")
        return self.parameters[symbol]

    def _new(self, wanted: str, otherwise: str) -> str:
        name = self.names.new(wanted, otherwise)
        self.nodes[name] = self.graph.symbol(name)
        return name

    def texts(self, expressions: Sequence[Any]) -> list[Any]:
        """Expressions as they stand in a model file, each in its shorter form."""
        return file_texts([self.scalar(x) for x in expressions])

    def text(self, expression: Any) -> Any:
        return self.texts([expression])[0]


def with_rationals(expression: Any) -> Any:
    """An expression or matrix in which decimals are the numbers that are written."""
    return expression.xreplace({x: sympy.Rational(str(x)) for x in expression.atoms(sympy.Float)})


def file_texts(scalars: Sequence[Scalar], taken: Container[str] = ()) -> list[Any]:
    """Scalars as they stand in a model file, numbers as decimals where they end.

    What would be longer than a formula may be has its parts named before it: "z1 = sin(q); z1^2 + z1".

    Args:
        taken: names that no part may have.
    Raises:
        DerivationError: one is longer than a model file may have it even so.
    """
    shortest = [min((simplest(x, Work.FORMULA), x), key=text_size) for x in scalars]
    found = [_written(x, taken) if (value := _decimal(x)) is None else value for x in shortest]
    _refuse_misread(scalars, found)
    return found


def _refuse_misread(scalars: Sequence[Scalar], found: Sequence[Any]) -> None:
    """Refuses texts that, read back by the grammar, are worth another number than what they stand for.

    Raises:
        DerivationError: one is.
    """
    rng, symbols = Random(41), symbols_of(scalars)
    state = {x: rng.uniform(0.5, 1.0) for x in sorted(symbols, key=lambda x: x.name)}
    names = {x.name: value for x, value in state.items()} | {"pi": math.pi}
    for x, text in zip(scalars, found, strict=True):
        if not isinstance(text, str):
            continue
        with suppress(NoValue, ExpressionError, ArithmeticError, ValueError):  # a root of what is negative there
            (due,) = evaluate((x,), state, FLOAT)
            read = float(parse(text, longest=LONGEST_WITH_PARTS).evaluate(names))
            if abs(read - due) > COMPUTED * (1 + abs(due)):
                what = f"a formula of sympy is written as another one, {read:.9g} for {due:.9g}: {text[:60]}"
                raise DerivationError(what, mend="this is a mistake of eomgen: please report it")


def _written(x: Scalar, taken: Container[str]) -> str:
    if text_size(x) <= LONGEST:
        return to_text(x)
    definitions, (text,) = with_definitions([x], NAMED_PART, taken)
    found = "; ".join([*(f"{name} = {part}" for name, part in definitions), text])
    if len(found) > LONGEST_WITH_PARTS:
        what = f"an energy or a force takes {len(found)} characters to write"
        mend = "give sympy's System its joints, or sympy shorter frames and velocities"
        raise DerivationError(f"{what}, of which a model file may have {LONGEST_WITH_PARTS}", mend=mend)
    return found


def _decimal(x: Scalar) -> Decimal | None:
    """A number whose decimals end."""
    if type(x) is Node:
        return None
    found = Decimal(int(Fraction(x).numerator)) / Decimal(int(Fraction(x).denominator))
    return found if fraction_of(str(found)) == x else None


def speeds_as_rates(q: Sequence[Any], u: Sequence[Any], kinematic: Sequence[Any]) -> dict[Any, Any]:
    """{speed: coordinate} of the speeds that are rates, by what vanishes of q' and u."""
    t = dynamicsymbols._t
    found = {x.diff(t): x for x in q if x.diff(t) in list(u)}  # a rate that was given for the speed
    for x in kinematic:
        for coordinate in (each for each in q if x.has(each.diff(t))):
            for speed in (each for each in u if x.has(each)):
                if (difference := (coordinate.diff(t) - speed)) in (x, -x) or sympy.expand(x**2 - difference**2) == 0:
                    found[speed] = coordinate
    return found


def _plain(symbol: Any) -> str:
    name = symbol.name if isinstance(symbol, sympy.Symbol) else symbol.func.__name__
    return PLAIN.sub("", name)


def _sorted(symbols: Any) -> list[Any]:
    return sorted(symbols, key=lambda x: (str(x), sympy.default_sort_key(x)))
