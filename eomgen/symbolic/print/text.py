"""Node -> text that the grammar of the model file reads back: 6*M*R^2*theta'^2 + 27/2*M*R^2*cos(theta)^2*theta'^2.

Loops over an explicit stack, never recursion: a chain of 50 links is nested a thousand deep.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence

from eomgen.symbolic.expression import Node, Sampled, Scalar, order
from eomgen.symbolic.print.layout import (
    TRIGONOMETRIC,
    Factor,
    Product,
    decimal_of,
    is_base,
    is_part_of_turn,
    is_time,
    number_length,
    number_text,
    summands,
)

ATOM, POWER, LOOSE = range(3)  # how tightly a text binds: theta', x^(1/3), a*b or a + b
Printed = dict[Node, tuple[str, int]]

SHORTEST_NAMED = 16  # characters: what is shorter gets no name
LONGEST_RESULT = 20_000  # characters of an exact result
SHORTEST_LIMIT = 60
_SIGNS = {"neg": 3, "add": 3, "sub": 3, "mul": 5, "div": 7, "pow": 5}


def to_text(x: Scalar, names: Mapping[Node, str] | None = None) -> str:
    """x as text; nodes with a name of their own are printed by it.

    The text can be exponentially longer than the graph: where that may be, ask `text_size` first or take
    `with_definitions`.
    """
    if type(x) is not Node:
        return number_text(x)
    names = names or {}
    printed: Printed = {node: (name, ATOM) for node, name in names.items()}
    plans: dict[Node, list[Product]] = {}
    stack = [x]
    while stack:
        node = stack[-1]
        if node in printed:
            stack.pop()
            continue
        if node not in plans:
            plans[node] = [] if is_base(node) else summands(node, names)
        missing = [part for part in _parts(node, plans[node]) if part not in printed]
        if missing:
            stack += missing
        else:
            stack.pop()
            printed[node] = _sum_text(plans[node], printed) if plans[node] else _base_text(node, printed, plans)
    return printed[x][0]


def _parts(node: Node, products: list[Product]) -> list[Node]:
    """The nodes whose text the node's own text needs."""
    if products:
        return [base for product in products for base, _ in (*product.numerator, *product.denominator)]
    return [a for a in node.args if type(a) is Node]


def _sum_text(products: list[Product], printed: Printed) -> tuple[str, int]:
    if len(products) == 1 and products[0].coefficient > 0:
        return _product_text(products[0], printed)
    pieces: list[str] = []
    for product in products:
        sign = "-" if product.coefficient < 0 else "+"
        pieces.append(f" {sign} " if pieces else sign.replace("+", ""))
        pieces.append(_product_text(product, printed)[0])
    return "".join(pieces), LOOSE


def _product_text(product: Product, printed: Printed, *, one_line: bool = False) -> tuple[str, int]:
    """The text of |coefficient| * numerator / denominator; 27/2*M*R^2, 3*M*R/(2*h).

    Args:
        one_line: 14*l/3 rather than 14/3*l.
    """
    c = product.coefficient
    c = -c if c < 0 else c
    if product.denominator and len(product.numerator) > 1 and is_time(product.numerator[-1][0]):
        before, last = Product(c, product.numerator[:-1], product.denominator), product.numerator[-1]
        return f"{_product_text(before, printed)[0]}*{_power_text(last, printed)}", LOOSE
    above = [_power_text(factor, printed) for factor in product.numerator]
    below = [_power_text(factor, printed) for factor in product.denominator]
    plain = c.denominator == 1 or decimal_of(c) is not None
    if not above and not below:
        return number_text(c), ATOM if plain else LOOSE
    if is_part_of_turn(product):
        return f"{'pi' if c.numerator == 1 else f'{c.numerator}*pi'}/{c.denominator}", LOOSE
    if above and (one_line or below) and not plain:
        above = above if c.numerator == 1 else [str(c.numerator), *above]
        below = [str(c.denominator), *below]
    elif above:
        above = above if c == 1 else [number_text(c), *above]
    else:
        above = [number_text(c) if plain else str(c.numerator)]
        below = below if plain else [str(c.denominator), *below]
    if not below and len(above) == 1:
        base, exponent = product.numerator[0]
        return above[0], printed[base][1] if exponent == 1 else POWER
    under = f"/({'*'.join(below)})" if len(below) > 1 else f"/{below[0]}" if below else ""
    return "*".join(above) + under, LOOSE


def _power_text(factor: Factor, printed: Printed) -> str:
    base, exponent = factor
    text, looseness = printed[base]
    if looseness == LOOSE or (looseness == POWER and exponent != 1):
        text = f"({text})"
    return text if exponent == 1 else f"{text}^{exponent}"


def _base_text(node: Node, printed: Printed, plans: Mapping[Node, list[Product]]) -> tuple[str, int]:
    if node.op in ("symbol", "pi"):
        return (node.name if node.op == "symbol" else "pi"), ATOM
    if node.op == "sampled":
        sampled, x = Sampled.of(node.args[1]), node.args[0]
        own = printed[x][0] if type(x) is Node else number_text(x)
        return f"{sampled.name}({own})" if sampled.called else sampled.name, ATOM
    if node.op == "pow":
        return "^".join(_tight(a, printed) for a in node.args), POWER
    products = plans.get(node.args[0], []) if node.op == "sqrt" or node.op in TRIGONOMETRIC else []
    if len(products) == 1 and products[0].coefficient > 0:
        return f"{node.op}({_product_text(products[0], printed, one_line=True)[0]})", ATOM
    inside = (printed[a][0] if type(a) is Node else number_text(a) for a in node.args)
    return f"{node.op}({', '.join(inside)})", ATOM


