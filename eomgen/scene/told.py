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
    return ToldPicture(bodies, ends, tuple(_arrows(drawing, scene, frame)), {}, drawing.sizes.extent)


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
