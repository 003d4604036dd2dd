"""System, Assembly -> checks at states, in numbers: what the routes share, free bodies, reactions, the emitted code."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from random import Random
from typing import Any

import numpy as np

from eomgen.codegen.rhs import RightHandSide
from eomgen.errors import DerivationError, ModelError
from eomgen.mechanics.balance.friction import frictions, push_sizes, rubbing_contacts
from eomgen.mechanics.bodies.contact_modes import CLOSED
from eomgen.mechanics.bodies.kinematics import spin_between
from eomgen.mechanics.constraints.closure import generic_state, on_unit_spheres
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.equilibrium import imbalance
from eomgen.mechanics.reactions.reactions import reactions_of
from eomgen.proof.check import Check, checked, unchecked
from eomgen.proof.free_bodies import demand_of
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import apply, matrix_of, transposed, vector_of
from eomgen.symbolic.numeric.dense import dense_solution, independent, scaled_condition, weighted, without_rounding
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, DIFFERENCE_AT_50, LEAST_CHANGE, REFINED_AT_50

SINGULAR = 1e13  # condition number from which a mass matrix counts as singular in double precision
REFINEMENTS = 40  # each adds the digits that the condition number leaves of 16
TRIES = 20


def eliminated_rows(system: System) -> Check:
    """W^T xi + s_t = 0 and dphi/dt = 0 whatever the independent speeds: what the dependent rates were solved from.

    Rows that follow from others do so where the ties hold, and are looked at there.
    """

    def check(state: State) -> str:
        rows = [row for row in system.ties.rows if row.status == "eliminated"]
        gaps = [(row, row.gap) for row in rows if row.gap is not None]
        rates = zip((row for row, _ in gaps), system.scope.time_derivative(tuple(x for _, x in gaps)), strict=True)
        size = 1 + sum(abs(x) for x in evaluate(system.scope.rates, state, fifty_digits()))
        for row, rate in (*((row, row.velocity) for row in rows), *rates):
            if abs(evaluate((rate,), state, fifty_digits())[0]) > DIFFERENCE_AT_50 * size:
                return f"row {row.number} of '{row.tie}' opens"
        return ""

    return _at_a_state(system, "eliminated rows hold whatever the speeds", "50 digits", check)


def real_state(system: System, rng: Random) -> State:
    """Random values of all symbols, at 50 digits; parameters and times positive."""
    arithmetic = fifty_digits()
    symbols = system.symbols

    def draw(low: int, high: int) -> Any:
        return arithmetic.number(1) * rng.randint(low * 10**12, high * 10**12) / 10**12

    state = {p: draw(1, 3) / 2 for p in symbols.parameters.values()}
    state |= {x: draw(-1, 1) for x in (*symbols.q, *symbols.u, *symbols.a, *symbols.lam, *symbols.inputs.values())}
    state[symbols.t] = draw(0, 1)
    return state | on_unit_spheres(system.scope.quaternions, state)


def closed_state(system: System, rng: Random) -> tuple[State, str]:
    """A random real state, and a remark; where ties close, one in which they do if one is near the start."""
    state = real_state(system, rng)
    if all(row.identical for row in system.ties.rows):
        return state, ""
    try:
        return state | generic_state(system.ties, rng), ""
    except (DerivationError, ModelError) as error:  # the equations still say what a is, if no row is redundant
        return state, f" ({error.what})"


def _at_a_state(system: System, name: str, how: str, check: Callable[[State], str]) -> Check:
    """A check at the first random real state where everything has a value; `check` names what differs."""
    rng = Random(7)
    for _ in range(TRIES):
        state, remark = closed_state(system, rng)
        try:
            wrong = check(state)
        except (NoValue, ZeroDivisionError):
            continue
        return checked(name, wrong and wrong + remark, how)
    return unchecked(name, f"no state with values was found in {TRIES} tries", how)


def twists(system: System) -> Check:
    """Twists against central differences of the poses along the motion."""

    def check(state: State) -> str:
        arithmetic = fifty_digits()
        h = arithmetic.number(1) / 10**15
        links = system.motion.links
        poses = tuple(x for link in links for x in (*(x for row in link.pose.R for x in row), *link.pose.p))
        late, early = (evaluate(poses, _moved(system, state, sign * h), arithmetic) for sign in (1, -1))
        all_rates = [(a - b) / (2 * h) for a, b in zip(late, early, strict=True)]
        now = evaluate(poses, state, arithmetic)
        motions = evaluate(tuple(x for link in links for x in (*link.twist.w, *link.twist.v)), state, arithmetic)
        for k, link in enumerate(links):
            rates, here, twist = all_rates[12 * k :], now[12 * k :], motions[6 * k : 6 * k + 6]
            R_now = matrix_of((here[0:3], here[3:6], here[6:9]))
            spin = spin_between(R_now, matrix_of((rates[0:3], rates[3:6], rates[6:9])))
            velocity = apply(transposed(R_now), vector_of(rates[9:12]))
            pairs = zip(twist, (*spin, *velocity), strict=True)
            if any(abs(a - b) > DIFFERENCE_AT_50 * (1 + abs(a)) for a, b in pairs):
                return f"the twist of '{link.name}' is not the rate of its pose"
        return ""

    return _at_a_state(system, "twists are the rates of the poses", "differences at 50 digits", check)


def _moved(system: System, state: State, h: Any) -> State:
    """The state h later, to first order."""
    arithmetic = fifty_digits()
    rates = evaluate(system.scope.rates, state, arithmetic)
    values = dict(state)
    for q, rate in zip(system.scope.symbols.q, rates, strict=True):
        values[q] = values[q] + h * rate
    values[system.scope.symbols.t] = values[system.scope.symbols.t] + h
    return values


def free_bodies(system: System, assembly: Assembly) -> Check:
    """M a + c - Q - J^T lam and J a + gamma at any a and lam, by the free bodies, which use no B and no energy."""
    symbols, friction = assembly.symbols, assembly.friction or (0,) * len(assembly.Q)
    inertia = [inner(row, symbols.a) - b + f for row, b, f in zip(assembly.M, assembly.forcing, friction, strict=True)]
    forces = [x - inner(column, symbols.lam) for x, column in zip(inertia, _columns(assembly), strict=True)]
    rows = [inner(row, symbols.a) + bias for row, bias in zip(assembly.J, assembly.gamma, strict=True)]

    def check(state: State) -> str:
        needed = demand_of(system, state)
        own = evaluate((*forces, *rows), state, fifty_digits())
        rates = [needed.rates[row.tie, row.number] for row in system.ties.closing]
        sizes = [*needed.sizes, *(1 + abs(x) for x in rates)]
        found = zip(own, (*needed.forces, *rates), sizes, strict=True)
        wrong = [i for i, (x, y, size) in enumerate(found) if abs(x - y) > DIFFERENCE_AT_50 * size]
        names = [
            *(f"M a + c - Q - J^T lam [{u.name}]" for u in symbols.u),
            *(f"J a + gamma of {x}" for x in symbols.lam),
        ]
        return f"{names[wrong[0]]} differs" if wrong else ""

    name = "the equations are those of the free bodies, at any accelerations and multipliers"
    return _at_a_state(system, name, "differences at 50 digits", check)


def _columns(assembly: Assembly) -> Iterable[Sequence[Scalar]]:
    """The columns of J, also where it has no rows."""
    return zip(*assembly.J, strict=True) if assembly.J else ((),) * len(assembly.M)


def friction(system: System, assembly: Assembly) -> Check:
    """Whatever rubs is braked: factor * v < 0 for a contact that pushes, v its sliding velocity.

    What holds on all sides rubs with F = factor sqrt(N_1^2 + N_2^2), N_1 and N_2 those of the balance of the bodies.
    """
    laws = _laws_of_round(system) if push_sizes(system) else []

    def check(state: State) -> str:
        for name, law in laws:
            if not _holds(law, assembly, state):
                return f"the friction of '{name}' is not that of its normal force"
        for name, factor, sliding in frictions(system):
            mode = system.modes.get(name, CLOSED)
            v = sliding if mode.sense is None else mode.sense
            (power,) = evaluate((mode.push * factor * v,), state, fifty_digits())
            if not power < 0:
                return f"friction drives '{name}' on"
        return ""

    return _at_a_state(system, "friction takes power from what slides", "50 digits", check)


def _laws_of_round(system: System) -> list[tuple[str, tuple[Scalar, ...]]]:
    """(contact, (F, factor, N_1, N_2)) of everything that rubs and holds on all sides."""
    reactions = reactions_of(system)
    rounds = [rub for rub in rubbing_contacts(system, reactions.components) if rub.normals]
    return [(r.name, (reactions.value(r.component), r.factor, *map(reactions.value, r.normals))) for r in rounds]


def _holds(law: tuple[Scalar, ...], assembly: Assembly, state: State) -> bool:
    """F = factor sqrt(N_1^2 + N_2^2) with the accelerations of the equations of motion."""
    digits = fifty_digits()
    a = exact_accelerations(assembly, state)
    values = evaluate(law, state | dict(zip(assembly.symbols.a, a, strict=True)), digits)
    F, factor, *N = map(float, values)
    return math.isclose(F, factor * math.hypot(*N), rel_tol=COMPUTED, abs_tol=COMPUTED)


def balance(system: System, assembly: Assembly) -> Iterable[Check]:
    """D'Alembert's principle for every body, every pair and the whole; none where reactions do not follow."""
    try:
        reactions = reactions_of(system)
    except DerivationError:
        return

    def check(state: State) -> str:
        a = exact_accelerations(assembly, state)
        return imbalance(reactions, state | dict(zip(assembly.symbols.a, a, strict=True)), Random(7))

    if reactions.components:
        yield _at_a_state(system, "every body is in balance with its reactions", "floating point", check)


def code(system: System, assembly: Assembly, rhs: RightHandSide) -> Check:
    """The emitted code returns the symbols' numbers."""

    def check(state: State) -> str:
        symbols = assembly.symbols
        x, p, inputs = (
            [float(state[s]) for s in group]
            for group in ((*symbols.q, *symbols.u), symbols.parameters.values(), symbols.inputs.values())
        )
        rates = [float(v) for v in evaluate(system.scope.rates, state, fifty_digits())]
        dx = rhs(float(state[symbols.t]), x, p, inputs)
        return _difference("dx", dx, np.concatenate([rates, accelerations_at(assembly, state)]), COMPUTED)

    return _at_a_state(system, f"the emitted code ({rhs.target}) returns the symbols' numbers", "floating point", check)


