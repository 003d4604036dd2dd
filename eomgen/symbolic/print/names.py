"""Names in LaTeX, derived from their letters or declared by a model."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field, replace
from difflib import get_close_matches

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass

# -------- symbols ---------------------------------------------------------------------------------------------
# How a name is set in LaTeX: theta1 -> \theta_{1}, mb -> m_{b}, k_max -> k_{\mathrm{max}}.


SMALL = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi"
    " omega varphi vartheta varepsilon"
).split()
LARGE = "Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega".split()
GREEK = {name: rf"\{name}" for name in SMALL + LARGE} | {"epsilon": r"\varepsilon"}
LETTERS = dict(
    zip("αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΥΦΨΩ", [GREEK[n] for n in SMALL[:23]] + [GREEK[n] for n in LARGE], strict=True)
)
DOTS = {1: r"\dot", 2: r"\ddot", 3: r"\dddot"}
_TOKEN = re.compile(r"\\(?:[a-zA-Z]+|.)|.", re.DOTALL)
_AXES = re.compile(r"[xyz]+")
_COMPONENT = re.compile(r"(?P<letter>[IJFcprvw])(?P<axes>[xyz]{1,2})(?P<number>\d*)")  # Ixx1, cy2, Fz
_NAME = re.compile(r"(?P<letters>[^\W\d_]+?)(?P<rest>[\d_].*)?")
_JOINED = re.compile(r"(?=[A-Za-z][a-z]$|[a-z][A-Z]{1,3}$|[IJ][A-Z]$)(?P<letter>.)(?P<index>.+)")  # mb, lAB, IA; not EI
_GREEK_JOINED = re.compile(rf"(?P<letter>{'|'.join(sorted(GREEK, key=len, reverse=True))})(?P<index>[A-Z]{{1,3}})")


@dataclass(frozen=True)
class Symbol:
    r"""A symbol as it is set: \theta with the index A, and what is over it.

    Args:
        text: as it was declared (not compared: that is what it sets).
        base: what stands on the line, and gets the dots of a rate.
        below, above: its index and what stands where an exponent would; "" where nothing does.
    """

    LONGEST = 60  # characters

    text: str = field(compare=False)
    base: str
    below: str = ""
    above: str = ""

    @property
    def tex(self) -> str:
        """The symbol in LaTeX."""
        below, above = f"_{{{self.below}}}" if self.below else "", f"^{{{self.above}}}" if self.above else ""
        return f"{self.base}{below}{above}"

    def dotted(self, dots: int) -> str:
        """The symbol of its derivative, the dots over the letter and not over its index."""
        over = _dotted(self.base, dots)
        if over is None:
            return replace(self, above=",".join(filter(None, (self.above, f"({dots})")))).tex
        return replace(self, base=over).tex

    def with_index(self, *more: str) -> Symbol:
        """The symbol with more in its index, behind what stands there."""
        return replace(self, below=",".join(filter(None, (self.below, *more))))

    @staticmethod
    def of(name: str, indices: Mapping[str, str] | None = None) -> Symbol:
        """The symbol of a name without primes, by its own letters.

        Args:
            indices: how the names of bodies, constraints and forces are set in an index, where they declare it.
        """
        component = _COMPONENT.fullmatch(name)
        if component:
            return Symbol(name, component["letter"], ",".join(filter(None, (component["axes"], component["number"]))))
        match = _NAME.fullmatch(name)
        if match is None:
            return Symbol(name, _letters(name))
        joined = _GREEK_JOINED.fullmatch(match["letters"])
        if joined is None and match["letters"] not in GREEK:
            joined = _JOINED.fullmatch(match["letters"])
        letters = joined["letter"] if joined else match["letters"]
        inside = joined["index"] if joined else ""
        rest = index_latex(match["rest"] or "", indices)
        return Symbol(name, _letters(letters), ",".join(filter(None, (inside, rest))))

    @staticmethod
    def parsed(text: str) -> Symbol:
        """The symbol that a text declares.

        Raises:
            ExpressionError: it is no symbol of the grammar; `column` counts from 0 within the text.
        """
        if len(text) > Symbol.LONGEST:
            raise ExpressionError(
                f"a symbol of {len(text)} characters", 0, f"write at most {Symbol.LONGEST}", len(text)
            )
        tokens = _Tokens(text)
        if not tokens.now:
            raise ExpressionError(NOTHING, 0, LIKE)
        *before, last = _atoms(tokens)
        if tokens.now:
            raise ExpressionError("a brace is closed that was never opened", tokens.at, "leave out the }")
        if re.match(r"\{*[0-9]", before[0].tex if before else last.base):
            raise ExpressionError("a symbol that begins with a digit, as a number does", 0, "begin with a letter")
        return Symbol(text, _joined([*(atom.tex for atom in before), last.base]), last.below, last.above)


def _dotted(base: str, dots: int) -> str | None:
    """The letter with the dots, which join those that it has; None where there are more than anybody sets."""
    if not dots:
        return base
    over = re.fullmatch(r"\\(d{0,2}dot)\{(.*)\}", base)
    if over is not None and dots + len(over[1]) - 2 in DOTS and _is_one(over[2]):
        return rf"{DOTS[dots + len(over[1]) - 2]}{{{over[2]}}}"
    return f"{DOTS[dots]}{{{base}}}" if dots in DOTS else None


def _is_one(inside: str) -> bool:
    """True if the braces around it close where it ends: of {a}, not of {a}{b}."""
    depth = 0
    for token in _TOKEN.findall(inside):
        depth += (token == "{") - (token == "}")
        if depth < 0:
            return False
    return depth == 0


# -- what a name looks like by itself -----------------------------------------------------------------


def index_latex(text: str, indices: Mapping[str, str] | None = None) -> str:
    """Words in an index, one style for all: letters slanted, words upright, max -> \\mathrm{max}."""
    pieces = [piece for piece in text.split("_") if piece]
    found: list[str] = []
    while pieces:
        count = next((k for k in range(len(pieces), 0, -1) if "_".join(pieces[:k]) in (indices or {})), 0)
        found.append((indices or {})["_".join(pieces[:count])] if count else _piece(pieces[0]))
        pieces = pieces[max(count, 1) :]
    return ",".join(found)


def upright(text: str) -> str:
    """A word in roman type inside a formula."""
    pieces = {"_": r"\_", " ": r"\ ", "&": r"\&", "#": r"\#", "%": r"\%", "$": r"\$", "{": r"\{", "}": r"\}"}
    inside = "".join(LETTERS.get(c, pieces.get(c, c)) + ("{}" if c in LETTERS else "") for c in text)
    return rf"\mathrm{{{inside}}}"


def _piece(piece: str) -> str:
    if piece.isdigit() or _AXES.fullmatch(piece):
        return piece
    return GREEK.get(piece) or LETTERS.get(piece) or (piece if len(piece) == 1 else upright(piece))


def _letters(letters: str) -> str:
    if letters in GREEK:
        return GREEK[letters]
    if letters in LETTERS:
        return LETTERS[letters]
    if letters[0] == "δ" and len(letters) > 1:  # a virtual displacement
        return rf"\delta {_letters(letters[1:])}"
    return letters if len(letters) == 1 and letters.isascii() and letters.isalpha() else upright(letters)


# -------- declared symbol -------------------------------------------------------------------------------------
# LaTeX that a user declares -> Symbol, or what is wrong with it: "\\dot\\gamma", "J_C", "\\bar x_{\\mathrm{max}}^*".
#
# symbol := atom atom ...,  atom := piece ' ... [_piece] [^piece],  piece := letter | \gamma | \dot piece | { symbol }
#
# All of it is known to amsmath, KaTeX, MathML writers and matplotlib; nothing in it can end a formula or begin a
# command.


ACCENTS = frozenset("\\" + x for x in "dot ddot hat bar tilde vec widehat overline".split())
STYLES = frozenset("\\" + x for x in "mathrm mathit mathbf mathsf mathcal".split())
OTHERS = "ell hbar infty partial ast star circ bullet dagger prime parallel perp".split()
SIGNS = frozenset("\\" + x for x in (*SMALL, *LARGE, *OTHERS))
WORDS = frozenset("\\" + x for x in "max min sup inf lim".split())  # set upright: S_{\max}
SPACES = frozenset((r"\,", r"\;", r"\ "))
COMMANDS = (*sorted(WORDS), *sorted(SIGNS), *sorted(ACCENTS), *sorted(STYLES))
_DECLARED_TOKEN = re.compile(r"\\(?:[a-zA-Z]+|.|$)|.", re.DOTALL)
_PLAIN = re.compile(r"[A-Za-z0-9]")
_BESIDE = frozenset(",+-*/()|<>=.")  # what may stand in an index, and nowhere else
_EATEN = {"\t": "t", "\b": "b", "\n": "n", "\r": "r", "\f": "f"}  # what TOML and Python make of \theta, \beta, \nu, ...


NOTHING = "a symbol without a letter"
MADE_OF = r"a symbol is made of letters, digits, Greek letters, \dot, \hat, \bar, \vec and \mathrm{...}"
LIKE = r"like 'J_C' or '\dot\gamma'"


class _Tokens:
    """The tokens of a text one after the other, blanks left out; "" at the end."""

    def __init__(self, text: str) -> None:
        self._found = [(match[0], match.start()) for match in _DECLARED_TOKEN.finditer(text) if match[0] != " "]
        self._found.append(("", len(text)))
        self._k = 0

    @property
    def now(self) -> str:
        return self._found[self._k][0]

    @property
    def at(self) -> int:
        return self._found[self._k][1]

    def take(self) -> str:
        """The token, which then lies behind."""
        token = self.now
        self._k += bool(token)
        return token

    def refuse(self, what: str, fix: str) -> ExpressionError:
        """The error at the present token."""
        return ExpressionError(what, self.at, fix, max(len(self.now), 1))


def _joined(pieces: list[str]) -> str:
    r"""Pieces side by side; a blank where a letter would become part of a command: \Delta x."""
    found = ""
    for piece in pieces:
        found += (" " if re.search(r"\\[a-zA-Z]+$", found) and piece[:1].isalpha() else "") + piece
    return found


def _atoms(tokens: _Tokens, *, index: bool = False) -> list[Symbol]:
    """The atoms as far as they go: to the end, or to a brace that closes; at least one."""
    found: list[Symbol] = []
    while tokens.now and tokens.now != "}":
        if (found and tokens.now in SPACES) or (index and tokens.now in _BESIDE):
            found.append(Symbol("", tokens.take()))
        else:
            found.append(_atom(tokens, index=index))
    if not found:
        raise tokens.refuse("braces with nothing between them", "put a letter there, or leave them out")
    return found


def _atom(tokens: _Tokens, *, index: bool) -> Symbol:
    """A piece with its primes, its index and what stands where an exponent would."""
    if tokens.now in ("_", "^", "'"):
        raise tokens.refuse(f"'{tokens.now}' has nothing before it", "put a letter there")
    base = _declared_piece(tokens, index=index)
    primes = ""
    while tokens.now == "'":
        primes += tokens.take()
    scripts = {"_": "", "^": ""}
    while tokens.now in ("_", "^"):
        sign = tokens.now
        if scripts[sign] or (sign == "^" and primes):
            whose = "an index" if sign == "_" else "an exponent or primes"
            raise tokens.refuse(f"'{sign}' where the letter has {whose} already", "put all of it into one pair of { }")
        tokens.take()
        scripts[sign] = _declared_piece(tokens, index=True, bare=True)
    return Symbol("", base, scripts["_"], scripts["^"] or r"\prime" * len(primes))


def _declared_piece(tokens: _Tokens, *, index: bool, bare: bool = False) -> str:
    """A letter, a command with what it needs, or what stands in braces.

    Args:
        bare: without its braces.
    """
    token = tokens.now
    if token == "{":
        return _braces(tokens, index=index, bare=bare)
    if token in SIGNS or _PLAIN.fullmatch(token) or (index and token in ("+", "-", "*")):
        return tokens.take()
    if token in WORDS:
        return rf"\mathrm{{{tokens.take()[1:]}}}"
    if token in ACCENTS or token in STYLES:
        tokens.take()
        if not tokens.now or tokens.now in ("}", "_", "^", "'"):
            raise tokens.refuse(f"'{token}' has nothing to stand on", f"like {token}{{x}}")
        return f"{token}{{{_word(tokens) if token in STYLES else _declared_piece(tokens, index=index, bare=True)}}}"
    raise _stranger(tokens)


def _braces(tokens: _Tokens, *, index: bool, bare: bool) -> str:
    opened = tokens.at
    tokens.take()
    if not tokens.now:
        raise ExpressionError("a brace that is never closed", opened, "close it: }")
    inside = _joined([atom.tex for atom in _atoms(tokens, index=index)])
    if not tokens.now:
        raise ExpressionError("a brace that is never closed", opened, "close it: }")
    tokens.take()
    return inside if bare else f"{{{inside}}}"


def _word(tokens: _Tokens) -> str:
    r"""A word in another type: \mathrm{max}, letters and digits."""
    if _PLAIN.fullmatch(tokens.now):
        return tokens.take()
    if tokens.now != "{":
        raise tokens.refuse(f"'{tokens.now}' where letters of another type stand", r"like \mathrm{max}")
    opened = tokens.at
    tokens.take()
    word = ""
    while tokens.now and tokens.now != "}":
        if not (_PLAIN.fullmatch(tokens.now) or tokens.now in _BESIDE or tokens.now in SPACES):
            raise _stranger(tokens)
        word += tokens.take()
    if not tokens.now:
        raise ExpressionError("a brace that is never closed", opened, "close it: }")
    if not word:
        raise tokens.refuse("braces with nothing between them", "put a letter there, or leave them out")
    tokens.take()
    return word


def _stranger(tokens: _Tokens) -> ExpressionError:
    """The error for a token that the grammar does not know here."""
    token = tokens.now
    if not token:
        return tokens.refuse("the symbol ends where a letter should follow", "put one there")
    if token in _EATEN:
        lost = "\\" + _EATEN[token]
        return tokens.refuse(f"a control character: in double quotes '{lost}' is one", "write it in single quotes")
    if token in COMMANDS or token in SPACES:
        return tokens.refuse(f"'{token}' cannot stand here in a symbol", r"among \mathrm{...} stand letters and digits")
    if token == "$":
        return tokens.refuse("'$' in a symbol", "leave it out: a symbol stands in a formula already")
    if token in LETTERS:
        return tokens.refuse(f"'{token}' is not LaTeX everywhere", f"write {LETTERS[token]}")
    if token.startswith("\\"):
        near = get_close_matches(token, COMMANDS, n=1, cutoff=0.7)
        fix = f"did you mean {near[0]}?" if near else MADE_OF
        return tokens.refuse(f"unknown command '{token}' in a symbol", fix)
    shown = token if token.isprintable() else repr(token)[1:-1]
    return tokens.refuse(f"'{shown}' cannot stand here in a symbol", MADE_OF)
