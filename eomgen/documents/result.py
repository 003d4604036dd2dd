"""A result of a verb: its document in every format, in a notebook, in a file; its picture."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from eomgen.documents import json_form, latex, markdown, text
from eomgen.documents.document import Document, with_section
from eomgen.documents.figures import Picture
from eomgen.documents.markdown import markdown_below
from eomgen.errors import UsageError, visible
from eomgen.proof import Certificate, Check, DrawnPanel

ALL = (text, latex, markdown, json_form)


def rendered(document: Document, format: str = "text") -> str:
    """The document in one of the formats of ALL: text, latex, markdown, json.

    Raises:
        UsageError: an unknown format.
    """
    return visible(drawn(document, format))


def drawn(document: Document, format: str) -> str:
    """Document in a format, as of `rendered` but with control characters left in; this text is read back."""
    formats: dict[str, Callable[[Document], str]] = {member.name: member.render for member in ALL}
    if format not in formats:
        raise UsageError(f"unknown format '{format}'", fix=f"one of {', '.join(formats)}")
    return formats[format](document)


def fragment_of(document: Document, section: str | None, fragment: bool, numbered: bool) -> Document:
    """The document with one of its sections, or all; as a part of another document, where that is requested.

    Raises:
        UsageError: there is no such section; numbers are requested for a whole document.
    """
    if numbered and not fragment:
        raise UsageError("numbers are those of a fragment", fix="give fragment=True, or --fragment, too")
    found = document if section is None else with_section(document, section)
    return replace(found, fragment=("numbered" if numbered else "plain") if fragment else "")


class Result:
    """Result of a verb that can be shown: a derivation, entries for JSON, and a picture where it has one."""

    @property
    def derivation(self) -> Document:
        """The way to it, step by step."""
        raise NotImplementedError

    @property
    def picture(self) -> Picture:
        """Picture of the result."""
        raise NotImplementedError

    @property
    def failed(self) -> str:
        """Errors or open questions of the result, in words; "" if there are none."""
        return ""

    def certify(self) -> Certificate:
        """The proof of it, made on demand."""
        raise NotImplementedError

    def drawn_checks(self, panels: Sequence[DrawnPanel]) -> Iterable[Check]:
        """The proof of its picture, by the content of its panels."""
        return ()

    def entries(self) -> Mapping[str, Any]:
        """Entries of the JSON document, with quantities as leaves."""
        raise NotImplementedError

    @property
    def document(self) -> Document:
        """All of it as one value."""
        return replace(self.derivation, entries=self.entries, failed=self.failed)

    def render(self, format: str = "text") -> str:
        """Text of the document in one of the formats text, latex, markdown, json."""
        return rendered(self.document, format)

    def as_dict(self) -> dict[str, Any]:
        """Content of the output of `--json`."""
        return json_form.as_dict(self.document)

    def latex(self, section: str | None = None, fragment: bool = False, numbered: bool = False) -> str:
        """The derivation in LaTeX, a file that compiles.

        Args:
            section: only this one of its sections: "motion", "positions", ...
            fragment: what one pastes into a document of one's own, which needs amsmath alone.
            numbered: each formula of a fragment has a number.
        Raises:
            UsageError: there is no such section.
        """
        return rendered(fragment_of(self.document, section, fragment, numbered), "latex")

    def plot(self, path: str | Path) -> None:
        """Draw it as .png, .svg or .pdf."""
        self.picture.save(path)

    def __str__(self) -> str:
        return self.render("text")

    def _repr_markdown_(self) -> str:
        return markdown_below(self.render("markdown"))
