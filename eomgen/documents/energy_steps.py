"""System -> the steps of Lagrange's method: energies, work and generalized forces, the three derivatives."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.documents.bounded import page
from eomgen.documents.motion_steps import Pair, axes, component_pairs
from eomgen.documents.reading import Reader
from eomgen.documents.setting_steps import moved_coordinates
from eomgen.documents.statements import Law, Name, Partial, Rate, Side, Statement, Step, prose
from eomgen.mechanics.bodies.armature import given_energy
from eomgen.mechanics.bodies.inertia import BodyEnergy, armature_energy, body_energies
from eomgen.mechanics.bodies.loads import Applied, JointEffort
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import effort_row, force_row, per_speed
from eomgen.model.forces.load import Couple, Load, PointForce
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import gradient
from eomgen.symbolic.expression.graph import Scalar, is_zero

T, V = Name("T"), Name("V")

KINETIC = Law(
    "T = 1/2*m*v^2 + 1/2*omega*I*omega", r"T = \tfrac{1}{2} m v^{2} + \tfrac{1}{2} \omega^{\mathsf{T}} I \omega"
)
WORK = Law(
    "Q_k = sum F*dr/dq_k - dV/dq_k",
    r"Q_{k} = \sum F \cdot \frac{\partial r}{\partial q_{k}} - \frac{\partial V}{\partial q_{k}}",
)


@dataclass(frozen=True)
class Momenta:
    """The derivatives of the kinetic energy, one entry a speed, each readable where it is short enough.

    Args:
        T: the kinetic energy that was differentiated.
        momenta: dT/du.
        rates: d/dt dT/du, linear in the accelerations.
        held: N^T dT/dq.
    """

    T: Scalar
    momenta: tuple[Scalar, ...]
    rates: tuple[Scalar, ...]
    held: tuple[Scalar, ...]


def momenta_of(system: System, reader: Reader, T: Scalar) -> Momenta:
    """The three derivatives of T for each speed."""
    scope = system.scope
    momenta = reader.short(gradient(T, scope.symbols.u))
    rates = reader.short(scope.with_accelerations(momenta))
    held = reader.short(per_speed(system.motion, gradient(T, scope.symbols.q)))
    return Momenta(T, momenta, rates, held)


def kinetic_energy_step(system: System, reader: Reader, energies: tuple[BodyEnergy, ...], total: Scalar) -> Step:
    """T of each body, then of the whole."""
    formulas = _of_bodies(system, energies)
    if len(formulas) <= 1:
        law = prose(KINETIC if energies else "As it is given", ":")
        return Step("kinetic_energy", "Kinetic energy", (law, *page(reader, [(T, total)])))
    statements = (prose("Of each body ", KINETIC, ":"), *page(reader, formulas), prose("Together:"))
    together = reader.as_sum(total, [x for _, x in formulas])
    return Step("kinetic_energy", "Kinetic energy", (*statements, *page(reader, [(T, together)])))


def _of_bodies(system: System, energies: Sequence[BodyEnergy]) -> list[Pair]:
    """The kinetic energy of each body, of each rotor, and what is given as one."""
    formulas: list[Pair] = []
    for link, energy in zip(system.motion.links, energies, strict=True):
        of_body = energy.translation + energy.rotation
        if not is_zero(of_body):
            formulas.append((Name("T", link.name), of_body))
        rotor = armature_energy(system.motion, link)
        if not is_zero(rotor):
            formulas.append((Name("T", f"{link.name}, rotor"), rotor))
    given = given_energy(system.scope)
    return formulas if is_zero(given) else [*formulas, (Name("T", "given"), given)]


def energies_by_parts(system: System, reader: Reader, T: Scalar) -> tuple[Scalar, Scalar]:
    """(T, V), each as the sum over bodies or forces where that is shorter."""
    bodies = [x for _, x in _of_bodies(system, body_energies(system.motion))]
    V, loads = system.loads.potential_energy, system.loads
    held = [*(force.potential for force in loads.applied), *(effort.potential for effort in loads.efforts)]
    potentials = [reader.as_square(x) for x in held if x is not None and not is_zero(x)]
    return reader.as_sum(T, bodies), reader.as_sum(V, potentials)


def work_step(system: System, reader: Reader, forces: tuple[Scalar, ...]) -> Step:
    """The work of each force, and the generalized forces of everything applied."""
    names = moved_coordinates(system)
    formulas = [f for force in system.loads.applied for f in _force(system, force)]
    formulas += [f for effort in system.loads.efforts for f in _effort(system, effort)]
    formulas = [(name, reader.as_square(x) if _is_potential(name) else x) for name, x in formulas]
    statements: list[Statement] = []
    if not system.loads.applied and not system.loads.efforts:
        statements.append(prose("Nothing is applied."))
    elif names or formulas:
        statements.append(prose("Potentials and virtual work, ", WORK, ":"))
    else:
        statements.append(prose("Nothing is free to move: what is applied enters the reactions alone."))
    statements += page(reader, formulas)
    potentials = [x for name, x in formulas if _is_potential(name)]
    if len(potentials) > 1:
        statements += [prose("The potential energy together:")]
        statements += page(reader, [(V, reader.as_sum(system.loads.potential_energy, potentials))])
    if names:
        statements.append(prose("The generalized forces of everything applied:"))
        statements += page(reader, [(Name("Q", by=q), Q) for q, Q in zip(names, forces, strict=True)])
    return Step("work", "Work and generalized forces", tuple(statements))


def _is_potential(name: Side) -> bool:
    return isinstance(name, Name) and name.letter == "V"


def _force(system: System, force: Applied) -> list[Pair]:
    """The potential of a force, or what it is and its virtual work."""
    if force.potential is not None:
        return [(Name("V", force.name), force.potential)]
    formulas: list[Pair] = []
    for number, load in enumerate(force.loads, start=1):
        formulas += _load(system, load, force.name if len(force.loads) == 1 else f"{force.name} {number}")
    return formulas + _contributions(system, force.name, force_row(system.loads, force))


def _load(system: System, load: Load, name: str) -> list[Pair]:
    if isinstance(load, PointForce) and load.place[0] is not None and load.axes is None:
        return component_pairs(system, "F", name, load.force)
    if isinstance(load, Couple) and len(axes(system)) == 2:
        return [(Name("couple", name), load.couple[2])]
    return []


def _contributions(system: System, name: str, row: tuple[Scalar, ...]) -> list[Pair]:
    names = moved_coordinates(system)
    return [(Name("Q", name, q), x) for q, x in zip(names, row, strict=True) if not is_zero(x)]


def _effort(system: System, effort: JointEffort) -> list[Pair]:
    """A joint's spring, and the virtual work of its drive and damper."""
    name = f"joint of {effort.body}"
    formulas: list[Pair] = [] if is_zero(effort.potential) else [(Name("V", name), effort.potential)]
    if is_zero(effort.drive):
        return formulas
    return formulas + _contributions(system, name, effort_row(system.motion, effort))


def derivatives_step(system: System, reader: Reader, momenta: Momenta) -> Step:
    """dT/du, d/dt dT/du and dT/dq of each speed."""
    formulas: list[Pair] = []
    for k, (u, q) in enumerate(zip(system.symbols.u, moved_coordinates(system), strict=True)):
        momentum = Partial(T, u)
        formulas += [
            (momentum, momenta.momenta[k]),
            (Rate(momentum), momenta.rates[k]),
            (Partial(T, q), momenta.held[k]),
        ]
    return Step("derivatives", "Derivatives of the kinetic energy", page(reader, formulas))
