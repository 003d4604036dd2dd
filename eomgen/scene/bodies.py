"""Bodies and what acts on them -> marks: shapes, parts, lines between places; arrows of loads and reactions."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Axes, Component
from eomgen.mechanics.kinematics import GROUND, BodyLink, Motion, SystemScene
from eomgen.model import (
    ArcForm,
    Couple,
    EllipsoidForm,
    Form,
    LineForm,
    MassProperties,
    PointForce,
    PolygonForm,
    SpreadLoad,
    is_node,
)
from eomgen.scene.forms import ArrowForm, CoupleForm, FieldForm, LoadForm, PointForm, RodForm, SymbolForm
from eomgen.scene.scene import Mark, SceneFrame
from eomgen.symbolic.expression import (
    Fraction,
    Matrix,
    Node,
    Scalar,
    Vector,
    function,
    is_zero,
    over,
    sqrt,
    substituted,
)
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances


def body_marks(system: System, link: BodyLink, frame: int) -> list[Mark]:
    """Marks of a body in its own frame; none of a node of a truss."""
    part = system.scope.model.bodies.get(link.name)
    if part is None or is_node(link.name):
        return []
    marks: list[Mark] = []
    if part.shape is not None and not part.shape.is_point:
        marks = [Mark(form, frame, "body", link.name) for form in seen(system, part.shape.forms(system.scope.value))]
    elif part.parts is None and is_rotor(system, link):
        marks = [Mark(SymbolForm("rotor", link.point, Vector((1, 0, 0))), frame, "body", link.name)]
    elif part.parts is None:
        marks = skeleton(system, link, frame)
        point = part.shape is not None and part.shape.is_point
        if (point or not marks) and not is_block(system, link):
            marks.append(Mark(PointForm(Vector.ZERO), frame, "body", link.name))
    return marks


def is_rotor(system: System, link: BodyLink) -> bool:
    """True if a body in the plane turns on a hinge, has inertia and no lengths."""
    part = system.scope.model.bodies[link.name]
    bare = part.shape is None and len(places_of_body(system, link)) < 2
    plane = system.scope.model.space == "plane"
    return plane and bare and _turns(link) and not is_zero(system.scope.mass_properties(link.name).I[2][2])


def is_block(system: System, link: BodyLink) -> bool:
    """True if a body slides on the ground and has no shape: it is drawn as a block."""
    part = system.scope.model.bodies[link.name]
    if system.scope.model.space == "space":
        return False
    formless = part.parts is None and (part.shape is None or part.shape.is_point)
    slides = len(link.S) < 3 and sum(all(map(is_zero, w)) for w, _ in link.S) == 1
    seated = link.joint is not None and link.joint.carries_reaction and link.joint.straight
    return formless and slides and seated and link.parent == GROUND


def is_cylinder(link: BodyLink) -> bool:
    """True if a body slides on another one by the force of a drive: its rod comes out of a cylinder."""
    alone = len(link.S) == 1 and all(map(is_zero, link.S[0][0]))
    efforts = () if link.joint is None or link.parent == GROUND else link.joint.efforts()
    return alone and any(effort is not None and effort.drive is not None for effort in efforts)


def wedge_of(system: System, link: BodyLink) -> PolygonForm | None:
    """The triangle under the face of a block: on it another body slides along a line that meets the ground's guide."""
    if not is_block(system, link):
        return None
    motion, own = system.motion, link.point
    base = next(v for w, v in link.S if all(map(is_zero, w)))
    up: Vector = Vector((-base[1], base[0], 0))
    for other in motion.links:
        if other.parent != motion.index[link.name] or other.joint is None or not other.joint.straight or not other.S:
            continue
        seat, along = other.before.p, other.before.R @ (other.relative.R @ other.S[0][1])
        height, fall = up @ (seat - own), up @ along
        if motion.moves(seat) or motion.moves(along):
            continue
        if all(abs(x) > tolerances.COMPUTED for x in evaluate((height, fall), parameters_as_drawn(system), FLOAT)):
            toe = seat - over(height, fall) * along
            top = seat + Fraction(1, 8) * (seat - toe)
            heel = top - over(up @ (top - own), up @ up) * up
            return PolygonForm((toe, heel, top))
    return None


