"""A system at a state in numbers -> what output functions are worth there by their second definitions.

Poses and masses alone are evaluated, at the state and a moment before and after it, with 50 digits:

    q +- h q' + h^2 q''/2,  t +- h;     r' = (r+ - r-)/2h,  r'' = (r+ - 2 r + r-)/h^2
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.inertia import armature_energy
from eomgen.mechanics.bodies.loads import JointEffort, weights
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.model.forces.load import GeneralizedForce, PointForce
from eomgen.model.outputs import FUNCTIONS
from eomgen.proof.at_a_state import NumericState
from eomgen.proof.check import differing
from eomgen.proof.elements import acting
from eomgen.proof.free_bodies import drive_demanded, multipliers_demanded
from eomgen.proof.in_numbers import SECOND_STEP, Pushes, Way, add_push, pushes_of, way_through
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import (
    ZERO,
    Matrix,
    Numbers,
    Vector,
    apply,
    cross,
    dot,
    matrix_of,
    minus,
    plus,
    product,
    times,
    transposed,
    vector_of,
)
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import LARGEST_AT_50

UNIT: Matrix = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


@dataclass(frozen=True)
class NearbyStates:
    """The trial of output functions: the system at a state, a moment before it and a moment after."""

    state: NumericState

    @cached_property
    def scene(self) -> Quantities:
        return Quantities(self.state.equations.system)

    @property
    def step(self) -> Any:
        return SECOND_STEP

    @cached_property
    def _way(self) -> Way:
        system, zero = self.state.equations.system, fifty_digits().number(0)
        known = {**self.state.values, **dict.fromkeys(system.symbols.a, zero), **(self._accelerations or {})}
        return way_through(system, known, SECOND_STEP, order=2)

    @cached_property
    def _accelerations(self) -> dict[Node, Any] | None:
        """None where they are not determined: first rates do not need them, second ones are nan."""
        try:
            return self.state.unknowns
        except (NoValue, DerivationError):
            return None

    def along(self, scalars: Sequence[Scalar]) -> tuple[list[Any], list[Any], list[Any]]:
        """What functions of q and t are worth, and their first and second rates."""
        now, first, second = self._way.along(scalars)
        return now, first, second if self._accelerations is not None else [math.nan] * len(now)

    def around(self, place: Vector) -> tuple[Numbers, Numbers, Numbers]:
        """A place a moment before, now, and a moment later."""
        now, first, second = map(vector_of, self._way.along(place))
        moved, bent = times(SECOND_STEP, first), times(SECOND_STEP**2 / 2, second)
        return minus(plus(now, bent), moved), now, plus(plus(now, bent), moved)

    def particles(self, body: str, *, still: bool = False) -> list[tuple[Any, Numbers, Numbers]]:
        """(m, r, v): with P the integral of d d^T dm about the mass centre C, at C +- e_i and C +- (e_i + e_j)

            m_i = (P_ii - sum_j P_ij)/2,     m_ij = P_ij/2,     and at C what is left of m.

        Some of these masses are negative; energy, momentum and moments of inertia are linear in them.
        """
        motion = self.state.equations.system.motion
        if not still and not is_zero(armature_energy(motion, motion.link(body))):
            raise NoValue("rotors in a joint are no particles of the body")
        mass = self.scene.mass(body)
        P = self._second_moments(body, mass.I)
        arms = [(times(1, UNIT[i]), (P[i][i] - sum(P[i][j] for j in range(3) if j != i)) / 2) for i in range(3)]
        arms += [(plus(UNIT[i], UNIT[j]), P[i][j] / 2) for i, j in ((0, 1), (0, 2), (1, 2))]
        ends = [(end, m) for arm, m in arms if m for end in (arm, minus(ZERO, arm))]
        (whole,) = self.along((mass.m,))[0]
        held = [(ZERO, whole - sum(m for _, m in ends)), *ends]
        origin, R = self.scene.origin(body), self.scene.axes(body)
        places = [plus(origin, apply(R, plus(mass.com, arm))) for arm, _ in held]
        now, rates, _ = self.along([x for place in places for x in place])
        return [
            (m, vector_of(now[3 * k : 3 * k + 3]), vector_of(rates[3 * k : 3 * k + 3])) for k, (_, m) in enumerate(held)
        ]

    def _second_moments(self, body: str, I: Matrix) -> list[list[Any]]:
        """P = tr(I)/2 - I in body axes; a body of which the moment about z alone is known is thin."""
        flat = self.along([x for row in I for x in row])[0]
        if self.scene.known_about_z((body,)):
            return [[flat[8] / 2 if i == j < 2 else 0 * flat[8] for j in range(3)] for i in range(3)]
        half = (flat[0] + flat[4] + flat[8]) / 2
        return [[(half if i == j else 0) - flat[3 * i + j] for j in range(3)] for i in range(3)]

    def given_energy(self) -> Any:
        """The expressions of the file, coordinates' rates as differences say."""
        scope = self.state.equations.system.scope
        q = scope.symbols.q
        names = {f"{x.name}'": scope.graph.symbol(f"(difference of {x.name})") for x in q}
        known = {**self._way.now, **dict(zip(names.values(), self.along(q)[1], strict=True))}
        stated = [force.kinetic for force in scope.model.forces.values() if force.kinetic is not None]
        given = [formula.evaluate({**scope.names, **names}) for formula in stated]
        return sum(evaluate(given, known, fifty_digits()), start=0 * SECOND_STEP)

    def worked(self, body: str | None = None) -> Any:
        """Of every body F . v + tau . w, and s' times the effort of every joint."""
        system = self.state.equations.system
        loads, known = system.loads, dict(self._way.now)
        if any(isinstance(load, GeneralizedForce) for force in loads.applied for load in force.loads):
            raise NoValue("something acts at no place")
        placed = [load for force in loads.applied for load in force.loads]
        if system.motion.moves(tuple(x for load in placed if isinstance(load, PointForce) for x in load.place[1])):
            raise NoValue("a force acts at a place that slides in its body")
        energies = tuple(f.potential for f in loads.applied if f.placeless and f.potential is not None and body is None)
        if system.symbols.t in symbols_of(energies):
            raise NoValue("a potential depends on time")
        total = 0 * SECOND_STEP - sum(self.along(energies)[1])
        pushes = pushes_of(system.motion, known, (*placed, *weights(loads)))
        for effort in loads.efforts if body is not None else ():
            self._add_effort(pushes, effort)
        for name, (moment, force) in pushes.items():
            if body in (None, name):
                rates = vector_of(self.along(self.scene.origin(name))[1])
                flat = self.along([x for row in self.scene.axes(name) for x in row])
                W = product(_rows(flat[1]), transposed(_rows(flat[0])))
                w = (W[2][1], W[0][2], W[1][0])
                arm = vector_of(self.along(self.scene.origin(name))[0])
                total = total + dot(force, rates) + dot(minus(moment, cross(arm, force)), w)
        for effort in loads.efforts if body is None else ():
            link = system.motion.link(effort.body)
            (push,) = evaluate((effort.effort,), known, fifty_digits())
            total = total + push * self.along((link.s[effort.variable],))[1][0]
        return total

    def _add_effort(self, pushes: Pushes, effort: JointEffort) -> None:
        """A couple about the axis, or a force along it at the joint, on the child; the opposite on the parent."""
        motion = self.state.equations.system.motion
        link = motion.link(effort.body)
        turn, slide = link.S[effort.variable]
        if not (all(map(is_zero, turn)) or all(map(is_zero, slide))):
            raise NoValue("a joint that turns and slides at once")
        along = apply(link.pose.R, slide if all(map(is_zero, turn)) else turn)
        flat = self.along((effort.effort, *along, *link.pose.point(link.point)))[0]
        push, place = times(flat[0], vector_of(flat[1:4])), vector_of(flat[4:7])
        parent = None if link.parent < 0 else motion.links[link.parent].name
        for name, sign in ((effort.body, 1), (parent, -1)):
            own: Numbers = times(sign, push)
            add_push(pushes, name, *((own, ZERO) if all(map(is_zero, slide)) else (cross(place, own), own)))

    def acting(self, force: str) -> Any:
        """Of what is declared between two points, or two bodies, by the twists."""
        return acting(self.state.equations.system, self.state.values, force)

    def demanded(self, coordinate: str) -> Any:
        """M a + c - Q - J^T lam of the freed coordinate, by the free bodies, at the motion as it is given."""
        return drive_demanded(self.state.equations.system, coordinate, self.state.values | self.state.unknowns)[0]

    def held(self, tie: str) -> Any:
        """lam of a tie of one row, by the balance of the free bodies on which all ties push."""
        equations, known = self.state.equations, self.state.values | self.state.unknowns
        friction = evaluate(equations.friction or (), known, fifty_digits())
        found = multipliers_demanded(equations.system, known, friction)
        if (tie, 1) not in found:
            raise NoValue("it shares its force with other ties")
        return found[tie, 1]

    def root(self, x: Any) -> Any:
        """Of a number."""
        return fifty_digits().functions["sqrt"](x)

    def eigenvalues(self, rows: Sequence[Sequence[Any]]) -> list[Any]:
        """Of a symmetric matrix, ascending."""
        context = rows[0][0].context
        found: list[Any] = sorted(context.eigsy(context.matrix(rows), eigvals_only=True))
        return found

    def faster(self, speed: str, by: float) -> NearbyStates:
        """The same with one speed larger.

        Raises:
            NoValue: it is no speed of the system.
        """
        found = [u for u in self.state.equations.symbols.u if u.name == speed]
        if not found:
            raise NoValue(f"'{speed}' is no speed of these equations")
        numbers = {**self.state.numbers, found[0]: self.state.numbers[found[0]] + by}
        return NearbyStates(replace(self.state, numbers=numbers))


def _rows(flat: Sequence[Any]) -> Matrix:
    return matrix_of((flat[0:3], flat[3:6], flat[6:9]))


def second_definition(state: NumericState, call: Call) -> str:
    """That a function of the motion is not worth what its second definition says, in words; "".

    Raises:
        NoValue: it has no value by one of the two.
        DerivationError: it has no meaning there.
    """
    second = FUNCTIONS[call.name].second
    assert second is not None, "asked of those that have one"
    if any(abs(x) > LARGEST_AT_50 for x in state.numbers.values()):
        raise NoValue("coordinates or speeds too large for differences")
    found = state.number(Quantities(state.equations.system).value(call))
    right = float(second(NearbyStates(state), call))
    if math.isnan(right):
        raise NoValue("accelerations are not determined there")
    return differing(found, right)
