"""An equation of somebody -> how near it is to one that is right: by one place of it that is wrong, or by other names.

Where the one place is changed, it is right. Names, directions and conventions may be chosen otherwise than the model:
the work of a constant force may stand among the potential energies; a frequency may be that without damping."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cache, cached_property
from heapq import heappop, heappush
from itertools import islice, product
from typing import Any

import numpy as np

from eomgen.errors import EomgenError
from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.comparison import excess
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import PLAINEST, Explanation, Mistake, Samples, Share, samples_of
from eomgen.judge.reading import HandEquation
from eomgen.judge.terms import (
    ANGLES,
    FEW,
    Amended,
    Products,
    angles_in,
    other_forms,
    power,
    powers_of,
    short_text,
    term_text,
    terms_of,
    wrong_power,
)
from eomgen.judge.truth import IDENTITY, Decided, on_one_side, truth_of
from eomgen.judge.verdict import FUNCTION_KINDS, Cause
from eomgen.mechanics.dynamics import Contribution
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Fraction,
    Node,
    Scalar,
    depends_on,
    derivative,
    is_zero,
    order,
    over,
    parse,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import ARRAYS, evaluate, tolerances
from eomgen.symbolic.print import to_text

MOST_TRIED = 6  # changes that are proven before it is given up
SHORT = 60  # characters of a place that is stated
MOST_PAIRS = 2000  # of terms that are compared
ENERGIES = {"kinetic_energy": "T", "potential_energy": "V"}


@dataclass(frozen=True)
class Fixes:
    """An equation of somebody that one change would make right."""

    author: Authored

    def explained(self, number: int) -> list[Explanation]:
        """The simplest change that makes it right."""
        with suppress(EomgenError, np.linalg.LinAlgError):
            found = [] if number > 1 else list(self.author.changes())
            found.sort(key=lambda each: (each[1].cost, len(self._text(each[0])) + len(self._text(each[1].to))))
            for node, amended in found[:MOST_TRIED]:
                explanation = self._explanation(node, amended)
                if explanation is not None:
                    return [explanation]
        return []

    def difference(self, explanation: Explanation) -> str:
        """The excess on the left side."""
        return excess(self.author.case, self._by[explanation.shares[0]])

    @cached_property
    def _by(self) -> dict[Share, Scalar]:
        """The difference of the sides, of each mistake that is stated."""
        return {}

    def _explanation(self, node: Node, amended: Amended) -> Explanation | None:
        """The change, where it makes the equation right, exactly."""
        difference, case = self.author.difference, self.author.case
        (corrected,) = substituted((difference,), {node: amended.to})
        right, wrong = substituted((corrected, difference), self.author.meant)
        still = self.author.is_still
        found = is_zero_everywhere(case.system, right) if still else truth_of(case, right, self.author.kind)
        if not found.holds:
            return None
        share = self._share(node, amended, corrected)
        self._by[share] = wrong - right
        return Explanation((share,), 0, PLAINEST + amended.cost)

    # -- the sentence ----------------------------------------------------------------------------

    def _share(self, node: Node, amended: Amended, corrected: Scalar) -> Share:
        product, term = self._around(node)
        there, should = (self.author.plain(x) for x in (product, substituted((product,), {node: amended.to})[0]))
        term = product if product is not node else term
        around = self.author.plain(substituted((term,), {node: amended.to})[0]) if is_zero(should) else should
        owners = self._owners(corrected, around)
        named = " and ".join(part.name for part in owners)
        body, force = (owners[0].body, owners[0].force) if len(owners) == 1 else ("", "")
        (ratio,) = (0,) if is_zero(should) else self.author.case.edits.written((over(there, should),))
        if type(ratio) is not Node and ratio not in (0, 1):
            rates = [x for x in symbols_of((there,)) if x.name.endswith("'")]
            name, kind = named or f"the term {self._text(product)}", "coriolis" if len(rates) == 2 else "factor"
            return Share(Mistake(name, kind, (should,), amended.cost, body, force), Fraction(ratio))
        where = "" if term is node or len(self._text(term)) > SHORT else f"the term {self._text(term)}"
        reported = self._reported(self.author.plain(node), self.author.plain(amended.to), there)
        place = ", ".join(filter(None, (named, where)))
        text = f"in {place}{',' if named and where else ''} {reported}" if place else reported
        row = (there if is_zero(should) else should,)
        mistake = Mistake(place or reported, amended.kind, row, amended.cost, body, force, open=False, text=text)
        return Share(mistake, Fraction(1))

    def _around(self, node: Node) -> tuple[Node, Node]:
        """The product, and the term that is stated, in which a node stands."""
        product = term = node
        in_sum = False
        for x in order((self.author.difference,)):
            if x is not node and x is not self.author.difference and node in order((x,)):
                in_sum = in_sum or x.op in ("add", "sub")
                product = product if in_sum else x
                if x.op not in ("add", "sub") and len(self._text(x)) <= SHORT:
                    term = x
        return product, product if term is node else term

    def _text(self, x: Scalar) -> str:
        return short_text(self.author.plain(x), self.author.case.system.scope.positive)

    def _reported(self, there: Scalar, should: Scalar, around: Scalar) -> str:
        """The sentence on a product in which one thing stands and another is meant."""
        if is_zero(should):
            return f"{term_text(there)} does not belong there"
        (ratio,), held = self.author.case.edits.written((over(should, there),)), powers_of(around)
        powers = powers_of(ratio)
        number = over(ratio, math.prod((power(x, k) for x, k in powers.items()), start=1))
        if number in (1, -1):
            (x, k), *rest = sorted(powers.items(), key=lambda each: -each[1])
            if not rest:
                reported = wrong_power(term_text(x), held.get(x, Fraction(0)) + k, held.get(x, Fraction(0)))
                return reported if number == 1 else f"{reported}, and the sign is wrong"
            ((y, n), *more) = rest
            if number == 1 and not more and n == -k and held.get(y, 0) >= k:
                there, should = power(y, k), power(x, k)
        return f"{term_text(there)} stands where {term_text(should)} is meant"

    def _owners(self, corrected: Scalar, around: Scalar) -> Sequence[Contribution]:
        """The contributions in which the change is made: those whose terms, or else names, are the ones meant."""
        case, names = self.author.case, {call.name for call in self.author.written.calls}
        what = next((letter for name, letter in ENERGIES.items() if {name} == names), "motion")
        found: dict[str, Contribution] = {}
        if what != "motion" or (self.author.kind == "motion" and not names):
            called = {x: 0 for x in self.author.meant if x.name.endswith(")")}
            sides = substituted((corrected, self.author.difference), {**self.author.meant, **called})
            found = self._of_terms(what, *sides)
        if 0 < len(found) <= FEW:
            return tuple(found.values())
        return case.parts.holding(around, FEW, what.replace("motion", ""))

    def _of_terms(self, what: str, right: Scalar, wrong: Scalar) -> dict[str, Contribution]:
        """The contributions with a term that the change makes, where most of the equation is made of such terms."""
        samples, positive = self.author.samples, self.author.case.system.scope.positive
        mine, before = terms_of(right, positive), terms_of(wrong, positive)
        known = self.author.case.mistakes(what)
        theirs = [(part, x) for part in known.whole for row in known.rows(part) for x in terms_of(row, positive)]
        if samples is None or not mine or not theirs or len(mine) * len(theirs) > MOST_PAIRS:
            return {}
        values = samples.flat([*mine, *(x for _, x in theirs)])
        with np.errstate(all="ignore"):
            ratios = values[: len(mine), None] / values[None, len(mine) :]
        keys = [[tuple(f"{x:.6g}" for x in ratio) for ratio in row] for row in ratios]
        ((common, often),) = Counter(key for row in keys for key in row).most_common(1)
        matched = {
            term: [part for (part, _), key in zip(theirs, row, strict=True) if key == common]
            for term, row in zip(mine, keys, strict=True)
        }
        if 2 * often <= len(mine) or not any(matched[term] for term in mine if term in before):
            return {}  # the equation is not made of such terms, or all of them differ
        return {part.name: part for term in mine if term not in before for part in matched[term]}


# -------- authored --------------------------------------------------------------------------------------------
# The formula that somebody wrote -> the value that each place of it would need to be right, at states of the motion.
#
# Every name in it counts by itself, as it was written: what is wrong with one length need not be with the same one
# elsewhere.


MOST_PLACES, MOST_ATOMS = 80, 24  # nodes that are looked at; names and waves of which products are made
PLACES, PLACES_OF_MOTION = 12, 5  # configurations at which it is looked at
LEAST_STATES = 5  # at which it must have a value
STEPS = 8  # of the secant method
FARTHEST = 1e9  # times what stands there: as far as a value is sought


class _Occurrences(dict[str, Scalar]):
    """A symbol of its own for every name that is looked up; what each stands for."""

    def __init__(self, known: Mapping[str, Scalar], pi: Node) -> None:
        super().__init__()
        self.known, self.pi = known, pi
        self.meant = dict[Node, Scalar]()

    def get(self, name: str, default: Any = None) -> Any:
        return self[name] if name in self.known else default

    def __getitem__(self, name: str) -> Scalar:
        return self.pi if name == "pi" else self.of(name, self.known[name])

    def of(self, name: str, meant: Scalar) -> Node:
        symbol = self.pi.graph.symbol(f"({len(self.meant)}) {name}")
        self.meant[symbol] = meant
        return symbol


@dataclass(frozen=True)
class Authored:
    """An equation of somebody, name by name.

    Args:
        case: the model.
        written: the equation.
        kind: what it is about.
        place: coordinates at the place of which it speaks; {} in every motion.
        true: the true value of what stands alone on the left; None: it follows from the state.
    """

    case: Case
    written: HandEquation
    kind: str
    place: Mapping[Node, Scalar] = field(default_factory=dict)
    true: Scalar | None = None

    @property
    def is_still(self) -> bool:
        """True if it is about one place or instant."""
        return bool(self.place) or self.true is not None

    @cached_property
    def _sides(self) -> tuple[Scalar, Scalar, Mapping[Node, Scalar]]:
        """Both sides over occurrences, and what these stand for."""
        scope = self.case.system.scope
        names = _Occurrences(self.case.names, scope.graph.pi)

        def called(call: Call) -> Scalar:
            return names.of(str(call), self.case.value(Expression(str(call), (("call", call),), (0,))))

        right = self.written.right.evaluate(names, called)
        if self.true is not None:
            return names.of(self.written.left.text, self.true), right, names.meant
        return self.written.left.evaluate(names, called), right, names.meant

    @cached_property
    def difference(self) -> Scalar:
        """The left side less the right one."""
        return self._sides[0] - self._sides[1]

    @cached_property
    def meant(self) -> Mapping[Node, Scalar]:
        """The value of each occurrence of a name, at the place."""
        known = self._sides[2]
        return dict(zip(known, substituted(tuple(known.values()), self.place), strict=True))

    def plain(self, x: Scalar) -> Scalar:
        """The scalar with the names in place of their occurrences."""
        graph = self.case.system.scope.graph
        return substituted((x,), {y: graph.symbol(y.name.partition(") ")[2]) for y in self.meant})[0]

    # -- states of the true motion -------------------------------------------------------------------

    @cached_property
    def samples(self) -> Samples | None:
        case, constraints = self.case, self.case.system.constraints
        places = PLACES_OF_MOTION if self.kind == "motion" else PLACES
        constrained = bool(constraints.rows) and not self.is_still
        found = samples_of(case.system, tuple(self.meant.values()), on_constraints=constrained, places=places)
        if found is None or self.is_still:
            return found
        by_integrals = (case.speeds or case.by_momenta) if self.kind == "law" else None
        speeds = {} if by_integrals is None else by_integrals[0]
        found = found.with_values(dict(zip(speeds, found.flat(tuple(speeds.values())), strict=True)))
        return found if case.parts.equations is None else self._moving(found)

    def _moving(self, found: Samples) -> Samples:
        """States with accelerations and multipliers of the motion: [[M, -J^T], [J, 0]] [a; lam] = [forcing; -gamma]."""
        e = self.case.parts.equations
        assert e is not None
        n, k = len(e.M), len(e.J)
        rows = [(*row, *(-J[i] for J in e.J), e.forcing[i]) for i, row in enumerate(e.M)]
        rows += [(*row, *[0] * k, -gamma) for row, gamma in zip(e.J, e.gamma, strict=True)]
        flat = found.of([x for row in rows for x in row])
        system = np.moveaxis(flat.reshape(n + k, n + k + 1, -1), 2, 0)
        solved = np.linalg.pinv(system[:, :, :-1]) @ system[:, :, -1:]
        return found.with_values(dict(zip((*e.symbols.a, *e.symbols.lam), solved[:, :, 0].T, strict=True)))

    @cached_property
    def _atoms(self) -> tuple[Node, ...]:
        """The factors of which changes are made: names of the model, sines and cosines of angles."""
        symbols, known = self.case.system.symbols, tuple(self.meant.values())
        atoms: list[Node] = [*symbols.parameters.values(), *symbols.inputs.values()]
        formulas = known if self.is_still else (*self.case.rows, *known)
        if not self.is_still:
            held = {*symbols_of(formulas)}
            atoms += [x for x in symbols.x if x in held]
        angles = angles_in(formulas)
        angles += [x for x in atoms if str(self.case.edits.dimensions.get(x.name, "")) in ANGLES[:2]]
        waves = [x.graph.call(op, x) for x in dict.fromkeys(angles) for op in ("sin", "cos")]
        atoms += [x for x in waves if type(x) is Node and x not in atoms]
        return tuple(atoms[:MOST_ATOMS])

    # -- what a place of it would have to be ----------------------------------------------------------

    def changes(self) -> Iterator[tuple[Node, Amended]]:
        """(place, change) by which the equation holds in numbers."""
        left, samples, difference = self._sides[0], self.samples, self.difference
        if type(difference) is not Node or samples is None:
            return
        flat = samples.flat([*self.meant.values(), *substituted(self._atoms, self.place)])
        n = len(self.meant)
        there = np.all(np.isfinite(flat[:n]), axis=0)
        if np.count_nonzero(there) < LEAST_STATES:
            return
        values = dict(zip(self.meant, flat[:n, there], strict=True))
        usable = [k for k, row in enumerate(flat[n:, there]) if np.all(np.isfinite(row) & (row != 0))]
        products = Products(tuple(self._atoms[k] for k in usable), flat[n:, there][usable])
        nodes = order((difference,))
        factors = {x for y in nodes if y.op in ("mul", "div", "neg") for x in y.args}
        forced = [x for x, meant in self.meant.items() if meant in self.case.system.symbols.a]
        whole = {difference, *(difference.args if difference.op == "neg" else ())}
        for node in [x for x in nodes if x not in whole][:MOST_PLACES]:
            found = _needed(difference, node, values)
            if found is None:
                continue
            if node is left and len(self.written.left.code) == 1:
                known = list(other_forms(node, *found))
            else:
                known = products.changes(node, *found, inner=node in factors, forced=depends_on(node, forced))
            for each in known:
                if each.kind != "extra_term" or node not in self._sides[:2]:
                    yield node, each


def _needed(difference: Node, node: Node, values: Mapping[Node, np.ndarray]) -> tuple[np.ndarray, np.ndarray] | None:
    """The values of a node, and those with which the difference vanishes at every state; None: there are none."""
    zero = np.zeros(len(next(iter(values.values()))))

    def at(x: Node, known: Mapping[Node, np.ndarray]) -> np.ndarray:
        found: np.ndarray = np.asarray(evaluate((x,), known, ARRAYS)[0], dtype=float) + zero
        return found

    with np.errstate(all="ignore"):
        own = at(node, values)
        size = np.abs(own) + tolerances.COMPUTED
        x, y = own, own + size / 10
        f, g = (at(difference, {**values, node: each}) for each in (x, y))
        scale = np.abs(f) + np.abs(g)
        for _ in range(STEPS):
            step = g * (y - x) / (g - f)
            x, f = y, g
            y = np.where(np.isfinite(step), y - step, y)
            g = at(difference, {**values, node: y})
            if not np.all(np.isfinite(g)):
                return None
            if np.all(np.abs(g) <= tolerances.COMPUTED * scale):
                return (own, y) if np.all(np.abs(y) < FARTHEST * size) else None
    return None


# -------- forces of constraints -------------------------------------------------------------------------------
# In the plane balances of what is cut free are searched (`balances`). In space, and in an equation of motion
# with reactions, one of the author's is turned round, or another of its kind is added with the factor of one there.


def of_forces(case: Case, written: HandEquation, kind: str) -> Cause | None:
    """The one reaction by which a wrong equation would be right; None: it is none of these."""
    calls = list(dict.fromkeys(call for call in written.calls if FUNCTION_KINDS.get(call.name) == "reaction"))
    if (case.model.space != "space" and kind != "motion") or not calls or case.unknown_names(written):
        return None
    with suppress(EomgenError):
        return next(_forces(case, written, calls), None)
    return None


def _forces(case: Case, written: HandEquation, calls: list[Call]) -> Iterator[Cause]:
    graph = case.system.scope.graph
    symbols = {call: graph.symbol(f"({call})") for call in calls}

    def opaque(call: Call) -> Scalar:
        return symbols[call] if call in symbols else case.called(call)

    def holds(x: Scalar) -> bool:
        (there,) = substituted((x,), values)
        if depends_on(there, case.forced):
            return bool(case.follows(there).holds)
        return bool(is_zero_everywhere(case.system, there).holds)

    left, right = (case.evaluated(side, case.names, opaque) for side in (written.left, written.right))
    values: dict[Node, Scalar] = {symbol: case.called(call) for call, symbol in symbols.items()}
    slopes = {call: derivative(left - right, symbol) for call, symbol in symbols.items()}
    if any(depends_on(slope, tuple(values)) for slope in slopes.values()) or all(map(is_zero, values.values())):
        return
    for call, slope in slopes.items():
        if not is_zero(values[symbols[call]]) and holds(left - right - 2 * slope * symbols[call]):
            yield Cause("sign", f"the force {call} has the wrong sign", str(call), force=str(call), quantity=str(call))
    if not is_zero(right) and holds(left + right):
        yield Cause("sign", "one of the sides has the wrong sign", quantity="the signs")
    for call, slope in slopes.items():
        for _, other in case.reading.requested:
            if other.name == call.name and other not in symbols:
                more = slope * case.called(other)
                if not is_zero(more) and any(holds(left - right + sign * more) for sign in (1, -1)):
                    text = f"the force {other} is missing, which stands with the same factor as {call}"
                    yield Cause("missing_term", text, str(other), force=str(other), quantity=str(other))


# -------- other names and conventions -------------------------------------------------------------------------
MOST_READINGS = 600  # ways to read names that are not the model's
FEW_READINGS = 60  # of them are tried whatever it takes
NODES = 60_000  # of the equations of motion that all ways together may evaluate: each is compared with them

POTENTIAL, KINETIC = "potential_energy", "kinetic_energy"
WORK = "the work of constant forces counted as a potential energy"
UNDAMPED = "the frequency without the damping"
NATURAL = ("omega_0", "omega0", "omega_n", "omegan", "f_0", "f0", "T_0", "T0")
"""letters of a natural frequency, or its period, which books have for the motion without damping"""


@dataclass(frozen=True)
class Renaming:
    """Meaning of names that the model does not have.

    Args:
        values: of each name, with its primes, the scalar.
        reported: of each name without primes the text: {phi: "theta - pi/2"}.
        near: whether every name is spelt as what it stands for, but for case and marks, or moves as it does.
        guessed: a name that does not move stands for a coordinate: where constraints hold that at 0, it says nothing.
    """

    values: Mapping[str, Scalar]
    reported: Mapping[str, str]
    near: bool = True
    guessed: bool = False


def renamings(case: Case, written: HandEquation, unknown: Sequence[str]) -> Iterator[Renaming]:
    """Ways to read the unknown names, the nearest first, at most MOST_READINGS; fewer where the equations are long."""
    equations = case.parts.equations
    entries = () if equations is None else (*equations.forcing, *(x for row in equations.M for x in row))
    most = max(FEW_READINGS, min(MOST_READINGS, NODES // max(1, len(order(entries)))))
    return islice(_renamings(case, written, unknown), most)


def _renamings(case: Case, written: HandEquation, unknown: Sequence[str]) -> Iterator[Renaming]:
    coordinates = [name for name in case.model.coordinates if name not in written.names]
    still_named = (*case.model.parameters, *case.model.inputs, *case.model.states)
    parameters = [name for name in still_named if name not in written.names]
    moving = [name for name in unknown if {f"{name}'", f"{name}''"} & written.names]
    still = [name for name in unknown if name not in moving]
    turns = cache(lambda of: list(_turns(case, of)) if of in case.model.coordinates else [(1, 0)])
    for places in _choices(moving, coordinates):
        for constants in _choices(still, [*parameters, *(q for q in coordinates if q not in places)]):
            named = dict(zip((*moving, *still), (*places, *constants), strict=True))
            for chosen in product(*map(turns, named.values())):
                near = all(name in moving or _distance(name, of) < 1 for name, of in named.items())
                ways = {name: (of, *how) for (name, of), how in zip(named.items(), chosen, strict=True)}
                guessed = any(of in case.model.coordinates and name not in moving for name, of in named.items())
                yield replace(_renaming(case, ways), near=near, guessed=guessed)


def _choices(names: Sequence[str], among: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """The choices of meanings for names; those that are spelt alike first, at most MOST_READINGS."""
    if len(names) <= len(among):
        yield from islice((tuple(among[k] for k in chosen) for chosen in _nearest_first(names, among)), MOST_READINGS)


def _nearest_first(names: Sequence[str], among: Sequence[str]) -> Iterator[tuple[int, ...]]:
    """Numbers of different ones of `among`, one for each name, by the sum of their distances, then by themselves.

    Best first: what is open holds beginnings, each by the least that its end can come to.
    """
    distances = [[_distance(name, other) for other in among] for name in names]
    least = [sum(map(min, distances[k:])) for k in range(len(names) + 1)]
    opened: list[tuple[float, tuple[int, ...]]] = [(least[0], ())]
    while opened:
        bound, chosen = heappop(opened)
        k = len(chosen)
        if k == len(names):
            yield chosen
            continue
        for i, distance in enumerate(distances[k]):
            if i not in chosen:
                heappush(opened, (bound - least[k] + distance + least[k + 1], (*chosen, i)))


def _distance(a: str, b: str) -> float:
    """Distance of two names; 0: they are one but for case and marks."""
    x, y = (name.lower().replace("_", "") for name in (a, b))
    if x == y:
        return 0
    digits = [[c for c in name if c.isdigit()] for name in (x, y)]
    return 1 + (x[:1] != y[:1]) + (digits[0] != digits[1])


def _turns(case: Case, name: str) -> Iterator[tuple[int, Scalar]]:
    """(sign, shift) of q = sign * own + shift: none first."""
    pi = case.system.scope.graph.pi
    quarter = over(pi, 2)
    yield 1, 0
    if case.dimension(name) in ANGLES:
        for sign in (1, -1):
            for shift in (0, quarter, -quarter, pi):
                if (sign, shift) != (1, 0):
                    yield sign, shift
        return
    yield -1, 0
    for place in case.places_of_rest:
        rest = next((x for q, x in place.items() if q.name == name), 0)
        if not is_zero(rest):
            yield 1, -rest
            yield -1, rest
    for parameter, node in case.system.symbols.parameters.items():
        if case.dimension(parameter) == case.dimension(name):
            for sign in (1, -1):
                yield from ((sign, node), (sign, -node))


def _renaming(case: Case, named: Mapping[str, tuple[str, int, Scalar]]) -> Renaming:
    names = case.system.scope.names
    values: dict[str, Scalar] = {}
    reported: dict[str, str] = {}
    for name, (of, sign, shift) in named.items():
        values[name] = sign * names[of] + shift
        for primes in ("'", "''"):
            if of + primes in names:
                values[name + primes] = sign * names[of + primes]
        if (sign, shift) != (1, 0) or of != name:
            reported[name] = to_text(values[name]) if isinstance(values[name], Node) else str(values[name])
    return Renaming(values, reported)


# -------- conventions -----------------------------------------------------------------------------------------
# What authors count otherwise -> whether an equation is right in that sense.


def is_of_kinetic_energy(written: HandEquation) -> bool:
    """True if kinetic energies stand in it and no potential one: no constant may be added to these."""
    names = {call.name for call in written.calls}
    return KINETIC in names and POTENTIAL not in names


def potential_of_constant_forces(case: Case, written: HandEquation) -> Scalar:
    """The negative work of constant forces, which the model does not count among its potential energies; 0 of none."""
    if not any(call.name == POTENTIAL and not call.args for call in written.calls):
        return 0
    return sum((part.V for part in case.parts.elementary if part.kind == "constant"), start=0)


def with_constant_forces(case: Case, written: HandEquation, kind: str) -> Decided | None:
    """Right where V holds the work of constant forces, too; None: it is not so."""
    work = potential_of_constant_forces(case, written) if kind in ("energy", "law") else 0
    if is_zero(work):
        return None

    def called(call: Call) -> Scalar:
        return case.called(call) + (work if call.name == POTENTIAL and not call.args else 0)

    scalar = case.evaluated(written.difference, case.names, called)
    found = truth_of(case, scalar, kind)
    if not found.holds:
        found = on_one_side(case, written, kind, scalar) or found
    return Decided(True, " and ".join(filter(None, (WORK, found.up_to)))) if found.holds else None


def with_reactions_of_zero(case: Case, written: HandEquation, kind: str, up_to: str) -> str:
    """Words for what an equation is right up to; of one of motion also its reactions that are 0 in every motion."""
    calls = written.calls if kind == "motion" else ()
    asked = [call for call in calls if FUNCTION_KINDS.get(call.name) == "reaction"]
    found = {call: truth_of(case, case.called(call), "motion") for call in asked}
    idle = [call for call, x in found.items() if x.holds or x.why == IDENTITY]
    letters = ", ".join(written.letters.get(str(call), str(call)) for call in idle)
    reported = f"{letters}, which {'is' if len(idle) == 1 else 'are'} 0 in every motion" if idle else ""
    return " and ".join(filter(None, (up_to, reported)))


def without_damping(case: Case, written: HandEquation) -> HandEquation | None:
    """The same, omega_0 as sqrt(K/M) of the one motion; None: it is another letter, or there are several motions."""
    speeds = case.system.symbols.u
    asked = [call for call in written.left.calls if call.name == "frequency"]
    letter = re.match(r"\w+", written.left.text)
    if letter is None or letter[0] not in NATURAL or len(speeds) != 1 or len(asked) != 1:
        return None
    q = speeds[0].name.removesuffix("'")
    if q not in case.model.coordinates:
        return None
    root = parse(f"sqrt(stiffness({q}, {q})/mass({q}, {q}))", references=True)
    code = tuple(x for kind, what in written.left.code for x in (root.code if what == asked[0] else ((kind, what),)))
    return replace(written, left=Expression(str(root.text), code, (-1,) * len(code)))
