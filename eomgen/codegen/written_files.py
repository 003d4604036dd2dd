"""Programs -> the functions that are written of a model, with their right answers, and files that others can use."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from eomgen.codegen.kernel_reader import solve_bordered
from eomgen.codegen.program import Program, Solve, stem_of
from eomgen.codegen.rhs import RightHandSide, target_named, targets_named
from eomgen.codegen.targets.base import Called, Description, Emitted, FileContent, Role, Target, TestVector, header
from eomgen.codegen.targets.c_lanes import RUN_TEST, RUN_USE, integrator_files
from eomgen.errors import DerivationError, visible
from eomgen.files import json_text
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Fraction, Node, ScalarRows
from eomgen.symbolic.numeric import Arithmetic, evaluate, fifty_digits, tolerances
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

    @property
    def is_right_hand_side(self) -> bool:
        """True if it gives the rates of the states."""
        return self.role is Role.RHS

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
        run: files of an integrator of its own that go through phases, in place of those of one phase.
    """

    name: str
    emitted: tuple[Emitted, ...]
    targets: tuple[str, ...]
    notes: tuple[str, ...] = ()
    begin: tuple[Sequence[float] | None, Sequence[float] | None] | None = None
    float32: bool = False
    run: Mapping[str, str] = field(default_factory=dict)

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
        tests = any("RUN_SELFTEST" in text for text in self.run.values())
        uses = {} if self.begin is None else {"c": [RUN_USE, *([RUN_TEST] if tests else [])]}
        texts = texts_of(self.name, emitted, targets=self.targets, notes=self.notes, uses=uses)
        found = texts | {f"{self._folder('c')}{name}": text for name, text in self._integrator.items()}
        return {path: visible(text) if isinstance(text, str) else text for path, text in found.items()}

    @property
    def _integrator(self) -> dict[str, str]:
        if self.begin is None:
            return {}
        if self.run:
            return {**self.run}
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


# -------- right answers ---------------------------------------------------------------------------------------
# Program -> right answers at random states, in 50 digits, with which emitted code is compared.


TRIES = 60
PARTIAL = 2  # states, at most, at which some result has no value
NEAR = Fraction(1, 10**6)  # of a state: so far from it, what has no value there has none either


def vectors(
    program: Program,
    *,
    x0: Any = None,
    p0: Any = None,
    count: int = 6,
    seed: int = 1,
    held: Sequence[tuple[float, Sequence[float], Sequence[float]]] = (),
) -> tuple[TestVector, ...]:
    """Right answers near the start (else near 0), half of them with inputs given where there are any; and there.

    A state at which dependent constraint rows contradict each other has no single answer (one language may satisfy
    one row, another one the other): such states serve only where there are no others.

    Args:
        x0, p0: start and parameter values; where None, states near 0 and parameters between 0.5 and 2.
        held: (t, x, p) at which all constraints are satisfied: right answers there too.
    Raises:
        DerivationError: no states were found at which the right-hand side has a value.
    """
    rng = random.Random(seed)
    floats = RightHandSide.of(program, "numpy")
    found: list[TestVector] = []
    partial: list[TestVector] = []
    torn: list[TestVector] = []
    for _ in range(TRIES):
        if len(found) == count or (not found and len(torn) == count):
            break
        vector = _vector(program, floats, _state(program, rng, x0, p0, with_inputs=len(found or torn) % 2 == 1))
        if vector is None:
            continue
        if any(value != value for value in vector.result):
            partial.append(vector)
        else:
            (torn if _contradicts(program, vector) else found).append(vector)
    if not found and not torn:
        raise DerivationError(
            "the equations have no value at any of the states tried for test vectors",
            fix="give a start, and parameters, at which the equations have values",
        )
    if not held:
        found = found or torn
    like = (found or torn)[0]
    where_held = [replace(like, t=t, x=tuple(x), p=tuple(p), inputs=None, result=()) for t, x, p in held]
    states = (*where_held, *_special(program, like, x0))
    special = [vector for vector in (_vector(program, floats, state) for state in states) if vector is not None]
    return (*(found or ([] if special else torn)), *special, *partial[:PARTIAL])


