"""The house in figures: what somebody has to know who comes new. `tests/test_layering.py` keeps those that are reached.

python benchmarks/house.py          tables in Markdown: the figures, the rooms
"""

from __future__ import annotations

import ast
import gc
import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "eomgen"
DIVIDED = ("symbolic", "mechanics")  # rooms whose folders have doors of their own
SEAMS = ("joints", "forces", "constraints", "shapes", "outputs", "targets", "verbs")  # a member is a file, or a class
LOWER = ("symbolic", "model", "mechanics", "codegen", "simulation")
LAZY = re.compile(r"^(?:functools\.)?(?:cached_property|cache|lru_cache)\b")
BY_HAND = re.compile(r"^(?:dict|list|OrderedDict|defaultdict)\b.*= field\(.*default_factory=", re.S)
MOST_KEPT = 2  # things derived of a model that a class may cache before it counts as a bundle


@cache
def door_of(package: str) -> dict[str, str]:
    """{name: module} of what a package gives to others by its stub; {} of one without a door."""
    stub = PACKAGE.joinpath(*package.split(".")[1:], "__init__.pyi")
    if package == "eomgen" or not stub.exists():
        return {}
    return {name: home for home, name in re.findall(r"^from (\S+) import (\w+) as \2$", stub.read_text("utf-8"), re.M)}


@cache
def tree_of(path: Path) -> ast.Module:
    """The syntax tree of a module. The garbage collector waits: it would look at each node again and again."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        return ast.parse(path.read_text(encoding="utf-8"))
    finally:
        if was_on:
            gc.enable()


@dataclass(frozen=True)
class Module:
    """A module of the package by its dotted name without the package's, "mechanics.kinematics.motion"."""

    name: str
    path: Path

    @cached_property
    def text(self) -> str:
        return self.path.read_text(encoding="utf-8")

    @property
    def tree(self) -> ast.Module:
        return tree_of(self.path)

    @property
    def lines(self) -> int:
        return self.text.count("\n")

    @property
    def is_init(self) -> bool:
        return self.path.name == "__init__.py"

    @property
    def room(self) -> str:
        """What has a door: a room, in a divided room a folder, or the module itself where it stands alone."""
        parts = self.name.split(".")
        return ".".join(parts[: 2 if parts[0] in DIVIDED else 1])

    @property
    def in_seam(self) -> bool:
        parts = self.name.split(".")
        return parts[0] != "mechanics" and any(seam in parts[:-1] for seam in SEAMS)

    @cached_property
    def public_names(self) -> set[str]:
        """Classes, functions and aliases; CONSTANTS are not counted."""
        found: set[str] = set()
        for node in self.tree.body:
            if isinstance(node, ast.ClassDef | ast.FunctionDef):
                found.add(node.name)
            elif isinstance(node, ast.Assign):
                found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
        return {name for name in found if not name.startswith("_") and not name.isupper()}

    @cached_property
    def imports(self) -> tuple[tuple[str, str], ...]:
        """(module, name) of every import from the package, wherever it stands."""
        froms = (n for n in ast.walk(self.tree) if isinstance(n, ast.ImportFrom) and n.module and not n.level)
        return tuple(
            (door_of(node.module).get(alias.name, node.module).removeprefix("eomgen").removeprefix("."), alias.name)
            for node in froms
            if node.module and node.module.split(".")[0] == "eomgen"
            for alias in node.names
        )


