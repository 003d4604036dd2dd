"""Base class of forces, and the two ways to what each does.

A force is declared by fields that say where it acts and by which law. `loads` gives that over the graph, from which the
equations are derived; `acts` gives it in numbers at a state, by which they are proven.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from typing import Any, ClassVar, Protocol

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, owner_of
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.load import Fluid, Load, LoadContext, Push, SpreadLoad
from eomgen.model.kinds import JointFriction
from eomgen.model.part import MADE, Part
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Scalar, Vector, as_expression

# -------- second way ------------------------------------------------------------------------------------------
# What a force does, in numbers, as its fields declare it: what the proof compares `loads` with. It uses places, twists
# and masses of a system at a state, and nothing of `loads`.


AXES = tuple(tuple(as_expression(str(int(i == k))) for i in range(3)) for k in range(3))
"""x, y and z as declared vectors."""


@dataclass(frozen=True)
class Act:
    """Action of a force in numbers: it pushes along what moves, and turns a body.

    Its virtual work is sum force_k d(moving_k) + couple . d(turn of the body).

    Args:
        body: on which it acts; None: the ground, or no body.
        moving: a place of the body, or one scalar, over the coordinates; () of a couple alone.
        force: along each of these; of a place, ground axes [N].
        couple: on the body, ground axes [N m].
        kinetic: a kinetic energy of what moves and is no body, over the motion; None: none [J].
        fluid: (v, p, L) of the fluid that moves with the body at the place, over the motion, axes of the body: its
            velocity against the fluid, momentum and angular momentum; (): none.
    """

    body: str | None = None
    moving: tuple[Scalar, ...] = ()
    force: tuple[Any, ...] = ()
    couple: Vector = Vector.ZERO
    kinetic: Scalar | None = None
    fluid: tuple[Vector, ...] = ()

    def times(self, k: Any) -> Act:
        """The action multiplied by a number."""
        return replace(self, force=tuple(k * x for x in self.force), couple=k * self.couple)


class StretchedRope(Protocol):
    """The straight pieces of a rope at a state, in numbers."""

    @property
    def stretch(self) -> Any:
        """Length by which it is longer than without tension [m]."""

    @property
    def rate(self) -> Any:
        """Rate of that, by the material that it touches [m/s]."""

    def pulled(self, tension: Any) -> Iterator[Act]:
        """Forces of a tension at both ends of every piece [N]."""


class ForceTrial(Protocol):
    """A system at a state, in numbers of 50 digits and ground axes, for the second way to what a force does.

    Places are those of the poses, velocities those of the twists.
    """

    def value(self, x: Any, also: Mapping[str, Any] | None = None) -> Any:
        """Number of a declared expression, None: 0; further names in it stand for given numbers."""

    def directed(self, xs: tuple[Any, ...], axes: str = "ground") -> Vector:
        """A declared vector, which is written in the axes of the ground or of a body."""

    def scalar(self, x: Any) -> Scalar:
        """A declared expression, or a coordinate by its name, over the coordinates."""

    def place(self, point: str) -> tuple[str | None, Vector]:
        """(body, place over the coordinates) of a point."""

    def vector(self, moving: Sequence[Scalar]) -> Vector:
        """Numbers of a place."""

    def at_start(self, moving: Sequence[Scalar]) -> list[Any]:
        """Numbers where the motion starts."""

    def velocity_of(self, point: str) -> Vector:
        """Velocity of a point, also against its body [m/s]."""

    def angle(self, body: str) -> Scalar:
        """Angle of a body in the plane, over the coordinates."""

    def turned(self, body: str | None) -> tuple[Any, Any]:
        """Angle of the axes of a body about z, with its whole turns, and its rate [rad, rad/s]."""

    def masses(self, bodies: tuple[str, ...] | None) -> Iterator[tuple[str, Any, Vector]]:
        """(body, mass, its centre over the coordinates) of the named bodies, or of all."""

    def mass_that_enters(self, body: str, rate: Any) -> Any:
        """Mass that enters a body per second: the declared rate, None: what other flows leave [kg/s]."""

    def rope(self, stops: tuple[Any, ...], slack: Any) -> StretchedRope:
        """A rope along points and wraps, `slack` its length without tension, or "start"."""

    def spin(self, body: str) -> Vector:
        """Angular velocity of a body [rad/s]."""

    def axis(self, body: str) -> Vector:
        """Unit vector along the axis about which the joint of a body turns; in the plane z."""

    def in_joint(self, body: str) -> tuple[Any, tuple[Act, ...]]:
        """(rate s' of a body's joint, the action of a unit along s on the body and on what carries it)."""

    def rubs(self, force: Force, size: Any, rate: Any) -> Any:
        """Dry friction of a size, never below 0, by its rate: - F sign(v), in a phase of the sense of its mode."""

    def direction(self, v: Vector) -> Vector:
        """v over its length.

        Raises:
            NoValue: it has none.
        """

    def function(self, name: str, *x: Any) -> Any:
        """A function of numbers: sqrt, tanh, atan2 ..."""

    def rate_of(self, xs: tuple[Any, ...]) -> Vector:
        """d/dt of a declared vector of time, ground axes."""

    def in_stream(self, point: str, medium: tuple[Any, ...] | None) -> tuple[Vector, Vector]:
        """(velocity of a point less that of a medium, spin of its body) by the twist, its axes, over the motion."""

    @property
    def plane(self) -> bool:
        """True of a model in the plane."""


# -------- element ---------------------------------------------------------------------------------------------
# Action between two points, or between two bodies that turn, as it is declared.


class Pressed(Protocol):
    """A cylinder that pushes the ends of an element apart by the pressure in it."""

    def push(self, here: ForceTrial, length: Any) -> Any:
        """Force that drives the ends apart, in numbers [N]."""


@dataclass(frozen=True)
class Element:
    """Action between two points, or a couple that turns two bodies relative to one another.

    With l = |r_2 - r_1| (or n . (r_2 - r_1)) and l' = n . (v_2 - v_1), or the angle between the axes of both and its
    rate, it pulls with T = k (l - l_0) + c l' + f(l, l'), on the first along n, on the second the opposite; the energy
    of a spring is V = k (l - l_0)^2 / 2.

    Args:
        points: its ends; () for what turns bodies.
        bodies: the first and the second; None: the ground.
        along: a fixed direction along which its length is measured; None: from end to end.
        stiffness, damping: of length and its rate, of angle and its rate; None: 0.
        slack: the length, or angle, at which a spring is slack, or "start"; None: 0.
        pushes: beyond the slack, where it is shorter, it pushes and never pulls, elsewhere it does nothing.
        power: n of the law k x^n that it then has (None: 1).
        dissipation: a share of it per speed of compression: k x^n (1 + a x') (None: 0).
        pull: a law of the length `r` and its rate `r'`; None: 0.
        pressed: a cylinder between its ends; None: there is none.
    """

    points: tuple[str, ...] = ()
    bodies: tuple[str | None, ...] = ()
    along: tuple[Expression, ...] | None = None
    stiffness: Expression | None = None
    damping: Expression | None = None
    slack: Expression | str | None = None
    pull: Expression | None = None
    pushes: bool = False
    power: Expression | None = None
    dissipation: Expression | None = None
    pressed: Pressed | None = None

    # -- in numbers ------------------------------------------------------------------------------------------

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        """The pull at both ends, or the couples on both bodies, at a state."""
        pull = self.law(here)[0]
        for body, sign in zip(self.bodies, (1, -1), strict=False):
            yield Act(body, couple=Vector((0, 0, sign * pull)))
        for point, sign in zip(self.points, (1, -1), strict=False):
            yield Act(*here.place(point), sign * pull * self._direction(here))

    def law(self, here: ForceTrial) -> tuple[Any, Any]:
        """(T, V) at a state; V is None where the element is no spring."""
        k, c = here.value(self.stiffness), here.value(self.damping)
        length, rate = self.measured(here)
        pull, energy = c * rate, None
        if self.pressed is not None:
            return -self.pressed.push(here, length), None
        if self.pushes:
            return self._pushed(here, self._slack(here) - length, rate)
        if self.stiffness is not None:
            stretch = length - self._slack(here)
            pull, energy = pull + k * stretch, k * stretch * stretch / 2
        if self.pull is not None:
            pull += here.value(self.pull, {"r": length, "r'": rate})
        return pull, energy

    def _pushed(self, here: ForceTrial, x: Any, rate: Any) -> tuple[Any, Any]:
        """(T, V) of a bumper that is compressed by x: - (k x^n (1 + a x') + d x') where both are above 0."""
        k, c, a = map(here.value, (self.stiffness, self.damping, self.dissipation))
        n = 1 if self.power is None else here.value(self.power)
        if x <= 0:
            return 0 * x, 0 * x
        push = k * x**n
        return -max(push * max(1 - a * rate, 0) - c * rate, 0 * x), push * x / (n + 1)

    def measured(self, here: ForceTrial) -> tuple[Any, Any]:
        """(l, l') or (theta, theta')"""
        if not self.points:
            (first, w_1), (second, w_2) = map(here.turned, self.bodies)
            return second - first, w_2 - w_1
        A, B = self._ends(here)
        v_1, v_2 = map(here.velocity_of, self.points)
        n = self._direction(here)
        return (B - A) @ n, (v_2 - v_1) @ n

    def _ends(self, here: ForceTrial) -> tuple[Vector, Vector]:
        first, second = (here.vector(here.place(point)[1]) for point in self.points)
        return first, second

    def _direction(self, here: ForceTrial) -> Vector:
        """Direction of the pull on the first end, a unit vector; 0 for a spring whose ends coincide."""
        if self.along is not None:
            return here.direction(here.directed(self.along))
        A, B = self._ends(here)
        if not any(B - A) and self._is_spring_without_length(here):
            return Vector.ZERO  # it pulls nothing, in no direction
        return here.direction(B - A)

    def _is_spring_without_length(self, here: ForceTrial) -> bool:
        """True if the pull is k l alone, which is smooth where the ends meet."""
        springs = self.stiffness is not None and self.damping is None and self.pull is None
        return springs and bool(self._slack(here) == 0)

    def _slack(self, here: ForceTrial) -> Any:
        if not isinstance(self.slack, str):
            return here.value(self.slack)
        first, second = (here.place(point)[1] for point in self.points)
        apart = Vector(here.at_start(second - first))
        if self.along is not None:
            return apart @ self._direction(here)
        return apart @ here.direction(apart) if any(apart) else 0


# -------- base ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class OwnState:
    """A state of first order that a force brings along, under NAME_name of the force NAME.

    Args:
        unit: in which it is reported.
        start: its value at t = 0, in SI (None: 0).
        about: what it is, in words.
    """

    name: str
    unit: str
    about: str
    start: Expression | None = None


@dataclass(frozen=True, kw_only=True)
class Force(Part):
    """An action on the system; `by_mass` marks one that acts on every particle of a body in proportion to its mass.

    A law gives `loads`, with or without a `potential`: the two ways to its generalized forces.
    `works` is False for a kind that is read and checked but not derived yet. One with states of its own gives their
    rates, in `state_rates`; `name` is that under which the model holds it.
    """

    name: str = field(default="", metadata={MADE: True})
    kind: ClassVar[str]
    works: ClassVar[bool] = True
    by_mass: ClassVar[bool] = False
    one_of: ClassVar[tuple[str, ...]] = ()  # of these fields exactly one is given
    elastic: ClassVar[bool] = False  # a spring
    tight: ClassVar[bool] = False  # one tension along its way
    placeless: ClassVar[bool] = False  # an energy of coordinates, without a point of application
    moving: ClassVar[bool] = False  # it has a kinetic energy, of what moves and is no body

    @property
    def friction(self) -> JointFriction | None:
        """Law of what sticks and slips as a whole along one rate; None of others."""
        return None

    def pushes(self, scene: LoadContext) -> tuple[Push, ...]:
        """Forces and couples for a unit of its friction, whose power is the rate of slipping; () of others."""
        return ()

    @property
    def drawn_at(self) -> tuple[str, str] | None:
        """(its symbol, the body at whose joint that is drawn); None of what has none."""
        return None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of fields that do not fit together; each field alone is checked by its rule."""
        yield from ()

    @property
    def element(self) -> Element | None:
        """The action between two points or two bodies; None for what acts otherwise."""
        return None

    @property
    def flow(self) -> tuple[str, Expression | None] | None:
        """(body, mass that enters it per second, None: what others leave of the rate of its mass); None of others."""
        return None

    @property
    def of_the_start(self) -> bool:
        """True if its law holds the length, or angle, that it has where the motion starts."""
        return self.element is not None and self.element.slack == "start"

    @property
    def slack_at_start(self) -> bool:
        """True if it pulls and pushes nothing at that length."""
        return self.of_the_start

    @property
    def own_states(self) -> tuple[OwnState, ...]:
        """The states of first order that the force brings along."""
        return ()

    def state_rates(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """z' of its own states, in q, u, z, inputs and t [their units in SI per second]."""
        return ()

    def rates(self, here: ForceTrial) -> tuple[Any, ...]:
        """The second way to its `state_rates`, in numbers."""
        return ()

    @property
    def uniform(self) -> tuple[Expression, ...] | None:
        """An acceleration that every mass of the model feels, ground axes [m/s^2]; None of others."""
        return None

    @property
    def pushed_points(self) -> tuple[str, ...]:
        """Points at which it pushes, by name; () of what pushes elsewhere."""
        return () if self.element is None else self.element.points

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        """Its actions at a state in numbers, as its fields declare them: the proof uses them instead of `loads`."""
        yield from () if self.element is None else self.element.acts(here)

    def pulled(self, here: ForceTrial) -> Any:
        """The second way to its `effort`, in numbers; None of what has none."""
        return None if self.element is None else self.element.law(here)[0]

    @property
    def kinetic(self) -> Expression | None:
        """T [J] of what moves and is no body; None of a force that has none."""
        return None

    def kinetic_energy(self, scene: LoadContext) -> Scalar | None:
        """T [J] of what moves and is no body, over the motion; None of a force that has none."""
        return None if self.kinetic is None else scene.value(self.kinetic)

    def fluid(self, scene: LoadContext) -> Fluid | None:
        """The fluid that moves with its body; None of a force that has none."""
        return None

    def misplaced(self, scene: LoadContext) -> tuple[str, str]:
        """(what is probably a mistake at the start, its fix); ("", "") where nothing is."""
        return "", ""

    def strands_at(self, scene: LoadContext) -> tuple[Any, ...]:
        """The straight pieces of what pulls along its way; () of others."""
        return ()

    def effort(self, scene: LoadContext) -> Scalar | None:
        """Attraction of its two points [N], or couple on its (second) body [N m]; None of others."""
        return None

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """Forces and couples on bodies, and forces along coordinates."""
        return ()

    def spread(self, scene: LoadContext) -> tuple[SpreadLoad, ...]:
        """Loads distributed along lines, of which `loads` gives the resultants."""
        return ()

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V [J], or None where the force has none."""
        return None


def of_a_body(path: DocumentPath, point: Any) -> Iterator[Diagnostic]:
    """Diagnostics of a point of the ground where one of a body is needed."""
    if isinstance(point, str) and not owner_of(point):
        what = f"'{path[1]}' acts at '{point}', which is no point of a body"
        yield Diagnostic((*path, "point"), what, 'name a point of the body: point = "hull.center"')
