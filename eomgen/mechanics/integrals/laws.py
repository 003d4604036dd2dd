"""Accelerations, start -> laws of motion q(t) in closed form, and the state at an instant of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from random import Random

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.integrals.linear_motion import LinearEquation, MotionConstants, law_of_motion, waves
from eomgen.mechanics.integrals.speeds import Relations, rates_of
from eomgen.mechanics.kinematics import Located, integral_from_zero, primitive
from eomgen.symbolic.exact import sign_of_terms, simplest, vanishes
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    ScalarRows,
    State,
    depends_on,
    derivative,
    gradient,
    is_zero,
    over,
    sqrt,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, NoValue, Work, evaluate
from eomgen.symbolic.print import text_size

# -------- laws ------------------------------------------------------------------------------------------------
# Accelerations, start -> laws of motion: q(t) and u(t) in closed form, where there is one.
#
# Coordinates are taken one after the other: as soon as all that the acceleration of one holds are t, itself, and
# others whose laws are known, it is one equation in one unknown, and is solved where it is linear with constant
# coefficients; so are pairs that have no damping. A coordinate whose rate is a known function of time is integrated.


SEEN = 1e-3  # relative: a change that rounding does not make


def laws_of_motion(system: System, accelerations: Sequence[Scalar], start: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """q(t) and u(t) of every coordinate and speed that has a law in closed form.

    Args:
        accelerations: a as expressions of q, u, t and inputs.
        start: q and u at the start, scalars of the parameters; t where that is not 0.
    """
    return _Laws(system, start, system.scope.positive).found(tuple(accelerations))


@dataclass(frozen=True)
class _Laws:
    """The search for laws; inside it time counts from the start.

    Args:
        system, start: whose, and from where.
        positive: parameters that are positive.
    """

    system: System
    start: Mapping[Node, Scalar]
    positive: frozenset[Node]

    def found(self, accelerations: tuple[Scalar, ...]) -> dict[Node, Scalar]:
        """The laws, one after the other, as long as there is one."""
        symbols = self.system.symbols
        own = {node: self.system.inputs[name] for name, node in symbols.inputs.items()}
        begin = {symbols.t: symbols.t + self.start.get(symbols.t, 0)}
        speeds = dict(zip(symbols.u, self._replaced(accelerations, own, begin), strict=True))
        rates = dict(zip(symbols.q, self._replaced(self.system.scope.rates, own, begin), strict=True))
        laws: dict[Node, Scalar] = {}
        while new := self._by_rate(rates, laws) or self._by_line(speeds, laws) or self._by_pair(speeds, laws):
            laws |= {
                node: min(law, simplest(law, Work.VALUE, self.positive), key=text_size) for node, law in new.items()
            }
            speeds = {u: a for u, a in speeds.items() if u not in laws}
            rates = {q: rate for q, rate in rates.items() if q not in laws}
        later = {symbols.t: symbols.t - self.start.get(symbols.t, 0)}
        return {node: substituted((law,), later)[0] for node, law in laws.items()}

    def _replaced(self, scalars: tuple[Scalar, ...], *each: Mapping[Node, Scalar]) -> tuple[Scalar, ...]:
        for replacements in each:
            scalars = substituted(scalars, replacements)
        return scalars

    def _by_rate(self, rates: Mapping[Node, Scalar], laws: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """A coordinate whose rate is a known function of time: driven, or dependent on known ones."""
        for q, rate in rates.items():
            (rate,) = substituted((rate,), laws)
            if depends_on(rate, self._moving):
                continue
            try:
                return {q: self.start[q] + integral_from_zero(rate, self.system.symbols.t, q.name)}
            except DerivationError:
                continue
        return {}

    def _by_line(self, speeds: Mapping[Node, Scalar], laws: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """A coordinate with a linear equation of its own."""
        for u, a in speeds.items():
            q = self._coordinate(u)
            line = None if q is None or q in laws else self._line(substituted((a,), laws)[0], q, u)
            if q is None or line is None:
                continue
            law = law_of_motion(line, self.start[q], self.start[u], self._constants)
            if law is not None:
                return {q: law, u: derivative(law, self.system.symbols.t)}
        return {}

    def _by_pair(self, speeds: Mapping[Node, Scalar], laws: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """Two coordinates with linear equations of their own."""
        for two in combinations(speeds, 2):
            q = [x for u in two if (x := self._coordinate(u)) is not None]
            if len(q) < 2:
                continue
            a = substituted([speeds[u] for u in two], laws)
            pair = self._pair(a, q, two)
            if pair is None:
                continue
            law = pair_solution(pair, [self.start[x] for x in q], [self.start[u] for u in two], self._constants)
            if law is not None:
                rates = (derivative(x, self.system.symbols.t) for x in law)
                return dict(zip((*q, *two), (*law, *rates), strict=True))
        return {}

    def _line(self, a: Scalar, q: Node, u: Node) -> LinearEquation | None:
        """a as A q + B u + f(t) with constants A and B, or None."""
        A, B = derivative(a, q), derivative(a, u)
        if self._vary([[A], [B], [a, -A * q, -B * u]]):
            return None
        a = simplest(a, Work.VALUE, self.positive)
        A, B = derivative(a, q), derivative(a, u)
        if any(depends_on(x, (*self._moving, self.system.symbols.t)) for x in (A, B)):
            return None
        f = simplest(a - A * q - B * u, Work.VALUE, self.positive)
        return None if depends_on(f, self._moving) else LinearEquation(A, B, f)

    def _pair(self, a: Sequence[Scalar], q: Sequence[Node], u: Sequence[Node]) -> CoupledEquations | None:
        """a as A q + B u + b with constants, or None."""
        slopes = [[derivative(x, y) for y in (*q, *u)] for x in a]
        rests = [[x, *(-k * y for k, y in zip(row, (*q, *u), strict=True))] for x, row in zip(a, slopes, strict=True)]
        if self._vary([*([k] for row in slopes for k in row), *rests]):
            return None
        a = tuple(simplest(x, Work.VALUE, self.positive) for x in a)
        A, B = ([[derivative(x, y) for y in of] for x in a] for of in (q, u))
        rest = [x - sum(derivative(x, y) * y for y in (*q, *u)) for x in a]
        b = [simplest(x, Work.VALUE, self.positive) for x in rest]
        constants = (*A[0], *A[1], *B[0], *B[1], *b)
        return (
            None
            if any(depends_on(x, (*self._moving, self.system.symbols.t)) for x in constants)
            else CoupledEquations(A, B, b)
        )

    def _vary(self, sums: Sequence[Sequence[Scalar]]) -> bool:
        """True if numbers at two states show that one of the sums of terms changes with the moving variables."""
        rng = Random(1)
        terms = [x for each in sums for x in each]
        fixed = {x: rng.uniform(0.5, 1.5) for x in symbols_of(terms) if x not in self._moving}
        states = [fixed | {x: rng.uniform(0.3, 1.1) for x in self._moving} for _ in range(2)]
        try:
            one, other = (iter(evaluate(terms, state, FLOAT)) for state in states)
        except (NoValue, ZeroDivisionError):
            return False
        for each in sums:
            pairs = [(next(one), next(other)) for _ in each]
            if abs(sum(x - y for x, y in pairs)) > SEEN * max(max(abs(x), abs(y)) for x, y in pairs):
                return True
        return False

    def _coordinate(self, u: Node) -> Node | None:
        """The coordinate whose rate the speed is."""
        rates = zip(self.system.symbols.q, self.system.scope.rates, strict=True)
        return next((q for q, rate in rates if rate is u), None)

    @property
    def _moving(self) -> tuple[Node, ...]:
        return self.system.symbols.x

    @property
    def _constants(self) -> MotionConstants:
        zero = self.system.scope.zero
        return MotionConstants(
            self.system.symbols.t, self._sign, lambda x: simplest(x, Work.VALUE, self.positive), zero
        )

    def _sign(self, x: Scalar) -> int | None:
        """The sign of a constant: of its value, or the one that all of its terms have."""
        if type(x) is not Node:
            return (x > 0) - (x < 0)
        if vanishes(x):
            return 0
        values = self.system.scope.model.exact_parameters()
        parameters = self.system.symbols.parameters
        known = {node: float(values[name]) for name, node in parameters.items() if name in values}
        if any(symbol not in known for symbol in symbols_of((x,))):
            return sign_of_terms(x, self.positive)
        value = evaluate((x,), known, FLOAT)[0]
        return int(value > 0) - int(value < 0)


# -------- coupled motion --------------------------------------------------------------------------------------
# Two coordinates with linear equations of motion -> their solutions in closed form.
#
#     q'' = A q + B q' + b,   or  x' = S x + z,  x = (q, q'),  S = [0, 1; A, B],  z = (0, b)
#
# where the motion looks the same backward in time, det(l^2 - l B - A) being even in l: springs, weights, gyroscopic
# and Coriolis terms, no damping. With M = S^2, whose eigenvalues mu are two and real,
#
#     x = E(M) x0 + S O(M) x0 + O(M) z + S G(M) z
#
#     E(mu) = cosh(w t),  O(mu) = sinh(w t)/w,  G(mu) = (cosh(w t) - 1)/w^2,  w^2 = mu


Four = tuple[Scalar, ...]
WaveCoefficients = tuple[Scalar, Scalar, Scalar]  # E, O, G
WavePart = tuple[
    Callable[[Four], Four], WaveCoefficients
]  # of f(M) x: what multiplies f or its derivative at an eigenvalue, and that


@dataclass(frozen=True)
class CoupledEquations:
    """q'' = A q + B q' + b of two coordinates; all constants."""

    A: ScalarRows
    B: ScalarRows
    b: Sequence[Scalar]

    def rate(self, x: Four) -> Four:
        """S x."""
        return (*x[2:], *(_row(self.A[i], x[:2]) + _row(self.B[i], x[2:]) for i in range(2)))

    def less(self, x: Four, mu: Scalar) -> Four:
        """(M - mu) x."""
        return tuple(y - mu * own for y, own in zip(self.rate(self.rate(x)), x, strict=True))

    @property
    def is_even(self) -> bool:
        """True if det(l^2 - l B - A) has no odd powers of l: B11 + B22 = 0, A11 B22 + A22 B11 = A12 B21 + A21 B12."""
        A, B = self.A, self.B
        mixed = A[0][0] * B[1][1] + A[1][1] * B[0][0] - A[0][1] * B[1][0] - A[1][0] * B[0][1]
        return vanishes(B[0][0] + B[1][1]) and vanishes(mixed)


