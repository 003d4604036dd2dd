"""Equations of motion -> first integrals: what stays constant along every motion.

T + V = const,      p_k - integral of Q_k dt = const where dp_k/dt = Q_k(t),  p_k = dT/du_k
u . dT/du - T + V = const    (Jacobi's, where what moves by itself does so at a steady rate)

Each is decided in every piece of what is made of min, max, abs, sign, cases and samples; what stays in the piece of the
start alone, as the energy above an elastic floor, says so long as what it does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from random import Random

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.scope import integral_from_zero
from eomgen.mechanics.constraints.closure import of_50_digits, on_unit_spheres, scattered_state
from eomgen.mechanics.constraints.ties import hold_identically
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.pieces import EVERYWHERE, NOWHERE, Extent, division_of
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.wellposed import where_conservative
from eomgen.mechanics.first_integrals.constants_of_motion import jacobi
from eomgen.model.forces.load import Couple, GeneralizedForce, Load, PointForce
from eomgen.records import dataclass
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.exact.normal_form import readable
from eomgen.symbolic.expression.derivative import depends_on, gradient
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import holds_op
from eomgen.symbolic.expression.spatial import dot
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.pieces import PIECEWISE, Choices, as_chosen
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50
from eomgen.symbolic.numeric.work import Work


@dataclass(frozen=True)
class Integral:
    """A function of the motion that stays constant.

    Args:
        name: "energy", "jacobi" or "momentum(x)".
        expression: the function, of q, u, t and parameters.
        coordinate: whose momentum it is, "" of the energy.
        held: in which pieces.
    """

    name: str
    expression: Scalar
    coordinate: str = ""
    held: Extent = EVERYWHERE


def energy_integral(equations: EquationsOfMotion) -> tuple[Integral, ...]:
    """(T + V - W,) where it stays constant, W the work of constant forces that have no potential; else ().

    Where something moves by itself, Jacobi's integral if that stays. One that stays in every piece goes before one that
    stays in that of the start.
    """
    if not equations.M:
        return ()
    within: list[Integral] = []
    for V in (equations.V, equations.V - work_of_constant_forces(equations.system)):
        held = where_conservative(replace(equations, V=V))
        if held.everywhere:
            return (Integral("energy", equations.T + V),)
        if held:
            within.append(Integral("energy", equations.T + V, held=held))
    found = jacobi(equations)
    if found is not None:
        integral = Integral("jacobi", found[0], held=found[1])
        if integral.held.everywhere:
            return (integral,)
        within.append(integral)
    return tuple(within[:1])


def where_momenta_hold(equations: EquationsOfMotion) -> Extent:
    """Where all momenta that stay constant do: what follows from them holds there."""
    held = EVERYWHERE
    for each in momentum_integrals(equations):
        if not depends_on(each.expression, (equations.symbols.t,)):
            held = held & each.held
    return held


def work_of_constant_forces(system: System) -> Scalar:
    """W(q): F . r of constant forces on points, C times the angle of constant couples in the plane, Q_k q_k."""
    loads = system.loads
    work: Scalar = 0
    for force in loads.applied:
        for load in () if force.potential is not None else force.loads:
            work = work + _work(system, load)
    for effort in loads.efforts:
        if _is_constant(system, effort.drive):
            work = work + effort.drive * system.motion.link(effort.body).s[effort.variable]
    return work


def _work(system: System, load: Load) -> Scalar:
    """The work of one load where it is constant, else 0."""
    motion = system.motion
    if isinstance(load, PointForce) and load.axes is None and _is_constant(system, *load.force):
        return dot(load.force, motion.position(load.place))
    if isinstance(load, Couple) and _is_constant(system, *load.couple):
        angle = motion.link(load.body).angle
        return 0 if angle is None else load.couple[2] * angle
    if isinstance(load, GeneralizedForce) and _is_constant(system, load.value):
        return load.value * next(q for q in system.symbols.q if q.name == load.coordinate)
    return 0


def _is_constant(system: System, *scalars: Scalar) -> bool:
    symbols = system.symbols
    moving = (symbols.t, *symbols.q, *symbols.u, *symbols.inputs.values())
    return not any(depends_on(x, moving) for x in scalars)


def momentum_integrals(equations: EquationsOfMotion) -> tuple[Integral, ...]:
    """p_k - integral of dp_k/dt of every speed for which dp_k/dt is a function of time; a constant force is one."""
    symbols, scope = equations.symbols, equations.system.scope
    momenta = gradient(equations.T, symbols.u)
    drifts = scope.time_derivative(momenta)  # dp/dt = M a + drift, and M a = forcing + J^T lam
    others, found = (*symbols.q, *symbols.u, *symbols.inputs.values()), []
    free = [k for k in range(len(symbols.u)) if all(hold_identically([row[k] for row in equations.J]))]
    rates = [drifts[k] + equations.forcing[k] for k in free]
    for k, (rate, held) in zip(free, _of_time_alone(equations, rates, others), strict=True):
        u, p = symbols.u[k], momenta[k]
        if rate is None:
            continue
        try:
            gained = integral_from_zero(rate, symbols.t, "") if type(rate) is Node else rate * symbols.t
        except DerivationError:  # no closed form
            continue
        name = u.name.removesuffix("'")
        found.append(Integral(f"momentum({name})", p - gained, name, held))
    return tuple(found)


def _of_time_alone(
    equations: EquationsOfMotion, rates: Sequence[Scalar], others: Sequence[Node]
) -> list[tuple[Scalar | None, Extent]]:
    """Each rate where it depends on none of the others, else None; in which pieces."""
    whole = [None if holds_op(rate, *PIECEWISE) and depends_on(rate, others) else rate for rate in rates]
    smooth = iter(_alone_at_all(equations.system, [rate for rate in whole if rate is not None], others))
    return [
        _in_pieces(equations, rate, others) if same is None else (next(smooth), EVERYWHERE)
        for rate, same in zip(rates, whole, strict=True)
    ]


def _in_pieces(equations: EquationsOfMotion, rate: Scalar, others: Sequence[Node]) -> tuple[Scalar | None, Extent]:
    """A rate that has pieces as it is in that of the start, where it depends on none of the others there."""
    division = division_of(equations, (rate,))
    if division is None:
        return _alone_at_all(equations.system, (rate,), others)[0], EVERYWHERE
    if division.start is None:
        return None, NOWHERE

    def alone(piece: Choices) -> Scalar | None:
        return _alone_at_all(equations.system, as_chosen((rate,), division.nodes, piece), others)[0]

    try:
        begun = alone(division.start)
    except DerivationError:  # a division by zero
        return None, NOWHERE
    if begun is None:
        return None, NOWHERE

    def stays(piece: Choices) -> bool:
        other = alone(piece)
        return other is not None and equal_at_random_states([(other, begun)]).equal

    held = division.where(stays)
    return (begun, held) if held else (None, NOWHERE)


def _alone_at_all(system: System, rates: Sequence[Scalar], others: Sequence[Node]) -> list[Scalar | None]:
    """Each rate where it depends on none of the others, else None; what is seen to change needs no exact look."""
    changes = _seen_to_change(system, rates, others)
    left = [rate for rate, seen in zip(rates, changes, strict=True) if not seen]
    looked_at = iter(zip(left, hold_identically(left), strict=True))
    return [None if seen else _alone(*next(looked_at), others) for seen in changes]


def _alone(rate: Scalar, vanishes: bool, others: Sequence[Node]) -> Scalar | None:
    return rate if not depends_on(rate, others) else 0 if vanishes else _read_of_time(rate, others)


def _seen_to_change(system: System, rates: Sequence[Scalar], others: Sequence[Node]) -> list[bool]:
    """Of each rate whether it is another one, by 50 digits, where the others are and t is not."""
    state, rng = scattered_state(system.ties), Random(2)
    moved = state | {x: state[x] + of_50_digits(rng.uniform(0.1, 0.4)) for x in others}
    moved |= on_unit_spheres(system.scope.quaternions, moved)
    try:
        here, there = (evaluate(rates, each, fifty_digits()) for each in (state, moved))
    except NoValue:
        return [False] * len(rates)
    size = max((abs(x) for x in (*here, *there)), default=0)
    return [abs(x - y) > ZERO_AT_50 * max(1, size) for x, y in zip(here, there, strict=True)]


def _read_of_time(rate: Scalar, others: Sequence[Node]) -> Scalar | None:
    """The rate multiplied out, where it depends on none of the others then."""
    rate = readable(rate, Work.FORMULA)
    return None if depends_on(rate, others) else rate
