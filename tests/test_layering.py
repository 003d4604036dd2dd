"""The house has rooms: a module imports only from rooms to its left, and nobody imports in a ring."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from quick_set import is_slow
from source_trees import house as house_of
from source_trees import tree_of

TESTS = Path(__file__).parent
PACKAGE = TESTS.parent / "eomgen"
IMPORTED = re.compile(r"^(?:from|import) eomgen\.(\w+)", re.M)
CHAIN = (
    ("version", "frozen", "doors"),
    ("errors",),
    ("files",),
    ("disk_cache", "resources"),
    ("symbolic",),
    ("model",),
    ("robots",),
    ("mechanics",),
    ("codegen",),
    ("simulation",),
    ("study",),
    ("proof",),
    ("scene",),
    ("documents",),
    ("results",),
    ("equations",),
    ("runs",),
    ("pipeline",),
    ("questions",),
    ("sensitivities",),
    ("sweeps",),
    ("identification", "exported"),
    ("generated",),
    ("page",),
    ("judge",),
    ("verbs",),
    ("language_server", "notebook"),
    ("living",),
    ("cli_options",),
    ("cli_common",),
    ("cli_runs",),
    ("cli",),
    ("__main__",),
)
FOLDERS = {  # of rooms that are divided further
    "symbolic": ("expression", "numeric", "print", "exact"),
    "mechanics": (
        "kinematics",
        "state",
        "constraints",
        "dynamics",
        "start",
        "free_bodies",
        "impacts",
        "statics",
        "integrals",
        "instant",
        "equilibrium",
        "linearization",
    ),
}
RANK = {room: rank for rank, rooms in enumerate(CHAIN) for room in rooms}


def module_names(package: Path) -> dict[str, Path]:
    """Every module of a package by its dotted name; a package is its __init__."""
    names = {}
    for path in sorted(package.rglob("*.py")):
        parts = (package.name, *path.relative_to(package).with_suffix("").parts)
        names[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return names


def statements(tree: ast.AST) -> Iterator[ast.stmt]:
    """All statements of a tree, those inside others too; expressions are not entered."""
    for part in ("body", "orelse", "finalbody", "handlers", "cases"):
        for node in getattr(tree, part, ()):
            yield node
            yield from statements(node)


@cache
def import_statements(path: Path) -> tuple[ast.Import | ast.ImportFrom, ...]:
    """All imports of a module, read once: at its top, inside functions, or for type checking only."""
    found = statements(tree_of(path))
    return tuple(node for node in found if isinstance(node, ast.Import | ast.ImportFrom))


def imported(name: str, path: Path, modules: dict[str, Path]) -> set[str]:
    """The package's modules that a module imports, at its top, inside functions, or for type checking only."""
    found = set()
    base = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in import_statements(path):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names if alias.name in modules}
        else:
            if node.level:
                above = base.split(".")[: len(base.split(".")) - node.level + 1]
                source = ".".join([*above, *([node.module] if node.module else [])])
            else:
                source = node.module or ""
            members = {f"{source}.{alias.name}" for alias in node.names}
            found |= members & modules.keys()
            if source in modules and not members <= modules.keys():
                found.add(source)
    return found - {name}


def room(name: str) -> str:
    """The room of a module: 'eomgen.symbolic.graph' stands in 'symbolic'."""
    return name.split(".")[1] if "." in name else ""


def wrong_ways(imports: dict[str, set[str]]) -> list[str]:
    """Imports that go to the right, or between two rooms of the same place in the chain."""
    wrong = []
    for name, targets in imports.items():
        for target in sorted(targets):
            here, there = room(name), room(target)
            if here == "" or here == there:  # the package's __init__ shows all rooms
                continue
            if there == "" or RANK[there] >= RANK[here]:
                wrong.append(f"{name} imports {target}")
    return wrong


def ring(imports: dict[str, set[str]]) -> list[str]:
    """A ring of imports, as the names along it, or []."""
    done: set[str] = set()
    path: list[str] = []

    def visit(name: str) -> list[str]:
        if name in path:
            return [*path[path.index(name) :], name]
        if name in done:
            return []
        path.append(name)
        for target in sorted(imports.get(name, ())):
            if found := visit(target):
                return found
        done.add(path.pop())
        return []

    for name in sorted(imports):
        if found := visit(name):
            return found
    return []


