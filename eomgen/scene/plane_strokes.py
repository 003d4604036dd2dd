"""Forms in the plane -> strokes: the look of each kind of mark on paper."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from eomgen.model import ArcForm, LineForm, PolygonForm
from eomgen.scene import forms
from eomgen.scene.forms import PLANE, TEETH
from eomgen.scene.scene import Mark, plain_number
from eomgen.scene.strokes import (
    DrawerTable,
    Drawn,
    Letter,
    PictureSizes,
    SceneNumbers,
    Stroke,
)
from eomgen.symbolic.expression import Vector

HEAD = np.array([[0.0, 0.0], [-1.1, 0.36], [-0.85, 0.0], [-1.1, -0.36], [0.0, 0.0]])  # of an arrow, its tip at 0
BARREL, MOST_BARREL = 0.55, 0.9  # of the longest way, and of each, that the cylinder of a drive takes
SMALL = 0.6  # heads of a line load, of those of a force
ROUND = 73  # points of a circle
LONGEST = 1.5  # of the extent, a length that is drawn
NARROW = 1.5  # units: a dimension line that is not longer has no room for its heads
LEAST = 0.03  # of an angle that is drawn [rad]


def _stroke(path: np.ndarray, mark: Mark, **look: bool) -> Stroke:
    return Stroke(path, mark.role, mark.of, **look)


# -- shapes ------------------------------------------------------------------------------------------


def _line(form: LineForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [_stroke(numbers.spots(form.points, mark), mark, fine=form.fine)], []


def _polygon(form: PolygonForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    path = numbers.spots((*form.points, form.points[0]), mark)
    return [_stroke(path, mark, filled=True, hole=form.hole)], []


def _arc(form: ArcForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    start = np.zeros(numbers.size) if form.start is None else numbers.value(form.start)
    end = start + math.tau if form.end is None else numbers.value(form.end)
    sweep = np.where(end < start, np.mod(end - start, math.tau), end - start)
    turn = start[:, None] + sweep[:, None] * np.linspace(0, 1, ROUND)
    across = numbers.value(form.radius)[:, None] * np.cos(turn), numbers.value(form.radius_y)[:, None] * np.sin(turn)
    own = numbers.vector(form.at)[:, None, :] + np.stack(across, axis=-1)
    if form.close == "center":
        middle = numbers.vector(form.at)[:, None, :]
        own = np.concatenate([middle, own, middle], axis=1)
    elif form.close == "chord":
        own = np.concatenate([own, own[:, :1]], axis=1)
    filled = form.close != "none"
    return [_stroke(numbers.placed(own, mark.frame), mark, filled=filled, hole=form.hole)], []


def _rod(form: forms.RodForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [_stroke(numbers.spots((form.a, form.b), mark), mark)], []


def _point(form: forms.PointForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [_stroke(numbers.spots((form.at,), mark), mark, dot=True)], []


# -- springs, dampers, symbols -----------------------------------------------------------------------


def _spring(form: forms.SpringForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """Straight at its ends, teeth between."""
    share = np.array([0.0, 0.15, *(0.15 + 0.7 * (k + 0.5) / TEETH for k in range(TEETH)), 0.85, 1.0])
    aside = np.array([0.0, 0.0, *(0.55 * (-1) ** k for k in range(TEETH)), 0.0, 0.0])
    return [_stroke(_between(form, mark, numbers, sizes, share, aside), mark)], []


def _damper(form: forms.DamperForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A piston in a cylinder."""
    nan = math.nan
    share = np.array([0.0, 0.38, nan, 0.62, 0.38, 0.38, 0.62, nan, 0.52, 0.52, nan, 0.52, 1.0])
    aside = np.array([0.0, 0.0, nan, 0.55, 0.55, -0.55, -0.55, nan, 0.42, -0.42, nan, 0.0, 0.0])
    return [_stroke(_between(form, mark, numbers, sizes, share, aside), mark)], []


