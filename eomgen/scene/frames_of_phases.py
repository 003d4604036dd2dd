"""Trajectory -> one picture over all its phases, and its content at a frame.

Trajectory -> one picture over all its phases: each phase is drawn by its own system, whose coordinates mean its own.

Scenes of the same bodies become one: bodies, points and marks are found again by their names. A number that differs
from piece to piece, or moves in one of them, gets a slot of its own; marks that a piece lacks are nan there, hidden.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.mechanics.dynamics import System
from eomgen.model import Form
from eomgen.proof import ReportedArrow, ReportedPicture, ReportedPush
from eomgen.scene import plane_strokes, space_strokes
from eomgen.scene.bodies import Resultant, force_marks, resultants
from eomgen.scene.making import scene_of_system
from eomgen.scene.scene import ROLES, Mark, Scene, SceneFrame, frames_along, is_moving, plain_number, scalars_of
from eomgen.scene.strokes import Drawing, SceneNumbers, Stroke
from eomgen.simulation import Phase, Trajectory
from eomgen.symbolic.expression import Fraction, Matrix, Node, Pose, Scalar, Vector

Piece = tuple[SceneNumbers, np.ndarray]
"""A scene over its own instants, and their places among those of the whole."""
SceneMaker = Callable[[System], Scene]
Known = tuple[SceneNumbers, Sequence[Scalar]]
"""A piece and the numbers in it of one thing."""

WORDS = ("text", "symbol", "unit", "close", "faces", "side", "tier", "hole", "fine", "outward")
"""Fields of forms that say what a thing is, not where."""


def phase_frames(
    run: Trajectory, times: np.ndarray, *, forces: bool = True, scene_of: SceneMaker = scene_of_system
) -> SceneNumbers:
    """Scene of a run and its numbers at given instants; states between rows are interpolated.

    Args:
        forces: applied forces and reactions are arrows.
        scene_of: makes the scene of a system.
    """
    starts = [phase.start for phase in run.phases]
    owner = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
    rows = [np.flatnonzero(owner == k) for k in range(len(starts))]
    pairs = [(k, own) for k, own in enumerate(rows) if len(own)] or [(0, rows[0])]
    pieces = [
        (_phase_numbers(run, run.phases[k], times[own], forces=forces, scene_of=scene_of), own) for k, own in pairs
    ]
    return joined(pieces)


def _phase_numbers(
    run: Trajectory, phase: Phase, times: np.ndarray, *, forces: bool, scene_of: SceneMaker
) -> SceneNumbers:
    """A phase at instants of its own."""
    system: System = phase.model.declared
    columns = _columns(run, phase, times)
    scene = scene_of(system)
    given: dict[Node, np.ndarray] = {}
    if forces:
        arrows: list[tuple[Resultant, Vector]] = []
        for k, (resultant, force) in enumerate(_resultants(run, phase, times, columns)):
            axes = "xyz"[: len(force)]
            named = [system.symbols.graph.symbol(f"({axis} of {resultant.owner}, {k})") for axis in axes]
            given |= dict(zip(named, force, strict=True))
            padded: list[Scalar] = [*named, 0]
            arrows.append((resultant, Vector(padded[:3])))
        scene = replace(scene, marks=(*scene.marks, *force_marks(system, arrows)))
    else:
        scene = replace(scene, marks=tuple(mark for mark in scene.marks if mark.role != "force"))
    x = _states(system, columns, times)
    return SceneNumbers(scene, _frames(scene, times, x, phase.model.p, given))


def _resultants(
    run: Trajectory, phase: Phase, times: np.ndarray, columns: Mapping[str, np.ndarray]
) -> Iterator[tuple[Resultant, np.ndarray]]:
    """Resultants of reactions, and their components along the run, 2 or 3 x instants [N]."""
    system: System = phase.model.declared
    found = list(resultants(system, run.reactions))
    d = 2 if system.scope.model.space == "plane" else 3
    units = [x for resultant in found for unit in resultant.units.values() for x in unit[:d]]
    along = iter(_value(system, units, times, _states(system, columns, times), phase.model.p))
    for resultant in found:
        force = np.zeros((d, len(times)))
        for name in resultant.units:
            force += columns[name] * np.array([next(along) for _ in range(d)])
        yield resultant, force


def _states(system: System, columns: Mapping[str, np.ndarray], times: np.ndarray) -> np.ndarray:
    """States (q, u) at the instants, instants x n."""
    rest = np.zeros(len(times))
    nodes = system.symbols.x
    return np.array([columns.get(node.name, rest) for node in nodes]).reshape(len(nodes), len(times)).T


def _value(system: System, scalars: Sequence[Scalar], t: np.ndarray, x: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Values of scalars along a motion, scalars x instants."""
    program = Program.of(scalars, system.symbols, inputs=system.inputs)
    with np.errstate(all="ignore"):
        return RightHandSide.of(program, "numpy").many(t, x, p).T


