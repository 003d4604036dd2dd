"""Letters and names: their plain forms, how names are typeset, and the names of a model for which they can stand."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container, Iterable, Mapping
from functools import cached_property

from eomgen.frozen import dataclass
from eomgen.symbolic.expression import spelled

ALIKE = {"−": "-", "–": "-", "·": "*", "⋅": "*", "×": "*", "∙": "*", "÷": "/", "[": "(", "]": ")", "′": "'", "’": "'"}
ALIKE |= {
    "″": "''",
    '"': "''",
    "“": "''",
    "”": "''",
    "≈": "=",
    "≡": "=",
    "ʹ": "'",
    "˙": "'",  # dots that stand behind their letter
    "¨": "''",
    "\u00a0": " ",
}


@dataclass(frozen=True)
class Vocabulary:
    """The names for which those in an equation can stand.

    Args:
        names: of the model, without primes.
        functions: that can be requested of it: speed, T, Q.
        set_as: how names are set in LaTeX, by name.
        derived: names of quantities as derivations set them, {LaTeX: name}; they stand with their whole index alone.
        tables: functions of any formula that the model declares.
    """

    names: frozenset[str]
    functions: frozenset[str]
    set_as: Mapping[str, str]
    derived: Mapping[str, str]
    tables: frozenset[str] = frozenset()

    @cached_property
    def _by_key(self) -> dict[str, str]:
        found: dict[str, str] = {}
        for name in sorted(self.names - {*self.derived.values()}):
            found.setdefault(key(name), name)
        for name, latex in self.set_as.items():
            found.setdefault(key(latex), name)
        return found

    def known(self, letters: str) -> str | None:
        """The model's name for letters with their index, or None."""
        if letters in self.names:
            return letters
        return self._by_key.get(key(letters))

    @cached_property
    def _derived_by_key(self) -> dict[str, str]:
        found: dict[str, str] = {}
        for written, name in self.derived.items():
            found.setdefault(key(written), name)
        return found

    def indexed(self, letters: str, index: str) -> str | None:
        """The name for letters with an index that is written as one: x_{bob}; None where there is none."""
        return self.known(letters + index) or (self._derived_by_key.get(key(letters + index)) if index else None)

    @property
    def rates(self) -> Container[str]:
        """The names with their primes."""
        return frozenset(name + primes for name in self.names for primes in ("'", "''"))

    def cut(self, word: str) -> list[str] | None:
        """A word taken apart into names of the model, the fewest: mgl is m, g, l; None where it cannot be."""
        best: list[list[str] | None] = [[], *([None] * len(word))]
        for end in range(1, len(word) + 1):
            for start in range(end):
                before, name = best[start], self.known(word[start:end])
                if before is not None and name is not None and not word[start].isdigit():
                    now = best[end]
                    if word[end - 1] != "_" and (now is None or len(before) + 1 < len(now)):
                        best[end] = [*before, name]
        return best[-1]


def key(letters: str) -> str:
    """The part of a name that is compared: its letters and digits, Greek ones by their names."""
    plain = re.sub(r"\\(?:mathrm|mathit|text|mathbf|mathsf|mathcal|left|right)\b", "", letters)
    return "".join(spelled(c) or c for c in plain if c.isalnum()).replace("varphi", "phi").replace("vartheta", "theta")


def plain_forms(written: str) -> tuple[str, list[int]]:
    """The characters in their plain forms, dots behind their letters; and where each was written."""
    found, places = "", list[int]()
    for at, c in enumerate(written):
        plain = ALIKE.get(c) or _fraction(c) or unicodedata.normalize("NFD", c)
        found += plain
        places += [at] * len(plain)
    return found, places or [0]


def _fraction(c: str) -> str:
    """⅙ as (1/6), "" of others."""
    above, slash, below = unicodedata.normalize("NFKD", c).partition("\u2044")
    return f"({above}/{below})" if slash and above and below else ""


def spelled_command(command: str) -> str:
    """A Greek letter's command by its name (\\varphi is phi), "" of others."""
    bare = command.removeprefix("var") if command.startswith("var") else command
    try:
        kind = "CAPITAL" if bare[:1].isupper() else "SMALL"
        name = {"lambda": "LAMDA", "Lambda": "LAMDA"}.get(bare, bare.upper())
        unicodedata.lookup(f"GREEK {kind} LETTER {name}")
    except KeyError:
        return ""
    return bare


def vocabulary(
    names: Iterable[str],
    functions: Iterable[str],
    set_as: Mapping[str, str],
    derived: Mapping[str, str] | None = None,
    tables: Iterable[str] = (),
) -> Vocabulary:
    """Names without their primes, functions, how names are set, and how derivations set their quantities."""
    derived = derived or {}
    bare = frozenset(name.rstrip("'") for name in (*names, *derived.values()))
    set_derived = {x: name.rstrip("'") for x, name in derived.items()}
    return Vocabulary(bare, frozenset((*functions, *tables)), set_as, set_derived, frozenset(tables))
