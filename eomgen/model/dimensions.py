"""Dimensions: every sum, every function and every field of the model is an equation between them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import Leaf, WrittenEquation, named
from eomgen.model.inference import NUMBER, SECOND, TIME, Clash, Dimension, Inference, Walk, dimension_of_unit
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.outputs.base import DRY_JOINT, formula_at
from eomgen.model.quantities import Unit
from eomgen.symbolic.expression import Call, Expression, Reference

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
