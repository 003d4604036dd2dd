"""Motions against peers, in one run and at equal error: python benchmarks/integration.py [-o FILE.md]

Every rival integrates the same double pendulum (models/double_pendulum.toml) for 10 s and gives 101 states; for the
others its equations are written out by hand. Of several tolerances the loosest is taken whose error against the
reference is below 1e-6; the time is the least CPU time of some calls after a first one. The reference has 25 digits
(extrapolation in mpmath with two step widths, `--reference` makes it anew). What does not import is named as missing.
"""

from __future__ import annotations

import argparse
import os
import platform
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

import eomgen
from eomgen.simulation import integrator, motion
from eomgen.simulation.compiled_phases import BorrowedPhases

MODELS = Path(__file__).parent.parent / "models"
START, TIME, SAMPLES = [2.0, 0.5, 0.0, 0.0], 10.0, 101
M1, M2, L1, L2, G = 1.0, 1.0, 1.0, 0.5, 9.81
TOLERANCES = [10.0 ** (-k / 2) for k in range(12, 28)]
ERROR = 1e-6
REFERENCE = (  # --reference: 1000 and 2000 steps differ by 3e-20, their order is 24
    "-1.4401629538417988145466885",
    "-5.9839823765164500314328789",
    "-2.4713251372556811958240850",
    "8.8253136271604716287348623",
)
RUNS = 1000
A_TURN = 3  # calls


def rate(x, sin, cos):
    """x' of two rods, over any numbers."""
    a, b, u, v = x
    s, c = sin(a - b), cos(a - b)
    m11, m12, m22 = L1**2 * (M1 / 3 + M2), L1 * L2 * M2 * c / 2, L2**2 * M2 / 3
    f1 = -v * v * L1 * L2 * M2 * s / 2 - G * L1 * (M1 / 2 + M2) * sin(a)
    f2 = u * u * L1 * L2 * M2 * s / 2 - G * L2 * M2 * sin(b) / 2
    d = m11 * m22 - m12 * m12
    return [u, v, (m22 * f1 - m12 * f2) / d, (m11 * f2 - m12 * f1) / d]


def reference(steps: int):
    """x(10) by Gragg's extrapolation of order 24 with 40 digits."""
    import mpmath as mp

    mp.mp.dps = 40
    global M1, M2, L1, L2, G
    kept = M1, M2, L1, L2, G
    M1, M2, L1, L2, G = mp.mpf(1), mp.mpf(1), mp.mpf(1), mp.mpf(1) / 2, mp.mpf("9.81")
    x, H, rows = [mp.mpf(2), mp.mpf(1) / 2, mp.mpf(0), mp.mpf(0)], mp.mpf(10) / steps, 12
    for _ in range(steps):
        table: list[list] = []
        first = rate(x, mp.sin, mp.cos)
        for j in range(rows):
            n = 2 * (j + 1)
            h = H / n
            before, here = x, [a + h * b for a, b in zip(x, first, strict=True)]
            for _ in range(n - 1):
                after = rate(here, mp.sin, mp.cos)
                before, here = here, [a + 2 * h * b for a, b in zip(before, after, strict=True)]
            last = rate(here, mp.sin, mp.cos)
            row = [[(a + b + h * c) / 2 for a, b, c in zip(before, here, last, strict=True)]]
            for k in range(1, j + 1):
                factor = (mp.mpf(n) / (2 * (j + 1 - k))) ** 2 - 1
                row.append([p + (p - q) / factor for p, q in zip(row[k - 1], table[j - 1][k - 1], strict=True)])
            table.append(row)
        x = table[-1][-1]
    M1, M2, L1, L2, G = kept
    return x


def by_eomgen(target: str | None = None, method: str = "auto"):
    def make(tolerance):
        how = {"rtol": 10 * tolerance, "atol": 10 * tolerance, "target": target, "method": method}
        simulate = eomgen.simulator(MODELS / "double_pendulum.toml", **how)
        return lambda: simulate(TIME, samples=SAMPLES).x[-1]

    return make


