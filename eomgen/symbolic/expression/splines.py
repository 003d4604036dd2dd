"""Samples -> a function of time between them, exactly: piecewise polynomials over any scalar.

Between the knots t_k and t_k+1, with values y and slopes d there, h = t_k+1 - t_k, m = (y_k+1 - y_k)/h, s = t - t_k:

    f = y_k + d_k s + (3 m - 2 d_k - d_k+1)/h s^2 + (d_k + d_k+1 - 2 m)/h^2 s^3

The slopes are those that make f'' continuous, or those that let f rise and fall only where the samples do ("pchip").
Beyond the ends a cubic goes on straight, anything else stays.
Source: C. de Boor, A Practical Guide to Splines (2001), ch. IV; F. N. Fritsch & J. Butland, SIAM J. Sci. Stat. Comput.
5 (1984), 300-304.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import field, replace
from functools import cache
from hashlib import blake2b
from itertools import pairwise
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.expression.rational import Fraction

LONGEST = 1000  # bits of a denominator
SplineRow = tuple[Fraction, ...]


@dataclass(frozen=True, slots=True)
class Spline:
    """A piecewise polynomial of one variable.

    Args:
        bounds: where one piece ends and the next begins, ascending.
        origins: of every piece the point from which its polynomial counts, one more than bounds.
        pieces: of every piece its coefficients, from that of the power 0 on; all of one length. A piece holds from its
            first bound on.
        closed: the last bound belongs to the piece before it: there the samples end.
    """

    bounds: SplineRow
    origins: SplineRow
    pieces: tuple[SplineRow, ...]
    closed: bool = True

    @property
    def vanishes(self) -> bool:
        return not any(c for piece in self.pieces for c in piece)

    def at(self, t: Any, number: Callable[[Fraction], Any] = Fraction) -> Any:
        """The value at a number.

        Args:
            number: an exact number as one of the kind of t.
        """
        k = bisect_right(self.bounds, t, key=number)
        if self.closed and t == number(self.bounds[-1]):
            k -= 1
        return _polynomial(self.pieces[k], t - number(self.origins[k]), number)

    def chosen(self, t: Any, choose: Callable[..., Any]) -> Any:
        """The value over any scalar: every coefficient is chosen, then one polynomial is taken.

        Args:
            choose: (a, b, if a <= b, else) -> one of the two.
        """
        s = t - self._chosen(t, self.origins, choose)
        value: Any = 0
        for row in reversed(tuple(zip(*self.pieces, strict=True))):
            value = value * s + self._chosen(t, row, choose)
        return value

    def _chosen(self, t: Any, values: SplineRow, choose: Callable[..., Any], first: int = 0) -> Any:
        """The value of the piece in which t lies, by halving: no choice stands deeper than log2 of their number."""
        if len(set(values)) == 1:
            return _tidy(values[0])
        middle = (len(values) - 1) // 2
        below = self._chosen(t, values[: middle + 1], choose, first)
        above = self._chosen(t, values[middle + 1 :], choose, first + middle + 1)
        bound = _tidy(self.bounds[first + middle])
        if self.closed and first + middle == len(self.bounds) - 1:
            return choose(t, bound, below, above)
        return choose(bound, t, above, below)

    def derivative(self) -> Spline:
        """Its rate, where it has one."""
        falling = (tuple(k * c for k, c in enumerate(piece))[1:] or (Fraction(0),) for piece in self.pieces)
        return replace(self, pieces=tuple(falling))

    def integral(self) -> Spline:
        """The continuous function whose rate this is, 0 at 0."""
        rising = [(Fraction(0), *(c / (k + 1) for k, c in enumerate(piece))) for piece in self.pieces]
        found = [rising[0]]
        for bound, before, after, piece in zip(self.bounds, self.origins, self.origins[1:], rising[1:], strict=False):
            gap = _polynomial(found[-1], bound - before) - _polynomial(piece, bound - after)
            found.append((gap, *piece[1:]))
        whole = replace(self, pieces=tuple(found))
        return whole.raised(-whole.at(Fraction(0)))

    def raised(self, by: Fraction) -> Spline:
        """The spline with a number added."""
        return replace(self, pieces=tuple((piece[0] + by, *piece[1:]) for piece in self.pieces))

    def scaled(self, factor: Fraction) -> Spline:
        """A multiple of it."""
        return replace(self, pieces=tuple(tuple(factor * c for c in piece) for piece in self.pieces))


@dataclass(frozen=True, slots=True)
class DeclaredSamples:
    """Samples as they were given, and the way between them: what proofs look at.

    Args:
        way, ends: of `spline_of`.
        factor: by which the values have been multiplied since.
        ends_given: True if the behaviour at the ends was declared.
    """

    times: SplineRow
    values: SplineRow
    way: str
    ends: str
    factor: Fraction = Fraction(1)
    ends_given: bool = False


@dataclass(frozen=True, slots=True)
class Sampled:
    """A function through samples, which the graph holds as one operation on t.

    Args:
        name: as it is printed: theta', a rate that is given.
        spline: its values over pi^pi_power.
        declared: the samples; None of its rate and its integral.
        called: it is printed with its argument, M(n): a table of any variable, and not a function of time alone.
        units: of its argument and of its values, in SI; "" of what is not known.
        measure: (factor, power of pi) that make its argument one in the unit of its samples: degrees of radians.
    """

    name: str
    spline: Spline
    pi_power: int = 0
    declared: DeclaredSamples | None = field(default=None, compare=False, repr=False)
    called: bool = False
    units: tuple[str, str] = field(default=("", ""), compare=False, repr=False)
    measure: tuple[Fraction, int] = (Fraction(1), 0)

    WAYS = ("cubic", "linear", "steps", "pchip")
    """between samples"""

    SMOOTH = ("cubic", "pchip")
    """of which f is differentiated twice; of pchip f'' jumps at samples"""

    ENDS = ("not-a-knot", "natural", "rest")
    """of a cubic, the usual one first"""

    def derivative(self) -> Sampled:
        factor, power = self.measure
        slope = self.spline.derivative().scaled(factor) if factor != 1 else self.spline.derivative()
        at, unit = self.units
        units = (at, f"{unit}/({at})" if at and unit else "")
        return Sampled(f"{self.name}'", slope, self.pi_power + power, None, self.called, units, self.measure)

    def integral(self) -> Sampled:
        """The integral from t = 0 on."""
        return Sampled(self.name.removesuffix("'"), self.spline.integral(), self.pi_power)

    def raised(self, by: Fraction) -> Sampled:
        """The function with a number added; the number has no pi in it."""
        return replace(self, spline=self.spline.raised(by), declared=None)

    def named(self, name: str) -> Sampled:
        return replace(self, name=name)

    def scaled(self, factor: Fraction, pi_power: int) -> Sampled:
        given = self.declared and replace(self.declared, factor=self.declared.factor * factor)
        return replace(self, spline=self.spline.scaled(factor), pi_power=self.pi_power + pi_power, declared=given)

    def measured(self, t: Any, pi: Any, number: Callable[[Fraction], Any] = lambda x: x) -> Any:
        """An argument in the unit of the samples."""
        factor, power = self.measure
        t = t * number(factor) if factor != 1 else t
        return t * pi**power if power > 0 else t / pi**-power if power else t

    def ends(self, pi: Any, number: Callable[[Fraction], Any] = lambda x: x) -> tuple[Any, ...]:
        """The arguments at which one piece ends and the next begins."""
        factor, power = self.measure
        found = (number(end / factor) for end in self.spline.bounds)
        return tuple(end / pi**power if power > 0 else end * pi**-power if power else end for end in found)

    def at(self, t: Any, number: Callable[[Fraction], Any], pi: Any) -> Any:
        """The value at a number; pi is one of its kind."""
        value = self.spline.at(self.measured(t, pi, number), number)
        return value * pi**self.pi_power if self.pi_power else value

    def chosen(self, t: Any, choose: Callable[..., Any], pi: Any) -> Any:
        """The value over any scalar; pi is one of its kind."""
        value = self.spline.chosen(self.measured(t, pi, _tidy), choose)
        return value * pi**self.pi_power if self.pi_power else value

    @staticmethod
    def of(number: Any) -> Sampled:
        """The function of this number."""
        return _BY_NUMBER[int(number)]


_BY_NUMBER: dict[int, Sampled] = {}  # a table that is made again wherever a function is named


@cache
def number_of_sampled(sampled: Sampled) -> int:
    """Its number, by which an operation of the graph names it: made of its samples, the same in every process.

    Raises:
        RuntimeError: another function has the same number (one of 2^52).
    """
    number = int.from_bytes(blake2b(repr(sampled).encode(), digest_size=8).digest()) >> 12  # as a double holds it
    if _BY_NUMBER.setdefault(number, sampled) != sampled:
        raise RuntimeError(f"the functions '{sampled.name}' and '{_BY_NUMBER[number].name}' have one number")
    return number


def spline_of(
    times: Sequence[Fraction], values: Sequence[Fraction], way: str = "cubic", ends: str = "not-a-knot"
) -> Spline:
    """The function through samples: "cubic" (f'' continuous), "pchip" (cubics, monotone between samples), "linear", or
    "steps" (each value until the next).

    Args:
        times: strictly ascending, two or more.
        ends: of a cubic. "not-a-knot": the first two pieces are one cubic, and the last two; "natural": f'' = 0;
            "rest": f' = 0.
    """
    if way == "steps":
        return Spline(tuple(times[1:]), tuple(times), tuple((y,) for y in values), closed=False)
    slopes = None if way == "linear" else _monotone(times, values) if way == "pchip" else _slopes(times, values, ends)
    pieces = [_piece(times[k : k + 2], values[k : k + 2], slopes and slopes[k : k + 2]) for k in range(len(times) - 1)]
    first, last = (slopes[0], slopes[-1]) if slopes else (Fraction(0), Fraction(0))
    zeros = (Fraction(0),) * (len(pieces[0]) - 2)
    pieces = [(values[0], first, *zeros), *pieces, (values[-1], last, *zeros)]
    return Spline(tuple(times), (times[0], *times), tuple(pieces))


def _tidy(a: Fraction) -> int | Fraction:
    return a.numerator if a.denominator == 1 else a


def _polynomial(piece: SplineRow, s: Any, number: Callable[[Fraction], Any] = Fraction) -> Any:
    value = number(Fraction(0))
    for c in reversed(piece):
        value = value * s + number(c)
    return value


def _piece(times: Sequence[Fraction], values: Sequence[Fraction], slopes: Sequence[Fraction] | None) -> SplineRow:
    h = times[1] - times[0]
    m = (values[1] - values[0]) / h
    if slopes is None:
        return values[0], m
    d, e = slopes
    return values[0], d, (3 * m - 2 * d - e) / h, (d + e - 2 * m) / h**2


def _slopes(times: Sequence[Fraction], values: Sequence[Fraction], ends: str) -> list[Fraction]:
    """f' at the knots: h_k d_k-1 + 2 (h_k-1 + h_k) d_k + h_k-1 d_k+1 = 3 (h_k m_k-1 + h_k-1 m_k), and the ends."""
    h = [b - a for a, b in pairwise(times)]
    m = [(b - a) / step for a, b, step in zip(values, values[1:], h, strict=False)]
    rows = [_end(h, m, ends)]
    for k in range(1, len(h)):
        right = 3 * (h[k] * m[k - 1] + h[k - 1] * m[k])
        rows.append((h[k], 2 * (h[k - 1] + h[k]), h[k - 1], right))
    inner, own, right = _end(h[::-1], m[::-1], ends)[2:0:-1] + _end(h[::-1], m[::-1], ends)[3:]
    rows.append((inner, own, Fraction(0), right))
    return _tridiagonal(rows)


