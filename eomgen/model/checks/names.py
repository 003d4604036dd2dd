"""Names: what may be one, and that each means one thing."""

import re
from collections.abc import Iterator
from typing import Any

from eomgen.model.catalog import OBJECT_TABLES, SYMBOL_TABLES, Catalog
from eomgen.model.findings import Finding, one_of
from eomgen.symbolic.expression.expressions import is_name

RESERVED = {"t": "time", "pi": "the constant", "nan": "no number", "inf": "no number", "infinity": "no number"}
_WORD = re.compile(r"\w+")


def names(catalog: Catalog) -> Iterator[Finding]:
    """Names that are none, that are reserved, or that stand for two things."""
    yield from _symbols(catalog)
    yield from _objects(catalog)
    yield from _points(catalog)
    yield from _twice(catalog, SYMBOL_TABLES)
    yield from _twice(catalog, OBJECT_TABLES)


def _symbols(catalog: Catalog) -> Iterator[Finding]:
    for table in SYMBOL_TABLES:
        for name in catalog.table(table):
            if name in RESERVED or name.lower() in ("nan", "inf", "infinity"):
                meaning = RESERVED[name.lower()]
                yield Finding((table, name), f"'{name}' is reserved: it means {meaning}", "take another name", key=True)
            elif not is_name(name):
                yield _no_name(table, name, "letters, digits and _, a letter first")


def _objects(catalog: Catalog) -> Iterator[Finding]:
    for table in (*OBJECT_TABLES, "points", "forces", "outputs"):
        for name in catalog.table(table):
            if not _WORD.fullmatch(name):
                yield _no_name(table, name, "letters, digits and _")
            elif table == "bodies" and name == "ground":
                yield Finding((table, name), "'ground' means the ground, not a body", "take another name", key=True)


def _no_name(table: str, name: str, made_of: str) -> Finding:
    return Finding((table, name), f"'{name}' cannot name {one_of(table)}", f"a name is made of {made_of}", key=True)


def _points(catalog: Catalog) -> Iterator[Finding]:
    for body, part in catalog.table("bodies").items():
        for point in (part.points or {}) if part else ():
            path = ("bodies", body, "points", point)
            if not _WORD.fullmatch(point):
                yield Finding(path, f"'{point}' cannot name a point", "use letters, digits and _", key=True)
            elif point in _points_of_its_own(part):
                what = f"body '{body}' has a point '{point}' of its own already"
                yield Finding(path, what, "take another name, or leave it out", key=True)


def _points_of_its_own(part: Any) -> tuple[str, ...]:
    if part.shape is not None:
        return tuple(part.shape.point_names)
    heavy = any(source is not None for source in (part.mass, part.center, part.parts))
    return ("origin", "center") if heavy else ()


def _twice(catalog: Catalog, tables: tuple[str, ...]) -> Iterator[Finding]:
    first: dict[str, str] = {}
    for table in tables:
        for name in catalog.table(table):
            if name in first:
                what = f"'{name}' is declared twice: as {one_of(first[name])} and as {one_of(table)}"
                yield Finding((table, name), what, "give one of them another name", key=True)
            first.setdefault(name, table)
