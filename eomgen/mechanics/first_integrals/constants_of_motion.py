"""Equations of motion -> whether a function of the motion stays constant; momenta of the whole that do.

    df/dt = g.a + r = 0  for all a with  M a = forcing        g = df/du,  r what is left at a = 0

that is, the row (g, -r) follows from the rows (M, forcing): decided exactly, at random states of a prime field, or with
50 digits where roots have no meaning there; in every piece of what is made of min, max, abs, sign, cases and samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.kinematics import GROUND, velocity_of
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.pieces import EVERYWHERE, NOWHERE, Extent, division_of
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.masses.inertia_about import angular_momentum, shapeless
from eomgen.records import dataclass
from eomgen.symbolic.exact.equality import equal_at_random_states, exact_state, real_values
from eomgen.symbolic.expression.derivative import depends_on, gradient
from eomgen.symbolic.expression.functions import inner, over
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.spatial import (
    ZERO,
    Vector,
    apply,
    cross,
    dot,
    minus,
    plus,
    times,
    transposed,
    vector_of,
)
from eomgen.symbolic.numeric import dense
from eomgen.symbolic.numeric.evaluation import PRIME_FIELD, NoMeaning, NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.modular import follows
from eomgen.symbolic.numeric.pieces import Choices, as_chosen
from eomgen.symbolic.print.text import text_size

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


def stay_constant(equations: EquationsOfMotion, functions: Sequence[Scalar]) -> tuple[bool, ...]:
    """Of each function of q, u and t whether it stays constant along every motion, in every piece.

    Where ties close or there is friction none is said to be, nor where the prime field cannot tell.
    """
    return tuple(held.everywhere for held in where_constant(equations, functions))


def where_constant(equations: EquationsOfMotion, functions: Sequence[Scalar]) -> tuple[Extent, ...]:
    """Of each function of q, u and t in which pieces it stays constant."""
    if equations.J or equations.friction or not equations.M:
        return (NOWHERE,) * len(functions)
    try:
        drifts = equations.system.scope.time_derivative(tuple(functions))
    except DerivationError:  # an input, which a caller may replace
        return (NOWHERE,) * len(functions)
    slopes = [gradient(f, equations.symbols.u) for f in functions]
    rows = [[*row, force] for row, force in zip(equations.M, equations.forcing, strict=True)]
    asked = [[*slope, -drift] for slope, drift in zip(slopes, drifts, strict=True)]
    flat = [x for row in (*rows, *asked) for x in row]
    division = division_of(equations, flat)
    if division is None:
        return tuple(EVERYWHERE if yes else NOWHERE for yes in _following(rows, asked))
    known: dict[Choices, tuple[bool, ...]] = {}

    def found(piece: Choices) -> tuple[bool, ...]:
        if piece not in known:
            values = iter(as_chosen(flat, division.nodes, piece))
            table = [[next(values) for _ in row] for row in (*rows, *asked)]
            known[piece] = _following(table[: len(rows)], table[len(rows) :])
        return known[piece]

    return tuple(division.where(lambda piece, k=k: found(piece)[k]) for k in range(len(functions)))  # type: ignore[misc]


def _following(rows: Sequence[Sequence[Scalar]], asked: Sequence[Sequence[Scalar]]) -> tuple[bool, ...]:
    """Of each row asked whether it follows from the rows, at random states: exact ones, or else of 50 digits."""
    flat = [x for row in (*rows, *asked) for x in row]
    for follow, values_of in ((follows, _exact_values), (dense.follows_in_digits, _real_values)):
        rng, found = Random(5), [True] * len(asked)
        try:
            for _ in range(STATES):
                values = iter(values_of(flat, rng))
                table = [[next(values) for _ in row] for row in (*rows, *asked)]
                known, others = table[: len(rows)], table[len(rows) :]
                found = [yes and follow(known, row) for yes, row in zip(found, others, strict=True)]
            return tuple(found)
        except (NoMeaning, NoValue, ValueError, DerivationError):
            continue
    return (False,) * len(asked)


def _exact_values(flat: Sequence[Scalar], rng: Random) -> list[Any]:
    return evaluate(flat, exact_state(flat, rng).values, PRIME_FIELD)


def _real_values(flat: Sequence[Scalar], rng: Random) -> list[Any]:
    return real_values(flat, rng, fifty_digits())


def jacobi(equations: EquationsOfMotion) -> tuple[Scalar, Extent] | None:
    """(u . dT/du - T + V, in which pieces it stays constant): drives at a steady rate take energy in and out."""
    symbols = equations.symbols
    if depends_on(equations.V, (symbols.t,)) or all(is_zero(x) for x in equations.nu):
        return None
    found = inner(symbols.u, gradient(equations.T, symbols.u)) - equations.T + equations.V
    (held,) = where_constant(equations, (found,))
    return (found, held) if held else None


def momenta_of_the_whole(equations: EquationsOfMotion, known: Sequence[Scalar]) -> tuple[Constant, ...]:
    """Components of momentum and angular momentum that stay constant and are not among those known.

    Angular momenta about the point about which most of them stay, of such points the one about which least is new.
    """
    system = equations.system
    bodies = [link.name for link in system.motion.links if _has_inertia(system, link.name)]
    many = len(equations.M) > MOST_SPEEDS
    in_space = system.scope.model.space == "space"
    if not bodies or many or (in_space and shapeless(system.motion, bodies)):
        return ()
    heavy = [body for body in bodies if not is_zero(mass_properties(system.scope, body).m)]
    P = _momentum(system, heavy)
    constant = stay_constant(equations, P) if heavy else (False,) * 3
    places = ({"the mass centre": _mass_center(system, heavy)} if heavy else {}) | _seats(system)
    moments = [_constant_moments(equations, bodies, about, point) for about, point in places.items()]
    found = [Constant("P", axis, "", x) for axis, x, yes in zip("xyz", P, constant, strict=True) if yes]
    most = max(map(len, moments))
    new = [_new(each, known) for each in moments if len(each) == most]
    return (*_new(found, known), *min(new, key=lambda each: (len(each), sum(text_size(x.expression) for x in each))))


def _constant_moments(equations: EquationsOfMotion, bodies: Sequence[str], about: str, point: Vector) -> list[Constant]:
    """The components of the angular momentum about a point that stay, and in space the square of one body's."""
    system = equations.system
    in_space = system.scope.model.space == "space"
    axes = "xyz" if in_space else "z"
    L = angular_momentum(system.motion, point, bodies)[-len(axes) :]
    constant = stay_constant(equations, L)
    found = [Constant("L", axis, about, x) for axis, x, yes in zip(axes, L, constant, strict=True) if yes]
    if in_space and all(constant) and len(bodies) == 1:
        found.append(Constant("L", "", about, _square(system, point, bodies[0])))
    return found


