"""The steps about the motion of bodies, mechanisms, and points on moving bodies."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from eomgen.documents import (
    Cell,
    Formula,
    Grid,
    Law,
    Name,
    Omitted,
    Piece,
    Prose,
    Side,
    Statement,
    Step,
    axes,
    count,
    prose,
    tabled,
)
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.instant import (
    BodyMotion,
    Centrodes,
    Kinds,
    KinematicState,
    Mechanism,
    Quantities,
    Readable,
)
from eomgen.symbolic.exact import book_form, vanishes
from eomgen.symbolic.expression import Fraction, Node, Scalar, Vector, is_zero, over, sqrt
from eomgen.symbolic.numeric import Work, tolerances
from eomgen.symbolic.print import text_size, to_text

# -------- field steps -----------------------------------------------------------------------------------------
# BodyMotion, Centrodes, Composition -> the steps about the motion of bodies, and the same as plain data.


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
    motions, particles = BodyMotion.all_of(system, state, kinds), particles_of(system)
    bodies = [motion for motion in motions if motion.body not in particles]
    steps = (kinds_step(motions, particles), *fields_step(bodies, shown, plane=system.scope.model.space == "plane"))
    return steps if kinds is None else (*steps, *centrodes_step(kinds.centrodes(), kinds.constants.positive))


def field_payload(system: System, state: Mapping[Node, Scalar], kinds: Kinds | None = None) -> dict[str, Any]:
    """The same for machines: every expression is text of the grammar."""
    found = {} if kinds is None else {each.body: each for each in kinds.centrodes()}
    return {motion.body: _payload(motion, found.get(motion.body)) for motion in BodyMotion.all_of(system, state, kinds)}


def particles_of(system: System) -> tuple[str, ...]:
    """The bodies that are points."""
    bodies = system.scope.model.bodies
    return tuple(name for name, part in bodies.items() if part.shape is not None and part.shape.is_point)


def kinds_step(motions: Sequence[BodyMotion], particles: Iterable[str] = ()) -> Step:
    """Step with the kind of motion of every body over time, and at this state."""
    single = set(particles)
    statements = tuple(Prose(tuple(_sentence(motion, motion.body in single))) for motion in motions)
    return Step("kinds", "Kinds of motion", statements)


def _sentence(motion: BodyMotion, particle: bool) -> Iterator[Piece]:
    kind, now = motion.kind, motion.now
    yield f"{motion.body}: "
    if kind is None:
        yield f"{now} at this instant."
        return
    yield from _of_particle(motion) if particle else _of_kind(motion)
    yield "." if particle or kind.name.endswith(now) or kind.name.startswith(now) else f"; {now} at this instant."


def _of_kind(motion: BodyMotion) -> Iterator[Piece]:
    kind = motion.kind
    assert kind is not None
    yield kind.name
    if kind.point:
        yield f", {kind.point}"
    if kind.at is not None:
        yield from (" at ", *_place(kind.at, 2 if motion.plane else 3))
    if kind.axis is not None and not (is_zero(kind.axis[0]) and is_zero(kind.axis[1])):
        yield from (", across " if kind.name == "plane motion" else ", along ", *_place(kind.axis, 3))
    if kind.is_helical and kind.pitch is not None:
        yield from (", advancing ", _formula(kind.pitch), " per radian")
    yield from _way(motion)


def _of_particle(motion: BodyMotion) -> Iterator[Piece]:
    kind = motion.kind
    assert kind is not None
    if kind.way is None:
        yield "a point at rest" if kind.name == "rest" else "a point that moves"
        return
    words = {"line": "a point on a straight line", "circle": "a point on a circle", "curve": "a point on a curve"}
    yield words[kind.way.kind]
    yield from _way(motion)


def _way(motion: BodyMotion) -> Iterator[Piece]:
    """Words on the direction of a straight path, or the radius of a circular one."""
    way = None if motion.kind is None else motion.kind.way
    if way is None:
        return
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
    yield from tabled(PLACES, [(m.body, *_place_cells(m.center, shown), *_place_cells(m.pole, shown)) for m in moving])
    circles = tuple(row for m in moving for row in _inflection(m, shown))
    if circles:
        words = "The points whose path is straight there lie on the inflection circle, through the centre of rotation:"
        yield prose(words)
        yield from tabled(("body", "centre of the circle: x", "centre of the circle: y", "radius"), circles)


def _inflection(motion: BodyMotion, shown: Shown) -> Iterator[tuple[Cell, ...]]:
    if motion.inflection is not None and not vanishes(motion.inflection[1]):
        yield motion.body, *_place_cells(motion.inflection[0], shown), shown(motion.inflection[1])


def _in_space(moving: Sequence[BodyMotion], shown: Shown) -> Iterator[Statement]:
    rows = [(f"{m.body}, {AXES[i]}", shown(m.field.w[i]), shown(m.field.e[i])) for m in moving for i in range(3)]
    yield from tabled(VECTORS, rows)
    yield prose(
        "The two invariants of the field; the axis of the motion at this instant goes through the point ",
        CENTER,
        " from the origin of the body, the advance along it per radian is omega.v/omega.omega:",
    )
    yield from tabled(INVARIANTS, [(m.body, *map(shown, m.invariants)) for m in moving])


def _place_cells(place: Vector | None, shown: Shown) -> tuple[Cell, Cell]:
    """x and y in two cells; where there is no such point, that."""
    return (NONE, "") if place is None else (shown(place[0]), shown(place[1]))


# -- centrodes -------------------------------------------------------------------------------------


def centrodes_step(found: Sequence[Centrodes], positive: frozenset[Node]) -> tuple[Step, ...]:
    """The curves on which centres of rotation run, and their names where they are simple curves."""
    statements: list[Statement] = []
    for centrodes in found:
        words = f"{centrodes.body}: its centre of rotation in the axes of the ground, and in its own:"
        statements.append(prose(words))
        for of, place in (("", centrodes.fixed), (centrodes.body, centrodes.moving)):
            owner = f"C, {of}" if of else "C"
            statements += [Formula((Name(axis, owner), x)) for axis, x in zip("xy", place, strict=False)]
            if equation := equation_of(centrodes, positive, own=bool(of)):
                statements.append(prose("a ", *equation, "."))
    return (Step("centrodes", "Centrodes", tuple(statements)),) if statements else ()


def equation_of(centrodes: Centrodes, positive: frozenset[Node], *, own: bool) -> tuple[Piece, ...]:
    """A line or circle by its equation, in the ground or in the body's own axes; () of any other curve."""
    curve = centrodes.moving_curve if own else centrodes.fixed_curve
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
    return {"line": ("straight line",), "circle": ("circle",)}.get(curve.kind, ())


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


