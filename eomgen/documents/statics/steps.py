"""StaticReactions -> Document: structure and count, every reaction, each by virtual work, and the comparison."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from eomgen.documents.document import Document, document_of, with_symbols
from eomgen.documents.reaction_names import lettered, reaction_name, said
from eomgen.documents.setting_steps import count, data_step
from eomgen.documents.statements import Cell, Formula, Grid, Law, Statement, Step, narrow_grid, prose
from eomgen.documents.statics.work_steps import virtual_work_step
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.mechanics.statics.rest_contacts import RestCondition
from eomgen.mechanics.statics.two_ways import StaticReaction, StaticReactions, StaticSum
from eomgen.mechanics.structures.loose_motion import motion_in_words
from eomgen.mechanics.structures.structure import Structure
from eomgen.model.trusses import is_node
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.print.symbols import Symbol
from eomgen.symbolic.print.text import to_text

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
    """(a symbol for each reaction by its name, how they are set in LaTeX where that is declared)."""
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
            name = _untaken(_letter(reaction.name), taken)
            found[reaction.name] = graph.symbol(name)
            taken.add(name)
    return found, declared


def _letter(name: str) -> str:
    """reaction_x(foot) -> R_foot_x, reaction_couple_z(foot) -> M_foot_z"""
    kind, _, rest = name.partition("(")
    owner, *more = rest.removesuffix(")").replace(".", "_").replace(", ", "_").replace("-", "_").split("_")
    what, *axes = kind.removeprefix("reaction_").split("_")
    return reaction_name(what, owner, *more, *axes)


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
            "The count of freedoms, everything that holds taken as independent:"
        ),
        Formula((_law(formula), number)),
        prose(
            f"By rank: the bodies have {count(len(structure.columns), 'velocity', 'velocities')}, of which the "
            f"reactions forbid {structure.rank}. {_free(structure)}"
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


def _free(structure: Structure) -> str:
    """What can move: nothing, straight bodies about their own lines, or what no load moves."""
    idle = dict.fromkeys(body for plan in structure.loose for body in plan.moving)
    if not idle:
        return "Nothing can move"
    if structure.turns_idly:
        return f"Nothing can move but {', '.join(idle)} about its own line, on which nothing acts"
    told = "; ".join(motion_in_words(plan) for plan in structure.loose)
    why = "nothing resists it, but no load does any work in it"
    return f"{told[0].upper()}{told[1:]}: {why}. Else nothing can move"


def _law(formula: str) -> Law:
    """The count as it stands, words upright."""
    latex = formula.replace("*", r" \cdot ")
    for word in ("bodies", "particles", "joints", "ties", "given motions", "unknown loads"):
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
    ties = dict.fromkeys(
        statics.structure.components[j].owner
        for s in statics.structure.stresses
        for j in s
        if j < len(statics.structure.components)
    )
    statements.append(
        prose(f"One tie too many for each of these is among: {', '.join(ties)}. What stays determinate is given.")
    )
    if statics.sums:
        rows: list[tuple[Cell, ...]] = []
        for each in statics.sums:
            shown = sum((k * letters[j] for j, k in each.combination.items()), start=0)
            name = sum_name(statics, each)
            rows.append((shown, each.value, f"{values[name]:.7g}" if name in values else "", each.unit))
        statements.append(prose("Sums in which that leaves no trace have one value:"))
        statements.append(narrow_grid(("sum", "exact", "value", "unit"), rows))
    return (Step("indeterminate", "Self-stresses", tuple(statements)),)


def sum_name(statics: StaticReactions, each: StaticSum) -> str:
    """As an output asks for it: reaction_x(A) + reaction_x(B)."""
    graph, names = statics.system.scope.graph, statics.structure.names
    return to_text(sum((k * graph.symbol(names[j]) for j, k in each.combination.items()), start=0))


# -- the reactions -------------------------------------------------------------------------------------


def static_reactions_step(statics: StaticReactions, symbols: SymbolsByName, values: Mapping[str, float]) -> Step:
    """All reactions: what each is, exact and in numbers."""
    rows: list[tuple[Cell, ...]] = []
    for reaction in statics.reactions:
        value = reaction.value
        number = f"{values[reaction.name]:.7g}" if reaction.name in values else ""
        exact: Cell = "indeterminate" if value is None else value
        sense = _sense(statics, reaction, values.get(reaction.name))
        words = meaning_of(statics.balance, reaction)
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


def _sense(statics: StaticReactions, reaction: StaticReaction, value: float | None) -> str:
    """In words; "" where there is none, or its sign is not known."""
    senses = SENSES.get(reaction.name.partition("(")[0])
    if senses is None or not value or statics.system.scope.model.space != "plane":
        return ""
    return senses[value < 0]


def meaning_of(balance: Reactions, reaction: StaticReaction) -> str:
    """What it is, on which body, in which sense."""
    if reaction.named is None:
        about = balance.balance.system.scope.model.unknowns[reaction.name]
        return getattr(about, "about", None) or "asked for"
    return said(balance.balance, reaction.named)


def _works(statics: StaticReactions, symbols: SymbolsByName) -> tuple[Step, ...]:
    return tuple(
        virtual_work_step(reaction, symbols[reaction.name])
        for reaction in statics.reactions
        if reaction.work is not None
    )


def agreement_step(statics: StaticReactions) -> tuple[Step, ...]:
    """Whether virtual work and the balance of the bodies agree."""
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


MARGINS = {"pushes": "its normal force", "pulls": "its tension", "sticks": "mu |N| less its friction"}


def contacts_step(conditions: Sequence[RestCondition], broken: Sequence[str]) -> tuple[Step, ...]:
    """What must hold of contacts that can end or slide, and what does not."""
    if not conditions:
        return ()
    rows = tuple((c.tie, MARGINS[c.kind], c.margin) for c in conditions)
    statements: list[Statement] = [
        prose("The contacts are as they were taken while none of these is negative:"),
        Grid(("contact", "what", "formula"), rows),
        *(prose(f"It is not at rest like this: {words}.") for words in broken),
    ]
    return (Step("contacts", "Contacts: FAILED" if broken else "Contacts", tuple(statements)),)


def _or_open(value: Scalar | None) -> Cell:
    return "indeterminate" if value is None else value
