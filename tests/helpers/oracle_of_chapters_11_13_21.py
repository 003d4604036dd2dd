"""Chapters 11, 13 and 21 and the inertia of the notes, in numbers from the statements; nothing of eomgen is used here.

Each function gives what its exercise asks at given numbers of its parameters. Three plain tools serve all:

- `Plane`: the velocity fields that the contacts and the given velocities allow to rigid bodies, by least squares that
  leave nothing over;
- `Cloud`: particles at the points of a Gauss rule, which integrate x^2, x y, ... over a body exactly, so that every
  moment of inertia is a sum over particles;
- `Structure` of float_statics: the balance of every body and joint, whose only solution are the reactions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise

import numpy as np
from float_statics import Numbers, Structure, Vector, the_solution

ORACLES: dict[str, Callable[[Numbers], Numbers]] = {}


def oracle(function: Callable[[Numbers], Numbers]) -> Callable[[Numbers], Numbers]:
    """Puts a system into ORACLES under the name of its model file."""
    ORACLES[function.__name__] = function
    return function


# -- velocities of plane mechanisms --------------------------------------------------------------------------------

Place = tuple[float, float]


class Plane:
    """Bodies with the unknown velocity (a, b) of the point at the origin and spin w: v(x, y) = (a - w y, b + w x)."""

    def __init__(self, *bodies: str) -> None:
        self.bodies, self.rows, self.right = bodies, [], []

    def row(self, body: str, at: Place, direction: Place) -> Vector:
        """direction . v of the body's point as a row of coefficients."""
        row = np.zeros(3 * len(self.bodies))
        (x, y), (dx, dy) = at, direction
        k = 3 * self.bodies.index(body)
        row[k : k + 3] = dx, dy, dy * x - dx * y
        return row

    def know(self, row: Vector, value: float = 0.0) -> None:
        self.rows.append(row)
        self.right.append(value)

    def fixed(self, body: str, at: Place) -> None:
        """A hinge on the ground."""
        for direction in ((1, 0), (0, 1)):
            self.know(self.row(body, at, direction))

    def hinge(self, at: Place, *bodies: str) -> None:
        """A hinge of two or more bodies."""
        for one, other in pairwise(bodies):
            for direction in ((1, 0), (0, 1)):
                self.know(self.row(one, at, direction) - self.row(other, at, direction))

    def roller(self, body: str, at: Place, normal: Place) -> None:
        self.know(self.row(body, at, normal))

    def link(self, one: tuple[str, Place], other: tuple[str, Place]) -> None:
        """A rigid massless bar: no velocity of one end against the other along it."""
        along = (other[1][0] - one[1][0], other[1][1] - one[1][1])
        self.know(self.row(*one, along) - self.row(*other, along))

    def spin(self, body: str, value: float) -> None:
        row = np.zeros(3 * len(self.bodies))
        row[3 * self.bodies.index(body) + 2] = 1
        self.know(row, value)

    def solved(self) -> Field:
        found = the_solution(self.rows, self.right)
        return Field({name: found[3 * k : 3 * k + 3] for k, name in enumerate(self.bodies)})


class Field:
    """Known velocity fields of the bodies of a plane mechanism."""

    def __init__(self, motions: dict[str, Vector]) -> None:
        self.motions = motions

    def omega(self, body: str) -> float:
        return self.motions[body][2]

    def v(self, body: str, at: Place) -> tuple[float, float]:
        a, b, w = self.motions[body]
        return a - w * at[1], b + w * at[0]

    def centre(self, body: str, other: str | None = None) -> tuple[float, float]:
        """Where the two bodies (or the body and the ground) have the same velocity."""
        a, b, w = self.motions[body] - (self.motions[other] if other else 0)
        return -b / w, a / w


def named(letter_of: dict[str, tuple[float, float]]) -> Numbers:
    """{"v_A": (vx, vy)} as {"v_A_x": vx, "v_A_y": vy}."""
    return {f"{name}_{axis}": part for name, pair in letter_of.items() for axis, part in zip("xy", pair, strict=True)}


