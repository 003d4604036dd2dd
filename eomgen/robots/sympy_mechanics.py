"""Systems of sympy.physics.mechanics -> models: System, KanesMethod, LagrangesMethod.

A `System` whose bodies hang on joints becomes bodies on joints, with its gravity, springs, forces and torques. Anything
else has its energies, and what the equations have beside them: with T(q, q', t) the kinetic energy of all bodies,
u = Y q' + y the speeds and r_k = 0 their equations (Fr + Fr* of Kane's method), the generalized forces are

    Q_i = d/dt dT/dq_i' - dT/dq_i + sum_k r_k du_k/dq_i'

in which the accelerations cancel. Velocities that were given and are not the rates of places (a wheel that rolls) so
leave in Q what ties them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import sympy
from sympy.physics.mechanics import KanesMethod, LagrangesMethod
from sympy.physics.mechanics import System as SympySystem
from sympy.physics.vector import dynamicsymbols

from eomgen import files
from eomgen.errors import DerivationError, UsageError
from eomgen.model.parts import Model
from eomgen.model.reader import loads
from eomgen.records import dataclass
from eomgen.robots.drawn_up import Entries, without_empty
from eomgen.robots.sympy_joints import tables_of_joints
from eomgen.robots.sympy_words import Words, file_texts, speeds_as_rates
from eomgen.robots.toml_text import toml_text
from eomgen.symbolic.expression.derivative import gradient, substituted, symbols_of, tangent
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY


@dataclass(frozen=True)
class Formed:
    """What equations of motion are made of, whichever class of sympy holds it.

    Args:
        q, u: coordinates and speeds, the dependent ones included.
        kinematic: what vanishes of q' and u.
        gaps, velocities: what vanishes of q, and of q and u.
        T: kinetic energy.
        rows: Fr + Fr* along each speed, ties left out.
        V: potential energy, where it is known.
    """

    q: tuple[Any, ...]
    u: tuple[Any, ...]
    kinematic: tuple[Any, ...]
    gaps: tuple[Any, ...]
    velocities: tuple[Any, ...]
    T: Any
    rows: tuple[Any, ...]
    V: Any = field(default=sympy.S.Zero)


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
        DerivationError: what a model has no counterpart for: auxiliary speeds, rates of given functions.
    """
    if not isinstance(system, (SympySystem, KanesMethod, LagrangesMethod)):
        what = "a System, KanesMethod or LagrangesMethod of sympy.physics.mechanics is needed"
        raise UsageError(f"{what}, not {type(system).__name__}", mend="name one of them")
    tables = tables_of_joints(system) if isinstance(system, SympySystem) else None
    if tables is None:
        formed = _of_lagrange(system) if isinstance(system, LagrangesMethod) else _of_kane(system)
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
    alone = LagrangesMethod(L, list(q), forcelist=method.forcelist or None, frame=method.inertial)
    rows = [-x for x in alone.form_lagranges_equations()]
    at_rest = L.xreplace({x.diff(t): sympy.S.Zero for x in q})
    gaps = tuple(method._hol_coneqs)
    return Formed(q, (), (), gaps, tuple(method.coneqs)[len(gaps) :], L - at_rest, tuple(rows), -at_rest)