def _special(program: Program, like: TestVector, x0: Any) -> list[TestVector]:
    """Vectors at states where pieces and singular positions are met: the start, and at rest there; or all zero."""
    x = tuple([0.0] * len(program.states) if x0 is None else [float(v) for v in x0])
    q, u = len(program.symbols.q), len(program.symbols.u)
    states = dict.fromkeys([x, (*x[:q], *[0.0] * u, *x[q + u :])])
    return [replace(like, t=0.0, x=state, inputs=None, result=()) for state in states]


def outputs_at(program: Program, values: dict[Node, Any], arithmetic: Arithmetic) -> list[Any]:
    """The program's outputs in any arithmetic.

    Args:
        values: of t, x, p, and of inputs that are given; the others follow from their own expressions.
    """
    values = _with_inputs(program, values, arithmetic)
    for solve in (s for s in program.statements if type(s) is Solve):
        values = values | _solved(solve, evaluate(solve.entries, values, arithmetic))
    return evaluate(program.outputs, values, arithmetic)


def _with_inputs(program: Program, values: dict[Node, Any], arithmetic: Arithmetic) -> dict[Node, Any]:
    """The values, and those of inputs that are not given by their own expressions."""
    inputs = list(program.symbols.inputs.values())
    missing = [x for x in inputs if x not in values]
    own = [program.defaults[inputs.index(x)] for x in missing]
    return values | dict(zip(missing, evaluate(own, values, arithmetic), strict=True))