def _tight(a: Scalar, printed: Printed) -> str:
    """The text of a base or exponent, in parentheses unless it is one piece."""
    if not isinstance(a, Node):
        return str(a) if a.denominator == 1 and a >= 0 else f"({number_text(a)})"
    text, looseness = printed[a]
    return text if looseness == ATOM else f"({text})"


# -- naming sub-expressions --------------------------------------------------------------------


def readable_text(x: Scalar) -> str | None:
    """The text of a result; None where it would be longer than anybody reads: a shared graph is far smaller."""
    return to_text(x) if text_size(x) <= LONGEST_RESULT else None


def text_size(x: Scalar) -> int:
    """A lower bound of the length of to_text(x), at the cost of the graph: nothing is printed."""
    if type(x) is not Node:
        return number_length(x)
    sizes: dict[Node, int] = x.graph.found(text_size)
    for node in order((x,), sizes):
        if node not in sizes:
            sizes[node] = _size(node, sizes)
    return sizes[x]


def _size(node: Node, sizes: Mapping[Node, int]) -> int:
    if node.op in ("symbol", "pi"):
        return len(node.name) if node.op == "symbol" else 2
    if node.op == "sampled":
        sampled, x = Sampled.of(node.args[1]), node.args[0]
        own = sizes[x] if type(x) is Node else number_length(x)
        return len(sampled.name) + (2 + own if sampled.called else 0)
    size = _SIGNS.get(node.op) or len(node.op) + 2 * len(node.args)
    for a in node.args:
        size += sizes[a] if type(a) is Node else number_length(a)
    return size


def named_parts(expressions: Sequence[Scalar], limit: int) -> tuple[Node, ...]:
    """The sub-expressions to be named so that no text is much longer than `limit`, in evaluation order.

    None where every expression is short enough. Else all that are used more than once and long enough for a
    name, and what must be cut out of a longer text still.
    """
    limit = max(limit, SHORTEST_LIMIT)
    if all(text_size(x) <= limit for x in expressions):
        return ()
    nodes = order(expressions)
    uses = _uses(nodes, expressions)
    sizes: dict[Node, int] = {}
    named: dict[Node, None] = {}
    for node in nodes:
        sizes[node] = _size(node, sizes)
        while sizes[node] > limit and (part := _largest_part(node, sizes, named)) is not None:
            named[part] = None
            sizes[part] = len("z999")
            _resize(node, sizes)
        if uses[node] > 1 and sizes[node] >= SHORTEST_NAMED and _can_be_named(node):
            named[node] = None
            sizes[node] = len("z999")
    return tuple(sorted(named, key=lambda node: node.index))


def with_definitions(
    expressions: Sequence[Scalar], limit: int, taken: Container[str] = ()
) -> tuple[list[tuple[str, str]], list[str]]:
    """(definitions, texts): the expressions as text, long and repeated parts named z1, z2, ... before use.

    Args:
        limit: characters of one text, about.
        taken: names that may not be given, besides those of the symbols.
    """
    used = {node.name for node in order(expressions) if node.op == "symbol"}
    names: dict[Node, str] = {}
    definitions: list[tuple[str, str]] = []
    number = 0
    for node in named_parts(expressions, limit):
        number += 1
        while (name := f"z{number}") in taken or name in used:
            number += 1
        definitions.append((name, to_text(node, names)))
        names[node] = name
    return definitions, [to_text(x, names) for x in expressions]


def _uses(nodes: Iterable[Node], expressions: Iterable[Scalar]) -> dict[Node, int]:
    """Number of nodes and expressions that use each node; signs and coefficients are looked through."""
    uses = dict.fromkeys(nodes, 0)
    for node in uses:
        if _can_be_named(node):
            for part in {_core(a) for a in node.args if type(a) is Node}:
                uses[part] += 1
    for x in expressions:
        if type(x) is Node:
            uses[_core(x)] += 1
    return uses


def _can_be_named(node: Node) -> bool:
    """A sign or a coefficient stays with the text; a condition is no quantity."""
    return node.op not in ("symbol", "pi", "sampled", "less", "less_equal") and _core(node) is node


def _core(node: Node) -> Node:
    """The node without its sign and its coefficient."""
    while node.op == "neg" or (node.op == "mul" and type(node.args[0]) is not Node):
        node = node.args[-1]
    return node


def _largest_part(node: Node, sizes: Mapping[Node, int], named: Container[Node]) -> Node | None:
    parts = [core for a in node.args if type(a) is Node and (core := _core(a)) not in named and _can_be_named(core)]
    parts = [part for part in parts if sizes[part] >= SHORTEST_NAMED]
    return max(parts, key=lambda part: (sizes[part], part.index), default=None)


def _resize(node: Node, sizes: dict[Node, int]) -> None:
    """The size of the node again, after a part behind its signs and coefficients was named."""
    for a in node.args:
        chain = []
        while type(a) is Node and (a.op == "neg" or (a.op == "mul" and type(a.args[0]) is not Node)):
            chain.append(a)
            a = a.args[-1]
        for link in reversed(chain):
            sizes[link] = _size(link, sizes)
    sizes[node] = _size(node, sizes)
