"""How the certificate of the equations grows with the model: python benchmarks/certificates.py [n ...]

`python benchmarks/certificates.py models [FOLDER]`: CPU seconds of all proofs of the models of a folder (models/).
With the tree of another commit in PYTHONPATH, in turn with this one over the same folder, it gives a ratio.

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


def of_models(folder: Path) -> None:
    """CPU seconds of all proofs together, with the emitted numpy code, and how many hold."""
    total, proofs = 0.0, []
    for path in sorted(folder.rglob("*.toml")):
        try:
            equations = eomgen.derive(eomgen.load(path))
        except eomgen.EomgenError:  # structures without equations of motion
            continue
        equations.rhs("numpy")
        start = process_time()
        proofs.append(equations.certify("numpy").ok)
        total += process_time() - start
    print(f"{total:.2f} s: {len(proofs)} proofs, {sum(ok is True for ok in proofs)} hold")


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
    if sys.argv[1:2] == ["models"]:
        of_models(Path(sys.argv[2]) if sys.argv[2:] else Path(__file__).parents[1] / "models")
        sys.exit()
    main(tuple(map(int, sys.argv[1:])) or SIZES)
