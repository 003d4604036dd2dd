"""Which files of tests the quick set passes over, and which model a test is of."""

from __future__ import annotations

from pathlib import Path
from typing import Any

SLOW = ("\npytestmark = pytest.mark.slow\n", "\npytestmark = [pytest.mark.slow,")


def is_slow(text: str) -> bool:
    """Whether a file of tests says that all of them are slow."""
    return any(mark in text for mark in SLOW)


def model_of(item: Any) -> str:
    """The name of the model that a test over many models is asked of; "" where it is of none."""
    given = getattr(getattr(item, "callspec", None), "params", {})
    found = next((given[key] for key in ("name", "path", "equations", "system", "golden") if key in given), "")
    found = getattr(found, "path", found)  # of a formula of a textbook
    return found.stem if isinstance(found, Path) else str(found)
