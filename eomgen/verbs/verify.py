"""eomgen verify: decides whether equations derived by hand are right for a model."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from eomgen import files
from eomgen.documents import Document, Lines, plain_document, proven, with_constraints_closed
from eomgen.errors import UsageError
from eomgen.judge import Answered, judged, judged_forces
from eomgen.model import AtRest, Model, WrittenEquation
from eomgen.results import free_bodies as free_bodies_of

LARGEST = 1_000_000  # bytes of a file of answers
PAGES = (".tex", ".md", ".ipynb")  # endings of derivations


def verify_document(
    model: Model,
    *,
    equations: Sequence[str] = (),
    answers: Sequence[str] = (),
    at: WrittenEquation | AtRest | None = None,
    from_rest: Mapping[str, Any] | None = None,
    kind: str | None = None,
    hint: int | None = None,
    derivation: bool = False,
    to_first_order: bool = False,
    about: str | None = None,
    free_bodies: str | None = None,
    certify: bool = True,
) -> Document:
    """The verdicts, each with the relations used or the reason why it is wrong.

    Args:
        equations: as they were typed; "-" reads them from stdin, one a line.
        answers: files of equations, one a line, or folders of such files; .tex, .md and .ipynb are derivations.
        to_first_order, about: as of `verify`.
        derivation: each file is a derivation, whatever its ending.
        at, from_rest, kind: as of `verify`.
        free_bodies: the file of a list of forces on bodies that are cut free, `{body, at, direction, kind, name}`.
        hint: how much is said about what is wrong: 1 where to look, 2 at which quantity, 3 the cause.
    Raises:
        UsageError: there is no equation; the only one cannot be read.
    """
    requested = [
        *(each for text in equations for each in _typed(text)),
        *(each for path in answers for each in _of_path(path, derivation)),
    ]
    if free_bodies is not None:
        if requested:
            raise UsageError("--free-bodies judges a list of forces, and no equation", fix="ask for one of the two")
        return _on_bodies(model, free_bodies, at, certify)
    if not requested:
        raise UsageError("there is no equation to judge", fix="write one behind the model, or --file FILE")
    found = judged(
        model, requested, at=at, from_rest=from_rest, kind=kind, hint=hint, to_first_order=to_first_order, about=about
    )
    skipped = {"skipped": list(found.skipped)} if any(each.is_page for each in requested) else {}
    document = plain_document(
        model,
        lambda: {"name": model.name, "equations": list(found.entries), **skipped},
        Lines(found.lines),
        answer_code=found.exit_code,
    )
    if found.system is not None:
        document = with_constraints_closed(document, found.system)
    return proven(document, found.certify(again=at is None) if certify else None)


def _on_bodies(model: Model, path: str, at: WrittenEquation | AtRest | None, certify: bool) -> Document:
    """The verdict on a list of forces.

    Raises:
        UsageError: the file holds none.
    """
    try:
        listed = json.loads(files.read(Path(path), LARGEST))
    except ValueError as error:
        raise UsageError(f"{path} is no JSON: {error}", fix="save a list of forces as JSON") from error
    listed = listed.get("forces") if isinstance(listed, dict) else listed
    if not isinstance(listed, list):
        raise UsageError(f"{path} holds no list of forces", fix='write [{"body": ..., "at": ..., "direction": ...}]')
    free = free_bodies_of(model, at)
    found = judged_forces(free, listed)
    document = plain_document(
        model,
        lambda: {"name": model.name, "equations": [], "free_bodies": found.entries},
        Lines(found.lines),
        answer_code=found.exit_code,
    )
    return proven(document, free.certify() if certify else None)


def _typed(text: str) -> Iterator[Answered]:
    if text != "-":
        yield Answered(text)
        return
    if sys.stdin is None:
        raise UsageError("there are no equations on stdin: it is closed", fix="write one behind the model")
    yield from _lines(sys.stdin.read(LARGEST), "<stdin>")


def _of_path(path: str, derivation: bool) -> Iterator[Answered]:
    """The equations of a file, or of every file of a folder, a line each; a derivation as a whole."""
    if path == "-" and derivation and sys.stdin is not None:
        yield Answered(sys.stdin.read(LARGEST), "<stdin>", is_page=True)
        return
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
            text = data.decode("utf-8-sig")
            if derivation or (each.suffix.lower() in PAGES and not place.is_dir()):
                yield Answered(_cells(text, str(each)) if each.suffix == ".ipynb" else text, str(each), is_page=True)
            else:
                yield from _lines(text, str(each))
        except UnicodeDecodeError as error:
            raise UsageError(f"{each} is no text in UTF-8", fix="save it as UTF-8") from error


def _cells(text: str, name: str) -> str:
    """The cells of words of a notebook, one below the other.

    Raises:
        UsageError: it is no notebook.
    """
    try:
        cells = json.loads(text)["cells"]
        return "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown")
    except (ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{name} is no notebook", fix="save it as .ipynb") from error


def _lines(text: str, name: str) -> Iterator[Answered]:
    """One equation a line; # and % begin remarks; LaTeX's own lines have no equality sign."""
    for number, line in enumerate(text.splitlines(), start=1):
        bare = line.strip()
        if not bare or bare[0] in "#%" or (bare.startswith(("\\", "$$")) and "=" not in bare):
            continue
        yield Answered(bare, name, number)
