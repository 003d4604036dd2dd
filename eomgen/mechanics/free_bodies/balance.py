"""System -> Balance: every body's own equations, its reactions and its inertia force and couple."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure, holds_identically
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies.wrenches import Axes, Component, Effect, placements_of, seen_by_carriers
from eomgen.mechanics.kinematics import GROUND, BodyLink, SystemInertia
from eomgen.model import PointForce
from eomgen.symbolic.exact import Solution, readable_all
from eomgen.symbolic.expression import (
    Matrix,
    Node,
    Scalar,
    SparseRow,
    Vector,
    depends_on,
    derivative,
    gradient,
    inner,
    is_zero,
    operations,
    substituted,
)
from eomgen.symbolic.numeric import NoValue, Work, evaluate, fifty_digits, tolerances

# -------- balance ---------------------------------------------------------------------------------------------
# System -> Balance: every body's own equations, its reactions and its inertia force and couple included.
#
#     sum of reactions + sum of applied forces = inertia:   f = m a_C,   n = d/dt (I w) about the mass centre
#
# In the plane two forces and one moment a body, in ground axes; in space three and three, in the body's axes. The
# unknowns are the components of all reactions, of joints and of constraints; what drives a given motion is one of them.


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
        """Sum that the reactions must give: inertia less applied load."""
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
        """Unknowns in the loads; the equilibrium of the bodies determines them together with the reactions."""
        symbols = self.system.symbols.unknowns
        return tuple(symbols[name] for name in self.system.scope.model.unknowns_in_loads())

    @property
    def symbols(self) -> tuple[Node, ...]:
        """Symbols of the unknowns of the equations: one for each component, by its name, then those of the loads."""
        return (*(self.system.scope.graph.symbol(c.name) for c in self.components), *self.unknowns)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the unknowns of the equations: reaction_x(B), then the unknowns of the loads."""
        return (*(c.name for c in self.components), *(unknown.name for unknown in self.unknowns))

    @staticmethod
    def of(system: System, sizes: Mapping[str, Scalar] | None = None) -> Balance:
        """The equations of every body; those that say 0 = 0 are left out.

        Args:
            sizes: |N| of the bilateral contacts with friction.
        Raises:
            DerivationError: a force, an energy or a constraint that acts at no place, named.
        """
        if sizes:
            return _balance(system, sizes)
        if Balance.of not in system.found:
            system.found[Balance.of] = _balance(system, {})
        found: Balance = system.found[Balance.of]
        return found

    @staticmethod
    def refuse_placeless(system: System) -> None:
        """Refuse loads at no place, or on a point that a coordinate moves in its body: a balance would lack them.

        Raises:
            DerivationError: it is named.
        """
        _refuse_placeless_forces(system)
        _refuse_placeless_constraints(system)
        for link in system.motion.links:
            if _seat_moves_others(system, link):
                raise _moved_inside(f"the joint of body '{link.name}'", f"bodies.{link.name}.joint")


def _balance(system: System, sizes: Mapping[str, Scalar]) -> Balance:
    Balance.refuse_placeless(system)
    axes = Axes(system.motion)
    components = axes.components_of(system)
    components += placements_of(system, axes, components)
    inertia, applied, on_bodies = _inertia(axes), _applied(system, axes), _coefficients(components)
    equations = []
    for i, link in enumerate(system.motion.links):
        for d in axes.rows:
            row = {j: six[d] for j, six in on_bodies.get(i, {}).items() if not is_zero(six[d])}
            if row or not (is_zero(applied[i][d]) and is_zero(inertia[i][d])):
                equations.append(BodyEquation(link.name, d, row, applied[i][d], inertia[i][d]))
    return Balance(system, components, tuple(equations), sizes)


def _refuse_placeless_forces(system: System) -> None:
    for force in system.loads.applied:
        if force.placeless or force.is_along_coordinate:
            what = f"the force '{force.name}' acts on coordinates and at no place: reactions do not follow"
            raise DerivationError(what, f"forces.{force.name}", "give it as forces and couples on bodies")
        pushes = [load for load in force.loads if isinstance(load, PointForce)]
        if any(_pushes_along(system, system.motion.slide_power(push)) for push in pushes):
            raise _moved_inside(f"the force '{force.name}'", f"forces.{force.name}")
    for name, place, *_ in SystemInertia(system.motion).fluids:
        if any(_pushes_along(system, x) for x in system.motion.slide(place)):
            raise _moved_inside(f"the force '{name}'", f"forces.{name}")


