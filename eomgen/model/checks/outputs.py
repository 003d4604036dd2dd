"""Outputs: the functions of the motion that they call, and what each can be asked of."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from eomgen.model.checks.catalog import Catalog
from eomgen.model.checks.references import missing_point
from eomgen.model.fields import Leaf
from eomgen.model.findings import Finding, nearest
from eomgen.symbolic.expressions import Call, Expression, Reference
from eomgen.symbolic.functions import NAMES


@dataclass(frozen=True)
class Signature:
    """What a function takes: the kind of each argument, and how many there must be at least."""

    kinds: tuple[str, ...]
    least: int


def _functions() -> dict[str, Signature]:
    point, pair = Signature(("point", "body"), 1), Signature(("body", "body"), 1)
    table = {name: point for name in ("x", "y", "z", "vx", "vy", "vz", "ax", "ay", "az", "speed", "acceleration")}
    turning = ("angle", "omega", "epsilon", "rotation_center_x", "rotation_center_y")
    table |= {name: pair for name in (*turning, *(f"{n}_{axis}" for n in ("omega", "epsilon") for axis in "xyz"))}
    reactions = [f"reaction_{c}" for c in ("x", "y", "z", "n", "t", "couple", "couple_x", "couple_y", "couple_z")]
    table |= {name: Signature(("reaction", "body"), 1) for name in reactions}
    table |= {name: Signature(("coordinate", "coordinate"), 2) for name in ("mass", "damping", "stiffness")}
    table |= {f"inertia_{name}": Signature(("any",) * 6, 0) for name in ("point", "axis", "product", "tensor")}
    return table | {
        "kinetic_energy": Signature(("body",), 0),
        "potential_energy": Signature(("body or force",), 0),
        "power": Signature(("body or force",), 0),
        "generalized_force": Signature(("coordinate",), 1),
        "drive": Signature(("coordinate",), 1),
        "momentum": Signature(("coordinate or speed",), 1),
        "frequency": Signature(("number",), 1),
        "multiplier": Signature(("tie",), 1),
        "tension": Signature(("tie or truss", "any", "any"), 1),
    }


FUNCTIONS = _functions()
"""The functions of the motion, by name."""


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
    signature = FUNCTIONS.get(call.name)
    if signature is None:
        mend = nearest(call.name, [*FUNCTIONS, *NAMES])
        yield Finding(leaf.path, f"unknown function '{call.name}'", mend, call.column, len(call.name))
        return
    if not signature.least <= len(call.args) <= len(signature.kinds):
        most = len(signature.kinds)
        count = str(most) if most == signature.least else f"{signature.least} to {most}"
        what = f"{call.name} takes {count} argument{'' if count == '1' else 's'}, not {len(call.args)}"
        yield Finding(leaf.path, what, _usage(call.name, signature), call.column, len(call.name))
        return
    for argument, kind in zip(call.args, signature.kinds, strict=False):
        wrong = _argument(catalog, argument, kind)
        if wrong is not None:
            what, mend, column, length = wrong
            yield Finding(leaf.path, f"{what} (in {call})", mend, column, length)


def _usage(name: str, signature: Signature) -> str:
    shown = [k if i < signature.least else f"[{k}]" for i, k in enumerate(signature.kinds)]
    return f"{name}({', '.join(shown)})"


def _argument(catalog: Catalog, argument: Any, kind: str) -> tuple[str, str, int, int] | None:
    """What is wrong with an argument: message, mend, column, length; None when it is right."""
    if kind == "any":
        return None
    if isinstance(argument, Expression):
        if kind == "number":
            return None
        start = min((c for c in argument.columns if c >= 0), default=0)
        return f"a {kind} is needed, not '{argument.text}'", "", start, len(argument.text)
    if kind == "number":
        symbols = catalog.allowed[""]
        return None if argument.name in symbols else _unknown(argument, kind, symbols)
    if kind == "point":
        wrong = missing_point(catalog, argument.name)
        return None if wrong is None else (wrong[0], wrong[1], argument.column + wrong[2], wrong[3])
    if kind == "reaction":
        return _reaction(catalog, argument)
    known = _known(catalog, kind)
    return None if argument.name in known else _unknown(argument, kind, known)


def _known(catalog: Catalog, kind: str) -> list[str]:
    tables = {
        "body": ("bodies",), "body or force": ("bodies", "forces"), "coordinate": ("coordinates",),
        "coordinate or speed": ("coordinates", "speeds"), "tie": ("constraints",),
        "tie or truss": ("constraints", "trusses"),
    }[kind]  # fmt: skip
    names = [name for table in tables for name in catalog.table(table)]
    return [*names, "ground"] if kind == "body" else names


def _unknown(argument: Reference, kind: str, known: Any) -> tuple[str, str, int, int]:
    return f"unknown {kind} '{argument.name}'", nearest(argument.name, known), argument.column, len(argument.name)


def _reaction(catalog: Catalog, argument: Reference) -> tuple[str, str, int, int] | None:
    """A tie, a tie's side (`B.II`), or a body, which means its joint."""
    owner, dot, side = argument.name.partition(".")
    ties, bodies = catalog.table("constraints"), catalog.table("bodies")
    if owner in ties:
        if dot and side not in bodies and side != "ground":
            return f"unknown body '{side}'", nearest(side, bodies), argument.column + len(owner) + 1, len(side)
        return None
    if owner in bodies:
        return _joint_reaction(catalog, argument, owner, side)
    jointed = [name for name, part in bodies.items() if part is not None and part.joint is not None]
    return _unknown(Reference(owner, argument.column), "tie or joint", [*ties, *jointed])


def _joint_reaction(catalog: Catalog, argument: Reference, body: str, side: str) -> tuple[str, str, int, int] | None:
    part = catalog.table("bodies")[body]
    if part is None or ("bodies", body, "joint") in catalog.broken:
        return None
    if part.joint is None or not part.joint.carries_reaction:
        held = "has no joint" if part.joint is None else "is placed, which is geometry"
        mend = "name the constraint that holds it"
        return f"body '{body}' {held}: it has no reaction of its own", mend, argument.column, len(body)
    pieces = [piece.name for piece in getattr(part.joint, "pieces", None) or ()]
    if side and side not in pieces and side not in catalog.table("bodies"):
        column = argument.column + len(body) + 1
        return f"the joint of body '{body}' has no '{side}'", nearest(side, filter(None, pieces)), column, len(side)
    return None
