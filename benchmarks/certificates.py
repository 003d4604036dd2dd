"""How the certificate of the equations grows with the model: python benchmarks/certificates.py [n ...]

Chains of n rods, CPU seconds of this process: the derivation, and its proof with the emitted numpy code. The exponent
is that of the proof's time from one n to the next; ratios of one run are to be trusted, seconds are the machine's.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from time import process_time

sys.path.insert(0, str(Path(__file__).parents[1] / "models"))

from chain import chain

import eomgen

SIZES = (25, 50, 100, 200)


def measured(text: str) -> tuple[float, float, bool | None]:
    """(seconds of the derivation, of the proof, whether it holds) of the text of a model."""
    model = eomgen.loads(text)
    start = process_time()
    equations = eomgen.derive(model)
    equations.rhs("numpy")
    derived = process_time()
    certificate = equations.certify("numpy")
    return derived - start, process_time() - derived, certificate.ok


def main(sizes: tuple[int, ...]) -> None:
    measured(chain(3))  # imports
    print("| rods | derivation and code [s] | proof [s] | exponent | holds |\n|---|---|---|---|---|")
    before: tuple[int, float] | None = None
    for n in sizes:
        derivation, proof, ok = measured(chain(n))
        exponent = "" if before is None else f"{math.log(proof / before[1]) / math.log(n / before[0]):.2f}"
        print(f"| {n} | {derivation:.2f} | {proof:.2f} | {exponent} | {ok} |", flush=True)
        before = n, proof


if __name__ == "__main__":
    main(tuple(map(int, sys.argv[1:])) or SIZES)
