"""Combinations of features against an oracle that shares nothing; the oracle is looked at by errors planted in it."""

from __future__ import annotations

import re
import sys
import tempfile
import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from each import each
from slow_run import beside, sampled, usual

sys.path.insert(0, str(Path(__file__).parent))

import calls
import compare
import cross
import laws
import solids
import structures
import taylor as ty
from covering import _row
from drawn import text_of
from features import FACTORS, FORBIDDEN, possible_pairs
from oracle import Oracle, State
from refusals import lacking

import eomgen
from eomgen.cli import main
from eomgen.cli_common import problems_of
from eomgen.model import constraints, forces, joints, shapes

pytestmark = pytest.mark.slow


UNDER_ANOTHER_NAME = {
    "pin": "four_bar", "equation": "gap", "hydraulic_cylinder": "hydraulic", "pneumatic_cylinder": "gas",
}  # a kind that is drawn by the level of another name  # fmt: skip


def test_every_kind_of_part_is_a_level_of_what_is_drawn():
    """A joint, constraint, force or shape enters the combinations on its first day, with a law of the oracle."""
    levels = {level for factor in FACTORS.values() for level in factor}
    oracle = (
        (joints, laws.JOINTS, "JOINTS of laws.py"),
        (constraints, laws.CONSTRAINTS, "CONSTRAINTS of laws.py"),
        (forces, laws.FORCES, "FORCES of laws.py"),
        (shapes, solids.FORMULAS, "FORMULAS of solids.py"),
    )
    lacking = []
    for seam, known, table in oracle:
        for kind in (cls.kind for cls in seam.ALL):
            if UNDER_ANOTHER_NAME.get(kind, kind) not in levels:
                lacking.append(f"'{kind}' is no level in features.py (how it is written: there or in drawn.py)")
            if kind not in known:
                lacking.append(f"'{kind}' has no law of the oracle: {table}")
    assert not lacking, "tests/combinations/: " + "; ".join(lacking)


PLAIN = {
    "space": "plane", "base": "turning", "loop": "none", "tie": "none", "closure": "multipliers", "joint": "revolute",
    "joint_with": "nothing", "shape": "given", "force": "gravity", "second_force": "none", "contact": "none",
    "speeds": "rates", "input": "none", "state": "none", "units": "none", "parameters": "numbers", "symbols": "plain",
    "output": "none",
}  # fmt: skip
IN_SPACE = ("cylindrical", "screw", "universal", "spherical", "quaternion")


@cache
def product(**levels: str) -> compare.Product:
    return compare.product_of(text_of(PLAIN | levels, 1))


TOGETHER = {"spring": "spring_damper", "damper": "spring_damper", "torque": "drive"}  # laws that a joint has together


def of_law(table: str, law: str) -> compare.Product:
    """A small model in which the law acts."""
    if table == "JOINTS":
        level = {"spherical": "quaternion"}.get(law, law)
        return product(joint=level, space="space" if level in IN_SPACE else "plane")
    if table == "CONSTRAINTS":
        constraints = {"equation": "points", "pin": "none"}
        space = "space" if law == "string" else "plane"
        return product(
            tie=constraints.get(law, law),
            loop="four_bar" if law == "pin" else "none",
            base="ground",
            space=space,
        )
    if table == "STATES":
        brought = {"chamber": "hydraulic", "slip": "tyre_wheel"}
        return product(force=brought[law], space="space") if law in brought else product(state="pushes")
    if table == "FORCES":
        return product(force=UNDER_ANOTHER_NAME.get(law, law), second_force="gravity")
    if table == "MOVING":
        return product(force="spring_moved", joint="prismatic")
    if table == "STICKING":
        return product(contact="sticking")
    if table == "IMPACTS":
        return product(contact="bouncing", output="equilibrium")
    if table == "FRICTION":
        return product(contact={"coulomb": "sliding", "viscous": "viscous"}[law])
    if law == "added_mass":
        return product(force=law, joint="planar")
    return product(joint_with=TOGETHER.get(law, law))


