"""System -> Quantities: the functions that outputs may call, as graph scalars.

Positions are read off the poses; velocities and accelerations are their time derivatives, and the
accelerations hold the symbols a, in which they are linear. Seen from a body: in that body's frame
and axes, r = R^T (p - p_body), v = dr/dt, a = dv/dt.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.inertia import kinetic_energy
from eomgen.mechanics.bodies.sign import positive_parameters
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import generalized_forces
from eomgen.mechanics.fields.centers import finite_center
from eomgen.mechanics.fields.field import (
    VelocityField,
    acceleration_pole,
    curvature_radius,
    field_of,
    least_speed,
    normal_part,
    tangential_part,
)
from eomgen.mechanics.fields.relative_motion import COMPONENTS as PARTS_OF_MOTION
from eomgen.mechanics.fields.relative_motion import MAGNITUDES as SIZES_OF_PARTS
from eomgen.mechanics.fields.relative_motion import body_axes, part_of_motion
from eomgen.mechanics.first_integrals.energies import energy_of_force, energy_of_motion, power_of_loads
from eomgen.mechanics.formulations.lagrange import free_rates
from eomgen.mechanics.masses.inertia_about import FUNCTIONS as MOMENTS_OF_INERTIA
from eomgen.mechanics.masses.inertia_about import Asked
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.mechanics.statics.reaction_outputs import ASKING_REACTIONS, AskedReactions, output_name
from eomgen.model.forces.load import BodyPoint
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import derivative, substituted
from eomgen.symbolic.expression.expressions import Call, Expression
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.spatial import ZERO, Vector, apply, dot, minus, transposed, vector_of
from eomgen.symbolic.numeric.work import Work

_ORDERS = {"": 0, "v": 1, "a": 2}  # x is a position, vx a velocity, ax an acceleration
_AXES = {"x": 0, "y": 1, "z": 2}
COMPONENTS = {kind + axis: (n, i) for kind, n in _ORDERS.items() for axis, i in _AXES.items()}
"""Functions of a point: (time derivatives, component)."""

GROUND = "ground"
ALONG_THE_PATH: dict[str, Callable[[Vector, Vector], Scalar]] = {
    "tangential_acceleration": tangential_part,
    "normal_acceleration": normal_part,
    "curvature_radius": curvature_radius,
}
"""Functions of a point's velocity and acceleration."""
MAGNITUDES = {"speed": 1, "acceleration": 2}
TURNING = {f"{name}_{axis}": (n, i) for name, n in (("omega", 1), ("epsilon", 2)) for axis, i in _AXES.items()}
"""Functions of a body: (time derivatives, component)."""

LINEARIZED = frozenset(("mass", "damping", "stiffness", "frequency"))
"""Functions of the linearized system, which is none of a state."""


OF_MOTION = frozenset(
    (
        *(name for name, (n, _) in COMPONENTS.items() if n),
        *MAGNITUDES,
        *TURNING,
        *ALONG_THE_PATH,
        *PARTS_OF_MOTION,
        *SIZES_OF_PARTS,
        "omega",
        "epsilon",
        "rotation_center_x",
        "rotation_center_y",
        "acceleration_pole_x",
        "acceleration_pole_y",
        "least_speed",
        "kinetic_energy",
        "power",
        "angular_momentum_x",
        "angular_momentum_y",
        "angular_momentum_z",
    )
)
"""Functions of velocities and accelerations."""


def asks_motion(formula: Expression) -> bool:
    """Whether velocities or accelerations stand in a formula: functions of them, or rates of coordinates."""
    return any(call.name in OF_MOTION for call in formula.calls) or any(name.endswith("'") for name in formula.names)


