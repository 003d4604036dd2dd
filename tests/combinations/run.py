"""The combinations, by a command: models of a covering array against the oracle, and through verbs, formats and doors.

    python tests/combinations/run.py --shard 3/40 --out DIR     one shard; what is in DIR already is passed over
    python tests/combinations/run.py --level screw --most 9 --out DIR  nine models that hold a level, as a new kind
    python tests/combinations/run.py --structures 20 --out DIR  structures at rest, so many of each kind
    python tests/combinations/run.py --totals --out DIR         what all shards found

One line of JSON a model is written into DIR/shard_K_of_N_SEED.jsonl, and each model that shows a fault beside it.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from random import Random
from typing import Any

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "helpers"), str(HERE.parents[1])]
os.environ.setdefault("EOMGEN_FRESH", "1")
os.environ.setdefault("EOMGEN_PATIENCE", "none")

import calls  # noqa: E402
import compare  # noqa: E402
import cross  # noqa: E402
import structures  # noqa: E402
from covering import rows, rows_with  # noqa: E402
from drawn import text_of  # noqa: E402
from features import FACTORS, all_pairs, pairs_of, possible_pairs, why_not  # noqa: E402
from refusals import lacking  # noqa: E402
from shared import one_model  # noqa: E402

import eomgen  # noqa: E402
from eomgen.cli_common import problems_of  # noqa: E402

LANGUAGES = ((), ("c",), ("javascript",))


def seed_of(levels: dict[str, str]) -> int:
    return sum(map(ord, "".join(levels.values())))


def of_model(levels: dict[str, str], seed: int, *, through_verbs: bool = True) -> dict[str, Any]:
    """All that one model shows: its faults, its calls, and whether it covers its pairs."""
    with one_model():
        return _of_model(text_of(levels, seed), levels, seed, through_verbs)


def _of_model(text: str, levels: dict[str, str], seed: int, through_verbs: bool) -> dict[str, Any]:
    begin = time.process_time()
    row: dict[str, Any] = {
        "levels": levels,
        "seed": seed,
        "faults": [],
        "refused": "",
        "numbers": 0,
        "skipped": [],
        "calls": [],
    }
    try:
        with calls.limit(120):
            product = compare.product_of(text)
            found = compare.against(product, seed)
        if through_verbs:
            with calls.limit(120):
                reported = cross.across(product, languages=LANGUAGES[seed_of(levels) % 3])
            row["calls"] += [[f"python {call}", 0, 0.0, ""] for call in ("solve", "reactions", "simulate", "linearize")]
            found.numbers += reported.numbers
            found.faults += reported.faults
            found.skipped += reported.skipped
        row["numbers"], row["skipped"] = found.numbers, found.skipped
        row["calls"] += [[f"python {call}", 0, 0.0, ""] for call in ("derive", "rhs", "reaction_rhs")]
        row["faults"] += [["oracle: " + kind, what] for kind, what in found.faults[:5]]
    except eomgen.EomgenError as no:
        row["refused"] = f"{type(no).__name__}: {str(no).splitlines()[0][:200]}"
        left = lacking(problems_of(no), text)
        row["faults"] += [["refusal", f"{left}: {row['refused']}"]] if left else []
    except calls.TooLong:
        row["faults"].append(["slow", "derive and the comparison take more than 120 s"])
    except Exception as error:
        row["faults"].append(["internal error", f"{type(error).__name__}: {str(error)[:200]}"])
    outcomes: list[calls.Outcome] = []
    if through_verbs:
        rng = Random(f"calls{sorted(levels.items())}{seed}")
        with tempfile.TemporaryDirectory() as folder:
            outcomes += [
                calls.by_command(text, words, Path(folder)) for words in calls.commands(text, rng, every_format=True)
            ]
        outcomes += calls.by_python(text, calls.python_doors(rng))
        if not row["refused"] and rng.random() < 0.3:
            outcomes += calls.judged(text, rng)
            outcomes += calls.small_motions_judged(text)
    row["calls"] += [[o.call, o.code, round(o.seconds, 2), o.note] for o in outcomes]
    row["faults"] += [[o.fault, f"{o.call}: {o.detail}"] for o in outcomes if o.fault]
    row["covers"] = not row["refused"]
    row["seconds"] = round(time.process_time() - begin, 1)
    return row


def shard(number: int, count: int, seed: int, out: Path, *, most: int | None, alone: bool) -> None:
    """The models number, number + count, ... of the array of a seed; those in the ledger are passed over."""
    out.mkdir(parents=True, exist_ok=True)
    ledger = out / f"{'oracle' if alone else 'shard'}_{number}_of_{count}_{seed}.jsonl"
    done = {json.loads(line)["index"] for line in ledger.read_text().splitlines()} if ledger.exists() else set()
    made = 0
    for index, levels in enumerate(rows(seed)):
        if index % count != number - 1 or index in done:
            continue
        if most is not None and made >= most:
            return
        written(ledger, levels, seed, alone=alone, index=index)
        made += 1


def written(ledger: Path, levels: dict[str, str], seed: int, *, alone: bool, index: int) -> dict[str, Any]:
    """A model's line, in the ledger; beside it the model, if it shows a fault."""
    row = {"index": index, "array": seed, **of_model(levels, seed, through_verbs=not alone)}
    if row["faults"]:
        (ledger.parent / f"model_{ledger.stem}_{index}.toml").write_text(text_of(levels, seed))
    with ledger.open("a") as file:
        file.write(json.dumps(row) + "\n")
    return row


