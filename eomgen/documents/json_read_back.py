"""A document and the JSON that was made of it -> whether it says, read again, what the document holds."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

from eomgen.documents.document import Document
from eomgen.documents.quantity import Quantity
from eomgen.documents.read_back import NAME, Unlike, misspelt
from eomgen.documents.statements import Formula, Grid, Lines, Prose, Statement, Table
from eomgen.documents.text_read_back import cell_said, flat, piece_said, row_said, side_said
from eomgen.proof.check import Check, checked

HOW = "entry by entry"


def json_read_back(document: Document, entries: Mapping[str, Any], text: str) -> Iterable[Check]:
    """Whether a text for machines says what the document holds.

    Args:
        entries: those of the document.
    """
    try:
        told = json.loads(text)
        count = _same(entries, {name: told.get(name) for name in entries}, "") if entries else 0
        if document.has_heads and "steps" not in entries:
            count += _steps(document, told)
    except Unlike as error:
        return (checked(NAME, str(error), HOW),)
    return (Check(NAME, "holds", HOW, f"of {count}"),) if count else ()


def _same(entry: Any, told: Any, where: str) -> int:
    """How many leaves an entry has that is told as it is.

    Raises:
        Unlike: one is told otherwise.
    """
    if isinstance(entry, Quantity):
        return _quantity(entry, told, where)
    if isinstance(entry, Mapping):
        if not isinstance(told, dict) or list(map(str, entry)) != list(told):
            raise Unlike(f"{where or 'the whole'}: other entries")
        return sum(_same(inner, told[str(name)], f"{where}.{name}".lstrip(".")) for name, inner in entry.items())
    if isinstance(entry, (list, tuple)):
        if not isinstance(told, list) or len(told) != len(entry):
            raise Unlike(f"{where}: not {len(entry)} entries")
        return sum(_same(a, b, f"{where}[{k}]") for k, (a, b) in enumerate(zip(entry, told, strict=True)))
    if entry != told:
        raise Unlike(f"{where}: {told!r:.60} for {entry!r:.60}")
    return 1


def _quantity(found: Quantity, told: Any, where: str) -> int:
    """Its formula, number, unit, way and message under these names."""
    wanted = {"exact": found.exact, "value": found.value, "unit": found.unit}
    wanted |= {"method": found.method or None, "message": found.message}
    if not isinstance(told, dict):
        raise Unlike(f"{where}: {told!r:.60} for a quantity")
    for name, right in wanted.items():
        if (told.get(name) or None) != (right or None) or (name == "value" and told.get(name) != right):
            raise Unlike(f"{where}.{name}: {told.get(name)!r:.60} for {right!r:.60}")
    return 1


def _steps(document: Document, told: Mapping[str, Any]) -> int:
    """The sections, each with its title and statements; every symbol set by itself."""
    if len(told["steps"]) != len(document.steps):
        raise Unlike(f"{len(told['steps'])} steps for {len(document.steps)}")
    count = 0
    for step, section in zip(document.steps, told["steps"], strict=True):
        if (section["key"], section["title"]) != (step.key, step.title):
            raise Unlike(f"'{section['title']}' for '{step.title}'")
        if len(section["statements"]) != len(step.statements):
            raise Unlike(f"{step.title}: {len(section['statements'])} statements for {len(step.statements)}")
        for statement, said in zip(step.statements, section["statements"], strict=True):
            _statement(statement, said, step.title)
            count += 1
    letters = list(told["symbols"].values())
    if len(set(letters)) != len(letters):
        raise Unlike("two symbols are set alike")
    if wrong := misspelt(told["symbols"], document.notation):
        raise Unlike(wrong)
    return count


def _statement(statement: Statement, told: Mapping[str, Any], where: str) -> None:
    wanted: Any
    if isinstance(statement, Grid):
        found: Any = [told["head"], *told["rows"]]
        wanted = [list(map(cell_said, row)) for row in (statement.head, *statement.rows)]
    elif isinstance(statement, Table):
        found = [[row[key] for key in ("symbol", "meaning", "unit", "value")] for row in told["rows"]]
        wanted = [[side_said(row.symbol), row.meaning, row.unit, row.value] for row in statement.rows]
    elif isinstance(statement, Formula):
        found, wanted = [[told["text"]]], [["=".join(map(side_said, statement.sides))]]
    elif isinstance(statement, Prose):
        found, wanted = [[told["text"]]], [["".join(map(piece_said, statement.pieces))]]
    else:
        lines = statement.lines if isinstance(statement, Lines) else map(row_said, statement.rows)
        found, wanted = [["".join(told["lines"])]], [["".join(lines)]]
    if [list(map(flat, row)) for row in found] != [list(map(flat, row)) for row in wanted]:
        pairs = [(a, b) for x, y in zip(found, wanted, strict=False) for a, b in zip(x, y, strict=False)]
        said, right = next(((a, b) for a, b in pairs if flat(a) != flat(b)), ("other rows", ""))
        raise Unlike(f"{where}: '{said:.60}' for '{right:.60}'")