@oracle
def ch11_p1(_: Numbers) -> Numbers:
    """Bar I about A, bar II hinged to it at C and on a roller at E; the answers do not depend on the rate chosen."""
    A, C, D, E = (0, 0), (5, 3), (7, 3), (7, 0)
    plane = Plane("I", "II")
    plane.fixed("I", A)
    plane.hinge(C, "I", "II")
    plane.roller("II", E, (0, 1))
    plane.spin("I", 1)
    v = plane.solved()
    centres = named({"c01": v.centre("I"), "c12": v.centre("I", "II"), "c02": v.centre("II")})
    return centres | {"y2": v.centre("II")[1] - D[1], "omega2_over_omega1": v.omega("II") / v.omega("I")}


@oracle
def ch11_p2(_: Numbers) -> Numbers:
    """Two bars about fixed hinges, their ends joined by a rigid link."""
    A, C, D, E = (0, 0), (2, 3), (6, 4), (8, 0)
    plane = Plane("I", "II")
    plane.fixed("I", A)
    plane.fixed("II", E)
    plane.link(("I", C), ("II", D))
    plane.spin("I", 1)
    v = plane.solved()
    centres = named({"c01": v.centre("I"), "c02": v.centre("II"), "c12": v.centre("I", "II")})
    return centres | {"omega2_over_omega1": v.omega("II") / v.omega("I")}


@oracle
def ch11_p3(_: Numbers) -> Numbers:
    """Crank, bar, and a body on two rollers, which can only slide to the side."""
    O, A, B = (0, 0), (4, 6), (9, 6)
    plane = Plane("I", "II", "III")
    plane.fixed("I", O)
    plane.hinge(A, "I", "II")
    plane.hinge(B, "II", "III")
    plane.roller("III", (10, 4), (0, 1))
    plane.roller("III", (15, 4), (0, 1))
    plane.spin("I", -2)
    v = plane.solved()
    centre = v.centre("II")
    spins = {f"omega{k}": v.omega("I" * k) for k in (1, 2, 3)}
    found = named({"c02": centre, "c13": v.centre("I", "III"), "v_A": v.v("I", A), "v_B": v.v("III", B)})
    return found | spins | {"y2": centre[1] - A[1]}


@oracle
def ch11_p4(_: Numbers) -> Numbers:
    """Three bodies on one hinge; x2 from D, y3 above C: the distances with which the book finds the two centres."""
    A, B, C, D, E, F = (0, 0), (5, 5), (5, 9), (7, 9), (11, 5), (11, 2)
    plane = Plane("I", "II", "III")
    plane.fixed("I", A)
    plane.hinge(B, "I", "II", "III")
    plane.roller("II", D, (1, 0))
    plane.roller("III", F, (0, 1))
    plane.know(plane.row("II", D, (0, 1)), 10)
    v = plane.solved()
    spins = {f"omega{k}": v.omega("I" * k) for k in (1, 2, 3)}
    points = {"v_B": v.v("I", B), "v_C": v.v("II", C), "v_D": v.v("II", D), "v_E": v.v("III", E), "v_F": v.v("III", F)}
    return named(points) | spins | {"x2": v.centre("II")[0] - D[0], "y3": v.centre("III")[1] - C[1]}


@oracle
def ch11_p5(_: Numbers) -> Numbers:
    """Four-bar linkage."""
    O, A, B, C, M = (0, 0), (3, 4), (9, 4), (9, 0), (6, 6)
    plane = Plane("I", "II", "III")
    plane.fixed("I", O)
    plane.hinge(A, "I", "II")
    plane.hinge(B, "II", "III")
    plane.fixed("III", C)
    plane.spin("I", 3)
    v = plane.solved()
    points = {"c02": v.centre("II"), "v_A": v.v("I", A), "v_B": v.v("III", B), "v_M": v.v("II", M)}
    return named(points) | {"omega2": v.omega("II"), "omega3": v.omega("III")}


@oracle
def ch11_p6(_: Numbers) -> Numbers:
    """Crank, bar with its end guided on a line, bar, rocker."""
    O, A, B, C, D = (0, 0), (2, 2), (6, 0), (10, 4), (13, 0)
    plane = Plane("I", "II", "III", "IV")
    plane.fixed("I", O)
    plane.hinge(A, "I", "II")
    plane.hinge(B, "II", "III")
    plane.roller("II", B, (0, 1))
    plane.hinge(C, "III", "IV")
    plane.fixed("IV", D)
    plane.spin("I", -2)
    v = plane.solved()
    spins = {"omega2": v.omega("II"), "omega3": v.omega("III"), "omega4": v.omega("IV")}
    return named({"v_A": v.v("I", A), "v_B": v.v("II", B), "v_C": v.v("IV", C)}) | spins


