"""System, velocities, accelerations at one instant -> steps: the mechanism, its centres of rotation, how it moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from eomgen.documents.latex_names import letter_law
from eomgen.documents.setting_steps import count
from eomgen.documents.statements import Cell, Formula, Grid, Law, Omitted, Piece, Side, Statement, Step, prose
from eomgen.mechanics.instant.construction import POINT, FoundPoint, LineOf, PointPair
from eomgen.mechanics.instant.kinematic_state import KinematicState
from eomgen.mechanics.instant.mechanism import FIXED, Mechanism, RotationCenter
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.numeric.tolerances import COMPUTED, ZERO_AT_50
from eomgen.symbolic.print.text import text_size, to_text

LONGEST = 60  # characters of a value in a table
LONGEST_NUMBER = 12
DIGITS = 6
PUSHES = {
    "n": "the normal through '{}'",
    "tension": "the line of '{}'",
    "t": "the line of contact of '{}'",
    "couple": "the line at infinity, as '{}' lets nothing turn",
    POINT: "the line at infinity, as '{}' is a point that does not turn",
}


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
            f"{count(state.freedoms, 'degree')} of freedom by the rank of the constraints {state.when}; ",
            f"by count {formula} = {number}" if formula else "",
            "."
            if number == state.freedoms
            else ": the count takes constraints for independent that are not."
            if number < state.freedoms
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
        if name == FIXED and bodies:
            whose = "It belongs" if len(bodies) == 1 else "They belong"
            statements.append(prose(f"At rest: {listed}. {whose} to the ground, 0."))
        elif name != FIXED and len(bodies) > 1:
            statements.append(prose(f"{listed} move as one body, called {name}."))
    return statements


# -- centres -----------------------------------------------------------------------------------------


def _centers(state: KinematicState, mechanism: Mechanism) -> Step:
    known = [(mechanism.centers[pair], how_found(state, each)) for pair, each in state.found.items()]
    left = [(center, "by the velocities") for pair, center in mechanism.centers.items() if pair not in state.found]
    rows = tuple((center.name, *place_cells(state, center), how) for center, how in (*known, *left))
    theory = (
        "(0, i) is the point about which body i turns, (i, j) the point at which bodies i and j have one velocity. A "
        "hinge is the centre of its two bodies; a force that a tie can bear between two bodies passes through theirs; "
        "the three centres of any three bodies are in one line."
    )
    agree = (
        f"The drawing and the velocities DISAGREE on {state.disagreement}."
        if state.disagreement
        else "The velocities below have the same centres."
        if state.found
        else ""
    )
    words = (prose(theory), Grid(("centre", letter_law("x"), letter_law("y"), "where"), rows))
    return Step("centers", "Centres of rotation", (*words, *((prose(agree),) if agree else ())))


def place_cells(state: KinematicState, center: RotationCenter) -> tuple[Cell, Cell]:
    """x and y; of a centre at infinity in which direction."""
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
    return f"{0.0 if abs(number) < (ZERO_AT_50 if state.exact else COMPUTED) else number:.{DIGITS}g}"


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


def how_found(state: KinematicState, found: FoundPoint) -> str:
    """Why the centre is there."""
    if found.same:
        return " and ".join(map(_pair, found.same)) + " are at one point"
    if found.hinge and not is_zero(found.point[2]):
        return f"{_called(state, found.hinge)} holds the point"
    owners = [line.owner for line in found.lines]
    if owners[0] and owners[0] == owners[1]:
        return f"{_called(state, owners[0])} only lets slide"
    return "; ".join(map(_line, found.lines))


def _called(state: KinematicState, owner: str) -> str:
    """A tie, or the joint of a body."""
    return f"'{owner}'" if owner in state.system.scope.model.constraints else f"the joint of '{owner}'"


def _line(line: LineOf) -> str:
    if line.through is not None:
        return "in line with " + " and ".join(map(_pair, line.through))
    return "on " + PUSHES.get(line.kind.split(" ")[0], "the line of the force of '{}'").format(line.owner)


def _pair(pair: PointPair) -> str:
    return f"({pair[0]}, {pair[1]})"


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
        return prose(words), Grid(("body", letter_law(letter)), tuple((name, cell(state, w[2])) for name, w in turns))
    head: tuple[Cell, ...] = ("body", *_components(letter, "xyz"))
    return prose(words), Grid(head, tuple((name, *_cells(state, w, "xyz")) for name, w in turns))


def _vectors(state: KinematicState, letter: str, rows: Sequence[tuple[str, Vector]]) -> Grid:
    axes = "xy" if state.plane else "xyz"
    return Grid(("point", *_components(letter, axes)), tuple((names, *_cells(state, v, axes)) for names, v in rows))


def _components(letter: str, axes: str) -> tuple[Law, ...]:
    """v_x, v_y, |v|: the columns of a vector."""
    size = letter_law(letter)
    return (*(letter_law(f"{letter}_{axis}") for axis in axes), Law(f"|{size.text}|", f"|{size.latex}|"))


def _cells(state: KinematicState, v: Vector, axes: str) -> tuple[Cell, ...]:
    """The components of a vector, and its size."""
    return tuple(cell(state, x) for x in (*v[: len(axes)], state.size(v)))
