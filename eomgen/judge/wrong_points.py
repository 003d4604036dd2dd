"""Contributions -> what they change by where a mass, an inertia or a force is taken at another point of its body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from eomgen.judge.contributions import FEW, Contribution, Contributions
from eomgen.judge.corruption import PLACED, SHARED, SHORTER
from eomgen.judge.terms import LONG, term_text
from eomgen.mechanics.bodies.inertia import HALF, BodyEnergy, body_energies, mass_properties
from eomgen.mechanics.bodies.kinematics import velocity_of
from eomgen.mechanics.bodies.scope import Scope
from eomgen.mechanics.equations.work import load_row
from eomgen.model.forces.load import BodyPoint, PointForce
from eomgen.model.shapes.base import MassProperties
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import legible
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector, apply, cross, dot, minus, plus, transposed, vector_of
from eomgen.symbolic.numeric.work import Work

SHAPES = (  # I / (m r^2)
    (Fraction(1), "a thin hoop"),
    (Fraction(1, 2), "a disc"),
    (Fraction(2, 5), "a solid ball"),
    (Fraction(2, 3), "a thin shell"),
    (Fraction(1, 4), "a disc about a diameter"),
    (Fraction(1, 3), "a rod about its end"),
    (Fraction(1, 12), "a rod about its middle"),
)


def other_shapes(scope: Scope, body: str) -> Iterator[tuple[Fraction, str]]:
    """How many times the moment of inertia of a body is that of another shape with its mass and size, in the plane."""
    own = _coefficient(scope, body)
    rod = scope.model.bodies[body].shape is not None and getattr(scope.model.bodies[body].shape, "kind", "") == "rod"
    for coefficient, what in SHAPES if own is not None else ():
        share, length = own  # type: ignore[misc]
        if coefficient != share and rod == what.startswith("a rod"):
            mass = mass_properties(scope, body).m
            taken, true = (term_text(c * mass * length * length) for c in (coefficient, share))
            text = f"in the rotation of {body} the moment of inertia is that of {what}, {taken}, where it is {true}"
            yield coefficient / share, text


def _coefficient(scope: Scope, body: str) -> tuple[Fraction, Scalar] | None:
    """(c, r) of I = c m r^2; None where it is not that."""
    if scope.model.space != "plane":
        return None
    shape, mass = scope.model.bodies[body].shape, mass_properties(scope, body)
    sizes = [scope.value(x) for x in vars(shape).values() if isinstance(x, Expression)] if shape else []
    inertia = mass.I[2][2]
    for r in (*sizes, *(x for x in symbols_of((inertia,)) if x is not mass.m)):
        ratio = legible(over(inertia, mass.m * r * r), Work.FORMULA, scope.positive, LONG)
        if type(ratio) is not Node and not is_zero(ratio):
            return Fraction(ratio), r
    return None


@dataclass(frozen=True)
class Altered:
    """What a contribution changes by through a mistake.

    Args:
        name: what it concerns.
        kind: of the cause.
        text: the sentence.
        part: by what energies and forces change, with the body and the force that it is about.
        rank: how readily it is believed.
    """

    name: str
    kind: str
    text: str
    part: Contribution
    rank: float


def changes_of_places(parts: Contributions, whole: Sequence[Contribution]) -> Iterator[Altered]:
    """Every body's mass, inertia and forces at its other points."""
    motion = parts.operator.base.motion
    for link, energy in zip(motion.links, body_energies(motion), strict=True):
        mass = mass_properties(motion.scope, link.name)
        if not is_zero(mass.m):
            mine = tuple(part for part in whole if part.body == link.name)
            yield from _Places(parts, link.name, mass, energy, mine).changes()


