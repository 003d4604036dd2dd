"""System -> Kind: the kind of motion of a body, and the curves on which its points move."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure, Rank
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import VelocityField
from eomgen.mechanics.state import Numbers
from eomgen.symbolic.exact import simplest, vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    State,
    Vector,
    depends_on,
    is_zero,
    over,
    sqrt,
    substituted,
    tangent,
)
from eomgen.symbolic.numeric import Newton, NoValue, Work, evaluate, fifty_digits, tolerances

# -------- motion kind -----------------------------------------------------------------------------------------
# System -> Kind: what kind of motion a body makes, from its field of velocities along every possible motion.
#
# Two invariants belong to a field: omega.omega and omega.v. Where omega vanishes the body translates; where its
# direction stays and omega.v vanishes it moves in parallel planes; where moreover its axis stays,
#
#     c = p + omega x v / omega.omega,     c' along omega,
#
# it turns about that axis, and moves helically where omega.v does not vanish: by the pitch omega.v/omega.omega a
# radian.


REST, TRANSLATION, ROTATION, PLANE = "rest", "translation", "rotation about a fixed axis", "plane motion"
HELICAL, SLIDING = "helical motion", "rotation about a fixed axis and sliding along it"
SPHERICAL, GENERAL = "rotation about a fixed point", "general motion"
WAYS = {"line": "rectilinear translation", "circle": "circular translation", "curve": "curvilinear translation"}


@dataclass(frozen=True)
class Kind:
    """The kind of motion of a body.

    Args:
        name: in words.
        at: a point of the axis, the fixed point; None where there is none, or none in closed form.
        axis: direction of the axis, of the normal of the planes.
        pitch: advance along the axis per radian.
        way: of a translation, the line on which its points run.
        point: the body's point that is there, by name, "" where it has none.
    """

    name: str
    at: Vector | None = None
    axis: Vector | None = None
    pitch: Scalar | None = None
    way: Curve | None = None
    point: str = ""

    @property
    def is_helical(self) -> bool:
        """True if the body advances along the axis about which it turns, at any instant."""
        return self.name == HELICAL


@dataclass(frozen=True)
class Kinds:
    """The kinds of motion of the bodies of a system.

    Args:
        system: the system.
        start: an exact state of its motion, or {}.
    """

    system: System
    start: Mapping[Node, Scalar]

    @cached_property
    def possible(self) -> Possible:
        return Possible(self.system)

    @cached_property
    def constants(self) -> Constants:
        return Constants(self.possible, self.start, self.system.scope.positive)

    def of(self, body: str) -> Kind:
        """The kind of motion of one body.

        Raises:
            DerivationError: the constraints do not close, or the motion is singular near the start.
        """
        field, vanish = self.system.motion.field(body), self.possible.vanish
        if vanish(*field.w):
            if vanish(*field.v):
                return Kind(REST)
            way = curve_of(field.p, self.possible, self.constants)
            return Kind(WAYS[way.kind], way=way)
        if vanish(*field.w.cross(field.e)):
            return self._about_one_direction(body, field)
        return self._in_all_directions(body, field)

    def _about_one_direction(self, body: str, field: VelocityField) -> Kind:
        """Kind of a motion in which omega keeps its direction."""
        vanish, possible = self.possible.vanish, self.possible
        axis = self._direction(field.w)
        planar = vanish(field.w @ field.v)
        center = field.axis_point()
        if not vanish(*possible.rate_of(center).cross(field.w)):
            return Kind(PLANE if planar else GENERAL, axis=axis)
        if planar:
            return Kind(ROTATION, self.constants.vector(center), axis, point=self._named(body, field))
        pitch = over(field.w @ field.v, field.w @ field.w)
        if not vanish(*possible.rate((pitch,))):
            return Kind(SLIDING, self._on_axis(center, field.w), axis)
        return Kind(HELICAL, self._on_axis(center, field.w), axis, self.constants.of(pitch))

    def _in_all_directions(self, body: str, field: VelocityField) -> Kind:
        """Kind of a motion in which omega turns: about a fixed point, or general."""
        place = fixed_point(field)
        if self.possible.vanish(*field.velocity(place), *self.possible.rate(place)):
            return Kind(SPHERICAL, self.constants.vector(place), point=self._named(body, field))
        return Kind(GENERAL)

    def _direction(self, w: Vector) -> Vector | None:
        """A constant vector along omega, whose first component that does not vanish is 1."""
        for component in w:
            if not self.possible.vanish(component):
                return self.constants.vector(over(1, component) * w)
        return None

    def _on_axis(self, center: Vector, w: Vector) -> Vector | None:
        """The point of a fixed axis nearest to the ground's origin."""
        return self.constants.vector(center - over(center @ w, w @ w) * w)

    def _named(self, body: str, field: VelocityField) -> str:
        """The body's first point that stays where it is: `bar.start`; "" where none has a name."""
        motion = self.system.motion
        for name, local in motion.points[body].items():
            if not motion.moves(local) and self.possible.vanish(*field.velocity(motion.position((body, local)))):
                return f"{body}.{name}"
        return ""

    def centrodes(self) -> tuple[Centrodes, ...]:
        """The centrodes of all bodies that have them."""
        found = []
        for link in self.system.motion.links:
            try:
                found.append(centrodes_of(self, link.name))
            except (DerivationError, MissingValues):  # no motion near the start at which it could be tried
                continue
        return tuple(each for each in found if each is not None)


