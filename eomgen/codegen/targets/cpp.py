"""Program -> a C++17 header: `NAME_rhs<Real>::rhs(t, x, p, inputs, dx)`, over any scalar that has its operators.

With it comes a test over the test vectors, a plain main.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from eomgen.codegen.build import Compiler
from eomgen.codegen.lowering import Statements
from eomgen.codegen.statements import ATOM, INDICES, INT, PRODUCT, READ, SUM, RankedText, ranked_number
from eomgen.codegen.targets.base import QUOTED, SUFFIXED, SingleWords, by_cases, in_quotes
from eomgen.codegen.targets.c import CONSTANTS, ENTRY, SELF_TEST, C
from eomgen.codegen.targets.c import FORM as C_FORM
from eomgen.codegen.targets.loading import compiled_target
from eomgen.symbolic.expression import Number


def _number(a: Number) -> RankedText:
    """A number of the scalar's own kind."""
    text, strength = ranked_number(a)
    if strength == ATOM:
        return f"Real({text})", ATOM
    return (f"-{_number(-a)[0]}", SUM) if a < 0 else ("/".join(f"Real({part})" for part in text.split("/")), PRODUCT)


def _real(texts: Mapping[str, str]) -> dict[str, str]:
    """Texts of C over the scalar."""
    return {key: text.replace("double", "Real") for key, text in texts.items()}


CPP = replace(
    C,
    reserved=C.reserved
    | frozenset(
        "alignas alignof and and_eq asm bitand bitor catch char16_t char32_t char8_t class co_await co_return co_yield "
        "compl concept consteval constexpr constinit const_cast decltype delete dynamic_cast explicit export false "
        "friend mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public "
        "reinterpret_cast requires static_assert static_cast template this thread_local throw true try typeid typename "
        "using virtual wchar_t xor xor_eq std Real".split()
    ),
    defined=by_cases(
        "static Real {name}({arguments}) {{ return {value}; }}",
        argument="Real {name}",
        number="Real({value})",
        words={"select": "pick", "nan": "a + b"},
    ),
    words={"not": "!", "nan": "std::numeric_limits<Real>::quiet_NaN()", "given": "inputs != nullptr"},
    kinds=_real(C.kinds),
    arrays={kind: text.replace("{{0}}", "{{}}") for kind, text in _real(C.arrays).items()},
    tables={
        INT: "static constexpr long {name} = {value};",
        INDICES: "static constexpr int {name}[{size}] = {values};",
        READ: "inline static const Real {name}[{size}] = {values};",
    },
    function=("static {declared}({arguments})\n{{", "}"),
    hidden="",
    out=("static void {name}({arguments}, Real *{out})\n{{", "}"),
    remark="// {text}",
    number=_number,
)
COMPILER = Compiler(
    "C++",
    ".cpp",
    "CXX",
    ("c++", "g++", "clang++"),
    ("-std=c++17", "-shared", "-fPIC", "-fvisibility=hidden"),  # else one process has one eomgen_rhs<double>
    "install g++ or `pip install ziglang`, or set CXX",
    zig="c++",
)

_CLASS = """\
#include <math.h>
#include <cstddef>
#include <limits>

template <class Real>
struct {main} {{
    static constexpr std::size_t states_size = {states};
    static constexpr std::size_t parameters_size = {parameters};
    static constexpr std::size_t inputs_size = {inputs};
    static constexpr std::size_t constants_size = {constants};
{names}

{functions}

    // {result} has {outputs} places; inputs nullptr: the model's own
    static void {role}(Real t, const Real *x, {a_declared}const Real *p, const Real *inputs, Real *{result})
    {{
        Real c[{size}]{cleared};
        constants(p, c);
        evaluate(t, x, {a}p, c, inputs, {result});
    }}
}};
"""


def _inner(made: Statements) -> dict[str, str]:
    """The functions as members."""
    lines = "\n\n".join(made.texts(CPP)).split("\n")
    return {"functions": "\n".join(f"    {line}".rstrip() for line in lines)}


def _named(key: str, names: Sequence[str]) -> list[str]:
    """Names in quotes, where there are any; C++ knows no array without entries."""
    listed = ", ".join(in_quotes(name).replace("??", "?\\?") for name in names)
    return [f"    static constexpr const char *{key}[] = {{{listed}}};"] * bool(names)


FORM = replace(
    C_FORM,
    language=CPP,
    module=_CLASS,
    path="{main}.hpp",
    test_path="{main}_test.cpp",
    top="{head}\n#ifndef {MAIN}_HPP\n#define {MAIN}_HPP\n\n{text}\n#endif\n",
    reported=None,
    prefix="",
    given={
        **C_FORM.given,
        "a_declared": ("const Real *a, ", ""),
        "tested": ("{main}<double>::{role}",) * 2,
        "of": ("{main}<double>::",) * 2,
        "linked": ('extern "C" __attribute__((visibility("default")))\n',) * 2,
    },
    marked={"cleared": ("(void)c;", " = {}")},  # else it is said to be used before it is set
    body=_inner,
    named=_named,
    test=f'// Held against its test vectors: exit 0 where all agree\n#include "{{main}}.hpp"\n{SELF_TEST}',
)
USE = ('#include "{stem}_rhs.hpp"', "g++ -std=c++17 -Wall -Wextra -pedantic {stem}_rhs_test.cpp -o test && ./test")
TARGET = compiled_target(
    "cpp",
    "C++17 header, templates over the scalar",
    FORM,
    USE,
    entry=ENTRY,
    size=CONSTANTS,
    by=COMPILER,
    single=SingleWords(
        ((r"\bdouble\b", "float"), SUFFIXED), rf"//[^\n]*|{QUOTED}|(?<!sizeof)\(double\)", r"_test\.cpp$"
    ),
)
