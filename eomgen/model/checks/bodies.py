"""Bodies and joints: where mass comes from, what a joint needs, and that the bodies hang in a tree."""

from collections.abc import Iterator
from typing import Any

from eomgen.model.catalog import Catalog
from eomgen.model.composite import sources
from eomgen.model.findings import Finding
from eomgen.model.positions import DocumentPath

MEASURES = {1: "mass by length", 2: "mass by area", 3: "mass by volume"}


def bodies(catalog: Catalog) -> Iterator[Finding]:
    """Mass given in two ways or in none, an inertia that is missing, joints that lack something, rings of bodies."""
    for name, body in catalog.table("bodies").items():
        if body is not None:
            yield from _mass(catalog, name, body)
            if body.joint is not None:
                yield from _joint(catalog, name, body.joint)
    yield from _rings(catalog)


def _mass(catalog: Catalog, name: str, body: Any) -> Iterator[Finding]:
    path: DocumentPath = ("bodies", name)
    alone = "shape" if body.shape is not None else "parts" if body.parts is not None else ""
    others = {"shape": ("mass", "center", "inertia", "parts"), "parts": ("center", "inertia"), "": ()}[alone]
    for other in others:
        if getattr(body, other) is not None:
            what = f"body '{name}' has both '{alone}' and '{other}'"
            yield Finding((*path, other), what, f"'{alone}' gives the mass already: leave out '{other}'", key=True)
    if body.shape is not None and body.shape.mass is None and (*path, "shape", "mass") not in catalog.broken:
        what = f"the shape of body '{name}' has no 'mass'"
        yield Finding((*path, "shape"), what, "give 'mass' (0 for a massless body)")
    if body.parts is not None and (*path, "parts") not in catalog.broken and (*path, "mass") not in catalog.broken:
        yield from _sharing((*path, "parts"), name, body)
    if _needs_inertia(body) and (*path, "inertia") not in catalog.broken and _turns(catalog, name):
        what = f"body '{name}' can turn but has no 'inertia'"
        yield Finding(path, what, "give 'inertia' about the mass centre (0 for a point)", key=True)


def _sharing(path: DocumentPath, name: str, body: Any) -> Iterator[Finding]:
    """Parts without a mass of their own: in what they share the rest, and that equal densities can be meant."""
    sharing = [k for k, piece in enumerate(body.parts) if piece.shape.mass is None]
    for k in sharing:
        piece = body.parts[k]
        if piece.shape.dimension == 0:
            yield Finding((*path, k), f"a particle among the parts of body '{name}' has no 'mass'", "give its mass")
        elif body.mass is None and not piece.hole:
            what = f"part {k + 1} of body '{name}' has no 'mass', and neither has the body"
            yield Finding((*path, k), what, "give the net mass of the body, or a mass to each part")
        elif body.mass is None and len(of := sources(body.parts, k)) != 1:
            what = f"the mass of the hole, part {k + 1} of body '{name}', is not known: "
            what += f"it may be cut out of {len(of)} parts" if of else "no part is of its kind"
            yield Finding((*path, k), what, "give its mass (what it takes away), or the net mass of the body")
    kinds = {body.parts[k].shape.dimension: body.parts[k].shape.kind for k in sharing}
    if body.mass is not None and len(kinds) > 1 and 0 not in kinds:
        told = " and ".join(f"{kind} ({MEASURES[d]})" for d, kind in sorted(kinds.items()))
        what = f"the parts of body '{name}' have no common density: {told}"
        yield Finding(path, what, "give a mass to the parts of one kind: the others share the rest", key=True)


def _needs_inertia(body: Any) -> bool:
    """Whether it has a mass, is no shape and not composed, and says nothing of its inertia."""
    without = body.parts is None and body.shape is None and body.inertia is None
    return without and body.mass is not None and body.mass.literal != 0


def _turns(catalog: Catalog, name: str) -> bool:
    """Whether a body can turn against the ground: its joint or one below it turns with something."""
    seen: set[str] = set()
    constant = frozenset(["pi", *catalog.table("parameters"), *catalog.table("unknowns")])
    while name not in seen and catalog.table("bodies").get(name) is not None:
        seen.add(name)
        joint = catalog.table("bodies")[name].joint
        if joint is None:
            return False
        if any(e is not None and not e.names <= constant for e in joint.turns()):
            return True
        name = joint.parent or ""
    return False


def _joint(catalog: Catalog, name: str, joint: Any) -> Iterator[Finding]:
    path: DocumentPath = ("bodies", name, "joint")
    space = catalog.model.space
    if joint.on is not None and joint.at is not None:
        if "." in joint.on:
            what = f"the joint of body '{name}' sits at the point '{joint.on}' and has an 'at' too"
            yield Finding((*path, "at"), what, "leave out one of them", key=True)
        elif isinstance(joint.at, str):
            what = f"'{joint.at}' is a point of the ground, but the joint of body '{name}' hangs on '{joint.on}'"
            yield Finding((*path, "at"), what, f'write on = "{joint.on}.point", or give coordinates in its axes')
    if space == "plane" and joint.only_space:
        yield Finding(
            (*path, "kind"),
            f"a {joint.kind} joint needs space, but the model is in the plane",
            'use "revolute", "prismatic" or "free"',
        )
    else:
        yield from joint.findings(path, catalog)


def _rings(catalog: Catalog) -> Iterator[Finding]:
    """A body that hangs on itself, at once or by way of others (each ring told once, at its first body)."""
    table = catalog.table("bodies")
    parents = {n: body.joint.parent for n, body in table.items() if body is not None and body.joint is not None}
    done: set[str] = set()
    for first in parents:
        trail: list[str] = []
        name: str | None = first
        while name is not None and name in parents and name not in done and name not in trail:
            trail.append(name)
            name = parents[name]
        if name in trail:
            ring = trail[trail.index(name) :]
            told = " -> ".join([*ring, ring[0]])
            what = f"body '{name}' hangs on itself"
            what = what if len(ring) == 1 else f"bodies hang on one another in a ring: {told}"
            yield Finding(("bodies", ring[0], "joint", "on"), what, "one of them must hang on the ground")
        done.update(trail)
