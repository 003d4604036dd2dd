"""Inertia tensor -> principal moments and axes, exact wherever they have a closed form; tensors of several bodies."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import cache, cached_property, cmp_to_key, partial

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics.motion import Motion
from eomgen.mechanics.kinematics.symbols import Scope
from eomgen.model import InertiaMatrix, MassProperties
from eomgen.symbolic.exact import common_factor, roots, sign_of_terms, simplest, vanishes
from eomgen.symbolic.expression import (
    Fraction,
    Matrix,
    Node,
    Pose,
    Scalar,
    State,
    Vector,
    cos,
    function,
    is_zero,
    order,
    over,
    sqrt,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import Work, number_of
from eomgen.symbolic.print import text_size

# -------- principal -------------------------------------------------------------------------------------------
# Inertia tensor -> principal moments and axes, exact wherever they have a closed form.
#
#     det(I - J 1) = 0,  R I R^T = diag(J_1, J_2, J_3):  the rows of R are the principal axes, right-handed
#
# A tensor with two products that vanish splits: its moments are J_kk and, with D^2 = (a - b)^2 + 4 p^2, (a + b -+
# D)/2; the axis of the larger one has the components sqrt((D + a - b) / 2D) and +- sqrt((D - a + b) / 2D). Else the
# characteristic polynomial is split into factors; where it has none, its three real roots are
#
#     J = q + 2 p cos((f + 2 pi k) / 3),  q = tr(I) / 3,  p^2 = tr((I - q 1)^2) / 6,  cos f = det(I - q 1) / (2 p^3).


TERMS = 60  # of a sum that is made short; a longer one nobody reads
LONGEST = 3_000  # characters of a tensor whose characteristic polynomial may have factors
HALF = Fraction(1, 2)
PrincipalMoments = tuple[Scalar, Scalar, Scalar]


@dataclass(frozen=True)
class Principal:
    """The principal moments and axes of a tensor.

    Args:
        moments: ascending where `sorted`, [kg m^2].
        axes: the rows of R, unit vectors, right-handed; None where they have no closed form.
        sorted: whether the order of the moments is known.
        equal: pairs (k, l) of moments that are equal: every axis in their plane is principal.
    """

    moments: PrincipalMoments
    axes: Matrix | None
    sorted: bool
    equal: tuple[tuple[int, int], ...]

    @staticmethod
    def of(I: Matrix, scope: Scope) -> Principal:
        """The principal moments with their axes."""
        tensor = _Tensor(I, scope)
        ascending = _ascending(tensor)
        moments = tensor.moments if ascending is None else Vector(tensor.moments[k] for k in ascending)
        pairs = tuple((k, n) for k, n in ((0, 1), (1, 2), (0, 2)) if vanishes(moments[k] - moments[n]))
        return Principal(moments, tensor.axes(Vector(moments), pairs), ascending is not None, pairs)

    @staticmethod
    def ascending(I: Matrix, scope: Scope) -> PrincipalMoments:
        """The principal moments, ascending; by min and max where their order depends on the values of the symbols."""
        tensor = _Tensor(I, scope)
        found = tensor.moments
        ascending = _ascending(tensor)
        if ascending is not None:
            return Vector(found[k] for k in ascending)
        for k in range(3):
            signs = {tensor.larger(k, n) for n in range(3) if n != k}
            one, other = (found[n] for n in range(3) if n != k)
            pair = function("min", one, other), function("max", one, other)
            if signs <= {0, 1}:
                return (*pair, found[k])
            if signs <= {0, -1}:
                return (found[k], *pair)
        least, most = (function(name, function(name, found[0], found[1]), found[2]) for name in ("min", "max"))
        return least, found[0] + found[1] + found[2] - least - most, most


@dataclass(frozen=True)
class _Tensor:
    """A symmetric tensor over the scalars of a scope."""

    given: Matrix
    scope: Scope

    def short(self, x: Scalar) -> Scalar:
        return short_form(x, self.scope.positive)

    @cached_property
    def tensor(self) -> Matrix:
        """The tensor in short form, what vanishes as 0."""
        I = self.given
        upper = {(i, j): 0 if vanishes(I[i][j]) else self.short(I[i][j]) for i in range(3) for j in range(i, 3)}
        return Matrix.of((upper[min(i, j), max(i, j)] for j in range(3)) for i in range(3))

    @property
    def linked(self) -> list[tuple[int, int]]:
        """The pairs of axes whose product of inertia does not vanish."""
        return [(i, j) for i, j in ((0, 1), (1, 2), (0, 2)) if not is_zero(self.tensor[i][j])]

    @property
    def moments(self) -> PrincipalMoments:
        """The principal moments; ascending where `is_ordered`, else in no order."""
        return self._moments[0]

    @property
    def is_ordered(self) -> bool:
        """True if the moments are given as the three cosines of the cubic, the smallest first."""
        return self._moments[1]

    @cached_property
    def _moments(self) -> tuple[PrincipalMoments, bool]:
        I = self.tensor
        if not self.linked:
            return (I[0][0], I[1][1], I[2][2]), False
        if len(self.linked) == 1:
            ((i, j),) = self.linked
            return (I[3 - i - j][3 - i - j], *self._halves(I[i][i] + I[j][j], self._spread)), False
        rational = self._cubic(I)
        return (self._trigonometric(I), True) if rational is None else (rational, False)

    @property
    def _spread(self) -> Scalar:
        """D, the difference of the two moments in the plane of the one pair that is linked."""
        ((i, j),) = self.linked
        across = self.tensor[i][i] - self.tensor[j][j]
        return self.short(sqrt(self.short(across * across + 4 * self.tensor[i][j] * self.tensor[i][j])))

    def _halves(self, total: Scalar, spread: Scalar) -> tuple[Scalar, Scalar]:
        return self.short(HALF * (total - spread)), self.short(HALF * (total + spread))

    @property
    def _is_long(self) -> bool:
        return sum(text_size(x) for row in self.tensor for x in row) > LONGEST

    def _short_unless_long(self, x: Scalar) -> Scalar:
        return x if self._is_long else self.short(x)

    def _cubic(self, I: Matrix) -> PrincipalMoments | None:
        """The roots of J^3 - tr J^2 + minors J - det where one is rational in the entries; None where none is found.

        Without a determinant, as of masses in line, 0 is one.
        """
        short = self._short_unless_long
        trace = short(I[0][0] + I[1][1] + I[2][2])
        if vanishes(I[0] @ I[1].cross(I[2])):
            square = trace * trace - 4 * self._minors(I)
            spread = 0 if vanishes(square) else sqrt(square)
            return 0, short(HALF * (trace - spread)), short(HALF * (trace + spread))
        if self._is_long:
            return None
        minors, determinant = self.short(self._minors(I)), self.short(I[0] @ I[1].cross(I[2]))
        J = self.scope.graph.symbol("J of the characteristic equation")
        found = roots(J * J * J - trace * J * J + minors * J - determinant, J, self.scope.positive)
        if len(found) >= 2:
            first, second = found[:2]
            return first, second, self.short(trace - first - second)
        if found:
            total = trace - found[0]
            square = self.short(total * total - 4 * (minors - found[0] * total))
            return (found[0], *self._halves(total, self.short(sqrt(square))))
        return None

    @staticmethod
    def _minors(I: Matrix) -> Scalar:
        found: Scalar = sum(I[i][i] * I[j][j] - I[i][j] * I[i][j] for i, j in ((0, 1), (1, 2), (0, 2)))
        return found

    def _trigonometric(self, I: Matrix) -> PrincipalMoments:
        """q + 2 p cos(turn + 2 pi k/3), 0 <= turn <= pi/3, ascending."""
        short = self._short_unless_long
        q = over(short(I[0][0] + I[1][1] + I[2][2]), 3)
        A = Matrix.of((I[i][j] - (q if i == j else 0) for j in range(3)) for i in range(3))
        p = short(sqrt(short(over(sum(x * x for row in A for x in row), 6))))
        turn = over(function("acos", over(short(A[0] @ A[1].cross(A[2])), 2 * p * p * p)), 3)
        third = over(2 * self.scope.graph.pi, 3)
        return q + 2 * p * cos(turn + third), q + 2 * p * cos(turn - third), q + 2 * p * cos(turn)

    def larger(self, i: int, j: int) -> int | None:
        """The sign of moment i - moment j, where that is known: by its terms, or as both are made.

        The two of a pair of axes come as the smaller and the larger one; of a thin plate J_z = J_x + J_y.
        """
        moments = self.moments
        if len(self.linked) == 1 and {i, j} == {1, 2}:
            return i - j
        if i != j:
            rest = moments[3 - i - j]
            for large, small, sign in ((moments[i], moments[j], 1), (moments[j], moments[i], -1)):
                if vanishes(large - small - rest):
                    return sign
        return self.sign(moments[i] - moments[j])

    def sign(self, x: Scalar) -> int | None:
        """The sign of x, where all its terms have it, or where it is a constant times positive symbols."""
        known = sign_of_terms(x, self.scope.positive)
        if known is not None:
            return known
        _, product = common_factor((self.short(x),))
        rest = self.short(over(x, product))
        if symbols_of((rest,)) or sign_of_terms(product, self.scope.positive) != 1:
            return None
        return 1 if number_of(rest) > 0 else -1

    # -- axes ---------------------------------------------------------------------------------------

    def axes(self, moments: Vector, equal: Sequence[tuple[int, int]]) -> Matrix | None:
        """The rows of R for the moments in this order; of equal moments one choice of many. None: no closed form."""
        if len(equal) == 3:
            return Matrix.IDENTITY
        if len(self.linked) == 3 or len(self.linked) == 2:
            return self._by_rows(moments, equal)
        known = list(zip(self.moments, self._in_plane(), strict=True))
        rows = []
        for moment in moments[:2]:
            k = next(k for k, (other, _) in enumerate(known) if other is moment or other == moment)
            rows.append(known.pop(k)[1])
        return self._right_handed(*rows)

    def _in_plane(self) -> Matrix:
        """An axis for each of the moments where at most one pair of axes is linked."""
        if not self.linked:
            return Matrix.IDENTITY
        ((i, j),) = self.linked
        a, b, product, spread = self.tensor[i][i], self.tensor[j][j], self.tensor[i][j], self._spread
        sine, cosine = (self.short(sqrt(over(spread + side, 2 * spread))) for side in (b - a, a - b))
        sign = self._sign(product)
        larger: list[Scalar] = [0, 0, 0]
        smaller: list[Scalar] = [0, 0, 0]
        larger[i], larger[j] = cosine, self.short(sign * sine)
        smaller[i], smaller[j] = sine, self.short(-sign * cosine)
        return Matrix.of((Matrix.IDENTITY[3 - i - j], smaller, larger))

    def _sign(self, x: Scalar) -> Scalar:
        """The sign of what does not vanish, as a formula where it is not known."""
        known = self.sign(x)
        numbers = None if known else self.scope.numbers((x,))
        return known or (function("sign", x) if numbers is None else (1 if numbers[0] > 0 else -1))

    def _by_rows(self, moments: Vector, equal: Sequence[tuple[int, int]]) -> Matrix | None:
        """Every simple moment's axis is across two rows of I - J 1; two equal ones have any axes across the third."""
        if any(node.op == "acos" for node in order(moments)):
            return None
        if not equal:
            found = [n for n in map(self._across_rows, moments) if n is not None]
            return self._turned_right(*found) if len(found) == 3 else None
        (pair,) = equal
        single = 3 - sum(pair)
        n = self._across_rows(moments[single])
        if n is None:
            return None
        other = self._unit(Matrix.IDENTITY[2].cross(n))
        return Matrix.of((n, other, self._third(n, other)) if single == 0 else (other, self._third(n, other), n))

    def _across_rows(self, moment: Scalar) -> Vector | None:
        I = self.tensor
        rows = [Vector(I[i][j] - (moment if i == j else 0) for j in range(3)) for i in range(3)]
        for i, j in ((0, 1), (1, 2), (0, 2)):
            n = Vector(map(self.short, rows[i].cross(rows[j])))
            if not all(vanishes(x) for x in n):
                return self._unit(n)
        return None

    def _right_handed(self, first: Vector, second: Vector) -> Matrix:
        return Matrix.of((first, second, self._third(first, second)))

    def _turned_right(self, first: Vector, second: Vector, third: Vector) -> Matrix:
        """The three axes, the last one reversed where they are left-handed."""
        hand = first.cross(second) @ third
        signs = [sign for sign in (1, -1) if vanishes(hand - sign)]
        return Matrix.of((first, second, signs[0] * third) if signs else self._right_handed(first, second))

    def _third(self, first: Vector, second: Vector) -> Vector:
        return Vector(map(self.short, first.cross(second)))

    def _unit(self, n: Vector) -> Vector:
        """n over its length, its first component that does not vanish positive where its sign is known.

        Divided by that component at first, so that what all three share is gone.
        """
        flat = [0 if vanishes(x) else x for x in n]
        lead = next(x for x in flat if not is_zero(x))
        ratios = Vector(self.short(over(x, lead)) for x in flat)
        length = sqrt(self.short(ratios @ ratios))
        return Vector(self.short(over(x, length)) for x in ratios)


