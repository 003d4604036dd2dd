"""The compiler and its cache: a program is compiled once, and nobody needs a compiler."""

from __future__ import annotations

import ctypes
import threading

import numpy as np
import pytest
from forked import needs_sh
from hand_made import cart_pole, pendulum

from eomgen import disk_cache
from eomgen.codegen import build, rhs
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.codegen.targets.c import c_text
from eomgen.errors import RunFailed, TextRefused, ToolMissing
from eomgen.symbolic.expression.derivatives import Symbols
from eomgen.symbolic.expression.formula import cos, sin, sqrt
from eomgen.symbolic.expression.graph import Graph

needs_cc = pytest.mark.skipif(build.compiler() is None, reason="no C compiler")


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    """A cache folder of this test's own."""
    monkeypatch.setattr(disk_cache.platformdirs, "user_cache_dir", lambda name: str(tmp_path / "cache" / name))
    return tmp_path / "cache" / "eomgen"


@pytest.mark.slow
@needs_cc
def test_a_program_is_compiled_once(own_cache, monkeypatch):
    """The same text is found in the cache; another text is compiled."""
    RightHandSide.of(Program.right_hand_side(pendulum()), "c")
    monkeypatch.setattr(build, "_ran", lambda command: pytest.fail("compiled again"))
    assert RightHandSide.of(Program.right_hand_side(pendulum()), "c")(0, [0.0, 1.0], [1, 1, 1])[0] == 1
    assert [path.suffix for path in own_cache.iterdir()] == [".so"]


@pytest.mark.slow
@needs_cc
def test_registers_of_this_machine_change_no_bit():
    """Each operation is rounded as by a compiler that knows none of them: no product is fused with a sum."""
    graph = Graph()
    x, u, k = (graph.symbol(name) for name in "xuk")
    parts = (x * u - k * x * x, sin(x) * cos(u) - k / (1 + u * u), sqrt(x * x + k * k * u * u))
    text = c_text(Program.of(parts, Symbols(graph, graph.symbol("t"), {"k": k}, {}, (x,), (u,), (), ())), "eomgen")
    plain, own = (build.library(text, by=by) for by in (build.C, build.of_this_machine()))
    assert build.of_this_machine().flags != build.C.flags
    rng = np.random.default_rng(1)
    for _ in range(100):
        values = [np.ascontiguousarray(rng.normal(size=n)) for n in (2, 1)]
        found = []
        for made in (plain, own):
            c, dx = np.zeros(64), np.zeros(3)
            at = [ctypes.c_void_p(each.ctypes.data) for each in (*values, c, dx)]
            made.eomgen_constants(at[1], at[2])
            made.eomgen_evaluate(ctypes.c_double(0.3), at[0], at[1], at[2], None, at[3])
            found.append(dx)
        assert np.all(np.isfinite(found[0])) and found[0].tobytes() == found[1].tobytes()


TEXT = "double twice(double x);\ndouble twice(double x) { return 2*x; }\n"


def cached(own_cache, monkeypatch):
    """TEXT's library in the cache, not yet loaded."""
    with monkeypatch.context() as unloaded:
        unloaded.setattr(build.ctypes, "CDLL", lambda path: None)
        build.library(TEXT)
    (path,) = own_cache.iterdir()
    return path


@pytest.mark.slow
@needs_cc
@pytest.mark.parametrize("size", [0, 4, 4096])
def test_a_damaged_library_is_made_anew(own_cache, monkeypatch, size):
    """A file that was cut off is not loaded: its pages behind the end would kill the process."""
    path = cached(own_cache, monkeypatch)
    whole = path.read_bytes()
    path.write_bytes(whole[:size])
    assert build.library(TEXT).twice is not None
    assert path.stat().st_size == len(whole) > 4096


@pytest.mark.slow
@needs_cc
@pytest.mark.parametrize("what", ["may be written", "belongs to another", "is another program"])
@needs_sh
def test_what_others_have_put_into_the_cache_is_not_loaded(own_cache, monkeypatch, what):
    """A file that others may write, or own, or have given another program's name, is compiled anew."""
    path = cached(own_cache, monkeypatch)
    if what == "may be written":
        path.chmod(0o777)
    elif what == "belongs to another":
        monkeypatch.setattr(disk_cache, "is_ours", lambda x: x != path or x.stat().st_mtime_ns != old)
    else:
        other = own_cache / f"{'0' * 32}-{path.name[33:]}"
        path.rename(other)
        assert disk_cache.content_of(other) is None
    old = path.stat().st_mtime_ns if path.exists() else 0
    ran = []
    real = build._ran
    monkeypatch.setattr(build, "_ran", lambda *how: (ran.append(how), real(*how))[1])
    assert build.library(TEXT).twice is not None
    assert len(ran) == 1 and not path.stat().st_mode & 0o022


