"""The formula that somebody wrote -> the one place of it that makes it right, where that is changed.

Every name in it counts by itself, as it was written. At states of the true motion the value is sought that a node of the
formula would need; where this is the node's own value times, or plus, a simple product of the model's names, or such a
product itself, that is what was meant.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from itertools import combinations

import numpy as np

from eomgen.errors import DerivationError, EomgenError, ExpressionError
from eomgen.judge.case import Case
from eomgen.judge.contributions import Contribution
from eomgen.judge.corruption import Corruption
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import MINUS, PLAINEST, UNUSUAL, USUAL, WELL_KNOWN, Explanation, Samples, Share, samples_of, simple_factor
from eomgen.judge.edits import power, powers_of, wrong_power
from eomgen.judge.reading import HandEquation
from eomgen.judge.right import truth_of
from eomgen.judge.terms import angles_in, short_text, term_text, terms_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, substituted, symbols_of
from eomgen.symbolic.expression.expressions import Call, Expression
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.batch_evaluation import ARRAYS
from eomgen.symbolic.numeric.evaluation import evaluate
from eomgen.symbolic.numeric.tolerances import CARRIED, COMPUTED

MOST_PLACES, MOST_ATOMS = 80, 24  # nodes that are looked at; names and waves of which products are made
MOST_TRIED = 6  # changes that are proven before it is given up
SHORT = 60  # characters of a place that is told
LEAST_STATES = 5
MOST_PAIRS, MOST_OWNERS = 2000, 2  # terms that are compared; contributions that are named
ENERGIES = {"kinetic_energy": "T", "potential_energy": "V"}
STEPS = 8  # of the secant method
SIGN, NUMBER, PRODUCT, LONGER = 2.5, 2.7, 3.0, 4.5  # how much less than the plainest mistake each is believed


class _Occurrences(dict[str, Scalar]):
    """A fresh symbol for every name that is looked up; what each stands for."""

    def __init__(self, known: Mapping[str, Scalar], pi: Node) -> None:
        super().__init__()
        self.known, self.pi = known, pi
        self.meant = dict[Node, Scalar]()

    def get(self, name: str, default: object = None) -> Scalar:  # type: ignore[override]
        return self[name] if name in self.known or name == "pi" else default  # type: ignore[return-value]

    def __getitem__(self, name: str) -> Scalar:
        if name == "pi":
            return self.pi
        return self.of(name, self.known[name])

    def of(self, name: str, meant: Scalar) -> Node:
        """A symbol of its own for something that is met."""
        symbol = self.pi.graph.symbol(f"({len(self.meant)}) {name}")
        self.meant[symbol] = meant
        return symbol


@dataclass(frozen=True)
class Mends:
    """An equation of somebody that one change would make right.

    Args:
        case: the model.
        written: the equation.
        kind: what it is about.
        place: q, u or what is asked at the place or instant of which it speaks; {} in every motion.
        true: the true value of what stands alone on the left; None: it is a formula.
    """

    case: Case
    written: HandEquation
    kind: str
    place: Mapping[Node, Scalar] = field(default_factory=dict)
    true: Scalar | None = None

    def explained(self, number: int) -> list[Explanation]:
        """The changes that make it right, the simplest first."""
        if number > 1:
            return []
        with suppress(EomgenError, np.linalg.LinAlgError):
            known = sorted(self._found(), key=lambda each: each[:2])
            found = [x for x in [self._explanation(*each) for each in known[:MOST_TRIED]] if x is not None]
            return found[:1]
        return []

    def difference(self, explanation: Explanation) -> str:
        """What is too much on the left."""
        (share,) = explanation.shares
        return short_text(self._by[share], self.case.system.scope.positive)

    # -- the formula, and states of the true motion ------------------------------------------------

    @cached_property
    def _author(self) -> tuple[Scalar, dict[Node, Scalar], frozenset[Node]]:
        """The difference of sides over occurrences; what each of these stands for; nodes that are not looked at."""
        case, scope = self.case, self.case.system.scope
        names = _Occurrences(scope.names, scope.graph.pi)

        def called(call: Call) -> Scalar:
            return names.of(str(call), self._value(call))

        left, right = (side.evaluate(names, called) for side in (self.written.left, self.written.right))
        if self.true is not None:
            names.meant[left] = self.true
        alone = frozenset({left} if len(self.written.left.code) == 1 else ())
        return left - right, names.meant, alone

    def _value(self, call: Call) -> Scalar:
        expression = Expression(str(call), (("call", call),), (0,))
        return 0 if self.true is not None and self.written.left.calls == (call,) else self.case.value(expression)

    @cached_property
    def _samples(self) -> Samples | None:
        """States of the true motion."""
        case, system = self.case, self.case.system
        _, meant, _ = self._author
        given = substituted(tuple(meant.values()), self.place)
        tied = bool(system.ties.rows) and not self.place
        found = samples_of(system, given, on_ties=tied, places=5 if self.kind == "motion" else 12)
        if found is None or self.place or self.true is not None:
            return found
        if self.kind == "law" and case.speeds is not None:
            own = found.of(tuple(case.speeds.values()))
            found = replace(found, values={**found.values, **dict(zip(case.speeds, own.reshape(len(own), -1), strict=True))})
        return found if case.equations is None else self._moving(found)

    def _moving(self, found: Samples) -> Samples:
        """With the accelerations and multipliers that the equations of motion give."""
        e = self.case.equations
        assert e is not None
        n, k = len(e.M), len(e.J)
        flat = found.of((*(x for row in e.M for x in row), *e.forcing, *(x for row in e.J for x in row), *e.gamma))
        flat = np.moveaxis(flat.reshape(len(flat), -1), 1, 0)
        M, forcing = flat[:, : n * n].reshape(len(flat), n, n), flat[:, n * n : n * n + n]
        J, gamma = flat[:, n * n + n : n * n + n + k * n].reshape(len(flat), k, n), flat[:, n * n + n + k * n :]
        zero = np.zeros((len(M), k, k))
        matrix = np.concatenate([np.concatenate([M, -np.swapaxes(J, 1, 2)], 2), np.concatenate([J, zero], 2)], 1)
        solved = np.linalg.pinv(matrix) @ np.concatenate([forcing, -gamma], 1)[:, :, None]
        forced = dict(zip((*e.symbols.a, *e.symbols.lam), solved[:, :, 0].T, strict=True))
        return replace(found, values={**found.values, **forced})

    # -- what a node would have to be ---------------------------------------------------------------

    def _found(self) -> Iterator[tuple[float, int, Node, Scalar, str]]:
        """(cost, length, place, what is meant there, kind) of every change in numbers."""
        difference, meant, alone = self._author
        if type(difference) is not Node or self._samples is None:
            return
        inner = _inner(difference)
        flat = self._samples.of(substituted(tuple(meant.values()), self.place)).reshape(len(meant), -1)
        there = np.all(np.isfinite(flat), axis=0)
        if np.count_nonzero(there) < LEAST_STATES:
            return
        values = dict(zip(meant, flat[:, there], strict=True))
        atoms = replace(self._atoms, values=self._atoms.values[:, there])
        for node in [x for x in order((difference,)) if x is not difference][:MOST_PLACES]:
            needed = _needed(difference, node, values)
            if needed is not None:
                (own,) = evaluate((node,), values, ARRAYS)
                known = _other_forms(node, own, needed) if node in alone else atoms.changes(node, own, needed, node in inner)
                for cost, other, kind in known:
                    yield cost, self._length(node) + self._length(other), node, other, kind

    def _length(self, x: Scalar) -> int:
        return len(short_text(self._plain(x), self.case.system.scope.positive))

    def _plain(self, x: Scalar) -> Scalar:
        """With the names in place of their occurrences."""
        graph = self.case.system.scope.graph
        names = {y: graph.symbol(y.name.partition(") ")[2]) for y in self._author[1]}
        return substituted((x,), names)[0]

    @cached_property
    def _atoms(self) -> _Products:
        """Of what changes are made: names of the model, and waves of angles."""
        case = self.case
        _, meant, _ = self._author
        symbols = case.system.symbols
        atoms: list[Node] = [*symbols.parameters.values(), *symbols.inputs.values()]
        if not self.place and self.true is None:
            held = {*symbols_of((*case.rows, *meant.values()))}
            atoms += [x for x in (*symbols.q, *symbols.u) if x in held]
            angles = angles_in((*case.rows, *meant.values()))
        else:
            angles = angles_in(tuple(meant.values()))
        graph = case.system.scope.graph
        angles += [x for x in atoms if str(case.parts.dimensions.get(x.name, "")) in ("1", "rad")]
        waves = [graph.call(op, x) for x in dict.fromkeys(angles) for op in ("sin", "cos")]
        atoms += [x for x in waves if type(x) is Node and x not in atoms]
        atoms = atoms[:MOST_ATOMS]
        assert self._samples is not None
        known = self._samples.of(substituted(tuple(atoms), self.place))
        accelerated = tuple(x for x, y in meant.items() if y in symbols.a)
        return _Products(tuple(atoms), known.reshape(len(atoms), -1), accelerated)

    # -- what is told ----------------------------------------------------------------------------

    def _explanation(self, cost: float, length: int, node: Node, other: Scalar, kind: str) -> Explanation | None:
        """The change, where it makes the equation right, exactly."""
        difference, meant, _ = self._author
        case = self.case
        (mended,) = substituted((difference,), {node: other})
        right, wrong = substituted(substituted((mended, difference), meant), self.place)
        asked = self.place or self.true is not None
        found = is_zero_everywhere(case.system, right) if asked else truth_of(case, right, self.kind)
        if not found.holds:
            return None
        product, term = self._around(node)
        there, should = self._plain(product), substituted((self._plain(product),), {self._plain(node): self._plain(other)})[0]
        owners = self._owners(mended, substituted((self._plain(term),), {self._plain(node): self._plain(other)})[0])
        named = " and ".join(part.name for part in owners)
        body, force = (owners[0].body, owners[0].force) if len(owners) == 1 else ("", "")
        (ratio,) = case.edits.written((over(there, should),)) if not is_zero(should) else (0,)
        if type(ratio) is not Node and ratio not in (0, 1):
            rates = [x for x in symbols_of((there,)) if x.name.endswith("'")]
            corruption = Corruption(
                named or f"the term {self._text(product)}", "coriolis" if len(rates) == 2 else "factor", (should,), cost, body, force
            )
            share = Share(corruption, Fraction(ratio))
        else:
            where = "" if term is node or len(self._text(term)) > SHORT else f"the term {self._text(term)}"
            place = ", ".join(filter(None, (named, where)))
            told = self._told(self._plain(node), self._plain(other), there)
            text = f"in {place}{',' if named and where else ''} {told}" if place else told
            share = Share(Corruption(place or told, kind, (there if is_zero(should) else should,), cost, body, force, open=False, text=text), Fraction(1))
        self._by[share] = wrong - right
        return Explanation((share,), 0, PLAINEST + cost)

    @cached_property
    def _by(self) -> dict[Share, Scalar]:
        """By what the sides differ, of what is told."""
        return {}

    def _around(self, node: Node) -> tuple[Node, Node]:
        """The product, and the term that is told, in which a node stands."""
        product = term = node
        in_sum = False
        for x in order((self._author[0],)):  # type: ignore[arg-type]
            if x is not node and x is not self._author[0] and node in order((x,)):
                in_sum = in_sum or x.op in ("add", "sub")
                if not in_sum:
                    product = x
                if x.op not in ("add", "sub") and len(self._text(x)) <= SHORT:
                    term = x
        return product, product if term is node else term

    def _text(self, x: Scalar) -> str:
        return short_text(self._plain(x), self.case.system.scope.positive)

    def _told(self, there: Scalar, should: Scalar, around: Scalar) -> str:
        """What is wrong."""
        if is_zero(should):
            return f"{term_text(there)} does not belong there"
        (ratio,), held = self.case.edits.written((over(should, there),)), powers_of(around)
        powers = powers_of(ratio)
        number = over(ratio, math.prod((power(x, k) for x, k in powers.items()), start=1))
        if number == 1 and len(powers) == 1:
            ((x, k),) = powers.items()
            return wrong_power(term_text(x), held.get(x, Fraction(0)) + k, held.get(x, Fraction(0)))
        if number == 1 and len(powers) == 2 and sum(powers.values()) == 0:
            (x, k), (y, _) = sorted(powers.items(), key=lambda each: -each[1])
            if held.get(y, 0) >= k:
                return f"{term_text(power(y, k))} stands where {term_text(power(x, k))} is meant"
        return f"{term_text(there)} stands where {term_text(should)} is meant"

    def _owners(self, mended: Scalar, around: Scalar) -> Sequence[Contribution]:
        """The contributions in which the change is made: those whose terms, or else names, are the ones meant."""
        case, (difference, meant, _) = self.case, self._author
        names = {call.name for call in self.written.calls}
        what = next((letter for name, letter in ENERGIES.items() if {name} == names), "motion")
        of_rows = what != "motion" or (self.kind == "motion" and not names)
        found: dict[str, Contribution] = {}
        if of_rows:
            found = self._of_terms(what, *substituted(substituted((mended, difference), self._uncalled), meant))
        if not 0 < len(found) <= MOST_OWNERS:
            constants = {*case.system.symbols.parameters.values(), *case.system.symbols.inputs.values()}
            known = [part for part in case.parts.elementary if what == "motion" or not is_zero(getattr(part, what))]
            holders = [[part for part in known if x in part.held] for x in symbols_of((around,)) if x in constants]
            few = min(filter(None, holders), key=len, default=[])
            together = [part for part in few if all(part in some for some in holders)]
            found = {part.name: part for part in together or few}
        return tuple(found.values()) if len(found) <= MOST_OWNERS else ()

    @property
    def _uncalled(self) -> dict[Node, Scalar]:
        """0 for the functions of the motion."""
        return {x: 0 for x in self._author[1] if x.name.endswith(")")}

    def _of_terms(self, what: str, right: Scalar, wrong: Scalar) -> dict[str, Contribution]:
        """Those of which a term is what the change makes, where most of the equation is made of such terms."""
        samples, positive = self._samples, self.case.system.scope.positive
        mine, before = terms_of(right, positive), terms_of(wrong, positive)
        known = self.case.corruptions(what)
        theirs = [(part, x) for part in known.whole for row in known.rows(part) for x in terms_of(row, positive)]
        if samples is None or not mine or not theirs or len(mine) * len(theirs) > MOST_PAIRS:
            return {}
        values = samples.of((*mine, *(x for _, x in theirs))).reshape(len(mine) + len(theirs), -1)
        with np.errstate(all="ignore"):
            ratios = values[: len(mine), None] / values[None, len(mine) :]
        keys = [[tuple(f"{x:.6g}" for x in ratio) for ratio in row] for row in ratios]
        ((common, often),) = Counter(key for row in keys for key in row).most_common(1)
        return {
            part.name: part
            for term, row in zip(mine, keys, strict=True)
            for (part, _), key in zip(theirs, row, strict=True)
            if key == common and 2 * often > len(mine) and term not in before
        }


def _inner(difference: Node) -> frozenset[Node]:
    """The factors of products."""
    return frozenset(x for y in order((difference,)) if y.op in ("mul", "div", "neg") for x in y.args if type(x) is Node)


def _needed(difference: Node, node: Node, values: Mapping[Node, np.ndarray]) -> np.ndarray | None:
    """The value of a node with which the difference vanishes at every state; None: there is none."""
    with np.errstate(all="ignore"):

        def left(x: np.ndarray) -> np.ndarray:
            (found,) = evaluate((difference,), {**values, node: x}, ARRAYS)
            return np.asarray(found, dtype=float) + 0 * x

        (first,) = evaluate((node,), values, ARRAYS)
        first = np.asarray(first, dtype=float) + np.zeros(len(next(iter(values.values()))))
        size = np.abs(first) + COMPUTED
        x, y = first, first + 0.1 * size
        f, g = left(x), left(y)
        scale = np.abs(f) + np.abs(g)
        for _ in range(STEPS):
            step = g * (y - x) / (g - f)
            x, f = y, g
            y = np.where(np.isfinite(step), y - step, y)
            g = left(y)
            if not np.all(np.isfinite(g)):
                return None
            if np.all(np.abs(g) <= COMPUTED * scale):
                return y if np.all(np.abs(y) < 1e9 * size) else None
    return None


@dataclass(frozen=True)
class _Products:
    """Simple products of names, with their values.

    Args:
        accelerations: occurrences of which nobody takes the wrong sign.
    """

    atoms: tuple[Node, ...]
    values: np.ndarray
    accelerations: tuple[Node, ...] = ()

    @cached_property
    def _all(self) -> tuple[list[tuple[float, tuple[tuple[int, Fraction], ...]]], np.ndarray]:
        """(cost, powers) of each, and its values."""
        n, half = len(self.atoms), Fraction(1, 2)
        found: list[tuple[float, tuple[tuple[int, Fraction], ...]]] = [(0.0, ())]
        found += [(PRODUCT + self._dear(i), ((i, Fraction(k)),)) for i in range(n) for k in (1, -1)]
        found += [(PRODUCT + 0.5, ((i, k),)) for i in range(n) for k in (Fraction(2), Fraction(-2), half, -half)]
        for i, j in combinations(range(n), 2):
            found += [(PRODUCT, ((i, Fraction(k)), (j, Fraction(-k)))) for k in (1, -1)]
            found += [(LONGER, ((i, Fraction(k)), (j, Fraction(k)))) for k in (1, -1)]
            found += [(PRODUCT + 0.5, ((i, Fraction(k)), (j, Fraction(-k)))) for k in (2, -2)]
            found += [(LONGER, ((i, Fraction(k)), (j, Fraction(-l)))) for k, l in ((2, 1), (-2, -1), (1, 2), (-1, -2))]
        with np.errstate(all="ignore"):
            logs = np.log(np.abs(self.values))
            signs = np.sign(self.values)
            rows = [np.zeros(self.values.shape[1])] * len(found)
            values = np.array([sum((float(k) * logs[i] for i, k in powers), rows[0]) for _, powers in found])
            odd = [np.prod([signs[i] for i, k in powers if k.denominator == 1 and k % 2] or [rows[0] + 1], axis=0) for _, powers in found]
            return found, np.exp(values) * np.array(odd)

    def _dear(self, i: int) -> float:
        """How much less a rate is believed to be left out than another name."""
        return 1.0 if self.atoms[i].op == "symbol" and self.atoms[i].name.endswith("'") else 0.0

    def changes(self, node: Node, own: np.ndarray, needed: np.ndarray, inner: bool) -> Iterator[tuple[float, Scalar, str]]:
        """(cost, what is meant, kind of the cause) where the needed value is a simple change of the node's own.

        Args:
            inner: it is a factor of a product: a number is one of that.
        """
        if np.all(np.abs(needed) <= COMPUTED * np.abs(own)):
            yield PRODUCT, 0, "extra_term"
            return
        with np.errstate(all="ignore"):
            for cost, powers, c in self._fits(needed / own):
                dear = SIGN if c == -1 and not powers else cost + _of_number(c) + (0.0 if not powers or c > 0 else PLAINEST) + (0.0 if powers else NUMBER)
                if c < 0 and depends_on(node, self.accelerations):
                    continue
                if powers or (c != 1 and not inner):
                    yield dear, self._product(c, powers) * node, _kind(c, powers, self.atoms)
            for cost, other, kind in _other_forms(node, own, needed):
                yield cost, other, kind
            for cost, powers, c in self._fits(needed):
                if powers and cost < LONGER:
                    yield cost + 0.5 + _of_number(c) + (0.0 if c > 0 else PLAINEST), self._product(c, powers), "wrong_quantity"
            for cost, powers, c in self._fits(needed - own):
                if powers and cost < LONGER and node.op not in ("mul", "div"):
                    yield cost + 0.7 + _of_number(c), node + self._product(c, powers), "missing_term"

    def _fits(self, values: np.ndarray) -> Iterator[tuple[float, tuple[tuple[int, Fraction], ...], Fraction]]:
        found, products = self._all
        ratios = values / products
        first = ratios[:, :1]
        good = np.all(np.abs(ratios - first) <= CARRIED * np.abs(first), axis=1) & (np.abs(first[:, 0]) > 0)
        for k in np.flatnonzero(good):
            c = simple_factor(float(first[k, 0]))
            if c and max(abs(c.numerator), c.denominator) <= WELL_KNOWN:
                yield *found[k], c

    def _product(self, c: Fraction, powers: tuple[tuple[int, Fraction], ...]) -> Scalar:
        found: Scalar = c
        for i, k in powers:
            x: Scalar = self.atoms[i] if k.denominator == 1 else self.atoms[i].graph.sqrt(self.atoms[i])
            n = int(k) if k.denominator == 1 else int(2 * k)
            found = found * x**n if n > 0 else over(found, x**-n)
        return found


def _other_forms(node: Node, own: np.ndarray, needed: np.ndarray) -> Iterator[tuple[float, Scalar, str]]:
    """Its square, its root, its reciprocal."""
    graph = node.graph
    forms = ((own * own, lambda: node * node), (np.sqrt(np.abs(own)), lambda: graph.sqrt(node)), (1 / own, lambda: over(1, node)))
    for value, form in forms:
        if np.all(np.abs(value - needed) <= CARRIED * np.abs(needed)):
            yield NUMBER, form(), "factor"


def _of_number(c: Fraction) -> float:
    """How much less a number is believed than none."""
    size = next((more / 2 for known, more in USUAL if abs(c) in known), UNUSUAL)
    return size + (MINUS if c < 0 else 0.0)


def _kind(c: Fraction, powers: tuple[tuple[int, Fraction], ...], atoms: tuple[Node, ...]) -> str:
    if not powers:
        return "sign" if c == -1 else "factor"
    waves = [atoms[i].op for i, _ in powers]
    if len(powers) == 2:
        return "wrong_axis" if {*waves} == {"sin", "cos"} else "wrong_quantity"
    return "factor"