def pair_solution(
    pair: CoupledEquations, q0: Sequence[Scalar], u0: Sequence[Scalar], of: MotionConstants
) -> tuple[Scalar, Scalar] | None:
    """(q1, q2) as functions of t with q(0) = q0, q'(0) = u0; None where no closed form is known."""
    parts = _parts(pair, of)
    if parts is None:
        return None
    found: list[Scalar] = [0, 0]
    for share, (even, odd, gained) in parts:
        x, z = share((*q0, *u0)), share((0, 0, *pair.b))
        for i in range(2):
            added = even * of.simple(x[i]) + odd * of.simple(x[2 + i] + z[i]) + gained * of.simple(z[2 + i])
            found[i] = found[i] + added
    return found[0], found[1]


def _parts(pair: CoupledEquations, of: MotionConstants) -> list[WavePart] | None:
    """f(M) = f(mu1) (M - mu2)/(mu1 - mu2) + f(mu2) (M - mu1)/(mu2 - mu1),  or  f(mu) + f'(mu) (M - mu)."""
    values = _eigenvalues(pair, of)
    each = [waves for mu in values if (waves := _waves(mu, of)) is not None]
    if not values or len(each) < len(values):
        return None
    if len(values) == 1:
        mu = values[0]
        return [(lambda x: x, each[0]), (lambda x: pair.less(x, mu), _derivatives(of.t, mu, each[0]))]

    def share(own: Scalar, other: Scalar) -> Callable[[Four], Four]:
        return lambda x: tuple(over(y, own - other) for y in pair.less(x, other))

    return [(share(*values), each[0]), (share(*values[::-1]), each[1])]


