"""System, state -> whether dampers take power and springs are slack at their rest length, in numbers.

Power is that of the loads on the velocities of their places, by the twists; the length of a spring is the distance of
its ends, by the poses. The laws' own lengths, rates and stretches are not used.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from eomgen.mechanics.bodies.kinematics import Motion, velocity_of
from eomgen.mechanics.bodies.loads import SystemScene, in_body_axes, in_ground_axes
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.load import Couple, Load, PointForce
from eomgen.proof.pieces import Switch
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import dot, minus
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50


@dataclass(frozen=True)
class Brake:
    """What brakes: its coefficient, and the power that it gives."""

    name: str
    coefficient: Scalar
    power: Scalar


@dataclass(frozen=True)
class Stretch:
    """A spring: its energy, what is 0 where it is slack, and a scale of the energy: k l^2."""

    name: str
    energy: Scalar
    excess: Scalar
    scale: Scalar


@dataclass(frozen=True)
class PassiveElements:
    """The dampers and springs of a system."""

    system: System

    @cached_property
    def brakes(self) -> tuple[Brake, ...]:
        """Dampers between points or bodies, and those of joints."""
        motion, model = self.system.motion, self.system.scope.model
        found = []
        for force in self.system.loads.applied:
            law = model.forces[force.name].damping_law
            if law is not None:
                power = sum((_power(motion, load) for load in force.loads), start=0)
                found.append(Brake(f"forces.{force.name}", self._scene.value(law), power))
        for joint in self.system.loads.efforts:
            link = motion.link(joint.body)
            law = link.joint.efforts()[joint.variable]
            if law.damping is not None:
                (rate,) = self.system.scope.time_derivative((link.s[joint.variable],))
                power = (joint.drive - self._scene.value(law.drive)) * rate
                found.append(Brake(f"bodies.{joint.body}.joint", self._scene.value(law.damping), power))
        return tuple(found)

    @cached_property
    def springs(self) -> tuple[Stretch, ...]:
        """Springs between two points, and those of joints, that have a rest length of their own."""
        scope, found = self.system.scope, []
        for force in self.system.loads.applied:
            spring = scope.model.forces[force.name]
            if spring.rest_length is None or isinstance(spring.rest_length, str) or force.potential is None:
                continue
            ends = [self._scene.position(self._scene.place(point)) for point in spring.spring_ends]
            apart, rest = minus(ends[1], ends[0]), scope.value(spring.rest_length)
            square = dot(apart, apart)
            found.append(Stretch(f"forces.{force.name}", force.potential, square - rest * rest, square))
        for joint in self.system.loads.efforts:
            law, s = self.system.motion.link(joint.body).joint.efforts()[joint.variable], joint.variable
            if law.stiffness is not None:
                excess = self.system.motion.link(joint.body).s[s] - scope.value(law.rest)
                found.append(Stretch(f"bodies.{joint.body}.joint", joint.potential, excess, 1))
        return tuple(found)

    @property
    def _scene(self) -> SystemScene:
        return SystemScene(self.system.motion)

    def driven_on(self, state: State) -> str:
        """Which damper gives power at a state; "" where none does.

        Raises:
            NoValue: nothing that is damped moves there.
        """
        asked = [x for brake in self.brakes for x in (brake.coefficient, brake.power)]
        values = evaluate(asked, state, fifty_digits())
        pairs = list(zip(self.brakes, values[::2], values[1::2], strict=True))
        for brake, c, power in pairs:
            if c > 0 and power > ZERO_AT_50 * (1 + c):
                return f"the damping of {brake.name} gives power"
        if not any(abs(power) > ZERO_AT_50 * (1 + abs(c)) for _, c, power in pairs):
            raise NoValue("nothing moves")
        return ""

    def stretched(self, state: State) -> str:
        """Which spring has energy at its rest length, near a state; "" where none has.

        Raises:
            NoValue: no place near has that length.
        """
        symbols, seen = self.system.symbols, 0
        for spring in self.springs:
            slack = Switch(spring.excess, (0,)).moved(state, fifty_digits().number(0), frozenset(symbols.q))
            if slack is None:
                continue
            seen += 1
            energy, scale = evaluate((spring.energy, spring.scale), slack, fifty_digits())
            if abs(energy) > ZERO_AT_50 * (1 + abs(scale)):
                return f"{spring.name} has energy at its rest length"
        if not seen:
            raise NoValue("no place has the rest length")
        return ""


def _power(motion: Motion, load: Load) -> Scalar:
    """F . v of a place, M . w of a body."""
    power: Scalar = 0
    if isinstance(load, PointForce):
        power = dot(in_ground_axes(motion, load.force, load.axes), velocity_of(motion, load.place))
    if isinstance(load, Couple):
        power = dot(in_body_axes(motion, load.body, load.couple, load.axes), motion.link(load.body).twist.w)
    return power
