"""System, state -> whether T and V are those of its bodies: their constant parts, which no equation of motion knows.

    T = sum of (m v_C . v_C + w . I w)/2 by the twists,      V = - sum of f . r_C for weights f, and what else has one

Rotors in joints and energies that are given stand in T as they are stated, springs and given potentials in V.
"""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics.bodies.armature import given_energy
from eomgen.mechanics.bodies.inertia import HALF, armature_energy, mass_properties
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.load import BodyPoint, PointForce, UniformField
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import Vector, apply, dot, times
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
    yield given_energy(system.scope)
    for link in system.motion.links:
        mass, w = mass_properties(system.scope, link.name), link.twist.w
        v = link.twist.at(mass.com).v
        yield HALF * mass.m * dot(v, v)
        yield HALF * dot(w, apply(mass.I, w))
        yield armature_energy(system.motion, link)


def _of_places(system: System) -> Iterator[Scalar]:
    forces = system.scope.model.forces
    for applied in system.loads.applied:
        if applied.potential is not None and forces[applied.name].by_mass:
            for load in applied.loads:
                yield from (-dot(f, system.motion.position(place)) for place, f in _weights(system, load))
        elif applied.potential is not None:
            yield applied.potential
    yield from (effort.potential for effort in system.loads.efforts)


def _weights(system: System, load: object) -> Iterator[tuple[BodyPoint, Vector]]:
    """(mass centre, force) of what acts by mass."""
    if isinstance(load, PointForce):
        yield load.place, load.force
    elif isinstance(load, UniformField):
        for link in system.motion.links:
            mass = mass_properties(system.scope, link.name)
            yield (link.name, mass.com), times(mass.m, load.acceleration)
