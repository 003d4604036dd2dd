"""System -> Inverse: the forces and torques that given accelerations need.

    A tau + J^T lam = r,   r = M a + c - Q

The columns of A are the actuators: dq_i'/du of a force along the coordinate q_i, a unit column of one along a speed,
ds'/du of a torque or force in a body's joint, dQ/d input of an input. r comes from one recursion over the tree
(Newton-Euler), M is never formed. Where an actuator acts along one speed alone its equation gives its tau; the others
give the other tau and lam.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from eomgen.errors import DerivationError, MissingValues, ModelError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import (
    Closure,
    Constraints,
    Rank,
    Row,
    holds_identically,
)
from eomgen.mechanics.dynamics import EquationsOfMotion, System, assembled_by_recursion, inverse_residual
from eomgen.mechanics.free_bodies.friction import SystemFriction
from eomgen.mechanics.free_bodies.reactions import Reactions
from eomgen.mechanics.start import Start
from eomgen.mechanics.state import Numbers, Split
from eomgen.model import nearest
from eomgen.symbolic.exact import cramer
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    ScalarRow,
    State,
    depends_on,
    derivative,
    gradient,
    inner,
    is_zero,
    substituted,
)
from eomgen.symbolic.numeric import dense, tolerances, transplanted

NAME = "name the actuated coordinates or inputs, one for each degree of freedom"


@dataclass(frozen=True)
class Inverse:
    """Inverse dynamics: tau as functions of t, q, u, a, parameters, and of inputs that are no actuators.

    Args:
        system: the system.
        names: the actuators: coordinates, speeds, inputs, or bodies whose joint has one variable.
        inputs: the inputs that are arguments: all but the actuators.
        tau: of each actuator the force (of an angle: torque) along it, or the input's value; `unknowns` stand in it.
        rows, right: rows z = right gives the unknowns z; () where tau is explicit.
        unknowns: the symbols of z: multipliers, and inputs that are actuators.
    """

    system: System
    names: tuple[str, ...]
    inputs: dict[str, Scalar]
    tau: ScalarRow
    rows: tuple[ScalarRow, ...] = ()
    right: ScalarRow = ()
    unknowns: tuple[Node, ...] = ()

    def explicit(self) -> ScalarRow:
        """tau without unknowns, these by determinants.

        Raises:
            DerivationError: constraints follow from others, so that they share their forces; too many unknowns.
        """
        if not self.unknowns:
            return self.tau
        if len(self.rows) != len(self.unknowns):
            raise DerivationError(
                "tau has no single expression: constraints that follow from others share their forces",
                fix="take the generated code",
            )
        lines = [{j: x for j, x in enumerate(row) if not is_zero(x)} for row in self.rows]
        values = [x for (x,) in cramer.solution_by_minors(lines, [(x,) for x in self.right])[0]]
        return substituted(self.tau, dict(zip(self.unknowns, values, strict=True)))

    @staticmethod
    def of(system: System, actuated: Sequence[str] = ()) -> Inverse:
        """tau that moves the system with accelerations a; where constraints close, J a + gamma = 0 must hold of them.

        Args:
            actuated: coordinates, speeds, inputs or bodies (in their joint) that act, one for each degree of freedom;
                () for all speeds of a system without closing constraints.
        Raises:
            UsageError: an unknown name; too few or too many actuators.
            DerivationError: Coulomb friction; an input that does not act linearly.
        """
        if SystemFriction(system).exists:
            raise DerivationError(
                "inverse dynamics with Coulomb friction, which depends on the reactions, is not derived",
                fix="give the coordinates their `motion`, and use drive(...)",
            )
        symbols, closing = system.symbols, system.symbols.lam
        if not symbols.u:
            raise UsageError(
                "nothing is free to move: every motion is given", fix="ask for drive(...) of what is driven"
            )
        if not actuated and closing:
            raise UsageError("constraints close loops, and nothing says which coordinates are actuated", fix=NAME)
        names = tuple(actuated) or tuple(_along(u, system) for u in symbols.u)
        own = {name: symbols.inputs[name] for name in names if name in symbols.inputs}
        needed = inverse_residual(system)
        columns = _columns(system, names, needed)
        _refuse_wrong_number(system, names, columns)
        r = substituted(needed, dict.fromkeys(own.values(), 0))
        inputs = {name: value for name, value in system.inputs.items() if name not in own}
        return _solved_for(Inverse(system, names, inputs, ()), columns, r)


def _columns(system: System, names: Sequence[str], needed: ScalarRow) -> tuple[ScalarRow, ...]:
    """The generalized forces of a unit of every actuator.

    Raises:
        UsageError: a name that is none, or that is driven.
        DerivationError: an input that does not act linearly.
    """
    symbols, scope = system.symbols, system.scope
    known = {link.name: _column_of_joint(system, link.name) for link in system.motion.links if len(link.s) == 1}
    known |= {q.name: row for q, row in zip(symbols.q, scope.N, strict=True)}
    known |= {u.name: tuple(int(u is other) for other in symbols.u) for u in symbols.u}
    for name in names:
        if name in symbols.inputs:
            known[name] = _column_of_input(name, symbols.inputs[name], needed)
        elif name not in known:
            raise UsageError(
                f"there is no coordinate, speed, input or hinged body '{name}'",
                fix=nearest(name, [*known, *symbols.inputs]),
            )
        elif all(is_zero(x) for x in known[name]):
            requested = name if name in scope.model.coordinates else "its coordinate"
            raise UsageError(f"'{name}' is driven: drive({requested}) is the force that it needs", fix=NAME)
    return tuple(known[name] for name in names)


def _along(u: Node, system: System) -> str:
    """The coordinate whose rate a speed is, else the speed."""
    rated = u.name.removesuffix("'")
    return rated if rated in system.scope.model.coordinates else u.name


def _column_of_joint(system: System, body: str) -> ScalarRow:
    row = system.motion.joint_row(body, 0)
    return tuple(row.get(k, 0) for k in range(len(system.symbols.u)))


def _column_of_input(name: str, node: Node, needed: ScalarRow) -> ScalarRow:
    column = tuple(-gradient(x, (node,))[0] for x in needed)
    if any(depends_on(x, (node,)) for x in column):
        raise DerivationError(f"'{name}' does not act linearly: what it has to be is not determined", fix=NAME)
    return column


def _refuse_wrong_number(system: System, names: Sequence[str], columns: Sequence[ScalarRow]) -> None:
    """Refuses actuators that leave a motion without force, or forces that are indeterminate.

    Raises:
        UsageError: rank [A J^T] < nu, or rank [A J^T] - rank J^T < number of actuators.
    """
    constraints, nu = system.constraints, len(system.symbols.u)
    state = Closure(constraints).generic()
    A, J = Numbers(state).array(columns, nu), Numbers(state).on_manifold(constraints.J, nu)
    whole, own = (dense.rank(rows, smallest=tolerances.RANK_NEARBY) for rows in (np.vstack([A, J]), J))
    reported = f"{len(names)} actuated, and {nu - own} degrees of freedom"
    if whole < nu:
        raise UsageError(f"{reported}: {nu - whole} would have no actuator", fix=NAME)
    if whole - own < len(names):
        raise UsageError(f"{reported}: the forces of the actuators are indeterminate", fix=NAME)


def _solved_for(found: Inverse, columns: Sequence[ScalarRow], r: ScalarRow) -> Inverse:
    """tau of the actuators that act along one speed alone; the equations for the others, and for lam."""
    symbols, J = found.system.symbols, found.system.constraints.J
    alone = _acting_alone(columns)
    others = [m for m in range(len(columns)) if m not in alone.values()]
    stands = {m: symbols.inputs.get(found.names[m], symbols.graph.symbol(f"tau({found.names[m]})")) for m in others}
    acting = [*(columns[m] for m in others), *J]
    unknowns = (*stands.values(), *symbols.lam)
    tau = dict[int, Scalar](stands)
    for k, m in alone.items():
        tau[m] = r[k] - inner((column[k] for column in acting), unknowns)
    left = [k for k in range(len(r)) if k not in alone]
    rows = tuple(tuple(column[k] for column in acting) for k in left)
    values = tuple(tau[m] for m in range(len(columns)))
    return replace(found, tau=values, rows=rows, right=tuple(r[k] for k in left), unknowns=unknowns)


def _acting_alone(columns: Sequence[ScalarRow]) -> dict[int, int]:
    """{speed: the actuator that acts along it alone, with a unit of force}."""
    found: dict[int, int] = {}
    for m, column in enumerate(columns):
        acting = [k for k, x in enumerate(column) if not is_zero(x)]
        if len(acting) == 1 and type(column[acting[0]]) is int and column[acting[0]] == 1:
            found.setdefault(acting[0], m)
    return found


# -------- drive -----------------------------------------------------------------------------------------------
# System -> the forces that act along coordinates: what drives a given motion, and multipliers of constraints of
# coordinates.
#
# With the coordinate k freed, the equations of motion give the force along it that keeps it moving as given:
#
#     F_k = (M a + c - Q - J^T lam - sum f_r N_r)_k,   all of them at the given motion
#
# N_r are the normal reactions of contacts with friction, f_r the generalized force of its friction for a unit of it.


@dataclass(frozen=True)
class DrivingForces:
    """Forces along what is driven, and multipliers of constraints, of given motions."""

    system: System

    def along(self, coordinate: str) -> Scalar:
        """The force (of an angle: torque) along a driven coordinate that keeps it moving as given, linear in a and lam.

        That of a coordinate which a constraint drives is the multiplier of the constraint.

        Raises:
            DerivationError: the coordinate is not driven.
        """
        if ("drive", coordinate) not in self.system.found:
            self.system.found["drive", coordinate] = _drive(self.system, coordinate)
        found: Scalar = self.system.found["drive", coordinate]
        return found

    def multiplier(self, constraint: str) -> Scalar:
        """lam of a constraint of one row in the equations of motion; a symbol where it closes.

        Raises:
            DerivationError: it has no single row, carries nothing, or shares what it carries with others.
        """
        rows = [row for row in self.system.constraints.rows if row.constraint == constraint]
        if len(rows) != 1:
            raise DerivationError(
                f"multiplier({constraint}): the constraint has {len(rows)} rows",
                fix="ask for reaction(...) of one component",
            )
        (row,) = rows
        if row.status == "identical":
            raise DerivationError(
                f"multiplier({constraint}): the coordinates satisfy it by themselves, and it acts on no body",
                fix="take it away, or other coordinates",
            )
        _refuse_shared((self.system.free or self.system).constraints, constraint)
        if row.status == "closing":
            return next(lam for lam in self.system.symbols.lam if lam.name == row.label)
        return _eliminated(self.system, row)


def _drive(system: System, coordinate: str) -> Scalar:
    model = system.scope.model
    part, constraints = model.coordinates[coordinate], model.driving_constraints.get(coordinate, ())
    if not part.driven and constraints:
        return sum((DrivingForces(system).multiplier(constraint) for constraint in constraints), start=0)
    if not part.driven:
        raise DerivationError(
            f"drive({coordinate}): '{coordinate}' is not driven, it moves freely",
            fix="ask it of a coordinate with `motion`, `rate` or `acceleration`",
        )
    free = system.let_go(coordinate)
    equations = assembled_by_recursion(free)
    k = [u.name for u in free.symbols.u].index(f"{coordinate}'")
    return _carried(drive_residual(equations, k), system) - _friction(system, free, k)


def _friction(system: System, free: System, k: int) -> Scalar:
    """The friction along the k-th speed of the freed system, by the normal reactions of the motion as it is given."""
    u = free.symbols.u[k]
    shares = {
        name: _carried(factor * derivative(sliding, u), system) for name, factor, sliding in SystemFriction(free).named
    }
    shares = {name: share for name, share in shares.items() if not is_zero(share)}
    if not shares:
        return 0
    reactions = Reactions.of(system)
    return sum((share * reactions.normal(name) for name, share in shares.items()), start=0)


def drive_residual(equations: EquationsOfMotion, k: int, without: Container[tuple[str, int]] = ()) -> Scalar:
    """(M a + c - Q - J^T lam)_k, the multipliers of some rows left out."""
    symbols = equations.system.symbols
    value = sum((m * a for m, a in zip(equations.M[k], symbols.a, strict=True)), start=-equations.forcing[k])
    for row, J, lam in zip(equations.system.constraints.closing, equations.J, symbols.lam, strict=True):
        value = value if (row.constraint, row.number) in without else value - J[k] * lam
    return value


def _carried(value: Scalar, system: System) -> Scalar:
    """A scalar of the freed model's graph in the symbols of the system, at its motion."""
    scope = system.scope
    meanings = {**scope.names, **{lam.name: lam for lam in system.symbols.lam}}
    return transplanted((value,), scope.graph, meanings)[0]