# -------- relative steps --------------------------------------------------------------------------------------
# Composition -> the steps about the motion of a point on a moving body, and of a particle in a moving frame.
#
# v = v_t + v_r,   a = a_t + a_r + a_C;      m a_r = F - m a_t - m a_C


VELOCITY = Law("v = v_t + v_r, v_t = v_O + omega x r", r"v = v_{t} + v_{r}, \quad v_{t} = v_{O} + \omega \times r")
ACCELERATION = Law(
    "a = a_t + a_r + a_C, a_t = a_O + epsilon x r + omega x (omega x r), a_C = 2*omega x v_r",
    r"a = a_{t} + a_{r} + a_{C}, \quad a_{t} = a_{O} + \varepsilon \times r + \omega \times (\omega \times r), \quad "
    r"a_{C} = 2 \omega \times v_{r}",
)
IN_FRAME = Law("m*a_r = F - m*a_t - m*a_C", r"m a_{r} = F - m a_{t} - m a_{C}")

NAMES = {
    "transport_velocity": Law("v_t", "v_{t}"),
    "relative_velocity": Law("v_r", "v_{r}"),
    "velocity": Law("v", "v"),
    "origin": Law("a_O", "a_{O}"),
    "euler": Law("epsilon x r", r"\varepsilon \times r"),
    "centripetal": Law("omega x (omega x r)", r"\omega \times (\omega \times r)"),
    "transport_acceleration": Law("a_t", "a_{t}"),
    "relative_acceleration": Law("a_r", "a_{r}"),
    "coriolis": Law("a_C", "a_{C}"),
    "acceleration": Law("a", "a"),
}
FORCES = {"m*a_r": Law("m*a_r", "m a_{r}"), "-m*a_O": Law("-m*a_O", "-m a_{O}")}
VELOCITY_PARTS = ("transport_velocity", "relative_velocity", "velocity")
ACCELERATIONS = (
    "origin",
    "euler",
    "centripetal",
    "transport_acceleration",
    "relative_acceleration",
    "coriolis",
    "acceleration",
)
TRANSPORT = "the transport part is that of the point of the body which is passed, O the origin of the body"


