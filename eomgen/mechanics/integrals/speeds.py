"""First integrals, start -> every speed as a function of the coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial

from eomgen.errors import DerivationError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics import EquationsOfMotion, Extent, System
from eomgen.mechanics.integrals.first_integrals import (
    FirstIntegrals,
)
from eomgen.mechanics.integrals.linear_motion import LinearEquation, MotionConstants, particular
from eomgen.mechanics.kinematics import primitive
from eomgen.symbolic.exact import LinearSystem, Solution, sign_of_terms, simplest, vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    Symbols,
    depends_on,
    derivative,
    function,
    gradient,
    is_zero,
    linear_terms,
    order,
    over,
    substituted,
)
from eomgen.symbolic.numeric import FLOAT, Work, evaluate, fifty_digits, has_pieces, tolerances

# -------- speeds ----------------------------------------------------------------------------------------------
# First integrals, start -> every speed as a function of the coordinates, without time.
#
# Momenta and constraint rows are linear in the speeds and leave one of them (`relations`), which the energy gives, or
# the equation of its path (`free_speed`).


def rates_of(
    equations: EquationsOfMotion,
    start: Mapping[Node, Scalar],
    *,
    there: Mapping[Node, float] | None = None,
    accelerations: Sequence[Scalar] | None = None,
    at: Mapping[Node, Scalar] | None = None,
) -> dict[Node, Scalar] | None:
    """Every speed as a function of the coordinates, by the integrals; None where they do not give it.

    Args:
        start: q and u at the start, scalars of the parameters.
        there: a state of the motion in numbers, with parameters, that says in which sense it goes; None: the start.
        accelerations: a as expressions, for what loses energy, and for the sense in which a motion leaves a rest.
        at: coordinates whose values are put in before anything is solved.
    Raises:
        DerivationError: a coordinate has no value at the start.
    """
    found = rates_and_extent(equations, start, there=there, accelerations=accelerations, at=at)
    return None if found is None else found[0]


def rates_and_extent(
    equations: EquationsOfMotion,
    start: Mapping[Node, Scalar],
    *,
    there: Mapping[Node, float] | None = None,
    accelerations: Sequence[Scalar] | None = None,
    at: Mapping[Node, Scalar] | None = None,
) -> tuple[dict[Node, Scalar], Extent] | None:
    """(the same, in which pieces the integrals hold that give it)."""
    relations = Relations.of(equations, start, at)
    if relations is None:
        return None
    speeds, held = relations.speeds, FirstIntegrals(equations).where_momenta_hold
    if relations.speed is None:
        return speeds, held
    there = start_in_numbers(equations.system, start) if there is None else there
    found = FreeSpeed(equations, relations, start, there, accelerations, at or {}).value()
    if found is None:
        return None
    speed, of_speed = found
    rates = substituted(tuple(speeds.values()), {relations.speed: speed})
    return dict(zip(speeds, rates, strict=True)), held & of_speed


def start_in_numbers(system: System, start: Mapping[Node, Scalar]) -> dict[Node, float]:
    """The start in numbers; a parameter without a value counts as 1: some sense of the motion must be chosen."""
    known = system.scope.model.exact_parameters()
    values = {node: float(known.get(name, 1)) for name, node in system.symbols.parameters.items()}
    return values | {node: float(evaluate((x,), values, FLOAT)[0]) for node, x in start.items()}


# -------- free speed ------------------------------------------------------------------------------------------
# Relations, start -> the one free speed u_s as a function of the coordinates, without time.
#
# The energy is a quadratic function of it,
#
#     A u_s^2 + B u_s + C = 0,   A > 0,   u_s = (sense sqrt(B^2 - 4 A C) - B) / 2 A,   sense = sign(2 A u_s + B).
#
# Where energy is lost, but a_s = F0(q_s) + F2(q_s) u_s^2, y = u_s^2 is the solution of dy/dq_s = 2 F0 + 2 F2 y.


@dataclass(frozen=True)
class FreeSpeed:
    """Quantities from which the free speed is found.

    Args:
        equations: the equations of motion.
        relations: every speed by the free one.
        start: q and u at the start, scalars of the parameters.
        there: a state of the motion in numbers, parameters included, which gives the sense of the motion.
        accelerations: a as expressions, where they are known.
        at: coordinates whose values are put in.
    """

    equations: EquationsOfMotion
    relations: Relations
    start: Mapping[Node, Scalar]
    there: Mapping[Node, float]
    accelerations: Sequence[Scalar] | None
    at: Mapping[Node, Scalar]

    def value(self) -> tuple[Scalar, Extent] | None:
        """(u_s as a function of the coordinates that are not in `at`, where that holds); None where nothing gives it.

        By the energy where it is conserved; else along the path, where it is lost or stored without a potential; else
        by the energy in the piece in which it is conserved.
        """
        energies = FirstIntegrals(self.equations).of_energy
        if not any(energy.held.everywhere for energy in energies):
            square = self._square_by_path()
            if square is not None:
                root = function("sqrt", self._simple(substituted((square,), self.at)[0]))
                return self._sense(self._speed) * root, Extent(True)
        for energy in energies:
            difference = energy.expression - value_at_start(energy.expression, self.start, self.equations.symbols)
            return self._root_of_energy(substituted((difference,), self.relations.speeds)[0]), energy.held
        return None

    @property
    def _speed(self) -> Node:
        assert self.relations.speed is not None
        return self.relations.speed

    def _simple(self, x: Scalar) -> Scalar:
        return simplest(x, Work.VALUE, self.equations.system.scope.positive)

    # -- in which sense ---------------------------------------------------------------------------

    def _sense(self, slope: Scalar) -> int:
        """The sign of 2 A u_s + B there; at rest that of the motion that follows; 1 if it stays at rest.

        Args:
            slope: 2 A u_s + B as it depends on u_s, or u_s itself.
        """
        (bias,) = substituted((slope,), {self._speed: 0})
        found, own = self._number(slope), self._number(bias)
        if abs(found) <= tolerances.COMPUTED * (abs(found - own) + abs(own)):
            found = 0.0 if self.accelerations is None else self._number(self._acceleration)
        return -1 if found < 0 else 1

    def _number(self, x: Scalar) -> float:
        """A scalar's value there."""
        return float(evaluate((x,), self.there, FLOAT)[0])

    @property
    def _acceleration(self) -> Scalar:
        """Acceleration of the free speed, with the model's own inputs."""
        assert self.accelerations is not None
        inputs = {node: self.equations.inputs[name] for name, node in self.equations.symbols.inputs.items()}
        return substituted((self.accelerations[self.equations.symbols.u.index(self._speed)],), inputs)[0]

    # -- by the energy ----------------------------------------------------------------------------

    def _root_of_energy(self, energy: Scalar) -> Scalar:
        """u_s of A u_s^2 + B u_s + C = 0."""
        s = self._speed
        slope = derivative(energy, s)
        sense = self._sense(slope)
        energy, slope = substituted((energy, slope), self.at)
        C, B = substituted((energy, slope), {s: 0})
        A = over(derivative(slope, s), 2)
        if vanishes(B):
            return 0 if vanishes(C) else sense * function("sqrt", self._simple(over(-C, A)))
        inside = self._simple(B * B - 4 * A * C)
        return self._simple(over(sense * function("sqrt", inside) - B, 2 * A))

    # -- along the path, where energy is lost -----------------------------------------------------

    def _square_by_path(self) -> Scalar | None:
        """y = u_s^2 as a function of q_s, from dy/dq_s = 2 F0 + 2 F2 y."""
        symbols, s = self.equations.symbols, self._speed
        q = next((q for q in symbols.q if q.name + "'" == s.name), None)
        if q is None or self.accelerations is None:
            return None
        (F,) = substituted((self.accelerations[symbols.u.index(s)],), self.relations.speeds)  # of all q: `at` is later
        F = self._in_sense(F)
        if depends_on(F, (symbols.t, *symbols.inputs.values())) or self._has_pieces_of_speed(F):
            return None
        F = simplest(F, Work.VALUE)
        F0, F2 = substituted((F, over(derivative(derivative(F, s), s), 2)), {s: 0})
        others = tuple(x for x in symbols.q if x is not q)
        if depends_on(F0, others) or depends_on(F2, others) or not vanishes(F - F0 - F2 * s * s):
            return None
        solution = _of_first_order(2 * self._simple(F0), 2 * self._simple(F2), q)
        if solution is None:
            return None
        growth, own = solution
        at, first = substituted((own, growth), {q: self.start[q]})
        return own + over(growth, first) * (self.start[s] * self.start[s] - at)

    def _has_pieces_of_speed(self, F: Scalar) -> bool:
        """True if F has a piecewise function of the free speed: max(0, -y')."""
        return has_pieces(F, (self._speed,))

    def _in_sense(self, F: Scalar) -> Scalar:
        """F with sign(k u_s) replaced by what it is in this sense, for every k that has a sign of its own."""
        s, sense = self._speed, self._sense(self._speed)
        known: dict[Node, Scalar] = {}
        for node in order((F,)):
            if node.op != "sign":
                continue
            k = self._simple(derivative(node.args[0], s))
            sign = sign_of_terms(k, self.equations.system.scope.positive)
            if sign and vanishes(node.args[0] - k * s):
                known[node] = sense * sign
        return substituted((F,), known)[0] if known else F


