"""Program -> files that others can use as they are: all of them, or none."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

from eomgen.codegen.names import identifier
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import target_named
from eomgen.codegen.targets.base import Description
from eomgen.errors import RunFailed

SCHEMA_VERSION = 1


def write_files(name: str, program: Program, description: Description, *, target: str, directory: Path) -> list[Path]:
    """Write NAME_rhs.c, NAME_rhs.h (or the target's own) and test_vectors.json.

    Args:
        name: of the functions: the model file's stem; what is no identifier is made one.
        program: the right-hand side.
        description: title, origin, remarks and test vectors.
        target: "c" or "numpy".
        directory: where to; made if it is not there.
    Returns:
        The paths written.
    Raises:
        RunFailed: the folder cannot be written; nothing is then left behind.
    """
    texts = target_named(target).files(program, identifier(name), description)
    texts["test_vectors.json"] = vectors_text(program, description)
    try:
        return _written(texts, directory)
    except OSError as error:
        raise RunFailed(f"the files cannot be written: {error.strerror or error}", str(directory)) from None


def vectors_text(program: Program, description: Description) -> str:
    """The test vectors as JSON, one a line: names in order, then t, x, p, inputs (null: the model's own), dx."""
    symbols = program.symbols
    rows = [
        {"t": v.t, "x": v.x, "p": v.p, "inputs": v.inputs, "dx": v.dx, "tolerance": v.tolerance}
        for v in description.vectors
    ]
    head = {
        "schema_version": SCHEMA_VERSION,
        "model": description.title,
        "origin": description.origin,
        "coordinates": [x.name for x in symbols.q],
        "speeds": [x.name for x in symbols.u],
        "parameters": list(symbols.parameters),
        "inputs": list(symbols.inputs),
        "tolerance": "of |dx - given| / max(1, largest |dx|)",
    }
    lines = [f" {json.dumps(name)}: {json.dumps(value, ensure_ascii=False)}," for name, value in head.items()]
    listed = ",\n".join(f"  {json.dumps(row)}" for row in rows)
    return "\n".join(["{", *lines, ' "vectors": [', listed, " ]", "}", ""])


def _written(texts: Mapping[str, str], directory: Path) -> list[Path]:
    """Everything is written aside first and moved into place last."""
    directory.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=directory, prefix=".eomgen-") as aside:
        for name, text in texts.items():
            (Path(aside) / name).write_text(text, encoding="utf-8")
        for name in texts:
            os.replace(Path(aside) / name, directory / name)
    return [directory / name for name in texts]