@dataclass(frozen=True)
class _Places:
    """The points of one body."""

    parts: Contributions
    body: str
    mass: MassProperties
    energy: BodyEnergy
    mine: tuple[Contribution, ...]

    def changes(self) -> Iterator[Altered]:
        places = self._others()
        if not is_zero(self.energy.rotation):
            yield from self._other_shapes()
        translation = next((part.T for part in self.mine if part.kind == "translation"), None)
        if self.body not in self.parts.operator.base.motion.index:
            translation = None
        for point, r in places.items():
            if any(not is_zero(x) for x in self.energy.spin):
                yield from self._inertia(point, r)
            if translation is not None:
                yield from self._mass(f"its {point}", r, translation)
        if translation is not None and any(not is_zero(x) for x in self.mass.com):
            for factor, how in ((2, "twice"), (HALF, "half")):
                T = self._moving(r := vector_of(factor * x for x in self.mass.com)) - translation
                T = T + (factor * factor - 1) * self.energy.rotation
                text = f"{self.body} is treated as if it were {how} as long"
                yield self._change(f"the length of {self.body}", text, T, self._raised(r), SHARED)
        for part in self.mine:
            yield from self._other_place(part, places)
        yield from self._relative()

    def _relative(self) -> Iterator[Altered]:
        """The motion relative to the body on which this one hangs, in the place of its own."""
        motion = self.parts.operator.base.motion
        link = motion.link(self.body) if self.body in motion.index else None
        if link is None or link.parent < 0:
            return
        carrier, place = motion.links[link.parent], link.pose.point(self.mass.com)
        turned, arm = transposed(carrier.pose.R), minus(place, carrier.pose.p)
        carried = apply(carrier.pose.R, plus(carrier.twist.v, cross(carrier.twist.w, apply(turned, arm))))
        v = minus(self.energy.velocity, carried)
        w = minus(self.energy.spin, apply(transposed(link.pose.R), apply(carrier.pose.R, carrier.twist.w)))
        translation, rotation = HALF * self.mass.m * dot(v, v), HALF * dot(w, apply(self.mass.I, w))
        held = symbols_of((*carried, *carrier.twist.w))
        rates = [u.name for u in motion.scope.symbols.u if u in held]
        which = f" ({', '.join(rates)})" if 0 < len(rates) <= FEW else ""
        for of, what, T in (
            ("translation", "velocity", translation - self.energy.translation),
            ("rotation", "angular velocity", rotation - self.energy.rotation),
        ):
            text = f"in the {of} of {self.body} what the motion of {carrier.name}{which} does is missing: its {what}"
            text = f"{text} relative to {carrier.name} stands for the absolute one"
            yield Altered(f"the {of} of {self.body}", "missing_term", text, self._part(T), SHARED - SHORTER)

    def _others(self) -> dict[str, Vector]:
        """The points of the body that are not its mass centre, each once."""
        found: dict[str, Vector] = {}
        for name, r in self.parts.operator.base.motion.points[self.body].items():
            if r not in found.values() and any(not is_zero(x - y) for x, y in zip(r, self.mass.com, strict=True)):
                found[name] = r
        return found

    def _change(self, name: str, text: str, T: Scalar, V: Scalar = 0, rank: float = PLACED) -> Altered:
        return Altered(name, "wrong_point", text, Contribution("", self.body, T=T, V=V), rank)

    def _other_shapes(self) -> Iterator[Altered]:
        for ratio, text in other_shapes(self.parts.operator.base.scope, self.body):
            name = f"the moment of inertia of {self.body}"
            yield Altered(name, "factor", text, self._part((ratio - 1) * self.energy.rotation), PLACED)

    def _part(self, T: Scalar) -> Contribution:
        return Contribution("", self.body, T=T)

    def _inertia(self, point: str, r: Vector) -> Iterator[Altered]:
        """Steiner's term too often, or not at all."""
        swept = cross(self.energy.spin, minus(r, self.mass.com))
        T = HALF * self.mass.m * dot(swept, swept)
        name = f"the moment of inertia of {self.body}"
        text = (
            f"{name} about {point} stands where that about its mass centre is needed: what the mass centre does is"
            " counted in the translation already"
        )
        yield self._change(name, text, T)
        yield self._change(
            name, f"{name} about its mass centre stands where that about {point} is needed (Steiner)", -T
        )

    def _mass(self, where: str, r: Vector, translation: Scalar) -> Iterator[Altered]:
        """The mass centre at another point, in the kinetic energy alone and in all."""
        T = self._moving(r) - translation
        if is_zero(T + translation):
            return  # it stands still: nothing of it is left
        if not is_zero(self.energy.rotation):
            text = f"the mass of {self.body} is taken as if all of it were at {where}"
            yield self._change(f"the kinetic energy of {self.body}", text, T - self.energy.rotation)
        point = where.removeprefix("its ")
        text = f"the velocity of {self.body}.{point} stands where that of its mass centre is needed"
        yield self._change(f"the translation of {self.body}", text, T)
        V = self._raised(r)
        if not is_zero(V):
            text = f"{self.body} is treated as if its mass centre were at {where}"
            yield self._change(f"the mass centre of {self.body}", text, T, V)

    def _moving(self, r: Vector) -> Scalar:
        """The kinetic energy of all of the mass at one point."""
        v = velocity_of(self.parts.operator.base.motion, (self.body, r))
        T: Scalar = HALF * self.mass.m * dot(v, v)
        return T

    def _raised(self, r: Vector) -> Scalar:
        """What the potential energy of the weights changes by where they act at another place."""
        return sum((self._lifted(part.load, (self.body, r)) for part in self.mine if part.kind == "weight"), start=0)

    def _lifted(self, load: object, place: BodyPoint) -> Scalar:
        motion = self.parts.operator.base.motion
        if not isinstance(load, PointForce):
            return 0
        return -dot(load.force, minus(motion.position(place), motion.position(load.place)))

    def _other_place(self, part: Contribution, places: Mapping[str, Vector]) -> Iterator[Altered]:
        """A force of the body at another point of it."""
        load, loads = part.load, self.parts.operator.base.loads
        if not isinstance(load, PointForce) or load.place[0] is None:
            return
        for point, r in places.items():
            place = (load.place[0], r)
            changed = Contribution("", part.body, part.force, V=self._lifted(load, place))
            if is_zero(part.V):
                moved = load_row(loads, PointForce(place, load.force))
                row = tuple(x - y for x, y in zip(moved, load_row(loads, load), strict=True))
                changed = Contribution("", part.body, part.force, Q=row)
            text = f"{part.name} acts at {load.place[0]}.{point} in the equation: its lever arm is wrong"
            yield Altered(part.name, "wrong_point", text, changed, PLACED)
