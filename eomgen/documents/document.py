"""The result of a verb as one value: sections for people, quantities for machines, the proof; each format draws it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import field, replace
from typing import Any

from eomgen.documents.languages import OURS, Catalogue, catalogue
from eomgen.documents.statements import (
    Equation,
    Lines,
    Listing,
    Matrix,
    Meaning,
    Name,
    Partial,
    Quantity,
    Rate,
    Statement,
    Step,
    Table,
    parts_of,
)
from eomgen.errors import Problem, UsageError
from eomgen.frozen import Pickled, dataclass
from eomgen.model import Model, Taken, nearest
from eomgen.proof import Certificate
from eomgen.symbolic.expression import AS_WRITTEN, Graph, Node, Sampled, Scalar, TableFunction, order, parse
from eomgen.symbolic.print import Notation, Symbol

DISTRUST = "the certificate FAILS: do not trust this result"
NOTHING_CHECKED = Problem("", "nothing of this result could be checked")


def _nothing() -> Mapping[str, Any]:
    return {}


@dataclass(frozen=True)
class Document:
    """The result of a verb.

    Args:
        title: the model's name.
        about: a remark of the user, "" where there is none.
        source: the origin of the system, or "".
        space: "plane" or "space".
        method: "lagrange", "statics", ...; "" where nothing is derived.
        steps: its sections, in order.
        equations: the equations of motion as printed; empty where they are too long.
        definitions: sub-expressions with a name of their own, in the order of their use.
        entries: gives the JSON entries by name, with quantities as leaves; made on demand.
        failed: errors or open questions of the result; "" if there are none.
        notes: further remarks, a line each on stderr.
        certificate: the proof; None where none was made.
        interrupted: it holds the results up to an interruption.
        cautions: warnings of what is allowed in the model but probably a mistake.
        taken: the values that were read from typed text.
        notation: typesetting of its symbols in LaTeX.
        parameters: the values of those that have one, exact constants.
        answer_code: the exit code that is an answer: 5 where that is no.
        proven_in_full: its proof is printed check by check, and not in one line.
        language: the words in which it is printed.
        fragment: in LaTeX it is what one pastes into a document of one's own: "plain", "numbered"; "" for a whole file.
    """

    title: str
    about: str = ""
    source: str = ""
    space: str = ""
    method: str = ""
    steps: tuple[Step, ...] = ()
    equations: tuple[Equation, ...] = ()
    definitions: tuple[tuple[Node, Scalar], ...] = ()
    entries: Callable[[], Mapping[str, Any]] = _nothing
    failed: str = ""
    notes: tuple[str, ...] = ()
    certificate: Certificate | None = None
    interrupted: bool = False
    cautions: tuple[Problem, ...] = ()
    taken: tuple[Taken, ...] = ()
    notation: Notation = Notation()
    parameters: Mapping[str, Any] = field(default_factory=dict)
    answer_code: int = 0
    proven_in_full: bool = False
    language: Catalogue = OURS
    fragment: str = ""

    @property
    def source_words(self) -> str:
        """The sentence that names its source; "" where there is none."""
        return self.language.say(f"Source: {self.source}.") if self.source else ""

    def said_in(self, language: Catalogue) -> Document:
        """The document in another language: its words, its heads, the signs of its decimals."""
        steps, notation = tuple(map(language.step, self.steps)), replace(self.notation, comma=language.comma)
        return replace(self, steps=steps, failed=language.say(self.failed), language=language, notation=notation)

    @property
    def proof(self) -> str:
        """The proof as it is printed; "" where none was made."""
        if self.certificate is None:
            return ""
        return str(self.certificate) if self.proven_in_full else self.language.say(self.certificate.brief)

    def __getstate__(self) -> dict[str, Any]:
        """State to be pickled: the entries take the place of the function that makes them."""
        own = {name: self.__dict__[name] for name in self.__dataclass_fields__}
        return own | {"entries": Pickled(self.entries())}

    def __repr__(self) -> str:
        return f"<document {self.title!r} of {len(self.steps)} sections>"

    @property
    def nomenclature(self) -> tuple[Meaning, ...]:
        """Meanings of all symbols of the tables."""
        tables = (s for step in self.steps for s in step.statements if isinstance(s, Table))
        return tuple(row for table in tables for row in table.rows)

    @property
    def has_heads(self) -> bool:
        """True if its sections have titles: then it has one too."""
        return any(step.title for step in self.steps)

    @property
    def quantities(self) -> dict[str, Quantity]:
        """Every quantity by its place among the entries: reactions.reaction_y(A)."""
        return quantities_of(self.entries())

    @property
    def distrust(self) -> str:
        """Sentence that the proof contradicts the result; "" if it does not."""
        return self.language.say(DISTRUST) if self.certificate is not None and self.certificate.ok is False else ""

    @property
    def wrong(self) -> str:
        """Why the exit code is 3, or ""."""
        return "; ".join(filter(None, (self.distrust, self.failed)))

    @property
    def warnings(self) -> tuple[Problem, ...]:
        """Warnings that a user should read before using the result."""
        unchecked = self.certificate is not None and self.certificate.ok is None
        return (*self.cautions, *((NOTHING_CHECKED,) if unchecked else ()))


SECTION_GROUPS = {"motion": ("equations",), "energies": ("kinetic_energy", "work")}
"""Sections that are called by one name."""


def with_section(document: Document, name: str) -> Document:
    """The document with this one of its sections, or of the groups of them.

    Raises:
        UsageError: there is none of that name.
    """
    keys = SECTION_GROUPS.get(name, (name,))
    steps = tuple(step for step in document.steps if step.key in keys)
    if not steps:
        known = [*(step.key for step in document.steps if step.key), *SECTION_GROUPS]
        what = f"there is no section '{name}'"
        raise UsageError(what, fix=nearest(name, known) or f"one of {', '.join(known)}")
    return replace(document, steps=steps)


def quantities_of(entries: Mapping[str, Any]) -> dict[str, Quantity]:
    """Every quantity by its place among entries."""
    return dict(_leaves("", entries))


def document_of(model: Model, method: str, steps: tuple[Step, ...]) -> Document:
    """The document of a model, under its name, its remark and its source."""
    about, source = model.about or "", model.source or ""
    notation, values = notation_of(model), model.constant_parameters(Graph())
    return Document(model.name, about, source, model.space, method, steps, notation=notation, parameters=values)


def with_symbols(document: Document, symbols: Mapping[str, Symbol]) -> Document:
    """The document with symbols for names that are not the model's: of its reactions."""
    return replace(document, notation=document.notation.with_symbols(symbols))


