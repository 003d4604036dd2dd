"""The same mechanism said in another way: turned, shifted, with other body frames, in another order, in other units.

A model is taken as the tables of its file. What a transformation cannot say of a model raises `Unfit`, with the reason.
"""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Callable, Iterator, Mapping
from copy import deepcopy
from fractions import Fraction
from pathlib import Path
from typing import Any

from eomgen.model.quantities import Unit

Tables = dict[str, Any]
ANGLE = "7/10"
SHIFT = ("3/10", "-1/5", "1/2")


class Unfit(Exception):
    """The model holds something that this transformation does not carry along."""


class Literal(str):
    """A decimal as it stands in the file."""


def tables_of(path: Path) -> Tables:
    return tomllib.loads(path.read_text(encoding="utf-8"), parse_float=Literal)


def text_of(tables: Tables) -> str:
    """As a model file."""
    return "".join(
        f"{key} = {_value(value)}\n" if not isinstance(value, dict) else "".join(_table(key, value))
        for key, value in sorted(tables.items(), key=lambda item: isinstance(item[1], dict))
    )


def _table(name: str, table: Mapping[str, Any]) -> Iterator[str]:
    yield f"\n[{name}]\n"
    yield from (f"{json.dumps(key)} = {_value(value)}\n" for key, value in table.items())


