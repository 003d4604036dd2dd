"""Equations of motion -> claims that are identities: the same functions by independent routes, exactly.

Energies and their derivatives (Lagrange), twists and wrenches (projection), recursion over the tree.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import METHODS, EquationsOfMotion, System, inverse_residual
from eomgen.mechanics.free_bodies import with_friction
from eomgen.mechanics.kinematics import SystemInertia
from eomgen.proof.check import Check, checked, unchecked
from eomgen.proof.states import States
from eomgen.symbolic.exact import equal_at_real_states, equal_in_field
from eomgen.symbolic.expression import Node, Scalar, gradient, inner, substituted, tangent

Pairs = list[tuple[Scalar, Scalar]]


@dataclass(frozen=True)
class Claim:
    """Identity to prove: pairs of scalars that must be the same function; labels name each pair."""

    name: str
    pairs: Pairs
    labels: Sequence[str]


def identity_checks(
    equations: EquationsOfMotion, derived: EquationsOfMotion | None = None, states: States | None = None
) -> list[Check]:
    """Checks of all identities of equations of motion.

    Args:
        derived: the same equations by the way in which a derivation is written.
        states: real states that come before random ones.
    """
    claims = [rates(equations), *routes(equations), mass_matrix(equations), energy(equations)]
    if derived is not None:
        claims.append(derivation(equations, derived))
    if equations.J:
        claims.append(closing_rows(equations))
    return compared(claims, states)


def compared(claims: Sequence[Claim], states: States | None = None) -> list[Check]:
    """Check of each claim, in a prime field, which proves it at every state; where that fails, at real states.

    Args:
        states: real states that come before random ones.
    """
    checks = list[Check]()
    for claim, verdict in zip(claims, equal_in_field([claim.pairs for claim in claims]), strict=True):
        given = () if states is None else [(place.state for place in supply) for _, supply in states.supplies]
        try:
            found = verdict or equal_at_real_states(claim.pairs, given=given)
        except DerivationError as error:
            checks.append(unchecked(claim.name, error.what, "no state found"))
            continue
        differs = "" if found.culprit is None else f"{claim.labels[found.culprit]} differs"
        how = f"{found.arithmetic}, {found.states} states" if found.states else found.arithmetic
        checks.append(checked(claim.name, differs, how))
    return checks


def rates(equations: EquationsOfMotion) -> Claim:
    """q' = N u + nu are the rates in which everything else is differentiated; x' and x'' in formulas are they."""
    u, scope = equations.symbols.u, equations.system.scope
    rows = [
        sum((n * w for n, w in zip(row, u, strict=True)), start=bias)
        for row, bias in zip(equations.N, equations.nu, strict=True)
    ]
    pairs, labels = list(zip(rows, scope.rates, strict=True)), [q.name for q in equations.symbols.q]
    for name, rate, second in zip(labels, rows, scope.with_accelerations(tuple(rows)), strict=True):
        pairs += [(scope.names[f"{name}'"], rate), (scope.names[f"{name}''"], second)]
    return Claim(
        "N u + nu are the rates of the coordinates", pairs, [*labels, *(x for q in labels for x in (q + "'", q + "''"))]
    )


def routes(equations: EquationsOfMotion) -> Iterable[Claim]:
    """The equations along a motion with any accelerations a: against energies, wrenches and inverse dynamics.

    M a is linear in a, so that at random a a wrong entry of M shows with the chance with which it shows by itself.
    """
    system = equations.system
    symbols, friction = equations.symbols, equations.friction or (0,) * len(equations.Q)
    speeds = [u.name for u in symbols.u]
    Ma = tuple(inner(row, symbols.a) for row in equations.M)
    Q = tuple(x - f for x, f in zip(equations.Q, friction, strict=True))
    labels = [f"{word} [{name}]" for word in ("M a", "c", "Q") for name in speeds]
    for way in dict.fromkeys(METHODS.values()):
        if way.along is not None:
            pairs = _paired((Ma, equations.c, Q), way.along(system))
            yield Claim(f"M a, c and Q agree with those by {way.title}", pairs, labels)
    left = [x - b + f for x, b, f in zip(Ma, equations.forcing, friction, strict=True)]
    pairs = [*zip(left, inverse_residual(system), strict=True)]
    pairs += [(b, x - y) for b, x, y in zip(equations.forcing, equations.Q, equations.c, strict=True)]
    labels = [f"{word} [{name}]" for word in ("M a + c - Q", "forcing") for name in speeds]
    yield Claim("M a + c - Q agrees with inverse dynamics, body by body", pairs, labels)
    if friction != (0,) * len(equations.Q):
        other = with_friction(METHODS["lagrange"].assemble(system)).friction
        yield Claim("friction agrees with that by Lagrange's equations", [*zip(friction, other, strict=True)], speeds)


def derivation(equations: EquationsOfMotion, derived: EquationsOfMotion) -> Claim:
    """The entries of M, c and Q by which a derivation is written are those of the equations that are held."""
    friction, speeds = equations.friction or (0,) * len(equations.Q), [u.name for u in equations.symbols.u]
    Q = tuple(x - f for x, f in zip(equations.Q, friction, strict=True))
    pairs = _paired((*equations.M, equations.c, Q), (*derived.M, derived.c, derived.Q))
    labels = [f"{row} [{name}]" for row in (*(f"M [{name}]" for name in speeds), "c", "Q") for name in speeds]
    return Claim("M, c and Q of the derivation are those of the equations", pairs, labels)


def _paired(own: Iterable[Sequence[Scalar]], other: Iterable[Sequence[Scalar]]) -> Pairs:
    return [pair for rows in zip(own, other, strict=True) for pair in zip(*rows, strict=True)]


def mass_matrix(equations: EquationsOfMotion) -> Claim:
    """M a is the derivative of dT/du along a, and M and its transpose are the same."""
    u, a = equations.symbols.u, equations.symbols.a
    slope = tangent(gradient(equations.T, u), dict(zip(u, a, strict=True)))
    pairs = [*zip((inner(row, a) for row in equations.M), slope, strict=True)]
    pairs += [
        (row[j], equations.M[j][i])
        for i, row in enumerate(equations.M)
        for j in range(i)
        if row[j] is not equations.M[j][i]
    ]
    labels = [f"M a [{x.name}]" for x in u] + ["M or its transpose"] * (len(pairs) - len(u))
    return Claim("M is symmetric and is the second derivative of T", pairs, labels)


def energy(equations: EquationsOfMotion) -> Claim:
    """d/dt(u . dT/du - T + V) = Q_nc . u + (M a + c - Q) . u - dT/dt + dV/dt, at any a.

    With M a = Q - c + J^T lam it is the energy theorem; dT/dt and dV/dt are those by explicit time, states and nu.
    Where dependent rates follow from constraints that depend on time, `_carried_power` is added, and what d/dt
    dT/du gains by masses that change.
    """
    scope, symbols = equations.system.scope, equations.symbols
    power = given_power(equations)
    for k, u in enumerate(symbols.u):
        inertia = sum((equations.M[k][j] * a for j, a in enumerate(symbols.a)), start=equations.c[k])
        power = power + u * (inertia - equations.Q[k])
    H = energy_function(equations)
    left = scope.with_accelerations((H,))[0]
    return Claim("the energy theorem holds along every motion", [(left, power)], ["dH/dt"])


def energy_function(equations: EquationsOfMotion) -> Scalar:
    """H = u . dT/du - T + V, which is T + V where nothing moves by itself."""
    momenta = gradient(equations.T, equations.symbols.u)
    return sum((p * u for p, u in zip(momenta, equations.symbols.u, strict=True)), start=equations.V - equations.T)


def given_power(equations: EquationsOfMotion) -> Scalar:
    """dH/dt without the constraints' power u . J^T lam: Q_nc . u - dT/dt + dV/dt by explicit time and nu."""
    system = equations.system
    speeds = equations.symbols.u
    friction = equations.friction or (0,) * len(speeds)
    powered = tuple(a + b for a, b in zip(system.loads.powered_forces, friction, strict=True))
    power = tangent((equations.V - equations.T,), _own_motion(system.scope))[0] + _carried_power(system)
    power = power + inner(speeds, SystemInertia(system.motion).carried_momenta)
    return sum((u * Q for u, Q in zip(speeds, powered, strict=True)), start=power)


