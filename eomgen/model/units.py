"""Dimensions and units of names: inferred from every sum, function and field; of values as typed and as shown."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache, cached_property
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic, nearest
from eomgen.model.fields import Leaf, Table, WrittenEquation, named
from eomgen.model.inference import (
    NUMBER,
    SECOND,
    TIME,
    Clash,
    Dimension,
    Inference,
    Walk,
    dimension_of_unit,
    in_words,
    quoted,
)
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.outputs.base import DRY_JOINT, formula_at
from eomgen.model.parts import Coordinate, Output, StateVariable
from eomgen.model.quantities import Typed, Unit, read_typed, unit_for_name
from eomgen.symbolic.expression import Call, Expression, Fraction, Reference, parse

# -------- dimensions -------------------------------------------------------------------------------------------
# Dimensions: every sum, every function and every field of the model is an equation between them.

PER_NAME = ("coordinate", "coordinate or speed")
RATES = {"start": 0, "near": 0, "motion": 0, "speed": 1, "rate": 1, "acceleration": 2}
"""The fields of a coordinate: how often it is differentiated in each."""


def dimensions(catalog: Catalog) -> Iterator[Diagnostic]:
    """Terms whose declared units do not fit one another, or the place in which they stand."""
    yield from inferred(catalog).errors


@dataclass(frozen=True)
class Inferred:
    """Dimensions of a model, as far as they follow from its units and expressions.

    Args:
        errors: places where declared units contradict one another.
        warnings: places where inferred ones do.
        names: the dimension of every name, with its unknowns.
    """

    errors: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...]
    names: Names
    found: dict[str, Dimension]


class Names:
    """The dimension of each name of a model: declared, or an unknown that is inferred."""

    def __init__(self, catalog: Catalog) -> None:
        self.inference = Inference()
        self.declared: dict[str, Unit] = {}
        for table in ("parameters", "coordinates", "states", "inputs", "unknowns"):
            parts = catalog.table(table).items()
            self.declared |= {name: part.unit for name, part in parts if part is not None and part.unit is not None}
        self._known = {name: dimension_of_unit(unit) for name, unit in self.declared.items()}
        turns = (getattr(body.joint, "omega", None) for body in catalog.table("bodies").values() if body is not None)
        self._known |= {name: SECOND.raised(-1) for names in turns for name in names or ()}
        self._known |= {"t": SECOND, "pi": NUMBER}
        self.frictions = {name: "N*m" if turns else "N" for name, turns in catalog.joints_with_friction.items()}
        closing = ((name, part.impulse_unit(catalog)) for name, part in catalog.table("constraints").items() if part)
        self.impulses = {name: unit for name, unit in closing if unit}
        self.moves = frozenset((*catalog.table("coordinates"), *catalog.table("states")))
        self.parameters = frozenset(catalog.table("parameters").keys() & self.declared)

    def of(self, name: str, also: dict[str, Dimension] | None = None) -> Dimension:
        """The dimension of a name, a prime for each derivative by time."""
        base = name.rstrip("'")
        known = also[base] if also and base in also else self._known.get(base)
        found = Inference.named(base) if known is None else known
        return found if base == name else found.times(SECOND, len(base) - len(name))

    def of_call(self, call: Call) -> Dimension | None:
        """The dimension of a function of the motion; None where a constraint's gap decides it, or it is unknown."""
        function = FUNCTIONS.get(call.name)
        if function is None or max(function.per, default=-1) >= len(call.args):
            return None
        if function.like is not None:
            return self.walk().of(formula_at(call, function.like))
        found = dimension_of_unit(function.dimension)
        for k in function.per:
            argument, kind = call.args[k], function.kinds[k]
            if call.name == "impulse" and isinstance(argument, Reference) and argument.name in self.impulses:
                return _dimension(self.impulses[argument.name])
            if kind == DRY_JOINT and isinstance(argument, Reference):
                return _dimension(self.frictions[argument.name]) if argument.name in self.frictions else None
            if kind not in PER_NAME or not isinstance(argument, Reference):
                return None
            rate = kind == "coordinate or speed" and argument.name in self.moves
            found = found.times(self.of(argument.name + "'" * rate), -1)
        return found

    def walk(self) -> Walk:
        """A pass over a formula by which its own clashes are not reported."""
        return Walk(self.of, self.inference, self.of_call, self.parameters, self.moves, fixes=False)

    def is_declared(self, name: str) -> bool:
        """True if the file declares it; speeds of joints do not count: `couple = ["-w1", 0, 0]` may hide a factor 1."""
        return (base := name.rstrip("'")) in self.declared or base in TIME


def inferred(catalog: Catalog) -> Inferred:
    """The dimensions that follow from every expression of the model, each examined once."""
    names, sound = Names(catalog), []
    errors: list[Diagnostic] = []
    warnings: list[Diagnostic] = []
    for leaf in catalog.leaves:
        clashes = list(_clashes(catalog, leaf, names, strict=False))[:1]  # what follows from it is no news
        for clash in clashes:
            certain = bool(clash.names) and all(names.is_declared(name) for name in clash.names)
            (errors if certain else warnings).append(_diagnostic(catalog, leaf, clash, names))
        if not clashes:
            sound.append(leaf)
    found = {name: names.inference.reduced(names.of(name)) for name in catalog.symbols if name not in ("t", "pi")}
    strict = (
        _diagnostic(catalog, leaf, clash, names)
        for leaf in sound
        for clash in _clashes(catalog, leaf, names, strict=True)
    )
    return Inferred(tuple(errors), (*warnings, *strict), names, found)