def folder(name: str) -> str:
    """Where a module stands: its folder inside a room, or itself where it stands in the room."""
    parts = name.split(".")
    return ".".join(parts[:3]) if len(parts) > 3 else name


def between_folders(imports: dict[str, set[str]]) -> dict[str, set[str]]:
    """The same arrows, drawn between folders."""
    found: dict[str, set[str]] = {}
    for name, targets in imports.items():
        found.setdefault(folder(name), set()).update({folder(t) for t in targets} - {folder(name), "eomgen"})
    return found


@pytest.fixture(scope="module")
def imports() -> dict[str, set[str]]:
    modules = module_names(PACKAGE)
    return {name: imported(name, path, modules) for name, path in modules.items()}


def test_every_module_stands_in_a_room(imports):
    """The rooms are those of the chain: a new one is a decision."""
    assert {room(name) for name in imports} - {""} <= RANK.keys()


def test_a_module_imports_only_from_rooms_to_its_left(imports):
    """errors < symbolic < model < mechanics < codegen < simulation < proof < documents, questions < pipeline < cli."""
    wrong = wrong_ways(imports)
    assert not wrong, "a room imports only from rooms before it: docs/architecture.md has their order"


@pytest.mark.parametrize("divided", FOLDERS)
def test_a_folder_of_a_room_imports_only_from_folders_to_its_left(imports, divided):
    """expression < numeric < print < exact, and so for every room that is divided."""
    rank = {folder: k for k, folder in enumerate(FOLDERS[divided])}
    folders = {name: name.split(".")[2] for name in imports if name.startswith(f"eomgen.{divided}.")}
    assert set(folders.values()) == rank.keys()
    wrong = [
        f"{name} imports {target}"
        for name, folder in folders.items()
        for target in imports[name] & folders.keys()
        if rank[folders[target]] > rank[folder]
    ]
    assert wrong == []


def test_no_modules_import_one_another_in_a_ring(imports):
    """The graph of imports has no cycle, those inside functions counted."""
    assert ring(imports) == []


def test_no_folders_import_one_another_in_a_ring(imports):
    """Inside a room, too, an arrow between two folders goes one way only, by whatever modules between."""
    assert ring(between_folders(imports)) == []


def test_a_ring_of_folders_is_seen():
    """a.x -> b.x and b.y -> a.y is no ring of modules, and one of folders."""
    arrows = {"eomgen.r.a.x": {"eomgen.r.b.x"}, "eomgen.r.b.y": {"eomgen.r.a.y"}}
    assert ring(arrows) == []
    assert ring(between_folders(arrows)) == ["eomgen.r.a", "eomgen.r.b", "eomgen.r.a"]


def test_an_import_to_the_right_is_seen(tmp_path):
    """A planted `from eomgen.cli import main` in symbolic, hidden in a function, is a wrong way."""
    (tmp_path / "eomgen" / "symbolic").mkdir(parents=True)
    (tmp_path / "eomgen" / "cli.py").write_text("")
    (tmp_path / "eomgen" / "symbolic" / "graph.py").write_text("def f():\n    from ..cli import main\n")
    modules = module_names(tmp_path / "eomgen")
    imports = {name: imported(name, path, modules) for name, path in modules.items()}
    assert wrong_ways(imports) == ["eomgen.symbolic.graph imports eomgen.cli"]


def test_a_ring_is_seen():
    """a -> b -> c -> a is a ring."""
    assert ring({"a": {"b"}, "b": {"c"}, "c": {"a"}}) == ["a", "b", "c", "a"]


