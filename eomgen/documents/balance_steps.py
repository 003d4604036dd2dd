"""Balance -> the kineto-static steps: each body cut free, with its reactions, applied forces and inertia.

F_in = -m a_C,  M_in = -d(I omega)/dt;   sum F + F_in = 0,  sum M_C + M_in = 0
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.documents import motion_steps, projection_steps
from eomgen.documents.bounded import FULL
from eomgen.documents.equation_steps import EquationSteps, equations_of, sides_of
from eomgen.documents.motion_steps import Pair
from eomgen.documents.reaction_names import Lettered
from eomgen.documents.reading import Reader
from eomgen.documents.setting_steps import count
from eomgen.documents.statements import Formula, Law, Name, Omitted, Statement, Step, prose
from eomgen.mechanics.balance.balance import BodyEquation
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.formulations import derived_by
from eomgen.model.trusses import called
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.print.layout import terms
from eomgen.symbolic.print.text import text_size

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
        return Step("unknowns", "Unknown reactions", (prose("Nothing reacts: no body is held by joints or ties."),))
    return Step("unknowns", "Unknown reactions", (prose(words), letters.table()))


def body_steps(reader: Reader, letters: Lettered) -> tuple[Step, ...]:
    """Of each body its inertia force and couple, and its equations; as many bodies as a reader can take."""
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
    """One body cut free, and how long that is in print."""
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
    """sum of coefficients * reactions + applied - inertia, each readable; or how large it is."""
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
        projection_steps.twists_step(system, reader),
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
    """What the multipliers are of the ties that the coordinates do not satisfy: their reactions."""
    statements: list[Statement] = []
    for row, lam in zip(system.ties.closing, system.symbols.lam, strict=True):
        reaction = letters.of_row(row)
        if reaction is not None:
            statements.append(Formula((lam, reaction)))
    if not statements:
        return ()
    words = prose("Ties that the coordinates do not satisfy stay in the equations of motion by their reactions:")
    return (Step("multipliers", "Reactions of the ties that close", (words, *statements)),)
