"""Contributions -> what people make of them by mistake: each a change of the equations that can be named.

A whole contribution (a body's rotation, a weight, a spring) with a wrong factor, several together, or terms of its
derivatives; with one place of it changed, before it is derived (`edits`) or in its terms (`wrong_terms`). What an
equation differs by is then sought among them (`diagnosis`): the lists hold no equation, only what may go wrong.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from itertools import combinations

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.judge.diagnosis import PIECES, PLAIN, SHARED, SHORTER, Mistake
from eomgen.judge.terms import Edits, Term, WrongTerms, terms_of
from eomgen.mechanics.dynamics import Contribution, Contributions
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    depends_on,
    gradient,
    is_zero,
    substituted,
    symbols_of,
)

MOST = 3000  # mistakes of one equation
MOST_SPEEDS = 12  # of a model whose products of speeds are looked at one by one
GROUPS = ("all rotations", "the whole potential energy", "all that is applied")  # whose members are stated
MOST_REPORTED = 3  # members of a group that are stated
MOST_NODES = 100_000  # of expressions that are made for them


@dataclass(frozen=True)
class Mistakes:
    """Possible mistakes in equations, energies or forces of a system.

    Args:
        parts: the contributions.
        what: "motion": the equations of motion; "T", "V", "energy": T + V; "Q": the generalized forces.
        of: only of these bodies or forces; () of all.
        start: q and u there: of an energy what it has changed by since.
    """

    parts: Contributions
    what: str
    of: tuple[str, ...] = ()
    start: Mapping[Node, Scalar] = field(default_factory=dict)

    @property
    def _edits(self) -> Edits:
        return Edits.of_system(self.parts.system)

    def rows(self, part: Contribution) -> ScalarRow:
        """The share of a contribution in the requested quantity."""
        operator = self.parts.operator
        if self.what == "T":
            return (operator.energy(part.T),)
        if self.what == "V":
            return (part.V,)
        if self.what == "energy":
            energy = operator.energy(part.T) + part.V
            return (energy - substituted((energy,), self.start)[0] if self.start else energy,)
        if self.what == "Q":
            return tuple(-x for x in operator.rows(replace(part, T=0)))
        return operator.rows(part)

    @cached_property
    def all(self) -> tuple[Mistake, ...]:
        """All of them that change something, the most believable first."""
        found: list[Mistake] = []
        graph = self.parts.system.scope.graph
        most = len(graph) + MOST_NODES
        for each in self._sought():
            if not all(map(is_zero, each.rows)):
                found.append(each)
            if len(found) >= MOST or len(graph) > most:
                break
        return tuple(sorted(found, key=lambda each: each.rank))

    @cached_property
    def whole(self) -> tuple[Contribution, ...]:
        """The contributions that matter here."""
        known = (part for part in self.parts.elementary if self.what != "V" or part.kind != "constant")
        mine = (part for part in known if not self.of or {part.body, part.force} & {*self.of})
        return tuple(part for part in mine if not all(map(is_zero, self.rows(part))))

    def _sought(self) -> Iterator[Mistake]:
        alike: dict[tuple[str, ScalarRow], list[Contribution]] = {}
        for part in self.whole:
            alike.setdefault((part.kind, self._edits.written(self.rows(part))), []).append(part)
        for members in alike.values():
            for part in members:  # of several that do the same all are rather wrong than one
                rank, squares = 2 * SHORTER if len(members) > 1 else PLAIN, not is_zero(part.T)
                yield Mistake(part.name, "factor", self.rows(part), rank, part.body, part.force, squares=squares)
            if len(members) > 1:
                name, squares = " and ".join(part.name for part in members), not is_zero(members[0].T)
                yield Mistake(name, "factor", self._sum(members), SHORTER, squares=squares)
        yield from self._together()
        if self.what == "motion":
            yield from self._pieces()
        if self.what in ("motion", "T", "energy"):
            yield from self._products()
        for part in self.whole if self.what != "energy" else ():
            yield from self._wrong_terms(part).in_rows(self.rows(part))
        for part in self.whole:
            yield from self._edited(part)

    # -- a formula with a mistake in it --------------------------------------------------------------

    @cached_property
    def terms(self) -> frozenset[Term]:
        """(row, term) of every contribution, multiplied out."""
        if self.what == "energy":
            return frozenset()  # what it has changed by since the start is no sum of terms changed one by one
        positive = frozenset(self._edits.positive)
        return frozenset(
            (k, term)
            for part in self.whole
            for k, row in enumerate(self.rows(part))
            for term in terms_of(row, positive)
        )

    def _wrong_terms(self, part: Contribution) -> WrongTerms:
        symbols = self.parts.system.symbols
        parameters, rates = tuple(symbols.parameters.values()), (*symbols.u, *symbols.a)
        return WrongTerms(self._edits, parameters, rates, part.name, part.body, part.force)

    def _edited(self, part: Contribution) -> Iterator[Mistake]:
        """A contribution with one place of its energy or its forces changed, carried through the derivation."""
        edits = self._edits
        forms: list[tuple[ScalarRow, Callable[[ScalarRow], Contribution]]] = [
            ((part.T,), lambda x: replace(part, T=x[0], V=0, Q=(), row=None)),
            ((part.V,), lambda x: replace(part, T=0, V=x[0], Q=(), row=None)),
            (part.Q, lambda x: replace(part, T=0, V=0, Q=x, row=None)),
            (part.row or (), lambda x: replace(part, row=x)),
        ]
        for formulas, changed in forms:
            for each in edits.of(formulas):
                by = tuple(x - y for x, y in zip(each.to, formulas, strict=True))
                text = f"in {part.name} {each.text}"
                with suppress(DerivationError):  # it has no value at the start
                    rows = self.rows(changed(by))
                    yield Mistake(part.name, each.kind, rows, each.rank, part.body, part.force, False, text)

    # -- contributions together --------------------------------------------------------------------

    def _together(self) -> Iterator[Mistake]:
        groups: dict[tuple[str, str, str], list[Contribution]] = {}
        for part in self.whole:
            kinetic = not is_zero(part.T)
            if kinetic:
                groups.setdefault((f"the kinetic energy of {part.body}", part.body, ""), []).append(part)
                groups.setdefault(("the whole kinetic energy", "", ""), []).append(part)
            elif part.force:
                groups.setdefault((f"the force {part.force}", "", part.force), []).append(part)
            if not kinetic and not is_zero(part.V):
                groups.setdefault(("the whole potential energy", "", ""), []).append(part)
            if not kinetic:
                groups.setdefault(("all that is applied", "", ""), []).append(part)
            if part.kind == "rotation":
                groups.setdefault(("all rotations", "", ""), []).append(part)
            if part.body:
                groups.setdefault((f"all that belongs to {part.body}", part.body, ""), []).append(part)
        seen: set[tuple[str, ...]] = set()
        for (name, body, force), members in groups.items():
            key = tuple(part.name for part in members)
            if len(members) > 1 and key not in seen:
                seen.add(key)
                whose = ", ".join(part.body if part.kind == "rotation" else part.name for part in members)
                reported = f"{name} ({whose})" if name in GROUPS and len(members) <= MOST_REPORTED else name
                squares = all(not is_zero(part.T) for part in members)
                rows = self._sum(members)
                yield Mistake(reported, "factor", rows, SHARED, body, force, squares=squares)

    def _sum(self, members: Sequence[Contribution]) -> ScalarRow:
        rows = [self.rows(part) for part in members]
        return tuple(sum(column, start=0) for column in zip(*rows, strict=True))

    # -- terms of the derivatives --------------------------------------------------------------------

    @property
    def _kinetic(self) -> tuple[Contribution, ...]:
        return tuple(part for part in self.whole if not is_zero(part.T))

    def _pieces(self) -> Iterator[Mistake]:
        """Accelerations, products of speeds and dT/dq of every kinetic energy."""
        operator, u, a = self.parts.operator, self.parts.system.symbols.u, self.parts.system.symbols.a
        sums = [(part, part.T) for part in self._kinetic]
        if len(sums) > 1:
            whole = Contribution("the whole kinetic energy", T=sum((part.T for part in self._kinetic), start=0))
            sums.append((whole, whole.T))
        for part, T in sums:
            accelerated, carried, held = operator.inertia(T)
            of = part.name.removeprefix("the ")
            moving = [x + y for x, y in zip(carried, held, strict=True)]
            slopes = [gradient(value, a) for value in accelerated]
            for k, x in enumerate(a):
                row = tuple(each[k] * x for each in slopes)
                name = f"the term with {x.name} of the {of}"
                yield Mistake(name, "factor", row, PIECES, part.body, squares=True)
            first = [gradient(value, u) for value in moving] if len(u) <= MOST_SPEEDS else []
            for i, j in [*combinations(range(len(u)), 2), *((k, k) for k in range(len(u)))] if first else ():
                row = tuple(
                    gradient(row[i], (u[j],))[0] * u[i] * u[j] * (1 if i != j else Fraction(1, 2)) for row in first
                )
                name = f"{u[i].name}*{u[j].name}" if i != j else f"{u[i].name}^2"
                kind = "coriolis" if i != j else "factor"
                title = f"the Coriolis term with {name}" if i != j else f"the term with {name}"
                yield Mistake(f"{title} of the {of}", kind, row, PIECES, part.body)
            mixed = len(u) > 1 and any(depends_on(x, (v,)) for row in first for x, v in zip(row, u, strict=True))
            kind = "coriolis" if mixed else "factor"
            yield Mistake(f"-dT/dq of the {of}", "factor", held, PIECES + SHORTER, part.body)
            name = f"what d/dt dT/dq' of the {of} holds beside accelerations"
            yield Mistake(name, kind, carried, PIECES + SHORTER, part.body)
            yield Mistake(f"all products of speeds in the {of}", kind, tuple(moving), PIECES + SHORTER, part.body)

    def _products(self) -> Iterator[Mistake]:
        """The product of two speeds in a kinetic energy, which is lost where only their squares are added."""
        for part in self._kinetic:
            held = symbols_of((part.T,))
            moving = [u for u in self.parts.operator.base.symbols.u if u in held]
            for u, w in combinations(moving, 2) if len(moving) <= MOST_SPEEDS else ():
                mixed = gradient(gradient(part.T, (u,))[0], (w,))[0] * u * w
                name = f"the product {u.name}*{w.name} in the square of the velocity of {part.body}"
                row = self.rows(replace(part, T=mixed, V=0, Q=(), row=None))
                yield Mistake(name, "factor", row, SHARED, part.body)