def _blocks(solve: Solve, entries: Sequence[Any]) -> tuple[list[Any], Sequence[Any], Sequence[Any], Sequence[Any]]:
    """M (n x n) and J (k x n), row after row, f and g of  M a - J^T lam = f,  J a = g."""
    n, k = len(solve.matrix), len(solve.border)
    first = n * (n + 1) // 2
    M = [entries[max(i, j) * (max(i, j) + 1) // 2 + min(i, j)] for i in range(n) for j in range(n)]
    right = entries[first + k * n :]
    return M, entries[first : first + k * n], right[:n], right[n:]


def _solved(solve: Solve, entries: Sequence[Any]) -> dict[Node, Any]:
    return dict(zip(solve.unknowns, solve_bordered(*_blocks(solve, entries), solve.tables), strict=True))


def _contradicts(program: Program, vector: TestVector) -> bool:
    """True if J a = g has no solution there: one of two dependent rows is left open by the accelerations."""
    solves = [s for s in program.statements if type(s) is Solve]
    if not any(solve.border for solve in solves):
        return False
    arithmetic = fifty_digits(partial=True)
    values = {node: arithmetic.number(number) for node, number in _exact(program, vector).items()}
    values = _with_inputs(program, values, arithmetic)
    for solve in solves:
        entries = evaluate(solve.entries, values, arithmetic)
        found = _solved(solve, entries)
        if _is_left_open(solve, entries, found):
            return True
        values = values | found
    return False


def _is_left_open(solve: Solve, entries: Sequence[Any], found: Mapping[Node, Any]) -> bool:
    """True if the accelerations of a solution leave a row of J a = g open."""
    _, J, _, g = _blocks(solve, entries)
    n = len(solve.matrix)
    a = [found[x] for x in solve.unknowns[:n]]
    for i, due in enumerate(g):
        terms: list[Any] = [x * y for x, y in zip(J[i * n : (i + 1) * n], a, strict=True)]
        if abs(sum(terms, start=-due)) > tolerances.COMPUTED * max(map(abs, (*terms, due))):
            return True
    return False


def _state(program: Program, rng: random.Random, x0: Any, p0: Any, with_inputs: bool) -> TestVector:
    """A state without its answer; short decimals, for the reader."""
    symbols = program.symbols
    start = [0.0] * len(program.states) if x0 is None else [float(v) for v in x0]
    x = tuple(program.unit_quaternions.at_unit_norms([round(v + rng.uniform(-1, 1), 3) for v in start]).tolist())
    p = tuple(round(rng.uniform(0.5, 2), 3) for _ in symbols.parameters) if p0 is None else tuple(map(float, p0))
    inputs = tuple(round(rng.uniform(-1, 1), 3) for _ in symbols.inputs)
    t, a = round(rng.uniform(0, 2), 3), tuple(round(rng.uniform(-2, 2), 3) for _ in program.accelerations)
    return TestVector(t, x, p, inputs if with_inputs and inputs else None, (), tolerances.SOLVED, a)


def _vector(program: Program, floats: RightHandSide, state: TestVector) -> TestVector | None:
    """The state with its answer, or None where there is none."""
    exact = _exact(program, state)
    result = _right(program, exact)
    found = floats(state.t, [*state.x, *state.a], state.p, state.inputs or ())
    known = [(a, b) for a, b in zip(found, result, strict=True) if b == b]
    largest = max(1.0, *(abs(b) for _, b in known)) if known else 1.0
    error = max((abs(a - b) for a, b in known), default=0.0) / largest
    if not error < tolerances.COMPUTED or (len(known) < len(result) and not _is_partial_nearby(program, exact, result)):
        return None
    return replace(state, result=result, tolerance=float(max(tolerances.SOLVED, 10 * error)))


def _exact(program: Program, state: TestVector) -> dict[Node, Fraction]:
    """Arguments that a vector gives to a program, as the exact values of its doubles."""
    symbols = program.symbols
    arguments = [symbols.t, *program.moving, *symbols.parameters.values()]
    numbers = [state.t, *state.x, *state.a, *state.p]
    if state.inputs is not None:
        arguments += symbols.inputs.values()
        numbers += state.inputs
    return dict(zip(arguments, map(Fraction, numbers), strict=True))


def _right(program: Program, exact: dict[Node, Fraction]) -> tuple[float, ...]:
    """The outputs from 50 digits, nan where there is no value."""
    arithmetic = fifty_digits(partial=True)
    values = {node: arithmetic.number(number) for node, number in exact.items()}
    return tuple(float(value) for value in outputs_at(program, values, arithmetic))


def _is_partial_nearby(program: Program, exact: dict[Node, Fraction], result: Sequence[float]) -> bool:
    """True if the same outputs have no value a little before and after: not at an edge, nor by a division by zero."""
    missing = [value != value for value in result]
    near = ({node: x * (1 + away) + away for node, x in exact.items()} for away in (NEAR, -NEAR))
    return all([value != value for value in _right(program, state)] == missing for state in near)


# -------- single precision ------------------------------------------------------------------------------------
# How near single precision comes: the tolerances of its vectors, measured, and the errors of a text that is run.


DRAWS = 16  # states around one, by which it is measured what rounding does
GROWN = 8  # times what the arguments' rounding does: that of all operations


def single_vectors(program: Program, vectors: Sequence[TestVector]) -> tuple[TestVector, ...]:
    """The vectors with the tolerances of single precision, measured at states that differ by rounding only."""
    rhs, rng = RightHandSide.of(program, "numpy"), random.Random(1)

    def beside(values: Sequence[float]) -> list[float]:
        return [x * (1 + rng.choice((-1, 1)) * tolerances.SINGLE_ROUNDING) for x in values]

    def measured(v: TestVector) -> TestVector:
        size = max([1.0, *(abs(y) for y in v.result if y == y)])
        far = 0.0
        for _ in range(DRAWS):
            found = rhs(v.t, beside([*v.x, *v.a]), beside(v.p), beside(v.inputs or ()))
            far = max([far, *(abs(a - b) for a, b in zip(found, v.result, strict=True) if a == a and b == b)])
        x, a, p, result = map(_in_range, (v.x, v.a, v.p, v.result))
        inputs = None if v.inputs is None else _in_range(v.inputs)
        return replace(
            v, x=x, a=a, p=p, inputs=inputs, result=result, tolerance=float(tolerances.SINGLE + GROWN * far / size)
        )

    return tuple(map(measured, vectors))


def _in_range(values: Sequence[float]) -> tuple[float, ...]:
    """Numbers, 0 where single precision has none so small: compilers warn of such a one."""
    return tuple(0.0 if abs(x) < np.finfo(np.float32).tiny else x for x in values)


def single_error(called: Called, vectors: Sequence[TestVector]) -> float:
    """The largest error of a text in single precision against its tolerance, at all vectors.

    Args:
        called: the text, run.
    """
    worst = 0.0
    for v in vectors:
        size = max([1.0, *(abs(y) for y in v.result if y == y)])
        for a, b in zip(called(v.t, v.x, v.a, v.p, v.inputs), v.result, strict=True):
            if b == b:
                worst = max(worst, abs(a - b) / size / v.tolerance if a == a else float("inf"))
    return worst
