"""System -> what its energies and equations are the sum of, each part known by name.

T = sum over the bodies of translation and rotation, V and Q over the forces, weights body by body. Each of them enters
every equation of motion by one and the same operator:

    E_k = d/dt dT/du_k - dT/dq_k + dV/dq_k - Q_k - J^T lam
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from functools import cached_property

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System
from eomgen.mechanics.kinematics import Applied, SystemInertia
from eomgen.model import Couple, Load, PointForce, UniformField
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    ScalarRow,
    depends_on,
    gradient,
    inner,
    is_zero,
    jacobian,
    substituted,
    symbols_of,
    tangent,
)


@dataclass(frozen=True)
class Contribution:
    """One part of energies and equations.

    Args:
        name: in words: "the rotation of rod".
        body, force: whose it is; "" of others.
        T, V: its share of the energies.
        gained: what d/dt dT/du gains by mass that comes; () of a constant mass.
        Q: its generalized forces of what has no potential, one for each speed of the free system.
        kind: "translation", "rotation", "given" (a kinetic energy), "weight", "constant" (a force whose work is that of
            a potential, which the model's V does not hold), "force", "friction" or "constraint".
        load: what acts, and where.
        row: its share of the equations, where it is no energy and no load: friction, constraints.
    """

    name: str
    body: str = ""
    force: str = ""
    T: Scalar = 0
    V: Scalar = 0
    gained: ScalarRow = ()
    Q: ScalarRow = ()
    kind: str = ""
    load: Load | None = None
    row: ScalarRow | None = None

    @property
    def held(self) -> frozenset[Node]:
        """The symbols in it."""
        acts: Sequence[Scalar] = ()
        if isinstance(self.load, PointForce):
            acts = (*self.load.force, *self.load.place[1])
        elif isinstance(self.load, Couple):
            acts = self.load.couple
        return frozenset(symbols_of((self.T, self.V, *self.Q, *(self.row or ()), *acts)))


@dataclass(frozen=True)
class Operator:
    """Energies and forces -> their share of the equations of motion, over the independent speeds."""

    system: System

    @property
    def base(self) -> System:
        """The system whose speeds are rates."""
        return self.system.free or self.system

    def rows(self, part: Contribution) -> ScalarRow:
        """The share of a contribution in every E_k."""
        if part.row is not None:
            return part.row
        left = [0] * len(self.base.symbols.u) if is_zero(part.T) else self._held(part)
        motion = self.base.motion
        elastic = [0] * len(left) if is_zero(part.V) else motion.scope.from_potential(part.V)
        forces = part.Q or [0] * len(left)
        return self.reduced([a - b - c for a, b, c in zip(left, elastic, forces, strict=True)])

    def _held(self, part: Contribution) -> list[Scalar]:
        """d/dt dT/du - dT/dq, masses held as they are."""
        rows = [sum(x, start=0) for x in self._inertia(part.T)]
        return [x - k for x, k in zip(rows, part.gained or (0,) * len(rows), strict=True)]

    def inertia(self, T: Scalar) -> tuple[ScalarRow, ScalarRow, ScalarRow]:
        """(what holds accelerations, the rest of d/dt dT/du, -dT/dq) of a kinetic energy."""
        parts = zip(*self._inertia(T), strict=True)
        a, b, c = (self.reduced(part) for part in parts)
        return a, b, c

    def _inertia(self, T: Scalar) -> list[tuple[Scalar, Scalar, Scalar]]:
        scope = self.base.scope
        momenta = gradient(T, scope.symbols.u)
        accelerated = tangent(momenta, dict(zip(scope.symbols.u, scope.symbols.a, strict=True)))
        carried = scope.time_derivative(momenta)
        held = self.base.motion.scope.per_speed(gradient(T, scope.symbols.q))
        return [(a, b, -c) for a, b, c in zip(accelerated, carried, held, strict=True)]

    def reduced(self, row: Sequence[Scalar]) -> ScalarRow:
        """N^T row, the speeds of the free system in terms of those that are left."""
        if self.system.free is None:
            return tuple(row)
        base, scope = self.base, self.system.scope
        rates = self.system.free_rates(base)
        known = dict(zip(base.symbols.u, rates, strict=True))
        known |= dict(zip(base.symbols.a, scope.with_accelerations(rates), strict=True))
        row = substituted(tuple(row), known)
        columns = zip(*jacobian(rates, scope.symbols.u), strict=True)
        return tuple(inner(column, row) for column in columns)

    def energy(self, T: Scalar) -> Scalar:
        """A kinetic energy over the independent speeds."""
        if self.system.free is None:
            return T
        rates = self.system.free_rates(self.base)
        return substituted((T,), dict(zip(self.base.symbols.u, rates, strict=True)))[0]


@dataclass(frozen=True)
class Contributions:
    """All contributions of a system.

    Args:
        system: the system.
        equations: its equations of motion; None where it has none.
    """

    system: System
    equations: EquationsOfMotion | None = field(repr=False, default=None)

    @property
    def operator(self) -> Operator:
        return Operator(self.system)

    @cached_property
    def elementary(self) -> tuple[Contribution, ...]:
        """Bodies' energies and forces, one by one."""
        return (*self._kinetic(), *self._forces(), *self._others())

    def holding(self, x: Scalar, most: int, what: str = "") -> tuple[Contribution, ...]:
        """The few contributions of whose constants x is made: those of the one that fewest hold, of all if there are.

        Args:
            most: so many at most; () of more.
            what: of those with a share of this energy, "T" or "V"; "" of all.
        """
        symbols = self.system.symbols
        constants = {*symbols.parameters.values(), *symbols.inputs.values()}
        known = [part for part in self.elementary if not what or not is_zero(getattr(part, what))]
        holders = [[part for part in known if y in part.held] for y in symbols_of((x,)) if y in constants]
        few = min(holders, key=len, default=[])
        found = [part for part in few if all(part in some for some in holders)] or few
        return tuple(found) if len(found) <= most else ()

    def _kinetic(self) -> list[Contribution]:
        motion, found = self.operator.base.motion, []
        inertia = SystemInertia(motion)
        for link, energy in zip(motion.links, inertia.bodies, strict=True):
            moved, turned = inertia.carried_by(energy)
            parts: tuple[tuple[str, Scalar, ScalarRow], ...] = (
                ("translation", energy.translation, moved),
                ("rotation", energy.rotation, turned),
                ("rotor", inertia.rotor_energy(link), ()),
            )
            for kind, T, gained in parts:
                if not is_zero(T):
                    name = f"the {kind} of {link.name}"
                    found.append(Contribution(name, link.name, "", T, gained=gained, kind=kind))
        given = inertia.given_energies.items()
        energies = (Contribution(f"the kinetic energy of {name}", force=name, T=T, kind="given") for name, T in given)
        return [*found, *(part for part in energies if not is_zero(part.T))]

    def _forces(self) -> list[Contribution]:
        loads, found = self.operator.base.loads, list[Contribution]()
        for force in loads.applied:
            found += self._force(force)
        for effort in loads.efforts:
            where = f"in the joint of {effort.body}"
            name = f"joint of {effort.body}"
            if not is_zero(effort.potential):
                found.append(Contribution(f"the spring {where}", effort.body, name, V=effort.potential, kind="force"))
            drive = effort.drive if is_zero(effort.friction) else effort.drive - effort.friction
            for what, size in (("drive or damper", drive), ("friction", effort.friction)):
                if not is_zero(size):
                    Q = loads.drive_row(replace(effort, drive=size))
                    found.append(Contribution(f"the {what} {where}", effort.body, name, Q=Q, kind="force"))
        return found

    def _force(self, force: Applied) -> list[Contribution]:
        motion, loads = self.operator.base.motion, self.operator.base.loads
        found = []
        for load in force.loads:
            if isinstance(load, UniformField):
                for link in motion.links:
                    mass = motion.scope.mass_properties(link.name)
                    if not is_zero(mass.m):
                        weight = mass.m * load.acceleration
                        place = (link.name, mass.com)
                        V = -(weight @ motion.position(place))
                        name = f"the weight of {link.name}"
                        acts = PointForce(place, weight)
                        found.append(Contribution(name, link.name, force.name, V=V, kind="weight", load=acts))
        if found:
            return found
        if force.potential is not None:
            return [
                Contribution(f"the force {force.name}", _body(force.loads), force.name, V=force.potential, kind="force")
            ]
        many = len(force.loads) > 1
        for number, load in enumerate(force.loads, start=1):
            name = f"the force {force.name}" + (f" ({number})" if many else "")
            body = _body((load,))
            if isinstance(load, PointForce) and load.axes is None and not depends_on(load.force, self._varying):
                V = -(load.force @ motion.position(load.place))
                found.append(Contribution(name, body, force.name, V=V, kind="constant", load=load))
                continue
            Q = loads.load_row(load)
            found.append(Contribution(name, body, force.name, Q=Q, kind="force", load=load))
        return found

    @property
    def _varying(self) -> tuple[Node, ...]:
        """The symbols of which a constant force holds none."""
        symbols = self.operator.base.symbols
        return (symbols.t, *symbols.x, *symbols.inputs.values(), *(symbols.unknowns or {}).values())

    def _others(self) -> list[Contribution]:
        """Friction, and what the constraints do."""
        if self.equations is None:
            return []
        found, e = [], self.equations
        if e.friction:
            row = tuple(-x for x in e.friction)
            found.append(Contribution("the friction of the contacts", kind="friction", row=row))
        for constraint, J, lam in zip(self.system.constraints.closing, e.J, e.symbols.lam, strict=True):
            row = tuple(-x * lam for x in J)
            found.append(
                Contribution(
                    f"the force of the constraint {constraint.constraint}",
                    "",
                    constraint.constraint,
                    kind="constraint",
                    row=row,
                )
            )
        return found


def _body(loads: Sequence[Load]) -> str:
    """The one body on which they act, "" where there are several."""
    bodies = {load.place[0] for load in loads if isinstance(load, PointForce) and load.place[0]}
    bodies |= {load.body for load in loads if isinstance(load, Couple)}
    return bodies.pop() if len(bodies) == 1 else ""
