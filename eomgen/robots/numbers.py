"""Decimals of robot files: places, turns and inertias by 40 digits, written with 17; angles that are parts of pi."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from decimal import Context, Decimal, localcontext
from typing import Any

import mpmath

from eomgen.model.joints.orientation import rotation_of
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import IDENTITY, product, rotation, transposed
from eomgen.symbolic.numeric.tolerances import ROUNDED_AWAY, SAME_TURN

Triple = tuple[Any, Any, Any]
Nine = tuple[Triple, Triple, Triple]

DIGITS = 40
WRITTEN = 17  # digits of a number that had to be computed: what a double holds
SURE = 13  # digits by which a decimal is taken for a part of pi
PARTS = 24  # of pi, that people write

ZERO = Decimal(0)
ORIGIN: Triple = (ZERO, ZERO, ZERO)
EXACTLY = Context(prec=DIGITS)
"""in which robots are read"""


def decimals(values: Iterable[Any]) -> Triple:
    """Three decimals."""
    x, y, z = (Decimal(value) for value in values)
    return x, y, z


def decimal_of_double(x: float) -> Decimal:
    """A double as a decimal: with 15 digits where it is the next but few to that, else as it is."""
    short, close = Decimal(f"{x:.15g}"), 2 * sys.float_info.epsilon * abs(x)
    return short if len(short.as_tuple().digits) < 12 and abs(float(short) - x) <= close else Decimal(repr(float(x)))


def computed(x: Decimal) -> Decimal:
    """A computed number, rounded to what is written; what is nothing but rounding is 0."""
    if abs(x) < ROUNDED_AWAY:
        return ZERO
    return Context(prec=WRITTEN).plus(x).normalize()


def part_of_pi(angle: Decimal) -> Fraction | None:
    """Which part of pi an angle is, where it is one to all of its digits, and has enough of them."""
    if angle == 0:
        return Fraction(0)
    with mpmath.workdps(DIGITS):
        part = Fraction(round(mpmath.mpf(str(angle)) / mpmath.pi * PARTS), PARTS)
        exact = Decimal(mpmath.nstr(mpmath.pi * part.numerator / part.denominator, DIGITS))
    digits = len(angle.as_tuple().digits)
    unit = Decimal(1).scaleb(int(angle.as_tuple().exponent))
    return part if part and digits >= SURE and abs(angle - exact) <= 2 * unit else None


def angle_text(angle: Decimal) -> Decimal | str:
    """An angle as a person writes it: pi/2, -2*pi/3, or its decimals."""
    part = part_of_pi(angle)
    if not part:
        return angle
    top = {1: "pi", -1: "-pi"}.get(part.numerator, f"{part.numerator}*pi")
    return top if part.denominator == 1 else f"{top}/{part.denominator}"


def sine_cosine(angle: Decimal) -> tuple[Any, Any]:
    """(sin, cos) of an angle, by DIGITS; of a part of pi exactly that part's."""
    part = part_of_pi(angle)
    with mpmath.workdps(DIGITS + 5):
        x = mpmath.mpf(str(angle)) if part is None else mpmath.pi * part.numerator / part.denominator
        pair = [Decimal(mpmath.nstr(y, DIGITS)) for y in (mpmath.sin(x), mpmath.cos(x))]
    sine, cosine = (ZERO if abs(y) < ROUNDED_AWAY else y for y in pair)
    return sine, cosine


def turning(axis: Sequence[Decimal], angle: Decimal) -> Nine:
    """The rotation by an angle about an axis of any length."""
    sine, cosine = sine_cosine(angle)
    with localcontext(EXACTLY):
        length = sum((x * x for x in axis), ZERO).sqrt()
        n: Any = tuple(x / length for x in axis)
        return rotation(n, cosine, sine)


