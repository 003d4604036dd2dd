"""Systems of space, in one run: a platform on six legs, trees of fifty bodies, the Whipple bicycle.

    python benchmarks/space.py [--bicycle] [-o benchmarks/space.md]

`--bicycle` runs sympy's own test of the bicycle too, which takes two minutes.
"""

from __future__ import annotations

import argparse
import platform
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import sympy

import eomgen
from eomgen.codegen import build
from eomgen.codegen.rhs import RightHandSide
from eomgen.codegen.targets.c import c_text

MODELS = Path(__file__).parent.parent / "models"
AXES = ([1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 2, 2])
INSTRUCTED = 1000  # calls under valgrind
BICYCLE = "from sympy.physics.mechanics.tests.test_kane3 import test_bicycle as t; t()"


def best(work: Callable[[], Any], runs: int = 3) -> tuple[float, Any]:
    """The shortest of several runs [s of this process], and the last result."""
    shortest, result = float("inf"), None
    for _ in range(runs):
        start = time.process_time()
        result = work()
        shortest = min(shortest, time.process_time() - start)
    return shortest, result


# -- right-hand sides in C -----------------------------------------------------------------------------


def call(rhs: RightHandSide, calls: int) -> float:
    """One evaluation in C at the start, in a loop that is in C too [µs]."""
    x = np.tile(rhs.x0, (calls, 1))
    return best(lambda: rhs.many(0.0, x, rhs.p0), runs=9)[0] / calls * 1e6


def instructions(rhs: RightHandSide) -> int | None:
    """What one evaluation executes, as valgrind counts it; None without valgrind."""
    compiler = build.compiler()
    if shutil.which("valgrind") is None or compiler is None:
        return None
    x, p = (", ".join(map(repr, map(float, values))) for values in (rhs.x0, rhs.p0))
    main = (
        f"#include <stdlib.h>\n{rhs.source}\nint main(int n, char **given)\n{{\n"
        f"    static double x[] = {{{x}}}, p[] = {{{p}}}, c[10000], dx[1000];\n    eomgen_constants(p, c);\n"
        "    for (long i = n > 1 ? atol(given[1]) : 0; i > 0; i--) eomgen_evaluate(0, x, p, c, NULL, dx);\n}\n"
    )
    with tempfile.TemporaryDirectory() as place:
        source, program = Path(place) / "program.c", Path(place) / "program"
        source.write_text(main)
        subprocess.run([compiler, "-O2", "-o", program, source, "-lm"], check=True)
        counts = [_counted(program, n) for n in (0, INSTRUCTED)]
    return (counts[1] - counts[0]) // INSTRUCTED


def _counted(program: Path, calls: int) -> int:
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", str(program), str(calls)]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    return int(said.split("Collected :")[1].split()[0])


def right_hand_sides() -> list[tuple[str, ...]]:
    """arm7, and systems with loops beside it."""
    rows, arm = [], eomgen.derive(eomgen.load(MODELS / "arm7.toml")).rhs("c")
    first = instructions(arm)
    for name in ("arm7", "andrews_squeezer", "stewart_platform", "bricard", "delta_robot", "whipple_bicycle"):
        equations = eomgen.derive(eomgen.load(MODELS / f"{name}.toml"))
        rhs = equations.rhs("c")
        pairs = [(call(rhs, 2000), call(arm, 2000)) for _ in range(5)]
        took, beside = map(min, zip(*pairs, strict=True))
        executed = instructions(rhs)
        ratios = f"{took / beside:.1f}", "-" if executed is None or first is None else f"{executed / first:.1f}"
        sizes = f"{len(equations.speeds)}", f"{len(equations.graph.J)}"
        counted = str(equations.program.count.total), "-" if executed is None else str(executed)
        rows.append(report((name, *sizes, *counted, f"{took:.2f}", *ratios)))
    return rows


# -- trees ---------------------------------------------------------------------------------------------


