"""Comparison of somebody's equation with the model's equations or a value, and explanations of the difference."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from itertools import islice, permutations

import numpy as np

from eomgen.errors import DerivationError, ExpressionError, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.judge.case import Case
from eomgen.judge.decision import combination, is_zero_everywhere, linear_row
from eomgen.judge.diagnosis import (
    PIECES,
    SHARED,
    SHORTER,
    TERMS,
    WHOLE,
    Explanation,
    Mistake,
    Samples,
    Search,
    explained,
    fitting,
    in_other_units,
    samples_of,
)
from eomgen.judge.terms import Term, WrongTerms, short_text, term_text, terms_of
from eomgen.judge.verdict import other_calls
from eomgen.symbolic.expression import (
    Call,
    Node,
    Scalar,
    ScalarRow,
    depends_on,
    derivative,
    gradient,
    is_zero,
    operations,
    order,
    over,
    parse,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import tolerances

LONGEST = 3000  # operations of equations that are looked at term by term
_TURNING = frozenset(("abs", "sign", "min", "max", "less", "less_equal"))  # where what is left of the first is 0
EXTRA = 5.6  # rank of a term of the author that does not belong there


@dataclass(frozen=True)
class Comparison:
    """A comparison of an equation with rows or a value of the model.

    Args:
        case: the model.
        scalar: of an equation of motion its left minus its right side; else what the author's value is too much.
        rows: the model's equations of motion; else its value alone.
        what: "motion"; "constraints", of the rates that these allow; "energy", what T + V have gained since the start;
            "T",
            "V", "Q", or "" of other values.
        call: what the value is of.
        of: of which body, force or coordinate an energy or a force is requested; () of the whole.
        more: what may be wrong, in place of what is known of such a value.
        squared: the value is the square of what is requested: its mistakes stand under a root.
        sizes: what roots and sizes |x| are at the start, where the author wrote x.
        near: of linearized rows the place; {} of others.
    """

    case: Case
    scalar: Scalar
    rows: tuple[Scalar, ...]
    what: str
    call: Call | None = None
    of: tuple[str, ...] = ()
    more: Callable[[], Iterable[Mistake]] | None = None
    squared: bool = False
    sizes: Mapping[Node, Scalar] = field(default_factory=dict)
    near: Mapping[Node, Scalar] = field(default_factory=dict)

    def with_known(self, known: Mapping[Node, Scalar]) -> Comparison:
        """The same where nodes have values."""
        scalar, *rows = substituted((self.scalar, *self.rows), known)
        return replace(self, scalar=scalar, rows=tuple(rows), sizes={**self.sizes, **known})

    @cached_property
    def mistakes(self) -> tuple[Mistake, ...]:
        """Possible mistakes, the most believable first."""
        system = self.case.system
        if self.more is not None:
            return tuple(self.more())
        structural: list[Mistake] = []
        if self.what == "constraints":
            pass
        elif self.what:
            structural += self._structural()
            if self.sizes:
                structural = [replace(x, rows=substituted(x.rows, self.sizes)) for x in structural]
            if self.near:
                structural = list(_linearized(structural, self.near))
        else:
            structural += self._other_arguments()
            structural += self._classes()
        if not self._is_equation:
            requested = self.call
            what = (
                "it"
                if requested is None
                else str(requested)
                if requested.args
                else f"the {requested.name.replace('_', ' ')}"
            )
            structural.append(Mistake(f"{WHOLE} {what}", "factor", self.rows, 1))
        if self.is_long:
            return tuple(structural)
        concerned, known = self._concerned, tuple(system.symbols.parameters.values())
        held = {*symbols_of((self.scalar, *concerned))}
        rates = frozenset(x for x in (*system.symbols.u, *system.symbols.a) if x in held)
        wrong = WrongTerms(self.case.edits, known, rates)
        terms = [*wrong.in_rows(concerned, self._known_terms), *wrong.throughout(concerned)]
        if not self.what:
            terms += changed_answers(self.case, self.rows)
        return (*structural, *sorted(terms, key=lambda each: each.rank))

    @property
    def _known_terms(self) -> Collection[Term]:
        """Terms that are looked at as those of a contribution."""
        known = self.what and self.what not in ("constraints", "Q") and not self.sizes and not self.near
        return self.case.mistakes(self.what, self.of).terms if known else ()

    @property
    def _concerned(self) -> tuple[Scalar, ...]:
        """The rows that are looked at term by term: those with accelerations of the author's, others are 0."""
        mine = [x for x in self.case.system.symbols.a if depends_on(self.scalar, (x,))]
        if len(self.rows) < 2 or not mine:
            return self.rows
        return tuple(row if depends_on(row, mine) else 0 for row in self.rows)

    @property
    def _is_equation(self) -> bool:
        """True if the author may have multiplied it by any factor."""
        return self.what in ("motion", "constraints", "energy")

    @cached_property
    def is_long(self) -> bool:
        """True if it is too long to be looked at term by term."""
        return operations((self.scalar, *self.rows)).total > LONGEST

    def _structural(self) -> Iterator[Mistake]:
        """Possible mistakes in contributions."""
        speeds = [u.name.removesuffix("'") for u in self.case.system.symbols.u]
        start = self.case.start if self.what == "energy" else {}
        for each in self.case.mistakes(self.what, () if self.what == "Q" else self.of, start).all:
            if self.what != "Q":
                yield each
            elif self.of[0] in speeds:
                yield replace(each, rows=(each.rows[speeds.index(self.of[0])],))

    def _classes(self) -> Iterator[Mistake]:
        """The shares of a value that hold accelerations, speeds, or are there at rest."""
        symbols, (value,) = self.case.system.symbols, self.rows
        u, a = (tuple(x for x in some if depends_on(value, (x,))) for some in (symbols.u, symbols.a))
        classes = [("all that holds accelerations", a), ("all that holds speeds", u)]
        classes += [("all that is there in motion alone", (*u, *a))] if u and a else []
        classes += [(f"what {x.name} does", (x,)) for some in (u, a) if len(some) > 1 for x in some]
        for name, some in classes if u or a else ():
            with suppress(DerivationError):
                (left,) = substituted((value,), dict.fromkeys(some, 0))
                yield Mistake(name, "factor", (value - left,), SHARED + 2 * SHORTER)
                if len(some) == len(u) + len(a):
                    yield Mistake("all that is there at rest", "factor", (left,), SHARED + 2 * SHORTER)

    def _other_arguments(self) -> Iterator[Mistake]:
        """The same function of another point, body or constraint."""
        for call in other_calls(self.case, self.call) if self.call is not None else ():
            try:
                other = self.case.called(call)
            except ExpressionError:
                continue
            text = f"it is {call} that stands there, and {self.call} that is asked"
            yield Mistake(str(self.call), "wrong_point", (other - self.rows[0],), SHARED, open=False, text=text)

    @cached_property
    def extra(self) -> tuple[Mistake, ...]:
        """The author's own terms, each of which may be one too many."""
        if self.is_long:
            return ()
        own = self.scalar if self._is_equation else self.scalar + self.rows[0]
        known = set() if self._is_equation else set(terms_of(self.rows[0], self.case.system.scope.positive))
        found = []
        for term in terms_of(own, self.case.system.scope.positive):
            if term not in known:
                text = f"the term {term_text(term)} does not belong there"
                found.append(Mistake(text, "extra_term", (term,) * len(self.rows), EXTRA, open=False, text=text))
        return tuple(found)

    @cached_property
    def _samples(self) -> tuple[Samples, bool] | None:
        """States of the comparison, and whether they lie on constraints."""
        case = self.case
        constrained = (
            self.what != "constraints" and bool(case.closing) and not depends_on(self.scalar, case.system.symbols.lam)
        )
        flat = [self.scalar, *self.rows]
        found = samples_of(case.system, flat, on_constraints=constrained and self.what == "motion")
        return None if found is None else (found, constrained)

    @cached_property
    def searches(self) -> tuple[Search, ...]:
        """The comparison with every equation, and with the combination that the author's accelerations make."""
        if self._samples is None:
            return ()
        samples, constrained = self._samples
        known, n = self.mistakes, len(self.rows)
        scalars = self._moving([self.scalar, *self.rows, *(x for each in known for x in each.rows)])
        flat = samples.of(scalars)
        D, E, C = flat[0], flat[1 : n + 1], flat[n + 1 :].reshape(len(known), n, *flat.shape[1:])
        others = in_other_units(samples, self.case.edits.dimensions)
        if others is not None:
            fits = fitting(flat, others.of(scalars), n + 1, n)
            known, C = tuple(each for each, fit in zip(known, fits, strict=True) if fit), C[fits]
        if not self._is_equation:
            more = samples.of(self._moving([each.rows[0] for each in self.extra]))
            return (Search(None, -D, np.concatenate([C[:, 0], more]), (*known, *self.extra), 0, E[0]),)
        found = [] if constrained else [Search(D, E[k], C[:, k], known, k) for k in range(n)]
        if n > 1 and self.what == "motion":
            mixed = self._mixed(samples)
            if mixed is not None:
                whole = np.einsum("kpv,kpv->pv", mixed, E)
                found.append(Search(D, whole, np.einsum("kpv,ckpv->cpv", mixed, C), known, -1))
        elif constrained:
            found = [Search(D, E[0], C[:, 0], known, 0)]
        more = samples.of([each.rows[0] for each in self.extra])
        if len(more):
            for search in tuple(found):
                found.append(Search(search.E, D, -more, self.extra, search.row))
                for sign in (1, -1):
                    both, all_ = np.concatenate([search.C, sign * more]), (*search.mistakes, *self.extra)
                    found.append(Search(None, search.E - sign * D, both, all_, search.row, opposite=sign < 0))
        return tuple(found)

    def _moving(self, scalars: Sequence[Scalar]) -> Sequence[Scalar]:
        """The scalars; of potentials, which hold a free constant, their rates."""
        return self.case.system.scope.time_derivative(tuple(scalars)) if self.what == "V" else scalars

    def _mixed(self, samples: Samples) -> np.ndarray | None:
        """f with f M + h J = dD/da and f J^T = -dD/dlam: the combination whose accelerations are the author's."""
        e, case = self.case.parts.equations, self.case
        assert e is not None
        slopes = gradient(self.scalar, case.forced)
        if any(depends_on(x, case.forced) for x in slopes):
            return None
        n, k = len(e.M), len(e.J)
        flat = samples.of([*slopes, *(x for row in e.M for x in row), *(x for row in e.J for x in row)])
        flat = flat.reshape(len(flat), -1)
        found = []
        for values in flat.T:
            M = values[n + k : n + k + n * n].reshape(n, n)
            J = values[n + k + n * n :].reshape(k, n)
            matrix = np.block([[M, -J.T], [J, np.zeros((k, k))]]) if k else M
            if not np.all(np.isfinite(values)):
                return None
            f, *_ = np.linalg.lstsq(matrix.T, values[: n + k], rcond=None)
            found.append(f[:n])
        sizes = np.abs(np.array(found))
        if not k and np.all(np.sort(sizes, axis=1)[:, :-1] < tolerances.CARRIED * sizes.max(axis=1, keepdims=True)):
            return None  # it is one of the equations
        return np.array(found).T.reshape(n, samples.places, -1)

    def explained(self, number: int) -> list[Explanation]:
        """The explanations by so many mistakes."""
        return explained(self.searches, self.proves, number)

    def proves(self, explanation: Explanation) -> bool:
        """True if the model's equation with these mistakes is exactly the author's."""
        case = self.case
        if not self._is_consistent(explanation):
            return False
        extra = [share for share in explanation.shares if share.mistake.kind == "extra_term"]
        added = [share.added(case.system.scope.graph.pi) for share in explanation.shares if share not in extra]
        scalar = self.scalar - sum((share.mistake.rows[0] for share in extra), start=0)
        if self.what == "energy":
            return self._is_multiple(scalar, self.rows[0] + sum((x[0] for x in added), start=0))
        if not self._is_equation:
            total = sum((x[0] for x in added), start=0)
            return bool(is_zero_everywhere(case.system, *self._moving([scalar - total])).holds)
        rows = tuple(row + sum((x[k] for x in added), start=0) for k, row in enumerate(self.rows))
        if self.what == "constraints":
            moving = (*case.system.symbols.u, *case.system.symbols.a)
            row, *others = (linear_row(x, moving)[0] for x in (scalar, *rows))
            return bool(combination(case.system, row, others).holds)
        return bool(case.follows(scalar, rows).holds)

    def _is_consistent(self, explanation: Explanation) -> bool:
        """True if nothing is missing twice: a term of its own, or a part of a body's kinetic energy, and all of it.

        Nor has all of it a number for its factor beside another number of a part.
        """
        factors = [(x.mistake.name.startswith(WHOLE), x.factor) for x in explanation.shares if x.mistake.open]
        if any(whole and abs(x) != 1 for whole, x in factors) and any(x and not whole for whole, x in factors):
            return False
        gone = [share.mistake for share in explanation.shares if share.mistake.open and share.factor == 0]
        for part, whole in permutations(gone, 2):
            if part.rank >= PIECES and whole.name.removeprefix("the ") in part.name:
                return False
            if whole.rank < TERMS and PIECES <= part.rank:
                positive = self.case.system.scope.positive
                held = [x for row in whole.rows for x in terms_of(row, positive)]
                if any(x in held for row in part.rows for x in terms_of(row, positive)):
                    return False
        return True

    def _is_multiple(self, scalar: Scalar, energy: Scalar) -> bool:
        """True if an energy is the scalar times a function of the configuration, as their squares of speeds are."""
        system = self.case.system
        for u in system.symbols.u:
            mine, own = (derivative(derivative(x, u), u) for x in (scalar, energy))
            if not is_zero(mine):
                return bool(is_zero_everywhere(system, energy * mine - scalar * own).holds)
        return False

    def difference(self, explanation: Explanation) -> str:
        """The excess in the equation, as it stands in the model's own."""
        added = [share.added(self.case.system.scope.graph.pi) for share in explanation.shares]
        rows = [sum(column, start=0) for column in zip(*added, strict=True)]
        row = rows[explanation.row] if explanation.row >= 0 else next((x for x in rows if not is_zero(x)), 0)
        return excess(self.case, row)

    def unexplained(self) -> tuple[str, str]:
        """(the difference, beside which equation), where nothing explains it."""
        case = self.case
        if self.is_long:
            return "", ""
        if self.what != "motion":
            return excess(case, self.scalar), ""
        best = min(self.searches, key=lambda search: search.misfit, default=None)
        if best is not None and best.row < 0:
            return excess(case, case.phase.eliminated(self.scalar)), ""
        a = None if best is None else case.leading(self.rows[best.row])
        if best is None or a is None or is_zero_everywhere(case.system, derivative(self.scalar, a)).holds:
            return excess(case, self.scalar), ""
        row, name = self.rows[best.row], case.system.symbols.u[best.row].name.removesuffix("'")
        factor = over(derivative(self.scalar, a), derivative(row, a))
        return excess(case, self.scalar - factor * row), f", beside the equation of {name}"


