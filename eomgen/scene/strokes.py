"""Scene, frames -> strokes: every mark as paths in ground axes, along a whole motion at once.

A path is n x k x d, over n frames: k points of the plane (d = 2) or of space (d = 3); nan breaks it. What a drawer adds
are colours and letters. Symbols have one size in a picture: `unit`, a part of its extent.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.model import Form
from eomgen.scene.scene import Mark, Scene, frame_at, is_moving, plain_number
from eomgen.study import StateInNumbers
from eomgen.symbolic.expression import Vector
from eomgen.symbolic.numeric import tolerances

SYMBOL = 0.028  # symbol unit, of the extent
ARROW = 0.2  # the longest arrow, of the extent
WIDEST = 14.0  # of the rest, how large a guide may be that is shown as a whole: a bowl under its ball
LONELY = 14.0  # side of a picture of one point [symbol units]
SHOWN = frozenset(("body", "inertia"))
"""Roles that are a body itself."""
NEAR = 1.0  # symbol units between the middles of bodies whose names stand at their rims
SIDES_OF_NAMES = (
    (0.6, 0.6, 0.7),
    (-0.6, 0.6, 0.7),
    (0.6, -0.6, -0.7),
    (-0.6, -0.6, -0.7),
)  # the first, the second, ...
CLEAR_WAYS = ((0, 0), (3, 0), (6, 0), (9, 0), (0, 6), (0, -6), (6, 6), (6, -6), (12, 0), (16, 0))
"""Ways by which the arrow of the weight is moved out of the way, the first first [symbol units]."""
MOST_DOTS = 400  # along one line
QUANTILE = 0.98  # of all arrows of a kind are no longer than that
FORCES = ("force", "reaction")
"""Roles of forces, drawn to one scale."""
SOLID = frozenset(
    ("body", "inertia", "rim", "member", "string", "spring", "damper", "cylinder", "joint", "support", "center")
)
"""Roles that make up the extent of a picture."""


@dataclass(frozen=True)
class Stroke:
    """A path to draw.

    Args:
        path: n x k x d [m].
        filled: its inside is filled; hole: with paper.
        fine: thinner than an edge.
        faces: in space: the path is n x faces x corners x 3 of a surface.
        solid: it encloses a convex body, so that only its faces towards the eye are visible.
    """

    path: np.ndarray
    role: str
    of: str
    filled: bool = False
    hole: bool = False
    fine: bool = False
    faces: bool = False
    solid: bool = False
    dot: bool = False


@dataclass(frozen=True)
class Letter:
    """A name and the place next to which it stands, n x d."""

    text: str
    at: np.ndarray
    role: str
    of: str


@dataclass(frozen=True)
class SceneNumbers:
    """The numbers of a scene over n frames.

    Args:
        scene: whose.
        frames: n x slots.
    """

    scene: Scene
    frames: np.ndarray

    @classmethod
    def at(cls, scene: Scene, state: StateInNumbers) -> SceneNumbers:
        """Numbers of one state, as a single frame."""
        return cls(scene, frame_at(scene, state)[None, :])

    @property
    def size(self) -> int:
        return len(self.frames)

    @property
    def dimension(self) -> int:
        return 2 if self.scene.plane else 3

    @cached_property
    def _slots(self) -> dict[Any, int]:
        return {x: k for k, x in enumerate(self.scene.values)}

    def value(self, x: Any) -> np.ndarray:
        """A scalar, n."""
        if is_moving(x):
            return self.frames[:, self._slots[x]]
        return np.full(self.size, float(plain_number(x)))

    def vector(self, v: Vector) -> np.ndarray:
        """A vector in its own axes, n x d."""
        return np.column_stack([self.value(x) for x in v[: self.dimension]])

    @cached_property
    def poses(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """(R, p) of every frame in the ground, n x d x d and n x d."""
        found: list[tuple[np.ndarray, np.ndarray]] = []
        for frame in self.scene.frames:
            entries = np.column_stack([self.value(x) for x in self.scene.pose_entries(frame.pose)])
            if self.scene.plane:
                x, y, c, s = entries.T
                R, p = np.moveaxis(np.array([[c, -s], [s, c]]), 2, 0), np.column_stack([x, y])
            else:
                R, p = entries[:, 3:].reshape(-1, 3, 3), entries[:, :3]
            if frame.parent >= 0:
                above, origin = found[frame.parent]
                R, p = above @ R, origin + np.einsum("nij,nj->ni", above, p)
            found.append((R, p))
        return found

    def placed(self, own: np.ndarray, frame: int) -> np.ndarray:
        """Points n x ... x d of a frame's axes, in the ground."""
        if frame == 0:
            return own
        R, p = self.poses[frame]
        shape = (self.size, *(1,) * (own.ndim - 2), self.dimension)
        found: np.ndarray = np.einsum("nij,n...j->n...i", R, own) + p.reshape(shape)
        return found

    def turned(self, own: np.ndarray, frame: int) -> np.ndarray:
        """Directions n x d of a frame's axes, in the ground."""
        found: np.ndarray = own if frame == 0 else np.einsum("nij,nj->ni", self.poses[frame][0], own)
        return found

    def spot(self, at: Vector, mark: Mark) -> np.ndarray:
        """A place of a mark, n x d, ground axes."""
        return self.placed(self.vector(at), mark.frame)

    def way(self, v: Vector, mark: Mark) -> np.ndarray:
        """A direction of a mark, n x d, ground axes."""
        return self.turned(self.vector(v), mark.frame)

    def spots(self, points: Iterable[Vector], mark: Mark) -> np.ndarray:
        """Places of a mark, n x k x d, ground axes."""
        return self.placed(np.stack([self.vector(each) for each in points], axis=1), mark.frame)


