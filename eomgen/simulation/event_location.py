"""Functions of the state -> the instant at which the first of them changes sign, within one step of an integrator."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import field, replace
from functools import cache, cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from eomgen.codegen import RateFunction, RightHandSide
from eomgen.frozen import dataclass
from eomgen.symbolic.numeric import tolerances

PARTS = 8  # of a step: how often the functions are looked at
MOST_PARTS = 4096  # of a step in which a function goes up and down many times
RESOLVED = 0.02  # of a function's largest value in a step: so near a polynomial comes to what lies between looks
NODES, DEGREE = 40, 16  # of the polynomial around an event
SMALLER = 8  # times, the second window around an event
ORDER = 0.05  # of the largest value nearby: the derivative that shows the order of a root is larger
MOST_ORDER = 5  # of a root
NEARBY = 0.5  # of the window: how far the root may be from where it was seen
NEWTON_STEPS = 6
LOOKED_OUT = -1  # the index of a crossing that a lookout found
EDGE = 1e-3  # of a part: so near to the ends of a step they are looked at too, so that no extremum hides there
TOUCH = 100.0  # relative tolerances of a step; so near to zero, against its largest value, a function touches it
RELATIVE = 4 * np.finfo(float).eps  # of the instant of an event, and one part in 1e12 of the step


@dataclass(frozen=True)
class Measured:
    """(t n, x n x states) -> the outputs of a function at parameters p, n x outputs."""

    function: RightHandSide
    p: np.ndarray

    def __call__(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        if len(x) == 1 and np.ndim(t):
            return self._one(t[0], x[0])[None, :]
        return self.function.many(t, x, self.p)

    def at(self, p: np.ndarray) -> Measured:
        """The same at other values of the parameters."""
        return replace(self, p=p)

    @cached_property
    def _one(self) -> RateFunction:
        return self.function.at(self.p)


@dataclass(frozen=True)
class Events:
    """Functions that end a run where they fall to zero, or (`either`) where they reach zero from either side.

    A function must first have been above its floor: one that starts at zero (a gap that has just opened) ends nothing
    until it was positive, unless it falls below minus its floor first. One that counts from either side also ends a run
    where it touches zero and turns back, like a speed.

    Args:
        values: (t n, x n x states) -> n x k.
        floors: rounding error of each function, k; of those that count from either side an upper bound.
        either: the indices of those that count from either side.
        touch: distance from zero that counts as a touch of these, relative to their largest value.
        measured: the same values as a function that there is in C; None where there is none.
    """

    values: Callable[[np.ndarray, np.ndarray], np.ndarray]
    floors: np.ndarray
    either: tuple[int, ...] = ()
    touch: float = tolerances.CARRIED
    measured: Measured | None = None


@dataclass(frozen=True)
class Crossing:
    """An event: function `index` of Events reached zero at t, in the state x."""

    index: int
    t: float
    x: np.ndarray


@dataclass
class EventSearch:
    """Follows the functions of `events` from step to step.

    Args:
        seen: instants of the step -> the functions there, where there is a quicker way than by its states.
        signs: factor of each function with which it falls; 0 where that is not known yet.
        armed: those that have been above their floor.
        largest: their largest absolute values so far.
    """

    events: Events
    t: float
    x: np.ndarray
    seen: Callable[[np.ndarray], np.ndarray] | None = None
    signs: np.ndarray = field(init=False)
    armed: np.ndarray = field(init=False)
    largest: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        g = self.events.values(np.array([self.t]), self.x[None, :])[0]
        self.signs = np.ones(len(g))
        self.signs[list(self.events.either)] = 0.0
        self.armed = self.signs * g > self.events.floors
        self.largest = np.abs(g)

    def _direct(self, g: np.ndarray, floors: np.ndarray) -> None:
        """Functions that count from either side fall from the side on which they first are."""
        new = (self.signs == 0) & (np.abs(g) > floors)
        self.signs[new] = np.sign(g[new])

    def _floors(self) -> np.ndarray:
        """Rounding errors of the functions; where both signs count, a share of the largest value so far."""
        floors, either = self.events.floors.copy(), list(self.events.either)
        floors[either] = np.minimum(floors[either], tolerances.ITERATED * self.largest[either])
        return floors

    def step(self, t_old: float, t_new: float, dense: Callable[[Any], np.ndarray]) -> Crossing | None:
        """The first crossing in the step from t_old to t_new; `dense` gives the state at instants in it."""
        times, g = self._looked(t_old, t_new, dense)
        self.largest = np.maximum(self.largest, np.nan_to_num(np.abs(g)).max(axis=0))
        floors = self._floors()
        for row in g:
            self._direct(row, floors)
        self.armed |= (self.signs * g[0] > floors) & (np.abs(self.signs) > 0)
        found = [
            root
            for k in range(g.shape[1])
            if (root := self._first(k, floors[k], times, self.signs[k] * g[:, k], dense)) is not None
        ]
        if not found:
            return None
        t, index = min(found)
        return Crossing(index, t, dense(t))

    def _looked(self, t_old: float, t_new: float, dense: Callable[[Any], np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """(instants of a step, the functions there): so many that those of either side are resolved between them."""
        parts, either = PARTS, list(self.events.either)
        times = _looks(t_old, t_new, parts)
        g = self._at(times, dense)
        while either and parts < MOST_PARTS and not _is_resolved(g[:, either]):
            parts *= 2
            times = _looks(t_old, t_new, parts)
            g = self._at(times, dense)
        return times, g

    def _at(self, times: np.ndarray, dense: Callable[[Any], np.ndarray]) -> np.ndarray:
        """The functions at instants of the step, n x k."""
        return self.seen(times) if self.seen is not None else self.events.values(times, dense(times).T)

    def _first(
        self, k: int, floor: float, times: np.ndarray, g: np.ndarray, dense: Callable[[Any], Any]
    ) -> tuple[float, int] | None:
        """The first time at which function k crosses, and k."""
        sign = float(self.signs[k])
        touch = self.events.touch * self.largest[k] if k in self.events.either else None

        def value(t: float, level: float = 0.0) -> float:
            return float(sign * self._at(np.array([t]), dense)[0, k]) - level

        for i in range(1, len(times)):
            if self.armed[k]:
                low = _low(value, times[max(i - 2, 0) : i + 1], g[max(i - 2, 0) : i + 1], closely=touch is not None)
                if low is not None and low[1] < 0:
                    return _root(value, times[i - 2], low[0]), k
                if low is not None and touch is not None and low[1] <= touch:
                    return low[0], k
                if g[i] <= 0:
                    return _root(value, times[i - 1], times[i]), k
            elif g[i] < -floor:
                return _root(lambda t: value(t, -floor), times[i - 1], times[i]), k
            elif g[i] > floor:
                self.armed[k] = True
        return None


def _looks(t_old: float, t_new: float, parts: int) -> np.ndarray:
    """The instants of a step at which the functions are looked at."""
    inner = np.linspace(t_old, t_new, parts + 1)
    near = EDGE * (t_new - t_old) / parts
    return np.concatenate([inner[:1], [t_old + near], inner[1:-1], [t_new - near], inner[-1:]])


def _is_resolved(g: np.ndarray) -> bool:
    """True if polynomials through every second sample, eight parts each, give the samples between."""
    inner = np.delete(g, [1, len(g) - 2], axis=0)
    windows = np.stack([inner[i : i + PARTS + 1] for i in range(0, len(inner) - 1, PARTS)])
    guessed = np.einsum("ij,wjk->wik", _BETWEEN, windows[:, ::2])
    return bool(np.all(np.abs(guessed - windows[:, 1::2]) <= RESOLVED * np.max(np.abs(g), axis=0)))


def _between() -> np.ndarray:
    """Values of the polynomial through 0, 2, 4, ... PARTS at 1, 3, ..., by its values there."""
    at, known = np.arange(1, PARTS, 2), np.arange(0, PARTS + 1, 2)
    return np.linalg.solve(np.vander(known / PARTS).T, np.vander(at / PARTS, len(known)).T).T


_BETWEEN = _between()


def _low(value: Callable[[float], float], t: np.ndarray, g: np.ndarray, *, closely: bool) -> tuple[float, float] | None:
    """(where, how low) between three positive values the middle one of which is the least; None where they are not so.

    Unless `closely` is set, the search is made only where the parabola through the three comes near to 0.
    """
    if len(t) < 3 or not (g > 0).all() or not (g[1] <= g[0] and g[1] <= g[2]):
        return None
    if not closely and _vertex(t, g) > 0.5 * g[1]:
        return None
    from scipy.optimize import minimize_scalar

    options = {
        "xatol": tolerances.ITERATED * (t[2] - t[0])
    }  # from the middle: the search knows its unknown to half of the digits
    least = minimize_scalar(
        lambda z: value(t[1] + z), bounds=(t[0] - t[1], t[2] - t[1]), method="bounded", options=options
    )
    return float(t[1] + least.x), float(least.fun)


def _vertex(t: np.ndarray, g: np.ndarray) -> float:
    """The least value of the parabola through three points, the middle one of which is the least."""
    before, after = np.diff(g) / np.diff(t)
    curvature = (after - before) / (t[2] - t[0])
    slope = (before * (t[2] - t[1]) + after * (t[1] - t[0])) / (t[2] - t[0])
    return float(g[1] - slope**2 / (4 * curvature)) if curvature > 0 else float(g[1])


def _root(value: Callable[[float], float], before: float, after: float) -> float:
    """Root of a function between two instants, or just past it, where the function is no longer above 0."""
    from scipy.optimize import brentq

    if not value(before) > 0:
        return before
    if not value(after) < 0:
        return after
    xtol = tolerances.SOLVED * (after - before)
    root = float(brentq(value, before, after, xtol=xtol, rtol=RELATIVE))
    step = float(xtol + RELATIVE * abs(root))
    while root < after and value(root) > 0:
        root, step = min(float(after), root + step), 2 * step
    return root


# -- as exactly as the motion is known ---------------------------------------------------------------


def sharpened(
    search: EventSearch, found: Crossing, width: float, carry: Callable[[np.ndarray], np.ndarray]
) -> Crossing:
    """A crossing of a function that counts from either side, by states at which steps end.

    Around a root of order m the derivative of order m - 1 goes straight through zero: of a polynomial through g on
    both sides. What only touches zero in an edge, |v|, is one with its sign turned beyond it.

    Args:
        width: length of the interval before and after in which the motion is sampled.
        carry: instants -> states, one a row.
    """
    events = search.events
    if found.index not in events.either:
        return found
    known = events.touch / TOUCH * float(search.largest[found.index])
    for w in (width, width / SMALLER):
        nodes = w * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)[::-1]
        with np.errstate(all="ignore"):
            g = events.values(found.t + nodes, carry(found.t + nodes))[:, found.index]
        root = _root_within(nodes / w, g, known) if np.all(np.isfinite(g)) else None
        if root is not None:
            t = found.t + w * root
            return Crossing(found.index, t, carry(np.array([t]))[0])
    return found


def _root_within(z: np.ndarray, g: np.ndarray, known: float) -> float | None:
    """The root near 0, of any order, of a function by its values in -1 < z < 1; None where no polynomial fits.

    Args:
        known: to within which the function is known.
    """
    from numpy.polynomial.chebyshev import Chebyshev

    size = float(np.max(np.abs(g)))
    fits = [Chebyshev.fit(z, values, DEGREE, domain=[-1, 1]) for values in (g, np.sign(z) * g)]
    apart = [float(np.max(np.abs(np.abs(fit(z)) - np.abs(g)))) for fit in fits]
    best = fits[int(np.argmin(apart))]
    if not 0 < size or min(apart) > tolerances.COMPUTED * size:
        return None
    noise = max(known, min(apart)) / size
    slopes = [best, *(best.deriv(order) for order in range(1, MOST_ORDER + 1))]
    for order in range(MOST_ORDER, 0, -1):
        root = _newton(slopes[order - 1], slopes[order])
        if root is not None and _is_of_order(order, [float(f(root)) / size for f in slopes], noise):
            return root
    return None


def _is_of_order(order: int, slopes: Sequence[float], known: float) -> bool:
    """True if `order` roots cannot be distinguished from one, where a function of largest value 1 is known to `known`.

    With a_k = g^(k)/k! and a_m r^m = known they lie within r, where |a_k| r^k <= known for all k < m.
    """
    if abs(slopes[order]) <= ORDER:
        return False
    a = [abs(slope) / math.factorial(k) for k, slope in enumerate(slopes)]
    r = (known / a[order]) ** (1 / order)
    return all(a[k] * r**k <= known for k in range(order - 1))


def _newton(g: Any, slope: Any) -> float | None:
    """The root of g to which Newton's method leads from 0; None where it leads to none nearby."""
    z = 0.0
    for _ in range(NEWTON_STEPS):
        step = float(g(z) / slope(z))
        z -= step
        if not abs(z) < NEARBY:
            return None
        if abs(step) < tolerances.SOLVED:
            break
    return z


