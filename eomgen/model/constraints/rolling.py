"""Rolling of round bodies on lines, planes, balls and pipes.

Rolling: a round body on a line, a circle or another body; in space on a plane, a ball or a pipe.
"""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, diagnostics_of_one, is_round, not_in_the_plane
from eomgen.model.constraints.base import Constraint, FlatSurface, Meeting, RoundSurface, TouchingRound
from eomgen.model.constraints.plane import Touch, opposite, right
from eomgen.model.constraints.row import ConstraintRow, Edge, direction_of
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.load import BodyPoint, LoadContext
from eomgen.model.kinds import (
    BodyName,
    Direction,
    Flag,
    FrictionLaw,
    GroundPlace,
    Length,
    OwnPlace,
    Radius,
    Restitution,
    Size,
    SpaceDirection,
)
from eomgen.model.part import Part, PartRule
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.exact import readable
from eomgen.symbolic.expression import Expression, Fraction, Node, Scalar, Vector, cos, over, sin, sqrt
from eomgen.symbolic.numeric import Work, tolerances
from eomgen.symbolic.print import text_size

# -------- round bodies ----------------------------------------------------------------------------------------
# Round bodies in space: the point of each that comes nearest to a plane.
#
# The place nearest to a plane is the one farthest against its normal n. From the centre it is `reach` away, and the
# centre then is `height` = - n . reach above the plane:
#
#     ball         reach = - R n                                 height = R
#     wheel        reach = - R (n - (n.a) a) / rho - r n         height = R rho + r,   rho = |n x a|
#     ellipsoid    reach = - A n / h                             height = h = sqrt(n . A n)
#
# with a wheel's axis a and the radius r of its tyre (0: a thin disc), A = R_B diag(a^2, b^2, c^2) R_B^T. As the place
# is an extreme one, it may wander in the body, and the gap's rate is still n . v of the material points in contact.


LONGEST = 400  # characters of a cosine that is multiplied out


@dataclass(frozen=True)
class Nearest:
    """The place of a round body that is nearest to a plane.

    Args:
        reach: from the body's centre to it, ground axes [m].
        height: of the centre above the plane through it [m].
    """

    reach: Vector
    height: Scalar


@dataclass(frozen=True)
class RollingBall:
    """A ball of radius R."""

    R: Scalar

    def nearest(self, scene: LoadContext, n: Vector) -> Nearest:
        """R below the centre."""
        return Nearest(-self.R * n, self.R)


@dataclass(frozen=True)
class Wheel:
    """A thin disc of radius R about `axis` (body axes), or the centre line of a tyre of radius `tube`."""

    body: str
    axis: Vector
    R: Scalar
    tube: Scalar

    def nearest(self, scene: LoadContext, n: Vector) -> Nearest:
        """The lowest place of the rim.

        Raises:
            ModelError: the wheel lies flat at the start, where the whole rim touches.
        """
        a, rho = self._axle(scene), self.tilt(scene, n)
        if abs(_value(scene, rho)) < tolerances.DEGENERATE:
            raise ModelError(
                f"'{self.body}' lies flat at the start: its whole rim touches",
                scene.where,
                "start it upright or leaning; an axis along the normal has no lowest point",
            )
        down = over(-self.R, rho) * a.cross(n.cross(a))
        return Nearest(down - self.tube * n, self.R * rho + self.tube)

    def nearest_to_ball(self, scene: LoadContext, out: Vector, side: int) -> Vector:
        """Vector from the wheel's centre to the point of its centre line nearest to a ball's centre; inside: farthest.

        -+ R h / |h|,  h = d - (d . a) a,  d from the ball's centre to the wheel's.

        Raises:
            ModelError: its axis points to the ball's centre at the start, where the whole rim touches.
        """
        h, size = self._across(scene, out), self.distance(scene, out)
        if abs(_value(scene, size)) < tolerances.DEGENERATE * abs(_value(scene, self.R)):
            raise ModelError(
                f"the axis of '{self.body}' points to the ball's centre: its whole rim touches",
                scene.where,
                "start it leaning",
            )
        return over(-side * self.R, size) * h

    def distance(self, scene: LoadContext, out: Vector) -> Scalar:
        """|h|, of a ball's centre from the wheel's axis [m]; 0 where the whole rim touches."""
        h = self._across(scene, out)
        return sqrt(_short(h @ h))

    def _across(self, scene: LoadContext, out: Vector) -> Vector:
        a = self._axle(scene)
        return out - out @ a * a

    def tilt(self, scene: LoadContext, n: Vector) -> Scalar:
        """rho = |n x a|, the sine of the angle between its axis and n; 0 where it lies flat."""
        a = self._axle(scene)
        k = n.cross(a)
        wave = _other_wave(scene, _short(n @ a))
        return sqrt(k @ k) if wave is None else wave

    def _axle(self, scene: LoadContext) -> Vector:
        return scene.orientation(self.body) @ self.axis.unit


