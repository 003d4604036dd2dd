"""Equations between coordinates -> the coordinates in closed form, branches chosen by numbers found before.

Three ways, again and again: an equation in one coordinate is solved; one that is linear in a coordinate, or that can be
solved for it, gives it as a function of others; and of two equations of a loop,

    a1 cos q + b1 sin q + r1 = 0,   a2 cos q + b2 sin q + r2 = 0,

q is eliminated by cos^2 + sin^2 = 1.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import combinations

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.exact import has_period, roots, simplest, vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    cos,
    depends_on,
    derivative,
    order,
    over,
    sin,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, Work, evaluate, tolerances
from eomgen.symbolic.print import text_size

PAGE = 1000  # characters of a root, and of an equation of a loop that is solved for one
SHORT = 40  # characters of a root that is put into other equations first


@dataclass(frozen=True)
class Located:
    """A state in numbers, by which exact values are recognised, never made.

    Args:
        numbers: of t, q, u and the parameters.
        positive: symbols that are positive there.
    """

    numbers: Mapping[Node, float]
    positive: frozenset[Node]

    def value(self, x: Scalar) -> float:
        """The scalar's value there; nan where it has none."""
        if any(symbol not in self.numbers for symbol in symbols_of((x,))):
            return math.nan
        return float(evaluate((x,), self.numbers, FLOAT)[0])

    def agrees(self, x: Scalar, node: Node) -> bool:
        """True if x has the value that is known of the node."""
        number = self.numbers.get(node, math.nan)
        return abs(self.value(x) - number) <= tolerances.CARRIED * (1 + abs(number))

    def chosen(self, candidates: Sequence[Scalar], node: Node, equation: Scalar) -> Scalar | None:
        """The candidate with the value known of the node, the nearest of several; whole turns added if it has them.

        A turn is 2 pi, or 2 pi/q where the node stands in waves of q times it alone. A candidate of more than a page is
        none: no reader follows it, and what depends on it would be longer still.
        """
        turn, found = _turn_of(equation, node), list[tuple[float, Scalar]]()
        for candidate in candidates:
            if text_size(candidate) > PAGE:
                continue
            away = (self.numbers.get(node, math.nan) - self.value(candidate)) / self.value(turn)
            turns = round(away) if math.isfinite(away) else 0
            shifted = candidate + turns * turn if turns else candidate
            if self.agrees(shifted, node) and (not turns or has_period(equation, node, turn)):
                found.append((abs(self.value(shifted) - self.numbers[node]), shifted))
        return min(found, key=lambda each: each[0])[1] if found else None

    def root(self, equation: Scalar, node: Node) -> Scalar | None:
        """The root of the equation with the value known of the node."""
        return self.chosen(roots(equation, node, self.positive, Work.VALUE), node, equation)

    def places(self, equations: Sequence[Scalar], unknowns: Collection[Node]) -> dict[Node, Scalar]:
        """The unknowns near there that equations determine in closed form, functions of the parameters alone.

        Args:
            equations: what vanishes.
        """
        left = [simplest(x, Work.VALUE, self.positive) for x in equations]
        relations: dict[Node, Scalar] = {}
        found: dict[Node, Scalar] = {}
        while left:
            left = [x for x in substituted(left, {**relations, **found}) if _held(x, unknowns) and not vanishes(x)]
            step = _single(left, unknowns, self) or _relation(left, unknowns, self)
            if step is not None:
                node, value, used = step
                relations = dict(zip(relations, substituted(tuple(relations.values()), {node: value}), strict=True))
                target = relations if depends_on(value, unknowns) else found
                target[node] = value
                del left[used]
            elif of_loop := _of_loop(left, unknowns, self):
                found |= of_loop
            elif not _joined(left, unknowns, self):
                break
        found |= {node: substituted((value,), found)[0] for node, value in relations.items()}
        known = {node: value for node, value in found.items() if not depends_on(value, unknowns)}
        return {node: simplest(value, Work.VALUE, self.positive) for node, value in known.items()}


def _turn_of(equation: Scalar, node: Node) -> Scalar:
    """2 pi/q of an equation that holds a node in waves of q times it, q a constant with a name; else 2 pi."""
    turn: Scalar = 2 * node.graph.pi
    waves = {x.args[0] for x in order((equation,)) if x.op in ("sin", "cos") and depends_on(x, (node,))}
    slopes = {derivative(x, node) for x in waves}
    if len(slopes) != 1:
        return turn
    (q,) = slopes
    return over(turn, q) if type(q) is Node and not depends_on(q, (node,)) else turn


