"""Model file, the model read from it -> checks that its numbers and samples, in SI, are those of the file, in doubles.

The text is read once more, by tomllib; units are products of the few that stand here, formulas of parameters are
evaluated by Python. Text that is not understood that way is not checked: our reader's own refusals know more.
"""

from __future__ import annotations

import ast
import math
import operator
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from eomgen.model import Model
from eomgen.proof.check import Check, checked, first_wrong
from eomgen.symbolic.expression import Expression, Fraction, Sampled
from eomgen.symbolic.numeric import tolerances

SIZES = {  # of one of it, in SI
    **{"1": 1, "m": 1, "km": 1e3, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "kg": 1, "g": 1e-3, "t": 1e3, "s": 1, "ms": 1e-3},
    **{"min": 60, "h": 3600, "N": 1, "kN": 1e3, "J": 1, "W": 1, "kW": 1e3, "Pa": 1, "MPa": 1e6, "GPa": 1e9, "rad": 1},
    **{"bar": 1e5, "l": 1e-3, "ml": 1 / 1e6, "A": 1, "mA": 1e-3, "V": 1, "mV": 1e-3, "kV": 1e3, "ohm": 1, "kohm": 1e3},
    **{"H": 1, "mH": 1e-3, "uH": 1 / 1e6, "F": 1, "mF": 1e-3, "uF": 1 / 1e6, "Wb": 1, "T": 1, "C": 1, "K": 1},
    **{"deg": math.pi / 180, "rev": 2 * math.pi, "rpm": math.pi / 30},
}
PIECE = re.compile(r"([*/]?)([A-Za-z]+|1)(?:\^(-?\d+))?")
PLAIN = re.compile(r"[^()/]+(/[^()/]+|/\([^()/]+\))?")  # N*s/m, N/(m*s)
SIGNS: Mapping[type, Callable[..., Any]] = {
    **{ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv},
    **{ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos},
}
FUNCTIONS: Mapping[str, Callable[..., float]] = {
    name: getattr(math, name) for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "log")
}


def numbers_otherwise(data: bytes, model: Model) -> str:
    """Message that names a number which differs between the file and the model; "" where all agree."""
    try:
        found = tomllib.loads(data.decode("utf-8-sig").replace("\r\n", "\n"))
    except (ValueError, RecursionError):  # our reader accepts more
        return ""
    return first_wrong((*_parameters(found, model), *_starts(found, model)))


def _parameters(found: Mapping[str, Any], model: Model) -> Iterator[str]:
    known = {name: float(x) for name, x in model.exact_parameters().items()}
    for name, entry in _table(found, "parameters"):
        value, unit = (entry.get("value"), entry.get("unit", "1")) if isinstance(entry, dict) else (entry, "1")
        due, size = _value(value, known), _size(unit)
        if name in known and due is not None and size is not None:
            yield _apart(name, known[name], due * size)


def _starts(found: Mapping[str, Any], model: Model) -> Iterator[str]:
    """Differences of starts and inputs that are written as plain numbers, in words or ""."""
    for table, parts, keys in (
        ("coordinates", model.coordinates, ("start", "speed", "near")),
        ("states", model.states, ("start",)),
        ("inputs", model.inputs, ("value",)),
    ):
        for name, entry in _table(found, table):
            if not isinstance(entry, dict) or name not in parts:
                continue
            size = _size(entry.get("unit", "1"))
            for key in keys:
                due, own = entry.get(key), getattr(parts[name], key, None)
                if isinstance(due, (int, float)) and size is not None and own is not None and not own.names - {"pi"}:
                    yield _apart(f"{name}.{key}", float(own.evaluate({"pi": math.pi})), due * size)


def _table(found: Mapping[str, Any], name: str) -> Iterator[tuple[str, Any]]:
    table = found.get(name)
    yield from table.items() if isinstance(table, dict) else ()


def _apart(name: str, found: float, due: float) -> str:
    same = abs(found - due) <= tolerances.COMPUTED * abs(due)
    return "" if same else f"the file's number of '{name}' is {due:.10g} in SI, and {found:.10g} was read"


def _size(text: Any) -> float | None:
    """Size of a unit in SI; None where it is not understood."""
    if not isinstance(text, str):
        return None
    size, at, below, whole = 1.0, 0, False, text.replace(" ", "")
    if not PLAIN.fullmatch(whole):
        return None
    flat = whole.replace("(", "").replace(")", "")
    for piece in PIECE.finditer(flat):
        if piece.start() != at or piece[2] not in SIZES or (at and not piece[1]):
            return None
        below = (below and "(" in whole) or piece[1] == "/"
        size *= SIZES[piece[2]] ** ((-1 if below else 1) * int(piece[3] or 1))
        at = piece.end()
    return size if at == len(flat) and at else None


