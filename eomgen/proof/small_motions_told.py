"""What is printed of small motions -> checks: it is that which machines get of them, and texts are worth their numbers.

Everything is taken as it stands, {"exact": [["c_f + c_r"]], "value": [[0.0]]}, M = [m  0], "mode 2", "oscillates and
fades". The entries for machines are proven by themselves (`linear_entries`), but for the shapes and transfer functions:

    (A - lambda) (v, u) = 0 with some u,     W = (s 1 - A)^-1 B at a number s
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import ExpressionError
from eomgen.proof.check import Check, Tally, differing
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import LONGEST, parse
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import (
    CARRIED,
    COMPUTED,
    SAME_PLACE,
    SEVEN_DIGITS,
    SLOW,
    SOLVED,
)

NAME, HOW = "what is printed of small motions is what machines get of them", "texts and numbers read back"
MATRICES = ("mass", "rates", "stiffness", "input", "kinematic_rates", "kinematic_places")
PARTS = ("damping", "gyroscopic", "circulatory")


@dataclass(frozen=True)
class PrintedModes:
    """What is printed of small motions.

    Args:
        matrices: in numbers, by their letters.
        modes: the cells of the table of modes, without its head: by the words of the head.
        shapes: of each coordinate the cells of its row.
        conditions: in numbers, in their order.
    """

    matrices: Mapping[str, Sequence[Sequence[float]]]
    modes: Sequence[Mapping[str, str]] = ()
    shapes: Mapping[str, Sequence[str]] = ()  # type: ignore[assignment]
    conditions: Sequence[float] = ()


def small_motions_told(entries: Mapping[str, Any], printed: PrintedModes, values: Mapping[str, Any]) -> Iterator[Check]:
    """Whatever has numbers.

    Args:
        entries: as machines get them.
        values: of the parameters.
    """
    if entries["state_matrix"] is None:
        return
    told = ToldMotions(entries, printed, {name: float(x) for name, x in values.items()})
    tally = Tally(NAME, HOW)
    for what, wrong in told.everything():
        tally.add(what, wrong)
    yield from tally.checks()


@dataclass(frozen=True)
class ToldMotions:
    """Small motions as machines get them: their matrices by name, in the shapes that they should have."""

    entries: Mapping[str, Any]
    printed: PrintedModes
    values: Mapping[str, float]

    def everything(self) -> Iterator[tuple[str, Callable[[], str]]]:
        for name in (*MATRICES, *PARTS):
            if name in self.entries:
                yield name, lambda name=name: self._texts(self.entries[name])  # type: ignore[misc]
        for name in ("A", "B", "C_y", "D_y"):
            yield name, lambda name=name: self._texts(self.entries["state_space"][name])  # type: ignore[misc]
        for k in range(len(self.entries["modes"])):
            yield f"the shape of mode {k + 1}", lambda k=k: self._shape(self.entries["modes"][k])  # type: ignore[misc]
        yield "matrices as they are printed", self._printed_matrices
        yield "modes as they are printed", self._printed_modes
        yield "conditions as they are printed", self._printed_conditions
        for transfer in self.entries["transfer_functions"]:
            yield f"{transfer['coordinate']}/{transfer['input']}", lambda t=transfer: self._transfer(t)  # type: ignore[misc]

    def matrix(self, name: str) -> np.ndarray:
        """In numbers."""
        return self.shaped(name, np.array(self.entries[name]["value"], dtype=float))

    def shaped(self, name: str, found: np.ndarray) -> np.ndarray:
        shape = {"input": (self.n, len(self.entries["inputs"])), "kinematic_rates": (self.m, self.n)}.get(name)
        return found.reshape(shape) if shape is not None and not found.size else found

    @property
    def n(self) -> int:
        return len(self.entries["speeds"])

    @property
    def m(self) -> int:
        return len(self.entries["coordinates"])

    def _texts(self, entry: Mapping[str, Any]) -> str:
        """Each exact text is worth its number."""
        if entry["exact"] is None or entry["value"] is None:
            return ""
        numbers = np.array(entry["value"], dtype=float)
        size = float(np.max(np.abs(numbers), initial=0.0))
        for row, right in zip(entry["exact"], entry["value"], strict=True):
            for text, number in zip(row, right, strict=True):
                found = self._worth(text, self.values)
                if abs(found - number) > COMPUTED * (size + abs(found)):
                    return f"{text[:60]}: {differing(found, number) or found}"
        return ""

    def _worth(self, text: str, values: Mapping[str, float]) -> float:
        """A text of the grammar in numbers.

        Raises:
            NoValue: it holds what has none.
        """
        if len(text) > 10 * LONGEST:
            raise NoValue("too long to be read back")
        try:
            expression = parse(text, longest=len(text))
        except ExpressionError as error:
            raise NoValue(error.what) from error
        if expression.calls or not expression.names <= values.keys() | {"pi"}:
            raise NoValue(f"'{text[:60]}' is not of parameters alone")
        return float(expression.evaluate({**values, "pi": math.pi}))

    # -- modes ---------------------------------------------------------------------------------------------

    @cached_property
    def A(self) -> np.ndarray:
        """As it is told, which is proven by itself."""
        return np.array(self.entries["state_matrix"], dtype=float)

    def _shape(self, mode: Mapping[str, Any]) -> str:
        """(A - lambda) (v, u) = 0 with some u."""
        x, shape, names = complex(*mode["eigenvalue"]), mode["shape"], self.entries["coordinates"]
        if not x or not all(name in shape for name in names):
            return ""
        v = np.array([complex(*shape[name]) for name in names])
        if not np.any(v):
            return ""
        pencil = self.A - x * np.eye(len(self.A))
        pencil = pencil / (abs(pencil).max(axis=1) + SLOW * abs(x))[:, None]
        u = np.linalg.lstsq(pencil[:, self.m :], -pencil[:, : self.m] @ v, rcond=None)[0]
        whole = np.concatenate([v, u])
        left, size = abs(pencil @ whole), abs(pencil) @ abs(whole)
        return "its shape is no motion of that eigenvalue" if np.any(left > CARRIED * (size + abs(whole).max())) else ""

    # -- as they are printed ---------------------------------------------------------------------------------

    def _printed_matrices(self) -> str:
        letters = dict(zip("MCKEFDGH", (*MATRICES[:3], *MATRICES[4:], *PARTS), strict=True))
        space = self.entries["state_space"]
        for letter, rows in self.printed.matrices.items():
            if letter == "B":
                rights = [self.matrix("input"), np.array(space["B"]["value"], dtype=float)]
            elif letter in letters and letters[letter] in self.entries:
                rights = [self.matrix(letters[letter])]
            elif letter in ("A", "C_y", "D_y"):
                rights = [np.array(space[letter]["value"], dtype=float)]
            else:
                continue
            found = np.array(rows, dtype=float)
            if all(found.shape != right.shape or _differ(found, right, SEVEN_DIGITS) for right in rights):
                return f"{letter} is another for machines"
        return ""

    def _printed_modes(self) -> str:
        modes = self.entries["modes"]
        if not self.printed.modes:
            return ""
        if len(self.printed.modes) != len(modes):
            return f"{len(self.printed.modes)} rows for {len(modes)} modes"
        for k, (row, mode) in enumerate(zip(self.printed.modes, modes, strict=True)):
            frequency = getattr(mode["frequency"], "value", mode["frequency"])
            wanted = {
                "omega [rad/s]": frequency,
                "f [Hz]": mode["hertz"],
                "damping ratio": mode["damping_ratio"],
            }
            for head, right in wanted.items():
                text = row.get(head, "")
                if (text == "") != (right is None) or (text and differing(float(text), right or 0.0, SEVEN_DIGITS)):
                    return f"mode {k + 1}, {head}: {text} for {right}"
            if row.get("", "") != mode["kind"] or row.get("mode") != str(k + 1):
                return f"mode {k + 1}: '{row.get('', '')}' for '{mode['kind']}'"
            if not _is_complex(row.get("eigenvalue [1/s]", ""), complex(*mode["eigenvalue"])):
                return f"mode {k + 1}: {row.get('eigenvalue [1/s]')} for {complex(*mode['eigenvalue']):.7g}"
        for name, cells in self.printed.shapes.items():
            for k, cell in enumerate(cells):
                if not _is_complex(cell, complex(*modes[k]["shape"][name]), 2 * SEVEN_DIGITS):
                    return f"mode {k + 1}, {name}: {cell} for {complex(*modes[k]['shape'][name]):.7g}"
        return ""

    def _printed_conditions(self) -> str:
        told = self.entries["conditions"]
        if len(told) != len(self.printed.conditions):
            return f"{len(self.printed.conditions)} are printed of {len(told)}" if self.printed.conditions else ""
        for text, number in zip(told, self.printed.conditions, strict=True):
            if not math.isnan(number) and (wrong := differing(number, self._worth(text, self.values), SEVEN_DIGITS)):
                return wrong
        return ""

    def _transfer(self, told: Mapping[str, Any]) -> str:
        """(s 1 - A)^-1 B at a number s."""
        i, j = self.entries["coordinates"].index(told["coordinate"]), self.entries["inputs"].index(told["input"])
        B = np.array(self.entries["input_matrix"]).astype(complex)
        sizes = abs(np.linalg.eigvals(self.A))
        rate = float(np.mean(sizes[sizes > 0])) if np.any(sizes > 0) else 1.0
        for s in (rate * (0.7 + 0.9j), rate * (-0.4 + 2.3j)):
            answers = np.linalg.solve(s * np.eye(len(self.A)) - self.A, B)[:, j]
            above, below = (
                sum(self._worth(text, self.values) * s**k for k, text in enumerate(told[part]))
                for part in ("numerator", "denominator")
            )
            if abs(above / below - answers[i]) > SAME_PLACE * abs(answers).max():
                return f"{above / below:.6g} for {answers[i]:.6g} at s = {s:.4g}"
        return ""


def _differ(a: np.ndarray, b: np.ndarray, share: float = COMPUTED) -> bool:
    """Entries are judged beside the largest of their rows and columns."""
    if a.size == b.size == 0:
        return False
    if a.shape != b.shape:
        return True
    size = np.maximum(abs(a), abs(b))
    usual = np.minimum.outer(size.max(axis=1), size.max(axis=0))
    return bool(np.any(abs(a - b) > share * (size + usual) + SOLVED * size.max()))


def _is_complex(text: str, right: complex, share: float = SEVEN_DIGITS) -> bool:
    """Whether 1.2 +- 3.4i is that number, or its conjugate."""
    pieces = text.replace("+-", "+").replace("+ ", "+").replace("- ", "-").replace("i", "j").replace(" ", "")
    try:
        found = complex(pieces)
    except ValueError:
        return False
    return abs(found - right) <= share * (1 + abs(right))