def _columns(run: Trajectory, phase: Phase, times: np.ndarray) -> dict[str, np.ndarray]:
    """Every column of the run at instants of one of its phases, between that phase's own ends."""
    named = run.columns()
    begin, end = phase.rows
    t, edges = run.t[begin:end], [(phase.start, phase.first), (phase.end, phase.last)]
    if not (phase.first and phase.last):
        return {name: np.interp(times, run.t, column) for name, column in named.items()}
    t = np.concatenate([[edges[0][0]], t, [edges[1][0]]])
    return {
        name: np.interp(times, t, np.concatenate([[edges[0][1][name]], column[begin:end], [edges[1][1][name]]]))
        for name, column in named.items()
    }


def _frames(scene: Scene, t: np.ndarray, x: np.ndarray, p: np.ndarray, given: Mapping[Node, np.ndarray]) -> np.ndarray:
    """The frames of a scene in which some symbols have columns of their own."""
    if not given:
        return frames_along(scene, t, x, p)
    known = tuple(value for value in scene.values if value not in given)
    found: dict[Scalar, np.ndarray] = dict(zip(known, _value(scene.system, known, t, x, p), strict=True))
    columns = found | dict(given)
    return np.column_stack([columns[value] for value in scene.values])


# -- several scenes as one -----------------------------------------------------------------------------


def joined(pieces: Sequence[Piece]) -> SceneNumbers:
    """Scenes of the same bodies, one after the other, as one."""
    if len(pieces) == 1:
        return pieces[0][0]
    one = _Joined(pieces)
    first = pieces[0][0].scene
    frames = tuple(one.frame(k) for k in range(len(first.frames)))
    points = tuple(one.points())
    marks = tuple(sorted(one.marks(), key=lambda mark: ROLES.index(mark.role)))
    scene = Scene(first.system, frames, points, marks)
    columns = [one.columns[value] for value in scene.values]
    size = sum(len(rows) for _, rows in pieces)
    return SceneNumbers(scene, np.column_stack(columns) if columns else np.empty((size, 0)))


class _Joined:
    """The numbers of several scenes, each once.

    Args:
        pieces: the scenes, of the same bodies.
    """

    def __init__(self, pieces: Sequence[Piece]) -> None:
        self.pieces = pieces
        self.size = sum(len(rows) for _, rows in pieces)
        self.graph = pieces[0][0].scene.system.symbols.graph
        self.columns: dict[Scalar, np.ndarray] = {}
        self._slots: dict[tuple[Scalar | None, ...], Scalar] = {}

    def frame(self, k: int) -> SceneFrame:
        """The k-th frame."""
        own = self.pieces[0][0].scene.frames[k]
        if k == 0:
            return own
        entries = self._numbers(
            [numbers.scene.pose_entries(numbers.scene.frames[k].pose) for numbers, _ in self.pieces]
        )
        if self.pieces[0][0].scene.plane:
            x, y, c, s = entries
            return replace(own, pose=Pose(Matrix.of(((c, -s, 0), (s, c, 0), (0, 0, 1))), Vector((x, y, 0))))
        R = (Vector(entries[3:6]), Vector(entries[6:9]), Vector(entries[9:12]))
        return replace(own, pose=Pose(Matrix.of(R), Vector(entries[:3])))

    def points(self) -> Iterator[tuple[str, Any]]:
        """The named points."""
        tables = [dict(numbers.scene.points) for numbers, _ in self.pieces]
        for name in dict.fromkeys(name for table in tables for name in table):
            yield name, Vector(self._numbers([table.get(name) for table in tables]))

    def marks(self) -> Iterator[Mark]:
        """All marks that one of the scenes has."""
        tables = [_by_identity(numbers.scene.marks) for numbers, _ in self.pieces]
        for key in dict.fromkeys(key for table in tables for key in table):
            found = [table.get(key) for table in tables]
            some = next(mark for mark in found if mark is not None)
            if some.role == "track" and some.frame == 0 and (laid := self._laid(found)):
                yield from (_with_numbers(some, numbers) for numbers in laid)
                continue
            numbers = self._numbers([None if mark is None else tuple(scalars_of(mark.form)) for mark in found])
            yield _with_numbers(some, numbers)

    def _laid(self, found: Sequence[Mark | None]) -> list[list[Scalar]]:
        """The numbers of each track that lies still on the ground in one of the pieces; [] where one moves.

        It is there all the time, whether something is on it or not.
        """
        places: dict[tuple[float, ...], None] = {}
        for (numbers, _), mark in zip(self.pieces, found, strict=True):
            columns = [] if mark is None else [numbers.value(x) for x in scalars_of(mark.form)]
            if any(not np.array_equal(column, np.broadcast_to(column[:1], column.shape)) for column in columns):
                return []
            places |= {tuple(float(f"{column[0]:.12g}") for column in columns): None} if mark is not None else {}
        return [[Fraction(value) for value in place] for place in places]

    def _numbers(self, found: Sequence[Sequence[Scalar] | None]) -> list[Scalar]:
        """The numbers of a thing, from those that each piece has of it."""
        size = next(len(each) for each in found if each is not None)
        return [self._number(tuple(None if each is None else each[k] for each in found)) for k in range(size)]

    def _number(self, found: tuple[Scalar | None, ...]) -> Scalar:
        """One: a constant where all have the same, else a slot."""
        first = found[0]
        if first is not None and not any(map(is_moving, found)) and all(x is not None for x in found):
            values = [plain_number(x) for x in found]
            if all(value == values[0] for value in values):
                return first
        if found not in self._slots:
            column = np.full(self.size, np.nan)
            for (numbers, rows), x in zip(self.pieces, found, strict=True):
                if x is not None:
                    column[rows] = numbers.value(x)
            slot = self._slots[found] = self.graph.symbol(f"(slot {len(self._slots)})")
            self.columns[slot] = column
        return self._slots[found]


