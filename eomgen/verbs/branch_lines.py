"""Branches -> lines of text: in which ways the loops close, by what these differ, and how another is chosen."""

from __future__ import annotations

from eomgen.mechanics.initial_state.assembly_modes import AssemblyMode, Branches
from eomgen.model.own_units import in_own_unit
from eomgen.model.parts import Model
from eomgen.verbs.outcome import listed

MOST_TOLD = 5  # other ways


def branch_lines(model: Model, branches: Branches | None) -> list[str]:
    """The way at the start, the others, and what (+), (-), left and right are of."""
    if branches is None:
        return []
    sided = _sided(branches)
    lines = [f"loops at the start: {_told(branches.here, sided)}"]
    if not branches.others:
        return lines
    others, more = [_told(each, sided) for each in branches.others[:MOST_TOLD]], len(branches.others) - MOST_TOLD
    others += [f"and {more} more ways"] if more > 0 else []
    kept = f" with the same {listed(branches.kept)}" if branches.kept else ""
    also = [f"they also close{kept} at {others[0]}"] if len(others) == 1 else [f"they also close{kept} at"]
    return [*lines, *also, *(f"  {each}" for each in others if len(others) > 1), *_keys(model, branches, sided)]


def _sided(branches: Branches) -> tuple[str, ...]:
    """The pins that do not lie on the same side in all ways."""
    here = {side.tie: side.left for side in branches.here.sides}
    others = [{side.tie: side.left for side in each.sides} for each in branches.others]
    return tuple(tie for tie, left in here.items() if any(each.get(tie, left) != left for each in others))


def _told(branch: AssemblyMode, sided: tuple[str, ...]) -> str:
    """beta = 0.48, gamma = 1.57 (-), 'B' on the left"""
    sides = [f"'{s.tie}' on the {'left' if s.left else 'right'}" for s in branch.sides if s.tie in sided]
    return ", ".join([str(branch), *sides])


def _keys(model: Model, branches: Branches, sided: tuple[str, ...]) -> list[str]:
    here, first = branches.here, branches.others[0]
    sign = f"(+) and (-): det d phi/d({listed(here.values)}), which is 0 in a dead centre, where two ways meet"
    lines = [sign] if here.sign else []
    lines += [
        f"left and right of '{s.tie}': of the line from the hinge of '{s.first}' to that of '{s.second}'"
        for s in here.sides
        if s.tie in sided
    ]
    near = ", ".join(f"{name} = {{ near = {_number(model, name, x)} }}" for name, x in first.values.items())
    return [f"  {line}" for line in (*lines, f"another way is taken from a start near it: {near}")]


def _number(model: Model, name: str, value: float) -> str:
    """A guess as it stands in the model file, in the unit of the coordinate."""
    return in_own_unit(model, name, value, 4).split()[0]
