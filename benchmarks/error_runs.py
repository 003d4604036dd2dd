"""Runs of eomgen in forks of one process that has loaded it all; in a fork one function may be another.

An error by source text (planted_errors.py) is planted while its module is imported: each run imports the package anew.
Here all is imported once, and a fork gives the functions of the module's changed text their code, whoever holds them.
"""

from __future__ import annotations

import contextlib
import gc
import hashlib
import importlib
import io
import multiprocessing
import os
import pickle
import pkgutil
import resource
import tempfile
import time
import tomllib
import warnings
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import planted_errors as planted

PACKAGE = str(planted.ROOT / "eomgen") + "/"
LIST = Path(__file__).with_name("random_errors.toml")
SHORT = 5.0  # s of CPU that a run may take while it is traced
LONGEST, SLOWER = 12.0, 6  # s of CPU that a run with an error may take, and so many times what it takes without
MEMORY = 8 * 2**30  # bytes of address space
READ_AS_CODE = "codegen/kernels.py"  # whose functions are read, not called
Function = tuple[str, str]  # a file below eomgen/, and the qualified name of a function in it


@dataclass(frozen=True)
class Run:
    """Words of the command line as in planted_errors.py, or a program ("python: print(...)") that ends as they do.

    Args:
        files: name -> text of what stands in the run's folder @.
    """

    words: str
    model: str = ""
    files: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Calls:
    """Which functions a run calls, its exit code with what it says of that, and its CPU time [s]."""

    functions: frozenset[Function]
    code: int
    why: str
    cpu: float


def runs(path: Path = LIST) -> list[Run]:
    """The list: of each of its commands a run."""
    found = tomllib.loads(path.read_text(encoding="utf-8"))
    files = found["files"]
    lines = [line.strip() for text in found["runs"] for line in text.splitlines() if line.strip()]
    lines += [f"python: {text.strip()}" for text in found["programs"]]
    return [Run(line, files=_named(files, line)) for line in lines]


def _named(files: Mapping[str, str], line: str) -> dict[str, str]:
    return {name: text for name, text in files.items() if f"@/{name}" in line}


class Server:
    """This process, with all of eomgen loaded, and its functions by their files."""

    def __init__(self) -> None:
        _import_all()
        gc.collect()
        self.functions: dict[str, list[FunctionType]] = defaultdict(list)
        for x in gc.get_objects():
            if isinstance(x, FunctionType) and x.__code__.co_filename.startswith(PACKAGE):
                self.functions[x.__code__.co_filename].append(x)
        every = (x for mine in self.functions.values() for x in mine)
        codes = ((x, x.__code__) for x in every if not x.__code__.co_freevars)
        self.codes = [(x, code) for x, code in codes if not code.co_filename.endswith(READ_AS_CODE)]
        gc.freeze()

    def plant(self, file: str, text: str) -> None:
        """This process has the functions of this text; what modules hold since they were imported is as it was."""
        path = PACKAGE + file
        new = compile(text, path, "exec", dont_inherit=True)
        old = compile(Path(path).read_text(encoding="utf-8"), path, "exec", dont_inherit=True)
        changed = {_key(a): b for a, b in _pairs(old, new)}
        for x in self.functions[path]:
            if _key(x.__code__) in changed:
                x.__code__ = changed[_key(x.__code__)]

    def watched(self) -> set[Function]:
        """A set that fills with the functions that are called from now on: each tells its first call alone."""
        found: set[Function] = set()
        for x, code in self.codes:
            telling = _Telling(x, code, found)
            x.__code__ = _STUB.replace(co_consts=tuple(telling if y == "told" else y for y in _STUB.co_consts))
        return found

    def outcome(
        self, run: Run, cache: Path, error: tuple[str, str] | None = None, *, cpu: float = 0
    ) -> planted.Outcome:
        """What a run says, with an error (file, its text) or without."""
        found = _forked(_reported, self, run, cache, error, max(LONGEST, SLOWER * cpu))
        return found if isinstance(found, planted.Outcome) else planted.Outcome(139, str(found))

    def calls(self, run: Run, cache: Path) -> Calls:
        found = _forked(_watched, self, run, cache)
        return found if isinstance(found, Calls) else Calls(frozenset(), 139, str(found), 0.0)


def _import_all() -> None:
    import eomgen.cli

    for module in pkgutil.walk_packages(eomgen.__path__, "eomgen."):
        if "__main__" not in module.name:
            with contextlib.suppress(ModuleNotFoundError):
                importlib.import_module(module.name)


def _pairs(old: CodeType, new: CodeType) -> Iterable[tuple[CodeType, CodeType]]:
    """Codes that differ, of the functions in a module by their order."""
    inner = ([x for x in code.co_consts if isinstance(x, CodeType)] for code in (old, new))
    for a, b in zip(*inner, strict=True):
        if a != b:
            yield a, b
            yield from _pairs(a, b)


def _key(code: CodeType) -> tuple[str, int]:
    return code.co_qualname, code.co_firstlineno


