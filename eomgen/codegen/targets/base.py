"""What a target gives: the text of a program in its language, and that text made callable."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.codegen.program import Program
from eomgen.records import dataclass


@dataclass(frozen=True)
class Address:
    """Where a compiled right-hand side and its constants lie; `kept` keeps them there.

    Args:
        evaluate: of the function (t, x, p, c, inputs, dx).
        p, c: of its parameters and of what they determine.
        constants: of the function (p, c) that makes the latter.
    """

    evaluate: int
    p: int
    c: int
    constants: int
    kept: Any


@dataclass(frozen=True)
class Functions:
    """A program in memory.

    Args:
        constants: p, an array -> what the parameters determine, p included, in a form that only `one` reads.
        one: (t, x, constants, inputs or None) -> a new array of the outputs; x with a after it, where a is an argument.
        many: the same of n instants at once: t n, x n x states, p, inputs None or n x inputs -> n x outputs.
        address: constants -> where all of it lies in memory, for other compiled functions; None where that is nowhere.
    """

    constants: Callable[[Any], Any]
    one: Callable[..., np.ndarray]
    many: Callable[..., np.ndarray]
    address: Callable[[Any], Address] | None = None


@dataclass(frozen=True)
class TestVector:
    """A right answer: the result at (t, x, p), and a where it is an argument, by the model's own inputs or given ones.

    Args:
        result: in the order of the program's outputs.
        tolerance: of |result - given| / max(1, largest |result|).
    """

    t: float
    x: tuple[float, ...]
    p: tuple[float, ...]
    inputs: tuple[float, ...] | None
    result: tuple[float, ...]
    tolerance: float
    a: tuple[float, ...] = ()


@dataclass(frozen=True)
class Role:
    """What a program is for, and what its text is called.

    Args:
        name: of the files and the main function: NAME_rhs.
        prefix: of the other functions: NAME + prefix + _many.
        result: the array of the outputs.
        about: what it computes, one line.
    """

    name: str
    prefix: str
    result: str
    about: str

    def main(self, stem: str) -> str:
        return f"{stem}_{self.name}"

    def others(self, stem: str) -> str:
        return f"{stem}{self.prefix}"


RHS = Role("rhs", "", "dx", "dx = f(t, x, p), the equations of motion solved for the accelerations")
INVERSE = Role("inverse", "_inverse", "tau", "tau = f(t, x, a, p), the forces and torques that accelerations a take")
REACTIONS = Role("reactions", "_reactions", "out", "out = f(t, x, p), the reactions of joints and ties in the motion")


OUTPUTS = Role("outputs", "_outputs", "out", "out = f(t, x, p), what the model asks in [outputs], in SI")
MATRICES = Role(
    "matrices",
    "_matrices",
    "out",
    "out = f(t, x, p), of M a = forcing + J^T lam and, where ties close, J a + gamma = 0",
)
REGRESSOR = Role(
    "regressor",
    "_regressor",
    "out",
    "out = f(t, x, a, p), of tau + J^T lam = Y pi + y0 = Y_base base + y0, tau what the inputs push",
)
JACOBIAN = Role("jacobian", "_jacobian", "out", "out = f(t, x, p), A = d x'/d x and B = d x'/d inputs")


@dataclass(frozen=True)
class Description:
    """What emitted files say about themselves.

    Args:
        title: the model's name.
        origin: who made the file from what, one line.
        remarks: of the name of an argument or output: its unit and what it is.
        vectors: right answers, for the self-test.
        role: what the program is for.
        outputs: names of the outputs, () where they are in the order of x.
        blocks: (name, rows, columns) of matrices that are the outputs, one after the other, each row after row.
        columns: of each block what its columns stand for; () of none, or of all.
    """

    title: str
    origin: str
    remarks: Mapping[str, str]
    vectors: tuple[TestVector, ...] = ()
    role: Role = RHS
    outputs: tuple[str, ...] = ()
    blocks: tuple[tuple[str, int, int], ...] = ()
    columns: tuple[tuple[str, ...], ...] = ()


FileContent = str | bytes
Emitted = tuple[Program, Description]
"""A program and what its files say of it."""

Called = Callable[[float, Sequence[float], Sequence[float], Sequence[float], Sequence[float] | None], Sequence[float]]
"""(t, x, a, p, inputs or None) -> the outputs; a is () where it is no argument."""


@dataclass(frozen=True)
class Single:
    """A language in single precision.

    Args:
        files: its files in doubles -> the same in single precision.
        run: these, as of `Target`.
    """

    files: Callable[[Mapping[str, FileContent]], dict[str, FileContent]]
    run: Callable[[Mapping[str, FileContent], Program, str, Role], Called]


@dataclass(frozen=True)
class Target:
    """A language that programs are written in.

    Args:
        name: as the user says it.
        about: the language, and what its files need.
        text: (program, stem, role) -> its functions in the language.
        files: (stem, what is emitted, the right-hand side first) -> {path: content}, ready to be used by others.
        use: how they are used and tested, a line each, {stem} among them.
        load: the program, callable.
        run: (those files, program, stem, role) -> (t, x, a, p, inputs or None) -> outputs: the very text that others
            get, run here; None where nothing here runs the language.
        roles: names of the functions that it writes; None: all.
        single: the same in single precision; None where its numbers are doubles.
    """

    name: str
    about: str
    text: Callable[[Program, str, Role], str]
    files: Callable[[str, Sequence[Emitted]], dict[str, FileContent]]
    use: tuple[str, ...]
    load: Callable[[Program], Functions]
    run: Callable[[Mapping[str, FileContent], Program, str, Role], Called] | None = None
    roles: tuple[str, ...] | None = None
    single: Single | None = None

    def writes(self, role: Role) -> bool:
        """Whether a function is among its files."""
        return self.roles is None or role.name in self.roles


Many = Callable[[np.ndarray, np.ndarray, np.ndarray, "np.ndarray | None"], np.ndarray]
"""(t n, x n x states with a beside it, p, inputs None or n x inputs) -> n x outputs."""


def functions_by(many: Many) -> Functions:
    """A function of many instants as those of a program in memory."""

    def one(t: float, x: Any, p: np.ndarray, inputs: Any) -> np.ndarray:
        given = None if inputs is None else np.array([inputs], dtype=float)
        found: np.ndarray = many(np.array([t], dtype=float), np.array([x], dtype=float), p, given)[0]
        return found

    return Functions(
        lambda p: np.array(p, dtype=float), one, lambda t, x, p, inputs: many(t, x, np.array(p, dtype=float), inputs)
    )


def called_by(many: Many) -> Called:
    """The same at one state."""

    def called(t: float, x: Any, a: Any, p: Any, inputs: Any) -> Sequence[float]:
        given = None if inputs is None else np.array([inputs], dtype=float)
        state = np.array([[*x, *a]], dtype=float)
        found: list[float] = many(np.array([t], dtype=float), state, np.array(p, dtype=float), given)[0].tolist()
        return found

    return called
