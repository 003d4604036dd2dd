"""Files that are cached from one process to the next in the user's cache folder: compiled code, derivations.

Each is a file NAME-DIGEST.SUFFIX: NAME is the digest of everything that it depends on, DIGEST that of NAME and the
content. It is written under another name and then renamed. A file is ignored where it belongs to another user, others
can write it, or its content does not match its name (cut off, changed or renamed).
"""

from __future__ import annotations

import atexit
import functools
import hashlib
import os
import shutil
import stat
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import platformdirs

MOST_KEPT, LARGEST, OLDEST = 1000, 2**28, 90 * 86_400.0  # of a suffix; bytes together; seconds since the last use


def digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:32]


def cache_folder() -> Path | None:
    """The folder of the cached files; None for a user without a home."""
    try:
        place = Path(platformdirs.user_cache_dir("eomgen"))
    except RuntimeError:
        return None
    return place if place.is_absolute() else None


def cache_place() -> Path:
    """The user's cache folder, closed to others; one of this process where that is another's or not writable."""
    place = cache_folder()
    if place is None:
        return _own_folder()
    try:
        place.mkdir(parents=True, exist_ok=True, mode=0o700)
        if not is_ours(place):
            return _own_folder()
        if _others_write(place):
            place.chmod(0o700)  # what others have put there meanwhile is theirs, and not loaded
        with tempfile.TemporaryFile(dir=place):
            return place
    except OSError:
        return _own_folder()


def contents(place: Path, name: str, suffix: str) -> Iterator[tuple[Path, bytes]]:
    """(path, content) of each intact file of this name, see `content_of`."""
    for path in place.glob(f"{name}-*{suffix}"):
        content = content_of(path)
        if content is not None:
            yield path, content


def content_of(path: Path) -> bytes | None:
    """The content of a file; None where its name does not match it, or others can write it."""
    try:
        if not is_ours(path) or _others_write(path):
            return None
        content = path.read_bytes()
        return content if path.name == _named(path.name[:32], content, path.suffix) else None
    except OSError:
        return None


def put_whole(made: Path, place: Path, name: str) -> Path:
    """Renames a file, complete under another name, to its name in the cache; other processes see all of it or nothing.

    Raises:
        OSError: it cannot be put there.
    """
    made.chmod(0o700)  # whatever the umask
    path = place / _named(name, made.read_bytes(), made.suffix)
    os.replace(made, path)
    _let_go(place, path)
    return path


def used(path: Path) -> None:
    """Marks a file as used now, so that it is not deleted soon."""
    with suppress(OSError):
        os.utime(path)


def is_ours(path: Path) -> bool:
    """True if a file or folder belongs to this user; on Windows everything below the user's folder does."""
    return not hasattr(os, "getuid") or path.stat().st_uid == os.getuid()


def _named(name: str, content: bytes, suffix: str) -> str:
    """NAME-DIGEST.SUFFIX; the digest is of both name and content."""
    return f"{name}-{digest(name.encode() + content)}{suffix}"


def _others_write(path: Path) -> bool:
    return hasattr(os, "getuid") and bool(path.stat().st_mode & (stat.S_IWGRP | stat.S_IWOTH))


def _let_go(place: Path, new: Path) -> None:
    """Deletes files unused for long, and the oldest where they are too many or together too large."""
    with suppress(OSError):  # another process does the same
        found = [(path.stat(), path) for path in place.glob(f"*{new.suffix}")]
        size = 0
        for count, (about, path) in enumerate(sorted(found, key=lambda each: -each[0].st_mtime)):
            size += about.st_size
            if path != new and (count >= MOST_KEPT or size > LARGEST or time.time() - about.st_mtime > OLDEST):
                path.unlink()


@functools.cache
def _own_folder() -> Path:
    place = tempfile.mkdtemp(prefix="eomgen-")
    atexit.register(shutil.rmtree, place, ignore_errors=True)
    return Path(place)
