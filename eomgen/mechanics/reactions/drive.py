"""System -> the forces that act along coordinates: what drives a given motion, and multipliers of ties of coordinates.

With the coordinate k freed, the equations of motion say what force along it keeps it moving as given:

    F_k = (M a + c - Q - J^T lam - sum f_r N_r)_k,   all of them at the given motion

N_r are the normal reactions of contacts with friction, f_r the generalized force of its friction for a unit of it.
"""

from __future__ import annotations

from collections.abc import Container

from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.balance.friction import frictions
from eomgen.mechanics.bodies.system_scene import let_go
from eomgen.mechanics.constraints.elimination import dependent_coordinates
from eomgen.mechanics.constraints.freedom import redundant_rows
from eomgen.mechanics.constraints.ties import Row, Ties, holds_identically
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System, free_system_of, system_of
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.reactions.reactions import reactions_of
from eomgen.model.driven import driving_ties
from eomgen.model.part import altered
from eomgen.model.table import Table
from eomgen.symbolic.expression.derivative import derivative, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.numeric.transplant import transplanted
from eomgen.symbolic.solve import cramer


def drive(system: System, coordinate: str) -> Scalar:
    """The force (of an angle: torque) along a driven coordinate that keeps it moving as given, linear in a and lam.

    That of a coordinate which a tie drives is the multiplier of the tie.

    Raises:
        DerivationError: the coordinate is not driven.
    """
    if (drive, coordinate) not in system.found:
        system.found[drive, coordinate] = _drive(system, coordinate)
    found: Scalar = system.found[drive, coordinate]
    return found


def _drive(system: System, coordinate: str) -> Scalar:
    model = system.scope.model
    part, ties = model.coordinates[coordinate], driving_ties(model).get(coordinate, ())
    if not part.driven and ties:
        return sum((multiplier(system, tie) for tie in ties), start=0)
    if not part.driven:
        raise DerivationError(
            f"drive({coordinate}): '{coordinate}' is not driven, it moves freely",
            mend="ask it of a coordinate with `motion`, `rate` or `acceleration`",
        )
    free = with_drive_let_go(system, coordinate)
    equations = recursive.assembled_by_recursion(free)
    k = [u.name for u in free.symbols.u].index(f"{coordinate}'")
    return _carried(drive_residual(equations, k), system) - _friction(system, free, k)


def with_drive_let_go(system: System, coordinate: str) -> System:
    """The same without what moves a driven coordinate: one like others, which starts where it is driven from.

    A system over all rates stays one: rates that its ties would give need not be those of a state.
    """
    key = (with_drive_let_go, coordinate)
    if key not in system.found:
        model = altered(
            system.scope.model,
            coordinates=Table({**system.scope.model.coordinates, coordinate: let_go(system.scope, coordinate)}),
        )
        over_all = system.free is None and dependent_coordinates(system.scope)
        system.found[key] = (free_system_of if over_all else system_of)(model, system.modes, begun_as=system)
    free: System = system.found[key]
    return free


def _friction(system: System, free: System, k: int) -> Scalar:
    """The friction along the k-th speed of the freed system, by the normal reactions of the motion as it is given."""
    u = free.symbols.u[k]
    shares = {name: _carried(factor * derivative(sliding, u), system) for name, factor, sliding in frictions(free)}
    shares = {name: share for name, share in shares.items() if not is_zero(share)}
    if not shares:
        return 0
    reactions = reactions_of(system)
    return sum((share * reactions.normal(name) for name, share in shares.items()), start=0)


def drive_residual(equations: EquationsOfMotion, k: int, without: Container[tuple[str, int]] = ()) -> Scalar:
    """(M a + c - Q - J^T lam)_k, the multipliers of some rows left out."""
    symbols = equations.system.symbols
    value = sum((m * a for m, a in zip(equations.M[k], symbols.a, strict=True)), start=-equations.forcing[k])
    for row, J, lam in zip(equations.system.ties.closing, equations.J, symbols.lam, strict=True):
        value = value if (row.tie, row.number) in without else value - J[k] * lam
    return value


def _carried(value: Scalar, system: System) -> Scalar:
    """A scalar of the freed model's graph in the symbols of the system, at its motion."""
    scope = system.scope
    meanings = {**scope.names, **{lam.name: lam for lam in system.symbols.lam}}
    return transplanted((value,), scope.graph, meanings)[0]


def multiplier(system: System, tie: str) -> Scalar:
    """lam of a tie of one row in the equations of motion; a symbol where it closes.

    Raises:
        DerivationError: it has no single row, carries nothing, or shares what it carries with others.
    """
    rows = [row for row in system.ties.rows if row.tie == tie]
    if len(rows) != 1:
        raise DerivationError(
            f"multiplier({tie}): the tie has {len(rows)} rows", mend="ask for reaction(...) of one component"
        )
    (row,) = rows
    if row.status == "identical":
        raise DerivationError(
            f"multiplier({tie}): the coordinates satisfy it by themselves, and it acts on no body",
            mend="take it away, or other coordinates",
        )
    _refuse_shared((system.free or system).ties, tie)
    if row.status == "closing":
        return next(lam for lam in system.symbols.lam if lam.name == row.label)
    return _eliminated(system, row)


def _refuse_shared(ties: Ties, tie: str) -> None:
    """Refuse a tie that follows from others: what these carry together is determined, not what each does."""
    try:
        redundant = redundant_rows(ties)
    except MissingValues:  # whether they do cannot be told without values
        return
    for row in redundant:
        sharing = tuple(dict.fromkeys((row.tie, *row.others)))
        if tie in sharing:
            with_whom = " and ".join(f"'{name}'" for name in sharing if name != tie)
            raise DerivationError(
                f"statically indeterminate: multiplier({tie}) shares its force with {with_whom}",
                mend="take one of them away",
            )


def _eliminated(system: System, own: Row) -> Scalar:
    """lam of an eliminated row: J_d^T lam = (M a + c - Q - J_c^T lam_c)_d along the coordinates d that they give."""
    free = system.free
    assert free is not None, "a row is eliminated from the free system"
    gone = [row for row in system.ties.rows if row.status == "eliminated"]
    names = {(row.tie, row.number) for row in gone}
    speeds, equations = [u.name for u in free.symbols.u], recursive.assembled_by_recursion(free)
    d = [speeds.index(f"{row.eliminates}'") for row in gone]
    J = {(row.tie, row.number): line for row, line in zip(free.ties.closing, equations.J, strict=True)}
    right = [(drive_residual(equations, k, names) - _friction(system, free, k),) for k in d]
    columns = [J[row.tie, row.number] for row in gone]
    lines = [{j: line[k] for j, line in enumerate(columns) if not is_zero(line[k])} for k in d]
    lam, _ = cramer.solution_by_minors(lines, right, vanishes=holds_identically)
    known: dict[Node, Scalar] = {}
    for u, a in zip(free.symbols.u, free.symbols.a, strict=True):
        if u not in system.symbols.u:
            known |= {u: system.scope.names[u.name], a: system.scope.names[a.name]}
    (value,) = substituted(lam[gone.index(own)], known)
    return value
