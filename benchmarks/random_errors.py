"""Errors that nobody chose: one operator, sign, number or comparison of the package is changed; who sees it?

Where `planted_errors.toml` is a list made by hand, here the places are drawn by lot from the functions that a run
really calls: from every room in turn, so that what a person reads is tried as often as what is computed. The package is
imported once; a run is a fork of it in which the function has other code, and up to three that call it are made again:

    product     the verb says so: exit code other than 0
    tests       by --tests: the quick tests fail
    harmless    every number and formula that is printed is right all the same
    no effect   what is printed, and what is written into files, is the same
    open        exit code 0, and something that is printed or written differs: read it, by -v

Totals stand apart for equations and numbers, and for what a person reads (READ).
The share is of those that do something.

    python benchmarks/random_errors.py 200 --seed 1 [-v] [--rooms mechanics,model] [--tests] [--evenly no]

--traced FILE keeps there which functions each run calls: the next draw begins at once. Delete it where some are new.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import cProfile
import gc
import importlib
import json
import multiprocessing
import os
import pkgutil
import random
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import planted_errors as planted

ROOT = planted.ROOT
# Of these a change is no wrong law: what is refused, said or bounded, and what looks at results by itself.
APART = ("schema", "checks", "reader", "tolerances", "work.py", "errors", "closeness", "suggest", "templates")
LEFT_OUT = ("proof", "certificate.py", "records.py", "files.py", "kept.py", "errors.py", "version.py", "edge.py")
READ = ("documents", "scene", "page", "judge", "verbs", "symbolic/print")
QUICK = '-m "not slow" tests'  # the tests that README asks everybody to run
RUNS = """
derive arm3; derive whipple_bicycle; derive ball_on_turntable; derive seeds/s1_euler; derive gyrostat; derive four_bar
derive flyball_governor; derive seeds/ch22_p3; derive block_on_wedge
derive double_pendulum --text; derive four_bar --format latex --text; derive rolling_disc --format markdown --text
solve seeds/ch22_p1; solve seeds/ch22_p6; solve seeds/ch20_p3; solve seeds/ch17_p5; solve seeds/ch16_p4
solve seeds/ch18_p2; solve seeds/ch21_p4; solve seeds/ch13_p1; solve seeds/ch11_p5; solve quick_return; solve arm3
solve epicyclic_gear; solve double_atwood; solve rolling_cone; solve half_car; solve flyball_governor
solve skate_on_slope; solve seeds/ch9_p10; solve spherical_pendulum; solve seeds/ch22_p1 --text
reactions seeds/ch22_p3; reactions four_bar; reactions heavy_top; reactions block_on_wedge; reactions rolling_disc
reactions slider_crank; reactions seeds/ch20_p5; reactions four_bar --text
statics gerber_beam; statics three_hinged_arch; statics a_frame; statics fink_truss; statics tripod
statics strut_frame; statics seeds/ch10_p2; statics bolt_cutter; statics shear_legs; statics gerber_beam --text
kinematics four_bar; kinematics slider_crank; kinematics quick_return; kinematics epicyclic_gear
kinematics four_bar --text
inertia seeds/s1_inertia_tensor; inertia seeds/s1_principal_axes; inertia heavy_top; inertia heavy_top --text
linearize half_car; linearize double_pendulum; linearize four_bar; linearize two_mass_oscillator
linearize furuta_pendulum; linearize whipple_bicycle; linearize half_car --text
simulate double_pendulum --time 1; simulate four_bar --time 0.5; simulate sliding_ladder --time 1.2
simulate rattleback --time 0.5; simulate tumbling_body --time 0.5; simulate rough_incline --time 0.5
simulate box_on_two_feet --time 0.5; simulate chaplygin_sleigh --time 1; simulate elastic_pendulum --time 1
simulate tippe_top --time 0.2; simulate scotch_yoke --time 0.5; simulate disc_leaves_cylinder --time 1
simulate double_pendulum --time 1 -o @/run.csv; simulate cart_pole --time 1 --text
check four_bar; check fink_truss --text; check parallelogram_reactions
verify double_pendulum "2*m1 = 3"; verify simple_pendulum "theta'' = -g/l*sin(theta)"
verify simple_pendulum "theta'' = g/l*sin(theta)" --text; verify cart_pole "T = m*x'^2/2"
report simple_pendulum -o @/r.html --time 1; report four_bar -o @/r.md --time 0.5
report double_pendulum -o @/r.tex --time 1
animate double_pendulum -o @/a.png --time 1 --frames 3; animate four_bar -o @/a.html --time 0.5 --forces
play simple_pendulum -o @/p.html --time 1
codegen double_pendulum --target c -o @/c; codegen four_bar --target javascript -o @/j
export arm3 -o @/r.urdf then import @/r.urdf -o @/m.toml
simulate arm3 --time 1 --samples 80 -o @/d.csv then identify arm3 --data @/d.csv; identify arm3
sweep simple_pendulum --over "l=0.5:1:3" --ask "frequency(1)" -o @/s
"""


@dataclass(frozen=True)
class Place:
    """A node of a module's text that can be changed: between two offsets `new` is put in, in words `what`."""

    file: str
    line: int
    begin: int
    end: int
    new: str
    what: str

    def patched(self) -> str:
        source = (ROOT / "eomgen" / self.file).read_bytes()
        return (source[: self.begin] + self.new.encode() + source[self.end :]).decode()

    def planted(self) -> planted.Planted:
        return _Drawn(self.what, "", self.file, "", "", "", QUICK, place=self)