def piece_marks(system: System, body: str, parent: int, first: int) -> tuple[list[SceneFrame], list[Mark]]:
    """The frames and marks of the pieces of a composite body; holes lie over the pieces from which they are cut."""
    pieces = system.scope.model.bodies[body].parts if body in system.scope.model.bodies else None
    frames: list[SceneFrame] = []
    marks: list[Mark] = []
    for piece in pieces or ():
        own = (PointForm(Vector.ZERO),) if piece.shape.is_point else piece.shape.forms(system.scope.value)
        for form in seen(system, own):
            if piece.hole and isinstance(form, (ArcForm, PolygonForm)):
                marks.append(Mark(replace(form, hole=not form.hole), first + len(frames), "hole", body))
            elif not piece.hole:
                marks.append(Mark(form, first + len(frames), "body", body))
        frames.append(SceneFrame(body, parent, piece.pose(system.scope.value)))
    return frames, marks


def seen(system: System, forms: Iterable[Form]) -> list[Form]:
    """The forms of a shape: in the plane its view along z."""
    if system.scope.model.space == "plane":
        return [flat for form in forms for flat in form.flat()]
    return list(forms)


def skeleton(system: System, link: BodyLink, frame: int) -> list[Mark]:
    """A body without a shape: the lines through its joint and its points, in space also its inertia."""
    places = places_of_body(system, link)
    if system.scope.model.space == "plane":
        wedge = wedge_of(system, link)
        forms = [wedge] if wedge else _plate(system, line_of(system, link))
        return [Mark(form, frame, "body", link.name) for form in forms]
    line, bent = line_of(system, link), not system.scope.model.coordinates  # of a structure: from point to point
    pairs = pairwise(line) if bent or line != places else ((places[0], place) for place in places[1:])
    rods = [Mark(RodForm(a, b), frame, "body", link.name) for a, b in pairs]
    if gimbal := gimbal_of(system, link):
        symbol, axis = gimbal
        pins = Mark(SymbolForm(f"{symbol}_pins", link.point, link.S[0][0]), frame, "body", link.name)
        return [Mark(SymbolForm(symbol, link.point, axis), frame, "body", link.name), pins]
    if shaft := shaft_of(system, link):
        return [Mark(SymbolForm("shaft", link.point, shaft), frame, "body", link.name)]
    if not rods and is_cylinder(link):
        return [Mark(PointForm(link.point), frame, "body", link.name)]
    return [*rods, *inertia_mark(system.scope.mass_properties(link.name), frame, link.name)]


def line_of(system: System, link: BodyLink) -> list[Vector]:
    """All places of a body, in the order of its line where that goes through all of them."""
    part, own, places = (
        system.scope.model.bodies[link.name],
        system.motion.points[link.name],
        places_of_body(system, link),
    )
    line = [own[name.rpartition(".")[2]] for name in part.line or ()]
    return line if set(places) <= set(line) else places


def gimbal_of(system: System, link: BodyLink) -> tuple[str, Vector] | None:
    """(symbol, its axis) of a hinged body that has no lengths: a rotor is all inertia, a ring carries one.

    The ring lies in the plane of its own hinge and of that in it.
    """
    part, motion = system.scope.model.bodies[link.name], system.motion
    if system.scope.model.space == "plane" or not _turns(link) or part.shape is not None or part.parts is not None:
        return None
    mass, axis = system.scope.mass_properties(link.name), link.S[0][0]
    hung = [other for other in motion.links if other.parent == motion.index[link.name]]
    if len(hung) > 1 or len(places_of_body(system, link)) > 1 or not (is_zero(mass.m) or _spins(link, mass)):
        return None
    if not hung:
        return None if all(is_zero(x) for row in mass.I for x in row) else ("rotor", axis)
    if not is_zero(mass.m):
        return None
    inner = gimbal_of(system, hung[0])
    across = axis.cross(hung[0].before.R @ hung[0].S[0][0]) if inner else Vector.ZERO
    if inner is None or hung[0].before.p != link.point or all(map(is_zero, across)):
        return None
    return "ring" if inner[0] == "rotor" else "outer_ring", across


