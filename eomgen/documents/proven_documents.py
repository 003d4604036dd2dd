"""A document, the proof of its result -> the document with both, and a proof that it is printed as it was found.

A result -> its document, with notes on the changes of its model's start.
"""

from __future__ import annotations

import difflib
import math
import operator
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from random import Random
from typing import TYPE_CHECKING, Any

from eomgen.documents.document import Document, quantities_of
from eomgen.documents.read_back import page_read_back
from eomgen.documents.result import Result, drawn
from eomgen.documents.statements import Equation, Formula, Grid, Law, Listing, Matrix, Quantity, Statement, parts_of
from eomgen.documents.text import cases_text, cell_text, is_piecewise, side_text
from eomgen.documents.texts_read import json_read_back, text_read_back
from eomgen.errors import (
    DerivationError,
    ExpressionError,
    ModelError,
    NumberBeyond,
    OpenConstraints,
    Problem,
)
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.start import Start
from eomgen.model import Model, Unit
from eomgen.proof import Certificate, Check, Tally, differing
from eomgen.study import study_of
from eomgen.symbolic.expression import LONGEST, Expression, Graph, Node, Scalar, order, parse, symbols_of
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances
from eomgen.symbolic.print import to_text

if TYPE_CHECKING:
    from eomgen.simulation import Trajectory

NAME = "formulas, read back as they are printed, are what they stand for"
HOW = "50 digits"
NUMBERLESS = "it has no finite number: it is not real, or beyond what a double holds"
NO_NUMBERS = ("nan", "inf", "-inf")  # as they are printed
NAMED = 3  # of those without a finite number in a message
SHOWN = 60  # characters of a formula in a message
TRIES = 12  # random values of the symbols of a formula, for one with a value
CASE = re.compile(r"(?P<if_true>.*?)(?: else)? where (?P<left>.*) (?P<relation><=?) (?P<right>.*)")
RELATION = {"<": "less", "<=": "less_equal"}


def proven(document: Document, certificate: Certificate | None) -> Document:
    """The document with the proof of what was found, and of its printed texts; None: none was requested."""
    entries = document.entries
    if certificate is not None:
        certificate = _joined(certificate, _printed_as_found(document))
    proof = None if certificate is None else certificate.as_dict()
    return replace(document, certificate=certificate, entries=lambda: {**entries(), "certificate": proof})


def proven_for_machines(document: Document) -> Document:
    """The document with a proof of its entries too, where it has one; they are made only once."""
    if document.certificate is None:
        return document
    entries, tally = document.entries(), Tally("texts for machines, read back, give their numbers", HOW)
    for name, compared in _compared(quantities_of(entries).items(), document.parameters):
        tally.add(name, compared)
    bare = {name: x for name, x in entries.items() if name != "certificate"}
    page = drawn(replace(document, certificate=None, entries=lambda: bare), "json")
    certificate = _joined(document.certificate, (*tally.checks(), *json_read_back(document, bare, page)))
    found = {**entries, "certificate": certificate.as_dict()}
    return replace(document, certificate=certificate, entries=lambda: found)


def proven_as(document: Document, form: str) -> Document:
    """The document with a proof of the page that is made of it, read back, where it has one.

    Where a number of it is not finite it has failed, and names it.
    """
    document = _with_finite_numbers(document, form)
    if form == "json":
        return proven_for_machines(document)
    if document.certificate is None:
        return document
    bare = replace(document, certificate=None)
    page = drawn(bare, form)
    more = text_read_back(bare, page) if form == "text" else page_read_back(bare, page, form)
    return replace(document, certificate=_joined(document.certificate, more))


def _joined(certificate: Certificate, more: Iterable[Check]) -> Certificate:
    """Certificate with further checks; where none of the result's checks could be made, only failed ones are added."""
    return certificate + (x for x in more if certificate.ok is not None or x.status == "fails")


def _printed_as_found(document: Document) -> Iterator[Check]:
    """Every formula against the scalar that was printed; the text of a quantity against its number."""
    tally = Tally(NAME, HOW)
    statements = [statement for step in document.steps for statement in step.statements]
    for x in dict.fromkeys(_formulas(document.equations, statements)):
        tally.add(side_text(x)[:SHOWN], partial(_misread, x))
    rows = (row for listing in statements if isinstance(listing, Listing) for row in listing.rows)
    for name, compared in _compared(((row.name, row.quantity) for row in rows), document.parameters):
        tally.add(name, compared)
    return tally.checks()


def _formulas(equations: Iterable[Equation], statements: Iterable[Statement]) -> Iterator[Node]:
    """Every formula that is printed; plain numbers and symbols left out."""
    sides = [side for equation in equations for side in (equation.left, equation.right)]
    sides += [part for statement in statements for part in _parts(statement)]
    return (x for x in sides if isinstance(x, Node) and x.args)


