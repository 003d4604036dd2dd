"""BodyMotion, Centrodes, Composition -> the steps about the motion of bodies, and the same as plain data."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from eomgen.documents.bounded import tabled
from eomgen.documents.statements import Cell, Formula, Law, Name, Piece, Prose, Statement, Step, prose
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.centrodes import Centrodes, all_centrodes
from eomgen.mechanics.fields.curves import Curve
from eomgen.mechanics.fields.motion_kind import HELICAL, Kind, Kinds
from eomgen.mechanics.instant.body_motion import BodyMotion, body_motions
from eomgen.symbolic.exact.book_form import book_form
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import to_text
from eomgen.symbolic.solve.solving import vanishes

AXES = "xyz"
VELOCITIES = Law(
    "v = v_O + omega x r, a = a_O + epsilon x r + omega x (omega x r)",
    r"v = v_{O} + \omega \times r, \quad a = a_{O} + \varepsilon \times r + \omega \times (\omega \times r)",
)
CENTER = Law("r = omega x v_O/omega^2", r"r = \omega \times v_{O} / \omega^{2}")
POLE = Law(
    "r = (omega^2*a_O + epsilon x a_O)/(omega^4 + epsilon^2)",
    r"r = \left(\omega^{2} a_{O} + \varepsilon \times a_{O}\right) / \left(\omega^{4} + \varepsilon^{2}\right)",
)
NONE = "none"
NUMBERS = ("body", "omega", "epsilon")
PLACES = ("body", "centre: x", "centre: y", "pole: x", "pole: y")
VECTORS = ("body, along", "omega", "epsilon")
INVARIANTS = ("body", "omega.omega", "omega.v")


Shown = Callable[[Scalar], Cell]
"""How a value is written: as its formula, or as its number."""


def field_steps(
    system: System, state: Mapping[Node, Scalar], kinds: Kinds | None = None, shown: Shown = lambda x: x
) -> tuple[Step, ...]:
    """Kinds of motion, spins, centres, poles and slowest points at a state, and centrodes.

    Args:
        state: exact scalars in place of coordinates, speeds, accelerations and t; {}: as functions of them.
        kinds: of the motions in the long run, of which the state is an instant; None: only the instant is known.
    """
    motions, particles = body_motions(system, state, kinds), particles_of(system)
    bodies = [motion for motion in motions if motion.body not in particles]
    steps = (kinds_step(motions, particles), *fields_step(bodies, shown, plane=system.scope.model.space == "plane"))
    return steps if kinds is None else (*steps, *centrodes_step(all_centrodes(kinds), kinds.constants.positive))


def field_payload(system: System, state: Mapping[Node, Scalar], kinds: Kinds | None = None) -> dict[str, Any]:
    """The same for machines: every expression is text of the grammar."""
    found = {} if kinds is None else {each.body: each for each in all_centrodes(kinds)}
    return {motion.body: _payload(motion, found.get(motion.body)) for motion in body_motions(system, state, kinds)}


def particles_of(system: System) -> tuple[str, ...]:
    """The bodies that are points."""
    bodies = system.scope.model.bodies
    return tuple(name for name, part in bodies.items() if part.shape is not None and part.shape.is_point)


def kinds_step(motions: Sequence[BodyMotion], particles: Iterable[str] = ()) -> Step:
    """What kind of motion every body makes in the long run, and at this state."""
    single = set(particles)
    statements = tuple(Prose(tuple(_sentence(motion, motion.body in single))) for motion in motions)
    return Step("kinds", "Kinds of motion", statements)


def _sentence(motion: BodyMotion, particle: bool) -> Iterator[Piece]:
    kind, now = motion.kind, motion.now
    yield f"{motion.body}: "
    if kind is None:
        yield f"{now} at this instant."
        return
    yield from _of_particle(kind) if particle else _of_kind(kind, 2 if motion.plane else 3)
    yield "." if particle or kind.name.endswith(now) or kind.name.startswith(now) else f"; {now} at this instant."


def _of_kind(kind: Kind, axes: int) -> Iterator[Piece]:
    yield kind.name
    if kind.point:
        yield f", {kind.point}"
    if kind.at is not None:
        yield from (" at ", *_place(kind.at, axes))
    if kind.axis is not None and not (is_zero(kind.axis[0]) and is_zero(kind.axis[1])):
        yield from (", across " if kind.name == "plane motion" else ", along ", *_place(kind.axis, 3))
    if kind.name == HELICAL and kind.pitch is not None:
        yield from (", advancing ", _formula(kind.pitch), " per radian")
    if kind.way is not None:
        yield from _way(kind.way)


def _of_particle(kind: Kind) -> Iterator[Piece]:
    if kind.way is None:
        yield "a point at rest" if kind.name == "rest" else "a point that moves"
        return
    words = {"line": "a point on a straight line", "circle": "a point on a circle", "curve": "a point on a curve"}
    yield words[kind.way.kind]
    yield from _way(kind.way)


def _way(way: Curve) -> Iterator[Piece]:
    """Where a straight line runs, which radius a circle has."""
    if way.kind == "line" and way.along is not None:
        yield from (" along ", *_place(way.along))
    if way.kind == "circle" and way.radius is not None:
        yield from (", radius ", _formula(way.radius))


def _formula(x: Scalar) -> Piece:
    """A formula inside a sentence."""
    return x if type(x) is Node else to_text(x)


def _place(place: Vector, least: int = 2) -> tuple[Piece, ...]:
    """(x, y) inside a sentence; the third component where it is there."""
    shown = place if least == 3 or not is_zero(place[2]) else place[:2]
    pieces: list[Piece] = []
    for x in shown:
        pieces += [", " if pieces else "(", _formula(x)]
    return (*pieces, ")")


def fields_step(motions: Sequence[BodyMotion], shown: Shown, *, plane: bool) -> tuple[Step, ...]:
    """Spins, centres and poles of the bodies that move, and the slowest points of bars; () where all rest."""
    moving = [m for m in motions if not all(is_zero(x) for x in (*m.field.w, *m.field.v, *m.field.a, *m.field.e))]
    statements: tuple[Statement, ...] = (
        prose("Every body has one field of velocities and accelerations, ", VELOCITIES, "."),
        *(_in_plane(moving, shown) if plane else _in_space(moving, shown)),
    )
    bars = tuple((f"{m.slowest[0]} to {m.slowest[1]}", shown(m.slowest[2])) for m in moving if m.slowest is not None)
    if bars:
        words = "Of a bar the slowest point is the foot of the perpendicular from the centre of rotation, or an end:"
        statements += (prose(words), *tabled(("bar", "least speed"), bars))
    return (Step("fields", "Angular velocities, centres, poles", statements),) if moving else ()


def _in_plane(moving: Sequence[BodyMotion], shown: Shown) -> Iterator[Statement]:
    yield from tabled(NUMBERS, [(m.body, shown(m.field.w[2]), shown(m.field.e[2])) for m in moving])
    yield prose(
        "From the origin of the body to its centre of rotation ", CENTER, ", to its pole of accelerations ", POLE, ":"
    )
    yield from tabled(PLACES, [(m.body, *_pair(m.center, shown), *_pair(m.pole, shown)) for m in moving])
    circles = tuple(row for m in moving for row in _inflection(m, shown))
    if circles:
        words = "The points whose path is straight there lie on the inflection circle, through the centre of rotation:"
        yield prose(words)
        yield from tabled(("body", "centre of the circle: x", "centre of the circle: y", "radius"), circles)


def _inflection(motion: BodyMotion, shown: Shown) -> Iterator[tuple[Cell, ...]]:
    if motion.inflection is not None and not vanishes(motion.inflection[1]):
        yield motion.body, *_pair(motion.inflection[0], shown), shown(motion.inflection[1])


def _in_space(moving: Sequence[BodyMotion], shown: Shown) -> Iterator[Statement]:
    rows = [(f"{m.body}, {AXES[i]}", shown(m.field.w[i]), shown(m.field.e[i])) for m in moving for i in range(3)]
    yield from tabled(VECTORS, rows)
    yield prose(
        "The two invariants of the field; the axis of the motion at this instant goes through the point ",
        CENTER,
        " from the origin of the body, the advance along it per radian is omega.v/omega.omega:",
    )
    yield from tabled(INVARIANTS, [(m.body, *map(shown, m.invariants)) for m in moving])


def _pair(place: Vector | None, shown: Shown) -> tuple[Cell, Cell]:
    """x and y in two cells; where there is no such point, that."""
    return (NONE, "") if place is None else (shown(place[0]), shown(place[1]))


# -- centrodes -------------------------------------------------------------------------------------


def centrodes_step(found: Sequence[Centrodes], positive: frozenset[Node]) -> tuple[Step, ...]:
    """The curves on which centres of rotation run, and what they are where they are simple."""
    statements: list[Statement] = []
    for centrodes in found:
        words = f"{centrodes.body}: its centre of rotation in the axes of the ground, and in its own:"
        statements.append(prose(words))
        places, curves = (centrodes.fixed, centrodes.moving), (centrodes.fixed_curve, centrodes.moving_curve)
        for of, place, curve in zip(("", f"{centrodes.body}"), places, curves, strict=True):
            owner = f"C, {of}" if of else "C"
            statements += [Formula((Name(axis, owner), x)) for axis, x in zip("xy", place, strict=False)]
            if curve.kind in ("line", "circle"):
                statements.append(prose("a ", *equation_of(curve, positive), "."))
    return (Step("centrodes", "Centrodes", tuple(statements)),) if statements else ()


def equation_of(curve: Curve, positive: frozenset[Node]) -> tuple[Piece, ...]:
    """A line or circle by its equation."""
    if curve.kind == "circle" and curve.at is not None and curve.radius is not None:
        return ("circle about ", *_place(curve.at), ", radius ", _formula(curve.radius))
    if curve.kind == "line" and curve.at is not None and curve.along is not None:
        (x, y, _), (dx, dy, _) = curve.at, curve.along
        if is_zero(dx):
            return ("straight line x = ", _formula(x))
        slope = book_form(over(dy, dx), Work.FORMULA, positive)
        offset = book_form(y - x * slope, Work.FORMULA, positive)
        if is_zero(slope):
            return ("straight line y = ", _formula(offset))
        return ("straight line of slope ", _formula(slope), " through (0, ", _formula(offset), ")")
    return (f"{'straight line' if curve.kind == 'line' else curve.kind}",)


def _payload(motion: BodyMotion, centrodes: Centrodes | None) -> dict[str, Any]:
    kind, field = motion.kind, motion.field
    return {
        "kind": None if kind is None else kind.name,
        "at": _texts(None if kind is None else kind.at),
        "axis": _texts(None if kind is None else kind.axis),
        "pitch": None if kind is None or kind.pitch is None else to_text(kind.pitch),
        "at_instant": motion.now,
        "omega": _texts(field.w),
        "epsilon": _texts(field.e),
        "invariants": [to_text(x) for x in motion.invariants],
        "center": _texts(motion.center),
        "pole": _texts(motion.pole),
        "least_speed": None if motion.slowest is None else to_text(motion.slowest[2]),
        "centrodes": None
        if centrodes is None
        else {"fixed": _texts(centrodes.fixed), "moving": _texts(centrodes.moving)},
    }


def _texts(place: Vector | None) -> list[str] | None:
    return None if place is None else [to_text(x) for x in place]
