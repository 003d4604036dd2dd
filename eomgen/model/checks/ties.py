"""Ties, forces and coordinates: what goes together, what excludes what, and that nothing is idle."""

import re
from collections.abc import Iterator
from typing import Any

from eomgen.model.catalog import Catalog, findings_of_one, owner_of
from eomgen.model.fields import NameRule
from eomgen.model.findings import Finding
from eomgen.model.positions import DocumentPath

_WORD = re.compile(r"[^\W\d]\w*")


def ties(catalog: Catalog) -> Iterator[Finding]:
    """Fields of ties and forces that exclude one another, or of which one is missing."""
    for table in ("constraints", "forces"):
        for name, part in catalog.table(table).items():
            if part is None:
                continue
            path: DocumentPath = (table, name)
            if part.one_of:
                yield from findings_of_one(catalog, path, part, part.one_of)
            yield from part.findings(path, catalog)
            if table == "constraints":
                yield from _on_itself(catalog, path, part)
            friction = getattr(part, "friction", None)
            if friction is not None:
                yield from findings_of_one(catalog, (*path, "friction"), friction, ("coulomb", "viscous"))


def _on_itself(catalog: Catalog, path: DocumentPath, part: Any) -> Iterator[Finding]:
    """A tie that joins a body to itself, or the ground to the ground."""
    name = path[1]
    bodies = getattr(part, "bodies", None)
    if bodies and bodies[0] == bodies[1]:
        yield Finding((*path, "bodies", 1), f"'{name}' gears body '{bodies[0]}' with itself", "name two bodies")
    points = getattr(part, "points", None) or ()
    point = getattr(part, "point", None)
    if any(name not in catalog.point_names() for name in (point, *points) if name is not None):
        return
    if point is not None and "." not in point and not part.holds_ground:
        yield Finding((*path, "point"), f"'{name}' holds '{point}', a point of the ground", "name a point of a body")
    owners = {owner_of(point) for point in points}
    if len(owners) == 1 and (len(points) > 1 or "" in owners):
        whose = f"body '{owner}'" if (owner := owners.pop()) else "the ground"
        yield Finding((*path, "points"), f"'{name}' joins {whose} to itself", "name points of different bodies")


def coordinates(catalog: Catalog) -> Iterator[Finding]:
    """Coordinates that are driven in two ways, or driven and dependent; starts that a given motion fixes already."""
    for name, part in catalog.table("coordinates").items():
        if part is None:
            continue
        path: DocumentPath = ("coordinates", name)
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
    for name, part in catalog.table("speeds").items():
        if name in used and part is not None and part.rate is not None:
            used.update(x.rstrip("'") for x in part.rate.names)
    for finding in catalog.found:
        used.update(_WORD.findall(str(finding.raw)))
    return used
