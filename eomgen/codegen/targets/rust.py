"""Program -> a Rust crate NAME_rhs without std, a module a function: `rhs::rhs(t, x, p, inputs, &mut dx)`.

It needs no other crate: sine and the like are those of the C library. With it comes a test, run by `cargo test`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from eomgen.codegen.build import Compiler
from eomgen.codegen.lowered import CHANGED, INDICES, INT, PLACES, READ, REAL, ROOM, Language
from eomgen.codegen.lowering import lowered
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    RHS,
    Description,
    Emitted,
    FileContent,
    Role,
    header,
    vector_lines,
)
from eomgen.codegen.targets.in_single import QUOTED, SingleWords
from eomgen.codegen.targets.library_call import compiled_target, sizes

LONGEST_CONST = 1000  # names: a larger constant would be copied where it is used
UNARY = "sin cos asin acos atan sinh cosh tanh exp log sqrt".split()
RUST = Language(
    reserved=frozenset(
        "as async await break const continue crate dyn else enum extern false fn for if impl in let loop match mod "
        "move mut pub ref return self Self static struct super trait true type unsafe use where while abstract become "
        "box do final gen macro override priv try typeof unsized virtual yield f64 isize usize bool str core math "
        "STATES PARAMETERS INPUTS SIZE Option Some None".split()
    ),
    functions={
        **{op: f"math::{op}({{0}})" for op in (*UNARY, "abs", "sign")},
        **{op: f"math::{op}({{0}}, {{1}})" for op in "atan2 pow min max less less_equal".split()},
        "select": "math::select({0}, {1}, {2})",
    },
    defined={},
    words={"not": "!", "nan": "f64::NAN", "given": "!inputs.is_empty()"},
    kinds={
        "": "{name}",
        REAL: "{name}: f64",
        INT: "{name}: isize",
        READ: "{name}: &[f64]",
        CHANGED: "{name}: &mut [f64]",
        INDICES: "{name}: &[isize]",
        PLACES: "{name}: &mut [isize]",
    },
    at="{array}[{index}]",
    index="({index}) as usize",
    sized="({size}) as usize",
    let="let {declared} = {value};",
    put="{place} = {value};",
    call="{function}({arguments});",
    back="return {value};",
    arrays={
        CHANGED: "let {name}: &mut [f64] = &mut [0.0; {size}];",
        ROOM: "let {name}: &mut [f64] = &mut [0.0; {size}];",
        PLACES: "let {name}: &mut [isize] = &mut [0; {size}];",
    },
    tables={
        INT: "const {name}: isize = {value};",
        INDICES: "static {name}: &[isize] = &{values};",
        READ: "static {name}: &[f64] = &{values};",
    },
    listed=("[", "]"),
    loop=("for {name} in {first}..{last} {{", "}"),
    down=("for {name} in ({first}..{last}).rev() {{", "}"),
    branch=("if {condition} {{", "} else {", "}"),
    function=("fn {name}({arguments}){gives} {{", "}"),
    gives={INT: " -> isize", REAL: " -> f64"},
    out=("pub fn {name}({arguments}, {out}: &mut [f64]) {{", "}"),
    remark="// {text}",
    unused="let _ = {name};",
    longest=4000,
)
COMPILER = Compiler(
    "Rust",
    ".rs",
    "RUSTC",
    ("rustc",),
    ("--edition=2021", "--crate-type=cdylib", "--cap-lints=warn"),
    "install Rust (rustup.rs), or set RUSTC",
    last=(),
    once=("-Copt-level=0",),
    usual=("-Copt-level=3",),
    long=("-Copt-level=1",),
)

# Loops over places, nan in comparisons, and names as the model has them
ALLOWED = (
    "#![allow(non_snake_case, non_upper_case_globals, clippy::needless_range_loop, clippy::needless_return, "
    "clippy::too_many_arguments, clippy::neg_cmp_op_on_partial_ord, clippy::identity_op, clippy::erasing_op, "
    "clippy::approx_constant, clippy::excessive_precision, clippy::manual_range_contains, clippy::manual_memcpy, "
    "clippy::manual_swap, clippy::collapsible_if, clippy::many_single_char_names, clippy::assign_op_pattern)]"
)

_MATH = """\
//! Functions of the C library, and those that neither it nor `core` has: what has no value stays without one.
#![allow(dead_code)]
mod c {
    extern "C" {
@FOREIGN@
        pub fn atan2(a: f64, b: f64) -> f64;
        pub fn pow(a: f64, b: f64) -> f64;
    }
}