def own_words(model: Model) -> Iterator[str]:
    """The words of a model's author, which no language changes: its names and remarks."""
    moving = (model.coordinates, model.speeds, model.states)
    tables = (model.parameters, *moving, model.inputs, model.unknowns, model.outputs)
    objects = (model.points, model.bodies, model.constraints, model.trusses, model.forces)
    yield from (name for table in (*tables, *objects) for name in table)
    parts = (part for table in (*tables, model.bodies) for part in table.values())
    yield from filter(None, (model.name, model.about, model.source, *(part.about for part in parts)))


def language_of(model: Model, requested: str = "") -> Catalogue:
    """The catalogue of the requested language, else of that of the model, for its documents.

    Raises:
        UsageError: there are no words in that language.
    """
    return catalogue(requested or model.language or OURS.language).beside(own_words(model))


def plain_document(
    model: Model,
    entries: Callable[[], Mapping[str, Any]],
    *statements: Statement,
    failed: str = "",
    notes: tuple[str, ...] = (),
    answer_code: int = 0,
) -> Document:
    """A document of one section without a head, for results that are no derivation."""
    steps = (Step("", "", statements),)
    document = Document(model.name, steps=steps, entries=entries, notation=notation_of(model))
    values = model.constant_parameters(Graph())
    return replace(document, failed=failed, notes=notes, parameters=values, answer_code=answer_code)


def lines_document(entries: Callable[[], Mapping[str, Any]], *lines: str) -> Document:
    """Lines of text that are of no model."""
    return Document("", steps=(Step("", "", (Lines(lines),)),), entries=entries)


def _leaves(name: str, entry: Any) -> Iterator[tuple[str, Quantity]]:
    if isinstance(entry, Quantity):
        yield name, entry
    elif isinstance(entry, Mapping):
        for key, inner in entry.items():
            yield from _leaves(f"{name}.{key}" if name else str(key), inner)
    elif isinstance(entry, (list, tuple)):
        for k, inner in enumerate(entry):
            yield from _leaves(f"{name}[{k}]", inner)


def notation_of(model: Model) -> Notation:
    """Notation that a model declares."""
    tables = (model.parameters, model.coordinates, model.speeds, model.states, model.inputs, model.unknowns)
    symbols = {name: part.symbol for table in tables for name, part in table.items() if part.symbol is not None}
    indices = {name: body.symbol.tex for name, body in model.bodies.items() if body.symbol is not None}
    constraints = {
        name: constraint.symbol.letter
        for name, constraint in model.constraints.items()
        if constraint.symbol is not None
    }
    return Notation(symbols, indices | {name: letter.tex for name, letter in constraints.items() if letter is not None})


def tables_called(document: Document) -> dict[str, TableFunction]:
    """The tables of values that the formulas of a document call, and their derivatives, by name."""
    found: dict[str, TableFunction] = {}
    statements = (statement for step in document.steps for statement in step.statements)
    parts: list[Any] = []
    for statement in statements:
        parts += parts_of(statement)
        exact = [row.quantity.exact or "" for row in statement.rows] if isinstance(statement, Listing) else []
        for text in filter(None, exact):
            code = parse(text, longest=len(text), tables=AS_WRITTEN).code
            found |= {what.name: TableFunction(what) for kind, what in code if kind == "sampled"}
    while parts:
        part = parts.pop()
        if isinstance(part, Node):
            called = (Sampled.of(x.args[1]) for x in order((part,)) if x.op == "sampled")
            found |= {sampled.name: TableFunction(sampled) for sampled in called if sampled.called}
        elif isinstance(part, (Name, Partial, Rate)):
            parts.append(part.of if isinstance(part, (Partial, Rate)) else part.by)
        elif isinstance(part, Matrix):
            parts += [entry for row in part.rows for entry in row]
    plain = {name.rstrip("'"): table for name, table in found.items() if "'" not in name}
    for name, table in plain.items():
        found.setdefault(f"{name}'", table.rate)
        found.setdefault(f"{name}''", table.rate.rate)
    return found
