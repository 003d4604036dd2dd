"""Kinds -> Centrodes: the curves on which the centre of rotation of a body runs, in the ground and in the body.

    c = p + omega x v / omega^2 in ground axes,   R^T (c - p) in the body's: the moving one rolls on the fixed one

Where one parameter moves the body (one freedom, or time alone) they are functions of the coordinates, or of t.
"""

from __future__ import annotations

from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.constraints.freedom import freedoms
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.curves import Curve, curve_of
from eomgen.mechanics.fields.field import field_of, rotation_center
from eomgen.mechanics.fields.motion_kind import PLANE, Kinds, in_body
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.graph import is_zero
from eomgen.symbolic.expression.spatial import Vector, vector_of
from eomgen.symbolic.numeric.work import Work


@dataclass(frozen=True)
class Centrodes:
    """The centre of rotation of one body as its motion goes on.

    Args:
        body: its name.
        fixed, moving: the place in ground axes and in body axes, functions of the coordinates and t.
        fixed_curve, moving_curve: the lines on which it runs.
    """

    body: str
    fixed: Vector
    moving: Vector
    fixed_curve: Curve
    moving_curve: Curve


def centrodes_of(kinds: Kinds, body: str) -> Centrodes | None:
    """The centrodes of a body in plane motion; None where it has no single ones.

    So it is where the centre stays or is at infinity, where more than one parameter moves the system, or where the
    rates are left to multipliers, and are no functions of one of them.
    """
    system = kinds.system
    if system.scope.model.space != "plane" or kinds.of(body).name != PLANE or parameters(kinds) != 1:
        return None
    try:
        center = rotation_center(field_of(system.motion, body))
        unit = dict.fromkeys(system.symbols.u, 1)  # one speed, which cancels
        (x, y, z) = substituted(center, unit)
    except DerivationError:
        return None
    places = (x, y, z), in_body(system, body, (x, y, z))
    fixed, moving = (
        vector_of(simplest(each, Work.VALUE, kinds.constants.positive) for each in place) for place in places
    )
    if depends_on(x, system.symbols.u) or len(system.symbols.u) > 1:
        return None
    curves = [curve_of(place, kinds.possible, kinds.constants) for place in (fixed, moving)]
    return Centrodes(body, fixed, moving, *curves)


def all_centrodes(kinds: Kinds) -> tuple[Centrodes, ...]:
    """The centrodes of all bodies that have them."""
    found = []
    for link in kinds.system.motion.links:
        try:
            found.append(centrodes_of(kinds, link.name))
        except (DerivationError, MissingValues):  # no motion near the start at which it could be tried
            continue
    return tuple(each for each in found if each is not None)


def parameters(kinds: Kinds) -> int:
    """How many parameters move a system: its freedoms by rank, and the time where something moves as given."""
    return freedoms(kinds.system.ties, kinds.possible.states[0]) + moves_by_itself(kinds.system)


def moves_by_itself(system: System) -> bool:
    """Whether coordinates move as given."""
    return not all(is_zero(x) for x in (*system.scope.nu, *system.ties.sigma))
