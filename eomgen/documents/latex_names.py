"""Names of a document -> LaTeX: those that a model declares, else by their own letters, each told from the others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import field, replace

from eomgen.documents.statements import Law
from eomgen.model.parts import Model
from eomgen.records import dataclass
from eomgen.symbolic.print.symbols import LETTERS, Symbol, index_latex, symbol_of, upright

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
_MULTIPLIER = re.compile(r"lam\((?P<tie>.*), (?P<row>\d+)\)")


@dataclass(frozen=True)
class Notation:
    """How the names of a model are set.

    Args:
        symbols: the symbols that are declared, by name without primes.
        indices: how bodies and ties are called in an index, where they declare it.
    """

    symbols: Mapping[str, Symbol] = field(default_factory=dict)
    indices: Mapping[str, str] = field(default_factory=dict)

    def with_symbols(self, symbols: Mapping[str, Symbol]) -> Notation:
        """With more of them, the model's own first."""
        return replace(self, symbols={**symbols, **self.symbols})

    def latex(self, name: str) -> str:
        """A symbol of the formulas, dots and index included."""
        multiplier = _MULTIPLIER.fullmatch(name)
        if multiplier:
            return rf"\lambda_{{{self.index(multiplier['tie'])},{multiplier['row']}}}"
        bare = name.rstrip("'")
        symbol = self.symbols.get(bare) or symbol_of(bare, self.indices)
        return symbol.dotted(len(name) - len(bare))

    def index(self, name: str) -> str:
        """The name of a body, a tie, a force or a point as an index: bar, or what it declares; bar.end."""
        owner, dot, point = name.partition(".")
        found = self.indices.get(owner) or index_latex(owner)
        return f"{found}{dot}{index_latex(point)}" if dot else found

    def told_apart(self, names: Iterable[str]) -> Notation:
        """With every name set by itself: where two would look alike (theta1, theta_1) the later one is spelt out."""
        bare = list(dict.fromkeys(name.rstrip("'") for name in names))
        taken: dict[str, str] = {}
        spelt: dict[str, Symbol] = {}
        for name in sorted(bare, key=lambda name: name not in self.symbols):  # those that are declared keep theirs
            if taken.setdefault(self.latex(name), name) != name and name not in self.symbols:
                spelt[name] = Symbol(name, upright(name))
        return replace(self, symbols={**self.symbols, **spelt})


def notation_of(model: Model) -> Notation:
    """What a model declares of it."""
    tables = (model.parameters, model.coordinates, model.speeds, model.inputs, model.unknowns)
    symbols = {name: part.symbol for table in tables for name, part in table.items() if part.symbol is not None}
    indices = {name: body.symbol.tex for name, body in model.bodies.items() if body.symbol is not None}
    ties = {name: tie.symbol.letter for name, tie in model.constraints.items() if tie.symbol is not None}
    return Notation(symbols, indices | {name: letter.tex for name, letter in ties.items() if letter is not None})


def letter_law(text: str) -> Law:
    """A letter, with an index or without: v_x, J_xy, omega."""
    return Law(text, symbol_of(text).tex)


def latex_escaped(text: str) -> str:
    """Plain text for LaTeX outside formulas."""
    return "".join(rf"${LETTERS[c]}$" if c in LETTERS else SPECIAL.get(c, c) for c in text)
