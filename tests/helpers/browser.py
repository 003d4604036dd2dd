"""A page in a real browser without a network: what a script finds in it, what it complained of, what it asked for."""

from __future__ import annotations

import html
import json
import re
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tools import tool

FLAGS = (
    "--headless=new --no-sandbox --disable-gpu --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync --use-angle=swiftshader --enable-unsafe-swiftshader "
    "--enable-logging=stderr --virtual-time-budget=6000"
)
BROWSERS_OWN = re.compile(
    r"https?://([\w-]+\.)*(google|googleapis|gvt1)\.com[:/]"
)  # what Chromium asks without any page
FOUND = """<script>
addEventListener("load", async () => {
    let found;
    try { found = await (async () => { SCRIPT })(); } catch (error) { found = { error: String(error) }; }
    const asked = performance.getEntriesByType("resource").map(entry => entry.name);
    const left = asked.filter(name => !name.startsWith("data:"));
    document.body.dataset.found = JSON.stringify({ found, left });
});
</script>"""

TRIES = 5  # the browser's virtual time may run out while it waits for one of its own processes


@dataclass(frozen=True)
class Visit:
    """What was seen of a page.

    Args:
        dom: the page as it stood at the end.
        found: what the script gave.
        console: lines that the page wrote or caused.
        requests: addresses that it asked for.
    """

    dom: str
    found: Any
    console: tuple[str, ...]
    requests: tuple[str, ...]


def visited(
    page: str, script: str = "return null;", *, width: int = 1280, fragment: str = "", flags: str = ""
) -> Visit:
    """The page opened, and a script (the body of an async function) run in it when it has loaded."""
    for _ in range(TRIES):
        done, requested = _opened(page, script, width, fragment, flags)
        if reported := re.search(r'data-found="([^"]*)"', done.stdout):
            break
    else:
        raise AssertionError(f"the script did not end: {done.stdout[-2000:]} {done.stderr[-2000:]}")
    inside = json.loads(html.unescape(reported[1]))
    console = tuple(line for line in done.stderr.splitlines() if "CONSOLE" in line and "GL Driver" not in line)
    return Visit(done.stdout, inside["found"], console, (*inside["left"], *requested))


def _opened(
    page: str, script: str, width: int, fragment: str, flags: str
) -> tuple[subprocess.CompletedProcess[str], list[str]]:
    """(the browser's end, the addresses that it asked for)."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "page.html")
        path.write_text(page.replace("</body>", FOUND.replace("SCRIPT", script) + "</body>"), encoding="utf-8")
        log = Path(folder, "net.json")
        command = [tool("chromium"), *FLAGS.split(), "--host-resolver-rules=MAP * ~NOTFOUND", *flags.split()]
        command += [f"--user-data-dir={folder}/profile"]
        command += [f"--window-size={width},900", f"--log-net-log={log}", "--dump-dom", f"{path.as_uri()}{fragment}"]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
        requested = re.findall(r'"url":"(https?://[^"]+)"', log.read_text(errors="replace")) if log.exists() else []
    return done, [address for address in requested if not BROWSERS_OWN.match(address)]
