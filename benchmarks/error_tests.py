"""Who sees an error: of README's tests those of its subject, each error in a fork of one process of pytest.

First the readings, then the test files of its subject: those whose text names the module, a public function or class of
it, or its room; so many as run in LONGEST, the nearest first. What they do not see others may: it counts as open.
"""

from __future__ import annotations

import ast
import gc
import json
import multiprocessing
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parent.parent
READINGS = "tests/test_golden_readings.py"
LONGEST, NEAREST = 120.0, 8  # s of CPU of the tests of one error; test files
ERRORS = "EOMGEN_ERRORS"  # names a file: the errors as JSON
Error = tuple[str, str]  # file, its text


def first_failing(errors: Sequence[Error], kept: Path) -> list[str]:
    """Of each error the test that sees it; "" of what none sees."""
    requested = kept / "errors.json"
    chosen = [[READINGS, *islice(near(file), NEAREST)] for file, _ in errors]
    every = sorted({name for mine in chosen for name in mine})
    if not every:
        return ["" for _ in errors]
    requested.write_text(
        json.dumps([(*error, mine) for error, mine in zip(errors, chosen, strict=True)]), encoding="utf-8"
    )
    environment = {**os.environ, ERRORS: str(requested), "PYTHONPATH": f"{ROOT}{os.pathsep}{Path(__file__).parent}"}
    environment |= {"EOMGEN_FRESH": "1", "XDG_CACHE_HOME": str(kept / "cache")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "error_tests", "-p", "no:cacheprovider", "-n", "0"]
    subprocess.run([*command, *every], cwd=ROOT, env=environment, check=False, capture_output=True)
    found: list[str] = json.loads(requested.with_suffix(".found").read_text(encoding="utf-8"))
    return found


def near(file: str) -> Iterator[str]:
    """Test files of the subject of a module, the nearest first."""
    module = "eomgen." + file.removesuffix(".py").replace("/", ".")
    tree = ast.parse((ROOT / "eomgen" / file).read_text(encoding="utf-8"))
    names = [x.name for x in tree.body if isinstance(x, (ast.FunctionDef, ast.ClassDef)) and x.name[0] != "_"]
    room = file.split("/")[0].removesuffix(".py")
    words = [
        f"\\b{re.escape(module)}\\b",
        rf"\b({'|'.join(names) or module})\b",
        rf"\beomgen\.{room}\b|\b{room.rstrip('s')}",
    ]
    texts = {path: path.read_text(encoding="utf-8") for path in sorted((ROOT / "tests").rglob("test_*.py"))}
    reported = {ROOT / READINGS}
    for word in words:
        for path, text in texts.items():
            if path not in reported and re.search(word, text):
                reported.add(path)
                yield str(path.relative_to(ROOT))


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Requested())


class Requested:
    """Errors, each in a fork of a process that has collected all tests."""

    def __init__(self) -> None:
        self.failed = ""

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.failed = report.nodeid

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        from error_runs import Server

        gc.unfreeze()  # else the functions that an error is put into are not found
        server, place = Server(), Path(os.environ[ERRORS])
        by_file: dict[str, list[pytest.Item]] = {}
        for item in session.items:
            by_file.setdefault(str(item.path.relative_to(ROOT)), []).append(item)
        found = []
        for file, text, names in json.loads(place.read_text(encoding="utf-8")):
            mine = [x for name in names for x in by_file.get(name, ())]
            failing = _in_a_fork(self, server, (file, text), mine)
            same = [x for x in mine if x.nodeid == failing]
            found.append("" if same and _in_a_fork(self, server, None, same) else failing)  # it fails at all times
            place.with_suffix(".found").write_text(json.dumps(found), encoding="utf-8")
        return True


def _in_a_fork(requested: Requested, server: Any, error: tuple[str, str] | None, tests: Sequence[pytest.Item]) -> str:
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)

    def sent() -> None:
        if error is not None:
            server.plant(*error)
        start = time.process_time()
        for item in tests:
            item.ihook.pytest_runtest_protocol(item=item, nextitem=None)
            if requested.failed or time.process_time() - start > LONGEST:
                break
        there.send(requested.failed)

    child = context.Process(target=sent)
    child.start()
    there.close()
    try:
        return str(here.recv()) if here.poll(10 * LONGEST) else "the tests do not end"
    except EOFError:
        return "the tests end by themselves"
    finally:
        child.kill()
        child.join()
