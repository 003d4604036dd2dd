"""`--follow theta=run.csv`: a motion or an input through the samples of a file, in place of the model's own."""

from __future__ import annotations

import csv
import errno
import io
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from eomgen.documents import nearest_name
from eomgen.errors import ModelError, UsageError
from eomgen.files import read
from eomgen.model import Coordinate, Model, Table, assignments, samples
from eomgen.symbolic.expression import Expression

EXAMPLE = "--follow theta=run.csv"
LARGEST = 100_000_000  # bytes of a file
LAWS = ("motion", "rate", "acceleration")


def following(model: Model, given: Sequence[str]) -> Model:
    """The model with coordinates and inputs that follow files: a coordinate in the way it was driven, else by `motion`.

    Args:
        given: NAME=FILE each; a CSV with the times in its first column and the values, in SI, in the column NAME, or
            in its second.
    Raises:
        UsageError: no coordinate or input of that name, one that cannot be driven, or a file without samples.
    """
    coordinates, inputs = dict(model.coordinates), dict(model.inputs)
    for name, path in assignments(given, EXAMPLE):
        if name in inputs:
            inputs[name] = inputs[name].altered(value=_read(path, name))
        elif name in coordinates:
            coordinates[name] = _driven(coordinates[name], name, _read(path, name))
        else:
            fix = nearest_name(name, [*coordinates, *inputs])
            raise UsageError(f"--follow: there is no coordinate or input '{name}'", fix=fix)
    changes: dict[str, Any] = {"coordinates": Table(coordinates), "inputs": Table(inputs)}
    try:
        replace(model, **changes)  # what is wrong with a model is wrong with this one
    except ModelError as error:
        raise UsageError(f"--follow: {error.problems[0].what}", fix=error.problems[0].fix) from error
    followed: Model = model.altered(**changes)
    return followed


def _driven(part: Coordinate, name: str, law: Expression) -> Coordinate:
    if part.dependent:
        raise UsageError(
            f"--follow: coordinate '{name}' is dependent, the constraints move it", fix="drive another one"
        )
    (way,) = [way for way in LAWS if getattr(part, way) is not None] or ["motion"]
    own = {} if way != "motion" else {"start": None, "speed": None}
    driven: Coordinate = part.altered(**{way: law}, **own)
    return driven


def _read(path: str, name: str) -> Expression:
    """The samples of a file.

    Raises:
        UsageError: it cannot be read, or holds no samples.
    """
    try:
        data = read(path, LARGEST)
        if len(data) > LARGEST:
            raise OSError(errno.EFBIG, f"it is longer than {LARGEST // 10**6} MB")
        lines = io.StringIO(data.decode("utf-8-sig"), newline="")
        rows = [row for row in csv.reader(lines) if row and not row[0].lstrip().startswith("#")]
    except UnicodeDecodeError as error:
        what = f"--follow: not UTF-8: byte 0x{error.object[error.start]:02x}"
        raise UsageError(what, path, "write plain text: a time and a value a row") from error
    except (OSError, csv.Error) as error:
        raise UsageError(
            f"--follow: cannot be read: {getattr(error, 'strerror', None) or error}",
            path,
            "name a file that can be read",
        ) from error
    if any(mark in row[0] for row in rows for mark in ";\t"):
        raise UsageError("--follow: columns stand between commas", path, "write 0.5,1.25: decimals have points")
    heads = [word.strip() for word in rows.pop(0)] if rows and not _is_number(rows[0][0]) else []
    if name not in heads and len(heads) > 2:
        raise UsageError(f"--follow: there is no column '{name}'", path, nearest_name(name, heads[1:]))
    column = heads.index(name) if name in heads else 1
    if any(len(row) <= column for row in rows):
        raise UsageError(f"--follow: a row has no column {column + 1}", path, fix="write a time and a value a row")
    try:
        return samples([row[0].strip() for row in rows], [row[column].strip() for row in rows])
    except ModelError as error:
        raise UsageError(f"--follow: {error.problems[0].what}", path, fix=error.problems[0].fix) from error


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
