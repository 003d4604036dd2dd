"""System, [given] -> the linear equations of velocities or accelerations at one configuration, and their solution."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from random import Random

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.constraints.ties import holds_identically
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.values_at_rest import values_for, values_of_parameters
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.model.fields import WrittenEquation
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import collected_in, readable_all
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.dense import independent_rows
from eomgen.symbolic.numeric.evaluation import digits_at, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, ELIMINATED_AT_50, RANK
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve.linear_systems import LinearSystem, Pivots, general_solution

UNSAID = ""  # what nobody wrote, as the norm of a quaternion


@dataclass(frozen=True)
class GivenRow:
    """One equation: sum of entries * unknowns = right.

    Args:
        said: how a message calls it.
        entries: {velocity or acceleration or unknown: coefficient}, zeros left out.
    """

    said: str
    entries: dict[Node, Scalar]
    right: Scalar


# -- the equations -----------------------------------------------------------------------------------


def tie_lines(system: System, state: Mapping[Node, Scalar], *, accelerations: bool = False) -> list[GivenRow]:
    """J u = - sigma, or J a = - gamma, of every closing row at a state."""
    ties, symbols = system.ties, system.symbols
    rates, right = (symbols.a, ties.gamma) if accelerations else (symbols.u, ties.sigma)
    width = len(rates)
    placed = substituted((*(x for row in ties.J for x in row), *right), state)
    flat = readable_all(placed, Work.ANSWER, system.scope.positive)
    lines = []
    for k, row in enumerate(ties.closing):
        entries = zip(rates, flat[k * width : (k + 1) * width], strict=True)
        kept = {node: x for node, x in entries if not is_zero(x)}
        lines.append(GivenRow(f"the tie '{row.tie}'", kept, -flat[len(ties.closing) * width + k]))
    return [*_norm_lines(system, state, accelerations=accelerations), *lines]


def _norm_lines(system: System, state: Mapping[Node, Scalar], *, accelerations: bool) -> Iterator[GivenRow]:
    """e . e' = 0, or e . e'' = - e' . e', of every quaternion; nobody wrote them, so no message names them."""
    scope, rates = system.scope, system.symbols.a if accelerations else system.symbols.u
    for four in scope.quaternions:
        gap = sum((e * scope.names[e.name + "'"] for e in four), start=0)
        gap = scope.with_accelerations((gap,))[0] if accelerations else gap
        (placed,) = readable_all(substituted((gap,), state), Work.ANSWER, scope.positive)
        yield linear_line(UNSAID, placed, rates, "")


def speed_lines(system: System, speeds: Mapping[str, Expression], state: Mapping[Node, Scalar]) -> list[GivenRow]:
    """The start speeds of coordinates, and of declared speeds, as equations."""
    scope, u = system.scope, system.symbols.u
    gaps = substituted([scope.names[name] - scope.value(speed) for name, speed in speeds.items()], state)
    return [linear_line(f"the start speed {name}", gap, u, "speeds") for name, gap in zip(speeds, gaps, strict=True)]


def given_lines(
    system: System,
    state: Mapping[Node, Scalar],
    equations: Sequence[WrittenEquation],
    rates: Sequence[Node],
    order: str,
) -> list[GivenRow]:
    """Given equations at a state, linear in the rates and the unknowns.

    Args:
        order: "velocity" or "acceleration".
    Raises:
        DerivationError: one is not linear in them, or says nothing of them.
    """
    quantities, symbols = Quantities(system, state), system.symbols
    lines = []
    for number, equation in enumerate(equations):
        where = f"given.{order}.{number}"
        sides = (equation.left, equation.right)
        left, right = (side.evaluate(system.scope.names, quantities.value) for side in sides)
        _refuse_other_order(system, equation, left - right, order, where)
        (gap,) = substituted((left - right,), state)
        if order == "velocity" and depends_on(gap, symbols.a):
            raise DerivationError(f"'{equation.text}' holds an acceleration", where, "put it under `acceleration`")
        lines.append(linear_line(f"'{equation.text}'", gap, (*rates, *symbols.unknowns.values()), where))
    return lines


def _refuse_other_order(system: System, equation: WrittenEquation, gap: Scalar, order: str, where: str) -> None:
    """Refuse an equation that says nothing of its order: of places, or of velocities under `acceleration`.

    Raises:
        DerivationError: the equation is named.
    """
    symbols = system.symbols
    unknowns = tuple(symbols.unknowns.values())
    if depends_on(gap, (*symbols.a, *unknowns, *(symbols.u if order == "velocity" else ()))):
        return
    if depends_on(gap, (*symbols.u, *symbols.q)):
        mend = "put it under `velocity`" if depends_on(gap, symbols.u) else "places are where points and starts are"
        asked = "velocities" if order == "velocity" else "accelerations"
        raise DerivationError(f"'{equation.text}' says nothing of {asked}", where, mend)


