"""Programs -> NAME.fmu of FMI 3.0, model exchange and co-simulation: its source, and this platform's binary.

Parameters, inputs, states and outputs have their units; reactions are outputs too. Co-simulation goes by DOP853.
"""

from __future__ import annotations

import ctypes
import hashlib
import io
import platform
import re
import sys
import tempfile
import weakref
import zipfile
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from eomgen.codegen.build import C as COMPILER
from eomgen.codegen.build import Compiler, library
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    RHS,
    Called,
    Description,
    Emitted,
    FileContent,
    Functions,
    Role,
    Target,
)
from eomgen.codegen.targets.c import apart, c_functions, c_text, constants_in
from eomgen.codegen.targets.form import header
from eomgen.errors import RunFailed, ToolMissing
from eomgen.symbolic.numeric.tolerances import BEST, RUN

ROLES = ("rhs", "outputs", "reactions")
EPOCH = (1980, 1, 1, 0, 0, 0)
UNIT = re.compile(r"\[([^\]]*)\]")

_TEST = '''\
"""Held against the answers in test_vectors.json, simulated and validated by FMPy: python -m pytest"""

import json
import pathlib

import fmpy
import numpy as np
from fmpy.fmi3 import FMU3Model
from fmpy.validation import validate_fmu

HERE = pathlib.Path(__file__).parent
PATH = str(HERE / "{stem}.fmu")
TOLD = json.loads((HERE / "test_vectors.json").read_text(encoding="utf-8"))


def test_the_fmu_is_valid():
    assert validate_fmu(PATH) == []


def test_the_rates_and_outputs_are_those_of_the_test_vectors():
    found, folder = fmpy.read_model_description(PATH), fmpy.extract(PATH)
    states, parameters, inputs = (range(1, 1 + {states}), range(1 + 2*{states}, 1 + 2*{states} + {parameters}),
        range(1 + 2*{states} + {parameters}, 1 + 2*{states} + {parameters} + {inputs}))
    for kind, first in {kinds}:
        for v in (TOLD if kind == "rhs" else TOLD[kind])["vectors"]:
            fmu = FMU3Model(guid=found.guid, modelIdentifier="{stem}", unzipDirectory=folder)
            fmu.instantiate()
            fmu.enterInitializationMode(startTime=v["t"])
            fmu.setFloat64(list(parameters), v["p"])
            if v["inputs"] is not None:
                fmu.setFloat64(list(inputs), v["inputs"])
            fmu.setFloat64(list(states), v["x"])
            fmu.exitInitializationMode()
            right = np.array(v["dx" if kind == "rhs" else "out"], dtype=float)
            values = np.array(fmu.getFloat64(list(range(first, first + len(right)))))
            known = right == right
            largest = max([1.0, *abs(right[known])])
            assert (abs(values[known] - right[known]) <= v["tolerance"]*largest).all(), (values, right)
            fmu.terminate()
            fmu.freeInstance()


def test_both_kinds_of_simulation_agree():
    ends = [
        fmpy.simulate_fmu(PATH, fmi_type=kind, stop_time=0.2, relative_tolerance={run!r}, )[-1]
        for kind in ("ModelExchange", "CoSimulation")
    ]
    a, b = (np.array(list(end.tolist())) for end in ends)
    assert np.allclose(a, b, rtol=10000*{run!r}, atol=10000*{run!r}, equal_nan=True)
'''


def source(stem: str, emitted: Sequence[Emitted]) -> str:
    """Everything in one text of C."""
    kept = [(program, told) for program, told in emitted if told.role.name in ROLES]
    program, told = kept[0]
    symbols, start = program.symbols, _start(told, program)
    further = [(each, other.role) for each, other in kept[1:]]
    calls = "".join(
        f" {role.main(stem)}(t, x, p, inputs, (out) + {at});"
        for (_, role), at in zip(further, _places(kept)[1:], strict=True)
    )
    parts = [apart(each, stem, other.role) for each, other in kept]
    sizes = {
        "STATES": len(program.states),
        "PARAMETERS": len(symbols.parameters),
        "INPUTS": len(symbols.inputs),
        "OUTPUTS": sum(len(each.outputs) for each, _ in further),
        "CONSTANTS": constants_in(parts[0]),
        "FIRST_X": _braces(start[0]),
        "FIRST_P": _braces(start[1]),
        "TOLERANCE": repr(RUN),
        "SMALLEST": repr(BEST),
        "TOKEN": f'"{token(stem, emitted)}"',
        "MAKE_CONSTANTS": f"{stem}_constants",
        "EVALUATE": f"{stem}_evaluate",
        "MAKE_OUTPUTS(t, x, p, inputs, out)": f"do {{{calls} (void)(out); }} while (0)",
    }
    defined = "\n".join(f"#define {name} {value}" for name, value in sizes.items())
    texts = [
        resources.files("eomgen.codegen").joinpath(name).read_text("utf-8") for name in ("dop853.c", "targets/fmi3.c")
    ]
    return "\n".join([*parts, texts[0].replace("static void dop853_dense", "void dop853_dense"), defined, texts[1]])


