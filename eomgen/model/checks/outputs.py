"""Outputs: the functions of the motion that they call, and what each can be asked of."""

from collections.abc import Iterator
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.model.catalog import Catalog
from eomgen.model.checks.references import missing_point
from eomgen.model.fields import Leaf
from eomgen.model.findings import Finding, nearest, whereabouts
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.outputs.base import AXES, SIDES
from eomgen.symbolic.expression.expressions import Call, Expression, Reference, parse
from eomgen.symbolic.expression.functions import NAMES
from eomgen.symbolic.expression.habits import rate_of_call


def outputs(catalog: Catalog) -> Iterator[Finding]:
    """Functions that are unknown, take another number of arguments, or are asked of what was never declared."""
    for leaf, expression in catalog.expressions:
        for call in _calls_in(expression):
            yield from _call(catalog, leaf, call)


def _calls_in(expression: Expression) -> Iterator[Call]:
    for call in expression.calls:
        yield call
        for argument in call.args:
            if isinstance(argument, Expression):
                yield from _calls_in(argument)


def _call(catalog: Catalog, leaf: Leaf, call: Call) -> Iterator[Finding]:
    function = FUNCTIONS.get(call.name)
    if function is None:
        there = [name for name in FUNCTIONS if catalog.model.space != "plane" or name[-1] != "z" or name == "omega_z"]
        mend = rate_of_call(str(call)) or nearest(call.name, [*there, *NAMES])
        yield Finding(leaf.path, f"unknown function '{call.name}'", mend, call.column, len(call.name))
        return
    functions = getattr(leaf.rule, "functions", None)
    if functions is not None and (call.name not in functions or len(call.args) > 2):
        what, mend = f"'{call}' cannot stand in {whereabouts(leaf.path)}", f"only {', '.join(functions)} can stand here"
        few = "name one body, whose axes are meant too"
        yield Finding(leaf.path, what, few if call.name in functions else mend, call.column, len(call.name))
        return
    kinds = function.kinds + (function.more,) * (len(call.args) - len(function.kinds) if function.more else 0)
    if not function.least <= len(call.args) <= len(kinds):
        most = len(function.kinds)
        count = str(most) if most == function.least else f"{function.least} to {most}"
        count = f"at least {function.least}" if function.more else count
        what = f"{call.name} takes {count} argument{'' if count in ('1', 'at least 1') else 's'}, not {len(call.args)}"
        yield Finding(leaf.path, what, f"{call.name}{function.arguments}", call.column, len(call.name))
        return
    yield from function.findings(catalog, leaf, call)
    for argument, kind in zip(call.args, kinds, strict=False):
        wrong = _argument(catalog, argument, kind)
        if wrong is not None:
            what, mend, column, length = wrong
            yield Finding(leaf.path, f"{what} (in {call})", mend, column, length)


def _argument(catalog: Catalog, argument: Any, kind: str) -> tuple[str, str, int, int] | None:
    """What is wrong with an argument: message, mend, column, length; None when it is right."""
    if kind == "any":
        return None
    if isinstance(argument, Expression):
        if kind in ("number", "formula"):
            return None
        start = min((c for c in argument.columns if c >= 0), default=0)
        return f"a {kind} is needed, not '{argument.text}'", "", start, len(argument.text)
    if kind == "side":
        return None if argument.name in SIDES else _unknown(argument, kind, SIDES)
    if kind in ("number", "formula"):
        if "." in argument.name:
            return _unknown(argument, "name", catalog.allowed[""])
        try:
            return _names_in(catalog, parse(argument.name), argument.column)  # L-c reads like a member
        except ExpressionError as error:
            return error.what, error.mend, argument.column + error.column, error.length
    if kind.endswith("axis"):
        if argument.name in AXES:
            return None
        if kind == "axis":
            return _unknown(argument, kind, AXES)
    if kind.startswith("point"):
        wrong = missing_point(catalog, argument.name)
        return None if wrong is None else (wrong[0], wrong[1], argument.column + wrong[2], wrong[3])
    if kind == "reaction":
        return _reaction(catalog, argument)
    known = _known(catalog, kind)
    return None if argument.name in known else _unknown(argument, kind, known)


