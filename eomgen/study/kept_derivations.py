"""Cache of proven derivations: one is found by the content of all that it depends on, and checked before it is shown.

Cached are the text, the lines printed with it and the exit code of results whose certificate holds. An entry is found
by the digest of the model's text, the options, every file of this package, and the versions below. It is trusted where

    the file is this user's alone, whole, and made for this key (`eomgen.disk_cache`), and
    the equations of motion, derived anew from the model as it was read now, have the values that they had then

in doubles, at a state that the key draws: M a - forcing - J^T lam, J a + gamma, J u + sigma, N u + nu, T and V, bit for
bit. That is of the equations; how they are written, and that they were proven, the digest alone says. The state is
drawn by no secret: the cache does not protect against somebody who may write as this user.
"""

from __future__ import annotations

import json
import platform
from collections.abc import Mapping, Sequence
from functools import cache
from hashlib import sha256
from pathlib import Path
from random import Random
from typing import Any

import numpy

from eomgen import disk_cache
from eomgen.errors import EomgenError
from eomgen.files import beside
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import equations_of_motion
from eomgen.mechanics.kinematics import ContactModes
from eomgen.model import Model
from eomgen.symbolic.expression import Scalar, inner, symbols_of
from eomgen.symbolic.numeric import FLOAT, evaluate

SUFFIX = ".json"
ENTRY = {"key": str, "values": list, "text": str, "lines": list, "code": int}
LIBRARIES = ("numpy", "quicktions", "python_flint", "sympy", "scipy")


@dataclass(frozen=True)
class CachedDerivation:
    """One derivation of the cache.

    Args:
        key: the digest of all that it depends on.
        model: as it was read now.
    """

    key: str
    model: Model

    def found(self) -> tuple[str, tuple[str, ...], int] | None:
        """(text, lines, code) as they were printed; None where it was not derived before, or is not trusted."""
        for path, content in disk_cache.contents(disk_cache.cache_place(), self.key[:32], SUFFIX):
            entry = _entry(content)
            if entry is not None and entry["key"] == self.key and entry["values"] == self.values:
                disk_cache.used(path)
                return entry["text"], tuple(entry["lines"]), entry["code"]
        return None

    def keep(self, text: str, lines: tuple[str, ...], code: int) -> None:
        """Stores what was printed; does nothing where it cannot be written."""
        values = self.values
        if values is None:
            return
        entry = {"key": self.key, "values": values, "text": text, "lines": lines, "code": code}
        try:
            with beside(disk_cache.cache_place()) as place:
                made = place / f"made{SUFFIX}"
                made.write_text(json.dumps(entry), encoding="utf-8")
                disk_cache.put_whole(made, disk_cache.cache_place(), self.key[:32])
        except OSError:
            return

    @property
    def values(self) -> list[str] | None:
        """The equations of motion at a state that the key draws, to the last bit; None where they have none."""
        try:
            return _values(self.model, Random(self.key))
        except EomgenError:
            return None


def cached_derivation(data: bytes, name: str, model: Model, requested: Mapping[str, Any]) -> CachedDerivation | None:
    """The entry of a derivation in the cache; None where this package is not made of files.

    Args:
        data: the model's text.
        name: of its file, in error messages.
        model: the model that was read from it, with the values that were typed.
        requested: all that was typed besides.
    """
    package = _package()
    if package is None:
        return None
    others = () if model.repeat is None else model.repeat.parts  # files of parts
    parts = (package, repr(name).encode(), repr(sorted(requested.items())).encode(), data, repr(others).encode())
    content = b"".join(len(part).to_bytes(8, "big") + part for part in parts)
    return CachedDerivation(sha256(content).hexdigest(), model)


@cache
def _package() -> bytes | None:
    """This package, file by file, the version of Python and those of the libraries that it stands on."""
    root = Path(__file__).parents[1]
    if not root.is_dir():
        return None
    found = sha256(platform.python_version().encode() + platform.platform().encode())
    for path in sorted((*root.rglob("*.py"), *root.rglob("*.json"))):
        content = path.read_bytes()
        found.update(f"{path.relative_to(root)}\0{len(content)}\0".encode() + content)
    beside_numpy = Path(numpy.__file__).parents[1]
    found.update(repr(sorted(x.name for name in LIBRARIES for x in beside_numpy.glob(f"{name}-*.dist-info"))).encode())
    return found.digest()


def _entry(content: bytes) -> dict[str, Any] | None:
    try:
        entry = json.loads(content)
    except ValueError:
        return None
    whole = isinstance(entry, dict) and {name: type(x) for name, x in entry.items()} == ENTRY
    return entry if whole else None


def _values(model: Model, rng: Random) -> list[str]:
    equations = equations_of_motion(System.of(model, _modes(model)))
    symbols = equations.symbols
    balance, constraints = equations.residual
    rows = [*balance, *constraints, *_linear(equations.J, symbols.u, equations.sigma)]
    rows += [*_linear(equations.N, symbols.u, equations.nu), equations.T, equations.V]
    state = {x: rng.uniform(0.3, 1.2) for x in sorted(symbols_of(rows), key=lambda x: x.name)}
    return [float(x).hex() for x in evaluate(rows, state, FLOAT)]


def _linear(A: Sequence[Sequence[Scalar]], x: Sequence[Scalar], b: Sequence[Scalar]) -> list[Scalar]:
    """A x + b"""
    return [inner(row, x) + bias for row, bias in zip(A, b, strict=True)]


def _modes(model: Model) -> ContactModes | None:
    """Contact modes at the start; None if the model has no contacts."""
    if not model.contacts:
        return None
    from eomgen.mechanics.statics import ContactsAtStart

    return ContactsAtStart.of(model).modes
