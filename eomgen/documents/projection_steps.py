"""System -> the steps of the projection of Newton-Euler: velocities by twists, M, c and Q as projected wrenches."""

from __future__ import annotations

from eomgen.documents.bounded import page
from eomgen.documents.motion_steps import Pair, component_pairs, is_still, spins
from eomgen.documents.reading import Reader
from eomgen.documents.setting_steps import moved_coordinates
from eomgen.documents.statements import Entry, Formula, Law, Name, Step, prose
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.kinematics import velocity_of
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.symbolic.expression.graph import is_zero

BALANCE = Law(
    "m*a = F, I*epsilon + omega x I*omega = tau",
    r"m a = F, \quad I \varepsilon + \omega \times I \omega = \tau",
)
PROJECTED = Law(
    "sum (m*a - F)*dv/du_k + (I*epsilon + omega x I*omega - tau)*domega/du_k = 0",
    r"\sum \left(m a - F\right) \cdot \frac{\partial v}{\partial u_{k}}"
    r" + \left(I \varepsilon + \omega \times I \omega - \tau\right) \cdot \frac{\partial \omega}{\partial u_{k}} = 0",
)


def twists_step(system: System, reader: Reader) -> Step:
    """Velocities of the mass centres and angular velocities, from body to body along the tree."""
    formulas: list[Pair] = []
    for link in system.motion.links:
        body = mass_properties(system.scope, link.name)
        if not is_zero(body.m):
            velocity = velocity_of(system.motion, (link.name, body.com))
            if not is_still(velocity):
                formulas += component_pairs(system, "v", f"{link.name}.center", velocity)
        formulas += spins(system, link.name, link.twist.w)
    words = "Each body moves with the one it hangs on and by its joint:"
    return Step("velocities", "Velocities", (prose(words), *page(reader, formulas)))


def balance_step(equations: EquationsOfMotion, reader: Reader) -> Step:
    """M, c and Q: the balance of momentum of every body along the motions that the joints allow."""
    u, q = equations.system.symbols.u, moved_coordinates(equations.system)
    inertia: list[Pair] = [
        (Entry("M", u[i], u[j]), equations.M[i][j])
        for i in range(len(u))
        for j in range(i, len(u))
        if not is_zero(equations.M[i][j])
    ]
    inertia += [(Name("c", by=x), c) for x, c in zip(u, equations.c, strict=True)]
    forces: list[Pair] = [(Name("Q", by=x), Q) for x, Q in zip(q, equations.Q, strict=True)]
    statements = (
        prose("For each body ", BALANCE, ". Ideal joints do no work on the motions that they allow, so that"),
        Formula((PROJECTED,)),
        prose("Sorted by accelerations:"),
        *page(reader, inertia),
        *page(reader, forces),
    )
    return Step("balance", "Balance of momentum along the free motions", statements)
