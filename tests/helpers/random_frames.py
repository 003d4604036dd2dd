"""Random frames of straight members, hinged to one another and held; as a model, and in floats."""

from __future__ import annotations

from copy import deepcopy
from fractions import Fraction
from random import Random

import numpy as np
from float_statics import Structure, Vector, three

DIRECTIONS = (
    (1, 0),
    (Fraction(3, 5), Fraction(4, 5)),
    (Fraction(4, 5), Fraction(-3, 5)),
    (0, 1),
    (0, -1),
    (Fraction(-3, 5), Fraction(4, 5)),
    (Fraction(-5, 13), Fraction(-12, 13)),
)
NORMALS = ((0, 1), (1, 0), (3, 4), (1, -2))
STIFF = 0.03  # of the smallest singular value of a frame that is taken

Effect = tuple[float, str, Vector, float]
"""(x along the member, unknown or "", force, couple)"""
Line = tuple[float, float, Vector, Vector]
"""(from x, to x, force per length there): a linear load"""


class RandomFrame:
    """A model's text and the same frame in floats: every member with what acts along it.

    Args:
        members: one hinged to another, at an end or between.
    """

    def __init__(self, rng: Random, members: int) -> None:
        self.rng = rng
        self.floats = Structure()
        self.length = [rng.randint(3, 8) for _ in range(members)]
        self.way = [rng.choice(DIRECTIONS) for _ in range(members)]
        self.start = [(Fraction(0), Fraction(0))]
        self.stations: list[list[Fraction]] = [[Fraction(0), Fraction(n)] for n in self.length]
        self.effects: list[list[Effect]] = [[] for _ in range(members)]
        self.lines: list[list[Line]] = [[] for _ in range(members)]
        self.constraints: list[str] = []
        self.forces: list[str] = []
        for i in range(1, members):
            self._hinge(i)
        missing = 3 * members - 2 * (members - 1)
        while missing > 0:
            missing -= self._support(missing)

    # -- places --------------------------------------------------------------------------------------

    def at(self, i: int, x: Fraction) -> tuple[Fraction, Fraction]:
        (a, b), (c, s) = self.start[i], self.way[i]
        return a + x * c, b + x * s

    def place(self, i: int, x: float) -> Vector:
        return np.array([float(k) for k in self.at(i, Fraction(x))])

    def _station(self, i: int, x: Fraction | None = None) -> tuple[str, Fraction]:
        """A point of the member by name, and where it is along it."""
        x = Fraction(self.rng.randint(0, 2 * self.length[i]), 2) if x is None else x
        if x not in self.stations[i]:
            self.stations[i].append(x)
        return f"m{i}.S{self.stations[i].index(x)}", x

    # -- what holds it -------------------------------------------------------------------------------

    def _hinge(self, i: int) -> None:
        """The start of the member on one before it."""
        other = self.rng.randrange(i)
        point, x = self._station(other)
        self.start.append(self.at(other, x))
        self.constraints.append(f'h{i} = {{ kind = "pin", points = ["m{i}.S0", "{point}"] }}')
        for k, e in enumerate(np.eye(2)):
            self._unit(f"h{i}_{k}", i, Fraction(0), e)
            self._unit(f"h{i}_{k}", other, x, -e)

    def _support(self, most: int) -> int:
        i = self.rng.randrange(len(self.length))
        point, x = self._station(i)
        name = f"s{len(self.constraints)}"
        kind = self.rng.choice(("support", "support", "pin", "clamp")[: most + 1])
        if kind == "support":
            n = self.rng.choice(NORMALS)
            self.constraints.append(f'{name} = {{ kind = "support", point = "{point}", normal = {list(n)} }}')
            self._unit(name, i, x, np.array(n) / np.hypot(*n))
            return 1
        self.constraints.append(f'{name} = {{ kind = "{kind}", points = ["{point}"] }}')
        for k, e in enumerate(np.eye(2)):
            self._unit(f"{name}_{k}", i, x, e)
        if kind == "clamp":
            self._unit(f"{name}_couple", i, x, np.zeros(2), 1.0)
        return 2 if kind == "pin" else 3

    def _unit(self, unknown: str, i: int, x: Fraction, force: Vector, couple: float = 0.0) -> None:
        self.floats.put(unknown, f"m{i}", self.place(i, float(x)), force, (0, 0, couple))
        self.effects[i].append((float(x), unknown, three(force), couple))

    # -- what acts on it -----------------------------------------------------------------------------

    def load(self, count: int) -> None:
        """Forces, couples and linear loads, on members at random."""
        for k in range(count):
            i = self.rng.randrange(len(self.length))
            getattr(self, self.rng.choice(("_force", "_couple", "_line")))(f"f{k}", i)

    def _force(self, name: str, i: int) -> None:
        """A force in the ground's axes, or in those of the member."""
        point, x = self._station(i)
        fx, fy = self.rng.randint(-9, 9), self.rng.randint(-9, 9)
        own = self.rng.random() < 0.4
        axes = f', axes = "m{i}"' if own else ""
        self.forces.append(f'{name} = {{ kind = "force", point = "{point}", force = ["{fx}*P", "{fy}*P"]{axes} }}')
        t, n = self.axes(i)
        force = fx * t + fy * n if own else three((fx, fy))
        self.floats.load(f"m{i}", self.place(i, float(x)), force)
        self.effects[i].append((float(x), "", force, 0.0))

    def _couple(self, name: str, i: int) -> None:
        point, x = self._station(i)
        size = self.rng.randint(-9, 9)
        where = f'body = "m{i}", couple = "{size}*P*a", point = "{point.partition(".")[2]}"'
        self.forces.append(f'{name} = {{ kind = "couple", {where} }}')
        self.floats.load(f"m{i}", self.place(i, float(x)), couple=(0, 0, size))
        self.effects[i].append((float(x), "", np.zeros(3), float(size)))

    def _line(self, name: str, i: int) -> None:
        (p, a), (q, b) = self._station(i), self._station(i)
        if a == b:
            return self._line(name, i)
        loads = [[self.rng.randint(-6, 6) for _ in range(2)] for _ in range(2)]
        values = ", ".join(f'["{x}*P/a", "{y}*P/a"]' for x, y in loads)
        between = ", ".join(f'"{point.partition(".")[2]}"' for point in (p, q))
        line = f'body = "m{i}", between = [{between}], intensities = [{values}]'
        self.forces.append(f'{name} = {{ kind = "distributed", {line} }}')
        first, last = (three(v) for v in loads)
        self.floats.spread(f"m{i}", self.place(i, float(a)), self.place(i, float(b)), first, last)
        self.lines[i].append((float(a), float(b), first, last) if a < b else (float(b), float(a), last, first))
        return None

    # -- in floats -----------------------------------------------------------------------------------

    def axes(self, i: int) -> tuple[Vector, Vector]:
        """Along the member, and to its left."""
        c, s = (float(k) for k in self.way[i])
        return np.array([c, s, 0.0]), np.array([-s, c, 0.0])

    def section(self, i: int, x: float) -> tuple[float, float, float]:
        """N = -F_t, V = F_n, M = sum of F_n (x - s) - couples: of all that acts before the section."""
        found = self.floats.solved()
        t, n = self.axes(i)
        force, moment = np.zeros(3), 0.0
        for s, unknown, f, couple in self.effects[i]:
            if s < x:
                size = found[unknown] if unknown else 1.0
                force, moment = force + size * f, moment + size * ((x - s) * (f @ n) - couple)
        for a, b, q0, q1 in self.lines[i]:
            for s, share in _gauss(a, min(b, x)):
                f = share * (q0 + (s - a) / (b - a) * (q1 - q0))
                force, moment = force + f, moment + (x - s) * (f @ n)
        return -force @ t, force @ n, moment

    def under_unit_load(self, i: int, x: float) -> RandomFrame:
        """The frame with nothing on it but 1 downward at a place of a member."""
        found = deepcopy(self)
        found.floats.loads, found.lines = {}, [[] for _ in self.lines]
        found.effects = [[e for e in effects if e[1]] for effects in self.effects]
        found.floats.load(f"m{i}", self.place(i, x), (0, -1))
        found.effects[i].append((x, "", three((0, -1)), 0.0))
        return found

    @property
    def is_stiff(self) -> bool:
        _, G, _ = self.floats.equations()
        return G.shape[0] == G.shape[1] and np.linalg.svd(G, compute_uv=False)[-1] > STIFF

    # -- as a model ----------------------------------------------------------------------------------

    @property
    def text(self) -> str:
        lines = ["eomgen = 1", 'name = "random frame"', 'space = "plane"', "[parameters]", "P = 1", "a = 1"]
        for i, stations in enumerate(self.stations):
            (x, y), (c, s) = self.start[i], self.way[i]
            points = ", ".join(f'S{k} = ["{station}*a", 0]' for k, station in enumerate(stations))
            joint = f'kind = "placed", at = ["({x})*a", "({y})*a"], angle = "atan2({s}, {c})"'
            lines += [f"[bodies.m{i}]", f"points = {{ {points} }}", 'line = ["S0", "S1"]', f"joint = {{ {joint} }}"]
        return "\n".join([*lines, "[constraints]", *self.constraints, "[forces]", *self.forces]) + "\n"


def _gauss(a: float, b: float) -> list[tuple[float, float]]:
    """(place, weight) by which polynomials of the third degree are integrated exactly; none where b <= a."""
    half, middle = (b - a) / 2, (a + b) / 2
    return [(middle - half / 3**0.5, half), (middle + half / 3**0.5, half)] if b > a else []


def stiff_frame(seed: int, members: int, loads: int = 5) -> RandomFrame:
    """A frame that its hinges and supports hold, and no more than these."""
    rng = Random(seed)
    while True:
        frame = RandomFrame(rng, members)
        if frame.is_stiff:
            frame.load(loads)
            return frame
