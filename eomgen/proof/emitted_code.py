"""Emitted code, states -> checks: what is computed is put back into the equations that it was made from.

    q' = N u + nu,    M a - J^T lam = forcing,    J a = -gamma

The coefficients are the symbols' with 50 digits; a is the code's, lam by least squares. So nothing is shared with the
code but the equations: neither the elimination, nor the order of its statements, nor its language or compiler.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace

import numpy as np

from eomgen.mechanics.constraints.closure import closed, movable, speeds_closed
from eomgen.mechanics.constraints.closure import of_50_digits as precise
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.formulations.lagrange import free_rates
from eomgen.proof.check import Check, checked, unchecked
from eomgen.proof.free_bodies import moved_otherwise
from eomgen.proof.in_numbers import instant_of, with_inputs
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.dense import of_one_length
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits, floats_of
from eomgen.symbolic.numeric.tolerances import CARRIED, COMPUTED, LARGEST_SQUARED, SOLVED

WORK = 60_000  # graph nodes evaluated with 50 digits in one check, some 0.2 s; one state always
FAR = 1e-2  # of the least of the singular values of scaled rows, from which doubles solve them to COMPUTED
PUT = 2  # states at which accelerations are put to the free bodies: those take as long as the equations' whole proof
HOW = "equations with 50 digits, the code's accelerations put in"


Code = Callable[["TriedState"], np.ndarray]


@dataclass(frozen=True)
class TriedState:
    """A state at which code is tried.

    Args:
        t, x, p: time, (q, u), parameters.
        inputs: those that are given in place of the model's own, by name.
        a: accelerations, where these are given.
    """

    t: float
    x: np.ndarray
    p: Sequence[float] | np.ndarray
    inputs: Mapping[str, float] = field(default_factory=dict)
    a: np.ndarray = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class PhaseMotion:
    """The equations of one phase."""

    equations: EquationsOfMotion

    def values(self, at: TriedState) -> State:
        """Every symbol but a and lam at a state, with 50 digits; the inputs as the model says, or as they are given."""
        symbols = self.equations.symbols
        nodes = (*symbols.q, *symbols.u, *symbols.parameters.values())
        found = {node: precise(float(value)) for node, value in zip(nodes, (*at.x, *at.p), strict=True)}
        found[symbols.t] = instant_of(self.equations.system, float(at.t))
        given = {symbols.inputs[name]: precise(float(x)) for name, x in at.inputs.items()}
        return with_inputs(self.equations.system, found | given)

    @property
    def scalars(self) -> tuple[Scalar, ...]:
        """What stands in the equations: rates, M, J, forcing, gamma, row after row."""
        equations = self.equations
        matrices = (x for row in (*equations.M, *equations.J) for x in row)
        return (*self.equations.system.scope.rates, *matrices, *equations.forcing, *equations.gamma)

    def torn(self, code: Code, at: TriedState) -> str | None:
        """What the code's accelerations leave of the free bodies that all ties hold at once; "" where nothing.

        None at a state in which the ties do not hold, and where no tie closes. Where the code's numbers hang on the
        last digits of the state, this is held against it only if the rows themselves are far from singular.
        """
        equations, symbols = self.equations, self.equations.symbols
        system = equations.system
        if not (system.free or system).ties.closing:
            return None
        given = self.values(at)
        found = _held(system, given)
        if found is None or any(
            abs(found[x] - given[x]) > CARRIED * (1 + abs(given[x])) for x in (*symbols.q, *symbols.u)
        ):
            return None
        state = replace(at, x=np.array(floats_of(found[x] for x in (*symbols.q, *symbols.u))))
        a = code(state)[len(symbols.q) :]
        if not np.all(np.isfinite(a)):
            return None
        moving = found | dict(zip(symbols.a, map(precise, a.tolist()), strict=True))
        friction = evaluate(equations.friction, moving, fifty_digits())
        wrong = moved_otherwise(system, moving, friction)
        return wrong if not wrong or _sure(code, state) else moved_otherwise(system, moving, friction, regular=FAR)

    def numbers(self, at: TriedState) -> RunNumbers:
        """The coefficients at a state.

        Raises:
            NoValue: some have none there.
        """
        found = np.array(floats_of(evaluate(self.scalars, self.values(at), fifty_digits())))
        n, k = len(self.equations.M), len(self.equations.J)
        rates, M, J, forcing, gamma = np.split(found, np.cumsum([len(self.equations.N), n * n, k * n, n]))
        return RunNumbers(rates, M.reshape(n, n), J.reshape(k, n), forcing, gamma)


@dataclass(frozen=True)
class RunNumbers:
    """The coefficients of the equations at one state."""

    rates: np.ndarray
    M: np.ndarray
    J: np.ndarray
    forcing: np.ndarray
    gamma: np.ndarray

    def left(self, dx: np.ndarray) -> tuple[float, str]:
        """(what dx leaves of the equations, against the largest of their terms; in which); nan where it is none.

        Raises:
            NoValue: a coefficient, or its square, is beyond doubles.
        """
        if not all(np.all(np.abs(x) < LARGEST_SQUARED) for x in (self.rates, self.M, self.J, self.forcing, self.gamma)):
            raise NoValue("a coefficient of the equations is beyond doubles")
        rates, a = np.split(np.asarray(dx, dtype=float), [len(self.rates)])
        sizes = 1 + np.max(np.abs(self.rates), initial=0.0)
        parts = {"q' = N u + nu": np.max(np.abs(rates - self.rates), initial=0.0) / sizes}
        parts["M a = forcing + J^T lam"] = self.left_of_forces(a)
        rows = np.abs(self.J @ a + self.gamma)
        terms = 1 + np.abs(self.J) @ np.abs(a) + np.abs(self.gamma)
        parts["J a + gamma = 0"] = float(np.max(rows / terms, initial=0.0))
        self.refuse_contradiction()
        worst = max(parts, key=lambda name: np.inf if np.isnan(parts[name]) else parts[name])
        return float(parts[worst]), worst

    def refuse_contradiction(self) -> None:
        """Redundant rows contradict one another where the ties are open.

        Raises:
            NoValue: no a fulfils J a + gamma = 0.
        """
        if not len(self.J):
            return
        sizes = np.linalg.norm(self.J, axis=1)
        J = of_one_length(self.J)
        gamma = self.gamma / np.where(sizes > 0, sizes, 1.0)
        least = J @ np.linalg.lstsq(J, -gamma, rcond=COMPUTED)[0] + gamma
        if np.max(np.abs(least)) > COMPUTED * (1 + np.max(np.abs(gamma))):
            raise NoValue("the ties contradict one another")

    def left_of_forces(self, a: np.ndarray, acting: np.ndarray | float = 0.0) -> float:
        """Of M a - J^T lam = forcing + acting, rows weighted by 1/sqrt(M_kk), with the lam that leaves least.

        A term counts as no smaller than that of an acceleration of 1 m/s^2 or rad/s^2; nan where a has no value.

        Raises:
            NoValue: the terms are beyond doubles.
        """
        weights = np.diag(self.M)
        weights = 1 / np.sqrt(np.where(weights > 0, weights, np.max(weights, initial=0.0) or 1.0))
        needed = weights * (self.M @ a - self.forcing - acting)
        terms = weights * (np.abs(self.M) @ (1 + np.abs(a)) + np.abs(self.forcing) + np.abs(acting))
        if not np.all(np.isfinite(a)):
            return float("nan")
        if len(self.J):
            J = of_one_length(self.J * weights)
            lam = np.linalg.lstsq(J.T, needed, rcond=COMPUTED)[0]
            needed, terms = needed - J.T @ lam, terms + np.abs(J.T) @ np.abs(lam)
        left = float(np.max(np.abs(needed), initial=0.0) / max(np.max(terms, initial=0.0), np.finfo(float).tiny))
        if np.isnan(left):
            raise NoValue("the terms of the equations are beyond doubles")
        return left


def _held(system: System, given: State) -> State | None:
    """The nearest state at which all ties hold, positions and speeds; None where none is near."""
    found = closed(system.ties, given, movable(system.ties))
    if found is None or system.free is None or system.declared:
        return None if found is None else speeds_closed(system.ties, found)
    free = system.free
    rates = evaluate(free_rates(system, free), found, fifty_digits())
    return speeds_closed(free.ties, found | dict(zip(free.scope.symbols.u, rates, strict=True)))


def equations_hold(motion: PhaseMotion, code: Code, at: Iterable[TriedState], name: str) -> Check:
    """The code's accelerations fulfil the equations at states; one next to a singular position says nothing.

    Where the ties hold they are put to the free bodies too, which choose no rows: at the first PUT states.
    """
    put: list[str] = []

    def torn(instant: TriedState) -> str:
        with suppress(NoValue, ZeroDivisionError):
            found = motion.torn(code, instant) if len(put) < PUT else None
            put.extend([] if found is None else [found])
            return f"{found} at t = {instant.t:.6g} s" if found else ""
        return ""

    def wrong(instant: TriedState) -> str | None:
        numbers = motion.numbers(instant)
        left, where = numbers.left(code(instant))
        if left <= COMPUTED or not _sure(code, instant):
            return torn(instant) or ("" if left <= COMPUTED else None)
        return f"{where} is left with {left:.1e} of its terms at t = {instant.t:.6g} s"

    return at_states(name, HOW, at, wrong, cost=len(order(motion.scalars)))


def _sure(code: Code, instant: TriedState) -> bool:
    """Whether the code's numbers hardly change where the state does by a part in 1e12, or are nowhere there."""
    here, *beside = (code(each) for each in (instant, *_beside(instant)))
    if not np.all(np.isfinite(here)):
        return not any(np.all(np.isfinite(each)) for each in beside)
    change = max(float(np.max(np.abs(each - here), initial=0.0)) for each in beside)
    return bool(change <= COMPUTED * (1 + np.max(np.abs(here), initial=0.0)))


