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
from itertools import accumulate
from math import isfinite
from pathlib import Path
from typing import Any

from eomgen.codegen.build import C as COMPILER
from eomgen.codegen.build import Compiler, library
from eomgen.codegen.program import Assign, Program
from eomgen.codegen.targets.base import Called, Description, Emitted, FileContent, Role, Target, header
from eomgen.codegen.targets.c import CONSTANTS, apart, c_functions, c_text
from eomgen.errors import RunFailed, ToolMissing
from eomgen.symbolic.numeric import FLOAT, JUMPS, NoValue, evaluate, tolerances

ROLES = ("rhs", "outputs", "reactions")
UNTIL_STUCK = (0.2, 0.1, 0.05, 0.02)  # s, that its own test simulates: the longest that a solver without events can
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
EXPECTED = json.loads((HERE / "test_vectors.json").read_text(encoding="utf-8"))


def test_the_fmu_is_valid():
    assert validate_fmu(PATH) == []


def test_the_rates_and_outputs_are_those_of_the_test_vectors():
    found, folder = fmpy.read_model_description(PATH), fmpy.extract(PATH)
    states, parameters, inputs = (range(1, 1 + {states}), range(1 + 2*{states}, 1 + 2*{states} + {parameters}),
        range(1 + 2*{states} + {parameters}, 1 + 2*{states} + {parameters} + {inputs}))
    for kind, first in {kinds}:
        for v in (EXPECTED if kind == "rhs" else EXPECTED[kind])["vectors"]:
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


def ends(time):
    return [
        fmpy.simulate_fmu(PATH, fmi_type=kind, stop_time=time, relative_tolerance={run!r}, )[-1]
        for kind in ("ModelExchange", "CoSimulation")
    ]


def test_both_kinds_of_simulation_agree():
    for time in {times}:
        try:
            found = ends(time)
            break
        except RuntimeError:  # a solver without events does not come across the jump of a friction that sticks
            if time == {times}[-1]:
                raise
    a, b = (np.array(list(end.tolist())) for end in found)
    assert np.allclose(a, b, rtol=10000*{run!r}, atol=10000*{run!r}, equal_nan=True)
