"""First integrals, start -> every speed as a function of the coordinates, without time.

Momenta and closing rows are linear in the speeds and leave one of them, u_s; of it the energy is a quadratic function,

    A u_s^2 + B u_s + C = 0.

Where energy is lost, but a_s = F0(q_s) + F2(q_s) u_s^2, y = u_s^2 is the solution of dy/dq_s = 2 F0 + 2 F2 y.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from eomgen.errors import DerivationError, EomgenError
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.closure import generic_state
from eomgen.mechanics.integrals import energy_integral, momentum_integrals
from eomgen.mechanics.linear_motion import Constants, Line, particular
from eomgen.mechanics.positive import positive_parameters
from eomgen.mechanics.scope import primitive
from eomgen.mechanics.system import System
from eomgen.symbolic import linear
from eomgen.symbolic.derivative import depends_on, derivative, gradient, substituted
from eomgen.symbolic.evaluation import evaluate, fifty_digits, order
from eomgen.symbolic.functions import function, over
from eomgen.symbolic.graph import Node, Scalar, is_zero, linear_terms
from eomgen.symbolic.normal_form import simplest
from eomgen.symbolic.signs import sign_of_terms
from eomgen.symbolic.solving import vanishes
from eomgen.symbolic.symbols import Symbols

LONGEST = 20_000  # products of terms for making a speed readable
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
    constants = {symbols.u[j]: simplest(x, LONGEST, positive) for j, x in solution.constants.items()}
    if not solution.free:
        return Relations(None, dict.fromkeys(symbols.u, 0), constants)
    (free,) = solution.free
    speed = symbols.u[free]
    shares: dict[Node, Scalar] = {speed: 1}
    shares |= {symbols.u[j]: simplest(-x.get(free, 0), LONGEST, positive) for j, x in solution.shares.items()}
    return Relations(speed, {u: shares[u] for u in symbols.u}, {speed: 0, **constants})


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
    square = _square_by_path(assembly, relations, start, accelerations, sense, positive)
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
    if vanishes(B):
        return 0 if vanishes(C) else sense * function("sqrt", simplest(over(-C, A), LONGEST, positive))
    inside = simplest(B * B - 4 * A * C, LONGEST, positive)
    return simplest(over(sense * function("sqrt", inside) - B, 2 * A), LONGEST, positive)


def _square_by_path(
    assembly: Assembly,
    relations: Relations,
    start: Mapping[Node, Scalar],
    accelerations: Sequence[Scalar],
    sense: int,
    positive: frozenset[Node],
) -> Scalar | None:
    """y = u_s^2 as a function of q_s, from dy/dq_s = 2 F0 + 2 F2 y."""
    symbols, s = assembly.symbols, relations.speed
    assert s is not None
    q = next((q for q in symbols.q if q.name + "'" == s.name), None)
    (F,) = substituted((accelerations[symbols.u.index(s)],), relations.speeds)  # of all q: nothing is put in yet
    F = _in_sense(F, s, sense, positive)
    if q is None or depends_on(F, (symbols.t, *symbols.inputs.values())):
        return None
    F = simplest(F, LONGEST)
    F0, F2 = substituted((F, over(derivative(derivative(F, s), s), 2)), {s: 0})
    others = tuple(x for x in symbols.q if x is not q)
    if depends_on(F0, others) or depends_on(F2, others) or not vanishes(F - F0 - F2 * s * s):
        return None
    solution = _of_first_order(2 * simplest(F0, LONGEST, positive), 2 * simplest(F2, LONGEST, positive), q)
    if solution is None:
        return None
    growth, own = solution
    at, first = substituted((own, growth), {q: start[q]})
    return own + over(growth, first) * (start[s] * start[s] - at)


def _of_first_order(f: Scalar, k: Scalar, q: Node) -> tuple[Scalar, Scalar] | None:
    """(g, y): solutions of g' = k g and y' = k y + f; None where they have no closed form."""
    power = 0 if is_zero(k) else primitive(k, q)
    if power is None:
        return None
    growth = exponential_of(power)
    if not is_zero(k) and not depends_on(k, (q,)):
        constants = Constants(q, lambda x: None, lambda x: simplest(x, LONGEST))
        second = particular(Line(0, k, f), constants)  # of Y'' = k Y' + f, y = Y'
        return None if second is None else (growth, derivative(second, q))
    gained = primitive(over(f, growth), q)
    return None if gained is None else (growth, growth * gained)


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


def _in_sense(F: Scalar, s: Node, sense: int, positive: frozenset[Node]) -> Scalar:
    """F with sign(k u_s) replaced by what it is in this sense, for every k that has a sign of its own."""
    known: dict[Node, Scalar] = {}
    for node in order((F,)):
        if node.op != "sign":
            continue
        k = simplest(derivative(node.args[0], s), LONGEST, positive)
        sign = sign_of_terms(k, positive)
        if sign and vanishes(node.args[0] - k * s):
            known[node] = sense * sign
    return substituted((F,), known)[0] if known else F


def depends_on_any(scalars: Sequence[Scalar], symbols: Sequence[Node]) -> bool:
    """Whether one of the scalars depends on one of the symbols."""
    return any(depends_on(x, symbols) for x in scalars)
