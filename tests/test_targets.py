"""The contract of every target: emitted code, built and run, gives the symbols' numbers; and the files stand alone."""

from __future__ import annotations

import json
import math
import random
import re
import subprocess
import sys
import threading
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hand_made import cart_pole, motor, pendulum, spring_row, symbols, tied_pendulum
from slow_run import sampled
from tools import each_target, every_target, marked, needs, tool

import eomgen
from eomgen import files
from eomgen.codegen import build
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide
from eomgen.codegen.targets import ALL, wasm
from eomgen.codegen.targets.base import Description, Role
from eomgen.codegen.written_files import Written, outputs_at, single_vectors, texts_of, vectors
from eomgen.errors import DerivationError, UsageError
from eomgen.proof.emitted_code import unwritten
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

GOLDEN = Path(__file__).parent / "golden"
MODELS = Path(__file__).parent.parent / "models"
TEXTS = [target.name for target in ALL if target.name != "fmu"]  # an archive with a binary is no text
TARGETS = [target.name for target in ALL if target is not wasm.TARGET or build.compiler(wasm.COMPILER)]
KEPT = ["numpy", "c", "javascript"]  # whose reactions are kept as texts too
needs_cc = pytest.mark.skipif(build.compiler() is None, reason="no C compiler")
STRICT = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror"]


# -- values ---------------------------------------------------------------------------------------

UNARY = "neg sqrt sin cos tan asin acos atan sinh cosh tanh exp log abs sign".split()
BINARY = "add sub mul div pow atan2 min max less less_equal".split()


def one_of_each(g: Graph, a: Node, b: Node, positive: Node, unit: Node) -> dict[str, object]:
    """Every operation of the graph, at arguments in its domain."""
    within = {"sqrt": positive, "log": positive, "asin": unit, "acos": unit}
    by_op = {op: g.call(op, within.get(op, a)) for op in UNARY}
    by_op |= {"add": a + b, "sub": a - b, "mul": a * b, "div": a / positive, "pow": positive**b}
    by_op |= {op: g.call(op, a, b) for op in ("atan2", "min", "max", "less", "less_equal")}
    by_op |= {"power": a**11, "root": positive ** Fraction(2, 3), "minus power": positive**-3, "pi": g.pi * a}
    by_op |= {"select": g.select(g.call("less", a, b), a * 2, b / 3), "constant": g.sqrt(2) * a + g.sqrt(3) * g.pi}
    by_op |= {"thirds": Fraction(1, 3) * a - Fraction(22, 7) * b, "tiny": a * Fraction(1, 10**30), "number": 5}
    by_op |= {"sign by sign": g.call("sign", a) / (g.call("sign", b) * 2), "signs": -(a + b) * -(a - b)}
    return by_op | {"nested": g.call("min", g.call("max", a + b, a * b), g.call("abs", a - b) + 1)}


@every_target
def test_every_operation_of_the_graph_has_its_value(target):
    """|emitted(x) - symbols(x)| <= 1e-12, one output an operation, in one state and in many at once."""
    s = symbols("a b positive unit")
    formulas = one_of_each(s.graph, *s.q)
    assert {x.op for x in formulas.values() if isinstance(x, Node)} >= {*BINARY, *UNARY, "select"} - {"tan"}
    program = Program.of(list(formulas.values()), s)
    function = RightHandSide.of(program, target)
    rng = random.Random(1)
    states = [[rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(0.1, 3), rng.uniform(-1, 1)] for _ in range(25)]
    many = function.many(0, np.hstack([states, np.zeros((25, 4))]), [])
    for state, row in zip(states, many, strict=True):
        right = evaluate(program.outputs, dict(zip(s.q, state, strict=True)), FLOAT)
        found = function(0, [*state, 0, 0, 0, 0], [])
        for name, a, b, c in zip(formulas, right, found, row, strict=True):
            assert b == pytest.approx(float(a), rel=1e-12, abs=1e-12), name
            assert c == pytest.approx(float(a), rel=1e-12, abs=1e-12), name


def random_expression(rng: random.Random, g: Graph, leaves: list[Node], size: int):
    """A random expression of every op that has a value everywhere."""
    pool: list = [*leaves, 2, Fraction(1, 3), g.pi]
    for _ in range(size):
        a, b, c = rng.choices(pool[-12:] + leaves, k=3)
        kind = rng.randrange(12)
        if kind < 3:
            pool.append((a + b, a - b, a * b)[kind])
        elif kind == 3:
            pool.append(a / (1 + b * b))
        elif kind == 4:
            pool.append(g.select(g.call("less", a, b), b, c))
        elif kind == 5:
            pool.append(g.call("sqrt", 1 + a * a))
        elif kind == 6:
            pool.append(g.call("atan2", a, 1 + b * b))
        else:
            pool.append(g.call(rng.choice("sin cos tanh abs atan".split()), a))
    return pool[-4:]


