"""Reactions, multipliers, drives, tensions and section forces."""

from collections.abc import Iterator

from eomgen.errors import DerivationError
from eomgen.model.catalog import Catalog
from eomgen.model.constraints.link import ends_requested
from eomgen.model.diagnostics import Diagnostic, nearest
from eomgen.model.fields import Leaf
from eomgen.model.outputs.base import (
    AXES,
    DRY_JOINT,
    SIDES,
    OutputContext,
    OutputFunction,
    OutputSource,
    ValueOf,
    along,
    component,
    formula_at,
)
from eomgen.symbolic.expression import Call, Expression, Reference, Scalar

# -------- reactions -------------------------------------------------------------------------------------------
# reaction_x, reaction_n, reaction_couple, ...: of a constraint, or of the joint of a body, by the balance of the
# bodies.
#
# Their second way is the same balance, solved in doubles at one state (`NumericState.reactions`), and the Newton and
# Euler equations of every body, into which the certificate puts them.


def _placed(call: Call) -> tuple[str, str, str]:
    """(constraint or body, the side, the frame) of reaction_x(B), reaction_x(B.II), reaction_y(bar, bar)."""
    owner, frame = (*call.names, "")[:2]
    name, _, side = owner.partition(".")
    return name, side, frame


def _force(scene: OutputContext, call: Call) -> Scalar:
    return scene.reactions.component("force", component(call), *_placed(call))


def _couple(scene: OutputContext, call: Call) -> Scalar:
    return scene.reactions.component("couple", component(call), *_placed(call))


def _one_couple(scene: OutputContext, call: Call) -> Scalar:
    """Couple of a constraint; in space along the axle of the gear's first body, as others have no one direction."""
    if scene.is_plane:
        return scene.reactions.component("couple", AXES["z"], *_placed(call))
    owner, _, _ = _placed(call)
    if scene.reactions.labels(owner) != ["couple"] or str(call) != f"reaction_couple({owner})":
        names = ", ".join(str(call).replace("couple(", f"couple_{axis}(") for axis in AXES)
        raise DerivationError(f"'{call}': a couple in space has three components", fix=f"ask {names}")
    return scene.reactions.multiplier(owner)


def _contact(scene: OutputContext, call: Call) -> Scalar:
    owner, side, _ = _placed(call)
    if side:
        fix = f"ask {call.name}({owner}), at an instant where it is meant"
        raise DerivationError(f"'{call}': normal force and friction are on the body named first", fix=fix)
    if call.name == "reaction_n":
        return scene.reactions.normal(owner)
    return scene.reactions.friction(owner, call.name[-1])


REACTION_FORCE = OutputFunction(
    names=along("reaction_*"),
    kinds=("reaction", "body"),
    least=1,
    shown="(constraint or body[, body])",
    unit="N",
    gives="[reaction](reactions.md) of a constraint, or of a joint, in ground axes or those of the second body",
    value=_force,
    source=OutputSource.BALANCE,
)
REACTION_COUPLE = OutputFunction(
    names=along("reaction_couple_*"),
    kinds=("reaction", "body"),
    least=1,
    shown="(constraint or body[, body])",
    unit="N*m",
    gives="its couple, about the point of the joint or constraint",
    value=_couple,
    source=OutputSource.BALANCE,
)
ONE_REACTION_COUPLE = OutputFunction(
    names=("reaction_couple",),
    kinds=("reaction", "body"),
    least=1,
    shown="(constraint or body[, body])",
    unit="N*m",
    gives="the same in the plane; in space of a gear, along the axle of its first body",
    value=_one_couple,
    source=OutputSource.BALANCE,
)
CONTACT_REACTION = OutputFunction(
    names=("reaction_n", "reaction_t", "reaction_s"),
    kinds=("reaction", "body"),
    least=1,
    shown="(constraint or body)",
    unit="N",
    gives="normal force and friction of a contact, a guide, a path; `reaction_s` across `reaction_t` on a surface",
    value=_contact,
    source=OutputSource.BALANCE,
)


# -------- efforts ---------------------------------------------------------------------------------------------
# multiplier, drive, pull, couple: along the gap of a constraint, a driven coordinate, a spring, a damper.