def _beside(instant: TriedState) -> tuple[TriedState, ...]:
    """The state, each of its numbers a part in 1e12 larger or smaller by turns."""
    turns = np.where(np.arange(len(instant.x)) % 2, -SOLVED, SOLVED)
    return tuple(replace(instant, x=instant.x * (1 + sign * turns)) for sign in (1, -1))


def values_agree(
    name: str,
    motion: PhaseMotion,
    scalars: Mapping[str, Scalar],
    code: Code,
    at: Iterable[TriedState],
    further: Callable[[TriedState], Mapping[Node, float]] = lambda _: {},
) -> Check:
    """Code against the symbols with 50 digits, entry by entry, relative to the largest.

    Args:
        scalars: what it computes, by name, in the order of its results.
        further: values of symbols that the states do not have: accelerations.
    """

    def wrong(instant: TriedState) -> str | None:
        known = motion.values(instant) | {node: precise(float(x)) for node, x in further(instant).items()}
        right = np.array([float(x) for x in evaluate(tuple(scalars.values()), known, fifty_digits())])
        found = np.asarray(code(instant), dtype=float)
        apart = np.abs(found - right) / (1 + np.max(np.abs(right), initial=0.0))
        if np.all(apart <= COMPUTED):
            return ""
        if not _sure(code, instant):
            return None
        k = int(np.argmax(np.where(np.isnan(apart), np.inf, apart)))
        return f"{list(scalars)[k]} is {found[k]:.12g} for {right[k]:.12g} at t = {instant.t:.6g} s"

    return at_states(name, "symbols with 50 digits", at, wrong, cost=len(order(tuple(scalars.values()))))


def at_states(
    name: str, how: str, at: Iterable[TriedState], wrong: Callable[[TriedState], str | None], *, cost: int
) -> Check:
    """A check at states, as many as the work allows.

    Args:
        wrong: what is wrong at a state, or ""; None where the state says nothing.
        cost: graph nodes that one state takes.
    """
    count, work = 0, 0
    for instant in at:
        if work and work + cost > WORK:
            break
        work += cost
        try:
            found = wrong(instant)
        except (NoValue, ZeroDivisionError):
            continue
        if found:
            return checked(name, found, how)
        count += found is not None
    if not count:
        return unchecked(name, "at none of the states have the equations sure values", how)
    return Check(name, "holds", how, f"at {count} state{'s' * (count > 1)}")
