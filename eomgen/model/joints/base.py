"""Base class of joints: declared moves, pose X(s), subspace S and its complement.

A joint gives its variables s, the pose X(s), the subspace S and its complement W, over any scalar.

The joint sits at a point of the parent (`on`, `at`), in axes that may be turned by a fixed rotation (`turned`), and at
a point of the child (`point`). Everything here is from the (turned) parent's joint frame to the child's joint frame.
A column of S or W has six entries, angular part (torque) first, at the joint point, in the child's axes.
"""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar

from eomgen.errors import ExpressionError, NotYet
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import ListRule
from eomgen.model.kinds import (
    ConstantAngle,
    JointFriction,
    Limits,
    MovingGroundPlace,
    OwnPointName,
    ReactionSymbolsField,
    SeatName,
    SpaceDirection,
    ValueOf,
)
from eomgen.model.part import Part, PartRule
from eomgen.model.positions import DocumentPath
from eomgen.model.quantities import Unit
from eomgen.model.shapes.forms import Form
from eomgen.symbolic.expression import (
    Expression,
    Graph,
    Matrix,
    Pose,
    Vector,
    cos,
    depends_on,
    derivative,
    sin,
)

# -------- moves -----------------------------------------------------------------------------------------------
# Moves of a joint, as they are declared: one after another, each in the axes that those before left.
#
# Fields and names alone, no formulas. Proofs look at them.


@dataclass(frozen=True)
class Move:
    """A displacement, and a turn: of a screw both along one axis, which need not have unit length.

    Args:
        axis: of both; None: z.
        way: along the axis, or along lines and arcs from the beginning of the first; None: 0 [m].
        angle: about the axis; None: 0 [rad].
        quaternion: of norm 1, scalar first, in place of an angle.
        heading: of the first of the lines and arcs, from x [rad].
        pieces: lines and arcs, end to end, the first and the last of which go on; the axes do not turn.
    """

    axis: Any = None
    way: Any = None
    angle: Any = None
    quaternion: Any = None
    heading: Any = None
    pieces: Any = ()


@dataclass(frozen=True)
class PushAlong:
    """Action along a displacement or an angle of a joint, on the child and opposite on the parent; None: nothing.

    push - stiffness (way - rest) - damping way', and armature way'^2 / 2 of kinetic energy; dry friction by its law.
    """

    way: Any
    push: Any = None
    stiffness: Any = None
    damping: Any = None
    rest: Any = None
    armature: Any = None
    friction: Any = None


# -------- base ------------------------------------------------------------------------------------------------


Scalars = tuple[Any, ...]
Column = tuple[Any, Any, Any, Any, Any, Any]

X: Vector = Vector((1, 0, 0))
Y: Vector = Vector((0, 1, 0))
Z: Vector = Vector((0, 0, 1))


@dataclass(frozen=True, kw_only=True)
class Turned(Part):
    """A fixed rotation by `angle` about `axis` (default z).

    Args:
        axis: in the axes that the rotation before left (None: z).
        angle: constant [rad].
    """

    title: ClassVar[str] = "turned"
    axis: SpaceDirection | None = None
    angle: ConstantAngle


Turns = Annotated[tuple[Turned, ...], ListRule(PartRule(Turned), single=True)]


@dataclass(frozen=True)
class Effort:
    """Action along one variable s of a joint, on the child and opposite on the parent (None: nothing).

    drive - stiffness (s - rest) - damping s', and armature s'^2 / 2 more of kinetic energy.
    """

    drive: Expression | None = None
    stiffness: Expression | None = None
    damping: Expression | None = None
    rest: Expression | None = None
    armature: Expression | None = None


