"""Frozen records: what `dataclasses.dataclass` makes of a class, in 2/5 of its time.

The library writes and compiles six methods of each class. For the four hundred classes that a verb loads that is
0.18 s of CPU of the 0.83 s of `check`, and 0.22 s of the 1.23 s of `derive` (Python 3.11); by what follows it is
0.035 s of both, which is why this file exists. Here `__init__` alone is compiled, and only once it is asked for: most
classes that are loaded are never made. What compares, hashes, shows and refuses is the same for all. The library's own
way got faster in later versions: when 3.13 is the oldest that is supported, measure again, and if nothing is left of
the difference, delete this file.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Hashable
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, TypeVar, cast

_Made = TypeVar("_Made")

RECALLED = "_recalled"  # where a record caches what was computed from it
MOST_RECALLED = 8

_SET = object.__setattr__


class _Factory:
    """The default of an argument that is made anew at each call, as it stands in a signature."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY = _Factory()

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(cls=None, /, *, frozen=False, slots=False, kw_only=False, eq=True, repr=True):
        """Makes a class a dataclass, like `dataclasses.dataclass`; a frozen class without slots is made faster.

        It is recognized as frozen by the changes that it refuses alone: its `__dataclass_params__` do not say so.
        """

        def made(cls):
            if slots or not frozen:
                return dataclasses.dataclass(cls, frozen=frozen, slots=slots, kw_only=kw_only, eq=eq, repr=repr)
            return _frozen(cls, kw_only=kw_only, eq=eq, shown=repr)

        return made if cls is None else made(cls)


class Pickled:
    """A function that returns a value computed before, for any arguments; pickles carry it instead of its maker."""

    def __init__(self, value: Any) -> None:
        self.value = value

    def __call__(self, *_: Any) -> Any:
        return self.value


def with_fields(record: Any, **changes: Any) -> Any:
    """A copy of a frozen record with some fields changed, in a tenth of the time of `dataclasses.replace`.

    Only for records without `__post_init__`, as nothing is checked.
    """
    made, held = object.__new__(type(record)), record.__dict__
    made.__dict__.update({name: held[name] for name in record.__dataclass_fields__}, **changes)
    return made


def recalled(record: Any, key: Hashable, make: Callable[[], _Made]) -> _Made:
    """make(), cached with a frozen record; of its last MOST_RECALLED keys each is computed once.

    It lives as long as the record, and no longer; a class whose records cache something leaves it out of its pickles.
    """
    known = record.__dict__.setdefault(RECALLED, {})
    found = known.pop(key, _FACTORY)
    if found is _FACTORY:
        found = make()
    known[key] = found  # now the youngest
    while len(known) > MOST_RECALLED:
        known.pop(next(iter(known)), None)
    return cast("_Made", found)


def _frozen(cls: type, *, kw_only: bool, eq: bool, shown: bool) -> type:
    """The class with its methods; what it defines itself stays."""
    own = cls.__dict__
    documented = own.get("__doc__") is not None  # else the library makes one of the signature
    if not documented:
        cls.__doc__ = cls.__name__  # all that is said of a module's own; the library would ask for a signature
    dataclasses.dataclass(init=False, repr=False, eq=False, kw_only=kw_only)(cls)
    fields = dataclasses.fields(cls)
    found: dict[str, Any] = {"__setattr__": _refusing_to_set(cls), "__delattr__": _refusing_to_delete(cls)}
    if "__init__" not in own:
        type.__setattr__(cls, "__init__", _InitWhenAsked(cls, fields))
    if shown and "__repr__" not in own:
        found["__repr__"] = _shown_by([f.name for f in fields if f.repr])
    if eq:
        compared = tuple(f.name for f in fields if f.compare)
        hashed = tuple(f.name for f in fields if (f.compare if f.hash is None else f.hash))
        if "__eq__" not in own:
            found["__eq__"] = _compared_by(_values_of(compared))
        if own.get("__hash__") is None:  # the None that Python adds to an __eq__ says nothing
            found["__hash__"] = _hashed_by(_values_of(hashed))
    for name, method in found.items():
        method.__qualname__ = f"{cls.__qualname__}.{name}"
        setattr(cls, name, method)
    if not documented and not cls.__name__.startswith("_"):
        import inspect

        cls.__doc__ = cls.__name__ + str(inspect.signature(cls)).replace(" -> None", "")
    return cls


