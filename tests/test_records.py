"""eomgen.frozen: frozen classes are those of the standard library, in all that a user of one sees."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from dataclasses import field, replace
from functools import cached_property
from typing import Any, ClassVar

import pytest

from eomgen.frozen import dataclass


def _declared(maker: Any) -> tuple[type, ...]:
    """The same classes by one maker and by the other."""

    @maker(frozen=True)
    class Plain:
        """With words."""

        a: int
        b: tuple[int, ...] = ()
        c: dict[str, int] = field(default_factory=dict, compare=False, repr=False)
        of_all: ClassVar[int] = 3

        @cached_property
        def twice(self) -> int:
            return 2 * self.a

    @maker(frozen=True)
    class Derived(Plain):
        b: tuple[int, ...] = (7,)
        d: float = 0.5

    @maker(frozen=True, kw_only=True)
    class Named:
        first: str
        second: str = "second"
        later: int = field(default=4, init=False)
        unseen: int = field(default=0, hash=False)

    @maker(frozen=True, repr=False)
    class Own:
        """Own methods stay."""

        value: int

        def __post_init__(self) -> None:
            if self.value < 0:
                raise ValueError("negative")

        def __eq__(self, other: object) -> bool:
            return isinstance(other, type(self)) and abs(self.value) % 2 == abs(other.value) % 2

        def __hash__(self) -> int:
            return self.value % 2

    @maker(frozen=True, eq=False)
    class Alone:
        value: int

    @maker(frozen=True)
    class Empty:
        pass

    return Plain, Derived, Named, Own, Alone, Empty


OURS, THEIRS = _declared(dataclass), _declared(dataclasses.dataclass)
CALLS: tuple[tuple[tuple[Any, ...], dict[str, Any]], ...] = (
    ((), {}),
    ((1,), {}),
    ((2,), {"b": (1, 2)}),
    ((1, (), {"x": 1}), {}),
    ((1,), {"b": (), "d": 0.25}),
    ((1, 2, 3, 4, 5), {}),
    ((), {"first": "x"}),
    ((), {"first": "x", "unseen": 3}),
    ((-1,), {}),
    ((3,), {}),
    (([],), {}),
)


def _outcome(of: Any, *args: Any, **named: Any) -> Any:
    """What comes of it: the value, or the error in words."""
    try:
        return of(*args, **named)
    except Exception as error:
        return type(error), str(error)


@pytest.mark.parametrize(("ours", "theirs"), list(zip(OURS, THEIRS, strict=True)), ids=[c.__name__ for c in OURS])
def test_a_record_is_what_the_standard_library_makes_of_its_class(ours, theirs):
    """Signature, fields, what it shows and its hash, x == y, and each refusal, over the same calls."""
    assert str(inspect.signature(ours)) == str(inspect.signature(theirs))
    assert ours.__doc__ == theirs.__doc__
    assert ours.__match_args__ == theirs.__match_args__
    assert [f.name for f in dataclasses.fields(ours)] == [f.name for f in dataclasses.fields(theirs)]
    pairs = []
    for args, named in CALLS:
        x, y = _outcome(ours, *args, **named), _outcome(theirs, *args, **named)
        if not isinstance(x, ours):
            assert x == y
            continue
        pairs.append((x, y))
        for seen in (
            lambda z: z.__class__.__eq__ is object.__eq__ or hash(z),
            lambda z: None if z.__class__.__repr__ is object.__repr__ else repr(z),
            dataclasses.asdict,
            lambda z: vars(copy.copy(z)),
            lambda z: vars(replace(z)),
            lambda z: setattr(z, "a", 1),
            lambda z: setattr(z, "another", 1),
            lambda z: delattr(z, "value"),
        ):
            assert _outcome(seen, x) == _outcome(seen, y)
    assert pairs
    for x, y in pairs:
        assert [x == other for other, _ in pairs] == [y == other for _, other in pairs]
        assert x != y


def test_what_a_record_computes_once_is_kept_in_it():
    """cached_property writes past the refusal, as with the standard library's."""
    x = OURS[0](21)
    assert x.twice == 42 and vars(x)["twice"] == 42


@dataclass(frozen=True)
class Sent:
    """Of a module, so that it goes to another process."""

    a: int
    inside: tuple[Sent, ...] = ()


def test_a_record_goes_to_another_process():
    x = Sent(1, (Sent(2),))
    assert pickle.loads(pickle.dumps(x)) == x
    assert repr(x) == "Sent(a=1, inside=(Sent(a=2, inside=()),))"
