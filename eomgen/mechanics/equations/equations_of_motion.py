"""What every formulation gives: the equations of motion of a system, as graph scalars."""

from __future__ import annotations

from eomgen.mechanics.constraints.freedom import rows_alike
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.symbols import Symbols


@dataclass(frozen=True)
class EquationsOfMotion:
    """The equations of motion: q' = N u + nu,  M a + c = Q + J^T lam,  J a + gamma = 0.

    Args:
        system: whose motion, loads and ties they are put together from.
        N, nu: kinematic matrix, nq rows of nu entries, and bias, nq.
        M: mass matrix, nu rows of nu entries.
        c: inertia terms left when a = 0, nu.
        Q: generalized forces of everything applied, nu.
        forcing: Q - c, nu (of its own: it can be cheaper than the difference).
        J, sigma, gamma: closing rows, k rows of nu entries; velocity bias, k; acceleration bias, k.
        phi: gaps, k (None for a row that has none).
        T, V: kinetic and potential energy [J].
        accelerations: a as explicit expressions where the formulation gives them (articulated body), else None.
        friction: the part of Q that contacts with friction make, nu; () where there is no friction.
        alike: of each closing row a number that it has with those that share what they hold (`rows_alike`); () of few.
    """

    system: System
    N: tuple[ScalarRow, ...]
    nu: ScalarRow
    M: tuple[ScalarRow, ...]
    c: ScalarRow
    Q: ScalarRow
    forcing: ScalarRow
    J: tuple[ScalarRow, ...]
    sigma: ScalarRow
    gamma: ScalarRow
    phi: tuple[Scalar | None, ...]
    T: Scalar
    V: Scalar
    accelerations: ScalarRow | None = None
    friction: ScalarRow = ()
    alike: tuple[int, ...] = ()

    def __repr__(self) -> str:
        name = self.system.scope.model.name
        return f"<equations of motion of {name!r}: {len(self.M)} speeds, {len(self.J)} closing rows>"

    @property
    def symbols(self) -> Symbols:
        """The symbols in which everything is written."""
        return self.system.symbols

    @property
    def residual(self) -> tuple[ScalarRow, ScalarRow]:
        """(M a - forcing - J^T lam, J a + gamma) with a and lam as symbols: zero in every motion."""
        a, lam = self.symbols.a, self.symbols.lam
        pushes = list(zip(*self.J, strict=True)) if self.J else [()] * len(self.M)
        balance = tuple(
            inner(row, a) - force - inner(push, lam)
            for row, force, push in zip(self.M, self.forcing, pushes, strict=True)
        )
        return balance, tuple(inner(row, a) + bias for row, bias in zip(self.J, self.gamma, strict=True))

    @property
    def inputs(self) -> dict[str, Scalar]:
        """The model's own expression of each input."""
        return self.system.inputs


def assembled(
    system: System, *, M: tuple[ScalarRow, ...], c: ScalarRow, Q: ScalarRow, T: Scalar, forcing: ScalarRow | None = None
) -> EquationsOfMotion:
    """The formulation's M, c, Q and T with what all formulations share: kinematics, closing rows, V."""
    scope, ties = system.scope, system.ties
    if forcing is None:
        forcing = tuple(force - inertia for force, inertia in zip(Q, c, strict=True))
    return EquationsOfMotion(
        system,
        scope.N,
        scope.nu,
        M,
        c,
        Q,
        forcing,
        ties.J,
        ties.sigma,
        ties.gamma,
        ties.phi,
        T,
        system.loads.potential_energy,
        alike=_alike(system),
    )


def _alike(system: System) -> tuple[int, ...]:
    if len(system.ties.closing) < 2:
        return ()
    if rows_alike not in system.found:
        system.found[rows_alike] = rows_alike(system.ties)
    found: tuple[int, ...] = system.found[rows_alike]
    return found
