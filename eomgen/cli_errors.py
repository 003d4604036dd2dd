"""The outermost layer of the command line: whatever leaves a verb becomes a sentence and an exit code.

It is written on streams of any kind.

Exit codes: 0 ok, 1 the model is wrong, 2 usage, 3 derivation or run failed, 4 an optional tool is missing, 70 an
internal error, 74 a failed write, 130 interrupted; 141 where the reader of stdout went away.
"""

from __future__ import annotations

import errno
import json
import os
import platform
import signal
import sys
import tempfile
import traceback
import unicodedata
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

import click

from eomgen.errors import EomgenError, ModelError, Problem, ToolMissing, WriteFailed, visible
from eomgen.symbolic.expression import spelled
from eomgen.version import SCHEMA_VERSION, __version__

MEMORY, INTERNAL, INTERRUPTED, CLOSED_PIPE = 3, 70, 130, 141
NO_ROOM = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EIO}
ENDING = ("SIGTERM", "SIGHUP", "SIGBREAK")  # those of them that this system has end a run as Ctrl-C does
LONGEST = 300  # characters of an unexpected error in its sentence
IN_ASCII = {
    **{"δ": "d", "·": "*", "×": "x", "−": "-", "–": "-", "—": "-", "…": "...", "→": "->", "≤": "<=", "≥": ">="},
    **{"≠": "!=", "≈": "~", "√": "sqrt", "∞": "inf", "∂": "d", "°": " deg", "′": "'", "″": "''", "⋅": "*", "±": "+-"},
    **{"²": "^2", "³": "^3", "½": "1/2", "¼": "1/4", "ᵀ": "^T"},
}


class Placed(Exception):
    """Problems of a model, each at its place in the file."""

    def __init__(self, exit_code: int, problems: tuple[Problem, ...]) -> None:
        self.exit_code, self.problems = exit_code, problems


class ReaderGone(Exception):
    """The reader of stdout is gone. It is no BrokenPipeError, which click would handle itself."""


def guarded(verb: Callable[[], int], words: Sequence[str]) -> int:
    """The exit code of a verb; what went wrong in it is reported, with --json as JSON too."""
    wants_json = "--json" in words or "--format json" in " ".join(words).replace("=", " ")
    with _streams(), _signals(), warnings.catch_warnings():
        if not sys.warnoptions:
            warnings.simplefilter("ignore")  # of libraries, to their callers: what a user is to know, verbs say
        try:
            return _reported(*_outcome(verb, words), wants_json)
        except ReaderGone:
            return CLOSED_PIPE
        except WriteFailed as error:
            say(str(error))
            return error.exit_code
        except KeyboardInterrupt:
            return INTERRUPTED


def problems_of(error: EomgenError) -> tuple[Problem, ...]:
    """The problems that an error carries, one by one."""
    if isinstance(error, ModelError):
        return error.problems
    return (Problem(error.where, error.what, fix=error.fix),)


def failure(code: int, problems: Sequence[Problem]) -> str:
    """The problems of a failed verb as JSON."""
    error = {"exit_code": code, "problems": [problem.as_dict() for problem in problems]}
    return json.dumps({"schema_version": SCHEMA_VERSION, "error": error}, indent=1) + "\n"


def say(line: str) -> None:
    """Writes a line to stderr."""
    sys.stderr.write(f"{line}\n")


def in_ascii(character: str) -> str:
    """The ASCII spelling of a character, for streams that can show no others: dtheta for δθ."""
    if character in IN_ASCII:
        return IN_ASCII[character]
    if greek := spelled(character):
        return greek
    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return plain or json.dumps(character)[1:-1]


def _outcome(verb: Callable[[], int], words: Sequence[str]) -> tuple[int, tuple[Problem, ...], str]:
    """(exit code, what went wrong, as people read it) of a verb."""
    try:
        return verb() or 0, (), ""
    except click.ClickException as error:
        error.show(sys.stderr)
        return error.exit_code, (Problem("", error.format_message()),), ""
    except (Placed, EomgenError) as error:
        found = error.problems if isinstance(error, Placed) else problems_of(error)
        code = error.exit_code
    except (click.Abort, KeyboardInterrupt) as error:
        if isinstance(error.__cause__, EOFError):  # click takes a file that ends too early for somebody's Ctrl-D
            return _internal(error.__cause__, words)
        kept = str(error.__cause__ or error) or "nothing is kept"
        code, found = INTERRUPTED, (Problem("", f"interrupted, {kept}"),)
    except ReaderGone:
        raise
    except MemoryError:
        code, found = MEMORY, (Problem("", "there is not enough memory for that", fix="ask for less"),)
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] == "eomgen":
            return _internal(error, words)
        missing = ToolMissing(f"the package '{error.name}' is not installed", fix=f"pip install {error.name}")
        code, found = missing.exit_code, problems_of(missing)
    except OSError as error:
        if error.errno not in NO_ROOM:
            return _internal(error, words)
        code, found = (
            WriteFailed.exit_code,
            (Problem(str(error.filename or ""), f"cannot be written: {error.strerror}"),),
        )
    except Exception as error:  # the one place where whatever is left is reported as what it is: a mistake of ours
        return _internal(error, words)
    return code, found, "\n\n".join(map(str, found))


