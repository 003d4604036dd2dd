"""`eomgen live` as a person has it: a process, a browser, a file that is saved; keys, clicks, Ctrl-C.

Slow: the process and the browser each take a second or two to begin.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import axe_core_python
import pytest
from driven_browser import Tab, driven_tab
from slow_run import in_slow_run
from tools import needs

from eomgen.living.session import Team, Worker

pytestmark = [pytest.mark.slow, pytest.mark.skipif(os.name != "posix", reason="pipes and signals as POSIX has them")]

MODELS = Path(__file__).parent.parent / "models"
EDITOR = Path(__file__).parent.parent / "eomgen" / "living" / "editor"
TEXT = (MODELS / "double_pendulum.toml").read_text("utf-8")
NEVER = 40.0  # s


def at_a_terminal() -> None:
    """Lets a program hear Ctrl-C: tests that a script runs in its background are deaf to it, and what they begin."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class Live:
    """The command at work."""

    def __init__(self, path: Path, *options: str, **environment: str) -> None:
        command = [sys.executable, "-m", "eomgen", "live", str(path), *options]
        self.begun = time.monotonic()
        self.process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, **environment},
            preexec_fn=at_a_terminal,
        )
        assert self.process.stdout is not None
        self.address = self.process.stdout.readline().rstrip("\n")
        self.token = self.address.partition("token=")[2]

    def at(self, path: str) -> str:
        return f"{self.address.partition('/?')[0]}{path}?token={self.token}"

    def state(self) -> dict:
        with urllib.request.urlopen(self.at("/state"), timeout=10) as answer:
            return json.load(answer)

    def until(self, revision: int) -> dict:
        """The state when all work of a revision is done."""
        end = time.monotonic() + NEVER
        while (state := self.state())["working"] or state["revision"] < revision:
            assert time.monotonic() < end
            time.sleep(0.02)
        return state

    def ended(self, how: int = signal.SIGINT) -> int:
        self.process.send_signal(how)
        return self.process.wait(60)


@contextmanager
def live(path: Path, *options: str, **environment: str) -> Iterator[Live]:
    found = Live(path, "--no-browser", *options, **environment)
    try:
        yield found
    finally:
        found.process.kill()
        found.process.wait()


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "pendulum.toml"
    shutil.copy(MODELS / "double_pendulum.toml", path)
    return path


def test_the_first_line_is_the_address_and_ctrl_c_ends_it_well(file):
    """http://127.0.0.1:PORT/?token=...; exit 0, and nothing on stderr; its workers end with it."""
    with live(file) as found:
        assert found.address.startswith("http://127.0.0.1:") and len(found.token) >= 32
        state = found.until(1)
        assert state["degrees_of_freedom"] == 2 and state["figure"].startswith("<svg ") and state["problems"] == []
        assert all(state[part] is not None for part in ("equations", "answers", "motion", "reactions", "certificate"))
        children = subprocess.run(
            ["pgrep", "-P", str(found.process.pid)], capture_output=True, text=True
        ).stdout.split()
        assert found.ended() == 0
        assert found.process.stderr.read() == ""
        time.sleep(0.3)
        assert children and not [child for child in children if Path(f"/proc/{child}/cmdline").exists()]


@in_slow_run
def test_workers_end_where_the_program_is_killed(file):
    """Their stdin ends with it."""
    with live(file) as found:
        found.until(1)
        children = subprocess.run(
            ["pgrep", "-P", str(found.process.pid)], capture_output=True, text=True
        ).stdout.split()
        found.process.kill()
        found.process.wait()
        end = time.monotonic() + 10
        while any(Path(f"/proc/{child}/cmdline").exists() for child in children):
            assert time.monotonic() < end
            time.sleep(0.05)


def test_a_broken_file_keeps_the_last_good_picture(file):
    """Broken from the start there is none; then save, break, mend: it stays while the file is broken."""
    text = file.read_text()
    file.write_text("eomgen = 1\nspace = \n")
    with live(file) as found:
        state = found.until(1)
        assert state["figure"] is None and [problem["line"] for problem in state["problems"]] == [2]
        file.write_text(text)
        first = found.until(2)
        file.write_text(text.replace('mass = "m1"', 'mass = "nothing"'))
        broken = found.until(3)
        assert broken["figure"] == first["figure"] and broken["equations"] == first["equations"]
        assert [problem["line"] for problem in broken["problems"]] == [17] and not broken["good"]
        file.write_text(text.replace("start = 2.0", "start = 1.0"))
        mended = found.until(4)
        assert mended["figure"] != first["figure"] and mended["problems"] == [] and mended["good"]


