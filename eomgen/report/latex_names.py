"""Names of a model -> LaTeX: theta1' -> \\dot{\\theta}_{1}, k_max -> k_{\\mathrm{max}}, lam(B, 1) -> \\lambda_{B,1}."""

from __future__ import annotations

import re
from collections.abc import Iterable

from eomgen.report.statements import Law

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
SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "²": r"\textsuperscript{2}",
    "³": r"\textsuperscript{3}",
    "µ": r"$\mu$",
    "°": r"$^{\circ}$",
    "·": r"$\cdot$",
}
_COMPONENT = re.compile(r"(?P<letter>[IJFcprvw])(?P<axes>[xyz]{1,2})(?P<number>\d*)")  # Ixx1, cy2, Fz
_NAME = re.compile(r"(?P<letters>[^\W\d_]+?)(?P<rest>[\d_].*)?")
_MULTIPLIER = re.compile(r"lam\((?P<tie>.*), (?P<row>\d+)\)")


def symbol_latex(name: str, base: str = "") -> str:
    """A symbol of the formulas, dots and subscripts included.

    Args:
        base: how the name without its primes is set, where not by its own letters.
    """
    multiplier = _MULTIPLIER.fullmatch(name)
    if multiplier:
        return rf"\lambda_{{{upright(multiplier['tie'])},{multiplier['row']}}}"
    bare = name.rstrip("'")
    letters, subscript = _parts(bare)
    return _dotted(base or _letters(letters), len(name) - len(bare)) + (
        f"_{{{subscript}}}" if subscript and not base else ""
    )


def letter_law(text: str) -> Law:
    """A letter, with an index or without: v_x, J_xy, omega."""
    letter, _, index = text.partition("_")
    return Law(text, _letters(letter) + (f"_{{{index}}}" if index else ""))


def _dotted(base: str, dots: int) -> str:
    if not dots:
        return base
    return f"{DOTS[dots]}{{{base}}}" if dots in DOTS else f"{base}^{{({dots})}}"


def notation(names: Iterable[str]) -> dict[str, str]:
    """The LaTeX of each name; where two would look alike (theta1, theta_1), the later one is spelt out."""
    names = list(names)
    taken: dict[str, str] = {}
    spelt: dict[str, str] = {}
    for bare in dict.fromkeys(name.rstrip("'") for name in names):
        if taken.setdefault(symbol_latex(bare), bare) != bare:
            spelt[bare] = upright(bare)
    return {name: symbol_latex(name, spelt.get(name.rstrip("'"), "")) for name in names}


def upright(text: str) -> str:
    """A word in roman type inside a formula."""
    return rf"\mathrm{{{_greek_out(text)}}}"


def latex_escaped(text: str) -> str:
    """Plain text for LaTeX outside formulas."""
    return "".join(rf"${LETTERS[c]}$" if c in LETTERS else SPECIAL.get(c, c) for c in text)


def _greek_out(text: str) -> str:
    """A word for \\mathrm: special characters escaped, blanks kept, Greek letters by their commands."""
    pieces = {"_": r"\_", " ": r"\ ", "&": r"\&", "#": r"\#", "%": r"\%", "$": r"\$", "{": r"\{", "}": r"\}"}
    return "".join(LETTERS.get(c, pieces.get(c, c)) + ("{}" if c in LETTERS else "") for c in text)


def _parts(bare: str) -> tuple[str, str]:
    """theta1 -> (theta, 1); k_max -> (k, \\mathrm{max}); x_1_2 -> (x, 1,2); Ixx1 -> (I, xx,1)."""
    component = _COMPONENT.fullmatch(bare)
    if component:
        return component["letter"], ",".join(filter(None, (component["axes"], component["number"])))
    match = _NAME.fullmatch(bare)
    if match is None:
        return bare, ""
    rest = [piece for piece in (match["rest"] or "").split("_") if piece]
    return match["letters"], ",".join(_subscript(piece) for piece in rest)


def _subscript(piece: str) -> str:
    if piece.isdigit():
        return piece
    return GREEK.get(piece) or LETTERS.get(piece) or (piece if len(piece) == 1 else upright(piece))


def _letters(letters: str) -> str:
    if letters in GREEK:
        return GREEK[letters]
    if letters in LETTERS:
        return LETTERS[letters]
    if letters[0] == "δ":  # a virtual displacement
        return rf"\delta {_letters(letters[1:])}"
    return letters if len(letters) == 1 and letters.isascii() and letters.isalpha() else upright(letters)
