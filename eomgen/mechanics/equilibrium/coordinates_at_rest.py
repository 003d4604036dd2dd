"""Static equations -> the coordinates that may be chosen where velocity constraints let a system rest in many places.

A knife edge or a wheel restricts velocities and no positions: where Q + J^T lam = 0, phi = 0 hold at one place they
hold near it too. With A the derivatives of these equations by (lam, q), the coordinates whose columns of A depend
linearly on the columns before them may have any value near: they stay where they start, and the others follow.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.equilibrium.equations import StaticEquations
from eomgen.mechanics.equilibrium.places import place_near
from eomgen.mechanics.state import Split
from eomgen.symbolic.exact import vanishes
from eomgen.symbolic.expression import Node, jacobian
from eomgen.symbolic.numeric import dense, rank, tolerances

ASIDE = 0.01  # distance from the first equilibrium at which another one is sought


@dataclass(frozen=True)
class Chosen:
    """Coordinates whose values at rest may be chosen.

    Args:
        coordinates: those that may have any value near their start.
        smooth: True if two neighbouring equilibria have as many of them: they belong to one family.
        indifferent: coordinates on which no equation depends.
    """

    coordinates: tuple[Node, ...] = ()
    smooth: bool = True
    indifferent: tuple[Node, ...] = ()


def holds_velocities(statics: StaticEquations, values: Mapping[Node, Any], guess: np.ndarray) -> bool:
    """True if a constraint restricts velocities but no positions: d phi/dq has less rank than J."""
    aside = guess + ASIDE * np.random.default_rng(3).uniform(1, 2, len(guess))
    floats = {node: float(x) for node, x in values.items()}
    relations = jacobian(statics.phi, statics.q) if statics.phi else ()
    held = rank(statics.slopes(relations, aside, floats)) if relations else 0
    return held < rank(statics.slopes(statics.J, aside, floats))


def unheld(statics: StaticEquations) -> tuple[Node, ...]:
    """Coordinates that occur in the equations although none depends on them: sin^2 + cos^2."""
    slopes = zip(*jacobian(statics.equations, statics.q), strict=True) if statics.equations else iter(())
    return tuple(q for q, column in zip(statics.q, slopes, strict=False) if all(map(vanishes, column)))


def chosen_coordinates(statics: StaticEquations, values: Mapping[Node, Any], guess: np.ndarray) -> Chosen:
    """The coordinates that may be chosen near the equilibrium that is reached from a guess.

    Args:
        values: of the parameters, with 50 digits.
        guess: of the coordinates.
    """
    here = place_near(statics, values, guess)
    return Chosen() if here is None else _Near(statics, values, guess, here).chosen()


@dataclass(frozen=True)
class _Near:
    statics: StaticEquations
    values: Mapping[Node, Any]
    guess: np.ndarray
    here: np.ndarray

    def chosen(self) -> Chosen:
        beside = place_near(self.statics, self.values, self._shifted)
        loose = [self._loose(z) for z in (self.here, self.here if beside is None else beside)]
        return Chosen(tuple(loose[1]), len(loose[0]) == len(loose[1]))

    @cached_property
    def _shifted(self) -> np.ndarray:
        """A place near the family's tangent."""
        n = len(self.statics.q)
        free = [self.statics.q.index(q) for q in self._loose(self.here)]
        moved = self.here[:n].copy()
        moved[free] += ASIDE * np.random.default_rng(4).uniform(1, 2, len(free))
        return moved

    def _loose(self, place: np.ndarray) -> list[Node]:
        """The coordinates whose columns of A follow from those of the multipliers and of other coordinates."""
        floats = {node: float(x) for node, x in self.values.items()}
        floats |= dict(zip(self.statics.unknowns, map(float, place), strict=True))
        slopes = jacobian(self.statics.equations, self.statics.unknowns)
        A = self.statics.slopes(slopes, place[: len(self.statics.q)], floats)
        n = len(self.statics.q)
        order = [*range(n, A.shape[1]), *sorted(range(n), key=self._place_in_order)]
        free = Split.in_order(dense.without_noise(A, tolerances.SUMMED, axis=1), order).free
        return [q for k, q in enumerate(self.statics.q) if k in free]

    def _place_in_order(self, k: int) -> tuple[bool, bool, int]:
        """Key of a coordinate in the choice: first those that move away from the guess, then those only guessed."""
        still = abs(self.here[k] - self.guess[k]) <= tolerances.SAME_PLACE * (1 + abs(self.guess[k]))
        return bool(still), not self.statics.system.scope.model.is_guess(self.statics.q[k].name), -k
