"""`-m "not slow"`: the quick tests. What is slow as a whole says so in its file, which is then not even read."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

os.environ.setdefault("EOMGEN_PATIENCE", "none")  # no test hangs on how busy the machine is
os.environ.setdefault("EOMGEN_FRESH", "1")  # tests patch laws: nothing is told again that was derived without them

ZERO = b"\0after"

SLOW = ("\npytestmark = pytest.mark.slow\n", "\npytestmark = [pytest.mark.slow,")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Whether a file of slow tests can be passed over: most of the quick set's time would be their collection."""
    if config.getoption("markexpr") != "not slow" or collection_path.suffix != ".py":
        return None
    text = collection_path.read_text(encoding="utf-8")
    return True if any(mark in text for mark in SLOW) else None


@pytest.fixture(autouse=True)
def zero_stays_zero():
    """A library that writes over b"\\0" breaks files of bytes that other tests write, far from the cause."""
    yield
    assert ZERO[:1][0] == 0, "the interpreter's own b'\\0' was written over: text of one character given to Fraction?"