def changed_answers(case: Case, answer: ScalarRow) -> Iterator[Mistake]:
    """Mistakes in an answer as it is written: one node changed, all of it inverted or without its root."""
    answer = case.edits.written(answer)
    for each in case.edits.of_answer(answer):
        by = tuple(x - y for x, y in zip(each.to, answer, strict=True))
        yield Mistake(each.text, each.kind, by, each.rank, open=False, text=f"in the answer {each.text}")


def linearized(rows: ScalarRow, place: Mapping[Node, Scalar]) -> ScalarRow:
    """Rows to the first order beside a place.

    Raises:
        DerivationError: one has no value there.
    """
    moving = tuple(place)
    slopes = [gradient(row, moving) for row in rows]
    flat = substituted((*rows, *(slope for row in slopes for slope in row)), place)
    n, steps = len(moving), [x - place[x] for x in moving]
    return tuple(
        sum((s * dx for s, dx in zip(flat[k : k + n], steps, strict=True)), start=still)
        for still, k in zip(flat[: len(rows)], range(len(rows), len(flat), n), strict=True)
    )


def place_of(case: Case, about: str | None) -> Mapping[Node, Scalar] | None:
    """The place that equations name, "theta = 0, x = l"; None: none is named.

    Raises:
        UsageError: it names no coordinate.
    """
    if about is None:
        return None
    named, found = {q.name: q for q in case.system.symbols.q}, dict[Node, Scalar]()
    for each in about.split(","):
        name, sign, value = (part.strip() for part in each.partition("="))
        if name not in named or not sign:
            known = ", ".join(f"{q} = 0" for q in named)
            raise UsageError(f"about '{each.strip()}': no coordinate is named", fix=f"write {known}")
        try:
            found[named[name]] = case.value(parse(value))
        except ExpressionError as error:
            raise UsageError(f"about '{each.strip()}': {error.what}", fix=error.fix) from error
    return found


