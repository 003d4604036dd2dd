"""A robot file of another program -> the text of a model file, the parts that were left out, the model."""

from __future__ import annotations

import re
from decimal import localcontext
from pathlib import Path

from eomgen.errors import ModelError, UsageError
from eomgen.files import read
from eomgen.frozen import dataclass
from eomgen.model import Model, loads
from eomgen.robots.mjcf import mjcf
from eomgen.robots.sdf import sdf
from eomgen.robots.sdf_models import LARGEST
from eomgen.robots.tables import EXACTLY, Imported, LeftOut, toml_text
from eomgen.robots.urdf import urdf

COMMENT = re.compile(rb"<!--.*?-->", re.S)
ROOT = re.compile(rb"<\s*([A-Za-z][A-Za-z0-9]*)")  # the first element


@dataclass(frozen=True)
class ImportedRobot:
    """A robot of another program's file.

    Args:
        text: the model file.
        model: the model of this text.
        left_out: parts of the robot's file that have no counterpart in it.
        source: the robot's file as it was read: a pipe is read once.
    """

    text: str
    model: Model
    left_out: tuple[LeftOut, ...]
    source: bytes

    @property
    def root(self) -> str:
        """The first element of the robot's file: its format."""
        return first_element(self.source)


def imported(path: str | Path, *, floating: bool = False, model: str | None = None) -> ImportedRobot:
    """The robot in a file: URDF, SDF, or MJCF (by the extra `[mujoco]`).

    Args:
        floating: of URDF: nothing holds the base; else it is fixed to the ground.
        model: of SDF: the name of the model, of several; None: the first that moves.
    Raises:
        ModelError: it cannot be read, is no robot, or one that is none for eomgen.
    """
    path = Path(path)
    try:
        data = read(path, LARGEST)
    except OSError as error:
        raise ModelError(f"cannot be read: {error.strerror or error}", str(path), "check the path") from error
    with localcontext(EXACTLY):
        found = _tables(path, data, floating, model)
    after = [f"left out: {each}" for each in found.left_out]
    text = toml_text(found.tables, [f"Imported from {path.name}."], after)
    return ImportedRobot(text, loads(text, path.with_suffix(".toml").name, path.stem), found.left_out, data)


def import_robot(path: str | Path, *, floating: bool = False, model: str | None = None) -> Model:
    """Model of a robot in a file of another program; `imported` gives its text and the parts that were left out.

    Args:
        floating: of URDF: nothing holds the base; else it is fixed to the ground.
        model: of SDF: the name of the model, of several; None: the first that moves.
    Raises:
        ModelError: it cannot be read, is no robot, or one that is none for eomgen.
    """
    return imported(path, floating=floating, model=model).model


def first_element(data: bytes) -> str:
    """The name of the first element of an XML file; "" of other texts."""
    root = ROOT.search(COMMENT.sub(b"", data))
    return "" if root is None else root[1].decode()


def _tables(path: Path, data: bytes, floating: bool, model: str | None) -> Imported:
    """Import by the reader for the root element of the file."""
    root = first_element(data)
    if model is not None and root != "sdf":
        raise UsageError("only SDF files have several models to choose from", fix="leave --model out")
    if root == "mujoco":
        return mjcf(path, data)
    if root == "sdf":
        return sdf(data, str(path), model)
    if root == "mujocoinclude":
        raise ModelError("a part of an MJCF file", f"{path}:1:1", "import the file with <mujoco> that includes it")
    return urdf(data, str(path), floating=floating)
