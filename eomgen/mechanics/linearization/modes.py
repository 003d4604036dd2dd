"""Small motions -> eigenvalues, frequencies, damping ratios, shapes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.equilibrium import Equilibria, Equilibrium
from eomgen.mechanics.linearization.linearization import SmallMotions, about_places, motions_beside
from eomgen.mechanics.linearization.reduction import LinearEquations, floats
from eomgen.mechanics.linearization.responses import (
    StateMatrices,
    TransferFunction,
    transfer_functions,
    transfers_in_numbers,
)
from eomgen.mechanics.state import Entries, Numbers
from eomgen.symbolic.exact import Conditions, Polynomial, book_form, simplest
from eomgen.symbolic.expression import Fraction, Node, Scalar, is_zero
from eomgen.symbolic.numeric import (
    NoValue,
    Work,
    dense,
    eigenpairs_in_digits,
    evaluate,
    fifty_digits,
    floats_of,
    tolerances,
)
from eomgen.symbolic.print import text_size

# -------- modes -----------------------------------------------------------------------------------------------
# Small motions -> what is requested of them: frequencies in their order, exact where they are known so, and entries.


TRIES = 12  # values of the parameters at which the order of frequencies is looked at
LONGEST = 6_000  # characters of a polynomial whose roots are written
MOST_STATES = 8  # of transfer functions in floats


@dataclass(frozen=True)
class Frequency:
    """One frequency: the mode in numbers, and in closed form where it has one."""

    mode: Mode
    exact: Scalar | None


@dataclass(frozen=True)
class Modes:
    """Eigenvalues, frequencies, shapes, transfer functions and stability that follow from small motions.

    Args:
        small: the equations.
        in_full: True if a polynomial and conditions too long to be printed are still brought into their shortest
            form, for machine-readable results; else they stay as they were derived.
    """

    MOST_WRITTEN = 8  # speeds of matrices whose entries are written as a book does

    small: SmallMotions
    in_full: bool = True

    @staticmethod
    def decided(found: Equilibria) -> Equilibria:
        """Equilibria whose stability the eigenvalues of full order decide, where states of first order move too."""
        if not found.statics.system.symbols.z:
            return found
        return replace(found, found=tuple(map(_of_place, found.found, about_places(found.found))))

    @property
    def positive(self) -> frozenset[Node]:
        return self.small.reference.system.scope.positive

    @cached_property
    def spectrum(self) -> Spectrum:
        return spectrum_of(self.small, self.polynomial)

    @property
    def participation(self) -> tuple[dict[str, float], ...]:
        """Shares of x = (q_i, u_i, z) in each mode, |V o V^-T|, their sum 1; () where modes have come to be one.

        Source: Perez-Arriaga, Verghese & Schweppe, IEEE Trans. PAS 101 (1982) 3117.
        """
        e, A = self.small.numbers, self.small.state_matrix
        values, V = np.linalg.eig(A)
        if np.linalg.cond(V / abs(V).max(axis=0)) > 1 / tolerances.SAME_PLACE:
            return ()
        shares = abs(V * np.linalg.inv(V).T)
        names, found = (*e.coordinates, *e.speeds), []
        for mode in self.spectrum.modes:
            own = shares[:, int(np.argmin(abs(values - mode.eigenvalue)))]
            found.append({names[k].name: float(own[k] / own.sum()) for k in e.order})
        return tuple(found)

    @cached_property
    def polynomial(self) -> Polynomial | None:
        """det(s^2 M + s C + K); None where it is not written exactly."""
        exact = self.small.exact
        return None if exact is None else exact.characteristic_polynomial(self.positive, in_full=self.in_full)

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
        """Stability conditions of Routh and Hurwitz."""
        if self.polynomial is None or self.small.exact is None:
            return Conditions()
        return self.polynomial.conditions(
            self.small.exact.laplace_variable,
            self.positive,
            self.small.reference.trial,
            conservative=self.is_conservative,
            in_full=self.in_full,
        )

    @property
    def is_conservative(self) -> bool:
        """True if the exact equations hold only M and a symmetric K; False too where they are not known exactly."""
        e = self.small.exact
        if e is None or not self.small.is_second_order or not all(is_zero(x) for row in e.C for x in row):
            return False
        return all(is_zero(self.tidy(e.K[i][j] - e.K[j][i])) for i in range(len(e.K)) for j in range(i))

    @cached_property
    def transfers(self) -> tuple[TransferFunction, ...]:
        """Transfer functions from inputs to coordinates: exact where possible, else in floats for few states."""
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
        exact = self.polynomial.frequencies(self.small.exact.laplace_variable, self.positive)
        found = []
        for w in exact:
            try:
                found.append((float(evaluate((w,), self.small.reference.trial, fifty_digits())[0]), w))
            except (NoValue, ZeroDivisionError, TypeError):  # it does not oscillate
                continue
        return found

    def _ordered(self, candidates: list[tuple[float, Scalar]]) -> bool:
        """True if the frequencies are real and in the same order at all values tried for the parameters."""
        modes = self.spectrum.oscillating
        inner = [w for mode in modes if (w := self._exact(mode, candidates)) is not None]
        reference, rng = self.small.reference, Random(5)
        if len(inner) < len(modes):
            return False
        known = reference.system.scope.values_of_parameters(None)
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
        near = [w for value, w in candidates if abs(value - mode.frequency) <= tolerances.COMPUTED * mode.frequency]
        return near[0] if near else None

    # -- by name -----------------------------------------------------------------------------------------------

    def entry(self, function: str, *names: str) -> tuple[Any, bool]:
        """(an entry of M, C or K, whether it is exact).

        Raises:
            DerivationError: a coordinate that is none of the linearized system.
        """
        equations = self.small.equations
        row, column = self.place(function, *names)
        return equations.matrix(function)[row][column], self.small.exact is not None

    def place(self, function: str, *names: str) -> tuple[int, int]:
        """The row and column of an entry of M, C or K.

        Raises:
            DerivationError: a coordinate that is none of the linearized system.
        """
        equations = self.small.equations
        rows = {u.name.removesuffix("'"): k for k, u in enumerate(equations.speeds)}
        if self.small.is_second_order:
            rows |= {q.name: k for k, q in enumerate(equations.coordinates)}
        columns = rows if function != "stiffness" else {q.name: k for k, q in enumerate(equations.coordinates)}
        for name, known in zip(names, (rows, columns), strict=True):
            if name not in known:
                what = f"{function}({', '.join(names)}): '{name}' is no coordinate of the linearized system"
                raise DerivationError(what, fix=f"one of {', '.join(known)}")
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
            raise DerivationError(f"frequency({k}): {have}", fix="ask for one of those")
        return found[k - 1]

    @property
    def symmetric_parts(self) -> dict[str, list[list[Any]]]:
        """D and G of C = D + G, and the symmetric and circulatory part of K = S + H."""
        equations = self.small.equations
        return {
            name: part
            for letter, names in (("C", "DG"), ("K", "SH"))
            for name, part in zip(names, _parted(getattr(equations, letter)), strict=True)
        }

    def state_spaces(self, outputs: Sequence[str]) -> tuple[StateMatrices | None, StateMatrices | None]:
        """(exact state space, in numbers), as far as they are known."""
        small = self.small
        exact = StateMatrices.exact(small, outputs)
        if not small.reference.valued:
            return exact, None
        A, B = small.state_matrix.tolist(), small.input_matrix.tolist()
        return exact, StateMatrices.of(small.numbers, A, B, outputs)

    def tidy(self, x: Any) -> Any:
        """An entry in its shortest form."""
        return x if isinstance(x, float) else simplest(x, Work.VALUE, self.positive)

    def written(self, x: Any) -> Any:
        """An entry as it is printed, as formulas of a book are; of many speeds as it is."""
        if isinstance(x, float) or len(self.small.numbers.speeds) > Modes.MOST_WRITTEN:
            return x
        if x not in self._forms:
            self._forms[x] = book_form(x, Work.ENTRY, self.positive)
        return self._forms[x]

    @cached_property
    def _forms(self) -> dict[Scalar, Scalar]:
        return {}


def _parted(A: list[list[Any]]) -> tuple[list[list[Any]], list[list[Any]]]:
    """(A + A^T)/2 and (A - A^T)/2."""
    half = 0.5 if any(isinstance(x, float) for row in A for x in row) else Fraction(1, 2)
    n = range(len(A))
    return ([[half * (A[i][j] + A[j][i]) for j in n] for i in n], [[half * (A[i][j] - A[j][i]) for j in n] for i in n])


# -------- spectrum --------------------------------------------------------------------------------------------
# Small motions -> their modes: eigenvalues, frequencies, damping ratios, shapes, and what they say of stability.
#
#     (lambda^2 M + lambda C + K) v = 0,  or  A x = lambda x,        lambda = -zeta w +- i w sqrt(1 - zeta^2)
#
# Systems without C and with symmetric K by the symmetric problem K v = w^2 M v, whose w^2 are real.


ALONG = 0.1  # of a displacement along a drift, after which the equations are compared


@dataclass(frozen=True)
class Mode:
    """One mode.

    Args:
        eigenvalue: lambda, of a pair the one with the positive imaginary part [1/s].
        pair: whether the conjugate, or with undamped systems the opposite value, belongs to it.
        shape: of each coordinate of the model, the largest 1; complex where they do not move in step.
    """

    eigenvalue: complex
    pair: bool
    shape: Mapping[Node, complex]

    @property
    def frequency(self) -> float | None:
        """Angular frequency of the oscillation, Im lambda [rad/s]; 0 of a rigid motion; None: it does not oscillate."""
        if self.eigenvalue.imag > 0:
            return self.eigenvalue.imag
        return 0.0 if self.eigenvalue == 0 and self.pair else None

    @property
    def hertz(self) -> float | None:
        return None if self.frequency is None else self.frequency / math.tau

    @property
    def damping_ratio(self) -> float | None:
        """zeta = -Re lambda/|lambda|; None of what does not oscillate."""
        return None if not self.frequency else -self.eigenvalue.real / abs(self.eigenvalue) + 0.0

    @property
    def kind(self) -> str:
        """Behaviour of the mode in words: it oscillates, fades, grows, or stays."""
        real = self.eigenvalue.real
        if self.eigenvalue == 0:
            return "stays as it is, or drifts"
        if self.frequency:
            return "oscillates" if real == 0 else "oscillates and fades" if real < 0 else "oscillates and grows"
        return "grows" if real > 0 else "fades"


@dataclass(frozen=True)
class Spectrum:
    """All modes: those that oscillate first, the slowest of them first.

    Args:
        modes: see there.
        eigenvalues: all of them.
        stability: "asymptotically stable", "stable", "stable to first order", "unstable to first order", "unstable" or
            "undecided".
        why: in words.
    """

    modes: tuple[Mode, ...]
    eigenvalues: tuple[complex, ...]
    stability: str
    why: str

    def __repr__(self) -> str:
        return f"<spectrum of {len(self.modes)} modes: {self.stability}>"

    @property
    def oscillating(self) -> tuple[Mode, ...]:
        """The modes that have a frequency, the slowest first."""
        return tuple(mode for mode in self.modes if mode.frequency is not None)


def spectrum_of(small: SmallMotions, polynomial: Polynomial | None = None) -> Spectrum:
    """The modes of small motions in numbers.

    Args:
        polynomial: p(s), where it is known exactly.
    """
    zeros = count_of_zeros(small.numbers, polynomial, small.reference.trial)
    modes = _undamped(small, zeros // 2) if _is_undamped(small) else _general(small, zeros)
    modes.sort(key=lambda mode: (mode.frequency is None, mode.frequency or 0.0, -mode.eigenvalue.real))
    values = [x for mode in modes for x in _all_values(mode)]
    return Spectrum(tuple(modes), tuple(values), *_stability(small, values, modes))


def _all_values(mode: Mode) -> tuple[complex, ...]:
    if not mode.pair:
        return (mode.eigenvalue,)
    return mode.eigenvalue, mode.eigenvalue.conjugate()


# -- undamped ------------------------------------------------------------------------------------------------


def _is_undamped(small: SmallMotions) -> bool:
    e = small.numbers
    if not small.is_second_order:
        return False
    M, C, K = (floats(x) for x in (e.M, e.C, e.K))
    size = abs(M).max() * np.sqrt(abs(K).max() / abs(M).max())
    return bool(abs(C).max() <= tolerances.SUMMED * size) and _is_symmetric(K, 1)


def _is_symmetric(A: np.ndarray, sign: int) -> bool:
    """True if A = sign A^T, each entry compared with the size of its own row and column, so that slow motions count."""
    rows = np.maximum(abs(A).max(axis=1), abs(A).max(axis=0))
    limit = tolerances.ITERATED * np.minimum.outer(rows, rows) + tolerances.ROUNDING * abs(A).max()
    return bool(np.all(abs(A - sign * A.T) <= limit))


def _undamped(small: SmallMotions, rigid: int) -> list[Mode]:
    """K v = w^2 M v."""
    squares, vectors = squares_of(floats(small.numbers.M), floats(small.numbers.K))
    still = np.argsort(abs(squares))[:rigid]
    zeros = [_shape(small, vectors[:, k].astype(complex), 0) for k in still for _ in range(2)]
    modes = []
    for k in np.setdiff1d(np.arange(len(squares)), still):
        square, v, rate = squares[k], vectors[:, k].astype(complex), math.sqrt(abs(squares[k]))
        values, pair = ([complex(0, rate)], True) if square > 0 else ([complex(rate, 0), complex(-rate, 0)], False)
        modes += [Mode(value, pair, _shape(small, v, value)) for value in values]
    return modes + _zero_modes(small, zeros)


# -- all others ------------------------------------------------------------------------------------------------


def _general(small: SmallMotions, still: int) -> list[Mode]:
    """The eigenvalues of the state matrix."""
    values, vectors = eigenpairs(small.state_matrix)
    order = np.argsort(abs(values))
    moving = vectors[: len(small.numbers.coordinates)]  # 0 where speeds alone change, as that of a boat that glides
    moving = np.where(abs(moving) > tolerances.RANK * abs(vectors).max(axis=0, initial=0), moving, 0)
    real = [moving[:, k].imag if values[k].imag < 0 else moving[:, k].real for k in order[:still]]  # drawn to a pair
    zeros = [_shape(small, x.astype(complex), 0) for x in real]
    values, vectors = merged(values[order[still:]]), vectors[:, order[still:]]
    modes = []
    for value, x in zip(_without_noise(small, values), vectors.T, strict=True):
        if value.imag >= 0:
            modes.append(Mode(value, value.imag > 0, _shape(small, x[: len(small.numbers.coordinates)], value)))
    return modes + _zero_modes(small, zeros)


def _without_noise(small: SmallMotions, values: np.ndarray) -> list[complex]:
    """Eigenvalues in which parts of the size of rounding errors are 0.

    Of undamped equations, whose eigenvalues have real parts of both signs or none, a coarser limit for the real parts.
    """
    e = small.numbers
    gyroscopic = small.is_second_order and _is_symmetric(floats(e.C), -1) and _is_symmetric(floats(e.K), 1)
    largest = abs(values).max(initial=0)
    turning = tolerances.COMPUTED * abs(values) + tolerances.SOLVED * largest
    real = np.full(len(values), tolerances.COMPUTED * largest) if gyroscopic else turning
    return [
        complex(0 if abs(x.real) <= fades else x.real, 0 if abs(x.imag) <= turns else x.imag)
        for x, fades, turns in zip(values, real, turning, strict=True)
    ]


def _zero_modes(small: SmallMotions, shapes: Sequence[Mapping[Node, complex]]) -> list[Mode]:
    """Modes of eigenvalue 0: at an equilibrium two zeros are one rigid motion; else each leads to neighbours."""
    pairs = len(shapes) // 2 if small.is_second_order and small.reference.about_equilibrium else 0
    rigid = [Mode(0j, True, shape) for shape in shapes[: 2 * pairs : 2]]
    return rigid + [Mode(0j, False, shape) for shape in shapes[2 * pairs :]]


def _shape(small: SmallMotions, v: np.ndarray, eigenvalue: complex) -> dict[Node, complex]:
    """The coordinates of the whole model in one mode, the largest 1; parts of the size of rounding are 0."""
    whole = floats(small.whole.P) @ _with_others(small, v, eigenvalue)
    largest = whole[np.argmax(abs(whole) * (1 - tolerances.COMPUTED * np.arange(len(whole))))] if len(whole) else 0
    whole = whole / largest if largest else whole

    def clean(x: complex) -> complex:
        return complex(
            0 if abs(x.real) < tolerances.ITERATED else x.real, 0 if abs(x.imag) < tolerances.ITERATED else x.imag
        )

    return {q: clean(x) for q, x in zip(small.whole.all, whole, strict=True)}


def _with_others(small: SmallMotions, v: np.ndarray, eigenvalue: complex) -> np.ndarray:
    """The independent coordinates of the whole system while those of v move in a mode.

    (A - lambda) x = 0 with the part v of x known: the others follow, as the track of a wheel does. With lambda = 0
    they are 0.
    """
    every, known = small.whole.coordinates, small.numbers.coordinates
    places = [every.index(q) for q in known]
    others = [k for k in range(len(every)) if k not in places]
    x = np.zeros(len(every) + len(small.whole.speeds), dtype=complex)
    x[places] = v
    if others and eigenvalue:
        A = small.whole.state_matrix - eigenvalue * np.eye(len(x))
        free = [k for k in range(len(x)) if k not in places]
        x[free] = np.linalg.lstsq(A[:, free], -A[:, places] @ v, rcond=None)[0]
    return x[: len(every)]


# -- stability --------------------------------------------------------------------------------------------------


def _stability(small: SmallMotions, values: Sequence[complex], modes: Sequence[Mode]) -> tuple[str, str]:
    growing = [x for x in values if x.real > 0]
    if any(x.imag for x in growing):
        return "unstable", "an oscillation grows (flutter)"
    if growing:
        return "unstable", "a motion grows without oscillation (divergence)"
    if all(x.real < 0 for x in values):
        return "asymptotically stable", "all motions fade"
    if defective(small.numbers, values):
        return "undecided", "two oscillations have come to be one: to first order they grow with the time"
    drift = drifting(small.numbers, sum(x == 0 for x in values))
    leads_on = drift is not None and _leads_on(small, drift)
    if drift is not None and (small.reference.about_equilibrium or not leads_on):
        others = "" if leads_on else "; terms of higher order may decide otherwise"
        return "unstable to first order", _grows_like_time(small, drift, values) + others
    if any(x == 0 for x in values) and not small.reference.about_equilibrium and small.reference.moving:
        return "stable to first order", "motions oscillate, fade, or go over into a steady motion nearby"
    if any(x == 0 for x in values):
        return "undecided", _drifting(modes)
    if _is_undamped(small) and small.reference.about_equilibrium:
        added = ", that of the centrifugal forces included," if small.reference.moving else ""
        return "stable", f"the potential energy{added} has a minimum (Lagrange and Dirichlet)"
    return "stable to first order", "all motions oscillate or fade; terms of higher order may decide otherwise"


def _of_place(place: Equilibrium, small: SmallMotions | DerivationError) -> Equilibrium:
    """An equilibrium with its stability by the eigenvalues of its small motions, where these do not leave it open."""
    if isinstance(small, DerivationError) or not small.reference.valued:
        return place
    own, found, q = place.stability, Modes(small).spectrum, small.reference.system.symbols.q
    like = f"like exp({max(x.real for x in found.eigenvalues):.6g} t)"
    grown, faded = f"{found.why}, {like}", f"all small motions fade, the slowest {like}"
    said = {"asymptotically stable": ("stable", faded), "unstable": ("unstable", grown)}
    kind, why = said.get(found.stability, (own.kind, f"{own.why.rpartition('; ')[0]}; {found.why}"))
    own = replace(own, kind=kind, why=why, along=tuple(x for x in small.numbers.coordinates if x in q))
    return replace(place, stability=own)


def _leads_on(small: SmallMotions, drift: np.ndarray) -> bool:
    """True if all equations are the same after a displacement along a drift: the drift leads to a steady motion."""
    shape = _shape(small, drift.astype(complex), 0)
    numbers = small.reference.numbers
    there = {q: numbers[q] + ALONG * x.real for q, x in shape.items()}
    try:
        beside = small.over(Numbers({**numbers, **there}))
    except (DerivationError, NoValue, ZeroDivisionError, np.linalg.LinAlgError):
        return False
    pairs = [(floats(getattr(small.numbers, name)), floats(getattr(beside, name))) for name in "MCKFE"]
    return all(A.shape == B.shape and np.all(abs(A - B) <= tolerances.COMPUTED * (1 + abs(A))) for A, B in pairs)


def _grows_like_time(small: SmallMotions, drift: np.ndarray, values: Sequence[complex]) -> str:
    """Sentence that says which coordinates grow like t: 0 is a defective eigenvalue (fewer modes than its order)."""
    shape = _shape(small, drift.astype(complex), 0)
    names = ", ".join(q.name for q, x in shape.items() if abs(x) > tolerances.SHARE) or "some speeds"
    others = "; all other motions oscillate or fade" if any(values) else ""
    return f"{names} grows like t, as the eigenvalue 0 has fewer modes than it counts for{others}"


def _drifting(modes: Sequence[Mode]) -> str:
    """Sentence that says which coordinates stay anywhere or drift to first order; higher-order terms decide on them."""
    moving = [
        q.name
        for q in (modes[0].shape if modes else ())
        if any(mode.eigenvalue == 0 and abs(mode.shape[q]) > tolerances.SHARE for mode in modes)
    ]
    names = ", ".join(moving) or "some speeds"
    others = "; all other motions oscillate or fade" if any(mode.eigenvalue for mode in modes) else ""
    return f"to first order {names} may stay anywhere, or drift{others}"


# -------- eigen -----------------------------------------------------------------------------------------------
# Matrices of small motions -> eigenvalues and eigenvectors in numbers, and how many eigenvalues are 0.
#
# A_0 x = lambda B_0 x,   A_0 = [F, E; -K, -C],   B_0 = [1, 0; 0, M]


MOST_BY_DIGITS = 30  # rows of a matrix whose eigenvalues are sought with more digits


def eigenpairs(A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(lambda, v) of A v = lambda v, the small ones as exact as the large ones."""
    values, vectors = np.linalg.eig(A)
    if not _is_wide(values):
        return values, vectors
    found, by_digits = eigenpairs_in_digits(A.tolist())
    return np.array(found), np.array(by_digits)


