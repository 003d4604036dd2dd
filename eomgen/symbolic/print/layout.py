"""Node -> its terms and factors in the order in which a textbook prints them.

Node -> the terms of its sum and the factors of its products, in the order in which a textbook writes them.

Sums and products are flattened by multiplicity, each node opened once: an
expression whose tree is exponentially large costs what its graph costs.
"""

from __future__ import annotations

import math
from collections.abc import Container
from functools import lru_cache
from heapq import heappop, heappush
from math import gcd
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import SUMS, Fraction, Node, Number, Scalar, holds_op, order, tidy
from eomgen.symbolic.numeric import FLOAT, evaluate

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

    @staticmethod
    def of(x: Scalar, named: Container[Node] = ()) -> Product:
        """x as powers over powers: constants, symbols, sums, functions, then rates (27/2*M*R^2*cos(theta)^2*theta'^2).

        A base is a symbol, pi, a function, a sum, or a `pow` that is no whole power.

        Args:
            named: nodes with a name of their own, which are not opened.
        """
        if not isinstance(x, Node):
            return Product(x, (), ())
        known: dict[Node, Product] = {} if named else x.graph.found(Product.of)
        if x not in known:
            known[x] = _factors(x, named)
        return known[x]


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
    product = Product.of(1 if node is None else node, named)
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
    """Sort key of a factor: by what it is made of, and by its age only where that is long or the same."""
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


# -------- printed ---------------------------------------------------------------------------------------------
# Node -> the products of its sum with the signs and roots of a textbook. Text and LaTeX print from here.


TRIGONOMETRIC = frozenset("sin cos tan sinh cosh tanh".split())
_OTHER = {"sin": "cos", "cos": "sin"}


def summands(x: Scalar, named: Container[Node] = ()) -> list[Product]:
    """x as a sum of products for print, in the order of `terms`.

    k*(1 - l/r) rather than -k*(l/r - 1), sqrt(14*l/3) rather than 1/3*sqrt(42*l), tan(x) rather than sin(x)/cos(x),
    and k*(b - a) rather than -k*(a - b) where that is all.
    """
    found = terms(x, named)
    alone = len(found) == 1
    known: dict[Any, tuple[Product, bool]] = {} if named or type(x) is not Node else x.graph.found(summands)
    for term in found:
        if (term, alone) not in known:
            product = product_of(term, named)
            known[term, alone] = _for_people(product, named, alone=alone), product.coefficient > 0
    products = [known[term, alone] for term in found]
    first = next((i for i, (_, plus) in enumerate(products) if plus), 0)
    return plus_first([product for product, _ in (products[first], *products[:first], *products[first + 1 :])])


def _for_people(product: Product, named: Container[Node], *, alone: bool) -> Product:
    return _with_shorter_roots(_with_plus(_with_tangents(product, named), named, alone=alone), named)


def _with_tangents(product: Product, named: Container[Node]) -> Product:
    """sin(a)/cos(a) as tan(a), cos(a)^2/sin(a) as cos(a)/tan(a); sin(a)/cos(a)^2 as it is."""
    for below, n in product.denominator:
        if (other := _OTHER.get(below.op)) is None or below in named:
            continue
        for above, m in product.numerator:
            if above.op == other and above.args[0] is below.args[0] and m >= n and above not in named:
                tangent = (_for_print(above, above.args, "tan"), n)
                rest = [(above, m - n)] if m > n else []
                top, bottom = (rest, [tangent]) if other == "cos" else ([*rest, tangent], [])
                product = Product(
                    product.coefficient,
                    _replaced(product.numerator, above, top),
                    _replaced(product.denominator, below, bottom),
                )
    return product


def _replaced(factors: tuple[Factor, ...], base: Node, by: list[Factor]) -> tuple[Factor, ...]:
    return tuple(f for factor in factors for f in (by if factor[0] is base else [factor]))


def _with_plus(product: Product, named: Container[Node], *, alone: bool) -> Product:
    """-k/(a - b) as k/(b - a), and where it stands alone -k (a - b) as k (b - a); else as it is."""
    if product.coefficient > 0:
        return product
    above, below = (_with_turned_difference(factors, named) for factors in (product.numerator, product.denominator))
    if alone and above is not None:
        return Product(-product.coefficient, above, product.denominator)
    return product if below is None else Product(-product.coefficient, product.numerator, below)


def _with_turned_difference(factors: tuple[Factor, ...], named: Container[Node]) -> tuple[Factor, ...] | None:
    """The factors with the sign of one difference changed; None where none of them is one."""
    for i, (base, exponent) in enumerate(factors):
        if exponent % 2 and base.op == "sub" and base not in named:
            return (*factors[:i], (_for_print(base, base.args[::-1]), exponent), *factors[i + 1 :])
    return None


def is_bare_argument(op: str, x: Scalar) -> bool:
    """True if x stands behind the function without parentheses: sin x, and of an angle cos 2 x and sin omega t."""
    if type(x) is not Node:
        return False
    if is_base(x) or op not in TRIGONOMETRIC:
        return x.op in ("symbol", "pi")
    alone, *others = products_of(x)
    bases = [factor for factor in (*alone.numerator, *alone.denominator)]
    return not others and alone.coefficient > 0 and all(base.op in ("symbol", "pi") and e == 1 for base, e in bases)