# -- moments of inertia --------------------------------------------------------------------------------------------


class Cloud:
    """Particles (mass, place) that stand for a body in every integral of a polynomial up to the second degree."""

    def __init__(self, masses: Iterable[float], places: Iterable[Sequence[float]]) -> None:
        self.m, self.r = np.array(list(masses)), np.array([(*place, 0.0)[:3] for place in places], dtype=float)

    @property
    def mass(self) -> float:
        return self.m.sum()

    def scaled(self, factor: float) -> Cloud:
        return Cloud(factor * self.m, self.r)

    def __add__(self, other: Cloud) -> Cloud:
        return Cloud(np.concatenate([self.m, other.m]), np.concatenate([self.r, other.r]))

    def seen_from(self, point: Sequence[float]) -> Vector:
        return self.r - np.array((*point, 0.0)[:3], dtype=float)

    def tensor(self, point: Sequence[float]) -> Vector:
        """sum m (r^2 delta - r r), off the diagonal minus the products."""
        r = self.seen_from(point)
        second = np.einsum("k,ki,kj->ij", self.m, r, r)
        return np.trace(second) * np.eye(3) - second

    def about_axis(self, point: Sequence[float], direction: Sequence[float]) -> float:
        """sum m (distance from the axis)^2, by the cross product."""
        e = np.array((*direction, 0.0)[:3], dtype=float)
        return float(self.m @ (np.cross(self.seen_from(point), e / np.linalg.norm(e)) ** 2).sum(axis=1))

    def polar(self, point: Sequence[float]) -> float:
        return float(self.m @ (self.seen_from(point)[:, :2] ** 2).sum(axis=1))

    def product(self, point: Sequence[float]) -> float:
        """+ sum m x y."""
        r = self.seen_from(point)
        return float(self.m @ (r[:, 0] * r[:, 1]))

    def centre(self) -> Vector:
        return self.m @ self.r / self.mass


NODES, WEIGHTS = np.polynomial.legendre.leggauss(3)


def segment(start: Place, end: Place) -> Cloud:
    """A bar, its mass its length."""
    a, b = np.array(start, dtype=float), np.array(end, dtype=float)
    return Cloud(WEIGHTS / 2 * np.linalg.norm(b - a), [(a + b) / 2 + s * (b - a) / 2 for s in NODES])


def plate(corners: Sequence[Place]) -> Cloud:
    """A quadrangle, its mass its area; two corners may fall together (a triangle)."""
    P = np.array(corners, dtype=float)
    masses, places = [], []
    for s, ws in zip(NODES, WEIGHTS, strict=True):
        for t, wt in zip(NODES, WEIGHTS, strict=True):
            shape = np.array([(1 - s) * (1 - t), (1 + s) * (1 - t), (1 + s) * (1 + t), (1 - s) * (1 + t)]) / 4
            by_s = np.array([-(1 - t), 1 - t, 1 + t, -(1 + t)]) / 4 @ P
            by_t = np.array([-(1 - s), -(1 + s), 1 + s, 1 - s]) / 4 @ P
            masses.append(ws * wt * abs(by_s[0] * by_t[1] - by_s[1] * by_t[0]))
            places.append(shape @ P)
    return Cloud(masses, places)


def triangle(a: Place, b: Place, c: Place) -> Cloud:
    return plate([a, b, c, c])


def disc(centre: Place, radius: float) -> Cloud:
    """A round plate, its mass its area: Gauss along the radius, equal steps of the angle."""
    masses, places = [], []
    for s, w in zip(NODES, WEIGHTS, strict=True):
        r = radius * (1 + s) / 2
        for angle in np.arange(8) * np.pi / 4:
            masses.append(w * radius / 2 * r * np.pi / 4)
            places.append((centre[0] + r * np.cos(angle), centre[1] + r * np.sin(angle)))
    return Cloud(masses, places)


