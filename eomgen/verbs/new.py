"""eomgen new: a commented starter model."""

from __future__ import annotations

import json
import shlex
from dataclasses import replace
from pathlib import Path

from eomgen.errors import RunFailed, UsageError
from eomgen.report.document import Document, lines_document

TEMPLATES = Path(__file__).parent.parent / "templates"


def new_document(name: str) -> Document:
    """A commented starter model NAME.toml; never over a file that is there.

    Raises:
        UsageError: the file is there already, or the name is none.
        RunFailed: it cannot be written.
    """
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    if not path.stem.isprintable() or path.stem.startswith(".") or path.name == ".toml":
        raise UsageError(f"{name!r} is no name for a model", mend="use letters, digits, _ and -")
    text = (TEMPLATES / "starter.toml").read_text(encoding="utf-8")
    text = text.replace('"NAME"', json.dumps(path.stem, ensure_ascii=False)).replace("FILE", shlex.quote(str(path)))
    try:
        with open(path, "x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise UsageError(f"'{path}' is there already", mend="take another name") from None
    except OSError as error:
        raise RunFailed(f"the file cannot be written: {error.strerror or error}", str(path)) from None
    document = lines_document(lambda: {"file": str(path)}, str(path))
    return replace(document, notes=(f"now try: eomgen derive {shlex.quote(str(path))}",))
