"""reaction_x, reaction_n, reaction_couple, ...: of a tie, or of the joint of a body, by the balance of the bodies.

Their second way is the same balance, solved in doubles at one state (`NumericState.reactions`), and the Newton and
Euler equations of every body, into which the certificate puts them.
"""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.model.outputs.base import AXES, BALANCE, OutputFunction, along, component, names_of
from eomgen.model.outputs.context import OutputContext
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.spatial import AnyScalar


def _placed(call: Call) -> tuple[str, str, str]:
    """(tie or body, the side, the frame) of reaction_x(B), reaction_x(B.II), reaction_y(bar, bar)."""
    owner, frame = (*names_of(call), "")[:2]
    name, _, side = owner.partition(".")
    return name, side, frame


def _force(scene: OutputContext, call: Call) -> AnyScalar:
    return scene.reactions.component("force", component(call), *_placed(call))


def _couple(scene: OutputContext, call: Call) -> AnyScalar:
    return scene.reactions.component("couple", component(call), *_placed(call))


def _one_couple(scene: OutputContext, call: Call) -> AnyScalar:
    """In space along the axle of the gear's first body; other couples have no one direction there."""
    if scene.is_plane:
        return scene.reactions.component("couple", AXES["z"], *_placed(call))
    owner, _, _ = _placed(call)
    if scene.reactions.labels(owner) != ["couple"] or str(call) != f"reaction_couple({owner})":
        names = ", ".join(str(call).replace("couple(", f"couple_{axis}(") for axis in AXES)
        raise DerivationError(f"'{call}': a couple in space has three components", mend=f"ask {names}")
    return scene.reactions.multiplier(owner)


def _contact(scene: OutputContext, call: Call) -> AnyScalar:
    owner, side, _ = _placed(call)
    if side:
        mend = f"ask {call.name}({owner}), at an instant where it is meant"
        raise DerivationError(f"'{call}': normal force and friction are on the body named first", mend=mend)
    if call.name == "reaction_n":
        return scene.reactions.normal(owner)
    return scene.reactions.friction(owner, call.name[-1])


REACTION_FORCE = OutputFunction(
    names=along("reaction_*"),
    kinds=("reaction", "body"),
    least=1,
    shown="(tie or body[, body])",
    unit="N",
    gives="[reaction](#reactions) of a tie, or of the body's joint, in ground axes or those of the body named second",
    value=_force,
    source=BALANCE,
)
REACTION_COUPLE = OutputFunction(
    names=along("reaction_couple_*"),
    kinds=("reaction", "body"),
    least=1,
    shown="(tie or body[, body])",
    unit="N*m",
    gives="its couple, about the point of the joint or tie",
    value=_couple,
    source=BALANCE,
)
ONE_REACTION_COUPLE = OutputFunction(
    names=("reaction_couple",),
    kinds=("reaction", "body"),
    least=1,
    shown="(tie or body[, body])",
    unit="N*m",
    gives="the same in the plane; in space of a gear, along the axle of its first body",
    value=_one_couple,
    source=BALANCE,
)
CONTACT_REACTION = OutputFunction(
    names=("reaction_n", "reaction_t", "reaction_s"),
    kinds=("reaction", "body"),
    least=1,
    shown="(tie or body)",
    unit="N",
    gives="normal force and friction of a contact, a guide, a path; `reaction_s` across `reaction_t` on a surface",
    value=_contact,
    source=BALANCE,
)