def first_order_place(
    case: Case, scalar: Scalar, about: Mapping[Node, Scalar] | None = None
) -> Mapping[Node, Scalar] | None:
    """The place beside which an equation is right to the first order; None: beside none, or it approximates nothing.

    Only what is linear there, or holds no sine and cosine where the model has some, was meant as an approximation.
    Accelerations are small beside an equilibrium alone: elsewhere their products with a coordinate are of first order.

    Args:
        about: the place that is meant, in part: the rest of an equilibrium there, else 0; None: 0, or an equilibrium.
    """
    symbols, rows = case.system.symbols, (*case.rows, *case.closing)
    moving = (*symbols.x, *symbols.a)
    if not case.rows or not depends_on(scalar, symbols.a):
        return None
    of_speeds = not is_linear((scalar,), symbols.u)  # who keeps their products approximates nothing
    plain = is_linear((scalar,), moving) or (_bent(rows, moving) and not _bent((scalar,), moving) and not of_speeds)
    if not plain or is_linear(rows, moving):
        return None
    for place in _places(case, about):
        beside = {**dict.fromkeys((*moving, *symbols.lam), 0), **place}
        with suppress(DerivationError):
            at_rest = all(is_zero_everywhere(case.system, x).holds for x in substituted(rows, beside))
            rests = not at_rest or all(is_zero(x) for x in substituted((scalar,), beside)) or about is not None
            if not rests or _has_a_corner((*rows, scalar), moving, beside):
                continue  # at a corner the slopes differ from side to side: there is no first order
            if at_rest and _follows_beside(case, scalar, beside):
                return {q: beside[q] for q in symbols.q}
            if not at_rest and not case.closing and _follows_elsewhere(case, scalar, beside):
                return {q: beside[q] for q in symbols.q}
    return None


