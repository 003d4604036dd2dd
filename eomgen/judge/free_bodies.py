"""What acts -> the balances of bodies that are cut free, in the plane.

    sum of F . e = 0,   sum of (M_O - (p x F)) = 0 about a named point p;   inertia forces -m a stand among the F

An equation for each body, for bodies that hang together, for the whole, and of a truss for each node and each part that
a straight cut separates; along x and y, along and across what pulls in one direction, along the bodies' own axes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field
from functools import cached_property
from itertools import combinations

import numpy as np

from eomgen.judge.acting import ActingForce, PlacedPush
from eomgen.judge.diagnosis import Samples
from eomgen.judge.terms import angles_in
from eomgen.mechanics.equations.system import System
from eomgen.model.trusses import is_node
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.spatial import Vector, cross, vector_of
from eomgen.symbolic.numeric.tolerances import CARRIED

MOST_BODIES = 6  # of a system whose connected parts are all cut free
MOST_CUT = 3  # members through which a part of a truss is cut
CUTS = 12  # directions of straight cuts
GENERIC = ("origin", "center", "start", "end")  # names that points of several bodies have


@dataclass(frozen=True)
class CutBalance:
    """One equation: the balance of forces along e, or of moments about p, of parts that are cut free."""

    parts: frozenset[int]
    name: str
    along: Vector | None = None
    about: Vector | None = None

    def value(self, push: PlacedPush) -> Scalar:
        """What a push adds to the sum."""
        if self.along is not None:
            return push.force[0] * self.along[0] + push.force[1] * self.along[1]
        return push.moment - (0 if self.about is None else cross(self.about, push.force)[2])


@dataclass(frozen=True)
class Spot:
    """A place that has a name, and the bodies of which it is a point."""

    name: str
    place: Vector
    numbers: np.ndarray
    bodies: set[int]


@dataclass(frozen=True)
class FreeBodies:
    """What is cut free.

    Args:
        acting: what acts on it.
        beams: the balances of parts of beams.
        samples: states at which directions and places are compared.
    """

    system: System
    acting: tuple[ActingForce, ...]
    beams: tuple[CutBalance, ...]
    samples: Samples = field(repr=False)

    def cuts(self, asked: Sequence[Node]) -> Iterator[CutBalance]:
        """The balances in which something that is asked may stand."""
        mine = [each for each in self.acting if each.symbol in asked]
        for bodies in self._parts():
            if any(each.on(bodies) for each in mine):
                name = self._called(bodies)
                for told, e in self._directions(bodies):
                    yield CutBalance(bodies, f"the balance of forces {told} of {name}", along=e)
                around = bodies | (self._beyond(bodies) if self.is_truss(bodies) else set())
                for spot in self.spots:
                    if spot.bodies & around:
                        told = f"the balance of moments about {spot.name} of {name}"
                        yield CutBalance(bodies, told, about=spot.place)
        yield from self.beams

    def _beyond(self, bodies: frozenset[int]) -> set[int]:
        """What reactions join to them."""
        return {
            push.body for each in self.acting if each.kind == "reaction" and each.on(bodies) for push in each.pushes
        }

    @cached_property
    def angles(self) -> list[Node]:
        """Under whose sines and cosines forces stand."""
        return angles_in([x for each in self.acting for push in each.pushes for x in push.force])

    @cached_property
    def spots(self) -> tuple[Spot, ...]:
        """All points that have a name, each once."""
        motion, found = self.system.motion, list[Spot]()
        named = [(x, i, r) for i, link in enumerate(motion.links) for x, r in motion.points[link.name].items()]
        for name, i, r in sorted(named, key=lambda each: each[0] in GENERIC):
            link = motion.links[i]
            place = link.pose.point(r)
            numbers = self._numbers(place)
            near = (x for x in found if np.allclose(numbers, x.numbers, rtol=CARRIED, atol=CARRIED))
            if (spot := next(near, None)) is None:
                body = _short(link.name)
                told = name if name not in GENERIC else body if is_node(link.name) else f"{body}.{name}"
                found.append(spot := Spot(told, place, numbers, set()))
            spot.bodies.add(i)
        return tuple(found)

    def is_truss(self, bodies: frozenset[int]) -> bool:
        """Whether they are nodes of a truss."""
        links = self.system.motion.links
        return all(i < len(links) and is_node(links[i].name) for i in bodies)

    def _numbers(self, vector: Vector) -> np.ndarray:
        """The first two components at all samples, (2, n)."""
        return self.samples.flat(vector[:2])

    # -- what is cut free --------------------------------------------------------------------------------

    def _parts(self) -> Iterator[frozenset[int]]:
        links = self.system.motion.links
        n, truss = len(links), any(is_node(link.name) for link in links)
        sizes = range(1, n + 1) if n <= MOST_BODIES else (1, n) if truss else (1, 2, n)
        found = {frozenset(some): None for size in sizes for some in combinations(range(n), size)}
        yield from (bodies for bodies in found if self._hangs_together(bodies))
        for bodies in self._separated() if truss else ():
            if bodies not in found and sum(self._is_cut(each, bodies) for each in self.acting) <= MOST_CUT:
                found[bodies] = None
                yield bodies

    @staticmethod
    def _is_cut(acting: ActingForce, bodies: frozenset[int]) -> bool:
        """Whether it acts between these bodies and others."""
        return acting.kind == "reaction" and 0 < len(acting.on(bodies)) < len(acting.pushes)

    def _hangs_together(self, bodies: frozenset[int]) -> bool:
        reached, joined = {min(bodies)}, [{push.body for push in each.pushes} & bodies for each in self.acting]
        for _ in bodies:
            reached |= {i for some in joined if some & reached for i in some}
        return reached == bodies

    def _separated(self) -> Iterator[frozenset[int]]:
        """What lies on one side of straight lines."""
        places = [self._numbers(link.pose.p)[:, 0] for link in self.system.motion.links]
        for angle in np.arange(CUTS) * np.pi / CUTS:
            far = [x * np.cos(angle) + y * np.sin(angle) for x, y in places]
            for level in sorted(far)[1:]:
                yield frozenset(i for i, x in enumerate(far) if x < level - CARRIED)

    def _called(self, bodies: frozenset[int]) -> str:
        links = self.system.motion.links
        names = [_short(links[i].name) for i in sorted(bodies)]
        if len(names) == len(links) > 1:
            return "the whole"
        if not self.is_truss(bodies):
            return " and ".join(names)
        return f"node {names[0]}" if len(names) == 1 else f"the part with {', '.join(names)}"

    def _directions(self, bodies: frozenset[int]) -> Iterator[tuple[str, Vector]]:
        """The directions of balances of forces, each once, those of the structure first."""
        own: list[tuple[str, Vector]] = [
            (each.name, push.unit)
            for each in self.acting
            for push in each.on(bodies)[:1]
            if push.unit is not None and not push.is_couple
        ]
        links = [self.system.motion.links[i] for i in sorted(bodies)]
        own += [(f"the axis of {x.name}", vector_of(row[0] for row in x.pose.R)) for x in links if not is_node(x.name)]
        axes: list[tuple[str, Vector]] = [("along x", (1, 0, 0)), ("along y", (0, 1, 0))]
        known = [self._numbers(e) for _, e in axes]
        for told, along in own:
            for how, e in (("along", along), ("across", (-along[1], along[0], 0))):
                numbers = self._numbers(e)
                numbers = numbers / np.maximum(np.linalg.norm(numbers, axis=0), CARRIED)
                if all(np.abs(np.sum(numbers * x, axis=0)).min() < 1 - CARRIED for x in known):
                    known.append(numbers)
                    yield f"{how} {told}", e
        yield from axes


def _short(body: str) -> str:
    """A body, or a node without its truss."""
    return body.rpartition(".")[2]
