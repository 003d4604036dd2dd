"""A result -> its document; how files are written: whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable
from pathlib import Path

from eomgen.errors import RunFailed
from eomgen.report.document import Document
from eomgen.report.result import Result


def shown(found: Result, *, plot: str | None = None, certify: bool = True) -> Document:
    """What is found, proven where that is asked for, its picture in a file where one is."""
    if plot is not None:
        found.plot(prepared(plot))
    return found.document.proven(found.certify() if certify else None)


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