def accelerations_at(assembly: Assembly, state: State) -> np.ndarray:
    """a from M a = forcing + J^T lam, J a + gamma = 0 at a state, right to double precision whatever the condition.

    Raises:
        NoValue: some motion that the ties allow moves no mass at the state.
    """
    return np.array([float(x) for x in exact_accelerations(assembly, state)])


def exact_accelerations(assembly: Assembly, state: State) -> list[Any]:
    """The same with more than 20 digits: solved in doubles, what is left of the right side solved for again.

    Raises:
        NoValue: some motion that the ties allow moves no mass at the state.
    """
    n, k = len(assembly.M), len(assembly.J)
    if n == 0:
        return []
    entries = [x for row in (*assembly.M, *assembly.J) for x in row]
    values = evaluate((*entries, *assembly.forcing, *assembly.gamma), state, fifty_digits())
    wide = np.array(values[: n * (n + k)], dtype=object).reshape(n + k, n)
    M, J = wide[:n].astype(float), without_rounding(wide[n:].astype(float))
    if scaled_condition(weighted(M, J)) > SINGULAR:  # what no mass measures the ties may say
        raise NoValue("the mass matrix is singular")
    wide[n:] *= np.any(J, axis=1, keepdims=True)
    bordered = np.block([[M, -J.T], [J, np.zeros((k, k))]])
    regular = k == 0 or independent(J, smallest=LEAST_CHANGE)
    right = np.array([*values[n * (n + k) : len(values) - k], *(-y for y in values[len(values) - k :])], dtype=object)
    x = np.zeros(n + k, dtype=object)
    for _ in range(REFINEMENTS):
        size = max(map(abs, right))
        if size == 0:
            return list(x[:n])
        left = (right / size).astype(float)
        step = dense_solution(bordered, left, regular=regular, smallest=LEAST_CHANGE).astype(object) * size
        x = x + step
        right = right - np.concatenate([wide[:n] @ step[:n] - wide[n:].T @ step[n:], wide[n:] @ step[:n]])
        if max(map(abs, step[:n])) <= REFINED_AT_50 * max(map(abs, x[:n])):
            return list(x[:n])
    raise NoValue("the accelerations are not determined to 20 digits")


def _difference(name: str, a: Any, b: Any, tolerance: float) -> str:
    """Which entry of two vectors differs, or ""."""
    scale = 1 + max((abs(x) for x in b), default=0)
    wrong = [i for i, (x, y) in enumerate(zip(a, b, strict=True)) if not abs(x - y) <= tolerance * scale]
    return f"{name}[{wrong[0]}] is {a[wrong[0]]:.15g} against {b[wrong[0]]:.15g}" if wrong else ""