def _of_first_order(f: Scalar, k: Scalar, q: Node) -> tuple[Scalar, Scalar] | None:
    """(g, y): solutions of g' = k g and y' = k y + f; None where they have no closed form."""
    power = 0 if is_zero(k) else primitive(k, q)
    if power is None:
        return None
    growth = exponential_of(power)
    if not is_zero(k) and not depends_on(k, (q,)):
        constants = MotionConstants(q, lambda x: None, lambda x: simplest(x, Work.VALUE))
        second = particular(LinearEquation(0, k, f), constants)  # of Y'' = k Y' + f, y = Y'
        return None if second is None else (growth, derivative(second, q))
    gained = primitive_over_bends(over(f, growth), q)
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


# -------- speeds from momenta ---------------------------------------------------------------------------------
# Momenta, constraint rows -> every speed by one of them, without time: both are linear in the speeds.


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

    @staticmethod
    def of(
        equations: EquationsOfMotion, start: Mapping[Node, Scalar], at: Mapping[Node, Scalar] | None = None
    ) -> Relations | None:
        """Relations between the speeds from momenta and constraint rows, all linear in them; None if several stay free.

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
        for integral in FirstIntegrals(equations).of_momentum:
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
        own = LinearSystem(
            rows,
            right,
            unknowns,
            partial(evaluate, values=Closure(system.constraints).generic(), arithmetic=fifty_digits()),
        ).solution()
    except (DerivationError, MissingValues):
        return None
    with suppress(DerivationError, MissingValues):
        shaken = Closure(system.constraints).generic(shaken=True)
        found = LinearSystem(
            rows, right, unknowns, partial(evaluate, values=shaken, arithmetic=fifty_digits())
        ).solution()
        return found if len(found.free) == len(own.free) else own
    return own


def value_at_start(integral: Scalar, start: Mapping[Node, Scalar], symbols: Symbols) -> Scalar:
    """An integral's value at the start; where the speeds are 0 coefficients need not exist, as at a branch point.

    Raises:
        DerivationError: it holds a coordinate or speed that has no exact value there.
    """
    (integral,) = substituted((integral,), {u: start[u] for u in symbols.u if u in start})
    (value,) = substituted((integral,), start)
    left = [x.name for x in symbols.x if depends_on(value, (x,))]
    if left:
        raise DerivationError(
            f"the start has no closed form: {', '.join(left)}", fix="give them as numbers in [coordinates]"
        )
    return value


BENT = ("max", "min", "abs", "sign")


def primitive_over_bends(f: Scalar, x: Node) -> Scalar | None:
    """`primitive`, of functions with bends too, continuous over these; None where no closed form was found.

    f = rest + sum of c times what has a bend, its arguments linear in x, c without x. The integral of max(0, d) is
    max(0, d)^2/(2 d'), of min(0, d) the same with min, of |d| it is d |d|/(2 d'), of sign(d) it is |d|/d'.
    """
    total: Scalar = 0
    while type(f) is Node and (bent := [n for n in order((f,)) if n.op in BENT and depends_on(n, (x,))]):
        node = bent[-1]  # what holds others comes after them
        name = f.graph.symbol("(what has a bend)")
        (named,) = substituted((f,), {node: name})
        factor, own = derivative(named, name), _of_one_bend(node, x)
        if own is None or depends_on(factor, (x, name)):
            return None
        (f,) = substituted((named,), {name: 0})
        total = total + factor * own
    rest = 0 if is_zero(f) else primitive(f, x)
    return None if rest is None else total + rest


def _of_one_bend(node: Node, x: Node) -> Scalar | None:
    """The integral of max, min, abs or sign of what is linear in x; None of anything else."""
    a: Scalar
    b: Scalar
    a, b = node.args if len(node.args) == 2 else (node.args[0], 0)
    if not depends_on(a, (x,)):
        a, b = b, a
    d = a - b
    slope = derivative(d, x)
    if is_zero(slope) or depends_on(slope, (x,)) or any(depends_on(derivative(y, x), (x,)) for y in (a, b)):
        return None
    if node.op == "sign":
        return over(function("abs", d), slope)
    if node.op == "abs":
        return over(d * function("abs", d), 2 * slope)
    above = function(node.op, 0, d)  # max(a, b) = b + max(0, a - b), and min the same
    return Fraction(1, 2) * derivative(b, x) * x * x + substituted((b,), {x: 0})[0] * x + over(above * above, 2 * slope)
