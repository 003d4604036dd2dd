"""An answer of somebody -> the equation of motion that it would follow from, beside the model's.

Of one freedom: omega implies q'' = -omega^2 q, an equilibrium that the forces balance there, a course its own rates, a
speed at an instant its kinetic energy. Put into the model's equation, what is left is explained by the contributions:

    E + sum y_j C_j = 0

Of a structure the reactions are sums over the loads. Where none of these applies, the answer is looked at term by term,
as it stands and under its root.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from itertools import chain, islice
from typing import Protocol

import numpy as np

from eomgen.errors import DerivationError, EomgenError, ExpressionError
from eomgen.frozen import dataclass
from eomgen.judge.balances import Balances, requests_reactions
from eomgen.judge.case import Case
from eomgen.judge.comparison import Comparison, excess
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.diagnosis import (
    BELIEVED,
    DEAREST,
    FAR_FETCHED,
    MOST_MISTAKES,
    MOST_NEAR,
    NEARLY,
    PLAINEST,
    TERMS,
    USUAL,
    Explanation,
    Mistake,
    Search,
    Share,
    cost_of,
    explained,
    fitting,
    in_other_units,
    samples_of,
)
from eomgen.judge.reading import HandEquation
from eomgen.judge.terms import WrongTerms
from eomgen.judge.truth import directions_at_start, signs_at_start, sizes_in
from eomgen.model import AtRest, WrittenEquation
from eomgen.questions import Answer
from eomgen.symbolic.exact import determinant
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Reference,
    Scalar,
    ScalarRow,
    depends_on,
    derivative,
    gradient,
    is_zero,
    order,
    over,
    substituted,
)
from eomgen.symbolic.numeric import tolerances


@dataclass(frozen=True)
class PutIn:
    """A way to put an answer into an equation.

    Args:
        case: the model in the phase of the answer.
        what: of which equation, as of Mistakes.
        into: a row, the answer put in.
        resisting: what of a row answers to a change.
        row: into which of the rows.
    """

    case: Case
    what: str
    into: Callable[[Scalar], Scalar]
    resisting: Callable[[Scalar], Scalar]
    row: int = 0


Instant = WrittenEquation | AtRest | None
STATES_OF_VALUES = 12  # sets of values of the parameters at which an answer is compared


@dataclass(frozen=True)
class Implied:
    """The remainder of the model's equation with an answer put in.

    Args:
        case: the model.
        left: E, with the answer put in.
        mistakes: with the answer put in.
        resisting: of E and of every mistake what answers to a change: inertia, or stiffness. Some must be left.
    """

    case: Case
    left: Scalar
    mistakes: tuple[Mistake, ...]
    resisting: ScalarRow

    def explained(self, number: int) -> list[Explanation]:
        """The explanations by so many mistakes."""
        return explained(self._searches, self.proves, number)

    @cached_property
    def _searches(self) -> tuple[Search, ...]:
        flat = [self.left, *(each.rows[0] for each in self.mistakes), *self.resisting]
        samples = samples_of(self.case.system, flat, places=STATES_OF_VALUES)
        if samples is None:
            return ()
        found, n = samples.of(flat), len(self.mistakes)
        others = in_other_units(samples, self.case.edits.dimensions)
        ours = found[: n + 1]
        fits = np.ones(n, dtype=bool) if others is None else fitting(ours, others.of(flat[: n + 1]), 1, 1)
        known = tuple(each for each, fit in zip(self.mistakes, fits, strict=True) if fit)
        resisting = (found[n + 1], found[n + 2 :][fits])
        return (Search(None, found[0], found[1 : n + 1][fits], known, 0, resisting=resisting),)

    def difference(self, explanation: Explanation) -> str:
        """The remainder of the model's equation."""
        return excess(self.case, self.left)

    def proves(self, explanation: Explanation) -> bool:
        """True if the answer exactly satisfies the model's equation with these mistakes."""
        pi = self.case.system.scope.graph.pi
        total = sum((share.added(pi)[0] for share in explanation.shares), start=self.left)
        return bool(is_zero_everywhere(self.case.system, total).holds)


