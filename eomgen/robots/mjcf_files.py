"""An MJCF file -> MuJoCo's own reading of it, pictures left away."""

from __future__ import annotations

import importlib
import warnings
from pathlib import Path
from typing import Any

from eomgen.errors import ModelError, ToolMissing

NOT_THERE = "Error opening file"  # so MuJoCo says it


def spec_of(path: Path) -> Any:
    """A file as MuJoCo reads it; files of pictures need not be there, nor those of meshes that give no mass.

    Raises:
        ToolMissing: MuJoCo is not installed.
        ModelError: MuJoCo cannot read it; it says why.
    """
    try:
        mujoco: Any = importlib.import_module("mujoco")
    except ImportError as error:
        raise ToolMissing("MJCF is read by MuJoCo, which is not installed", mend="pip install mujoco") from error
    try:
        try:
            return _read(mujoco, path)
        except ValueError as error:
            if NOT_THERE not in str(error):
                raise
        return _read(mujoco, path, meshes=False)
    except ValueError as error:
        why = " ".join(str(error).split())
        mend = "put the file there" if NOT_THERE in why else "mend the file"
        raise ModelError(f"MuJoCo cannot read it: {why}", str(path), mend) from error


def compiled(spec: Any) -> Any:
    """What MuJoCo makes of it, without a word of what it will not read some day."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return spec.compile()


def _read(mujoco: Any, path: Path, *, meshes: bool = True) -> Any:
    """Without textures; without `meshes` what has a mesh on a body whose mass is given, or that stands, is a ball."""
    spec = mujoco.MjSpec.from_file(str(path))
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