@dataclass(frozen=True, kw_only=True)
class Joint(Part):
    """Connection of a body to its parent.

    Args:
        on: the parent, or a point of it (`arm.end`, then without `at`); None: the ground.
        at: where the joint sits, parent's axes (None: its origin) [m]; on the ground also a point's name.
        point: the point of this body that sits there; None: its origin.
        turned: fixed rotations before the joint, each about the axes that the one before left.
        symbol: letter of its reactions in formulas, in LaTeX: A gives A_x, A_y, M_A.
    """

    kind: ClassVar[str]
    only_space: ClassVar[bool] = False
    carries_reaction: ClassVar[bool] = True
    straight: ClassVar[bool] = True  # what slides in it keeps its direction
    driven_by: ClassVar[str] = ""  # the field of what drives its one variable
    limited: ClassVar[tuple[str, ...]] = ()  # its variables' fields that may have limits or friction, in their order
    seated: ClassVar[bool] = True  # `at` is where the joint sits; else it is among the variables

    on: SeatName | None = None
    at: MovingGroundPlace | None = None
    point: OwnPointName | None = None
    turned: Turns | None = None
    symbol: ReactionSymbolsField | None = None

    def orientation_before(self, value: ValueOf) -> Matrix:
        """The fixed rotation before the joint."""
        return oriented(self.turned, value)

    @property
    def limits_of_variables(self) -> tuple[tuple[int, str, Limits], ...]:
        """(number of the variable, its field, its limits) of each variable with limits."""
        if getattr(self, "stop", None) is not None:
            return ()
        return tuple((self.limited.index(name), name, limits) for name, limits in self.given_limits)

    @property
    def given_limits(self) -> tuple[tuple[str, Limits], ...]:
        """(field of the variable, its limits), of rigid stops and of those that yield."""
        given = getattr(self, "limits", None)
        if given is None:
            return ()
        each = (given,) if isinstance(given, Limits) else (entry_of(given, name) for name in self.limited)
        return tuple((name, limits) for name, limits in zip(self.limited, each, strict=True) if limits is not None)

    @property
    def frictions(self) -> tuple[tuple[int, str, JointFriction], ...]:
        """(number of the variable, its field, its friction) of each variable with dry friction."""
        given = getattr(self, "friction", None)
        if given is None or not self.limited:
            return ()
        each = (given,) if isinstance(given, JointFriction) else (entry_of(given, name) for name in self.limited)
        pairs = zip(self.limited, each, strict=True)
        return tuple((k, name, law) for k, (name, law) in enumerate(pairs) if law is not None)

    def variable_of(self, field: str) -> Expression:
        """The variable of that field; of `angles2` the second of its angles."""
        found: Expression = entry_of(self, field)
        return found

    @staticmethod
    def unit_of(field: str) -> str:
        """The SI unit of the variable of a field, "rad" or "m"."""
        return "rad" if field.startswith("angle") else "m"

    def unit_of_limits(self, field: str, coordinates: Mapping[str, Any]) -> Unit | None:
        """The unit of plain limits of a variable a q + b: that of its coordinate q; of any other None, SI.

        Units that do not fit are not meant: with q in mm, q/r is an angle, in radians.
        """
        variable, units = self.variable_of(field), self.units_in(field, coordinates)
        alone = len(units) == 1 and variable.names & coordinates.keys() == units.keys()
        return units[min(units)] if alone and _is_affine(variable, min(units)) else None

    def units_in(self, field: str, coordinates: Mapping[str, Any]) -> dict[str, Unit]:
        """The units not of SI of coordinates in a variable, in which it may be given itself."""
        variable, own = self.variable_of(field), Unit.parse(self.unit_of(field))
        parts = {} if variable is None else {name: coordinates.get(name) for name in sorted(variable.names)}
        units = {name: part.unit for name, part in parts.items() if part is not None and part.unit is not None}
        return {name: u for name, u in units.items() if u.fits(own) and (u.factor != 1 or u.pi_power != 0)}

    def named_contact(self, body: str, field: str) -> str:
        """Name of what acts along a variable: that of the body, of several variables arm_angle."""
        return f"{body}_{field}" if len(self.limited) > 1 else body

    @property
    def parent(self) -> str | None:
        """The parent body (None: the ground)."""
        return None if self.on is None else self.on.split(".", 1)[0]

    def turns(self) -> tuple[Expression, ...]:
        """The expressions that turn the child against the parent."""
        return ()

    @property
    def spins(self) -> tuple[str, ...]:
        """Speeds that S takes in place of the rates of a quaternion, the last four variables; () of other joints."""
        return ()

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of fields that do not fit together; each field alone is checked by its rule."""
        yield from ()

    def works_in(self, space: str) -> bool:
        """True if this version derives the joint in this space."""
        return space == "space" or not self.only_space

    def moves(self) -> tuple[Move, ...]:
        """The declared moves of the joint, from the (turned) parent's joint frame to the child's."""
        raise self._not_yet()

    @property
    def moves_from_parent(self) -> tuple[Move, ...]:
        """The fixed rotations, then the moves of the joint."""
        return (*(Move(each.axis, angle=each.angle) for each in self.turned or ()), *self.moves())

    def variables(self, space: str) -> tuple[Expression, ...]:
        """The joint's variables s, f of them."""
        raise self._not_yet()

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        """Pose of the child's joint frame in the parent's."""
        raise self._not_yet()

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        """Angle of the child relative to the parent in the plane [rad]."""
        return 0

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        """S, f columns: the twist of the child against the parent is S s'."""
        raise self._not_yet()

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        """W, 6 - f columns with S^T W = 0: the wrenches that the joint can carry."""
        raise self._not_yet()

    def guides(self, value: ValueOf, seat: Pose) -> tuple[Form, ...]:
        """The curve along which the child's joint point moves, where it is not straight, in the axes of the seat."""
        return ()

    def efforts(self) -> tuple[Effort | None, ...]:
        """Drive, spring, damper and rotor of each variable, in the order of s."""
        return ()

    def pushes(self) -> tuple[PushAlong, ...]:
        """The declared actions along its variables, which the proof uses instead of `efforts`."""
        return ()

    def _not_yet(self) -> NotYet:
        """A kind whose fields are read and whose law this version does not state."""
        return NotYet(f"the joint '{self.kind}' is not derived yet")


