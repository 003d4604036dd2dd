"""A long Layout -> Parts: a compiler's time grows faster than the length of one function.

What one part computes and another reads, or the function that calls them, stands in an array between them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from eomgen.codegen.targets.base import Layout
from eomgen.symbolic.expression.graph import Node, Scalar

LONG = 4000  # operations from which on a program is cut: in one function they take a compiler a second
LENGTH = 600  # operations of a part


@dataclass(frozen=True)
class Parts:
    """A program cut into pieces; none where it is short.

    Args:
        before, after: the nodes of each piece, before and after the solve.
        places: of what a piece reads that it does not compute, symbols of inputs and unknowns among it, the place in
            the array.
    """

    before: tuple[tuple[Node, ...], ...] = ()
    after: tuple[tuple[Node, ...], ...] = ()
    places: dict[Node, int] | None = None

    @property
    def all(self) -> tuple[tuple[Node, ...], ...]:
        return self.before + self.after

    def names(self, array: str, without: Sequence[Node] = ()) -> dict[Node, str]:
        """How the array's entries are written, but for what is computed here."""
        own = frozenset(without)
        return {x: f"{array}[{place}]" for x, place in (self.places or {}).items() if x not in own}


def program_parts(bodies: Layout) -> Parts:
    """The pieces of a layout."""
    if len(bodies.before) + len(bodies.after) <= LONG:
        return Parts()
    before, after = _cut(bodies.before), _cut(bodies.after)
    program, solve = bodies.program, bodies.solve
    home = {x: i for i, part in enumerate(before + after) for x in part}
    given = [*program.symbols.inputs.values(), *(solve.unknowns if solve else ())]
    home |= dict.fromkeys(given, -1)
    read = _across(home, before + after, (*(solve.entries if solve else ()), *program.outputs))
    return Parts(before, after, {x: place for place, x in enumerate(x for x in home if x in read)})


def _cut(nodes: tuple[Node, ...]) -> tuple[tuple[Node, ...], ...]:
    return tuple(nodes[i : i + LENGTH] for i in range(0, len(nodes), LENGTH))


def _across(home: dict[Node, int], parts: Sequence[Sequence[Node]], written: Sequence[Scalar]) -> set[Node]:
    """What is read elsewhere than where it is computed, signs looked through."""
    reads = [(i, a) for i, part in enumerate(parts) for node in part for a in node.args]
    reads += [(len(parts), x) for x in written]
    found = set()
    for i, x in reads:
        if type(x) is Node:
            x = x.args[0] if x.op == "neg" else x
            if home.get(x, i) != i:
                found.add(x)
    return found
