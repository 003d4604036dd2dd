"""Scene -> SVG: a picture without a library that draws.

Each stroke carries the class of its role, so that a page can give it another colour.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby
from typing import Any

from eomgen.documents import FlatName, FlatShape, drawing_at_rest, flat_drawing
from eomgen.frozen import dataclass
from eomgen.model import Model
from eomgen.page.markup import Html, element, in_a_row
from eomgen.page.paper import GREEK, UPRIGHT
from eomgen.scene import Drawing, Scene, scene_of

HALO = 2.5  # white edge of a name, so that it can be read over lines
WIDE, SMALL = 0.56, 0.7  # width of a letter, of its size; size of an index, of the letter's
DROP, BASE = 0.28, 0.78  # of a letter's size: how far an index stands lower; of a box: how far the base line is below
LETTERS = GREEK | {"ell": "ℓ", "prime": "′", "cdot": "·"}
COMBINED = {"dot": "\u0307", "ddot": "\u0308", "bar": "\u0304", "hat": "\u0302", "tilde": "\u0303", "vec": "\u20d7"}
FONT = "'STIX Two Math', 'Cambria Math', serif"
_MARKS = re.compile(r"\\[a-zA-Z]+|\\.|[{}_^]|.")


def model_svg(model: Model) -> Html:
    """The picture of a model where it starts, with its coordinates and lengths, as one element <svg>.

    Raises:
        DerivationError, NotYet: what cannot be derived is not drawn either.
    """
    scene = scene_of(model)
    return scene_svg(scene, drawing_at_rest(scene))


def scene_svg(scene: Scene, drawing: Drawing, label: str = "the model at its start") -> Html:
    """A scene at the first frame of its drawing as one element <svg>.

    Args:
        label: its content, in words.
    """
    found = flat_drawing(scene, drawing, lambda text: WIDE * sum(SMALL if s.level else 1.0 for s in signs_of(text)))
    marks = [mark for shape in found.shapes for mark in _shape(shape)]
    letters = element("g", *map(_name, found.names), class_="names")
    width, height = (f"{side:.0f}" for side in found.size)
    named: dict[str, Any] = {"xmlns": "http://www.w3.org/2000/svg", "role": "img", "aria_label": label}
    box = {"viewBox": f"0 0 {width} {height}", "width": width, "height": height}
    return element("svg", *marks, letters, **named, **box)


def _shape(shape: FlatShape) -> Iterator[Html]:
    look, (inside, edge) = shape.look, shape.opaque
    shown: dict[str, Any] = {"class_": shape.role or None, "data_of": shape.of or None}
    if shape.dot:
        for piece in shape.pieces:
            for x, y in piece:
                yield element("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r=f"{look.width / 2:g}", fill=look.edge, **shown)
        return
    path = "".join(
        "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in piece) + ("Z" if look.fill else "") for piece in shape.pieces
    )
    shown |= {"fill": look.fill or "none", "stroke": look.edge, "stroke_width": f"{look.width:g}"}
    shown |= {"fill_opacity": f"{inside:g}"} if look.fill and inside < 1 else {}
    shown |= {"stroke_opacity": f"{edge:g}"} if edge < 1 else {}
    if path:
        yield element("path", d=path, stroke_linecap="round", stroke_linejoin="round", **shown)


# -------- names -----------------------------------------------------------------------------------------------
# Names in LaTeX as text of SVG.


@dataclass(frozen=True)
class Sign:
    """A letter of a name.

    Args:
        level: 0, -1 below, 1 above the line.
        upright: it does not slope.
    """

    text: str
    level: int
    upright: bool


def _name(name: FlatName) -> Html:
    """One name in its box."""
    box, size, level = name.box, name.size, 0
    pieces = []
    for (new, upright), run in groupby(signs_of(name.text), key=lambda sign: (sign.level, sign.upright)):
        look: dict[str, Any] = {"font_style": None if upright else "italic"}
        here = SMALL if new else 1.0
        look |= {"font_size": f"{SMALL:g}em"} if new else {}
        look |= {"dy": f"{DROP * (level - new) / here:.2f}em"} if new != level else {}
        pieces.append(element("tspan", "".join(sign.text for sign in run), **look))
        level = new
    middle, base = 0.5 * (box.left + box.right), box.bottom + BASE * (box.top - box.bottom)
    look = {"font_family": FONT, "font_size": f"{size:.1f}", "fill": name.color, "text_anchor": "middle"}
    halo: dict[str, Any] = {"stroke": "#ffffff", "stroke_width": f"{HALO:g}", "paint_order": "stroke"}
    return element("text", in_a_row(*pieces), x=f"{middle:.1f}", y=f"{base:.1f}", **look, **halo)


def signs_of(text: str) -> tuple[Sign, ...]:
    r"""The letters of a name as pictures have it: "$\theta_{1}$" in mathematics, all else as it stands."""
    if not (text.startswith("$") and text.endswith("$") and len(text) > 1):
        return tuple(Sign(letter, 0, True) for letter in text.replace(r"\$", "$"))
    return tuple(_signs(iter(_MARKS.findall(text[1:-1])), 0, False))


def _signs(marks: Iterator[str], level: int, upright: bool) -> Iterator[Sign]:
    """The letters up to the end of a group."""
    here, plain, accent = level, upright, ""
    for mark in marks:
        if mark == "}":
            return
        if mark in "_^":
            here = -1 if mark == "_" else 1
            continue
        if mark[0] == "\\" and mark[1:] in COMBINED:
            accent = COMBINED[mark[1:]]
            continue
        if mark[0] == "\\" and mark[1:] in UPRIGHT:
            plain = True
            continue
        for sign in _signs(marks, here, plain) if mark == "{" else _letter(mark, here, plain):
            yield Sign(sign.text + accent, sign.level, sign.upright)
            accent = ""
        here, plain = level, upright


def _letter(mark: str, level: int, upright: bool) -> Iterator[Sign]:
    word = mark[1:] if mark.startswith("\\") else ""
    if mark.isspace() or (word and not word.isalpha() and word in ",;:! "):
        return
    text = LETTERS.get(word, word) if word else mark
    yield Sign(text, level, upright or not text.isalpha())