def block(a: float, b: float, c: float) -> Cloud:
    """A block with a corner at the origin, its mass its volume."""
    grid = [(x, y, z) for x in range(3) for y in range(3) for z in range(3)]
    masses = [WEIGHTS[x] * WEIGHTS[y] * WEIGHTS[z] * a * b * c / 8 for x, y, z in grid]
    places = [(a * (1 + NODES[x]) / 2, b * (1 + NODES[y]) / 2, c * (1 + NODES[z]) / 2) for x, y, z in grid]
    return Cloud(masses, places)


def in_plane(body: Cloud, point: Sequence[float]) -> Numbers:
    """J_x, J_y, J_C, J_xy about the point."""
    x, y = body.about_axis(point, (1, 0)), body.about_axis(point, (0, 1))
    return {"J_x": x, "J_y": y, "J_C": body.polar(point), "J_xy": body.product(point)}


@oracle
def ch13_b1(n: Numbers) -> Numbers:
    bar = segment((0, 0), (n["l"], 0)).scaled(n["M"] / n["l"])
    return in_plane(bar, (n["l"] / 2, 0))


@oracle
def ch13_b2(n: Numbers) -> Numbers:
    b, h = n["b"], n["h"]
    return in_plane(plate([(0, 0), (b, 0), (b, h), (0, h)]).scaled(n["M"] / (b * h)), (b / 2, h / 2))


@oracle
def ch13_b3(n: Numbers) -> Numbers:
    body = triangle((0, 0), (n["b"], 0), (0, n["h"]))
    body = body.scaled(n["M"] / body.mass)
    legs = {"J_x1": body.about_axis((0, 0), (1, 0)), "J_y1": body.about_axis((0, 0), (0, 1))}
    return legs | {"J_x1y1": body.product((0, 0))} | in_plane(body, body.centre()[:2])


@oracle
def ch13_b4(n: Numbers) -> Numbers:
    body = disc((0, 0), n["R"])
    return in_plane(body.scaled(n["M"] / body.mass), (0, 0))


@oracle
def ch13_p1(n: Numbers) -> Numbers:
    """The areas share the plate's net mass; a hole is a plate of negative mass."""
    a = n["a"]
    whole, hole = plate([(6 * a, -3 * a), (18 * a, -3 * a), (18 * a, 3 * a), (6 * a, 3 * a)]), disc((15 * a, 0), a)
    density = n["m_plate"] / (whole.mass - hole.mass)
    bar = segment((0, 0), (6 * a, 0)).scaled(n["m_bar"] / (6 * a))
    body = bar + whole.scaled(density) + hole.scaled(-density)
    return {"M2": density * whole.mass, "M3": density * hole.mass, "J_O": body.polar((0, 0))}


@oracle
def ch13_p2(n: Numbers) -> Numbers:
    a = n["a"]
    rectangle = plate([(0, 0), (6 * a, 0), (6 * a, -12 * a), (0, -12 * a)])
    wing = triangle((6 * a, 0), (9 * a, 0), (6 * a, -12 * a))
    hole = disc((3 * a, -3 * a), a)
    density = n["M"] / (rectangle.mass + wing.mass - hole.mass)
    body = (rectangle + wing + hole.scaled(-1)).scaled(density)
    masses = {f"M{k}": density * part.mass for k, part in enumerate((rectangle, wing, hole), start=1)}
    about = in_plane(body, (0, 0))
    return masses | {x: about[x] for x in ("J_x", "J_y", "J_xy")} | {"J_Delta": body.about_axis((0, 0), (1, -2))}


@oracle
def ch13_p3(n: Numbers) -> Numbers:
    bar = segment((0, 0), (n["l"], 0)).scaled(n["m_bar"] / n["l"])
    ring = disc((n["d"], 0), n["R"]) + disc((n["d"], 0), n["r"]).scaled(-1)
    return {"J_O": (bar + ring.scaled(n["m_ring"] / ring.mass)).polar((0, 0))}


@oracle
def ch13_p4(n: Numbers) -> Numbers:
    a = n["a"]
    square = plate([(0, 0), (6 * a, 0), (6 * a, 6 * a), (0, 6 * a)])
    body = square + triangle((6 * a, 6 * a), (3 * a, 6 * a), (6 * a, 3 * a)).scaled(-1)
    body = body.scaled(n["M"] / body.mass)
    about = in_plane(body, (0, 0))
    return {x: about[x] for x in ("J_x", "J_y", "J_xy")} | {"J_Delta": body.about_axis((0, 0), (1, 1))}


