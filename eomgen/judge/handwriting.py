"""An equation as people write and paste it -> the text of the grammar: LaTeX, Unicode, products without a sign.

The text becomes a list of pieces, each with its place in what was written; between two values that stand side by side
comes `*`. What a letter stands for is looked up among the names that the model knows: `mgl` is m*g*l where these are
three of them, and `m_{\\mathrm{max}}` is `m_max` or `mmax`, whichever there is. Nothing is evaluated here.
"""

from __future__ import annotations

import re
import unicodedata
from contextlib import suppress

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.judge.alphabet import Vocabulary, plain_forms, spelled_command
from eomgen.model import Unit
from eomgen.symbolic.expression import NAMES, SLOPE, called_rate, meant_name, spelled

RATE = "rate_of"  # d/dt of what stands in parentheses
DEEPEST = 64  # groups inside one another, as of the grammar
LONGEST = 20_000  # characters: LaTeX is longer than what it says
_FUNCTIONS = {**{name: name for name in NAMES}, "arcsin": "asin", "arccos": "acos", "arctan": "atan", "ln": "log"}
_FUNCTIONS |= {"sgn": "sign", "Abs": "abs"}
_NOTHING = frozenset(
    "left right big Big bigg Bigg bigl bigr Bigl Bigr biggl biggr displaystyle textstyle quad qquad limits nonumber "
    "mathstrut ! , ; : > ".split()
)
_WRAPS = frozenset("mathrm text mathit mathbf textrm textit boldsymbol mbox mathsf mathcal operatorname bm".split())
_FRACTIONS = ("frac", "dfrac", "tfrac", "cfrac")
_SIGNS = {"cdot": "*", "times": "*", "ast": "*", "div": "/", "approx": "=", "equiv": "=", "lbrace": "(", "rbrace": ")"}
_SIGNS |= {"{": "(", "}": ")", "lvert": "|", "rvert": "|", "vert": "|", "lbrack": "(", "rbrack": ")"}
_RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789", strict=True))
_STATEMENTS = dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True))
_DOTS = {"\u0307": 1, "\u0308": 2}
_ACCENTS = {"dot": 1, "ddot": 2}
_DECORATIONS = frozenset("hat bar tilde vec overline widehat".split())
_NUMBER = re.compile(r"(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")
_WORD = re.compile(r"[^\W\d_⁰¹²³⁴-⁹₀-₉][^\W⁰¹²³⁴-⁹₀-₉]*(?:\.\w+)*")
_PIECE = re.compile(r"[^\W\d_⁰¹²³⁴-⁹₀-₉]")
_DIFFERENTIAL = re.compile(
    r"\s*(?:\\(?:mathrm|text|operatorname)\s*(?:\{\s*d\s*\}|d)|d)\s*(?:\^\s*\{?\s*(\d)\s*\}?)?\s*(.*)", re.S
)
_BY_TIME = re.compile(r"\s*(?:\\(?:mathrm|text)\s*(?:\{\s*d\s*\}|d)|d)\s*t\s*(?:\^\s*\{?\s*(\d)\s*\}?)?\s*")
_PLAIN_RATE = re.compile(r"d\s*/\s*dt\s*(?=[(\[{]|[d∂][TVL]\b)")
_D = r"(?:d|∂|\\partial(?![A-Za-z])|\\(?:mathrm|text|operatorname)\s*(?:\{\s*d\s*\}|d))\s*"
_OF_ENERGY = re.compile(_D + r"([TVL](?:\s*\(\s*[\w.]+\s*\))?)\s*")
_PLAIN_SLOPE = re.compile(_OF_ENERGY.pattern + "/" + r"\s*(?=" + _D + ")")
_BY = re.compile(_D)
_A_SLOPE = re.compile(r"\s*\\[dtc]?frac\s*\{\s*" + _OF_ENERGY.pattern + r"\}")
_E_TO_THE = re.compile(r"(?:e|\\(?:mathrm|text|operatorname)\s*\{\s*e\s*\})\s*\^")
_TIME_BEHIND = re.compile(r"(?:\s|\\[,;:! ])*t(?![A-Za-z'])")
_WHOLE = re.compile(r"\s*(?:\\(?:left|[bB]igg?l?)\s*)?[(\[{]|\s*\\left\s*\\lbrace")
_UNIT = re.compile(r"\s*([A-Za-zµ]+)(?![\w(])")
_INDEX_GROUP = re.compile(r"\{([^{}]*)\}")
_OF_TIME = re.compile(r"\s*\{?\s*(?:\\left)?\s*\(\s*t\s*(?:\\right)?\s*\)\s*\}?")
_OPENED = re.compile(r"\s*(?:\\left\s*)?\(")
_REFERENCES = re.compile(r"\(\s*[\w.]+(?:\s*[,-]\s*[\w.]+)*\s*\)")
_ORNAMENT = re.compile(
    r"\$\$?|\\\[|\\\]|\\\(|\\\)|\\(?:begin|end)\s*\{(?:equation|align|aligned|gather|split)\*?\}|(?<!\\)&|\\\\\s*$"
)


