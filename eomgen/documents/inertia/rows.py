"""System -> what a report of inertia adds up: bodies and their pieces, in one set of axes, about one point."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, cached_property, partial

from eomgen.mechanics.bodies.composition import made_of
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.masses.principal import numbers_in, short_form
from eomgen.model.composite import about, matrix_times
from eomgen.model.shapes import MassProperties
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import (
    ZERO,
    Matrix,
    Pose,
    Vector,
    added,
    matrix_of,
    plus,
    product,
    times,
    transposed,
    vector_of,
)


@dataclass(frozen=True)
class InertiaRow:
    """A body, or a piece of one.

    Args:
        label: what it is called.
        sign: -1 for a hole, which takes away.
        mass: its mass (positive), mass centre and inertia about it.
    """

    label: str
    sign: int
    mass: MassProperties

    def own(self) -> Matrix:
        """Its inertia about its own mass centre, as it counts."""
        return matrix_times(self.sign, self.mass.I)

    def shift(self, point: Vector) -> Matrix:
        """m (d.d 1 - d d^T), what the parallel axes add, as it counts."""
        without = MassProperties(self.mass.m, self.mass.com, (ZERO, ZERO, ZERO))
        return matrix_times(self.sign, about(without, point))


@dataclass(frozen=True)
class InertiaSum:
    """Rows taken as one body: mass, mass centre, inertia about a point.

    Args:
        motion: whose formulas they are.
        rows: in one set of axes.
        start: where the numbers are taken: the coordinates there (empty: moving things have no numbers).
    """

    motion: Motion
    rows: tuple[InertiaRow, ...]
    start: State

    def numbers(self, scalars: Sequence[Scalar]) -> list[float] | None:
        """What scalars are worth at the start, those not met before in one go; None where one has no value."""
        fresh = [x for x in dict.fromkeys(scalars) if x not in self._worth]
        found = numbers_in(fresh, self.motion.scope, self.start) if fresh else []
        if found is None:
            return None
        self._worth.update(zip(fresh, found, strict=True))
        return [self._worth[x] for x in scalars]

    @cached_property
    def _worth(self) -> dict[Scalar, float]:
        return {}

    @cached_property
    def short(self) -> Callable[[Scalar], Scalar]:
        """x in readable form; what was read once is not read again."""
        return cache(partial(short_form, positive=self.motion.scope.positive))

    @cached_property
    def m(self) -> Scalar:
        return self.short(sum(row.sign * row.mass.m for row in self.rows))

    @cached_property
    def com(self) -> Vector:
        """The mass centre (without mass, the origin)."""
        if is_zero(self.m):
            return ZERO
        first: Vector = ZERO
        for row in self.rows:
            first = plus(first, times(row.sign * row.mass.m, row.mass.com))
        return vector_of(self.short(over(x, self.m)) for x in first)

    def tensor(self, point: Vector) -> Matrix:
        """The inertia about a point, axes of the rows."""
        total: Matrix = (ZERO, ZERO, ZERO)
        for row in self.rows:
            total = added(total, added(row.own(), row.shift(point)))
        return matrix_of((self.short(x) for x in line) for line in total)


def own_sum(motion: Motion, body: str, start: State) -> InertiaSum:
    """One body in its own axes: its pieces, or itself."""
    return InertiaSum(motion, _rows(motion, body, Pose()), start)


def together(motion: Motion, bodies: Sequence[str], start: State) -> InertiaSum:
    """Several bodies where they are, ground axes."""
    rows = [row for body in bodies for row in _rows(motion, body, motion.link(body).pose, body)]
    return InertiaSum(motion, tuple(rows), start)


def _rows(motion: Motion, body: str, pose: Pose, of: str = "") -> tuple[InertiaRow, ...]:
    """The pieces of a body, or itself, seen from where `pose` leads."""
    if motion.scope.model.bodies[body].parts is None:
        return (InertiaRow(body, 1, _seen(mass_properties(motion.scope, body), pose)),)
    pieces = made_of(motion.scope, body).pieces
    begin = f"{of}, " if of else ""
    return tuple(
        InertiaRow(
            f"{begin}part {k}: {p.piece.shape.kind}" + (" (hole)" if p.piece.hole else ""), p.sign, _seen(p.mass, pose)
        )
        for k, p in enumerate(pieces, start=1)
    )


def _seen(mass: MassProperties, pose: Pose) -> MassProperties:
    return MassProperties(mass.m, pose.point(mass.com), product(product(pose.R, mass.I), transposed(pose.R)))
