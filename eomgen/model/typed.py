"""Typed values -> expressions in SI, the interpretation that is reported, and the model that holds them.

On the command line and in [given] a plain number is in the unit that the file declares, and its rate in that unit per
second; in Python it is in SI. `45 deg`, `(45, "deg")` and quantities of pint bring a unit of their own. With names in
it an expression is in SI.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import nearest
from eomgen.model.dimensions import Inferred, inferred
from eomgen.model.fields import WrittenEquation
from eomgen.model.inference import Dimension, Walk, dimension_of_unit, in_words, quoted
from eomgen.model.quantities import Typed, Unit, read_typed, unit_for_name
from eomgen.symbolic.expression import Expression, parse


@dataclass(frozen=True)
class Settled:
    """The value of something that was typed.

    Args:
        name: of what it is the value: "theta'", or one side of an equation.
        value: in SI.
        unit: the one that is declared, else the one that was typed; None: neither is.
        dimension: of it, as far as it is known.
    """

    name: str
    typed: str
    value: Expression
    unit: Unit | None
    dimension: Dimension


@dataclass(frozen=True)
class Typing:
    """Rules by which typed values are read for one model.

    Args:
        declared: True if plain numbers are in the units that the file declares; else they are in SI.
    """

    model: Any
    declared: bool

    @cached_property
    def _inferred(self) -> Inferred:
        return inferred(Catalog(self.model, ()))

    def value(self, name: str, typed: Typed) -> Settled:
        """The value of a parameter, coordinate, rate or speed.

        Raises:
            ExpressionError: it is none, or its unit does not fit.
        """
        expression, unit = read_typed(typed)
        return self._settled(parse(name), expression, unit, shown(typed))

    def equation(self, typed: WrittenEquation) -> tuple[WrittenEquation, tuple[Settled, ...]]:
        """An equation in SI, of which one side may be a plain number or have a unit; and what these were taken as.

        Raises:
            ExpressionError: a unit does not fit.
        """
        sides, found = [typed.left, typed.right], []
        if typed.units is None or (not self.declared and typed.units == (None, None)):
            return replace(typed, units=None), ()
        for k, (side, unit) in enumerate(zip((typed.left, typed.right), typed.units, strict=True)):
            other = (typed.right, typed.left)[k]
            if unit is None and (not side.is_plain or side.literal == 0 or other.is_plain):
                continue
            settled = self._settled(other, side, unit, side.text if unit is None else f"{side.text} {unit}")
            sides[k] = settled.value
            found.append(settled)
        return WrittenEquation(sides[0], sides[1], typed.text), tuple(found)

    # -- one value -------------------------------------------------------------------------------------

    def _settled(self, of: Expression, value: Expression, unit: Unit | None, typed: str) -> Settled:
        """A value of something, in SI."""
        own, needed, plain = self._declared(of), self._needed(of), value.is_plain
        if unit is None and self.declared and plain:
            unit = self._unit_of_plain(of, value, own)
        if unit is not None:
            _refuse_unfit(of, unit, own, needed)
            value = unit.expression_in_si(value)
        elif not plain:
            self._refuse_clash(of, value, needed)
        return Settled(of.text, typed, value, own or unit, needed)

    def _unit_of_plain(self, of: Expression, value: Expression, own: Unit | None) -> Unit | None:
        """The unit in which a plain number is meant."""
        units = [self._declared(parse(name)) for name in sorted(of.names)] if own is None else [own]
        foreign = [unit for unit in units if unit is not None and (unit.factor != 1 or unit.pi_power)]
        needed = self._needed(of)
        turned = [unit for unit in foreign if unit.pi_power and dimension_of_unit(unit) == needed]
        if "pi" in value.names and turned:
            raise _ambiguous(f"'{value.text}' has pi in it, and", of, value, turned[0])
        if own is None and foreign and any(dimension_of_unit(unit) == needed for unit in foreign):
            (unit, *_) = [unit for unit in foreign if dimension_of_unit(unit) == needed]
            raise _ambiguous(f"'{value.text}' has no unit, and what stands in", of, value, unit)
        return own

    def _declared(self, of: Expression) -> Unit | None:
        """The unit that the file declares for a name; of a rate per second."""
        name = of.text if len(of.code) == 1 and of.code[0][0] == "name" else ""
        unit = self._inferred.names.declared.get(name.rstrip("'"))
        for _ in range(len(name) - len(name.rstrip("'"))):
            unit = None if unit is None else unit.rate
        return unit

    def _needed(self, of: Expression) -> Dimension:
        """The dimension of a name, or of one side of an equation."""
        names = self._inferred.names
        return names.inference.reduced(Walk(names.of, names.inference, names.of_call, fixes=False).of(of))

    def _refuse_clash(self, of: Expression, value: Expression, needed: Dimension) -> None:
        names, symbols = self._inferred.names, Catalog(self.model, ()).symbols
        for name, column in value.occurrences:
            if name.rstrip("'") not in symbols:
                fix = unit_for_name(name, value) or nearest(name, symbols)
                raise ExpressionError(f"unknown name '{name}'", column, fix, len(name))
        walk = Walk(names.of, names.inference, names.of_call, names.parameters, names.moves)
        walk.of(value, needed=needed)
        for clash in walk.clashes:
            what = clash.what
            if clash.other is None and not clash.in_function:
                what = f"{quoted(clash.one)} is {in_words(clash.one_is)}, but '{of.text}' is {in_words(clash.needed)}"
            raise ExpressionError(what, clash.one.column, clash.fix, len(clash.one.text))


def typing_of(model: Any, table: str) -> Typing:
    """Rules by which equations of a table are read: in [given] and [outputs] as on the command line, else in SI."""
    return Typing(model, declared=table in ("given", "outputs"))


def _refuse_unfit(of: Expression, unit: Unit, own: Unit | None, needed: Dimension) -> None:
    known = not needed.unknowns
    if (own is not None and not unit.fits(own)) or (known and dimension_of_unit(unit) != needed):
        right = own.text if own is not None else str(needed) if needed else "radians or a pure number"
        raise ExpressionError(f"the unit '{unit.text}' does not fit: '{of.text}' is in {right}")


def shown(typed: Typed) -> str:
    """A typed value as text, for a message."""
    return " ".join(map(str, typed)) if isinstance(typed, tuple) else str(typed)


def _ambiguous(why: str, of: Expression, value: Expression, unit: Unit) -> ExpressionError:
    """The error of a number that may be meant in the unit of the file, or in SI."""
    number = float(value.evaluate({"pi": math.pi}))
    own = f"{float(unit.from_si(number, math.pi)):.10g}" if "pi" in value.names else value.text
    si = unit.si if unit.si != unit.text else "rad"
    return ExpressionError(
        f"{why} '{of.text}' is declared in {unit.text}", fix=f"write {own} {unit}, or {value.text} {si}"
    )
