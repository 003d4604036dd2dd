"""System -> the derivation by D'Alembert: bodies cut free, their balance with inertia, what is left for the motion.

The equations of the bodies, each taken with the motion that its body makes for a unit of a speed, add up to the
equations of motion: there the reactions do no work and drop out. The rest of them gives the reactions.
"""

from __future__ import annotations

from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.formulations import projection
from eomgen.report import motion_steps, projection_steps
from eomgen.report.balance_steps import body_steps, reactions_table_step
from eomgen.report.equation_steps import EquationSteps, equations_of, sides_of
from eomgen.report.reaction_names import Lettered
from eomgen.report.reading import Reader
from eomgen.report.statements import Formula, Law, Prose, Statement, Step

DROPPED = Law(
    "sum (F + F_in)*dv_C/du_k + (M + M_in)*domega/du_k = 0",
    r"\sum \left(F + F^{\mathrm{in}}\right) \cdot \frac{\partial v_{C}}{\partial u_{k}}"
    r" + \left(M + M^{\mathrm{in}}\right) \cdot \frac{\partial \omega}{\partial u_{k}} = 0",
)


def kinetostatic_steps(
    system: System, reader: Reader, assembly: Assembly, letters: Lettered
) -> tuple[tuple[Step, ...], EquationSteps]:
    """The free bodies and their balance, and the equations of motion that come out of it."""
    own = projection.assembled_by_wrenches(system)
    steps = (
        motion_steps.positions_step(system, reader),
        *motion_steps.speeds_step(system, reader),
        projection_steps.twists_step(system, reader),
        *motion_steps.constraints_step(system, reader),
        reactions_table_step(letters),
        *body_steps(reader, letters),
    )
    words = (
        "Each equation times the velocity of its body for a unit of a speed, all added up, inertia on the left: ",
        "the reactions do no work on these motions and drop out, ",
        DROPPED,
        ":",
    )
    result = equations_of(system, reader, assembly, sides_of(assembly, own.M, own.c, own.Q), words)
    return (*steps, *_multipliers(system, letters)), result


def _multipliers(system: System, letters: Lettered) -> tuple[Step, ...]:
    """What the multipliers are of the ties that the coordinates do not satisfy: their reactions."""
    statements: list[Statement] = []
    for row, lam in zip(system.ties.closing, system.symbols.lam, strict=True):
        reaction = letters.of_row(row)
        if reaction is not None:
            statements.append(Formula((lam, reaction)))
    if not statements:
        return ()
    words = Prose(("Ties that the coordinates do not satisfy stay in the equations of motion by their reactions:",))
    return (Step("multipliers", "Reactions of the ties that close", (words, *statements)),)
