"""Node -> LaTeX as a textbook sets it: \\frac{27}{2} M R^{2} \\dot{\\theta}^{2} \\cos^{2}\\theta, and how wide that is.

Only amsmath and KaTeX's common ground is used. Factors are juxtaposed, functions last, quotients are fractions.
Loops over an explicit stack, as the printing of text does.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import pairwise

from eomgen.documents.latex_names import Notation
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Number, Scalar
from eomgen.symbolic.expression.node import SUMS
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.splines import sampled_of
from eomgen.symbolic.print.decimals import decimal_of
from eomgen.symbolic.print.layout import Factor, Product, is_base, is_part_of_letter, is_part_of_turn, is_time
from eomgen.symbolic.print.printed import TRIGONOMETRIC, is_bare_argument, summands

ATOM, TALL, SUM = range(3)  # a symbol or number; what needs parentheses under an exponent; a sum or a product
FUNCTIONS = {op: rf"\{op}" for op in ("sin", "cos", "tan", "sinh", "cosh", "tanh")} | {
    "asin": r"\arcsin",
    "acos": r"\arccos",
    "atan": r"\arctan",
    "log": r"\ln",
    "min": r"\min",
    "max": r"\max",
    "sign": r"\operatorname{sign}",
    "atan2": r"\operatorname{atan2}",
}
WRAPPED: dict[str, Callable[[str], str]] = {
    "sqrt": lambda x: rf"\sqrt{{{x}}}",
    "exp": lambda x: f"e^{{{x}}}",
    "abs": lambda x: rf"\left\lvert {x} \right\rvert",
}
RELATIONS = {"less": "<", "less_equal": r"\leq"}
_COMMAND = re.compile(r"\\[a-zA-Z]+")
_HIGH = re.compile(r"\\(?:frac|sqrt|begin|left)")
_SILENT = re.compile(r"[{}_^\\ ]")


@dataclass(frozen=True, slots=True)
class Set:
    """A formula as set: its LaTeX, about how many characters wide it is, and how it hangs together."""

    tex: str
    width: float
    hold: int = ATOM


class Setter:
    """Sets graph scalars, with one notation for all of them.

    Args:
        notation: how names are set; None: by their own letters.
    """

    def __init__(self, notation: Notation | None = None) -> None:
        self.notation = notation or Notation()
        self._set: dict[Node, Set] = {}
        self._plans: dict[Node, list[Product]] = {}

    def set(self, x: Scalar) -> Set:
        """x as one line."""
        if type(x) is not Node:
            return _number(x)
        stack = [x]
        while stack:
            node = stack[-1]
            if node in self._set:
                stack.pop()
                continue
            missing = [part for part in self._needs(node) if part not in self._set]
            if missing:
                stack += missing
            else:
                self._set[stack.pop()] = self._made(node)
        return self._set[x]

    def summands(self, x: Scalar) -> list[Product]:
        """The terms of x, each with its factors, coefficients included."""
        if type(x) is not Node:
            return [Product(x, (), ())]
        if x not in self._plans:
            self._plans[x] = summands(x)
        return self._plans[x]

    def _needs(self, node: Node) -> list[Node]:
        if is_base(node):
            return [a for a in node.args if type(a) is Node]
        return [base for p in self.summands(node) for base, _ in (*p.numerator, *p.denominator)]

    def _made(self, node: Node) -> Set:
        if is_base(node):
            return self._base(node)
        products = self.summands(node)
        if len(products) == 1:
            return self.term(products[0], first=True)
        parts = [self.term(product, first=i == 0) for i, product in enumerate(products)]
        return Set(" ".join(part.tex for part in parts), sum(part.width for part in parts), SUM)

    def term(self, product: Product, *, first: bool) -> Set:
        """A term with its sign; a plus only where it is not the first."""
        body = self.product(product)
        sign = "-" if product.coefficient < 0 else "" if first else "+"
        hold = body.hold if not sign else SUM
        return Set(f"{sign} {body.tex}".strip(), body.width + (3 if sign else 0), hold)

    def product(self, product: Product, *, one_fraction: bool = False) -> Set:
        """|coefficient| * numerator / denominator; the number beside it has a fraction of its own, or none."""
        c = max(product.coefficient, -product.coefficient)
        if not product.denominator and not (one_fraction or is_part_of_turn(product) or is_part_of_letter(product)):
            return self._juxtaposed(c, product.numerator)
        if len(product.numerator) > 1 and is_time(product.numerator[-1][0]):
            before = self.product(Product(c, product.numerator[:-1], product.denominator))
            last = self.power(product.numerator[-1])
            return Set(f"{before.tex} {last.tex}", before.width + last.width, SUM)
        whole = decimal_of(c) is not None
        above = self._juxtaposed(c if whole else c.numerator, product.numerator)
        below = self._juxtaposed(1 if whole else c.denominator, product.denominator)
        return Set(rf"\frac{{{above.tex}}}{{{below.tex}}}", max(above.width, below.width), SUM)

    def _juxtaposed(self, c: Number, found: tuple[Factor, ...]) -> Set:
        """c and the factors side by side; functions last, so that what follows is no part of their argument."""
        if not found:
            return _number(c)
        if len(found) == 1 and c == 1 and found[0][1] == 1:
            return self._set[found[0][0]]
        parts = [] if c == 1 else [_number(c)]
        parts += [self.power(factor) for factor in sorted(found, key=lambda factor: _is_function(factor[0]))]
        tex = parts[0].tex
        for before, part in pairwise(parts):
            tex += _between(before.tex, part.tex) + part.tex
        return Set(tex, sum(part.width for part in parts), parts[0].hold if len(parts) == 1 else SUM)

    def power(self, factor: Factor) -> Set:
        """base ^ exponent, the exponent a whole positive number."""
        base, exponent = factor
        found = self._set[base]
        if exponent != 1 and base.op in TRIGONOMETRIC:
            name = FUNCTIONS[base.op]
            return Set(name + f"^{{{exponent}}}" + found.tex.removeprefix(name).lstrip(), found.width + 1, TALL)
        if found.hold == SUM or (found.hold == TALL and exponent != 1):
            found = bracketed(found)
        return found if exponent == 1 else Set(f"{found.tex}^{{{exponent}}}", found.width + 0.7, TALL)

    def _base(self, node: Node) -> Set:
        op = node.op
        if op in ("symbol", "pi"):
            tex = r"\pi" if op == "pi" else self.notation.latex(node.name)
            return Set(tex, width_of(tex), TALL if "^" in tex else ATOM)
        if op == "sampled":
            tex = self.notation.latex(sampled_of(node.args[1]).name)
            return Set(tex, width_of(tex))
        arguments = [self._set[a] if type(a) is Node else _number(a) for a in node.args]
        if op == "sqrt":
            arguments = [self._in_one_fraction(node.args[0])]
        inside = ", ".join(a.tex for a in arguments)
        width = sum(a.width + 1 for a in arguments)
        if op in WRAPPED:
            return Set(WRAPPED[op](inside), width + 1, ATOM if op == "abs" else TALL)
        if op in RELATIONS:
            return Set(f" {RELATIONS[op]} ".join(a.tex for a in arguments), width + 2, SUM)
        if op == "select":
            return self._cases(node)
        if op == "pow":
            base = arguments[0] if arguments[0].hold == ATOM else bracketed(arguments[0])
            return Set(f"{base.tex}^{{{arguments[1].tex}}}", width, TALL)
        if len(arguments) == 1 and is_bare_argument(op, node.args[0]):
            inside = self._in_one_fraction(node.args[0]).tex
            return Set(FUNCTIONS[op] + (inside if inside.startswith("\\") else f" {inside}"), width + len(op), TALL)
        return Set(f"{FUNCTIONS[op]}{_in_brackets(inside)}", width + len(op) + 1, TALL)

    def _in_one_fraction(self, x: Scalar) -> Set:
        """x, a product with a broken number as one fraction: 14 l/3."""
        if type(x) is Node and x.op == "mul" and type(x.args[0]) is Fraction and decimal_of(x.args[0]) is None:
            return self.product(self.summands(x)[0], one_fraction=True)
        return self.set(x)

    def _cases(self, node: Node) -> Set:
        """Cases below one another: what is chosen where a condition fails is no case of its own."""
        rows: list[str] = []
        width = 9.0
        last: Scalar = node
        while type(last) is Node and last.op == "select":
            condition, if_true, last = last.args
            value, where = self.set(if_true), self.set(condition)
            rows.append(f"{value.tex} & {where.tex}")
            width = max(width, value.width + where.width)
        rows.append(rf"{self.set(last).tex} & \text{{otherwise}}")
        width = max(width, self.set(last).width + 9) + 3
        return Set(r"\begin{cases} " + r" \\ ".join(rows) + r" \end{cases}", width)


def width_of(tex: str) -> float:
    """About how many characters wide a symbol is set."""
    return max(1.0, 0.9 * len(_SILENT.sub("", _COMMAND.sub("x", tex.replace(r"\mathrm", "").replace(r"\dot", "")))))


def bracketed(inside: Set) -> Set:
    """In parentheses."""
    return Set(_in_brackets(inside.tex), inside.width + 2)


def _in_brackets(tex: str) -> str:
    """Parentheses that grow with what they hold, plain ones round what is no higher than a line: they stand closer."""
    return rf"\left({tex}\right)" if _HIGH.search(tex) else f"({tex})"


def _number(c: Number) -> Set:
    decimal = decimal_of(c)
    if c.denominator == 1 or decimal is not None:
        digits, power = decimal or (str(c), 0)
        scale = rf" \cdot 10^{{{power}}}" if power else ""
        return Set(digits + scale, len(digits) + (5 if power else 0), ATOM if c >= 0 and not power else SUM)
    width = max(len(str(abs(c.numerator))), len(str(c.denominator)))
    sign = "-" if c < 0 else ""
    return Set(rf"{sign}\frac{{{abs(c.numerator)}}}{{{c.denominator}}}", width + 3 * len(sign), SUM)


def _is_function(node: Node) -> bool:
    return node.op in FUNCTIONS or node.op == "select"


def _between(before: str, after: str) -> str:
    """Between two factors: nothing to see, but words keep apart and numbers are multiplied by a dot."""
    if after[0].isdigit():
        return r" \cdot "
    return r" \, " if r"\mathrm" in before or r"\mathrm" in after else " "


def is_sum(node: Node) -> bool:
    """True for a factor that is a sum."""
    return node.op in SUMS
