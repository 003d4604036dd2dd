"""What targets that are Python modules share: their head, their test, and how they are run here."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    RHS,
    Called,
    Description,
    Emitted,
    FileContent,
    Functions,
    Role,
    Single,
    Target,
    functions_by,
    header,
)
from eomgen.codegen.targets.in_single import SingleWords
from eomgen.errors import ToolMissing

_TEST = '''\
"""Held against the answers in test_vectors.json: python -m pytest"""

import json
import pathlib

import numpy as np
from {module} import {main}


def test_{main}_gives_the_values_of_its_test_vectors():
    told = json.loads((pathlib.Path(__file__).parent / "test_vectors.json").read_text(encoding="utf-8"))
    for v in told{where}["vectors"]:
        found = np.asarray({main}(v["t"], v["x"], {a}v["p"], v["inputs"]), dtype=float).ravel()
        right = np.array(v["{result}"], dtype=float)  # null: not a number
        assert found.shape == right.shape
        known = right == right
        assert np.isnan(found[~known]).all()
        largest = max([1.0, *abs(right[known])])
        assert (abs(found[known] - right[known]) <= v["tolerance"]*largest).all(), (found, right)
'''


def python_target(
    name: str, language: str, text: Callable[..., str], use: tuple[str, ...], single: SingleWords | None = None
) -> Target:
    """A language that is a Python package: STEM_NAME.py of the right-hand side, STEM_ROLE_NAME.py, and their tests.

    Args:
        name: of the package, too.
        language: in words.
        text: the module of a program.
        use: how it is imported, and what runs its tests.
        single: its words in single precision, where there are such.
    """

    def module(stem: str, role: Role) -> str:
        return f"{role.others(stem)}_{name}"

    def files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
        return {
            path: content
            for program, told in emitted
            for path, content in module_files(
                text(program, stem, told.role, told.remarks), module(stem, told.role), stem, program, told
            ).items()
        }

    def functions(program: Program) -> Functions:
        return functions_each(executed(text(program, "eomgen"), f"eomgen_{name}", name)["eomgen_rhs"], program)

    def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
        return called_each(texts, module(stem, role), program, stem, role, name)

    return Target(
        name,
        language,
        text,
        files,
        use,
        functions,
        run,
        single=Single(single.files, run) if single is not None else None,
    )


def module_files(text: str, module: str, stem: str, program: Program, told: Description) -> dict[str, str]:
    """The module and its test: MODULE.py, test_MODULE.py."""
    head = "\n".join(header(program, told)).replace("\\", "/").replace('"""', "'''")
    test = _TEST.format(
        module=module,
        main=told.role.main(stem),
        where="" if told.role is RHS else f'["{told.role.name}"]',
        a='v["a"], ' if program.accelerations else "",
        result=told.role.result,
    )
    return {f"{module}.py": f'"""{head}\n"""\n\n{text}'} | ({f"test_{module}.py": test} if told.vectors else {})


def executed(text: str, name: str, package: str = "") -> dict[str, Any]:
    """What a module holds: our own text, from the graph.

    Raises:
        ToolMissing: the package that it needs is not there.
    """
    space: dict[str, Any] = {"__name__": name}
    try:
        exec(compile(text, name, "exec"), space)
    except ImportError as error:
        raise ToolMissing(
            f"{package or name} cannot be imported: {error}", mend="pip install 'eomgen[languages]', or another target"
        ) from None
    return space


def functions_each(function: Callable[..., Any], program: Program) -> Functions:
    """A function of one state, (t, x, [a,] p, inputs or None), as those of a program."""
    n = len(program.states)

    def many(t: np.ndarray, x: np.ndarray, p: np.ndarray, inputs: np.ndarray | None) -> np.ndarray:
        found = np.empty((len(t), len(program.outputs)))
        for i, (instant, state) in enumerate(zip(t, x, strict=True)):
            given = (state[:n], state[n:]) if program.accelerations else (state,)
            found[i] = np.asarray(function(instant, *given, p, None if inputs is None else inputs[i])).ravel()
        return found

    return functions_by(many)


def called_each(
    texts: Mapping[str, FileContent], module: str, program: Program, stem: str, role: Role, package: str
) -> Called:
    """The same of the file that others get, at one state."""
    function = executed(str(texts[f"{module}.py"]), module, package)[role.main(stem)]

    def called(t: float, x: Any, a: Any, p: Any, inputs: Any) -> Any:
        given = (np.array(x, dtype=float), np.array(a, dtype=float))[: 1 + bool(program.accelerations)]
        acting = None if inputs is None else np.array(inputs, dtype=float)
        return np.asarray(function(t, *given, np.array(p, dtype=float), acting), dtype=float).ravel().tolist()

    return called
