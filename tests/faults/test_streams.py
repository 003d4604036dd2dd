"""Streams that are closed, full, of another encoding or without a reader; no memory, no home: a sentence, a code."""

from __future__ import annotations

import itertools
import json
import os
import signal
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

import pytest
from forked import forked, needs_fork
from slow_run import usual

from eomgen import pipeline
from eomgen.cli_common import IN_ASCII, in_ascii
from eomgen.disk_cache import _own_folder
from eomgen.errors import visible
from eomgen.simulation import integrator

pytestmark = [pytest.mark.slow, needs_fork]
pwd = pytest.importorskip("pwd", reason="users of POSIX")
resource = pytest.importorskip("resource", reason="limits of POSIX")

ROOT = Path(__file__).parent.parent.parent
PENDULUM = str(ROOT / "models" / "simple_pendulum.toml")
FRAME = ("statics", str(ROOT / "models" / "a_frame.toml"), "--no-certify")
RUN = ("simulate", PENDULUM, "--time", "0.1", "--target", "numpy", "--no-certify")
VERBS = [("check", PENDULUM), ("derive", PENDULUM, "--no-certify"), RUN, ("schema",), ("--help",), ("--version",)]
needs_full = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full on this system")


@cache
def in_utf_8(*more):
    """What a stream of UTF-8 shows of FRAME."""
    return forked((*FRAME, *more))


@needs_full
@pytest.mark.parametrize("words", VERBS, ids=lambda words: words[0])
def test_a_full_stdout_is_a_sentence_and_exit_code_74(words):
    """Never 1, which says that the model is wrong."""
    ended = forked(words, streams={1: "/dev/full"})
    assert (ended.code, ended.said) == (74, "stdout cannot be written: No space left on device\n")


@pytest.mark.parametrize("words", VERBS, ids=lambda words: words[0])
def test_a_closed_stdout_is_a_sentence_and_exit_code_74(words):
    """`eomgen derive MODEL >&-`."""
    ended = forked(words, closed=[1])
    assert (ended.code, ended.said) == (74, "stdout cannot be written: it is closed\n")


def test_a_file_is_written_whole_though_all_streams_are_closed(tmp_path):
    """No file gets the number of a stream, and with it what the stream should have shown."""
    path = tmp_path / "run.csv"
    assert forked((*RUN, "-o", str(path)), closed=[0, 1, 2]).code == 0
    lines = path.read_text().splitlines()
    assert len(lines) == 1002 and all(line.count(",") == lines[0].count(",") for line in lines)


@needs_full
@pytest.mark.parametrize("how", [{"closed": [2]}, {"streams": {2: "/dev/full"}}], ids=["closed", "full"])
def test_what_cannot_be_said_changes_no_exit_code(how):
    """stderr closed or full: the result and the code of the model's error are the same."""
    assert forked(("check", PENDULUM), **how).out == forked(("check", PENDULUM)).out
    assert forked(("check", __file__), **how).code == 1
    assert forked(("derive",), **how).code == 2


def test_a_closed_stdin_is_wrong_usage():
    """`eomgen check - <&-`."""
    ended = forked(("check", "-"), closed=[0])
    assert ended.code == 2 and "it is closed" in ended.said


def test_a_reader_that_went_away_is_no_error_message():
    """Exit code 141, as a shell has it, and silence."""
    reader, writer = os.pipe()
    os.close(reader)
    ended = forked(("schema",), lambda: os.dup2(writer, 1))
    os.close(writer)
    assert (ended.code, ended.said) == (141, "")


@needs_full
@pytest.mark.parametrize("words", [("schema", "1>/dev/full"), ("--help", "1>&-"), ("check", "nofile", "2>&-")])
def test_the_end_of_the_process_adds_nothing(words):
    """A process from the shell: the interpreter finds nothing left in a buffer that cannot be written."""
    command = " ".join([sys.executable, "-m", "eomgen", *words])
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == (2 if words[0] == "check" else 74)
    assert done.stderr.count("\n") == (0 if words[0] == "check" else 1)