def planted(table: str, law: str) -> Callable:
    """The law with an error in it."""
    own: Callable = getattr(laws, table)[law]

    def joint(now: Any, j: dict) -> Any:
        R, d = own(now, j)
        return ty.matmul(R, ty.turn([0, 0, 1], ty.component(R, 1, 0) * 0.3 + ty.component(d, 0) * 0.3)), d * 1.3

    def constraint(name: str, constraint: dict, now: Any, o: Any) -> Any:
        (gap, rate, role), *rest = own(name, constraint, now, o)
        q = next(iter(now.q.values()))
        return [(gap + (q.rate() if rate else q * q) * 0.3, rate, role), *rest]

    def force(*arguments: Any) -> Any:
        found = own(*arguments)
        for load in found:
            load.force = None if load.force is None else -load.force
            load.torque = None if load.torque is None else -load.torque
            load.along = None if load.along is None else {q: -x for q, x in load.along.items()}
        return found

    def kinetic(*arguments: Any) -> Any:
        M, bias = own(*arguments)
        return 2 * M, 2 * bias

    if table == "STICKING":
        return lambda *arguments: 0.1 * own(*arguments)
    by_table = {"JOINTS": joint, "CONSTRAINTS": constraint, "FORCES": force}
    return by_table.get(
        table, kinetic if law in ("kinetic", "added_mass") else lambda *arguments: 1.5 * own(*arguments)
    )


STICKS = ("answers", "run")  # code and `reactions` have friction by the law of sliding
LAWS = [
    *(("JOINTS", law) for law in laws.JOINTS),
    *(("CONSTRAINTS", law) for law in laws.CONSTRAINTS),
    *(("FORCES", law) for law in laws.FORCES if law not in ("kinetic", "added_mass")),
    *(("EFFORTS", law) for law in ("spring", "damper", "torque")),
    ("ARMATURE", "armature"),
    ("ARMATURE", "added_mass"),
    *(("FRICTION", law) for law in laws.FRICTION),
    ("MOVING", "point"),
    ("STICKING", "least"),
    ("IMPACTS", "cone"),
    *(("STATES", law) for law in laws.STATES),
]


@sampled(3)
@pytest.mark.parametrize(("table", "law"), LAWS)
def test_an_error_in_each_law_of_the_oracle_is_noticed(monkeypatch, table, law):
    """Product and oracle agree; with the law wrong they do not."""
    known = of_law(table, law)
    parts = {"STICKING": STICKS, "IMPACTS": ("impacts",)}.get(table)
    held = (lambda: cross.across(known, parts=parts)) if parts else lambda: compare.against(known, seed=1)
    right = held()
    assert right.numbers > 0
    assert not right.faults
    assert not [x for x in right.skipped if x.startswith("oracle: ")]
    monkeypatch.setitem(getattr(laws, table), law, planted(table, law))
    wrong = held()
    assert wrong.faults or wrong.skipped != right.skipped


def test_every_level_stands_in_some_pair():
    """No level of a factor is forbidden with all of another factor."""
    pairs = possible_pairs()
    for factor, levels in FACTORS.items():
        for level in levels:
            others = {f for pair in pairs if (factor, level) in pair for f, _ in pair} - {factor}
            assert others == set(FACTORS) - {factor}, (factor, level)


@pytest.mark.parametrize("number", usual(range(12), 2))
def test_a_sample_of_combinations_moves_as_the_oracle_says(number):
    """Accelerations, determinate reactions and energies of the product are the oracle's; a refusal, after which another
    model is drawn, is one by name.
    """
    pairs = sorted(possible_pairs())
    rng = Random(number)
    for _ in range(20):
        row = _row(rng, dict(rng.choice(pairs)), set(pairs))
        if row is None:
            continue
        try:
            found = compare.of_model(text_of(row, number), number)
        except eomgen.EomgenError as error:
            assert not lacking(problems_of(error), text_of(row, number))
            continue
        assert not found.faults, (found.faults, row)
        return
    pytest.fail("every model that was drawn is refused")


