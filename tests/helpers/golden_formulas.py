"""tests/golden/textbook.toml -> each formula of an author beside ours: typeset, how long, and whether they agree.

python tests/helpers/golden_formulas.py       a table of all, the longest ratio first
"""

from __future__ import annotations

import re
import statistics
import tomllib
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from derivations import PATHS, answers, equations

import eomgen
from eomgen import Equations, Output
from eomgen.documents.latex import setter_of, side_latex, with_listings_typeset
from eomgen.documents.statements import Formula, Side
from eomgen.documents.text import side_text
from eomgen.questions.outputs_answered import Answers
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivatives import derivative, substituted
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node, Scalar, is_zero
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.print.latex import Notation, Setter
from eomgen.symbolic.print.length import length_of_latex

ROOT = Path(__file__).parents[2]
LIST = ROOT / "tests/golden/textbook.toml"
PLACED = re.compile(r"\\(?:d?dot|left|right|frac|mathrm)(?![a-z])|\\,")
LETTER = re.compile(r"(\\[A-Za-z]+|[A-Za-z])(?:_(\{+\w+\}+|\w))?")
OWN = "textbook/"  # how a model begins that was written for the list


@dataclass(frozen=True)
class Golden:
    """A formula as an author prints it; the head of the list says what each key means."""

    name: str
    source: str
    model: str
    requests: str
    author: str
    text: str
    above: str = ""

    @property
    def path(self) -> Path:
        folder = LIST.parent if self.model.startswith(OWN) else ROOT / "models"
        return folder / f"{self.model}.toml"


@dataclass(frozen=True)
class Ours:
    """The same formula by eomgen: typeset, and as text of the grammar."""

    latex: str
    text: str


@dataclass(frozen=True)
class Compared:
    """Both, and how long they are in visible marks."""

    golden: Golden
    ours: Ours

    @property
    def lengths(self) -> tuple[int, int]:
        return length_of_latex(self.ours.latex), length_of_latex(self.golden.author)

    @property
    def ratio(self) -> float:
        ours, his = self.lengths
        return ours / his


@cache
def golden_formulas() -> tuple[Golden, ...]:
    """The list, in its order."""
    return tuple(Golden(**entry) for entry in tomllib.loads(LIST.read_text(encoding="utf-8"))["formula"])


@cache
def compared(formulas: Sequence[Golden] = ()) -> tuple[Compared, ...]:
    """These formulas beside ours; without any all."""
    return tuple(Compared(golden, ours_of(golden)) for golden in formulas or golden_formulas())


def ours_of(golden: Golden) -> Ours:
    """What eomgen prints for what is asked."""
    kind, _, name = golden.requests.partition(" ")
    return REQUESTED[kind](golden.path, name)


def _equation(path: Path, name: str) -> Ours:
    derivation = _derived(path).derivation
    (sides,) = [(e.left, e.right) for e in derivation.equations if e.speed.name in (name, f"{name}'")]
    return _joined(setter_of(derivation), substituted(sides, dict(derivation.definitions)))  # as if it had no names


def _formula(path: Path, left: str) -> Ours:
    derivation = _derived(path).derivation
    named = dict(derivation.definitions)  # as if it had no names
    statements = [statement for step in derivation.steps for statement in step.statements]
    found = [s.sides[1] for s in statements if isinstance(s, Formula) and side_text(s.sides[0]) == left]
    assert found, f"{path.stem}: the derivation has no formula for {left}"
    return _joined(setter_of(derivation), [substituted((x,), named)[0] if type(x) is Node else x for x in found[:1]])


def _output(path: Path, name: str) -> Ours:
    exact = _answered(path)[name].exact
    assert exact is not None, f"{path.stem}: no formula for {name}"
    setter = setter_of(with_listings_typeset(_answered(path).derivation))
    return Ours(side_latex(setter, read(Graph(), exact)[0]), exact)


def _reaction(path: Path, name: str) -> Ours:
    text = _derived_data(path)["reactions"][name]
    return Ours(side_latex(setter_of(_derived(path).derivation), read(Graph(), text)[0]), text)


REQUESTED: dict[str, Callable[[Path, str], Ours]] = {
    "equation": _equation,
    "formula": _formula,
    "output": _output,
    "reaction": _reaction,
}