@dataclass(frozen=True)
class _Drawn(planted.Planted):
    place: Place | None = None

    @property
    def patched(self) -> str:
        assert self.place is not None
        return self.place.patched()

    def put_in(self) -> None:
        assert self.place is not None
        exchange(self.place)


OTHER = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*"}
SIGNS = {"-": "+", "+": "-", "*": "/", "/": "*"}
TURNED = {ast.Lt: ">=", ast.Gt: "<=", ast.LtE: ">", ast.GtE: "<", ast.Eq: "!=", ast.NotEq: "=="}


def places(file: str, called: set[str]) -> Iterator[tuple[str, Place]]:
    """(function, what can be changed inside it) of the functions of these qualified names."""
    text = (ROOT / "eomgen" / file).read_bytes()
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def span(node: ast.expr) -> tuple[int, int]:
        assert node.end_lineno is not None and node.end_col_offset is not None
        return starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset

    def between(left: ast.expr, right: ast.expr, old: str, new: str, line: int, what: str) -> Iterator[Place]:
        a, b = span(left)[1], span(right)[0]
        at = text[a:b].find(old.encode())
        if at >= 0 and text[a:b].count(old.encode()) == 1:
            yield Place(file, line, a + at, a + at + len(old), new, what)

    def changes(node: ast.AST) -> Iterator[Place]:
        if isinstance(node, ast.BinOp) and type(node.op) in OTHER:
            new = OTHER[type(node.op)]
            yield from between(node.left, node.right, SIGNS[new], new, node.lineno, f"{SIGNS[new]} becomes {new}")
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            a, _ = span(node)
            yield Place(file, node.lineno, a, a + 1, "+", "a minus is lost")
        elif isinstance(node, ast.Constant) and type(node.value) is int and node.value in range(10):
            a, b = span(node)
            yield Place(file, node.lineno, a, b, str(node.value + 1), f"{node.value} becomes {node.value + 1}")
        elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in TURNED:
            old = {ast.Lt: "<", ast.Gt: ">", ast.LtE: "<=", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
            word = old[type(node.ops[0])]
            new = TURNED[type(node.ops[0])]
            yield from between(node.left, node.comparators[0], word, new, node.lineno, f"{word} becomes {new}")

    for name, node in _nodes(ast.parse(text)):
        if name in called:
            yield from ((name, place) for place in changes(node) if _stands(place, text))


def _stands(place: Place, text: bytes) -> bool:
    """Whether what is changed is there: inside an f-string Python 3.11 does not know where its nodes stand."""
    old = text[place.begin : place.end].decode(errors="replace")
    if place.new.isdigit():
        return old.isdigit() and int(old) + 1 == int(place.new)
    return old in ("+", "-", "*", "/", "<", ">", "<=", ">=", "==", "!=")


def _nodes(tree: ast.AST, within: str = "") -> Iterator[tuple[str, ast.AST]]:
    """(qualified name of the function, a node inside it), functions inside functions as part of them."""
    for child in ast.iter_child_nodes(tree):
        name = within + getattr(child, "name", "")
        if isinstance(child, ast.FunctionDef):
            yield from ((name, node) for statement in child.body for node in ast.walk(statement))
        else:
            yield from _nodes(child, f"{name}." if isinstance(child, ast.ClassDef) else within)


Function = tuple[str, str]  # (file, qualified name)


def warm() -> None:
    """Import the whole package: an error then is other code of a function that is there."""
    planted.warm()
    import eomgen

    for module in pkgutil.walk_packages(eomgen.__path__, "eomgen."):
        if not module.name.endswith("__main__"):
            with contextlib.suppress(ImportError):
                importlib.import_module(module.name)
    functions()


@cache
def functions() -> dict[str, list[FunctionType]]:
    """The functions of every file that is loaded."""
    found: dict[str, list[FunctionType]] = defaultdict(list)
    for each in gc.get_objects():
        if type(each) is FunctionType:
            found[each.__code__.co_filename].append(each)
    return found


def exchange(place: Place) -> None:
    """Every function of the module that a place changes gets its changed code."""
    path = str(ROOT / "eomgen" / place.file)
    new = {(code.co_qualname, code.co_firstlineno): code for code in _codes(compile(place.patched(), path, "exec"))}
    for function in functions()[path]:
        if other := new.get((function.__code__.co_qualname, function.__code__.co_firstlineno)):
            function.__code__ = other


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _codes(inner)


def _traced(run: str, pipe: Any) -> None:
    """In a process of its own: which functions of the package a run calls."""
    home, profiler = str(ROOT / "eomgen") + "/", cProfile.Profile(builtins=False)

    class Kept:
        def send(self, found: Any) -> None:
            self.found = found

    kept = Kept()
    profiler.enable()
    planted._child(None, run, "", kept)  # type: ignore[arg-type]
    profiler.disable()
    codes = (entry.code for entry in profiler.getstats())
    seen = {(x.co_filename[len(home) :], x.co_qualname) for x in codes if x.co_filename.startswith(home)}
    pipe.send((kept.found.code, kept.found.why, seen))


def traced(run: str) -> tuple[int, str, set[Function]]:
    """(exit code, why it is not 0, which functions a run calls)."""
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)
    child = context.Process(target=_traced, args=(run, there))
    child.start()
    found = here.recv()
    child.join()
    return found  # type: ignore[no-any-return]


