"""Words of documents in other languages, by catalogues that a person can add: `languages/de.po`, in gettext's form.

A msgid is a whole sentence, or a part between commas, in which {1}, {2} stand for formulas, names and numbers: these
are put into the translation, translated themselves where they can be. A sentence without a translation stays as it is.

Source: GNU gettext manual, "The Format of PO Files".
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache, cached_property
from importlib import resources
from itertools import islice, starmap, zip_longest
from pathlib import Path
from typing import Any, TypeVar

from eomgen.documents.statements import (
    Cell,
    Formula,
    Found,
    Grid,
    Head,
    Law,
    Listing,
    Meaning,
    Piece,
    Prose,
    Side,
    Statement,
    Step,
    Table,
)
from eomgen.errors import UsageError
from eomgen.frozen import dataclass
from eomgen.model import Table as Entries
from eomgen.model import nearest

FIRST_PIECE = 0xE000  # private characters stand for the formulas of a sentence while its words are looked up
PLACE = re.compile(r"\{(\d)\}")
_WORDS = re.compile(r"\\text\{\(([^{}()]*)\)\}")
_IN_BRACKETS = re.compile(r"\(([^()]*)\)")
_PIECE = re.compile(r"[\ue000-\uf8ff]")
SIGNS = tuple(map(re.compile, (r"(?<=[.!?])( )(?=[^a-z])", "(; )", "(: )", "(, )(?![^()]*\\))")))
"""Signs at which a text is parted: between sentences, then between clauses; a comma in brackets parts nothing."""
TRIED = 8  # patterns that fit
_DECIMAL = re.compile(r"(?<![\w.,])(\d+)\.(\d+)(?![\w.]*\.\d)(?!\w)")
_ENTRY = re.compile(r'^(msgid|msgstr) ("(?:[^"\\]|\\.)*"(?:\n"(?:[^"\\]|\\.)*")*)', re.M)
_QUOTED = re.compile(r'"((?:[^"\\]|\\.)*)"')
_ESCAPED = re.compile(r"\\(.)")
Said = TypeVar("Said", bound=Statement)


@dataclass(frozen=True)
class Pattern:
    """A msgid with places.

    Args:
        form: matches the whole of what it is for.
        chunk: its longest literal part, which is looked for first.
        places: the number of each place in order.
        words: its translation.
    """

    form: re.Pattern[str]
    chunk: str
    places: tuple[int, ...]
    words: str

    @staticmethod
    def of(msgid: str, words: str) -> Pattern:
        """The pattern of an entry with places."""
        literal = PLACE.split(msgid)
        form = "".join(re.escape(part) if k % 2 == 0 else "(.+?)" for k, part in enumerate(literal))
        places = tuple(map(int, literal[1::2]))
        return Pattern(re.compile(form, re.DOTALL), max(literal[::2], key=len), places, words)

    @property
    def weight(self) -> int:
        """Number of its literal characters: of several that fit the most exact one counts."""
        return len(self.form.pattern) - 5 * len(self.places)


@dataclass(frozen=True)
class Catalogue:
    """The words of a language.

    Args:
        language: "de", "fr"; "en" for our own words.
        messages: {our words: theirs}.
        comma: numbers have a decimal comma.
    """

    language: str = "en"
    messages: Mapping[str, str] = Entries()
    comma: bool = False

    @cached_property
    def _patterns(self) -> tuple[Pattern, ...]:
        """The entries with places, the most exact one first."""
        found = (Pattern.of(msgid, words) for msgid, words in self.messages.items() if PLACE.search(msgid))
        return tuple(sorted(found, key=lambda each: -each.weight))

    @cached_property
    def _known(self) -> dict[str, tuple[str, int]]:
        return {}

    def beside(self, texts: Iterable[str]) -> Catalogue:
        """The catalogue for a document with words of a user's own, which stay as they are."""
        own = {text: text for text in texts if text}
        return replace(self, messages={**self.messages, **own}) if self.messages else self

    def say(self, text: str) -> str:
        """A text in the language; what has no translation stays as it is."""
        return self._best(text)[0] if self.messages and text else text

    def untranslated(self, text: str) -> int:
        """Number of letters of a text that stay in our language."""
        return self._best(text)[1]

    def number(self, text: str) -> str:
        """A text with the decimal sign of the language."""
        return _DECIMAL.sub(r"\1,\2", text) if self.comma else text

    def _best(self, text: str) -> tuple[str, int]:
        """(a text in the language, the letters of it that stay in ours): as a whole, or in parts, where that leaves
        fewer."""
        bare = text.strip()
        if bare != text:
            found, left = self._best(bare) if bare else ("", 0)
            return text.replace(bare, found) if bare else text, left
        if text not in self._known:
            whole = self.messages.get(text)
            tried = [(whole, 0)] if whole is not None else [*self._in_parts(text), *self._by_patterns(text)]
            tried.append((self.number(text), sum(map(str.isalpha, _PIECE.sub("", text)))))
            self._known[text] = min(tried, key=lambda each: each[1])  # the first of those that leave as few
        return self._known[text]

    def _by_patterns(self, text: str) -> Iterator[tuple[str, int]]:
        fitting = ((each, each.form.fullmatch(text)) for each in self._patterns if each.chunk in text)
        for pattern, match in islice(((each, match) for each, match in fitting if match is not None), TRIED):
            inside = {place: self._best(part) for place, part in zip(pattern.places, match.groups(), strict=True)}
            words = PLACE.sub(lambda found, inside=inside: inside[int(found[1])][0], pattern.words)  # type: ignore[misc]
            yield words, sum(left for _, left in inside.values())

    def _in_parts(self, text: str) -> Iterator[tuple[str, int]]:
        """A text by its sentences, else by the parts between its signs, the strongest ones first."""
        for signs in SIGNS:
            parts = signs.split(text)
            if len(parts) > 1:
                found = list(starmap(self._part, zip_longest(parts[::2], parts[1::2], fillvalue="")))
                yield "".join(words for words, _ in found), sum(left for _, left in found)
                return

    def _part(self, words: str, sign: str) -> tuple[str, int]:
        """A part of a sentence with the sign behind it; an entry may hold the sign."""
        if sign and (found := self.messages.get(words + sign.strip())):
            return f"{found} ", 0
        said, left = self._best(words)
        return said + sign, left

    # -- elements of documents ---------------------------------------------------------------------

    def step(self, step: Step) -> Step:
        """A step with its title and statements in the language."""
        statements = tuple(map(self.statement, step.statements))
        return replace(step, title=self.say(step.title), statements=statements)

    def statement(self, statement: Said) -> Said:
        """A statement in the language; listings are typeset before."""
        found: Any = statement
        if isinstance(statement, Prose):
            found = self.prose(statement)
        elif isinstance(statement, Table):
            symbol, meaning, unit, value = map(self.head, statement.head)
            found = Table((symbol, meaning, unit, value), tuple(map(self._meaning, statement.rows)))
        elif isinstance(statement, Grid):
            rows = (tuple(map(self._cell, row)) for row in statement.rows)
            heads = tuple(self.head(head) if isinstance(head, str) else head for head in statement.head)
            found = Grid(heads, tuple(rows))
        elif isinstance(statement, Formula):
            found = Formula(tuple(map(self._side, statement.sides)))
        elif isinstance(statement, Listing):
            found = Listing(tuple(map(self._found_row, statement.rows)))
        return found  # type: ignore[no-any-return]

    def head(self, head: str) -> str:
        """The head of a column."""
        if not self.messages or not head:
            return head
        made = Head(self.say(head))
        made.key = head
        return made

    def _side(self, side: Side) -> Side:
        """A side of a formula, with the words that stand in it: 3*3 (bodies)."""
        if not isinstance(side, Law):
            return side
        words = {word: self.say(word) for word in _WORDS.findall(side.latex)}
        text = _IN_BRACKETS.sub(lambda found: f"({words.get(found[1], found[1])})", side.text)
        return Law(text, _WORDS.sub(lambda found: rf"\text{{({words[found[1]]})}}", side.latex))

    def _cell(self, cell: Cell) -> Cell:
        return self.say(cell) if isinstance(cell, str) else cell

    def _meaning(self, row: Meaning) -> Meaning:
        return replace(row, meaning=self.say(row.meaning), value=self.say(row.value))

    def _found_row(self, row: Found) -> Found:
        quantity = row.quantity
        message = None if quantity.message is None else self.say(quantity.message)
        said = replace(quantity, method=self.say(quantity.method), message=message)
        return replace(row, words=self.say(row.words), quantity=said)

    def prose(self, sentence: Prose) -> Prose:
        """A sentence in the language, its formulas where the language has them."""
        others = [piece for piece in sentence.pieces if not isinstance(piece, str)]
        number = iter(range(FIRST_PIECE, FIRST_PIECE + len(others)))
        text = "".join(piece if isinstance(piece, str) else chr(next(number)) for piece in sentence.pieces)
        return Prose(tuple(self._pieces(self.say(text), others)))

    def _pieces(self, text: str, others: list[Any]) -> Iterator[Piece]:
        end = 0
        for found in _PIECE.finditer(text):
            if found.start() > end:
                yield text[end : found.start()]
            yield others[ord(found[0]) - FIRST_PIECE]
            end = found.end()
        if end < len(text):
            yield text[end:]


