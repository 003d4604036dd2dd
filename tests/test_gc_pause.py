"""The rest of the cycle collector while graphs grow: nothing is looked through at its end, and no ring is lost."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator

import pytest

from eomgen.symbolic.numeric.gc_pause import growing


class Ring:
    """An object that holds itself."""

    def __init__(self) -> None:
        self.own = self


@pytest.fixture(autouse=True)
def none_kept_apart() -> Iterator[None]:
    """What the tests themselves have frozen is so again afterwards."""
    frozen = gc.get_freeze_count()
    gc.unfreeze()
    yield
    if frozen:
        gc.freeze()


def test_what_was_made_in_a_rest_is_not_looked_through_at_its_end():
    """Of twice as many objects as make Python look none is looked at within, or when the next is made."""
    seen: list[int] = []

    def look(phase: str, info: dict[str, int]) -> None:
        seen.append(info["generation"])

    gc.collect()
    gc.callbacks.append(look)
    try:
        with growing():
            made = [[k] for k in range(2 * gc.get_threshold()[0])]
        more = [[made]]
    finally:
        gc.callbacks.remove(look)
    assert gc.isenabled() and not seen and more


def test_rests_that_overlap_end_with_the_last():
    """Of two that begin and end crosswise, as those of threads do, the collector works again behind both."""
    one, other = growing(), growing()
    one.__enter__()
    other.__enter__()
    one.__exit__(None, None, None)
    assert not gc.isenabled()
    other.__exit__(None, None, None)
    assert gc.isenabled()


def test_a_ring_that_is_left_behind_is_found_by_the_next_full_look():
    with growing():
        ring = weakref.ref(Ring())
    assert ring() is not None
    gc.collect()
    assert ring() is None


def test_what_somebody_keeps_apart_stays_apart():
    """gc.freeze() before a rest: as many objects are frozen after it."""
    gc.freeze()
    try:
        frozen = gc.get_freeze_count()
        with growing():
            made = [[k] for k in range(1000)]
        assert frozen - 100 < gc.get_freeze_count() <= frozen and made
    finally:
        gc.unfreeze()
