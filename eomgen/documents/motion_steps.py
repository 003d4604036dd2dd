"""The first steps of a derivation: the problem, data, degrees of freedom, coordinates, motion, constraints.

System -> the steps about motion: positions, velocities, constraints. A sheet has the first of them, and no answer.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Protocol

from eomgen.documents.bounded import page
from eomgen.documents.document import notation_of
from eomgen.documents.latex import number_latex
from eomgen.documents.reading import Reader
from eomgen.documents.statements import (
    Code,
    Formula,
    Law,
    Meaning,
    Name,
    Piece,
    Prose,
    Rate,
    Side,
    Statement,
    Step,
    Table,
    prose,
    unit_text,
)
from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.constraints import Rank, Row
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import BodyEnergy, BodyLink, Scope
from eomgen.mechanics.start import ExactStart
from eomgen.model import STATEMENT, Coordinate, Model, Output, PointForce, Unit
from eomgen.symbolic.expression import Expression, Graph, Node, Scalar, Vector, is_zero
from eomgen.symbolic.print import to_text

AXES = "xyz"
ALONG = Law(
    "d/dq_k = sum_i N_ik*d/dq_i", r"\frac{\partial}{\partial q_{k}} = \sum_{i} N_{ik} \frac{\partial}{\partial q_{i}}"
)
WITH = Law("N_ik = dq_i'/dq_k'", r"N_{ik} = \frac{\partial \dot{q}_{i}}{\partial \dot{q}_{k}}")
Pair = tuple[Side, Scalar]


def axes(system: System) -> str:
    """The letters of the axes: xy in the plane."""
    return AXES[:2] if system.scope.model.space == "plane" else AXES


def positions_step(system: System, reader: Reader) -> Step:
    """Step with the positions of the mass centres, the angles of the bodies, and the places of given forces."""
    motion = system.motion
    formulas: list[Pair] = []
    for link in motion.links:
        body = system.scope.mass_properties(link.name)
        if not is_zero(body.m):
            at = motion.position((link.name, body.com))
            formulas += component_pairs(system, "", f"{link.name}.center", at)
        if _turns(link):
            formulas.append((Name("angle", link.name), link.angle))  # type: ignore[arg-type]
    for name, point in points_of_forces(system):
        formulas += component_pairs(system, "", name, point)
    angles = ", and the angles of the bodies against the x axis" if any(_turns(link) for link in motion.links) else ""
    return Step("positions", "Positions", (prose(f"The mass centres{angles}:"), *page(reader, formulas)))


def _turns(link: BodyLink) -> bool:
    return isinstance(link.angle, Node)


def component_pairs(system: System, prefix: str, of: str, vector: Vector) -> list[Pair]:
    """One formula for each component; `prefix` is "v" for velocities."""
    return [(Name(prefix + axis, of), x) for axis, x in zip(axes(system), vector, strict=False)]


def points_of_forces(system: System) -> Iterator[tuple[str, Vector]]:
    """(name of the force, where it acts) of every force at a point of a body that has no potential."""
    for force in system.loads.applied:
        if force.potential is None:
            places = [load.place for load in force.loads if isinstance(load, PointForce) and load.place[0] is not None]
            for number, place in enumerate(places, start=1):
                label = force.name if len(places) == 1 else f"{force.name} {number}"
                yield label, system.motion.position(place)


def velocities_step(system: System, reader: Reader, energies: tuple[BodyEnergy, ...]) -> Step:
    """Velocities of the mass centres and angular velocities, by differentiation."""
    formulas: list[Pair] = []
    for energy in energies:
        if not is_zero(system.scope.mass_properties(energy.body).m) and not is_still(energy.velocity):
            of = f"{energy.body}.center"
            formulas += component_pairs(system, "v", of, energy.velocity)
            formulas.append((Name("speed", of, power=2), energy.velocity @ energy.velocity))
        formulas += spins(system, energy.body, energy.spin)
    words = "The derivatives of the positions, and the angular velocities"
    words += ":" if len(axes(system)) == 2 else " about the axes 1, 2, 3 of the bodies:"
    return Step("velocities", "Velocities", (prose(words), *page(reader, formulas)))


def speeds_step(system: System, reader: Reader) -> tuple[Step, ...]:
    """The speeds that are no rates, and the rates of the coordinates in terms of them; no step where there are none."""
    model, scope = system.scope.model, system.scope
    if not model.speeds or system.free is None:
        return ()
    meant = [(u, system.free.scope.names[u.name]) for u in scope.symbols.u if u.name in model.speeds]
    own = {f"{u.name}" for u in scope.symbols.u}
    rates: list[Pair] = [
        (Rate(q), rate)
        for q, rate in zip(scope.symbols.q, scope.rates, strict=True)
        if f"{q.name}'" not in own and not model.coordinates[q.name].driven
    ]
    statements: list[Statement] = [prose("The speeds are combinations of the rates:"), *page(reader, meant)]
    for each in model.quaternions:
        words = f"{', '.join(each.coordinates)} is a unit quaternion, and {', '.join(each.speeds)} "
        statements.append(prose(words, f"is the angular velocity of {each.body} relative to the body that carries it."))
    return (Step("speeds", "Speeds", (*statements, prose("Solved for the rates:"), *page(reader, rates))),)


def is_still(velocity: Vector) -> bool:
    """True where every component is zero."""
    return all(is_zero(x) for x in velocity)


def spins(system: System, body: str, spin: Vector) -> list[Pair]:
    """The angular velocity of a body: one number in the plane; in space its components about the axes of the body.

    They are numbered: omega_x of a body is, wherever it is an output, the component along the ground's axis.
    """
    if len(axes(system)) == 2:
        return [] if is_zero(spin[2]) else [(Name("omega", body), spin[2])]
    if is_still(spin):
        return []
    return [(Name(f"omega_{axis}", body), x) for axis, x in enumerate(spin, start=1)]


def constraints_step(system: System, reader: Reader) -> tuple[Step, ...]:
    """The constraints: those that the coordinates satisfy, the gaps that must stay zero, and the dependent rates."""
    away = [constraint for constraint, mode in system.modes.items() if not mode.closed]
    if not system.constraints.rows and not away:
        return ()
    satisfied = [row for row in system.constraints.rows if row.identical]
    statements: list[Statement] = [
        prose(f"{row.constraint}, row {row.number}: satisfied by the coordinates.") for row in satisfied
    ]
    statements += [prose(f"{constraint}: open at the start, and left out.") for constraint in away]
    held = _held(system)
    if held:
        statements += [prose("These must vanish along the motion:"), *page(reader, held, then=(0,))]
    if system.free is not None and system.elimination is not None:
        statements += _dependent(system, system.free, reader)
    if system.constraints.closing:
        statements.append(_multipliers(system))
    return (Step("constraints", "Constraints", tuple(statements)),)


def _held(system: System) -> list[Pair]:
    """Equation of each constraint row, of its gap or its rate, with every coordinate free."""
    free = system.free or system
    return [_closing(row) for row in free.constraints.closing]


def _dependent(system: System, free: System, reader: Reader) -> list[Statement]:
    """The rates of the dependent coordinates, and the meaning of derivatives from here on."""
    known = dict(zip((q.name for q in system.symbols.q), system.scope.rates, strict=True))
    parts = system.scope.model.coordinates
    solved = [u for u in free.symbols.u if parts[u.name[:-1]].dependent]
    rates: list[Pair] = [(u, known[u.name[:-1]]) for u in solved]
    return [
        prose("Their time derivatives are linear in the rates. Solved for those of the dependent coordinates:"),
        *page(reader, rates),
        prose("Along the motions that the constraints allow, ", ALONG, ", ", WITH, "."),
    ]


def _multipliers(system: System) -> Table:
    named = zip(system.constraints.closing, system.symbols.lam, strict=True)
    rows = tuple(Meaning(lam, f"multiplier of {row.constraint}, row {row.number}") for row, lam in named)
    return Table(("multiplier", "meaning", "unit", ""), rows)


def _closing(row: Row) -> Pair:
    name = _gap_name(row)
    return (name, row.gap) if row.gap is not None else (Rate(name), row.velocity)


def _gap_name(row: Row) -> Name:
    return Name("gap", f"{row.constraint}, {row.number}")


# -------- setting steps ---------------------------------------------------------------------------------------
# System -> the first steps of a derivation: data, degrees of freedom, coordinates.


PARAMETERS = ("parameter", "meaning", "unit", "value")
COORDINATES = ("coordinate", "meaning", "unit", "start")
MOST_VALUES = 8  # of a table, that are printed
INPUTS = ("input", "meaning", "unit", "value")


class Quantified(Protocol):
    """A parameter, coordinate, state or input, in the unit that the user gave it."""

    @property
    def unit(self) -> Unit | None: ...


def setting_steps(system: System) -> tuple[Step, ...]:
    """Data, degrees of freedom, coordinates."""
    return (data_step(system), _freedom(system), _coordinates(system))


def assumption_steps(assumptions: Sequence[str]) -> tuple[Step, ...]:
    """First step, with the assumptions; none where nothing was assumed."""
    reported = tuple(prose(f"{what}.") for what in assumptions)
    return (Step("assumptions", "Assumptions", reported),) if reported else ()


def listed_symbols(symbols: tuple[Node, ...]) -> tuple[Piece, ...]:
    """The symbols, with commas between."""
    pieces: list[Piece] = []
    for symbol in symbols:
        pieces += [", ", symbol] if pieces else [symbol]
    return tuple(pieces)


def count(number: int, noun: str, plural: str = "") -> str:
    """1 coordinate, 2 coordinates."""
    return f"{number} {noun}" if number == 1 else f"{number} {plural or noun + 's'}"


def data_step(system: System) -> Step:
    """Step with the given data."""
    symbols = system.symbols
    return Step("data", "Data", data_tables(system.scope.model, {**symbols.parameters, **symbols.inputs}))


def data_tables(model: Model, symbols: Mapping[str, Node]) -> tuple[Statement, ...]:
    """Tables of the parameters and of the inputs.

    Args:
        symbols: of each of them.
    """
    values = model.exact_parameters()
    rows = []
    for name, part in model.parameters.items():
        rows.append(Meaning(symbols[name], part.about or "", _unit(part), _in_unit(values.get(name), part)))
    statements: list[Statement] = [Table(PARAMETERS, tuple(rows))] if rows else [prose("No parameters.")]
    inputs = tuple(
        Meaning(symbols[name], part.about or "a known function of time", _unit(part), part.value.text)
        for name, part in model.inputs.items()
    )
    if inputs:
        statements.append(Table(INPUTS, inputs))
    statements += [prose(_said_of_table(name, part)) for name, part in model.tables.items()]
    return tuple(statements)


WAYS = {"pchip": "monotone cubics", "linear": "straight lines", "cubic": "a cubic spline"}


def _said_of_table(name: str, table: Any) -> str:
    """A table in words: what it goes through, and how."""
    unit, at_unit = (f" {x}" if x is not None and x.text else "" for x in (table.unit, table.at_unit))
    places, values = (", ".join(f"{float(x):g}" for x in row[:MOST_VALUES]) for row in (table.at, table.values))
    more = ", ..." if len(table.at) > MOST_VALUES else ""
    way = WAYS[table.between]
    return f"{name} is, at {places}{more}{at_unit}: {values}{more}{unit}; between them {way}."


def open_at_rest(system: System) -> list[Statement]:
    """Statement that names the contacts that are open where the system rests; none where all are closed."""
    names = [name for name, mode in system.modes.items() if not mode.closed]
    return [prose(f"Open at rest, without a force: {', '.join(names)}.")] if names else []


def _unit(part: Quantified | None) -> str:
    return "" if part is None or part.unit is None else str(part.unit)


def _in_unit(value: Any, part: Quantified | None) -> str:
    """A value in the unit in which the user gave it."""
    if value is None:
        return ""
    return f"{float(value if part is None or part.unit is None else part.unit.from_si(value, math.pi)):.10g}"


def _freedom(system: System) -> Step:
    """Step with the numbers of coordinates, driven coordinates, constraint rows and degrees of freedom."""
    symbols, closing = system.symbols, system.constraints.closing
    dependent = len(system.scope.dependent)
    driven = sum(part.driven for part in system.scope.model.coordinates.values())
    others = [f"{number} of them {kind}" for number, kind in ((driven, "driven"), (dependent, "dependent")) if number]
    statements: list[Statement] = [
        prose(
            f"{count(len(system.motion.links), 'body', 'bodies')}, {count(len(symbols.q), 'coordinate')}",
            "".join(f", {other}" for other in others),
            ".",
        )
    ]
    identical = [row for row in system.constraints.rows if row.identical]
    if identical:
        constraints = ", ".join(dict.fromkeys(row.constraint for row in identical))
        statements.append(
            prose(
                f"The coordinates satisfy {count(len(identical), 'equation')} of the constraints by themselves "
                f"({constraints}): they carry reactions and take no freedom."
            )
        )
    eliminated = [row for row in system.constraints.rows if row.status == "eliminated"]
    if eliminated:
        constraints = ", ".join(dict.fromkeys(row.constraint for row in eliminated))
        statements.append(
            prose(
                f"{count(len(eliminated), 'equation')} of the constraints ",
                "gives" if len(eliminated) == 1 else "give",
                " the rate of the dependent coordinate"
                if dependent == 1
                else " the rates of the dependent coordinates",
                f" ({constraints}).",
            )
        )
    if closing:
        statements.append(
            prose(
                f"{count(len(closing), 'equation')} of the constraints ",
                "remains to be satisfied by the motion"
                if len(closing) == 1
                else "remain to be satisfied by the motion",
                " and brings a multiplier." if len(closing) == 1 else " and bring a multiplier each.",
            )
        )
    statements += _velocities(system)
    freedom = len(symbols.u) - len(closing)
    independent = ", where the constraints' equations are independent" if closing else ""
    statements.append(prose(f"{count(freedom, 'degree')} of freedom{independent}."))
    return Step("freedom", "Degrees of freedom", tuple(statements))


def _velocities(system: System) -> list[Statement]:
    """Statements on velocity constraints: the holonomic ones with the functions that they hold at zero."""
    try:
        found = Rank((system.free or system).constraints).integrability
    except (
        DerivationError,
        MissingValues,
    ):  # the constraints do not close near the start: whoever needs a state says so
        return []
    statements: list[Statement] = []
    for row in () if found is None else found.rows:
        condition = f"The condition on velocities of '{row.constraint}' (row {row.number}) "
        if not row.integrable:
            statements.append(prose(condition, "cannot be integrated: it restricts no position (Frobenius)."))
        elif row.integral is None:
            statements.append(prose(condition, "can be integrated (Frobenius): it is holonomic."))
        else:
            statements.append(prose(condition, "can be integrated, it is holonomic; with the constant of the start"))
            statements.append(Formula((row.integral, 0)))
    return statements


def _coordinates(system: System) -> Step:
    """Step with the coordinates, their rates and accelerations, and the laws of driven ones."""
    model, symbols, scope = system.scope.model, system.symbols, system.scope
    values = model.exact_parameters()
    begun = _begun(system)
    whole = (system.free or system).symbols
    free = {u.name.removesuffix("'"): (u, a) for u, a in zip(whole.u, whole.a, strict=True)}
    rows: list[Meaning] = []
    for q in symbols.q:
        part = model.coordinates[q.name]
        unit = _unit(part)
        kind = "dependent coordinate" if part.dependent else "coordinate"
        guessed = part.dependent and part.near is not None
        start = f"near {_start(part, part.near, values)}" if guessed else _start(part, part.start, values)
        start = begun.get(q.name, start)
        rows.append(Meaning(q, part.about or kind, unit, start))
        if q.name in free:
            u, a = free[q.name]
            speed = "" if part.dependent else _start(part, part.speed, values)
            rows.append(Meaning(u, "its rate", unit_per(unit, "s"), begun.get(u.name, speed)))
            if part.dependent or u in symbols.u:
                rows.append(Meaning(a, "its acceleration", unit_per(unit, "s^2")))
        for x in (x for x in scope.laws if x.name.rstrip("'") == q.name):
            second = x.name.endswith("''")
            what = "its acceleration, as given" if second else "its rate, as given"
            rows.append(Meaning(x, what, unit_per(unit, "s^2" if second else "s")))
    rows += _speeds(system, begun)
    for z in symbols.z:
        state = model.states[z.name]
        start = "0" if state.start is None else start_shown(state.start, values, state)
        rows.append(Meaning(z, state.about or "state of first order", _unit(state), start))
        rows.append(Meaning(Rate(z), "its rate", unit_per(_unit(state), "s")))
    rows.append(Meaning(symbols.t, "time", "s"))
    statements: list[Statement] = [Table(COORDINATES, tuple(rows))]
    driven: list[Statement] = []
    for q, rate in zip(symbols.q, scope.rates, strict=True):
        if q.name not in free:
            driven += _as_given(scope, q, rate)
    if driven:
        statements += [prose("Driven coordinates move as given:"), *driven]
    return Step("coordinates", "Coordinates", tuple(statements))


def states_step(system: System, reader: Reader, in_letters: Mapping[Node, Scalar]) -> tuple[Step, ...]:
    """The rates of the states of first order; no step where there are none.

    Args:
        in_letters: the rates in which reactions stand, with the symbols of these.
    """
    scope = system.scope
    if not scope.symbols.z:
        return ()
    rates: list[Pair] = [(Rate(z), rate) for z, rate in zip(scope.symbols.z, scope.state_rates, strict=True)]
    several = len(rates) > 1
    words = (
        "The states of first order change as declared:" if several else "The state of first order changes as declared:"
    )
    declared: list[Statement] = [prose(words)]
    if scope.reactions_in_rates:
        lettered = page(reader, [(Rate(z), rate) for z, rate in in_letters.items()])
        by_balance = prose("With the reactions by the balance of forces and moments of every body:")
        declared = [*(declared if lettered else ()), *lettered, by_balance]
    return (Step("states", "States of first order", (*declared, *page(reader, rates))),)


def _as_given(scope: Scope, q: Node, rate: Scalar) -> list[Statement]:
    """Law of a driven coordinate: formulas, or the samples through which it passes."""
    part = scope.model.coordinates[q.name]
    of = {"": part.motion, "The rate of ": part.rate, "The acceleration of ": part.acceleration}
    for what, law in of.items():
        if law is not None and law.sampled is not None:
            return [prose(what, q, f" is {law.text}.")]
    motion = [] if part.motion is None else [Formula((q, scope.value(part.motion)))]
    laws = {x.name: law for x, law in scope.laws.items()}
    second = [Formula((scope.names[name], laws[name]))] if (name := f"{q.name}''") in laws else []
    return [*motion, Formula((Rate(q), laws.get(f"{q.name}'", rate))), *second]


def _begun(system: System) -> dict[str, str]:
    """Start, in words, of each coordinate and speed that was changed so that the constraints hold, by name."""
    start = ExactStart(system)
    try:
        moved = start.moved
    except (DerivationError, MissingValues):  # the constraints do not close there: whoever needs a state says so
        return {}
    coordinates, reported = system.scope.model.coordinates, dict[str, str]()
    for x in (x for x in system.symbols.x if x.name in moved):
        part = coordinates.get(x.name.removesuffix("'"))
        if start.numbers:
            reported[x.name] = _in_unit(start.numbers[x], part)
        elif x in start.exact:
            reported[x.name] = to_text(start.exact[x])
    return reported


def _speeds(system: System, begun: Mapping[str, str]) -> list[Meaning]:
    """The speeds that are no rates, and their derivatives."""
    model, symbols = system.scope.model, system.symbols
    values = model.exact_parameters()
    rows: list[Meaning] = []
    for u, a in zip(symbols.u, symbols.a, strict=True):
        if u.name in model.speeds:
            part = model.speeds[u.name]
            start = begun.get(u.name, "" if part.start is None else start_shown(part.start, values, None))
            rows += [Meaning(u, part.about or "speed", "", start), Meaning(a, "its derivative", "")]
    return rows


def unit_per(unit: str, time: str) -> str:
    """A unit per second: rad/s."""
    return "" if not unit else f"{unit}/{time}" if "/" not in unit else f"({unit})/{time}"


def _start(part: Coordinate, expression: Expression | None, values: Mapping[str, Any]) -> str:
    """A start value in the user's unit, "0" where none is given."""
    if expression is None:
        return "" if part.driven else "0"
    return start_shown(expression, values, part)


