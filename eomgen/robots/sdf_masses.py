"""The <inertial> of a link of SDF -> its mass, centre and inertia; `auto` by the densities of its collision shapes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from decimal import Decimal
from typing import Any

import mpmath

from eomgen.errors import ModelError
from eomgen.records import dataclass
from eomgen.robots.drawn_up import Entries
from eomgen.robots.meshes import enclosed
from eomgen.robots.numbers import (
    DIGITS,
    ORIGIN,
    ZERO,
    Nine,
    Triple,
    computed,
    decimal_of_double,
    decimals,
    in_radians,
    inertia_in,
    roll_pitch_yaw,
    six,
    tensor_of,
    turned_by,
)
from eomgen.robots.sdf_models import file_of
from eomgen.robots.urdf import with_mass
from eomgen.robots.xml_tree import XmlElement
from eomgen.symbolic.expression.spatial import IDENTITY, Pose, apply, minus, plus

WATER = Decimal(1000)  # kg/m^3, where no density is given
SIZES = {  # of a shape: what its element says
    "box": ("size",),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "ellipsoid": ("radii",),
    "cone": ("radius", "length"),
}
YES = ("true", "1")


@dataclass(frozen=True)
class MassPart:
    """A mass, its centre and its inertia about that, all in the axes of the link."""

    mass: Decimal
    center: Triple
    tensor: Nine


def own_pose(pose: XmlElement | None) -> Pose:
    """What a <pose> says: x y z roll pitch yaw, or x y z and a quaternion, scalar last."""
    if pose is None or not pose.text:
        return Pose(IDENTITY, ORIGIN)
    if pose.get("rotation_format") == "quat_xyzw":
        *place, x, y, z, w = pose.value(7)
        if not any((x, y, z, w)):
            raise ModelError("a quaternion of length 0", pose.where, "give one of length 1")
        return Pose(turned_by((w, x, y, z)), decimals(place))
    numbers = pose.value(6)
    angles = decimals(map(in_radians, numbers[3:]) if pose.get("degrees") in YES else numbers[3:])
    return Pose(roll_pitch_yaw(angles)[0], decimals(numbers[:3]))


def link_masses(link: XmlElement, placed: Callable[[XmlElement], Pose], files: tuple[str, ...]) -> Entries:
    """Mass, centre and inertia of a link, in its axes; 1 kg and 1 kg*m^2 where the file does not say.

    Args:
        placed: where a collision of the link is in it.
        files: that include one another, the link's last.
    Raises:
        ModelError: masses below zero; `auto` without shapes that have a volume.
    """
    inertial = link.one("inertial")
    if inertial is not None and inertial.get("auto") in YES:
        return _by_density(link, inertial, placed, files)
    pose, mass, tensor = (None if inertial is None else inertial.one(tag) for tag in ("pose", "mass", "inertia"))
    frame = own_pose(pose)
    kilograms = Decimal(1) if mass is None else mass.value()[0]
    _refuse_negative(mass, kilograms)
    entries = {"ixx": Decimal(1), "iyy": Decimal(1), "izz": Decimal(1), "ixy": ZERO, "iyz": ZERO, "ixz": ZERO}
    for key in entries if tensor is not None else ():
        element = None if tensor is None else tensor.one(key)
        if element is not None:
            entries[key] = element.value()[0]
    return with_mass({"mass": kilograms}, frame.p, six(inertia_in(frame.R, tensor_of(*entries.values()))))


def _refuse_negative(mass: XmlElement | None, kilograms: Decimal) -> None:
    if kilograms < 0:
        where = "" if mass is None else mass.where
        raise ModelError(f"a negative mass: {kilograms}", where, "give a mass of 0 or more")


def _by_density(
    link: XmlElement, inertial: XmlElement, placed: Callable[[XmlElement], Pose], files: tuple[str, ...]
) -> Entries:
    """The sum over the collisions of a link; a mass that is given too scales it."""
    inertial.one("pose"), inertial.one("inertia")  # they mean nothing here
    shapes = [child for child in link.children if child.tag == "collision"]
    if not shapes:
        name = link.attributes.get("name", "")
        raise ModelError(
            f"link '{name}' has no <collision> to tell its mass by", inertial.where, "give mass and inertia"
        )
    usual = inertial.one("density")
    parts = [_part(shape, usual, placed(shape), files) for shape in shapes]
    mass = sum((part.mass for part in parts), ZERO)
    if mass <= 0:
        raise ModelError("the shapes of a link have no mass", inertial.where, "give a density above 0")
    center = decimals(sum((part.mass * part.center[i] for part in parts), ZERO) / mass for i in range(3))
    total = [[sum((_about(part, center)[i][j] for part in parts), ZERO) for j in range(3)] for i in range(3)]
    given = inertial.one("mass")
    wanted = mass if given is None else given.value()[0]
    _refuse_negative(given, wanted)
    scaled: Any = tuple(tuple(x * wanted / mass for x in row) for row in total)
    return with_mass({"mass": computed(wanted)}, center, six(scaled))


def _about(part: MassPart, center: Triple) -> Nine:
    """I + m (d^2 1 - d d^T): the inertia of a part about another point."""
    d: Any = minus(part.center, center)
    square = sum((x * x for x in d), ZERO)
    xx, yy, zz, xy, yz, zx = (
        part.tensor[i][j] + part.mass * ((square if i == j else ZERO) - d[i] * d[j])
        for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))
    )
    return tensor_of(xx, yy, zz, xy, yz, zx)


def _part(shape: XmlElement, usual: XmlElement | None, at: Pose, files: tuple[str, ...]) -> MassPart:
    """A collision as a mass: its own density, else the link's, else that of water."""
    given = {child.tag: child for child in shape.children}
    element = given.get("density", usual)
    density = WATER if element is None else element.value()[0]
    geometry = given.get("geometry")
    what = None if geometry is None else next(iter(geometry.children), None)
    if what is None or what.tag not in (*SIZES, "mesh"):
        told = "no shape" if what is None else f"<{what.tag}>"
        raise ModelError(
            f"{told} gives no mass by its density", shape.where, f"one of {', '.join((*SIZES, 'mesh'))}, or give mass"
        )
    own = _mesh(what, density, files) if what.tag == "mesh" else _simple(what, density)
    return MassPart(own.mass, plus(at.p, apply(at.R, own.center)), inertia_in(at.R, own.tensor))


