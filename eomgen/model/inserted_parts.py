"""Things of another file -> things of a model, under names of their own, on a body of the model or where they stood."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

from eomgen.frozen import dataclass
from eomgen.model.diagnostics import TABLES, Decimal, Diagnostic, nearest, shown
from eomgen.model.fields import Alternatives, Leaf, NameRule, ParsedTextRule, TextRule, VectorRule
from eomgen.model.part import Part
from eomgen.model.positions import DocumentPath
from eomgen.model.quantities import Unit

PARTS, COUNTED = "parts", "parameters"
TEXTS = ("kind", "unit", "about", "symbol")
"""keys whose text holds no name of a part"""
PLACED = ("on", "at", "turned")
KEYS = ("file", *PLACED, "set", "about")
Drafting = Callable[[Mapping[str, Any], list[Diagnostic]], Any]
"""reads tables as a model, unchecked"""

_NAME = re.compile(r"[^\W\d]\w*")
_WORD = re.compile(r"(?<![\w.])([^\W\d]\w*)(?:\.([^\W\d]\w*))?(?=(?P<call>'*\s*\()?)")


@dataclass(frozen=True)
class WrittenAt:
    """The place where something of the expanded tables is written.

    Args:
        source: number of the file, 0 the model's own.
        path: in it.
        where: values of the indices there: "i = 3".
    """

    source: int
    path: DocumentPath
    where: str = ""


@dataclass(frozen=True)
class ModelFile:
    """A file of a model.

    Args:
        name: in messages.
        text: its content.
        raw: its tables.
    """

    name: str
    text: str
    raw: Mapping[str, Any]


def table_of(raw: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """A table of tables; empty where there is none."""
    table = raw.get(key)
    return table if isinstance(table, Mapping) else {}


class Refused(Exception):
    """Refusal of what cannot be repeated, at its place in a file; None: in the one that is being read."""

    def __init__(self, found: Diagnostic, source: ModelFile | None = None) -> None:
        self.found, self.source = found, source


@dataclass
class Expanded:
    """The tables of a file as they are read.

    Args:
        tables: without [repeat] and [parts].
        places: of each entry by its path.
        sources: the file and those of its parts.
        counts: the parameters by which something is counted.
    """

    tables: dict[str, Any]
    places: dict[DocumentPath, WrittenAt]
    sources: list[ModelFile]
    counts: tuple[str, ...] = ()

    def origin(self, path: DocumentPath) -> WrittenAt:
        """The place where something is written: itself, or the nearest that holds it."""
        for k in range(len(path), 0, -1):
            if (found := self.places.get(path[:k])) is not None:
                return replace(found, path=(*found.path, *path[k:]))
        return WrittenAt(0, path)

    def as_written(self, found: Diagnostic) -> tuple[int, Diagnostic]:
        """(number of the file, the diagnostic at its place there)."""
        place = self.origin(found.path)
        if place == WrittenAt(0, found.path):
            return 0, found
        what = f"{found.what} ({place.where})" if place.where else found.what
        found = replace(found, path=place.path, what=what)
        changed = bool(place.where) or place.source
        return place.source, replace(found, column=None, length=None, beside=None) if changed else found


# -------- parts -----------------------------------------------------------------------------------------------


def refused_at(made: Expanded, found: Diagnostic) -> Refused:
    """The refusal at the place where it is written."""
    place = made.origin(found.path)
    return Refused(replace(found, path=place.path), made.sources[place.source])


def part_file(made: Expanded, name: str, spec: Any) -> str:
    """The file of a part.

    Raises:
        Refused: what is said of the part is wrong.
    """
    path: DocumentPath = (PARTS, name)
    if not isinstance(spec, Mapping) or not isinstance(spec.get("file"), str):
        what = f"part '{name}' has no 'file'"
        raise refused_at(made, Diagnostic(path, what, f'[parts.{name}] and below it file = "leg.toml"'))
    for key in spec:
        if key not in KEYS:
            what, fix = f"unknown key '{key}' in part '{name}'", nearest(key, KEYS) or f"known here: {', '.join(KEYS)}"
            raise refused_at(made, Diagnostic((*path, key), what, fix, key=True))
    if not isinstance(spec.get("set", {}), Mapping):
        what = f"a table of parameters is needed here, not {shown(spec['set'])}"
        raise refused_at(made, Diagnostic((*path, "set"), what, "set = { l = 2 }"))
    file = spec["file"]
    assert isinstance(file, str)
    return file


def counts_set(made: Expanded, name: str, spec: Mapping[str, Any], source: ModelFile) -> dict[str, int]:
    """The whole numbers among the parameters of a part that are set: it may count by them.

    Raises:
        Refused: it has no such parameter.
    """
    known = table_of(source.raw, COUNTED)
    for key in spec.get("set", {}):
        if key not in known:
            fix = nearest(key, known) or f"there are {', '.join(known) or 'none'}"
            told = Diagnostic((PARTS, name, "set", key), f"the part has no parameter '{key}'", fix, key=True)
            raise refused_at(made, told)
    values = spec.get("set", {}).items()
    return {key: x for key, x in values if isinstance(x, int) and not isinstance(x, bool)}


def put_in(made: Expanded, name: str, spec: Mapping[str, Any], part: Expanded, draft: Drafting) -> None:
    """Put the things of a part among those of a model.

    Raises:
        Refused: they do not fit.
    """
    path: DocumentPath = (PARTS, name)
    first, found = len(made.sources), list[Diagnostic]()
    made.sources.extend(part.sources)
    whole = draft(part.tables, found)
    if found:
        number, told = part.as_written(found[0])
        raise Refused(told, part.sources[number])
    if made.tables.get("space") != part.tables.get("space"):
        what = "the part is of the plane and the model of space, or the other way round"
        raise refused_at(made, Diagnostic((*path, "file"), what, "write both in one of them"))
    seat = {key: spec[key] for key in PLACED if key in spec}
    shift = seat.pop("at") if seat.keys() == {"at"} and isinstance(seat["at"], list) else None
    tables = _Renamed(name, whole, part, bool(seat), shift).tables()
    for key, x in spec.get("set", {}).items():
        own = f"{name}_{key}"
        tables[COUNTED][own] = _with_value(tables[COUNTED][own], x)
        made.places[(COUNTED, own, "value")] = made.origin((*path, "set", key))
    _leave_out(tables, (f"{name}_{count}" for count in part.counts))
    _take_weights(made.tables, tables)
    _merge(made, tables, name, seat)
    for at, place in part.places.items():
        if len(at) > 1 and at[0] in TABLES:
            new = (at[0], f"{name}_{at[1]}", *at[2:])
            made.places.setdefault(new, WrittenAt(first + place.source, place.path, place.where))


def _with_value(entry: Any, value: Any) -> Any:
    """A parameter of a part with another value; one with names in it is in SI."""
    kept = dict(entry) if isinstance(entry, Mapping) else {}
    if isinstance(value, Mapping):
        return {**kept, **value}
    if isinstance(value, str) and not isinstance(value, Decimal) and _NAME.search(value):
        kept |= {"unit": Unit.parse(str(kept["unit"])).si} if "unit" in kept else {}
    return {**kept, "value": value}


def _take_weights(tables: Mapping[str, Any], part: dict[str, Any]) -> None:
    """Leave out the weight of a part on all bodies where the model has one already, and what nothing else needs."""

    def general(force: Any) -> bool:
        return isinstance(force, Mapping) and force.get("kind") == "gravity" and "bodies" not in force

    if not any(map(general, table_of(tables, "forces").values())):
        return
    left = {key: x for key, x in part["forces"].items() if general(x)}
    part["forces"] = {key: x for key, x in part["forces"].items() if key not in left}
    _leave_out(part, _NAME.findall(repr(left)))


def _leave_out(part: dict[str, Any], names: Iterable[str]) -> None:
    """Leaves parameters of a part out that nothing of it needs."""
    for name in set(names) & part[COUNTED].keys():
        if len(re.findall(rf"\b{name}\b", repr(part))) == 1:  # its own declaration
            del part[COUNTED][name]


def _merge(made: Expanded, tables: Mapping[str, Any], name: str, placed: Mapping[str, Any]) -> None:
    """Put a part's tables among those of a model, on a body of its own where it is placed."""
    path: DocumentPath = (PARTS, name)
    if placed:
        seat = dict(placed)
        if "turned" in seat and not isinstance(seat["turned"], (list, Mapping)):
            seat["turned"] = {"angle": seat["turned"]}
        body = {"joint": {"kind": "fixed", **seat}, "points": tables["points"]}
        made.tables.setdefault("bodies", {})
        if name in made.tables["bodies"]:
            what = f"a body is called '{name}', as the part is"
            raise refused_at(made, Diagnostic(path, what, "give one another name", key=True))
        made.tables["bodies"][name] = {key: x for key, x in body.items() if x}
        made.places[("bodies", name)] = made.origin(path)
        for key in PLACED:
            made.places[("bodies", name, "joint", key)] = made.origin((*path, key))
    for key, entries in tables.items():
        if key == "points" and placed:
            continue
        own = made.tables.setdefault(key, {})
        for each, entry in entries.items():
            if each in own:
                what = f"'{each}' of part '{name}' is declared already"
                raise refused_at(made, Diagnostic(path, what, "give one another name", key=True))
            own[each] = entry


