"""Text or Python -> Model: what a user declares. Frozen values that compute nothing."""

from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Annotated, Any, ClassVar, Self

from eomgen.frozen import dataclass
from eomgen.model import joints, shapes
from eomgen.model.constraints.link import Members
from eomgen.model.fields import (
    EVERY,
    UNIT,
    AtRest,
    CountRule,
    EquationRule,
    EventRule,
    InstantRule,
    Leaf,
    ListRule,
    NameRule,
    NumbersRule,
    OutputRule,
    StatementRule,
    Table,
    TableRule,
    TextRule,
    WrittenEquation,
)
from eomgen.model.joints import Joint
from eomgen.model.joints.base import Turns, Z, oriented, vector
from eomgen.model.joints.placed import Placed
from eomgen.model.kinds import (
    ConstantAngle,
    Coordinates,
    Flag,
    Formula,
    InertiaTensor,
    Mass,
    MotionLaw,
    MovingPlace,
    Place,
    RateInTime,
    RateLaw,
    RateOfState,
    SpaceDirection,
    SymbolField,
    Text,
    TimeLaw,
    TwoOwnPoints,
    ValueOf,
)
from eomgen.model.part import MADE, Part, PartRule, SeamRule
from eomgen.model.positions import DocumentPath
from eomgen.model.quantities import Unit
from eomgen.model.shapes import Shape
from eomgen.model.shapes.lines import Particle
from eomgen.symbolic.expression import Expression, Matrix, Pose, cos, sin

UnitText = Annotated[Unit, UNIT]
ShapeField = Annotated[Shape, SeamRule("shape", shapes.ALL)]
JointField = Annotated[Joint, SeamRule("joint", joints.ALL)]


@dataclass(frozen=True, kw_only=True)
class Parameter(Part):
    """A constant of the system.

    Args:
        value: a number, an expression of other parameters, or None (`{}`: open; then only derivations can be made).
        unit: in which the number is given; `value` is in SI already.
        about: a remark, printed in the derivation.
        positive: roots of its squares may be taken; a value that is not positive is an error.
        symbol: in formulas, in LaTeX (None: by its name).
        range: the numbers in `unit` from which variants of the problem draw it: two ends, or a list of values.
    """

    shorthand: ClassVar[str] = "value"
    title: ClassVar[str] = "parameter"
    in_unit: ClassVar[tuple[str, ...]] = ("value",)
    value: Formula | None = None
    unit: UnitText | None = None
    about: Text | None = None
    positive: Flag = False
    symbol: SymbolField | None = None
    range: Annotated[tuple[Any, ...], NumbersRule()] | None = None

    @property
    def formula(self) -> Expression | None:
        """The formula of other parameters that it is; None of a number."""
        return self.value if self.value is not None and self.value.names - {"pi"} else None


@dataclass(frozen=True, kw_only=True)
class Coordinate(Part):
    """A generalized coordinate q.

    Args:
        start, speed: q and q' at the start, t = 0 (None: 0).
        unit: in which the numbers are given, all of them here; they are in SI already.
        near: first guess of a dependent coordinate, or of an equilibrium.
        dependent: eliminated through the constraints.
        motion, rate, acceleration: q, q' (from `start`) or q'' (from `start` and `speed`) as a function of time, or
            through samples, of a driven coordinate; an acceleration needs an integral in closed form, as that of
            samples is.
        symbol: in formulas, in LaTeX (None: by its name); its rates get dots.
        about: a remark, printed in the derivation.
    """

    shorthand: ClassVar[str] = "start"
    title: ClassVar[str] = "coordinate"
    in_unit: ClassVar[tuple[str, ...]] = ("start", "speed", "near", "motion", "rate", "acceleration")
    start: Formula | None = None
    speed: Formula | None = None
    unit: UnitText | None = None
    about: Text | None = None
    near: Formula | None = None
    dependent: Flag = False
    motion: MotionLaw | None = None
    rate: RateInTime | None = None
    acceleration: TimeLaw | None = None
    symbol: SymbolField | None = None

    @property
    def driven(self) -> bool:
        """True if the model prescribes its motion."""
        return any(law is not None for law in (self.motion, self.rate, self.acceleration))

    @property
    def held(self) -> Self:
        """The same coordinate, which stays where it starts."""
        place = next((x for x in (self.start, self.near) if x is not None), Expression.number(0))
        return self.altered(start=None, speed=None, near=None, motion=place)