@in_slow_run
def test_long_work_that_is_out_of_date_is_left_behind(tmp_path):
    """A model that takes a minute, then another one: the second is there soon, by the worker or by the spare one."""
    path = tmp_path / "m.toml"
    shutil.copy(MODELS / "double_pendulum.toml", path)
    with live(path) as found:
        found.until(1)
        shutil.copy(MODELS / "arm7.toml", path)
        while found.state()["revision"] < 2:
            time.sleep(0.02)
        time.sleep(0.3)
        shutil.copy(MODELS / "double_pendulum.toml", path)
        begun = time.monotonic()
        assert found.until(3)["degrees_of_freedom"] == 2
        assert time.monotonic() - begun < 15


@in_slow_run
def test_a_worker_that_does_not_stop_is_replaced_by_the_spare_one(monkeypatch):
    """Its process ends within PAUSE and the kill; the spare one answers."""
    heard: list[dict] = []
    monkeypatch.setattr(Worker, "say", lambda self, **request: None if "stop" in request else _say(self, **request))
    team = Team(heard.append)
    try:
        first = team.current
        text = (MODELS / "arm7.toml").read_bytes()
        team.ask(1, text, "m.toml", "m", None)
        while not heard:
            time.sleep(0.01)
        team.ask(2, (MODELS / "atwood.toml").read_bytes(), "m.toml", "m", None)
        assert first.process.poll() is not None and team.current is not first
        end = time.monotonic() + NEVER
        while {"revision": 2, "done": True} not in heard:
            assert time.monotonic() < end
            time.sleep(0.02)
    finally:
        team.end()


_say = Worker.say


@in_slow_run
def test_the_address_is_opened_in_the_browser_that_is_named(tmp_path, file):
    """BROWSER is called with the address; with --no-browser it is not."""
    log = tmp_path / "opened"
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$1" >> {log}\n')
    browser.chmod(0o755)
    for options, opened in (((), True), (("--no-browser",), False)):
        log.unlink(missing_ok=True)
        found = Live(file, *options, BROWSER=str(browser))
        end = time.monotonic() + (10 if opened else 1)
        while not log.exists() and time.monotonic() < end:
            time.sleep(0.02)
        assert (log.read_text().strip() if opened else None) == (found.address if opened else None)
        assert log.exists() == opened
        assert found.ended() == 0


# -- in a browser ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Seen:
    """A page that may be edited, in a browser.

    Args:
        path: the file of its model.
    """

    tab: Tab
    live: Live
    path: Path

    def saved(self, text: str) -> None:
        """The file is saved by somebody else; the page has shown it."""
        before = self.live.state()["revision"]
        self.path.write_text(text)
        self.shown(before + 1)

    def shown(self, revision: int) -> None:
        """Waits until the page shows all of a revision."""
        self.tab.until(f"document.body.dataset.revision >= {revision}")

    def revision(self) -> int:
        return int(self.live.state()["revision"])

    def text(self, selector: str) -> str:
        return self.tab.value(f"document.querySelector('{selector}').innerText")

    @property
    def picture(self) -> str:
        return self.tab.value("document.querySelector('#figure').innerHTML")


@pytest.fixture(scope="module")
def page(tmp_path_factory) -> Iterator[Seen]:
    """One process and one browser for all of these tests."""
    path = tmp_path_factory.mktemp("live") / "model.toml"
    path.write_text(TEXT)
    with live(path, "--edit") as found, driven_tab() as tab:
        tab.size(1280)
        tab.open(found.address)
        yield Seen(tab, found, path)


@pytest.fixture
def seen(page) -> Seen:
    """The same page, with the double pendulum in its file and nothing typed."""
    page.tab.until("document.querySelector('.cm-content')")
    if page.path.read_text() != TEXT:
        page.saved(TEXT)
    page.tab.until("document.body.dataset.revision !== ''")
    page.tab.until("document.querySelector('#save').disabled")
    page.tab.requests.clear()
    page.tab.console.clear()
    return page


