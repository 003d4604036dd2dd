"""A browser that is driven over a pipe: real keys and clicks, what the page asked for, pictures of it."""

from __future__ import annotations

import base64
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tools import tool

FLAGS = (
    "--headless=new --no-sandbox --disable-gpu --no-first-run --disable-background-networking --disable-sync "
    "--disable-component-update --remote-debugging-pipe --use-angle=swiftshader --enable-unsafe-swiftshader"
)
WITH_PIPES = (  # numbers 3 and 4 are those that the browser reads and writes
    "import fcntl, os, sys; a, b = (fcntl.fcntl(int(x), fcntl.F_DUPFD, 10) for x in sys.argv[1:3]); os.dup2(a, 3); "
    "os.dup2(b, 4); os.execv(sys.argv[3], sys.argv[3:])"
)
PATIENCE = 40.0  # s


class Tab:
    """One page of the browser."""

    def __init__(self, into: int, out_of: int) -> None:
        self._into, self._out_of = into, out_of
        self._number, self._left, self._session = 0, b"", ""
        self.requests: list[str] = []
        self.console: list[str] = []
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.ask(f"{domain}.enable")
        self.ask("Emulation.setFocusEmulationEnabled", enabled=True)

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """What the browser answers."""
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method, "params": parameters}
        message |= {"sessionId": self._session} if self._session else {}
        os.write(self._into, json.dumps(message).encode() + b"\0")
        for heard in self._messages():
            if heard.get("id") == self._number:
                assert "error" not in heard, heard
                return heard["result"]
        raise AssertionError("the browser ended")

    def _messages(self) -> Iterator[dict[str, Any]]:
        while True:
            *whole, self._left = self._left.split(b"\0")
            for k, each in enumerate(whole):
                self._left = b"\0".join([*whole[k + 1 :], self._left])
                heard = json.loads(each)
                self._noted(heard)
                yield heard
                break
            else:
                more = os.read(self._out_of, 1 << 16)
                if not more:
                    return
                self._left += more

    def _noted(self, heard: dict[str, Any]) -> None:
        parameters = heard.get("params", {})
        if heard.get("method") == "Network.requestWillBeSent":
            self.requests.append(parameters["request"]["url"])
        if heard.get("method") == "Runtime.exceptionThrown":
            self.console.append(json.dumps(parameters["exceptionDetails"]))
        if heard.get("method") == "Log.entryAdded":
            self.console.append(parameters["entry"]["text"])

    def open(self, address: str) -> None:
        """Goes to an address."""
        self.ask("Page.navigate", url=address)
        self.until("document.readyState === 'complete'")

    def value(self, expression: str) -> Any:
        """The value of an expression of the page, awaited."""
        found = self.ask("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def until(self, expression: str, seconds: float = PATIENCE) -> float:
        """Waits until an expression holds; returns the seconds that it took."""
        begun = time.monotonic()
        while not self.value(f"Boolean({expression})"):
            assert time.monotonic() < begun + seconds, f"it never holds: {expression}; {self.console}"
            time.sleep(0.01)
        return time.monotonic() - begun

    def click(self, selector: str) -> None:
        """A click of the mouse in the middle of an element."""
        box = self.value(
            f"(() => {{ const e = document.querySelector({json.dumps(selector)}); e.scrollIntoView("
            "{block: 'center'}); const b = e.getBoundingClientRect(); return [b.x + b.width/2, b.y + b.height/2]; })()"
        )
        for kind in ("mousePressed", "mouseReleased"):
            self.ask("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)

    def press(self, key: str, *, control: bool = False) -> None:
        """A key, pressed and released."""
        code = ord(key.upper()) if len(key) == 1 else {"End": 35, "Home": 36, "Tab": 9, "Escape": 27, "F8": 119}[key]
        held = {"key": key, "windowsVirtualKeyCode": code, "modifiers": 2 if control else 0}
        held |= {"code": f"Key{key.upper()}"} if len(key) == 1 else {"code": key}
        self.ask("Input.dispatchKeyEvent", type="rawKeyDown", **held)
        self.ask("Input.dispatchKeyEvent", type="keyUp", **held)

    def write(self, text: str) -> None:
        """Characters, as typed."""
        self.ask("Input.insertText", text=text)

    def size(self, width: int, height: int = 900) -> None:
        """The size of the window."""
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def picture(self, path: Path) -> None:
        """What is seen, as a PNG."""
        path.write_bytes(
            base64.b64decode(self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=True)["data"])
        )


@contextmanager
def driven_tab() -> Iterator[Tab]:
    """A tab of a browser of its own."""
    theirs_in, into = os.pipe()
    out_of, theirs_out = os.pipe()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        command = [tool("chromium"), *FLAGS.split(), f"--user-data-dir={folder}"]
        browser = subprocess.Popen(
            [sys.executable, "-c", WITH_PIPES, str(theirs_in), str(theirs_out), *command],
            pass_fds=(theirs_in, theirs_out),
            stderr=subprocess.DEVNULL,
        )
        os.close(theirs_in)
        os.close(theirs_out)
        try:
            yield Tab(into, out_of)
        finally:
            browser.kill()
            browser.wait()
            os.close(into)
            os.close(out_of)
