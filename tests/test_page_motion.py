"""The page's own integrator and its constraints, run by node: orders measured, constraints kept, the motion that of
scipy's."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from slow_run import usual
from tools import needs, tool

import eomgen
from eomgen.codegen.targets.javascript import javascript_expression
from eomgen.page.player import PlayedRun, PlayerOptions

pytestmark = [pytest.mark.slow, needs("node")]

MODELS = Path(__file__).parent.parent / "models"
PLAYER = Path(eomgen.__file__).parent / "page" / "player"


def reported(text: str) -> Any:
    """What a module prints as JSON; it may import the player's modules from PLAYER."""
    text = text.replace("PLAYER", PLAYER.as_uri())
    command = [tool("node"), "--input-type=module", "-e", text]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


CIRCLE = """
import { integrated } from "PLAYER/integrator.mjs";
const rate = (t, x, dx) => { dx[0] = x[1]; dx[1] = -x[0]; };
const found = [1e-4, 1e-6, 1e-8, 1e-10].map(rtol => {
    const run = integrated(rate, Float64Array.of(0, 1), 10, { rtol, atol: rtol });
    const h = 10/run.steps, off = t => Math.abs(run.at(t)[0] - Math.sin(t));
    const between = run.t.slice(0, -1).map((t, k) => Math.max(...[0.3, 0.5, 0.8].map(s => {
        const whole = run.t[k + 1] - t, y = run.at(t), at = t + s*whole;
        return Math.abs(run.at(at)[0] - (y[0]*Math.cos(s*whole) + y[1]*Math.sin(s*whole)));
    })));
    return [h, off(10), Math.max(...between)];
});
console.log(JSON.stringify(found));
"""


def test_the_order_is_five_and_between_the_steps_four():
    """|x(10) - sin 10| ~ h^5; in a step from an exact state |x(t) - exact| ~ h^5, the local error of order 4."""
    rows = np.log(np.array(reported(CIRCLE)))
    at_end, between = ((rows[-1, k] - rows[0, k]) / (rows[-1, 0] - rows[0, 0]) for k in (1, 2))
    assert 4.6 < at_end < 6.2 and 4.6 < between < 5.6


def motion(name: str, given: dict[str, float], time: float, rtol: float) -> dict[str, Any]:
    """A model's motion by the page's programs in node: states at three instants, what is open of its constraints."""
    played = PlayedRun(eomgen.simulate(MODELS / f"{name}.toml", time=0.01), PlayerOptions(moves=True))
    live = played.live
    assert live is not None
    programs = ", ".join(f"{key}: {javascript_expression(program)}" for key, program in live.programs.items())
    values = [float(value) for value in played.phase.p]
    parameters = {key: value for key, value in given.items() if key in played.model.parameters}
    return reported(f"""
import {{ Motion }} from "PLAYER/motion.mjs";
const told = {json.dumps(live.reported())}, motion = new Motion(told, {{ {programs} }}, {json.dumps(values)});
motion.parametersSet({json.dumps(parameters)});
const run = motion.run({json.dumps(given)}, {{ time: {time}, rtol: {rtol} }});
const x = [0, {time / 2}, {time}].map(t => Array.from(motion.at(run, t)));
const open = Math.max(...run.t.flatMap(t => motion.ties.open(t, run.at(t))));
const names = [...told.phase.coordinates, ...told.phase.speeds];
console.log(JSON.stringify({{ x, names, open, message: run.message }}));
""")


@pytest.mark.parametrize(
    ("name", "given"),
    usual(
        [
            ("four_bar", {"a": 0.35, "alpha'": 2.0}),  # a loop, through its change of dependent coordinates
            ("slider_crank", {}),
            ("roller_racer", {}),  # rolling: rows without a gap
            ("bricard", {}),  # redundant rows
            ("space_manipulator", {}),  # quaternions
            ("quadrotor", {}),
            ("spatial_slider_crank", {}),
        ],
        3,
        2,
    ),
)
def test_the_motion_of_the_page_is_that_of_the_simulation(name, given):
    """Coordinates and speeds at three instants to 1e-7 of their size, constraints open by less than 1e-9."""
    model = eomgen.load(MODELS / f"{name}.toml")
    found = motion(name, given, 1.0, 1e-10)
    assert found["message"] == "" and found["open"] < 1e-9
    parameters = {key: value for key, value in given.items() if key in model.parameters}
    start = {key: value for key, value in given.items() if key not in model.parameters}
    right = eomgen.simulate(model, time=1.0, samples=[0, 0.5, 1.0], parameters=parameters, start=start, rtol=1e-11)
    columns = dict(zip(found["names"], np.array(found["x"]).T, strict=True))
    for key, column in zip(right.coordinates + right.speeds, right.x.T, strict=True):
        if key in columns:
            assert columns[key] == pytest.approx(column, abs=1e-7 * max(1, *abs(column))), key


def test_a_singular_position_is_no_place_to_go_on_from():
    """The n-four-bar falls through positions in which its constraints do not determine it: the page stops, and says
    so."""
    assert "singular position" in motion("n_four_bar", {}, 1.5, 1e-8)["message"]