@dataclass(frozen=True)
class PictureSizes:
    """Sizes of the picture that strokes depend on.

    Args:
        unit: of symbols [m].
        low, high: corners of the box around all that moves, d [m].
        scales: (role, unit of quantity) -> metres for a unit of an arrow.
        dimensions: dimension lines and angles are drawn.
        up: against the weight where the motion begins, else z.
        at_first: the larger side of what is solid in the first frame [m].
    """

    unit: float
    low: np.ndarray
    high: np.ndarray
    scales: dict[tuple[str, str], float] = field(default_factory=dict)
    dimensions: bool = False
    up: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    at_first: float = 1.0

    @property
    def extent(self) -> float:
        """The larger side of the box [m]."""
        return float(np.max(self.high - self.low)) or 1.0


Drawn = tuple[list[Stroke], list[Letter]]
Drawer = Callable[[Any, Mark, SceneNumbers, PictureSizes], Drawn]
DrawerTable = Mapping[type[Form], Drawer]


@dataclass(frozen=True)
class Drawing:
    """Everything of a picture, in the order in which it is drawn.

    Args:
        followed: the picture goes with the bodies: its corners are those of `sizes`, whatever lies beyond them.
    """

    strokes: tuple[Stroke, ...]
    letters: tuple[Letter, ...]
    sizes: PictureSizes
    followed: bool = False


def drawn_with(
    table: DrawerTable,
    numbers: SceneNumbers,
    *,
    dimensions: bool = False,
    symbol: float = SYMBOL,
    arrow: float = ARROW,
) -> Drawing:
    """The marks of a scene as strokes and letters.

    Args:
        table: the function that draws each form, in the plane or in space.
        dimensions: dimension lines and angles are drawn.
        symbol: size of symbols, of the extent; arrow: of the longest arrow.
    """
    marks = numbers.scene.marks
    flat = PictureSizes(0.0, np.zeros(numbers.dimension), np.ones(numbers.dimension))
    solid = [table[type(m.form)](m.form, m, numbers, flat)[0] for m in marks if m.role in SOLID]
    guides = [
        stroke
        for m in marks
        if m.role == "track" and m.form.kind in ("line", "arc")
        for stroke in table[type(m.form)](m.form, m, numbers, flat)[0]
    ]
    low, high, extent = _box(numbers, [stroke for strokes in solid for stroke in strokes], guides)
    sizes = PictureSizes(symbol * extent, low, high, _scales(numbers, arrow * extent), dimensions, _up(numbers), extent)
    strokes: list[Stroke] = []
    letters: list[Letter] = []
    for mark in marks:
        drawn, named = table[type(mark.form)](mark.form, mark, numbers, sizes)
        if mark.form.kind == "field":
            way = _clear_way(drawn, strokes_of(table, [m for m in marks if m is not mark], numbers, sizes), sizes)
            drawn = [replace(stroke, path=stroke.path + way) for stroke in drawn]
            named = [replace(letter, at=letter.at + way) for letter in named]
        strokes += drawn
        letters += named
    return Drawing(tuple(strokes), tuple(_apart(_once(letters, sizes), strokes, sizes)), sizes)