def inferred_units(model: Any) -> dict[str, str]:
    """{name: unit} of what has none in the file, where the expressions say what it must be."""
    found = inferred(Catalog(model, ()))
    return {
        name: str(dimension)
        for name, dimension in found.found.items()
        if name not in found.names.declared and not dimension.unknowns
    }


def _clashes(catalog: Catalog, leaf: Leaf, names: Names, *, strict: bool) -> Iterator[Clash]:
    """Clashes of dimensions in one value of the model."""
    value, rule = leaf.value, leaf.rule
    also = _also(getattr(rule, "also_in", "1")) if getattr(rule, "also", ()) else {}

    def walk() -> Walk:
        known = {name: also[name.rstrip("'")] for name in also}
        return Walk(
            lambda name: names.of(name, known),
            names.inference,
            names.of_call,
            names.parameters,
            moves=names.moves,
            strict=strict,
        )

    if isinstance(value, WrittenEquation):
        first = walk()
        left = first.of(value.left, value.text)
        yield from first.clashes
        second = walk()
        second.of(value.right, value.text, left)
        yield from second.clashes
    elif isinstance(value, Expression) and value.literal is None:  # a number alone fits anything
        one = walk()
        one.of(value, needed=_needed(leaf, names))
        yield from one.clashes


def _also(unit: str) -> dict[str, Dimension]:
    return {"r": _dimension(unit)}


@cache
def _dimension(unit: str) -> Dimension:
    return dimension_of_unit(Unit.parse(unit))


def _needed(leaf: Leaf, names: Names) -> Dimension | None:
    """Dimension that a field needs: by its rule, its part's unit, or the coordinate to which it belongs; None: any."""
    table, rule, part = leaf.path[0], leaf.rule, leaf.part
    key = str(leaf.path[-1])
    if table == "coordinates" and key in RATES:
        return names.of(str(leaf.path[1]) + "'" * RATES[key])
    if table == "states" and key in RATES:
        return names.of(str(leaf.path[1]) + "'" * RATES[key])
    if table in ("parameters", "inputs") and len(leaf.path) < 4:
        return names.of(str(leaf.path[1]))
    if table == "speeds":
        return names.of(str(leaf.path[1]))
    if table == "outputs":
        return None if part.unit is None else dimension_of_unit(part.unit)
    if getattr(rule, "same_as", ""):
        return names.of(getattr(part, rule.same_as) or "")
    if getattr(rule, "works_on", ""):
        return _dimension("J").times(names.of(getattr(part, rule.works_on) or ""), -1)
    given = [slot.rule for slot in part.slots() if slot.name in like] if (like := _like(rule, part)) else [rule]
    unit = getattr(given[0], "unit", None)
    return None if unit is None else _dimension(unit)


def _like(rule: Any, part: Any) -> list[str]:
    """The given field of the part whose unit a value has, where its rule names some."""
    return [name for name in getattr(rule, "like", ()) if getattr(part, name) is not None][:1]


def _diagnostic(catalog: Catalog, leaf: Leaf, clash: Clash, names: Names) -> Diagnostic:
    what, fix = clash.what, clash.fix
    if clash.other is None and not clash.in_function:
        name = clash.one.text
        kind = catalog.symbols.get(name)
        unit = names.declared[name].text if name in names.declared else str(clash.one_is)
        whole = f"{kind} '{name}'" if kind is not None else f"'{name}'"
        equation = isinstance(leaf.value, WrittenEquation)
        needed = str(clash.needed) if equation else _own_text(leaf) or str(clash.needed)
        place = "the left side" if equation else leaf.whereabouts
        what = f"{whole} is in {unit}, but {place} is in {named(needed)}"
        fix = fix or ("" if kind is None else f"give another {kind}, or fix its unit")
    other = None if clash.other is None else (clash.other.column, len(clash.other.text))
    return Diagnostic(leaf.path, what, fix, clash.one.column, len(clash.one.text), beside=other)


def _own_text(leaf: Leaf) -> str | None:
    """The unit of a field as its rule, or its part, writes it."""
    if leaf.path[0] == "outputs" or (
        leaf.path[0] in ("coordinates", "states") and leaf.path[-1] in ("start", "near", "motion")
    ):
        return None if leaf.part is None or leaf.part.unit is None else str(leaf.part.unit.text)
    return getattr(leaf.rule, "unit", None)


# -------- typed ------------------------------------------------------------------------------------------------
# Typed values -> expressions in SI, the interpretation that is reported, and the model that holds them.
#
# On the command line and in [given] a plain number is in the unit that the file declares, and its rate in that unit
# per second; in Python it is in SI. `45 deg`, `(45, "deg")` and quantities of pint bring a unit of their own. With
# names in it an expression is in SI.


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