@sampled(3)
@each_target
@pytest.mark.parametrize("seed", range(8))
def test_random_expressions_have_the_symbols_value(target, seed):
    """Inlining, hoisting, signs and parentheses change nothing: 1e-12 at random states and parameters."""
    rng = random.Random(seed)
    s = symbols("x y", "k m", "F")
    leaves = [*s.q, *s.parameters.values(), *s.inputs.values(), s.t]
    outputs = random_expression(rng, s.graph, leaves, 40)
    (own,) = random_expression(rng, s.graph, [s.t, *s.parameters.values()], 8)[-1:]
    program = Program.of(outputs, s, inputs={"F": own})
    function = RightHandSide.of(program, target)
    for given in (None, 0.7):
        t, x, p = rng.uniform(0, 1), [rng.uniform(-1, 1) for _ in range(4)], [rng.uniform(0.5, 2) for _ in range(2)]
        values = dict(zip([s.t, *s.q, *s.u, *s.parameters.values()], [t, *x, *p], strict=True))
        if given is not None:
            values[s.inputs["F"]] = given
        right = outputs_at(program, values, FLOAT)
        inputs = () if given is None else (given,)
        assert function(t, x, p, inputs) == pytest.approx(right, rel=1e-12, abs=1e-12)
        assert function.many([t], [x], p, inputs)[0] == pytest.approx(right, rel=1e-12, abs=1e-12)


SYSTEMS = {
    "pendulum": pendulum,
    "cart-pole": lambda: cart_pole(F=0),
    "row of springs, in a loop": lambda: spring_row(20),
    "tie": tied_pendulum,
    "constraint said three times": lambda: tied_pendulum(3),
    "states": motor,
}


@sampled(2)
@each_target
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_right_hand_side_agrees_with_fifty_digits(target, name):
    """dx of every way of solving: written out, looped, bordered, and bordered with dependent rows."""
    program = Program.right_hand_side(SYSTEMS[name]())
    function = RightHandSide.of(program, target)
    for v in vectors(program):
        found = function(v.t, v.x, v.p, v.inputs or ())
        assert np.abs(found - v.result).max() <= v.tolerance * max(1, *map(abs, v.result))


@each_target
def test_a_tie_said_three_times_moves_the_pendulum_as_one_does(target):
    """The accelerations are those of the independent rows."""
    x, p = [0.6, -0.8, 0.4, 0.3], [1.2, 1.0, 9.81]
    once, thrice = (RightHandSide.of(Program.right_hand_side(tied_pendulum(n)), target)(0, x, p) for n in (1, 3))
    assert thrice == pytest.approx(once, rel=1e-12)


@each_target
def test_the_pendulum_falls_as_it_should(target):
    """theta'' = -g/l sin(theta)."""
    found = RightHandSide.of(Program.right_hand_side(pendulum()), target)(0, [0.5, 2.0], [3.0, 0.5, 9.81])
    assert found == pytest.approx([2.0, -9.81 / 0.5 * math.sin(0.5)])


@each_target
def test_a_model_without_coordinates_runs(target):
    """nq = nu = 0: dx is empty."""
    function = RightHandSide.of(Program.of((), symbols("", "m")), target)
    assert function(0, [], [1.0]).shape == (0,) and function.many([0.0, 1.0], np.empty((2, 0)), [1]).shape == (2, 0)


@each_target
def test_outside_a_domain_the_value_is_not_a_number(target):
    """sqrt(-1) and 1/0 are no exceptions: nan and inf, as in C; the other outputs keep their values."""
    s = symbols("x", "k")
    x, k = s.q[0], s.parameters["k"]
    function = RightHandSide.of(Program.of([s.graph.sqrt(x), 1 / (x + 1), x * 2, 1 / k], s), target)
    with np.errstate(all="raise"):
        found = function(0, [-1.0, 0], [0.0])
    assert np.isnan(found[0]) and np.isinf(found[1]) and found[2] == -2 and np.isinf(found[3])


