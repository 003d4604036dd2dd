"""Files of closed surfaces (STL, OBJ) -> volume, centre and second moments of what they enclose."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from eomgen.errors import ModelError
from eomgen.files import read
from eomgen.records import dataclass

LARGEST = 100_000_000  # bytes
FORMATS = (".stl", ".obj")
HEAD, EACH = 84, 50  # bytes of a binary STL: before the triangles, of each


@dataclass(frozen=True)
class Enclosed:
    """A volume [m^3], its centre [m] and the integral of x x^T over it about that [m^5]."""

    volume: float
    center: Any
    second: Any


def enclosed(path: Path, scale: Any = (1.0, 1.0, 1.0)) -> Enclosed:
    """What a surface encloses, by the divergence theorem: sums over tetrahedra from the origin.

    Raises:
        ModelError: a file of another format, or a surface that is not closed.
    """
    if path.suffix.lower() not in FORMATS:
        raise ModelError("a surface that is not read", str(path), f"convert it to {' or '.join(FORMATS)}")
    data = read(path, LARGEST)
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
