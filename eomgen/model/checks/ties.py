"""Ties, forces and coordinates: what goes together, what excludes what, and that nothing is idle."""

import re
from collections.abc import Iterator
from typing import Any

from eomgen.model.checks.catalog import Catalog
from eomgen.model.checks.choices import not_in_the_plane, one_of
from eomgen.model.checks.rolling import is_round, rolling
from eomgen.model.fields import NameRule
from eomgen.model.findings import Finding, Path

ONE_OF = {
    "clamp": ("point", "points"),
    "equation": ("gap", "rate"),
    "torsion_spring": ("bodies", "body"),
    "torsion_damper": ("bodies", "body"),
    "distributed": ("intensity", "intensities"),
}
"""Of these fields of a kind exactly one is given."""

_WORD = re.compile(r"[^\W\d]\w*")


def ties(catalog: Catalog) -> Iterator[Finding]:
    """Fields of ties and forces that exclude one another, or of which one is missing."""
    for table in ("constraints", "forces"):
        for name, part in catalog.table(table).items():
            if part is None:
                continue
            path: Path = (table, name)
            if part.kind in ONE_OF:
                yield from one_of(catalog, path, part, ONE_OF[part.kind])
            if part.kind == "rolling":
                yield from rolling(catalog, path, part)
            elif part.kind == "skate":
                yield from not_in_the_plane(catalog, path, part, ("normal",))
            elif part.kind == "string":
                yield from _string(catalog, path, part)
            elif part.kind == "slider":
                yield from _slider(catalog, path, part)
            if table == "constraints":
                yield from _on_itself(catalog, path, part)
            friction = getattr(part, "friction", None)
            if friction is not None:
                yield from one_of(catalog, (*path, "friction"), friction, ("coulomb", "viscous"))


def _on_itself(catalog: Catalog, path: Path, part: Any) -> Iterator[Finding]:
    """A tie that joins a body to itself, or the ground to the ground."""
    name = path[1]
    bodies = getattr(part, "bodies", None)
    if bodies and bodies[0] == bodies[1]:
        yield Finding((*path, "bodies", 1), f"'{name}' gears body '{bodies[0]}' with itself", "name two bodies")
    points = getattr(part, "points", None) or ()
    point = getattr(part, "point", None)
    if any(name not in catalog.point_names() for name in (point, *points) if name is not None):
        return
    if point is not None and "." not in point and part.kind != "slider":
        yield Finding((*path, "point"), f"'{name}' holds '{point}', a point of the ground", "name a point of a body")
    elif point is not None and part.kind == "slider" and _owner(point) == part.on:
        yield Finding((*path, "point"), f"the point '{point}' of '{name}' is on the body along which it should slide")
    owners = {_owner(point) for point in points}
    if len(owners) == 1 and (len(points) > 1 or "" in owners):
        whose = f"body '{owner}'" if (owner := owners.pop()) else "the ground"
        yield Finding((*path, "points"), f"'{name}' joins {whose} to itself", "name points of different bodies")


def _owner(point: str) -> str:
    """The body of a point; "" of the ground's."""
    return point.partition(".")[0] if "." in point else ""


def _slider(catalog: Catalog, path: Path, part: Any) -> Iterator[Finding]:
    if _lacks_line(catalog, part.on):
        what = f"'{path[1]}' slides on the line of body '{part.on}', which has none"
        yield Finding((*path, "on"), what, f'give body \'{part.on}\' its line = ["A", "B"]')
    if part.unilateral and catalog.model.space == "space":
        what = f"'{path[1]}' holds its point on a line in space from all sides: it cannot end"
        yield Finding((*path, "unilateral"), what, "leave it out, or use a support", key=True)


def _lacks_line(catalog: Catalog, body: Any) -> bool:
    part = catalog.table("bodies").get(body)
    return part is not None and part.line is None and ("bodies", body, "line") not in catalog.broken


