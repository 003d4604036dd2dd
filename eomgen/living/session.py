"""A file -> its page, until somebody ends it: watcher, workers, state and server together."""

from __future__ import annotations

import hmac
import json
import os
import secrets
import signal
import subprocess
import sys
import threading
import tomllib
import webbrowser
from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cache
from hashlib import sha256
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

from eomgen import files
from eomgen.errors import Problem, UsageError, WriteFailed
from eomgen.living.state import LiveState
from eomgen.page import in_a_row, page_style


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

        try:
            with suppress(KeyboardInterrupt):
                watcher.follow(followed)
                say(server.address)
                if opens and _has_screen():
                    threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
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
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

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
        """Ends it, and what it started: nothing more is heard of it."""
        self._left = True
        if os.name == "posix" and self.process.poll() is None:
            with suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)
        self.process.kill()
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(LONGEST_END)
        self._listener.join(LONGEST_END)
        pipes = (self.process.stdin, self.process.stdout)
        for pipe in pipes[: 1 if self._listener.is_alive() else 2]:  # one that is read would wait
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


# -------- server ----------------------------------------------------------------------------------------------
# Requests of the page -> answers: only from this machine, only with the token, only from the page itself.
#
# GET changes nothing. The host that a browser names must be this one (a name of somebody else's that leads here is
# refused), and so must the origin where it names one. POST writes the model's file, where editing is allowed and
# the file
# is still as it was read.


ADDRESS = "127.0.0.1"
KINDS = {"text": str, "sha256": str, "offset": int}
LARGEST = 1_000_000  # bytes of a model
BREATH = 10.0  # s between two signs of life of a stream
OWN_SITES = ("none", "same-origin")
"""Who asks, as a browser says: a person who typed the address, or the page itself."""
POLICY = (
    "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; style-src-attr 'unsafe-inline'; "
    "connect-src 'self'; img-src data:; font-src data:; frame-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'"
)
PLAYER_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:; "
    "font-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'; sandbox allow-scripts"
)