def _ascending(tensor: _Tensor) -> list[int] | None:
    """Indices of the moments in ascending order; None where the order is not known."""
    moments = tensor.moments
    if tensor.is_ordered:
        return [0, 1, 2]
    numbers = tensor.scope.numbers(moments)
    if numbers is not None:
        return sorted(range(3), key=lambda k: numbers[k])
    signs = {(k, k): 0 for k in range(3)}
    for i, j in ((0, 1), (0, 2), (1, 2)):
        sign = tensor.larger(i, j)
        if sign is None:
            return None
        signs[i, j], signs[j, i] = sign, -sign

    def compared(i: int, j: int) -> int:
        return signs[i, j]

    return sorted(range(3), key=cmp_to_key(compared))


def short_form(x: Scalar, positive: Collection[Node]) -> Scalar:
    """x in readable form, the magnitudes of constants by their sign; a long sum as it is."""
    found = simplest(x, Work.FORMULA, positive, TERMS)
    signed = _with_signs(found)
    return found if signed is found else simplest(signed, Work.FORMULA, positive, TERMS)


def _with_signs(x: Scalar) -> Scalar:
    """x with the magnitudes of constants by their sign: |pi - 90| is 90 - pi."""
    known: dict[Node, Scalar] = {}
    for node in order((x,)):
        if node.op == "abs" and not symbols_of((node,)):
            (inside,) = node.args
            known[node] = inside if number_of(inside) > 0 else -inside
    return substituted((x,), known)[0] if known else x