def roll_pitch_yaw(angles: Triple) -> tuple[Nine, list[dict[str, Any]]]:
    """R = Rz(yaw) Ry(pitch) Rx(roll), and the turns of a model file that make it, those by 0 left out."""
    R, turns = IDENTITY, []
    for axis, angle in zip(((0, 0, 1), (0, 1, 0), (1, 0, 0)), reversed(angles), strict=True):
        if angle != 0:
            R = product(R, turning(decimals(axis), angle))
            turns.append({"axis": list(axis), "angle": angle_text(angle)})
    return R, turns


def in_radians(degrees: Decimal) -> Decimal:
    """An angle, by DIGITS."""
    with mpmath.workdps(DIGITS + 5):
        return Decimal(mpmath.nstr(mpmath.mpf(str(degrees)) * mpmath.pi / 180, DIGITS))


def turned_by(quaternion: Sequence[Decimal]) -> Nine:
    """The rotation of a quaternion of any length, scalar first."""
    length = sum((x * x for x in quaternion), ZERO).sqrt()
    R: Nine = rotation_of("quaternion", tuple(x / length for x in quaternion))
    return R


def quaternion_of(R: Nine) -> tuple[Decimal, Decimal, Decimal, Decimal]:
    """The quaternion of a rotation, scalar first, from its largest component."""
    with localcontext(EXACTLY):
        d = [R[i][i] for i in range(3)]
        squares = [1 + d[0] + d[1] + d[2], *(1 + 2 * d[i] - d[0] - d[1] - d[2] for i in range(3))]
        k = max(range(4), key=lambda i: squares[i])
        s = Decimal(squares[k]).sqrt()
        skew = [R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1]]
        if k == 0:
            e = [s, *(x / s for x in skew)]
        else:
            i, j = k % 3, (k + 1) % 3
            e = [ZERO] * 4
            e[0], e[k] = skew[k - 1] / s, s
            e[1 + i], e[1 + j] = (R[k - 1][i] + R[i][k - 1]) / s, (R[k - 1][j] + R[j][k - 1]) / s
        return e[0] / 2, e[1] / 2, e[2] / 2, e[3] / 2


def turn_of(quaternion: Sequence[Decimal]) -> list[dict[str, Any]]:
    """The turn of a model file that a quaternion is, scalar first: [] for none, else one about an axis."""
    with localcontext(EXACTLY):
        w, *v = quaternion
        length = sum((x * x for x in v), ZERO).sqrt()
        if length < SAME_TURN:
            return []
        largest = max(v, key=abs)
        axis = [_plain(x / abs(largest)) for x in v]
        sign = -1 if largest < 0 and sum(map(bool, axis)) == 1 else 1
        with mpmath.workdps(DIGITS):
            angle = 2 * mpmath.atan2(mpmath.mpf(str(length)), mpmath.mpf(str(w)))
            if angle > mpmath.pi:
                angle -= 2 * mpmath.pi
            decimal = Decimal(mpmath.nstr(sign * angle, 14, strip_zeros=False))
            full = Decimal(mpmath.nstr(sign * angle, WRITTEN))
    text = angle_text(decimal)
    return [{"axis": [sign * x for x in axis], "angle": text if isinstance(text, str) else full}]


def _plain(x: Decimal) -> Decimal:
    """A ratio, made short where it is so to 14 digits."""
    short = Context(prec=6).plus(x)
    return short.normalize() if abs(short - x) < SAME_TURN else computed(x)


def inertia_in(R: Nine, tensor: Nine) -> Nine:
    """R I R^T."""
    return product(product(R, tensor), transposed(R))


def tensor_of(xx: Decimal, yy: Decimal, zz: Decimal, xy: Decimal, yz: Decimal, zx: Decimal) -> Nine:
    """A symmetric matrix."""
    return (xx, xy, zx), (xy, yy, yz), (zx, yz, zz)


def six(I: Nine) -> list[Decimal]:
    """xx, yy, zz, xy, yz, zx of a tensor; of a diagonal one three."""
    found = [computed(x) for x in (I[0][0], I[1][1], I[2][2], I[0][1], I[1][2], I[0][2])]
    return found if any(found[3:]) else found[:3]
