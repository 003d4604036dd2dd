"""Brakes, clutches and belts: dry friction between what turns or slides, which slips or sticks."""

from collections.abc import Iterator
from math import prod
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import MOTION, FormulaRule, ListRule
from eomgen.model.forces.base import Act, Force, ForceTrial
from eomgen.model.forces.load import Couple, Load, LoadContext, PointForce, Push
from eomgen.model.kinds import (
    BodyName,
    Flag,
    ForceSize,
    Friction,
    JointFriction,
    Length,
    Opening,
    PushFriction,
    SlidingSpeed,
    SpaceDirection,
    TorqueOrCoefficient,
    TorqueSize,
    TurnFriction,
    TurningSpeed,
    TwoBodies,
    Wrap,
)
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Fraction, Vector, as_expression

Faces = Annotated[Expression, FormulaRule("1", "positive")]
AnySpeed = Annotated[Expression, FormulaRule(None, "positive")]
Radii = Annotated[tuple[Expression, ...], ListRule(FormulaRule("m", "positive"), 2, 2)]
AnySizeOrCoefficient = Annotated[
    Expression, FormulaRule(None, "nonnegative", like=("torque", "force", "coefficient"), scope=MOTION)
]

# -------- dry forces ------------------------------------------------------------------------------------------
# Dry friction along a rate v of slipping, to which a unit of friction is dual: - F sign(v) while it slips, and at rest
# what holds, up to the largest. It is the friction of joints between any two things.


