"""Planted errors: who sees a wrong law?

`planted_errors.toml` holds a list of small patches by source text, over all rooms. One at a time each is put into a
copy of the module in memory (no file changes), and the verb and model that use it are run. What comes out is

    product     the verb itself says so: its certificate fails, or it refuses, with an exit code other than 0
    crash       the verb ends in an internal error: loud, but nothing that a proof saw
    tests       the verb says nothing; the tests named for the room fail
    nobody      neither
    harmless    every number that is printed is right all the same: another way was taken, an exact form is missing
    no effect   what is printed is the same as without the patch: the entry does not reach what it should, and is fixed
    text gone   the old text stands no more in its file, or more than once: nothing is planted, and the entry is fixed

    python benchmarks/planted_errors.py                         # all, by the product; a table
    python benchmarks/planted_errors.py --tests                 # what the product did not see also by the tests
    python benchmarks/planted_errors.py --only spring,disc -v   # these, with what was said
    python benchmarks/planted_errors.py --tests --write docs/planted_errors.md        # the table of all, anew
    python benchmarks/planted_errors.py --tests --new --write docs/planted_errors.md  # its missing rows alone

`--write` puts the rows of what ran into the list of the page and counts them anew; the other rows, and the words
around both tables, stay as they are.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.abc
import importlib.machinery
import importlib.util
import io
import json
import multiprocessing
import os
import re
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
LIST = Path(__file__).with_suffix(".toml")
CACHE = ".cache"
CODE = ""  # a folder of compiled code that runs share; "": each has its own
VERDICTS = (0, 5)  # exit codes of `verify`: neither says that something is wrong with what it tells
PATIENCE = 180  # s of one run of a verb; what takes longer counts as refused
TEST_PATIENCE = 900  # s of the tests of one room
COUNTS, LISTED = "| room | planted |", "| room | error | verb and model | seen by |"  # how the tables of a page begin


@dataclass(frozen=True)
class Planted:
    """One error: in `file` (below eomgen/) the text `old`, which stands there once, becomes `new`.

    Args:
        name: unique, what is wrong in words.
        room: of which law it is.
        run: words of the command line, the model among them, models/ and .toml left out: "solve four_bar"; several with
            " then " between; @ is a folder of their own; "--text" at the end asks for what a person reads; "" where
            no proof can know what was meant, as of what a person typed: then the tests alone are asked.
        tests: pytest's words that should see it, where the verb does not: "tests/test_targets.py -k nan".
        model: text of a model of its own, in the list its name in [models] where more than one entry has it; `run` then
            names it "-".
        open: the product does not see it yet.
        harmless: another way gives the right answer all the same.
    """

    name: str
    room: str
    file: str
    old: str
    new: str
    run: str
    tests: str = ""
    model: str = ""
    open: bool = False
    harmless: bool = False

    @property
    def module(self) -> str:
        return "eomgen." + self.file.removesuffix(".py").removesuffix("/__init__").replace("/", ".")

    @property
    def gone(self) -> str:
        """Why nothing can be planted; "" where it can."""
        path = ROOT / "eomgen" / self.file
        times = path.read_text(encoding="utf-8").count(self.old) if path.exists() else 0
        return "" if times == 1 else f"'{self.name}': the text stands {times} times in {self.file}"

    @property
    def patched(self) -> str:
        """The module's text with the error.

        Raises:
            ValueError: the old text does not stand there exactly once.
        """
        if self.gone:
            raise ValueError(self.gone)
        source = (ROOT / "eomgen" / self.file).read_text(encoding="utf-8")
        return source.replace(self.old, self.new)

    def put_in(self) -> None:
        """This process has the error."""
        plant(self)


@dataclass(frozen=True)
class Outcome:
    """What a verb said: its exit code, its output, and the files that it wrote, by their names."""

    code: int
    out: str
    files: tuple[tuple[str, bytes], ...] = ()

    @property
    def why(self) -> str:
        """The checks that failed, or the message of a refusal."""
        with contextlib.suppress(ValueError, AttributeError, TypeError, KeyError):
            found = json.loads(self.out)
            if "error" in found:
                return str(found["error"]["problems"][0]["what"])
            failing = [c["name"] for c in found["certificate"]["checks"] if c["status"] == "fails"]
            return "; ".join(failing) or str(found.get("failed", ""))
        return self.out[-200:].strip().replace("\n", " / ")


class Patch(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Loads one module from another text."""

    def __init__(self, planted: Planted) -> None:
        self.name, self.text = planted.module, planted.patched
        self.path = str(ROOT / "eomgen" / planted.file)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if fullname != self.name:
            return None
        inside = [os.path.dirname(self.path)] if self.path.endswith("__init__.py") else None
        return importlib.util.spec_from_file_location(
            fullname, self.path, loader=self, submodule_search_locations=inside
        )

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        exec(compile(self.text, self.path, "exec", dont_inherit=True), module.__dict__)


