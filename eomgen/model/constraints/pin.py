"""Pin: a hinge of points."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, owner_of
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.row import AXIS_NAMES, ConstraintRow, scene_axes
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.load import BodyPoint, Couple, LoadContext, PointForce
from eomgen.model.joints.base import across
from eomgen.model.kinds import AxesName, Points, SpaceDirection
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Matrix, Scalar, Vector


@dataclass(frozen=True, kw_only=True)
class Pin(Constraint):
    """A hinge: one point is fixed to the ground where it stands at the start; two or more are hinged together.

    Rows, for each point after the first: e . (p_first - p_other) = 0 along x and y (in space also z): forces along
    these axes. In space `axis` makes it a hinge, the axis carried along by both bodies, with two rows more, couples;
    without it it is a ball joint. With an axis the single point's body keeps its axis in the ground. `check` warns of a
    hinge whose axis would leave more degrees of freedom in the axes of one of its bodies.

    Args:
        points: the hinge's points, one of each body.
        axis: in space, the hinge's axis at the start, as it is written, guesses included (None: a ball joint).
        axes: "ground", or the body of the hinge in whose axes that is given.
    """

    kind: ClassVar[str] = "pin"
    points: Points
    axis: SpaceDirection | None = None
    axes: AxesName = "ground"

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of axes of a body that the hinge does not hold, or without a hinge axis."""
        if self.points is None or self.axes is None:  # what could not be read
            return
        holds = [owner_of(point) for point in self.points]
        if self.axes in catalog.table("bodies") and self.axes not in holds:
            what = f"'{path[1]}' does not hold body '{self.axes}'"
            yield Diagnostic((*path, "axes"), what, f"one of {', '.join(holds)}")
        elif self.axes != "ground" and self.axis is None:
            yield Diagnostic(
                (*path, "axes"), f"'{path[1]}' has no axis", "give the axis, or leave 'axes' out", key=True
            )

    def turned(self) -> Iterator[tuple[str, Any]]:
        """The same hinge with its axis in the axes of each body that it holds."""
        if self.axis is not None and self.axes == "ground":
            for body in dict.fromkeys(owner_of(point) for point in self.points if "." in point):
                yield f'axes = "{body}"', replace(self, axes=body)

    def stays(self, component: str) -> bool:
        return len(self.points) == 1 and component != "couple"

    @property
    def lies_by_start(self) -> bool:
        return len(self.points) == 1

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """The rows e . (p_first - p_P) = 0 along each axis, for each further point P; a single point's, to its start.

        With an axis in space also n_P . e = 0 for the two directions e of the first body across the axis.
        """
        first, *_ = named = [scene.place(point) for point in self.points]
        rows = []
        for other in others_of(scene, named):
            rows += held_together(scene, first, other)
            if self.axis is not None and not scene.plane:
                bodies = first[0], other[0]
                n = as_carried(scene, scene.carrier_of(*bodies), self._axis_at_start(scene)).unit
                rows += [across_from(scene, bodies, e, n) for e in across(n)]
        return tuple(rows)

    def agreeing(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """The product n_first . n_P for each further point P, of a hinge in space; () of others."""
        if self.axis is None or scene.plane:
            return ()
        first, *_ = named = [scene.place(point) for point in self.points]
        n = self._axis_at_start(scene).unit
        return tuple(alike(scene, (first[0], other[0]), n) for other in others_of(scene, named))

    def _axis_at_start(self, scene: LoadContext) -> Vector:
        """The axis at the start, in ground axes."""
        assert self.axis is not None, "only a hinge has an axis"
        n = scene.vector(self.axis)
        if self.axes == "ground":
            return n
        return Matrix.of((scene.start(x) for x in row) for row in scene.orientation(self.axes)) @ n


def others_of(scene: LoadContext, named: list[BodyPoint]) -> list[BodyPoint]:
    """The places to which the first is held: the others, or where it stands at the start."""
    first, *others = named
    if others:
        return others
    x, y, z = scene.position(first)
    return [(None, Vector((scene.start(x), scene.start(y), scene.start(z))))]


def held_together(scene: LoadContext, first: BodyPoint, other: BodyPoint) -> list[ConstraintRow]:
    """e . (p_first - p_other) = 0 along each axis; a unit force on the first, its opposite on the other.

    The axes are those of the nearest body that carries both. A loop that lies in a plane of that body, however it
    turns, then leaves rows that vanish identically; in ground axes they would only where the others hold.
    """
    carrier = scene.carrier_of(first[0], other[0])
    view = scene.seen_from(carrier)
    gap, found = view.position(first) - view.position(other), []
    for name, e in zip(AXIS_NAMES, scene_axes(scene), strict=False):
        pushes = PointForce(first, e), PointForce(other, -e)
        carried = () if carrier is None else pushes
        found.append(ConstraintRow(pushes, e @ gap, component=name, carrier=carrier, carried=carried))
    return found


def across_from(scene: LoadContext, bodies: tuple[str | None, str | None], e: Vector, n: Vector) -> ConstraintRow:
    """n . e = 0 in space: n is carried by the second body, e across it by the first; the couple is e x n.

    Both are given in the axes that the body which carries both has at the start, and seen from there.
    """
    carrier = scene.carrier_of(*bodies)
    view = scene.seen_from(carrier)
    n, e = carried_direction(view, bodies[1], n), carried_direction(view, bodies[0], e)
    couple = e.cross(n)
    pairs = [(b, tau) for b, tau in ((bodies[0], couple), (bodies[1], -couple)) if b is not None]
    pushes = tuple(Couple(b, tau, axes=carrier) for b, tau in pairs)
    carried = () if carrier is None else tuple(Couple(b, tau) for b, tau in pairs)
    return ConstraintRow(pushes, n @ e, component="couple", carrier=carrier, carried=carried)


def as_carried(scene: LoadContext, carrier: str | None, direction: Vector) -> Vector:
    """A direction given in ground axes, in those that a body has at the start."""
    if carrier is None:
        return direction
    at_start = Matrix.of((scene.start(x) for x in row) for row in scene.orientation(carrier))
    return at_start.T @ direction


def not_turning(scene: LoadContext, bodies: tuple[str | None, str | None]) -> list[ConstraintRow]:
    """e_i . e_j = 0 in space of axes in either body, that agree at the start: the couples about x, y and z."""
    x, y, z = Matrix.IDENTITY  # y x z = x
    return [across_from(scene, bodies, e, n) for e, n in ((y, z), (z, x), (x, y))]


def alike(scene: LoadContext, bodies: tuple[str | None, str | None], n: Vector) -> Scalar:
    """n . n of a direction that agreed at the start, carried by either body."""
    return carried_direction(scene, bodies[0], n) @ carried_direction(scene, bodies[1], n)


def carried_direction(scene: LoadContext, body: str | None, direction: Vector) -> Vector:
    """A direction given in ground axes at the start, as the body carries it along, ground axes."""
    if body is None:
        return direction
    R = scene.orientation(body)
    at_start = Matrix.of((scene.start(x) for x in row) for row in R)
    return R @ (at_start.T @ direction)