DOORS = {  # rooms that are imported through what their stub names, and how many names others take: it may only fall
    "robots": 6,
    "scene": 30,
    "questions": 5,
    "runs": 16,
    "sensitivities": 4,
    "sweeps": 5,
    "identification": 3,
    "page": 6,
    "judge": 3,
    "verbs": 2,
    "living": 0,
    "language_server": 1,
    "codegen": 26,
    "simulation": 21,
    "documents": 130,
    "results": 15,
    "study": 16,
    "proof": 59,
    "model": 76,
    "mechanics.kinematics": 20,
    "mechanics.constraints": 14,
    "mechanics.dynamics": 19,
    "mechanics.start": 6,
    "mechanics.free_bodies": 23,
    "mechanics.impacts": 4,
    "mechanics.statics": 12,
    "mechanics.integrals": 8,
    "mechanics.instant": 8,
    "mechanics.equilibrium": 6,
    "mechanics.linearization": 10,
    "symbolic.expression": 76,
    "symbolic.numeric": 43,
    "symbolic.print": 25,
    "symbolic.exact": 40,
}


RATCHET = "; it may only fall: do without one, or raise it here, and say in the commit for which feature"


def given(package: str) -> set[str]:
    """The names in the stub of a package, each with the module that it comes from."""
    stub = PACKAGE.joinpath(*package.split(".")[1:], "__init__.pyi").read_text("utf-8")
    return set(re.findall(r"^from \S+ import (\w+) as \1$", stub, re.M))


def inside(name: str, package: str) -> bool:
    """True if a module is the package, or stands in it."""
    return f"{name}.".startswith(f"{package}.")


@pytest.mark.parametrize("own", DOORS)
def test_a_room_with_a_door_is_entered_by_its_door(own):
    """Others import from the package alone, only what its stub names; and all that it names is used.

    What only users and the command line ask for is not counted: a new command brings one name.
    """
    package = f"eomgen.{own}"
    used, by_rooms = given("eomgen"), set[str]()
    for name, path in module_names(PACKAGE).items():
        if inside(name, package) or name == "eomgen":
            continue
        for node in import_statements(path):
            if isinstance(node, ast.ImportFrom) and inside(node.module or "", package):
                names = {alias.name for alias in node.names}
                assert node.module == package and names <= given(package), (
                    f"{name}:{node.lineno} imports what {package}/__init__.pyi names, from {package} itself"
                )
                used |= names
                by_rooms |= set() if name.startswith("eomgen.cli") else names
    assert not given(package) - used, f"nobody takes this from {package}: leave it out of its stub"
    assert len(by_rooms) <= DOORS[own], f"names that rooms take from {package}{RATCHET}"


@pytest.mark.parametrize("own", DOORS)
def test_a_door_gives_no_name_of_a_module_of_its_room(own):
    """Of `documents.figures` and its function `figures` the door would give the module, once that is loaded."""
    folder = PACKAGE.joinpath(*own.split("."))
    stub = (folder / "__init__.pyi").read_text(encoding="utf-8")
    homes = {name: home for home, name in re.findall(r"^from (\S+) import (\w+) as \2$", stub, re.M)}
    modules = {path.stem for path in folder.iterdir()}
    assert {home for name, home in homes.items() if name in modules} <= {f"eomgen.{own}"}


def test_all_rooms_with_a_stub_have_a_door_here():
    """A stub beside `__init__` is a door, and a door is kept."""
    stubs = {path.parent.relative_to(PACKAGE) for path in PACKAGE.glob("*/**/__init__.pyi")}
    assert {".".join(folder.parts) for folder in stubs} == DOORS.keys()


def test_the_page_of_the_house_names_every_room_and_no_module_that_is_gone():
    """docs/architecture.md: a row for each room, in their order; every `room/module` there and in the theory exists."""
    docs = TESTS.parent / "docs"
    rooms = (docs / "architecture.md").read_text("utf-8").split("## The rooms")[1].split("\n## ")[0]
    named = [room for row in re.findall(r"^\| (`.*?) \|", rooms, re.M) for room in re.findall(r"`(\w+)`", row)]
    assert [RANK[room] for room in named] == sorted(RANK[room] for room in named)
    assert {*named, "__main__"} == RANK.keys()
    for page in ("architecture.md", "theory.md"):
        for place in re.findall(r"(?<!})`(\w+(?:/\w+)+)`", (docs / page).read_text("utf-8")):
            there = [PACKAGE / place, PACKAGE / f"{place}.py", TESTS.parent / place]
            assert any(path.exists() for path in there), f"{page} names {place}"