# -------- curves ----------------------------------------------------------------------------------------------
# A function of one variable -> polynomials that are it piece by piece: extremes, zeros and integrals between samples.
#
#     g(t) = sum of c_k T_k(s),   s = (2 t - a - b)/(b - a)   in each piece a < t < b
#
# A piece whose last coefficients do not vanish is halved: what is smooth needs few, a kink or a jump is enclosed.


DEGREE = 16
FINE = 4 * DEGREE  # parts of a piece in which extremes and zeros are sought
LAST = 3  # coefficients that vanish where a piece is resolved
MOST_HALVINGS = 50
MOST_PIECES = 200_000

Curve = Callable[[np.ndarray], np.ndarray]


def nodes_between(edges: np.ndarray, degree: int = DEGREE) -> np.ndarray:
    """The extremes of T_n in each piece, both ends among them: pieces x (n + 1), ascending."""
    s = -np.cos(np.pi * np.arange(degree + 1) / degree)
    a, b = edges[:-1, None], edges[1:, None]
    found: np.ndarray = (a + b) / 2 + (b - a) / 2 * s
    found[:, 0], found[:, -1] = edges[:-1], edges[1:]
    return found


@cache
def transform(degree: int) -> np.ndarray:
    """Values at the nodes -> coefficients."""
    s = -np.cos(np.pi * np.arange(degree + 1) / degree)
    return np.asarray(np.linalg.inv(chebyshev.chebvander(s, degree)))