'''


def _kept(emitted: Sequence[Emitted]) -> list[Emitted]:
    """The functions that an FMU has, the right-hand side first."""
    return [each for each in emitted if each[1].role.word in ROLES]


def _firsts(programs: Sequence[Program]) -> list[int]:
    """The first value reference of each function's results: time, x, x', p, inputs, then the outputs in a row."""
    n, symbols = len(programs[0].states), programs[0].symbols
    after = 1 + 2 * n + len(symbols.parameters) + len(symbols.inputs)
    return [1 + n, *accumulate((len(each.outputs) for each in programs[1:-1]), initial=after)][: len(programs)]


def source(stem: str, emitted: Sequence[Emitted]) -> str:
    """Everything in one text of C."""
    kept = _kept(emitted)
    program, reported = kept[0]
    start, firsts = _start(reported, program), _firsts([each for each, _ in kept])
    calls = "".join(
        f" {other.role.main(stem)}(t, x, p, inputs, (out) + {at - firsts[1]});"
        for (_, other), at in zip(kept[1:], firsts[1:], strict=True)
    )
    parts = [apart(each, stem, other.role) for each, other in kept]
    sizes = {
        "STATES": len(program.states),
        "PARAMETERS": len(program.symbols.parameters),
        "INPUTS": len(program.symbols.inputs),
        "OUTPUTS": sum(len(each.outputs) for each, _ in kept[1:]),
        "CONSTANTS": re.findall(CONSTANTS, parts[0])[0],
        "FIRST_X": _braces(start[0]),
        "FIRST_P": _braces(start[1]),
        "FIRST_INPUTS": _braces(_start_of_inputs(program, *start)),
        "TOLERANCE": repr(tolerances.RUN),
        "SMALLEST": repr(tolerances.BEST),
        "TOKEN": f'"{token(stem, emitted)}"',
        "MAKE_CONSTANTS": f"{stem}_constants",
        "EVALUATE": f"{stem}_evaluate",
        "MAKE_OUTPUTS(t, x, p, inputs, out)": f"do {{{calls} (void)(out); }} while (0)",
    }
    defined = "\n".join(f"#define {name} {value}" for name, value in sizes.items())
    own = resources.files("eomgen.codegen")
    dop853, fmi3 = (own.joinpath(name).read_text("utf-8") for name in ("dop853.c", "targets/fmi3.c"))
    return "\n".join([*parts, dop853.replace("static void dop853_dense", "void dop853_dense"), defined, fmi3])


def _braces(values: Sequence[float]) -> str:
    return "{" + (", ".join(map(repr, values)) or "0") + "}"


def _start(reported: Description, program: Program) -> tuple[Sequence[float], Sequence[float]]:
    """x and p at the start, as the test vectors have them; zeros and the parameters of one where the model has none."""
    first = next((v for v in reported.vectors if v.t == 0 and v.inputs is None), None)
    if first is not None:
        return first.x, first.p
    p = reported.vectors[0].p if reported.vectors else (1.0,) * len(program.symbols.parameters)
    return (0.0,) * len(program.states), p


def _start_of_inputs(program: Program, x: Sequence[float], p: Sequence[float]) -> list[float]:
    """Inputs as the model's own expressions give them at the start; 0 where they have no value there."""
    symbols = program.symbols
    known = {symbols.t: 0.0, **dict(zip(symbols.parameters.values(), p, strict=True))}
    known |= dict(zip(program.states, x, strict=True))
    found = []
    for own in program.defaults:
        try:
            (value,) = evaluate((own,), known, FLOAT)
        except (NoValue, ZeroDivisionError, KeyError):
            value = 0.0
        found.append(float(value) if isfinite(float(value)) else 0.0)
    return found


def token(stem: str, emitted: Sequence[Emitted]) -> str:
    """Token that identifies the model: a digest of its code."""
    text = "\n".join(c_text(program, stem, reported.role) for program, reported in _kept(emitted))
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _variables(kept: Sequence[Emitted]) -> list[tuple[str, str, str]]:
    """(name, remark, attributes) of each, in the order of the value references."""
    program, reported = kept[0]
    symbols, (x, p), states = program.symbols, _start(reported, program), [node.name for node in program.states]
    how = [f'causality="local" initial="exact" start="{value!r}"' for value in x]
    how += [f'causality="local" derivative="{k}"' for k in range(1, len(x) + 1)]
    how += [f'causality="parameter" variability="tunable" start="{value!r}"' for value in p]
    how += [f'causality="input" start="{value!r}"' for value in _start_of_inputs(program, x, p)]
    names = (*states, *(f"der({name})" for name in states), *symbols.parameters, *symbols.inputs)
    found = [("time", "", 'causality="independent" variability="continuous"')]
    found += [(name, reported.remarks.get(name, ""), said) for name, said in zip(names, how, strict=True)]
    for _, other in kept[1:]:
        found += [(name, other.remarks.get(name, ""), 'causality="output"') for name in other.outputs]
    return found


def description(stem: str, emitted: Sequence[Emitted]) -> str:
    """modelDescription.xml."""
    from xml.sax.saxutils import quoteattr  # with it come urllib, http and email, for every verb

    kept, n = _kept(emitted), len(emitted[0][0].states)
    units: dict[str, None] = {}
    taken: set[str] = set()
    lines: list[str] = []
    for k, (name, remark, attributes) in enumerate(_variables(kept)):
        unit = UNIT.match(remark)
        if unit and unit[1]:
            units[unit[1]] = None
            attributes += f" unit={quoteattr(unit[1])}"
        about = remark[unit.end() :].strip() if unit else remark
        attributes += f" description={quoteattr(about)}" if about else ""
        unique = name if name not in taken else f"{name} ({k})"
        taken.add(unique)
        lines.append(f'<Float64 name={quoteattr(unique)} valueReference="{k}" {attributes}/>')
    first = len(lines) - sum(len(each.outputs) for each, _ in kept[1:])
    rates, outputs, reported = range(n + 1, 2 * n + 1), range(first, len(lines)), kept[0][1]
    known = [f"<Unit name={quoteattr(unit)}/>" for unit in units]
    body = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<fmiModelDescription fmiVersion="3.0" modelName={quoteattr(stem)} '
        f'instantiationToken="{token(stem, emitted)}" '
        f"description={quoteattr(_plain(reported.title))} generationTool={quoteattr(_plain(reported.origin))}>",
        f'<ModelExchange modelIdentifier="{stem}"/>',
        f'<CoSimulation modelIdentifier="{stem}" canHandleVariableCommunicationStepSize="true"/>',
        *(["<UnitDefinitions>", *known, "</UnitDefinitions>"] if known else []),
        '<DefaultExperiment startTime="0" stopTime="10"/>',
        "<ModelVariables>",
        *lines,
        "</ModelVariables>",
        "<ModelStructure>",
        *(f'<Output valueReference="{v}"/>' for v in outputs),
        *(f'<ContinuousStateDerivative valueReference="{k}"/>' for k in rates),
        *(f'<InitialUnknown valueReference="{v}"/>' for v in (*rates, *outputs)),
        "</ModelStructure>",
        "</fmiModelDescription>",
    ]
    return "\n".join(body) + "\n"


def _plain(text: str) -> str:
    """Text with only the characters that XML may hold."""
    return "".join(x if x.isprintable() else " " for x in text)


def fmu_files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
    """NAME.fmu and its test; with sources alone where there is no compiler."""
    text, packed, kept = source(stem, emitted), io.BytesIO(), _kept(emitted)
    build = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<fmiBuildDescription fmiVersion="3.0">\n'
        f'<BuildConfiguration modelIdentifier="{stem}">\n<SourceFileSet language="C99"><SourceFile name="all.c"/>'
        "</SourceFileSet>\n</BuildConfiguration>\n</fmiBuildDescription>\n"
    )
    about = "\n".join(line for each in kept for line in header(*each)).replace("&", "&amp;").replace("<", "&lt;")
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        contents: dict[str, str | bytes] = {
            "modelDescription.xml": description(stem, emitted),
            "sources/all.c": text,
            "sources/buildDescription.xml": build,
            "documentation/index.html": f'<!DOCTYPE html>\n<meta charset="utf-8">\n<pre>{about}</pre>\n',
            **_binary(stem, text),
        }
        for path, content in contents.items():
            archive.writestr(zipfile.ZipInfo(path, EPOCH), content, zipfile.ZIP_DEFLATED)
    program, firsts = kept[0][0], _firsts([program for program, _ in kept])
    sizes = {"parameters": len(program.symbols.parameters), "inputs": len(program.symbols.inputs)}
    kinds = [(reported.role.word, first) for (_, reported), first in zip(kept, firsts, strict=True)]
    times = UNTIL_STUCK if _jumps(program) else UNTIL_STUCK[:1]
    test = _TEST.format(times=times, run=tolerances.RUN, stem=stem, states=len(program.states), kinds=kinds, **sizes)
    return {f"{stem}.fmu": packed.getvalue(), f"test_{stem}_fmu.py": test}


def _jumps(program: Program) -> bool:
    """True if a value may jump, as friction does where sliding reverses; in space it is v/max(|v|, tiny)."""
    ops = [each.node.op for each in program.statements if isinstance(each, Assign)]
    return not (JUMPS | {"max"}).isdisjoint(ops)


def _binary(stem: str, text: str) -> dict[str, bytes]:
    """This platform's library, by its path in the archive; nothing where there is no compiler."""
    try:
        made = library(text, by=BUILT)
    except (ToolMissing, RunFailed):
        return {}
    return {f"binaries/{platform_name()}/{stem}{SUFFIX}": Path(made._name).read_bytes()}


BUILT = Compiler(
    COMPILER.language, COMPILER.suffix, COMPILER.variable, COMPILER.names,
    (*COMPILER.flags, "-fvisibility=hidden"), COMPILER.fix, COMPILER.zig,
)  # fmt: skip
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")


def platform_name() -> str:
    """Name of the platform in FMI 3: x86_64-linux."""
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    return f"{machine}-{ {'win32': 'windows', 'darwin': 'darwin'}.get(sys.platform, 'linux') }"


def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
    """The rates or outputs of the FMU's binary."""
    content = texts[f"{stem}.fmu"]
    assert isinstance(content, bytes)
    archive = zipfile.ZipFile(io.BytesIO(content))
    path = f"binaries/{platform_name()}/{stem}{SUFFIX}"
    if path not in archive.namelist():
        library(archive.read("sources/all.c").decode(), by=BUILT)  # why there is none
        raise ToolMissing("the FMU has sources alone", fix=COMPILER.fix)
    folder = tempfile.TemporaryDirectory(prefix="eomgen-")
    model = ctypes.CDLL(archive.extract(path, folder.name))
    reported = archive.read("modelDescription.xml").decode()
    found = re.search(r'instantiationToken="(\w+)"', reported)
    assert found is not None
    model.fmi3InstantiateModelExchange.restype = ctypes.c_void_p
    made = ctypes.c_void_p(
        model.fmi3InstantiateModelExchange(stem.encode(), found[1].encode(), None, False, False, None, None)
    )
    n, size = len(program.states), len(program.outputs)
    begin = _firsts([program, program])[0 if role is Role.RHS else 1]
    begin += reported.count('causality="output"') - size if role is Role.OUTPUTS else 0  # they come last

    def values(function: str, at: int, numbers: Sequence[float]) -> Any:
        count = len(numbers)
        references, held = (ctypes.c_uint32 * count)(*range(at, at + count)), (ctypes.c_double * count)(*numbers)
        many = ctypes.c_size_t(count)
        if count and getattr(model, function)(made, references, many, held, many):
            raise RunFailed(f"{function} of the FMU refuses", fix="make it again by eomgen codegen --target fmu")
        return held

    def called(t: float, x: Any, a: Any, p: Any, inputs: Any) -> Sequence[float]:
        model.fmi3Reset(made)
        model.fmi3SetTime(made, ctypes.c_double(t))
        values("fmi3SetFloat64", 1, x)
        values("fmi3SetFloat64", 1 + 2 * n, p)
        values("fmi3SetFloat64", 1 + 2 * n + len(p), () if inputs is None else inputs)
        found: list[float] = list(values("fmi3GetFloat64", begin, [0.0] * size))
        return found

    weakref.finalize(called, folder.cleanup)
    return called


USE = ("python -m fmpy simulate {stem}.fmu --show-plot", "python -m pytest")
ABOUT = "FMI 3.0: model exchange and co-simulation, source and binary"
TARGET = Target("fmu", ABOUT, c_text, fmu_files, USE, c_functions, run, ROLES)
