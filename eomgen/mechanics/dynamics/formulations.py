"""Ways to the equations of motion: Lagrange, Newton-Euler projected, recursive."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from eomgen.errors import DerivationError, ModelError
from eomgen.frozen import dataclass, recalled
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System, assembled
from eomgen.mechanics.dynamics.tree import Branch, applied_wrenches, bias_forces, branches_of, composite_mass_matrix
from eomgen.mechanics.kinematics import Loads, Motion, SystemInertia
from eomgen.model import Coordinate, Model, NodeBalance, Table
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    ScalarRow,
    SpatialInertia,
    Twist,
    Vector,
    Wrench,
    depends_on,
    derivative,
    gradient,
    inner,
    is_zero,
    jacobian,
    parse,
    pullback,
    substituted,
    tangent,
)
from eomgen.symbolic.print import text_size, to_text

# -------- lagrange --------------------------------------------------------------------------------------------
# Lagrange's equations of the second kind, by derivatives of the energies.
#
#     d/dt dT/du_k - dT/dq_k = Q_k,   M = d2T/du du,   c = (d/dt dT/du at a = 0) - dT/dq
#
# d/dt holds masses as they are: where they change, what d/dt dT/du gains by that is taken off again.
#
# Where coordinates were eliminated, u_free = N u + nu, the equations of the free system are reduced:
#
#     M_r = N^T M N,   c_r = N^T (c + M (N' u + nu')),   Q_r = N^T Q


def assembled_by_energies(system: System) -> EquationsOfMotion:
    """The equations of motion from the energies; constraint rows by multipliers."""
    if system.free is not None:
        return _reduced(system, system.free)
    T = SystemInertia(system.motion).kinetic_energy
    M, c = inertia_by_energies(system.motion, T)
    return assembled(system, M=M, c=c, Q=system.loads.generalized_forces, T=T)


def _reduced(system: System, free: System) -> EquationsOfMotion:
    """The free system's M, c and Q along the motions that are left, its speeds in terms of the independent ones."""
    whole = assembled_by_energies(free)
    rates = system.free_rates(free)
    known = dict(zip(free.scope.symbols.u, rates, strict=True))
    N = jacobian(rates, system.scope.symbols.u)
    bias = system.scope.time_derivative(rates)
    n, entries = len(whole.M), [x for row in whole.M for x in row]
    (T, *rest) = substituted((whole.T, *whole.c, *whole.Q, *entries), known)  # at once: they share nearly everything
    c, Q, M = rest[:n], rest[n : 2 * n], [rest[k : k + n] for k in range(2 * n, len(rest), n)]
    carried = [inertia + inner(row, bias) for inertia, row in zip(c, M, strict=True)]
    columns = tuple(zip(*N, strict=True))
    columned = [[inner(row, column) for row in M] for column in columns]
    return assembled(
        system,
        M=tuple(tuple(inner(column, momentum) for momentum in columned) for column in columns),
        c=tuple(inner(column, carried) for column in columns),
        Q=tuple(inner(column, Q) for column in columns),
        T=T,
    )


def energies_along(system: System) -> tuple[ScalarRow, ScalarRow, ScalarRow]:
    """(M a, c, Q) by derivatives of the energies along one motion: O(n), no entry of M is formed."""
    if system.free is None:
        return _along(system, system.symbols.a)
    u, free = system.scope.symbols.u, system.free
    rates = system.free_rates(free)
    bias = system.scope.time_derivative(rates)
    rows = (*_along(free, tangent(rates, dict(zip(u, system.symbols.a, strict=True)))), _along(free, bias)[0])
    known = dict(zip(free.scope.symbols.u, rates, strict=True))
    found = substituted([x for row in rows for x in row], known)
    Ma, c, Q, carried = (found[k : k + len(rates)] for k in range(0, len(found), len(rates) or 1))
    inertia = tuple(x + y for x, y in zip(c, carried, strict=True))
    return pullback(rates, Ma, u), pullback(rates, inertia, u), pullback(rates, Q, u)


def _along(system: System, a: ScalarRow) -> tuple[ScalarRow, ScalarRow, ScalarRow]:
    """The same for given accelerations of a system whose speeds are rates."""
    scope, u = system.scope, system.scope.symbols.u
    T = SystemInertia(system.motion).kinetic_energy
    momenta = gradient(T, u)
    held = system.motion.scope.per_speed(gradient(T, scope.symbols.q))
    c = tuple(p - k for p, k in zip(_inertial(system.motion, momenta), held, strict=True))
    return tangent(momenta, dict(zip(u, a, strict=True))), c, system.loads.generalized_forces