@dataclass(frozen=True, kw_only=True)
class DryForce(Force):
    """Dry friction of a given size along the rate that is dual to its pushes."""

    sized: ClassVar[tuple[str, ...]] = ()  # fields that give its size whole, of which one may be given
    parts: ClassVar[tuple[str, ...]] = ()  # fields that give it together instead
    static: Any = None
    smooth: Any = None

    @property
    def friction(self) -> JointFriction:
        """Its law."""
        raise NotImplementedError

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a size that is given twice, or not wholly, and of a name that another friction has."""
        name = str(path[1])
        given = [key for key in (*self.sized, *self.parts) if getattr(self, key) is not None]
        whole = [key for key in self.sized if key in given]
        for key in given:
            if whole and key != whole[0]:
                what = f"the {self.kind} '{name}' has '{whole[0]}' and '{key}'"
                yield Diagnostic((*path, key), what, "leave one of them out", key=True)
        missing = [key for key in ("normal", "coefficient") if key in self.parts and key not in given]
        if not whole and missing and not any((*path, key) in catalog.broken for key in (*self.sized, *self.parts)):
            what = f"the size of the {self.kind} '{name}' is not known: it needs '{missing[0]}'"
            yield Diagnostic(path, what, f"give {' or '.join(map(repr, self.sized))}, or all of mu N r")
        elif self.static is not None and self.smooth is not None:
            what = "smooth friction has no 'static': it never rests"
            yield Diagnostic((*path, "static"), what, "leave out one of the two", key=True)
        bodies: tuple[str, ...] = getattr(self, "bodies", None) or ()
        if len(bodies) == 2 and bodies[0] == bodies[1]:
            what = f"'{name}' rubs body '{bodies[0]}' on itself"
            yield Diagnostic((*path, "bodies", 1), what, "name two bodies")
        if name in catalog.table("bodies") or name in catalog.table("constraints"):
            what = f"'{name}' is the name of a body or a constraint too, and both may stick"
            yield Diagnostic(path, what, "give it another name")

    def pushes(self, scene: LoadContext) -> tuple[Push, ...]:
        """Forces and couples for a unit of friction; their power is the rate of slipping."""
        raise NotImplementedError

    def most(self, here: ForceTrial) -> Any:
        """Size while it slips, in numbers, by the fields that give it."""
        for key in self.sized:
            if getattr(self, key) is not None:
                return here.value(getattr(self, key))
        return prod(here.value(getattr(self, key)) for key in self.parts if getattr(self, key) is not None)


def _product(*factors: Expression | None) -> Expression:
    """mu*N*r*n of what is given; 0 of nothing."""
    return as_expression("*".join(f"({x.text})" for x in factors if x is not None) or 0)


# -------- clutch ----------------------------------------------------------------------------------------------
# Clutch: between two bodies that turn.


@dataclass(frozen=True, kw_only=True)
class Clutch(DryForce):
    """A clutch between two bodies that turn: slipping it transmits M, sticking it locks them, up to the largest M.

    M = n mu N r on the second body against its slip w = omega_2 - omega_1, the opposite on the first. It may be a
    formula of t, of inputs and of the motion; where that falls below 0 it is 0.

    Args:
        bodies: the two; in space w is about the axis of the joint of the second.
        torque: M while it slips [N m].
        normal: N that presses it together, with `coefficient` and `radius` in place of `torque` [N].
        coefficient: mu.
        radius: r at which friction acts, of worn discs the mean radius [m].
        faces: n of them that rub (None: 1).
        static: the largest at rest, a torque or a coefficient as the other (None: the same).
        smooth: w_0 of - M tanh(w/w_0), which creeps; None: it sticks and slips [rad/s].
    """

    kind: ClassVar[str] = "clutch"
    sized: ClassVar[tuple[str, ...]] = ("torque",)
    parts: ClassVar[tuple[str, ...]] = ("normal", "coefficient", "radius", "faces")
    bodies: TwoBodies
    torque: TorqueSize | None = None
    normal: ForceSize | None = None
    coefficient: Friction | None = None
    radius: Length | None = None
    faces: Faces | None = None
    static: TorqueOrCoefficient | None = None
    smooth: TurningSpeed | None = None

    @property
    def friction(self) -> JointFriction:
        if self.torque is not None:
            return TurnFriction(torque=self.torque, static=self.static, smooth=self.smooth)
        others = (self.normal, self.radius, self.faces)
        static = None if self.static is None else _product(self.static, *others)
        return TurnFriction(torque=_product(self.coefficient, *others), static=static, smooth=self.smooth)

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        yield from DryForce.diagnostics(self, path, catalog)
        if self.normal is not None and self.radius is None:
            yield Diagnostic(path, f"the clutch '{path[1]}' needs 'radius'", "at which friction acts: M = mu N r")

    @property
    def drawn_at(self) -> tuple[str, str]:
        return "plates", self.bodies[1]

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        first, second = self.bodies
        n = here.axis(second)
        couple = here.rubs(self, self.most(here), n @ (here.spin(second) - here.spin(first))) * n
        yield Act(second, couple=couple)
        yield Act(first, couple=-couple)

    def pushes(self, scene: LoadContext) -> tuple[Push, ...]:
        """A unit couple on the second, its opposite on the first."""
        first, second = self.bodies
        n = Vector((0, 0, 1)) if scene.plane else scene.orientation(second) @ scene.turn_of_joint(second)[1]
        return (Couple(second, n), Couple(first, -n))


# -------- brake -----------------------------------------------------------------------------------------------
# Brake: in the joint of a body, against what carries it.


@dataclass(frozen=True, kw_only=True)
class Brake(DryForce):
    """A brake in the hinge or slide of a body, against what carries it: slipping it takes M, sticking it holds.

    M = n mu N r of a hinge, F = n mu N of a slide, on the body against the rate of its joint, the opposite on what
    carries it. It may be a formula of t, of inputs and of the motion; where that falls below 0 it is 0.

    Args:
        body: whose joint it brakes.
        torque: M of a hinge while it slips [N m].
        force: F of a slide while it slips [N].
        normal: N that presses it together, with `coefficient`, of a hinge `radius`, in place of these [N].
        coefficient: mu.
        radius: r of a hinge, at which friction acts [m].
        faces: n of them that rub (None: 1).
        static: the largest at rest, as the other of the three (None: the same).
        smooth: v of - M tanh(s'/v), which creeps; None: it sticks and slips [rad/s, m/s].
    """

    kind: ClassVar[str] = "brake"
    sized: ClassVar[tuple[str, ...]] = ("torque", "force")
    parts: ClassVar[tuple[str, ...]] = ("normal", "coefficient", "radius", "faces")
    body: BodyName
    torque: TorqueSize | None = None
    force: ForceSize | None = None
    normal: ForceSize | None = None
    coefficient: Friction | None = None
    radius: Length | None = None
    faces: Faces | None = None
    static: AnySizeOrCoefficient | None = None
    smooth: AnySpeed | None = None

    @property
    def friction(self) -> JointFriction:
        given = self.torque if self.force is None else self.force
        size, static = given, self.static
        if size is None:
            others = (self.normal, self.radius, self.faces)
            size = _product(self.coefficient, *others)
            static = None if static is None else _product(static, *others)
        if self.torque is not None or (self.force is None and self.radius is not None):
            return TurnFriction(torque=size, static=static, smooth=self.smooth)
        return PushFriction(force=size, static=static, smooth=self.smooth)

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics beyond its size: of a joint that has no single rate, or one of another kind."""
        yield from DryForce.diagnostics(self, path, catalog)
        body = catalog.table("bodies").get(self.body)
        joint = None if body is None else body.joint
        if body is None or (joint is not None and joint.kind not in ("revolute", "screw", "prismatic")):
            if body is not None:
                what = f"the joint of '{self.body}' has no single rate that '{path[1]}' could brake"
                yield Diagnostic((*path, "body"), what, "a hinge, a slide or a screw; or a clutch between two bodies")
            return
        if joint is None:
            yield Diagnostic((*path, "body"), f"'{self.body}' has no joint that '{path[1]}' could brake")
            return
        others = [name for name, part in catalog.table("forces").items() if isinstance(part, Brake)]
        others = [name for name in others if catalog.table("forces")[name].body == self.body and name < str(path[1])]
        rubs = any(law.smooth is None for _, _, law in joint.frictions)
        if self.smooth is None and (rubs or others):
            other = f"the brake '{others[0]}'" if others else "the friction of the joint"
            what = f"'{path[1]}' and {other} hold '{self.body}' together, and at rest nobody knows how they share"
            yield Diagnostic(path, what, 'write one with both sizes: torque = "T + mu*N*r"')
        if self.torque is None and self.force is None and (self.normal is None or self.coefficient is None):
            return
        turns, amount = joint.kind != "prismatic", self.friction.amount
        if turns != (amount == "torque"):
            fix = "give 'torque', or 'normal', 'coefficient' and 'radius'" if turns else "give 'force', and no 'radius'"
            what = f"'{path[1]}' brakes a {'turn' if turns else 'slide'}, and its size is a {amount}"
            yield Diagnostic(path, what, fix)

    @property
    def drawn_at(self) -> tuple[str, str]:
        return "shoes", self.body

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        rate, units = here.in_joint(self.body)
        yield from (unit.times(here.rubs(self, self.most(here), rate)) for unit in units)

    def pushes(self, scene: LoadContext) -> tuple[Push, ...]:
        """A unit of what acts along the joint on the body, its opposite on what carries it."""
        _, force, couple, own, parent, _ = scene.along_joint(self.body, 0)
        if self.friction.amount == "torque":
            on_parent = () if parent[0] is None else (Couple(parent[0], -couple, place=parent),)
            return (Couple(self.body, couple, place=own), *on_parent)
        return (PointForce(own, force), PointForce(parent, -force))


# -------- belt ------------------------------------------------------------------------------------------------
# Belt: between two pulleys, which slips.


@dataclass(frozen=True, kw_only=True)
class Belt(DryForce):
    """A belt about two pulleys: it sticks, r_1 omega_1 = r_2 omega_2, up to the pull that friction on an arc holds.

    Tensions T_0 + F/2 and T_0 - F/2 of its strands: with T_1 <= T_2 e^(mu phi) the pull F from the first pulley to the
    second is at most 2 T_0 tanh(mu phi/2) = 2 T_0 (e^(mu phi) - 1)/(e^(mu phi) + 1). The belt has no mass.

    Args:
        bodies: the pulleys, round about their origins.
        radii: r_1, r_2 [m].
        tension: T_0, the mean of both strands, which may change in the motion [N].
        coefficient: mu; of a V-belt of the angle beta mu/sin(beta/2).
        wrap: phi, the smaller of the two arcs on which it lies [rad].
        crossed: the pulleys turn against one another.
        axis: in space, of both pulleys, in their own axes (None: z).
        static: mu at rest (None: the same).
        smooth: v of - F tanh(slip/v), which creeps; None: it sticks and slips [m/s].
    """

    kind: ClassVar[str] = "belt"
    bodies: TwoBodies
    radii: Radii
    tension: ForceSize
    coefficient: Friction
    wrap: Opening
    crossed: Flag = False
    axis: SpaceDirection | None = None
    static: Friction | None = None
    smooth: SlidingSpeed | None = None

    @property
    def friction(self) -> JointFriction:
        static = None if self.static is None else self._largest(self.static)
        return PushFriction(force=self._largest(self.coefficient), static=static, smooth=self.smooth)

    def _largest(self, mu: Expression) -> Expression:
        """2 T_0 tanh(mu phi/2)"""
        return as_expression(f"2*({self.tension.text})*tanh(({mu.text})*({self.wrap.text})/2)")

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        to, back = (here.rope(way, "start") for way in self._ways)
        T, ratio = here.value(self.tension), here.function("exp", here.value(self.coefficient) * here.value(self.wrap))
        F = here.rubs(self, 2 * T * (ratio - 1) / (ratio + 1), (back.rate - to.rate) / 2)
        yield from to.pulled(T + F / 2)
        yield from back.pulled(T - F / 2)

    @property
    def _ways(self) -> tuple[tuple[Wrap, ...], ...]:
        """Ways from the first pulley to the second, and back."""
        (first, second), (r_1, r_2) = self.bodies, self.radii
        one = Wrap(body=first, radius=r_1, turn="cw", axis=self.axis)
        other = Wrap(body=second, radius=r_2, turn="ccw" if self.crossed else "cw", axis=self.axis)
        return (one, other), (other, one)

    def strands_at(self, scene: LoadContext) -> tuple[Any, ...]:
        return tuple(strand for way in self._ways for strand in scene.strands(way))

    def pushes(self, scene: LoadContext) -> tuple[Push, ...]:
        """Half a unit of tension more in the strand to the second pulley, half a unit less in the other."""
        to, back = self.strands_at(scene)
        half = Fraction(1, 2)
        return (*(push.times(half) for push in to.pulls), *(push.times(-half) for push in back.pulls))

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """T_0 along both strands."""
        T = scene.value(self.tension)
        return tuple(push.times(T) for strand in self.strands_at(scene) for push in strand.pulls)