def _of_kane(system: Any) -> Formed:
    """T of the bodies, and Fr + Fr* as if nothing tied the speeds.

    Raises:
        DerivationError: auxiliary speeds; no bodies; kinematic equations that are missing.
    """
    if isinstance(system, SympySystem):
        frame, bodies, kinematic = system.frame, system.bodies, tuple(system.kdes)
        forces = [*system.loads, *(load for each in system.actuators for load in each.to_loads())]
        gaps, velocities = tuple(system.holonomic_constraints), tuple(system.nonholonomic_constraints)
        auxiliary = system.u_aux
    else:
        frame, bodies, forces = system._inertial, system.bodies, system.forcelist
        kinematic = tuple(rate - x for rate, x in (system._qdot_u_map or {}).items())
        gaps, auxiliary = tuple(system._f_h), system._uaux
        velocities = tuple(system._f_nh + system._k_nh * system.u) if system._k_nh else ()
    if len(auxiliary):
        raise DerivationError("auxiliary speeds have no counterpart", mend="leave them out, and ask for reactions")
    if not bodies:
        raise DerivationError("the method has no bodies", mend="give them to it: KanesMethod(..., bodies=bodies)")
    q, u = tuple(system.q), tuple(system.u)
    if len(kinematic) != len(q):
        raise DerivationError(
            f"{len(kinematic)} kinematic equations for {len(q)} coordinates", mend="give one for each"
        )
    alone = KanesMethod(frame, list(q), list(u), kd_eqs=list(kinematic))
    fr, star = alone.kanes_equations(list(bodies), list(forces) if forces else None)
    T = sum((body.kinetic_energy(frame) for body in bodies), start=sympy.S.Zero)
    return Formed(q, u, kinematic, gaps, velocities, T, tuple(fr + star))


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
        solved = sympy.solve(kinematic, list(formed.u), dict=True) if formed.u else [{}]
        if not solved or len(solved[0]) != len(formed.u):
            raise DerivationError(
                "the kinematic equations do not give every speed", mend="give one for each coordinate"
            )
        rates = speeds_as_rates(self.q, formed.u, kinematic)
        combined = [solved[0][u] for u in formed.u if u not in rates]  # what stands in one is no speed by itself
        rates = {u: q for u, q in rates.items() if not any(x.has(q.diff(t)) for x in combined)}
        self.words = Words(self.q, formed.u, rates)
        self.speeds = {u: solved[0][u] for u in formed.u if u not in rates}

    def tables(self) -> Entries:
        formed, words = self.formed, self.words
        q = [words.nodes[words.of(x)] for x in self.q]
        w = [words.nodes[words.of(x.diff(dynamicsymbols._t))] for x in self.q]
        T, V, *rows = (words.scalar(x) for x in (formed.T, formed.V, *formed.rows))
        velocities = [words.scalar(x) for x in formed.velocities]
        gaps = [words.scalar(x) for x in formed.gaps]
        own = {words.nodes[words.of(u)]: words.scalar(rate) for u, rate in self.speeds.items()}
        accelerated = {words.nodes[f"{u.name}'"]: self._rate((x,), q, w)[0] for u, x in own.items()}
        still = {words.nodes[f"{x.name}'"]: 0 for x in w}
        known = own | accelerated | still
        (T, *rows) = substituted(substituted((T, *rows), known), still)
        u = [words.nodes[words.of(x)] for x in formed.u] or w
        Q = self._forces(q, w, T, V, [(own.get(x, x), row) for x, row in zip(u, rows, strict=True)])
        ties = {f"tie{k}": {"kind": "equation", "gap": x} for k, x in enumerate(file_texts(gaps), 1)}
        kept = _beyond(q, w, self._rate(gaps, q, w), substituted(velocities, own))
        shown = file_texts([velocities[k] for k in kept])
        ties |= {f"tie{len(gaps) + k}": {"kind": "equation", "rate": x} for k, x in enumerate(shown, 1)}
        energies = zip(("T", "V"), ("kinetic", "potential"), file_texts([words.scalar(formed.T), V]), strict=True)
        forces: Entries = {name: {"kind": kind, "energy": x} for name, kind, x in energies if x != 0}
        along = zip(q, file_texts(Q), strict=True)
        forces |= {
            f"Q_{x.name}": {"kind": "generalized", "coordinate": x.name, "value": value}
            for x, value in along
            if value != 0
        }
        speeds = file_texts(list(own.values()))
        return without_empty(
            {
                "parameters": {name: {} for name in words.parameters.values()},
                "coordinates": {x.name: {"start": 0} for x in q},
                "speeds": {x.name: {"rate": rate} for x, rate in zip(own, speeds, strict=True)},
                "inputs": {name: {"value": 0} for name in words.inputs.values()},
                "constraints": ties,
                "forces": forces,
            }
        )

    def _rate(self, outputs: Sequence[Scalar], q: list[Node], w: list[Node]) -> tuple[Scalar, ...]:
        """d/dt of functions of q, q' and t where q'' = 0."""
        return tangent(tuple(outputs), {self.words.nodes["t"]: 1, **dict(zip(q, w, strict=True))})

    def _forces(
        self, q: list[Node], w: list[Node], T: Scalar, V: Scalar, rows: Sequence[tuple[Scalar, Scalar]]
    ) -> list[Scalar]:
        """d/dt dT/dq' - dT/dq + dV/dq + sum r_k du_k/dq' where q'' = 0."""
        momenta = self._rate(gradient(T, w), q, w)
        held, elastic = gradient(T, q), gradient(V, q)
        found = [p - x + y for p, x, y in zip(momenta, held, elastic, strict=True)]
        for speed, row in rows:
            found = [x + row * slope for x, slope in zip(found, gradient(speed, w), strict=True)]
        return found


def _beyond(q: list[Node], w: list[Node], rates: Sequence[Scalar], velocities: Sequence[Scalar]) -> list[int]:
    """The velocity equations that do not follow from the rates of the gaps."""
    J = [gradient(x, w) for x in (*rates, *velocities)]
    flat = [x for row in J for x in row]
    rng = Random(1)
    state = {x: rng.uniform(0.5, 1.5) for x in symbols_of(flat)}
    found = np.array(evaluate(flat, state, FLOAT), dtype=float).reshape(len(J), len(w))
    ranks = [int(np.linalg.matrix_rank(found[:k], tol=RANK_NEARBY)) if k else 0 for k in range(len(J) + 1)]
    first = len(rates)
    return [k for k in range(len(velocities)) if ranks[first + k + 1] > ranks[first + k]]
