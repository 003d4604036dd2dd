"""Rows of equations -> what may be wrong with single terms of them, multiplied out: what goes wrong after deriving."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.judge.diagnosis import EXCHANGED, ODD, TERMS, Mistake
from eomgen.judge.terms import Edits, angles_in, is_product, term_text, terms_of, turned_angles, wrong_parameters
from eomgen.symbolic.expression import Node, Scalar, depends_on, substituted, symbols_of

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
