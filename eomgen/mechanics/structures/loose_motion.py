"""Plan -> in words, how bodies that nothing holds can move: "body 'CD' can turn about (2*a, 0)"."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from eomgen.errors import DerivationError
from eomgen.mechanics.structures.blocks import RigidBlock, blocks_of
from eomgen.mechanics.structures.structure import Structure
from eomgen.mechanics.structures.velocity_plan import VelocityPlan
from eomgen.model.constraints.base import Constraint
from eomgen.model.trusses import declared_at
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.spatial import Vector, cross, dot, times, vector_of
from eomgen.symbolic.print.text import to_text

MOST_NAMES = 6  # of parts that move together
MOST_MOTIONS = 3  # that are told in words


def refuse_loose(structure: Structure, freedoms: int = 0) -> None:
    """Refuse bodies that can move although no coordinate describes it, and would.

    Args:
        freedoms: the motions that coordinates describe.
    Raises:
        DerivationError: which bodies can move, and how.
    """
    if structure.mobility <= freedoms or stays(structure):
        return
    told = [motion_in_words(plan) for plan in structure.loose[:MOST_MOTIONS]]
    more = len(structure.loose) - len(told)
    enough = structure.indeterminacy + freedoms >= structure.mobility
    kind = "infinitesimally movable" if enough else "unstable"
    what = f"the structure is {kind}: {'; '.join(told)}{f'; and {more} more' if more else ''}"
    if freedoms:
        what += f" ({freedoms} of these motions {'is' if freedoms == 1 else 'are'} a coordinate's)"
    if enough:
        what += f"; its {len(structure.rows)} reactions are not independent there"
    raise DerivationError(what, declared_at(_culprit(structure.loose[0])), _mend(structure, enough))


def stays(structure: Structure) -> bool:
    """Whether what nothing resists stays where it is all the same.

    A straight body does not turn about its own line. Where the loads do no work what hangs on strings hangs still, and
    so does a machine of which an unknown load is asked for.
    """
    if structure.turns_idly:
        return True
    kept = bool(structure.unknowns) or all(_hangs(structure, plan) for plan in structure.loose)
    return kept and structure.is_in_balance


def _hangs(structure: Structure, plan: VelocityPlan) -> bool:
    """Whether a string pulls every body that moves."""
    system = structure.system
    ties = system.scope.model.constraints
    ropes = [row for row in system.ties.rows if row.component == "tension" and _only_pulls(ties[row.tie])]
    pulled = {body for row in ropes for body, _ in row.wrenches}
    return set(plan.moving) <= pulled


def _only_pulls(tie: Constraint) -> bool:
    return bool(tie.strand_rows()) or bool(getattr(tie, "unilateral", False))


def _culprit(plan: VelocityPlan) -> str:
    """A body or node that moves."""
    blocks = blocks_of(plan)
    named = [name for block in blocks for name in block.bodies]
    return named[0] if named else plan.moving[0]


def _mend(structure: Structure, enough: bool) -> str:
    if structure.is_special:
        return "at other values of the parameters it is held: change these, or turn a support"
    if enough:
        return "turn or move a support or hinge, so that it stands across this motion"
    held = "hold it against this motion by a further support, hinge, clamp or member"
    model = structure.system.scope.model
    if not model.coordinates and any(force.elastic for force in model.forces.values()):
        held += "; a spring holds only what a coordinate moves: name the angle or displacement in the body's joint"
    balanced = "; its loads are in balance even so, what they need then `eomgen reactions` gives"
    return held + (balanced if structure.is_in_balance else "")


def motion_in_words(plan: VelocityPlan) -> str:
    """body 'AC' can turn about (4*a, 0), with it body 'CD' about (16*a, 0)"""
    (name, (verb, _, how)), *others = [(_named(block), _motion(plan, block)) for block in blocks_of(plan)]
    following = [f"{other} {doing} {how}" for other, (_, doing, how) in others[:MOST_MOTIONS]]
    following += [f"{len(others) - MOST_MOTIONS} more blocks"] if len(others) > MOST_MOTIONS else []
    return f"{name} can {verb} {how}" + (f", with it {' and '.join(following)}" if following else "")


def _named(block: RigidBlock) -> str:
    """Its bodies; of trusses its members, or its nodes."""
    members = [member for _, member in block.members]
    kinds: list[tuple[str, str, Sequence[str]]] = [
        ("body", "bodies", block.bodies),
        ("member", "members", members),
        ("node", "nodes", block.nodes),
    ]
    return " and ".join(_of_kind(one, many, names) for one, many, names in kinds if names)


def _of_kind(one: str, many: str, names: Sequence[str]) -> str:
    shown = ", ".join(f"'{name}'" for name in names[:MOST_NAMES])
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"{one if len(names) == 1 else many} {shown}{more}"


def _motion(plan: VelocityPlan, block: RigidBlock) -> tuple[str, str, str]:
    """(slide, sliding, along x), (turn, turning, about (a, 0))"""
    if plan.vanishes(block.spin):
        return "slide", "sliding", f"along {_direction(plan, vector_of(map(plan.simple, block.velocity)))}"
    place = block.center(plan).place if plan.system.scope.model.space == "plane" else None
    return "turn", "turning", _screw(plan, block) if place is None else f"about {_tuple(place[:2])}"


def _screw(plan: VelocityPlan, block: RigidBlock) -> str:
    """In space: the axis through w x v_O / w.w along w, and the advance along it."""
    w, v = block.spin, block.velocity
    square = dot(w, w)
    place = tuple(plan.simple(over(x, square)) for x in cross(w, v))
    turning = f"about the axis through {_tuple(place)} along {_direction(plan, w)}"
    return turning if plan.vanishes((dot(w, v),)) else f"{turning}, advancing along it"


def _direction(plan: VelocityPlan, vector: Vector) -> str:
    """x, y, z, or the components against the first that is not 0."""
    kept = [k for k in range(3) if not plan.vanishes((vector[k],))]
    if len(kept) == 1:
        return "xyz"[kept[0]]
    ratio = times(over(1, vector[kept[0]]), vector)
    size = 2 if plan.system.scope.model.space == "plane" else 3
    return _tuple([plan.simple(x) if k in kept else 0 for k, x in enumerate(ratio)][:size])


def _tuple(scalars: Iterable[Scalar]) -> str:
    return f"({', '.join(to_text(x) for x in scalars)})"
