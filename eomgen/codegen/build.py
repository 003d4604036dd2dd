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
import subprocess
import sys
import tempfile
from pathlib import Path

import platformdirs

from eomgen.errors import RunFailed, ToolMissing

FLAGS = ("-std=c99", "-O2", "-shared", "-fPIC")
FLAGS_OF_LONG_TEXT = ("-std=c99", "-O1", "-shared", "-fPIC")
LONG_TEXT = 150_000  # characters, some 8 000 operations: there -O2 takes several seconds
PATIENCE = 300  # seconds


def compiler() -> str | None:
    """Path of the C compiler (the environment's CC, else cc, gcc, clang, or ziglang's), or None."""
    command = _command()
    return command[0] if command else None


def library(text: str) -> ctypes.CDLL:
    """The text, compiled and loaded.

    Raises:
        ToolMissing: there is no compiler.
        RunFailed: the compiler refuses the text, or does not come back.
    """
    command = _command()
    if command is None:
        raise ToolMissing("no C compiler", mend="install cc or `pip install ziglang`, set CC, or take --target numpy")
    flags = FLAGS if len(text) < LONG_TEXT else FLAGS_OF_LONG_TEXT
    key = "\0".join((text, *command, *flags, platform.platform(), platform.machine()))
    path = _cache() / f"{hashlib.sha256(key.encode()).hexdigest()[:32]}.so"
    if path.exists():
        try:
            return ctypes.CDLL(str(path))
        except OSError:  # half a file from a full disk, or another machine's: made anew below
            pass
    _compile(text, [*command, *flags], path)
    return ctypes.CDLL(str(path))


def _compile(text: str, command: list[str], path: Path) -> None:
    """Compile beside the target and rename: another process sees all of the library or nothing."""
    with tempfile.TemporaryDirectory(dir=path.parent, prefix="making-") as place:
        source, made = Path(place) / "program.c", Path(place) / "program.so"
        source.write_text(text, encoding="utf-8")
        try:
            done = subprocess.run(
                [*command, "-o", str(made), str(source), "-lm"],
                capture_output=True,
                text=True,
                timeout=PATIENCE,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise RunFailed(f"the C compiler did not come back within {PATIENCE} s") from None
        except OSError as error:
            raise ToolMissing(f"the C compiler does not start: {error}", command[0]) from None
        if done.returncode != 0 or not made.exists():
            raise RunFailed(f"the C compiler failed: {done.stderr.strip()[:2000]}", command[0])
        os.replace(made, path)


def _command() -> list[str] | None:
    """The compiler's command line, the environment's choice first."""
    chosen = shlex.split(os.environ.get("CC", ""))
    for words in [chosen] if chosen else [["cc"], ["gcc"], ["clang"]]:
        path = shutil.which(words[0])
        if path:
            return [path, *words[1:]]
    if not chosen and importlib.util.find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc"]
    return None


def _cache() -> Path:
    """The user's cache folder, or one of this process where that cannot be written."""
    place = Path(platformdirs.user_cache_dir("eomgen"))
    try:
        place.mkdir(parents=True, exist_ok=True, mode=0o700)
        with tempfile.TemporaryFile(dir=place):
            return place
    except OSError:
        return _own_folder()


@functools.cache
def _own_folder() -> Path:
    place = tempfile.mkdtemp(prefix="eomgen-")
    atexit.register(shutil.rmtree, place, ignore_errors=True)
    return Path(place)
