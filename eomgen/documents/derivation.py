"""Equations of motion -> Document: the way to the equations of motion, step by step, as a teacher would write it."""

from __future__ import annotations

from dataclasses import replace

from eomgen.documents import energy_steps, motion_steps
from eomgen.documents.document import Document, document_of, with_symbols
from eomgen.documents.energy_steps import MAGGI, Momenta, balance_step, integral_steps, maggi_equations, twists_step
from eomgen.documents.equation_steps import EquationSteps, Sides, equations_of, multiplier_forces, sides_of
from eomgen.documents.motion_steps import setting_steps, states_step
from eomgen.documents.reaction_steps import (
    along_the_motion,
    kinetostatic_steps,
    letters_of,
    reactions_step,
    reactions_table_step,
)
from eomgen.documents.reaction_values import Lettered, lettered
from eomgen.documents.reading import Reader, Written, with_coefficients_throughout, with_parts_named, with_roots_named
from eomgen.documents.statements import Formula, Law, Prose, Step, notation_step
from eomgen.documents.text import prose_text, side_text
from eomgen.mechanics.dynamics import EquationsOfMotion, System, derived_by, inertia_by_energies
from eomgen.mechanics.free_bodies import Reactions
from eomgen.mechanics.kinematics import BodyEnergy, SystemInertia
from eomgen.proof import Printed
from eomgen.symbolic.exact import equal_at_random_states
from eomgen.symbolic.expression import Node, Scalar
from eomgen.symbolic.print import text_size

LAGRANGE = Law(
    "d/dt(dT/dq_k') - dT/dq_k = Q_k",
    r"\frac{d}{dt} \frac{\partial T}{\partial \dot{q}_{k}} - \frac{\partial T}{\partial q_{k}} = Q_{k}",
)
MATRICES = Law("M*a + c = Q", r"M a + c = Q")
LAGRANGE_WITH_CONSTRAINTS = Law(
    f"{LAGRANGE.text} + (J^T*lam)_k", LAGRANGE.latex + r" + \left(J^{\mathsf{T}} \lambda\right)_{k}"
)
MATRICES_WITH_CONSTRAINTS = Law(f"{MATRICES.text} + J^T*lam", MATRICES.latex + r" + J^{\mathsf{T}} \lambda")

FROM_THE_START = frozenset(("data", "freedom", "coordinates", "constraints", "along", "laws"))
"""Steps whose formulas hold on the motion from the start alone, or define what the others use."""
SHORT = 900  # characters of the derivatives of T that are printed where rates of dependent coordinates stand in them


def derivation_of(
    equations: EquationsOfMotion,
    method: str,
    *,
    full: bool = False,
    in_time: EquationsOfMotion | None = None,
    reactions: bool = True,
) -> Document:
    """The derivation of the equations of motion of a system.

    By "lagrange" the energies are differentiated in the form in which they are printed, so that each step follows
    from the one before; by "projection" the balance of momentum of every body is projected on its free motions.
    Equations that are too long to print are replaced by their size, unless `full` is set.

    Args:
        equations: those that a user gets; printed with named sub-expressions where the method's own are long.
        full: everything is printed, however long, the long and the repeated parts with names of their own.
        in_time: the same with all that is driven as functions of time; None: they are so.
        reactions: those of joints and constraints follow at the end.
    """
    system = equations.system
    model = system.scope.model
    reader = Reader(full=full, gathers=model.space == "space", positive=system.scope.positive)
    letters = letters_of(system)
    steps, result = _by_method(equations, reader, method, letters)
    known = method == "kinetostatic" or bool(equations.friction)  # the table of the reactions stands further up
    last = reactions_step(equations, reader, letters, table=not known) if reactions else ()
    if method == "kinetostatic" and not isinstance(letters, str):
        last = (*last, *along_the_motion(equations, reader, letters))
    last = (*integral_steps(equations, reader, in_time), *last)
    written = Written(
        (*setting_steps(system), *steps, *result.steps, *states_step(system, reader), *last),
        result.equations,
        result.definitions,
    )
    graph, taken = equations.symbols.graph, {*system.scope.names, *(symbol.name for symbol, _ in result.definitions)}
    taken |= set() if isinstance(letters, str) else letters.names
    written = with_coefficients_throughout(written, result.coefficients)
    written = with_roots_named(written, graph, taken, reader.roots)
    if full:
        written = with_parts_named(written, graph, taken, reader.raw)
    notation = notation_step(written.steps, system.scope.names, result.meanings)
    declared = {} if isinstance(letters, str) else letters.declared
    document = with_symbols(document_of(model, method, (*written.steps, notation)), declared)
    return replace(document, equations=written.equations, definitions=written.definitions)