# -------- units ------------------------------------------------------------------------------------------------

ALWAYS = {"t": "s", "energy": "J"}
OUTPUT = " (output)"  # after the name of an output's column, where another column has that name


class UnitsOfNames:
    """Units of all that a model names: a base of `Model`."""

    coordinates: Table[Coordinate]
    states: Table[StateVariable]
    outputs: Table[Output]

    def in_own_unit(self, name: str, value: float, digits: int = 9) -> str:
        """The value with its unit, where a coordinate or state has one not of SI; a number alone elsewhere."""
        rate = name.endswith("'")
        base = name[:-1] if rate else name
        part = self.coordinates.get(base) or self.states.get(base)
        unit = None if part is None else part.unit
        if unit is None or (unit.factor == 1 and unit.pi_power == 0):
            return f"{value:.{digits}g}"
        return f"{float(unit.from_si(value, math.pi)):.{digits}g} {unit.text}{'/s' * rate}"

    def units_of(self, names: Iterable[str]) -> dict[str, Unit]:
        """The unit of each name or function of the motion that has one: as the file declares it, else that of SI.

        Args:
            names: coordinates, rates, speeds, `t`, `energy`, "reaction_x(A)", "omega(bar)", outputs.
        """
        known = inferred(Catalog(self, ())).names
        found = {name: self._of_output(known, name) or _unit(known, name) for name in names}
        return {name: unit for name, unit in found.items() if unit is not None}

    def _of_output(self, known: Names, name: str) -> Unit | None:
        """The unit of an output's column; None where it is none, or where nobody knows it."""
        output = name.removesuffix(OUTPUT)
        if output not in self.outputs or (name == output and name in known.moves):
            return None
        return _of_answer(known, self.outputs[output])

    @property
    def output_units(self) -> dict[Output, Unit]:
        """The unit of each output: the one that is declared, else that of SI, where the model says which that is."""
        known = inferred(Catalog(self, ())).names
        found = {part: _of_answer(known, part) for part in self.outputs.values()}
        return {part: unit for part, unit in found.items() if unit is not None}

    def units_of_everything(self, speeds: Iterable[str]) -> dict[str, dict[str, str]]:
        """The unit of every name, of the equation of motion along each speed, and of every output; "?" is not known.

        An equation of motion is W per unit of its speed: its terms times the speed are powers.
        """
        found = inferred(Catalog(self, ()))
        known, reduced = found.names, found.names.inference.reduced

        def unit_text(dimension: Dimension) -> str:
            dimension = reduced(dimension)
            return "?" if dimension.unknowns else str(dimension)

        walk, of_outputs = known.walk(), self.output_units
        outputs = {
            name: of_outputs[part].text if part in of_outputs else unit_text(walk.of(part.value))
            for name, part in self.outputs.items()
        }
        names = {
            name: known.declared[name].text if name in known.declared else unit_text(x)
            for name, x in found.found.items()
        }
        power = dimension_of_unit(Unit.parse("W"))
        return {
            "names": names,
            "equations": {u: unit_text(power.times(known.of(u), -1)) for u in speeds},
            "outputs": outputs,
        }


def _of_answer(known: Names, part: Output) -> Unit | None:
    """The declared unit, or that of the function alone (N*m, not J), or by its dimension; None of a number."""
    if part.unit is not None:
        return part.unit
    calls = part.value.calls
    function = FUNCTIONS.get(calls[0].name) if len(part.value.code) == len(calls) == 1 else None
    if function is not None and not function.per and function.like is None:
        return Unit.parse(function.unit)
    if function is not None and (function.kinds[:1] == (DRY_JOINT,) or calls[0].name == "impulse"):
        return _unit(known, part.value.text)
    return _in_si(known.inference.reduced(known.walk().of(part.value)))


def _unit(known: Names, name: str) -> Unit | None:
    if name.endswith(OUTPUT):
        return None
    if name in ALWAYS:
        return Unit.parse(ALWAYS[name])
    call = parse(name, references=True).call
    if call is not None and call.name in FUNCTIONS and not FUNCTIONS[call.name].per:
        return Unit.parse(FUNCTIONS[call.name].unit)
    if call is not None and call.name == "impulse" and (unit := known.impulses.get(call.name_at(0))):
        return Unit.parse(unit)
    if call is not None and call.name == "friction" and (unit := known.frictions.get(call.name_at(0))):
        return Unit.parse(unit)
    declared = known.declared.get(name.rstrip("'"))
    if declared is not None:
        if declared.text == "1":
            return None
        for _ in range(len(name) - len(name.rstrip("'"))):
            declared = declared.rate
        return declared
    dimension = known.inference.reduced((known.of_call(call) or Dimension()) if call else known.of(name))
    return _in_si(dimension)


def _in_si(dimension: Dimension) -> Unit | None:
    """The unit of SI; None of a number, of what is not known, and of a root that is no unit."""
    whole = dimension and not dimension.unknowns and all(n.denominator == 1 for n in map(Fraction, dimension.values()))
    return Unit.parse(str(dimension)) if whole else None
