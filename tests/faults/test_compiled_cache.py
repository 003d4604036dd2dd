"""Compilers that hang, lie or write junk; entries of the cache that are not what they were: named, made anew."""

from __future__ import annotations

import os
import signal
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hand_made import cart_pole, pendulum

import eomgen
from eomgen import disk_cache
from eomgen.codegen import build, rhs
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.errors import RunFailed
from eomgen.resources import patience
from eomgen.simulation import many_runs as march

MODELS = Path(__file__).parent.parent.parent / "models"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(build.compiler() is None or not hasattr(os, "fork"), reason="no C compiler, or no POSIX"),
]

TEXT = "double twice(double x);\ndouble twice(double x) { return 2*x; }\n"
WRITES = 'while [ "$1" != "-o" ]; do shift; done; '
LIES = {
    "says that all is well": ("exit 0", "made nothing"),
    "writes junk": (f'{WRITES}echo junk > "$2"', "makes no library"),
    "writes nothing": (f'{WRITES}: > "$2"', "makes no library"),
    "makes a folder": (f'{WRITES}mkdir "$2"', "made nothing"),
    "leaves out a function": ('exec {cc} -Dtwice=once "$@"', "without the function 'twice'"),
    "makes a program": ('for a; do shift; [ "$a" = -shared ] || set -- "$@" "$a"; done; exec {cc} -c "$@"', "library"),
    "is killed": ("kill -SEGV $$", "ended with"),
    "complains without end": ("head -c 1000000 /dev/zero | tr '\\0' x >&2; exit 1", "failed: xxx"),
    "is no program": ("\x7fELF", "failed"),
}


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """A cache of this test's own."""
    monkeypatch.setattr(disk_cache.platformdirs, "user_cache_dir", lambda name: str(tmp_path / "cache"))
    return tmp_path / "cache"


def compiler(tmp_path: Path, monkeypatch, text: str) -> None:
    path = tmp_path / "fake-cc"
    path.write_text(f"#!/bin/sh\n{text.replace('{cc}', str(build.compiler()))}\n")
    path.chmod(0o755)
    monkeypatch.setenv("CC", str(path))
    monkeypatch.setattr(rhs, "_said", set())


@pytest.mark.parametrize("how", LIES)
def test_a_compiler_that_lies_is_named_and_numpy_runs(how, cache, tmp_path, monkeypatch, capsys):
    """One line on stderr, then the numbers of numpy; nothing half made stays in the cache."""
    text, word = LIES[how]
    compiler(tmp_path, monkeypatch, text)
    with pytest.raises(RunFailed, match=word) as refused:
        build.function_of(build.library(TEXT), "twice")
    assert "fake-cc" in str(refused.value) and len(str(refused.value)) < 3000
    if how != "leaves out a function":  # these are other functions' names
        assert RightHandSide.of(Program.right_hand_side(pendulum())).target == "numpy"
        assert capsys.readouterr().err.count("\n") == 1
        assert list(cache.iterdir()) == []


@pytest.mark.parametrize("then", ["wait", "exit 0"])
def test_a_compiler_that_hangs_is_ended_with_all_that_it_started(then, cache, tmp_path, monkeypatch):
    """A shell that waits for another process, or has left it, which holds its streams: both are gone by then."""
    compiler(tmp_path, monkeypatch, f"sleep 1000 & echo $! > {tmp_path}/child; {then}")
    begun = time.monotonic()
    with pytest.raises(RunFailed, match=r"did not come back: it did nothing for 0\.5 s"):
        build.library(TEXT, by=replace(build.C, patience=0.5))
    assert time.monotonic() - begun < 20 and list(cache.iterdir()) == []
    child = Path(f"/proc/{(tmp_path / 'child').read_text().strip()}/stat")
    assert not child.exists() or child.read_text().split()[2] == "Z"


def test_a_compiler_is_ended_by_its_own_work_and_not_by_the_clock(cache, tmp_path, monkeypatch):
    """One that waits for its turn as a loaded machine lets it is awaited; one that works on and on is not"""
    compiler(tmp_path, monkeypatch, 'sleep 1; exec cc "$@"')
    build.library(TEXT, by=replace(build.C, patience=2.5))
    compiler(tmp_path, monkeypatch, "while :; do :; done")
    with pytest.raises(RunFailed, match=r"did not come back within 0\.5 s of its own work"):
        build.library(TEXT + "/* again */", by=replace(build.C, patience=0.5))


