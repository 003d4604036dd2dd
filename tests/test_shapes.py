"""Shapes: mass, mass centre and inertia against independent integrals and against one another."""

from fractions import Fraction

import pytest
from scipy.integrate import dblquad, tplquad

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

EXAMPLES = {
    "particle": {"mass": 3},
    "rod": {"mass": 3, "length": 2},
    "disc": {"mass": 3, "radius": "1/2"},
    "ring": {"mass": 3, "radius": "1/2"},
    "rectangle": {"mass": 3, "width": 2, "height": "3/2"},
    "triangle": {"mass": 3, "width": 2, "height": "3/2"},
    "polygon": {"mass": 3, "vertices": [[1, 0], [3, 1], [2, 4], [0, 2]]},
    "sphere": {"mass": 3, "radius": "1/2"},
    "cylinder": {"mass": 3, "radius": "1/2", "length": 2},
    "box": {"mass": 3, "size": [1, 2, 3]},
    "cone": {"mass": 3, "radius": "1/2", "height": 2},
    "ellipsoid": {"mass": 3, "semiaxes": [1, 2, 3]},
}


def value(expression):
    return expression.evaluate({"pi": 3.141592653589793})


def properties(shape):
    return shape.mass_properties(value)


def moment_tensor(m, measure, integral):
    """I_ij = m / measure * integral of (r.r delta_ij - x_i x_j), from the six second moments."""
    xx, yy, zz, xy, yz, zx = (m / measure * integral(f) for f in SECOND)
    return [[yy + zz, -xy, -zx], [-xy, zz + xx, -yz], [-zx, -yz, xx + yy]]


SECOND = (
    lambda x, y, z: x * x, lambda x, y, z: y * y, lambda x, y, z: z * z,
    lambda x, y, z: x * y, lambda x, y, z: y * z, lambda x, y, z: z * x,
)  # fmt: skip


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.kind)
def test_a_shape_is_exact_and_has_the_points_of_its_names(cls):
    """No float comes in; `points` gives what `point_names` promises; `center` is the mass centre."""
    shape = cls(**EXAMPLES[cls.kind])
    found, points = properties(shape), shape.points(value)
    assert set(points) == set(shape.point_names)
    assert points["center"] == found.com and points["origin"] == (0, 0, 0)
    assert all(isinstance(x, int | Fraction) for row in (*found.I, found.com, (found.m,)) for x in row)


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.kind)
def test_an_inertia_is_symmetric_and_obeys_the_triangle_inequality(cls):
    """I = I^T and I_xx <= I_yy + I_zz, and so on round."""
    tensor = properties(cls(**EXAMPLES[cls.kind])).I
    assert all(tensor[i][j] == tensor[j][i] for i in range(3) for j in range(3))
    xx, yy, zz = (tensor[i][i] for i in range(3))
    assert xx <= yy + zz and yy <= zz + xx and zz <= xx + yy


@pytest.mark.parametrize(("shape", "radius_at"), [
    (Cone(**EXAMPLES["cone"]), lambda z: 0.5 * (1.5 - z) / 2),  # base at -h/4, apex at 3h/4
    (Sphere(**EXAMPLES["sphere"]), lambda z: max(0.0, 0.25 - z * z) ** 0.5),
    (Cylinder(**EXAMPLES["cylinder"]), lambda z: 0.5),
])  # fmt: skip
def test_round_solids_agree_with_the_integral_over_their_volume(shape, radius_at):
    """I = (m / V) times the integral of (r.r 1 - r r^T) dV about the origin, which is the mass centre."""
    low, high = {"cone": (-0.5, 1.5), "sphere": (-0.5, 0.5), "cylinder": (-1.0, 1.0)}[shape.kind]

    def integral(f):
        from math import cos, pi, sin

        return tplquad(
            lambda a, r, z: r * f(r * cos(a), r * sin(a), z), low, high, 0, radius_at, 0, 2 * pi, epsabs=1e-8
        )[0]  # fmt: skip

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


@pytest.mark.parametrize("turn", [1, -1])
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
