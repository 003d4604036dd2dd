"""System, Assembly -> first integrals: what stays constant along every motion, and the speeds that follow from it.

    T + V = const,      p_k - integral of Q_k dt = const where dp_k/dt = Q_k(t),  p_k = dT/du_k
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from eomgen.errors import EomgenError
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.closure import generic_state
from eomgen.mechanics.positive import positive_parameters
from eomgen.mechanics.scope import integral_from_zero, primitive
from eomgen.mechanics.system import System
from eomgen.mechanics.ties import holds_identically
from eomgen.mechanics.wellposed import is_conservative
from eomgen.model.forces.load import Couple, GeneralizedForce, PointForce
from eomgen.symbolic import linear
from eomgen.symbolic.derivative import depends_on, derivative, gradient, substituted
from eomgen.symbolic.evaluation import evaluate, fifty_digits, order
from eomgen.symbolic.functions import function, over
from eomgen.symbolic.graph import Node, Scalar, linear_terms
from eomgen.symbolic.normal_form import readable, simplest
from eomgen.symbolic.spatial import dot
from eomgen.symbolic.symbols import Symbols

WORK = 5_000  # products of terms for finding that a rate of momentum is a function of time
LONGEST = 20_000  # products of terms for making a speed readable
MOST_SPEEDS = 12  # of a system whose speeds are sought from its integrals


@dataclass(frozen=True)
class Integral:
    """A function of the motion that stays constant.

    Args:
        name: "energy" or "momentum(x)".
        expression: the function, of q, u, t and parameters.
        coordinate: whose momentum it is, "" of the energy.
    """

    name: str
    expression: Scalar
    coordinate: str = ""


def first_integrals(system: System, assembly: Assembly) -> tuple[Integral, ...]:
    """The energy where it stays, and the momenta on which only known functions of time act."""
    return (*energy_integral(system, assembly), *momentum_integrals(system, assembly))


def energy_integral(system: System, assembly: Assembly) -> tuple[Integral, ...]:
    """(T + V - W,) where it stays constant, W the work of constant forces that have no potential; else ()."""
    if not assembly.M:
        return ()
    for V in (assembly.V, assembly.V - work_of_constant_forces(system)):
        if is_conservative(system, replace(assembly, V=V)):
            return (Integral("energy", assembly.T + V),)
    return ()


def work_of_constant_forces(system: System) -> Scalar:
    """W(q): F . r of constant forces on points, C times the angle of constant couples in the plane, Q_k q_k."""
    loads, motion, symbols = system.loads, system.motion, system.symbols
    work: Scalar = 0
    for force in loads.applied:
        for load in () if force.potential is not None else force.loads:
            if isinstance(load, PointForce) and load.axes is None:
                work = work + dot(load.force, motion.position(load.place))
            elif isinstance(load, Couple) and load.body is not None:
                work = work + load.couple[2] * (motion.link(load.body).angle or 0)
            elif isinstance(load, GeneralizedForce):
                work = work + load.value * next(q for q in symbols.q if q.name == load.coordinate)
    for effort in loads.efforts:
        work = work + effort.drive * motion.link(effort.body).s[effort.variable]
    return work


def momentum_integrals(system: System, assembly: Assembly) -> tuple[Integral, ...]:
    """p_k - integral of dp_k/dt of every speed for which dp_k/dt is a function of time; a constant force is one."""
    symbols, scope = assembly.symbols, system.scope
    momenta = gradient(assembly.T, symbols.u)
    drifts = scope.time_derivative(momenta)  # dp/dt = M a + drift, and M a = forcing + J^T lam
    found = []
    for k, (u, p) in enumerate(zip(symbols.u, momenta, strict=True)):
        if not all(holds_identically(row[k]) for row in assembly.J):
            continue
        rate = _of_time_alone(drifts[k] + assembly.forcing[k], (*symbols.q, *symbols.u, *symbols.inputs.values()))
        if rate is None:
            continue
        try:
            gained = integral_from_zero(rate, symbols.t, "") if type(rate) is Node else rate * symbols.t
        except EomgenError:  # no closed form
            continue
        name = u.name.removesuffix("'")
        found.append(Integral(f"momentum({name})", p - gained, name))
    return tuple(found)


def _of_time_alone(rate: Scalar, others: Sequence[Node]) -> Scalar | None:
    """The rate where it depends on none of the others, else None."""
    if not depends_on(rate, others):
        return rate
    if holds_identically(rate):
        return 0
    rate = readable(rate, WORK)
    return None if depends_on(rate, others) else rate


# -- speeds ------------------------------------------------------------------------------------------


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
    system: System, assembly: Assembly, start: Mapping[Node, Scalar], at: Mapping[Node, Scalar] | None = None
) -> Relations | None:
    """What momenta and closing rows, all linear in the speeds, say of them; None where more than one stays free.

    Args:
        start: q and u at the start, scalars of the parameters.
        at: coordinates whose values are put in before anything is solved.
    """
    symbols = assembly.symbols
    if not 0 < len(symbols.u) <= MOST_SPEEDS or depends_on_any((*assembly.sigma, *assembly.nu), (symbols.t,)):
        return None
    rows: list[dict[int, Scalar]] = [dict(enumerate(row)) for row in assembly.J]
    right: list[Scalar] = [-sigma for sigma in assembly.sigma]
    for integral in momentum_integrals(system, assembly):
        if depends_on(integral.expression, (symbols.t,)):
            continue
        (rest,) = substituted((integral.expression,), dict.fromkeys(symbols.u, 0))
        rows.append(dict(enumerate(gradient(integral.expression, symbols.u))))
        right.append(_at_start(integral.expression, start, symbols) - rest)
    if at:
        rows = [dict(zip(row, substituted(tuple(row.values()), at), strict=True)) for row in rows]
        right = list(substituted(tuple(right), at))
    solution = _solved(system, rows, right, len(symbols.u))
    if solution is None or len(solution.free) > 1:
        return None
    positive = positive_parameters(system.scope)
    free = solution.free[0] if solution.free else None
    shares: dict[Node, Scalar] = {}
    constants: dict[Node, Scalar] = {}
    for j, u in enumerate(symbols.u):
        share = int(j == free) if j == free else -solution.shares[j].get(free, 0)
        shares[u] = simplest(share, LONGEST, positive)
        constants[u] = 0 if j == free else simplest(solution.constants[j], LONGEST, positive)
    return Relations(None if free is None else symbols.u[free], shares, constants)


def _solved(
    system: System, rows: Sequence[Mapping[int, Scalar]], right: Sequence[Scalar], unknowns: int
) -> linear.Solution | None:
    """The speeds by the rows, with pivots that do not vanish at a generic state of the motion."""
    try:
        state = generic_state(system.ties)
    except EomgenError:
        return None
    return linear.solved(rows, right, unknowns, lambda entries: evaluate(entries, state, fifty_digits()))


def rates_of(
    system: System,
    assembly: Assembly,
    start: Mapping[Node, Scalar],
    sense: int = 1,
    *,
    accelerations: Sequence[Scalar] | None = None,
    at: Mapping[Node, Scalar] | None = None,
) -> dict[Node, Scalar] | None:
    """Every speed as a function of the coordinates, by the integrals; None where they do not give it.

    Momenta and closing rows leave one speed u_s, and of it the energy is a quadratic function:
    A u_s^2 + B u_s + C = 0. Where energy is lost, but a_s = F0(q_s) + F2(q_s) u_s^2, y = u_s^2 is the solution of
    dy/dq_s = 2 F0 + 2 F2 y.

    Args:
        start: q and u at the start, scalars of the parameters.
        sense: the sign of u_s, +1 or -1.
        accelerations: a as expressions, for the second way.
        at: coordinates whose values are put in before anything is solved.
    """
    relations = relations_of(system, assembly, start, at)
    if relations is None:
        return None
    if relations.speed is None:
        return relations.speeds
    speed = speed_of(system, assembly, relations, start, sense, accelerations, at or {})
    if speed is None:
        return None
    u = tuple(relations.shares)
    return dict(zip(u, substituted(tuple(relations.speeds[x] for x in u), {relations.speed: speed}), strict=True))


def speed_of(
    system: System,
    assembly: Assembly,
    relations: Relations,
    start: Mapping[Node, Scalar],
    sense: int,
    accelerations: Sequence[Scalar] | None,
    at: Mapping[Node, Scalar],
) -> Scalar | None:
    """The one free speed as a function of the coordinates that are not in `at`, with the sign `sense`."""
    positive = positive_parameters(system.scope)
    for energy in energy_integral(system, assembly):
        difference = energy.expression - _at_start(energy.expression, start, system.symbols)
        (difference,) = substituted(substituted((difference,), relations.speeds), at)
        return _root_of_energy(difference, relations, sense, positive)
    if accelerations is None:
        return None
    square = _square_by_path(assembly, relations, start, accelerations, sense)
    if square is None:
        return None
    return sense * function("sqrt", simplest(substituted((square,), at)[0], LONGEST, positive))


def _at_start(integral: Scalar, start: Mapping[Node, Scalar], symbols: Symbols) -> Scalar:
    """An integral's value at the start; where the speeds are 0 coefficients need not exist, as at a branch point.

    Raises:
        DerivationError: it holds a coordinate or speed that has no exact value there.
    """
    (integral,) = substituted((integral,), {u: start[u] for u in symbols.u if u in start})
    (value,) = substituted((integral,), start)
    left = [x.name for x in (*symbols.q, *symbols.u) if depends_on(value, (x,))]
    if left:
        raise DerivationError(f"the start has no closed form: {', '.join(left)}")
    return value


def _root_of_energy(energy: Scalar, relations: Relations, sense: int, positive: frozenset[Node]) -> Scalar:
    """u_s of A u_s^2 + B u_s + C = 0, A > 0."""
    s = relations.speed
    assert s is not None
    slope = derivative(energy, s)
    C, B = substituted((energy, slope), {s: 0})
    A = over(derivative(slope, s), 2)
    if holds_identically(B):
        return 0 if holds_identically(C) else sense * function("sqrt", simplest(over(-C, A), LONGEST, positive))
    inside = simplest(B * B - 4 * A * C, LONGEST, positive)
    return simplest(over(sense * function("sqrt", inside) - B, 2 * A), LONGEST, positive)


def _square_by_path(
    assembly: Assembly,
    relations: Relations,
    start: Mapping[Node, Scalar],
    accelerations: Sequence[Scalar],
    sense: int,
) -> Scalar | None:
    """y = u_s^2 as a function of q_s, from dy/dq_s = 2 F0 + 2 F2 y."""
    symbols, s = assembly.symbols, relations.speed
    assert s is not None
    q = next((q for q in symbols.q if q.name + "'" == s.name), None)
    (F,) = substituted((accelerations[symbols.u.index(s)],), relations.speeds)  # of all q: nothing is put in yet
    F = _in_sense(F, s, sense)
    if q is None or depends_on(F, (symbols.t, *symbols.inputs.values())):
        return None
    F = simplest(F, LONGEST)
    F0, F1, F2 = substituted((F, derivative(F, s), over(derivative(derivative(F, s), s), 2)), {s: 0})
    others = tuple(x for x in symbols.q if x is not q)
    if depends_on(F0, others) or depends_on(F2, others) or not holds_identically(F - F0 - F2 * s * s):
        return None
    power = primitive(2 * F2, q) if type(F2) is Node or F2 else 0
    if power is None:
        return None
    growth = exponential_of(power)
    gained = primitive(over(2 * F0, growth), q)
    if gained is None:
        return None
    first = substituted((over(start[s] * start[s], growth) - gained,), {q: start[q]})[0]
    return growth * (gained + first)


def exponential_of(x: Scalar) -> Scalar:
    """exp(x), with f^c for each term c log(f) of x."""
    product: Scalar = 1
    rest: Scalar = 0
    for atom, c in linear_terms(x).items():
        if atom is not None and atom.op == "log":
            product = product * atom.graph.pow(atom.args[0], c)
        else:
            rest = rest + c * (1 if atom is None else atom)
    return product * function("exp", rest)


def _in_sense(F: Scalar, s: Node, sense: int) -> Scalar:
    """F with sign(u_s) replaced by the sense."""
    known: dict[Node, Scalar] = {node: sense for node in order((F,)) if node.op == "sign" and node.args[0] is s}
    return substituted((F,), known)[0] if known else F


def depends_on_any(scalars: Sequence[Scalar], symbols: Sequence[Node]) -> bool:
    """Whether one of the scalars depends on one of the symbols."""
    return any(depends_on(x, symbols) for x in scalars)
