"""Numbers: a mass, length, radius or inertia has its sign; an inertia obeys the triangle inequality."""

import math
from collections.abc import Iterator
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.model.arithmetic import AnyNumber, in_order, value_of
from eomgen.model.catalog import Catalog
from eomgen.model.checks.made import made
from eomgen.model.fields import Leaf
from eomgen.model.findings import Finding, shown, whereabouts
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.spatial import cross, vector_of


def numbers(catalog: Catalog) -> Iterator[Finding]:
    """Wherever an expression is worth a number (by literals and parameters with values), that number is possible."""
    values: dict[str, AnyNumber] = {"pi": math.pi}
    for name in in_order({n: p.value if p else None for n, p in catalog.table("parameters").items()})[0]:
        yield from _parameter(catalog, name, values)
    for leaf, expression in catalog.expressions:
        yield from _worth(leaf, expression, values)
        sign = getattr(leaf.rule, "sign", "")
        if sign:
            yield from _sign(leaf, expression, value_of(expression, values))
    yield from _directions(catalog, values)
    yield from _crossing(catalog, values)
    yield from _positive(catalog, values)
    yield from _inertias(catalog, values)
    yield from made(catalog, values)


def _parameter(catalog: Catalog, name: str, values: dict[str, AnyNumber]) -> Iterator[Finding]:
    """Adds the value of a parameter to the values, or tells why it has none."""
    part = catalog.table("parameters")[name]
    if part is None or part.value is None or not part.value.names <= values.keys():
        return
    try:
        values[name] = part.value.evaluate(values)
    except ExpressionError as error:
        path, what = ("parameters", name, "value"), f"parameter '{name}': {error.what}"
        yield Finding(path, what, error.mend, error.column, error.length)


def _worth(leaf: Leaf, expression: Expression, values: dict[str, AnyNumber]) -> Iterator[Finding]:
    """An expression of parameters that has no value, such as asin(2); a parameter's own is told above."""
    elsewhere = leaf.path[0] == "parameters" or leaf.value is not expression or expression.calls
    if elsewhere or not expression.names <= values.keys():
        return
    try:
        expression.evaluate(values)
    except ExpressionError as error:
        yield Finding(leaf.path, f"{whereabouts(leaf.path)}: {error.what}", error.mend, error.column, error.length)


def _sign(leaf: Leaf, expression: Expression, number: Any) -> Iterator[Finding]:
    if number is None or number > 0 or (number == 0 and leaf.rule.sign == "nonnegative"):
        return
    what = "negative" if number < 0 else "zero"
    key = next((str(k) for k in reversed(leaf.path) if isinstance(k, str)), "")
    told = shown(expression.text) if expression.literal is None else expression.text
    worth = f"{told} = {float(number):g}" if expression.literal is None else told
    where = whereabouts(leaf.path[:-1] if len(leaf.path) > 2 else leaf.path)
    yield Finding(leaf.path, f"'{key}' in {where} is {what}: {worth}")


def _directions(catalog: Catalog, values: dict[str, AnyNumber]) -> Iterator[Finding]:
    """A direction that its parameters make zero (one of literal zeros is told where vectors are checked)."""
    for leaf in catalog.leaves:
        if not getattr(leaf.rule, "nonzero", False) or isinstance(leaf.value, str):
            continue
        named = any(component.literal is None for component in leaf.value)
        if named and all(value_of(component, values) == 0 for component in leaf.value):
            yield Finding(leaf.path, f"{whereabouts(leaf.path)}: a direction cannot be zero", "give a direction")


def _crossing(catalog: Catalog, values: dict[str, AnyNumber]) -> Iterator[Finding]:
    """The two axes of a universal joint that its numbers make parallel: it then turns about one axis alone."""
    for name, body in catalog.table("bodies").items():
        axes = getattr(getattr(body, "joint", None), "axes", None)
        if axes is None or len(axes) != 2 or any(len(axis) != 3 for axis in axes):
            continue
        a, b = (list[Any](value_of(component, values) for component in axis) for axis in axes)
        if None not in (*a, *b) and any(a) and any(b) and not any(cross(vector_of(a), vector_of(b))):
            what = f"the two axes of the universal joint of body '{name}' are parallel"
            yield Finding(("bodies", name, "joint", "axes"), what, "give axes that cross, or a revolute joint")


def _positive(catalog: Catalog, values: dict[str, AnyNumber]) -> Iterator[Finding]:
    for name, part in catalog.table("parameters").items():
        if part is not None and part.positive and name in values and values[name] <= 0:
            what = f"parameter '{name}' is declared positive but is {float(values[name]):g}"
            yield Finding(("parameters", name, "value"), what)


def _inertias(catalog: Catalog, values: dict[str, AnyNumber]) -> Iterator[Finding]:
    for name, body in catalog.table("bodies").items():
        if body is None or body.inertia is None:
            continue
        path: DocumentPath = ("bodies", name, "inertia")
        moments = [value_of(e, values) for e in body.inertia]
        negative = [k for k, x in enumerate(moments[:3]) if x is not None and x < 0]
        for k in negative:
            what = f"a moment of inertia of body '{name}' is negative: {body.inertia[k].text}"
            yield Finding(path if len(moments) == 1 else (*path, k), what)
