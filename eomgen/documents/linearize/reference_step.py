"""Modes -> the step that says about what the equations are linearized: place of rest or steady motion."""

from __future__ import annotations

from eomgen.documents.setting_steps import listed_symbols
from eomgen.documents.statements import Cell, Formula, Prose, Statement, Step, narrow_grid, prose
from eomgen.mechanics.small_motions.family import Family
from eomgen.mechanics.small_motions.modes import Modes
from eomgen.mechanics.small_motions.reference import EQUILIBRIUM, STEADY, ReferenceMotion
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.print.text import text_size

LONG = 400  # characters of a condition or formula of a family
SHORT = 90  # characters of a formula in a table
NOTHING_DEPENDS = "nothing depends on them, and they have no speed of their own"


def reference_step(modes: Modes) -> Step:
    """The state, how it was found, and the family that a steady motion belongs to."""
    small, reference = modes.small, modes.small.reference
    symbols = reference.system.symbols
    shown = symbols.q if reference.about == EQUILIBRIUM else (*symbols.q, *symbols.u)
    rows: list[tuple[Cell, ...]] = []
    for x in shown:
        exact: Cell = reference.exact.get(x, "")
        value, beside = float(reference.numbers[x]), reference.beside or {}
        from_start = (_number(beside[x]), _number(value - beside[x])) if x in beside and reference.valued else ("", "")
        rows.append((x, exact, _number(value) if reference.valued else "", *from_start))
    head = ("quantity", "exact", "value", "start", "away from it")
    statements: list[Statement] = [prose(_words(reference)), narrow_grid(head, rows)]
    if reference.family is not None:
        statements += _family(modes, reference.family)
    if reference.place is not None and reference.place.statics.held:
        statements.append(prose(f"What the model drives is held there: {', '.join(reference.place.statics.held)}."))
    if small.left_out:
        one = len(small.left_out) == 1
        why = "nothing depends on it, and it has no speed of its own" if one else NOTHING_DEPENDS
        statements.append(prose("Left out: ", *listed_symbols(small.left_out), f"; {why}."))
    return Step("reference", "Reference", tuple(statements))


def _words(reference: ReferenceMotion) -> str:
    if reference.beside is not None:
        return f"The start is accelerated. {_near(reference)} near it, about which this is:"
    if reference.about == STEADY:
        return "The steady motion nearest to the start:"
    if reference.about != EQUILIBRIUM:
        return "The steady motion from the start:"
    if reference.moving:
        return "The place of rest beside what moves steadily, nearest to the start:"
    return "The place of rest nearest to the start:"


def _near(reference: ReferenceMotion) -> str:
    return "The steady motion" if reference.about == STEADY else "The place of rest"


def _family(modes: Modes, family: Family) -> list[Statement]:
    """Its conditions, what follows from what is held, and all motions with the same values held."""
    found: list[Statement] = []
    if family.conditions and max(map(text_size, family.conditions)) <= LONG:
        words = "it rests where" if _at_rest(modes) else "a motion is steady where"
        zeros = [piece for x in family.zeros for piece in (x, " = 0, ")]
        found.append(Prose(("With ", *zeros, words) if zeros else (words.capitalize(),)))
        found += [Formula((condition, 0)) for condition in family.conditions]
    formulas = {x: value for x, value in family.formulas.items() if text_size(value) <= LONG}
    formulas = {x: value for x, value in formulas.items() if depends_on(value, family.held)}
    if formulas:
        found.append(prose("As a function of ", *listed_symbols(family.held), ":"))
        found += [Formula((x, value)) for x, value in formulas.items()]
    if len(family.others) > 1 and modes.small.reference.valued:
        found += _others(modes, family)
    return found


def _others(modes: Modes, family: Family) -> list[Statement]:
    """A row for each of them: values, closed forms, stability."""
    kind = "places of rest" if _at_rest(modes) else "steady motions"
    words = f"All {kind}" if family.complete else f"{kind.capitalize()} that were found"
    where = f" ({family.where})" if family.where else ""
    held = (" with the same ", *listed_symbols((*family.zeros, *family.held))) if family.zeros or family.held else ()
    head: list[Cell] = []
    rows: list[list[Cell]] = [[] for _ in family.others]
    for x in family.following:
        head += [x, "exact"]
        for row, at, closed in zip(rows, family.others, family.closed, strict=True):
            short = x in closed and text_size(closed[x]) <= SHORT
            row += [_number(at[x]), closed[x] if short else ""]
    table = [(*row, stability) for row, stability in zip(rows, modes.beside, strict=True)]
    return [prose(words, *held, f"{where}:"), narrow_grid((*head, "stability"), table)]


def _at_rest(modes: Modes) -> bool:
    return modes.small.reference.about == EQUILIBRIUM


def _number(x: float) -> str:
    return f"{x:.9g}"
