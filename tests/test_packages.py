"""What eomgen imports is what pyproject.toml declares, and README's table names each extra."""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS: dict[str, list[str]] = PROJECT["optional-dependencies"]
OF_DEVELOPERS = {"docs", "test", "dev"}
DISTRIBUTIONS = {
    "IPython": "ipython",
    "PIL": "pillow",
    "flint": "python-flint",
}  # a module that is not called as its distribution
IMPORT = re.compile(r"^ *(?:from (?=[\w.]+ import )|import (?=[\w.]+(?: as \w+)?$))(\w+)", re.MULTILINE)
READERS_OWN = {"pandas", "xarray"}  # results are handed over in their forms to whoever has them


def distribution(requirement: str) -> str:
    """The name at the head of a requirement, as modules spell it: "math-core==0.9.0" -> "math_core"."""
    return re.split(r"[\[<>=;!~ ]", requirement)[0].replace("-", "_")


def imported() -> set[str]:
    """The modules outside the standard library that the package imports anywhere."""
    found = set()
    for path in (ROOT / "eomgen").rglob("*.py"):
        found.update(IMPORT.findall(path.read_text(encoding="utf-8")))
    return found - sys.stdlib_module_names - {"eomgen"}


def table_of_extras() -> dict[str, str]:
    """{extra: what README's table says that it adds}."""
    section = README.partition("## Optional packages")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| (`[^|]*) \| ([^|]*) \|$", section, re.MULTILINE)
    return {name: adds for names, adds in rows for name in re.findall(r"`(\w+)`", names)}


def test_the_readme_names_each_extra():
    """The rows of the table are the extras of pyproject.toml."""
    assert table_of_extras().keys() == EXTRAS.keys()


def test_what_is_imported_is_declared():
    """As a dependency or in an extra for users; README names the two libraries that are taken where they are."""
    declared = [*PROJECT["dependencies"], *(x for name in EXTRAS.keys() - OF_DEVELOPERS for x in EXTRAS[name])]
    known = {distribution(requirement) for requirement in declared} | READERS_OWN
    missing = {name for name in imported() if DISTRIBUTIONS.get(name, name).replace("-", "_") not in known}
    assert not missing
    assert all(f"`{name}`" in README for name in READERS_OWN)


def test_the_base_installation_is_imported():
    """No dependency that nothing in the package asks for."""
    requested = {DISTRIBUTIONS.get(name, name).replace("-", "_") for name in imported()}
    assert {distribution(requirement) for requirement in PROJECT["dependencies"]} <= requested


def test_a_message_or_page_names_an_extra_that_there_is():
    """eomgen[NAME] in the package, the pages and the check of every change."""
    places = [ROOT / ".ci" / "run", *(ROOT / "eomgen").rglob("*.py"), *(ROOT / "docs").rglob("*.md")]
    named = {
        extra
        for path in places
        for names in re.findall(r"(?:eomgen|\.)\[(\w[\w,]*)\]'", path.read_text(encoding="utf-8"))
        for extra in names.split(",")
    }
    assert {"notebook", "space", "video"} < named <= {*EXTRAS, "NAME"}