@pytest.mark.slow
@needs_cc
@needs_sh
def test_a_cache_that_others_may_write_is_closed_and_one_of_another_is_not_used(own_cache, monkeypatch):
    """0777 becomes 0700; where the folder is another's, one of this process is taken."""
    cached(own_cache, monkeypatch)
    own_cache.chmod(0o777)
    assert disk_cache.cache_place() == own_cache and own_cache.stat().st_mode & 0o777 == 0o700
    monkeypatch.setattr(build.os, "getuid", lambda: own_cache.stat().st_uid + 1)
    assert disk_cache.cache_place() != own_cache


@pytest.mark.slow
@needs_cc
@pytest.mark.parametrize(
    ("command", "said"), [('cc "', "No closing quotation"), ("{}/junk", "makes no library"), ("{}/dies", "failed")]
)
@needs_sh
def test_a_compiler_that_does_not_work_is_one_line(own_cache, tmp_path, monkeypatch, capsys, command, said):
    """CC with an open quote, one that writes no library, one that is killed: a line on stderr, then numpy."""
    for name, text in (("junk", 'while [ "$1" != "-o" ]; do shift; done; echo junk > "$2"'), ("dies", "kill -SEGV $$")):
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("CC", command.format(tmp_path))
    monkeypatch.setattr(rhs, "_said", set())
    assert RightHandSide.of(Program.right_hand_side(pendulum())).target == "numpy"
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and said in err and "numpy" in err
    assert not own_cache.exists() or list(own_cache.iterdir()) == []


@pytest.mark.slow
@needs_cc
def test_a_cache_that_cannot_be_written_is_done_without(tmp_path, monkeypatch):
    """A file in the folder's place: the library goes to a folder of this process."""
    (tmp_path / "taken").write_text("")
    monkeypatch.setattr(disk_cache.platformdirs, "user_cache_dir", lambda name: str(tmp_path / "taken" / name))
    assert RightHandSide.of(Program.right_hand_side(pendulum()), "c")(0, [0.0, 1.0], [1, 1, 1])[0] == 1


@pytest.mark.slow
@needs_cc
def test_several_at_once_compile_into_one_cache(own_cache):
    """Renaming is atomic: everyone gets a whole library."""
    results: list = []
    program = Program.right_hand_side(cart_pole(F=0))
    threads = [threading.Thread(target=lambda: results.append(RightHandSide.of(program, "c"))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4 and len(list(own_cache.iterdir())) == 1


@pytest.mark.slow
def test_without_a_compiler_numpy_is_taken_and_said_once(monkeypatch, capsys):
    """No compiler: one line on stderr in a process; an explicit "c" is an error with its fix."""
    monkeypatch.setattr(build.shutil, "which", lambda name: None)
    monkeypatch.setattr(build.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(rhs, "_said", set())
    program = Program.right_hand_side(pendulum())
    assert build.compiler() is None
    assert RightHandSide.of(program).target == RightHandSide.of(program).target == "numpy"
    assert capsys.readouterr().err.count("no C compiler") == 1
    with pytest.raises(ToolMissing, match="no C compiler"):
        RightHandSide.of(program, "c")


@pytest.mark.slow
@needs_cc
@needs_sh
def test_the_environment_chooses_the_compiler(tmp_path, monkeypatch, own_cache):
    """CC is obeyed, with its options; one that fails is an error for "c", and said on stderr otherwise."""
    monkeypatch.setenv("CC", f"{build.compiler()} -DNOTHING")
    assert RightHandSide.of(Program.right_hand_side(pendulum())).target == "c"
    fails = tmp_path / "fails"
    fails.write_text("#!/bin/sh\necho broken >&2\nexit 1\n")
    fails.chmod(0o755)
    monkeypatch.setenv("CC", str(fails))
    monkeypatch.setattr(rhs, "_said", set())
    with pytest.raises(RunFailed, match="broken"):
        RightHandSide.of(Program.right_hand_side(pendulum()), "c")
    assert RightHandSide.of(Program.right_hand_side(pendulum())).target == "numpy"
    monkeypatch.setenv("CC", "no-such-compiler")
    assert build.compiler() is None


@pytest.mark.parametrize(("given", "expected"), [("cc", ("-O2",)), ("cc -O0", ()), ("cc -O3 -g", ())])
def test_the_environment_says_how_far_is_optimized(given, expected, monkeypatch):
    monkeypatch.setenv("CC", given)
    assert tuple(x for x in build.C.flags_of("", False) if x.startswith("-O")) == expected


@pytest.mark.slow
@needs_cc
def test_a_text_that_a_working_compiler_refuses_is_wrong(own_cache, monkeypatch):
    """A place in the text is named, and nothing is taken: TextRefused; of a compiler that takes nothing it is not."""
    with pytest.raises(TextRefused, match=r"program\.c:1:"):
        build.library("int eomgen_rhs(void) { return nothing; }")
    monkeypatch.setenv("CC", "false")
    with pytest.raises(RunFailed) as failed:
        build.library("int eomgen_rhs(void) { return nothing; }")
    assert not isinstance(failed.value, TextRefused)
