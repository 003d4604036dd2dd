"""A document and the page that was made of it -> checks that the page, read back, says what the document holds.

The page is read by a reader of its own. The content is compared: every formula in numbers, every entry of
a table under its head, every word, in their order; not how it was made.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from decimal import Decimal
from functools import cached_property
from random import Random
from typing import Any

from eomgen.documents.document import Document, tables_called
from eomgen.documents.pages_read import (
    GREEK_LETTERS,
    PAGES,
    PageBlock,
    PageLine,
    SetLetters,
    Tokens,
    Tree,
    between_equals,
    closing_brace,
    names_of_tree,
    said_by,
    spoken,
    tokens_of,
    tree_value,
    typeset,
    typeset_name,
    unlike_words,
)
from eomgen.documents.statements import (
    Cell,
    Code,
    Entry,
    Formula,
    Found,
    Grid,
    Law,
    Lines,
    Listing,
    Matrix,
    Name,
    Omitted,
    Partial,
    Piece,
    Prose,
    Quantity,
    Rate,
    Side,
    Statement,
    Table,
    parts_of,
)
from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.proof import Check, checked, differing, unchecked
from eomgen.symbolic.expression import AS_WRITTEN, LONGEST, Graph, Node, Sampled, Scalar, TableFunction, order, parse
from eomgen.symbolic.numeric import READ_BACK, NoValue, evaluate, fifty_digits, tolerances
from eomgen.symbolic.print import Notation

NAME = "the page, read back, says what was found"
HOW = "a reader of its own, 50 digits"
SHOWN = 60  # characters of a quoted text
TRIES = 12  # random states, for one at which a formula has a value
LETTERED = frozenset("sin cos tan arcsin arccos arctan sinh cosh tanh ln min max det".split())
_SCALED = re.compile(r"(-?\d+(?:[.,]\d+)?)(?:·10(-?\d+))?")  # 5 · 10^-5
_NUMBER = re.compile(r"-?\d+(?:[.,]\d+)?(?:e[-+]?\d+)?")


class Unlike(Exception):
    """Raised where a page does not say what the document holds."""


@dataclass(frozen=True)
class Wanted:
    """Required content of one block of a page.

    Args:
        kind: as that of the block.
        pieces: of a heading and a paragraph.
        sides: of a formula.
        rows: of a table, its head first.
        lines: verbatim text.
    """

    kind: str
    pieces: tuple[Piece, ...] = ()
    sides: tuple[Side | Quantity, ...] = ()
    rows: tuple[tuple[Cell, ...], ...] = ()
    lines: tuple[str, ...] = ()


def page_read_back(document: Document, text: str, form: str) -> Iterator[Check]:
    """Checks that a page of LaTeX or Markdown says what its document holds.

    Args:
        text: the page, without its proof.
    """
    comparison = PageComparison(document)
    wanted = list(_wanted(document, form))
    yield from comparison.checks(wanted, list(PAGES[form](text)))


def _wanted(document: Document, form: str) -> Iterator[Wanted]:
    """Required blocks of a page, in order; a part of a page has no head, and titles where there are several."""
    part = form == "latex" and document.fragment
    titled = sum(bool(step.title) for step in document.steps) > 1 or not part
    if part:
        document = replace(document, certificate=None, title="", about="", source="")
    if document.distrust:
        yield Wanted("words", (document.distrust,))
    if not part:
        yield Wanted("heading", (document.title,))
    if document.about:
        yield Wanted("words", (document.about,))
    if document.source:
        yield Wanted("words", (document.source_words,))
    for step in document.steps:
        if step.title and titled:
            yield Wanted("heading", (step.title,))
        for statement in step.statements:
            yield from wanted_of(statement)


def _by_names(part: object) -> object:
    """A quantity with its symbols by their names: sections of a report are of several verbs, of a graph each."""
    if isinstance(part, Node):
        return part.name
    if isinstance(part, (Name, Entry, Partial, Rate)):
        return (type(part), *(_by_names(x) for x in vars(part).values()))
    return part


def wanted_of(statement: Statement) -> Iterator[Wanted]:
    if isinstance(statement, Prose):
        if any(not isinstance(piece, str) or piece.strip() for piece in statement.pieces):
            yield Wanted("words", statement.pieces)
    elif isinstance(statement, Formula):
        yield Wanted("formula", sides=statement.sides)
    elif isinstance(statement, Lines):
        yield Wanted("lines", lines=statement.lines)
    elif isinstance(statement, Listing):
        for row in statement.rows:
            yield from _of_row(row)
    else:
        grid = statement if isinstance(statement, Grid) else columns_of(statement)
        yield Wanted("table", rows=(grid.head, *grid.rows))


def _of_row(row: Found) -> Iterator[Wanted]:
    found = row.quantity
    way, message = (f"[{found.method}]" if found.method else ""), (f"({found.message})" if found.message else "")
    yield Wanted("words", (row.name, f": {row.words}" if row.words else "", way, message))
    if found.exact is not None or found.value is not None:
        yield Wanted("formula", sides=(*row.letters, found))


def columns_of(table: Table) -> Grid:
    """The columns of a table in which something stands."""
    rows = [(row.symbol, row.meaning, row.unit, row.value) for row in table.rows]
    kept = [k for k in range(len(table.head)) if any(row[k] != "" for row in rows)]
    return Grid(tuple(table.head[k] for k in kept), tuple(tuple(row[k] for k in kept) for row in rows))


@dataclass
class PageComparison:
    """Comparison of one document with its page.

    Args:
        values: to be compared in numbers: (place on the page, formula read there, formula of the document).
        left: {reason: places that could not be compared}.
        named: quantities that have a letter, by the letter, and the other way round.
        read: the number of parts read so far.
        laws: True if general laws stand in sentences as they are set, letter by letter.
    """

    document: Document
    values: list[tuple[str, Tree, Scalar]] = field(default_factory=list)
    left: dict[str, list[str]] = field(default_factory=dict)
    named: dict[Any, Any] = field(default_factory=dict)
    read: int = 0
    laws: bool = True

    @cached_property
    def notation(self) -> Notation:
        """Notation of the document, with distinct names."""
        return self.document.notation.reported_apart(_names_in(self.document))

    @cached_property
    def letters(self) -> SetLetters:
        """The letters of the document, as it declares them."""
        names = _names_in(self.document)
        bare = {(bare := name.rstrip("'")): self.notation.latex(bare) for name in names}
        tables = {name: self.notation.latex(name) for name in self.tables if "'" not in name}
        letters = SetLetters(bare, tuple(names), tables)
        if letters.alike:
            raise Unlike(f"these names look alike: {letters.alike[0]}")
        if wrong := misspelt(letters.bare, self.document.notation):
            raise Unlike(wrong)
        return letters

    @cached_property
    def leaning_letters(self) -> SetLetters:
        """The same where it is not said which letters stand upright."""
        bare = {name: " ".join(_leaning(tokens_of(tex))) for name, tex in self.letters.bare.items()}
        tables = {name: " ".join(_leaning(tokens_of(tex))) for name, tex in self.letters.tables.items()}
        return SetLetters(bare, self.letters.names, tables)

    @cached_property
    def tables(self) -> dict[str, TableFunction]:
        """The tables of values that its formulas call, with primes where one is differentiated."""
        return tables_called(self.document)

    def name_set(self, tex: str) -> str:
        """The name of the symbol that a formula is, also where it is not said which letters stand upright; ""."""
        leaning = " ".join(_leaning(tokens_of(tex)))
        return typeset_name(tex, self.letters) or typeset_name(leaning, self.leaning_letters)

    def checks(self, wanted: Sequence[Wanted], blocks: Sequence[PageBlock]) -> Iterator[Check]:
        """Checks that each block of the page is the required one; with unmade checks of what could not be read."""
        try:
            self.of_all(wanted, blocks)
            self.of_values()
        except Unlike as error:
            yield checked(NAME, str(error), HOW)
            return
        yield Check(NAME, "holds", HOW, f"of {len(wanted)}")
        for why, names in self.left.items():
            yield unchecked(NAME, f"{', '.join(names[:3])}{', ...' if len(names) > 3 else ''}: {why}", HOW)

    def of_all(self, wanted: Sequence[Wanted], blocks: Sequence[PageBlock]) -> None:
        """Compares each block of the page with the required one.

        Raises:
            Unlike: something else stands there.
        """
        if len(wanted) != len(blocks):
            kinds = next((k for k, (w, b) in enumerate(zip(wanted, blocks, strict=False)) if w.kind != b.kind), -1)
            where = f", {_reported(wanted[kinds])} is not where it belongs" if 0 <= kinds < len(wanted) else ""
            raise Unlike(f"{len(blocks)} things stand on the page for {len(wanted)}{where}")
        for want, block in zip(wanted, blocks, strict=True):
            if want.kind != block.kind:
                raise Unlike(f"where {_reported(want)} belongs stands a {block.kind}")
            self._of_one(want, block)

    def _of_one(self, want: Wanted, block: PageBlock) -> None:
        if want.kind in ("heading", "words"):
            self._pieces(want.pieces, block.words, _reported(want))
        elif want.kind == "formula":
            self._formula(want, block)
        elif want.kind == "lines":
            if spoken("".join(want.lines)) != spoken("".join(block.lines)):
                raise Unlike(f"other lines than {_reported(want)}")
        else:
            self._table(want, block)

    def _table(self, want: Wanted, block: PageBlock) -> None:
        if len(want.rows) != len(block.rows):
            raise Unlike(f"a table of {len(block.rows)} lines for {len(want.rows)} below {_reported(want)}")
        for cells, row in zip(want.rows, block.rows, strict=True):
            if len(cells) != len(row):
                raise Unlike(f"{len(row)} columns for {len(cells)} below {_reported(want)}")
            for head, cell, line in zip(want.rows[0], cells, row, strict=True):
                self._cell(cell, line, f"{_said(cells[0])}, {_said(head)}")

    def _cell(self, cell: Cell, line: PageLine, where: str) -> None:
        if not isinstance(cell, str):
            self._pieces((cell,), line, where)
        elif _NUMBER.fullmatch(cell) and len(line) == 1 and line[0].tex:
            self._number(line[0].tex, _float(cell), where)
        elif _NUMBER.fullmatch(cell) and (said := _SCALED.fullmatch("".join(part.character for part in line))):
            if wrong := differing(_float(f"{said[1]}e{said[2] or 0}"), _float(cell)):
                raise Unlike(f"{where}: {wrong}")
        else:
            self._pieces((cell,), line, where)

    def _number(self, tex: str, right: float, where: str) -> None:
        found = float(tree_value(self._tree(tokens_of(tex), where), {}, fifty_digits()))
        if wrong := differing(found, right):
            raise Unlike(f"{where}: {wrong}")

    def _pieces(self, pieces: Iterable[Piece | Side], line: PageLine, where: str) -> None:
        """Words and formulas of a line."""
        k = 0
        for piece in pieces:
            if isinstance(piece, (str, Code)):
                said = unlike_words(line[k:], piece if isinstance(piece, str) else piece.text)
                if said is None:
                    stands = "".join(part.character or f"${part.tex}$" for part in line[k : k + SHOWN])
                    raise Unlike(f"{where}: '{stands}' for '{_said(piece)[:SHOWN]}'")
                k += said
                continue
            if k == len(line) or not line[k].tex:
                raise Unlike(f"{where}: no formula for {_said(piece)}")
            if self.laws or not isinstance(piece, Law):
                self._sides((piece,), between_equals(tokens_of(line[k].tex)), where)
            elif _letters_of(line[k].tex) != _letters_of(piece.latex):
                raise Unlike(f"{where}: '{line[k].tex}' for {piece.text}")
            k += 1
        if k != len(line):
            raise Unlike(f"{where}: more stands there")

    def _formula(self, want: Wanted, block: PageBlock) -> None:
        self.read += sum(map(len, block.sides))
        if self.read > READ_BACK:
            self.left.setdefault("the page is too long to be read back whole", []).append(_reported(want))
            return
        *before, last = want.sides
        if isinstance(last, Quantity):
            self._sides(before, list(block.sides[: len(before)]), _reported(want))
            self._quantity(last, list(block.sides[len(before) :]), _reported(want))
        else:
            self._sides(want.sides, list(block.sides), _reported(want))

    def _quantity(self, found: Quantity, sides: list[Tokens], where: str) -> None:
        """exact = number unit"""
        if found.exact is not None:
            if not sides:
                raise Unlike(f"{where}: nothing stands there")
            self._text(found.exact, sides.pop(0), where)
        if found.value is not None:
            if not sides:
                raise Unlike(f"{where}: no number stands there")
            tokens = sides.pop(0)
            cut = tokens.index(r"\text") if r"\text" in tokens else len(tokens)
            number = float(tree_value(self._tree(tokens[:cut], where), {}, fifty_digits()))
            unit = spoken("".join(x for x in tokens[cut + 2 : -1] if x not in "${}").replace(r"\cdot", "·"))
            if wrong := differing(number, float(number_said(found))):
                raise Unlike(f"{where}: {wrong}")
            if unit != spoken(found.unit or ""):
                raise Unlike(f"{where}: '{unit}' for {found.unit}")
        if sides:
            raise Unlike(f"{where}: more stands there")

    def _sides(self, wanted: Iterable[Side | Quantity], sides: list[Tokens], where: str) -> None:
        sides = list(sides)
        for side in wanted:
            count = len(between_equals(tokens_of(side.latex))) if isinstance(side, Law) else 1
            if len(sides) < count:
                raise Unlike(f"{where}: {_said(side)} is missing")
            tokens, sides = sides[:count], sides[count:]
            if isinstance(side, Law):
                self._law(side, tokens, where)
            elif not isinstance(side, Quantity):
                self._side(side, tokens[0], where)
        if sides:
            raise Unlike(f"{where}: more stands there")

    def _side(
        self, side: Name | Entry | Partial | Rate | Omitted | Matrix | Scalar, tokens: Tokens, where: str
    ) -> None:
        if isinstance(side, (Name, Entry, Partial, Rate)):
            self._named(side, tokens, where)
        elif isinstance(side, Matrix):
            self._matrix(side, tokens, where)
        elif isinstance(side, Omitted):
            if str(side.operations) not in tokens:
                raise Unlike(f"{where}: another count than {side.operations} operations")
        else:
            self.values.append((where, self._tree(tokens, where), side))

    def _tree(self, tokens: Tokens, where: str) -> Tree:
        try:
            return typeset(tokens, self.letters)
        except ExpressionError as error:
            if self.laws:
                raise Unlike(f"{where}: {error.what}") from error
        try:
            return typeset(_leaning(tokens), self.leaning_letters)
        except ExpressionError as error:
            raise Unlike(f"{where}: {error.what}") from error

    def _text(self, text: str, tokens: Tokens, where: str) -> None:
        """Compares a formula on the page with a text of the grammar."""
        if len(text) > LONGEST:
            self.left.setdefault("too long to be read back", []).append(where)
            return
        graph = Graph()
        expression = parse(text, longest=len(text), tables=self.tables)
        symbols = {name: graph.symbol(name) for kind, name in expression.code if kind == "name"}
        self.values.append((where, self._tree(tokens, where), expression.evaluate(symbols | {"pi": graph.pi})))

    def _law(self, law: Law, sides: list[Tokens], where: str) -> None:
        """A general law as it stands; where its text is a formula of symbols it is that."""
        right = between_equals(tokens_of(law.latex))
        if sides != right and (self.laws or [*map(_unworded, sides)] != [*map(_unworded, right)]):
            raise Unlike(f"{where}: '{''.join(sides[0])}' for {law.text}")
        if _digits(law.text) != _digits(law.latex):
            raise Unlike(f"{where}: '{law.latex}' for {law.text}")
        try:
            expression = parse(law.text)
            names = [name for kind, name in expression.code if kind == "name" and name != "pi"]
            bare = {name: self.notation.latex(name) for name in names}
            tree = typeset(sides[0], SetLetters(bare, tuple(bare)))
        except ExpressionError:  # a law that is no formula of numbers
            return
        graph = Graph()
        symbols = {name: graph.symbol(name) for name in bare}
        self.values.append((where, tree, expression.evaluate(symbols | {"pi": graph.pi})))

    def _matrix(self, matrix: Matrix, tokens: Tokens, where: str) -> None:
        inside = tokens[len(_begin("pmatrix", r"\begin")) : -len(_begin("pmatrix", r"\end"))]
        rows = [_split(row, "&") for row in _split(inside, r"\\")]
        if [len(row) for row in rows] != [len(row) for row in matrix.rows]:
            raise Unlike(f"{where}: a matrix of other rows or columns")
        for row, entries in zip(rows, matrix.rows, strict=True):
            for entry, side in zip(row, entries, strict=True):
                self._sides((side,), between_equals(entry), where)

    def _named(self, side: Name | Entry | Partial | Rate, tokens: Tokens, where: str) -> None:
        """A quantity by its letter: equal letters are equal quantities; a derivative is read as the required one."""
        tex = " ".join(tokens)
        if isinstance(side, Rate) and isinstance(side.of, Node):
            self._symbol(f"{side.of.name}'", tokens, where)
            return
        if isinstance(side, Partial):
            begins = tokens[:1] == ("-",)
            if begins != (side.sign < 0):
                raise Unlike(f"{where}: the other sign for {_said(side)}")
            below = tokens[_after_partial(tokens[begins:], where) + begins :]
            self._symbol(side.by.name, below[2:-1], where)
        elif isinstance(side, Entry):
            row, column = _split(tokens[3:-1], ",")[:2] if tokens[-1:] == ("}",) else ((), ())
            self._symbol(side.row.name, row, where)
            self._symbol(side.column.name, column, where)
        if isinstance(side, Name):
            self._name(side, tokens, where)
        quantity = _by_names(side)
        for key, value in ((("tex", tex), quantity), (("side", quantity), tex)):
            if self.named.setdefault(key, value) != value:
                raise Unlike(f"{where}: '{tex}' stands for {_said(side)} and for another quantity")

    def _name(self, side: Name, tokens: Tokens, where: str) -> None:
        """Its exponent, the coordinate that it belongs to, and whose it is."""
        raised = tokens[-4:-2] == ("^", "{") and tokens[-2].isdigit()
        if (tokens[-2] if raised else "1") != str(side.power):
            raise Unlike(f"{where}: another power of {_said(side)}")
        index = tokens[tokens.index("_") + 2 : -4 if raised else None] if "_" in tokens else ()
        if side.by is not None and not any(self._is(side.by.name, part) for part in _split(index[:-1], ",")):
            raise Unlike(f"{where}: '{''.join(tokens)}' for {_said(side)} of {side.by.name}")
        whose = side.of.removesuffix(".center")
        if whose and whose.partition(".")[0] not in self.notation.indices and not _spells(index, whose):
            raise Unlike(f"{where}: '{''.join(tokens)}' for {_said(side)} of {side.of}")

    def _is(self, name: str, tokens: Tokens) -> bool:
        try:
            return typeset(tokens, self.letters) == ("symbol", name)
        except ExpressionError:
            return False

    def _symbol(self, name: str, tokens: Tokens, where: str) -> None:
        found = self._tree(tokens, where)
        if found != ("symbol", name):
            raise Unlike(f"{where}: '{''.join(tokens)}' for {name}")

    def of_values(self) -> None:
        """Compares the formulas of the page with those of the document at random values of the symbols.

        Raises:
            Unlike: one has another value.
        """
        random, arithmetic = Random(0), fifty_digits()
        names = {name for _, tree, meant in self.values for name in (*names_of_tree(tree), *_leaves(meant))}
        todo = self.values
        for _ in range(TRIES):
            state = {name: arithmetic.number(random.randint(1, 997)) / 499 for name in sorted(names)}
            todo = list(_valueless(todo, state | {f"{name}(": table for name, table in self.tables.items()}))
            if not todo:
                return
        self.left.setdefault("at none of the states tried it has a value", []).extend(where for where, *_ in todo)


InNumbers = tuple[str, Tree, Scalar]


def _valueless(todo: Sequence[InNumbers], state: Mapping[str, Any]) -> Iterator[InNumbers]:
    """Comparisons without a value at a state, to be tried at another.

    Raises:
        Unlike: the page gives another number there.
    """
    for each, right in zip(todo, _rights([meant for *_, meant in todo], state), strict=True):
        where, tree, _ = each
        try:
            found = tree_value(tree, state, fifty_digits())
        except NoValue:
            yield each
            continue
        if right != right:
            yield each
        elif abs(found - right) > tolerances.COMPUTED * (abs(found) + abs(right)) + tolerances.ZERO_AT_50:
            raise Unlike(f"{where}: {float(found):.10g} stands there for {float(right):.10g}")


def _rights(scalars: Sequence[Scalar], state: Mapping[str, Any]) -> list[Any]:
    """Values of scalars, those of each graph together; nan where one has no value."""
    arithmetic = fifty_digits(partial=True)
    found = [arithmetic.number(x) if type(x) is not Node else None for x in scalars]
    graphs: dict[Any, list[int]] = {}
    for k, x in enumerate(scalars):
        if type(x) is Node:
            graphs.setdefault(x.graph, []).append(k)
    for places in graphs.values():
        own = [scalars[k] for k in places]
        values = {x: state[name] for name, x in _leaf_nodes(own)}
        for k, value in zip(places, evaluate(own, values, arithmetic), strict=True):
            found[k] = value
    return found


def _leaf_nodes(scalars: Iterable[Scalar]) -> Iterator[tuple[str, Node]]:
    """Named leaves of formulas: symbols, and functions of time given by samples."""
    for x in order(tuple(scalars)):
        if x.op == "symbol":
            yield x.name, x
        elif x.op == "sampled" and not Sampled.of(x.args[1]).called:
            yield Sampled.of(x.args[1]).name, x


def _leaves(x: Scalar) -> list[str]:
    return [name for name, _ in _leaf_nodes((x,))] if type(x) is Node else []


def _names_in(document: Document) -> list[str]:
    """The names of all symbols that stand in the formulas of a document, each once, in their order."""
    found: dict[str, None] = {}
    for statement in (statement for step in document.steps for statement in step.statements):
        if isinstance(statement, Listing):
            for row in statement.rows:
                if row.quantity.exact is not None:
                    exact = row.quantity.exact
                    code = parse(exact, longest=len(exact), tables=AS_WRITTEN).code
                    found |= {name: None for kind, name in code if kind == "name" and name != "pi"}
        for part in parts_of(statement):
            found |= dict.fromkeys(_names_of(part))
    return list(found)


def _names_of(part: Any) -> list[str]:
    if isinstance(part, Node):
        return _leaves(part)
    if isinstance(part, Name):
        return _names_of(part.by)
    if isinstance(part, Entry):
        return [part.row.name, part.column.name]
    if isinstance(part, Partial):
        return [*_names_of(part.of), part.by.name]
    if isinstance(part, Matrix):
        return [name for row in part.rows for entry in row for name in _names_of(entry)]
    if isinstance(part, Rate):
        return [f"{part.of.name}'"] if isinstance(part.of, Node) else _names_of(part.of)
    return []


def _digits(text: str) -> list[str]:
    """The numbers of a text in their order, 2e-05 as 2 10 5."""
    plain = unicodedata.normalize("NFKC", re.sub(r"([⁰¹²³⁴-⁹]+)", r" \1", text))
    return [x.lstrip("0") for x in re.findall(r"\d+(?:\.\d+)?", re.sub(r"(?<=\d)e[-+]?(?=\d)", " 10 ", plain))]


def _reported(wanted: Wanted) -> str:
    """Beginning of a required block, quoted for a message."""
    pieces = wanted.pieces or wanted.sides or (wanted.rows[0] if wanted.rows else ()) or wanted.lines[:1]
    return f"'{' '.join(map(_said, pieces))[:SHOWN]}'"


def _said(piece: Any) -> str:
    """A piece, for a message."""
    if isinstance(piece, (Code, Law)):
        return piece.text
    if isinstance(piece, Node):
        return piece.name if piece.op == "symbol" else "a formula"
    if isinstance(piece, Quantity):
        return piece.exact or piece.number
    return str(piece) if isinstance(piece, str) else getattr(piece, "letter", type(piece).__name__.lower())


def _float(digits: str) -> float:
    """A number of a page, with a decimal point or comma."""
    return float(digits.replace(",", "."))


def number_said(found: Quantity) -> str:
    """The number of a quantity as it is due on a page: rounded by decimal arithmetic where digits are requested."""
    value = math.nan if found.value is None else float(found.value)
    if found.digits is None or not math.isfinite(value):
        return format(value, ".10g")
    exact = Decimal(value)
    rounded = exact
    for _ in range(2):  # 9.999 becomes 10.00, which has a digit more, and then 10.0
        rounded = exact.quantize(Decimal(1).scaleb((rounded.adjusted() if rounded else 0) - found.digits + 1))
    long = bool(exact) and not -4 <= rounded.adjusted() < 6
    return f"{float(rounded):.{found.digits - 1}e}" if long else f"{rounded:f}"


def _letters_of(tex: str) -> str:
    """The letters, digits and equality signs of a formula, in their order."""
    greek = {command: letter for letter, command in GREEK_LETTERS.items()}
    named = (
        greek.get(x.replace("var", ""), x[1:] if x[1:] in LETTERED else "" if x[:1] == "\\" else x)
        for x in tokens_of(tex)
    )
    return "".join(c for x in named for c in unicodedata.normalize("NFKC", x) if c.isalnum() or c == "=")


def _leaning(tokens: Tokens) -> Tokens:
    r"""n1 for \mathrm{n1}."""
    found, k = list(tokens), 0
    while r"\mathrm" in found[k:]:
        k = found.index(r"\mathrm", k)
        end = closing_brace(tuple(found), k + 1)
        found[k : end + 1] = found[k + 2 : end]
    return tuple(found)


def _unworded(tokens: Tokens) -> Tokens:
    """Tokens without those that mark where words begin and end."""
    return tuple(x for x in tokens if x not in ("$", r"\text", "{", "}"))


def _split(tokens: Tokens, between: str) -> list[Tokens]:
    """Parts between the separators that are outside of all braces and brackets."""
    found: list[list[str]] = [[]]
    depth = 0
    for x in tokens:
        depth += (x in "{(" or x == r"\begin") - (x in "})" or x == r"\end")
        if x == between and not depth:
            found.append([])
        else:
            found[-1].append(x)
    return [tuple(part) for part in found]


def misspelt(letters: Mapping[str, str], notation: Notation) -> str:
    """The first symbol in whose letters an index of its name is missing, R_{bar} of R_bar_x; "" of none.

    Args:
        letters: LaTeX by name.
        notation: declared symbols are set as they are declared.
    """
    for name, tex in letters.items():
        bare = name.rstrip("'")
        if bare in notation.symbols or not bare.isidentifier():
            continue
        tokens = tokens_of(tex)
        indices = [piece for piece in bare.split("_")[1:] if piece and piece not in notation.indices]
        if not all(_spells(tokens, piece) for piece in indices):
            return f"'{tex}' for {name}"
    return ""


def _spells(tokens: Tokens, name: str) -> bool:
    """True if the letters of an index are those of a name."""
    said = "".join(spoken(said_by(x)) or x for x in tokens if x not in (r"\mathrm", r"\,"))
    return _alone(name) in _alone(said)


def _alone(text: str) -> str:
    """Its letters and digits; a Greek letter by its name."""
    named = "".join(
        unicodedata.name(c).rpartition(" ")[2].lower() if "GREEK" in unicodedata.name(c, "") else c for c in text
    )
    return "".join(c for c in named if c.isalnum()).lower()


def _begin(kind: str, command: str) -> Tokens:
    return (command, "{", *kind, "}")


def _after_partial(tokens: Tokens, where: str) -> int:
    r"""Index of the brace at which the lower half of \frac{\partial T}{\partial q} begins."""
    if tokens[:2] != (r"\frac", "{"):
        raise Unlike(f"{where}: no derivative stands there")
    k = closing_brace(tokens, 1)
    if tokens[k + 1 : k + 3] != ("{", r"\partial"):
        raise Unlike(f"{where}: no derivative stands there")
    return k + 1
