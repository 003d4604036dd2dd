"""System, Assembly -> Derivation: the way to the equations of motion, step by step, as a teacher would write it."""

from __future__ import annotations

from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.formulations import projection
from eomgen.mechanics.inertia import BodyEnergy, armature_energy, body_energies
from eomgen.mechanics.system import System
from eomgen.mechanics.work import generalized_forces
from eomgen.report import energy_steps, motion_steps, projection_steps
from eomgen.report.energy_steps import Momenta
from eomgen.report.equation_steps import Result, Sides, equations_of, multiplier_forces, sides_of
from eomgen.report.naming import Written, with_parts_named, with_roots_named
from eomgen.report.notation import notation_step
from eomgen.report.reading import Reader
from eomgen.report.setting_steps import setting_steps
from eomgen.report.statements import Derivation, Law, Step
from eomgen.symbolic.graph import Scalar

LAGRANGE = Law(
    "d/dt(dT/dq_k') - dT/dq_k = Q_k",
    r"\frac{d}{dt} \frac{\partial T}{\partial \dot{q}_{k}} - \frac{\partial T}{\partial q_{k}} = Q_{k}",
)
MATRICES = Law("M*a + c = Q", r"M a + c = Q")
LAGRANGE_WITH_TIES = Law(
    f"{LAGRANGE.text} + (J^T*lam)_k", LAGRANGE.latex + r" + \left(J^{\mathsf{T}} \lambda\right)_{k}"
)
MATRICES_WITH_TIES = Law(f"{MATRICES.text} + J^T*lam", MATRICES.latex + r" + J^{\mathsf{T}} \lambda")


def derivation_of(system: System, assembly: Assembly, method: str, *, full: bool = False) -> Derivation:
    """The derivation of the equations of motion of a system.

    By "lagrange" the energies are differentiated in the form in which they are printed, so that each step follows
    from the one before; by "projection" the balance of momentum of every body is projected on its free motions.
    What is too long to print is said to be so, with its size, unless `full`.

    Args:
        assembly: the equations that a user gets; printed with named sub-expressions where the method's own are long.
        full: everything is printed, however long, the long and the repeated parts with names of their own.
    """
    reader, model = Reader(full=full), system.scope.model
    steps, result = _BY_METHOD[method](system, reader, assembly)
    written = Written((*setting_steps(system), *steps, *result.steps), result.equations, result.definitions)
    graph, taken = assembly.symbols.graph, {*system.scope.names, *(symbol.name for symbol, _ in result.definitions)}
    written = with_roots_named(written, graph, taken, reader.roots)
    if full:
        written = with_parts_named(written, graph, taken, reader.raw)
    return Derivation(
        model.name, model.about or "", model.source or "", model.space, method,
        (*written.steps, notation_step(written.steps, system.scope.names)), written.equations, written.definitions,
    )  # fmt: skip


def _lagrange(system: System, reader: Reader, assembly: Assembly) -> tuple[tuple[Step, ...], Result]:
    energies = body_energies(system.motion)
    T = _whole(system, reader, energies)
    momenta = energy_steps.momenta_of(system, reader, T)
    forces = reader.short_with_symbols(generalized_forces(system.loads))
    steps = (
        motion_steps.positions_step(system, reader),
        motion_steps.velocities_step(system, reader, energies),
        *motion_steps.constraints_step(system, reader),
        energy_steps.kinetic_energy_step(system, reader, energies, T),
        energy_steps.work_step(system, reader, forces),
    )
    if momenta.momenta:
        steps = (*steps, energy_steps.derivatives_step(system, reader, momenta))
    sides = _lagrange_sides(assembly, momenta, forces)
    law = LAGRANGE_WITH_TIES if assembly.J else LAGRANGE
    return steps, equations_of(system, reader, assembly, sides, ("Lagrange's equations ", law, ":"))


def _whole(system: System, reader: Reader, energies: tuple[BodyEnergy, ...]) -> Scalar:
    """T of the whole, readable where it is short enough."""
    total: Scalar = 0
    for link, energy in zip(system.motion.links, energies, strict=True):
        total = total + energy.translation + energy.rotation + armature_energy(system.motion, link)
    return reader.short((total,))[0]


def _lagrange_sides(assembly: Assembly, momenta: Momenta, forces: tuple[Scalar, ...]) -> list[Sides]:
    """d/dt dT/du - N^T dT/dq = Q + J^T lam"""
    ties = multiplier_forces(assembly)
    rows = zip(momenta.rates, momenta.held, forces, ties, strict=True)
    return [Sides(rate - held, force + tie) for rate, held, force, tie in rows]


def _projection(system: System, reader: Reader, assembly: Assembly) -> tuple[tuple[Step, ...], Result]:
    own = projection.assemble(system)
    steps: tuple[Step, ...] = (
        motion_steps.positions_step(system, reader),
        projection_steps.twists_step(system, reader),
        *motion_steps.constraints_step(system, reader),
    )
    if own.Q:
        steps = (*steps, projection_steps.balance_step(system, reader, own))
    sides = sides_of(assembly, own.M, own.c, own.Q)
    law = MATRICES_WITH_TIES if assembly.J else MATRICES
    return steps, equations_of(system, reader, assembly, sides, ("The equations ", law, ":"))


_BY_METHOD = {"lagrange": _lagrange, "projection": _projection}
