"""Shapes: mass, mass centre and inertia against independent integrals and against one another."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from each import each
from scipy.integrate import dblquad, tplquad

from eomgen.model import shapes
from eomgen.model.shapes import (
    ALL,
    Box,
    Cone,
    Cylinder,
    Disc,
    Ellipsoid,
    Polygon,
    Rectangle,
    Ring,
    Rod,
    Sphere,
    Triangle,
)
from eomgen.proof.masses import filled
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.expression.rational import Fraction


def shown(path: Path) -> dict[str, Any]:
    """The fields of a shape in its example, parameters by their values."""
    model = tomllib.loads(path.read_text(encoding="utf-8"))
    known = {name: given["value"] for name, given in model.get("parameters", {}).items()}

    def valued(x: Any) -> Any:
        return [valued(y) for y in x] if isinstance(x, list) else known.get(x, x) if isinstance(x, str) else x

    (fields,) = (b["shape"] for b in model["bodies"].values() if b.get("shape", {}).get("kind") == path.stem)
    return {name: valued(x) for name, x in fields.items() if name != "kind"}


ROOT = Path(__file__).parent.parent
PATHS = {cls: ROOT / "docs" / "examples" / f"{cls.kind}.toml" for cls in ALL}
SHAPES = tuple(cls for cls in ALL if PATHS[cls].exists())
EXAMPLES = {cls.kind: shown(PATHS[cls]) for cls in SHAPES if cls.kind not in ("polygon", "tetrahedron")}
EXAMPLES |= {  # less even than those that are drawn
    "polygon": {"mass": 3, "vertices": [[1, 0], [3, 1], [2, 4], [0, 2]]},
    "tetrahedron": {"mass": 3, "vertices": [[0, 0, 0], [3, 0, 0], [1, 2, 0], [1, 1, 4]]},
}
PI = Graph().pi


def value(expression):
    return expression.evaluate({"pi": 3.141592653589793})


def exactly(expression):
    return expression.evaluate({"pi": PI})


def properties(shape):
    return shape.mass_properties(value)


def moment_tensor(m, measure, integral):
    """I_ij = m / measure * integral of (r.r delta_ij - x_i x_j), from the six second moments."""
    xx, yy, zz, xy, yz, zx = (m / measure * integral(f) for f in SECOND)
    return [[yy + zz, -xy, -zx], [-xy, zz + xx, -yz], [-zx, -yz, xx + yy]]


SECOND = (
    lambda x, y, z: x * x,
    lambda x, y, z: y * y,
    lambda x, y, z: z * z,
    lambda x, y, z: x * y,
    lambda x, y, z: y * z,
    lambda x, y, z: z * x,
)


def test_every_shape_has_an_example():
    """docs/examples/KIND.toml: the laws below are asked of the shape in it."""
    assert not [f"write {PATHS[cls].relative_to(ROOT)}" for cls in ALL if cls not in SHAPES]


@each("cls", SHAPES)
def test_a_shape_is_exact_and_has_the_points_of_its_names(cls):
    """No float comes in; `points` gives what `point_names` promises; `center` is the mass centre."""
    shape = cls(**EXAMPLES[cls.kind])
    found, points = shape.mass_properties(exactly), shape.points(exactly)
    assert set(points) == set(shape.point_names)
    assert points["center"] == found.com and points["origin"] == (0, 0, 0)
    entries = [x for row in (*found.I, found.com, (found.m, shape.measure(exactly))) for x in row]
    assert all(isinstance(x, int | Fraction | Node) for x in entries)


@each("cls", SHAPES)
def test_an_inertia_is_symmetric_and_obeys_the_triangle_inequality(cls):
    """I = I^T and I_xx <= I_yy + I_zz, and so on round."""
    tensor = properties(cls(**EXAMPLES[cls.kind])).I
    assert all(tensor[i][j] == tensor[j][i] for i in range(3) for j in range(3))
    xx, yy, zz = (tensor[i][i] for i in range(3))
    assert xx <= yy + zz and yy <= zz + xx and zz <= xx + yy


@each(
    "shape, radius_at",
    [
        (Cone(**EXAMPLES["cone"]), lambda z: 0.5 * (1.5 - z) / 2),  # base at -h/4, apex at 3h/4
        (Sphere(**EXAMPLES["sphere"]), lambda z: max(0.0, 0.25 - z * z) ** 0.5),
        (Cylinder(**EXAMPLES["cylinder"]), lambda z: 0.5),
    ],
)
def test_round_solids_agree_with_the_integral_over_their_volume(shape, radius_at):
    """I = (m / V) times the integral of (r.r 1 - r r^T) dV about the origin, which is the mass centre."""
    low, high = {"cone": (-0.5, 1.5), "sphere": (-0.5, 0.5), "cylinder": (-1.0, 1.0)}[shape.kind]

    def integral(f):
        from math import cos, pi, sin

        return tplquad(
            lambda a, r, z: r * f(r * cos(a), r * sin(a), z), low, high, 0, radius_at, 0, 2 * pi, epsabs=1e-8
        )[0]

    volume = integral(lambda x, y, z: 1.0)
    assert integral(lambda x, y, z: z) == pytest.approx(0, abs=1e-7)
    expected, found = moment_tensor(3, volume, integral), properties(shape).I
    assert all(float(found[i][j]) == pytest.approx(expected[i][j], abs=1e-6) for i in range(3) for j in range(3))


def test_a_triangle_agrees_with_the_integral_over_its_area():
    """Right angle at the origin, legs along +x and +y; the tensor's product is minus the integral of x y."""
    w, h = 2.0, 1.5
    found = properties(Triangle(**EXAMPLES["triangle"]))
    cx, cy = float(found.com[0]), float(found.com[1])

    def integral(f):
        return dblquad(lambda y, x: f(x - cx, y - cy, 0.0), 0, w, 0, lambda x: h * (1 - x / w))[0]

    assert integral(lambda x, y, z: x) == pytest.approx(0, abs=1e-9) == integral(lambda x, y, z: y)
    expected = moment_tensor(3, w * h / 2, integral)
    assert all(float(found.I[i][j]) == pytest.approx(expected[i][j]) for i in range(3) for j in range(3))


