"""Node -> the terms of its sum and the factors of its products, in the order in which a textbook writes them.

Sums and products are flattened by multiplicity, each node opened once: an
expression whose tree is exponentially large costs what its graph costs.
"""

from __future__ import annotations

from collections.abc import Container
from heapq import heappop, heappush
from typing import Any

from eomgen.records import dataclass
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Node, Number, Scalar
from eomgen.symbolic.expression.node import SUMS
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.print.decimals import decimal_of

SHORT_SUM = 40  # nodes of a sum that is looked through for what moves

Term = tuple[Number, "Node | None"]
Factor = tuple[Node, int]
Rank = tuple[int, tuple[int, ...], str, tuple[str, ...], int]


@dataclass(frozen=True, slots=True)
class Product:
    """coefficient * (product of base ^ exponent) / (product of base ^ exponent), exponents whole and positive."""

    coefficient: Number
    numerator: tuple[Factor, ...]
    denominator: tuple[Factor, ...]


def terms(x: Scalar, named: Container[Node] = ()) -> list[Term]:
    """x as a sum of number * term, the term None for a plain number.

    The order is the one in which they were added. A positive number leads, a negative one comes last, and
    the sum begins with a term without a minus where there is one: 1 - cos(theta), theta - pi/2.

    Args:
        named: nodes with a name of their own, which are not opened.
    """
    if not isinstance(x, Node):
        return [(x, None)]
    opened, leaves = _opened_sum(x, named)
    share_opened: dict[Node, Number] = dict.fromkeys(opened, 0)
    share: dict[Node, Number] = dict.fromkeys(leaves, 0)
    (share_opened if opened else share)[x] = 1
    number: Number = 0
    for node in sorted(opened, key=_newest_first):
        for factor, child in _summands(node):
            part = factor * share_opened[node]
            if not isinstance(child, Node):
                number += part * child
            elif node.op != "mul" and child in share_opened:
                share_opened[child] += part
            else:
                share[child] += part
    return _lead([(tidy(c), leaf) for leaf, c in share.items() if c != 0], tidy(number))


def products_of(x: Scalar, named: Container[Node] = ()) -> list[Product]:
    """x as a sum of products, in the order of `terms`; k*(1 - l/r) rather than -k*(l/r - 1)."""
    return plus_first([product_of(term, named) for term in terms(x, named)])


def product_of(term: Term, named: Container[Node] = ()) -> Product:
    """number * term with the sign of a factor turned where it reads better."""
    c, node = term
    product = factors(1 if node is None else node, named)
    return _turned(Product(c * product.coefficient, product.numerator, product.denominator), named)


def plus_first(products: list[Product]) -> list[Product]:
    """The products with the first positive one in front."""
    first = next((i for i, product in enumerate(products) if product.coefficient > 0), 0)
    return [products[first], *products[:first], *products[first + 1 :]]


def _turned(product: Product, named: Container[Node]) -> Product:
    """The product with the sign of a factor turned where it reads better: -(x - 1) is 1 - x, and l/r - 1 too."""
    product = _turned_below(product, named)
    for i, (base, exponent) in enumerate(product.numerator):
        if exponent % 2 and base not in named and base.op == "add" and _is_less_than(base.args[0], 0):
            rest = base.args[1]
            if product.coefficient < 0 or (type(rest) is Node and rest.op == "div"):
                turned = (base.graph.held("neg", (base,)), exponent)
                above = (*product.numerator[:i], turned, *product.numerator[i + 1 :])
                return Product(-product.coefficient, above, product.denominator)
    return product


def _turned_below(product: Product, named: Container[Node]) -> Product:
    """-a/(x - 1) as a/(1 - x), and a/(pi - 4), whose divisor is negative, as -a/(4 - pi)."""
    for i, (base, exponent) in enumerate(product.denominator):
        if base in named or base.op != "add" or not _is_less_than(base.args[0], 0):
            continue
        if (exponent % 2 and product.coefficient < 0) or _is_negative_constant(base):
            below = (
                *product.denominator[:i],
                (base.graph.held("neg", (base,)), exponent),
                *product.denominator[i + 1 :],
            )
            return Product((-1) ** exponent * product.coefficient, product.numerator, below)
    return product