def inertia_by_energies(motion: Motion, T: Scalar) -> tuple[tuple[ScalarRow, ...], ScalarRow]:
    """(M, c) by derivatives of the kinetic energy."""
    scope = motion.scope
    momenta = gradient(T, scope.symbols.u)
    M = jacobian(momenta, scope.symbols.u)
    held = motion.scope.per_speed(gradient(T, scope.symbols.q))
    c = tuple(p - k for p, k in zip(_inertial(motion, momenta), held, strict=True))
    return M, c


def _inertial(motion: Motion, momenta: ScalarRow) -> ScalarRow:
    """d/dt dT/du at a = 0, masses held as they are."""
    gained = SystemInertia(motion).carried_momenta
    return tuple(p - k for p, k in zip(motion.scope.time_derivative(momenta), gained, strict=True))


# -------- projection ------------------------------------------------------------------------------------------
# Newton-Euler of every body, projected on the motions that the joints allow.
#
# M = sum B^T I B,   c = sum B^T (I alpha + xi x* (I xi)),   Q = sum B^T W


def assembled_by_wrenches(system: System) -> EquationsOfMotion:
    """The equations of motion from wrenches and twists; constraint rows by multipliers."""
    M, c = inertia_by_twists(system.motion)
    return assembled(system, M=M, c=c, Q=force_side(system.loads), T=SystemInertia(system.motion).kinetic_energy)


def wrenches_along(system: System) -> tuple[ScalarRow, ScalarRow, ScalarRow]:
    """(M a, c, Q) by the wrenches of one motion, B^T applied in one sweep: O(n), no entry of M is formed."""
    motion, a = system.motion, system.symbols.a
    u = motion.scope.symbols.u
    twists = tuple(x for link in motion.links for x in (*link.twist.w, *link.twist.v))
    pushed = tangent(twists, dict(zip(u, a, strict=True)))
    inertia, bias = [], []
    for i, link in enumerate(motion.links):
        mass = motion.scope.mass_properties(link.name)
        body = SpatialInertia.about_center(mass.m, mass.com, mass.I)
        inertia.append(body.momentum(_twist(pushed[6 * i : 6 * i + 6])))
        bias.append(_bias(body, link.twist, _twist(motion.alpha[i])))
    Ma = list(_projected(twists, inertia, u))
    for i, j, value in SystemInertia(motion).added_mass:
        Ma[i] = Ma[i] + value * a[j]
    rotors = SystemInertia(motion).added_bias
    c = tuple(x + y for x, y in zip(_projected(twists, bias, u), rotors, strict=True))
    applied = applied_to_bodies(system.loads)
    none = Wrench(Vector.ZERO, Vector.ZERO)
    Q = _projected(twists, [applied.get(link.name, none) for link in motion.links], u)
    return tuple(Ma), c, tuple(x + y for x, y in zip(Q, system.loads.placeless_forces, strict=True))


def _projected(twists: ScalarRow, wrenches: Iterable[Wrench], u: Sequence[Node]) -> ScalarRow:
    """sum B^T W"""
    return pullback(twists, [x for wrench in wrenches for x in (*wrench.tau, *wrench.f)], u)


def inertia_by_twists(motion: Motion) -> tuple[tuple[ScalarRow, ...], ScalarRow]:
    """(M, c) from the twists of the bodies."""
    size = len(motion.scope.symbols.u)
    M: list[list[Scalar]] = [[0] * size for _ in range(size)]
    c: list[Scalar] = [0] * size
    for i, link in enumerate(motion.links):
        mass = motion.scope.mass_properties(link.name)
        inertia = SpatialInertia.about_center(mass.m, mass.com, mass.I)
        columns = [column for column in zip(*motion.B[i], strict=True)]
        touched = [k for k, column in enumerate(columns) if not all(is_zero(x) for x in column)]
        bias = _bias(inertia, link.twist, _twist(motion.alpha[i]))
        for k in touched:
            c[k] = c[k] + _twist(columns[k]).power(bias)
            momentum = inertia.momentum(_twist(columns[k]))
            for j in touched:
                if j >= k:
                    M[k][j] = M[k][j] + _twist(columns[j]).power(momentum)
    for k in range(size):
        for j in range(k):
            M[k][j] = M[j][k]
    return _with_armatures(motion, M, c)


def _bias(inertia: SpatialInertia, xi: Twist, alpha: Twist) -> Wrench:
    """I alpha + xi x* (I xi): the wrench that the motion takes at a = 0, body axes, at the origin."""
    momentum = inertia.momentum(xi)
    turning = Wrench(xi.w.cross(momentum.tau) + xi.v.cross(momentum.f), xi.w.cross(momentum.f))
    return inertia.momentum(alpha).plus(turning)


