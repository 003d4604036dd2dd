"""System, Assembly -> checks that are identities: the same functions by independent routes, exactly.

Energies and their derivatives (Lagrange), twists and wrenches (projection), recursion over the tree.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.formulations import ALL
from eomgen.mechanics.formulations.lagrange import free_rates
from eomgen.mechanics.friction import with_friction
from eomgen.mechanics.inertia import kinetic_energy
from eomgen.mechanics.system import System
from eomgen.mechanics.work import powered_forces, total
from eomgen.proof.check import Check, checked, unchecked
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivative import gradient, jacobian, substituted, tangent
from eomgen.symbolic.expression.graph import Node, Scalar

Pairs = list[tuple[Scalar, Scalar]]


def _compared(name: str, pairs: Pairs, labels: Sequence[str]) -> Check:
    """A check that the two of each pair are the same function."""
    try:
        verdict = equal_at_random_states(pairs)
    except DerivationError as error:
        return unchecked(name, error.what, "no state found")
    differs = "" if verdict.culprit is None else f"{labels[verdict.culprit]} differs"
    return checked(name, differs, verdict.arithmetic)


def rates(system: System, assembly: Assembly) -> Check:
    """q' = N u + nu are the rates in which everything else is differentiated."""
    u = assembly.symbols.u
    rows = [
        sum((n * w for n, w in zip(row, u, strict=True)), start=bias)
        for row, bias in zip(assembly.N, assembly.nu, strict=True)
    ]
    pairs = list(zip(rows, system.scope.rates, strict=True))
    return _compared("N u + nu are the rates of the coordinates", pairs, [q.name for q in assembly.symbols.q])


def routes(system: System, assembly: Assembly) -> Iterable[Check]:
    """The equations against each formulation's own M, c, Q."""
    speeds = [u.name for u in assembly.symbols.u]
    for formulation in ALL:
        if not formulation.applies(system):
            continue
        other = with_friction(system, formulation.assemble(system))
        pairs, labels = [], []
        for i, name in enumerate(speeds):
            pairs += [(assembly.M[i][j], other.M[i][j]) for j in range(len(speeds))]
            labels += [f"M[{name}, {column}]" for column in speeds]
            pairs += [(assembly.c[i], other.c[i]), (assembly.Q[i], other.Q[i])]
            labels += [f"c[{name}]", f"Q[{name}]"]
            pairs += [(assembly.forcing[i], other.forcing[i])]
            labels += [f"Q - c [{name}]"]
        yield _compared(f"M, c and Q agree with those by {formulation.title}", pairs, labels)


def mass_matrix(assembly: Assembly) -> Check:
    u = assembly.symbols.u
    curvature = jacobian(gradient(assembly.T, u), u)
    pairs, labels = [], []
    for i, row in enumerate(assembly.M):
        for j in range(i + 1):
            pairs += [(row[j], assembly.M[j][i]), (row[j], curvature[i][j])]
            labels += [f"M[{u[i].name}, {u[j].name}]"] * 2
    return _compared("M is symmetric and is the second derivative of T", pairs, labels)


def energy(system: System, assembly: Assembly) -> Check:
    """d/dt(u . dT/du - T + V) = Q_nc . u + (M a + c - Q) . u - dT/dt + dV/dt, at any a.

    With M a = Q - c + J^T lam it is the energy theorem; dT/dt and dV/dt are of what moves by itself. Where dependent
    rates follow from ties that move by themselves, what `_carried_power` says comes in addition.
    """
    scope, symbols = system.scope, assembly.symbols
    momenta = gradient(assembly.T, symbols.u)
    H = sum((p * u for p, u in zip(momenta, symbols.u, strict=True)), start=assembly.V - assembly.T)
    powered = total([powered_forces(system.loads), assembly.friction or (0,) * len(symbols.u)], len(symbols.u))
    power: Scalar = tangent((assembly.V - assembly.T,), _own_motion(scope))[0]
    for k, u in enumerate(symbols.u):
        inertia = sum((assembly.M[k][j] * a for j, a in enumerate(symbols.a)), start=assembly.c[k])
        power = power + u * (inertia - assembly.Q[k] + powered[k])
    left = scope.with_accelerations((H,))[0]
    power = power + _carried_power(system)
    return _compared("the energy theorem holds along every motion", [(left, power)], ["dH/dt"])


def _carried_power(system: System) -> Scalar:
    """p . ((N u)' along nu and t - nu' along N u), p the momenta of the free system: 0 where nothing moves by itself.

    The motions N u and those by themselves do not commute where rolling ties carry dependent coordinates along.
    """
    if system.free is None:
        return 0
    scope, free = system.scope, system.free.scope.symbols.u
    rates = free_rates(system, system.free)
    carried = substituted(rates, dict.fromkeys(scope.symbols.u, 0))
    own = tuple(rate - part for rate, part in zip(rates, carried, strict=True))
    along = {q: rate - bias for q, rate, bias in zip(scope.symbols.q, scope.rates, scope.nu, strict=True)}
    apart = zip(tangent(own, _own_motion(scope)), tangent(carried, along), strict=True)
    differences = [a - b for a, b in apart]
    momenta = gradient(kinetic_energy(system.free.motion), free)
    power = sum((p * x for p, x in zip(momenta, differences, strict=True)), start=0)
    return substituted((power,), dict(zip(free, rates, strict=True)))[0]


def _own_motion(scope: Any) -> dict[Node, Scalar]:
    """What moves by itself: time, and the coordinates along nu."""
    return {scope.symbols.t: 1, **dict(zip(scope.symbols.q, scope.nu, strict=True))}


def closing_rows(system: System, assembly: Assembly) -> Check:
    """J u + sigma = dphi/dt where there is a gap, and J a + gamma its derivative."""
    scope, symbols = system.scope, assembly.symbols
    pairs, labels = [], []
    for i, phi in enumerate(assembly.phi):
        row = sum((x * u for x, u in zip(assembly.J[i], symbols.u, strict=True)), start=assembly.sigma[i])
        pairs.append((row, system.ties.closing[i].velocity))
        labels.append(f"J u + sigma of row {i + 1}")
        if phi is not None:
            pairs.append((row, scope.time_derivative((phi,))[0]))
            labels.append(f"the gap of row {i + 1}")
        second = sum((x * a for x, a in zip(assembly.J[i], symbols.a, strict=True)), start=assembly.gamma[i])
        pairs.append((second, scope.with_accelerations((row,))[0]))
        labels.append(f"J a + gamma of row {i + 1}")
    return _compared("the closing rows are the derivatives of their gaps", pairs, labels)