def tensor(prefix: str, I: Vector, entries: str) -> Numbers:
    return {f"{prefix}_{entry}": I["xyz".index(entry[0]), "xyz".index(entry[1])] for entry in entries.split()}


@oracle
def s1_inertia_tensor(n: Numbers) -> Numbers:
    body = block(n["a"], n["b"], n["c"])
    body = body.scaled(n["M"] / body.mass)
    corner = tensor("Ik", body.tensor((0, 0, 0)), "xx yy zz xy xz yz")
    return tensor("Ic", body.tensor((n["a"] / 2, n["b"] / 2, n["c"] / 2)), "xx yy zz") | corner


@oracle
def s1_particles(n: Numbers) -> Numbers:
    """L = sum m r x v and T = sum m v^2/2 with v = omega x r, particle by particle."""
    a, m = n["a"], n["m"]
    body = Cloud([m, 2 * m, m], [(a, a, 0), (0, a, a), (a, 0, a)])
    v = np.cross([0, 0, n["omega0"]], body.r)
    L = body.m @ np.cross(body.r, v)
    found = {"L_x": L[0], "L_y": L[1], "L_z": L[2], "T": float(body.m @ (v**2).sum(axis=1)) / 2}
    return tensor("I", body.tensor((0, 0, 0)), "xx yy zz xy xz yz") | found


@oracle
def s1_parallel_axis(n: Numbers) -> Numbers:
    a = n["a"]
    body = block(a, a, a).scaled(n["M"] / a**3)
    centre = body.about_axis((a / 2, a / 2, a / 2), (0, 0, 1))
    diagonal = body.about_axis((0, 0, 0), (1, 1, 1))
    return {"I_edge": body.about_axis((0, 0, 0), (0, 0, 1)), "I_diagonal": diagonal, "I_centre": centre}


@oracle
def s1_principal_axes(n: Numbers) -> Numbers:
    a = n["a"]
    I = plate([(0, 0), (a, 0), (a, a), (0, a)]).scaled(n["M"] / a**2).tensor((0, 0, 0))
    values, columns = np.linalg.eigh(I)
    axes = {(1, 1, 0): 0, (1, -1, 0): 1, (0, 0, 1): 2}
    for axis, k in axes.items():
        assert np.linalg.norm(np.cross(columns[:, k], axis)) < 1e-9
    return tensor("I", I, "xx xy") | {f"I_{k + 1}": values[k] for k in range(3)}


# -- statics -------------------------------------------------------------------------------------------------------


def truss(nodes: dict[int, Place], members: str, loads: dict[int, Place], pin: int, roller: int) -> Numbers:
    """Member forces "1-2", tension positive, and reactions, by the method of joints."""
    s = Structure(joints=tuple(nodes))
    s.truss(nodes, members)
    s.pin("R", nodes[pin], str(pin))
    s.put("roller", str(roller), nodes[roller], (0, 1))
    for k, force in loads.items():
        s.load(str(k), nodes[k], force)
    return s.solved()


@oracle
def ch21_p1(n: Numbers) -> Numbers:
    p, a = n["p"], n["a"]
    s = Structure()
    s.put("A", "AC", (0, 0), (0, 1))
    s.put("B", "AC", (4 * a, 0), (0, 1))
    s.pin("C", (10 * a, 0), "AC", "CD")
    s.pin("D", (16 * a, 0), "CD", "DE")
    s.clamp("E", (20 * a, 0), "DE")
    for body, x, y in (("AC", 4, 10), ("CD", 10, 16), ("DE", 16, 20)):
        s.spread(body, (x * a, 0), (y * a, 0), (0, -p))
    r = s.solved()
    return {"V_A": r["A"], "V_B": r["B"], "V_E": r["E_y"], "M_E": -r["E_couple"], "H_E": r["E_x"]}


@oracle
def ch21_p2(n: Numbers) -> Numbers:
    p, a = n["p"], n["a"]
    s = Structure()
    s.clamp("A", (0, 0), "AB")
    s.pin("B", (4 * a, 0), "AB", "BD")
    s.put("C", "BD", (10 * a, 0), (0, 1))
    s.pin("D", (12 * a, 0), "BD", "DE")
    s.put("E", "DE", (18 * a, 0), (0, 1))
    s.spread("AB", (0, 0), (4 * a, 0), (0, -p))
    s.spread("DE", (12 * a, 0), (18 * a, 0), (0, -p))
    s.load("BD", (7 * a, 0), (0, -6 * p * a))
    r = s.solved()
    return {"V_A": r["A_y"], "M_A": r["A_couple"], "V_C": r["C"], "V_E": r["E"]}


