"""System -> Scene: bodies, their shapes, names and dimensions, put together.

System -> Scene: bodies, joints, constraints, springs and names of a model, put together.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import combinations, pairwise
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import holds_identically
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.free_bodies import Axes, Effect, Structure
from eomgen.mechanics.kinematics import GROUND, BodyLink, SystemScene
from eomgen.mechanics.statics import StaticReaction, WorkEquation
from eomgen.model import ArcForm, EllipsoidForm, LineForm, ModelOrPath, PolygonForm, SpreadLoad, UniformField, is_node
from eomgen.scene.bodies import (
    applied_marks,
    body_marks,
    field_marks,
    parameters_as_drawn,
    piece_marks,
    places_of_body,
    spread_mark,
    without_veils,
)
from eomgen.scene.connections import constraint_marks, drive_marks, force_elements, joint_marks, ordered
from eomgen.scene.forms import (
    AngleForm,
    ArrowForm,
    AxesForm,
    CoupleForm,
    DimensionForm,
    LabelForm,
    PointForm,
    SymbolForm,
)
from eomgen.scene.scene import ROLES, Mark, Scene, SceneFrame
from eomgen.scene.space_strokes import drawing_of
from eomgen.scene.strokes import SceneNumbers
from eomgen.study import model_to_study, study_of
from eomgen.symbolic.expression import (
    Fraction,
    Matrix,
    Node,
    Pose,
    Scalar,
    Vector,
    collected,
    derivative,
    function,
    is_zero,
    substituted,
)
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances

Place = Vector | Sequence[float] | np.ndarray


def scene_of_system(system: System, equations: EquationsOfMotion | None = None) -> Scene:
    """Scene of a system: its drawable elements at a state.

    Args:
        equations: of motion: applied forces and reactions are drawn too.
    """
    motion = system.motion
    frames = [SceneFrame(""), *(SceneFrame(link.name, -1, link.pose) for link in motion.links)]
    marks: list[Mark] = []
    for k, link in enumerate(motion.links, start=1):
        marks += body_marks(system, link, k)
        pieces, drawn = piece_marks(system, link.name, k, len(frames))
        frames += pieces
        marks += drawn + joint_marks(system, link, k)
    marks += constraint_marks(system) + force_elements(system)
    marks = without_veils(marks, alone=len(motion.links) == 1)
    marks += [
        *size_marks(system, marks),
        *drive_marks(system),
        *field_marks(system),
        *applied_marks(system),
        *name_marks(system),
    ]
    if system.scope.model.space == "space":
        marks.append(Mark(AxesForm(Vector.ZERO), 0, "axes", ""))
    points = tuple(named_points(system))
    return Scene(system, tuple(frames), points, ordered(marks, ROLES), equations)


def scene_of(model: ModelOrPath) -> Scene:
    """Scene of a model: its drawable elements at a state, forces left out."""
    model = model_to_study(model)
    return scene_of_system(study_of(model).system)


def named_points(system: System) -> Iterator[tuple[str, Vector]]:
    """Every named point of the ground and of bodies by its whole name, ground axes [m]."""
    motion, model = system.motion, system.scope.model
    for name, place in model.points.items():
        yield name, motion.scope.vector(place)
    for link in motion.links:
        if is_node(link.name):
            yield link.name, link.pose.p
            continue
        for name in model.body_points(link.name):
            yield f"{link.name}.{name}", motion.position((link.name, motion.points[link.name].get(name, Vector.ZERO)))


def name_marks(system: System) -> Iterator[Mark]:
    """The letters of named points, and the names of bodies."""
    motion, model = system.motion, system.scope.model
    for name, place in model.points.items():
        yield Mark(LabelForm(name, motion.scope.vector(place)), 0, "point", name)
    for k, link in enumerate(motion.links, start=1):
        if is_node(link.name):
            yield Mark(LabelForm(link.name.rpartition(".")[2], Vector.ZERO), k, "point", link.name)
            continue
        for name in model.bodies[link.name].points:
            yield Mark(LabelForm(name, motion.points[link.name][name]), k, "point", f"{link.name}.{name}")
        yield Mark(LabelForm(link.name, _middle(system, link)), k, "label", link.name)


def _middle(system: System, link: BodyLink) -> Vector:
    """Place of a body's name: its mass centre, else half-way along its middle piece; so of rods in space too, which
    may leave their mass centre aside."""
    part, places = system.scope.model.bodies[link.name], places_of_body(system, link) or [Vector.ZERO]
    rods = system.scope.model.space == "space" and part.shape is None and part.parts is None and len(places) > 1
    if (center := system.motion.points[link.name].get("center")) is not None and not rods:
        return center
    half = len(places) // 2
    return Fraction(1, 2) * (places[max(half - 1, 0)] + places[min(half, len(places) - 1)])


# -------- sizes -----------------------------------------------------------------------------------------------
# Lengths, radii, angles and displacements by their names -> dimension marks of the rest picture.


MOST = 12  # lengths, or coordinates, that a picture has room for
TIERS = (3, 5, 4, 6)  # of angles at one place, one after the other [symbol units]
OBLIQUE: Vector = Vector((Fraction(3, 5), Fraction(4, 5), 0))  # along which the radius of a circle is drawn


def size_marks(system: System, marks: Iterable[Mark]) -> list[Mark]:
    """Every parameter that is a length and every coordinate, once, where one first sees it; in the plane.

    Of a chain of many bodies neither: nothing could be read.
    """
    if system.scope.model.space != "plane":
        return []
    names = {node: name for name, node in system.symbols.parameters.items()}
    found: dict[str, Mark] = {}
    for mark in (*_body_lengths(system, names), *_of_forms(marks, names), *_ground_lengths(system, names)):
        found.setdefault(getattr(mark.form, "text", ""), mark)
    return [
        mark for marks in (list(found.values()), list(_coordinates(system))) if len(marks) <= MOST for mark in marks
    ]


def _body_lengths(system: System, names: dict[Node, str]) -> Iterator[Mark]:
    """Dimensions between two places of a body that are a parameter apart along one of its axes."""
    for k, link in enumerate(system.motion.links, start=1):
        part = system.scope.model.bodies.get(link.name)
        if part is None:
            continue
        own = system.motion.points[link.name]
        ends = [own[name] for name in ("start", "end", "center") if name in own]
        places = dict.fromkeys([link.point, *ends, *places_of_body(system, link)])
        yield from _between(places, names, k, link.name)


def _ground_lengths(system: System, names: dict[Node, str]) -> Iterator[Mark]:
    """Dimensions between two places of the ground that are a parameter apart along one of its axes."""
    motion = system.motion
    seats = [link.before.p for link in motion.links if link.parent == GROUND and link.joint is not None]
    points = [motion.scope.vector(place) for place in system.scope.model.points.values()]
    fixed = [place for place in (*seats, *points) if not motion.moves(place)]
    yield from _between(dict.fromkeys(fixed), names, 0, "")


def _between(places: Iterable[Vector], names: dict[Node, str], frame: int, of: str) -> Iterator[Mark]:
    for a, b in combinations(places, 2):
        if (name := _length(b - a, names)) is not None:
            yield Mark(DimensionForm(a, b, name), frame, "dimension", of)


def _length(v: Vector, names: dict[Node, str]) -> str | None:
    """The parameter that is the length of a vector along an axis."""
    parts = [collected(x) for x in v if not is_zero(x)]
    if len(parts) != 1:
        return None
    (x,) = parts
    return next((names[y] for y in (x, -x) if type(y) is Node and y in names), None)


def _of_forms(marks: Iterable[Mark], names: dict[Node, str]) -> Iterator[Mark]:
    """Radii of circles, and edges of polygons along the axes of their body."""
    for mark in marks:
        form = mark.form
        if isinstance(form, ArcForm) and type(form.radius) is Node and form.radius in names:
            rim = form.at + form.radius * OBLIQUE
            yield Mark(DimensionForm(form.at, rim, names[form.radius], 0), mark.frame, "dimension", mark.of)
        elif isinstance(form, PolygonForm):
            for a, b in pairwise((*form.points, form.points[0])):
                if (name := _length(b - a, names)) is not None:
                    yield Mark(DimensionForm(a, b, name, 2), mark.frame, "dimension", mark.of)


def _coordinates(system: System) -> Iterator[Mark]:
    """The angle or the displacement that each coordinate is, at the first joint that shows it alone."""
    tiers: dict[Vector, int] = {}
    for q in system.symbols.q:
        links = system.motion.links
        ways = (_turn(system, link, q, tiers) or _slide(system, link, q) for link in links)
        shown = next(filter(None, ways), None) or next(filter(None, (_way(system, link, q) for link in links)), None)
        if shown is not None:
            yield shown


def _turn(system: System, link: BodyLink, q: Node, tiers: dict[Vector, int]) -> Mark | None:
    """angle = reference + q or reference - q: the arc from the reference to the body."""
    if link.angle is None or type(link.angle) is not Node:
        return None
    slope = derivative(link.angle, q)
    if type(slope) is Node or slope not in (1, -1):
        return None
    at = system.motion.position((link.name, link.point))
    tier = tiers[at] = tiers.get(at, -1) + 1
    reference = collected(link.angle - slope * q)
    return Mark(AngleForm(at, reference, link.angle, q.name, TIERS[tier % len(TIERS)]), 0, "dimension", q.name)


def _slide(system: System, link: BodyLink, q: Node) -> Mark | None:
    """place = seat + q n: the way from the seat."""
    if (
        link.joint is None
        or not link.joint.straight
        or link.s != (q,)
        or len(link.S) != 1
        or any(not is_zero(w) for w in link.S[0][0])
    ):
        return None
    above = link.parent + 1 if link.parent != GROUND else 0
    return Mark(DimensionForm(link.before.p, link.local.p, q.name), above, "dimension", q.name)


def _way(system: System, link: BodyLink, q: Node) -> Mark | None:
    """A coordinate by which a placed body goes round a fixed centre, p = c + r(q), or straight on, p = a + q e.

    It goes round where p + p'' is a fixed c, and straight on where p'' = 0, at a rate of 1: from where q is 0.
    """
    if not link.is_placed:
        return None
    place = system.motion.points[link.name].get("center", Vector.ZERO)
    p = system.motion.position((link.name, place))
    rate = Vector(derivative(x, q) for x in p)
    second = Vector(derivative(x, q) for x in rate)
    start = Vector(substituted(p, {q: 0}))
    if all(map(holds_identically, second)):
        return Mark(DimensionForm(start, p, q.name, 5), 0, "dimension", q.name) if _is_one(rate @ rate) else None
    center = Vector(collected(x + y) for x, y in zip(p, second, strict=True))
    arm = p - center
    if not all(holds_identically(derivative(x, q)) for x in center):
        return None
    x, y, _ = start - center
    begin = function("atan2", y, x)
    turns = arm.cross(rate)[2] - arm @ arm, arm.cross(rate)[2] + arm @ arm
    sense = next((k for k, left in zip((1, -1), turns, strict=True) if holds_identically(left)), None)
    return (
        None if sense is None else Mark(AngleForm(center, begin, begin + sense * q, q.name, 7), 0, "dimension", q.name)
    )


def _is_one(x: Scalar) -> bool:
    return holds_identically(x - 1)


# -- ellipsoids of inertia ---------------------------------------------------------------------------------------


LONGEST_AXIS = 4.0  # half-axis of an ellipsoid of inertia, of its shortest: that of a rod has no end
BEYOND = 1.25  # times its half-axis a principal axis goes


def scene_of_inertia(
    system: System,
    known: Mapping[Node, float],
    axes: Mapping[str, Sequence[Sequence[float]]],
    moments: Mapping[str, Sequence[float]],
) -> Scene:
    """Bodies in space and about their mass centres x I x = c, of half-axes sqrt(c/I_k): of a ball the ball.

    Args:
        known: parameters, coordinates and time at a state.
        axes: the principal axes, the rows of R, by the body's name.
        moments: the principal moments in their order [kg m^2], by the body's name.
    """
    scene = scene_of_system(system)
    frames, marks = list(scene.frames), [mark for mark in scene.marks if mark.role != "inertia"]
    for body, rows in axes.items():
        if body not in system.motion.index or body not in moments or min(moments[body]) < 0 or not any(moments[body]):
            continue
        mass = system.scope.mass_properties(body)
        m, *com = system.scope.numbers((mass.m, *mass.com), known) or (0.0, 0.0, 0.0, 0.0)
        if m <= 0:
            continue
        marks += _ellipsoid(moments[body], m, len(frames), body)
        pose = Pose(Matrix.of(map(_vector, zip(*rows, strict=True))), _vector(com))
        frames.append(SceneFrame(f"{body}, principal", system.motion.index[body] + 1, pose))
    return replace(scene, frames=tuple(frames), marks=ordered(marks, ROLES))


def _ellipsoid(moments: Sequence[float], m: float, frame: int, body: str) -> Iterator[Mark]:
    """The ellipsoid, its centre, and its axes with their numbers."""
    largest = max(moments)
    size = math.sqrt(5 * sum(moments) / (6 * m))  # of the shortest half-axis: of a ball its radius
    half = [size * min(math.sqrt(largest / I) if I > 0 else LONGEST_AXIS, LONGEST_AXIS) for I in moments]
    yield Mark(EllipsoidForm(Vector.ZERO, _vector(half)), frame, "inertia", body)
    yield Mark(PointForm(Vector.ZERO), frame, "center", body)
    ends = {str(k + 1): _vector(BEYOND * length * (i == k) for i in range(3)) for k, length in enumerate(half)}
    yield from axis_marks(body, Vector.ZERO, ends, frame)


def axis_marks(body: str, center: Place, ends: Mapping[str, Place], frame: int) -> Iterator[Mark]:
    """Principal axes through a mass centre, each with its number at one end.

    Args:
        ends: from the centre, by the number.
    """
    center = exact_vector(center)
    for number, end in zip(ends, map(exact_vector, ends.values()), strict=True):
        yield Mark(LineForm((center - end, center + end), fine=True), frame, "reaction", body)
        yield Mark(LabelForm(number, center + end), frame, "axes", body)


def _vector(v: Iterable[float]) -> Vector:
    return Vector(map(Fraction, v))


# -------- arrows ------------------------------------------------------------------------------------------------------
# Forces, couples and velocities in numbers -> marks: the arrows of a state that a result knows, on its scene.


STEEP = 0.25  # sine of the angle below which two lines run along one another
CLEAR = 0.15  # of an arrow: nearer to a line it is on it; so much of it is at its own place


@dataclass(frozen=True)
class DrawnArrow:
    """An arrow in numbers.

    Args:
        of: the force, joint, constraint or point that it belongs to.
        at, vector: ground axes, 2 or 3 each; of those with one role and unit the longest becomes the longest arrow.
        role: "force", "reaction" or "velocity".
        text: at its free end, "" of none; of a zero vector that alone is drawn.
        turns: it is a couple.
        outward: it begins at its place, and does not end there.
    """

    of: str
    at: Sequence[float] | np.ndarray
    vector: Sequence[float] | np.ndarray
    role: str
    text: str = ""
    turns: bool = False
    outward: bool = False
    unit: str = "1"

    @staticmethod
    def never_short(size: float, largest: float, shortest: float) -> float:
        """Length of an arrow in a picture without a scale: 1 of the largest, never below `shortest`."""
        return shortest + (1 - shortest) * min(1.0, size / largest)

    @staticmethod
    def is_freer_outward(lines: Iterable[np.ndarray], at: Sequence[float], vector: Sequence[float]) -> bool:
        """True if an arrow on the page that begins at its place meets fewer lines than one that ends there."""
        pieces = [piece for line in lines for piece in pairwise(line)]
        place, stroke = np.array(at), np.array(vector)
        begun, ended = (sum(_meets(a, b, place, s) for a, b in pieces) for s in (stroke, -stroke))
        return begun < ended


def arrow_marks(arrows: Iterable[DrawnArrow]) -> Iterator[Mark]:
    """The marks of arrows; of a zero vector its name at its place."""
    for arrow in arrows:
        at, vector = exact_vector(arrow.at), exact_vector(arrow.vector)
        if not any(vector):
            if arrow.text:
                yield Mark(LabelForm(arrow.text, at), 0, arrow.role, arrow.of)
        elif arrow.turns:
            yield Mark(CoupleForm(at, vector, arrow.text), 0, arrow.role, arrow.of)
        else:
            yield Mark(ArrowForm(at, vector, arrow.unit, arrow.outward, arrow.text), 0, arrow.role, arrow.of)


def center_marks(centers: Iterable[tuple[str, Place]], of: str = "") -> Iterator[Mark]:
    """Marks of centres, of rotation or of mass, by their names."""
    for name, place in centers:
        at = exact_vector(place)
        yield Mark(PointForm(at), 0, "center", of)
        yield Mark(LabelForm(name, at), 0, "center", of)


def exact_vector(place: Place) -> Vector:
    """Two or three numbers as a vector, as they are."""
    return place if isinstance(place, Vector) else Vector(Fraction(float(x)) for x in [*place, 0.0][:3])


def _meets(a: np.ndarray, b: np.ndarray, at: np.ndarray, stroke: np.ndarray) -> bool:
    """True if a stroke from a place runs along the piece a b, or crosses it further on."""
    along, away = b - a, at - a
    turn = along[0] * stroke[1] - along[1] * stroke[0]
    sizes = float(np.hypot(*along) * np.hypot(*stroke))
    if not sizes:
        return False
    if abs(turn) < STEEP * sizes:
        middle = away + stroke / 2
        share = float(np.clip(middle @ along / (along @ along), 0, 1))
        return bool(np.hypot(*(middle - share * along)) < CLEAR * np.hypot(*stroke))
    on_piece = (away[0] * stroke[1] - away[1] * stroke[0]) / turn
    on_stroke = (away[0] * along[1] - away[1] * along[0]) / turn
    return bool(0 <= on_piece <= 1 and CLEAR < on_stroke <= 1)


def scene_with(scene: Scene, marks: Iterable[Mark]) -> Scene:
    """A scene with more marks, each in the place that its role has."""
    return replace(scene, marks=ordered((*scene.marks, *marks), ROLES))


# -- cut free ----------------------------------------------------------------------------------------------------


OWN = ("body", "hole", "inertia", "rim", "member")  # roles of a body itself
NAMED = ("point", "center")  # roles of what is named on it


def scene_of_cut_body(scene: Scene, body: str, arrows: Iterable[DrawnArrow] = ()) -> Scene:
    """The scene of one body by itself, with its forces; loads along lines as they are, a symbol where it was cut."""
    arrows = tuple(arrows)
    kept = [mark for mark in scene.marks if _belongs(mark, body)]
    spread = list(_spread(scene, body)) if arrows else []
    lines = {mark.of for mark in spread}
    marks = (*kept, *spread, *arrow_marks(each for each in arrows if each.of not in lines))
    places = dict.fromkeys(tuple(each.at) for each in arrows if each.role == "reaction" and not each.turns)
    symbol = "hinge" if scene.plane else "ball"
    cuts = (Mark(SymbolForm(symbol, exact_vector(at)), 0, "joint", "") for at in places)
    points = tuple(point for point in scene.points if point[0].startswith(f"{body}."))
    return replace(scene, marks=ordered((*marks, *cuts), ROLES), points=points)


def _belongs(mark: Mark, body: str) -> bool:
    if mark.role in OWN:
        return mark.of == body
    return mark.role in NAMED and mark.of.partition(".")[0] == body


def _spread(scene: Scene, body: str) -> Iterator[Mark]:
    """Loads along lines of a body."""
    motion = scene.system.motion
    for applied in scene.system.loads.applied:
        for load in applied.spread:
            if isinstance(load, SpreadLoad) and load.start[0] == body:
                yield spread_mark(motion, load, applied.name, applied.name)


# -------- virtual ----------------------------------------------------------------------------------------------
# WorkEquation -> picture of a virtual displacement: a structure with one reaction released, moved and back.
#
# Every body is displaced by its part of the velocity plan, to the first order as the principle of virtual work has
# it:
#
#     p -> p + s v,   R -> R + s w x R
#
# so that joints and constraints stay closed exactly; s swings once to each side.

SWING = 0.12  # of the extent, by which the point that moves most is swung out
IN_SIGHT = 0.5  # of the extent: centres of rotation farther outside are not drawn
SOLID = frozenset(("body", "inertia", "member"))
SHARE = "(share of the virtual displacement)"


def swing_of(numbers: SceneNumbers, step: float) -> float:
    """Size of the displacement at which the body that moves most moves by SWING of the picture's extent."""
    drawing = drawing_of(numbers)
    solid = [s.path.reshape(numbers.size, -1) for s in drawing.strokes if s.role in SOLID]
    moved = max((float(np.nanmax(np.abs(path - path[0]))) for path in solid if path.size), default=0.0)
    return SWING * drawing.sizes.extent * step / moved if moved > 0 else 0.0