def _eigenvalues(pair: CoupledEquations, of: MotionConstants) -> tuple[Scalar, ...]:
    """The eigenvalues of M where they are real, one where they coincide; else none.

    mu^2 + (B11 B22 - B12 B21 - A11 - A22) mu + A11 A22 - A12 A21 = 0
    """
    if not pair.is_even:
        return ()
    half = over(pair.A[0][0] + pair.A[1][1] - _determinant(pair.B), 2)
    inside = of.simple(half * half - _determinant(pair.A))
    sign = of.sign(inside)
    if sign == 0:
        return (of.simple(half),)
    root = of.simple(sqrt(inside)) if sign == 1 else 0
    return (of.simple(half + root), of.simple(half - root)) if sign == 1 else ()


def _waves(mu: Scalar, of: MotionConstants) -> WaveCoefficients | None:
    """E, O and G at mu."""
    found = waves(mu, of)
    if found is None:
        return None
    even, odd, w = found
    return even, over(odd, w), over(of.t * of.t, 2) if is_zero(mu) else over(even - 1, mu)


def _derivatives(t: Node, mu: Scalar, at: WaveCoefficients) -> WaveCoefficients:
    """E' = t O/2,  O' = (t E - O)/(2 mu),  G' = (t O/2 - G)/mu;  at 0  t^2/2,  t^3/6,  t^4/24."""
    even, odd, gained = at
    if is_zero(mu):
        return over(t**2, 2), over(t**3, 6), over(t**4, 24)
    slope = over(t * odd, 2)
    return slope, over(t * even - odd, 2 * mu), over(slope - gained, mu)