def _spins(link: BodyLink, mass: MassProperties) -> bool:
    """True if a body that turns on another one has its centre there and is round about the axis: a wheel."""
    I, axis = mass.I, link.S[0][0]
    along = [k for k in range(3) if not is_zero(axis[k])]
    if link.parent == GROUND or len(along) != 1 or not all(map(is_zero, mass.com - link.point)):
        return False
    i, j = (k for k in range(3) if k not in along)
    return is_zero(I[i][i] - I[j][j]) and all(is_zero(I[a][b]) for a in range(3) for b in range(a))


def shaft_of(system: System, link: BodyLink) -> Vector | None:
    """Direction in which a rotor without dimensions is drawn as a shaft from its bearing on the ground, body axes.

    None of a body that is no such rotor. Of two rotors at one bearing the second is drawn in the opposite direction.
    """
    part = system.scope.model.bodies[link.name]
    if link.parent != GROUND or not _turns(link) or part.shape is not None or part.parts is not None:
        return None
    if len(places_of_body(system, link)) > 1:
        return None
    before = [other for other in system.motion.links[: system.motion.index[link.name]] if other.parent == GROUND]
    second = any(_turns(other) and other.before.p == link.before.p for other in before)
    return link.S[0][0] if second else Vector.ZERO - link.S[0][0]


def _turns(link: BodyLink) -> bool:
    """True if the body is held by a hinge."""
    alone = len(link.S) == 1 and not all(map(is_zero, link.S[0][0])) and all(map(is_zero, link.S[0][1]))
    return link.joint is not None and link.joint.carries_reaction and alone


def _plate(system: System, places: list[Vector]) -> list[Form]:
    """A line through places; of a moving body with places on more than one line the plate between them."""
    model = system.scope.model
    if len(places) < 2:
        return []
    loose = not model.constraints and len(system.motion.links) == 1  # a body at an instant, by itself
    still = not model.coordinates and not loose
    if still or len(places) < 3 or any(system.motion.moves(place) for place in places):
        return [LineForm(tuple(places))]
    numbers = [tuple(map(float, evaluate(place[:2], parameters_as_drawn(system), FLOAT))) for place in places]
    corners = hull(numbers)
    return [PolygonForm(tuple(places[k] for k in corners)) if len(corners) > 2 else LineForm(tuple(places))]


def hull(places: Sequence[tuple[float, ...]]) -> list[int]:
    """The numbers of the corners of the convex hull, counter-clockwise; of points on one line its ends."""
    order = sorted(range(len(places)), key=lambda k: (places[k], k))
    chains = []
    for way in (order, order[::-1]):
        chain: list[int] = []
        for k in way:
            while len(chain) > 1 and _turn(places[chain[-2]], places[chain[-1]], places[k]) <= tolerances.COMPUTED:
                chain.pop()
            chain.append(k)
        chains.append(chain[:-1])
    return [*chains[0], *chains[1]]


