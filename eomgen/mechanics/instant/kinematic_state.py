"""System, velocities, accelerations at one instant -> KinematicState: fields of bodies, points, the mechanism."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import Any

from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.constraints.freedom import is_particle
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.field import VelocityField, field_of
from eomgen.mechanics.initial_state.numeric_value import Worth
from eomgen.mechanics.instant.construction import FoundPoint, PointPair, constructed
from eomgen.mechanics.instant.mechanism import Mechanism
from eomgen.model.trusses import is_node
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import Legibly
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import Vector, dot
from eomgen.symbolic.numeric.tolerances import COMPUTED, ZERO_AT_50
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size

SHORT = 400  # characters of all values of a state that a reader can take
LARGE = 4000  # characters of a value that is not made readable any more


@dataclass(frozen=True)
class KinematicState:
    """How a system moves at one instant, by scalars of the parameters.

    Args:
        system: its bodies and ties.
        moving: what stands in place of coordinates, speeds, time and inputs.
        accelerated: the same, the accelerations too; {} where they are not known.
        freedoms: how many there are by rank.
        formula: the same by counting, a number and its text.
        when: the instant in words.
        given: what is given of velocities and accelerations, as it was written.
        rate: the velocity that is left as a symbol, by which all others are expressed; "" where all are known.
        symbol: of it.
        exact: whether the state is known in closed form.
        rounded: whether the accelerations are numbers although the state has a closed form.
        equations: the equations of motion by which it goes on; None where only the instant is known.
    """

    system: System
    moving: State
    accelerated: State
    freedoms: int
    formula: tuple[int, str]
    when: str
    given: tuple[str, ...] = ()
    rate: str = ""
    symbol: Node | None = None
    exact: bool = True
    rounded: bool = False
    equations: EquationsOfMotion | None = None

    @property
    def state(self) -> State:
        """All that is known."""
        return self.accelerated or self.moving

    @property
    def is_short(self) -> bool:
        """Whether it is known exactly, by formulas that a reader can take."""
        return self.exact and not self.rounded and sum(map(text_size, self.state.values())) <= SHORT

    @property
    def plane(self) -> bool:
        return self.system.scope.model.space == "plane"

    # -- fields --------------------------------------------------------------------------------------

    @cached_property
    def fields(self) -> dict[str, VelocityField]:
        """Of every body; nodes of trusses are points, not bodies."""
        motion = self.system.motion
        bodies = [link.name for link in motion.links if not is_node(link.name)]
        return {name: field_of(motion, name).at(self.state) for name in bodies}

    @property
    def turning(self) -> dict[str, VelocityField]:
        """Of the bodies that are no points."""
        links = self.system.motion.links
        points = {link.name for link in links if is_particle(self.system.motion, link)}
        return {name: field for name, field in self.fields.items() if name not in points}

    @cached_property
    def points(self) -> tuple[tuple[str, Vector, Vector, Vector | None], ...]:
        """(names, place, velocity, acceleration) of every named point; those of a hinge stand together."""
        links = self.system.motion.links
        named = [(name, *self._of(link.name, place)) for link in links for name, place in self._named(link)]
        found: list[tuple[list[str], int]] = []
        values = self._values([vectors for _, *vectors in named])
        for k, (name, *_) in enumerate(named):
            home = next((names for names, first in found if self._same(values[first], values[k])), None)
            if home is None:
                found.append(([name], k))
            else:
                home.append(name)
        return tuple((", ".join(names), *named[k][1:]) for names, k in found)

    def _values(self, named: Sequence[Sequence[Vector | None]]) -> list[list[Any]]:
        """What the vectors of every point are worth, those that are not known left out."""
        flat = [[x for v in vectors if v is not None for x in v] for vectors in named]
        values = iter(self.worth.of(x for vectors in flat for x in vectors))
        return [[next(values) for _ in vectors] for vectors in flat]

    def _same(self, one: Sequence[Any], other: Sequence[Any]) -> bool:
        return all(abs(x - y) < self.worth.tolerance for x, y in zip(one, other, strict=True))

    def _named(self, link: BodyLink) -> Iterable[tuple[str, Vector]]:
        motion = self.system.motion
        if is_node(link.name):
            return [(link.name, (0, 0, 0))]
        own = motion.points[link.name]
        kept = [name for name in own if name != "origin"] or ["origin"]
        return [(f"{link.name}.{name}", own[name]) for name in kept]

    def _of(self, body: str, place: Vector) -> tuple[Vector, Vector, Vector | None]:
        """Place, velocity and acceleration of a place of a body, which may move in it."""
        scope = self.system.scope
        r = self.system.motion.position((body, place))
        v = scope.rate_of(r)
        a = self.put(scope.with_accelerations(v)) if self.accelerated else None
        return self.put(r), self.put(v), a

    def put(self, scalars: Sequence[Scalar]) -> Vector:
        """A vector at the instant, readable."""
        return self.simple.vector(substituted(tuple(scalars), self.state))

    @cached_property
    def simple(self) -> Legibly:
        """Scalars as a person writes them; as they are where they are very long."""
        return Legibly(Work.ANSWER, self.system.scope.positive, LARGE)

    def size(self, v: Vector) -> Scalar:
        """|v|"""
        return self.simple(sqrt(dot(v, v)))

    @cached_property
    def worth(self) -> Worth:
        """What scalars are worth."""
        return Worth(self.system.scope, ZERO_AT_50 if self.exact else COMPUTED)

    def number(self, x: Scalar) -> float | None:
        """What a scalar is worth at the model's parameters; None where some have no value."""
        return self.worth.number(x)

    # -- the mechanism -------------------------------------------------------------------------------

    @cached_property
    def mechanism(self) -> Mechanism | None:
        """In the plane."""
        return Mechanism(self.system, self.moving, self.worth) if self.plane else None

    @cached_property
    def found(self) -> dict[PointPair, FoundPoint]:
        """The centres that a drawing finds, in its order."""
        return {} if self.mechanism is None else {each.pair: each for each in constructed(self.mechanism)}

    @property
    def disagreement(self) -> str:
        """The centres that the drawing finds elsewhere than the velocities; "" as it must be."""
        return ", ".join(f"({i}, {j})" for (i, j), each in self.found.items() if not each.agrees)