def start_shown(expression: Expression, values: Mapping[str, Any], part: Quantified | None) -> str:
    """A value in the unit of a coordinate, else in SI; an expression of parameters without values as text."""
    if expression.names <= values.keys() | {"pi"}:
        return _in_unit(expression.evaluate({**values, "pi": math.pi}), part)
    return expression.text


def moved_coordinates(system: System) -> tuple[Node, ...]:
    """The coordinate of each speed; of a speed that is no rate the speed itself."""
    rates = {f"{q.name}'": q for q in system.symbols.q}
    return tuple(rates.get(u.name, u) for u in system.symbols.u)


# -------- sheet ------------------------------------------------------------------------------------------------
# Model -> the parts of a sheet that hold no answer: the problem in words, the given data, the questions.

ROOM = 6  # cm to write the answer of one output in
_PARAGRAPHS = re.compile(r"\n\s*\n")


def statement_step(model: Model) -> Step:
    """Step with the words of the problem; without statements where the model has none."""
    texts = (paragraph for text in model.text or () for paragraph in _PARAGRAPHS.split(text.strip()))
    return Step("statement", "", tuple(_said(model, text) for text in texts if text.strip()))


def given_step(model: Model) -> Step:
    """Step with what the file declares: parameters, inputs, and the coordinates with their starts and laws."""
    graph = Graph()
    symbols = {name: graph.symbol(name) for name in (*model.parameters, *model.inputs, *model.coordinates)}
    statements: list[Statement] = [*data_tables(model, symbols)]
    rows: list[Meaning] = []
    for name, part in model.coordinates.items():
        unit = "" if part.unit is None else str(part.unit)
        rates = graph.symbol(f"{name}'"), graph.symbol(f"{name}''")
        laws = ((symbols[name], part.motion), (rates[0], part.rate), (rates[1], part.acceleration))
        rows += [Meaning(x, part.about or "", unit, f"= {law.text}") for x, law in laws if law is not None]
        if not part.driven and not part.dependent:
            rows += _started(model, name, part, unit)
    if rows:
        statements.append(Table(COORDINATES, tuple(rows)))
    return Step("data", "Data", tuple(statements))