ChainStep = tuple[Node, Scalar, int]


def _held(x: Scalar, unknowns: Collection[Node]) -> list[Node]:
    return [q for q in unknowns if depends_on(x, (q,))]


def _single(left: Sequence[Scalar], unknowns: Collection[Node], located: Located) -> ChainStep | None:
    """An equation in one unknown, solved."""
    for i, equation in enumerate(left):
        held = _held(equation, unknowns)
        if len(held) == 1 and (root := located.root(equation, held[0])) is not None:
            return held[0], root, i
    return None


def _relation(left: Sequence[Scalar], unknowns: Collection[Node], located: Located) -> ChainStep | None:
    """An equation solved for one of its unknowns; the one in which it has a single root first.

    Only of an equation of less than a page; where there is a loop such a one alone: a cos q + b sin q + r has two
    roots.
    """
    several: ChainStep | None = None
    in_loop = any(True for _ in _loops(left, unknowns))
    for i, equation in enumerate(left):
        if text_size(equation) > PAGE:
            continue
        for q in _held(equation, unknowns):
            if in_loop and _waves(equation, q) is not None:
                continue
            candidates = roots(equation, q, located.positive, Work.VALUE)
            root = located.chosen(candidates, q, equation)
            if root is not None and len(candidates) == 1:
                return q, root, i
            if root is not None and several is None:
                several = q, root, i
    return None if in_loop else several


def _of_loop(left: Sequence[Scalar], unknowns: Collection[Node], located: Located) -> dict[Node, Scalar]:
    """The unknowns of two equations that hold no third one, each by the equation without the other; {}: none such.

    One that has a short root comes alone: put in, it leaves a shorter one for the other. So a parallelogram gives the
    angle of its crank itself, rather than an arc tangent of the same value.
    """
    found: dict[Node, Scalar] = {}
    for i, j, q, first, second in _loops(left, unknowns):
        two = _held(left[i], unknowns)
        other = next(x for x in two if x is not q)
        if len(two) > 2 or two != _held(left[j], unknowns) or other in found:
            continue
        root = located.root(_without_angle(first, second, located), other)
        if root is not None:
            found[other] = root
            if text_size(root) <= SHORT:
                return {other: root}
    return found


def _joined(left: list[Scalar], unknowns: Collection[Node], located: Located) -> bool:
    """Replaces one equation of a loop by one without the angle common to both; False where there is no loop."""
    loop = next(_loops(left, unknowns), None)
    if loop is None:
        return False
    _, j, _, first, second = loop
    left[j] = _without_angle(first, second, located)
    return True


WaveSum = tuple[Scalar, Scalar, Scalar]


def _without_angle(first: WaveSum, second: WaveSum, located: Located) -> Scalar:
    """cos^2 + sin^2 = 1 of the waves that two equations fix."""
    (a1, b1, r1), (a2, b2, r2) = first, second
    below = a1 * b2 - a2 * b1
    cosine, sine = r2 * b1 - r1 * b2, r1 * a2 - r2 * a1
    return simplest(cosine * cosine + sine * sine - below * below, Work.VALUE, located.positive)


def _loops(left: Sequence[Scalar], unknowns: Collection[Node]) -> Iterator[tuple[int, int, Node, WaveSum, WaveSum]]:
    """Two equations a cos q + b sin q + r = 0 of one unknown q that fix both waves, with other unknowns in them.

    Both of less than a page: what is longer has grown by joining others, as around a loop in space, and no root of it
    is one that is taken.
    """
    short = [i for i, x in enumerate(left) if text_size(x) <= PAGE]
    for i, j in combinations(short, 2):
        for q in _held(left[i], unknowns):
            if len(_held(left[i], unknowns)) < 2 or q not in _held(left[j], unknowns):
                continue
            first, second = _waves(left[i], q), _waves(left[j], q)
            if first and second and not vanishes(first[0] * second[1] - second[0] * first[1]):
                yield i, j, q, first, second


def _waves(equation: Scalar, q: Node) -> WaveSum | None:
    """(a, b, r) of an equation a cos q + b sin q + r = 0, from its values at 0, pi/2 and pi; None for any other."""
    pi = q.graph.pi
    try:
        at = [substituted((equation,), {q: Fraction(k, 2) * pi if k else 0})[0] for k in range(3)]
    except DerivationError:
        return None
    half = Fraction(1, 2)
    a, r = half * (at[0] - at[2]), half * (at[0] + at[2])
    b = at[1] - r
    return (a, b, r) if vanishes(equation - a * cos(q) - b * sin(q) - r) else None
