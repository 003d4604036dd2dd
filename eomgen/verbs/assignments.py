"""What a user assigns on the command line: NAME=VALUE, and the nearest right thing to a name that is wrong."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from eomgen.errors import UsageError
from eomgen.verbs.outcome import listed


def assignments(given: Iterable[str], example: str) -> list[tuple[str, str]]:
    """(name, text) of each NAME=VALUE.

    Raises:
        UsageError: a word that is no assignment; `example` is its mend.
    """
    pairs = []
    for word in given:
        name, sign, text = word.partition("=")
        if not sign or not name.strip() or not text.strip():
            raise UsageError(f"'{word}' is no assignment", mend=f"write {example}")
        pairs.append((name.strip(), text.strip()))
    return pairs


def nearest_name(name: str, names: Iterable[str]) -> str:
    """The name that was probably meant, or all that there are."""
    names = list(names)
    near = difflib.get_close_matches(name, names, n=1)
    return f"did you mean '{near[0]}'?" if near else f"there are {listed(names)}"