def _monotone(times: Sequence[Fraction], values: Sequence[Fraction]) -> list[Fraction]:
    """f' at the knots: 0 where the samples turn, else (w + v)/(w/m_k-1 + v/m_k), w = 2 h_k + h_k-1, v = h_k + 2 h_k-1.

    At the ends that of the parabola through three samples, as far as it keeps their sense.
    """
    h = [b - a for a, b in pairwise(times)]
    m = [(b - a) / step for a, b, step in zip(values, values[1:], h, strict=False)]
    if len(h) == 1:
        return [m[0], m[0]]
    inner = [Fraction(0)] * (len(h) - 1)
    for k in range(1, len(h)):
        if m[k - 1] * m[k] > 0:
            w, v = 2 * h[k] + h[k - 1], h[k] + 2 * h[k - 1]
            inner[k - 1] = _rounded((w + v) / (w / m[k - 1] + v / m[k]))
    return [_monotone_end(h, m), *inner, _monotone_end(h[::-1], m[::-1])]


def _monotone_end(h: Sequence[Fraction], m: Sequence[Fraction]) -> Fraction:
    found = ((2 * h[0] + h[1]) * m[0] - h[0] * m[1]) / (h[0] + h[1])
    if found * m[0] <= 0:
        return Fraction(0)
    return 3 * m[0] if m[0] * m[1] < 0 and abs(found) > 3 * abs(m[0]) else _rounded(found)