@dataclass(frozen=True)
class Scrap:
    """A piece of the equation: its text, what it is, and where it stands in what was written."""

    text: str
    kind: str  # "number" "name" "function" "call" "sign" "open" "close"
    at: int


@dataclass(frozen=True)
class Transcript:
    """The text of the grammar, and of each of its characters where it was written."""

    text: str
    columns: tuple[int, ...]

    def column(self, at: int) -> int:
        """Column, in the given text, of a character of the transcript."""
        return self.columns[min(at, len(self.columns) - 1)] if self.columns else 0


def transcript(written: str, known: Vocabulary) -> Transcript:
    """The text of somebody in the grammar of the model file.

    Raises:
        ExpressionError: it cannot be read; column and length say where.
    """
    if len(written) > LONGEST:
        raise ExpressionError(f"the equation is longer than {LONGEST} characters", LONGEST)
    plain, places = plain_forms(written)
    pieces = _Reader(plain, known).whole()
    text, columns = "", list[int]()
    before: Scrap | None = None
    for piece in pieces:
        glue = "*" if before is not None and _side_by_side(before, piece) else ""
        shown = (
            f" {piece.text} " if piece.text in ("=", "+") or (piece.text == "-" and before is not None) else piece.text
        )
        text += glue + shown
        columns += [places[min(piece.at, len(places) - 1)]] * (len(glue) + len(shown))
        if before is not None and before.kind == piece.kind == "number" and glue:
            what = f"two numbers side by side: {before.text} {piece.text}"
            raise ExpressionError(what, columns[-1], f"write {before.text}*{piece.text}", len(piece.text))
        before = piece
    return Transcript(text, tuple(columns))


def _side_by_side(a: Scrap, b: Scrap) -> bool:
    """True if a product is meant between the two."""
    return a.kind in ("number", "name", "call", "close") and b.kind in ("number", "name", "call", "function", "open")


