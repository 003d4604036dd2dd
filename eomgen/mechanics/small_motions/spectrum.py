"""Small motions -> their modes: eigenvalues, frequencies, damping ratios, shapes, and what they say of stability.

    (lambda^2 M + lambda C + K) v = 0,  or  A x = lambda x,        lambda = -zeta w +- i w sqrt(1 - zeta^2)

Systems without C and with symmetric K by the symmetric problem K v = w^2 M v, whose w^2 are real.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.small_motions.eigen import count_of_zeros, defective, drifting, eigenpairs, merged, squares_of
from eomgen.mechanics.small_motions.field import Numbers
from eomgen.mechanics.small_motions.forms import floats
from eomgen.mechanics.small_motions.linearization import SmallMotions, state_matrix_of
from eomgen.mechanics.small_motions.polynomial import Polynomial
from eomgen.mechanics.small_motions.reference import EQUILIBRIUM
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import COMPUTED, ITERATED, RANK, ROUNDING, SHARE, SOLVED, SUMMED

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
        """What it does, in words."""
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
    return bool(abs(C).max() <= SUMMED * size) and _is_symmetric(K, 1)


def _is_symmetric(A: np.ndarray, sign: int) -> bool:
    """Whether A = sign A^T: entries of slow motions count, whatever stiff ones stand beside them."""
    rows = np.maximum(abs(A).max(axis=1), abs(A).max(axis=0))
    limit = ITERATED * np.minimum.outer(rows, rows) + ROUNDING * abs(A).max()
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
    moving = np.where(abs(moving) > RANK * abs(vectors).max(axis=0, initial=0), moving, 0)
    real = [moving[:, k].imag if values[k].imag < 0 else moving[:, k].real for k in order[:still]]  # drawn to a pair
    zeros = [_shape(small, x.astype(complex), 0) for x in real]
    values, vectors = merged(values[order[still:]]), vectors[:, order[still:]]
    modes = []
    for value, x in zip(_without_noise(small, values), vectors.T, strict=True):
        if value.imag >= 0:
            modes.append(Mode(value, value.imag > 0, _shape(small, x[: len(small.numbers.coordinates)], value)))
    return modes + _zero_modes(small, zeros)


def _without_noise(small: SmallMotions, values: np.ndarray) -> list[complex]:
    """Parts that are what rounding leaves of 0 taken out: real ones all where nothing fades unless another grows."""
    e = small.numbers
    gyroscopic = small.is_second_order and _is_symmetric(floats(e.C), -1) and _is_symmetric(floats(e.K), 1)
    largest = abs(values).max(initial=0)
    turning = COMPUTED * abs(values) + SOLVED * largest
    real = np.full(len(values), COMPUTED * largest) if gyroscopic else turning
    return [
        complex(0 if abs(x.real) <= fades else x.real, 0 if abs(x.imag) <= turns else x.imag)
        for x, fades, turns in zip(values, real, turning, strict=True)
    ]


def _zero_modes(small: SmallMotions, shapes: Sequence[Mapping[Node, complex]]) -> list[Mode]:
    """Two zeros are one rigid motion of a place of rest; of a steady motion they lead to its neighbours."""
    pairs = len(shapes) // 2 if small.is_second_order and small.reference.about == EQUILIBRIUM else 0
    rigid = [Mode(0j, True, shape) for shape in shapes[: 2 * pairs : 2]]
    return rigid + [Mode(0j, False, shape) for shape in shapes[2 * pairs :]]


def _shape(small: SmallMotions, v: np.ndarray, eigenvalue: complex) -> dict[Node, complex]:
    """The coordinates of the whole model, the largest 1; noise taken out."""
    whole = floats(small.whole.P) @ _with_others(small, v, eigenvalue)
    largest = whole[np.argmax(abs(whole) * (1 - COMPUTED * np.arange(len(whole))))] if len(whole) else 0
    whole = whole / largest if largest else whole

    def clean(x: complex) -> complex:
        return complex(0 if abs(x.real) < ITERATED else x.real, 0 if abs(x.imag) < ITERATED else x.imag)

    return {q: clean(x) for q, x in zip(small.whole.all, whole, strict=True)}


def _with_others(small: SmallMotions, v: np.ndarray, eigenvalue: complex) -> np.ndarray:
    """The independent coordinates of the whole system while those of v move in a mode.

    (A - lambda) x = 0 with the part v of x known: the others follow, as the track of a wheel does. Beside a motion that
    stays as it is they stay too.
    """
    every, known = small.whole.coordinates, small.numbers.coordinates
    places = [every.index(q) for q in known]
    others = [k for k in range(len(every)) if k not in places]
    x = np.zeros(len(every) + len(small.whole.speeds), dtype=complex)
    x[places] = v
    if others and eigenvalue:
        A = state_matrix_of(small.whole) - eigenvalue * np.eye(len(x))
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
    if drift is not None and (small.reference.about == EQUILIBRIUM or not leads_on):
        others = "" if leads_on else "; terms of higher order may decide otherwise"
        return "unstable to first order", _grows_like_time(small, drift, values) + others
    if any(x == 0 for x in values) and small.reference.about != EQUILIBRIUM and small.reference.moving:
        return "stable to first order", "motions oscillate, fade, or go over into a steady motion nearby"
    if any(x == 0 for x in values):
        return "undecided", _drifting(modes)
    if _is_undamped(small) and small.reference.about == EQUILIBRIUM:
        added = ", that of the centrifugal forces included," if small.reference.moving else ""
        return "stable", f"the potential energy{added} has a minimum (Lagrange and Dirichlet)"
    return "stable to first order", "all motions oscillate or fade; terms of higher order may decide otherwise"


def _leads_on(small: SmallMotions, drift: np.ndarray) -> bool:
    """Whether all equations are the same after a displacement along a drift: it is a steady motion nearby."""
    shape = _shape(small, drift.astype(complex), 0)
    numbers = small.reference.numbers
    there = {q: numbers[q] + ALONG * x.real for q, x in shape.items()}
    try:
        beside = small.over(Numbers({**numbers, **there}))
    except (DerivationError, NoValue, ZeroDivisionError, np.linalg.LinAlgError):
        return False
    pairs = [(floats(getattr(small.numbers, name)), floats(getattr(beside, name))) for name in "MCKFE"]
    return all(A.shape == B.shape and np.all(abs(A - B) <= COMPUTED * (1 + abs(A))) for A, B in pairs)


def _grows_like_time(small: SmallMotions, drift: np.ndarray, values: Sequence[complex]) -> str:
    """That a zero eigenvalue has fewer modes than it counts for; what grows."""
    shape = _shape(small, drift.astype(complex), 0)
    names = ", ".join(q.name for q, x in shape.items() if abs(x) > SHARE) or "some speeds"
    others = "; all other motions oscillate or fade" if any(values) else ""
    return f"{names} grows like t, as the eigenvalue 0 has fewer modes than it counts for{others}"


def _drifting(modes: Sequence[Mode]) -> str:
    """That of motions which stay as they are, or drift, terms of higher order decide; what moves in them."""
    moving = [
        q.name
        for q in (modes[0].shape if modes else ())
        if any(mode.eigenvalue == 0 and abs(mode.shape[q]) > SHARE for mode in modes)
    ]
    names = ", ".join(moving) or "some speeds"
    others = "; all other motions oscillate or fade" if any(mode.eigenvalue for mode in modes) else ""
    return f"to first order {names} may stay anywhere, or drift{others}"