def _twist(entries: Sequence[Scalar]) -> Twist:
    return Twist(Vector(entries[:3]), Vector(entries[3:]))


def _with_armatures(motion: Motion, M: list[list[Scalar]], c: list[Scalar]) -> tuple[tuple[ScalarRow, ...], ScalarRow]:
    for i, j, value in SystemInertia(motion).added_mass:
        M[i][j] = M[i][j] + value
    added = SystemInertia(motion).added_bias
    return tuple(tuple(row) for row in M), tuple(a + b for a, b in zip(c, added, strict=True))


def force_side(loads: Loads) -> ScalarRow:
    """Q = sum B^T W of every wrench, and what acts at no place."""
    motion = loads.motion
    Q = list(loads.placeless_forces)
    for body, wrench in applied_to_bodies(loads).items():
        rows = motion.B[motion.index[body]]
        for k in range(len(Q)):
            Q[k] = Q[k] + _twist([row[k] for row in rows]).power(wrench)
    return tuple(Q)


def applied_to_bodies(loads: Loads) -> dict[str, Wrench]:
    """Applied wrench on each body, efforts of joints included: at its origin, in its axes."""
    motion = loads.motion
    wrenches = [motion.body_wrench(load) for load in (*loads.placed, *loads.weights)]
    wrenches += [pair for effort in loads.efforts for pair in effort.wrenches(motion)]
    total: dict[str, Wrench] = {}
    for found in wrenches:
        if found is not None:
            body, wrench = found
            total[body] = total[body].plus(wrench) if body in total else wrench
    return total


# -------- recursive -------------------------------------------------------------------------------------------
# The recursive forms: bias forces body by body, mass matrix by composite bodies. For trees.


def assembled_by_recursion(system: System) -> EquationsOfMotion:
    """The equations of motion by recursion over the tree; constraint rows by multipliers."""
    motion = system.motion
    branches = branches_of(motion)
    return assembled(
        system,
        M=mass(motion, branches),
        c=inertia_terms(motion, branches),
        Q=system.loads.generalized_forces,
        T=SystemInertia(motion).kinetic_energy,
        forcing=forcing(system.loads, branches),
    )


def inertia_terms(motion: Motion, branches: tuple[Branch, ...]) -> ScalarRow:
    """c: what inertia takes at a = 0, armatures included."""
    size = len(motion.scope.symbols.u)
    bias = bias_forces(branches, size, base_acceleration=Vector.ZERO, applied={})
    return tuple(a + b for a, b in zip(bias, SystemInertia(motion).added_bias, strict=True))


def forcing(loads: Loads, branches: tuple[Branch, ...]) -> ScalarRow:
    """Q - c in one sweep, weight as an upward acceleration of the ground."""
    motion = loads.motion
    size = len(motion.scope.symbols.u)
    bias = bias_forces(
        branches,
        size,
        base_acceleration=-loads.fields,
        applied=applied_wrenches(loads, branches),
    )
    direct = [a + b for a, b in zip(loads.joint_forces, loads.placeless_forces, strict=True)]
    armature = SystemInertia(motion).added_bias
    return tuple(q - b - r for q, b, r in zip(direct, bias, armature, strict=True))


def mass(motion: Motion, branches: tuple[Branch, ...] = ()) -> tuple[ScalarRow, ...]:
    """M by composite bodies, armatures included.

    Args:
        branches: the tree of bodies, where it is known.
    """
    M = composite_mass_matrix(branches or branches_of(motion), len(motion.scope.symbols.u))
    for i, j, value in SystemInertia(motion).added_mass:
        M[i][j] = M[i][j] + value
    return tuple(tuple(row) for row in M)


def inverse_residual(system: System) -> ScalarRow:
    """M a + c - Q by recursive Newton-Euler, weight as an upward acceleration of the ground."""
    motion, loads, a = system.motion, system.loads, system.symbols.a
    branches = branches_of(motion)
    forces = bias_forces(
        branches,
        len(a),
        base_acceleration=-loads.fields,
        applied=applied_wrenches(loads, branches),
        a=a,
    )
    rotors = SystemInertia(motion).added_bias
    for i, j, value in SystemInertia(motion).added_mass:
        rotors[i] = rotors[i] + value * a[j]
    direct = zip(forces, rotors, loads.joint_forces, loads.placeless_forces, strict=True)
    return tuple(f + rotor - x - y for f, rotor, x, y in direct)


# -------- formulations ----------------------------------------------------------------------------------------
# Formulations: the seam of ways to the equations of motion, and which of them a method of derivation goes.


Along = Callable[[System], tuple[ScalarRow, ScalarRow, ScalarRow]]


