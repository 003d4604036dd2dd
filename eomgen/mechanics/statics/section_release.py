"""Structure, a section of a body -> Cut: how the two parts move against each other when the section is released.

N shifts them along the axis, V across it, M turns them about the section. With w on the part before the section all
other reactions do no work, so that the motion v of the bodies follows from

    G^T v = -(power of each reaction on the part before the section in the motion w)

and the part before it moves by v + w.
"""

from __future__ import annotations

from collections.abc import Callable

from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.balance.named_reactions import argument_name
from eomgen.mechanics.balance.unit_wrenches import Effect
from eomgen.mechanics.statics.member_axis import MemberAxis, Sizes, axis_of
from eomgen.mechanics.statics.member_loads import place_of
from eomgen.mechanics.structures.structure import Structure
from eomgen.model.findings import nearest
from eomgen.model.trusses import is_node
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.expressions import Call, Reference, parse
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.spatial import ZERO, Vector, apply, cross, dot, minus, plus, times, vector_of
from eomgen.symbolic.print.text import to_text


@dataclass(frozen=True)
class Cut:
    """A section that was released.

    Args:
        axis: of the body.
        x: where it is.
        before: whether the place of an effect, x along the axis, belongs to the part before it.
        shift: velocity of the part before the section against the part behind, at the section, ground axes.
        spin: angular velocity of the one part against the other, counter-clockwise.
        place: of the section, ground axes.
    """

    axis: MemberAxis
    x: Scalar
    before: Callable[[Scalar], bool]
    shift: Vector
    spin: Scalar
    place: Vector

    def velocity(self, position: Vector) -> Vector:
        """w of a place of the part before the section."""
        return plus(self.shift, cross((0, 0, self.spin), minus(position, self.place)))


def cut_of(structure: Structure, call: Call, sizes: Sizes) -> Cut:
    """The released section: N shifts along t, V across, -n, M turns by 1."""
    if not 2 <= len(call.args) <= 3:
        raise UsageError(
            f"influence line: {call}: a body and a place along it are asked for", mend=f'ask "{call.name}(body, x)"'
        )
    body, where, *side = call.args
    motion, names = structure.system.motion, structure.system.scope.names
    name = argument_name(body)
    if name not in motion.index or is_node(name):
        raise UsageError(f"influence line: {call}: there is no body '{name}'", mend=nearest(name, motion.index))
    axis = loaded_axis(structure, name, sizes)
    x = sizes.simple((parse(where.name) if isinstance(where, Reference) else where).evaluate(names))
    leg = next((leg for leg in reversed(axis.legs) if sizes.sign(x - leg.x) >= 0), axis.legs[0])
    if sizes.sign(x - axis.ends[0]) < 0 or sizes.sign(axis.ends[1] - x) < 0:
        raise UsageError(
            f"influence line: {call}: the section is beyond the ends of the body", mend="ask at a place of the body"
        )
    R = motion.link(name).pose.R
    t, n = (vector_of(substituted(apply(R, v), structure.at)) for v in (leg.along, leg.left))
    place = vector_of(substituted(motion.position((name, leg.place(x))), structure.at))
    shift = {"axial_force": t, "shear_force": times(-1, n), "bending_moment": ZERO}[call.name]
    at_end = sizes.sign(axis.ends[1] - x) == 0
    here = 1 if (argument_name(side[0]) if side else "before" if at_end else "after") == "before" else 0
    inside = not at_end and sizes.sign(x - axis.ends[0]) != 0
    if inside and not side and call.name != "bending_moment" and _is_pushed(structure, axis, x, name):
        asked = f"{call.name}({name}, {to_text(x)}"
        raise UsageError(f"influence line: {asked}) jumps there", mend=f"ask {asked}, before) or {asked}, after)")
    return Cut(axis, x, lambda s: sizes.sign(x - s) >= here, shift, int(call.name == "bending_moment"), place)


def _is_pushed(structure: Structure, axis: MemberAxis, x: Scalar, body: str) -> bool:
    """Whether a reaction acts at the section."""
    link = structure.system.motion.index[body]
    places = (e.place for _, effects in structure.pushes for e in effects if e.link == link and e.place is not None)
    distances = (axis.distance(place) for place in places)
    return any(s is not None and axis.sizes.sign(x - s) == 0 for s in distances)


def left_powers(structure: Structure, cut: Cut) -> dict[int, Scalar]:
    """Minus the power of each reaction and unknown load on the part before the section in the motion w."""
    found: dict[int, Scalar] = {}
    link = structure.system.motion.index[cut.axis.body]
    for j, (owner, effects) in enumerate(structure.pushes):
        power = sum((_power(structure, cut, e, owner) for e in effects if e.link == link), start=0)
        if not is_zero(power):
            found[j] = -power
    return found


def _power(structure: Structure, cut: Cut, effect: Effect, owner: str) -> Scalar:
    place = place_of(structure.components, effect, owner)
    s = None if place is None else cut.axis.distance(place)
    if place is None or s is None:
        raise DerivationError(
            f"'{owner}' acts on '{cut.axis.body}' off its axis: it has no section forces",
            f"bodies.{cut.axis.body}",
            mend="let it act at a point of the axis",
        )
    if not cut.before(s):
        return 0
    position = structure.system.motion.position((cut.axis.body, place))
    power = dot(effect.force, cut.velocity(position)) + effect.couple[2] * cut.spin
    return cut.axis.sizes.simple(substituted((power,), structure.at)[0])


def loaded_axis(structure: Structure, body: str, sizes: Sizes) -> MemberAxis:
    """The axis of a body, as far as reactions act on it."""
    motion = structure.system.motion
    link = motion.index[body]
    acting = [e.place for _, effects in structure.pushes for e in effects if e.link == link and e.place is not None]
    return axis_of(motion, body, acting, sizes)