def by_eomgen_in_python(tolerance):
    """The loop in Python over C stages' right-hand side, as it was."""
    simulate = eomgen.simulator(MODELS / "double_pendulum.toml", rtol=10 * tolerance, atol=10 * tolerance, target="c")

    def run():
        kept, integrator.COMPILED = integrator.COMPILED, ()
        try:
            return simulate(TIME, samples=SAMPLES).x[-1]
        finally:
            integrator.COMPILED = kept

    return run


def by_scipy(tolerance):
    import sympy as sp
    from scipy.integrate import solve_ivp

    x = sp.symbols("a b u v")
    f = sp.lambdify([x], rate(x, sp.sin, sp.cos), modules="math", cse=True)
    t = np.linspace(0, TIME, SAMPLES)
    return lambda: solve_ivp(lambda _, y: f(y), (0, TIME), START, "DOP853", t, rtol=tolerance, atol=tolerance).y[:, -1]


def by_casadi(tolerance):
    import casadi as ca

    x = ca.SX.sym("x", 4)
    ode = ca.vertcat(*rate([x[i] for i in range(4)], ca.sin, ca.cos))
    how = {"abstol": tolerance, "reltol": tolerance, "max_num_steps": 1_000_000}
    run = ca.integrator("run", "cvodes", {"x": x, "ode": ode}, 0, np.linspace(0, TIME, SAMPLES)[1:].tolist(), how)
    return lambda: np.array(run(x0=START)["xf"])[:, -1]


def by_diffrax(tolerance, runs: int = 0):
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    term = diffrax.ODETerm(lambda t, y, p: jnp.stack(rate(y, jnp.sin, jnp.cos)))
    saved = diffrax.SaveAt(ts=jnp.linspace(0, TIME, SAMPLES))
    control = diffrax.PIDController(rtol=tolerance, atol=tolerance)

    def solve(y):
        return diffrax.diffeqsolve(
            term, diffrax.Dopri8(), 0.0, TIME, None, y, saveat=saved, stepsize_controller=control, max_steps=100_000
        ).ys

    if runs:
        solved, y = jax.jit(jax.vmap(solve)), jnp.array(starts(runs))
        return lambda: np.asarray(solved(y))[:, -1]
    one, y0 = jax.jit(solve), jnp.array(START)
    return lambda: np.asarray(one(y0))[-1]


def by_heyoka(tolerance, runs: int = 0):
    import heyoka as hy

    names = hy.make_vars("a", "b", "u", "v")
    system = list(zip(names, rate(names, hy.sin, hy.cos), strict=True))
    t = np.linspace(0, TIME, SAMPLES)
    if not runs:
        one = hy.taylor_adaptive(system, START, tol=tolerance)

        def run():
            one.time, one.state[:] = 0.0, START
            return one.propagate_grid(t)[-1][-1]

        return run
    width = 8
    many = hy.taylor_adaptive_batch(system, np.zeros((4, width)), tol=tolerance)
    begun = np.array(starts(runs)).reshape(-1, width, 4)

    def all_of():
        ends = []
        for group in begun:
            many.set_time(0.0)
            many.state[:] = group.T
            ends.append(many.propagate_grid(np.repeat(t[:, None], width, 1))[-1][-1].T)
        return np.vstack(ends)

    return all_of


def many_by_eomgen(tolerance, runs, **how):
    values = np.array(starts(runs))

    def run():
        requested = {"rtol": 10 * tolerance, "atol": 10 * tolerance, "samples": SAMPLES, **how}
        start = {"theta1": values[:, 0], "theta2": values[:, 1]}
        return eomgen.simulate_many(MODELS / "double_pendulum.toml", time=TIME, start=start, **requested).x[:, -1]

    return run


def starts(runs: int) -> list[list[float]]:
    return [[2 + 1e-3 * k / runs, 0.5, 0.0, 0.0] for k in range(runs)]


