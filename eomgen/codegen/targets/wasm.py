"""Program -> WebAssembly, made of its C, and an ECMAScript module that loads it, called as that of `javascript`.

It imports nothing. Its numbers lie in one block of the memory: x, a, p, c, inputs, and the result.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from itertools import accumulate

from eomgen.codegen.build import Compiler, binary
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import RHS, Description, FileContent, Role
from eomgen.codegen.targets.c import SINGLE, c_text, constants_of
from eomgen.codegen.targets.in_single import QUOTED, SingleWords
from eomgen.codegen.targets.node import node_target

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
static double block[{size}];

__attribute__((export_name("block"))) double *{others}_block(void);
double *{others}_block(void)
{{
    return block;
}}

__attribute__((export_name("constants"))) void {others}_constants_here(void);
void {others}_constants_here(void)
{{
    {others}_constants(block + {p}, block + {c});
}}

__attribute__((export_name("evaluate"))) void {others}_evaluate_here(double t, int given);
void {others}_evaluate_here(double t, int given)
{{
    {others}_evaluate(t, block + {x}, {a_block}block + {p}, block + {c}, given ? block + {inputs} : NULL,
        block + {out});
}}
"""

_READ = "const bytes = await read(new URL({path}, import.meta.url));"
_LOADER = """\
async function read(url) {{
    if (url.protocol !== "file:") return (await fetch(url)).arrayBuffer();
    return (await import("node:fs/promises")).readFile(url);
}}

{read}
const {{ exports }} = (await WebAssembly.instantiate(bytes, {{}})).instance;
exports._initialize();
const block = new Float64Array(exports.memory.buffer, exports.block(), {size});

export function constants(p, c = new Float64Array({constants})) {{
    block.set(p, {p});
    exports.constants();
    c.set(block.subarray({c}, {c} + {constants}));
    return c;
}}

export function evaluate(t, x, {a}p, c, inputs, {result} = new Float64Array({outputs})) {{
    block.set(x, {x});
{a_set}    block.set(p, {p});
    block.set(c, {c});
    if (inputs !== null) block.set(inputs, {inputs});
    exports.evaluate(t, inputs !== null);
    {result}.set(block.subarray({out}, {out} + {outputs}));
    return {result};
}}

/** {result}: {outputs} numbers; inputs null: the model's own. */
export function {role}(t, x, {a}p, inputs = null) {{
    return evaluate(t, x, {a}p, constants(p), inputs);
}}
"""


def wasm_text(program: Program, stem: str, role: Role = RHS, remarks: Mapping[str, str] | None = None) -> str:
    """The C that is compiled."""
    text = c_text(program, stem, role, remarks)
    return text + _ENTRY.format(**_words(program, stem, role, constants_of(text)))


def _words(program: Program, stem: str, role: Role, constants: int) -> dict[str, object]:
    """What stands in the templates, the places in the block among them."""
    sizes = {
        "x": len(program.states),
        "a": len(program.accelerations),
        "p": len(program.symbols.parameters),
        "c": constants,
        "inputs": len(program.symbols.inputs),
        "out": len(program.outputs),
    }
    at = dict(zip(sizes, accumulate(sizes.values(), initial=0), strict=False))
    given = "a, " if program.accelerations else ""
    return {
        **at,
        "places": ", ".join(f"{name} from {place}" for name, place in at.items() if sizes[name]),
        "size": sum(sizes.values()),
        "constants": constants,
        "outputs": len(program.outputs),
        "others": role.others(stem),
        "role": role.name,
        "result": role.result,
        "a": given,
        "a_block": f"block + {at['a']}, " if given else "",
        "a_set": f"    block.set(a, {at['a']});\n" if given else "",
    }


def _written(stem: str, program: Program, told: Description) -> dict[str, FileContent]:
    """NAME_rhs.mjs, NAME_rhs.wasm, and the C that this was made of."""
    main, text = told.role.main(stem), wasm_text(program, stem, told.role, told.remarks)
    read = _READ.format(path=f'"./{main}.wasm"')
    loader = _LOADER.format(read=read, **_words(program, stem, told.role, constants_of(text)))
    return {f"{main}.mjs": loader, f"{main}.wasm": binary(text, COMPILER), f"{main}.c": text}


def _alone(texts: Mapping[str, FileContent], main: str) -> str:
    """The module with the binary in it."""
    content = texts[f"{main}.wasm"]
    assert isinstance(content, bytes)
    inside = f'const bytes = Buffer.from("{base64.b64encode(content).decode()}", "base64");'
    return str(texts[f"{main}.mjs"]).replace(_READ.format(path=f'"./{main}.wasm"'), inside)


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
TARGET = node_target(
    "wasm", "WebAssembly, made of the C, and its ECMAScript module", wasm_text, _written, USE, _alone, _single
)
