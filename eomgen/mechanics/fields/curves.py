"""Possible, a moving place -> Curve: on what line it runs, recognised exactly by rates that vanish along every motion.

at rest: c' = 0;   straight: c' x c'' = 0;
a circle: the centre of curvature stays, c + |c'|^2 (c' x c'') x c' / |c' x c''|^2
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from eomgen.errors import DerivationError
from eomgen.mechanics.fields.possible import Possible
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.functions import over, sqrt
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector, cross, dot, plus, times, vector_of
from eomgen.symbolic.numeric.work import Work

TRIED = (Fraction(0), Fraction(1), Fraction(1, 2), Fraction(2))  # values of what a constant does not depend on


@dataclass(frozen=True)
class Curve:
    """The line on which a place runs.

    Args:
        kind: "point", "line", "circle" or "curve".
        at: the point, a point of the line, the centre of the circle; None where it has no closed form.
        along: the direction of the line; of a circle the axis across it.
        radius: of the circle.
    """

    kind: str
    at: Vector | None = None
    along: Vector | None = None
    radius: Scalar | None = None


@dataclass(frozen=True)
class Constants:
    """Puts what is known to be constant into closed form.

    Args:
        possible: the motions along which it is constant.
        start: an exact state of the motion, or {}.
        positive: symbols that stand for positive numbers.
    """

    possible: Possible
    start: Mapping[Node, Scalar]
    positive: frozenset[Node]

    def of(self, x: Scalar) -> Scalar | None:
        """The constant as a function of the parameters; None where it has no closed form."""
        moving = self._moving
        x = simplest(x, Work.VALUE, self.positive)
        if not depends_on(x, moving):
            return x
        for state in self._states(moving):
            try:
                found = simplest(substituted((x,), state)[0], Work.VALUE, self.positive)
            except DerivationError:  # a division by zero there
                continue
            if not depends_on(found, moving):
                return found
        return None

    def vector(self, x: Vector) -> Vector | None:
        """The same of the components."""
        found = [value for each in x if (value := self.of(each)) is not None]
        return vector_of(found) if len(found) == 3 else None

    def length(self, x: Vector) -> Scalar | None:
        """The same of the length of a vector that may turn: of its components where they are short."""
        moving = self._moving
        for state in self._states(moving):
            try:
                there = vector_of([simplest(each, Work.VALUE, self.positive) for each in substituted(x, state)])
            except DerivationError:  # a division by zero there
                continue
            if not any(depends_on(each, moving) for each in there):
                return simplest(sqrt(dot(there, there)), Work.VALUE, self.positive)
        return self.of(sqrt(dot(x, x)))

    def some_place(self, place: Vector) -> Vector | None:
        """A place on the way of one that moves, as functions of the parameters: where it is at the start, if known."""
        symbols = self.possible.system.symbols
        moving = (symbols.t, *symbols.q, *symbols.u, *symbols.a)
        for state in self._states(moving):
            x, y, z = (simplest(x, Work.VALUE, self.positive) for x in substituted(place, state))
            if not any(depends_on(each, moving) for each in (x, y, z)):
                return (x, y, z)
        return None

    @property
    def _moving(self) -> tuple[Node, ...]:
        symbols = self.possible.system.symbols
        return (symbols.t, *symbols.q, *symbols.u, *symbols.a, *self.possible.jerks)

    def _states(self, moving: tuple[Node, ...]) -> Iterator[dict[Node, Scalar]]:
        """Exact states: those with the coordinates of the start, and where nothing ties them any others."""
        symbols = self.possible.system.symbols
        of_place = (symbols.t, *symbols.q)
        rates = [x for x in moving if x not in of_place]
        tied = bool(self.possible.system.ties.closing) or self.possible.system.free is not None
        for value in TRIED[1:]:
            if all(q in self.start for q in symbols.q):
                yield {**{x: self.start.get(x, 0) for x in of_place}, **dict.fromkeys(rates, value)}
        if not tied:
            for value in TRIED:
                yield {**dict.fromkeys(of_place, value), **dict.fromkeys(rates, 1)}


def curve_of(place: Vector, possible: Possible, constants: Constants) -> Curve:
    """The line on which a place runs that depends on coordinates and t."""
    v = possible.rate_of(place)
    if possible.vanish(*v):
        return Curve("point", constants.vector(place))
    a = possible.rate_of(v)
    n = cross(v, a)
    if possible.vanish(*n):
        return Curve("line", constants.some_place(place), _direction(v, possible, constants))
    arm = _arm(v, a)
    center = plus(place, arm)
    if possible.vanish(*possible.rate_of(center), *_turning(n, possible)):
        return Curve("circle", constants.vector(center), _direction(n, possible, constants), constants.length(arm))
    return Curve("curve")


def _arm(v: Vector, a: Vector) -> Vector:
    """From a point with velocity v and acceleration a to the centre of curvature of its way."""
    n = cross(v, a)
    return times(over(dot(v, v), dot(n, n)), cross(n, v))


def _direction(v: Vector, possible: Possible, constants: Constants) -> Vector | None:
    """A constant vector along v: over its first component that does not vanish."""
    for component in v:
        if not possible.vanish(component):
            return constants.vector(times(over(1, component), v))
    return None


def _turning(n: Vector, possible: Possible) -> tuple[Scalar, ...]:
    """What vanishes where the direction of n stays: n x n'."""
    return cross(n, possible.rate_of(n)) if not possible.vanish(n[0], n[1]) else ()
