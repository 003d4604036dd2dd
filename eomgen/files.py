"""Files, whole or not at all: written to a temporary name, synced, renamed; read up to a length.

Every room reads and writes files here.

While a file is written INT and TERM wait (POSIX), so that nothing is left behind. What a killed process left, one
folder `.eomgen-*` beside its target, the next write into the same folder takes away.
"""

from __future__ import annotations

import errno
import json
import os
import re
import secrets
import select
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from eomgen.errors import DerivationError, WriteFailed

try:
    import fcntl
except ImportError:  # Windows has no locks of this kind: there the age decides what nobody uses
    fcntl = None  # type: ignore[assignment]

Content = str | bytes | Callable[[IO[bytes]], object]

PREFIX = ".eomgen-"
LEFT = re.compile(re.escape(PREFIX) + "[0-9a-f]{16}")
HOUR = 3600.0  # seconds after which a temporary folder is nobody's, where there are no locks
SILENCE = 30.0  # seconds after which nothing more is awaited of a pipe
LOOK = 0.1  # seconds between two looks at a silent pipe
TRIES = 10  # another process may take a new folder away before it is locked
WAITING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


def json_text(content: Any, **form: Any) -> str:
    """The content as JSON, which has no nan and no infinity.

    Args:
        form: `indent`, `separators` and such of `json.dumps`.
    Raises:
        DerivationError: a number of it is not finite.
    """
    try:
        return json.dumps(content, allow_nan=False, **form)
    except ValueError as error:
        raise DerivationError(
            f"a result has no finite number, which JSON cannot hold: {error}",
            fix="its text form shows which; give values at which it is real and within doubles",
        ) from error


def write(path: str | Path, content: Content) -> None:
    """Writes a file, and makes its folder if there is none; a pipe or a terminal is written directly.

    Args:
        content: a text (in UTF-8), bytes, or what fills an open file.
    Raises:
        WriteFailed: it cannot be written; what was there before is then still there.
    """
    try:
        if is_stream(path):
            with open(path, "wb") as file:
                _fill(file, content)
            return
        target = Path(os.path.realpath(path))
        _write_all(target.parent, {target.name: content})
    except OSError as error:
        raise WriteFailed(
            f"the file cannot be written: {error.strerror or error}",
            str(path),
            fix="name a place that can be written to",
        ) from None


def write_all(directory: str | Path, contents: Mapping[str, Content]) -> list[Path]:
    """Writes several files into a folder, made if there is none; all are complete before the first takes its place.

    Args:
        contents: by path inside the folder.
    Raises:
        WriteFailed: one cannot be written.
    """
    try:
        return _write_all(Path(directory), contents)
    except OSError as error:
        what, where = "the files cannot be written", str(directory)
        if len(contents) == 1:
            what, where = "the file cannot be written", str(Path(directory, *contents))
        raise WriteFailed(
            f"{what}: {error.strerror or error}", where, fix="write into another file or folder"
        ) from None


def read(path: str | Path, most: int) -> bytes:
    """The content of a file, a pipe or a device: at most `most` bytes, and one more if it is longer.

    Raises:
        OSError: it cannot be read, or a pipe stays silent.
    """
    if not (hasattr(os, "O_NONBLOCK") and is_stream(path)):
        with open(path, "rb") as file:
            return file.read(most + 1)
    handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    try:
        return _through(handle, most)
    finally:
        os.close(handle)


def read_stdin(most: int) -> bytes:
    """The content of stdin, read as in `read`; typed input is awaited without a time limit.

    Raises:
        OSError: it cannot be read, or a pipe stays silent.
    """
    stream = sys.stdin.buffer
    try:
        handle = stream.fileno()
    except (OSError, ValueError):  # no file: a text that stands for one
        return stream.read(most + 1)
    return stream.read(most + 1) if os.name != "posix" or stream.isatty() else _through(handle, most)