def implied_by(
    case: Case, written: HandEquation, kind: str, at: Instant, true: Answer, author: Answer
) -> Iterator[Implied | Comparison | GivenFrequency]:
    """The comparisons of an answer with the model, the most telling first.

    Args:
        true, author: the answer of the model and that of somebody.
    """
    own, other = case.exact(true), case.exact(author)
    if other is None:
        return
    with suppress(DerivationError):  # a putting has no value
        for put in _puttings(case, written, kind, at, author):
            with suppress(EomgenError):
                found = _implied(put)
                if found is not None:
                    yield found
    if own is not None:
        yield from _beside_answer(case, written, own, other)
    alone = len(written.left.code) == 1 and kind == "frequency" and not case.closing and case.system.free is None
    if alone and 1 < len(case.rows) <= MOST_DEGREES_OF_FREEDOM:
        yield GivenFrequency(case, other, dict(([{}, *case.places_of_rest])[-1]))


def _beside_answer(case: Case, written: HandEquation, own: Scalar, other: Scalar) -> Iterator[Comparison]:
    """The comparisons of somebody's value with the true one."""
    call = written.left.calls[0] if len(written.left.code) == 1 and written.left.calls else None
    yield Comparison(case, other - own, (own,), "", call)
    if any(x.op == "sqrt" for x in order((own, other))):
        yield Comparison(case, other * other - own * own, (own * own,), "", squared=True)


class Explainable(Protocol):
    """A thing of which explanations are sought."""

    def explained(self, number: int) -> list[Explanation]:
        """The explanations by so many mistakes."""

    def difference(self, explanation: Explanation) -> str:
        """The excess on the left side."""


def simplest_explanation(
    targets: Iterable[Explainable], fixes: Iterable[Explainable] = (), *, soon: bool = False, at_once: float = BELIEVED
) -> tuple[Explainable | None, list[Explanation]]:
    """The comparison that is explained by the fewest mistakes, with its explanations: the first that is believed.

    Args:
        fixes: looked at where no one mistake of the others is believed.
        soon: already where none is plain: the author wrote no equation of motion.
        at_once: the cost of a mistake up to which no further comparison is looked at.
    """
    best: tuple[Explainable | None, list[Explanation]] = None, []
    beside: list[Explanation] = []
    known, own = tuple(targets), tuple(fixes)
    for number in range(1, MOST_MISTAKES + 1):
        for some, believed in (
            (known, number * at_once),
            (own if number == 1 else (), BELIEVED if soon else FAR_FETCHED),
        ):
            for target in some if not best[1] or some is known or best[1][0].cost >= believed else ():
                with suppress(DerivationError):
                    found = [x for x in target.explained(number) if x.cost <= DEAREST[number]]
                    if found and (not best[1] or found[0].cost < best[1][0].cost):
                        best, found = (target, found), best[1]
                    beside += found if not isinstance(target, Comparison) or not target.squared else []
                if best[1] and best[1][0].cost < believed:
                    break
        if best[1] and best[1][0].cost < FAR_FETCHED + (number - 1) * PLAINEST:
            break
    near = [x for x in beside if x.cost <= best[1][0].cost + NEARLY]
    return best[0], [*best[1], *sorted(near, key=lambda x: x.cost)]


def implied_by_course(case: Case, known: Mapping[Node, Scalar]) -> Implied | None:
    """Remainder of the equation of motion for a coordinate as a function of time; None: it needs the others."""
    symbols = case.system.symbols
    others = [x for x in (*symbols.x, *case.forced) if x not in known]
    for k, (row, a) in enumerate(zip(case.rows, symbols.a, strict=True)):
        left = substituted((row, derivative(row, a)), known)
        if a in known and not any(depends_on(x, others) for x in left):
            return _implied(
                PutIn(
                    case,
                    "motion",
                    lambda row: substituted((row,), known)[0],
                    lambda row, a=a: substituted((derivative(row, a),), known)[0],  # type: ignore[misc]
                    k,
                )
            )
    return None


