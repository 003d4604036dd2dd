"""Parts of a report: sections of the documents of verbs, drawings, and files that it carries."""

from __future__ import annotations

import html
import re
import tempfile
from collections.abc import Callable, Container, Mapping
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from eomgen.documents import Catalogue, Document, Prose, Step
from eomgen.frozen import Pickled, dataclass
from eomgen.model import Table
from eomgen.page.markup import Html
from eomgen.proof import Certificate, Check

SECTIONS = {
    "statement": "Problem",
    "figure": "Figure",
    "data": "Data",
    "questions": "Questions",
    "derivation": "Derivation",
    "reactions": "Reactions",
    "free_bodies": "Free bodies",
    "statics": "At rest",
    "kinematics": "Velocities and accelerations",
    "inertia": "Masses and inertia",
    "outputs": "Answers",
    "linearize": "Small motions",
    "plots": "Plots",
    "motion": "Motion",
    "certificate": "Certificate",
    "downloads": "Downloads",
}
"""Every section that there is, in the order of the page, with its title."""
_TICK = re.compile(r"(?<=>)[^<>]+(?=</text>)")

PLAYER = "motion-player"
"""The element of a page in which the motion is played."""

INKS = ("#1f5fa8", "#b8431f", "#1f7a4a", "#7a3f9d", "#8a6a00", "#0f7c86", "#a12d63", "#4f5a66")
"""The colours of curves on light paper, by the number of their class."""


ENDINGS = (".svg", ".pdf")
"""Endings of the files that hold the figures of a report."""


@dataclass(frozen=True)
class LegendEntry:
    """Meaning of one line of a drawing.

    Args:
        style: its class, which gives colour and dashes.
        name: in words and formulas.
    """

    style: str
    name: Prose


class _Files:
    """A picture as it was drawn, by the ending of the file."""

    def __init__(self, drawn: Mapping[str, bytes]) -> None:
        self.drawn = dict(drawn)

    def __call__(self, path: Path) -> None:
        path.write_bytes(self.drawn[path.suffix])