def _by_identity(marks: Sequence[Mark]) -> dict[tuple[Any, ...], Mark]:
    """The marks by their identity; of the same the first, the second, and so on."""
    seen: Counter[tuple[Any, ...]] = Counter()
    found = {}
    for mark in marks:
        form: Form = mark.form
        words = tuple(getattr(form, word, None) for word in WORDS)
        who = (form.kind, mark.frame, mark.role, mark.of, words, sum(1 for _ in scalars_of(form)))
        seen[who] += 1
        found[*who, seen[who]] = mark
    return found


def _with_numbers(mark: Mark, numbers: Sequence[Scalar]) -> Mark:
    """A mark with other numbers, in the order of `scalars_of`."""
    flat = iter(numbers)
    return replace(
        mark, form=replace(mark.form, **{f.name: _filled(getattr(mark.form, f.name), flat) for f in fields(mark.form)})
    )


def _filled(value: Any, numbers: Iterator[Scalar]) -> Any:
    """A field of a form with other numbers, in the order of `scalars_of`."""
    if isinstance(value, tuple):
        return tuple(_filled(x, numbers) for x in value)
    return value if value is None or isinstance(value, (str, bool)) else next(numbers)


# -------- read back -------------------------------------------------------------------------------------------
# Drawing -> what it shows at one of its frames, as it is proven: places of bodies, ends of springs, arrows.


LENGTHS = frozenset(("line", "polygon", "arc", "rod", "point", "box", "ellipsoid", "revolution", "prism", "polyhedron"))
"""Kinds of marks that are as large as what they show."""


def picture_reported(drawing: Drawing, scene: Scene, frame: int) -> ReportedPicture:
    """Places of bodies, ends of springs and arrows that the strokes of a drawing show at a frame."""
    d = 2 if scene.plane else 3
    symbols = {mark.of for mark in scene.marks if mark.role == "body" and mark.form.kind not in LENGTHS}
    whole = ("spring", "damper", "cylinder") if scene.plane else ("spring",)  # in space a damper has several parts
    springs = {mark.of: mark.form.kind for mark in scene.marks if mark.form.kind in whole}
    clouds: dict[str, list[np.ndarray]] = {}
    ends = {}
    for stroke in drawing.strokes:
        path = stroke.path[frame].reshape(-1, d)
        if stroke.role == "body" and stroke.of not in symbols:
            clouds.setdefault(stroke.of, []).append(path)
        elif stroke.of in springs and stroke.role == springs[stroke.of] and not stroke.faces and len(path):
            ends[stroke.of] = (path[0], path[-1])
    faced = {stroke.of for stroke in drawing.strokes if stroke.faces and stroke.role == "body"}
    shaped = {name for name, part in scene.system.scope.model.bodies.items() if part.shape or part.parts}
    bodies = {name: np.concatenate(each) for name, each in clouds.items() if name not in faced or name in shaped}
    arrows, otherwise = tuple(_arrows(drawing, scene, frame)), frozenset(symbols | (faced - shaped))
    signs = [
        (stroke.of, stroke.path[frame].reshape(-1, d))
        for stroke in drawing.strokes
        if stroke.role in ("support", "joint") and stroke.path.size
    ]
    lengths, angles = _sizes(drawing, scene, frame) if drawing.sizes.dimensions else ([], [])
    masses = {s.of: s.path[frame].reshape(-1, d) for s in drawing.strokes if s.role == "inertia"}
    return ReportedPicture(
        bodies, ends, arrows, {}, drawing.sizes.extent, otherwise, (), signs, lengths, angles, masses
    )