def fixed_point(field: VelocityField) -> Vector:
    """The point of a body whose velocity and acceleration vanish together, where there is one and omega turns.

    v + omega x r = 0 gives r but for its part along omega, and a + epsilon x r + omega x (omega x r) = 0 that one.
    """
    w, e = field.w, field.e
    across = over(1, w @ w) * w.cross(field.v)
    turning = e.cross(w)
    left = field.a + (e.cross(across) + w.cross(w.cross(across)))
    along = over(-(left @ turning), turning @ turning)
    return field.p + (across + along * w)


# -- at one instant --------------------------------------------------------------------------------


def instant_kind(field: VelocityField) -> str:
    """The kind of a field at one instant: rest, translation, rotation, helical motion."""
    if all(vanishes(x) for x in field.w):
        return REST if all(vanishes(x) for x in field.v) else TRANSLATION
    return "rotation" if vanishes(field.w @ field.v) else HELICAL


def in_body(system: System, body: str, place: Vector) -> Vector:
    """A place of the ground seen from a body, in its axes [m]."""
    pose = system.motion.link(body).pose
    return pose.R.T @ (place - pose.p)


# -------- centers ---------------------------------------------------------------------------------------------
# Field -> Center: the point about which a body turns in the plane, seen from the ground or from another body.
#
# With v_0 the velocity of the body's point that is at the ground's origin, a point (x, y) has the velocity (v_0x - w
# y, v_0y + w x). It is 0 at the homogeneous point
#
#     c = (-v_0y : v_0x : w)
#
# which is at infinity, across the velocity, where w = 0; c = 0 where nothing moves. The field is linear, hence so are
# relative centres: c_ij = c_0j - c_0i, and any three centres c_ij, c_jk, c_ik are on one line (Aronhold, Kennedy).


Homogeneous = Vector
"""(x : y : w), a point of the plane; w = 0 at infinity."""


def homogeneous_center(field: VelocityField) -> Homogeneous:
    """c = (-v_0y : v_0x : w) of a field."""
    v = field.velocity(Vector.ZERO)
    return Vector((-v[1], v[0], field.w[2]))


def finite_center(field: VelocityField, whose: str) -> Vector:
    """The centre of rotation at a finite place.

    Args:
        whose: the body, for messages.
    Raises:
        DerivationError: it is at infinity: a translation; or everywhere: a rest.
    """
    if not vanishes(field.w[2]):
        return field.rotation_center()
    if all(vanishes(x) for x in field.v):
        raise DerivationError(
            f"{whose} is at rest: every point is a centre of rotation", fix="choose a state in which the body turns"
        )
    raise DerivationError(
        f"{whose} translates{_along(field.v)}: its centre of rotation is at infinity",
        fix="choose a state in which the body turns",
    )


