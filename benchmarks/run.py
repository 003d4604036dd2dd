"""Everything beside its peers, in one run: python benchmarks/run.py [--quick] [-o benchmarks/results.md]

One table of ratios; below it the tables that it is taken from, each by the script that its head names: derivation
(sympy), right-hand sides (operations, instructions; CasADi, Pinocchio), motions at equal error (scipy with lambdify,
CasADi, diffrax, heyoka), and how all of it grows with the number of bodies. A peer that does not import is named as
missing. Times are CPU seconds of the process; trust the ratios.
"""

from __future__ import annotations

import argparse
import platform
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import derivation
import growth
import integration
import inverse
import numpy as np
from chain import chain
from four_bars import four_bars

import eomgen
from eomgen.codegen.targets.base import Role

RODS, STATES = 10, 20_000
PEERS = ("numpy", "scipy", "sympy", "casadi", "pin", "diffrax", "jax", "heyoka")
GLANCE = "| measure | eomgen | peer | the peer's | times eomgen's |\n|---|---|---|---|---|"


def versions() -> str:
    """The peers that are here."""
    found = []
    for name in PEERS:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"{name} missing")
    return ", ".join(found)


def derivations(rows: list[tuple[str, ...]]) -> Iterator[str]:
    """Of the longest row of each peer: its time against ours."""
    heads = derivation.COLUMNS
    for peer in ("Lagrange", "Kane"):
        whole = [dict(zip(heads, row, strict=True)) for row in rows]
        there = [row for row in whole if row[f"{peer} [s]"] != "-"]
        for row in there[-2:]:
            own, other = row["Model to M, F, graph [s]"], row[f"{peer} [s]"]
            what = f"{row['system']}: M and forcing"
            yield f"| {what} | {own} s | sympy {peer}'s method | {other} s | {row[f'{peer}/graph']} |"


def calls() -> Iterator[str]:
    """A call of the right-hand side of a chain: ours of many states at once, Pinocchio's from Python one by one."""
    rhs = eomgen.derive(eomgen.loads(chain(RODS))).rhs()
    assert rhs.x0 is not None
    assert rhs.p0 is not None
    states = np.tile(rhs.x0, (STATES, 1))
    own = growth.spent(lambda: rhs.many(0.0, states, rhs.p0)) / STATES
    count = rhs.program.count.total
    for name, work, mine, unit in (
        ("a call (emitted C, many states; Pinocchio's from Python)", growth.by_pinocchio, own, " s"),
        ("operations", growth.by_casadi, float(count), ""),
    ):
        peer = "Pinocchio ABA" if work is growth.by_pinocchio else "CasADi, derivatives of T and V"
        try:
            other = work(RODS)
        except ImportError:
            yield f"| chain of {RODS}, {name} | {mine:.3g}{unit} | {peer} | missing here | |"
            continue
        yield f"| chain of {RODS}, {name} | {mine:.3g}{unit} | {peer} | {other:.3g}{unit} | {other / mine:.1f} |"


def motions(rows: list[str], what: str) -> Iterator[str]:
    """The rows of a table of motions against its first one."""
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows[2:]]
    own = next(row for row in cells if row[0].startswith("eomgen"))
    for row in cells:
        if not row[0].startswith("eomgen"):
            yield f"| {what} | {own[3]} | {row[0]} | {row[3]} | {row[4]} |"


def counts() -> Iterator[str]:
    """Operations and instructions of a call."""
    yield "| system | operations | instructions of the emitted C, -O2 | as eomgen compiles it here, AVX-512 left out |"
    yield "|---|---|---|---|"
    systems = {f"row of {n} four-bars": four_bars(n) for n in (10, 40)}
    systems |= {f"chain of {RODS}": chain(RODS)}
    systems |= {name: (inverse.MODELS / f"{name}.toml").read_text() for name in ("double_pendulum", "arm7")}
    for name, text in systems.items():
        program = eomgen.derive(eomgen.loads(text)).program
        own = inverse.instructions(program, Role.RHS, inverse.flags_of_this_machine())
        yield f"| {name} | {program.count.total} | {inverse.instructions(program, Role.RHS) or '-'} | {own or '-'} |"


def page(quick: bool) -> Iterator[str]:
    """The page, line by line."""
    command = "python benchmarks/run.py" + (" --quick" if quick else "")
    rows = derivation.table(quick)
    single = list(integration.single_rows())
    many = [] if quick else list(integration.many_rows())
    yield "# Side by side with peers"
    yield ""
    yield f"Made by `{command}` on Python {platform.python_version()}, {platform.machine()}; {versions()}."
    yield "Times are CPU seconds of one run on a machine with other work: trust the ratios. Tables below it say how."
    yield ""
    yield GLANCE
    yield from derivations(rows)
    yield from calls()
    yield from motions(single, "double pendulum, 10 s, at equal error, CPU [ms]")
    yield from motions(many, f"{integration.RUNS} double pendulums, 10 s, at equal error, CPU [s]") if many else ()
    yield "\n## Growth with the number of bodies (`benchmarks/growth.py`)\n"
    yield from growth.table(quick)
    yield "\n## Counts (`benchmarks/inverse.py`)\n"
    yield from counts()
    yield f"\n## Double pendulum, 10 s, error below {integration.ERROR:g} (`benchmarks/integration.py`)\n"
    yield from single
    yield from ["", *many] if many else ()
    text = derivation.markdown(rows, derivation.reaction_table(), "python benchmarks/derivation.py")
    yield "\n" + text.replace("\n## ", "\n### ").replace("# ", "## ", 1).rstrip()


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--quick", action="store_true", help="smaller sizes: some minutes")
    words.add_argument("-o", "--output", type=Path, help="write the page there, too")
    requested = words.parse_args()
    lines = []
    for line in page(requested.quick):
        print(line, flush=True)
        lines.append(line)
    if requested.output is not None:
        requested.output.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