def implied_by_rest(case: Case, written: HandEquation) -> Implied | None:
    """The remainder of the balance of forces at a place q = value, or cos(q) = value; None: it is no such place."""
    scalar = case.value(written.difference)
    held = [q for q in case.system.symbols.q if depends_on(scalar, (q,))]
    if len(case.rows) != 1 or len(held) != 1:
        return None
    (q,) = held
    graph = q.graph
    for x in (q, graph.held("sin", (q,)), graph.held("cos", (q,)), graph.held("tan", (q,))):
        free = graph.symbol("(x)")
        (of_it,) = substituted((scalar,), {x: free})
        slope = derivative(of_it, free)
        if is_zero(slope) or depends_on(of_it, (q,) if x is not q else ()) or depends_on(slope, (free,)):
            continue
        (rest,) = substituted((of_it,), {free: 0})
        return _implied(_resting(case, q, over(-rest, slope), x))
    return None


def beside_rest(case: Case, scalar: Scalar) -> list[Comparison]:
    """An equation of what does not move, beside the model's: with one mistake it is that, or its opposite."""
    still = dict.fromkeys((*case.system.symbols.u, *case.system.symbols.a), 0)
    if len(case.rows) != 1 or case.closing:
        return []
    rows = substituted(case.rows, still)

    def wrong() -> Iterator[Mistake]:
        for each in case.mistakes("motion").all:
            with suppress(DerivationError):  # it has no value there
                yield replace(each, rows=substituted(each.rows, still))

    return [Comparison(case, k * scalar - rows[0], rows, "", more=wrong) for k in (1, -1)]


def _implied(put: PutIn) -> Implied | None:
    """The one equation of the model and its mistakes, with an answer put in."""
    case, known = put.case, put.case.mistakes(put.what)
    if put.what == "motion":
        whole = case.rows[put.row]
    else:
        whole = sum((known.rows(part)[0] for part in case.parts.elementary if part.row is None), start=0)
    left = put.into(whole)
    moving = (*case.system.symbols.u, *case.system.symbols.a)
    if is_zero(left) or depends_on(left, moving):
        return None
    found, resisting = list[Mistake](), [put.resisting(whole)]
    symbols = case.system.symbols
    rates = frozenset((*symbols.u, *symbols.a))
    wrong = WrongTerms(case.edits, tuple(symbols.parameters.values()), rates)
    terms = chain(wrong.in_rows((whole,)), wrong.throughout((whole,)))
    single = (replace(each, rows=(0,) * put.row + each.rows) for each in terms)
    for each in (*known.all, *single):
        with suppress(DerivationError):
            row = put.into(each.rows[put.row])
            if not is_zero(row) and not depends_on(row, moving):
                resisting.append(put.resisting(each.rows[put.row]))
                found.append(replace(each, rows=(row,)))
    return Implied(case, left, tuple(found), tuple(resisting))


