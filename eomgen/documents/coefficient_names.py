"""Equations of motion -> the same with names for large coefficients, where these halve an equation.

I_1*theta'' = M,    I_1 = 1/4*m*r_s^2 + I_s + I_p*r_s^2/(4*r_p^2) + I_c*r_s^2/(4*(r_s + r_p)^2)
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from eomgen.documents.reading import free_names
from eomgen.documents.statements import Equation, Meaning
from eomgen.mechanics.bodies.scope import Scope
from eomgen.model.catalog import Catalog
from eomgen.model.dimensions import inferred
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.expressions import parse
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.print.length import length_of
from eomgen.symbolic.print.symbols import symbol_of
from eomgen.symbolic.print.text import to_text

LARGE = 20  # marks of a coefficient that may have a name
HALF = 0.5  # of an equation's marks, to which the names must bring it
LETTERS = {"kg*m^2": "I", "kg": "m", "N/m": "k"}  # by the unit; of all other coefficients the next
OTHER = "C"


@dataclass(frozen=True)
class NamedCoefficients:
    """Equations in which large coefficients have names.

    Args:
        equations: with the names.
        definitions: (name, what it stands for).
        units: of each name, "" where it is not known.
    """

    equations: tuple[Equation, ...]
    definitions: tuple[tuple[Node, Scalar], ...] = ()
    units: tuple[str, ...] = ()

    @property
    def meanings(self) -> tuple[Meaning, ...]:
        """The names for a table of symbols."""
        pairs = zip(self.definitions, self.units, strict=True)
        return tuple(Meaning(name, "coefficient in the equations of motion", unit) for (name, _), unit in pairs)


def with_coefficients_named(scope: Scope, equations: Sequence[Equation], taken: Collection[str]) -> NamedCoefficients:
    """The equations with a name for each large coefficient of those that become half as long by it.

    Args:
        scope: of the model.
        taken: names that no coefficient may have, nor one that is set like them.
    """
    large: dict[Node, None] = {}
    for equation in equations:
        parts = dict.fromkeys(part for side in (equation.left, equation.right) for part in _constants(side))
        named = substituted((equation.left, equation.right), dict.fromkeys(parts, scope.symbols.t))
        if parts and length_of(*named) + len(parts) <= HALF * length_of(equation.left, equation.right):
            large |= parts
    if not large:
        return NamedCoefficients(tuple(equations))
    units = [_unit(scope, part) for part in large]
    set_as = {symbol_of(name).tex for name in taken}
    names = {letter: free_names(f"{letter}_") for letter in (*LETTERS.values(), OTHER)}
    known: dict[Node, Node] = {}
    for part, unit in zip(large, units, strict=True):
        name = next(n for n in names[LETTERS.get(unit, OTHER)] if symbol_of(n).tex not in set_as)
        known[part] = scope.graph.constant(name)
    sides = [substituted((e.left, e.right), known) for e in equations]
    written = tuple(replace(e, left=left, right=right) for e, (left, right) in zip(equations, sides, strict=True))
    return NamedCoefficients(written, tuple((symbol, part) for part, symbol in known.items()), tuple(units))


def _constants(x: Scalar) -> Iterator[Node]:
    """The largest parts made of parameters alone that are sums or quotients, and long."""
    stack = [x]
    while stack:
        node = stack.pop()
        if type(node) is not Node:
            continue
        if node.op in ("add", "sub", "div") and node.graph.is_constant(node):
            if length_of(node) >= LARGE:
                yield node
        elif node.op in ("add", "sub", "neg", "mul", "div"):
            stack += reversed(node.args)


def _unit(scope: Scope, x: Node) -> str:
    """Of a coefficient, as the model's units and places say; "" where they do not."""
    found = inferred(Catalog(scope.model, ())).names
    text = to_text(x)
    dimension = found.inference.reduced(found.walk().of(parse(text, longest=len(text))))
    return "" if dimension.unknowns else str(dimension)
