r"""Node -> LaTeX as a textbook sets it.

Node -> LaTeX as a textbook sets it: \frac{27}{2} M R^{2} \dot{\theta}^{2} \cos^{2}\theta.

Only amsmath and KaTeX's common ground is used. Factors are juxtaposed, functions last, quotients are fractions.
Loops over an explicit stack, as the printing of text does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from itertools import groupby, pairwise

from eomgen.frozen import dataclass
from eomgen.symbolic.expression import SUMS, Fraction, Node, Number, Sampled, Scalar
from eomgen.symbolic.print.breaking import OVER, PAPER, TIMES, LinePiece, SetLine
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
_HIGH = re.compile(r"\\(?:frac|sqrt|begin|left)")


@dataclass(frozen=True, slots=True)
class Set:
    """A typeset formula: its LaTeX, the precedence of its outermost operation."""

    tex: str
    hold: int = ATOM


class Setter:
    """Sets graph scalars, with one notation for all of them.

    Args:
        notation: typesetting of names; None: by their own letters.
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

    def displays(self, formulas: Sequence[Sequence[Set | Scalar]], longest: int, line: SetLine = PAPER) -> list[str]:
        """The formulas in aligned blocks of about `longest` rows each."""
        return [aligned(rows) for rows in runs_of(self, formulas, longest, line)]

    def display(self, formulas: Sequence[Sequence[Set | Scalar]]) -> str:
        """The formulas in one aligned block."""
        leads = [lead_of(self, sides, PAPER) for sides in formulas]
        lead = max(leads) if all(leads) else 0.0
        return aligned([row for sides in formulas for row in rows_of(self, sides, PAPER, lead)])

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
        return Set(" ".join(part.tex for part in parts), SUM)

    def term(self, product: Product, *, first: bool) -> Set:
        """A term with its sign; a plus only where it is not the first."""
        body = self.product(product)
        sign = "-" if product.coefficient < 0 else "" if first else "+"
        hold = body.hold if not sign else SUM
        return Set(f"{sign} {body.tex}".strip(), hold)

    def product(self, product: Product, *, one_fraction: bool = False) -> Set:
        """|coefficient| * numerator / denominator; the number in front has a fraction of its own, or none."""
        c = max(product.coefficient, -product.coefficient)
        if not product.denominator and not (one_fraction or is_part_of_turn(product) or is_part_of_letter(product)):
            return self._juxtaposed(c, product.numerator)
        if len(product.numerator) > 1 and is_time(product.numerator[-1][0]):
            before = self.product(Product(c, product.numerator[:-1], product.denominator))
            last = self.power(product.numerator[-1])
            return Set(f"{before.tex} {last.tex}", SUM)
        whole = decimal_of(c) is not None
        above = self._juxtaposed(c if whole else c.numerator, product.numerator)
        below = self._juxtaposed(1 if whole else c.denominator, product.denominator)
        return Set(rf"\frac{{{above.tex}}}{{{below.tex}}}", SUM)

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
        return Set(tex, parts[0].hold if len(parts) == 1 else SUM)

    def power(self, factor: Factor) -> Set:
        """base ^ exponent, the exponent a whole positive number."""
        base, exponent = factor
        found = self._set[base]
        if exponent != 1 and base.op in TRIGONOMETRIC:
            name = FUNCTIONS[base.op]
            return Set(name + f"^{{{exponent}}}" + found.tex.removeprefix(name).lstrip(), TALL)
        if found.hold == SUM or (found.hold == TALL and exponent != 1):
            found = bracketed(found)
        return found if exponent == 1 else Set(f"{found.tex}^{{{exponent}}}", TALL)

    def _base(self, node: Node) -> Set:
        op = node.op
        if op in ("symbol", "pi"):
            tex = r"\pi" if op == "pi" else self.notation.latex(node.name)
            return Set(tex, TALL if "^" in tex else ATOM)
        if op == "sampled" and not Sampled.of(node.args[1]).called:
            return Set(self.notation.latex(Sampled.of(node.args[1]).name))
        arguments = [self._set[a] if type(a) is Node else _number(a) for a in node.args]
        if op == "sampled":
            name = Sampled.of(node.args[1]).name
            tex = self.notation.latex(name.rstrip("'")) + "'" * (len(name) - len(name.rstrip("'")))
            return Set(tex + _in_brackets(arguments[0].tex), ATOM)
        if op == "sqrt":
            arguments = [self._in_one_fraction(node.args[0])]
        inside = ", ".join(a.tex for a in arguments)
        if op in WRAPPED:
            return Set(WRAPPED[op](inside), ATOM if op == "abs" else TALL)
        if op in RELATIONS:
            return Set(f" {RELATIONS[op]} ".join(a.tex for a in arguments), SUM)
        if op == "select":
            return self._cases(node)
        if op == "pow":
            base = arguments[0] if arguments[0].hold == ATOM else bracketed(arguments[0])
            return Set(f"{base.tex}^{{{arguments[1].tex}}}", TALL)
        if len(arguments) == 1 and is_bare_argument(op, node.args[0]):
            inside = self._in_one_fraction(node.args[0]).tex
            return Set(FUNCTIONS[op] + (inside if inside.startswith("\\") else f" {inside}"), TALL)
        return Set(f"{FUNCTIONS[op]}{_in_brackets(inside)}", TALL)

    def _in_one_fraction(self, x: Scalar) -> Set:
        """x, a product with a broken number as one fraction: 14 l/3."""
        if type(x) is Node and x.op == "mul" and type(x.args[0]) is Fraction and decimal_of(x.args[0]) is None:
            return self.product(self.summands(x)[0], one_fraction=True)
        return self.set(x)

    def _cases(self, node: Node) -> Set:
        """Cases below one another: what is chosen where a condition fails is no case of its own."""
        rows: list[str] = []
        last: Scalar = node
        while type(last) is Node and last.op == "select":
            condition, if_true, last = last.args
            value, where = self.set(if_true), self.set(condition)
            rows.append(f"{value.tex} & {where.tex}")
        rows.append(rf"{self.set(last).tex} & \text{{otherwise}}")
        return Set(r"\begin{cases} " + r" \\ ".join(rows) + r" \end{cases}")


