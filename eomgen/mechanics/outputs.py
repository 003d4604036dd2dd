"""System -> Quantities: the functions that outputs may call, as graph scalars.

Positions are read off the poses; velocities and accelerations are their time derivatives, and the
accelerations hold the symbols a, in which they are linear. Seen from a body: in that body's frame
and axes, r = R^T (p - p_body), v = dr/dt, a = dv/dt.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from eomgen.errors import DerivationError, NotYet
from eomgen.mechanics.drive import drive, multiplier
from eomgen.mechanics.energies import energy_of_force, energy_of_motion, power
from eomgen.mechanics.inertia import kinetic_energy
from eomgen.mechanics.reactions import Reactions, reactions_of
from eomgen.mechanics.system import System
from eomgen.mechanics.work import generalized_forces
from eomgen.model.forces.load import Place
from eomgen.symbolic.derivative import derivative
from eomgen.symbolic.expressions import Call, Expression, Reference
from eomgen.symbolic.functions import sqrt
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.spatial import ZERO, Vector, apply, dot, minus, transposed, vector_of

_ORDERS = {"": 0, "v": 1, "a": 2}  # x is a position, vx a velocity, ax an acceleration
_AXES = {"x": 0, "y": 1, "z": 2}
COMPONENTS = {kind + axis: (n, i) for kind, n in _ORDERS.items() for axis, i in _AXES.items()}
"""Functions of a point: (time derivatives, component)."""

GROUND = "ground"
MAGNITUDES = {"speed": 1, "acceleration": 2}
TURNING = {f"{name}_{axis}": (n, i) for name, n in (("omega", 1), ("epsilon", 2)) for axis, i in _AXES.items()}
"""Functions of a body: (time derivatives, component)."""

LATER = {
    "linearization": ("mass", "damping", "stiffness", "frequency"),
    "centres of rotation": ("rotation_center",),
    "moments of inertia": ("inertia",),
}
"""What later versions bring, and how their functions begin."""


def later(function: str) -> str:
    """What a function of the outputs waits for, in words; "" where it works."""
    for what, heads in LATER.items():
        if any(function == head or function.startswith(head + "_") for head in heads):
            return f"{what} come with a later version" if what.endswith("s") else f"{what} comes with a later version"
    return ""


COMPONENTS_OF_REACTIONS = {f"reaction_{axis}": i for axis, i in _AXES.items()}
COUPLES = {"reaction_couple": 2, **{f"reaction_couple_{axis}": i for axis, i in _AXES.items()}}
_ALONE = ("reaction_n", "reaction_t", "tension", "multiplier", "drive")
ASKING_REACTIONS = frozenset((*COMPONENTS_OF_REACTIONS, *COUPLES, *_ALONE))
"""Functions for which the balance of the bodies is needed."""


@dataclass(frozen=True)
class Quantities:
    """What the functions of the outputs are worth in one system.

    Args:
        system: the system.
        at: exact scalars that stand in place of coordinates, speeds, accelerations and t in the reactions.
    """

    system: System
    at: Mapping[Node, Scalar] = field(default_factory=dict)

    @cached_property
    def reactions(self) -> Reactions:
        """All reactions, of generic coordinates or at the given ones."""
        return reactions_of(self.system, self.at, short=True)

    def value(self, call: Call) -> Scalar:
        """One function at its arguments, in q, u, a, t and the parameters.

        Raises:
            NotYet: a function that comes later.
            DerivationError: it has no meaning here.
        """
        if waits := later(call.name):
            raise NotYet(f"'{call}': {waits}")
        if call.name == "tension":
            return self._tension(call)
        names = [_name(call, argument) for argument in call.args]
        if call.name in ASKING_REACTIONS:
            return self._reaction(call, *names)
        if call.name in COMPONENTS:
            n, i = COMPONENTS[call.name]
            return self.of_point(n, *names)[i]
        if call.name in MAGNITUDES:
            vector = self.of_point(MAGNITUDES[call.name], *names)
            return sqrt(dot(vector, vector))
        if call.name in TURNING:
            n, i = TURNING[call.name]
            return self.of_body(n, *names)[i]
        if call.name not in _OTHERS:
            raise DerivationError(f"'{call}': there is no function '{call.name}'")
        return _OTHERS[call.name](self, *names)

    def _reaction(self, call: Call, owner: str, frame: str = "") -> Scalar:
        """A component of a reaction: reaction_x(B), reaction_x(B.II), reaction_y(bar, bar), reaction_n(wall)."""
        if call.name == "multiplier":
            return self._multiplier(owner)
        if call.name == "drive":
            return drive(self.system, owner)
        owner, _, side = owner.partition(".")
        if side and call.name in ("reaction_n", "reaction_t"):
            mend = f"ask {call.name}({owner}), at an instant where it is meant"
            raise DerivationError(f"'{call}': normal force and friction are on the body named first", mend=mend)
        if call.name == "reaction_n":
            return self.reactions.normal(owner)
        if call.name == "reaction_t":
            return self.reactions.friction(owner)
        if call.name in COMPONENTS_OF_REACTIONS:
            return self.reactions.component("force", COMPONENTS_OF_REACTIONS[call.name], owner, side, frame)
        return self.reactions.component("couple", COUPLES[call.name], owner, side, frame)

    def _tension(self, call: Call) -> Scalar:
        """tension(rope) or tension(rope, 2)."""
        owner, *strand = call.args
        name = _name(call, owner)
        if name in self.system.scope.model.trusses:
            raise NotYet(f"'{call}': trusses come with a later version")
        number = strand[0].literal if strand and isinstance(strand[0], Expression) else 1
        if not isinstance(number, int) or len(strand) > 1:
            raise DerivationError(f"'{call}': the second argument is the number of the strand, from 1")
        return self.reactions.tension(name, number)

    def _multiplier(self, tie: str) -> Scalar:
        """lam of a tie of one row; of one without a place it stands in the equations of motion."""
        rows = [row for row in self.system.ties.rows if row.tie == tie]
        if any(row.pushes for row in rows):
            return self.reactions.multiplier(tie)
        return multiplier(self.system, tie)

    def of_point(self, order: int, point: str, frame: str = GROUND) -> Vector:
        """Position (order 0), velocity (1) or acceleration (2) of a point, ground axes or those of `frame` [m, s]."""
        motion = self.system.motion
        place = motion.position(self._place(point))
        if frame in motion.index:
            pose = motion.link(frame).pose
            place = apply(transposed(pose.R), minus(place, pose.p))
        return self._rate(place, order)

    def of_body(self, order: int, body: str, frame: str = GROUND) -> Vector:
        """Angular velocity (order 1) or acceleration (2) of a body, ground axes or those of `frame` [rad, s]."""
        w = self._spin(body)
        if frame in self.system.motion.index:
            R = self.system.motion.link(frame).pose.R
            w = apply(transposed(R), minus(w, self._spin(frame)))
        return w if order == 1 else vector_of(self.system.scope.with_accelerations(w))

    def _spin(self, body: str) -> Vector:
        """Angular velocity in ground axes, from the twist; of the ground 0 [rad/s]."""
        if body not in self.system.motion.index:
            return ZERO
        link = self.system.motion.link(body)
        return link.twist.w if link.angle is not None else apply(link.pose.R, link.twist.w)

    def angle(self, body: str, frame: str = GROUND) -> Scalar:
        """Angle of a body in the plane, against the ground or another body [rad]."""
        return self._angle(body) - self._angle(frame)

    def _angle(self, body: str) -> Scalar:
        """Angle of a body against the ground's axes; of the ground 0 [rad]."""
        if self.system.scope.model.space != "plane":
            raise DerivationError(f"body '{body}' has no single angle in space")
        angle = self.system.motion.link(body).angle if body in self.system.motion.index else 0
        assert angle is not None, "in the plane every body has an angle"
        return angle

    def turning(self, order: int, body: str, frame: str = GROUND) -> Scalar:
        """In the plane omega or epsilon, counter-clockwise positive; in space its magnitude."""
        vector = self.of_body(order, body, frame)
        return vector[2] if self.system.scope.model.space == "plane" else sqrt(dot(vector, vector))

    def generalized_force(self, coordinate: str) -> Scalar:
        """Q_k of everything applied."""
        return generalized_forces(self.system.loads)[self._speed(coordinate, "generalized_force")]

    def momentum(self, coordinate: str) -> Scalar:
        """p_k = dT/dq_k'."""
        k = self._speed(coordinate, "momentum")
        return derivative(kinetic_energy(self.system.motion), self.system.symbols.u[k])

    def _rate(self, vector: Vector, order: int) -> Vector:
        scope = self.system.scope
        if order == 0:
            return vector
        rate = scope.time_derivative(vector)
        return vector_of(rate if order == 1 else scope.with_accelerations(rate))

    def _place(self, point: str) -> Place:
        owner, _ = self.system.scope.model.resolve_point(point)
        if owner in self.system.scope.model.trusses:
            raise NotYet(f"'{point}': trusses come with a later version")
        return self.system.motion.place(point)

    def _speed(self, coordinate: str, function: str) -> int:
        names = [u.name for u in self.system.symbols.u]
        if coordinate + "'" not in names:
            raise DerivationError(f"{function}({coordinate}): '{coordinate}' moves as given, it is no freedom")
        return names.index(coordinate + "'")


def _name(call: Call, argument: object) -> str:
    if not isinstance(argument, Reference):
        raise DerivationError(f"'{call}': names are needed as arguments")
    return argument.name


_OTHERS: dict[str, Callable[..., Scalar]] = {
    "angle": Quantities.angle,
    "omega": lambda quantities, *names: quantities.turning(1, *names),
    "epsilon": lambda quantities, *names: quantities.turning(2, *names),
    "generalized_force": Quantities.generalized_force,
    "momentum": Quantities.momentum,
    "kinetic_energy": lambda quantities, *names: energy_of_motion(quantities.system, *names),
    "potential_energy": lambda quantities, *names: energy_of_force(quantities.system, *names),
    "power": lambda quantities, *names: power(quantities.system, *names),
}