class _Reader:
    """One pass over the text; `at` is where it stands."""

    def __init__(self, text: str, known: Vocabulary, start: int = 0, depth: int = 0) -> None:
        self.text, self.known, self.offset, self.at, self.depth = text, known, start, 0, depth
        self.out: list[Scrap] = []
        if depth > DEEPEST:
            raise ExpressionError(f"more than {DEEPEST} levels inside one another", start)

    def whole(self) -> list[Scrap]:
        while self.at < len(self.text):
            self.next()
        return self.out

    # -- pieces --------------------------------------------------------------------------------------

    def put(self, text: str, kind: str, at: int | None = None) -> None:
        self.out.append(Scrap(text, kind, self.offset + (self.at if at is None else at)))

    def next(self) -> None:
        ornament = _ORNAMENT.match(self.text, self.at)
        if ornament:
            self.at = ornament.end()
            return
        c = self.text[self.at]
        if c.isspace() or c == "~":
            self.at += 1
        elif (power := _E_TO_THE.match(self.text, self.at)) and self.known.known("e") is None:
            self.exponential(power.end())
        elif c == "\\":
            self.command()
        elif found := _NUMBER.match(self.text, self.at):
            self.number(found.group())
        elif (rate := _PLAIN_RATE.match(self.text, self.at)) and "dt" not in self.known.names:
            self.at = rate.end()
            self.function(RATE, rate.start())
        elif (c in "d∂") and (of := _PLAIN_SLOPE.match(self.text, self.at)) and self.is_slope(of):
            self.at = of.end()
            self.slope(of[1], of.start())
        elif _PIECE.match(c):
            self.word()
        elif c == "{":
            self.put("(", "open")
            self.out += self.inner(*self.group())
            self.put(")", "close", self.at - 1)
        elif c == "^":
            self.power()
        elif c in _RAISED:
            self.put("^", "sign")
            self.put(_RAISED[c], "number")
            self.at += 1
        elif c == "°":
            self.put("*", "sign")
            self.put("(pi/180)", "name")
            self.at += 1
        elif c == "|":
            self.absolute()
        elif c == "√":
            self.at += 1
            self.put("sqrt", "function")
        elif c in "(":
            self.put("(", "open")
            self.at += 1
        elif c in ")":
            self.put(")", "close")
            self.at += 1
        elif c in "+-*/=," and not self.at_end():
            twice = self.text.startswith("**", self.at)
            self.put("^" if twice else c, "sign")
            self.at += 2 if twice else 1
        elif c in ".;," and self.at_end():
            self.at += 1  # the end of a sentence
        else:
            raise self.strange(f"unexpected character {c!r}")

    def exponential(self, behind: int) -> None:
        """e^{-t}, of which the power is the argument."""
        self.put("exp", "function")
        self.at = behind
        if self.text[behind:].lstrip().startswith("("):
            return
        self.put("(", "open")
        text, at = self.group()
        self.out += self.inner(text, at)
        self.put(")", "close", self.at - 1)

    def at_end(self) -> bool:
        """True if a punctuation mark ends the text."""
        return self.text[self.at] in ".;," and not _ORNAMENT.sub("", self.text[self.at + 1 :]).strip()

    def strange(self, what: str, fix: str = "", length: int = 1, at: int | None = None) -> ExpressionError:
        return ExpressionError(what, self.offset + (self.at if at is None else at), fix, length)

    def number(self, text: str) -> None:
        self.put(text, "number")
        self.at += len(text)
        unit = _UNIT.match(self.text, self.at)
        if unit is None or self.known.known(unit[1]) is not None or unit[1] in _FUNCTIONS or self.known.cut(unit[1]):
            return
        with suppress(ExpressionError):
            meant = Unit.parse({"degrees": "deg"}.get(unit[1], unit[1]))
            self.put("*", "sign")
            self.put(f"({meant.factor}{'*pi' if meant.pi_power else ''})", "name")
            self.at = unit.end()

    def group(self) -> tuple[str, int]:
        """The content of braces from here, or the one character (or command) that stands for a group; and its place."""
        while self.at < len(self.text) and self.text[self.at].isspace():
            self.at += 1
        if self.at >= len(self.text):
            raise self.strange("something is missing at the end", at=max(0, len(self.text) - 1))
        start = self.at
        if self.text[start] != "{":
            command = re.compile(r"\\[A-Za-z]+(?:\s*\{[^{}]*\})?|.", re.S).match(self.text, start)
            assert command is not None
            self.at = command.end()
            return command.group(), start
        level = 0
        for k in range(start, len(self.text)):
            if self.text[k] in "{}" and (k == 0 or self.text[k - 1] != "\\"):
                level += 1 if self.text[k] == "{" else -1
                if level == 0:
                    self.at = k + 1
                    return self.text[start + 1 : k], start + 1
        raise self.strange("'{' is never closed", "write } at the end", at=start)

    def inner(self, text: str, start: int) -> list[Scrap]:
        """The pieces of a group."""
        found = _Reader(text, self.known, self.offset + start, self.depth + 1).whole()
        if not found:
            raise self.strange("an empty pair of braces", at=start)
        return found

    # -- derivatives of energies ---------------------------------------------------------------------

    def is_slope(self, of: re.Match[str]) -> bool:
        """True if dT/dq is a derivative here: no name of the model begins with such a d."""
        words = (_WORD.match(self.text, at) for at in (of.start(), of.end()))
        return not any(word and word.group() in self.known.names for word in words)

    def slope(self, energy: str, start: int) -> None:
        """The variable from the lower d on: \\partial\\dot\\theta, dp1'; dt."""
        by, before = _BY.match(self.text, self.at), len(self.out)
        assert by is not None
        self.at = by.end()
        if self.text.startswith("\\", self.at):
            self.name()
        else:
            self.word()
        names = self.out[before:]
        if len(names) != 1 or names[0].kind != "name":
            raise self.strange("an energy is differentiated by one coordinate, or by its rate", at=by.end())
        self.out[before:] = []
        of, by_name = re.sub(r"\s", "", energy), names[0].text
        whole = by_name == "t" and by.group().strip() != "∂"
        self.put(f"{RATE}({of})" if whole else f"{SLOPE}({of}, {by_name})", "call", start)

    # -- commands ------------------------------------------------------------------------------------

    def command(self) -> None:
        found = re.compile(r"\\([A-Za-z]+|.)", re.S).match(self.text, self.at)
        if found is None:
            raise self.strange("'\\' at the end")
        name, start = found[1], self.at
        if name in _NOTHING or name == " ":
            self.at = found.end()
        elif name in _FRACTIONS:
            self.at = found.end()
            self.fraction(start)
        elif name == "sqrt":
            self.at = found.end()
            self.root(start)
        elif name in _SIGNS:
            self.at = found.end()
            sign = _SIGNS[name]
            if sign == "|":
                self.at -= 1
                self.text = self.text[: self.at] + "|" + self.text[self.at + 1 :]
            else:
                self.put(sign, {"(": "open", ")": "close"}.get(sign, "sign"), start)
        elif name in _FUNCTIONS:
            self.at = found.end()
            self.function(_FUNCTIONS[name], start)
        elif name == "operatorname":
            self.at = found.end()
            inside, place = self.group()
            if inside.strip() not in _FUNCTIONS:
                raise self.strange(f"unknown function '{inside.strip()}'", length=len(inside), at=place)
            self.function(_FUNCTIONS[inside.strip()], start)
        elif name == "circ":
            raise self.strange("'\\circ' stands for degrees after ^: 30^\\circ", length=5)
        else:
            self.name()

    def fraction(self, start: int) -> None:
        above, above_at = self.group()
        below, below_at = self.group()
        rate, by_time = _DIFFERENTIAL.fullmatch(above), _BY_TIME.fullmatch(below)
        of = _OF_ENERGY.fullmatch(above)
        if of and _BY.match(below) and (not by_time or of[1][0] in self.known.functions):
            lower = _Reader(below, self.known, self.offset + below_at, self.depth + 1)
            lower.slope(of[1], 0)
            if below[lower.at :].strip():
                raise self.strange("more than one name stands below", at=below_at)
            self.out += lower.out
            return
        if rate and by_time and (rate[1] or "1") == (by_time[1] or "1"):
            dots = int(by_time[1] or 1)
            if rate[2].strip():
                self.out += _Reader(rate[2], self.known, self.offset + above_at, self.depth + 1).one_name(dots)
            elif dots == 1 and (_WHOLE.match(self.text, self.at) or _A_SLOPE.match(self.text, self.at)):
                self.function(RATE, start)
            else:
                self.skip_space()
                rest = _Reader(self.text[self.at :], self.known, self.offset + self.at, self.depth + 1)
                self.out += rest.one_name(dots, whole=False)
                self.at += rest.at
            return
        self.put("(", "open", start)
        for k, (text, at) in enumerate(((above, above_at), (below, below_at))):
            if k:
                self.put("/", "sign", at)
            self.put("(", "open", at)
            self.out += self.inner(text, at)
            self.put(")", "close", at + len(text) - 1)
        self.put(")", "close", self.at - 1)

    def skip_space(self) -> None:
        while self.at < len(self.text) and self.text[self.at].isspace():
            self.at += 1

    def one_name(self, dots: int, whole: bool = True) -> list[Scrap]:
        """A name with so many dots.

        Raises:
            ExpressionError: something else stands there.
        """
        self.skip_space()
        self.name(dots)
        self.skip_space()
        if (whole and self.at < len(self.text)) or len(self.out) != 1:
            raise self.strange("only a coordinate is differentiated by time here", "write \\dot or a prime for a rate")
        return self.out

    def root(self, start: int) -> None:
        self.skip_space()
        degree = re.compile(r"\[([^\]]*)\]").match(self.text, self.at)
        if degree:
            self.at = degree.end()
        inside, at = self.group()
        if degree is None:
            self.put("sqrt", "function", start)
        self.put("(", "open", at)
        self.out += self.inner(inside, at)
        self.put(")", "close", at + len(inside) - 1)
        if degree is not None:
            self.put("^", "sign", start)
            self.put(f"(1/({degree[1]}))", "name", start)

    def function(self, name: str, start: int) -> None:
        """\\sin^{2} x, \\sin{\\left(x\\right)}, \\sin 2\\theta: the power comes behind, the argument in parentheses."""
        power: tuple[str, int] | None = None
        self.skip_space()
        if self.text[self.at : self.at + 1] == "^":
            self.at += 1
            power = self.group()
        elif self.text[self.at : self.at + 1] in _RAISED:
            power = (_RAISED[self.text[self.at]], self.at)
            self.at += 1
        if power is not None and power[0].replace(" ", "") == "-1" and name in ("sin", "cos", "tan"):
            name, power = f"a{name}", None
        self.put(name, "function", start)
        self.argument(name, start)
        if power is not None:
            self.put("^", "sign", power[1])
            self.put("(", "open", power[1])
            self.out += self.inner(*power)
            self.put(")", "close", power[1])

    def argument(self, name: str, start: int) -> None:
        while True:
            self.skip_space()
            ignored = re.compile(r"\\(?:left|bigl|Bigl|big|Big|,|!|;)(?![A-Za-z])").match(self.text, self.at)
            if ignored is None:
                break
            self.at = ignored.end()
        c = self.text[self.at : self.at + 1]
        if c == "{":
            inside, at = self.group()
            pieces = self.inner(inside, at)
            bare = not (pieces[0].kind == "open" and _closes_last(pieces))
            self.out += [Scrap("(", "open", self.offset + at), *pieces] if bare else pieces
            if bare:
                self.put(")", "close", self.at - 1)
            return
        if c and c in "([":
            self.parenthesis()
            return
        self.put("(", "open")
        first = len(self.out)
        self.plain_argument()
        if len(self.out) == first:
            raise self.strange(f"{name} of what?", f"write {name}(...)", at=start)
        if self.text[self.at : self.at + 1] and self.text[self.at] in "^²³":
            inside = "".join(piece.text for piece in self.out[first:])
            what = f"a power behind {name} without parentheses can be read in two ways"
            raise self.strange(what, f"write {name}({inside})^2 or {name}({inside}^2)")
        self.put(")", "close", self.at - 1)

    def plain_argument(self) -> None:
        """NumberKind and the names behind them: 2\\theta, \\omega t; a fraction."""
        while self.at < len(self.text):
            self.skip_space()
            c = self.text[self.at : self.at + 1]
            if c == "-" and self.out[-1].kind != "name":
                self.next()
                continue
            if _NUMBER.match(self.text, self.at):
                self.next()
                continue
            break
        set_as = self.text.startswith("\\", self.at)
        self.next_value()
        last = self.out[-1]
        names = _TIME_BEHIND.match(self.text, self.at)
        is_name = last.kind == "name" and not last.text.endswith("'")
        if names and (is_name or (set_as and last.kind == "close")):  # \sin\omega t, \cos\sqrt{k/m}\,t
            self.put("t", "name")
            self.at = names.end()

    def next_value(self) -> None:
        """One value, spaces before it left out."""
        before = len(self.out)
        while self.at < len(self.text) and len(self.out) == before and self.text[self.at] not in ")}=+-":
            self.next()

    def parenthesis(self) -> None:
        """The text from an opening parenthesis to the one that closes it."""
        start, level = len(self.out), 0
        opened = self.at
        while self.at < len(self.text):
            before = len(self.out)
            self.next()
            for piece in self.out[before:]:
                level += {"open": 1, "close": -1}.get(piece.kind, 0)
            if level == 0 and len(self.out) > start:
                return
        raise self.strange("'(' is never closed", at=opened)

    def absolute(self) -> None:
        """|x|"""
        end = re.compile(r"\||\\rvert|\\right\s*\|").search(self.text, self.at + 1)
        if end is None:
            raise self.strange("'|' is never closed", "write abs(...)")
        inside = re.sub(r"\\left\s*$", "     ", self.text[self.at + 1 : end.start()])
        self.put("abs", "function")
        self.put("(", "open")
        self.out += self.inner(inside, self.at + 1)
        self.put(")", "close", end.start())
        self.at = end.end()

    def power(self) -> None:
        start = self.at
        self.at += 1
        text, at = self.group()
        primes = re.sub(r"\s", "", text).replace("\\prime", "'")
        if set(primes) == {"'"} and self.out and self.out[-1].kind == "name":
            last = self.out.pop()
            self.out.append(Scrap(last.text + primes, "name", last.at))
            return
        if text.strip() in ("\\circ", "°"):
            self.put("*", "sign", start)
            self.put("(pi/180)", "name", start)
            return
        self.put("^", "sign", start)
        self.put("(", "open", at)
        self.out += self.inner(text, at)
        self.put(")", "close", at + len(text) - 1)

    # -- names ---------------------------------------------------------------------------------------

    def name(self, dots: int = 0) -> None:
        """One name with its accents, index and primes."""
        start = self.at
        letters, more = self.letters()
        dots += more
        index = self.index()
        dots += self.dots()
        index = index or self.index()
        found = self.known.indexed(letters, index)
        if found is None and letters == "ell":
            found = self.known.indexed("l", index)
        if found is None:
            index = re.sub(r"\W", "_", index)
            found = letters + (index if index[:1].isdigit() or not index else f"_{index}")
        arguments = _REFERENCES.match(self.text, self.at)
        if found in self.known.functions - self.known.names and arguments and not dots:
            self.at = arguments.end()
            self.put(found + re.sub(r"\s", "", arguments.group()), "call", start)
            return
        self.put_name(found, dots, start)

    def dots(self) -> int:
        """Number of dots and primes here."""
        found = re.compile("[\u0307\u0308']*").match(self.text, self.at)
        assert found is not None
        self.at = found.end()
        return sum(_DOTS.get(c, 1) for c in found.group())

    def letters(self) -> tuple[str, int]:
        """A letter, a Greek one by its name, or what is set upright; and how many dots stand over it."""
        found = re.compile(r"\\([A-Za-z]+)").match(self.text, self.at)
        if found is None:
            c = self.text[self.at : self.at + 1]
            if not c or not _PIECE.match(c):
                raise self.strange("a name is missing here")
            plain = unicodedata.normalize("NFD", c)
            self.at += 1
            dots = 0
            while self.at < len(self.text) and self.text[self.at] in _DOTS:
                dots += _DOTS[self.text[self.at]]
                self.at += 1
            return plain[0], dots + sum(_DOTS.get(mark, 0) for mark in plain[1:])
        command = found[1]
        if command in _ACCENTS or command in _DECORATIONS:
            self.at = found.end()
            inside, at = self.group()
            below = _Reader(inside, self.known, self.offset + at, self.depth + 1)
            below.skip_space()
            letters, dots = below.letters()
            index = below.index()
            below.skip_space()
            if below.at < len(below.text):
                what = f"a dot over more than one name: '{inside}'"
                raise self.strange(what, "differentiate by hand, or put it over the coordinate", len(inside), at)
            return letters + index, dots + _ACCENTS.get(command, 0)
        if command in _WRAPS:
            self.at = found.end()
            inside, _ = self.group()
            return re.sub(r"[\s{}\\]", "", inside), 0
        if command == "delta" and self.known.known("delta") is None:  # a virtual displacement
            self.at = found.end()
            self.skip_space()
            behind = re.match(r"\\([A-Za-z]+)|[^\W\d_]", self.text[self.at :])
            if behind is not None and (not behind[1] or behind[1] in _WRAPS or spelled_command(behind[1])):
                letters, dots = self.letters()
                return f"delta{letters}", dots
            return "delta", 0
        letter = "ell" if command == "ell" else spelled_command(command)
        if not letter:
            raise self.strange(f"unknown command '\\{command}'", length=len(command) + 1)
        self.at = found.end()
        return letter, 0

    def index(self) -> str:
        """The index below the line behind a name."""
        statements = re.compile(f"[{''.join(_STATEMENTS)}]+").match(self.text, self.at)
        if statements:
            self.at = statements.end()
            return "".join(_STATEMENTS[c] for c in statements.group())
        mark = re.compile(r"\s*_").match(self.text, self.at)
        if mark is None:
            return ""
        self.at = mark.end()
        inside, _ = self.group()
        bare = re.sub(r"\\(?:mathrm|text|mathit|textrm|mathsf|mathbf)\b", "", inside)
        return re.sub(r"[\s{}\\]", "", bare).strip()

    def word(self) -> None:
        """A word of plain letters: a name, a function, or several names side by side."""
        found = _WORD.match(self.text, self.at)
        assert found is not None
        word, start = unicodedata.normalize("NFC", found.group()), self.at
        bare = word.split(".", maxsplit=1)[0]
        behind = self.text[found.end() :].lstrip()
        if word.endswith("e") and behind.startswith("^") and not {word, "e"} & self.known.names:
            for part in self.known.cut(word[:-1]) or ():  # v_0e^{-t}
                self.put(part, "name", start)
                self.at = start + len(word) - 1
            if self.at > start:
                return
        if called := called_rate(self.text[start:]):
            self.at = start + called[2]
            self.put(f"{self.known.known(called[0]) or called[0]}{chr(39) * called[1]}", "name", start)
            return
        of_time = _OF_TIME.match(self.text, found.end()) and self.known.known(bare)
        if bare == word and behind.startswith("(") and not of_time and not self._is_product(word, found.end()):
            if word in _FUNCTIONS or word in self.known.tables:
                self.at = found.end()
                self.put(_FUNCTIONS.get(word, word), "function", start)
                self.skip_space()
                self.parenthesis()
                return
            arguments = _REFERENCES.match(self.text, found.end())
            if word in self.known.functions and arguments:
                self.at = arguments.end()
                self.put(word + re.sub(r"\s", "", arguments.group()), "call", start)
                return
        if self._several(bare, start):
            return
        single = _PIECE.match(self.text[self.at + 1 : self.at + 2]) is None
        if self.known.known(bare) is not None or "_" in bare or (single and not bare[1:].isdigit()):
            self.named(bare, start)
            return
        if bare in _FUNCTIONS:
            self.at = found.end()
            self.function(_FUNCTIONS[bare], start)
            return
        parts = self.known.cut(bare)
        if parts is None:
            function = next((x for x in sorted(_FUNCTIONS, key=len, reverse=True) if bare.startswith(x)), None)
            if function is not None and self.known.cut(bare[len(function) :]):  # sinθ
                self.at = start + len(function)
                self.function(_FUNCTIONS[function], start)
                return
            self.named(bare, start)
            return
        for part in parts[:-1]:
            self.put(part, "name", start)
        self.at = start + len(bare)
        self.after(parts[-1], start)

    def _is_product(self, word: str, end: int) -> bool:
        """True if parentheses behind a name are a factor: l(1 - cos(theta)), where l is a length."""
        if word in _FUNCTIONS or word in self.known.tables:
            return False
        return not (word in self.known.functions and _REFERENCES.match(self.text, end))

    def _several(self, bare: str, start: int) -> bool:
        """Names side by side of which some have an index: l_1l_2, gl_{1}, k_ta; whether they are that."""
        group = _INDEX_GROUP.match(self.text, start + len(bare)) if bare.endswith("_") else None
        whole = bare + re.sub(r"\W", "", group[1]) if group else bare
        if "_" not in whole or self.known.known(whole) is not None:
            return False
        parts = self.known.cut(whole)
        if parts is None or len(parts) < 2:
            return False
        for part in parts[:-1]:
            self.put(part, "name", start)
        self.at = group.end() if group else start + len(bare)
        self.after(parts[-1], start)
        return True

    def named(self, bare: str, start: int) -> None:
        """A name that stands as one word."""
        base, _, index = bare.partition("_")
        self.at = start + len(bare)
        if bare.endswith("_"):  # m_{1}: the index is a group
            self.at -= 1
            self.after(base, start)
            return
        found = self.known.known(bare) or self.known.indexed(base, index)
        found = found or meant_name(bare, self.known.rates) or "".join(spelled(c) or c for c in bare)
        self.after(found, start)

    def after(self, name: str, start: int) -> None:
        """An index, dots and primes behind a name."""
        index = self.index()
        dots = self.dots()
        index = index or self.index()
        if index:
            name = self.known.indexed(name, index) or name + (index if index[0].isdigit() else f"_{index}")
        self.put_name(name, dots, start)

    def put_name(self, name: str, dots: int, start: int) -> None:
        """A name with its dots; x(t) of time is x, a table of the model stands before its argument, M(n)."""
        if name in self.known.tables and _OPENED.match(self.text, self.at):
            self.put(name + "'" * dots, "function", start)
            self.parenthesis()
            return
        of_time = _OF_TIME.match(self.text, self.at)
        if of_time and (name in self.known.names or name not in self.known.functions):
            self.at = of_time.end()
        self.put(name + "'" * dots, "name", start)


def _closes_last(pieces: list[Scrap]) -> bool:
    """True if the parenthesis that opens first closes last."""
    level = 0
    for k, piece in enumerate(pieces):
        level += {"open": 1, "close": -1}.get(piece.kind, 0)
        if level == 0:
            return k == len(pieces) - 1
    return False
