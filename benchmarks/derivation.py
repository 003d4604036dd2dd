"""Derivation time and size of the result, side by side with sympy in one run.

    python benchmarks/derivation.py [--quick] [-o FILE.md]

The clock of eomgen starts at the frozen Model; the time from text to Model stands beside it. Each of sympy's methods
runs in a process of its own (benchmarks/peers.py), in the coordinates that suit it best, up to LIMIT seconds.
"""

from __future__ import annotations

import argparse
import json
import platform
import runpy
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import sympy

import eomgen
from eomgen.symbolic.expression.derivatives import operations

HERE = Path(__file__).parent
MODELS = HERE.parent / "models"
LIMIT = 120  # seconds for one derivation by a peer
LENGTHS = (1, 2, 3, 5, 8, 10, 15, 20, 30, 50)
LAGRANGE_AT_MOST = 10
KANE_AT_MOST = 20


@dataclass(frozen=True)
class Ours:
    """What eomgen needs for one model; times in seconds, the best of several runs.

    Args:
        reading: text to frozen Model.
        graph: Model to M and forcing on the graph.
        as_sympy: Model to M and forcing as sympy expressions.
        equations: operations of M and forcing, those of the parameters alone left out.
        hoisted: operations of the parameters alone in M and forcing.
        whole: operations of the full right-hand side.
    """

    reading: float
    graph: float
    as_sympy: float
    equations: int
    hoisted: int
    whole: int


@dataclass(frozen=True)
class Peer:
    """What a method of sympy needs: seconds and operations after cse, or None where it ran into the limit."""

    seconds: float | None
    operations: int | None


def best(work: Callable[[], Any], runs: int) -> tuple[float, Any]:
    """The shortest of several runs [s], and the last result."""
    shortest, result = float("inf"), None
    for _ in range(runs):
        start = time.process_time()
        result = work()
        shortest = min(shortest, time.process_time() - start)
    return shortest, result


def ours(text: str, runs: int = 3) -> Ours:
    """Measures eomgen on the text of a model."""
    reading, model = best(lambda: eomgen.loads(text), runs)

    def derive_on_graph():
        equations = eomgen.derive(model)
        return equations, (equations.graph.M, equations.graph.forcing)

    def derive_to_sympy():
        equations = eomgen.derive(model)
        return equations.M, equations.forcing

    graph_time, (equations, _) = best(derive_on_graph, runs)
    sympy_time, _ = best(derive_to_sympy, runs)
    graph = equations.graph
    lower = [graph.M[i][j] for i in range(len(graph.M)) for j in range(i + 1)]
    count = operations([*lower, *graph.forcing], graph.symbols.parameters.values())
    return Ours(reading, graph_time, sympy_time, count.total, count.hoisted, equations.program.count.total)


def peer(method: str, size: int) -> Peer:
    """Measures a method of sympy in a process of its own."""
    command = [sys.executable, str(HERE / "peers.py"), method, str(size)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=2 * LIMIT, check=True)
    except subprocess.TimeoutExpired:
        return Peer(None, None)
    measured = json.loads(done.stdout)
    return Peer(measured["seconds"], measured["operations"]) if measured["seconds"] < LIMIT else Peer(None, None)


def cell(value: float | int | None) -> str:
    """A number for the table: times with three figures, counts whole."""
    if value is None:
        return "-"
    return str(value) if isinstance(value, int) else f"{value:.3g}"


def ratio(theirs: Peer | None, own: float) -> str:
    """How many times longer the peer takes."""
    return "-" if theirs is None or theirs.seconds is None else f"{theirs.seconds / own:.0f}"


@dataclass(frozen=True)
class EveryReaction:
    """What all reactions of a model take; times in seconds, the best of several runs.

    Args:
        components: scalar reactions, as outputs ask for them.
        graph: Model to M and forcing on the graph.
        seconds: Model to every reaction on the graph, linear in the accelerations.
        operations: of their program, the accelerations included.
        whole: operations of the full right-hand side.
    """

    components: int
    graph: float
    seconds: float
    operations: int
    whole: int


def every_reaction(text: str, runs: int = 3) -> EveryReaction:
    """Measures the reactions of a model."""
    model = eomgen.loads(text)
    graph, _ = best(lambda: eomgen.derive(model), runs)

    def derive_reactions():
        equations = eomgen.derive(model)
        return equations, equations.reactions.determinate()

    seconds, (equations, values) = best(derive_reactions, runs)
    _, program = equations.reactions_program
    return EveryReaction(len(values), graph, seconds, program.count.total, equations.program.count.total)


