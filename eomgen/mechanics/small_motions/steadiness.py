"""Reference -> whether it is one: a state at which the equations are smooth, and later look the same as now."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.friction import frictions
from eomgen.mechanics.constraints.elimination import refuse_undetermined
from eomgen.mechanics.equations.work import acting
from eomgen.mechanics.small_motions.field import NumberField, Numbers
from eomgen.mechanics.small_motions.first_order import Choice, FirstOrder
from eomgen.mechanics.small_motions.forms import carrying, floats, seen_beside_own
from eomgen.mechanics.small_motions.reduction import LinearEquations, Reducing, unsettled
from eomgen.mechanics.small_motions.reference import ReferenceMotion
from eomgen.mechanics.small_motions.spin_axes import over_turns, spinning, turned_on
from eomgen.symbolic.expression.derivative import depends_on_any
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric import dense
from eomgen.symbolic.numeric.evaluation import NoValue, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, REGULAR, SQUARED_SINE

TIMES = (0.3717281828, 1.1931415926)  # later states of a steady motion, at which it must look the same [of one unit]
CORNERS = frozenset(("abs", "sign", "min", "max", "select"))
SIDES = 4  # directions that are tried, with their opposites
PRIME = "'"
LATER = (13.4142135623, 1717.7724538509)  # the same, where t itself stands in the equations


def reduced_equations(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, field: NumberField
) -> LinearEquations:
    """The equations at a state of the reference, small turns in the place of quaternions that move in it."""
    return reduced_of(Reducing(first, choice, field), reference)


def reduced_of(reducing: Reducing, reference: ReferenceMotion) -> LinearEquations:
    """`reduced_equations`, of what is known of the state.

    Raises:
        DerivationError: dependent coordinates are not determined there.
    """
    system = reference.system
    refuse_undetermined(system.elimination, system.scope, reference.exact, "at the place of reference")
    turns = spinning(reference, reducing.choice)
    return over_turns(reducing.field, reducing.first.system, reducing.equations, turns)


def refuse_corners(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, raw: LinearEquations, kept: Sequence[int]
) -> None:
    """Forces that are not smooth at the reference, as k |x| at x = 0: close to it, on both sides, all must be the same.

    Raises:
        DerivationError: they are not.
    """
    if not _cornered(first.residual):
        return
    symbols, rng = first.system.symbols, Random(7)
    changes = _changed(first, choice, reference, raw, kept)
    for _ in range(SIDES):
        aside = {x: fifty_digits().number(1) * SQUARED_SINE * rng.uniform(-1, 1) for x in (*symbols.q, *symbols.u)}
        if changes(aside) or changes({x: -d for x, d in aside.items()}):
            rough = [f"the friction of '{name}'" for name, factor, _ in frictions(first.system) if _cornered((factor,))]
            named = [*filter(None, [acting(first.system.loads, _cornered)]), *dict.fromkeys(rough)]
            raise DerivationError(
                f"{' and '.join(named) or 'the forces'}: a corner or a jump at the place of reference",
                "linearize",
                "take a place beside it, or forces that are smooth there",
            )


def _cornered(row: ScalarRow) -> bool:
    return any(node.op in CORNERS for node in order(row))


def steady_coordinates(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, raw: LinearEquations, wanted: Sequence[str]
) -> tuple[int, ...]:
    """The coordinates over which the equations stay as they are with time: those that carry the motion.

    Where the reference moves, a coordinate on which nothing depends may have a rate that changes, as the place of a car
    that turns in a circle: it is then left out.

    Raises:
        DerivationError: the coordinate that moves, and on which the others depend, is named.
    """
    coordinates = reference.system.scope.model.coordinates
    kept = carrying(raw, wanted, [name for name, part in coordinates.items() if part.dependent])
    if not (shifts := _unsteady(first, choice, reference, raw, kept)):
        return kept
    fewer = seen_beside_own(raw, kept)
    if len(fewer) < len(kept) and not _unsteady(first, choice, reference, raw, fewer):
        return fewer
    changes = _changed(first, choice, reference, raw, kept)
    t = first.system.symbols.t
    culprit = next((x for x in shifts[0] if changes({x: shifts[0][x]})), t)
    if culprit is t:
        named = acting(first.system.loads, lambda row: depends_on_any(row, (t,)))
        driven = [f"'{name}'" for name, part in coordinates.items() if part.driven]
        by = " and ".join((*driven, *([named] if named else ())))
        raise DerivationError(
            f"coefficients of the small motions change with time{f', by {by}' if by else ''}: there are no modes",
            "linearize",
            "let nothing but inputs depend on t",
        )
    what = f"no steady motion: '{culprit.name}' moves, and the equations depend on it"
    raise DerivationError(what, f"coordinates.{culprit.name}", "only coordinates on which nothing depends may move")


def _unsteady(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, raw: LinearEquations, kept: Sequence[int]
) -> list[dict[Node, Any]]:
    """How coordinates and t move on to later states, where the equations are others at one of these; else none."""
    moving, t, graph = reference.moving, first.system.symbols.t, first.equations
    unit = 1 / max((abs(rate) for rate in moving.values()), default=1)
    timed = depends_on_any((*graph.forcing, *graph.gamma, *graph.sigma), (t,))
    times = (*TIMES, *LATER) if timed else TIMES
    shifts = [{x: rate * unit * time for x, rate in {**moving, t: 1}.items()} for time in times]
    turns = spinning(reference, choice)
    for shift in shifts:
        shift |= {e: x - reference.numbers[e] for e, x in turned_on(turns, reference.numbers, shift[t]).items()}
    return shifts if any(map(_changed(first, choice, reference, raw, kept), shifts)) else []


def refuse_singular(reducing: Reducing, equations: LinearEquations) -> None:
    """Coordinates that do not describe motions there, as angles at a pole.

    Raises:
        DerivationError: the speed that moves nothing is named, where it is one.
    """
    M, Z = floats(equations.M), abs(floats(reducing.Z))
    least = np.maximum(REGULAR * np.diagonal(Z.T @ abs(floats(reducing.M)) @ Z), SQUARED_SINE * abs(M).max())
    idle = [u.name for u, x, size in zip(equations.speeds, np.diagonal(M), least, strict=True) if abs(x) <= size]
    if idle or dense.scaled_condition(M) > 1 / REGULAR:
        moved = f"'{idle[0].rstrip(PRIME)}' moves nothing there" if idle else "two coordinates move the same there"
        raise DerivationError(
            f"the mass matrix is singular at the place: {moved}",
            "linearize",
            "describe the motion by coordinates that are regular there",
        )


def _changed(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, raw: LinearEquations, kept: Sequence[int]
) -> Callable[[Mapping[Node, Any]], bool]:
    """Whether the equations are others at a shifted state; they are those here where they hold nothing that shifts.

    At rest a force that t alone changes is no other equation: it stands on the right side, as an input does.
    """
    t = first.system.symbols.t
    here, held = list(_compared(raw, kept)), first.held

    @cache
    def found(shift: tuple[tuple[Node, Any], ...]) -> bool:
        reducing = Reducing(first, choice, Numbers({**reference.numbers, **dict(shift)}))
        try:
            if (not reference.at_rest or any(x is not t for x, _ in shift)) and unsettled(reducing, COMPUTED):
                return True
            there = list(_compared(reduced_of(reducing, reference), kept)) if shift else here
        except (NoValue, ZeroDivisionError):
            return True
        pairs = zip(here, there, strict=True)
        return any(np.any(abs(A - B) > COMPUTED * (abs(A).max(initial=0) + 1e-3)) for A, B in pairs)

    return lambda shift: found(tuple((x, reference.numbers[x] + d) for x, d in shift.items() if x in held))


def _compared(equations: LinearEquations, kept: Sequence[int]) -> Iterator[np.ndarray]:
    yield floats(equations.M)
    yield floats(equations.C)
    yield floats(equations.K)[:, list(kept)]
    yield floats(equations.F)[np.ix_(kept, kept)]
    yield floats(equations.E)[list(kept)]