def test_the_process_ends_with_its_code_and_what_others_asked_for_at_its_end():
    """run() = main(), then what `atexit` holds, and the exit code, whether the verb went well or not."""
    code = "import atexit, sys; from eomgen.__main__ import run; atexit.register(print, 'last'); run()"
    for words, expected in ((["schema"], 0), (["check", "nofile"], 2)):
        done = subprocess.run(
            [sys.executable, "-c", code, *words], capture_output=True, text=True, cwd=ROOT, check=False
        )
        assert done.returncode == expected
        assert done.stdout.endswith("last\n")


def test_who_watches_the_process_has_the_last_word(tmp_path):
    """`python -m cProfile -o FILE -m eomgen ...` writes its file."""
    command = [sys.executable, "-m", "cProfile", "-o", str(tmp_path / "p"), "-m", "eomgen", "schema"]
    assert subprocess.run(command, capture_output=True, cwd=ROOT, check=False).returncode == 0
    assert (tmp_path / "p").stat().st_size


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
def test_what_a_stream_cannot_show_is_written_in_ascii(encoding):
    """δθ is dtheta; JSON is the same object everywhere; nothing is lost where letters are there."""
    shown, whole = forked(FRAME, encoding=encoding), in_utf_8().out.decode()
    assert (shown.code, shown.said) == (0, "")
    assert "δθ" in whole and "1. Data" in whole
    assert shown.out.decode(encoding) == "".join(
        in_ascii(c) if ord(c) > 255 or (encoding == "ascii" and not c.isascii()) else c for c in whole
    )
    machines = forked((*FRAME, "--json"), encoding=encoding).out, in_utf_8("--json").out
    assert machines[0] == machines[1] and machines[0].isascii()


def test_every_letter_has_a_form_in_ascii():
    """Greek letters by their names, signs by words, others by their number."""
    assert [in_ascii(c) for c in "θΩςé→漢"] == ["theta", "Omega", "sigma", "e", "->", "\\u6f22"]
    assert all(text.isascii() for text in IN_ASCII.values())


def test_nothing_that_steers_a_terminal_reaches_it(tmp_path):
    """Escapes, bells, returns and marks that turn the direction, of a name or of a path, are shown as what they are."""
    name = "A\x1b[31mred\x1b]0;title\x07\x9b1m \u202eback\u2066\u200b\ufeff"
    model = tmp_path / "m\x1b[2J.toml"
    model.write_text(f'eomgen = 1\nspace = "plane"\nname = {json.dumps(name)}\nbodies.b = {{ mass = 1 }}\nx = 1\n')
    good = tmp_path / "good.toml"
    good.write_text(model.read_text().replace("\nx = 1", ""))
    for ended in (forked(("check", str(model))), forked(("check", str(good))), forked(("check", str(good), "--json"))):
        text = (ended.out + ended.err).decode()
        assert visible(text) == text and text.isascii()
        assert "\\u001b[" in text
    assert json.loads(forked(("check", str(good), "--json")).out)["name"] == name
    for form in (".txt", ".md", ".tex"):
        path = tmp_path / f"shown{form}"
        assert forked(("inertia", str(good), "-o", str(path))).code == 0
        assert visible(path.read_text()) == path.read_text()


def test_too_little_memory_is_a_sentence():
    """A limit on the address space below what the samples take: exit code 3."""

    def limited():
        used = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
        resource.setrlimit(resource.RLIMIT_AS, (used + 60_000_000,) * 2)

    if not Path("/proc/self/statm").exists():
        pytest.skip("no /proc to learn the memory in use from")
    ended = forked((*RUN, "--samples", "5000000"), limited)
    assert ended.code == 3 and ended.said.startswith("there is not enough memory for that\nfix: ")


def test_more_samples_than_there_can_be_are_refused():
    """--samples 1000000000000: the limit is named, at once."""
    ended = forked((*RUN, "--samples", "1000000000000"))
    assert ended.code == 2 and "at most" in ended.said


