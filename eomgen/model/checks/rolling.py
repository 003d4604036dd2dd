"""What rolls on what: a round body, a track, and fields that fit the space and one another."""

from collections.abc import Iterator
from typing import Any

from eomgen.model.checks.catalog import Catalog
from eomgen.model.checks.choices import not_in_the_plane, one_of
from eomgen.model.findings import Finding, Path

TRACKS = ("line", "plane", "circle")


def rolling(catalog: Catalog, path: Path, part: Any) -> Iterator[Finding]:
    """All that can be wrong with a rolling contact."""
    alone = part.on is not None and all(getattr(part, track) is None for track in TRACKS)
    yield from one_of(catalog, path, part, (*TRACKS, "on") if part.on is None or alone else TRACKS)
    yield from _sizes(catalog, path, part)
    if alone and not is_round(catalog, part.on):
        what = f"'{part.body}' rolls on body '{part.on}', which is not round"
        yield Finding((*path, "on"), what, "give the line or circle of it, or the body a round shape")
    track = part.line or part.plane or part.circle
    if part.on is not None and track is not None and isinstance(track.at, str):
        what = f"'{track.at}' is a point of the ground, but the track is fixed in body '{part.on}'"
        yield Finding(path, what, f"give 'at' as coordinates in the axes of '{part.on}'")
    yield from _of_space(catalog, path, part, curved=alone or part.circle is not None)
    if part.on is not None and part.on == part.body:
        yield Finding((*path, "on"), f"'{part.body}' cannot roll on itself")
    if part.friction is not None and not part.slip:
        yield Finding((*path, "friction"), "friction needs sliding", "slip = true, or leave 'friction' out", key=True)


def is_round(catalog: Catalog, body: Any, sizes: tuple[str, ...] = ("radius",)) -> bool:
    """Whether a body's shape has a radius, or other such sizes (or could not be read)."""
    part = catalog.table("bodies").get(body)
    return part is None or ("bodies", body, "shape") in catalog.broken or any(hasattr(part.shape, x) for x in sizes)


def _sizes(catalog: Catalog, path: Path, part: Any) -> Iterator[Finding]:
    """A radius, or semiaxes, of the tie or of the shape; not both; a tyre only about an axis."""
    sizes = ("radius",) if catalog.model.space == "plane" else ("radius", "semiaxes", "major")
    if part.radius is None and part.ellipsoid is None and not is_round(catalog, part.body, sizes):
        what = f"the radius of '{part.body}', which rolls, is not known"
        yield Finding(path, what, "give 'radius', or the body a round shape")
    for key in ("radius", "axis", "tube") if part.ellipsoid is not None else ():
        if getattr(part, key) is not None:
            what = f"'{path[1]}' has an 'ellipsoid' and '{key}': it is one or the other"
            yield Finding((*path, key), what, "keep one", key=True)
    if part.tube is not None and part.axis is None and not is_round(catalog, part.body, ("major",)):
        yield Finding((*path, "tube"), f"the tyre of '{part.body}' has no 'axis'", "give it, body axes", key=True)


def _of_space(catalog: Catalog, path: Path, part: Any, curved: bool) -> Iterator[Finding]:
    """In the plane no fields of space; in space a plane for a line; wheels on planes and balls, eggs on planes."""
    if catalog.model.space == "plane":
        if part.plane is not None:
            mend = "in the plane a body rolls on a 'line'"
            yield Finding((*path, "plane"), f"'plane' of '{path[1]}' is for space", mend, key=True)
        yield from not_in_the_plane(catalog, path, part, ("axis", "ellipsoid", "tube"))
        if part.circle is not None and part.circle.axis is not None:
            yield Finding((*path, "circle", "axis"), f"'axis' of '{path[1]}' is for space", "leave it out", key=True)
        return
    if part.line is not None:
        yield Finding((*path, "line"), f"'line' of '{path[1]}' is for the plane", "in space: 'plane'", key=True)
    pipe = part.circle is not None and part.circle.axis is not None
    for key in (*(["axis"] if pipe else []), "ellipsoid") if curved else ():
        if getattr(part, key) is not None:
            where = "only a ball rolls in or on a pipe" if key == "axis" else "no ellipsoid rolls on something curved"
            what = f"'{path[1]}': {where}, '{part.body}' has '{key}'"
            yield Finding((*path, key), what, "let it roll on a 'plane', or leave it out", key=True)
