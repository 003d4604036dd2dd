"""A linear equation of motion with constant coefficients -> its solution in closed form.

    q'' = A q + B q' + f(t)

A root of a number of unknown sign is real or imaginary: `sign` decides, and where it cannot, the result is None.
"""

from __future__ import annotations

from collections.abc import Callable

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics import integral_from_zero
from eomgen.symbolic.exact import readable, vanishes
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    depends_on,
    derivative,
    function,
    is_zero,
    linear_terms,
    over,
    sqrt,
    substituted,
)
from eomgen.symbolic.numeric import has_pieces

HIGHEST_DEGREE = 6  # of a polynomial on the right side

Simplify = Callable[[Scalar], Scalar]
Sign = Callable[[Scalar], int | None]


@dataclass(frozen=True)
class MotionConstants:
    """Functions that give the signs and short forms of constants.

    Args:
        t: time.
        sign: -1, 0 or 1 of a constant; None where it is not known.
        simple: a constant in its shortest form.
        zero: the parameters whose value is 0.
    """

    t: Node
    sign: Sign
    simple: Simplify
    zero: frozenset[str] | None = None


@dataclass(frozen=True)
class LinearEquation:
    """q'' = A q + B q' + f(t)."""

    A: Scalar
    B: Scalar
    f: Scalar


def law_of_motion(line: LinearEquation, q0: Scalar, u0: Scalar, of: MotionConstants) -> Scalar | None:
    """q(t) with q(0) = q0, q'(0) = u0; None where no closed form is known."""
    found = particular(line, of)
    if found is None:
        return None
    at, slope = substituted((found, derivative(found, of.t)), {of.t: 0})
    free = homogeneous(line.A, line.B, q0 - at, u0 - slope, of)
    return None if free is None else found + free


def homogeneous(A: Scalar, B: Scalar, q0: Scalar, u0: Scalar, of: MotionConstants) -> Scalar | None:
    """The solution of q'' = A q + B q': with d = B/2 and D = d^2 + A, e^(d t) times cos, cosh or 1 of sqrt(|D|) t."""
    t = of.t
    if is_zero(A):
        return q0 + u0 * t if is_zero(B) else q0 + over(u0, B) * (function("exp", B * t) - 1)
    d = over(B, 2)
    found = waves(of.simple(d * d + A), of)
    if found is None:
        return None
    even, odd, w = found
    return function("exp", d * t) * (of.simple(q0) * even + of.simple(over(u0 - d * q0, w)) * odd)


def waves(D: Scalar, of: MotionConstants) -> tuple[Scalar, Scalar, Scalar] | None:
    """(cosh(w t), sinh(w t), w) with w^2 = D; of a negative D (cos(w t), sin(w t), w) with w^2 = -D; of 0 (1, t, 1)."""
    t, sign = of.t, of.sign(D)
    if sign is None:
        return None
    if sign == 0:
        return 1, t, 1
    w = of.simple(sqrt(sign * D))
    names = ("cos", "sin") if sign < 0 else ("cosh", "sinh")
    return function(names[0], w * t), function(names[1], w * t), w


def particular(line: LinearEquation, of: MotionConstants) -> Scalar | None:
    """One solution of q'' = A q + B q' + f(t)."""
    try:
        if is_zero(line.A) and is_zero(line.B):
            return integral_from_zero(integral_from_zero(line.f, of.t, "", of.zero), of.t, "", of.zero)
        total: Scalar = 0
        for node, c in linear_terms(readable(line.f)).items():
            part = _of_term(line.A, line.B, 1 if node is None else node, of)
            if part is None:
                return None
            total = total + c * part
        return total
    except DerivationError:  # no integral in closed form
        return None


def _of_term(A: Scalar, B: Scalar, g: Scalar, of: MotionConstants) -> Scalar | None:
    """One solution for f = g, g a polynomial in t or a g with g'' = mu g; none of what has pieces in time.

    max(0, t - t0) has no second derivative in any piece, and is no polynomial: at t0 a vibration begins.
    """
    t = of.t
    if has_pieces(g) and depends_on(g, (t,)):
        return None
    second = derivative(derivative(g, t), t)
    mu = 0 if is_zero(second) else of.simple(over(second, g))
    if is_zero(second) or depends_on(mu, (t,)):
        return _of_polynomial(A, B, g, t)
    # x g + y g':  (mu - A) x - B mu y = 1,  (mu - A) y = B x
    below = of.simple((mu - A) * (mu - A) - B * B * mu)
    if vanishes(below):
        return None  # resonance
    return over((mu - A) * g + B * derivative(g, t), below)


def _of_polynomial(A: Scalar, B: Scalar, g: Scalar, t: Node) -> Scalar | None:
    """Solution for a polynomial g: A q = q'' - B q' - g, or B u = u' - g with A = 0, by repeated insertion."""
    degrees = [g]
    while not is_zero(degrees[-1]) and len(degrees) <= HIGHEST_DEGREE + 1:
        degrees.append(readable(derivative(degrees[-1], t)))
    if not is_zero(degrees[-1]):
        return None
    found: Scalar = 0
    for _ in degrees:
        rate = derivative(found, t)
        known = rate - g if is_zero(A) else derivative(rate, t) - B * rate - g
        found = readable(over(known, B if is_zero(A) else A))
    return integral_from_zero(found, t, "") if is_zero(A) else found
