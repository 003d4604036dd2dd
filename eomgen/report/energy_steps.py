"""System -> the steps of Lagrange's method: energies, work and generalized forces, the three derivatives."""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.mechanics.inertia import BodyEnergy, armature_energy
from eomgen.mechanics.loads import Applied, JointEffort
from eomgen.mechanics.system import System
from eomgen.mechanics.work import effort_row, force_row, generalized_forces, per_speed
from eomgen.model.forces.load import Couple, Load, PointForce
from eomgen.report.bounded import page
from eomgen.report.motion_steps import axes, components
from eomgen.report.reading import read, shown
from eomgen.report.setting_steps import moved_coordinates
from eomgen.report.statements import Formula, Law, Name, Partial, Prose, Rate, Side, Statement, Step
from eomgen.symbolic.derivative import gradient
from eomgen.symbolic.graph import Scalar, is_zero

T, V = Name("T"), Name("V")

KINETIC = Law(
    "T = 1/2*m*v^2 + 1/2*omega*I*omega", r"T = \tfrac{1}{2} m v^{2} + \tfrac{1}{2} \omega^{\mathsf{T}} I \omega"
)
WORK = Law("Q_k = sum F*dr/dq_k - dV/dq_k",
           r"Q_{k} = \sum F \cdot \frac{\partial r}{\partial q_{k}} - \frac{\partial V}{\partial q_{k}}")  # fmt: skip


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


def momenta_of(system: System, T: Scalar) -> Momenta:
    """The three derivatives of T for each speed."""
    scope = system.scope
    momenta = _short(gradient(T, scope.symbols.u))
    rates = _short(scope.with_accelerations(momenta))
    held = _short(per_speed(system.motion, gradient(T, scope.symbols.q)))
    return Momenta(T, momenta, rates, held)


def _short(scalars: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
    """Each in its readable form, or as it is."""
    return tuple(x if (short := read(x)) is None else short for x in scalars)


def kinetic_energy_step(system: System, energies: tuple[BodyEnergy, ...], total: Scalar) -> Step:
    """T of each body, then of the whole."""
    formulas = []
    for link, energy in zip(system.motion.links, energies, strict=True):
        of_body = energy.translation + energy.rotation
        if not is_zero(of_body):
            formulas.append(Formula((Name("T", link.name), shown(of_body))))
        rotor = armature_energy(system.motion, link)
        if not is_zero(rotor):
            formulas.append(Formula((Name("T", f"{link.name}, rotor"), shown(rotor))))
    statements = (Prose(("Of each body ", KINETIC, ":")), *page(formulas), Prose(("Together:",)))
    return Step("kinetic_energy", "Kinetic energy", (*statements, *page([Formula((T, shown(total)))])))


def work_step(system: System, forces: tuple[Scalar, ...]) -> Step:
    """The work of each force, and the generalized forces of everything applied."""
    statements: list[Statement] = []
    if not system.loads.applied and not system.loads.efforts:
        statements.append(Prose(("Nothing is applied.",)))
    else:
        statements.append(Prose(("Potentials and virtual work, ", WORK, ":")))
    formulas = [f for force in system.loads.applied for f in _force(system, force)]
    formulas += [f for effort in system.loads.efforts for f in _effort(system, effort)]
    statements += page(formulas)
    if any(force.potential is not None for force in system.loads.applied) or _elastic(system):
        statements += [Prose(("The potential energy together:",))]
        statements += page([Formula((V, shown(system.loads.potential_energy)))])
    names = moved_coordinates(system)
    if names:
        statements.append(Prose(("The generalized forces of everything applied:",)))
        statements += page(Formula((Name("Q", by=q), shown(Q))) for q, Q in zip(names, forces, strict=True))
    return Step("work", "Work and generalized forces", tuple(statements))


def generalized_forces_of(system: System) -> tuple[Scalar, ...]:
    """Q, readable where it is short enough."""
    return _short(generalized_forces(system.loads))


def _elastic(system: System) -> bool:
    return any(not is_zero(effort.potential) for effort in system.loads.efforts)


def _force(system: System, force: Applied) -> list[Formula]:
    """The potential of a force, or what it is and its virtual work."""
    if force.potential is not None:
        return [Formula((Name("V", force.name), shown(force.potential)))]
    formulas = [f for number, load in enumerate(force.loads, start=1)
                for f in _load(system, load, force.name if len(force.loads) == 1 else f"{force.name} {number}")]  # fmt: skip
    return formulas + _contributions(system, force.name, force_row(system.loads, force))


def _load(system: System, load: Load, name: str) -> list[Formula]:
    if isinstance(load, PointForce) and load.place[0] is not None and load.axes is None:
        return components(system, "F", name, load.force)
    if isinstance(load, Couple) and len(axes(system)) == 2:
        return [Formula((Name("couple", name), shown(load.couple[2])))]
    return []


def _contributions(system: System, name: str, row: tuple[Scalar, ...]) -> list[Formula]:
    names = moved_coordinates(system)
    return [Formula((Name("Q", name, q), shown(x))) for q, x in zip(names, row, strict=True) if not is_zero(x)]


def _effort(system: System, effort: JointEffort) -> list[Formula]:
    """A joint's spring, and the virtual work of its drive and damper."""
    name = f"joint of {effort.body}"
    formulas = [] if is_zero(effort.potential) else [Formula((Name("V", name), shown(effort.potential)))]
    if is_zero(effort.drive):
        return formulas
    return formulas + _contributions(system, name, effort_row(system.motion, effort))


def derivatives_step(system: System, momenta: Momenta) -> Step:
    """dT/du, d/dt dT/du and dT/dq of each speed."""
    formulas = []
    for k, (u, q) in enumerate(zip(system.symbols.u, moved_coordinates(system), strict=True)):
        momentum = Partial(T, u)
        rows: tuple[tuple[Side, Scalar], ...] = (
            (momentum, momenta.momenta[k]), (Rate(momentum), momenta.rates[k]), (Partial(T, q), momenta.held[k]),
        )  # fmt: skip
        formulas += [Formula((name, shown(x))) for name, x in rows]
    return Step("derivatives", "Derivatives of the kinetic energy", page(formulas))
