"""WorkEquation -> the step that finds a reaction by virtual work: mechanism, centres, displacements, equation."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from eomgen.documents.statements import Cell, Formula, Grid, Piece, Prose, Statement, Step, narrow_grid, prose
from eomgen.documents.text import cell_text
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.statics.two_ways import StaticReaction
from eomgen.mechanics.statics.virtual_work import Acting, WorkEquation, WorkTerm
from eomgen.mechanics.structures.blocks import RigidBlock, blocks_of, members_of, numeral, resting_blocks
from eomgen.mechanics.structures.velocity_plan import VelocityPlan
from eomgen.model.forces.load import BodyPoint, Couple, PointForce, SpreadLoad
from eomgen.model.trusses import is_node
from eomgen.proof.works_told import ToldBlock, ToldMotion, ToldWork
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector, plus, times, vector_of

TURN, SHIFT = "δθ", "δs"
"""The virtual displacement of the block that sets the scale: the angle by which it turns, or how far it moves."""

LISTED = 8  # parts of a block by name


def virtual_work_step(reaction: StaticReaction, symbol: Node) -> Step:
    """How one reaction follows from the virtual work of the mechanism that its release leaves."""
    equation = reaction.work
    assert equation is not None, "an indeterminate reaction has no equation of work"
    plan, blocks = equation.plan, blocks_of(equation.plan)
    if not blocks:
        nothing = prose("Its tie leaves this motion free, and so bears nothing: ", symbol, " = 0.")
        return Step(f"work {reaction.name}", f"{reaction.name} by virtual work", (nothing,))
    delta = _scale(blocks, symbol)
    statements: list[Statement] = [_released(plan, blocks, symbol, delta), _mechanism(plan, blocks, delta)]
    if equation.terms:
        statements += [prose("The loads do the virtual works:"), _works(plan, equation.terms, delta)]
    else:
        statements.append(prose("No load does any work in this motion."))
    statements += [
        prose("The principle of virtual work says", *_without(equation), ":"),
        *_equations(equation, symbol, delta),
    ]
    return Step(f"work {reaction.name}", f"{reaction.name} by virtual work", tuple(statements))


def _scale(blocks: Sequence[RigidBlock], symbol: Node) -> Node:
    """The angle where a block turns by 1, else a length."""
    turns = any(not isinstance(w, Node) and w == 1 for block in blocks for w in block.spin)
    scale: Node = symbol.graph.symbol(TURN if turns else SHIFT)
    return scale


def _released(plan: VelocityPlan, blocks: Sequence[RigidBlock], symbol: Node, delta: Node) -> Prose:
    """What moves once the reaction is released, and what does not."""
    still = resting_blocks(plan)
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


# -- as it is told -----------------------------------------------------------------------------------


def told_work(name: str, step: Step, machines: Mapping[str, Any]) -> ToldWork | None:
    """How a reaction in the plane is found, as it is printed and as machines get it; None where nothing moves."""
    grids = {cell_text(s.head[0]): [_by_head(s, row) for row in s.rows] for s in step.statements if isinstance(s, Grid)}
    formulas = [s for s in step.statements if isinstance(s, Formula)]
    if "block" not in grids:
        return None
    blocks = [ToldBlock(tuple(x["parts"]), x["rotation"][2], x["shift_at_origin"]) for x in machines["mechanism"]]
    loads = grids.get("load", [])
    left, last = formulas[0].sides[0], formulas[1].sides[1]
    return ToldWork(
        name,
        blocks,
        machines["along"],
        [(term["load"], term["work"]) for term in machines["terms"]],
        machines["value"],
        [_told_motion(row) for row in grids["block"]],
        [_told_motion(row) for row in loads if any(f"shift {k}" in row for k in "xy")],
        [(row["load"], row["work"]) for row in loads if not isinstance(row["work"], str)],
        left,  # type: ignore[arg-type]
        last,  # type: ignore[arg-type]
    )


def _by_head(grid: Grid, row: Sequence[Cell]) -> dict[str, Any]:
    return dict(zip(map(cell_text, grid.head), row, strict=True))


def _told_motion(row: Mapping[str, Any]) -> ToldMotion:
    """Columns in which nothing stands are left out, and a centre at infinity is a word."""
    spin, *shift = (0 if isinstance(x := row.get(k, ""), str) else x for k in ("rotation", "shift x", "shift y"))
    x = row.get("centre x", "")
    return ToldMotion(None if isinstance(x, str) else (x, row["centre y"]), spin, shift, row.get("at", ""))


# -- the mechanism -----------------------------------------------------------------------------------


def _mechanism(plan: VelocityPlan, blocks: Sequence[RigidBlock], delta: Node) -> Grid:
    """Of every block its centre of rotation and its rotation, or its displacement."""
    if plan.system.scope.model.space != "plane":
        return _mechanism_in_space(plan, blocks, delta)
    rows: list[tuple[Cell, ...]] = []
    for number, block in enumerate(blocks, start=1):
        center = block.center(plan)
        place: tuple[Cell, Cell] = ("at infinity", "") if center.place is None else (center.place[0], center.place[1])
        moved = [plan.simple(x) for x in center.direction or (0, 0, 0)]
        shift = ("", "") if center.place is not None else (moved[0] * delta, moved[1] * delta)
        rows.append((numeral(number), _parts(plan, block, blocks), *place, block.spin[2] * delta, *shift))
    return _narrow(("block", "moves", "centre x", "centre y", "rotation", "shift x", "shift y"), rows)


def _mechanism_in_space(plan: VelocityPlan, blocks: Sequence[RigidBlock], delta: Node) -> Grid:
    """Of every body its rotation and the displacement of its mass centre; nodes are named, loads show their shifts."""
    rows: list[tuple[Cell, ...]] = []
    for number, block in enumerate(blocks, start=1):
        if not block.bodies:
            continue
        moved = plan.center_velocity(block.bodies[0])
        spin = tuple(plan.simple(x) * delta for x in block.spin)
        rows.append((numeral(number), _parts(plan, block, blocks), *spin, *(x * delta for x in moved)))
    nodes = tuple(node for block in blocks for node in block.nodes)
    if nodes:
        rows.append(("nodes", _listed(nodes), *("",) * 6))
    axes = ("x", "y", "z")
    head = ("block", "moves", *(f"rotation {k}" for k in axes), *(f"shift {k}" for k in axes))
    return _narrow(head, rows)


def _parts(plan: VelocityPlan, block: RigidBlock, blocks: Sequence[RigidBlock]) -> str:
    """Its bodies, members and nodes; a truss as one where all of it is in the block."""
    if len(plan.moving) == len(plan.system.motion.links) and len(blocks) == 1:
        return "the whole structure"
    of_truss = Counter(truss for truss, _, _ in members_of(plan.system))
    inside = Counter(truss for truss, _ in block.members)
    whole = [truss for truss, number in inside.items() if number == of_truss[truss]]
    single = [f"{truss} {member}" for truss, member in block.members if truss not in whole]
    return _listed((*block.bodies, *(f"truss {truss}" for truss in whole), *single, *block.nodes))


# -- works -------------------------------------------------------------------------------------------


def _works(plan: VelocityPlan, terms: Sequence[WorkTerm], delta: Node) -> Grid:
    """Of every load that works the displacement of its point, and its work."""
    plane = plan.system.scope.model.space == "plane"
    size = 2 if plane else 3
    rows: list[tuple[Cell, ...]] = []
    for term in terms:
        *before, last = _points_of(plan, term.acting)
        for where, moved, turned in before:
            rows.append((term.acting.name, where, *_moved(moved, turned, size, delta), ""))
        where, moved, turned = last
        rows.append((term.acting.name, where, *_moved(moved, turned, size, delta), term.work * delta))
    turning = ("rotation",) if plane else ("rotation x", "rotation y", "rotation z")
    return _narrow(("load", "at", *(f"shift {k}" for k in "xyz"[:size]), *turning, "work"), rows)


Displaced = tuple[str, Vector | None, Vector | None]
"""(where a load acts, displacement of that point, rotation of the body): of what it works on."""


def _points_of(plan: VelocityPlan, acting: Acting) -> list[Displaced]:
    load = acting.load
    if load is None:
        return [(f"joint of {acting.name}", None, None)]
    if isinstance(load, Couple):
        return [(load.body, None, plan.spin(load.body))]
    if isinstance(load, PointForce):
        return [(point_name(plan, load.place), plan.velocity(load.place), None)]
    return _along(plan, load)


def _along(plan: VelocityPlan, load: SpreadLoad) -> list[Displaced]:
    """Of a uniform load its middle, where the resultant acts; of another both ends."""
    a, b = (point_name(plan, place) for place in (load.start, load.end))
    v, w = (plan.velocity(place) for place in (load.start, load.end))
    if not _same(load.at_start, load.at_end):
        return [(a, v, None), (b, w, None)]
    middle = vector_of(map(plan.simple, times(Fraction(1, 2), plus(v, w))))
    return [(f"middle of {a}, {b}", middle, None)]


def _moved(moved: Vector | None, turned: Vector | None, size: int, delta: Node) -> tuple[Cell, ...]:
    shift: tuple[Cell, ...] = ("",) * size if moved is None else tuple(x * delta for x in moved[:size])
    if turned is None:
        return (*shift, *("",) * (1 if size == 2 else 3))
    return (*shift, *(x * delta for x in (turned[2:] if size == 2 else turned)))


def point_name(plan: VelocityPlan, place: BodyPoint) -> str:
    """A place by the name of the point of the body that is there."""
    body, r = place
    motion = plan.system.motion
    if body is None:
        return "the ground"
    if is_node(body):
        return body
    named = [name for name, at in motion.points[body].items() if _same(at, r)]
    given = [name for name in named if name not in ("origin", "center")]
    if given:
        return f"{body}.{given[0]}"
    return f"mass centre of {body}" if _same(mass_properties(motion.scope, body).com, r) else body


def _same(a: Vector, b: Vector) -> bool:
    return all(is_zero(x - y) for x, y in zip(a, b, strict=True))


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
