"""Outputs: the functions of the motion that they call, and what each can be asked of."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.model.catalog import Catalog
from eomgen.model.checks.references import missing_point
from eomgen.model.constraints.members import ends_asked
from eomgen.model.fields import Leaf
from eomgen.model.findings import Finding, nearest, whereabouts
from eomgen.symbolic.expression.expressions import Call, Expression, Reference, parse
from eomgen.symbolic.expression.functions import NAMES


@dataclass(frozen=True)
class Signature:
    """What a function takes: the kind of each argument, the least number of them, and of what there may be more."""

    kinds: tuple[str, ...]
    least: int
    more: str = ""


def _along(*names: str) -> tuple[str, ...]:
    """Each name with x, y and z in place of its star."""
    return tuple(name.replace("*", axis) for name in names for axis in AXES)


AXES = ("x", "y", "z")
_BY_SIGNATURE = (
    (Signature(("point", "body", "body"), 1), _along("*", "v*", "a*")),
    (
        Signature(("point", "body"), 1),
        ("speed", "acceleration", "tangential_acceleration", "normal_acceleration", "curvature_radius"),
    ),
    (
        Signature(("point", "body", "body"), 2),
        _along("transport_v*", "transport_a*", "coriolis_a*", "euler_a*", "centripetal_a*"),
    ),
    (
        Signature(("point", "body"), 2),
        (
            "transport_speed",
            "transport_acceleration",
            "coriolis_acceleration",
            "euler_acceleration",
            "centripetal_acceleration",
        ),
    ),
    (Signature(("body",), 1), ("acceleration_pole_x", "acceleration_pole_y")),
    (Signature(("point", "point"), 2), ("least_speed",)),
    (
        Signature(("body", "body"), 1),
        ("angle", "omega", "epsilon", "rotation_center_x", "rotation_center_y", *_along("omega_*", "epsilon_*")),
    ),
    (
        Signature(("reaction", "body"), 1),
        ("reaction_n", "reaction_t", "reaction_s", "reaction_couple", *_along("reaction_*", "reaction_couple_*")),
    ),
    (Signature(("tie or truss", "any", "any"), 1), ("tension",)),
    (Signature(("tie",), 1), ("multiplier",)),
    (Signature(("body", "number", "side"), 2), ("axial_force", "shear_force", "bending_moment")),
    (Signature(("body", "number"), 1), ("mass_of",)),
    (Signature(("point",), 1, "body"), ("inertia_point", *_along("angular_momentum_*"))),
    (Signature(("point", "point or axis"), 2, "body"), ("inertia_axis",)),
    (Signature(("point", "axis"), 2, "body"), ("inertia_plane",)),
    (Signature(("point", "axis", "axis"), 3, "body"), ("inertia_product", "inertia_tensor")),
    (Signature(("point", "number"), 2, "body"), ("principal_moment",)),
    (Signature(("body",), 0), ("kinetic_energy",)),
    (Signature(("body or force",), 0), ("potential_energy", "power")),
    (Signature(("coordinate",), 1), ("generalized_force", "drive")),
    (Signature(("coordinate or speed",), 1), ("momentum",)),
    (Signature(("coordinate", "coordinate"), 2), ("mass", "damping", "stiffness")),
    (Signature(("number",), 1), ("frequency",)),
)
SIDES = ("before", "after")
FUNCTIONS = {name: signature for signature, names in _BY_SIGNATURE for name in names}
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
    functions = getattr(leaf.rule, "functions", None)
    if functions is not None and (call.name not in functions or len(call.args) > 2):
        what, mend = f"'{call}' cannot stand in {whereabouts(leaf.path)}", f"only {', '.join(functions)} can stand here"
        few = "name one body, whose axes are meant too"
        yield Finding(leaf.path, what, few if call.name in functions else mend, call.column, len(call.name))
        return
    kinds = signature.kinds + (signature.more,) * (len(call.args) - len(signature.kinds) if signature.more else 0)
    if not signature.least <= len(call.args) <= len(kinds):
        most = len(signature.kinds)
        count = str(most) if most == signature.least else f"{signature.least} to {most}"
        count = f"at least {signature.least}" if signature.more else count
        what = f"{call.name} takes {count} argument{'' if count in ('1', 'at least 1') else 's'}, not {len(call.args)}"
        yield Finding(leaf.path, what, _usage(call.name, signature), call.column, len(call.name))
        return
    if call.name == "tension" and isinstance(call.args[0], Reference):
        yield from _member(catalog, leaf, call, call.args[0].name)
    for argument, kind in zip(call.args, kinds, strict=False):
        wrong = _argument(catalog, argument, kind)
        if wrong is not None:
            what, mend, column, length = wrong
            yield Finding(leaf.path, f"{what} (in {call})", mend, column, length)


def _member(catalog: Catalog, leaf: Leaf, call: Call, owner: str) -> Iterator[Finding]:
    """Of a truss the tension of one of its members can be asked."""
    truss = catalog.table("trusses").get(owner)
    if truss is None or truss.members is None:
        return
    ends = ends_asked(call)
    if ends is None or set(ends) not in [set(member.split("-")) for member in truss.members]:
        what = f"truss '{owner}' has no member '{'-'.join(ends)}'" if ends else f"'{call}' names no member"
        mend = nearest("-".join(ends or ()), truss.members) or f"tension({owner}, {truss.members[0]})"
        yield Finding(leaf.path, what, mend, call.column, len(call.name))


def _usage(name: str, signature: Signature) -> str:
    shown = [k if i < signature.least else f"[{k}]" for i, k in enumerate(signature.kinds)]
    return f"{name}({', '.join([*shown, *([f'[{signature.more}, ...]'] if signature.more else [])])})"


def _argument(catalog: Catalog, argument: Any, kind: str) -> tuple[str, str, int, int] | None:
    """What is wrong with an argument: message, mend, column, length; None when it is right."""
    if kind == "any":
        return None
    if isinstance(argument, Expression):
        if kind == "number":
            return None
        start = min((c for c in argument.columns if c >= 0), default=0)
        return f"a {kind} is needed, not '{argument.text}'", "", start, len(argument.text)
    if kind == "side":
        return None if argument.name in SIDES else _unknown(argument, kind, SIDES)
    if kind == "number":
        if "." in argument.name:
            return _unknown(argument, kind, catalog.allowed[""])
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