def plant(planted: Planted) -> None:
    """This process loads the module, or reads the text that is compiled elsewhere (.c, .mjs), with the error."""
    if planted.file.endswith(".py"):
        sys.meta_path.insert(0, Patch(planted))
        return
    path, text, read = ROOT / "eomgen" / planted.file, planted.patched, Path.read_text
    Path.read_text = lambda self, *args, **options: text if self == path else read(self, *args, **options)  # type: ignore[method-assign]


def entries(path: Path = LIST) -> tuple[Planted, ...]:
    """The list, in its order."""
    found = tomllib.loads(path.read_text(encoding="utf-8"))
    models = found.get("models", {})
    return tuple(
        Planted(**{**entry, "model": models.get(entry.get("model"), entry.get("model", ""))})
        for entry in found["error"]
    )


def sample(size: int) -> list[Planted]:
    """Errors that the product sees, of different rooms: one of each, evenly spread over the rooms."""
    rooms: dict[str, list[Planted]] = {}
    for planted in entries():
        if planted.run and not (planted.open or planted.harmless):
            rooms.setdefault(planted.room, []).append(planted)
    middle = [of_room[len(of_room) // 2] for of_room in rooms.values()]
    return [middle[k * len(middle) // size] for k in range(min(size, len(middle)))]


def words_of(run: str, model: str, folder: str) -> list[str]:
    """The command line of an entry: the model's path put in, results as JSON, files (@) in a folder.

    NAME=VALUE before the verb stands in the environment, as in a shell: CC=none runs what steps without a compiler.
    """
    import shlex

    words = shlex.split(run)
    while "=" in words[0]:
        name, _, os.environ[name] = words.pop(0).partition("=")
    verb, name, *options = words
    path = Path(folder) / "model.toml"
    if name == "-":
        path.write_text(model, encoding="utf-8")
    else:
        path = Path(name.replace("@", folder)) if "@" in name else ROOT / "models" / f"{name}.toml"
    form = options.pop() if options[-1:] == ["--text"] else "--json"
    return [verb, str(path), *(o.replace("@", folder) for o in options), *([form] if form == "--json" else [])]


def _child(planted: Planted | None, run: str, model: str, pipe: multiprocessing.connection.Connection) -> None:
    """In a process of its own: the verb, with the error."""
    if planted is not None:
        planted.put_in()
    out, err = io.StringIO(), io.StringIO()
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        os.environ["XDG_CACHE_HOME"] = CODE or os.path.join(folder, CACHE)  # no code of another patch
        code = 0
        for each in run.split(" then "):
            out.truncate(out.seek(0))
            if code := _code(each, model, folder, out):
                break
        written = () if code else _written(Path(folder), run)
    pipe.send(Outcome(code, (out.getvalue() or err.getvalue()).replace(folder, "@"), written))


def _code(run: str, model: str, folder: str, out: io.StringIO) -> int:
    """The exit code of one command line."""
    try:
        from eomgen.cli import main

        main(words_of(run, model, folder))
    except SystemExit as end:
        return int(end.code or 0) if not isinstance(end.code, str) else 1
    except BaseException as error:  # a crash is a refusal, too
        print(f"{type(error).__name__}: {error}", file=out)
        return 70
    return 0


def _written(folder: Path, run: str) -> tuple[tuple[str, bytes], ...]:
    """The files that a run wrote, where its command line names its folder."""
    if "@" not in run:
        return ()
    found = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.suffix not in (".sqlite", ".so"))
    names = ((path.relative_to(folder).as_posix(), path) for path in found)
    return tuple(
        (name, path.read_bytes().replace(str(folder).encode(), b"@"))
        for name, path in names
        if not name.startswith(CACHE) and name != "model.toml"
    )


def outcome(planted: Planted | None, run: str, model: str = "") -> Outcome:
    """What the verb says, with the error or without."""
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)
    child = context.Process(target=_child, args=(planted, run, model, there))
    child.start()
    there.close()
    try:
        found = here.recv() if here.poll(PATIENCE) else Outcome(124, f"no answer in {PATIENCE} s")
    except EOFError:
        found = Outcome(139, "the process died")
    child.kill()
    child.join()
    return found


@cache
def without(run: str, model: str) -> Outcome:
    """What the verb says of the right product."""
    return outcome(None, run, model)


def seen_by_product(planted: Planted) -> tuple[str, str]:
    """("product" | "crash" | "harmless" | "no effect" | "broken" | "text gone" | "", what was said)."""
    if planted.gone:
        return "text gone", planted.gone
    if not planted.run:
        return "", ""
    right = without(planted.run, planted.model)
    if right.code not in VERDICTS:
        return "broken", f"exit {right.code} without the error: {right.why}"
    wrong = outcome(planted, planted.run, planted.model)
    if wrong.code in (70, 139):
        return "crash", f"exit {wrong.code}: {wrong.why}"
    if wrong.code not in VERDICTS:
        return "product", f"exit {wrong.code}: {wrong.why}"
    if wrong.code == right.code and wrong.out == right.out and wrong.files == right.files:
        return "no effect", ""
    same = wrong.code == right.code and wrong.files == right.files and _same_answers(wrong.out, right.out)
    return ("harmless", "") if same else ("", "")


def _same_answers(one: str, other: str) -> bool:
    """Whether every answer of the first result is right by the other: numbers to 1e-9, formulas missing or equal."""
    with contextlib.suppress(ValueError):
        a, b = (_leaves(_answers(json.loads(text))) for text in (one, other))
        return bool(b) and a.keys() == b.keys() and all(_right(a[k], b[k], k.endswith(".exact")) for k in b)
    return False


def _answers(found: dict[str, Any]) -> Any:
    """The outputs; of a run its end and its phases."""
    return found.get("outputs") or {key: found[key] for key in ("end", "phases") if key in found}


def _leaves(found: Any, name: str = "") -> dict[str, Any]:
    """Numbers and formulas of the outputs, by their places; the way to them and their proof are no answers."""
    if isinstance(found, dict):
        parts = ((f"{name}.{k}", x) for k, x in found.items() if k not in ("certificate", "steps", "method"))
    elif isinstance(found, list):
        parts = ((f"{name}[{i}]", x) for i, x in enumerate(found))
    else:
        return {name: found}
    return {k: x for key, part in parts for k, x in _leaves(part, key).items()}


def _right(found: Any, right: Any, formula: bool) -> bool:
    if isinstance(found, float) and isinstance(right, (int, float)):
        return abs(found - right) <= 1e-9 * (1 + abs(right))
    return found == right or (formula and (found is None or _equal_formulas(found, right)))


def _equal_formulas(one: object, other: object) -> bool:
    """Whether two texts are worth the same at three states, every name a number between 1/2 and 1, with 60 digits."""
    import random

    import mpmath

    if not (isinstance(one, str) and isinstance(other, str)):
        return False
    texts = [re.sub("'+", lambda m: "_" * len(m[0]), x).replace("^", "**") for x in (one, other)]
    texts = [re.sub(r"(?<![\w.])(\d+)(?![\w.])", r"mpf(\1)", x) for x in texts]
    names = sorted({name for x in texts for name in re.findall(r"[A-Za-z_]\w*(?![\w(])", x)} - {"pi"})
    rng = random.Random(1)
    with mpmath.workdps(60):
        known = {**vars(mpmath), "abs": abs, "max": max, "min": min}
        states = [{**known, **{name: mpmath.mpf(rng.uniform(0.5, 1)) for name in names}} for _ in range(3)]
        try:
            pairs = [[eval(x, dict(state)) for x in texts] for state in states]
            return all(abs(a - b) <= 1e-9 * (1 + abs(b)) for a, b in pairs)
        except (ArithmeticError, ValueError, TypeError, NameError, SyntaxError):
            return False


def seen_by_tests(planted: Planted) -> bool:
    """Whether the tests named for it fail in a copy of the tree with the error."""
    import shlex
    import shutil

    if not planted.tests:
        return False
    with tempfile.TemporaryDirectory() as folder:
        for part in ("eomgen", "tests", "models", "notebooks", "benchmarks", "docs", "pyproject.toml", "README.md"):
            source = ROOT / part
            if source.is_dir():
                shutil.copytree(source, Path(folder) / part, ignore=shutil.ignore_patterns("__pycache__", "_build"))
            else:
                shutil.copy(source, folder)
        (Path(folder) / "eomgen" / planted.file).write_text(planted.patched, encoding="utf-8")
        environment = {**os.environ, "PYTHONPATH": folder, "XDG_CACHE_HOME": str(Path(folder) / "cache")}
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *shlex.split(planted.tests)]
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, timeout=TEST_PATIENCE)
    return done.returncode == 1