@dataclass(frozen=True)
class House:
    """All modules of the package."""

    modules: dict[str, Module]

    @cached_property
    def chapters(self) -> list[Module]:
        """What one reads: neither members of seams nor `__init__` of folders."""
        return [m for m in self.modules.values() if not m.in_seam and not m.is_init]

    @cached_property
    def importers(self) -> dict[str, set[str]]:
        """Of each module those that import it."""
        found: defaultdict[str, set[str]] = defaultdict(set)
        for module in self.modules.values():
            for source, name in module.imports:
                inner = f"{source}.{name}" if source else name
                found[inner if inner in self.modules else source].add(module.name)
        return found

    @property
    def private(self) -> list[str]:
        """Chapters that one other module imports."""
        return [m.name for m in self.chapters if len(self.importers[m.name]) == 1]

    @cached_property
    def crossing(self) -> dict[str, set[tuple[str, str]]]:
        """Of each room the names (their room, name) that it takes from others."""
        found: defaultdict[str, set[tuple[str, str]]] = defaultdict(set)
        for module in self.modules.values():
            for source, name in module.imports:
                inner = f"{source}.{name}" if source else name
                home = self.modules.get(inner) or self.modules.get(source)
                if home is not None and home.name and home.room != module.room:
                    found[module.room].add((home.room, name))
        return found

    def taken_from(self, rooms: tuple[str, ...]) -> set[tuple[str, str]]:
        """Names of these rooms that others use."""
        return {(home, x) for names in self.crossing.values() for home, x in names if home.split(".")[0] in rooms}

    def taken_by(self, room: str) -> set[tuple[str, str]]:
        """Names that a room, with its folders, takes from other rooms."""
        mine = (names for own, names in self.crossing.items() if own.split(".")[0] == room)
        return {(home, x) for names in mine for home, x in names if home.split(".")[0] != room}

    @cached_property
    def classes(self) -> list[tuple[str, ast.ClassDef]]:
        """(module, class) of all of them."""
        trees = ((m.name, node) for m in self.modules.values() for node in ast.walk(m.tree))
        return [(name, node) for name, node in trees if isinstance(node, ast.ClassDef)]

    @cached_property
    def of_a_model(self) -> set[str]:
        """Names of the classes that hold a model, or what holds one: by their fields, bases and `__init__`."""
        words = {node: set(re.findall(r"\w+", " ".join(_held(node)))) for _, node in self.classes}
        found, more = set[str](), {"Model"}
        while more > found:
            found = more
            more = found | {node.name for _, node in self.classes if words[node] & found}
        return found

    @property
    def bundles(self) -> list[tuple[str, int]]:
        """(module.class, how many) of those that cache more than a few things derived of a model."""
        kept = ((f"{m}.{node.name}", node.name, _kept(node)) for m, node in self.classes)
        found = [(name, k) for name, own, k in kept if k > MOST_KEPT and own in self.of_a_model]
        return sorted(found, key=lambda each: (-each[1], each[0]))

    def calls(self, names: Collection[str], above: Collection[str]) -> set[tuple[str, str]]:
        """(module, function) of each call of these functions, "f" or "Class.f", outside some rooms."""
        return {
            (module.name, name)
            for module in self.modules.values()
            if module.name.split(".")[0] not in above
            for node in ast.walk(module.tree)
            if isinstance(node, ast.Call) and (name := ast.unparse(node.func)) in names
        }


def _held(node: ast.ClassDef) -> Iterator[str]:
    """Texts of what a class holds: its bases, and the types of its fields and of the arguments of `__init__`."""
    yield from map(ast.unparse, node.bases)
    for part in node.body:
        if isinstance(part, ast.AnnAssign):
            yield ast.unparse(part.annotation)
        elif isinstance(part, ast.FunctionDef) and part.name == "__init__":
            yield from (ast.unparse(x.annotation) for x in (*part.args.args, *part.args.kwonlyargs) if x.annotation)


def _kept(node: ast.ClassDef) -> int:
    """Number of caches of a class: lazy properties, fields and attributes that begin empty, values recalled."""
    return sum(sum(_kept_by(part)) for part in node.body)


