"""Tyres that slip: linear, by the magic formula or as a brush, ahead and aside together, with or without relaxation."""

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, owner_of
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import MOTION, FormulaRule, VectorRule
from eomgen.model.forces.base import AXES, Act, Force, ForceTrial, OwnState, of_a_body
from eomgen.model.forces.load import Couple, Load, LoadContext, PointForce
from eomgen.model.kinds import Direction, Length, Radius, SpaceDirection, VectorFormula
from eomgen.model.kinds import PointName as ContactName
from eomgen.model.part import Part, PartRule
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Scalar, Vector, as_expression, function, over, sqrt

SlipStiffness = Annotated[Expression, FormulaRule("N", "nonnegative", MOTION)]
SlipFactor = Annotated[Expression, FormulaRule("1", "", MOTION)]
Heading = Annotated[VectorFormula, VectorRule(FormulaRule("1", "", MOTION))]
PeakForce = Annotated[Expression, FormulaRule("N", "", MOTION)]
RollingSpeed = Annotated[Expression, FormulaRule("m/s", "", MOTION)]
GripForce = Annotated[Expression, FormulaRule("N", "positive", MOTION)]
SmoothSpeed = Annotated[Expression, FormulaRule("m/s", "positive")]
LeastSlip = Annotated[Expression, FormulaRule("1", "positive")]


@dataclass(frozen=True, kw_only=True)
class TyreLaw(Part):
    """The force of a slip s: c s; with a grip c s (1 - x + x^2/3); or D sin(C atan(B s - E (B s - atan(B s)))).

    x = c |s|/(3 mu F_z), and from x = 1 on all of the tread slides with mu F_z: a brush, its pressure a parabola.

    Args:
        stiffness: c [N]; it may hold the load.
        grip: mu F_z, the largest force of a brush [N].
        B, C, E: of the magic formula (E left out: 0).
        D: of it, the largest force [N].
        relaxation: the way after which a slip has come to 63 % (None: at once) [m].
    """

    title: ClassVar[str] = "law of a tyre"
    stiffness: SlipStiffness | None = None
    grip: GripForce | None = None
    B: SlipFactor | None = None
    C: SlipFactor | None = None
    D: PeakForce | None = None
    E: SlipFactor | None = None
    relaxation: Length | None = None

    def force(self, s: Scalar, value: Any, of: Any) -> Scalar:
        """f(s) [N]; `of` gives the value of a function by its name."""
        found: Scalar
        if self.stiffness is not None:
            c = value(self.stiffness)
            if self.grip is None:
                found = c * s
                return found
            slides = over(3 * value(self.grip), c)
            held = of("min", of("max", s, -slides), slides)
            x = over(of("abs", held), slides)
            found = c * held * (1 - x + over(x * x, 3))
            return found
        x = value(self.B) * s
        found = value(self.D) * of("sin", value(self.C) * of("atan", x - value(self.E) * (x - of("atan", x))))
        return found


Law = Annotated[TyreLaw, PartRule(TyreLaw)]


@dataclass(frozen=True)
class Rolling:
    """The contact of a wheel: its directions and velocities, over any scalar.

    Args:
        ahead, left: unit vectors along the ground, ground axes.
        arm: from the point to the contact, ground axes [m].
        travel: velocity of the point ahead [m/s].
        drift: velocity of the contact to the left [m/s].
        spin: velocity by which the tread runs faster backwards than the wheel goes ahead [m/s]; None: not known.
    """

    ahead: Vector
    left: Vector
    arm: Vector
    travel: Any
    drift: Any
    spin: Any


