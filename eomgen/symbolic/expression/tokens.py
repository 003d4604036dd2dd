"""Text -> tokens of the model file's grammar: numbers (exact), names with their primes, signs."""

from __future__ import annotations

import re

from eomgen.errors import ExpressionError, NumberBeyond
from eomgen.records import dataclass
from eomgen.symbolic.expression.habits import degrees, plainly
from eomgen.symbolic.expression.rational import Fraction, fraction_of

LARGEST_EXPONENT = 300  # of ten, in a decimal: what a double can hold
MOST_DIGITS = 320
LARGEST_SIZE = 1000  # bits: a number still fits a double, and a product of two short ones

_DIGITS = r"[0-9](?:_?[0-9])*"
_NUMBER = rf"(?:{_DIGITS}(?:\.(?:{_DIGITS})?)?|\.{_DIGITS})(?:[eE][+-]?{_DIGITS})?"
_NAME = r"[^\W\d²³¹⁰⁴-⁹][^\W²³¹⁰⁴-⁹]*"
_TOKEN = re.compile(rf"(?P<number>{_NUMBER})|(?P<name>{_NAME}'*)|(?P<sign>\*\*|[-+*/^(),=;])")
_SPACE = re.compile(r"\s*")
_REFERENCE = re.compile(rf"(?P<number>{_NUMBER}\s*[,)])|(?P<reference>\w+(?:\.\w+)*(?:\s*-\s*\w+(?:\.\w+)*)*)\s*[,)]")
_DOTTED = re.compile(rf"{_NAME}(?:\.\w+)+")

CASES = "nothing is compared here: an instant is an equation, x = 1; cases are made by max, min, abs, sign"
_MENDS = {
    "−": "write -",
    "–": "write -",
    "·": "write *",
    "×": "write *",
    "÷": "write /",
    "′": "write '",
    "’": "write '",
    "″": "write ''",
    '"': "write ''",
    "²": "write ^2",
    "³": "write ^3",
    "√": "write sqrt(...)",
    "|": "write abs(...)",
    "°": 'give the unit beside it: { start = 20, unit = "deg" }',
    ">": CASES,
    "<": CASES,
    "?": CASES,
    "[": "use round parentheses",
    "{": "use round parentheses",
    "]": "use round parentheses",
    "}": "use round parentheses",
    "%": "write /100",
    "!": "there is no factorial; a product is written out",
}


@dataclass(frozen=True, slots=True)
class Token:
    """A piece of the text: `kind` is "number", "name", "sign" or "end"; `start` counts from 0."""

    kind: str
    text: str
    start: int

    @property
    def end(self) -> int:
        return self.start + len(self.text)


def is_name(text: str) -> bool:
    """True where text can name a parameter or a coordinate: letters (Greek too), digits, `_`; no prime."""
    return re.fullmatch(_NAME, text) is not None


def skip_space(text: str, position: int) -> int:
    """The first position from here on that holds no space."""
    found = _SPACE.match(text, position)
    return found.end() if found else position


def token_at(text: str, position: int) -> Token:
    """The token that begins at or after this position."""
    start = skip_space(text, position)
    if start == len(text):
        return Token("end", "", start)
    found = _TOKEN.match(text, start)
    if found is None or found.lastgroup is None:
        raise _strange(text, start)
    return Token(found.lastgroup, found.group(), start)


def _strange(text: str, start: int) -> ExpressionError:
    character = text[start]
    if character == "." and start > 0 and (dotted := _DOTTED.match(text, _word_start(text, start))):
        length = dotted.end() - dotted.start()
        owner, _, what = dotted.group().partition(".")
        mend = {"dot": f"the rate is written {owner}'", "ddot": f"it is written {owner}''"}.get(what, "")
        if owner in ("np", "numpy", "math", "sp", "sympy"):
            mend = f"write {what}(...)"
        return ExpressionError(f"'{dotted.group()}' is a point, not a number", dotted.start(), mend, length)
    in_formula = character == "°" and not text[:start].strip().isdigit()
    mend = degrees(text) if in_formula else _MENDS.get(character) or plainly(character)
    return ExpressionError(f"unexpected character {character!r}", start, mend)


def _word_start(text: str, end: int) -> int:
    while end > 0 and (text[end - 1].isalnum() or text[end - 1] == "_"):
        end -= 1
    return end


def reference_at(text: str, position: int) -> str | None:
    """The dotted name or member (`arm.end`, `B`, `n1-n2`) that is a whole argument here, else None."""
    found = _REFERENCE.match(text, position)
    return found.group("reference") if found else None


def unclosed_at(text: str, position: int) -> bool:
    """Whether a dotted name here is the last thing of the text: the parenthesis before it is never closed."""
    found = _DOTTED.match(text, position)
    return found is not None and skip_space(text, found.end()) == len(text)


def number_in(token: Token) -> int | Fraction:
    """The exact value of a decimal: 0.0825 is 33/400."""
    mantissa, _, exponent = token.text.replace("_", "").lower().partition("e")
    if len(mantissa) > MOST_DIGITS or len(exponent) > 6 or abs(int(exponent or 0)) > LARGEST_EXPONENT:
        shown = token.text if len(token.text) < 30 else f"{token.text[:24]}..."
        what = f"the number {shown} has too many digits or too large an exponent"
        raise NumberBeyond(what, token.start, f"at most {LARGEST_EXPONENT} in each", len(token.text))
    value = fraction_of(f"{mantissa}e{exponent or 0}")
    if value.numerator.bit_length() - value.denominator.bit_length() > LARGEST_SIZE:
        what = f"{token.text[:24]}... is too large for a number"
        raise NumberBeyond(what, token.start, f"at most 1e{LARGEST_EXPONENT}", len(token.text))
    return value.numerator if value.denominator == 1 else value
