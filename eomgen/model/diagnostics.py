"""Problems of a model: what is wrong, where in it, and in which words."""

from collections.abc import Iterable, Mapping
from dataclasses import field
from difflib import get_close_matches
from itertools import islice
from typing import Any

from eomgen.frozen import dataclass
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import other_words


class Decimal(str):
    """A decimal of the file as it was written (tomllib's `parse_float`): a number, exact."""

    __slots__ = ()


@dataclass(frozen=True)
class Diagnostic:
    """One thing wrong, at a path into the model.

    Args:
        path: keys and indices that lead to the culprit.
        what: what is wrong, the culprit printed.
        fix: the nearest right thing, or "".
        column, length: the culprit within the text of an expression (None: all of it).
        key: the culprit is the key itself, not its value.
        raw: what could not be read (names in it count as used).
        instead: of a key, the one for which it was read.
        beside: column and length of a second culprit in the same text.
    """

    path: DocumentPath
    what: str
    fix: str = ""
    column: int | None = None
    length: int | None = None
    key: bool = False
    raw: Any = field(default=None, compare=False, repr=False)
    instead: str = ""
    beside: tuple[int, int] | None = None


LONGEST_WORD, MOST_WORDS = 40, 1000  # beyond them nothing is compared: a hostile file must not cost minutes
MOST_OFFERS = 50


def nearest(word: str, known: Iterable[str]) -> str:
    """ "did you mean 'forearm'?", or "" where nothing is near."""
    found = meant(word, known)
    if len(found) > 1:
        return f"one of {', '.join(found)}"
    return f"did you mean '{found[0]}'?" if found else ""


def meant(word: str, known: Iterable[str]) -> tuple[str, ...]:
    """The names that a word may stand for: what it is called here, else what is nearest."""
    words = [] if len(word) > LONGEST_WORD else sorted(islice(known, MOST_WORDS))
    close = get_close_matches(word, words, n=1, cutoff=0.6)
    return other_words(word, words) or tuple(close or [name for name in words if name.lower() == word.lower()][:1])


def article(kind: str) -> str:
    """ "a rate", "an input"; time and a constant have none."""
    if kind in ("time", "constant"):
        return kind
    return f"an {kind}" if kind[0] in "aiou" else f"a {kind}"


def shown(raw: Any) -> str:
    """A value of the file in a message."""
    if isinstance(raw, Mapping):
        return "a table"
    if isinstance(raw, (list, tuple)):
        return "a list"
    if isinstance(raw, bool):
        return str(raw).lower()
    text = str(raw)
    text = text if len(text) <= 60 else text[:57] + "..."
    return f"'{text}'" if isinstance(raw, str) and not isinstance(raw, Decimal) else text


TABLES = {
    "parameters": "parameter",
    "coordinates": "coordinate",
    "speeds": "speed",
    "states": "state",
    "tables": "table",
    "inputs": "input",
    "points": "point",
    "bodies": "body",
    "constraints": "constraint",
    "trusses": "truss",
    "forces": "force",
    "outputs": "output",
    "unknowns": "unknown",
}
"""The tables of a model that name things, and what one of those is called."""


def one_of(table: str) -> str:
    """A thing that a table names, with its article: "an input"."""
    return f"{'an' if TABLES[table][0] in 'aeiou' else 'a'} {TABLES[table]}"


def whereabouts(path: DocumentPath, what: str = "") -> str:
    """A part in words: "the joint of body 'hand'", "parameter 'm'"."""
    if len(path) < 2 or path[0] not in TABLES:
        return f"[{path[0]}]" if path else what or "the model"
    owner = f"{TABLES[str(path[0])]} '{path[1]}'"
    inner = [str(key) for key in path[2:] if isinstance(key, str)]
    if inner[:1] == ["points"] and path[0] == "bodies" and len(inner) > 1:
        return f"point '{inner[1]}' of {owner}"
    return " of ".join([*(f"the {key}" for key in reversed(inner)), owner])


def unknown_keys(
    raw: Mapping[str, Any],
    known: Iterable[str],
    path: DocumentPath,
    found: list[Diagnostic],
    what: str,
    *,
    needed: Iterable[str] = (),
) -> dict[str, str]:
    """Reports every key of a table that nobody reads; {key that one may have meant and is missing: the key}.

    Where a single key is strange, and a single one of those that are needed is missing, the one was meant by the other.
    """
    strange = [key for key in raw if key not in known]
    missing = [key for key in needed if key not in raw]
    only = missing[0] if len(strange) == len(missing) == 1 else ""
    read: dict[str, str] = {}
    listed = ", ".join(f"'{name}'" for name in known)
    for k, key in enumerate(strange):
        fix = (nearest(str(key), known) or f"known here: {listed}") if k < MOST_OFFERS else ""
        if 0 < len(path) < 3 and key in TABLES and key != "points":
            fix = f"it is of the whole model: give it its own header, [{key}], or write it above the first header"
        guess = meant(str(key), known)[:1] if k < MOST_OFFERS else ()
        if only and not guess:
            fix, guess = f"write '{only}': it is needed here ({fix})", (only,)
        instead = guess[0] if guess and guess[0] not in (*raw, *read) else ""
        read |= {instead: key} if instead else {}
        wrong = f"unknown key '{key}' in {what}"
        found.append(Diagnostic((*path, key), wrong, fix, key=True, raw=raw[key], instead=instead))
    return read