def _refuse_shared(constraints: Constraints, constraint: str) -> None:
    """Refuse a constraint that follows from others: what these carry together is determined, not what each does."""
    try:
        redundant = Rank(constraints).redundant()
    except MissingValues:  # without values nobody can say if they do
        return
    for row in redundant:
        sharing = tuple(dict.fromkeys((row.constraint, *row.others)))
        if constraint in sharing:
            with_whom = " and ".join(f"'{name}'" for name in sharing if name != constraint)
            raise DerivationError(
                f"statically indeterminate: multiplier({constraint}) shares its force with {with_whom}",
                fix="take one of them away",
            )


def _eliminated(system: System, own: Row) -> Scalar:
    """lam of an eliminated row: J_d^T lam = (M a + c - Q - J_c^T lam_c)_d along the coordinates d that they give."""
    free = system.free
    assert free is not None, "a row is eliminated from the free system"
    gone = [row for row in system.constraints.rows if row.status == "eliminated"]
    names = {(row.constraint, row.number) for row in gone}
    speeds, equations = [u.name for u in free.symbols.u], assembled_by_recursion(free)
    d = [speeds.index(f"{row.eliminates}'") for row in gone]
    J = {(row.constraint, row.number): line for row, line in zip(free.constraints.closing, equations.J, strict=True)}
    right = [(drive_residual(equations, k, names) - _friction(system, free, k),) for k in d]
    columns = [J[row.constraint, row.number] for row in gone]
    lines = [{j: line[k] for j, line in enumerate(columns) if not is_zero(line[k])} for k in d]
    lam, _ = cramer.solution_by_minors(lines, right, vanishes=holds_identically)
    known: dict[Node, Scalar] = {}
    for u, a in zip(free.symbols.u, free.symbols.a, strict=True):
        if u not in system.symbols.u:
            known |= {u: system.scope.names[u.name], a: system.scope.names[a.name]}
    (value,) = substituted(lam[gone.index(own)], known)
    return value