def _parts(statement: Statement) -> list[Any]:
    parts = parts_of(statement)
    return [*parts, *(x for part in parts if isinstance(part, Matrix) for row in part.rows for x in row)]


def _misread(x: Node) -> str:
    """Message if a formula, read back as printed, is not what it stands for; else ""."""
    try:
        read = [(_read(text, meant), meant) for text, meant in _as_printed(x)]
    except NumberBeyond as error:
        raise NoValue(error.what) from error
    except ExpressionError as error:
        return error.what
    return next(filter(None, (_unlike(found, meant) for found, meant in read if found is not meant)), "")


def _as_printed(x: Scalar) -> Iterator[tuple[str, Scalar]]:
    """(text, its formula): of a formula that has cases each of them, and both sides of its condition."""
    if not is_piecewise(x):
        yield side_text(x), x
        return
    for text in cases_text(x):
        if not is_piecewise(x):
            yield text.removesuffix(" otherwise"), x
            return
        condition, if_true, x = x.args
        case = CASE.fullmatch(text)
        if case is None or RELATION[case["relation"]] != condition.op:
            raise ExpressionError(f"'{text}' is no case", 0)
        yield case["if_true"], if_true
        yield from zip((case["left"], case["right"]), condition.args, strict=True)


def _read(text: str, meant: Scalar) -> Scalar:
    """A text over the symbols of its formula; a multiplier, lam(floor, 2), is a symbol as a whole."""
    if len(text) > LONGEST:
        raise NoValue("too long to be read back")
    if not isinstance(meant, Node):
        return parse(text).evaluate({})
    symbols = {x.name: x for x in symbols_of((meant,))}
    symbols |= {to_text(x): x for x in order((meant,)) if x.op == "sampled"}
    longest = max(map(len, symbols), default=0)
    for k, name in enumerate([name for name in symbols if "(" in name]):
        letter = f"lam{'_' * longest}{k}"
        text, symbols[letter] = text.replace(name, letter), symbols[name]
    return parse(text, longest=len(text)).evaluate({**symbols, "pi": meant.graph.pi})


def _unlike(found: Scalar, meant: Scalar) -> str:
    """Both numbers, where they differ at random values of the symbols; ""."""
    random = Random(0)
    symbols, arithmetic = symbols_of((found, meant)), fifty_digits()
    for _ in range(TRIES):
        state = {x: arithmetic.number(random.randint(1, 997)) / 499 for x in symbols}
        try:
            a, b = evaluate((found, meant), state, arithmetic)
        except (NoValue, ZeroDivisionError):
            continue
        same = abs(a - b) <= tolerances.COMPUTED * (abs(a) + abs(b)) + tolerances.ZERO_AT_50
        return "" if same else f"{float(a):.10g} against {float(b):.10g}"
    raise NoValue("at none of the states tried it has a value")


def _compared(
    quantities: Iterable[tuple[str, Quantity]], values: Mapping[str, Any]
) -> Iterator[tuple[str, Callable[[], str]]]:
    """(name, difference between its text and its number) of those that have both, of parameters with values."""
    for name, quantity in quantities:
        text = quantity.exact
        if text is None:
            continue
        try:
            expression = parse(text, references=True, longest=len(text))
        except NumberBeyond:
            continue
        except ExpressionError as error:
            yield name, partial(str, f"{text[:SHOWN]}: {error.what}")
            continue
        if quantity.value is not None and not expression.calls and expression.names <= values.keys() | {"pi"}:
            yield name, partial(_off, expression, quantity.unit or "1", quantity.value, values)


def _off(expression: Expression, unit: str, right: float, values: Mapping[str, Any]) -> str:
    """Message if the value of the text is not the number; else ""."""
    graph, digits = Graph(), fifty_digits()
    symbols = {name: graph.symbol(name) for name in sorted(expression.names - {"pi"})}
    scalar = expression.evaluate({**symbols, "pi": graph.pi})
    state = dict(zip(symbols.values(), evaluate([values[name] for name in symbols], {}, digits), strict=True))
    found = float(evaluate((scalar,), state, digits)[0])
    return differing(found / Unit.parse(unit).size, right)


# -------- finite numbers --------------------------------------------------------------------------------------
# nan and inf are no results, and JSON has no word for them: they become null, and the document says of what.


def _with_finite_numbers(document: Document, form: str) -> Document:
    """The document, failed where a number of it is not finite.

    Args:
        form: in which it is written: JSON is made of the entries, other forms of the sections.
    """
    names: list[str] = []
    if form == "json":
        entries = _finite("", document.entries(), names)
        document = replace(document, entries=lambda: entries)
    else:
        statements = (statement for step in document.steps for statement in step.statements)
        names += dict.fromkeys(name for statement in statements for name in _numberless(statement))
    if not names:
        return document
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    failed = f"no finite number: {', '.join(names[:NAMED])}{more}"
    return replace(document, failed="; ".join(filter(None, (document.failed, failed))))


