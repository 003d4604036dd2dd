"""What a verb gives, and how files are written: whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eomgen.errors import RunFailed
from eomgen.proof.check import Certificate
from eomgen.report import json_form
from eomgen.report.document import Document
from eomgen.report.result import Result


@dataclass(frozen=True)
class Outcome:
    """What a verb gives.

    Args:
        document: the result, for people and for machines.
        notes: what else is worth a line on stderr.
    """

    document: Document
    notes: tuple[str, ...] = ()

    @property
    def failed(self) -> str:
        """Why the exit code is 3, or ""."""
        return "; ".join(filter(None, (self.document.distrust, self.document.failed)))

    @property
    def payload(self) -> dict[str, Any]:
        """The result for machines."""
        return json_form.as_dict(self.document)


def told(found: Result, *, plot: str | None) -> Outcome:
    """A result, its picture in a file where one is asked for."""
    if plot is not None:
        found.plot(prepared(plot))
    return Outcome(found.document)


def proven(outcome: Outcome, certificate: Certificate | None) -> Outcome:
    """A result with its certificate: a contradiction stands first and ends in exit 3; None: none was asked for."""
    return Outcome(outcome.document.proven(certificate), outcome.notes)


def listed(names: Iterable[str]) -> str:
    """Names in a line of text."""
    return ", ".join(names) or "none"


def prepared(path: str) -> Path:
    """The path, its folder made if it is not there.

    Raises:
        RunFailed: the folder cannot be made.
    """
    try:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RunFailed(f"the folder cannot be made: {error.strerror or error}", str(Path(path).parent)) from None
    return Path(path)


def write_text(path: str, text: str) -> None:
    """The text into a file, whole or not at all.

    Raises:
        RunFailed: it cannot be written; what was there before is then still there.
    """
    target = prepared(path)
    aside = None
    try:
        if target.exists() and not target.is_file():  # a pipe, a terminal: nothing to move into place
            target.write_text(text, encoding="utf-8")
            return
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=target.parent, prefix=".eomgen-", delete=False
        ) as file:
            aside = file.name
            file.write(text)
        os.umask(mask := os.umask(0))
        os.chmod(aside, 0o666 & ~mask)
        os.replace(aside, target)
    except OSError as error:
        if aside is not None:
            Path(aside).unlink(missing_ok=True)
        raise RunFailed(f"the file cannot be written: {error.strerror or error}", path) from None