REFUSED = {
    "modes beside what is driven": (
        {"base": "by_tie", "joint": "revolute"},
        lambda m: eomgen.linearize(m),
    ),
    "regressor with friction": ({"contact": "sliding"}, lambda m: eomgen.regressor(m)),
    "sensitivity of a motion in phases": (
        {"contact": "closed"},
        lambda m: eomgen.sensitivity(m, "b", "m", time=0.1, samples=2),
    ),
    "rest of what is pushed": (
        {"base": "sliding", "joint": "fixed", "force": "gravity"},
        lambda m: eomgen.statics(m),
    ),
    "energy of what is driven": (
        {"base": "by_formula", "joint": "prismatic"},
        lambda m: eomgen.simulate(m, time=0.1, samples=2, stabilization="energy"),
    ),
}


@each("what", REFUSED)
def test_a_refusal_names_an_object_its_place_and_what_to_do(what):
    """What cannot be asked of a model is refused by a name of the model, and with a fix."""
    levels, ask = REFUSED[what]
    text = text_of(PLAIN | levels, 1)
    model = eomgen.loads(text)
    with pytest.raises(eomgen.EomgenError) as reported:
        ask(model)
    assert not lacking(problems_of(reported.value), text)


EXPORTED = (
    {"space": "space", "joint": "revolute"},
    {"space": "space", "base": "sliding", "joint": "prismatic", "joint_with": "turned"},
    {"space": "space", "joint": "fixed", "shape": "box"},
)


@pytest.mark.parametrize("levels", EXPORTED, ids=lambda levels: levels["joint"])
def test_a_robot_written_and_read_again_moves_as_the_oracle_says_of_the_first(tmp_path, levels):
    """Kinetic energy, weight and accelerations of the imported model are the oracle's of the one that was exported."""
    text = text_of(PLAIN | levels | {"force": "gravity"}, 2)
    source, robot, again = tmp_path / "model.toml", tmp_path / "robot.urdf", tmp_path / "again.toml"
    source.write_text(text, encoding="utf-8")
    for words in (["export", str(source), "-o", str(robot)], ["import", str(robot), "-o", str(again)]):
        assert CliRunner().invoke(main, words).exit_code == 0
    first = Oracle(text, np.zeros(len(tomllib.loads(text)["coordinates"])))
    e = eomgen.derive(eomgen.load(again))
    rhs = e.rhs("numpy")
    assert e.coordinates == tuple(first.names)
    rng = Random(3)
    for _ in range(3):
        q, v = (np.array([rng.uniform(-1, 1) for _ in first.names]) for _ in range(2))
        want = first.solve(State(0.0, q, v)).a
        assert rhs(0.0, [*q, *v], rhs.p0, [0.0] * len(e.inputs))[len(q) :] == pytest.approx(want, rel=1e-6, abs=1e-6)


def test_parameters_identified_from_the_oracles_motion_are_those_of_the_model():
    """Of states and accelerations by the oracle least squares leave nothing: the groups have the model's values."""
    known = product(joint="prismatic", joint_with="spring_damper", space="space", force="force", input="expression")
    e, rng = known.equations, Random(5)
    oracle = Oracle(known.text, next(iter(known.functions.values())).x0[: len(e.coordinates)])
    rows = []
    for k in range(60):
        q, v = (np.array([rng.uniform(-1, 1) for _ in oracle.names]) for _ in range(2))
        rows.append([0.1 * k, *q, *v, *oracle.solve(State(0.1 * k, q, v)).a])
    names = ["t", *(q + mark for mark in ("", "'", "''") for q in oracle.names)]
    found = eomgen.identify(e.model, dict(zip(names, np.array(rows).T, strict=True)))
    assert found.residual < 1e-9
    assert found.certify().ok


FINDS = sorted((Path(__file__).parent / "finds").glob("*.toml"))


@sampled(2)
@pytest.mark.parametrize("path", FINDS, ids=lambda path: path.stem)
def test_what_was_found_stays_right(path):
    """Every find, as its smallest model, does what its first line says; an open one is known to fail."""
    text = path.read_text(encoding="utf-8")
    first, second = text.splitlines()[:2]
    kind, _, rest = first.removeprefix("# ").partition(": ")
    known = second.startswith("# open: ")
    try:
        EXPECTED[kind](text, rest)
    except (AssertionError, eomgen.EomgenError) as error:
        if not known:
            raise
        pytest.xfail(f"{second[2:]} ({str(error).splitlines()[0][:80]})")


