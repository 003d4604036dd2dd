"""Program -> a Rust crate NAME_rhs without std, a module a function: `rhs::rhs(t, x, p, inputs, &mut dx)`.

It needs no other crate: sine and the like are those of the C library. With it comes a test, run by `cargo test`.
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.codegen.build import Compiler
from eomgen.codegen.statements import CHANGED, INDICES, INT, PLACES, READ, REAL, ROOM, Language
from eomgen.codegen.targets.base import QUOTED, Emitted, FileContent, FileForm, SingleWords, by_cases, in_quotes
from eomgen.codegen.targets.loading import compiled_target

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
    index="({index}) as usize",
    sized="({size}) as usize",
    let="let {declared} = {value};",
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
    loop=("for {name} in {first}..{last} {{", "}"),
    down=("for {name} in ({first}..{last}).rev() {{", "}"),
    branch=("if {condition} {{", "} else {", "}"),
    function=("fn {name}({arguments}){gives} {{", "}"),
    gives={INT: " -> isize", REAL: " -> f64"},
    out=("pub fn {name}({arguments}, {out}: &mut [f64]) {{", "}"),
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
    trial="// nothing\n",
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

_ARGUMENTS = {**dict.fromkeys(UNARY, "a: f64"), **dict.fromkeys(("atan2", "pow"), "a: f64, b: f64")}
_MATH = """\
//! Functions of the C library, and those that neither it nor `core` has: what has no value stays without one.
#![allow(dead_code)]
mod c {
    extern "C" {
@FOREIGN@
    }
}

@SAFE@

pub fn abs(a: f64) -> f64 {
    f64::from_bits(a.to_bits() & !(1 << 63))
}

@CHOSEN@
"""
_SAFE = """\
pub fn {op}({arguments}) -> f64 {{
    // SAFETY: a pure function of numbers
    unsafe {{ c::{op}({names}) }}
}}"""
_CHOSEN = by_cases(
    "pub fn {name}({arguments}) -> f64 {{\n    {value}\n}}",
    "if {condition} {{ {value} }} else {otherwise}",
    argument="{name}: f64",
    number="{value}.0",
    ends="{{ {value} }}",
    words={"a != a": "a.is_nan()", "given == given": "!given.is_nan()", "nan": "f64::NAN", "0": "0.0"},
)
_MATH = (
    _MATH.replace("@FOREIGN@", "\n".join(f"        pub fn {op}({a}) -> f64;" for op, a in _ARGUMENTS.items()))
    .replace("@CHOSEN@", "\n\n".join(_CHOSEN.values()))
    .replace(
        "@SAFE@",
        "\n\n".join(_SAFE.format(op=op, arguments=a, names=a.replace(": f64", "")) for op, a in _ARGUMENTS.items()),
    )
)

_MODULE = """\
{allowed}
{uses}{names}

{functions}

/// {result} of {outputs} places; `inputs` none: the model's own.
pub fn {role}(t: f64, x: &[f64], {a_declared}p: &[f64], inputs: Option<&[f64]>, {result}: &mut [f64]) {{
    let c = &mut [0.0; {constants}];
    constants(p, c);
    evaluate(t, x, {a}p, c, inputs.unwrap_or(&[]), {result});
}}
"""

_ENTRY = """\
mod math {{
{math}
}}
mod {role} {{
{text}
}}

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
        {role}::evaluate(t[i], {x_and_a}, p, c, given, out);
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


FORM = FileForm(
    RUST,
    _MODULE,
    "{stem}_rhs/src/{role}.rs",
    given={"a_declared": ("a: &[f64], ", ""), "x_and_a": ("&x[..{states}], &x[{states}..]", "x")},
    fixed={"allowed": ALLOWED, "math": _MATH},
    marked={"uses": ("math::", "use crate::math;\n\n")},
    keys=("STATES", "PARAMETERS", "INPUTS"),
    named="pub static {key}: [&str; {count}] = [{names}];",
    test=_CASE,
    vector="    {role}({t}, {x}, {a}{p}, {inputs}, out);\n    agree(out, {result}, {tolerance});",
    listed=("&[", "]"),
    nan="f64::NAN",
    acting=("None", "Some({})"),
)


def rust_files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
    """The crate: Cargo.toml, lib.rs, math.rs, a module a function, and the test."""
    folder, about = f"{stem}_rhs", RUST.harmless(emitted[0][1].origin)
    modules = "".join(f"pub mod {reported.role.word};\n" for _, reported in emitted)
    return {
        f"{folder}/Cargo.toml": _CARGO.format(stem=stem, about=in_quotes(about)),
        f"{folder}/src/lib.rs": f"// {about}\n#![no_std]\n\nmod math;\n{modules}",
        f"{folder}/src/math.rs": _MATH,
        **FORM.files(stem, emitted),
        f"{folder}/tests/vectors.rs": _CHECK
        + "".join(FORM.tested(program, stem, reported) for program, reported in emitted if reported.vectors),
    }


_OF_C = "|".join((*UNARY, "atan2", "pow"))
USE = ("use {stem}_rhs::rhs::rhs;", "cd {stem}_rhs && cargo test && cargo clippy -- -D warnings")
TARGET = compiled_target(
    "rust",
    "a Rust crate without std and without dependencies",
    FORM,
    USE,
    entry=_ENTRY,
    size=r"let c = &mut \[0\.0; (\d+)\]",
    by=COMPILER,
    files=rust_files,
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