def _with_shorter_roots(product: Product, named: Container[Node]) -> Product:
    """The product with the common factor of a root's number and the denominator moved under the root.

    k/(g d) sqrt(g n x) = k/d sqrt(n x/g)
    """
    c = product.coefficient
    above = list(product.numerator)
    for i, (base, exponent) in enumerate(above):
        inside = _number_under(base)
        share = gcd(inside, c.denominator)
        if exponent == 1 and share > 1 and base not in named and decimal_of(c) is None:
            rest = base.graph.mul(Fraction(inside, share * share), base.args[0].args[1])
            above[i] = (_for_print(base, (rest,)), 1)
            c = tidy(Fraction(c) * share)
    return Product(c, tuple(above), product.denominator)


def _for_print(base: Node, args: tuple[Scalar, ...], op: str | None = None) -> Node:
    """An operation as the graph would not hold it; the graph does not learn of it."""
    return Node(base.graph, op or base.op, args, base.index)


def _number_under(base: Node) -> int:
    """The whole number c of sqrt(c x); 1 where there is none."""
    inside = base.args[0] if base.op == "sqrt" else None
    if type(inside) is Node and inside.op == "mul" and type(inside.args[0]) is int:
        return inside.args[0]
    return 1


def has_nested_quotient(x: Scalar) -> bool:
    """True where a sum in a quotient has quotients itself, (a + b/c)/d, functions not looked into."""
    if not holds_op(x, "div") or not any(_is_of_sums(node) for node in order((x,))):
        return False
    stack: list[tuple[Scalar, bool]] = [(x, False)]
    seen = set()
    while stack:
        entry = stack.pop()
        node, within = entry
        if not isinstance(node, Node) or is_base(node) or entry in seen:
            continue
        seen.add(entry)
        for product in summands(node):
            broken = product.coefficient.denominator > 1 and decimal_of(product.coefficient) is None
            if within and (product.denominator or broken):
                return True
            sums = [base for base, _ in (*product.numerator, *product.denominator) if base.op in SUMS]
            stack += [(base, within or bool(product.denominator)) for base in sums]
    return False


def _is_of_sums(x: Node) -> bool:
    """True if x is a product, quotient or power of which a part is a sum."""
    return x.op in ("mul", "div", "pow") and any(type(a) is Node and a.op in SUMS for a in x.args)


# -------- decimals --------------------------------------------------------------------------------------------
# Exact numbers -> how they are written: 27/2 as a fraction, 0.0825 as the decimal that it is exactly.


MOST_DIGITS = 8  # of a decimal that may be longer than its fraction
LONGEST_FRACTION = 100  # the smallest denominator of a fraction that reads worse than its decimal
MUCH_LONGER = 2  # characters by which a decimal of hundredths may be longer than its fraction
MOST_PRINTED = 4000  # digits of a whole number: Python prints 4300
BITS = math.log2(10)  # of a digit
KEPT = 1000  # numbers whose decimals are cached
SMALLEST = -4  # power of ten below which a decimal is written with its exponent: 8.464e-7


def number_text(c: Number) -> str:
    """c as text that is read back as c: 4, -27/2, 0.0825, 8.464e-7.

    Raises:
        DerivationError: it has more digits than can be printed.
    """
    if _is_long(c):
        raise DerivationError(
            f"a number of {number_length(c)} digits came up, which is too long to print",
            fix="scale the parameters: other units, or numbers nearer to 1",
        )
    decimal = decimal_of(c)
    if decimal is None:
        return str(c)
    digits, power = decimal
    return f"{digits}e{power}" if power else digits


def number_length(c: Number) -> int:
    """Length of the text of c; of a very long one an estimate."""
    return int((c.numerator.bit_length() + c.denominator.bit_length()) / BITS) if _is_long(c) else len(number_text(c))


def _is_long(c: Number) -> bool:
    return max(c.numerator.bit_length(), c.denominator.bit_length()) > BITS * MOST_PRINTED


@lru_cache(maxsize=KEPT)
def decimal_of(c: Number) -> tuple[str, int] | None:
    """(digits, power of ten) with c = digits * 10^power exactly; None where a fraction or a whole number reads better.

    33/400 is 0.0825 and 1/25 is 0.04; 1/12, 27/2, 3/80 and 1/128 stay fractions, and so does 83/320 (of a hemisphere),
    whose decimal is longer: only a denominator with 25 in it comes from decimals. One of many digits, as a file of
    another program has it, is the decimal that it was where that is shorter.
    """
    if _is_long(c) or (c.denominator < LONGEST_FRACTION and c.denominator % 25):
        return None
    places = _places(c.denominator)
    digits = "" if places is None else str(abs(c.numerator) * 10**places // c.denominator)
    if places is None:
        return None
    text, power = _placed(digits, places)
    longer = -1 if len(digits) > MOST_DIGITS else 0 if c.denominator % 25 else MUCH_LONGER
    if len(text) + (len(f"e{power}") if power else 0) > len(str(abs(c))) + longer:
        return None
    return ("-" if c < 0 else "") + text, power


def _places(denominator: int) -> int | None:
    """Number of places after the point of 1/denominator; None where they never end."""
    powers = []
    for prime in (2, 5):
        count = 0
        while denominator % prime == 0:
            denominator //= prime
            count += 1
        powers.append(count)
    return max(powers) if denominator == 1 else None


def _placed(digits: str, places: int) -> tuple[str, int]:
    """The digits with their point: at its place, or after the first digit and with a power of ten."""
    power = len(digits) - 1 - places
    if power < SMALLEST:
        return digits[0] + (f".{digits[1:]}" if digits[1:] else ""), power
    digits = digits.rjust(places + 1, "0")
    return f"{digits[:-places]}.{digits[-places:]}", 0