def _places(kept: Sequence[Emitted]) -> list[int]:
    """Where the outputs of each function begin; of the right-hand side 0."""
    places, at = [0], 0
    for program, _ in kept[1:]:
        places.append(at)
        at += len(program.outputs)
    return places


def _braces(values: Sequence[float]) -> str:
    return "{" + (", ".join(map(repr, values)) or "0") + "}"


def _start(told: Description, program: Program) -> tuple[Sequence[float], Sequence[float]]:
    """x and p at the start, as the test vectors have them; zeros and the parameters of one where the model has none."""
    first = next((v for v in told.vectors if v.t == 0 and v.inputs is None), None)
    if first is not None:
        return first.x, first.p
    p = told.vectors[0].p if told.vectors else (1.0,) * len(program.symbols.parameters)
    return (0.0,) * len(program.states), p


def token(stem: str, emitted: Sequence[Emitted]) -> str:
    """What belongs to this model alone."""
    text = "\n".join(c_text(program, stem, told.role) for program, told in emitted if told.role.name in ROLES)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def description(stem: str, emitted: Sequence[Emitted]) -> str:
    """modelDescription.xml."""
    from xml.sax.saxutils import quoteattr  # with it come urllib, http and email, for every verb

    kept = [(program, told) for program, told in emitted if told.role.name in ROLES]
    program, told = kept[0]
    symbols, (x, p) = program.symbols, _start(told, program)
    n, remarks = len(program.states), told.remarks
    units: dict[str, None] = {}
    lines = ['<Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>']

    def add(name: str, remark: str, attributes: str) -> int:
        unit = UNIT.match(remark)
        if unit and unit[1]:
            units[unit[1]] = None
            attributes += f" unit={quoteattr(unit[1])}"
        about = remark[unit.end() :].strip() if unit else remark
        attributes += f" description={quoteattr(about)}" if about else ""
        unique = name if name not in taken else f"{name} ({len(lines)})"
        taken.add(unique)
        lines.append(f'<Float64 name={quoteattr(unique)} valueReference="{len(lines)}" {attributes}/>')
        return len(lines) - 1

    taken = {"time"}
    for node, value in zip(program.states, x, strict=True):
        add(node.name, remarks.get(node.name, ""), f'causality="local" initial="exact" start="{value!r}"')
    for k, node in enumerate(program.states, start=1):
        add(f"der({node.name})", "", f'causality="local" derivative="{k}"')
    for name, value in zip(symbols.parameters, p, strict=True):
        add(name, remarks.get(name, ""), f'causality="parameter" variability="tunable" start="{value!r}"')
    for name in symbols.inputs:
        add(name, remarks.get(name, ""), 'causality="input" start="0.0"')
    outputs = [
        add(name, other.remarks.get(name, ""), 'causality="output"') for _, other in kept[1:] for name in other.outputs
    ]
    known = [f"<Unit name={quoteattr(unit)}/>" for unit in units]
    body = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<fmiModelDescription fmiVersion="3.0" modelName={quoteattr(stem)} '
        f'instantiationToken="{token(stem, emitted)}" '
        f"description={quoteattr(_plain(told.title))} generationTool={quoteattr(_plain(told.origin))}>",
        f'<ModelExchange modelIdentifier="{stem}"/>',
        f'<CoSimulation modelIdentifier="{stem}" canHandleVariableCommunicationStepSize="true"/>',
        *(["<UnitDefinitions>", *known, "</UnitDefinitions>"] if known else []),
        '<DefaultExperiment startTime="0" stopTime="10"/>',
        "<ModelVariables>",
        *lines,
        "</ModelVariables>",
        "<ModelStructure>",
        *(f'<Output valueReference="{v}"/>' for v in outputs),
        *(f'<ContinuousStateDerivative valueReference="{k}"/>' for k in range(n + 1, 2 * n + 1)),
        *(f'<InitialUnknown valueReference="{v}"/>' for v in (*range(n + 1, 2 * n + 1), *outputs)),
        "</ModelStructure>",
        "</fmiModelDescription>",
    ]
    return "\n".join(body) + "\n"


def _plain(text: str) -> str:
    """What XML may hold."""
    return "".join(x if x.isprintable() else " " for x in text)


def fmu_files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
    """NAME.fmu and its test; with sources alone where there is no compiler."""
    text, packed = source(stem, emitted), io.BytesIO()
    build = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<fmiBuildDescription fmiVersion="3.0">\n'
        f'<BuildConfiguration modelIdentifier="{stem}">\n<SourceFileSet language="C99"><SourceFile name="all.c"/>'
        "</SourceFileSet>\n</BuildConfiguration>\n</fmiBuildDescription>\n"
    )
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        contents: dict[str, str | bytes] = {
            "modelDescription.xml": description(stem, emitted),
            "sources/all.c": text,
            "sources/buildDescription.xml": build,
            "documentation/index.html": _documentation(emitted),
            **_binary(stem, text),
        }
        for path, content in contents.items():
            archive.writestr(zipfile.ZipInfo(path, EPOCH), content, zipfile.ZIP_DEFLATED)
    kept = [each for each in emitted if each[1].role.name in ROLES]
    program = kept[0][0]
    n, m = len(program.states), len(program.symbols.parameters) + len(program.symbols.inputs)
    firsts = [1 + n, *(1 + 2 * n + m + at for at in _places(kept)[1:])]
    test = _TEST.format(
        run=RUN, stem=stem, states=n, parameters=len(program.symbols.parameters), inputs=len(program.symbols.inputs),
        kinds=[(told.role.name, first) for (_, told), first in zip(kept, firsts, strict=True)],
    )  # fmt: skip
    return {f"{stem}.fmu": packed.getvalue(), f"test_{stem}_fmu.py": test}