@dataclass(frozen=True, kw_only=True)
class Tyre(Force):
    """A tyre on the ground: the forces of its slip, to the side by tan alpha = v_y/|v_x|, ahead by kappa.

    v_x and v_y are the velocity of the wheel ahead and to the left, and the force to the left is - f(alpha), the one
    ahead f(kappa), kappa = (r omega - v_x)/|v_x|: both by laws of their own. With a `relaxation` l the slips are states
    of the model, NAME_slip and NAME_kappa of the tyre NAME: l s' + |v_x| s = v_y, and the same of kappa with
    r omega - v_x. With `combined` both slips share one friction (similarity): with s^2 = kappa^2 + tan^2 alpha + s_0^2
    the force is f(s) kappa/s ahead and - f(s) tan alpha/s to the left, each by its own law or both by the one that is
    given: against the velocity of the tread where the laws are alike, in an ellipse where their largest forces differ.

    The wheel is a body that spins, with its `axle` and `radius`, or its place on a body that does not,
    with a `heading`: in the plane seen from above.

    Args:
        point: the centre of a wheel with a `radius`, else the place of contact on the body that carries it.
        lateral: the law of the force to the side, of the angle alpha [rad].
        longitudinal: the law of the force ahead, of kappa.
        combined: s_0, a slip below which the law of both together is nearly linear; both are laws of s then (None: each
            force by its own slip alone).
        heading: of a wheel without a radius, in the axes of the body, 2 or 3 (None: its x axis); a
            steered one is ["cos(delta)", "sin(delta)"].
        rolling: r omega of it, given, where it has a longitudinal law [m/s].
        radius: r of a wheel that is a body [m].
        axle: in space, the axis about which it turns when it goes ahead, in its axes (None: its y axis).
        up: the normal of the ground (None: z, in the plane y of a wheel with a radius).
        smooth: v, where |v_x| is sqrt(v_x^2 + v^2): a tyre that comes to rest [m/s].
    """

    kind: ClassVar[str] = "tyre"
    point: ContactName
    lateral: Law | None = None
    longitudinal: Law | None = None
    combined: LeastSlip | None = None
    heading: Heading | None = None
    rolling: RollingSpeed | None = None
    radius: Radius | None = None
    axle: SpaceDirection | None = None
    up: Direction | None = None
    smooth: SmoothSpeed | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a tyre without a law, of laws that are none, of fields for the other way to say the wheel."""
        yield from of_a_body(path, self.point)
        for key in ("lateral", "longitudinal"):
            yield from _of_law((*path, key), getattr(self, key))
        broken = any((*path, key) in catalog.broken for key in ("lateral", "longitudinal"))
        if self.lateral is None and self.longitudinal is None and not broken:
            yield Diagnostic(path, f"the tyre '{path[1]}' has no law", "give 'lateral', 'longitudinal' or both")
        spins = self.radius is not None
        for key in ("heading", "rolling") if spins else ("axle",):
            if getattr(self, key) is not None:
                has = "a radius" if spins else "no radius"
                yield Diagnostic((*path, key), f"'{path[1]}' has {has}, and '{key}'", "leave one of them out", key=True)
        if (
            not spins
            and (self.longitudinal is not None or self.combined is not None)
            and self.rolling is None
            and (*path, "rolling") not in catalog.broken
        ):
            what = f"how fast the wheel of '{path[1]}' rolls is not known"
            yield Diagnostic(path, what, "give 'rolling' [m/s], or the 'radius' of a wheel that is a body")
        if not spins and self.up is not None and catalog.model.space == "plane":
            what = f"'{path[1]}' without a radius is seen from above"
            yield Diagnostic((*path, "up"), what, "leave 'up' out", key=True)

    @property
    def pushed_points(self) -> tuple[str, ...]:
        return (self.point,)

    # -- states ----------------------------------------------------------------------------------------------

    @property
    def own_states(self) -> tuple[OwnState, ...]:
        relaxes = [law is not None and law.relaxation is not None for law in self._laws]
        known = (OwnState("slip", "1", "lateral slip"), OwnState("kappa", "1", "longitudinal slip"))
        return tuple(state for state, own in zip(known, relaxes, strict=True) if own)

    def state_rates(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """(v_y - |v_x| s)/l, (r omega - v_x - |v_x| kappa)/l"""
        return self._relaxed(self._contact(scene), scene.value, lambda x: sqrt(x))

    def rates(self, here: ForceTrial) -> tuple[Any, ...]:
        return self._relaxed(self._rolls(here), here.value, lambda x: here.function("sqrt", x))

    def _relaxed(self, wheel: Rolling, value: Any, root: Any) -> tuple[Any, ...]:
        given = zip(self._laws, ("slip", "kappa"), (wheel.drift, wheel.spin), strict=True)
        rows = ((law, self._state(name, value), fed) for law, name, fed in given if law is not None and law.relaxation)
        speed = self._speed(wheel, value, root)
        return tuple(over(fed - speed * s, value(law.relaxation)) for law, s, fed in rows)

    @property
    def _laws(self) -> tuple[TyreLaw | None, TyreLaw | None]:
        """The laws to the side and ahead; of combined slip the one that is given stands for both."""
        if self.combined is None:
            return self.lateral, self.longitudinal
        return self.lateral or self.longitudinal, self.longitudinal or self.lateral

    def _state(self, name: str, value: Any) -> Any:
        return value(as_expression(f"{self.name}_{name}"))

    def _speed(self, wheel: Rolling, value: Any, root: Any) -> Any:
        """|v_x|"""
        if self.smooth is None:
            return root(wheel.travel * wheel.travel)
        v = value(self.smooth)
        return root(wheel.travel * wheel.travel + v * v)

    # -- force -----------------------------------------------------------------------------------------------

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """- f(alpha) to the left, f(kappa) ahead, at the contact."""
        wheel = self._contact(scene)
        speed = self._speed(wheel, scene.value, lambda x: sqrt(x))
        slips = [
            None if law is None else over(fed, speed) if law.relaxation is None else self._state(name, scene.value)
            for law, name, fed in zip(self._laws, ("slip", "kappa"), (wheel.drift, wheel.spin), strict=True)
        ]
        F = self._together(wheel, slips, scene) if self.combined is not None else self._apart(wheel, slips, scene)
        place = scene.place(self.point)
        if self.radius is None:
            return (PointForce(place, F),)
        return (PointForce(place, F), Couple(owner_of(self.point), wheel.arm.cross(F), place=place))

    def _apart(self, wheel: Rolling, slips: Sequence[Any], scene: LoadContext) -> Vector:
        """The force of each slip by itself."""
        (tan_alpha, kappa), F = slips, Vector.ZERO
        if self.lateral is not None:
            F = F - self.lateral.force(function("atan", tan_alpha), scene.value, function) * wheel.left
        if self.longitudinal is not None:
            F = F + self.longitudinal.force(kappa, scene.value, function) * wheel.ahead
        return F

    def _together(self, wheel: Rolling, slips: Sequence[Any], scene: LoadContext) -> Vector:
        """f(s) (kappa, - tan alpha)/s"""
        (tan_alpha, kappa), least = slips, scene.value(self.combined)
        s = sqrt(kappa * kappa + tan_alpha * tan_alpha + least * least)
        lateral, ahead = (law.force(s, scene.value, function) for law in self._laws if law is not None)
        F: Vector = over(ahead * kappa, s) * wheel.ahead - over(lateral * tan_alpha, s) * wheel.left
        return F

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        """The same in numbers, by the twist of the wheel; of combined slip along the slip as a vector."""
        wheel = self._rolls(here)
        speed = self._speed(wheel, here.value, lambda x: here.function("sqrt", x))
        push, slipping = Vector.ZERO, Vector.ZERO
        if (law := self._laws[0]) is not None:
            slip = wheel.drift / speed if law.relaxation is None else self._state("slip", here.value)
            slipping = slipping - slip * wheel.left
            if self.combined is None:
                push = push - law.force(here.function("atan", slip), here.value, here.function) * wheel.left
        if (law := self._laws[1]) is not None:
            kappa = wheel.spin / speed if law.relaxation is None else self._state("kappa", here.value)
            slipping = slipping + kappa * wheel.ahead
            if self.combined is None:
                push = push + law.force(kappa, here.value, here.function) * wheel.ahead
        if self.combined is not None:
            size = here.function("sqrt", slipping @ slipping + here.value(self.combined) ** 2)
            for law, axis in zip(self._laws, (wheel.left, wheel.ahead), strict=True):
                if law is not None:
                    push = push + law.force(size, here.value, here.function) / size * (slipping @ axis) * axis
        yield Act(*here.place(self.point), push, wheel.arm.cross(push))

    # -- contact ---------------------------------------------------------------------------------------------

    def _contact(self, scene: LoadContext) -> Rolling:
        """Directions and velocities by the rates of the place and the axes."""
        body, place = owner_of(self.point), scene.place(self.point)
        R, v = scene.orientation(body), scene.velocity(place)
        if self.radius is None:
            ahead = R @ (Vector((1, 0, 0)) if self.heading is None else scene.vector(self.heading))
            up = Vector((0, 0, 1)) if self.up is None else _unit(scene.vector(self.up))
            ahead = _unit(ahead - (ahead @ up) * up)
            left = up.cross(ahead)
            travel = v @ ahead
            spin = None if self.rolling is None else scene.value(self.rolling) - travel
            return Rolling(ahead, left, Vector.ZERO, travel, v @ left, spin)
        axle = R @ _unit(self._axle(scene))
        up = scene.vector(self.up) if self.up is not None else Vector((0, 1, 0) if scene.plane else (0, 0, 1))
        ahead = _unit(axle.cross(up))
        arm = -scene.value(self.radius) * ahead.cross(axle)
        treads = v + (R @ scene.spin(body)).cross(arm)
        left = _unit(up).cross(ahead)
        return Rolling(ahead, left, arm, v @ ahead, treads @ left, -(treads @ ahead))

    def _axle(self, scene: LoadContext) -> Vector:
        if scene.plane:
            return Vector((0, 0, -1))
        return Vector((0, 1, 0)) if self.axle is None else scene.vector(self.axle)

    def _rolls(self, here: ForceTrial) -> Rolling:
        """The same in numbers, by the twist."""
        body, v = owner_of(self.point), here.velocity_of(self.point)
        axes = [here.directed(axis, body) for axis in AXES]
        flat = here.plane and self.radius is not None
        up = here.direction(here.directed(self.up or AXES[1 if flat else 2]))
        if self.radius is None:
            nose = axes[0] if self.heading is None else here.directed(self.heading, body)
            left = here.direction(up.cross(nose))
            ahead = left.cross(up)
            rolls = None if self.rolling is None else here.value(self.rolling) - v @ ahead
            return Rolling(ahead, left, Vector.ZERO, v @ ahead, v @ left, rolls)
        axle = (
            -1 * axes[2] if flat else here.direction(axes[1] if self.axle is None else here.directed(self.axle, body))
        )
        ahead = here.direction(axle.cross(up))
        down = here.direction(axle.cross(ahead))
        arm = here.value(self.radius) * down
        turn = here.vector(here.in_stream(self.point, None)[1])
        tread = v + sum((w * e for w, e in zip(turn, axes, strict=True)), start=Vector.ZERO).cross(arm)
        left = up.cross(ahead)
        return Rolling(ahead, left, arm, v @ ahead, tread @ left, -(tread @ ahead))


def _unit(v: Vector) -> Vector:
    """v over its length."""
    size = sqrt(v @ v)
    return Vector(over(x, size) for x in v)


def _of_law(path: DocumentPath, law: TyreLaw | None) -> Iterator[Diagnostic]:
    """Diagnostics of a law that is both, or neither, and of a grip without a stiffness."""
    if law is None:
        return
    magic = [key for key in "BCDE" if getattr(law, key) is not None]
    if law.stiffness is not None and magic:
        yield Diagnostic((*path, magic[0]), "a stiffness and a magic formula", "leave one of them out", key=True)
    elif law.stiffness is None and not {*"BCD"} <= {*magic}:
        yield Diagnostic(path, "the law of a tyre has a stiffness, or B, C and D", "give 'stiffness', or these three")
    elif law.stiffness is None and law.grip is not None:
        yield Diagnostic((*path, "grip"), "a grip without a stiffness", "leave it out: D is the grip", key=True)
