"""eomgen verify: decides whether equations derived by hand are right for a model."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from eomgen import files
from eomgen.documents import Document, Lines, plain_document, proven, with_constraints_closed
from eomgen.errors import UsageError
from eomgen.judge import Answered, judged
from eomgen.model import AtRest, Model, WrittenEquation

LARGEST = 1_000_000  # bytes of a file of answers


def verify_document(
    model: Model,
    *,
    equations: Sequence[str] = (),
    answers: Sequence[str] = (),
    at: WrittenEquation | AtRest | None = None,
    from_rest: Mapping[str, Any] | None = None,
    kind: str | None = None,
    hint: int | None = None,
    certify: bool = True,
) -> Document:
    """The verdicts, each with the relations used or the reason why it is wrong.

    Args:
        equations: as they were typed; "-" reads them from stdin, one a line.
        answers: files of equations, one a line, or folders of such files.
        at, from_rest, kind: as of `verify`.
        hint: how much is said about what is wrong: 1 where to look, 2 at which quantity, 3 the cause.
    Raises:
        UsageError: there is no equation; the only one cannot be read.
    """
    requested = [
        *(each for text in equations for each in _typed(text)),
        *(each for path in answers for each in _of_path(path)),
    ]
    if not requested:
        raise UsageError("there is no equation to judge", fix="write one behind the model, or --file FILE")
    found = judged(model, requested, at=at, from_rest=from_rest, kind=kind, hint=hint)
    document = plain_document(
        model,
        lambda: {"name": model.name, "equations": list(found.entries)},
        Lines(found.lines),
        answer_code=found.exit_code,
    )
    if found.system is not None:
        document = with_constraints_closed(document, found.system)
    return proven(document, found.certify(again=at is None) if certify else None)


def _typed(text: str) -> Iterator[Answered]:
    if text != "-":
        yield Answered(text)
        return
    if sys.stdin is None:
        raise UsageError("there are no equations on stdin: it is closed", fix="write one behind the model")
    yield from _lines(sys.stdin.read(LARGEST), "<stdin>")


def _of_path(path: str) -> Iterator[Answered]:
    """The equations of a file, or of every file of a folder."""
    if path == "-":
        yield from _typed(path)
        return
    place = Path(path)
    found = (
        sorted(x for x in place.iterdir() if x.is_file() and not x.name.startswith(".")) if place.is_dir() else [place]
    )
    for each in found:
        data = files.read(each, LARGEST)
        try:
            yield from _lines(data.decode("utf-8-sig"), str(each))
        except UnicodeDecodeError as error:
            raise UsageError(f"{each} is no text in UTF-8", fix="save it as UTF-8") from error


def _lines(text: str, name: str) -> Iterator[Answered]:
    """One equation a line; # and % begin remarks; LaTeX's own lines have no equality sign."""
    for number, line in enumerate(text.splitlines(), start=1):
        bare = line.strip()
        if not bare or bare[0] in "#%" or (bare.startswith(("\\", "$$")) and "=" not in bare):
            continue
        yield Answered(bare, name, number)