class _InitWhenAsked:
    """Stands for `__init__`, which is compiled when it is first asked for: most classes that load are never made."""

    def __init__(self, cls: type, fields: tuple[dataclasses.Field[Any], ...]) -> None:
        self.cls, self.fields = cls, fields

    def __get__(self, record: Any, owner: type) -> Any:
        init = _init_of(self.cls, self.fields)
        init.__qualname__ = f"{self.cls.__qualname__}.__init__"
        self.cls.__init__ = init  # type: ignore[misc]
        return init.__get__(record, owner)


def _init_of(cls: type, fields: tuple[dataclasses.Field[Any], ...]) -> Callable[..., None]:
    """`__init__` with the fields as its arguments, in their order, those by keyword alone last."""
    made = _init_text(fields, hasattr(cls, "__post_init__"))
    names: dict[str, Any] = {"_set": _SET, "_fresh": _FACTORY}
    names |= {f"_default_{f.name}": f.default for f in fields}
    names |= {f"_factory_{f.name}": f.default_factory for f in fields}
    exec(made, names)  # of names that Python took for attributes
    init: Callable[..., None] = names["__init__"]
    init.__annotations__ = {f.name: f.type for f in fields if f.init} | {"return": None}
    init.__module__ = cls.__module__
    return init


def _init_text(fields: tuple[dataclasses.Field[Any], ...], post: bool) -> str:
    def declared(f: dataclasses.Field[Any]) -> str:
        if f.default is not dataclasses.MISSING:
            return f"{f.name}=_default_{f.name}"
        return f.name if f.default_factory is dataclasses.MISSING else f"{f.name}=_fresh"

    def given(f: dataclasses.Field[Any]) -> str:
        if f.default_factory is dataclasses.MISSING:
            return f.name if f.init else f"_default_{f.name}"
        fresh = f"_factory_{f.name}()"
        return f"{fresh} if {f.name} is _fresh else {f.name}" if f.init else fresh

    first = [declared(f) for f in fields if f.init and not f.kw_only]
    last = [declared(f) for f in fields if f.init and f.kw_only]
    filled = [f for f in fields if f.init or f.default_factory is not dataclasses.MISSING]
    lines = [f" _set(self, {f.name!r}, {given(f)})" for f in filled]
    lines += [" self.__post_init__()"] if post else []
    arguments = ", ".join(["self", *first, *(["*", *last] if last else [])])
    return f"def __init__({arguments}):\n" + ("\n".join(lines) or " pass")


def _values_of(names: tuple[str, ...]) -> Callable[[Any], Any]:
    """x -> what it holds under these names, comparable and hashable as a tuple of it is."""
    if not names:
        return lambda x: ()
    if len(names) == 1:
        (name,) = names
        return lambda x: (getattr(x, name),)
    return attrgetter(*names)


def _compared_by(values: Callable[[Any], Any]) -> Callable[..., Any]:
    def __eq__(self: Any, other: object) -> Any:
        return values(self) == values(other) if other.__class__ is self.__class__ else NotImplemented

    return __eq__


def _hashed_by(values: Callable[[Any], Any]) -> Callable[[Any], int]:
    def __hash__(self: Any) -> int:
        return hash(values(self))

    return __hash__


def _shown_by(names: list[str]) -> Callable[[Any], str]:
    @recursive_repr()
    def __repr__(self: Any) -> str:
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"

    return __repr__


def _refusing_to_set(cls: type) -> Callable[[Any, str, Any], None]:
    def __setattr__(self: Any, name: str, value: Any) -> None:
        if type(self) is cls or name in cls.__dataclass_fields__:  # type: ignore[attr-defined]
            raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)  # type: ignore[arg-type]

    return __setattr__


def _refusing_to_delete(cls: type) -> Callable[[Any, str], None]:
    def __delattr__(self: Any, name: str) -> None:
        if type(self) is cls or name in cls.__dataclass_fields__:  # type: ignore[attr-defined]
            raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)  # type: ignore[arg-type]

    return __delattr__