def _joined(setter: Setter, sides: Sequence[Side]) -> Ours:
    texts, formulas = map(side_text, sides), [side_latex(setter, side) for side in sides]
    return Ours(" = ".join(formulas), " = ".join(texts))


@cache
def _derived(path: Path) -> Equations:
    return equations(path.stem) if path in PATHS else eomgen.derive(eomgen.load(path))


@cache
def _derived_data(path: Path) -> dict[str, Any]:
    return _derived(path).as_dict()


@cache
def _answered(path: Path) -> Answers:
    return answers(path)


def read(graph: Graph, text: str) -> tuple[Scalar, list[str]]:
    expression = parse(text, longest=len(text))
    names = [name for kind, name in expression.code if kind == "name"]
    value: Scalar = expression.evaluate({name: graph.symbol(name) for name in names} | {"pi": graph.pi})
    return value, names


def agrees(golden: Golden, ours: Ours) -> bool:
    """Whether both say the same: equal at random exact states; an equation of motion up to a factor.

    a_1 f_2 = a_2 f_1 with f = left - right and a = df/dq'' of an acceleration that stands in both. What else holds
    accelerations is compared with those of the motion in their place.
    """
    graph = Graph()
    if not golden.requests.startswith("equation"):
        texts = (golden.text, ours.text)
        if any("''" in text for text in texts):
            texts = _along_the_motion(golden, texts)
        his, mine = (read(graph, text)[0] for text in texts)
        return equal_at_random_states([(his, mine)]).equal
    (his, names), (mine, _) = _residual(graph, golden.text), _residual(graph, ours.text)
    speed = golden.requests.split()[1]
    acceleration = graph.symbol(next(n for n in (f"{speed}''", f"{speed}'") if n in names))
    a_1, a_2 = derivative(his, acceleration), derivative(mine, acceleration)
    assert not is_zero(a_1), golden.name
    return equal_at_random_states([(a_1 * mine, a_2 * his)]).equal


def _along_the_motion(golden: Golden, texts: tuple[str, str]) -> tuple[str, str]:
    """The texts, their accelerations replaced by the equations of motion."""
    requested = {f"asked_{k}": Output(value=text) for k, text in enumerate(texts)}
    his, mine = (found.exact for found in eomgen.solve(replace(eomgen.load(golden.path), outputs=requested)).values())
    assert his is not None and mine is not None, golden.name
    return his, mine


def _residual(graph: Graph, equation: str) -> tuple[Node, list[str]]:
    (left, of_left), (right, of_right) = (read(graph, side) for side in equation.split("="))
    residual = left - right
    assert isinstance(residual, Node)
    return residual, [*of_left, *of_right]


def letters_of_latex(latex: str) -> Counter[str]:
    """How often each letter stands in a formula, with its index: {"m_2": 1, "theta_1": 3}; functions by their names."""
    found = (found.groups() for found in LETTER.finditer(PLACED.sub("", latex)))
    return Counter("_".join((letter.strip("\\"), *([index.strip("{}")] if index else []))) for letter, index in found)


def letters_of_text(text: str) -> Counter[str]:
    """The same of a text of the grammar."""
    total: Counter[str] = Counter()
    for side in text.split("="):
        for kind, what in parse(side).code:
            if kind == "function":
                total[what[0]] += 1
            elif kind == "name":
                total += letters_of_latex(Notation().latex(what.rstrip("'")))
    return total


def table() -> str:
    """All formulas, the longest ratio first, as Markdown."""
    rows = sorted(compared(), key=lambda row: -row.ratio)
    ratios = [row.ratio for row in rows]
    lines = [
        f"{len(rows)} formulas, median {statistics.median(ratios):.3f}, above 1.3: {sum(x > 1.3 for x in ratios)}",
        "",
        "| ratio | ours | his | formula | ours, typeset | the author's |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        mark = "" if agrees(row.golden, row.ours) else " **NOT EQUAL**"
        ours, his = row.lengths
        where = f"{row.golden.name} ({row.golden.model}, {row.golden.requests}){mark}"
        lines.append(f"| {row.ratio:.2f} | {ours} | {his} | {where} | `{row.ours.latex}` | `{row.golden.author}` |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
