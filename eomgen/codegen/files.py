"""Programs -> the texts of files that others can use as they are."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from eomgen.codegen.names import stem_of
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import target_named
from eomgen.codegen.targets.base import RHS, Description, Emitted, FileContent, Target
from eomgen.codegen.targets.form import header
from eomgen.version import SCHEMA_VERSION


def texts_of(
    name: str,
    emitted: Sequence[Emitted],
    *,
    targets: Sequence[str],
    notes: Sequence[str] = (),
    uses: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> dict[str, FileContent]:
    """{path: content}: NAME_rhs.c, NAME_rhs.h (or the target's own), the same of the others, README, test_vectors.json.

    Args:
        name: of the functions: the model file's stem; what is no identifier is made one.
        emitted: the right-hand side first, then reactions and whatever else is asked for.
        targets: names of languages, "c" or "numpy"; the files of one lie in the directory, of several each in its own.
        notes: what is not in the code, and why, a line each.
        uses: by language, how files are used that lie beside its own.
    """
    answers, stem = vectors_text(emitted), stem_of(name)
    texts: dict[str, FileContent] = {}
    for target in map(target_named, dict.fromkeys(targets)):
        folder = "" if len(set(targets)) == 1 else f"{target.name}/"
        files = target.files(stem, emitted)
        files |= {
            "README.md": readme(target, stem, emitted, notes, uses.get(target.name, ())),
            "test_vectors.json": answers,
        }
        texts |= {f"{folder}{file}": text for file, text in files.items()}
    return texts


def readme(
    target: Target, stem: str, emitted: Sequence[Emitted], notes: Sequence[str], uses: Sequence[str] = ()
) -> str:
    """What lies beside it: the functions, the order of their arguments, how they are used and tested."""
    lines = [f"# {stem}: {target.about}", ""]
    for line in (*target.use, *uses):
        lines.append(f"    {line.format(stem=stem)}")
    for program, told in emitted:
        if not target.writes(told.role):
            continue
        lines += ["", *(f"    {line}".rstrip() for line in header(program, told))]
    lines += ["", "All in SI and radians; without inputs the model's own act. Right answers are in test_vectors.json."]
    lines += [line for note in notes for line in ("", f"Not here: {note}")]
    return "\n".join([*lines, ""])


def vectors_text(emitted: Sequence[Emitted]) -> str:
    """The test vectors as JSON, one a line: names in order, then t, x, p, inputs (null: the model's own), result."""
    program, description = emitted[0]
    symbols = program.symbols
    head = {
        "schema_version": SCHEMA_VERSION,
        "model": description.title,
        "origin": description.origin,
        "coordinates": [x.name for x in symbols.q],
        "speeds": [x.name for x in symbols.u],
        "parameters": list(symbols.parameters),
        "inputs": list(symbols.inputs),
        "tolerance": "of |result - given| / max(1, largest |result|); the result is dx, of the others out or tau; "
        "null: no value there, not a number",
    }
    lines = [f" {json.dumps(name)}: {json.dumps(value, ensure_ascii=False)}," for name, value in head.items()]
    if not any(told.role.name == "reactions" for _, told in emitted):
        lines.append(' "reactions": null,')
    for other, told in emitted:
        if told.role is not RHS:
            lines += _other(other, told)
    return "\n".join(["{", *lines, *_listed(description, " "), "}", ""])


def _other(program: Program, told: Description) -> list[str]:
    """The vectors of a function beside the right-hand side."""
    own: dict[str, object] = {"names": told.outputs}
    if told.blocks:
        meant = told.columns or ((),) * len(told.blocks)
        own = {
            "blocks": [
                {"name": name, "rows": n, "columns": k, **({"of": of} if of else {})}
                for (name, n, k), of in zip(told.blocks, meant, strict=True)
            ]
        }
    if program.accelerations:
        own |= {
            "accelerations": [x.name for x in program.accelerations],
            "inputs": list(program.symbols.inputs),
        }
    lines = [f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}," for key, value in own.items()]
    return [f' "{told.role.name}": {{', *lines, *_listed(told, "  "), " },"]


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