@dataclass(frozen=True)
class VirtualDisplacement:
    """A structure of which one reaction is released.

    Args:
        structure: as it stands.
        reaction: the one released, with its equation of virtual work.
    """

    structure: Structure
    reaction: StaticReaction

    @property
    def equation(self) -> WorkEquation:
        assert self.reaction.work is not None, "an indeterminate reaction has no displacement"
        return self.reaction.work

    @property
    def moves(self) -> bool:
        """True if the release lets anything move."""
        return bool(self.equation.plan.moving)

    def along(self, phases: np.ndarray) -> SceneNumbers:
        """Frames at phases of the swing; phase 0 is the structure at rest [rad]."""
        step = np.array([0.0, tolerances.WIDE_STEP])
        size = swing_of(SceneNumbers(self.scene, self._frames(step)), tolerances.WIDE_STEP)
        return SceneNumbers(self.scene, self._frames(size * np.sin(phases)))

    @cached_property
    def scene(self) -> Scene:
        """Bodies displaced by the share s, loads that work, the reaction in its positive sense."""
        system = self._displaced
        scene = scene_of_system(system)
        constraints = system.scope.model.constraints
        named = self.reaction.named
        owner = named.owner if named is not None and named.owner in constraints else None
        kept = [m for m in scene.marks if not (m.of == owner and isinstance(m.form, SymbolForm))]
        return replace(scene, marks=(*kept, *self._weights(system), *self._released(system), *self._centers()))

    # -- the bodies ------------------------------------------------------------------------------------

    @property
    def _share(self) -> Node:
        share: Node = self.structure.system.symbols.graph.symbol(SHARE)
        return share

    @cached_property
    def _displaced(self) -> System:
        system = self.equation.plan.system
        links = tuple(replace(link, pose=self._pose(link)) for link in system.motion.links)
        return replace(system, motion=replace(system.motion, links=links))

    def _pose(self, link: BodyLink) -> Pose:
        plan, s, pose = self.equation.plan, self._share, link.pose
        if link.name not in plan.moving:
            return pose
        v, w = plan.raw_velocity((link.name, Vector.ZERO)), plan.raw_spin(link.name)
        axes = [e + s * w.cross(e) for e in pose.R.T]
        return Pose(Matrix.of((axes[0], axes[1], axes[2])).T, pose.p + s * v)

    def _frames(self, shares: np.ndarray) -> np.ndarray:
        system, scene = self._displaced, self.scene
        own = {**system.inputs, SHARE: 0}
        symbols = replace(system.symbols, inputs={**system.symbols.inputs, SHARE: self._share})
        program = Program.of(scene.values, symbols, inputs=own)
        x, inputs = self._numbers(system.symbols.x), self._numbers(tuple(own.values()))
        table = np.tile(inputs, (len(shares), 1))
        table[:, -1] = shares
        p = list(parameters_as_drawn(system).values())
        with np.errstate(all="ignore"):
            found: np.ndarray = RightHandSide.of(program, "numpy").many(0.0, np.tile(x, (len(shares), 1)), p, table)
        return found

    # -- forces ----------------------------------------------------------------------------------------

    def _weights(self, system: System) -> Iterator[Mark]:
        """Arrows of the weights of all bodies with mass."""
        for force in system.loads.applied:
            for load in force.loads:
                if isinstance(load, UniformField):
                    for place, m in SystemScene(system.motion).masses(None):
                        if not is_zero(m):
                            at = system.motion.position(place)
                            yield Mark(ArrowForm(at, m * load.acceleration, "N"), 0, "force", force.name)

    def _released(self, system: System) -> Iterator[Mark]:
        """A unit of the reaction on every body that it acts on, its name at the first."""
        axes, name = Axes(system.motion), self.reaction.name
        text, pulls = name, name.startswith("tension(")
        for effect in self.effects:
            place = axes.masses[effect.link].com if effect.place is None else effect.place
            frame = 0 if axes.plane else effect.link + 1
            at = system.motion.links[effect.link].pose.point(place) if axes.plane else place
            if not all(map(is_zero, effect.force)):
                yield Mark(ArrowForm(at, effect.force, "1", outward=pulls, text=text), frame, "reaction", name)
            elif not all(map(is_zero, effect.couple)):
                yield Mark(CoupleForm(at, effect.couple, text), frame, "reaction", name)
            text = ""

    @property
    def effects(self) -> list[Effect]:
        """Effects of a unit of the reaction, summed once for each body at each place."""
        named, found = self.reaction.named, dict[tuple[int, Vector | None], Effect]()
        for j, k in named.combination.items() if named is not None else ():
            for effect in self.structure.components[j].effects:
                key, more = (effect.link, effect.place), effect.times(k)
                had = found.get(key)
                if had is not None:
                    more = replace(more, force=had.force + more.force, couple=had.couple + more.couple)
                found[key] = more
        return list(found.values())

    def _centers(self) -> Iterator[Mark]:
        """The centres of rotation of the blocks that are in sight, by the blocks' numbers; in the plane."""
        plan, system = self.equation.plan, self.equation.plan.system
        if system.scope.model.space != "plane":
            return
        places = [at for name, at in scene_of_system(system).points]
        spots = np.array(self._numbers([x for place in places for x in place[:2]])).reshape(-1, 2)
        low, high = (spots.min(axis=0), spots.max(axis=0)) if len(spots) else (np.zeros(2), np.zeros(2))
        reach = IN_SIGHT * float(np.max(high - low))
        for numeral, block in plan.numbered_blocks.items():
            place = block.center(plan).place
            if place is None:
                continue
            spot = np.array(self._numbers(place[:2]))
            if np.all(spot > low - reach) and np.all(spot < high + reach):
                yield from center_marks([(numeral, place)])

    def _numbers(self, scalars: Sequence[Scalar]) -> list[float]:
        """Scalars where the structure stands."""
        system = self.equation.plan.system
        known: dict[Node, Any] = {**parameters_as_drawn(system)}
        nodes = system.symbols.x
        at = evaluate([self.structure.at.get(node, 0) for node in nodes], known, FLOAT)
        known |= {system.symbols.t: 0.0, **dict(zip(nodes, at, strict=True))}
        return [float(x) for x in evaluate(scalars, known, FLOAT)]
