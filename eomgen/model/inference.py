"""Expression -> its dimension, by unification: what is not declared is an unknown, every sum an equation.

    [a + b]: [a] = [b]      [a b] = [a] [b]      [a^n] = n [a]      sin a, exp a: [a] = 1

A dimension is a product of powers of m, kg, s, A, K and of unknowns; an equation between two is linear in the
exponents. Angles are numbers. A plain number fits anything: it is an unknown of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field, replace
from itertools import count
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.model.quantities import Unit
from eomgen.symbolic.expression import Call, Expression, Fraction, Sampled, is_exact, token_at

BASE = ("kg", "m", "s", "A", "K")
LARGEST_COEFFICIENT = 12  # of a number that textbooks write before parameters: 1/2 k x^2, 4/3 r, m l^2/12
ROUND = (5, 10)  # more often a value, as of g, than a coefficient
TIME = frozenset(("t", "pi"))
KEEPS = ("abs",)
ALL_SAME = ("min", "max")
_KNOWN = {
    (1, 1, -2, 0, 0): "N",
    (1, 2, -2, 0, 0): "N*m",
    (1, 0, -2, 0, 0): "N/m",
    (1, 0, -1, 0, 0): "N*s/m",
    (1, -1, -2, 0, 0): "Pa",
    (1, 2, -3, 0, 0): "W",
    (1, 2, -3, -1, 0): "V",
    (1, 2, -3, -2, 0): "ohm",
    (1, 2, -2, -2, 0): "H",
    (-1, -2, 4, 2, 0): "F",
    (1, 2, -2, -1, 0): "N*m/A",
    (1, 2, -4, -1, 0): "V/s",
    (1, 1, -2, -1, 0): "N/A",
}


class Dimension(dict[Any, Fraction]):
    """The exponents of m, kg, s, A, K and of unknowns; none is 0."""

    def times(self, other: Mapping[Any, Fraction], power: Any = 1) -> Dimension:
        """self * other^power."""
        found = dict(self)
        for base, n in other.items():
            found[base] = found.get(base, 0) + n * power
        return Dimension({base: n for base, n in found.items() if n})

    def raised(self, power: Any) -> Dimension:
        return Dimension().times(self, power)

    @classmethod
    def of_time(cls) -> Dimension:
        """The second."""
        return cls({"s": Fraction(1)})

    @property
    def unknowns(self) -> list[Any]:
        return [base for base in self if base not in BASE]

    def __str__(self) -> str:
        """The dimension as a unit: N*m, kg/s^2; 1 of a number; unknowns by their names in brackets."""
        known = tuple(self.get(base, 0) for base in BASE)
        bases = [] if known in _KNOWN else [(base, self[base]) for base in BASE if base in self]
        bases += [(f"[{base[0]}]" if isinstance(base, tuple) else "[?]", self[base]) for base in self.unknowns]
        above = ([_KNOWN[known]] if known in _KNOWN else []) + [_power(base, n) for base, n in bases if n > 0]
        below = [_power(base, -n) for base, n in bases if n < 0]
        under = f"/({'*'.join(below)})" if len(below) > 1 else f"/{below[0]}" if below else ""
        return ("*".join(above) or "1") + under


def _power(base: str, n: Any) -> str:
    return base if n == 1 else f"{base}^{n}" if Fraction(n).denominator == 1 else f"{base}^({n})"


NUMBER = Dimension()
SECOND = Dimension.of_time()


_KINDS = {
    (): "a number",
    (("m", 1),): "a length",
    (("kg", 1),): "a mass",
    (("s", 1),): "a time",
    (("m", 1), ("s", -1)): "a velocity",
    (("m", 1), ("s", -2)): "an acceleration",
    (("s", -1),): "an angular velocity",
    (("kg", 1), ("m", 1), ("s", -2)): "a force",
    (("kg", 1), ("m", 2), ("s", -2)): "a moment or an energy",
    (("A", 1),): "a current",
    (("kg", 1), ("m", 2), ("s", -3), ("A", -1)): "a voltage",
    (("K", 1),): "a temperature",
    (("kg", 1), ("m", -1), ("s", -2)): "a pressure",
}
KINDS: dict[frozenset[tuple[Any, Any]], str] = {frozenset(powers): kind for powers, kind in _KINDS.items()}
"""What a dimension is called, where it has a name."""


def dimension_of_unit(unit: Unit) -> Dimension:
    """Dimension of a declared unit."""
    return Dimension(
        {base: Fraction(n) for base, n in zip(("m", "kg", "s", "A", "K"), unit.dimension, strict=True) if n}
    )


class Inference:
    """Equations between dimensions, solved for the unknown ones; grows by every equation."""

    def __init__(self) -> None:
        self._solved: dict[Any, Dimension] = {}
        self._fresh = count()

    def unknown(self) -> Dimension:
        """A dimension of which nothing is known."""
        return Dimension({next(self._fresh): Fraction(1)})

    @staticmethod
    def named(name: str) -> Dimension:
        """The unknown dimension of a name."""
        return Dimension({(name,): Fraction(1)})

    def reduced(self, dimension: Dimension) -> Dimension:
        """The dimension with the known values of its unknowns substituted."""
        for base in [base for base in dimension if base in self._solved]:
            power = dimension[base]
            dimension = dimension.times({base: -power}).times(self._settled(base), power)
        return dimension

    def _settled(self, base: Any) -> Dimension:
        """The known value of an unknown, in unknowns that have none; cached, so that a long chain is followed once."""
        open_ = [base]
        while open_:
            known = self._solved[open_[-1]]
            deeper = [
                other
                for other in known
                if other in self._solved and any(x in self._solved for x in self._solved[other])
            ]
            if deeper:
                open_ += deeper
                continue
            found = known
            for other in [other for other in known if other in self._solved]:
                found = found.times({other: -known[other]}).times(self._solved[other], known[other])
            self._solved[open_.pop()] = found
        return self._solved[base]

    def equal(self, a: Dimension, b: Dimension) -> bool:
        """Makes two dimensions one, if they can be; numbers of the text give way before names."""
        ratio = self.reduced(a.times(b, -1))
        unknowns = sorted(ratio.unknowns, key=lambda base: isinstance(base, tuple))
        if not unknowns:
            return not ratio
        base = unknowns[0]
        self._solved[base] = ratio.times({base: -ratio[base]}).raised(-1 / ratio[base])
        return True


@dataclass(frozen=True)
class Term:
    """A piece of an expression: its dimension, and its code from `first` up to `last`.

    Args:
        names: that stand in it.
        numbers: the unknowns of the coefficients among its factors.
        bare: it is made of plain numbers and of functions such as the sine alone.
    """

    dimension: Dimension
    first: int
    last: int
    names: frozenset[str] = frozenset()
    numbers: tuple[Dimension, ...] = ()
    bare: bool = False


@dataclass(frozen=True)
class Place:
    """A stretch of a text."""

    column: int
    text: str


@dataclass(frozen=True)
class Clash:
    """Two terms that ought to have one dimension and have not.

    Args:
        one, other: the terms; other None: what the place needs is in `needed`.
        needed: the dimension that `one` ought to have.
        in_function: that takes numbers only, or arguments of one dimension; "" elsewhere.
    """

    one: Place
    one_is: Dimension
    needed: Dimension
    other: Place | None = None
    in_function: str = ""
    names: frozenset[str] = frozenset()
    fix: str = ""

    @property
    def what(self) -> str:
        if self.in_function and self.other is None:
            return f"{self.in_function} of {kind_of(self.one_is)}: {quoted(self.one)} is {in_words(self.one_is)}"
        if self.other is None:
            return f"{quoted(self.one)} is {in_words(self.one_is)}, and {in_words(self.needed)} is needed"
        two = f"{quoted(self.other)} is {in_words(self.needed)}, {quoted(self.one)} {in_words(self.one_is)}"
        joined = f"do not fit together in {self.in_function}" if self.in_function else "have no sum"
        return f"{kind_of(self.needed)} and {kind_of(self.one_is)} {joined}: {two}"


def quoted(place: Place) -> str:
    return f"'{place.text}'"


def in_words(dimension: Dimension) -> str:
    """ "in N*m", "a number"."""
    return f"in {dimension}" if dimension else "a number"


def kind_of(dimension: Dimension) -> str:
    """ "a length", "a mass", "kg*m"."""
    known: frozenset[tuple[Any, Any]] = frozenset(dimension.items())
    return KINDS.get(known, str(dimension))


@dataclass
class Walk:
    """One pass over an expression.

    Args:
        names: the dimension of each name.
        calls: of a function of the motion; None: not known.
        declared: the parameters that have a unit.
        moves: the names that have rates.
        strict: True if small numbers next to declared parameters are coefficients, without a dimension.
        fixes: True if a fix is sought.
    """

    names: Callable[[str], Dimension]
    inference: Inference
    calls: Callable[[Call], Dimension | None] = lambda call: None
    declared: frozenset[str] = frozenset()
    moves: frozenset[str] = frozenset()
    strict: bool = False
    fixes: bool = True
    clashes: list[Clash] = field(default_factory=list)

    def of(self, expression: Expression, source: str | None = None, needed: Dimension | None = None) -> Dimension:
        """The dimension of an expression; what does not fit is among the clashes.

        Args:
            source: the text in which its columns count; None: its own.
            needed: the dimension that it must have.
        """
        self._expression, self._source = expression, expression.text if source is None else source
        stack: list[Term] = []
        for k, (kind, what) in enumerate(expression.code):
            self._step(stack, k, kind, what)
        whole = self._finished(stack[0])
        if needed is not None and not self.inference.equal(whole.dimension, needed):
            self._clash(whole, needed)
        return whole.dimension

    def _step(self, stack: list[Term], k: int, kind: str, what: Any) -> None:
        if kind in ("number", "name", "call"):
            stack.append(self._leaf(k, kind, what))
        elif kind == "part":
            stack.append(replace(stack[-1 - what], first=k, last=k))
        elif kind == "under":
            del stack[-1 - len(what) : -1]
        elif kind == "neg":
            stack[-1] = replace(stack[-1], last=k)
        elif kind == "sampled":
            stack[-1] = Term(self._of_samples(what, stack[-1], k), stack[-1].first, k)
        elif kind == "function":
            name, number = what
            stack[-number:] = [self._function(name, stack[-number:], k)]
        else:
            b = stack.pop()
            stack[-1] = {"^": self._power, "*": self._product, "/": self._product}.get(kind, self._sum)(
                stack[-1], b, k, kind
            )

    def _leaf(self, k: int, kind: str, what: Any) -> Term:
        if kind == "name" and what != "pi":
            return Term(self.names(what), k, k, frozenset((what,)))
        if kind == "call":
            return Term(self.calls(what) or self.inference.unknown(), k, k)
        if self._expression.columns[k] < 0 and len(self._expression.code) > 1:  # a factor of a unit
            return Term(NUMBER, k, k)
        free = self.inference.unknown()
        small = kind == "name" or (is_exact(what) and _is_coefficient(what))
        return Term(free, k, k, numbers=(free,) if small else (), bare=True)

    def _product(self, a: Term, b: Term, k: int, kind: str) -> Term:
        dimension = a.dimension.times(b.dimension, 1 if kind == "*" else -1)
        return Term(dimension, a.first, k, a.names | b.names, (*a.numbers, *b.numbers), a.bare and b.bare)

    def _sum(self, a: Term, b: Term, k: int, kind: str) -> Term:
        a, b = self._finished(a), self._finished(b)
        if not self.inference.equal(a.dimension, b.dimension):
            self._clash(b, a.dimension, a)
        return Term(a.dimension, a.first, k, a.names | b.names, bare=a.bare and b.bare)

    def _power(self, a: Term, b: Term, k: int, kind: str) -> Term:
        exponent = _value(self._expression.code[b.first : b.last + 1])
        if is_exact(exponent):
            return Term(a.dimension.raised(Fraction(exponent)), a.first, k, a.names, a.numbers, a.bare)
        if not self.inference.equal(self._finished(b).dimension, NUMBER):
            self._clash(b, NUMBER, function="an exponent")
        moving = any(name.rstrip("'") in self.moves or name == "t" for name in b.names)
        if moving and not self.inference.equal(self._finished(a).dimension, NUMBER):
            self._clash(a, NUMBER, function="a power")
        return Term(NUMBER if moving else self.inference.unknown(), a.first, k, a.names | b.names)

    def _of_samples(self, sampled: Sampled, argument: Term, k: int) -> Dimension:
        """The dimension of a table's value; of a function of time nothing is known here."""
        at, unit = (dimension_of_unit(Unit.parse(text)) if text else None for text in sampled.units)
        if at is not None and not self.inference.equal(self._finished(argument).dimension, at):
            self._clash(argument, at, function=sampled.name)
        return self.inference.unknown() if unit is None else unit

    def _function(self, name: str, args: list[Term], k: int) -> Term:
        first, args = args[0].first, [self._finished(a) for a in args]
        names = frozenset[str]().union(*(a.names for a in args))
        if name in KEEPS or name in ALL_SAME or name == "atan2":
            for other in args[1:]:
                if not self.inference.equal(args[0].dimension, other.dimension):
                    self._clash(other, args[0].dimension, args[0], name)
            return Term(NUMBER if name == "atan2" else args[0].dimension, first, k, names)
        if name == "sqrt":
            return Term(args[0].dimension.raised(Fraction(1, 2)), first, k, names)
        if name != "sign" and not self.inference.equal(args[0].dimension, NUMBER):
            self._clash(args[0], NUMBER, function=name)
        return Term(NUMBER, first, k, names, bare=True)

    def _finished(self, term: Term) -> Term:
        """The term as it enters a sum: 1 - cos(a) is a plain number, t alone counts seconds; both fit any dimension."""
        if term.bare or ("t" in term.names and term.names <= TIME):
            return replace(term, dimension=self.inference.unknown())
        divided = any(kind == "/" for kind, _ in self._code_of(term))
        several = len(term.names) > 1 or not divided  # 0.5/r may be a speed over r
        if self.strict and several and "t" not in term.names and term.names & self.declared:
            for number in term.numbers:
                self.inference.equal(number, NUMBER)
        return term

    def _code_of(self, term: Term) -> tuple[tuple[str, Any], ...]:
        return tuple(self._expression.code[term.first : term.last + 1])

    # -- what does not fit ---------------------------------------------------------------------------

    def _clash(self, term: Term, needed: Dimension, other: Term | None = None, function: str = "") -> None:
        names = (term.names if other is None else term.names | other.names) - TIME
        known = self.inference.reduced
        place, beside = self._place(term), None if other is None else self._place(other)
        fix = "" if function or not self.fixes or known(needed).unknowns else self._fix(known(needed), place)
        self.clashes.append(Clash(place, known(term.dimension), known(needed), beside, function, names, fix))

    def _place(self, term: Term) -> Place:
        """Place of a term in the text, including the brackets that belong to it."""
        text = self._source
        columns = [(c, code) for c, code in zip(self._expression.columns, self._expression.code, strict=True)]
        mine = [c for c, _ in columns[term.first : term.last + 1] if c >= 0]
        if not mine:
            return Place(0, self._expression.text)
        start, end = min(mine), token_at(text, max(mine)).end
        if self._expression.code[term.first][0] == "number" and self._expression.code[term.first][1] < 0:
            start = max(text.rfind("-", 0, start), 0)
        while end < len(text) and text.count("(", start, end) > text.count(")", start, end):
            end += 1
        while start > 0 and text.count(")", start, end) > text.count("(", start, end):
            start -= 1
        return Place(start, text[start:end])

    def _fix(self, needed: Dimension, place: Place) -> str:
        """The same term with one power, or one rate, changed, where that fits and no other such change does."""
        from eomgen.symbolic.expression import parse

        try:
            variants = list(_variants(place.text, self.moves))
        except ExpressionError:  # points of bodies are no names
            return ""
        for candidates in variants:
            fitting = []
            for text in candidates:
                try:
                    walk = replace(self, fixes=False, clashes=[])
                    found = self.inference.reduced(walk.of(parse(text, references=True)))
                except ExpressionError:
                    continue
                if not walk.clashes and found == needed:
                    fitting.append(text)
            if len(fitting) == 1:
                return f"write {fitting[0]}"
        return ""