def _puttings(case: Case, written: HandEquation, kind: str, at: Instant, author: Answer) -> Iterator[PutIn]:
    """The ways to put the answer into the equation of a model of one degree of freedom."""
    symbols, value = case.system.symbols, case.exact(author)
    assert value is not None
    free = [q for q in symbols.q if not case.model.coordinates[q.name].driven]
    if len(case.rows) != 1 or len(free) != 1 or len(symbols.u) != 1 or case.closing or case.system.free is not None:
        return
    (q,), (u,), (a,) = free, symbols.u, symbols.a
    still: dict[Node, Scalar] = {u: 0, a: 0}
    if kind == "frequency" and [call.name for call in written.left.calls] == ["frequency"]:
        place = _place(case, q)
        if place is not None and len(written.left.code) == 1:

            def slope(row: Scalar, x: Node) -> Scalar:
                return substituted((derivative(row, x),), {**still, **place})[0]

            yield PutIn(
                case, "motion", lambda row: slope(row, q) - value * value * slope(row, a), lambda row: slope(row, a)
            )
    elif isinstance(at, AtRest) or kind == "equilibrium":
        if written.left.names == {q.name} and len(written.left.code) == 1:
            yield _resting(case, q, value)
    elif isinstance(at, WrittenEquation):
        begun = case.as_begun or case
        moment = begun.exact(author)
        if moment is not None:
            yield from _at_instant(begun, written, at, moment)


def _resting(case: Case, q: Node, value: Scalar, of: Node | None = None) -> PutIn:
    """An equilibrium, q or a function of it, put into the equation of what does not move."""
    at = {q if of is None else of: value, **dict.fromkeys((*case.system.symbols.u, *case.system.symbols.a), 0)}
    return PutIn(
        case,
        "motion",
        lambda row: substituted((row,), at)[0],
        lambda row: substituted((derivative(row, q),), at)[0],
    )


def _place(case: Case, q: Node) -> dict[Node, Scalar] | None:
    """The place of the small motions; {} where that does not matter."""
    u, a = case.system.symbols.u[0], case.system.symbols.a[0]
    slopes = substituted((derivative(case.rows[0], q), derivative(case.rows[0], a)), {u: 0, a: 0})
    if not any(depends_on(slope, (q,)) for slope in slopes):
        return {}
    return {q: case.places_of_rest[0][q]} if case.places_of_rest else None


def _at_instant(case: Case, written: HandEquation, at: WrittenEquation, author: Scalar) -> Iterator[PutIn]:
    """A speed at a place, a way or a time at a speed: by the energies, or by a constant acceleration."""
    symbols, start = case.system.symbols, case.start
    (u,), (a,) = symbols.u, symbols.a
    q = next(x for x in symbols.q if x.name == u.name.removesuffix("'"))
    if not start or at.left.text not in (q.name, u.name):
        return
    (reached,) = substituted((case.value(at.right),), start)
    if depends_on(reached, (*symbols.x, symbols.t)):
        return
    steady = not depends_on(case.rows[0], (symbols.t, q, u))
    q1: Scalar | None = reached
    squared: Scalar | None = reached * reached
    if at.left.text != u.name:
        squared = _squared_speed(case, written, author, {q: reached})
    else:
        q1 = author if written.left.text == q.name else None
    acceleration: Scalar | None = None
    if written.left.text == "t" and at.left.text == u.name:
        acceleration = over(reached - start[u], author)
    elif q1 is not None and squared is not None:
        acceleration = over(squared - start[u] * start[u], 2 * (q1 - start[q]))
        if not any(part.Q or part.row is not None for part in case.parts.elementary):

            def inertia(x: Scalar) -> Scalar:
                return substituted((derivative(derivative(x, u), u),), {q: q1})[0]

            def energy(x: Scalar) -> Scalar:
                (held,) = substituted((x,), {u: 0, q: q1})
                return over(inertia(x) * squared, 2) + held - substituted((x,), start)[0]

            yield PutIn(case, "energy", energy, inertia)
    if acceleration is not None and steady:
        yield PutIn(
            case, "motion", lambda row: substituted((row,), {a: acceleration})[0], lambda row: derivative(row, a)
        )


