"""How long a page takes for a whole rerun, by its own performance.now(): what one waits for when a slider is moved.

python benchmarks/player.py [MODEL ...]: of each model the smallest and the median of 60 reruns of 10 s in a headless
browser, at rtol 1e-6 and at the 1e-8 that pages ask for: the numbers alone (start, run, kept constraints), and all of
it with
picture, plots and energy. No test: machines differ.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tests" / "helpers"))

from browser import visited  # noqa: E402

import eomgen  # noqa: E402
from eomgen.symbolic.numeric import tolerances  # noqa: E402

MODELS = ("four_bar", "double_pendulum", "cart_pole", "trifilar_pendulum")
SCRIPT = """
    const name = eomgen.names[0], first = eomgen.state(0)[0], took = [];
    for (let k = 0; k < 60; k++) {
        const began = performance.now();
        eomgen.set(name, first + 0.005*k);
        took.push([eomgen.took, performance.now() - began]);
    }
    return [0, 1].map(i => took.map(each => each[i]).sort((a, b) => a - b));
"""


REQUESTED = f'"rtol":{tolerances.CARRIED}'  # as a page says it


def main(names: tuple[str, ...]) -> None:
    """Two lines a model."""
    print(f"{'model':<24}{'rtol':>7}{'numbers: smallest, median [ms]':>32}{'all: smallest, median [ms]':>29}")
    for name in names:
        page = eomgen.play(ROOT / "models" / f"{name}.toml", time=10).html
        assert page.count(REQUESTED) == 1
        for rtol in (1e-6, tolerances.CARRIED):
            columns = visited(page.replace(REQUESTED, f'"rtol":{rtol}'), SCRIPT).found
            reported = "".join(f"{took[0]:>{16}.1f}{took[len(took) // 2]:>14.1f}" for took in columns)
            print(f"{name:<24}{rtol:>7g}{reported}")


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or MODELS)
