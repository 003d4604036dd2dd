"""Model -> Catalog: the names that it declares, and every value with the rule that it was read by."""

from collections.abc import Iterator
from functools import cached_property
from typing import Any

from eomgen.frozen import dataclass
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import (
    CONFIGURATION,
    FLOWING,
    MOTION,
    PARAMETERS,
    RATES,
    SPEEDS,
    STATE,
    TIME,
    Leaf,
    WrittenEquation,
)
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression

SYMBOL_TABLES = ("parameters", "coordinates", "speeds", "states", "inputs", "unknowns")
OBJECT_TABLES = ("bodies", "trusses", "constraints")


@dataclass(frozen=True)
class Catalog:
    """A model in the making. Parts that could not be read are None; what reading found is in `found`."""

    model: Any
    found: tuple[Diagnostic, ...]

    @cached_property
    def leaves(self) -> tuple[Leaf, ...]:
        """Every value of the model, with its path and rule."""
        return tuple(self.model.leaves(()))

    @cached_property
    def broken(self) -> frozenset[DocumentPath]:
        """The paths of what could not be read, and of all that it stands in."""
        return frozenset(f.path[:k] for f in self.found for k in range(1, len(f.path) + 1))

    @cached_property
    def symbols(self) -> dict[str, str]:
        """{name in expressions: its kind}: {"m": "parameter", ...}."""
        kinds = {
            "parameters": "parameter",
            "coordinates": "coordinate",
            "speeds": "speed",
            "states": "state",
            "inputs": "input",
            "unknowns": "unknown",
        }
        named = {name: kinds[table] for table in reversed(SYMBOL_TABLES) for name in self.table(table)}
        return {**named, "t": "time", "pi": "constant"}

    def table(self, name: str) -> Any:
        """One of the model's tables (empty where it could not be read)."""
        return getattr(self.model, name) or {}

    @cached_property
    def allowed(self) -> dict[str, frozenset[str]]:
        """The names that may stand in an expression of each scope."""
        constant = frozenset(["pi", *self.table("parameters"), *self.table("unknowns")])
        q = frozenset(self.table("coordinates"))
        rates = frozenset(name + "'" for name in q)
        speeds = frozenset(self.table("speeds"))
        accelerations = frozenset([name + "''" for name in q] + [name + "'" for name in speeds])
        time = constant | {"t"}
        states = frozenset(name + dot for name in self.table("states") for dot in ("", "'"))
        motion = time | q | rates | speeds | states | frozenset(self.table("inputs"))
        return {
            PARAMETERS: constant,
            TIME: time,
            FLOWING: time | frozenset(self.table("states")),
            CONFIGURATION: time | q,
            RATES: time | q | rates,
            SPEEDS: time | q | rates | speeds,
            MOTION: motion,
            STATE: motion | accelerations,
            "": motion | accelerations,
        }

    @cached_property
    def expressions(self) -> tuple[tuple[Leaf, Expression], ...]:
        """Every expression of the model, with the leaf that holds it."""
        return tuple(
            (leaf, expression)
            for leaf in self.leaves
            for expression in _expressions_in(leaf.value)
            if not isinstance(leaf.value, tuple)  # a vector's components are leaves of their own
        )

    def body_points(self, body: str) -> tuple[str, ...]:
        """The names of a body's points (none where the body could not be read)."""
        return self.model.body_points(body) if self.model.bodies.get(body) is not None else ()

    def point_names(self) -> list[str]:
        """Every point that a constraint or a force may name."""
        names = list(self.table("points"))
        names += [f"{body}.{point}" for body in self.table("bodies") for point in self.body_points(body)]
        return names + list(self.nodes)

    @property
    def nodes(self) -> tuple[str, ...]:
        """The nodes of all trusses: "T.n1"."""
        trusses = self.table("trusses").items()
        return tuple(f"{name}.{node}" for name, truss in trusses if truss for node in truss.nodes or {})

    @property
    def joints_with_friction(self) -> dict[str, bool]:
        """{joint, brake, clutch or belt: True of a torque, False of a force} of all dry friction of a given rate."""
        joints = ((name, body.joint) for name, body in self.table("bodies").items() if body is not None and body.joint)
        found = ((body, joint, each) for body, joint in joints if joint.is_whole for each in joint.frictions)
        whole = ((name, force) for name, force in self.table("forces").items() if force is not None and force.is_whole)
        forces = ((name, force.friction) for name, force in whole)
        turns = {joint.named_contact(body, field): law.amount == "torque" for body, joint, (_, field, law) in found}
        return turns | {name: law.amount == "torque" for name, law in forces if law is not None}


def diagnostics_of_one(catalog: Catalog, path: DocumentPath, part: Any, keys: tuple[str, ...]) -> Iterator[Diagnostic]:
    """Diagnostics unless exactly one of these fields is given."""
    given = [key for key in keys if getattr(part, key) is not None]
    listed = " and ".join(f"'{key}'" for key in keys)
    if len(given) > 1:
        yield Diagnostic((*path, given[1]), f"only one of {listed} can be given ({'.'.join(map(str, path))})", key=True)
    elif not given and not any((*path, key) in catalog.broken for key in keys):
        yield Diagnostic(path, f"one of {listed} is needed ({'.'.join(map(str, path))})")


def not_in_the_plane(catalog: Catalog, path: DocumentPath, part: Any, keys: tuple[str, ...]) -> Iterator[Diagnostic]:
    """Diagnostics of fields for space that are given in the plane."""
    for key in keys if catalog.model.space == "plane" else ():
        if getattr(part, key) is not None:
            yield Diagnostic((*path, key), f"'{key}' of '{path[1]}' is for space", "leave it out", key=True)


def is_round(catalog: Catalog, body: Any, sizes: tuple[str, ...] = ("radius",)) -> bool:
    """True if a body's shape has a radius, or other such sizes (or could not be read)."""
    part = catalog.table("bodies").get(body)
    return part is None or ("bodies", body, "shape") in catalog.broken or any(hasattr(part.shape, x) for x in sizes)


def owner_of(point: str) -> str:
    """The body of a point; "" of the ground's."""
    return point.partition(".")[0] if "." in point else ""


def _expressions_in(value: Any) -> Iterator[Expression]:
    if isinstance(value, Expression):
        yield value
    elif isinstance(value, WrittenEquation):
        yield value.left
        yield value.right
