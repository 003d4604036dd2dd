"""An MJCF file -> MuJoCo's own reading of it, pictures left away."""

from __future__ import annotations

import importlib
import math
import re
import warnings
from pathlib import Path
from typing import Any

from eomgen.errors import ModelError, ToolMissing
from eomgen.files import read
from eomgen.robots.sdf_models import LARGEST

MOST_MADE = (
    3_000  # elements that <replicate> makes: MuJoCo takes the square of it, of 3000 some 3 s, and cannot be stopped
)
MOST_VALUES = 10_000_000  # of one array that a file asks for
SIZES = {  # what makes arrays as large as a number in the file, or as the product of several
    "hfield": ("nrow", "ncol"),
    "texture": ("width", "height"),
    "flexcomp": ("count",),
    "composite": ("count",),
    "numeric": ("size",),
    "size": ("nkey", "nuser_body", "nuser_jnt", "nuser_geom", "nuser_site", "nuser_cam", "nuser_tendon"),
}
ALONE = ("size",)  # of these each attribute is an array of its own
COMMENT = re.compile(r"<!--.*?-->", re.S)
TAG = re.compile(r"<\s*(/?)\s*([A-Za-z_]+)([^<>]*?)(/?)>", re.S)
ATTRIBUTE = re.compile(r"""([A-Za-z_]+)\s*=\s*["']([^"']*)["']""")
DEEPEST = 30  # files that include one another
NOT_THERE = "Error opening file"  # so MuJoCo says it


def spec_of(path: Path, data: bytes) -> Any:
    """A file as MuJoCo reads it; files of pictures need not be there, nor those of meshes that give no mass.

    Raises:
        ToolMissing: MuJoCo is not installed.
        ModelError: MuJoCo cannot read it; it says why.
    """
    try:
        mujoco: Any = importlib.import_module("mujoco")
    except ImportError as error:
        raise ToolMissing("MJCF is read by MuJoCo, which is not installed", mend="pip install mujoco") from error
    _refuse_endless(path, data, path, 1, 0)
    try:
        try:
            return _read(mujoco, path, data)
        except ValueError as error:
            if NOT_THERE not in str(error):
                raise
        return _read(mujoco, path, data, meshes=False)
    except (ValueError, RuntimeError) as error:
        why = " ".join(str(error).split())
        mend = "put the file there" if NOT_THERE in why else "mend the file"
        raise ModelError(f"MuJoCo cannot read it: {why}", str(path), mend) from error


def _refuse_endless(path: Path, data: bytes, first: Path, times: int, depth: int) -> int:
    """How many elements replicas make of a file, and of those that it includes.

    Args:
        first: beside which included files lie.
        times: how often this file stands there.
    Raises:
        ModelError: more than anything can be computed with; MuJoCo would ask for the memory, or work on it for hours.
    """
    text = data.decode("utf-8", "replace")
    text = COMMENT.sub(lambda found: "\n" * found[0].count("\n"), text)
    made, copies = 0, [times]
    for found in TAG.finditer(text):
        closes, tag, inner, closed = found.groups()
        if closes:
            if tag == "replicate" and len(copies) > 1:
                copies.pop()
            continue
        given = dict(ATTRIBUTE.findall(inner))
        where = f"{path}:{text.count(chr(10), 0, found.start()) + 1}:1"
        if tag == "replicate" and not closed:
            copies.append(copies[-1] * _product(given.get("count", "1")))
        elif tag == "include" and depth < DEEPEST and "file" in given:
            part = first.parent / given["file"]
            made += _refuse_endless(part, _included(part), first, copies[-1], depth + 1)
        made += copies[-1] if copies[-1] > 1 and tag != "replicate" else 0
        if made > MOST_MADE:
            what = f"replicas make more than {MOST_MADE} elements"
            raise ModelError(what, where, "make fewer: equations of so many bodies are not derived")
        sizes = [_product(given[key]) for key in SIZES.get(tag, ()) if key in given]
        if sizes and max(max(sizes), 1 if tag in ALONE else math.prod(sizes)) > MOST_VALUES:
            what = f"<{tag}> asks for more than {MOST_VALUES} values"
            raise ModelError(what, where, "make it smaller: no equation depends on it")
    return made


def _included(path: Path) -> bytes:
    """A part of a file; nothing where it is missing, which MuJoCo says."""
    try:
        return read(path, LARGEST)
    except OSError:
        return b""


def _product(text: str) -> int:
    """The product of whole numbers; 1 of what is none: MuJoCo says so."""
    words = text.split()
    return math.prod(int(word) for word in words) if all(word.isdigit() and len(word) < 20 for word in words) else 1


def compiled(spec: Any) -> Any:
    """What MuJoCo makes of it, without a word of what it will not read some day."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return spec.compile()


def _read(mujoco: Any, path: Path, data: bytes, *, meshes: bool = True) -> Any:
    """Without textures; without `meshes` what has a mesh on a body whose mass is given, or that stands, is a ball."""
    pipe = not path.is_file()
    spec = mujoco.MjSpec.from_string(data.decode()) if pipe else mujoco.MjSpec.from_file(str(path))
    spec.compiler.fusestatic = False
    for material in spec.materials:
        material.textures = ["" for _ in material.textures]
    for texture in list(spec.textures):
        _delete(spec, texture)
    if not meshes:
        by_geoms = spec.compiler.inertiafromgeom == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
        _without_meshes(spec, mujoco.mjtGeom.mjGEOM_SPHERE, by_geoms)
    compiled(spec)
    return spec


def _without_meshes(spec: Any, ball: Any, by_geoms: bool) -> None:
    needed = set()
    for body in spec.bodies:
        for geom in body.geoms:
            if geom.meshname and (body.name == "world" or (body.explicitinertial and not by_geoms)):
                geom.type, geom.size[0], geom.meshname = ball, 1, ""
            needed.add(geom.meshname)
    for mesh in list(spec.meshes):
        if mesh.name not in needed:
            _delete(spec, mesh)


def _delete(spec: Any, what: Any) -> None:
    """As each MuJoCo has it."""
    if hasattr(spec, "delete"):
        spec.delete(what)
    else:
        what.delete()