@each("turn", [1, -1])
def test_a_polygon_is_a_triangle_or_a_rectangle_where_it_looks_like_one(turn):
    """Green's sums give the plates' own formulas, whichever way round the vertices are given."""
    triangle = [[0, 0], [2, 0], [0, "3/2"]][::turn]
    rectangle = [[-1, "-3/4"], [1, "-3/4"], [1, "3/4"], [-1, "3/4"]][::turn]
    assert properties(Polygon(mass=3, vertices=triangle)) == properties(Triangle(**EXAMPLES["triangle"]))
    assert properties(Polygon(mass=3, vertices=rectangle)) == properties(Rectangle(**EXAMPLES["rectangle"]))


def test_solids_without_thickness_are_plates_and_rods():
    """A cylinder without length is a disc, without radius a rod; a box without height a rectangle (to 1e-12)."""
    flat, line = Cylinder(mass=3, radius="1/2", length="1e-9"), Cylinder(mass=3, radius="1e-9", length=2)
    pairs = [
        (properties(flat).I, properties(Disc(**EXAMPLES["disc"])).I),
        (properties(Box(mass=3, size=[2, "3/2", "1e-9"])).I, properties(Rectangle(**EXAMPLES["rectangle"])).I),
    ]
    for found, expected in pairs:
        assert all(abs(found[i][j] - expected[i][j]) < 1e-12 for i in range(3) for j in range(3))
    assert abs(properties(line).I[0][0] - properties(Rod(mass=3, length=2)).I[1][1]) < 1e-12


def test_an_ellipsoid_with_equal_axes_is_a_sphere_and_a_ring_has_all_its_mass_outside():
    """2/5 m r^2 both ways; I_zz of the hoop is m r^2."""
    assert properties(Ellipsoid(mass=3, semiaxes=["1/2"] * 3)) == properties(Sphere(**EXAMPLES["sphere"]))
    assert properties(Ring(**EXAMPLES["ring"])).I[2][2] == Fraction(3, 4)


# -- every shape against an integral over what it is made of -----------------------------------------


