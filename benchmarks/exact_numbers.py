"""Exact numbers in Python and compiled: fractions, quicktions, python-flint, on numbers and polynomials of derivations.

python benchmarks/exact_numbers.py          each library in one run; one that is not installed is left out
Figures: exact_numbers.md
"""

from __future__ import annotations

import random
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from importlib import import_module
from pathlib import Path
from time import process_time

MODELS = Path(__file__).parent.parent / "models"
WORK = ("arm7.toml", "stewart_platform.toml", "whipple_bicycle.toml", "chain20.toml")
DERIVE = """
import sys
if sys.argv.pop(1) == "fractions":
    sys.modules["quicktions"] = None
from eomgen.cli import main
main()
"""


def seconds(work: Callable[[], object], rounds: int = 3) -> float:
    """The least CPU time of a few rounds."""
    found = []
    for _ in range(rounds):
        begin = process_time()
        work()
        found.append(process_time() - begin)
    return min(found)


def rationals() -> dict[str, Callable[[int, int], object]]:
    """The kinds of rational that are installed."""
    kinds: dict[str, Callable[[int, int], object]] = {"fractions": Fraction}
    for module, name in (("quicktions", "Fraction"), ("flint", "fmpq")):
        try:
            kinds[module] = getattr(import_module(module), name)
        except ImportError:
            continue
    return kinds


def sums_of_products(kind: Callable[[int, int], object]) -> Callable[[], object]:
    """a += b c over numbers like those of sums of terms."""
    rng = random.Random(1)
    numbers = [kind(rng.randint(-400, 400), rng.choice((1, 2, 3, 4, 12, 25, 400))) for _ in range(2000)]

    def work() -> object:
        total = kind(0, 1)
        for k in range(20_000):
            total += numbers[k % 1999] * numbers[k * 7 % 1997] if k % 50 else -total
        return total

    return work


def polynomials() -> dict[str, tuple[object, object, object]]:
    """Three polynomials f, g, h of 6 variables, of each library."""
    from sympy.polys.domains import QQ
    from sympy.polys.rings import ring

    rng = random.Random(2)
    terms = [
        {tuple(rng.choice((0, 0, 0, 1, 1, 2)) for _ in range(6)): rng.randint(1, 9) for _ in range(9)} for _ in "fgh"
    ]
    R, *_ = ring([f"x{k}" for k in range(6)], QQ)
    found: dict[str, tuple[object, object, object]] = {
        "sympy": tuple(R.from_dict({k: QQ(c) for k, c in f.items()}) for f in terms)
    }
    try:
        from flint import Ordering, fmpq_mpoly_ctx
    except ImportError:
        return found
    context = fmpq_mpoly_ctx.get([f"x{k}" for k in range(6)], Ordering.lex)
    return found | {"flint": tuple(context.from_dict(f) for f in terms)}


def of_polynomials(f, g, h) -> dict[str, Callable[[], object]]:
    fg, gh = f * g, g * h
    factors = "factor" if hasattr(fg, "factor") else "factor_list"
    return {"product": lambda: fg * gh, "gcd": lambda: fg.gcd(gh), "factors": getattr(fg, factors)}


def derived(kind: str, model: str) -> tuple[float, str]:
    """(user CPU time of `eomgen derive`, what it prints)."""
    import resource

    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    command = [sys.executable, "-c", DERIVE, kind, "derive", str(MODELS / model), "--no-certify"]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, text


def main() -> None:
    for name, kind in rationals().items():
        print(f"20 000 sums of products, {name:10} {seconds(sums_of_products(kind)) * 1e3:8.1f} ms")
    for name, (f, g, h) in polynomials().items():
        for what, work in of_polynomials(f, g, h).items():
            print(f"{what:8} of polynomials, {name:10} {seconds(work) * 1e3:10.3f} ms")
    for model in WORK:
        (plain, text), (compiled, same) = derived("fractions", model), derived("quicktions", model)
        equal = "same text" if text == same else "ANOTHER TEXT"
        print(f"derive {model:22} fractions {plain:5.2f} s, quicktions {compiled:5.2f} s, {equal}")


if __name__ == "__main__":
    main()
