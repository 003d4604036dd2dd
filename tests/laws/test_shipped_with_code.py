"""What is shipped beside code is proven too: test vectors by the symbols, an FMU's variables by their names."""

from __future__ import annotations

import io
import math
import zipfile
from dataclasses import replace

import pytest

import eomgen
from eomgen.codegen import written_files
from eomgen.codegen.targets.fmu import description
from eomgen.generated import generate
from eomgen.proof.emitted_code import fmu_reported

PENDULUM = """
eomgen = 1
space = "plane"
parameters = { m = 2, g = 9.81, l = 0.6 }
coordinates = { a = { start = 0.4, speed = 0.6 }, b = 0.1 }
inputs = { tau = "0.5*m" }
[bodies.upper]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "a", torque = "tau" }
[bodies.lower]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "upper.end", angle = "b" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
"""


@pytest.mark.parametrize("wrong", ["result", "tolerance"])
def test_a_test_vector_that_is_another_one_is_contradicted(wrong, monkeypatch):
    """M a = forcing + J^T lam with the a that is told."""
    right = written_files._vector

    def other(program, floats, state):
        found = right(program, floats, state)
        if found is None:
            return None
        changes = {"result": tuple(2 * x for x in found.result), "tolerance": 1.0}
        return replace(found, **{wrong: changes[wrong]})

    assert generate(eomgen.loads(PENDULUM), ["numpy"]).certify().ok
    monkeypatch.setattr(written_files, "_vector", other)
    failing = [c.name for c in generate(eomgen.loads(PENDULUM), ["numpy"]).certify().checks if c.ok is False]
    assert failing and all("test vectors" in name for name in failing)


def packed(text: str) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", text)
    return file.getvalue()


def test_the_variables_of_an_fmu_are_what_their_names_say():
    """der(x) is the derivative of x, which starts at x0."""
    text = description("pendulum", generate(eomgen.loads(PENDULUM), ["numpy"]).emitted)
    states, parameters = {"a": 0.4, "b": 0.1, "a'": 0.6, "b'": 0.0}, {"m": 2.0, "g": 9.81, "l": 0.6}
    parameters |= {"tau": 1.0}  # 0.5*m, where the model's own law begins
    assert fmu_reported(packed(text), states, parameters).ok
    turned = text.replace('derivative="1"', 'derivative="9"').replace('derivative="2"', 'derivative="1"')
    for other in (
        turned.replace('derivative="9"', 'derivative="2"'),
        text.replace('start="0.4"', 'start="0.1"'),
        text.replace('start="9.81"', 'start="2.0"'),
        text.replace('start="1.0"', 'start="0.0"'),
        text.replace(
            '<ContinuousStateDerivative valueReference="5"/>', '<ContinuousStateDerivative valueReference="1"/>'
        ),
    ):
        assert other != text and fmu_reported(packed(other), states, parameters).ok is False


CART = """
eomgen = 1
space = "plane"
parameters = { m = 2, F = 1.5 }
coordinates.x = 0
inputs = { pull = "2*F", push = { value = 4, unit = "N" }, wave = "3*cos(t)" }
[bodies.cart]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "pull + push + wave" }
"""


@pytest.mark.slow
def test_the_inputs_of_an_fmu_start_as_the_model_says_and_act_by_its_laws_until_one_is_set(tmp_path):
    """x(1) = (3 + 4)/4 + 3/2 (1 - cos 1); with pull = 5 set: x = (5 + 4 + 3)/4."""
    fmpy = pytest.importorskip("fmpy")
    (tmp_path / "cart.toml").write_text(CART)
    found = generate(eomgen.load(tmp_path / "cart.toml"), ["fmu"])
    (content,) = (content for path, content in found.texts.items() if path.endswith(".fmu"))
    (tmp_path / "cart.fmu").write_bytes(content)
    starts = {v.name: v.start for v in fmpy.read_model_description(str(tmp_path / "cart.fmu")).modelVariables}
    assert [float(starts[name]) for name in ("pull", "push", "wave")] == [3, 4, 3]
    for given, due in (({}, 7 / 4 + 1.5 * (1 - math.cos(1))), ({"pull": 5.0}, 3.0)):
        run = fmpy.simulate_fmu(str(tmp_path / "cart.fmu"), stop_time=1, start_values=given, output=["x"])
        assert run["x"][-1] == pytest.approx(due, rel=1e-8)
