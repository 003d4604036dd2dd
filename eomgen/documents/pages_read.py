r"""Page of LaTeX or Markdown as it is written -> its blocks in order: headings, words, formulas, tables; and numbers.

The reader knows the meaning of \subsection*, $$ and |, and shares nothing with the writer.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property, reduce
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Fraction
from eomgen.symbolic.numeric import Arithmetic, NoValue

GREEK = "alpha beta gamma delta zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi omega"
_CHARACTERS = {
    rf"\{x}": unicodedata.lookup(f"GREEK SMALL LETTER {x.replace('lambda', 'lamda')}") for x in GREEK.split()
}
_CHARACTERS |= {
    rf"\{x.title()}": unicodedata.lookup(f"GREEK CAPITAL LETTER {x.replace('lambda', 'lamda')}") for x in GREEK.split()
}
GREEK_LETTERS = {letter: command for command, letter in _CHARACTERS.items()}
_CHARACTERS |= {r"\varepsilon": "ε", r"\cdot": "·", r"^{\circ}": "°"}
_COMMANDS = {
    r"\textbackslash": "\\",
    r"\textasciicircum": "^",
    r"\textasciitilde": "~",
    r"\textless": "<",
    r"\textgreater": ">",
}
_SILENT = frozenset((r"\texttt", r"\textbf", r"\text", r"\textsuperscript", r"\emph"))
_RAISED = re.compile(r"\^\{(-?\d+)\}")
_GROUPING = str.maketrans({"^": "", "(": "", ")": "", "*": "·", "\u2212": "-"})
_TABLE = re.compile(r"\\begin\{(tabular|longtable)\}")
_BEGINS = (r"\[\begin{aligned}", r"\begin{", r"\medskip", r"\section*", r"\subsection*")
_HEADING = re.compile(r"\\(?:sub)?section\*\{(.*)\}")
_HEAD_ENDS = re.compile(r" \\\\ \\hline \\noalign\{\\vskip 3pt\}(?: \\endhead)?(?:\n|\Z)")


@dataclass(frozen=True)
class PagePart:
    """A character of a page, or a formula between dollars.

    Args:
        tex: of the formula; "" of a character.
    """

    character: str = ""
    tex: str = ""


PageLine = tuple[PagePart, ...]


@dataclass(frozen=True)
class PageBlock:
    """One block of a page.

    Args:
        kind: "heading", "words", "formula", "table" or "lines".
        words: of a heading and a paragraph.
        sides: of a formula.
        rows: of a table, its head first.
        lines: lines of a block that is printed verbatim.
    """

    kind: str
    words: PageLine = ()
    sides: tuple[Tokens, ...] = ()
    rows: tuple[tuple[PageLine, ...], ...] = ()
    lines: tuple[str, ...] = ()


def spoken(text: str) -> str:
    """Words as they are compared: without blanks and brackets, exponents as digits, a dot for a product."""
    return "".join(unicodedata.normalize("NFKC", text).translate(_GROUPING).split())


def said_by(tex: str) -> str:
    r"""Character that a formula stands for in a sentence: $\cdot$, $^{2}$; "" for any other formula."""
    raised = _RAISED.fullmatch(tex)
    return raised[1] if raised else _CHARACTERS.get(tex, "")


def latex_page(text: str) -> Iterator[PageBlock]:
    """Blocks of a page of LaTeX, or of a part of one that is pasted into another."""
    whole = "\\begin{document}\n" in text
    body = text.partition("\\begin{document}\n")[2].rpartition("\\end{document}")[0] if whole else text
    lines = [line for line in body.split("\n") if whole or not line.startswith("%")]
    while lines:
        line = lines.pop(0)
        if not line or line == r"\medskip":
            continue
        heading = _HEADING.fullmatch(line)
        if heading is not None:
            yield PageBlock("heading", latex_line(heading[1]))
        elif line == r"\[\begin{aligned}":
            yield from displayed("\n".join(_until(lines, r"\end{aligned}\]")))
        elif line == r"\begin{align}":
            numbered = (row.replace(r"\notag ", "") for row in _until(lines, r"\end{align}"))
            yield from displayed("\n".join(numbered))
        elif line == r"\begin{verbatim}":
            yield PageBlock("lines", lines=tuple(_until(lines, r"\end{verbatim}")))
        elif kind := _TABLE.match(line):
            head, _, rest = _parted("\n".join(_until(lines, rf"\end{{{kind[1]}}}")))
            rows = [head, *(row.removesuffix(r" \\") for row in rest.split("\n") if row)]
            yield PageBlock("table", rows=tuple(tuple(map(latex_line, _cells(row, "&"))) for row in rows))
        else:
            paragraph = [line]
            while lines and lines[0] and not lines[0].startswith(_BEGINS):
                paragraph.append(lines.pop(0))
            yield PageBlock("words", latex_line("\n".join(paragraph)))


def _until(lines: list[str], end: str) -> Iterator[str]:
    """The lines up to the one that begins with the end, taken away with it."""
    while lines:
        line = lines.pop(0)
        if line.startswith(end):
            return
        yield line


def _parted(table: str) -> tuple[str, str, str]:
    end = _HEAD_ENDS.search(table)
    return (table, "", "") if end is None else (table[: end.start()], end[0], table[end.end() :])


def markdown_page(text: str) -> Iterator[PageBlock]:
    """Blocks of a page of Markdown."""
    for fenced, block in _markdown_blocks(text):
        if fenced:
            yield PageBlock("lines", lines=tuple(block.split("\n")))
        elif block.startswith("$$\n"):
            inside = block.removeprefix("$$\n\\begin{aligned}\n").removesuffix("\n\\end{aligned}\n$$")
            yield from displayed(inside)
        elif block.startswith("#"):
            yield PageBlock("heading", markdown_line(block.lstrip("#")))
        elif block.startswith("| "):
            head, _, *rows = block.split("\n")
            cells = [_cells(row.strip()[1:-1], "|") for row in (head, *rows)]
            yield PageBlock("table", rows=tuple(tuple(map(markdown_line, row)) for row in cells))
        else:
            yield PageBlock("words", markdown_line(block))


def _markdown_blocks(text: str) -> Iterator[tuple[bool, str]]:
    """(True for a fenced block, its text)."""
    for k, part in enumerate(re.split(r"^```$\n?", text, flags=re.MULTILINE)):
        if k % 2:
            yield True, part.removesuffix("\n")
        else:
            yield from ((False, block.strip("\n")) for block in re.split(r"\n{2,}", part) if block.strip())


def displayed(rows: str) -> Iterator[PageBlock]:
    r"""The formulas of an aligned block: a row that begins with &\quad or &= goes on with the one before it."""
    formulas: list[list[str]] = []
    for row in rows.split(" \\\\\n"):
        goes_on = row.startswith(("&\\quad ", "&= "))
        lead, mark, rest = row.partition("&")
        bare = (f"{lead}{rest}" if mark else row).removeprefix("\\quad ")
        if goes_on and formulas:
            formulas[-1].append(bare)
        else:
            formulas.append([bare])
    for formula in formulas:
        yield PageBlock("formula", sides=tuple(between_equals(tokens_of(" ".join(formula)))))


def _cells(row: str, between: str) -> list[str]:
    """Cells of a row; a bar that is escaped or stands in a formula does not separate cells."""
    found, in_formula, k = [""], False, 0
    while k < len(row):
        step = 2 if row[k] == "\\" else 1
        piece = row[k : k + step]
        in_formula ^= piece == "$"
        if piece == between and not in_formula:
            found.append("")
        else:
            found[-1] += piece
        k += step
    return found


def latex_line(text: str) -> PageLine:
    """Words of LaTeX, escapes undone."""
    return tuple(_line(text, _latex_character))


def markdown_line(text: str) -> PageLine:
    """Words of Markdown, escapes undone."""
    return tuple(_line(text, _markdown_character))


def _line(text: str, character: Callable[[str, int], tuple[str, int]]) -> Iterator[PagePart]:
    k = 0
    while k < len(text):
        if text[k] == "$":
            end = _formula_ends(text, k + 1)
            yield PagePart(tex=text[k + 1 : end].strip())
            k = end + 1
            continue
        found, k = character(text, k)
        yield from (PagePart(x) for x in spoken(found))


def _formula_ends(text: str, k: int) -> int:
    """Index at which a formula ends; a dollar in its own \\text belongs to it."""
    depth = 0
    while k < len(text):
        if text[k] == "\\":
            k += 2
            continue
        depth += (text[k] == "{") - (text[k] == "}")
        if text[k] == "$" and depth <= 0:
            return k
        k += 1
    return k


def _latex_character(text: str, k: int) -> tuple[str, int]:
    command = re.compile(r"\\[a-zA-Z]+").match(text, k)
    if command is not None:
        end = command.end()
        known = _COMMANDS.get(command[0])
        if known is not None:
            return known, end + 2 * text.startswith("{}", end)
        return "" if command[0] in _SILENT else command[0], end
    if text[k] == "\\":
        return text[k + 1 : k + 2], k + 2
    return "" if text[k] in "{}" else text[k], k + 1


def _markdown_character(text: str, k: int) -> tuple[str, int]:
    if text[k] == "\\":
        return text[k + 1 : k + 2], k + 2
    if text[k] == "`":
        end = text.find("`", k + 1)
        return (text[k + 1 : end], end + 1) if end > k else (text[k], k + 1)
    return "" if text.startswith("**", k) else text[k], k + 1 + text.startswith("**", k)


PAGES: Mapping[str, Callable[[str], Iterable[PageBlock]]] = {"latex": latex_page, "markdown": markdown_page}


def unlike_words(found: Sequence[PagePart], wanted: str) -> int | None:
    """Number of parts that say these words; None where they say others."""
    rest, k = spoken(wanted), 0
    while rest:
        if k == len(found):
            return None
        said = found[k].character or spoken(said_by(found[k].tex))
        if not said or not rest.startswith(said):
            return None
        rest, k = rest[len(said) :], k + 1
    return k


# -------- typeset ---------------------------------------------------------------------------------------------
# Formulas as they are typeset -> numbers: a reader of LaTeX that shares nothing with the writer.
#
# It reads as a person does: what stands side by side is multiplied, \sin x ends where the next function, sign or
# bracket begins, a\big/b is a quotient, dots over a letter are rates of it.


Tokens = tuple[str, ...]
Tree = tuple[Any, ...]  # (operation, *parts); ("number", c), ("symbol", name)
_TOKEN = re.compile(r"\\(?:[a-zA-Z]+|.)|\d+(?:\.\d+)?|\S")
_LONE = re.compile(r"(?<!\\)([_^])\s*([^\s{}\\]|\\[a-zA-Z]+(?![a-zA-Z]|\s*\{))")  # an index without braces is one sign
_DOTS = {r"\dot": 1, r"\ddot": 2, r"\dddot": 3}
_BLANKS = frozenset((r"\,", r"\ ", r"\quad"))
_SIZES = frozenset((r"\left", r"\right", r"\bigl", r"\bigr", r"\big"))
_OF_ONE = {rf"\{x}": x for x in "sin cos tan sinh cosh tanh".split()} | {
    r"\arcsin": "asin",
    r"\arccos": "acos",
    r"\arctan": "atan",
    r"\ln": "log",
}
_OF_MORE = {r"\min": "min", r"\max": "max"}
_NAMED = {"sign": "sign", "atan2": "atan2"}
_RELATIONS = {"<": "less", r"\leq": "less_equal"}
_ENDS = frozenset(("+", "-", ")", "}", ",", "&", r"\\", r"\end", "<", r"\leq", "=", r"\rvert", "/"))


def tokens_of(tex: str) -> Tokens:
    """The commands, numbers and letters of a formula; an index in braces always, L_{x} for L_x."""
    tex = tex.replace("{,}", ".")  # a decimal comma
    return tuple("|" if x == r"\vert" else x for x in _TOKEN.findall(_LONE.sub(r"\1{\2}", tex)))


def between_equals(tokens: Tokens) -> list[Tokens]:
    """Sides between the equality signs that are not inside brackets or braces."""
    found: list[list[str]] = [[]]
    depth = 0
    for x in tokens:
        depth += (x in "{(" or x == r"\begin") - (x in "})" or x == r"\end")
        if x == "=" and not depth:
            found.append([])
        else:
            found[-1].append(x)
    return [tuple(side) for side in found]


@dataclass(frozen=True)
class SetLetters:
    """Typesetting of symbols.

    Args:
        bare: the LaTeX of each symbol by its name without primes.
        names: all symbols, with primes.
        tables: the LaTeX of each table of values by its name.
    """

    bare: Mapping[str, str]
    names: tuple[str, ...]
    tables: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def _known(self) -> dict[tuple[Tokens, int], list[str]]:
        found: dict[tuple[Tokens, int], list[str]] = {}
        for name in self.names:
            bare = name.rstrip("'")
            tokens, dots = _undotted(tokens_of(self.bare[bare]))
            found.setdefault((tokens, dots + len(name) - len(bare)), []).append(name)
        return found

    @cached_property
    def _lengths(self) -> dict[str, list[int]]:
        """first letter -> how many tokens symbols have that begin so, the longest first."""
        found: dict[str, set[int]] = {}
        for tokens, _ in self._known:
            found.setdefault(tokens[0], set()).add(len(tokens))
        return {first: sorted(lengths, reverse=True) for first, lengths in found.items()}

    @property
    def alike(self) -> list[str]:
        """Names of symbols that look the same in print."""
        return [" and ".join(names) for names in self._known.values() if len(names) > 1]

    def table_at(self, tokens: Tokens, k: int) -> tuple[str, int]:
        """(name, with primes, where its argument begins) of a table that begins at a place; ("", k) of none."""
        for name, tex in self.tables.items():
            own = tokens_of(tex)
            end = k + len(own)
            if tokens[k:end] == own:
                while tokens[end : end + 1] == ("'",):
                    name, end = f"{name}'", end + 1
                if "(" in tokens[end : end + 2]:
                    return name, end
        return "", k

    def at(self, tokens: Tokens, k: int) -> tuple[str, int]:
        """(name, where it ends) of the longest symbol that begins at a place; ("", k) where none does."""
        rest, dots = _undotted(tokens[k:])
        for length in self._lengths.get(rest[0] if rest else "", ()):
            if names := self._known.get((rest[:length], dots)):
                return names[0], len(tokens) - len(rest) + length
        return "", k


def _undotted(tokens: Tokens) -> tuple[Tokens, int]:
    r"""\ddot{x}_{1} as x_{1} with two dots."""
    dots = 0
    while len(tokens) > 2 and tokens[0] in _DOTS and tokens[1] == "{":
        end = closing_brace(tokens, 1)
        dots += _DOTS[tokens[0]]
        tokens = tokens[2:end] + tokens[end + 1 :]
    return tokens, dots


def closing_brace(tokens: Tokens, k: int) -> int:
    """Index at which the brace that opens at k closes."""
    depth = 0
    for i in range(k, len(tokens)):
        depth += (tokens[i] == "{") - (tokens[i] == "}")
        if not depth:
            return i
    raise ExpressionError("a brace is not closed", k)


class TypesetReading:
    """A formula that is read.

    Args:
        tokens: without blanks that say nothing.
    """

    def __init__(self, tokens: Tokens, letters: SetLetters) -> None:
        self.tokens, self.letters, self.k = tokens, letters, 0

    def whole(self) -> Tree:
        """The formula.

        Raises:
            ExpressionError: it is none.
        """
        found = self._sum()
        if self._next():
            raise self._wrong()
        return found

    def _next(self) -> str:
        while self.k < len(self.tokens) and (self.tokens[self.k] in _BLANKS or self.tokens[self.k] in _SIZES):
            self.k += 1
        return self.tokens[self.k] if self.k < len(self.tokens) else ""

    def _wrong(self) -> ExpressionError:
        return ExpressionError(f"'{''.join(self.tokens[self.k : self.k + 6])}' is no formula", self.k)

    def _take(self, *wanted: str) -> None:
        for token in wanted:
            if self._next() != token:
                raise self._wrong()
            self.k += 1

    def _given(self, token: str) -> bool:
        if self._next() != token:
            return False
        self.k += 1
        return True

    def _sum(self) -> Tree:
        found: list[Tree] = []
        while not found or self._next() in ("+", "-"):
            minus = self._given("-")
            if not minus:
                self._given("+")
            term = self._term()
            found.append(("neg", term) if minus else term)
        return found[0] if len(found) == 1 else ("sum", *found)

    def _term(self) -> Tree:
        above = self._product()
        return ("div", above, self._product()) if self._given("/") else above

    def _product(self) -> Tree:
        found = [self._power()]
        while (token := self._next()) and token not in _ENDS:
            if token == r"\cdot":
                self.k += 1
            found.append(self._power())
        return found[0] if len(found) == 1 else ("product", *found)

    def _power(self) -> Tree:
        base = self._atom()
        return ("pow", base, self._group(self._sum)) if self._given("^") else base

    def _group(self, read: Callable[[], Tree]) -> Tree:
        self._take("{")
        found = read()
        self._take("}")
        return found

    def _atom(self) -> Tree:
        token = self._next()
        table, begun = self.letters.table_at(self.tokens, self.k)
        if table:
            self.k = begun
            self._take("(")
            return ("table", table, *self._arguments())
        name, end = self.letters.at(self.tokens, self.k)
        if token == "e" and self._is_exponential(name, end):
            self.k += 2
            return ("exp", self._group(self._sum))
        if name:
            self.k = end
            return ("symbol", name)
        if token[:1].isdigit():
            self.k += 1
            return ("number", Fraction(token) if "." in token else int(token))
        if token in _OF_ONE or token in _OF_MORE or token == r"\operatorname":
            return self._function()
        read = self._FIRST.get(token)
        if read is None:
            raise self._wrong()
        self.k += 1
        return read(self)

    def _is_exponential(self, name: str, end: int) -> bool:
        """e^{x}; of a symbol e a whole power is that of the symbol."""
        after = self.tokens[self.k + 1 : self.k + 3]
        if name:
            return end == self.k + 1 and after == ("^", "{") and not self.tokens[self.k + 3].isdigit()
        return after == ("^", "{")

    def _function(self) -> Tree:
        token = self._next()
        self.k += 1
        if token == r"\operatorname":
            end = closing_brace(self.tokens, self.k)
            op = _NAMED.get("".join(self.tokens[self.k + 1 : end]), "")
            self.k = end + 1
        else:
            op = _OF_ONE.get(token) or _OF_MORE[token]
        exponent = self._group(self._sum) if self._given("^") else None
        found: Tree = (op, *(self._arguments() if self._given("(") else (self._bare(),)))
        return found if exponent is None else ("pow", found, exponent)

    def _arguments(self) -> list[Tree]:
        found = [self._sum()]
        while self._given(","):
            found.append(self._sum())
        self._take(")")
        return found

    def _bare(self) -> Tree:
        """Argument of a function without brackets: as far as letters and numbers go."""
        found = [self._power()]
        while (token := self._next()) and token not in _ENDS and not self._begins_function(token):
            if token == r"\cdot":
                self.k += 1
            found.append(self._power())
        return found[0] if len(found) == 1 else ("product", *found)

    def _begins_function(self, token: str) -> bool:
        known = token in _OF_ONE or token in _OF_MORE or token in (r"\operatorname", r"\begin", "(", "|")
        return known and not self.letters.at(self.tokens, self.k)[0]

    def _fraction(self) -> Tree:
        return ("div", self._group(self._sum), self._group(self._sum))

    def _root(self) -> Tree:
        return ("sqrt", self._group(self._sum))

    def _bracket(self) -> Tree:
        found = self._sum()
        self._take(")")
        return found

    def _size(self) -> Tree:
        found = self._sum()
        self._take(r"\rvert")
        return ("abs", found)

    def _turn(self) -> Tree:
        return ("pi",)

    def _cases(self) -> Tree:
        r"""\begin{cases} a & x < y \\ b & \text{otherwise} \end{cases}"""
        self._take("{", *"cases", "}")
        rows: list[tuple[Tree, Tree]] = []
        while True:
            value = self._sum()
            self._take("&")
            if self._given(r"\text"):
                self._take("{", *"otherwise", "}", r"\end", "{", *"cases", "}")
                return reduce(lambda rest, row: ("select", row[1], row[0], rest), reversed(rows), value)
            rows.append((value, self._condition()))
            self._take(r"\\")

    def _condition(self) -> Tree:
        left, token = self._sum(), self._next()
        if token not in _RELATIONS:
            raise self._wrong()
        self.k += 1
        return (_RELATIONS[token], left, self._sum())

    _FIRST: Mapping[str, Callable[[TypesetReading], Tree]] = {
        r"\frac": _fraction,
        r"\tfrac": _fraction,
        r"\sqrt": _root,
        "(": _bracket,
        r"\lvert": _size,
        r"\pi": _turn,
        r"\begin": _cases,
    }


def typeset(tokens: Sequence[str], letters: SetLetters) -> Tree:
    """A formula of LaTeX as a tree.

    Raises:
        ExpressionError: it is none.
    """
    return TypesetReading(tuple(tokens), letters).whole()


def typeset_name(tex: str, letters: SetLetters) -> str:
    """Name of the symbol that a formula is; "" of any other formula."""
    try:
        tree = typeset(tokens_of(tex), letters)
    except ExpressionError:
        return ""
    return str(tree[1]) if tree[0] == "symbol" else ""


def names_of_tree(tree: Tree) -> Iterable[str]:
    """The names of the symbols of a tree."""
    if tree[0] == "symbol":
        yield tree[1]
    for part in tree[1:]:
        if isinstance(part, tuple):
            yield from names_of_tree(part)


def tree_value(tree: Tree, values: Mapping[str, Any], arithmetic: Arithmetic) -> Any:
    """A tree in numbers.

    Raises:
        NoValue: it has none there.
    """
    op, *parts = tree
    if op == "number":
        return arithmetic.number(parts[0])
    if op == "symbol":
        return values[parts[0]]
    if op == "select":
        condition, if_true, if_false = parts
        return tree_value(if_true if tree_value(condition, values, arithmetic) else if_false, values, arithmetic)
    if op == "table":
        name, argument = parts
        x = tree_value(argument, values, arithmetic)
        return values[f"{name}("].function.at(x, arithmetic.number, arithmetic.functions["pi"]())
    known = [tree_value(part, values, arithmetic) for part in parts]
    if op == "sum":
        return sum(known[1:], start=known[0])
    if op == "product":
        return reduce(lambda a, b: a * b, known)
    if op in ("min", "max"):
        return (min if op == "min" else max)(known)
    try:
        return arithmetic.functions[op](*known)
    except (ValueError, ZeroDivisionError, OverflowError) as error:
        raise NoValue(f"'{op}' outside its domain") from error
