"""System, a state -> whether its ties hold there: more than rounding apart, they are refused by name."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

from eomgen.errors import DerivationError, OpenTies
from eomgen.mechanics.constraints.assembly import open_by
from eomgen.mechanics.constraints.closure import of_50_digits
from eomgen.mechanics.constraints.elimination import dependent_coordinates
from eomgen.mechanics.constraints.ties import Row
from eomgen.mechanics.equations.no_value import reason_without_value
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.nearest_miss import nearest_miss
from eomgen.model.forces.load import PointForce
from eomgen.model.own_units import in_own_unit
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import minus
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits


def refuse_open_gaps(system: System, state: State) -> None:
    """Raises OpenTies for the tie that is open by most, DerivationError where its gap has no value."""
    q = system.symbols.q
    gaps = [(row, row.gap) for row in system.ties.rows if row.gap is not None and not row.identical]
    found = _worst(gaps, q, state)
    if found is None:
        return
    row, gap, size = found
    if size == float("inf"):
        raise DerivationError(
            f"'{row.tie}' (row {row.number}) {_lacking(gap, state) or 'has no value at the start'}",
            f"constraints.{row.tie}",
            "give start values at which its roots and quotients have one",
        )
    size = _in_full(system, row, size, state)
    what = f"'{row.tie}' (row {row.number}) does not close at the start: it is open by {size:.3g}"
    raise OpenTies(what, f"constraints.{row.tie}", _mend(system, gap), partial(_nearest, system, state))


def _lacking(gap: Scalar, state: State) -> str:
    """Why a gap has no value: " is 0/0 at x = 0, where it starts"."""
    found = reason_without_value(gap, {node: float(x) for node, x in state.items()})
    return f"{found}, where it starts" if found else ""


def _nearest(system: System, state: State) -> str:
    """; how near the ties come to closing, and where."""
    miss = nearest_miss(system, state)
    if miss is None:
        return ""
    model = system.scope.model
    there = ", ".join(f"{name} = {in_own_unit(model, name, x, 6)}" for name, x in miss.values.items())
    if not miss.open:
        return f"; all ties close at {there}, farther than a start is moved"
    stay = f"{quoted_names(miss.ties)} {'stays' if len(miss.ties) == 1 else 'stay'} open"
    left = state | {q: of_50_digits(miss.values[q.name]) for q in system.symbols.q if q.name in miss.values}
    rows = [row for row in system.ties.rows if row.gap is not None and row.tie in miss.ties]
    gaps = evaluate([row.gap for row in rows if row.gap is not None], left, fifty_digits())
    size = max((_in_full(system, row, abs(float(x)), left) for row, x in zip(rows, gaps, strict=True)), default=0)
    return f"; wherever the coordinates go, {stay}: by {size:.3g} at {there}, the least that was found"


def _in_full(system: System, row: Row, size: float, state: State) -> float:
    """By how much a row is open: of a link, whose gap g = (L - r.r/L)/2 is a length to first order, |L - |r||.

    L = g + sqrt(g^2 + r.r)
    """
    tie = system.scope.model.constraints.get(row.tie)
    if row.gap is None or tie is None or not tie.by_squares:
        return size
    first, second = (system.motion.position(push.place) for push in row.pushes if isinstance(push, PointForce))
    (g, *r), digits = evaluate((row.gap, *minus(second, first)), state, fifty_digits()), fifty_digits()
    root = digits.functions["sqrt"]
    square = sum(x * x for x in r)
    return float(abs(g + root(g * g + square) - root(square)))


def _mend(system: System, gap: Scalar) -> str:
    """What closes a gap: another guess, a coordinate marked dependent, other start values."""
    dependent = dependent_coordinates(system.scope)
    standing = [q.name for q in system.symbols.q if depends_on(gap, (q,))]
    sought = [name for name in standing if name in dependent]
    if sought:
        return f"give start values at which it can close, or another guess: `near` of {quoted_names(sought)}"
    free = [name for name in standing if not system.scope.model.coordinates[name].driven]
    if not free:
        return "change the given motions"
    return f"give start values that close it, or mark a coordinate as `dependent`: {quoted_names(free)}"


def quoted_names(names: Sequence[str]) -> str:
    """Names in a sentence: 'pin', 'rod'."""
    return ", ".join(f"'{name}'" for name in names)


def refuse_open_rates(system: System, state: State) -> None:
    """Raises DerivationError for the closing tie whose velocity row is off by most."""
    u = system.symbols.u
    found = _worst(((row, row.velocity) for row in system.ties.closing), u, state)
    if found is None:
        return
    row, _, size = found
    speeds = [node.name for node in u if depends_on(row.velocity, (node,))]
    what = f"the speeds at the start break '{row.tie}' (row {row.number}): it opens at {size:.3g} a second"
    raise DerivationError(what, f"constraints.{row.tie}", f"give start speeds that keep it: {quoted_names(speeds)}")


def _worst(
    pairs: Iterable[tuple[Row, Scalar]], symbols: Sequence[Node], state: State
) -> tuple[Row, Scalar, float] | None:
    """(row, scalar, size) of the largest scalar that ought to be zero and is not; None where all are."""
    found = [(row, x, open_by(x, symbols, state)) for row, x in pairs]
    return max((each for each in found if each[2]), key=lambda each: each[2], default=None)