REACTION_COLUMNS = (
    "system",
    "components",
    "Model to M, F, graph [s]",
    "Model to every reaction, graph [s]",
    "ratio",
    "operations, reactions",
    "full RHS",
    "ratio",
)
REACTION_MODELS = ("double_pendulum", "andrews_squeezer", "arm3", "arm7", "chain20")


def reaction_table() -> list[tuple[str, ...]]:
    """Every reaction of some models."""
    rows = []
    for name in REACTION_MODELS:
        own = every_reaction((MODELS / f"{name}.toml").read_text())
        rows.append(
            report(
                (
                    name,
                    cell(own.components),
                    cell(own.graph),
                    cell(own.seconds),
                    f"{own.seconds / own.graph:.1f}",
                    cell(own.operations),
                    cell(own.whole),
                    f"{own.operations / own.whole:.2f}",
                )
            )
        )
    return rows


COLUMNS = (
    "system",
    "text to Model [s]",
    "Model to M, F, graph [s]",
    "as sympy [s]",
    "Lagrange [s]",
    "Kane [s]",
    "Lagrange/graph",
    "Kane/graph",
    "Lagrange/sympy form",
    "Kane/sympy form",
    "operations M, F",
    "hoisted",
    "full RHS",
    "Lagrange, cse",
    "Kane, cse",
)


def row(name: str, own: Ours, lagrange: Peer | None, kane: Peer | None) -> tuple[str, ...]:
    """One line of the table."""
    return (
        name,
        cell(own.reading),
        cell(own.graph),
        cell(own.as_sympy),
        cell(lagrange and lagrange.seconds),
        cell(kane and kane.seconds),
        ratio(lagrange, own.graph),
        ratio(kane, own.graph),
        ratio(lagrange, own.as_sympy),
        ratio(kane, own.as_sympy),
        cell(own.equations),
        cell(own.hoisted),
        cell(own.whole),
        cell(lagrange and lagrange.operations),
        cell(kane and kane.operations),
    )


def table(quick: bool) -> list[tuple[str, ...]]:
    """Every measurement; the quick one leaves out what takes more than a few seconds."""
    chain = runpy.run_path(str(MODELS / "chain.py"))["chain"]
    rows = []
    for n in (2, 5, 10) if quick else LENGTHS:
        own = ours(chain(n))
        lagrange = peer("lagrange", n) if n <= (5 if quick else LAGRANGE_AT_MOST) else None
        kane = peer("kane", n) if n <= KANE_AT_MOST else None
        rows.append(report(row(f"chain, n = {n}", own, lagrange, kane)))
    own = ours((MODELS / "arm7.toml").read_text())
    rows.append(report(row("arm7", own, None, None if quick else peer("kane-arm", 7))))
    return rows


def report(cells: tuple[str, ...]) -> tuple[str, ...]:
    """Says on stderr that a line of the table is there."""
    print("  ".join(cells), file=sys.stderr)
    return cells


def markdown(rows: list[tuple[str, ...]], reactions: list[tuple[str, ...]], command: str) -> str:
    """The measurements as a page."""
    lines = [
        "# Derivation, side by side with sympy",
        "",
        f"Made by `{command}` on Python {platform.python_version()}, sympy {sympy.__version__}, {platform.machine()}.",
        "",
        "Ratios are of times in this one run. Ours are the best of three runs, front end included; an operation is",
        "each `+ - * /`, power or function reached from the results, once; signs and constants are free; what depends",
        "on parameters only is hoisted. The peers' counts are after `sympy.cse`, by the same rule. KanesMethod and",
        f"LagrangesMethod have angles from the vertical, their best; `-`: not run, or over {LIMIT} s.",
        "",
        "| " + " | ".join(COLUMNS) + " |",
        "|" + "---|" * len(COLUMNS),
        *("| " + " | ".join(cells) + " |" for cells in rows),
        "",
        "## Every reaction",
        "",
        "All force and couple components of all joints and constraints as functions of q, u, accelerations, from the",
        "frozen Model on, M and F included. Operations: one evaluation from (t, x, p), accelerations included. No peer",
        "gives them by default.",
        "",
        "| " + " | ".join(REACTION_COLUMNS) + " |",
        "|" + "---|" * len(REACTION_COLUMNS),
        *("| " + " | ".join(cells) + " |" for cells in reactions),
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="only what takes a few seconds")
    parser.add_argument("-o", "--output", type=Path, help="write the table there instead of to stdout")
    arguments = parser.parse_args()
    command = "python benchmarks/derivation.py" + (" --quick" if arguments.quick else "")
    page = markdown(table(arguments.quick), reaction_table(), command)
    if arguments.output is None:
        print(page, end="")
    else:
        arguments.output.write_text(page)


if __name__ == "__main__":
    main()