@dataclass(frozen=True)
class Egg:
    """An ellipsoid with its semiaxes along the body's axes."""

    body: str
    semiaxes: Vector

    def nearest(self, scene: LoadContext, n: Vector) -> Nearest:
        """The place of the surface at which n is its inner normal."""
        R = scene.orientation(self.body)
        n_B = R.T @ n
        x, y, z = (s * s * k for s, k in zip(self.semiaxes, n_B, strict=True))
        h = sqrt(n_B @ Vector((x, y, z)))
        return Nearest(R @ (over(-1, h) * Vector((x, y, z))), h)


Round = RollingBall | Wheel | Egg


def laid_in(scene: LoadContext, n: Vector) -> tuple[Vector, Vector]:
    """Two directions in the plane across the unit vector n: x laid into the plane (y where n is along x), and n x it.

    So (t, s) is (x, y) on a level floor, and t points down a slope about y.
    """
    x, y, z = n
    if _plain(y) and _plain(z):
        t: Vector = Vector((0, 1, 0))
    elif _plain(y):
        t = _sense(scene, z) * Vector((z, 0, -x))
    elif _plain(z):
        t = _sense(scene, y) * Vector((y, -x, 0))
    else:
        root = complement(scene, x)
        t = Vector((root, -over(x * y, root), -over(x * z, root)) if not _plain(x) else (1, 0, 0))
    return t, n.cross(t)


def turned_over(scene: LoadContext, n: Vector) -> tuple[Vector, Vector]:
    """Two directions across a unit vector n that moves: those that come along when e turns into n the shortest way.

    t_i = e_i - (n . e_i) (n + e) / (1 + n . e), e the axis of the ground nearest to n at the start. Opposite to e,
    and only there, they are not determined.
    """
    k, sense = _nearest_axis(scene, n)
    axes: tuple[Vector, ...] = (Vector((1, 0, 0)), Vector((0, 1, 0)), Vector((0, 0, 1)))
    e = sense * axes[k]
    first = axes[(k + 1) % 3]
    middle = n + e
    share = over(1, 1 + n @ e)
    t, s = (d - n @ d * share * middle for d in (first, e.cross(first)))
    return t, s


def _nearest_axis(scene: LoadContext, n: Vector) -> tuple[int, int]:
    """(which axis, +1 or -1); z where nobody knows."""
    sizes = [_value(scene, x, unknown=0.0) for x in n]
    k = max((2, 1, 0), key=lambda i: abs(sizes[i]))
    return k, -1 if sizes[k] < 0 else 1


def complement(scene: LoadContext, x: Scalar) -> Scalar:
    """sqrt(1 - x^2)."""
    x = _short(x)
    wave = _other_wave(scene, x)
    return sqrt(1 - x * x) if wave is None else wave


def _short(x: Scalar) -> Scalar:
    """x multiplied out, where it is no long sum: a cosine that is written by those of two angles."""
    return readable(x, Work.PART) if type(x) is Node and text_size(x) <= LONGEST else x


def _other_wave(scene: LoadContext, x: Scalar) -> Scalar | None:
    """sqrt(1 - x^2) of a sine or a cosine: the cosine or sine, in the sense that it has at the start; else None."""
    if type(x) is Node and x.op == "neg":
        return _other_wave(scene, x.args[0])
    if type(x) is not Node or x.op not in ("sin", "cos"):
        return None
    found: Scalar = cos(x.args[0]) if x.op == "sin" else sin(x.args[0])
    return -found if _sense(scene, found) < 0 else found


def _sense(scene: LoadContext, x: Scalar) -> int:
    return -1 if _value(scene, x) < 0 else 1


