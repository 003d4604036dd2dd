"""Errors that nobody chose: one operator, sign, number or comparison of the package is changed; who sees it?

Where `planted_errors.toml` is a list made by hand, here the places are drawn by lot from the functions that a run of
`random_errors.toml` really calls, of every room in turn: what a person reads is tried as often as what is computed.
Each error is put into the function in a fork of one process (`error_runs.py`), and up to three runs that call the
function, shorter ones first in the lot, are made again:

    product     the verb says so: exit code other than 0
    tests       by --tests: one of README's tests of its subject fails (`error_tests.py`)
    harmless    every number, formula and word that is printed or written is right all the same (`error_outputs.py`)
    no effect   what is printed, and what is written into files, is the same
    open        exit code 0, and something that is printed or written differs: read it, by -v or --log

Totals stand apart for equations and numbers, and for what a person reads (READ).
The share is of those that do something.

    python benchmarks/random_errors.py 200 --seed 1 [-v] [--rooms mechanics,model] [--tests] [--evenly no]
    python benchmarks/random_errors.py 200 --seed 1 --kind numbers --kept FOLDER --log FILE

In FOLDER stands what runs say without an error, of this package as it is, and which functions they call.
"""

from __future__ import annotations

import argparse
import ast
import json
import random
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import planted_errors as planted
from error_outputs import difference, files_apart
from error_runs import Function, Kept, Run, Server, kept_in, runs
from error_tests import first_failing

ROOT = planted.ROOT
# Of these a change is no wrong law: what is refused, said or bounded, and what looks at results by itself.
APART = (
    "read_back",
    "proven.py",
    "schema",
    "checks",
    "reader",
    "tolerances",
    "work.py",
    "errors",
    "closeness",
    "suggest",
    "templates",
)
LEFT_OUT = (
    *("proof/", "frozen.py", "files.py", "disk_cache.py", "errors.py", "version.py", "cli_common.py"),
    "__init__.py",
)
MOST = 3  # runs of one error
PAGES = ("report", "animate", "play")
READ = ("documents", "results", "scene", "page", "judge", "verbs", "symbolic/print")


@dataclass(frozen=True)
class Place:
    """A node of a module's text that can be changed: between two offsets `new` is put in, in words `what`."""

    file: str
    function: str  # its qualified name
    line: int
    begin: int
    end: int
    new: str
    what: str

    def patched(self) -> str:
        source = (ROOT / "eomgen" / self.file).read_bytes()
        return (source[: self.begin] + self.new.encode() + source[self.end :]).decode()

    @property
    def lines(self) -> tuple[str, str]:
        """The line as it is and as it becomes."""
        old = (ROOT / "eomgen" / self.file).read_text(encoding="utf-8").splitlines()
        return old[self.line - 1].strip(), self.patched().splitlines()[self.line - 1].strip()


OTHER = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*"}
SIGNS = {"-": "+", "+": "-", "*": "/", "/": "*"}
TURNED = {ast.Lt: ">=", ast.Gt: "<=", ast.LtE: ">", ast.GtE: "<", ast.Eq: "!=", ast.NotEq: "=="}


