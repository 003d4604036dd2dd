"""Mass, mass centre and inertia of the declared shapes, by formulas of handbooks; the oracle's own.

Imports nothing of eomgen. Inertia about the mass centre, in body axes, 3 x 3.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np

Properties = tuple[float, np.ndarray, np.ndarray]


def of_shape(shape: dict, number: Callable, vectors: Callable) -> Properties:
    """(m, com, I) of a shape's table; `number` reads a field, `vectors` a list of vectors."""
    m = number(shape["mass"]) if "mass" in shape else 0.0
    f = {key: number(x) for key, x in shape.items() if key not in ("kind", "mass", "vertices", "size", "semiaxes")}
    listed = {key: vectors(shape[key]) for key in ("vertices", "size", "semiaxes") if key in shape}
    com, moments = FORMULAS[shape["kind"]](f, listed)
    return m, np.array(com, dtype=float), m * (np.diag(moments) if np.ndim(moments) == 1 else np.array(moments))


def _flat(x: float, y: float) -> list[float]:
    return [x, y, x + y]


def _rod(f: dict, _: dict) -> tuple:
    i = f["length"] ** 2 / 12
    return [f["length"] / 2, 0, 0], [0, i, i]


def _triangle(f: dict, _: dict) -> tuple:
    b, h = f["width"], f["height"]
    xx, yy, xy = h * h / 18, b * b / 18, b * h / 36
    return [b / 3, h / 3, 0], [[xx, xy, 0], [xy, yy, 0], [0, 0, xx + yy]]


def _polygon(_: dict, listed: dict) -> tuple:
    """Sums over the triangles from the first vertex."""
    points = [np.array([*v[:2], 0.0]) for v in listed["vertices"]]
    area, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for b, c in itertools.pairwise(points):
        a = points[0]
        part = np.cross(b - a, c - a)[2] / 2
        s = a + b + c
        area += part
        first += part * s / 3
        second += part * (np.outer(s, s) + np.outer(a, a) + np.outer(b, b) + np.outer(c, c)) / 12
    com = first / area
    second = second / area - np.outer(com, com)
    return com, np.trace(second) * np.eye(3) - second


def _arc(f: dict, _: dict) -> tuple:
    r, o = f["radius"], f["opening"]
    x = r * np.sin(o / 2) / (o / 2)
    yy, xx = r * r * (1 + np.sin(o) / o) / 2, r * r * (1 - np.sin(o) / o) / 2
    return [x, 0, 0], [xx, yy - x * x, r * r - x * x]


def _sector(f: dict, _: dict) -> tuple:
    r, o = f["radius"], f["opening"]
    x = 2 * r * np.sin(o / 2) / (3 * o / 2)
    yy, xx = r * r * (1 + np.sin(o) / o) / 4, r * r * (1 - np.sin(o) / o) / 4
    return [x, 0, 0], [xx, yy - x * x, r * r / 2 - x * x]


def _hollow(f: dict, _: dict) -> tuple:
    R, r = f["radius"], f["inner"]
    return [0, 0, 0], [2 * (R**5 - r**5) / (5 * (R**3 - r**3))] * 3


def _tube(f: dict, _: dict) -> tuple:
    q = f["radius"] ** 2 + f["inner"] ** 2
    side = q / 4 + f["length"] ** 2 / 12
    return [0, 0, 0], [side, side, q / 2]


def _frustum(f: dict, _: dict) -> tuple:
    """By Gauss' points over the height: exact for polynomials."""
    x, w = np.polynomial.legendre.leggauss(6)
    z, w = f["height"] * (x + 1) / 2, w / 2
    r = f["radius"] + (f["top"] - f["radius"]) * (x + 1) / 2
    volume = w @ r**2
    com = w @ (r**2 * z) / volume
    axial = w @ r**4 / 2 / volume
    side = axial / 2 + w @ (r**2 * z**2) / volume - com**2
    return [0, 0, com], [side, side, axial]


def _tetrahedron(_: dict, listed: dict) -> tuple:
    points = np.array([list(v) for v in listed["vertices"]], dtype=float)
    com = points.mean(axis=0)
    d = points - com
    second = d.T @ d / 20
    return com, np.trace(second) * np.eye(3) - second


