"""Forms in space -> strokes: lines, and the faces of solids."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from eomgen.model import (
    ArcForm,
    BoxForm,
    EllipsoidForm,
    LineForm,
    PolygonForm,
    PolyhedronForm,
    PrismForm,
    RevolutionForm,
)
from eomgen.scene import forms, plane_strokes
from eomgen.scene.forms import SPACE, TEETH
from eomgen.scene.plane_strokes import barrel
from eomgen.scene.scene import Mark, plain_number
from eomgen.scene.strokes import (
    ARROW,
    SYMBOL,
    DrawerTable,
    Drawing,
    Drawn,
    Letter,
    PictureSizes,
    SceneNumbers,
    Stroke,
    drawn_with,
)
from eomgen.symbolic.expression import Vector

ROUND, FEWEST = 20, 8  # pieces of a turn, from the largest to the smallest
SEEN = 0.0012  # of the extent: chords need not be nearer to their arc
STANDS_FOR = 2.0  # times that for an ellipsoid that only stands for masses
FAR = 0.5  # part of what is upright along an axis: more, and the top of a picture is at that end of it
BESIDE = 3  # units of a plane around what is drawn over it, and of the weight's arrow from its corner
SMALLER = 0.6  # heads of a line load, of those of a force
SMALL = 10  # pieces of a turn of a symbol no larger than its unit
CUBE = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def drawing_of(
    numbers: SceneNumbers, *, dimensions: bool = False, symbol: float = SYMBOL, arrow: float = ARROW
) -> Drawing:
    """The strokes of a scene, in the plane or in space; arguments as of `drawn_with`."""
    table = plane_strokes.TABLE if numbers.scene.plane else TABLE
    return drawn_with(table, numbers, dimensions=dimensions, symbol=symbol, arrow=arrow)


def _faces(corners: np.ndarray, mark: Mark, role: str = "", *, solid: bool = False) -> Stroke:
    """Faces n x f x c x 3 in the ground."""
    return Stroke(corners, role or mark.role, mark.of, filled=True, faces=True, solid=solid)


# -- shapes ------------------------------------------------------------------------------------------


def _line(form: LineForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [Stroke(numbers.spots(form.points, mark), mark.role, mark.of, fine=form.fine)], []


def _polygon(form: PolygonForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [_faces(numbers.spots(form.points, mark)[:, None], mark)], []


def _arc(form: ArcForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    start = np.zeros(numbers.size) if form.start is None else numbers.value(form.start)
    end = start + math.tau if form.end is None else numbers.value(form.end)
    sweep = np.where(end < start, np.mod(end - start, math.tau), end - start)
    turn = start[:, None] + sweep[:, None] * np.linspace(0, 1, 2 * ROUND + 1)
    x, y = numbers.value(form.radius)[:, None] * np.cos(turn), numbers.value(form.radius_y)[:, None] * np.sin(turn)
    middle = numbers.vector(form.at)[:, None, :]
    own = middle + np.stack([x, y, np.zeros_like(x)], axis=-1)
    if form.close == "center":
        own = np.concatenate([middle, own], axis=1)
    path = numbers.placed(own, mark.frame)
    if form.close == "none":
        return [Stroke(path, mark.role, mark.of)], []
    return [] if form.hole else [_faces(path[:, None], mark)], []


def _box(form: BoxForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    own = numbers.vector(form.at)[:, None, :] + numbers.vector(form.size)[:, None, :] * CUBE
    return [_faces(numbers.placed(own, mark.frame)[:, SIDES], mark, solid=True)], []


def _pieces(radius: np.ndarray, sizes: PictureSizes, coarser: float = 1.0) -> int:
    """Number of chords of a turn that cannot be distinguished from the arc: r (1 - cos(pi/n)) = SEEN extent."""
    largest = float(np.max(np.abs(radius), where=np.isfinite(radius), initial=0.0))
    return (
        int(np.clip(math.pi / math.sqrt(2 * SEEN * coarser * sizes.extent / largest), FEWEST, ROUND))
        if largest
        else FEWEST
    )


def _ellipsoid(form: EllipsoidForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    half = numbers.vector(form.size)
    least = 0.12 * np.max(np.where(np.isfinite(half), half, 0.0), axis=1, keepdims=True)
    half = np.maximum(half, least)
    coarser = STANDS_FOR if mark.role == "inertia" else 1.0
    fall = np.linspace(0, math.pi, _pieces(half, sizes, coarser) // 2 + 1)
    turn = np.linspace(0, math.tau, _pieces(half[:, :2], sizes, coarser) + 1)
    ball = np.stack(
        [np.outer(np.sin(fall), np.cos(turn)), np.outer(np.sin(fall), np.sin(turn)), np.outer(np.cos(fall), turn**0)], 2
    )
    own = numbers.vector(form.at)[:, None, None, :] + half[:, None, None, :] * ball
    return [_faces(numbers.placed(_quads(own), mark.frame), mark, solid=True)], []


def _revolution(form: RevolutionForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    r = np.column_stack([numbers.value(x) for x, _ in form.profile])
    z = np.column_stack([numbers.value(x) for _, x in form.profile])
    own = numbers.vector(form.at)[:, None, None, :] + _swept(r, z, _pieces(r, sizes))
    return [_faces(numbers.placed(_quads(own), mark.frame), mark, solid=_convex(r, z))], []


def _convex(r: np.ndarray, z: np.ndarray) -> bool:
    """True if every profile, n x k, begins and ends on the axis and turns to one side: it sweeps a convex solid."""
    across, up = np.diff(r, axis=1), np.diff(z, axis=1)
    turns = across[:, :-1] * up[:, 1:] - across[:, 1:] * up[:, :-1]
    return not r[:, [0, -1]].any() and bool((turns >= 0).all() or (turns <= 0).all())


def _swept(r: np.ndarray, z: np.ndarray, pieces: int) -> np.ndarray:
    """A profile n x k about z: n x k x turns x 3."""
    turn = np.linspace(0, math.tau, pieces + 1)
    swept: np.ndarray = np.stack(
        [
            r[:, :, None] * np.cos(turn),
            r[:, :, None] * np.sin(turn),
            np.broadcast_to(z[:, :, None], (*z.shape, len(turn))),
        ],
        axis=-1,
    )
    return swept


def _quads(grid: np.ndarray) -> np.ndarray:
    """The faces between the lines of a grid n x k x m x 3."""
    corners = np.stack([grid[:, :-1, :-1], grid[:, 1:, :-1], grid[:, 1:, 1:], grid[:, :-1, 1:]], axis=3)
    quads: np.ndarray = corners.reshape(len(grid), -1, 4, 3)
    return quads


def _prism(form: PrismForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    ends = [numbers.spots(tuple(Vector((x, y, z)) for x, y in form.points), mark) for z in (form.low, form.high)]
    rims = [np.concatenate([end, end[:, :1]], axis=1) for end in ends]
    walls = np.stack([rims[0][:, :-1], rims[0][:, 1:], rims[1][:, 1:], rims[1][:, :-1]], axis=2)
    return [_faces(walls, mark), *(_faces(end[:, None], mark) for end in ends)], []


def _polyhedron(form: PolyhedronForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    corners = numbers.spots(form.points, mark)
    return [_faces(corners[:, None, list(face)], mark) for face in form.faces], []


def _wheel(form: forms.WheelForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """Its rim and two spokes; the axes across are the body's, so that it is seen to turn."""
    n, at, r = _unit(numbers.vector(form.axis)), numbers.vector(form.at), numbers.value(form.radius)[:, None, None]
    x, y = _crossing(n)
    turn = np.linspace(0, math.tau, 2 * ROUND + 1)
    rim = np.cos(turn)[:, None] * x[:, None, :] + np.sin(turn)[:, None] * y[:, None, :]
    own = at[:, None, :] + r * np.concatenate([rim, -x[:, None, :], y[:, None, :], -y[:, None, :]], axis=1)
    path = numbers.placed(own, mark.frame)
    spokes = [Stroke(path[:, pair], mark.role, mark.of, fine=True) for pair in ([0, -3], [-2, -1])]
    return [Stroke(path[:, :-3], mark.role, mark.of), *spokes], []