@dataclass(frozen=True, kw_only=True)
class Speed(Part):
    """A generalized speed that is not a rate, but a combination of the rates.

    Args:
        rate: the combination (None: named by a joint's `omega`).
        start: its value at the start (None: 0, or by the coordinates' `speed` where no speed has one).
        about: a remark, printed in the derivation.
        symbol: in formulas, in LaTeX (None: by its name).
    """

    shorthand: ClassVar[str] = "rate"
    title: ClassVar[str] = "speed"
    rate: RateLaw | None = None
    start: Formula | None = None
    about: Text | None = None
    symbol: SymbolField | None = None


@dataclass(frozen=True, kw_only=True)
class StateVariable(Part):
    """A state of first order: a current, a pressure, a temperature, an integral, z' = `rate`.

    Its rate may hold the whole state, accelerations, reactions and inputs; forces may depend on it. It moves no body.

    Args:
        rate: z' [its unit in SI per second].
        start: z at the start, t = 0 (None: 0).
        unit: in which `start` is given; it is in SI already.
        about: a remark, printed in the derivation.
        symbol: in formulas, in LaTeX (None: by its name); its rate gets a dot.
    """

    title: ClassVar[str] = "state"
    in_unit: ClassVar[tuple[str, ...]] = ("start",)
    rate: RateOfState | None  # None: the force that it belongs to gives it
    start: Formula | None = None
    unit: UnitText | None = None
    about: Text | None = None
    symbol: SymbolField | None = None
    force: str = field(default="", metadata={MADE: True})  # whose own it is; "": declared

    def leaves(self, path: DocumentPath) -> Iterator[Leaf]:
        """Its values; what a force gives its own states stands among the values of the force."""
        if not self.force:
            yield from Part.leaves(self, path)


@dataclass(frozen=True, kw_only=True)
class Input(Part):
    """A known function of time that a caller may replace.

    Args:
        value: a number, an expression of time, or samples.
        about: a remark.
        unit: in which the numbers are given; they are in SI already.
        symbol: in formulas, in LaTeX (None: by its name).
    """

    shorthand: ClassVar[str] = "value"
    title: ClassVar[str] = "input"
    in_unit: ClassVar[tuple[str, ...]] = ("value",)
    value: TimeLaw
    about: Text | None = None
    unit: UnitText | None = None
    symbol: SymbolField | None = None


@dataclass(frozen=True, kw_only=True)
class Piece(Part):
    """One piece of a composite body: a shape `at` a place, turned by `angle`; a hole takes away.

    Args:
        shape: its form; its mass only where the densities are not equal; of a hole, what it takes away.
        at: where the shape's origin is, body axes (None: the body's origin), 2 or 3 [m].
        turned: fixed rotations, each about the axes that the one before left.
        angle: after them, about `axis` (default z) [rad].
        hole: it takes away.
        axis: of `angle` (None: z).
    """

    title: ClassVar[str] = "a piece"
    shape: ShapeField = field(metadata={"inline": True})
    at: Place | None = None
    turned: Turns | None = None
    angle: ConstantAngle | None = None
    axis: SpaceDirection | None = None
    hole: Flag = False

    def pose(self, value: ValueOf) -> Pose:
        """Pose of its frame in the body: rotated as `turned` says, then by `angle` about `axis`."""
        R = oriented(self.turned, value)
        if self.angle is not None:
            angle = value(self.angle)
            R = R @ Matrix.rotation(vector(self.axis, value, Z).unit, cos(angle), sin(angle))
        return Pose(R, vector(self.at, value))


Pieces = Annotated[tuple[Piece, ...], ListRule(PartRule(Piece))]
PointTable = Annotated[Table[tuple[Expression, ...]], TableRule(MovingPlace.__metadata__[0], "point")]
GroundPoints = Annotated[Table[tuple[Expression, ...]], TableRule(Place.__metadata__[0], "point")]