def _value(scene: LoadContext, x: Scalar, unknown: float = 1.0) -> float:
    """The value of x at the start with the model's values."""
    found = scene.value_at_start(x)
    return unknown if found is None else found


def _plain(x: Scalar) -> bool:
    return type(x) is int and x == 0


# -------- tracks ----------------------------------------------------------------------------------------------
# Tracks on which a round body rolls: a plane (in the plane a line), a ball or pipe (in the plane a circle).


@dataclass(frozen=True, kw_only=True)
class Track(Part):
    """A line or a plane: through `at`, `normal` towards the rolling body; in the axes of `on`.

    Args:
        at: a place on it, or the name of a point of the ground, 2 or 3 [m].
        normal: towards the rolling body, of any length.
    """

    title: ClassVar[str] = "a line or plane"
    at: GroundPlace
    normal: Direction


@dataclass(frozen=True, kw_only=True)
class Circle(Part):
    """A circle about `at`, in space a ball or with `axis` a pipe, in the axes of `on`; rolled on outside or inside.

    Args:
        at: its centre, or the name of a point of the ground, 2 or 3 [m].
        radius: of the circle, ball or pipe [m].
        inside: the body rolls in it, and the normal points to the centre.
        axis: of a pipe, 3.
    """

    title: ClassVar[str] = "a circle"
    at: GroundPlace
    radius: Length
    inside: Flag = False
    axis: SpaceDirection | None = None


@dataclass(frozen=True)
class TrackContact:
    """A round body against its track.

    Args:
        n: from the track towards the body, of unit length where they touch.
        gap: between them [m].
        reach: from the body's centre to the contact, ground axes [m].
        anchor: a place of the track that does not move in its body.
        arm: from the anchor to the contact, ground axes [m].
        tangents: one direction along the contact, in space two.
    """

    n: Vector
    gap: Scalar
    reach: Vector
    anchor: BodyPoint
    arm: Vector
    tangents: tuple[Vector, ...]


@dataclass(frozen=True)
class Curved:
    """A ball, a pipe about `axis` (ground axes), or in the plane a circle, about `anchor`.

    Args:
        r: its radius [m].
        side: 1: it is rolled on outside, -1: inside.
    """

    anchor: BodyPoint
    r: Scalar
    side: int = 1
    axis: Vector | None = None


def on_level(scene: LoadContext, on: str | None, track: Track, center: Vector, body: Round) -> TrackContact:
    """gap = n . (c - at) - height, n and `at` fixed in the track's body."""
    own = direction_of(scene, scene.vector(track.normal))
    tangents = (right(own),) if scene.plane else laid_in(scene, own)
    n, *along = (_carried(scene, on, e) for e in (own, *tangents))
    anchor = anchor_of(scene, on, track.at)
    out, near = center - scene.position(anchor), body.nearest(scene, n)
    return TrackContact(n, n @ out - near.height, near.reach, anchor, out + near.reach, tuple(along))


def normal_of(scene: LoadContext, on: str | None, track: Track) -> Vector:
    """Its unit normal in ground axes."""
    return _carried(scene, on, direction_of(scene, scene.vector(track.normal)))


def _carried(scene: LoadContext, on: str | None, e: Vector) -> Vector:
    """A direction of the ground, or of the body `on`, in ground axes."""
    return e if on is None else scene.orientation(on) @ e


def on_curved(scene: LoadContext, track: Curved, center: Vector, ball: RollingBall) -> TrackContact:
    """gap = (d . d - D^2) / 2D, n = d / D, d from the circle's centre (the pipe's axis) to the ball's.

    d and D = r + R where they touch; inside, D = r - R and both signs turn. No root stands in it: to first order the
    gap is the distance.
    """
    D = _apart(scene, track, ball.R)
    out = center - scene.position(track.anchor)
    along = Vector.ZERO if track.axis is None else track.axis @ out * track.axis
    d = out if track.axis is None else out - along
    n = Vector(track.side * over(x, D) for x in d)
    arm = along + track.side * track.r * n
    return TrackContact(n, _gap(track, d, D), -ball.R * n, track.anchor, arm, _around(scene, track, n))