@SAFE@

pub fn atan2(a: f64, b: f64) -> f64 {
    // SAFETY: a pure function of numbers
    unsafe { c::atan2(a, b) }
}

pub fn pow(a: f64, b: f64) -> f64 {
    // SAFETY: a pure function of numbers
    unsafe { c::pow(a, b) }
}

pub fn abs(a: f64) -> f64 {
    f64::from_bits(a.to_bits() & !(1 << 63))
}

pub fn sign(a: f64) -> f64 {
    if a > 0.0 { 1.0 } else if a < 0.0 { -1.0 } else { a }
}

pub fn min(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

pub fn max(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

pub fn less(a: f64, b: f64) -> f64 {
    if a < b { 1.0 } else if a >= b { 0.0 } else { f64::NAN }
}

pub fn less_equal(a: f64, b: f64) -> f64 {
    if a <= b { 1.0 } else if a > b { 0.0 } else { f64::NAN }
}

pub fn select(given: f64, a: f64, b: f64) -> f64 {
    if given == 0.0 { b } else if given.is_nan() { given } else { a }
}
"""
_MATH = _MATH.replace("@FOREIGN@", "\n".join(f"        pub fn {op}(a: f64) -> f64;" for op in UNARY)).replace(
    "@SAFE@",
    "\n\n".join(
        f"pub fn {op}(a: f64) -> f64 {{\n    // SAFETY: a pure function of numbers\n    unsafe {{ c::{op}(a) }}\n}}"
        for op in UNARY
    ),
)

_CALLER = """\
/// {result} of {outputs} places; `inputs` none: the model's own.
pub fn {role}(t: f64, x: &[f64], {a_declared}p: &[f64], inputs: Option<&[f64]>, {result}: &mut [f64]) {{
    let c = &mut [0.0; {size}];
    constants(p, c);
    evaluate(t, x, {a}p, c, inputs.unwrap_or(&[]), {result});
}}
"""

_ENTRY = """
#[no_mangle]
pub unsafe extern "C" fn {entry}(
    n: usize, t: *const f64, x: *const f64, p: *const f64, inputs: *const f64, out: *mut f64,
) {{
    use core::slice::{{from_raw_parts, from_raw_parts_mut}};
    let (t, p) = (from_raw_parts(t, n), from_raw_parts(p, {parameters}));
    let c = &mut [0.0; {size}];
    {role}::constants(p, c);
    for i in 0..n {{
        let x = from_raw_parts(x.add(i*{moving}), {moving});
        let given = if inputs.is_null() {{ &[] }} else {{ from_raw_parts(inputs.add(i*{inputs}), {inputs}) }};
        let out = from_raw_parts_mut(out.add(i*{outputs}), {outputs});
        {role}::evaluate(t[i], {x}, p, c, given, out);
    }}
}}
"""

_CARGO = """\
[package]
name = "{stem}_rhs"
version = "0.1.0"
edition = "2021"
description = {about}

[workspace]
"""

_CHECK = """\
//! Held against the test vectors: cargo test
#![allow(clippy::approx_constant, clippy::excessive_precision)]

fn agree(found: &[f64], right: &[f64], tolerance: f64) {
    let largest = right.iter().fold(1.0_f64, |most, value| most.max(value.abs()));
    for (k, (a, b)) in found.iter().zip(right).enumerate() {
        let same = if b.is_nan() { a.is_nan() } else { (a - b).abs() <= tolerance*largest };
        assert!(same, "place {k} is {a}, not {b}");
    }
}
"""

_CASE = """
#[test]
fn {role}_gives_the_values_of_its_test_vectors() {{
    use {stem}_rhs::{role}::{role};
    let out = &mut [0.0; {outputs}];
{lines}
}}
"""


def rust_text(program: Program, stem: str = "", role: Role = RHS, remarks: Mapping[str, str] | None = None) -> str:
    """The module of a program, which uses `crate::math`."""
    made, given = lowered(program, RUST, role.result, remarks=remarks), bool(program.accelerations)
    text, symbols = "\n\n".join(made.texts(RUST)), program.symbols
    listed = {"STATES": [x.name for x in program.states], "PARAMETERS": symbols.parameters, "INPUTS": symbols.inputs}
    names = "\n".join(_names(key, list(n)) for key, n in listed.items())
    caller = _CALLER.format(
        **sizes(program, role, stem),
        size=made.constants,
        a_declared="a: &[f64], " if given else "",
        a="a, " if given else "",
    )
    uses = "use crate::math;\n\n" if "math::" in text else ""
    return f"{ALLOWED}\n{uses}{names}\n\n{text}\n\n{caller}".replace("fn constants", "pub fn constants", 1).replace(
        "pub pub", "pub"
    )


def _names(key: str, names: Sequence[str]) -> str:
    kind, quoted = "const" if len(names) <= LONGEST_CONST else "static", ", ".join(map(_quoted, names))
    return f"pub {kind} {key}: [&str; {len(names)}] = [{quoted}];"


def _quoted(name: str) -> str:
    return json.dumps(name, ensure_ascii=False)


def rust_files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
    """The crate: Cargo.toml, lib.rs, math.rs, a module a function, and the test."""
    folder, roles = f"{stem}_rhs", [told.role.name for _, told in emitted]
    about = emitted[0][1].origin
    library = f"// {RUST.harmless(about)}\n#![no_std]\n\nmod math;\n" + "".join(f"pub mod {name};\n" for name in roles)
    tests = _CHECK + "".join(_case(stem, *each) for each in emitted if each[1].vectors)
    return {
        f"{folder}/Cargo.toml": _CARGO.format(stem=stem, about=_quoted(RUST.harmless(about))),
        f"{folder}/src/lib.rs": library,
        f"{folder}/src/math.rs": _MATH,
        **{f"{folder}/src/{told.role.name}.rs": _module(stem, program, told) for program, told in emitted},
        f"{folder}/tests/vectors.rs": tests,
    }


def _module(stem: str, program: Program, told: Description) -> str:
    head = "\n".join(f"// {RUST.harmless(line)}".rstrip() for line in header(program, told))
    return f"{head}\n{rust_text(program, stem, told.role, told.remarks)}"


def _number(value: float) -> str:
    return "f64::NAN" if value != value else repr(value)


def _listed(values: Sequence[float]) -> str:
    return f"&[{', '.join(map(_number, values))}]"


def _case(stem: str, program: Program, told: Description) -> str:
    a = "{a}, " if program.accelerations else ""
    call = f"    {told.role.name}({{t}}, {{x}}, {a}{{p}}, {{inputs}}, out);\n    agree(out, {{result}}, {{tolerance}});"
    lines = vector_lines(told.vectors, call, _listed, _number, ("None", "Some({})"))
    return _CASE.format(**sizes(program, told.role, stem), lines="\n".join(lines))


def _many_text(text: str, program: Program, _: str, role: Role) -> str:
    """One text of the modules with a function that Python calls."""
    size = text.partition("let c = &mut [0.0; ")[2].partition("]")[0]
    given, n = program.accelerations, len(program.states)
    entry = _ENTRY.format(**sizes(program, role, ""), size=size, x=f"&x[..{n}], &x[{n}..]" if given else "x")
    return f"mod math {{\n{_MATH}\n}}\nmod {role.name} {{\n{text}\n}}\n{entry}"


_OF_C = "|".join((*UNARY, "atan2", "pow"))
USE = ("use {stem}_rhs::rhs::rhs;", "cd {stem}_rhs && cargo test && cargo clippy -- -D warnings")
TARGET = compiled_target(
    "rust",
    "a Rust crate without std and without dependencies",
    rust_text,
    rust_files,
    USE,
    source="{stem}_rhs/src/{role}.rs",
    called=_many_text,
    by=COMPILER,
    single=SingleWords(
        (
            (r"(?<!\w)f64\b|(?<=\d_)f64\b", "f32"),
            (r"1 << 63\b", "1 << 31"),
            (rf"\bc::({_OF_C})(?=\()", r"c::\1f"),
            (rf"^( +pub fn )({_OF_C})(?=\([^{{\n]*;)", r"\1\2f"),
        ),
        rf"//[^\n]*|{QUOTED}",
        r"\.rs$",
    ),
)
