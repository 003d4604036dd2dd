"""The concepts that several parts share, each with its rule: what a mass, a length, a point's name may be."""

from typing import Annotated

from eomgen.model.containers import ListRule
from eomgen.model.fields import (
    CONFIGURATION,
    MOTION,
    RATES,
    SPEEDS,
    TIME,
    AxialRule,
    FlagRule,
    FormulaRule,
    NameRule,
    TextRule,
    VectorRule,
)
from eomgen.model.samples import TimeLawRule
from eomgen.symbolic.expression.expressions import Expression

Vector = tuple[Expression, ...]

Formula = Annotated[Expression, FormulaRule()]
Mass = Annotated[Expression, FormulaRule("kg", "nonnegative")]
Length = Annotated[Expression, FormulaRule("m", "positive")]
Radius = Annotated[Expression, FormulaRule("m", "nonnegative")]
NaturalLength = Annotated[Expression | str, FormulaRule("m", "nonnegative", TIME, words=("start",))]
ConstantAngle = Annotated[Expression, FormulaRule("rad")]
Opening = Annotated[Expression, FormulaRule("rad", "positive")]
RestAngle = Annotated[Expression, FormulaRule("rad", "", TIME)]
InertiaTensor = Annotated[Vector, AxialRule(FormulaRule("kg*m^2"), (3, 6))]
RotorInertia = Annotated[Expression, FormulaRule(None, "nonnegative")]
RestLength = Annotated[Expression, FormulaRule("m", "", TIME)]
LinearStiffness = Annotated[Expression, FormulaRule("N/m", "", TIME)]
AngularStiffness = Annotated[Expression, FormulaRule("N*m", "", TIME)]
Pure = Annotated[Expression, FormulaRule("1")]
Friction = Annotated[Expression, FormulaRule("1", "nonnegative")]

Angle = Annotated[Expression, FormulaRule("rad", "", CONFIGURATION)]
Displacement = Annotated[Expression, FormulaRule("m", "", CONFIGURATION)]
PLACES = ("x", "y", "z", "angle")
VELOCITIES = ("vx", "vy", "vz", "omega", "omega_x", "omega_y", "omega_z")
Gap = Annotated[Expression, FormulaRule(None, "", CONFIGURATION, functions=PLACES)]
Energy = Annotated[Expression, FormulaRule("J", "", CONFIGURATION)]
Law = Annotated[Expression, FormulaRule(None, "", MOTION)]
ForceFormula = Annotated[Expression, FormulaRule("N", "", MOTION)]
Torque = Annotated[Expression, FormulaRule("N*m", "", MOTION)]
RateLaw = Annotated[Expression, FormulaRule(None, "", RATES)]
VelocityLaw = Annotated[Expression, FormulaRule(None, "", SPEEDS, functions=(*PLACES, *VELOCITIES))]
Pull = Annotated[Expression, FormulaRule("N", "", MOTION, also=("r", "r'"))]
TimeLaw = Annotated[Expression, TimeLawRule(None, "", TIME)]
MotionLaw = Annotated[Expression, TimeLawRule(None, "", TIME, ways=("cubic",))]
RateInTime = Annotated[Expression, TimeLawRule(None, "", TIME, ways=("cubic", "linear"))]

Place = Annotated[Vector, VectorRule(FormulaRule("m"))]
MovingPlace = Annotated[Vector, VectorRule(FormulaRule("m", "", CONFIGURATION))]
GroundPlace = Annotated[Vector | str, VectorRule(FormulaRule("m"), point=True)]
MovingGroundPlace = Annotated[Vector | str, VectorRule(FormulaRule("m", "", CONFIGURATION), point=True)]
Direction = Annotated[Vector, VectorRule(FormulaRule(None), nonzero=True)]
SpaceDirection = Annotated[Vector, VectorRule(FormulaRule(None), length=3, nonzero=True)]
ForceVector = Annotated[Vector, VectorRule(FormulaRule("N", "", MOTION))]
LineLoad = Annotated[Vector, VectorRule(FormulaRule("N/m", "", MOTION))]
TwoLineLoads = Annotated[tuple[Vector, ...], ListRule(VectorRule(FormulaRule("N/m", "", MOTION)), 2, 2)]
Acceleration = Annotated[Vector, VectorRule(FormulaRule("m/s^2", "", TIME))]
CoupleFormula = Annotated[Vector, AxialRule(FormulaRule("N*m", "", MOTION))]
Size = Annotated[Vector, VectorRule(FormulaRule("m", "positive"), length=3)]
PlaneSize = Annotated[Vector, VectorRule(FormulaRule("m", "positive"), length=2)]

BodyName = Annotated[str, NameRule("body")]
PointName = Annotated[str, NameRule("point")]
OwnPointName = Annotated[str, NameRule("own point")]
SeatName = Annotated[str, NameRule("seat")]
CoordinateName = Annotated[str, NameRule("coordinate")]
AxesName = Annotated[str, NameRule("axes")]
Flag = Annotated[bool, FlagRule()]
Text = Annotated[str, TextRule()]
Turn = Annotated[str, TextRule(("cw", "ccw"))]

TwoOwnPoints = Annotated[tuple[str, ...], ListRule(NameRule("own point"), 2, 2)]
TwoPoints = Annotated[tuple[str, ...], ListRule(NameRule("point"), 2, 2)]
Points = Annotated[tuple[str, ...], ListRule(NameRule("point"), 1)]
TwoBodies = Annotated[tuple[str, ...], ListRule(NameRule("body"), 2, 2)]
Bodies = Annotated[tuple[str, ...], ListRule(NameRule("body"), 1)]
Coordinates = Annotated[tuple[str, ...], ListRule(NameRule("coordinate"), 1)]
