"""Files are whole or not there: a full disk and a signal at every write of a run, two writers, what a kill left."""

from __future__ import annotations

import errno
import json
import mmap
import os
import pickle
import shutil
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import click
import pytest
from forked import forked, needs_fork
from slow_run import sampled, usual

from eomgen import files
from eomgen.cli import main
from eomgen.cli_common import Lasting
from eomgen.errors import WriteFailed, visible

pytestmark = [pytest.mark.slow, needs_fork]
resource = pytest.importorskip("resource", reason="limits of POSIX")

ROOT = Path(__file__).parent.parent.parent
PENDULUM = str(ROOT / "models" / "simple_pendulum.toml")
RUN = ("simulate", PENDULUM, "--time", "0.1", "--samples", "5", "--target", "numpy", "--no-certify")
WRITES = {
    "text": (("check", PENDULUM, "-o"), "r.txt"),
    "csv": ((*RUN, "-o"), "r.csv"),
    "npz": ((*RUN, "-o"), "r.npz"),
    "picture": ((*RUN, "--plot"), "r.png"),
    "report": (("report", PENDULUM, "--no-certify", "--without", "figure,plots,motion,downloads", "-o"), "r.md"),
    "page": (("play", PENDULUM, "--time", "0.1", "--no-certify", "-o"), "r.html"),
    "code": (("codegen", PENDULUM, "--target", "numpy", "--no-certify", "-o"), "."),
}
EVENTS = {"open", "os.rename", "os.mkdir", "os.rmdir", "os.remove", "os.chmod", "os.scandir", "os.listdir"}
TAKES_ROOM = {"os.rename", "os.mkdir"}  # and what is opened to be written: these fail on a full disk
ENDINGS = ("", ".txt", ".md", ".csv", ".png", ".html", ".toml", ".urdf")  # of what a verb may write; the first it takes
ONE_BY_ONE = (
    "check",
    "simulate",
    "codegen",
)  # a file, a long one, several together: each fault at each of their events
READS_AGAIN = ("plan.json", "ledger.sqlite")  # by which the next run of a verb goes on
ROBOT = """<robot name="r\u202e\x7f"><link name="base"/><link name="arm"><inertial><mass value="2"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint></robot>"""
STEERING = "A\x1b[31mred\x1b]0;t\x07\u202eback\u2066=cmd"  # a name that a terminal or an editor must not get
MEASURED = "t,theta,theta',theta''\n" + "".join(f"{k},{k % 3},{k % 2},{k % 5}\n" for k in range(9))


def ways() -> list[tuple[str, str]]:
    """(verb, option) of every option under which a verb of the command line writes; "" where it needs none.

    What lasts until somebody ends it writes nothing of its own: `live` and `lsp` answer who asks.
    """
    found = [
        (verb, max(parameter.opts, key=len))
        for verb, command in main.commands.items()
        for parameter in command.params
        if isinstance(parameter.type, click.Path) and not parameter.type.exists
    ]
    ends = [verb for verb, command in main.commands.items() if not isinstance(command, Lasting)]
    return found + [(verb, "") for verb in ends if verb not in dict(found)]


def words_of(verb: str, option: str, path: Path, given: dict[str, str]) -> list[str]:
    """A short command that writes there: of what it takes, what is given below its name."""
    words = [verb]
    for parameter in main.commands[verb].params:
        name = max(parameter.opts, key=len)
        if name in given:
            words += [given[name]] if isinstance(parameter, click.Argument) else [name, given[name]]
    return [*words, *([option, str(path)] if option else [str(path)])]


def command(kind: str, folder: Path) -> tuple[str, ...]:
    words, name = WRITES[kind]
    return (*words, str(folder / name))


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def left(folder: Path) -> list[str]:
    return [path.name for path in folder.rglob(".eomgen-*")]


def raised() -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def killed(number: int) -> Callable[[], None]:
    return lambda: os.kill(os.getpid(), number)


FAULTS: dict[str, Callable[[], None]] = {"full": raised}
FAULTS |= {name: killed(getattr(signal, name)) for name in ("SIGINT", "SIGTERM", "SIGKILL")}


@dataclass(frozen=True)
class Disturbed:
    """How a verb ended that was disturbed at one of its writes.

    Args:
        found: the files then; what it left beside is not among them.
        left: folders `.eomgen-*` then, and after the next write there.
    """

    fault: str
    code: int
    said: str
    found: dict[str, bytes]
    left: tuple[int, int]


