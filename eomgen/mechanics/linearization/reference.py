"""System -> Reference: the equilibrium, or the steady motion, about which small motions are sought."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import EquationsOfMotion, System, WellPosed
from eomgen.mechanics.equilibrium import Equilibrium, StaticEquations
from eomgen.mechanics.free_bodies import equations_of_motion
from eomgen.mechanics.integrals import position_equations
from eomgen.mechanics.kinematics import Located
from eomgen.mechanics.start import Start
from eomgen.mechanics.state import Doubles, Numbers, Split
from eomgen.symbolic.expression import (
    Node,
    Scalar,
    ScalarRows,
    State,
    depends_on,
    holds_many_digits,
    inner,
    is_zero,
    jacobian,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

# -------- reference -------------------------------------------------------------------------------------------
# System -> Reference: the equilibrium, or the steady motion, about which small motions are sought.


EQUILIBRIUM, START, STEADY = "equilibrium", "start", "steady"


@dataclass(frozen=True)
class ReferenceMotion:
    """The state about which the equations are linearized.

    Args:
        system: of the model; about an equilibrium its drives are held.
        about: EQUILIBRIUM, START or STEADY.
        exact: t, q, u, z and inputs as scalars of the parameters, as far as they are known so.
        numbers: t, q, u, z, inputs and parameters, with 50 digits; parameters without a value have one to try.
        place: the equilibrium, where it was sought.
        family: the steady motions that one belongs to, where it was sought and they could be written.
        beside: the requested start, which is no equilibrium or steady motion but is near this one; None where no start
            was requested.
    """

    system: System
    about: str
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, Any]
    place: Equilibrium | None = None
    family: Family | None = None
    beside: Mapping[Node, float] | None = None

    @property
    def about_equilibrium(self) -> bool:
        """True if the state is an equilibrium."""
        return self.about == EQUILIBRIUM

    @property
    def about_steady_motion(self) -> bool:
        """True if the state is one of a steady motion."""
        return self.about == STEADY

    @property
    def is_exact(self) -> bool:
        """True if all coordinates and speeds are known in closed form."""
        symbols = self.system.symbols
        return all(x in self.exact for x in symbols.x)

    @property
    def at_rest(self) -> bool:
        """True if all speeds are exactly 0."""
        return all(is_zero(self.exact.get(u, u)) for u in self.system.symbols.u)

    @property
    def valued(self) -> bool:
        """True if all parameters have values."""
        return not self.system.symbols.parameters.keys() - self.system.scope.model.exact_parameters().keys()

    @cached_property
    def moving(self) -> dict[Node, Any]:
        """The coordinates that move in the reference, and their rates."""
        rates = evaluate(self.system.scope.rates, self.numbers, fifty_digits())
        return {q: rate for q, rate in zip(self.system.symbols.q, rates, strict=True) if abs(rate) > tolerances.SOLVED}

    @property
    def trial(self) -> dict[Node, Any]:
        """The values of the parameters."""
        return {x: self.numbers[x] for x in self.system.symbols.parameters.values()}


def place_of_rest(system: System, guess: Mapping[str, float] | None = None) -> ReferenceMotion:
    """The equilibrium nearest to the guess.

    Args:
        guess: values of coordinates in place of `near` and `start`.
    Raises:
        DerivationError: none was found; a one-sided contact would have to pull.
        NotYet: speeds that are not rates.
    """
    place = Equilibrium.nearest(StaticEquations.of(system), guess)
    if system.scope.model.contacts:
        place.refuse_contradicted()
    return about_place(place)


def relative_rest(equations: EquationsOfMotion, guess: Mapping[str, float] | None = None) -> ReferenceMotion:
    """Relative equilibrium, at rest relative to what the model drives at a steady rate: a bead on a turning hoop.

    forcing + J^T lam = 0 and z' = 0 at u = 0, forcing with the inertia forces of the drives' motion.

    Raises:
        DerivationError: none was found.
    """
    system = equations.system
    symbols, coordinates = system.symbols, system.scope.model.coordinates
    start = system.scope.start_values()
    driven = [q for q in symbols.q if coordinates[q.name].driven]
    given = system.standing({q: start[q] for q in driven})
    forcing = substituted(equations.forcing, given)
    own = {q: k for k, u in enumerate(symbols.u) for q in symbols.q if u.name == f"{q.name}'"}
    if len(own) != len(symbols.u) or len(own) + len(driven) != len(symbols.q):
        raise DerivationError(
            "relative rest is sought only where every coordinate is free or driven",
            "coordinates",
            fix='ask about = "start"',
        )
    Q = (*(forcing[k] for k in own.values()), *substituted(equations.state_rates, given))
    statics = StaticEquations(
        system,
        (),
        (*own, *symbols.z),
        given,
        Q,
        Q,
        tuple((*substituted(row, given), *(0 for _ in symbols.z)) for row in equations.J),
        symbols.lam,
        substituted(tuple(x for x in position_equations(system, start) if depends_on(x, own)), given),
    )
    return about_place(Equilibrium.nearest(statics, guess))


def about_place(place: Equilibrium) -> ReferenceMotion:
    """The reference that an equilibrium is."""
    system = StaticEquations.over_rates(place.statics.system)
    symbols = system.symbols
    still: dict[Node, Scalar] = {symbols.t: 0, **dict.fromkeys(symbols.u, 0)}
    found = {q: place.exact[q] for q in symbols.places if q in place.exact}
    exact = (_short(found) if place.numbers else found) | still
    trial = system.scope.values_of_parameters(Random(3))
    numbers: dict[Node, Any] = {**trial, **_numbers(still, trial)}
    for q in symbols.places:
        numbers[q] = _numbers({q: exact[q]}, trial)[q] if q in exact else fifty_digits().number(place.numbers[q])
    return _with_inputs(ReferenceMotion(system, EQUILIBRIUM, exact, numbers, place))


def at_the_start(system: System, *, at_rest: bool, given: Mapping[str, float] | None = None) -> ReferenceMotion:
    """The start of the model, without its speeds where it is to be an equilibrium.

    Args:
        given: coordinates and speeds in place of the model's.
    Raises:
        DerivationError: a constraint that does not hold there.
    """
    symbols, scope, model = system.symbols, system.scope, system.scope.model
    trial = scope.values_of_parameters(Random(3))
    parameters = {name: float(trial[node]) for name, node in symbols.parameters.items()}
    state = Start.of(system, parameters, given).values
    numbers: dict[Node, Any] = {**trial, symbols.t: fifty_digits().number(0)}
    sought = system.constraints.fixed_by_position
    exact = {symbols.t: 0} | scope.start_values(q for q in symbols.q if q not in sought)
    for u in symbols.u:
        speed = model.coordinates[u.name[:-1]].speed if u.name.endswith("'") else model.speeds[u.name].start
        exact[u] = 0 if at_rest else scope.value(speed)
    exact |= scope.start_values(symbols.z)
    located = Located(
        {
            **{x: float(v) for x, v in numbers.items()},
            **{x: 0.0 if at_rest and x in symbols.u else state[x.name] for x in symbols.x},
        },
        scope.positive,
    )
    gaps = [gap for row in system.constraints.rows if (gap := _gap(row)) is not None]
    exact |= located.places(substituted(tuple(gaps), exact), sought) if sought else {}
    exact = {x: value for x, value in exact.items() if x is symbols.t or located.agrees(value, x)}
    exact = exact if symbols.parameters.keys() - model.exact_parameters().keys() else _short(exact)
    for x in symbols.x:
        numbers[x] = _numbers({x: exact[x]}, trial)[x] if x in exact else fifty_digits().number(located.numbers[x])
    return _with_inputs(ReferenceMotion(system, EQUILIBRIUM if at_rest else START, exact, numbers))


def in_closed_form(reference: ReferenceMotion, state: Mapping[Node, Scalar]) -> ReferenceMotion:
    """The reference with coordinates and speeds that are known as scalars of the parameters."""
    numbers = {**reference.numbers, **_numbers(state, reference.trial)}
    return replace(reference, exact={**reference.exact, **state}, numbers=numbers)


def _short(state: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """Entries of a state that can be in a formula; a double with all its digits is a number, and no part of one."""
    return {node: x for node, x in state.items() if not holds_many_digits(x)}


def _gap(row: Row) -> Scalar | None:
    return None if row.identical else row.gap


def _with_inputs(reference: ReferenceMotion) -> ReferenceMotion:
    """Inputs as they are at t = 0.

    Raises:
        DerivationError: a coordinate is so far away that nothing small is left of it.
    """
    system = reference.system
    Start.refuse_lost({q: reference.numbers[q] for q in system.symbols.q})
    given = {node: system.inputs[name] for name, node in system.symbols.inputs.items()}
    exact = dict(zip(given, substituted(tuple(given.values()), reference.exact), strict=True))
    exact = {x: value for x, value in exact.items() if not depends_on(value, system.symbols.x)}
    numbers = dict(reference.numbers)
    for node, value in given.items():
        numbers[node] = evaluate((value,), numbers, fifty_digits())[0]
    return replace(reference, exact={**reference.exact, **exact}, numbers=numbers)


def _numbers(state: Mapping[Node, Scalar], trial: Mapping[Node, Any]) -> dict[Node, Any]:
    return dict(zip(state, evaluate(tuple(state.values()), trial, fifty_digits()), strict=True))


# -------- family ----------------------------------------------------------------------------------------------
# The family of steady motions that one belongs to: top, governor, rolling disc in a circle.


@dataclass(frozen=True)
class Family:
    """The steady motions that one belongs to.

    Args:
        held: coordinates and speeds that say which of them it is.
        following: those that follow from these.
        conditions: what vanishes, of both.
        formulas: those that follow, as functions of the held; {}: no closed form.
        state: everything in closed form at the values of the start; {}: not known so.
        zeros: coordinates that are held at 0, by which other conditions are satisfied.
        others: those that follow, in all the motions with the same values held that were found, this one first.
        closed: the same as functions of the held; {} for one that has no closed form.
        complete: True if there are no others in the region that `where` names.
    """

    held: tuple[Node, ...]
    following: tuple[Node, ...]
    conditions: tuple[Scalar, ...]
    formulas: State
    state: State
    zeros: tuple[Node, ...] = ()
    others: tuple[Mapping[Node, float], ...] = ()
    closed: tuple[State, ...] = ()
    complete: bool = False
    where: str = ""


# -------- first order -----------------------------------------------------------------------------------------
# System -> FirstOrder: its equations of motion with their first derivatives, exact or as numbers.


# -------- first order -----------------------------------------------------------------------------------------
# System -> FirstOrder: its equations of motion with their first derivatives, and what may stay independent.


@dataclass(frozen=True)
class Choice:
    """The independent coordinates and speeds, and the rows that are solved for the dependent ones.

    Args:
        places: of the coordinates, by the relations between them.
        speeds: of the speeds, by the constraint rows.
        standing: True if small turns of spinning bodies are about axes fixed in space; else about body axes.
    """

    places: Split
    speeds: Split
    standing: bool = False


@dataclass(frozen=True)
class FirstOrder:
    """The equations of motion of a system, and their first derivatives, as graph scalars.

    Args:
        equations: the equations of motion.
        relations: what is known between positions: they vanish.
        at_rest: whether it is looked at where all speeds are 0 alone: what holds none of them is far shorter.
    """

    equations: EquationsOfMotion
    relations: tuple[Scalar, ...]
    at_rest: bool = False

    @property
    def system(self) -> System:
        return self.equations.system

    def looked_at(self, *, at_rest: bool) -> FirstOrder:
        """The same equations for states at rest, or for moving ones, without a new derivation."""
        return self if at_rest == self.at_rest else replace(self, at_rest=at_rest)

    @property
    def residual(self) -> tuple[Scalar, ...]:
        """M a - forcing - J^T lam."""
        return self.equations.residual[0]

    @cached_property
    def seen(self) -> frozenset[str]:
        """The names of symbols in the equations of motion."""
        e = self.equations
        rows = (*e.M, e.forcing, *e.J, e.sigma, e.gamma, e.state_rates)
        return frozenset(x.name for x in symbols_of(x for row in rows for x in row))

    @property
    def held(self) -> frozenset[Node]:
        """Symbols that occur in the equations of motion, in the rates and in the relations."""
        scope, rows = self.system.scope, (*self.equations.M, *self.equations.J, *self.rows)
        entries = (x for row in (*rows, *scope.N, scope.state_rates) for x in row)
        return frozenset(symbols_of((*entries, *self.residual, *scope.rates, *self.relations)))

    @property
    def rows(self) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
        """(J u + sigma, J a + gamma)."""
        graph, symbols = self.equations, self.system.symbols
        velocities = tuple(inner(row, symbols.u) + bias for row, bias in zip(graph.J, graph.sigma, strict=True))
        return velocities, self.equations.residual[1]

    @cached_property
    def derivatives(self) -> Mapping[str, ScalarRows]:
        """R_q, R_u, R_z, S_q, V_q, A_q, A_u, G, W, and Z_q, Z_u, Z_z, Z_a, Z_w of z' by name."""
        symbols = self.system.symbols
        q, u, w = symbols.q, symbols.u, tuple(symbols.inputs.values())
        velocities, accelerations = self.rows
        rates = self.system.scope.state_rates
        unmoved, still = self._unmoved(), dict.fromkeys(u, 0) if self.at_rest else {}

        def by_places(rows: Sequence[Scalar]) -> ScalarRows:
            return jacobian(substituted(rows, unmoved | still), q)

        return {
            "R_q": by_places(self.residual),
            "R_u": jacobian(substituted(self.residual, unmoved), u),
            "S_q": by_places(self.system.scope.rates),
            "V_q": by_places(velocities),
            "A_q": by_places(accelerations),
            "A_u": jacobian(substituted(accelerations, unmoved), u),
            "G": (*jacobian(self.relations, q), *_held(self.system)),
            "W": [[-x for x in row] for row in jacobian(self.residual, w)],
            "R_z": jacobian(substituted(self.residual, unmoved | still), symbols.z),
            "Z_q": by_places(rates),
            "Z_u": jacobian(substituted(rates, unmoved), u),
            "Z_z": jacobian(substituted(rates, unmoved | still), symbols.z),
            "Z_a": jacobian(rates, symbols.a),
            "Z_w": jacobian(rates, w),
        }

    def _unmoved(self) -> dict[Node, Scalar]:
        """Accelerations that are 0 in every state considered: all of them at rest, if no constraint needs one."""
        e, s = self.equations, self.system.symbols
        requested = substituted(e.gamma, dict.fromkeys(s.u, 0))
        return dict.fromkeys(s.a, 0) if self.at_rest and all(map(is_zero, requested)) else {}

    @staticmethod
    def of(system: System) -> FirstOrder:
        """The equations of a system to first order.

        Raises:
            ModelError: a free coordinate moves no mass.
        """
        scope = system.scope
        relations = [x for x in position_equations(system, scope.start_values()) if depends_on(x, scope.symbols.q)]
        relations += [sum((e * e for e in four), start=-1) for four in scope.quaternions]
        equations = equations_of_motion(system)
        WellPosed(equations).refuse_massless()
        return FirstOrder(equations, tuple(relations))

    def slopes_at(self, state: Mapping[Node, Any], *, single: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """(d x'/d x, d x'/d w) at a state, x = (q, u, z).

        Where constraints follow from others their multipliers are the least.

        Args:
            state: t, parameters, inputs, q, u and z as floats.
            single: nan where a change opens constraints that follow from others: no acceleration then closes them all.
        """
        e, s = self.equations, self.system.symbols
        nq, nu, nz, k, w = len(s.q), len(s.u), len(s.z), len(e.J), len(s.inputs)
        here = Doubles(state)
        M, J, N = (here.array(rows, nu) for rows in (e.M, e.J, e.N))
        K = np.block([[M, -J.T], [J, np.zeros((k, k))]])
        right = np.concatenate([here.array((e.forcing,), nu)[0], -here.array((e.gamma,), k)[0]])
        found = _solved(K, right, k)
        here = here.with_values(dict(zip((*s.a, *s.lam), found.tolist(), strict=True)))
        columns = {"R_q": nq, "R_u": nu, "R_z": nz, "W": w, "A_q": nq, "A_u": nu, "S_q": nq}
        columns |= {"Z_q": nq, "Z_u": nu, "Z_z": nz, "Z_a": nu, "Z_w": w}
        at = {name: here.array(self.derivatives[name], n) for name, n in columns.items()}
        of_rows = [at["A_q"], at["A_u"], np.zeros((k, nz + w))]
        slopes = np.block([[at["R_q"], at["R_u"], at["R_z"], -at["W"]], of_rows])
        changes = _solved(K, slopes, k)
        below = 0.0 - changes[:nu]
        if single:
            left = abs(K @ changes - slopes).max(axis=0, initial=0.0)
            below[:, left > tolerances.RANK * (1.0 + abs(slopes).max(axis=0, initial=0.0))] = np.nan
        further = np.hstack([at["Z_q"], at["Z_u"], at["Z_z"], at["Z_w"]]) + at["Z_a"] @ below
        both = np.vstack([np.hstack([at["S_q"], N, np.zeros((nq, nz + w))]), below, further])
        return both[:, : nq + nu + nz], both[:, nq + nu + nz :]


def _held(system: System) -> list[list[Scalar]]:
    """A row for each driven coordinate: it moves as given, and not otherwise."""
    q, coordinates = system.symbols.q, system.scope.model.coordinates
    return [[int(x is y) for y in q] for x in q if coordinates[x.name].driven]


# -- what stays independent --------------------------------------------------------------------------------


def choice_of(first: FirstOrder, reference: ReferenceMotion, wanted: Sequence[str]) -> Choice:
    """Coordinates and speeds that stay: those wanted, then the model's own, then the others.

    Args:
        wanted: names of coordinates that are to stay where they can.
    """
    elsewhere = _elsewhere(reference)
    symbols, coordinates = first.system.symbols, reference.system.scope.model.coordinates
    dependent = {name for name, part in coordinates.items() if part.dependent}

    turning = {e.name: abs(float(reference.numbers[e])) for four in first.system.scope.quaternions for e in four}

    def late(name: str, stays: bool) -> tuple[int, float]:
        """Rank of a variable: those of the highest rank become dependent first.

        First the model's dependent ones; of the others those with constant coefficients, then those of coordinates on
        which nothing depends, such as the position of a wheel, whose velocity turns with it. Of a quaternion the
        largest of its four components.
        """
        usual = float(stays) + 0.5 * (name in coordinates and name not in first.seen)
        return 0 if name in wanted else 2 if name in dependent else 1, turning.get(name, usual)

    def split(rows: ScalarRows, columns: Sequence[Node]) -> Split:
        here, there = (Numbers(state).array(rows, len(columns)) for state in (reference.numbers, elsewhere))
        stays = _same(here, there)
        return Split.of(here, [late(x.name.removesuffix("'"), same) for x, same in zip(columns, stays, strict=True)])

    return Choice(split(first.derivatives["G"], symbols.q), split(first.equations.J, symbols.u))


def _elsewhere(reference: ReferenceMotion) -> dict[Node, Any]:
    """The state with other coordinates."""
    rng, number = Random(4), fifty_digits().number(1)
    return {
        **reference.numbers,
        **{q: reference.numbers[q] + number * rng.uniform(0.01, 0.1) for q in reference.system.symbols.q},
    }


def _same(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    """True for each column that is the same in both matrices, up to rounding."""
    return np.asarray(np.all(abs(A - B) <= tolerances.SOLVED * abs(A).max(initial=0), axis=0))


# -------- slopes ----------------------------------------------------------------------------------------------
# EquationsOfMotion -> A, B of dx' = A dx + B dw at any state, in numbers.
#
# K [da; dlam] = -[R_q dq + R_u du + R_z dz - W dw; A_q dq + A_u du],   K = [M, -J^T; J, 0],   dq' = S_q dq + N du,
# dz' = Z_q dq + Z_u du + Z_z dz + Z_a da + Z_w dw


def _solved(K: np.ndarray, right: np.ndarray, constraints: int) -> np.ndarray:
    found: np.ndarray = np.linalg.lstsq(K, right, rcond=None)[0] if constraints else np.linalg.solve(K, right)
    return found
