"""The models of an SDF file -> the one that is imported, with its nested and included models as links of its own.

A nested model `arm` gives links, joints and frames called `arm::...`, and a frame `arm`, from which their poses count.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from decimal import Decimal
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from eomgen.errors import ModelError
from eomgen.files import read
from eomgen.frozen import dataclass
from eomgen.model import InertiaMatrix, nearest
from eomgen.robots.tables import (
    DIGITS,
    ORIGIN,
    PI,
    ZERO,
    Entries,
    computed,
    decimal_of_double,
    decimals,
    in_radians,
    inertia_in,
    roll_pitch_yaw,
    six,
    turned_by,
)
from eomgen.robots.urdf import with_mass
from eomgen.robots.xml_tree import XmlElement, xml_tree
from eomgen.symbolic.expression import Matrix, Pose, Vector

LARGEST = 20_000_000  # bytes of a file
DEEPEST = 30  # models one within the other
PLACED = ("link", "joint", "frame")
REFERRING = ("relative_to", "attached_to", "expressed_in", "joint")  # attributes that name something of the model


@dataclass(frozen=True)
class ModelScope:
    """Place of the elements of a model in the whole file.

    Args:
        frame: frame of their model, to which poses are relative.
        files: files that include one another, theirs last.
        old: True if an axis is given in that frame.
        prefix: prefix of their names.
    """

    frame: str = "__model__"
    files: tuple[str, ...] = ()
    old: bool = False
    prefix: str = ""

    def named(self, name: str) -> str:
        """Name in the whole of a name in the model."""
        if name in ("", "world"):
            return name
        return self.frame if name == "__model__" else f"{self.prefix}{name}"


@dataclass
class FlatModel:
    """A model whose nested models are frames, their links, joints and frames its own.

    Args:
        scopes: by the identity of an element, where it stands; those that are not there stand in `scope`.
        nested: the models within it, by the names of their frames.
        canonical: the link with which each of these frames moves.
    """

    model: XmlElement
    scope: ModelScope
    scopes: dict[int, ModelScope] = field(default_factory=dict)
    nested: dict[str, XmlElement] = field(default_factory=dict)
    canonical: dict[str, str] = field(default_factory=dict)

    def scope_of(self, element: XmlElement) -> ModelScope:
        return self.scopes.get(id(element), self.scope)


@dataclass(frozen=True)
class SdfChoice:
    """Model of a file that may be imported: itself or the element that includes it, and the gravity of its world."""

    element: XmlElement
    gravity: XmlElement | None
    scope: ModelScope

    @property
    def name(self) -> str:
        if self.element.tag == "model":
            return self.element.attributes.get("name", "")
        given = {child.tag: child.text for child in self.element.children}
        return given.get("name") or given.get("uri", "").rpartition("/")[2]

    def is_called(self, name: str) -> bool:
        """True if a model has this name: its own, or that of the file's model which it includes."""
        if self.name == name:
            return True
        try:
            return self.element.tag == "include" and included(self.element, self.scope)[0].attributes["name"] == name
        except (ModelError, KeyError):
            return False

    def flat(self) -> FlatModel:
        """Raises: ModelError: the included file is not there."""
        model, scope = self.element, self.scope
        model.seen = True
        if model.tag == "include":
            model, scope = included(model, scope)
            self.element.children.append(model)  # its parts that are not read are left out
        found = FlatModel(model, scope)
        _flatten(found, model, scope)
        return found


def choices(root: XmlElement, file: str) -> list[SdfChoice]:
    """The models of a file, of its worlds, and those that worlds include, in their order."""
    scope = ModelScope(files=(str(Path(file).resolve()),), old=_is_old(root))
    found = []
    for top in root.all("world") or [root]:
        top.get("name")
        gravity = None if top is root else top.one("gravity")
        found += [SdfChoice(x, gravity, scope) for x in top.children if x.tag in ("model", "include")]
    return found


def choice_named(choices: list[SdfChoice], name: str, root: XmlElement) -> SdfChoice:
    """The model of a name.

    Raises:
        ModelError: there is none.
    """
    found = next((each for each in choices if each.is_called(name)), None)
    if found is None:
        names = [each.name for each in choices]
        raise ModelError(
            f"no model is called '{name}'", root.where, nearest(name, names) or f"one of {', '.join(names)}"
        )
    return found


