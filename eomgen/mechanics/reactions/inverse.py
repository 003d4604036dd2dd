"""System -> Inverse: the forces and torques that given accelerations take.

    A tau + J^T lam = r,   r = M a + c - Q

The columns of A are the actuators: dq_i'/du of a force along the coordinate q_i, a unit column of one along a speed,
ds'/du of a torque or force in a body's joint, dQ/d input of an input. r comes from one recursion over the tree
(Newton-Euler), M is never formed. Where an actuator acts along one speed alone its equation gives its tau; the others
give the other tau and lam.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.balance.friction import has_friction
from eomgen.mechanics.bodies.armature import armature_bias, armature_mass, joint_row
from eomgen.mechanics.bodies.recursion import applied_wrenches, bias_forces
from eomgen.mechanics.bodies.tree import branches_of
from eomgen.mechanics.constraints.closure import generic_state, rows_where_closed
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import joint_forces, placeless_forces
from eomgen.model.findings import nearest
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, gradient, substituted
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.spatial import times
from eomgen.symbolic.numeric import dense
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY
from eomgen.symbolic.solve import cramer

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
            DerivationError: ties follow from others, so that they share their forces; too many unknowns.
        """
        if not self.unknowns:
            return self.tau
        if len(self.rows) != len(self.unknowns):
            raise DerivationError(
                "tau has no single expression: ties that follow from others share their forces",
                mend="take the generated code",
            )
        lines = [{j: x for j, x in enumerate(row) if not is_zero(x)} for row in self.rows]
        values = [x for (x,) in cramer.solution_by_minors(lines, [(x,) for x in self.right])[0]]
        return substituted(self.tau, dict(zip(self.unknowns, values, strict=True)))


def inverse_of(system: System, actuated: Sequence[str] = ()) -> Inverse:
    """tau that moves the system with accelerations a; where ties close, J a + gamma = 0 must hold of them.

    Args:
        actuated: coordinates, speeds, inputs or bodies (in their joint) that act, one for each degree of freedom; ()
            for all speeds of a system without closing ties.
    Raises:
        UsageError: an unknown name; too few or too many actuators.
        DerivationError: Coulomb friction; an input that does not act linearly.
    """
    if has_friction(system):
        raise DerivationError(
            "inverse dynamics with Coulomb friction, which depends on the reactions, is not derived",
            mend="give the coordinates their `motion`, and ask for drive(...)",
        )
    symbols, closing = system.symbols, system.symbols.lam
    if not symbols.u:
        raise UsageError("nothing is free to move: every motion is given", mend="ask for drive(...) of what is driven")
    if not actuated and closing:
        raise UsageError("ties close loops, and nothing says which coordinates are actuated", mend=NAME)
    names = tuple(actuated) or tuple(_along(u, system) for u in symbols.u)
    own = {name: symbols.inputs[name] for name in names if name in symbols.inputs}
    needed = inverse_residual(system)
    columns = _columns(system, names, needed)
    _refuse_wrong_number(system, names, columns)
    r = substituted(needed, dict.fromkeys(own.values(), 0))
    inputs = {name: value for name, value in system.inputs.items() if name not in own}
    return _solved_for(Inverse(system, names, inputs, ()), columns, r)


def inverse_residual(system: System) -> ScalarRow:
    """M a + c - Q by recursive Newton-Euler, weight as an upward acceleration of the ground."""
    motion, loads, a = system.motion, system.loads, system.symbols.a
    branches = branches_of(motion)
    forces = bias_forces(
        branches,
        len(a),
        base_acceleration=times(-1, loads.fields),
        applied=applied_wrenches(loads, branches),
        a=a,
    )
    rotors = armature_bias(motion, len(a))
    for i, j, value in armature_mass(motion):
        rotors[i] = rotors[i] + value * a[j]
    direct = zip(forces, rotors, joint_forces(loads), placeless_forces(loads), strict=True)
    return tuple(f + rotor - x - y for f, rotor, x, y in direct)


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
                mend=nearest(name, [*known, *symbols.inputs]),
            )
        elif all(is_zero(x) for x in known[name]):
            asked = name if name in scope.model.coordinates else "its coordinate"
            raise UsageError(f"'{name}' is driven: it takes what drive({asked}) says", mend=NAME)
    return tuple(known[name] for name in names)


def _along(u: Node, system: System) -> str:
    """The coordinate whose rate a speed is, else the speed."""
    rated = u.name.removesuffix("'")
    return rated if rated in system.scope.model.coordinates else u.name


def _column_of_joint(system: System, body: str) -> ScalarRow:
    row = joint_row(system.motion, body, 0)
    return tuple(row.get(k, 0) for k in range(len(system.symbols.u)))


def _column_of_input(name: str, node: Node, needed: ScalarRow) -> ScalarRow:
    column = tuple(-gradient(x, (node,))[0] for x in needed)
    if any(depends_on(x, (node,)) for x in column):
        raise DerivationError(f"'{name}' does not act linearly: what it has to be is not determined", mend=NAME)
    return column


def _refuse_wrong_number(system: System, names: Sequence[str], columns: Sequence[ScalarRow]) -> None:
    """Every motion must be reached by an actuator, and every tau be determined.

    Raises:
        UsageError: rank [A J^T] < nu, or rank [A J^T] - rank J^T < number of actuators.
    """
    ties, nu = system.ties, len(system.symbols.u)
    state = generic_state(ties)
    A = _numbers([x for column in columns for x in column], state, nu)
    J = rows_where_closed(ties, state)
    whole, own = (dense.rank(rows, smallest=RANK_NEARBY) for rows in (np.vstack([A, J]), J))
    told = f"{len(names)} actuated, and {nu - own} degrees of freedom"
    if whole < nu:
        raise UsageError(f"{told}: {nu - whole} would be moved by nothing", mend=NAME)
    if whole - own < len(names):
        raise UsageError(f"{told}: how the actuators share their work is indeterminate", mend=NAME)


def _numbers(entries: Sequence[Scalar], state: dict[Node, object], width: int) -> np.ndarray:
    values = evaluate(entries, state, fifty_digits())
    return np.array([float(x) for x in values]).reshape(-1, width)


def _solved_for(found: Inverse, columns: Sequence[ScalarRow], r: ScalarRow) -> Inverse:
    """tau of the actuators that act along one speed alone; the equations for the others, and for lam."""
    symbols, J = found.system.symbols, found.system.ties.J
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
