"""References: every body, point, coordinate that is named was declared; every vector has its length."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from eomgen.model.catalog import Catalog
from eomgen.model.fields import AxialRule, Leaf, NameRule, VectorRule
from eomgen.model.findings import Finding, nearest, whereabouts


def references(catalog: Catalog) -> Iterator[Finding]:
    """Names of parts that were never declared; vectors and inertias of the wrong length."""
    for leaf in catalog.leaves:
        if isinstance(leaf.rule, NameRule):
            yield from _CHECKS[leaf.rule.of](catalog, leaf)
        elif isinstance(leaf.rule, VectorRule):
            yield from _vector(catalog, leaf)
        elif isinstance(leaf.rule, AxialRule):
            yield from _axial(catalog, leaf)
    yield from _idle_nodes(catalog)


def missing_point(catalog: Catalog, point: str) -> tuple[str, str, int, int] | None:
    """What is wrong with a point's name: message, mend, column and length of the culprit; None when it is declared."""
    owner, dot, name = point.partition(".")
    if not dot:
        if point in catalog.table("points"):
            return None
        if point in catalog.table("bodies"):
            offered = ", ".join(f"'{point}.{p}'" for p in catalog.body_points(point))
            return f"'{point}' is a body, not a point", f"one of its points: {offered}", 0, len(point)
        of_bodies = [p for p in catalog.point_names() if p.endswith("." + point)]
        mend = f"did you mean '{of_bodies[0]}'?" if of_bodies else nearest(point, catalog.point_names())
        declared = f"declare it in [points]: {point} = [...]" if point.isidentifier() else "declare it in [points]"
        return f"unknown point of the ground: '{point}'", mend or declared, 0, len(point)
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
    mend = nearest(point, known) or f"it has {listed}"
    return f"body '{body}' has no point '{point}'", mend, column, len(point)


def _point(catalog: Catalog, leaf: Leaf) -> Iterator[Finding]:
    yield from _told(leaf, missing_point(catalog, leaf.value))


def _told(leaf: Leaf, wrong: tuple[str, str, int, int] | None) -> Iterator[Finding]:
    if wrong is not None:
        what, mend, column, length = wrong
        yield Finding(leaf.path, f"{what} (in {whereabouts(leaf.path)})", mend, column, length)


def _own_point(catalog: Catalog, leaf: Leaf) -> Iterator[Finding]:
    body = leaf.path[1] if leaf.path[0] == "bodies" else leaf.part.body
    if not isinstance(body, str) or body not in catalog.table("bodies"):
        return
    owner, dot, name = leaf.value.partition(".")
    if dot and owner != body:
        what = f"'{leaf.value}' is not a point of body '{body}'"
        yield Finding(leaf.path, what, f"only a point of '{body}' can stand here", 0, len(owner))
    else:
        name = name if dot else owner
        yield from _told(leaf, _missing_own(catalog, body, name, len(owner) + 1 if dot else 0))


def _seat(catalog: Catalog, leaf: Leaf) -> Iterator[Finding]:
    owner, dot, name = leaf.value.partition(".")
    body = leaf.path[1]
    if owner not in catalog.table("bodies"):
        what = f"joint of body '{body}' hangs on a body that was never declared: '{owner}'"
        mend = nearest(owner, [b for b in catalog.table("bodies") if b != body])
        if owner == "ground" or owner in catalog.table("points"):
            mend = "leave out 'on' for the ground" + ("" if owner == "ground" else f', and write at = "{owner}"')
        yield Finding(leaf.path, what, mend, 0, len(owner))
    elif dot:
        yield from _told(leaf, _missing_own(catalog, owner, name, len(owner) + 1))


