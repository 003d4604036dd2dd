"""Round bodies in space: where each of them comes nearest to a plane.

The place nearest to a plane is the one farthest against its normal n. From the centre it is `reach` away, and the
centre then is `height` = - n . reach above the plane:

    ball         reach = - R n                                 height = R
    wheel        reach = - R (n - (n.a) a) / rho - r n         height = R rho + r,   rho = |n x a|
    ellipsoid    reach = - A n / h                             height = h = sqrt(n . A n)

with a wheel's axis a and the radius r of its tyre (0: a thin disc), A = R_B diag(a^2, b^2, c^2) R_B^T. As the place
is an extreme one, it may wander in the body, and the gap's rate is still n . v of the material points in contact.
"""

from __future__ import annotations

from eomgen.errors import ModelError
from eomgen.model.forces.load import LoadContext
from eomgen.model.joints.base import unit
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import readable
from eomgen.symbolic.expression.functions import cos, over, sin, sqrt
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.spatial import AnyScalar, Vector, apply, cross, dot, minus, plus, times, transposed
from eomgen.symbolic.numeric.tolerances import DEGENERATE
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size

LONGEST = 400  # characters of a cosine that is multiplied out


@dataclass(frozen=True)
class Nearest:
    """The place of a round body that is nearest to a plane.

    Args:
        reach: from the body's centre to it, ground axes [m].
        height: of the centre above the plane through it [m].
    """

    reach: Vector
    height: AnyScalar


@dataclass(frozen=True)
class RollingBall:
    """A ball of radius R."""

    R: AnyScalar

    def nearest(self, scene: LoadContext, n: Vector) -> Nearest:
        """R below the centre."""
        return Nearest(times(-self.R, n), self.R)


@dataclass(frozen=True)
class Wheel:
    """A thin disc of radius R about `axis` (body axes), or the centre line of a tyre of radius `tube`."""

    body: str
    axis: Vector
    R: AnyScalar
    tube: AnyScalar

    def nearest(self, scene: LoadContext, n: Vector) -> Nearest:
        """The lowest place of the rim.

        Raises:
            ModelError: the wheel lies flat at the start, where the whole rim touches.
        """
        a, rho = self._axle(scene), self.tilt(scene, n)
        if abs(_worth(scene, rho)) < DEGENERATE:
            raise ModelError(
                f"'{self.body}' lies flat at the start: its whole rim touches",
                scene.where,
                "start it upright or leaning; an axis along the normal has no lowest point",
            )
        down = times(over(-self.R, rho), cross(a, cross(n, a)))
        return Nearest(minus(down, times(self.tube, n)), self.R * rho + self.tube)

    def nearest_to_ball(self, scene: LoadContext, out: Vector, side: int) -> Vector:
        """From the wheel's centre to the place of its centre line nearest to a ball's centre; from inside the farthest.

        -+ R h / |h|,  h = d - (d . a) a,  d from the ball's centre to the wheel's.

        Raises:
            ModelError: its axis points to the ball's centre at the start, where the whole rim touches.
        """
        h, size = self._across(scene, out), self.distance(scene, out)
        if abs(_worth(scene, size)) < DEGENERATE * abs(_worth(scene, self.R)):
            raise ModelError(
                f"the axis of '{self.body}' points to the ball's centre: its whole rim touches",
                scene.where,
                "start it leaning",
            )
        return times(over(-side * self.R, size), h)

    def distance(self, scene: LoadContext, out: Vector) -> AnyScalar:
        """|h|, of a ball's centre from the wheel's axis [m]; 0 where the whole rim touches."""
        h = self._across(scene, out)
        return sqrt(_short(dot(h, h)))

    def _across(self, scene: LoadContext, out: Vector) -> Vector:
        a = self._axle(scene)
        return minus(out, times(dot(out, a), a))

    def tilt(self, scene: LoadContext, n: Vector) -> AnyScalar:
        """rho = |n x a|, the sine of the angle between its axis and n; 0 where it lies flat."""
        a = self._axle(scene)
        k = cross(n, a)
        wave = _other_wave(scene, _short(dot(n, a)))
        return sqrt(dot(k, k)) if wave is None else wave

    def _axle(self, scene: LoadContext) -> Vector:
        return apply(scene.orientation(self.body), unit(self.axis))


