"""Mass that may change its body unfelt -> base parameters as formulas of the lengths, of mechanisms with loops too.

Where a point of one body always meets a point of another, a particle there may belong to either; where they have an
axis together, so may the dipole and the quadrupole along it; bodies that turn alike may exchange moments of inertia:

    particle:    m = 1,   m c = r,   I = r.r E - r r^T
    dipole:      m = 0,   m c = n,   I = 2 r.n E - r n^T - n r^T
    quadrupole:  m = 0,   m c = 0,   I = n.n E - n n^T

What one body loses the other gains, which is a combination of the columns of Y that vanishes on every motion: found by
what meets at a few states, and tried on Y there, with 50 digits and with other lengths than the model's. As many of
them as there are columns that follow from others give these by exact elimination.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any

from eomgen.mechanics.bodies.kinematics import velocity_of
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import (
    IDENTITY,
    ZERO,
    Matrix,
    SpatialInertia,
    Vector,
    added,
    apply,
    dot,
    matrix_of,
    product,
    transposed,
)
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import FOLLOWS_AT_50

PLACES = {"Ixx": (0, 0), "Iyy": (1, 1), "Izz": (2, 2), "Ixy": (0, 1), "Iyz": (1, 2), "Izx": (0, 2)}
MOMENTS = {"mx": 0, "my": 1, "mz": 2}

Transfer = Mapping[str, Scalar]
"""Of each parameter by how much it changes."""


def named_entries(inertia: SpatialInertia) -> dict[str, Scalar]:
    """m, m c and I of a body by the names of its parameters."""
    found = {"m": inertia.m} | {name: inertia.h[k] for name, k in MOMENTS.items()}
    return found | {name: inertia.I[i][j] for name, (i, j) in PLACES.items()}


def particle(r: Vector) -> SpatialInertia:
    """Of mass 1 at r."""
    return SpatialInertia(1, r, _crossed(r, r))


def dipole(r: Vector, n: Vector) -> SpatialInertia:
    """The slope of a particle at r along n."""
    return SpatialInertia(0, n, added(_crossed(r, n), _crossed(n, r)))


def quadrupole(n: Vector) -> SpatialInertia:
    """Half of the second slope along n: a moment of inertia about all that is across it."""
    return SpatialInertia(0, ZERO, _crossed(n, n))


def _crossed(a: Vector, b: Vector) -> Matrix:
    """a.b E - a b^T"""
    size = dot(a, b)
    return matrix_of([(size if i == j else 0) - a[i] * b[j] for j in range(3)] for i in range(3))


@dataclass(frozen=True)
class SharedPoint:
    """What two bodies share: a point, r in the axes of each, and axes through it; None: the ground."""

    bodies: tuple[str | None, str | None]
    at: tuple[Vector, Vector]
    axes: tuple[tuple[Vector, Vector], ...] = ()

    def transfers(self) -> Iterator[Transfer]:
        """From the second body to the first, or from the ground."""
        for first, second in [
            tuple(map(particle, self.at)),
            *((dipole(self.at[0], m), dipole(self.at[1], n)) for m, n in self.axes),
            *((quadrupole(m), quadrupole(n)) for m, n in self.axes),
        ]:
            yield _exchanged(self.bodies, first, second)


def _exchanged(bodies: tuple[str | None, str | None], first: SpatialInertia, second: SpatialInertia) -> Transfer:
    sides = [(body, x) for body, x in zip(bodies, (first, second), strict=True) if body is not None]
    signed = ((body, 1 if body == bodies[0] else -1, named_entries(x)) for body, x in sides)
    return {f"{name}({body})": sign * x for body, sign, own in signed for name, x in own.items() if not is_zero(x)}


def transfers_of(system: System, states: Sequence[State]) -> Iterator[Transfer]:
    """What may be a move: the points that meet at all states, the axes of joints, bodies that turn alike."""
    motion = system.motion
    yield from (x for shared in _shared(system, states) for x in shared.transfers())
    for link in motion.links:
        parent = None if link.parent < 0 else motion.links[link.parent].name
        if link.joint is None or len(link.S) > 1:
            continue
        R = product(link.before.R, link.joint.pose((0,) * len(link.S), motion.scope.value).R)
        own = [n for column in link.S for n in column if not all(map(is_zero, n))] or IDENTITY
        axes = tuple((apply(R, n), n) for n in own)
        yield from SharedPoint((parent, link.name), (link.before.p, link.point), axes).transfers()
        for i in range(3):
            for j in range(i + 1):
                E = matrix_of([int({r, c} == {i, j}) for c in range(3)] for r in range(3))
                turned = product(product(R, E), transposed(R))
                yield _exchanged((parent, link.name), SpatialInertia(0, ZERO, turned), SpatialInertia(0, ZERO, E))
    yield from _alike(system, states)


def _shared(system: System, states: Sequence[State]) -> Iterator[SharedPoint]:
    """The points of bodies that are one point at all states, and those that stand still."""
    motion = system.motion
    places: list[tuple[str, Vector]] = []
    for link in motion.links:
        places += [(link.name, r) for r in (*motion.points[link.name].values(), link.point)]
        places += [(motion.links[link.parent].name, link.before.p)] if link.parent >= 0 else []
    places = [place for place in dict.fromkeys(places) if not motion.moves(place[1])]
    met: dict[Any, dict[str, Vector]] = defaultdict(dict)
    for name, r in places:
        met[_seen(motion.position((name, r)), states)].setdefault(name, r)
    for there in met.values():
        yield from (SharedPoint((a, b), (r, s)) for (a, r), (b, s) in combinations(there.items(), 2))
        for name, r in there.items():
            if not any(any(rates) for rates in _seen(velocity_of(motion, (name, r)), states)):
                yield SharedPoint((name, None), (r, ZERO))


def _seen(scalars: Sequence[Scalar], states: Sequence[State]) -> tuple[tuple[int, ...], ...]:
    """What scalars are worth at each state, as whole numbers of what is surely known."""
    return tuple(tuple(int(x / FOLLOWS_AT_50 + 0.5) for x in evaluate(scalars, s, fifty_digits())) for s in states)


def _alike(system: System, states: Sequence[State]) -> Iterator[Transfer]:
    """In the plane: bodies with one angular velocity at all states."""
    if system.scope.model.space != "plane":
        return
    groups: dict[Any, list[str]] = defaultdict(list)
    for link in system.motion.links:
        groups[_seen((link.twist.w[2],), states)].append(link.name)
    for names in groups.values():
        yield from ({f"Izz({names[0]})": 1, f"Izz({other})": -1} for other in names[1:])