def _finite(name: str, entry: Any, names: list[str]) -> Any:
    """The entry with None for numbers that are not finite, whose names are added to the list."""
    if isinstance(entry, Quantity):
        beside, value = _finite(name, entry.beside, names), _finite(name, entry.value, names)
        if value is entry.value:
            return entry if beside is entry.beside else replace(entry, beside=beside)
        return replace(entry, value=None, message=entry.message or NUMBERLESS, beside=beside)
    if isinstance(entry, Mapping):
        found = {key: _finite(f"{name}.{key}" if name else str(key), inner, names) for key, inner in entry.items()}
        return entry if all(map(operator.is_, found.values(), entry.values())) else found
    if isinstance(entry, (list, tuple)):
        rows = [_finite(f"{name}[{k}]", inner, names) for k, inner in enumerate(entry)]
        return entry if all(map(operator.is_, rows, entry)) else rows
    if isinstance(entry, float) and not math.isfinite(entry):
        names.append(name)
        return None
    return entry


def _numberless(statement: Statement) -> Iterator[str]:
    """Names of what a statement tells without a finite number."""
    if isinstance(statement, Listing):
        values = ((row.name, row.quantity.value) for row in statement.rows)
        yield from (name for name, value in values if value is not None and not math.isfinite(value))
    elif isinstance(statement, Formula) and any(map(_is_no_number, statement.sides)):
        yield side_text(statement.sides[0])
    elif isinstance(statement, Grid):
        for row in statement.rows:
            at = [k for k, cell in enumerate(row) if _is_no_number(cell) and not _is_missing(cell)]
            yield from (cell_text(row[max(k - 1, 0)]) for k in at)


def _is_missing(cell: Any) -> bool:
    """True for nan in a table: what has no value at an instant of a run, as a reaction that is indeterminate."""
    return cell == "nan" or (isinstance(cell, float) and math.isnan(cell))


def _is_no_number(part: Any) -> bool:
    """True for nan and infinity, as numbers and as they are printed."""
    if isinstance(part, Matrix):
        return any(_is_no_number(x) for row in part.rows for x in row)
    if isinstance(part, Law):
        part = part.text
    return part in NO_NUMBERS if isinstance(part, str) else isinstance(part, float) and not math.isfinite(part)


# -------- start ----------------------------------------------------------------------------------------------
# Result -> its document, with notes on the changes of its start.


def shown(found: Result, *, plot: str | None = None, certify: bool = True) -> Document:
    """Document of a result, with its proof where that is requested; its picture is saved where a file is given."""
    panels = () if plot is None else found.picture.saved(plot)
    certificate = found.certify() + found.drawn_checks(panels) if certify else None
    document = proven(found.document, certificate)
    over = getattr(found, "over", None)  # the range of a picture
    return document if over is None else replace(document, taken=(*document.taken, over.taken))


def with_start_reported(document: Document, model: Model, run: Trajectory | None = None) -> Document:
    """The document with a note on the changes where its model could not start as it is written; a warning where
    nothing closes its constraints.

    Args:
        run: the motion that it reports: that nothing moves is a note too.
    """
    if run is not None and run.still:
        document = replace(document, notes=(*document.notes, run.still))
    if not (model.coordinates and model.constraints):
        return document
    try:
        words = _words_of_start(model)
    except OpenConstraints as error:
        return with_open_constraints(document, error)
    except (DerivationError, ModelError):  # reported by the verb, where it needs a start
        return document
    return replace(document, notes=(*document.notes, f"The start was {words}.")) if words else document


def with_constraints_closed(document: Document, system: System) -> Document:
    """The document of a result that needs no start; with a warning where nothing closes the constraints near it."""
    try:
        Start.of(system)
    except OpenConstraints as error:
        return with_open_constraints(document, error)
    except (DerivationError, ModelError):  # reported by the verbs that need a start
        pass
    return document


def with_open_constraints(document: Document, error: OpenConstraints) -> Document:
    """The document with a warning that nothing closes the constraints of its model near the start."""
    return replace(document, cautions=(*document.cautions, Problem(error.where, error.what, fix=error.fix)))


def named_open(model: Model, error: OpenConstraints) -> OpenConstraints:
    """The same error with the constraint that stays open at the start and by how much, where that can be found."""
    try:
        _words_of_start(model)
    except OpenConstraints as exact:
        return exact
    except (DerivationError, ModelError):
        pass
    return error


def _words_of_start(model: Model) -> str:
    """The changes by which a model starts otherwise than it is written, "" where there are none."""
    return Start.of(study_of(model).system).words


def nearest_name(name: str, names: Iterable[str]) -> str:
    """The name that was probably meant, or all that there are."""
    names = list(names)
    near = difflib.get_close_matches(name, names, n=1)
    return f"did you mean '{near[0]}'?" if near else f"there are {listed(names)}"


def listed(names: Iterable[str]) -> str:
    """Names in a line of text."""
    return ", ".join(names) or "none"
