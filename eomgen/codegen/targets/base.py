"""What a target gives: the text of a program in its language, and that text made callable."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.codegen.program import Program


@dataclass(frozen=True)
class Address:
    """Where a compiled right-hand side and its constants lie; `kept` keeps them there.

    Args:
        evaluate: of the function (t, x, p, c, inputs, dx).
        p, c: of its parameters and of what they determine.
    """

    evaluate: int
    p: int
    c: int
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
    """

    title: str
    origin: str
    remarks: Mapping[str, str]
    vectors: tuple[TestVector, ...] = ()
    role: Role = RHS
    outputs: tuple[str, ...] = ()


Called = Callable[[float, Sequence[float], Sequence[float], Sequence[float], Sequence[float] | None], Sequence[float]]
"""(t, x, a, p, inputs or None) -> the outputs; a is () where it is no argument."""


@dataclass(frozen=True)
class Target:
    """A language that programs are written in.

    Args:
        name: as the user says it.
        about: the language, and what its files need.
        text: (program, stem, role) -> its functions in the language.
        files: (program, stem, description) -> {file name: text}, ready to be used by others.
        load: the program, callable.
        run: (those files, program, stem, role) -> (t, x, a, p, inputs or None) -> outputs: the very text that others
            get, run here; None where nothing here runs the language.
    """

    name: str
    about: str
    text: Callable[[Program, str, Role], str]
    files: Callable[[Program, str, Description], dict[str, str]]
    load: Callable[[Program], Functions]
    run: Callable[[Mapping[str, str], Program, str, Role], Called] | None = None


def header(program: Program, description: Description) -> list[str]:
    """Title, origin, and the order of x, p, inputs and named outputs, a line each."""
    symbols, result = program.symbols, description.role.result
    lines = [f"{description.title}: {description.role.about}", ""]
    lines += [description.origin, ""]
    groups = {
        "x": program.states,
        "a": program.accelerations,
        "p": symbols.parameters.values(),
        "inputs": symbols.inputs.values(),
    }
    for array, members in groups.items():
        for place, x in enumerate(members):
            remark = description.remarks.get(x.name, "")
            lines.append(f"    {array}[{place}]  {x.name}{'  ' + remark if remark else ''}")
    for place, name in enumerate(description.outputs):
        lines.append(f"    {result}[{place}]  {name}  {description.remarks.get(name, '')}".rstrip())
    if not description.outputs:
        lines.append(f"    {result}  {len(program.outputs)} values, in the order of x")
    return [" ".join(line.split("\n")) for line in lines]
