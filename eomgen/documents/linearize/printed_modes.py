"""The steps of a linearization -> what is printed of its matrices, modes and conditions, in numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from eomgen.documents.document import Document
from eomgen.documents.statements import Formula, Grid, Law, Matrix, Side
from eomgen.documents.text import cell_text
from eomgen.proof.small_motions_told import PrintedModes
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate


def printed_modes(derivation: Document) -> PrintedModes:
    """Formulas at the values of the parameters; where one has none, nan."""
    statements = [s for step in derivation.steps for s in step.statements]
    named = list(_named(statements))
    values = {name: _number(x) for name, x in derivation.parameters.items() if x is not None}
    matrices: dict[str, Any] = {}
    for name, side in named:
        if isinstance(side, Matrix):
            rows = [[_worth(x, values) for x in row] for row in side.rows]
            if not any(math.isnan(x) for row in rows for x in row):
                matrices[name] = rows  # of the two that are called B that of the states, the last
    grids = {cell_text(s.head[0]): s for s in statements if isinstance(s, Grid)}
    modes, shapes = grids.get("mode"), grids.get("shape")
    return PrintedModes(
        matrices,
        []
        if modes is None
        else [dict(zip(map(cell_text, modes.head), map(cell_text, r), strict=True)) for r in modes.rows],
        {} if shapes is None else {cell_text(q): list(map(cell_text, cells)) for q, *cells in shapes.rows},
        [_worth(side, values) for name, side in named if name.startswith("h_")],
    )


def _named(statements: list[Any]) -> Iterator[tuple[str, Side]]:
    """(M, what it is) of formulas that begin with a letter."""
    for statement in statements:
        if isinstance(statement, Formula) and isinstance(statement.sides[0], Law) and len(statement.sides) == 2:
            yield statement.sides[0].text, statement.sides[1]


def _number(value: Any) -> float:
    """The value of a parameter: an angle in degrees is an expression of pi."""
    return float(evaluate((value,), {}, FLOAT)[0] if isinstance(value, Node) else value)


def _worth(side: Any, values: Mapping[str, float]) -> float:
    if isinstance(side, Law):
        try:
            return float(side.text)
        except ValueError:
            return math.nan
    if not isinstance(side, Node):
        return float(side)
    symbols = symbols_of((side,))
    if any(x.name not in values for x in symbols):
        return math.nan
    return float(evaluate((side,), {x: values[x.name] for x in symbols}, FLOAT)[0])
