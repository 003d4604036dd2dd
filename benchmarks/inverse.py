"""Inverse dynamics: operations and instructions of the emitted C, beside those of the right-hand side.

    python benchmarks/inverse.py [-o benchmarks/inverse.md]

Operations are counted on the programs and are free of noise; instructions are counted by valgrind where it is there.
"""

from __future__ import annotations

import argparse
import platform
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

import eomgen
from eomgen.codegen.build import of_this_machine
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Role
from eomgen.codegen.targets.c import c_text

MODELS = Path(__file__).parent.parent / "models"
SYSTEMS = {
    "double_pendulum": (),
    "arm3": (),
    "arm7": (),
    "chain20": (),
    "gyrostat": (),
    "four_bar": ("alpha",),
    "stewart_platform": tuple(f"f{k}" for k in range(1, 7)),
}
PLAIN = 779  # operations of a plain recursion over the arm of seven axes, inertias of the bodies not regrouped
CALLS = 2000
PLAIN_C = ("-std=c99", "-O2")
_MAIN = """
int main(void)
{{
    double x[{states}], a[{speeds}], p[{parameters}], c[{constants}], out[{outputs}], sum = 0;
    for (int k = 0; k < {states}; k++) x[k] = 0.1 + 0.01*k;
    for (int k = 0; k < {speeds}; k++) a[k] = 0.3 - 0.02*k;
    for (int k = 0; k < {parameters}; k++) p[k] = 1 + 0.01*k;
    eomgen{prefix}_constants(p, c);
    for (int i = 0; i < {calls}; i++) {{
        eomgen{prefix}_evaluate(0, x, {a}p, c, NULL, out);
        sum += out[0];
    }}
    return sum == 1e300 || a[0] == 1e300;
}}
"""


def instructions(program: Program, role: Role, flags: Sequence[str] = PLAIN_C) -> int | None:
    """Instructions of one call, by valgrind: those of many calls less those of none."""
    if shutil.which("valgrind") is None or shutil.which("cc") is None:
        return None
    many, none = (_counted(program, role, flags, calls) for calls in (CALLS, 0))
    return round((many - none) / CALLS)


def flags_of_this_machine() -> tuple[str, ...]:
    """Those by which eomgen compiles what it runs itself, but for registers that valgrind does not know."""
    own = of_this_machine()
    return tuple(x for x in (*own.flags, *own.usual) if x not in ("-shared", "-fPIC") and "avx512" not in x)


def _counted(program: Program, role: Role, flags: Sequence[str], calls: int) -> int:
    sizes = {
        "states": len(program.states),
        "speeds": len(program.symbols.u),
        "outputs": len(program.outputs),
        "parameters": max(1, len(program.symbols.parameters)),
        "constants": len(program.hoisted) + 1,
    }
    text = c_text(program, "eomgen", role)
    text += _MAIN.format(prefix=role.prefix, calls=calls, a="a, " if program.accelerations else "", **sizes)
    with tempfile.TemporaryDirectory() as place:
        source, made = Path(place) / "run.c", Path(place) / "run"
        source.write_text(text)
        subprocess.run(["cc", *flags, "-o", str(made), str(source), "-lm"], check=True)
        reported = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={place}/out", str(made)],
            capture_output=True,
            text=True,
            check=True,
        )
    return int(next(line for line in reported.stderr.splitlines() if "Collected" in line).split()[-1])


def row(name: str, actuated: tuple[str, ...]) -> str:
    """A line of the table."""
    model = eomgen.load(MODELS / f"{name}.toml")
    equations = eomgen.derive(model)
    act = tuple(q for q in actuated if q in model.inputs or q in model.coordinates) or tuple(model.inputs)
    inverse = equations.inverse_dynamics(act if equations.graph.J or actuated else ()).program
    own, other = inverse.count.total, equations.program.count.total
    counted = [instructions(inverse, Role.INVERSE), instructions(equations.program, Role.RHS)]
    reported = " | ".join("-" if n is None else str(n) for n in counted)
    return f"| {name} | {len(equations.speeds)} | {own} | {other} | {own / other:.2f} | {reported} |"


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("-o", "--output", type=Path)
    lines = [
        "# Inverse dynamics beside the right-hand side",
        "",
        f"Made by `python benchmarks/inverse.py` on Python {platform.python_version()}, {platform.machine()}.",
        "Operations a call, each sub-expression once, those of the parameters alone left out; instructions a call of",
        f"the emitted C by valgrind. A plain recursion of Newton and Euler over `arm7` takes {PLAIN} operations.",
        "",
        "| system | speeds | operations | of the right-hand side | ratio | instructions | of the right-hand side |",
        "|---|---|---|---|---|---|---|",
        *(row(name, actuated) for name, actuated in SYSTEMS.items()),
        "",
    ]
    path = parser.parse_args().output
    if path is None:
        print("\n".join(lines))
    else:
        path.write_text("\n".join(lines))


if __name__ == "__main__":
    main()