def _turn(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> float:
    """Twice the area of a triangle, positive where it is counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def parameters_as_drawn(system: System) -> dict[Node, float]:
    """The parameters in numbers; one without a value is 1, as in pictures."""
    known = system.scope.model.exact_parameters()
    return {node: float(known.get(name, 1)) for name, node in system.symbols.parameters.items()}


def places_of_body(system: System, link: BodyLink) -> list[Vector]:
    """Places of a body, each once, in body axes: of its joint, its own points in order, the joints of other bodies."""
    motion, part = system.motion, system.scope.model.bodies[link.name]
    seated = link.joint is not None and link.joint.carries_reaction
    own = [motion.points[link.name][name] for name in part.points]
    hung = [other.before.p for other in motion.links if other.parent == motion.index[link.name]]
    fixed = [place for place in hung if not motion.moves(place)]
    found = [*([link.point] if seated else []), *own, *fixed]
    center = motion.points[link.name].get("center")
    if len(dict.fromkeys(found)) < 2 and center is not None:
        found.append(center)
    return list(dict.fromkeys(found))


def inertia_mark(mass: MassProperties, frame: int, body: str) -> list[Mark]:
    """The ellipsoid of the same mass and moments, where its axes are those of the body: a^2 = 5 (B + C - A) / 2 m."""
    I, m = mass.I, mass.m
    if is_zero(m) or not all(is_zero(I[i][j]) for i in range(3) for j in range(3) if i != j):
        return []
    A, B, C = (I[k][k] for k in range(3))
    if all(map(is_zero, (A, B, C))):
        return [Mark(PointForm(mass.com), frame, "body", body)]
    size = tuple(_half_axis(x, m) for x in (B + C - A, C + A - B, A + B - C))
    return [Mark(EllipsoidForm(mass.com, Vector((size[0], size[1], size[2]))), frame, "inertia", body)]


def _dot(mark: Mark) -> Mark:
    """The place of a symbol alone."""
    form: Any = mark.form
    return replace(mark, form=PointForm(form.at))


def is_a_rotor(mark: Mark) -> bool:
    """True of the symbol of a rotor."""
    return isinstance(mark.form, SymbolForm) and mark.form.symbol == "rotor" and mark.role == "body"


def without_veils(marks: Sequence[Mark], *, alone: bool) -> list[Mark]:
    """An ellipsoid of inertia stands for a body that nothing else shows, or about the rods of the only body; the symbol
    of a rotor for one whose rim no string or surface shows, else there is a dot.

    Moments that a model declares say little of its size: ellipsoids would hide how the bodies are connected.
    """
    rims = {
        mark.of for mark in marks if mark.role == "rim" or (mark.role == "body" and mark.form.kind in ("arc", "wheel"))
    }
    marks = [_dot(mark) if is_a_rotor(mark) and mark.of in rims else mark for mark in marks]
    shown = {mark.of for mark in marks if mark.role == "body" and not (alone and isinstance(mark.form, RodForm))}
    return [mark for mark in marks if mark.role != "inertia" or mark.of not in shown]


def _half_axis(twice: Any, m: Any) -> Any:
    """The half-axis of a body whose integral of x^2 dm is half of `twice`; measured tensors may give less than 0."""
    return sqrt(over(Fraction(5, 2) * function("max", twice, 0), m))


# -------- acting -----------------------------------------------------------------------------------------------
# Loads, reactions -> marks: arrows of what is applied, the field of gravity, forces of joints and constraints.


def field_marks(system: System) -> list[Mark]:
    """The direction of the weight."""
    g = system.loads.fields
    return [] if all(map(is_zero, g)) else [Mark(FieldForm(g, "g"), 0, "axes", "")]


def applied_marks(system: System) -> Iterator[Mark]:
    """Forces and couples at bodies, but for weights, springs and dampers, and drives of joints."""
    motion, model = system.motion, system.scope.model
    for applied in system.loads.applied:
        force = model.forces[applied.name]
        if force.element is not None or force.strands_at(SystemScene(motion, f"forces.{applied.name}")):
            continue
        for spread in applied.spread:
            ends = _known(system, spread.at_start), _known(system, spread.at_end)
            yield spread_mark(motion, replace(spread, at_start=ends[0], at_end=ends[1]), applied.name, applied.name)
        for load in () if applied.spread else applied.loads:
            if isinstance(load, PointForce) and load.place[0] is not None:
                f = _known(system, motion.in_ground_axes(load.force, load.axes))
                at = motion.position(load.place)
                yield Mark(ArrowForm(at, f, "N", text=applied.name), 0, "force", applied.name)
            elif isinstance(load, Couple):
                at = motion.position(load.place or (load.body, Vector.ZERO))
                couple = _known(system, motion.in_ground_axes(load.couple, load.axes))
                yield Mark(CoupleForm(at, couple, applied.name), 0, "force", applied.name)
    yield from _drives(system)


def spread_mark(motion: Motion, load: SpreadLoad, of: str, text: str) -> Mark:
    """A load along a line with its name."""
    ends = motion.position(load.start), motion.position(load.end)
    return Mark(LoadForm(*ends, load.at_start, load.at_end, text), 0, "force", of)


def _given(system: System) -> Iterator[Mark]:
    """Weights at the mass centres, and what springs and dampers do to the bodies at their ends."""
    motion, model = system.motion, system.scope.model
    for weight in system.loads.weights:
        yield Mark(_from(motion.position(weight.place), weight.force), 0, "force", f"weight({weight.place[0]})")
    for applied in system.loads.applied:
        if model.forces[applied.name].element is None:
            continue
        for load in applied.loads:
            if isinstance(load, PointForce) and load.place[0] is not None:
                yield Mark(_from(motion.position(load.place), load.force), 0, "force", applied.name)
    for effort in system.loads.efforts:
        link = motion.link(effort.body)
        w, v = link.S[effort.variable]
        declared = None if link.joint is None else link.joint.efforts()[effort.variable]
        drive = 0 if declared is None or declared.drive is None else system.scope.value(declared.drive)
        size = effort.effort - drive
        if all(map(is_zero, w)) and not is_zero(size):
            along = link.pose.R @ (over(size, v @ v) * v)
            yield Mark(_from(link.pose.point(link.point), along), 0, "force", f"spring({effort.body})")


def _from(at: Vector, force: Vector) -> ArrowForm:
    return ArrowForm(at, force, "N", outward=True)


def _known(system: System, v: Vector) -> Vector:
    """A load in which an unknown number, to be found, is drawn as 1."""
    return Vector(substituted(v, dict.fromkeys(system.symbols.unknowns.values(), 1)))


def _drives(system: System) -> Iterator[Mark]:
    """The drives of joints, on the child."""
    for link in system.motion.links:
        efforts = () if link.joint is None else link.joint.efforts()
        for (w, v), effort in zip(link.S, efforts, strict=False):
            if effort is None or effort.drive is None:
                continue
            value = system.scope.value(effort.drive)
            at = link.pose.point(link.point)
            turns = not all(map(is_zero, w))
            along = link.pose.R @ (value * (w if turns else v))
            form = CoupleForm(at, along) if turns else ArrowForm(at, along, "N", outward=True)
            yield Mark(form, 0, "force", link.name)


@dataclass(frozen=True)
class Resultant:
    """Force of a joint or constraint on the body that it holds: the sum of its components along unit vectors.

    Args:
        owner: the constraint, or the body whose joint it is.
        at: the point where it acts, ground axes [m].
        units: of each component by its name, `reaction_x(A)` or `reaction_n(wall)`, the direction, ground axes.
        pulls: it is the tension of a string: its arrow begins at its place.
    """

    owner: str
    at: Vector
    units: Mapping[str, Vector]
    pulls: bool = False

    def of(self, values: Mapping[str, Scalar]) -> Vector:
        """The resultant, ground axes [N]."""
        total = Vector.ZERO
        for name, along in self.units.items():
            total = total + values[name] * along
        return total


def resultants(system: System, names: Container[str]) -> Iterator[Resultant]:
    """Resultants of the joints and constraints all of whose forces are among the names.

    Components along x, y, z are whole as they are. Others, normal forces and friction, are each along what a unit of it
    does to the first-named body, where all of them act at one place.
    """
    if not names:
        return
    motion = system.motion
    along = "xy" if system.scope.model.space == "plane" else "xyz"
    owners: dict[str, list[Component]] = {}
    for component in Axes(motion).components_of(system):
        if component.kind != "drive":
            owners.setdefault(component.owner, []).append(component)
    for owner, components in owners.items():
        seat, units = (
            _seat(system, owner),
            {f"reaction_{axis}({owner})": e for axis, e in zip(along, Matrix.IDENTITY, strict=False)},
        )
        if seat is not None and all(name in names for name in units):
            yield Resultant(owner, motion.position(seat), units)
        elif (contact := _contact(motion, components)) is not None and all(name in names for name in contact.units):
            yield contact
        yield from (pull for pull in _pulls(system, owner, components) if all(name in names for name in pull.units))


def _pulls(system: System, owner: str, components: Sequence[Component]) -> Iterator[Resultant]:
    """The tension of each strand of a string on the bodies at its ends, where it touches them; of a link the same."""
    tensions = {component.number: component for component in components if component.label == "tension"}
    constraint = system.scope.model.constraints.get(owner)
    if not tensions or constraint is None:
        return
    strands = constraint.strands_at(SystemScene(system.motion, f"constraints.{owner}"))
    for strand, number in zip(strands, constraint.strand_rows(), strict=True):
        for stop, at, along in zip((strand.first, strand.second), strand.ends, (strand.d, -strand.d), strict=True):
            if stop.body is not None and number in tensions:
                yield Resultant(owner, at, {tensions[number].name: along}, pulls=True)
    for component in tensions.values() if not strands else ():
        for effect in component.effects:
            pose, plane = system.motion.links[effect.link].pose, system.scope.model.space == "plane"
            if effect.place is not None and not all(map(is_zero, effect.force)):
                along = effect.force if plane else pose.R @ effect.force
                yield Resultant(owner, pose.point(effect.place), {component.name: along}, pulls=True)


def _contact(motion: Motion, components: Sequence[Component]) -> Resultant | None:
    """Resultant of the forces at one place along directions of their own; None of hinges, strings and placed bodies."""
    owner, on = components[0].owner, components[0].effects[0].link
    pose, plane = motion.links[on].pose, motion.scope.model.space == "plane"
    pushes = [(c.label, c.name, c.effects) for c in components]
    pushes += [(s.label, f"reaction_{s.label}({owner})", s.effects) for c in components for s in c.friction]
    places: set[Vector] = set()
    units: dict[str, Vector] = {}
    for label, name, effects in pushes:
        mine = [e for e in effects if e.link == on and not all(map(is_zero, e.force))]
        if not mine and label.startswith("couple"):
            continue
        if len(mine) != 1 or name in units or label[:1] not in ("n", "t", "s") or label == "tension":
            return None
        (push,) = mine
        if push.place is None:
            return None
        places.add(push.place + (push.beyond or Vector.ZERO))
        units[name] = push.force if plane else pose.R @ push.force
    return Resultant(owner, pose.point(places.pop()), units) if len(places) == 1 else None


def force_marks(system: System, forces: Iterable[tuple[Resultant, Vector]]) -> Iterator[Mark]:
    """Weights, forces of springs and dampers, and the resultant force of every joint and constraint, on the body that
    it holds."""
    yield from _given(system)
    for resultant, force in forces:
        yield Mark(ArrowForm(resultant.at, force, "N", outward=resultant.pulls), 0, "reaction", resultant.owner)


def _seat(system: System, owner: str) -> tuple[str | None, Vector] | None:
    """(body, place) at which a joint or constraint acts; None if at no single place."""
    motion = system.motion
    if owner in motion.index:
        return owner, motion.link(owner).point
    pushes = [push for row in system.constraints.rows if row.constraint == owner for push in row.pushes]
    return next((push.place for push in pushes if isinstance(push, PointForce)), None)
