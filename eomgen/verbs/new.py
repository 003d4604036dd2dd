"""eomgen new: a commented starter model, or an example that ships, as a file of one's own."""

from __future__ import annotations

import json
import os
import shlex
from dataclasses import replace
from pathlib import Path

from eomgen import files
from eomgen.documents import Document, lines_document
from eomgen.errors import UsageError
from eomgen.verbs.examples import example_named

TEMPLATES = Path(__file__).parent.parent / "templates"


def new_document(name: str, example: str | None = None) -> Document:
    """A commented starter model NAME.toml, or the example as it is; never over a file that is there.

    Raises:
        UsageError: the file is there already, the name is none or that of another kind of file; no such example.
        WriteFailed: it cannot be written.
    """
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    ending = Path(name).suffix
    if ending and ending != ".toml" and ending[1:].isalpha():
        raise UsageError(f"a model file ends in .toml, not in {ending}", fix=f"eomgen new {Path(name).stem}")
    if not path.stem.isprintable() or path.stem.startswith(".") or path.name == ".toml":
        raise UsageError(f"{name!r} is no name for a model", fix="use letters, digits, _ and -")
    text = (example_named(example) if example else TEMPLATES / "starter.toml").read_text(encoding="utf-8")
    if not example:
        text = text.replace('"NAME"', json.dumps(path.stem, ensure_ascii=False)).replace("FILE", shlex.quote(str(path)))
    if os.path.lexists(path):
        raise UsageError(f"'{path}' is there already", fix="take another name")
    files.write(path, text)
    document = lines_document(lambda: {"file": str(path)}, str(path))
    return replace(document, notes=(f"now try: eomgen derive {shlex.quote(str(path))}",))
