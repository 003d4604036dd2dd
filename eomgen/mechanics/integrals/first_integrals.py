"""Equations of motion -> first integrals: the quantities conserved along every motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from random import Random
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure, hold_identically
from eomgen.mechanics.dynamics import (
    EquationsOfMotion,
    Extent,
    System,
    WellPosed,
    division_of,
)
from eomgen.mechanics.kinematics import GROUND, SystemInertia, integral_from_zero
from eomgen.model import Couple, GeneralizedForce, Load, PointForce
from eomgen.symbolic.exact import equal_at_random_states, exact_state, readable, real_values
from eomgen.symbolic.expression import Node, Scalar, Vector, depends_on, gradient, inner, is_zero, over
from eomgen.symbolic.numeric import (
    PRIME_FIELD,
    Choices,
    NoMeaning,
    NoValue,
    Work,
    dense,
    evaluate,
    fifty_digits,
    follows,
    has_pieces,
    tolerances,
)
from eomgen.symbolic.print import text_size

# -------- integrals -------------------------------------------------------------------------------------------
# Equations of motion -> first integrals: what stays constant along every motion.
#
# T + V = const,      p_k - integral of Q_k dt = const where dp_k/dt = Q_k(t),  p_k = dT/du_k u . dT/du - T + V =
# const    (Jacobi's, where what moves by itself does so at a steady rate)
#
# Each is decided in every piece of what is made of min, max, abs, sign, cases and samples; what stays in the piece of
# the start alone, as the energy above an elastic floor, says so long as what it does.


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
    held: Extent = Extent(True)


@dataclass(frozen=True)
class FirstIntegrals:
    """Quantities that stay constant along every motion of a system."""

    equations: EquationsOfMotion

    @property
    def work_of_constant_forces(self) -> Scalar:
        """W(q): F . r of constant forces on points, C times the angle of constant couples in the plane, Q_k q_k."""
        system = self.equations.system
        work: Scalar = 0
        for force in system.loads.applied:
            for load in () if force.potential is not None else force.loads:
                work = work + _work(system, load)
        for effort in system.loads.efforts:
            if _is_constant(system, effort.drive):
                work = work + effort.drive * system.motion.link(effort.body).s[effort.variable]
        return work

    @property
    def of_energy(self) -> tuple[Integral, ...]:
        """(T + V - W,) where it stays constant, W the work of constant forces that have no potential; else ().

        Where something moves by itself, Jacobi's integral if that stays. One that stays in every piece goes before one
        that stays in that of the start.
        """
        if not self.equations.M:
            return ()
        within: list[Integral] = []
        for V in (self.equations.V, self.equations.V - self.work_of_constant_forces):
            held = WellPosed(replace(self.equations, V=V)).where_conservative
            if held.everywhere:
                return (Integral("energy", self.equations.T + V),)
            if held:
                within.append(Integral("energy", self.equations.T + V, held=held))
        found = self.jacobi
        if found is not None:
            integral = Integral("jacobi", found[0], held=found[1])
            if integral.held.everywhere:
                return (integral,)
            within.append(integral)
        return tuple(within[:1])

    @property
    def where_momenta_hold(self) -> Extent:
        """Extent in which all conserved momenta are constant; results that follow from them hold there."""
        held = Extent(True)
        for each in self.of_momentum:
            if not depends_on(each.expression, (self.equations.symbols.t,)):
                held = held & each.held
        return held

    @property
    def of_momentum(self) -> tuple[Integral, ...]:
        """p_k - integral of dp_k/dt of every speed for which dp_k/dt is a function of time; a constant force is one."""
        symbols, scope = self.equations.symbols, self.equations.system.scope
        momenta = gradient(self.equations.T, symbols.u)
        drifts = scope.time_derivative(momenta)  # dp/dt = M a + drift, and M a = forcing + J^T lam
        others, found = (*symbols.x, *symbols.inputs.values()), []
        free = [k for k in range(len(symbols.u)) if all(hold_identically([row[k] for row in self.equations.J]))]
        rates = [drifts[k] + self.equations.forcing[k] for k in free]
        for k, (rate, held) in zip(free, _of_time_alone(self.equations, rates, others), strict=True):
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

    def stay_constant(self, functions: Sequence[Scalar]) -> tuple[bool, ...]:
        """True for each function of q, u and t that is constant along every motion, in every piece.

        With closing constraints or friction, or where the test cannot decide, all are False.
        """
        return tuple(held.everywhere for held in self.where_constant(functions))

    def where_constant(self, functions: Sequence[Scalar]) -> tuple[Extent, ...]:
        """Extent in which each function of q, u and t is constant along every motion."""
        if self.equations.J or self.equations.friction or not self.equations.M:
            return (Extent(False),) * len(functions)
        try:
            drifts = self.equations.system.scope.time_derivative(tuple(functions))
        except DerivationError:  # an input, which a caller may replace
            return (Extent(False),) * len(functions)
        slopes = [gradient(f, self.equations.symbols.u) for f in functions]
        rows = [[*row, force] for row, force in zip(self.equations.M, self.equations.forcing, strict=True)]
        requested = [[*slope, -drift] for slope, drift in zip(slopes, drifts, strict=True)]
        flat = [x for row in (*rows, *requested) for x in row]
        division = division_of(self.equations, flat)
        if division is None:
            return tuple(Extent(True) if yes else Extent(False) for yes in _following(rows, requested))
        known: dict[Choices, tuple[bool, ...]] = {}

        def found(piece: Choices) -> tuple[bool, ...]:
            if piece not in known:
                values = iter(division.chosen(flat, piece))
                table = [[next(values) for _ in row] for row in (*rows, *requested)]
                known[piece] = _following(table[: len(rows)], table[len(rows) :])
            return known[piece]

        return tuple(division.where(lambda piece, k=k: found(piece)[k]) for k in range(len(functions)))  # type: ignore[misc]

    @property
    def jacobi(self) -> tuple[Scalar, Extent] | None:
        """(u . dT/du - T + V, in which pieces it stays constant): drives at a steady rate take energy in and out."""
        symbols = self.equations.symbols
        moving = any(not is_zero(x) for x in self.equations.nu) or WellPosed(self.equations).moves_at_rest
        if depends_on(self.equations.V, (symbols.t,)) or not moving:
            return None
        found = inner(symbols.u, gradient(self.equations.T, symbols.u)) - self.equations.T + self.equations.V
        (held,) = self.where_constant((found,))
        return (found, held) if held else None

    def momenta_of_the_whole(self, known: Sequence[Scalar]) -> tuple[Constant, ...]:
        """Components of momentum and angular momentum that stay constant and are not among those known.

        Angular momenta about the point about which most of them stay, of such points the one about which least is new.
        """
        system = self.equations.system
        bodies = [link.name for link in system.motion.links if _has_inertia(system, link.name)]
        many = len(self.equations.M) > MOST_SPEEDS
        in_space = system.scope.model.space == "space"
        if not bodies or many or (in_space and SystemInertia(system.motion).shapeless(bodies)):
            return ()
        heavy = [body for body in bodies if not is_zero(system.scope.mass_properties(body).m)]
        P = _momentum(system, heavy)
        constant = self.stay_constant(P) if heavy else (False,) * 3
        places = ({"the mass centre": _mass_center(system, heavy)} if heavy else {}) | _seats(system)
        moments = [_constant_moments(self.equations, bodies, about, point) for about, point in places.items()]
        found = [Constant("P", axis, "", x) for axis, x, yes in zip("xyz", P, constant, strict=True) if yes]
        most = max(map(len, moments))
        new = [_new(each, known) for each in moments if len(each) == most]
        return (
            *_new(found, known),
            *min(new, key=lambda each: (len(each), sum(text_size(x.expression) for x in each))),
        )


def _work(system: System, load: Load) -> Scalar:
    """The work of one load where it is constant, else 0."""
    motion = system.motion
    if isinstance(load, PointForce) and load.axes is None and _is_constant(system, *load.force):
        return load.force @ motion.position(load.place)
    if isinstance(load, Couple) and _is_constant(system, *load.couple):
        angle = motion.link(load.body).angle
        return 0 if angle is None else load.couple[2] * angle
    if isinstance(load, GeneralizedForce) and _is_constant(system, load.value):
        return load.value * next(q for q in system.symbols.q if q.name == load.coordinate)
    return 0


def _is_constant(system: System, *scalars: Scalar) -> bool:
    symbols = system.symbols
    moving = (symbols.t, *symbols.x, *symbols.inputs.values())
    return not any(depends_on(x, moving) for x in scalars)


def _of_time_alone(
    equations: EquationsOfMotion, rates: Sequence[Scalar], others: Sequence[Node]
) -> list[tuple[Scalar | None, Extent]]:
    """Each rate where it depends on none of the others, else None; in which pieces."""
    whole = [None if has_pieces(rate) and depends_on(rate, others) else rate for rate in rates]
    smooth = iter(_alone_at_all(equations.system, [rate for rate in whole if rate is not None], others))
    return [
        _in_pieces(equations, rate, others) if same is None else (next(smooth), Extent(True))
        for rate, same in zip(rates, whole, strict=True)
    ]


def _in_pieces(equations: EquationsOfMotion, rate: Scalar, others: Sequence[Node]) -> tuple[Scalar | None, Extent]:
    """A rate that has pieces as it is in that of the start, where it depends on none of the others there."""
    division = division_of(equations, (rate,))
    if division is None:
        return _alone_at_all(equations.system, (rate,), others)[0], Extent(True)
    if division.start is None:
        return None, Extent(False)

    def alone(piece: Choices) -> Scalar | None:
        return _alone_at_all(equations.system, division.chosen((rate,), piece), others)[0]

    try:
        begun = alone(division.start)
    except DerivationError:  # a division by zero
        return None, Extent(False)
    if begun is None:
        return None, Extent(False)

    def stays(piece: Choices) -> bool:
        other = alone(piece)
        return other is not None and equal_at_random_states([(other, begun)]).equal

    held = division.where(stays)
    return (begun, held) if held else (None, Extent(False))


def _alone_at_all(system: System, rates: Sequence[Scalar], others: Sequence[Node]) -> list[Scalar | None]:
    """Each rate where it depends on none of the others, else None; what is seen to change needs no exact look."""
    changes = _seen_to_change(system, rates, others)
    left = [rate for rate, seen in zip(rates, changes, strict=True) if not seen]
    looked_at = iter(zip(left, hold_identically(left), strict=True))
    return [None if seen else _alone(*next(looked_at), others) for seen in changes]


def _alone(rate: Scalar, vanishes: bool, others: Sequence[Node]) -> Scalar | None:
    return rate if not depends_on(rate, others) else 0 if vanishes else _read_of_time(rate, others)


def _seen_to_change(system: System, rates: Sequence[Scalar], others: Sequence[Node]) -> list[bool]:
    """True for each rate that 50 digits show to change when the other coordinates change and t does not."""
    state, rng = Closure(system.constraints).scattered(), Random(2)
    moved = state | {x: state[x] + fifty_digits().number(rng.uniform(0.1, 0.4)) for x in others}
    moved |= system.scope.on_unit_norms(moved)
    try:
        here, there = (evaluate(rates, each, fifty_digits()) for each in (state, moved))
    except NoValue:
        return [False] * len(rates)
    size = max((abs(x) for x in (*here, *there)), default=0)
    return [abs(x - y) > tolerances.ZERO_AT_50 * max(1, size) for x, y in zip(here, there, strict=True)]


def _read_of_time(rate: Scalar, others: Sequence[Node]) -> Scalar | None:
    """The rate multiplied out, where it depends on none of the others then."""
    rate = readable(rate, Work.FORMULA)
    return None if depends_on(rate, others) else rate


# -------- constants of motion ---------------------------------------------------------------------------------
# Equations of motion -> whether a function of the motion stays constant; momenta of the whole that do.
#
#     df/dt = g.a + r = 0  for all a with  M a = forcing        g = df/du,  r what is left at a = 0
#
# that is, the row (g, -r) follows from the rows (M, forcing): decided exactly, at random states of a prime field, or
# with 50 digits where roots have no meaning there; in every piece of what is made of min, max, abs, sign, cases and
# samples.


STATES = 2
MOST_SPEEDS = 24  # of a system whose momenta are looked at
ORIGIN = (0, 0, 0)


@dataclass(frozen=True)
class Constant:
    """A momentum of the whole system that stays constant, or the square of one.

    Args:
        letter: "P" momentum, "L" angular momentum.
        axis: "x", "y", "z" of the ground; "" the square of all three.
        about: "" of P; of L "the mass centre", or the place on the ground.
        expression: the function.
    """

    letter: str
    axis: str
    about: str
    expression: Scalar


def _following(rows: Sequence[Sequence[Scalar]], requested: Sequence[Sequence[Scalar]]) -> tuple[bool, ...]:
    """True for each requested row that depends linearly on the rows, at random states: exact, or else of 50 digits."""
    flat = [x for row in (*rows, *requested) for x in row]
    for follow, values_of in ((follows, _exact_values), (dense.follows_in_digits, _real_values)):
        rng, found = Random(5), [True] * len(requested)
        try:
            for _ in range(STATES):
                values = iter(values_of(flat, rng))
                table = [[next(values) for _ in row] for row in (*rows, *requested)]
                known, others = table[: len(rows)], table[len(rows) :]
                found = [yes and follow(known, row) for yes, row in zip(found, others, strict=True)]
            return tuple(found)
        except (NoMeaning, NoValue, ValueError, DerivationError):
            continue
    return (False,) * len(requested)


def _exact_values(flat: Sequence[Scalar], rng: Random) -> list[Any]:
    return evaluate(flat, exact_state(flat, rng).values, PRIME_FIELD)


def _real_values(flat: Sequence[Scalar], rng: Random) -> list[Any]:
    return real_values(flat, rng, fifty_digits())


def _constant_moments(equations: EquationsOfMotion, bodies: Sequence[str], about: str, point: Vector) -> list[Constant]:
    """The components of the angular momentum about a point that stay, and in space the square of one body's."""
    system = equations.system
    in_space = system.scope.model.space == "space"
    axes = "xyz" if in_space else "z"
    L = SystemInertia(system.motion).angular_momentum(point, bodies)[-len(axes) :]
    constant = FirstIntegrals(equations).stay_constant(L)
    found = [Constant("L", axis, about, x) for axis, x, yes in zip(axes, L, constant, strict=True) if yes]
    if in_space and all(constant) and len(bodies) == 1:
        found.append(Constant("L", "", about, _square(system, point, bodies[0])))
    return found