def warm() -> None:
    """Import what every run needs and no patch touches: a run then is a fork."""
    import click
    import mpmath
    import numpy
    import scipy.integrate
    import sympy

    assert click and mpmath and numpy and scipy.integrate and sympy
    assert not any(name.startswith("eomgen.") for name in sys.modules), "the errors are planted at import"


def judged(chosen: Iterable[Planted], tests: bool, verbose: bool) -> list[tuple[Planted, str, str]]:
    """(error, who saw it, what was said) of each."""
    rows = []
    for planted in chosen:
        seen, said = seen_by_product(planted)
        if not seen:
            seen = "tests" if tests and seen_by_tests(planted) else "nobody" if tests else "not by the product"
        rows.append((planted, seen, said))
        if verbose or seen != "product":
            print(f"{seen:18} {planted.room:14} {planted.name} [{planted.run}] {said[:160]}", flush=True)
    return rows


def table(rows: Sequence[tuple[str, str]]) -> str:
    """Markdown: of every room how many were planted and who saw them; rows are (room, who saw it)."""
    columns = ["product", *sorted({seen for _, seen in rows} - {"product"})]
    lines = [f"| room | planted | {' | '.join(columns)} |", f"|---|---:|{'---:|' * len(columns)}"]
    for room in [*dict.fromkeys(room for room, _ in rows), "all"]:
        mine = Counter(seen for own, seen in rows if room in (own, "all"))
        lines.append(f"| {room} | {mine.total()} | {' | '.join(str(mine[c]) for c in columns)} |")
    return "\n".join(lines)