def _started(model: Model, name: str, part: Coordinate, unit: str) -> Iterator[Meaning]:
    """Rows of a coordinate and of its rate, as far as something is said of them."""
    graph, values = Graph(), model.exact_parameters()
    if part.about or part.start is not None:
        start = "" if part.start is None else start_shown(part.start, values, part)
        yield Meaning(graph.symbol(name), part.about or "", unit, start)
    if part.speed is not None:
        yield Meaning(graph.symbol(f"{name}'"), "its rate", unit_per(unit, "s"), start_shown(part.speed, values, part))


def question_steps(model: Model, *, room: bool = False) -> tuple[Step, ...]:
    """A step for each question, numbered; where the file has none in words, for each output.

    Args:
        room: to write the answer in.
    """
    if model.questions:
        asked = [(_said(model, each.text).pieces, len(each.outputs or ("",))) for each in model.questions]
    else:
        asked = [(tuple(_of_output(model, name, output)), 1) for name, output in model.outputs.items()]
    return tuple(
        Step(f"question_{k}", "", (Prose((f"{k}. ", *pieces)),), room=ROOM * count if room else 0)
        for k, (pieces, count) in enumerate(asked, start=1)
    )


def _of_output(model: Model, name: str, output: Output) -> Iterator[Piece]:
    """The question that an output asks: its letter, its meaning, the function, the instant."""
    yield "Find "
    yield Law.of_letter(name) if output.symbol is None else Law(name, output.symbol.tex)
    if output.about is not None and "=" not in output.about:
        yield f", {output.about}"
    if output.value.calls:  # a formula without one may be an answer
        yield ": "
        yield Code(output.value.text)
    if output.rests:
        yield " at equilibrium"
    elif output.at is not None:
        yield " at "
        yield Code(output.at.text)
    yield "."