def test_sympy_is_not_imported_at_the_top_of_the_command_line():
    """`eomgen --help` answers without sympy: nothing that cli imports at its top imports sympy at its own."""
    modules = module_names(PACKAGE)
    if "eomgen.cli" not in modules:
        pytest.skip("no command line yet")
    seen, waiting = set(), ["eomgen", "eomgen.cli"]
    while waiting:
        name = waiting.pop()
        if name in seen:
            continue
        seen.add(name)
        tree = ast.parse(modules[name].read_text())
        for node in tree.body:
            if isinstance(node, ast.Import):
                heads = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and not node.level:
                heads = [node.module or ""] + [f"{node.module}.{alias.name}" for alias in node.names]
            else:
                heads = []
            assert not any(head.split(".")[0] == "sympy" for head in heads), f"{name} imports sympy at its top"
            waiting += [head for head in heads if head in modules]


def test_every_public_name_is_where_the_package_says():
    """`eomgen.derive` and all its neighbours are there on first use."""
    import eomgen

    assert all(getattr(eomgen, name) is not None for name in eomgen.__all__)


def test_every_room_has_quick_tests():
    """Each folder of the package is imported by a test that the quick set runs."""
    texts = (path.read_text(encoding="utf-8") for path in TESTS.rglob("test_*.py"))
    requested = {room for text in texts if not is_slow(text) for room in IMPORTED.findall(text)}
    rooms = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    assert rooms - requested == set()


@pytest.fixture(scope="module")
def house():
    """The house in figures, as `benchmarks/house.py` counts them."""
    return house_of()


def test_a_newcomer_has_no_more_to_know_than_was_reached(house):
    """Modules outside the seams, lines of the longest, modules of one importer, names of lower rooms used elsewhere."""
    assert len(house.chapters) <= 326, f"modules outside the seams{RATCHET}"
    assert max(m.lines for m in house.modules.values()) <= 700, "lines of a module: it is two"
    assert len(house.private) <= 38, f"modules that one other imports{RATCHET}"
    lower = ("symbolic", "model", "mechanics", "codegen", "simulation")
    assert len(house.taken_from(lower)) <= 444, f"names of lower rooms that others take{RATCHET}"
    assert {room: k for room in FOREIGN if (k := len(house.taken_by(room))) > FOREIGN[room]} == {}, (
        f"names that a room takes{RATCHET}"
    )


def test_readers_of_pages_share_nothing_with_their_writers(house):
    """What reads a page back imports of the rooms that write it only the other reader, and nothing that prints."""
    writers = ("documents", "page", "symbolic.print")
    readers = [house.modules[name] for name in ("documents.pages_read", "page.reports_read")]
    shared = {m.name: {source for source, _ in m.imports if source.startswith(writers)} for m in readers}
    assert shared == {"documents.pages_read": set(), "page.reports_read": {"documents.pages_read"}}


FOREIGN = {"documents": 150, "results": 179, "questions": 78, "verbs": 56, "proof": 120, "judge": 99}
"""room -> names that it takes from others, at most"""
OF_POSIX = {"resource", "fcntl", "pwd", "grp", "termios", "tty", "pty", "syslog"}
NAMED = re.compile(rf"\b(?:{'|'.join(sorted(OF_POSIX))})\b")  # only sources with such a word are parsed


def test_no_module_needs_what_only_posix_has():
    """An import of it stands in a `try`, or where it is used: else Windows cannot read a file, nor find a test."""
    for root in (PACKAGE, Path(__file__).parent):
        for path in root.rglob("*.py"):
            if not NAMED.search(path.read_text(encoding="utf-8")):
                continue
            tree = tree_of(path)
            names = {each.name for part in tree.body if isinstance(part, ast.Import) for each in part.names}
            names |= {part.module for part in tree.body if isinstance(part, ast.ImportFrom)}
            assert not names & OF_POSIX, path