@dataclass(frozen=True, kw_only=True)
class Body(Part):
    """A rigid body: its mass (`shape`; or `mass`, `center`, `inertia`; or `mass` and `parts`), its points, its joint.

    Args:
        center: mass centre in the body's axes (None: the origin) [m].
        inertia: about the mass centre, body axes: 1 value in the plane, 3 principal values or 6 `[xx, yy, zz, xy, yz,
            zx]` with the tensor's sign in space [kg m^2].
        line: two of its points, `["start", "end"]`, the axis of a bar: for sliders, and for section forces.
        measured: published data: no warning where `inertia` breaks the triangle inequality.
        symbol: its index in formulas, in LaTeX (None: its name).
        about: a remark.
        shape: a homogeneous body, with its mass, points and inertia.
        mass: instead of a shape; of a body of parts that of the net whole [kg].
        parts: a composite of shapes and holes.
        points: further points, `{ hook = [0, "l/2"] }`, which may hold coordinates and t, and then move in the body
            [m].
        joint: its connection (None: its frame is the ground's and does not move).
    """

    title: ClassVar[str] = "body"
    about: Text | None = None
    shape: ShapeField | None = None
    mass: Mass | None = None
    center: Place | None = None
    inertia: InertiaTensor | None = None
    parts: Pieces | None = None
    points: PointTable = Table()
    line: TwoOwnPoints | None = None
    joint: JointField | None = None
    measured: Flag = False
    symbol: SymbolField | None = None

    @property
    def may_be_massless(self) -> bool:
        """True if no mass is given, or one that is 0."""
        masses = [self.mass, getattr(self.shape, "mass", None)]
        given = [x for x in masses if x is not None]
        return not self.parts and (not given or any(x.literal == 0 for x in given))

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """Its shape, or those of its parts."""
        own = () if self.shape is None else (self.shape,)
        return (*(piece.shape for piece in self.parts or ()), *own)

    @property
    def path_pieces(self) -> tuple[Any, ...]:
        """The pieces of the path on which the body is; () where it is on none."""
        return getattr(self.joint, "pieces", None) or ()


@dataclass(frozen=True, kw_only=True)
class Truss(Part):
    """Massless two-force members between hinges: nodes and members `n1-n2`.

    Args:
        nodes: places of the hinges on the ground, 2 or 3 [m].
        members: bars, each as `"n1-n2"` by its two nodes.
        about: a remark.
    """

    title: ClassVar[str] = "truss"
    nodes: GroundPoints
    members: Annotated[tuple[str, ...], ListRule(NameRule("member"))]
    about: Text | None = None


@dataclass(frozen=True, kw_only=True)
class Linearize(Part):
    """The state about which the equations are linearized, and in which coordinates.

    Args:
        about: the equilibrium nearest to the start; the start, which must be a steady motion; or the steady motion
            sought from there.
        coordinates: the requested ones (None: all).
    """

    title: ClassVar[str] = "[linearize]"
    about: Annotated[str, TextRule(("equilibrium", "start", "steady"))] = "equilibrium"
    coordinates: Coordinates | None = None


@dataclass(frozen=True, kw_only=True)
class ImpactRules(Part):
    """The law of the model's impacts; with it, friction has a part in them.

    Args:
        law: where the restitution e ends: "newton" at the speed -e v, "poisson" at the impulse e times that of the
            compression, "energetic" (Stronge) at the work e^2 times that of the compression (None: Newton's law without
            friction, Poisson's with friction, which never gains energy).
        order: of contacts that touch: all at once, or one after the other, the one approached fastest first.
    """

    title: ClassVar[str] = "[impact]"
    law: Annotated[str, TextRule(("newton", "poisson", "energetic"))] | None = None
    order: Annotated[str, TextRule(("simultaneous", "sequential"))] = "simultaneous"


OutputEquations = Annotated[tuple[WrittenEquation, ...], ListRule(EquationRule(), single=True)]


@dataclass(frozen=True, kw_only=True)
class Given(Part):
    """Kinematics at one instant: known velocities and accelerations as equations.

    Args:
        velocity: equations that are linear in velocities.
        acceleration: equations that are linear in accelerations.
    """

    title: ClassVar[str] = "[given]"
    velocity: OutputEquations | None = None
    acceleration: OutputEquations | None = None


@dataclass(frozen=True, kw_only=True)
class Unknown(Part):
    """A number that is sought, and what it is.

    Args:
        about: what it is.
        unit: in which it is given.
        symbol: in formulas, in LaTeX (None: by its name).
    """

    shorthand: ClassVar[str] = "about"
    title: ClassVar[str] = "unknown"
    about: Text | None = None
    unit: UnitText | None = None
    symbol: SymbolField | None = None


