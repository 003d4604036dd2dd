"""Forces, couples and velocities in numbers -> marks: the arrows of a state that a result knows, on its scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from eomgen.frozen import dataclass
from eomgen.model import SpreadLoad
from eomgen.scene.acting import spread_mark
from eomgen.scene.connections import ordered
from eomgen.scene.forms import ArrowForm, CoupleForm, LabelForm, PointForm, SymbolForm
from eomgen.scene.scene import ROLES, Mark, Scene
from eomgen.symbolic.expression import Fraction, Vector

STEEP = 0.25  # sine of the angle below which two lines run along one another
CLEAR = 0.15  # of an arrow: nearer to a line it is on it; so much of it is at its own place


@dataclass(frozen=True)
class DrawnArrow:
    """An arrow in numbers.

    Args:
        of: the force, joint, constraint or point that it belongs to.
        at, vector: ground axes, 2 or 3 each; of those with one role and unit the longest becomes the longest arrow.
        role: "force", "reaction" or "velocity".
        text: at its free end, "" of none; of a zero vector that alone is drawn.
        turns: it is a couple.
        outward: it begins at its place, and does not end there.
    """

    of: str
    at: Sequence[float] | np.ndarray
    vector: Sequence[float] | np.ndarray
    role: str
    text: str = ""
    turns: bool = False
    outward: bool = False
    unit: str = "1"


def arrow_marks(arrows: Iterable[DrawnArrow]) -> Iterator[Mark]:
    """The marks of arrows; of a zero vector its name at its place."""
    for arrow in arrows:
        at, vector = exact_vector(arrow.at), exact_vector(arrow.vector)
        if not any(vector):
            if arrow.text:
                yield Mark(LabelForm(arrow.text, at), 0, arrow.role, arrow.of)
        elif arrow.turns:
            yield Mark(CoupleForm(at, vector, arrow.text), 0, arrow.role, arrow.of)
        else:
            yield Mark(ArrowForm(at, vector, arrow.unit, arrow.outward, arrow.text), 0, arrow.role, arrow.of)


def center_marks(centers: Iterable[tuple[str, Vector]], of: str = "") -> Iterator[Mark]:
    """Marks of centres, of rotation or of mass, by their names."""
    for name, at in centers:
        yield Mark(PointForm(at), 0, "center", of)
        yield Mark(LabelForm(name, at), 0, "center", of)


def exact_vector(numbers: Sequence[float] | np.ndarray) -> Vector:
    """Two or three numbers as a vector, as they are."""
    return Vector(Fraction(float(x)) for x in [*numbers, 0.0][:3])


def is_freer_outward(lines: Iterable[np.ndarray], at: Sequence[float], vector: Sequence[float]) -> bool:
    """True if an arrow on the page that begins at its place meets fewer lines than one that ends there."""
    pieces = [piece for line in lines for piece in pairwise(line)]
    place, stroke = np.array(at), np.array(vector)
    begun, ended = (sum(_meets(a, b, place, s) for a, b in pieces) for s in (stroke, -stroke))
    return begun < ended


def _meets(a: np.ndarray, b: np.ndarray, at: np.ndarray, stroke: np.ndarray) -> bool:
    """True if a stroke from a place runs along the piece a b, or crosses it further on."""
    along, away = b - a, at - a
    turn = along[0] * stroke[1] - along[1] * stroke[0]
    sizes = float(np.hypot(*along) * np.hypot(*stroke))
    if not sizes:
        return False
    if abs(turn) < STEEP * sizes:
        middle = away + stroke / 2
        share = float(np.clip(middle @ along / (along @ along), 0, 1))
        return bool(np.hypot(*(middle - share * along)) < CLEAR * np.hypot(*stroke))
    on_piece = (away[0] * stroke[1] - away[1] * stroke[0]) / turn
    on_stroke = (away[0] * along[1] - away[1] * along[0]) / turn
    return bool(0 <= on_piece <= 1 and CLEAR < on_stroke <= 1)


def never_short(size: float, largest: float, shortest: float) -> float:
    """Length of an arrow in a picture without a scale: 1 of the largest, never below `shortest`."""
    return shortest + (1 - shortest) * min(1.0, size / largest)


def scene_with(scene: Scene, marks: Iterable[Mark]) -> Scene:
    """A scene with more marks, each in the place that its role has."""
    return replace(scene, marks=ordered((*scene.marks, *marks), ROLES))


# -- cut free ----------------------------------------------------------------------------------------------------


OWN = ("body", "hole", "inertia", "rim", "member")  # roles of a body itself
NAMED = ("point", "center")  # roles of what is named on it


def scene_of_cut_body(scene: Scene, body: str, arrows: Iterable[DrawnArrow] = ()) -> Scene:
    """The scene of one body by itself, with its forces; loads along lines as they are, a symbol where it was cut."""
    arrows = tuple(arrows)
    kept = [mark for mark in scene.marks if _belongs(mark, body)]
    spread = list(_spread(scene, body)) if arrows else []
    lines = {mark.of for mark in spread}
    marks = (*kept, *spread, *arrow_marks(each for each in arrows if each.of not in lines))
    places = dict.fromkeys(tuple(each.at) for each in arrows if each.role == "reaction" and not each.turns)
    symbol = "hinge" if scene.plane else "ball"
    cuts = (Mark(SymbolForm(symbol, exact_vector(at)), 0, "joint", "") for at in places)
    points = tuple(point for point in scene.points if point[0].startswith(f"{body}."))
    return replace(scene, marks=ordered((*marks, *cuts), ROLES), points=points)


def _belongs(mark: Mark, body: str) -> bool:
    if mark.role in OWN:
        return mark.of == body
    return mark.role in NAMED and mark.of.partition(".")[0] == body


def _spread(scene: Scene, body: str) -> Iterator[Mark]:
    """Loads along lines of a body."""
    motion = scene.system.motion
    for applied in scene.system.loads.applied:
        for load in applied.spread:
            if isinstance(load, SpreadLoad) and load.start[0] == body:
                yield spread_mark(motion, load, applied.name, applied.name)