def _simple(what: XmlElement, density: Decimal) -> MassPart:
    """A shape about its own centre, by the formulas of tables."""
    sizes: list[Decimal] = []
    for tag in SIZES[what.tag]:
        element = what.one(tag)
        if element is None:
            raise ModelError(f"<{what.tag}> has no <{tag}>", what.where, "give it")
        sizes += element.value(3 if tag in ("size", "radii") else 1)
    if min(sizes) < 0:
        raise ModelError(f"a negative size of <{what.tag}>", what.where, "give sizes above 0")
    with mpmath.workdps(DIGITS + 5):
        pi = Decimal(mpmath.nstr(mpmath.pi, DIGITS))
    return _SHAPES[what.tag](sizes, density, pi)


def _diagonal(mass: Decimal, moments: Sequence[Decimal], down: Decimal = ZERO) -> MassPart:
    x, y, z = (mass * moment for moment in moments)
    return MassPart(mass, (ZERO, ZERO, -down), tensor_of(x, y, z, ZERO, ZERO, ZERO))


def _box(s: Sequence[Decimal], density: Decimal, pi: Decimal) -> MassPart:
    a, b, c = (x * x / 12 for x in s)
    return _diagonal(density * s[0] * s[1] * s[2], (b + c, c + a, a + b))


def _ellipsoid(s: Sequence[Decimal], density: Decimal, pi: Decimal) -> MassPart:
    a, b, c = (x * x / 5 for x in s)
    return _diagonal(density * 4 * pi / 3 * s[0] * s[1] * s[2], (b + c, c + a, a + b))


def _sphere(s: Sequence[Decimal], density: Decimal, pi: Decimal) -> MassPart:
    return _ellipsoid([s[0]] * 3, density, pi)


def _cylinder(s: Sequence[Decimal], density: Decimal, pi: Decimal) -> MassPart:
    r, l = s
    across = r * r / 4 + l * l / 12
    return _diagonal(density * pi * r * r * l, (across, across, r * r / 2))


def _capsule(s: Sequence[Decimal], density: Decimal, pi: Decimal) -> MassPart:
    """A cylinder of length l between two half balls, whose centres are 3/8 r from their flat sides."""
    r, l = s
    tube, ball = density * pi * r * r * l, density * pi * r * r * r * 4 / 3
    mass = tube + ball
    across = tube * (r * r / 4 + l * l / 12) + ball * (2 * r * r / 5 + l * l / 4 + 3 * l * r / 8)
    along = tube * r * r / 2 + ball * 2 * r * r / 5
    return MassPart(mass, ORIGIN, tensor_of(across, across, along, ZERO, ZERO, ZERO))


def _cone(s: Sequence[Decimal], density: Decimal, pi: Decimal) -> MassPart:
    """Its tip up, the origin half way: the centre of mass is a quarter of the length below."""
    r, l = s
    across = 3 * (4 * r * r + l * l) / 80
    return _diagonal(density * pi * r * r * l / 3, (across, across, 3 * r * r / 10), l / 4)


_SHAPES = {
    "box": _box,
    "ellipsoid": _ellipsoid,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "capsule": _capsule,
    "cone": _cone,
}


def _mesh(mesh: XmlElement, density: Decimal, files: tuple[str, ...]) -> MassPart:
    """What the surface of a file encloses."""
    uri, scale = mesh.one("uri"), mesh.one("scale")
    where = "" if uri is None else uri.text
    path = file_of(where, files)
    if path is None:
        mend = "put it into this folder, or one above it; or give mass and inertia"
        raise ModelError(f"no file is there for '{where}', by which the mass is told", mesh.where, mend)
    if any(child.tag == "submesh" for child in mesh.children):
        raise ModelError("the mass of a part of a surface is not told", mesh.where, "give mass and inertia")
    found = enclosed(path, [1.0] * 3 if scale is None else [float(x) for x in scale.value(3)])
    S = [[density * decimal_of_double(float(x)) for x in row] for row in found.second]
    xx, yy, zz = (S[i][i] for i in range(3))
    tensor = tensor_of(yy + zz, zz + xx, xx + yy, -S[0][1], -S[1][2], -S[2][0])
    return MassPart(
        density * decimal_of_double(found.volume), decimals(decimal_of_double(float(x)) for x in found.center), tensor
    )
