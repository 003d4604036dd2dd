"""System -> what its energies and equations are the sum of, and what is changed by a wrong place.

System -> what its energies and equations are the sum of, each part known by name.

T = sum over the bodies of translation and rotation, V and Q over the forces, weights body by body. Each of them enters
every equation of motion by one and the same operator:

    E_k = d/dt dT/du_k - dT/dq_k + dV/dq_k - Q_k - J^T lam
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.judge.diagnosis import EXCHANGED, ODD, PLACED, SHARED, SHORTER, TERMS
from eomgen.judge.terms import LONG, Edits, angles_in, term_text, turned_angles, wrong_parameters
from eomgen.mechanics.dynamics.formulations import free_rates
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System, drive_row, from_potential, load_row, per_speed
from eomgen.mechanics.kinematics.inertia import (
    HALF,
    BodyEnergy,
    armature_energy,
    body_energies,
    given_energy,
    mass_properties,
)
from eomgen.mechanics.kinematics.loads import Applied
from eomgen.mechanics.kinematics.motion import velocity_of
from eomgen.mechanics.kinematics.symbols import Scope
from eomgen.model.catalog import Catalog
from eomgen.model.dimensions import inferred
from eomgen.model.forces.load import BodyPoint, Couple, Load, PointForce, UniformField
from eomgen.model.shapes.base import MassProperties
from eomgen.symbolic.exact.normal_form import legible
from eomgen.symbolic.expression.derivative import depends_on_any, gradient, jacobian, substituted, symbols_of, tangent
from eomgen.symbolic.expression.dimensions import Dimension
from eomgen.symbolic.expression.formula import Expression, inner, over
from eomgen.symbolic.expression.node import Node, Scalar, ScalarRow, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector, apply, cross, dot, minus, plus, times, transposed, vector_of
from eomgen.symbolic.numeric.work import Work

FEW = 2  # contributions that are named together


@dataclass(frozen=True)
class Contribution:
    """One part of energies and equations.

    Args:
        name: in words: "the rotation of rod".
        body, force: whose it is; "" of others.
        T, V: its share of the energies.
        Q: its generalized forces of what has no potential, one for each speed of the free system.
        kind: "translation", "rotation", "weight", "constant" (a force whose work is that of a potential, which the
            model's V does not hold), "force", "friction" or "constraint".
        load: what acts, and where.
        row: its share of the equations, where it is no energy and no load: friction, constraints.
    """

    name: str
    body: str = ""
    force: str = ""
    T: Scalar = 0
    V: Scalar = 0
    Q: ScalarRow = ()
    kind: str = ""
    load: Load | None = None
    row: ScalarRow | None = None

    @property
    def held(self) -> frozenset[Node]:
        """The symbols in it."""
        acts: Sequence[Scalar] = ()
        if isinstance(self.load, PointForce):
            acts = (*self.load.force, *self.load.place[1])
        elif isinstance(self.load, Couple):
            acts = self.load.couple
        return frozenset(symbols_of((self.T, self.V, *self.Q, *(self.row or ()), *acts)))


@dataclass(frozen=True)
class Operator:
    """Energies and forces -> their share of the equations of motion, over the independent speeds."""

    system: System

    @cached_property
    def base(self) -> System:
        """The system whose speeds are rates."""
        return self.system.free or self.system

    def rows(self, part: Contribution) -> ScalarRow:
        """What it adds to every E_k."""
        if part.row is not None:
            return part.row
        left = [0] * len(self.base.symbols.u) if is_zero(part.T) else [sum(x, start=0) for x in self._inertia(part.T)]
        motion = self.base.motion
        elastic = [0] * len(left) if is_zero(part.V) else from_potential(motion, part.V)
        forces = part.Q or [0] * len(left)
        return self.reduced([a - b - c for a, b, c in zip(left, elastic, forces, strict=True)])

    def inertia(self, T: Scalar) -> tuple[ScalarRow, ScalarRow, ScalarRow]:
        """(what holds accelerations, the rest of d/dt dT/du, -dT/dq) of a kinetic energy."""
        parts = zip(*self._inertia(T), strict=True)
        a, b, c = (self.reduced(part) for part in parts)
        return a, b, c

    def _inertia(self, T: Scalar) -> list[tuple[Scalar, Scalar, Scalar]]:
        scope = self.base.scope
        momenta = gradient(T, scope.symbols.u)
        accelerated = tangent(momenta, dict(zip(scope.symbols.u, scope.symbols.a, strict=True)))
        carried = scope.time_derivative(momenta)
        held = per_speed(self.base.motion, gradient(T, scope.symbols.q))
        return [(a, b, -c) for a, b, c in zip(accelerated, carried, held, strict=True)]

    def reduced(self, row: Sequence[Scalar]) -> ScalarRow:
        """N^T row, the speeds of the free system in terms of those that are left."""
        if self.system.free is None:
            return tuple(row)
        base, scope = self.base, self.system.scope
        rates = free_rates(self.system, base)
        known = dict(zip(base.symbols.u, rates, strict=True))
        known |= dict(zip(base.symbols.a, scope.with_accelerations(rates), strict=True))
        row = substituted(tuple(row), known)
        columns = zip(*jacobian(rates, scope.symbols.u), strict=True)
        return tuple(inner(column, row) for column in columns)

    def energy(self, T: Scalar) -> Scalar:
        """A kinetic energy over the independent speeds."""
        if self.system.free is None:
            return T
        rates = free_rates(self.system, self.base)
        return substituted((T,), dict(zip(self.base.symbols.u, rates, strict=True)))[0]


@dataclass(frozen=True)
class Contributions:
    """All contributions of a system.

    Args:
        system: the system.
        equations: its equations of motion; None where it has none.
    """

    system: System
    equations: EquationsOfMotion | None = field(repr=False, default=None)

    @cached_property
    def operator(self) -> Operator:
        return Operator(self.system)

    @cached_property
    def dimensions(self) -> Mapping[str, Dimension]:
        """Of every name, as far as it is known."""
        return inferred(Catalog(self.system.scope.model, ())).found

    @cached_property
    def edits(self) -> Edits:
        """What may go wrong in formulas of the system."""
        groups: dict[str, set[Node]] = {}
        parameters = self.system.symbols.parameters
        for name, x in parameters.items():
            groups.setdefault(str(self.dimensions.get(name, name)), set()).add(x)
        alike = tuple(frozenset(group) for group in groups.values() if len(group) > 1)
        return Edits(self.system.scope.positive, alike, tuple(parameters.values()))

    @cached_property
    def elementary(self) -> tuple[Contribution, ...]:
        """Bodies' energies and forces, one by one."""
        return (*self._kinetic(), *self._forces(), *self._others())

    def holding(self, x: Scalar, what: str = "") -> tuple[Contribution, ...]:
        """The few contributions of whose constants x is made: those of the one that fewest hold, of all if there are.

        Args:
            what: of those with a share of this energy, "T" or "V"; "" of all.
        """
        symbols = self.system.symbols
        constants = {*symbols.parameters.values(), *symbols.inputs.values()}
        known = [part for part in self.elementary if not what or not is_zero(getattr(part, what))]
        holders = [[part for part in known if y in part.held] for y in symbols_of((x,)) if y in constants]
        few = min(holders, key=len, default=[])
        found = [part for part in few if all(part in some for some in holders)] or few
        return tuple(found) if len(found) <= FEW else ()

    def _kinetic(self) -> list[Contribution]:
        motion, found = self.operator.base.motion, []
        for link, energy in zip(motion.links, body_energies(motion), strict=True):
            rotor = armature_energy(motion, link)
            for kind, T in (("translation", energy.translation), ("rotation", energy.rotation), ("rotor", rotor)):
                if not is_zero(T):
                    name = f"the {kind} of {link.name}"
                    found.append(Contribution(name, link.name, "", T, kind=kind))
        given = given_energy(motion.scope)
        return found if is_zero(given) else [*found, Contribution("the given kinetic energy", T=given, kind="given")]

    def _forces(self) -> list[Contribution]:
        loads, found = self.operator.base.loads, list[Contribution]()
        for force in loads.applied:
            found += self._force(force)
        for effort in loads.efforts:
            where = f"in the joint of {effort.body}"
            name = f"joint of {effort.body}"
            if not is_zero(effort.potential):
                found.append(Contribution(f"the spring {where}", effort.body, name, V=effort.potential, kind="force"))
            if not is_zero(effort.drive):
                Q = drive_row(loads.motion, effort)
                found.append(Contribution(f"the drive or damper {where}", effort.body, name, Q=Q, kind="force"))
        return found

    def _force(self, force: Applied) -> list[Contribution]:
        motion, loads = self.operator.base.motion, self.operator.base.loads
        found = []
        for load in force.loads:
            if isinstance(load, UniformField):
                for link in motion.links:
                    mass = mass_properties(motion.scope, link.name)
                    if not is_zero(mass.m):
                        weight = times(mass.m, load.acceleration)
                        place = (link.name, mass.com)
                        V = -dot(weight, motion.position(place))
                        name = f"the weight of {link.name}"
                        acts = PointForce(place, weight)
                        found.append(Contribution(name, link.name, force.name, V=V, kind="weight", load=acts))
        if found:
            return found
        if force.potential is not None:
            return [
                Contribution(f"the force {force.name}", _body(force.loads), force.name, V=force.potential, kind="force")
            ]
        many = len(force.loads) > 1
        for number, load in enumerate(force.loads, start=1):
            name = f"the force {force.name}" + (f" ({number})" if many else "")
            body = _body((load,))
            if isinstance(load, PointForce) and load.axes is None and not depends_on_any(load.force, self._varying):
                V = -dot(load.force, motion.position(load.place))
                found.append(Contribution(name, body, force.name, V=V, kind="constant", load=load))
                continue
            Q = load_row(loads, load)
            found.append(Contribution(name, body, force.name, Q=Q, kind="force", load=load))
        return found

    @cached_property
    def _varying(self) -> tuple[Node, ...]:
        """What a constant force holds nothing of."""
        symbols = self.operator.base.symbols
        return (symbols.t, *symbols.q, *symbols.u, *symbols.inputs.values(), *(symbols.unknowns or {}).values())

    def _others(self) -> list[Contribution]:
        """Friction, and what the constraints do."""
        if self.equations is None:
            return []
        found, e = [], self.equations
        if e.friction:
            row = tuple(-x for x in e.friction)
            found.append(Contribution("the friction of the contacts", kind="friction", row=row))
        for constraint, J, lam in zip(self.system.constraints.closing, e.J, e.symbols.lam, strict=True):
            row = tuple(-x * lam for x in J)
            found.append(
                Contribution(
                    f"the force of the constraint {constraint.constraint}",
                    "",
                    constraint.constraint,
                    kind="constraint",
                    row=row,
                )
            )
        return found


def _body(loads: Sequence[Load]) -> str:
    """The one body on which they act, "" where there are several."""
    bodies = {load.place[0] for load in loads if isinstance(load, PointForce) and load.place[0]}
    bodies |= {load.body for load in loads if isinstance(load, Couple)}
    return bodies.pop() if len(bodies) == 1 else ""


# -------- wrong points ----------------------------------------------------------------------------------------
# Contributions -> what they change by where a mass, an inertia or a force is taken at another point of its body.


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


# -------- substitutions ---------------------------------------------------------------------------------------
# Contributions -> what they change by where something stands in them in the place of something else.
#
# An angle taken from another axis, in degrees or as a small one; a speed or a coordinate left out, turned round,
# relative for absolute; a parameter left out, with the wrong sign or factor, or another of its kind in its place.


EVERYTHING = "everything"
ANGLES = ("1", "rad", "")  # dimensions of angles


def substitutions_in(parts: Contributions, whole: Sequence[Contribution]) -> Iterator[Altered]:
    """Every substitution in every contribution, in all of one body, and in everything."""
    groups, search = _groups(whole), _Substitutions(parts)
    for what in (search.angles, search.motions, search.parameters):
        for part in groups:
            together = not any(part is each for each in whole)
            for found in what(part):
                yield replace(found, rank=max(found.rank, SHARED + SHORTER)) if together else found


@dataclass(frozen=True)
class _Substitutions:
    parts: Contributions

    def _change(
        self, part: Contribution, kind: str, mapping: Mapping[Node, Scalar], what: str, rank: float
    ) -> Iterator[Altered]:
        try:
            T, V, *Q = substituted((part.T, part.V, *part.Q), mapping)
        except DerivationError:
            return  # it has no value there
        Q_ = tuple(x - y for x, y in zip(Q, part.Q, strict=True))
        changed = Contribution("", part.body, part.force, T - part.T, V - part.V, Q_)
        yield Altered(part.name, kind, what, changed, rank)

    def angles(self, part: Contribution) -> Iterator[Altered]:
        """Sines and cosines of one angle."""
        formulas = (part.T, part.V, *part.Q)
        for angle in angles_in(formulas):
            reported = term_text(angle)
            for kind, mapping, what in turned_angles(angle, formulas):
                rank = PLACED if is_zero(part.T) else EXCHANGED
                if part.name == EVERYTHING or what.endswith("as zero"):
                    rank = ODD
                elif kind in ("factor", "approximation"):
                    rank = max(rank, TERMS if kind == "approximation" else EXCHANGED)
                yield from self._change(part, kind, mapping, f"in {part.name} {what.format(reported)}", rank)

    def motions(self, part: Contribution) -> Iterator[Altered]:
        """Speeds and coordinates."""
        symbols = self.parts.operator.base.symbols
        named = {x.name: x for x in symbols.u}
        rates: dict[Node, Node | None] = {q: named.get(f"{q.name}'") for q in symbols.q}
        moved, acting = symbols_of((part.T,)), symbols_of((part.V, *part.Q))
        for u in symbols.u:
            if u in moved:
                still = Contribution("", part.body, part.force, substituted((part.T,), {u: 0})[0] - part.T)
                text = f"the velocity in {part.name} leaves out what {u.name} does"
                yield Altered(part.name, "missing_term", text, still, SHARED)
            if u in acting:
                text = f"{part.name} leaves out what {u.name} does: the velocity is a relative one"
                yield from self._change(part, "missing_term", {u: 0}, text, SHARED)
        for q, rate in rates.items():
            if q in acting and part.name != EVERYTHING:
                text = f"{part.name} leaves out what {q.name} does"
                yield from self._change(part, "missing_term", {q: 0}, text, EXCHANGED)
            if {q, rate} & {*acting, *moved}:
                yield from self._coordinate(part, q, rate, rates)

    def _coordinate(
        self, part: Contribution, q: Node, u: Node | None, rates: Mapping[Node, Node | None]
    ) -> Iterator[Altered]:
        """A coordinate in the opposite direction, relative for absolute, or another one in its place."""
        opposite: dict[Node, Scalar] = {q: -q} if u is None else {q: -q, u: -u}
        text = f"in {part.name} {q.name} is taken in the opposite direction"
        yield from self._change(part, "sign", opposite, text, EXCHANGED)
        if part.name == EVERYTHING or u is None:
            return
        for p, w in rates.items():
            if p is q or w is None or not self._alike(p.name, q.name):
                continue
            meant = f"stands where {q.name} alone is meant"
            for mapping, what in (
                ({q: q + p, u: u + w}, f"{q.name} + {p.name} {meant}: it is no relative one"),
                ({q: q - p, u: u - w}, f"{q.name} - {p.name} {meant}: it is a relative one"),
                ({q: p, u: w}, f"{p.name} stands where {q.name} is meant"),
            ):
                yield from self._change(part, "wrong_quantity", mapping, f"in {part.name} {what}", EXCHANGED)

    def parameters(self, part: Contribution) -> Iterator[Altered]:
        """Masses, lengths and other constants."""
        known = tuple(self.parts.system.symbols.parameters.values())
        for kind, mapping, what in wrong_parameters(symbols_of((part.T, part.V, *part.Q)), known):
            x, y = next(iter(mapping.items()))
            length = kind == "factor" and str(self.parts.dimensions.get(x.name)) == "m"
            if kind != "wrong_quantity" or (type(y) is Node and self._alike(y.name, x.name)):
                angle = kind == "missing_term" and str(self.parts.dimensions.get(x.name)) in ANGLES
                rank = ODD if kind == "factor" or angle else EXCHANGED
                yield from self._change(
                    part, "wrong_point" if length else kind, mapping, f"in {part.name} {what}", rank
                )
        for x in (x for x in known if str(self.parts.dimensions.get(x.name)) == "1"):
            what = f"in {part.name} {x.name} is turned over: 1/{x.name} stands where {x.name} is meant"
            yield from self._change(part, "factor", {x: over(1, x)}, what, EXCHANGED)

    def _alike(self, a: str, b: str) -> bool:
        """Whether two names stand for the same kind of quantity."""
        return str(self.parts.dimensions.get(a, a)) == str(self.parts.dimensions.get(b, b))


def _groups(whole: Sequence[Contribution]) -> list[Contribution]:
    """Every contribution, and all of one body together."""
    found = [part for part in whole if part.row is None]
    bodies: dict[str, list[Contribution]] = {}
    forces: dict[str, list[Contribution]] = {}
    for part in found:
        if part.body:
            bodies.setdefault(part.body, []).append(part)
        if part.force and is_zero(part.T):
            forces.setdefault(part.force, []).append(part)
    joined = [_joined(f"all that belongs to {body}", members, body) for body, members in bodies.items()]
    joined += [_joined(f"the force {force}", members, force=force) for force, members in forces.items()]
    joined.append(_joined(EVERYTHING, found))
    return [*found, *(each for each in joined if each is not None)]


def _joined(name: str, members: Sequence[Contribution], body: str = "", force: str = "") -> Contribution | None:
    """Several contributions as one; None where it is one."""
    if len(members) < 2:
        return None
    T, V = (sum((getattr(part, x) for part in members), start=0) for x in ("T", "V"))
    rows = [part.Q for part in members if part.Q]
    return Contribution(name, body, force, T, V, tuple(sum(x, start=0) for x in zip(*rows, strict=True)))
