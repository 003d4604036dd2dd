"""Small motions -> what is asked of them: frequencies in their order, exact where they are known so, and entries."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from random import Random

from eomgen.errors import DerivationError
from eomgen.mechanics.initial_state.values_at_rest import values_of_parameters
from eomgen.mechanics.small_motions.conditions import Conditions, stability_conditions
from eomgen.mechanics.small_motions.field import MatrixEntry
from eomgen.mechanics.small_motions.linearization import SmallMotions, motions_beside
from eomgen.mechanics.small_motions.polynomial import (
    Polynomial,
    characteristic_polynomial,
    closed_frequencies,
    laplace_variable,
)
from eomgen.mechanics.small_motions.spectrum import Mode, Spectrum, spectrum_of
from eomgen.mechanics.small_motions.transfer import TransferFunction, transfer_functions, transfers_in_numbers
from eomgen.records import dataclass
from eomgen.symbolic.exact.book_form import book_form
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size

TRIES = 12  # values of the parameters at which the order of frequencies is looked at
LONGEST = 6_000  # characters of a polynomial whose roots are written
MOST_WRITTEN = 8  # speeds of matrices whose entries are written as a book does
MOST_STATES = 8  # of transfer functions in floats
MATRICES = {"mass": "M", "damping": "C", "stiffness": "K"}


@dataclass(frozen=True)
class Frequency:
    """One frequency: the mode in numbers, and in closed form where it has one."""

    mode: Mode
    exact: Scalar | None


@dataclass(frozen=True)
class Modes:
    """What follows from the equations of small motions.

    Args:
        small: the equations.
        in_full: whether a polynomial and conditions that are too long to be printed are brought into their shortest
            form all the same, as machines get them; else they stay as they came.
    """

    small: SmallMotions
    in_full: bool = True

    @property
    def positive(self) -> frozenset[Node]:
        return self.small.reference.system.scope.positive

    @cached_property
    def spectrum(self) -> Spectrum:
        return spectrum_of(self.small, self.polynomial)

    @cached_property
    def polynomial(self) -> Polynomial | None:
        """det(s^2 M + s C + K); None where it is not written exactly."""
        exact = self.small.exact
        return None if exact is None else characteristic_polynomial(exact, self.positive, in_full=self.in_full)

    @cached_property
    def beside(self) -> tuple[str, ...]:
        """The stability of each steady motion with the same values held, this one first; "" where it is not known."""
        family = self.small.reference.family
        if family is None or not family.others:
            return ()
        others = [Modes(x).spectrum.stability if x is not None else "" for x in motions_beside(self.small)]
        return (self.spectrum.stability, *others)

    @cached_property
    def conditions(self) -> Conditions:
        """Routh and Hurwitz: what must be positive."""
        if self.polynomial is None or self.small.exact is None:
            return Conditions()
        return stability_conditions(
            self.polynomial,
            laplace_variable(self.small.exact),
            self.positive,
            self.small.reference.trial,
            conservative=self.is_conservative,
            in_full=self.in_full,
        )

    @cached_property
    def is_conservative(self) -> bool:
        """Whether there is nothing but M and a symmetric K, known exactly."""
        e = self.small.exact
        if e is None or not self.small.is_second_order or not all(is_zero(x) for row in e.C for x in row):
            return False
        return all(is_zero(self.tidy(e.K[i][j] - e.K[j][i])) for i in range(len(e.K)) for j in range(i))

    @cached_property
    def transfers(self) -> tuple[TransferFunction, ...]:
        """From inputs to coordinates: exact where that can be, else in floats, of systems of few states."""
        exact, small = self.small.exact, self.small
        found = () if exact is None else transfer_functions(exact, self.positive, small.reference.trial)
        if found or not small.numbers.inputs or not small.reference.valued or len(small.state_matrix) > MOST_STATES:
            return found
        return transfers_in_numbers(small.numbers, small.state_matrix, small.input_matrix)

    @cached_property
    def frequencies(self) -> tuple[Frequency, ...]:
        """The frequencies of the oscillating modes, the lowest first."""
        candidates = self.closed
        if not self.small.reference.valued and not self._ordered(candidates):
            raise DerivationError(
                "which motion is slower, and whether it oscillates, depends on the parameters",
                "parameters",
                "give them values",
            )
        return tuple(Frequency(mode, self._exact(mode, candidates)) for mode in self.spectrum.oscillating)

    @cached_property
    def closed(self) -> list[tuple[float, Scalar]]:
        """(number at the parameters, exact frequency)"""
        if self.polynomial is None or self.small.exact is None:
            return []
        if sum(map(text_size, self.polynomial.coefficients)) > LONGEST:
            return []
        exact = closed_frequencies(self.polynomial, laplace_variable(self.small.exact), self.positive)
        found = []
        for w in exact:
            try:
                found.append((float(evaluate((w,), self.small.reference.trial, fifty_digits())[0]), w))
            except (NoValue, ZeroDivisionError, TypeError):  # it does not oscillate
                continue
        return found

    def _ordered(self, candidates: list[tuple[float, Scalar]]) -> bool:
        """Whether the frequencies are real and in the same order at all values that are tried for the parameters."""
        modes = self.spectrum.oscillating
        inner = [w for mode in modes if (w := self._exact(mode, candidates)) is not None]
        reference, rng = self.small.reference, Random(5)
        if len(inner) < len(modes):
            return False
        known = values_of_parameters(reference.system.scope, None)
        for _ in range(TRIES):
            tried = {x: known.get(x, fifty_digits().number(Fraction(rng.randint(2, 80), 20))) for x in reference.trial}
            try:
                values = evaluate(inner, tried, fifty_digits())
            except (NoValue, ZeroDivisionError):
                return False
            if any(b < a for a, b in pairwise(values)):
                return False
        return True

    def _exact(self, mode: Mode, candidates: list[tuple[float, Scalar]]) -> Scalar | None:
        assert mode.frequency is not None
        if mode.frequency == 0:
            return 0
        near = [w for value, w in candidates if abs(value - mode.frequency) <= COMPUTED * mode.frequency]
        return near[0] if near else None

    # -- by name -----------------------------------------------------------------------------------------------

    def entry(self, function: str, *names: str) -> tuple[MatrixEntry, bool]:
        """(an entry of M, C or K, whether it is exact).

        Raises:
            DerivationError: a coordinate that is none of the linearized system.
        """
        equations = self.small.exact or self.small.numbers
        row, column = self.place(function, *names)
        return getattr(equations, MATRICES[function])[row][column], self.small.exact is not None

    def place(self, function: str, *names: str) -> tuple[int, int]:
        """The row and column of an entry of M, C or K.

        Raises:
            DerivationError: a coordinate that is none of the linearized system.
        """
        equations = self.small.exact or self.small.numbers
        rows = {u.name.removesuffix("'"): k for k, u in enumerate(equations.speeds)}
        if self.small.is_second_order:
            rows |= {q.name: k for k, q in enumerate(equations.coordinates)}
        columns = rows if function != "stiffness" else {q.name: k for k, q in enumerate(equations.coordinates)}
        for name, known in zip(names, (rows, columns), strict=True):
            if name not in known:
                what = f"{function}({', '.join(names)}): '{name}' is no coordinate of the linearized system"
                raise DerivationError(what, mend=f"one of {', '.join(known)}")
        return rows[names[0]], columns[names[1]]

    def frequency(self, k: int) -> Frequency:
        """The k-th frequency, from 1.

        Raises:
            DerivationError: there are not so many.
        """
        found = self.frequencies
        if not 1 <= k <= len(found):
            n = len(found)
            have = "one small motion oscillates" if n == 1 else f"{n or 'no'} small motions oscillate"
            raise DerivationError(f"frequency({k}): {have}", mend="ask for one of those")
        return found[k - 1]

    @property
    def symmetric_parts(self) -> dict[str, list[list[MatrixEntry]]]:
        """D and G of C = D + G, and the symmetric and circulatory part of K = S + H."""
        equations = self.small.exact or self.small.numbers
        return {
            name: part
            for letter, names in (("C", "DG"), ("K", "SH"))
            for name, part in zip(names, _parted(getattr(equations, letter)), strict=True)
        }

    def tidy(self, x: MatrixEntry) -> MatrixEntry:
        """An entry in its shortest form."""
        return x if isinstance(x, float) else simplest(x, Work.VALUE, self.positive)

    def written(self, x: MatrixEntry) -> MatrixEntry:
        """An entry as it is printed, as formulas of a book are; of many speeds as it is."""
        if isinstance(x, float) or len(self.small.numbers.speeds) > MOST_WRITTEN:
            return x
        if x not in self._forms:
            self._forms[x] = book_form(x, Work.ENTRY, self.positive)
        return self._forms[x]

    @cached_property
    def _forms(self) -> dict[Scalar, Scalar]:
        return {}


def _parted(A: list[list[MatrixEntry]]) -> tuple[list[list[MatrixEntry]], list[list[MatrixEntry]]]:
    """(A + A^T)/2 and (A - A^T)/2."""
    half = 0.5 if any(isinstance(x, float) for row in A for x in row) else Fraction(1, 2)
    n = range(len(A))
    return ([[half * (A[i][j] + A[j][i]) for j in n] for i in n], [[half * (A[i][j] - A[j][i]) for j in n] for i in n])
