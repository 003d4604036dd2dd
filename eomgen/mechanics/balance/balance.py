"""System -> Balance: every body's own equations, its reactions and its inertia force and couple included.

    sum of reactions + sum of applied forces = inertia:   f = m a_C,   n = d/dt (I w) about the mass centre

In the plane two forces and one moment a body, in ground axes; in space three and three, in the body's axes. The
unknowns are the components of all reactions, of joints and of ties; what drives a given motion is one of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.components import Component, components_of
from eomgen.mechanics.balance.placements import placements_of
from eomgen.mechanics.balance.unit_wrenches import Axes, effects_of_load, joint_effects
from eomgen.mechanics.bodies.inertia import kinetic_energy
from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.bodies.loads import weights
from eomgen.mechanics.constraints.ties import holds_identically, slide_power
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import generalized_forces
from eomgen.model.driven import driven_coordinates, driving_ties
from eomgen.model.forces.load import PointForce
from eomgen.model.unknowns import in_loads
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, derivative, gradient
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import Vector, apply, cross, in_turned_axes, plus, times, vector_of

DIRECTIONS = ("x", "y", "z", "moment x", "moment y", "moment z")


@dataclass(frozen=True)
class BodyEquation:
    """One scalar equation of one body: sum of coefficients * reactions + applied = inertia.

    Args:
        body: its name.
        direction: index in DIRECTIONS.
        coefficients: {index of the component: coefficient}.
        applied: of everything given, weight included.
        inertia: m a, or the rate of the angular momentum about the mass centre.
    """

    body: str
    direction: int
    coefficients: dict[int, Scalar]
    applied: Scalar
    inertia: Scalar

    @property
    def needed(self) -> Scalar:
        """What the reactions have to make up."""
        return self.inertia - self.applied


@dataclass(frozen=True)
class Balance:
    """All equations of all bodies.

    Args:
        sizes: |N| of the bilateral contacts with friction, by their names.
    """

    system: System
    components: tuple[Component, ...]
    equations: tuple[BodyEquation, ...]
    sizes: Mapping[str, Scalar] = field(default_factory=dict)

    @cached_property
    def given(self) -> dict[int, Scalar]:
        """The components that do not follow from the equations: friction by |N| = sqrt(N_1^2 + N_2^2)."""
        return {
            j: c.bilateral_friction * self.sizes[c.owner]
            for j, c in enumerate(self.components)
            if c.bilateral_friction is not None
        }

    @cached_property
    def unknowns(self) -> tuple[Node, ...]:
        """The unknowns that stand in the loads: the bodies at rest determine them together with the reactions."""
        symbols = self.system.symbols.unknowns
        return tuple(symbols[name] for name in in_loads(self.system.scope.model))

    @property
    def names(self) -> tuple[str, ...]:
        """Of all that the equations are solved for: reaction_x(B), then the unknowns."""
        return (*(c.name for c in self.components), *(unknown.name for unknown in self.unknowns))


def balance_of(system: System, sizes: Mapping[str, Scalar] | None = None) -> Balance:
    """The equations of every body; those that say 0 = 0 are left out.

    Args:
        sizes: |N| of the bilateral contacts with friction.
    Raises:
        DerivationError: a force, an energy or a tie that acts at no place, named.
    """
    if sizes:
        return _balance(system, sizes)
    if balance_of not in system.found:
        system.found[balance_of] = _balance(system, {})
    found: Balance = system.found[balance_of]
    return found


def _balance(system: System, sizes: Mapping[str, Scalar]) -> Balance:
    refuse_placeless(system)
    axes = Axes(system.motion)
    components = components_of(system, axes)
    components += placements_of(system, axes, components)
    inertia, applied, on_bodies = _inertia(axes), _applied(system, axes), _coefficients(components)
    equations = []
    for i, link in enumerate(system.motion.links):
        for d in axes.rows:
            row = {j: six[d] for j, six in on_bodies.get(i, {}).items() if not is_zero(six[d])}
            if row or not (is_zero(applied[i][d]) and is_zero(inertia[i][d])):
                equations.append(BodyEquation(link.name, d, row, applied[i][d], inertia[i][d]))
    return Balance(system, components, tuple(equations), sizes)


def refuse_placeless(system: System) -> None:
    """Refuse what acts at no place, or on a point that a coordinate moves in its body: some balance would lack it.

    Raises:
        DerivationError: it is named.
    """
    _refuse_placeless_forces(system)
    _refuse_placeless_ties(system)
    for link in system.motion.links:
        if _seat_moves_others(system, link):
            raise _moved_inside(f"the joint of body '{link.name}'", f"bodies.{link.name}.joint")


def _refuse_placeless_forces(system: System) -> None:
    for force in system.loads.applied:
        if force.placeless or any(not hasattr(load, "place") and hasattr(load, "coordinate") for load in force.loads):
            what = f"the force '{force.name}' acts on coordinates and at no place: reactions do not follow"
            raise DerivationError(what, f"forces.{force.name}", "give it as forces and couples on bodies")
        pushes = [load for load in force.loads if isinstance(load, PointForce)]
        if any(_pushes_along(system, slide_power(system.motion, push)) for push in pushes):
            raise _moved_inside(f"the force '{force.name}'", f"forces.{force.name}")


def _refuse_placeless_ties(system: System) -> None:
    drives = {tie for ties in driving_ties(system.scope.model).values() for tie in ties}  # whose place is a joint
    idle = _idle_rows(system)
    for row in (row for row in system.ties.rows if row.tie not in drives and row.label not in idle):
        points = (push for push in row.pushes if isinstance(push, PointForce))
        slide = sum((slide_power(system.motion, push) for push in points), start=0)
        seen_alike = row.carrier is None and not is_zero(row.direct)
        own = row.direct - slide if seen_alike else 0  # a row of material points sees no slide
        if row.status != "identical" and (not row.pushes or _pushes_along(system, own)):
            raise DerivationError(
                f"the tie '{row.tie}' acts on coordinates and at no place: reactions do not follow",
                f"constraints.{row.tie}",
                "give it as a tie between bodies",
            )
        if row.pushes and _pushes_along(system, row.direct):
            raise _moved_inside(f"the tie '{row.tie}'", f"constraints.{row.tie}")


def _idle_rows(system: System) -> set[str]:
    """The labels of rows without bodies that push nothing: z' = r - x, where z moves no body and nothing pushes it.

    Along such a coordinate the row alone acts: lam = 0.
    """
    if all(row.pushes for row in system.ties.rows):
        return set()
    free = system.free or system
    Q = generalized_forces(free.loads)
    moved = [any(not is_zero(B[i][k]) for B in free.motion.B for i in range(6)) for k in range(len(Q))]
    alone = [k for k, force in enumerate(Q) if is_zero(force) and not moved[k]]
    left = {row.label: line for row, line in zip(free.ties.closing, free.ties.J, strict=True)}
    found = balances_of_nodes(free)
    left = {label: line for label, line in left.items() if label not in found}
    while more := {
        label
        for label, line in left.items()
        if any(
            not is_zero(line[k]) and all(is_zero(other[k]) for name, other in left.items() if name != label)
            for k in alone
        )
    }:
        found |= more
        left = {label: line for label, line in left.items() if label not in more}
    return found


def balances_of_nodes(free: System) -> set[str]:
    """The labels of rows that say 0 = Q_k of coordinates that move no mass: nothing else acts along these, lam = 0."""
    T, Q, ties = kinetic_energy(free.motion), generalized_forces(free.loads), free.ties
    idle = [k for k, u in enumerate(free.symbols.u) if is_zero(derivative(T, u)) and not is_zero(Q[k])]
    rows: dict[int, str] = {}
    for row, line, sigma in zip(ties.closing, ties.J, ties.sigma, strict=True) if idle else ():
        rate = sum((x * u for x, u in zip(line, free.symbols.u, strict=True)), start=sigma)
        law = rate if row.gap is None else row.gap
        rows |= {k: row.label for k in idle if not row.pushes and k not in rows and holds_identically(law - Q[k])}
    others = [line for row, line in zip(ties.closing, ties.J, strict=True) if row.label not in rows.values()]
    touched = {k for k in rows if any(not is_zero(line[k]) for line in others)}
    return set() if touched else set(rows.values())


def _pushes_along(system: System, power: Scalar) -> bool:
    """Whether a force does work on a coordinate by the slide of its point alone."""
    return any(not holds_identically(x) for x in gradient(power, system.symbols.u))


def _seat_moves_others(system: System, link: BodyLink) -> bool:
    """Whether a free coordinate moves the seat of a joint and something else: what joins the two acts at no place."""
    given = driven_coordinates(system.scope.model)
    free = [q for q in system.symbols.q if q.name not in given]
    seat = (*link.before.p, *link.point)
    for q in free:
        if any(depends_on(x, (q,)) for x in seat):
            others = [x for other in system.motion.links for x in other.s]
            others += [x for other in system.motion.links if other is not link for x in (*other.before.p, *other.point)]
            if any(depends_on(x, (q,)) for x in others):
                return True
    return False


def _moved_inside(what: str, where: str) -> DerivationError:
    return DerivationError(
        f"{what} acts on a point that a coordinate moves in its body, and no body moves it there",
        where,
        "make the point one of a body of its own",
    )


def _coefficients(components: Sequence[Component]) -> dict[int, dict[int, tuple[Scalar, ...]]]:
    """{body: {component: its force and moment there}}, friction included."""
    found: dict[int, dict[int, tuple[Scalar, ...]]] = {}
    for j, component in enumerate(components):
        for effect in (*component.effects, *component.friction_effects):
            on_body = found.setdefault(effect.link, {})
            on_body[j] = tuple(a + b for a, b in zip(on_body.get(j, (0,) * 6), effect.six, strict=True))
    return found


# -- inertia and what is applied -------------------------------------------------------------------


def _inertia(axes: Axes) -> list[tuple[Scalar, ...]]:
    """(m a_C, d/dt (I w)) of every body, accelerations included."""
    accelerations = _center_accelerations(axes)
    scope = axes.motion.scope
    spins = scope.with_accelerations(tuple(x for link in axes.motion.links for x in link.twist.w))
    rows: list[tuple[Scalar, ...]] = []
    for i, (link, mass) in enumerate(zip(axes.motion.links, axes.masses, strict=True)):
        wd, w = vector_of(spins[3 * i : 3 * i + 3]), link.twist.w
        n = plus(apply(mass.I, wd), cross(w, apply(mass.I, w)))
        rows.append((*times(mass.m, accelerations[i]), *in_turned_axes(axes.of_body(link), n)))
    return rows


def _center_accelerations(axes: Axes) -> list[Vector]:
    """Of every mass centre: in the plane from its place, in space from the body's twist."""
    links, scope = axes.motion.links, axes.motion.scope
    if axes.plane:
        places = tuple(x for link, m in zip(links, axes.masses, strict=True) for x in link.pose.point(m.com))
        found = scope.with_accelerations(scope.time_derivative(places))
        return [vector_of(found[3 * i : 3 * i + 3]) for i in range(len(links))]
    velocities = [plus(link.twist.v, cross(link.twist.w, m.com)) for link, m in zip(links, axes.masses, strict=True)]
    moved = [scope.time_derivative(m.com) for m in axes.masses]
    velocities = [plus(v, vector_of(d)) for v, d in zip(velocities, moved, strict=True)]
    rates = scope.with_accelerations(tuple(x for v in velocities for x in v))
    return [
        plus(vector_of(rates[3 * i : 3 * i + 3]), cross(link.twist.w, v))
        for i, (link, v) in enumerate(zip(links, velocities, strict=True))
    ]


def _applied(system: System, axes: Axes) -> list[tuple[Scalar, ...]]:
    """(force, moment about the mass centre) of everything given, on every body."""
    totals: list[tuple[Scalar, ...]] = [(0,) * 6 for _ in axes.motion.links]
    effects = [e for load in (*system.loads.placed, *weights(system.loads)) for e in effects_of_load(axes, load)]
    for effect in (*effects, *joint_effects(system)):
        totals[effect.link] = tuple(a + b for a, b in zip(totals[effect.link], effect.six, strict=True))
    return totals