def all_traced(runs: Iterable[str], kept: str) -> dict[str, set[Function]]:
    """{run: the functions that it calls}, of runs that end well; by the file, where it is given and knows them."""
    known = json.loads(Path(kept).read_text()) if kept and Path(kept).exists() else {}
    for run in runs:
        if run not in known:
            code, why, functions = traced(run)
            if code not in planted.VERDICTS:
                print(f"left out: {run}: exit {code} {why}", flush=True)
            known[run] = sorted(functions) if code in planted.VERDICTS else []
            if kept:
                Path(kept).write_text(json.dumps(known))
    return {run: {(file, name) for file, name in known[run]} for run in runs}


@cache
def as_it_is(run: str) -> planted.Outcome:
    """What a run says without an error."""
    return planted.outcome(None, run)


def difference(found: str, right: str) -> str:
    """The first answer that is not right; "" where all are."""
    if not right.lstrip().startswith(("{", "[")):
        return "" if found == right else _first_line(found, right)
    a, b = (planted._leaves(json.loads(text)) for text in (found, right))
    for key in b:
        if key.startswith((".schema", ".steps")) or ".message" in key or ".method" in key:
            continue
        if key not in a:
            if key.startswith(".symbols"):  # a formula in another form has other letters
                continue
            return f"{key}: missing"
        if not planted._right(a[key], b[key], True) and not _same_text(a[key], b[key]):
            return f"{key}: {str(a[key])[:150]} for {str(b[key])[:150]}"
    return ""


