"""The kernels, a language -> their functions in the small language, read from Python's own syntax tree."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from types import FunctionType
from typing import Any

from eomgen.codegen import kernels
from eomgen.codegen.statements import (
    ATOM,
    CHANGED,
    INDICES,
    INT,
    PLACES,
    PRODUCT,
    REAL,
    ROOM,
    SUM,
    Array,
    Call,
    For,
    Function,
    If,
    Language,
    Let,
    Put,
    RankedText,
    Return,
    Statement,
    Table,
    held,
)
from eomgen.symbolic.numeric import tolerances

_OPERATORS = {
    ast.Add: ("+", SUM),
    ast.Sub: ("-", SUM),
    ast.Mult: ("*", PRODUCT),
    ast.Div: ("/", PRODUCT),
    ast.Lt: ("<", SUM),
    ast.LtE: ("<=", SUM),
    ast.Gt: (">", SUM),
    ast.Eq: ("==", SUM),
    ast.NotEq: ("!=", SUM),
}
_NEW = {"zeros": CHANGED, "room": ROOM, "places": PLACES}


def kernel(entry: str, tables: Iterable[Table], language: Language) -> tuple[list[Table], list[Function]]:
    """(the tables that are read, the functions that are called, those first that others call) from one function on."""
    needed = _called_from(entry)
    names = {x.id for name in needed for x in ast.walk(_parsed()[name]) if isinstance(x, ast.Name)}
    return [t for t in tables if t.name in names], [_Reader(language, _parsed()[name]).function() for name in needed]


def run(entry: str, tables: Iterable[Table]) -> Callable[..., Any]:
    """The same function in Python, over any scalar, with these tables as its constants."""
    values = {table.name: table.values[0] if table.kind == INT else table.values for table in tables}
    space: dict[str, Any] = {**vars(kernels), **values}
    for name in _called_from(entry):
        space[name] = FunctionType(getattr(kernels, name).__code__, space)
    found: Callable[..., Any] = space[entry]
    return found


def solve_bordered(
    M: Sequence[Any], J: Sequence[Any], f: Sequence[Any], g: Sequence[Any], tables: Iterable[Table]
) -> list[Any]:
    """(a, lam) of  M a - J^T lam = f,  J a = g  over any scalar.

    Args:
        M, J: n x n and k x n, row after row.
        tables: entries that may not be zero, as of `Solve.tables`.
    """
    a, lam = list(f), list(g)
    if lam:
        run("solve", tables)(list(M), list(J), a, lam)
    else:
        run("solve_plain", tables)(list(M), a)
    return [*a, *lam]


@cache
def _parsed() -> dict[str, ast.FunctionDef]:
    tree = ast.parse(inspect.getsource(kernels))
    return {x.name: x for x in tree.body if isinstance(x, ast.FunctionDef) and x.name not in _NEW}


@cache
def _called_from(entry: str) -> tuple[str, ...]:
    """Names of the functions that a function calls, directly or indirectly, before its own name."""
    calls = [x.func.id for x in ast.walk(_parsed()[entry]) if isinstance(x, ast.Call) and isinstance(x.func, ast.Name)]
    before = [name for call in calls if call in _parsed() for name in _called_from(call)]
    return tuple(dict.fromkeys([*before, entry]))


class _Reader:
    """One function; knows the kind of every name in it."""

    def __init__(self, language: Language, tree: ast.FunctionDef) -> None:
        self._language, self._tree = language, tree
        self._kinds = {name: kind for name, kind in kernels.__annotations__.items() if isinstance(kind, str)}
        self._kinds |= {"N": INT, "K": INT}
        self._kinds |= {a.arg: _named(a.annotation) for a in tree.args.args}

    def function(self) -> Function:
        tree = self._tree
        about = (ast.get_docstring(tree) or "").split("\n")[0]
        arguments = tuple((self._language.spelled(a.arg), self._kinds[a.arg]) for a in tree.args.args)
        gives = "" if _named(tree.returns) == "None" else _named(tree.returns)
        return Function(tree.name, arguments, self._body(tree.body[1:]), gives, about=about)

    def _body(self, statements: Iterable[ast.stmt]) -> tuple[Statement, ...]:
        return tuple(map(self._statement, statements))

    def _statement(self, s: ast.stmt) -> Statement:
        match s:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id=new), args=[size])) if (
                new in _NEW
            ):
                self._kinds[name] = PLACES if new == "places" else CHANGED
                return Array(self._language.spelled(name), self._text(size), _NEW[new])
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id=called)) as call) if (
                called in _parsed()
            ):
                self._kinds[name] = self._kind(call)
                return self._call(call, name)
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                self._kinds[name] = self._kind(value)
                return Let(self._language.spelled(name), self._text(value), self._kinds[name])
            case ast.Assign(targets=[ast.Subscript(value=ast.Name(id=array), slice=index)], value=value):
                return Put(self._language.spelled(array), self._text(index), self._text(value))
            case ast.AugAssign(
                target=ast.Subscript(value=ast.Name(id=array), slice=index) as place, op=op, value=value
            ):
                return Put(self._language.spelled(array), self._text(index), self._text(ast.BinOp(place, op, value)))
            case ast.For(target=ast.Name(id=name), iter=ast.Call() as over, body=body):
                self._kinds[name] = INT
                down = _function(over) == "reversed"
                bounds = [self._text(x) for x in (over.args[0].args if down else over.args)]  # type: ignore[attr-defined]
                return For(
                    self._language.spelled(name),
                    bounds[0] if len(bounds) > 1 else "0",
                    bounds[-1],
                    self._body(body),
                    down,
                )
            case ast.If(test=test, body=body, orelse=otherwise):
                return If(self._text(test), self._body(body), self._body(otherwise))
            case ast.Expr(value=ast.Call() as call):
                return self._call(call)
            case ast.Return(value=value):
                return Return(self._text(value) if value else "")
        raise NotImplementedError(f"a kernel has no {ast.unparse(s)}")

    def _call(self, call: ast.Call, name: str = "") -> Call:
        """A function of the kernels that is called, and the name of its result."""
        function, texts = _function(call), tuple(map(self._text, call.args))
        kinds = [_named(a.annotation) for a in _parsed()[function].args.args]
        changed = tuple(text for text, kind in zip(texts, kinds, strict=True) if kind in (CHANGED, PLACES))
        return Call(function, texts, changed, self._language.spelled(name), self._kinds.get(name, INT))

    def _text(self, x: ast.expr) -> str:
        return self._strong(x)[0]

    def _strong(self, x: ast.expr) -> RankedText:
        words = self._language.words
        match x:
            case ast.Name(id=name):
                return words.get(name) or self._language.spelled(name), ATOM
            case ast.Attribute(value=ast.Name(id="tolerances"), attr=name):
                return self._language.real(vars(tolerances)[name]), ATOM
            case ast.Constant(value=value):
                return self._language.real(value) if isinstance(value, float) else repr(value), ATOM
            case ast.Subscript(value=ast.Name(id=array), slice=index):
                return self._language.place(self._language.spelled(array), self._text(index)), ATOM
            case ast.Call(args=arguments):
                return self._language.called(_function(x), [self._text(a) for a in arguments]), ATOM
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return f"{words['not']}({self._text(operand)})", ATOM
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return f"-{held(self._strong(operand), PRODUCT)}", SUM
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                sign = _OPERATORS[type(op)][0]
                if isinstance(right, ast.Constant) and self._kind(left) == REAL:
                    right = ast.Constant(float(right.value))  # type: ignore[arg-type]
                return f"{self._text(left)} {words.get(sign, sign)} {self._text(right)}", SUM
            case ast.BinOp(left=left, op=op, right=right):
                sign, strength = _OPERATORS[type(op)]
                space = " " if strength == SUM else ""
                a, b = held(self._strong(left), strength), held(self._strong(right), strength + 1)
                return f"{a}{space}{sign}{space}{b}", strength
        raise NotImplementedError(f"a kernel has no {ast.unparse(x)}")

    def _kind(self, x: ast.expr) -> str:
        """INT or REAL."""
        match x:
            case ast.Name(id=name):
                return self._kinds[name]
            case ast.Constant(value=value):
                return INT if isinstance(value, int) else REAL
            case ast.Subscript(value=ast.Name(id=array)):
                return INT if self._kinds[array] in (INDICES, PLACES) else REAL
            case ast.Call():
                return _named(_parsed()[_function(x)].returns)
            case ast.BinOp(left=left, op=op, right=right):
                whole = {self._kind(left), self._kind(right)} == {INT} and not isinstance(op, ast.Div)
                return INT if whole else REAL
            case ast.UnaryOp(operand=operand):
                return self._kind(operand)
        raise NotImplementedError(f"a kernel has no {ast.unparse(x)}")


def _named(annotation: ast.expr | None) -> str:
    return ast.unparse(annotation) if annotation else "None"


def _function(x: ast.Call) -> str:
    return x.func.id if isinstance(x.func, ast.Name) else ast.unparse(x.func)