def _by_method(
    equations: EquationsOfMotion, reader: Reader, method: str, letters: Lettered | str
) -> tuple[tuple[Step, ...], EquationSteps]:
    """The method's own steps, and its equations of motion.

    Raises:
        DerivationError: by "kinetostatic", where the reactions cannot carry the motion.
    """
    system = equations.system
    if method == "kinetostatic":
        if isinstance(letters, str):
            letters = lettered(Reactions.of(system.free or system), system.scope.names)  # raises what it says
        return kinetostatic_steps(equations, reader, letters)
    steps, result = _BY_METHOD[method](equations, reader)
    if equations.friction and not isinstance(letters, str):
        steps = (*steps, reactions_table_step(letters))
    return steps, result


def _lagrange(equations: EquationsOfMotion, reader: Reader) -> tuple[tuple[Step, ...], EquationSteps]:
    """Derivation by the energies; by Maggi's equations where dependent rates make those long or are nonholonomic.

    Speeds that are no rates have no equation of Lagrange's: there the balances are projected (Kane's way).
    """
    system = equations.system
    if system.scope.model.speeds:
        return _projection(equations, reader)
    if system.free is None:
        return _by_energies(equations, reader)
    if _is_integrable(equations):
        momenta = energy_steps.momenta_of(system, reader, _whole(system, reader, SystemInertia(system.motion).bodies))
        if sum(text_size(x) for x in (*momenta.momenta, *momenta.rates, *momenta.held)) <= SHORT:
            return _by_energies(equations, reader)
    return _by_maggi(equations, system.free, reader)


def _is_integrable(equations: EquationsOfMotion) -> bool:
    """True if Lagrange's equations hold in the independent speeds alone, as they do with holonomic constraints."""
    _, c = inertia_by_energies(equations.system.motion, SystemInertia(equations.system.motion).kinetic_energy)
    return equal_at_random_states(zip(c, equations.c, strict=True)).equal


def _by_energies(equations: EquationsOfMotion, reader: Reader) -> tuple[tuple[Step, ...], EquationSteps]:
    system = equations.system
    energies = SystemInertia(system.motion).bodies
    T = _whole(system, reader, energies)
    momenta = energy_steps.momenta_of(system, reader, T)
    forces = reader.short_with_symbols(system.loads.generalized_forces)
    velocities = (motion_steps.velocities_step(system, reader, energies),) if energies else ()
    constraints = motion_steps.constraints_step(system, reader)
    steps = (
        *((motion_steps.positions_step(system, reader),) if energies else ()),
        *((*velocities, *constraints) if system.free is None else (*constraints, *velocities)),
        energy_steps.kinetic_energy_step(system, reader, energies, T),
        energy_steps.work_step(system, reader, forces),
    )
    if momenta.momenta:
        steps = (*steps, energy_steps.derivatives_step(system, reader, momenta))
    sides = _lagrange_sides(equations, momenta, forces)
    law = LAGRANGE_WITH_CONSTRAINTS if equations.J else LAGRANGE
    return steps, equations_of(equations, reader, sides, ("Lagrange's equations ", law, ":"))


