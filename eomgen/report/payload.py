"""Equations -> what `derive --json` carries, as plain data. Every expression is text that the grammar reads back.

q' = N u + nu,   M a = forcing + J^T lam,   J a + gamma = 0
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.model.values import exact_parameters
from eomgen.report.equation_steps import multiplier_forces
from eomgen.report.reaction_payload import reactions_payload
from eomgen.report.reading import TRIED, Reader, without_cases
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.print.text import text_size, to_text, with_definitions

LARGEST = 16_000_000  # characters of all expressions together that are written out in full
NAMED_PART = 200  # characters of a text in which long parts have names


def equations_payload(system: System, assembly: Assembly, method: str) -> dict[str, Any]:
    """The equations of motion as plain data, ready for JSON.

    Matrices are lists of rows, vectors flat lists. Small expressions are multiplied out. Where everything written out
    would be longer than 16 megabytes, long and repeated parts stand under `definitions`, [[name, text], ...], each
    before its use.
    """
    model, symbols = system.scope.model, assembly.symbols
    fields = _fields(system, assembly)
    definitions, texts = _texts([x for field in fields.values() for x in field.scalars], _taken(assembly))
    rest = iter(texts)
    written = {name: field.shaped([next(rest) for _ in field.scalars]) for name, field in fields.items()}
    sides = written.pop("equations")
    values = exact_parameters(model)
    return {
        "name": model.name,
        "space": model.space,
        "source": model.source or "",
        "method": method,
        "coordinates": [q.name for q in symbols.q],
        "speeds": [u.name for u in symbols.u],
        "parameters": {name: float(values[name]) if name in values else None for name in symbols.parameters},
        "inputs": {name: part.value.text for name, part in model.inputs.items()},
        **({"definitions": [list(pair) for pair in definitions]} if definitions else {}),
        **written,
        "unknowns": [x.name for x in (*symbols.a, *symbols.lam)],
        "generalized_forces": dict(zip((u.name for u in symbols.u), written["generalized_forces"], strict=True)),
        "equations": [f"{left} = {right}" for left, right in sides],
        **reactions_payload(system, assembly, _taken(assembly) | {name for name, _ in definitions}),
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


def _fields(system: System, assembly: Assembly) -> dict[str, Field]:
    """Every expression of the payload."""
    gaps = tuple(gap for gap in assembly.phi if gap is not None)
    return {
        "kinematic_matrix": _matrix(assembly.N),
        "kinematic_bias": Field(assembly.nu),
        "mass_matrix": _matrix(assembly.M),
        "forcing": Field(assembly.forcing),
        "constraint_jacobian": _matrix(assembly.J),
        "velocity_bias": Field(assembly.sigma),
        "constraint_bias": Field(assembly.gamma),
        "gaps": Field(gaps, present=tuple(gap is not None for gap in assembly.phi)),
        "kinetic_energy": Field((assembly.T,), single=True),
        "potential_energy": Field((assembly.V,), single=True),
        "generalized_forces": Field(assembly.Q),
        "equations": Field(_sides(assembly), rows=len(assembly.symbols.u)),
    }


def _matrix(rows: Sequence[Sequence[Scalar]]) -> Field:
    return Field(tuple(x for row in rows for x in row), rows=len(rows))


def _sides(assembly: Assembly) -> tuple[Scalar, ...]:
    """Left and right of M a + c = Q + J^T lam, row by row."""
    sides: list[Scalar] = []
    for k, reaction in enumerate(multiplier_forces(assembly)):
        left = sum((m * a for m, a in zip(assembly.M[k], assembly.symbols.a, strict=True)), start=assembly.c[k])
        sides += [left, assembly.Q[k] + reaction]
    return tuple(sides)


def _texts(scalars: Sequence[Scalar], taken: frozenset[str]) -> tuple[list[tuple[str, str]], list[str]]:
    """The texts, and the named parts that they share where all in full would be too long."""
    whole = sum(text_size(x) for x in scalars)
    written = without_cases(Reader().short(scalars) if whole <= TRIED * len(scalars) else scalars)
    if sum(text_size(x) for x in written) <= LARGEST:
        return [], [to_text(x) for x in written]
    return with_definitions(without_cases(scalars), NAMED_PART, taken)


def _taken(assembly: Assembly) -> frozenset[str]:
    """Names that no named part may have."""
    s = assembly.symbols
    symbols: tuple[Node, ...] = (s.t, *s.parameters.values(), *s.inputs.values(), *s.q, *s.u, *s.a, *s.lam)
    return frozenset(symbol.name for symbol in symbols)
