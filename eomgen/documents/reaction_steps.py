"""The kineto-static steps: each body cut free, and its reactions.

Reactions -> the step that gives them: each as an expression, indeterminate ones with their free components.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import islice

from eomgen.documents import motion_steps
from eomgen.documents.bounded import FULL
from eomgen.documents.energy_steps import twists_step, while_words
from eomgen.documents.equation_steps import EquationSteps, equations_of, sides_of
from eomgen.documents.motion_steps import Pair, count, listed_symbols
from eomgen.documents.reaction_values import Lettered, Readings, lettered, readings_of, shown_system
from eomgen.documents.reading import LONGEST, TRIED, Reader, free_names, length_in_print
from eomgen.documents.statements import Code, Formula, Law, Meaning, Name, Omitted, Prose, Statement, Step, Table, prose
from eomgen.errors import DerivationError
from eomgen.mechanics.dynamics import EquationsOfMotion, System, derived_by
from eomgen.mechanics.free_bodies import BodyEquation, Reactions
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.integrals import rates_and_extent
from eomgen.mechanics.start import ExactStart
from eomgen.model import called
from eomgen.symbolic.exact import book_form
from eomgen.symbolic.expression import Node, Scalar, depends_on, is_zero, order, substituted
from eomgen.symbolic.numeric import Work
from eomgen.symbolic.print import terms, text_size

PAGE = 6000  # characters of all reactions in print
CLEARER = 1.5  # times as long as without accelerations: then the form with them is left out
SHORT = 240  # characters of a reaction in which no acceleration is left
VERB = Code("eomgen reactions MODEL")


def letters_of(system: System) -> Lettered | str:
    """The reactions of a system with their symbols, or why they cannot be derived."""
    try:
        return lettered(Reactions.of(shown_system(system), short=True), system.scope.names)
    except DerivationError as error:
        return f"{error.what}; {error.fix}" if error.fix else error.what


def rates_in_letters(system: System, letters: Lettered | str) -> dict[Node, Scalar]:
    """The rates of states in which reactions stand, with the symbols of these; none where friction depends on them."""
    scope = system.scope
    if isinstance(letters, str) or letters.contacts or not scope.reactions_in_rates:
        return {}
    by_components, symbols = letters.reactions.by_components
    quantities = Quantities(letters.balance.system, balance=by_components)
    known = dict(zip(symbols, letters.symbols, strict=True))
    found: dict[Node, Scalar] = {}
    for z in scope.symbols.z:
        law = scope.model.states[z.name].rate
        if law is not None and law.all_calls:
            found[z] = substituted((law.evaluate(scope.names, quantities.value),), known)[0]
    return found


def reactions_step(
    equations: EquationsOfMotion, reader: Reader, letters: Lettered | str, *, table: bool
) -> tuple[Step, ...]:
    """Every reaction; no step where nothing is held.

    Args:
        table: the meanings of the symbols stand here, and not in a step before.
    """
    if isinstance(letters, str):
        return (Step("reactions", "Reactions", (prose(f"The reactions do not follow: {letters}."),)),)
    if not letters.symbols:
        return ()
    formulas, left_out = _formulas(readings_of(equations, reader, free=True), letters)
    shown = {formula.sides[0] for formula in formulas} | {
        symbol
        for c, symbol in zip(letters.balance.components, letters.symbols, strict=True)
        if c in letters.reactions.indeterminate
    }
    statements: list[Statement] = [letters.table(shown)] if table and shown else []
    if formulas:
        statements += [prose("From the balance of forces and moments of every body:"), *formulas]
    if left_out:
        statements.append(_too_long(left_out, bool(formulas)))
    statements += _open(reader, letters)
    return (Step("reactions", "Reactions", tuple(statements)),) if statements else ()


def _too_long(number: int, after: bool) -> Prose:
    more = f"{number} more" if after else "All of them" if number > 1 else "It"
    return prose(
        f"{more} {'are' if number > 1 else 'is'} too long to print here: ",
        VERB,
        " evaluates them, ",
        Code("eomgen codegen MODEL"),
        " gives them as code.",
    )


def _formulas(readings: Readings, letters: Lettered) -> tuple[list[Formula], int]:
    """(the formulas of as many reactions as a reader can take, the number of further ones)."""
    kept: list[Formula] = []
    length, left_out = 0, 0
    with_friction = {contact.component for contact in letters.contacts}  # these stand in the step of friction
    for j, symbol in enumerate(letters.symbols):
        if j in with_friction or not letters.reactions.solution.determined(j):
            continue
        sides = _sides(readings, j) if readings.reader.full or length < PAGE else []
        if sides:
            kept.append(Formula((symbol, *sides)))
            length += sum(map(text_size, sides))
        else:
            left_out += 1
    return kept, left_out


def _sides(readings: Readings, j: int) -> list[Scalar]:
    """A reaction with accelerations, and without them where that is short; [] where both are too long."""
    with_a, without = readings.with_accelerations({j: 1}), readings.without({j: 1})
    too_long = not readings.reader.full and text_size(with_a) > LONGEST
    if without is None or length_in_print(without) > SHORT:
        return [] if too_long else [with_a]
    if too_long or length_in_print(with_a) > CLEARER * length_in_print(without) + SHORT // 4:
        return [without]
    return [without] if with_a is without else [with_a, without]


# -- along the motion from the start ----------------------------------------------------------------


def along_the_motion(equations: EquationsOfMotion, reader: Reader, letters: Lettered) -> tuple[Step, ...]:
    """The reactions as functions of the coordinates alone, where first integrals give the speeds and that is short."""
    if equations.system.free is not None:
        return ()
    readings = readings_of(equations, reader)
    accelerations, positive = readings.accelerations, readings.system.scope.positive
    start = _start(equations.system) if accelerations else None
    if start is None:
        return ()
    by_integrals = rates_and_extent(equations, start, accelerations=tuple(accelerations.values()))
    if by_integrals is None or sum(text_size(x) for x in by_integrals[0].values()) > TRIED:
        return ()
    rates, held = by_integrals
    known, u = rates, tuple(rates)
    squares = [(u * u, book_form(x * x, Work.ENTRY, positive)) for u, x in rates.items()]
    formulas: list[Statement] = []
    with_friction = {contact.component for contact in letters.contacts}  # these stand in the step of friction
    for j, symbol in enumerate(letters.symbols):
        if j in with_friction or not letters.reactions.solution.determined(j):
            continue
        values = [x for way in readings.own_ways if depends_on(x := way.value(j), u)]
        found = readings.replaced(values, lambda x: substituted(substituted((x,), accelerations), known)[0])
        if found is not None and not depends_on(found, u) and _is_clear(found):
            formulas.append(Formula((symbol, found)))
    if not formulas:
        return ()
    words = prose("The motion from the start has, by its first integrals", *while_words(held), ",")
    then = prose("so that along it the reactions are functions of the coordinates:")
    statements = (words, *map(Formula, squares), then, *formulas)
    return (Step("along", "Reactions along the motion from the start", statements),)


def _is_clear(x: Scalar) -> bool:
    """True if the formula is short and has no root, whose sign would depend on the sense of the motion."""
    return length_in_print(x) <= SHORT and all(node.op != "sqrt" for node in order((x,)))


def _start(system: System) -> dict[Node, Scalar] | None:
    """q and u at the start, as every verb takes them; None where it is not known, or a coordinate is driven."""
    driven = any(part.driven for part in system.scope.model.coordinates.values())
    return None if driven else ExactStart(system).known


# -- what is indeterminate -------------------------------------------------------------------------


def _open(reader: Reader, letters: Lettered) -> list[Statement]:
    """The reactions that rigid bodies leave open, and the self-stresses that may be added to them."""
    reactions = letters.reactions
    if not reactions.indeterminate:
        return []
    symbol = dict(zip((c.name for c in reactions.components), letters.symbols, strict=True))
    names = listed_symbols(tuple(symbol[c.name] for c in reactions.indeterminate))
    one = len(reactions.indeterminate) == 1
    words = (
        *names,
        f" {'is' if one else 'are'} statically indeterminate: rigid bodies in balance leave ",
        f"{'it' if one else 'them'} open. To all of these at once may be added, with any number k, without a trace:",
    )
    statements: list[Statement] = [Prose(words)]
    spaces = reactions.null_space
    factors = _factors(reactions, letters, len(spaces))
    statements.append(
        Table(
            ("symbol", "meaning", "unit", ""),
            tuple(Meaning(k, "any number: an inner stress that rigid bodies do not show") for k in factors),
        )
    )
    for k, space in zip(factors, spaces, strict=True):
        statements += _shares(reader, symbol, k, space)
    return statements


def _factors(reactions: Reactions, letters: Lettered, number: int) -> list[Node]:
    """k, or k1, k2, ..."""
    scope = reactions.balance.system.scope
    names = free_names("k", scope.names, letters.names)
    if number == 1 and "k" not in scope.names and "k" not in letters.names:
        names = iter(["k"])
    return [scope.graph.symbol(name) for name in islice(names, number)]


def _shares(reader: Reader, symbol: Mapping[str, Node], k: Node, space: Mapping[str, Scalar]) -> Sequence[Statement]:
    """Delta of each reaction = coefficient * k."""
    formulas: list[Statement] = []
    left_out = 0
    for name, coefficient in space.items():
        if is_zero(coefficient):
            continue
        shown = reader.shown(coefficient)
        if isinstance(shown, Omitted):
            left_out += 1
        else:
            formulas.append(Formula((Name("Delta", by=symbol[name]), shown * k)))
    if left_out:
        formulas.append(prose(f"{count(left_out, 'more share')} with {k.name} too long to print here."))
    return formulas


# -------- balance steps ---------------------------------------------------------------------------------------
# Balance -> the kineto-static steps: each body cut free, with its reactions, applied forces and inertia.
#
# F_in = -m a_C,  M_in = -d(I omega)/dt;   sum F + F_in = 0,  sum M_C + M_in = 0


BOOK = 12_000  # characters of the equations of all bodies together

INERTIA = Law(
    "F_in = -m*a, M_in = -d/dt(I*omega)",
    r"F^{\mathrm{in}} = -m a, \quad M^{\mathrm{in}} = -\frac{d}{dt} \left(I \omega\right)",
)
DALEMBERT = Law(
    "sum F + F_in = 0, sum M + M_in = 0", r"\sum F + F^{\mathrm{in}} = 0, \quad \sum M + M^{\mathrm{in}} = 0"
)
LETTERS = ("Fin_x", "Fin_y", "Fin_z", "Min_x", "Min_y", "Min_z")


def reactions_table_step(letters: Lettered) -> Step:
    """The unknown reactions by name, against the number of equations."""
    balance = letters.balance
    bodies, n = len(balance.system.motion.links), len(balance.components)
    words = (
        f"{count(bodies, 'body', 'bodies')} cut free give{'s' if bodies == 1 else ''} "
        f"{count(len(balance.equations), 'equation')} for {count(n, 'reaction')} and the motion."
    )
    if not n:
        return Step(
            "unknowns", "Unknown reactions", (prose("Nothing reacts: no body is held by joints or constraints."),)
        )
    return Step("unknowns", "Unknown reactions", (prose(words), letters.table()))


def body_steps(reader: Reader, letters: Lettered) -> tuple[Step, ...]:
    """Step of each body, with its inertia force and couple and its equations; as many bodies as a reader can take."""
    by_body: dict[str, list[BodyEquation]] = {}
    for equation in letters.balance.equations:
        by_body.setdefault(equation.body, []).append(equation)
    plane = letters.balance.system.scope.model.space == "plane"
    steps: list[Step] = []
    room = BOOK
    for number, (body, equations) in enumerate(by_body.items()):
        if room <= 0 and not reader.full:
            steps.append(_others(len(by_body) - number))
            break
        step, length = _body(reader, letters, body, equations, plane=plane)
        room -= length
        steps.append(step)
    return tuple(steps)


def _others(number: int) -> Step:
    words = f"{count(number, 'body', 'bodies')} more, each likewise: too long to print here; "
    return Step("bodies", "The other bodies", (prose(words, FULL, " prints them."),))


def _body(
    reader: Reader, letters: Lettered, body: str, equations: Sequence[BodyEquation], *, plane: bool
) -> tuple[Step, int]:
    """One body cut free, and its length in print."""
    inertia: list[Pair] = [(_inertia_name(e, plane), -e.inertia) for e in equations if not is_zero(e.inertia)]
    statements: list[Statement] = []
    length = 0
    if inertia:
        where = "" if plane else ", in the axes of the body"
        statements.append(prose("Inertia force and couple at the mass centre, ", INERTIA, f"{where}:"))
        for name, value in inertia:
            shown = reader.shown(value)
            statements.append(Formula((name, shown)))
            length += 0 if isinstance(shown, Omitted) else text_size(shown)
    words = "" if inertia else "No inertia force and no inertia couple. "
    words += "Everything on it is in balance, moments about the mass centre, "
    statements.append(prose(words, DALEMBERT, ":"))
    for equation in equations:
        total = _balanced(reader, letters, equation)
        statements.append(Formula((total, 0)))
        length += 0 if isinstance(total, Omitted) else text_size(total)
    title = called(body).capitalize().split()[0] + f" {body}"
    return Step(f"body_{body}", title, tuple(statements)), length


def _inertia_name(equation: BodyEquation, plane: bool) -> Name:
    letter = LETTERS[equation.direction]
    return Name("Min" if plane and letter == "Min_z" else letter, equation.body)


def _balanced(reader: Reader, letters: Lettered, equation: BodyEquation) -> Scalar | Omitted:
    """sum of coefficients * reactions + applied - inertia, each readable; or its size."""
    parts: list[tuple[Scalar | Omitted, Scalar]] = [(reader.shown(c), s) for s, c in _terms(letters, equation)]
    parts += [(reader.shown(given), 1) for given in (equation.applied, -equation.inertia)]
    long = tuple(part for shown, _ in parts if isinstance(shown, Omitted) for part in shown.parts)
    if long:
        return Omitted(long)
    total: Scalar = 0
    for shown, symbol in parts:
        assert not isinstance(shown, Omitted)
        for c, term in [(shown, symbol)] if type(symbol) is Node else terms(shown):
            total = total + c * (1 if term is None else term)  # one by one: so they stand in this order
    return total


def _terms(letters: Lettered, equation: BodyEquation) -> list[tuple[Node, Scalar]]:
    """(symbol, coefficient) of every reaction in one equation, friction by a symbol of its own."""
    balance = letters.balance
    link, d = balance.system.motion.index[equation.body], equation.direction
    frictions = {
        contact.component: symbols for contact, symbols in zip(letters.contacts, letters.frictions, strict=True)
    }
    found: list[tuple[Node, Scalar]] = []
    for j in equation.coefficients:
        component = balance.components[j]
        own = sum((e.six[d] for e in component.effects if e.link == link), start=0)
        if not is_zero(own):
            found.append((letters.symbols[j], own))
        for along, symbol in zip(component.friction, frictions.get(j, ()), strict=True):
            braking = sum((e.six[d] for e in along.effects if e.link == link), start=0)
            if not is_zero(braking):
                found.append((symbol, braking))
    return found


DROPPED = Law(
    "sum (F + F_in)*dv_C/du_k + (M + M_in)*domega/du_k = 0",
    r"\sum \left(F + F^{\mathrm{in}}\right) \cdot \frac{\partial v_{C}}{\partial u_{k}}"
    r" + \left(M + M^{\mathrm{in}}\right) \cdot \frac{\partial \omega}{\partial u_{k}} = 0",
)


def kinetostatic_steps(
    equations: EquationsOfMotion, reader: Reader, letters: Lettered
) -> tuple[tuple[Step, ...], EquationSteps]:
    """The free bodies and their balance, and the equations of motion that come out of it."""
    system = equations.system
    own = derived_by("kinetostatic", system)
    steps = (
        motion_steps.positions_step(system, reader),
        *motion_steps.speeds_step(system, reader),
        twists_step(system, reader),
        *motion_steps.constraints_step(system, reader),
        reactions_table_step(letters),
        *body_steps(reader, letters),
    )
    words = (
        "Each equation times the velocity of its body for a unit of a speed, all added up, inertia on the left: ",
        "the reactions do no work on these motions and drop out, ",
        DROPPED,
        ":",
    )
    result = equations_of(equations, reader, sides_of(equations, own.M, own.c, own.Q), words)
    return (*steps, *_multipliers(system, letters)), result


def _multipliers(system: System, letters: Lettered) -> tuple[Step, ...]:
    """Step that gives the multipliers of the closing constraints by their reactions."""
    statements: list[Statement] = []
    for row, lam in zip(system.constraints.closing, system.symbols.lam, strict=True):
        reaction = letters.of_row(row)
        if reaction is not None:
            statements.append(Formula((lam, reaction)))
    if not statements:
        return ()
    words = prose("Constraints that the coordinates do not satisfy stay in the equations of motion by their reactions:")
    return (Step("multipliers", "Reactions of the constraints that close", (words, *statements)),)