def wheel_on_ball(scene: LoadContext, track: Curved, center: Vector, wheel: Wheel) -> TrackContact:
    """A wheel on a ball, or in it: a ball of the tyre's radius at the place of its centre line that comes nearest."""
    D, out = _apart(scene, track, wheel.tube), center - scene.position(track.anchor)
    rim = wheel.nearest_to_ball(scene, out, track.side)
    d = out + rim
    n = Vector(track.side * over(x, D) for x in d)
    reach = rim - wheel.tube * n
    return TrackContact(n, _gap(track, d, D), reach, track.anchor, out + reach, _around(scene, track, n))


def _gap(track: Curved, d: Vector, D: Scalar) -> Scalar:
    return Fraction(1, 2) * track.side * (over(d @ d, D) - D)


def _apart(scene: LoadContext, track: Curved, R: Scalar) -> Scalar:
    """Distance of a ball's centre from that of its track where they touch [m]."""
    inside = track.side < 0
    D = track.r - R if inside else track.r + R
    if inside and (scene.vanishes(D) or (scene.value_at_start(D) or 1) < 0):
        raise ModelError(
            "the body is as large as the circle in which it should roll", scene.where, "give the circle a larger radius"
        )
    return D


def _around(scene: LoadContext, track: Curved, n: Vector) -> tuple[Vector, ...]:
    """Directions across n: of a pipe its axis k and n x k."""
    if scene.plane:
        return (right(n),)
    return turned_over(scene, n) if track.axis is None else (track.axis, n.cross(track.axis))


def curved(scene: LoadContext, on: str | None, circle: Circle) -> Curved:
    """The circle of a model as it stands."""
    axis = None if circle.axis is None else _carried(scene, on, scene.vector(circle.axis).unit)
    return Curved(anchor_of(scene, on, circle.at), scene.value(circle.radius), -1 if circle.inside else 1, axis)


def anchor_of(scene: LoadContext, on: str | None, at: tuple[Expression, ...] | str) -> BodyPoint:
    """A place of the track: of the ground, or in the axes of the body `on`."""
    return (None, scene.ground_place(at)) if on is None else (on, scene.vector(at))


# -------- rolling ---------------------------------------------------------------------------------------------


TrackField = Annotated[Track, PartRule(Track)]
CircleField = Annotated[Circle, PartRule(Circle)]

TRACKS = ("line", "plane", "circle")
ALONG = ("t", "s")
"""Names of the components along a contact."""


