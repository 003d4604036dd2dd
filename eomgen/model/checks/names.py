"""Names and formulas: what may be one, that each means one thing, was declared, and has the unit that fits.

Names: what may be one, and that each means one thing.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.model.catalog import OBJECT_TABLES, SYMBOL_TABLES, Catalog
from eomgen.model.diagnostics import Diagnostic, article, nearest, one_of
from eomgen.model.fields import (
    EVERYTHING,
    STATEMENT,
    AxialRule,
    Leaf,
    NameRule,
    StatementRule,
    VectorRule,
    WrittenEquation,
    is_mixed,
    mixed,
)
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.parts import begun_speeds
from eomgen.model.positions import DocumentPath
from eomgen.model.units import typing_of
from eomgen.model.values import in_order
from eomgen.symbolic.expression import NAMES, Expression, degrees, is_name, meant_name

RESERVED = {"t": "time", "pi": "the constant", "nan": "no number", "inf": "no number", "infinity": "no number"}
_WORD = re.compile(r"\w+")


def names(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of invalid names, reserved names, and names that stand for two things."""
    yield from _symbols(catalog)
    yield from _objects(catalog)
    yield from _points(catalog)
    yield from _tables(catalog)
    yield from _states_of_forces(catalog)
    yield from _twice(catalog, (*SYMBOL_TABLES, "tables"))
    yield from _twice(catalog, OBJECT_TABLES)


def _symbols(catalog: Catalog) -> Iterator[Diagnostic]:
    for table in SYMBOL_TABLES:
        for name in catalog.table(table):
            if name in RESERVED or name.lower() in ("nan", "inf", "infinity"):
                meaning = RESERVED[name.lower()]
                yield Diagnostic(
                    (table, name), f"'{name}' is reserved: it means {meaning}", "take another name", key=True
                )
            elif not is_name(name):
                yield _no_name(table, name, "letters, digits and _, a letter first")


def _tables(catalog: Catalog) -> Iterator[Diagnostic]:
    for name in catalog.table("tables"):
        if name in NAMES or name in FUNCTIONS:
            what = f"'{name}' is a function already"
            yield Diagnostic(("tables", name), what, "take another name", key=True)
        elif not is_name(name) or name in RESERVED:
            yield _no_name("tables", name, "letters, digits and _, a letter first")


def _objects(catalog: Catalog) -> Iterator[Diagnostic]:
    for table in (*OBJECT_TABLES, "points", "forces", "outputs"):
        for name in catalog.table(table):
            if not _WORD.fullmatch(name):
                yield _no_name(table, name, "letters, digits and _")
            elif table == "bodies" and name == "ground":
                yield Diagnostic((table, name), "'ground' means the ground, not a body", "take another name", key=True)


def _no_name(table: str, name: str, made_of: str) -> Diagnostic:
    return Diagnostic((table, name), f"'{name}' cannot name {one_of(table)}", f"a name is made of {made_of}", key=True)


def _points(catalog: Catalog) -> Iterator[Diagnostic]:
    for body, part in catalog.table("bodies").items():
        for point in (part.points or {}) if part else ():
            path = ("bodies", body, "points", point)
            if not _WORD.fullmatch(point):
                yield Diagnostic(path, f"'{point}' cannot name a point", "use letters, digits and _", key=True)
            elif point in _points_of_its_own(part):
                what = f"body '{body}' has a point '{point}' of its own already"
                yield Diagnostic(path, what, "take another name, or leave it out", key=True)


def _points_of_its_own(part: Any) -> tuple[str, ...]:
    if part.shape is not None:
        return tuple(part.shape.point_names)
    heavy = any(source is not None for source in (part.mass, part.center, part.parts))
    return ("origin", "center") if heavy else ()


