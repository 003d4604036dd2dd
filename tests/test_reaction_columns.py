"""Reactions along a motion: what they are called, that every road gives the same numbers, and what is left open."""

from __future__ import annotations

import csv
import dataclasses
import pickle
import warnings
from math import cos, sin
from pathlib import Path
from random import Random

import numpy as np
import pytest
from cpu_limit import cpu_limit
from derivations import equations as equations_of
from derivations import moving
from moving import at
from slow_run import sampled, usual

import eomgen
from eomgen.documents.figures import over_time
from eomgen.equations import Equations
from eomgen.errors import DerivationError
from eomgen.mechanics.constraints.closure import Closure
from eomgen.mechanics.dynamics.accelerations import exact_accelerations
from eomgen.mechanics.free_bodies.names_of_reactions import NamedReaction
from eomgen.mechanics.free_bodies.solution import Indeterminate
from eomgen.mechanics.instant.quantities import Quantities
from eomgen.simulation.reaction_columns import ReactionColumns
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

MODELS = Path(__file__).parent.parent / "models"
UNPLACED = {"balancing_robot": "ahead", "delta_robot": "platform", "foucault_pendulum": "weight"}
"""Models with forces at no place, or bodies that nothing holds: reactions are refused, with what is to blame."""
HELD = [path for path in moving() if path.stem not in UNPLACED]


def derived(name: str) -> Equations:
    return eomgen.derive(eomgen.load(next(MODELS.rglob(f"{name}.toml"))))


def loaded(text: str, space: str = "plane"):
    return eomgen.loads(f'eomgen = 1\nname = "test"\nspace = "{space}"\n{text}')


WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, "-g"]\n'
BEAM = f"""
[parameters]
m = 2.0
M = 3.0
g = 9.81
[coordinates]
theta = 0.4
[points]
A = [0, 0]
B = [4, 0]
[bodies.beam]
mass = "M"
center = [2, 0]
inertia = 1
points = {{ A = [0, 0], B = [4, 0], C = [1, 0] }}
joint = {{ kind = "placed", at = [0, 0] }}
[bodies.bob]
mass = "m"
center = [0, -1]
inertia = 0
joint = {{ kind = "revolute", on = "beam.C", angle = "theta" }}
[constraints.A]
kind = "pin"
points = ["beam.A"]
[constraints.B]
kind = "pin"
points = ["beam.B"]
{WEIGHT}"""


@pytest.mark.parametrize(("name", "culprit"), UNPLACED.items())
def test_what_has_no_place_or_is_held_by_nothing_is_named(name, culprit):
    """a constraint between coordinates, a potential of coordinates, a body that geometry alone places"""
    with pytest.raises(DerivationError) as caught:
        NamedReaction.all_of(derived(name).reactions.balance)
    assert culprit in str(caught.value)


@sampled(2)
@pytest.mark.parametrize("path", HELD, ids=lambda path: path.stem)
def test_a_column_is_what_an_output_of_its_name_says(path):
    """reaction_x(B), reaction_n(wall), tension(rope, 2), drive(q): the same number, in the motion through a state."""
    equations = equations_of(path.stem)
    reactions, quantities = equations.reactions, Quantities(equations.system)
    state = Closure(equations.system.constraints).generic(Random(3))
    a = [
        fifty_digits().number(1) * float(value)
        for value in np.array(exact_accelerations(equations.graph, state), dtype=float)
    ]
    state |= dict(zip(equations.graph.symbols.a, a, strict=True))
    state |= multipliers_at(equations, state)
    for named in NamedReaction.all_of(reactions.balance):
        (call,) = parse(named.name, references=True).calls
        try:
            pair = reactions.combined(named.combination, named.name) + named.given, quantities.value(call)
        except Indeterminate:
            with pytest.raises(Indeterminate):
                quantities.value(call)
            continue
        a, b = evaluate(pair, state, fifty_digits())
        assert float(a) == pytest.approx(float(b), rel=1e-9, abs=1e-9), named.name


def multipliers_at(equations: Equations, state: dict) -> dict:
    """lam from J^T lam = M a - forcing at a state with its accelerations."""
    graph = equations.graph
    lam, a = graph.symbols.lam, np.array([float(state[x]) for x in graph.symbols.a])
    M, J = (np.array([at(row, state) for row in rows]) for rows in (graph.M, graph.J))
    values = np.linalg.lstsq(J.T, M @ a - at(graph.forcing, state), rcond=None)[0] if lam else []
    return {x: fifty_digits().number(1) * float(value) for x, value in zip(lam, values, strict=True)}


