"""System, state -> whether springs, dampers and pulls act as they are declared, in numbers.

    l = |r_2 - r_1| (or n . (r_2 - r_1)),  l' = n . (v_2 - v_1);   theta between the axes of both, theta' = w_2 - w_1
    T = k (l - l_0) + c l' + f(l, l')      on the first along n, on the second the opposite;   V = k (l - l_0)^2 / 2

Places and axes are those of the poses, velocities those of the twists. An angle has the whole turns of its body.
The laws' own lengths, rates, stretches and loads are what is proven.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

from eomgen.mechanics.bodies.kinematics import BodyLink, velocity_of
from eomgen.mechanics.bodies.loads import Applied, JointEffort
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.element import Element
from eomgen.proof.in_numbers import InNumbers, Pushes, add_push, direction_at, pushed_otherwise, pushes_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import (
    ZERO,
    Numbers,
    Pose,
    Twist,
    apply,
    cross,
    dot,
    minus,
    plus,
    product,
    times,
    transposed,
)
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50


def elements_of(system: System) -> tuple[tuple[Applied, Element], ...]:
    """The springs, dampers and pulls of a system."""
    forces = system.scope.model.forces
    found = ((applied, forces[applied.name].element) for applied in system.loads.applied)
    return tuple((applied, element) for applied, element in found if element is not None)


def undeclared(system: System, state: State) -> str:
    """Which element acts otherwise than it is declared at a state; "" where none does.

    Raises:
        NoValue: something has no value there.
    """
    for applied, element in elements_of(system):
        if wrong := ActingElement(system, state, element).wrong(applied):
            return f"forces.{applied.name} {wrong}"
    for effort in system.loads.efforts:
        if wrong := _in_joint(system, state, effort):
            return f"bodies.{effort.body}.joint {wrong}"
    return ""


def acting(system: System, state: State, force: str) -> Any:
    """What an element pulls [N], or turns its second body back with [N m], by its declaration at a state."""
    (element,) = (each for applied, each in elements_of(system) if applied.name == force)
    return ActingElement(system, state, element).law[0]


def _in_joint(system: System, state: State, effort: JointEffort) -> str:
    """effort = drive - c s' - k (s - rest), V = k (s - rest)^2 / 2: s from the poses, s' from the twists of both.

    Raises:
        NoValue: the joint turns about several axes, of which no pose tells the angles.
    """
    link, scope = system.motion.link(effort.body), system.scope
    law = link.joint.pushes()[effort.variable]
    declared = tuple(map(scope.value, (law.push, law.damping, law.stiffness, law.rest)))
    drive, c, k, rest, stated, V = evaluate((*declared, effort.effort, effort.potential), state, fifty_digits())
    s, rate = _joint_motion(system, state, link, effort.variable)
    stretch = s - rest
    if _turns(link, effort.variable) and k != 0:
        stretch = _by_whole_turns(stretch, (drive - c * rate - stated) / k)
    left, energy = stated - (drive - c * rate - k * stretch), k * stretch * stretch / 2
    if abs(left) > ZERO_AT_50 * (1 + abs(stated)):
        return "pushes otherwise than its drive, rate and place say"
    return _energy(V, energy)


def _energy(stated: Any, due: Any) -> str:
    """That an energy is another one."""
    same = abs(stated - due) <= ZERO_AT_50 * (1 + abs(due))
    return "" if same else f"has the energy {float(stated):.10g} for {float(due):.10g}"


def _turns(link: BodyLink, variable: int) -> bool:
    return not all(map(is_zero, link.S[variable][0]))


def _joint_motion(system: System, state: State, link: BodyLink, variable: int) -> tuple[Any, Any]:
    """(s, s') of a joint's variable in numbers.

    A turn by s about n: 2 sin s = n . vee(R - R^T), 2 cos s = tr R - 1; a way s along v: s v.v = v . p.
    """
    if sum(_turns(link, j) for j in range(len(link.S))) > 1:
        raise NoValue("a joint that turns about several axes")
    home, here = link.joint.pose((0,) * len(link.S), system.scope.value), link.relative
    parent = Pose() if link.parent < 0 else system.motion.links[link.parent].pose
    carried = (Twist() if link.parent < 0 else system.motion.links[link.parent].twist).at(link.local.p)
    turning = _turns(link, variable)
    column = link.S[variable][0 if turning else 1]
    n, Q = apply(here.R, column), product(here.R, transposed(home.R))
    own = link.twist.w if turning else plus(link.twist.v, cross(link.twist.w, link.point))
    against = minus(apply(link.pose.R, own), apply(parent.R, carried.w if turning else carried.v))
    asked = (
        dot(n, (Q[2][1] - Q[1][2], Q[0][2] - Q[2][0], Q[1][0] - Q[0][1])),
        Q[0][0] + Q[1][1] + Q[2][2] - 1,
        dot(n, minus(here.p, home.p)),
        dot(column, column),
        dot(against, apply(link.pose.R, column)),
    )
    sine, cosine, way, square, rate = evaluate(asked, state, fifty_digits())
    size = square**0.5
    return square.context.atan2(sine / size, cosine) / size if turning else way / square, rate / square


def _by_whole_turns(angle: Any, other: Any) -> Any:
    """The angle and as many whole turns as bring it next to another."""
    turn = 2 * angle.context.pi
    return angle + turn * round((other - angle) / turn)


@dataclass(frozen=True)
class ActingElement(InNumbers):
    """One element at one state."""

    element: Element

    def wrong(self, applied: Applied) -> str:
        """What of its loads and its energy is otherwise."""
        pull, energy = self.law
        reach: Any = 1 + max(map(abs, (x for end in self.ends for x in end)), default=0)
        stated = pushes_of(self.motion, self.state, applied.loads)
        if body := pushed_otherwise(stated, self.of_pull(pull), (1 + abs(pull)) * reach):
            return f"pushes '{body}' otherwise than its length and rate say"
        if energy is not None and applied.potential is not None:
            return _energy(self.at((applied.potential,))[0], energy)
        return ""

    @cached_property
    def scene(self) -> SystemScene:
        return SystemScene(self.motion, begun=self.system.loads.begun)

    # -- geometry --------------------------------------------------------------------------------------------

    @cached_property
    def ends(self) -> tuple[Numbers, ...]:
        return tuple(self.vector(self.scene.position(self.scene.place(p))) for p in self.element.points)

    @cached_property
    def direction(self) -> Numbers:
        """Of the pull on the first end."""
        along = self.element.along
        v: Numbers = minus(self.ends[1], self.ends[0]) if along is None else self.vector(self.scene.vector(along))
        if along is None and self._is_spring_without_length and not any(v):
            return ZERO  # it pulls nothing, in no direction
        return direction_at(v)

    @property
    def _is_spring_without_length(self) -> bool:
        """Whether k l is all that it pulls: that is smooth where its ends meet."""
        element = self.element
        springs = element.stiffness is not None and element.damping is None and element.pull is None
        return springs and self._slack == 0

    @cached_property
    def measured(self) -> tuple[Any, Any]:
        """(l, l') or (theta, theta')."""
        if not self.element.points:
            (first, w_1), (second, w_2) = map(self._turned, self.element.bodies)
            return second - first, w_2 - w_1
        speeds = [self.vector(velocity_of(self.motion, self.scene.place(p))) for p in self.element.points]
        n = self.direction
        return dot(minus(self.ends[1], self.ends[0]), n), dot(minus(speeds[1], speeds[0]), n)

    def _turned(self, body: str | None) -> tuple[Any, Any]:
        """(the angle of its axes, by the whole turns that the body has made; its spin) about z."""
        if body is None:
            return 0, 0
        link = self.motion.link(body)
        c, s, w = self.at((link.pose.R[0][0], link.pose.R[1][0], link.twist.w[2]))
        angle = c.context.atan2(s, c)
        return angle if link.angle is None else _by_whole_turns(angle, self.one(link.angle)), w

    # -- the law ---------------------------------------------------------------------------------------------

    @cached_property
    def law(self) -> tuple[Any, Any]:
        """(T, V); V None of what is no spring."""
        element, scope = self.element, self.system.scope
        k, c = self.at((scope.value(element.stiffness), scope.value(element.damping)))
        length, rate = self.measured
        pull, energy = c * rate, None
        if element.stiffness is not None:
            stretch = length - self._slack
            pull, energy = pull + k * stretch, k * stretch * stretch / 2
        if element.pull is not None:
            r, r1 = (scope.graph.symbol(f"({name})") for name in ("r", "r'"))
            law = self.scene.value_at(element.pull, {"r": r, "r'": r1})
            pull += evaluate((law,), {**self.state, r: length, r1: rate}, fifty_digits())[0]
        return pull, energy

    @property
    def _slack(self) -> Any:
        slack = self.element.slack
        if not isinstance(slack, str):
            return self.at((self.system.scope.value(slack),))[0]
        first, second = (self.scene.position(self.scene.place(p)) for p in self.element.points)
        apart = self.vector([self.scene.start(x) for x in minus(second, first)])
        if self.element.along is not None:
            return dot(apart, self.direction)
        return dot(apart, direction_at(apart)) if any(apart) else 0

    # -- what acts -------------------------------------------------------------------------------------------

    def of_pull(self, pull: Any) -> Pushes:
        """By the law."""
        found: Pushes = {}
        if not self.element.points:
            for body, sign in zip(self.element.bodies, (1, -1), strict=True):
                add_push(found, body, (0, 0, sign * pull), ZERO)
            return found
        for point, place, sign in zip(self.element.points, self.ends, (1, -1), strict=True):
            f: Numbers = times(sign * pull, self.direction)
            add_push(found, self.scene.place(point)[0], cross(place, f), f)
        return found