def _drawn(save: Callable[[Path], object], ending: str) -> bytes:
    """Content of a picture's file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"figure{ending}"
        save(path)
        return path.read_bytes()


def framed(page: str) -> str:
    """A page inside another, as notebooks show it: it loads nothing from elsewhere."""
    style = "width:100%;height:560px;border:0"
    return f'<iframe sandbox="allow-scripts" style="{style}" srcdoc="{html.escape(page)}"></iframe>'


@dataclass(frozen=True)
class ReportFigure:
    """A picture of a report.

    Args:
        key: names its file.
        caption: its content, in words.
        size: width and height of its box.
        marks: its content, SVG; its look is given by classes, so that a page can be dark.
        legend: its curves.
        save: draws it into a file of its own, whose ending says how, where it is not fixed in a `language`; None where
            that is not possible.
        fixed: its colours are its own, for light paper.
    """

    key: str
    caption: str
    size: tuple[float, float]
    marks: Html
    legend: tuple[LegendEntry, ...] = ()
    save: Callable[..., object] | None = None
    fixed: bool = False

    def drawn(self, ending: str) -> bytes:
        """The picture as a file with this ending."""
        assert self.save is not None
        return _drawn(self.save, ending)

    def __getstate__(self) -> dict[str, Any]:
        """State to be pickled: the drawn files take the place of the function that draws them."""
        own = {name: self.__dict__[name] for name in self.__dataclass_fields__}
        return own if self.save is None else own | {"save": _Files({e: _drawn(self.save, e) for e in ENDINGS})}


@dataclass(frozen=True)
class Attachment:
    """A file inside a report.

    Args:
        content: its bytes; or, of a table, its columns, of which the page makes the lines when they are requested.
    """

    name: str
    media: str
    content: bytes | Mapping[str, np.ndarray]
    about: str


@dataclass(frozen=True)
class ReportSection:
    """A part of a report.

    Args:
        key: one of SECTIONS.
        steps: of the document of a verb; formulas in it are graph scalars.
        drawings: in their order, after the steps.
        attachments: files that it offers.
        live: gives a player as complete HTML; None where nothing moves.
        computed: the columns of the motion that it computes.
        remark: the reason why it is empty, or a further remark.
        heading: its title in another language; "" for ours.
    """

    key: str
    steps: tuple[Step, ...] = ()
    drawings: tuple[ReportFigure, ...] = ()
    attachments: tuple[Attachment, ...] = ()
    live: Callable[[], Html] | None = None
    computed: frozenset[str] = frozenset()
    remark: str = ""
    heading: str = ""

    def __getstate__(self) -> dict[str, Any]:
        """State to be pickled: the finished player takes the place of the function that makes it."""
        own = {name: self.__dict__[name] for name in self.__dataclass_fields__}
        return own if self.live is None else own | {"live": Pickled(self.live())}

    @property
    def title(self) -> str:
        return self.heading or SECTIONS[self.key]

    def said_in(self, language: Catalogue, kept: Container[str]) -> ReportSection:
        """The section in another language.

        Args:
            kept: keys of the steps that are a user's own words.
        """
        drawings = (
            replace(
                each,
                caption=language.say(each.caption),
                marks=each.marks if each.fixed else Html(_TICK.sub(lambda x: language.number(x[0]), each.marks)),
                legend=tuple(replace(curve, name=language.prose(curve.name)) for curve in each.legend),
                save=each.save if each.fixed or each.save is None else partial(each.save, language=language),
            )
            for each in self.drawings
        )
        return replace(
            self,
            heading=language.say(self.title),
            steps=tuple(step if step.key in kept else language.step(step) for step in self.steps),
            drawings=tuple(drawings),
            attachments=tuple(replace(each, about=language.say(each.about)) for each in self.attachments),
            remark=language.say(self.remark),
        )


@dataclass(frozen=True)
class Report:
    """A model and the results for it.

    Args:
        head: the document under whose name, remark and source it stands; with its proof.
        sections: in the order of the page.
        origin: the file that it was made of, "" for none.
        source: the text of the model, "" where it was made in Python.
        values: "parameters" and "start" that replace those of the text, in SI.
        time: the duration of the motion [s].
        is_open: it holds no answer, and no code that gives one.
    """

    head: Document
    sections: tuple[ReportSection, ...]
    origin: str = ""
    source: str = ""
    values: Mapping[str, Mapping[str, str]] = Table()
    time: float = 0.0
    is_open: bool = False

    def __repr__(self) -> str:
        keys = ", ".join(section.key for section in self.sections)
        proof = "" if self.certificate is None else f"; {self.certificate!r}"
        return f"<report of {self.head.title!r}: {keys}{proof}>"

    def _repr_html_(self) -> str:
        """The page in a frame of its own, for notebooks."""
        formats = import_module("eomgen.page.formats")  # they are made of contents, and come later
        return framed(str(formats.written_as(self, ".html", "report.html")["report.html"]))

    @property
    def certificate(self) -> Certificate | None:
        return self.head.certificate

    @property
    def printed(self) -> tuple[ReportSection, ...]:
        """The sections of which something can be printed."""
        return tuple(s for s in self.sections if s.steps or s.drawings or s.remark or s.key == "certificate")

    @property
    def as_document(self) -> Document:
        """Its head with every step of every section, and the texts of legends: the same notation for all."""
        steps = tuple(step for section in self.sections for step in section.steps)
        legends = (curve.name for section in self.sections for each in section.drawings for curve in each.legend)
        return replace(self.head, steps=(*steps, Step("", "", tuple(legends))))


def joint_proof(parts: dict[str, Certificate | None]) -> Certificate | None:
    """The proofs of several results as one: a check of the same words stands once, where it says the same.

    Args:
        parts: by what they prove; None where a proof was not made.
    """
    found: dict[Check, None] = {}
    for certificate in parts.values():
        found |= dict.fromkeys(certificate.checks if certificate is not None else ())
    return Certificate(tuple(found)) if any(each is not None for each in parts.values()) else None