def included(include: XmlElement, scope: ModelScope) -> tuple[XmlElement, ModelScope]:
    """The model of the file that an <include> names; <name>, <static>, <pose> are the include's.

    Raises:
        ModelError: no such file, or no model in it.
    """
    uri = include.one("uri")
    where = plain_path("" if uri is None else uri.text)
    file = file_of(where, scope.files)
    if file is None:
        raise ModelError(f"no file is there for '{where}'", include.where, "put it into this folder, or one above it")
    if str(file) in scope.files:
        raise ModelError(f"'{where}' includes itself", include.where, "take one <include> out")
    root = xml_tree(read(file, LARGEST), str(file))
    model = root.one("model")
    if model is None:
        raise ModelError("the file holds no <model>", root.where, "include one with a model")
    title, own = include.one("name"), [x for x in (include.one("static"), include.one("pose")) if x is not None]
    attributes = dict(model.attributes) if title is None else {**model.attributes, "name": title.text}
    if frame := include.get("placement_frame"):
        attributes["placement_frame"] = frame
    kept = [child for child in model.children if child.tag not in {x.tag for x in own}]
    made = XmlElement("model", attributes, model.where, [*own, *kept], seen=True)
    return made, ModelScope(files=(*scope.files, str(file)), old=_is_old(root))


def file_of(uri: str, files: tuple[str, ...]) -> Path | None:
    """File, or model of a folder, at an address: next to the last of `files`, or above it."""
    where = plain_path(uri)
    places = [folder / where for folder in Path(files[-1]).parents]
    return next((x for place in places for x in (place, place / "model.sdf") if where and x.is_file()), None)


def plain_path(uri: str) -> str:
    """An address without its scheme."""
    return re.sub(r"^(model|file|package)://", "", uri)


def _is_old(root: XmlElement) -> bool:
    text = root.get("version", "1.10") or "1.10"
    return tuple(int(part) for part in text.split(".") if part.isdigit()) < (1, 5)


def _flatten(found: FlatModel, model: XmlElement, scope: ModelScope) -> None:
    """Moves the elements of nested models into the whole, under their names there."""
    if scope.prefix.count("::") > DEEPEST:
        raise ModelError(
            f"more than {DEEPEST} models stand one inside the other", model.where, "put their links into one <model>"
        )
    for within, own, merged in list(_within(model, scope)):
        title = within.get("name") or "model"
        frame = scope.named(f"_merged__{title}__model__" if merged else title)
        inner = ModelScope(frame, own.files, own.old, scope.prefix if merged else f"{scope.named(title)}::")
        within.attributes = {**within.attributes, "name": frame}
        for key in ("placement_frame", "canonical_link"):
            if key in within.attributes:
                within.attributes = {**within.attributes, key: inner.named(within.attributes[key])}
        for pose in (child for child in within.children if child.tag == "pose"):
            _rename(pose, scope)
        found.scopes[id(within)] = scope
        if frame in found.nested:
            raise ModelError(f"two models within one are called '{title}'", within.where, "give each a name of its own")
        found.nested[frame] = within
        moved = [child for child in within.children if child.tag in PLACED]
        within.children = [child for child in within.children if child.tag not in PLACED]
        for child in moved:
            child.attributes = {**child.attributes, "name": inner.named(child.need("name"))}
            _rename(child, inner)
            found.scopes[id(child)] = inner
        found.model.children += moved
        count = len(found.model.children)
        _flatten(found, within, inner)
        links = [x for x in (*moved, *found.model.children[count:]) if x.tag == "link"]
        first = links[0].attributes["name"] if links else ""
        found.canonical[frame] = within.get("canonical_link") or first


def _within(model: XmlElement, scope: ModelScope) -> Iterator[tuple[XmlElement, ModelScope, bool]]:
    """Nested models, with their files, and whether they are merged into the whole."""
    for child in [*model.children]:
        if child.tag == "model":
            child.seen = True
            yield child, scope, False
        elif child.tag == "include":
            uri = next((x.text for x in child.children if x.tag == "uri"), "")
            if file_of(uri, scope.files) is None:
                continue  # reported among the parts left out
            child.seen = True
            inner, own = included(child, scope)
            child.children.append(inner)
            yield inner, own, child.get("merge") in ("true", "1")


