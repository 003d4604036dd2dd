"""Fields of which one is given, and fields that mean nothing in the plane."""

from collections.abc import Iterator
from typing import Any

from eomgen.model.checks.catalog import Catalog
from eomgen.model.findings import Finding, Path


def one_of(catalog: Catalog, path: Path, part: Any, keys: tuple[str, ...]) -> Iterator[Finding]:
    """Exactly one of these fields is given."""
    given = [key for key in keys if getattr(part, key) is not None]
    listed = " and ".join(f"'{key}'" for key in keys)
    if len(given) > 1:
        yield Finding((*path, given[1]), f"only one of {listed} can be given ({'.'.join(map(str, path))})", key=True)
    elif not given and not any((*path, key) in catalog.broken for key in keys):
        yield Finding(path, f"one of {listed} is needed ({'.'.join(map(str, path))})")


def not_in_the_plane(catalog: Catalog, path: Path, part: Any, keys: tuple[str, ...]) -> Iterator[Finding]:
    """Fields for space that are given in the plane."""
    for key in keys if catalog.model.space == "plane" else ():
        if getattr(part, key) is not None:
            yield Finding((*path, key), f"'{key}' of '{path[1]}' is for space", "leave it out", key=True)