def cpu(run: Callable[[], object], calls: int = 5, seconds: float = 3.0) -> float:
    """The least CPU time of some calls after a first one [s]."""
    return cpus([run], calls, seconds)[0]


def cpus(runs: list[Callable[[], object]], calls: int, seconds: float) -> list[float]:
    """The same of several, a few calls of each in turn, so that what else the machine does meets all of them."""
    for run in runs:
        run()
    best, since = [float("inf")] * len(runs), time.perf_counter()
    for _ in range(calls):
        for k, run in enumerate(runs):
            for _ in range(A_TURN):
                begun = time.process_time()
                run()
                best[k] = min(best[k], time.process_time() - begun)
        if time.perf_counter() - since > seconds:
            break
    return best


SINGLE = {
    "eomgen.simulator, by power series": (by_eomgen(method="taylor"), "eomgen"),
    "eomgen.simulator": (by_eomgen(), "eomgen"),
    "eomgen, by scipy (no compiler)": (by_eomgen("numpy"), "eomgen"),
    "eomgen, Python loop over compiled rates": (by_eomgen_in_python, "eomgen"),
    "scipy DOP853 + lambdify": (by_scipy, "scipy"),
    "CasADi + CVODES": (by_casadi, "casadi"),
    "diffrax Dopri8": (by_diffrax, "diffrax"),
    "heyoka Taylor": (by_heyoka, "heyoka"),
}


def single_rows() -> Iterator[str]:
    """Of each rival the least time for an error below ERROR, and that error."""
    exact, found = np.array(list(map(float, REFERENCE))), {}
    yield "| rival | tolerance of a step | error at 10 s | CPU [ms] | times the first |"
    yield "|---|---|---|---|---|"
    for name, (make, needs) in SINGLE.items():
        try:
            import_module(needs)
        except ImportError:
            found[name] = None
            continue
        for tolerance in TOLERANCES:
            run = make(tolerance)
            error = float(np.max(np.abs(run() - exact)))
            if error < found.get(name, (0, np.inf))[1]:
                found[name] = tolerance, error, run
            if error < ERROR:
                break
    there = {name: row for name, row in found.items() if row is not None}
    took = dict(zip(there, cpus([row[2] for row in there.values()], calls=40, seconds=120), strict=True))
    own = next(iter(took.values()))
    for name in found:
        if name not in there:
            yield f"| {name} | missing here | | | |"
        else:
            tolerance, error, _ = there[name]
            yield f"| {name} | {tolerance:.1e} | {error:.1e} | {1e3 * took[name]:.2f} | {took[name] / own:.2f} |"


