"""Sums of terms -> nodes as a textbook writes them.

Sums of terms -> nodes as a textbook writes them: monomials in a fixed order, each with its shortest waves.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from functools import lru_cache, reduce
from itertools import product
from math import gcd
from operator import and_

from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.polynomials import PowerSum, axes_of, eliminated, power_form, shortest_on
from eomgen.symbolic.exact.quotient import Radical, one_root, powers_in
from eomgen.symbolic.exact.terms import (
    ONE,
    RADIAN,
    AngleSum,
    Key,
    Monomial,
    Terms,
    Wave,
    common_monomial,
    common_number,
    constant,
    inverse,
    terms_times,
    vector_sum,
    wave,
)
from eomgen.symbolic.expression import Fraction, Node, Number, Scalar, tidy
from eomgen.symbolic.print import text_size


class Writer:
    """Writes the terms of one expansion as nodes of its graph."""

    def __init__(self, expansion: Expansion) -> None:
        self.atoms, self.graph, self.positive = expansion.atoms, expansion.graph, expansion.positive
        self._expansion = expansion
        self._written_atoms: dict[int, Scalar] = {}
        self._monomials: dict[Monomial, tuple[Scalar, Scalar]] = {}
        self._roots: dict[tuple[tuple[tuple[Key, Number], ...], ...], Scalar] = {}

    def sum(self, terms: Terms) -> Scalar:
        """The terms added up; those over one divisor share one fraction."""
        parts: dict[Monomial, Terms] = {}
        for (monomial, w), c in terms.items():
            below = tuple((atom, e) for atom, e in monomial if e < 0 and self.atoms.is_a(atom, "sum"))
            above = tuple(item for item in monomial if item not in below)
            parts.setdefault(below, {})[above, w] = c
        total: Scalar = 0
        for below in sorted(parts):
            total = self.graph.add(total, self._quotient(parts[below], below))
        return total

    def _quotient(self, above: Terms, below: Monomial) -> Scalar:
        """The terms over sums; a single one with the root of such a sum under one root: sqrt(g/(M + m))."""
        if len(above) == 1:
            ((monomial, w), c), *_ = above.items()
            merged, root = self._one_root(tuple(sorted((*monomial, *below))))
            if root != 1:
                left = tuple((atom, e) for atom, e in merged if e < 0 and self.atoms.is_a(atom, "sum"))
                rest = tuple(item for item in merged if item not in left)
                return self.graph.div(self.graph.mul(self._polynomial({(rest, w): c}), root), self._divisor(left))
        return self.graph.div(self._polynomial(above), self._divisor(below))

    def factored(self, common: Monomial, rest: Terms) -> Scalar:
        """common * (rest), sines and cosines that every term of the rest holds in front of it."""
        above, below = self._monomial(common)
        return self.graph.div(self.graph.mul(above, self._by_common_waves(rest)), below)

    def _by_common_waves(self, terms: Terms) -> Scalar:
        """sin(theta)*(3*g + 20*R*cos(theta)*theta'^2)"""
        if len(terms) < 2 or any(e < 0 and self.atoms.is_a(a, "sum") for monomial, _ in terms for a, e in monomial):
            return self.sum(terms)
        if not any(w for _, w in terms):
            return self._polynomial(terms)
        written = [(c, monomial, _powers(factors)) for c, monomial, factors in self.written(terms)]
        common = reduce(and_, (powers for _, _, powers in written))
        total: Scalar = 0
        for c, monomial, powers in written:
            total = self.graph.add(total, self.term(c, monomial, _factors(powers - common)))
        return self.graph.mul(self.term(1, (), _factors(common)), total)

    def content(self, *sums: Terms) -> Fraction:
        """The rational number common to every coefficient as written (27/2 cos^2, not 27/4 + 27/4 cos(2 theta))."""
        return common_number(c for terms in sums for c, _, _ in self.written(terms))

    def leads_with_minus(self, terms: Terms) -> bool:
        """True if the first term as written has a minus sign."""
        return bool(terms) and self.written(terms)[0][0] < 0

    def _divisor(self, below: Monomial) -> Scalar:
        product: Scalar = 1
        for atom, e in below:
            product = self.graph.mul(product, self.graph.pow(self._atom(atom), -e))
        return product

    def _polynomial(self, terms: Terms) -> Scalar:
        total: Scalar = 0
        for c, monomial, factors in self.written(terms):
            total = self.graph.add(total, self.term(c, monomial, factors))
        return total

    def written(self, terms: Terms) -> list[tuple[Number, Monomial, Factors]]:
        """(coefficient, monomial, sines and cosines) of each term as it is written."""
        for sphere in self._expansion.unit_quaternions:
            terms = shortest_on(sphere, terms)
        groups: dict[Monomial, dict[Wave, Number]] = {}
        for (monomial, w), c in terms.items():
            groups.setdefault(monomial, {})[w] = c
        return [
            (sign * c, monomial, turned)
            for monomial in sorted(groups, key=self.atoms.place)
            for c, factors in shortest(groups[monomial])
            for sign, turned in (_forward(factors),)
        ]

    def term(self, c: Number, monomial: Monomial, factors: Factors) -> Scalar:
        """c * monomial * sines and cosines"""
        above, below = self._monomial(monomial)
        for kind, angle, e in factors:
            above = self.graph.mul(above, self.graph.pow(self.atoms.wave_node(kind, angle), e))
        return self.graph.mul(c, self.graph.div(above, below))

    def _atom(self, atom: int) -> Scalar:
        """The atom, the arguments of a function written out."""
        if atom not in self._written_atoms:
            opaque = self.atoms.opaque.get(atom)
            node: Scalar = self.atoms.nodes[atom]
            if opaque is not None:
                arguments = [self.sum(a) for a in opaque.arguments]
                node = arguments[0] if opaque.op == "sum" else self._applied(opaque.op, arguments)
            self._written_atoms[atom] = node
        return self._written_atoms[atom]

    def _monomial(self, monomial: Monomial) -> tuple[Scalar, Scalar]:
        """(numerator, denominator)"""
        if monomial not in self._monomials:
            rest, root = self._one_root(monomial)
            above, below = self.atoms.monomial_nodes(rest, {atom: self._atom(atom) for atom, _ in rest if atom >= 0})
            self._monomials[monomial] = self.graph.mul(above, root), below
        return self._monomials[monomial]

    def _one_root(self, monomial: Monomial) -> tuple[Monomial, Scalar]:
        """(the rest, all roots as one): sqrt(2) sqrt(g) sqrt(l)/l = sqrt(2 g/l), sqrt(4 a + 2) = sqrt(2 (2 a + 1))."""
        exponents = dict(monomial)
        roots = [atom for atom in exponents if self.atoms.is_a(atom, "sqrt")]
        if not roots:
            return monomial, 1
        found: list[Terms] = [constant(-atom) for atom in exponents if atom < 0]
        for atom in roots:
            inside = self.atoms.opaque[atom].arguments[0]
            under = self.atoms.nodes[atom].args[0]
            if type(under) is Node and exponents.get(under.index, 0) < 0 and self._may_divide_root(under.index):
                exponents[under.index] += 1
                inside = self._expansion.reciprocal(inside)
            found.append(inside)
        rest = tuple((atom, e) for atom, e in sorted(exponents.items()) if e and atom >= 0 and atom not in roots)
        return rest, self._root(tuple(found))

    def _may_divide_root(self, atom: int) -> bool:
        """True if sqrt(f)/f may be written 1/sqrt(f): f is a positive symbol, or a sum."""
        return atom in self.positive or self.atoms.is_a(atom, "sum")

    def _root(self, found: tuple[Terms, ...]) -> Scalar:
        """The square roots of all these as one, squares in front of the root."""
        key = tuple(tuple(sorted(f.items())) for f in found)
        if key not in self._roots:
            radical = one_root(self._expansion, constant(1), constant(1), found)
            self._roots[key] = self._apart(found) if radical is None else self.radical(radical)
        return self._roots[key]

    def _apart(self, found: tuple[Terms, ...]) -> Scalar:
        product: Scalar = 1
        for f in found:
            product = self.graph.mul(product, self.graph.sqrt(self.sum(f)))
        return product

    def radical(self, x: Radical) -> Scalar:
        """above/below |bare| sqrt(...)"""
        graph = self.graph
        bare = self._size(graph.div(self.in_factors(x.bare_above), self.in_factors(x.bare_below)))
        sign = -1 if x.number < 0 else 1
        above, below = self._product(({ONE: sign}, *x.under_above)), self._product(x.under_below)
        number = abs(Fraction(x.number))
        if above == 1 and number.numerator == 1 and type(below) is Node:
            root = graph.div(1, graph.sqrt(graph.mul(number.denominator, below)))
        else:
            root = graph.sqrt(graph.mul(tidy(number), graph.div(above, below)))
        outside = graph.mul(self.in_factors(x.above), graph.mul(bare, root))
        return graph.div(outside, self.in_powers(x.below))

    def _size(self, x: Scalar) -> Scalar:
        """|x|; x or -x of a number without symbols."""
        sign = self._expansion.sign_of_constant(x)
        return self.graph.call("abs", x) if sign is None else self.graph.mul(sign, x)

    def _product(self, parts: tuple[Terms, ...]) -> Scalar:
        """The product, or what comes of multiplying it out where that is no longer."""
        product: Scalar = 1
        total = constant(1)
        for part in parts:
            product = self.graph.mul(product, self.in_factors(part))
            total = self._expansion.product(total, part)
        whole = self.in_factors(total)
        return whole if text_size(whole) <= text_size(product) else product

    def in_powers(self, terms: Terms) -> Scalar:
        """The terms in factors, (4 + 9*cos(theta)^2)^2 as the power that it is."""
        product: Scalar = 1
        for part, e in powers_in(self._expansion, terms):
            product = self.graph.mul(product, self.graph.pow(self.in_factors(part), e))
        return product

    def in_factors(self, terms: Terms) -> Scalar:
        """The terms with what they have in common outside: l*(M + m*sin(theta)^2)."""
        common = common_monomial(terms)
        inverted, factor = inverse(common)
        number = self.content(terms) if len(terms) > 1 else Fraction(1)
        return tidy(number) * self.factored(
            common, terms_times(terms, {(inverted, ()): tidy(Fraction(factor) / number)})
        )

    def _applied(self, op: str, arguments: list[Scalar]) -> Scalar:
        if op == "select":
            return self.graph.select(*arguments)
        if op == "pow":
            return self.graph.pow(arguments[0], arguments[1])
        return self.graph.call(op, *arguments)


def _forward(factors: Factors) -> tuple[int, Factors]:
    """(sign, factors) with the first symbol of every angle positive: sin(-theta) = -sin(theta)."""
    sign, turned = 1, []
    for kind, angle, e in factors:
        if next((c for atom, c in angle if atom != RADIAN), 1) < 0:
            angle = tuple((atom, -c) for atom, c in angle)
            sign *= -1 if kind == "sin" and e % 2 else 1
        turned.append((kind, angle, e))
    return sign, tuple(turned)


def _powers(factors: Factors) -> Counter[tuple[str, AngleSum]]:
    return Counter({(kind, angle): e for kind, angle, e in factors})


def _factors(powers: Counter[tuple[str, AngleSum]]) -> Factors:
    return tuple((kind, angle, e) for (kind, angle), e in powers.items())


def is_rate(x: Node) -> bool:
    """True for a symbol that moves: theta', theta''."""
    return x.op == "symbol" and x.name.endswith("'")


# -------- trigonometric form ----------------------------------------------------------------------------------
# A sum of waves -> the shortest way to write it: 27/2 cos(theta)^2, cos(theta1 - theta2), sin(theta) cos(theta).
#
# Candidates: the waves themselves; powers of sines and cosines with s^2 or c^2 eliminated, angle by angle; powers
# along each direction of the angles (theta1 - theta2 is one), which keeps the energies of long chains short; products
# of two in place of pairs. The candidate with the fewest terms wins, then the one without multiple angles, then the
# one with fewer minus signs.


Waves = dict[Wave, Number]
Factors = tuple[tuple[str, AngleSum, int], ...]  # (function, angle, exponent)
Sum = tuple[tuple[Number, Factors], ...]

MOST_WAVES = 500  # of a sum that is shortened: more are too long to be read either way
MOST_AXES = 6
MOST_PAIRED = 60  # waves among which pairs are sought
MOST_CHOICES = 64  # of forms along the directions, tried all
KEPT = 4096  # sums of which the shortest form is cached


def shortest(waves: Waves) -> Sum:
    """The sum of coefficient * wave, written in as few terms as the candidates allow.

    Args:
        waves: {wave: coefficient}; () is the wave 1.
    """
    if len(waves) > MOST_WAVES or (len(waves) == 1 and not _has_multiple(waves)):
        return _as_waves(waves)
    number = common_number(waves.values())
    if number == 1:
        return _shortest(tuple(sorted(waves.items())))
    found = _shortest(tuple(sorted((w, tidy(c / number)) for w, c in waves.items())))
    return tuple((tidy(number * c), factors) for c, factors in found)


@lru_cache(maxsize=KEPT)
def _shortest(items: tuple[tuple[Wave, Number], ...]) -> Sum:
    """The search itself: one sum comes several times on its way into a formula."""
    waves = dict(items)
    pairs, rest = _paired(waves)
    if not pairs:
        return _without_pairs(waves)
    return _best(_without_pairs(waves), _merged([*pairs, *_without_pairs(rest)]))


def _without_pairs(waves: Waves) -> Sum:
    plain = _as_waves(waves)
    return _best(plain, _by_directions(waves), _in_powers(waves) or plain, _by_support(waves))


def _best(*candidates: Sum) -> Sum:
    """The shortest, the first of those that are equally short."""
    fewest = min(map(len, candidates))
    left = [candidate for candidate in candidates if len(candidate) == fewest]
    return left[0] if len(left) == 1 else min(left, key=_length)


def _length(terms: Sum) -> tuple[int, int, int, int]:
    multiple = sum(1 for _, factors in terms if any(_is_multiple(k) for _, k, _ in factors))
    negative = sum(1 for c, _ in terms if c < 0)
    return len(terms), multiple, negative, sum(e for _, factors in terms for _, _, e in factors)


@lru_cache(maxsize=KEPT)
def _is_multiple(k: AngleSum) -> bool:
    return k[0][0] >= 0 and gcd(*(c.numerator for _, c in k)) > 1


def _has_multiple(waves: Waves) -> bool:
    return any(w and _is_multiple(w[1]) for w in waves)


def _as_waves(waves: Waves) -> Sum:
    return tuple((c, ((w[0], w[1], 1),) if w else ()) for w, c in sorted(waves.items()))


# -- along directions ---------------------------------------------------------------------------


def _by_directions(waves: Waves) -> Sum:
    """Powers of cos and sin of one combination of angles each: cos(2a - 2b) = 2 cos(a - b)^2 - 1."""
    directions: dict[AngleSum, Waves] = {}
    for w, c in waves.items():
        if w:
            directions.setdefault(_direction(w[1]), {})[w] = c
    forms = [_forms(rays) for rays in directions.values()]
    best: Sum | None = None
    count = 1
    for options in forms:
        count *= len(options)
    choices = product(*forms) if count <= MOST_CHOICES else [[min(options, key=_size_of_form) for options in forms]]
    for choice in choices:
        number: Number = waves.get((), 0)
        rest: list[tuple[Number, Factors]] = []
        for shift, terms in choice:
            number = tidy(number + shift)
            rest += terms
        candidate = ((number, ()), *rest) if number else tuple(rest)
        if best is None or _length(candidate) < _length(best):
            best = candidate
    return best if best is not None else _as_waves(waves)


Form = tuple[Number, Sum]  # a plain number and the other terms


def _size_of_form(form: Form) -> tuple[int, int, int, int]:
    return _length(form[1])


def _forms(rays: Waves) -> list[Form]:
    """The waves of one direction: as they are, with s^2 eliminated, and with c^2 eliminated."""
    forms: list[Form] = [(0, _as_waves(rays))]
    if _is_one_axis({w[1] for w in rays if w}):
        return forms
    polynomial, axes = _polynomial(rays) or ({}, ())
    if axes and any(_is_multiple(w[1]) or w[1] != axes[0] for w in rays if w):
        for keep in ("cos", "sin"):
            reduced = eliminated(polynomial, 0, keep)
            rest = {powers: c for powers, c in reduced.items() if any(powers)}
            forms.append((reduced.get((0, 0), 0), _as_sum(rest, axes)))
    return forms


def _is_one_axis(angles: set[AngleSum]) -> bool:
    """True if all angles are a single one, which is no whole multiple of a shorter one."""
    return len(angles) == 1 and gcd(*(c.numerator for k in angles for _, c in k)) == 1


def _direction(k: AngleSum) -> AngleSum:
    """k divided by the largest number that leaves whole multiples."""
    common = common_number(c for _, c in k)
    return tuple((angle, tidy(c / common)) for angle, c in k)


# -- in pairs ---------------------------------------------------------------------------------


def _paired(waves: Waves) -> tuple[list[tuple[Number, Factors]], Waves]:
    """(products, the other waves): cos(b) + cos(2 a + b) = 2 cos(a) cos(a + b), and so on, where that is whole."""
    products: list[tuple[Number, Factors]] = []
    rest = dict(waves)
    ordered = sorted(w for w in waves if w)[:MOST_PAIRED]
    for i, v in enumerate(ordered):
        for w in ordered[i + 1 :]:
            if v in rest and w in rest and v[0] == w[0] and abs(rest[v]) == abs(rest[w]):
                product = _product_of_pair(v[0], v[1], w[1], rest[v], rest[v] == rest[w])
                if product is not None:
                    products.append(product)
                    del rest[v], rest[w]
    return products, rest


def _product_of_pair(kind: str, k: AngleSum, l: AngleSum, c: Number, same: bool) -> tuple[Number, Factors] | None:
    """c (f(k) + f(l)), or c (f(k) - f(l)) where not `same`, as one product; None where (k + l)/2 is not whole."""
    halves = [tuple((angle, tidy(Fraction(m) / 2)) for angle, m in vector_sum(k, l, sign)) for sign in (1, -1)]
    if not all(halves) or any(type(m) is not int or angle < 0 for half in halves for angle, m in half):
        return None
    if kind == "cos":
        functions = ("cos", "cos") if same else ("sin", "sin")
    else:
        functions = ("sin", "cos") if same else ("cos", "sin")
    c = 2 * c if same or kind == "sin" else -2 * c
    factors = []
    for function, half in zip(functions, halves, strict=True):
        (name, vector), sign = _named(wave(function, half))
        c *= sign
        factors.append((name, vector, 1))
    return tidy(c), tuple(sorted(factors))


def _named(found: tuple[Wave, int]) -> tuple[tuple[str, AngleSum], int]:
    """A wave that is not 1."""
    w, sign = found
    assert w
    return w, sign


# -- by the angles that occur together --------------------------------------------------------


def _by_support(waves: Waves) -> Sum:
    """The waves that hold the same angles together in powers, part by part."""
    parts: dict[tuple[int, ...], Waves] = {}
    for w, c in waves.items():
        parts.setdefault(tuple(angle for angle, _ in w[1]) if w else (), {})[w] = c
    if len(parts) == 1:
        return _as_waves(waves)  # in one part it is what the other candidates are
    terms: list[tuple[Number, Factors]] = []
    for part in parts.values():
        plain = _as_waves(part)
        alone = len(part) == 1 and not _has_multiple(part)
        terms += plain if alone else _best(plain, _by_directions(part), _in_powers(part) or plain)
    return _merged(terms)


def _merged(terms: Iterable[tuple[Number, Factors]]) -> Sum:
    total: dict[Factors, Number] = {}
    for c, factors in terms:
        total[factors] = tidy(total.get(factors, 0) + c)
    return tuple((c, factors) for factors, c in sorted(total.items()) if c)


# -- in powers ---------------------------------------------------------------------------------


def _in_powers(waves: Waves) -> Sum | None:
    """Everything in powers of sines and cosines of the axes; None where that is too large."""
    found = _polynomial(waves)
    if found is None:
        return None
    polynomial, axes = found
    for axis in range(len(axes)):  # it comes with the sines' squares eliminated
        other = eliminated(polynomial, axis, "sin")
        if len(other) < len(polynomial) or (
            len(other) == len(polynomial) and _size_of_powers(other, axes) < _size_of_powers(polynomial, axes)
        ):
            polynomial = other
    return _as_sum(polynomial, axes)


def _size_of_powers(polynomial: PowerSum, axes: tuple[AngleSum, ...]) -> tuple[int, int, int, int]:
    """`_length` of what will be written of it."""
    doubled = [2 * k + i for k, axis in enumerate(axes) if _is_multiple(axis) for i in (0, 1)]
    multiple = sum(any(powers[i] for i in doubled) for powers in polynomial) if doubled else 0
    negative = sum(c < 0 for c in polynomial.values())
    return len(polynomial), multiple, negative, sum(map(sum, polynomial))


def _polynomial(waves: Waves) -> tuple[PowerSum, tuple[AngleSum, ...]] | None:
    axes = axes_of(waves)
    if len(axes) > MOST_AXES:
        return None
    polynomial = power_form(waves, axes)
    return None if polynomial is None else (polynomial, axes)


def _as_sum(polynomial: PowerSum, axes: tuple[AngleSum, ...]) -> Sum:
    """The polynomial's terms, low powers first."""
    terms = []
    for powers in sorted(polynomial, key=lambda powers: (sum(powers), powers)):
        factors: list[tuple[str, AngleSum, int]] = []
        for axis, c, s in zip(axes, powers[::2], powers[1::2], strict=True):
            factors += [(kind, axis, e) for kind, e in (("sin", s), ("cos", c)) if e]
        terms.append((polynomial[powers], tuple(factors)))
    return tuple(terms)