NEW_PAGE = f"""# Planted errors

Made by `python benchmarks/planted_errors.py --write FILE`; it says what the columns mean.

{COUNTS}

{LISTED}
"""


def listed(page: str) -> dict[str, tuple[str, str, str]]:
    """{name of an error: (room, verb and model, who saw it)} of the list of a page, in its order."""
    _, head, below = page.partition(LISTED)
    rows = re.match(r"(?:\n\|.*)*", below) if head else None
    cells = [line.strip("| ").split(" | ") for line in rows[0].split("\n")[2:]] if rows else []
    return {name: (room, run, seen) for room, name, run, seen in cells}


def page_with(page: str, rows: Sequence[tuple[Planted, str, str]]) -> str:
    """The page with the rows of what ran in its list, each in its place or at the end, and with their counts."""
    found = listed(page) | {p.name: (p.room, f"`{p.run}`", seen) for p, seen, _ in rows}
    lines = [
        LISTED,
        "|---|---|---|---|",
        *(f"| {room} | {n} | {run} | {seen} |" for n, (room, run, seen) in found.items()),
    ]
    counted = table([(room, seen) for room, _, seen in found.values()])
    for head, text in ((LISTED, "\n".join(lines)), (COUNTS, counted)):
        if head not in page:
            raise SystemExit(f"the page has no table that begins with '{head}': nothing is written")
        page = re.sub(re.escape(head) + r".*(?:\n\|.*)*", lambda _: text, page, count=1)  # noqa: B023
    return page


def main() -> int:
    """The table, on stdout or in a file; 1 where an error was seen by nobody or had no effect."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="names that contain one of these words, separated by commas")
    parser.add_argument("--room", default="", help="only this room")
    parser.add_argument("--tests", action="store_true", help="run the tests of what the product did not see")
    parser.add_argument(
        "--write", metavar="FILE", help="a Markdown page, in whose tables the rows of what ran stand then"
    )
    parser.add_argument("--new", action="store_true", help="only those without a row in the page of --write")
    parser.add_argument("-v", "--verbose", action="store_true")
    given = parser.parse_args()
    words = [word for word in given.only.split(",") if word]
    chosen = [e for e in entries() if (not words or any(w in e.name for w in words)) and given.room in ("", e.room)]
    page = Path(given.write) if given.write else None
    before = page.read_text(encoding="utf-8") if page is not None and page.exists() else NEW_PAGE
    if given.new:
        chosen = [e for e in chosen if e.name not in listed(before)]
    page_with(before, [])  # a page without these tables is refused before anything runs
    warm()
    rows = judged(chosen, given.tests, given.verbose)
    print(table([(planted.room, seen) for planted, seen, _ in rows]))
    if page is not None:
        page.write_text(page_with(before, rows), encoding="utf-8")
    return int(any(seen not in ("product", "tests", "harmless") for _, seen, _ in rows))


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    sys.exit(main())
