r"""Node -> LaTeX as a textbook sets it.

Node -> LaTeX as a textbook sets it: \frac{27}{2} M R^{2} \dot{\theta}^{2} \cos^{2}\theta, and its width.

Only amsmath and KaTeX's common ground is used. Factors are juxtaposed, functions last, quotients are fractions.
Loops over an explicit stack, as the printing of text does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from itertools import groupby, pairwise

from eomgen.frozen import dataclass
from eomgen.symbolic.expression import SUMS, Fraction, Node, Number, Scalar, sampled_of
from eomgen.symbolic.print.layout import (
    TRIGONOMETRIC,
    Factor,
    Product,
    decimal_of,
    is_bare_argument,
    is_base,
    is_part_of_letter,
    is_part_of_turn,
    is_time,
    summands,
)
from eomgen.symbolic.print.names import LETTERS, Symbol, index_latex, upright

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
    """A typeset formula: its LaTeX, its approximate width in characters, the precedence of its outermost operation."""

    tex: str
    width: float
    hold: int = ATOM

    @classmethod
    def of(cls, tex: str) -> Set:
        """A formula that is typeset already."""
        return cls(tex, width_of(tex))


class Setter:
    """Sets graph scalars, with one notation for all of them.

    Args:
        notation: typesetting of names; None: by their own letters.
    """

    LINE = 87.0  # characters

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

    def displays(self, formulas: Sequence[Sequence[Set | Scalar]], longest: int) -> list[str]:
        """The formulas in aligned blocks of about `longest` rows each."""
        return [aligned(rows) for rows in runs_of(self, formulas, longest)]

    def display(self, formulas: Sequence[Sequence[Set | Scalar]]) -> str:
        """The formulas in one aligned block."""
        leads = [lead_of(self, sides) for sides in formulas]
        lead = max(leads) if all(leads) else 0.0
        return aligned([row for sides in formulas for row in rows_of(self, sides, lead)])

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
        """|coefficient| * numerator / denominator; the number in front has a fraction of its own, or none."""
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
        """c and the factors side by side; functions last, so that no factor seems to belong to their argument."""
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
            return Set.of(tex)
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
    """Approximate width of a symbol [characters]."""
    return max(1.0, 0.9 * len(_SILENT.sub("", _COMMAND.sub("x", tex.replace(r"\mathrm", "").replace(r"\dot", "")))))


def bracketed(inside: Set) -> Set:
    """Formula in parentheses."""
    return Set(_in_brackets(inside.tex), inside.width + 2)


def _in_brackets(tex: str) -> str:
    """Parentheses that grow with their content, plain ones round content no higher than a line: they stand closer."""
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
    """Separator of two factors: a blank, a wider one next to words, a dot before a number."""
    if after[0].isdigit():
        return r" \cdot "
    return r" \, " if r"\mathrm" in before or r"\mathrm" in after else " "


def is_sum(node: Node) -> bool:
    """True for a factor that is a sum."""
    return node.op in SUMS


# -------- lines -----------------------------------------------------------------------------------------
# Formulas -> lines of an aligned block, each about `Setter.LINE` characters wide, broken before + and -.


NARROW = 24.0  # a left side that stands before the alignment


def aligned(rows: list[str]) -> str:
    """Rows as one aligned block."""
    return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"


def runs_of(setter: Setter, formulas: Sequence[Sequence[Set | Scalar]], longest: int) -> list[list[str]]:
    """The rows of the formulas, in runs of about `longest` rows; the equality signs of a run stand below one another.

    A formula whose left side is too wide for that begins another run.

    Args:
        formulas: the sides of each, what is set already, or scalars.
    """
    runs: list[list[str]] = []
    leads: list[float] = []
    for lead, sides in _with_leads(setter, formulas):
        rows = rows_of(setter, sides, lead)
        if not runs or leads[-1] != lead or len(runs[-1]) + len(rows) > longest:
            runs.append([])
            leads.append(lead)
        runs[-1] += rows
    return runs


def _with_leads(
    setter: Setter, formulas: Sequence[Sequence[Set | Scalar]]
) -> list[tuple[float, Sequence[Set | Scalar]]]:
    """(room on the left, sides): neighbours share the room; 0 where the left side is too wide."""
    own = [lead_of(setter, sides) for sides in formulas]
    found = []
    for is_narrow, group in groupby(range(len(own)), key=lambda i: own[i] > 0):
        indices = list(group)
        widest = max(own[i] for i in indices) if is_narrow else 0.0
        found += [(widest, formulas[i]) for i in indices]
    return found


def lead_of(setter: Setter, sides: Sequence[Set | Scalar]) -> float:
    """The width of the left side; 0 where it is too wide to stand before the equality sign of a run."""
    width = _set(setter, sides[0]).width
    return width if width <= NARROW and len(sides) > 1 else 0.0


def rows_of(setter: Setter, sides: Sequence[Set | Scalar], lead: float | None = None) -> list[str]:
    """The rows of one formula: its sides joined by equality signs.

    Args:
        sides: typeset formulas, or scalars.
        lead: the room for the left side, 0 for none before the alignment; by its own width where none is given.
    """
    lead = lead_of(setter, sides) if lead is None else lead
    if lead:
        return _rows_after(setter, sides, Setter.LINE - lead)
    parts = pieces(setter, sides[0], Setter.LINE)
    for side in sides[1:]:
        head, *rest = pieces(setter, side, Setter.LINE)
        parts += [Set(f"= {head.tex}", head.width + 3), *rest]
    filled = _filled(parts, Setter.LINE)
    return [f"& {filled[0]}", *(rf"&\quad {part}" for part in filled[1:])]


def _rows_after(setter: Setter, sides: Sequence[Set | Scalar], room: float) -> list[str]:
    """left &= right, the right in as many rows as it needs."""
    rows, line, width = [], f"{_set(setter, sides[0]).tex} &=", 0.0
    for number, side in enumerate(sides[1:]):
        whole = _set(setter, side)
        if number and width + whole.width <= room:
            line, width = f"{line} = {whole.tex}", width + whole.width + 3
            continue
        if number:
            rows.append(line)
            line = "&="
        filled = _filled(pieces(setter, side, room), room)
        line = f"{line} {filled[0]}"
        for part in filled[1:]:
            rows.append(line)
            line = rf"&\quad {part}"
        width = whole.width
    return [*rows, line]


def _set(setter: Setter, side: Set | Scalar) -> Set:
    return side if isinstance(side, Set) else setter.set(side)


def pieces(setter: Setter, side: Set | Scalar, room: float) -> list[Set]:
    """Pieces of a side that are not broken further, each but the first with its sign in front."""
    whole = _set(setter, side)
    if isinstance(side, Set) or type(side) is not Node or whole.width <= room:
        return [whole]
    found: list[Set] = []
    for number, product in enumerate(setter.summands(side)):
        term = setter.term(product, first=number == 0)
        found += [term] if term.width <= room else _opened(setter, product, term, room)
    return found


def _opened(setter: Setter, product: Product, term: Set, room: float) -> list[Set]:
    """A term that is too long for a line, broken inside the parentheses of its longest sum."""
    if product.denominator:
        return _quotient(setter, product, term.tex[:2] if term.tex.startswith(("+", "-")) else "", room)
    bases = [base for base, _ in product.numerator]
    bases += [a for base in bases if base.op in FUNCTIONS for a in base.args if type(a) is Node]
    sums = [base for base in bases if is_sum(base)]
    if not sums:
        return [term]
    longest = max(sums, key=lambda base: setter.set(base).width)
    bracket = bracketed(setter.set(longest)).tex
    if term.tex.count(bracket) != 1:
        return [term]
    before, after = term.tex.split(bracket)
    parts = pieces(setter, longest, room / 2)
    parts[0] = Set(rf"{before}\bigl({parts[0].tex}", term.width - setter.set(longest).width + parts[0].width)
    parts[-1] = Set(rf"{parts[-1].tex}\bigr){after}", parts[-1].width + 2)
    return parts


def _quotient(setter: Setter, product: Product, sign: str, room: float) -> list[Set]:
    """A quotient that is too long for a fraction, in which no line can end: (above) / (below)."""
    c = max(product.coefficient, -product.coefficient)
    above = _factor_pieces(setter, Product(c.numerator, product.numerator, ()), room)
    below = _factor_pieces(setter, Product(c.denominator, product.denominator, ()), room)
    above[0] = Set(f"{sign}{above[0].tex}", above[0].width + len(sign))
    joined = Set(rf"{above[-1].tex} \big/ {below[0].tex}", above[-1].width + below[0].width + 2)
    return [*above[:-1], joined, *below[1:]]


def _factor_pieces(setter: Setter, product: Product, room: float) -> list[Set]:
    """A side of a quotient, in parentheses where it is more than one symbol."""
    lone = product.coefficient == 1 and len(product.numerator) == 1
    if lone and product.numerator[0][1] == 1 and is_sum(product.numerator[0][0]):
        parts = pieces(setter, product.numerator[0][0], room / 2)
    else:
        term = setter.product(product)
        parts = [term] if term.width <= room else _opened(setter, product, term, room)
        if lone or not product.numerator:
            return parts
    parts[0] = Set(rf"\bigl({parts[0].tex}", parts[0].width + 1)
    parts[-1] = Set(rf"{parts[-1].tex}\bigr)", parts[-1].width + 1)
    return parts


def _filled(parts: list[Set], room: float) -> list[str]:
    """The pieces in lines."""
    lines: list[str] = []
    width = 0.0
    for part in parts:
        if lines and width + part.width <= room:
            lines[-1] += f" {part.tex}"
            width += part.width
        else:
            lines.append(part.tex)
            width = part.width + (2 if lines else 0)
    return lines


# -------- names -----------------------------------------------------------------------------------------
# Names of a document -> LaTeX: those that a model declares, else by their own letters, each distinct from the others.


SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "²": r"\textsuperscript{2}",
    "³": r"\textsuperscript{3}",
    "µ": r"$\mu$",
    "°": r"$^{\circ}$",
    "·": r"$\cdot$",
}
_MULTIPLIER = re.compile(r"lam\((?P<constraint>.*), (?P<row>\d+)\)")


@dataclass(frozen=True)
class Notation:
    """Typesetting of the names of a model.

    Args:
        symbols: the symbols that are declared, by name without primes.
        indices: the names of bodies and constraints in an index, where they declare one.
        comma: numbers have a decimal comma.
    """

    symbols: Mapping[str, Symbol] = field(default_factory=dict)
    indices: Mapping[str, str] = field(default_factory=dict)
    comma: bool = False

    def with_symbols(self, symbols: Mapping[str, Symbol]) -> Notation:
        """The notation with further symbols; the model's own take precedence."""
        return replace(self, symbols={**symbols, **self.symbols})

    def latex(self, name: str) -> str:
        """A symbol of the formulas, dots and index included."""
        multiplier = _MULTIPLIER.fullmatch(name)
        if multiplier:
            return rf"\lambda_{{{self.index(multiplier['constraint'])},{multiplier['row']}}}"
        bare = name.rstrip("'")
        symbol = self.symbols.get(bare) or Symbol.of(bare, self.indices)
        return symbol.dotted(len(name) - len(bare))

    def index(self, name: str) -> str:
        """The name of a body, a constraint, a force or a point as an index: bar, or its declared symbol; bar.end."""
        owner, dot, point = name.partition(".")
        found = self.indices.get(owner) or index_latex(owner)
        return f"{found}{dot}{index_latex(point)}" if dot else found

    def reported_apart(self, names: Iterable[str]) -> Notation:
        """The notation with distinct names: where two would look alike (theta1, theta_1) the later one is spelt out."""
        bare = list(dict.fromkeys(name.rstrip("'") for name in names))
        taken: dict[str, str] = {}
        spelt: dict[str, Symbol] = {}
        for name in sorted(bare, key=lambda name: name not in self.symbols):  # those that are declared keep theirs
            if taken.setdefault(self.latex(name), name) != name and name not in self.symbols:
                spelt[name] = Symbol(name, upright(name))
        return replace(self, symbols={**self.symbols, **spelt})


def latex_escaped(text: str) -> str:
    """Plain text for LaTeX outside formulas."""
    return "".join(rf"${LETTERS[c]}$" if c in LETTERS else SPECIAL.get(c, c) for c in text)
