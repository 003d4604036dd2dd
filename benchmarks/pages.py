"""How large the page of each model is, and what it takes: python benchmarks/pages.py [NAME...].

The limits: 700 KB in space, 400 KB in the plane; CPU is that of `report` without its imports.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from eomgen.errors import EomgenError
from eomgen.model.reader import model_at
from eomgen.page.report import report

MODELS = Path(__file__).parent.parent / "models"
LIMITS = {"space": 700, "plane": 400}  # KB


def main(names: list[str]) -> int:
    """A line a model; how many are over their limit."""
    over = 0
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder, "page.html")
        for path in [MODELS / f"{name}.toml" for name in names] or sorted(MODELS.glob("*.toml")):
            began = time.process_time()
            try:
                report(path, page)
            except EomgenError as error:
                print(f"{path.stem:24}         {error.what}", flush=True)
                continue
            took, size, limit = time.process_time() - began, page.stat().st_size / 1000, LIMITS[model_at(path).space]
            over += size > limit
            print(f"{path.stem:24} {size:5.0f} KB {took:6.1f} s{'  too large' * (size > limit)}", flush=True)
    return over


if __name__ == "__main__":
    sys.exit(bool(main(sys.argv[1:])))
