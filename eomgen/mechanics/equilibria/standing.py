"""System -> the same as it stands at rest: over its rates alone, and its explicit times held at 0.

At rest all rates are 0. A declared speed w = Y q' + y(q, t) is then y, and need not stay: where y is not 0, rest is
said of the rates. A surface or a seat that moves by an explicit time stands where it is at t = 0, as the forces do.
"""

from __future__ import annotations

from dataclasses import replace

from eomgen.mechanics.bodies.kinematics import motion_of
from eomgen.mechanics.bodies.loads import loads_of
from eomgen.mechanics.bodies.scope import Scope
from eomgen.mechanics.constraints.elimination import dependent_coordinates
from eomgen.mechanics.constraints.ties import ties_of
from eomgen.mechanics.equations.system import System, reduced_system
from eomgen.model.part import altered
from eomgen.model.table import Table
from eomgen.symbolic.expression.derivative import depends_on_any, substituted
from eomgen.symbolic.expression.graph import Node, is_zero


def over_rates(system: System) -> System:
    """The system over its rates, where a declared speed is not 0 at rest; else as it is."""
    scope = system.scope
    given = (scope.model.coordinates[q.name].driven for q in scope.symbols.q)
    moving = any(not is_zero(x) and not driven for x, driven in zip(scope.nu, given, strict=True))
    if system.free is None or not scope.combines or not moving:
        return system
    return _made_of(system.free, system.free.scope)


def standing_system(system: System) -> System:
    """`over_rates`, what moves by an explicit time held where it is at t = 0."""
    system = over_rates(system)
    free = system.free or system
    scope, t = free.scope, (free.scope.symbols.t,)
    places = [x for link in free.motion.links for x in (*link.pose.p, *(y for row in link.pose.R for y in row))]
    given = (scope.model.coordinates[q.name].driven for q in scope.symbols.q)
    biases = [x for x, driven in zip(scope.nu, given, strict=True) if not driven]
    if not depends_on_any((*places, *biases, *(row.velocity for row in free.ties.rows)), t):
        return system
    names = {name: substituted((x,), {t[0]: 0})[0] if type(x) is Node else x for name, x in scope.names.items()}
    return _made_of(free, replace(scope, names=names))


def _made_of(free: System, scope: Scope) -> System:
    """The system of another scope over the rates, dependent coordinates eliminated."""
    scope = replace(scope, model=altered(scope.model, speeds=Table({})))
    motion = motion_of(scope)
    made = System(motion, loads_of(motion, free.loads.begun), ties_of(motion, modes=free.modes), free.modes)
    return reduced_system(made) if dependent_coordinates(scope) else made
