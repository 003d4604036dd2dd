"""Language, FileForm -> the files of a program: templates over one set of words, which all languages share.

The words: main, stem, role, result, others; MAIN and upper, main and others in capitals; states, accelerations,
moving, parameters, inputs, outputs, how many there are of each, and as states_room in an array that is not empty; a,
"a, " where accelerations are an argument; of_role, where the vectors lie in test_vectors.json; constants, and size, of
their array, which is not empty; head, what the file says of itself; names of states, parameters and inputs; functions,
those of the program.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import Any

from eomgen.codegen.lowered import Language
from eomgen.codegen.lowering import Lowered, lowered
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import RHS, Description, Emitted, FileContent, Role, TestVector
from eomgen.records import dataclass

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
        top: what stands around {text}, those functions, in a file of their own.
        told: a line of the head.
        prefix: of the names of the functions that are not the main one.
        given: words that hang on whether accelerations are an argument: where they are, and where they are not.
        fixed: words that hang on nothing.
        marked: (mark, text): words that are there only where the functions have a mark.
        body: words that are made of the functions.
        named: the lines that hold names of x, p and inputs, by the three keys; or one line with {key}, {count}, and the
            {names} as they are `quoted`.
        test: with {lines}, a line a vector.
        vector: one of these: {t}, {x}, {a}, {p}, {inputs}, {result} and {tolerance}.
        listed: how an array is held together; empty: what stands for one without numbers; nan, what for no value.
        acting: what stands for no inputs, and how an array stands for those that are given.
        real: the text of a double.
        finished: the last change of a text.
    """

    language: Language
    module: str
    path: str = ""
    test_path: str = ""
    top: str = "{head}\n{text}"
    told: Callable[[str], str] | None = None
    prefix: str = ""
    given: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    fixed: Mapping[str, str] = field(default_factory=dict)
    marked: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    body: Callable[[Lowered], Mapping[str, str]] | None = None
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
        """What stands in templates: names, and how many there are of each."""
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
            "role": role.name,
            "result": role.result,
            "others": others,
        }
        words |= counts | {f"{what}_room": max(n, 1) for what, n in counts.items()}
        words |= {"of_role": "" if role is RHS else f'["{role.name}"]'}
        words |= {"upper": others.upper(), "MAIN": words["main"].upper(), "a": "" if without else "a, ", **self.fixed}
        return words | {word: pair[without].format(**words) for word, pair in self.given.items()}

    def lowered(
        self, program: Program, stem: str, role: Role, remarks: Mapping[str, str] | None = None
    ) -> tuple[Lowered, dict[str, Any]]:
        """The functions of a program, and the words with what they give."""
        words = self.words(program, stem, role)
        made = lowered(program, self.language, role.result, self.prefix.format(**words), remarks)
        words |= {"constants": made.constants, "size": max(made.constants, 1)}
        return made, words | {"names": "\n".join(self._names(program))}

    def text(self, program: Program, stem: str = "", role: Role = RHS, remarks: Mapping[str, str] | None = None) -> str:
        """The functions of a program.

        Args:
            stem: NAME of the files and functions, an identifier.
            remarks: of an argument's name: its unit and what it is, for the comments.
        """
        return self.written(*self.lowered(program, stem, role, remarks), [role.about])

    def written(self, made: Lowered, words: Mapping[str, Any], head: Sequence[str] = ()) -> str:
        """Lowered functions with what stands around them."""
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
        told = self.told or (lambda line: language.remark.format(text=language.harmless(line)).rstrip())
        return "\n".join(map(told, lines))

    def files(self, stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
        """The file of each function, and its test."""
        return {path: text for program, told in emitted for path, text in self.of_one(stem, program, told).items()}

    def of_one(self, stem: str, program: Program, told: Description) -> dict[str, FileContent]:
        """The file of one function, and its test."""
        made, words = self.lowered(program, stem, told.role, told.remarks)
        lines = header(program, told)
        text = self.top.format(**words, head=self.head(lines), text=self.written(made, words, lines))
        test = (
            {self.test_path.format(**words): self.tested(program, stem, told)}
            if told.vectors and self.test_path
            else {}
        )
        return {self.path_of(program, stem, told.role): text, **test}

    def path_of(self, program: Program, stem: str, role: Role) -> str:
        """Where a function stands."""
        return self.path.format(**self.words(program, stem, role))

    def tested(self, program: Program, stem: str, told: Description) -> str:
        """What holds the function against its test vectors."""
        words = self.words(program, stem, told.role)
        lines = "\n".join(self.checked(v, words) for v in told.vectors)
        return self.finished(self.test.format(**words, lines=lines))

    def checked(self, v: TestVector, words: Mapping[str, Any]) -> str:
        """The line of a vector."""
        none, some = self.acting
        own = {"t": self.number(v.t), "x": self.array(v.x), "a": f"{self.array(v.a)}, " if v.a else ""}
        own |= {"p": self.array(v.p), "inputs": none if v.inputs is None else some.format(self.array(v.inputs))}
        own |= {"result": self.array(v.result), "tolerance": self.number(v.tolerance)}
        return self.vector.format(**{**words, **own})

    def number(self, value: float) -> str:
        """A double, or what has no value."""
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
    told = description.columns or ((),) * len(description.blocks)
    for (name, rows, columns), meant in zip(description.blocks, told, strict=True):
        last = first + rows * columns - 1
        lines.append(f"    {result}[{first}..{last}]  {name}, {rows} x {columns}, row after row")
        lines += [f"        column {k} of {name}  {column}" for k, column in enumerate(meant, 1)]
        first = last + 1
    if not description.outputs and not description.blocks:
        lines.append(f"    {result}  {len(program.outputs)} values, in the order of x")
    return [" ".join(line.split("\n")) for line in lines]