@dataclass(frozen=True)
class Egg:
    """An ellipsoid with its semiaxes along the body's axes."""

    body: str
    semiaxes: Vector

    def nearest(self, scene: LoadContext, n: Vector) -> Nearest:
        """The place of the surface at which n is its inner normal."""
        R = scene.orientation(self.body)
        n_B = apply(transposed(R), n)
        x, y, z = (s * s * k for s, k in zip(self.semiaxes, n_B, strict=True))
        h = sqrt(dot(n_B, (x, y, z)))
        return Nearest(apply(R, times(over(-1, h), (x, y, z))), h)


Round = RollingBall | Wheel | Egg


def laid_in(scene: LoadContext, n: Vector) -> tuple[Vector, Vector]:
    """Two directions in the plane across the unit vector n: x laid into the plane (y where n is along x), and n x it.

    So (t, s) is (x, y) on a level floor, and t points down a slope about y.
    """
    x, y, z = n
    if _plain(y) and _plain(z):
        t: Vector = (0, 1, 0)
    elif _plain(y):
        t = times(_sense(scene, z), (z, 0, -x))
    elif _plain(z):
        t = times(_sense(scene, y), (y, -x, 0))
    else:
        root = complement(scene, x)
        t = (root, -over(x * y, root), -over(x * z, root)) if not _plain(x) else (1, 0, 0)
    return t, cross(n, t)


def turned_over(scene: LoadContext, n: Vector) -> tuple[Vector, Vector]:
    """Two directions across a unit vector n that moves: those that come along when e turns into n the shortest way.

    t_i = e_i - (n . e_i) (n + e) / (1 + n . e), e the axis of the ground nearest to n at the start. Opposite to e,
    and only there, they are not determined.
    """
    k, sense = _nearest_axis(scene, n)
    axes: tuple[Vector, ...] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    e = times(sense, axes[k])
    first = axes[(k + 1) % 3]
    middle = plus(n, e)
    share = over(1, 1 + dot(n, e))
    t, s = (minus(d, times(dot(n, d) * share, middle)) for d in (first, cross(e, first)))
    return t, s


def _nearest_axis(scene: LoadContext, n: Vector) -> tuple[int, int]:
    """(which axis, +1 or -1); z where nobody knows."""
    sizes = [_worth(scene, x, unknown=0.0) for x in n]
    k = max((2, 1, 0), key=lambda i: abs(sizes[i]))
    return k, -1 if sizes[k] < 0 else 1


def complement(scene: LoadContext, x: AnyScalar) -> AnyScalar:
    """sqrt(1 - x^2)."""
    x = _short(x)
    wave = _other_wave(scene, x)
    return sqrt(1 - x * x) if wave is None else wave


def _short(x: AnyScalar) -> AnyScalar:
    """x multiplied out, where it is no long sum: a cosine that is written by those of two angles."""
    return readable(x, Work.PART) if type(x) is Node and text_size(x) <= LONGEST else x


def _other_wave(scene: LoadContext, x: AnyScalar) -> AnyScalar | None:
    """sqrt(1 - x^2) of a sine or a cosine: the cosine or sine, in the sense that it has at the start; else None."""
    if type(x) is Node and x.op == "neg":
        return _other_wave(scene, x.args[0])
    if type(x) is not Node or x.op not in ("sin", "cos"):
        return None
    found: AnyScalar = cos(x.args[0]) if x.op == "sin" else sin(x.args[0])
    return -found if _sense(scene, found) < 0 else found


def _sense(scene: LoadContext, x: AnyScalar) -> int:
    return -1 if _worth(scene, x) < 0 else 1


def _worth(scene: LoadContext, x: AnyScalar, unknown: float = 1.0) -> float:
    """What x is at the start with the model's values."""
    found = scene.worth(x)
    return unknown if found is None else found


def _plain(x: AnyScalar) -> bool:
    return type(x) is int and x == 0
