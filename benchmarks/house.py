"""The house in figures: names defined twice, private tolerances, sizes of files and functions, arrows between rooms.

python benchmarks/house.py          two tables in Markdown: the figures, and the lines of each room
"""

from __future__ import annotations

import ast
import re
from collections import Counter, defaultdict
from fnmatch import fnmatch
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "eomgen"
LATER = {  # what was built after the house was laid out, by what it is for: patterns of paths inside the package
    "pages and pictures": "page/ scene/ documents/*motion* documents/*pictur* documents/*drawing* documents/letters* "
    "verbs/play.py verbs/animate.py verbs/report.py",
    "equations that somebody derived": "judge/ verbs/verify.py symbolic/expression/text.py",
    "other languages, series, lanes": "codegen/targets/[d-z]*.py codegen/targets/loading.py "
    "codegen/targets/python_files.py codegen/targets/casadi.py codegen/targets/cpp.py "
    "codegen/targets/c_lanes.py codegen/targets/c_lanes.py "
    "codegen/taylor.py codegen/taylor.py codegen/batching.py codegen/programs.py codegen/rhs.py "
    "codegen/vectors.py",
    "robots and other programs": "robots/ exported.py verbs/importing.py verbs/exporting.py",
    "many runs, sweeps, parameters": "sweeps/ sensitivities/ identification/ questions/many_runs.py "
    "questions/simulator.py questions/simulator.py questions/of_a_run.py verbs/sweep.py verbs/identify.py",
    "compiled steps": "simulation/compiled_steps.py simulation/compiled_steps.py simulation/motion.py "
    "simulation/phase_functions.py",
    "kept and compared derivations": "kept.py verbs/kept_derivation.py verbs/derive_difference.py",
    "units of what is written": "symbolic/expression/dimensions.py",
}
STAYS = ("codegen/targets/numpy.py",)
SMALL = 60  # lines of a file that should live with its owner, unless it is a member of a seam


def sources() -> dict[Path, str]:
    return {path: path.read_text(encoding="utf-8") for path in sorted(PACKAGE.rglob("*.py"))}


def public_names(text: str) -> set[str]:
    """Classes, functions and aliases of a module; CONSTANTS are not counted."""
    found: set[str] = set()
    for node in ast.parse(text).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            found.add(node.name)
        elif isinstance(node, ast.Assign):
            found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    return {name for name in found if not name.startswith("_") and not name.isupper()}


def small_literals(text: str) -> int:
    """Literals of at most 1e-4: tolerances that stand where they are used."""
    numbers = (node.value for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Constant))
    return sum(isinstance(x, float) and 0 < x <= 1e-4 for x in numbers)


def longest_function(text: str) -> int:
    spans = (n for n in ast.walk(ast.parse(text)) if isinstance(n, (ast.FunctionDef, ast.AsyncFunctionDef)))
    return max(((n.end_lineno or n.lineno) - n.lineno + 1 for n in spans), default=0)


def figures() -> dict[str, str]:
    """(what, how much), as text."""
    texts = sources()
    homes: defaultdict[str, set[Path]] = defaultdict(set)
    for path, text in texts.items():
        for name in public_names(text):
            homes[name].add(path)
    twice = [name for name, where in homes.items() if len(where) > 1]
    lines = {path: text.count("\n") for path, text in texts.items()}
    rooms = Counter(path.relative_to(PACKAGE).parts[0] for path, n in lines.items() for _ in range(n))
    proof = sum(n for path, n in lines.items() if "proof" in path.as_posix().removeprefix(PACKAGE.as_posix()))
    seams = ("joints", "forces", "constraints", "shapes", "targets")
    small = [p for p, n in lines.items() if n < SMALL and p.name != "__init__.py" and p.parent.name not in seams]
    handlers = sum(len(re.findall(r"(?:except|suppress)\b[^:\n]*\bEomgenError", t)) for t in texts.values())
    private = sum(small_literals(text) for path, text in texts.items() if path.name != "tolerances.py")
    return {
        "public names in more than one module": f"{len(twice)} of {len(homes)} ({100 * len(twice) / len(homes):.1f} %)",
        "tolerances outside `tolerances.py`": str(private),
        "private budgets (`WORK = ...`)": str(sum(len(re.findall(r"^WORK", t, re.M)) for t in texts.values())),
        "handlers that name the root class of errors": str(handlers),
        "tests on `kind ==` in mechanics and simulation, of members": str(_kinds(texts)),
        "`# fmt: skip`": str(sum(text.count("# fmt: skip") for text in texts.values())),
        "longest function [lines]": str(max(map(longest_function, texts.values()))),
        "modules": str(len(texts)),
        f"modules under {SMALL} lines, seams apart": str(len(small)),
        "lines": f"{sum(lines.values())}, {proof} of them proofs",
        "lines by room": ", ".join(f"{room} {n}" for room, n in rooms.most_common(9)),
    }


def built_later(path: Path) -> str:
    """For what a file was built after the house was laid out, or ""."""
    name = path.relative_to(PACKAGE).as_posix()
    for what, patterns in LATER.items():
        for pattern in patterns.split():
            if name not in STAYS and fnmatch(name, pattern + "*" if pattern.endswith("/") else pattern):
                return what
    return ""


def lines_of_rooms() -> list[tuple[str, int, int]]:
    """(room, its lines, of these what was built later), the largest first; then the whole."""
    whole, later = Counter[str](), Counter[str]()
    for path, text in sources().items():
        room = path.relative_to(PACKAGE).parts[0]
        whole[room] += text.count("\n")
        later[room] += text.count("\n") if built_later(path) else 0
    rows = [(room, n, later[room]) for room, n in whole.most_common()]
    return [*rows, ("all", whole.total(), later.total())]


def lines_built_later() -> Counter[str]:
    found = Counter[str]()
    for path, text in sources().items():
        found[built_later(path)] += text.count("\n")
    return found


def _kinds(texts: dict[Path, str]) -> int:
    of_members = re.compile(r"\b(joint|shape|force|tie|contact|part)\.kind (==|!=|in) ")
    return sum(len(of_members.findall(t)) for p, t in texts.items() if {"mechanics", "simulation"} & set(p.parts))


def main() -> None:
    print("| what | now |\n|---|---|")
    for what, value in figures().items():
        print(f"| {what} | {value} |")
    print("\n| room | lines | as it was laid out | built later |\n|---|---|---|---|")
    for room, lines, later in lines_of_rooms():
        print(f"| {room} | {lines} | {lines - later} | {later} |")
    print("\n| built later | lines |\n|---|---|")
    for what, lines in lines_built_later().most_common():
        print(f"| {what} | {lines} |" if what else f"| (as it was laid out) | {lines} |")


if __name__ == "__main__":
    main()
