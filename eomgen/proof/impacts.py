"""The equations of an impact -> checks, at random exact states, by the momenta of the bodies and by their energies.

sum_b m dv . dv/du_k + I dw . dw/du_k = sum of the impulses' wrenches . d(twists)/du_k
v+ = - e v- of what closes, 0 of what holds;   T- - T+ is the loss
the same jump by the law in numbers (complementarity) where it pushes
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, partial
from itertools import pairwise, product
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.impacts import ImpactEquations
from eomgen.mechanics.kinematics import SystemInertia
from eomgen.model import PointForce
from eomgen.proof.check import Check, Tally
from eomgen.proof.declared_loads import fluids_carried
from eomgen.proof.states import real_state
from eomgen.symbolic.expression import Node, Scalar, State, Vector, jacobian, substituted, symbols_of
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

SEEDS = (5, 6, 7)


def impact_checks(found: ImpactEquations) -> Iterator[Check]:
    """Check impulses, speeds and loss of an impact."""
    momenta = Tally("impulses change the momenta of the bodies to those of the speeds after it", "momenta, 50 digits")
    speeds = Tally("what closes leaves with e times its approach, what holds is at rest", "velocities, 50 digits")
    energies = Tally("the loss is the kinetic energy before less that after", "energies by the poses, 50 digits")
    numbers = Tally("the law of impact in numbers gives the same jump", "complementarity in doubles")
    bodies = Tally("each body moves by the impulses on it", "momenta, 50 digits")
    for seed in SEEDS:
        state = real_state(found.system, Random(seed))
        after = _solved(found, state)
        momenta.add(f"state {seed}", partial(_unbalanced, found, state, after))
        speeds.add(f"state {seed}", partial(_leaves_otherwise, found, state, after))
        energies.add(f"state {seed}", partial(_lost_otherwise, found, state, after))
        numbers.add(f"state {seed}", partial(_jumps_otherwise, found, state))
        for body in found.of_joints:
            bodies.add(f"{body}, state {seed}", partial(_body_unbalanced, found, body, state, after))
    cases = Tally("each case of friction is that of Routh's graph within its bounds", "the graph in doubles, momenta")
    states = _states_of_cases(found) if found.others else {}
    for each in (found, *found.others) if found.others else ():
        name = SLIDES_ON if each.course is None else each.course.name
        if name in states:
            cases.add(name, partial(_graph_otherwise, found, each, states[name]))
    for tally in (momenta, speeds, energies, numbers, bodies, cases):
        yield from tally.checks()


def _solved(found: ImpactEquations, state: State) -> dict[Node, Any]:
    """The speeds after it and the impulses at a state."""
    unknowns = tuple(found.solution)
    return dict(zip(unknowns, evaluate(tuple(found.solution.values()), state, fifty_digits()), strict=True))


def _later(found: ImpactEquations, after: Mapping[Node, Any]) -> dict[Node, Any]:
    """The speeds of the state after it."""
    return {u: after[x] for u, x in zip(found.u, found.after, strict=True)}


def _unbalanced(found: ImpactEquations, state: State, after: Mapping[Node, Any]) -> str:
    """Message that names a speed along which momentum and impulses differ; "".

    P_k = sum_b m v . dv/du_k + I w . dw/du_k + armature s' ds'/du_k
    """
    motion, u = found.system.motion, found.u
    moved: list[Scalar] = []
    momenta: list[Scalar] = []
    for link in motion.links:
        mass = found.system.scope.mass_properties(link.name)
        v = motion.velocity((link.name, mass.com))
        moved += [*v, *link.twist.w]
        momenta += [*(mass.m * x for x in v), *(mass.I @ link.twist.w)]
    inertia = SystemInertia(motion)
    for link, k, armature in inertia.rotors:
        moved.append(link.s_rate[k])
        momenta.append(armature * link.s_rate[k])
    moved += found.system.scope.rates
    momenta += inertia.given_momenta
    slopes = _numbers(tuple(x for row in jacobian(tuple(moved), u) for x in row), state)
    before, later = (_numbers(tuple(momenta), {**state, **more}) for more in ({}, _later(found, after)))
    pushed = _pushed(found, state, after)
    for k, node in enumerate(u):
        change = sum((b - a) * slopes[m * len(u) + k] for m, (a, b) in enumerate(zip(before, later, strict=True)))
        if abs(change - pushed[k]) > tolerances.ZERO_AT_50 * (1 + abs(change)):
            given = f"the impulses give {float(pushed[k]):.10g}"
            return f"along {node.name} the momentum changes by {float(change):.10g}, {given}"
    return ""


def _body_unbalanced(found: ImpactEquations, body: str, state: State, after: Mapping[Node, Any]) -> str:
    """Message if m (v+ - v-) of a body's mass centre is not the sum of the impulses on it; "".

    Raises:
        NoValue: a joint of it has no impulse here, or a row acts on coordinates.
    """
    motion, names = found.system.motion, [link.name for link in found.system.motion.links]
    carried = [link.name for link in motion.links if link.parent == names.index(body)]
    known = {(row.row.constraint, row.row.number) for row in found.rows}
    rows = [row for row in found.system.constraints.rows if (row.constraint, row.number) not in known]
    further = {name for row in rows for name, _ in row.wrenches}
    if (
        body in further
        or any(name not in found.of_joints for name in carried)
        or any(not row.row.wrenches for row in found.rows)
    ):
        raise NoValue("not all impulses on it are known")
    mass = found.system.scope.mass_properties(body)
    v = motion.velocity((body, mass.com))
    before, later = (_numbers((mass.m, *v), {**state, **x}) for x in ({}, _later(found, after)))
    total = [0, *_numbers(found.of_joints[body], state)]
    for name in carried:
        total = [0, *(a - b for a, b in zip(total[1:], _numbers(found.of_joints[name], state), strict=True))]
    for row in found.rows:
        for name, wrench in row.row.wrenches:
            if name == body:
                force = _numbers(motion.link(body).pose.R @ wrench.f, state)
                total = [0, *(a + after[row.impulse] * b for a, b in zip(total[1:], force, strict=True))]
    fluids = (fluid.p for fluid in fluids_carried(found.system).values() if fluid.body == body)
    P: Vector = sum(fluids, start=Vector.ZERO)
    own = [0, *(b - a for a, b in zip(*(_numbers(P, {**state, **x}) for x in ({}, _later(found, after))), strict=True))]
    for axis in (1, 2, 3):
        change = before[0] * (later[axis] - before[axis]) + own[axis]
        if abs(change - total[axis]) > tolerances.ZERO_AT_50 * (1 + abs(change)):
            return f"its momentum changes by {float(change):.10g}, the impulses give {float(total[axis]):.10g}"
    return ""


def _pushed(found: ImpactEquations, state: State, after: Mapping[Node, Any]) -> list[Any]:
    """Generalized impulses: of each row by its wrenches on the bodies, of a row of coordinates by its own slopes."""
    u, motion = found.u, found.system.motion
    total: list[Any] = [0] * len(u)
    for row in found.rows:
        along: list[Any] = [0] * len(u)
        factor = None if row.rubs is None else _numbers((row.rubs.factor,), state)[0]
        pushes = [] if factor is None else [motion.body_wrench(push) for push in row.row.tangent]
        rubbing = [(*each, factor) for each in pushes if each is not None]
        for body, wrench, share in (*((*each, 1) for each in row.row.wrenches), *rubbing):
            twist = motion.link(body).twist
            slopes = _numbers(tuple(x for r in jacobian((*twist.w, *twist.v), u) for x in r), state)
            W = _numbers((*wrench.tau, *wrench.f), state)
            works = (sum(W[m] * slopes[m * len(u) + k] for m in range(6)) for k in range(len(u)))
            along = [a + share * work for a, work in zip(along, works, strict=True)]
        if not row.row.wrenches:
            along = _numbers(row.J, state)
        total = [a + after[row.impulse] * b for a, b in zip(total, along, strict=True)]
    return total


def _numbers(scalars: tuple[Scalar, ...], state: State) -> list[Any]:
    return list(evaluate(scalars, state, fifty_digits()))


def _leaves_otherwise(found: ImpactEquations, state: State, after: Mapping[Node, Any]) -> str:
    """Message that names a row which leaves with another velocity than its law says; "".

    The velocities are those of the rows themselves, not J u + sigma; of what closes the growth of its gap.
    """
    model = found.system.scope.model
    for row in found.rows:
        squares = model.constraints[row.row.constraint].by_squares if row.row.constraint in model.constraints else True
        if row.e is not None and row.row.gap is not None and not squares:
            grows = found.system.scope.time_derivative((row.row.gap,))[0]
            v, rate = _numbers((row.row.velocity, grows), state)
            if abs(v - rate) > tolerances.ZERO_AT_50 * (1 + abs(rate)):
                return f"its impulse acts along {float(v):.10g}, its gap grows by {float(rate):.10g}"
        before, later = (_numbers((row.row.velocity,), {**state, **x})[0] for x in ({}, _later(found, after)))
        due = 0 if row.e is None else -_numbers((row.e,), state)[0] * before
        if abs(later - due) > tolerances.ZERO_AT_50 * (1 + abs(before)):
            return f"'{row.name}' leaves with {float(later):.10g}, its law says {float(due):.10g}"
    return ""


def _lost_otherwise(found: ImpactEquations, state: State, after: Mapping[Node, Any]) -> str:
    T = SystemInertia(found.system.motion).kinetic_energy
    before, later = (_numbers((T,), {**state, **x})[0] for x in ({}, _later(found, after)))
    (loss,) = _numbers((found.loss,), state)
    wrong = abs(before - later - loss) > tolerances.ZERO_AT_50 * (1 + abs(before))
    return f"{float(before - later):.10g} J are lost, the formula says {float(loss):.10g} J" if wrong else ""


def _jumps_otherwise(found: ImpactEquations, state: State) -> str:
    """Message if the law in numbers gives other speeds.

    Raises:
        NoValue: at this state an impulse would pull, or something is not approached: the law says another thing.
    """
    n = len(found.u)
    rubbing = list(found.rubbing.values())
    rows = [[*row.J, row.sigma] for row in found.rows] + [[*own.J, own.sigma] for own in rubbing]
    values = _numbers((*(x for row in found.M for x in row), *(x for row in rows for x in row)), state)
    M = np.array([float(x) for x in values[: n * n]]).reshape(n, n)
    at = np.array([float(x) for x in values[n * n :]]).reshape(-1, n + 1)
    held = at[[k for k, row in enumerate(found.rows) if row.e is None]]
    closes = [row for row in found.rows if row.e is not None]
    e = [None if row.e is None else float(_numbers((row.e,), state)[0]) for row in found.rows]
    rub = None if not rubbing else (abs(float(_numbers((rubbing[0].mu,), state)[0])), at[len(found.rows) :])
    drawn = np.array([float(state[x]) for x in found.u])
    for u in (drawn, -drawn):
        if len(held):
            u = u - np.linalg.lstsq(held[:, :-1], held[:, :-1] @ u + held[:, -1], rcond=None)[0]
        moved = {**state, **dict(zip(found.u, map(fifty_digits().number, u.tolist()), strict=True))}
        there = _solved(found, moved)
        if any(there[row.impulse] < 0 for row in closes):
            continue
        due = np.array([float(there[x]) for x in found.after])
        if rub is not None and any(float(t[:-1] @ u + t[-1]) * float(t[:-1] @ due + t[-1]) <= 0 for t in rub[1][:1]):
            continue
        jumped = found.jumped(M, at[: len(found.rows)], u, e=e, rub=rub)
        if jumped is None:
            continue
        wrong = np.max(np.abs(jumped - due)) > tolerances.CARRIED * (1 + np.max(np.abs(due)))
        return f"the law in numbers gives {jumped}, the formulas {due}" if wrong else ""
    raise NoValue("nothing is approached, an impulse would pull, or sliding stops")


# -------- cases of a contact that rubs ------------------------------------------------------------------------
# D, v of a contact in the plane -> the corner of Routh's graph and its end, found by halving

LEAST_DRAWN, DRAWN = 4, 30  # places at which cases are looked for
SLIPS = (-3.0, -2.0, -1.2, -0.7, -0.4, -0.2, 0.1, 0.3, 0.6, 1.0, 1.5, 2.5)  # v_t for v_n = -1
LESS_ROUGH = 5  # times less friction, at every other of these states
SLIDES_ON = "slides on"
FARTHEST, HALVINGS = 1e6, 200


@dataclass(frozen=True)
class RouthGraph:
    """v_n and v_t by the normal impulse p: friction F up to the corner p_s, then G, the nearest allowed to sticking.

    Args:
        D: changes of (v_n, v_t) for unit impulses, 2 x 2.
        v: (v_n, v_t) before it.
    """

    D: np.ndarray
    v: np.ndarray
    mu: float

    @cached_property
    def frictions(self) -> tuple[float, float]:
        still = -float(self.D[1, 0] / self.D[1, 1])
        return -self.mu * float(np.sign(self.v[1])), max(-self.mu, min(self.mu, still))

    @cached_property
    def corner(self) -> float:
        slows = float(self.D[1] @ [1.0, self.frictions[0]])
        return float(-self.v[1] / slows) if self.v[1] * slows < 0 else 0.0 if self.v[1] == 0 else math.inf

    def impulses(self, p: float) -> np.ndarray:
        F, G = self.frictions
        return np.array([p, F * min(p, self.corner) + (G * (p - self.corner) if p > self.corner else 0.0)])

    def speeds(self, p: float) -> np.ndarray:
        return np.asarray(self.v + self.D @ self.impulses(p))

    def work(self, p: float) -> float:
        """Integral of v_n dp, by the trapezes of its corners."""
        ends = [0.0, min(p, self.corner), p]
        v = [float(self.speeds(x)[0]) for x in ends]
        return sum((b - a) * (x + y) / 2 for a, b, x, y in zip(ends, ends[1:], v, v[1:], strict=False))

    def end(self, e: float, law: str) -> tuple[float, float]:
        """(p at the end of compression, at that of the restitution).

        Raises:
            NoValue: one does not come.
        """
        pressed = _first(lambda p: float(self.speeds(p)[0]), 0.0)
        if law == "poisson":
            return pressed, (1 + e) * pressed
        least = (1 - e * e) * self.work(pressed)
        reached = {"newton": lambda p: self.speeds(p)[0] + e * self.v[0], "energetic": lambda p: self.work(p) - least}
        return pressed, _first(reached[law], pressed)

    def name(self, e: float, law: str) -> str:
        """The course: slides on, or what it does from which phase on."""
        pressed, end = self.end(e, law)
        if end <= self.corner:
            return SLIDES_ON
        does = "sticks" if abs(self.frictions[1]) < self.mu else "slides back"
        return f"{does} from the {'compression' if self.corner < pressed else 'restitution'} on"


def _first(signed: Callable[[float], float], low: float) -> float:
    """First place where what is negative at first becomes 0, by halving.

    Raises:
        NoValue: it does not.
    """
    high = max(2 * low, 1.0)
    while signed(high) < 0:
        high *= 2
        if high > FARTHEST:
            raise NoValue("no impulse ends it")
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if middle in (low, high):
            break
        low, high = (middle, high) if signed(middle) < 0 else (low, middle)
    return high


def _states_of_cases(found: ImpactEquations) -> dict[str, list[tuple[State, RouthGraph, float]]]:
    """{course: (a state in which the graph takes it, that graph, e), some of them}, for those that come up.

    Args:
        found: as long as it slides on; where D_nt = 0 both phases in which it sticks are one course.
    """
    known: dict[str, list[tuple[State, RouthGraph, float]]] = {}
    wanted = {each.name for each in found.cases.courses}
    for seed in range(DRAWN):
        if wanted <= set(known) and seed >= LEAST_DRAWN:
            break
        for name, drawn in _drawn_cases(found, seed):
            name = name if name in wanted else name.partition(" from ")[0]
            if name in wanted:
                known.setdefault(name, []).append(drawn)
    return known


def _drawn_cases(found: ImpactEquations, seed: int) -> Iterator[tuple[str, tuple[State, RouthGraph, float]]]:
    """(course, (state, graph, e)) of one random place with several speeds (v_n, v_t) = (-1, v_t)."""
    state, first, n = real_state(found.system, Random(seed)), found.rows[0], len(found.u)
    rubs = found.rubbing[first.name]
    for symbol in symbols_of((rubs.mu,)) if seed % 2 else ():
        state = {**state, symbol: state[symbol] / LESS_ROUGH}
    mu, e = (abs(float(x)) for x in _numbers((rubs.mu, 0 if first.e is None else first.e), state))
    M, rows = _by_steps(
        found, (first.row.velocity, first.row.sliding, *(x.row.velocity for x in found.rows[1:])), state
    )
    J, u = rows[:, :-1], np.array([float(state[x]) for x in found.u])
    k = len(J) - 2
    whole = np.block([[M, -J[2:].T], [J[2:], np.zeros((k, k))]])
    columns = np.linalg.solve(whole, np.vstack([J[:2].T, np.zeros((k, 2))]))[:n]
    u = u + np.linalg.solve(whole, np.concatenate([np.zeros(n), -(J[2:] @ u + rows[2:, -1])]))[:n]
    D, v = J[:2] @ columns, J[:2] @ u + rows[:2, -1]
    for slip in SLIPS:
        wanted = np.array([-1.0, slip])
        speeds = u + columns @ np.linalg.solve(D, wanted - v)
        graph = RouthGraph((D + D.T) / 2, wanted, mu)
        with suppress(NoValue):
            moved = dict(zip(found.u, map(fifty_digits().number, speeds.tolist()), strict=True))
            yield graph.name(e, found.law), ({**state, **moved}, graph, e)


def _by_steps(found: ImpactEquations, velocities: tuple[Scalar, ...], state: State) -> tuple[np.ndarray, np.ndarray]:
    """(M by differences of T, rows (J, sigma) of velocities) at a state, in doubles: of speeds one larger."""
    u, n, scalars = found.u, len(found.u), (found.kinetic_energy, *velocities)

    def at(*faster: int) -> np.ndarray:
        moved = {u[i]: state[u[i]] + faster.count(i) for i in faster}
        return np.array([float(x) for x in _numbers(scalars, {**state, **moved})])

    here, by_one = at(), [at(i) for i in range(n)]
    M = np.array([[at(i, j)[0] - by_one[i][0] - by_one[j][0] + here[0] for j in range(n)] for i in range(n)])
    J = np.array([x[1:] - here[1:] for x in by_one]).T
    return M, np.hstack([J, (here[1:] - J @ [float(state[x]) for x in u])[:, None]])


def _graph_otherwise(found: ImpactEquations, each: ImpactEquations, at: list[tuple[State, RouthGraph, float]]) -> str:
    """Message if the formulas of a case are not those of the graph, its bounds not its own, or its loss another; ""."""
    (state, graph, e), *_ = at
    after = _solved(each, state)
    velocities = (found.rows[0].row.velocity, found.rows[0].row.sliding)
    later = [float(x) for x in _numbers(velocities, {**state, **_later(each, after)})]
    due = graph.speeds(graph.end(e, found.law)[1])
    if np.max(np.abs(later - due)) > tolerances.CARRIED * (1 + np.max(np.abs(due))):
        return f"(v_n, v_t) after it are {later}, by the graph {due.tolist()}"
    for course, (there, *_) in product(found.cases.courses, at):
        sides = _numbers(tuple(found.cases.written_out(x) for pair in course.bounds for x in pair), there)
        within = all(a <= b for a, b in zip(sides[::2], sides[1::2], strict=True))
        if within is not (course.name == (SLIDES_ON if each.course is None else each.course.name)):
            return f"the bounds of '{course.name}' {'hold' if within else 'fail'} there"
    return _unbalanced(each, state, after) or _lost_otherwise(each, state, after)


# -------- verdicts --------------------------------------------------------------------------------------------


def sides_differ(found: ImpactEquations, difference: Scalar) -> bool:
    """True if an equation of an impact does not hold with its impulses and speeds by differences.

    [[M, -J^T], [J, 0]] [u+ - u; Lam] = [0; -(1 + e) v], M and J by differences of T and of velocities.

    Args:
        difference: left minus right, over impulses and speeds before and after it.
    """
    unknowns = (*found.after, *(row.impulse for row in found.rows))
    (difference,) = substituted((difference,), found.along)
    for state, values in _solved_by_differences(found):
        solved = dict(zip(unknowns, values, strict=True))
        (terms,) = jacobian((difference,), unknowns)
        value, *slopes = _numbers((difference, *terms), {**state, **solved})
        size = 1 + sum(abs(slope * solved[x]) for slope, x in zip(slopes, unknowns, strict=True))
        if abs(value) > tolerances.CARRIED * size:
            return True
    return False


def _solved_by_differences(found: ImpactEquations) -> Iterator[tuple[State, list[Any]]]:
    """(state, speeds after it and impulses there), several; of a course of friction one within its bounds.

    Raises:
        NoValue: no such state comes up.
    """
    if found.slides is None or found.course is None:
        for seed in SEEDS:
            state = real_state(found.system, Random(seed))
            yield state, _by_differences(found, state)
        return
    known = _states_of_cases(found.slides)
    if found.course.name not in known:
        raise NoValue(f"no state was found in which it {found.course.name}")
    (state, graph, e), *_ = known[found.course.name]
    M, rows = _by_steps(found, tuple(row.row.velocity for row in found.rows), state)
    J, n, k = rows[:, :-1], len(found.u), len(rows) - 2
    own = graph.impulses(graph.end(e, found.law)[1])
    whole = np.block([[M, -J[2:].T], [J[2:], np.zeros((k, k))]])
    held = J[2:] @ [float(state[x]) for x in found.u] + rows[2:, -1]
    change = np.linalg.solve(whole, np.concatenate([J[:2].T @ own, -held]))
    values = [*(change[:n] + [float(state[x]) for x in found.u]), *own, *change[n:]]
    yield state, [fifty_digits().number(float(x)) for x in values]


def _by_differences(found: ImpactEquations, state: State) -> list[Any]:
    """(speeds after it, impulses) at a state, in doubles."""
    n, k, u = len(found.u), len(found.rows), found.u
    velocities = tuple(row.row.velocity for row in found.rows)
    sliding = tuple(0 if row.rubs is None else row.row.sliding for row in found.rows)
    factors = np.array(
        [0.0 if row.rubs is None else float(_numbers((row.rubs.factor,), state)[0]) for row in found.rows]
    )
    M, rows = _by_steps(found, (*velocities, *sliding), state)
    J, here = rows[:k, :-1], rows[:, :-1] @ [float(state[x]) for x in u] + rows[:, -1]
    whole = np.block([[M, -(J + factors[:, None] * rows[k:, :-1]).T], [J, np.zeros((k, k))]])
    right = np.zeros(n + k)
    e = [0.0 if row.e is None else float(_numbers((row.e,), state)[0]) for row in found.rows]
    right[n:] = -(1 + np.array(e)) * here[:k]
    values = np.linalg.solve(whole, right)
    values[:n] += [float(state[x]) for x in u]
    return [fifty_digits().number(float(x)) for x in values]


# -------- second way of the outputs ---------------------------------------------------------------------------
# Impulses by differences: M from T of the bodies' particles, J from the rates of gaps, at speeds one larger.


@dataclass(frozen=True)
class Struck:
    """The impact of one contact at a trial state.

    M_kl = T(u + e_k + e_l) - T(u + e_k) - T(u + e_l) + T(u), T = sum m v^2/2 of particles; J_k the growth of a gap's
    rate with u_k; [[M, -J^T], [J, 0]] [u+ - u; Lam] = [0; -(1 + e) v].
    """

    trial: Any
    system: System
    contact: str

    @property
    def rows(self) -> list[Row]:
        """The contact's row, and those of the constraints.

        Raises:
            NoValue: other contacts touch, or a row has no gap.
        """
        modes = self.system.modes
        ending = [c.name for c in self.system.scope.model.contacts if c.unilateral]
        others = [name for name in ending if name != self.contact and (name not in modes or modes[name].closed)]
        if self.contact not in ending or others:
            raise NoValue("other contacts touch, or it is none")
        found = [Row.of_constraint(self.system.motion, self.contact)[0], *self.system.constraints.closing]
        if any(row.gap is None for row in found):
            raise NoValue("a row has no gap")
        return found

    @cached_property
    def _faster(self) -> list[Any]:
        return [self.trial.faster(u.name, 1) for u in self.system.symbols.u]

    @cached_property
    def solved(self) -> tuple[np.ndarray, np.ndarray]:
        """(u+ - u, impulses of the rows)."""
        rows, names = self.rows, [u.name for u in self.system.symbols.u]
        gaps = tuple(row.gap for row in rows if row.gap is not None)
        T, T_k = self._energy(self.trial), [self._energy(at) for at in self._faster]
        v, v_k = list(self.trial.along(gaps)[1]), [list(at.along(gaps)[1]) for at in self._faster]
        n, k = len(names), len(rows)
        whole, right = np.zeros((n + k, n + k)), np.zeros(n + k)
        for i in range(n):
            for j in range(n):
                whole[i, j] = float(self._energy(self._faster[i].faster(names[j], 1)) - T_k[i] - T_k[j] + T)
            for m in range(k):
                whole[n + m, i] = float(v_k[i][m] - v[m])
                whole[i, n + m] = -whole[n + m, i]
        declared = self.system.scope.model.constraints[self.contact]
        restitution = getattr(declared, "restitution", None)
        e = 0 if restitution is None else self.trial.along((self.system.scope.value(restitution),))[0][0]
        right[n:] = [-float((1 + e) * v[0]), *(-float(x) for x in v[1:])]
        found = np.linalg.solve(whole, right)
        return found[:n], found[n:]

    def _energy(self, at: Any) -> Any:
        return sum((m * (v @ v) for body in at.scene.bodies for m, _, v in at.particles(body)), start=0) / 2

    def of_joint(self, body: str, axis: int) -> float:
        """Impulse of a body's joint: the momentum that it and all that it carries gain, less the impulses on these.

        Raises:
            NoValue: it is no body with a joint.
        """
        links = self.system.motion.links
        names = [link.name for link in links]
        if body not in names:
            raise NoValue("only of joints")
        carried = {names.index(body)}
        for k, link in enumerate(links):
            carried |= {k} if link.parent in carried else set()
        du, impulses = self.solved
        total = 0.0
        for name in (names[k] for k in carried):
            before = self._momentum(self.trial, name, axis)
            total += sum(d * (self._momentum(at, name, axis) - before) for d, at in zip(du, self._faster, strict=True))
        for x, row in zip(impulses, self.rows, strict=True):
            for push in row.pushes:
                if isinstance(push, PointForce) and push.place[0] is not None and names.index(push.place[0]) in carried:
                    force = self.system.motion.in_ground_axes(push.force, push.axes)
                    total -= float(x) * float(self.trial.along((force[axis],))[0][0])
        return total

    def _momentum(self, at: Any, body: str, axis: int) -> float:
        return float(sum((m * v[axis] for m, _, v in at.particles(body)), start=0))


def struck(trial: Any, system: System, owner: str, axis: int | None = None) -> float:
    """Impulse of a contact that closes, or of a joint in the impact of the one that can, by differences.

    Raises:
        NoValue: several can close, or a row in the impact has no gap.
    """
    ending = [c.name for c in system.scope.model.contacts if c.unilateral]
    if owner in ending and axis is None:
        return float(Struck(trial, system, owner).solved[1][0])
    if len(ending) != 1 or axis is None:
        raise NoValue("of constraints that hold there is no second way")
    return Struck(trial, system, ending[0]).of_joint(owner, axis)


# -------- impacts that rub ------------------------------------------------------------------------------------
# D, v of contacts -> speeds after them, by small steps of one impulse, or by impulses iterated one after the other


STEPS, MOST_STEPS = 1000, 50_000  # of an impact that is followed in small steps
PROJECTIONS = 40  # of the friction of one of them
CORNERS = 64  # of the polygon around a circle of friction: 0.12 % beyond it
SWEEPS = 5000  # over the contacts of one impact


@dataclass(frozen=True)
class Touched:
    """A contact in an impact.

    Args:
        size: of its (v_n, v_t); 1: it does not rub.
    """

    mu: float
    e: float
    size: int


def after_impact(D: np.ndarray, v: np.ndarray, contacts: Sequence[Touched], law: str) -> np.ndarray | None:
    """The speeds (v_n, v_t) of contacts after an impact; None where there is no second way."""
    first = np.cumsum([0, *(contact.size for contact in contacts)])
    if len(contacts) == 1:
        (own,) = contacts
        return None if v[0] >= 0 or own.size < 2 else stepped_impact(D, v, own.mu, own.e, law)
    blocks = [D[a:b, c:d] for a, b in pairwise(first) for c, d in pairwise(first)]
    if law == "energetic" or any(not np.any(block) for block in blocks):
        return None
    if law == "newton":
        normals = np.minimum(v[first[:-1]], 0.0) * [contact.e for contact in contacts]
        p = _iterated(D, v, contacts, np.zeros(len(contacts)), normals)
        return None if p is None else v + D @ p
    none = np.zeros(len(contacts))
    pressed = _iterated(D, v, contacts, none, none)
    if pressed is None:
        return None
    returned = pressed[first[:-1]] * [contact.e for contact in contacts]
    p = _iterated(D, v + D @ pressed, contacts, returned, none)
    return None if p is None else v + D @ (pressed + p)


def _iterated(
    D: np.ndarray, v: np.ndarray, contacts: Sequence[Touched], given: np.ndarray, returns: np.ndarray
) -> np.ndarray | None:
    """Impulses with p_n >= given, |p_t| <= mu p_n that are the last of sweeps over the contacts; None: there is none.

    p_n <- max(given, p_n - (v_n + returns)/D_nn),   p_t <- p_t - v_t/|D_tt| within the friction, in space a circle
    """
    p, now = np.zeros(len(v)), np.array(v, dtype=float)
    size = float(np.max(np.abs(v), initial=0.0))
    for _ in range(SWEEPS):
        k, moved = 0, 0.0
        for contact, least, returned in zip(contacts, given, returns, strict=True):
            to = [max(least, p[k] - (now[k] + returned) / D[k, k])]
            if contact.size > 1:
                own, most = slice(k + 1, k + contact.size), contact.mu * to[0]
                along = p[own] - now[own] / np.linalg.norm(D[own, own], 2)
                to += (along * min(1.0, most / max(float(np.linalg.norm(along)), tolerances.TINIEST))).tolist()
            for i, x in enumerate(to, k):
                change, p[i] = D[:, i] * (x - p[i]), x
                now = now + change
                moved = max(moved, float(np.max(np.abs(change))))
            k += contact.size
        if moved <= tolerances.COMPUTED * size:
            return p
    return None


def around(tangents: Sequence[np.ndarray]) -> Iterator[np.ndarray]:
    """Directions t of friction whose cone n + mu t holds all that are allowed: in space the corners of a polygon."""
    if len(tangents) == 1:
        yield from (tangents[0], -tangents[0])
        return
    for k in range(CORNERS):
        turned = 2 * math.pi * k / CORNERS
        x, y = (part(turned) / math.cos(math.pi / CORNERS) for part in (math.cos, math.sin))
        yield x * tangents[0] + y * tangents[1]


def stepped_impact(D: np.ndarray, v: np.ndarray, mu: float, e: float, law: str) -> np.ndarray:
    """(v_n, v_t) after an impact, by small steps of the normal impulse and Coulomb's friction in each of them.

    Friction in a step is that which leaves the least energy at its end: min F^T D_tt F/2 + F^T (v_t/step + D_tn),
    |F| <= mu, by projected steps from that of the step before.
    """
    rows, now = D.tolist(), np.array(v, dtype=float).tolist()
    step, F = -now[0] / rows[0][0] / STEPS, [0.0] * (len(now) - 1)
    p, W, compressed = 0.0, 0.0, None
    stiffest = float(np.linalg.norm(D[1:, 1:], 2)) or 1.0
    for _ in range(MOST_STEPS):
        F = _least_energy(
            [x / step + row[0] for x, row in zip(now[1:], rows[1:], strict=True)], rows, F, (mu, stiffest)
        )
        gained = [step * (row[0] + sum(d * f for d, f in zip(row[1:], F, strict=True))) for row in rows]
        W += (now[0] + gained[0] / 2) * step
        now, p = [x + change for x, change in zip(now, gained, strict=True)], p + step
        if compressed is None and now[0] >= 0:
            compressed = p, W
        if (
            compressed is not None
            and {
                "newton": now[0] >= -e * v[0],
                "poisson": p >= (1 + e) * compressed[0],
                "energetic": W >= (1 - e * e) * compressed[1],
            }[law]
        ):
            break
    return np.array(now)


def _least_energy(
    due: Sequence[float], D: Sequence[Sequence[float]], F: Sequence[float], of: tuple[float, float]
) -> list[float]:
    """min F^T D_tt F/2 + F^T due, |F| <= mu; along one direction at once, along two by projected steps from F."""
    mu, stiffest = of
    if len(F) == 1:
        return [max(-mu, min(mu, -due[0] / D[1][1] if D[1][1] else 0.0))]
    (x, y), ((_, xx, xy), (_, yx, yy)) = F, D[1:]
    for _ in range(PROJECTIONS):
        a, b = x - (due[0] + xx * x + xy * y) / stiffest, y - (due[1] + yx * x + yy * y) / stiffest
        share = min(1.0, mu / max(math.hypot(a, b), tolerances.TINIEST))
        a, b = a * share, b * share
        moved, x, y = abs(a - x) + abs(b - y), a, b
        if moved <= tolerances.COMPUTED:
            break
    return [x, y]
