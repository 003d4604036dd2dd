"""Text -> Expression: the grammar of the model file."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable, Container, Iterable, Mapping
from decimal import Decimal
from numbers import Rational
from typing import Any

from eomgen.errors import ExpressionError, NumberBeyond
from eomgen.frozen import dataclass
from eomgen.symbolic.expression.formula import (
    NAMES,
    Call,
    Expression,
    Instruction,
    Reference,
    TableFunction,
    Undefined,
    apply_operation,
    bounded,
    is_exact,
    unknown,
)
from eomgen.symbolic.expression.rational import Fraction, fraction_of

__all__ = ["Call", "Expression", "Reference", "as_expression", "is_name", "parse", "parse_equation", "unknown"]


# -------- tokens ----------------------------------------------------------------------------------------------
# Text -> tokens of the model file's grammar: numbers (exact), names with their primes, signs.


LARGEST_EXPONENT = 300  # of ten, in a decimal: what a double can hold
MOST_DIGITS = 320
LARGEST_SIZE = 1000  # bits: a number still fits a double, and a product of two short ones

_DIGITS = r"[0-9](?:_?[0-9])*"
_NUMBER = rf"(?:{_DIGITS}(?:\.(?:{_DIGITS})?)?|\.{_DIGITS})(?:[eE][+-]?{_DIGITS})?"
_NAME = r"[^\W\d²³¹⁰⁴-⁹][^\W²³¹⁰⁴-⁹]*"
_TOKEN = re.compile(rf"(?P<number>{_NUMBER})|(?P<name>{_NAME}'*)|(?P<sign>\*\*|[-+*/^(),=;])")
_SPACE = re.compile(r"\s*")
_REFERENCE = re.compile(rf"(?P<number>{_NUMBER}\s*[,)])|(?P<reference>\w+(?:\.\w+)*(?:\s*-\s*\w+(?:\.\w+)*)*)\s*[,)]")
_DOTTED = re.compile(rf"{_NAME}(?:\.\w+)+")

CASES = "nothing is compared here: an instant is an equation, x = 1; cases are made by max, min, abs, sign"
_FIXES = {
    "−": "write -",
    "–": "write -",
    "·": "write *",
    "×": "write *",
    "÷": "write /",
    "′": "write '",
    "’": "write '",
    "″": "write ''",
    '"': "write ''",
    "²": "write ^2",
    "³": "write ^3",
    "√": "write sqrt(...)",
    "|": "write abs(...)",
    "°": 'give the unit separately: { start = 20, unit = "deg" }',
    ">": CASES,
    "<": CASES,
    "?": CASES,
    "[": "use round parentheses",
    "{": "use round parentheses",
    "]": "use round parentheses",
    "}": "use round parentheses",
    "%": "write /100",
    "!": "there is no factorial; a product is written out",
}


@dataclass(frozen=True, slots=True)
class Token:
    """A piece of the text: `kind` is "number", "name", "sign" or "end"; `start` counts from 0."""

    kind: str
    text: str
    start: int

    @property
    def end(self) -> int:
        return self.start + len(self.text)


def is_name(text: str) -> bool:
    """True where text can name a parameter or a coordinate: letters (Greek too), digits, `_`; no prime."""
    return re.fullmatch(_NAME, text) is not None


def skip_space(text: str, position: int) -> int:
    """The first position from here on that holds no space."""
    found = _SPACE.match(text, position)
    return found.end() if found else position


def token_at(text: str, position: int) -> Token:
    """The token that begins at or after this position."""
    start = skip_space(text, position)
    if start == len(text):
        return Token("end", "", start)
    found = _TOKEN.match(text, start)
    if found is None or found.lastgroup is None:
        raise _strange(text, start)
    return Token(found.lastgroup, found.group(), start)


def _strange(text: str, start: int) -> ExpressionError:
    character = text[start]
    if character == "." and start > 0 and (dotted := _DOTTED.match(text, _word_start(text, start))):
        length = dotted.end() - dotted.start()
        owner, _, what = dotted.group().partition(".")
        fix = {"dot": f"the rate is written {owner}'", "ddot": f"it is written {owner}''"}.get(what, "")
        if owner in ("np", "numpy", "math", "sp", "sympy"):
            fix = f"write {what}(...)"
        return ExpressionError(f"'{dotted.group()}' is a point, not a number", dotted.start(), fix, length)
    in_formula = character == "°" and not text[:start].strip().isdigit()
    fix = degrees(text) if in_formula else _FIXES.get(character) or plainly(character)
    return ExpressionError(f"unexpected character {character!r}", start, fix)


def _word_start(text: str, end: int) -> int:
    while end > 0 and (text[end - 1].isalnum() or text[end - 1] == "_"):
        end -= 1
    return end


def reference_at(text: str, position: int) -> str | None:
    """The dotted name or member (`arm.end`, `B`, `n1-n2`) that is a whole argument here, else None."""
    found = _REFERENCE.match(text, position)
    return found.group("reference") if found else None


def unclosed_at(text: str, position: int) -> bool:
    """True if a dotted name here is the last thing in the text: the parenthesis before it is never closed."""
    found = _DOTTED.match(text, position)
    return found is not None and skip_space(text, found.end()) == len(text)


def number_in(token: Token) -> int | Fraction:
    """The exact value of a decimal: 0.0825 is 33/400."""
    mantissa, _, exponent = token.text.replace("_", "").lower().partition("e")
    if len(mantissa) > MOST_DIGITS or len(exponent) > 6 or abs(int(exponent or 0)) > LARGEST_EXPONENT:
        shown = token.text if len(token.text) < 30 else f"{token.text[:24]}..."
        what = f"the number {shown} has too many digits or too large an exponent"
        raise NumberBeyond(what, token.start, f"at most {LARGEST_EXPONENT} in each", len(token.text))
    value = fraction_of(f"{mantissa}e{exponent or 0}")
    if value.numerator.bit_length() - value.denominator.bit_length() > LARGEST_SIZE:
        what = f"{token.text[:24]}... is too large for a number"
        raise NumberBeyond(what, token.start, f"at most 1e{LARGEST_EXPONENT}", len(token.text))
    return value.numerator if value.denominator == 1 else value


# -------- expressions -----------------------------------------------------------------------------------------
# Text -> Expression: the grammar of the model file.
#
#     whole    = (name "=" sum ";")* sum                parts with a name, of which what follows is made
#     sum      = product (("+" | "-") product)*
#     product  = signed (("*" | "/") signed)*
#     signed   = ("-" | "+") signed | power
#     power    = value (("^" | "**") signed)?           right to left: -x^2 is -(x^2)
#     value    = number | name | function "(" sum ("," sum)* ")" | "(" whole ")"
#
# A Pratt parser that writes the tree in postfix order. Nothing is ever handed to Python's own evaluation. Length,
# depth and the size of exact numbers are bounded, so that a hostile text costs a millisecond.


LONGEST = 10_000  # characters
LONGEST_WITH_PARTS = 200_000  # of a text in which parts have names, each of at most LONGEST
DEEPEST = 64  # parentheses, signs and powers inside one another

# how strongly a sign binds to the value on its left, and to the one on its right
_SIGNS = {"+": (10, 10), "-": (10, 10), "*": (20, 20), "/": (20, 20), "^": (40, 30), "**": (40, 30)}
_SIGNED = 30  # a leading minus: looser than a power, tighter than a product
EXTREMES = ("min", "max")  # of several values; where outputs may stand, of one over a run
_NO_NUMBERS = ("nan", "inf", "infinity")


def parse(
    text: str, *, references: bool = False, longest: int = LONGEST, tables: Mapping[str, TableFunction] | None = None
) -> Expression:
    """The expression that a text writes.

    Args:
        references: functions of the outputs (`speed(bar.end)`) are allowed, as calls.
        longest: characters; more than the default only for a text of our own making.
        tables: functions that a model declares, by name.
    Raises:
        ExpressionError: it is none; column and length say where.
    """
    parser = _Parser(text, references, longest, named=";" in text, tables=tables)
    expression = parser.whole()
    if parser.token.kind != "end":
        raise parser.misplaced()
    return expression


def parse_equation(
    text: str, *, references: bool = True, tables: Mapping[str, TableFunction] | None = None
) -> tuple[Expression, Expression]:
    """Both sides of `left = right`.

    Args:
        tables: as of `parse`.
    Raises:
        ExpressionError: it is no equation; column and length say where.
    """
    parser = _Parser(text, references, tables=tables)
    left = parser.whole()
    if parser.token.kind == "end":
        raise ExpressionError(f"'{text.strip()}' is no equation", 0, "write left = right", max(1, len(text)))
    if parser.token.text != "=":
        raise parser.misplaced()
    parser.advance()
    right = parser.whole()
    if parser.token.kind != "end":
        raise parser.misplaced()
    return left, right


def as_expression(value: Any, *, references: bool = False) -> Expression:
    """The expression of a number or a text; a float means the decimal that it is written as (0.1 is 1/10).

    Raises:
        ExpressionError: nan, inf, a bool, or something else.
    """
    if isinstance(value, Expression):
        return value
    if isinstance(value, str):
        return parse(value, references=references)
    if isinstance(value, Rational) and not isinstance(value, bool):
        return _exact_number(Fraction(int(value.numerator), int(value.denominator)))
    if isinstance(value, (float, Decimal)):
        if not math.isfinite(value):
            raise ExpressionError(f"{value} is not a number that can be calculated with", length=len(str(value)))
        return _decimal(repr(float(value)) if isinstance(value, float) else str(value))
    raise ExpressionError(f"{value!r} is neither a number nor a text", fix="write a number or an expression")


def _decimal(text: str) -> Expression:
    """`parse` of a decimal, without its passes: models have thousands of values, which are put in many times."""
    if text[0] == "-":
        return parse(text)
    return Expression(text, (("number", number_in(Token("number", text, 0))),), (0,))


def _exact_number(value: Fraction) -> Expression:
    try:
        bounded(value)
    except Undefined as error:
        raise ExpressionError(str(error)) from error
    return Expression.number(value)


class _Parser:
    """One pass over a text; `code` and `columns` grow in postfix order."""

    def __init__(
        self,
        text: str,
        references: bool,
        longest: int = LONGEST,
        *,
        named: bool = False,
        tables: Mapping[str, TableFunction] | None = None,
    ) -> None:
        _refuse_long(text, longest, named)
        self.tables: Mapping[str, TableFunction] = {} if tables is None else tables
        self.text, self.references, self.depth, self.named = text, references, 0, named
        self.parts: dict[str, int] = {}  # by name, at which height of the stack each stands
        self.height = 0
        self.code: list[Instruction] = []
        self.columns: list[int] = []
        self.before = self.token = Token("end", "", 0)
        self.advance()

    def advance(self) -> Token:
        """The present token; the next one takes its place."""
        self.before, self.token = self.token, token_at(self.text, self.token.end)
        return self.before

    def emit(self, kind: str, what: Any, column: int) -> None:
        if kind in _LEAVES:
            self.height += 1
        elif kind == "under":
            self.height -= len(what)
        else:
            self.height -= what[1] - 1 if kind == "function" else 0 if kind in ("neg", "sampled") else 1
        self.code.append((kind, what))
        self.columns.append(column)

    def whole(self) -> Expression:
        """One expression with code of its own."""
        code, columns, self.code, self.columns = self.code, self.columns, [], []
        parts, height, self.parts, self.height = self.parts, self.height, {}, 0
        start = self.token.start
        self.with_parts()
        self.parts, self.height = parts, height
        made = Expression(self.text[start : self.before.end], tuple(self.code), tuple(self.columns))
        self.code, self.columns = code, columns
        _check_numbers(made)
        return made

    def with_parts(self) -> None:
        """A sum, and before it the parts that have names."""
        outside, own = dict(self.parts), list[str]()
        while self.named and self.token.kind == "name" and token_at(self.text, self.token.end).text == "=":
            name = self.advance()
            if name.text in (*NAMES, "t", "pi") or "'" in name.text or name.text in self.parts:
                what = f"'{name.text}' cannot be the name of a part"
                raise ExpressionError(what, name.start, "give each part a name of its own", len(name.text))
            self.advance()
            self.operand(0)
            if self.token.text != ";":
                raise ExpressionError(
                    f"the part '{name.text}' has no end", name.start, "write ; behind it", len(name.text)
                )
            self.advance()
            self.parts[_checked_name(name)] = self.height - 1
            own.append(name.text)
        self.operand(0)
        if own:
            self.emit("under", tuple(own), -1)
        self.parts = outside

    def operand(self, binding: int) -> None:
        """A value and all signs after it that bind more strongly than `binding`."""
        self.value()
        while self.token.kind == "sign" and self.token.text in _SIGNS:
            left, right = _SIGNS[self.token.text]
            if left <= binding:
                break
            sign = self.advance()
            if sign.text in ("^", "**"):
                self.nested(sign, lambda: self.operand(_SIGNED))
            else:
                self.operand(right)
            self.emit("^" if sign.text == "**" else sign.text, None, sign.start)

    def nested(self, opening: Token, parse_inside: Callable[[], None]) -> None:
        self.depth += 1
        if self.depth > DEEPEST:
            raise ExpressionError(f"more than {DEEPEST} levels inside one another", opening.start)
        parse_inside()
        self.depth -= 1

    def value(self) -> None:
        token = self.token
        if token.kind == "number":
            self.emit("number", number_in(self.advance()), token.start)
        elif token.kind == "name":
            self.name_or_function()
        elif token.text == "(":
            self.advance()
            self.nested(token, self.with_parts)
            self.close(token)
        elif token.text in ("-", "+"):
            self.advance()
            self.signed(token)
        else:
            raise self.nothing_there()

    def signed(self, sign: Token) -> None:
        """-x; of a number that is written there, the negative number."""
        start = len(self.code)
        self.nested(sign, lambda: self.operand(_SIGNED))
        if sign.text == "+":
            return
        if len(self.code) == start + 1 and self.code[start][0] == "number":
            self.code[start] = ("number", -self.code[start][1])
        else:
            self.emit("neg", None, sign.start)

    def name_or_function(self) -> None:
        token = self.advance()
        if self.token.text == "(":
            self.nested(token, lambda: self.function(token))
        elif token.text in self.parts:
            self.emit("part", self.height - 1 - self.parts[token.text], token.start)
        else:
            self.emit("name", _checked_name(token), token.start)

    def function(self, name: Token) -> None:
        if name.text in self.tables:
            self.of_table(name)
            return
        if name.text not in NAMES and self.references:
            self.emit("call", Call(name.text, self.arguments_of_call(), name.start), name.start)
            return
        if name.text not in NAMES:
            error = unknown("function", name.text, NAMES, name.start)
            product = f"for a product write {name.text}*(...)"
            fix = rate_of_call(self.text[name.start :]) or error.fix or product
            raise ExpressionError(error.what, error.column, fix, error.length)
        opening, count, begun, height = self.advance(), 0, len(self.code), self.height
        while self.token.text != ")" and (count == 0 or self.token.text == ","):
            if count:
                self.advance()
            self.operand(0)
            count += 1
        inner = self.text[opening.end : self.token.start].strip()
        self.close(opening)
        if count == 1 and self.references and name.text in EXTREMES:
            formula = Expression(inner, tuple(self.code[begun:]), tuple(self.columns[begun:]))
            if self.parts and any(kind == "part" for kind, _ in formula.code):
                raise ExpressionError("a part with a name means nothing over a run", name.start, "write it out")
            del self.code[begun:], self.columns[begun:]
            self.height = height
            self.emit("call", Call(name.text, (formula,), name.start), name.start)
            return
        _check_count(name, count)
        self.emit("function", (name.text, count), name.start)

    def of_table(self, name: Token) -> None:
        """A table at its argument, in the unit in which it is declared."""
        table, opening = self.tables[name.text], self.advance()
        self.operand(0)
        self.close(opening)
        self.emit("sampled", table.function, name.start)

    def arguments_of_call(self) -> tuple[Reference | Expression, ...]:
        opening = self.token
        args: list[Reference | Expression] = []
        if token_at(self.text, opening.end).text == ")":
            self.advance()
        else:
            args.append(self.argument())
            while self.token.text == ",":
                args.append(self.argument())
        self.close(opening)
        return tuple(args)

    def argument(self) -> Reference | Expression:
        """The argument after the present token, "(" or ","; the token after it becomes the present one."""
        start = skip_space(self.text, self.token.end)
        if unclosed_at(self.text, start):
            raise ExpressionError("'(' is never closed", self.token.start, "write ) at the end")
        reference = reference_at(self.text, start)
        if reference is None:
            self.advance()
            return self.whole()
        self.token = Token("name", reference, start)
        self.advance()
        return Reference(reference, start)

    def close(self, opening: Token) -> None:
        if self.token.text == ")":
            self.advance()
        elif self.token.kind == "end":
            raise ExpressionError("'(' is never closed", opening.start)
        else:
            raise self.misplaced()

    def nothing_there(self) -> ExpressionError:
        """The error where a value should stand and none does."""
        token, before = self.token, self.before
        if token.kind == "end" and not self.text.strip():
            return ExpressionError("the expression is empty")
        where = f"after '{before.text}'" if before.text else "at the beginning"
        fix = "an equation has one =" if token.text == "=" else ""
        return ExpressionError(f"a value is missing {where}", max(0, token.start - (token.kind == "end")), fix)

    def misplaced(self) -> ExpressionError:
        """The error for a token that cannot follow the value before it."""
        token, before = self.token, self.before
        length = len(token.text)
        if token.text == ")":
            return ExpressionError("')' closes nothing", token.start)
        if token.kind == "sign" and token.text != "(":
            fix = decimal_comma(self.text, token.start) if token.text == "," else ""
            return ExpressionError(f"'{token.text}' has no place here", token.start, fix, length)
        what = f"no sign between '{before.text}' and '{token.text}'"
        if before.text in NAMES:
            return ExpressionError(what, token.start, f"write {before.text}({token.text})", length)
        if habit := two_values(self.text, token.start):
            return ExpressionError(what, token.start, habit, length)
        opened = "(...)" if token.text == "(" else token.text
        left = "(...)" if before.text == ")" else before.text
        return ExpressionError(what, token.start, f"there is no implicit product: write {left}*{opened}", length)


def _checked_name(token: Token) -> str:
    bare = token.text.rstrip("'")
    primes = len(token.text) - len(bare)
    if bare.lower() in _NO_NUMBERS:
        what = f"'{bare}' is not a number that can be calculated with"
        raise ExpressionError(what, token.start, length=len(bare))
    if primes > 2:
        raise ExpressionError(f"more than two primes: {token.text}", token.start, length=len(token.text))
    if primes and bare in ("pi", "t"):
        raise ExpressionError(f"'{bare}' has no derivative", token.start, f"write {bare}", len(token.text))
    return token.text


def _check_count(name: Token, count: int) -> None:
    least = NAMES[name.text]
    if count == least or (name.text in EXTREMES and count > least):
        return
    needed = ("two or more" if name.text in EXTREMES else ("one", "two")[least - 1], "" if least == 1 else "s")
    what = f"{name.text} takes {needed[0]} argument{needed[1]}, not {count}"
    raise ExpressionError(what, name.start, length=len(name.text))


def _check_numbers(expression: Expression) -> None:
    """Refuses plain numbers without a value (1/0, 9^9^9) at once, where they are written."""
    stack: list[Any] = []
    for (kind, what), column in zip(expression.code, expression.columns, strict=True):
        if kind in ("part", "under"):
            apply_operation(stack, kind, what, None)
            continue
        count = what[1] if kind == "function" else 1 if kind == "neg" else 0 if kind in _LEAVES else 2
        operands = stack[len(stack) - count :]
        del stack[len(stack) - count :]
        if kind in _LEAVES or kind == "function" or not all(is_exact(a) for a in operands):
            stack.append(what if kind == "number" else None)
            continue
        try:
            apply_operation(operands, kind, what, None)
        except Undefined as error:
            raise ExpressionError(str(error), column) from error
        stack.append(operands[0])


def _refuse_long(text: str, longest: int, named: bool) -> None:
    """Raises: ExpressionError: a text, or a part of it, is longer than it may be."""
    if len(text) <= longest:
        return
    if not named or len(text) > LONGEST_WITH_PARTS:
        most = LONGEST_WITH_PARTS if named else longest
        raise ExpressionError(f"the expression is longer than {most} characters", most)
    start = 0
    for part in text.split(";"):
        if len(part) > longest:
            raise ExpressionError(f"a part of the expression is longer than {longest} characters", start + longest)
        start += len(part) + 1


_LEAVES = ("number", "name", "call", "part")


# -------- habits ----------------------------------------------------------------------------------------------
# What hands write out of habit from other notations, and how it is written here: the fixes of errors.


DEGREES = ("deg", "degree", "degrees", "grad", "Grad")
RATES = {  # functions and ends of names that stand for dots: how many
    "diff": 1,
    "Derivative": 1,
    "der": 1,
    "dot": 1,
    "ddot": 2,
}
SLOPE = "slope_of"  # what dT/dq' is read as: slope_of(T, q'), of an energy by a coordinate or its rate
_ENDS = (("_ddot", 2), ("_dotdot", 2), ("ddot", 2), ("_dot", 1), ("dot", 1), ("_dd", 2), ("_d", 1))
_TYPED_NUMBER = r"\d+(?:\.\d*)?(?:[eE][-+]?\d+)?|\.\d+"
_COMMA = re.compile(r"(\d+)\s*,\s*(\d+)")
_POWER = re.compile(r"(\w+)\s*(?:\^|\*\*)\s*(\d+)\s*$")
_DEGREES = re.compile(rf"({_TYPED_NUMBER})\s*(?:\*?\s*(?:{'|'.join(DEGREES)})(?!\w)|°)")
_WITH_UNIT = re.compile(rf"\s*([-+]?(?:{_TYPED_NUMBER}))(?:\s+([A-Za-z][\w^*/]*)|(kg|mm|cm|kN|N|deg|rad|rpm))\s*")
_OF_TIME = re.compile(r"\s*(\w+)\s*\(\s*t\s*\)")
_POW = re.compile(r"\s*pow\(\s*(\w+)\s*,\s*(\w+)\s*\)")
_RATE = re.compile(
    rf"\s*({'|'.join(RATES)})\(\s*(\w+)\s*(?:\(\s*t\s*\)\s*)?(?:,\s*\(?\s*t\s*(?:,\s*([12t])\s*)?\)?\s*)?\)"
)


def spelled(letter: str) -> str:
    """A Greek letter by its name ("theta"), "" of others."""
    found = re.fullmatch(r"GREEK (SMALL|CAPITAL) LETTER (?:FINAL )?([A-Z]+)(?: WITH .*)?", unicodedata.name(letter, ""))
    return "" if found is None else found[2].lower() if found[1] == "SMALL" else found[2].capitalize()


def invisible(character: str) -> str:
    """The fix of a character that looks like a blank, or like nothing; "" of a visible one."""
    if character in ("", "\n", "\t", " ") or (character.isprintable() and not character.isspace()):
        return ""
    return f"a character that is not seen stands there, U+{ord(character):04X}: write a plain blank, or nothing"


def plainly(character: str) -> str:
    """The fix of a character that stands for a plain one; "" of others."""
    plain = unicodedata.normalize("NFKC", character)
    return f"write {plain}" if plain.isascii() and plain != character and plain.strip() else invisible(character)


def two_values(text: str, place: int) -> str:
    """The fix where two values stand side by side, the second at a place; "" for what is no habit."""
    power = _POWER.search(text, 0, place)
    if power is not None and power[1] in NAMES and text[place] == "(":
        return f"write {power[1]}{_in_parentheses(text, place)}^{power[2]}"
    if fix := degrees(text):
        return fix
    given = _WITH_UNIT.fullmatch(text)
    if given is not None:
        value, unit = given[1], given[2] or given[3]
        return f'with a unit it is {{ value = {value}, unit = "{unit}" }}, as a product {value}*{unit}'
    return ""


def degrees(text: str, unit: str = "deg") -> str:
    """The fix of an angle in degrees: "angles are in rad here: write pi/2", or ""; also where `unit` is no degree."""
    found = _DEGREES.search(text) if unit in DEGREES else None
    if found is None:
        return ""
    share = fraction_of(found[1]) / 180
    above = "pi" if share.numerator == 1 else f"{share.numerator}*pi"
    return f"angles are in rad here: write {above}{'' if share.denominator == 1 else f'/{share.denominator}'}"


def decimal_comma(text: str, place: int) -> str:
    """The fix of a comma in a number, or ""."""
    found = next((each for each in _COMMA.finditer(text) if each.start() <= place < each.end()), None)
    return "" if found is None else f"write a decimal point: {found[1]}.{found[2]}"


def called_rate(text: str) -> tuple[str, int, int] | None:
    """(phi, how many dots, where it ends) of diff(phi, t), ddot(phi); None of others."""
    found = _RATE.match(text)
    return None if found is None else (found[2], max(RATES[found[1]], 2 if found[3] in ("2", "t") else 1), found.end())


def rate_of_call(text: str) -> str:
    """The fix of diff(phi, t), ddot(phi), phi(t) or pow(phi, 2), or ""."""
    if of_time := _OF_TIME.match(text):
        return f"write {of_time[1]}: what moves depends on t by itself"
    if power := _POW.match(text):
        return f"write {power[1]}^{power[2]}"
    found = called_rate(text)
    return "" if found is None else f"write {found[0]}{chr(39) * found[1]}"


def meant_name(name: str, allowed: Container[str]) -> str:
    """The correct spelling of phi_dot (phi'), π (pi), θ (theta) among the allowed names; "" if none is recognized."""
    for end, dots in _ENDS:
        rate = name.removesuffix(end) + "'" * dots
        if name.endswith(end) and rate in allowed:
            return rate
    if re.fullmatch(r"dd?\w+", name):
        dots = 2 if name.startswith("dd") else 1
        if name[dots:] + "'" * dots in allowed:
            return name[dots:] + "'" * dots
    latin = "".join(spelled(c) or c for c in name)
    return latin if latin != name and latin in allowed else ""


WORDS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("parent", "base", "attached_to", "connected_to", "frame"), ("on",)),
    **dict.fromkeys(("type", "class"), ("kind",)),
    **dict.fromkeys(("value", "initial", "init", "x0", "q0", "initial_value"), ("start",)),
    **dict.fromkeys(("velocity", "initial_velocity", "v0"), ("speed",)),
    **dict.fromkeys(("units",), ("unit",)),
    **dict.fromkeys(("description", "comment", "note", "remark"), ("about",)),
    **dict.fromkeys(("hinge", "rotation", "rotary", "rotational", "rotate", "pivot"), ("revolute",)),
    **dict.fromkeys(("slider", "linear", "sliding", "translation", "translational", "slide", "rail"), ("prismatic",)),
    **dict.fromkeys(("ball", "ball_joint", "ball_and_socket"), ("spherical",)),
    **dict.fromkeys(("weld", "welded", "rigid", "clamped"), ("fixed",)),
    **dict.fromkeys(("cardan", "hooke"), ("universal",)),
    **dict.fromkeys(("bar", "beam", "stick"), ("rod",)),
    **dict.fromkeys(("disk", "wheel"), ("disc",)),
    **dict.fromkeys(("point", "point_mass", "mass_point"), ("particle",)),
    **dict.fromkeys(("cuboid", "block", "brick"), ("box",)),
    **dict.fromkeys(("hoop", "circle"), ("ring",)),
    **dict.fromkeys(("dashpot",), ("damper",)),
    **dict.fromkeys(("weight",), ("gravity",)),
    **dict.fromkeys(("rope", "cable", "cord"), ("string",)),
    **dict.fromkeys(("ln", "loge"), ("log",)),
    **dict.fromkeys(("run", "integrate", "animate", "ode"), ("simulate",)),
    "reaction": ("reaction_x", "reaction_y", "reaction_z"),
    "velocity": ("speed", "vx", "vy", "vz"),
    "acceleration": ("ax", "ay", "az"),
    "position": ("x", "y", "z"),
    "angular_velocity": ("omega",),
    "kinetic": ("kinetic_energy",),
    "potential": ("potential_energy",),
}
"""what a thing is called elsewhere -> what it is called here"""


def other_words(word: str, known: Iterable[str]) -> tuple[str, ...]:
    """The names here, among the known ones, of what other programs call `word`."""
    there = set(known)
    return tuple(each for each in WORDS.get(word.lower(), ()) if each in there)


def _in_parentheses(text: str, start: int) -> str:
    """The part of a text from an opening parenthesis to the one that closes it; at the end of the text it is closed."""
    depth = 0
    for k in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[k], 0)
        if depth == 0:
            return text[start : k + 1]
    return f"{text[start:]})"