# -------- sums of inertia -------------------------------------------------------------------------------------
# System -> what bodies and their pieces add up to, in one set of axes, about one point.

LONGEST_ROOT = 300  # characters of a moment whose radius of gyration is made short
MOST_NODES = 5000  # of axes whose numbers are those of the formulas


@dataclass(frozen=True)
class InertiaRow:
    """A body, or a piece of one.

    Args:
        label: its name.
        sign: -1 for a hole, which takes away.
        mass: its mass (positive), mass centre and inertia about it.
    """

    label: str
    sign: int
    mass: MassProperties

    def own(self) -> Matrix:
        """Its inertia about its own mass centre, as it counts."""
        return self.sign * self.mass.I

    def shift(self, point: Vector) -> Matrix:
        """m (d.d 1 - d d^T), the parallel-axis term, with the sign of the piece."""
        without = MassProperties(self.mass.m, self.mass.com, Matrix.of((Vector.ZERO, Vector.ZERO, Vector.ZERO)))
        return self.sign * without.about(point)


@dataclass(frozen=True)
class InertiaSum:
    """Rows taken as one body: mass, mass centre, inertia about a point.

    Args:
        motion: whose formulas they are.
        rows: in one set of axes.
        start: values of the coordinates for the numbers (empty: moving bodies have no numbers).
    """

    motion: Motion
    rows: tuple[InertiaRow, ...]
    start: State

    @staticmethod
    def of_body(motion: Motion, body: str, start: State) -> InertiaSum:
        """One body in its own axes: its pieces, or itself."""
        return InertiaSum(motion, _rows(motion, body, Pose()), start)

    @staticmethod
    def of_bodies(motion: Motion, bodies: Sequence[str], start: State) -> InertiaSum:
        """Several bodies where they are, ground axes."""
        rows = [row for body in bodies for row in _rows(motion, body, motion.link(body).pose, body)]
        return InertiaSum(motion, tuple(rows), start)

    def numbers(self, scalars: Sequence[Scalar]) -> list[float] | None:
        """Values of scalars at the start, new ones evaluated together; None where one has no value."""
        fresh = [x for x in dict.fromkeys(scalars) if x not in self._value]
        found = self.motion.scope.numbers(fresh, self.start) if fresh else []
        if found is None:
            return None
        self._value.update(zip(fresh, found, strict=True))
        return [self._value[x] for x in scalars]

    @cached_property
    def _value(self) -> dict[Scalar, float]:
        return {}

    @cached_property
    def short(self) -> Callable[[Scalar], Scalar]:
        """x in readable form; what was read once is not read again."""
        return cache(partial(short_form, positive=self.motion.scope.positive))

    @property
    def m(self) -> Scalar:
        return self.short(sum(row.sign * row.mass.m for row in self.rows))

    @property
    def com(self) -> Vector:
        """The mass centre (without mass, the origin)."""
        if is_zero(self.m):
            return Vector.ZERO
        first: Vector = Vector.ZERO
        for row in self.rows:
            first = first + row.sign * row.mass.m * row.mass.com
        return Vector(self.short(over(x, self.m)) for x in first)

    def tensor(self, point: Vector) -> InertiaMatrix:
        """The inertia about a point, axes of the rows."""
        total: Matrix = Matrix.of((Vector.ZERO, Vector.ZERO, Vector.ZERO))
        for row in self.rows:
            total = total + (row.own() + row.shift(point))
        return InertiaMatrix(Vector(self.short(x) for x in line) for line in total)


