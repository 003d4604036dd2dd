"""Equations of motion, rates -> the same with closing rows that pull back what has opened, after Baumgarte.

    J a + gamma + 2 alpha (J u + sigma) + beta^2 phi = 0

so that phi'' + 2 alpha phi' + beta^2 phi = 0: a gap decays as a damped oscillation does, critically for alpha = beta.
Of a row that is given as a velocity alone the speed decays, with the rate 2 alpha.
Source: Baumgarte, Stabilization of constraints and integrals of motion in dynamical systems, Computer Methods in
Applied Mechanics and Engineering 1 (1972).
"""

from __future__ import annotations

from dataclasses import replace

from eomgen.errors import UsageError
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.symbolic.expression.rational import Fraction, fraction_of

PullBack = tuple[float, float]


def stabilized(equations: EquationsOfMotion, rates: PullBack) -> EquationsOfMotion:
    """The equations of motion with rows that pull.

    Args:
        rates: alpha, beta [1/s].
    Raises:
        UsageError: a rate that is no positive number; a tie that has no multiplier to pull by.
    """
    alpha, beta = (_exact(rate) for rate in rates)
    taken = dict.fromkeys(row.tie for row in equations.system.ties.rows if row.status == "eliminated")
    if taken:
        names = ", ".join(f"'{name}'" for name in taken)
        raise UsageError(
            f"Baumgarte's rows pull by multipliers, and {names} has none: it gives dependent coordinates",
            mend="take the projection, or declare no coordinate dependent",
        )
    rows = zip(equations.gamma, equations.system.ties.closing, equations.phi, strict=True)
    pulling = (g + 2 * alpha * row.velocity + (0 if phi is None else beta * beta * phi) for g, row, phi in rows)
    return replace(equations, gamma=tuple(pulling))


def _exact(rate: float) -> Fraction:
    """A decimal as it was written."""
    if not 0 < rate < float("inf"):
        raise UsageError(f"Baumgarte's rates must be positive, not {rate:g}", mend="give alpha and beta in 1/s")
    return fraction_of(repr(float(rate)))