def tree(bodies: int, joints: tuple[str, ...], branching: float, free: bool = False) -> str:
    """A random tree, every mass, centre, inertia and length a parameter; its first body floats where it is free."""
    rng = random.Random(1)
    parameters, coordinates, speeds, parts = ["g = 9.81"], [], [], []
    for i in range(bodies):
        parent = i - 1 if rng.random() >= branching else rng.randrange(max(i, 1))
        on = f'on = "b{parent}.end", ' if i else ""
        kind = "free" if free and i == 0 else rng.choice(joints)
        parameters += [f"m{i} = {rng.uniform(0.5, 2):.3f}", f"l{i} = {rng.uniform(0.2, 0.5):.3f}", f"a{i} = 0.03"]
        parameters += [f"A{i} = 0.02", f"B{i} = 0.03", f"C{i} = 0.025", f"D{i} = 0.001"]
        parts += [
            f"[bodies.b{i}]",
            f'mass = "m{i}"',
            f'center = ["a{i}", 0, "l{i}/2"]',
            f'inertia = ["A{i}", "B{i}", "C{i}", "D{i}", 0, 0]',
            f'points = {{ end = [0, 0, "l{i}"] }}',
            joint(kind, i, on, rng, coordinates, speeds),
        ]
    return "\n".join(
        [
            "eomgen = 1",
            'space = "space"',
            "[parameters]",
            *parameters,
            "[coordinates]",
            *coordinates,
            "[speeds]",
            *speeds,
            *parts,
            "[forces.weight]",
            'kind = "gravity"',
            'acceleration = [0, 0, "-g"]',
        ]
    )


def joint(kind: str, i: int, on: str, rng: random.Random, coordinates: list[str], speeds: list[str]) -> str:
    """The joint's line; its coordinates and speeds are added to the lists."""
    names = [f"q{i}", f"r{i}", f"s{i}"]
    if kind in ("quaternion", "free"):
        four, three = [f"e{i}{j}" for j in range(4)], [f"w{i}{j}" for j in range(3)]
        coordinates += [f"{name} = {int(name.endswith('0'))}" for name in four]
        speeds += [f"{name} = {{}}" for name in three]
        coordinates += [f"{name} = 0" for name in names] if kind == "free" else []
        place = f"position = {names}, " if kind == "free" else on
        kind = "free" if kind == "free" else "spherical"
        return f'joint = {{ kind = "{kind}", {place}orientation = "quaternion", quaternion = {four}, omega = {three} }}'
    count = {"revolute": 1, "universal": 2, "spherical": 3}[kind]
    coordinates += [f"{name} = {rng.uniform(-0.5, 0.5):.3f}" for name in names[:count]]
    if kind == "revolute":
        return f'joint = {{ kind = "revolute", {on}axis = {rng.choice(AXES)}, angle = "q{i}" }}'
    if kind == "universal":
        return f'joint = {{ kind = "universal", {on}axes = [[1, 0, 0], [0, 1, 0]], angles = {names[:2]} }}'
    return f'joint = {{ kind = "spherical", {on}orientation = "xyz", angles = {names} }}'


TREES = {
    "chain, 50 hinges": (50, ("revolute",), 0.0, False),
    "tree, 50 hinges": (50, ("revolute",), 0.3, False),
    "tree, 50 bodies, one to three turns a joint": (50, ("revolute", "universal", "spherical"), 0.3, False),
    "tree, 50 spherical joints by quaternions": (50, ("quaternion",), 0.3, False),
    "chain, 50 spherical joints by angles": (50, ("spherical",), 0.0, False),
    "free base, 20 bodies": (20, ("revolute", "universal", "quaternion"), 0.4, True),
}


def trees() -> list[tuple[str, ...]]:
    """Text to Model, Model to M and forcing, and on to the program of the right-hand side; then its C, compiled."""
    rows = []
    eomgen.derive(eomgen.loads(tree(2, ("revolute",), 0.0))).rhs("numpy")  # what is imported on first use
    for name, given in TREES.items():
        text = tree(*given)
        reading, model = best(lambda text=text: eomgen.loads(text))
        deriving, equations = best(lambda model=model: eomgen.derive(model))
        ordering, program = best(lambda equations=equations: replace(equations).program)
        times = reading, deriving, ordering, reading + deriving + ordering
        rows.append(
            report(
                (
                    name,
                    str(len(equations.speeds)),
                    *(f"{s:.2f}" for s in times),
                    str(program.count.total),
                    f"{compiling(c_text(program, 'eomgen')):.1f}",
                )
            )
        )
    return rows


