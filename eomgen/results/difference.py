"""Equations of two models -> Difference: what is declared otherwise, and which equations of motion differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from eomgen.documents import Document, Formula, Grid, Statement, Step, document_of, prose, sides_of
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.model import Model
from eomgen.symbolic.exact import book_form, equal_at_random_states
from eomgen.symbolic.expression import Graph, Scalar, symbols_of
from eomgen.symbolic.numeric import Work, transplanted
from eomgen.symbolic.print import to_text

DECLARED = ("coordinates", "speeds", "states", "parameters", "inputs", "bodies", "constraints", "forces")


@dataclass(frozen=True)
class Compared:
    """One equation in both models, R = 0.

    Args:
        name: of the speed along which it is, or of a constraint's row.
        first, second: R in this model and in the other; None where one does not have it.
        same: True if they are the same function, with a factor of 1.
    """

    name: str
    first: Scalar | None
    second: Scalar | None
    same: bool

    @property
    def status(self) -> str:
        if self.first is None or self.second is None:
            return "removed" if self.second is None else "added"
        return "same" if self.same else "changed"


@dataclass(frozen=True)
class Difference:
    """The equations of motion of two models, side by side.

    Args:
        declared: {table of parts: (names that only the other model declares, names that only this one declares)}.
        values: the values of parameters that both have, where they differ [SI].
        equations: every equation of motion and every row that closes a constraint, of either.
    """

    first: Model
    second: Model
    declared: Mapping[str, tuple[list[str], list[str]]]
    values: Mapping[str, tuple[float | None, float | None]]
    equations: tuple[Compared, ...]

    def entries(self) -> Mapping[str, Any]:
        """Entries of the JSON document."""
        return {
            "name": self.first.name,
            "other": self.second.name,
            "same": not (self.declared or self.values or any(x.status != "same" for x in self.equations)),
            "declared": {table: {"added": new, "removed": old} for table, (new, old) in self.declared.items()},
            "values": {name: list(pair) for name, pair in self.values.items()},
            "equations": [
                {
                    "of": x.name,
                    "status": x.status,
                    "this": None if x.first is None else to_text(x.first),
                    "other": None if x.second is None else to_text(x.second),
                    "difference": to_text(_difference(x)) if x.status == "changed" else None,
                }
                for x in self.equations
            ],
        }

    @property
    def steps(self) -> tuple[Step, ...]:
        """Sections of the text: the declarations, then the equations of motion."""
        return (*self._declarations, Step("equations", "Equations of motion", tuple(self._statements)))

    @property
    def _declarations(self) -> tuple[Step, ...]:
        rows = [(table, ", ".join(new), ", ".join(old)) for table, (new, old) in self.declared.items()]
        values = [(name, _shown(a), _shown(b)) for name, (a, b) in self.values.items()]
        reported: list[Statement] = []
        if rows:
            reported.append(Grid(("declared", "only in the other", "only in this one"), tuple(rows)))
        if values:
            reported.append(Grid(("value of", "in this one", "in the other"), tuple(values)))
        return (Step("declared", "What is declared", tuple(reported)),) if reported else ()

    @property
    def _statements(self) -> list[Statement]:
        by_status = {status: [x for x in self.equations if x.status == status] for status in ("same", "changed")}
        reported: list[Statement] = []
        if by_status["same"]:
            names = ", ".join(x.name for x in by_status["same"])
            reported.append(prose(f"The same in both, as functions of all names: {names}."))
        for x in by_status["changed"]:
            assert x.first is not None and x.second is not None
            reported += [prose(f"Along {x.name}, here and in the other, and the other less this one:")]
            reported += [Formula((side, 0)) for side in (x.first, x.second)] + [Formula((_difference(x),))]
        for x in self.equations:
            if x.status in ("added", "removed"):
                where = "in the other" if x.status == "added" else "in this one"
                reported += [prose(f"Along {x.name}, only {where}:"), Formula((_present(x), 0))]
        return reported or [prose("Nothing is free to move in either.")]


def difference_of(first: EquationsOfMotion, second: EquationsOfMotion) -> Difference:
    """The equations of motion of two models, compared."""
    own, other, graph = first.system.scope.model, second.system.scope.model, Graph()
    rows = [_rows(e, graph) for e in (first, second)]
    equations = (_compared(name, *(row.get(name) for row in rows)) for name in dict.fromkeys((*rows[0], *rows[1])))
    return Difference(own, other, _declared(own, other), _values(own, other), tuple(equations))


def _declared(first: Model, second: Model) -> dict[str, tuple[list[str], list[str]]]:
    found = {}
    for table in DECLARED:
        own, other = (list(getattr(model, table) or ()) for model in (first, second))
        found[table] = ([x for x in other if x not in own], [x for x in own if x not in other])
    return {table: names for table, names in found.items() if any(names)}


def _values(first: Model, second: Model) -> dict[str, tuple[float | None, float | None]]:
    own, other = (model.exact_parameters() for model in (first, second))
    shared = [name for name in first.parameters if name in second.parameters]
    pairs = {name: (own.get(name), other.get(name)) for name in shared}
    return {
        name: (None if a is None else float(a), None if b is None else float(b))
        for name, (a, b) in pairs.items()
        if a != b
    }


def difference_document(first: EquationsOfMotion, second: EquationsOfMotion) -> Document:
    """Differences of the second of two models from the first, not proven yet."""
    found = difference_of(first, second)
    model, other = found.first, found.second
    return replace(document_of(model, f"difference from {other.name}", found.steps), entries=found.entries)


def _rows(equations: EquationsOfMotion, graph: Graph) -> dict[str, Scalar]:
    """R of every equation by its name, over the symbols of a common graph; symbols of one name are one."""
    named = {u.name.removesuffix("'"): R for u, R in zip(equations.symbols.u, _residuals(equations), strict=True)}
    rows = zip(equations.system.constraints.closing, equations.J, equations.gamma, strict=True)
    for row, J, gamma in rows:
        terms = (x * a for x, a in zip(J, equations.symbols.a, strict=True))
        named[row.label] = sum(terms, start=gamma)
    states = zip(equations.symbols.z, equations.state_rates, strict=True)
    named |= {z.name: z.graph.symbol(f"{z.name}'") - rate for z, rate in states}
    scalars = tuple(named.values())
    meanings: dict[str, Scalar] = {symbol.name: graph.symbol(symbol.name) for symbol in symbols_of(scalars)}
    readable = (book_form(x, Work.FORMULA) for x in transplanted(scalars, graph, meanings))
    return dict(zip(named, readable, strict=True))


def _residuals(equations: EquationsOfMotion) -> Sequence[Scalar]:
    """M a - forcing - J^T lam."""
    sides = sides_of(equations, equations.M, [0] * len(equations.M), equations.forcing)
    return [row.left - row.right for row in sides]


def _compared(name: str, first: Scalar | None, second: Scalar | None) -> Compared:
    if first is None or second is None:
        return Compared(name, first, second, same=False)
    return Compared(name, first, second, same=equal_at_random_states([(first, second)]).equal)


def _difference(x: Compared) -> Scalar:
    assert x.first is not None and x.second is not None
    return book_form(x.second - x.first, Work.FORMULA)


def _present(x: Compared) -> Scalar:
    found = x.second if x.first is None else x.first
    assert found is not None
    return found


def _shown(value: float | None) -> str:
    return "" if value is None else f"{value:.10g}"
