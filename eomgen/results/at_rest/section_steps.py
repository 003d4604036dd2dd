"""StaticReactions -> the steps about section forces: N, V and M from station to station; influence lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

from eomgen.documents import Formula, Grid, Law, Name, Side, Statement, Step, cell_text, prose
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.statics import InfluenceLine, SectionForces, StaticReactions
from eomgen.model import is_node
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.print import to_text

LETTERS = {"axial_force": "N", "shear_force": "V", "bending_moment": "M"}
SIGNS = (
    "N is positive as tension, V where it turns the piece on which it acts clockwise, M where it stretches the "
    "right-hand fibre, as one goes along the axis: of a beam from left to right the lower one. "
)
RELATIONS = Law("dV/dx = q_n, dM/dx = V", r"\frac{dV}{dx} = q_{n}, \quad \frac{dM}{dx} = V")
NO_LINE = "has no line"  # how a body says that it is no beam at all


@dataclass(frozen=True)
class Sections:
    """The section forces of all bodies that are beams.

    Args:
        found: by body.
        reasons: {body: why it has none}, of those that have a line.
    """

    found: dict[str, SectionForces]
    reasons: dict[str, str]


def sections_of(statics: StaticReactions) -> Sections:
    """Section forces of every body in the plane; none in space."""
    system, reactions = statics.system, statics.balance
    found: dict[str, SectionForces] = {}
    reasons: dict[str, str] = {}
    bodies = [link.name for link in system.motion.links if not is_node(link.name)]
    for body in bodies if system.scope.model.space == "plane" else ():
        try:
            found[body] = SectionForces.of(reactions, body)
        except DerivationError as error:
            if NO_LINE not in error.what:
                reasons[body] = f"{error.what}; {error.fix}" if error.fix else error.what
    return Sections(found, reasons)


def sections_in_space(statics: StaticReactions) -> dict[str, SectionForces]:
    """Section forces of every body in space that is a beam and not a rod of a truss alone."""
    system, reactions = statics.system, statics.balance
    found = {}
    for link in system.motion.links if system.scope.model.space == "space" else ():
        if not is_node(link.name):
            with suppress(DerivationError):
                found[link.name] = SectionForces.in_space(reactions, link.name)
    return found


def section_steps(sections: Sections) -> tuple[Step, ...]:
    """A step for each body, pieces as rows of a table; bodies without section forces with the reason."""
    steps = [
        Step(f"section_{body}", f"Section forces of {body}", tuple(_of_body(forces, number)))
        for number, (body, forces) in enumerate(sections.found.items())
    ]
    if sections.reasons:
        words = [prose(f"{reason}.") for reason in sections.reasons.values()]
        steps.append(Step("section_none", "Bodies without section forces", tuple(words)))
    return tuple(steps)


def section_payload(sections: Sections) -> dict[str, Any]:
    """{body: {"pieces": [{"from", "to", "N", "V", "M"}, ...], "extremes": [{"x", "M"}]}} for machines."""
    found: dict[str, Any] = {}
    for body, forces in sections.found.items():
        x = _variable(forces)
        found[body] = {
            "variable": x.name,
            "pieces": list(_rows(forces, x)),
            "extremes": [{"x": to_text(e.x), "M": to_text(e.M)} for e in forces.extremes],
        }
    return found | {body: {"message": reason} for body, reason in sections.reasons.items()}


def reported_sections(
    sections: Sections, steps: Sequence[Step], payload: Mapping[str, Any]
) -> Iterator[tuple[str, str, Any, Any]]:
    """(body, distance along its axis, pieces, extremes), as they are printed and as the JSON entries give them."""
    by_key = {step.key: step.statements for step in steps}
    for body, forces in sections.found.items():
        printed = by_key[f"section_{body}"]
        (grid,) = (x for x in printed if isinstance(x, Grid))
        heads = [{"from x": "from", "to x": "to"}.get(head, head) for head in map(cell_text, grid.head)]
        sides = [x.sides[1] for x in printed if isinstance(x, Formula)]
        extremes = [dict(zip(("M", "x"), sides[k : k + 2], strict=True)) for k in range(0, len(sides), 2)]
        rows = [dict(zip(heads, row, strict=True)) for row in grid.rows]
        x = _variable(forces).name
        yield body, x, rows, extremes
        yield body, payload[body]["variable"], payload[body]["pieces"], payload[body]["extremes"]


def _rows(forces: SectionForces, x: Node) -> Iterator[dict[str, str]]:
    for piece in forces.pieces:
        values = {LETTERS[kind]: to_text(forces.sizes.shortest(piece.value(kind, x))) for kind in forces.kinds}
        ends = (to_text(forces.sizes.shortest(end)) for end in (piece.start, piece.end))
        yield {**dict(zip(("from", "to"), ends, strict=True)), **values}


def _of_body(forces: SectionForces, number: int) -> Iterable[Statement]:
    x = _variable(forces)
    line = "its axis" if forces.axis.is_straight else f"its axis of {len(forces.axis.legs)} straight parts"
    yield prose(
        f"Along {line}, ",
        x,
        " from its start; all that acts before the section gives N, V and M. ",
        *((SIGNS, RELATIONS, ":") if number == 0 else (RELATIONS, ":")),
    )
    rows = [(piece.start, piece.end, *(piece.value(kind, x) for kind in forces.kinds)) for piece in forces.pieces]
    written = tuple(tuple(forces.sizes.shortest(cell) for cell in row) for row in rows)
    yield Grid(("from x", "to x", *map(Law.of_letter, "NVM")), written)
    if forces.extremes:
        yield prose("Where V = 0 within a part, M has an extreme:")
        for extreme in forces.extremes:
            yield Formula((Name("M", "extreme"), extreme.M))
            yield Formula((x, extreme.x))


def _variable(forces: SectionForces) -> Node:
    """A symbol for the distance along the axis that is no name of the model."""
    taken = {node.name for node in forces.sizes.positive} | {node.name for node in forces.sizes.values}
    names = (name for name in ("x", "s", "xi", "x_axis") if name not in taken)
    return forces.sizes.graph.symbol(next(names))


# -- influence lines ---------------------------------------------------------------------------------


def influence_step(line: InfluenceLine) -> Step:
    """The straight parts of an influence line, from vertex to vertex."""
    words = (
        f"A unit load travels along {_listed([span.name for span in line.spans])}, {_sense(line)}. What belongs to "
        f"{line.name} is released; the displacement along it being 1, the load's own virtual displacement, turned "
        "about, is the influence line:"
    )
    rows: list[tuple[str | Side, ...]] = []
    for span in line.spans:
        rows.append((span.name, span.start[0], span.start[1], span.at_start, span.end[0], span.end[1], span.at_end))
    head = ("along", "from x", "y", "value", "to x", "y", "value")
    return Step("influence", f"Influence line of {line.name}", (prose(words), Grid(head, tuple(rows))))


def influence_payload(line: InfluenceLine) -> dict[str, Any]:
    """JSON entry of an influence line."""
    return {
        "of": line.name,
        "load": [to_text(x) for x in line.load[:2]],
        "spans": [
            {
                "along": s.name,
                "from": _place(s.start),
                "to": _place(s.end),
                "start": to_text(s.at_start),
                "end": to_text(s.at_end),
            }
            for s in line.spans
        ],
    }


def _place(place: Sequence[Scalar]) -> list[str]:
    return [to_text(x) for x in place[:2]]


def _listed(names: Sequence[str]) -> str:
    return ", ".join(dict.fromkeys(names))


def _sense(line: InfluenceLine) -> str:
    if tuple(line.load) == (0, -1, 0):
        return "downward"
    return f"along ({', '.join(to_text(x) for x in line.load[:2])})"