def compiling(text: str) -> float:
    """How long the C compiler takes [s], nothing kept from before."""
    compiler = build.compiler()
    assert compiler is not None, "a C compiler is needed"
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    with tempfile.TemporaryDirectory() as place:
        source = Path(place) / "program.c"
        source.write_text(text)
        flags = build.FLAGS if len(text) < build.LONG_TEXT else build.FLAGS_OF_LONG_TEXT
        subprocess.run([compiler, *flags, "-o", Path(place) / "program.so", source, "-lm"], check=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


# -- the bicycle ---------------------------------------------------------------------------------------


def bicycle(with_sympy: bool) -> list[tuple[str, ...]]:
    """Whipple's bicycle from the Model to its linearized equations at zero steer, and sympy's own test of it."""
    eomgen.linearize(eomgen.load(MODELS / "simple_pendulum.toml"))  # what is imported on first use
    model = eomgen.load(MODELS / "whipple_bicycle.toml")
    own, _ = best(lambda: eomgen.linearize(model).as_dict(), runs=1)
    theirs = None
    if with_sympy:
        started = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run([sys.executable, "-c", BICYCLE], check=True)
        theirs = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - started
    shown = ("-", "-") if theirs is None else (f"{theirs:.1f}", f"{theirs / own:.0f}")
    return [report((f"{own:.2f}", *shown))]


def report(cells: tuple[str, ...]) -> tuple[str, ...]:
    """Says on stderr that a line of a table is there."""
    print("  ".join(cells), file=sys.stderr)
    return cells


def table(columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    return [f"| {' | '.join(cells)} |" for cells in (columns, ("---",) * len(columns), *rows)]


def page(command: str, with_sympy: bool) -> str:
    """The measurements, in words and tables."""
    versions = f"Python {platform.python_version()}, sympy {sympy.__version__}, {platform.machine()}"
    return (
        "\n".join(
            [
                "# Systems of space",
                "",
                f"Made by `{command}` on {versions}.",
                "",
                "Times are of the process, not of the clock on the wall; ratios are of times in this one run.",
                "",
                "## Right-hand sides in C",
                "",
                "Speeds and constraint rows; operations of one evaluation, the solve with its second pass included;",
                "instructions by valgrind; ratios against the seven-axis arm.",
                "",
                *table(
                    (
                        "system",
                        "speeds",
                        "rows",
                        "operations",
                        "instructions",
                        "µs",
                        "µs/arm7 beside",
                        "instructions/arm7",
                    ),
                    right_hand_sides(),
                ),
                "",
                "## Trees",
                "",
                "Every mass, centre, inertia and length is a symbol. Text to Model, to M and forcing, to the ordered",
                "program of the right-hand side; the operations of that; gcc's time for its C.",
                "",
                *table(
                    (
                        "system",
                        "speeds",
                        "Model [s]",
                        "M, F [s]",
                        "program [s]",
                        "all three [s]",
                        "operations",
                        "C [s]",
                    ),
                    trees(),
                ),
                "",
                "## Whipple's bicycle, linearized",
                "",
                "Model to M, C, K, state matrix and modes at zero steer; sympy: `test_kane3.test_bicycle`,",
                "import and all.",
                "",
                *table(("eomgen [s]", "sympy [s]", "ratio"), bicycle(with_sympy)),
            ]
        )
        + "\n"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bicycle", action="store_true", help="sympy's bicycle too: two minutes")
    parser.add_argument("-o", "--output", type=Path, help="write the page there instead of to stdout")
    arguments = parser.parse_args()
    text = page("python benchmarks/space.py" + (" --bicycle" if arguments.bicycle else ""), arguments.bicycle)
    if arguments.output is None:
        print(text, end="")
    else:
        arguments.output.write_text(text)


if __name__ == "__main__":
    main()
