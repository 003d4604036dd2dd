"""Derivation -> JSON: the same steps, formulas as text that the grammar of the model file reads back."""

from __future__ import annotations

import json
from typing import Any

from eomgen.report.statements import Derivation, Formula, Grid, Prose, Statement
from eomgen.report.text import cell_text, formula_text, prose_text, side_text
from eomgen.symbolic.print.text import to_text

name = "json"

VERSION = 1


def render(derivation: Derivation) -> str:
    """The derivation as a JSON text."""
    return json.dumps(as_dict(derivation), indent=2, ensure_ascii=False) + "\n"


def as_dict(derivation: Derivation) -> dict[str, Any]:
    """The derivation as plain data."""
    return {
        "schema_version": VERSION,
        "name": derivation.title,
        "about": derivation.about,
        "source": derivation.source,
        "space": derivation.space,
        "method": derivation.method,
        "steps": steps(derivation),
        "definitions": [[symbol.name, to_text(value)] for symbol, value in derivation.definitions],
        "equations": [
            {
                "speed": equation.speed.name,
                "left": to_text(equation.left),
                "right": to_text(equation.right),
                "divisor": to_text(equation.divisor),
            }
            for equation in derivation.equations
        ],
    }


def steps(derivation: Derivation) -> list[dict[str, Any]]:
    """The steps, each a list of prose, formulas and tables."""
    return [
        {"key": step.key, "title": step.title, "statements": [_statement(s) for s in step.statements]}
        for step in derivation.steps
    ]


def _statement(statement: Statement) -> dict[str, Any]:
    if isinstance(statement, Prose):
        return {"kind": "prose", "text": prose_text(statement)}
    if isinstance(statement, Formula):
        return {"kind": "formula", "text": formula_text(statement)}
    if isinstance(statement, Grid):
        head, *lines = (list(map(cell_text, row)) for row in (statement.head, *statement.rows))
        return {"kind": "grid", "head": head, "rows": lines}
    rows = [
        {"symbol": side_text(row.symbol), "meaning": row.meaning, "unit": row.unit, "value": row.value}
        for row in statement.rows
    ]
    return {"kind": "table", "rows": rows}