@dataclass(frozen=True)
class ChebyshevPieces:
    """A function, resolved.

    Args:
        g: itself, t n -> n.
        a, b: the ends of the pieces, ascending.
        c: coefficients of each, pieces x (DEGREE + 1).
    """

    g: Curve
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray

    def extreme(self, sign: int) -> tuple[float, float]:
        """(the largest value of sign * g times sign, where)."""
        values = self._looked
        size = np.nanmax(np.abs(values), initial=0.0)
        high = sign * values
        best = np.nanmax(high)
        # between two looks a polynomial of this degree rises by less than a tenth of its change nearby
        change = np.nanmax(high, axis=1) - np.nanmin(high, axis=1)
        candidates = np.flatnonzero(np.nanmax(high, axis=1) + change / 10 >= best - tolerances.SOLVED * size)
        found = [self._peak(int(k), sign) for k in candidates]
        k = int(np.nanargmax([sign * value for value, _ in found]))
        return found[k]

    def _peak(self, k: int, sign: int) -> tuple[float, float]:
        """The largest value in one piece: at an end, or where the polynomial's derivative vanishes."""
        roots = _roots(chebyshev.chebder(self.c[k]))
        t = np.concatenate([[self.a[k], self.b[k]], self._time(k, roots)])
        values = self.g(t)
        best = int(np.nanargmax(sign * values))
        return float(values[best]), float(t[best])

    def zeros(self) -> list[tuple[float, int]]:
        """(where it changes its sign, +1 where it rises), ascending."""
        flat, times = self._looked.ravel(), nodes_between_each(self.a, self.b, FINE).ravel()
        floor = tolerances.SOLVED * np.nanmax(np.abs(flat), initial=0.0)
        signs = np.where(np.abs(flat) <= floor, 0, np.sign(flat))
        standing = np.flatnonzero(signs != 0)
        found = []
        for i, j in pairwise(standing.tolist()):
            if signs[i] != signs[j]:
                found.append((self._zero(times[i], times[j]), int(signs[j])))
        return found

    def _zero(self, before: float, after: float) -> float:
        from scipy.optimize import brentq

        low, high = self.g(np.array([before, after]))
        if not low * high < 0:  # the polynomial's own zero, as near to that of the function as it is resolved
            return float(before + after) / 2
        return float(
            brentq(
                lambda t: float(self.g(np.array([t]))[0]), before, after, xtol=tolerances.BEST, rtol=4 * tolerances.BEST
            )
        )

    def integral(self) -> float:
        """Over all pieces: of T_k over -1 < s < 1 it is 2/(1 - k^2) for even k, else 0."""
        k = np.arange(0, self.c.shape[1], 2)
        return float(np.sum((self.c[:, ::2] @ (2.0 / (1.0 - k**2))) * (self.b - self.a) / 2))

    @property
    def _looked(self) -> np.ndarray:
        """Values of the polynomials, pieces x looks."""
        s = -np.cos(np.pi * np.arange(FINE + 1) / FINE)
        return np.asarray(self.c @ chebyshev.chebvander(s, self.c.shape[1] - 1).T)

    def _time(self, k: int, s: np.ndarray) -> np.ndarray:
        return np.asarray((self.a[k] + self.b[k]) / 2 + (self.b[k] - self.a[k]) / 2 * s)