def _squared_speed(case: Case, written: HandEquation, author: Scalar, place: Mapping[Node, Scalar]) -> Scalar | None:
    """u^2, where a speed is requested, c u or |c u|, or what depends on its square alone, as forces of turning do."""
    u = case.system.symbols.u[0]
    try:
        requested = case.value(written.left)
        if depends_on(requested, case.forced):
            requested = case.phase.simple(case.phase.eliminated(requested))
        plain, square = substituted((requested, requested * requested), place)
    except (ExpressionError, DerivationError):
        return None
    for value, given in ((plain, author), (square, author * author)):
        first = derivative(value, u)
        second, (still, steady) = derivative(first, u), substituted((value, first), {u: 0})
        if is_zero(second) or (value is square and not is_zero_everywhere(case.system, still).holds):
            continue
        if is_zero_everywhere(case.system, steady, *(derivative(second, x) for x in (u, *case.system.symbols.a))).holds:
            (second,) = substituted((second,), {u: 1})
            found = over(2 * (given - still), second)
            return None if is_zero_everywhere(case.system, found).holds else found  # it does not move: no energy
    return None


# -------- frequencies -----------------------------------------------------------------------------------------
# A frequency that somebody gives for a system of several degrees of freedom -> what would have to be wrong for it to
# be one.
#
#     det(K + y C_K - omega^2 (M + y C_M)) = 0
#
# M and K are the slopes of the equations of motion at the equilibrium, C_M and C_K those of what a mistake adds,
# once or as often as people write it; at a few sets of values in doubles first, and what holds there is proven
# exactly.


MOST_DEGREES_OF_FREEDOM = 4
STATES = 6  # sets of values at which it is tried
BY_CHANCE = 3.0  # how much less it is believed: many things make a determinant vanish
OTHER = 1.37  # times the frequency: what vanishes there as well says nothing
FACTORS = (Fraction(0), Fraction(-1), *(x for some, _ in USUAL for x in some if x != 1))


@dataclass(frozen=True)
class GivenFrequency:
    """A frequency of somebody.

    Args:
        case: the model.
        omega: what he gives.
        place: where the motion is small; {} where that does not matter.
    """

    case: Case
    omega: Scalar
    place: dict[Node, Scalar]

    def explained(self, number: int) -> list[Explanation]:
        """Single mistakes with which it is a frequency, the most believable first, each proven."""
        found = sorted(self._fitting, key=lambda each: each.cost) if number == 1 else []
        return list(islice(filter(self._proves, found), MOST_NEAR))

    def difference(self, explanation: Explanation) -> str:
        """The value of the determinant, which should vanish."""
        return excess(self.case, determinant(self._matrix(self._slopes(self.case.rows))))

    # -- slopes ----------------------------------------------------------------------------------

    def _slopes(self, rows: ScalarRow) -> tuple[ScalarRow, ScalarRow]:
        """M and K of rows, flat."""
        symbols = self.case.system.symbols
        named = {q.name: q for q in symbols.q}
        q = tuple(named[u.name.removesuffix("'")] for u in symbols.u)
        still = {**dict.fromkeys((*symbols.u, *symbols.a), 0), **self.place}
        both = [x for along in (symbols.a, q) for row in rows for x in gradient(row, along)]
        flat = substituted(tuple(both), still)
        half = len(flat) // 2
        return flat[:half], flat[half:]

    def _matrix(self, slopes: tuple[ScalarRow, ScalarRow]) -> list[ScalarRow]:
        """K - omega^2 M"""
        n, square = len(self.case.rows), self.omega * self.omega
        flat = [k - square * m for m, k in zip(*slopes, strict=True)]
        return [tuple(flat[i : i + n]) for i in range(0, n * n, n)]

    @cached_property
    def _known(self) -> list[tuple[Mistake, tuple[ScalarRow, ScalarRow]]]:
        """Possible mistakes with their derivatives."""
        found = []
        for each in (x for x in self.case.mistakes("motion").all if x.rank < TERMS):
            with suppress(DerivationError):  # it has no value there
                slopes = self._slopes(each.rows)
                if not all(is_zero(x) for row in slopes for x in row):
                    found.append((each, slopes))
        return found

    # -- the search ------------------------------------------------------------------------------

    @cached_property
    def _fitting(self) -> list[Explanation]:
        """The mistakes that make the determinant vanish in numbers."""
        n, own = len(self.case.rows), self._slopes(self.case.rows)
        flat = [self.omega, *(x for M, K in (own, *(slopes for _, slopes in self._known)) for x in (*M, *K))]
        samples = samples_of(self.case.system, flat, places=STATES)
        if samples is None:
            return []
        values = samples.of(flat)[:, :, 0]  # nothing of it moves
        square = values[0] ** 2
        every = np.moveaxis(values[1:].reshape(-1, 2, n, n, values.shape[1]), 4, 2)  # of M and K, state by state

        def size(at: np.ndarray, y: float, k: int) -> np.ndarray:
            M, K = every[0] + y * every[k + 1] if k >= 0 else every[0]
            A = K - at[:, None, None] * M
            scale = np.prod(np.linalg.norm(np.abs(K) + at[:, None, None] * np.abs(M), axis=2), axis=1)
            found: np.ndarray = np.abs(np.linalg.det(A)) / scale
            return found

        found = []
        for k, (mistake, _) in enumerate(self._known):
            for x in FACTORS if mistake.open else (Fraction(1),):
                y = float(x - 1) if mistake.open else 1.0
                with np.errstate(all="ignore"):
                    if np.all(size(square, y, k) < tolerances.CARRIED) and np.all(
                        size(OTHER * square, y, k) > tolerances.CARRIED
                    ):
                        share = Share(mistake, x)
                        found.append(Explanation((share,), 0, cost_of(share) + BY_CHANCE))
        return found

    def _proves(self, explanation: Explanation) -> bool:
        (share,) = explanation.shares
        rows = tuple(x + y for x, y in zip(self.case.rows, share.added(self.case.system.scope.graph.pi), strict=True))
        return bool(is_zero_everywhere(self.case.system, determinant(self._matrix(self._slopes(rows)))).holds)


