"""System, state -> whether T and V are those of its bodies: their constant parts, which no equation of motion knows.

    T = sum of (m v_C . v_C + w . I w)/2 by the twists,      V = - sum of m g . r_C, and what else has one

Rotors, springs of joints and given energies are taken from their fields.
"""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics.bodies.inertia import HALF, mass_properties
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.element import GivenEnergy, PushOfMass
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import apply, dot
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50


def other_energies(equations: EquationsOfMotion, state: State) -> str:
    """Which energy is another one at a state; "" where neither is."""
    terms = {"T": [*_of_motion(equations.system)], "V": [*_of_places(equations.system)]}
    values = iter(evaluate((equations.T, equations.V, *terms["T"], *terms["V"]), state, fifty_digits()))
    stated = {"T": next(values), "V": next(values)}
    for letter, parts in terms.items():
        due = [next(values) for _ in parts]
        total = sum(due, start=0 * stated[letter])
        if abs(stated[letter] - total) > ZERO_AT_50 * (1 + sum(map(abs, due))):
            return f"{letter} is {float(stated[letter]):.10g}, that of the bodies {float(total):.10g}"
    return ""


def _of_motion(system: System) -> Iterator[Scalar]:
    scope = system.scope
    for force in scope.model.forces.values():
        yield from (scope.value(act.kinetic) for act in force.acts if isinstance(act, GivenEnergy))
    for link in system.motion.links:
        mass, w = mass_properties(scope, link.name), link.twist.w
        v = link.twist.at(mass.com).v
        yield HALF * mass.m * dot(v, v)
        yield HALF * dot(w, apply(mass.I, w))
        for push in () if link.joint is None else link.joint.pushes():
            rate = scope.time_derivative((scope.value(push.way),))[0]
            yield HALF * scope.value(push.armature) * rate * rate


def _of_places(system: System) -> Iterator[Scalar]:
    """Of weights and given energies as they are declared; springs' and pulls' own are looked at by themselves."""
    scope = system.scope
    for applied in system.loads.applied:
        for act in scope.model.forces[applied.name].acts:
            if isinstance(act, PushOfMass):
                yield from _of_weights(system, act)
            elif isinstance(act, GivenEnergy):
                yield scope.value(act.potential)
            elif applied.potential is not None:
                yield applied.potential
    for link in system.motion.links:
        for push in () if link.joint is None else link.joint.pushes():
            stretch = scope.value(push.way) - scope.value(push.rest)
            yield HALF * scope.value(push.stiffness) * stretch * stretch


def _of_weights(system: System, act: PushOfMass) -> Iterator[Scalar]:
    g = system.scope.vector(act.acceleration)
    for name in act.bodies or [link.name for link in system.motion.links]:
        mass = mass_properties(system.scope, name)
        yield -mass.m * dot(g, system.motion.position((name, mass.com)))
