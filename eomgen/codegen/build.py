"""C text -> a library in memory: compiled once, cached by its content in the user's cache."""

from __future__ import annotations

import ctypes
import importlib.util
import math
import os
import platform
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from eomgen import disk_cache
from eomgen.errors import RunFailed, TextRefused, ToolMissing
from eomgen.files import beside
from eomgen.frozen import dataclass
from eomgen.resources import time_left

LONG_TEXT = 150_000  # characters, some 8 000 operations: there -O2 takes several seconds
PATIENCE = 20  # seconds of work: under what a verb has in all, so that numpy still has its time
SHARE = 0.5  # of the time that a user still waits, for one compilation: what runs without it needs the other half
LOOK = 0.1  # seconds between two looks at a compiler at work
IDLE = 20  # seconds in which a compiler that does nothing has stopped; a loaded machine gives each its turn sooner
ENDING = 2.0  # seconds in which what was killed is gone: on a loaded machine it takes its turn
ENDED = "ZX"  # states of processes that have ended and only wait for their exit code to be read
TURN = 0.05  # seconds of work that are something
_GIVEN_UP: dict[str, str] = {}  # what took a compiler too long in this process, and why: nobody waits for it twice
MOST_SAID = 2000  # characters of a compiler
IN_THE_TEXT = re.compile(r"program\.\w+:\d+:\d+")  # a place that a compiler names in the text which it was given


@dataclass(frozen=True)
class Compiler:
    """A compiler, which makes a library of a text.

    Args:
        language: its name in messages.
        suffix: of the text's file.
        variable: of the environment, which names another command line.
        names: of the programs, the first that is there.
        zig: the command of ziglang that can replace it; "" if there is none.
        flags: always; last: after the file.
        once, usual, long: of a text that is called a few times only, so that it is made soonest; of others; of long.
        patience: seconds of work that it may take; the time on a loaded machine is not limited.
        trial: a text of nothing, which it takes where it works at all.
        fix: how to install it.
    """

    language: str
    suffix: str
    variable: str
    names: tuple[str, ...]
    flags: tuple[str, ...]
    fix: str
    zig: str = ""
    last: tuple[str, ...] = ("-lm",)
    once: tuple[str, ...] = ("-O0",)
    usual: tuple[str, ...] = ("-O2",)
    long: tuple[str, ...] = ("-O1",)
    patience: float = PATIENCE
    trial: str = "#include <math.h>\nint eomgen_trial;\n"

    def command(self) -> list[str]:
        """The command line, the environment's choice first.

        Raises:
            ToolMissing: there is none, or the environment's is no command line.
        """
        given = os.environ.get(self.variable, "")
        try:
            chosen = shlex.split(given)
        except ValueError as error:
            raise ToolMissing(
                f"no {self.language} compiler: {self.variable} is {given!r}: {error}",
                fix=f"set {self.variable} to a command line, or to none",
            ) from None
        for words in [chosen] if chosen else [[name] for name in self.names]:
            path = shutil.which(words[0])
            if path:
                return [path, *words[1:]]
        if not chosen and self.zig and importlib.util.find_spec("ziglang"):
            return [sys.executable, "-m", "ziglang", self.zig]
        raise ToolMissing(f"no {self.language} compiler", fix=self.fix)

    def flags_of(self, text: str, quickly: bool) -> tuple[str, ...]:
        """The flags for a text; how far it is optimized the environment's command line may say: CC="cc -O3"."""
        if any(word.startswith("-O") for word in self.command()[1:]):
            return self.flags
        return (*self.flags, *(self.once if quickly else self.usual if len(text) < LONG_TEXT else self.long))


C = Compiler(
    "C",
    ".c",
    "CC",
    ("cc", "gcc", "clang"),
    ("-std=c99", "-shared", "-fPIC"),
    "install cc or `pip install ziglang`, set CC, or take --target numpy",
    zig="cc",
)


