"""Program -> C99: `void NAME_rhs(double t, const double *x, const double *p, const double *inputs, double *dx)`.

The reactions alike: `NAME_reactions(..., double *out)`; inverse dynamics has the accelerations after x:
`NAME_inverse(double t, const double *x, const double *a, ..., double *tau)`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from eomgen.codegen.build import C as COMPILER
from eomgen.codegen.build import library, of_this_machine
from eomgen.codegen.lowering import Statements
from eomgen.codegen.program import Program
from eomgen.codegen.statements import CHANGED, INDICES, INT, PLACES, READ, REAL, ROOM, Language, one_line
from eomgen.codegen.targets.base import (
    FUNCTIONS,
    QUOTED,
    SUFFIXED,
    Emitted,
    FileContent,
    FileForm,
    Functions,
    Role,
    SingleWords,
    by_cases,
    header,
)
from eomgen.codegen.targets.c_loading import functions_of
from eomgen.codegen.targets.loading import compiled_target


def comment(text: str) -> str:
    """Text that cannot end the comment it stands in, on one line."""
    for mark, harmless in (("*/", "* /"), ("/*", "/ *"), ("??", "? ?"), ("\\", "/")):
        text = text.replace(mark, harmless)
    return one_line(text)


C = Language(
    reserved=frozenset(
        "auto break case char const continue default do double else enum extern float for goto if inline int long "
        "register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while "
        "asm main near far huge linux unix errno complex imaginary I bool true false NULL NAN INFINITY HUGE_VAL "
        "pick".split()
    )
    | {f"{name}f" for name in FUNCTIONS.split("|")},  # those of single precision
    functions={"abs": "fabs({0})", "select": "pick({0}, {1}, {2})"},  # POSIX has another select
    defined=by_cases(
        "static double {name}({arguments}) {{ return {value}; }}",
        argument="double {name}",
        words={"select": "pick", "nan": "NAN"},
    ),
    words={"not": "!", "nan": "NAN", "given": "inputs != NULL"},
    kinds={
        "": "void {name}",
        REAL: "double {name}",
        INT: "long {name}",  # indices as wide as addresses
        READ: "const double *{name}",
        CHANGED: "double *{name}",
        INDICES: "const int *{name}",
        PLACES: "long *{name}",
    },
    let="const {declared} = {value};",
    arrays={
        CHANGED: "double {name}[{size}] = {{0}};",
        ROOM: "double {name}[{size}];",
        PLACES: "long {name}[{size}] = {{0}};",
    },
    tables={
        INT: "enum {{ {name} = {value} }};",
        INDICES: "static const int {name}[{size}] = {values};",
        READ: "static const double {name}[{size}] = {values};",
    },
    listed=("{", "}"),
    loop=("for (long {name} = {first}; {name} < {last}; {name}++) {{", "}"),
    down=("for (long {name} = {last} - 1; {name} >= {first}; {name}--) {{", "}"),
    function=("{hidden}{declared}({arguments})\n{{", "}"),
    hidden="static ",
    out=("void {name}({arguments}, double *{out})\n{{", "}"),
    remark="/* {text} */",
    harmless=comment,
    unused="(void){name};",
    longest=4000,  # in one function they take a compiler a second
)


_MODULE = """\
#include <math.h>
#include <stddef.h>

{functions}

void {main}({one}, const double *inputs, double *{result})
{{
    double c[{size}];
    {others}_constants(p, c);
    {others}_evaluate(t, x{then_a}, p, c, inputs, {result});
}}

void {others}_many(size_t n, {many}, const double *inputs, double *{result})
{{
    double c[{size}];
    {others}_constants(p, c);
    for (size_t i = 0; i < n; i++)
        {others}_evaluate(t[i], x + i*{states}{a_there}, p, c, inputs ? inputs + i*{inputs} : NULL,
            {result} + i*{outputs});
}}
"""

_DECLARED = """\
{head}#ifndef {MAIN}_H
#define {MAIN}_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {{
#endif