def _refuse_placeless_constraints(system: System) -> None:
    drives = {
        constraint for constraints in system.scope.model.driving_constraints.values() for constraint in constraints
    }  # whose place is a joint
    idle = _idle_rows(system)
    for row in (row for row in system.constraints.rows if row.constraint not in drives and row.label not in idle):
        points = (push for push in row.pushes if isinstance(push, PointForce))
        slide = sum((system.motion.slide_power(push) for push in points), start=0)
        seen_alike = row.carrier is None and not is_zero(row.direct)
        own = row.direct - slide if seen_alike else 0  # a row of material points sees no slide
        if row.status != "identical" and (not row.pushes or _pushes_along(system, own)):
            raise DerivationError(
                f"the constraint '{row.constraint}' acts on coordinates and at no place: reactions do not follow",
                f"constraints.{row.constraint}",
                "give it as a constraint between bodies",
            )
        if row.pushes and _pushes_along(system, row.direct):
            raise _moved_inside(f"the constraint '{row.constraint}'", f"constraints.{row.constraint}")


def _idle_rows(system: System) -> set[str]:
    """Labels of rows without bodies and forces: z' = r - x, where z moves no body and no force acts along it.

    Along such a coordinate the row alone acts: lam = 0.
    """
    if all(row.pushes for row in system.constraints.rows):
        return set()
    free = system.free or system
    Q = free.loads.generalized_forces
    moved = [any(not is_zero(B[i][k]) for B in free.motion.B for i in range(6)) for k in range(len(Q))]
    alone = [k for k, force in enumerate(Q) if is_zero(force) and not moved[k]]
    left = {row.label: line for row, line in zip(free.constraints.closing, free.constraints.J, strict=True)}
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
    T, Q, constraints = SystemInertia(free.motion).kinetic_energy, free.loads.generalized_forces, free.constraints
    idle = [k for k, u in enumerate(free.symbols.u) if is_zero(derivative(T, u)) and not is_zero(Q[k])]
    rows: dict[int, str] = {}
    for row, line, sigma in zip(constraints.closing, constraints.J, constraints.sigma, strict=True) if idle else ():
        rate = sum((x * u for x, u in zip(line, free.symbols.u, strict=True)), start=sigma)
        law = rate if row.gap is None else row.gap
        rows |= {k: row.label for k in idle if not row.pushes and k not in rows and holds_identically(law - Q[k])}
    others = [
        line for row, line in zip(constraints.closing, constraints.J, strict=True) if row.label not in rows.values()
    ]
    touched = {k for k in rows if any(not is_zero(line[k]) for line in others)}
    return set() if touched else set(rows.values())


def _pushes_along(system: System, power: Scalar) -> bool:
    """True if a force does work on a coordinate by the motion of its point relative to the body."""
    return any(not holds_identically(x) for x in gradient(power, system.symbols.u))


def _seat_moves_others(system: System, link: BodyLink) -> bool:
    """True if a free coordinate moves the seat of a joint and something else, so that their coupling has no place."""
    given = system.scope.model.driven_coordinates
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
        wd, w = Vector(spins[3 * i : 3 * i + 3]), link.twist.w
        n = mass.I @ wd + w.cross(mass.I @ w)
        rows.append((*(mass.m * accelerations[i]), *(axes.of_body(link) @ n)))
    return rows


def _center_accelerations(axes: Axes) -> list[Vector]:
    """Acceleration of every mass centre: in the plane from its position, in space from the body's twist."""
    links, scope = axes.motion.links, axes.motion.scope
    if axes.plane:
        places = tuple(x for link, m in zip(links, axes.masses, strict=True) for x in link.pose.point(m.com))
        found = scope.with_accelerations(scope.time_derivative(places))
        return [Vector(found[3 * i : 3 * i + 3]) for i in range(len(links))]
    velocities = [link.twist.v + link.twist.w.cross(m.com) for link, m in zip(links, axes.masses, strict=True)]
    moved = [scope.time_derivative(m.com) for m in axes.masses]
    velocities = [v + Vector(d) for v, d in zip(velocities, moved, strict=True)]
    rates = scope.with_accelerations(tuple(x for v in velocities for x in v))
    return [
        Vector(rates[3 * i : 3 * i + 3]) + link.twist.w.cross(v)
        for i, (link, v) in enumerate(zip(links, velocities, strict=True))
    ]


