"""Common parts of all verbs of the command line: how a verb is run, where its model is read and its result written.

Results go to stdout, everything else to stderr.
"""

from __future__ import annotations

import errno
import json
import os
import platform
import signal
import sys
import tempfile
import threading
import traceback
import unicodedata
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eomgen import files
from eomgen.cli_options import form_requested, proven_in_full
from eomgen.errors import (
    DerivationError,
    EomgenError,
    ModelError,
    OpenConstraints,
    Problem,
    RunFailed,
    ToolMissing,
    UsageError,
    WriteFailed,
    visible,
)
from eomgen.frozen import dataclass
from eomgen.resources import doing, growing, patience, seldom
from eomgen.symbolic.expression import other_words, spelled
from eomgen.version import SCHEMA_VERSION, __version__

if TYPE_CHECKING:
    from eomgen.documents import Document, Result
    from eomgen.model import Model


# -------- errors -----------------------------------------------------------------------------------------------
# The outermost layer of the command line: whatever leaves a verb becomes a sentence and an exit code.
#
# It is written on streams of any kind.
#
# Exit codes: 0 ok, 1 the model is wrong, 2 usage, 3 derivation or run failed, 4 an optional tool is missing, 70 an
# internal error, 74 a failed write, 130 interrupted; 141 where the reader of stdout went away.

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


ONE_THREAD = ("OPENBLAS_NUM_THREADS", "1")  # numpy's matrices are small here: its threads would wait for one another


class Verb(click.Command):
    """One verb; where it works on a file, only as long as a user waits."""

    def __init__(self, *given: Any, **options: Any) -> None:
        super().__init__(*given, **options)
        if any(isinstance(each, click.Argument) and isinstance(each.type, click.Path) for each in self.params):
            self.params.append(_patience_option())

    def invoke(self, ctx: click.Context) -> Any:
        with patience(ctx.params.pop("patience", None)), doing(f"`{self.name}`"):
            return super().invoke(ctx)


class Lasting(Verb):
    """A verb that works until somebody ends it: what it does one after the other has a time limit, not the whole."""

    def invoke(self, ctx: click.Context) -> Any:
        return click.Command.invoke(self, ctx)


def _patience_option() -> click.Option:
    return click.Option(
        ["--patience"],
        metavar="SECONDS",
        default="30",
        show_default=True,
        envvar="EOMGEN_PATIENCE",
        callback=_seconds,
        help="Time limit in seconds; none: as long as it takes.",
    )


def _seconds(context: click.Context, option: click.Parameter, text: str) -> float | None:
    """The seconds of --patience; None for none.

    Raises:
        UsageError: it is no positive number.
    """
    if text == "none":
        return None
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not 0 < seconds < threading.TIMEOUT_MAX:
        raise click.UsageError(f"--patience {text}: a positive number of seconds is needed, or none")
    return seconds


class Verbs(click.Group):
    """The group of all verbs: what goes wrong in any of them becomes a message and an exit code."""

    command_class = Verb

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        name = args[0]
        if not name.startswith("-") and self.get_command(ctx, name) is None:
            raise click.UsageError(_unknown_verb(name, self.list_commands(ctx)), ctx)
        return super().resolve_command(ctx, args)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)  # in the order in which they are used

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        **extra: Any,
    ) -> Any:
        words = list(sys.argv[1:] if args is None else args)
        name = prog_name or "eomgen"
        if not standalone_mode:
            return super().main(words, name, complete_var, standalone_mode=False, **extra)
        sys.exit(self._run(words, name, complete_var, extra))

    def _run(self, words: list[str], name: str, complete_var: str | None, extra: dict[str, Any]) -> int:
        os.environ.setdefault(*ONE_THREAD)
        run = super().main
        with seldom():
            return guarded(lambda: run(words, name, complete_var, standalone_mode=False, **extra) or 0, words)


def _unknown_verb(name: str, verbs: list[str]) -> str:
    import difflib

    near = other_words(name, verbs) or difflib.get_close_matches(name, verbs, n=1)
    return f"There is no command '{name}'." + (f" Did you mean '{near[0]}'?" if near else "")


@dataclass(frozen=True)
class Source:
    """A model, and the text that it was read from."""

    model: Model
    data: bytes
    name: str

    def warned(self, document: Document, model: Model) -> Document:
        """The document of a model made of it; cautions about the model get their place in the text."""
        from eomgen.model import located, warned

        own = tuple(located(problem, self.data, self.name) for problem in document.cautions)
        return replace(document, cautions=(*warned(model, self.data, self.name), *own))


@dataclass(frozen=True)
class Delivery:
    """The result of a verb, as it is written.

    Args:
        text: its result in the requested form.
        lines: messages, written to stderr.
        code: the exit code.
    """

    text: str
    lines: tuple[str, ...]
    code: int

    def deliver(self, output: str | None = None, *, on_stderr: bool = False) -> int:
        """Writes the result to stdout or into a file, and the messages to stderr; returns the exit code.

        The result too goes to stderr where `on_stderr` is set.
        """
        if on_stderr:
            sys.stderr.write(self.text)
        else:
            put(self.text, output)
        for line in self.lines:
            say(line)
        return self.code


