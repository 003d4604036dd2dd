r"""LaTeX that a user declares -> Symbol, or what is wrong with it: "\\dot\\gamma", "J_C", "\\bar x_{\\mathrm{max}}^*".

symbol := atom atom ...,  atom := piece ' ... [_piece] [^piece],  piece := letter | \gamma | \dot piece | { symbol }

All of it is known to amsmath, KaTeX, MathML writers and matplotlib; nothing in it can end a formula or begin a command.
"""

from __future__ import annotations

import re
from difflib import get_close_matches

from eomgen.errors import ExpressionError
from eomgen.symbolic.print.symbols import LARGE, LETTERS, SMALL, Symbol

LONGEST = 60  # characters
ACCENTS = frozenset("\\" + x for x in "dot ddot hat bar tilde vec widehat overline".split())
STYLES = frozenset("\\" + x for x in "mathrm mathit mathbf mathsf mathcal".split())
OTHERS = "ell hbar infty partial ast star circ bullet dagger prime parallel perp".split()
SIGNS = frozenset("\\" + x for x in (*SMALL, *LARGE, *OTHERS))
SPACES = frozenset((r"\,", r"\;", r"\ "))
COMMANDS = (*sorted(SIGNS), *sorted(ACCENTS), *sorted(STYLES))
_TOKEN = re.compile(r"\\(?:[a-zA-Z]+|.|$)|.", re.DOTALL)
_PLAIN = re.compile(r"[A-Za-z0-9]")
_BESIDE = frozenset(",+-*/()|<>=.")  # what may stand in an index, and nowhere else
_EATEN = {"\t": "t", "\b": "b", "\n": "n", "\r": "r", "\f": "f"}  # what TOML and Python make of \theta, \beta, \nu, ...


NOTHING = "a symbol without a letter"
MADE_OF = r"a symbol is made of letters, digits, Greek letters, \dot, \hat, \bar, \vec and \mathrm{...}"
LIKE = r"like 'J_C' or '\dot\gamma'"


def parse_symbol(text: str) -> Symbol:
    """The symbol that a text declares.

    Raises:
        ExpressionError: it is no symbol of the grammar; `column` counts from 0 within the text.
    """
    if len(text) > LONGEST:
        raise ExpressionError(f"a symbol of {len(text)} characters", 0, f"write at most {LONGEST}", len(text))
    tokens = _Tokens(text)
    if not tokens.now:
        raise ExpressionError(NOTHING, 0, LIKE)
    *before, last = _atoms(tokens)
    if tokens.now:
        raise ExpressionError("a brace is closed that was never opened", tokens.at, "leave out the }")
    if re.match(r"\{*[0-9]", before[0].tex if before else last.base):
        raise ExpressionError("a symbol that begins with a digit, as a number does", 0, "begin with a letter")
    return Symbol(text, _joined([*(atom.tex for atom in before), last.base]), last.below, last.above)


class _Tokens:
    """The tokens of a text one after the other, blanks left out; "" at the end."""

    def __init__(self, text: str) -> None:
        self._found = [(match[0], match.start()) for match in _TOKEN.finditer(text) if match[0] != " "]
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

    def refuse(self, what: str, mend: str) -> ExpressionError:
        """What is wrong with the token."""
        return ExpressionError(what, self.at, mend, max(len(self.now), 1))


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
    base = _piece(tokens, index=index)
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
        scripts[sign] = _piece(tokens, index=True, bare=True)
    return Symbol("", base, scripts["_"], scripts["^"] or r"\prime" * len(primes))


def _piece(tokens: _Tokens, *, index: bool, bare: bool = False) -> str:
    """A letter, a command with what it needs, or what stands in braces.

    Args:
        bare: without its braces.
    """
    token = tokens.now
    if token == "{":
        return _braces(tokens, index=index, bare=bare)
    if token in SIGNS or _PLAIN.fullmatch(token) or (index and token in ("+", "-", "*")):
        return tokens.take()
    if token in ACCENTS or token in STYLES:
        tokens.take()
        if not tokens.now or tokens.now in ("}", "_", "^", "'"):
            raise tokens.refuse(f"'{token}' has nothing to stand on", f"like {token}{{x}}")
        return f"{token}{{{_word(tokens) if token in STYLES else _piece(tokens, index=index, bare=True)}}}"
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
    r"""What stands in another type: \mathrm{max}, letters and digits."""
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
    """What is wrong with a token that the grammar does not know here."""
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
        mend = f"did you mean {near[0]}?" if near else MADE_OF
        return tokens.refuse(f"unknown command '{token}' in a symbol", mend)
    shown = token if token.isprintable() else repr(token)[1:-1]
    return tokens.refuse(f"'{shown}' cannot stand here in a symbol", MADE_OF)
