"""Two coordinates with linear equations of motion -> their solutions in closed form.

    q'' = A q + B q' + b,   or  x' = S x + z,  x = (q, q'),  S = [0, 1; A, B],  z = (0, b)

where the motion looks the same backward in time, det(l^2 - l B - A) being even in l: springs, weights, gyroscopic and
Coriolis terms, no damping. With M = S^2, whose eigenvalues mu are two and real,

    x = E(M) x0 + S O(M) x0 + O(M) z + S G(M) z

    E(mu) = cosh(w t),  O(mu) = sinh(w t)/w,  G(mu) = (cosh(w t) - 1)/w^2,  w^2 = mu
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from eomgen.mechanics.first_integrals.linear_motion import MotionConstants, waves
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over, sqrt
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRows
from eomgen.symbolic.solve.solving import vanishes

Four = tuple[Scalar, ...]
WaveCoefficients = tuple[Scalar, Scalar, Scalar]  # E, O, G
WavePart = tuple[
    Callable[[Four], Four], WaveCoefficients
]  # of f(M) x: what multiplies f or its derivative at an eigenvalue, and that


@dataclass(frozen=True)
class CoupledEquations:
    """q'' = A q + B q' + b of two coordinates; all constants."""

    A: ScalarRows
    B: ScalarRows
    b: Sequence[Scalar]

    def rate(self, x: Four) -> Four:
        """S x."""
        return (*x[2:], *(_row(self.A[i], x[:2]) + _row(self.B[i], x[2:]) for i in range(2)))

    def less(self, x: Four, mu: Scalar) -> Four:
        """(M - mu) x."""
        return tuple(y - mu * own for y, own in zip(self.rate(self.rate(x)), x, strict=True))

    @property
    def is_even(self) -> bool:
        """Whether det(l^2 - l B - A) has no odd powers of l: B11 + B22 = 0, A11 B22 + A22 B11 = A12 B21 + A21 B12."""
        A, B = self.A, self.B
        mixed = A[0][0] * B[1][1] + A[1][1] * B[0][0] - A[0][1] * B[1][0] - A[1][0] * B[0][1]
        return vanishes(B[0][0] + B[1][1]) and vanishes(mixed)


def pair_solution(
    pair: CoupledEquations, q0: Sequence[Scalar], u0: Sequence[Scalar], of: MotionConstants
) -> tuple[Scalar, Scalar] | None:
    """(q1, q2) as functions of t with q(0) = q0, q'(0) = u0; None where no closed form is known."""
    parts = _parts(pair, of)
    if parts is None:
        return None
    found: list[Scalar] = [0, 0]
    for share, (even, odd, gained) in parts:
        x, z = share((*q0, *u0)), share((0, 0, *pair.b))
        for i in range(2):
            added = even * of.simple(x[i]) + odd * of.simple(x[2 + i] + z[i]) + gained * of.simple(z[2 + i])
            found[i] = found[i] + added
    return found[0], found[1]


def _parts(pair: CoupledEquations, of: MotionConstants) -> list[WavePart] | None:
    """f(M) = f(mu1) (M - mu2)/(mu1 - mu2) + f(mu2) (M - mu1)/(mu2 - mu1),  or  f(mu) + f'(mu) (M - mu)."""
    values = _eigenvalues(pair, of)
    each = [waves for mu in values if (waves := _waves(mu, of)) is not None]
    if not values or len(each) < len(values):
        return None
    if len(values) == 1:
        mu = values[0]
        return [(lambda x: x, each[0]), (lambda x: pair.less(x, mu), _derivatives(of.t, mu, each[0]))]

    def share(own: Scalar, other: Scalar) -> Callable[[Four], Four]:
        return lambda x: tuple(over(y, own - other) for y in pair.less(x, other))

    return [(share(*values), each[0]), (share(*values[::-1]), each[1])]


def _eigenvalues(pair: CoupledEquations, of: MotionConstants) -> tuple[Scalar, ...]:
    """The eigenvalues of M where they are real, one where they coincide; else none.

    mu^2 + (B11 B22 - B12 B21 - A11 - A22) mu + A11 A22 - A12 A21 = 0
    """
    if not pair.is_even:
        return ()
    half = over(pair.A[0][0] + pair.A[1][1] - _determinant(pair.B), 2)
    inside = of.simple(half * half - _determinant(pair.A))
    sign = of.sign(inside)
    if sign == 0:
        return (of.simple(half),)
    root = of.simple(sqrt(inside)) if sign == 1 else 0
    return (of.simple(half + root), of.simple(half - root)) if sign == 1 else ()


def _waves(mu: Scalar, of: MotionConstants) -> WaveCoefficients | None:
    """E, O and G at mu."""
    found = waves(mu, of)
    if found is None:
        return None
    even, odd, w = found
    return even, over(odd, w), over(of.t * of.t, 2) if is_zero(mu) else over(even - 1, mu)


def _derivatives(t: Node, mu: Scalar, at: WaveCoefficients) -> WaveCoefficients:
    """E' = t O/2,  O' = (t E - O)/(2 mu),  G' = (t O/2 - G)/mu;  at 0  t^2/2,  t^3/6,  t^4/24."""
    even, odd, gained = at
    if is_zero(mu):
        return over(t**2, 2), over(t**3, 6), over(t**4, 24)
    slope = over(t * odd, 2)
    return slope, over(t * even - odd, 2 * mu), over(slope - gained, mu)


def _row(row: Sequence[Scalar], x: Sequence[Scalar]) -> Scalar:
    return row[0] * x[0] + row[1] * x[1]


def _determinant(A: ScalarRows) -> Scalar:
    return A[0][0] * A[1][1] - A[0][1] * A[1][0]