_EXTENSIONS = {"avx512f": "-mavx512f", "avx512dq": "-mavx512dq", "avx2": "-mavx2", "fma": "-mfma"}


def functions_in_c(text: str, *names: str) -> tuple[Any, ...]:
    """The functions of a C text by their names, compiled for this machine.

    Raises:
        RunFailed, ToolMissing: as of `library`.
    """
    made = library(text, by=of_this_machine())
    return tuple(function_of(made, name) for name in names)


@cache
def of_this_machine() -> Compiler:
    """The C compiler, with flags for the registers of this machine; every operation is rounded as without them."""
    flags = [flag for name, flag in _EXTENSIONS.items() if name in _processor()]
    return replace(C, flags=(*C.flags, *flags, "-fno-math-errno", "-ffp-contract=off"))


def _processor() -> frozenset[str]:
    """Instruction sets that the processor reports; empty where it reports none."""
    if platform.machine() not in ("x86_64", "AMD64"):
        return frozenset()
    try:
        reported = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return frozenset()
    lines = [line for line in reported.splitlines() if line.startswith("flags")]
    return frozenset(lines[0].split()) if lines else frozenset()


def compiler(of: Compiler = C) -> str | None:
    """Path of a compiler (the environment's, as CC, else cc, gcc, clang, or ziglang's), or None."""
    try:
        return of.command()[0]
    except ToolMissing:
        return None


def library(text: str, *, quickly: bool = False, by: Compiler = C) -> ctypes.CDLL:
    """The text, compiled and loaded.

    Args:
        quickly: it is called a few times only.
    Raises:
        ToolMissing: there is no compiler, or none that starts.
        RunFailed: the compiler does not end, or makes no library; TextRefused: it refuses the text.
    """
    path = _compiled_file(text, by, quickly)
    with suppress(OSError):  # another machine's: made anew below
        return ctypes.CDLL(str(path))
    path.unlink(missing_ok=True)
    path = _compiled_file(text, by, quickly)
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        path.unlink(missing_ok=True)
        raise RunFailed(
            f"the {by.language} compiler makes no library: {error}",
            shlex.join(by.command()),
            fix="take --target numpy, or another compiler: CC",
        ) from None


def binary(text: str, by: Compiler) -> bytes:
    """Bytes of the library that the compiler makes of a text.

    Raises:
        ToolMissing, RunFailed: as of `library`.
    """
    return _compiled_file(text, by, quickly=False).read_bytes()


def _compiled_file(text: str, by: Compiler, quickly: bool) -> Path:
    """Library that the compiler makes of a text, as a file in the cache."""
    command, flags = by.command(), by.flags_of(text, quickly)
    key = "\0".join((text, *command, *flags, platform.platform(), platform.machine()))
    folder, name = disk_cache.cache_place(), disk_cache.digest(key.encode())
    for path, _ in disk_cache.contents(folder, name, ".so"):  # half a file kills at load
        disk_cache.used(path)
        return path
    if name in _GIVEN_UP:
        raise RunFailed(_GIVEN_UP[name], command[0], fix="take --target numpy, or another compiler: CC")
    return _compile(text, [*command, *flags], folder, name, by)


def function_of(made: ctypes.CDLL, name: str, by: Compiler = C) -> Any:
    """A function of a library.

    Raises:
        RunFailed: it is not in it.
    """
    try:
        return getattr(made, name)
    except AttributeError:
        raise RunFailed(
            f"the {by.language} compiler makes a library without the function '{name}'",
            by.command()[0],
            fix="take --target numpy, or another compiler: CC",
        ) from None