def relative_steps(system: System, point: str, body: str, state: Mapping[Node, Scalar]) -> tuple[Step, ...]:
    """The motion of a point in its parts, seen from a body, and a particle's equation of motion in the body's frame.

    Args:
        state: exact scalars in place of coordinates, speeds, accelerations and t; {}: as functions of them.
    """
    readable, letters = Readable.of(system, state), axes(system)
    parts = velocity_parts(system, point, body, readable)
    title = f"{point}, seen from {body}"
    steps = (
        Step(
            "relative velocity",
            f"Velocity of {title}",
            (
                prose(f"In the axes of {body}, ", VELOCITY, f"; {TRANSPORT}:"),
                *_table(parts, VELOCITY_PARTS, letters, readable),
            ),
        ),
        Step(
            "relative acceleration",
            f"Acceleration of {title}",
            (
                prose(f"In the axes of {body}, ", ACCELERATION, ":"),
                *_table(parts, ACCELERATIONS, letters, readable),
            ),
        ),
    )
    owner, _ = system.motion.place(point)
    return (*steps, *_in_frame(system, str(owner), body, readable)) if _is_particle(system, owner, point) else steps


def relative_payload(system: System, point: str, body: str, state: Mapping[Node, Scalar]) -> dict[str, Any]:
    """The parts as texts, axes of the body."""
    parts = velocity_parts(system, point, body, Readable.of(system, state))
    return {"point": point, "body": body, **{name: [to_text(x) for x in vector] for name, vector in parts.items()}}


def velocity_parts(system: System, point: str, body: str, readable: Readable) -> dict[str, Vector]:
    """The parts of velocity and acceleration by name, axes of the body, readable."""
    parts = Quantities(system).parts_of_motion(point, body)
    own = {"relative_velocity": parts.relative[1], "relative_acceleration": parts.relative[2]}
    ground = {name: getattr(parts, name) for name in NAMES if name != "origin"} | {"origin": parts.carrier.a}
    seen = {name: parts.R.T @ x for name, x in ground.items()} | own
    return {name: readable.vector(seen[name]) for name in NAMES}


def _table(
    parts: Mapping[str, Vector], names: tuple[str, ...], letters: str, readable: Readable
) -> tuple[Statement, ...]:
    """The components and the magnitude of each part; side by side where there is room."""
    sizes = {name: readable.scalar(sqrt(parts[name] @ parts[name])) for name in names}
    together = tabled(("", *letters, "magnitude"), [(NAMES[n], *parts[n][: len(letters)], sizes[n]) for n in names])
    if isinstance(together[0], Grid):
        return together
    components = tabled(("", *letters), [(NAMES[n], *parts[n][: len(letters)]) for n in names])
    return (*components, *tabled(("", "magnitude"), [(NAMES[n], sizes[n]) for n in names]))


# -- a particle in a moving frame ------------------------------------------------------------------


def _is_particle(system: System, owner: str | None, point: str) -> bool:
    """True if the point is the mass centre of a particle of the model."""
    part = None if owner is None else system.scope.model.bodies.get(owner)
    if part is None or part.shape is None or not part.shape.is_point:
        return False
    return point.endswith((".center", ".origin")) and not is_zero(system.scope.mass_properties(str(owner)).m)


def _in_frame(system: System, particle: str, body: str, readable: Readable) -> tuple[Step, ...]:
    """m a_r = F - m a_t - m a_C in the axes of the body; F: applied forces and reactions."""
    parts = Quantities(system).parts_of_motion(f"{particle}.origin", body)
    m, letters = system.scope.mass_properties(particle).m, axes(system)
    ground = {
        "applied": applied_force(system, particle),
        "-m*a_O": -m * parts.carrier.a,
        "Euler": -m * parts.euler,
        "centrifugal": -m * parts.centripetal,
        "Coriolis": -m * parts.coriolis,
    }
    forces = {"m*a_r": m * parts.relative[2]}
    forces |= {name: parts.R.T @ x for name, x in ground.items()}
    rows = [(FORCES.get(name, name), *readable.vector(x)[: len(letters)]) for name, x in forces.items()]
    words = (
        f"In the axes of {body}, ",
        IN_FRAME,
        ": F is what is applied, and the reactions of joints and constraints; "
        "of the rest, transport brings the Euler and the centrifugal force.",
    )
    statements: tuple[Statement, ...] = (Prose(words), *tabled(("force", *letters), rows))
    return (Step("moving frame", f"Equation of motion of {particle} in the frame of {body}", statements),)


