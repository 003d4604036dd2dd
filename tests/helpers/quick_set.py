"""Which files of tests the quick set passes over."""

from __future__ import annotations

SLOW = ("\npytestmark = pytest.mark.slow\n", "\npytestmark = [pytest.mark.slow,")


def is_slow(text: str) -> bool:
    """Whether a file of tests says that all of them are slow."""
    return any(mark in text for mark in SLOW)
