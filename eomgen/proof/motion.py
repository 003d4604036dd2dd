"""Run -> checks: the code that ran, its steps, the energy, the constraints and the norms, at states that it visited."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide, Solve
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.mechanics.free_bodies import SystemFriction
from eomgen.proof import emitted_code
from eomgen.proof.check import Check, checked, unchecked
from eomgen.proof.declared_loads import Declared
from eomgen.proof.emitted_code import PhaseMotion, TriedState
from eomgen.proof.identities import energy_function, given_power
from eomgen.symbolic.expression import Fraction, Scalar, State, depends_on, gradient, is_zero
from eomgen.symbolic.numeric import tolerances

HALF = Fraction(1, 2)
PER_STEP = 10  # tolerances of the run that one step may cost
SURE = 0.1  # of a limit: how unsure an integral may be to be judged by it
VISITED = 5  # states of a phase at which the code is tried
FAST = 0.01  # of the largest T so far: above it speeds put the energy on its level
PLACES = 40  # steps that are taken again
PARTS = (1, 2, 4)  # of a step, until its work is sure
EXPLICIT = "the run's right-hand side, order 8"


@dataclass(frozen=True)
class Leg:
    """One phase of a run.

    Args:
        equations, p: its equations, and the parameters' values.
        code: the right-hand side that ran.
        t, x: n instants in order, the requested ones and the integrator's steps, and the states there.
        carried: starts and ends of singular crossings, in which nothing was integrated.
        pulled: whether its constraints were pulled together by Baumgarte's rows.
        known: compiled functions of its equations, for all runs by them.
    """

    equations: EquationsOfMotion
    p: np.ndarray
    code: RightHandSide
    t: np.ndarray
    x: np.ndarray
    carried: tuple[tuple[float, float], ...] = ()
    pulled: bool = False
    known: dict[Hashable, Any] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def energies(self) -> Energies:
        return Energies(self.equations, self.p, self.pulled, self.known)

    @cached_property
    def TVH(self) -> np.ndarray:
        """(T, V, H) along the leg, 3 x n [J]."""
        with np.errstate(all="ignore"):
            return self.energies.along(self.t, self.x)

    def rates(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        return self.code.many(t, x, self.p)

    @property
    def integrated(self) -> np.ndarray:
        """Mask of the intervals between neighbouring states that the integrator went through."""
        found = np.diff(self.t) > 0
        for start, end in self.carried:
            found &= (self.t[1:] <= start) | (self.t[:-1] >= end)
        return found


@dataclass(frozen=True)
class Promise:
    """Accuracy that a run promises: an error of at most 10 (rtol size + atol) for each step.

    Args:
        rtol, atol: tolerances of the run.
        steps: how many it took.
        projected: True if each step was projected onto the constraints, so that their errors do not add up.
        levelled: True if each step was put back on the energy of the start, where the speeds allow it.
    """

    rtol: float
    atol: float
    steps: int
    projected: bool = False
    levelled: bool = False

    def of_one_step(self, size: float) -> float:
        return PER_STEP * (self.rtol * size + self.atol)

    def limit(self, size: float) -> float:
        return self.of_one_step(size) * max(self.steps, 1)

    def open(self, size: float) -> float:
        """Limit of the error of constraints, for states of a size."""
        return PER_STEP * (self.atol + tolerances.SUMMED * size) if self.projected else self.limit(size)


def code_and_steps(legs: Sequence[Leg], promise: Promise) -> tuple[Check, ...]:
    """Checks that the code that ran is that of the equations, and that its steps are repeated by another method."""
    moving = _moving(legs)
    return (_code(moving), _steps(moving, promise)) if moving else ()


def energy_and_constraints(legs: Sequence[Leg], promise: Promise) -> tuple[Check, ...]:
    """Checks that every run makes: energy against power, constraints, and norms of quaternions."""
    moving = _moving(legs)
    if not moving:
        return ()
    found = (
        energy_kept(moving, promise),
        _level(moving, promise),
        _constraints(moving, promise),
        _norms(moving, promise),
    )
    return tuple(check for check in found if check is not None)


def _moving(legs: Sequence[Leg]) -> list[Leg]:
    return [leg for leg in legs if len(leg.t) and len(leg.equations.symbols.u)]


# -- the code that ran -----------------------------------------------------------------------------


def _code(legs: Sequence[Leg]) -> Check:
    """Check of the code at the start, the end and between, of every phase; a phase that fails decides."""
    name = f"the code that ran ({legs[0].code.target}) gives the symbols' numbers"
    made: dict[int, Leg] = {id(leg.code): leg for leg in reversed(legs)}
    found = [_code_of(leg, name) for leg in reversed(made.values())]
    return next((check for check in found if check.ok is False), next((c for c in found if c.ok), found[0]))


def _code_of(leg: Leg, name: str) -> Check:
    places = dict.fromkeys([0, *np.linspace(0, len(leg.t) - 1, VISITED)[1:].astype(int).tolist()])
    at = [TriedState(float(leg.t[i]), leg.x[i], leg.p) for i in places]
    motion = PhaseMotion(leg.equations)
    return emitted_code.equations_hold(motion, lambda instant: leg.code(instant.t, instant.x, instant.p), at, name)


# -- the steps -------------------------------------------------------------------------------------


def _steps(legs: Sequence[Leg], promise: Promise) -> Check:
    """Check of steps, repeated in two halves: |difference| <= 10 (rtol |x| + atol)."""
    name, how = "steps repeated from states of the run end at its next states", f"{EXPLICIT}, half steps"
    size = max(float(np.max(np.abs(leg.x), initial=0.0)) for leg in legs)
    limit, judged = promise.of_one_step(size), 0
    for leg in legs:
        places = np.flatnonzero(leg.integrated)
        i = places[np.unique(np.linspace(0, len(places) - 1, PLACES).astype(int))] if len(places) else places
        with np.errstate(all="ignore"):
            i = i[np.max(np.abs(leg.rates(leg.t[i], leg.x[i])), axis=1, initial=0.0) < tolerances.LARGEST_SQUARED]
        if not len(i):
            continue
        with np.errstate(all="ignore"):
            there, _, unsure = followed(leg.rates, _nothing, leg.t[i], leg.x[i], leg.t[i + 1], parts=2)
        sure = np.max(unsure, axis=1, initial=0.0) <= SURE * limit
        apart = np.where(sure, np.max(np.abs(there - leg.x[i + 1]), axis=1, initial=0.0), 0.0)
        judged += int(np.sum(sure))
        k = int(np.argmax(apart))
        if not apart[k] <= limit:
            return checked(name, f"{apart[k]:.1e} apart at t = {leg.t[i[k] + 1]:.6g} s, limit {limit:.1e}", how)
    if not judged:
        return unchecked(name, "its steps are too long, too stiff or too fast for the explicit method", how)
    return Check(name, "holds", how, f"{judged} steps")


def _nothing(t: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.zeros(len(t))


# -- energy ----------------------------------------------------------------------------------------


def energy_kept(legs: Sequence[Leg], promise: Promise) -> Check:
    """|E - E(0) - integral of the power| <= 10 (rtol E_max + atol) steps, in every phase from its start.

    E_max: the largest |T| + |V - V(0)| on the way. Where motions are given E is H = u . dT/du - T + V.
    """
    name, how = "E - E0 is the integral of the power", "T and V at the steps; power by virtual work, order 8"
    moving = max(float(np.max(np.abs(leg.TVH[0]) + np.abs(leg.TVH[1] - leg.TVH[1][0]))) for leg in legs)
    limit = promise.limit(moving)
    if not np.isfinite(limit):
        return unchecked(name, "the energy has no value at some of the states", how)
    worst, when, unsure = 0.0, 0.0, 0.0
    for leg in legs:
        work, left = _work(leg, SURE * limit)
        unsure = max(unsure, left)
        drift = np.abs(leg.TVH[2] - leg.TVH[2][0] - work)
        k = int(np.argmax(drift))
        if not drift[k] <= worst:
            worst, when = float(drift[k]), float(leg.t[k])
    if not np.isfinite(worst):
        return unchecked(name, "the energy has no value at some of the states", how)
    if not unsure <= SURE * limit:
        return unchecked(name, f"the integral of the power is not sure: by {unsure:.1e} J, limit {limit:.1e} J", how)
    reported = (
        f"|E - E0 - W| <= {worst:.1e} J at t = {when:.6g} s, limit {limit:.1e} J, energy that moves {moving:.3g} J"
    )
    return Check(name, "holds" if worst <= limit else "fails", how, reported)


def _level(legs: Sequence[Leg], promise: Promise) -> Check | None:
    """|E - E(0)| <= rounding of E_max at every step whose kinetic energy is not negligible."""
    if not promise.levelled:
        return None
    name, how = "speeds put the energy on the level of the start", "T and V at the steps"
    worst, limit = 0.0, 0.0
    for leg in legs:
        T, V, H = leg.TVH
        fast = T > FAST * np.maximum.accumulate(T)
        limit = max(limit, tolerances.ITERATED * float(np.max(T + np.abs(V - V[0]))))
        worst = max(worst, float(np.max(np.abs(H - H[0])[fast], initial=0.0)))
    if not np.isfinite(limit + worst):
        return unchecked(name, "the energy has no value at some of the states", how)
    return Check(name, "holds" if worst <= limit else "fails", how, f"|E - E0| <= {worst:.1e} J, limit {limit:.1e} J")


def _work(leg: Leg, wanted: float) -> tuple[np.ndarray, float]:
    """(the integral of the power from the start to each of the instants [J], how unsure it is)."""
    if is_zero(leg.energies.power):
        return np.zeros(len(leg.t)), 0.0
    places = np.flatnonzero(leg.integrated)
    work, unsure = np.zeros(len(leg.t) - 1), np.zeros(len(leg.t) - 1)
    with np.errstate(all="ignore"):
        if not np.all(leg.integrated):
            P, dt = leg.energies.powers(leg.t, leg.x), np.diff(leg.t)
            work[:] = 0.5 * (P[1:] + P[:-1]) * dt
            unsure[:] = np.abs(np.diff(P)) * dt
        for parts in PARTS:
            begin, end = leg.t[places], leg.t[places + 1]
            _, found, doubt = followed(leg.rates, leg.energies.powers, begin, leg.x[places], end, parts)
            work[places], unsure[places] = found, doubt[:, -1]
            if np.sum(unsure[leg.integrated]) <= wanted:
                break
            places = places[~(doubt[:, -1] <= wanted / len(leg.t))]
    return np.concatenate([[0.0], np.cumsum(work)]), float(np.sum(unsure))


# -- constraints and norms --------------------------------------------------------------------------------


def _constraints(legs: Sequence[Leg], promise: Promise) -> Check | None:
    """|phi| and |J u + sigma| <= 10 (atol + rounding of the largest entry) at every state, which is put back onto them.

    Where it is not, 10 (rtol |q| + atol) steps and 10 (rtol |u| + atol) steps.
    """
    name, how = "the constraints are satisfied", "gaps and their velocities at the steps, eliminated rows too"
    judged = 0
    for leg in legs:
        rows = [row for row in leg.equations.system.constraints.rows if not row.identical]
        gaps = tuple(row.gap for row in rows if row.gap is not None)
        n = len(leg.equations.symbols.q)
        for scalars, part, what in (
            (gaps, leg.x[:, :n], "open"),
            (tuple(r.velocity for r in rows), leg.x[:, n:], "opening"),
        ):
            if not scalars:
                continue
            limit = promise.open(float(np.max(np.abs(leg.x if promise.projected else part), initial=0.0)))
            if not np.isfinite(limit):
                return unchecked(name, "there are states without a value", how)
            found = np.max(np.abs(_function(leg, scalars)), axis=1)
            judged, k = judged + len(scalars), int(np.argmax(found))
            if not found[k] <= limit and not promise.projected:
                limit *= _leverage(leg, scalars, k)
            if not found[k] <= limit:
                return checked(name, f"{what} by {found[k]:.1e} at t = {leg.t[k]:.6g} s, limit {limit:.1e}", how)
    return checked(name, "", how) if judged else None


def _leverage(leg: Leg, scalars: tuple[Scalar, ...], k: int) -> float:
    """Factor by which an error of the k-th state opens a scalar, at least 1; large for a rod of 1e9 m that turns."""
    symbols = leg.equations.symbols
    slopes = tuple(x for scalar in scalars for x in gradient(scalar, symbols.x))
    one = replace(leg, t=leg.t[k : k + 1], x=leg.x[k : k + 1])
    return max(1.0, float(np.max(np.abs(_function(one, slopes)), initial=0.0)))


def _norms(legs: Sequence[Leg], promise: Promise) -> Check | None:
    """|e . e - 1| <= 10 (rtol + atol) steps of every quaternion."""
    fours = [(leg, four) for leg in legs for four in leg.equations.system.scope.quaternions]
    if not fours:
        return None
    name, how = "quaternions keep their norm", "sums of squares at the steps"
    for leg, four in fours:
        away = np.abs(_function(leg, (sum((e * e for e in four), start=-1),)))[:, 0]
        k = int(np.argmax(away))
        if not away[k] <= promise.limit(1.0):
            return checked(name, f"e . e = 1 is missed by {away[k]:.1e} at t = {leg.t[k]:.6g} s", how)
    return checked(name, "", how)


def _function(leg: Leg, scalars: tuple[Scalar, ...]) -> np.ndarray:
    key = ("proof", scalars)
    if key not in leg.known:
        leg.known[key] = RightHandSide.of(
            Program.of(scalars, leg.equations.symbols, inputs=leg.equations.inputs), "numpy"
        )
    function: RightHandSide = leg.known[key]
    with np.errstate(all="ignore"):
        return function.many(leg.t, leg.x, leg.p)


# -------- power -----------------------------------------------------------------------------------------------
# Equations, states along a motion -> check of its energy: H - H(0) against the integral of the power.
#
#     H = u . dT/du - T + V    (T + V where nothing moves by itself)
#     dH/dt = Q_nc . u + u . J^T lam + d(V - T)/dt by explicit time and driven coordinates
#
# The integral is taken along the motion by an explicit method of order 8, one step from each state to the next, with
# the error estimated by its formulas of orders 5 and 3.


Rates = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""(t n, x n x states) -> x', n x states."""


