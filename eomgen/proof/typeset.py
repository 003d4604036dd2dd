r"""Formulas as they are typeset -> numbers: a reader of LaTeX that shares nothing with what sets it.

It reads as a person does: what stands side by side is multiplied, \sin x ends where the next function, sign or bracket
begins, a\big/b is a quotient, dots over a letter are rates of it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, reduce
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import Arithmetic, NoValue

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
    return tuple("|" if x == r"\vert" else x for x in _TOKEN.findall(_LONE.sub(r"\1{\2}", tex)))


def between_equals(tokens: Tokens) -> list[Tokens]:
    """What stands between the equality signs, brackets and braces not looked into."""
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
    """How symbols are set.

    Args:
        bare: the LaTeX of each symbol by its name without primes.
        names: all symbols, with primes.
    """

    bare: Mapping[str, str]
    names: tuple[str, ...]

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
        """Names of symbols that nobody can tell apart."""
        return [" and ".join(names) for names in self._known.values() if len(names) > 1]

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
    """Where the brace that opens at k closes."""
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
        """What a function is of that stands without brackets behind it: as far as letters and numbers go."""
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


def names_of_tree(tree: Tree) -> Iterable[str]:
    """The names of the symbols of a tree."""
    if tree[0] == "symbol":
        yield tree[1]
    for part in tree[1:]:
        if isinstance(part, tuple):
            yield from names_of_tree(part)


def worth(tree: Tree, values: Mapping[str, Any], arithmetic: Arithmetic) -> Any:
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
        return worth(if_true if worth(condition, values, arithmetic) else if_false, values, arithmetic)
    known = [worth(part, values, arithmetic) for part in parts]
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
