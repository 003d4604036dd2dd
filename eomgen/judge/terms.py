"""Formulas -> their terms, and what people make of them by mistake.

Formulas -> their terms, and what may stand in them in the place of a name or an angle.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from itertools import chain, combinations

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.judge.diagnosis import (
    EXCHANGED,
    MINUS,
    ODD,
    PLAINEST,
    TERMS,
    UNUSUAL,
    USUAL,
    WELL_KNOWN,
    Mistake,
    simple_factor,
)
from eomgen.mechanics.dynamics import System
from eomgen.model import Dimension
from eomgen.symbolic.exact import legible, readable, written_terms
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    depends_on,
    is_zero,
    linear_terms,
    order,
    over,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import Work, tolerances
from eomgen.symbolic.print import readable_text

FEW = 2  # contributions that are named together
ANGLES = ("1", "rad", "")  # dimensions of angles
MOST_TERMS = 60  # of an equation that is looked at term by term


def terms_of(x: Scalar, positive: frozenset[Node]) -> tuple[Scalar, ...]:
    """The terms of a sum multiplied out, as they are written; () where they are too many."""
    written = written_terms(x, Work.FORMULA, positive) or ()
    return written if len(written) <= MOST_TERMS else ()


LONG = 400  # characters of a term or a difference that is shown


def short_text(x: Scalar, positive: frozenset[Node]) -> str:
    """A scalar in its most legible form; "" where nobody would read it."""
    text = readable_text(legible(x, Work.FORMULA, positive, LONG)) or ""
    return text if len(text) <= LONG else ""


def is_product(t: Scalar, others: Sequence[Scalar]) -> bool:
    """True if a term is the mixed one in the square of a sum: t^2 = 4 a b, but for a cosine of an angle."""
    if type(t) is not Node:
        return False
    square = powers_of(t * t)
    for a, b in combinations([x for x in others if type(x) is Node and x is not t], 2):
        left = powers_of(over(t * t, a * b))
        if square and all(f.op in ("sin", "cos") for f in left):
            return True
    return False


def term_text(x: Scalar) -> str:
    """A term or an angle as a text."""
    return readable_text(readable(x, Work.FORMULA)) or "that is too long to be shown"


def wrong_parameters(held: Iterable[Node], known: Sequence[Node]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """Mistakes in the parameters that are held: (kind of the cause, replacement, in words)."""
    mine = [x for x in known if x in {*held}]
    for x in mine:
        yield "missing_term", {x: 0}, f"{x.name} is left out"
        yield "sign", {x: -x}, f"{x.name} has the wrong sign"
        yield "factor", {x: 2 * x}, f"2*{x.name} stands where {x.name} is meant"
        yield "factor", {x: over(x, 2)}, f"{x.name}/2 stands where {x.name} is meant"
        for y in known:
            if y is not x:
                yield "wrong_quantity", {x: y}, f"{y.name} stands where {x.name} is meant"
                if y in mine and x.name < y.name:
                    yield "wrong_quantity", {x: y, y: x}, f"{x.name} and {y.name} are exchanged"


Powers = dict[Node, Fraction]


def powers_of(x: Scalar) -> Powers:
    """A product as {factor: power}, its number apart; of a root of a product with halves."""
    found: Powers = {}

    def gather(y: Scalar, k: Fraction) -> None:
        if type(y) is not Node:
            return
        if y.op == "neg":
            gather(y.args[0], k)
        elif y.op in ("mul", "div"):
            gather(y.args[0], k)
            gather(y.args[1], k if y.op == "mul" else -k)
        elif y.op == "pow" and type(y.args[1]) is not Node:
            gather(y.args[0], k * Fraction(y.args[1]))
        elif y.op == "sqrt":
            gather(y.args[0], k / 2)
        else:
            found[y] = found.get(y, Fraction(0)) + k

    gather(x, Fraction(1))
    return {f: k for f, k in found.items() if k}


# -- angles ------------------------------------------------------------------------------------------


def angles_in(scalars: Sequence[Scalar]) -> list[Node]:
    """The arguments of sines and cosines."""
    found = [x.args[0] for x in order(scalars) if x.op in ("sin", "cos")]
    return list(dict.fromkeys(x for x in found if type(x) is Node))


def turned_angles(angle: Node, scalars: Sequence[Scalar]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """Mistakes in an angle in scalars: (kind of the cause, replacement of sine and cosine, in words).

    What replaces one of them alone comes first; where the other does not stand there, no more is stated.
    """
    held, seen = {x for x in order(scalars) if x.op in ("sin", "cos")}, list[dict[Node, Scalar]]()
    for kind, mapping, what in sorted(_turned(angle), key=lambda each: len(each[1])):
        there = {x: y for x, y in mapping.items() if x in held}
        if there and there not in seen:
            seen.append(there)
            yield kind, there, what


def _turned(angle: Node) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    graph = angle.graph
    sin, cos = graph.held("sin", (angle,)), graph.held("cos", (angle,))
    yield "wrong_axis", {sin: cos, cos: sin}, "sin and cos of {0} are exchanged: the angle is taken from the other axis"
    axis = "{0} is taken from the other axis"
    yield "wrong_axis", {sin: cos, cos: -sin}, f"cos stands for sin, sin with the opposite sign for cos: {axis}"
    yield "wrong_axis", {sin: -cos, cos: sin}, f"sin stands for cos, cos with the opposite sign for sin: {axis}"
    yield "wrong_axis", {sin: cos}, "cos stands for sin({0}): the angle is taken from the other axis"
    yield "wrong_axis", {cos: sin}, "sin stands for cos({0}): the angle is taken from the other axis"
    yield "sign", {sin: -sin}, "the sign of sin({0}) is wrong"
    yield "sign", {cos: -cos}, "the sign of cos({0}) is wrong"
    for factor, how in ((over(graph.pi, 180), "degrees"), (over(180, graph.pi), "radians")):
        scaled = factor * angle
        mapping = {sin: graph.call("sin", scaled), cos: graph.call("cos", scaled)}
        yield "unit", mapping, f"{{0}} is taken in {how}"
    yield "factor", {cos: 1}, "cos({0}) is left out"
    yield "approximation", {sin: angle, cos: 1}, "sin({0}) and cos({0}) are those of a small angle"
    yield "approximation", {sin: angle}, "sin({0}) is replaced by the angle, as that of a small angle"
    yield "approximation", {sin: 0, cos: 1}, "{0} is taken as zero"
    yield "factor", {sin: 1}, "sin({0}) is left out"
    terms = linear_terms(angle)
    if len(terms) > 1:
        for atom in terms:
            if type(atom) is Node and atom.op == "symbol":
                other = substituted((angle,), {atom: -atom})[0]
                mapping = {sin: graph.call("sin", other), cos: graph.call("cos", other)}
                yield "sign", mapping, f"the sign of {atom.name} in the angle {{0}} is wrong"


def all_turned(angles: Sequence[Node]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """The same for several angles at once."""
    graph = angles[0].graph
    sines, cosines = ([graph.held(op, (x,)) for x in angles] for op in ("sin", "cos"))
    exchanged: dict[Node, Scalar] = {**dict(zip(sines, cosines, strict=True)), **dict(zip(cosines, sines, strict=True))}
    yield "wrong_axis", exchanged, "sin and cos are exchanged: the angles are taken from the other axes"
    small: dict[Node, Scalar] = {**dict(zip(sines, angles, strict=True)), **dict.fromkeys(cosines, 1)}
    yield "approximation", small, "sines and cosines are those of small angles"
    for factor, how in ((over(graph.pi, 180), "degrees"), (over(180, graph.pi), "radians")):
        mapping: dict[Node, Scalar] = {
            graph.held(op, (x,)): graph.call(op, factor * x) for x in angles for op in ("sin", "cos")
        }
        yield "unit", mapping, f"the angles are taken in {how}"


# -------- edits -----------------------------------------------------------------------------------------------
# A formula -> what people make of it by mistake: one place of it changed.
#
# A place is a node of the formula as it was derived or as it is written. Of a product a factor is left out, stands
# once too often or too few, multiplies where it should divide, is another function of its angle; of a sum a term is
# left out, turned, or there with twice or half of it; springs in a row are taken for springs side by side. The
# formula may be an energy before it is differentiated, a force, a row of an equation or an answer: the changes are
# the same.


MOST_PLACES = 80  # nodes of a formula that are looked at
SHOWN = 60  # characters of a place that is stated
WAVES = ("sin", "cos", "tan")


@dataclass(frozen=True)
class Edit:
    """A formula with one mistake in it.

    Args:
        kind: of the cause.
        to: the formulas with the mistake.
        text: what is wrong, to be read behind "in ...".
        rank: how readily it is believed.
    """

    kind: str
    to: ScalarRow
    text: str
    rank: float


@dataclass(frozen=True)
class Edits:
    """Mistakes of one place in formulas.

    Args:
        positive: symbols that stand for positive numbers.
        alike: groups of parameters of one dimension; the ratio of two of them is looked at as a whole.
        also: nodes by which somebody may multiply or divide although they do not stand there.
        dimensions: of every name, as far as they are known.
    """

    positive: Collection[Node] = ()
    alike: Sequence[frozenset[Node]] = ()
    also: Sequence[Node] = ()
    dimensions: Mapping[str, Dimension] = field(default_factory=dict, repr=False, compare=False)

    @staticmethod
    def of_system(system: System) -> Edits:
        """The mistakes that are looked for in formulas of a system."""
        if Edits not in system.found:
            dimensions = system.scope.model.dimensions.found
            groups: dict[str, set[Node]] = {}
            for name, x in system.symbols.parameters.items():
                groups.setdefault(str(dimensions.get(name, name)), set()).add(x)
            alike = tuple(frozenset(group) for group in groups.values() if len(group) > 1)
            parameters = tuple(system.symbols.parameters.values())
            system.found[Edits] = Edits(system.scope.positive, alike, parameters, dimensions)
        found: Edits = system.found[Edits]
        return found

    def of(self, formulas: ScalarRow) -> Iterator[Edit]:
        """Edits of formulas as they are and as they are written, each once; a shared place is changed in all."""
        seen = {formulas}
        for form in dict.fromkeys((formulas, self.written(formulas))):
            for each in self._in_form(form):
                if each.to not in seen:
                    seen.add(each.to)
                    yield each

    def of_answer(self, answer: ScalarRow) -> Iterator[Edit]:
        """Edits of an answer as it is written, which may also be inverted or under a root."""
        for each in self.of(answer):
            yield replace(each, rank=max(each.rank, ODD))
        for x in answer if len(answer) == 1 else ():
            if type(x) is Node:
                yield Edit(
                    "factor", (over(1, x),), "what is above and below is exchanged: its reciprocal stands there", TERMS
                )
                yield Edit("factor", (x * x,), "the root is missing: its square stands there", TERMS)
                if x.op != "sqrt":
                    yield Edit("factor", (x.graph.sqrt(x),), "a root is too many", EXCHANGED)

    def written(self, formulas: ScalarRow) -> ScalarRow:
        """Formulas as people write them."""
        return tuple(legible(x, Work.FORMULA, self.positive, LONG) for x in formulas)

    def _in_form(self, formulas: ScalarRow) -> Iterator[Edit]:
        places = [node for node in order(formulas) if node.args]
        for node in places[-MOST_PLACES:][::-1]:
            where = "" if node in formulas or len(name := term_text(node)) > SHOWN else f" in {name}"
            for kind, other, text, rank in chain(self._of_product(node), _of_sum(node), self._in_series(node)):
                with suppress(DerivationError):  # it has no value there
                    yield Edit(kind, substituted(formulas, {node: other}), text + where, rank)

    def of_term(self, term: Node) -> Iterator[Edit]:
        """Edits of a term of a sum multiplied out: other functions of its angles, too, and factors too many."""
        for kind, other, text, rank in self._of_product(term):
            yield Edit(kind, (other,), text, rank)
        angles = angles_in((term,))
        for angle in angles:
            for kind, mapping, what in turned_angles(angle, (term,)):
                with suppress(DerivationError):
                    rank = EXCHANGED if kind == "factor" else TERMS
                    yield Edit(kind, substituted((term,), mapping), what.format(term_text(angle)), rank)
        if len(angles) > 1:
            for kind, mapping, what in all_turned(angles):
                with suppress(DerivationError):
                    yield Edit(kind, substituted((term,), mapping), what, TERMS)
        held = powers_of(term)
        waves = [term.graph.call(op, x) for x in angles for op in ("sin", "cos")]
        for f in (*self.also, *(x for x in waves if type(x) is Node)):
            if f not in held:
                yield Edit("factor", (term * f,), f"a factor {term_text(f)} is too many", ODD)
                yield Edit("factor", (over(term, f),), f"a division by {term_text(f)} is too many", ODD)

    # -- products --------------------------------------------------------------------------------

    def _of_product(self, x: Node) -> Iterator[tuple[str, Scalar, str, float]]:
        powers = powers_of(x)
        if x.op in ("mul", "div", "pow", "sqrt") or len(powers) > 1:
            for f, k in powers.items():
                name = term_text(f)
                for other in _other_powers(k):
                    if other != k and (len(powers) > 1 or other != 0):
                        yield "factor", x * power(f, other - k), wrong_power(name, k, other), EXCHANGED
                yield from _other_waves(x, f, k)
                yield from _of_square(x, f, k)
            yield from _in_parallel(x, powers)
            for p, q in self._ratios(powers):
                yield from _of_ratio(x, p, q, powers[p])

    def _in_series(self, x: Node) -> Iterator[tuple[str, Scalar, str, float]]:
        """Constants a + b taken for a b/(a + b)."""
        terms = linear_terms(x) if x.op == "add" and {*symbols_of((x,))} <= {*self.also} else {}
        if len(terms) == 2 and None not in terms and all(c == 1 for c in terms.values()):
            a, b = terms
            series = over(a * b, x)  # type: ignore[operator]
            reported = (
                f"{term_text(series)} stands where {term_text(x)} is meant: what adds up is taken to act in series"
            )
            yield "wrong_formula", series, reported, TERMS

    def _ratios(self, powers: Powers) -> Iterator[tuple[Node, Node]]:
        """Parameters of one dimension of which one stands above and one below with the same power."""
        for p, k in powers.items():
            for q, n in powers.items():
                if k > 0 and k == -n and any(p in some and q in some for some in self.alike):
                    yield p, q


def _of_ratio(x: Node, p: Node, q: Node, k: Fraction) -> Iterator[tuple[str, Scalar, str, float]]:
    ratio, name = over(p, q), f"{p.name}/{q.name}"
    yield "factor", x * power(ratio, -k), f"the ratio {name} is missing", EXCHANGED
    yield "factor", x * power(ratio, -2 * k), f"the ratio {name} is turned over: {q.name}/{p.name} stands there", TERMS
    for other in dict.fromkeys((k - 1, k + 1, 2 * k, k / 2)):
        if other > 0 and other != k:
            reported = (f"({name})" + (f"^{n}" if n != 1 else "") for n in (other, k))
            there, meant = reported
            square = ": the square is missing" if 2 * other == k else ""
            yield "factor", x * power(ratio, other - k), f"{there} stands where {meant} is meant{square}", EXCHANGED


def _other_powers(k: Fraction) -> tuple[Fraction, ...]:
    """Powers that people write for a power k, each once."""
    halved = (k / 2,) if (k / 2).denominator <= 2 else ()
    return tuple(dict.fromkeys((Fraction(0), k - 1 if k > 0 else k + 1, k + 1 if k > 0 else k - 1, -k, 2 * k, *halved)))


def _other_waves(x: Node, f: Node, k: Fraction) -> Iterator[tuple[str, Scalar, str, float]]:
    """Another function of the same angle."""
    for op in WAVES if f.op in WAVES else ():
        other = f.graph.call(op, f.args[0])
        if op != f.op and not is_zero(other):
            reported = f"{op} stands for {f.op}({term_text(f.args[0])})"
            reported += ": the angle is taken from the other axis" if "tan" not in (op, f.op) else ""
            yield "wrong_axis", x * power(over(other, f), k), reported, TERMS


def power(x: Scalar, k: Fraction) -> Scalar:
    """x^k, k a multiple of 1/2."""
    if type(x) is not Node:
        return x
    if k.denominator == 1:
        n = int(k)
        return x**n if n >= 0 else over(1, x**-n)
    root: Scalar = x.graph.sqrt(x)
    return power(root, 2 * k)


def wrong_power(name: str, k: Fraction, other: Fraction) -> str:
    """The sentence that x^other stands where x^k is meant."""
    name = f"({name})" if any(c in name for c in " +-*/") and not name.endswith(")") else name
    if other == 0:
        return f"a factor {name} is missing" if k > 0 else f"a division by {name} is missing"
    if k == 0:
        return (
            f"a factor {_with_power(name, other)} is too many"
            if other > 0
            else f"a division by {_with_power(name, -other)} is too many"
        )
    there, meant = (_with_power(name, abs(x)) for x in (other, k))
    if k * other > 0:
        root = ": a root is missing" if k.denominator == 2 and other.denominator == 1 else ""
        square = ": the square is missing" if abs(k) == 2 and abs(other) == 1 else ""
        return f"{there} stands where {meant} is meant{root}{square}"
    does, should = ("multiplies", "divide") if other > 0 else ("divides", "multiply")
    return f"{there} {does} where {meant} should {should}"


def _with_power(name: str, k: Fraction) -> str:
    if k == 1:
        return name
    return f"sqrt({name})" if k == Fraction(1, 2) else f"{name}^{k}" if k.denominator == 1 else f"{name}^({k})"


def _of_square(x: Node, f: Node, k: Fraction) -> Iterator[tuple[str, Scalar, str, float]]:
    """The squares of the terms for the square of their sum."""
    terms = linear_terms(f) if k == 2 and f.op in ("add", "sub") else {}
    if len(terms) > 1:
        squares = sum((c * c * (1 if t is None else t * t) for t, c in terms.items()), start=0)
        reported = f"of the square of {term_text(f)} the product is missing: the squares of its terms alone stand there"
        yield "missing_term", over(x * squares, f * f), reported, TERMS


# -- sums ----------------------------------------------------------------------------------------


def _in_parallel(x: Node, powers: Powers) -> Iterator[tuple[str, Scalar, str, float]]:
    """a b/(a + b) taken for a + b."""
    for f, k in powers.items():
        terms = linear_terms(f) if k == -1 and f.op == "add" else {}
        if len(terms) == 2 and all(n is not None and c == 1 and powers.get(n, 0) >= 1 for n, c in terms.items()):
            a, b = terms
            reported = f"{term_text(f)} stands where {term_text(over(a * b, f))} is meant: what acts in series is added"  # type: ignore[operator]
            yield "wrong_formula", over(x * f * f, a * b), reported, TERMS  # type: ignore[operator]


def _of_sum(x: Node) -> Iterator[tuple[str, Scalar, str, float]]:
    if x.op not in ("add", "sub"):
        return
    terms = linear_terms(x)
    parts: list[Scalar] = [c * node if node is not None else c for node, c in terms.items()]
    for t in parts:
        name, what = term_text(t), "product" if is_product(t, parts) else "term"
        rank = TERMS if len(name) <= SHOWN else ODD
        yield "missing_term", x - t, f"the {what} {name} is missing", rank
        yield "sign", x - 2 * t, f"the sign of the term {name} is wrong", rank
        yield "factor", x + t, f"the term {name} stands with the factor 2", ODD
        yield "factor", x - over(t, 2), f"the term {name} stands with the factor 1/2", ODD


# -------- products --------------------------------------------------------------------------------------------
# Values that a formula has, and should have, at many states -> the simple change that makes the one the other.
#
# What is meant is the formula times a simple product of names, or such a product beside it or in its place, or the
# formula's square, root or reciprocal.


SIGN, NUMBER, PRODUCT, LONGER = 2.5, 2.7, 3.0, 4.5  # how much less than the plainest mistake each is believed
ELSEWHERE, BESIDE, A_RATE = 0.5, 0.7, 1.0  # of a product in its place; beside it; of a rate that is left out
SQUARES = (Fraction(9), Fraction(16), Fraction(1, 9), Fraction(1, 16))  # numbers of which people take twice a power
_EXPONENTS = (  # of two names: powers, how much less they are believed
    *(((k, -k), PRODUCT) for k in (1, -1)),
    *(((k, -k), PRODUCT + ELSEWHERE) for k in (2, -2)),
    *(((k, k), LONGER) for k in (1, -1)),
    *(((k, n), LONGER) for k, n in ((2, -1), (-2, 1), (1, -2), (-1, 2))),
)


@dataclass(frozen=True)
class Amended:
    """The formula that is meant in the place of another.

    Args:
        cost: how much less it is believed than the plainest mistake.
        to: what is meant.
        kind: of the cause.
    """

    cost: float
    to: Scalar
    kind: str


@dataclass(frozen=True)
class Products:
    """Products of names with simple powers.

    Args:
        atoms: the names, and waves of angles.
        values: of each at every state.
    """

    atoms: tuple[Node, ...]
    values: np.ndarray

    @cached_property
    def _known(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Powers of the atoms, cost and values of each product."""
        n = len(self.atoms)
        unit = np.eye(n)
        rows = [np.zeros(n), *(k * unit[i] for k in (1, -1, 2, -2, 0.5, -0.5) for i in range(n))]
        dear = [x.op == "symbol" and x.name.endswith("'") for x in self.atoms]
        costs = [0.0, *(PRODUCT + A_RATE * each for _ in range(2) for each in dear), *[PRODUCT + ELSEWHERE] * 4 * n]
        for i, j in combinations(range(n), 2):
            rows += [k * unit[i] + m * unit[j] for (k, m), _ in _EXPONENTS]
            costs += [cost for _, cost in _EXPONENTS]
        powers = np.array(rows)
        with np.errstate(all="ignore"):
            sizes = np.exp(powers @ np.log(np.abs(self.values)))
            negative = (powers % 2 == 1).astype(int) @ (self.values < 0).astype(int)
        return powers, np.array(costs), np.where(negative % 2 == 1, -sizes, sizes)

    def changes(self, node: Node, own: np.ndarray, needed: np.ndarray, *, inner: bool, forced: bool) -> list[Amended]:
        """The changes by which a node gets the value that is needed.

        Args:
            inner: it is a factor of a product: a number is one of that.
            forced: it holds accelerations, of which nobody takes the wrong sign.
        """
        if np.all(np.abs(needed) <= tolerances.COMPUTED * np.abs(own)):
            return [Amended(PRODUCT, 0, "extra_term")]
        with np.errstate(all="ignore"):
            found = list(other_forms(node, own, needed))
            ratios = list(self._fits(needed / own))
            for k, c in ratios:
                if not (c < 0 and forced) and (k or (c != 1 and not inner)):
                    number = SIGN if c == -1 else NUMBER + _of_number(c)
                    cost = self._cost(k, c) if k else number
                    found.append(Amended(cost, self._product(k, c) * node, self._kind(k, c)))
            if any(k == 0 for k, _ in ratios):
                return found
            for k, c in self._fits(needed):
                if k and self._known[1][k] < LONGER:
                    found.append(Amended(self._cost(k, c) + ELSEWHERE, self._product(k, c), "wrong_quantity"))
            for k, c in self._fits(needed - own) if node.op not in ("mul", "div") else ():
                if k and self._known[1][k] < LONGER:
                    cost = float(self._known[1][k]) + BESIDE + _of_number(abs(c))
                    found.append(Amended(cost, node + self._product(k, c), "missing_term"))
        return found

    def _fits(self, values: np.ndarray) -> Iterator[tuple[int, Fraction]]:
        """(which product, how often) the values are at every state."""
        ratios = values / self._known[2]
        first = ratios[:, :1]
        good = np.all(np.abs(ratios - first) <= tolerances.CARRIED * np.abs(first), axis=1) & (np.abs(first[:, 0]) > 0)
        for k in np.flatnonzero(good):
            c = simple_factor(float(first[k, 0]), WELL_KNOWN**2)
            if c and (max(abs(c.numerator), c.denominator) <= WELL_KNOWN or c in SQUARES):
                yield int(k), c

    def _cost(self, k: int, c: Fraction) -> float:
        """The cost of a product; a wrong sign in addition is a mistake of its own."""
        return float(self._known[1][k]) + _of_number(abs(c)) + (PLAINEST if c < 0 else 0.0)

    def _product(self, k: int, c: Fraction) -> Scalar:
        found: Scalar = c
        for i in np.flatnonzero(self._known[0][k]):
            found = found * power(self.atoms[i], Fraction(float(self._known[0][k][i])))
        return found

    def _kind(self, k: int, c: Fraction) -> str:
        held = [self.atoms[i] for i in np.flatnonzero(self._known[0][k])]
        if len(held) == 2:
            return "wrong_axis" if {x.op for x in held} == {"sin", "cos"} else "wrong_quantity"
        return "sign" if not held and c == -1 else "factor"


