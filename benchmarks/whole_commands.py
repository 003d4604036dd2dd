"""Whole commands, proof included, in units of `python -c "import sympy"`: python benchmarks/whole_commands.py

CPU seconds of user and system, the least of three runs, of programs that start anew each time, byte code already made.
Nothing is told again that was derived before (EOMGEN_FRESH=1), but in the row that says so.
`--write` puts the table beside this file. The wanted figures are those of the project's own plan.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "models"))
sys.path.insert(0, str(Path(__file__).parent))

from chain import chain
from instants import truss
from space import tree

ROOT = Path(__file__).parents[1]
RUNS = 3
UNCHANGED = "derive double_pendulum, unchanged"
WANTED = {
    "derive double_pendulum": 2,
    UNCHANGED: 1,
    "derive arm7": 4,
    "derive chain of 50": 8,
    "derive tree of 50": 12,
    "statics truss of 101 members": 6,
    "kinematics chain20": 6,
    "linearize chain of 50": 6,
    "linearize whipple_bicycle": 4,
}


def truss_text(panels: int) -> str:
    """A Pratt truss of 4 panels - 3 members with a load at every lower node."""
    nodes, members = truss(panels)
    places = ", ".join(f'{n} = ["{x}*a", "{y}*h"]' for n, x, y in nodes)
    joined = ", ".join(f'"{i}-{j}"' for i, j in members)
    loads = (f'F{k} = {{ kind = "force", point = "T.L{k}", force = [0, "-P"] }}' for k in range(1, panels))
    return "\n".join(
        [
            "eomgen = 1",
            'space = "plane"',
            "parameters = { a = 2, h = 3, P = 10 }",
            "[trusses.T]",
            f"nodes = {{ {places} }}",
            f"members = [{joined}]",
            "[constraints]",
            'A = { kind = "pin", points = ["T.L0"] }',
            f'B = {{ kind = "support", point = "T.L{panels}", normal = [0, 1] }}',
            "[forces]",
            *loads,
        ]
    )


def made(folder: Path) -> dict[str, list[str]]:
    """The commands by their names, with the models that they take."""
    big = {"chain50": chain(50), "tree50": tree(50, ("revolute",), 0.3), "truss101": truss_text(26)}
    for name, text in big.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    paths = {name: str(folder / f"{name}.toml") for name in big}
    paths |= {name: str(ROOT / "models" / f"{name}.toml") for name in ("double_pendulum", "arm7", "chain20")}
    paths["whipple_bicycle"] = str(ROOT / "models" / "whipple_bicycle.toml")
    models = (
        "double_pendulum",
        "double_pendulum",
        "arm7",
        "chain50",
        "tree50",
        "truss101",
        "chain20",
        "chain50",
        "whipple_bicycle",
    )
    verbs = ("derive", "derive", "derive", "derive", "derive", "statics", "kinematics", "linearize", "linearize")
    return {
        name: ["-m", "eomgen", verb, paths[model], "--patience", "none"]
        for name, verb, model in zip(WANTED, verbs, models, strict=True)
    }


def seconds(command: list[str], runs: int = RUNS, *, fresh: bool = True) -> float:
    """CPU of one run of Python, the least of several."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    environment["EOMGEN_FRESH"] = str(int(fresh))
    found = []
    for _ in range(runs):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([sys.executable, *command], env=environment, cwd=ROOT, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode:
            raise SystemExit(f"{' '.join(command)}: exit {done.returncode}\n{done.stderr}")
        found.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="write whole_commands.md beside this file")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        commands = made(Path(folder))
        seconds(commands["derive double_pendulum"], 1)  # makes the byte code
        seconds(commands[UNCHANGED], 1, fresh=False)
        unit = seconds(["-c", "import sympy"], 2 * RUNS)
        lines = ["| command | CPU [s] | units | wanted |", "|---|---:|---:|---:|"]
        for name, command in commands.items():
            took = seconds(command, fresh=name != UNCHANGED)
            lines.append(f"| {name} | {took:.2f} | {took / unit:.1f} | {WANTED[name]} |")
            print(lines[-1], flush=True)
    lines.append(f'\nOne unit: `python -c "import sympy"`, {unit:.2f} s here.')
    if given.write:
        head = "# Whole commands\n\nMade by `python benchmarks/whole_commands.py --write`.\n\n"
        Path(__file__).with_suffix(".md").write_text(head + "\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
