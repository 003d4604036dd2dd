"""The concepts that several parts share, each with its rule, and how a part is called in formulas.

The concepts that several parts share, each with its rule: what a mass, a length, a point's name may be.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.diagnostics import Diagnostic, unknown_keys
from eomgen.model.fields import (
    CONFIGURATION,
    FLOWING,
    MOTION,
    RATES,
    SPEEDS,
    STATE,
    TIME,
    AxialRule,
    EitherRule,
    FlagRule,
    FormulaRule,
    Leaf,
    ListRule,
    NameRule,
    ParsedTextRule,
    StatementRule,
    Table,
    TextRule,
    VectorRule,
    in_si,
    is_in_si,
)
from eomgen.model.part import Part, PartRule, Slot
from eomgen.model.positions import DocumentPath
from eomgen.model.quantities import Unit
from eomgen.model.sampled_laws import TimeLawRule
from eomgen.symbolic.expression import Expression, Sampled
from eomgen.symbolic.print import Symbol

ValueOf = Callable[[Expression], Any]
"""Value of an expression, in the arithmetic of the caller."""
VectorFormula = tuple[Expression, ...]

RESISTS = "it drives away from its rest"
TAKES = "it gives energy"

Formula = Annotated[Expression, FormulaRule()]
Mass = Annotated[Expression, FormulaRule("kg", "nonnegative", FLOWING)]
Length = Annotated[Expression, FormulaRule("m", "positive")]
MovingLength = Annotated[Expression, FormulaRule("m", "positive", TIME)]
Radius = Annotated[Expression, FormulaRule("m", "nonnegative")]
NaturalLength = Annotated[Expression | str, FormulaRule("m", "nonnegative", TIME, words=("start",))]
ConstantAngle = Annotated[Expression, FormulaRule("rad")]
Opening = Annotated[Expression, FormulaRule("rad", "positive")]
RestAngle = Annotated[Expression, FormulaRule("rad", "", TIME)]
InertiaTensor = Annotated[VectorFormula, AxialRule(FormulaRule("kg*m^2", "", FLOWING), (3, 6))]
RotorInertia = Annotated[Expression, FormulaRule("kg*m^2", "nonnegative")]
SlideInertia = Annotated[Expression, FormulaRule("kg", "nonnegative")]
RestLength = Annotated[Expression, FormulaRule("m", "", TIME)]
LinearStiffness = Annotated[Expression, FormulaRule("N/m", "", TIME, usually=RESISTS)]
AngularStiffness = Annotated[Expression, FormulaRule("N*m", "", TIME, usually=RESISTS)]
Pure = Annotated[Expression, FormulaRule("1")]
Friction = Annotated[Expression, FormulaRule("1", "nonnegative")]
Restitution = Annotated[Expression, FormulaRule("1", "nonnegative")]

Angle = Annotated[Expression, FormulaRule("rad", "", CONFIGURATION)]
Displacement = Annotated[Expression, FormulaRule("m", "", CONFIGURATION)]
PLACES = ("x", "y", "z", "angle")
VELOCITIES = ("vx", "vy", "vz", "omega", "omega_x", "omega_y", "omega_z")
Gap = Annotated[Expression, FormulaRule(None, "", CONFIGURATION, functions=PLACES)]
OF_REACTIONS = (
    *("reaction_x", "reaction_y", "reaction_z", "reaction_n", "reaction_t", "reaction_s"),
    *("reaction_couple", "reaction_couple_x", "reaction_couple_y", "reaction_couple_z"),
    *("tension", "friction", "multiplier", "drive"),
)
MotionEnergy = Annotated[Expression, FormulaRule("J", "", SPEEDS)]
Energy = Annotated[Expression, FormulaRule("J", "", CONFIGURATION)]
LinearDamping = Annotated[Expression, FormulaRule("N*s/m", "", MOTION, usually=TAKES)]
AngularDamping = Annotated[Expression, FormulaRule("N*m*s", "", MOTION, usually=TAKES)]
WorkingForce = Annotated[Expression, FormulaRule(None, "", MOTION, works_on="coordinate")]
ForceFormula = Annotated[Expression, FormulaRule("N", "", MOTION)]
Torque = Annotated[Expression, FormulaRule("N*m", "", MOTION)]
FlowRate = Annotated[Expression, FormulaRule("kg/s", "", MOTION)]
RateLaw = Annotated[Expression, FormulaRule(None, "", RATES)]
RateOfState = Annotated[Expression, FormulaRule(None, "", STATE, functions=OF_REACTIONS)]
VelocityLaw = Annotated[Expression, FormulaRule(None, "", SPEEDS, functions=(*PLACES, *VELOCITIES))]
Pull = Annotated[Expression, FormulaRule("N", "", MOTION, also=("r", "r'"), also_in="m")]
TimeLaw = Annotated[Expression, TimeLawRule(None, "", TIME)]
MotionLaw = Annotated[Expression, TimeLawRule(None, "", TIME, ways=Sampled.SMOOTH)]
MotionOfCoordinate = Annotated[Expression, TimeLawRule(None, "", TIME, same_as="coordinate", ways=Sampled.SMOOTH)]
RateInTime = Annotated[Expression, TimeLawRule(None, "", TIME, ways=(*Sampled.SMOOTH, "linear"))]

Place = Annotated[VectorFormula, VectorRule(FormulaRule("m"))]
MovingPlace = Annotated[VectorFormula, VectorRule(FormulaRule("m", "", CONFIGURATION))]
GroundPlace = Annotated[VectorFormula | str, VectorRule(FormulaRule("m"), point=True)]
MovingGroundPlace = Annotated[VectorFormula | str, VectorRule(FormulaRule("m", "", CONFIGURATION), point=True)]
Direction = Annotated[VectorFormula, VectorRule(FormulaRule(None), nonzero=True)]
SpaceDirection = Annotated[VectorFormula, VectorRule(FormulaRule(None), length=3, nonzero=True)]
ForceVector = Annotated[VectorFormula, VectorRule(FormulaRule("N", "", MOTION))]
FlowVelocity = Annotated[VectorFormula, VectorRule(FormulaRule("m/s", "", MOTION))]
LineLoad = Annotated[VectorFormula, VectorRule(FormulaRule("N/m", "", MOTION))]
TwoLineLoads = Annotated[tuple[VectorFormula, ...], ListRule(VectorRule(FormulaRule("N/m", "", MOTION)), 2, 2)]
Acceleration = Annotated[VectorFormula, VectorRule(FormulaRule("m/s^2", "", TIME), downward=True)]
CoupleFormula = Annotated[VectorFormula, AxialRule(FormulaRule("N*m", "", MOTION))]
Size = Annotated[VectorFormula, VectorRule(FormulaRule("m", "positive"), length=3)]
PlaneSize = Annotated[VectorFormula, VectorRule(FormulaRule("m", "positive"), length=2)]

BodyName = Annotated[str, NameRule("body")]
PointName = Annotated[str, NameRule("point")]
OwnPlace = Annotated[VectorFormula | str, VectorRule(FormulaRule("m"), own_point=True)]
OwnPointName = Annotated[str, NameRule("own point")]
SeatName = Annotated[str, NameRule("seat")]
CoordinateName = Annotated[str, NameRule("coordinate")]
AxesName = Annotated[str, NameRule("axes")]
Flag = Annotated[bool, FlagRule()]
Text = Annotated[str, TextRule()]
Paragraphs = Annotated[tuple[str, ...], ListRule(StatementRule(), single=True)]
Turn = Annotated[str, TextRule(("cw", "ccw"))]

TwoOwnPoints = Annotated[tuple[str, ...], ListRule(NameRule("own point"), 2, 2)]
TwoPoints = Annotated[tuple[str, ...], ListRule(NameRule("point"), 2, 2)]
Points = Annotated[tuple[str, ...], ListRule(NameRule("point"), 1)]
TwoBodies = Annotated[tuple[str, ...], ListRule(NameRule("body"), 2, 2)]
Bodies = Annotated[tuple[str, ...], ListRule(NameRule("body"), 1)]
Coordinates = Annotated[tuple[str, ...], ListRule(NameRule("coordinate"), 1)]


# -------- symbols ---------------------------------------------------------------------------------------------
# How a part is called in formulas, where it says so: LaTeX, checked when it is read.


REACTIONS = ("x", "y", "z", "n", "t", "s", "couple", "tension", "drive")
SYMBOL = ParsedTextRule(
    Symbol,
    Symbol.parsed,
    "a symbol",
    r"like '\theta_A' or 'J_C', in single quotes",
    (("minLength", 1), ("maxLength", Symbol.LONGEST)),
)


@dataclass(frozen=True)
class ReactionSymbols:
    """Symbols of the reactions of a joint or a constraint.

    Args:
        letter: of all of them: A gives A_x, A_y, M_A; of one that is alone its symbol.
        each: the symbol of a component by its label: {x: H, n: N_1}.
    """

    letter: Symbol | None = None
    each: Table[Symbol] = Table()


@dataclass(frozen=True)
class ReactionSymbolsRule:
    """One symbol for all reactions, or a table with one for each: { x = 'H', y = 'V' }."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> ReactionSymbols | None:
        if isinstance(raw, ReactionSymbols):
            return raw
        if not isinstance(raw, Mapping):
            letter = SYMBOL.read(raw, path, found)
            return None if letter is None else ReactionSymbols(letter)
        unknown_keys(raw, REACTIONS, path, found, "the symbols of reactions")
        read = {label: SYMBOL.read(raw[label], (*path, label), found) for label in REACTIONS if label in raw}
        return ReactionSymbols(None, Table({label: symbol for label, symbol in read.items() if symbol is not None}))

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        if value.letter is not None:
            yield Leaf(path, self, value.letter, part)
        for label, symbol in value.each.items():
            yield Leaf((*path, label), self, symbol, part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        one = SYMBOL.schema(definitions)
        table = {"type": "object", "properties": dict.fromkeys(REACTIONS, one), "additionalProperties": False}
        return {"anyOf": [one, table]}


SymbolField = Annotated[Symbol, SYMBOL]
ReactionSymbolsField = Annotated[ReactionSymbols, ReactionSymbolsRule()]


# -------- wraps -----------------------------------------------------------------------------------------------
# The way of a string or rope from point to point, over pulleys, pegs and drums.


@dataclass(frozen=True, kw_only=True)
class Wrap(Part):
    """A round thing that the string lies on.

    Args:
        body: a pulley, about its origin.
        radius: None: the shape's [m].
        turn: the sense in which one travels round it.
        axis: in space, about which it is round and the sense is seen, in the axes of the body or the ground; None: z.
        slip: the string slides on it: one tension through.
        at: instead of a body: a place of the ground about which there is a peg [m].
    """

    title: ClassVar[str] = "a wrap of the string"
    body: BodyName | None = None
    at: GroundPlace | None = None
    radius: Radius | None = None
    turn: Turn | None = None
    axis: SpaceDirection | None = None
    slip: Flag = False


Route = Annotated[tuple[str | Wrap, ...], ListRule(EitherRule(NameRule("point"), PartRule(Wrap)), least=2)]


# -------- friction --------------------------------------------------------------------------------------------
# Friction of a contact: Coulomb's `mu`, or a viscous coefficient.


Viscosity = Annotated[Expression, FormulaRule("s/m", "nonnegative")]  # -c N v


@dataclass(frozen=True, kw_only=True)
class Resistance(Part):
    """`friction = mu`: mu |N| against the sliding velocity; `{ viscous = c }`: -c N v.

    Args:
        coulomb: mu, as which a bare number counts.
        viscous: c [s/m].
    """

    shorthand: ClassVar[str] = "coulomb"
    title: ClassVar[str] = "friction"
    coulomb: Friction | None = None
    viscous: Viscosity | None = None


FrictionLaw = Annotated[Resistance, PartRule(Resistance)]


# -------- friction of joints ----------------------------------------------------------------------------------
# Dry friction along a joint's variable: of a given size, or of the joint's own reaction force R.


TorqueSize = Annotated[Expression, FormulaRule("N*m", "nonnegative", MOTION)]
ForceSize = Annotated[Expression, FormulaRule("N", "nonnegative", MOTION)]
TorqueOrCoefficient = Annotated[
    Expression, FormulaRule(None, "nonnegative", like=("torque", "coefficient"), scope=MOTION)
]
TurningSpeed = Annotated[Expression, FormulaRule("rad/s", "positive")]
SlidingSpeed = Annotated[Expression, FormulaRule("m/s", "positive")]


@dataclass(frozen=True, kw_only=True)
class JointFriction(Part):
    """Dry friction along a variable of a joint.

    While it moves, - T sign(s'), or - mu |R| sign(s'), times r in a hinge; at rest what holds it, up to the same with
    `static`. Smooth: - T tanh(s'/v), which never rests. T may be any formula of the motion, of t and of inputs; where
    that falls below 0 it is 0.
    """

    title: ClassVar[str] = "friction"
    amount: ClassVar[str]  # the field of a given size
    static: Formula | None = None
    smooth: Formula | None = None

    @property
    def size(self) -> Expression | None:
        """The given torque or force while it moves; None where it depends on the load."""
        found: Expression | None = getattr(self, self.amount)
        return found

    @property
    def coulomb(self) -> Expression | None:
        """The friction of a unit of the joint's force, of a hinge mu r; None where its size is given."""
        return self._of_load(self._coefficient)

    @property
    def guide(self) -> Expression | None:
        """Length of a guide that carries force and couple at its two ends; None: the force alone counts, once."""
        found: Expression | None = getattr(self, "length", None)
        return found

    @property
    def grip(self) -> Expression | None:
        """The largest friction at rest: all of it, or that of a unit of the joint's force."""
        if self.static is None:
            return self.size if self._coefficient is None else self.coulomb
        return self.static if self._coefficient is None else self._of_load(self.static)

    @property
    def _coefficient(self) -> Expression | None:
        return getattr(self, "coefficient", None)

    def _of_load(self, mu: Expression | None) -> Expression | None:
        radius: Expression | None = getattr(self, "radius", None)
        return mu if mu is None or radius is None else mu * radius

    def diagnostics(self, path: DocumentPath) -> Iterator[Diagnostic]:
        """Diagnostics of sizes that exclude one another, or of which one is missing."""
        fields = [slot.name for slot in self.slots()]
        ways = [name for name in (self.amount, "coefficient") if name in fields]
        given = [name for name in ways if getattr(self, name) is not None]
        if len(given) != 1:
            what = f"the friction of the joint of '{path[1]}' needs {'one of ' * (len(ways) > 1)}"
            yield Diagnostic(path, what + " and ".join(map(repr, ways)), "its size while it moves")
        if "radius" in fields and (self._coefficient is None) != (getattr(self, "radius", None) is None):
            what = f"'coefficient' and 'radius' of the friction of the joint of '{path[1]}' go together"
            yield Diagnostic(path, what, "coefficient = 0.1, radius = 0.01: the friction torque is mu r |R|")
        if self.guide is not None and self._coefficient is None:
            what = f"the friction of the joint of '{path[1]}' has a 'length' and no 'coefficient'"
            yield Diagnostic(
                (*path, "length"), what, "a guide has a length where its friction goes by its load", key=True
            )
        if self.smooth is not None and self.static is not None:
            what = "smooth friction has no 'static': it never rests"
            yield Diagnostic((*path, "static"), what, "leave out one of the two", key=True)
        least, most = (
            None if x is None else x.literal for x in (getattr(self, given[0]) if given else None, self.static)
        )
        if least is not None and most is not None and most < least:
            what = f"'static' is {most}, below {least} while it moves"
            yield Diagnostic((*path, "static"), what, f"at least {least}, or leave it out", key=True)


@dataclass(frozen=True, kw_only=True)
class TurnFriction(JointFriction):
    """Dry friction of a given torque against a turn.

    Args:
        torque: T while it turns [N m].
        static: the largest torque at rest (None: T) [N m].
        smooth: v of - T tanh(s'/v), at which tanh reaches 76 %; None: it sticks and slips [rad/s].
    """

    amount: ClassVar[str] = "torque"
    torque: TorqueSize | None = None
    static: TorqueSize | None = None
    smooth: TurningSpeed | None = None


@dataclass(frozen=True, kw_only=True)
class HingeFriction(TurnFriction):
    """Dry friction of a hinge: of a given torque, or mu r |R| of the force R that it carries.

    Args:
        torque: T while it turns [N m].
        coefficient: mu, with `radius` in place of `torque`.
        radius: r of its pin [m].
        static: the largest at rest, a torque or a coefficient as the other (None: the same).
        smooth: v of - T tanh(s'/v), at which tanh reaches 76 %; None: it sticks and slips [rad/s].
    """

    torque: TorqueSize | None = None
    coefficient: Friction | None = None
    radius: Length | None = None
    static: TorqueOrCoefficient | None = None
    smooth: TurningSpeed | None = None


@dataclass(frozen=True, kw_only=True)
class ThreadFriction(TurnFriction):
    """Dry friction of a thread: of a given torque, or mu |N| of the force N of its flanks, along it at its mean radius.

    With the pitch h, tan(alpha) = h/r: a load W along the axis is raised by W r tan(alpha + rho), rho = atan(mu), let
    down by W r tan(alpha - rho), and held without a torque while tan(alpha) <= mu.

    Args:
        torque: T while it turns [N m].
        coefficient: mu, with `radius` in place of `torque`; of flanks at an angle beta mu/cos(beta).
        radius: r, the mean one of the thread [m].
        static: the largest at rest, a torque or a coefficient as the other (None: the same).
        smooth: v of - T tanh(s'/v), at which tanh reaches 76 %; None: it sticks and slips [rad/s].
    """

    torque: TorqueSize | None = None
    coefficient: Friction | None = None
    radius: Length | None = None
    static: TorqueOrCoefficient | None = None
    smooth: TurningSpeed | None = None


@dataclass(frozen=True, kw_only=True)
class PushFriction(JointFriction):
    """Dry friction of a given force against a slide.

    Args:
        force: F while it slides [N].
        static: the largest force at rest (None: F) [N].
        smooth: v of - F tanh(s'/v), at which tanh reaches 76 %; None: it sticks and slips [m/s].
    """

    amount: ClassVar[str] = "force"
    force: ForceSize | None = None
    static: ForceSize | None = None
    smooth: SlidingSpeed | None = None


@dataclass(frozen=True, kw_only=True)
class SlideFriction(PushFriction):
    """Dry friction of a slide: of a given force, or mu |N| of the force N across it.

    With a `length` L it is that of a guide which touches at both ends, L/2 before and behind the joint's point of the
    body: force N across and couple M across are two forces N/2 +- M x n/L, n along the slide, in the plane N/2 +- M/L,
    and friction is mu times the sum of their sizes. A drawer that is pushed at an offset e jams when 2 mu e/L >= 1.
    The couple about the slide itself does not count.

    Args:
        force: F while it slides [N].
        coefficient: mu, in place of `force`.
        length: L of the guide, with `coefficient`; None: N alone counts [m].
        static: the largest at rest, a force or a coefficient as the other (None: the same).
        smooth: v of - F tanh(s'/v), at which tanh reaches 76 %; None: it sticks and slips [m/s].
    """

    force: ForceSize | None = None
    coefficient: Friction | None = None
    length: Length | None = None
    static: (
        Annotated[Expression, FormulaRule(None, "nonnegative", like=("force", "coefficient"), scope=MOTION)] | None
    ) = None
    smooth: SlidingSpeed | None = None


@dataclass(frozen=True, kw_only=True)
class SleeveFriction(Part):
    """Dry friction of what turns about an axis and slides along it, each alone.

    Args:
        displacement: against the slide.
        angle: against the turn.
    """

    title: ClassVar[str] = "friction"
    displacement: Annotated[PushFriction, PartRule(PushFriction)] | None = None
    angle: Annotated[TurnFriction, PartRule(TurnFriction)] | None = None


@dataclass(frozen=True, kw_only=True)
class PlanarFriction(Part):
    """Dry friction of what moves in a plane, along each variable alone.

    Args:
        x, y: against each slide.
        angle: against the turn.
    """

    title: ClassVar[str] = "friction"
    x: Annotated[PushFriction, PartRule(PushFriction)] | None = None
    y: Annotated[PushFriction, PartRule(PushFriction)] | None = None
    angle: Annotated[TurnFriction, PartRule(TurnFriction)] | None = None


# -------- limits ----------------------------------------------------------------------------------------------
# Limits of a joint's variables: rigid stops, each a constraint that can only push.


ENDLESS = ("inf", "-inf")


@dataclass(frozen=True)
class Limits:
    """The least and the largest value of a joint's variable; None where there is none.

    Args:
        settled: of each end, True if it is in SI; else it is a plain number in the unit of the coordinate.
    """

    low: Expression | None = None
    high: Expression | None = None
    settled: tuple[bool, bool] = (True, True)

    @property
    def plain(self) -> tuple[Expression, ...]:
        """The ends that are plain numbers in the unit of the coordinate."""
        ends = zip((self.low, self.high), self.settled, strict=True)
        return tuple(x for x, known in ends if x is not None and not known)

    def in_si(self, unit: Unit | None) -> "Limits":
        """Both ends in SI.

        Args:
            unit: of plain numbers; None: SI.
        """
        low, high = self.settled
        return Limits(self.low if low else in_si(self.low, unit), self.high if high else in_si(self.high, unit))

    @classmethod
    def slots(cls) -> tuple[Slot, ...]:
        """Its two values, by their places in the list of the file."""
        return tuple(Slot(name, k, None, False, False, None) for k, name in enumerate(("low", "high")))


@dataclass(frozen=True)
class LimitsRule:
    """[least, largest], each a number in the coordinate's unit, an expression in SI, or "inf" where there is none.

    A quantity with a unit of its own, { value = 20, unit = "deg" }, is in that.
    """

    item: FormulaRule

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Limits | None:
        if isinstance(raw, Limits):
            return raw
        if not isinstance(raw, (list, tuple)) or len(raw) != 2:
            found.append(
                Diagnostic(path, "the least and the largest value are needed here", 'like [-1.5, 1.5], "inf" for none')
            )
            return None
        ends = [None if self._is_endless(x) else self.item.read(x, (*path, i), found) for i, x in enumerate(raw)]
        plain = [x is not None and not x.names and not is_in_si(given) for x, given in zip(ends, raw, strict=True)]
        return Limits(ends[0], ends[1], (not plain[0], not plain[1]))

    @staticmethod
    def _is_endless(raw: Any) -> bool:
        return str(raw) in ENDLESS

    def leaves(self, value: Limits, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        for i, x in enumerate((value.low, value.high)):
            if x is not None:
                yield from self.item.leaves(x, (*path, i), part)

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        one = {"anyOf": [{"enum": list(ENDLESS)}, self.item.schema(definitions)]}
        return {"type": "array", "items": one, "minItems": 2, "maxItems": 2}


@dataclass(frozen=True)
class FromFieldRule:
    """A value that another field declares: it is checked there."""

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        return raw

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        yield from ()

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return {}


AngleLimits = Annotated[Limits, LimitsRule(FormulaRule("rad", in_own_unit=True))]
SlideLimits = Annotated[Limits, LimitsRule(FormulaRule("m", in_own_unit=True))]
FromField = Annotated[Any, FromFieldRule()]


@dataclass(frozen=True, kw_only=True)
class TurnStop(Part):
    """Stops that yield: beyond a limit by x, k x + d x' pushes back and never pulls.

    Args:
        stiffness: k [N m].
        damping: d [N m s].
    """

    title: ClassVar[str] = "stop"
    stiffness: AngularStiffness
    damping: AngularDamping | None = None


@dataclass(frozen=True, kw_only=True)
class SlideStop(Part):
    """Stops that yield: beyond a limit by x, k x + d x' pushes back and never pulls.

    Args:
        stiffness: k [N/m].
        damping: d [N s/m].
    """

    title: ClassVar[str] = "stop"
    stiffness: LinearStiffness
    damping: LinearDamping | None = None


@dataclass(frozen=True, kw_only=True)
class SleeveLimits(Part):
    """Limits of what turns about an axis and slides along it.

    Args:
        displacement: [least, largest], in the unit of its coordinate [m].
        angle: the same [rad].
    """

    title: ClassVar[str] = "limits"
    displacement: SlideLimits | None = None
    angle: AngleLimits | None = None


@dataclass(frozen=True, kw_only=True)
class PlanarLimits(Part):
    """Limits of what moves in a plane.

    Args:
        x, y: [least, largest], in the unit of each coordinate [m].
        angle: the same [rad].
    """

    title: ClassVar[str] = "limits"
    x: SlideLimits | None = None
    y: SlideLimits | None = None
    angle: AngleLimits | None = None


@dataclass(frozen=True, kw_only=True)
class TurnsLimits(Part):
    """Limits of what turns one axis after the other.

    Args:
        angles: [least, largest] of each angle, in the unit of its coordinate [rad].
    """

    title: ClassVar[str] = "limits"
    angles: Annotated[tuple[Limits, ...], ListRule(LimitsRule(FormulaRule("rad", in_own_unit=True)), 2, 3)]
