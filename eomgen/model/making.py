"""Declared parts -> a finished Model: fields read, checks made, places on the ground resolved."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import islice
from typing import Any, TypeVar

from eomgen.errors import ExpressionError, ModelError, Problem
from eomgen.model.catalog import Catalog, diagnostics_of_one, owner_of
from eomgen.model.checks.names import equations, formulas, missing_point, names, references, speeds
from eomgen.model.checks.plausible import bodies, numbers
from eomgen.model.constraints import Limit
from eomgen.model.diagnostics import Diagnostic, nearest
from eomgen.model.fields import Leaf, NameRule, Table, WrittenEquation
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.outputs.base import AXES, DRY_JOINT, SIDES
from eomgen.model.part import Part, read_part
from eomgen.model.parts import StateVariable
from eomgen.model.positions import DocumentPath
from eomgen.model.quantities import Unit
from eomgen.model.units import Typing, dimensions, typing_of
from eomgen.model.value_tables import TABLES, functions_of_tables, with_functions
from eomgen.symbolic.expression import NAMES, Call, Expression, Reference, parse, rate_of_call

# -------- all checks -------------------------------------------------------------------------------------------
# Outputs, constraints and forces: fields that go together, and all checks in their order.
#
# All checks, in the order in which they are reported for one place.

# -------- outputs ---------------------------------------------------------------------------------------------
# Outputs: the functions of the motion that they call, and the arguments of each.


def outputs(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of unknown functions, of a wrong number of arguments, of arguments that were never declared."""
    for leaf, expression in catalog.expressions:
        for call in _calls_in(expression):
            yield from _call(catalog, leaf, call)


def _calls_in(expression: Expression) -> Iterator[Call]:
    for call in expression.calls:
        yield call
        for argument in call.args:
            if isinstance(argument, Expression):
                yield from _calls_in(argument)


def _call(catalog: Catalog, leaf: Leaf, call: Call) -> Iterator[Diagnostic]:
    if call.name.rstrip("'") in catalog.table("tables"):
        return
    function = FUNCTIONS.get(call.name)
    if function is None:
        there = [name for name in FUNCTIONS if catalog.model.space != "plane" or name[-1] != "z" or name == "omega_z"]
        fix = rate_of_call(str(call)) or nearest(call.name, [*there, *NAMES])
        yield Diagnostic(leaf.path, f"unknown function '{call.name}'", fix, call.column, len(call.name))
        return
    functions = getattr(leaf.rule, "functions", None)
    if functions is not None and (call.name not in functions or len(call.args) > 2):
        what, fix = f"'{call}' cannot stand in {leaf.whereabouts}", f"only {', '.join(functions)} can stand here"
        few = "name one body, whose axes are meant too"
        yield Diagnostic(leaf.path, what, few if call.name in functions else fix, call.column, len(call.name))
        return
    kinds = function.kinds + (function.more,) * (len(call.args) - len(function.kinds) if function.more else 0)
    if not function.least <= len(call.args) <= len(kinds):
        most = len(function.kinds)
        count = str(most) if most == function.least else f"{function.least} to {most}"
        count = f"at least {function.least}" if function.more else count
        what = f"{call.name} takes {count} argument{'' if count in ('1', 'at least 1') else 's'}, not {len(call.args)}"
        yield Diagnostic(leaf.path, what, f"{call.name}{function.arguments}", call.column, len(call.name))
        return
    yield from function.diagnostics(catalog, leaf, call)
    for argument, kind in zip(call.args, kinds, strict=False):
        wrong = _argument(catalog, argument, kind)
        if wrong is not None:
            what, fix, column, length = wrong
            yield Diagnostic(leaf.path, f"{what} (in {call})", fix, column, length)