@oracle
def ch21_p3(n: Numbers) -> Numbers:
    p, a = n["p"], n["a"]
    s = Structure()
    s.pin("A", (0, 0), "I")
    s.pin("C", (4 * a, 6 * a), "I", "II")
    s.pin("D", (10 * a, 6 * a), "II", "III")
    s.clamp("B", (14 * a, 0), "III")
    for body, x, y in (("I", 0, 4), ("II", 4, 10), ("III", 10, 14)):
        s.spread(body, (x * a, 6 * a), (y * a, 6 * a), (0, -p))
    s.load("III", (14 * a, 4 * a), (-8 * p * a, 0))
    s.load("I", (0, 0), couple=(0, 0, -12 * p * a**2))
    r = s.solved()
    return {"V_A": r["A_y"], "H_A": r["A_x"], "V_B": r["B_y"], "H_B": r["B_x"], "M_B": -r["B_couple"]}


@oracle
def ch21_p4(n: Numbers) -> Numbers:
    p, a = n["p"], n["a"]
    s = Structure()
    s.pin("A", (0, 0), "I")
    s.pin("C", (4 * a, 4 * a), "I", "II")
    s.pin("B", (10 * a, 0), "II")
    s.spread("I", (0, 4 * a), (4 * a, 4 * a), (0, -p))
    s.load("I", (0, 4 * a), (3 * p * a, 0))
    s.load("II", (7 * a, 4 * a), (0, -6 * p * a))
    r = s.solved()
    return {"V_A": r["A_y"], "H_A": r["A_x"], "V_B": r["B_y"], "H_B": r["B_x"]}


P5_NODES = {
    1: (0, 0),
    3: (3, 0),
    5: (6, 0),
    7: (9, 0),
    9: (12, 0),
    11: (15, 0),
    13: (18, 0),
    2: (3, 1),
    4: (6, 2),
    6: (9, 3),
    8: (12, 4),
    10: (15, 4),
    12: (18, 4),
}
P5_MEMBERS = "1-3 3-5 5-7 7-9 9-11 11-13 1-2 2-4 4-6 6-8 8-10 10-12 2-3 4-5 6-7 8-9 10-11 12-13 2-5 4-7 6-9 9-10 11-12"
P6_NODES = {1: (0, 0), 3: (3, 0), 5: (6, 0), 7: (9, 0), 8: (12, 0), 2: (3, 4), 4: (6, 4), 6: (9, 4)}
P6_MEMBERS = "1-3 3-5 5-7 7-8 2-4 4-6 1-2 6-8 2-3 4-5 6-7 2-5 5-6"


@oracle
def ch21_p5(n: Numbers) -> Numbers:
    P, a = n["P"], n["a"]
    nodes = {k: (a * x, a * y) for k, (x, y) in P5_NODES.items()}
    others = {2: (0, -4 * P), 6: (0, -6 * P), 12: (-3 * P, 0)}
    r = truss(nodes, P5_MEMBERS, others | {8: (0, -12 * P)}, 1, 13)
    moved = truss(nodes, P5_MEMBERS, others | {9: (0, -12 * P)}, 1, 13)
    found = {"N79": r["7-9"], "N69": r["6-9"], "N89": r["8-9"], "N9_10": r["9-10"]}
    return found | {"N89_if_12P_at_joint9": moved["8-9"], "R1_x": r["R_x"], "R1_y": r["R_y"], "R13_y": r["roller"]}


@oracle
def ch21_p6(n: Numbers) -> Numbers:
    P, a = n["P"], n["a"]
    nodes = {k: (a * x, a * y) for k, (x, y) in P6_NODES.items()}
    r = truss(nodes, P6_MEMBERS, {3: (0, -6 * P), 5: (0, -9 * P), 2: (3 * P, 0)}, 1, 8)
    members = {f"N{i}{j}": r[f"{i}-{j}"] for i, j in ("24", "25", "35", "45", "56")}
    return members | {"R8_y": r["roller"], "R1_y": r["R_y"], "R1_x": r["R_x"]}
