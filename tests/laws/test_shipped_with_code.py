"""What is shipped beside code is proven too: test vectors by the symbols, an FMU's variables by their names."""

from __future__ import annotations

import io
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
    assert fmu_reported(packed(text), states, parameters).ok
    turned = text.replace('derivative="1"', 'derivative="9"').replace('derivative="2"', 'derivative="1"')
    for other in (
        turned.replace('derivative="9"', 'derivative="2"'),
        text.replace('start="0.4"', 'start="0.1"'),
        text.replace('start="9.81"', 'start="2.0"'),
        text.replace(
            '<ContinuousStateDerivative valueReference="5"/>', '<ContinuousStateDerivative valueReference="1"/>'
        ),
    ):
        assert other != text and fmu_reported(packed(other), states, parameters).ok is False
