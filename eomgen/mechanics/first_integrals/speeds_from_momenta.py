"""Momenta, closing rows -> every speed by one of them, without time: both are linear in the speeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress

from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.constraints.closure import generic_state
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.first_integrals.integrals import momentum_integrals
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import depends_on, gradient, substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.symbols import Symbols
from eomgen.symbolic.numeric.evaluation import digits_at
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve.linear_systems import LinearSystem, Solution, general_solution

MOST_SPEEDS = 12  # of a system whose speeds are sought from its integrals


@dataclass(frozen=True)
class Relations:
    """Every speed by one of them:  u_j = share_j u_s + constant_j.

    Args:
        speed: u_s; None where all speeds are known without it.
        shares, constants: of every speed, functions of q.
    """

    speed: Node | None
    shares: Mapping[Node, Scalar]
    constants: Mapping[Node, Scalar]

    @property
    def speeds(self) -> dict[Node, Scalar]:
        """Every speed as a function of q and u_s."""
        s = 0 if self.speed is None else self.speed
        return {u: self.constants[u] + self.shares[u] * s for u in self.shares}


def relations_of(
    equations: EquationsOfMotion, start: Mapping[Node, Scalar], at: Mapping[Node, Scalar] | None = None
) -> Relations | None:
    """What momenta and closing rows, all linear in the speeds, say of them; None where more than one stays free.

    Args:
        start: q and u at the start, scalars of the parameters.
        at: coordinates whose values are put in before anything is solved.
    """
    symbols = equations.symbols
    by_itself = (*equations.sigma, *equations.nu)
    if not 0 < len(symbols.u) <= MOST_SPEEDS or any(depends_on(x, (symbols.t,)) for x in by_itself):
        return None
    rows: list[dict[int, Scalar]] = [dict(enumerate(row)) for row in equations.J]
    right: list[Scalar] = [-sigma for sigma in equations.sigma]
    for integral in momentum_integrals(equations):
        if depends_on(integral.expression, (symbols.t,)):
            continue
        (rest,) = substituted((integral.expression,), dict.fromkeys(symbols.u, 0))
        rows.append(dict(enumerate(gradient(integral.expression, symbols.u))))
        right.append(value_at_start(integral.expression, start, symbols) - rest)
    if at:
        rows = [dict(zip(row, substituted(tuple(row.values()), at), strict=True)) for row in rows]
        right = list(substituted(tuple(right), at))
    solution = _solved(equations.system, rows, right, len(symbols.u))
    if solution is None or len(solution.free) > 1:
        return None
    positive = equations.system.scope.positive
    constants = {symbols.u[j]: simplest(x, Work.VALUE, positive) for j, x in solution.constants.items()}
    if not solution.free:
        return Relations(None, dict.fromkeys(symbols.u, 0), constants)
    (free,) = solution.free
    speed = symbols.u[free]
    shares: dict[Node, Scalar] = {speed: 1}
    shares |= {symbols.u[j]: simplest(-x.get(free, 0), Work.VALUE, positive) for j, x in solution.shares.items()}
    return Relations(speed, {u: shares[u] for u in symbols.u}, {speed: 0, **constants})


def _solved(
    system: System, rows: Sequence[Mapping[int, Scalar]], right: Sequence[Scalar], unknowns: int
) -> Solution | None:
    """The speeds by the rows, with pivots that do not vanish at a generic state of the motion.

    Parameters are off any special value, m1 - m2 is 0 at m1 = m2 alone, unless the rows determine less for these.
    """
    try:
        own = general_solution(LinearSystem(rows, right, unknowns, digits_at(generic_state(system.ties))))
    except (DerivationError, MissingValues):
        return None
    with suppress(DerivationError, MissingValues):
        shaken = generic_state(system.ties, shaken=True)
        found = general_solution(LinearSystem(rows, right, unknowns, digits_at(shaken)))
        return found if len(found.free) == len(own.free) else own
    return own


def value_at_start(integral: Scalar, start: Mapping[Node, Scalar], symbols: Symbols) -> Scalar:
    """An integral's value at the start; where the speeds are 0 coefficients need not exist, as at a branch point.

    Raises:
        DerivationError: it holds a coordinate or speed that has no exact value there.
    """
    (integral,) = substituted((integral,), {u: start[u] for u in symbols.u if u in start})
    (value,) = substituted((integral,), start)
    left = [x.name for x in (*symbols.q, *symbols.u) if depends_on(value, (x,))]
    if left:
        raise DerivationError(
            f"the start has no closed form: {', '.join(left)}", mend="give them as numbers in [coordinates]"
        )
    return value