def turned_about_z(profile):
    """The solid between z0 and z1 whose section at z is the ring from r0(z) to r1(z), as midpoints with volumes."""
    z0, z1, inner, outer = profile
    n = 400
    z = z0 + (z1 - z0) * (np.arange(n) + 0.5) / n
    r0, r1 = np.vectorize(inner)(z), np.vectorize(outer)(z)
    share = (np.arange(n) + 0.5) / n
    squares = r0[:, None] ** 2 + (r1**2 - r0**2)[:, None] * share  # equal areas in r^2
    volume = np.pi * (r1**2 - r0**2)[:, None] * (z1 - z0) / n / n * np.ones_like(squares)
    return around(np.sqrt(squares), z[:, None] * np.ones_like(squares), volume)


def around(r, z, weight):
    """Rings of the radius r at the height z: second moments of a whole turn."""
    m = weight.sum()
    return (
        m,
        (0, 0, (weight * z).sum() / m),
        np.diag([(weight * r * r).sum() / 2, (weight * r * r).sum() / 2, (weight * z * z).sum()]),
    )


def mantle(z0, z1, radius):
    """The surface whose radius at the height z is given."""
    n = 4000
    edges = z0 + (z1 - z0) * np.arange(n + 1) / n
    r = np.vectorize(radius)(edges)
    slant = np.hypot(np.diff(edges), np.diff(r))
    middle, z = (r[1:] + r[:-1]) / 2, (edges[1:] + edges[:-1]) / 2
    return around(middle, z, 2 * np.pi * middle * slant)


def fan(radius, opening, thick):
    """A sector, or its arc, about the centre of the circle; +x halves the opening."""
    n = 1500
    angle = opening * ((np.arange(n) + 0.5) / n - 0.5)
    r = radius * np.sqrt((np.arange(n) + 0.5) / n)[:, None] if thick else np.array([[radius]])
    x, y = r * np.cos(angle), r * np.sin(angle)
    weight = np.full(x.shape, (opening * radius**2 / 2 if thick else opening * radius) / x.size)
    second = np.diag([(weight * x * x).sum(), (weight * y * y).sum(), 0])
    return weight.sum(), ((weight * x).sum() / weight.sum(), 0, 0), second


def corners(vertices):
    """A solid simplex, by the moments of its Duffy points."""
    n = 60
    t, w = np.polynomial.legendre.leggauss(n)
    t, w = (t + 1) / 2, w / 2
    a, b, c = np.meshgrid(t, t, t, indexing="ij")
    weight = np.einsum("i,j,k->ijk", w * (1 - t) ** 2, w * (1 - t), w)
    shares = np.stack([(1 - a) * (1 - b) * (1 - c), a, (1 - a) * b, (1 - a) * (1 - b) * c])
    vertices = np.array(vertices, dtype=float)
    p = np.einsum("vijk,vd->dijk", shares, vertices)
    weight = weight * abs(np.linalg.det(vertices[1:] - vertices[0]))
    m = weight.sum()
    return m, tuple((weight * x).sum() / m for x in p), np.array([[(weight * x * y).sum() for y in p] for x in p])


def block(width, depth, z0, z1, share):
    """Rectangles of which the sides are a share of the whole at the height z."""
    n = 4000
    z = z0 + (z1 - z0) * (np.arange(n) + 0.5) / n
    k = np.vectorize(share)(z)
    area = width * depth * k * k * (z1 - z0) / n
    m = area.sum()
    x = (area * (width * k) ** 2 / 12).sum()
    return m, (0, 0, (area * z).sum() / m), np.diag([x, (area * (depth * k) ** 2 / 12).sum(), (area * z * z).sum()])


