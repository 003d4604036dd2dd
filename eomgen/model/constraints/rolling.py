"""Rolling: a round body on a line, a circle or another body; in space on a plane, a ball or a pipe."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from eomgen.errors import ModelError
from eomgen.model.catalog import Catalog, findings_of_one, is_round, not_in_the_plane
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.meeting import FlatSurface, Meeting, RoundSurface, TouchingRound
from eomgen.model.constraints.plane import Touch, opposite
from eomgen.model.constraints.round_bodies import Egg, RollingBall, Round, Wheel
from eomgen.model.constraints.row import Edge, TieRow
from eomgen.model.constraints.tracks import (
    Circle,
    Curved,
    Track,
    TrackContact,
    curved,
    normal_of,
    on_curved,
    on_level,
    wheel_on_ball,
)
from eomgen.model.findings import Finding
from eomgen.model.forces.load import LoadContext
from eomgen.model.friction import FrictionLaw
from eomgen.model.kinds import BodyName, Flag, Length, OwnPlace, Radius, Size, SpaceDirection
from eomgen.model.part import PartRule
from eomgen.model.positions import DocumentPath
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar, dot, minus

TrackField = Annotated[Track, PartRule(Track)]
CircleField = Annotated[Circle, PartRule(Circle)]

TRACKS = ("line", "plane", "circle")
ALONG = ("t", "s")
"""What the components along a contact are called."""


@dataclass(frozen=True, kw_only=True)
class Rolling(Constraint):
    """The contact (a normal row) and no slip (its other rows).

    Args:
        body: what rolls.
        line, plane, circle: on which it rolls, in the ground, or with `on` in that body's axes.
        on: the other body (alone: a round one).
        slip: True leaves the contact row only.
        unilateral: it can only push.
        friction: with slip.
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

    def findings(self, path: DocumentPath, catalog: Catalog) -> Iterator[Finding]:
        """Tracks and sizes that are missing or exclude one another, or that are for another space."""
        alone = self.on is not None and all(getattr(self, track) is None for track in TRACKS)
        yield from findings_of_one(catalog, path, self, (*TRACKS, "on") if self.on is None or alone else TRACKS)
        yield from self._wrong_sizes(path, catalog)
        if alone and not is_round(catalog, self.on):
            what = f"'{self.body}' rolls on body '{self.on}', which is not round"
            yield Finding((*path, "on"), what, "give the line or circle of it, or the body a round shape")
        track = self.line or self.plane or self.circle
        if self.on is not None and track is not None and isinstance(track.at, str):
            what = f"'{track.at}' is a point of the ground, but the track is fixed in body '{self.on}'"
            yield Finding(path, what, f"give 'at' as coordinates in the axes of '{self.on}'")
        yield from self._of_other_space(path, catalog, curved=alone or self.circle is not None)
        if self.on is not None and self.on == self.body:
            yield Finding((*path, "on"), f"'{self.body}' cannot roll on itself")
        if self.friction is not None and not self.slip:
            yield Finding(
                (*path, "friction"), "friction needs sliding", "slip = true, or leave 'friction' out", key=True
            )

    def _wrong_sizes(self, path: DocumentPath, catalog: Catalog) -> Iterator[Finding]:
        """A radius, or semiaxes, of the tie or of the shape; not both; a tyre only about an axis."""
        sizes = ("radius",) if catalog.model.space == "plane" else ("radius", "semiaxes", "major")
        if self.radius is None and self.ellipsoid is None and not is_round(catalog, self.body, sizes):
            what = f"the radius of '{self.body}', which rolls, is not known"
            yield Finding(path, what, "give 'radius', or the body a round shape")
        for key in ("radius", "axis", "tube") if self.ellipsoid is not None else ():
            if getattr(self, key) is not None:
                what = f"'{path[1]}' has an 'ellipsoid' and '{key}': it is one or the other"
                yield Finding((*path, key), what, "keep one", key=True)
        if self.tube is not None and self.axis is None and not is_round(catalog, self.body, ("major",)):
            yield Finding((*path, "tube"), f"the tyre of '{self.body}' has no 'axis'", "give it, body axes", key=True)

    def _of_other_space(self, path: DocumentPath, catalog: Catalog, curved: bool) -> Iterator[Finding]:
        """In the plane no fields of space; in space a plane for a line; wheels on planes and balls, eggs on planes."""
        if catalog.model.space == "plane":
            if self.plane is not None:
                mend = "in the plane a body rolls on a 'line'"
                yield Finding((*path, "plane"), f"'plane' of '{path[1]}' is for space", mend, key=True)
            yield from not_in_the_plane(catalog, path, self, ("axis", "ellipsoid", "tube"))
            if self.circle is not None and self.circle.axis is not None:
                yield Finding(
                    (*path, "circle", "axis"), f"'axis' of '{path[1]}' is for space", "leave it out", key=True
                )
            return
        if self.line is not None:
            yield Finding((*path, "line"), f"'line' of '{path[1]}' is for the plane", "in space: 'plane'", key=True)
        pipe = self.circle is not None and self.circle.axis is not None
        for key in (*(["axis"] if pipe else []), "ellipsoid") if curved else ():
            if getattr(self, key) is not None:
                where = (
                    "only a ball rolls in or on a pipe" if key == "axis" else "no ellipsoid rolls on something curved"
                )
                what = f"'{path[1]}': {where}, '{self.body}' has '{key}'"
                yield Finding((*path, key), what, "let it roll on a 'plane', or leave it out", key=True)

    def meeting(self) -> Meeting:
        """The round body and its track."""
        body = TouchingRound(self.body, self._hub, self.radius, self.axis, self.tube, self.ellipsoid)
        flat, track = self.line or self.plane, self.circle
        if flat is not None:
            return Meeting(body, FlatSurface(self.on, flat.at, flat.normal), not self.slip)
        if track is None:
            return Meeting(body, RoundSurface(self.on, None, None), not self.slip)
        surface = RoundSurface(self.on, track.at, track.radius, bool(track.inside), track.axis)
        return Meeting(body, surface, not self.slip)

    def misplaced(self, scene: LoadContext) -> tuple[str, str]:
        """Within a circle that is rolled on outside."""
        if self.circle is None or self.circle.inside:
            return "", ""
        track = self._curved(scene)
        out = minus(scene.position(scene.own_place(self.body, self._hub)), scene.position(track.anchor))
        along = 0 if track.axis is None else dot(track.axis, out)
        away, r = scene.worth(dot(out, out) - along * along), scene.worth(track.r)
        if away is None or r is None or away >= r * r:
            return "", ""
        name = scene.where.rpartition(".")[2]
        what = f"'{self.body}' starts within the circle of '{name}', and would roll on its outside"
        return what, "inside = true, where it rolls in it"

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
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
            return (TieRow(normal, contact.gap, component="n", tangent=tangent, cross_tangent=cross_tangent),)
        held = (TieRow(push, None, component=name, material=True) for name, push in zip(ALONG, along, strict=False))
        return (TieRow(normal, contact.gap, component="n"), *held)

    def edges(self, scene: LoadContext) -> tuple[Edge, ...]:
        """A wheel must not lie flat, on a ball neither."""
        body, name = self._round(scene), scene.where.rpartition(".")[2]
        if not isinstance(body, Wheel):
            return ()
        if self.plane is not None:
            n = normal_of(scene, self.on, self.plane)
            return (Edge(f"'{self.body}' lies flat in '{name}'", body.tilt(scene, n)),)
        center = scene.position(scene.own_place(self.body, self._hub))
        out = minus(center, scene.position(self._curved(scene).anchor))
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
        """What touches: a ball (in the plane a disc), a wheel, an ellipsoid; sizes left out are those of the shape."""
        shape = scene.shape(self.body)
        semiaxes = self.ellipsoid or (getattr(shape, "semiaxes", None) if self._plain else None)
        if semiaxes is not None:
            return Egg(self.body, scene.vector(semiaxes))
        torus = not scene.plane and shape is not None and shape.is_tyre
        if self.axis is None and not (torus and self.radius is None):
            return RollingBall(self._radius(scene))
        R = scene.value(shape.major) if torus and self.radius is None else self._radius(scene)
        tube = shape.minor if torus and self.tube is None else self.tube
        return Wheel(self.body, (0, 0, 1) if self.axis is None else scene.vector(self.axis), R, scene.value(tube))

    @property
    def _plain(self) -> bool:
        """Whether nothing is said of the body's form."""
        return self.radius is None and self.axis is None

    def _radius(self, scene: LoadContext) -> AnyScalar:
        return scene.radius(self.body) if self.radius is None else scene.value(self.radius)
