"""How long a page takes for a whole rerun, by its own performance.now(): what one waits for when a slider is moved.

python benchmarks/player.py [MODEL ...]: of each model the smallest and the median of 20 reruns of 10 s at rtol 1e-8,
in a headless browser. On an idle machine a four-bar takes less than 30 ms. No test: machines differ.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tests" / "helpers"))

from browser import visited  # noqa: E402

import eomgen  # noqa: E402

MODELS = ("four_bar", "double_pendulum", "cart_pole", "trifilar_pendulum")
SCRIPT = """
    const name = eomgen.names[0], first = eomgen.state(0)[0], took = [];
    for (let k = 0; k < 20; k++) { eomgen.set(name, first + 0.01*k); took.push(eomgen.took); }
    return took.sort((a, b) => a - b);
"""


def main(names: tuple[str, ...]) -> None:
    """A line a model."""
    print(f"{'model':<24}{'smallest [ms]':>14}{'median [ms]':>13}")
    for name in names:
        page = eomgen.play(ROOT / "models" / f"{name}.toml", time=10).html
        took = visited(page, SCRIPT).found
        print(f"{name:<24}{took[0]:>14.1f}{took[len(took) // 2]:>13.1f}")


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or MODELS)
