"""Sixty-seven systems that nobody here had modelled, each beside numbers that share nothing with eomgen.

The models, as a reader of docs/reference writes them: tests/helpers/systems_of_strangers.toml. What they must give:
the function of the same name in tests/helpers/oracles_*.py. The list: docs/published_systems.md.
"""

from __future__ import annotations

import tomllib
import warnings
from collections.abc import Callable
from pathlib import Path

import oracles_at_rest_and_linkages
import oracles_of_machines
import oracles_of_motions
import pytest
from slow_run import sampled, usual

import eomgen

SYSTEMS = tomllib.loads((Path(__file__).parents[1] / "helpers/systems_of_strangers.toml").read_text(encoding="utf-8"))
ORACLES: dict[str, Callable[[], dict[str, float]]] = {
    name: found
    for module in (oracles_at_rest_and_linkages, oracles_of_motions, oracles_of_machines)
    for name, found in vars(module).items()
    if name in SYSTEMS
}
QUICK = ("sign_on_two_cables", "lazy_tongs", "pratt_truss", "space_truss", "screw_jack", "gate_with_water", "suslov")


def answers(model: eomgen.Model, run: dict[str, float] | None) -> dict[str, float]:
    """What the model asks, at the start; of a run, and its last state."""
    if run is None:
        found = eomgen.solve(model)
        return {name: found[name].value for name in found}
    found = eomgen.simulate(model, **run)
    last = {name: column[-1] for name, column in found.columns().items()}
    return last | {name: quantity.value for name, quantity in found.quantities.items()}


@sampled(2)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in usual([*SYSTEMS], 2)]
)
def test_a_system_of_a_stranger_gives_the_numbers_found_without_us(name):
    """Of every output, to 1e-9; of a run 1e-7."""
    system, wanted = SYSTEMS[name], ORACLES[name]()
    text = f'eomgen = 1\nspace = "{system["space"]}"\n{system["model"]}'
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found = answers(eomgen.loads(text), system.get("run"))
    assert wanted
    digits = 1e-7 if "run" in system else 1e-9
    assert {name: found[name] for name in wanted} == pytest.approx(wanted, rel=digits, abs=1e-12)
