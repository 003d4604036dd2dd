"""Text or Python -> Model: the whole that a user declares, and what follows from its declarations alone."""

from importlib import import_module
from typing import Annotated, Any, ClassVar

from eomgen.errors import EomgenError
from eomgen.frozen import RECALLED, dataclass
from eomgen.model import constraints, forces
from eomgen.model.constraints import Constraint
from eomgen.model.contacts import Connections
from eomgen.model.fields import (
    Table,
    TableRule,
    TextRule,
)
from eomgen.model.forces import Force
from eomgen.model.kinds import (
    Text,
)
from eomgen.model.making import finish
from eomgen.model.part import Part, PartRule, SeamRule, part_schema
from eomgen.model.parts import (
    Body,
    Coordinate,
    Given,
    GroundPoints,
    Input,
    Linearize,
    Output,
    Parameter,
    Speed,
    Truss,
    Unknown,
)
from eomgen.model.units import UnitsOfNames
from eomgen.model.unknowns import Unknowns
from eomgen.model.values import Numbers
from eomgen.symbolic.expression import Expression

DIALECT = "https://json-schema.org/draft/2020-12/schema"
"""of the JSON Schema of a model file"""


def _table(cls: type, what: str) -> TableRule:
    return TableRule(PartRule(cls), what)


Constraints = Annotated[Table[Constraint], TableRule(SeamRule("constraint", constraints.ALL), "constraint")]
Forces = Annotated[Table[Force], TableRule(SeamRule("force", forces.ALL), "force")]


@dataclass(frozen=True, kw_only=True, repr=False)
class Model(Numbers, Connections, Unknowns, UnitsOfNames, Part):
    """A mechanical system as declared: tables of named parts, each a read-only mapping in the user's order.

    Args:
        name: of the system (the file's stem where it is left out).
        space: the plane (x right, y up, turns about z, counter-clockwise positive), or space; required.
        about, source: remarks.
        parameters: constants.
        coordinates: what moves.
        speeds: generalized speeds that are not rates.
        inputs: known functions of time that a caller may replace.
        points: of the ground, fixed [m].
        bodies: what has a frame: its mass, points, joint.
        constraints: all contacts beyond the one joint of each body.
        trusses: massless bars between hinges.
        forces: what is applied.
        linearize: the state about which small motions are taken.
        given: known velocities and accelerations at one instant.
        unknowns: numbers that statics is to find.
        outputs: requested results.

    Raises:
        ModelError: on construction, with every problem at once.
    """

    title: ClassVar[str] = "the model"
    name: Text = "model"
    space: Annotated[str, TextRule(("plane", "space"))]
    about: Text | None = None
    source: Text | None = None
    parameters: Annotated[Table[Parameter], _table(Parameter, "parameter")] = Table()
    coordinates: Annotated[Table[Coordinate], _table(Coordinate, "coordinate")] = Table()
    speeds: Annotated[Table[Speed], _table(Speed, "speed")] = Table()
    inputs: Annotated[Table[Input], _table(Input, "input")] = Table()
    points: GroundPoints = Table()
    bodies: Annotated[Table[Body], _table(Body, "body")] = Table()
    constraints: Constraints = Table()
    trusses: Annotated[Table[Truss], _table(Truss, "truss")] = Table()
    forces: Forces = Table()
    linearize: Annotated[Linearize, PartRule(Linearize)] | None = None
    given: Annotated[Given, PartRule(Given)] | None = None
    unknowns: Annotated[Table[Unknown], _table(Unknown, "unknown")] = Table()
    outputs: Annotated[Table[Output], _table(Output, "output")] = Table()

    def __post_init__(self) -> None:
        finish(self)

    @staticmethod
    def schema() -> dict[str, Any]:
        """The JSON Schema of a model file, for editors: what `check` finds beyond it needs the whole model."""
        definitions: dict[str, Any] = {
            "expression": {
                "description": "a number, or the text of an expression",
                "anyOf": [{"type": "number"}, {"type": "string", "minLength": 1}],
            },
            "quantity": {
                "description": "a number, an expression, or a value with its unit",
                "anyOf": [
                    {"$ref": "#/$defs/expression"},
                    {
                        "type": "object",
                        "properties": {"value": {"$ref": "#/$defs/expression"}, "unit": {"type": "string"}},
                        "required": ["value"],
                        "additionalProperties": False,
                    },
                ],
            },
        }
        part_schema(Model, definitions)
        table = definitions.pop("Model")
        version = {"eomgen": {"const": 1, "description": "version of the model file"}}
        return {
            "$schema": DIALECT,
            **table,
            "title": "eomgen model file",
            "properties": {**version, **table["properties"]},
            "required": ["eomgen", *table["required"]],
            "$defs": definitions,
        }

    def __getstate__(self) -> dict[str, Any]:
        """The declared model; what was derived from it (`frozen.recalled`) is derived anew where it is needed."""
        return {name: value for name, value in self.__dict__.items() if name != RECALLED}

    def __repr__(self) -> str:
        tables = ("bodies", "trusses", "coordinates", "constraints", "forces", "parameters", "outputs")
        sizes = [f"{len(getattr(self, name))} {name}" for name in tables if getattr(self, name)]
        where = "in space" if self.space == "space" else "in the plane"
        return f"<model {self.name!r} {where}: {', '.join(sizes) or 'nothing in it'}>"

    def scene(self) -> Any:
        """The scene: what can be drawn of the model at a state, forces left out; `to_json()` gives it as data.

        Raises:
            DerivationError, NotYet: what cannot be derived is not drawn either.
        """
        return import_module("eomgen").scene_of(self)  # the package's front door: the scene is a later room's

    @property
    def picture(self) -> Any:
        """Picture of the model at its start: shows itself in a notebook, `save("model.svg")` writes it."""
        return import_module("eomgen").rest_picture(self)  # as above

    def _repr_png_(self) -> bytes | None:
        """Picture of the model at its start, for notebooks; None where it cannot be drawn."""
        try:
            found: bytes = self.picture._repr_png_()
        except EomgenError:
            return None
        return found

    def body_points(self, body: str) -> tuple[str, ...]:
        """The names of a body's points: `origin`, its shape's or mass centre's, its own."""
        part = self.bodies[body]
        names = ["origin"]
        if part.shape is not None:
            names += part.shape.point_names
        elif part.mass is not None or part.center is not None or part.parts is not None:
            names.append("center")
        return tuple(dict.fromkeys([*names, *(part.points or ())]))

    @property
    def named_points(self) -> tuple[str, ...]:
        """Every point of the ground and of the bodies by its whole name: "O", "arm.end"."""
        own = (f"{body}.{point}" for body in self.bodies for point in self.body_points(body))
        return (*self.points, *own)

    def resolve_point(self, point: str) -> tuple[str | None, str]:
        """(body, its point) of "arm.end"; (None, point) of a point of the ground; (truss, node) of "T.n1".

        In a model in parts a node is a body: ("T.n1", "origin").
        """
        owner, dot, name = point.partition(".")
        if dot and point in self.bodies:
            return point, "origin"
        return (owner, name) if dot else (None, owner)

    def place(self, at: tuple[Expression, ...] | str) -> tuple[Expression, ...]:
        """Coordinates of a place on the ground that may be given by a point's name [m]."""
        return self.points[at] if isinstance(at, str) else at