def other_forms(node: Node, own: np.ndarray, needed: np.ndarray) -> Iterator[Amended]:
    """Its square, its root, its reciprocal."""
    for value, k in ((own * own, Fraction(2)), (np.sqrt(np.abs(own)), Fraction(1, 2)), (1 / own, Fraction(-1))):
        if np.all(np.abs(value - needed) <= tolerances.CARRIED * np.abs(needed)):
            yield Amended(NUMBER, power(node, k), "factor")


def _of_number(c: Fraction) -> float:
    """The cost of a number, compared with none."""
    size = next((more / 2 for known, more in USUAL if abs(c) in known), UNUSUAL)
    return size + (MINUS if c < 0 else 0.0)


# -------- wrong terms -----------------------------------------------------------------------------------------


Term = tuple[int, Scalar]  # of which row


@dataclass(frozen=True)
class WrongTerms:
    """Possible mistakes in single terms.

    Args:
        edits: what goes wrong in formulas.
        parameters, rates: the names that may stand in the place of one another.
        owner: whose rows these are, in words; "" where they are the equations.
        body, force: whose it is.
    """

    edits: Edits
    parameters: Sequence[Node]
    rates: Collection[Node]
    owner: str = ""
    body: str = ""
    force: str = ""

    def in_rows(self, rows: Sequence[Scalar], known: Collection[Term] = ()) -> Iterator[Mistake]:
        """Mistakes in the terms of each row, one by one.

        Args:
            known: terms that are looked at already.
        """
        for k, row in enumerate(rows):
            terms = terms_of(row, frozenset(self.edits.positive))
            for term in terms:
                if (k, term) not in known:
                    yield from self._of_term(term, k, len(rows), terms)

    def _of_term(self, term: Scalar, k: int, number: int, terms: Sequence[Scalar]) -> Iterator[Mistake]:
        alone = len(terms) == 1
        name = f"the {'product' if is_product(term, terms) else 'term'} {term_text(term)}"
        name = f"{name} of {self.owner}" if self.owner and not alone else self.owner or name
        if not alone:
            squared = [u for u in self.rates if depends_on(term, (u,))]
            kind = "coriolis" if len(squared) == 2 else "factor"
            yield Mistake(name, kind, _row(term, k, number), TERMS, self.body, self.force)
        if type(term) is not Node:
            return
        for each in self.edits.of_term(term):
            yield self._changed(name, each.kind, each.to[0] - term, each.text, each.rank, k, number)
        for kind, mapping, what in wrong_parameters(symbols_of((term,)), self.parameters):
            if kind == "wrong_quantity":
                yield from self._replaced(name, term, kind, mapping, what, EXCHANGED, k, number)
        held = [u for u in self.rates if depends_on(term, (u,))]
        for u in held:
            for w in self.rates:
                if w is not u:
                    what = f"{w.name} stands where {u.name} is meant"
                    yield from self._replaced(name, term, "wrong_quantity", {u: w}, what, ODD, k, number)
                    for other, of in ((u + w, "it is no relative one"), (u - w, "it is a relative one")):
                        what = f"{term_text(other)} stands where {u.name} is meant: {of}"
                        yield from self._replaced(name, term, "wrong_quantity", {u: other}, what, ODD, k, number)

    def throughout(self, rows: Sequence[Scalar]) -> Iterator[Mistake]:
        """Mistakes throughout a row: in angles and parameters."""
        for k, row in enumerate(rows):
            whole = sum(terms_of(row, frozenset(self.edits.positive)), start=0)
            if type(whole) is not Node:
                continue
            for angle in angles_in((whole,)):
                for kind, mapping, what in turned_angles(angle, (whole,)):
                    reported = what.format(term_text(angle))
                    yield from self._replaced("everything", whole, kind, mapping, reported, EXCHANGED, k, len(rows))
            for kind, mapping, what in wrong_parameters(symbols_of((whole,)), self.parameters):
                rank = EXCHANGED if kind == "wrong_quantity" else ODD
                yield from self._replaced("everything", whole, kind, mapping, what, rank, k, len(rows))

    def _replaced(
        self, name: str, x: Scalar, kind: str, mapping: Mapping[Node, Scalar], what: str, rank: float, k: int, n: int
    ) -> Iterator[Mistake]:
        with suppress(DerivationError):  # it has no value there
            yield self._changed(name, kind, substituted((x,), mapping)[0] - x, what, rank, k, n)

    def _changed(self, name: str, kind: str, by: Scalar, what: str, rank: float, k: int, n: int) -> Mistake:
        text = f"in {name} {what}"
        return Mistake(name, kind, _row(by, k, n), rank, self.body, self.force, open=False, text=text)


def _row(x: Scalar, place: int, number: int) -> tuple[Scalar, ...]:
    return tuple(x if j == place else 0 for j in range(number))