# -------- targets ---------------------------------------------------------------------------------------------
# An equation of somebody -> what it is compared with, the most telling first.


Meanings = Mapping[str, Scalar]
_WHAT = {"kinetic_energy": "T", "potential_energy": "V", "generalized_force": "Q"}


def targets_of(
    case: Case, written: HandEquation, kind: str, scalar: Scalar, also: Meanings | None
) -> list[Explainable]:
    """The comparisons of an equation with the model, the most telling first."""
    if kind in ("reaction", "motion") and not also and requests_reactions(written):
        begun = case.as_begun or case  # it slides as the author says, not by the sign of a speed
        balances = (Balances(begun, written), Balances(begun, written, finely=True))
        return [balances[0], *_values_of(case, written, kind, scalar, also), balances[1]]
    return [*_values_of(case, written, kind, scalar, also)]


def _values_of(case: Case, written: HandEquation, kind: str, scalar: Scalar, also: Meanings | None) -> list[Comparison]:
    """Its values and the equations of motion."""
    calls = set(written.calls)
    if kind == "motion" or (kind in ("law", "energy") and not calls):
        if not case.rows or not depends_on(scalar, (*case.system.symbols.u, *case.forced)):
            return []  # of a place alone any equation without motion is some multiple
        of_energy = _energies(case, scalar) if kind in ("law", "energy") else []
        of_law = () if depends_on(scalar, case.forced) else _rates(case, scalar)
        sizes = {**signs_at_start(case, sizes_in(case, written, scalar)), **directions_at_start(case, written)}
        rows = substituted(case.rows, sizes)
        return of_energy + [
            Comparison(case, each, rows, "motion", sizes=sizes) for each in substituted((*of_law, scalar), sizes)
        ]
    if len(calls) != 1:
        return _sums(case, written, scalar) if calls else []
    (call,) = calls
    symbol = case.system.scope.graph.symbol(f"({call})")
    left = case.evaluated(written.difference, {**case.names, **(also or {})}, lambda _: symbol)
    slope = derivative(left, symbol)
    if depends_on(slope, (symbol,)) or is_zero(slope):
        return [] if is_zero(slope) else _sums(case, written, scalar)
    (rest,) = substituted((left,), {symbol: 0})
    author, true = over(-rest, slope), case.called(call)
    sizes = sizes_in(case, written, author - true)
    if sizes:  # of a speed the author wrote without its sign
        (true,) = substituted((true,), {**sizes, **signs_at_start(case, sizes)})
    of = tuple(x.name for x in call.args if isinstance(x, Reference))
    found = [Comparison(case, author - true, (true,), _WHAT.get(call.name, ""), call, of)]
    moving = (*case.system.symbols.a, *case.system.symbols.lam)
    if depends_on(true, moving) and not depends_on(author, moving):
        with suppress(EomgenError):
            so = case.phase.simple(case.phase.eliminated(true))
            if sizes := sizes_in(case, written, author - so):
                so = case.phase.simple(substituted((so,), {**sizes, **signs_at_start(case, sizes)})[0])
            found.append(Comparison(case, author - so, (so,), "", call, of))
            true = so
    if any(x.op == "sqrt" for x in order((author, true))) and not depends_on(true, moving):
        found.append(Comparison(case, author * author - true * true, (true * true,), "", squared=True))
    return found