def _rod(form: forms.RodForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [Stroke(numbers.spots((form.a, form.b), mark), mark.role, mark.of)], []


def _point(form: forms.PointForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [Stroke(numbers.spots((form.at,), mark), mark.role, mark.of, dot=True)], []


# -- springs, tracks, symbols ------------------------------------------------------------------------


def _spring(form: forms.SpringForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A coil about the line from a to b."""
    turn = np.linspace(0, math.tau * TEETH, 12 * TEETH + 1)
    share = np.concatenate([[0.0], np.linspace(0.12, 0.88, len(turn)), [1.0]])
    ring = (
        0.5 * sizes.unit * np.concatenate([[[0.0, 0.0]], np.column_stack([np.cos(turn), np.sin(turn)]), [[0.0, 0.0]]])
    )
    return [Stroke(_along(form, mark, numbers, share, ring), mark.role, mark.of)], []


def _damper(form: forms.DamperForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A cylinder about a thin rod."""
    r = np.array([0.0, 0.5, 0.5, 0.5, 0.0, 0.0]) * sizes.unit
    share = np.array([0.38, 0.38, 0.62, 0.62, 0.62, 1.0])
    side = np.column_stack([r, np.zeros(len(r))])
    paths = [_along(form, mark, numbers, share, sign * side) for sign in (1, -1)]
    start = _along(form, mark, numbers, np.array([0.0, 0.38]), np.zeros((2, 2)))
    return [Stroke(path, mark.role, mark.of) for path in (start, *paths)], []


def _cylinder(form: forms.CylinderForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A closed cylinder of one length, and a rod that comes out of it."""
    a, b = numbers.spot(form.a, mark), numbers.spot(form.b, mark)
    n = _unit(b - a)
    x, y = _crossing(n)
    length = np.linalg.norm(b - a, axis=1)
    end = barrel(b - a) * length
    found = []
    for radius, low, high in ((0.6, 0.0 * end, end), (0.25, end, length)):
        r = np.tile(radius * sizes.unit * np.array([0.0, 1.0, 1.0, 0.0]), (numbers.size, 1))
        own = _quads(_swept(r, np.column_stack([low, low, high, high]), SMALL))
        turned = sum(own[..., k : k + 1] * e[:, None, None, :] for k, e in enumerate((x, y, n)))
        found.append(_faces(a[:, None, None, :] + turned, mark, solid=True))
    return found, []


def _along(
    form: forms.SpringForm, mark: Mark, numbers: SceneNumbers, share: np.ndarray, across: np.ndarray
) -> np.ndarray:
    """Points at shares of the way from a to b, offset in two directions across it [m]."""
    a, b = numbers.spot(form.a, mark), numbers.spot(form.b, mark)
    first, second = _crossing(_unit(b - a))
    path: np.ndarray = a[:, None, :] + share[:, None] * (b - a)[:, None, :]
    path = path + across[:, :1] * first[:, None, :] + across[:, 1:] * second[:, None, :]
    return path


def _unit(v: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(v, axis=1, keepdims=True)
    found: np.ndarray = v / np.where(length > 0, length, 1.0)
    return found


def _crossing(n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit directions across unit vectors n x 3, so that the three are right-handed."""
    least = np.eye(3)[np.argmin(np.abs(n), axis=1)]
    first = _unit(np.cross(least, n))
    return first, np.cross(n, first)


def _track(form: forms.TrackForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A line as long as the picture; a plane as the rectangle below all that is drawn."""
    at = numbers.spot(form.at, mark)
    middle, half = 0.5 * (sizes.low + sizes.high), 0.5 * (sizes.high - sizes.low)
    if form.along is not None:
        reach = 1.2 * float(np.linalg.norm(half))
        along = _unit(numbers.way(form.along, mark))
        center = at + np.sum((middle - at) * along, axis=1, keepdims=True) * along
        return [Stroke(np.stack([center - reach * along, center + reach * along], axis=1), mark.role, mark.of)], []
    if form.normal is None:
        return [], []
    n = _unit(numbers.way(form.normal, mark))
    center = middle - np.sum((middle - at) * n, axis=1, keepdims=True) * n
    x, y = (((np.abs(e) @ half)[:, None] + BESIDE * sizes.unit) * e for e in _crossing(n))
    corners = np.stack([center + x + y, center - x + y, center - x - y, center + x - y], axis=1)
    return [_faces(corners[:, None], mark)], []


def _symbol(form: forms.SymbolForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A symbol of the table, its axis turned, in its size."""
    at = numbers.spot(form.at, mark)
    z = _unit(numbers.way(form.along if form.along is not None else Vector((0, 0, 1)), mark))
    x, y = _crossing(z)
    found = []
    for role, part in SPACE[form.symbol]:
        faces, solid = _own(part)
        own = sizes.unit * faces
        path = at[:, None, None, :] + sum(own[..., k : k + 1] * e[:, None, None, :] for k, e in enumerate((x, y, z)))
        if isinstance(part, LineForm):
            found.append(Stroke(path[:, 0], role, mark.of, fine=True))
        else:
            found.append(_faces(path, mark, role, solid=solid))
    return found, []


def _own(part: Any) -> tuple[np.ndarray, bool]:
    """(the faces f x c x 3 of a part of a symbol, whether they enclose what is convex); of a line 1 x k x 3."""
    if isinstance(part, LineForm):
        return np.array([[[float(plain_number(x)) for x in place] for place in part.points]]), False
    if isinstance(part, RevolutionForm):
        profile = np.array([[[float(plain_number(r)), float(plain_number(z))] for r, z in part.profile]])
        pieces = SMALL if profile[..., 0].max() <= 1 else ROUND
        return _quads(_swept(profile[..., 0], profile[..., 1], pieces))[0], _convex(profile[..., 0], profile[..., 1])
    size = np.array([float(plain_number(x)) for x in part.size])
    if isinstance(part, BoxForm):
        return (size * CUBE)[np.array(SIDES)], True
    fall = np.linspace(0, math.pi, SMALL // 2 + 1)
    return size[0] * _quads(_swept(np.sin(fall)[None], np.cos(fall)[None], SMALL))[0], True


# -- arrows and names --------------------------------------------------------------------------------


def _arrow(form: forms.ArrowForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    at, v = numbers.spot(form.at, mark), numbers.way(form.vector, mark)
    shown = sizes.scales.get((mark.role, form.unit), 0.0) * v
    begin, tip = (at, at + shown) if form.outward else (at - shown, at)
    free = tip if form.outward else begin
    letters = [Letter(form.text, free, mark.role, mark.of)] if form.text else []
    return _arrow_strokes(begin, tip, mark, sizes), letters


def _arrow_strokes(
    begin: np.ndarray, tip: np.ndarray, mark: Mark, sizes: PictureSizes, part: float = 1.0
) -> list[Stroke]:
    """A shaft, and a cone at its end, so many units of the usual; gone where it has no length."""
    along = tip - begin
    length = np.linalg.norm(along, axis=1, keepdims=True)
    hidden = np.where(length > 0.02 * sizes.unit, 0.0, np.nan)
    n = _unit(along)
    size = np.minimum(1.2 * part * sizes.unit, 0.8 * length)
    first, second = _crossing(n)
    turn = np.linspace(0, math.tau, 9)
    rim = (tip - size * n)[:, None, :] + 0.33 * size[:, None] * (
        np.cos(turn)[:, None] * first[:, None, :] + np.sin(turn)[:, None] * second[:, None, :]
    )
    top = np.broadcast_to((tip + hidden)[:, None, :], rim[:, 1:].shape)
    cone = np.stack([rim[:, :-1], rim[:, 1:], top], axis=2)
    return [Stroke(np.stack([begin + hidden, tip - size * n], axis=1), mark.role, mark.of), _faces(cone, mark)]


def _couple(form: forms.CoupleForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """A double arrow along the couple."""
    at = numbers.spot(form.at, mark)
    v = np.column_stack([numbers.value(x) for x in form.vector])
    tip = at + np.where(np.linalg.norm(v, axis=1, keepdims=True) > 0, 4.0, 0.0) * sizes.unit * _unit(v)
    inner = at + 0.8 * (tip - at)
    letters = [Letter(form.text, tip, mark.role, mark.of)] if form.text else []
    return [*_arrow_strokes(at, inner, mark, sizes), *_arrow_strokes(at, tip, mark, sizes)], letters


def _load(form: forms.LoadForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """Arrows whose tips are on a line, their tails joined."""
    a, b = numbers.spot(form.a, mark), numbers.spot(form.b, mark)
    p, q = numbers.way(form.at_a, mark), numbers.way(form.at_b, mark)
    size = 0.07 * sizes.extent / (float(np.nanmax(np.linalg.norm(np.concatenate([p, q]), axis=1))) or 1.0)
    found, tails = [], []
    for share in np.linspace(0, 1, 8):
        tip = a + share * (b - a)
        tails.append(tip - size * (p + share * (q - p)))
        found += _arrow_strokes(tails[-1], tip, mark, sizes, SMALLER)
    found.append(Stroke(np.stack(tails, axis=1), mark.role, mark.of))
    return found, [Letter(form.text, np.mean(tails, axis=0), mark.role, mark.of)] if form.text else []


def _label(form: forms.LabelForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    return [], [Letter(form.text, numbers.spot(form.at, mark), mark.role, mark.of)]


def _nothing(form: Any, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """Dimension lines and angles are for the plane."""
    return [], []


def _field(form: forms.FieldForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """Arrow of a uniform field, at the corner of the picture."""
    if not sizes.dimensions:
        return [], []
    v = 4.5 * sizes.unit * _unit(numbers.way(form.vector, mark))
    corner = np.where(sizes.up < -FAR, sizes.low, np.where(sizes.up > FAR, sizes.high, [sizes.low[0], *sizes.high[1:]]))
    aside = np.eye(3)[0 if abs(sizes.up[0]) < FAR else 1]
    begin = np.broadcast_to(corner + sizes.unit * (2 * sizes.up - 2 * BESIDE * aside), v.shape)
    return _arrow_strokes(begin, begin + v, mark, sizes), [Letter(form.text, begin + 0.5 * v, mark.role, mark.of)]


def _axes(form: forms.AxesForm, mark: Mark, numbers: SceneNumbers, sizes: PictureSizes) -> Drawn:
    """x, y and z, four symbols long."""
    at = numbers.spot(form.at, mark)
    found: list[Stroke] = []
    letters: list[Letter] = []
    for name, e in zip("xyz", np.eye(3, dtype=int).tolist(), strict=True):
        tip = at + 4 * sizes.unit * _unit(numbers.way(Vector((e[0], e[1], e[2])), mark))
        found += _arrow_strokes(at, tip, mark, sizes)
        letters.append(Letter(name, tip, mark.role, mark.of))
    return found, letters


TABLE: DrawerTable = {
    LineForm: _line,
    PolygonForm: _polygon,
    ArcForm: _arc,
    BoxForm: _box,
    EllipsoidForm: _ellipsoid,
    RevolutionForm: _revolution,
    PrismForm: _prism,
    PolyhedronForm: _polyhedron,
    forms.RodForm: _rod,
    forms.SpringForm: _spring,
    forms.DamperForm: _damper,
    forms.CylinderForm: _cylinder,
    forms.WheelForm: _wheel,
    forms.TrackForm: _track,
    forms.SymbolForm: _symbol,
    forms.PointForm: _point,
    forms.LabelForm: _label,
    forms.ArrowForm: _arrow,
    forms.CoupleForm: _couple,
    forms.LoadForm: _load,
    forms.DimensionForm: _nothing,
    forms.AngleForm: _nothing,
    forms.FieldForm: _field,
    forms.AxesForm: _axes,
}