def _along(v: Vector) -> str:
    return " along y" if vanishes(v[0]) else " along x" if vanishes(v[1]) else ""


# -------- curves ----------------------------------------------------------------------------------------------
# Possible, a moving place -> Curve: the line on which it moves, known exactly by rates that vanish in every motion.
#
# at rest: c' = 0;   straight: c' x c'' = 0;
# a circle: the centre of curvature is constant, c + |c'|^2 (c' x c'') x c' / |c' x c''|^2


TRIED = (Fraction(0), Fraction(1), Fraction(1, 2), Fraction(2))  # values of what a constant does not depend on


@dataclass(frozen=True)
class Curve:
    """The line on which a place runs.

    Args:
        kind: "point", "line", "circle" or "curve".
        at: the point, a point of the line, the centre of the circle; None where it has no closed form.
        along: the direction of the line; of a circle the axis across it.
        radius: of the circle.
    """

    kind: str
    at: Vector | None = None
    along: Vector | None = None
    radius: Scalar | None = None


@dataclass(frozen=True)
class Constants:
    """Puts what is known to be constant into closed form.

    Args:
        possible: the motions along which it is constant.
        start: an exact state of the motion, or {}.
        positive: symbols that stand for positive numbers.
    """

    possible: Possible
    start: Mapping[Node, Scalar]
    positive: frozenset[Node]

    def of(self, x: Scalar) -> Scalar | None:
        """The constant as a function of the parameters; None where it has no closed form."""
        moving = self._moving
        x = simplest(x, Work.VALUE, self.positive)
        if not depends_on(x, moving):
            return x
        for state in self._states(moving):
            try:
                found = simplest(substituted((x,), state)[0], Work.VALUE, self.positive)
            except DerivationError:  # a division by zero there
                continue
            if not depends_on(found, moving):
                return found
        return None

    def vector(self, x: Vector) -> Vector | None:
        """Constant vector as functions of the parameters, by its components."""
        found = [value for each in x if (value := self.of(each)) is not None]
        return Vector(found) if len(found) == 3 else None

    def length(self, x: Vector) -> Scalar | None:
        """The same of the length of a vector that may turn: of its components where they are short."""
        moving = self._moving
        for state in self._states(moving):
            try:
                there = Vector([simplest(each, Work.VALUE, self.positive) for each in substituted(x, state)])
            except DerivationError:  # a division by zero there
                continue
            if not any(depends_on(each, moving) for each in there):
                return simplest(sqrt(there @ there), Work.VALUE, self.positive)
        return self.of(sqrt(x @ x))

    def some_place(self, place: Vector) -> Vector | None:
        """A place on the way of one that moves, as functions of the parameters: where it is at the start, if known."""
        symbols = self.possible.system.symbols
        moving = (symbols.t, *symbols.x, *symbols.a)
        for state in self._states(moving):
            x, y, z = (simplest(x, Work.VALUE, self.positive) for x in substituted(place, state))
            if not any(depends_on(each, moving) for each in (x, y, z)):
                return Vector((x, y, z))
        return None

    @property
    def _moving(self) -> tuple[Node, ...]:
        symbols = self.possible.system.symbols
        return (symbols.t, *symbols.x, *symbols.a, *self.possible.jerks)

    def _states(self, moving: tuple[Node, ...]) -> Iterator[dict[Node, Scalar]]:
        """Exact states: those with the coordinates of the start, and where nothing constraints them any others."""
        symbols = self.possible.system.symbols
        of_place = (symbols.t, *symbols.q)
        rates = [x for x in moving if x not in of_place]
        constrained = bool(self.possible.system.constraints.closing) or self.possible.system.free is not None
        for value in TRIED[1:]:
            if all(q in self.start for q in symbols.q):
                yield {**{x: self.start.get(x, 0) for x in of_place}, **dict.fromkeys(rates, value)}
        if not constrained:
            for value in TRIED:
                yield {**dict.fromkeys(of_place, value), **dict.fromkeys(rates, 1)}