def bracketed(inside: Set) -> Set:
    """Formula in parentheses."""
    return Set(_in_brackets(inside.tex))


def _in_brackets(tex: str) -> str:
    """Parentheses that grow with their content, plain ones round content no higher than a line: they stand closer."""
    return rf"\left({tex}\right)" if _HIGH.search(tex) else f"({tex})"


def _number(c: Number) -> Set:
    decimal = decimal_of(c)
    if c.denominator == 1 or decimal is not None:
        digits, power = decimal or (str(c), 0)
        scale = rf" \cdot 10^{{{power}}}" if power else ""
        return Set(digits + scale, ATOM if c >= 0 and not power else SUM)
    sign = "-" if c < 0 else ""
    return Set(rf"{sign}\frac{{{abs(c.numerator)}}}{{{c.denominator}}}", SUM)


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
# Formulas -> lines of an aligned block, none wider than its line as far as they can be broken.


NARROW = 0.27  # of a line: the widest left side that stands before the alignment
EQUALS = 1.4  # an equality sign with its blanks [size of the letters]
INDENT = 1.0  # of a row that goes on with the one before


def aligned(rows: list[str]) -> str:
    """Rows as one aligned block."""
    return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"


def runs_of(
    setter: Setter, formulas: Sequence[Sequence[Set | Scalar]], longest: int, line: SetLine = PAPER
) -> list[list[str]]:
    """The rows of the formulas, in runs of about `longest` rows; the equality signs of a run stand below one another.

    A formula whose left side is too wide for that begins another run.

    Args:
        formulas: the sides of each, what is set already, or scalars.
    """
    runs: list[list[str]] = []
    leads: list[float] = []
    for lead, sides in _with_leads(setter, formulas, line):
        rows = rows_of(setter, sides, line, lead)
        if not runs or leads[-1] != lead or len(runs[-1]) + len(rows) > longest:
            runs.append([])
            leads.append(lead)
        runs[-1] += rows
    return runs


def _with_leads(
    setter: Setter, formulas: Sequence[Sequence[Set | Scalar]], line: SetLine
) -> list[tuple[float, Sequence[Set | Scalar]]]:
    """(room on the left, sides): neighbours share the room; 0 where the left side is too wide."""
    own = [lead_of(setter, sides, line) for sides in formulas]
    found = []
    for is_narrow, group in groupby(range(len(own)), key=lambda i: own[i] > 0):
        indices = list(group)
        widest = max(own[i] for i in indices) if is_narrow else 0.0
        found += [(widest, formulas[i]) for i in indices]
    return found


def lead_of(setter: Setter, sides: Sequence[Set | Scalar], line: SetLine) -> float:
    """The width of the left side; 0 where it is too wide to stand before the equality sign of a run."""
    width = line.width(_set(setter, sides[0]).tex)
    return width if width <= NARROW * line.room and len(sides) > 1 else 0.0


def rows_of(
    setter: Setter, sides: Sequence[Set | Scalar], line: SetLine = PAPER, lead: float | None = None
) -> list[str]:
    """The rows of one formula: its sides joined by equality signs.

    Args:
        sides: typeset formulas, or scalars.
        lead: the room for the left side, 0 for none before the alignment; by its own width where none is given.
    """
    lead = lead_of(setter, sides, line) if lead is None else lead
    texts = [_set(setter, side).tex for side in sides]
    if lead:
        return _rows_after(texts, line, line.room - lead - EQUALS)
    parts = line.pieces(texts[0], line.room - INDENT)
    for tex in texts[1:]:
        head, *rest = line.pieces(tex, line.room - INDENT - EQUALS)
        parts += [head.after("= ", EQUALS), *rest]
    filled = _filled(parts, line.room)
    return [f"& {filled[0]}", *(rf"&\quad {part}" for part in filled[1:])]


def _rows_after(texts: Sequence[str], line: SetLine, room: float) -> list[str]:
    """left &= right, the right in as many rows as it needs."""
    rows, row, width = [], f"{texts[0]} &=", 0.0
    for number, tex in enumerate(texts[1:]):
        whole = line.width(tex)
        if number and width + EQUALS + whole <= room:
            row, width = f"{row} = {tex}", width + EQUALS + whole
            continue
        if number:
            rows.append(row)
            row = "&="
        filled = _filled(line.pieces(tex, room - INDENT) if whole > room else [LinePiece(tex, whole)], room)
        row = f"{row} {filled[0]}"
        for part in filled[1:]:
            rows.append(row)
            row = rf"&\quad {part}"
        width = whole
    return [*rows, row]


def _set(setter: Setter, side: Set | Scalar) -> Set:
    return side if isinstance(side, Set) else setter.set(side)


def _filled(parts: list[LinePiece], room: float) -> list[str]:
    """The pieces in lines."""
    lines: list[str] = []
    width = 0.0
    for part in parts:
        if lines and width + part.width <= room:
            lines[-1] += f" {_undotted(lines[-1], part.tex)}"
            width += part.width
        else:
            width = part.width + (INDENT if lines else 0)
            lines.append(part.tex)
    return lines


def _undotted(before: str, after: str) -> str:
    """A piece without the dot between factors that only a line's end needs."""
    factor = after.removeprefix(TIMES)
    return after if OVER in before or factor[0].isdigit() else factor


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
