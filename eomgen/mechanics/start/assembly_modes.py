"""System, start -> Branches: the ways in which the loops close while the independent coordinates stay."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import BodyLink, SystemScene
from eomgen.mechanics.state import Doubles, Split
from eomgen.model import PointForce
from eomgen.symbolic.expression import Node, Scalar, State, is_zero, jacobian, symbols_of
from eomgen.symbolic.numeric import FLOAT, Newton, all_roots, evaluate, tolerances

# -------- assembly modes --------------------------------------------------------------------------------------
# System, start -> Branches: in which ways the loops close while the independent coordinates stay.
#
# Ways that meet in a dead centre differ in the sign of det d phi/dq over the coordinates that follow. Sought from
# many places by Newton's method: those named exist; where there are many, others may. Positions in which branches
# meet are left out.


TRIES = 30  # for each coordinate that follows
MOST = 8  # of these
CLOSING_IN_FLOATS = Newton(enough=tolerances.GAP_CLOSED, steps=40, again=True)


@dataclass(frozen=True)
class AssemblyMode:
    """One way to close the loops.

    Args:
        values: of the coordinates that follow.
        sign: of det d phi/dq over them; 0 where rows are redundant: no choice of them is independent everywhere.
        words: the values as their user writes them.
        sides: on which side links of the plane are pinned together.
    """

    values: Mapping[str, float]
    sign: int
    words: str = ""
    sides: tuple[AssemblySide, ...] = ()

    def __str__(self) -> str:
        return self.words + {1: " (+)", -1: " (-)", 0: ""}[self.sign]

    def in_words(self, sided: Collection[str]) -> str:
        """beta = 0.48, gamma = 1.57 (-), 'B' on the left; with the sides of these pins."""
        sides = [
            f"'{s.constraint}' on the {'left' if s.left else 'right'}" for s in self.sides if s.constraint in sided
        ]
        return ", ".join([str(self), *sides])


@dataclass(frozen=True)
class Branches:
    """The ways to close the loops of a model at its start.

    Args:
        kept: the coordinates that stay.
        here, others: that of the start, and the other ones found.
    """

    kept: tuple[str, ...]
    here: AssemblyMode
    others: tuple[AssemblyMode, ...]

    @property
    def sided(self) -> tuple[str, ...]:
        """The pins that do not lie on the same side in all ways."""
        here = {side.constraint: side.left for side in self.here.sides}
        others = [{side.constraint: side.left for side in each.sides} for each in self.others]
        return tuple(name for name, left in here.items() if any(each.get(name, left) != left for each in others))

    @staticmethod
    def of(system: System, start: Mapping[str, float]) -> Branches | None:
        """The branches with the start's independent coordinates; None where none follow, or too many.

        Args:
            start: coordinates at which the loops are closed.
        Raises:
            MissingValues: parameters without values.
        """
        search = _search(system, start)
        if search is None:
            return None
        rng = Random(1)
        starts = (search.scattered(rng) for _ in range(TRIES * len(search.sought)))
        found = all_roots(
            search.other, starts, lambda place: float(np.linalg.norm(search.apart(place, search.here))), search.same
        )
        return Branches(search.kept, search.branch(search.here), tuple(map(search.branch, found)))


@dataclass(frozen=True)
class _Search:
    """Search for other ways in which the loops close.

    Args:
        system: the system of the loops.
        gaps, derivatives: phi, and its derivatives by the coordinates sought.
        rows: indices of the independent gaps.
        agreeing: scalars that are positive where hinges and welds are not turned over.
        here: the place of the start.
        turns: mask of the coordinates sought that are angles.
        reach: largest distance of lengths from their values at the start.
    """

    system: System
    gaps: tuple[Any, ...]
    derivatives: tuple[Any, ...]
    rows: tuple[int, ...]
    known: State
    sought: tuple[Node, ...]
    kept: tuple[str, ...]
    agreeing: tuple[Scalar, ...]
    here: np.ndarray
    turns: np.ndarray
    reach: float

    def scattered(self, rng: Random) -> np.ndarray:
        shifts = [rng.uniform(-math.pi, math.pi) if turn else rng.uniform(-1, 1) * self.reach for turn in self.turns]
        return np.asarray(self.here + np.array(shifts))

    def closed(self, place: np.ndarray) -> np.ndarray | None:
        """The regular place to which Newton's method leads, angles as near to the start's as they can be."""
        found = CLOSING_IN_FLOATS.root(self, place)
        if not found.met or not self.is_regular(self.slopes(found.x)) or not self._is_upright(found.x):
            return None
        return np.asarray(self.here + self.apart(found.x, self.here))

    def other(self, place: np.ndarray) -> np.ndarray | None:
        """The same where it is another one than the start's."""
        found = self.closed(place)
        return None if found is None or self.same(found, self.here) else found

    def left(self, place: np.ndarray) -> Sequence[float]:
        """The gaps."""
        return evaluate(self.gaps, self._state(place), FLOAT)

    def slopes(self, place: np.ndarray) -> np.ndarray:
        """Their derivatives by what is sought."""
        return self._at(place)[1]

    def moved(self, place: np.ndarray, step: Sequence[float]) -> np.ndarray:
        return np.asarray(place + np.array(step))

    def is_regular(self, J: np.ndarray) -> bool:
        """True if no other branch meets this one there, judged by the slopes against those at the start."""
        scale = np.linalg.norm(self._at(self.here)[1], axis=0)
        sizes = np.linalg.svd(J / np.where(scale > 0, scale, 1.0), compute_uv=False)
        return bool(sizes[-1] > tolerances.BRANCHES_MEET * sizes[0])

    def _is_upright(self, place: np.ndarray) -> bool:
        return all(x > 0 for x in evaluate(self.agreeing, self._state(place), FLOAT))

    def _state(self, place: np.ndarray) -> State:
        return self.known | dict(zip(self.sought, place.tolist(), strict=True))

    def _at(self, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values = np.array(evaluate((*self.gaps, *self.derivatives), self._state(place), FLOAT), dtype=float)
        k = len(self.gaps)
        return values[:k], values[k:].reshape(k, -1)

    def apart(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """The difference, whole turns left out."""
        d = one - other
        return np.asarray(np.where(self.turns, (d + np.pi) % (2 * np.pi) - np.pi, d))

    def same(self, one: np.ndarray, other: np.ndarray) -> bool:
        return bool(np.max(np.abs(self.apart(one, other))) < tolerances.SAME_PLACE)

    def branch(self, place: np.ndarray) -> AssemblyMode:
        values = {q.name: _plain(x) for q, x in zip(self.sought, place, strict=True)}
        words = ", ".join(f"{name} = {self.system.scope.model.in_own_unit(name, x, 6)}" for name, x in values.items())
        reported = words, assembly_sides(self.system, self._state(place))
        if len(self.rows) < len(self.gaps):
            return AssemblyMode(values, 0, *reported)
        return AssemblyMode(values, 1 if np.linalg.det(self._at(place)[1]) > 0 else -1, *reported)


def _plain(x: float) -> float:
    """A value found by an iteration; what is rounding of it is 0."""
    return float(x) if abs(x) > tolerances.SOLVED else 0.0


def _search(system: System, start: Mapping[str, float]) -> _Search | None:
    gaps, symbols = system.constraints.gaps, system.symbols
    standing = set(symbols_of(gaps))
    free = [q for q in system.constraints.movable if q in standing]
    if not gaps or not free or system.scope.quaternions:
        return None
    p = system.scope.model.numeric_parameters()
    known: State = {symbols.parameters[name]: value for name, value in p.items()} | {symbols.t: 0.0}
    known |= dict(zip(symbols.inputs.values(), evaluate(tuple(system.inputs.values()), known, FLOAT), strict=True))
    known |= {q: start[q.name] for q in symbols.q}
    split = _split(system, free, Doubles(known).array(jacobian(gaps, free), len(free)))
    sought = [free[k] for k in split.following]
    if not 0 < len(sought) <= MOST:
        return None
    slopes = tuple(x for row in jacobian(gaps, sought) for x in row)
    turns = np.array([_is_angle(gaps, known, q) for q in sought])
    lengths = [abs(known[q]) for q in free] + [abs(x) for x in p.values()]
    here = np.array([known[q] for q in sought])
    kept = tuple(q.name for q in free if q not in sought)
    agreeing = tuple(
        x
        for name, constraint in system.scope.model.constraints.items()
        for x in constraint.agreeing(SystemScene(system.motion, f"constraints.{name}"))
    )
    reach = 2 * max(lengths, default=1.0)
    return _Search(system, gaps, slopes, split.rows, known, tuple(sought), kept, agreeing, here, turns, reach)


def _split(system: System, free: Sequence[Node], J: np.ndarray) -> Split:
    """The coordinates that follow from the others: dependent ones, then those without a given start, then others."""
    dependent = system.scope.dependent

    def place(k: int) -> tuple[bool, bool, int]:
        return free[k].name not in dependent, not system.scope.model.is_guess(free[k].name), -k

    return Split.in_order(J, sorted(range(len(free)), key=place), tolerances.RANK_NEARBY)


def _is_angle(gaps: Sequence[Any], known: State, q: Node) -> bool:
    """True if a whole turn of the coordinate changes no gap."""
    before, after = (evaluate(gaps, {**known, q: known[q] + turn}, FLOAT) for turn in (0.3, 0.3 + 2 * math.pi))
    return bool(np.allclose(before, after, atol=tolerances.COMPUTED))


# -------- assembly sides --------------------------------------------------------------------------------------
# System, a place -> the side of the line between their own hinges on which two links of the plane are pinned together.
#
# The pin R of two links that turn about P and Q lies to the left or to the right of the line from P to Q. That
# distinguishes the two ways in which such a pair closes (open and crossed, elbow up and down). In line, the pair is in
# a dead centre.


@dataclass(frozen=True)
class AssemblySide:
    """Side of the line PQ on which a pin R lies.

    Args:
        constraint: the pin.
        first, second: the bodies with the hinges P and Q.
        left: True if R is to the left of the way from P to Q.
    """

    constraint: str
    first: str
    second: str
    left: bool


def assembly_sides(system: System, state: Mapping[Node, Any]) -> tuple[AssemblySide, ...]:
    """Side of each constraint that pins two turning bodies of a plane system together; () in space."""
    if system.scope.model.space != "plane":
        return ()
    found: dict[str, AssemblySide] = {}
    for row in system.constraints.rows:
        pushes = [push for push in row.pushes if isinstance(push, PointForce)]
        links = _joined(system, pushes)
        if row.identical or row.constraint in found or len(links) != 2 or not all(map(_turns, links)):
            continue
        left = _is_left(system, state, links, pushes)
        found |= (
            {} if left is None else {row.constraint: AssemblySide(row.constraint, links[0].name, links[1].name, left)}
        )
    return tuple(found.values())


def _joined(system: System, pushes: list[PointForce]) -> list[BodyLink]:
    """The bodies that a row pushes, the ground left out."""
    names = dict.fromkeys(push.place[0] for push in pushes)
    return [system.motion.link(name) for name in names if name is not None]


def _turns(link: BodyLink) -> bool:
    return len(link.S) == 1 and not is_zero(link.S[0][0][2])


def _is_left(system: System, state: Mapping[Node, Any], links: list[BodyLink], pushes: list[PointForce]) -> bool | None:
    """True if R is on the left; None in line, and where the bodies are not pinned at one point."""
    ends = [link.pose.point(push.place[1]) for link in links for push in pushes if push.place[0] == link.name]
    hinges = [link.pose.point(link.point) for link in links]
    flat: tuple[Scalar, ...] = tuple(x for point in (*hinges, *ends) for x in point[:2])
    numbers = [float(x) for x in evaluate(flat, state, FLOAT)]
    P, Q, R, *others = [complex(*numbers[k : k + 2]) for k in range(0, len(numbers), 2)]
    area = ((Q - P).conjugate() * (R - P)).imag
    size = max(abs(Q - P), abs(R - P)) ** 2
    if any(abs(other - R) ** 2 > tolerances.COMPUTED * size for other in others):
        return None
    return None if abs(area) <= tolerances.COMPUTED * size else area > 0
