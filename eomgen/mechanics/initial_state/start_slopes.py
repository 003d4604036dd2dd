"""System, what changes -> how all parameters and the start follow: dependent ones by the ties that they keep closed.

phi_q dq + phi_p dp = 0,    J du + d(J u + sigma) = 0 along (dq, dp)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.scope import Scope
from eomgen.mechanics.bodies.system_scene import start_values, with_unit_quaternions
from eomgen.mechanics.constraints.assembly import fixed_by_position
from eomgen.mechanics.constraints.consistency import is_guess
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import start_speeds
from eomgen.model.arithmetic import in_order
from eomgen.symbolic.expression.derivative import jacobian, tangent
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits, floats_of
from eomgen.symbolic.numeric.tolerances import CARRIED, RANK

Seeds = Mapping[Node, Scalar]
"""how symbols change: their derivatives, by what is changed"""


def parameter_seeds(scope: Scope, name: str) -> dict[Node, Scalar]:
    """How the parameters change with one of them: it, and those whose expressions hold it."""
    given = {other: part.value for other, part in scope.model.parameters.items() if part is not None}
    found: dict[Node, Scalar] = {scope.symbols.parameters[name]: 1}
    for other in in_order(given)[0]:
        value = given[other]
        if other != name and value is not None:
            (rate,) = tangent((scope.value(value),), found)
            found |= {scope.symbols.parameters[other]: rate} if rate != 0 else {}
    return found


def start_seeds(system: System, numbers: Mapping[Node, Any], seeds: Seeds, own: str = "") -> dict[Node, Fraction]:
    """How coordinates and speeds at the start change with the parameters, or with the start of one of them.

    Args:
        numbers: t, parameters, inputs, q and u at the start, with 50 digits.
        seeds: how the parameters and inputs change.
        own: the coordinate or speed whose start is changed; "" of none.
    Raises:
        DerivationError: the ties do not say how.
    """
    scope, symbols = system.scope, system.symbols

    def at(scalars: Sequence[Scalar], along: Seeds) -> list[float]:
        return floats_of(evaluate(tangent(tuple(scalars), along), numbers, fifty_digits()))

    begun = with_unit_quaternions(scope, start_values(scope))
    dq = dict(zip(symbols.q, map(Fraction, at([begun[q] for q in symbols.q], seeds)), strict=True))
    dq |= {q: Fraction(1) for q in symbols.q if q.name == own}
    rows = [row for row in system.ties.rows if row.gap is not None and not row.identical]
    gaps = [row.gap for row in rows if row.gap is not None]
    sought = fixed_by_position(system.ties)
    given = {q for q in symbols.q if scope.model.coordinates[q.name].driven}
    silent = [q for q in symbols.q if q in sought or (q.name != own and is_guess(scope.model, q.name))]
    silent = [q for q in silent if q not in given]
    what = own or "the parameter"
    dq = _kept(gaps, at(gaps, {**seeds, **dq}), silent, dq, numbers, what, _moved(begun, symbols.q, numbers))
    speeds = start_speeds(system)
    du = dict(zip(symbols.u, map(Fraction, at([speeds[u] for u in symbols.u], {**seeds, **dq})), strict=True))
    du |= {u: Fraction(1) for u in symbols.u if u.name == own}
    rates = [row.velocity for row in system.ties.closing]
    silent = [u for u in symbols.u if u.name != own and is_guess(scope.model, u.name)]
    left = at(rates, {**seeds, **dq, **du})
    du = _kept(rates, left, silent, du, numbers, what, _moved(speeds, symbols.u, numbers))
    return dq | du


def _kept(
    scalars: Sequence[Scalar],
    left: Sequence[float],
    silent: Sequence[Node],
    seeds: dict[Node, Fraction],
    numbers: Mapping[Node, Any],
    what: str,
    moved: Sequence[Node],
) -> dict[Node, Fraction]:
    """The changes with which scalars stay 0: those that nobody gives follow.

    Args:
        moved: what stands elsewhere than it was said to, so that the scalars are 0: it must be what follows.
    Raises:
        DerivationError: these do not do, or may do so in several ways.
    """
    if not moved and not np.any(np.abs(left) > CARRIED):
        return seeds
    flat = evaluate([x for row in jacobian(scalars, silent) for x in row], numbers, fifty_digits())
    A = np.array(floats_of(flat)).reshape(len(scalars), len(silent))
    step, _, rank, _ = np.linalg.lstsq(A, -np.array(left), rcond=RANK)
    several = rank < np.count_nonzero(np.any(A, axis=0)) or not {*moved} <= {*silent}
    if several or np.max(abs(A @ step + left)) > CARRIED * max(1.0, np.max(np.abs(left))):
        names = ", ".join(f"'{x.name}'" for x in silent or moved)
        raise DerivationError(
            f"the ties do not say how the start changes with {what}{f': of {names}' if names else ''}",
            mend="declare what follows from the ties as dependent",
        )
    return seeds | {x: seeds[x] + Fraction(d) for x, d in zip(silent, step.tolist(), strict=True)}


def _moved(said: Mapping[Node, Scalar], variables: Sequence[Node], numbers: Mapping[Node, Any]) -> list[Node]:
    """Which of them start elsewhere than the model says: where the ties hold."""
    found = floats_of(evaluate([said[x] for x in variables], numbers, fifty_digits()))
    own = [float(numbers[x]) for x in variables]
    return [x for x, a, b in zip(variables, found, own, strict=True) if abs(a - b) > CARRIED * max(1.0, abs(b))]
