"""Model -> the model stated otherwise: laws in place of its inputs; its bodies free to move but for constraints."""

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, ClassVar

from eomgen.errors import UsageError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import nearest
from eomgen.model.fields import MOTION, Table, WrittenEquation
from eomgen.model.joints.ball import rotation_by, turning_columns
from eomgen.model.joints.base import Column, Effort, Joint, Move, Scalars, X, Y, Z, angular, linear
from eomgen.model.joints.placed import Placed
from eomgen.model.kinds import Coordinates, ValueOf
from eomgen.model.model import Model
from eomgen.model.part import Part, PartRule
from eomgen.model.parts import Body, Coordinate, in_parts
from eomgen.symbolic.expression import Call, Expression, Matrix, Pose, Reference, Vector, cos, sin

# -------- driven -----------------------------------------------------------------------------------------------
# Model, laws of inputs over the state -> the model in which they stand in place of the inputs: feedback.

# What is put in so is derived, proven and emitted with everything else.


Laws = Mapping[str, Expression]


def with_feedback(model: Model, laws: Laws) -> Model:
    """The model with laws in place of inputs; their gains may be plain numbers, whatever their dimensions.

    Raises:
        UsageError: a law names what there is not, or what may not stand where its input stood.
    """
    if not laws:
        return model
    allowed = Catalog(model, ()).allowed[MOTION] - laws.keys()
    for name, law in laws.items():
        strangers = [other for other, _ in law.occurrences if other not in allowed]
        if strangers:
            what = f"inputs: {name} = {law.text}: '{strangers[0]}' cannot stand in it"
            raise UsageError(
                what, fix=nearest(strangers[0], allowed) or "coordinates, rates, t, parameters, other inputs"
            )
    left = {name: part for name, part in model.inputs.items() if name not in laws}
    fields = {slot.name: getattr(model, slot.name) for slot in Model.slots() if slot.name != "inputs"}
    return model.altered(**{name: _put(value, laws) for name, value in fields.items()}, inputs=Table(left))


def _put(value: Any, laws: Laws) -> Any:
    """A value of the model with the laws in it."""
    if isinstance(value, Expression):
        return _expression(value, laws)
    if isinstance(value, WrittenEquation):
        return replace(value, left=_expression(value.left, laws), right=_expression(value.right, laws))
    if isinstance(value, Part):
        fields = {slot.name: getattr(value, slot.name) for slot in type(value).slots()}
        return type(value).of_values({name: _put(x, laws) for name, x in fields.items()})
    if isinstance(value, tuple):
        return tuple(_put(x, laws) for x in value)
    return Table({name: _put(x, laws) for name, x in value.items()}) if isinstance(value, Table) else value


def _expression(formula: Expression, laws: Laws) -> Expression:
    """A formula in which a law stands for each of its names."""
    if laws.keys().isdisjoint(formula.names):
        return formula
    code: list[tuple[str, Any]] = []
    columns: list[int] = []
    for (kind, what), column in zip(formula.code, formula.columns, strict=True):
        law = laws.get(what) if kind == "name" else None
        if law is not None:
            code += law.code
            columns += [-1] * len(law.code)
            continue
        code.append((kind, _called(what, laws) if kind == "call" else what))
        columns.append(column)
    text = formula.text
    for name, law in laws.items():
        text = f"({law.text})".join(re.split(rf"(?<![\w.']){re.escape(name)}(?![\w'(])", text))
    return Expression(text, tuple(code), tuple(columns))


def _called(call: Call, laws: Laws) -> Call:
    return replace(call, args=tuple(x if isinstance(x, Reference) else _expression(x, laws) for x in call.args))


# -------- unassembled ------------------------------------------------------------------------------------------
# Model -> Model in which every body that only constraints can hold is free to move.
#
# A body without joint, or `placed` by constants, stands still by declaration. For velocities the constraints alone
# say how it can move. So it gets displacements from where it stands, 0 at the start: x, y and a turn in the plane;
# x, y, z and three turns about its own successive axes in space. Then the constraints are rows in their rates.

SMALL = "xyz"  # the sequence of the three turns