def nodes_between_each(a: np.ndarray, b: np.ndarray, degree: int) -> np.ndarray:
    """The nodes of `nodes_between`, for pieces that need not follow one another."""
    s = -np.cos(np.pi * np.arange(degree + 1) / degree)
    found: np.ndarray = ((a + b) / 2)[:, None] + ((b - a) / 2)[:, None] * s
    found[:, 0], found[:, -1] = a, b
    return found


def _roots(c: np.ndarray) -> np.ndarray:
    """The real roots in -1 < s < 1 of a sum of T_k."""
    size = np.max(np.abs(c), initial=0.0)
    c = chebyshev.chebtrim(c, tolerances.SOLVED * size)
    if len(c) < 2 or not np.isfinite(size):
        return np.zeros(0)
    roots = chebyshev.chebroots(c)
    return np.asarray(roots.real[(np.abs(roots.imag) < tolerances.CARRIED) & (np.abs(roots.real) < 1)])


def resolved_curve(g: Curve, edges: np.ndarray) -> ChebyshevPieces:
    """A function between the edges, halved until polynomials are it; nan where it has no value in a piece.

    Args:
        g: t n -> n.
        edges: where it may have a kink, ascending.
    """
    a, b = edges[:-1], edges[1:]
    above = np.full(len(a), np.inf)
    done: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    size, narrow, count = 0.0, tolerances.SOLVED * float(edges[-1] - edges[0]), 0
    for halving in range(MOST_HALVINGS + 1):
        t = nodes_between_each(a, b, DEGREE)
        values = g(t.ravel()).reshape(t.shape)
        size = max(size, float(np.nanmax(np.abs(values), initial=0.0)))
        c = values @ transform(DEGREE).T
        left = np.abs(c[:, -LAST:]).max(axis=1)
        noisy = (left <= tolerances.CARRIED * size) & (left > above / 1.5)
        enough = (left <= tolerances.ITERATED * size) | noisy | (b - a <= narrow) | ~np.isfinite(left)
        count += len(a)
        if halving == MOST_HALVINGS or count > MOST_PIECES:
            enough[:] = True
        rough = ~(left <= tolerances.CARRIED * size)
        c[rough] = 0.0  # a jump, or too many to be halved: a straight line from end to end
        c[rough, 0], c[rough, 1] = (
            (values[rough, 0] + values[rough, -1]) / 2,
            (values[rough, -1] - values[rough, 0]) / 2,
        )
        done.append((a[enough], b[enough], c[enough]))
        if enough.all():
            break
        a, b, left = a[~enough], b[~enough], left[~enough]
        middle = (a + b) / 2
        a, b = np.column_stack([a, middle]).ravel(), np.column_stack([middle, b]).ravel()
        above = np.repeat(left, 2)
    starts, ends, coefficients = (np.concatenate(parts) for parts in zip(*done, strict=True))
    order = np.argsort(starts, kind="stable")
    return ChebyshevPieces(g, starts[order], ends[order], coefficients[order])
