"""The right-hand side in every language beside C: nanoseconds a state and ratios, all in one run on one machine.

    python benchmarks/languages.py [-o benchmarks/languages.md] [--only jax] [--states 1000000] [MODEL ...]

A batch of states is given to each in its own way: a compiled loop, a process beside us (the pipe counts), vmap of JAX,
map of CasADi. Compiling is apart. What is not installed is named, and the device that JAX takes. `apart`: the
largest difference to C, of the largest value.
"""

from __future__ import annotations

import argparse
import os
import platform
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import eomgen
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.codegen.targets import ALL, casadi, jax, numba
from eomgen.codegen.targets.python_files import executed
from eomgen.errors import RunFailed, ToolMissing

MODELS = Path(__file__).parent.parent / "models"
SYSTEMS = ("cart_pole", "arm7", "four_bar", "whipple_bicycle")
STATES = 2000
BEST_OF = 5
ENOUGH = 10.0  # seconds of one language

Batch = Callable[[], np.ndarray]


def batch_of(name: str, program: Program, t: np.ndarray, X: np.ndarray, p: np.ndarray) -> Batch:
    """All states at once, in the language's own way; what is compiled is compiled here."""
    if name == "jax":
        space = executed(jax.FORM.text(program, "m"), "m_jax")
        many = space["jax"].jit(space["jax"].vmap(space["m_rhs"], (None, 0, None)))
        return lambda: np.asarray(many(0.0, X, p))
    if name == "casadi":
        mapped = executed(casadi.FORM.text(program, "m"), "m_casadi")["own"].map(len(X))
        turned = np.ascontiguousarray(X.T)
        return lambda: np.asarray(mapped(0.0, turned, p)).T
    if name == "numba":
        space = executed(numba.FORM.text(program, "m") + _LOOP, "m_numba")
        return lambda: space["_loop"](X, p, len(program.outputs))
    rhs = RightHandSide.of(program, name)
    return lambda: rhs.many(t, X, p)


_LOOP = """

@_compiled
def _loop(X, p, n):
    c, found = constants(p), np.zeros((len(X), n))
    for i in range(len(X)):
        found[i] = evaluate(0.0, X[i], p, c, None)
    return found
"""


def device_of(name: str) -> str:
    """What runs it, where that is not this machine's processor by itself."""
    if name != "jax":
        return ""
    import jax as package

    return f" on {package.devices()[0].platform} ({package.devices()[0].device_kind})"


def rows(model: str, only: Sequence[str], states: int) -> list[tuple[str, float, float, str]]:
    """(language, ns a state, its difference to C, what is to be said) of one model; C first, and those asked for."""
    equations = eomgen.derive(MODELS / f"{model}.toml")
    program, rhs = equations.program, equations.rhs("c")
    rng = np.random.default_rng(1)
    start = rhs.x0 if rhs.x0 is not None else np.zeros(len(program.states))
    p = rhs.p0 if rhs.p0 is not None else np.ones(len(rhs.parameters))
    X, t = start + rng.uniform(-0.3, 0.3, (states, len(start))), np.zeros(states)
    right, found = rhs.many(t, X, p), []
    for target in sorted(ALL, key=lambda each: each.name != "c"):
        if target.name == "fmu" or (only and target.name not in ("c", *only)):
            continue
        try:
            begun = time.perf_counter()
            batch = batch_of(target.name, program, t, X, p)
            values = batch()
            making = time.perf_counter() - begun
        except (ToolMissing, RunFailed) as error:
            found.append((target.name, np.nan, np.nan, error.what))
            continue
        apart = float(np.nanmax(np.abs(values - right)) / max(1.0, float(np.nanmax(np.abs(right)))))
        found.append(
            (target.name, _best(batch) / states * 1e9, apart, f"made in {making:.1f} s{device_of(target.name)}")
        )
    return found


def _best(batch: Callable[[], Any]) -> float:
    """The shortest of some runs, fewer where they are long."""
    times: list[float] = []
    while len(times) < BEST_OF and sum(times) < ENOUGH:
        begun = time.perf_counter()
        batch()
        times.append(time.perf_counter() - begun)
    return min(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("models", nargs="*", default=SYSTEMS)
    parser.add_argument("-o", "--output")
    parser.add_argument("--only", action="append", default=[], help="a language beside C; repeatable")
    parser.add_argument("--states", type=int, default=STATES)
    requested = parser.parse_args()
    lines = [
        "# Every language beside C",
        "",
        f"Python {platform.python_version()}, {platform.machine()}, one core; load {os.getloadavg()[0]:.1f} at first.",
        "",
    ]
    for model in requested.models:
        lines += [f"## {model}", "", "| language | ns a state | times C | apart | |", "|---|---|---|---|---|"]
        table = rows(model, requested.only, requested.states)
        c = table[0][1]
        for name, nanoseconds, apart, said in table:
            known = nanoseconds == nanoseconds
            numbers = f"{nanoseconds:.0f} | {nanoseconds / c:.2f} | {apart:.0e}" if known else "| | "
            lines.append(f"| {name} | {numbers} | {said} |")
        lines.append("")
        print("\n".join(lines[-len(table) - 5 :]), flush=True)
    if requested.output:
        Path(requested.output).write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
