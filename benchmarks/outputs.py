"""Everything that the verbs print, kept, and two such collections compared: what does a change of the house change?

    python benchmarks/outputs.py keep BEFORE              each verb, model and format: exit code, output, messages
    python benchmarks/outputs.py keep BEFORE --shard 2/8  an eighth; what BEFORE has already is passed over
    python benchmarks/outputs.py compare BEFORE AFTER     what differs, byte for byte, by its kind

`keep` is run in the tree whose output is asked for. A kind is the first line that differs, its numbers and names left
out; each is shown once, with how often it came. Exit code 1 where anything differs.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import runpy
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from difflib import SequenceMatcher
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
EVERY = ("text", "json")
SHOWN = ("text", "latex", "markdown", "json")
VERBS: dict[str, tuple[str, ...]] = {
    "check": EVERY,
    "derive": SHOWN,
    "derive --method kinetostatic": ("text",),
    "solve": SHOWN,
    "reactions": SHOWN,
    "statics": EVERY,
    "kinematics": EVERY,
    "inertia": EVERY,
    "linearize": SHOWN,
    "simulate --time 0.2": EVERY,
}
PATIENCE = 900  # s of CPU for one run
PASSING = re.compile(r"\d+(?:\.\d+)? (?:s|ms|MB)\b")  # what a clock says


def runs(models: list[Path]) -> Iterator[tuple[Path, str, str]]:
    return ((model, verb, form) for model in models for verb, forms in VERBS.items() for form in forms)


def name_of(model: Path, verb: str, form: str) -> str:
    stem = model.relative_to(ROOT / "models").with_suffix("").as_posix().replace("/", "+")
    return f"{stem}/{verb.replace(' --', '-').replace(' ', '-')}.{form}"


def outcome(words: list[str], cache: str) -> tuple[int, str, str]:
    """Exit code, output and messages of the command line, in a fork of this process; a signal as 128 + its number."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        if not (child := os.fork()):
            os.dup2(out.fileno(), 1)
            os.dup2(err.fileno(), 2)
            os.environ["XDG_CACHE_HOME"] = cache
            resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE))
            sys.argv = ["eomgen", *words]
            code = 0
            try:
                runpy.run_module("eomgen", run_name="__main__")
            except SystemExit as end:
                code = end.code if isinstance(end.code, int) else int(end.code is not None)
            finally:
                sys.stdout.flush()
                sys.stderr.flush()
                os._exit(code)
        _, status = os.waitpid(child, 0)
        code = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        return code if code >= 0 else 128 - code, out.read().decode(), err.read().decode()


def keep(folder: Path, models: list[Path], shard: tuple[int, int]) -> None:
    import mpmath
    import numpy
    import scipy.integrate
    import sympy

    assert mpmath and numpy and scipy.integrate and sympy  # loaded once: a run then is a fork
    os.chdir(ROOT)
    k, n = shard
    for model in models[k - 1 :: n]:
        with tempfile.TemporaryDirectory() as cache:
            for _, verb, form in runs([model]):
                path = folder / name_of(model, verb, form)
                if path.exists():
                    continue
                first, *options = verb.split()
                requested = [first, str(model.relative_to(ROOT)), *options, "--format", form, "--patience", "none"]
                code, out, err = outcome(requested, cache)
                if code == 2 and "no such option" in err.lower():
                    code, out, err = outcome(requested[:-2], cache)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(f"exit {code}\n{out}\n--- messages\n{err}", encoding="utf-8")
        print(f"{model.stem}", flush=True)


def first_difference(one: str, other: str) -> tuple[str, str]:
    """The first line of both that is another one; "" for none."""
    a, b = one.splitlines(), other.splitlines()
    for tag, i, j, k, m in SequenceMatcher(None, a, b, autojunk=False).get_opcodes():
        if tag != "equal":
            return (a[i] if j > i else ""), (b[k] if m > k else "")
    return "", ""


def kind_of(line: str) -> str:
    """A line without its numbers and names: what remains is the sentence."""
    return re.sub(r"[\w.]*\d[\w.]*|'[^']*'|\"[^\"]*\"|\b\w\b", "#", line)[:100]


def compare(before: Path, after: Path) -> int:
    kinds: dict[tuple[str, str, str], list[tuple[str, str, str]]] = defaultdict(list)
    same = 0
    names = sorted({str(p.relative_to(f)) for f in (before, after) for p in f.rglob("*.*") if p.is_file()})
    for name in names:
        if not ((before / name).exists() and (after / name).exists()):
            kinds["only in one", "", ""].append((name, "", ""))
            continue
        one, other = (PASSING.sub("#", (f / name).read_text(encoding="utf-8")) for f in (before, after))
        if one == other:
            same += 1
            continue
        a, b = first_difference(one, other)
        kinds[Path(name).name, kind_of(a), kind_of(b)].append((name, a, b))
    print(f"{len(names)} outputs, {same} the same, {len(names) - same} in {len(kinds)} kinds")
    for _, mine in sorted(kinds.items(), key=lambda each: -len(each[1])):
        name, a, b = mine[0]
        print(f"\n{len(mine)} x  {name}\n  - {a[:240]}\n  + {b[:240]}")
    return int(same < len(names))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("what", choices=("keep", "compare"))
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--models", default="**/*", help="a pattern below models/")
    parser.add_argument("--shard", default="1/1", help="K/N: each Nth model, from the Kth")
    options = parser.parse_args()
    if options.what == "compare":
        return compare(*options.folders)
    models = sorted((ROOT / "models").glob(f"{options.models}.toml"))
    k, n = map(int, options.shard.split("/"))
    keep(options.folders[0].resolve(), models, (k, n))
    return 0


if __name__ == "__main__":
    sys.exit(main())