def squares_of(M: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(w^2, v) of K v = w^2 M v, both symmetric: A y = w^2 y of A = L^-1 K L^-T, M = L L^T, v = L^-T y."""
    M, K = (M + M.T) / 2, (K + K.T) / 2
    lower = np.linalg.cholesky(M)
    A = np.linalg.solve(lower, np.linalg.solve(lower, K).T)
    squares, vectors = np.linalg.eigh((A + A.T) / 2)
    if not _is_wide(squares):
        return squares, np.linalg.solve(lower.T, vectors)
    found, by_digits = eigenpairs_in_digits(K.tolist(), M.tolist())
    V = np.array([floats_of(row) for row in by_digits])
    return np.array(floats_of(found)), V / abs(V).max(axis=0)


def _is_wide(values: np.ndarray) -> bool:
    sizes = abs(values)
    return 1 < len(values) <= MOST_BY_DIGITS and sizes.min() < tolerances.WIDE_SPECTRUM * sizes.max()


# -- zeros ---------------------------------------------------------------------------------------------------------


def count_of_zeros(e: LinearEquations, polynomial: Polynomial | None, trial: Mapping[Node, Any]) -> int:
    """Number of eigenvalues that are 0.

    Args:
        polynomial: p(s), where it is known exactly.
        trial: values of the parameters, with 50 digits.
    """
    found = None if polynomial is None else _of_polynomial(e, polynomial, trial)
    return _by_rank(*_pencil(e)) if found is None else found


def _of_polynomial(e: LinearEquations, polynomial: Polynomial, trial: Mapping[Node, Any]) -> int | None:
    """The power of s that p(s) holds as a factor; None where nothing but 0 is left, in which no size can be seen."""
    A, B = _pencil(e)
    largest = abs(np.linalg.eigvals(np.linalg.solve(B, A))).max(initial=0)
    if not largest:
        return None
    unit = fifty_digits().number(float(largest))
    sizes = [abs(c) * unit**k for k, c in enumerate(evaluate(polynomial.coefficients, trial, fifty_digits()))]
    return next((k for k, x in enumerate(sizes) if x > tolerances.COEFFICIENT_AT_50 * sizes[-1]), None)


def _pencil(e: LinearEquations) -> tuple[np.ndarray, np.ndarray]:
    """(A_0, B_0)"""
    n, m = len(e.coordinates), len(e.speeds)
    M = floats(e.M)  # a light mass counts too
    C, K = (_without_rounding(x, m) for x in (e.C, e.K))
    F, E = (_without_rounding(x, n) for x in (e.F, e.E))
    return np.block([[F, E], [-K, -C]]), np.block([[np.eye(n), np.zeros((n, m))], [np.zeros((m, n)), M]])


def _without_rounding(A: Entries, rows: int) -> np.ndarray:
    found = floats(A) if rows else np.zeros((0, 0))
    return dense.without_noise(found, tolerances.ROUNDING)


def _by_rank(A: np.ndarray, B: np.ndarray) -> int:
    """The number of chains A x_1 = 0, A x_2 = B x_1, ... that are independent."""
    n, found = len(A), 0
    for k in range(1, n + 1):
        chain = np.kron(np.eye(k), A) - np.kron(np.eye(k, k=1), B)
        missing = k * n - dense.rank(chain, smallest=tolerances.RANK)
        if missing <= found:
            break
        found = missing
    return found


# -- eigenvalues that are one --------------------------------------------------------------------------------------


def merged(values: np.ndarray) -> np.ndarray:
    """The eigenvalues, those that rounding has drawn apart from one place of the imaginary axis put back on it."""
    values = values.copy()
    for group in _groups(values):
        mean = values[group].mean()
        if len(group) > 1 and abs(mean.real) <= tolerances.SAME_EIGENVALUE**1.5 * abs(mean):
            values[group] = 1j * values[group].imag
    return values


def _groups(values: Sequence[complex] | np.ndarray) -> list[list[int]]:
    groups: list[list[int]] = []
    for k in np.argsort(np.imag(values), kind="stable"):
        near = [g for g in groups if abs(values[g[-1]] - values[k]) <= tolerances.SAME_EIGENVALUE * abs(values[k])]
        near[0].append(int(k)) if near else groups.append([int(k)])
    return groups


def defective(e: LinearEquations, values: Sequence[complex]) -> bool:
    """True if an eigenvalue on the imaginary axis, 0 excepted, has fewer modes than its multiplicity."""
    A, B = _pencil(e)
    for group in _groups(values):
        x = 1j * np.mean([values[k].imag for k in group])
        if len(group) > 1 and x.imag > 0 and not any(values[k].real for k in group):
            whole = np.block([[A, x.imag * B], [-x.imag * B, A]])  # of real and imaginary parts
            if len(whole) - dense.rank(whole, smallest=tolerances.NEARLY_SINGULAR) < 2 * len(group):
                return True
    return False


def drifting(e: LinearEquations, zeros: int) -> np.ndarray | None:
    """The displacements that grow like t: x = x_2 + t x_1 with A x_1 = 0, A x_2 = B x_1; None where there are none.

    A x_2 = B x_1 has a solution where L^T B x_1 = 0, L^T A = 0: with x_1 = N c, A N = 0, that is (L^T B N) c = 0.

    Args:
        zeros: how many eigenvalues are 0.
    """
    A, B = _pencil(e)
    nullity = len(A) - dense.rank(A, smallest=tolerances.RANK)
    if not 0 < nullity < zeros:
        return None
    U, _, V = np.linalg.svd(A)
    L, N = U[:, -nullity:], V[-nullity:].T
    x = N @ np.linalg.svd(L.T @ B @ N)[2][-1]
    return np.asarray(x[: len(e.coordinates)])