def states(equations: Equations, count: int = 6) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(t, x, p) of random states on the constraints."""
    symbols = equations.graph.symbols
    found = [Closure(equations.system.constraints).generic(Random(seed)) for seed in range(count)]
    rows = np.array([[float(state[s]) for s in (symbols.t, *symbols.x)] for state in found])
    p = np.array([float(found[0][s]) for s in symbols.parameters.values()])
    return rows[:, 0], rows[:, 1:], p


@pytest.mark.parametrize("path", usual(HELD, 3), ids=lambda path: path.stem)
def test_rank_in_numbers_and_elimination_in_symbols_give_the_same(path):
    """Columns (the bodies' equations by Q R at each state) against emitted code (solved on the graph): 1e-9.

    Of a third of the models, of all in the slow run.
    """
    equations = equations_of(path.stem)
    t, x, p = states(equations)
    columns = ReactionColumns(equations.reactions, equations.rhs("numpy"))
    found = dict(zip(columns.names, columns.along(t, x, p).T, strict=True))
    emitted = equations.reaction_rhs("numpy")
    assert set(columns.names) - set(emitted.names) == set(columns.indeterminate)
    for name, right in zip(emitted.names, emitted.many(t, x, p).T, strict=True):
        assert found[name] == pytest.approx(right, rel=1e-9, abs=1e-9), name
    assert all(np.isnan(found[name]).all() for name in columns.indeterminate)
    one = emitted(t[0], x[0], p)
    assert one == pytest.approx([found[name][0] for name in emitted.names], rel=1e-9, abs=1e-9)


def test_a_pendulum_is_held_by_its_weight_and_when_it_swings_by_more():
    """O_y = M g at rest; as it passes below with omega, M g + sum m_i s_i omega^2, and O_x = 0."""
    model = eomgen.load(MODELS / "double_pendulum.toml")
    p = model.numeric_parameters()
    m1, m2, l1, l2, g = (p[name] for name in ("m1", "m2", "l1", "l2", "g"))
    below = {"theta1": 0.0, "theta2": 0.0, "theta1'": 0.0, "theta2'": 0.0}
    rest = eomgen.simulate(model, time=1.0, samples=5, start=below)
    assert rest["reaction_y(arm1)"] == pytest.approx(np.full(5, (m1 + m2) * g))
    assert rest["reaction_y(arm2)"] == pytest.approx(np.full(5, m2 * g))
    swing = eomgen.simulate(model, time=0.0, samples=2, start=below | {"theta1'": 2.0, "theta2'": 3.0})
    pull = m2 * (g + l1 * 2.0**2 + l2 / 2 * 3.0**2)
    assert swing["reaction_y(arm2)"][0] == pytest.approx(pull)
    assert swing["reaction_y(arm1)"][0] == pytest.approx(pull + m1 * (g + l1 / 2 * 2.0**2))
    assert swing["reaction_x(arm1)"][0] == pytest.approx(0, abs=1e-12)


def test_a_position_where_a_formula_would_divide_by_zero_is_no_singular_one():
    """A ball on a wire at its lowest point: T = m g + m v^2/l, although the balance along x says nothing of T there."""
    run = eomgen.simulate(eomgen.load(MODELS / "seeds" / "ch16_p4.toml"), time=0.1, samples=3)
    assert run["tension(wire)"][0] == pytest.approx(9.81 + 6.5**2, rel=1e-9)
    assert run.remark == ""


def test_in_a_singular_position_only_what_is_open_has_no_value():
    """Cranks and coupler in one line: the forces along it are shared as one likes, those across it are not."""
    model = eomgen.load(MODELS / "parallelogram_reactions.toml")
    with pytest.warns(RuntimeWarning, match=r"singular positions, first at t = 0 s: reaction_x\(OA\)") as reported:
        run = eomgen.simulate(model, time=0.5, samples=26)
    assert len(reported) == 1
    along, across = (np.array([run[f"reaction_{axis}({joint})"] for joint in ("OA", "CB", "AB", "B")]) for axis in "xy")
    assert np.isnan(along[:, 0]).all() and np.isfinite(along[:, 1:]).all() and np.isfinite(across).all()
    assert across[:, 0] == pytest.approx(across[:, 1], rel=1e-2)  # and nothing jumps


def test_of_redundant_ties_the_determinate_part_is_given():
    """A beam on two pins: A_x and B_x are open, A_y + B_y and the moments are not: at rest A_y = M g/2 + 3 m g/4."""
    with pytest.warns(
        RuntimeWarning, match=r"Statically indeterminate: reaction_x\(A\), reaction_x\(B\)\."
    ) as reported:
        run = eomgen.simulate(loaded(BEAM), time=1.0, samples=11, start={"theta": 0.0})
    assert len(reported) == 1
    assert np.isnan(run["reaction_x(A)"]).all() and np.isnan(run["reaction_x(B)"]).all()
    assert run["reaction_y(A)"] == pytest.approx(np.full(11, (3.0 / 2 + 2.0 * 3 / 4) * 9.81))
    assert run["reaction_y(B)"] == pytest.approx(np.full(11, (3.0 / 2 + 2.0 * 1 / 4) * 9.81))


def test_what_drives_an_arm_is_a_column():
    """An arm that turns with theta = w t: drive = m g l cos(w t) + I theta'' = m g l cos(w t)."""
    model = loaded(f"""
[parameters]
m = 2.0
w = 1.5
g = 9.81
[coordinates]
theta = {{ motion = "w*t" }}
[bodies.arm]
mass = "m"
center = [0.5, 0]
inertia = 0.3
joint = {{ kind = "revolute", angle = "theta" }}
{WEIGHT}""")
    run = eomgen.simulate(model, time=2.0, samples=21)
    assert run["drive(theta)"] == pytest.approx(2.0 * 9.81 * 0.5 * np.cos(1.5 * run.t), abs=1e-9)
    assert run["reaction_x(arm)"] == pytest.approx(-2.0 * 0.5 * 1.5**2 * np.cos(1.5 * run.t), abs=1e-9)


def test_friction_stands_beside_the_normal_reaction():
    """Up a rough plane: N = m g cos(alpha), reaction_t = - mu N along the motion; down it, + mu N."""
    run = eomgen.simulate(eomgen.load(MODELS / "seeds" / "ch16_p6.toml"), time=2.0, samples=41)
    N, alpha = 9.81 * cos(np.pi / 6), np.pi / 6
    assert run["reaction_n(plane)"] == pytest.approx(np.full(len(run.t), N))
    stop = 5.0 / (9.81 * (sin(alpha) + 0.1 * cos(alpha)))
    sense = np.where(run.t < stop, 1.0, -1.0)
    away = np.abs(run.t - stop) > 1e-6
    assert np.abs(run["reaction_t(plane)"])[away] == pytest.approx(0.1 * N * np.abs(sense[away]))
    along = run["reaction_t(plane)"] * run["x'"]
    assert np.ptp(np.sign(along[away & (np.abs(run["x'"]) > 1e-6)])) == 0  # always against the sliding


def test_a_slack_wire_has_no_tension():
    """From the instant at which T = 0 on, until it is taut again, the column is 0, not nan."""
    run = eomgen.simulate(eomgen.load(MODELS / "seeds" / "ch16_p4.toml"), time=0.9, samples=91)
    slack = run.phases[0].end
    taut = run.phases[1].end if len(run.phases) > 1 else np.inf
    tension = run["tension(wire)"]
    assert len(run.phases) >= 2 and (tension[run.t < slack - 1e-3] > 0).all()
    assert (tension[(run.t > slack + 1e-9) & (run.t < taut - 1e-9)] == 0).all()


def test_where_nothing_holds_a_body_there_are_no_columns_and_the_summary_says_so():
    """`placed` is geometry: the equations of motion stand without reactions."""
    model = dataclasses.replace(eomgen.load(MODELS / "atwood.toml"), constraints={}, outputs={})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = eomgen.simulate(model, time=0.1, samples=3)
    assert not run.reactions and "No reactions: body 'left' is unsupported along y." in run.summary()
    with pytest.raises(DerivationError, match="unsupported"):
        eomgen.derive(model).reaction_rhs("numpy")


def test_a_force_on_a_point_that_wanders_in_its_body_is_refused():
    """The point P = (d, 0) of a turning arm, d a coordinate: what moves it there would carry part of the force."""
    model = loaded("""
[parameters]
m = 1.0
[coordinates]
a = 0.3
d = 0.2
[bodies.arm]
mass = "m"
inertia = 1
points = { P = ["d", 0] }
joint = { kind = "revolute", angle = "a" }
[bodies.block]
mass = "m"
inertia = 1
joint = { kind = "prismatic", at = [0, 2], axis = [1, 0], displacement = "d" }
[forces.push]
kind = "force"
point = "arm.P"
force = [1, 1]
""")
    with pytest.raises(DerivationError, match="the force 'push' acts on a point that a coordinate moves in its body"):
        eomgen.derive(model).reactions  # noqa: B018


def test_reactions_are_written_with_the_trajectory(tmp_path):
    """CSV, NPZ, pandas, repr and item access: a column each."""
    run = eomgen.simulate(eomgen.load(MODELS / "double_pendulum.toml"), time=0.2, samples=5)
    names = [f"reaction_{axis}(arm{k})" for k in (1, 2) for axis in "xy"]
    assert list(run.reactions) == names and list(run.columns())[-4:] == names
    assert {run.units[name] for name in names} == {"N"}
    run.to_csv(tmp_path / "run.csv")
    rows = list(csv.DictReader((tmp_path / "run.csv").open()))
    assert [float(row["reaction_y(arm2)"]) for row in rows] == run["reaction_y(arm2)"].tolist()
    run.to_npz(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz") as kept:
        assert kept["reaction_names"].tolist() == names
        assert (kept["reactions"][:, 1] == run["reaction_y(arm1)"]).all()
    pytest.importorskip("pandas")
    assert list(run.to_pandas().columns)[-4:] == names


@pytest.mark.parametrize(("name", "components"), [("chain20", 40), ("arm7", 42)])
def test_every_reaction_of_a_large_system_is_there_soon(name, components):
    """From the frozen model to all components on the graph and to their program, in processor time."""
    model = eomgen.load(MODELS / f"{name}.toml")
    with cpu_limit(10):  # 1 on a quiet machine
        equations = eomgen.derive(model)
        names, program = equations.reactions_program
    assert len(names) == components and program.count.total < 3 * equations.program.count.total


def test_a_picture_shows_the_largest_reactions_only(tmp_path):
    """40 hinge components of a chain: those of 5 hinges, with a word; forces and couples in panels of their own."""
    for name, words, panels in (
        ("chain20", "the largest, at 5 of 20 joints and constraints", 1),
        ("arm3", "reactions [N", 2),
    ):
        run = eomgen.simulate(eomgen.load(MODELS / f"{name}.toml"), time=0.2, samples=11)
        over_time(run, "", {}).save(tmp_path / f"{name}.svg")
        text = (tmp_path / f"{name}.svg").read_text()  # beside the outlines of a text its words
        assert words in text and text.count("reactions [N") == panels, name


def test_reactions_that_joints_alone_carry_wait_to_be_read_and_are_whole_where_they_leave(monkeypatch, tmp_path):
    """simulate: no balance solved; run[name], a pickle, a CSV: the columns that `simulator` gives when it is asked"""
    model, solved = eomgen.load(MODELS / "double_pendulum.toml"), []
    along = ReactionColumns.along
    monkeypatch.setattr(ReactionColumns, "along", lambda *given: solved.append(1) or along(*given))
    due = eomgen.simulator(model)(1.0, samples=7, columns=("reactions",))
    run = eomgen.simulate(model, time=1.0, samples=7)
    assert not solved and list(run.reactions) == list(due.reactions) and run.ok and "reaction_x(" in "".join(run.units)
    name = next(iter(run.reactions))
    assert run[name].tolist() == due[name].tolist() and len(solved) == 2
    run.to_csv(tmp_path / "run.csv")
    lines = (tmp_path / "run.csv").read_text().splitlines()
    assert name in lines[0] and len(lines) == 8 and len(solved) == 2
    fresh = eomgen.simulate(model, time=1.0, samples=7)
    again = pickle.loads(pickle.dumps(fresh))
    assert type(again.reactions) is dict and again.remark == ""
    assert all(again[x].tolist() == due[x].tolist() for x in due.reactions)
