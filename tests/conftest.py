"""`-m "not slow"`: the quick tests. What is slow as a whole says so in its file, which is then not even read."""

from __future__ import annotations

import gc
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: its threads wait for one another, and burn a core

import shutil
import sys
import warnings
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

import pytest
from hypothesis import settings
from hypothesis.internal.conjecture import providers
from quick_set import is_slow, model_of
from slow_run import left_out

from eomgen.resources import SELDOM

os.environ.setdefault("EOMGEN_PATIENCE", "none")  # no test hangs on how busy the machine is
if shutil.which("cc"):  # a third of all tests' time went into optimizing what runs for milliseconds
    os.environ.setdefault("CC", "cc -O0")
os.environ.setdefault("EOMGEN_FRESH", "1")  # tests patch laws: nothing is told again that was derived without them

gc.set_threshold(*SELDOM)

settings.register_profile(
    "fixed", derandomize=True, deadline=None
)  # a drawn formula that sympy needs minutes for came once
settings.load_profile("fixed")

with suppress(AttributeError):  # it would parse all modules of ours, for half a minute, to draw their constants
    providers._get_local_constants = lambda: providers._local_constants  # type: ignore[attr-defined]

COLLECTED = ("test_gc_pause.py", "test_public_values.py")
ZERO = b"\0after"


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Whether a file of slow tests can be passed over: most of the quick set's time would be their collection."""
    if config.getoption("markexpr") != "not slow" or collection_path.suffix != ".py":
        return None
    return True if is_slow(collection_path.read_text(encoding="utf-8")) else None


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """What is asked of one model by several files stands together, first: one process derives it, and once.

    Tests that import jax come last, in each worker too: its threads hold locks that a forked process waits for.
    Tests of the garbage collector come first: what others keep would be looked at by it again and again.
    Of laws that are sampled the usual run asks a part of the cases, where no case is named.
    """
    if not any("::" in each for each in config.args) and (left := left_out(items)):
        config.hook.pytest_deselected(items=left)
        gone = set(map(id, left))
        items[:] = [item for item in items if id(item) not in gone]
    items.sort(key=lambda item: (1, "") if item.get_closest_marker("by_model") is None else (0, model_of(item)))
    items.sort(key=lambda item: "jax" in item.name)
    items.sort(key=lambda item: item.path.name not in COLLECTED)


def pytest_collection_finish() -> None:
    """What is there before the first test stays: a garbage collection need not look at it again and again."""
    gc.freeze()


@pytest.hookimpl(hookwrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """A quick test compiles nothing, in its fixtures neither: what goes to a compiler, or to its cache, is slow."""
    with pytest.MonkeyPatch.context() as patch:
        if item.get_closest_marker("slow") is None:
            patch.setattr("eomgen.codegen.build._compiled_file", _compiled_in_a_quick_test)
        if hasattr(os, "fork"):
            patch.setattr(os, "fork", _forked_without_threads)
        yield


_fork = getattr(os, "fork", None)


def _forked_without_threads() -> int:
    """As os.fork, in a process without the threads of jax: beside them the child may wait for a lock for ever."""
    if "jax" in sys.modules:
        warnings.warn("forked where jax was imported: name the test that imports it '...jax...'", stacklevel=2)
    assert _fork is not None
    return _fork()


def _compiled_in_a_quick_test(*_: object) -> NoReturn:
    pytest.fail("a quick test compiles nothing: mark it slow, or ask for numpy", pytrace=False)


@pytest.fixture(autouse=True)
def zero_stays_zero():
    """A library that writes over b"\\0" breaks files of bytes that other tests write, far from the cause."""
    yield
    assert ZERO[:1][0] == 0, "the interpreter's own b'\\0' was written over: text of one character given to Fraction?"