def _through(handle: int, most: int) -> bytes:
    """Reads part by part; after as many bytes as are wanted the next part is empty, as it is at the end.

    The next part is awaited in short steps, so that a shorter time limit can stop it between two of them (--patience).
    """
    data = b""
    while True:
        given_up = time.monotonic() + SILENCE
        while not select.select([handle], [], [], min(LOOK, SILENCE))[0]:
            if time.monotonic() > given_up:
                raise TimeoutError(errno.ETIMEDOUT, f"nothing came through it for {SILENCE:g} s")
        part = os.read(handle, most + 1 - len(data))
        if not part:
            return data
        data += part


def is_stream(path: str | Path) -> bool:
    """True for a pipe, a terminal or a device: no file can be moved into its place."""
    return os.path.exists(path) and not os.path.isfile(path)


@contextmanager
def beside(folder: Path) -> Iterator[Path]:
    """A new temporary folder `.eomgen-*` in another one; those of processes that were killed are deleted first."""
    _clear(folder)
    for _ in range(TRIES):
        place = folder / (PREFIX + secrets.token_hex(8))
        try:
            place.mkdir(mode=0o700)
            lock = _lock(place)
        except (FileNotFoundError, BlockingIOError):
            if not folder.is_dir():
                raise
            continue
        except BaseException:
            shutil.rmtree(place, ignore_errors=True)
            raise
        if place.is_dir():
            break
    try:
        yield place
    finally:
        shutil.rmtree(place, ignore_errors=True)
        if lock is not None:
            os.close(lock)


def _write_all(directory: Path, contents: Mapping[str, Content]) -> list[Path]:
    with _undisturbed(), _made(directory), beside(directory) as place:
        for name, content in contents.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            with open(place / name, "wb") as file:
                _fill(file, content)
                file.flush()
                os.fsync(file.fileno())
        for name in contents:
            target = directory / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if target.exists():
                shutil.copymode(target, place / name)
            os.replace(place / name, target)
        _sync(directory)
    return [directory / name for name in contents]


def _fill(file: IO[bytes], content: Content) -> None:
    if callable(content):
        content(file)
    else:
        file.write(content if isinstance(content, bytes) else content.encode("utf-8", "backslashreplace"))


@contextmanager
def _made(directory: Path) -> Iterator[None]:
    """Makes the folder; if what follows fails, the folders that were made for it are removed."""
    new = [each for each in (directory, *directory.parents) if not each.exists()]
    try:
        directory.mkdir(parents=True, exist_ok=True)
        yield
    except BaseException:
        for each in new:
            with suppress(OSError):
                each.rmdir()
        raise


@contextmanager
def _undisturbed() -> Iterator[None]:
    """Delays INT, TERM and HUP until the end. Windows cannot: what an interrupt leaves, the next write deletes."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    try:
        signal.pthread_sigmask(signal.SIG_BLOCK, WAITING)
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _clear(folder: Path) -> None:
    """Deletes the temporary folders that no process holds."""
    with suppress(OSError):
        for left in folder.iterdir():
            if LEFT.fullmatch(left.name) and left.is_dir() and _is_left(left):
                shutil.rmtree(left, ignore_errors=True)


def _is_left(place: Path) -> bool:
    """True if the process that made the folder has ended: nobody holds its lock."""
    try:
        if fcntl is None:
            return time.time() - place.stat().st_mtime > HOUR
        lock = _lock(place)
    except OSError:
        return False
    if lock is not None:
        os.close(lock)
    return True


def _lock(place: Path) -> int | None:
    """The lock on a folder, which ends with the process that holds it; None where there are no locks.

    Raises:
        BlockingIOError: another process holds it.
    """
    if fcntl is None:
        return None
    handle = os.open(place, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BaseException:
        os.close(handle)
        raise
    return handle


def _sync(directory: Path) -> None:
    """Writes the names of a folder to the disk; where folders cannot be opened, the system does that by itself."""
    with suppress(OSError):
        handle = os.open(directory, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