def places(file: str, functions: set[str]) -> Iterator[Place]:
    """What can be changed inside the functions of these qualified names; of none given, of all."""
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
            yield Place(file, name, line, a + at, a + at + len(old), new, what)

    def changes(name: str, function: ast.FunctionDef) -> Iterator[Place]:
        for node in (x for statement in function.body for x in ast.walk(statement)):
            if isinstance(node, ast.BinOp) and type(node.op) in OTHER:
                new = OTHER[type(node.op)]
                yield from between(node.left, node.right, SIGNS[new], new, node.lineno, f"{SIGNS[new]} becomes {new}")
            elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
                a, _ = span(node)
                yield Place(file, name, node.lineno, a, a + 1, "+", "a minus is lost")
            elif isinstance(node, ast.Constant) and type(node.value) is int and node.value in range(10):
                a, b = span(node)
                yield Place(
                    file, name, node.lineno, a, b, str(node.value + 1), f"{node.value} becomes {node.value + 1}"
                )
            elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in TURNED:
                old = {ast.Lt: "<", ast.Gt: ">", ast.LtE: "<=", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
                word = old[type(node.ops[0])]
                new = TURNED[type(node.ops[0])]
                yield from between(node.left, node.comparators[0], word, new, node.lineno, f"{word} becomes {new}")

    for name, function in _functions(ast.parse(text), ""):
        if not functions or name in functions:
            yield from (place for place in changes(name, function) if _stands(place, text))


def _stands(place: Place, text: bytes) -> bool:
    """Whether what is changed is there: inside an f-string Python 3.11 does not know where its nodes stand."""
    old = text[place.begin : place.end].decode(errors="replace")
    if place.new.isdigit():
        return old.isdigit() and int(old) + 1 == int(place.new)
    return old in ("+", "-", "*", "/", "<", ">", "<=", ">=", "==", "!=")


def _functions(node: ast.AST, above: str) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Every function by its qualified name; what stands inside another counts to that one."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef):
            yield f"{above}{child.name}", child
        else:
            yield from _functions(child, f"{above}{child.name}." if isinstance(child, ast.ClassDef) else above)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("number", type=int, nargs="?", default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rooms", default="", help="these alone, separated by commas")
    parser.add_argument("--kind", choices=("all", "numbers", "read"), default="all", help="rooms of this kind")
    parser.add_argument("--evenly", choices=("yes", "no"), default="yes", help="from every room as many")
    parser.add_argument(
        "--tests", action="store_true", help="run the tests of its subject on what the product did not see"
    )
    parser.add_argument("--of", default="", help="the runs alone in which one of these words stands")
    parser.add_argument("--runs", type=int, help="so many of the runs alone, drawn by the seed")
    parser.add_argument("--kept", type=Path, help="a folder for what runs and tests do without an error")
    parser.add_argument("--again", type=Path, help="instead of a draw what was open in this log, once more")
    parser.add_argument("--log", type=Path, help="a file of JSON lines: every draw")
    parser.add_argument("-v", "--verbose", action="store_true")
    options = parser.parse_args()
    planted.warm()
    with tempfile.TemporaryDirectory() as beside:
        options.kept = (options.kept or Path(beside)).resolve()
        found = [*_found(options)]
        if options.tests:
            found = [*_with_tests(found, options)]
    rows = Counter((room_of(place.file), seen) for place, seen, _, _ in found)
    print(f"seed {options.seed}\n{table(rows)}")
    return 0


Drawn = tuple[Place, list[str]]  # runs that call its function
Found = tuple[Place, str, str, str]  # who saw it, in which run, what was said


def _found(options: argparse.Namespace) -> Iterator[Found]:
    """Every draw, as the product sees it."""
    product = _Product(Server(), kept_in(options.kept))
    for place, words in _again(options) if options.again else _drawn(product, options):
        found = (place, *product.seen(place, words))
        _tell(found, options)
        yield found


@dataclass
class _Product:
    """The product, and its runs."""

    server: Server
    kept: Kept
    runs: dict[str, Run] = field(default_factory=lambda: {run.words: run for run in runs()})
    cpu: dict[str, float] = field(default_factory=dict)

    def seen(self, place: Place, mine: list[str]) -> tuple[str, str, str]:
        """(who sees it, in which of the runs, what is said)."""
        seen, words, said = "no effect", "", ""
        for each in mine:
            run, right = self.runs[each], self.kept.right(self.server, self.runs[each])
            error = place.file, place.patched()
            wrong = self.server.outcome(run, self.kept.compiled, error, cpu=self.cpu.get(each, 0))
            now, reported = judged(wrong, right, seen)
            if now == "open" and self.server.outcome(run, self.kept.compiled) != right:
                continue  # it says another thing each time
            if now != seen:
                seen, words, said = now, each, reported
            if seen not in ("harmless", "no effect"):
                break
        return seen, words, said


def _drawn(product: _Product, options: argparse.Namespace) -> list[Drawn]:
    """The places, each with up to three runs that call its function, by lot: the likelier the shorter they take."""
    chosen, rng = list(product.runs.values()), random.Random(options.seed)
    if options.kind == "numbers":
        chosen = [run for run in chosen if not run.words.startswith(PAGES)]
    if options.of:
        chosen = [run for run in chosen if any(word in run.words for word in options.of.split(","))]
    chosen = random.Random(options.seed).sample(chosen, options.runs) if options.runs else chosen
    known = product.kept.calls(product.server, chosen)
    product.cpu |= {words: calls.cpu for words, (_, calls) in known.items()}
    called: dict[Function, list[str]] = defaultdict(list)
    for words, (_, calls) in sorted(known.items()):
        for function in calls.functions:
            called[function].append(words)
    names: dict[str, set[str]] = defaultdict(set)
    for file, name in sorted(called):
        if _requested(file, options):
            names[file].add(name)
    every = [(x, called[file, x.function]) for file, mine in names.items() for x in places(file, mine)]
    print(f"{len(every)} places in {len(names)} files, {len(known)} runs", flush=True)
    found = []
    for place, mine in drawn(every, options.number, rng, evenly=options.evenly == "yes"):
        weight = {words: rng.random() ** (0.3 + product.cpu[words]) for words in mine}
        found.append((place, sorted(mine, key=lambda words: -weight[words])[:MOST]))
    return found


def _again(options: argparse.Namespace) -> Iterator[Drawn]:
    """The open ones of a log once more, in the runs that showed them."""
    for line in options.again.read_text(encoding="utf-8").splitlines():
        row = json.loads(line)
        if row["seen"] == "open":
            mine = [x for x in places(row["file"], set()) if x.lines == (row["old"], row["new"])]
            if not mine:
                print(f"gone      {row['file']}: {row['old']}", flush=True)
            nearest = sorted(mine, key=lambda x: abs(x.line - row["line"]))
            yield from ((place, [row["run"]]) for place in nearest[:1])


def _requested(file: str, options: argparse.Namespace) -> bool:
    room, rooms = room_of(file), set(filter(None, options.rooms.split(",")))
    if rooms:
        return room in rooms
    wanted = {"all": True, "numbers": room not in READ, "read": room in READ}[options.kind]
    return wanted and not file.startswith(LEFT_OUT) and not any(word in file for word in APART)


def _tell(found: Found, options: argparse.Namespace) -> None:
    place, seen, words, said = found
    if options.verbose or seen == "open":
        print(f"{seen:9} {place.file}:{place.line} {place.what} [{words}] {said[:330]}", flush=True)
    if options.log:
        old, new = place.lines
        each = {"seed": options.seed, "seen": seen, "file": place.file, "line": place.line, "what": place.what}
        each |= {"old": old, "new": new, "run": words, "said": said[:2000]}
        with options.log.open("a", encoding="utf-8") as file:
            file.write(json.dumps(each) + "\n")


def _with_tests(found: list[Found], options: argparse.Namespace) -> Iterator[Found]:
    """With what the tests see of what the product does not."""
    mine = [place for place, seen, _, _ in found if seen == "open"]
    seen_by = iter(first_failing([(x.file, x.patched()) for x in mine], options.kept))
    for place, seen, words, said in found:
        test = next(seen_by) if seen == "open" else ""
        if test:
            print(f"tests     {place.file}:{place.line} {place.what} {test}", flush=True)
        yield place, "tests" if test else seen, words, test or said


def room_of(file: str) -> str:
    """The room of a file; what prints formulas is a room of its own, options belong to the verbs."""
    if file.startswith("symbolic/print"):
        return "symbolic/print"
    if file.startswith("cli"):
        return "verbs"
    return file.split("/")[0] if "/" in file else "doors"


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
    said = difference(wrong.out, right.out) or files_apart(dict(wrong.files), dict(right.files))
    return ("open", said) if said else ("harmless", "")


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
