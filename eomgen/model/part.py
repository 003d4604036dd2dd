"""A part of a model: a frozen dataclass that reads its own fields by their rules, from Python or from a file."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields
from functools import cache
from inspect import Parameter, Signature, cleandoc
from types import NoneType, UnionType
from typing import Any, ClassVar, Self, Union, get_args, get_origin

from eomgen.errors import ModelError, Problem
from eomgen.frozen import dataclass
from eomgen.model.diagnostics import Diagnostic, meant, nearest, shown, unknown_keys, whereabouts
from eomgen.model.fields import Leaf, WrittenEquation, in_si, is_in_si
from eomgen.model.positions import DocumentPath
from eomgen.model.quantities import Unit
from eomgen.symbolic.expression import Expression, other_words
from eomgen.symbolic.print import Symbol

MADE = "made"
"""mark, in its metadata, of a field that no user gives: the model fills it"""


@dataclass(frozen=True)
class Slot:
    """One field of a part.

    Args:
        name: the attribute in Python.
        key: the key in the file (`from` for the attribute `from_`), or the place in a list.
        rule: what its value may be.
        required: it has no default.
        inline: its keys stand among the keys of the part itself.
        default: its value when it is left out.
    """

    name: str
    key: str | int
    rule: Any
    required: bool
    inline: bool
    default: Any


@cache
def _slots_of(cls: Any) -> tuple[Slot, ...]:
    slots = []
    for field in fields(cls):
        if field.metadata.get(MADE):
            continue
        default = field.default_factory() if field.default_factory is not MISSING else field.default
        required = default is MISSING
        slots.append(
            Slot(
                field.name,
                field.name.rstrip("_"),
                _rule_of(field.type),
                required,
                bool(field.metadata.get("inline")),
                None if required else default,
            )
        )
    return tuple(slots)


@cache
def _made_of(cls: Any) -> dict[str, Any]:
    return {field.name: field.default for field in fields(cls) if field.metadata.get(MADE)}


def _rule_of(annotation: Any) -> Any:
    if get_origin(annotation) in (Union, UnionType):
        (annotation,) = (a for a in get_args(annotation) if a is not NoneType)
    return annotation.__metadata__[0]


class _Fields:
    """The signature of a part's class, for `help` and editors: its fields by name, without the rules by which they are
    read; each is described in the docstring."""

    def __get__(self, instance: Any, cls: Any) -> Signature:
        own = [Parameter("self", Parameter.POSITIONAL_OR_KEYWORD)]
        fields = [
            Parameter(slot.name, Parameter.KEYWORD_ONLY, default=Parameter.empty if slot.required else slot.default)
            for slot in cls.slots()
        ]
        cls.__init__.__signature__ = Signature([*own, *fields], return_annotation=None)
        return Signature(fields)


def _is_whole(value: Any, required: bool) -> bool:
    if isinstance(value, tuple):
        return all(_is_whole(x, required) for x in value)
    return value.is_whole if isinstance(value, Part) else value is not None or not required


def _shown(value: Any) -> str:
    """A value as it is written."""
    if isinstance(value, (Expression, Unit, WrittenEquation, Symbol)):
        return repr(value.text)
    if isinstance(value, tuple):
        return f"[{', '.join(map(_shown, value))}]"
    return repr(value)


@dataclass(frozen=True, kw_only=True, repr=False)
class Part:
    """Base of every part. Values given in Python are read by the same rules as those of a file.

    Raises:
        ModelError: on construction, naming every field whose value cannot be read.
    """

    __signature__ = _Fields()
    shorthand: ClassVar[str] = ""  # the field that a bare value stands for: `m = 1.2`
    title: ClassVar[str] = ""  # what messages call it
    in_unit: ClassVar[tuple[str, ...]] = ()  # the fields whose numbers are in the part's own `unit`

    def __init_subclass__(cls) -> None:
        if "__repr__" not in vars(cls):
            cls.__repr__ = Part.__repr__  # type: ignore[method-assign]

    @classmethod
    def slots(cls) -> tuple[Slot, ...]:
        """The fields of the class, in order."""
        own: Any = cls
        return _slots_of(own)

    @classmethod
    def meanings(cls) -> dict[str, str]:
        """Field -> its meaning, by the docstrings of the class and of its bases; the nearest counts."""
        found: dict[str, str] = {}
        for base in reversed(cls.__mro__):
            found |= dict(_entries(cleandoc(base.__doc__ or "")))
        return found

    @classmethod
    def made(cls) -> dict[str, Any]:
        """{field that no user gives: its default}"""
        own: Any = cls
        return _made_of(own)

    @classmethod
    def of_values(cls, values: Mapping[str, Any]) -> Self:
        """A part from values that were read already."""
        part = object.__new__(cls)
        for slot in cls.slots():
            object.__setattr__(part, slot.name, values.get(slot.name, slot.default))
        for name, default in cls.made().items():
            object.__setattr__(part, name, values.get(name, default))
        return part

    def altered(self, **changes: Any) -> Self:
        """The part with some fields changed to values that were read already."""
        own = (*(slot.name for slot in self.slots()), *self.made())
        return type(self).of_values({name: getattr(self, name) for name in own} | changes)

    @property
    def is_whole(self) -> bool:
        """True if all that must be given could be read, in the parts in it too: what follows of its fields exists."""
        return all(_is_whole(getattr(self, slot.name), slot.required) for slot in self.slots())

    def leaves(self, path: DocumentPath) -> Iterator[Leaf]:
        """Every value of the part and of the parts in it, with its path and its rule."""
        for slot in self.slots():
            value = getattr(self, slot.name)
            if value is not None:
                yield from slot.rule.leaves(value, path if slot.inline else (*path, slot.key), self)

    def __repr__(self) -> str:
        """The part as it is written, with its given fields: Revolute(on='cart', angle='theta')."""
        slots = self.slots()
        given = ((slot.name, getattr(self, slot.name)) for slot in slots if getattr(self, slot.name) != slot.default)
        return f"{type(self).__name__}({', '.join(f'{name}={_shown(value)}' for name, value in given)})"

    def __post_init__(self) -> None:
        found: list[Diagnostic] = []
        raw = {slot.name: getattr(self, slot.name) for slot in self.slots()}
        given = [slot for slot in self.slots() if raw[slot.name] is not slot.default]
        values = {slot.name: slot.rule.read(raw[slot.name], (slot.key,), found) for slot in given}
        for name, value in _in_si(type(self), values, raw).items():
            object.__setattr__(self, name, value)
        if found:
            raise ModelError(
                tuple(Problem(".".join([title_of(type(self)), *map(str, f.path)]), f.what, fix=f.fix) for f in found)
            )


def _in_si(cls: Any, values: dict[str, Any], raw: Mapping[str, Any]) -> dict[str, Any]:
    """The values read, those given in the part's `unit` exactly in SI (one with a unit of its own is so already)."""
    unit = values.get("unit")
    if unit is None or not cls.in_unit:
        return values
    fresh = [name for name in cls.in_unit if values.get(name) is not None and not is_in_si(raw[name])]
    return {**values, **{name: in_si(values[name], unit) for name in fresh}}