def _has_inertia(system: System, body: str) -> bool:
    mass = system.scope.mass_properties(body)
    return not is_zero(mass.m) or not all(is_zero(x) for row in mass.I for x in row)


def _new(found: Sequence[Constant], known: Sequence[Scalar]) -> tuple[Constant, ...]:
    """Constants found that do not vanish and are neither one of those known nor its opposite."""
    kept: list[Constant] = []
    for each in found:
        x = each.expression
        others = [*known, *(other.expression for other in kept)]
        if not _vanishes(x) and not any(_vanishes(x - y) or _vanishes(x + y) for y in others):
            kept.append(each)
    return tuple(kept)


def _vanishes(x: Scalar) -> bool:
    return equal_at_random_states([(x, 0)]).equal


def _momentum(system: System, bodies: Sequence[str]) -> Vector:
    """sum m v_C, ground axes."""
    total: Vector = Vector.ZERO
    for body in bodies:
        mass = system.scope.mass_properties(body)
        total = total + mass.m * system.motion.velocity((body, mass.com))
    return total


def _mass_center(system: System, bodies: Sequence[str]) -> Vector:
    """sum m r_C / sum m"""
    whole: Scalar = 0
    total: Vector = Vector.ZERO
    for body in bodies:
        mass = system.scope.mass_properties(body)
        whole, total = whole + mass.m, total + mass.m * system.motion.position((body, mass.com))
    return Vector(over(x, whole) for x in total)


def _seats(system: System) -> dict[str, Vector]:
    """Fixed places at which bodies are joined to the ground, by name; the ground's origin where there are none."""
    symbols = system.symbols
    found: dict[str, Vector] = {}
    for link in system.motion.links:
        on_ground = link.parent == GROUND
        if on_ground and not any(depends_on(x, (symbols.t, *symbols.q)) for x in link.before.p):
            zero = all(is_zero(x) for x in link.before.p)
            found.setdefault("the origin" if zero else f"the joint of {link.name}", link.before.p)
    return found or {"the origin": Vector.ZERO}


def _square(system: System, point: Vector, body: str) -> Scalar:
    """L.L of one body, in its own axes."""
    link, mass = system.motion.link(body), system.scope.mass_properties(body)
    arm = mass.com - link.pose.R.T @ (point - link.pose.p)
    v = link.twist.v + link.twist.w.cross(mass.com)
    own: Vector = mass.I @ link.twist.w + mass.m * arm.cross(v)
    return own @ own
