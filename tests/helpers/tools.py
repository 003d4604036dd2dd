"""Programs that some tests run: without one they are skipped by its name, but on CI, where that is a failure."""

from __future__ import annotations

import os
import shutil

import pytest

from eomgen.codegen import build
from eomgen.codegen.targets import ALL

REQUIRED = bool(os.environ.get("CI") or os.environ.get("EOMGEN_REQUIRE"))
NAMES = {"chromium": ("chromium", "chromium-browser", "google-chrome")}


def found(name: str) -> str | None:
    """Where a program is; None where it is not."""
    return next(filter(None, map(shutil.which, NAMES.get(name, (name,)))), None)


def tool(name: str) -> str:
    """Where a program is; the test fails where it is not."""
    path = found(name)
    if path is None:
        pytest.fail(f"there is no {name} on this machine")
    return path


def needs(*names: str) -> pytest.MarkDecorator:
    """The mark of a test that runs these programs."""
    missing = [name for name in names if found(name) is None]
    return pytest.mark.skipif(bool(missing) and not REQUIRED, reason=f"not on this machine: {', '.join(missing)}")


RUNS = {"javascript": needs("node"), "c": pytest.mark.skipif(build.compiler() is None, reason="no C compiler")}
each_target = pytest.mark.parametrize(
    "target", [pytest.param(target.name, marks=RUNS.get(target.name, ())) for target in ALL]
)
