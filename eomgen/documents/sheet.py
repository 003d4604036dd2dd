"""Model -> the parts of a sheet that hold no answer: the problem in words, the given data, the questions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from eomgen.documents.document import notation_of
from eomgen.documents.latex import number_latex
from eomgen.documents.motion_steps import COORDINATES, data_tables, start_shown, unit_per
from eomgen.documents.statements import Code, Law, Meaning, Piece, Prose, Statement, Step, Table, prose, unit_text
from eomgen.model import STATEMENT, Coordinate, Model, Output
from eomgen.symbolic.expression import Graph

ROOM = 6  # cm to write the answer of one output in
_PARAGRAPHS = re.compile(r"\n\s*\n")


def statement_step(model: Model) -> Step:
    """Step with the words of the problem; without statements where the model has none."""
    texts = (paragraph for text in model.text or () for paragraph in _PARAGRAPHS.split(text.strip()))
    return Step("statement", "", tuple(_said(model, text) for text in texts if text.strip()))


def given_step(model: Model) -> Step:
    """Step with what the file declares: parameters, inputs, and the coordinates with their starts and laws."""
    graph = Graph()
    symbols = {name: graph.symbol(name) for name in (*model.parameters, *model.inputs, *model.coordinates)}
    statements: list[Statement] = [*data_tables(model, symbols)]
    rows: list[Meaning] = []
    for name, part in model.coordinates.items():
        unit = "" if part.unit is None else str(part.unit)
        rates = graph.symbol(f"{name}'"), graph.symbol(f"{name}''")
        laws = ((symbols[name], part.motion), (rates[0], part.rate), (rates[1], part.acceleration))
        rows += [Meaning(x, part.about or "", unit, f"= {law.text}") for x, law in laws if law is not None]
        if not part.driven and not part.dependent:
            rows += _started(model, name, part, unit)
    if rows:
        statements.append(Table(COORDINATES, tuple(rows)))
    return Step("data", "Data", tuple(statements))


def _started(model: Model, name: str, part: Coordinate, unit: str) -> Iterator[Meaning]:
    """Rows of a coordinate and of its rate, as far as something is said of them."""
    graph, values = Graph(), model.exact_parameters()
    if part.about or part.start is not None:
        start = "" if part.start is None else start_shown(part.start, values, part)
        yield Meaning(graph.symbol(name), part.about or "", unit, start)
    if part.speed is not None:
        yield Meaning(graph.symbol(f"{name}'"), "its rate", unit_per(unit, "s"), start_shown(part.speed, values, part))


def question_steps(model: Model, *, room: bool = False) -> tuple[Step, ...]:
    """A step for each question, numbered; where the file has none in words, for each output.

    Args:
        room: to write the answer in.
    """
    if model.questions:
        asked = [(_said(model, each.text).pieces, len(each.outputs or ("",))) for each in model.questions]
    else:
        asked = [(tuple(_of_output(model, name, output)), 1) for name, output in model.outputs.items()]
    return tuple(
        Step(f"question_{k}", "", (Prose((f"{k}. ", *pieces)),), room=ROOM * count if room else 0)
        for k, (pieces, count) in enumerate(asked, start=1)
    )


def _of_output(model: Model, name: str, output: Output) -> Iterator[Piece]:
    """The question that an output asks: its letter, its meaning, the function, the instant."""
    yield "Find "
    yield Law.of_letter(name) if output.symbol is None else Law(name, output.symbol.tex)
    if output.about is not None and "=" not in output.about:
        yield f", {output.about}"
    if output.value.calls:  # a formula without one may be an answer
        yield ": "
        yield Code(output.value.text)
    if output.rests:
        yield " at equilibrium"
    elif output.at is not None:
        yield " at "
        yield Code(output.at.text)
    yield "."


SAID_ALREADY = ("=", r"\approx", "≈")  # what stands before a value whose letter the author wrote


def _said(model: Model, text: str) -> Prose:
    """A paragraph of a problem: words, formulas, and declared names with their values."""
    pieces: list[Piece] = []
    end = 0
    for found in STATEMENT.finditer(text):
        pieces.append(_words(text[end : found.start()]))
        end = found.end()
        if found["math"] is not None:
            pieces.append(Law(found["math"].strip(), found["math"].strip()))
        elif found["name"] is not None:
            named = text[: found.start()].rstrip(" \n$").endswith(SAID_ALREADY)
            pieces.append(_valued(model, found["name"].strip(), letter=not named))
        else:
            pieces.append(found["plain"] or found[0])
    pieces.append(_words(text[end:]))
    return prose(*_joined(pieces))


def _words(text: str) -> str:
    """Words with one blank between them, those at the ends kept."""
    return re.sub(r"\s+", " ", text)


def _joined(pieces: list[Piece]) -> Iterator[Piece]:
    """The pieces without empty ones; words that follow one another as one, without blanks at the ends of all."""
    found: list[Piece] = []
    for piece in pieces:
        if isinstance(piece, str) and found and isinstance(found[-1], str):
            found[-1] += piece
        elif piece != "":
            found.append(piece)
    for k, piece in enumerate(found):
        text = piece.lstrip() if isinstance(piece, str) and k == 0 else piece
        yield text.rstrip() if isinstance(text, str) and k == len(found) - 1 else text


def _valued(model: Model, name: str, *, letter: bool = True) -> Law:
    """name = value unit, of a parameter, an input, the start of a coordinate or of its rate.

    Args:
        letter: the name stands before its value.
    """
    bare, values = name.rstrip("'"), model.exact_parameters()
    tables: tuple[Mapping[str, Any], ...] = (model.parameters, model.inputs, model.coordinates)
    part = next(table[bare] for table in tables if bare in table)
    value = (part.speed if name != bare else part.start) if isinstance(part, Coordinate) else part.value
    unit = "" if part.unit is None else str(part.unit)
    unit = unit_text(unit_per(unit, "s") if name != bare else unit)
    tex = notation_of(model).latex(name)
    if value is None:
        return Law(name, tex)
    before, number = (f"{name} = ", f"{tex} = ") if letter else ("", ""), start_shown(value, values, part)
    if unit == "deg":
        return Law(f"{before[0]}{number}°", rf"{before[1]}{number_latex(number)}^{{\circ}}")
    number = f"{number} {unit}".strip()
    return Law(f"{before[0]}{number}", f"{before[1]}{number_latex(number)}")
