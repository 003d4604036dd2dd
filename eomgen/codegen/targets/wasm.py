"""Program -> WebAssembly, made of its C, and an ECMAScript module that loads it, called as that of `javascript`.

It imports nothing. Its numbers lie in one block of the memory: x, a, p, c, inputs, and the result.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import accumulate
from typing import Any

from eomgen.codegen.build import Compiler, binary
from eomgen.codegen.lowering import Statements
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import QUOTED, FileContent, Role, SingleWords
from eomgen.codegen.targets.c import FORM as C_FORM
from eomgen.codegen.targets.c import SINGLE, C
from eomgen.codegen.targets.node import node_form, node_target

FLAGS = ("--target=wasm32-wasi", "-mexec-model=reactor", "-std=c99", "-s")
COMPILER = Compiler(
    "WebAssembly",
    ".c",
    "WASM_CC",
    (),
    FLAGS,
    "pip install 'eomgen[compile]', or set WASM_CC to the clang of wasi-sdk",
    zig="cc",
    patience=240.0,  # the first time it makes its C library
)

_ENTRY = """
/* The numbers: {places}. */
static double block[{block_size}];

__attribute__((export_name("block"))) double *{others}_block(void);
double *{others}_block(void)
{{
    return block;
}}

__attribute__((export_name("constants"))) void {others}_constants_here(void);
void {others}_constants_here(void)
{{
    {others}_constants(block + {at_p}, block + {at_c});
}}

__attribute__((export_name("evaluate"))) void {others}_evaluate_here(double t, int given);
void {others}_evaluate_here(double t, int given)
{{
    {others}_evaluate(t, block + {at_x}, {a_block}block + {at_p}, block + {at_c}, given ? block + {at_inputs} : NULL,
        block + {at_out});
}}
"""

_LOADER = """\
async function read(url) {{
    if (url.protocol !== "file:") return (await fetch(url)).arrayBuffer();
    return (await import("node:fs/promises")).readFile(url);
}}

const bytes = await read(new URL("./{main}.wasm", import.meta.url));
const {{ exports }} = (await WebAssembly.instantiate(bytes, {{}})).instance;
exports._initialize();
const block = new Float64Array(exports.memory.buffer, exports.block(), {block_size});

export function constants(p, c = new Float64Array({constants})) {{
    block.set(p, {at_p});
    exports.constants();
    c.set(block.subarray({at_c}, {at_c} + {constants}));
    return c;
}}

export function evaluate(t, x, {a}p, c, inputs, {result} = new Float64Array({outputs})) {{
    block.set(x, {at_x});
{a_set}    block.set(p, {at_p});
    block.set(c, {at_c});
    if (inputs !== null) block.set(inputs, {at_inputs});
    exports.evaluate(t, inputs !== null);
    {result}.set(block.subarray({at_out}, {at_out} + {outputs}));
    return {result};
}}

/** {result}: {outputs} numbers; inputs null: the model's own. */
export function {role}(t, x, {a}p, inputs = null) {{
    return evaluate(t, x, {a}p, constants(p), inputs);
}}
"""


def _body(made: Statements) -> dict[str, Any]:
    """The C, and the places in the block."""
    program, symbols = made.program, made.program.symbols
    arrays = (program.states, program.accelerations, symbols.parameters, range(made.constants), symbols.inputs)
    sizes = dict(zip(("x", "a", "p", "c", "inputs", "out"), map(len, (*arrays, program.outputs)), strict=True))
    at = dict(zip(sizes, accumulate(sizes.values(), initial=0), strict=False))
    return {
        **{f"at_{name}": place for name, place in at.items()},
        "functions": "\n\n".join(made.texts(C)),
        "places": ", ".join(f"{name} from {place}" for name, place in at.items() if sizes[name]),
        "block_size": sum(sizes.values()),
        "a_block": f"block + {at['a']}, " if sizes["a"] else "",
        "a_set": f"    block.set(a, {at['a']});\n" if sizes["a"] else "",
    }


FORM = node_form(C, _LOADER, body=_body)
IN_C = replace(C_FORM, module=C_FORM.module + _ENTRY, body=_body)


def _beside(stem: str, program: Program, role: Role, remarks: Mapping[str, str] | None) -> dict[str, FileContent]:
    """NAME_rhs.wasm, and the C that this was made of."""
    text = IN_C.text(program, stem, role, remarks)
    return {f"{role.main(stem)}.wasm": binary(text, COMPILER), f"{role.main(stem)}.c": text}


def _alone(texts: Mapping[str, FileContent], main: str) -> str:
    """The module with the binary in it."""
    content = texts[f"{main}.wasm"]
    assert isinstance(content, bytes)
    inside = f'const bytes = Buffer.from("{base64.b64encode(content).decode()}", "base64");'
    return re.sub(r"const bytes = await read\(.*", lambda _: inside, str(texts[f"{main}.mjs"]))


USE = (
    'import {{ rhs }} from "./{stem}_rhs.mjs";',
    "node --test",
    f"python -m ziglang cc {' '.join(FLAGS)} -O2 {{stem}}_rhs.c -o {{stem}}_rhs.wasm",
)


def _single(files: Mapping[str, FileContent]) -> dict[str, FileContent]:
    """The files in single precision, the binary made anew."""
    found = SINGLE.files(_LOADED.files(files))
    binaries = (path for path in files if path.endswith(".wasm"))
    return found | {path: binary(str(found[f"{path.removesuffix('.wasm')}.c"]), COMPILER) for path in binaries}


_LOADED = SingleWords(((r"\bFloat64Array\b", "Float32Array"),), rf"//[^\n]*|{QUOTED}", r"\.mjs$")
ABOUT = "WebAssembly, made of the C, and its ECMAScript module"
TARGET = node_target("wasm", ABOUT, FORM, USE, text=IN_C.text, beside=_beside, alone=_alone, single=_single)
