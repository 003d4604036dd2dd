"""Machines modelled from the reference alone, each beside numbers that share nothing with eomgen.

States of first order, dry friction, stops, impacts, tables, lengths of time, parts that repeat, mostly in pairs. The
models: tests/helpers/machines_of_strangers.toml. What they must give: the functions of the same names in
tests/helpers/oracles_of_jumps_and_states.py.
"""

from __future__ import annotations

import tomllib
import warnings
from pathlib import Path

import oracles_of_jumps_and_states as oracles
import pytest
from slow_run import sampled

import eomgen

MACHINES = tomllib.loads((Path(__file__).parents[1] / "helpers/machines_of_strangers.toml").read_text("utf-8"))
HEAD = 'eomgen = 1\nspace = "{space}"\n'


def model_of(name: str, folder: Path) -> eomgen.Model:
    machine = MACHINES[name]
    head = HEAD.format(space=machine["space"])
    for part, text in machine.get("files", {}).items():
        (folder / f"{part}.toml").write_text(head + text, encoding="utf-8")
    (folder / "model.toml").write_text(head + machine["model"], encoding="utf-8")
    return eomgen.load(folder / "model.toml")


def answers(model: eomgen.Model, time: float | None) -> dict[str, float]:
    """What the model asks, at the start; of a run its last state, that at its start (`M0`), impacts, ends of phases."""
    if time is None:
        found = eomgen.solve(model)
        return {name: found[name].value for name in found}
    run = eomgen.simulate(model, time=time, target="numpy")
    columns = run.columns()
    last = {name: column[-1] for name, column in columns.items()}
    first = {f"{name}0": column[0] for name, column in columns.items()}
    asked = {name: quantity.value for name, quantity in run.quantities.items()}
    hits = {f"t{k}": hit.t for k, hit in enumerate(run.impacts, 1)}
    impulses = {f"P{k}": hit.impulses[hit.contact] for k, hit in enumerate(run.impacts, 1)}
    ends = {f"end{k}": phase.end for k, phase in enumerate(run.phases, 1)}
    return first | last | asked | hits | impulses | ends


@sampled(7)
@pytest.mark.slow
@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_of_a_stranger_gives_the_numbers_found_without_us(name, tmp_path):
    """Of every output, to 1e-9; of a run, and of an instant found along it, 1e-6."""
    wanted = getattr(oracles, name)()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found = answers(model_of(name, tmp_path), MACHINES[name].get("run"))
    assert {key: found[key] for key in wanted} == pytest.approx(wanted, rel=1e-6, abs=1e-9)


def test_every_machine_has_its_oracle():
    assert all(callable(getattr(oracles, name, None)) for name in MACHINES) and len(MACHINES) == 39


@pytest.mark.slow
def test_an_output_just_after_an_impact_is_judged_just_after_it(tmp_path):
    """Of a pile z' = -(1 + e) mr/(mr + mp) sqrt(2 g h) after the blow, and 0 before it."""
    model = model_of("pile_driver_answers", tmp_path)
    assert eomgen.verify(model, "vp = -(1 + e)*mr/(mr + mp)*sqrt(2*g*h)").verdict == "right"
    assert eomgen.verify(model, "vp = 0").verdict == "wrong"