def _string(catalog: Catalog, path: Path, part: Any) -> Iterator[Finding]:
    for k, wrap in enumerate(part.path or ()):
        where = (*path, "path", k)
        if isinstance(wrap, str):
            continue
        yield from one_of(catalog, where, wrap, ("body", "at"))
        if wrap.radius is None and (wrap.at is not None or not is_round(catalog, wrap.body)):
            yield Finding(where, "the radius of this wrap is not known", "give 'radius', or the body a round shape")
        if wrap.turn is None and (*where, "turn") not in catalog.broken:
            yield Finding(where, "a wrap needs 'turn': the sense in which one travels round it", 'turn = "cw" or "ccw"')
        if wrap.axis is not None and catalog.model.space == "plane":
            yield Finding((*where, "axis"), f"'axis' of a wrap of '{path[1]}' is for space", "leave it out", key=True)
        if wrap.slip and k in (0, len(part.path) - 1):
            yield Finding((*where, "slip"), "the string is wound on its last wrap, where it cannot slip", key=True)
    owners = {_owner(stop) if isinstance(stop, str) else stop.body or "" for stop in part.path or ()}
    if len(owners) == 1:
        what = f"the string '{path[1]}' has nothing on it that it could hold: all of it is on one body or the ground"
        yield Finding((*path, "path"), what, "fasten a body to it, or lay it over a pulley that can turn")
    for k, way in enumerate(part.strands or ()):
        if isinstance(way, str) and catalog.model.space == "space":
            what = f"'{way}' says no direction in space, where nothing tells which axis is up"
            yield Finding((*path, "strands", k), what, "give the direction as three components")
    pieces = len(part.path or ()) - 1
    if part.strands is not None and part.path is not None and len(part.strands) != pieces:
        what = f"the string has {pieces} strands, but {len(part.strands)} directions are given"
        yield Finding((*path, "strands"), what)


def coordinates(catalog: Catalog) -> Iterator[Finding]:
    """Coordinates that are driven in two ways, or driven and dependent; starts that a given motion fixes already."""
    for name, part in catalog.table("coordinates").items():
        if part is None:
            continue
        path: Path = ("coordinates", name)
        laws = [law for law in ("motion", "rate", "acceleration") if getattr(part, law) is not None]
        if len(laws) > 1:
            what = f"coordinate '{name}' is driven twice: {', '.join(laws)}"
            yield Finding((*path, laws[1]), what, "keep one", key=True)
        if laws and part.dependent:
            what = f"coordinate '{name}' is driven and dependent"
            yield Finding((*path, "dependent"), what, "it is one or the other", key=True)
        fixed = {"motion": ("start", "speed", "near"), "rate": ("speed", "near"), "acceleration": ("near",)}
        for key in fixed[laws[0]] if laws else ():
            if getattr(part, key) is not None:
                what = f"'{key}' of coordinate '{name}' is given by its '{laws[0]}' already"
                yield Finding((*path, key), what, "leave it out", key=True)


def idle(catalog: Catalog) -> Iterator[Finding]:
    """A coordinate, a speed or an input that nothing uses."""
    used = _used(catalog)
    for table, kind in (("coordinates", "coordinate"), ("inputs", "input")):
        for name in catalog.table(table):
            if name not in used:
                yield Finding((table, name), f"{kind} '{name}' is used by nothing", "use it, or leave it out", key=True)
    for name, part in catalog.table("speeds").items():
        broken = ("speeds", name, "rate") in catalog.broken
        if part is not None and part.rate is None and name not in used and not broken:
            what = f"speed '{name}' has no 'rate' and no joint names it in 'omega'"
            yield Finding(("speeds", name), what, "give its 'rate', an expression in the rates", key=True)


def _used(catalog: Catalog) -> set[str]:
    """The names that something uses; a table of its own is no use, and what could not be read counts as one."""
    used: set[str] = set()
    for leaf, expression in catalog.expressions:
        if leaf.path[0] not in ("parameters", "coordinates", "speeds", "inputs"):
            used.update(name.rstrip("'") for name in expression.names)
            used.update(a.name for call in expression.calls for a in call.args if not hasattr(a, "code"))
    used.update(leaf.value for leaf in catalog.leaves if isinstance(leaf.rule, NameRule))
    for finding in catalog.found:
        used.update(_WORD.findall(str(finding.raw)))
    return used