READERS = {  # classes beside `Study` that cache more than two things derived of a model: how many, at most, and why
    "documents.reaction_values.Readings": (
        3,
        "reactions from one side of each joint, divisors of loads: seconds of algebra",
    ),
    "documents.scene_pictures.Sketch": (5, "a drawing, its frame and its points, which several pictures share"),
    "equations.Equations": (7, "texts and forms that a user asks again: printed, derived by its method, in sympy"),
    "generated.Generated": (7, "programs that several files are written of"),
    "judge.balances.Balances": (11, "states, the answer and its mistakes, for every number of mistakes that is tried"),
    "judge.case.Case": (10, "readings, mistakes and changed models that all equations of an author share"),
    "judge.comparison.Comparison": (5, "mistakes and their values, searched one, two, three at a time"),
    "judge.fixes.Authored": (5, "an equation taken apart, and its values at states"),
    "judge.mistakes.Mistakes": (3, "mistakes of the contributions, which every equation is compared with"),
    "mechanics.dynamics.pieces._Search": (4, "pieces, found state by state, and their switches"),
    "mechanics.dynamics.system.System": (3, "symbols, inputs, and the store of what stages find of it"),
    "mechanics.equilibrium.search._Search": (
        7,
        "static equations in stages, each of which compiles; places in numbers",
    ),
    "mechanics.free_bodies.friction._WithFriction": (
        5,
        "equilibrium of bodies with friction, solved in several stages",
    ),
    "mechanics.free_bodies.structure.Structure": (
        8,
        "the solution for all rows at once, its ranks, motions and self-stresses",
    ),
    "mechanics.free_bodies.velocity_plan.VelocityPlan": (4, "velocities of points, thousands of times"),
    "mechanics.impacts.equations.ImpactEquations": (6, "a jump that is solved once, and what is lost in it"),
    "mechanics.instant.kinematic_state.KinematicState": (6, "velocities and centres as formulas, seconds of algebra"),
    "mechanics.instant.mechanism.Mechanism": (4, "rigid blocks and their centres, for each pair of bodies"),
    "mechanics.instant.velocity_analysis.InstantKinematics": (5, "velocities, then accelerations, solved once"),
    "mechanics.kinematics.motion.Motion": (6, "points of bodies and their places, thousands of times"),
    "mechanics.linearization.modes.Modes": (
        8,
        "the characteristic polynomial, its roots, conditions and transfer functions",
    ),
    "mechanics.linearization.responses.ParameterSlopes": (
        3,
        "slopes of the reference, of M, C and K, and of A",
    ),
    "mechanics.linearization.reduction.Reducing": (4, "equations reduced at a state, entry by entry"),
    "page.report.Subject": (6, "a result for each section, derived where the report has it"),
    "proof.answers._Proof": (6, "states and checks of the equations, which all answers share"),
    "proof.at_a_state.NumericState": (6, "reactions and balances in numbers at one state"),
    "proof.free_bodies._Bodies": (6, "motion and loads of each body at one state"),
    "proof.free_bodies._Formulas": (4, "formulas that are evaluated at every state"),
    "proof.instant.NearbyStates": (3, "states a moment before and after"),
    "proof.instant._Proof": (4, "the motion found by another way, and its sizes"),
    "proof.motion.Leg": (3, "energies along one phase, and a store of columns"),
    "proof.printed.ReadBack": (6, "formulas read back from their print"),
    "proof.reported_cuts._Works": (3, "virtual works at every station"),
    "proof.structure._Proof": (6, "loads and balance of a structure in numbers"),
    "questions.outputs_answered._Solver": (
        4,
        "the linearization, the instant and the equilibrium, where an output needs them",
    ),
    "results.at_rest.result.Statics": (6, "values, sections and the derivation of a structure"),
    "results.at_rest.pictures.StaticScene": (4, "the picture of a structure, and its sizes"),
    "results.small_motions.result.Linearization": (3, "its derivation, its entries, and its matrices in sympy"),
    "runs.simulator.Simulator": (5, "equations that were derived at other values"),
    "scene.scene.Scene": (3, "the scalars of a frame and their program"),
    "sensitivities.derivatives._Asking": (3, "the small motions and the numbers that all derivatives need"),
    "simulation.columns._Columns": (7, "the program of all columns of a run"),
    "simulation.columns._Formulas": (3, "scalars and their refusals, filled while formulas are read"),
    "simulation.contacts.ContactEvents": (6, "signals and bounds, at every step"),
    "simulation.contacts.ContactSignals": (6, "signals at the last state, at every step"),
    "simulation.many_runs.ManyStarts": (6, "programs of the start of many runs"),
    "simulation.phase_model.PhaseModel": (9, "compiled functions of a phase, at every step"),
    "simulation.phase_models.DerivedAt": (6, "decisions that were taken at values of parameters"),
    "simulation.phase_models.PhaseModels": (3, "the phases of a motion by their contacts"),
    "simulation.reaction_columns.ReactionColumns": (6, "reactions of a whole run, solved at once"),
    "study.instant.CutState": (6, "the bodies at one instant, with every force"),
    "study.motion.MotionFromStart": (6, "phases, instants and runs of the motion from the start"),
    "sweeps.design.SweepPlan": (3, "the model of a plan, its design, and the slopes that are asked"),
}


