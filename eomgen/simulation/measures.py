"""System, assembly -> what is measured along a motion at many states: how near it comes to singular positions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import compiled
from eomgen.mechanics.bodies.gimbal import locks_of
from eomgen.mechanics.constraints.elimination import singular_blocks
from eomgen.mechanics.constraints.freedom import rank_of_ties
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.simulation.constraint_rank import PLACE, Measure, Nearness
from eomgen.simulation.independence import ConstraintRank
from eomgen.symbolic.expression.graph import Scalar


def measure(system: System, outputs: tuple[Scalar, ...], p: np.ndarray) -> Measure:
    """(t n, x n x states) -> the outputs at each state, n x outputs."""
    function = compiled(program_of(outputs, system.symbols, inputs=system.inputs), "numpy")
    one = function.at(p)

    def along(t: Any, x: Any) -> np.ndarray:
        return one(t[0], x[0])[None, :] if len(x) == 1 and np.ndim(t) else function.many(t, x, p)

    return along


@dataclass(frozen=True)
class Undetermined:
    """What vanishes where something of the motion is not determined.

    Args:
        determinants: (t n, x n x states) -> n x k.
        what: (t n, x n x states) -> of each determinant, what is not determined where it vanishes there.
        place: what such a position is called.
    """

    determinants: Measure
    what: Callable[[np.ndarray, np.ndarray], Sequence[str]]
    place: str = PLACE


def undetermined_of(system: System, assembly: Assembly, p: np.ndarray) -> tuple[Undetermined, ...]:
    """Rates of dependent coordinates, declared speeds, angles that lock, rows that depend on one another."""

    def of(parts: Sequence[Any], place: str) -> list[Undetermined]:
        words = tuple(map(str, parts))
        determinants = tuple(part.determinant for part in parts)
        return [Undetermined(measure(system, determinants, p), lambda t, x: words, place)] if parts else []

    found = of(singular_blocks(system.elimination, system.scope), PLACE)
    found += of(system.declared, "declare other speeds")
    found += of(locks_of(system.motion), "gimbal lock: choose another `orientation`, or a quaternion")
    rows = independence_of(system, assembly, p)
    return (*found, *([] if rows is None else [Undetermined(rows, lambda t, x: [rows.words(t, x)])]))


def nearness_of(system: System, assembly: Assembly, p: np.ndarray) -> Nearness | None:
    """How near a motion is to positions in which the ties do not determine it; None without ties."""
    blocks = singular_blocks(system.elimination, system.scope)
    determinants = measure(system, tuple(block.determinant for block in blocks), p) if blocks else None
    rows = independence_of(system, assembly, p)
    what = tuple(map(str, blocks))
    return None if determinants is None and rows is None else Nearness(determinants, rows, what)


def independence_of(system: System, assembly: Assembly, p: np.ndarray) -> ConstraintRank | None:
    """How independent the rows are that close by multipliers; None without such."""
    rank = rank_of_ties(system.ties)
    if not rank:
        return None
    J = measure(system, tuple(x for row in assembly.J for x in row), p)
    return ConstraintRank(J, tuple(row.tie for row in system.ties.closing), rank)
