"""More of the same than a test run has time for: `python tests/fuzz/long_run.py --expressions 1000000 --files 100000`.

What breaks a law is written into a folder, its law first, as in `regressions/`; figures are rows of docs/fuzzing.md.
"""

from __future__ import annotations

import argparse
import shlex
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from datetime import date
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

import fuzzed_expressions
import fuzzed_verbs
import mutated_models

Try = Callable[[Random], tuple[str, str, str]]
"""a random source -> (what was run, its text, the law that it broke or "")"""


def an_expression(rng: Random) -> tuple[str, str, str]:
    text, tree = fuzzed_expressions.one(rng)
    return "expression", text, fuzzed_expressions.broken_law(text, tree)


def a_file(rng: Random) -> tuple[str, str, str]:
    text = mutated_models.mutated(rng)
    return "load", text, mutated_models.broken_law(text)


def a_verb(rng: Random) -> tuple[str, str, str]:
    text = mutated_models.loadable(rng, fuzzed_verbs.LONGEST)
    words = fuzzed_verbs.words(text, rng)
    with tempfile.TemporaryDirectory() as folder:
        return shlex.join(words), text, fuzzed_verbs.broken_law(text, words, Path(folder))


def searched(what: str, one: Try, count: int, seed: int, folder: Path) -> str:
    """A row of the table: how many, their CPU, and how many kinds of finds, each written once."""
    found: dict[str, int] = {}
    begun = time.process_time()
    for k in range(count):
        command, text, law = one(Random(f"{what} {seed} {k}"))
        if not law:
            continue
        kind = fuzzed_verbs.shape_of(law)
        found[kind] = found.get(kind, 0) + 1
        if found[kind] == 1:
            head = f"# law: {' '.join(law.split())}\n# run: {command}\n"
            (folder / f"{what}_{seed}_{k}.toml").write_bytes((head + text).encode("utf-8", "surrogatepass"))
    seconds = time.process_time() - begun
    reported = f"{sum(found.values())} of {len(found)} kinds" if found else "none"
    return f"| {date.today()} | {count} {what} | {seed} | {seconds:.0f} s | {reported} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    tries: dict[str, Try] = {"expressions": an_expression, "files": a_file, "verbs": a_verb}
    for what in tries:
        parser.add_argument(f"--{what}", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--finds", type=Path, default=Path(tempfile.gettempdir()) / "eomgen-finds")
    requested = parser.parse_args()
    requested.finds.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore")
    for what, one in tries.items():
        if count := getattr(requested, what):
            print(searched(what, one, count, requested.seed, requested.finds), flush=True)


if __name__ == "__main__":
    main()