def test_what_is_derived_of_a_model_is_cached_by_its_study_and_few_others(house):
    """Lazy properties, fields that begin empty and values recalled, of classes that hold a model or what holds one."""
    found = dict(house.bundles)
    assert found.pop("study.study.Study") == max(house.bundles, key=lambda each: each[1])[1]
    assert found.keys() == READERS.keys()
    assert {name: k for name, k in found.items() if k > READERS[name][0]} == {}


def test_a_bundle_is_seen_by_whatever_it_caches(house, tmp_path):
    """A lazy property, a field that begins empty, one of `__init__`, a recalled value: of what holds a model alone."""
    texts = {
        "fields": "c: Case\n    k: dict[str, int] = field(default_factory=dict)",
        "recalled": "c: Case\n    def f(self): return recalled(self, 1, g)",
        "begun": "def __init__(self, c: Case): self.k = {}",
        "lazy": "c: Case\n    @cached_property\n    def f(self): return 1",
        "numbers": "c: float\n    @cached_property\n    def f(self): return 1",
    }
    lazy = "".join(f"\n    @cached_property\n    def x{k}(self): return 1" for k in range(2))
    for name, text in texts.items():
        (tmp_path / f"{name}.py").write_text(f"class {name.title()}:\n    {text}{lazy}\n")
    (tmp_path / "case.py").write_text("class Case:\n    model: Model\n")
    found = house_of(tmp_path).bundles
    assert found == [(f"{name}.{name.title()}", 3) for name in ("begun", "fields", "lazy", "recalled")]


DERIVATIONS = {
    "accelerations_and_multipliers",
    "Equilibria.of",
    "assembled_by_recursion",
    "equations_of_motion",
    "outputs_of_state",
    "rates_and_extent",
    "Program.right_hand_side",
    "slopes_of",
    "StaticEquations.of",
    "System.of",
    "with_accelerations",
}
OF_THEIR_OWN = {  # what rooms above `study` derive themselves, and why
    ("documents.reaction_steps", "rates_and_extent"): "of the system that is shown",
    ("equations", "equations_of_motion"): "with the laws of what is driven by their names",
    ("equations", "System.of"): "with the laws of what is driven by their names",
    ("identification.proof_of_groups", "equations_of_motion"): "a proof, of other mass properties",
    ("page.live", "Program.right_hand_side"): "of the study's accelerations while it slides",
    ("page.animation", "System.of"): "of a structure that is pulled loose where it starts",
}
BELOW = ("symbolic", "model", "robots", "mechanics", "codegen", "simulation", "study", "proof")


def test_what_a_study_derives_is_asked_of_it(house):
    """Rooms above `study` call no function that it derives by, but where what they derive is another thing."""
    assert house.calls(DERIVATIONS, BELOW) == OF_THEIR_OWN.keys()