def _applied(system: System, axes: Axes) -> list[tuple[Scalar, ...]]:
    """(force, moment about the mass centre) of everything given, on every body."""
    totals: list[tuple[Scalar, ...]] = [(0,) * 6 for _ in axes.motion.links]
    effects = [e for load in (*system.loads.placed, *system.loads.weights) for e in axes.effects_of(load)]
    for effect in (*effects, *Effect.of_joints(system), *Effect.of_fluids(system).values()):
        totals[effect.link] = tuple(a + b for a, b in zip(totals[effect.link], effect.six, strict=True))
    return totals


# -------- unknown loads ---------------------------------------------------------------------------------------
# Balance -> the same equations with the unknowns of the loads on the side of the reactions.
#
#     sum of coefficients * reactions + sum of d(applied)/dP * P = inertia - applied at P = 0
#
# The bodies are at rest: rates and accelerations are 0.


def with_unknowns(balance: Balance) -> tuple[list[dict[int, Scalar]], list[Scalar]]:
    """(coefficients, what they have to make up) of every equation; unknowns are counted after the components.

    Raises:
        DerivationError: an unknown does not stand linearly in the loads.
    """
    rows, needed = [], []
    zero = dict.fromkeys(balance.unknowns, 0)
    for equation in balance.equations:
        own = {len(balance.components) + k: slope(balance, equation, p) for k, p in enumerate(balance.unknowns)}
        rows.append({**equation.coefficients, **{j: x for j, x in own.items() if not is_zero(x)}})
        needed.append(substituted((equation.needed,), zero)[0] if zero else equation.needed)
    return rows, needed


def slope(balance: Balance, equation: BodyEquation, unknown: Node) -> Scalar:
    """d(applied)/dP

    Raises:
        DerivationError: an unknown stands in it: the loads are not linear.
    """
    found = derivative(equation.applied, unknown)
    if depends_on(found, balance.unknowns):
        names = ", ".join(f"'{p.name}'" for p in balance.unknowns if depends_on(found, (p,)))
        what = f"the loads on '{equation.body}' are not linear in the unknown {names}"
        raise DerivationError(what, f"unknowns.{unknown.name}", "let an unknown be one force, couple or intensity")
    return found


def refuse_friction(balance: Balance) -> None:
    """Refuses friction at rest: it may have any value up to its limit, so that the balance determines no force.

    Raises:
        DerivationError: the contact is named.
    """
    for component in balance.components:
        if component.frictional:
            what = f"'{component.owner}' has friction: at rest its force, and so the unknowns, may lie in a range"
            raise DerivationError(what, f"constraints.{component.owner}.friction", "leave the friction out")


def is_balanced(balance: Balance, solution: Solution) -> bool:
    """True if the residuals that no unknown or reaction can change vanish wherever the constraints are satisfied."""
    left = solution.left
    if all(holds_identically(x) for x in left):
        return True
    if not balance.system.symbols.q:
        return False
    state = Closure(balance.system.constraints).generic()
    try:
        sizes = [abs(x) for x in evaluate(left, state, fifty_digits())]
    except NoValue:
        return False
    return bool(max(sizes) < tolerances.ELIMINATED_AT_50)


def unbalanced(balance: Balance, solution: Solution) -> DerivationError:
    """Error: no equilibrium, as there are more degrees of freedom than the unknowns can hold."""
    names = ", ".join(f"'{p.name}'" for p in balance.unknowns)
    degrees_of_freedom = len(balance.system.symbols.u) - len(balance.system.constraints.closing)
    how_many = (
        f"; there are {degrees_of_freedom} degrees of freedom for {len(balance.unknowns)}"
        if degrees_of_freedom > 0
        else ""
    )
    return DerivationError(
        f"the bodies are not in balance at rest, whatever {names} may be{how_many}",
        "unknowns",
        "hold every degree of freedom by a constraint or by an unknown in a load, or start in equilibrium",
    )


# -------- ground balance --------------------------------------------------------------------------------------
# Balance -> the force equations of bodies that no joint holds, along the ground's axes.
#
# The axes of a body spin with it. Where constraints alone push it, along directions that do not, its force equations
# are short in the ground's axes, R (sum of forces) = R m a, and their solutions divide by nothing that vanishes as the
# body turns.


