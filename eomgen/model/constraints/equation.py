"""An equation between coordinates, points and bodies.

Equation: a constraint written as an expression.
"""

from collections.abc import Mapping
from typing import ClassVar

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.plane import Touch, angle_of, opposite
from eomgen.model.constraints.row import ConstraintRow
from eomgen.model.forces.load import BodyPoint, Couple, LoadContext, Push
from eomgen.model.kinds import Gap, VelocityLaw
from eomgen.symbolic.expression import Call, Matrix, Reference, Scalar, Vector

# -------- measured --------------------------------------------------------------------------------------------
# Functions of points and bodies in an equation: the value of each, and the forces along it.
#
# x(P), x(P, B)         e . p_P,  e . (p_P - p_B):  a force along e on P, its opposite at the same place on B
# angle(A), angle(A, B)    a couple about z on A, its opposite on B vx(P, B), omega_x(A, B)  the same pushes; e is an
# axis of the ground, or of the body B from which it is seen


GROUND = "ground"


@dataclass(frozen=True)
class Measured:
    """One function of the motion in an equation.

    Args:
        call: as it was written.
    """

    scene: LoadContext
    call: Call

    @property
    def is_velocity(self) -> bool:
        return self.call.name.startswith(("v", "omega"))

    @property
    def value(self) -> Scalar:
        """Value of a place or an angle."""
        if self.call.name == "angle":
            return angle_of(self.scene, self._body) - angle_of(self.scene, self._frame)
        return self._axis @ self._arm

    def pushed(self, k: Scalar) -> tuple[Push, ...]:
        """Forces and couples whose power is k times the rate of a place or angle, or k times the velocity."""
        push = k * self._axis
        if self._turns:
            pairs = ((self._body, push), (self._frame, -push))
            return tuple(Couple(body, couple) for body, couple in pairs if body is not None)
        if self._frame is None:
            return Touch(self._place).pushed(push)
        return opposite(Touch(self._place), Touch((self._frame, Vector.ZERO), self._arm), push)

    @property
    def _turns(self) -> bool:
        return self.call.name.startswith(("angle", "omega"))

    @property
    def _axis(self) -> Vector:
        """x, y or z of the ground or of the body from which it is seen; in the plane a body turns about z."""
        k = "xyz".find(self.call.name[-1])
        if k < 0 and not self.scene.plane:
            raise ModelError(
                f"'{self.call}': a body has no single angle in space",
                self.scene.where,
                "write omega_x, omega_y or omega_z, or the coordinate of its joint",
            )
        e = Matrix.IDENTITY[k]
        return e if self._frame is None else self.scene.orientation(self._frame) @ e

    @property
    def _arm(self) -> Vector:
        """Vector to the point from the origin of the body from which it is seen."""
        position = self.scene.position(self._place)
        return position if self._frame is None else position - self.scene.position((self._frame, Vector.ZERO))

    @property
    def _place(self) -> BodyPoint:
        return self.scene.place(self._named(0))

    @property
    def _body(self) -> str | None:
        return None if self._named(0) == GROUND else self._named(0)

    @property
    def _frame(self) -> str | None:
        return None if len(self.call.args) < 2 or self._named(1) == GROUND else self._named(1)

    def _named(self, k: int) -> str:
        argument = self.call.args[k]
        assert isinstance(argument, Reference), "checked when the model was read"
        return argument.name


# -------- equation --------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Equation(Constraint):
    """An equation: `gap` = 0 between coordinates, t and places, or `rate` = 0, linear in rates and velocities.

    Its multiplier is a generalized force. Places of points and angles of bodies may stand in both, velocities in a
    rate: what holds them pushes on the bodies, with lam times the derivative of the equation by each.
    A quantity that changes by a law of its own and is no place of anything, as a current or a pressure, is better
    declared in [states] than held by a rate of a dependent coordinate.

    Args:
        gap: of coordinates, places and time.
        rate: linear in rates and velocities.
    """

    kind: ClassVar[str] = "equation"
    one_of: ClassVar[tuple[str, ...]] = ("gap", "rate")
    gap: Gap | None = None
    rate: VelocityLaw | None = None

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
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
        """True if a place or velocity in it is relative to the ground."""
        law = self.rate if self.gap is None else self.gap
        return law is not None and any(len(call.args) < 2 or str(call.args[1]) == "ground" for call in law.calls)


@dataclass(frozen=True, kw_only=True)
class NodeBalance(Equation):
    """Equilibrium of a node without mass: nobody declares it, and its multiplier is 0."""

    PREFIX: ClassVar[str] = "balance_of_"  # of its name, before its coordinate

    def assumption(self, name: str) -> str:
        follows = "moves no mass: it follows from the balance of what pushes it"
        return f"{name.removeprefix(self.PREFIX)} {follows} ({name})"


def _pushes(measured: Mapping[Call, Measured], slopes: Mapping[Call, Scalar]) -> tuple[Push, ...]:
    return tuple(push for call, k in slopes.items() for push in measured[call].pushed(k))


def _row(gap: Scalar | None, rate: Scalar | None, pushes: tuple[Push, ...]) -> ConstraintRow:
    return ConstraintRow(pushes, gap, rate, component="wrench" if pushes else "")
