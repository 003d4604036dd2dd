"""Drawing -> what it shows at one of its frames, as it is proven: places of bodies, ends of springs, arrows."""

from __future__ import annotations

import numpy as np

from eomgen.proof.pictures_told import ToldArrow, ToldPicture
from eomgen.scene.scene import Scene
from eomgen.scene.strokes import Drawing, Stroke

LENGTHS = frozenset(("line", "polygon", "arc", "rod", "point", "box", "ellipsoid", "revolution", "prism", "polyhedron"))
"""Kinds of marks that are as large as what they show."""


def picture_told(drawing: Drawing, scene: Scene, frame: int) -> ToldPicture:
    """What the strokes of a drawing show at a frame."""
    d = 2 if scene.plane else 3
    symbols = {mark.of for mark in scene.marks if mark.role == "body" and mark.form.kind not in LENGTHS}
    whole = ("spring", "damper") if scene.plane else ("spring",)  # in space a damper has several parts
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
    return ToldPicture(bodies, ends, arrows, {}, drawing.sizes.extent, otherwise, (), signs, lengths, angles, masses)


def _sizes(drawing: Drawing, scene: Scene, frame: int) -> tuple[list[tuple[str, float]], list[tuple[str, float]]]:
    """(name, how large) of dimension lines: between the tips of both heads; of arcs: from their legs' middle."""
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


def _arrows(drawing: Drawing, scene: Scene, frame: int) -> list[ToldArrow]:
    """Of single forces and resultants: a shaft, then its head."""
    single = {mark.of for mark in scene.marks if mark.form.kind == "arrow"}
    single -= {mark.of for mark in scene.marks if mark.form.kind in ("couple", "load")}
    found, strokes = [], [s for s in drawing.strokes if s.role in ("force", "reaction") and s.of in single]
    for shaft, head in zip(strokes[::2], strokes[1::2], strict=True):
        begin, tip = shaft.path[frame].reshape(-1, shaft.path.shape[-1])[0], _tip(head, frame)
        if np.isfinite(begin).all() and np.isfinite(tip).all():
            found.append(ToldArrow(shaft.role, shaft.of, begin, tip))
    return found


def _tip(head: Stroke, frame: int) -> np.ndarray:
    """The tip of an arrow's head: in the plane its first place, in space the one that all its faces share."""
    tip: np.ndarray = head.path[frame][0][-1] if head.faces else head.path[frame][0]
    return tip
