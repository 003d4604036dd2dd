"""The rest of the cycle collector while graphs grow: nothing is looked through at its end, and no ring is lost."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator

import pytest
from derivations import model_called

import eomgen
from eomgen.resources import growing


class Ring:
    """An object that holds itself."""

    alive = 0

    def __init__(self) -> None:
        self.own = self
        Ring.alive += 1

    def __del__(self) -> None:
        Ring.alive -= 1


@pytest.fixture(autouse=True)
def as_python_is_found() -> Iterator[None]:
    """The collector as Python starts it; what the tests themselves have made of it is so again afterwards."""
    frozen, thresholds = gc.get_freeze_count(), gc.get_threshold()
    gc.unfreeze()
    gc.set_threshold(700, 10, 10)
    yield
    gc.set_threshold(*thresholds)
    if frozen:
        gc.freeze()


def test_rings_that_are_dropped_after_rests_do_not_pile_up():
    """Of 400 rests, each of which leaves 100 rings behind, the collector by itself finds nearly all; nobody asks it."""
    Ring.alive = 0
    gc.collect()
    for _ in range(400):
        with growing():
            made = [Ring() for _ in range(100)]
        del made
    assert gc.isenabled() and Ring.alive < 400 * 100 / 4


def test_the_collector_is_left_as_it_was_found():
    """Thresholds, and whether it works, are those of whoever calls: also where it was switched off."""
    for works in (True, False):
        before = gc.get_threshold()
        (gc.enable if works else gc.disable)()
        try:
            eomgen.derive(model_called("arm3"))
            assert gc.isenabled() is works and gc.get_threshold() == before
        finally:
            gc.enable()


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