@dataclass(frozen=True)
class Energies:
    """The energies of one phase, and the power that changes them.

    Args:
        p: the parameters' values.
        pulled: whether the constraints take power by being open: Baumgarte's rows.
        known: compiled functions of the equations, for any values of the parameters.
    """

    equations: EquationsOfMotion
    p: np.ndarray
    pulled: bool = False
    known: dict[Hashable, Any] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def power(self) -> Scalar:
        """dH/dt = Q_nc . u + u . J^T lam + d(V - T)/dt by explicit time and driven coordinates."""
        equations = self.equations
        found = given_power(equations)
        for sigma, row, lam in zip(equations.sigma, equations.J, equations.symbols.lam, strict=True):
            if self.pulled:
                found = found + lam * sum((x * u for x, u in zip(row, equations.symbols.u, strict=True)), start=0)
            elif not is_zero(sigma):
                found = found - lam * sigma
        return SystemFriction(self.equations.system).with_rest((found,))[0]

    def along(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """(T, V, H), each n [J]."""
        return self._energies.many(t, x, self.p).T

    def powers(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """dH/dt, n [W]."""
        return self._power.many(t, x, self.p)[:, 0] if not is_zero(self.power) else np.zeros(len(t))

    @property
    def _energies(self) -> RightHandSide:
        return self._compiled((self.equations.T, self.equations.V, energy_function(self.equations)))

    @property
    def _power(self) -> RightHandSide:
        return self._compiled((self.power,))

    def _compiled(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        key = ("proof of energies", scalars)
        if key not in self.known:
            self.known[key] = self._program(scalars)
        found: RightHandSide = self.known[key]
        return found

    def _program(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        symbols = self.equations.symbols
        solve = Solve.bordered(self.equations) if depends_on(scalars[-1], symbols.lam) else None
        return RightHandSide.of(Program.of(scalars, symbols, inputs=self.equations.inputs, solve=solve), "numpy")


def followed(
    rates: Rates, powers: Rates, t: np.ndarray, x: np.ndarray, later: np.ndarray, parts: int = 1
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(the state at `later`, the work until then, how unsure both are), of each of n states by itself.

    y = (x, W), y' = (rates, powers), by Dormand and Prince's formulas of order 8 in so many equal steps.
    """
    from scipy.integrate import DOP853

    y, h = np.column_stack([x, np.zeros(len(t))]), (later - t) / parts
    unsure, errors = np.zeros_like(y), (DOP853.E5[:-1], DOP853.E3[:-1])  # the state at the end has no share in them
    counted = np.any([DOP853.B, *errors], axis=0)  # the power of other stages stands in no sum
    for part in range(parts):
        K = np.zeros((DOP853.n_stages, *y.shape))
        for i in range(DOP853.n_stages):
            now = (y + h[:, None] * np.tensordot(DOP853.A[i, :i], K[:i], axes=1))[:, :-1]
            when = t + (part + DOP853.C[i]) * h
            K[i, :, :-1] = rates(when, now)
            if counted[i]:
                K[i, :, -1:] = powers(when, now).reshape(len(t), 1)
        y = y + h[:, None] * np.tensordot(DOP853.B, K, axes=1)
        fine, coarse = (np.abs(h[:, None] * np.tensordot(E, K, axes=1)) for E in errors)
        unsure = unsure + fine * fine / np.maximum(np.hypot(fine, 0.1 * coarse), np.finfo(float).tiny)
    return y[:, :-1], y[:, -1], unsure


# -------- energies --------------------------------------------------------------------------------------------
# System, state -> whether T and V are those of its bodies: their constant parts, which no equation of motion knows.
#
#     T = sum of (m v_C . v_C + w . I w)/2 by the twists,      V = - sum of m g . r_C, and the other potentials
#
# Rotors, springs of joints and given energies are taken from their fields.


def other_energies(equations: EquationsOfMotion, state: State) -> str:
    """Message if T or V at a state is not that of the bodies and forces; ""."""
    proof = Declared(equations.system, state)
    parts = {"T": proof.at([*_of_motion(proof)]), "V": [*_of_places(proof)]}
    for (letter, due), stated in zip(parts.items(), proof.at((equations.T, equations.V)), strict=True):
        total = sum(due, start=0 * stated)
        if abs(stated - total) > tolerances.ZERO_AT_50 * (1 + sum(map(abs, due))):
            return f"{letter} is {float(stated):.10g}, that of the bodies {float(total):.10g}"
    return ""


def _of_motion(proof: Declared) -> Iterator[Scalar]:
    scope = proof.system.scope
    moving = (force for force in scope.model.forces.values() if force.moving)
    yield from (act.kinetic for force in moving for act in force.acts(proof) if act.kinetic is not None)
    for link in proof.motion.links:
        mass, w = scope.mass_properties(link.name), link.twist.w
        v = link.twist.at(mass.com).v
        yield HALF * mass.m * (v @ v)
        yield HALF * (w @ (mass.I @ w))
        for push in () if link.joint is None else link.joint.pushes():
            rate = scope.time_derivative((scope.value(push.way),))[0]
            yield HALF * scope.value(push.armature) * rate * rate


def _of_places(proof: Declared) -> Iterator[Any]:
    """Potential energies of weights, given energies and springs in joints, as they are declared.

    Elements between points are checked by themselves, and enter with the energy that they state.
    """
    scope = proof.system.scope
    for applied in proof.system.loads.applied:
        force = scope.model.forces[applied.name]
        if force.by_mass or force.placeless:  # constant along what they move: V = - F . r
            for act in force.acts(proof):
                yield from (-f * x for f, x in zip(act.force, proof.at(act.moving), strict=True))
        elif applied.potential is not None:
            yield proof.one(applied.potential)
    for link in proof.system.motion.links:
        for push in () if link.joint is None else link.joint.pushes():
            stretch = scope.value(push.way) - scope.value(push.rest)
            yield proof.one(HALF * scope.value(push.stiffness) * stretch * stretch)