def linear_line(text: str, gap: Scalar, unknowns: Sequence[Node], where: str) -> GivenRow:
    """gap = 0 as an equation of the unknowns.

    Raises:
        DerivationError: it is not linear in them.
    """
    try:
        parts = collected_in(gap, unknowns)
    except DerivationError:
        raise DerivationError(
            f"{text} is not linear in what it gives", where, "give components: vx(...), vy(...), omega(...)"
        ) from None
    entries = {node: x for node, x in parts.items() if node is not None}
    return GivenRow(text, entries, -parts.get(None, 0))


def open_gaps(system: System, places: Mapping[Node, Scalar]) -> None:
    """Refuse ties whose points do not meet at a configuration.

    Raises:
        DerivationError: the tie is named.
    """
    rows = [(row, row.gap) for row in system.ties.closing if row.gap is not None]
    gaps = substituted([gap for _, gap in rows], places)
    for (row, _), gap in zip(rows, gaps, strict=True):
        if not holds_identically(gap) and abs(value := _at_own_values(system, gap)) > COMPUTED:
            along = f" along {row.component}" if row.component in ("x", "y", "z") else ""
            raise DerivationError(
                f"'{row.tie}' does not close at the start: it is open by {value:.4g}{along}",
                f"constraints.{row.tie}",
                "put its points where they meet",
            )


def _at_own_values(system: System, x: Scalar) -> float:
    return float(evaluate((x,), values_of_parameters(system.scope, Random(1)), fifty_digits())[0])


# -- their solution ----------------------------------------------------------------------------------


def solution_of(
    system: System,
    ties: Sequence[GivenRow],
    given: Sequence[GivenRow],
    unknowns: Sequence[Node],
    near: Mapping[Node, float] | None = None,
) -> tuple[dict[Node, Scalar], tuple[int, int]]:
    """(each unknown that the equations determine, with the free ones in it; ranks of the ties and of all).

    Args:
        near: where symbols of the configuration are, in rounded numbers: what nearly vanishes there does.
    Raises:
        DerivationError: equations that contradict one another.
    """
    lines = [*ties, *given]
    scalars = [x for line in lines for x in (*line.entries.values(), line.right)]
    own, shaken = (values_for(system.scope, scalars, near, shaken=shaken) for shaken in (False, True))
    matrix = _matrix(lines, unknowns, own)
    _refuse_contradiction(lines, matrix, len(ties))
    rank = _rank(matrix)
    values = shaken if near is None and _rank(_matrix(lines, unknowns, shaken)) == rank else own
    index = {node: j for j, node in enumerate(unknowns)}
    rows = [{index[node]: x for node, x in line.entries.items()} for line in lines]
    found = general_solution(
        LinearSystem(rows, [line.right for line in lines], len(unknowns), digits_at(values)),
        Pivots(tolerance=ELIMINATED_AT_50 if near is None else RANK),
    )
    result = {}
    for j, constant in found.constants.items():
        shares = [share * unknowns[f] for f, share in found.shares[j].items()]
        result[unknowns[j]] = constant - sum(shares, start=0)
    return result, (_rank(matrix[: len(ties)]), rank)


def _matrix(lines: Sequence[GivenRow], unknowns: Sequence[Node], values: State) -> np.ndarray:
    """[A | b], rows of unit length in A."""
    index = {node: j for j, node in enumerate(unknowns)}
    matrix = np.zeros((len(lines), len(unknowns) + 1))
    for i, line in enumerate(lines):
        numbers = evaluate((*line.entries.values(), line.right), values, fifty_digits())
        for node, x in zip(line.entries, numbers, strict=False):
            matrix[i, index[node]] = float(x)
        matrix[i, -1] = float(numbers[-1])
        size = np.linalg.norm(matrix[i, :-1])
        matrix[i] /= size if size else 1.0
    return matrix


def _rank(matrix: np.ndarray) -> int:
    """Of A in [A | b]."""
    return len(independent_rows(matrix[:, :-1], RANK))


def _refuse_contradiction(lines: Sequence[GivenRow], matrix: np.ndarray, ties: int) -> None:
    """Refuse equations of which one contradicts others.

    Args:
        ties: how many of them are ties.
    Raises:
        DerivationError: all of them are named.
    """
    kept = independent_rows(matrix[:, :-1], RANK)
    basis = matrix[kept]
    for i, line in enumerate(lines):
        if i in kept:
            continue
        before = [k for k in range(len(kept)) if kept[k] < i]
        shares = np.linalg.lstsq(basis[before][:, :-1].T, matrix[i, :-1], rcond=None)[0] if before else np.zeros(0)
        rest = matrix[i, -1] - shares @ basis[before][:, -1]
        if abs(rest) > RANK * max(1.0, float(np.max(np.abs(matrix[:, -1])))):
            others = dict.fromkeys(
                lines[kept[k]].said
                for k, share in zip(before, shares, strict=True)
                if abs(share) > RANK and lines[kept[k]].said != UNSAID
            )
            against = f" contradicts {', '.join(others)}" if others else " cannot hold: nothing there can move so"
            if i < ties:
                raise DerivationError(
                    f"no motion has these velocities: {line.said}{against}",
                    "given",
                    "the bodies lock there, or their motion branches: give other velocities",
                )
            raise DerivationError(f"{line.said}{against}", "given", "leave one of them out, or change its value")