@dataclass(frozen=True)
class _Renamed:
    """The tables of a part, its names with those of the part before them.

    Args:
        name: of the part.
        draft: the model that its tables are.
        part: its tables.
        placed: it stands on a body of its own.
        shift: by which it is moved on the ground.
    """

    name: str
    draft: Any
    part: Expanded
    placed: bool
    shift: list[Any] | None

    def tables(self) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for table in TABLES:
            entries = self._table(table).items()
            found[table] = {self._called(table, str(key)): self._value(x, (table, key)) for key, x in entries}
        if self.placed:
            self._on_its_body(found)
        elif self.shift is not None:
            self._shifted(found)
        return found

    def _called(self, table: str, key: str) -> str:
        return key if self.placed and table == "points" else f"{self.name}_{key}"

    @cached_property
    def _leaves(self) -> dict[DocumentPath, Leaf]:
        return {leaf.path: leaf for leaf in self.draft.leaves(())}

    def _value(self, raw: Any, path: DocumentPath) -> Any:
        leaf = self._leaves.get(path)
        if isinstance(raw, Alternatives):
            raw = raw.chosen if is_one(path, leaf) else list(raw)
        if isinstance(raw, Mapping):
            return {key: self._value(x, (*path, key)) for key, x in raw.items()}
        if isinstance(raw, list):
            return [self._value(x, (*path, k)) for k, x in enumerate(raw)]
        if not isinstance(raw, str) or isinstance(raw, Decimal) or path[-1] in TEXTS or _is_own(leaf):
            return raw
        hidden = {name.rstrip("'") for name in getattr(getattr(leaf, "rule", None), "also", ())}
        at = self._place(path, raw)
        return at if at is not None else self._text(raw, hidden)

    def _place(self, path: DocumentPath, raw: str) -> Any:
        """The coordinates of a point of the ground that is named where only such a one can be; None of other texts."""
        points = self._table("points")
        if self.placed and path[-1] == "at" and raw in points:
            return self._value(points[raw], ("points", raw))
        return None

    def _text(self, text: str, hidden: set[str]) -> str:
        """A text with the names of things replaced; of tension(T, n1-n2) the nodes are the truss's own."""
        trusses = "|".join(map(str, self._table("trusses")))
        own = [x.span(1) for x in re.finditer(rf"\(\s*(?:{trusses})\s*(,[^()]*)\)", text)] if trusses else []

        def word(found: re.Match[str]) -> str:
            kept = any(a <= found.start() < b for a, b in own)
            if kept or found[1] in hidden or (found["call"] and found[1] not in self._table("tables")):
                return found[0]
            side = found[2]
            if side and found[1] in self._table("constraints") and side in self._table("bodies"):  # B.beam: of its two
                side = f"{self.name}_{side}"
            return ".".join(filter(None, (self._word(found[1]), side)))

        return _WORD.sub(word, text)

    def _table(self, table: str) -> Mapping[str, Any]:
        return table_of(self.part.tables, table)

    def _word(self, word: str) -> str:
        if self.placed and word in self._table("points"):
            return f"{self.name}.{word}"
        known = any(word in self._table(table) for table in TABLES) or word in (self.draft.states or {})
        return f"{self.name}_{word}" if known else word

    def _on_its_body(self, tables: dict[str, Any]) -> None:
        """Puts what stood on the ground on the body of the part, in whose axes its directions are then."""
        for key, body in tables["bodies"].items():
            joint = body.get("joint") if isinstance(body, Mapping) else None
            if isinstance(joint, Mapping) and "on" not in joint:
                tables["bodies"][key] = {**body, "joint": {**joint, "on": self.name}}
            elif joint is None:
                tables["bodies"][key] = {**body, "joint": {"kind": "placed", "on": self.name}}
        directed = {leaf.path[:2] for leaf in self.draft.leaves(()) if _is_of_the_ground(leaf)}
        for table, key in sorted(directed):
            drawn: Part = getattr(self.draft, table)[key]
            new = self._called(str(table), str(key))
            axes = next((slot.key for slot in type(drawn).slots() if slot.key in ("axes", "on")), None)
            if axes is None:
                raise self._refused(table, key, "directions")
            if axes not in tables[table][new] or tables[table][new][axes] == "ground":
                tables[table][new] = {**tables[table][new], axes: self.name}

    def _shifted(self, tables: dict[str, Any]) -> None:
        """Moves what stands on the ground; directions stay."""
        tables["points"] = {key: self._moved(at, "points", key) for key, at in tables["points"].items()}
        for key, body in tables["bodies"].items():
            joint = body.get("joint") if isinstance(body, Mapping) else None
            if joint is None:
                tables["bodies"][key] = {**body, "joint": {"kind": "placed", "at": self.shift}}
            elif isinstance(joint, Mapping) and "on" not in joint and not isinstance(joint.get("at"), str):
                at = self._moved(joint["at"], "bodies", key) if "at" in joint else self.shift
                tables["bodies"][key] = {**body, "joint": {**joint, "at": at}}
        for leaf in self.draft.leaves(()):
            if _is_of_the_ground(leaf) and leaf.rule.point and getattr(leaf.part, "on", None) is None:
                table, key, *inner, last = leaf.path
                holder = tables[str(table)][self._called(str(table), str(key))]
                for each in inner:
                    holder = holder[each]
                holder[last] = self._moved(holder[last], table, key)
        for key, truss in tables["trusses"].items():
            nodes = {node: self._moved(at, "trusses", key) for node, at in truss["nodes"].items()}
            tables["trusses"][key] = {**truss, "nodes": nodes}

    def _moved(self, at: Any, table: str, key: Any) -> list[Any]:
        shift = self.shift or []
        if (
            not isinstance(at, list)
            or len(at) != len(shift)
            or not all(isinstance(x, (int, str)) for x in (*at, *shift))
        ):
            raise self._refused(table, key, "places")
        return [y if x in (0, "0") else x if y in (0, "0") else f"{x} + ({y})" for x, y in zip(shift, at, strict=True)]

    def _refused(self, table: Any, key: Any, what: str) -> Refused:
        place = self.part.origin((table, key))
        told = f"'{key}' is written with {what} in the axes of the ground: its part cannot be placed"
        fix = "place it by names of points"
        if what == "directions":
            fix = "place its part by `at` alone, or use what a body carries: a slider on its line, limits of a joint"
        return Refused(Diagnostic(place.path, told, fix), self.part.sources[place.source])


def is_one(path: DocumentPath, leaf: Leaf | None) -> bool:
    """True if one reference is read at a path: a seat on a point of the ground is its place by then."""
    return path[-1] == "on" or (leaf is not None and isinstance(leaf.value, str))


def _is_own(leaf: Leaf | None) -> bool:
    """True for a text that holds no name of the model: words, a point of the body whose table it is in."""
    rule = None if leaf is None else leaf.rule
    own = isinstance(rule, NameRule) and rule.of in ("own point", "member")
    return own or isinstance(rule, (TextRule, ParsedTextRule)) or (isinstance(rule, VectorRule) and rule.own_point)


def _is_of_the_ground(leaf: Leaf) -> bool:
    """True for a vector of a constraint or force in the axes of the ground; the field of weights is the model's."""
    vector = isinstance(leaf.rule, VectorRule) and not leaf.rule.own_point and not isinstance(leaf.value, str)
    return vector and leaf.path[0] in ("constraints", "forces") and getattr(leaf.part, "kind", "") != "gravity"