OURS = Catalogue()


def languages() -> tuple[str, ...]:
    """The languages that there are, English first."""
    folder = resources.files("eomgen.documents").joinpath("languages")
    return ("en", *sorted(path.name.removesuffix(".po") for path in folder.iterdir() if path.name.endswith(".po")))


@cache
def catalogue(language: str) -> Catalogue:
    """The catalogue of a language, by its name or by the path of a file .po.

    Raises:
        UsageError: there is none.
    """
    if language in ("", "en"):
        return OURS
    if language.endswith(".po") and Path(language).is_file():
        return read_catalogue(Path(language).read_text("utf-8"), Path(language).stem)
    if language not in languages():
        fix = nearest(language, languages()) or f"there are {', '.join(languages())}; or give a file .po of your own"
        raise UsageError(f"there are no words in the language '{language}'", fix=fix)
    text = resources.files("eomgen.documents").joinpath("languages", f"{language}.po").read_text("utf-8")
    return read_catalogue(text, language)


def read_catalogue(text: str, language: str) -> Catalogue:
    """The catalogue that a file of gettext holds; its first entry says whether numbers have a comma: X-Decimal."""
    entries = [(kind, _unquoted(words)) for kind, words in _ENTRY.findall(text)]
    pairs = {msgid: words for (_, msgid), (_, words) in zip(entries[::2], entries[1::2], strict=True)}
    head = pairs.pop("", "")
    messages = {msgid: words for msgid, words in pairs.items() if words}
    return Catalogue(language, messages, comma="X-Decimal: ," in head)


def _unquoted(words: str) -> str:
    inside = "".join(_QUOTED.findall(words))
    return _ESCAPED.sub(lambda found: {"n": "\n", "t": "\t"}.get(found[1], found[1]), inside)
