"""Freedom, assembly modes -> lines of text: degrees of freedom, closing, reacting and redundant rows, the modes."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.documents import listed
from eomgen.mechanics.constraints import Freedom, VelocityRow
from eomgen.mechanics.start import AssemblyMode, Branches
from eomgen.model import Model
from eomgen.symbolic.print import to_text


def freedom_lines(model: Model, freedom: Freedom) -> list[str]:
    """Lines that state the degrees of freedom by rank and by formula, and the reasons for both."""
    if freedom.by_rank is None:
        lines = [f"degrees of freedom: not counted yet ({freedom.not_counted})"]
        return lines if freedom.by_formula is None else [*lines, _formula_line(model, freedom)]
    lines = [f"degrees of freedom: {freedom.by_rank} by rank", _formula_line(model, freedom)]
    lines += (
        [f"constraints that close: {_constraints(freedom.closing_rows, freedom.identical)}"] if freedom.closing else []
    )
    lines += (
        [f"constraints that only react: {_constraints(freedom.identical_rows, freedom.closing)}"]
        if freedom.identical
        else []
    )
    lines += _velocity_lines(freedom)
    for row in freedom.redundant:
        alone = "the joints" if row.by_joints else "its other rows"
        others = f", it follows from {listed(row.others) if row.others else alone}"
        lines.append(f"redundant: row {row.number} of constraint '{row.constraint}'{others}")
    return lines


def _constraints(rows: Sequence[tuple[str, int]], beside: Sequence[str]) -> str:
    """Names the constraints of rows, with row numbers where other rows of it are named too: floor (rows 2 and 3)."""
    return listed(
        f"{constraint} ({_numbered(numbers)})" if constraint in beside else constraint
        for constraint, numbers in _by_constraint(rows).items()
    )


def _by_constraint(rows: Sequence[tuple[str, int]]) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    for constraint, number in rows:
        found.setdefault(constraint, []).append(number)
    return found


def _numbered(numbers: Sequence[int]) -> str:
    """row 1; rows 1, 2 and 3"""
    *before, last = map(str, numbers)
    return f"rows {', '.join(before)} and {last}" if before else f"row {last}"


def _velocity_lines(freedom: Freedom) -> list[str]:
    """Lines about velocity constraints: the holonomic ones with their integrals, and the degrees of freedom in
    position."""
    found = freedom.integrability
    if found is None:
        return []
    free = [row for row in found.rows if not row.integrable]
    lines = [f"not integrable (nonholonomic): {listed(_rows(free))}"] if free else []
    kept: dict[str, list[VelocityRow]] = {}
    for row in found.rows:
        if row.integrable:
            kept.setdefault("" if row.integral is None else f": {to_text(row.integral)} = 0", []).append(row)
    lines += [f"integrable (holonomic): {each}{integral}" for integral, rows in kept.items() for each in _rows(rows)]
    more = found.positions != freedom.by_rank
    return [*lines, f"degrees of freedom in position: {found.positions}"] if more else lines


def _rows(rows: Sequence[VelocityRow]) -> list[str]:
    """row 1 of constraint 'edge', rows 2 and 3 of constraint 'wheel'"""
    named = _by_constraint([(row.constraint, row.number) for row in rows])
    return [f"{_numbered(numbers)} of constraint '{constraint}'" for constraint, numbers in named.items()]


def _formula_line(model: Model, freedom: Freedom) -> str:
    placed = [name for name, body in model.bodies.items() if body.joint is None or not body.joint.carries_reaction]
    remark = f"; {listed(placed)}: placed, counted as free" if placed else ""
    return f"count by formula: {freedom.by_formula} = {freedom.formula or '0'}{remark}"


MOST_REPORTED = 5  # other ways


def branch_lines(model: Model, branches: Branches | None) -> list[str]:
    """The way at the start, the others, and the meaning of (+), (-), left and right."""
    if branches is None:
        return []
    sided = _sided(branches)
    lines = [f"loops at the start: {_reported(branches.here, sided)}"]
    if not branches.others:
        return lines
    others, more = (
        [_reported(each, sided) for each in branches.others[:MOST_REPORTED]],
        len(branches.others) - MOST_REPORTED,
    )
    others += [f"and {more} more ways"] if more > 0 else []
    kept = f" with the same {listed(branches.kept)}" if branches.kept else ""
    also = [f"they also close{kept} at {others[0]}"] if len(others) == 1 else [f"they also close{kept} at"]
    return [*lines, *also, *(f"  {each}" for each in others if len(others) > 1), *_keys(model, branches, sided)]


def _sided(branches: Branches) -> tuple[str, ...]:
    """The pins that do not lie on the same side in all ways."""
    here = {side.constraint: side.left for side in branches.here.sides}
    others = [{side.constraint: side.left for side in each.sides} for each in branches.others]
    return tuple(
        constraint for constraint, left in here.items() if any(each.get(constraint, left) != left for each in others)
    )


def _reported(branch: AssemblyMode, sided: tuple[str, ...]) -> str:
    """beta = 0.48, gamma = 1.57 (-), 'B' on the left"""
    sides = [f"'{s.constraint}' on the {'left' if s.left else 'right'}" for s in branch.sides if s.constraint in sided]
    return ", ".join([str(branch), *sides])


def _keys(model: Model, branches: Branches, sided: tuple[str, ...]) -> list[str]:
    here, first = branches.here, branches.others[0]
    sign = f"(+) and (-): det d phi/d({listed(here.values)}), which is 0 in a dead centre, where two ways meet"
    lines = [sign] if here.sign else []
    lines += [
        f"left and right of '{s.constraint}': of the line from the hinge of '{s.first}' to that of '{s.second}'"
        for s in here.sides
        if s.constraint in sided
    ]
    near = ", ".join(f"{name} = {{ near = {_number(model, name, x)} }}" for name, x in first.values.items())
    return [f"  {line}" for line in (*lines, f"another way is taken from a start near it: {near}")]


def _number(model: Model, name: str, value: float) -> str:
    """A guess as it stands in the model file, in the unit of the coordinate."""
    return model.in_own_unit(name, value, 4).split()[0]