def curve_of(place: Vector, possible: Possible, constants: Constants) -> Curve:
    """The line on which a place runs that depends on coordinates and t."""
    v = possible.rate_of(place)
    if possible.vanish(*v):
        return Curve("point", constants.vector(place))
    a = possible.rate_of(v)
    n = v.cross(a)
    if possible.vanish(*n):
        return Curve("line", constants.some_place(place), _direction(v, possible, constants))
    arm = _arm(v, a)
    center = place + arm
    if possible.vanish(*possible.rate_of(center), *_turning(n, possible)):
        return Curve("circle", constants.vector(center), _direction(n, possible, constants), constants.length(arm))
    return Curve("curve")


def _arm(v: Vector, a: Vector) -> Vector:
    """Vector from a point with velocity v and acceleration a to the centre of curvature of its path."""
    n = v.cross(a)
    return over(v @ v, n @ n) * n.cross(v)


def _direction(v: Vector, possible: Possible, constants: Constants) -> Vector | None:
    """A constant vector along v: over its first component that does not vanish."""
    for component in v:
        if not possible.vanish(component):
            return constants.vector(over(1, component) * v)
    return None


def _turning(n: Vector, possible: Possible) -> tuple[Scalar, ...]:
    """Components of n x n', which vanish if the direction of n is constant; () if n is along z."""
    return n.cross(possible.rate_of(n)) if not possible.vanish(n[0], n[1]) else ()


# -------- possible --------------------------------------------------------------------------------------------
# System -> Possible: motions that the constraints allow, to the third order, in numbers of 50 digits.
#
#     phi = 0,   J u + sigma = 0,   J a + gamma = 0,   J a' + d/dt(J a + gamma) at a' = 0 = 0
#
# What must vanish along every motion (the rate of a centre that stays, the curvature of a straight way) is tried at
# two of them.


CORRECTED = Newton(steps=4)  # each step adds about 15 digits
SEEDS = (1, 2)


