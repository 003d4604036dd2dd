"""StaticReactions -> the steps to every reaction, by virtual work and by the balance.

StaticReactions -> Document: structure and count, every reaction, each by virtual work, and the comparison.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from eomgen.documents import (
    Cell,
    Document,
    Formula,
    Grid,
    Law,
    Piece,
    Prose,
    Statement,
    Step,
    cell_text,
    count,
    data_step,
    document_of,
    lettered,
    narrow_grid,
    prose,
    reaction_name,
    said,
    with_symbols,
)
from eomgen.mechanics.statics import StaticReactions, WorkEquation
from eomgen.model import is_node
from eomgen.proof import ReportedWork
from eomgen.symbolic.expression import Node, Scalar, Vector, is_zero
from eomgen.symbolic.print import Notation, Symbol, to_text, upright

METHOD = "statics"
SymbolsByName = Mapping[str, Node]


def statics_derivation(statics: StaticReactions, values: Mapping[str, float], more: Sequence[Step] = ()) -> Document:
    """The solution, step by step.

    Args:
        values: of the reactions in numbers, as far as the parameters have values.
        more: steps that follow: section forces, influence lines.
    """
    model = statics.system.scope.model
    symbols, declared = _named(statics)
    steps = (
        data_step(statics.system),
        structure_step(statics),
        *_open(statics, symbols, values),
        static_reactions_step(statics, symbols, values),
        *_works(statics, symbols),
        *agreement_step(statics),
        *more,
    )
    return with_symbols(document_of(model, METHOD, steps), declared)


def _named(statics: StaticReactions) -> tuple[dict[str, Node], dict[str, Symbol]]:
    """(a symbol for each reaction by its name, their LaTeX symbols where declared)."""
    letters = lettered(statics.balance, statics.system.scope.names)
    graph, taken = statics.system.scope.graph, {*statics.system.scope.names, *letters.names}
    found: dict[str, Node] = {}
    declared = dict(letters.declared)
    for reaction in statics.reactions:
        if reaction.named is None:
            found[reaction.name] = statics.system.symbols.unknowns[reaction.name]
            continue
        alone = [j for j, k in reaction.named.combination.items() if type(k) is int and k == 1]
        if len(reaction.named.combination) == 1 and alone and is_zero(reaction.named.given):
            found[reaction.name] = letters.symbols[alone[0]]
        else:
            name = _untaken(letter_of_reaction(reaction.name), taken)
            found[reaction.name] = graph.symbol(name)
            taken.add(name)
    return found, declared


def letter_of_reaction(name: str) -> str:
    """reaction_x(foot) -> R_foot_x, reaction_couple_z(foot) -> M_foot_z"""
    kind, _, rest = name.partition("(")
    owner, *more = rest.removesuffix(")").replace(".", "_").replace(", ", "_").replace("-", "_").split("_")
    what, *axes = kind.removeprefix("reaction_").split("_")
    return reaction_name(what, owner, *more, *axes)


_LETTER = re.compile(r"[A-Za-z]\d*")


def letter_of_load(name: str, notation: Notation) -> str:
    """The letter of a load in LaTeX: its declared symbol, F or F1 as in formulas, else its name upright."""
    if name in notation.symbols or _LETTER.fullmatch(name):
        return notation.latex(name)
    return upright(name)


def _untaken(name: str, taken: set[str]) -> str:
    while name in taken:
        name += "_r"
    return name


# -- the structure -----------------------------------------------------------------------------------


def structure_step(statics: StaticReactions) -> Step:
    """Bodies, reactions, the count, the rank."""
    structure = statics.structure
    links = statics.system.motion.links
    nodes = sum(is_node(link.name) for link in links)
    parts = [count(len(links) - nodes, "body", "bodies")] if len(links) > nodes else []
    parts += [count(nodes, "node")] if nodes else []
    number, formula = statics.count
    unknowns = len(structure.unknowns)
    besides = f" and {count(unknowns, 'unknown load')}" if unknowns else ""
    statements: list[Statement] = [
        prose(
            f"{' and '.join(parts)}, held by {count(len(structure.components), 'scalar reaction')}{besides}. "
            "The count of degrees of freedom, everything that holds taken as independent:"
        ),
        Formula((_law(formula), number)),
        prose(
            f"By rank: the bodies have {count(len(structure.columns), 'velocity', 'velocities')}, of which the "
            f"reactions forbid {structure.rank}. {_free(statics)}"
            + (
                ": the structure is statically determinate."
                if not structure.indeterminacy
                else f"; there {'is' if structure.indeterminacy == 1 else 'are'} "
                f"{count(structure.indeterminacy, 'reaction')} more than independent ones: the structure is "
                f"statically indeterminate, to the degree {structure.indeterminacy}."
            )
        ),
    ]
    return Step("structure", "Structure", tuple(statements))


def _free(statics: StaticReactions) -> str:
    """Sentence on what can move: nothing, straight bodies about their lines, or motions in which no load does work."""
    structure = statics.structure
    idle = dict.fromkeys(body for plan in structure.loose for body in plan.moving)
    if not idle:
        return "Nothing can move"
    if structure.turns_idly:
        return f"Nothing can move but {', '.join(idle)} about its own line, on which nothing acts"
    reported = "; ".join(plan.in_words for plan in structure.loose)
    why = "nothing resists it, but no load does any work in it"
    return f"{reported[0].upper()}{reported[1:]}: {why}. Else nothing can move"


def _law(formula: str) -> Law:
    """The count as it stands, words upright."""
    latex = formula.replace("*", r" \cdot ")
    for word in ("bodies", "particles", "joints", "constraints", "given motions", "unknown loads"):
        latex = latex.replace(f"({word})", rf"\ \text{{({word})}}")
    return Law(formula, latex)


def _open(statics: StaticReactions, symbols: SymbolsByName, values: Mapping[str, float]) -> tuple[Step, ...]:
    """Self-stresses of an indeterminate structure, by the names of its reactions."""
    if not statics.structure.indeterminacy:
        return ()
    letters = lettered(statics.balance, statics.system.scope.names).symbols
    letters = (*letters, *statics.structure.unknowns)
    graph = statics.system.scope.graph
    statements: list[Statement] = []
    for number, stress in enumerate(statics.structure.stresses, start=1):
        k = graph.symbol(_untaken("k" if statics.structure.indeterminacy == 1 else f"k{number}", set(symbols)))
        statements += [
            prose("To these at once may be added, with any number ", k, ", without a trace:"),
            Grid(("reaction", "added"), tuple((letters[j], share * k) for j, share in stress.items())),
        ]
    constraints = dict.fromkeys(
        statics.structure.components[j].owner
        for s in statics.structure.stresses
        for j in s
        if j < len(statics.structure.components)
    )
    statements.append(
        prose(f"One constraint too many for each of these is among: {', '.join(constraints)}. The rest is determinate.")
    )
    if statics.sums:
        rows: list[tuple[Cell, ...]] = []
        for each in statics.sums:
            shown = sum((k * letters[j] for j, k in each.combination.items()), start=0)
            name = sum_name(statics, each.combination)
            rows.append((shown, each.value, f"{values[name]:.7g}" if name in values else "", each.unit))
        statements.append(prose("Sums in which that leaves no trace have one value:"))
        statements.append(narrow_grid(("sum", "exact", "value", "unit"), rows))
    return (Step("indeterminate", "Self-stresses", tuple(statements)),)


def sum_name(statics: StaticReactions, combination: Mapping[int, Scalar]) -> str:
    """Name of a sum as in an output: reaction_x(A) + reaction_x(B)."""
    graph, names = statics.system.scope.graph, statics.structure.names
    return to_text(sum((k * graph.symbol(names[j]) for j, k in combination.items()), start=0))


# -- the reactions -------------------------------------------------------------------------------------


def static_reactions_step(statics: StaticReactions, symbols: SymbolsByName, values: Mapping[str, float]) -> Step:
    """All reactions: the meaning of each, exact and in numbers."""
    rows: list[tuple[Cell, ...]] = []
    for reaction in statics.reactions:
        value = reaction.value
        number = f"{values[reaction.name]:.7g}" if reaction.name in values else ""
        exact: Cell = "indeterminate" if value is None else value
        sense = _sense(statics, reaction.name, values.get(reaction.name))
        words = meaning_of(statics, reaction.name)
        rows.append((symbols[reaction.name], words, exact, number, reaction.unit, sense))
    if not rows:
        return Step("reactions", "Reactions", (prose("Nothing reacts."),))
    head = ("reaction", "meaning", "exact", "value", "unit", "sense")
    return Step("reactions", "Reactions", (narrow_grid(head, rows),))


SENSES = {
    "reaction_x": ("to the right", "to the left"),
    "reaction_y": ("up", "down"),
    "reaction_couple": ("counter-clockwise", "clockwise"),
    "tension": ("tension", "compression"),
    "reaction_n": ("along the normal", "against the normal"),
}
"""Of a reaction in the plane that is positive, and of one that is negative."""


def _sense(statics: StaticReactions, reaction: str, value: float | None) -> str:
    """Sense of a reaction in words; "" where there is none, or its sign is not known."""
    senses = SENSES.get(reaction.partition("(")[0])
    if senses is None or not value or statics.system.scope.model.space != "plane":
        return ""
    return senses[value < 0]


def meaning_of(statics: StaticReactions, reaction: str) -> str:
    """Meaning of a reaction: its kind, its body, its sense."""
    named = statics.by_name[reaction].named
    if named is None:
        about = statics.system.scope.model.unknowns[reaction]
        return getattr(about, "about", None) or "to be found"
    return said(statics.balance.balance, named)


def _works(statics: StaticReactions, symbols: SymbolsByName) -> tuple[Step, ...]:
    return tuple(
        virtual_work_step(reaction.name, reaction.work, symbols[reaction.name])
        for reaction in statics.reactions
        if reaction.work is not None
    )


def agreement_step(statics: StaticReactions) -> tuple[Step, ...]:
    """Step that says whether virtual work and the balance of the bodies agree."""
    compared = [reaction for reaction in statics.reactions if reaction.work is not None]
    if not compared:
        return ()
    wrong = statics.disagreeing
    if not wrong:
        what = "value" if len(compared) == 1 else f"{len(compared)} values"
        text = f"The balance of forces and moments of every body gives the same {what}, as formulas of the parameters."
        return (Step("agreement", "Check by equilibrium", (prose(text),)),)
    rows = [(r.name, _or_open(None if r.work is None else r.work.value), _or_open(r.balanced)) for r in wrong]
    return (
        Step(
            "agreement",
            "Check by equilibrium: FAILED",
            (
                prose("The two ways do not agree; do not trust this result:"),
                Grid(("reaction", "by virtual work", "by equilibrium"), tuple(rows)),
            ),
        ),
    )


MARGINS = {
    "pushes": "its normal force",
    "pulls": "its tension",
    "sticks": "mu |N| less its friction",
    "holds": "its largest friction less what holds",
}


def contacts_step(statics: StaticReactions, broken: Sequence[str]) -> tuple[Step, ...]:
    """Step with the conditions on contacts that can open or slide, and those that are violated."""
    rows = tuple((c.constraint, MARGINS[c.kind], c.margin) for c in statics.conditions)
    if not rows and not broken:
        return ()
    statements: list[Statement] = [prose(f"It is not at rest like this: {words}.") for words in broken]
    if rows:
        whole = prose("The contacts are as they were taken while none of these is negative:")
        statements = [whole, Grid(("contact", "what", "formula"), rows), *statements]
    return (Step("contacts", "Contacts: FAILED" if broken else "Contacts", tuple(statements)),)


WHERE = {"anywhere": "anywhere", "nowhere": "nowhere"}


def ranges_step(statics: StaticReactions) -> tuple[Step, ...]:
    """Step with the limits of impending motion, where dry friction holds."""
    if not statics.ranges:
        return ()
    own_unit = statics.system.scope.model.in_own_unit

    def end(name: str, value: float | None) -> Cell:
        return "" if value is None else own_unit(name, value, 10)

    rows = tuple(
        (each.name, WHERE.get(each.extent) or end(each.name, each.low), end(each.name, each.high), each.condition)
        for each in statics.ranges
    )
    words = prose(
        "Dry friction keeps it at rest between these limits, the others as they stand; from them on it moves:"
    )
    return (Step("rest range", "Range of rest", (words, Grid(("of", "from", "to", "while"), rows))),)


def _or_open(value: Scalar | None) -> Cell:
    return "indeterminate" if value is None else value


# -------- work steps ------------------------------------------------------------------------------------------
# WorkEquation -> the step that finds a reaction by virtual work: mechanism, centres, displacements, equation.


TURN, SHIFT = "δθ", "δs"
"""The virtual displacement of the block that sets the scale: the angle by which it turns, or how far it moves."""

LISTED = 8  # parts of a block by name


def virtual_work_step(reaction: str, equation: WorkEquation, symbol: Node) -> Step:
    """Step that derives one reaction from the virtual work of the mechanism that its release leaves."""
    if not equation.plan.blocks:
        nothing = prose("Its constraint leaves this motion free, and so bears nothing: ", symbol, " = 0.")
        return Step(f"work {reaction}", f"{reaction} by virtual work", (nothing,))
    delta = _scale(equation, symbol)
    statements: list[Statement] = [_released(equation, symbol, delta), _mechanism(equation, delta)]
    if equation.terms:
        statements += [prose("The loads do the virtual works:"), _work_terms(equation, delta)]
    else:
        statements.append(prose("No load does any work in this motion."))
    statements += [
        prose("The principle of virtual work says", *_without(equation), ":"),
        *_equations(equation, symbol, delta),
    ]
    return Step(f"work {reaction}", f"{reaction} by virtual work", tuple(statements))


def _scale(equation: WorkEquation, symbol: Node) -> Node:
    """The angle where a block turns by 1, else a length."""
    turns = any(not isinstance(w, Node) and w == 1 for block in equation.plan.blocks for w in block.spin)
    scale: Node = symbol.graph.symbol(TURN if turns else SHIFT)
    return scale


def _released(equation: WorkEquation, symbol: Node, delta: Node) -> Prose:
    """Sentence on the blocks that move once the reaction is released, and those that stay at rest."""
    still, blocks = equation.plan.resting_blocks, equation.plan.blocks
    rest = f"; {_listed(still)} {'stays' if len(still) == 1 else 'stay'} at rest" if still else ""
    many = "one block" if len(blocks) == 1 else f"{len(blocks)} blocks"
    return prose(
        "Released along ",
        symbol,
        f", the structure is a mechanism: {many} can move{rest}. Its virtual displacements, all by ",
        delta,
        ":",
    )


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(names[:LISTED])
    return shown + (f" and {len(names) - LISTED} more" if len(names) > LISTED else "")


# -- as it is reported -------------------------------------------------------------------------------


def reported_work(name: str, step: Step, machines: Mapping[str, Any]) -> ReportedWork | None:
    """Virtual work of a reaction in the plane, as printed and as in the JSON entries; None where nothing moves."""
    grids = {cell_text(s.head[0]): [_by_head(s, row) for row in s.rows] for s in step.statements if isinstance(s, Grid)}
    formulas = [s for s in step.statements if isinstance(s, Formula)]
    if "block" not in grids:
        return None
    blocks = [(tuple(x["parts"]), x["rotation"][2], x["shift_at_origin"]) for x in machines["mechanism"]]
    loads = grids.get("load", [])
    left, last = formulas[0].sides[0], formulas[1].sides[1]
    return ReportedWork(
        name,
        blocks,
        machines["along"],
        [(term["load"], term["work"]) for term in machines["terms"]],
        machines["value"],
        [_reported_motion(row) for row in grids["block"]],
        [_reported_motion(row) for row in loads if any(f"shift {k}" in row for k in "xy")],
        [(row["load"], row["work"]) for row in loads if not isinstance(row["work"], str)],
        left,  # type: ignore[arg-type]
        last,  # type: ignore[arg-type]
    )


def _by_head(grid: Grid, row: Sequence[Cell]) -> dict[str, Any]:
    return dict(zip(map(cell_text, grid.head), row, strict=True))


def _reported_motion(row: Mapping[str, Any]) -> tuple[Any, Any, Any, str]:
    """(centre, turn, shift, where): columns in which nothing stands are left out, a centre at infinity is a word."""
    spin, *shift = (0 if isinstance(x := row.get(k, ""), str) else x for k in ("rotation", "shift x", "shift y"))
    x = row.get("centre x", "")
    return None if isinstance(x, str) else (x, row["centre y"]), spin, shift, row.get("at", "")


# -- the mechanism -----------------------------------------------------------------------------------


def _mechanism(equation: WorkEquation, delta: Node) -> Grid:
    """Table of the blocks with their centres of rotation and rotations, or their displacements."""
    plan = equation.plan
    if plan.system.scope.model.space != "plane":
        return _mechanism_in_space(equation, delta)
    rows: list[tuple[Cell, ...]] = []
    for numeral, block in plan.numbered_blocks.items():
        center = block.center(plan)
        place: tuple[Cell, Cell] = ("at infinity", "") if center.place is None else (center.place[0], center.place[1])
        moved = [plan.simple(x) for x in center.direction or (0, 0, 0)]
        shift = ("", "") if center.place is not None else (moved[0] * delta, moved[1] * delta)
        rows.append((numeral, _parts(equation, numeral), *place, block.spin[2] * delta, *shift))
    return _narrow(("block", "moves", "centre x", "centre y", "rotation", "shift x", "shift y"), rows)


def _mechanism_in_space(equation: WorkEquation, delta: Node) -> Grid:
    """Table of the bodies with their rotations and the displacements of their mass centres; nodes are only named."""
    plan, blocks = equation.plan, equation.plan.numbered_blocks
    rows: list[tuple[Cell, ...]] = []
    for numeral, block in blocks.items():
        if not block.bodies:
            continue
        moved = plan.center_velocity(block.bodies[0])
        spin = tuple(plan.simple(x) * delta for x in block.spin)
        rows.append((numeral, _parts(equation, numeral), *spin, *(x * delta for x in moved)))
    nodes = tuple(node for block in blocks.values() for node in block.nodes)
    if nodes:
        rows.append(("nodes", _listed(nodes), *("",) * 6))
    axes = ("x", "y", "z")
    head = ("block", "moves", *(f"rotation {k}" for k in axes), *(f"shift {k}" for k in axes))
    return _narrow(head, rows)


def _parts(equation: WorkEquation, numeral: str) -> str:
    """Bodies, members and nodes of a block; a truss as one where all of it is in the block."""
    plan, blocks = equation.plan, equation.plan.numbered_blocks
    block = blocks[numeral]
    if len(plan.moving) == len(plan.system.motion.links) and len(blocks) == 1:
        return "the whole structure"
    of_truss = Counter(truss for truss, _, _ in plan.system.scope.model.truss_members)
    inside = Counter(truss for truss, _ in block.members)
    whole = [truss for truss, number in inside.items() if number == of_truss[truss]]
    single = [f"{truss} {member}" for truss, member in block.members if truss not in whole]
    return _listed((*block.bodies, *(f"truss {truss}" for truss in whole), *single, *block.nodes))


# -- works -------------------------------------------------------------------------------------------


def _work_terms(equation: WorkEquation, delta: Node) -> Grid:
    """Table of the loads that do work, with the displacements of their points and their works."""
    plane = equation.plan.system.scope.model.space == "plane"
    size = 2 if plane else 3
    rows: list[tuple[Cell, ...]] = []
    for term in equation.terms:
        *before, last = term.acting.displaced(equation.plan)
        for where, moved, turned in before:
            rows.append((term.acting.name, where, *_moved(moved, turned, size, delta), ""))
        where, moved, turned = last
        rows.append((term.acting.name, where, *_moved(moved, turned, size, delta), term.work * delta))
    turning = ("rotation",) if plane else ("rotation x", "rotation y", "rotation z")
    return _narrow(("load", "at", *(f"shift {k}" for k in "xyz"[:size]), *turning, "work"), rows)


def _moved(moved: Vector | None, turned: Vector | None, size: int, delta: Node) -> tuple[Cell, ...]:
    shift: tuple[Cell, ...] = ("",) * size if moved is None else tuple(x * delta for x in moved[:size])
    if turned is None:
        return (*shift, *("",) * (1 if size == 2 else 3))
    return (*shift, *(x * delta for x in (turned[2:] if size == 2 else turned)))


# -- the equation --------------------------------------------------------------------------------------


def _without(equation: WorkEquation) -> tuple[Piece, ...]:
    return () if is_zero(equation.given) else (" (of the joint's reaction without its drive and spring)",)


def _equations(equation: WorkEquation, symbol: Node, delta: Node) -> list[Statement]:
    """R delta_R + sum of works = 0, and R."""
    total: Scalar = sum((term.work for term in equation.terms), start=0)
    own = symbol - equation.given
    written = equation.plan.simple(total)
    return [Formula((own * equation.along * delta + written * delta, 0)), Formula((symbol, equation.value))]


def _narrow(head: Sequence[str], rows: Sequence[tuple[Cell, ...]]) -> Grid:
    """The table without columns in which nothing stands, or only zeros; centres keep both coordinates."""
    kept = [k for k in range(len(head)) if any(not _is_nothing(row[k]) for row in rows) or head[k].startswith("centre")]
    return narrow_grid(head, rows, kept)


def _is_nothing(cell: Cell) -> bool:
    return cell == "" if isinstance(cell, str) else type(cell) is int and cell == 0