@sampled(2)
@every_target
def test_what_has_no_value_gives_none_to_what_is_made_of_it(target):
    """f(nan, b), f(a, nan), f(nan) are nan for every f, choices and comparisons too; what is not chosen counts not."""
    s = symbols("x y")
    g, (x, y) = s.graph, s.q
    lost = g.sqrt(x)
    made = {op: g.call(op, lost) for op in UNARY if op not in ("tan", "asin", "acos")}
    for op in BINARY:
        if op != "pow":
            made |= {f"{op} left": g.call(op, lost, y), f"{op} right": g.call(op, y, lost)}
    later = y + 1  # made after `lost`, and so the second argument of what has no order of its own
    made |= {f"{op} of what came first": g.call(op, lost, later) for op in ("min", "max", "less", "less_equal")}
    made |= {"chosen": g.select(g.call("less", x, y), lost, y), "by nothing": g.select(g.call("less", lost, y), x, y)}
    program = Program.of([*made.values(), g.select(g.call("less", y, x), lost, y)], s)
    function, state = RightHandSide.of(program, target), [-1.0, 2.0, 0.0, 0.0]
    symbols_say = evaluate(program.outputs, dict(zip(s.q, state, strict=False)), FLOAT)
    for found in (function(0, state, []), function.many([0.0], [state], [])[0], symbols_say):
        assert [name for name, value in zip(made, found, strict=False) if value == value] == [] and found[-1] == 2


@each_target
def test_vectors_hold_states_without_a_value(target, tmp_path):
    """min(sqrt(y), x) beside x + y: nan is expected where the root has no value, and what else there is."""
    s = symbols("x y")
    (x, y), g = s.q, s.graph
    program = Program.of([g.call("min", g.sqrt(y), x), x + y], s)
    found = vectors(program)
    partial = [v for v in found if math.isnan(v.result[0])]
    assert 1 <= len(partial) < len(found) and all(v.result[1] == pytest.approx(v.x[0] + v.x[1]) for v in partial)
    for v in found:
        assert RightHandSide.of(program, target)(v.t, v.x, v.p) == pytest.approx(v.result, rel=1e-12, nan_ok=True)
    texts = texts_of("roots", [(program, Description("Roots", "", {}, found))], targets=[target])
    written = Written(target, texts, program, "roots", Role.RHS, found)
    assert not [*unwritten(texts, [written])]
    others = [replace(v, result=tuple(2 * x for x in v.result)) for v in found]
    assert [*unwritten(texts, [replace(written, vectors=others)])] or target == "fmu", (
        "what is not written in a self-test is contradicted"
    )
    paths = files.write_all(tmp_path, texts)
    assert sum(row["dx"][0] is None for row in json.loads(paths[-1].read_text())["vectors"]) == len(partial)
    if target == "c":
        assert self_test(paths[0]).returncode == 0
        paths[0].write_text(paths[0].read_text().replace("a < b || a != a ? a : b", "fmin(a, b)"))
        assert "dx[0]" in self_test(paths[0]).stderr


def test_states_at_which_dependent_rows_contradict_each_other_are_no_test_vectors():
    """Four cranks, two rows follow from others: off the constraints no a satisfies J a + gamma = 0; none is told."""
    model = eomgen.load(MODELS / "four_cranks.toml")
    equations = eomgen.derive(model)
    graph, n = equations.graph, len(equations.program.symbols.u)
    symbols = graph.system.symbols
    for vector in json.loads(eomgen.generate(model, ("c",)).texts["test_vectors.json"])["vectors"]:
        values = dict(zip(symbols.parameters.values(), vector["p"], strict=True))
        values |= dict(zip((symbols.t, *symbols.x), (vector["t"], *vector["x"]), strict=True))
        a = np.array(vector["dx"][-n:])
        J = np.array([evaluate(row, values, FLOAT) for row in graph.J])
        open_by = J @ a + evaluate(graph.gamma, values, FLOAT)
        assert np.abs(open_by).max() < 1e-8 * np.abs(a).max()


@every_target
def test_names_of_the_language_are_harmless(target):
    """Keywords, functions, our own variables and Greek letters as names of coordinates and parameters."""
    s = symbols("int double t_ v1 solve_M M sin θ", "lambda I E x p c dx NULL printf é Math await rhs", "for inputs")
    arguments = [*s.q, *s.parameters.values(), *s.inputs.values()]
    outputs = [a + i * b for i, (a, b) in enumerate(zip(arguments, reversed(arguments), strict=True), start=2)]
    program = Program.of(outputs, s, inputs={"for": s.t, "inputs": 2 * s.t})
    values = [float(i) for i in range(len(s.q) * 2)], [0.5 + i for i in range(len(s.parameters))]
    function = RightHandSide.of(program, target)
    right = outputs_at(
        program,
        dict(zip([s.t, *s.q, *s.u, *s.parameters.values()], [0.25, *values[0], *values[1]], strict=True)),
        FLOAT,
    )
    assert function(0.25, *values) == pytest.approx(right)


