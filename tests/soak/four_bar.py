"""A four-bar runs for long: `python tests/soak/four_bar.py --time 1000`; constraints and energy are measured, not
believed.

What is asked in the end is 1e6 s; a run of it takes as many times longer as it is longer.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import eomgen

MODEL = Path(__file__).parents[2] / "models" / "four_bar.toml"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--time", type=float, default=100.0)
    requested = parser.parse_args()
    begun = time.process_time()
    run = eomgen.simulate(MODEL, time=requested.time, samples=101)
    drift = "none is kept" if run.drift is None else f"{run.drift:.1e}"
    gap = "none" if run.gap is None else f"{run.gap:.1e}"
    seconds = time.process_time() - begun
    print(f"{run.status} at {run.t[-1]:g} s, {run.steps} steps, {seconds:.0f} s of CPU: energy {drift}, gaps {gap}")


if __name__ == "__main__":
    main()