def _argument(catalog: Catalog, argument: Any, kind: str) -> tuple[str, str, int, int] | None:
    """The error of an argument: message, fix, column, length; None if it is right."""
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
            return error.what, error.fix, argument.column + error.column, error.length
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
        drawn = [name for name, part in forces if part and part.element and getattr(part.element, between)]
        return drawn + [name for name, part in forces if part and part.tight and between == "points"]
    if kind == DRY_JOINT:
        return list(catalog.joints_with_friction)
    tables = {
        "body": ("bodies",),
        "body or force": ("bodies", "forces"),
        "coordinate": ("coordinates",),
        "coordinate or speed": ("coordinates", "speeds"),
        "constraint": ("constraints",),
        "constraint or truss": ("constraints", "trusses"),
    }[kind]
    names = [name for table in tables for name in catalog.table(table)]
    return [*names, "ground"] if kind == "body" else names


def _unknown(argument: Reference, kind: str, known: Any) -> tuple[str, str, int, int]:
    return f"unknown {kind} '{argument.name}'", nearest(argument.name, known), argument.column, len(argument.name)


def _reaction(catalog: Catalog, argument: Reference) -> tuple[str, str, int, int] | None:
    """The error of a reaction's argument: a constraint, a constraint's side (`B.II`), or a body, for its joint."""
    owner, dot, side = argument.name.partition(".")
    constraints, bodies = catalog.table("constraints"), catalog.table("bodies")
    if owner in constraints:
        if dot and side not in bodies and side != "ground" and side not in catalog.nodes:
            return f"unknown body '{side}'", nearest(side, bodies), argument.column + len(owner) + 1, len(side)
        return None
    if owner in bodies:
        return _joint_reaction(catalog, argument, owner, side)
    jointed = [name for name, part in bodies.items() if part is not None and part.joint is not None]
    return _unknown(Reference(owner, argument.column), "constraint or joint", [*constraints, *jointed])


def _moves_as_given(catalog: Catalog, body: str, joint: Any) -> bool:
    """True if the position of a body depends on time or a driven coordinate: its joint then has a reaction."""
    clocks = {"t", *(name for name, part in catalog.table("coordinates").items() if part is not None and part.driven)}
    clocks |= {constraint.drives() for constraint in catalog.table("constraints").values() if constraint is not None}
    seats = {("bodies", body, "joint"), ("points", joint.at, "at"), ("points", joint.at)}
    mine = (expression for leaf, expression in catalog.expressions if {leaf.path[:2], leaf.path[:3]} & seats)
    return any(name in clocks for expression in mine for name, _ in expression.occurrences)


def _joint_reaction(catalog: Catalog, argument: Reference, body: str, side: str) -> tuple[str, str, int, int] | None:
    part = catalog.table("bodies")[body]
    if part is None or ("bodies", body, "joint") in catalog.broken:
        return None
    if part.joint is None or not (part.joint.carries_reaction or _moves_as_given(catalog, body, part.joint)):
        held = "has no joint" if part.joint is None else "is placed, which is geometry"
        fix = "name the constraint that holds it"
        return f"body '{body}' {held}: it has no reaction of its own", fix, argument.column, len(body)
    pieces = [piece.name for piece in getattr(part.joint, "pieces", None) or ()]
    if side and side not in pieces and side not in catalog.table("bodies"):
        column = argument.column + len(body) + 1
        return f"the joint of body '{body}' has no '{side}'", nearest(side, filter(None, pieces)), column, len(side)
    return None


# -------- constraints ------------------------------------------------------------------------------------------------
# Constraints, forces and coordinates: what goes together, what excludes what, and that nothing is idle.


_WORD = re.compile(r"[^\W\d]\w*")