def _value(code: tuple[Any, ...]) -> Any:
    """The number that a piece of code is, None with names in it."""
    if any(kind in ("name", "call", "part") for kind, _ in code):
        return None
    try:
        return Expression("", code, (0,) * len(code)).evaluate({})
    except ExpressionError:
        return None


def _is_coefficient(value: Any) -> bool:
    exact = abs(Fraction(value))
    return exact <= LARGEST_COEFFICIENT and exact.denominator in (1, 2, 4) and exact not in ROUND


def _variants(text: str, moves: frozenset[str]) -> Iterator[Iterable[str]]:
    """A text with a power taken away, lowered or raised; a square added; a rate for its coordinate and back."""
    tokens = []
    at = token_at(text, 0)
    while at.kind != "end":
        tokens.append(at)
        at = token_at(text, at.end)
    powers = [k for k, token in enumerate(tokens[:-1]) if token.text in ("^", "**") and tokens[k + 1].kind == "number"]
    yield [text[: tokens[k].start] + text[tokens[k + 1].end :] for k in powers]
    changed = [(k, int(tokens[k + 1].text) + d) for k in powers if tokens[k + 1].text.isdigit() for d in (-1, 1)]
    yield [f"{text[: tokens[k + 1].start]}{n}{text[tokens[k + 1].end :]}" for k, n in changed if n > 1]
    names = [token for token in tokens if token.kind == "name"]
    yield [f"{text[: t.end]}'{text[t.end :]}" for t in names if t.text in moves]
    yield [f"{text[: t.end - 1]}{text[t.end :]}" for t in names if t.text.endswith("'")]
    yield [f"{text[: t.end]}^2{text[t.end :]}" for t in names]