FRICTION_OF_JOINT = OutputFunction(
    names=("friction",),
    kinds=(DRY_JOINT,),
    least=1,
    unit="J",
    per=(0,),
    gives="dry friction in a [joint](joints.md#dry-friction), on the body along its variable: N m of an angle, else N",
    value=lambda scene, call: scene.reactions.friction_of_joint(call.name_at(0)),
    source=OutputSource.BALANCE,
)
MULTIPLIER = OutputFunction(
    names=("multiplier",),
    kinds=("constraint",),
    least=1,
    unit="J",
    per=(0,),
    gives="of a constraint of one row",
    value=lambda scene, call: scene.multiplier(call.name_at(0)),
    second=lambda trial, call: trial.held(call.name_at(0)),
    source=OutputSource.BALANCE,
)
DRIVE = OutputFunction(
    names=("drive",),
    kinds=("coordinate",),
    least=1,
    unit="J",
    per=(0,),
    gives="force or couple that moves a driven coordinate as given",
    value=lambda scene, call: scene.drive(call.name_at(0)),
    second=lambda trial, call: trial.demanded(call.name_at(0)),
    source=OutputSource.BALANCE,
)
IMPULSE = OutputFunction(
    names=("impulse",),
    kinds=("constraint",),
    least=1,
    unit="J*s",
    per=(0,),
    gives="of a contact, if it closes at that state; of a constraint in the impact of the one contact that can close",
    value=lambda scene, call: scene.impulse(call.name_at(0)),
    second=lambda trial, call: trial.struck(call.name_at(0)),
    moves=True,
)
IMPULSE_OF_FORCES = OutputFunction(
    names=along("impulse_*"),
    kinds=("reaction",),
    least=1,
    shown="(constraint or body)",
    unit="N*s",
    gives="of a joint or constraint, ground axes, on its child, in the impact of the one contact that can close",
    value=lambda scene, call: scene.impulse(call.name_at(0), component(call)),
    second=lambda trial, call: trial.struck(call.name_at(0), component(call)),
    moves=True,
)
PULL = OutputFunction(
    names=("pull",),
    kinds=("force between points",),
    least=1,
    unit="N",
    gives="of a spring, a damper, a `between`, a bumper: what draws its points together; of a rope its tension",
    value=lambda scene, call: scene.effort(call.name_at(0)),
    second=lambda trial, call: trial.acting(call.name_at(0)),
    moves=True,
)
COUPLE = OutputFunction(
    names=("couple",),
    kinds=("force between bodies",),
    least=1,
    unit="N*m",
    gives="of a torsion spring or damper: on its second body, counter-clockwise",
    value=lambda scene, call: scene.effort(call.name_at(0)),
    second=lambda trial, call: -trial.acting(call.name_at(0)),
    moves=True,
)


# -------- tension ---------------------------------------------------------------------------------------------
# tension: of a link, of a strand of a string, or of a member of a truss.


def _tension(scene: OutputContext, call: Call) -> Scalar:
    """tension(rope), tension(rope, 2), or tension(T, n1-n2) of a truss."""
    name, strand = call.name_at(0), call.args[1:]
    if scene.is_truss(name):
        return scene.reactions.member(name, *_ends(call))
    literal = strand[0].literal if strand and isinstance(strand[0], Expression) else None
    number = literal if isinstance(literal, int) else None
    if (strand and number is None) or len(strand) > 1:
        raise DerivationError(
            f"'{call}': the second argument is the number of the strand, from 1", fix="tension(string, 1)"
        )
    return scene.reactions.tension(name, number)


def _ends(call: Call) -> tuple[str, str]:
    """The nodes of the member that an output names."""
    ends = ends_requested(call)
    if ends is None:
        raise DerivationError(f"'{call}' names no member of a truss", fix=f"write tension({call.args[0]}, n1-n2)")
    return ends


def _diagnostics(catalog: Catalog, leaf: Leaf, call: Call) -> Iterator[Diagnostic]:
    """Diagnostics of a truss's tension: it must name one of its members."""
    owner = call.args[0]
    if not isinstance(owner, Reference):
        return
    truss = catalog.table("trusses").get(owner.name)
    if truss is None or truss.members is None:
        return
    ends = ends_requested(call)
    if ends is None or set(ends) not in [set(member.split("-")) for member in truss.members]:
        what = f"truss '{owner.name}' has no member '{'-'.join(ends)}'" if ends else f"'{call}' names no member"
        fix = nearest("-".join(ends or ()), truss.members) or f"tension({owner.name}, {truss.members[0]})"
        yield Diagnostic(leaf.path, what, fix, call.column, len(call.name))


TENSION = OutputFunction(
    names=("tension",),
    kinds=("constraint or truss", "any", "any"),
    least=1,
    shown="(constraint[, number]) or (truss, n1-n2)",
    unit="N",
    gives="of a link; of a strand of a string, from 1 (default); of a capstan the mean, or of its side 1 or 2; "
    "of a member of a [truss](statics.md#trusses), by "
    "its two nodes",
    value=_tension,
    source=OutputSource.BALANCE,
    diagnostics=_diagnostics,
)


# -------- section forces --------------------------------------------------------------------------------------
# axial_force, shear_force, bending_moment: at a distance from the start of a body's line.


def _section(scene: OutputContext, call: Call) -> Scalar:
    """bending_moment(beam, a), shear_force(beam, a, before)."""
    sides = [call.name_at(k) for k in range(2, len(call.args))]
    if any(name not in SIDES for name in sides):
        raise DerivationError(f"'{call}': the third argument is before or after", fix="N(body, x, before)")
    x = formula_at(call, 1).evaluate(scene.names)
    return scene.section(call.name_at(0)).value(call.name, x, *sides)


def _of(name: str, unit: str, gives: str, value: ValueOf) -> OutputFunction:
    return OutputFunction(
        names=(name,),
        kinds=("body", "number", "side"),
        least=2,
        shown="(body, distance[, before or after])",
        unit=unit,
        gives=gives,
        value=value,
        source=OutputSource.BALANCE,
    )


SECTION_FORCES = (
    _of(
        "axial_force",
        "N",
        "[section forces](statics.md#section-forces), at a distance from the start of its line",
        _section,
    ),
    _of("shear_force", "N", "across it; at a jump the side is needed", _section),
    _of("bending_moment", "N*m", "the moment there", _section),
)