def _follows_beside(case: Case, scalar: Scalar, place: Mapping[Node, Scalar]) -> bool:
    """True if a scalar follows to the first order beside an equilibrium, displacements along the constraints."""
    constraints = case.system.constraints.rows
    held = [x for row in constraints for x in (row.gap, row.velocity) if x is not None]
    near, *rows = linearized((scalar, *case.rows, *case.closing, *held), place)
    own, *others = (linear_row(x, tuple(place))[0] for x in (near, *rows))
    return depends_on(near, case.system.symbols.a) and combination(case.system, own, others).holds is True


def _follows_elsewhere(case: Case, scalar: Scalar, place: Mapping[Node, Scalar]) -> bool:
    """True if a scalar follows to the first order in coordinates and speeds, beside a place that is no equilibrium."""
    still = {x: place[x] for x in case.system.symbols.x}
    (near,) = linearized((scalar,), still)
    return depends_on(near, case.system.symbols.a) and case.follows(near, linearized(case.rows, still)).holds is True


def _places(case: Case, about: Mapping[Node, Scalar] | None) -> Iterator[Mapping[Node, Scalar]]:
    """The places beside which somebody may have looked; of a place that is named in part, with equilibria there."""
    at_rest = zip(case.places_of_rest, case.multipliers_at_rest, strict=True)
    if about is not None:
        yield from ({**q, **lam} for q, lam in at_rest if all(is_zero(q[x] - value) for x, value in about.items()))
        yield about
    else:
        yield {}
        yield from ({**q, **lam} for q, lam in at_rest)