def is_refused(text: str, words: str) -> None:
    with pytest.raises(eomgen.EomgenError, match=re.escape(words)):
        eomgen.derive(eomgen.loads(text)).rhs("numpy")


def answers_are(text: str, said: str) -> None:
    answers = eomgen.solve(eomgen.loads(text))
    for one in said.split(", "):
        name, _, value = one.partition(" = ")
        assert answers[name].value == pytest.approx(float(value), abs=1e-9)


def is_as_the_oracle_says(text: str, _: str) -> None:
    found = compare.of_model(text, 1)
    assert found.numbers
    assert not found.faults


def derives(text: str, _: str) -> None:
    equations = eomgen.derive(eomgen.loads(text))
    assert equations.certify().ok
    assert equations.render("text")


def is_not_answered(text: str, words: str) -> None:
    assert any(words in str(answer) for answer in eomgen.solve(eomgen.loads(text)).values())


def is_right_as_code(text: str, target: str) -> None:
    assert eomgen.generate(eomgen.loads(text), (target,)).certify().ok


def is_solved(text: str, _: str) -> None:
    answers = eomgen.solve(eomgen.loads(text))
    assert all(answer.answered for answer in answers.values())
    assert answers.certify().ok


def rests(text: str, _: str) -> None:
    found = eomgen.statics(eomgen.loads(text))
    assert found.places
    assert found.certify().ok


