"""The user's names -> identifiers of a language, no two alike."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Container, Iterable

MATH_WORDS = frozenset(
    "acos asin atan atan2 cos sin tan acosh asinh atanh cosh sinh tanh exp exp2 expm1 frexp ilogb ldexp log log10 "
    "log1p log2 logb modf cbrt fabs hypot pow sqrt erf erfc lgamma tgamma gamma ceil floor nearbyint rint lrint round "
    "lround trunc fmod remainder remquo copysign nan nextafter fdim fmax fmin fma abs sign j0 j1 jn y0 y1 yn min max "
    "select less less_equal pi np math signgam isnan isinf isfinite signbit div printf size_t".split()
)
OWN_WORDS = frozenset(
    "between acting t x p c inputs dx out given n constants evaluate math float SIZE "
    "rhs reactions inverse outputs matrices jacobian".split()
)
RESERVED = MATH_WORDS | OWN_WORDS
# our own variables, functions and macros, and what C keeps for itself
LOCAL = re.compile(
    r"[vi][0-9]+|samples[0-9]+|.*part[0-9]+|solve.*|.*_(rhs|reactions|inverse|outputs|matrices|jacobian).*|.*_(STATES|PARAMETERS|INPUTS|CONSTANTS|OUTPUTS)|_.*"
)


LONGEST = 31  # what is no longer every language takes
LONGEST_STEM = 48  # Fortran and MATLAB take 63, `_regressor_test` after it


def identifiers(
    names: Iterable[str], taken: Container[str], folded: Callable[[str], str] = lambda word: word
) -> dict[str, str]:
    """An identifier for every name, by the name's own letters where that can be: theta' -> theta_dot.

    Args:
        taken: words of the language, and what stands for something else.
        folded: what no two identifiers have in common: of a language without capitals, the small letters.
    """
    chosen: dict[str, str] = {}
    used: set[str] = set()
    for name in names:
        word = identifier(name)[:LONGEST]
        word = word if word[0].isalpha() else f"n{word}"
        if {word, folded(word)} & RESERVED or word in taken or folded(word) in taken or LOCAL.fullmatch(word):
            word += "_"
        unique, number = word, 2
        while folded(unique) in used:
            unique, number = f"{word}_{number}", number + 1
        chosen[name] = unique
        used.add(folded(unique))
    return chosen


def identifier(name: str) -> str:
    """The letters, digits and underscores nearest to a name: 'ω₁' -> 'omega1', 'arm-7' -> 'arm_7'."""
    word = "".join(_plain(letter) for letter in unicodedata.normalize("NFKC", name))
    return f"n{word}" if not word or word[0].isdigit() else word


def stem_of(name: str) -> str:
    """What files and functions of a model are called by, with `_rhs` and the like after it."""
    return identifier(name)[:LONGEST_STEM]


def _plain(letter: str) -> str:
    if letter == "'":
        return "_dot"
    if letter.isascii():
        return letter if letter.isalnum() or letter == "_" else "_"
    spelled = unicodedata.name(letter, "")
    greek = re.fullmatch(r"GREEK (SMALL|CAPITAL) LETTER (?:FINAL )?(\w+)(?: WITH .*)?", spelled)
    if greek:
        word = greek[2].replace("LAMDA", "LAMBDA")
        return word.lower() if greek[1] == "SMALL" else word.capitalize()
    bare = unicodedata.normalize("NFKD", letter)[0]
    return bare if bare.isascii() and bare.isalnum() else f"u{ord(letter):04x}"