def _idle_nodes(catalog: Catalog) -> Iterator[Finding]:
    """Nodes that no member joins to a truss."""
    for name, truss in catalog.table("trusses").items():
        if truss is None or truss.members is None:
            continue
        joined = {node for member in truss.members for node in member.split("-")}
        for node in truss.nodes or {}:
            if node not in joined:
                what = f"node '{node}' of truss '{name}' has no member"
                yield Finding(("trusses", name, "nodes", node), what, "join it by a member, or leave it out", key=True)


def _declared(table: str, what: str) -> Callable[[Catalog, Leaf], Iterator[Finding]]:
    def check(catalog: Catalog, leaf: Leaf) -> Iterator[Finding]:
        known = catalog.table(table)
        if leaf.value not in known:
            told = f"unknown {what} '{leaf.value}' in {whereabouts(leaf.path)}"
            yield Finding(leaf.path, told, nearest(leaf.value, known), 0, len(leaf.value))

    return check


def _axes(catalog: Catalog, leaf: Leaf) -> Iterator[Finding]:
    if leaf.value != "ground":
        yield from _declared("bodies", "axes: no body")(catalog, leaf)


def _member(catalog: Catalog, leaf: Leaf) -> Iterator[Finding]:
    truss = catalog.table("trusses")[leaf.path[1]]
    ends = leaf.value.split("-")
    if len(ends) != 2 or ends[0] == ends[1]:
        yield Finding(leaf.path, f"'{leaf.value}' is no member", 'a member joins two nodes: "n1-n2"')
        return
    before = [set(member.split("-")) for member in (truss.members or ())[: int(leaf.path[-1])]]
    if set(ends) in before:
        yield Finding(leaf.path, f"member '{leaf.value}' of truss '{leaf.path[1]}' stands there twice", "leave one out")
    for k, node in enumerate(ends):
        if truss.nodes is not None and node not in truss.nodes:
            column = 0 if k == 0 else len(ends[0]) + 1
            what = f"truss '{leaf.path[1]}' has no node '{node}'"
            yield Finding(leaf.path, what, nearest(node, truss.nodes) or _nodes(truss.nodes), column, len(node))


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
}


def _vector(catalog: Catalog, leaf: Leaf) -> Iterator[Finding]:
    rule, value, space = leaf.rule, leaf.value, catalog.model.space
    if isinstance(value, str) and rule.own_point:
        yield from _own_point(catalog, leaf)
        return
    if isinstance(value, str):
        if value not in catalog.table("points"):
            what = f"unknown point of the ground '{value}' in {whereabouts(leaf.path)}"
            mend = nearest(value, catalog.table("points")) or "give coordinates, or a point of [points]"
            yield Finding(leaf.path, what, mend, 0, len(value))
        return
    needed = rule.length or {"plane": 2, "space": 3}.get(space)
    if needed is not None and len(value) != needed:
        what = f"{whereabouts(leaf.path)}: {needed} components are needed, not {len(value)}"
        where = "" if rule.length else f"the model is in the {space}" if space == "plane" else "the model is in space"
        yield Finding(leaf.path, what, where)
    elif rule.nonzero and all(c.literal == 0 for c in value):
        yield Finding(leaf.path, f"{whereabouts(leaf.path)}: a direction cannot be zero", "give a direction")
    elif rule.nonzero and rule.length == 3 and space == "plane" and [c.literal for c in value] != [0, 0, 1]:
        yield Finding(leaf.path, "in the plane everything turns about z", f"leave out '{leaf.path[-1]}'")


def _axial(catalog: Catalog, leaf: Leaf) -> Iterator[Finding]:
    count, space = len(leaf.value), catalog.model.space
    if space == "plane" and count != 1:
        what = f"{whereabouts(leaf.path)}: one number about z is needed in the plane, not {count}"
        yield Finding(leaf.path, what, "give the one about z")
    elif space == "space" and count not in leaf.rule.lengths:
        needed = " or ".join(map(str, leaf.rule.lengths))
        yield Finding(leaf.path, f"{whereabouts(leaf.path)}: {needed} numbers are needed in space, not {count}")