def constraints(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of fields of constraints and forces that exclude one another, or of which one is missing."""
    for table in ("constraints", "forces"):
        for name, part in catalog.table(table).items():
            if part is None:
                continue
            path: DocumentPath = (table, name)
            if part.one_of:
                yield from diagnostics_of_one(catalog, path, part, part.one_of)
            yield from part.diagnostics(path, catalog)
            if table == "constraints":
                yield from _on_itself(catalog, path, part)
            declared = table == "constraints" and part.is_whole and part.exponent is None
            if declared and (friction := getattr(part, "friction", None)) is not None:
                yield from diagnostics_of_one(catalog, (*path, "friction"), friction, ("coulomb", "viscous"))


def _on_itself(catalog: Catalog, path: DocumentPath, part: Any) -> Iterator[Diagnostic]:
    """Diagnostics of a constraint that joins a body to itself, or the ground to the ground."""
    name = path[1]
    bodies = getattr(part, "bodies", None)
    if bodies and bodies[0] == bodies[1]:
        yield Diagnostic((*path, "bodies", 1), f"'{name}' gears body '{bodies[0]}' with itself", "name two bodies")
    points = getattr(part, "points", None) or ()
    point = getattr(part, "point", None)
    if any(name not in catalog.point_names() for name in (point, *points) if name is not None):
        return
    if point is not None and "." not in point and not part.holds_ground:
        yield Diagnostic((*path, "point"), f"'{name}' holds '{point}', a point of the ground", "name a point of a body")
    owners = {owner_of(point) for point in points}
    if len(owners) == 1 and (len(points) > 1 or "" in owners):
        whose = f"body '{owner}'" if (owner := owners.pop()) else "the ground"
        yield Diagnostic((*path, "points"), f"'{name}' joins {whose} to itself", "name points of different bodies")


def coordinates(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of coordinates driven twice, or driven and dependent; of starts that a given motion fixes."""
    for name, part in catalog.table("coordinates").items():
        if part is None:
            continue
        path: DocumentPath = ("coordinates", name)
        laws = [law for law in ("motion", "rate", "acceleration") if getattr(part, law) is not None]
        if len(laws) > 1:
            what = f"coordinate '{name}' is driven twice: {', '.join(laws)}"
            yield Diagnostic((*path, laws[1]), what, "keep one", key=True)
        if laws and part.dependent:
            what = f"coordinate '{name}' is driven and dependent"
            yield Diagnostic((*path, "dependent"), what, "it is one or the other", key=True)
        fixed = {"motion": ("start", "speed", "near"), "rate": ("speed", "near"), "acceleration": ("near",)}
        for key in fixed[laws[0]] if laws else ():
            if getattr(part, key) is not None:
                what = f"'{key}' of coordinate '{name}' is given by its '{laws[0]}' already"
                yield Diagnostic((*path, key), what, "leave it out", key=True)


def idle(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of a coordinate, a speed or an input that nothing uses."""
    used = _used(catalog)
    for table, kind in (("coordinates", "coordinate"), ("inputs", "input")):
        for name in catalog.table(table):
            if name not in used:
                yield Diagnostic(
                    (table, name), f"{kind} '{name}' is used by nothing", "use it, or leave it out", key=True
                )
    for name, part in catalog.table("speeds").items():
        broken = ("speeds", name, "rate") in catalog.broken
        if part is not None and part.rate is None and name not in used and not broken:
            what = f"speed '{name}' has no 'rate' and no joint names it in 'omega'"
            yield Diagnostic(("speeds", name), what, "give its 'rate', an expression in the rates", key=True)


def _used(catalog: Catalog) -> set[str]:
    """The names that something uses: an entry of their own table is no use; what could not be read is one."""
    used: set[str] = set()
    for leaf, expression in catalog.expressions:
        if leaf.path[0] not in ("parameters", "coordinates", "speeds", "inputs"):
            used.update(name.rstrip("'") for name in expression.names)
            used.update(a.name for call in expression.calls for a in call.args if not hasattr(a, "code"))
    used.update(leaf.value for leaf in catalog.leaves if isinstance(leaf.rule, NameRule))
    for name, part in catalog.table("speeds").items():
        if name in used and part is not None and part.rate is not None:
            used.update(x.rstrip("'") for x in part.rate.names)
    for diagnostic in catalog.found:
        used.update(_WORD.findall(str(diagnostic.raw)))
    return used


# -------- everything ------------------------------------------------------------------------------------------


ALL = (
    names,
    references,
    formulas,
    dimensions,
    equations,
    outputs,
    numbers,
    bodies,
    constraints,
    coordinates,
    speeds,
    idle,
)


MOST_DIAGNOSTICS = 200  # of one model: more say nothing new


Made = TypeVar("Made", bound=Part)


def draft_of(cls: Any, raw: Mapping[str, Any], title: str, found: list[Diagnostic]) -> Any:
    """A model from the tables of a file, unchecked; what could not be read is None and has a diagnostic."""
    if TABLES in raw:
        raw = with_functions(raw, functions_of_tables(raw[TABLES], found), found)
    draft = read_part(cls, {"name": title, **raw}, (), found, known=("eomgen",))
    found[:] = map(_of_outputs_alone, found)
    seated = draft.altered(bodies=_seated(draft), **_with_states(draft))
    limited = with_limits(seated)
    return seated.altered(constraints=Table(limited)) if len(limited) > len(draft.constraints or {}) else seated


def _of_outputs_alone(problem: Diagnostic) -> Diagnostic:
    """The same with a fix for a function of outputs where none may stand: no product was meant."""
    called = re.fullmatch(r"unknown function '(\w+)'", problem.what)
    if called is None or called[1] not in FUNCTIONS or problem.path[0] == "outputs":
        return problem
    fix = f"{called[1]} is for [outputs]: write here what it is, in coordinates, rates, accelerations"
    return replace(problem, fix=fix)


def _seated(model: Any) -> Table[Any]:
    """The bodies of a draft, those that sit on a point of the ground (`on = "O"`) by `at`."""
    points: Mapping[str, Any] = model.points or {}
    bodies: Mapping[str, Any] = model.bodies or {}  # one that could not be read is None
    found = {}
    for name, body in bodies.items():
        joint = None if body is None else body.joint
        on = None if joint is None or joint.at is not None else joint.on
        found[name] = body
        if body is not None and joint is not None and on in points:
            found[name] = body.altered(joint=joint.altered(on=None, at=on))
    return Table(found)


def with_limits(model: Any) -> Any:
    """The model with a constraint for each limit of a joint: arm_low, arm_high; of several variables arm_angle_low."""
    found = dict(model.constraints or {})
    for body, part in (model.bodies or {}).items():
        joint: Any = None if part is None else part.joint
        for k, field, limits in () if joint is None else joint.limits_of_variables:
            settled = limits.in_si(joint.unit_of_limits(field, model.coordinates or {}))
            several = joint.named_contact(body, field)
            for end, bound in (("low", settled.low), ("high", settled.high)):
                if bound is not None:
                    values = {"body": body, "variable": k, "bound": bound, "upper": end == "high"}
                    stop = Limit.of_values({**values, "restitution": joint.restitution})
                    found[_free_name(f"{several}_{end}", stop, found)] = stop
    return found


def _with_states(model: Any) -> dict[str, Any]:
    """Forces by their names, and the states with those that forces bring along: jack_p_1 of the force `jack`.

    A start that a person typed for one stays; another model's own states do not.
    """
    forces, states = dict(model.forces or {}), dict(model.states or {})
    before = {name: state for name, state in states.items() if state is not None and state.force}
    states = {name: state for name, state in states.items() if name not in before}
    for name, force in forces.items():
        for own in () if force is None else force.own_states:
            forces[name] = force.altered(name=name)
            made = StateVariable.of_values({"unit": Unit.parse(own.unit), "about": own.about, "force": name})
            known = before.get(f"{name}_{own.name}")
            typed = known is not None and known.start is not None and known.start.typed
            start = known.start if typed and known is not None else own.start
            states.setdefault(f"{name}_{own.name}", made.altered(start=start))
    return {"forces": Table(forces), "states": Table(states)} if forces else {}


def _free_name(name: str, stop: Limit, constraints: Mapping[str, Any]) -> str:
    """The name, with a line below where another constraint has it."""
    while name in constraints and not isinstance(constraints[name], Limit):
        name += "_"
    return name


def diagnostics_of(model: Any, found: list[Diagnostic]) -> list[Diagnostic]:
    """The problems of a model that was read, beyond those found by reading it."""
    catalog = Catalog(model, tuple(found))
    every = (diagnostic for check in ALL for diagnostic in check(catalog))
    return list(dict.fromkeys(islice(every, MOST_DIAGNOSTICS)))


def finish(model: Any) -> None:
    """Reads the fields of a model made in Python, checks it as a whole and resolves it, in place (it is being made).

    Raises:
        ModelError: every problem at once, by path ("bodies.arm.joint.on").
    """
    found: list[Diagnostic] = []
    functions = functions_of_tables({} if model.tables is None else model.tables, found)
    for slot in type(model).slots():
        raw = getattr(model, slot.name)
        if raw is not slot.default:
            raw = with_functions({slot.name: raw}, functions, found)[slot.name] if functions else raw
            object.__setattr__(model, slot.name, slot.rule.read(raw, (slot.key,), found))
    object.__setattr__(model, "bodies", _seated(model))
    object.__setattr__(model, "constraints", Table(with_limits(model)))
    for name, value in _with_states(model).items():
        object.__setattr__(model, name, value)
    found += diagnostics_of(model, found)
    if found:
        raise ModelError(tuple(Problem(".".join(map(str, f.path)), f.what, fix=f.fix) for f in found))
    for name, value in _resolved_tables(model).items():
        object.__setattr__(model, name, value)


def resolved(model: Made) -> Made:
    """The checked model with the places of its ground joints as coordinates and its own points without their body."""
    return model.altered(**_resolved_tables(model))


def _resolved_tables(model: Any) -> dict[str, Any]:
    constraints, centers = _with_centers(model)
    bodies = Table({name: _resolved_body(model, name, body) for name, body in model.bodies.items()})
    for name, points in centers.items():
        own = bodies[name].points or {}
        bodies = Table({**bodies, name: bodies[name].altered(points=Table({**own, **points}))})
    forces = {name: _resolved_force(force) for name, force in model.forces.items()}
    outputs = {name: _settled(output, typing_of(model, "outputs"), ("at",)) for name, output in model.outputs.items()}
    typing = typing_of(model, "given")
    given = None if model.given is None else _settled(model.given, typing, ("velocity", "acceleration"))
    return {
        "bodies": bodies,
        "constraints": constraints,
        "forces": Table(forces),
        "outputs": Table(outputs),
        "given": given,
    }


def _with_centers(model: Any) -> tuple[Table[Any], dict[str, dict[str, Any]]]:
    """The constraints, each place that is the center of a body a point of it; and these points, by body."""
    found: dict[str, Any] = {}
    points: dict[str, dict[str, Any]] = {}
    for name, constraint in model.constraints.items():
        center = getattr(constraint, "center", None)
        found[name] = constraint
        if isinstance(center, tuple):
            body = model.bodies[constraint.body]
            own = f"center_of_{name}"
            while own in (body.points or {}) or own in points.get(constraint.body, {}):
                own += "_"
            points.setdefault(constraint.body, {})[own] = center
            found[name] = constraint.altered(center=own)
    return Table(found), points


def _settled(part: Any, typing: Typing, keys: tuple[str, ...]) -> Any:
    """A part whose equations are in SI."""

    def in_si(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(in_si, value))
        return typing.equation(value)[0] if isinstance(value, WrittenEquation) else value

    changes = {key: in_si(getattr(part, key)) for key in keys}
    return part if all(value is None for value in changes.values()) else part.altered(**changes)


def _resolved_force(force: Any) -> Any:
    between = getattr(force, "between", None)
    return force if between is None else force.altered(between=tuple(_own(point) for point in between))


def _resolved_body(model: Any, name: str, body: Any) -> Any:
    changes: dict[str, Any] = {}
    if body.line is not None:
        changes["line"] = tuple(_own(point) for point in body.line)
    joint = _with_stop(model, body.joint)
    if joint is not body.joint:
        changes["joint"] = joint
    if joint is not None:
        point = None if joint.point is None else _own(joint.point)
        at = model.place(joint.at) if isinstance(joint.at, str) else joint.at
        if point != joint.point or at is not joint.at:
            changes["joint"] = joint.altered(point=point, at=at)
    return body.altered(**changes) if changes else body


def _with_stop(model: Any, joint: Any) -> Any:
    """A joint whose stops yield, with its limits in SI."""
    law, limits = getattr(joint, "stop", None), getattr(joint, "limits", None)
    if law is None or limits is None or all(limits.settled):
        return joint
    return joint.altered(limits=limits.in_si(joint.unit_of_limits(joint.limited[0], model.coordinates or {})))


def _own(point: str) -> str:
    """The name of a body's own point, without the body."""
    return point.rpartition(".")[2]