def _states_of_forces(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of names that a force takes for the states that it brings along."""
    for force, part in catalog.table("forces").items():
        for own in () if part is None else part.own_states:
            name = f"{force}_{own.name}"
            other = next((table for table in (*SYMBOL_TABLES, "tables") if name in catalog.table(table)), "")
            state = catalog.table("states").get(name)
            if other != "states" or state is None or state.force != force:
                what = f"'{name}' is declared as {one_of(other)}, and is the name of a state of the force '{force}'"
                yield Diagnostic((other, name), what, "give one of them another name", key=True)


def _twice(catalog: Catalog, tables: tuple[str, ...]) -> Iterator[Diagnostic]:
    first: dict[str, str] = {}
    for table in tables:
        for name, part in catalog.table(table).items():
            if table == "states" and part is not None and part.force:  # as `_states_of_forces` says
                continue
            if name in first:
                what = f"'{name}' is declared twice: as {one_of(first[name])} and as {one_of(table)}"
                yield Diagnostic((table, name), what, "give one of them another name", key=True)
            first.setdefault(name, table)


# -------- references ------------------------------------------------------------------------------------------
# References: every body, point, coordinate that is named was declared; every vector has its length.


def references(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of names of parts that were never declared; of vectors and inertias of the wrong length."""
    for leaf in catalog.leaves:
        if isinstance(leaf.rule, NameRule):
            yield from _CHECKS[leaf.rule.of](catalog, leaf)
        elif isinstance(leaf.rule, StatementRule):
            yield from _statement(catalog, leaf)
        elif isinstance(leaf.rule, VectorRule):
            yield from _vector(catalog, leaf)
        elif isinstance(leaf.rule, AxialRule):
            yield from _axial(catalog, leaf)
    yield from _idle_nodes(catalog)


def missing_point(catalog: Catalog, point: str) -> tuple[str, str, int, int] | None:
    """The error of a point's name: message, fix, column and length of the culprit; None if it is declared."""
    owner, dot, name = point.partition(".")
    if not dot:
        if point in catalog.table("points"):
            return None
        if point in catalog.table("bodies"):
            offered = ", ".join(f"'{point}.{p}'" for p in catalog.body_points(point))
            return f"'{point}' is a body, not a point", f"one of its points: {offered}", 0, len(point)
        of_bodies = [p for p in catalog.point_names() if p.endswith("." + point)]
        fix = f"did you mean '{of_bodies[0]}'?" if of_bodies else nearest(point, catalog.point_names())
        declared = f"declare it in [points]: {point} = [...]" if point.isidentifier() else "declare it in [points]"
        return f"unknown point of the ground: '{point}'", fix or declared, 0, len(point)
    if owner in catalog.table("trusses"):
        nodes = (catalog.table("trusses")[owner] and catalog.table("trusses")[owner].nodes) or {}
        if name in nodes:
            return None
        return f"truss '{owner}' has no node '{name}'", nearest(name, nodes) or _nodes(nodes), len(owner) + 1, len(name)
    if owner not in catalog.table("bodies"):
        return _unknown_body(catalog, owner)
    return _missing_own(catalog, owner, name, len(owner) + 1)


def _unknown_body(catalog: Catalog, body: str) -> tuple[str, str, int, int]:
    known = [*catalog.table("bodies"), *catalog.table("trusses")]
    return f"unknown body '{body}'", nearest(body, known), 0, len(body)


def _missing_own(catalog: Catalog, body: str, point: str, column: int) -> tuple[str, str, int, int] | None:
    known = catalog.body_points(body)
    if point in known or ("bodies", body, "points") in catalog.broken or ("bodies", body, "shape") in catalog.broken:
        return None
    if catalog.table("bodies")[body] is None:
        return None
    listed = ", ".join(known)
    fix = nearest(point, known) or f"it has {listed}"
    return f"body '{body}' has no point '{point}'", fix, column, len(point)


def _point(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
    yield from _reported(leaf, missing_point(catalog, leaf.value))


def _reported(leaf: Leaf, wrong: tuple[str, str, int, int] | None) -> Iterator[Diagnostic]:
    if wrong is not None:
        what, fix, column, length = wrong
        yield Diagnostic(leaf.path, f"{what} (in {leaf.whereabouts})", fix, column, length)


def _own_point(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
    body = leaf.path[1] if leaf.path[0] == "bodies" else leaf.part.body
    if not isinstance(body, str) or body not in catalog.table("bodies"):
        return
    owner, dot, name = leaf.value.partition(".")
    if dot and owner != body:
        what = f"'{leaf.value}' is not a point of body '{body}'"
        yield Diagnostic(leaf.path, what, f"only a point of '{body}' can stand here", 0, len(owner))
    else:
        name = name if dot else owner
        yield from _reported(leaf, _missing_own(catalog, body, name, len(owner) + 1 if dot else 0))


def _seat(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
    owner, dot, name = leaf.value.partition(".")
    body = leaf.path[1]
    if owner not in catalog.table("bodies"):
        what = f"joint of body '{body}' hangs on a body that was never declared: '{owner}'"
        fix = nearest(owner, [b for b in catalog.table("bodies") if b != body])
        if owner == "ground" or owner in catalog.table("points"):
            fix = "leave out 'on' for the ground" + ("" if owner == "ground" else f', and write at = "{owner}"')
        yield Diagnostic(leaf.path, what, fix, 0, len(owner))
    elif dot:
        yield from _reported(leaf, _missing_own(catalog, owner, name, len(owner) + 1))


def _statement(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
    """Diagnostics of names in braces, in the words of a problem, that have no value."""
    known = [name for table in ("parameters", "coordinates", "states", "inputs") for name in catalog.table(table)]
    known += [f"{name}'" for name in catalog.table("coordinates")]
    for each in STATEMENT.finditer(leaf.value):
        name = (each["name"] or "").strip()
        if each["name"] is not None and name not in known:
            fix = nearest(name, known) or "a formula stands between dollars: $\\{...\\}$"
            what = f"'{name}' in braces is no parameter, coordinate or input"
            yield Diagnostic(leaf.path, what, fix, each.start("name"), max(1, len(each["name"])))


def _idle_nodes(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of nodes that no member joins to a truss."""
    for name, truss in catalog.table("trusses").items():
        if truss is None or truss.members is None:
            continue
        joined = {node for member in truss.members for node in member.split("-")}
        for node in truss.nodes or {}:
            if node not in joined:
                what = f"node '{node}' of truss '{name}' has no member"
                yield Diagnostic(
                    ("trusses", name, "nodes", node), what, "join it by a member, or leave it out", key=True
                )


def _declared(table: str, what: str) -> Callable[[Catalog, Leaf], Iterator[Diagnostic]]:
    def check(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
        known = catalog.table(table)
        if leaf.value not in known:
            wrong = f"unknown {what} '{leaf.value}' in {leaf.whereabouts}"
            yield Diagnostic(leaf.path, wrong, nearest(leaf.value, known), 0, len(leaf.value))

    return check


def _axes(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
    if leaf.value != "ground":
        yield from _declared("bodies", "axes: no body")(catalog, leaf)


def _member(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
    truss = catalog.table("trusses")[leaf.path[1]]
    ends = leaf.value.split("-")
    if len(ends) != 2 or ends[0] == ends[1]:
        yield Diagnostic(leaf.path, f"'{leaf.value}' is no member", 'a member joins two nodes: "n1-n2"')
        return
    before = [set(member.split("-")) for member in (truss.members or ())[: int(leaf.path[-1])]]
    if set(ends) in before:
        yield Diagnostic(
            leaf.path, f"member '{leaf.value}' of truss '{leaf.path[1]}' stands there twice", "leave one out"
        )
    for k, node in enumerate(ends):
        if truss.nodes is not None and node not in truss.nodes:
            column = 0 if k == 0 else len(ends[0]) + 1
            what = f"truss '{leaf.path[1]}' has no node '{node}'"
            yield Diagnostic(leaf.path, what, nearest(node, truss.nodes) or _nodes(truss.nodes), column, len(node))


def _nodes(nodes: Iterable[str]) -> str:
    return f"its nodes are {', '.join(nodes)}"


_CHECKS: dict[str, Callable[[Catalog, Leaf], Any]] = {
    "body": _declared("bodies", "body"),
    "coordinate": _declared("coordinates", "coordinate"),
    "speed": _declared("speeds", "speed"),
    "point": _point,
    "own point": _own_point,
    "seat": _seat,
    "axes": _axes,
    "member": _member,
    "output": _declared("outputs", "output"),
}


def _vector(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
    rule, value, space = leaf.rule, leaf.value, catalog.model.space
    if isinstance(value, str) and rule.own_point:
        yield from _own_point(catalog, leaf)
        return
    if isinstance(value, str):
        if value not in catalog.table("points"):
            what = f"unknown point of the ground '{value}' in {leaf.whereabouts}"
            fix = nearest(value, catalog.table("points")) or "give coordinates, or a point of [points]"
            yield Diagnostic(leaf.path, what, fix, 0, len(value))
        return
    needed = rule.length or {"plane": 2, "space": 3}.get(space)
    if needed is not None and len(value) != needed:
        what = f"{leaf.whereabouts}: {needed} components are needed, not {len(value)}"
        where = "" if rule.length else f"the model is in the {space}" if space == "plane" else "the model is in space"
        yield Diagnostic(leaf.path, what, where)
    elif rule.nonzero and all(c.literal == 0 for c in value):
        yield Diagnostic(leaf.path, f"{leaf.whereabouts}: a direction cannot be zero", "give a direction")
    elif rule.nonzero and rule.length == 3 and space == "plane" and [c.literal for c in value] != [0, 0, 1]:
        yield Diagnostic(leaf.path, "in the plane everything turns about z", f"leave out '{leaf.path[-1]}'")


def _axial(catalog: Catalog, leaf: Leaf) -> Iterator[Diagnostic]:
    count, space = len(leaf.value), catalog.model.space
    if space == "plane" and count != 1:
        what = f"{leaf.whereabouts}: one number about z is needed in the plane, not {count}"
        yield Diagnostic(leaf.path, what, "give the one about z")
    elif space == "space" and count not in leaf.rule.lengths:
        needed = " or ".join(map(str, leaf.rule.lengths))
        yield Diagnostic(leaf.path, f"{leaf.whereabouts}: {needed} numbers are needed in space, not {count}")


# -------- formulas --------------------------------------------------------------------------------------------
# Expressions: every name in them is known, may stand there, and has the unit that the field needs.


LONGEST_TRAIL = 10  # names of a ring that are shown


def formulas(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of unknown or misplaced names, of units that do not fit, of parameters that depend on themselves."""
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
                what = f"a part of {leaf.whereabouts} is called '{name}', like {article(catalog.symbols[name])}"
                yield Diagnostic(leaf.path, what, "give it another name")
        unit = leaf.part.unit if leaf.part is not None and leaf.path[-1] in leaf.part.in_unit else None
        if unit is not None and expression.names <= allowed and is_mixed(expression, unit):
            yield mixed(expression, unit, leaf.path)
    yield from _rings(catalog)


def _misplaced(catalog: Catalog, leaf: Leaf, name: str, column: int, allowed: frozenset[str]) -> Diagnostic:
    base = name.rstrip("'")
    kind = catalog.symbols.get(base)
    where = leaf.whereabouts
    if kind is None:
        other = meant_name(name, allowed)
        fix = (
            f"write {other}" if other else _in_degrees(name, leaf) or nearest(name, allowed) or _declare(catalog, name)
        )
        what = f"unknown name '{name}' in {where}"
    elif name != base and kind not in ("coordinate", "speed", "state"):
        what, fix = f"a prime on what does not move: {name} ('{base}' is {article(kind)})", f"write {base}"
    elif name != base and f"{name}" not in catalog.allowed[""]:
        what, fix = (
            f"'{name}' means nothing: '{base}' is {article(kind)}",
            "a coordinate has '' and ', a speed and a state '",
        )
    else:
        primes = {
            "coordinate": ("coordinate", "rate", "acceleration"),
            "speed": ("speed", "acceleration"),
            "state": ("state", "rate"),
        }
        kind = primes[kind][len(name) - len(base)] if kind in primes else kind
        what, fix = f"'{name}' ({article(kind)}) cannot stand in {where}", f"only {leaf.rule.scope} can stand here"
        if leaf.path[0] == "constraints" and leaf.path[-1] == "length" and base in catalog.table("coordinates"):
            fix += f'; a length that changes is a driven joint: kind = "prismatic", displacement = "{base}"'
    return Diagnostic(leaf.path, what, fix, column, len(name))


def _in_degrees(name: str, leaf: Leaf) -> str:
    return degrees(leaf.value.text, name) if isinstance(leaf.value, Expression) else ""


def _declare(catalog: Catalog, name: str) -> str:
    if name in catalog.table("outputs"):
        return "outputs do not refer to outputs: write its expression here"
    if name in catalog.table("bodies"):
        return "this is a body: ask for one of its quantities, like angle(...)"
    if name in FUNCTIONS:
        return f"a function has its arguments behind it: {name}({'' if not FUNCTIONS[name].kinds else '...'})"
    return f"declare '{name.rstrip(chr(39))}' in [parameters]"


def _rings(catalog: Catalog) -> Iterator[Diagnostic]:
    values = {name: part.value if part else None for name, part in catalog.table("parameters").items()}
    for ring in in_order(values)[1]:
        path: DocumentPath = ("parameters", ring[0], "value")
        shown = ring if len(ring) <= LONGEST_TRAIL else [*ring[:LONGEST_TRAIL], "..."]
        trail = " -> ".join([*shown, ring[0]])
        what = f"parameter '{ring[0]}' needs itself: {trail}" if len(ring) == 1 else f"parameters in a ring: {trail}"
        yield Diagnostic(path, what, "give one of them a number")
    rates = {f"{name}'": part.rate if part else None for name, part in catalog.table("states").items()}
    for ring in in_order(rates)[1]:
        what = f"rates of states in a ring: {' -> '.join([*ring[:LONGEST_TRAIL], ring[0]])}"
        what = f"the rate of state '{ring[0][:-1]}' needs itself" if len(ring) == 1 else what
        yield Diagnostic(("states", ring[0][:-1], "rate"), what, "write one of them without the rates of the others")
    yield from _rates_in_forces(catalog, rates)


def _rates_in_forces(catalog: Catalog, rates: Mapping[str, Any]) -> Iterator[Diagnostic]:
    """Diagnostics of a force with states of its own that acts by a rate which follows from one of such states."""
    late = {name for name, law in rates.items() if law is None}
    for name in in_order(rates)[0]:
        late |= {name} if rates[name] is not None and late & rates[name].names else set()
    for leaf, expression in catalog.expressions if late else ():
        force = catalog.table("forces").get(leaf.path[1]) if leaf.path[0] == "forces" else None
        if force is not None and force.own_states:
            for name in sorted(late & expression.names):
                what = f"'{leaf.path[1]}' has states of its own, and their rates cannot hold {name}"
                yield Diagnostic(leaf.path, what, f"write it by the state '{name[:-1]}' itself")


# -------- equations -------------------------------------------------------------------------------------------
# Equations: what is typed in them has a unit that fits, and no two meanings.


def equations(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of units that do not fit the other side; of numbers that may be meant in two units."""
    for leaf in catalog.leaves:
        if isinstance(leaf.value, WrittenEquation) and leaf.value.units is not None:
            try:
                typing_of(catalog.model, str(leaf.path[0])).equation(leaf.value)
            except ExpressionError as error:
                yield Diagnostic(leaf.path, error.what, error.fix, error.column, error.length)


# -------- speeds ----------------------------------------------------------------------------------------------
# Speeds and quaternions: what turns by a quaternion is free, and every speed has one meaning and one start.


def speeds(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of quaternions of coordinates not free or of two bodies; of speeds that are named twice."""
    yield from _quaternions(catalog)
    yield from _starts(catalog)


def _quaternions(catalog: Catalog) -> Iterator[Diagnostic]:
    taken: dict[str, str] = {}
    for body, part in catalog.table("bodies").items():
        joint = None if part is None else part.joint
        if joint is None or getattr(joint, "orientation", None) != "quaternion":
            continue
        path: DocumentPath = ("bodies", body, "joint")
        for key, names in (("quaternion", joint.quaternion or ()), ("omega", joint.omega or ())):
            for k, name in enumerate(names):
                if name in taken:
                    whose = f"body '{taken[name]}'" if taken[name] != body else "this body"
                    what = f"'{name}' stands twice: it turns {whose} already"
                    yield Diagnostic((*path, key, k), what, "each body needs names of its own")
                taken.setdefault(name, body)
        yield from _free(catalog, body, joint.quaternion or ())
        for k, name in enumerate(joint.omega or ()):
            speed = catalog.table("speeds").get(name)
            if speed is not None and speed.rate is not None:
                what = f"speed '{name}' has a 'rate' and is the angular velocity of body '{body}' too"
                start = "" if speed.rate.names else f"; a start is {name} = {{ start = {speed.rate.text} }}"
                yield Diagnostic((*path, "omega", k), what, f"leave out the 'rate': `omega` says what it is{start}")


def _free(catalog: Catalog, body: str, names: tuple[str, ...]) -> Iterator[Diagnostic]:
    for name in names:
        part = catalog.table("coordinates").get(name)
        if part is not None and (part.driven or part.dependent):
            how = "driven" if part.driven else "dependent"
            what = f"'{name}' is {how}, but it is part of the quaternion of body '{body}', whose four are free together"
            yield Diagnostic(("coordinates", name), what, "describe the orientation by angles", key=True)


def _starts(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of a start speed of a coordinate whose rate is combined in speeds that have a start of their own."""
    begun = set[str]().union(*begun_speeds(catalog.table("speeds")).values())
    for name, part in catalog.table("coordinates").items():
        if part is not None and part.speed is not None and f"{name}'" in begun and not part.driven:
            what = f"coordinate '{name}' has a 'speed' at the start, and the speeds of its rate have a 'start' too"
            yield Diagnostic(("coordinates", name, "speed"), what, "keep `start` of the speeds", key=True)
