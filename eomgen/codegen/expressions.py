"""Statements of a Program -> text of assignments, in the grammar that languages share.

Signs and constants are written in place, and so are short parts that are used once; everything else
gets a variable. The order of operations is the graph's: the text rounds as the graph does.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence

from eomgen.errors import DerivationError
from eomgen.symbolic.expression import Fraction, Node, Number, Scalar
from eomgen.symbolic.numeric import number_of

SUM, PRODUCT, ATOM = 1, 2, 3  # how strongly a text holds together
LONGEST_INLINE = 60
LARGEST_WHOLE = 2**53  # up to here every whole number is a double

RankedText = tuple[str, int]
CallText = Callable[[str, list[str]], str]


class ExpressionWriter:
    """Texts of the nodes of one function body; grows while the body is written.

    Args:
        call: a function's text from its op and its arguments' texts, in the language.
        number: the text of an exact number, in the language.
        names: the identifier of each symbol, and the text of values computed elsewhere.
        inverse: of divisors the text of their reciprocals.
        prefix: of our variables, v1, v2, ...
    """

    def __init__(
        self,
        call: CallText,
        number: Callable[[Number], RankedText],
        names: Mapping[Node, str],
        inverse: Mapping[Node, str],
        prefix: str,
    ) -> None:
        self._call, self._number, self._inverse, self._prefix = call, number, inverse, prefix
        self._texts: dict[Node, RankedText] = {node: (text, ATOM) for node, text in names.items()}
        self._count = 0

    def assignments(self, nodes: Iterable[Node], once: frozenset[Node]) -> list[tuple[str, str]]:
        """(variable, text) for the nodes in their order; those in `once` may go where they are used."""
        lines = []
        for node in nodes:
            text, strength = self._operation(node)
            if node in once and len(text) <= LONGEST_INLINE:
                self._texts[node] = text, strength
                continue
            self._count += 1
            variable = f"{self._prefix}{self._count}"
            self._texts[node] = variable, ATOM
            lines.append((variable, text))
        return lines

    def define(self, node: Node, text: str) -> None:
        """Give a node a text of its own: the unknown of a solve."""
        self._texts[node] = text, ATOM

    def value(self, x: Scalar) -> str:
        """The text of a scalar whose node was assigned."""
        return self._text(x)[0]

    def factor(self, x: Scalar) -> str:
        """The same, to be divided by."""
        return held(self._text(x), ATOM)

    def _text(self, x: Scalar) -> RankedText:
        if not isinstance(x, Node):
            return self._number(x)
        known = self._texts.get(x)
        if known is None:
            if x.op == "neg":
                known = f"-{held(self._text(x.args[0]), PRODUCT)}", SUM
            else:  # an exact constant: sqrt(2), pi/2
                known = self._number(Fraction(number_of(x)))
            self._texts[x] = known
        return known

    def _operation(self, x: Node) -> RankedText:
        if x.op == "div" and x.args[1] in self._inverse:
            inverse = self._inverse[x.args[1]]
            return (inverse, ATOM) if x.args[0] == 1 else (f"{held(self._text(x.args[0]), PRODUCT)}*{inverse}", PRODUCT)
        if x.op == "sampled":
            return self._call(x.op, [self._text(x.args[0])[0], str(x.args[1])]), ATOM
        arguments = [self._text(a) for a in x.args]
        if x.op in ("add", "sub"):
            a, b = arguments
            return f"{a[0]} {'+' if x.op == 'add' else '-'} {held(b, PRODUCT)}", SUM
        if x.op in ("mul", "div"):
            a, b = arguments
            return f"{held(a, PRODUCT)}{'*' if x.op == 'mul' else '/'}{held(b, ATOM)}", PRODUCT
        return self._call(x.op, [text for text, _ in arguments]), ATOM


def used_once(bodies: Iterable[tuple[Sequence[Node], Iterable[Scalar]]]) -> frozenset[Node]:
    """Nodes with one use in all, in the function body that computes them.

    Args:
        bodies: of each function body the nodes that it computes and all that its text reads.
    """
    uses: Counter[Node] = Counter()
    for computed, read in bodies:
        own = frozenset(computed)
        for x in read:
            if type(x) is Node:
                x = x.args[0] if x.op == "neg" else x
                uses[x] += 1 if x in own else 2
    return frozenset(node for node, count in uses.items() if count == 1)


def ranked_number(a: Number) -> RankedText:
    """The nearest double of an exact number; 1/3 stays a quotient, for the reader."""
    if a < 0:
        return f"-{held(ranked_number(-a), PRODUCT)}", SUM
    a = Fraction(a)
    try:
        value = float(a)
    except OverflowError:
        raise DerivationError(
            f"the number {str(a)[:20]}... is too large for a double",
            fix="scale the parameters: other units, or numbers nearer to 1",
        ) from None
    if Fraction(value) == a or a.denominator > 10_000 or a.numerator > LARGEST_WHOLE:
        return repr(value), ATOM
    return f"{float(a.numerator)!r}/{float(a.denominator)!r}", PRODUCT


def held(text: RankedText, strength: int) -> str:
    """The text, in parentheses where it holds together less than it must."""
    return text[0] if text[1] >= strength else f"({text[0]})"