def along_ground(balance: Balance, rows: list[SparseRow], needed: list[Scalar]) -> tuple[list[SparseRow], list[Scalar]]:
    """(coefficients, what they have to make up), force equations turned where that makes them shorter."""
    rows, needed = list(rows), list(needed)
    if balance.system.scope.model.space == "plane" or any(c.frictional for c in balance.components):
        return rows, needed
    for i, link in enumerate(balance.system.motion.links):
        if not _held_by_constraints_alone(balance, i):
            continue
        three = [n for n, e in enumerate(balance.equations) if e.body == link.name and e.direction < 3]
        if len(three) == 3:
            _turn(link, three, rows, needed)
    return rows, needed


def _held_by_constraints_alone(balance: Balance, i: int) -> bool:
    kinds = {c.kind for c in balance.components if any(effect.link == i for effect in c.effects)}
    return kinds == {"constraint"}


def _turn(link: BodyLink, three: Sequence[int], rows: list[SparseRow], needed: list[Scalar]) -> None:
    """The three equations multiplied by R, if the coefficients then take fewer operations."""
    own = sorted({j for n in three for j in rows[n]})
    columns = {j: [rows[n].get(j, 0) for n in three] for j in own}
    turned = [
        dict(zip(own, readable_all(tuple(inner(r, c) for c in columns.values()), Work.VALUE), strict=True))
        for r in link.pose.R
    ]
    if _work(x for row in turned for x in row.values()) >= _work(x for c in columns.values() for x in c):
        return
    right = readable_all(tuple(inner(r, [needed[n] for n in three]) for r in link.pose.R), Work.VALUE)
    for n, row, value in zip(three, turned, right, strict=True):
        rows[n], needed[n] = {j: x for j, x in row.items() if not is_zero(x)}, value


def _work(scalars: Iterable[Scalar]) -> int:
    return operations(tuple(scalars)).total


# -------- carried balance -------------------------------------------------------------------------------------
# Balance -> the equations of each body together with all that it carries, about the point of its joint.
#
#     F_i = f_i + sum of R_j F_j,    N_i = n_i - arm x f_i + sum of (R_j N_j + p_j x R_j F_j)      j: the bodies on i
#
# Forces between carried bodies are absent in these: a joint's own reaction is there alone, along axes that do not turn
# against it, except for constraints with other bodies. So elimination finds numbers where the equations of single
# bodies have sines and cosines, which vanish at some state.


NOTHING: tuple[Scalar, ...] = (0,) * 6
RIGHT = -1  # among the numbers of components: the right side
Turned = list[tuple[tuple[int, ...], Matrix]]  # the components of a hinge, and the axes that they were seen in


def with_what_is_carried(
    balance: Balance, rows: Sequence[SparseRow], needed: Sequence[Scalar]
) -> tuple[list[SparseRow], list[Scalar]]:
    """(coefficients, what they have to make up) of each equation of the balance, put together from the leaves inwards.

    Args:
        rows, needed: the same of the single bodies.
    """
    axes, links = Axes(balance.system.motion), balance.system.motion.links
    within = _carried(links)
    sides = [{**row, RIGHT: value} for row, value in zip(rows, needed, strict=True)]
    sixes = [_by_component(balance, link, sides) for link in links]
    for i in reversed(range(len(links))):
        arm = axes.arm(i, links[i].point)
        own = {j: _about_joint(arm, six) for j, six in sixes[i].items()}
        for k, link in enumerate(links):
            if link.parent == i:
                for j, six in sixes[k].items():
                    own[j] = _added(own.get(j, NOTHING), _seen_by_parent(axes, link, arm, six))
        sixes[i] = {j: six for j, six in own.items() if not _is_inside(balance, j, within[i])}
    found = [_row(sixes[balance.system.motion.index[e.body]], e.direction) for e in balance.equations]
    return [{j: x for j, x in row.items() if j != RIGHT} for row in found], [row.get(RIGHT, 0) for row in found]


