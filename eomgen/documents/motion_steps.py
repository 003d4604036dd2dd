"""System -> the steps about motion: positions, velocities, constraints."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.documents.bounded import page
from eomgen.documents.reading import Reader
from eomgen.documents.statements import Law, Meaning, Name, Rate, Side, Statement, Step, Table, prose
from eomgen.mechanics.bodies.inertia import BodyEnergy, mass_properties
from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.constraints.ties import Row
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.load import PointForce
from eomgen.model.quaternions import quaternions_of
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import Vector, dot

AXES = "xyz"
ALONG = Law(
    "d/dq_k = sum_i N_ik*d/dq_i", r"\frac{\partial}{\partial q_{k}} = \sum_{i} N_{ik} \frac{\partial}{\partial q_{i}}"
)
WITH = Law("N_ik = dq_i'/dq_k'", r"N_{ik} = \frac{\partial \dot{q}_{i}}{\partial \dot{q}_{k}}")
Pair = tuple[Side, Scalar]


def axes(system: System) -> str:
    """The letters of the axes: xy in the plane."""
    return AXES[:2] if system.scope.model.space == "plane" else AXES


def positions_step(system: System, reader: Reader) -> Step:
    """Where the mass centres are, how the bodies stand, where given forces act."""
    motion = system.motion
    formulas: list[Pair] = []
    for link in motion.links:
        body = mass_properties(system.scope, link.name)
        if not is_zero(body.m):
            at = motion.position((link.name, body.com))
            formulas += component_pairs(system, "", f"{link.name}.center", at)
        if _turns(link):
            formulas.append((Name("angle", link.name), link.angle))  # type: ignore[arg-type]
    for name, point in points_of_forces(system):
        formulas += component_pairs(system, "", name, point)
    angles = ", and the angles of the bodies against the x axis" if any(_turns(link) for link in motion.links) else ""
    return Step("positions", "Positions", (prose(f"The mass centres{angles}:"), *page(reader, formulas)))


def _turns(link: BodyLink) -> bool:
    return isinstance(link.angle, Node)


def component_pairs(system: System, prefix: str, of: str, vector: Vector) -> list[Pair]:
    """One formula for each component; `prefix` is "v" for velocities."""
    return [(Name(prefix + axis, of), x) for axis, x in zip(axes(system), vector, strict=False)]


def points_of_forces(system: System) -> Iterator[tuple[str, Vector]]:
    """(name of the force, where it acts) of every force at a point of a body that has no potential."""
    for force in system.loads.applied:
        if force.potential is None:
            places = [load.place for load in force.loads if isinstance(load, PointForce) and load.place[0] is not None]
            for number, place in enumerate(places, start=1):
                label = force.name if len(places) == 1 else f"{force.name} {number}"
                yield label, system.motion.position(place)


def velocities_step(system: System, reader: Reader, energies: tuple[BodyEnergy, ...]) -> Step:
    """Velocities of the mass centres and angular velocities, by differentiation."""
    formulas: list[Pair] = []
    for energy in energies:
        if not is_zero(mass_properties(system.scope, energy.body).m) and not is_still(energy.velocity):
            of = f"{energy.body}.center"
            formulas += component_pairs(system, "v", of, energy.velocity)
            formulas.append((Name("speed", of, power=2), dot(energy.velocity, energy.velocity)))
        formulas += spins(system, energy.body, energy.spin)
    words = "The derivatives of the positions, and the angular velocities"
    words += ":" if len(axes(system)) == 2 else " about the axes 1, 2, 3 of the bodies:"
    return Step("velocities", "Velocities", (prose(words), *page(reader, formulas)))


def speeds_step(system: System, reader: Reader) -> tuple[Step, ...]:
    """The speeds that are no rates, and the rates of the coordinates in terms of them; no step where there are none."""
    model, scope = system.scope.model, system.scope
    if not model.speeds or system.free is None:
        return ()
    meant = [(u, system.free.scope.names[u.name]) for u in scope.symbols.u if u.name in model.speeds]
    own = {f"{u.name}" for u in scope.symbols.u}
    rates: list[Pair] = [
        (Rate(q), rate)
        for q, rate in zip(scope.symbols.q, scope.rates, strict=True)
        if f"{q.name}'" not in own and not model.coordinates[q.name].driven
    ]
    statements: list[Statement] = [prose("The speeds are combinations of the rates:"), *page(reader, meant)]
    for each in quaternions_of(model):
        words = f"{', '.join(each.coordinates)} is a unit quaternion, and {', '.join(each.speeds)} "
        statements.append(prose(words, f"is the angular velocity of {each.body} against what it hangs on."))
    return (Step("speeds", "Speeds", (*statements, prose("Solved for the rates:"), *page(reader, rates))),)


def is_still(velocity: Vector) -> bool:
    """True where every component is zero."""
    return all(is_zero(x) for x in velocity)


def spins(system: System, body: str, spin: Vector) -> list[Pair]:
    """The angular velocity of a body: one number in the plane; in space its components about the axes of the body.

    They are numbered: omega_x of a body is, wherever it is asked for, the component along the ground's axis.
    """
    if len(axes(system)) == 2:
        return [] if is_zero(spin[2]) else [(Name("omega", body), spin[2])]
    if is_still(spin):
        return []
    return [(Name(f"omega_{axis}", body), x) for axis, x in enumerate(spin, start=1)]


def constraints_step(system: System, reader: Reader) -> tuple[Step, ...]:
    """The constraints: those that the coordinates satisfy, the gaps that must stay zero, and the dependent rates."""
    away = [tie for tie, mode in system.modes.items() if not mode.closed]
    if not system.ties.rows and not away:
        return ()
    satisfied = [row for row in system.ties.rows if row.identical]
    statements: list[Statement] = [
        prose(f"{row.tie}, row {row.number}: satisfied by the coordinates.") for row in satisfied
    ]
    statements += [prose(f"{tie}: open at the start, and left out.") for tie in away]
    held = _held(system)
    if held:
        statements += [prose("These must vanish along the motion:"), *page(reader, held, then=(0,))]
    if system.free is not None and system.elimination is not None:
        statements += _dependent(system, system.free, reader)
    if system.ties.closing:
        statements.append(_multipliers(system))
    return (Step("constraints", "Constraints", tuple(statements)),)


def _held(system: System) -> list[Pair]:
    """Of each row that closes its gap or its rate, every coordinate free."""
    free = system.free or system
    return [_closing(row) for row in free.ties.closing]


def _dependent(system: System, free: System, reader: Reader) -> list[Statement]:
    """The rates of the dependent coordinates, and how derivatives are meant from here on."""
    known = dict(zip((q.name for q in system.symbols.q), system.scope.rates, strict=True))
    parts = system.scope.model.coordinates
    solved = [u for u in free.symbols.u if parts[u.name[:-1]].dependent]
    rates: list[Pair] = [(u, known[u.name[:-1]]) for u in solved]
    return [
        prose("Their time derivatives are linear in the rates. Solved for those of the dependent coordinates:"),
        *page(reader, rates),
        prose("Along the motions that the constraints allow, ", ALONG, ", ", WITH, "."),
    ]


def _multipliers(system: System) -> Table:
    named = zip(system.ties.closing, system.symbols.lam, strict=True)
    rows = tuple(Meaning(lam, f"multiplier of {row.tie}, row {row.number}") for row, lam in named)
    return Table(("multiplier", "meaning", "unit", ""), rows)


def _closing(row: Row) -> Pair:
    name = _gap_name(row)
    return (name, row.gap) if row.gap is not None else (Rate(name), row.velocity)


def _gap_name(row: Row) -> Name:
    return Name("gap", f"{row.tie}, {row.number}")
