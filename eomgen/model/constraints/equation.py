"""Equation: a tie written as an expression."""

from collections.abc import Mapping
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.measured import Measured
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import LoadContext, Push
from eomgen.model.kinds import Gap, VelocityLaw
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Equation(Constraint):
    """gap = 0 (holonomic), or rate = 0 (in the rates and speeds).

    Places of points and angles of bodies may stand in both, velocities in a rate: what holds them pushes on the
    bodies, with lam times the derivative of the equation by each.

    Args:
        gap: of coordinates, places and time.
        rate: linear in rates and velocities.
    """

    kind: ClassVar[str] = "equation"
    one_of: ClassVar[tuple[str, ...]] = ("gap", "rate")
    gap: Gap | None = None
    rate: VelocityLaw | None = None

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
        """phi = 0 with the forces lam dphi/dx(P); or sum k v + rest = 0 with the forces lam k."""
        law = self.rate if self.gap is None else self.gap
        assert law is not None, "one of gap and rate is given"
        measured = {call: Measured(scene, call) for call in law.calls}
        if self.gap is None:
            known = {call: None if x.is_velocity else x.value for call, x in measured.items()}
            rest, slopes = scene.slopes(law, known)
            moved = {call: k for call, k in zip(known, slopes, strict=True) if measured[call].is_velocity}
            return (_row(None, rest, _pushes(measured, moved)),)
        values = {call: x.value for call, x in measured.items()}
        gap, slopes = scene.slopes(law, values)
        pushes = _pushes(measured, dict(zip(values, slopes, strict=True)))
        return (_row(gap, scene.held_rate(law, values) if pushes else None, pushes),)

    def leans_on_ground(self) -> bool:
        """Whether a place or velocity stands in it as the ground sees it."""
        law = self.rate if self.gap is None else self.gap
        return law is not None and any(len(call.args) < 2 or str(call.args[1]) == "ground" for call in law.calls)


@dataclass(frozen=True, kw_only=True)
class NodeBalance(Equation):
    """That what pushes a node without mass is in balance: nobody declares it, and its multiplier is 0."""


def _pushes(measured: Mapping[Call, Measured], slopes: Mapping[Call, AnyScalar]) -> tuple[Push, ...]:
    return tuple(push for call, k in slopes.items() for push in measured[call].pushed(k))


def _row(gap: AnyScalar | None, rate: AnyScalar | None, pushes: tuple[Push, ...]) -> TieRow:
    return TieRow(pushes, gap, rate, component="wrench" if pushes else "")
