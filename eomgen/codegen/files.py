"""Program -> the texts of files that others can use as they are."""

from __future__ import annotations

import json
from collections.abc import Sequence

from eomgen.codegen.names import identifier
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import target_named
from eomgen.codegen.targets.base import Description
from eomgen.version import SCHEMA_VERSION

Emitted = tuple[Program, Description]


def texts_of(
    name: str,
    program: Program,
    description: Description,
    *,
    targets: Sequence[str],
    reactions: Emitted | None = None,
    inverse: Emitted | None = None,
) -> dict[str, str]:
    """{path: text}: NAME_rhs.c, NAME_rhs.h (or the target's own), the same of the reactions, and test_vectors.json.

    Args:
        name: of the functions: the model file's stem; what is no identifier is made one.
        program: the right-hand side.
        description: title, origin, remarks and test vectors.
        targets: names of languages, "c" or "numpy"; the files of one lie in the directory, of several each in its own.
        reactions: their program and its description, or None where there are none.
        inverse: the same of inverse dynamics, where they are asked for.
    """
    answers = vectors_text(program, description, reactions, inverse)
    texts: dict[str, str] = {}
    for target in map(target_named, dict.fromkeys(targets)):
        folder = "" if len(set(targets)) == 1 else f"{target.name}/"
        for emitted in ((program, description), reactions, inverse):
            if emitted is not None:
                files = target.files(emitted[0], identifier(name), emitted[1])
                texts |= {f"{folder}{file}": text for file, text in files.items()}
        texts[f"{folder}test_vectors.json"] = answers
    return texts


def vectors_text(
    program: Program, description: Description, reactions: Emitted | None = None, inverse: Emitted | None = None
) -> str:
    """The test vectors as JSON, one a line: names in order, then t, x, p, inputs (null: the model's own), result."""
    symbols = program.symbols
    head = {
        "schema_version": SCHEMA_VERSION,
        "model": description.title,
        "origin": description.origin,
        "coordinates": [x.name for x in symbols.q],
        "speeds": [x.name for x in symbols.u],
        "parameters": list(symbols.parameters),
        "inputs": list(symbols.inputs),
        "tolerance": "of |result - given| / max(1, largest |result|); the result is dx, of the reactions out; "
        "null: no value there, not a number",
    }
    lines = [f" {json.dumps(name)}: {json.dumps(value, ensure_ascii=False)}," for name, value in head.items()]
    if reactions is None:
        lines.append(' "reactions": null,')
    else:
        names = json.dumps(list(reactions[1].outputs), ensure_ascii=False)
        lines += [' "reactions": {', f'  "names": {names},', *_listed(reactions[1], "  "), " },"]
    if inverse is not None:
        own = {
            "names": inverse[1].outputs,
            "accelerations": [x.name for x in inverse[0].accelerations],
            "inputs": list(inverse[0].symbols.inputs),
        }
        told = [f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}," for key, value in own.items()]
        lines += [' "inverse": {', *told, *_listed(inverse[1], "  "), " },"]
    return "\n".join(["{", *lines, *_listed(description, " "), "}", ""])


def _listed(description: Description, indent: str) -> list[str]:
    """The vectors, a line each."""
    result = description.role.result
    rows = [
        {
            "t": v.t,
            "x": v.x,
            **({"a": v.a} if v.a else {}),
            "p": v.p,
            "inputs": v.inputs,
            result: [value if value == value else None for value in v.result],
            "tolerance": v.tolerance,
        }
        for v in description.vectors
    ]
    listed = ",\n".join(f"{indent} {json.dumps(row)}" for row in rows)
    return [f'{indent}"vectors": [', *([listed] if rows else []), f"{indent}]"]
