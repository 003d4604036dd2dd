"""Who sees an error: of the quick tests those that call the function in which it is, each error in a fork.

A plugin of pytest. It keeps which functions each test calls (EOMGEN_ERRORS_MAP names the file), or, where that is
kept already, plants one error after another (EOMGEN_ERRORS: a file of JSON lines) and writes the first test that
fails of each beside them.
"""

from __future__ import annotations

import json
import multiprocessing
import os
import pickle
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parent.parent
LONGEST = 60.0  # s of CPU of the tests of one error
MAP, ERRORS = "EOMGEN_ERRORS_MAP", "EOMGEN_ERRORS"
Error = tuple[str, str, str]  # file, its text, the qualified name of its function


def first_failing(errors: Sequence[Error], kept: Path) -> list[str]:
    """Of each error the test that sees it; "" of what none sees."""
    place, asked = kept / "tests.pickle", kept / "errors.json"
    environment = {**os.environ, MAP: str(place), "PYTHONPATH": f"{ROOT}{os.pathsep}{Path(__file__).parent}"}
    environment |= {"EOMGEN_FRESH": "1", "XDG_CACHE_HOME": str(kept / "cache")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "error_tests", "-p", "no:cacheprovider", "-n", "0"]
    command += ["-m", "not slow", "tests"]
    if not place.exists():
        subprocess.run(command, cwd=ROOT, env=environment, check=False)
    asked.write_text(json.dumps(errors), encoding="utf-8")
    subprocess.run(command, cwd=ROOT, env={**environment, ERRORS: str(asked)}, check=False, stdout=subprocess.DEVNULL)
    found: list[str] = json.loads(asked.with_suffix(".found").read_text(encoding="utf-8"))
    return found


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Asked() if ERRORS in os.environ else Mapped())


class Mapped:
    """Which functions each test calls, and how long it takes [s]."""

    def __init__(self) -> None:
        self.server: Any = None
        self.tests: dict[str, tuple[float, frozenset[tuple[str, str]]]] = {}

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Any:
        from error_runs import Server

        self.server = self.server or Server()
        start, calls = time.process_time(), self.server.watched()
        yield
        self.tests[item.nodeid] = time.process_time() - start, frozenset(calls)

    def pytest_sessionfinish(self) -> None:
        Path(os.environ[MAP]).write_bytes(pickle.dumps(self.tests))


class Asked:
    """Errors, each in a fork of a process that has collected all tests."""

    def __init__(self) -> None:
        self.failed = ""

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.failed = report.nodeid

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        from error_runs import Server

        known = pickle.loads(Path(os.environ[MAP]).read_bytes())
        items, server = {x.nodeid: x for x in session.items}, Server()
        place = Path(os.environ[ERRORS])
        found = []
        for file, text, function in json.loads(place.read_text(encoding="utf-8")):
            mine = sorted(
                (cpu, name) for name, (cpu, calls) in known.items() if (file, function) in calls and name in items
            )
            found.append(_in_a_fork(self, server, (file, text), [(cpu, items[name]) for cpu, name in mine]))
            place.with_suffix(".found").write_text(json.dumps(found), encoding="utf-8")
        return True


def _in_a_fork(asked: Asked, server: Any, error: tuple[str, str], tests: Sequence[tuple[float, pytest.Item]]) -> str:
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)

    def sent() -> None:
        server.plant(*error)
        start = time.process_time()
        for _, item in tests:
            item.ihook.pytest_runtest_protocol(item=item, nextitem=None)
            if asked.failed or time.process_time() - start > LONGEST:
                break
        there.send(asked.failed)

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
