"""Document -> JSON; the content of `derive --json`.

Document -> JSON: its entries, its steps; formulas as text that the grammar of the model file reads back.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from eomgen.documents.document import Document
from eomgen.documents.equation_steps import multiplier_forces
from eomgen.documents.latex import names_in, setter_of
from eomgen.documents.reaction_values import reactions_payload
from eomgen.documents.reading import TRIED, Reader, without_cases
from eomgen.documents.statements import Formula, Grid, Prose, Quantity, Statement, Table
from eomgen.documents.text import cell_text, formula_text, prose_text, side_text, statement_lines
from eomgen.files import json_text
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.model import Taken
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.print import text_size, to_text, with_definitions
from eomgen.version import SCHEMA_VERSION

name = "json"


def render(document: Document) -> str:
    """The document as a JSON text."""
    return json_text(as_dict(document), indent=1) + "\n"


def as_dict(document: Document) -> dict[str, Any]:
    """The document as plain data; of one without entries its printed text."""
    entries = document.entries() or _printed(document)
    own: dict[str, Any] = {"warnings": [each.as_dict() for each in document.warnings]} if document.title else {}
    own |= {"taken": taken_as_dict(document.taken)} if document.title else {}
    if document.has_heads:
        own |= {"steps": steps(document), "symbols": symbols(document)}
    return {"schema_version": SCHEMA_VERSION, **_plain(entries), **own}


def taken_as_dict(taken: Iterable[Taken]) -> dict[str, dict[str, Any]]:
    """Typed values by name; a name that was typed twice, as a start and an instant, has its whole text as the key."""
    found: dict[str, dict[str, Any]] = {}
    for each in taken:
        found[str(each) if each.name in found else each.name] = each.as_dict()
    return found


def symbols(document: Document) -> dict[str, str]:
    """The LaTeX of every symbol of the steps, by its name in their formulas."""
    names, notation = names_in(document), setter_of(document).notation
    return {name: notation.latex(name) for name in names}


def _plain(entry: Any) -> Any:
    """An entry, with quantities as their known values."""
    if isinstance(entry, Quantity):
        return entry.as_dict()
    if isinstance(entry, Mapping):
        return {key: _plain(inner) for key, inner in entry.items()}
    return [_plain(inner) for inner in entry] if isinstance(entry, (list, tuple)) else entry


def _printed(document: Document) -> dict[str, Any]:
    return {
        "name": document.title,
        "about": document.about,
        "source": document.source,
        "space": document.space,
        "method": document.method,
        "definitions": [[symbol.name, to_text(value)] for symbol, value in document.definitions],
        "equations": [
            {
                "speed": equation.speed.name,
                "left": to_text(equation.left),
                "right": to_text(equation.right),
                "divisor": to_text(equation.divisor),
            }
            for equation in document.equations
        ],
    }


def steps(document: Document) -> list[dict[str, Any]]:
    """The steps, each a list of prose, formulas and tables."""
    return [
        {"key": step.key, "title": step.title, "statements": [_statement(s) for s in step.statements]}
        for step in document.steps
    ]


def _statement(statement: Statement) -> dict[str, Any]:
    if isinstance(statement, Prose):
        return {"kind": "prose", "text": prose_text(statement)}
    if isinstance(statement, Formula):
        return {"kind": "formula", "text": formula_text(statement)}
    if isinstance(statement, Grid):
        head, *lines = (list(map(cell_text, row)) for row in (statement.head, *statement.rows))
        return {"kind": "grid", "head": head, "rows": lines}
    if not isinstance(statement, Table):
        return {"kind": "lines", "lines": statement_lines(statement)}
    rows = [
        {"symbol": side_text(row.symbol), "meaning": row.meaning, "unit": row.unit, "value": row.value}
        for row in statement.rows
    ]
    return {"kind": "table", "rows": rows}


# -------- payload ---------------------------------------------------------------------------------------------
# Equations -> what `derive --json` carries, as plain data. Every expression is text that the grammar reads back.
#
# q' = N u + nu,   M a = forcing + J^T lam,   J a + gamma = 0


LARGEST = 16_000_000  # characters of all expressions together that are written out in full
NAMED_PART = 200  # characters of a text in which long parts have names


@dataclass(frozen=True)
class Texts:
    """The expressions of the payload as texts.

    Args:
        fields: the scalars, by entry.
        definitions: (name, text) of parts that have a name, each before its use.
        texts: of all scalars, one entry after the other.
    """

    fields: Mapping[str, Field]
    definitions: Sequence[tuple[str, str]]
    texts: Sequence[str]

    @property
    def scalars(self) -> Iterator[tuple[str, Scalar]]:
        """(entry, scalar), as they belong to the texts."""
        return ((name, x) for name, field in self.fields.items() for x in field.scalars)


def payload_texts(equations: EquationsOfMotion) -> Texts:
    """Texts of the equations of motion in the payload, the reactions left out."""
    fields = _fields(equations)
    definitions, texts = _texts(
        [x for field in fields.values() for x in field.scalars], equations.system.scope.positive, _taken(equations)
    )
    return Texts(fields, definitions, texts)


def equations_payload(equations: EquationsOfMotion, method: str, found: Texts) -> dict[str, Any]:
    """The equations of motion as plain data, ready for JSON.

    Matrices are lists of rows, vectors flat lists. Small expressions are multiplied out. Where everything written out
    would be longer than 16 megabytes, long and repeated parts stand under `definitions`, [[name, text], ...], each
    before its use.
    """
    model, symbols = equations.system.scope.model, equations.symbols
    definitions, rest = found.definitions, iter(found.texts)
    written = {name: field.shaped([next(rest) for _ in field.scalars]) for name, field in found.fields.items()}
    sides = written.pop("equations")
    values = model.exact_parameters()
    return {
        "name": model.name,
        "space": model.space,
        "source": model.source or "",
        "method": method,
        "coordinates": [q.name for q in symbols.q],
        "speeds": [u.name for u in symbols.u],
        "states": [z.name for z in symbols.z],
        "parameters": {name: float(values[name]) if name in values else None for name in symbols.parameters},
        "inputs": {name: part.value.text for name, part in model.inputs.items()},
        **({"definitions": [list(pair) for pair in definitions]} if definitions else {}),
        **written,
        "unknowns": [x.name for x in (*symbols.a, *symbols.lam)],
        "generalized_forces": dict(zip((u.name for u in symbols.u), written["generalized_forces"], strict=True)),
        "equations": [f"{left} = {right}" for left, right in sides],
        "state_rates": dict(zip((z.name for z in symbols.z), written["state_rates"], strict=True)),
        **reactions_payload(equations, _taken(equations) | {name for name, _ in definitions}),
    }


@dataclass(frozen=True)
class Field:
    """The scalars of one entry of the payload, and how its texts stand together.

    Args:
        scalars: in order.
        rows: of a matrix, each as long as the others; None for a flat list.
        single: one text instead of a list.
        present: for a list with nulls, which of its places have a scalar.
    """

    scalars: tuple[Scalar, ...]
    rows: int | None = None
    single: bool = False
    present: tuple[bool, ...] | None = None

    def shaped(self, texts: Sequence[str]) -> Any:
        """The texts of the scalars in the entry's shape."""
        if self.single:
            return texts[0]
        if self.rows is not None:
            width = len(texts) // max(self.rows, 1)
            return [list(texts[width * i : width * (i + 1)]) for i in range(self.rows)]
        if self.present is None:
            return list(texts)
        found = iter(texts)
        return [next(found) if there else None for there in self.present]


