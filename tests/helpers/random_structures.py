"""Random structures: bodies held by hinges, supports, clamps and bars, with loads; as a model, and in floats."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import numpy as np
from float_statics import Structure, Vector

Place = tuple[Fraction, ...]
NORMALS = {
    2: ((0, 1), (1, 0), (3, 4), (1, 2), (-2, 1), (1, -1)),
    3: ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 2), (1, -1, 0)),
}
STIFF = 0.03  # of the smallest singular value of a structure that is taken
HALVES = 12


class RandomStructure:
    """A model's text and the same structure in floats.

    Args:
        space: in space; else in the plane.
        spare: supports more than are needed; less where negative.
    """

    def __init__(self, rng: Random, *, bodies: int, space: bool = False, spare: int = 0) -> None:
        self.rng, self.n, self.size = rng, bodies, 3 if space else 2
        self.floats = Structure(space)
        self.points: list[list[Place]] = [[] for _ in range(bodies)]
        self.frames = [self._place() if rng.random() < 0.5 else (Fraction(0),) * self.size for _ in range(bodies)]
        self.constraints: list[str] = []
        self.forces: list[str] = []
        for i in range(1, bodies):
            self._hinge(i)
        each = 6 if space else 3
        missing = bodies * each - (bodies - 1) * self.size + spare
        while missing > 0:
            missing -= self._support(missing)
        for k in range(rng.randint(2, 4)):
            self._load(k)

    # -- as a model ----------------------------------------------------------------------------------

    @property
    def text(self) -> str:
        space = "space" if self.size == 3 else "plane"
        lines = ["eomgen = 1", 'name = "random structure"', f'space = "{space}"', "[parameters]", "P = 1", "a = 1"]
        for i, (frame, points) in enumerate(zip(self.frames, self.points, strict=True)):
            named = ", ".join(f"P{k} = {_vector(_minus(p, frame))}" for k, p in enumerate(points))
            joint = f'joint = {{ kind = "placed", at = {_vector(frame)} }}'
            lines += [f"[bodies.b{i}]", joint, f"points = {{ {named} }}"]
        return "\n".join([*lines, "[constraints]", *self.constraints, "[forces]", *self.forces]) + "\n"

    def _point(self, body: int, at: Place) -> str:
        self.points[body].append(at)
        return f"b{body}.P{len(self.points[body]) - 1}"

    def _place(self) -> Place:
        return tuple(Fraction(self.rng.randint(-HALVES, HALVES), 2) for _ in range(self.size))

    # -- what holds it -------------------------------------------------------------------------------

    def _hinge(self, body: int) -> None:
        other, at = self.rng.randrange(body), self._place()
        name = f"h{len(self.constraints)}"
        points = f'"{self._point(body, at)}", "{self._point(other, at)}"'
        self.constraints.append(f'{name} = {{ kind = "pin", points = [{points}] }}')
        self.floats.pin(name, _numbers(at), f"b{body}", f"b{other}")

    def _support(self, most: int) -> int:
        """A support; how many components it has."""
        kinds = [self._roller, self._bar]
        kinds += [self._pin] if most >= self.size else []
        kinds += [self._clamp] if most >= 3 and self.size == 2 else []
        return self.rng.choice(kinds)(f"s{len(self.constraints)}", self.rng.randrange(self.n), self._place())

    def _clamp(self, name: str, body: int, at: Place) -> int:
        self.constraints.append(f'{name} = {{ kind = "clamp", point = "{self._point(body, at)}" }}')
        self.floats.clamp(name, _numbers(at), f"b{body}")
        return 3

    def _pin(self, name: str, body: int, at: Place) -> int:
        self.constraints.append(f'{name} = {{ kind = "pin", points = ["{self._point(body, at)}"] }}')
        self.floats.pin(name, _numbers(at), f"b{body}")
        return self.size

    def _roller(self, name: str, body: int, at: Place) -> int:
        normal = self.rng.choice(NORMALS[self.size])
        self.constraints.append(
            f'{name} = {{ kind = "support", point = "{self._point(body, at)}", normal = {list(normal)} }}'
        )
        n = np.array(normal, dtype=float)
        self.floats.put(name, f"b{body}", _numbers(at), n / np.linalg.norm(n))
        return 1

    def _bar(self, name: str, body: int, at: Place) -> int:
        """A bar to another body, or a roller where there is none."""
        others = [i for i in range(self.n) if i != body]
        if not others:
            return self._roller(name, body, at)
        other, far = self.rng.choice(others), self._place()
        while far == at:
            far = self._place()
        points = f'"{self._point(body, at)}", "{self._point(other, far)}"'
        self.constraints.append(f'{name} = {{ kind = "link", points = [{points}] }}')
        self.floats.bar(name, (f"b{body}", _numbers(at)), (f"b{other}", _numbers(far)))
        return 1

    # -- what acts on it -----------------------------------------------------------------------------

    def _load(self, k: int) -> None:
        body = self.rng.randrange(self.n)
        kind = self.rng.choice(("force", "couple", "spread"))
        if kind == "force":
            at, force = self._place(), self._place()
            point = self._point(body, at)
            self.forces.append(f'f{k} = {{ kind = "force", point = "{point}", force = {_vector(force, "P")} }}')
            self.floats.load(f"b{body}", _numbers(at), _numbers(force))
        elif kind == "couple":
            size = Fraction(self.rng.randint(-9, 9), 3)
            value = f'"{size}*P*a"' if self.size == 2 else f'[0, "{size}*P*a", "P*a"]'
            self.forces.append(f'f{k} = {{ kind = "couple", body = "b{body}", couple = {value} }}')
            couple = (0, 0, float(size)) if self.size == 2 else (0, float(size), 1)
            self.floats.load(f"b{body}", (0, 0, 0), couple=couple)
        else:
            ends, loads = (self._place(), self._place()), (self._place(), self._place())
            names = ", ".join(f'"{self._point(body, at).partition(".")[2]}"' for at in ends)
            values = ", ".join(_vector(q, "P/a") for q in loads)
            line = f'body = "b{body}", between = [{names}], intensities = [{values}]'
            self.forces.append(f'f{k} = {{ kind = "distributed", {line} }}')
            self.floats.spread(f"b{body}", *map(_numbers, ends), *map(_numbers, loads))

    @property
    def singular_values(self) -> np.ndarray:
        """Of the equations of all bodies."""
        return np.linalg.svd(self.floats.equations()[1], compute_uv=False)


def determinate(seed: int, *, bodies: int, space: bool = False) -> RandomStructure:
    """A structure that its reactions hold, and no more than these."""
    rng = Random(seed)
    while True:
        found = RandomStructure(rng, bodies=bodies, space=space)
        _, G, _ = found.floats.equations()
        if G.shape[0] == G.shape[1] and found.singular_values[-1] > STIFF:
            return found


def _vector(values: Place, unit: str = "a") -> str:
    return f"[{', '.join(f'{chr(34)}{v}*{unit}{chr(34)}' for v in values)}]"


def _minus(a: Place, b: Place) -> Place:
    return tuple(x - y for x, y in zip(a, b, strict=True))


def _numbers(values: Place) -> Vector:
    return np.array([float(x) for x in values])