@dataclass(frozen=True, kw_only=True)
class DisplacedJoint(Joint):
    """A body displaced from where it is placed; no file can name this joint, and it carries no reaction.

    s = (d, turns):  p = p_0 + d,  R = R_0 R(turns).

    Args:
        placed: where it stands.
        along: the names of the displacements, 2 or 3.
        about: the names of the turns: none of a particle, 1 in the plane, 3 in space.
    """

    kind: ClassVar[str] = "displaced"
    carries_reaction: ClassVar[bool] = False
    seated: ClassVar[bool] = False
    placed: Annotated[Placed, PartRule(Placed)]
    along: Coordinates
    about: Coordinates

    def variables(self, space: str) -> tuple[Expression, ...]:
        return tuple(Expression(name, (("name", name),), (-1,)) for name in (*self.along, *self.about))

    def moves(self) -> tuple[Move, ...]:
        names, places = self.variables(""), len(self.along)
        about = (Z,) if len(self.about) == 1 else (X, Y, Z)
        slides = map(Move, (X, Y, Z), names[:places])
        turns = (Move(axis, angle=name) for axis, name in zip(about, names[places:], strict=False))
        return (*slides, *self.placed.moves(), *turns)

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return self._standing(value)[2] + (s[2] if self.about else 0)

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        places = len(self.along)
        still = self.placed.pose(self._standing(value), value)
        R = still.R @ self._rotation(s[places:]) if self.about else still.R
        return Pose(R, still.p + Vector((*s[:places], *[0] * (3 - places))))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        R_CP = self.pose(s, value).R.T
        along = tuple(linear(R_CP @ e) for e in (X, Y, Z)[: len(self.along)])
        if len(self.about) == 1:
            return (*along, angular(Z))
        return (*along, *turning_columns(SMALL, s[3:])) if self.about else along

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return ()

    def efforts(self) -> tuple[Effort | None, ...]:
        return ()

    def _standing(self, value: ValueOf) -> Scalars:
        """The joint variables of the place where a body stands."""
        return tuple(value(e) for e in self.placed.variables("plane" if len(self.along) == 2 else "space"))

    def _rotation(self, turns: Scalars) -> Matrix:
        return Matrix.rotation(Z, cos(turns[0]), sin(turns[0])) if len(turns) == 1 else rotation_by(SMALL, turns)


def freed(model: Model) -> Model:
    """The model in which what only constraints can hold has displacements; the other bodies keep their joints.

    Trusses are taken apart. Everything that names a body means the same body; the new coordinates have names that no
    file can write.
    """
    model = in_parts(model)
    bodies: dict[str, Body] = dict(model.bodies)
    coordinates: dict[str, Coordinate] = dict(model.coordinates)
    for name in loose_bodies(model):
        along, about = _displacements(model, name)
        bodies[name] = model.bodies[name].altered(joint=_displaced(model.bodies[name].joint, along, about))
        coordinates |= {each: Coordinate.of_values({"start": Expression.number(0)}) for each in (*along, *about)}
    return model.altered(bodies=Table(bodies), coordinates=Table(coordinates))


def loose_bodies(model: Model) -> tuple[str, ...]:
    """The bodies that stand still by declaration: without joint, or placed by constants."""
    return tuple(name for name, body in model.bodies.items() if _stands(model, body.joint))


def _displacements(model: Model, body: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The names of the displacements and of the turns of a loose body; a point does not turn."""
    axes = "xy" if model.space == "plane" else "xyz"
    part = model.bodies[body]
    point = part.shape is not None and part.shape.is_point and not part.points
    turns = () if point else ("turn",) if axes == "xy" else tuple(f"turn_{axis}" for axis in axes)
    return tuple(f"({body}.{axis})" for axis in axes), tuple(f"({body}.{turn})" for turn in turns)


def _stands(model: Model, joint: Any) -> bool:
    if joint is None:
        return True
    if joint.carries_reaction or not joint.works_in(model.space):
        return False
    constants = {"pi", *model.parameters}
    return all(e.names <= constants for e in joint.variables(model.space))


def _displaced(joint: Joint | None, along: tuple[str, ...], about: tuple[str, ...]) -> DisplacedJoint:
    placed: Joint = Placed.of_values({}) if joint is None else joint
    kept = {"on": placed.on, "point": placed.point, "turned": placed.turned}
    return DisplacedJoint.of_values({**kept, "placed": placed, "along": along, "about": about})