def _value(value: Any) -> str:
    if isinstance(value, Literal):
        return str(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(k)} = {_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


# -- vectors of the ground --------------------------------------------------------------------------

Change = Callable[[list[Any]], list[Any]]


def on_ground(tables: Tables, place: Change, direction: Change) -> Tables:
    """Every place and direction given in the ground's axes changed, but those of joints.

    Raises:
        Unfit: places or angles against the ground stand in an expression.
    """
    new = deepcopy(tables)
    new["points"] = {name: place(at) for name, at in new.get("points", {}).items()}
    for constraint in new.get("constraints", {}).values():
        _change_constraint(constraint, place, direction, new["space"])
    for force in new.get("forces", {}).values():
        _change_force(force, direction)
    return new


def _change_constraint(constraint: dict[str, Any], place: Change, direction: Change, space: str) -> None:
    if constraint["kind"] in ("equation", "clamp") or "strands" in constraint:
        raise Unfit(f"a constraint of kind {constraint['kind']} speaks of the ground")
    if constraint["kind"] == "skate" and space == "space" and "normal" not in constraint:
        constraint["normal"] = [0, 0, 1]
    for key in ("normal", "axis") if constraint["kind"] != "rolling" else ():
        if key in constraint:
            constraint[key] = direction(constraint[key])
    if constraint["kind"] == "guide":
        constraint["along"] = direction(constraint["along"])
    if "at" in constraint and isinstance(constraint["at"], list):
        constraint["at"] = place(constraint["at"])
    for track in (constraint.get("line"), constraint.get("plane"), constraint.get("circle")):
        if isinstance(track, dict) and "on" not in constraint:
            _change_track(track, place, direction)
    for stop in constraint.get("path", ()):
        if isinstance(stop, dict) and "at" in stop:
            stop["at"] = place(stop["at"])


def _change_track(track: dict[str, Any], place: Change, direction: Change) -> None:
    if not isinstance(track["at"], str):
        track["at"] = place(track["at"])
    for key in ("normal", "axis"):
        if key in track:
            track[key] = direction(track[key])


def _change_force(force: dict[str, Any], direction: Change) -> None:
    kind = force["kind"]
    if kind in ("distributed", "potential", "generalized") or (kind.startswith("torsion") and "body" in force):
        raise Unfit(f"a force of kind {kind} speaks of the ground")
    key = {"gravity": "acceleration", "force": "force", "couple": "couple"}.get(kind, "along")
    if key in force and force.get("axes", "ground") == "ground" and isinstance(force[key], list):
        force[key] = direction(force[key])


def root_joints(tables: Tables) -> Iterator[dict[str, Any]]:
    """The joints of the bodies that hang on the ground; a body without one gets a weld."""
    for body in tables["bodies"].values():
        joint = body.setdefault("joint", {"kind": "fixed"})
        if "on" not in joint:
            yield joint


# -- the transformations ----------------------------------------------------------------------------


def turned(tables: Tables) -> Tables:
    """The whole model and its gravity, turned by a fixed rotation: about z in the plane, about x in space."""
    plane = tables["space"] == "plane"

    def rotate(v: list[Any]) -> list[Any]:
        if plane and len(v) == 1:
            return v
        a, b = v[-2:]
        pair = [f"({a})*cos({ANGLE}) - ({b})*sin({ANGLE})", f"({a})*sin({ANGLE}) + ({b})*cos({ANGLE})"]
        return [*v[:-2], *pair]

    new = on_ground(tables, rotate, rotate)
    rotation = {"angle": ANGLE} if plane else {"axis": [1, 0, 0], "angle": ANGLE}
    for joint in root_joints(new):
        if isinstance(joint.get("at"), list) and joint["kind"] != "placed":
            joint["at"] = rotate(joint["at"])
        before = joint.get("turned", [])
        joint["turned"] = [rotation, *(before if isinstance(before, list) else [before])]
    return new


def shifted(tables: Tables) -> Tables:
    """The ground's origin elsewhere."""

    def move(place: list[Any]) -> list[Any]:
        return [f"({x}) + {d}" for x, d in zip(place, SHIFT, strict=False)]

    new = on_ground(tables, move, lambda direction: direction)
    size = 2 if new["space"] == "plane" else 3
    for joint in root_joints(new):
        if not isinstance(joint.get("at"), str):
            joint["at"] = move(joint.get("at", [0] * size))
    return new


def reordered(tables: Tables) -> Tables:
    """Every table backwards."""
    return {k: dict(reversed(v.items())) if isinstance(v, dict) else v for k, v in tables.items()}


def other_origins(tables: Tables) -> Tables:
    """Bodies that are no shapes have their origin elsewhere; what is given in their axes moves along.

    Raises:
        Unfit: there is no such body; something else is about an origin.
    """
    new = deepcopy(tables)
    size = 2 if new["space"] == "plane" else 3
    chosen = [n for n, b in new["bodies"].items() if "mass" in b and not {"shape", "parts", "line"} & b.keys()]
    reported = json.dumps([new.get("constraints", {}), new.get("forces", {})])
    chosen = [
        n for n in chosen if f'"{n}.origin' not in reported and f'"{n}"' not in reported and "joint" in new["bodies"][n]
    ]
    if not chosen:
        raise Unfit("every body is a shape, or named by its origin")

    def move(place: list[Any]) -> list[Any]:
        return [f"({x}) + {d}" for x, d in zip(place, SHIFT, strict=False)]

    for name in chosen:
        body = new["bodies"][name]
        body["points"] = {p: move(at) for p, at in body.get("points", {}).items()}
        body["center"] = move(body.get("center", [0] * size))
        if "point" not in body["joint"]:
            body["points"]["old_origin"] = list(SHIFT[:size])
            body["joint"]["point"] = "old_origin"
        for other in new["bodies"].values():
            joint = other.get("joint", {})
            if joint.get("on") == name:
                joint["at"] = move(joint.get("at", [0] * size))
    return new


SCALES = {"length": Fraction(3, 2), "mass": Fraction(5, 7), "time": Fraction(4, 3)}
"""How many of the new units an old one is."""


def factor_of(unit: str | None) -> Fraction:
    """How many of the new units of this dimension one of SI is."""
    dims = dict(zip(SCALES, (0, 0, 0) if unit is None else Unit.parse(unit).dimension, strict=False))
    return Fraction(math.prod(SCALES[d] ** n for d, n in dims.items()))


def in_other_units(tables: Tables) -> Tables:
    """All values in other units of mass, length and time: each parameter and start times its own factor.

    Raises:
        Unfit: a number stands outside the tables that declare units.
    """
    new = deepcopy(tables)
    for table in ("parameters", "coordinates"):
        for name, entry in new.get(table, {}).items():
            if not isinstance(entry, dict):
                raise Unfit(f"'{name}' declares no unit")
            if table == "parameters" and entry.get("unit") is None:
                raise Unfit(f"'{name}' declares no unit")
            for key in ("value", "start", "near"):
                if key in entry:
                    entry[key] = f"({entry[key]})*{factor_of(entry.get('unit'))}"
            if "speed" in entry:
                entry["speed"] = f"({entry['speed']})*{factor_of(entry.get('unit')) / SCALES['time']}"
            entry.pop("unit", None)
    return new