@pytest.mark.parametrize("home", usual([None, "/nowhere/at/all", "", "relative"], 2, 1))
def test_a_user_without_a_home_loses_nothing(home, tmp_path):
    """HOME away, empty, or no folder, and nobody in the list of users: runs go on, and no folder `~` is made."""

    def nobody(uid):
        raise KeyError(uid)

    def homeless():
        os.chdir(tmp_path)
        os.environ.pop("XDG_CACHE_HOME", None)
        os.environ.pop("HOME", None)
        if home is not None:
            os.environ["HOME"] = home
        pwd.getpwuid = nobody
        _own_folder.cache_clear()

    for words in (("simulate", PENDULUM, "--time", "0.1", "--no-certify"), ("doctor",)):
        assert forked(words, homeless).code == 0
    assert [path.name for path in tmp_path.iterdir()] in ([], ["relative"])


def test_a_mistake_of_ours_says_so_and_writes_a_report(tmp_path):
    """Exit code 70; the report names the version, the command and the place; --json has it too."""

    def broken():
        tempfile.tempdir = str(tmp_path)
        pipeline.derive = lambda *_, **__: 1 / 0

    for words in (("derive", PENDULUM), ("derive", PENDULUM, "--json")):
        ended = forked(words, broken)
        assert ended.code == 70
        assert "internal error: ZeroDivisionError: division by zero" in ended.said
        assert "a mistake of eomgen, not of your model" in ended.said
    error = json.loads(ended.out)["error"]
    assert error["exit_code"] == 70 and "ZeroDivisionError" in error["problems"][0]["what"]
    reports = list(tmp_path.iterdir())
    assert len(reports) == 2 and all(str(path) in forked(("derive", PENDULUM), broken).said or path for path in reports)
    assert all("test_streams.py" in path.read_text() and "eomgen derive" in path.read_text() for path in reports)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupted_run_keeps_what_it_has(number, tmp_path):
    """Exit code 130; the file holds whole rows up to the instant that the message names; --json is JSON."""

    def soon():
        """The signal comes at the 300th step, however fast the machine is, under nohup too."""
        signal.signal(number, signal.SIG_DFL if number != signal.SIGINT else signal.default_int_handler)
        steps, requested = itertools.count(1), integrator.check_patience

        def counted():
            if next(steps) == 300:
                os.kill(os.getpid(), number)
            requested()

        integrator.check_patience = counted

    words = ("simulate", PENDULUM, "--time", "1e5", "--samples", "1000000", "--target", "numpy")
    path = tmp_path / "run.csv"
    ended = forked((*words, "-o", str(path)), soon)
    assert ended.code == 130
    assert "Interrupted at t = " in ended.said and "not proven" not in ended.said and "interrupted" in ended.said
    rows = [[float(x) for x in line.split(",")] for line in path.read_text().splitlines()[1:]]
    assert len(rows) > 10 and len({len(row) for row in rows}) == 1
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.csv"]
    found = json.loads(forked((*words[:-4], "--samples", "100", "--target", "numpy", "--json"), soon).out)
    assert found["status"] == "interrupted" and found["trajectory"]["t"]


def test_an_interrupted_derivation_says_so(monkeypatch):
    """Exit code 130, one word, JSON where it is asked for."""

    def stopped():
        def derive(*_, **__):
            os.kill(os.getpid(), signal.SIGINT)

        pipeline.derive = derive

    ended = forked(("derive", PENDULUM, "--json"), stopped)
    assert (ended.code, ended.said.strip()) == (130, "interrupted, nothing is kept")
    assert json.loads(ended.out)["error"]["exit_code"] == 130


@pytest.mark.parametrize("verb", ["report", "play"])
def test_a_page_of_an_interrupted_run_is_not_written(verb, monkeypatch, tmp_path):
    """Who stops the motion stops the page too: exit 130, and no file"""
    from eomgen.frozen import with_fields
    from eomgen.runs import single_run as runs

    whole = runs.run
    monkeypatch.setattr(runs, "run", lambda *given, **how: with_fields(whole(*given, **how), ended="interrupted"))
    page = tmp_path / "page.html"
    ended = forked((verb, PENDULUM, "--time", "0.1", "-o", str(page)), lambda: None)
    assert ended.code == 130 and not page.exists()