@needs("chromium")
def test_the_page_follows_the_file(seen):
    """A save moves the picture; a mistake is shown with its line, and the picture stays; nothing leaves the machine."""
    tab, picture = seen.tab, seen.picture
    assert seen.text("h1") == "Double pendulum"
    assert tab.value("document.querySelectorAll('#equations math').length") > 2
    assert seen.text("#degrees_of_freedom") == "2 degrees of freedom"
    seen.saved(TEXT.replace("start = 2.0", "start = 1.0"))
    moved = seen.picture
    assert moved != picture
    seen.saved(TEXT.replace('mass = "m1"', 'mass = "nothing"'))
    assert seen.picture == moved
    assert "line 17" in seen.text("#problems") and "nothing" in seen.text("#problems")
    assert tab.value("document.querySelector('#status').dataset.state") == "broken"
    seen.saved(TEXT)
    assert tab.value("document.querySelector('#problems').hidden")
    assert seen.picture == picture
    home = seen.live.address.partition("/?")[0]
    assert [each for each in tab.requests if not each.startswith((home, "data:"))] == []
    assert tab.console == []


@needs("chromium")
def test_what_is_typed_is_saved_on_save_and_shown(seen):
    """Real keys: nothing is written before Ctrl-S; then the file has the letters, and the page its new picture."""
    tab, revision = seen.tab, seen.revision()
    tab.click(".cm-line:nth-child(2)")
    tab.press("End")
    tab.write("  # typed")
    tab.until("!document.querySelector('#save').disabled")
    time.sleep(0.2)
    assert seen.path.read_text() == TEXT
    tab.press("s", control=True)
    seen.shown(revision + 1)
    assert seen.path.read_text() == TEXT.replace('"Double pendulum"\n', '"Double pendulum"  # typed\n')
    assert tab.value("document.querySelector('#save').disabled")
    tab.click(".cm-line:nth-child(1)")
    tab.press("End")
    tab.write("1 ]")
    tab.click("#save")
    seen.shown(revision + 2)
    tab.until("document.querySelector('.cm-lint-marker-error')")
    assert tab.value("document.querySelector('#figure svg') !== null")
    assert tab.console == []


@needs("chromium")
def test_names_are_offered_while_one_types(seen):
    """In the mass of a rod the parameters that begin so; the one that is chosen stands there."""
    tab = seen.tab
    tab.value(
        "(() => { const doc = editor.text(), at = doc.indexOf('mass = \"m1\"') + 8;"
        " editor.view.dispatch({ selection: { anchor: at } }); editor.view.focus(); })()"
    )
    tab.write("m")
    tab.until("document.querySelector('.cm-tooltip-autocomplete')")
    labels = tab.value("[...document.querySelectorAll('.cm-completionLabel')].map(each => each.textContent)")
    assert {"m1", "m2"} <= set(labels)
    tab.press("Escape")
    tab.value("editor.set(TEXT_OF_THE_FILE)".replace("TEXT_OF_THE_FILE", json.dumps(TEXT)))
    tab.until("(document.querySelector('#save').disabled = true)")


@in_slow_run
@needs("chromium")
def test_the_page_can_be_used_by_all(seen):
    """axe finds nothing against WCAG A and AA, with a problem shown and without."""
    axe = (Path(axe_core_python.__file__).parent / "axe.min.js").read_text("utf-8")
    for text in (TEXT, TEXT.replace('mass = "m1"', 'mass = "nothing"')):
        if text != TEXT:
            seen.saved(text)
        seen.tab.value(axe)
        found = seen.tab.value(
            "axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'], iframes: false })"
            ".then(done => done.violations.map(each => [each.id, each.nodes.map(node => node.html.slice(0, 160))]))"
        )
        assert found == []


@needs("chromium")
def test_what_somebody_else_saved_is_taken_or_asked_for(seen):
    """Where nothing is typed the pane takes it; where something is, saving is refused and both ways are offered."""
    tab = seen.tab
    seen.saved(f"# theirs\n{TEXT}")
    tab.until("document.querySelector('.cm-content').innerText.startsWith('# theirs')")
    tab.click(".cm-line:nth-child(1)")
    tab.write("mine ")
    seen.saved(f"# again\n{TEXT}")
    tab.until("!document.querySelector('#reload').hidden")
    tab.click("#save")
    tab.until("document.querySelector('#note').textContent === 'the file changed meanwhile'")
    assert seen.path.read_text() == f"# again\n{TEXT}"
    tab.click("#overwrite")
    tab.until("document.querySelector('#reload').hidden")
    assert "mine" in seen.path.read_text() and "again" not in seen.path.read_text()