def _names_in(catalog: Catalog, expression: Expression, column: int) -> tuple[str, str, int, int] | None:
    """The first name of a number's expression that nothing declares; the expression stands at the column."""
    symbols = catalog.allowed[""]
    unknown = [(name, column + k) for name, k in expression.occurrences if name not in symbols]
    return _unknown(Reference(*unknown[0]), "name", symbols) if unknown else None


def _known(catalog: Catalog, kind: str) -> list[str]:
    between = {"force between points": "points", "force between bodies": "bodies"}.get(kind)
    if between is not None:
        forces = catalog.table("forces").items()
        return [name for name, part in forces if part and part.element and getattr(part.element, between)]
    tables = {
        "body": ("bodies",),
        "body or force": ("bodies", "forces"),
        "coordinate": ("coordinates",),
        "coordinate or speed": ("coordinates", "speeds"),
        "tie": ("constraints",),
        "tie or truss": ("constraints", "trusses"),
    }[kind]
    names = [name for table in tables for name in catalog.table(table)]
    return [*names, "ground"] if kind == "body" else names


def _unknown(argument: Reference, kind: str, known: Any) -> tuple[str, str, int, int]:
    return f"unknown {kind} '{argument.name}'", nearest(argument.name, known), argument.column, len(argument.name)


def _reaction(catalog: Catalog, argument: Reference) -> tuple[str, str, int, int] | None:
    """A tie, a tie's side (`B.II`), or a body, which means its joint."""
    owner, dot, side = argument.name.partition(".")
    ties, bodies = catalog.table("constraints"), catalog.table("bodies")
    if owner in ties:
        if dot and side not in bodies and side != "ground" and side not in catalog.nodes:
            return f"unknown body '{side}'", nearest(side, bodies), argument.column + len(owner) + 1, len(side)
        return None
    if owner in bodies:
        return _joint_reaction(catalog, argument, owner, side)
    jointed = [name for name, part in bodies.items() if part is not None and part.joint is not None]
    return _unknown(Reference(owner, argument.column), "tie or joint", [*ties, *jointed])


def _moves_as_given(catalog: Catalog, body: str, joint: Any) -> bool:
    """Whether time or a driven coordinate stands in where a body is placed: what moves it as given holds it too."""
    clocks = {"t", *(name for name, part in catalog.table("coordinates").items() if part is not None and part.driven)}
    clocks |= {tie.drives() for tie in catalog.table("constraints").values() if tie is not None}
    seats = {("bodies", body, "joint"), ("points", joint.at, "at"), ("points", joint.at)}
    mine = (expression for leaf, expression in catalog.expressions if {leaf.path[:2], leaf.path[:3]} & seats)
    return any(name in clocks for expression in mine for name, _ in expression.occurrences)


def _joint_reaction(catalog: Catalog, argument: Reference, body: str, side: str) -> tuple[str, str, int, int] | None:
    part = catalog.table("bodies")[body]
    if part is None or ("bodies", body, "joint") in catalog.broken:
        return None
    if part.joint is None or not (part.joint.carries_reaction or _moves_as_given(catalog, body, part.joint)):
        held = "has no joint" if part.joint is None else "is placed, which is geometry"
        mend = "name the constraint that holds it"
        return f"body '{body}' {held}: it has no reaction of its own", mend, argument.column, len(body)
    pieces = [piece.name for piece in getattr(part.joint, "pieces", None) or ()]
    if side and side not in pieces and side not in catalog.table("bodies"):
        column = argument.column + len(body) + 1
        return f"the joint of body '{body}' has no '{side}'", nearest(side, filter(None, pieces)), column, len(side)
    return None
