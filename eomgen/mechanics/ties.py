"""Motion -> Ties: the rows of the constraints.

A row holds a wrench on each body that it touches; the motion that it forbids is the dual:

    W^T xi + s_t = 0,   J = W^T B,   sigma = W^T beta + s_t,   J u + sigma = 0,   J a + gamma = 0

A row without bodies (`equation`) gives dphi/dq, or its row in the rates, directly.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from eomgen.errors import DerivationError, ModelError, NotYet
from eomgen.mechanics.kinematics import Motion, slide_of
from eomgen.mechanics.loads import SystemScene, body_wrench, in_ground_axes
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import PointForce
from eomgen.model.unbuilt import unbuilt_ties
from eomgen.symbolic.derivative import depends_on, jacobian, substituted
from eomgen.symbolic.exact import equal_at_random_states
from eomgen.symbolic.graph import Scalar
from eomgen.symbolic.spatial import Wrench, dot


@dataclass(frozen=True)
class Row:
    """One scalar row of a tie.

    Args:
        tie, number: its name and place in the tie, from 1.
        wrenches: (body, W) for a unit lam, body axes, at the body's origin; empty for an equation.
        direct: s_t, the part that no twist sees: the slide of points in their bodies; of an equation all of it.
        velocity: W^T xi + s_t as a function of q, u, t: zero when the tie holds.
        gap: phi(q, t), or None where only the velocity row is given.
        status: "identical": the coordinates satisfy the row by themselves; "eliminated": it determines a dependent
            coordinate; both only carry a reaction. "closing": it restricts the speeds, by a multiplier.
        component: "x", "y", "z", "n", "t", "couple", "tension", or "".
        rubbing: of a contact that can rub, (body, wrench) of a unit of friction, as `wrenches`.
        sliding: the sliding velocity dual to it [m/s].
    """

    tie: str
    number: int
    wrenches: tuple[tuple[str, Wrench], ...]
    direct: Scalar
    velocity: Scalar
    gap: Scalar | None
    status: str
    component: str = ""
    rubbing: tuple[tuple[str, Wrench], ...] = ()
    sliding: Scalar = 0

    @property
    def identical(self) -> bool:
        return self.status == "identical"

    @property
    def label(self) -> str:
        return f"lam({self.tie}, {self.number})"


@dataclass(frozen=True)
class Ties:
    """All rows of all ties, and the matrices of those that close."""

    motion: Motion
    rows: tuple[Row, ...]

    @property
    def closing(self) -> tuple[Row, ...]:
        return tuple(row for row in self.rows if row.status == "closing")

    @cached_property
    def J(self) -> tuple[tuple[Scalar, ...], ...]:
        """J u + sigma = 0: one row for each closing row."""
        velocities = tuple(row.velocity for row in self.closing)
        return jacobian(velocities, self.motion.scope.symbols.u) if velocities else ()

    @cached_property
    def sigma(self) -> tuple[Scalar, ...]:
        still = {u: 0 for u in self.motion.scope.symbols.u}
        return substituted(tuple(row.velocity for row in self.closing), still)

    @cached_property
    def gamma(self) -> tuple[Scalar, ...]:
        """J a + gamma = 0: the total derivative of the velocity row at a = 0."""
        return self.motion.scope.time_derivative(tuple(row.velocity for row in self.closing))

    @property
    def phi(self) -> tuple[Scalar | None, ...]:
        return tuple(row.gap for row in self.closing)


def ties_of(motion: Motion) -> Ties:
    """The rows of every constraint of the model.

    Raises:
        NotYet: a kind whose rows this version does not build, friction, contact that can end, a truss.
    """
    for where, what in unbuilt_ties(motion.scope.model):
        raise NotYet(f"the rows of '{what}' are not built yet", where)
    scene = SystemScene(motion)
    rows = []
    for name, constraint in motion.scope.model.constraints.items():
        for number, tie_row in enumerate(constraint.rows(scene), start=1):
            rows.append(_row(motion, name, number, tie_row))
    return Ties(motion, tuple(rows))


def _row(motion: Motion, name: str, number: int, row: TieRow) -> Row:
    wrenches = _wrenches(motion, row.pushes)
    if row.pushes:
        direct = 0 if row.material else _slide(motion, row.pushes)
    elif row.rate is not None:
        direct = _linear(motion, name, row.rate)
    else:
        assert row.gap is not None, "a row without pushes and rate is the rate of its gap"
        direct = motion.scope.time_derivative((row.gap,))[0]
    velocity = _power(motion, wrenches, direct)
    rubbing = _wrenches(motion, row.tangent)
    sliding = _power(motion, rubbing, 0 if row.material else _slide(motion, row.tangent)) if rubbing else 0
    status = _status(motion, velocity, row.gap)
    if status == "closing" and not depends_on(velocity, motion.scope.symbols.u):
        what, mend = "nothing that is free moves it", "put its points where they meet, or give the bodies more freedom"
        raise DerivationError(f"row {number} of '{name}' cannot hold: {what}", f"constraints.{name}", mend)
    return Row(name, number, wrenches, direct, velocity, row.gap, status, row.component, rubbing, sliding)


def _status(motion: Motion, velocity: Scalar, gap: Scalar | None) -> str:
    return "identical" if holds_identically(velocity) and (gap is None or holds_identically(gap)) else "closing"


def _wrenches(motion: Motion, pushes: tuple[Any, ...]) -> tuple[tuple[str, Wrench], ...]:
    return tuple(found for push in pushes if (found := body_wrench(motion, push)) is not None)


def _power(motion: Motion, wrenches: tuple[tuple[str, Wrench], ...], direct: Scalar) -> Scalar:
    return sum((motion.link(b).twist.power(W) for b, W in wrenches), start=direct)


def _slide(motion: Motion, pushes: tuple[Any, ...]) -> Scalar:
    """What points that move in their bodies add to the power of the pushes."""
    return sum((_sliding(motion, push) for push in pushes if isinstance(push, PointForce)), start=0)


def _linear(motion: Motion, name: str, rate: Scalar) -> Scalar:
    """The row of an equation in the rates, which must be linear in them: J u + sigma = 0."""
    speeds = motion.scope.symbols.u
    if speeds and any(depends_on(entry, speeds) for row in jacobian((rate,), speeds) for entry in row):
        raise ModelError(f"the rate of '{name}' is not linear in the rates", f"constraints.{name}.rate",
                         "write it as a sum of rates, each times a function of the coordinates")  # fmt: skip
    return rate


def _sliding(motion: Motion, push: PointForce) -> Scalar:
    """Power of a push on a point that moves in its body: F . R r'."""
    return dot(in_ground_axes(motion, push.force, push.axes), slide_of(motion, push.place))


def holds_identically(scalar: Scalar) -> bool:
    """Whether the scalar is zero at all values of its symbols (exactly, at random states)."""
    if type(scalar) is int:
        return scalar == 0
    return equal_at_random_states([(scalar, 0)]).equal
