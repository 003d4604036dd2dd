"""A result of a verb: its document in every format, in a notebook, in a file; its picture."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from eomgen.documents import json_form, rendered
from eomgen.documents.document import Document
from eomgen.documents.figures import Picture
from eomgen.proof.check import Certificate, Check
from eomgen.proof.reports_read import DrawnPanel


class Result:
    """What can be shown of what a verb finds: a derivation, entries for machines, where it has one a picture."""

    @property
    def derivation(self) -> Document:
        """The way to it, step by step."""
        raise NotImplementedError

    @property
    def picture(self) -> Picture:
        """As it is drawn."""
        raise NotImplementedError

    @property
    def failed(self) -> str:
        """What is wrong with it, or open in it, in words; "" as it must be."""
        return ""

    def certify(self) -> Certificate:
        """The proof of it, made when it is asked for."""
        raise NotImplementedError

    def drawn_checks(self, panels: Sequence[DrawnPanel]) -> Iterable[Check]:
        """The proof of its picture, by what its panels show."""
        return ()

    def entries(self) -> Mapping[str, Any]:
        """What machines get, with quantities as leaves."""
        raise NotImplementedError

    @property
    def document(self) -> Document:
        """All of it as one value."""
        return replace(self.derivation, entries=self.entries, failed=self.failed)

    def render(self, format: str = "text") -> str:
        """In one of the formats text, latex, markdown, json."""
        return rendered(self.document, format)

    def as_dict(self) -> dict[str, Any]:
        """As `--json` gives it."""
        return json_form.as_dict(self.document)

    def latex(self) -> str:
        """The derivation in LaTeX."""
        return self.render("latex")

    def plot(self, path: str | Path) -> None:
        """Draw it as .png, .svg or .pdf."""
        self.picture.save(path)

    def __str__(self) -> str:
        return self.render("text")

    def _repr_markdown_(self) -> str:
        return self.render("markdown")