@dataclass(frozen=True)
class InertiaAbout:
    """The inertia of a sum of rows about a point, in short form."""

    sum: InertiaSum
    point: Vector

    @staticmethod
    def of_body(motion: Motion, body: str, start: State) -> InertiaAbout:
        """One body about its mass centre, in its own axes."""
        sum = InertiaSum.of_body(motion, body, start)
        return InertiaAbout(sum, sum.com)

    @staticmethod
    def of_bodies(motion: Motion, bodies: Sequence[str], start: State, point: Vector | None = None) -> InertiaAbout:
        """Several bodies where they are, about a point or their mass centre, ground axes."""
        sum = InertiaSum.of_bodies(motion, bodies, start)
        return InertiaAbout(sum, sum.com if point is None else point)

    @cached_property
    def tensor(self) -> InertiaMatrix:
        return self.sum.tensor(self.point)

    @cached_property
    def principal(self) -> Principal:
        return Principal.of(self.tensor, self.sum.motion.scope)

    @property
    def polar(self) -> Scalar:
        """The moment about the point itself."""
        return self.sum.short(self.tensor.polar)

    @property
    def planar(self) -> Vector:
        """The moments about the three planes through the point."""
        P = self.tensor.second_moments
        return Vector(self.sum.short(P[k][k]) for k in range(3))

    def product(self, i: int, j: int) -> Scalar:
        """The integral of x_i x_j dm, the textbook's product of inertia."""
        return self.sum.short(-self.tensor[i][j])

    def axial(self, along: Vector) -> Scalar:
        """The moment about the axis through the point in a direction."""
        return self.sum.short(self.tensor.about_axis(along))

    def radius(self, moment: Scalar) -> Scalar:
        """k = sqrt(I/m), short where the moment is."""
        short: Callable[[Scalar], Scalar] = (lambda x: x) if text_size(moment) > LONGEST_ROOT else self.sum.short
        return short(sqrt(short(over(moment, self.sum.m))))

    def axes_in_numbers(self) -> list[list[float]] | None:
        """The rows of R in floating point: the exact ones; eigenvectors of the tensor where these have no value, as
        where a product vanishes in the state alone."""
        found = self.principal
        if found.axes is not None and len(order([x for row in found.axes for x in row])) < MOST_NODES:
            flat = self.sum.numbers([x for row in found.axes for x in row])
            if flat is not None and np.allclose(np.reshape(flat, (3, 3)) @ np.reshape(flat, (3, 3)).T, np.eye(3)):
                return [list(row) for row in np.reshape(flat, (3, 3))]
        entries, moments = (self.sum.numbers(x) for x in ([x for row in self.tensor for x in row], found.moments))
        if entries is None or moments is None:
            return None
        axes = np.linalg.eigh(np.reshape(entries, (3, 3)))[1].T[np.argsort(np.argsort(moments))]
        axes[2] = np.cross(axes[0], axes[1])
        return [list(map(float, row)) for row in axes]


def _rows(motion: Motion, body: str, pose: Pose, of: str = "") -> tuple[InertiaRow, ...]:
    """The pieces of a body, or itself, seen from where `pose` leads."""
    if motion.scope.model.bodies[body].parts is None:
        return (InertiaRow(body, 1, _seen(motion.scope.mass_properties(body), pose)),)
    pieces = motion.scope.made_of(body).pieces
    begin = f"{of}, " if of else ""
    return tuple(
        InertiaRow(
            f"{begin}part {k}: {p.piece.shape.kind}" + (" (hole)" if p.piece.hole else ""), p.sign, _seen(p.mass, pose)
        )
        for k, p in enumerate(pieces, start=1)
    )


def _seen(mass: MassProperties, pose: Pose) -> MassProperties:
    return MassProperties(mass.m, pose.point(mass.com), pose.R @ mass.I @ pose.R.T)
