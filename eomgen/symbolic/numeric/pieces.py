"""Scalars -> the quantities on which their pieces depend, and the values where one piece ends and the next begins.

A comparison, min, max, abs or sign changes where the difference of its two sides passes 0, samples where their argument
passes one of their places; the root of a square is an absolute value, too. Differences that are equal up to constants
are one quantity with several ends.
With the choice of each made, the scalars are formulas without pieces, which algebra can examine.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Sampled,
    Scalar,
    State,
    depends_on,
    gradient,
    holds_op,
    linear_terms,
    order,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

STEPS = 40  # of Newton's method to a value of a quantity
SHARES = (Fraction(1, 2), Fraction(1, 8), Fraction(7, 8))  # of a piece, where it is entered
BEYOND = (Fraction(1, 2), Fraction(1, 20), Fraction(1, 200))  # of the nearest piece's width, outside of all

COMPARING = ("less", "less_equal", "min", "max")
ABOUT_ZERO = ("abs", "sign")
PIECEWISE = (*COMPARING, *ABOUT_ZERO, "sampled")


def has_pieces(x: Scalar, of: Sequence[Node] | None = None) -> bool:
    """True if a formula consists of several pieces.

    Args:
        of: those count that depend on one of these symbols (None: all).
    """
    if of is None or not holds_op(x, *PIECEWISE):
        return holds_op(x, *PIECEWISE)
    return any(node.op in PIECEWISE and depends_on(node, of) for node in order((x,)))


Choices = tuple[int, ...]
"""Of each node that has pieces: the sign of its argument, or of the difference of both; of samples the place."""


@dataclass(frozen=True)
class Switch:
    """A quantity, and the values of it at which something changes its form.

    Args:
        quantity: what moves.
        ends: what stands still: numbers and parameters.
    """

    quantity: Scalar
    ends: tuple[Scalar, ...]

    def places(self, state: State) -> list[Any]:
        """The ends in ascending order, each once, with the numbers of the state."""
        return sorted(set(evaluate(self.ends, state, fifty_digits())))

    def piece(self, state: State) -> int | None:
        """Index of the piece in which the quantity lies, from 0; None: between two."""
        value = evaluate((self.quantity,), state, fifty_digits())[0]
        places = self.places(state)
        if any(abs(value - end) <= tolerances.COMPUTED * (1 + abs(end)) for end in places):
            return None
        return len([end for end in places if value > end])

    def targets(self, state: State) -> list[list[Any]]:
        """Some values of the quantity inside each piece."""
        places, number = self.places(state), fifty_digits().number
        widths = [b - a for a, b in pairwise(places)] or [1 + abs(places[0])]
        inside = [[a + number(share) * (b - a) for share in SHARES] for a, b in pairwise(places)]
        below = [places[0] - number(share) * widths[0] for share in BEYOND]
        return [below, *inside, [places[-1] + number(share) * widths[-1] for share in BEYOND]]

    def moved(self, state: State, value: Any, moving: frozenset[Node]) -> State | None:
        """The nearest state at which the quantity has that value; None where Newton's method finds none.

        Raises:
            NoValue: the quantity has none on the way.
        """
        free = [x for x in symbols_of((self.quantity,)) if x in moving]
        slopes = gradient(self.quantity, free)
        for _ in range(STEPS):
            now, *slope = evaluate((self.quantity, *slopes), state, fifty_digits())
            if abs(value - now) <= tolerances.CERTAIN_AT_50 * (1 + abs(value)):
                return state
            square = sum(x * x for x in slope)
            if square == 0:
                return None
            state = state | {x: state[x] + s * (value - now) / square for x, s in zip(free, slope, strict=True)}
        return None


@dataclass(frozen=True)
class PiecewiseNodes:
    """Nodes whose form changes with something that moves, in the order of evaluation."""

    nodes: tuple[Node, ...]

    @staticmethod
    def of(scalars: Iterable[Scalar], moving: frozenset[Node]) -> PiecewiseNodes:
        """Nodes of some scalars, as of what moves."""
        nodes = order(filter(has_pieces, scalars))
        active = _active(nodes, moving)
        return PiecewiseNodes(tuple(x for x in nodes if (x.op in PIECEWISE or _base(x) is not None) and x in active))

    @staticmethod
    def all_of(scalars: Iterable[Scalar]) -> tuple[Node, ...]:
        """Every node of some scalars that has one of several forms, or is one of two cases."""
        return tuple(x for x in order(scalars) if x.op in PIECEWISE or x.op == "select")

    def choices_at(self, state: State) -> Choices | None:
        """The choice of each node at a state; None where it lies between two pieces of one.

        A node without a value, in a case that does not hold there, chooses 0: nothing.
        """
        values = evaluate(
            [side for x in self.nodes for side in PiecewiseNodes.compared_sides(x)], state, fifty_digits(partial=True)
        )
        found: list[int] = []
        for x, a, b in zip(self.nodes, values[::2], values[1::2], strict=True):
            if a != a or b != b:
                found.append(0)
                continue
            digits = fifty_digits()
            ends = [*Sampled.of(x.args[1]).ends(digits.functions["pi"](), digits.number)] if x.op == "sampled" else [b]
            if any(abs(a - end) <= tolerances.CERTAIN_AT_50 * (1 + abs(end)) for end in ends):
                return None
            passed = len([end for end in ends if a > end])
            found.append(passed if x.op == "sampled" else 2 * passed - 1)
        return tuple(found)

    def chosen(self, scalars: Sequence[Scalar], choices: Choices) -> tuple[Scalar, ...]:
        """The scalars as they are where the nodes choose so: without pieces.

        Raises:
            DerivationError: they divide by zero there.
        """
        chosen = dict(zip(self.nodes, choices, strict=True))
        known: dict[Node, Scalar] = {}
        for x in order(scalars):
            if x.op == "sampled" and x in chosen:
                known[x] = _polynomial_of(
                    Sampled.of(x.args[1]), chosen[x], substituted(x.args[:1], known)[0], x.graph.pi
                )
            elif chosen.get(x):
                known[x] = _as_chosen(x, chosen[x], substituted(PiecewiseNodes.compared_sides(x), known))
            elif x.op == "select":
                condition = substituted(x.args[:1], known)[0]
                if type(condition) is not Node:
                    known[x] = substituted((x.args[1] if condition else x.args[2],), known)[0]
        return substituted(tuple(scalars), known) if known else tuple(scalars)

    @staticmethod
    def compared_sides(x: Node) -> tuple[Scalar, Scalar]:
        """The two sides that are compared where x chooses; of samples their argument and 0."""
        if x.op in COMPARING:
            return x.args[0], x.args[1]
        base = _base(x)
        return x.args[0] if base is None else base, 0


def _base(x: Node) -> Scalar | None:
    """y of sqrt(y^2), which is |y|; None of anything else."""
    inside = x.args[0] if x.op == "sqrt" else None
    if type(inside) is not Node:
        return None
    if inside.op == "mul" and inside.args[0] is inside.args[1]:
        base: Scalar = inside.args[0]
        return base
    return inside.args[0] if inside.op == "pow" and inside.args[1] == 2 else None


def _as_chosen(x: Node, choice: int, sides: Sequence[Scalar]) -> Scalar:
    """A node with its choice made."""
    if x.op == "sign":
        return choice
    if x.op in ("abs", "sqrt"):
        return choice * sides[0]
    if x.op in ("less", "less_equal"):
        return int(choice < 0)
    return sides[0] if (x.op == "min") is (choice < 0) else sides[1]


def _polynomial_of(sampled: Sampled, piece: int, t: Scalar, pi: Node) -> Scalar:
    """The polynomial of one piece of the samples."""
    t = sampled.measured(t, pi)
    s, found = t - sampled.spline.origins[piece], 0 * t
    for c in reversed(sampled.spline.pieces[piece]):
        found = found * s + c
    for _ in range(abs(sampled.pi_power)):
        found = found * pi if sampled.pi_power > 0 else found / pi
    return found


def _active(nodes: Sequence[Node], moving: frozenset[Node]) -> set[Any]:
    """The nodes that depend on something that moves."""
    active: set[Any] = set(moving)
    for x in nodes:
        if x.op != "symbol" and any(type(a) is Node and a in active for a in x.args):
            active.add(x)
    return active


def switches_of(scalars: Iterable[Scalar], moving: frozenset[Node]) -> tuple[Switch, ...]:
    """Every switch in the scalars that something that moves can throw."""
    nodes = order(filter(has_pieces, scalars))
    active = _active(nodes, moving)
    found: dict[tuple[tuple[int, Any], ...], tuple[Scalar, dict[Scalar, None]]] = {}
    for x in nodes:
        for terms, ends in _thrown_by(x):
            parts = sorted(((y, c) for y, c in terms.items() if y in active), key=lambda part: part[0].index)
            if not parts:
                continue
            first = Fraction(parts[0][1])
            still = sum((c if y is None else c * y for y, c in terms.items() if y not in active), start=0)
            key = tuple((y.index, Fraction(c) / first) for y, c in parts)
            quantity = sum(((Fraction(c) / first) * y for y, c in parts), start=0)
            _, known = found.setdefault(key, (quantity, {}))
            known |= dict.fromkeys((end - still) * (1 / first) for end in ends)
    return tuple(Switch(quantity, tuple(ends)) for quantity, ends in found.values())


def _thrown_by(x: Node) -> Iterator[tuple[dict[Any, Any], Sequence[Scalar]]]:
    """(terms, the values of their sum at which x changes its form)."""
    if x.op in COMPARING:
        yield linear_terms(x.args[0] - x.args[1]), (0,)
    elif x.op in ABOUT_ZERO or _base(x) is not None:
        yield linear_terms(PiecewiseNodes.compared_sides(x)[0]), (0,)
    elif x.op == "sampled":
        yield linear_terms(x.args[0]), Sampled.of(x.args[1]).ends(x.graph.pi)