def applied_force(system: System, body: str) -> Vector:
    """The sum of the forces applied to a body, drives and springs of its joint included, ground axes."""
    motion, loads = system.motion, system.loads
    found = [motion.body_wrench(load) for load in (*loads.placed, *loads.weights)]
    found += [pair for effort in loads.efforts for pair in effort.wrenches(motion)]
    total: Vector = Vector.ZERO
    for each in found:
        if each is not None and each[0] == body:
            total = total + each[1].f
    return motion.link(body).pose.R @ total


# -------- mechanism steps -------------------------------------------------------------------------------------
# System, velocities, accelerations at one instant -> steps: the mechanism, its centres of rotation, how it moves.


LONGEST = 60  # characters of a value in a table
LONGEST_NUMBER = 12
DIGITS = 6


def mechanism_steps(state: KinematicState) -> tuple[Step, ...]:
    """The mechanism; in the plane its centres; spins and velocities; accelerations where they are known."""
    steps = [_mechanism(state)]
    if state.mechanism is not None and state.mechanism.centers:
        steps.append(_centers(state, state.mechanism))
    steps.append(_velocities(state))
    if state.accelerated:
        steps.append(_accelerations(state))
    return tuple(steps)


# -- the mechanism -----------------------------------------------------------------------------------


def _mechanism(state: KinematicState) -> Step:
    number, formula = state.formula
    statements: list[Statement] = [
        prose(
            f"{count(state.degrees_of_freedom, 'degree')} of freedom by the rank of the constraints {state.when}; ",
            f"by count {formula} = {number}" if formula else "",
            "."
            if number == state.degrees_of_freedom
            else ": the count takes constraints for independent that are not."
            if number < state.degrees_of_freedom
            else ": the count does not see what coordinates hold by themselves.",
        )
    ]
    if state.given:
        statements.append(prose("Given: " + ", ".join(state.given) + "."))
    if state.symbol is not None:
        what: tuple[Piece, ...] = ("All velocities are expressed by one: ", state.symbol)
        statements.append(prose(*what, f" = {state.rate}." if state.rate != state.symbol.name else "."))
    statements += _blocks(state)
    return Step("mechanism", "The mechanism", tuple(statements))


def _blocks(state: KinematicState) -> list[Statement]:
    """Bodies that are at rest, and those that move as one."""
    if state.mechanism is None:
        return []
    statements: list[Statement] = []
    for name, bodies in state.mechanism.blocks.items():
        listed = ", ".join(bodies)
        if name == Mechanism.FIXED and bodies:
            whose = "It belongs" if len(bodies) == 1 else "They belong"
            statements.append(prose(f"At rest: {listed}. {whose} to the ground, 0."))
        elif name != Mechanism.FIXED and len(bodies) > 1:
            statements.append(prose(f"{listed} move as one body, called {name}."))
    return statements


# -- centres -----------------------------------------------------------------------------------------


def _centers(state: KinematicState, mechanism: Mechanism) -> Step:
    constraints = state.system.scope.model.constraints
    known = [(pair, each.in_words(constraints)) for pair, each in state.found.items()]
    left = [(pair, "by the velocities") for pair in mechanism.centers if pair not in state.found]
    rows = tuple((mechanism.centers[k].name, *_place_of(state, mechanism, k), how) for k, how in (*known, *left))
    theory = (
        "(0, i) is the point about which body i turns, (i, j) the point at which bodies i and j have one velocity. A "
        "hinge is the centre of its two bodies; a force of a constraint between two bodies passes through theirs; "
        "the three centres of any three bodies are in one line."
    )
    agree = (
        f"The drawing and the velocities DISAGREE on {state.disagreement}."
        if state.disagreement
        else "The velocities below have the same centres."
        if state.found
        else ""
    )
    words = (prose(theory), Grid(("centre", Law.of_letter("x"), Law.of_letter("y"), "where"), rows))
    return Step("centers", "Centres of rotation", (*words, *((prose(agree),) if agree else ())))