# -------- accelerations at start ------------------------------------------------------------------------------
# Equations of motion -> accelerations and multipliers by the independent accelerations: few degrees of freedom, many
# constraints.
#
#     a = Z a_i + X,   Z^T M Z a_i = Z^T (F - M X),   J_d^T lam = (M a - F)_d
#
# J = (J_i, J_d) with J_d regular; Z = (1, A), X = (0, b) with J_d A = -J_i, J_d b = -gamma.


FEW = 3  # degrees of freedom


def by_independent(equations: EquationsOfMotion, kept: Sequence[int]) -> dict[Node, Scalar]:
    """a and lam, where the constraints leave few degrees of freedom; redundant rows are left out, their lam 0.

    Args:
        kept: the constraint rows that do not follow from others.
    Raises:
        DerivationError: more than FEW degrees of freedom are left, or too many unknowns hang together.
        MissingValues: the constraints do not close without values.
    """
    symbols, n = equations.symbols, len(equations.M)
    if n - len(kept) > FEW:
        what = f"the constraints leave more than {FEW} degrees of freedom"
        raise DerivationError(what, fix="declare what follows from them as dependent")
    J = [equations.J[m] for m in kept]
    d = _dependent(equations.system, J)
    i = [k for k in range(n) if k not in d]
    right = [(*(-row[k] for k in i), -equations.gamma[m]) for m, row in zip(kept, J, strict=True)]
    columns, _ = cramer.solution_by_minors([_entries([row[k] for k in d]) for row in J], right)
    follows = dict(zip(d, columns, strict=True))
    Z = [follows[k][:-1] if k in follows else tuple(int(k == j) for j in i) for k in range(n)]
    X = [follows[k][-1] if k in follows else 0 for k in range(n)]
    a = _moved(equations, Z, X)
    pull = [inner(equations.M[k], a) - equations.forcing[k] for k in d]
    lam, _ = cramer.solution_by_minors([_entries([row[k] for row in J]) for k in d], [(x,) for x in pull])
    multipliers = {symbols.lam[m]: x for m, (x,) in zip(kept, lam, strict=True)}
    return dict(zip(symbols.a, a, strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}


def _moved(equations: EquationsOfMotion, Z: Sequence[Sequence[Scalar]], X: Sequence[Scalar]) -> list[Scalar]:
    """a = Z a_i + X of the independent accelerations that the forces make."""
    degrees_of_freedom = range(len(Z[0]))
    columns = [[row[j] for row in Z] for j in degrees_of_freedom]
    moved = [[inner(row, column) for row in equations.M] for column in columns]
    left = [force - inner(row, X) for force, row in zip(equations.forcing, equations.M, strict=True)]
    reduced = [_entries([inner(column, each) for each in moved]) for column in columns]
    found, _ = cramer.solution_by_minors(reduced, [(inner(column, left),) for column in columns])
    return [inner(row, [x for (x,) in found]) + x for row, x in zip(Z, X, strict=True)]


def _dependent(system: System, J: Sequence[Sequence[Scalar]]) -> list[int]:
    """The speeds that follow from the others at the start, if it is not special; the last ones rather."""
    many = len(system.symbols.u)
    for state in _states(system):
        split = Split.of(Numbers(state).array(J, many), range(many), tolerances.RANK_NEARBY)
        if len(split.following) == len(J):
            break
    return [*split.following]


def _states(system: System) -> Iterator[State]:
    """The start where it has values, then a configuration that is not special."""
    with suppress(DerivationError, ModelError):
        yield Start.begun(system)
    yield Closure(system.constraints).generic()


def _entries(row: Sequence[Scalar]) -> dict[int, Scalar]:
    return {j: x for j, x in enumerate(row) if not is_zero(x)}
