"""Sums of monomials times one sine or cosine: the arithmetic of the normal form.

A term is coefficient * monomial * wave. The monomial is a product of powers of atoms (symbols, roots, other
functions), negative powers too; the wave is 1, cos(k . angles) or sin(k . angles) with a vector k of rational numbers
whose first entry is positive. Products of waves become sums,

    cos a cos b = (cos(a - b) + cos(a + b)) / 2,   and so on,

so a function that is polynomial in sines, cosines and atoms has exactly one such sum, and s^2 = 1 - c^2 needs no rule.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field
from functools import lru_cache
from math import gcd, lcm

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Fraction, Node, Number, Owner, Scalar, tidy

Monomial = tuple[tuple[int, int], ...]  # ((atom's index, exponent), ...) ascending; (-6, 1) stands for sqrt(6)
AngleSum = tuple[tuple[int, Number], ...]  # ((angle's index, multiple), ...) ascending; index -1 is one radian
Wave = tuple[str, AngleSum] | tuple[()]  # ("cos", k), ("sin", k), or () for 1
Key = tuple[Monomial, Wave]
Terms = dict[Key, Number]

ONE: Key = ((), ())
HALF = Fraction(1, 2)


class TooLarge(DerivationError):
    """The work or size needed is beyond its limit."""


def constant(c: Number) -> Terms:
    """The number c."""
    return {ONE: c} if c != 0 else {}


def terms_plus(a: Terms, b: Terms, factor: Number = 1) -> Terms:
    """a + factor b"""
    total = dict(a)
    for key, c in b.items():
        accumulate(total, key, factor * c)
    return total


def accumulate(total: Terms, key: Key, c: Number) -> None:
    """total += c * (the term of this key), in place; a term that vanishes goes."""
    was = total.get(key)
    if was is not None:
        c = was + c
        if not c:
            del total[key]
            return
    if c:
        total[key] = c if type(c) is int else tidy(c)


def terms_scaled(a: Terms, c: Number) -> Terms:
    """c a"""
    return {key: tidy(c * value) for key, value in a.items()} if c != 0 else {}


def terms_times(a: Terms, b: Terms) -> Terms:
    """a b; powers of roots of atoms are not reduced here (only those of numbers are)."""
    for one, other in ((a, b), (b, a)):
        if len(one) == 1 and ONE in one:
            return terms_scaled(other, one[ONE])
    total: Terms = {}
    for (m, w), c in a.items():
        for (n, v), d in b.items():
            monomial, factor = monomial_product(m, n) if m and n else (m or n, 1)
            product = c * d if factor == 1 else factor * c * d
            if not w or not v:
                accumulate(total, (monomial, w or v), product)
                continue
            for wave, share in wave_product(w, v):
                accumulate(total, (monomial, wave), product * share)
    return total


@lru_cache(maxsize=200_000)
def monomial_product(m: Monomial, n: Monomial) -> tuple[Monomial, int]:
    """(monomial, factor) with m n = factor * monomial; sqrt(6) sqrt(2) = 2 sqrt(3)."""
    if not m:
        return n, 1
    if not n:
        return m, 1
    if m[0][0] < 0 and n[0][0] < 0:
        product, factor = monomial_product(m[1:], n[1:])
        common = gcd(m[0][0], n[0][0])
        inside = m[0][0] * n[0][0] // (common * common)
        return (product if inside == 1 else ((-inside, 1), *product)), common * factor
    exponents = dict(m)
    for atom, e in n:
        exponents[atom] = exponents.get(atom, 0) + e
    return tuple(sorted((atom, e) for atom, e in exponents.items() if e)), 1


@lru_cache(maxsize=200_000)
def wave_product(w: Wave, v: Wave) -> tuple[tuple[Wave, Number], ...]:
    """The product of two waves as a sum: ((wave, coefficient), ...)."""
    if not w or not v:
        return ((w or v, 1),)
    (f, k), (g, l) = w, v
    kind = "cos" if f == g else "sin"
    difference, total = wave(kind, vector_sum(k, l, -1)), wave(kind, vector_sum(k, l, 1))
    sign_difference = -1 if (f, g) == ("cos", "sin") else 1
    sign_total = -1 if (f, g) == ("sin", "sin") else 1
    pairs = ((difference[0], HALF * sign_difference * difference[1]), (total[0], HALF * sign_total * total[1]))
    return tuple((x, c) for x, c in pairs if c != 0)


def vector_sum(k: AngleSum, l: AngleSum, factor: Number) -> AngleSum:
    """k + factor l"""
    entries = dict(k)
    for angle, c in l:
        entries[angle] = entries.get(angle, 0) + factor * c
    return tuple(sorted((angle, tidy(c)) for angle, c in entries.items() if c != 0))


def wave(kind: str, k: AngleSum) -> tuple[Wave, int]:
    """(wave, sign) with kind(k . angles) = sign * wave; sign 0 for sin(0)."""
    if not k:
        return (), 1 if kind == "cos" else 0
    if k[0][1] > 0:
        return (kind, k), 1
    return (kind, tuple((angle, -c) for angle, c in k)), 1 if kind == "cos" else -1


def common_number(numbers: Iterable[Number]) -> Fraction:
    """The largest positive rational number of which all are whole multiples (1 for none)."""
    numbers = list(numbers)
    return Fraction(gcd(*(c.numerator for c in numbers)) or 1, lcm(*(c.denominator for c in numbers)))


def content(a: Terms) -> Fraction:
    """The common number of the coefficients."""
    return common_number(a.values())


def common_monomial(a: Terms) -> Monomial:
    """The product of the lowest powers of every atom, over all terms (an atom missing in a term has power 0)."""
    lowest: dict[int, int] | None = None
    for monomial, _ in a:
        exponents = dict(monomial)
        if lowest is None:
            lowest = exponents
            continue
        for atom in list(lowest):
            least = min(lowest[atom], exponents.get(atom, 0))
            if least:
                lowest[atom] = least
            else:
                del lowest[atom]
        for atom, e in monomial:
            if e < 0 and atom not in lowest:
                lowest[atom] = e
    return tuple(sorted((atom, e) for atom, e in (lowest or {}).items() if atom >= 0))


def inverse(m: Monomial) -> tuple[Monomial, Fraction]:
    """(monomial, factor) with 1/m = factor * monomial; 1/sqrt(6) = sqrt(6)/6."""
    factor, inverted = Fraction(1), []
    for atom, e in m:
        if atom < 0:
            factor /= -atom
            inverted.append((atom, 1))
        else:
            inverted.append((atom, -e))
    return tuple(inverted), factor


# -------- atoms -----------------------------------------------------------------------------------------------
# The atoms of sums of terms: which node an index stands for, and terms as nodes again.


RADIAN = -1  # the index of the angle of a plain number: sin(1)
SortKey = tuple[int | Monomial, ...]  # sorts monomials as they are written


@dataclass(frozen=True)
class Opaque:
    """An atom that is no symbol: a function with its canonical arguments ("sum": an f that one divides by)."""

    op: str
    arguments: tuple[Terms, ...]


@dataclass
class Atoms:
    """The atoms of one expansion; it grows while the expansion meets new ones.

    Args:
        graph: owner of the nodes.
        nodes: the node of every atom and angle, by its index.
        opaque: what those atoms are that are no symbols.
        waves: those that were written, as nodes.
        places: of the monomials that were put in order.
    """

    graph: Owner
    nodes: dict[int, Node] = field(default_factory=dict)
    opaque: dict[int, Opaque] = field(default_factory=dict)
    waves: dict[tuple[str, AngleSum], Scalar] = field(default_factory=dict, repr=False)
    places: dict[Monomial, SortKey] = field(default_factory=dict, repr=False)

    def is_a(self, atom: int, op: str) -> bool:
        """True if the atom is an opaque one of this operation."""
        return atom in self.opaque and self.opaque[atom].op == op

    def node(self, terms: Terms) -> Scalar:
        """The sum as a node, in an order that depends on the terms only."""
        total: Scalar = 0
        for key in sorted(terms, key=lambda key: (self.place(key[0]), key[1])):
            total = self.graph.add(total, self.term(key, terms[key]))
        return total

    def place(self, monomial: Monomial) -> SortKey:
        """Accelerations before squares of rates before rates before the rest; then in the order of declaration."""
        if monomial not in self.places:
            self.places[monomial] = self._place(monomial)
        return self.places[monomial]

    def _place(self, monomial: Monomial) -> SortKey:
        moving: tuple[list[tuple[int, int]], list[tuple[int, int]], list[tuple[int, int]]] = ([], [], [])
        for atom, e in monomial:
            moving[min(2, self._primes(atom))].append((atom, -e))
        still, rates, accelerations = moving
        degrees = (sum(e for _, e in accelerations), sum(e for _, e in rates))
        return (*degrees, tuple(accelerations), tuple(rates), tuple(still))

    def _primes(self, atom: int) -> int:
        node = self.nodes.get(atom)
        if node is None or node.op != "symbol":
            return 0
        name: str = node.args[0]
        return len(name) - len(name.rstrip("'"))

    def term(self, key: Key, c: Number) -> Scalar:
        """c * monomial * wave as a node."""
        monomial, w = key
        above, below = self.monomial_nodes(monomial, self.nodes)
        if w:
            above = self.graph.mul(above, self.wave_node(w[0], w[1]))
        return self.graph.mul(c, self.graph.div(above, below))

    def monomial_nodes(self, monomial: Monomial, written: Mapping[int, Scalar]) -> tuple[Scalar, Scalar]:
        """(numerator, denominator) of a monomial, each atom as it is written."""
        above: Scalar = 1
        below: Scalar = 1
        for atom, e in monomial:
            if atom < 0:
                above = self.graph.mul(above, self.graph.sqrt(-atom))
            elif e > 0:
                above = self.graph.mul(above, self.graph.pow(written[atom], e))
            else:
                below = self.graph.mul(below, self.graph.pow(written[atom], -e))
        return above, below

    def wave_node(self, kind: str, k: AngleSum) -> Scalar:
        """cos or sin of k . angles."""
        if (kind, k) not in self.waves:
            self.waves[kind, k] = self.graph.call(kind, self.angle_node(k))
        return self.waves[kind, k]

    def angle_node(self, k: AngleSum) -> Scalar:
        """k . angles"""
        angle: Scalar = 0
        for atom, c in k:
            angle = self.graph.add(angle, c if atom == RADIAN else self.graph.mul(c, self.nodes[atom]))
        return angle