def _documentation(emitted: Sequence[Emitted]) -> str:
    lines = "\n".join(line for program, told in emitted if told.role.name in ROLES for line in header(program, told))
    escaped = lines.replace("&", "&amp;").replace("<", "&lt;")
    return f'<!DOCTYPE html>\n<meta charset="utf-8">\n<pre>{escaped}</pre>\n'


def _binary(stem: str, text: str) -> dict[str, bytes]:
    """This platform's library, by its path in the archive; nothing where there is no compiler."""
    try:
        made = library(text, by=BUILT)
    except (ToolMissing, RunFailed):
        return {}
    return {f"binaries/{platform_name()}/{stem}{SUFFIX}": Path(made._name).read_bytes()}


BUILT = Compiler(
    COMPILER.language, COMPILER.suffix, COMPILER.variable, COMPILER.names,
    (*COMPILER.flags, "-fvisibility=hidden"), COMPILER.mend, COMPILER.zig,
)  # fmt: skip
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")


def platform_name() -> str:
    """As FMI 3 has it: x86_64-linux."""
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    return f"{machine}-{ {'win32': 'windows', 'darwin': 'darwin'}.get(sys.platform, 'linux') }"


def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
    """The rates or outputs of the FMU's binary."""
    content = texts[f"{stem}.fmu"]
    assert isinstance(content, bytes)
    archive = zipfile.ZipFile(io.BytesIO(content))
    path = f"binaries/{platform_name()}/{stem}{SUFFIX}"
    if path not in archive.namelist():
        raise ToolMissing("the FMU has sources alone", mend=COMPILER.mend)
    folder = tempfile.TemporaryDirectory(prefix="eomgen-")
    model = ctypes.CDLL(archive.extract(path, folder.name))
    found = re.search(r'instantiationToken="(\w+)"', archive.read("modelDescription.xml").decode())
    first = archive.read("modelDescription.xml").decode().count('causality="output"')
    assert found is not None
    model.fmi3InstantiateModelExchange.restype = ctypes.c_void_p
    made = model.fmi3InstantiateModelExchange(stem.encode(), found[1].encode(), None, False, False, None, None)
    n, symbols = len(program.states), program.symbols
    begin = 1 + n if role is RHS else 1 + 2 * n + len(symbols.parameters) + len(symbols.inputs)
    begin += first - len(program.outputs) if role.name == _last(texts) else 0

    def values(function: str, at: int, numbers: Sequence[float]) -> Any:
        references = (ctypes.c_uint32 * len(numbers))(*range(at, at + len(numbers)))
        held = (ctypes.c_double * len(numbers))(*numbers)
        if len(numbers) and getattr(model, function)(
            ctypes.c_void_p(made), references, ctypes.c_size_t(len(numbers)), held, ctypes.c_size_t(len(numbers))
        ):
            raise RunFailed(f"{function} of the FMU refuses")
        return held

    def called(t: float, x: Any, a: Any, p: Any, inputs: Any) -> Sequence[float]:
        model.fmi3Reset(ctypes.c_void_p(made))
        model.fmi3SetTime(ctypes.c_void_p(made), ctypes.c_double(t))
        values("fmi3SetFloat64", 1, x)
        values("fmi3SetFloat64", 1 + 2 * n, p)
        if inputs is not None:
            values("fmi3SetFloat64", 1 + 2 * n + len(p), inputs)
        found: list[float] = list(values("fmi3GetFloat64", begin, [0.0] * len(program.outputs)))
        return found

    weakref.finalize(called, folder.cleanup)
    return called


def _last(texts: Mapping[str, FileContent]) -> str:
    """The role whose outputs come last: that of the first function after the others in the vectors' file."""
    answers = str(texts["test_vectors.json"])
    kept = [name for name in ("reactions", "outputs") if f'"{name}": {{' in answers]
    return max(kept, key=lambda name: answers.index(f'"{name}": {{'), default="")


def functions(program: Program) -> Functions:
    """The program as C runs it, of which the FMU is made."""
    return c_functions(program)


def fmu_text(program: Program, stem: str, role: Role = RHS) -> str:
    """The source of the functions."""
    return c_text(program, stem, role)


USE = ("python -m fmpy simulate {stem}.fmu --show-plot", "python -m pytest")
TARGET = Target(
    "fmu",
    "FMI 3.0: model exchange and co-simulation, source and binary",
    fmu_text,
    fmu_files,
    USE,
    functions,
    run,
    ROLES,
)
