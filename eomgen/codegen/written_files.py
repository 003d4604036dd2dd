"""Programs -> the functions that are written of a model, with their right answers, and files that others can use."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from types import MappingProxyType

from eomgen.codegen.program import Program, stem_of
from eomgen.codegen.rhs import target_named, targets_named
from eomgen.codegen.right_answers import single_error, single_vectors, vectors
from eomgen.codegen.targets.base import Called, Description, Emitted, FileContent, Role, Target, TestVector, header
from eomgen.codegen.targets.c_lanes import RUN_USE, integrator_files
from eomgen.errors import visible
from eomgen.files import json_text
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import ScalarRows
from eomgen.symbolic.numeric import tolerances
from eomgen.version import SCHEMA_VERSION


@dataclass(frozen=True)
class Emitter:
    """The right-hand side of a model, and what is written of further functions beside it.

    Args:
        title, origin, remarks: as of `Description`.
        program: the right-hand side.
        x0, p0: the start and the values of the parameters, None where one is missing.
        held: (t, x, p) at which all constraints are satisfied: right answers there too.
    """

    title: str
    origin: str
    remarks: Mapping[str, str]
    program: Program
    x0: Sequence[float] | None
    p0: Sequence[float] | None
    held: Sequence[tuple[float, Sequence[float], Sequence[float]]]

    @cached_property
    def motion(self) -> Emitted:
        """The right-hand side, described.

        Raises:
            DerivationError: it has no value at any state that was tried.
        """
        return self.program, Description(self.title, self.origin, self.remarks, self._answers(self.program))

    def function(self, role: Role, program: Program, outputs: tuple[str, ...] = ()) -> Emitted:
        """A further function, described.

        Args:
            outputs: names of its outputs.
        """
        described = self.motion[1]
        return program, replace(described, vectors=self._answers(program), role=role, outputs=outputs)

    def matrices(
        self, role: Role, program: Program, blocks: Mapping[str, ScalarRows], columns: tuple[tuple[str, ...], ...] = ()
    ) -> Emitted:
        """A further function whose outputs are the entries of matrices, described.

        Args:
            columns: of each the names of its columns.
        """
        _, described = self.function(role, program)
        sizes = tuple((name, len(rows), len(rows[0])) for name, rows in blocks.items())
        return program, replace(described, blocks=sizes, columns=columns)

    def _answers(self, program: Program) -> tuple[TestVector, ...]:
        return vectors(program, x0=self.x0, p0=self.p0, held=self.held)


@dataclass(frozen=True)
class Written:
    """One function of generated code.

    Args:
        target: name of the language.
        texts: its files in doubles, {path: content}.
        program, stem, role: the program, and the names under which it was written.
        vectors: the states of its test vectors.
    """

    target: str
    texts: Mapping[str, FileContent]
    program: Program
    stem: str
    role: Role
    vectors: tuple[TestVector, ...]

    @property
    def name(self) -> str:
        """Its name in the files, before those of other functions."""
        return self.role.main(self.stem)

    def called(self) -> Called | None:
        """The written function, compiled; None where the language cannot be run here.

        Raises:
            ToolMissing, RunFailed: its compiler is not there, or refuses it.
        """
        target = target_named(self.target)
        return None if target.run is None else target.run(self.texts, self.program, self.stem, self.role)


@dataclass(frozen=True)
class Files:
    """Files of functions in languages.

    Args:
        name: of the functions: the model file's stem; other characters are replaced.
        emitted: the right-hand side first, then reactions and whatever else is requested.
        targets: names of languages; the files of one lie in the directory, of several each in its own.
        notes: omissions of the code, with their reasons, a line each.
        begin: (states, values of the parameters) in the program of an integrator of its own in C, None where one is
            missing; None: without an integrator.
        float32: True for single precision everywhere.
    """

    name: str
    emitted: tuple[Emitted, ...]
    targets: tuple[str, ...]
    notes: tuple[str, ...] = ()
    begin: tuple[Sequence[float] | None, Sequence[float] | None] | None = None
    float32: bool = False

    @cached_property
    def texts(self) -> dict[str, FileContent]:
        """{path: content} of every file."""
        if not self.float32:
            return self._in_doubles
        found = self._texts(
            [(p, replace(described, vectors=single_vectors(p, described.vectors))) for p, described in self.emitted]
        )
        for target in targets_named(self.targets):
            folder = self._folder(target.name)
            assert target.single is not None
            found |= {f"{folder}{path}": text for path, text in target.single.files(_inside(found, folder)).items()}
        return found

    def of(self, target: str) -> dict[str, FileContent]:
        """The files of one language."""
        return _inside(self.texts, self._folder(target))

    def functions(self, target: str) -> tuple[Written, ...]:
        """All functions, as a language has them in doubles."""
        texts = self._in_doubles if self.float32 else self.texts
        texts, stem = _inside(texts, self._folder(target)), stem_of(self.name)
        return tuple(Written(target, texts, p, stem, each.role, each.vectors) for p, each in self.emitted)

    def written(self, target: str) -> tuple[Written, ...]:
        """Functions that the language writes."""
        language = target_named(target)
        return tuple(each for each in self.functions(target) if language.writes(each.role))

    def single_error(self, function: Written) -> float:
        """The largest error of a function in single precision, run, against the tolerances of its test vectors.

        Raises:
            ToolMissing, RunFailed: its compiler is not there, or refuses it.
        """
        target = target_named(function.target)
        assert target.single is not None
        called = target.single.run(self.of(function.target), function.program, function.stem, function.role)
        return single_error(called, single_vectors(function.program, function.vectors))

    def _folder(self, target: str) -> str:
        return "" if len(self.targets) == 1 else f"{target}/"

    @cached_property
    def _in_doubles(self) -> dict[str, FileContent]:
        return self._texts(self.emitted)

    def _texts(self, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
        uses = {} if self.begin is None else {"c": [RUN_USE]}
        texts = texts_of(self.name, emitted, targets=self.targets, notes=self.notes, uses=uses)
        found = texts | {f"{self._folder('c')}{name}": text for name, text in self._integrator.items()}
        return {path: visible(text) if isinstance(text, str) else text for path, text in found.items()}

    @property
    def _integrator(self) -> dict[str, str]:
        if self.begin is None:
            return {}
        rtol = tolerances.SINGLE if self.float32 else tolerances.RUN
        return integrator_files(stem_of(self.name), self.emitted[0][0], *self.begin, rtol)


def _inside(texts: Mapping[str, FileContent], folder: str) -> dict[str, FileContent]:
    """The files of one language."""
    return {path.removeprefix(folder): text for path, text in texts.items() if path.startswith(folder)}


# -------- texts -----------------------------------------------------------------------------------------------
# Functions, a language -> the texts of its files.


def texts_of(
    name: str,
    emitted: Sequence[Emitted],
    *,
    targets: Sequence[str],
    notes: Sequence[str] = (),
    uses: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> dict[str, FileContent]:
    """{path: content}: NAME_rhs.c, NAME_rhs.h (or the target's own), the same of the others, README, test_vectors.json.

    Args:
        name: of the functions: the model file's stem; other characters are replaced.
        emitted: the right-hand side first, then reactions and whatever else is requested.
        targets: names of languages, "c" or "numpy"; the files of one lie in the directory, of several each in its own.
        notes: omissions of the code, with their reasons, a line each.
        uses: by language, how further files are used.
    """
    answers, stem = vectors_text(emitted), stem_of(name)
    texts: dict[str, FileContent] = {}
    for target in targets_named(dict.fromkeys(targets)):
        folder = "" if len(set(targets)) == 1 else f"{target.name}/"
        files = target.files(stem, emitted)
        files |= {
            "README.md": readme(target, stem, emitted, notes, uses.get(target.name, ())),
            "test_vectors.json": answers,
        }
        texts |= {f"{folder}{file}": text for file, text in files.items()}
    return texts


def readme(
    target: Target, stem: str, emitted: Sequence[Emitted], notes: Sequence[str], uses: Sequence[str] = ()
) -> str:
    """README of the emitted files: the functions, the order of their arguments, their use and test."""
    lines = [f"# {stem}: {target.about}", ""]
    for line in (*target.use, *uses):
        lines.append(f"    {line.format(stem=stem)}")
    for program, reported in emitted:
        if not target.writes(reported.role):
            continue
        lines += ["", *(f"    {line}".rstrip() for line in header(program, reported))]
    lines += ["", "All in SI and radians; without inputs the model's own act. Right answers are in test_vectors.json."]
    lines += [line for note in notes for line in ("", f"Not here: {note}")]
    return "\n".join([*lines, ""])


def vectors_text(emitted: Sequence[Emitted]) -> str:
    """The test vectors as JSON, one a line: names in order, then t, x, p, inputs (null: the model's own), result."""
    program, description = emitted[0]
    symbols = program.symbols
    head = {
        "schema_version": SCHEMA_VERSION,
        "model": description.title,
        "origin": description.origin,
        "coordinates": [x.name for x in symbols.q],
        "speeds": [x.name for x in symbols.u],
        "parameters": list(symbols.parameters),
        "inputs": list(symbols.inputs),
        "tolerance": "of |result - given| / max(1, largest |result|); the result is dx, of the others out or tau; "
        "null: no value there, not a number",
    }
    lines = [f" {json_text(name)}: {json_text(value, ensure_ascii=False)}," for name, value in head.items()]
    if not any(reported.role.word == "reactions" for _, reported in emitted):
        lines.append(' "reactions": null,')
    for other, reported in emitted:
        if reported.role is not Role.RHS:
            lines += _other(other, reported)
    return "\n".join(["{", *lines, *_listed(description, " "), "}", ""])


def _other(program: Program, reported: Description) -> list[str]:
    """The vectors of a function other than the right-hand side."""
    own: dict[str, object] = {"names": reported.outputs}
    if reported.blocks:
        meant = reported.columns or ((),) * len(reported.blocks)
        own = {
            "blocks": [
                {"name": name, "rows": n, "columns": k, **({"of": of} if of else {})}
                for (name, n, k), of in zip(reported.blocks, meant, strict=True)
            ]
        }
    if program.accelerations:
        own |= {
            "accelerations": [x.name for x in program.accelerations],
            "inputs": list(program.symbols.inputs),
        }
    if reported.untested:
        own |= {"untested": reported.untested}
    lines = [f"  {json_text(key)}: {json_text(value, ensure_ascii=False)}," for key, value in own.items()]
    return [f' "{reported.role.word}": {{', *lines, *_listed(reported, "  "), " },"]


def _listed(description: Description, indent: str) -> list[str]:
    """The vectors, a line each."""
    result = description.role.result
    rows = [
        {
            "t": v.t,
            "x": v.x,
            **({"a": v.a} if v.a else {}),
            "p": v.p,
            "inputs": v.inputs,
            result: [value if value == value else None for value in v.result],
            "tolerance": v.tolerance,
        }
        for v in description.vectors
    ]
    listed = ",\n".join(f"{indent} {json_text(row)}" for row in rows)
    return [f'{indent}"vectors": [', *([listed] if rows else []), f"{indent}]"]
