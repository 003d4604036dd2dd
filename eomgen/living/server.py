"""Requests of the page -> answers: only from this machine, only with the token, only from the page itself.

GET changes nothing. The host that a browser names must be this one (a name of somebody else's that leads here is
refused), and so must the origin where it names one. POST writes the model's file, where editing is allowed and the file
is still as it was read.
"""

from __future__ import annotations

import hmac
import json
import secrets
import sys
import threading
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

from eomgen import files
from eomgen.errors import UsageError, WriteFailed
from eomgen.living.state import LiveState
from eomgen.page import in_a_row, page_style

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