def _is_negative_constant(x: Node) -> bool:
    """pi - 4"""
    return all(node.op in ("add", "mul", "pi") for node in order((x,))) and evaluate((x,), {}, FLOAT)[0] < 0


def _is_less_than(x: Scalar, limit: int) -> bool:
    return type(x) is not Node and x < limit


def _newest_first(node: Node) -> int:
    return -node.index


def _lead(found: list[Term], number: Number) -> list[Term]:
    """The terms with the plain number in its place and a positive one in front."""
    if number > 0:
        return [(number, None), *found]
    if number < 0 or not found:
        found.append((number, None))
    first = next((i for i, (c, _) in enumerate(found) if c > 0), 0)
    return [found[first], *found[:first], *found[first + 1 :]]


def is_base(node: Node) -> bool:
    """True for what is no sum, product or whole power: a symbol, pi, a function, a broken power."""
    return node.op not in SUMS and _parts(node) is None


def _opens_as_sum(node: Node, named: Container[Node]) -> bool:
    if node in named:
        return False
    return node.op in SUMS or (node.op == "mul" and type(node.args[0]) is not Node)


def _summands(node: Node) -> tuple[tuple[Number, Scalar], ...]:
    if node.op == "mul":
        return ((node.args[0], node.args[1]),)
    signs = {"add": (1, 1), "sub": (1, -1), "neg": (-1,)}[node.op]
    return tuple(zip(signs, node.args, strict=True))


def _opened_sum(x: Node, named: Container[Node]) -> tuple[list[Node], list[Node]]:
    """The nodes of the sum that are opened, and its terms in the order in which they were added.

    The graph sorts the arguments of a sum, but a longer sum is always younger than the shorter one that it
    was made from: a term's place is the age of the sum that brought it in.
    """
    opened: dict[Node, None] = {}
    leaves: dict[Node, int] = {}
    stack: list[tuple[Node, int]] = [(x, x.index)]
    while stack:
        node, brought_by = stack.pop()
        if not _opens_as_sum(node, named):
            leaves[node] = min(brought_by, leaves.get(node, brought_by))
        elif node not in opened:
            opened[node] = None
            by = node.index if node.op in ("add", "sub") else brought_by
            children = [(child, by) for child in reversed(node.args) if type(child) is Node]
            if node.op == "mul":  # 2*(a + b) stays a product
                leaves[children[0][0]] = min(by, leaves.get(children[0][0], by))
            else:
                stack += children
    return list(opened), sorted(leaves, key=leaves.__getitem__)


def factors(x: Scalar, named: Container[Node] = ()) -> Product:
    """x as powers over powers: constants, symbols, sums, functions, then rates (27/2*M*R^2*cos(theta)^2*theta'^2).

    A base is a symbol, pi, a function, a sum, or a `pow` that is no whole power.

    Args:
        named: nodes with a name of their own, which are not opened.
    """
    if not isinstance(x, Node):
        return Product(x, (), ())
    known: dict[Node, Product] = {} if named else x.graph.found(factors)
    if x not in known:
        known[x] = _factors(x, named)
    return known[x]


def _factors(x: Node, named: Container[Node]) -> Product:
    powers: dict[Node, int] = {x: 1}
    newest = [(-x.index, x)]
    bases: list[Factor] = []
    coefficient = Fraction(1)
    while newest:
        node = heappop(newest)[1]
        power = powers[node]
        parts = None if node in named else _parts(node)
        if parts is None and node.op == "sqrt" and node not in named:  # sqrt(x)^3 = x sqrt(x)
            whole = int(power / 2)
            bases += [(node, power - 2 * whole)] if power % 2 else []
            parts, power = ((node.args[0], 1),) if whole else (), whole
        if parts is None:
            bases += [(node, power)] if power else []
            continue
        for part, exponent in parts:
            if not isinstance(part, Node):
                coefficient *= Fraction(part) ** (power * exponent)
                continue
            if part not in powers:
                heappush(newest, (-part.index, part))
            powers[part] = powers.get(part, 0) + power * exponent
    if len(bases) > 1:
        bases.sort(key=_rank)
    above = tuple((base, power) for base, power in bases if power > 0)
    return Product(tidy(coefficient), above, tuple((base, -power) for base, power in bases if power < 0))


