"""Document -> JSON: its entries, its steps; formulas as text that the grammar of the model file reads back."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

from eomgen.documents.document import Document
from eomgen.documents.latex import names_in, setter_of
from eomgen.documents.quantity import Quantity
from eomgen.documents.statements import Formula, Grid, Prose, Statement, Table
from eomgen.documents.text import cell_text, formula_text, prose_text, side_text, statement_lines
from eomgen.model.replaced import Taken
from eomgen.symbolic.print.text import to_text
from eomgen.version import SCHEMA_VERSION

name = "json"


def render(document: Document) -> str:
    """The document as a JSON text."""
    return json.dumps(as_dict(document), indent=1, allow_nan=False) + "\n"


def as_dict(document: Document) -> dict[str, Any]:
    """The document as plain data; of one without entries what is printed."""
    entries = document.entries() or _printed(document)
    own: dict[str, Any] = {"warnings": [each.as_dict() for each in document.warnings]} if document.title else {}
    own |= {"taken": taken_as_dict(document.taken)} if document.title else {}
    if document.has_heads:
        own |= {"steps": steps(document), "symbols": symbols(document)}
    return {"schema_version": SCHEMA_VERSION, **_plain(entries), **own}


def taken_as_dict(taken: Iterable[Taken]) -> dict[str, dict[str, Any]]:
    """What was taken, by its name; of a name that was typed twice, as a start and an instant, by all that was said."""
    found: dict[str, dict[str, Any]] = {}
    for each in taken:
        found[str(each) if each.name in found else each.name] = each.as_dict()
    return found


def symbols(document: Document) -> dict[str, str]:
    """The LaTeX of every symbol of the steps, by its name in their formulas."""
    names, notation = names_in(document), setter_of(document).notation
    return {name: notation.latex(name) for name in names}


def _plain(entry: Any) -> Any:
    """An entry, quantities as what is known of them."""
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
