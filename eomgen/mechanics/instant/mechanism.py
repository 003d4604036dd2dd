"""System, velocities -> Mechanism: centres of rotation of every body and of every pair in the plane.

Every body has the homogeneous centre c = (-v_0y : v_0x : w) of its velocity field (`centers`); a pair has
c_ij = c_j - c_i. Bodies that move as one are one block; those at rest belong to the ground's.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from itertools import combinations

from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.centers import Homogeneous, homogeneous_center
from eomgen.mechanics.fields.field import field_of
from eomgen.mechanics.initial_state.numeric_value import Worth
from eomgen.model.trusses import is_node
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import Legibly
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.spatial import ZERO, minus
from eomgen.symbolic.numeric.work import Work

FIXED = "0"
"""How the ground is called among the bodies."""


@dataclass(frozen=True)
class RotationCenter:
    """The centre of rotation of a pair of blocks.

    Args:
        pair: the names of the blocks; the first is "0" for an absolute centre.
        point: homogeneous: (x, y, 1), or (dx, dy, 0) at infinity in this direction.
    """

    pair: tuple[str, str]
    point: Homogeneous

    @property
    def at_infinity(self) -> bool:
        return type(self.point[2]) is int and self.point[2] == 0

    @property
    def name(self) -> str:
        return f"({self.pair[0]}, {self.pair[1]})"


@dataclass(frozen=True)
class Mechanism:
    """Rigid bodies in motion in the plane, at one configuration.

    Args:
        system: whose bodies.
        moving: what stands in place of coordinates, speeds, time and inputs.
        worth: what scalars are worth.
    """

    system: System
    moving: Mapping[Node, Scalar]
    worth: Worth

    # -- bodies that move as one -------------------------------------------------------------------

    @cached_property
    def blocks(self) -> dict[str, tuple[str, ...]]:
        """The bodies by the block in which they move, the ground's first; a block has the name of its first body."""
        found: dict[str, list[str]] = {FIXED: []}
        for body in self.fields:
            home = next((block for block in found if self.is_zero(self._apart(block, body))), None)
            found.setdefault(body if home is None else home, []).append(body)
        return {name: tuple(bodies) for name, bodies in found.items()}

    @cached_property
    def fields(self) -> dict[str, Homogeneous]:
        """The homogeneous centre of every body; nodes of trusses left out."""
        motion = self.system.motion
        bodies = [link for link in motion.links if not is_node(link.name)]
        return {
            link.name: self._simple.vector(homogeneous_center(field_of(motion, link.name).at(self.moving)))
            for link in bodies
        }

    def _apart(self, block: str, body: str) -> Homogeneous:
        return minus(self.fields[body], ZERO if block == FIXED else self.fields[block])

    def block_of(self, body: str | None) -> str:
        """The block of a body; of the ground (None), and of a point, its own name or "0"."""
        if body is None:
            return FIXED
        return next((name for name, bodies in self.blocks.items() if body in bodies), body)

    @property
    def moved(self) -> tuple[str, ...]:
        """The blocks that move."""
        return tuple(name for name in self.blocks if name != FIXED)

    # -- centres -----------------------------------------------------------------------------------

    @cached_property
    def centers(self) -> dict[tuple[str, str], RotationCenter]:
        """Of every pair of blocks; absolute ones first."""
        return {pair: self._center(pair) for pair in combinations(self.blocks, 2)}

    def _center(self, pair: tuple[str, str]) -> RotationCenter:
        return RotationCenter(pair, self.normal(self._simple.vector(self._apart(pair[0], pair[1]))))

    def normal(self, c: Homogeneous) -> Homogeneous:
        """A homogeneous point as (x, y, 1), or as (1, dy, 0) or (0, 1, 0) at infinity."""
        k = next(k for k in (2, 0, 1) if not self.is_zero((c[k],)))
        x, y = (self._simple(over(c[i], c[k])) for i in (0, 1))
        return (x, y, 1) if k == 2 else (1, y, 0) if k == 0 else (0, 1, 0)

    # -- helpers -----------------------------------------------------------------------------------

    def is_zero(self, scalars: Iterable[Scalar]) -> bool:
        """Whether all are zero here."""
        return self.worth.vanish(scalars)

    @cached_property
    def _simple(self) -> Legibly:
        return Legibly(Work.ANSWER, self.system.scope.positive)
