"""Nodes -> sums of terms (see `terms`): everything multiplied out, waves for products of sines and cosines.

What is no polynomial stays as an atom with canonical arguments: exp(f), abs(f), sqrt(f) with atom^2 = f, and 1/f for a
sum f, an atom with negative powers. The work is bounded: `TooLarge` rather than minutes.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable

from eomgen.errors import DerivationError
from eomgen.resources import check_patience
from eomgen.symbolic.exact.polynomials import reduced_on, square_root
from eomgen.symbolic.exact.terms import (
    HALF,
    ONE,
    RADIAN,
    AngleSum,
    Atoms,
    Key,
    Monomial,
    Opaque,
    Terms,
    TooLarge,
    accumulate,
    common_monomial,
    constant,
    content,
    inverse,
    terms_plus,
    terms_scaled,
    terms_times,
    wave,
)
from eomgen.symbolic.expression import Fraction, Node, Number, Owner, Scalar, order, tidy, united
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

LARGEST_EXPONENT = 64
MOST_TERMS = 2_000  # of a sum: nobody reads a longer one
_TURNS = {  # cos(turn * pi) = coefficient * sqrt(root)
    Fraction(0): (Fraction(1), 1),
    Fraction(1, 6): (HALF, 3),
    Fraction(1, 4): (HALF, 2),
    Fraction(1, 3): (HALF, 1),
    Fraction(1, 2): (Fraction(0), 1),
}


class Expansion:
    """The expanded forms of the nodes of one graph.

    Args:
        graph: owner of the nodes; atoms are nodes of it and are named by their index.
        limit: products of terms that may be made before TooLarge is raised.
        positive: symbols that stand for positive numbers: roots of their squares are taken.
    """

    def __init__(self, graph: Owner, limit: int, positive: Collection[Node] = ()) -> None:
        self.graph, self.limit, self.work = graph, limit, 0
        self.positive = frozenset(x.index for x in positive)
        self.atoms = Atoms(graph)
        self.unit_quaternions = tuple(tuple(x.index for x in symbols) for symbols in graph.unit_quaternions)
        self._known: dict[Node, Terms] = {}
        self._too_long: set[Node] = set()

    def of(self, x: Scalar) -> Terms:
        """x as a sum of terms.

        Raises:
            TooLarge: the limit of work is reached, or a sum has more than MOST_TERMS terms.
        """
        if type(x) is not Node:
            return constant(x)
        for node in order((x,), self._known):
            if node in self._too_long:
                raise TooLarge(f"a sum of more than {MOST_TERMS} terms")
            if node not in self._known:
                self._known[node] = self._bounded(node)
        return self._known[x]

    # -- one node from its arguments ---------------------------------------------------------------

    def _bounded(self, x: Node) -> Terms:
        terms = self._expanded(x)
        if len(terms) > MOST_TERMS:
            self._too_long.add(x)
            raise TooLarge(f"a sum of more than {MOST_TERMS} terms")
        return terms

    def _expanded(self, x: Node) -> Terms:
        op = x.op
        if op in ("symbol", "pi"):
            return self._atom(x)
        parts = [self._known[a] if type(a) is Node else constant(a) for a in x.args]
        if op == "mul":
            return self.product(parts[0], parts[1])
        if op in ("add", "sub"):
            self._spend(len(parts[1]))
            return terms_plus(parts[0], parts[1], 1 if op == "add" else -1)
        if op == "neg":
            return terms_scaled(parts[0], -1)
        if op == "div":
            return self.product(parts[0], self.reciprocal(parts[1]))
        if op in ("sin", "cos"):
            return self._circular(op, parts[0])
        if op == "sqrt":
            return self._root(parts[0])
        if op == "pow" and type(x.args[1]) is int:
            return self.power(parts[0], x.args[1])
        if op == "abs":
            return self._absolute(parts[0])
        if op in ("min", "max"):
            return self._extreme(op, *parts)
        return self._sign(parts[0]) if op == "sign" else self._function(op, tuple(parts))

    def _sign(self, f: Terms) -> Terms:
        """sign(f), without the positive number and symbols that all terms have in common."""
        powers = tuple((atom, e) for atom, e in common_monomial(f) if self._is_positive(atom))
        return self._function("sign", (self._without(f, powers),))

    def _absolute(self, f: Terms) -> Terms:
        """abs(f), outside it what has no sign: the number, even powers that all terms hold, a sum of known sign."""
        if self.all_positive(f):
            return f
        powers = common_monomial(f)
        inside = tuple((atom, odd) for atom, e in powers if (odd := self._odd(atom, e)))
        outside = tuple((atom, e - self._odd(atom, e)) for atom, e in powers if e != self._odd(atom, e))
        rest = self._without(f, powers)
        if (sign := self._known_sign(rest)) is not None:
            outer, rest = terms_scaled(rest, sign), constant(1)
        else:
            outer = constant(1)
        bare = self._function("abs", (terms_times(rest, {(inside, ()): 1}),))
        return self.product({(outside, ()): tidy(content(f))}, self.product(outer, bare))

    def _extreme(self, op: str, a: Terms, b: Terms) -> Terms:
        """min or max of a and b; one of them where it is known which."""
        sign = self._known_sign(terms_plus(a, b, -1))
        if sign is None:
            return self._function(op, (a, b))
        return a if (sign > 0) is (op == "max") else b

    def _known_sign(self, f: Terms) -> int | None:
        """1 where f >= 0 wherever it has a value, -1 where f <= 0; None where that is unknown."""
        above, below = self.cleared(f)
        sign = self._sign_of_sum(above, f)
        for atom, e in below.items():
            if sign is not None and e % 2:
                of_divisor = self._sign_of_sum(self.atoms.opaque[atom].arguments[0], f)
                sign = None if of_divisor is None else sign * of_divisor
        return sign

    def _sign_of_sum(self, f: Terms, whole: Terms) -> int | None:
        """The same of a sum that stands in `whole`, of which no value exists where one of its roots has none."""
        roots = [
            self.atoms.opaque[atom].arguments[0]
            for monomial, _ in whole
            for atom, _ in monomial
            if self.atoms.is_a(atom, "sqrt")
        ]
        for sign in (1, -1):
            if self._is_never_negative(terms_scaled(f, sign)) or terms_scaled(f, sign) in roots:
                return sign
        return self.sign_of_constant(self.atoms.node(f))

    def _is_never_negative(self, f: Terms) -> bool:
        """True if the sum is never negative: of each product of symbols, which is not, the constant factor is at least
        as large as the amplitudes of its sines and cosines together, as in 1 + cos(2 x) >= 0.
        """
        least = self._least(f)
        return least is not None and all(number >= 0 for number in least.values())

    def is_positive(self, f: Terms) -> bool:
        """True if the sum is positive: never negative, and one part of it is always above 0.

        That part is a product of positive symbols whose constant factor is larger than the amplitudes of its sines and
        cosines together: M + m sin(alpha)^2 > 0 for positive M.
        """
        least = self._least(f)
        if least is None or not all(number >= 0 for number in least.values()):
            return False
        return any(number > 0 and all(self._is_sized(atom) for atom, _ in key) for key, number in least.items())

    def _is_sized(self, atom: int) -> bool:
        return atom < 0 or self._is_positive(atom)

    def _least(self, f: Terms) -> dict[Monomial, Number] | None:
        """{monomial: lower bound of its coefficient}; None where a monomial may be negative."""
        least: dict[Monomial, Number] = {}
        for (monomial, w), c in f.items():
            if not self.all_positive({(monomial, ()): 1}):
                return None
            least[monomial] = least.get(monomial, 0) + (-abs(Fraction(c)) if w else c)
        return least

    def sign_of_constant(self, x: Scalar) -> int | None:
        """The sign of a number without symbols, by its value; None for anything else, and for what may be 0."""
        if type(x) is not Node or any(node.op == "symbol" for node in order((x,))):
            return None
        try:
            (value,) = evaluate((x,), {}, fifty_digits())
        except NoValue:
            return None
        return (1 if value > 0 else -1) if abs(value) > tolerances.CERTAIN_AT_50 else None

    def _odd(self, atom: int, e: int) -> int:
        """Exponent of the factor of x^e that has a sign: 0 where x has no sign or e is even; else 1 or -1."""
        return 0 if e % 2 == 0 or self._has_no_sign(atom) else 1 if e > 0 else -1

    def _without(self, f: Terms, powers: Monomial) -> Terms:
        """f over its content and over a monomial that all its terms hold."""
        inverted, _ = inverse(powers)
        return terms_times(f, {(inverted, ()): tidy(1 / content(f))}) if f else f

    def product(self, a: Terms, b: Terms) -> Terms:
        """a b, with atom^2 = f for atoms sqrt(f), and e0^2 = 1 - (the other squares) for symbols on a sphere."""
        self._spend(len(a) * len(b))
        found = self._without_squared_roots(terms_times(a, b))
        for sphere in self.unit_quaternions:
            found = reduced_on(sphere, found)
        return found

    def power(self, a: Terms, n: int) -> Terms:
        """a ** n for a whole n >= 0."""
        if n > LARGEST_EXPONENT:
            raise TooLarge(f"the power {n} is too large to be multiplied out")
        result = constant(1)
        for _ in range(n):
            result = self.product(result, a)
        return result

    def _spend(self, work: int) -> None:
        check_patience()
        self.work += work
        if self.work > self.limit:
            raise TooLarge(f"more than {self.limit} products of terms")

    def _atom(self, x: Node) -> Terms:
        self.atoms.nodes[x.index] = x
        for symbols in self.graph.unit_quaternions:
            if x in symbols:
                self.atoms.nodes |= {symbol.index: symbol for symbol in symbols}
        return {(((x.index, 1),), ()): 1}

    def _function(self, op: str, arguments: tuple[Terms, ...]) -> Terms:
        """An opaque atom op(arguments), the same one for equal arguments."""
        nodes = [self.atoms.node(a) for a in arguments]
        x = self.graph.select(*nodes) if op == "select" else self._applied(op, nodes)
        if type(x) is not Node:
            return constant(x)
        inner = x.args[0] if x.op == "neg" else x
        if inner.op != op:  # folded into something simpler
            return self.of(x)
        if inner is not x:
            arguments = tuple(self.of(a) for a in inner.args)
        self.atoms.opaque[inner.index] = Opaque(op, arguments)
        return terms_scaled(self._atom(inner), -1 if inner is not x else 1)

    def _applied(self, op: str, nodes: list[Scalar]) -> Scalar:
        return self.graph.pow(nodes[0], nodes[1]) if op == "pow" else self.graph.call(op, *nodes)

    def _without_squared_roots(self, a: Terms) -> Terms:
        """The sum with sqrt(f)^2 = f and |f|^2 = f^2."""
        square = {atom: 1 if x.op == "sqrt" else 2 for atom, x in self.atoms.opaque.items() if x.op in ("sqrt", "abs")}
        powers = {item for monomial, _ in a for item in monomial} if square else ()
        high = {(atom, e) for atom, e in powers if atom in square and e // 2 and e != -1}
        if not high:
            return a
        result: Terms = {}
        for (monomial, w), c in a.items():
            squared = [item for item in monomial if item in high]
            if not squared:
                accumulate(result, (monomial, w), c)
                continue
            rest = tuple((atom, e % 2 if (atom, e) in squared else e) for atom, e in monomial)
            part: Terms = {(tuple((atom, e) for atom, e in rest if e), w): c}
            for atom, e in squared:
                whole = self.power(self.atoms.opaque[atom].arguments[0], square[atom] * abs(e // 2))
                part = self.product(part, whole if e > 0 else self.reciprocal(whole))
            result = terms_plus(result, part)
        return result

    def _root(self, f: Terms) -> Terms:
        """sqrt(f): the root of the number times an atom."""
        outside = content(f) if f else Fraction(0)
        root = self.graph.sqrt(outside)
        inside = terms_scaled(f, 1 / outside) if f else f
        outer = self._constant_root(root)
        if self.positive and inside:
            part, inside = self._positive_root(inside)
            outer = self.product(outer, part)
        if inside in ({}, constant(1)):
            return outer
        return terms_times(outer, self._function("sqrt", (inside,)))

    def _positive_root(self, f: Terms) -> tuple[Terms, Terms]:
        """(r, g) with sqrt(f) = r sqrt(g): the roots of positive symbols and sums that all terms hold."""
        powers = tuple((atom, e) for atom, e in common_monomial(f) if self._is_positive(atom))
        inverted, _ = inverse(powers)
        inside = terms_times(f, {(inverted, ()): 1})
        outer = constant(1)
        for atom, e in powers:  # sqrt(p^3) = p sqrt(p)
            if e // 2:
                outer = self.product(outer, {(((atom, e // 2),), ()): 1})
            if e % 2:
                outer = self.product(outer, self._root_of_atom(atom))
        square = square_root(inside) if len(inside) > 1 and self.all_positive(inside) else None
        if square is not None and self.all_positive(square):
            return self.product(outer, square), constant(1)
        return outer, inside

    def _root_of_atom(self, atom: int) -> Terms:
        if self.atoms.is_a(atom, "sum"):
            return self._root(self.atoms.opaque[atom].arguments[0])
        return self._function("sqrt", ({(((atom, 1),), ()): 1},))

    def _is_positive(self, atom: int) -> bool:
        is_sum = self.atoms.is_a(atom, "sum")
        if is_sum:
            return self.all_positive(self.atoms.opaque[atom].arguments[0])
        return atom == self.graph.pi.index or atom in self.positive

    def all_positive(self, f: Terms) -> bool:
        """True if every term is positive."""
        return all(
            c > 0 and w == () and all(a < 0 or e % 2 == 0 or self._has_no_sign(a) for a, e in monomial)
            for (monomial, w), c in f.items()
        )

    def _has_no_sign(self, atom: int) -> bool:
        if self.atoms.is_a(atom, "max"):
            return any(self.all_positive(f) for f in self.atoms.opaque[atom].arguments)
        return self._is_positive(atom) or any(self.atoms.is_a(atom, op) for op in ("sqrt", "exp", "abs"))

    def _constant_root(self, root: Scalar) -> Terms:
        """c sqrt(n), as the graph folds the root of a number, as a term."""
        if type(root) is not Node:
            return constant(root)
        c, node = (root.args[0], root.args[1]) if root.op == "mul" else (1, root)
        return {(((-node.args[0], 1),), ()): c}

    def reciprocal(self, f: Terms) -> Terms:
        """1/f: a term where f is a monomial, else an atom to the power -1."""
        if not f:
            raise DerivationError("division by an expression that is zero")
        if len(f) == 1:
            ((monomial, w), c), *_ = f.items()
            if w == () and all(self._invertible(atom) for atom, _ in monomial):
                inverted, factor = inverse(monomial)
                return {(inverted, ()): tidy(factor / Fraction(c))}
            root = next((atom for atom, _ in monomial if self.atoms.is_a(atom, "sqrt")), None)
            if root is not None:  # 1/(m sqrt(f)) = sqrt(f)/(m f)
                by_root: Terms = {(((root, 1),), ()): 1}
                return self.product(by_root, self.reciprocal(self.product(f, by_root)))
        factor, monomial, primitive = self.primitive(f)
        cleared, denominators = self.cleared(primitive)
        if denominators:  # 1/(a + b/d) = d/(a d + b)
            result = self.reciprocal(cleared)
            for atom, e in denominators.items():
                result = self.product(result, self.power(self.atoms.opaque[atom].arguments[0], e))
        else:
            result = self._inverted_sum(primitive)
        inverted, _ = inverse(monomial)
        return self.product(result, {(inverted, ()): tidy(1 / factor)})

    def _invertible(self, atom: int) -> bool:
        """True if negative and positive powers of the atom are both atoms: not so for sqrt(f) and for sums."""
        return not self.atoms.is_a(atom, "sqrt") and not self.atoms.is_a(atom, "sum")

    def _inverted_sum(self, f: Terms) -> Terms:
        node = self.atoms.node(f)
        assert type(node) is Node
        self.atoms.nodes[node.index] = node
        self.atoms.opaque[node.index] = Opaque("sum", (f,))
        return {(((node.index, -1),), ()): 1}

    def primitive(self, f: Terms) -> tuple[Fraction, Monomial, Terms]:
        """(c, m, g) with f = c m g: whole coefficients without common factor, the first one positive."""
        monomial = tuple((atom, e) for atom, e in common_monomial(f) if self._invertible(atom))
        inverted, _ = inverse(monomial)
        factor = content(f)
        if f[min(f)] < 0:
            factor = -factor
        return factor, monomial, terms_scaled(terms_times(f, {(inverted, ()): 1}), 1 / factor)

    def cleared(self, f: Terms) -> tuple[Terms, dict[int, int]]:
        """(numerator, {atom of a divisor: its power}): f = numerator / product of divisor ** power."""
        powers: dict[int, int] = {}
        for monomial, _ in f:
            for atom, e in monomial:
                if e < 0 and self.atoms.is_a(atom, "sum"):
                    powers[atom] = max(powers.get(atom, 0), -e)
        if not powers:
            return f, {}
        numerator: Terms = {}
        for (monomial, w), c in f.items():
            exponents = dict(monomial)
            missing = {atom: power + exponents.pop(atom, 0) for atom, power in powers.items()}
            part: Terms = {(tuple(sorted(exponents.items())), w): c}
            for atom, e in missing.items():
                part = self.product(part, self.power(self.atoms.opaque[atom].arguments[0], e))
            numerator = terms_plus(numerator, part)
        inner, more = self.cleared(numerator)
        for atom, e in more.items():
            powers[atom] = powers.get(atom, 0) + e
        return inner, powers

    # -- angles ----------------------------------------------------------------------------------

    def _circular(self, op: str, argument: Terms) -> Terms:
        """sin or cos of a sum of terms, every term an angle, multiples of pi evaluated where their cosine is known."""
        vector: dict[int, Number] = {}
        turn = Fraction(0)
        for key, c in argument.items():
            if key == ONE:
                vector[RADIAN] = c
            elif key == (((self.graph.pi.index, 1),), ()):
                turn = Fraction(c)
            else:
                vector[self._angle(key)] = c
        known = self._turn(turn)
        if known is None:
            vector[self._angle((((self.graph.pi.index, 1),), ()))] = turn
            known = (constant(1), {})
        k = tuple(sorted(vector.items()))
        cosine, sine = self._wave("cos", k), self._wave("sin", k)
        cos_turn, sin_turn = known
        if op == "sin":
            return terms_plus(terms_times(sine, cos_turn), terms_times(cosine, sin_turn))
        return terms_plus(terms_times(cosine, cos_turn), terms_times(sine, sin_turn), -1)

    def _angle(self, key: Key) -> int:
        """The index of the node whose multiples are angles."""
        monomial, w = key
        if w == () and len(monomial) == 1 and monomial[0][1] == 1 and monomial[0][0] >= 0:
            return monomial[0][0]
        node = self.atoms.node({key: 1})
        assert type(node) is Node
        self.atoms.nodes[node.index] = node
        return node.index

    def _wave(self, kind: str, k: AngleSum) -> Terms:
        w, sign = wave(kind, k)
        return {((), w): sign} if sign else {}

    def _turn(self, turn: Fraction) -> tuple[Terms, Terms] | None:
        """(cos, sin) of turn * pi, at multiples of pi/6 and pi/4."""
        cosine, sine = self._cosine(turn), self._cosine(turn - HALF)
        return None if cosine is None or sine is None else (cosine, sine)

    def _cosine(self, turn: Fraction) -> Terms | None:
        turn, sign = turn % 2, 1
        if turn > 1:
            turn = 2 - turn
        if turn > HALF:
            turn, sign = 1 - turn, -1
        if turn not in _TURNS:
            return None
        c, root = _TURNS[turn]
        return {(((-root, 1),) if root > 1 else (), ()): tidy(sign * c)} if c else {}


def expanded(outputs: Iterable[Scalar], limit: int, positive: Collection[Node] = ()) -> tuple[Expansion, list[Terms]]:
    """The outputs as sums of terms, with the expansion that owns their atoms."""
    graph, outputs = united(list(outputs))
    expansion = Expansion(graph, limit, positive)
    return expansion, [expansion.of(x) for x in outputs]