SAID_ALREADY = ("=", r"\approx", "≈")  # what stands before a value whose letter the author wrote


def _said(model: Model, text: str) -> Prose:
    """A paragraph of a problem: words, formulas, and declared names with their values."""
    pieces: list[Piece] = []
    end = 0
    for found in STATEMENT.finditer(text):
        pieces.append(_words(text[end : found.start()]))
        end = found.end()
        if found["math"] is not None:
            pieces.append(Law(found["math"].strip(), found["math"].strip()))
        elif found["name"] is not None:
            named = text[: found.start()].rstrip(" \n$").endswith(SAID_ALREADY)
            pieces.append(_valued(model, found["name"].strip(), letter=not named))
        else:
            pieces.append(found["plain"] or found[0])
    pieces.append(_words(text[end:]))
    return prose(*_joined(pieces))


def _words(text: str) -> str:
    """Words with one blank between them, those at the ends kept."""
    return re.sub(r"\s+", " ", text)


def _joined(pieces: list[Piece]) -> Iterator[Piece]:
    """The pieces without empty ones; words that follow one another as one, without blanks at the ends of all."""
    found: list[Piece] = []
    for piece in pieces:
        if isinstance(piece, str) and found and isinstance(found[-1], str):
            found[-1] += piece
        elif piece != "":
            found.append(piece)
    for k, piece in enumerate(found):
        text = piece.lstrip() if isinstance(piece, str) and k == 0 else piece
        yield text.rstrip() if isinstance(text, str) and k == len(found) - 1 else text


def _valued(model: Model, name: str, *, letter: bool = True) -> Law:
    """name = value unit, of a parameter, an input, the start of a coordinate or of its rate.

    Args:
        letter: the name stands before its value.
    """
    bare, values = name.rstrip("'"), model.exact_parameters()
    tables: tuple[Mapping[str, Any], ...] = (model.parameters, model.inputs, model.coordinates)
    part = next(table[bare] for table in tables if bare in table)
    value = (part.speed if name != bare else part.start) if isinstance(part, Coordinate) else part.value
    unit = "" if part.unit is None else str(part.unit)
    unit = unit_text(unit_per(unit, "s") if name != bare else unit)
    tex = notation_of(model).latex(name)
    if value is None:
        return Law(name, tex)
    before, number = (f"{name} = ", f"{tex} = ") if letter else ("", ""), start_shown(value, values, part)
    if unit == "deg":
        return Law(f"{before[0]}{number}°", rf"{before[1]}{number_latex(number)}^{{\circ}}")
    number = f"{number} {unit}".strip()
    return Law(f"{before[0]}{number}", f"{before[1]}{number_latex(number)}")
