"""System -> energies and powers, of the whole, of one body or of one force."""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.inertia import armature_energy, body_energies, kinetic_energy
from eomgen.mechanics.bodies.kinematics import velocity_of
from eomgen.mechanics.bodies.loads import Applied, JointEffort, in_body_axes, in_ground_axes, joint_wrenches
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.load import Couple, GeneralizedForce, Load, PointForce, UniformField
from eomgen.symbolic.expression.derivative import depends_on, tangent
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.spatial import dot, times


def energy_of_motion(system: System, body: str | None = None) -> Scalar:
    """T = m v.v / 2 + w.I w / 2 of the whole, or of one body with the rotors of its joint [J]."""
    motion = system.motion
    if body is None:
        return kinetic_energy(motion)
    energy = body_energies(motion)[motion.index[body]]
    return energy.translation + energy.rotation + armature_energy(motion, motion.link(body))


def energy_of_force(system: System, name: str | None = None) -> Scalar:
    """V of the whole, of one force, or of what acts on one body alone: its weight, a spring to the ground [J].

    Raises:
        DerivationError: a force without potential; a potential that the body shares with another.
    """
    loads = system.loads
    if name is None:
        return loads.potential_energy
    if name in system.scope.model.forces:
        (force,) = (f for f in loads.applied if f.name == name)
        if force.potential is None:
            raise DerivationError(f"force '{name}' has no potential energy", mend="ask for its power or its work")
        return force.potential
    total: Scalar = sum((_share(system, force, name) for force in loads.applied), start=0)
    return sum((_effort_share(system, effort, name) for effort in loads.efforts), start=total)


def _share(system: System, force: Applied, body: str) -> Scalar:
    """The part of a force's potential that belongs to one body: -F . r of a constant F, else all of it."""
    if force.potential is None:
        return 0
    share: Scalar = 0
    for load in _point_loads(system, force):
        if not _acts_on(load, body):
            continue
        if isinstance(load, PointForce) and _is_constant(system, load):
            share = share - dot(load.force, system.motion.position(load.place))
        elif all(_acts_on(other, body) or _acts_on(other, None) for other in force.loads):
            return force.potential
        else:
            raise DerivationError(
                f"the potential of force '{force.name}' belongs to more than body '{body}'",
                mend=f"ask potential_energy({force.name})",
            )
    return share


def _effort_share(system: System, effort: JointEffort, body: str) -> Scalar:
    """The joint's spring, where it stands between the body and the ground."""
    sharing = [name for name, _ in joint_wrenches(system.motion, effort)]
    if body not in sharing or type(effort.potential) is int:
        return 0
    if sharing != [body]:
        raise DerivationError(
            f"the spring in the joint of body '{effort.body}' belongs to more than body '{body}'",
            mend="ask for the potential energy of the whole: potential",
        )
    return effort.potential


def _point_loads(system: System, force: Applied) -> list[Load]:
    """The loads of a force, a uniform field as weights."""
    found: list[Load] = []
    for load in force.loads:
        found += _weights(system, load) if isinstance(load, UniformField) else [load]
    return found


def _weights(system: System, field: UniformField) -> list[PointForce]:
    masses = SystemScene(system.motion).masses(None)
    return [PointForce(place, times(m, field.acceleration)) for place, m in masses]


def _acts_on(load: Load, body: str | None) -> bool:
    return (load.place[0] if isinstance(load, PointForce) else getattr(load, "body", None)) == body


def _is_constant(system: System, load: PointForce) -> bool:
    symbols = system.symbols
    return load.axes is None and not any(depends_on(x, (*symbols.q, *symbols.u, symbols.t)) for x in load.force)


def power_of_loads(system: System, name: str | None = None) -> Scalar:
    """Power of everything applied, of one force, or of all that is applied to one body [W].

    P = sum F . v + C . w; of what acts at no place, Q_k q_k' and -dV/dq . q'.
    """
    loads = system.loads
    forces = loads.applied
    if name is not None and name in system.scope.model.forces:
        return sum((_force_power(system, force) for force in forces if force.name == name), start=0)
    if name is not None:
        return _body_power(system, name)
    total = sum((_force_power(system, force) for force in forces), start=0)
    for effort in loads.efforts:
        total = total + effort.effort * system.motion.link(effort.body).s_rate[effort.variable]
    return total


def _body_power(system: System, body: str) -> Scalar:
    total: Scalar = 0
    for force in system.loads.applied:
        for load in _point_loads(system, force):
            if _acts_on(load, body):
                total = total + _load_power(system, load)
    for effort in system.loads.efforts:
        for name, wrench in joint_wrenches(system.motion, effort):
            if name == body:
                total = total + system.motion.link(body).twist.power(wrench)
    return total


def _force_power(system: System, force: Applied) -> Scalar:
    if force.loads:
        return sum((_load_power(system, load) for load in _point_loads(system, force)), start=0)
    scope = system.scope
    rates = dict(zip(scope.symbols.q, scope.rates, strict=True))
    return 0 if force.potential is None else -tangent((force.potential,), rates)[0]


def _load_power(system: System, load: Load) -> Scalar:
    motion = system.motion
    if isinstance(load, GeneralizedForce):
        coordinates = [q.name for q in system.symbols.q]
        return load.value * system.scope.rates[coordinates.index(load.coordinate)]
    if isinstance(load, Couple):
        couple = in_body_axes(motion, load.body, load.couple, load.axes)
        return dot(couple, motion.link(load.body).twist.w)
    assert isinstance(load, PointForce), "fields are weights by now"
    return dot(in_ground_axes(motion, load.force, load.axes), velocity_of(motion, load.place))
