"""A formula as it is typeset -> how long it is as a person reads it.

Every visible mark counts one: a letter, a digit, an operator, a bracket, a fraction bar, a root. The name of a function
is one mark too. What stands over or beside a letter (accents, primes) and where marks are placed count nothing.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache

from eomgen.symbolic.expression import Fraction, Node, Number, Sampled, Scalar
from eomgen.symbolic.print.layout import (
    TRIGONOMETRIC,
    Factor,
    Product,
    decimal_of,
    is_bare_argument,
    is_base,
    is_part_of_letter,
    is_part_of_turn,
    summands,
)
from eomgen.symbolic.print.names import Symbol, index_latex

ATOM, TALL, SUM = range(3)  # a symbol or number; what needs parentheses under an exponent; a sum or a product
Marks = tuple[int, int]  # how many, and how they hang together

_MULTIPLIER = re.compile(r"lam\((?P<constraint>.*), (?P<row>\d+)\)")

_ACCENTS = (
    "dot ddot dddot ddddot hat widehat bar overline underline vec tilde widetilde acute grave breve check mathring"
    " overrightarrow overleftarrow prime"
)
_PLACES = (
    "left right middle big Big bigg Bigg bigl bigr Bigl Bigr biggl biggr Biggl Biggr quad qquad displaystyle textstyle"
    " limits nolimits hfill mathstrut nonumber notag newline"
)
_FONTS = (
    "mathrm mathbf mathit mathsf mathtt mathcal mathbb mathfrak boldsymbol bm pmb text textrm textbf textit textsf mbox"
    " mathop mathord mathbin mathrel overset underset stackrel substack phantomsection"
)
_SILENT = frozenset(f"{_ACCENTS} {_PLACES} {_FONTS}".split())
_UNREAD = frozenset(("label", "tag", "color", "hspace", "vspace", "phantom", "hphantom", "vphantom"))
_FENCES = {"cases": 1, "pmatrix": 2, "bmatrix": 2, "Bmatrix": 2, "vmatrix": 2, "Vmatrix": 2}
_INVISIBLE = frozenset("{}_^&~'$ \t\n\r")

_TOKEN = re.compile(
    r"""(?P<comment>%[^\n]*)
      | \\(?:begin|end)\s*\{(?P<environment>[^{}]*)\}(?:\{[^{}]*\})?
      | \\operatorname\*?\s*\{(?P<name>(?:[^{}]|\{[^{}]*\})*)\}
      | \\sqrt\s*\[(?P<degree>[^\[\]]*)\]
      | \\(?P<unread>[a-zA-Z]+)\*?\s*\{(?P<ignored>[^{}]*)\}
      | \\(?P<command>[a-zA-Z]+)\*?
      | (?P<break>\\\\(?:\[[^\[\]]*\])?)
      | \\(?P<escaped>.)
      | (?P<mark>.)""",
    re.VERBOSE | re.DOTALL,
)


def length_of_latex(tex: str) -> int:
    """The number of visible marks of a formula in LaTeX.

    length_of_latex(r"(M + m)\\ddot{X} + m\\ddot{s}\\cos\\alpha = 0") is 13

    Args:
        tex: a formula, with `$` around it or without.
    """
    total, place = 0, 0
    silenced = False  # by \left and its like, whose empty delimiter is a dot
    while (found := _TOKEN.match(tex, place)) is not None:
        place = found.end()
        if found["unread"] and found["unread"] not in _UNREAD:  # its braces hold what is read
            place = found.start("unread") + len(found["unread"])
            found = _TOKEN.fullmatch(f"\\{found['unread']}")
            assert found is not None
        if not (silenced and found["mark"] == "."):
            total += _marks(found)
        silenced = found["command"] in ("left", "right", "middle")
    return total


def _marks(found: re.Match[str]) -> int:
    """The visible marks of one token."""
    if found["environment"] is not None:
        return _FENCES.get(found["environment"], 0) if found[0].startswith("\\begin") else 0
    if found["degree"] is not None:
        return 1 + length_of_latex(found["degree"])
    if found["command"] is not None:
        return int(found["command"] not in _SILENT)
    if found["escaped"] is not None:
        return int(found["escaped"] not in ",;:!> \n")
    return int(found["name"] is not None or (found["mark"] is not None and found["mark"] not in _INVISIBLE))


# -- of what is not typeset yet -----------------------------------------------------------------


def length_of(*scalars: Scalar) -> int:
    """The number of visible marks that the scalars have when they are typeset, names by their letters.

    What `length_of_latex` counts in them; nothing is typeset, and each node is counted once.
    """
    return sum(_lengths(x)[x][0] if type(x) is Node else _number(x)[0] for x in scalars)


def _lengths(x: Node) -> dict[Node, Marks]:
    """The marks of x and of all its parts."""
    known: dict[Node, Marks] = x.graph.found(length_of)
    plans: dict[Node, list[Product]] = {}
    stack = [x]
    while stack:
        node = stack[-1]
        if node in known:
            stack.pop()
            continue
        if node not in plans:
            plans[node] = [] if is_base(node) else summands(node)
        bases = [base for p in plans[node] for base, _ in (*p.numerator, *p.denominator)]
        missing = [part for part in bases or node.args if type(part) is Node and part not in known]
        if missing:
            stack += missing
        else:
            known[stack.pop()] = _sum(plans[node], known) if plans[node] else _base(node, known)
    return known


def _sum(products: Sequence[Product], known: Mapping[Node, Marks]) -> Marks:
    if len(products) == 1:
        marks, hold = _product(products[0], known)
        return (marks + 1, SUM) if products[0].coefficient < 0 else (marks, hold)
    signs = sum(i > 0 or p.coefficient < 0 for i, p in enumerate(products))
    return signs + sum(_product(p, known)[0] for p in products), SUM


def _product(product: Product, known: Mapping[Node, Marks], *, one_fraction: bool = False) -> Marks:
    c = max(product.coefficient, -product.coefficient)
    if not product.denominator and not (one_fraction or is_part_of_turn(product) or is_part_of_letter(product)):
        return _side(c, product.numerator, known)
    whole = decimal_of(c) is not None
    above = _side(c if whole else c.numerator, product.numerator, known)
    below = _side(1 if whole else c.denominator, product.denominator, known)
    return above[0] + 1 + below[0], SUM


def _side(c: Number, found: Sequence[Factor], known: Mapping[Node, Marks]) -> Marks:
    """A number and powers side by side."""
    if not found:
        return _number(c)
    if len(found) == 1 and c == 1 and found[0][1] == 1:
        return known[found[0][0]]
    parts = [] if c == 1 else [_number(c)]
    parts += [_power(known[base], base, exponent) for base, exponent in found]
    dots = sum(base.op == "pow" and type(base.args[0]) is not Node for base, _ in found[0 if c != 1 else 1 :])
    return sum(marks for marks, _ in parts) + dots, parts[0][1] if len(parts) == 1 else SUM


def _power(found: Marks, base: Node, exponent: int) -> Marks:
    marks, hold = found
    if exponent == 1:
        return (marks + 2, TALL) if hold == SUM else found
    bracketed = hold == SUM or (hold == TALL and base.op not in TRIGONOMETRIC)
    return marks + 2 * bracketed + len(str(exponent)), TALL


def _base(node: Node, known: Mapping[Node, Marks]) -> Marks:
    op = node.op
    if op in ("symbol", "pi"):
        return (length_of_name(node.name) if op == "symbol" else 1), ATOM
    if op == "sampled" and not Sampled.of(node.args[1]).called:
        return length_of_name(Sampled.of(node.args[1]).name), ATOM
    if op == "sampled":
        inner = known[node.args[0]] if type(node.args[0]) is Node else _number(node.args[0])
        return length_of_name(Sampled.of(node.args[1]).name) + 2 + inner[0], ATOM
    parts = [known[a] if type(a) is Node else _number(a) for a in node.args]
    inside = sum(marks for marks, _ in parts)
    if op == "sqrt":
        return _in_one_fraction(node.args[0], parts[0], known) + 1, TALL
    if op in ("exp", "abs"):
        return inside + (1 if op == "exp" else 2), TALL if op == "exp" else ATOM
    if op in ("less", "less_equal"):
        return inside + 1, SUM
    if op == "select":
        return inside + 1, ATOM
    if op == "pow":
        return inside + 2 * (parts[0][1] != ATOM), TALL
    if len(parts) == 1 and is_bare_argument(op, node.args[0]):
        return _in_one_fraction(node.args[0], parts[0], known) + 1, TALL
    return inside + 2 + len(parts), TALL


def _in_one_fraction(x: Scalar, found: Marks, known: Mapping[Node, Marks]) -> int:
    """x with its broken number and the rest as one fraction."""
    if type(x) is Node and x.op == "mul" and type(x.args[0]) is Fraction and decimal_of(x.args[0]) is None:
        return _product(summands(x)[0], known, one_fraction=True)[0]
    return found[0]


def _number(c: Number) -> Marks:
    decimal = decimal_of(c)
    if c.denominator == 1 or decimal is not None:
        digits, power = decimal or (str(c), 0)
        return len(digits) + (3 + len(str(power)) if power else 0), ATOM if c >= 0 and not power else SUM
    return len(str(c.numerator)) + 1 + len(str(c.denominator)), SUM


@lru_cache(maxsize=1_000)
def length_of_name(name: str) -> int:
    """The letters and digits of a symbol: theta1' has two, m_cart five."""
    multiplier = _MULTIPLIER.fullmatch(name)
    if multiplier:
        return 2 + len(multiplier["row"]) + length_of_latex(index_latex(multiplier["constraint"]))
    return length_of_latex(Symbol.of(name.rstrip("'")).tex)