def _row(row: Sequence[Scalar], x: Sequence[Scalar]) -> Scalar:
    return row[0] * x[0] + row[1] * x[1]


def _determinant(A: ScalarRows) -> Scalar:
    return A[0][0] * A[1][1] - A[0][1] * A[1][0]


# -------- closed instant --------------------------------------------------------------------------------------
# System, condition, its place in numbers -> the state at an instant in closed form.
#
# By the laws of motion: the condition is an equation in t. By the integrals: speeds are functions of the coordinates,
# and the condition with the constraints is a set of equations between coordinates. What is found is taken only where it
# agrees with the numbers.


@dataclass(frozen=True)
class ClosedInstant:
    """State at which a condition is satisfied, in closed form.

    Args:
        equations, accelerations: the equations of motion.
        condition: of q, u, t and parameters; it vanishes.
        start: t, q and u at the start, scalars of the parameters.
        located: the requested state, in numbers.
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
        """The laws at the time at which the condition is satisfied."""
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
        """Coordinates by the condition and the constraints, speeds by the integrals; those that have a closed form."""
        speeds = self._rates({})
        equations = list(substituted((self.condition,), speeds))
        equations += position_equations(self.equations.system, self.start, self._relations({}))
        others = (*self.equations.symbols.u, self.equations.symbols.t)
        equations = [x for x in equations if not depends_on(x, others)]
        places = self._agreeing(self.located.places(equations, self.equations.symbols.q))
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
            return Relations.of(self.equations, self.start, at)
        except DerivationError:  # a division by 0 at this place, a start without closed form
            return None

    def _agreeing(self, state: State) -> State:
        """Values that depend on parameters only and agree with the located numbers."""
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
        return self.equations.symbols.x


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
    """Expressions of positions that vanish: gaps of the constraints, and rates integrated from the start.

    Args:
        relations: those that momenta and constraints give between the speeds.
    """
    rows = [row for row in system.constraints.rows if not row.identical]
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

    Of constraint rows J u = 0 without a gap, with a J that does not move, J (q - q0). Dependent coordinates that gaps
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
    closing = [row for row in system.constraints.closing if row.gap is None and not depends_on(row.velocity, moving)]
    combinations += [(0, gradient(row.velocity, symbols.u)) for row in closing]
    for left, row in combinations:
        gained = [_gained(a, own.get(u), start, moving) for a, u in zip(row, symbols.u, strict=True) if not is_zero(a)]
        if gained and all(x is not None for x in gained):
            found.append(left - sum((x for x in gained if x is not None), start=0))
    return found


def _placed_by_gaps(system: System) -> frozenset[str]:
    """The dependent coordinates that constraints of positions alone determine."""
    of_velocities = {row.constraint for row in system.constraints.rows if row.gap is None}
    blocks = () if system.elimination is None else system.elimination.blocks
    return frozenset(name for block in blocks if not of_velocities & {*block.constraints} for name in block.coordinates)


def _gained(a: Scalar, q: Node | None, start: Mapping[Node, Scalar], moving: Sequence[Node]) -> Scalar | None:
    """The integral of a over q from the start; None where a holds other coordinates, or there is no closed form."""
    if q is None or q not in start or depends_on(a, [x for x in moving if x is not q]):
        return None
    integral = primitive(a, q)
    return None if integral is None else integral - substituted((integral,), {q: start[q]})[0]
