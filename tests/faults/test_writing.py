"""Files are whole or not there: a full disk and a signal at every write of a run, two writers, what a kill left."""

from __future__ import annotations

import errno
import mmap
import os
import resource
import signal
import sys
import time
from pathlib import Path

import pytest
from forked import forked, needs_fork

from eomgen import files
from eomgen.errors import WriteFailed

pytestmark = [pytest.mark.slow, needs_fork]

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
EVERYWHERE = ("text", "csv", "code")  # a file, a long one, several together: one writer for all kinds
EVENTS = {"open", "os.rename", "os.mkdir", "os.rmdir", "os.remove", "os.chmod", "os.scandir", "os.listdir"}
TAKES_ROOM = {"os.rename", "os.mkdir"}  # and what is opened to be written: these fail on a full disk


def command(kind: str, folder: Path) -> tuple[str, ...]:
    words, name = WRITES[kind]
    return (*words, str(folder / name))


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def left(folder: Path) -> list[str]:
    return [path.name for path in folder.rglob(".eomgen-*")]


COUNTED = mmap.mmap(-1, 1)  # shared with the processes that are forked


def at_event(folder: Path, number: int, act, full: bool = False):
    """Before the n-th event of the file system below a folder, done once: the system calls of Python, and fsync."""

    def one(*_):
        COUNTED[0] += 1
        if COUNTED[0] == number:
            act()

    def heard(event, arguments):
        written = event == "open" and bool(arguments[2] & (os.O_WRONLY | os.O_RDWR))
        if (event in TAKES_ROOM or written if full else event in EVENTS) and any(
            str(folder) in str(each) for each in arguments
        ):
            one()

    def prepare():
        COUNTED[0] = 0
        real = os.fsync
        os.fsync = lambda handle: (one(), real(handle))[1]
        sys.addaudithook(heard)

    return prepare


def events(kind: str, folder: Path, full: bool = False) -> int:
    """How many there are in a run that nothing disturbs."""
    before = contents(folder)
    assert forked(command(kind, folder), at_event(folder, 0, lambda: None, full)).code == 0
    for name, data in before.items():
        (folder / name).write_bytes(data)
    assert COUNTED[0] >= 4
    return COUNTED[0]


def raised(number: int):
    def act():
        raise OSError(number, os.strerror(number))

    return act


def killed(number: int):
    return lambda: os.kill(os.getpid(), number)


def old_and_new(kind: str, tmp_path: Path):
    """A folder with old files, what they are, and what the verb makes of them."""
    folder, reference = tmp_path / "out", tmp_path / "reference"
    for place in (folder, reference):
        place.mkdir()
    assert forked(command(kind, reference)).code == 0
    new = contents(reference)
    for name in new:
        (folder / name).write_bytes(b"old")
    return folder, dict.fromkeys(new, b"old"), new


def is_whole(name: str, found: bytes, old: dict[str, bytes], new: dict[str, bytes]) -> bool:
    return found in (old[name], new[name])


@pytest.mark.parametrize("kind", EVERYWHERE)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL], ids=["INT", "TERM", "KILL"])
def test_a_signal_at_any_write_leaves_whole_files(kind, number, tmp_path):
    """INT, TERM: exit code 130, all old or all new, nothing else there. KILL: each file whole, one folder beside."""
    folder, old, new = old_and_new(kind, tmp_path)
    for n in range(1, events(kind, folder) + 1):
        ended = forked(command(kind, folder), at_event(folder, n, killed(number)))
        found = {name: data for name, data in contents(folder).items() if not name.startswith(".eomgen-")}
        assert found.keys() == new.keys() and all(is_whole(name, data, old, new) for name, data in found.items())
        if number == signal.SIGKILL:
            assert ended.code == -signal.SIGKILL and len(left(folder)) <= 1
            files.write(folder / next(iter(new)), b"old")
        else:
            assert ended.code == 130 and "interrupted" in ended.said
            assert len({data == b"old" for data in found.values()}) == 1
        assert left(folder) == []
        for name in new:
            (folder / name).write_bytes(b"old")


@pytest.mark.parametrize("kind", EVERYWHERE)
def test_a_disk_that_is_full_at_any_write_is_a_sentence(kind, tmp_path):
    """ENOSPC at the n-th system call: exit code 74, the old files, nothing beside; each call is tried."""
    folder, old, new = old_and_new(kind, tmp_path)
    refused = 0
    for n in range(1, events(kind, folder, full=True) + 1):
        ended = forked(command(kind, folder), at_event(folder, n, raised(errno.ENOSPC), full=True))
        found = contents(folder)
        assert left(folder) == [] and all(is_whole(name, data, old, new) for name, data in found.items())
        assert found.keys() == new.keys()
        if ended.code == 74:
            assert "cannot be written: No space left on device" in ended.said
            refused += 1
        for name in new:
            (folder / name).write_bytes(b"old")
    assert refused >= 3


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
    os.close(silent)
    if (pid := os.fork()) == 0:
        fifo.write_text("eomgen = 1\nbad\n")
        os._exit(0)
    ended = forked(("check", str(fifo)))
    os.waitpid(pid, 0)
    assert ended.code == 1 and f"{fifo}:2:" in ended.said
    assert forked(("check", str(tmp_path))).code == 2
    assert time.process_time() - begun < 5


def test_a_file_is_on_the_disk_before_it_takes_the_place_of_the_old_one(tmp_path, monkeypatch):
    """fsync of the file, then rename: else a machine that stops between the two leaves an empty file."""
    done, sync, move = [], os.fsync, os.replace
    monkeypatch.setattr(os, "fsync", lambda handle: (done.append("synced"), sync(handle)))
    monkeypatch.setattr(os, "replace", lambda *places: (done.append("moved"), move(*places)))
    files.write(tmp_path / "result.txt", "new")
    assert done[: done.index("moved")] == ["synced"]
