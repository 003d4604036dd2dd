"""Target languages: the text of a program, its files, and that text made callable."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from enum import Enum
from typing import Any

import numpy as np

from eomgen.codegen.lowering import Statements, statements
from eomgen.codegen.program import Program
from eomgen.codegen.statements import Language
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import NAMES


@dataclass(frozen=True)
class Address:
    """Addresses of a compiled right-hand side and its constants; `kept` keeps them alive.

    Args:
        evaluate: of the function (t, x, p, c, inputs, dx).
        p, c: of its parameters and of the constants that they determine.
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
        constants: p, an array -> the constants of the parameters, p included, in a form that only `one` reads.
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


class Role(Enum):
    """Role of a program, and the names in its text.

    Args:
        word: of the files and the main function: NAME_rhs.
        prefix: of the other functions: NAME + prefix + _many.
        result: the array of the outputs.
        about: its results, one line.
    """

    RHS = "rhs", "", "dx", "dx = f(t, x, p), the equations of motion solved for the accelerations"
    INVERSE = "inverse", "_inverse", "tau", "tau = f(t, x, a, p), the forces and torques that accelerations a take"
    REACTIONS = (
        *("reactions", "_reactions", "out"),
        "out = f(t, x, p), the reactions of joints and constraints in the motion",
    )
    OUTPUTS = "outputs", "_outputs", "out", "out = f(t, x, p), the model's [outputs], in SI"
    MATRICES = (
        *("matrices", "_matrices", "out"),
        "out = f(t, x, p), of M a = forcing + J^T lam and, where constraints close, J a + gamma = 0",
    )
    REGRESSOR = (
        *("regressor", "_regressor", "out"),
        "out = f(t, x, a, p), of tau + J^T lam = Y pi + y0 = Y_base base + y0, tau what the inputs push",
    )
    JACOBIAN = "jacobian", "_jacobian", "out", "out = f(t, x, p), A = d x'/d x and B = d x'/d inputs"

    def __init__(self, word: str, prefix: str, result: str, about: str) -> None:
        self.word, self.prefix, self.result, self.about = word, prefix, result, about

    def main(self, stem: str) -> str:
        return f"{stem}_{self.word}"

    def others(self, stem: str) -> str:
        return f"{stem}{self.prefix}"


@dataclass(frozen=True)
class Description:
    """Description of a program in its emitted files.

    Args:
        title: the model's name.
        origin: the program that made the file and its source, one line.
        remarks: of the name of an argument or output: its unit and what it is.
        vectors: right answers, for the self-test.
        role: of the program.
        outputs: names of the outputs, () where they are in the order of x.
        blocks: (name, rows, columns) of matrices that are the outputs, one after the other, each row after row.
        columns: of each block the names of its columns; () where it has none, or all.
        untested: why there are no right answers, "" where there are.
    """

    title: str
    origin: str
    remarks: Mapping[str, str]
    vectors: tuple[TestVector, ...] = ()
    role: Role = Role.RHS
    outputs: tuple[str, ...] = ()
    blocks: tuple[tuple[str, int, int], ...] = ()
    columns: tuple[tuple[str, ...], ...] = ()
    untested: str = ""


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
        name: its name on the command line.
        about: the language, and the requirements of its files.
        text: (program, stem, role) -> its functions in the language.
        files: (stem, what is emitted, the right-hand side first) -> {path: content}, ready to be used by others.
        use: commands by which they are used and tested, a line each, with {stem}.
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
        """True if a function is among its files."""
        return self.roles is None or role.word in self.roles


Many = Callable[[np.ndarray, np.ndarray, np.ndarray, "np.ndarray | None"], np.ndarray]
"""(t n, x n x states with a after it, p, inputs None or n x inputs) -> n x outputs."""


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