def of_level(level: str, seed: int, out: Path, *, most: int, alone: bool) -> None:
    """So many models that hold a level, each in a line: what was compared, and what was found."""
    known = [x for levels in FACTORS.values() for x in levels]
    if level not in known:
        sys.exit(f"there is no level '{level}': features.py has {', '.join(sorted({*known}))}")
    out.mkdir(parents=True, exist_ok=True)
    for index, levels in enumerate(itertools.islice(rows_with(level, seed), most)):
        row = written(out / f"level_{level}_{seed}.jsonl", levels, seed + index, alone=alone, index=index)
        found = row["refused"] or f"{row['numbers']} numbers, {len(row['calls'])} calls"
        print(f"{index}: {found}; faults: {row['faults'] or 'none'}", flush=True)


def at_rest(count: int, seed: int, out: Path) -> None:
    """Structures without coordinates, `count` of each kind, by the balance of their bodies."""
    out.mkdir(parents=True, exist_ok=True)
    with (out / f"structures_{seed}.jsonl").open("w") as file:
        for kind, number in itertools.product(structures.KINDS, range(count)):
            begin = time.process_time()
            text = structures.structure(kind, Random(f"{kind}{seed}{number}"))
            row: dict[str, Any] = {"kind": kind, "number": number, "numbers": 0, "faults": [], "refused": ""}
            try:
                with calls.limit(60):
                    found = structures.compared(text)
                row["numbers"], row["faults"] = found.numbers, [[f"structure: {k}", x] for k, x in found.faults[:5]]
            except (eomgen.EomgenError, structures.NoAnswer) as no:
                row["refused"] = str(no).splitlines()[0][:200]
            except calls.TooLong:
                row["faults"].append(["slow", "a structure takes more than 60 s"])
            except Exception as error:
                row["faults"].append(["internal error", f"{type(error).__name__}: {str(error)[:200]}"])
            if row["faults"]:
                (out / f"structure_{seed}_{kind}_{number}.toml").write_text(text)
            file.write(json.dumps({**row, "seconds": round(time.process_time() - begin, 2)}) + "\n")


def totals(out: Path) -> dict[str, Any]:
    """Over all shards: models, calls, pairs covered of those that can be, faults by kind, the slowest calls."""
    ledgers = sorted(out.glob("oracle_*.jsonl")) + sorted(out.glob("shard_*.jsonl"))
    every = [json.loads(x) for path in ledgers for x in path.read_text().splitlines()]
    lines = list({(row["array"], row["index"]): row for row in every}.values())  # with calls before without
    covered: set = set()
    for row in lines:
        if row["covers"]:
            covered |= pairs_of(row["levels"])
    resting = [json.loads(x) for path in out.glob("structures_*.jsonl") for x in path.read_text().splitlines()]
    faults = Counter(kind for row in [*lines, *resting] for kind, _ in row["faults"])
    slow = sorted((c[2], c[0], row["array"], row["index"]) for row in lines for c in row["calls"] if c[2] > calls.SLOW)
    return {
        "models": len(lines),
        "refused": sum(bool(row["refused"]) for row in lines),
        "calls": sum(len(row["calls"]) for row in lines),
        "numbers against the oracle": sum(row["numbers"] for row in lines),
        "structures": len(resting),
        "of them refused": sum(bool(row["refused"]) for row in resting),
        "their numbers against the balance": sum(row["numbers"] for row in resting),
        "pairs covered": len(covered & possible_pairs()),
        "pairs that can be": len(possible_pairs()),
        "pairs that cannot be": sum(bool(why_not(*pair)) for pair in all_pairs()),
        "models with faults": sum(bool(row["faults"]) for row in lines),
        "faults": dict(faults.most_common()),
        "lines of derive judged": sum(c[0] == "verify" for r in lines for c in r["calls"]),
        "unread lines": sum(
            c[0] == "verify" and "wrong" not in c[3] and "right" not in c[3] for r in lines for c in r["calls"]
        ),
        "calls above 8 s": slow[::-1],
        "CPU seconds": round(sum(row["seconds"] for row in lines)),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shard", default="1/1", help="K/N: the K-th of N shards")
    parser.add_argument("--seed", type=int, default=1, help="of the covering array and its numbers")
    parser.add_argument("--out", type=Path, required=True, help="the folder of the ledgers")
    parser.add_argument("--most", type=int, help="at most so many models now")
    parser.add_argument("--level", help="only models that hold this level of a factor")
    parser.add_argument("--alone", action="store_true", help="the oracle alone, without verbs: a fifth of the time")
    parser.add_argument("--structures", type=int, help="so many structures at rest of each kind")
    parser.add_argument("--totals", action="store_true", help="tell what is in the ledgers")
    given = parser.parse_args()
    if given.totals:
        print(json.dumps(totals(given.out), indent=1))
        return
    if given.structures:
        at_rest(given.structures, given.seed, given.out)
        return
    if given.level:
        of_level(given.level, given.seed, given.out, most=given.most or 10, alone=given.alone)
        return
    number, count = map(int, given.shard.split("/"))
    shard(number, count, given.seed, given.out, most=given.most, alone=given.alone)


if __name__ == "__main__":
    main()