def _value(value: Any, known: Mapping[str, float]) -> float | None:
    """Value of a number, or of a formula of parameters; None where Python cannot read it."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    if not isinstance(value, str):
        return None
    try:
        return float(_evaluated(ast.parse(value.replace("^", "**"), mode="eval").body, {**known, "pi": math.pi}))
    except (SyntaxError, ValueError, ArithmeticError, KeyError, TypeError, RecursionError):
        return None


def _evaluated(node: ast.expr, known: Mapping[str, float]) -> float:
    """Value of a formula of sums, products, powers and functions; a KeyError for anything else."""
    match node:
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.Name(id=name):
            return known[name]
        case ast.UnaryOp(op=op, operand=x):
            return float(SIGNS[type(op)](_evaluated(x, known)))
        case ast.BinOp(left=x, op=op, right=y):
            return float(SIGNS[type(op)](_evaluated(x, known), _evaluated(y, known)))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
            return FUNCTIONS[name](*(_evaluated(x, known) for x in args))
    raise KeyError(type(node).__name__)


# -------- sampled functions -----------------------------------------------------------------------------------
# Model -> whether its functions through samples go as the samples are declared, by other programs' interpolation.
#
# scipy's cubics, found in doubles from the samples and not from our pieces; a straight line by numpy; steps by
# search. Beyond the ends a cubic goes straight on, anything else stays.


CONDITIONS = {"not-a-knot": "not-a-knot", "natural": "natural", "rest": "clamped"}  # our ends, by scipy's names
MOST = 50  # gaps between samples in which a function is looked at, evenly spread
PARTS = (Fraction(0), Fraction(3, 10), Fraction(4, 5))  # of a gap


def other_functions(model: Model) -> Iterator[Check]:
    """Check that functions through samples go through them; none where the model has no such functions."""
    laws = [*(law.sampled for law in _expressions(model)), *(t.function(x).function for x, t in model.tables.items())]
    given = [law for law in laws if law is not None and law.declared is not None]
    if given:
        name = "functions through samples go through them, and between them as they are declared"
        off = (_off_table(name, table) for name, table in model.tables.items())
        yield checked(name, first_wrong((*map(_wrong, given), *off)), "floating point")


def _expressions(model: Model) -> Iterator[Expression]:
    parts = (*model.coordinates.values(), *model.inputs.values())
    for part in parts:
        leaves = (part,) if isinstance(part, Expression) else (leaf.value for leaf in part.leaves(()))
        yield from (value for value in leaves if isinstance(value, Expression))


def _wrong(function: Sampled) -> str:
    """Message that names an instant at which a function through samples has another value; ""."""
    given = function.declared
    assert given is not None
    times = given.times
    gaps = np.unique(np.linspace(0, len(times) - 2, MOST).astype(int))
    places = [times[k] + part * (times[k + 1] - times[k]) for k in gaps for part in PARTS]
    span = times[-1] - times[0]
    places += [times[-1], times[0] - span / 5, times[-1] + span / 5]
    x, y, at = (np.array([float(x) for x in row]) for row in (times, given.values, places))
    due = _interpolated((x, y), at, given.way, given.ends) * float(given.factor)
    found = np.array([float(function.spline.at(t)) for t in places])
    away = abs(found - due)
    k = int(np.argmax(away))
    if away[k] <= tolerances.COMPUTED * (1 + abs(due).max()):
        return ""
    return f"{found[k]:.10g} at t = {float(places[k]):.6g} s for {due[k]:.10g}"


def _off_table(name: str, table: Any) -> str:
    """Message that names a value of a table that its function, of SI and in SI, does not have; ""."""
    at, unit = (1.0 if x is None else _size(x.text) for x in (table.at_unit, table.unit))
    if at is None or unit is None:
        return ""
    function = table.function(name).function
    largest = max(abs(float(y)) for y in table.values) * unit
    for x, y in zip(table.at, table.values, strict=True):
        found, due = float(function.at(float(x) * at, float, math.pi)), float(y) * unit
        if abs(found - due) > tolerances.COMPUTED * (abs(due) + largest):
            return f"{name} is {found:.10g} in SI at {float(x):g}, and {due:.10g} in the file"
    return ""


def _interpolated(samples: tuple[np.ndarray, np.ndarray], t: np.ndarray, way: str, ends: str) -> np.ndarray:
    """Values between samples (times, values) by the declared way."""
    from scipy.interpolate import CubicSpline, PchipInterpolator

    times, values = samples

    inside = np.clip(t, times[0], times[-1])
    if way == "linear":
        found: np.ndarray = np.interp(t, times, values)
    elif way == "steps":
        found = values[np.maximum(np.searchsorted(times, t, side="right") - 1, 0)]
    else:
        monotone = way == "pchip"
        spline = PchipInterpolator(times, values) if monotone else CubicSpline(times, values, bc_type=CONDITIONS[ends])
        found = spline(inside) + spline(inside, 1) * (t - inside)
    return found