def entry_of(part: Any, field: str) -> Any:
    """Entry of a field, of `angles2` its second entry; None where there is none."""
    if hasattr(part, field):
        return getattr(part, field)
    entries = getattr(part, field.rstrip("123"), None) or ()
    number = field[len(field.rstrip("123")) :]
    return entries[int(number) - 1] if number and int(number) <= len(entries) else None


def _is_affine(variable: Expression, name: str) -> bool:
    """True if the rate of an expression by one of its names does not depend on that name."""
    if variable.text == name:
        return True
    graph = Graph()
    symbols = {each: graph.symbol(each) for each in variable.names if each != "pi"}
    try:
        rate = derivative(variable.evaluate({**symbols, "pi": graph.pi}), symbols[name])
    except ExpressionError:  # a function of samples, or no value
        return False
    return not depends_on(rate, (symbols[name],))


def vector(components: tuple[Expression, ...] | None, value: ValueOf, default: Vector = Vector.ZERO) -> Vector:
    """A vector of the model, 3, with z = 0 in the plane."""
    if components is None:
        return default
    values = [value(c) for c in components]
    return Vector(values + [0] * (3 - len(values)))


def oriented(turns: tuple[Turned, ...] | None, value: ValueOf) -> Matrix:
    """The rotation that turns one after the other make, each about the axes that the one before left."""
    R = Matrix.IDENTITY
    for turn in turns or ():
        axis = vector(turn.axis, value, Z).unit
        angle = value(turn.angle)
        R = R @ Matrix.rotation(axis, cos(angle), sin(angle))
    return R


def across(n: Vector) -> tuple[Vector, Vector]:
    """Two directions that with the unit vector n span space (a component that is plainly 0 keeps them short)."""
    for k in (2, 1, 0):
        if n[k] == 0:
            e = (X, Y, Z)[k]
            return e, n.cross(e)
    e = n.cross(Z)
    return e, n.cross(e)


def angular(n: Vector) -> Column:
    """A turn about n, or a torque along it."""
    return (*n, 0, 0, 0)


def linear(n: Vector) -> Column:
    """A displacement, or a force, along n."""
    return (0, 0, 0, *n)