def strokes_of(table: DrawerTable, marks: Iterable[Mark], numbers: SceneNumbers, sizes: PictureSizes) -> list[Stroke]:
    """The strokes of some marks."""
    return [stroke for m in marks for stroke in table[type(m.form)](m.form, m, numbers, sizes)[0]]


def _clear_way(drawn: Sequence[Stroke], others: Iterable[Stroke], sizes: PictureSizes) -> np.ndarray:
    """The way by which an arrow in the corner of a plane picture is moved so that it lies over nothing at the start."""
    d = len(sizes.low)
    places = [stroke.path[0].reshape(-1, d) for stroke in drawn]
    if d == 3 or not places:
        return np.zeros(d)
    box = np.concatenate(places)
    low, high = np.nanmin(box, axis=0) - sizes.unit, np.nanmax(box, axis=0) + sizes.unit
    dots = np.concatenate([np.zeros((0, 2)), *(_dots(stroke.path[0], sizes.unit) for stroke in others)])
    covered: list[tuple[int, int, np.ndarray]] = []
    for x, y in CLEAR_WAYS:
        way = sizes.unit * np.array([x, y])
        inside = np.all((dots > low + way) & (dots < high + way), axis=1)
        covered.append((int(np.count_nonzero(inside)), len(covered), way))
        if not covered[-1][0]:
            break
    return min(covered, key=lambda each: each[:2])[2]


def _dots(path: np.ndarray, step: float) -> np.ndarray:
    """Places along a path k x 2, no farther apart than a step."""
    found = [path[np.isfinite(path).all(axis=1)]]
    for a, b in pairwise(path):
        length = float(np.linalg.norm(b - a))
        if math.isfinite(length) and length > step > 0:
            found.append(a + np.linspace(0, 1, min(int(length / step), MOST_DOTS) + 2)[:, None] * (b - a))
    return np.concatenate(found)


def _once(letters: Sequence[Letter], sizes: PictureSizes) -> list[Letter]:
    """The letters but for points that are called as the body there is."""
    bodies = [letter for letter in letters if letter.role == "label"]

    def is_said(letter: Letter) -> bool:
        there = (x for x in bodies if x.text == letter.text)
        return letter.role == "point" and any(np.linalg.norm(x.at[0] - letter.at[0]) < sizes.unit for x in there)

    return [letter for letter in letters if not is_said(letter)]


def _apart(letters: Sequence[Letter], strokes: Sequence[Stroke], sizes: PictureSizes) -> Iterator[Letter]:
    """The names of bodies whose middles lie together, each at the rim of its own body, at another side of it."""
    names = [letter for letter in letters if letter.role == "label"]
    ways = [np.array(way[: len(sizes.low)]) for way in SIDES_OF_NAMES]
    for letter in letters:
        near = [x.of for x in names if np.linalg.norm(x.at[0] - letter.at[0]) < NEAR * sizes.unit]
        own = [s.path.reshape(len(s.path), -1, len(ways[0])) for s in strokes if s.of == letter.of and s.role in SHOWN]
        places = np.concatenate([x[:, np.isfinite(x[0]).all(axis=1)] for x in own], axis=1) if own else np.zeros((1, 0))
        if letter.role == "label" and len(near) > 1 and places.size:
            away = places[0] - letter.at[0]
            rim = np.linalg.norm(away, axis=1) + away @ ways[near.index(letter.of) % len(ways)]
            letter = replace(letter, at=places[:, int(np.argmax(rim))])
        yield letter