@dataclass(frozen=True, kw_only=True)
class Output(Part):
    """A requested result, by name.

    Args:
        value: an expression that may call functions of the motion.
        at: the instant: `"t = 2"`, or any equation, `"theta = pi/2"`, `"x' = 0"`, `"reaction_n(wall) = 0"`: the first
            time after the start at which it holds; or "equilibrium".
        from_: with `at`: "start" (None), or "rest": from the start values with all speeds 0; without `at`: rates as
            functions of the coordinates, by the energy theorem.
        side: with `at`: just before (None) or just after the instant, where a quantity jumps.
        event: with `at`: which of the events of a run, from 1 on, or "every".
        unit: in which the answer is given (None: SI, and the unit that the formula has, as far as the file says).
        about: a remark.
        symbol: of the result, in LaTeX (None: by its name).
        digits: those that the answer is printed with (None: ten); in JSON and Python it has all.
    """

    shorthand: ClassVar[str] = "value"
    title: ClassVar[str] = "output"
    value: Annotated[Expression, OutputRule()]
    at: Annotated[WrittenEquation | AtRest, InstantRule()] | None = None
    from_: Annotated[str, TextRule(("start", "rest"))] | None = None
    side: Annotated[str, TextRule(("before", "after"))] | None = None
    event: Annotated[int | str, EventRule()] | None = None
    unit: UnitText | None = None
    about: Text | None = None
    symbol: SymbolField | None = None
    digits: Annotated[int, CountRule(1, 15)] | None = None

    @property
    def rests(self) -> bool:
        """True if it is requested in equilibrium."""
        return isinstance(self.at, AtRest)

    @property
    def condition(self) -> WrittenEquation | None:
        """The equation that is first met at its instant; None without one, and in equilibrium."""
        return self.at if isinstance(self.at, WrittenEquation) else None

    @property
    def of_every_event(self) -> bool:
        """True if all values are requested, one at each event of a run."""
        return self.event == EVERY


@dataclass(frozen=True, kw_only=True)
class Question(Part):
    """A question of a sheet, in words.

    Args:
        text: the question; `$...$` is a formula in LaTeX, `{m}` a declared name with its value.
        outputs: the names of the outputs that answer it.
    """

    shorthand: ClassVar[str] = "text"
    title: ClassVar[str] = "a question"
    text: Annotated[str, StatementRule()]
    outputs: Annotated[tuple[str, ...], ListRule(NameRule("output"), 1, single=True)] | None = None


# -------- trusses ----------------------------------------------------------------------------------------------
# Model -> the same model in bodies and constraints alone: nodes of trusses are massless points, their members
# constraints.
#
# A node "T.n1" is a body of that name: a particle without mass, placed where the node is. The members of truss T are
# the rows of one constraint T.


def in_parts(model: Any) -> Any:
    """The model with its trusses replaced by bodies and constraints; the model itself where it has none."""
    if not model.trusses:
        return model
    nodes = {f"{name}.{node}": _node(at) for name, truss in model.trusses.items() for node, at in truss.nodes.items()}
    members = {name: _members(name, truss) for name, truss in model.trusses.items() if truss.members}
    return model.altered(
        bodies=Table({**model.bodies, **nodes}),
        constraints=Table({**model.constraints, **members}),
        trusses=Table(),
    )


def _node(at: tuple[Expression, ...]) -> Body:
    point = Particle.of_values({"mass": Expression.number(0)})
    return Body.of_values({"shape": point, "joint": Placed.of_values({"at": at})})


def _members(name: str, truss: Truss) -> Members:
    return Members.of_values({"truss": name, "members": truss.members})


def is_node(body: str) -> bool:
    """True if a body of a model in parts is a node of a truss."""
    return "." in body


def called(body: str) -> str:
    """The name in messages of a body of a model in parts: body 'bar', node 'T.n1'."""
    return f"node '{body}'" if is_node(body) else f"body '{body}'"


def declared_at(body: str) -> str:
    """The path of its declaration: bodies.bar, trusses.T.nodes.n1."""
    truss, dot, node = body.partition(".")
    return f"trusses.{truss}.nodes.{node}" if dot else f"bodies.{body}"


# -------- declared speeds --------------------------------------------------------------------------------------
# Declared speeds -> those with start values of their own, and those that start by the rates of the coordinates.


def begun_speeds(speeds: Mapping[str, Any]) -> dict[str, frozenset[str]]:
    """{speed: the rates that go with it} of those that have a `start`, or share rates with one that has.

    Sharing reaches through others: where w1 holds x' and y', and w2 holds y' and z', a start of w2 decides for both.
    """
    groups: list[tuple[set[str], set[str]]] = []
    for name, part in speeds.items():
        rates = {x for x in _names(part) if x.endswith("'")}
        joined = [group for group in groups if group[1] & rates]
        groups = [group for group in groups if group not in joined]
        groups.append(({name}.union(*(g[0] for g in joined)), rates.union(*(g[1] for g in joined))))
    begun = [group for group in groups if any(_begins(speeds[name]) for name in group[0])]
    return {name: frozenset(rates) for names, rates in begun for name in names}


def _names(part: Any) -> frozenset[str]:
    return frozenset() if part is None or part.rate is None else frozenset(part.rate.names)


def _begins(part: Any) -> bool:
    return part is not None and part.start is not None
