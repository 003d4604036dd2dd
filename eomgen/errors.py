"""Errors that a user can act on: what is wrong, where, and how to fix it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import Any

from eomgen.frozen import dataclass

HIDDEN = re.compile(  # controls, marks that turn the direction of writing, what has no width, halves of characters
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\xad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e007f]"
)


def visible(text: str) -> str:
    """The text, characters that steer a terminal or turn its direction as \\u001b: a JSON text remains one."""
    return HIDDEN.sub(lambda found: json.dumps(found[0])[1:-1].replace("\x7f", "\\u007f"), text)


class EomgenError(Exception):
    """A failure that a person can act on.

    Args:
        what: what is wrong, the culprit printed.
        where: a path that the user can open or a part of the model ("" when there is none).
        fix: what to do about it ("" when nothing is known).
    """

    exit_code = 3

    def __init__(self, what: str, where: str = "", fix: str = "") -> None:
        self.what, self.where, self.fix = what, where, fix
        super().__init__(self.__str__())

    def __str__(self) -> str:
        head = f"{self.where}: {self.what}" if self.where else self.what
        return visible(f"{head}\nfix: {self.fix}" if self.fix else head)


@dataclass(frozen=True)
class Problem:
    """One thing wrong with a model.

    Args:
        where: "file:line:column", or the path of the part ("bodies.arm.joint.on") for a model made in Python.
        what: what is wrong, the culprit printed.
        excerpt: the source line and the caret line below it, or "".
        fix: the nearest right thing, or "".
    """

    where: str
    what: str
    excerpt: str = ""
    fix: str = ""

    def __str__(self) -> str:
        lines = [f"{self.where}: {self.what}" if self.where else self.what]
        if self.excerpt:
            lines.append(self.excerpt)
        if self.fix:
            lines.append(f"fix: {self.fix}")
        return visible("\n".join(lines))

    def as_dict(self) -> dict[str, str | int | None]:
        """The problem as a JSON object; its place also as file, line and column where it has them."""
        file, line, column = (*self.where.rsplit(":", 2), "", "")[:3]
        placed = line.isdigit() and column.isdigit()
        return {
            "where": self.where,
            "file": file if placed else None,
            "line": int(line) if placed else None,
            "column": int(column) if placed else None,
            "what": self.what,
            "excerpt": self.excerpt,
            "fix": self.fix,
        }


class ModelError(EomgenError):
    """The model is wrong. Carries every problem that was found, not just the first."""

    exit_code = 1

    def __init__(self, problems: tuple[Problem, ...] | str, where: str = "", fix: str = "") -> None:
        if isinstance(problems, str):
            problems = (Problem(where, problems, fix=fix),)
        self.problems = tuple(problems)
        super().__init__(self.problems[0].what, self.problems[0].where, self.problems[0].fix)

    def __str__(self) -> str:
        return "\n\n".join(str(problem) for problem in self.problems)


class MissingValues(ModelError):
    """Numbers are needed of parameters that have none; names them all."""

    def __init__(self, names: tuple[str, ...], where: str = "") -> None:
        self.names = tuple(names)
        listed = ", ".join(f"'{name}'" for name in self.names)
        fix = "give it a value in [parameters]"
        each = (Problem(where or f"parameters.{x}", f"no value for parameter '{x}'", fix=fix) for x in self.names)
        super().__init__(tuple(each))
        if len(self.names) > 1:
            self.what, self.fix = f"no value for parameters {listed}", "give them values in [parameters]"


class ExpressionError(EomgenError):
    """A text that is not an expression of the grammar; `column` counts from 0 within the text."""

    exit_code = 1

    def __init__(self, what: str, column: int = 0, fix: str = "", length: int = 1) -> None:
        self.column, self.length = column, length
        super().__init__(what, "", fix)


class NumberBeyond(ExpressionError):
    """A number that the grammar does not take: too many digits, too large."""


class UsageError(EomgenError):
    """The command was called wrongly."""

    exit_code = 2


class DerivationError(EomgenError):
    """The equations could not be derived, or a result does not follow from them."""


class OpenConstraints(DerivationError):
    """Constraints that no configuration near the start satisfies.

    Args:
        nearest: the smallest distance from being satisfied that a search finds, in words; it runs when first read.
    """

    def __init__(self, what: str, where: str = "", fix: str = "", nearest: Callable[[], str] = str) -> None:
        self._said: str = what
        self._nearest: Callable[[], str] = str
        super().__init__(what, where, fix)
        self._nearest = nearest

    @property
    def what(self) -> str:
        """The description of what is wrong, and how near the constraints come to being satisfied."""
        self._said, self._nearest = self._said + self._nearest(), str
        return self._said

    @what.setter
    def what(self, said: str) -> None:
        self._said = said

    def __reduce__(self) -> tuple[Any, ...]:
        return OpenConstraints, (self.what, self.where, self.fix)


class NotYet(DerivationError):
    """A kind that the model file knows and this version cannot derive yet."""


class RunFailed(EomgenError):
    """A simulation or an emitted program failed."""


class TextRefused(RunFailed):
    """A compiler refuses a text that we wrote, and takes another: the text is wrong."""


class WriteFailed(EomgenError):
    """A result could not be written: a disk that is full, a stream that is closed, a folder of somebody else."""

    exit_code = 74  # as sysexits.h has it for input and output


class ToolMissing(EomgenError):
    """An optional tool (a compiler, say) is not on this machine."""

    exit_code = 4