@dataclass(frozen=True)
class Possible:
    """The motions of a system.

    Args:
        system: the system.
        shaken: parameters have values of their own, so that nothing holds for the model's values alone.
    """

    system: System
    shaken: bool = False

    @cached_property
    def jerks(self) -> tuple[Node, ...]:
        """Symbols of a', one for each speed."""
        symbols = self.system.symbols
        return tuple(symbols.graph.symbol(a.name + "'") for a in symbols.a)

    def rate(self, x: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """d/dt of functions of q, u, a and t; it holds the symbols of a'."""
        symbols, scope = self.system.symbols, self.system.scope
        flow = {**scope.flow, **dict(zip(symbols.u, symbols.a, strict=True))}
        return tangent(tuple(x), {**flow, **dict(zip(symbols.a, self.jerks, strict=True))})

    def rate_of(self, x: Vector) -> Vector:
        """d/dt of a vector, 3."""
        return Vector(self.rate(x))

    def vanish(self, *scalars: Scalar) -> bool:
        """True if all scalars are zero along every motion.

        Raises:
            DerivationError: the constraints cannot be satisfied, or the scalars have values at no state.
        """
        left = [x for x in scalars if type(x) is Node or x != 0]
        return not left or all(self._vanish_at(left, state) for state in self.states)

    def _vanish_at(self, scalars: Sequence[Scalar], state: State) -> bool:
        try:
            values = evaluate(scalars, state, fifty_digits())
        except (NoValue, ZeroDivisionError):
            raise DerivationError(
                "the motion is singular near the start", "coordinates", fix="start apart from the dead centre"
            ) from None
        return bool(max(map(abs, values)) < tolerances.ZERO_AT_50)

    @cached_property
    def states(self) -> tuple[State, ...]:
        """Values of every symbol along two motions."""
        return tuple(self._state(Random(seed)) for seed in SEEDS)

    def _state(self, rng: Random) -> State:
        constraints, symbols = self.system.constraints, self.system.symbols
        state = Closure(constraints).generic(rng, shaken=self.shaken)
        state |= {node: fifty_digits().number(rng.uniform(-1, 1)) for node in self.jerks}
        rows = tuple(row.velocity for row in constraints.closing)
        J = tuple(x for row in constraints.J for x in row)
        for unknowns in (symbols.u, symbols.a, self.jerks):
            state = _closed(J, rows, unknowns, state)
            rows = self.rate(rows)
        return state


def _closed(J: Sequence[Scalar], rows: Sequence[Scalar], unknowns: Sequence[Node], state: State) -> State:
    """The state with the nearest values of the unknowns at which the rows, linear in them by J, vanish."""
    if not rows or not unknowns:
        return state
    slopes = Numbers(state).array((J,), len(J)).reshape(len(rows), len(unknowns))
    found = CORRECTED.root(_LinearRows(tuple(rows), slopes, tuple(unknowns)), state)
    if math.isnan(found.left):
        raise DerivationError(
            "the motion is singular near the start", "coordinates", fix="start apart from the dead centre"
        )
    return found.x


@dataclass(frozen=True)
class _LinearRows:
    """Rows that are linear in the unknowns."""

    rows: tuple[Scalar, ...]
    matrix: np.ndarray
    unknowns: tuple[Node, ...]

    def left(self, state: State) -> Sequence[Any]:
        return evaluate(self.rows, state, fifty_digits())

    def slopes(self, state: State) -> np.ndarray:
        return self.matrix

    def moved(self, state: State, step: Sequence[Any]) -> State:
        return state | {node: state[node] + d for node, d in zip(self.unknowns, step, strict=True)}


# -------- centrodes -------------------------------------------------------------------------------------------
# Kinds -> Centrodes: the curves on which the centre of rotation of a body runs, in the ground and in the body.
#
#     c = p + omega x v / omega^2 in ground axes,   R^T (c - p) in the body's: the moving one rolls on the fixed one
#
# Where one parameter moves the body (one degree of freedom, or time) they are functions of the coordinates, or of t.


@dataclass(frozen=True)
class Centrodes:
    """The centre of rotation of one body as its motion goes on.

    Args:
        body: its name.
        fixed, moving: the place in ground axes and in body axes, functions of the coordinates and t.
        fixed_curve, moving_curve: the lines on which it runs.
    """

    body: str
    fixed: Vector
    moving: Vector
    fixed_curve: Curve
    moving_curve: Curve


def centrodes_of(kinds: Kinds, body: str) -> Centrodes | None:
    """The centrodes of a body in plane motion; None where it has no single ones.

    So it is where the centre stays or is at infinity, where more than one parameter moves the system, or where the
    rates are left to multipliers, and are no functions of one of them.
    """
    system = kinds.system
    if system.scope.model.space != "plane" or kinds.of(body).name != PLANE or parameters(kinds) != 1:
        return None
    try:
        center = system.motion.field(body).rotation_center()
        unit = dict.fromkeys(system.symbols.u, 1)  # one speed, which cancels
        (x, y, z) = substituted(center, unit)
    except DerivationError:
        return None
    places = (x, y, z), in_body(system, body, Vector((x, y, z)))
    fixed, moving = (Vector(simplest(each, Work.VALUE, kinds.constants.positive) for each in place) for place in places)
    if depends_on(x, system.symbols.u) or len(system.symbols.u) > 1:
        return None
    curves = [curve_of(place, kinds.possible, kinds.constants) for place in (fixed, moving)]
    return Centrodes(body, fixed, moving, *curves)


def parameters(kinds: Kinds) -> int:
    """Number of parameters that move a system: its degrees of freedom by rank, plus 1 if something moves with time."""
    return Rank(kinds.system.constraints).degrees_of_freedom(kinds.possible.states[0]) + moves_by_itself(kinds.system)


def moves_by_itself(system: System) -> bool:
    """True if something moves with time as prescribed: nu or sigma is not 0."""
    return not all(is_zero(x) for x in (*system.scope.nu, *system.constraints.sigma))