def _has_inertia(system: System, body: str) -> bool:
    mass = mass_properties(system.scope, body)
    return not is_zero(mass.m) or not all(is_zero(x) for row in mass.I for x in row)


def _new(found: Sequence[Constant], known: Sequence[Scalar]) -> tuple[Constant, ...]:
    """Those that are no numbers, and neither one of those known nor its opposite."""
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
    total: Vector = ZERO
    for body in bodies:
        mass = mass_properties(system.scope, body)
        total = plus(total, times(mass.m, velocity_of(system.motion, (body, mass.com))))
    return total


def _mass_center(system: System, bodies: Sequence[str]) -> Vector:
    """sum m r_C / sum m"""
    whole: Scalar = 0
    total: Vector = ZERO
    for body in bodies:
        mass = mass_properties(system.scope, body)
        whole, total = whole + mass.m, plus(total, times(mass.m, system.motion.position((body, mass.com))))
    return vector_of(over(x, whole) for x in total)


def _seats(system: System) -> dict[str, Vector]:
    """Where bodies are joined to the ground, at places that stay; the ground's origin where there are none."""
    symbols = system.symbols
    found: dict[str, Vector] = {}
    for link in system.motion.links:
        on_ground = link.parent == GROUND
        if on_ground and not any(depends_on(x, (symbols.t, *symbols.q)) for x in link.before.p):
            zero = all(is_zero(x) for x in link.before.p)
            found.setdefault("the origin" if zero else f"the joint of {link.name}", link.before.p)
    return found or {"the origin": ORIGIN}


def _square(system: System, point: Vector, body: str) -> Scalar:
    """L.L of one body, in its own axes."""
    link, mass = system.motion.link(body), mass_properties(system.scope, body)
    arm = minus(mass.com, apply(transposed(link.pose.R), minus(point, link.pose.p)))
    v = plus(link.twist.v, cross(link.twist.w, mass.com))
    own = plus(apply(mass.I, link.twist.w), times(mass.m, cross(arm, v)))
    return dot(own, own)