@dataclass(frozen=True)
class Formulation:
    """One way to the equations of motion.

    Args:
        name: as tests say it.
        title: what a certificate says.
        assemble: System -> the equations, every entry of M.
        along: System -> (M a, c, Q) along one motion, for any accelerations: O(n), no entry of M is formed; None where
            that is the residual of inverse dynamics.
    """

    name: str
    title: str
    assemble: Callable[[System], EquationsOfMotion]
    along: Along | None = None


LAGRANGE = Formulation("lagrange", "Lagrange's equations", assembled_by_energies, along=energies_along)
PROJECTION = Formulation("projection", "projection of Newton-Euler", assembled_by_wrenches, along=wrenches_along)
RECURSION = Formulation("recursive", "recursion over the tree", assembled_by_recursion)

ALL = (LAGRANGE, PROJECTION, RECURSION)

METHODS = {"lagrange": LAGRANGE, "projection": PROJECTION, "kinetostatic": PROJECTION}
"""By which way a method of derivation goes; the reactions of a kineto-static one do no work and drop out of it."""


def derived_by(method: str, system: System) -> EquationsOfMotion:
    """The equations by the way of a method, friction left out.

    Speeds that are no rates have no equation of Lagrange's: there the balances are projected (Kane's way).
    """
    way = PROJECTION if system.scope.model.speeds else METHODS[method]
    return way.assemble(system)


# -------- massless nodes --------------------------------------------------------------------------------------
# Model -> Model: a node that moves no mass follows from the balance of what pushes it.
#
#     0 = Q_k(q, q', t)        of a free coordinate k with M_kj = 0 for all j, in place of M_k a + c_k = Q_k
#
# Between springs it is a constraint of positions, with a damper one of rates: the node's rate is that of a first-order
# state.
# The multiplier of such a constraint is 0, as nothing else is left along the coordinate; all others keep their
# equations.


LONGEST = 2_000  # characters of a balance that stands as an equation


def with_nodes_balanced(model: Model) -> Model:
    """The model with the balance of every massless node as a constraint, from which its coordinate follows; the same
    where there is none, or where what pushes one is no spring or damper."""
    return recalled(model, with_nodes_balanced, lambda: _balanced(model))


def _balanced(model: Model) -> Model:
    free = [name for name, q in model.coordinates.items() if not (q.driven or q.dependent)]
    if not free or model.speeds or model.unknowns or not any(body.may_be_massless for body in model.bodies.values()):
        return model
    try:
        equations = assembled_by_recursion(System.free_of(model))
        found = dict(_balances(equations, free))
        if not found:
            return model
        constraints = {NodeBalance.PREFIX + name: constraint for name, constraint in found.items()}
        moved = {name: _following(model.coordinates[name], constraint) for name, constraint in found.items()}
        return replace(
            model,
            coordinates=Table({**model.coordinates, **moved}),
            constraints=Table({**model.constraints, **constraints}),
        )
    except (ModelError, DerivationError):  # whoever needs accelerations says what is missing
        return model


def _following(coordinate: Coordinate, constraint: NodeBalance) -> Coordinate:
    """The coordinate that follows: of a constraint of places its start is a guess."""
    if constraint.gap is None:
        return replace(coordinate, dependent=True)
    near = coordinate.start if coordinate.near is None else coordinate.near
    return replace(coordinate, dependent=True, start=None, speed=None, near=near)


def _balances(equations: EquationsOfMotion, free: list[str]) -> Iterator[tuple[str, NodeBalance]]:
    """(coordinate, 0 = Q_k) of those that move no mass, that no constraint holds, and that springs or dampers push."""
    symbols = equations.symbols
    q_of: Mapping[str, Node] = {f"{q.name}'": q for q in symbols.q}
    massless = [k for k, row in enumerate(equations.M) if all(is_zero(x) for x in row)]
    tables = equations.system.scope.model.functions
    for k in massless:
        u, force = symbols.u[k], equations.forcing[k]
        q, held = q_of.get(u.name), any(not is_zero(row[k]) for row in equations.J)
        if q is None or q.name not in free or held or text_size(force) > LONGEST:
            continue
        rates = depends_on(force, symbols.u)
        if rates and _is_linear(force, symbols.u) and not is_zero(derivative(force, u)):
            yield q.name, NodeBalance(rate=parse(to_text(force), longest=LONGEST + 1, tables=tables))
        elif not rates and depends_on(force, (q,)):
            yield q.name, NodeBalance(gap=parse(to_text(force), longest=LONGEST + 1, tables=tables))


def _is_linear(force: Scalar, u: tuple[Node, ...]) -> bool:
    return not any(depends_on(derivative(force, x), u) for x in u)
