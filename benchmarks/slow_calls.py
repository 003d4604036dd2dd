"""Which calls take long: python benchmarks/slow_calls.py [verb ...]

Every model in models/ with each verb, each call in a process of its own that has everything imported; CPU seconds of
that process and of what it starts (compilers among them). Printed: each call above LIMIT, and how all of them lie.
Nothing is told again that was derived before. `--resume FILE` goes on where a file of an earlier run ends.
"""

from __future__ import annotations

import argparse
import os
import resource
import tempfile
from pathlib import Path

LIMIT = 8.0  # s of CPU, above which a call is named in slow_calls.md with its reason
MODELS = Path(__file__).parents[1] / "models"
VERBS = {
    "check": (),
    "derive": (),
    "solve": (),
    "reactions": (),
    "statics": (),
    "linearize": (),
    "simulate": ("--time", "1"),
    "codegen": ("--target", "c"),
    "report": (),
}
WRITES = {"codegen": "code", "report": "report.html"}


def seconds(words: list[str]) -> tuple[float, int]:
    """(CPU seconds, exit code) of one call."""
    if (pid := os.fork()) == 0:
        from eomgen.cli import main

        code = 70
        try:
            null = os.open(os.devnull, os.O_RDWR)
            for stream in (0, 1, 2):
                os.dup2(null, stream)
            main(words)
            code = 0
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 1
        finally:
            os._exit(code)
    _, status, used = os.wait4(pid, 0)
    return used.ru_utime + used.ru_stime, os.waitstatus_to_exitcode(status)


def call(verb: str, model: Path, place: Path) -> list[str]:
    words = [verb, str(model), *VERBS[verb], "--patience", "120"]
    return [*words, "-o", str(place / WRITES[verb])] if verb in WRITES else words


def main(verbs: list[str], resumed: Path | None) -> None:
    os.environ["EOMGEN_FRESH"] = "1"
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    import eomgen.page.report
    import eomgen.verbs.derive
    import eomgen.verbs.simulate
    import eomgen.verbs.solve  # noqa: F401  # what every call would import

    lines = resumed.read_text().splitlines() if resumed is not None and resumed.exists() else []
    found = {tuple(line.split()[:2]): float(line.split()[2]) for line in lines}
    for verb in verbs:
        for model in sorted(MODELS.rglob("*.toml")):
            name = str(model.relative_to(MODELS).with_suffix(""))
            if (verb, name) in found:
                continue
            with tempfile.TemporaryDirectory() as place:
                took, code = seconds(call(verb, model, Path(place)))
            found[verb, name] = took
            if resumed is not None:
                with resumed.open("a") as file:
                    file.write(f"{verb} {name} {took:.2f} {code}\n")
            if took > LIMIT:
                print(f"{verb} {name}: {took:.1f} s, exit code {code}", flush=True)
    print("\n| verb | calls | mean [s] | above 2 s | above 8 s |\n|---|---|---|---|---|")
    for verb in verbs:
        own = [took for (each, _), took in found.items() if each == verb]
        over = [sum(took > limit for took in own) for limit in (2.0, LIMIT)]
        print(f"| {verb} | {len(own)} | {sum(own) / max(1, len(own)):.2f} | {over[0]} | {over[1]} |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verbs", nargs="*", choices=[*VERBS, []], metavar="verb")
    parser.add_argument("--resume", type=Path)
    requested = parser.parse_args()
    main(requested.verbs or list(VERBS), requested.resume)