def is_linear(rows: ScalarRow, moving: tuple[Node, ...]) -> bool:
    """True if rows are linear in what moves."""
    return not any(depends_on(slope, moving) for row in rows for slope in gradient(row, moving))


def _bent(rows: ScalarRow, moving: tuple[Node, ...]) -> bool:
    """True if a function of an angle that moves stands in rows."""
    return any(x.op in ("sin", "cos", "tan") and depends_on(x, moving) for x in order(rows))


def _has_a_corner(rows: ScalarRow, moving: tuple[Node, ...], place: Mapping[Node, Scalar]) -> bool:
    """True if a function of what moves has a corner or a jump at a place: |x|, max(0, x) and the like at x = 0."""
    turning = [x for x in order(rows) if x.op in _TURNING and depends_on(x, moving)]
    return any(is_zero(x) for x in substituted([x.args[0] - sum(x.args[1:]) for x in turning], place))


def _linearized(known: Iterable[Mistake], place: Mapping[Node, Scalar]) -> Iterator[Mistake]:
    known = tuple(known)
    try:  # what they share is looked at once
        flat = iter(linearized(tuple(x for each in known for x in each.rows), place))
    except DerivationError:  # one of them has no value there
        flat = None
    for each in known:
        with suppress(DerivationError):
            yield replace(
                each, rows=linearized(each.rows, place) if flat is None else tuple(islice(flat, len(each.rows)))
            )


def excess(case: Case, scalar: Scalar) -> str:
    """A difference as a text; "" where nobody would read it, and of what vanishes everywhere: that is no difference."""
    text = short_text(scalar, case.system.scope.positive)
    return "" if text and is_zero_everywhere(case.system, scalar).holds else text


def remainder(case: Case, scalar: Scalar) -> str:
    """The left side minus the right side along the motion, with accelerations or without, whichever is shorter."""
    texts = [excess(case, scalar)]
    with suppress(DerivationError, ModelError):
        texts += [excess(case, case.phase.simple(case.phase.eliminated(scalar)))] if texts[0] else []
    return min(filter(None, texts), key=len, default="")
