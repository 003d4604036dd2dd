"""Values in SI -> as a user writes them: 28.6 deg, 90 deg/s; the unit of every name and function."""

from __future__ import annotations

import math
from collections.abc import Iterable

from eomgen.model.catalog import Catalog
from eomgen.model.dimensions import Names, inferred
from eomgen.model.fields import Table
from eomgen.model.inference import Dimension, dimension_of_unit
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.outputs.base import DRY_JOINT
from eomgen.model.parts import Coordinate, Output, StateVariable
from eomgen.model.quantities import Unit
from eomgen.symbolic.expression import Fraction, parse

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
