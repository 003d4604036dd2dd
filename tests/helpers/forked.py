"""The command line in a forked process: with streams, limits and signals of its own, and everything imported already.

POSIX only: files that use it say so by `needs_fork`.
"""

from __future__ import annotations

import importlib
import os
import pkgutil
import signal
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

import eomgen.verbs
from eomgen.cli import main

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="faults are made by fork, signals and limits of POSIX")
needs_sh = pytest.mark.skipif(os.name != "posix", reason="compilers that are shell scripts, modes of files")
LONGEST = 60  # seconds of one process
USED = [f"eomgen.verbs.{each.name}" for each in pkgutil.iter_modules(eomgen.verbs.__path__)]
USED += ["eomgen.documents.figures", "eomgen.documents.latex"]
USED += ["matplotlib.backends.backend_agg", "scipy.integrate", "eomgen.results.at_rest.result"]  # slow to import


@dataclass(frozen=True)
class Ended:
    """How a process ended.

    Args:
        code: its exit code, or minus the signal that ended it.
    """

    code: int
    out: bytes
    err: bytes

    @property
    def said(self) -> str:
        """What stands on stderr; no traceback is ever among it."""
        text = self.err.decode("utf-8", "backslashreplace")
        assert "Traceback" not in text and "Exception ignored" not in text, text
        return text


def forked(
    words: Sequence[str],
    before: Callable[[], object] = lambda: None,
    *,
    closed: Sequence[int] = (),
    streams: dict[int, str] | None = None,
    encoding: str = "utf-8",
) -> Ended:
    """`eomgen WORDS` in a process of its own.

    Args:
        before: done in that process first.
        closed: numbers of the streams that are closed.
        streams: the files that others are.
    """
    for name in USED:
        importlib.import_module(name)
    with tempfile.TemporaryDirectory() as place:
        out, err = Path(place) / "out", Path(place) / "err"
        sys.stdout.flush()
        sys.stderr.flush()
        pid = os.fork()
        if pid == 0:
            _be_child(words, before, {1: str(out), 2: str(err), **(streams or {})}, closed, encoding)
        _, status = os.waitpid(pid, 0)
        said = [path.read_bytes() if path.exists() else b"" for path in (out, err)]
        return Ended(os.waitstatus_to_exitcode(status), *said)


def _be_child(words: Sequence[str], before: Callable[[], object], streams: dict[int, str], closed, encoding) -> None:
    code = 99
    sys.dont_write_bytecode = True  # a limit of the file size would leave half of a module's code for everybody
    try:
        signal.alarm(LONGEST)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        for number, path in streams.items():
            os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT), number)
        for number in closed:
            os.close(number)
        names = {0: "stdin", 1: "stdout", 2: "stderr"}
        for number, name in names.items():
            mode = "r" if number == 0 else "w"
            made = None if number in closed else open(number, mode, encoding=encoding, closefd=False)  # noqa: SIM115
            setattr(sys, name, made)
        before()
        main(list(words))
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 98
    except BaseException:
        import traceback

        os.write(2, traceback.format_exc().encode())
    finally:
        os._exit(code)
