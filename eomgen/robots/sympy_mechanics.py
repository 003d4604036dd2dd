"""Systems of sympy.physics.mechanics -> models: System, KanesMethod, LagrangesMethod.

A `System` whose bodies hang on joints becomes bodies on joints, with its gravity, springs, forces and torques. Anything
else is imported by its energies and the remaining forces. With w = q' and u = Y w + y the speeds, T(q, w, t) the
kinetic energy of all bodies, the generalized forces are

    Q_i = sum F . dv/dw_i + M . domega/dw_i
          + d/dt dT/dw_i - dT/dq_i - sum d(m v)/dt . dv/dw_i + dH/dt . domega/dw_i

in which the accelerations cancel. The second line vanishes where velocities are the rates of places; those that were
given and are not (a wheel that rolls) so leave in Q the terms that constrain them. Everything is written into one
graph, in which equal subexpressions are one node: sympy expands nothing.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import field
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import sympy
from sympy.physics.mechanics import KanesMethod, LagrangesMethod, Particle, ReferenceFrame, find_dynamicsymbols
from sympy.physics.mechanics import System as SympySystem
from sympy.physics.vector import dynamicsymbols

from eomgen import files
from eomgen.errors import DerivationError, UsageError
from eomgen.frozen import dataclass
from eomgen.model import Model, loads
from eomgen.robots.sympy_joints import Words, file_texts, lagrangian_method, speeds_as_rates, tables_of_joints
from eomgen.robots.tables import Entries, toml_text, without_empty
from eomgen.symbolic.exact import LinearSystem, vanishes
from eomgen.symbolic.expression import (
    LONGEST,
    Fraction,
    Matrix,
    Node,
    Scalar,
    Vector,
    depends_on,
    gradient,
    is_zero,
    pullback,
    substituted,
    symbols_of,
    tangent,
)
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances
from eomgen.symbolic.print import text_size

HALF = Fraction(1, 2)


@dataclass(frozen=True)
class MovingMass:
    """A body as its motion: its mass, the velocity of its mass centre, its inertia about that, and how it turns.

    Args:
        I: central, in the axes of `frame`, which need not be the body's; None of a particle.
    """

    mass: Any
    velocity: Any
    I: Any = None
    omega: Any = None
    frame: Any = None


@dataclass(frozen=True)
class Formed:
    """Parts of the equations of motion, for each class of sympy.

    Args:
        ground: the frame in which velocities are.
        q, u: coordinates and speeds, the dependent ones included.
        kinematic: expressions in q' and u that vanish.
        gaps, velocities: expressions in q, and in q and u, that vanish.
        masses: the moving masses.
        pushes: (force, velocity of its point) or (torque, angular velocity), vectors.
        T, V: kinetic and potential energy, where they are known in addition to the masses.
        still: auxiliary speeds, which are 0.
    """

    ground: Any
    q: tuple[Any, ...]
    u: tuple[Any, ...]
    kinematic: tuple[Any, ...]
    gaps: tuple[Any, ...]
    velocities: tuple[Any, ...]
    masses: tuple[MovingMass, ...]
    pushes: tuple[tuple[Any, Any], ...]
    T: Any = field(default=sympy.S.Zero)
    V: Any = field(default=sympy.S.Zero)
    still: tuple[Any, ...] = ()


def from_sympy(system: Any, *, name: str = "model", path: str | Path | None = None) -> Model:
    """The model of a system of sympy.physics.mechanics: bodies on joints where it has them, else its energies.

    Symbols become parameters without values, other functions of time inputs that are 0 until they are given; every
    coordinate starts at 0.

    Args:
        system: a System, a KanesMethod or a LagrangesMethod; nothing need be formed yet of it.
        name: of the model.
        path: where the model file is written; None: nowhere.
    Raises:
        UsageError: something else.
        DerivationError: a model has no counterpart: rates of given functions, masses that change.
    """
    if not isinstance(system, (SympySystem, KanesMethod, LagrangesMethod)):
        what = "a System, KanesMethod or LagrangesMethod of sympy.physics.mechanics is needed"
        raise UsageError(f"{what}, not {type(system).__name__}", fix="name one of them")
    tables = tables_of_joints(system) if isinstance(system, SympySystem) else None
    if tables is None:
        method = lagrangian_method(system) if isinstance(system, SympySystem) else system
        formed = _of_lagrange(method) if isinstance(method, LagrangesMethod) else _of_kane(system)
        tables = _Energies(formed).tables()
    space = "space" if "bodies" in tables else "plane"
    text = toml_text({"eomgen": 1, "name": name, "space": space, **tables}, ["From sympy.physics.mechanics."])
    if path is not None:
        files.write(str(path), text)
    return loads(text, "the system of sympy" if path is None else str(path), name)


def _of_lagrange(method: Any) -> Formed:
    """T, V and the forces of a Lagrangian."""
    t, (L,) = dynamicsymbols._t, method._L
    q = tuple(method.q)
    at_rest = L.xreplace({x.diff(t): sympy.S.Zero for x in q})
    gaps = tuple(method._hol_coneqs)
    constraints = tuple(method.coneqs)[len(gaps) :]
    pushes = _pushes(method.forcelist or (), method.inertial)
    return Formed(method.inertial, q, (), (), gaps, constraints, (), pushes, T=L - at_rest, V=-at_rest)


def _pushes(loads: Any, ground: Any) -> tuple[tuple[Any, Any], ...]:
    """Each load with the velocity that it does work on."""
    found = []
    for place, vector in loads:
        rate = place.ang_vel_in(ground) if isinstance(place, ReferenceFrame) else place.vel(ground)
        found.append((vector, rate))
    return tuple(found)


def _of_kane(system: Any) -> Formed:
    """The masses, loads and constraints of Kane's method, auxiliary speeds 0.

    Raises:
        DerivationError: no bodies; kinematic equations that are missing; masses that change.
    """
    if isinstance(system, SympySystem):
        ground, bodies, kinematic = system.frame, system.bodies, tuple[Any, ...](system.kdes)
        forces: Any = [*system.loads, *(load for each in system.actuators for load in each.to_loads())]
        gaps, velocities = tuple(system.holonomic_constraints), tuple(system.nonholonomic_constraints)
        auxiliary = system.u_aux
    else:
        ground, bodies, forces = system._inertial, system.bodies, system.forcelist or ()
        parts = (system._k_kqdot_implicit, system._k_ku_implicit, system._f_k_implicit)
        kinematic = tuple(parts[0] * system._qdot + parts[1] * system.u + parts[2]) if parts[0] else ()
        gaps, auxiliary = tuple(system._f_h), system._uaux
        velocities = tuple(system._f_nh + system._k_nh * system.u) if system._k_nh else ()
    if not bodies:
        raise DerivationError("the method has no bodies", fix="give them to it: KanesMethod(..., bodies=bodies)")
    q, u = tuple(system.q), tuple(system.u)
    if len(kinematic) != len(q):
        raise DerivationError(f"{len(kinematic)} kinematic equations for {len(q)} coordinates", fix="give one for each")
    masses = tuple(_moving(body, ground) for body in bodies)
    pushes = _pushes(forces, ground)
    return Formed(ground, q, u, kinematic, gaps, velocities, masses, pushes, still=tuple(auxiliary))


def _moving(body: Any, ground: Any) -> MovingMass:
    """Raises: DerivationError: its mass changes."""
    velocity = body.masscenter.vel(ground)
    if find_dynamicsymbols(sympy.sympify(body.mass, strict=True)):
        what = f"the mass of '{body.name}' changes"
        raise DerivationError(what, fix="make it a symbol: a model's masses are parameters")
    if isinstance(body, Particle):
        return MovingMass(body.mass, velocity)
    dyads = body.central_inertia.args
    if not dyads:
        return MovingMass(body.mass, velocity)
    axes = {frame for _, one, other in dyads for vector in (one, other) for _, frame in vector.args}
    own = axes.pop() if len(axes) == 1 else body.frame  # of a wheel people give it in axes that do not spin
    return MovingMass(body.mass, velocity, body.central_inertia.to_matrix(own), body.frame.ang_vel_in(ground), own)


@dataclass
class _Energies:
    """The tables of a model of energies and generalized forces."""

    formed: Formed

    def __post_init__(self) -> None:
        formed, t = self.formed, dynamicsymbols._t
        self.q = list(formed.q)
        kinematic = list(formed.kinematic)
        seen = [u for u in formed.u if any(x.has(u) for x in kinematic)]
        for u in formed.u:  # speeds that turn no coordinate get one that nothing else depends on
            if u not in seen:
                own = dynamicsymbols(f"{u.func.__name__}_0")
                self.q.append(own)
                kinematic.append(own.diff(t) - u)
        rates = speeds_as_rates(self.q, formed.u, kinematic)
        rates = {  # a speed in the equation of another is not determined by itself
            u: q for u, q in rates.items() if sum(x.has(q.diff(t)) or x.has(u) for x in kinematic) == 1
        }
        self.words = Words(self.q, formed.u, rates)
        self.constraints: list[Scalar] = []
        self.turned: dict[Any, Matrix] = {formed.ground: Matrix.IDENTITY}
        own = [u for u in formed.u if u not in rates]
        self.own = dict(
            zip([self.words.nodes[self.words.of(u)] for u in own], self._speeds(own, kinematic), strict=True)
        )

    def _speeds(self, u: Sequence[Any], kinematic: Sequence[Any]) -> tuple[Scalar, ...]:
        """Y and y of u = Y w + y, by the kinematic equations.

        Raises:
            DerivationError: it does not give them.
        """
        if not u:
            return ()
        nodes = [self.words.nodes[self.words.of(x)] for x in u]
        rows = [x for x in (self._scalar(x) for x in kinematic) if depends_on((x,), nodes)]
        A = [gradient(row, nodes) for row in rows]
        flat = [x for row in A for x in row]
        rng = Random(1)
        state = {x: rng.uniform(0.5, 1.5) for x in symbols_of([*rows])}
        numbers = np.array(evaluate(flat, state, FLOAT), dtype=float).reshape(len(rows), len(u))
        ranks = [
            0,
            *(int(np.linalg.matrix_rank(numbers[: k + 1], tol=tolerances.RANK_NEARBY)) for k in range(len(rows))),
        ]
        chosen = [k for k in range(len(rows)) if ranks[k + 1] > ranks[k]]
        fix = "give one for each coordinate"
        if len(chosen) != len(u):
            raise DerivationError("the kinematic equations do not give every speed", fix=fix)
        right = substituted(rows, dict.fromkeys(nodes, 0))
        system = LinearSystem(
            [{j: x for j, x in enumerate(A[k]) if not is_zero(x)} for k in chosen],
            [-right[k] for k in chosen],
            len(u),
            lambda found: evaluate(found, state, FLOAT),
        )
        found = system.unique_solution(vanishes=vanishes)
        others = [
            row for k, row in enumerate(rows) if k not in chosen
        ]  # of fewer speeds than rates: these constraint rates
        self.constraints = [x for x in substituted(others, dict(zip(nodes, found, strict=True))) if not vanishes(x)]
        return found

    def _scalar(self, expression: Any) -> Scalar:
        """Scalar of an expression in the graph, with auxiliary speeds 0."""
        if self.formed.still:
            t = dynamicsymbols._t
            expression = sympy.sympify(expression).xreplace(
                {x: sympy.S.Zero for u in self.formed.still for x in (u, u.diff(t))}
            )
        return self.words.scalar(expression)

    def _rotation(self, frame: Any) -> Matrix:
        """R of a frame in the ground: products of those of neighbours, each of which is short."""
        if frame not in self.turned:
            path = frame._dict_list(self.formed.ground, 0)
            above = path[1]
            step = above.dcm(frame)
            R = Matrix.of((self._scalar(step[i, j]) for j in range(3)) for i in range(3))
            self.turned[frame] = self._rotation(above) @ R
        return self.turned[frame]

    def _vector(self, vector: Any, axes: Any = None) -> Vector:
        """Components in the ground's axes, or in those of a frame."""
        total = Vector((0, 0, 0))
        for components, frame in getattr(vector, "args", ()):
            own = Vector(self._scalar(x) for x in components)
            if frame is not axes:
                own = self._rotation(frame) @ own
                own = own if axes is None else self._rotation(axes).T @ own
            total = total + own
        return total

    def tables(self) -> Entries:
        formed, words = self.formed, self.words
        q = [words.nodes[words.of(x)] for x in self.q]
        w = [words.nodes[words.of(x.diff(dynamicsymbols._t))] for x in self.q]
        energies, moved = [self._scalar(formed.T)], list[tuple[Vector, Vector]]()
        for mass in formed.masses:
            energies += self._mass(mass, moved, q, w)
        V = self._scalar(formed.V)
        pushes = [(self._vector(force), self._vector(rate)) for force, rate in formed.pushes]
        velocities, gaps = ([self._scalar(x) for x in rows] for rows in (formed.velocities, formed.gaps))
        velocities += self.constraints
        own = self.own
        accelerated = {words.nodes[f"{u.name}'"]: self._rate((x,), q, w)[0] for u, x in own.items()}
        self.known = own | accelerated | {words.nodes[f"{x.name}'"]: 0 for x in w}
        applied = self._work(pushes, w)
        inertial = self._inertial(energies, moved, q, w)
        Q = [x + y for x, y in zip(applied, inertial, strict=True)]
        constraints = {f"tie{k}": {"kind": "equation", "gap": x} for k, x in enumerate(self._texts(gaps), 1)}
        kept = _beyond(q, w, self._rate(gaps, q, w), substituted(velocities, own))
        shown = self._texts([velocities[k] for k in kept])
        constraints |= {f"constraint{len(gaps) + k}": {"kind": "equation", "rate": x} for k, x in enumerate(shown, 1)}
        forces: Entries = {}
        whole = sum(energies, start=0)
        energies = [whole] if text_size(whole) <= LONGEST else energies
        for kind, stem, found in (("kinetic", "T", energies), ("potential", "V", [V])):
            reported = [x for x in self._texts(found) if x != 0]
            forces |= {
                f"{stem}{k if len(reported) > 1 else ''}": {"kind": kind, "energy": x}
                for k, x in enumerate(reported, 1)
            }
        along = zip(q, self._texts(Q), strict=True)
        forces |= {
            f"Q_{x.name}": {"kind": "generalized", "coordinate": x.name, "value": value}
            for x, value in along
            if value != 0
        }
        speeds = self._texts(list(own.values()))
        used = _names_in([*forces.values(), *constraints.values(), speeds])
        return without_empty(
            {
                "parameters": {name: {} for name in words.parameters.values() if name in used},
                "coordinates": {x.name: {"start": 0} for x in q if x.name in used},
                "speeds": {x.name: {"rate": rate} for x, rate in zip(own, speeds, strict=True)},
                "inputs": {name: {"value": 0} for name in words.inputs.values() if name in used},
                "constraints": constraints,
                "forces": forces,
            }
        )

    def _texts(self, scalars: Sequence[Scalar]) -> list[Any]:
        return file_texts(scalars, self.words.names.given)

    def _mass(self, mass: MovingMass, moved: list[tuple[Vector, Vector]], q: list[Node], w: list[Node]) -> list[Scalar]:
        """m v^2/2 and omega . I omega/2; (m v, v) and (H, omega) in the ground's axes are appended to `moved`."""
        m, v = self._scalar(mass.mass), self._vector(mass.velocity)
        moved.append((m * v, v))
        T = HALF * m * (v @ v)
        if mass.I is None:
            return [T]
        I = Matrix.of((self._scalar(mass.I[i, j]) for j in range(3)) for i in range(3))
        omega = self._vector(mass.omega, mass.frame)
        H, R = I @ omega, self._rotation(mass.frame)
        moved.append((R @ H, R @ omega))
        return [T + HALF * (omega @ H)]

    def _rate(self, outputs: Sequence[Scalar], q: list[Node], w: list[Node]) -> tuple[Scalar, ...]:
        """d/dt of functions of q, q' and t where q'' = 0."""
        return tangent(tuple(outputs), {self.words.nodes["t"]: 1, **dict(zip(q, w, strict=True))})

    def _in_rates(self, scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """Scalars as functions of q and w alone, with accelerations 0."""
        return substituted(substituted(tuple(scalars), self.known), self.known)

    def _work(self, pushes: Sequence[tuple[Vector, Vector]], w: list[Node]) -> list[Scalar]:
        """sum F . dv/dw"""
        forces = self._in_rates([x for force, _ in pushes for x in force])
        rates = self._in_rates([x for _, rate in pushes for x in rate])
        return list(pullback(rates, forces, w)) if pushes else [0] * len(w)

    def _inertial(
        self, energies: Sequence[Scalar], moved: Sequence[tuple[Vector, Vector]], q: list[Node], w: list[Node]
    ) -> list[Scalar]:
        """d/dt dT/dw - dT/dq - sum d(m v)/dt . dv/dw - sum dH/dt . domega/dw; 0 of rates of places."""
        T = self._in_rates([sum(energies[1:], start=0)])[0]
        momenta = self._rate(gradient(T, w), q, w)
        lost = self._rate(self._in_rates([x for p, _ in moved for x in p]), q, w)
        work = pullback(self._in_rates([x for _, v in moved for x in v]), lost, w) if moved else [0] * len(w)
        found = [p - x - y for p, x, y in zip(momenta, gradient(T, q), work, strict=True)]
        return [0 if vanishes(x) else x for x in found]


def _names_in(written: Any) -> set[str]:
    """The names in texts of a file, without primes."""
    if isinstance(written, str):
        return set(re.findall(r"[^\W\d]\w*", written))
    inside = written.values() if isinstance(written, dict) else written if isinstance(written, list) else ()
    return set[str]().union(*map(_names_in, inside))


def _beyond(q: list[Node], w: list[Node], rates: Sequence[Scalar], velocities: Sequence[Scalar]) -> list[int]:
    """The velocity equations that do not follow from the rates of the gaps."""
    J = [gradient(x, w) for x in (*rates, *velocities)]
    flat = [x for row in J for x in row]
    rng = Random(1)
    state = {x: rng.uniform(0.5, 1.5) for x in symbols_of(flat)}
    found = np.array(evaluate(flat, state, FLOAT), dtype=float).reshape(len(J), len(w))
    ranks = [int(np.linalg.matrix_rank(found[:k], tol=tolerances.RANK_NEARBY)) if k else 0 for k in range(len(J) + 1)]
    first = len(rates)
    return [k for k in range(len(velocities)) if ranks[first + k + 1] > ranks[first + k]]