def _rename(element: XmlElement, scope: ModelScope) -> None:
    """Replaces, in an element and those in it, names of the model by those in the whole."""
    reported: Mapping[str, str] = element.attributes
    element.attributes = {key: scope.named(x) if key in REFERRING else x for key, x in reported.items()}
    if element.tag in ("parent", "child"):
        element.text = scope.named(element.text)
    for child in element.children:
        _rename(child, scope)


# -------- sdf masses ------------------------------------------------------------------------------------------
# The <inertial> of a link of SDF -> its mass, centre and inertia; `auto` by the densities of its collision shapes.


WATER = Decimal(1000)  # kg/m^3, where no density is given
SIZES = {  # values of the element of a shape
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
    center: Vector
    tensor: Matrix


def own_pose(pose: XmlElement | None) -> Pose:
    """Pose by an element <pose>: x y z roll pitch yaw, or x y z and a quaternion, scalar last."""
    if pose is None or not pose.text:
        return Pose(Matrix.IDENTITY, ORIGIN)
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
    return with_mass(
        {"mass": kilograms}, frame.p, six(inertia_in(frame.R, InertiaMatrix.of_moments(*entries.values())))
    )


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
            f"link '{name}' has no <collision> that determines its mass", inertial.where, "give mass and inertia"
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


def _about(part: MassPart, center: Vector) -> Matrix:
    """I + m (d^2 1 - d d^T): the inertia of a part about another point."""
    d: Any = part.center - center
    square = sum((x * x for x in d), ZERO)
    xx, yy, zz, xy, yz, zx = (
        part.tensor[i][j] + part.mass * ((square if i == j else ZERO) - d[i] * d[j])
        for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))
    )
    return InertiaMatrix.of_moments(xx, yy, zz, xy, yz, zx)


def _part(shape: XmlElement, usual: XmlElement | None, at: Pose, files: tuple[str, ...]) -> MassPart:
    """A collision as a mass: its own density, else the link's, else that of water."""
    given = {child.tag: child for child in shape.children}
    element = given.get("density", usual)
    density = WATER if element is None else element.value()[0]
    geometry = given.get("geometry")
    what = None if geometry is None else next(iter(geometry.children), None)
    if what is None or what.tag not in (*SIZES, "mesh"):
        reported = "no shape" if what is None else f"<{what.tag}>"
        raise ModelError(
            f"{reported} gives no mass by its density",
            shape.where,
            f"one of {', '.join((*SIZES, 'mesh'))}, or give mass",
        )
    own = _mesh(what, density, files) if what.tag == "mesh" else _simple(what, density)
    return MassPart(own.mass, at.p + at.R @ own.center, inertia_in(at.R, own.tensor))


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
    return _SHAPES[what.tag](sizes, density, PI.decimal(DIGITS))


def _diagonal(mass: Decimal, moments: Sequence[Decimal], down: Decimal = ZERO) -> MassPart:
    x, y, z = (mass * moment for moment in moments)
    return MassPart(mass, Vector((ZERO, ZERO, -down)), InertiaMatrix.of_moments(x, y, z, ZERO, ZERO, ZERO))


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
    return MassPart(mass, ORIGIN, InertiaMatrix.of_moments(across, across, along, ZERO, ZERO, ZERO))


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
    """Mass part that the surface of a file encloses."""
    uri, scale = mesh.one("uri"), mesh.one("scale")
    where = "" if uri is None else uri.text
    path = file_of(where, files)
    if path is None:
        fix = "put it into this folder, or one above it; or give mass and inertia"
        raise ModelError(f"no file is there for '{where}', which determines the mass", mesh.where, fix)
    if any(child.tag == "submesh" for child in mesh.children):
        raise ModelError("the mass of a part of a surface is not computed", mesh.where, "give mass and inertia")
    found = enclosed(path, [1.0] * 3 if scale is None else [float(x) for x in scale.value(3)])
    S = [[density * decimal_of_double(float(x)) for x in row] for row in found.second]
    xx, yy, zz = (S[i][i] for i in range(3))
    tensor = InertiaMatrix.of_moments(yy + zz, zz + xx, xx + yy, -S[0][1], -S[1][2], -S[2][0])
    return MassPart(
        density * decimal_of_double(found.volume), decimals(decimal_of_double(float(x)) for x in found.center), tensor
    )


