"""Small motions -> their modes: eigenvalues, frequencies, damping ratios, shapes, and what they say of stability.

    (lambda^2 M + lambda C + K) v = 0,  or  A x = lambda x,        lambda = -zeta w +- i w sqrt(1 - zeta^2)

Systems without C and with symmetric K by the symmetric problem K v = w^2 M v, whose w^2 are real.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from eomgen.mechanics.small_motions.forms import floats
from eomgen.mechanics.small_motions.linearization import SmallMotions, state_matrix_of
from eomgen.mechanics.small_motions.reference import EQUILIBRIUM, START
from eomgen.symbolic.graph import Node

ZERO = 1e-6  # of an eigenvalue against the largest: a double zero keeps half of the digits
STILL = 1e-9  # of a real part against the largest eigenvalue, below which a motion neither grows nor fades
SQUARE_ZERO = 1e-11  # of w^2 against the largest
SYMMETRIC = 1e-10  # of A - A^T against the largest entry


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
        stability: "asymptotically stable", "stable", "stable to first order", "unstable" or "undecided".
        why: in words.
    """

    modes: tuple[Mode, ...]
    eigenvalues: tuple[complex, ...]
    stability: str
    why: str

    @property
    def oscillating(self) -> tuple[Mode, ...]:
        """The modes that have a frequency, the slowest first."""
        return tuple(mode for mode in self.modes if mode.frequency is not None)


def spectrum_of(small: SmallMotions) -> Spectrum:
    """The modes of small motions in numbers."""
    modes = _undamped(small) if _is_undamped(small) else _general(small)
    modes.sort(key=lambda mode: (mode.frequency is None, mode.frequency or 0.0, -mode.eigenvalue.real))
    values = [x for mode in modes for x in _all_values(mode)]
    return Spectrum(tuple(modes), tuple(values), *_stability(small, values))


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
    return bool(abs(C).max() <= 1e-13 * size) and bool(abs(K - K.T).max() <= SYMMETRIC * abs(K).max())


def _undamped(small: SmallMotions) -> list[Mode]:
    """K v = w^2 M v."""
    from scipy.linalg import eigh

    M, K = floats(small.numbers.M), floats(small.numbers.K)
    squares, vectors = eigh((K + K.T) / 2, (M + M.T) / 2)
    largest = abs(squares).max()
    modes = []
    for square, v in zip(squares, vectors.T, strict=True):
        rate = math.sqrt(abs(square))
        if abs(square) <= SQUARE_ZERO * largest:
            values, pair = [0j], True
        else:
            values, pair = ([complex(0, rate)], True) if square > 0 else ([complex(rate, 0), complex(-rate, 0)], False)
        modes += [Mode(value, pair, _shape(small, v.astype(complex), value)) for value in values]
    return modes


# -- all others ------------------------------------------------------------------------------------------------


def _general(small: SmallMotions) -> list[Mode]:
    """The eigenvalues of the state matrix."""
    values, vectors = np.linalg.eig(small.state_matrix)
    largest = abs(values).max(initial=0)
    n = len(small.numbers.coordinates)
    modes, zeros = [], []
    for value, x in zip(values, vectors.T, strict=True):
        still = abs(value) <= ZERO * largest or largest == 0
        shape = _shape(small, x[:n], 0 if still else value)
        if still:
            zeros.append(shape)
        elif abs(value.imag) <= STILL * largest:
            modes.append(Mode(complex(value.real, 0), False, shape))
        elif value.imag > 0:
            real = 0.0 if abs(value.real) <= STILL * largest else value.real
            modes.append(Mode(complex(real, value.imag), True, shape))
    return modes + _zero_modes(small, zeros)


def _zero_modes(small: SmallMotions, shapes: Sequence[Mapping[Node, complex]]) -> list[Mode]:
    """Two zeros are one rigid motion of a place of rest; of a steady motion they lead to its neighbours."""
    pairs = len(shapes) // 2 if small.is_second_order and small.reference.about == EQUILIBRIUM else 0
    rigid = [Mode(0j, True, shape) for shape in shapes[: 2 * pairs : 2]]
    return rigid + [Mode(0j, False, shape) for shape in shapes[2 * pairs :]]


def _shape(small: SmallMotions, v: np.ndarray, eigenvalue: complex) -> dict[Node, complex]:
    """The coordinates of the whole model, the largest 1; noise taken out."""
    whole = floats(small.whole.P) @ _with_others(small, v, eigenvalue)
    largest = whole[np.argmax(abs(whole) * (1 - 1e-9 * np.arange(len(whole))))] if len(whole) else 0
    whole = whole / largest if largest else whole

    def clean(x: complex) -> complex:
        return complex(0 if abs(x.real) < 1e-10 else x.real, 0 if abs(x.imag) < 1e-10 else x.imag)

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


def _stability(small: SmallMotions, values: list[complex]) -> tuple[str, str]:
    growing = [x for x in values if x.real > 0]
    if any(x.imag for x in growing):
        return "unstable", "an oscillation grows (flutter)"
    if growing:
        return "unstable", "a motion grows without oscillation (divergence)"
    if all(x.real < 0 for x in values):
        return "asymptotically stable", "all motions fade"
    e = small.numbers
    if any(x == 0 for x in values) and small.reference.about == START and small.reference.moving:
        return "stable to first order", "motions oscillate, fade, or go over into a steady motion nearby"
    if any(x == 0 for x in values):
        return "undecided", "some small motions neither grow nor fade nor oscillate"
    if _is_undamped(small) and small.reference.about == EQUILIBRIUM and np.all(np.linalg.eigvalsh(floats(e.K)) > 0):
        added = ", that of the centrifugal forces included," if small.reference.moving else ""
        return "stable", f"the potential energy{added} has a minimum (Lagrange and Dirichlet)"
    return "stable to first order", "all motions oscillate or fade; terms of higher order may decide otherwise"
