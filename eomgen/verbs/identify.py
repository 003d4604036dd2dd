"""eomgen identify: parameters from a measured motion."""

from __future__ import annotations

import csv
from dataclasses import replace
from typing import Any

import numpy as np

from eomgen.documents import Document, Lines, plain_document, prose, proven
from eomgen.errors import UsageError
from eomgen.files import read
from eomgen.identification import Identified, Regressor, identify, regressor
from eomgen.model import Model

LARGEST = 200_000_000  # bytes of a file
BIASED = (
    "rates come of noisy columns, which moves parameters by more than their deviations say, by about as far as each "
    "line says: measure rates and accelerations, or filter all columns alike"
)
POOR = 100.0  # a condition number beyond which parameters can hardly be distinguished


def identify_document(model: Model, *, data: str | None = None, certify: bool = True) -> Document:
    """The parameters that fit a measured motion; without one the groups of them that motions can distinguish.

    Raises:
        UsageError: the file holds no samples of the coordinates.
    """
    if data is None:
        groups = regressor(model)
        return proven(_groups_reported(groups), groups.certify() if certify else None)
    found = identify(model, columns_of(data))
    width = max(map(len, (*found.base, *found.values)), default=0)
    poor = f" (poor: beyond {POOR:g})" if found.condition > POOR else ""
    lines = [
        f"{len(found.base)} base parameters from {found.samples} samples, residual {found.residual:.6g}",
        f"condition of the motion: {found.condition:.6g}{poor}",
        "",
        "base parameters (least squares, standard deviation)",
        *(
            f"    {name:{width}}  {x:.9g} +- {deviation:.2g}{_shift(found, name)}"
            for name, (x, deviation) in found.base.items()
        ),
        "",
        f"parameters of bodies of positive density, residual {found.consistent_residual:.6g}",
        *(f"    {name:{width}}  {x:.9g}" for name, x in found.values.items()),
    ]
    document = plain_document(model, lambda: _entries(found), Lines(tuple(lines)))
    document = replace(document, notes=(*document.notes, *([BIASED] if found.biased else [])))
    return proven(document, found.certify() if certify else None)


def _groups_reported(found: Regressor) -> Document:
    """The base parameters of any motion."""
    base = found.base
    width = max((len(group.name) for group in base.groups), default=0)
    lines = [
        f"{len(base)} base parameters of {len(found.parameters)} parameters, as many as the rank of Y in "
        f"tau + J^T lam = Y pi + y0 ({base.arithmetic})",
        "",
        *(f"    {group.name:{width}}  {group.formula}" for group in base.groups),
        "",
    ]
    rest = [prose(f"Without effect: {', '.join(base.without_effect)}.")] if base.without_effect else []
    entries = {
        "name": found.model.name,
        "parameters": list(found.parameters),
        "base": {group.name: {"formula": group.formula, "factors": group.numbers} for group in base.groups},
        "without_effect": list(base.without_effect),
        "arithmetic": base.arithmetic,
    }
    return plain_document(found.model, lambda: entries, Lines(tuple(lines)), *rest)


def _shift(found: Identified, name: str) -> str:
    return f", noise moved it by about {found.bias[name]:.2g}" if name in found.biased else ""


def _entries(found: Identified) -> dict[str, Any]:
    return {
        "name": found.regressor.model.name,
        "samples": found.samples,
        "condition": found.condition,
        "residual": found.residual,
        "base": {name: {"value": x, "deviation": deviation} for name, (x, deviation) in found.base.items()},
        "bias": dict(found.bias),
        "values": found.values,
        "consistent_residual": found.consistent_residual,
    }


def columns_of(path: str) -> dict[str, np.ndarray]:
    """The columns of a CSV by the names in its first line.

    Raises:
        UsageError: it cannot be read, or something in it is no number.
    """
    try:
        lines = read(path, LARGEST).decode("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"cannot be read: {error}", path, "name a CSV file") from error
    rows = [row for row in csv.reader(lines) if row and not row[0].lstrip().startswith("#")]
    names = [name.strip() for name in rows[0]] if rows else []
    try:
        numbers = np.array([[float(x) for x in row] for row in rows[1:]])
    except ValueError as error:
        raise UsageError(
            f"a value is no number: {error}", path, "write names in the first line, then numbers"
        ) from error
    if len(numbers) < 2:
        raise UsageError("it has fewer than two rows of numbers", path, "write names in the first line, then numbers")
    if numbers.ndim != 2 or numbers.shape[1] != len(names):
        raise UsageError("its rows are not as long as its first line", path, "write a number under every name")
    return {name: numbers[:, k] for k, name in enumerate(names)}
