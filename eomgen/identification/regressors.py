"""Model -> Regressor: the forces that a motion takes, linear in the inertial parameters of the bodies.

    tau + J^T lam = Y(q, u, a) pi + y0(q, u, t)

pi contains m, the first moments m c and the inertia about its origin, in its axes, of each body; the parameters of
rotor, damper and spring of each joint; and other parameters in which the forces are linear, as friction. A column
is the generalized force of a unit of its parameter, B^T (I A + xi x* (I xi)) with A = B a + alpha, weight as an upward
acceleration of the ground. y0 is the known part: the forces without a parameter of pi, and the inertia of given
energies.
Source: Khalil & Dombre, Modeling, Identification and Control of Robots (2002), §9.3 and §12.3.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.identification.base_parameters import MOMENTS, PLACES, BaseParameters, base_of, named_entries
from eomgen.identification.proof_of_groups import certify_regressor
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import SystemFriction
from eomgen.mechanics.kinematics import ContactMode, SystemInertia
from eomgen.model import Model, ModelOrPath
from eomgen.pipeline import derive
from eomgen.proof import Certificate
from eomgen.symbolic.expression import (
    Matrix,
    Node,
    Scalar,
    ScalarRow,
    SpatialInertia,
    Twist,
    Vector,
    Wrench,
    depends_on,
    gradient,
    is_zero,
    substituted,
)

SPACE = ("Izz", "Ixx", "Ixy", "Izx", "Iyz", "mx", "my", "Iyy", "mz", "m")
PLANE = ("Izz", "mx", "my", "m")
OF_JOINTS = ("armature", "damping", "stiffness")


@dataclass(frozen=True, repr=False)
class Regressor:
    """tau + J^T lam = Y pi + y0.

    Args:
        system: the system.
        parameters: pi by name: m(arm), mx(arm), Ixx(arm), armature(arm), damping(arm), stiffness(arm), mu.
        rows: Y as graph scalars, a row for each speed.
        values: value of each parameter in the model.
        known: y0, the forces that contain no parameter.
    """

    system: System
    parameters: tuple[str, ...]
    rows: tuple[ScalarRow, ...]
    values: ScalarRow
    known: ScalarRow

    def __repr__(self) -> str:
        return f"<regressor of {self.system.scope.model.name!r}: {len(self.rows)} x {len(self.parameters)}>"

    @property
    def model(self) -> Model:
        return self.system.scope.model

    @cached_property
    def Y(self) -> Any:
        """Y in sympy."""
        import sympy

        from eomgen.symbolic.print import to_sympy

        entries = to_sympy([x for row in self.rows for x in row])
        return sympy.ImmutableDenseMatrix(len(self.rows), len(self.parameters), entries)

    @cached_property
    def base(self) -> BaseParameters:
        """Groups of parameters that the forces can tell apart."""
        return base_of(self.system, self.parameters, self.rows)

    def certify(self) -> Certificate:
        """The proof of Y, of the groups and of their formulas, on that of the equations of motion."""
        return certify_regressor(self)

    @property
    def blocks(self) -> dict[str, tuple[ScalarRow, ...]]:
        """Y, y0 and Y_base, the columns of Y that lead groups, as far as they are not 0.

        Y pi + y0 = Y_base base + y0
        """
        leads = [self.parameters.index(group.name) for group in self.base.groups]
        base = tuple(tuple(row[j] for j in leads) for row in self.rows)
        found = {"Y": self.rows, "y0": tuple((x,) for x in self.known), "Y_base": base}
        return {name: rows for name, rows in found.items() if rows and rows[0]}

    @property
    def tau(self) -> ScalarRow:
        """Y pi + y0."""
        products = ([y * x for y, x in zip(row, self.values, strict=True)] for row in self.rows)
        return tuple(sum(row, start=known) for row, known in zip(products, self.known, strict=True))


def regressor(model: ModelOrPath) -> Regressor:
    """The regressor of a mechanism.

    Raises:
        DerivationError: Coulomb friction of a constraint, whose normal force is no linear function of the
            parameters; nothing moves.
    """
    return regressor_of(derive(model).system)


def regressor_of(system: System) -> Regressor:
    """The same of a system."""
    if not system.symbols.u:
        raise DerivationError(
            "nothing moves: no force depends on a mass",
            "coordinates",
            "give a joint a coordinate that is free, neither driven nor dependent",
        )
    if SystemFriction(system).exists:
        name = SystemFriction(system).named[0][0]
        raise DerivationError(
            f"the friction of '{name}' is not linear in the parameters: its normal force depends on them",
            f"{'constraints' if name in system.scope.model.constraints else 'bodies'}.{name}",
            "say it by a force with a parameter of its own",
        )
    changing = [link.name for link in system.motion.links if system.scope.mass_rates(link.name) is not None]
    if changing:
        what = f"the mass of body '{changing[0]}' changes: it is no parameter"
        raise DerivationError(what, f"bodies.{changing[0]}", "give it a constant mass where it is to be identified")
    size = len(system.symbols.u)
    columns = [*_bodies(system), *_joints(system), *_frictions(system)]
    rest = tuple(x - y for x, y in zip(_rest(system), SystemInertia(system.motion).given_inertia, strict=True))
    columns += [(name, system.symbols.parameters[name], row) for name, row in _linear(system, rest).items()]
    known = substituted(rest, {x: 0 for name, x, _ in columns if name in system.symbols.parameters and type(x) is Node})
    names, values, by_column = zip(*columns, strict=True) if columns else ((), (), ())
    rows = tuple(tuple(column[k] for column in by_column) for k in range(size))
    return Regressor(system, tuple(names), rows, tuple(values), tuple(-x for x in known))


Column = tuple[str, Scalar, ScalarRow]


def _bodies(system: System) -> Iterator[Column]:
    """The inertial parameters of each body that has any."""
    motion, a = system.motion, system.symbols.a
    names = PLANE if motion.scope.model.space == "plane" else SPACE
    for i, link in enumerate(motion.links):
        mass = motion.scope.mass_properties(link.name)
        if is_zero(mass.m) and all(is_zero(x) for row in mass.I for x in row):
            continue
        own = SpatialInertia.about_center(mass.m, mass.com, mass.I)
        B, alpha = motion.B[i], motion.alpha[i]
        rates = [sum((b * x for b, x in zip(row, a, strict=True)), start=alpha[r]) for r, row in enumerate(B)]
        up = link.pose.R.T @ system.loads.fields
        A = Twist(Vector(rates[:3]), Vector(rates[3:]) - up)
        values = named_entries(own)
        for name in names:
            wrench = _force(_unit(name), A, link.twist)
            entries = (*wrench.tau, *wrench.f)
            column = tuple(sum((B[r][k] * entries[r] for r in range(6)), start=0) for k in range(len(a)))
            yield f"{name}({link.name})", values[name], column


def _unit(name: str) -> SpatialInertia:
    """The spatial inertia of which one parameter is 1."""
    I = [[0] * 3 for _ in range(3)]
    h = [0, 0, 0]
    if name in PLACES:
        i, j = PLACES[name]
        I[i][j] = I[j][i] = 1
    elif name in MOMENTS:
        h[MOMENTS[name]] = 1
    return SpatialInertia(int(name == "m"), Vector(h), Matrix.of(I))


def _force(inertia: SpatialInertia, A: Twist, xi: Twist) -> Wrench:
    """I A + xi x* (I xi)."""
    momentum = inertia.momentum(xi)
    turning = Wrench(xi.w.cross(momentum.tau) + xi.v.cross(momentum.f), xi.w.cross(momentum.f))
    return inertia.momentum(A).plus(turning)


def _joints(system: System) -> Iterator[Column]:
    """Rotors, dampers and springs of joints."""
    motion, size = system.motion, len(system.symbols.u)
    for link in motion.links:
        efforts = () if link.joint is None else link.joint.efforts()
        for k, effort in enumerate(efforts):
            if effort is None:
                continue
            row = motion.joint_row(link.name, k)
            rate = link.s_rate[k]
            (push,) = motion.scope.time_derivative((rate,))
            for i, factor in row.items():
                push = push + factor * system.symbols.a[i]
            along = {"armature": push, "damping": rate, "stiffness": link.s[k] - motion.scope.value(effort.rest)}
            for name in OF_JOINTS:
                declared = getattr(effort, name)
                if declared is None:
                    continue
                value = motion.scope.value(declared)
                label = f"{name}({link.name})" if len(efforts) == 1 else f"{name}({link.name}, {k + 1})"
                yield label, value, tuple(row.get(i, 0) * along[name] for i in range(size))


def _frictions(system: System) -> Iterator[Column]:
    """Dry friction of constant size in joints: T sign(s'), smooth T tanh(s'/v)."""
    motion, size = system.motion, len(system.symbols.u)
    value = motion.scope.value
    for link in motion.links:
        for k, field, law in () if link.joint is None else link.joint.frictions:
            if law.size is not None:
                row, sense = motion.joint_row(link.name, k), -ContactMode().joint_factor(law, value, link.s_rate[k])
                label = f"friction({link.joint.named_contact(link.name, field)})"
                yield label, value(law.size), tuple(row.get(i, 0) * sense for i in range(size))


def _rest(system: System) -> ScalarRow:
    """Q of all forces but weight, inputs 0; of a joint its drive alone."""
    motion, loads = system.motion, system.loads
    size = len(system.symbols.u)
    total: list[Scalar] = [0] * size
    for force in loads.applied:
        if not force.is_field:
            total = [x + y for x, y in zip(total, loads.force_row(force), strict=True)]
    for link in motion.links:
        for k, effort in enumerate(() if link.joint is None else link.joint.efforts()):
            if effort is not None and effort.drive is not None:
                drive = motion.scope.value(effort.drive)
                for i, factor in motion.joint_row(link.name, k).items():
                    total[i] = total[i] + factor * drive
    return substituted(tuple(total), dict.fromkeys(system.symbols.inputs.values(), 0))


def _linear(system: System, rest: ScalarRow) -> dict[str, ScalarRow]:
    """The parameters in which the other forces are linear, all at once, and that stand nowhere else: -dQ/dp."""
    geometry = [x for link in system.motion.links for x in (*link.twist.w, *link.twist.v)]
    found: dict[str, ScalarRow] = {}
    for name, node in system.symbols.parameters.items():
        if not any(depends_on(x, (node,)) for x in rest) or any(depends_on(x, (node,)) for x in geometry):
            continue
        slope = [gradient(x, (node,))[0] for x in rest]
        others = [system.symbols.parameters[other] for other in found]
        if any(depends_on(x, (node, *others)) for x in slope):
            continue
        found[name] = tuple(-x for x in slope)
    return found
