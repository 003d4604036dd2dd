"""eomgen verify: decides whether equations derived by hand are right for a model."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from eomgen import files
from eomgen.documents import Document, Lines, plain_document, proven, with_constraints_closed
from eomgen.errors import ExpressionError, UsageError
from eomgen.frozen import dataclass
from eomgen.judge import EXIT_CODES, RIGHT, UNDECIDED, UNREADABLE, WRONG, Case, Judge, Verdict
from eomgen.model import AtRest, Model, WrittenEquation, with_values
from eomgen.proof import Certificate, verdicts_again
from eomgen.proof import certify as certificate_of_equations

LARGEST = 1_000_000  # bytes of a file of answers


@dataclass(frozen=True)
class Answered:
    """One equation to be judged.

    Args:
        text: the equation as it was written.
        file, line: its place; "" and 0 for a typed one.
    """

    text: str
    file: str = ""
    line: int = 0


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
    placed = with_values(model, None, from_rest, options=("--set", "--from-rest")).model if from_rest else model
    judge = Judge(Case(placed, from_rest is not None))
    entries: list[dict[str, Any]] = []
    lines: list[str] = []
    codes: list[int] = []
    found: list[Verdict] = []
    for each in requested:
        verdict, entry, reported, code = _judged(judge, each, at, kind, hint, alone=len(requested) == 1)
        found += [verdict]
        entries.append(entry | ({"file": each.file, "line": each.line} if each.file else {}))
        lines += [f"{each.file}:{each.line}: {reported[0]}" if each.file else reported[0], *reported[1:]]
        codes.append(code)
    if len(requested) > 1:
        count = {name: sum(entry["verdict"] == name for entry in entries) for name in EXIT_CODES}
        lines.append(f"{count[RIGHT]} right, {count[WRONG]} wrong, {count[UNDECIDED]} undecided")
    code = next((c for c in (EXIT_CODES[WRONG], UNREADABLE, EXIT_CODES[UNDECIDED]) if c in codes), 0)
    document = plain_document(
        model, lambda: {"name": model.name, "equations": entries}, Lines(tuple(lines)), answer_code=code
    )
    if judge.case.equations is not None:
        document = with_constraints_closed(document, judge.case.equations.system)
    return proven(document, _certificate(judge, found if at is None else ()) if certify else None)


def _certificate(judge: Judge, found: Sequence[Verdict]) -> Certificate:
    """The proof of the equations against which the judge holds others, and of its verdicts by another decision."""
    equations = judge.case.equations
    if equations is None:
        return Certificate(())
    again = [said for verdict in found if (said := judge.said(verdict)) is not None]
    return certificate_of_equations(equations) + verdicts_again(again)


def _judged(
    judge: Judge, each: Answered, at: Any, kind: str | None, hint: int | None, *, alone: bool
) -> tuple[Verdict, dict[str, Any], tuple[str, ...], int]:
    """(the verdict, for machines, for people, exit code) of one equation."""
    try:
        verdict = judge.verdict(each.text, at=at, kind=kind)
    except ExpressionError as error:
        where = f"{each.file}:{each.line}:{error.column + 1}" if each.file else ""
        if alone:
            caret = " " * error.column + "^" * max(1, min(error.length, len(each.text) - error.column))
            raise UsageError(f"{error.what}\n    {each.text}\n    {caret}", where, error.fix) from error
        reported = Verdict(each.text, kind or "", UNDECIDED, reason=f"it cannot be read: {error.what}")
        problem = {"what": error.what, "column": error.column + 1, "fix": error.fix}
        return reported, reported.as_dict() | {"error": problem}, reported.lines(), UNREADABLE
    return verdict, verdict.as_dict(hint), verdict.lines(hint), verdict.exit_code


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
