"""What targets that are Python modules share: their head, their test, and how they are run here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from eomgen.codegen.lowered import Language
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Called, FileContent, Functions, Role, Single, Target, functions_by
from eomgen.codegen.targets.form import FileForm
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
    for v in told{of_role}["vectors"]:
        found = np.asarray({main}(v["t"], v["x"], {a_of_v}v["p"], v["inputs"]), dtype=float).ravel()
        right = np.array(v["{result}"], dtype=float)  # null: not a number
        assert found.shape == right.shape
        known = right == right
        assert np.isnan(found[~known]).all()
        largest = max([1.0, *abs(right[known])])
        assert (abs(found[known] - right[known]) <= v["tolerance"]*largest).all(), (found, right)
'''


def python_form(
    language: Language, named: str, module: str, given: Mapping[str, tuple[str, str]], **words: Any
) -> FileForm:
    """The form of a language that is Python: NAMED.py, a module, and its test."""
    return FileForm(
        language,
        module,
        f"{named}.py",
        f"test_{named}.py",
        '"""{head}\n"""\n\n{text}',
        told=lambda line: line.replace("\\", "/").replace('"""', "'''"),
        given={**given, "a_of_v": ('v["a"], ', "")},
        test=_TEST.replace("{module}", named),
        **words,
    )


def python_target(
    name: str, language: str, form: FileForm, use: tuple[str, ...], single: SingleWords | None = None
) -> Target:
    """A language that is a Python package: STEM_NAME.py of the right-hand side, STEM_ROLE_NAME.py, and their tests.

    Args:
        name: of the package, too.
        language: in words.
        use: how it is imported, and what runs its tests.
        single: its words in single precision, where there are such.
    """

    def functions(program: Program) -> Functions:
        return functions_each(executed(form.text(program, "eomgen"), f"eomgen_{name}", name)["eomgen_rhs"], program)

    def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
        return called_each(str(texts[form.path_of(program, stem, role)]), program, role.main(stem), name)

    in_single = Single(single.files, run) if single else None
    return Target(name, language, form.text, form.files, use, functions, run, single=in_single)


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


def called_each(text: str, program: Program, main: str, package: str) -> Called:
    """The same of the file that others get, at one state."""
    function = executed(text, main, package)[main]

    def called(t: float, x: Any, a: Any, p: Any, inputs: Any) -> Any:
        given = (np.array(x, dtype=float), np.array(a, dtype=float))[: 1 + bool(program.accelerations)]
        acting = None if inputs is None else np.array(inputs, dtype=float)
        return np.asarray(function(t, *given, np.array(p, dtype=float), acting), dtype=float).ravel().tolist()

    return called
