r"""How a name is set in LaTeX: theta1 -> \theta_{1}, mb -> m_{b}, k_max -> k_{\mathrm{max}}."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field, replace

from eomgen.records import dataclass

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

    text: str = field(compare=False)
    base: str
    below: str = ""
    above: str = ""

    @property
    def tex(self) -> str:
        """In LaTeX."""
        below, above = f"_{{{self.below}}}" if self.below else "", f"^{{{self.above}}}" if self.above else ""
        return f"{self.base}{below}{above}"

    def dotted(self, dots: int) -> str:
        """The symbol of its derivative, the dots over the letter and not over its index."""
        over = _dotted(self.base, dots)
        if over is None:
            return replace(self, above=",".join(filter(None, (self.above, f"({dots})")))).tex
        return replace(self, base=over).tex

    def with_index(self, *more: str) -> Symbol:
        """With more in its index, behind what stands there."""
        return replace(self, below=",".join(filter(None, (self.below, *more))))


def _dotted(base: str, dots: int) -> str | None:
    """The letter with the dots, which join those that it has; None where there are more than anybody sets."""
    if not dots:
        return base
    over = re.fullmatch(r"\\(d{0,2}dot)\{(.*)\}", base)
    if over is not None and dots + len(over[1]) - 2 in DOTS and _is_one(over[2]):
        return rf"{DOTS[dots + len(over[1]) - 2]}{{{over[2]}}}"
    return f"{DOTS[dots]}{{{base}}}" if dots in DOTS else None


def _is_one(inside: str) -> bool:
    """Whether the braces around it close where it ends: of {a}, not of {a}{b}."""
    depth = 0
    for token in _TOKEN.findall(inside):
        depth += (token == "{") - (token == "}")
        if depth < 0:
            return False
    return depth == 0


# -- what a name looks like by itself -----------------------------------------------------------------


def symbol_of(name: str, indices: Mapping[str, str] | None = None) -> Symbol:
    """The symbol of a name without primes, by its own letters.

    Args:
        indices: how the names of bodies, ties and forces are set in an index, where they declare it.
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