def _prism(f: dict, listed: dict) -> tuple:
    com, flat = _polygon(f, listed)
    second = np.trace(flat) / 2 * np.eye(3) - flat
    second[2, 2] = f["length"] ** 2 / 12
    return com, np.trace(second) * np.eye(3) - second


FORMULAS: dict[str, Callable] = {
    "particle": lambda f, _: ([0, 0, 0], [0, 0, 0]),
    "rod": _rod,
    "disc": lambda f, _: ([0, 0, 0], _flat(f["radius"] ** 2 / 4, f["radius"] ** 2 / 4)),
    "ring": lambda f, _: ([0, 0, 0], _flat(f["radius"] ** 2 / 2, f["radius"] ** 2 / 2)),
    "rectangle": lambda f, _: ([0, 0, 0], _flat(f["height"] ** 2 / 12, f["width"] ** 2 / 12)),
    "triangle": _triangle,
    "polygon": _polygon,
    "sphere": lambda f, _: ([0, 0, 0], [0.4 * f["radius"] ** 2] * 3),
    "cylinder": lambda f, _: _tube(f | {"inner": 0.0}, {}),
    "box": lambda _, v: ([0, 0, 0], [(sum(x * x for x in v["size"]) - x * x) / 12 for x in v["size"]]),
    "cone": lambda f, _: (
        [0, 0, 0],
        [*[3 * f["radius"] ** 2 / 20 + 3 * f["height"] ** 2 / 80] * 2, 0.3 * f["radius"] ** 2],
    ),
    "ellipsoid": lambda _, v: (
        [0, 0, 0],
        [(sum(x * x for x in v["semiaxes"]) - x * x) / 5 for x in v["semiaxes"]],
    ),
    "arc": _arc,
    "annulus": lambda f, _: ([0, 0, 0], _flat(*[(f["radius"] ** 2 + f["inner"] ** 2) / 4] * 2)),
    "sector": _sector,
    "ellipse": lambda _, v: ([0, 0, 0], _flat(v["semiaxes"][1] ** 2 / 4, v["semiaxes"][0] ** 2 / 4)),
    "hollow_sphere": _hollow,
    "spherical_shell": lambda f, _: ([0, 0, 0], [2 * f["radius"] ** 2 / 3] * 3),
    "hemisphere": lambda f, _: (
        [0, 0, 3 * f["radius"] / 8],
        [*[83 * f["radius"] ** 2 / 320] * 2, 0.4 * f["radius"] ** 2],
    ),
    "hemispherical_shell": lambda f, _: (
        [0, 0, f["radius"] / 2],
        [*[5 * f["radius"] ** 2 / 12] * 2, 2 * f["radius"] ** 2 / 3],
    ),
    "tube": _tube,
    "cylindrical_shell": lambda f, _: _tube(f | {"inner": f["radius"]}, {}),
    "prism": _prism,
    "conical_shell": lambda f, _: (
        [0, 0, 0],
        [*[f["radius"] ** 2 / 4 + f["height"] ** 2 / 18] * 2, f["radius"] ** 2 / 2],
    ),
    "frustum": _frustum,
    "pyramid": lambda f, _: (
        [0, 0, 0],
        [
            f["depth"] ** 2 / 20 + 3 * f["height"] ** 2 / 80,
            f["width"] ** 2 / 20 + 3 * f["height"] ** 2 / 80,
            (f["width"] ** 2 + f["depth"] ** 2) / 20,
        ],
    ),
    "tetrahedron": _tetrahedron,
    "torus": lambda f, _: (
        [0, 0, 0],
        [*[f["major"] ** 2 / 2 + 5 * f["minor"] ** 2 / 8] * 2, f["major"] ** 2 + 3 * f["minor"] ** 2 / 4],
    ),
}


def of_parts(mass: float | None, parts: list[tuple[dict, Properties, float]]) -> Properties:
    """(m, com, I) of pieces: (table, (m, com, I) at its place, sign)."""
    m = sum(sign * p[0] for _, p, sign in parts)
    com = sum((sign * p[0] * p[1] for _, p, sign in parts), np.zeros(3)) / m
    inertia = np.zeros((3, 3))
    for _, (own, at, moment), sign in parts:
        d = at - com
        inertia += sign * (moment + own * (d @ d * np.eye(3) - np.outer(d, d)))
    return m, com, inertia


def turned(R: np.ndarray, inertia: np.ndarray) -> np.ndarray:
    return R @ inertia @ R.T
