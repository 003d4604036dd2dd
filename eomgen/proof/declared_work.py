"""System, state -> whether all that is applied acts as its fields declare it, in numbers: no load is looked at twice.

    sum F . dr + sum tau . w + sum Q_i dq_i + sum f ds - dV  =  Q . d,      dq = N d,  d at random

dr, w = vee(dR R^T), ds and dV are central differences of the places, axes, joint variables and energies at q +- h N d.
A line load is taken by Simpson's rule, which is exact for it. Before the whole, each force by itself, on every body:
moment about the ground's origin and force, ground axes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from random import Random
from typing import Any

from eomgen.mechanics.bodies.inertia import HALF, mass_properties
from eomgen.mechanics.bodies.loads import weights
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.element import (
    Act,
    CoupleOn,
    Element,
    GivenEnergy,
    PushAlongLine,
    PushAt,
    PushOfMass,
    PushOnCoordinate,
)
from eomgen.model.forces.load import UniformField
from eomgen.model.joints.moves import PushAlong
from eomgen.proof.elements import ActingElement
from eomgen.proof.in_numbers import STEP, InNumbers, Pushes, Way, add_push, pushed_otherwise, pushes_of, way_through
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import ZERO, Numbers, cross, dot, minus, plus, times, vector_of
from eomgen.symbolic.numeric.evaluation import fifty_digits
from eomgen.symbolic.numeric.tolerances import DIFFERENCE_AT_50

Term = tuple[Scalar, Any]
"""(what moves, what is done for a unit of it)"""
Placed = tuple[str | None, tuple[Scalar, ...], Numbers]
"""(body, a place of it as a function of the coordinates, the force there in ground axes)"""
SIMPSON = ((0, 1), (1, 4), (2, 1))  # (halves of the way, sixths of the length)


def acting_otherwise(system: System, state: State) -> str:
    """What pushes bodies otherwise than it is declared at a state; "" where nothing does.

    Raises:
        NoValue: something has no value there.
    """
    proof = _Declared(system, state)
    for applied in system.loads.applied:
        if any(isinstance(load, UniformField) for load in applied.loads):
            continue
        due = proof.pushes(system.scope.model.forces[applied.name].acts)
        if body := pushed_otherwise(pushes_of(system.motion, state, applied.loads), due, _size(due)):
            return f"forces.{applied.name} pushes '{body}' otherwise than it is declared"
    due = proof.pushes(proof.acts)
    stated = pushes_of(system.motion, state, (*system.loads.placed, *weights(system.loads)))
    if body := pushed_otherwise(stated, due, _size(due)):
        return f"all forces together push '{body}' otherwise than they are declared"
    return ""


def declared_pushes(system: System, state: State, force: str) -> Pushes:
    """Of each body (moment about the ground's origin, force) of one force as its fields declare it.

    Raises:
        NoValue: it has none at the state.
    """
    return _Declared(system, state).pushes(system.scope.model.forces[force].acts)


def working_otherwise(equations: EquationsOfMotion, state: State) -> str:
    """That Q does another work along a random direction than what is declared; "".

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
    if abs(stated - due) <= DIFFERENCE_AT_50 * size:
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

        def beside(h: Any) -> State:
            return {**self.state, **{q: self.state[q] + h * x for q, x in zip(symbols.q, moved, strict=True)}}

        return Way((beside(-STEP), self.state, beside(STEP)), STEP)

    # -- work ------------------------------------------------------------------------------------------------

    def works(self, way: Way) -> list[Any]:
        """Of every act and every joint, along a way."""
        terms = [term for act in self.acts for term in self._terms(act)]
        terms += [term for push in self._in_joints for term in self._of_joint(push)]
        rates = way.rates([moving for moving, _ in terms])
        return [k * x for (_, k), x in zip(terms, rates, strict=True)]

    @property
    def acts(self) -> Iterator[Act]:
        for force in self.system.scope.model.forces.values():
            yield from force.acts

    @property
    def _in_joints(self) -> Iterator[PushAlong]:
        for link in self.system.motion.links:
            yield from () if link.joint is None else link.joint.pushes()

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
                    yield from self._of_couple(body, (0, 0, sign * pull))
        else:
            for _, place, force in self._placed(act):
                yield from zip(place, force, strict=True)

    def _of_couple(self, body: str, couple: Sequence[Any]) -> Iterator[Term]:
        """tau . vee(dR R^T), entry by entry of dR."""
        R = self.motion.link(body).pose.R
        now = self.at([x for row in R for x in row])
        for i, j, axis in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
            if couple[axis]:
                yield from ((R[i][k], couple[axis] * now[3 * j + k]) for k in range(3))

    def _of_joint(self, push: PushAlong) -> Iterator[Term]:
        """(push - c s' - k (s - rest)) ds, s' along the motion."""
        scope = self.system.scope
        s = scope.value(push.way)
        f, k, c, rest, now = self.at((*map(scope.value, (push.push, push.stiffness, push.damping, push.rest)), s))
        rate = way_through(self.system, self.state).rates((s,))[0] if c else 0
        yield s, f - c * rate - k * (now - rest)

    # -- what acts on bodies ---------------------------------------------------------------------------------

    def pushes(self, acts: Iterable[Act]) -> Pushes:
        """Of each body (moment about the ground's origin, force)."""
        found: Pushes = {}
        for act in acts:
            if isinstance(act, CoupleOn):
                add_push(found, act.body, self._couple(act), ZERO)
            elif isinstance(act, Element) and not act.points:
                pull = ActingElement(self.system, self.state, act).law[0]
                for body, sign in zip(act.bodies, (1, -1), strict=True):
                    add_push(found, body, (0, 0, sign * pull), ZERO)
            elif not isinstance(act, (PushOnCoordinate, GivenEnergy)):
                for body, place, force in self._placed(act):
                    add_push(found, body, cross(self.vector(place), force), force)
        return found

    def _placed(self, act: Act) -> Iterator[Placed]:
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
                mass = mass_properties(self.system.scope, name)
                yield name, self.scene.position((name, mass.com)), times(self.one(mass.m), g)
        elif isinstance(act, Element):
            yield from self._of_element(act)

    def _along_line(self, line: PushAlongLine) -> Iterator[Placed]:
        """By Simpson's rule: the load at both ends and half way, there on the middle of the ends."""
        places = [
            self.scene.position(self.scene.place(name if "." in name else f"{line.body}.{name}")) for name in line.ends
        ]
        A, B = map(self.vector, places)
        q = [self.vector(self.scene.vector(each)) for each in line.intensities]
        gap = minus(B, A)
        sixth = fifty_digits().functions["sqrt"](dot(gap, gap)) / 6
        for halves, sixths in SIMPSON:
            here = times(sixth * sixths / 2, plus(times(2 - halves, q[0]), times(halves, q[1])))
            yield line.body, _between(places, halves), here

    def _of_element(self, element: Element) -> Iterator[Placed]:
        acting = ActingElement(self.system, self.state, element)
        for point, sign in zip(element.points, (1, -1), strict=True):
            place = self.scene.place(point)
            yield place[0], self.scene.position(place), times(sign * acting.law[0], acting.direction)

    def _couple(self, act: CoupleOn) -> Numbers:
        given = self.at([self.system.scope.value(x) for x in act.couple])
        own = vector_of(given if len(given) == 3 else (0, 0, *given))
        return self.carried(None if act.axes == "ground" else act.axes, own, direction=True)


def _between(places: Sequence[Sequence[Scalar]], halves: int) -> tuple[Scalar, ...]:
    """So many halves of the way from one place to another."""
    if halves != 1:
        return tuple(places[halves // 2])
    return tuple(HALF * (a + b) for a, b in zip(*places, strict=True))