def _internal(error: Exception, words: Sequence[str]) -> tuple[int, tuple[Problem, ...], str]:
    """An internal error as (exit code, problem, text); its report is written to a file that the user can send."""
    what = f"internal error: {type(error).__name__}: {error}".splitlines()[0][:LONGEST]
    trace = "".join(traceback.format_exception(error))
    about = f"eomgen {__version__}, Python {platform.python_version()}, {platform.platform()}"
    fix = "this is a mistake of eomgen, not of your model; "
    try:
        handle, path = tempfile.mkstemp(prefix="eomgen-report-", suffix=".txt")
        with open(handle, "w", encoding="utf-8", errors="backslashreplace") as file:
            file.write(f"{about}\neomgen {' '.join(words)}\n\n{trace}")
        fix += f"please send the report {path} and the model file"
    except OSError as full:
        fix += f"its report cannot be written ({full.strerror}), it is: {trace}"
    problem = Problem("", what, fix=fix)
    return INTERNAL, (problem,), str(problem)


def _reported(code: int, problems: tuple[Problem, ...], text: str, wants_json: bool) -> int:
    """Writes the problems to stderr, and to stdout too where JSON is requested; returns the exit code."""
    if text:
        say(text)
    if problems and wants_json:
        sys.stdout.write(failure(code, problems))
    return code


class _Shown:
    """A text stream that writes at once, escapes invisible characters and replaces those that its encoding lacks.

    Raises:
        WriteFailed: it is closed or full (only where it is needed; what cannot be said on stderr is left out).
        ReaderGone: its reader went away, likewise.
    """

    encoding, errors = "utf-8", "strict"  # what it takes, not what is below

    def __init__(self, stream: Any, name: str, needed: bool) -> None:
        self._stream, self._name, self._needed = stream, name, needed

    def write(self, text: str) -> int:
        if not isinstance(text, str):
            raise TypeError(f"a text is written, not {type(text).__name__}")
        try:
            if self._stream is None:
                raise OSError(errno.EBADF, "it is closed")
            self._stream.write(self._letters(visible(text)))
            self._stream.flush()
        except (OSError, ValueError) as error:
            self._give_up()
            if isinstance(error, BrokenPipeError) and self._needed:
                raise ReaderGone from None
            if text and self._needed:
                why = getattr(error, "strerror", None) or error
                raise WriteFailed(f"{self._name} cannot be written: {why}") from None
        return len(text)

    def flush(self) -> None:
        """Does nothing: everything is written already."""

    def isatty(self) -> bool:
        """True if the stream is a terminal."""
        return self._stream is not None and self._stream.isatty()

    def _letters(self, text: str) -> str:
        below = self._stream.encoding or "utf-8"
        lacking = {c for c in set(text) if not c.isascii() and c.encode(below, "ignore") == b""}
        return text.translate({ord(c): in_ascii(c) for c in lacking})

    def _give_up(self) -> None:
        """Sends what is left in the stream's buffer to the null device, so that the end of the process cannot fail."""
        with suppress(OSError, ValueError, AttributeError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), self._stream.fileno())

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def _streams() -> Iterator[None]:
    """Replaces stdout and stderr by `_Shown`; closed ones become the null device, so that no file gets their number."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free
    before = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = _Shown(sys.stdout, "stdout", True), _Shown(sys.stderr, "stderr", False)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before


@contextmanager
def _signals() -> Iterator[None]:
    """Handles TERM and similar signals like Ctrl-C; ignored ones stay ignored. In a thread nothing is changed."""

    def interrupted(number: int, frame: Any) -> None:
        raise KeyboardInterrupt

    before = {}
    with suppress(ValueError):
        for each in (getattr(signal, name) for name in ENDING if hasattr(signal, name)):
            if signal.getsignal(each) is signal.SIG_DFL:
                before[each] = signal.signal(each, interrupted)
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