class _Telling:
    """The first call of a function: it is told, and the function is what it was."""

    def __init__(self, function: FunctionType, code: CodeType, found: set[Function]) -> None:
        self.function, self.code, self.found = function, code, found

    def __call__(self, args: Any, words: Any) -> Any:
        self.function.__code__ = self.code
        self.found.add((self.code.co_filename.removeprefix(PACKAGE), self.code.co_qualname))
        return self.function(*args, **words)


def _stub() -> CodeType:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a text cannot be called: what it stands for can
        code = compile('lambda *args, **words: "told"(args, words)', "told", "eval").co_consts[0]
    assert isinstance(code, CodeType)
    return code


_STUB = _stub()


def _forked(work: Any, *args: Any) -> Any:
    """What work gives in a fork; a sentence where it ended without giving anything."""
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)

    def sent() -> None:
        there.send(work(*args))

    child = context.Process(target=sent)
    child.start()
    there.close()
    try:
        return here.recv()
    except EOFError:
        child.join()
        return f"the process ended by {child.exitcode}"
    finally:
        child.kill()
        child.join()


def _watched(server: Server, run: Run, cache: Path) -> Calls:
    start, calls = time.process_time(), server.watched()
    found = _reported(server, run, cache, None, SHORT)
    return Calls(frozenset(calls), found.code, found.why, time.process_time() - start)


def _reported(server: Server, run: Run, cache: Path, error: tuple[str, str] | None, cpu: float) -> planted.Outcome:
    """What a run says, in this process, which is for nothing else."""
    at = int(time.process_time() + cpu) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (at, at + 2))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    out, err = io.StringIO(), io.StringIO()
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        mine = Path(folder) / planted.CACHE
        if error is None:
            mine.mkdir()
            (mine / "eomgen").symlink_to(cache)
        else:
            (mine / "eomgen").mkdir(parents=True, mode=0o700)
            for path in cache.iterdir():
                os.link(path, mine / "eomgen" / path.name)
        os.environ |= {"XDG_CACHE_HOME": str(mine), "EOMGEN_FRESH": "1", "EOMGEN_PATIENCE": "600"}
        for name, text in run.files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        code = 0
        try:
            if error is not None:
                server.plant(*error)
            code = _code(run, folder, out)
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 1
        except BaseException as wrong:
            code = 70
            print(f"{type(wrong).__name__}: {wrong}", file=out)
        written = () if code else planted._written(Path(folder), run.words)
        given = {*run.files}
        return planted.Outcome(
            code,
            (out.getvalue() or err.getvalue()).replace(folder, "@"),
            tuple(each for each in written if each[0] not in given),
        )


def _code(run: Run, folder: str, out: io.StringIO) -> int:
    if run.words.startswith("python: "):
        text = run.words.removeprefix("python: ").replace("@", folder).replace("{MODELS}", str(planted.ROOT / "models"))
        exec(compile(text, "a run", "exec"), {})
        return 0
    for each in run.words.split(" then "):
        out.truncate(out.seek(0))
        if code := planted._code(each, run.model, folder, out):
            return code
    return 0


@dataclass(frozen=True)
class Kept:
    """A folder for what does not depend on an error.

    Args:
        compiled: code of compilers.
        package: the digest of all that the runs run.
    """

    folder: Path
    package: str

    @property
    def compiled(self) -> Path:
        place = self.folder / "compiled"
        place.mkdir(parents=True, exist_ok=True, mode=0o700)
        return place

    def calls(self, server: Server, chosen: Iterable[Run]) -> dict[str, tuple[Run, Calls]]:
        """What each run calls; those that fail without an error are told, and left out. Once made it is kept."""
        found: dict[str, tuple[Run, Calls]] = {}
        for run in chosen:
            calls = self._once(f"calls-{_named_by(run)}", lambda run=run: server.calls(run, self.compiled))
            if calls.code in planted.VERDICTS:
                found[run.words] = run, calls
            else:
                print(f"left out: {run.words[:100]}: {calls.code} {calls.why[-300:]}", flush=True)
        return found

    def right(self, server: Server, run: Run) -> planted.Outcome:
        """What a run says without an error, of this package."""
        name = f"{self.package}-{_named_by(run)}"
        return self._once(name, lambda: server.outcome(run, self.compiled, cpu=LONGEST))

    def _once(self, name: str, made: Callable[[], Any]) -> Any:
        path = self.folder / f"{name}.pickle"
        if not path.exists():
            path.write_bytes(pickle.dumps(made()))
        return pickle.loads(path.read_bytes())


def _named_by(run: Run) -> str:
    return hashlib.sha256(repr((run.words, run.model, sorted(run.files.items()))).encode()).hexdigest()[:24]


def kept_in(folder: Path) -> Kept:
    whole = hashlib.sha256()
    for path in sorted(Path(PACKAGE).rglob("*")):
        if path.is_file() and path.suffix != ".pyc":
            whole.update(path.read_bytes())
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    return Kept(folder, whole.hexdigest()[:24])
