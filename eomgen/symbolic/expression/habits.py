"""What hands write out of habit from other notations, and how it is written here: the mends of errors."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container, Iterable

from eomgen.symbolic.expression.functions import NAMES
from eomgen.symbolic.expression.rational import fraction_of

DEGREES = ("deg", "degree", "degrees", "grad", "Grad")
RATES = {  # functions and ends of names that stand for dots: how many
    "diff": 1,
    "Derivative": 1,
    "der": 1,
    "dot": 1,
    "ddot": 2,
}
SLOPE = "slope_of"  # what dT/dq' is read as: slope_of(T, q'), of an energy by a coordinate or its rate
_ENDS = (("_ddot", 2), ("_dotdot", 2), ("ddot", 2), ("_dot", 1), ("dot", 1), ("_dd", 2), ("_d", 1))
_NUMBER = r"\d+(?:\.\d*)?(?:[eE][-+]?\d+)?|\.\d+"
_COMMA = re.compile(r"(\d+)\s*,\s*(\d+)")
_POWER = re.compile(r"(\w+)\s*(?:\^|\*\*)\s*(\d+)\s*$")
_DEGREES = re.compile(rf"({_NUMBER})\s*(?:\*?\s*(?:{'|'.join(DEGREES)})(?!\w)|°)")
_WITH_UNIT = re.compile(rf"\s*([-+]?(?:{_NUMBER}))(?:\s+([A-Za-z][\w^*/]*)|(kg|mm|cm|kN|N|deg|rad|rpm))\s*")
_OF_TIME = re.compile(r"\s*(\w+)\s*\(\s*t\s*\)")
_POW = re.compile(r"\s*pow\(\s*(\w+)\s*,\s*(\w+)\s*\)")
_RATE = re.compile(
    rf"\s*({'|'.join(RATES)})\(\s*(\w+)\s*(?:\(\s*t\s*\)\s*)?(?:,\s*\(?\s*t\s*(?:,\s*([12t])\s*)?\)?\s*)?\)"
)


def spelled(letter: str) -> str:
    """A Greek letter by its name ("theta"), "" of others."""
    found = re.fullmatch(r"GREEK (SMALL|CAPITAL) LETTER (?:FINAL )?([A-Z]+)(?: WITH .*)?", unicodedata.name(letter, ""))
    return "" if found is None else found[2].lower() if found[1] == "SMALL" else found[2].capitalize()


def invisible(character: str) -> str:
    """The mend of what cannot be told from a blank, or from nothing; "" of what is seen."""
    if character in ("", "\n", "\t", " ") or (character.isprintable() and not character.isspace()):
        return ""
    return f"a character that is not seen stands there, U+{ord(character):04X}: write a plain blank, or nothing"


def plainly(character: str) -> str:
    """The mend of a character that stands for a plain one; "" of others."""
    plain = unicodedata.normalize("NFKC", character)
    return f"write {plain}" if plain.isascii() and plain != character and plain.strip() else invisible(character)


def two_values(text: str, place: int) -> str:
    """The mend where two values stand side by side, the second at a place; "" for what is no habit."""
    power = _POWER.search(text, 0, place)
    if power is not None and power[1] in NAMES and text[place] == "(":
        return f"write {power[1]}{_in_parentheses(text, place)}^{power[2]}"
    if mend := degrees(text):
        return mend
    given = _WITH_UNIT.fullmatch(text)
    if given is not None:
        value, unit = given[1], given[2] or given[3]
        return f'with a unit it is {{ value = {value}, unit = "{unit}" }}, as a product {value}*{unit}'
    return ""


def degrees(text: str) -> str:
    """The mend of an angle in degrees: "angles are in rad here: write pi/2", or ""."""
    found = _DEGREES.search(text)
    if found is None:
        return ""
    share = fraction_of(found[1]) / 180
    above = "pi" if share.numerator == 1 else f"{share.numerator}*pi"
    return f"angles are in rad here: write {above}{'' if share.denominator == 1 else f'/{share.denominator}'}"


def decimal_comma(text: str, place: int) -> str:
    """The mend of a comma in a number, or ""."""
    found = next((each for each in _COMMA.finditer(text) if each.start() <= place < each.end()), None)
    return "" if found is None else f"write a decimal point: {found[1]}.{found[2]}"


def called_rate(text: str) -> tuple[str, int, int] | None:
    """(phi, how many dots, where it ends) of diff(phi, t), ddot(phi); None of others."""
    found = _RATE.match(text)
    return None if found is None else (found[2], max(RATES[found[1]], 2 if found[3] in ("2", "t") else 1), found.end())


def rate_of_call(text: str) -> str:
    """The mend of diff(phi, t), ddot(phi), phi(t) or pow(phi, 2), or ""."""
    if of_time := _OF_TIME.match(text):
        return f"write {of_time[1]}: what moves depends on t by itself"
    if power := _POW.match(text):
        return f"write {power[1]}^{power[2]}"
    found = called_rate(text)
    return "" if found is None else f"write {found[0]}{chr(39) * found[1]}"


def meant_name(name: str, allowed: Container[str]) -> str:
    """What may stand there for phi_dot (phi'), π (pi), θ (theta); "" for what is no habit."""
    for end, dots in _ENDS:
        rate = name.removesuffix(end) + "'" * dots
        if name.endswith(end) and rate in allowed:
            return rate
    if re.fullmatch(r"dd?\w+", name):
        dots = 2 if name.startswith("dd") else 1
        if name[dots:] + "'" * dots in allowed:
            return name[dots:] + "'" * dots
    latin = "".join(spelled(c) or c for c in name)
    return latin if latin != name and latin in allowed else ""


WORDS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("parent", "base", "attached_to", "connected_to", "frame"), ("on",)),
    **dict.fromkeys(("type", "class"), ("kind",)),
    **dict.fromkeys(("value", "initial", "init", "x0", "q0", "initial_value"), ("start",)),
    **dict.fromkeys(("velocity", "initial_velocity", "v0"), ("speed",)),
    **dict.fromkeys(("units",), ("unit",)),
    **dict.fromkeys(("description", "comment", "note", "remark"), ("about",)),
    **dict.fromkeys(("hinge", "rotation", "rotary", "rotational", "rotate", "pivot"), ("revolute",)),
    **dict.fromkeys(("slider", "linear", "sliding", "translation", "translational", "slide", "rail"), ("prismatic",)),
    **dict.fromkeys(("ball", "ball_joint", "ball_and_socket"), ("spherical",)),
    **dict.fromkeys(("weld", "welded", "rigid", "clamped"), ("fixed",)),
    **dict.fromkeys(("cardan", "hooke"), ("universal",)),
    **dict.fromkeys(("bar", "beam", "stick"), ("rod",)),
    **dict.fromkeys(("disk", "wheel"), ("disc",)),
    **dict.fromkeys(("point", "point_mass", "mass_point"), ("particle",)),
    **dict.fromkeys(("cuboid", "block", "brick"), ("box",)),
    **dict.fromkeys(("hoop", "circle"), ("ring",)),
    **dict.fromkeys(("dashpot",), ("damper",)),
    **dict.fromkeys(("weight",), ("gravity",)),
    **dict.fromkeys(("rope", "cable", "cord"), ("string",)),
    **dict.fromkeys(("ln", "loge"), ("log",)),
    **dict.fromkeys(("run", "integrate", "animate", "ode"), ("simulate",)),
    "reaction": ("reaction_x", "reaction_y", "reaction_z"),
    "velocity": ("speed", "vx", "vy", "vz"),
    "acceleration": ("ax", "ay", "az"),
    "position": ("x", "y", "z"),
    "angular_velocity": ("omega",),
    "kinetic": ("kinetic_energy",),
    "potential": ("potential_energy",),
}
"""what a thing is called elsewhere -> what it is called here"""


def other_words(word: str, known: Iterable[str]) -> tuple[str, ...]:
    """What a word of other programs is called here, among what is known."""
    there = set(known)
    return tuple(each for each in WORDS.get(word.lower(), ()) if each in there)


def _in_parentheses(text: str, start: int) -> str:
    """From an opening parenthesis to the one that closes it, or to the end."""
    depth = 0
    for k in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[k], 0)
        if depth == 0:
            return text[start : k + 1]
    return f"{text[start:]})"
