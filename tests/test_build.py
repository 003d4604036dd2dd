"""The compiler and its cache: a program is compiled once, and nobody needs a compiler."""

from __future__ import annotations

import threading

import pytest
from hand_made import cart_pole, pendulum

from eomgen.codegen import build, rhs
from eomgen.codegen.program import right_hand_side
from eomgen.codegen.rhs import compiled
from eomgen.errors import RunFailed, ToolMissing

needs_cc = pytest.mark.skipif(build.compiler() is None, reason="no C compiler")


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    """A cache folder of this test's own."""
    monkeypatch.setattr(build.platformdirs, "user_cache_dir", lambda name: str(tmp_path / "cache" / name))
    return tmp_path / "cache" / "eomgen"


@needs_cc
def test_a_program_is_compiled_once(own_cache, monkeypatch):
    """The same text is found in the cache; another text is compiled."""
    compiled(right_hand_side(pendulum()), "c")
    monkeypatch.setattr(build.subprocess, "run", lambda *a, **k: pytest.fail("compiled again"))
    assert compiled(right_hand_side(pendulum()), "c")(0, [0.0, 1.0], [1, 1, 1])[0] == 1
    assert [path.suffix for path in own_cache.iterdir()] == [".so"]


@needs_cc
def test_a_damaged_library_is_made_anew(own_cache, monkeypatch):
    """Half a file in the cache is no reason to fail."""
    text = "double twice(double x);\ndouble twice(double x) { return 2*x; }\n"
    with monkeypatch.context() as unloaded:
        unloaded.setattr(build.ctypes, "CDLL", lambda path: None)
        build.library(text)
    (path,) = own_cache.iterdir()
    path.write_bytes(b"half")
    assert build.library(text).twice is not None
    assert path.stat().st_size > len(b"half")


@needs_cc
def test_a_cache_that_cannot_be_written_is_done_without(tmp_path, monkeypatch):
    """A file in the folder's place: the library goes to a folder of this process."""
    (tmp_path / "taken").write_text("")
    monkeypatch.setattr(build.platformdirs, "user_cache_dir", lambda name: str(tmp_path / "taken" / name))
    assert compiled(right_hand_side(pendulum()), "c")(0, [0.0, 1.0], [1, 1, 1])[0] == 1


@needs_cc
def test_several_at_once_compile_into_one_cache(own_cache):
    """Renaming is atomic: everyone gets a whole library."""
    results: list = []
    program = right_hand_side(cart_pole(), {"F": 0})
    threads = [threading.Thread(target=lambda: results.append(compiled(program, "c"))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4 and len(list(own_cache.iterdir())) == 1


def test_without_a_compiler_numpy_is_taken_and_said_once(monkeypatch, capsys):
    """No compiler: one line on stderr in a process; an explicit "c" is an error with its mend."""
    monkeypatch.setattr(build.shutil, "which", lambda name: None)
    monkeypatch.setattr(build.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(rhs, "_said", set())
    program = right_hand_side(pendulum())
    assert build.compiler() is None
    assert compiled(program).target == compiled(program).target == "numpy"
    assert capsys.readouterr().err.count("no C compiler") == 1
    with pytest.raises(ToolMissing, match="no C compiler"):
        compiled(program, "c")


@needs_cc
def test_the_environment_chooses_the_compiler(tmp_path, monkeypatch, own_cache):
    """CC is obeyed, with its options; one that fails is an error for "c", and said on stderr otherwise."""
    monkeypatch.setenv("CC", f"{build.compiler()} -DNOTHING")
    assert compiled(right_hand_side(pendulum())).target == "c"
    fails = tmp_path / "fails"
    fails.write_text("#!/bin/sh\necho broken >&2\nexit 1\n")
    fails.chmod(0o755)
    monkeypatch.setenv("CC", str(fails))
    monkeypatch.setattr(rhs, "_said", set())
    with pytest.raises(RunFailed, match="broken"):
        compiled(right_hand_side(pendulum()), "c")
    assert compiled(right_hand_side(pendulum())).target == "numpy"
    monkeypatch.setenv("CC", "no-such-compiler")
    assert build.compiler() is None