def _kept_by(part: ast.stmt) -> Iterator[int]:
    if isinstance(part, ast.AnnAssign) and part.value is not None:
        yield BY_HAND.match(f"{ast.unparse(part.annotation)} = {ast.unparse(part.value)}") is not None
    if not isinstance(part, ast.FunctionDef):
        return
    yield any(LAZY.match(ast.unparse(each)) for each in part.decorator_list)
    for node in ast.walk(part):
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "recalled":
            yield ast.unparse(node.args[0]) == "self"
        elif isinstance(node, ast.Assign | ast.AnnAssign) and part.name == "__init__":
            target = node.target if isinstance(node, ast.AnnAssign) else node.targets[0]
            yield isinstance(target, ast.Attribute) and node.value is not None and ast.unparse(node.value) == "{}"


def house(package: Path = PACKAGE) -> House:
    """The package as it stands."""

    def named(path: Path) -> str:
        parts = path.relative_to(package).with_suffix("").parts
        return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)

    paths = sorted(package.rglob("*.py"))
    return House({named(path): Module(named(path), path) for path in paths})


def longest_function(modules: list[Module]) -> int:
    nodes = (n for m in modules for n in ast.walk(m.tree) if isinstance(n, ast.FunctionDef | ast.AsyncFunctionDef))
    return max((n.end_lineno or n.lineno) - n.lineno + 1 for n in nodes)


def small_literals(module: Module) -> int:
    """Literals of at most 1e-4: tolerances that stand where they are used."""
    numbers = (node.value for node in ast.walk(module.tree) if isinstance(node, ast.Constant))
    return sum(isinstance(x, float) and 0 < x <= 1e-4 for x in numbers)


def figures(whole: House) -> Iterator[tuple[str, str]]:
    """(what, how much), as text."""
    modules = list(whole.modules.values())
    lines = sorted(m.lines for m in whole.chapters)
    lower = [m for m in modules if m.name.split(".")[0] in LOWER]
    homes = Counter(name for m in modules for name in m.public_names)
    yield "modules", f"{len(modules)}, of them {len(whole.chapters)} outside the seams"
    yield "lines", f"{sum(m.lines for m in modules)}"
    yield "lines of a module: median, most", f"{lines[len(lines) // 2]}, {lines[-1]}"
    yield "longest function [lines]", str(longest_function(modules))
    yield "modules that one other module imports", str(len(whole.private))
    yield (
        "public names in symbolic, model, mechanics, codegen, simulation",
        str(sum(len(m.public_names) for m in lower)),
    )
    yield (
        "of these rooms' names, used in others (in symbolic and mechanics: other folders)",
        str(len(whole.taken_from(LOWER))),
    )
    for room in ("documents", "results", "questions", "verbs", "proof", "judge"):
        yield f"foreign names in {room}", str(len(whole.taken_by(room)))
    doors = {m.name: len(door_of(f"eomgen.{m.name}")) for m in modules if m.is_init and m.name}
    yield "rooms with a door (names)", ", ".join(f"{name} {k}" for name, k in sorted(doors.items()) if k)
    yield f"classes that cache more than {MOST_KEPT} things derived of a model", str(len(whole.bundles))
    yield "the largest of them", ", ".join(f"{name} {k}" for name, k in whole.bundles[:6])
    yield "public names in more than one module", str(sum(k > 1 for k in homes.values()))
    private = sum(small_literals(m) for m in modules if m.path.name != "tolerances.py")
    yield "tolerances outside `tolerances.py`", str(private)


def main() -> None:
    whole = house()
    print("| what | now |\n|---|---|")
    for what, value in figures(whole):
        print(f"| {what} | {value} |")
    rooms = defaultdict(list)
    for module in whole.modules.values():
        rooms[module.name.partition(".")[0]].append(module)
    print("\n| room | modules | lines |\n|---|---|---|")
    for room, members in sorted(rooms.items(), key=lambda each: -sum(m.lines for m in each[1])):
        print(f"| {room or 'eomgen'} | {len(members)} | {sum(m.lines for m in members)} |")


if __name__ == "__main__":
    main()