def delivery_of(document: Document, form: str, *, strict: bool = False) -> Delivery:
    """The text, messages and exit code of a document.

    Args:
        strict: warnings end in exit 1.
    """
    from eomgen.documents import proven_as, rendered

    document = replace(proven_as(document, form), proven_in_full=proven_in_full())
    taken = [f"taken: {each}" for each in document.taken]
    lines = (*taken, *document.notes, *(f"warning: {each}" for each in document.warnings), document.wrong)
    return Delivery(rendered(document, form), tuple(filter(None, lines)), _code(document, strict))


def deliver(
    document: Document, form: str, output: str | None = None, *, on_stderr: bool = False, strict: bool = False
) -> int:
    """Writes the result in its form to stdout or into a file, and the messages to stderr; returns the exit code."""
    return delivery_of(document, form, strict=strict).deliver(output, on_stderr=on_stderr)


def _code(document: Document, strict: bool) -> int:
    failed = INTERRUPTED if document.interrupted else 3 if document.wrong else document.answer_code
    return failed or int(strict and bool(document.warnings))


def deliver_several(
    paths: Sequence[str],
    made: Callable[[Source], Document],
    form: str,
    output: str | None = None,
    *,
    strict: bool = False,
) -> int:
    """Writes the results of several models one after the other, in JSON as a list; returns the largest exit code.

    The problems of a wrong model are reported, and the next one follows.
    """
    from eomgen.documents import proven_as, rendered

    code, results = 0, []
    for path in paths:
        try:
            with reading(path) as declared:
                document = replace(proven_as(made(declared), form), proven_in_full=proven_in_full())
            results.append(rendered(document, form))
            code = max(code, _code(document, strict))
            for problem in document.warnings:
                say(f"warning: {problem}")
        except Placed as error:
            say("\n\n".join(map(str, error.problems)) + "\n")
            code = max(code, error.exit_code)
            if form == "json":
                results.append(failure(error.exit_code, error.problems))
    if form == "json":
        models = [{"path": path, **json.loads(each)} for path, each in zip(paths, results, strict=True)]
        results = [files.json_text({"schema_version": SCHEMA_VERSION, "models": models}, indent=1) + "\n"]
    put("\n".join(results), output)
    return code


def put(text: str, output: str | None = None) -> None:
    """Writes a text into a file, or to stdout."""
    if output is not None:
        files.write(output, text)
    else:
        sys.stdout.write(text)


@contextmanager
def reading(path: str) -> Iterator[Source]:
    """The model of a file (- is stdin); what a verb finds wrong with one of its parts is reported at its place."""
    from eomgen.model import bytes_at, loads, located
    from eomgen.proof import numbers_otherwise

    if path == "-" and sys.stdin is None:
        raise UsageError("there is no model on stdin: it is closed", fix="name a file")
    data = bytes_at(path)
    name, title = ("<stdin>", "model") if path == "-" else (path, Path(path).stem)
    try:
        model = loads(data, name, title)
        if wrong := numbers_otherwise(data, model):
            raise DerivationError(wrong, fix="this is a mistake of eomgen, not of your model")
        yield Source(model, data, name)
    except EomgenError as error:  # the edge: whatever is wrong is reported at its place in the file
        of_model = isinstance(error, (ModelError, DerivationError, RunFailed))  # no option, file or tool
        problems = tuple(located(problem, data, name, by_name=of_model) for problem in problems_of(error))
        raise Placed(error.exit_code, problems) from error


def _followed(declared: Model, follow: tuple[str, ...]) -> Model:
    """The model, coordinates and inputs through the samples of files."""
    from eomgen.model import Requests

    return Requests(declared).following(follow) if follow else declared


def write_requested(
    made: Callable[..., Document],
    *,
    model: str,
    wants_json: bool,
    output: str | None,
    format_: str | None,
    follow: tuple[str, ...] = (),
    strict: bool = False,
    **options: Any,
) -> int:
    """The document of a verb, in the requested form."""
    form = form_requested(wants_json, format_, output)
    with reading(model) as source:
        document = requested_document(made, source, options, follow)
    return deliver(document, form, output, strict=strict)


def requested_document(
    made: Callable[..., Document],
    source: Source,
    options: dict[str, Any],
    follow: tuple[str, ...] = (),
    **more: Any,
) -> Document:
    """The document of a verb for what was typed, in the units of the file; what was taken, and warnings, are in it."""
    from eomgen.verbs import typed

    valued, rest = typed(_followed(source.model, follow), options)
    try:
        document = made(valued.model, **rest, **more)
    except OpenConstraints as error:
        from eomgen.documents import named_open

        raise named_open(valued.model, error) from error
    document = replace(document, taken=(*valued.taken, *document.taken))
    return source.warned(document, valued.model)


def write_result(
    found: Callable[..., Result], *, certify: bool, plot: str | None = None, at_start: bool = False, **options: Any
) -> int:
    """Writes the result of a verb, at the start or elsewhere, with its plot and its proof where these are requested."""
    from eomgen.documents import shown, with_start_reported

    def made(declared: Model, **requested: Any) -> Document:
        with growing():
            document = shown(found(declared, **requested), plot=plot, certify=certify)
        with_start = with_start_reported(document, declared)
        return with_start if at_start else replace(document, cautions=with_start.cautions)

    return write_requested(made, **options)
