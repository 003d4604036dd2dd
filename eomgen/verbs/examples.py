"""eomgen examples: the models that ship; each can be the beginning of one's own."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path

from eomgen.documents import Document, lines_document
from eomgen.errors import UsageError
from eomgen.model import nearest

HOMES = (Path(__file__).parent.parent / "examples", Path(__file__).parent.parent.parent / "models")
"""where the models are: in what is installed, in the tree"""


@cache
def examples() -> dict[str, Path]:
    """Every model that ships, by its name: "double_pendulum", "seeds/ch22_p1"."""
    home = next((home for home in HOMES if home.is_dir()), None)
    paths = [] if home is None else sorted(home.rglob("*.toml"))
    return {path.relative_to(home or path).with_suffix("").as_posix(): path for path in paths}


def example_named(name: str) -> Path:
    """The model of a name; the folder of a seed may be left out.

    Raises:
        UsageError: there is none of that name.
    """
    found = examples()
    bare = name.removesuffix(".toml")
    for known in (bare, f"seeds/{bare}"):
        if known in found:
            return found[known]
    short = {known.rpartition("/")[2]: known for known in found}
    raise UsageError(f"there is no example '{name}'", fix=nearest(bare, short) or "see eomgen examples")


def examples_document() -> Document:
    """Name and title of each, a line."""
    rows = [{"name": name, "title": _title(path), "path": str(path)} for name, path in examples().items()]
    width = max((len(row["name"]) for row in rows), default=0)
    return lines_document(lambda: {"examples": rows}, *(f"{row['name']:<{width}}  {row['title']}" for row in rows))


def _title(path: Path) -> str:
    return str(tomllib.loads(path.read_text(encoding="utf-8")).get("name", path.stem))