class AtEachEvent:
    """At its first write below a folder the process becomes many, of which each meets a fault at an event of its own.

    The verb has computed by then, once for all of them. Events: system calls that Python tells of, and fsync.

    Args:
        faults: at each event the first of them, then the first is the last.
        near: a file beside the first that is written.
    """

    def __init__(
        self, folder: Path, old: dict[str, bytes], report: Path, faults: tuple[tuple[str, ...], ...], near: Path
    ) -> None:
        self.folder, self.old, self.report, self.faults, self.near = folder, old, report, faults, near
        self.fault, self.number, self.parts, self.busy = "", 0, False, False
        self.shared = mmap.mmap(-1, 4)  # how many events a process came to

    def __call__(self) -> None:
        real = os.fsync
        os.fsync = lambda handle: (self.one(), real(handle))[1]
        sys.addaudithook(self.heard)

    def heard(self, event: str, arguments: tuple) -> None:
        if self.busy or event not in EVENTS or not any(str(self.folder) in str(each) for each in arguments):
            return
        takes_room = event in TAKES_ROOM or (event == "open" and bool(arguments[2] & (os.O_WRONLY | os.O_RDWR)))
        if not self.parts and takes_room:
            self.parts = self.busy = True
            self.become_many()
        if self.fault != "full" or takes_room:
            self.one()

    def one(self) -> None:
        if self.busy:
            return
        count = int.from_bytes(self.shared[:], "little") + 1
        self.shared[:] = count.to_bytes(4, "little")
        if count == self.number:
            FAULTS[self.fault]()

    def become_many(self) -> None:
        signal.alarm(0)
        rows, said = [], self.report.with_suffix(".err")
        for faults in self.faults:
            self.number = 0
            while int.from_bytes(self.shared[:], "little") >= self.number:
                self.shared[:] = bytes(4)
                self.fault, self.number = faults[self.number % len(faults)], self.number + 1
                self.lay()
                if (pid := os.fork()) == 0:
                    os.dup2(os.open(said, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
                    self.busy = False
                    signal.alarm(60)
                    return
                code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
                found = {name: data for name, data in contents(self.folder).items() if ".eomgen-" not in name}
                beside = len(left(self.folder))
                files.write(self.near, b"")
                rows.append(Disturbed(self.fault, code, said.read_text(), found, (beside, len(left(self.folder)))))
        self.report.write_bytes(pickle.dumps(rows))
        os._exit(0)

    def lay(self) -> None:
        """The old files, and nothing else."""
        for path in contents(self.folder):
            (self.folder / path).unlink()
        for name, data in self.old.items():
            (self.folder / name).write_bytes(data)


@sampled(2)
@pytest.mark.parametrize(("verb", "option"), usual([*ways()], 6, 1))
def test_a_fault_at_any_write_of_any_verb_leaves_whole_files(verb, option, tmp_path):
    """INT, TERM: exit code 130, all old or all new. A full disk: 74, likewise. KILL: each file whole.

    Nothing stays beside, but after KILL one folder until the next write. And no file steers a terminal by a name.
    """
    folder, robot, data = tmp_path / "out", tmp_path / "robot.urdf", tmp_path / "measured.csv"
    robot.write_text(ROBOT)
    data.write_text(MEASURED)
    model = tmp_path / "pendulum.toml"
    text = Path(PENDULUM).read_text().replace('"Simple pendulum"', json.dumps(STEERING))
    pushed = (
        '[forces.push]\nkind = "force"\npoint = "bob.center"\nforce = [2, 0]\n'  # parameters follow from known forces
    )
    model.write_text(text + pushed * (verb == "identify"))
    given = dict.fromkeys(("model", "models", "where"), str(model)) | {"--time": "0.05"}
    given |= {"file": str(robot), "--data": str(data), "equations": "theta'' = -g/l*sin(theta)", "--target": "numpy"}
    given |= {"--ask": "theta", "--random": "l=uniform(1, 2)", "--frames": "1"}
    if verb == "reactions" and option != "--plot":  # says how much of the motion a picture shows
        del given["--time"]
    if option == "--output":
        given["--without"] = "figure,plots,motion,downloads"
    for ending in ENDINGS:
        folder.mkdir()
        words = words_of(verb, option, folder / f"r{ending}", given)
        code = forked(words).code
        new = contents(folder)
        if code == 0 and new:
            break
        assert code == 2, f"nothing is known of how to try '{' '.join(words)}': exit code {code}"
        shutil.rmtree(folder)
    assert new, f"{verb} {option} writes under none of {ENDINGS}"
    assert all(visible(text) == text for text in map(text_of, new.values()))
    kept = {name for name in new if Path(name).name in READS_AGAIN}
    report, verbs = tmp_path / "report", list(main.commands)
    old = (
        {name: data if name in kept else b"old" for name, data in new.items()} if option else {}
    )  # `new` makes new ones
    near = (folder / next(iter(new))).with_name("another")
    names = (*FAULTS, *FAULTS)[(turn := verbs.index(verb) % len(FAULTS)) : turn + len(FAULTS)]
    faults = tuple((name,) for name in names) if verb in ONE_BY_ONE and option == "--output" else (names,)
    disturbed = AtEachEvent(folder, old, report, faults, near)
    disturbed.lay()
    assert forked(words, disturbed).code == 0
    rows = pickle.loads(report.read_bytes())
    assert {row.fault for row in rows} == FAULTS.keys() and len(rows) >= 8
    for row in rows:
        judge(row, old, {name: data for name, data in new.items() if not name.endswith(".sqlite")})
    for fault, code in {"full": 74, "SIGINT": 130, "SIGTERM": 130, "SIGKILL": -signal.SIGKILL}.items():
        assert any(row.code == code for row in rows if row.fault == fault)


def text_of(data: bytes) -> str:
    """Of a file; "" where it holds none."""
    try:
        return "" if b"\0" in data else data.decode()
    except UnicodeDecodeError:
        return ""


def judge(row: Disturbed, old: dict[str, bytes], new: dict[str, bytes]) -> None:
    """Whole files after a fault, and a sentence."""
    assert old.keys() <= row.found.keys() <= old.keys() | new.keys() and row.left[1] == 0
    assert all(row.found.get(name) in (old.get(name), data) for name, data in new.items())
    assert "Traceback" not in row.said and "Exception ignored" not in row.said, row.said
    if row.fault == "SIGKILL":
        assert row.left[0] <= 1
        return
    reported = {74: "cannot be written: No space left on device", 130: "interrupted"}
    assert row.left[0] == 0 and row.code in (0, *reported) and reported.get(row.code, "") in row.said
    goes_on = any(name in READS_AGAIN for name in map(os.path.basename, old))  # its tables are made again each time
    if row.fault != "full" and not goes_on:
        assert len({row.found.get(name) == new[name] for name in new if old.get(name) in (None, b"old")}) == 1


@pytest.mark.parametrize("kind", [*WRITES, "new"])
@pytest.mark.parametrize("size", [0, 100])
def test_a_limit_of_the_file_size_is_a_full_disk(kind, size, tmp_path):
    """RLIMIT_FSIZE: exit code 74, and the folder that was made for the file is gone too."""
    folder = tmp_path / "deep" / "er"
    words = ("new", str(tmp_path / "fresh")) if kind == "new" else command(kind, folder)
    ended = forked(words, lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
    assert ended.code == 74
    assert list(tmp_path.iterdir()) == []


def test_what_a_killed_process_left_goes_and_what_another_writes_stays(tmp_path):
    """Only a folder that nobody holds is taken away, and nothing of another name."""
    dead, own, other = tmp_path / (".eomgen-" + "0" * 16), tmp_path / ".eomgen-notes", tmp_path / "x.txt"
    dead.mkdir()
    (dead / "half").write_text("half")
    own.mkdir()
    with files.beside(tmp_path) as held:
        assert not dead.exists()
        files.write(other, "one")
        assert held.is_dir() and own.is_dir() and other.read_text() == "one"
    assert sorted(path.name for path in tmp_path.iterdir()) == [".eomgen-notes", "x.txt"]


def test_two_processes_write_the_same_files_at_once(tmp_path):
    """Each file is one of both, whole; nothing beside."""
    texts = ["a" * 200_000, "b" * 200_000]
    children = []
    for text in texts:
        if (pid := os.fork()) == 0:
            for _ in range(20):
                files.write_all(tmp_path, {"x": text, "deep/y": text})
            os._exit(0)
        children.append(pid)
    end = time.monotonic() + 30
    while children and time.monotonic() < end:
        for name in ("x", "deep/y"):
            assert not (tmp_path / name).exists() or (tmp_path / name).read_text() in texts
        children = [pid for pid in children if os.waitpid(pid, os.WNOHANG) == (0, 0)]
    assert not children and left(tmp_path) == [] and {path.name for path in tmp_path.iterdir()} == {"x", "deep"}


def test_a_link_stays_a_link_and_a_file_keeps_its_mode(tmp_path):
    """What is written is the file at which a link points; 0600 stays 0600."""
    secret, link = tmp_path / "secret.txt", tmp_path / "link.txt"
    secret.write_text("old")
    secret.chmod(0o600)
    link.symlink_to(secret)
    files.write(link, "new")
    assert link.is_symlink() and secret.read_text() == "new" and secret.stat().st_mode & 0o777 == 0o600


def test_a_stream_is_written_as_it_is(tmp_path):
    """/dev/stdout and a pipe with a name take a result; a full device is exit code 74."""
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    reader = os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)
    assert forked((*RUN, "-o", str(fifo))).code == 0
    assert os.read(reader, 100).startswith(b"t,theta,")
    os.close(reader)
    if Path("/dev/full").exists():
        ended = forked((*RUN, "-o", "/dev/full"))
        assert ended.code == 74 and "/dev/full: the file cannot be written" in ended.said
    with pytest.raises(WriteFailed, match="Is a directory"):
        files.write(tmp_path, "text")


def test_reading_ends_where_a_model_would_be_too_long(tmp_path):
    """A device without an end, a pipe with a bad model, a silent pipe, 20 GB, a folder: exit code 1 or 2, soon."""
    fifo, sparse, csv = tmp_path / "fifo", tmp_path / "sparse.toml", tmp_path / "sparse.csv"
    os.mkfifo(fifo)
    for path in (sparse, csv):
        path.touch()
        os.truncate(path, 20_000_000_000)
    begun = time.process_time()
    room = 8 * 2**30

    def bounded():  # so that reading without end ends, and is seen
        resource.setrlimit(resource.RLIMIT_AS, (room, room))

    for path in ("/dev/zero", str(sparse)):
        ended = forked(("check", path), bounded)
        assert ended.code == 1 and "over 1 MB" in ended.said
    ended = forked(("check", "-"), lambda: (bounded(), os.dup2(os.open("/dev/zero", os.O_RDONLY), 0)))
    assert ended.code == 1 and "<stdin>:1:1: the file is over 1 MB" in ended.said
    assert forked((*RUN, "--follow", f"theta={csv}")).code == 2

    def quick():
        files.SILENCE = 0.2

    silent = os.open(fifo, os.O_RDWR)  # as stdin it has a writer, who says nothing
    for words in (("check", str(fifo)), ("check", "-")):
        ended = forked(words, lambda: (quick(), os.dup2(silent, 0)))
        assert ended.code == 1 and "nothing came through it" in ended.said
    awaited = time.monotonic()
    ended = forked(("check", "-", "--patience", "1"), lambda: os.dup2(silent, 0))
    assert ended.code == 3 and "given up after 1 s" in ended.said and time.monotonic() - awaited < files.SILENCE
    os.close(silent)
    if (pid := os.fork()) == 0:
        fifo.write_text("eomgen = 1\nbad\n")
        os._exit(0)
    ended = forked(("check", str(fifo)))
    os.waitpid(pid, 0)
    assert ended.code == 1 and f"{fifo}:2:" in ended.said
    assert forked(("check", str(tmp_path))).code == 2
    assert time.process_time() - begun < 30


def test_a_file_is_on_the_disk_before_it_takes_the_place_of_the_old_one(tmp_path, monkeypatch):
    """fsync of the file, then rename: else a machine that stops between the two leaves an empty file."""
    done, sync, move = [], os.fsync, os.replace
    monkeypatch.setattr(os, "fsync", lambda handle: (done.append("synced"), sync(handle)))
    monkeypatch.setattr(os, "replace", lambda *places: (done.append("moved"), move(*places)))
    files.write(tmp_path / "result.txt", "new")
    assert done[: done.index("moved")] == ["synced"]
