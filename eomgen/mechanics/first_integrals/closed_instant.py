"""System, condition, its place in numbers -> the state at an instant in closed form.

By the laws of motion: the condition is an equation in t. By the integrals: speeds are functions of the coordinates, and
the condition with the ties is a set of equations between coordinates. What is found is taken only where it agrees with
the numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.places import Located, places_of
from eomgen.mechanics.bodies.scope import primitive
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.first_integrals.laws import laws_of_motion
from eomgen.mechanics.first_integrals.speeds import rates_of
from eomgen.mechanics.first_integrals.speeds_from_momenta import Relations, relations_of
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import depends_on, gradient, substituted, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.work import Work


@dataclass(frozen=True)
class ClosedInstant:
    """What is asked: the state at which the condition holds.

    Args:
        equations, accelerations: the equations of motion.
        condition: of q, u, t and parameters; it vanishes.
        start: t, q and u at the start, scalars of the parameters.
        located: the state asked, in numbers.
    """

    equations: EquationsOfMotion
    accelerations: Sequence[Scalar]
    condition: Scalar
    start: Mapping[Node, Scalar]
    located: Located

    def by_laws(self) -> State:
        """t, and q(t), u(t) of every coordinate that has a law; {} where the condition has no root in closed form."""
        named, constants = self._with_constants_named()
        state = named._at_root(laws_of_motion(self.equations.system, named.accelerations, named.start))
        return dict(zip(state, substituted(tuple(state.values()), constants), strict=True))

    def _at_root(self, laws: State) -> State:
        """The laws at the time at which the condition holds."""
        t = self.equations.symbols.t
        (equation,) = substituted((self.condition,), laws)
        if depends_on(equation, self._moving):
            return {}
        instant = self.located.root(simplest(equation, Work.ANSWER, self.located.positive), t)
        if instant is None:
            return {}
        state = dict(zip(laws, substituted(tuple(laws.values()), {t: instant}), strict=True))
        return self._agreeing({t: instant, **state})

    def _with_constants_named(self) -> tuple[ClosedInstant, State]:
        """(the same with a symbol for each sum of constants, what the symbols stand for): such sums stay together."""
        scalars = (*self.accelerations, self.condition, *self.start.values())
        sums = constant_sums(scalars, (*self._moving, self.equations.symbols.t))
        names = {node: node.graph.symbol(f"(constant {node.index})") for node in sums}
        written = substituted(scalars, names)
        n = len(self.accelerations)
        values = {symbol: self.located.value(node) for node, symbol in names.items()}
        positive = self.located.positive | {symbol for symbol, value in values.items() if value > 0}
        located = Located({**self.located.numbers, **values}, frozenset(positive))
        start = dict(zip(self.start, written[n + 1 :], strict=True))
        named = ClosedInstant(self.equations, written[:n], written[n], start, located)
        return named, {symbol: node for node, symbol in names.items()}

    def by_integrals(self) -> State:
        """Coordinates by the condition and the ties, speeds by the integrals; those that have a closed form."""
        speeds = self._rates({})
        equations = list(substituted((self.condition,), speeds))
        equations += position_equations(self.equations.system, self.start, self._relations({}))
        others = (*self.equations.symbols.u, self.equations.symbols.t)
        equations = [x for x in equations if not depends_on(x, others)]
        places = self._agreeing(places_of(equations, self.equations.symbols.q, self.located))
        rates = self._agreeing(self._there(speeds, places))
        if len(rates) < len(self.equations.symbols.u):  # the place may be one where the functions have no value
            rates |= self._agreeing(self._rates(places))
        return {**places, **rates}

    def _there(self, speeds: State, places: State) -> State:
        """The speeds as functions of the coordinates, at the places that are known."""
        try:
            return dict(zip(speeds, substituted(tuple(speeds.values()), places), strict=True))
        except DerivationError:  # a division by 0 at this place
            return {}

    def _rates(self, at: State) -> State:
        """The speeds as functions of the coordinates that are not in `at`."""
        try:
            found = rates_of(
                self.equations,
                self.start,
                there=self.located.numbers,
                accelerations=self.accelerations,
                at=at,
            )
            return dict(zip(found, substituted(tuple(found.values()), at), strict=True)) if found else {}
        except DerivationError:  # a division by 0 at this place
            return {}

    def _relations(self, at: State) -> Relations | None:
        try:
            return relations_of(self.equations, self.start, at)
        except DerivationError:  # a division by 0 at this place, a start without closed form
            return None

    def _agreeing(self, state: State) -> State:
        """Those values that hold parameters only and are the located numbers."""
        found = {}
        for node, x in state.items():
            if not depends_on(x, (*self._moving, self.equations.symbols.t)):
                try:
                    x = simplest(x, Work.ANSWER, self.located.positive)
                except DerivationError:  # a division by 0 at this place
                    continue
                if self.located.agrees(x, node):
                    found[node] = x
        return found

    @property
    def _moving(self) -> tuple[Node, ...]:
        return (*self.equations.symbols.q, *self.equations.symbols.u)


def constant_sums(scalars: Sequence[Scalar], moving: Sequence[Node]) -> list[Node]:
    """The largest sums in the scalars that hold none of the moving symbols, and some symbol."""
    found: list[Node] = []
    seen: set[Node] = set()
    stack: list[Scalar] = list(scalars)
    while stack:
        x = stack.pop()
        if type(x) is not Node or x in seen or x.op == "symbol":
            continue
        seen.add(x)
        if x.op in ("add", "sub") and not depends_on(x, moving) and symbols_of((x,)):
            found.append(x)
        else:
            stack += x.args
    return found


def position_equations(
    system: System, start: Mapping[Node, Scalar], relations: Relations | None = None
) -> list[Scalar]:
    """What is known of positions: the ties' gaps, and rates that can be integrated from the start.

    Args:
        relations: what momenta and ties say of the speeds.
    """
    rows = [row for row in system.ties.rows if not row.identical]
    gaps = [row.gap for row in rows if row.gap is not None]
    return gaps + _integrated_rates(system, start) + _integrated_relations(system, start, relations)


def _integrated_relations(system: System, start: Mapping[Node, Scalar], relations: Relations | None) -> list[Scalar]:
    """q_k - q_k0 - integral of A over q_s, of u_k = A(q_s) u_s: the mass centre that keeps its place."""
    if relations is None:
        return []
    symbols = system.symbols
    own = {u: q for q, rate in zip(symbols.q, system.scope.rates, strict=True) for u in symbols.u if rate is u}
    leading = None if relations.speed is None else own.get(relations.speed)
    found: list[Scalar] = []
    for u, share in relations.shares.items():
        q = own.get(u)
        if q is None or q is leading or q not in start or not is_zero(relations.constants[u]):
            continue
        gained = 0 if is_zero(share) else _gained(share, leading, start, (*symbols.q, symbols.t))
        if gained is not None:
            found.append(q - start[q] - gained)
    return found


def _integrated_rates(system: System, start: Mapping[Node, Scalar]) -> list[Scalar]:
    """q - q0 - sum of A_k (q_k - q_k0) of q' = sum of A_k q_k' with numbers A_k, or one A_k that is a function of q_k.

    Of closing rows J u = 0 without a gap, with a J that does not move, J (q - q0). Dependent coordinates that gaps
    determine are where these say, and their q0 may be a guess.
    """
    symbols, scope = system.symbols, system.scope
    own = {u: q for q, rate in zip(symbols.q, scope.rates, strict=True) for u in symbols.u if rate is u}
    moving = (*symbols.q, symbols.t)
    found: list[Scalar] = []
    rows = [(q, row) for q, row, bias in zip(symbols.q, scope.N, scope.nu, strict=True) if is_zero(bias)]
    placed = _placed_by_gaps(system)
    rates = [(q, row) for q, row in rows if q not in own.values() and q in start and q.name not in placed]
    combinations = [(q - start[q], row) for q, row in rates]
    closing = [row for row in system.ties.closing if row.gap is None and not depends_on(row.velocity, moving)]
    combinations += [(0, gradient(row.velocity, symbols.u)) for row in closing]
    for left, row in combinations:
        gained = [_gained(a, own.get(u), start, moving) for a, u in zip(row, symbols.u, strict=True) if not is_zero(a)]
        if gained and all(x is not None for x in gained):
            found.append(left - sum((x for x in gained if x is not None), start=0))
    return found


def _placed_by_gaps(system: System) -> frozenset[str]:
    """The dependent coordinates that ties of positions alone determine."""
    of_velocities = {row.tie for row in system.ties.rows if row.gap is None}
    blocks = () if system.elimination is None else system.elimination.blocks
    return frozenset(name for block in blocks if not of_velocities & {*block.ties} for name in block.coordinates)


def _gained(a: Scalar, q: Node | None, start: Mapping[Node, Scalar], moving: Sequence[Node]) -> Scalar | None:
    """The integral of a over q from the start; None where a holds other coordinates, or there is no closed form."""
    if q is None or q not in start or depends_on(a, [x for x in moving if x is not q]):
        return None
    integral = primitive(a, q)
    return None if integral is None else integral - substituted((integral,), {q: start[q]})[0]