@each_target
def test_threads_do_not_disturb_one_another(target):
    """The same function from several threads with different parameters."""
    function = RightHandSide.of(Program.right_hand_side(pendulum()), target)
    wrong = []

    def work(l: float) -> None:
        for i in range(300):
            found = function(0, [0.1 * i, 1.0], [1.0, l, 9.81])
            if abs(found[1] + 9.81 / l * math.sin(0.1 * i)) > 1e-12:
                wrong.append((l, i))

    threads = [threading.Thread(target=work, args=(1.0 + n,)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


@each_target
def test_results_are_the_callers_own(target):
    """A second call leaves the first one's array as it was; changed parameters are seen."""
    function = RightHandSide.of(Program.right_hand_side(pendulum()), target)
    p = np.array([1.0, 1.0, 9.81])
    first = function(0, [0.5, 2.0], p)
    kept = first.copy()
    p[2] = 1.0
    second = function(0, [0.5, 2.0], p)
    assert (first == kept).all() and second[1] == pytest.approx(-math.sin(0.5))


@each_target
def test_arguments_of_the_wrong_length_are_named(target):
    """What is wrong, how many there are, and which there should be."""
    function = RightHandSide.of(Program.right_hand_side(cart_pole(F=0)), target)
    right = [0.0] * 4, [1.0] * 4
    with pytest.raises(UsageError, match="x has 3 entries, not 4: x, theta, x', theta'"):
        function(0, [0.0] * 3, right[1])
    with pytest.raises(UsageError, match="p has 1 entries, not 4: M, m, l, g"):
        function(0, right[0], [1.0])
    with pytest.raises(UsageError, match="inputs has 2 entries, not 1: F"):
        function(0, *right, [1.0, 2.0])
    with pytest.raises(UsageError, match="not n x 4"):
        function.many(0, [[1.0, 2.0]], right[1])


def test_a_number_too_large_for_a_double_is_refused():
    """10^400 has no double."""
    s = symbols("x")
    with pytest.raises(DerivationError, match="too large"):
        RightHandSide.of(Program.of([s.q[0] * 10**400], s), "numpy")


# -- text and files -------------------------------------------------------------------------------


def described(program) -> Description:
    remarks = {"x": "[m] place of the cart */ /* ??/", "l": "[m]"}
    return Description("Cart-pole", "made by eomgen from models/cart_pole.toml", remarks, vectors(program))


def written(tmp_path, target, equations=None):
    program = Program.right_hand_side(equations or cart_pole(F=0))
    texts = texts_of("cart-pole", [(program, described(program))], targets=[target])
    return files.write_all(tmp_path / "new" / "folder", texts)


@marked(TEXTS)
def test_the_text_is_what_was_agreed(target, tmp_path):
    """Golden files: a change of the emitted text is a decision, not an accident."""
    for path in written(tmp_path, target):
        golden = golden_of(path, tmp_path / "new" / "folder", target)
        if path.name not in ("test_vectors.json", "README.md", "math.rs") and path.suffix != ".wasm":
            assert path.read_text() == golden.read_text(), f"look at the difference, then copy to {golden}"


def golden_of(path: Path, folder: Path, target: str) -> Path:
    """Where the agreed text of a file is kept."""
    name = "__".join(path.relative_to(folder).parts)
    return GOLDEN / "languages" / target / (f"{name}.txt" if path.suffix == ".py" else name)


def reactions_written(tmp_path, target):
    """Files of a double pendulum's right-hand side and reactions."""
    equations = eomgen.derive(eomgen.load(MODELS / "double_pendulum.toml"))
    names, reactions = equations.reactions_program
    description = Description("Double pendulum", "made by eomgen", {}, vectors(equations.program, seed=2))
    reported = replace(
        description, vectors=vectors(reactions), role=Role.REACTIONS, outputs=names, remarks=dict.fromkeys(names, "[N]")
    )
    emitted = reactions, reported
    texts = texts_of("double_pendulum", [(equations.program, description), emitted], targets=[target])
    return files.write_all(tmp_path, texts)


@pytest.mark.parametrize("target", KEPT)
def test_the_text_of_reactions_is_what_was_agreed(target, tmp_path):
    """Golden files of NAME_reactions beside those of NAME_rhs."""
    kept = [path for path in reactions_written(tmp_path, target) if "reactions" in path.name]
    assert kept
    for path in kept:
        golden = golden_of(path, tmp_path, target)
        assert path.read_text() == golden.read_text(), f"look at the difference, then copy to {golden}"


def test_every_golden_text_of_reactions_is_still_written(tmp_path):
    """The targets together write the golden files of NAME_reactions, none less."""
    texts = {path.name for target in KEPT for path in reactions_written(tmp_path / target, target)}
    golden = {path.name.removesuffix(".txt") for path in GOLDEN.rglob("*double_pendulum_reactions*")}
    assert golden == {name for name in texts if "reactions" in name}


@needs_cc
def test_reactions_and_right_hand_side_go_into_one_library(tmp_path):
    """No two functions of the same name: both files link together, and each passes its own test."""
    paths = reactions_written(tmp_path, "c")
    sources = [str(path) for path in paths if path.suffix == ".c"]
    command = [build.compiler(), *STRICT, "-shared", "-fPIC", *sources, "-o", str(tmp_path / "both.so"), "-lm"]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    for source in sources:
        assert self_test(Path(source)).returncode == 0


def test_test_vectors_of_reactions_have_their_names(tmp_path):
    """{"names", "vectors"} under "reactions", each vector with its result `out`, right by the file itself."""
    document = json.loads(reactions_written(tmp_path, "numpy")[-1].read_text())
    names = [f"reaction_{axis}(arm{k})" for k in (1, 2) for axis in "xy"]
    assert document["reactions"]["names"] == names
    assert all(len(row["out"]) == 4 for row in document["reactions"]["vectors"])
    check = (
        "import json, double_pendulum_reactions as f\n"
        "for v in json.load(open('test_vectors.json'))['reactions']['vectors']:\n"
        "    out = f.double_pendulum_reactions(v['t'], v['x'], v['p'], v['inputs'])\n"
        "    many = f.double_pendulum_reactions_many([v['t']], [v['x']], v['p'])[0]\n"
        "    scale = v['tolerance']*max(1, *map(abs, v['out']))\n"
        "    assert all(abs(a - c) <= scale for a, c in zip(out, v['out'], strict=True))\n"
        "    assert all(abs(a - c) <= scale for a, c in zip(many, v['out'], strict=True))\n"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", check], cwd=tmp_path, check=True)


@needs_cc
@pytest.mark.parametrize("name", SYSTEMS)
def test_the_c_files_compile_without_a_warning_and_pass_their_own_test(name, tmp_path):
    """-std=c99 -Wall -Wextra -pedantic -Werror; the self-test returns 0."""
    paths = written(tmp_path, "c", SYSTEMS[name]())
    done = self_test(paths[0])
    assert done.returncode == 0, done.stderr


@needs_cc
def test_a_remark_uses_no_argument(tmp_path):
    """What a comment names is not read: (void)t stands there all the same, and nothing warns."""
    program = Program.right_hand_side(pendulum())
    remarks = {"theta": "angle at t, from p and c, no inputs"}
    reported = Description("Pendulum", "", remarks, vectors(program))
    texts = texts_of("pendulum", [(program, reported)], targets=["c"])
    assert "(void)t;" in texts["pendulum_rhs.c"]
    assert self_test(files.write_all(tmp_path, texts)[0]).returncode == 0


@needs_cc
def test_the_self_test_notices_a_wrong_sign(tmp_path):
    """The sign of one product in the file turned: the self-test returns 1 and names the entry."""
    path = written(tmp_path, "c")[0]
    text = path.read_text()
    changed = re.sub(r"(const double v\d+ = .*)\+", r"\1-", text[text.index("_evaluate(") :], count=1)
    path.write_text(text[: text.index("_evaluate(")] + changed)
    done = self_test(path)
    assert done.returncode == 1 and "dx[2]" in done.stderr


def self_test(path: Path) -> subprocess.CompletedProcess:
    run = path.parent / "self_test"
    command = [build.compiler(), *STRICT, "-DEOMGEN_SELFTEST", str(path), "-o", str(run), "-lm"]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    return subprocess.run([str(run)], capture_output=True, text=True, check=False)


def node_test(folder: Path) -> subprocess.CompletedProcess:
    return subprocess.run([tool("node"), "--test"], cwd=folder, capture_output=True, text=True, check=False)


@needs("node")
def test_the_javascript_files_pass_their_own_test(tmp_path):
    """`node --test` finds the files of every way of solving and of reactions, and holds them against the vectors."""
    for name, made in SYSTEMS.items():
        written(tmp_path / name, "javascript", made())
    reactions_written(tmp_path / "reactions", "javascript")
    done = node_test(tmp_path)
    assert done.returncode == 0 and f"# pass {len(SYSTEMS) + 2}" in done.stdout, done.stdout


@needs("node")
def test_the_javascript_test_notices_a_wrong_sign(tmp_path):
    """The sign of one product turned: the test fails and names the entry."""
    path = written(tmp_path, "javascript")[0]
    path.write_text(re.sub(r"\(c\[0\] - (v\d)", r"(c[0] + \1", path.read_text()))
    done = node_test(path.parent)
    assert done.returncode == 1 and "dx[2]" in done.stdout


def test_the_python_file_needs_nothing_of_ours(tmp_path):
    """Imported where eomgen is not, it gives the numbers of its test vectors."""
    for made in SYSTEMS.values():
        folder = written(tmp_path, "numpy", made())[0].parent
        check = (
            "import json, sys; import cart_pole_rhs as f; assert 'eomgen' not in sys.modules\n"
            "for v in json.load(open('test_vectors.json'))['vectors']:\n"
            "    dx = f.cart_pole_rhs(v['t'], v['x'], v['p'], v['inputs'])\n"
            "    many = f.cart_pole_many([v['t']], [v['x']], v['p'], v['inputs'] and [v['inputs']])[0]\n"
            "    scale = max(1, *map(abs, v['dx']))\n"
            "    assert all(abs(a - b) <= v['tolerance']*scale for a, b in zip(dx, v['dx'], strict=True))\n"
            "    assert all(abs(a - b) <= v['tolerance']*scale for a, b in zip(many, v['dx'], strict=True))\n"
        )
        subprocess.run([sys.executable, "-W", "error", "-c", check], cwd=folder, check=True)


def test_vectors_in_single_precision_have_no_number_below_its_range():
    """1e-51 is 0 in them: as 1e-51f it stops a strict compiler; nan stays."""
    s = symbols("x")
    program = Program.of([s.q[0] * Fraction(1, 10**51), s.q[0] * 2], s)
    plain = vectors(program)
    found = single_vectors(program, plain)
    assert any(0 < abs(v.result[0]) < 1e-45 for v in plain) and all(v.result[0] == 0 for v in found)
    assert [v.result[1] for v in found] == [v.result[1] for v in plain]


def test_test_vectors_say_what_they_are(tmp_path):
    """Names in order; half of the vectors with inputs of their own."""
    document = json.loads(written(tmp_path, "c")[-1].read_text())
    assert document["coordinates"] == ["x", "theta"] and document["speeds"] == ["x'", "theta'"]
    assert document["parameters"] == ["M", "m", "l", "g"] and document["inputs"] == ["F"]
    assert [row["inputs"] is None for row in document["vectors"]] == [*[True, False] * 3, True]
    assert document["vectors"][-1]["x"] == [0.0] * 4
    assert all(row["tolerance"] == 1e-12 for row in document["vectors"])


def test_files_of_several_targets_lie_each_in_a_folder_of_its_own(tmp_path):
    """One target writes into DIR, several into DIR/X/, each with the same test vectors."""
    program = Program.right_hand_side(pendulum())
    one, several = (
        files.write_all(tmp_path / str(len(names)), texts_of("p", [(program, described(program))], targets=names))
        for names in (TARGETS[:1], TARGETS)
    )
    assert {path.parent for path in one} == {tmp_path / "1"}
    assert {path.relative_to(tmp_path / str(len(TARGETS))).parts[0] for path in several} == set(TARGETS)
    texts = [path.read_text() for path in (*one, *several) if path.name == "test_vectors.json"]
    assert len(texts) == 1 + len(TARGETS) and len({*texts}) == 1
    for path in one:
        assert path.read_text() == (tmp_path / str(len(TARGETS)) / TARGETS[0] / path.name).read_text()


def test_an_unknown_target_is_refused_with_those_that_there_are():
    """fix: the names of ALL."""
    with pytest.raises(UsageError, match="numpy, c"):
        RightHandSide.of(Program.right_hand_side(pendulum()), "algol")
