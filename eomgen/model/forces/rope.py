"""Elastic ropes, over pulleys and drums."""

from collections.abc import Iterator
from typing import Any, ClassVar

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, diagnostics_of_one, is_round, owner_of
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.base import Act, Force, ForceTrial, StretchedRope
from eomgen.model.forces.load import Couple, Load, LoadContext, PointForce
from eomgen.model.kinds import LinearDamping, LinearStiffness, NaturalLength, Route
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Fraction, Scalar, function


@dataclass(frozen=True, kw_only=True)
class Rope(Force):
    """An elastic rope, which only pulls: T = k s + c s' where its stretch s is above 0, and never below 0; else slack.

    s is the length of its straight pieces, and what drums at its ends have wound up, less the length without tension.
    That counts from where the angles of the drums are 0; arcs on what it slides over are left out, as they stay.

    Args:
        path: points and wraps, in the order of travel; what it passes in between is an eyelet or slips.
        stiffness: k of the whole rope [N/m].
        length: without tension [m], which may be a function of t, or "start": its length at the start.
        damping: c [N s/m].
    """

    kind: ClassVar[str] = "rope"
    tight: ClassVar[bool] = True
    path: Route
    stiffness: LinearStiffness
    length: NaturalLength
    damping: LinearDamping | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of wraps without size or sense, of those that grip in between, of a rope that pulls nothing."""
        for k, wrap in enumerate(self.path or ()):
            where = (*path, "path", k)
            if isinstance(wrap, str):
                continue
            yield from diagnostics_of_one(catalog, where, wrap, ("body", "at"))
            if wrap.radius is None and (wrap.at is not None or not is_round(catalog, wrap.body)):
                what = "the radius of this wrap is not known"
                yield Diagnostic(where, what, "give 'radius', or the body a round shape")
            if wrap.turn is None and (*where, "turn") not in catalog.broken:
                what = "a wrap needs 'turn': the sense in which one travels round it"
                yield Diagnostic(where, what, 'turn = "cw" or "ccw"')
            if 0 < k < len(self.path) - 1 and not wrap.slip:
                what = f"the rope '{path[1]}' has one tension: it slips on what it passes"
                yield Diagnostic(where, what, "slip = true, or one rope on each side")
        owners = {owner_of(stop) if isinstance(stop, str) else stop.body or "" for stop in self.path or ()}
        if len(owners) == 1:
            what = f"the rope '{path[1]}' has nothing on it that it could pull: all of it is on one body or the ground"
            yield Diagnostic((*path, "path"), what, "fasten a body to it, or wind it on a drum that can turn")

    @property
    def of_the_start(self) -> bool:
        return self.length == "start"

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        rope = here.rope(self.path, self.length)
        yield from rope.pulled(self._tension(here, rope))

    def pulled(self, here: ForceTrial) -> Any:
        return self._tension(here, here.rope(self.path, self.length))

    def _tension(self, here: ForceTrial, rope: StretchedRope) -> Any:
        """k s + c s' where both s and that are above 0, else 0."""
        s, k, c = rope.stretch, here.value(self.stiffness), here.value(self.damping)
        return 0 * s if s <= 0 else max(k * s + c * (rope.rate if c else 0), 0 * s)

    def strands_at(self, scene: LoadContext) -> tuple[Any, ...]:
        return scene.strands(self.path)

    def effort(self, scene: LoadContext) -> Scalar:
        """T [N]."""
        s, k = self._stretch(scene), scene.value(self.stiffness)
        if self.damping is None:
            return function("max", 0, k * s)
        pull = function("max", 0, k * s + scene.value(self.damping) * scene.rate(s))
        return pull * function("max", 0, function("sign", s))

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """T along every strand, on what it leaves and what it reaches."""
        T = self.effort(scene)
        pushes = [push for strand in self.strands_at(scene) for push in strand.pulls]
        return tuple(
            PointForce(push.place, T * push.force)
            if isinstance(push, PointForce)
            else Couple(push.body, T * push.couple)
            for push in pushes
        )

    def potential(self, scene: LoadContext) -> Scalar | None:
        """V = k s^2/2 where s > 0; None with damping."""
        if self.damping is not None:
            return None
        s = function("max", 0, self._stretch(scene))
        return Fraction(1, 2) * scene.value(self.stiffness) * s * s

    def _stretch(self, scene: LoadContext) -> Scalar:
        """Length of the strands and of what drums paid out, less the length without tension."""
        used: Scalar = 0
        for strand in self.strands_at(scene):
            if strand.length is None or strand.first.winds or strand.second.winds:
                raise DerivationError(
                    "how long the rope is on a round thing that its strand turns about is not known",
                    scene.where,
                    "lead it through an eyelet, a point, before the drum, so that the strand there keeps its direction",
                )
            used = used + strand.length + strand.first.wound - strand.second.wound
        return used - (scene.start(used) if self.length == "start" else scene.value(self.length))