def _up(numbers: SceneNumbers) -> np.ndarray:
    """The unit vector against the weight in the first frame; z where there is none, and in the plane."""
    fields: list[Any] = [mark.form for mark in numbers.scene.marks_of_kind("field")]
    weight = numbers.vector(fields[0].vector)[0] if fields else np.zeros(numbers.dimension)
    size = float(np.linalg.norm(weight))
    up: np.ndarray = -weight / size if numbers.dimension == 3 and 0 < size < math.inf else np.eye(3)[2]
    return up


def _box(
    numbers: SceneNumbers, strokes: Iterable[Stroke], guides: Iterable[Stroke]
) -> tuple[np.ndarray, np.ndarray, float]:
    """(low, high) corner of all that is solid over all frames, and its larger side in the first frame.

    A guide counts where it is not much larger than the rest.
    """
    d = numbers.dimension
    clouds = [stroke.path.reshape(numbers.size, -1, d) for stroke in strokes]
    clouds += [numbers.vector(at)[:, None, :] for name, at in numbers.scene.points if not name.endswith(".origin")]
    side = _side(clouds, d)
    ways = [stroke.path.reshape(numbers.size, -1, d) for stroke in guides]
    clouds += [way for way in ways if not side or _side([way], d) < WIDEST * side]
    found = corners_of(clouds, d)
    if found is None:
        return -np.ones(d) / 2, np.ones(d) / 2, 1.0
    extent = _side([cloud[:1] for cloud in clouds], d) or _side(clouds, d) or 1.0
    low, high = found
    alone = max(0.0, LONELY * SYMBOL * extent - float(np.max(high - low)))
    return low - 0.5 * alone, high + 0.5 * alone, extent


def _side(clouds: list[np.ndarray], d: int) -> float:
    """The larger side of the box around some points; 0 of none."""
    found = corners_of(clouds, d)
    if found is None:
        return 0.0
    side = float(np.max(found[1] - found[0]))
    return side if side > tolerances.SUMMED * float(np.max(np.abs(found))) else 0.0  # one place, but for rounding


def corners_of(clouds: Iterable[np.ndarray], d: int) -> tuple[np.ndarray, np.ndarray] | None:
    """The lowest and the highest corner of points, ... x d, that are somewhere; None: none is."""
    boxes = []
    for cloud in clouds:
        columns = cloud.reshape(-1, d).T.copy()  # numpy takes the least of a row many times as fast as that of a column
        if not np.isfinite(columns.sum()):
            columns = columns[:, np.isfinite(columns).all(axis=0)]
        if columns.size:
            boxes.append((columns.min(axis=1), columns.max(axis=1)))
    if not boxes:
        return None
    lows, highs = zip(*boxes, strict=True)
    return np.min(lows, axis=0), np.max(highs, axis=0)


def _scales(numbers: SceneNumbers, longest: float) -> dict[tuple[str, str], float]:
    """Scales of arrows: the longest of a role and unit, but for a fiftieth of all instants, has a given length [m].

    What is applied and what joints do have one scale.
    """
    sizes: dict[tuple[str, str], list[np.ndarray]] = {}
    for mark in numbers.scene.marks_of_kind("arrow"):
        form: Any = mark.form
        sizes.setdefault((mark.role, form.unit), []).append(np.linalg.norm(numbers.vector(form.vector), axis=1))
    found = {}
    for key in sizes:
        alike = [(role, key[1]) for role in (FORCES if key[0] in FORCES else key[:1])]
        known = np.concatenate([size for one in alike for size in sizes.get(one, [])])
        known = known[np.isfinite(known)]
        largest = float(np.quantile(known, QUANTILE)) if len(known) else 0.0
        found[key] = longest / largest if largest > 0 else 0.0
    return found
