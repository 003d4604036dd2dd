"""A file -> its page, until somebody ends it: watcher, workers, state and server together."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import tomllib
import webbrowser
from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from eomgen import files
from eomgen.errors import Problem
from eomgen.living.server import LARGEST, LiveServer
from eomgen.living.state import LiveState


def serve(
    path: str | Path,
    *,
    port: int = 0,
    edits: bool = False,
    opens: bool = True,
    seconds: float | None = 30.0,
    values: Mapping[str, Any] | None = None,
    say: Callable[[str], object] = print,
) -> None:
    """Serves the page of a model's file until it is interrupted.

    Args:
        port: 0: any that is free.
        edits: the page may write the file.
        opens: the page is opened in a browser, where there is one.
        seconds: the time for one part; None: no limit.
        values: what was typed in the place of those of the file: "set_", "start", "variant".
        say: takes the address.
    Raises:
        UsageError: the port is taken.
    """
    path = Path(path)
    state = LiveState({"file": path.name, "editable": edits})
    with LiveServer(path, state, port=port, edits=edits) as server:
        team, watcher = Team(state.hear, values), Watcher(path, LARGEST)

        def followed(content: bytes | OSError) -> None:
            if isinstance(content, OSError):
                problem = Problem(str(path), f"cannot be read: {content.strerror}", fix="check the path")
                state.refuse(problem.as_dict())
            else:
                team.ask(state.begin(), content, str(path), path.stem, seconds)

        watcher.follow(followed)
        say(server.address)
        if opens and _has_screen():
            threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        try:
            with suppress(KeyboardInterrupt):
                server.serve_forever()
        finally:
            watcher.stop()
            team.end()


def _has_screen() -> bool:
    """True where a browser can be shown: no text browser is opened in this terminal."""
    named = any(map(os.environ.get, ("BROWSER", "DISPLAY", "WAYLAND_DISPLAY")))
    return named or sys.platform in ("win32", "darwin")


# -------- watching --------------------------------------------------------------------------------------------
# A file that is looked at: each of its contents, once it is whole.
#
# A look takes the time of the change, the size and the number of the file. What has changed is believed when two looks
# agree: a slow save is not read by halves. Saves in place and by renaming are seen alike.


BETWEEN = 0.025  # s between two looks
MISSED = 20  # looks after which a file that is not there, or empty, is believed: some programs empty it first

Look = tuple[int, int, int] | None


class Watcher:
    """Contents of a file, as they come; the same again, where a file of one of its parts changes.

    Args:
        most: bytes that are read.
    """

    def __init__(self, path: Path, most: int) -> None:
        self.path, self.most = path, most
        self._parts: tuple[Path, ...] = ()
        self._over = threading.Event()

    def stop(self) -> None:
        """Ends `contents`."""
        self._over.set()

    def contents(self) -> Iterator[bytes | OSError]:
        """The content that is there, then each other one; an error where the file is gone, or cannot be read."""
        believed: Look | str = "none yet"
        before: Look | str = "none yet"
        known: bytes | None = None
        missed, beside = 0, self._beside()
        while not self._over.is_set():
            now = self._look()
            if known is not None and now == believed and (moved := self._beside()) != beside:
                beside = moved
                yield known
            missed = missed + 1 if _is_nothing(now) else 0
            if now != believed and now == before and (not missed or missed > MISSED):
                found = self._read(now)
                if found is not None:
                    believed = now
                    if found != known:
                        known = found if isinstance(found, bytes) else None
                        self._parts = _files_of_parts(known or b"", self.path)
                        beside = self._beside()
                        yield found
            before = now
            self._over.wait(BETWEEN)

    def follow(self, tell: Callable[[bytes | OSError], None]) -> None:
        """Tells each content, in a thread of its own."""

        def follow_on() -> None:
            for each in self.contents():
                tell(each)

        threading.Thread(target=follow_on, daemon=True).start()

    def _beside(self) -> list[Look]:
        return [_look_at(path) for path in self._parts]

    def _look(self) -> Look:
        return _look_at(self.path)

    def _read(self, look: Look) -> bytes | OSError | None:
        """The content; None where the file changed while it was read."""
        try:
            found = files.read(self.path, self.most)
        except OSError as error:
            return error
        return found if self._look() == look else None


def _files_of_parts(content: bytes, path: Path) -> tuple[Path, ...]:
    """The files that [parts] of a model name; of parts of parts those of the first alone."""
    try:
        parts = tomllib.loads(content.decode("utf-8-sig")).get("parts", {})
    except (ValueError, RecursionError):
        return ()
    named = [part.get("file") for part in parts.values() if isinstance(part, dict)] if isinstance(parts, dict) else []
    return tuple(path.parent / name for name in dict.fromkeys(named) if isinstance(name, str))


def _look_at(path: Path) -> Look:
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _is_nothing(look: Look) -> bool:
    """True where there is no file, or an empty one."""
    return look is None or look[1] == 0


# -------- workers ---------------------------------------------------------------------------------------------
# Worker processes: one works, one is warm; what is out of date is stopped, or left behind.
#
# Work that does not stop by itself within PAUSE is ended with its process, and the spare one takes over.


PAUSE = 0.2  # s for work to stop by itself
LONGEST_END = 2.0  # s for a process to end

Hear = Callable[[dict[str, Any]], None]


class Worker:
    """One process; `hear` is called in a thread of its own with each message, and with {"died": True} at its end."""

    def __init__(self, hear: Hear) -> None:
        home = str(Path(__file__).parent.parent.parent)
        paths = os.pathsep.join(filter(None, (home, os.environ.get("PYTHONPATH", ""))))
        self.process = subprocess.Popen(
            [
                sys.executable,
                "-P",
                "-c",
                "from eomgen.living.parts import work_until_stdin_ends; work_until_stdin_ends()",
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": paths},
            text=True,
            encoding="utf-8",
            start_new_session=os.name == "posix",  # Ctrl-C in a terminal is not for it
        )
        self.idle = threading.Event()
        self.idle.set()
        self.revision = 0
        self._hear, self._left = hear, False
        threading.Thread(target=self._listen, daemon=True).start()

    def say(self, **request: Any) -> None:
        """Sends a request; a process that has ended does not hear it."""
        assert self.process.stdin is not None
        with suppress(OSError, ValueError):
            self.process.stdin.write(json.dumps(request) + "\n")
            self.process.stdin.flush()

    def begin(self, revision: int, **request: Any) -> None:
        """Gives it the work of a revision."""
        self.revision = revision
        self.idle.clear()
        self.say(revision=revision, **request)

    def leave(self) -> None:
        """Ends it: nothing more is heard of it."""
        self._left = True
        self.process.kill()
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(LONGEST_END)
        for pipe in (self.process.stdin, self.process.stdout):
            with suppress(OSError):
                assert pipe is not None
                pipe.close()

    def _listen(self) -> None:
        assert self.process.stdout is not None
        with suppress(OSError, ValueError):
            for line in self.process.stdout:
                message = json.loads(line)
                if message.get("done") and message["revision"] == self.revision:
                    self.idle.set()
                if not self._left:
                    self._hear(message)
        self.idle.set()
        if not self._left:
            self._hear({"revision": self.revision, "died": True})


class Team:
    """The worker that works and the one that waits.

    Args:
        values: what was typed in the place of those of each text.
    """

    def __init__(self, hear: Hear, values: Mapping[str, Any] | None = None) -> None:
        self._hear, self._values = hear, values
        self._lock = threading.Lock()
        self._ended = False
        self.current = Worker(self._heard)
        self.spare: Worker | None = None

    def ask(self, revision: int, data: bytes, name: str, title: str, seconds: float | None) -> None:
        """The parts of a text are wanted, and those of the text before no more."""
        with self._lock:
            if self._ended:
                return
            if not self.current.idle.is_set():
                self.current.say(stop=True)
                self.current.idle.wait(PAUSE)
            if not self.current.idle.is_set() or self.current.process.poll() is not None:
                self.current.leave()
                self.current, self.spare = self.spare or Worker(self._heard), None
            packed = b64encode(data).decode("ascii")
            self.current.begin(revision, data=packed, name=name, title=title, seconds=seconds, values=self._values)

    def end(self) -> None:
        """Ends all."""
        with self._lock:
            self._ended = True
            for worker in filter(None, (self.current, self.spare)):
                worker.leave()

    def _heard(self, message: dict[str, Any]) -> None:
        self._hear(message)
        if message.get("done"):
            threading.Thread(target=self._find_spare, daemon=True).start()

    def _find_spare(self) -> None:
        """Makes a spare worker where there is none, when the first has done its work."""
        with self._lock:
            if self.spare is None and not self._ended:
                self.spare = Worker(self._heard)
                self.spare.say(warm=True)