def _fields(equations: EquationsOfMotion) -> dict[str, Field]:
    """Every expression of the payload."""
    gaps = tuple(gap for gap in equations.phi if gap is not None)
    return {
        "kinematic_matrix": _matrix(equations.N),
        "kinematic_bias": Field(equations.nu),
        "mass_matrix": _matrix(equations.M),
        "forcing": Field(equations.forcing),
        "constraint_jacobian": _matrix(equations.J),
        "velocity_bias": Field(equations.sigma),
        "constraint_bias": Field(equations.gamma),
        "gaps": Field(gaps, present=tuple(gap is not None for gap in equations.phi)),
        "kinetic_energy": Field((equations.T,), single=True),
        "potential_energy": Field((equations.V,), single=True),
        "generalized_forces": Field(equations.Q),
        "equations": Field(_sides(equations), rows=len(equations.symbols.u)),
        "state_rates": Field(equations.state_rates),
    }


def _matrix(rows: Sequence[Sequence[Scalar]]) -> Field:
    return Field(tuple(x for row in rows for x in row), rows=len(rows))


def _sides(equations: EquationsOfMotion) -> tuple[Scalar, ...]:
    """Left and right of M a + c = Q + J^T lam, row by row."""
    sides: list[Scalar] = []
    for k, reaction in enumerate(multiplier_forces(equations)):
        left = sum((m * a for m, a in zip(equations.M[k], equations.symbols.a, strict=True)), start=equations.c[k])
        sides += [left, equations.Q[k] + reaction]
    return tuple(sides)


def _texts(
    scalars: Sequence[Scalar], positive: frozenset[Node], taken: frozenset[str]
) -> tuple[list[tuple[str, str]], list[str]]:
    """The texts, and the named parts that they share where all in full would be too long."""
    whole = sum(text_size(x) for x in scalars)
    written = without_cases(Reader(positive=positive).short(scalars) if whole <= TRIED * len(scalars) else scalars)
    if sum(text_size(x) for x in written) <= LARGEST:
        return [], [to_text(x) for x in written]
    return with_definitions(without_cases(scalars), NAMED_PART, taken)


def _taken(equations: EquationsOfMotion) -> frozenset[str]:
    """Names that no named part may have."""
    s = equations.symbols
    symbols: tuple[Node, ...] = (s.t, *s.parameters.values(), *s.inputs.values(), *s.x, *s.a, *s.lam)
    return frozenset(symbol.name for symbol in symbols)