INTEGRALS = {
    "disc": lambda: turned_about_z((-1e-6, 1e-6, lambda z: 0, lambda z: 0.5)),
    "annulus": lambda: turned_about_z((-1e-6, 1e-6, lambda z: 0.5, lambda z: 2)),
    "sector": lambda: fan(2, 2 * np.pi / 3, True),
    "arc": lambda: fan(2, 2 * np.pi / 3, False),
    "hollow_sphere": lambda: turned_about_z(
        (-2, 2, lambda z: max(0, 0.25 - z * z) ** 0.5, lambda z: max(0, 4 - z * z) ** 0.5)
    ),
    "spherical_shell": lambda: mantle(-2, 2, lambda z: max(0, 4 - z * z) ** 0.5),
    "hemisphere": lambda: turned_about_z((0, 2, lambda z: 0, lambda z: max(0, 4 - z * z) ** 0.5)),
    "hemispherical_shell": lambda: mantle(0, 2, lambda z: max(0, 4 - z * z) ** 0.5),
    "tube": lambda: turned_about_z((-1.5, 1.5, lambda z: 0.5, lambda z: 2)),
    "cylindrical_shell": lambda: mantle(-1.5, 1.5, lambda z: 2),
    "conical_shell": lambda: mantle(-1, 2, lambda z: 2 * (2 - z) / 3),
    "frustum": lambda: turned_about_z((0, 3, lambda z: 0, lambda z: 2 - z / 3)),
    "torus": lambda: turned_about_z(
        (-0.5, 0.5, lambda z: 2 - max(0, 0.25 - z * z) ** 0.5, lambda z: 2 + max(0, 0.25 - z * z) ** 0.5)
    ),
    "pyramid": lambda: block(2, 1, -0.75, 2.25, lambda z: (2.25 - z) / 3),
    "box": lambda: block(1, 2, -1.5, 1.5, lambda z: 1),
    "tetrahedron": lambda: corners([[0, 0, 0], [3, 0, 0], [1, 2, 0], [1, 1, 4]]),
}


@each("kind", INTEGRALS)
def test_a_shape_agrees_with_the_integral_over_what_it_is_made_of(kind):
    """Measure, mass centre and I = (m / measure) (tr P 1 - P) about it, from sums over small pieces of its own."""
    cls = next(cls for cls in ALL if cls.kind == kind)
    shape = cls(**EXAMPLES[kind])
    found, (measure, center, second) = properties(shape), INTEGRALS[kind]()
    flat = {"disc": 2e-6, "annulus": 2e-6}.get(kind, 1.0)  # thickness
    assert shape.measure(lambda e: float(value(e))) == pytest.approx(measure / flat, rel=1e-3)
    assert [float(x) for x in found.com] == pytest.approx(list(center), abs=1e-3)
    P = 3 / measure * second - 3 * np.outer(center, center)
    expected = np.trace(P) * np.eye(3) - P
    assert np.array(found.I, dtype=float) == pytest.approx(expected, abs=5e-3)


def test_what_no_integral_stands_for_follows_from_another_shape():
    """An ellipse is a stretched disc, a prism a polygon and a rod along z, a ring an arc of a whole turn."""
    ellipse, disc = properties(shapes.Ellipse(mass=3, semiaxes=[2, 2])), properties(Disc(mass=3, radius=2))
    assert ellipse == disc
    stretched = properties(shapes.Ellipse(**EXAMPLES["ellipse"])).I
    assert (stretched[0][0], stretched[1][1]) == (Fraction(3, 4), 3)  # m b^2/4, m a^2/4
    prism, plate = properties(shapes.Prism(**EXAMPLES["prism"])), properties(Triangle(mass=3, width=3, height=2))
    assert [prism.I[k][k] - plate.I[k][k] for k in range(3)] == [4, 4, 0] and prism.com == plate.com  # m l^2/12
    whole, ring = shapes.Arc(mass=3, radius=2, opening="2*pi"), properties(Ring(mass=3, radius=2))
    assert whole.mass_properties(exactly) == ring


@each("cls", SHAPES)
def test_a_shape_has_the_mass_centre_and_inertia_of_what_it_fills(cls):
    """S = sum w [r; 1] [r; 1]^T over the nodes of a quadrature of the shape's own map of [0, 1]^d."""
    shape = cls(**EXAMPLES[cls.kind])

    def number(expression):
        return float(value(expression))

    measure, S = filled(shape.cells(number), shape.dimension)
    mass = shape.of_mass(1, number)
    center, P = S[:3, 3], S[:3, :3] - np.outer(S[:3, 3], S[:3, 3])
    assert measure == pytest.approx(float(shape.measure(number)), rel=1e-10)
    assert [float(x) for x in mass.com] == pytest.approx(list(center), abs=1e-10)
    assert np.array(mass.I, dtype=float) == pytest.approx(np.trace(P) * np.eye(3) - P, abs=1e-10)
