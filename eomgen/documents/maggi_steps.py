"""System with dependent coordinates -> Maggi's equations: Lagrange's of all coordinates, put together along the ties.

    sum_i N_ik (d/dt dT/dq_i' - dT/dq_i - Q_i) = (J^T lam)_k

They need no T in which the dependent rates were replaced, and hold where ties restrict velocities only.
Source: Neimark & Fufaev, Dynamics of Nonholonomic Systems (1972), chapter III.
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.documents.coefficient_names import with_coefficients_named
from eomgen.documents.energy_steps import Momenta
from eomgen.documents.equation_steps import (
    EquationSteps,
    Sides,
    closing,
    multiplier_forces,
    printed,
    readable_equations,
    taken_in,
)
from eomgen.documents.reading import Reader
from eomgen.documents.statements import Formula, Law, Omitted, Step, prose
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.formulations.lagrange import free_rates
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import ScalarRow

MAGGI = Law(
    "sum_i N_ik*(d/dt(dT/dq_i') - dT/dq_i) = sum_i N_ik*Q_i",
    r"\sum_{i} N_{ik} \left(\frac{d}{dt} \frac{\partial T}{\partial \dot{q}_{i}}"
    r" - \frac{\partial T}{\partial q_{i}}\right) = \sum_{i} N_{ik} Q_{i}",
)
WITH_TIES = Law(MAGGI.text + " + (J^T*lam)_k", MAGGI.latex + r" + \left(J^{\mathsf{T}} \lambda\right)_{k}")


def maggi_equations(
    equations: EquationsOfMotion, free: System, reader: Reader, momenta: Momenta, forces: ScalarRow
) -> EquationSteps | None:
    """The equations in the rates of all coordinates, and what the dependent ones stand for; None where they are long.

    Args:
        momenta, forces: of the free system, one entry a coordinate.
    """
    system = equations.system
    N = jacobian(free_rates(system, free), system.scope.symbols.u)
    inertia = [rate - held for rate, held in zip(momenta.rates, momenta.held, strict=True)]
    columns = list(zip(*N, strict=True))
    ties = multiplier_forces(equations)
    sides = [
        Sides(inner(column, inertia), inner(column, forces) + tie) for column, tie in zip(columns, ties, strict=True)
    ]
    written = readable_equations(reader, equations, sides)
    followers = _followers(system, free, N)
    shown = [(symbol, reader.shown(x)) for symbol, x in followers]
    if written is None or any(isinstance(x, Omitted) for _, x in shown):
        return None
    law = WITH_TIES if equations.J else MAGGI
    words = "Lagrange's equations of all coordinates, put together along the motions that the constraints allow, "
    named = with_coefficients_named(system.scope, written, taken_in(equations))
    statements = (
        prose(words, law, ":"),
        *printed(system, named.equations),
        *closing(reader, equations),
        prose("The dependent coordinates follow, their rates as above:"),
        *map(Formula, shown[len(shown) // 2 :]),
    )
    definitions = tuple((symbol, x) for symbol, x in shown if not isinstance(x, Omitted))
    definitions = (*named.definitions, *definitions)
    steps = (Step("equations", "Equations of motion", statements),)
    return EquationSteps(named.equations, definitions, steps, named.meanings)


def _followers(system: System, free: System, N: Sequence[ScalarRow]) -> list[tuple[Node, Scalar]]:
    """u_d = A u + b, then a_d = A a + A' u + b', in the rates of all coordinates, of each dependent one."""
    rates = dict(zip(free.symbols.u, free_rates(system, free), strict=True))
    dependent = [k for k, u in enumerate(free.symbols.u) if u not in system.symbols.u]
    found = [(free.symbols.u[k], rates[free.symbols.u[k]]) for k in dependent]
    for k in dependent:
        bias = dict(zip(system.symbols.q, system.scope.nu, strict=True))
        own = next(x for q, x in bias.items() if f"{q.name}'" == free.symbols.u[k].name)
        *slopes, drift = free.scope.time_derivative((*N[k], own))
        found.append((free.symbols.a[k], inner(N[k], system.symbols.a) + inner(slopes, system.symbols.u) + drift))
    return found
