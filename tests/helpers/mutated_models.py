"""All shipped models, changed as a careless hand, a broken editor or a stranger would; and what loading must keep."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from random import Random

from cpu_limit import TooLong, cpu_limit, within_cpu
from fuzzed_expressions import PIECES, damaged, tree, written

from eomgen.errors import ModelError
from eomgen.model import constraints, forces, joints, shapes
from eomgen.model.reader import loads

MODELS = sorted((Path(__file__).parents[2] / "models").rglob("*.toml"))
SECONDS = 3.0  # of CPU for one file
SEAMS = (joints, forces, constraints, shapes)
TEXTS = (
    '"',
    "'",
    "[",
    "]",
    "{",
    "}",
    "=",
    ".",
    "\n",
    "\\",
    '"""',
    "[[",
    "nan",
    "''",
    "#",
    "-",
    "^",
    "1e9",
    "\ufeff",
    "\0",
)
NUMBERS = (
    "0",
    "-1",
    "1e300",
    "1e-300",
    "-0.0",
    "1e400",
    "nan",
    "-inf",
    "1_000",
    "0x10",
    "007",
    "3,5",
    "1/3",
    "9" * 400,
)
NUMBERS += ("1e9", "1e-9", "2", "-2.5", "0.1", "100", '"pi/2"', '"1/3"', '"2^0.5"', '"t"')
VALUES = ("0", "-1", '""', '"x"', "true", "[]", "[1]", "[[1]]", "{}", "{ a = 1 }", '{ kind = "rod" }', "2020-01-01")
VALUES += ('"1/0"', '"a.b.c"', '"."', '"-"', '"t"', '"pi"', "[1, 2, 3, 4, 5, 6, 7]", '{ value = "x", unit = "deg" }')
VALUES += ('"sqrt(-1)"', '"log(0)"', '["", ""]', "[0, 0]", "[0, 0, 0]", '{ value = 1, unit = "m" }', "1e400", "nan")
UNITS = (
    "m",
    "kg",
    "s",
    "deg",
    "rad",
    "rpm",
    "N",
    "kN*m",
    "m/s^2",
    "1",
    "",
    "kgs",
    "m/",
    "rad/s",
    "mm",
    "kg*m^2",
    "furlong",
)
WORD = re.compile(r"[^\W\d]\w*'*")
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])")
STRING = re.compile(r'"[^"\n]*"')


@cache
def texts() -> tuple[str, ...]:
    """The models as they are shipped."""
    return tuple(path.read_text(encoding="utf-8") for path in MODELS)


@cache
def kinds() -> tuple[str, ...]:
    """Every kind of joint, force, constraint and shape."""
    return tuple(member.kind for seam in SEAMS for member in seam.ALL)


def _swap(text: str, found: list[re.Match[str]], new: Callable[[str], str], rng: Random) -> str:
    if not found:
        return text
    match = rng.choice(found)
    return text[: match.start()] + new(match[0]) + text[match.end() :]


def a_number(text: str, rng: Random) -> str:
    return _swap(text, list(NUMBER.finditer(text)), lambda _: rng.choice(NUMBERS), rng)


def a_word(text: str, rng: Random) -> str:
    """One word becomes another of the same model."""
    found = list(WORD.finditer(text))
    return _swap(text, found, lambda _: rng.choice(found)[0], rng)


def a_letter(text: str, rng: Random) -> str:
    """A word is mistyped."""

    def mistyped(word: str) -> str:
        k = rng.randrange(len(word))
        return rng.choice(
            (word[:k] + word[k + 1 :], word[:k] + word[k] + word[k:], word.upper(), word + "'", word + "s")
        )

    return _swap(text, list(WORD.finditer(text)), mistyped, rng)


def a_formula(text: str, rng: Random) -> str:
    """A text in quotes becomes another formula, of names of the model."""
    names = sorted({match[0] for match in WORD.finditer(text)})

    def formula(old: str) -> str:
        new = written(tree(rng, rng.randint(0, 3)), rng)
        new = re.sub(r"\b(x|y|I|theta'?)(?![\w(])", lambda _: rng.choice(names), new)
        return rng.choice((f'"{new}"', f'"{old[1:-1]} + {new}"', f'"({old[1:-1]})*({new})"', f'"-({old[1:-1]})"'))

    return _swap(text, list(STRING.finditer(text)), formula, rng)


