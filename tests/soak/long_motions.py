"""Motions of many events, chaotic and stiff ones, beside what is known of them by hand; as long as `--length` says.

`python tests/soak/long_motions.py stick_slip --length 10000`
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from mpmath.ctx_mp import MPContext
from scipy.optimize import brentq

import eomgen

AT_ONCE = 200  # periods of one run by default, which begins where the one before it ended
G = 9.81

PUSHED = """
eomgen = 1
name = "Block on a rough floor, pushed to and fro"
space = "plane"
parameters = { m = 2, mu = 0.5, g = 9.81, F = 11.772 }     # 1.2 mu m g
coordinates = { s = { start = 0 } }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["s", 0] }
[constraints]
floor = { kind = "support", point = "block.center", normal = [0, 1], friction = "mu" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
push = { kind = "force", point = "block.center", force = ["F*sin(2*pi*t)", 0] }
"""

SHAKEN = """
eomgen = 1
name = "Particle on a shaken table"
space = "plane"
parameters = { m = 1, g = 9.81, A = { value = "3/2*g/(2*pi)^2" } }
coordinates = { z = { motion = "A*sin(2*pi*t)" }, y = { start = 0, speed = "2*pi*A" } }
[bodies.table]
shape = { kind = "rod", mass = 0, length = 1 }
line = ["start", "end"]
joint = { kind = "placed", at = [0, "z"] }
[bodies.ball]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = [0, "y"] }
[constraints]
floor = { kind = "slider", point = "ball.center", on = "table", unilateral = true }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
"""

PENDULA = """
eomgen = 1
name = "Double pendulum of two points"
space = "plane"
coordinates = { a = { start = 2 }, b = { start = 1 } }
[bodies]
upper = { points = { end = [1, 0] }, joint = { kind = "revolute", angle = "a - pi/2" } }
first = { shape = { kind = "particle", mass = 1 }, joint = { kind = "fixed", on = "upper.end" } }
lower = { points = { end = [1, 0] }, joint = { kind = "revolute", on = "upper.end", angle = "b - a" } }
second = { shape = { kind = "particle", mass = 1 }, joint = { kind = "fixed", on = "lower.end" } }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
"""

STIFF = """
eomgen = 1
name = "Mass in thick oil, drawn to and fro by a spring"
space = "plane"
parameters = { m = 1, c = 1e6, k = 1e6 }
coordinates = { x = { start = 0.3 } }
[bodies.mass]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", 0] }
[forces]
spring = { kind = "force", point = "mass.center", force = ["-k*(x - sin(2*pi*t)) - c*x'", 0] }
"""


def _runs(text: str, periods: int, at_once: int) -> Iterator[Any]:
    """Runs of whole periods, each from where the one before it ended."""
    model, start = eomgen.loads(text), dict[str, float]()
    while periods > 0:
        whole = min(periods, at_once)
        run = eomgen.simulate(model, time=whole, start=start, samples=[0.0, float(whole)])
        assert run.status == "finished", run.message
        yield run
        names = (*run.coordinates, *run.speeds)
        driven = {name for name, part in model.coordinates.items() if part.driven}
        start = {n: x for n, x in zip(names, run.x[-1].tolist(), strict=True) if n.removesuffix("'") not in driven}
        start |= {"y": start["y"] - float(run["z"][-1])} if "z" in driven else {}  # z is integrated, and begins anew
        periods -= whole


def _ends(runs: Iterator[Any], expected: np.ndarray) -> tuple[int, float, Any]:
    """(phases that ended, the farthest of an instant from those expected of each period, the last run)."""
    count, worst, run = 0, 0.0, None
    for run in runs:
        ends = np.array([phase.end for phase in run.phases[:-1]])
        off = [np.min(np.abs(t % 1.0 - expected)) for t in ends]
        worst, count = max(worst, *off), count + len(ends)
        whole = len(expected) * round(run.t[-1])
        assert len(ends) == whole, f"{len(ends)} phases for {whole}"
    return count, float(worst), run


def stick_slip(events: int, at_once: int = AT_ONCE) -> str:
    """It slips where 1.2 sin wt = 1, and sticks again where 1.2 (cos wt_1 - cos wt) = w (t - t_1); then to the left."""
    w = 2 * math.pi
    begun = math.asin(1 / 1.2) / w
    ended = brentq(lambda t: 1.2 * (math.cos(w * begun) - math.cos(w * t)) - w * (t - begun), 0.25, 0.5, xtol=1e-15)
    count, worst, run = _ends(
        _runs(PUSHED, -(-events // 4), at_once), np.array([begun, ended, begun + 0.5, ended + 0.5])
    )
    return f"{count} events, instants off by {worst:.1e} s, block off by {abs(run['s'][-1]):.1e} m"


def impacts(events: int, at_once: int = AT_ONCE) -> str:
    """It leaves where 3/2 sin wt = 1 and lands, without rebound, where the parabola meets the table."""
    w, A = 2 * math.pi, 1.5 * G / (2 * math.pi) ** 2
    off = math.asin(2 / 3) / w
    y, v = A * math.sin(w * off), A * w * math.cos(w * off)
    fall = brentq(lambda s: y + v * s - G * s * s / 2 - A * math.sin(w * (off + s)), 0.1, 1.0, xtol=1e-15)
    count, worst, run = _ends(_runs(SHAKEN, -(-events // 2), at_once), np.array([off, (off + fall) % 1.0]))
    off_by = ", ".join(f"{what} off by {abs(run[name][-1]):.1e} m" for what, name in (("ball", "y"), ("table", "z")))
    return f"{count} events, instants off by {worst:.1e} s, {off_by}"


def chaos(seconds: float) -> str:
    """Two points on strings of 1 m, 1 kg each, by Taylor's series with 30 digits; E = T + V stays.

    What a double rounds grows by e^(L t): it is told to when the angle is that of the series, to 1e-9, 1e-6, 1e-3 rad.
    """
    mp = MPContext()
    mp.dps = 30

    def rate(_: Any, x: list[Any]) -> list[Any]:
        a, b, u, v = x
        c, s = mp.cos(a - b), mp.sin(a - b)
        first, second = -s * v * v - 2 * mp.mpf("9.81") * mp.sin(a), s * u * u - mp.mpf("9.81") * mp.sin(b)
        return [u, v, (first - c * second) / (2 - c * c), (2 * second - c * first) / (2 - c * c)]

    exact = mp.odefun(rate, 0, [mp.mpf(2), mp.mpf(1), mp.mpf(0), mp.mpf(0)])
    times = np.linspace(0, seconds, max(5, round(4 * seconds) + 1))
    run = eomgen.simulate(eomgen.loads(PENDULA), time=seconds, samples=times, rtol=1e-13, atol=1e-13)
    pairs = zip(times[1:].tolist(), run["b"][1:].tolist(), strict=True)
    off = np.array([abs(float(mp.mpf(x) - exact(mp.mpf(t))[1])) for t, x in pairs])
    within = {size: np.flatnonzero(off > size) for size in (1e-9, 1e-6, 1e-3)}
    held = ", ".join(f"{size:g} rad to {times[late[0]]:g} s" for size, late in within.items() if len(late))
    worst = np.max(off[: within[1e-9][0]] if len(within[1e-9]) else off)
    reported = f"within {held}; the end is {off[-1]:.0e} rad off" if held else "so to its end"
    return f"angle off by {worst:.1e}, {reported}; energy drift {run.drift:.1e}, {run.steps} steps"


def stiffness(seconds: float) -> str:
    """m x'' + c x' + k (x - sin wt) = 0: x = Im(X e^(iwt)) + sum of A_n e^(s_n t), s_1 = -1, s_2 = -1e6."""
    m, c, k, w = 1.0, 1e6, 1e6, 2 * math.pi
    X = k / complex(k - m * w * w, c * w)
    fast = (-c - math.sqrt(c * c - 4 * m * k)) / (2 * m)
    slow = k / (m * fast)
    left = np.array([0.3 - X.imag, -w * X.real])
    A = np.linalg.solve(np.array([[1.0, 1.0], [slow, fast]]), left)
    run = eomgen.simulate(eomgen.loads(STIFF), time=seconds, method="Radau", rtol=1e-8, atol=1e-10)
    exact = (X * np.exp(1j * w * run.t)).imag + A[0] * np.exp(slow * run.t) + A[1] * np.exp(fast * run.t)
    return f"{run.status}: off by {np.max(np.abs(run['x'] - exact)):.1e} m in {run.steps} steps"


ALL: tuple[Callable[..., str], ...] = (stick_slip, impacts, chaos, stiffness)


def peak() -> str:
    """The largest memory so far, where the system tells."""
    try:
        import resource
    except ImportError:
        return "not told here"
    return f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("motion", choices=[one.__name__ for one in ALL])
    parser.add_argument("--length", type=float, default=100.0, help="events, or seconds of chaos and stiffness")
    parser.add_argument("--at-once", type=int, default=AT_ONCE, help="periods of one run, of events")
    requested = parser.parse_args()
    one = next(one for one in ALL if one.__name__ == requested.motion)
    begun, soon = (
        time.process_time(),
        min(requested.length, 1000.0) if one in (stick_slip, impacts) else requested.length,
    )
    before = (one(int(soon)), peak()) if soon < requested.length else ("", "")
    reported = one(int(requested.length), requested.at_once) if one in (stick_slip, impacts) else one(requested.length)
    memory = f"memory {before[1]} after {soon:g}, {peak()} after all" if before[1] else f"memory {peak()}"
    print(f"{requested.motion} {requested.length:g}: {reported}; {memory}; {time.process_time() - begun:.0f} s of CPU")


if __name__ == "__main__":
    main()
