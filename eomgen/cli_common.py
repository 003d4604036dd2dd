"""What every verb of the command line shares: how it is run, how its errors are told, where its result goes.

Results go to stdout, everything else to stderr. Exit codes: 0 ok, 1 the model is wrong, 2 usage,
3 derivation or run failed, 4 an optional tool is missing.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eomgen.errors import EomgenError, ModelError, Problem, ToolMissing
from eomgen.version import SCHEMA_VERSION

if TYPE_CHECKING:
    from eomgen.model.parts import Model
    from eomgen.report.document import Document

INTERRUPTED = 130  # as a shell has it for Ctrl-C
CLOSED_PIPE = 141  # as a shell has it for a reader that went away
LATER = ("verify", "sweep")
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "1")  # numpy's matrices are small here: its threads would wait for one another


class Verbs(click.Group):
    """The group of all verbs: what goes wrong in any of them becomes a message and an exit code."""

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
        wants_json = "--json" in words or "--format json" in " ".join(words).replace("=", " ")
        os.environ.setdefault(*ONE_THREAD)
        try:
            return super().main(words, name, complete_var, standalone_mode=False, **extra) or 0
        except click.ClickException as error:
            error.show()
            return _told(error.exit_code, (Problem("", error.format_message()),), wants_json)
        except EomgenError as error:
            return self._failed(error.exit_code, _problems(error), wants_json)
        except _Placed as error:
            return self._failed(error.exit_code, error.problems, wants_json)
        except ModuleNotFoundError as error:
            if (error.name or "").split(".")[0] == "eomgen":
                raise
            missing = ToolMissing(f"the package '{error.name}' is not installed", mend=f"pip install {error.name}")
            return self._failed(missing.exit_code, _problems(missing), wants_json)
        except (click.Abort, KeyboardInterrupt):
            return INTERRUPTED

    def _failed(self, code: int, problems: tuple[Problem, ...], wants_json: bool) -> int:
        click.echo("\n\n".join(str(problem) for problem in problems), err=True)
        return _told(code, problems, wants_json)


class _Placed(Exception):
    """What went wrong with a model, at its places in the file."""

    def __init__(self, exit_code: int, problems: tuple[Problem, ...]) -> None:
        self.exit_code, self.problems = exit_code, problems


def _unknown_verb(name: str, verbs: list[str]) -> str:
    import difflib

    if name in LATER:
        return f"'{name}' comes with a later version."
    near = difflib.get_close_matches(name, verbs, n=1)
    return f"There is no command '{name}'." + (f" Did you mean '{near[0]}'?" if near else "")


def _problems(error: EomgenError) -> tuple[Problem, ...]:
    if isinstance(error, ModelError):
        return error.problems
    return (Problem(error.where, error.what, mend=error.mend),)


def _told(code: int, problems: tuple[Problem, ...], wants_json: bool) -> int:
    """The problems for machines, where they are asked for."""
    if wants_json:
        error = {"exit_code": code, "problems": [problem.as_dict() for problem in problems]}
        _say(json.dumps({"schema_version": SCHEMA_VERSION, "error": error}, ensure_ascii=False, indent=1) + "\n")
    return code


def _say(text: str) -> None:
    """On stdout; a reader that went away ends the program quietly."""
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what is left in the buffer goes nowhere
        sys.exit(CLOSED_PIPE)


def deliver(document: Document, form: str, output: str | None = None, *, on_stderr: bool = False) -> int:
    """The result in its form to stdout, into a file or beside the messages, these to stderr; the exit code."""
    from eomgen.report import rendered
    from eomgen.verbs.outcome import write_text

    result = rendered(document, form)
    if on_stderr:
        click.echo(result, err=True, nl=False)
    elif output is None:
        _say(result)
    else:
        write_text(output, result)
    for line in (*document.notes, *(f"warning: {each}" for each in document.warnings), document.wrong):
        if line:
            click.echo(line, err=True)
    return 3 if document.wrong else 0


@contextmanager
def reading(path: str) -> Iterator[Model]:
    """The model of a file (- is stdin); what a verb finds wrong with one of its parts is told at its place there."""
    from eomgen.model.reader import load, loads, located

    data = sys.stdin.buffer.read() if path == "-" else None
    try:
        yield load(path) if data is None else loads(data, "<stdin>")
    except EomgenError as error:
        text = data if data is not None else Path(path).read_bytes() if os.access(path, os.R_OK) else b""
        name = path if data is None else "<stdin>"
        problems = tuple(located(problem, text, name) for problem in _problems(error))
        raise _Placed(error.exit_code, problems) from error
