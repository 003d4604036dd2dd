"""What a sweep costs beside its runs: time for each run, memory, size of the ledger, at 10^4 to 10^6 runs.

    python benchmarks/sweep.py [--runs 100000] [-o benchmarks/sweep.md]

The motion is taken out: each run gives three numbers at once. All else is the sweep's own: draws by number, rows,
chunks, processes, the ledger, the table. CPU time is of this process and its children.
"""

from __future__ import annotations

import argparse
import multiprocessing
import platform
import resource
import tempfile
import time
from pathlib import Path

import eomgen
from eomgen.sweeps import workers as kernel

MODEL = Path(__file__).parent.parent / "models" / "cart_pole.toml"
REQUESTED = ("last(x)", "max(theta)", "last(theta')")


def nothing(self: kernel.SweepKernel, set_: dict[str, float]) -> tuple[str, str, list[float]]:
    """A run that costs nothing."""
    return "finished", "", [set_["theta"], set_["l"], 1 / 3]


def measured(runs: int, workers: int, design: str) -> tuple[float, float, float, float]:
    """(CPU us a run, wall us a run, MiB of the parent at most, MiB of the ledger) in a process of its own."""
    with multiprocessing.get_context("fork").Pool(1) as pool:
        return pool.apply(_measured, (runs, workers, design))


def _measured(runs: int, workers: int, design: str) -> tuple[float, float, float, float]:
    multiprocessing.current_process()._config["daemon"] = False  # it has children of its own
    kernel.SweepKernel.requested = nothing
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with tempfile.TemporaryDirectory() as folder:
        begun, cpu = time.perf_counter(), _cpu()
        eomgen.sweep(
            MODEL,
            over={"theta": "0.1:0.5:10"},
            random={"l": "uniform(0.5, 1)"},
            runs=runs // 10,
            design=design,
            ask=REQUESTED,
            workers=workers,
            out=folder,
        )
        wall, used = time.perf_counter() - begun, _cpu() - cpu
        size = (Path(folder) / "ledger.sqlite").stat().st_size / 2**20
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert after >= before
    return used / runs * 1e6, wall / runs * 1e6, after / 1024, size


def _cpu() -> float:
    own, children = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


def main() -> None:
    """Measures, and prints or writes the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=100_000)
    parser.add_argument("-o", "--output")
    requested = parser.parse_args()
    lines = [
        "# Sweeps",
        "",
        f"Made by `python benchmarks/sweep.py --runs {requested.runs}` on Python {platform.python_version()}, "
        f"{platform.machine()}: what a sweep",
        "costs beside its runs, plan to table, CPU time of parent and workers together.",
        "",
        "| runs | design | workers | CPU us a run | wall us a run | MiB of the parent | MiB of the ledger |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    cases = [
        (requested.runs // 10, 1, "random"),
        *((requested.runs, k, d) for d in ("random", "sobol", "lhs") for k in (1, 2)),
    ]
    for runs, workers, design in [*cases, (10 * requested.runs, 1, "random")]:
        cpu, wall, memory, size = measured(runs, workers, design)
        lines.append(f"| {runs} | {design} | {workers} | {cpu:.1f} | {wall:.1f} | {memory:.0f} | {size:.1f} |")
        print(lines[-1], flush=True)
    if requested.output:
        Path(requested.output).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