def many_rows() -> Iterator[str]:
    """Many at once, one thread: of each rival the loosest tolerance with an error below 1e-5, against rtol 1e-13."""
    yield f"| {RUNS} double pendulums, 10 s | tolerance of a step | largest error | CPU [s] | times the first |"
    yield "|---|---|---|---|---|"
    finest = eomgen.simulator(MODELS / "double_pendulum.toml", rtol=1e-13, atol=1e-13)
    looked = starts(RUNS)[:: RUNS // 8]
    exact = np.array([finest(TIME, start={"theta1": x[0], "theta2": x[1]}, samples=2).x[-1] for x in looked])
    rivals = {
        "eomgen.simulate_many, by power series": (lambda tol, n: many_by_eomgen(tol, n, method="taylor"), "eomgen"),
        "eomgen.simulate_many": (many_by_eomgen, "eomgen"),
        "eomgen.simulator, one by one": (lambda tol, n: many_one_by_one(tol, n), "eomgen"),
        "diffrax vmap": (by_diffrax, "diffrax"),
        "heyoka batch of 8": (by_heyoka, "heyoka"),
    }
    found = {}
    for name, (make, needs) in rivals.items():
        try:
            import_module(needs)
        except ImportError:
            yield f"| {name} | missing here | | | |"
            continue
        for tolerance in (1e-9, 1e-10, 1e-11):
            run = make(tolerance, RUNS)
            apart = float(np.max(np.abs(run()[:: RUNS // 8] - exact)))
            if apart < 1e-5:
                break
        found[name] = tolerance, apart, run
    took = cpus([run for _, _, run in found.values()], calls=5, seconds=120)
    for (name, (tolerance, apart, _)), seconds in zip(found.items(), took, strict=True):
        yield f"| {name} | {tolerance:.0e} | {apart:.1e} | {seconds:.3f} | {seconds / took[0]:.2f} |"
    ten = many_by_eomgen(1e-10, 10_000, method="taylor")
    yield f"| eomgen.simulate_many, 10 000 of them, by power series | 1e-10 | | {cpu(ten, calls=2):.3f} | |"


def many_one_by_one(tolerance, runs):
    simulate = eomgen.simulator(MODELS / "double_pendulum.toml", rtol=10 * tolerance, atol=10 * tolerance)
    return lambda: np.array(
        [simulate(TIME, start={"theta1": x[0], "theta2": x[1]}, samples=SAMPLES).x[-1] for x in starts(runs)]
    )


FOUR_BAR = """
eomgen = 1
space = "plane"
coordinates = { a = { start = 1, speed = 4 }, b = 0.48, c = 1.57 }
bodies.crank = { shape = { kind = "rod", mass = 1, length = 0.4 }, joint = { kind = "revolute", angle = "a" } }
[bodies.coupler]
shape = { kind = "rod", mass = 2, length = 1 }
joint = { kind = "revolute", on = "crank.end", angle = "b - a" }
[bodies.rocker]
shape = { kind = "rod", mass = 1, length = 0.8 }
joint = { kind = "revolute", at = [1.1, 0], angle = "c" }
[constraints]
B = { kind = "pin", points = ["coupler.end", "rocker.end"] }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
"""


BLOCK = """
eomgen = 1
space = "plane"
coordinates.s = 0
bodies.block = { shape = { kind = "particle", mass = 2 }, joint = { kind = "placed", at = ["s", 0] } }
constraints.floor = { kind = "support", point = "block.center", normal = [0, 1], friction = 0.5 }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
push = { kind = "force", point = "block.center", force = ["11.772*sin(2*pi*t)", 0] }
"""


def own_rows() -> Iterator[str]:
    """Motions in C against the loop in Python that they replace."""
    yield "| motion, rtol 1e-9 | steps | in C [s] | Python loop [s] | times | drift | constraints open by |"
    yield "|---|---|---|---|---|---|---|"
    motions = {
        "arm of 7 axes, 10 s": (MODELS / "arm7.toml", 10.0, 1.0),
        "four-bar by multipliers, 1000 s": (eomgen.loads(FOUR_BAR), 1000.0, 0.02),
        "four-bar, dependent coordinates, 100 s": (MODELS / "four_bar.toml", 100.0, 0.1),
        "sliding ladder, 2 s": (MODELS / "sliding_ladder.toml", 2.0, 1.0),
        "block that sticks and slips, 10 s, 40 events": (eomgen.loads(BLOCK), 10.0, 0.2),
        "flyball governor (stiff), 10 s": (MODELS / "flyball_governor.toml", 10.0, 0.1),
    }
    for name, (model, seconds, share) in motions.items():
        simulate = eomgen.simulator(model, target="c")
        run = simulate(seconds)
        took = cpu(lambda s=simulate, t=seconds: s(t), calls=3)
        kept, integrator.COMPILED = integrator.COMPILED, ()
        slow = cpu(lambda s=simulate, t=seconds * share: s(t), calls=1) / share
        integrator.COMPILED = kept
        drift = "" if run.drift is None else f"{run.drift:.1e}"
        gap = "" if run.gap is None else f"{run.gap:.1e}"
        part = "" if share == 1 else f" (from {seconds * share:g} s)"
        yield f"| {name} | {run.steps} | {took:.4f} | {slow:.2f}{part} | {slow / took:.0f} | {drift} | {gap} |"


PENDULUM = """
eomgen = 1
space = "plane"
coordinates.theta = 2
bodies.rod = { shape = { kind = "rod", mass = 1, length = 1 }, joint = { kind = "revolute", angle = "theta - pi/2" } }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
"""


def long_rows() -> Iterator[str]:
    """A rod that swings from 2 rad, DOP853 with and without its energy kept, by the closed solution."""
    from mpmath import mp

    mp.dps = 30
    k, w = mp.sin(1), mp.sqrt(mp.mpf("14.715"))
    period = float(4 * mp.ellipk(k**2) / w)
    yield f"| 10^5 periods of {period:.4f} s | rtol | energy drift | angle off at the end | CPU [s] |"
    yield "|---|---|---|---|---|"
    end = round(1e5 * period)
    sn = mp.ellipfun("sn", w * end + mp.ellipk(k**2), k**2)
    exact = float(2 * mp.asin(k * sn))
    for way in ("projection", "energy"):
        for tolerance in (1e-6, 1e-9):
            simulate = eomgen.simulator(eomgen.loads(PENDULUM), rtol=tolerance, atol=tolerance, stabilization=way)
            begun = time.process_time()
            run = simulate(end, samples=3)
            took, off = time.process_time() - begun, abs(run["theta"][-1] - exact)
            yield f"| `{way}` | {tolerance:.0e} | {run.drift:.1e} | {off:.1e} | {took:.1f} |"


def command_rows() -> Iterator[str]:
    """The whole command, in units of `import sympy` in the same run."""

    def took(*words: str) -> float:
        before = sum(os.times()[2:4])
        subprocess.run([sys.executable, *words], check=True, capture_output=True)
        return sum(os.times()[2:4]) - before

    unit = min(took("-c", "import sympy") for _ in range(3))
    simulate = ("-m", "eomgen", "simulate", str(MODELS / "double_pendulum.toml"), "--time", "10")
    ratio = min(took(*simulate) for _ in range(2)) / unit
    yield f"`eomgen simulate models/double_pendulum.toml --time 10`, proof included: {ratio:.1f} times that CPU."


def peers() -> str:
    """The versions that ran."""
    found = []
    for name in ("numpy", "scipy", "sympy", "casadi", "diffrax", "jax", "heyoka"):
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"{name} missing")
    return ", ".join(found)


# -------- phases --------------------------------------------------------------------------------------------------


FALL, E = (2 * 1.0 / G) ** 0.5, 0.6  # of models/bouncing_ball.toml


def without(name: str) -> eomgen.Model:
    """The same model without its contacts."""
    text = (MODELS / f"{name}.toml").read_text(encoding="utf-8").split("[outputs]")[0]
    for pattern in (r", friction = \{[^}]*\}", r"\[constraints.*?\n\n", r"limits = .*\n", r"restitution = \"e\"\n"):
        text = re.sub(pattern, "", text, flags=re.S if "constraints" in pattern else 0)
    return eomgen.loads(text)


THROUGH_PHASES = {  # seconds, and of many runs what differs from run to run
    "stick_slip": (10.0, ("parameters", "v", 0.05, 0.2)),
    "bouncing_ball": (1.7, ("start", "y", 0.5, 1.5)),
    "pendulum_on_stop": (3.0, ("start", "q", 0.5, 1.5)),
}


def phase_rows() -> Iterator[str]:
    """Runs whose contacts change: in C, by the loop over phases in Python that it replaces, and the same model without
    its contacts."""
    yield "| motion, rtol 1e-9 | phases | in C [ms] | phases in Python | without contacts [ms] | times without |"
    yield "|---|---|---|---|---|---|"
    for name, (seconds, _) in THROUGH_PHASES.items():
        yield _phase_row(f"{name}, {seconds:g} s", MODELS / f"{name}.toml", without(name), seconds)
    free = re.sub(r"floor = .*\n", "", BLOCK.replace("constraints.floor", "floor"))
    yield _phase_row("block on a rough floor, 10 s", eomgen.loads(BLOCK), eomgen.loads(free), 10.0)


def _phase_row(words: str, model: object, free: object, seconds: float) -> str:
    simulate, plain = eomgen.simulator(model, target="c"), eomgen.simulator(free, target="c")
    phases = len(simulate(seconds).phases)
    took, alone = cpus([lambda: simulate(seconds), lambda: plain(seconds)], calls=20, seconds=10)
    kept, motion.compiled_phases = motion.compiled_phases, lambda *_: BorrowedPhases([], None)
    slow = cpu(lambda: simulate(seconds), calls=3)
    motion.compiled_phases = kept
    return (
        f"| {words} | {phases} | {1e3 * took:.2f} | {slow / took:.0f} times as long | {1e3 * alone:.2f} "
        f"| {took / alone:.1f} |"
    )


def phase_batches() -> Iterator[str]:
    """10 000 runs whose contacts change, one thread, beside 10 000 of the same model without contacts; of some of them
    the largest difference from the run alone."""
    yield "| 10 000 runs, rtol 1e-9 | CPU [s] | without contacts [s] | times | off the run alone |"
    yield "|---|---|---|---|---|"
    for name, (seconds, (kind, key, low, high)) in THROUGH_PHASES.items():
        values = np.linspace(low, high, 10_000)
        models = eomgen.load(MODELS / f"{name}.toml"), without(name)

        def run(model, seconds=seconds, kind=kind, key=key, values=values):
            return eomgen.simulate_many(model, time=seconds, **{kind: {key: values}})

        took, alone = cpus([lambda m=model: run(m) for model in models], calls=1, seconds=60)
        found, one, off = run(models[0]), eomgen.simulator(models[0]), 0.0
        for k in range(0, len(values), 2500):
            single = one(seconds, **{kind: {key: float(values[k])}}, samples=found.t.tolist())
            off = max(off, float(np.max(np.abs(found.x[k] - single.x))))
        yield f"| {name}, {seconds:g} s | {took:.3f} | {alone:.3f} | {took / alone:.1f} | {off:.0e} |"


def height(t: float) -> float:
    """y(t) of the bouncing ball, in closed form: flights of 2 e^k sqrt(2 h/g)."""
    begun, v = -FALL, G * FALL
    while begun + 2 * v / G <= t:
        begun, v = begun + 2 * v / G, E * v
    return v * (t - begun) - G / 2 * (t - begun) ** 2


def ball_rows() -> Iterator[str]:
    """The bouncing ball for 1.7 s beside MuJoCo, which takes fixed steps and pushes by springs and dampers: largest
    error of the height at 101 instants, against the closed form, and of the instant of the third impact. Its damping is
    tuned so that the first impact returns e."""
    instants = np.linspace(0, 1.7, 101)
    exact = np.array([height(t) for t in instants])
    third = FALL * (1 + 2 * E + 2 * E * E)
    yield "| rival | error of the height [m] | of the third impact [s] | CPU [ms] | times the first |"
    yield "|---|---|---|---|---|"
    simulate = eomgen.simulator(MODELS / "bouncing_ball.toml", target="c")
    run = simulate(1.7, samples=instants.tolist())
    first = cpu(lambda: simulate(1.7, samples=instants.tolist()), calls=20)
    errors = float(np.max(np.abs(run["y"] - exact))), abs(run.impacts[2].t - third)
    yield f"| eomgen.simulator, rtol 1e-9 | {errors[0]:.0e} | {errors[1]:.0e} | {1e3 * first:.2f} | 1.0 |"
    try:
        import mujoco
    except ImportError:
        yield "| MuJoCo | not installed here | | | |"
        return
    for step in (1e-3, 1e-4, 1e-5):
        found, impacts, took = _by_mujoco(mujoco, step, instants)
        errors = float(np.max(np.abs(found - exact))), abs(impacts[2] - third) if len(impacts) > 2 else np.nan
        yield (
            f"| MuJoCo {mujoco.__version__}, steps of {step:g} s | {errors[0]:.0e} | {errors[1]:.0e} "
            f"| {1e3 * took:.1f} | {took / first:.0f} |"
        )


def _by_mujoco(mujoco, step: float, instants: np.ndarray) -> tuple[np.ndarray, list[float], float]:
    """(heights, instants of impacts, CPU): a contact lasts some 15 steps, its damping is sought that returns e of the
    speed of the first impact."""
    low, high = 0.0, 1.0
    for _ in range(20):
        damping = (low + high) / 2
        low, high = (damping, high) if _returned(mujoco, step, damping) > E else (low, damping)
    model, data = _falling(mujoco, step, (low + high) / 2)
    found, impacts, begun = [], [], time.process_time()
    for t in instants:
        while data.time < t - step / 2:
            before = data.ncon
            mujoco.mj_step(model, data)
            if data.ncon and not before:
                impacts.append(data.time)
        found.append(1 + data.qpos[0])
    return np.array(found), impacts, time.process_time() - begun


def _falling(mujoco, step: float, damping: float):
    k = (0.2 / step) ** 2
    contact = f'solref="{-k} {-2 * damping * k**0.5}" solimp="0.9999 0.9999 0.001" condim="1"'
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option timestep="{step}" gravity="0 0 {-G}" integrator="RK4"/>
      <worldbody><geom type="plane" size="5 5 1" {contact}/><body pos="0 0 1"><joint type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.1" mass="0.5" pos="0 0 0.1" {contact}/></body></worldbody></mujoco>""")
    return model, mujoco.MjData(model)


def _returned(mujoco, step: float, damping: float) -> float:
    """The share of the speed with which the ball leaves its first contact."""
    model, data = _falling(mujoco, step, damping)
    data.qpos[0] = -0.99
    data.qvel[0] = -((2 * G * 0.99) ** 0.5)
    came = data.qvel[0]
    while data.ncon == 0 and data.time < 1:
        came = data.qvel[0]
        mujoco.mj_step(model, data)
    while data.ncon and data.time < 1:
        mujoco.mj_step(model, data)
    return -data.qvel[0] / came


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("-o", "--output", type=Path)
    words.add_argument("--reference", action="store_true")
    words.add_argument("--phases", action="store_true", help="only motions whose contacts change, put into the file")
    requested = words.parse_args()
    if requested.reference:
        import mpmath as mp

        for steps in (1000, 2000):
            print(steps, [mp.nstr(x, 32) for x in reference(steps)])
        return
    reported = (
        f"`python benchmarks/integration.py`; Python {platform.python_version()}, {platform.machine()}; {peers()}."
    )
    begun = ["# Integration against peers", "", f"{reported} CPU time, all in one run; trust the ratios.", ""]
    parts = (phase_rows, phase_batches, ball_rows)
    if requested.phases:
        kept = requested.output.read_text(encoding="utf-8") if requested.output else ""
        begun = [kept.partition(f"\n{PHASES}\n")[0].rstrip(), ""]
    else:
        begun += lines_of((single_rows, own_rows, many_rows, long_rows, command_rows))
    lines = [*begun, PHASES, "", f"{reported}", "", *lines_of(parts)]
    if requested.output:
        requested.output.write_text("\n".join(lines).rstrip() + "\n")


PHASES = "## Where contacts change"


def lines_of(sections: Sequence[Callable[[], Iterator[str]]]) -> list[str]:
    """Tables under what they show."""
    lines: list[str] = []
    for rows in sections:
        lines += [" ".join((rows.__doc__ or "").split()), ""]
        for row in rows():
            lines.append(row)
            print(row, flush=True)
        lines.append("")
    return lines


if __name__ == "__main__":
    main()