def _made_of(base: Node) -> tuple[list[Node], tuple[str, ...]]:
    """(its symbols in the order of their declaration, its numbers and operations); nothing where it is long."""
    found: dict[int, Node] = {}
    rest = [base.op]
    stack, seen = [base], 1
    while stack:
        for a in stack.pop().args:
            if type(a) is Node:
                seen += 1
                stack.append(a)
                if a.op == "symbol":
                    found[a.index] = a
                else:
                    rest.append(a.op)
            else:
                rest.append(str(a))
        if seen > SHORT_SUM:
            return [], ()
    return [found[k] for k in sorted(found)], (str(len(rest)), *sorted(rest))


def rebuilt_as_written(x: Scalar) -> Scalar:
    """x made anew as it is printed: sin(theta)^2/sin(theta), which is printed as sin(theta), is sin(theta)."""
    if not isinstance(x, Node):
        return x
    total: Scalar = 0
    for product in products_of(x):
        above: Any = product.coefficient
        for base, power in product.numerator:
            above = above * base**power
        below: Any = 1
        for base, power in product.denominator:
            below = below * base**power
        total = total + (above if type(below) is int else above / below)
    return total


def is_part_of_turn(product: Product) -> bool:
    """True for pi/2 and -3/4*pi, which are written as quotients: pi/2, 3*pi/4."""
    lone = len(product.numerator) == 1 and not product.denominator and product.numerator[0][1] == 1
    return lone and product.numerator[0][0].op == "pi" and 1 < product.coefficient.denominator < 100


def is_part_of_letter(product: Product) -> bool:
    """True for F/3 and 2*M/3, which are set as one fraction; of rates and accelerations a number stands before them."""
    if len(product.numerator) != 1 or product.denominator or type(product.coefficient) is not Fraction:
        return False
    ((base, exponent),) = product.numerator
    plain = base.op == "symbol" and exponent == 1 and "'" not in base.name and not is_time(base)
    return plain and decimal_of(product.coefficient) is None


def is_time(node: Node) -> bool:
    """True for t, which stands after what it is multiplied by: m*g*sin(alpha)/(2*M)*t^2."""
    return node.op == "symbol" and node.name == "t"


def _parts(node: Node) -> tuple[tuple[Scalar, int], ...] | None:
    """(factor, exponent) of a product, quotient, whole power or negation; None for a base."""
    if node.op == "mul":
        return ((node.args[0], 1), (node.args[1], 1))
    if node.op == "div":
        return ((node.args[0], 1), (node.args[1], -1))
    if node.op == "neg":
        return ((-1, 1), (node.args[0], 1))
    if node.op == "pow" and type(node.args[1]) is int:
        return ((node.args[0], node.args[1]),)
    return None


def _rank(factor: Factor) -> Rank:
    """Where a factor stands: by what it is made of, and by its age only where that is long or the same."""
    base = factor[0]
    known: dict[Node, Rank] = base.graph.found(_rank)
    if base not in known:
        known[base] = _rank_of(base)
    return known[base]


def _rank_of(base: Node) -> Rank:
    if base.op == "symbol":
        kind = 5 if base.name.startswith("lam(") else 4 if base.name.endswith("'") else 6 if is_time(base) else 1
        return kind, (base.index,), "", (), 0
    symbols, rest = _made_of(base)
    inside = tuple(x.index for x in symbols)
    if base.op in SUMS:
        still = symbols and all(map(base.graph.is_constant, symbols))
        return 1 if still else 2, inside, "sum", rest, base.index
    kind = 0 if base.op == "pi" or (base.op == "sqrt" and type(base.args[0]) is not Node) else 3
    return kind, inside, base.op, rest, base.index
