"""Reactions, a state -> test of the balance there; reactions by cuts through the system.

The test is made in numbers, by D'Alembert's principle in three forms:

    each body:    sum of reactions + applied = inertia
    each pair:    the forces of two bodies on each other have no resultant and no moment
    the whole:    sum of reactions and applied forces = dP/dt,   of their moments about the origin = dL/dt

P and L are those of the bodies' twists, of which the bodies' own equations in the plane make no use, and of the fluids
that move with them; the forces of the whole are taken as the loads give them, not from the bodies' equations.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies.balance import DIRECTIONS, Balance
from eomgen.mechanics.free_bodies.reactions import Reactions
from eomgen.mechanics.free_bodies.wrenches import PLANE_ROWS, SPACE_ROWS, Axes, Component, Effect
from eomgen.mechanics.kinematics import GROUND
from eomgen.model import Couple, MassProperties, PointForce
from eomgen.symbolic.exact import equal
from eomgen.symbolic.expression import Matrix, Pose, Scalar, ScalarRow, State, Vector, is_zero
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, floats_of, tolerances


def imbalance(reactions: Reactions, state: State, rng: Random, fluids: Iterable[ScalarRow] = ()) -> str:
    """Description of what is out of balance at a state; "" where nothing is. Reactions left open take random values.

    Args:
        state: values of all symbols, accelerations of the motion included, at 50 digits.
        fluids: rates of momentum, and of its moment about the origin, of what moves with bodies, by a second way.
    Raises:
        NoValue: a reaction has none at the state.
    """
    numbers = BodyNumbers(reactions.balance.system, state)
    x = _values(reactions, numbers, rng)
    wrenches = _Wrenches(reactions.balance, numbers)
    by_components = x[: len(reactions.components)]
    each = _of_bodies(reactions.balance, numbers, x) or _of_pairs(wrenches)
    return each or _of_the_whole(wrenches, by_components, fluids)


def _values(reactions: Reactions, numbers: BodyNumbers, rng: Random) -> np.ndarray:
    """Every component, then every unknown of the loads: x_j = constant - sum of share * x_free."""
    solution, loads = reactions.solution, numbers.array(reactions.balance.unknowns)
    x = np.concatenate([[rng.uniform(-1, 1) for _ in reactions.components], loads])
    x[list(solution.constants)] = numbers.array(tuple(solution.constants.values()))
    shares = [(j, f, share) for j, own in solution.shares.items() for f, share in own.items()]
    for (j, f, _), value in zip(shares, numbers.array(tuple(share for _, _, share in shares)), strict=True):
        x[j] -= value * x[f]
    return x


def _of_bodies(balance: Balance, numbers: BodyNumbers, x: np.ndarray) -> str:
    entries = [(i, j, value) for i, e in enumerate(balance.equations) for j, value in e.coefficients.items()]
    given = numbers.array(tuple(y for e in balance.equations for y in (e.applied, e.inertia))).reshape(-1, 2)
    total, size = given[:, 0] - given[:, 1], 1 + np.abs(given).sum(axis=1)
    for (i, j, _), value in zip(entries, numbers.array(tuple(value for _, _, value in entries)), strict=True):
        total[i] += value * x[j]
        size[i] += abs(value * x[j])
    wrong = np.flatnonzero(~(np.abs(total) <= tolerances.COMPUTED * size))
    if not len(wrong):
        return ""
    if tolerances.COMPUTED * size[wrong[0]] < tolerances.ELIMINATED_AT_50 * size.max():
        raise NoValue("small forces are lost by rounding against the largest force")
    e = balance.equations[wrong[0]]
    return f"body '{e.body}' is out of balance along {DIRECTIONS[e.direction]}"


@dataclass(frozen=True)
class _Wrenches:
    """Forces, and moments about the ground's origin, in the ground's axes."""

    balance: Balance
    numbers: BodyNumbers

    @property
    def system(self) -> System:
        return self.balance.system

    @cached_property
    def of_components(self) -> tuple[np.ndarray, np.ndarray]:
        """(resultant of a unit of each component, components x 6; sum of the sizes of what makes it up, likewise)."""
        components = self.balance.components
        owners = [j for j, c in enumerate(components) for _ in (*c.effects, *c.friction_effects)]
        effects = [e for c in components for e in (*c.effects, *c.friction_effects)]
        total, size = (np.zeros((len(components), 6)) for _ in range(2))
        for j, wrench, arm in zip(owners, self.of_effects(effects), self._arms(effects), strict=True):
            total[j] += wrench
            size[j] += abs(wrench) + arm * np.linalg.norm(wrench[:3])
        return total, size

    def of_effects(self, effects: Sequence[Effect]) -> np.ndarray:
        """Force, and moment about the ground's origin, of each of them alone, effects x 6, in the ground's axes."""
        flat = tuple(x for e in effects for x in (*e.force, *e.couple, *e.arm))
        force, couple, arm = self.numbers.array(flat).reshape(-1, 3, 3).transpose(1, 0, 2)
        R = np.array([self._places[e.link][0] for e in effects]).reshape(-1, 3, 3)
        p = np.array([self._places[e.link][1] for e in effects]).reshape(-1, 3)
        f, n = (np.einsum("eij,ej->ei", R, x) for x in (force, couple + np.cross(arm, force)))
        return np.hstack([f, n + np.cross(p, f)])

    def _arms(self, effects: Sequence[Effect]) -> list[float]:
        """Largest distance of each force from the origin: terms of its moment are no larger than force times arm."""
        arms = self.numbers.array(tuple(e.arm for e in effects)).reshape(-1, 3)
        return [
            float(np.linalg.norm(arm) + np.linalg.norm(self._places[effect.link][1]))
            for effect, arm in zip(effects, arms, strict=True)
        ]

    @property
    def rows(self) -> list[int]:
        return list(PLANE_ROWS if self._plane else SPACE_ROWS)

    @property
    def _plane(self) -> bool:
        return self.system.scope.model.space == "plane"

    @cached_property
    def _places(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """(axes of its equations in the ground's, mass centre) of each body, in numbers."""
        scope, links = self.system.scope, self.system.motion.links
        centers = tuple(link.pose.point(scope.mass_properties(link.name).com) for link in links)
        p = self.numbers.array(centers).reshape(-1, 3)
        if self._plane:
            return [(np.eye(3), center) for center in p]
        R = self.numbers.array(tuple(row for link in links for row in link.pose.R)).reshape(-1, 3, 3)
        return list(zip(R, p, strict=True))


def _of_pairs(wrenches: _Wrenches) -> str:
    """Newton's third law of every component that acts between bodies alone."""
    total, size = wrenches.of_components
    for j, component in enumerate(wrenches.balance.components):
        if not _is_inner(wrenches.system, component):
            continue
        rows = [k for k in wrenches.rows if k < 3 or not _takes_a_couple(wrenches.system, component)]
        if any(abs(total[j, k]) > tolerances.COMPUTED * (1 + size[j].max()) for k in rows):
            return f"{component.name} does not act on its bodies in opposite ways"
    return ""


def _takes_a_couple(system: System, component: Component) -> bool:
    """True if a component is a couple for which the model has no bearing: of a gear, or of a strand's direction."""
    forces = any(not is_zero(x) for effect in component.effects for x in effect.force)
    if component.kind != "constraint":
        return False
    side = component.label == "n" and bool(system.scope.model.constraints[component.owner].strand_rows())
    return side or not forces


def _is_inner(system: System, component: Component) -> bool:
    """True if the component acts between bodies only, not on the ground."""
    if len({effect.link for effect in component.effects}) < 2:
        return False
    if component.kind != "constraint":
        return True
    constraint = system.scope.model.constraints.get(component.owner)  # none of a joint that sticks
    if constraint is not None and constraint.leans_on_ground():
        return False
    rows = [
        row for row in system.constraints.rows if (row.constraint, row.number) == (component.owner, component.number)
    ]
    return all(_body(push) is not None for row in rows for push in row.pushes)


def _body(push: PointForce | Couple) -> str | None:
    return push.body if isinstance(push, Couple) else push.place[0]


def _of_the_whole(wrenches: _Wrenches, x: np.ndarray, fluids: Iterable[ScalarRow]) -> str:
    """The theorems of momentum and of moment of momentum."""
    unit, size = wrenches.of_components
    rates = wrenches.numbers.array(_momentum_rates(wrenches.system))
    for fluid in fluids:
        rates = rates + wrenches.numbers.array(fluid)
    applied = _applied(wrenches)
    total = x @ unit + applied - rates
    scale = 1 + np.abs(x) @ size.max(axis=1, initial=0.0) + np.abs(applied).max() + np.abs(rates).max()
    wrong = [k for k in wrenches.rows if not abs(total[k]) <= tolerances.COMPUTED * scale]
    return f"all forces and reactions do not make up the rate of the momentum: {DIRECTIONS[wrong[0]]}" if wrong else ""


def _applied(wrenches: _Wrenches) -> np.ndarray:
    """Resultant of all that is given, the loads as they were given."""
    system, numbers = wrenches.system, wrenches.numbers
    vectors: list[Scalar] = []
    for load in (*system.loads.placed, *system.loads.weights):
        vectors += _about_origin(system, load)
    given = numbers.array(tuple(vectors)).reshape(-1, 6).sum(axis=0)
    return np.asarray(given + wrenches.of_effects(Effect.of_joints(system)).sum(axis=0))


def _about_origin(system: System, load: PointForce | Couple) -> list[Scalar]:
    """Force, and moment about the ground's origin, in the ground's axes; of a load on the ground nothing."""
    if _body(load) is None:
        return []
    if isinstance(load, Couple):
        return [*Vector.ZERO, *system.motion.in_ground_axes(load.couple, load.axes)]
    force = system.motion.in_ground_axes(load.force, load.axes)
    return [*force, *system.motion.position(load.place).cross(force)]


def _momentum_rates(system: System) -> tuple[Scalar, ...]:
    """(dP/dt, dL/dt) of all bodies about the ground's origin, ground axes, from their twists; found once."""
    if _momentum_rates not in system.found:
        P, L = Vector.ZERO, Vector.ZERO
        for p, l in _momenta(system):
            P, L = P + p, L + l
        gained = iter((*_of_mass_that_comes(system),))
        rates = system.scope.with_accelerations((*P, *L))
        system.found[_momentum_rates] = tuple(x - next(gained) for x in rates)
    found: tuple[Scalar, ...] = system.found[_momentum_rates]
    return found


def _of_mass_that_comes(system: System) -> tuple[Scalar, ...]:
    """Momentum and angular momentum per second of mass that comes at the velocity of its body."""
    P, L = Vector.ZERO, Vector.ZERO
    for p, l in _momenta(system, system.scope.mass_rates):
        P, L = P + p, L + l
    return (*P, *L)


def _momenta(
    system: System, masses: Callable[[str], MassProperties | None] | None = None
) -> Iterable[tuple[Vector, Vector]]:
    for link in system.motion.links:
        mass = (masses or system.scope.mass_properties)(link.name)
        if mass is None:
            continue
        moved = system.scope.time_derivative(mass.com)
        velocity = link.twist.v + link.twist.w.cross(mass.com) + Vector((moved[0], moved[1], moved[2]))
        p = mass.m * (link.pose.R @ velocity)
        spin = link.pose.R @ (mass.I @ link.twist.w)
        yield p, link.pose.point(mass.com).cross(p) + spin


# -------- sides -----------------------------------------------------------------------------------------------
# Balance -> reactions by the balance of all bodies on one side of a joint or constraint, which hold together by it
# alone.
#
# Cut it through: the side without the ground has no other support, so that the force and moment at the cut are
#
#     f = sum(m a_C - f_applied),    n = sum(d/dt (I w) - n_applied + (C - P) x (m a_C - f_applied))    about its
#         place P
#
# and a component is the projection of that on its unit wrench. Of two free sides the one with fewer bodies is taken.
# Nothing is solved for, so nothing is divided by.


FORCES, MOMENTS = range(3), range(3, 6)
MOST_BODIES = 12  # of a system in which sides are added up: a chain of n has n^2/2 bodies on all its sides


def reactions_by_sides(balance: Balance) -> dict[int, Scalar]:
    """The components, by their number, that one side of their joint or constraint gives; none where there is
    friction."""
    links = balance.system.motion.links
    if len(links) > MOST_BODIES or balance.unknowns or any(c.frictional for c in balance.components):
        return {}
    sides = _Sides(balance)
    cuts: dict[tuple[str, str], list[int]] = {}
    for j, c in enumerate(balance.components):
        cuts.setdefault((c.owner, c.side if c.kind == "constraint" else ""), []).append(j)
    return {j: x for numbers in cuts.values() for j, x in sides.of_cut(numbers).items()}


@dataclass(frozen=True)
class _Sides:
    balance: Balance

    @cached_property
    def axes(self) -> Axes:
        return Axes(self.balance.system.motion)

    @property
    def _needed(self) -> dict[tuple[int, int], Scalar]:
        index = self.balance.system.motion.index
        return {(index[e.body], e.direction): e.needed for e in self.balance.equations}

    def of_cut(self, numbers: Sequence[int]) -> dict[int, Scalar]:
        """The components of one joint or constraint; none where its bodies hang together by something else, too."""
        components = [self.balance.components[j] for j in numbers]
        ends = {effect.link for c in components for effect in c.effects}
        sides = [side for end in sorted(ends) if GROUND not in (side := self._side(end, set(numbers)))]
        sides = [side for side in sides if len(ends & side) == 1]
        if not sides:
            return {}
        side = min(sides, key=lambda each: (len(each), min(ends & each)))
        (body,) = ends & side
        mine = [_only([effect for effect in c.effects if effect.link == body]) for c in components]
        found = {}
        for j, effect in zip(numbers, mine, strict=True):
            if effect is None or effect.place is None or not _is_apart(effect, mine):
                continue
            force, couple = self._held(body, side, effect)
            found[j] = effect.force @ force + effect.couple @ couple
        return found

    def _side(self, start: int, cut: set[int]) -> frozenset[int]:
        """The bodies, and GROUND, that hang together with the start when these components are cut through."""
        joined: dict[int, set[int]] = {}
        for j, ends in enumerate(self._ends):
            if j not in cut:
                for end in ends:
                    joined.setdefault(end, set()).update(ends)
        reached, pending = {start}, [start]
        while pending:
            for other in joined.get(pending.pop(), set()) - reached:
                if other != GROUND:
                    pending.append(other)
                reached.add(other)
        return frozenset(reached)

    @cached_property
    def _ends(self) -> list[set[int]]:
        """Bodies that each component joins; with the ground, if its forces on bodies are not in balance together."""
        found = []
        for c in self.balance.components:
            ends = {effect.link for effect in c.effects}
            found.append(ends if len(ends) > 1 and self._is_even(c) else ends | {GROUND})
        return found

    def _is_even(self, component: Component) -> bool:
        """True if the component's forces balance one another; a string over a peg of the ground presses on it too."""
        if component.kind != "constraint":
            return True
        total: list[Scalar] = [0] * 6
        for effect in component.effects:
            pose = self.axes.motion.links[effect.link].pose
            R = Matrix.IDENTITY if self.axes.plane else pose.R
            force, couple = R @ effect.force, R @ effect.couple
            if effect.place is not None:
                couple = couple + pose.point(effect.place).cross(force)
            elif any(not is_zero(x) for x in force):
                return False
            total = [x + y for x, y in zip(total, (*force, *couple), strict=True)]
        return all(equal(x, 0) for x in total)

    def _held(self, body: int, side: Iterable[int], effect: Effect) -> tuple[Vector, Vector]:
        """Force, and couple about the place of the effect, in the axes of the body's equations."""
        force, couple = Vector.ZERO, Vector.ZERO
        for b in sorted(side):
            R, arm = self._seen(b, body, effect)
            f, n = (R @ Vector(self._needed.get((b, d), 0) for d in rows) for rows in (FORCES, MOMENTS))
            force, couple = force + f, couple + (n + arm.cross(f))
        return force, couple

    def _seen(self, b: int, body: int, effect: Effect) -> tuple[Matrix, Vector]:
        """(rotation into the body's axes, from the effect's place to the mass centre of b in them)."""
        assert effect.place is not None
        links, com = self.axes.motion.links, self.axes.masses[b].com
        if self.axes.plane:
            return Matrix.IDENTITY, links[b].pose.point(com) - links[body].pose.point(effect.place)
        pose = self._relative(b, body)
        return pose.R, pose.point(com) - effect.place

    def _relative(self, b: int, body: int) -> Pose:
        """Pose of b in the axes of another body: along the tree where that body carries b."""
        links = self.axes.motion.links
        path: list[int] = []
        while b not in (body, GROUND):
            path.append(b)
            b = links[b].parent
        if b == GROUND and body != GROUND:
            R = links[body].pose.R.T
            last = links[path[0]].pose if path else Pose()
            return Pose(R @ last.R, R @ (last.p - links[body].pose.p))
        pose = Pose()
        for k in reversed(path):
            local = links[k].local
            pose = pose.then(Pose(local.R, local.p - local.R @ links[k].point))
        return pose


def _only(effects: Sequence[Effect]) -> Effect | None:
    return effects[0] if len(effects) == 1 else None


def _is_apart(effect: Effect, others: Sequence[Effect | None]) -> bool:
    """True if an effect is a unit wrench orthogonal to the other effects of the cut, all at one place."""
    for other in others:
        if other is None or other.place != effect.place:
            return False
        along = effect.force @ other.force + effect.couple @ other.couple
        if not equal(along, 1 if other is effect else 0):
            return False
    return True


# -------- body numbers ----------------------------------------------------------------------------------------
# System, state -> numbers of its expressions there, and their rates along the motion through it, by differences.


@dataclass(frozen=True)
class BodyNumbers:
    """Values of expressions at a state, and along the motion through it."""

    system: System
    state: State

    def at(self, scalars: tuple[Scalar, ...], shift: int = 0) -> list[Any]:
        """Values at the state, or a step of 1e-15 later (shift = 1) or earlier (-1) on the path with constant u."""
        return evaluate(scalars, self._beside[shift] if shift else self.state, fifty_digits())

    @cached_property
    def _beside(self) -> dict[int, State]:
        return {sign: self._shifted(sign) for sign in (1, -1)}

    def _shifted(self, sign: int) -> State:
        """The state a step of 1e-15 later or earlier."""
        arithmetic, values, symbols = fifty_digits(), dict(self.state), self.system.scope.symbols
        h = sign * _step(arithmetic)
        for q, rate in zip(symbols.q, evaluate(self.system.scope.rates, self.state, arithmetic), strict=True):
            values[q] = values[q] + h * rate
        values[symbols.t] = values[symbols.t] + h
        return values

    def array(self, scalars: Any) -> np.ndarray:
        """Values as floats, in the shape of the nested tuples."""
        flat, shape = _flattened(scalars)
        return np.array(floats_of(self.at(flat))).reshape(shape)

    def rate(self, scalars: Any) -> np.ndarray:
        """Time derivative at a = 0 by central differences."""
        flat, shape = _flattened(scalars)
        after, before = self.at(flat, 1), self.at(flat, -1)
        step = _step(fifty_digits())
        return np.array([float((x - y) / (2 * step)) for x, y in zip(after, before, strict=True)]).reshape(shape)


def _step(arithmetic: Any) -> Any:
    return arithmetic.number(1) / arithmetic.number(10**15)


def _flattened(scalars: Any) -> tuple[tuple[Scalar, ...], tuple[int, ...]]:
    """A scalar tuple or a tuple of rows, flat, and its shape."""
    if scalars and isinstance(scalars[0], tuple):
        return tuple(x for row in scalars for x in row), (len(scalars), len(scalars[0]))
    return tuple(scalars), (len(scalars),)
