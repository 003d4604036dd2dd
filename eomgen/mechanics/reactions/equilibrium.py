"""Reactions, a state -> whether everything is in balance there, in numbers: D'Alembert's principle, three times over.

    each body:    sum of reactions + applied = inertia
    each pair:    what two bodies do to each other has no resultant and no moment
    the whole:    sum of reactions and applied forces = dP/dt,   of their moments about the origin = dL/dt

P and L are those of the bodies' twists, of which the bodies' own equations in the plane make no use; the forces of the
whole are taken as the loads give them, not from the bodies' equations.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from random import Random

import numpy as np

from eomgen.mechanics.balance.balance import DIRECTIONS, Balance
from eomgen.mechanics.balance.components import Component
from eomgen.mechanics.balance.unit_wrenches import PLANE_ROWS, SPACE_ROWS, Effect, joint_effects
from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.loads import in_ground_axes, weights
from eomgen.mechanics.equations.body_numbers import BodyNumbers
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.model.forces.load import Couple, PointForce
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import ZERO, Vector, apply, cross, plus, times
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import COMPUTED, ELIMINATED_AT_50


def imbalance(reactions: Reactions, state: State, rng: Random) -> str:
    """What is out of balance at a state, in words; "" where nothing is. Reactions left open take random values.

    Args:
        state: values of all symbols, accelerations of the motion included, at 50 digits.
    Raises:
        NoValue: a reaction has none at the state.
    """
    numbers = BodyNumbers(reactions.balance.system, state)
    x = _values(reactions, numbers, rng)
    wrenches = _Wrenches(reactions.balance, numbers)
    by_components = x[: len(reactions.components)]
    return _of_bodies(reactions.balance, numbers, x) or _of_pairs(wrenches) or _of_the_whole(wrenches, by_components)


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
    wrong = np.flatnonzero(~(np.abs(total) <= COMPUTED * size))
    if not len(wrong):
        return ""
    if COMPUTED * size[wrong[0]] < ELIMINATED_AT_50 * size.max():
        raise NoValue("what is small is lost beside the largest force")
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
        """How far a force may act from the origin: what cancels in its moment was no larger than force times arm."""
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
        """Of each body (its equations' axes in the ground's, its mass centre)."""
        scope, links = self.system.scope, self.system.motion.links
        centers = tuple(link.pose.point(mass_properties(scope, link.name).com) for link in links)
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
        if any(abs(total[j, k]) > COMPUTED * (1 + size[j].max()) for k in rows):
            return f"{component.name} does not act on its bodies in opposite ways"
    return ""


def _takes_a_couple(system: System, component: Component) -> bool:
    """What the model has no bearing for: of a gear's frame, and of strands that keep their direction."""
    forces = any(not is_zero(x) for effect in component.effects for x in effect.force)
    if component.kind != "tie":
        return False
    side = component.label == "n" and bool(system.scope.model.constraints[component.owner].strand_rows())
    return side or not forces


def _is_inner(system: System, component: Component) -> bool:
    """Whether the component acts between bodies, nothing of it on the ground."""
    if len({effect.link for effect in component.effects}) < 2:
        return False
    if component.kind != "tie":
        return True
    if system.scope.model.constraints[component.owner].leans_on_ground():
        return False
    rows = [row for row in system.ties.rows if (row.tie, row.number) == (component.owner, component.number)]
    return all(_body(push) is not None for row in rows for push in row.pushes)


def _body(push: PointForce | Couple) -> str | None:
    return push.body if isinstance(push, Couple) else push.place[0]


def _of_the_whole(wrenches: _Wrenches, x: np.ndarray) -> str:
    """The theorems of momentum and of moment of momentum."""
    unit, size = wrenches.of_components
    rates = wrenches.numbers.array(_momentum_rates(wrenches.system))
    applied = _applied(wrenches)
    total = x @ unit + applied - rates
    scale = 1 + np.abs(x) @ size.max(axis=1, initial=0.0) + np.abs(applied).max() + np.abs(rates).max()
    wrong = [k for k in wrenches.rows if not abs(total[k]) <= COMPUTED * scale]
    return f"all forces and reactions do not make up the rate of the momentum: {DIRECTIONS[wrong[0]]}" if wrong else ""


def _applied(wrenches: _Wrenches) -> np.ndarray:
    """Resultant of all that is given, the loads as they were given."""
    system, numbers = wrenches.system, wrenches.numbers
    vectors: list[Scalar] = []
    for load in (*system.loads.placed, *weights(system.loads)):
        vectors += _about_origin(system, load)
    given = numbers.array(tuple(vectors)).reshape(-1, 6).sum(axis=0)
    return np.asarray(given + wrenches.of_effects(joint_effects(system)).sum(axis=0))


def _about_origin(system: System, load: PointForce | Couple) -> list[Scalar]:
    """Force, and moment about the ground's origin, in the ground's axes; of a load on the ground nothing."""
    if _body(load) is None:
        return []
    if isinstance(load, Couple):
        return [*ZERO, *in_ground_axes(system.motion, load.couple, load.axes)]
    force = in_ground_axes(system.motion, load.force, load.axes)
    return [*force, *cross(system.motion.position(load.place), force)]


def _momentum_rates(system: System) -> tuple[Scalar, ...]:
    """(dP/dt, dL/dt) of all bodies about the ground's origin, ground axes, from their twists; found once."""
    if _momentum_rates not in system.found:
        P, L = ZERO, ZERO
        for p, l in _momenta(system):
            P, L = plus(P, p), plus(L, l)
        system.found[_momentum_rates] = system.scope.with_accelerations((*P, *L))
    found: tuple[Scalar, ...] = system.found[_momentum_rates]
    return found


def _momenta(system: System) -> Iterable[tuple[Vector, Vector]]:
    for link in system.motion.links:
        mass = mass_properties(system.scope, link.name)
        moved = system.scope.time_derivative(mass.com)
        velocity = plus(plus(link.twist.v, cross(link.twist.w, mass.com)), (moved[0], moved[1], moved[2]))
        p = times(mass.m, apply(link.pose.R, velocity))
        spin = apply(link.pose.R, apply(mass.I, link.twist.w))
        yield p, plus(cross(link.pose.point(mass.com), p), spin)