def _by_component(balance: Balance, link: BodyLink, sides: Sequence[SparseRow]) -> dict[int, tuple[Scalar, ...]]:
    """{component: force and moment on one body}"""
    found: dict[int, list[Scalar]] = {}
    for equation, side in zip(balance.equations, sides, strict=True):
        if equation.body == link.name:
            for j, x in side.items():
                found.setdefault(j, [0] * 6)[equation.direction] = x
    return {j: tuple(six) for j, six in found.items()}


def _about_joint(arm: Vector, six: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """Force and moment about the joint's point, of those about the mass centre."""
    f, n = Vector(six[:3]), Vector(six[3:])
    return (*f, *(n - arm.cross(f)))


def _seen_by_parent(axes: Axes, link: BodyLink, arm: Vector, six: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """The force and moment about a body's joint, in the axes of its parent's equations and about the parent's joint."""
    f, n = Vector(six[:3]), Vector(six[3:])
    if not axes.plane:
        f, n = link.local.R @ f, link.local.R @ n
    return (*f, *(n + (axes.arm(link.parent, link.local.p) - arm).cross(f)))


def _added(a: Sequence[Scalar], b: Sequence[Scalar]) -> tuple[Scalar, ...]:
    return tuple(x + y for x, y in zip(a, b, strict=True))


def _row(sixes: dict[int, tuple[Scalar, ...]], direction: int) -> SparseRow:
    return {j: six[direction] for j, six in sixes.items() if not is_zero(six[direction])}


def _carried(links: Sequence[BodyLink]) -> list[frozenset[int]]:
    """Set of each body itself and all bodies that it carries, by index."""
    found: list[frozenset[int]] = [frozenset((i,)) for i in range(len(links))]
    for i in reversed(range(len(links))):
        if links[i].parent != GROUND:
            found[links[i].parent] |= found[i]
    return found


def _is_inside(balance: Balance, j: int, bodies: Iterable[int]) -> bool:
    """True if a joint's component acts between two of these bodies: on both together it has no force and no moment."""
    if not 0 <= j < len(balance.components) or balance.components[j].kind == "constraint":
        return False
    touched = {effect.link for effect in balance.components[j].effects}
    return len(touched) == 2 and touched <= {*bodies}


# -- hinges along the axes of the body that carries them -------------------------------------------


def along_carriers(balance: Balance, rows: Sequence[SparseRow]) -> tuple[list[SparseRow], Turned]:
    """The coefficients for forces of hinges along the axes of the body that carries both, and how these lie.

    What a plane loop leaves open lies along one of these, and not in between as in ground axes.
    """
    motion, seen = balance.system.motion, seen_by_carriers(balance.system)
    groups: dict[tuple[str, str, str], list[int]] = {}
    for j, (carrier, component) in seen.items():
        groups.setdefault((component.owner, component.side, carrier), []).append(j)
    hinges = {key: tuple(group) for key, group in groups.items() if len(group) == 3}
    own = {j: seen[j][1] for group in hinges.values() for j in group}
    found = [{**row, **_of_hinges(balance, n, row, own)} for n, row in enumerate(rows)]
    return found, [(group, motion.link(carrier).pose.R) for (_, _, carrier), group in hinges.items()]


def _of_hinges(balance: Balance, n: int, row: SparseRow, own: Mapping[int, Component]) -> SparseRow:
    """Coefficients of these components in one equation: the contribution of a unit of each."""
    equation = balance.equations[n]
    i = balance.system.motion.index[equation.body]
    six = {j: [e.six[equation.direction] for e in c.effects if e.link == i] for j, c in own.items()}
    return {j: sum(values, start=0) for j, values in six.items() if values or j in row}


def along_ground_again(solution: Solution, turned: Turned) -> Solution:
    """Forces of these hinges along the ground's axes: r = R r_C. A free one keeps its number, along its own axis."""
    constants, shares = dict(solution.constants), dict(solution.shares)
    for group, R in turned:
        own = [(solution.constants.get(j, 0), solution.shares.get(j, {j: -1})) for j in group]
        for j, row in zip(group, R, strict=True):
            constants[j] = sum((k * value for k, (value, _) in zip(row, own, strict=True)), start=0)
            total: SparseRow = {}
            for k, (_, share) in zip(row, own, strict=True):
                for f, x in share.items():
                    total[f] = total.get(f, 0) + k * x
            shares[j] = {f: x for f, x in total.items() if not is_zero(x) and not holds_identically(x)}
    return replace(solution, constants=constants, shares=shares)