def _place_of(state: KinematicState, mechanism: Mechanism, pair: tuple[str, str]) -> tuple[Cell, Cell]:
    """x and y of the centre of a pair; of one at infinity in which direction."""
    center = mechanism.centers[pair]
    x, y, _ = center.point
    if not center.at_infinity:
        return cell(state, x), cell(state, y)
    if is_zero(x):
        return "at infinity", "along y"
    return "at infinity", "along x" if is_zero(y) else f"along (1, {_short_text(state, y)})"


def cell(state: KinematicState, x: Scalar) -> Cell:
    """A value in a table: the formula; the number where that is long, or where only numbers are known."""
    if state.exact and text_size(x) <= (LONGEST if type(x) is Node else LONGEST_NUMBER):
        return x
    number = state.number(x)
    if number is None:
        return x if text_size(x) <= 2 * LONGEST else Omitted(((x,),))
    return (
        f"{0.0 if abs(number) < (tolerances.ZERO_AT_50 if state.exact else tolerances.COMPUTED) else number:.{DIGITS}g}"
    )


def in_numbers(state: KinematicState, step: Step) -> Step:
    """A step in which numbers stand in place of what a state that is known in numbers alone made of the formulas."""
    return Step(step.key, step.title, tuple(_in_numbers(state, statement) for statement in step.statements))


def _in_numbers(state: KinematicState, statement: Statement) -> Statement:
    if isinstance(statement, Grid):
        rows = tuple(tuple(_rounded(state, each) for each in row) for row in statement.rows)
        return Grid(statement.head, rows)
    if isinstance(statement, Formula):
        return Formula(tuple(_law(_rounded(state, side)) for side in statement.sides))
    return statement


def _rounded(state: KinematicState, shown: Cell) -> Cell:
    return cell(state, shown) if isinstance(shown, (int, Fraction, Node)) else shown


def _law(shown: Cell) -> Side:
    return Law(shown, shown) if isinstance(shown, str) else shown


def _short_text(state: KinematicState, x: Scalar) -> str:
    shown = cell(state, x)
    return shown if isinstance(shown, str) else "..." if isinstance(shown, Omitted) else to_text(x)


# -- velocities and accelerations ----------------------------------------------------------------------


def _velocities(state: KinematicState) -> Step:
    sense = "counter-clockwise positive" if state.plane else "ground axes"
    return Step(
        "velocities",
        "Velocities",
        (
            *_spins(state, f"Angular velocities, {sense}:", "omega", {n: f.w for n, f in state.turning.items()}),
            prose("Velocities of points, ground axes:"),
            _vectors(state, "v", [(names, v) for names, _, v, _ in state.points]),
        ),
    )


def _accelerations(state: KinematicState) -> Step:
    shown = replace(state, exact=False) if state.rounded else state
    return Step(
        "accelerations",
        "Accelerations",
        (
            *_spins(shown, "Angular accelerations:", "epsilon", {n: f.e for n, f in state.turning.items()}),
            prose("Accelerations of points, ground axes:"),
            _vectors(shown, "a", [(names, a) for names, _, _, a in state.points if a is not None]),
        ),
    )


def _spins(state: KinematicState, words: str, letter: str, spins: Mapping[str, Vector]) -> tuple[Statement, ...]:
    if not spins:
        return ()
    turns = [(name, state.put(w)) for name, w in spins.items()]
    if state.plane:
        return prose(words), Grid(
            ("body", Law.of_letter(letter)), tuple((name, cell(state, w[2])) for name, w in turns)
        )
    head: tuple[Cell, ...] = ("body", *_components(letter, "xyz"))
    return prose(words), Grid(head, tuple((name, *_cells(state, w, "xyz")) for name, w in turns))


def _vectors(state: KinematicState, letter: str, rows: Sequence[tuple[str, Vector]]) -> Grid:
    axes = "xy" if state.plane else "xyz"
    return Grid(("point", *_components(letter, axes)), tuple((names, *_cells(state, v, axes)) for names, v in rows))


def _components(letter: str, axes: str) -> tuple[Law, ...]:
    """v_x, v_y, |v|: the columns of a vector."""
    size = Law.of_letter(letter)
    return (*(Law.of_letter(f"{letter}_{axis}") for axis in axes), Law(f"|{size.text}|", f"|{size.latex}|"))


def _cells(state: KinematicState, v: Vector, axes: str) -> tuple[Cell, ...]:
    """The components of a vector, and its size."""
    return tuple(cell(state, x) for x in (*v[: len(axes)], state.size(v)))