def _same_text(one: Any, other: Any) -> bool:
    if not (isinstance(one, str) and isinstance(other, str) and "=" in one and "=" in other):
        return False
    sides = [x.split("=") for x in (one, other)]
    return all(len(x) == 2 for x in sides) and planted._equal_formulas(*("(" + ")-(".join(x) + ")" for x in sides))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("number", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rooms", default="", help="these alone, separated by commas")
    parser.add_argument("--evenly", choices=("yes", "no"), default="yes", help="from every room as many")
    parser.add_argument("--tests", action="store_true", help="run the quick tests on what the product did not see")
    parser.add_argument("--runs", type=int, help="so many of the runs alone, drawn by the seed")
    parser.add_argument("--of", default="", help="the runs alone in which one of these words stands")
    parser.add_argument("--traced", default="", help="a file that keeps which functions each run calls")
    parser.add_argument("-v", "--verbose", action="store_true")
    options = parser.parse_args()
    os.environ["EOMGEN_FRESH"] = "1"
    warm()
    rng = random.Random(options.seed)
    runs = [run.strip() for run in RUNS.replace("\n", ";").split(";") if run.strip()]
    runs = [run if run.startswith("export") else patient(run) for run in runs]
    words = [word for word in options.of.split(",") if word]
    runs = [run for run in runs if any(word in run for word in words)] if words else runs
    runs = random.Random(options.seed).sample(runs, options.runs) if options.runs else runs
    with tempfile.TemporaryDirectory() as planted.CODE:
        called: dict[Function, list[str]] = defaultdict(list)
        for run, mine in all_traced(runs, options.traced).items():
            for function in sorted(mine):
                called[function].append(run)
        rows = counted(called, rng, options)
    print(f"seed {options.seed}\n{table(rows)}")
    return 0


def counted(
    called: dict[Function, list[str]], rng: random.Random, options: argparse.Namespace
) -> Counter[tuple[str, str]]:
    """{(room, who saw it): how many} of what is drawn."""
    by_file: dict[str, set[str]] = defaultdict(set)
    rooms = set(filter(None, options.rooms.split(",")))
    for file, function in called:
        room = room_of(file)
        if room in rooms or (not rooms and room not in LEFT_OUT and not any(word in file for word in APART)):
            by_file[file].add(function)
    every = [
        (place, called[file, function])
        for file, functions in sorted(by_file.items())
        for function, place in places(file, functions)
    ]
    print(f"{len(every)} places in {len(by_file)} files", flush=True)
    rows: Counter[tuple[str, str]] = Counter()
    for place, mine in drawn(every, options.number, rng, evenly=options.evenly == "yes"):
        seen = "no effect"
        for run in rng.sample(mine, min(3, len(mine))):
            seen, said = judged(planted.outcome(place.planted(), run), as_it_is(run), seen)
            if seen == "open" and options.tests and planted.seen_by_tests(place.planted()):
                seen = "tests"
            if seen != "no effect" and (options.verbose or seen == "open"):
                print(f"{seen:9} {place.file}:{place.line} {place.what} [{run}] {said[:330]}", flush=True)
            if seen not in ("harmless", "no effect"):
                break
        rows[room_of(place.file), seen] += 1
    return rows


def patient(run: str) -> str:
    """A run that the clock does not end: it is traced, or shares its machine."""
    line = run.removesuffix(" --text")
    return f"{line} --patience none{run[len(line) :]}"


def room_of(file: str) -> str:
    """The room of a file; what prints formulas is a room of its own, options belong to the verbs."""
    if file.startswith(("symbolic/print", "cli")):
        return "symbolic/print" if file.startswith("symbolic") else "verbs"
    return file.split("/")[0]


Drawn = tuple[Place, list[str]]


def drawn(every: list[Drawn], number: int, rng: random.Random, *, evenly: bool) -> list[Drawn]:
    """So many places, of every room in turn or of all together."""
    if not evenly:
        return rng.sample(every, number)
    rooms: dict[str, list[Drawn]] = defaultdict(list)
    for each in every:
        rooms[room_of(each[0].file)].append(each)
    for mine in rooms.values():
        rng.shuffle(mine)
    found = []
    while len(found) < number and any(rooms.values()):
        found += [mine.pop() for mine in rooms.values() if mine]
    return found[:number]


def judged(wrong: planted.Outcome, right: planted.Outcome, before: str) -> tuple[str, str]:
    """(who saw it, what was said); `before` where this run is as it should be."""
    if wrong.code not in (right.code, *planted.VERDICTS):
        return "product", wrong.why
    if wrong.out == right.out and wrong.files == right.files:
        return before, ""
    said = difference(wrong.out, right.out) or _files_apart(dict(wrong.files), dict(right.files))
    return ("open", said) if said else ("harmless", "")


def _files_apart(found: dict[str, bytes], right: dict[str, bytes]) -> str:
    """The first file that is another one, and where."""
    for name, text in right.items():
        if found.get(name) != text:
            return f"{name}: {_first_line(found.get(name, b'').decode('latin-1'), text.decode('latin-1'))}"
    return ""


def _first_line(found: str, right: str) -> str:
    pairs = zip(found.splitlines(), right.splitlines(), strict=False)
    one, other = next(((a, b) for a, b in pairs if a != b), (f"{len(found)} characters", str(len(right))))
    at = next((k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), 0)
    return f"{one[max(at - 40, 0) : at + 80]} for {other[max(at - 40, 0) : at + 80]}"


def table(rows: Counter[tuple[str, str]]) -> str:
    """Markdown: of every room how many were drawn and who saw them; the sums of both kinds of rooms."""
    words = ("product", "tests", "harmless", "no effect", "open")
    lines = [f"| room | {' | '.join(words)} | seen |", f"|---|{'---:|' * (len(words) + 1)}"]
    rooms = sorted({room for room, _ in rows})
    sums = {
        "**equations and numbers**": [room for room in rooms if room not in READ],
        "**what a person reads**": [room for room in rooms if room in READ],
        "**all**": rooms,
    }
    for room, mine in ({room: [room] for room in rooms} | sums).items():
        counts = [sum(n for (r, w), n in rows.items() if w == word and r in mine) for word in words]
        wrong = counts[0] + counts[1] + counts[-1]
        share = f"{100 * (wrong - counts[-1]) / wrong:.0f} %" if wrong else ""
        lines.append(f"| {room} | {' | '.join(map(str, counts))} | {share} |")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