# -------- form ------------------------------------------------------------------------------------------------
# Language, FileForm -> the files of a program: templates over one set of words, which all languages share.
#
# The words: main, stem, role, result, others; MAIN and upper, main and others in capitals; states, accelerations,
# moving, parameters, inputs, outputs, how many there are of each, and as states_room in an array that is not empty;
# a, "a, " where accelerations are an argument; of_role, where the vectors lie in test_vectors.json; constants, and
# size, of their array, which is not empty; head, what the file says of itself; names of states, parameters and
# inputs; functions, those of the program.


NameLines = Callable[[str, Sequence[str]], Sequence[str]]
"""(key, names) -> the lines that hold them."""


CHECK = "check({t}, {x}, {a}{p}, {inputs}, {result}, {tolerance})"


def in_quotes(name: str) -> str:
    """A name in double quotes."""
    return json.dumps(name, ensure_ascii=False)


@dataclass(frozen=True)
class FileForm:
    """The table of a language's files.

    Args:
        language: its statements.
        module: of the functions of a program.
        path: of the file in which they stand; `test_path` of its test's, with "" there is none.
        top: the text around {text}, those functions, in a file of their own.
        reported: a line of the head.
        prefix: of the names of the functions that are not the main one.
        given: words that depend on whether accelerations are an argument: where they are, and where they are not.
        fixed: words that are always the same.
        marked: (mark, text): words that are there only where the functions have a mark.
        body: words that are made of the functions.
        named: the lines that hold names of x, p and inputs, by the three keys; or one line with {key}, {count}, and the
            {names} as they are `quoted`.
        test: with {lines}, a line a vector.
        vector: one of these: {t}, {x}, {a}, {p}, {inputs}, {result} and {tolerance}.
        listed: text around an array; empty: text of one without numbers; nan: text of a missing value.
        acting: text for no inputs, and the form of an array of given ones.
        real: the text of a double.
        finished: the last change of a text.
    """

    language: Language
    module: str
    path: str = ""
    test_path: str = ""
    top: str = "{head}\n{text}"
    reported: Callable[[str], str] | None = None
    prefix: str = ""
    given: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    fixed: Mapping[str, str] = field(default_factory=dict)
    marked: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    body: Callable[[Statements], Mapping[str, str]] | None = None
    keys: tuple[str, str, str] = ("x_names", "p_names", "input_names")
    named: NameLines | str = ""
    quoted: Callable[[str], str] = in_quotes
    test: str = ""
    vector: str = f"    {CHECK}"
    listed: tuple[str, str] = ("[", "]")
    empty: str | None = None
    nan: str = "NaN"
    acting: tuple[str, str] = ("[]", "{}")
    real: Callable[[float], str] = repr
    finished: Callable[[str], str] = str

    def words(self, program: Program, stem: str, role: Role) -> dict[str, Any]:
        """Values that templates take: names, and how many there are of each."""
        symbols, without = program.symbols, not program.accelerations
        counts = {
            "states": len(program.states),
            "accelerations": len(program.accelerations),
            "moving": len(program.moving),
            "parameters": len(symbols.parameters),
            "inputs": len(symbols.inputs),
            "outputs": len(program.outputs),
        }
        others = role.others(stem)
        words: dict[str, Any] = {
            "main": role.main(stem),
            "stem": stem,
            "role": role.word,
            "result": role.result,
            "others": others,
        }
        words |= counts | {f"{what}_room": max(n, 1) for what, n in counts.items()}
        words |= {"of_role": "" if role is Role.RHS else f'["{role.word}"]'}
        words |= {"upper": others.upper(), "MAIN": words["main"].upper(), "a": "" if without else "a, ", **self.fixed}
        return words | {word: pair[without].format(**words) for word, pair in self.given.items()}

    def statements(
        self, program: Program, stem: str, role: Role, remarks: Mapping[str, str] | None = None
    ) -> tuple[Statements, dict[str, Any]]:
        """The functions of a program, and the words with their results."""
        words = self.words(program, stem, role)
        made = statements(program, self.language, role.result, self.prefix.format(**words), remarks)
        words |= {"constants": made.constants, "size": max(made.constants, 1)}
        return made, words | {"names": "\n".join(self._names(program))}

    def text(
        self, program: Program, stem: str = "", role: Role = Role.RHS, remarks: Mapping[str, str] | None = None
    ) -> str:
        """The functions of a program.

        Args:
            stem: NAME of the files and functions, an identifier.
            remarks: of an argument's name: its unit and what it is, for the comments.
        """
        return self.written(*self.statements(program, stem, role, remarks), [role.about])

    def written(self, made: Statements, words: Mapping[str, Any], head: Sequence[str] = ()) -> str:
        """Emitted functions with the text around them."""
        own = self.body(made) if self.body else {"functions": "\n\n".join(made.texts(self.language))}
        there = {word: text * (mark in own["functions"]) for word, (mark, text) in self.marked.items()}
        return self.finished(self.module.format(**{"head": self.head(head), **words, **own, **there}))

    def _names(self, program: Program) -> Iterator[str]:
        """The lines that hold the user's names."""
        symbols = program.symbols
        listed = ([x.name for x in program.states], [*symbols.parameters], [*symbols.inputs])
        for key, names in zip(self.keys, listed, strict=True):
            if isinstance(self.named, str):
                quoted = ", ".join(map(self.quoted, names))
                yield from [self.named.format(key=key, count=len(names), names=quoted)] * bool(self.named)
            else:
                yield from self.named(key, names)

    def head(self, lines: Sequence[str]) -> str:
        """Lines as the language's remarks."""
        language = self.language
        reported = self.reported or (lambda line: language.remark.format(text=language.harmless(line)).rstrip())
        return "\n".join(map(reported, lines))

    def files(self, stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
        """The file of each function, and its test."""
        return {
            path: text for program, reported in emitted for path, text in self.of_one(stem, program, reported).items()
        }

    def of_one(self, stem: str, program: Program, reported: Description) -> dict[str, FileContent]:
        """The file of one function, and its test."""
        made, words = self.statements(program, stem, reported.role, reported.remarks)
        lines = header(program, reported)
        text = self.top.format(**words, head=self.head(lines), text=self.written(made, words, lines))
        test = (
            {self.test_path.format(**words): self.tested(program, stem, reported)}
            if reported.vectors and self.test_path
            else {}
        )
        return {self.path_of(program, stem, reported.role): text, **test}

    def path_of(self, program: Program, stem: str, role: Role) -> str:
        """Path of the file of a function."""
        return self.path.format(**self.words(program, stem, role))

    def tested(self, program: Program, stem: str, reported: Description) -> str:
        """Text of the test that compares a function with its test vectors."""
        words = self.words(program, stem, reported.role)
        lines = "\n".join(self.checked(v, words) for v in reported.vectors)
        return self.finished(self.test.format(**words, lines=lines))

    def checked(self, v: TestVector, words: Mapping[str, Any]) -> str:
        """The line of a vector."""
        none, some = self.acting
        own = {"t": self.number(v.t), "x": self.array(v.x), "a": f"{self.array(v.a)}, " if v.a else ""}
        own |= {"p": self.array(v.p), "inputs": none if v.inputs is None else some.format(self.array(v.inputs))}
        own |= {"result": self.array(v.result), "tolerance": self.number(v.tolerance)}
        return self.vector.format(**{**words, **own})

    def number(self, value: float) -> str:
        """A double, or the text of a missing value."""
        return self.nan if value != value else self.real(value)

    def array(self, values: Sequence[float]) -> str:
        """Numbers as an array."""
        return (
            self.empty
            if self.empty is not None and not values
            else ", ".join(map(self.number, values)).join(self.listed)
        )


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
    first = 0
    reported = description.columns or ((),) * len(description.blocks)
    for (name, rows, columns), meant in zip(description.blocks, reported, strict=True):
        last = first + rows * columns - 1
        lines.append(f"    {result}[{first}..{last}]  {name}, {rows} x {columns}, row after row")
        lines += [f"        column {k} of {name}  {column}" for k, column in enumerate(meant, 1)]
        first = last + 1
    if not description.outputs and not description.blocks:
        lines.append(f"    {result}  {len(program.outputs)} values, in the order of x")
    if description.untested:
        lines += ["", f"No test vectors: {description.untested}."]
    return [" ".join(line.split("\n")) for line in lines]


# -------- cases -----------------------------------------------------------------------------------------------
# Functions by cases that a language lacks, or where its own drops a NaN: written once, printed by its words.


CASES = {  # arguments, (condition, value) ..., the value where none holds
    "sign": ("a", (("a > 0", "1"), ("a < 0", "-1")), "a"),
    "min": ("a, b", (("a < b || a != a", "a"),), "b"),
    "max": ("a, b", (("a > b || a != a", "a"),), "b"),
    "less": ("a, b", (("a < b", "1"), ("a >= b", "0")), "nan"),
    "less_equal": ("a, b", (("a <= b", "1"), ("a > b", "0")), "nan"),
    "select": ("given, a, b", (("given == 0", "b"), ("given == given", "a")), "given"),
}


def by_cases(
    form: str,
    choice: str = "{condition} ? {value} : {otherwise}",
    *,
    argument: str = "{name}",
    number: str = "{value}",
    ends: str = "{value}",
    words: Mapping[str, str] = {},
    only: Iterable[str] = CASES,
) -> dict[str, str]:
    """The definition of each op.

    Args:
        form: of one, with {name}, {arguments} and {value}.
        choice: of two values by a condition; ends: what stands where no condition is left.
        argument, number: declaration of an argument, and form of a number that is a value.
        words: of the language, for "nan", other names, parts of conditions.
        only: the ops.
    """
    known = re.compile("|".join(rf"(?<![\w.]){re.escape(word)}(?![\w.])" for word in words) or "(?!)")

    def said(text: str) -> str:
        return known.sub(lambda found: words[found[0]], text)

    def valued(text: str) -> str:
        return number.format(value=text) if text.lstrip("-").isdigit() else said(text)

    def defined(op: str) -> str:
        arguments, cases, last = CASES[op]
        value = ends.format(value=valued(last))
        for condition, one in reversed(cases):
            value = choice.format(condition=said(condition), value=valued(one), otherwise=value)
        declared = ", ".join(argument.format(name=name) for name in arguments.split(", "))
        return form.format(name=said(op), arguments=declared, value=value)

    return {op: defined(op) for op in only}


# -------- in single -------------------------------------------------------------------------------------------
# Files of a language in doubles -> the same in single precision, by a table of words; remarks and strings stay.


QUOTED = r'"(?:\\.|[^"\\])*"'
FUNCTIONS = "|".join(sorted({*NAMES, "pow", "fabs", "fmin", "fmax"} - {"abs", "sign", "min", "max"}))
SUFFIXED = (r"(?<![\w.])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+|\.\d+(?:e[+-]?\d+)?)(?![\w.])", r"\1f")


@dataclass(frozen=True)
class SingleWords:
    """Replacements of words of a language in single precision; a replaced text is not replaced again.

    Args:
        changes: (pattern, replacement), one after the other.
        kept: pattern of the remarks and strings, which stay.
        paths: of the files that are changed, a pattern.
    """

    changes: tuple[tuple[str, str], ...]
    kept: str
    paths: str

    def text(self, text: str) -> str:
        """A text in single precision."""
        found, at = [], 0
        for kept in re.finditer(self.kept, text, re.DOTALL):
            found += [self._changed(text[at : kept.start()]), kept.group()]
            at = kept.end()
        return "".join([*found, self._changed(text[at:])])

    def _changed(self, code: str) -> str:
        for pattern, replacement in self.changes:
            code = re.sub(pattern, replacement, code, flags=re.MULTILINE)
        return code

    def files(self, files: Mapping[str, FileContent]) -> dict[str, FileContent]:
        """Files of one function or of all, by path."""
        return {path: self.text(str(x)) if re.search(self.paths, path) else x for path, x in files.items()}