#define {upper}_STATES {states}
#define {upper}_PARAMETERS {parameters}
#define {upper}_INPUTS {inputs}
#define {upper}_CONSTANTS {constants}
#define {upper}_OUTPUTS {outputs}

/* {result} at (t, x, p); inputs NULL: the model's own. */
void {main}({one}, const double *inputs, double *{result});

/* The same in two steps: c once for given p, then as often as one likes. */
void {others}_constants(const double *p, double *c);
void {others}_evaluate({one}, const double *c, const double *inputs, double *{result});

/* n instants at once: t n, x n x states, {a_given}inputs NULL or n x inputs, {result} n x outputs. */
void {others}_many(size_t n, {many}, const double *inputs, double *{result});

#ifdef __cplusplus
}}
#endif

#endif
"""

SELF_TEST = """\
#include <stdio.h>

static const struct {{
    double t, x[{states_room}], {a_array}p[{parameters_room}];
    int given;
    double inputs[{inputs_room}], {result}[{outputs_room}], tolerance;
}} vectors[] = {{
{lines}
}};

int main(void)
{{
    int wrong = 0;
    for (size_t i = 0; i < sizeof vectors/sizeof *vectors; i++) {{
        double {result}[{outputs_room}], largest = 1;
        {tested}(vectors[i].t, vectors[i].x, {a_of}vectors[i].p, vectors[i].given ? vectors[i].inputs : NULL, {result});
        for (int j = 0; j < {outputs}; j++)
            if (fabs(vectors[i].{result}[j]) > largest) largest = fabs(vectors[i].{result}[j]);
        for (int j = 0; j < {outputs}; j++)
            if (isnan(vectors[i].{result}[j]) ? !isnan({result}[j])
                : !(fabs({result}[j] - vectors[i].{result}[j]) <= vectors[i].tolerance*largest)) {{
                fprintf(stderr, "vector %d: {result}[%d] is %.17g, not %.17g\\n", (int)i, j, \
(double){result}[j], (double)vectors[i].{result}[j]);
                wrong = 1;
            }}
    }}
    return wrong;
}}
"""

ENTRY = """\
{text}
{linked}void {entry}(size_t n, const double *t, const double *x, const double *p, const double *inputs, double *out)
{{
    double c[{size}];
    {of}constants(p, c);
    for (size_t i = 0; i < n; i++)
        {of}evaluate(t[i], x + i*{moving}, {a_row}p, c, inputs ? inputs + i*{inputs} : NULL, out + i*{outputs});
}}
"""
CONSTANTS = r"(?:double|float|Real) c\[(\d+)\]"  # how many there are, as their caller in the text says; 1 of none
_X, _A, _P = (f"const double *{name}" for name in "xap")
FORM = FileForm(
    C,
    _MODULE,
    "{main}.c",
    top='{head}#include "{main}.h"\n\n{text}\n',
    reported=lambda line: f" * {comment(line)}".rstrip(),
    prefix="{others}_",
    given={
        "one": (f"double t, {_X}, {_A}, {_P}", f"double t, {_X}, {_P}"),
        "many": (f"const double *t, {_X}, {_A}, {_P}", f"const double *t, {_X}, {_P}"),
        "then_a": (", a", ""),
        "a_there": (", a + i*{accelerations}", ""),
        "a_given": ("a n x speeds, ", ""),
        "a_array": ("a[{accelerations}], ", ""),
        "a_of": ("vectors[i].a, ", ""),
        "a_row": ("x + i*{moving} + {states}, ", ""),
        **{word: (text,) * 2 for word, text in {"tested": "{main}", "linked": "", "of": "{others}_"}.items()},
    },
    test=f"#ifdef EOMGEN_SELFTEST\n{SELF_TEST}#endif\n",
    vector="    {{{t}, {x}, {a}{p}, {inputs}, {result}, {tolerance}}},",
    listed=("{", "}"),
    empty="{0}",
    nan="NAN",
    acting=("0, {0}", "1, {}"),
)


def c_text(program: Program, stem: str, role: Role = Role.RHS, remarks: Mapping[str, str] | None = None) -> str:
    """The functions of a program: NAME_constants, NAME_evaluate, NAME_rhs and NAME_many, or the names of its role."""
    return FORM.text(program, stem, role, remarks)


def c_functions(program: Program) -> Functions:
    """The program compiled (or found in the cache) and callable."""
    made, words = FORM.statements(program, "eomgen", Role.RHS)
    return functions_of(library(FORM.written(made, words), by=of_this_machine()), program, "eomgen", made.constants)


def c_together(programs: Sequence[Program]) -> tuple[Functions, ...]:
    """Several programs, compiled as one text."""
    made = [FORM.statements(program, f"eomgen{i}", Role.RHS) for i, program in enumerate(programs)]
    compiled = library("\n".join(_apart(*each) for each in made), by=of_this_machine())
    return tuple(
        functions_of(compiled, program, words["stem"], each.constants)
        for program, (each, words) in zip(programs, made, strict=True)
    )


def apart(program: Program, stem: str, role: Role) -> str:
    """The functions of a program, to stand in one text with those of others."""
    return _apart(*FORM.statements(program, stem, role))


def hidden_in_c(program: Program, stem: str) -> tuple[str, int]:
    """(STEM_constants and STEM_evaluate of a program, which no other file sees, the number of the constants)."""
    made, words = FORM.statements(program, stem, Role.RHS)
    text = _apart(made, words)
    first, last = text.index(f"void {stem}_rhs("), text.rindex("\n}") + 2
    text = text[:first].rstrip() + text[last:]
    return re.sub(rf"^void ({stem}_(?:constants|evaluate)\()", r"static void \1", text, flags=re.M), made.constants


def _apart(made: Statements, words: Mapping[str, Any]) -> str:
    """The functions of a program, with its own names for the hidden ones."""
    hidden = [C.called(op, ["0"] * 3).partition("(")[0] for op in sorted(made.ops & C.defined.keys())]
    hidden += [*(table.name for table in made.tables), *(function.name for function in made.kernels)]
    before = (f"#define {name} {words['others']}_hidden_{name}" for name in hidden)
    return "\n".join((*before, FORM.written(made, words), *(f"#undef {name}" for name in hidden)))


def _files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
    """NAME_rhs.c and NAME_rhs.h; the former with a self-test: `cc -DEOMGEN_SELFTEST NAME_rhs.c -lm && ./a.out`."""
    files: dict[str, FileContent] = {}
    for program, reported in emitted:
        made, words = FORM.statements(program, stem, reported.role, reported.remarks)
        words |= {"head": f"/*\n{FORM.head(header(program, reported))}\n */\n"}
        text = FORM.top.format(**words, text=FORM.written(made, words))
        tested = FORM.tested(program, stem, reported) if reported.vectors else ""
        files |= {f"{words['main']}.c": text + tested, f"{words['main']}.h": _DECLARED.format(**words)}
    return files


USE = ("cc -O2 -c {stem}_rhs.c", "cc -O2 -DEOMGEN_SELFTEST {stem}_rhs.c -lm -o selftest && ./selftest")
SINGLE = SingleWords(
    (
        (r"\bdouble\b", "float"),
        (r"\bDBL_EPSILON\b", "FLT_EPSILON"),
        (rf"\b({FUNCTIONS})(?=\()", r"\1f"),
        SUFFIXED,
    ),
    rf"/\*.*?\*/|{QUOTED}|(?<!sizeof)\(double\)",  # a cast for printf
    r"\.[ch]$",
)
TARGET = compiled_target(
    "c",
    "C99, no dependencies",
    FORM,
    USE,
    entry=ENTRY,
    size=CONSTANTS,
    by=COMPILER,
    single=SINGLE,
    files=_files,
    load=c_functions,
)