class LiveServer(ThreadingHTTPServer):
    """The server of one model's page.

    Args:
        port: 0: any that is free.
    Raises:
        UsageError: the port is taken.
    """

    daemon_threads = True

    def __init__(self, path: Path, state: LiveState, *, port: int, edits: bool) -> None:
        self.path, self.state, self.edits = path, state, edits
        self.token = secrets.token_urlsafe(24)
        self.writing = threading.Lock()
        try:
            super().__init__((ADDRESS, port), _Handler)
        except OSError as error:
            raise UsageError(
                f"port {port} cannot be used: {error.strerror}", fix="--port 0 takes one that is free"
            ) from error

    @property
    def hosts(self) -> tuple[str, ...]:
        """The names under which a browser reaches it."""
        return f"{ADDRESS}:{self.server_port}", f"localhost:{self.server_port}"

    @property
    def address(self) -> str:
        return f"http://{ADDRESS}:{self.server_port}/?token={self.token}"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Says nothing of a browser that went away; all else is a mistake of ours, and shown."""
        if not isinstance(sys.exc_info()[1], ConnectionError):
            super().handle_error(request, client_address)


class _Refused(Exception):
    """An answer that is no result."""

    def __init__(self, status: HTTPStatus, **entries: Any) -> None:
        self.status, self.entries = status, entries


class _Handler(BaseHTTPRequestHandler):
    server: LiveServer
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "eomgen", ""

    def do_GET(self) -> None:
        self._answered(
            {
                "/": self._page,
                "/state": self._state,
                "/events": self._events,
                "/motion": self._motion,
                "/model": self._model,
                "/examples": self._examples,
                "/editor.js": self._editor,
            }
        )

    def do_POST(self) -> None:
        self._answered({"/model": self._write, "/offers": self._offers})

    def log_message(self, format: str, *args: Any) -> None:
        """Writes no line for each request."""

    def _answered(self, ways: dict[str, Callable[[dict[str, str]], None]]) -> None:
        address = urlsplit(self.path)
        asked = {key: values[0] for key, values in parse_qs(address.query).items()}
        try:
            self._refuse_strangers(asked)
            if address.path not in ways:
                raise _Refused(HTTPStatus.NOT_FOUND, what=f"there is no {address.path}")
            ways[address.path](asked)
        except _Refused as refused:
            self.close_connection = True
            self._json(refused.entries, refused.status)
        except (BrokenPipeError, ConnectionError):
            self.close_connection = True

    def _refuse_strangers(self, asked: dict[str, str]) -> None:
        """Refuses another host, another origin, another page, and who does not know the token.

        Raises:
            _Refused: with 403.
        """
        hosts, origin = self.server.hosts, self.headers.get("Origin")
        site = self.headers.get("Sec-Fetch-Site", "none")
        known = hmac.compare_digest(asked.get("token", "").encode(), self.server.token.encode())
        if self.headers.get("Host") not in hosts:
            raise _Refused(HTTPStatus.FORBIDDEN, what="this is another host")
        own = [f"http://{host}" for host in hosts]
        if (origin is not None and origin not in own) or site not in OWN_SITES:
            raise _Refused(HTTPStatus.FORBIDDEN, what="another page asks")
        if not known:
            raise _Refused(
                HTTPStatus.FORBIDDEN, what="the token is missing or wrong: take the address that was printed"
            )

    # -- answers -----------------------------------------------------------------------------------

    def _page(self, asked: dict[str, str]) -> None:
        nonce = secrets.token_urlsafe(16)
        text = page_of(self.server.path.name, nonce, edits=self.server.edits, token=self.server.token)
        self._send(text.encode(), "text/html; charset=utf-8", policy=POLICY.format(nonce=nonce))

    def _state(self, asked: dict[str, str]) -> None:
        self._json(self.server.state.now())

    def _motion(self, asked: dict[str, str]) -> None:
        page = self.server.state.page(asked.get("page", ""))
        if page is None:
            raise _Refused(HTTPStatus.NOT_FOUND, what="this motion is not kept any more")
        page = page.replace("</body>", f"<script>{asset('height.js')}</script></body>")
        self._send(page.encode(), "text/html; charset=utf-8", policy=PLAYER_POLICY)

    def _model(self, asked: dict[str, str]) -> None:
        data = self._content()
        self._json({"text": data.decode("utf-8", "replace"), "sha256": sha256(data).hexdigest()})

    def _examples(self, asked: dict[str, str]) -> None:
        from eomgen.verbs import examples_document  # loads what this program needs for nothing else

        found = {each["name"]: Path(each["path"]) for each in examples_document().entries()["examples"]}
        if "name" not in asked:
            self._json({"examples": list(found)})
        elif asked["name"] in found:
            self._json({"text": found[asked["name"]].read_text(encoding="utf-8")})
        else:
            raise _Refused(HTTPStatus.NOT_FOUND, what=f"there is no example '{asked['name']}'")

    def _editor(self, asked: dict[str, str]) -> None:
        text = resources.files("eomgen.living").joinpath("editor", "editor.js").read_bytes()
        self._send(text, "text/javascript; charset=utf-8")

    def _events(self, asked: dict[str, str]) -> None:
        """The entries, then each that changes, as long as the page listens."""
        self.close_connection = True
        self._head("text/event-stream", None)
        number = 0
        while True:
            before = number
            number, changed = self.server.state.since(before, BREATH)
            text = f"data: {json.dumps(changed)}\n\n" if number > before else ":\n\n"
            self.wfile.write(text.encode())
            self.wfile.flush()

    def _write(self, asked: dict[str, str]) -> None:
        if not self.server.edits:
            raise _Refused(HTTPStatus.FORBIDDEN, what="the file is not written: eomgen live --edit writes it")
        given = self._given("text", "sha256")
        with self.server.writing:
            now = sha256(self._content()).hexdigest()
            if given["sha256"] != now:
                raise _Refused(HTTPStatus.CONFLICT, what="the file changed meanwhile", sha256=now)
            try:
                files.write(self.server.path, given["text"])
            except WriteFailed as error:
                raise _Refused(HTTPStatus.INTERNAL_SERVER_ERROR, what=str(error)) from error
        self._json({"sha256": sha256(given["text"].encode()).hexdigest()})

    def _offers(self, asked: dict[str, str]) -> None:
        """Offers of what may be typed at a place of a text: nothing is written."""
        from eomgen.language_server import offers_in_text  # loads what this program needs for nothing else

        given = self._given("text", "offset")
        self._json({"offers": offers_in_text(given["text"], given["offset"])})

    def _given(self, *keys: str) -> dict[str, Any]:
        """The posted text, and what else is named, an int or a text.

        Raises:
            _Refused: it is too long, or something else.
        """
        length = self.headers.get("Content-Length", "")
        if not length.isdigit() or int(length) > 2 * LARGEST:
            raise _Refused(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, what="a model has at most 1 MB")
        if self.headers.get_content_type() != "application/json":
            raise _Refused(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, what='post JSON: {"text": ..., "sha256": ...}')
        body = self.rfile.read(int(length))
        try:
            given = {key: json.loads(body)[key] for key in keys}
            whole = all(isinstance(each, KINDS[key]) for key, each in given.items())
            whole = whole and len(given["text"].encode()) <= LARGEST
        except (ValueError, KeyError, TypeError, RecursionError):
            whole = False
        if not whole:
            raise _Refused(HTTPStatus.BAD_REQUEST, what=f"post JSON with {', '.join(keys)}")
        return given

    def _content(self) -> bytes:
        """The file as it is now; b"" where it is gone."""
        try:
            return files.read(self.server.path, LARGEST)
        except OSError:
            return b""

    # -- sending -----------------------------------------------------------------------------------

    def _json(self, entries: dict[str, Any], status: HTTPStatus = HTTPStatus.OK) -> None:
        self._send(json.dumps(entries).encode(), "application/json", status)

    def _send(
        self, content: bytes, media: str, status: HTTPStatus = HTTPStatus.OK, policy: str = "default-src 'none'"
    ) -> None:
        self._head(media, len(content), status, policy)
        self.wfile.write(content)

    def _head(
        self, media: str, length: int | None, status: HTTPStatus = HTTPStatus.OK, policy: str = "default-src 'none'"
    ) -> None:
        self.send_response(status)
        heads = {"Content-Type": media, "Cache-Control": "no-store", "Content-Security-Policy": policy}
        heads |= {"X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer"}
        heads |= {"Cross-Origin-Resource-Policy": "same-origin", "Cross-Origin-Opener-Policy": "same-origin"}
        heads |= {"Connection": "close"} if self.close_connection else {}
        heads |= {} if length is None else {"Content-Length": str(length)}
        for name, value in heads.items():
            self.send_header(name, value)
        self.end_headers()


# -------- page ------------------------------------------------------------------------------------------------
# The page of a model that is being written: its frame, which a program of the page fills.


_PLACES = ("title", "nonce", "style", "script", "editor")


def page_of(name: str, nonce: str, *, edits: bool, token: str) -> str:
    """The page of a file.

    Args:
        nonce: by which the browser knows the page's own programs and style sheets.
        edits: it has a pane to edit in.
    """
    more = f'<script src="/editor.js?token={token}" nonce="{nonce}"></script>' if edits else ""
    shown = {"title": in_a_row(name), "nonce": nonce, "style": _style(), "script": asset("live.js"), "editor": more}
    page = asset("live.html")
    for place in _PLACES:
        page = page.replace(f"@{place}@", shown[place])
    return page


@cache
def _style() -> str:
    return page_style() + asset("live.css")


@cache
def asset(name: str) -> str:
    """A file of this page."""
    return resources.files("eomgen.living").joinpath("assets", name).read_text(encoding="utf-8")