def a_damaged_text(text: str, rng: Random) -> str:
    """A text in quotes gets pieces that do not belong there."""
    return _swap(text, list(STRING.finditer(text)), lambda old: f'"{damaged(old[1:-1], rng)}"', rng)


def a_kind(text: str, rng: Random) -> str:
    found = list(re.finditer(r'(?<=kind = )"\w+"', text))
    return _swap(text, found, lambda _: f'"{rng.choice(kinds())}"', rng)


def a_unit(text: str, rng: Random) -> str:
    found = list(re.finditer(r'(?<=unit = )"[^"]*"', text))
    return _swap(text, found, lambda _: f'"{rng.choice(UNITS)}"', rng)


def a_value(text: str, rng: Random) -> str:
    """What stands behind an = becomes a value of another kind."""
    found = list(re.finditer(r"(?<= = )(?:\[[^\]\n]*\]|\"[^\"\n]*\"|[\w.+-]+)", text))
    return _swap(text, found, lambda _: rng.choice(VALUES), rng)


def lines(text: str, rng: Random) -> str:
    """A line goes, comes twice, elsewhere, or from another model."""
    rows = text.split("\n")
    i, j = rng.randrange(len(rows)), rng.randrange(len(rows))
    what = rng.randrange(4)
    if what == 0:
        del rows[i]
    elif what == 1:
        rows.insert(j, rows[i])
    elif what == 2:
        rows[i], rows[j] = rows[j], rows[i]
    else:
        rows.insert(i, rng.choice(rng.choice(texts()).split("\n")))
    return "\n".join(rows)


def a_table(text: str, rng: Random) -> str:
    """A table goes, or one of another model comes."""
    tables = re.split(r"(?m)^(?=\[)", text)
    if rng.random() < 0.5 and len(tables) > 1:
        del tables[rng.randrange(1, len(tables))]
    else:
        others = re.split(r"(?m)^(?=\[)", rng.choice(texts()))[1:]
        tables.insert(rng.randint(1, len(tables)), rng.choice(others))
    return "".join(tables)


def the_space(text: str, rng: Random) -> str:
    return text.replace('"plane"', '"SPACE"').replace('"space"', '"plane"').replace('"SPACE"', '"space"')


def a_piece(text: str, rng: Random) -> str:
    """A stretch of characters goes, comes twice or is replaced by what does harm."""
    a = rng.randrange(len(text) + 1)
    b = min(len(text), a + rng.randint(0, 40))
    return text[:a] + rng.choice((rng.choice(TEXTS), rng.choice(PIECES), text[a:b] * 2, "")) + text[b:]


HARMLESS = (a_number, a_word, a_formula, a_kind, a_unit, lines, a_table, the_space)
"""after these a model often still loads"""
ALL = (*HARMLESS, a_letter, a_damaged_text, a_value, a_piece)


def mutated(rng: Random, ways: tuple[Callable[[str, Random], str], ...] = ALL) -> str:
    """A shipped model after one to three changes."""
    text = rng.choice(texts())
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        text = rng.choice(ways)(text, rng)
    return text


def loadable(rng: Random, longest: int) -> str:
    """A changed model that still loads, and is no longer than so many characters."""
    while True:
        text = mutated(rng, HARMLESS)
        try:
            with cpu_limit(SECONDS):
                if len(text) <= longest and loads(_bytes(text)):
                    return text
        except (Exception, TooLong):  # whatever is wrong with loading is found by loads alone
            continue


def broken_law(text: str) -> str:
    """The law that loading a text breaks, in words; "" where it keeps them all."""
    try:
        within_cpu(SECONDS, lambda: loads(_bytes(text), name="m"))
    except ModelError as error:
        return _reported(error, text)
    except TooLong:
        return f"a file is read in less than {SECONDS} s of CPU"
    except Exception as error:
        return f"only EomgenError leaves the reader: {type(error).__name__}: {error}"
    return ""


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _reported(error: ModelError, text: str) -> str:
    """Each problem has a place in the file, a sentence, and stands there once."""
    problems = error.problems
    if not problems:
        return "a model that is refused is told why"
    for problem in problems:
        place = re.fullmatch(r"m:(\d+):(\d+)", problem.where)
        if problem.what.endswith("more problems"):
            continue
        if place is None or not 1 <= int(place[1]) <= text.count("\n") + 2 or not problem.what:
            return f"each problem has its place: {problem.where!r}: {problem.what}"
    if len({(p.where, p.what) for p in problems}) < len(problems):
        return f"nothing is told twice: {problems[0]}"
    return ""