@dataclass(frozen=True, kw_only=True)
class Rolling(Constraint):
    """Rolling: a round body touches a line (in space a plane), a circle or another round body, and does not slip.

    Rows: the normal force n, which pushes `body` off its track; without `slip` also the friction t along n turned
    clockwise (along x where n is y), a row of velocities alone; in space two, t and s, with n a right-handed frame.

    Args:
        body: the rolling body.
        line, plane, circle: the track, in the ground, or with `on` in that body's axes.
        on: the other body (alone: a round one).
        slip: True leaves the contact row only.
        unilateral: it can only push.
        friction: with slip.
        restitution: where it closes again it rebounds with this share of its speed, 0 to 1 (None: not at all).
        radius: None: the shape's; of a tyre that of its centre line [m].
        tube: in space, with `axis`: the radius of the tyre's section (None: a thin disc) [m].
        center: the point of the body about which it is round, or a place in its axes, which becomes a point of it when
            the model is finished; None: its origin.
        axis: in space, of a wheel, body axes; without it a ball.
        ellipsoid: in space, semiaxes of an ellipsoid, 3 [m].
    """

    kind: ClassVar[str] = "rolling"
    body: BodyName
    line: TrackField | None = None
    plane: TrackField | None = None
    circle: CircleField | None = None
    on: BodyName | None = None
    slip: Flag = False
    unilateral: Flag = False
    friction: FrictionLaw | None = None
    restitution: Restitution | None = None
    radius: Length | None = None
    tube: Radius | None = None
    center: OwnPlace | None = None
    axis: SpaceDirection | None = None
    ellipsoid: Size | None = None

    @property
    def _hub(self) -> str | None:
        """The center as a point of the body."""
        assert not isinstance(self.center, tuple), "a point when the model was finished"
        return self.center

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of tracks and sizes that are missing or exclude one another, or that are for another space."""
        alone = self.on is not None and all(getattr(self, track) is None for track in TRACKS)
        yield from self.never_rebounds(path)
        yield from diagnostics_of_one(catalog, path, self, (*TRACKS, "on") if self.on is None or alone else TRACKS)
        yield from self._wrong_sizes(path, catalog)
        if alone and not is_round(catalog, self.on):
            what = f"'{self.body}' rolls on body '{self.on}', which is not round"
            yield Diagnostic((*path, "on"), what, "give the line or circle of it, or the body a round shape")
        track = self.line or self.plane or self.circle
        if self.on is not None and track is not None and isinstance(track.at, str):
            what = f"'{track.at}' is a point of the ground, but the track is fixed in body '{self.on}'"
            yield Diagnostic(path, what, f"give 'at' as coordinates in the axes of '{self.on}'")
        yield from self._of_other_space(path, catalog, curved=alone or self.circle is not None)
        if self.on is not None and self.on == self.body:
            yield Diagnostic((*path, "on"), f"'{self.body}' cannot roll on itself")
        if self.friction is not None and not self.slip:
            yield Diagnostic(
                (*path, "friction"), "friction needs sliding", "slip = true, or leave 'friction' out", key=True
            )

    def _wrong_sizes(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of sizes: a radius or semiaxes are needed, not both; a tyre has an axis."""
        sizes = ("radius",) if catalog.model.space == "plane" else ("radius", "semiaxes", "major")
        if self.radius is None and self.ellipsoid is None and not is_round(catalog, self.body, sizes):
            what = f"the radius of '{self.body}', which rolls, is not known"
            yield Diagnostic(path, what, "give 'radius', or the body a round shape")
        for key in ("radius", "axis", "tube") if self.ellipsoid is not None else ():
            if getattr(self, key) is not None:
                what = f"'{path[1]}' has an 'ellipsoid' and '{key}': it is one or the other"
                yield Diagnostic((*path, key), what, "keep one", key=True)
        if self.tube is not None and self.axis is None and not is_round(catalog, self.body, ("major",)):
            yield Diagnostic(
                (*path, "tube"), f"the tyre of '{self.body}' has no 'axis'", "give it, body axes", key=True
            )

    def _of_other_space(self, path: DocumentPath, catalog: Catalog, curved: bool) -> Iterator[Diagnostic]:
        """Diagnostics of fields for the other space, and of tracks on which a wheel or an ellipsoid cannot roll."""
        if catalog.model.space == "plane":
            if self.plane is not None:
                fix = "in the plane a body rolls on a 'line'"
                yield Diagnostic((*path, "plane"), f"'plane' of '{path[1]}' is for space", fix, key=True)
            yield from not_in_the_plane(catalog, path, self, ("axis", "ellipsoid", "tube"))
            if self.circle is not None and self.circle.axis is not None:
                yield Diagnostic(
                    (*path, "circle", "axis"), f"'axis' of '{path[1]}' is for space", "leave it out", key=True
                )
            return
        if self.line is not None:
            yield Diagnostic((*path, "line"), f"'line' of '{path[1]}' is for the plane", "in space: 'plane'", key=True)
        pipe = self.circle is not None and self.circle.axis is not None
        for key in (*(["axis"] if pipe else []), "ellipsoid") if curved else ():
            if getattr(self, key) is not None:
                where = (
                    "only a ball rolls in or on a pipe" if key == "axis" else "no ellipsoid rolls on something curved"
                )
                what = f"'{path[1]}': {where}, '{self.body}' has '{key}'"
                yield Diagnostic((*path, key), what, "let it roll on a 'plane', or leave it out", key=True)

    def meeting(self) -> Meeting:
        """The round body and its track."""
        body = TouchingRound(self.body, self._hub, self.radius, self.axis, self.tube, self.ellipsoid)
        flat, track = self.line or self.plane, self.circle
        if flat is not None:
            return Meeting(ball=body, flat=FlatSurface(self.on, flat.at, flat.normal), sticks=not self.slip)
        if track is None:
            return Meeting(ball=body, round=RoundSurface(self.on, None, None), sticks=not self.slip)
        surface = RoundSurface(self.on, track.at, track.radius, bool(track.inside), track.axis)
        return Meeting(ball=body, round=surface, sticks=not self.slip)

    def misplaced(self, scene: LoadContext) -> tuple[str, str]:
        """The warning of a start within a circle that is rolled on outside; ("", "") if there is none."""
        if self.circle is None or self.circle.inside:
            return "", ""
        track = self._curved(scene)
        out = scene.position(scene.own_place(self.body, self._hub)) - scene.position(track.anchor)
        along = 0 if track.axis is None else track.axis @ out
        away, r = scene.value_at_start(out @ out - along * along), scene.value_at_start(track.r)
        if away is None or r is None or away >= r * r:
            return "", ""
        name = scene.where.rpartition(".")[2]
        what = f"'{self.body}' starts within the circle of '{name}', and would roll on its outside"
        return what, "inside = true, where it rolls in it"

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """The normal row, gap = 0, n pushing the body off its track; unless it slips, e . (v - v_track) = 0 along it.

        Both velocities are those of the bodies' material points at the contact. In the plane e = t is n turned
        clockwise (x, where n is y); in space e = t and s, with n a right-handed frame (x and y, where n is z). The
        no-slip rows are of velocities alone.
        """
        center = scene.own_place(self.body, self._hub)
        contact = self._contact(scene, scene.position(center))
        touch = Touch(center, contact.reach), Touch(contact.anchor, contact.arm)
        normal = opposite(*touch, contact.n)
        along = [opposite(*touch, e) for e in contact.tangents]
        if self.slip:
            tangent, cross_tangent, *_ = (*along, ())
            return (ConstraintRow(normal, contact.gap, component="n", tangent=tangent, cross_tangent=cross_tangent),)
        held = (
            ConstraintRow(push, None, component=name, material=True) for name, push in zip(ALONG, along, strict=False)
        )
        return (ConstraintRow(normal, contact.gap, component="n"), *held)

    def edges(self, scene: LoadContext) -> tuple[Edge, ...]:
        """The tilt of a wheel, which must not lie flat, on a ball either."""
        body, name = self._round(scene), scene.where.rpartition(".")[2]
        if not isinstance(body, Wheel):
            return ()
        if self.plane is not None:
            n = normal_of(scene, self.on, self.plane)
            return (Edge(f"'{self.body}' lies flat in '{name}'", body.tilt(scene, n)),)
        center = scene.position(scene.own_place(self.body, self._hub))
        out = center - scene.position(self._curved(scene).anchor)
        return (Edge(f"the whole rim of '{self.body}' touches in '{name}'", body.distance(scene, out)),)

    def _contact(self, scene: LoadContext, center: Any) -> TrackContact:
        body = self._round(scene)
        track = self.plane or self.line
        if track is not None:
            return on_level(scene, self.on, track, center, body)
        found = self._curved(scene)
        if isinstance(body, Wheel) and found.axis is None:
            return wheel_on_ball(scene, found, center, body)
        if isinstance(body, RollingBall):
            return on_curved(scene, found, center, body)
        raise ModelError(
            f"'{self.body}' is no ball: where it touches something curved is not derived",
            scene.where,
            "let it roll on a plane, or leave out 'axis' and 'ellipsoid'",
        )

    def _curved(self, scene: LoadContext) -> Curved:
        if self.circle is not None:
            return curved(scene, self.on, self.circle)
        assert self.on is not None, "one of line, plane, circle and on is given"
        return Curved(scene.own_place(self.on, None), scene.radius(self.on))

    def _round(self, scene: LoadContext) -> Round:
        """The touching body: ball (in the plane a disc), wheel or ellipsoid; missing sizes are those of the shape."""
        shape = scene.shape(self.body)
        semiaxes = self.ellipsoid or (getattr(shape, "semiaxes", None) if self._plain else None)
        if semiaxes is not None:
            return Egg(self.body, scene.vector(semiaxes))
        torus = not scene.plane and shape is not None and shape.is_tyre
        if self.axis is None and not (torus and self.radius is None):
            return RollingBall(self._radius(scene))
        R = scene.value(shape.major) if torus and self.radius is None else self._radius(scene)
        tube = shape.minor if torus and self.tube is None else self.tube
        return Wheel(
            self.body, Vector((0, 0, 1) if self.axis is None else scene.vector(self.axis)), R, scene.value(tube)
        )

    @property
    def _plain(self) -> bool:
        """True if neither radius nor axis is given for the body."""
        return self.radius is None and self.axis is None

    def _radius(self, scene: LoadContext) -> Scalar:
        return scene.radius(self.body) if self.radius is None else scene.value(self.radius)
