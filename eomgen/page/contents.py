"""What a report is made of: sections of the documents of verbs, drawings, and files that it carries."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from eomgen.documents.document import Document
from eomgen.documents.statements import Prose, Step
from eomgen.model.table import Table
from eomgen.page.markup import Html
from eomgen.proof.check import Certificate, Check
from eomgen.records import dataclass

SECTIONS = {
    "figure": "Figure",
    "data": "Data",
    "derivation": "Derivation",
    "reactions": "Reactions",
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

PLAYER = "motion-player"
"""The element of a page in which the motion is played."""

INKS = ("#1f5fa8", "#b8431f", "#1f7a4a", "#7a3f9d", "#8a6a00", "#0f7c86", "#a12d63", "#4f5a66")
"""The colours of curves on light paper, by the number of their class."""


@dataclass(frozen=True)
class LegendEntry:
    """What a line of a drawing means.

    Args:
        style: its class: its colour, and how it is dashed.
        name: in words and formulas.
    """

    style: str
    name: Prose


@dataclass(frozen=True)
class ReportFigure:
    """A picture of a report.

    Args:
        key: names its file.
        caption: what it shows, in words.
        size: width and height of its box.
        marks: what stands in it, SVG; classes say how it looks, so that a page can be dark.
        legend: its curves.
        save: draws it into a file of its own, whose ending says how; None where that cannot be.
        fixed: its colours are its own, for light paper.
    """

    key: str
    caption: str
    size: tuple[float, float]
    marks: Html
    legend: tuple[LegendEntry, ...] = ()
    save: Callable[[Path], object] | None = None
    fixed: bool = False


@dataclass(frozen=True)
class Attachment:
    """A file inside a report.

    Args:
        content: its bytes; or, of a table, its columns, of which the page makes the lines when it is asked for them.
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
        live: gives what moves, as HTML that is complete in itself; None where nothing does.
        computed: the columns of the motion that it computes.
        remark: why it is empty, or what else is to be said.
    """

    key: str
    steps: tuple[Step, ...] = ()
    drawings: tuple[ReportFigure, ...] = ()
    attachments: tuple[Attachment, ...] = ()
    live: Callable[[], Html] | None = None
    computed: frozenset[str] = frozenset()
    remark: str = ""

    @property
    def title(self) -> str:
        return SECTIONS[self.key]


@dataclass(frozen=True)
class Report:
    """A model and what was found of it.

    Args:
        head: the document under whose name, remark and source it stands; with its proof.
        sections: in the order of the page.
        origin: the file that it was made of, "" for none.
        source: the text of the model, "" where it was made in Python.
        values: "parameters" and "start" that replace those of the text, in SI.
        time: how long the motion is followed [s].
    """

    head: Document
    sections: tuple[ReportSection, ...]
    origin: str = ""
    source: str = ""
    values: Mapping[str, Mapping[str, str]] = Table()
    time: float = 0.0

    @property
    def certificate(self) -> Certificate | None:
        return self.head.certificate

    @property
    def printed(self) -> tuple[ReportSection, ...]:
        """The sections of which something can be printed."""
        return tuple(s for s in self.sections if s.steps or s.drawings or s.remark or s.key == "certificate")

    @property
    def as_document(self) -> Document:
        """Its head with every step of every section, and what legends say: the same notation for all."""
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