def _carried_power(system: System) -> Scalar:
    """p . ((N u)' along nu and t - nu' along N u), p the momenta of the free system: 0 where nothing moves by itself.

    The motions N u and those by themselves do not commute where rolling constraints carry dependent coordinates along.
    """
    if system.free is None:
        return 0
    scope, free = system.scope, system.free.scope.symbols.u
    rates = system.free_rates(system.free)
    carried = substituted(rates, dict.fromkeys(scope.symbols.u, 0))
    own = tuple(rate - part for rate, part in zip(rates, carried, strict=True))
    along = {q: rate - bias for q, rate, bias in zip(scope.symbols.q, scope.rates, scope.nu, strict=True)}
    apart = zip(tangent(own, _own_motion(scope)), tangent(carried, along), strict=True)
    differences = [a - b for a, b in apart]
    momenta = gradient(SystemInertia(system.free.motion).kinetic_energy, free)
    power = sum((p * x for p, x in zip(momenta, differences, strict=True)), start=0)
    return substituted((power,), dict(zip(free, rates, strict=True)))[0]


def _own_motion(scope: Any) -> dict[Node, Scalar]:
    """Derivatives by time at zero speeds: 1 for time, nu for the coordinates, z' for the states."""
    states = dict(zip(scope.symbols.z, scope.state_rates, strict=True))
    return {scope.symbols.t: 1, **dict(zip(scope.symbols.q, scope.nu, strict=True)), **states}


def closing_rows(equations: EquationsOfMotion) -> Claim:
    """J u + sigma = dphi/dt where there is a gap, and J a + gamma its derivative."""
    scope, symbols = equations.system.scope, equations.symbols
    pairs, labels = [], []
    for i, phi in enumerate(equations.phi):
        row = sum((x * u for x, u in zip(equations.J[i], symbols.u, strict=True)), start=equations.sigma[i])
        pairs.append((row, equations.system.constraints.closing[i].velocity))
        labels.append(f"J u + sigma of row {i + 1}")
        if phi is not None:
            pairs.append((row, scope.time_derivative((phi,))[0]))
            labels.append(f"the gap of row {i + 1}")
        second = sum((x * a for x, a in zip(equations.J[i], symbols.a, strict=True)), start=equations.gamma[i])
        pairs.append((second, scope.with_accelerations((row,))[0]))
        labels.append(f"J a + gamma of row {i + 1}")
    return Claim("the constraint rows are the derivatives of their gaps", pairs, labels)