def _cylinder(form: forms.CylinderForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A closed cylinder of one length with its piston, and a rod that comes out of it."""
    end = barrel(numbers.spot(form.b, mark) - numbers.spot(form.a, mark))[:, None]
    nan, one, c, p = np.full_like(end, math.nan), np.ones_like(end), 0.06 * end, 0.85 * end
    share = [0 * end, c, nan, c, end, end, c, c, nan, p, p, nan, end, one, one, end, nan, one, one]
    gap = math.nan
    barrel_aside, piston, rod = [0.6, 0.6, -0.6, -0.6, 0.6], [0.6, -0.6], [0.2, 0.2, -0.2, -0.2]
    aside = np.array([0.0, 0.0, gap, *barrel_aside, gap, *piston, gap, *rod, gap, 0.0, 0.0])
    return [_stroke(_between(form, mark, numbers, sizes, np.concatenate(share, axis=1), aside), mark)], []


def barrel(along: np.ndarray) -> np.ndarray:
    """Part of each way n x d that a cylinder takes: it has one length along a motion, and its rod a little at least."""
    length = np.linalg.norm(along, axis=1)
    longest = float(np.max(length, where=np.isfinite(length), initial=0.0))
    found: np.ndarray = np.minimum(BARREL * longest / np.where(length > 0, length, 1.0), MOST_BARREL)
    return found


def _between(
    form: forms.SpringForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes, share: np.ndarray, aside: np.ndarray
) -> np.ndarray:
    """Points at shares of the way from a to b, and aside of it [symbol units]; to its side between short ends.

    Args:
        share: k, or n x k.
    """
    a, b = numbers.spot(form.a, mark), numbers.spot(form.b, mark)
    along = b - a
    length = np.linalg.norm(along, axis=1, keepdims=True)
    left = np.column_stack([-along[:, 1], along[:, 0]]) / np.where(length > 0, length, 1.0)
    shifted = aside + form.side
    if form.side:
        share = np.concatenate([[0.0, 0.04], 0.08 + 0.84 * share, [0.96, 1.0]])
        shifted = np.concatenate([[0.0, 0.0], shifted, [0.0, 0.0]])
        share[1], share[-2] = share[2], share[-3]
    path: np.ndarray = a[:, None, :] + share[..., None] * along[:, None, :]
    return path + sizes.unit * shifted[:, None] * left[:, None, :]


def _track(form: forms.TrackForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A track as long as the picture; with a normal it is hatched on the other side."""
    if form.along is None:
        return [], []
    at, along = numbers.spot(form.at, mark), _unit(numbers.way(form.along, mark))
    normal = np.zeros_like(at) if form.normal is None else _unit(numbers.way(form.normal, mark))
    at = at - float(plain_number(form.below)) * sizes.unit * normal
    middle, reach = 0.5 * (sizes.low + sizes.high), 0.5 * float(np.linalg.norm(sizes.high - sizes.low)) + sizes.unit
    center = at + np.sum((middle - at) * along, axis=1, keepdims=True) * along
    ends = np.stack([center - reach * along, center + reach * along], axis=1)
    found = [_stroke(ends, mark)]
    if form.normal is not None and sizes.unit:
        places = np.arange(-reach, reach, 1.1 * sizes.unit)
        begin = center[:, None, :] + places[:, None] * along[:, None, :]
        end = begin + sizes.unit * (-0.7 * normal - 0.6 * along)[:, None, :]
        found.append(_stroke(_broken(begin, end), mark, fine=True))
    return found, []


def _broken(begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Many pieces in one path, n x k x d each."""
    gap = np.full_like(begin, np.nan)
    joined: np.ndarray = np.stack([begin, end, gap], axis=2).reshape(len(begin), -1, begin.shape[2])
    return joined


def _symbol(form: forms.SymbolForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A symbol of the table, turned and in its size."""
    at = numbers.spot(form.at, mark)
    x = _unit(numbers.way(form.along, mark)) if form.along is not None else _unit(numbers.way(Vector((1, 0, 0)), mark))
    y = np.column_stack([-x[:, 1], x[:, 0]])
    found = []
    for role, part in PLANE[form.symbol]:
        own, look = _own(part)
        path = at[:, None, :] + sizes.unit * (own[:, :1] * x[:, None, :] + own[:, 1:] * y[:, None, :])
        own_role = mark.role if role == "joint" and mark.role == "body" else role
        found.append(Stroke(path, own_role, mark.of, **look))
    return found, []


def _own(part: Any) -> tuple[np.ndarray, dict[str, bool]]:
    """The points of a part of a symbol, k x 2, and its look."""
    if isinstance(part, ArcForm):
        turn = np.linspace(0, math.tau, 33)
        circle = float(plain_number(part.radius)) * np.column_stack([np.cos(turn), np.sin(turn)])
        return circle + np.array([float(plain_number(x)) for x in part.at[:2]]), {"filled": True}
    points = np.array([[float(plain_number(x)) for x in place[:2]] for place in part.points])
    closed = isinstance(part, PolygonForm)
    return (np.vstack([points, points[:1]]) if closed else points), {"filled": closed, "fine": not closed}


def _unit(v: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(v, axis=1, keepdims=True)
    found: np.ndarray = v / np.where(length > 0, length, 1.0)
    return found


# -- arrows ------------------------------------------------------------------------------------------


def _arrow(form: forms.ArrowForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A shaft and a head; nothing of a vector without length."""
    at, v = numbers.spot(form.at, mark), numbers.way(form.vector, mark)
    shown = sizes.scales.get((mark.role, form.unit), 0.0) * v
    begin, tip = (at, at + shown) if form.outward else (at - shown, at)
    strokes = _arrow_strokes(begin, tip, mark, sizes)
    free = tip if form.outward else begin
    return strokes, [Letter(form.text, free, mark.role, mark.of)] if form.text else []


def _arrow_strokes(
    begin: np.ndarray, tip: np.ndarray, mark: Mark, sizes: PictureSizes, part: float = 1.0
) -> list[Stroke]:
    """An arrow from one place to another, n x 2 each, its head so many units long; gone where it has no length."""
    along = tip - begin
    length = np.linalg.norm(along, axis=1, keepdims=True)
    hidden = np.where(length > 0.02 * sizes.unit, 0.0, np.nan)
    x = _unit(along)
    y = np.column_stack([-x[:, 1], x[:, 0]])
    size = np.minimum(part * sizes.unit, 0.8 * length)[:, None, :]
    head = tip[:, None, :] + size * (HEAD[:, :1] * x[:, None, :] + HEAD[:, 1:] * y[:, None, :])
    shaft = np.stack([begin, tip - 0.85 * size[:, 0] * x], axis=1)
    return [_stroke(shaft + hidden[:, None], mark), _stroke(head + hidden[:, None], mark, filled=True)]


def _couple(form: forms.CoupleForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """Three quarters of a circle around its place, counter-clockwise where it is positive."""
    at, value = numbers.spot(form.at, mark), numbers.value(form.vector[2])
    sense = np.sign(value)[:, None]
    turn = np.linspace(-0.25 * math.pi, 1.25 * math.pi, 40)
    radius = 1.9 * sizes.unit
    flip = np.where(sense < 0, -1.0, 1.0)
    ring = np.stack(
        [flip * radius * np.cos(turn), np.broadcast_to(radius * np.sin(turn), flip.shape[:1] + turn.shape)], 2
    )
    path = at[:, None, :] + ring + np.where(sense == 0, np.nan, 0.0)[:, None]
    head = _arrow_strokes(path[:, -4], path[:, -1] + 0.3 * (path[:, -1] - path[:, -4]), mark, sizes)[1:]
    letters = [Letter(form.text, at + np.array([0.0, radius]), mark.role, mark.of)] if form.text else []
    return [_stroke(path[:, :-2], mark), *head], letters


def _load(form: forms.LoadForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """Arrows whose tips are on a line, their tails joined; the largest half as long as that of a force."""
    a, b = numbers.spot(form.a, mark), numbers.spot(form.b, mark)
    p, q = numbers.way(form.at_a, mark), numbers.way(form.at_b, mark)
    highest = float(np.nanmax(np.linalg.norm(np.concatenate([p, q]), axis=1))) or 1.0
    size = 0.07 * sizes.extent / highest
    longest = float(np.max(np.linalg.norm(b - a, axis=1)))
    count = 3 + int(min(8.0, 3 * longest / (0.07 * sizes.extent)))
    found, tails = [], []
    for share in np.linspace(0, 1, count):
        tip = a + share * (b - a)
        tail = tip - size * (p + share * (q - p))
        tails.append(tail)
        found += _arrow_strokes(tail, tip, mark, sizes, SMALL)
    found.append(_stroke(np.stack(tails, axis=1), mark))
    letters = [Letter(form.text, np.mean(tails, axis=0), mark.role, mark.of)] if form.text else []
    return found, letters


# -- names and sizes -----------------------------------------------------------------------------------


def _label(form: forms.LabelForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [], [Letter(form.text, numbers.spot(form.at, mark), mark.role, mark.of)]


def _dimension(form: forms.DimensionForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A line with two heads parallel to the length that it measures, thin lines from its ends."""
    if not sizes.dimensions:
        return [], []
    a, b = numbers.spot(form.a, mark), numbers.spot(form.b, mark)
    length = np.linalg.norm(b - a, axis=1, keepdims=True)
    whole = np.nanmax(length, initial=0.0) <= LONGEST * sizes.extent  # else the picture shows a part of it
    a = a + np.where((length > NARROW * sizes.unit) & whole, 0.0, np.nan)
    x = _unit(b - a)
    side = np.column_stack([x[:, 1], -x[:, 0]])
    middle = 0.5 * (sizes.low + sizes.high)
    outward = np.sign(np.sum((0.5 * (a + b) - middle) * side, axis=1, keepdims=True))
    side = side * np.where(outward == 0, 1.0, outward)
    away = form.tier * sizes.unit
    c, d = a + away * side, b + away * side
    over = 0.5 * sizes.unit * side
    lines = _broken(np.stack([a + over, b + over], axis=1), np.stack([c + over, d + over], axis=1))
    found = [_stroke(lines, mark, fine=True), *_arrow_strokes(d, c, mark, sizes), *_arrow_strokes(c, d, mark, sizes)]
    return found, [Letter(form.text, 0.5 * (c + d) + 0.2 * over, mark.role, mark.of)]


def _angle(form: forms.AngleForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """The arc of an angle between two thin lines, with a head at its end."""
    if not sizes.dimensions:
        return [], []
    at = numbers.spot(form.at, mark)
    start, end = numbers.value(form.start), numbers.value(form.end)
    sweep = np.where(np.abs(end - start) > LEAST, np.fmod(end - start, math.tau), np.nan)
    turn = start[:, None] + sweep[:, None] * np.linspace(0, 1, 41)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=2)
    radius = form.tier * sizes.unit
    path = at[:, None, :] + radius * ring
    legs = _broken(np.repeat(at[:, None, :], 2, axis=1), at[:, None, :] + 1.25 * radius * ring[:, [0, -1]])
    head = _arrow_strokes(path[:, -4], path[:, -1], mark, sizes)[1:]
    return [_stroke(legs, mark, fine=True), _stroke(path, mark, fine=True), *head], [
        Letter(form.text, path[:, 20] + 0.3 * sizes.unit * ring[:, 20], mark.role, mark.of)
    ]


def _field(form: forms.FieldForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """Arrow of a uniform field, next to the upper right corner."""
    if not sizes.dimensions:
        return [], []
    v = 4.5 * sizes.unit * _unit(numbers.way(form.vector, mark))
    corner = np.array([sizes.high[0] + 4 * sizes.unit, max(sizes.high[1], sizes.low[1] + 5 * sizes.unit)])
    begin = np.broadcast_to(corner, v.shape) - np.minimum(v, 0.0) * np.array([1.0, 0.0]) - np.maximum(v, 0.0)
    return _arrow_strokes(begin, begin + v, mark, sizes), [Letter(form.text, begin + 0.5 * v, mark.role, mark.of)]


def _axes(form: forms.AxesForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """x and y, three symbols long."""
    at = numbers.spot(form.at, mark)
    found, letters = [], []
    for name, way in (("x", (1, 0, 0)), ("y", (0, 1, 0))):
        tip = at + 3 * sizes.unit * _unit(numbers.way(Vector(way), mark))
        found += _arrow_strokes(at, tip, mark, sizes)
        letters.append(Letter(name, tip, mark.role, mark.of))
    return found, letters


SOLIDS = frozenset(("box", "ellipsoid", "revolution", "prism", "polyhedron", "wheel"))
"""Kinds of space: in the plane a scene has what one sees of them along z."""

TABLE: DrawerTable = {
    LineForm: _line,
    PolygonForm: _polygon,
    ArcForm: _arc,
    forms.RodForm: _rod,
    forms.SpringForm: _spring,
    forms.DamperForm: _damper,
    forms.CylinderForm: _cylinder,
    forms.TrackForm: _track,
    forms.SymbolForm: _symbol,
    forms.PointForm: _point,
    forms.LabelForm: _label,
    forms.ArrowForm: _arrow,
    forms.CoupleForm: _couple,
    forms.LoadForm: _load,
    forms.DimensionForm: _dimension,
    forms.AngleForm: _angle,
    forms.FieldForm: _field,
    forms.AxesForm: _axes,
}
