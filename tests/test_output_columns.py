"""Outputs as columns of a run: each is what `solve` answers at that instant, by another way; all cost one motion."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from slow_run import sampled, usual

import eomgen
from eomgen.model.fields import Table
from eomgen.proof.reported_run import output_columns_hold
from eomgen.simulation.columns import formulas_of

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[1] / "models"
WHEN = 0.37

SYSTEMS = """
atwood balancing_robot ball_on_turntable bead_on_turning_hoop block_on_wedge box_on_two_feet cardan_shaft cart_pole
chaplygin_sleigh double_atwood dual_spin_satellite elastic_pendulum flyball_governor four_bar furuta_pendulum
gimbal_gyroscope golf_ball_in_cup gyrostat heavy_top n_four_bar puma560 quadrotor quick_return robot_with_trailer
rolling_disc_and_bar rough_incline scotch_yoke simple_pendulum skate_on_slope slewing_crane slider_crank
sliding_ladder snakeboard space_manipulator spatial_four_bar spatial_slider_crank spherical_pendulum tower_crane
two_mass_oscillator
""".split()


def asking(model: eomgen.Model, **formulas: str) -> eomgen.Model:
    """A model that asks these alone."""
    return replace(model, outputs=Table({name: eomgen.Output(value=text) for name, text in formulas.items()}))


def instants(model: eomgen.Model, when: float) -> dict[str, float | None]:
    """What `solve` answers of the same formulas at an instant [SI]."""
    at = {name: eomgen.Output(value=x, at=f"t = {when}") for name, x in formulas_of(model).items()}
    return {name: answer.value for name, answer in eomgen.solve(replace(model, outputs=Table(at))).items()}


@sampled(3)
@pytest.mark.parametrize("name", usual([*SYSTEMS], 3))
def test_a_column_is_what_solve_answers_at_the_instant(name: str):
    """Compiled programs over all rows against closed forms, energy theorem and exact balance at t = 0.37 s."""
    model = eomgen.load(MODELS / f"{name}.toml")
    run = eomgen.simulate(model, time=WHEN, samples=11, rtol=1e-12, atol=1e-12)
    answers = instants(model, WHEN)
    assert run.outputs and run.outputs.keys() == answers.keys()
    for output, value in answers.items():
        assert value is not None, output
        assert run.outputs[output][-1] == pytest.approx(value, rel=1e-7, abs=1e-7), output


def test_an_output_has_its_phase_s_own_equations():
    """On the free ladder the wall carries nothing, and theta'' has no wall in it."""
    model = asking(
        eomgen.load(MODELS / "sliding_ladder.toml"),
        N="reaction_n(wall)",
        e="epsilon(ladder)",
        q="theta''",
        H="2*reaction_n(wall)+1",
    )
    run = eomgen.simulate(model, time=1, samples=101)
    opened = run.phases[0].end
    before, after = run.t < opened, run.t > opened
    assert 0 < opened < 1
    assert np.all(run["N"][before] > 0) and np.all(run["N"][after] == 0) and np.all(run["H"][after] == 1)
    assert run["N"] == pytest.approx(run["reaction_n(wall)"])
    assert np.abs(run["e"]) == pytest.approx(np.abs(run["q"]))
    assert run.phases[0].last["N"] == pytest.approx(0, abs=1e-6)


def test_momenta_are_those_of_the_freedoms_that_the_model_declares():
    """p = dT/dq' over the one freedom of a four-bar, whose run is integrated over all rates: p q' = 2 T."""
    model = asking(eomgen.load(MODELS / "four_bar.toml"), p="momentum(alpha)", T="kinetic_energy()", w="alpha'")
    run = eomgen.simulate(model, time=1, samples=21)
    assert run["p"] * run["w"] == pytest.approx(2 * run["T"], rel=1e-9)


def test_what_has_no_single_value_is_nan_and_the_rest_stays():
    """At the flat position of a parallelogram its hinges share the load along it; the couples at rest do not."""
    model = eomgen.load(MODELS / "parallelogram_reactions.toml")
    run = eomgen.simulate(asking(model, along="reaction_x(AB)", across="reaction_y(AB)"), time=0.2, samples=5)
    assert run["along"] == pytest.approx(run["reaction_x(AB)"], nan_ok=True)
    assert np.isnan(run["along"][0]) and np.isfinite(run["across"]).all()


def test_what_is_never_determined_is_said_and_has_no_column():
    model = asking(eomgen.load(MODELS / "box_on_two_feet.toml"), t="reaction_t(left)", n="reaction_n(left)")
    run = eomgen.simulate(model, time=0.1, samples=3)
    assert list(run.outputs) == ["n"]
    assert "No column of 't': reaction_t(left) is statically indeterminate" in run.remark


def test_columns_are_written_with_their_units(tmp_path: Path):
    text = (MODELS / "cart_pole.toml").read_text(encoding="utf-8")
    text = text.replace("[outputs]", '[outputs]\ntheta = { value = "theta", unit = "deg" }\nv = "speed(pole.end)"\n')
    model = eomgen.loads(text)
    run = eomgen.simulate(model, time=0.2, samples=3)
    assert run["theta (output)"] == pytest.approx(run["theta"])
    run.to_csv(tmp_path / "plain.csv")
    head = next(csv.reader((tmp_path / "plain.csv").open()))
    assert {"theta (output)", "v", "hinge_x"} <= set(head)

    run.to_csv(tmp_path / "units.csv", model.units_of(run.columns()))
    head, first, *_ = csv.reader((tmp_path / "units.csv").open())
    assert {"theta (output) [deg]", "v [m/s]", "hinge_x [N]"} <= set(head)
    assert float(first[head.index("theta (output) [deg]")]) == pytest.approx(np.degrees(run["theta"][0]))
    assert "v" in run.to_pandas()
    run.to_npz(tmp_path / "run.npz")
    assert list(np.load(tmp_path / "run.npz")["output_names"]) == list(run.outputs)
    run.plot(tmp_path / "outputs.png", "outputs")


def test_the_proof_sees_a_wrong_column():
    model = eomgen.load(MODELS / "cart_pole.toml")
    run = eomgen.simulate(model, time=0.5, samples=11)
    assert all(check.status == "holds" for check in output_columns_hold(run, formulas_of(model)))
    wrong = replace(run, outputs={**run.outputs, "hinge_x": run.outputs["hinge_x"] * (1 + 1e-6)})
    checks = {check.name: check for check in output_columns_hold(wrong, formulas_of(model))}
    reported = checks["columns of outputs are those of the formulas"]
    assert reported.status == "fails" and "hinge_x" in reported.detail


def test_a_simulator_gives_the_columns_that_are_asked():
    """Outputs by name, formulas as they are typed, reactions; at other parameters by the same programs."""
    model = eomgen.load(MODELS / "cart_pole.toml")
    run = eomgen.simulator(model)
    assert run(0.2, samples=3).outputs == {} and run(0.2, samples=3).reactions == {}
    found = run(0.2, samples=3, columns=("x_tip", "2*theta''", "reaction_x(pole)"))
    assert list(found.outputs) == ["x_tip", "2*theta''"] and list(found.reactions) == ["reaction_x(pole)"]
    assert list(run(0.2, samples=3, columns="outputs").outputs) == list(model.outputs)
    name = next(iter(model.parameters))
    heavy = run(0.2, {name: 7}, samples=3, columns=("hinge_x", "x_tip"))
    fresh = eomgen.simulate(model, time=0.2, parameters={name: 7}, samples=3)
    assert heavy["hinge_x"] == pytest.approx(fresh["hinge_x"]) and heavy["x_tip"] == pytest.approx(fresh["x_tip"])
    with pytest.raises(eomgen.UsageError, match="no column 'thetaa'"):
        run(1, columns=["thetaa"])


def test_forty_outputs_cost_one_motion():
    """As many steps and evaluations as without any."""
    model = eomgen.load(MODELS / "double_pendulum.toml")
    formulas = {f"o{k}": f"{k}*reaction_x(rod2) + acceleration(rod2.end)" for k in range(40)}
    bodies = list(model.bodies)
    formulas = {name: text.replace("rod2", bodies[1]) for name, text in formulas.items()}
    many = eomgen.simulate(asking(model, **formulas), time=1, samples=11)
    none = eomgen.simulate(replace(model, outputs=Table({})), time=1, samples=11)
    assert (many.steps, many.evaluations) == (none.steps, none.evaluations)
    assert np.array_equal(many.x, none.x)
    first, second = many["o1"], many["o39"]
    assert second - first == pytest.approx(38 * many[f"reaction_x({bodies[1]})"])
