"""Julia's text -> its functions and its test, where no Julia is: read by tree-sitter's grammar, carried out by rules.

What is told apart: arrays from 1 on, `for` and `try` have names of their own, a function sees the module's names, `/`
is of floating point, a domain error is thrown, an integer takes no nan. What the rules do not know is an error.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import tree_sitter
import tree_sitter_julia

PARSER = tree_sitter.Parser(tree_sitter.Language(tree_sitter_julia.language()))


class DomainError(Exception):
    """What sqrt(-1.0) throws."""


class Returned(Exception):
    def __init__(self, value: Any) -> None:
        self.value = value


class Vector(list[Any]):
    """Places from 1 on."""

    def at(self, k: Any) -> int:
        assert type(k) is int and 1 <= k <= len(self), f"BoundsError: place {k!r} of {len(self)}"
        return k - 1


@dataclass
class Scope:
    names: dict[str, Any] = field(default_factory=dict)
    outer: Scope | None = None
    is_module: bool = False

    def owner(self, name: str) -> Scope | None:
        scope: Scope | None = self
        while scope is not None and name not in scope.names:
            scope = scope.outer
        return scope

    def get(self, name: str) -> Any:
        owner = self.owner(name)
        assert owner is not None, f"UndefVarError: {name}"
        return owner.names[name]

    def put(self, name: str, value: Any) -> None:
        owner = self.owner(name)
        (self if owner is None or (owner.is_module and not self.is_module) else owner).names[name] = value


def _within_domain(function: Callable[..., float]) -> Callable[..., float]:
    def called(*numbers: float) -> float:
        if any(math.isnan(x) for x in numbers):
            return math.nan
        try:
            return function(*map(float, numbers))
        except OverflowError:
            return math.inf
        except ValueError as error:
            raise DomainError(str(error)) from error

    return called


def _divided(a: float, b: float) -> float:
    with np.errstate(all="ignore"):
        return float(np.divide(float(a), float(b)))


def _power(a: Any, b: Any) -> Any:
    if type(a) is int and type(b) is int and b >= 0:
        return a**b
    if a < 0 and b != round(b):
        raise DomainError("a root of a negative number")
    with np.errstate(all="ignore"):
        return float(np.power(float(a), float(b)))


def _of_type(a: Any, value: Any) -> Any:
    if type(a) is not int:
        return float(value)
    assert value == int(value), f"InexactError: {value}"
    return int(value)


BINARY: dict[str, Callable[[Any, Any], Any]] = {
    "+": lambda a, b: a + b, "-": lambda a, b: a - b, "*": lambda a, b: a * b, "/": _divided, "^": _power,
    "==": lambda a, b: a == b, "!=": lambda a, b: a != b, "<": lambda a, b: a < b, "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b, ">=": lambda a, b: a >= b, "isa": isinstance,
}  # fmt: skip
BASE: dict[str, Any] = {
    **{op: _within_domain(getattr(math, op)) for op in "sin cos tan sqrt asin acos sinh cosh tanh exp log".split()},
    "atan": _within_domain(lambda *x: math.atan2(*x) if len(x) == 2 else math.atan(*x)),
    "abs": abs, "sign": lambda a: a if a != a else _of_type(a, (a > 0) - (a < 0)), "round": round, "float": float,
    "min": lambda a, b: math.nan if a != a or b != b else min(a, b), "isnan": math.isnan, "identity": lambda a: a,
    "max": lambda a, b: math.nan if a != a or b != b else max(a, b), "isempty": lambda a: not a, "oftype": _of_type,
    "zeros": lambda kind, n: Vector([0] * n), "NaN": math.nan, "Inf": math.inf, "Real": None, "Int": None,
    "DomainError": DomainError, "String": None, "Float64": None, "pi": math.pi, "true": True, "false": False,
}  # fmt: skip


def by_julia_s_grammar(folder: Path) -> str:
    """What each NAME_test.jl of a folder finds of NAME.jl, "" where all is well: its `check`, by its own vectors."""
    return "".join(filter(None, (_tested(path) for path in sorted(folder.rglob("*_test.jl")))))


def _tested(path: Path) -> str:
    source = path.with_name(path.name.replace("_test.jl", ".jl"))
    names, role = julia_functions(source.read_text()), source.stem.rpartition("_")[2]
    calls = [node for node in _below(_read(path.read_text())) if node.type == "call_expression"]
    calls = [node for node in calls if node.named_children[0].text == b"check"][1:]  # the first defines it
    assert calls, "no vectors"
    for k, call in enumerate(calls):
        scope = Scope(dict(BASE), is_module=True)
        *given, right, tolerance = (_value(x, scope) for x in call.named_children[1].named_children)
        found = names[role](*given)
        assert len(found) == len(right)
        largest = max([1.0, *(abs(b) for b in right if b == b)])
        for place, (a, b) in enumerate(zip(found, right, strict=True), 1):
            if not (a != a if b != b else abs(a - b) <= tolerance * largest):
                return f"{path.name}: vector {k + 1}: place {place} is {a!r}, not {b!r}\n"
    return ""


def _read(text: str) -> Any:
    # where Julia sees one expression, the grammar sees two: 2.0 and a call of * in 2.0*(a), a and +b in `if a + b`
    spaced = re.sub(r"^( *(?:else)?if) (.*)$", r"\1 (\2)", text.replace("*(", " * (").replace("/(", " / ("), flags=re.M)
    tree = PARSER.parse(spaced.encode())
    assert not tree.root_node.has_error, "the grammar of Julia does not read it"
    return tree.root_node


def _below(node: Any) -> Iterator[Any]:
    yield node
    for child in node.named_children:
        yield from _below(child)


def julia_functions(text: str) -> dict[str, Any]:
    """The names of a module, its functions among them."""
    (module,) = (node for node in _read(text).named_children if node.type == "module_definition")
    scope = Scope(is_module=True, outer=Scope(dict(BASE), is_module=True))
    _run(module.named_children[1:], scope)
    return scope.names


def _run(statements: list[Any], scope: Scope) -> Any:
    value = None
    for node in (x for x in statements if not x.type.endswith("comment")):
        value = _value(node, scope)
    return value


def _defined(call: Any, body: list[Any], scope: Scope) -> None:
    name, arguments = call.named_children[0].text.decode(), call.named_children[1].named_children
    plain = [x for x in arguments if x.type == "identifier"]
    given = [x.named_children for x in arguments if x.type == "named_argument"]
    assert len(plain) + len(given) == len(arguments)
    names = [x.text.decode() for x in (*plain, *(x[0] for x in given))]

    def function(*values: Any) -> Any:
        own = Scope(outer=scope)
        left = [_value(x[-1], scope) for x in given]
        everything = [*values, *left[len(values) - len(plain) :]]
        assert len(everything) == len(names), f"MethodError: {name} of {len(values)} arguments"
        own.names.update(zip(names, everything, strict=True))
        try:
            return _run(body, own)
        except Returned as found:
            return found.value

    scope.names[name] = function


def _value(node: Any, scope: Scope) -> Any:
    return RULES[node.type](node, [x for x in node.named_children if not x.type.endswith("comment")], scope)


def _assigned(node: Any, parts: list[Any], scope: Scope) -> Any:
    target, sign, value = parts
    assert sign.text == b"="
    if target.type == "call_expression":
        return _defined(target, [value], scope)
    found = _value(value, scope)
    if target.type == "identifier":
        scope.put(target.text.decode(), found)
    else:
        array, place = target.named_children
        held = _value(array, scope)
        held[held.at(_value(place.named_children[0], scope))] = found
    return found


def _binary(node: Any, parts: list[Any], scope: Scope) -> Any:
    first, sign, second = parts
    a, op = _value(first, scope), sign.text.decode()
    if op in ("&&", "||"):
        assert type(a) is bool, "TypeError: no Bool"
        return _value(second, scope) if a is (op == "&&") else a
    return BINARY[op](a, _value(second, scope))


def _signed(sign: bytes, value: Any) -> Any:
    assert sign in (b"-", b"!") and (sign == b"-" or type(value) is bool), f"MethodError: {sign!r} of {value!r}"
    return -value if sign == b"-" else not value


def _called(node: Any, parts: list[Any], scope: Scope) -> Any:
    values = [_value(x, scope) for x in parts[-1].named_children]
    if parts[0].type == "operator":  # -(a), which the grammar takes for a call
        return _signed(parts[0].text, *values)
    function = _value(parts[0], scope)
    return Vector(map(function, *values)) if node.type.startswith("broadcast") else function(*values)


def _indexed(node: Any, parts: list[Any], scope: Scope) -> Any:
    array, inside = _value(parts[0], scope), [_value(x, scope) for x in parts[1].named_children]
    return Vector(inside) if array is None else array[array.at(inside[0])]


def _range(node: Any, parts: list[Any], scope: Scope) -> Iterator[int]:
    if parts[0].type == "range_expression":
        (first, step), last = (_value(x, scope) for x in parts[0].named_children), _value(parts[1], scope)
    else:
        first, step, last = _value(parts[0], scope), 1, _value(parts[1], scope)
    assert {type(first), type(step), type(last)} == {int}
    return iter(range(first, last + (1 if step > 0 else -1), step))


def _looped(node: Any, parts: list[Any], scope: Scope) -> None:
    name, _, over = parts[0].named_children
    for value in _value(over, scope):
        own = Scope({name.text.decode(): value}, scope)
        _run(parts[1:], own)


def _branched(node: Any, parts: list[Any], scope: Scope) -> Any:
    condition, *rest = parts
    clauses = [x for x in rest if x.type in ("else_clause", "elseif_clause")]
    holds = _value(condition, scope)
    assert type(holds) is bool, "TypeError: no Bool"
    if holds:
        return _run([x for x in rest if x not in clauses], scope)
    for clause in clauses:
        inside = clause.named_children
        if clause.type == "else_clause" or _value(inside[0], scope):
            return _run(inside[clause.type == "elseif_clause" :], scope)
    return None


def _tried(node: Any, parts: list[Any], scope: Scope) -> Any:
    (clause,) = (x for x in parts if x.type == "catch_clause")
    try:
        return _run([x for x in parts if x is not clause], Scope(outer=scope))
    except DomainError as error:
        name, *body = clause.named_children
        return _run(body, Scope({name.text.decode(): error}, scope))


def _returned(node: Any, parts: list[Any], scope: Scope) -> None:
    raise Returned(_value(parts[0], scope) if parts else None)


RULES: dict[str, Callable[[Any, list[Any], Scope], Any]] = {
    "identifier": lambda node, parts, scope: scope.get(node.text.decode()),
    "integer_literal": lambda node, parts, scope: int(node.text),
    "float_literal": lambda node, parts, scope: float(node.text),
    "boolean_literal": lambda node, parts, scope: node.text == b"true",
    "string_literal": lambda node, parts, scope: node.text.decode(),
    "parenthesized_expression": lambda node, parts, scope: _value(parts[0], scope),
    "unary_expression": lambda node, parts, scope: _signed(parts[0].text, _value(parts[1], scope)),
    "binary_expression": _binary,
    "ternary_expression": lambda node, parts, scope: _value(parts[1 if _value(parts[0], scope) else -1], scope),
    "call_expression": _called,
    "broadcast_call_expression": _called,
    "index_expression": _indexed,
    "vector_expression": lambda node, parts, scope: Vector(_value(x, scope) for x in parts),
    "range_expression": _range,
    "assignment": _assigned,
    "const_statement": lambda node, parts, scope: _value(parts[0], scope),
    "export_statement": lambda node, parts, scope: None,
    "function_definition": lambda node, parts, scope: _defined(parts[0].named_children[0], parts[1:], scope),
    "for_statement": _looped,
    "if_statement": _branched,
    "try_statement": _tried,
    "return_statement": _returned,
}