# -------- meshes ----------------------------------------------------------------------------------------------
# Files of closed surfaces (STL, OBJ) -> volume, centre and second moments inside them.


LARGEST_MESH = 100_000_000  # bytes
FORMATS = (".stl", ".obj")
HEAD, EACH = 84, 50  # bytes of a binary STL: before the triangles, of each


@dataclass(frozen=True)
class Enclosed:
    """A volume [m^3], its centre [m] and the integral of x x^T over it about that [m^5]."""

    volume: float
    center: Any
    second: Any


def enclosed(path: Path, scale: Any = (1.0, 1.0, 1.0)) -> Enclosed:
    """Volume, centre and second moments inside a surface, by the divergence theorem over tetrahedra from the origin.

    Raises:
        ModelError: a file of another format, or a surface that is not closed.
    """
    if path.suffix.lower() not in FORMATS:
        raise ModelError("a surface that is not read", str(path), f"convert it to {' or '.join(FORMATS)}")
    data = read(path, LARGEST_MESH)
    try:
        corners = _obj(data) if path.suffix.lower() == ".obj" else _stl(data)
    except (ValueError, IndexError) as error:
        raise ModelError("no triangles can be read", str(path), "export it again") from error
    if not len(corners) or not _is_closed(corners):
        raise ModelError("the surface is not closed: it has no volume", str(path), "close it, or give mass and inertia")
    corners = corners * np.asarray(scale, dtype=float)
    shift = corners.reshape(-1, 3).mean(axis=0)
    a, b, c = (corners - shift).transpose(1, 0, 2)
    six = np.einsum("ki,ki->k", a, np.cross(b, c))
    volume = six.sum() / 6
    if volume == 0:
        raise ModelError("the surface encloses nothing", str(path), "give mass and inertia")
    center = np.einsum("k,ki->i", six, a + b + c) / (24 * volume)
    total = a + b + c
    second = sum(np.einsum("k,ki,kj->ij", six, x, x) for x in (a, b, c, total)) / 120
    return Enclosed(abs(volume), center + shift, (second - volume * np.outer(center, center)) * np.sign(volume))


def _stl(data: bytes) -> Any:
    """Corners of triangles, n x 3 x 3."""
    count = int.from_bytes(data[HEAD - 4 : HEAD], "little")
    if len(data) == HEAD + EACH * count:
        rows = np.frombuffer(data, np.uint8, offset=HEAD).reshape(count, EACH)[:, 12:48]
        return np.ascontiguousarray(rows).view("<f4").reshape(count, 3, 3).astype(float)
    words = [
        line.split()[1:4] for line in data.decode("utf-8", "replace").splitlines() if line.split()[:1] == ["vertex"]
    ]
    return np.array(words, dtype=float).reshape(-1, 3, 3)


def _obj(data: bytes) -> Any:
    """Corners of triangles; a face of more corners is a fan of them."""
    places: list[list[float]] = []
    faces: list[list[int]] = []
    for line in data.decode("utf-8", "replace").splitlines():
        key, *words = line.split("#")[0].split() or [""]
        if key == "v":
            places.append([float(x) for x in words[:3]])
        elif key == "f":
            at = [int(word.split("/")[0]) for word in words]
            face = [k - 1 if k > 0 else len(places) + k for k in at]
            faces += [[face[0], one, other] for one, other in pairwise(face[1:])]
    return np.array(places, dtype=float)[np.array(faces, dtype=int)]


def _is_closed(corners: Any) -> bool:
    """True if each edge is passed as often in one direction as in the other."""
    _, numbers = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    a, b, c = numbers.reshape(-1, 3).T
    edges = np.concatenate([np.stack(pair, axis=1) for pair in ((a, b), (b, c), (c, a))])
    found, back = (np.unique(x, axis=0, return_counts=True) for x in (edges, edges[:, ::-1]))
    return bool(np.array_equal(found[0], back[0]) and np.array_equal(found[1], back[1]))