def holds_by_command(text: str, words: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        outcome = calls.by_command(text, words.split(), Path(folder))
    assert (outcome.code, outcome.fault) == (0, ""), outcome.detail


def lines_are_right(text: str, names: str) -> None:
    model = eomgen.loads(text)
    lines = [x.strip() for x in eomgen.derive(model).render("text").splitlines()]
    for name in names.split(", "):
        (line,) = (x for x in lines if x.startswith(f"{name} = "))
        assert eomgen.verify(model, line).verdict == "right"
        assert eomgen.verify(model, f"{line} + 1").verdict == "wrong"


EXPECTED: dict[str, Callable[[str, str], None]] = {
    "command": holds_by_command,
    "verified": lines_are_right,
    "refused": is_refused,
    "answers": answers_are,
    "oracle": is_as_the_oracle_says,
    "derives": derives,
    "unanswered": is_not_answered,
    "rests": rests,
    "code": is_right_as_code,
    "solved": is_solved,
}


@each("pair", [f for f in FORBIDDEN if f.refused])
def test_a_pair_that_cannot_be_is_refused_by_name(pair):
    """The message says what does not go together, names it, its place, and what to do."""
    levels = PLAIN | {"space": "space"} | dict([pair.one, pair.two])
    if ("tie", "string") in (pair.one, pair.two) and pair.one[0] != "space":
        levels["space"] = "plane"
    if pair.one == ("speeds", "omega") and pair.two[0] == "shape":
        levels["joint"] = "quaternion"
    text = compare.filled(text_of(levels, 1))
    with pytest.raises(eomgen.EomgenError) as reported:
        eomgen.derive(eomgen.loads(text)).rhs("numpy")
    assert pair.refused in str(reported.value)
    assert not lacking(problems_of(reported.value), text)


@pytest.mark.parametrize("number", [0, *beside(1), 2, 3])
def test_verbs_say_of_one_quantity_one_number(number):
    """`solve`, `reactions`, a run, small motions and inverse dynamics agree with the oracle, so with one another."""
    levels = [
        {"base": "by_formula", "loop": "on_base", "force": "spring", "closure": "dependent", "output": "kinematics"},
        {"joint": "prismatic", "joint_with": "spring_damper", "force": "spring", "output": "energies"},
        {"space": "space", "base": "sliding", "joint": "universal", "force": "gravity", "output": "reactions"},
        {"joint": "prismatic", "joint_with": "spring_damper", "force": "torsion_spring", "speeds": "declared"},
    ]
    found = cross.across(compare.product_of(text_of(PLAIN | levels[number], 1)))
    assert found.numbers > 10
    assert not found.faults


BROKEN = """
eomgen = 1
name = "A bead comes to an arc, beside a mass that swings fast"
space = "plane"
[parameters]
m = 1
k = 40000
[coordinates]
s = { start = 0.3, speed = 1 }
x = { start = 0.2, speed = 4 }
[inputs]
F = { value = { samples = [[0, 1], [0.2, 3]], between = "BETWEEN" }, unit = "N" }
[points]
wall = [-2, 0]
[bodies.bead]
shape = { kind = "particle", mass = "m" }
joint = { kind = "path", along = "s", pieces = [{ line = 0.5 }, { arc = 1, turn = "ccw", angle = 1 }] }
[bodies.mass]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[forces.spring]
kind = "spring"
points = ["wall", "mass.center"]
along = [1, 0]
stiffness = "k"
length = 2
[forces.push]
kind = "force"
point = "bead.center"
force = ["F", 0]
[outputs]
acc_s = "s''"
acc_x = "x''"
"""


@pytest.mark.parametrize("between", ["steps", "linear"])
def test_a_row_of_a_run_at_a_break_has_the_values_of_one_side(monkeypatch, between):
    """Where a path or an input changes its piece an acceleration has two values, and each is right; a row that mixes
    them is not, nor, at any instant, a row that is off by 1e-5 of its size.
    """
    known = compare.product_of(BROKEN.replace("BETWEEN", between))
    right = cross.across(known, parts=("run",))
    assert any("switch" in x for x in right.skipped)
    assert not right.faults
    run = eomgen.simulate(known.equations.model, time=0.6, samples=4)
    columns = {name: np.array(values) for name, values in run.columns().items()}
    at = next(i for i, x in enumerate(run.x) if abs(x[run.coordinates.index("s")] - 0.5) < 1e-9)
    oracle = Oracle(known.text, run.x[0][:2])
    s = State(float(run.t[at]), run.x[at][:2], run.x[at][2:])
    assert cross._beyond(oracle, s, oracle.solve(s), columns, at)
    columns["reaction_n(bead)"][at] *= 0.5
    assert not cross._beyond(oracle, s, oracle.solve(s), columns, at)
    own = laws.FORCES["spring"]

    def stiffer(*arguments: Any) -> Any:
        found = own(*arguments)
        for load in found:
            load.force = None if load.force is None else 1.00003 * load.force
        return found

    monkeypatch.setitem(laws.FORCES, "spring", stiffer)
    assert len({x for x in cross.across(known, parts=("run",)).faults if "acc_x" in x[1]}) > 1


@pytest.mark.parametrize("closure", ["multipliers", "dependent"])
def test_forces_that_accelerations_take_along_a_loop_are_the_oracles(monkeypatch, closure):
    """tau of J a + gamma = 0: along the crank, the rest by the constraints; an error of the oracle's masses is
    noticed."""
    known = product(loop="slider_crank", joint="prismatic", force="spring", closure=closure)
    right = cross.across(known, parts=("inverse",))
    assert right.numbers > 0
    assert not right.faults
    monkeypatch.setitem(laws.FORCES, "spring", planted("FORCES", "spring"))
    assert cross.across(known, parts=("inverse",)).faults


@pytest.mark.parametrize("kind", structures.KINDS)
def test_structures_at_rest_stand_as_the_balance_of_their_bodies_says(monkeypatch, kind):
    """Reactions by virtual work and by equilibrium, member forces, N, V and M; errors of the oracle are noticed."""
    text = structures.structure(kind, Random(f"{kind}2"))
    said = structures.reported(text)
    right = structures.compared(text, said)
    assert right.numbers > 0
    assert not right.faults
    balance = structures.Structure(text)
    known = {key.partition("(")[2].rstrip(")") for key in balance.reactions()}
    for name in {
        constraint["kind"] for constrained, constraint in balance.o.model.constraints.items() if constrained in known
    }:
        own = laws.CONSTRAINTS[name]
        with monkeypatch.context() as patch:
            patch.setitem(laws.CONSTRAINTS, name, lambda *x, own=own: [(gap * 1.3, *rest) for gap, *rest in own(*x)])
            assert structures.compared(text, said).faults