def _sizes(drawing: Drawing, scene: Scene, frame: int) -> tuple[list[tuple[str, float]], list[tuple[str, float]]]:
    """(name, size) of dimension lines: between the tips of both heads; of arcs: from their legs' middle."""
    strokes = iter([stroke for stroke in drawing.strokes if stroke.role == "dimension"])
    lengths, angles = [], []
    for mark in (mark for mark in scene.marks if mark.form.kind in ("dimension", "angle")):
        name: str = getattr(mark.form, "text", "")
        if mark.form.kind == "dimension":
            _, _, first, _, second = (next(strokes) for _ in range(5))
            length = float(np.linalg.norm(_tip(first, frame) - _tip(second, frame)))
            lengths += [(name, length)] if np.isfinite(length) else []
        else:
            legs, arc, _ = (next(strokes) for _ in range(3))
            x, y = (arc.path[frame] - legs.path[frame][0]).T
            turned = float(np.unwrap(np.arctan2(y, x))[-1] - np.arctan2(y[0], x[0]))
            angles += [(name, turned)] if np.isfinite(turned) else []
    return lengths, angles


def _arrows(drawing: Drawing, scene: Scene, frame: int) -> list[ReportedArrow]:
    """Arrows of single forces and resultants; the strokes of each are a shaft, then its head."""
    single = {mark.of for mark in scene.marks if mark.form.kind == "arrow"}
    single -= {mark.of for mark in scene.marks if mark.form.kind in ("couple", "load")}
    found, strokes = [], [s for s in drawing.strokes if s.role in ("force", "reaction") and s.of in single]
    for shaft, head in zip(strokes[::2], strokes[1::2], strict=True):
        begin, tip = shaft.path[frame].reshape(-1, shaft.path.shape[-1])[0], _tip(head, frame)
        if np.isfinite(begin).all() and np.isfinite(tip).all():
            found.append(ReportedArrow(shaft.role, shaft.of, begin, tip, head.path[frame].reshape(-1, len(tip))))
    return found


def _tip(head: Stroke, frame: int) -> np.ndarray:
    """The tip of an arrow's head: in the plane its first place, in space the one that all its faces share."""
    tip: np.ndarray = head.path[frame][0][-1] if head.faces else head.path[frame][0]
    return tip


# -- a structure ---------------------------------------------------------------------------------------------------


def pushes_reported(drawing: Drawing, numbers: SceneNumbers) -> Iterator[ReportedPush]:
    """Forces, couples and line loads that the strokes of a drawing show at its first frame, with their words."""
    table = plane_strokes.TABLE if numbers.scene.plane else space_strokes.TABLE
    strokes = iter([stroke for stroke in drawing.strokes if stroke.role in ("force", "reaction")])
    for mark in (mark for mark in numbers.scene.marks if mark.role in ("force", "reaction")):
        form: Any = mark.form
        drawn = [next(strokes) for _ in table[type(form)](form, mark, numbers, drawing.sizes)[0]]
        if form.kind == "load":
            count = len(drawn) // 2  # and one line more
            shafts, heads = drawn[: 2 * count : 2], drawn[1 : 2 * count : 2]
            way, other = (_shaft(shafts[k], heads[k])[1] for k in (0, -1))
            a, b = (numbers.spot(at, mark)[0] for at in (form.a, form.b))
            yield ReportedPush(form.text, _three(a), way, end=(_three(b), other))
        elif form.kind == "couple" and numbers.scene.plane:
            x, y = (drawn[0].path[0] - numbers.spot(form.at, mark)[0]).T
            turned = float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
            yield ReportedPush(form.text, np.zeros(3), np.array([0.0, 0.0, turned]), turns=True)
        elif drawn:
            at, way = _shaft(*drawn[-2:])
            yield ReportedPush(form.text, at, way, turns=form.kind == "couple")


def _shaft(shaft: Stroke, head: Stroke) -> tuple[np.ndarray, np.ndarray]:
    """(tip, the way to it) of an arrow, 3 each."""
    tip = _tip(head, 0)
    return _three(tip), _three(tip - shaft.path[0].reshape(-1, len(tip))[0])


def _three(v: np.ndarray) -> np.ndarray:
    found: np.ndarray = np.array([*v, 0.0][:3])
    return found