def _by_maggi(equations: EquationsOfMotion, free: System, reader: Reader) -> tuple[tuple[Step, ...], EquationSteps]:
    """Lagrange's equations as if all coordinates were free, put together along the motions that the constraints
    allow."""
    system = equations.system
    energies = SystemInertia(free.motion).bodies
    T = _whole(free, reader, energies)
    momenta = energy_steps.momenta_of(free, reader, T)
    forces = reader.short_with_symbols(free.loads.generalized_forces)
    steps = (
        motion_steps.positions_step(system, reader),
        motion_steps.velocities_step(free, reader, energies),
        *motion_steps.constraints_step(system, reader),
        energy_steps.kinetic_energy_step(free, reader, energies, T),
        energy_steps.work_step(free, reader, forces),
        energy_steps.derivatives_step(free, reader, momenta),
    )
    result = None if equations.friction else maggi_equations(equations, free, reader, momenta, forces)
    if result is None:
        own = derived_by("lagrange", system)
        rule = ("Put together along the motions that the constraints allow, ", MAGGI, ":")
        result = equations_of(equations, reader, sides_of(equations, own.M, own.c, own.Q), rule)
    return steps, result


def _whole(system: System, reader: Reader, energies: tuple[BodyEnergy, ...]) -> Scalar:
    """T of the whole, readable where it is short enough."""
    total = SystemInertia(system.motion).given_energy
    for link, energy in zip(system.motion.links, energies, strict=True):
        total = total + energy.translation + energy.rotation + SystemInertia(system.motion).rotor_energy(link)
    return reader.short((total,))[0]


def _lagrange_sides(equations: EquationsOfMotion, momenta: Momenta, forces: tuple[Scalar, ...]) -> list[Sides]:
    """d/dt dT/du - N^T dT/dq = Q + J^T lam"""
    constraints = multiplier_forces(equations)
    rows = zip(momenta.rates, momenta.held, forces, constraints, strict=True)
    return [Sides(rate - held, force + constraint) for rate, held, force, constraint in rows]


def _projection(equations: EquationsOfMotion, reader: Reader) -> tuple[tuple[Step, ...], EquationSteps]:
    system = equations.system
    own = derived_by("projection", system)
    steps: tuple[Step, ...] = (
        motion_steps.positions_step(system, reader),
        *motion_steps.speeds_step(system, reader),
        twists_step(system, reader),
        *motion_steps.constraints_step(system, reader),
    )
    if own.Q:
        steps = (*steps, balance_step(own, reader))
    sides = sides_of(equations, own.M, own.c, own.Q)
    law = MATRICES_WITH_CONSTRAINTS if equations.J else MATRICES
    return steps, equations_of(equations, reader, sides, ("The equations ", law, ":"))


_BY_METHOD = {"lagrange": _lagrange, "projection": _projection}


def printed_formulas(document: Document) -> Printed:
    """The formulas that hold at any state, and the stated first integrals, as they are printed."""
    formulas: list[tuple[str, ...]] = []
    constants: list[tuple[str, str]] = []
    laws = [x for step in document.steps if step.key == "laws" for x in step.statements if isinstance(x, Formula)]
    for step in (step for step in document.steps if step.key not in FROM_THE_START):
        while_ = ""
        for statement in step.statements:
            if isinstance(statement, Prose):
                while_ = prose_text(statement).rstrip(":.").partition(" while ")[2]
            if not isinstance(statement, Formula):
                continue
            sides = tuple(map(side_text, statement.sides))
            if step.key == "integrals" and type(statement.sides[0]) is not Node:  # a symbol is a part of what follows
                constants.append((sides[-1], while_))
            else:
                formulas.append(sides)
    reported = tuple((side_text(x.sides[0]), side_text(x.sides[-1])) for x in laws)
    return Printed(tuple(formulas), tuple(constants), laws=reported)
