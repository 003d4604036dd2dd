"""What a verb gives, and how files are written: whole or not at all."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol

from eomgen.errors import RunFailed
from eomgen.proof.check import Certificate

SCHEMA_VERSION = 1


@dataclass(frozen=True)
class Outcome:
    """What a verb gives.

    Args:
        text: the result for people.
        payload: the result for machines; `schema_version` is added on the way out.
        failed: why the exit code is 3, or "".
        notes: what else is worth a line on stderr.
    """

    text: str
    payload: Mapping[str, Any] = field(default_factory=dict)
    failed: str = ""
    notes: tuple[str, ...] = ()

    @property
    def json(self) -> str:
        return (
            json.dumps(
                {"schema_version": SCHEMA_VERSION, **self.payload}, ensure_ascii=False, indent=1, allow_nan=False
            )
            + "\n"
        )


class Told(Protocol):
    """A result that is written step by step, for machines, and drawn."""

    def render(self, format: str) -> str: ...

    def as_dict(self) -> dict[str, Any]: ...

    def plot(self, path: str | Path) -> None: ...


def told(found: Told, *, format: str, plot: str | None, failed: str = "") -> Outcome:
    """A result in the format that is asked for, its picture in a file where one is."""
    if plot is not None:
        found.plot(prepared(plot))
    if format == "json":
        return Outcome("", found.as_dict(), failed)
    return Outcome(found.render(format), {}, failed)


DISTRUST = "the certificate FAILS: do not trust this result"
NOTHING_CHECKED = "warning: nothing of this result could be checked"


def proven(outcome: Outcome, certificate: Certificate | None, format: str = "text") -> Outcome:
    """A result with its certificate: a contradiction stands first and ends in exit 3; None: none was asked for.

    Args:
        format: text, latex, markdown or json, as the result is written.
    """
    if certificate is None:
        return replace(outcome, payload={**outcome.payload, "certificate": None})
    failed = DISTRUST if certificate.ok is False else ""
    text = outcome.text and _with_proof(outcome.text, certificate, failed, format)
    return replace(
        outcome,
        text=text,
        payload={**outcome.payload, "certificate": certificate.as_dict()},
        failed="; ".join(filter(None, (failed, outcome.failed))),
        notes=(*outcome.notes, *((NOTHING_CHECKED,) if certificate.ok is None else ())),
    )


def _with_proof(text: str, certificate: Certificate, failed: str, format: str) -> str:
    """The result and its proof: part of the text, a comment in LaTeX; a failure stands first, visibly."""
    text, proof = text.rstrip("\n") + "\n", str(certificate)
    if format == "latex":
        comment = "".join(f"% {line}\n" for line in proof.splitlines())
        visible = r"\begin{document}" + "\n" + r"\textbf{" + failed + "}\n"
        return comment + (text.replace(r"\begin{document}" + "\n", visible, 1) if failed else text)
    if format == "markdown":
        proof = f"```\n{proof}\n```"
        failed = f"**{failed}**" if failed else ""
    return (f"{failed}\n\n" if failed else "") + f"{text}\n{proof}\n"


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
