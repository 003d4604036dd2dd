"""A result with its derivation and its picture -> as text, in a notebook, in a file."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from eomgen.report import rendered
from eomgen.report.figures import Picture
from eomgen.report.statements import Derivation


class _Derived(Protocol):
    @property
    def derivation(self) -> Derivation: ...


class _Drawn(Protocol):
    @property
    def picture(self) -> Picture: ...


class Shown:
    """What can be shown of a result that has a `derivation`, and of one that has a `picture`."""

    def render(self: _Derived, format: str = "text") -> str:
        """In one of the formats text, latex, markdown, json."""
        return rendered(self.derivation, format)

    def latex(self: _Derived) -> str:
        """The derivation in LaTeX."""
        return rendered(self.derivation, "latex")

    def plot(self: _Drawn, path: str | Path) -> None:
        """Draw it as .png, .svg or .pdf."""
        self.picture.save(path)

    def __str__(self: _Derived) -> str:
        return rendered(self.derivation, "text")

    def _repr_markdown_(self: _Derived) -> str:
        return rendered(self.derivation, "markdown")