def test_a_compiler_leaves_half_of_the_patience_to_what_runs_without_it(cache, tmp_path, monkeypatch):
    """With 2 s to wait it has 1 s, once: what was given up is not tried again in this process"""
    compiler(tmp_path, monkeypatch, "sleep 1000")
    with patience(2.0):
        begun = time.monotonic()
        for _ in range(2):
            with pytest.raises(RunFailed, match="half of the time to wait"):
                build.library(TEXT + "/* awaited */")
        assert 0.9 < time.monotonic() - begun < 1.9


@pytest.mark.parametrize("limit", [3000, 20_000])
def test_what_no_compiler_makes_runs_without_it(limit, cache, tmp_path, monkeypatch, capsys):
    """Texts over a length fail: the rates in numpy, or steps in Python; the same numbers, each remark once"""
    usual = eomgen.simulate(MODELS / "four_bar.toml", time=0.3, samples=4)
    text = f'for a in "$@"; do case "$a" in *.c) n=$(wc -c < "$a");; esac; done; [ $n -lt {limit} ] && exec cc "$@"; '
    compiler(tmp_path, monkeypatch, text + "echo too long >&2; exit 1")
    march.library_of_march.cache_clear()
    for _ in range(2):
        found = eomgen.simulate(eomgen.load(MODELS / "four_bar.toml"), time=0.3, samples=4)
        assert np.allclose(found.x, usual.x, rtol=0, atol=1e-6) and found.ok
    many = eomgen.simulate_many(MODELS / "four_bar.toml", time=0.3, samples=4, parameters={"m": [1, 1]})
    assert set(many.status) == {"finished"}
    said = capsys.readouterr().err.splitlines()
    assert said and len(said) == len(set(said)) and all("the C compiler failed: too long: " in line for line in said)


def test_an_entry_of_which_one_bit_is_turned_is_never_loaded(cache, monkeypatch):
    """At each of many places, those of the code among them."""
    with monkeypatch.context() as unloaded:
        unloaded.setattr(build.ctypes, "CDLL", lambda path: None)
        build.library(TEXT)
    (path,) = cache.iterdir()
    whole = path.read_bytes()
    for at in range(0, len(whole), len(whole) // 200):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        assert disk_cache.content_of(path) is None
    path.write_bytes(whole + b"\0")
    assert disk_cache.content_of(path) is None
    assert build.library(TEXT).twice is not None and path.read_bytes() == whole


def test_two_processes_compile_the_same_at_once(cache):
    """Both get a function that is right; one entry stays."""
    program, children = Program.right_hand_side(cart_pole(F=0)), []
    for _ in range(3):
        if (pid := os.fork()) == 0:
            found = RightHandSide.of(program, "c")(0.0, [0.0, 0.1, 0.0, 0.0], [1.0, 1.0, 1.0, 9.81])
            os._exit(0 if abs(found[2]) > 0 else 1)
        children.append(pid)
    assert [os.waitpid(pid, 0)[1] for pid in children] == [0, 0, 0]
    assert [path.suffix for path in cache.iterdir()] == [".so"]


def test_a_process_that_is_killed_while_it_compiles_leaves_nothing_for_long(cache, tmp_path, monkeypatch):
    """One folder beside; the next compilation takes it away."""
    with monkeypatch.context() as slow:
        compiler(tmp_path, slow, f"touch {tmp_path}/begun; sleep 5")
        if (pid := os.fork()) == 0:
            build.library(TEXT)
        while not (tmp_path / "begun").exists():
            time.sleep(0.01)
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
    assert len(list(cache.iterdir())) == 1
    build.library(TEXT)
    assert [path.suffix for path in cache.iterdir()] == [".so"]


def test_old_entries_go(cache, monkeypatch):
    """What nobody has used for long; the oldest where there are too many; what is used is young again."""
    names = [f"double f{k}(void);\ndouble f{k}(void) {{ return {k}; }}\n" for k in range(4)]
    paths = []
    for text in names[:3]:
        build.library(text)
        paths.append(next(path for path in cache.iterdir() if path not in paths))
    for days, path in ((100, paths[0]), (2, paths[1]), (1, paths[2])):
        os.utime(path, (time.time() - 86_400 * days,) * 2)
    build.library(names[1])
    monkeypatch.setattr(disk_cache, "MOST_KEPT", 2)
    build.library(names[3])
    left = set(cache.iterdir())
    assert len(left) == 2 and paths[1] in left
