"""Expressions: every name in them is known, may stand there, and has the unit that the field needs."""

from collections.abc import Iterator

from eomgen.model.arithmetic import in_order
from eomgen.model.catalog import Catalog
from eomgen.model.fields import EVERYTHING, Leaf, is_mixed, mixed
from eomgen.model.findings import Finding, article, nearest, whereabouts
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.habits import DEGREES, degrees, meant_name

LONGEST_TRAIL = 10  # names of a ring that are shown


def formulas(catalog: Catalog) -> Iterator[Finding]:
    """Names that are unknown or may not stand where they do, units that do not fit, parameters in a ring."""
    for leaf, expression in catalog.expressions:
        scope = "" if leaf.rule.scope == EVERYTHING else leaf.rule.scope
        also = getattr(leaf.rule, "also", ())
        allowed = catalog.allowed[scope].union(also) if also else catalog.allowed[scope]
        if not expression.names <= allowed:
            for name, column in dict.fromkeys(expression.occurrences):
                if name not in allowed:
                    yield _misplaced(catalog, leaf, name, column, allowed)
        for name in expression.parts:
            if name in catalog.symbols:
                what = f"a part of {whereabouts(leaf.path)} is called '{name}', like {article(catalog.symbols[name])}"
                yield Finding(leaf.path, what, "give it another name")
        unit = leaf.part.unit if leaf.part is not None and leaf.path[-1] in leaf.part.in_unit else None
        if unit is not None and expression.names <= allowed and is_mixed(expression, unit):
            yield mixed(expression, unit, leaf.path)
    yield from _rings(catalog)


def _misplaced(catalog: Catalog, leaf: Leaf, name: str, column: int, allowed: frozenset[str]) -> Finding:
    base = name.rstrip("'")
    kind = catalog.symbols.get(base)
    where = whereabouts(leaf.path)
    if kind is None:
        other = meant_name(name, allowed)
        mend = (
            f"write {other}" if other else _in_degrees(name, leaf) or nearest(name, allowed) or _declare(catalog, name)
        )
        what = f"unknown name '{name}' in {where}"
    elif name != base and kind not in ("coordinate", "speed"):
        what, mend = f"a prime on what does not move: {name} ('{base}' is {article(kind)})", f"write {base}"
    elif name != base and f"{name}" not in catalog.allowed[""]:
        what, mend = f"'{name}' means nothing: '{base}' is {article(kind)}", "a coordinate has '' and ', a speed '"
    else:
        primes = {"coordinate": ("coordinate", "rate", "acceleration"), "speed": ("speed", "acceleration")}
        kind = primes[kind][len(name) - len(base)] if kind in primes else kind
        what, mend = f"'{name}' ({article(kind)}) cannot stand in {where}", f"only {leaf.rule.scope} can stand here"
        if leaf.path[0] == "constraints" and leaf.path[-1] == "length" and base in catalog.table("coordinates"):
            mend += f'; a length that changes is a driven joint: kind = "prismatic", displacement = "{base}"'
    return Finding(leaf.path, what, mend, column, len(name))


def _in_degrees(name: str, leaf: Leaf) -> str:
    return degrees(leaf.value.text) if name in DEGREES and isinstance(leaf.value, Expression) else ""


def _declare(catalog: Catalog, name: str) -> str:
    if name in catalog.table("outputs"):
        return "outputs do not refer to outputs: write its expression here"
    if name in catalog.table("bodies"):
        return "this is a body: ask for one of its quantities, like angle(...)"
    if name in FUNCTIONS:
        return f"a function has its arguments behind it: {name}({'' if not FUNCTIONS[name].kinds else '...'})"
    return f"declare '{name.rstrip(chr(39))}' in [parameters]"


def _rings(catalog: Catalog) -> Iterator[Finding]:
    values = {name: part.value if part else None for name, part in catalog.table("parameters").items()}
    for ring in in_order(values)[1]:
        path: DocumentPath = ("parameters", ring[0], "value")
        shown = ring if len(ring) <= LONGEST_TRAIL else [*ring[:LONGEST_TRAIL], "..."]
        trail = " -> ".join([*shown, ring[0]])
        what = f"parameter '{ring[0]}' needs itself: {trail}" if len(ring) == 1 else f"parameters in a ring: {trail}"
        yield Finding(path, what, "give one of them a number")
