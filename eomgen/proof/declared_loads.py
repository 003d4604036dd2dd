"""Forces, springs and strings at a state -> checks that they act as their fields declare."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from random import Random
from typing import Any

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.kinematics import (
    Applied,
    BodyLink,
    ContactMode,
    JointEffort,
    SystemScene,
)
from eomgen.model import (
    Act,
    CoupleOn,
    ElasticThread,
    Element,
    FlowOfMass,
    GivenEnergy,
    Meshing,
    PushAlong,
    PushAlongLine,
    PushAt,
    PushOfMass,
    PushOnCoordinate,
)
from eomgen.proof.declared_threads import StretchedRope
from eomgen.proof.in_numbers import (
    STEP,
    InNumbers,
    Pushes,
    Way,
    add_push,
    direction_at,
    mass_that_enters,
    pushed_otherwise,
    pushes_of,
    way_through,
)
from eomgen.symbolic.expression import Fraction, Scalar, State, Vector, is_zero
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

# -------- declared work ---------------------------------------------------------------------------------------
# System, state -> whether all that is applied acts as its fields declare it, in numbers: no load is looked at twice.
#
#     sum F . dr + sum tau . w + sum Q_i dq_i + sum f ds - dV  =  Q . d,      dq = N d,  d at random
#
# dr, w = vee(dR R^T), ds and dV are central differences of the places, axes, joint variables and energies at q +- h N
# d. A line load is taken by Simpson's rule, which is exact for it. Before the whole, each force by itself, on every
# body: moment about the ground's origin and force, ground axes.


Term = tuple[Scalar, Any]
"""(a scalar that moves, the work for a unit of it)"""
Placed = tuple[str | None, tuple[Scalar, ...], Vector]
"""(body, a place of it as a function of the coordinates, the force there in ground axes)"""
HALF = Fraction(1, 2)
SIMPSON = ((0, 1), (1, 4), (2, 1))  # (halves of the way, sixths of the length)


def acting_otherwise(system: System, state: State) -> str:
    """Message if a force pushes a body otherwise than it is declared, at a state; "".

    Raises:
        NoValue: something has no value there.
    """
    proof = _Declared(system, state)
    for applied in system.loads.applied:
        if applied.is_field:
            continue
        due = proof.pushes(system.scope.model.forces[applied.name].acts)
        if body := pushed_otherwise(pushes_of(system.motion, state, applied.loads), due, _size(due)):
            return f"forces.{applied.name} pushes '{body}' otherwise than it is declared"
    due = proof.pushes(proof.acts)
    stated = pushes_of(system.motion, state, (*system.loads.placed, *system.loads.weights))
    if body := pushed_otherwise(stated, due, _size(due)):
        return f"all forces together push '{body}' otherwise than they are declared"
    return ""


def declared_pushes(system: System, state: State, force: str) -> Pushes:
    """Wrench (moment about the ground's origin, force) of one force on each body, as its fields declare it.

    Raises:
        NoValue: it has none at the state.
    """
    return _Declared(system, state).pushes(system.scope.model.forces[force].acts)


def placed_pushes(system: System, state: State, acts: Iterable[Act]) -> Iterator[Placed]:
    """The forces of acts that have a place.

    Raises:
        NoValue: something has no value there.
    """
    declared = _Declared(system, state)
    for act in acts:
        yield from declared.placed(act)


def working_otherwise(equations: EquationsOfMotion, state: State) -> str:
    """Message if the work of Q along a random direction is not that of the declared loads; "".

    Raises:
        NoValue: something has no value there.
    """
    proof, u = _Declared(equations.system, state), equations.symbols.u
    rng = Random(23)
    d = [fifty_digits().number(rng.choice((-1, 1)) * rng.randint(50, 100)) / 100 for _ in u]
    friction = equations.friction or (0,) * len(u)
    Q = proof.at(tuple(x - f for x, f in zip(equations.Q, friction, strict=True)))
    stated = sum((x * y for x, y in zip(Q, d, strict=True)), start=0)
    works = proof.works(proof.turned(d))
    due, size = sum(works, start=0), 1 + sum(map(abs, works)) + sum(abs(x * y) for x, y in zip(Q, d, strict=True))
    if abs(stated - due) <= tolerances.DIFFERENCE_AT_50 * size:
        return ""
    return f"Q does the work {float(stated):.10g} for {float(due):.10g} of all that is declared"


def _size(pushes: Pushes) -> Any:
    return 1 + sum(abs(x) for both in pushes.values() for v in both for x in v)


@dataclass(frozen=True)
class _Declared(InNumbers):
    """All that is declared, at one state."""

    @property
    def scene(self) -> SystemScene:
        return SystemScene(self.motion, begun=self.system.loads.begun)

    def turned(self, d: Sequence[Any]) -> Way:
        """The states at q +- h N d; nothing else changes."""
        symbols, scope = self.system.symbols, self.system.scope
        flat = self.at([x for row in scope.N for x in row])
        n = len(symbols.u)
        moved = [
            sum((x * y for x, y in zip(flat[n * i : n * i + n], d, strict=True)), start=0) for i in range(len(scope.N))
        ]

        def nearby(h: Any) -> State:
            return {**self.state, **{q: self.state[q] + h * x for q, x in zip(symbols.q, moved, strict=True)}}

        return Way((nearby(-STEP), self.state, nearby(STEP)), STEP)

    # -- work ------------------------------------------------------------------------------------------------

    def works(self, way: Way) -> list[Any]:
        """Virtual work of every act and every joint, along a direction of motion."""
        terms = [term for act in self.acts for term in self._terms(act)]
        terms += [self._of_joint(link, push) for link, push in self._in_joints]
        rates = way.rates([moving for moving, _ in terms])
        return [k * x for (_, k), x in zip(terms, rates, strict=True)]

    @property
    def acts(self) -> Iterator[Act]:
        for force in self.system.scope.model.forces.values():
            yield from force.acts

    @property
    def _in_joints(self) -> Iterator[tuple[BodyLink, PushAlong]]:
        for link in self.system.motion.links:
            yield from () if link.joint is None else ((link, push) for push in link.joint.pushes())

    def _terms(self, act: Act) -> Iterator[Term]:
        scope = self.system.scope
        if isinstance(act, CoupleOn):
            yield from self._of_couple(act.body, self._couple(act))
        elif isinstance(act, PushOnCoordinate):
            yield scope.names[act.coordinate], self.one(scope.value(act.value))
        elif isinstance(act, GivenEnergy):
            yield scope.value(act.potential), fifty_digits().number(-1)
        elif isinstance(act, Element) and not act.points:
            pull = ActingElement(self.system, self.state, act).law[0]
            for body, sign in zip(act.bodies, (1, -1), strict=True):
                if body is not None:
                    yield from self._of_couple(body, Vector((0, 0, sign * pull)))
        elif isinstance(act, Meshing):
            for body, couple in self._meshing(act):
                yield from self._of_couple(body, couple)
        elif isinstance(act, ElasticThread):
            for stop, at, pull in StretchedRope(self.system, self.state, act).pulls():
                yield from zip(stop.place, pull, strict=True)
                if stop.body is not None:
                    yield from self._of_couple(stop.body, (at - stop.center).cross(pull))
        else:
            for _, place, force in self.placed(act):
                yield from zip(place, force, strict=True)

    def _of_couple(self, body: str, couple: Sequence[Any]) -> Iterator[Term]:
        """tau . vee(dR R^T), entry by entry of dR."""
        R = self.motion.link(body).pose.R
        now = self.at([x for row in R for x in row])
        for i, j, axis in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
            if couple[axis]:
                yield from ((R[i][k], couple[axis] * now[3 * j + k]) for k in range(3))

    def _of_joint(self, link: BodyLink, push: PushAlong) -> Term:
        """(push - c s' - k (s - rest) and dry friction) ds, s' along the motion."""
        scope = self.system.scope
        s = scope.value(push.way)
        f, k, c, rest, now = self.at((*map(scope.value, (push.push, push.stiffness, push.damping, push.rest)), s))
        moves = c or push.friction is not None
        rate = way_through(self.system, self.state).rates((s,))[0] if moves else 0
        return s, f - c * rate - k * (now - rest) + dry_friction(self.system, self.state, (link, push), rate)

    # -- loads on bodies -------------------------------------------------------------------------------------

    def pushes(self, acts: Iterable[Act]) -> Pushes:
        """Wrench (moment about the ground's origin, force) of acts on each body."""
        found: Pushes = {}
        for act in acts:
            if isinstance(act, CoupleOn):
                add_push(found, act.body, self._couple(act), Vector.ZERO)
            elif isinstance(act, Element) and not act.points:
                pull = ActingElement(self.system, self.state, act).law[0]
                for body, sign in zip(act.bodies, (1, -1), strict=True):
                    add_push(found, body, Vector((0, 0, sign * pull)), Vector.ZERO)
            elif isinstance(act, Meshing):
                for body, couple in self._meshing(act):
                    add_push(found, body, couple, Vector.ZERO)
            elif isinstance(act, ElasticThread):
                for stop, at, pull in StretchedRope(self.system, self.state, act).pulls():
                    add_push(found, stop.body, at.cross(pull), pull)
            elif not isinstance(act, (PushOnCoordinate, GivenEnergy)):
                for body, place, force in self.placed(act):
                    add_push(found, body, self.vector(place).cross(force), force)
        return found

    def placed(self, act: Act) -> Iterator[Placed]:
        """The forces of an act that has a place."""
        if isinstance(act, PushAt):
            place = self.scene.place(act.point)
            axes = None if act.axes == "ground" else act.axes
            force = self.carried(axes, self.vector(self.scene.vector(act.force)), direction=True)
            yield place[0], self.scene.position(place), force
        elif isinstance(act, PushAlongLine):
            yield from self._along_line(act)
        elif isinstance(act, PushOfMass):
            g = self.vector(self.scene.vector(act.acceleration))
            for name in act.bodies or [link.name for link in self.motion.links]:
                mass = self.system.scope.mass_properties(name)
                yield name, self.scene.position((name, mass.com)), self.one(mass.m) * g
        elif isinstance(act, Element):
            yield from self._of_element(act)
        elif isinstance(act, FlowOfMass):
            yield self._of_flow(act)

    def _along_line(self, line: PushAlongLine) -> Iterator[Placed]:
        """Forces that replace a line load by Simpson's rule, at both ends and in the middle."""
        places = [
            self.scene.position(self.scene.place(name if "." in name else f"{line.body}.{name}")) for name in line.ends
        ]
        A, B = map(self.vector, places)
        q = [self.vector(self.scene.vector(each)) for each in line.intensities]
        gap = B - A
        sixth = fifty_digits().functions["sqrt"](gap @ gap) / 6
        for halves, sixths in SIMPSON:
            here = sixth * sixths / 2 * ((2 - halves) * q[0] + halves * q[1])
            yield line.body, _between(places, halves), here

    def _of_flow(self, act: FlowOfMass) -> Placed:
        """m' w, m' by a central difference of the declared mass, w less the velocity of the point by the twist."""
        body, at = self.scene.place(act.point)
        place = self.scene.position((body, at))
        flow = self.carried(
            None if act.axes == "ground" else act.axes, self.vector(self.scene.vector(act.velocity)), direction=True
        )
        if act.absolute:
            flow = flow - self.velocity(body, self.vector(place)) - self._slid(body, at)
        return body, place, mass_that_enters(self.system, self.state, act) * flow

    def _slid(self, body: str | None, at: Vector) -> Vector:
        """Velocity of a point that moves in its body, against the body."""
        rates = way_through(self.system, self.state).rates(at)
        return self.carried(body, Vector(rates), direction=True)

    def _of_element(self, element: Element) -> Iterator[Placed]:
        acting = ActingElement(self.system, self.state, element)
        for point, sign in zip(element.points, (1, -1), strict=True):
            place = self.scene.place(point)
            yield place[0], self.scene.position(place), sign * acting.law[0] * acting.direction

    def _meshing(self, act: Meshing) -> list[tuple[str, Vector]]:
        """(wheel, couple) of both: the teeth push where x is beyond the play; the driven wheel gets its share."""
        value, (first, second) = self.system.scope.value, act.bodies
        ratio, k, c, play = self.at((*map(value, (act.ratio, act.stiffness, act.damping, act.play)),))
        eta = 1 if act.efficiency is None else self.one(value(act.efficiency))
        begun = self.one(self.scene.start(self.scene.angle(first) - value(act.ratio) * self.scene.angle(second)))
        pair = ActingElement(self.system, self.state, Element(bodies=act.bodies))
        (theta_1, w_1), (theta_2, w_2) = map(pair.turned, act.bodies)
        x, rate = theta_1 - ratio * theta_2 - begun, w_1 - ratio * w_2
        side = 1 if x > 0 else -1
        beyond = side * x - play / 2
        M = side * max(k * beyond + side * c * rate, 0) if beyond > 0 else 0 * x
        M = k * x + c * rate if act.play is None else M
        if act.smooth is None:
            drives = (M * w_1 > 0) - (M * w_1 < 0)
        else:
            drives = fifty_digits().functions["tanh"](w_1 / self.one(value(act.smooth))) * ((M > 0) - (M < 0))
        lost = (1 - eta) / fifty_digits().number(2)
        on_first, on_second = -M * (1 - lost * (1 - drives)), ratio * M * (1 - lost * (1 + drives))
        return [(first, Vector((0, 0, on_first))), (second, Vector((0, 0, on_second)))]

    def _couple(self, act: CoupleOn) -> Vector:
        given = self.at([self.system.scope.value(x) for x in act.couple])
        own = Vector(given if len(given) == 3 else (0, 0, *given))
        return self.carried(None if act.axes == "ground" else act.axes, own, direction=True)


def _between(places: Sequence[Sequence[Scalar]], halves: int) -> tuple[Scalar, ...]:
    """Start, middle or end of two places, for 0, 1 or 2 halves of the way."""
    if halves != 1:
        return tuple(places[halves // 2])
    return tuple(HALF * (a + b) for a, b in zip(*places, strict=True))


# -------- elements --------------------------------------------------------------------------------------------
# System, state -> whether springs, dampers and pulls act as they are declared, in numbers.
#
#     l = |r_2 - r_1| (or n . (r_2 - r_1)),  l' = n . (v_2 - v_1);   theta between the axes of both, theta' = w_2 - w_1
#     T = k (l - l_0) + c l' + f(l, l')      on the first along n, on the second the opposite;   V = k (l - l_0)^2 / 2
#
# Places and axes are those of the poses, velocities those of the twists. An angle has the whole turns of its body.
# Lengths, rates, stretches and loads of the laws are proven here.


def elements_of(system: System) -> tuple[tuple[Applied, Element], ...]:
    """The springs, dampers and pulls of a system."""
    forces = system.scope.model.forces
    found = ((applied, forces[applied.name].element) for applied in system.loads.applied)
    return tuple((applied, element) for applied, element in found if element is not None)


def undeclared(system: System, state: State) -> str:
    """Message that names an element which acts otherwise than it is declared, at a state; "".

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
    """Pull of an element [N], or its moment on the second body [N m], by its declaration at a state."""
    declared = system.scope.model.forces[force]
    if declared.element is None:
        (rope,) = (act for act in declared.acts if isinstance(act, ElasticThread))
        return StretchedRope(system, state, rope).tension
    return ActingElement(system, state, declared.element).law[0]


def _in_joint(system: System, state: State, effort: JointEffort) -> str:
    """effort = drive - c s' - k (s - rest), V = k (s - rest)^2 / 2: s from the poses, s' from the twists of both.

    Raises:
        NoValue: the joint turns about several axes; a pose does not determine its angles.
    """
    link, scope = system.motion.link(effort.body), system.scope
    law = link.joint.pushes()[effort.variable]
    declared = tuple(map(scope.value, (law.push, law.damping, law.stiffness, law.rest)))
    drive, c, k, rest, stated, V = evaluate((*declared, effort.effort, effort.potential), state, fifty_digits())
    s, rate = _joint_motion(system, state, link, effort.variable)
    stretch, drive = s - rest, drive + dry_friction(system, state, (link, law), rate)
    if _turns(link, effort.variable) and k != 0:
        stretch = _by_whole_turns(stretch, (drive - c * rate - stated) / k)
    left, energy = stated - (drive - c * rate - k * stretch), k * stretch * stretch / 2
    if abs(left) > tolerances.ZERO_AT_50 * (1 + abs(stated)):
        return "pushes otherwise than its drive, rate and place say"
    return _energy(V, energy)


def dry_friction(system: System, state: State, acting: tuple[BodyLink, PushAlong], rate: Any) -> Any:
    """- T sign(s'), in a phase of the sense of its mode, or - T tanh(s'/v): of constant size, as it is declared."""
    link, push = acting
    law = push.friction
    if law is None or law.size is None:
        return 0
    given = (law.size, *(() if law.smooth is None else (law.smooth,)))
    size, *speed = evaluate(tuple(map(system.scope.value, given)), state, fifty_digits())
    if speed:
        return -size * fifty_digits().functions["tanh"](rate / speed[0])
    (name,) = (link.joint.named_contact(link.name, field) for _, field, each in link.joint.frictions if each is law)
    sense = system.modes.get(name, ContactMode()).sense
    return -size * ((rate > 0) - (rate < 0) if sense is None else sense)


def _energy(stated: Any, due: Any) -> str:
    """Message if a stated energy differs from the due one; ""."""
    same = abs(stated - due) <= tolerances.ZERO_AT_50 * (1 + abs(due))
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
    turning = _turns(link, variable)
    column = link.S[variable][0 if turning else 1]
    n, Q = here.R @ column, here.R @ home.R.T
    own = link.twist.w if turning else link.twist.v + link.twist.w.cross(link.point)
    against = link.pose.R @ own
    if link.parent >= 0:
        parent = system.motion.links[link.parent]
        carried = parent.twist.at(link.local.p)
        against = against - parent.pose.R @ (carried.w if turning else carried.v)
    requested = (
        n @ Vector((Q[2][1] - Q[1][2], Q[0][2] - Q[2][0], Q[1][0] - Q[0][1])),
        Q[0][0] + Q[1][1] + Q[2][2] - 1,
        n @ (here.p - home.p),
        column @ column,
        against @ (link.pose.R @ column),
    )
    sine, cosine, way, square, rate = evaluate(requested, state, fifty_digits())
    size = square**0.5
    return fifty_digits().functions["atan2"](sine / size, cosine) / size if turning else way / square, rate / square


def _by_whole_turns(angle: Any, other: Any) -> Any:
    """Angle with the number of whole turns that brings it nearest to another."""
    turn = 2 * fifty_digits().functions["pi"]()
    return angle + turn * round((other - angle) / turn)


@dataclass(frozen=True)
class ActingElement(InNumbers):
    """One element at one state."""

    element: Element

    def wrong(self, applied: Applied) -> str:
        """Message if the loads or the energy of the element are not those of its law; ""."""
        pull, energy = self.law
        reach: Any = 1 + max((end.largest for end in self.ends), default=0)
        stated = pushes_of(self.motion, self.state, applied.loads)
        if body := pushed_otherwise(stated, self.of_pull(pull), (1 + abs(pull)) * reach):
            return f"pushes '{body}' otherwise than its length and rate say"
        if energy is not None and applied.potential is not None:
            return _energy(self.at((applied.potential,))[0], energy)
        return ""

    @property
    def scene(self) -> SystemScene:
        return SystemScene(self.motion, begun=self.system.loads.begun)

    # -- geometry --------------------------------------------------------------------------------------------

    @cached_property
    def ends(self) -> tuple[Vector, ...]:
        return tuple(self.vector(self.scene.position(self.scene.place(p))) for p in self.element.points)

    @cached_property
    def direction(self) -> Vector:
        """Direction of the pull on the first end, a unit vector; 0 for a spring whose ends coincide."""
        along = self.element.along
        v: Vector = self.ends[1] - self.ends[0] if along is None else self.vector(self.scene.vector(along))
        if along is None and self._is_spring_without_length and not any(v):
            return Vector.ZERO  # it pulls nothing, in no direction
        return direction_at(v)

    @property
    def _is_spring_without_length(self) -> bool:
        """True if the pull is k l alone, which is smooth where the ends meet."""
        element = self.element
        springs = element.stiffness is not None and element.damping is None and element.pull is None
        return springs and self._slack == 0

    @property
    def measured(self) -> tuple[Any, Any]:
        """(l, l') or (theta, theta')."""
        if not self.element.points:
            (first, w_1), (second, w_2) = map(self.turned, self.element.bodies)
            return second - first, w_2 - w_1
        speeds = [self.vector(self.motion.velocity(self.scene.place(p))) for p in self.element.points]
        n = self.direction
        return (self.ends[1] - self.ends[0]) @ n, (speeds[1] - speeds[0]) @ n

    def turned(self, body: str | None) -> tuple[Any, Any]:
        """Angle of the axes about z, with the whole turns of the body, and its rate."""
        if body is None:
            return 0, 0
        link = self.motion.link(body)
        c, s, w = self.at((link.pose.R[0][0], link.pose.R[1][0], link.twist.w[2]))
        angle = fifty_digits().functions["atan2"](s, c)
        return angle if link.angle is None else _by_whole_turns(angle, self.one(link.angle)), w

    # -- the law ---------------------------------------------------------------------------------------------

    @property
    def law(self) -> tuple[Any, Any]:
        """(T, V); V is None where the element is no spring."""
        element, scope = self.element, self.system.scope
        k, c = self.at((scope.value(element.stiffness), scope.value(element.damping)))
        length, rate = self.measured
        pull, energy = c * rate, None
        if element.pushes:
            return self._pushed(self._slack - length, rate)
        if element.stiffness is not None:
            stretch = length - self._slack
            pull, energy = pull + k * stretch, k * stretch * stretch / 2
        if element.pull is not None:
            r, r1 = (scope.graph.symbol(f"({name})") for name in ("r", "r'"))
            law = self.scene.value_at(element.pull, {"r": r, "r'": r1})
            pull += evaluate((law,), {**self.state, r: length, r1: rate}, fifty_digits())[0]
        return pull, energy

    def _pushed(self, x: Any, rate: Any) -> tuple[Any, Any]:
        """(T, V) of a bumper that is compressed by x: - (k x^n (1 + a x') + d x') where both are above 0."""
        element, value = self.element, self.system.scope.value
        k, c, a = self.at((value(element.stiffness), value(element.damping), value(element.dissipation)))
        n = 1 if element.power is None else self.one(value(element.power))
        if x <= 0:
            return 0 * x, 0 * x
        push = k * x**n
        return -max(push * max(1 - a * rate, 0) - c * rate, 0 * x), push * x / (n + 1)

    @property
    def _slack(self) -> Any:
        slack = self.element.slack
        if not isinstance(slack, str):
            return self.at((self.system.scope.value(slack),))[0]
        first, second = (self.scene.position(self.scene.place(p)) for p in self.element.points)
        apart = self.vector([self.scene.start(x) for x in second - first])
        if self.element.along is not None:
            return apart @ self.direction
        return apart @ direction_at(apart) if any(apart) else 0

    # -- acts ------------------------------------------------------------------------------------------------

    def of_pull(self, pull: Any) -> Pushes:
        """Wrench of a pull on each body."""
        found: Pushes = {}
        if not self.element.points:
            for body, sign in zip(self.element.bodies, (1, -1), strict=True):
                add_push(found, body, Vector((0, 0, sign * pull)), Vector.ZERO)
            return found
        for point, place, sign in zip(self.element.points, self.ends, (1, -1), strict=True):
            f: Vector = sign * pull * self.direction
            add_push(found, self.scene.place(point)[0], place.cross(f), f)
        return found