@dataclass(frozen=True)
class Quantities:
    """What the functions of the outputs are worth in one system.

    Args:
        system: the system.
        at: exact scalars that stand in place of coordinates, speeds, accelerations and t in the reactions.
    """

    system: System
    at: Mapping[Node, Scalar] = field(default_factory=dict)

    @property
    def reactions(self) -> Reactions:
        """All reactions, of generic coordinates or at the given ones."""
        return self._asked.reactions

    def value(self, call: Call) -> Scalar:
        """One function at its arguments, in q, u, a, t and the parameters.

        Raises:
            DerivationError: it has no meaning here.
        """
        if call.name in LINEARIZED:
            raise DerivationError(f"'{call}' is of the linearized system, not of a state", mend="ask it by itself")
        if call.name in ASKING_REACTIONS:
            return self._asked.value(call)
        if call.name in MOMENTS_OF_INERTIA:
            asked = Asked(call, self.system.motion, lambda entries: substituted(tuple(entries), self.at))
            return MOMENTS_OF_INERTIA[call.name](asked)
        if call.name not in _OF_NAMES:
            raise DerivationError(f"'{call}': there is no function '{call.name}'")
        return _OF_NAMES[call.name](self, *(output_name(call, argument) for argument in call.args))

    @cached_property
    def _asked(self) -> AskedReactions:
        return AskedReactions(self.system, self.at)

    def size(self, vector: Vector) -> Scalar:
        """|v|"""
        (vector,) = self._here(vector)
        return sqrt(dot(vector, vector))

    def of_point(self, order: int, point: str, frame: str = GROUND, axes: str = "") -> Vector:
        """Position (order 0), velocity (1) or acceleration (2) of a point, seen from `frame` [m, s].

        Args:
            axes: of the components: a body's or the ground's; those of `frame` where it is left out.
        """
        motion = self.system.motion
        place = motion.position(self._place(point))
        if frame in motion.index:
            pose = motion.link(frame).pose
            place = apply(transposed(pose.R), minus(place, pose.p))
        seen = self._rate(place, order)
        if axes in ("", frame):
            return seen
        return apply(transposed(body_axes(motion, axes)), apply(body_axes(motion, frame), seen))

    def along_the_path(self, law: Callable[[Vector, Vector], Scalar], *names: str) -> Scalar:
        """What depends on velocity and acceleration of a point, at the given state."""
        return law(*self._here(self.of_point(1, *names), self.of_point(2, *names)))

    def _here(self, *vectors: Vector) -> tuple[Vector, ...]:
        """The vectors at the given state, readable; as they are where none is given."""
        if not self.at:
            return vectors
        positive = positive_parameters(self.system.scope)
        values = substituted([x for vector in vectors for x in vector], self.at)
        flat = iter([simplest(x, Work.VALUE, positive) for x in values])
        return tuple(vector_of(next(flat) for _ in range(3)) for _ in vectors)

    def _field(self, body: str) -> VelocityField:
        """The field of a body at the given state."""
        field = field_of(self.system.motion, body)
        return VelocityField(*self._here(field.p, field.v, field.a, field.w, field.e))

    def center(self, body: str, other: str = GROUND) -> Vector:
        """The centre of rotation of a body against the ground or another body.

        Raises:
            DerivationError: it is at infinity, or there is none; in space there is no single one to be asked for.
        """
        if self.system.scope.model.space != "plane":
            raise DerivationError(f"rotation_center({body}): it is asked of plane motion")
        whose = f"body '{body}'" + (f" against '{other}'" if other != GROUND else "")
        return finite_center(self._field(body).against(self._field(other)), whose)

    def pole(self, body: str) -> Vector:
        """The point of a body that has no acceleration.

        Raises:
            DerivationError: there is none; in space there is no single one to be asked for.
        """
        if self.system.scope.model.space != "plane":
            raise DerivationError(f"acceleration_pole({body}): it is asked of plane motion")
        return acceleration_pole(self._field(body))

    def least_speed(self, start: str, end: str) -> Scalar:
        """The least speed of the points of a body between two of its points."""
        places = [self._place(point) for point in (start, end)]
        body, other = (GROUND if owner is None else owner for owner, _ in places)
        if body != other:
            what = f"least_speed({start}, {end}): '{start}' and '{end}' are points of two bodies"
            raise DerivationError(what, mend="name two points of one body")
        first, last = self._here(*map(self.system.motion.position, places))
        positive = positive_parameters(self.system.scope)
        return least_speed(self._field(body), first, last, lambda x: simplest(x, Work.VALUE, positive))

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
        system, k = self._speed(coordinate, "generalized_force")
        return self._carried(system, generalized_forces(system.loads)[k])

    def momentum(self, coordinate: str) -> Scalar:
        """p_k = dT/dq_k', or dT/du_k of a declared speed."""
        system, k = self._speed(coordinate, "momentum")
        return self._carried(system, derivative(kinetic_energy(system.motion), system.symbols.u[k]))

    def _rate(self, vector: Vector, order: int) -> Vector:
        scope = self.system.scope
        if order == 0:
            return vector
        rate = scope.time_derivative(vector)
        return vector_of(rate if order == 1 else scope.with_accelerations(rate))

    def _place(self, point: str) -> BodyPoint:
        return self.system.motion.place(point)

    def _speed(self, coordinate: str, function: str) -> tuple[System, int]:
        """The system among whose speeds it is, or its rate, and its place; of replaced rates the system over the rates.

        Raises:
            DerivationError: it is no freedom.
        """
        declared = self.system.scope.model.speeds
        turning = {e.name for four in self.system.scope.quaternions for e in four}
        for system in (self.system, *([self.system.free] if declared and self.system.free else [])):
            names = [u.name for u in system.symbols.u]
            sought = coordinate if coordinate in declared else f"{coordinate}'"
            part = system.scope.model.coordinates.get(coordinate)
            if sought in names and coordinate not in turning and not (part and part.dependent):
                return system, names.index(sought)
        if coordinate in turning:
            raise DerivationError(
                f"{function}({coordinate}): '{coordinate}' is part of a quaternion, it is no freedom",
                mend="ask it of the speeds that the joint's `omega` names",
            )
        raise DerivationError(f"{function}({coordinate}): '{coordinate}' moves as given, it is no freedom")

    def _carried(self, system: System, scalar: Scalar) -> Scalar:
        """A scalar of the system over the rates in the speeds of this one."""
        if system is self.system:
            return scalar
        rates = free_rates(self.system, system)
        return substituted((scalar,), dict(zip(system.symbols.u, rates, strict=True)))[0]


