"""Text or Python -> "Model": the whole that a user declares, and what follows from its declarations alone."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from importlib import import_module
from typing import Annotated, Any, ClassVar

from eomgen.errors import DerivationError, EomgenError, Problem
from eomgen.frozen import dataclass
from eomgen.model import constraints, forces
from eomgen.model.catalog import Catalog
from eomgen.model.checks.plausible import warnings_of
from eomgen.model.constraints import Constraint
from eomgen.model.constraints.link import Members, trusses_of
from eomgen.model.contacts import Connections
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.expansion import PartsRule, Repetition, RepetitionRule
from eomgen.model.fields import Leaf, ListRule, Table, TableRule, TextRule, WrittenEquation
from eomgen.model.forces import Force
from eomgen.model.kinds import (
    Paragraphs,
    Text,
)
from eomgen.model.making import finish
from eomgen.model.part import Part, PartRule, SeamRule, part_schema
from eomgen.model.parts import (
    Body,
    Coordinate,
    Given,
    GroundPoints,
    ImpactRules,
    Input,
    Linearize,
    Output,
    Parameter,
    Question,
    Speed,
    StateVariable,
    Truss,
    Unknown,
    begun_speeds,
    in_parts,
)
from eomgen.model.positions import DocumentPath
from eomgen.model.sampled_laws import given_samples, left_tables
from eomgen.model.units import Inferred, UnitsOfNames, inferred, inferred_units
from eomgen.model.value_tables import ValueTable
from eomgen.model.values import Numbers
from eomgen.symbolic.expression import DeclaredSamples, Expression, Sampled, TableFunction

REQUESTED = ("given", "outputs", "unknowns")
"""Tables in which an unknown is no load: its declaration, requested results, the kinematics of an instant."""
EFFORTS = ("torque", "force")
"""Loads at a joint."""
DIALECT = "https://json-schema.org/draft/2020-12/schema"
"""of the JSON Schema of a model file"""


def _table(cls: type, what: str) -> TableRule:
    return TableRule(PartRule(cls), what)


Constraints = Annotated[
    Table[Constraint], TableRule(SeamRule("constraint", constraints.ALL, constraints.MADE), "constraint")
]
Forces = Annotated[Table[Force], TableRule(SeamRule("force", forces.ALL), "force")]


@dataclass(frozen=True, kw_only=True, repr=False)
class Model(Numbers, Connections, UnitsOfNames, Part):
    """A mechanical system as declared: tables of named parts, each a read-only mapping in the user's order.

    Args:
        name: of the system (the file's stem where it is left out).
        space: the plane (x right, y up, turns about z, counter-clockwise positive), or space; required.
        about, source: remarks.
        text: the words of the problem, one paragraph or several, for sheets.
        language: of what is printed about it: "en", "de", "fr", "es".
        questions: what a sheet asks, in words.
        repeat: indices; what has `{i}` in its name is made for each i, up to a number or an integer parameter.
        parts: things from other files, `{ file, on, at, turned, set }` each, under names that begin with its name.
        parameters: constants.
        coordinates: what moves.
        speeds: generalized speeds that are not rates.
        tables: functions of any variable through values, M(n) in expressions.
        states: of first order, z' = rate: currents, pressures, temperatures.
        inputs: known functions of time that a caller may replace.
        points: of the ground, fixed [m].
        bodies: what has a frame: its mass, points, joint.
        constraints: all contacts beyond the one joint of each body.
        trusses: massless bars between hinges.
        forces: what is applied.
        impact: the law of impacts.
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
    text: Paragraphs | None = None
    language: Text | None = None
    repeat: Annotated[Repetition, RepetitionRule()] | None = None
    parts: Annotated[Any, PartsRule()] | None = None
    parameters: Annotated[Table[Parameter], _table(Parameter, "parameter")] = Table()
    coordinates: Annotated[Table[Coordinate], _table(Coordinate, "coordinate")] = Table()
    speeds: Annotated[Table[Speed], _table(Speed, "speed")] = Table()
    tables: Annotated[Table[ValueTable], _table(ValueTable, "table")] = Table()
    states: Annotated[Table[StateVariable], _table(StateVariable, "state")] = Table()
    inputs: Annotated[Table[Input], _table(Input, "input")] = Table()
    points: GroundPoints = Table()
    bodies: Annotated[Table[Body], _table(Body, "body")] = Table()
    constraints: Constraints = Table()
    trusses: Annotated[Table[Truss], _table(Truss, "truss")] = Table()
    forces: Forces = Table()
    impact: Annotated[ImpactRules, PartRule(ImpactRules)] | None = None
    linearize: Annotated[Linearize, PartRule(Linearize)] | None = None
    given: Annotated[Given, PartRule(Given)] | None = None
    unknowns: Annotated[Table[Unknown], _table(Unknown, "unknown")] = Table()
    outputs: Annotated[Table[Output], _table(Output, "output")] = Table()
    questions: Annotated[tuple[Question, ...], ListRule(PartRule(Question))] | None = None

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

    def requesting(self, outputs: Mapping[str, Output]) -> "Model":
        """The model with other requested results; without the words of its problem, which speak of those of the file.

        Raises:
            ModelError: one of them is wrong.
        """
        return replace(self, outputs=Table(outputs), text=None, questions=None)

    def with_given_velocities(self, equations: tuple[WrittenEquation, ...]) -> "Model":
        """The model with these velocities given in addition, checked as a whole."""
        if not equations:
            return self
        own = self.given or Given.of_values({})
        return replace(self, given=own.altered(velocity=(*(own.velocity or ()), *equations)))

    @property
    def functions(self) -> dict[str, TableFunction]:
        """The functions that tables declare, and their derivatives: M, M', M''."""
        found = {name: table.function(name) for name, table in self.tables.items()}
        for name, table in tuple(found.items()):
            found |= {f"{name}'": table.rate, f"{name}''": table.rate.rate}
        return found

    @property
    def counts(self) -> tuple[str, ...]:
        """Integer parameters by which things of the model are counted: they are set, not varied."""
        return () if self.repeat is None else self.repeat.counts

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """Warnings: what a user should look at again."""
        return warnings_of(self)

    @property
    def unbuilt(self) -> tuple[tuple[str, str], ...]:
        """(where, kind) of every joint, constraint, force and table that waits for a later version, in order."""
        bodies = ((name, body.joint) for name, body in self.bodies.items() if body.joint is not None)
        joints = ((f"bodies.{name}.joint", f"{x.kind} joint") for name, x in bodies if not x.works_in(self.space))
        forces = ((f"forces.{name}", force.kind) for name, force in self.forces.items() if not force.works)
        return (*joints, *self.unbuilt_constraints, *forces)

    @property
    def unbuilt_constraints(self) -> tuple[tuple[str, str], ...]:
        """(where, kind) of the constraints that wait for a later version: they cannot be counted."""
        constraints = self.constraints.items()
        return tuple((f"constraints.{name}", x.kind) for name, x in constraints if not x.works_in(self.space))

    @property
    def expressions(self) -> tuple[tuple[Leaf, Expression], ...]:
        """Every expression of the model, with the value in which it stands."""
        return Catalog(self, ()).expressions

    @property
    def assumed_by_constraints(self) -> tuple[str, ...]:
        """Sentences that state what is assumed by constraints that nobody declared."""
        sentences = (constraint.assumption(name) for name, constraint in self.constraints.items())
        return tuple(filter(None, sentences))

    @property
    def dimensions(self) -> Inferred:
        """The dimensions that follow from every expression of the model."""
        return inferred(Catalog(self, ()))

    @property
    def inferred_units(self) -> dict[str, str]:
        """{name: unit} of what has none in the file, where the expressions say what it must be."""
        return inferred_units(self)

    @property
    def given_samples(self) -> Iterator[tuple[DocumentPath, Sampled, DeclaredSamples]]:
        """(path, function of time, samples as declared) of all that the model gives through samples."""
        return given_samples(self)

    def left_tables(self, end: float) -> tuple[Problem, ...]:
        """Warnings of samples that a run from 0 goes beyond."""
        return left_tables(self, end)

    @property
    def begun_speeds(self) -> dict[str, frozenset[str]]:
        """{speed: the rates that go with it} of those that have a `start`, or share rates with one that has."""
        return begun_speeds(self.speeds)

    @property
    def trusses_in_parts(self) -> dict[str, Members]:
        """The trusses of a model in parts, by name."""
        return trusses_of(self.constraints)

    @property
    def truss_members(self) -> list[tuple[str, str, tuple[str, str]]]:
        """(truss, member, its two nodes) of every truss of a model in parts."""
        trusses = self.trusses_in_parts
        return [(name, member, truss.ends(member)) for name, truss in trusses.items() for member in truss.members]

    @property
    def in_parts(self) -> "Model":
        """The model with its trusses replaced by bodies and constraints; itself where it has none."""
        found: Model = in_parts(self)
        return found

    def _uses(self) -> Iterator[tuple[DocumentPath, str]]:
        """(path, unknown) of every place in which an unknown stands, except in the tables REQUESTED."""
        if not self.unknowns:
            return
        for leaf in self.leaves(()):
            if leaf.path[0] not in REQUESTED and isinstance(leaf.value, Expression):
                yield from ((leaf.path, name) for name in sorted(leaf.value.names & self.unknowns.keys()))

    def unknowns_in_loads(self) -> tuple[str, ...]:
        """The unknowns that stand in loads, in the model's order.

        Raises:
            DerivationError: one stands elsewhere, where no balance can be solved for it.
        """
        found = set()
        for path, name in self._uses():
            if not _is_load(path):
                where = ".".join(map(str, path))
                what = f"the unknown '{name}' stands where no balance gives it ({where})"
                fix = "an unknown may stand in forces, couples and drives, and in [given]"
                raise DerivationError(what, f"unknowns.{name}", fix)
            found.add(name)
        return tuple(name for name in self.unknowns if name in found)

    def refuse_motion(self) -> None:
        """Refuse equations of motion in which a force is unknown.

        Raises:
            DerivationError: it is named.
        """
        for path, name in self._uses():
            where = ".".join(map(str, path))
            raise DerivationError(
                f"the unknown '{name}' stands in {where}: a motion does not follow from it",
                where,
                "make it a parameter or an input; at rest `eomgen solve` and `eomgen statics` find it",
            )

    def __getstate__(self) -> dict[str, Any]:
        """The declared model; what was derived from it is derived anew where it is needed."""
        return {name: value for name, value in self.__dict__.items() if name in self.__dataclass_fields__}

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

    def free_bodies(self, at: Any = None) -> Any:
        """Each body cut free with its forces, reactions and inertia: `.bodies[name].forces`, and `.picture`.

        Args:
            at: the instant: an equation that is first met then, or "equilibrium"; None: the start.
        Raises:
            DerivationError: something acts at no place; a body is unsupported; there is no such instant.
        """
        return import_module("eomgen").free_bodies(self, at)  # as above

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

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """The times of the samples of every motion and input, ascending [s]."""
        laws = (
            leaf.value
            for table in (self.coordinates, self.inputs, self.states, self.constraints)
            for name, part in table.items()
            for leaf in part.leaves((name,))
        )
        sampled = (law.sampled for law in laws if isinstance(law, Expression))
        return tuple(sorted({float(t) for each in sampled if each is not None for t in each.spline.bounds}))

    @property
    def on_paths(self) -> tuple[str, ...]:
        """The bodies on a path of several pieces."""
        return tuple(name for name, body in self.bodies.items() if len(body.path_pieces) > 1)

    @property
    def changing(self) -> tuple[str, ...]:
        """Names of the contacts, and of the bodies on a path of several pieces, that can change as the model moves."""
        return tuple(dict.fromkeys((*(contact.name for contact in self.contacts), *self.on_paths)))

    @property
    def has_phases(self) -> bool:
        """True if the model has contacts, or bodies on a path of several pieces, that can change as it moves."""
        return bool(self.changing)

    def _given_at_start(self, name: str) -> list[Expression]:
        """Expressions of a start; for a declared speed without one, those of its rates."""
        if name in self.coordinates:
            part = self.coordinates[name]
            found = [part.start if part.near is None else None]
        elif name in self.speeds and self.speeds[name].start is None:
            rate = self.speeds[name].rate
            rates = [] if rate is None else [x[:-1] for x in rate.names if x[:-1] in self.coordinates]
            found = [self.coordinates[q].speed for q in rates]
        elif name in self.speeds:
            found = [self.speeds[name].start]
        elif name in self.states:
            found = [self.states[name].start]
        else:
            found = [self.coordinates[name[:-1]].speed if name[:-1] in self.coordinates else None]
        return [value for value in found if value is not None]

    def is_guess(self, name: str) -> bool:
        """True if the start of a coordinate, speed or state is not given, or is only a guess by `near`."""
        return not self._given_at_start(name)

    def is_typed(self, name: str) -> bool:
        """True if a person typed the start of a coordinate, speed or state, in place of what the model declares."""
        return any(value.typed for value in self._given_at_start(name))


def _is_load(path: DocumentPath) -> bool:
    return path[0] == "forces" or (path[0] == "bodies" and "joint" in path and path[-1] in EFFORTS)
