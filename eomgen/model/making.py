"""Declared parts -> a finished Model: fields read, checks made, places on the ground resolved."""

from collections.abc import Mapping
from itertools import islice
from typing import Any, TypeVar

from eomgen.errors import ModelError, Problem
from eomgen.model.catalog import Catalog
from eomgen.model.checks.everything import ALL
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import Table, WrittenEquation
from eomgen.model.part import Part, read_part
from eomgen.model.typed import Typing, typing_of

MOST_DIAGNOSTICS = 200  # of one model: more say nothing new


Made = TypeVar("Made", bound=Part)


def draft_of(cls: Any, raw: Mapping[str, Any], title: str, found: list[Diagnostic]) -> Any:
    """A model from the tables of a file, unchecked; what could not be read is None and has a diagnostic."""
    return read_part(cls, {"name": title, **raw}, (), found, known=("eomgen",))


def diagnostics_of(model: Any, found: list[Diagnostic]) -> list[Diagnostic]:
    """The problems of a model that was read, beyond those found by reading it."""
    catalog = Catalog(model, tuple(found))
    every = (diagnostic for check in ALL for diagnostic in check(catalog))
    return list(dict.fromkeys(islice(every, MOST_DIAGNOSTICS)))


def finish(model: Any) -> None:
    """Reads the fields of a model made in Python, checks it as a whole and resolves it, in place (it is being made).

    Raises:
        ModelError: every problem at once, by path ("bodies.arm.joint.on").
    """
    found: list[Diagnostic] = []
    for slot in type(model).slots():
        raw = getattr(model, slot.name)
        if raw is not slot.default:
            object.__setattr__(model, slot.name, slot.rule.read(raw, (slot.key,), found))
    found += diagnostics_of(model, found)
    if found:
        raise ModelError(tuple(Problem(".".join(map(str, f.path)), f.what, fix=f.fix) for f in found))
    for name, value in _resolved_tables(model).items():
        object.__setattr__(model, name, value)


def resolved(model: Made) -> Made:
    """The checked model with the places of its ground joints as coordinates and its own points without their body."""
    return model.altered(**_resolved_tables(model))


def _resolved_tables(model: Any) -> dict[str, Any]:
    constraints, centers = _with_centers(model)
    bodies = Table({name: _resolved_body(model, name, body) for name, body in model.bodies.items()})
    for name, points in centers.items():
        own = bodies[name].points or {}
        bodies = Table({**bodies, name: bodies[name].altered(points=Table({**own, **points}))})
    forces = {name: _resolved_force(force) for name, force in model.forces.items()}
    outputs = {name: _settled(output, typing_of(model, "outputs"), ("at",)) for name, output in model.outputs.items()}
    typing = typing_of(model, "given")
    given = None if model.given is None else _settled(model.given, typing, ("velocity", "acceleration"))
    return {
        "bodies": bodies,
        "constraints": constraints,
        "forces": Table(forces),
        "outputs": Table(outputs),
        "given": given,
    }


def _with_centers(model: Any) -> tuple[Table[Any], dict[str, dict[str, Any]]]:
    """The constraints, each place that is the center of a body a point of it; and these points, by body."""
    found: dict[str, Any] = {}
    points: dict[str, dict[str, Any]] = {}
    for name, constraint in model.constraints.items():
        center = getattr(constraint, "center", None)
        found[name] = constraint
        if isinstance(center, tuple):
            body = model.bodies[constraint.body]
            own = f"center_of_{name}"
            while own in (body.points or {}) or own in points.get(constraint.body, {}):
                own += "_"
            points.setdefault(constraint.body, {})[own] = center
            found[name] = constraint.altered(center=own)
    return Table(found), points


def _settled(part: Any, typing: Typing, keys: tuple[str, ...]) -> Any:
    """A part whose equations are in SI."""

    def in_si(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(in_si, value))
        return typing.equation(value)[0] if isinstance(value, WrittenEquation) else value

    changes = {key: in_si(getattr(part, key)) for key in keys}
    return part if all(value is None for value in changes.values()) else part.altered(**changes)


def _resolved_force(force: Any) -> Any:
    between = getattr(force, "between", None)
    return force if between is None else force.altered(between=tuple(_own(point) for point in between))


def _resolved_body(model: Any, name: str, body: Any) -> Any:
    changes: dict[str, Any] = {}
    if body.line is not None:
        changes["line"] = tuple(_own(point) for point in body.line)
    joint = body.joint
    if joint is not None:
        point = None if joint.point is None else _own(joint.point)
        at = model.place(joint.at) if isinstance(joint.at, str) else joint.at
        if point != joint.point or at is not joint.at:
            changes["joint"] = joint.altered(point=point, at=at)
    return body.altered(**changes) if changes else body


def _own(point: str) -> str:
    """The name of a body's own point, without the body."""
    return point.rpartition(".")[2]