def _of_point(order: int, axis: int) -> Callable[..., Scalar]:
    return lambda quantities, *names: quantities.of_point(order, *names)[axis]


def _size_of_point(order: int) -> Callable[..., Scalar]:
    return lambda quantities, *names: quantities.size(quantities.of_point(order, *names))


def _part(part: str, axis: int) -> Callable[..., Scalar]:
    return lambda quantities, *names: part_of_motion(quantities.system.motion, part, *names)[axis]


def _size_of_part(part: str) -> Callable[..., Scalar]:
    return lambda quantities, *names: quantities.size(part_of_motion(quantities.system.motion, part, *names))


def _of_body(order: int, axis: int) -> Callable[..., Scalar]:
    return lambda quantities, *names: quantities.of_body(order, *names)[axis]


def _along_the_path(law: Callable[[Vector, Vector], Scalar]) -> Callable[..., Scalar]:
    return lambda quantities, *names: quantities.along_the_path(law, *names)


_OF_NAMES: dict[str, Callable[..., Scalar]] = {
    **{name: _of_point(*asked) for name, asked in COMPONENTS.items()},
    **{name: _size_of_point(order) for name, order in MAGNITUDES.items()},
    **{name: _part(*asked) for name, asked in PARTS_OF_MOTION.items()},
    **{name: _size_of_part(part) for name, part in SIZES_OF_PARTS.items()},
    **{name: _along_the_path(law) for name, law in ALONG_THE_PATH.items()},
    **{name: _of_body(*asked) for name, asked in TURNING.items()},
    "angle": Quantities.angle,
    "omega": lambda quantities, *names: quantities.turning(1, *names),
    "epsilon": lambda quantities, *names: quantities.turning(2, *names),
    "rotation_center_x": lambda quantities, *names: quantities.center(*names)[0],
    "rotation_center_y": lambda quantities, *names: quantities.center(*names)[1],
    "acceleration_pole_x": lambda quantities, *names: quantities.pole(*names)[0],
    "acceleration_pole_y": lambda quantities, *names: quantities.pole(*names)[1],
    "least_speed": Quantities.least_speed,
    "generalized_force": Quantities.generalized_force,
    "momentum": Quantities.momentum,
    "kinetic_energy": lambda quantities, *names: energy_of_motion(quantities.system, *names),
    "potential_energy": lambda quantities, *names: energy_of_force(quantities.system, *names),
    "power": lambda quantities, *names: power_of_loads(quantities.system, *names),
}
"""Functions of names: points, bodies, coordinates."""
