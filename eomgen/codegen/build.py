"""C text -> a library in memory: compiled once, kept by its content in the user's cache."""

from __future__ import annotations

import atexit
import ctypes
import functools
import hashlib
import importlib.util
import os
import platform
import shlex
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import platformdirs

from eomgen.errors import RunFailed, ToolMissing
from eomgen.files import beside

LONG_TEXT = 150_000  # characters, some 8 000 operations: there -O2 takes several seconds
PATIENCE = 20  # seconds: under what a verb has in all, so that numpy still has its time
MOST_SAID = 2000  # characters of a compiler
MOST_KEPT, LARGEST, OLDEST = 1000, 2**28, 90 * 86_400.0  # libraries; bytes together; seconds since the last use


@dataclass(frozen=True)
class Compiler:
    """What makes a library of a text.

    Args:
        language: as it is told.
        suffix: of the text's file.
        variable: of the environment, which names another command line.
        names: of the programs, the first that is there.
        zig: as which ziglang stands in; "" where it cannot.
        flags: always; last: after the file.
        once, usual, long: of a text that is called a few times only, so that it is made soonest; of others; of long.
        mend: where it comes from.
    """

    language: str
    suffix: str
    variable: str
    names: tuple[str, ...]
    flags: tuple[str, ...]
    mend: str
    zig: str = ""
    last: tuple[str, ...] = ("-lm",)
    once: tuple[str, ...] = ("-O0",)
    usual: tuple[str, ...] = ("-O2",)
    long: tuple[str, ...] = ("-O1",)

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
                mend=f"set {self.variable} to a command line, or to none",
            ) from None
        for words in [chosen] if chosen else [[name] for name in self.names]:
            path = shutil.which(words[0])
            if path:
                return [path, *words[1:]]
        if not chosen and self.zig and importlib.util.find_spec("ziglang"):
            return [sys.executable, "-m", "ziglang", self.zig]
        raise ToolMissing(f"no {self.language} compiler", mend=self.mend)

    def flags_of(self, text: str, quickly: bool) -> tuple[str, ...]:
        """The flags for a text."""
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
        RunFailed: the compiler refuses the text, does not come back, or makes what is no library.
    """
    command, flags = by.command(), by.flags_of(text, quickly)
    key = "\0".join((text, *command, *flags, platform.platform(), platform.machine()))
    folder, name = _cache(), _digest(key.encode())
    for path in folder.glob(f"{name}-*.so"):
        if _is_whole(path):
            with suppress(OSError):  # another machine's: made anew below
                found = ctypes.CDLL(str(path))
                os.utime(path)
                return found
    path = _compile(text, [*command, *flags], folder, name, by)
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        path.unlink(missing_ok=True)
        raise RunFailed(f"the {by.language} compiler makes no library: {error}", shlex.join(command)) from None


def function_of(made: ctypes.CDLL, name: str, by: Compiler = C) -> Any:
    """A function of a library.

    Raises:
        RunFailed: it is not in it.
    """
    try:
        return getattr(made, name)
    except AttributeError:
        raise RunFailed(
            f"the {by.language} compiler makes a library without the function '{name}'", by.command()[0]
        ) from None


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:32]


def _is_whole(path: Path) -> bool:
    """Whether a file is what its name says, NAME-DIGEST.so, and nobody else can write it; half a file kills at load."""
    try:
        return _is_ours(path) and not _others_write(path) and path.name == _named(path.name[:32], path)
    except OSError:
        return False


def _named(name: str, path: Path) -> str:
    """NAME-DIGEST.so; the digest is of both name and content."""
    return f"{name}-{_digest(name.encode() + path.read_bytes())}.so"


def _is_ours(path: Path) -> bool:
    """Whether a file or folder belongs to this user; on Windows what is below the user's folder does."""
    return not hasattr(os, "getuid") or path.stat().st_uid == os.getuid()


def _others_write(path: Path) -> bool:
    return hasattr(os, "getuid") and bool(path.stat().st_mode & (stat.S_IWGRP | stat.S_IWOTH))


def _compile(text: str, command: list[str], folder: Path, name: str, by: Compiler) -> Path:
    """Compile beside the target and rename: another process sees all of the library or nothing."""
    try:
        with beside(folder) as place:
            source, made = place / f"program{by.suffix}", place / "program.so"
            source.write_text(text, encoding="utf-8")
            code, said = _ran([*command, "-o", str(made), str(source), *by.last], by.language, place)
            if code != 0 or not made.is_file():
                raise RunFailed(
                    f"the {by.language} compiler failed: {said or f'it ended with {code}, and made nothing'}",
                    command[0],
                )
            made.chmod(0o700)  # whatever the umask
            path = folder / _named(name, made)
            os.replace(made, path)
            _let_go(folder, path)
            return path
    except OSError as error:
        raise ToolMissing(f"nothing can be compiled: {error}", command[0]) from None


def _ran(command: list[str], language: str, place: Path) -> tuple[int, str]:
    """(the exit code, what it said) of a compiler; it and all that it has started end with this call.

    Raises:
        RunFailed: it does not come back.
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
    )
    try:
        said = started.communicate(timeout=PATIENCE)[1]
        return started.returncode, said.strip()[:MOST_SAID]
    except subprocess.TimeoutExpired:
        raise RunFailed(f"the {language} compiler did not come back within {PATIENCE} s", command[0]) from None
    finally:
        if started.poll() is None:
            _end(started)


def _end(started: subprocess.Popen[str]) -> None:
    """Kill a process with its children (on Windows without these)."""
    with suppress(OSError):
        if hasattr(os, "killpg"):
            os.killpg(started.pid, signal.SIGKILL)
        else:
            started.kill()
    started.wait()
    if started.stderr is not None:
        started.stderr.close()


def _let_go(folder: Path, new: Path) -> None:
    """Takes away the libraries that nobody has used for long, and the oldest where there are too many or too large."""
    with suppress(OSError):  # another process does the same
        found = sorted(((path.stat(), path) for path in folder.glob("*.so")), key=lambda each: -each[0].st_mtime)
        size = 0
        for kept, (about, path) in enumerate(found):
            size += about.st_size
            if path != new and (kept >= MOST_KEPT or size > LARGEST or time.time() - about.st_mtime > OLDEST):
                path.unlink()


def cache_folder() -> Path | None:
    """Where compiled code is kept; None for a user without a home."""
    try:
        place = Path(platformdirs.user_cache_dir("eomgen"))
    except RuntimeError:
        return None
    return place if place.is_absolute() else None


def _cache() -> Path:
    """The user's cache folder, closed to others; one of this process where that is another's or not writable."""
    place = cache_folder()
    if place is None:
        return _own_folder()
    try:
        place.mkdir(parents=True, exist_ok=True, mode=0o700)
        if not _is_ours(place):
            return _own_folder()
        if _others_write(place):
            place.chmod(0o700)  # what others have put there meanwhile is theirs, and not loaded
        with tempfile.TemporaryFile(dir=place):
            return place
    except OSError:
        return _own_folder()


@functools.cache
def _own_folder() -> Path:
    place = tempfile.mkdtemp(prefix="eomgen-")
    atexit.register(shutil.rmtree, place, ignore_errors=True)
    return Path(place)