def title_of(cls: Any) -> str:
    """The name of parts of this class in messages."""
    return getattr(cls, "title", "") or getattr(cls, "kind", "") or cls.__name__.lower()


@dataclass(frozen=True)
class PartRule:
    """A table that is a part of this class (or a part made in Python)."""

    cls: Any

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        if isinstance(raw, self.cls):
            return raw
        if not isinstance(raw, Mapping):
            if not self.cls.shorthand or isinstance(raw, (list, tuple)):
                what = f"a table is needed here ({title_of(self.cls)}), not {shown(raw)}"
                fields = ", ".join(slot.name for slot in self.cls.slots())
                found.append(Diagnostic(path, what, f"its fields are {fields}"))
                return None
            return self._shorthand(raw, path, found)
        return read_part(self.cls, raw, path, found)

    def _shorthand(self, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
        (slot,) = (s for s in self.cls.slots() if s.name == self.cls.shorthand)
        return self.cls.of_values({slot.name: slot.rule.read(raw, path, found)})

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        found: Iterator[Leaf] = value.leaves(path)
        return found

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        return part_schema(self.cls, definitions)


def read_part(
    cls: Any, raw: Mapping[str, Any], path: DocumentPath, found: list[Diagnostic], known: tuple[str, ...] = ()
) -> Any:
    """A part from a table: unknown and missing keys are reported; what can be read is used."""
    slots = cls.slots()
    inline = next((slot for slot in slots if slot.inline), None)
    own = [slot for slot in slots if slot is not inline]
    keys = (*known, *(slot.key for slot in own))
    values, instead = {}, {}
    if inline is not None:
        rest = {key: value for key, value in raw.items() if key not in keys}
        values[inline.name] = inline.rule.read(rest, path, found, beside=keys)
    else:
        needed = [slot.key for slot in own if slot.required]
        instead = unknown_keys(raw, keys, path, found, whereabouts(path, title_of(cls)), needed=needed)
        raw = {**raw, **{key: raw[given] for key, given in instead.items()}}
    for slot in own:
        if slot.key in instead:
            values[slot.name] = _read_instead(slot, raw[slot.key], (*path, slot.key), found)
        elif slot.key in raw:
            values[slot.name] = slot.rule.read(raw[slot.key], (*path, slot.key), found)
        elif slot.required:
            found.append(
                Diagnostic(path, f"{whereabouts(path, title_of(cls))} has no '{slot.key}'", f"give '{slot.key}'")
            )
            values[slot.name] = None
    return cls.of_values(_in_si(cls, values, raw))


def _read_instead(slot: Slot, raw: Any, path: DocumentPath, found: list[Diagnostic]) -> Any:
    """A value under a key that was mistyped, so that what follows from it is no error; a table reports its own."""
    wrong: list[Diagnostic] = []
    value = slot.rule.read(raw, path, wrong)
    if isinstance(raw, Mapping):
        found += wrong
    return None if wrong and not isinstance(raw, Mapping) else value


@dataclass(frozen=True)
class SeamRule:
    """A table whose `kind` names one of several classes.

    Args:
        what: what a member is called: "shape", "joint", "force", "constraint".
        members: the seam's tuple ALL.
        made: members that nobody declares: other parts of a model make them.
    """

    what: str
    members: tuple[Any, ...]
    made: tuple[Any, ...] = ()

    def read(self, raw: Any, path: DocumentPath, found: list[Diagnostic], beside: tuple[str, ...] = ()) -> Any:
        """A member of the seam; the keys `beside` its own are read already, and are known here."""
        if isinstance(raw, (*self.members, *self.made)):
            return raw
        if not isinstance(raw, Mapping):
            named = f"each has a name of its own: [{path[0]}.NAME]" if len(path) == 2 else ""
            found.append(Diagnostic(path, f"a {self.what} is a table with a 'kind', not {shown(raw)}", named))
            return None
        kinds = {member.kind: member for member in self.members}
        kind = raw.get("kind")
        given = next((key for key in raw if other_words(str(key), ("kind",)) and key not in beside), None)
        if kind is None and given is not None:
            found.append(
                Diagnostic(
                    (*path, given), f"unknown key '{given}' in {whereabouts(path, self.what)}", "write kind", key=True
                )
            )
            return self.read({**{k: x for k, x in raw.items() if k != given}, "kind": raw[given]}, path, found, beside)
        if kind is None:
            what = f"{whereabouts(path, self.what)} has no 'kind'"
            found.append(Diagnostic(path, what, f"one of {', '.join(kinds)}", raw=raw))
            return None
        if not isinstance(kind, str) or kind not in kinds:
            fix = nearest(str(kind), kinds) or f"one of {', '.join(kinds)}"
            found.append(Diagnostic((*path, "kind"), f"unknown kind of {self.what}: {shown(kind)}", fix, raw=raw))
            return self._as_meant(kinds, str(kind), raw, path, found, beside)
        return read_part(kinds[kind], raw, path, found, known=("kind", *beside))

    def _as_meant(
        self,
        kinds: Mapping[str, Any],
        kind: str,
        raw: Mapping[str, Any],
        path: DocumentPath,
        found: list[Diagnostic],
        beside: tuple[str, ...],
    ) -> Any:
        """A member whose kind was mistyped, read as the one that its keys fit, with its other errors; else None."""
        for guess in meant(kind, kinds)[:1]:
            wrong: list[Diagnostic] = []
            value = read_part(kinds[guess], raw, path, wrong, known=("kind", *beside))
            if not any(each.key or each.path == path for each in wrong):
                found += wrong
                return value
        return None

    def leaves(self, value: Any, path: DocumentPath, part: Any) -> Iterator[Leaf]:
        found: Iterator[Leaf] = value.leaves(path)
        return found

    def schema(self, definitions: dict[str, Any]) -> dict[str, Any]:
        branches = [part_schema(member, definitions) for member in self.members]
        return {"oneOf": branches, "required": ["kind"]}


def part_schema(cls: Any, definitions: dict[str, Any]) -> dict[str, Any]:
    """The JSON Schema of a part, by reference into `definitions` (draft 2020-12)."""
    name = cls.__name__
    if name not in definitions:
        definitions[name] = {}  # stands here while its own parts are written
        definitions[name] = _table_schema(cls, definitions)
    return {"$ref": f"#/$defs/{name}"}


def _table_schema(cls: Any, definitions: dict[str, Any]) -> dict[str, Any]:
    slots = cls.slots()
    properties = {slot.key: slot.rule.schema(definitions) for slot in slots if not slot.inline}
    required = [slot.key for slot in slots if slot.required and not slot.inline]
    kind = getattr(cls, "kind", None)
    if kind is not None:
        properties, required = {"kind": {"const": kind}, **properties}, ["kind", *required]
    table: dict[str, Any] = {
        "title": cls.__name__,
        "description": _first_line(cls),
        "type": "object",
        "properties": properties,
    }
    if required:
        table["required"] = required
    inline = [slot for slot in slots if slot.inline]
    if inline:
        return _with_inline(table, inline[0].rule.members, definitions)
    table["additionalProperties"] = False
    if cls.shorthand:
        (bare,) = (slot.rule for slot in slots if slot.name == cls.shorthand)
        return {"title": cls.__name__, "anyOf": [bare.schema(definitions), table]}
    return table


def _with_inline(table: dict[str, Any], members: tuple[Any, ...], definitions: dict[str, Any]) -> dict[str, Any]:
    """A table that holds the keys of one of several parts besides its own."""
    branches = []
    for member in members:
        inner = _table_schema(member, definitions)
        merged = {**inner["properties"], **table["properties"]}
        required = [*inner.get("required", ()), *table.get("required", ())]
        branches.append({**inner, "properties": merged, "required": required})
    return {"title": table["title"], "description": table["description"], "oneOf": branches}


_ENTRY = re.compile(r"^(\w[\w, ]*): (.*)$")


def _entries(text: str) -> Iterator[tuple[str, str]]:
    names: list[str] = []
    words = ""
    for line in text.partition("\nArgs:\n")[2].splitlines():
        match = _ENTRY.match(line.removeprefix("    "))
        if not line.startswith("    "):
            break
        if match and not line.startswith("     "):
            yield from ((name, words) for name in names)
            names, words = match[1].split(", "), match[2]
        else:
            words += f" {line.strip()}"
    yield from ((name, words) for name in names)


def _first_line(cls: Any) -> str:
    return (cls.__doc__ or "").strip().split("\n")[0]