@needs("chromium")
def test_one_begins_with_an_example(seen):
    """Chosen from the list it stands in the pane, and in the file when it is saved."""
    revision = seen.revision()
    seen.tab.until("document.querySelectorAll('#examples option').length > 20")
    seen.tab.value(
        "(() => { const list = document.querySelector('#examples'); list.value = 'four_bar';"
        " list.dispatchEvent(new Event('change')); })()"
    )
    seen.tab.until("!document.querySelector('#save').disabled")
    seen.tab.press("s", control=True)
    seen.shown(revision + 1)
    assert seen.path.read_text() == (MODELS / "four_bar.toml").read_text()


@needs("chromium")
@pytest.mark.parametrize("name", ["double_pendulum", "gerber_beam", "rolling_disc_and_bar"])
def test_nothing_leaves_the_window(seen, name):
    """360 px wide the page does not scroll sideways."""
    text = (MODELS / f"{name}.toml").read_text()
    if text != TEXT:
        seen.saved(text)
    try:
        seen.tab.size(360)
        assert seen.tab.value("document.documentElement.scrollWidth") <= 360
        assert seen.tab.console == []
    finally:
        seen.tab.size(1280)


@needs("chromium")
def test_the_motion_is_a_page_that_checks_itself(seen):
    """It moves the model by itself, and asks for nothing."""
    before = seen.live.address
    seen.tab.open(seen.tab.value("document.querySelector('iframe').src"))
    seen.tab.until("document.body.dataset.selfcheck === 'ok'")
    assert seen.tab.console == []
    seen.tab.open(before)


@needs("chromium")
def test_sliders_stay_where_they_are_over_a_save(seen):
    """What was moved stays moved, but for a value that the file has changed meanwhile."""
    tab = seen.tab
    tab.until("held.page && Object.keys(held.values).length")
    moved = json.dumps({"given": {"m1": 3, "theta1": 0.4}, "t": 0.5})
    tab.value(f"document.querySelector('iframe').contentWindow.postMessage({moved}, '*')")
    tab.until("held.given.m1 === 3 && held.given.theta1 === 0.4")
    for old, new, left in (
        ("0.5", "0.6", {"m1": 3, "theta1": 0.4}),
        ("m1 = { value = 1.0", "m1 = { value = 2", {"theta1": 0.4}),
    ):
        before = tab.value("held.page")
        seen.saved(seen.path.read_text().replace(old, new, 1))
        tab.until(f"held.page !== {json.dumps(before)}")
        tab.until(f"Object.keys(held.given).join() === '{','.join(left)}'")


def test_values_of_the_command_stay_in_the_place_of_the_files(file):
    """--set over a save; the name gone from the file is told."""
    with live(file, "--set", "m1=3") as found:
        page = found.until(1)["motion"]["digest"]
        file.write_text(file.read_text().replace("m1 = { value = 1.0", "m1 = { value = 2.0"))
        assert found.until(2)["motion"]["digest"] == page
        file.write_text(file.read_text().replace("m1", "m9"))
        state = found.until(3)
        assert "m1" in state["problems"][0]["what"] and state["figure"]


@in_slow_run
@needs("npm")
def test_the_built_editor_is_that_of_its_source(tmp_path):
    """`npm ci` and `npm run build` in another folder give the same bytes."""
    for name in ("package.json", "package-lock.json", "editor.mjs"):
        shutil.copy(EDITOR / name, tmp_path)
    fetched = subprocess.run(
        ["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=tmp_path, capture_output=True, text=True
    )
    if fetched.returncode:
        pytest.skip(f"the packages cannot be fetched: {fetched.stderr[-200:]}")
    subprocess.run(["npm", "run", "build"], cwd=tmp_path, check=True, capture_output=True)
    built, kept = ((folder / "editor.js").read_bytes() for folder in (tmp_path, EDITOR))
    assert sha256(built).hexdigest() == sha256(kept).hexdigest()
    locked = json.loads((EDITOR / "package-lock.json").read_text())["packages"]
    named = (EDITOR / "LICENSES.txt").read_text()
    bundled = [name.removeprefix("node_modules/") for name in locked if name and "esbuild" not in name]
    assert [name for name in bundled if f"{name} {locked[f'node_modules/{name}']['version']}" not in named] == []