def _sums(case: Case, written: HandEquation, scalar: Scalar) -> list[Comparison]:
    """Several functions: where all stand on one side, the other is the author's value of what is there."""
    author, of = (written.right, written.left) if not written.right.calls else (written.left, written.right)
    if author.calls:
        return [Comparison(case, scalar, (0,), "")]
    true, theirs = case.value(of), case.value(author)
    found = [Comparison(case, theirs - true, (true,), "")]
    with suppress(EomgenError):
        so = case.phase.simple(case.phase.eliminated(true)) if depends_on(true, case.forced) else true
        found = [Comparison(case, theirs - so, (so,), "")] if not depends_on(theirs, case.forced) else found
    return found


def loosened_targets(case: Case, written: HandEquation, kind: str) -> list[Comparison]:
    """The same where rates of what is driven or dependent stand by their names, as the author has them."""
    loose, coordinates = case.loosened, case.model.coordinates
    bound = {f"{q}{dots}" for q, x in coordinates.items() if x.driven or x.dependent for dots in ("'", "''")}
    if loose is None or "t" in written.names or kind == "reaction" or not bound & written.names:
        return []
    with suppress(EomgenError):
        scalar, a = loose.value(written.difference), loose.system.symbols.a
        found = []
        if not written.calls and loose.system.constraints.J:
            rows = loose.constrained_rates[depends_on(scalar, a)]
            found = [Comparison(loose, scalar, rows, "constraints")]
        if written.calls or not any(x.dependent for x in coordinates.values()):
            found += _values_of(loose, written, kind, scalar, None)
        known = {x: 0 for x in a if x.name in case.steady}
        return [x.with_known(known) for x in found]
    return []


def _energies(case: Case, scalar: Scalar) -> list[Comparison]:
    """The energy theorem, of a law with squares of speeds."""
    u = case.system.symbols.u
    if depends_on(scalar, case.forced) or not any(depends_on(derivative(scalar, x), (x,)) for x in u):
        return []
    return [] if case.gained is None else [Comparison(case, scalar, (case.gained,), "energy")]


def _rates(case: Case, scalar: Scalar) -> tuple[Scalar, ...]:
    """The equation of motion that a law follows from: its rate."""
    if not depends_on(scalar, case.system.symbols.u):
        return ()
    with suppress(DerivationError):
        (rate,) = case.system.scope.with_accelerations((scalar,))
        if len(case.system.symbols.a) == 1:
            slope = derivative(rate, case.system.symbols.a[0])
            rate = rate if is_zero(slope) else over(rate, slope)
        return (rate,)
    return ()
