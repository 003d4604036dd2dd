"""Picture of a state -> check: bodies, springs and arrows have the places and lengths of the model.

    R^T (r - p) of the drawing of a body fills the box of its shape, by places inside it as its mass is summed up;
    without a shape it joins the body's own places and those of its joints, and is as round as it rolls;
    a body without two places is an ellipsoid of its mass and moments, A = m (b^2 + c^2)/5, a dot or a symbol
    a spring goes from its one end to the other;   an arrow is k F, one k for all of one kind, and is at the place of F

The drawing is read as it is: places on the ground, from the strokes of a picture, or the marks of a page.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property, partial
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics import BodyLink, SystemScene
from eomgen.model import Couple, Meeting, PointForce
from eomgen.proof.at_a_state import NumericState
from eomgen.proof.check import Check, Tally
from eomgen.proof.declared_loads import placed_pushes
from eomgen.proof.reported_run import state_of_row
from eomgen.proof.states import InNumbers
from eomgen.simulation import Trajectory
from eomgen.symbolic.expression import is_zero
from eomgen.symbolic.numeric import NoValue, tolerances

NAME = "drawn parts are where the model says"
HOW = "poses and places in 50 digits, shapes by places inside them"
LARGE_SYMBOL = 0.5  # of all that is drawn; a symbol is a tenth of it
GRID = np.linspace(0.0, 1.0, 9)  # places inside a shape, along each of its parameters
WEIGHT = re.compile(r"weight\((.+)\)")
Corners = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class ReportedArrow:
    """An arrow.

    Args:
        role: "force" or "reaction".
        of: the force, joint or constraint that it stands for.
        begin, tip: its ends, d.
        head: places of its head, n x d; None where it is not read.
    """

    role: str
    of: str
    begin: np.ndarray
    tip: np.ndarray
    head: np.ndarray | None = None


@dataclass(frozen=True)
class ReportedPicture:
    """Content of a picture at one state, places in ground axes, d = 2 or 3 coordinates each.

    Args:
        bodies: of each body that is drawn by lengths its places, n x d.
        ends: of each spring, damper or pull between points (first place, last).
        arrows: of single forces, and the resultants of reactions.
        points: named points.
        size: of all that is drawn [m].
        joints: (symbol, body, place) of the symbols of joints.
        otherwise: bodies that are shown by symbols, or whose lines have a thickness.
        symbols: (what it belongs to, its places) of what is drawn of one size in every picture.
        lengths, angles: (name, how large it is drawn) of dimension lines and arcs.
        masses: of each body that an ellipsoid of inertia stands for its places, n x d.
    """

    bodies: Mapping[str, np.ndarray]
    ends: Mapping[str, tuple[np.ndarray, np.ndarray]]
    arrows: Sequence[ReportedArrow]
    points: Mapping[str, np.ndarray]
    size: float
    otherwise: frozenset[str] = frozenset()
    joints: Sequence[tuple[str, str, np.ndarray]] = ()
    symbols: Sequence[tuple[str, np.ndarray]] = ()
    lengths: Sequence[tuple[str, float]] = ()
    angles: Sequence[tuple[str, float]] = ()
    masses: Mapping[str, np.ndarray] = field(default_factory=dict)


def pictures_reported(reported: Iterable[tuple[NumericState, ReportedPicture]]) -> Iterator[Check]:
    """Check of the pictures of some states."""
    tally = Tally(NAME, HOW)
    for state, picture in reported:
        shown = _Shown(state.equations.system, state.values, state, picture)
        for name in state.equations.system.scope.model.bodies:
            if name not in picture.otherwise:
                tally.add(f"'{name}'", partial(shown.wrong_body, name))
        for name in picture.ends:
            tally.add(f"'{name}'", partial(shown.wrong_ends, name))
        for name in picture.points:
            tally.add(f"'{name}'", partial(shown.wrong_point, name))
        for symbol, body, at in picture.joints:
            tally.add(f"the joint of '{body}'", partial(shown.wrong_joint, symbol, body, at))
        for name, places in picture.symbols:
            tally.add(f"the symbol of '{name}'", partial(shown.wrong_symbol, places))
        for name, drawn in picture.lengths:
            tally.add(f"length {name}", partial(shown.wrong_length, name, drawn))
        for name, drawn in picture.angles:
            tally.add(f"angle {name}", partial(shown.wrong_angle, name, drawn))
        for role in dict.fromkeys(arrow.role for arrow in picture.arrows):
            tally.add(f"arrows of {role}s", partial(shown.wrong_arrows, role))
    return tally.checks()


def states_shown(run: Trajectory, times: np.ndarray) -> Iterator[tuple[int, NumericState]]:
    """(frame, state) of the first, the middle and the last frame, where it is a row of the run."""
    for frame in dict.fromkeys((0, len(times) // 2, len(times) - 1)) if len(times) else ():
        row = int(np.argmin(np.abs(run.t - times[frame])))
        phase = next((x for x in run.phases if x.rows[0] <= row < x.rows[1]), None)
        on_row = abs(float(run.t[row] - times[frame])) <= tolerances.COMPUTED * (1 + abs(float(times[frame])))
        if on_row and phase is not None and phase.model is not None and phase.track is not None:
            yield frame, state_of_row(run, phase, row)


@dataclass(frozen=True)
class _Shown(InNumbers):
    """A picture at its state."""

    numeric: NumericState
    picture: ReportedPicture

    @property
    def near(self) -> float:
        """Tolerance of a place [m]."""
        return tolerances.DRAWN * self.picture.size

    @property
    def d(self) -> int:
        return 2 if self.system.scope.model.space == "plane" else 3

    def placed(self, v: Sequence[Any]) -> np.ndarray:
        """Numbers of a vector, d."""
        return np.array([float(x) for x in self.at(v)[: self.d]])

    @cached_property
    def scene(self) -> SystemScene:
        return SystemScene(self.motion)

    # -- bodies ----------------------------------------------------------------------------------------------

    def wrong_body(self, name: str) -> str:
        link = self.motion.link(name)
        own = self._own(link, self.picture.bodies.get(name))
        seat = self._in_axes(link, self._ends_of(name)[0][None])[0]  # from there it may have slid
        part = self.system.scope.model.bodies[name]
        slides = any(all(map(is_zero, w)) for w, _ in link.S)
        if part.shape is not None or part.parts is not None:
            clouds = self._clouds(name)
            if not clouds:
                return ""
            if not len(own):
                return "is not drawn"
            cloud = np.concatenate(clouds)[:, : self.d]
            right = cloud.min(axis=0), cloud.max(axis=0)
            wrong = self._apart((own.min(axis=0), own.max(axis=0)), right)
            if wrong and self.d == 3 and slides:  # the way from the seat is drawn with it
                reach = np.array([seat, self.placed(link.point), *right])
                return self._apart((own.min(axis=0), own.max(axis=0)), (reach.min(axis=0), reach.max(axis=0))) and wrong
            return wrong
        if self.d == 2 and slides and len(link.S) < 3 and link.parent < 0 and self._seats(link):
            return ""  # a block, or the wedge under what slides on it
        mass = self._own(link, self.picture.masses.get(name))
        if len(mass) and (wrong := self._wrong_mass(link, mass)):
            return wrong
        for meeting in self._rolled(name):
            wrong, own = self._wrong_round(link, meeting, own)
            if wrong:
                return wrong
        if not len(own):
            alone = self._rolled(name) or (len(mass) and not self._is_long(link))
            return "" if alone else "is not drawn"
        return self._unknown_place(link, own, seat)

    def _own(self, link: BodyLink, drawn: np.ndarray | None) -> np.ndarray:
        """Places drawn of a body, in its axes, without those that are not finite."""
        places = np.zeros((0, self.d)) if drawn is None else drawn
        return self._in_axes(link, places[np.isfinite(places).all(axis=1)])

    def _in_axes(self, link: BodyLink, places: np.ndarray) -> np.ndarray:
        """R^T (r - p)"""
        pose = [float(x) for x in self.at((*(x for row in link.pose.R for x in row), *link.pose.p))]
        R, p = np.reshape(pose[:9], (3, 3))[: self.d, : self.d], np.array(pose[9:])[: self.d]
        found: np.ndarray = (places - p) @ R
        return found

    def _clouds(self, name: str) -> list[np.ndarray]:
        """Places inside the shape of a body, or inside its pieces that are no holes; none of points."""
        part, scope, clouds = self.system.scope.model.bodies[name], self.system.scope, []
        placed = [] if part.parts is None else [x for x in scope.made_of(name).pieces if x.sign > 0]
        poses = [pose.pose(scope.value) for pose in placed]
        for k, shape in enumerate(part.shapes if part.parts is None else [x.piece.shape for x in placed]):
            if shape.is_point:
                continue
            cells, grid = shape.cells(self._number), itertools.product(GRID.tolist(), repeat=shape.dimension)
            parts = [s for s in grid if len(cells) == 1 or s[0] == 1]  # of a fan of several its outer side
            cloud = np.array([cell(s) for cell in cells for s in parts], dtype=float)
            if poses:
                flat = [float(x) for x in self.at((*(x for row in poses[k].R for x in row), *poses[k].p))]
                cloud = cloud @ np.reshape(flat[:9], (3, 3)).T + np.array(flat[9:])
            clouds.append(cloud)
        return clouds

    def _number(self, expression: Any) -> float:
        return float(self.one(self.system.scope.value(expression)))

    def _apart(self, found: Corners, right: Corners) -> str:
        """Message if the corners of a box are elsewhere; a round shape may reach a little beyond grid places; ""."""
        near = tolerances.BETWEEN_PLACES * float(np.max(right[1] - right[0])) + self.near
        off = max(float(np.max(np.abs(a - b))) for a, b in zip(found, right, strict=True))
        sizes = [" x ".join(f"{x:.4g}" for x in high - low) for low, high in (found, right)]
        return "" if off <= near else f"fills {sizes[0]} m for {sizes[1]} m, or elsewhere"

    def _declared(self, link: BodyLink) -> dict[str, np.ndarray]:
        """Points of a body, and the seats of other bodies on it, in its axes: its lines reach all of them."""
        part, points = self.system.scope.model.bodies[link.name], self.motion.points[link.name]
        found = {f"its point {name}": points[name] for name in part.points}
        found |= {f"where '{x.name}' hangs on it": x.before.p for x in self._hung(link)}
        return {what: self.placed(place) for what, place in found.items()}

    def _seats(self, link: BodyLink) -> list[np.ndarray]:
        return [self.placed(link.point)] if link.joint is not None and link.joint.carries_reaction else []

    def _is_long(self, link: BodyLink) -> bool:
        """True if a body has two places far enough apart to be joined by a visible line; its mass centre may be one."""
        places = [*self._declared(link).values(), *self._seats(link)]
        center = self.motion.points[link.name].get("center")
        for more in ([], [] if center is None else [self.placed(center)]):
            places += more
            if len(places) > 1 and float(np.max(np.ptp(np.array(places), axis=0))) > self.near:
                return True
        return False

    def _unknown_place(self, link: BodyLink, own: np.ndarray, seat: np.ndarray) -> str:
        """Message if a body's lines end where none of its places is, or leave out one of them; "".

        Args:
            seat: where its joint sits, in its axes.
        """
        declared = self._declared(link)
        others = [self.placed(place) for place in (*self.motion.points[link.name].values(), (0, 0, 0))]
        places = np.array([*declared.values(), *others, *self._seats(link), seat])
        off = np.min(np.linalg.norm(own[:, None, :] - places[None, :, :], axis=2), axis=1)
        if float(np.max(off)) > self.near:
            return "a line of it ends where none of its points is"
        low, high = own.min(axis=0) - self.near, own.max(axis=0) + self.near
        outside = [what for what, place in declared.items() if np.any(place < low) or np.any(place > high)]
        return f"{outside[0]} is left out" if outside else ""

    def _rolled(self, name: str) -> list[Meeting]:
        """Contacts with which a body without a shape rolls, where a constraint says how large it is."""
        meetings = (constraint.meeting() for constraint in self.system.scope.model.constraints.values())
        found = [(each, each.ball) for each in meetings if each is not None]
        return [each for each, x in found if x and x.body == name and (x.radius is not None or x.semiaxes is not None)]

    def _wrong_round(self, link: BodyLink, meeting: Meeting, own: np.ndarray) -> tuple[str, np.ndarray]:
        """(message if a body is not as round as it rolls, its other drawn places): |(r - c)/h| = 1 along each axis."""
        what = meeting.ball
        assert what is not None
        if what.axis is not None:  # a wheel is drawn by symbols
            return "its wheel is not drawn", own
        semiaxes = what.semiaxes or (what.radius,) * 3
        h = np.array([abs(self._number(x)) for x in semiaxes[: self.d]])
        c = self.placed(self.motion.points[link.name][what.center or "origin"])
        on = np.abs(np.linalg.norm((own - c) / h, axis=1) - 1) * np.min(h) <= self.near
        rim = own[on]
        if not len(rim):
            return "is not drawn as it rolls", own
        off = np.maximum(np.abs(rim.min(axis=0) - (c - h)), np.abs(rim.max(axis=0) - (c + h)))
        return "is not as large as it rolls" if np.any(off > tolerances.BETWEEN_PLACES * h + self.near) else "", own[
            ~on
        ]

    def _wrong_mass(self, link: BodyLink, drawn: np.ndarray) -> str:
        """Message if the ellipsoid for a body has another centre or other moments: A = m (b^2 + c^2)/5; ""."""
        mass = self.system.scope.mass_properties(link.name)
        low, high = drawn.min(axis=0), drawn.max(axis=0)
        size = float(np.max(high - low))
        if float(np.max(np.abs((low + high) / 2 - self.placed(mass.com)))) > tolerances.STANDS_FOR_A_MASS * size:
            return "its ellipsoid is not about its mass centre"
        m, moments = float(self.one(mass.m)), np.array([float(self.one(mass.I[k][k])) for k in range(3)])
        squares = ((high - low) / 2) ** 2
        found = m / 5 * (np.sum(squares) - squares)
        beyond = max(0.0, *(2 * moments - np.sum(moments)))  # of moments that no body has the axis that is none is 0
        off = float(np.max(np.abs(found - moments))) - beyond
        return (
            "its ellipsoid has other moments" if off > 2 * tolerances.STANDS_FOR_A_MASS * float(np.max(moments)) else ""
        )

    def _hung(self, link: BodyLink) -> list[BodyLink]:
        """Bodies whose joints sit at a place fixed in the body."""
        others = (other for other in self.motion.links if other.parent == self.motion.index[link.name])
        return [other for other in others if not self.motion.moves(other.before.p)]

    # -- springs, points, arrows -----------------------------------------------------------------------------

    def wrong_ends(self, name: str) -> str:
        right = self._ends_of(name)
        if len(right) != 2:
            return "there is no such spring"
        off = max(float(np.linalg.norm(a - b)) for a, b in zip(self.picture.ends[name], right, strict=True))
        return f"ends {off:.4g} m from its points" if off > self.near else ""

    def _ends_of(self, name: str) -> list[np.ndarray]:
        """Ends of a spring or damper: its points, or the seat of its joint and the place where the body is held."""
        force = self.system.scope.model.forces.get(name)
        if force is not None:
            points = () if force.element is None else force.element.points
            return [self.placed(self.scene.position(self.scene.place(point))) for point in points]
        link = self.motion.link(name)
        above = None if link.parent < 0 else self.motion.links[link.parent].name
        return [self.placed(self.motion.position(x)) for x in ((above, link.before.p), (name, link.point))]

    def wrong_joint(self, symbol: str, body: str, at: np.ndarray) -> str:
        """Message if the symbol of a joint stands elsewhere, or wrongly shows a joint with the ground; ""."""
        link = self.motion.link(body)
        places = self._ends_of(body)
        if min(float(np.linalg.norm(at - place)) for place in places) > self.near:
            return "stands elsewhere"
        grounded = {"pin": True, "clamp": True, "hinge": False, "weld": False}.get(symbol) if self.d == 2 else None
        return f"is shown as a {symbol}" if grounded is not None and grounded != (link.parent < 0) else ""

    def wrong_symbol(self, places: np.ndarray) -> str:
        """Message if a symbol has no place, or is as large as the whole picture; ""."""
        finite = places[np.isfinite(places).all(axis=1)]
        if not len(finite):
            return "has no place"
        size = float(np.max(np.ptp(finite, axis=0)))
        return f"is {size:.4g} m large" if size > LARGE_SYMBOL * self.picture.size else ""

    def wrong_point(self, name: str) -> str:
        right = self.placed(self.scene.position(self.scene.place(name)))
        off = float(np.linalg.norm(self.picture.points[name] - right))
        return f"{off:.4g} m from its place" if off > self.near else ""

    def wrong_length(self, name: str, drawn: float) -> str:
        """Message if a dimension line has another length than its label; ""."""
        right = abs(self._named(name))
        return f"{drawn:.6g} m for {right:.6g} m" if abs(drawn - right) > self.near else ""

    def wrong_angle(self, name: str, drawn: float) -> str:
        """Message if an arc has another angle than its label, apart from whole turns; ""."""
        right = self._named(name)
        off = min(abs((drawn - turned + np.pi) % (2 * np.pi) - np.pi) for turned in (right, -right))
        return f"{drawn:.6g} for {right:.6g}" if off > tolerances.DRAWN else ""

    def _named(self, name: str) -> float:
        symbols = self.system.symbols
        found = {**symbols.parameters, **{q.name: q for q in symbols.q}}
        if name not in found:
            raise NoValue("it is not known")
        return float(self.one(found[name]))

    def wrong_arrows(self, role: str) -> str:
        """Message if an arrow has another direction than its force, another scale than the others, or place; ""."""
        scales: list[tuple[str, float]] = []
        largest = 0.0
        for arrow in self.picture.arrows:
            known = self._force(arrow) if arrow.role == role == "force" else self._reaction(arrow)
            if arrow.role != role or known is None:
                continue
            at, force = known
            along, size = arrow.tip - arrow.begin, float(np.linalg.norm(force))
            largest = max(largest, size)
            length = float(np.linalg.norm(along))
            if at is not None and self._away(arrow, at) > self.near:
                return f"that of {arrow.of} is not where it acts"
            if (
                np.linalg.norm(along * size - force * length)
                > tolerances.SAME_ARROW * size * length + tolerances.COMPUTED
            ):
                return f"that of {arrow.of} goes another way"
            if arrow.head is not None and np.max((arrow.head - arrow.tip) @ along) > self.near * length:
                return f"that of {arrow.of} has its head the other way round"
            scales.append((arrow.of, length / size if size else 0.0))
        if not scales:
            raise NoValue("their forces are not known apart")
        common = float(np.median([scale for _, scale in scales if scale] or [0.0]))
        off = next((of for of, scale in scales if scale and abs(scale - common) > tolerances.SAME_ARROW * common), "")
        return f"that of {off} is of another scale" if off else ""

    def _force(self, arrow: ReportedArrow) -> tuple[np.ndarray | None, np.ndarray] | None:
        """(place, force) of a force at a point, the weight of a body, or a spring at that of its ends where the arrow
        is; None of others."""
        if self.system.symbols.unknowns:
            return None
        weighed = WEIGHT.fullmatch(arrow.of)
        forces = self.system.scope.model.forces
        names = [x for x, f in forces.items() if (f.by_mass if weighed else x == arrow.of and f.pushed_points)]
        pushes = [
            (self.placed(place), np.array([float(x) for x in push[: self.d]]))
            for body, place, push in placed_pushes(self.system, self.state, names)
            if not weighed or body == weighed[1]
        ]
        if weighed and pushes:
            return pushes[0][0], np.sum([push for _, push in pushes], axis=0)
        return min(pushes, key=lambda one: self._away(arrow, one[0]), default=None)

    def _away(self, arrow: ReportedArrow, at: np.ndarray) -> float:
        return float(min(np.linalg.norm(arrow.tip - at), np.linalg.norm(arrow.begin - at)))

    def _reaction(self, arrow: ReportedArrow) -> tuple[np.ndarray | None, np.ndarray] | None:
        """(place, resultant) of the reactions of a joint or constraint; None where some have no single value."""
        owner = arrow.of
        if any(row.component == "tension" for row in self.system.constraints.rows if row.constraint == owner):
            return self._of_string(arrow)
        names = [f"reaction_{axis}({owner})" for axis in "xyz"[: self.d]]
        found = [self.numeric.reactions.get(name) for name in names]
        if any(x is None or not np.isfinite(x) for x in found):
            return self._of_contact(owner) if not any(name in self.numeric.reactions for name in names) else None
        at = None
        if owner in self.motion.index:
            at = self.placed(self.motion.position((owner, self.motion.link(owner).point)))
        return at, np.array([float(x) for x in found if x is not None])

    def _of_string(self, arrow: ReportedArrow) -> tuple[np.ndarray | None, np.ndarray] | None:
        """(place, tension) of the end of a string or link that is nearest to what an arrow shows.

        On a pulley its place is as far from the centre as its moment about that has it.
        """
        rows = [row for row in self.system.constraints.rows if row.constraint == arrow.of]
        found: list[tuple[float, np.ndarray, np.ndarray]] = []
        for number, row in enumerate(rows, start=1):
            name = f"tension({arrow.of}, {number})" if number > 1 else f"tension({arrow.of})"
            size = self.numeric.reactions.get(name, np.nan)
            if not np.isfinite(float(size)):
                return None
            for push, beside in zip(row.pushes, (*row.pushes[1:], None), strict=True):
                if not isinstance(push, PointForce) or push.place[0] is None:
                    continue
                turns = beside.couple if isinstance(beside, Couple) else (0, 0, 0)
                couple = float(size) * np.array([float(x) for x in self.at(turns)])
                center = self.placed(self.motion.position(push.place))
                pushed = self.carried(push.axes, self.vector(push.force), direction=True)
                force = float(size) * np.array(pushed[: self.d], dtype=float)
                off, along, most = arrow.begin - center, arrow.tip - arrow.begin, float(np.linalg.norm(force)) or 1.0
                arm = float(np.linalg.norm(couple)) / most
                at = center + off * (arm / (float(np.linalg.norm(off)) or 1.0)) if arm else center
                apart = np.linalg.norm(along) - along @ force / most
                turned = np.linalg.norm(np.cross([*off, 0][:3], [*force, 0][:3]) - couple) / most
                found.append((float(self._away(arrow, at) + apart + turned), at, force))
        return min(found, key=lambda each: each[0])[1:] if found else None

    def _of_contact(self, owner: str) -> tuple[np.ndarray | None, np.ndarray] | None:
        """(place, resultant) of the rows of a contact: each along its own force, friction along its tangents."""
        at, total = None, np.zeros(self.d)
        for row in (row for row in self.system.constraints.rows if row.constraint == owner):
            braking = (("t", row.tangent), ("s", row.cross_tangent)) if row.friction is not None else ()
            for label, pushes in ((row.component, row.pushes), *braking):
                push = next((x for x in pushes if isinstance(x, PointForce) and x.place[0] is not None), None)
                if push is None and label != row.component:
                    continue
                size = self.numeric.reactions.get(f"reaction_{label}({owner})")
                if push is None or size is None or not np.isfinite(size):
                    return None
                pushed = self.carried(push.axes, self.vector(push.force), direction=True)
                total += float(size) * np.array(pushed[: self.d], dtype=float)
                at = self.placed(self.motion.position(push.place))
                at = at if push.beyond is None else at + self.placed(push.beyond)
        return None if at is None else (at, total)


# -- the scene of a page ------------------------------------------------------------------------------------------


def picture_of_page(reported: Mapping[str, Any], slots: Sequence[float]) -> ReportedPicture:
    """Picture that a page draws by its scene, with the numbers of a frame in its slots."""
    return _Page(reported, slots).picture


@dataclass(frozen=True)
class _Page:
    reported: Mapping[str, Any]
    slots: Sequence[float]

    def number(self, x: Any) -> float:
        return float(self.slots[x[0]] if isinstance(x, list) else x)

    def spot(self, at: Sequence[Any]) -> np.ndarray:
        return np.array([self.number(x) for x in at])

    @cached_property
    def poses(self) -> list[tuple[np.ndarray, np.ndarray]]:
        plane = self.reported["space"] == "plane"
        d = 2 if plane else 3
        found: list[tuple[np.ndarray, np.ndarray]] = []
        for frame in self.reported["frames"]:
            R, p = np.eye(d), np.zeros(d)
            if frame["pose"] is not None:
                numbers = self.spot(frame["pose"])
                p = numbers[:d]
                R = (
                    np.array([[numbers[2], -numbers[3]], [numbers[3], numbers[2]]])
                    if plane
                    else numbers[3:].reshape(3, 3)
                )
            if frame["parent"] >= 0:
                above, origin = found[frame["parent"]]
                R, p = above @ R, origin + above @ p
            found.append((R, p))
        return found

    @property
    def picture(self) -> ReportedPicture:
        bodies: dict[str, list[np.ndarray]] = {}
        masses: dict[str, np.ndarray] = {}
        ends, arrows, left, joints = {}, [], set[str](), []
        for mark in self.reported["marks"]:
            R, p = self.poses[mark["frame"]]
            role, of, kind = mark["role"], mark["of"], mark["kind"]
            if role == "body":
                own = self._own(kind, mark)
                if own is None:
                    left.add(of)
                else:
                    bodies.setdefault(of, []).append(own @ R.T + p)
            elif role == "inertia" and (own := self._own(kind, mark)) is not None:
                masses[of] = own @ R.T + p
            elif kind == "symbol" and role in ("support", "joint") and of in self._bodies:
                joints.append((mark["symbol"], of, R @ self.spot(mark["at"]) + p))
            elif kind in ("spring", "damper", "cylinder"):
                ends[of] = (R @ self.spot(mark["a"]) + p, R @ self.spot(mark["b"]) + p)
            elif kind == "arrow" and role in ("force", "reaction"):
                at, way = R @ self.spot(mark["at"]) + p, R @ self.spot(mark["vector"])
                arrows.append(
                    ReportedArrow(role, of, at, at + way) if mark["outward"] else ReportedArrow(role, of, at - way, at)
                )
        points = {point["name"]: self.spot(point["at"]) for point in self.reported["points"]}
        shown = {name: np.concatenate(clouds) for name, clouds in bodies.items() if name not in left}
        clouds = [*(x for each in bodies.values() for x in each), *masses.values(), *(x[None] for x in points.values())]
        cloud = np.concatenate(clouds)
        finite = cloud[np.isfinite(cloud).all(axis=1)]
        size = float(np.max(np.ptp(finite, axis=0))) if len(finite) else 1.0
        return ReportedPicture(shown, ends, arrows, points, size or 1.0, frozenset(left), joints, masses=masses)

    @property
    def _bodies(self) -> set[str]:
        return {frame["name"] for frame in self.reported["frames"]} - {""}

    def _own(self, kind: str, mark: Mapping[str, Any]) -> np.ndarray | None:
        """Farthest places of a form in its own axes; None for a form without a length in the model."""
        if kind in ("line", "polygon", "polyhedron"):
            return np.array([self.spot(at) for at in mark["points"]])
        if kind == "rod":
            return np.array([self.spot(mark["a"]), self.spot(mark["b"])])
        if kind == "point":
            return self.spot(mark["at"])[None]
        if kind == "arc":
            return self._arc(mark)
        if kind in ("box", "ellipsoid"):
            half = self.spot(mark["size"]) * (0.5 if kind == "box" else 1.0)
            signs = itertools.product((-1, 1), repeat=3) if kind == "box" else (*np.eye(3), *-np.eye(3))
            return np.array([self.spot(mark["at"]) + half * np.array(sign) for sign in signs])
        if kind == "revolution":
            rims = [(self.number(r), self.number(z)) for r, z in mark["profile"]]
            rings = [(r * x, r * y, z) for r, z in rims for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
            rims_of: np.ndarray = np.array(rings) + self.spot(mark["at"])[None]
            return rims_of
        if kind == "prism":
            low, high = self.number(mark["low"]), self.number(mark["high"])
            return np.array([(self.number(x), self.number(y), z) for x, y in mark["points"] for z in (low, high)])
        return None

    def _arc(self, mark: Mapping[str, Any]) -> np.ndarray:
        start = 0.0 if mark["start"] is None else self.number(mark["start"])
        end = start + 2 * np.pi if mark["end"] is None else self.number(mark["end"])
        end += 2 * np.pi * (end < start)
        turn = np.linspace(start, end, 73)
        at, x, y = self.spot(mark["at"]), self.number(mark["radius"]), self.number(mark["radius_y"])
        rim = np.column_stack([x * np.cos(turn), y * np.sin(turn), *([np.zeros(73)] if len(at) == 3 else [])])
        found: np.ndarray = np.concatenate([at + rim, *([at[None]] if mark["close"] == "center" else [])])
        return found