def _end(h: Sequence[Fraction], m: Sequence[Fraction], ends: str) -> tuple[Fraction, Fraction, Fraction, Fraction]:
    """(0, own, next, right): the equation of the slope at the first knot."""
    zero, one = Fraction(0), Fraction(1)
    if ends == "rest":
        return zero, one, zero, zero
    if ends == "natural":
        return zero, 2 * one, one, 3 * m[0]
    if len(h) == 1:
        return zero, one, zero, m[0]
    if len(h) == 2:
        return zero, one, one, 2 * m[0]
    d = h[0] + h[1]
    return zero, h[1], d, ((h[0] + 2 * d) * h[1] * m[0] + h[0] ** 2 * m[1]) / d


def _tridiagonal(rows: Sequence[tuple[Fraction, Fraction, Fraction, Fraction]]) -> list[Fraction]:
    """x of  below x_k-1 + own x_k + above x_k+1 = right."""
    above, right = [Fraction(0)], [Fraction(0)]
    for below, own, next_, value in rows:
        pivot = own - below * above[-1]
        above.append(_rounded(next_ / pivot))
        right.append(_rounded((value - below * right[-1]) / pivot))
    x = [Fraction(0)]
    for factor, value in zip(reversed(above[1:]), reversed(right[1:]), strict=True):
        x.append(_rounded(value - factor * x[-1]))
    return x[:0:-1]


def _rounded(a: Fraction) -> Fraction:
    """A number; if it has grown long, the nearest multiple of 2^-300 (1e-90), to which f'' is then continuous."""
    return a if a.denominator.bit_length() <= LONGEST else Fraction(round(a * 2**300), 2**300)
