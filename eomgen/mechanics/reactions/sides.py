"""Balance -> reactions by the balance of all bodies on one side of a joint or tie, which hold together by it alone.

Cut it through: the side without the ground is held by nothing else, so that what acts at the cut is

    f = sum(m a_C - f_applied),    n = sum(d/dt (I w) - n_applied + (C - P) x (m a_C - f_applied))    about its place P

and a component is the projection of that on its unit wrench. Of two free sides the one with fewer bodies is taken.
Nothing is solved for, so nothing is divided by.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

from eomgen.mechanics.balance.balance import Balance
from eomgen.mechanics.balance.components import Component
from eomgen.mechanics.balance.unit_wrenches import Axes, Effect
from eomgen.mechanics.bodies.kinematics import GROUND
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import equal
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.spatial import (
    IDENTITY,
    ZERO,
    Matrix,
    Pose,
    Vector,
    apply,
    cross,
    dot,
    minus,
    plus,
    product,
    transposed,
    vector_of,
)

FORCES, MOMENTS = range(3), range(3, 6)
MOST_BODIES = 12  # of a system in which sides are added up: a chain of n has n^2/2 bodies on all its sides


def reactions_by_sides(balance: Balance) -> dict[int, Scalar]:
    """The components, by their number, that one side of their joint or tie gives; none where there is friction."""
    links = balance.system.motion.links
    if len(links) > MOST_BODIES or balance.unknowns or any(c.frictional for c in balance.components):
        return {}
    sides = _Sides(balance)
    cuts: dict[tuple[str, str], list[int]] = {}
    for j, c in enumerate(balance.components):
        cuts.setdefault((c.owner, c.side if c.kind == "tie" else ""), []).append(j)
    return {j: x for numbers in cuts.values() for j, x in sides.of_cut(numbers).items()}


@dataclass(frozen=True)
class _Sides:
    balance: Balance

    @cached_property
    def axes(self) -> Axes:
        return Axes(self.balance.system.motion)

    @cached_property
    def _needed(self) -> dict[tuple[int, int], Scalar]:
        index = self.balance.system.motion.index
        return {(index[e.body], e.direction): e.needed for e in self.balance.equations}

    def of_cut(self, numbers: Sequence[int]) -> dict[int, Scalar]:
        """The components of one joint or tie; none where its bodies hang together by something else, too."""
        components = [self.balance.components[j] for j in numbers]
        ends = {effect.link for c in components for effect in c.effects}
        sides = [side for end in sorted(ends) if GROUND not in (side := self._side(end, set(numbers)))]
        sides = [side for side in sides if len(ends & side) == 1]
        if not sides:
            return {}
        side = min(sides, key=lambda each: (len(each), min(ends & each)))
        (body,) = ends & side
        mine = [_only([effect for effect in c.effects if effect.link == body]) for c in components]
        found = {}
        for j, effect in zip(numbers, mine, strict=True):
            if effect is None or effect.place is None or not _is_apart(effect, mine):
                continue
            force, couple = self._held(body, side, effect)
            found[j] = dot(effect.force, force) + dot(effect.couple, couple)
        return found

    def _side(self, start: int, cut: set[int]) -> frozenset[int]:
        """The bodies, and GROUND, that hang together with the start when these components are cut through."""
        joined: dict[int, set[int]] = {}
        for j, ends in enumerate(self._ends):
            if j not in cut:
                for end in ends:
                    joined.setdefault(end, set()).update(ends)
        reached, pending = {start}, [start]
        while pending:
            for other in joined.get(pending.pop(), set()) - reached:
                if other != GROUND:
                    pending.append(other)
                reached.add(other)
        return frozenset(reached)

    @cached_property
    def _ends(self) -> list[set[int]]:
        """What each component joins: the ground too, where its pushes on bodies do not make up for one another."""
        found = []
        for c in self.balance.components:
            ends = {effect.link for effect in c.effects}
            found.append(ends if len(ends) > 1 and self._is_even(c) else ends | {GROUND})
        return found

    def _is_even(self, component: Component) -> bool:
        """Whether action and reaction are among its pushes: a string over a peg of the ground presses on that, too."""
        if component.kind != "tie":
            return True
        total: list[Scalar] = [0] * 6
        for effect in component.effects:
            pose = self.axes.motion.links[effect.link].pose
            R = IDENTITY if self.axes.plane else pose.R
            force, couple = apply(R, effect.force), apply(R, effect.couple)
            if effect.place is not None:
                couple = plus(couple, cross(pose.point(effect.place), force))
            elif any(not is_zero(x) for x in force):
                return False
            total = [x + y for x, y in zip(total, (*force, *couple), strict=True)]
        return all(equal(x, 0) for x in total)

    def _held(self, body: int, side: Iterable[int], effect: Effect) -> tuple[Vector, Vector]:
        """Force, and couple about the place of the effect, in the axes of the body's equations."""
        force, couple = ZERO, ZERO
        for b in sorted(side):
            R, arm = self._seen(b, body, effect)
            f, n = (apply(R, vector_of(self._needed.get((b, d), 0) for d in rows)) for rows in (FORCES, MOMENTS))
            force, couple = plus(force, f), plus(couple, plus(n, cross(arm, f)))
        return force, couple

    def _seen(self, b: int, body: int, effect: Effect) -> tuple[Matrix, Vector]:
        """(rotation into the body's axes, from the effect's place to the mass centre of b in them)."""
        assert effect.place is not None
        links, com = self.axes.motion.links, self.axes.masses[b].com
        if self.axes.plane:
            return IDENTITY, minus(links[b].pose.point(com), links[body].pose.point(effect.place))
        pose = self._relative(b, body)
        return pose.R, minus(pose.point(com), effect.place)

    def _relative(self, b: int, body: int) -> Pose:
        """Of b in the axes of another body: along the tree where it hangs on that."""
        links = self.axes.motion.links
        path: list[int] = []
        while b not in (body, GROUND):
            path.append(b)
            b = links[b].parent
        if b == GROUND and body != GROUND:
            R = transposed(links[body].pose.R)
            last = links[path[0]].pose if path else Pose()
            return Pose(product(R, last.R), apply(R, minus(last.p, links[body].pose.p)))
        pose = Pose()
        for k in reversed(path):
            local = links[k].local
            pose = pose.then(Pose(local.R, minus(local.p, apply(local.R, links[k].point))))
        return pose


def _only(effects: Sequence[Effect]) -> Effect | None:
    return effects[0] if len(effects) == 1 else None


def _is_apart(effect: Effect, others: Sequence[Effect | None]) -> bool:
    """Whether it is of size 1, and what the others of the cut give is not seen along it."""
    for other in others:
        if other is None or other.place != effect.place:
            return False
        along = dot(effect.force, other.force) + dot(effect.couple, other.couple)
        if not equal(along, 1 if other is effect else 0):
            return False
    return True