def _compile(text: str, command: list[str], folder: Path, name: str, by: Compiler) -> Path:
    """Compile next to the target and rename: another process sees all of the library or nothing."""
    try:
        with beside(folder) as place:
            source, made = place / f"program{by.suffix}", place / "program.so"
            source.write_text(text, encoding="utf-8")
            try:
                code, said = _ran([*command, "-o", str(made), str(source), *by.last], by, place)
            except TimeoutError as late:
                _GIVEN_UP[name] = f"the {by.language} compiler {late}"
                raise RunFailed(
                    _GIVEN_UP[name], command[0], fix="take --target numpy, or another compiler: CC"
                ) from None
            if code != 0 or not made.is_file():
                reported = f"the {by.language} compiler failed: {said or f'it ended with {code}, and made nothing'}"
                refused = IN_THE_TEXT.search(said) and text != by.trial and _works(by)
                raise (TextRefused if refused else RunFailed)(reported, command[0])
            return disk_cache.put_whole(made, folder, name)
    except OSError as error:
        raise ToolMissing(
            f"nothing can be compiled: {error}", command[0], fix="take --target numpy, or another compiler: CC"
        ) from None


def _works(by: Compiler) -> bool:
    """True if the compiler makes a library of a trivial text."""
    try:
        return bool(_compiled_file(by.trial, by, quickly=True))
    except (RunFailed, ToolMissing):
        return False


def _ran(command: list[str], by: Compiler, place: Path) -> tuple[int, str]:
    """(exit code, output) of a compiler; it and all that it has started end with this call.

    Raises:
        TimeoutError: it works too long, does nothing, or takes more than its share of what a user waits.
    """
    started = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        start_new_session=True,
        cwd=place,  # where modules are left
        env=os.environ | dict.fromkeys(("TMPDIR", "TMP", "TEMP"), str(place)),  # a full folder elsewhere is no matter
    )
    try:
        said = _awaited(started, by)
        return started.returncode, said.strip()[:MOST_SAID]
    finally:
        _end(started)


def _awaited(started: subprocess.Popen[str], by: Compiler) -> str:
    """Output of a compiler until it ends.

    Raises:
        TimeoutError: the reason why it was given up.
    """
    left, begun = time_left(), time.monotonic()
    at_most = math.inf if left is None else SHARE * left
    worked, since = 0.0, begun
    while True:
        try:
            return started.communicate(timeout=LOOK)[1]
        except subprocess.TimeoutExpired:
            now = time.monotonic()
        work = _work_of(started.pid)
        if work is None:  # not reported by the system: the time on the clock stands for it
            work = now - begun
        if work >= worked + TURN:
            worked, since = work, now
        if work > by.patience:
            raise TimeoutError(f"did not come back within {by.patience:g} s of its own work")
        if now - since > min(IDLE, by.patience):
            raise TimeoutError(f"did not come back: it did nothing for {min(IDLE, by.patience):g} s")
        if now - begun > at_most:
            raise TimeoutError(f"did not come back within {at_most:.3g} s, half of the time to wait (--patience)")


def _work_of(session: int) -> float | None:
    """CPU seconds of all processes of a session, ended ones included; None where the system does not report them."""
    ticks = [sum(map(int, fields[11:15])) for fields in _stats_of(session)]
    return sum(ticks) / os.sysconf("SC_CLK_TCK") if ticks else None


def _end(started: subprocess.Popen[str]) -> None:
    """Kill a process with all that it started, though it has ended itself; they are gone then (on Windows it alone)."""
    left = False
    with suppress(OSError):  # there is nothing left of it
        if hasattr(os, "killpg"):
            os.killpg(started.pid, signal.SIGKILL)
        else:
            started.kill()
        left = True
    started.wait()
    if started.stderr is not None:
        started.stderr.close()
    given_up = time.monotonic() + ENDING
    while left and _is_running(started.pid) and time.monotonic() < given_up:
        time.sleep(LOOK / 100)


def _is_running(session: int) -> bool:
    """True if a process of a session has not ended, as far as the system reports it."""
    return any(fields[0] not in ENDED for fields in _stats_of(session))


def _stats_of(session: int) -> Iterator[list[str]]:
    """Fields that the system reports of each process of a session, from its state on; none where it reports nothing."""
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError, IndexError):
            fields = stat.read_text().rpartition(")")[2].split()
            if fields[3] == str(session):
                yield fields
