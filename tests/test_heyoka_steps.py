"""heyoka's Taylor series as the method of a run: the same motion as by DOP853, proven alike, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hand_made import PUSHED
from tools import needs

import eomgen
from eomgen.errors import UsageError
from eomgen.simulation.compiled_steps import smooth

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"
needs_heyoka = needs(".heyoka", what="heyoka")


@needs_heyoka
@pytest.mark.parametrize("name", ["double_pendulum", "tumbling_body", "loop_the_loop"])
def test_taylor_series_give_the_motion_that_dop853_gives(name):
    """|x - x'| <= 1e-6 at all instants between the steps too; the same columns; the run is proven."""
    by_series = eomgen.simulate(MODELS / f"{name}.toml", time=2, samples=401, method="heyoka")
    by_stages = eomgen.simulate(MODELS / f"{name}.toml", time=2, samples=401, method="DOP853")
    assert by_series.status == "finished"
    assert np.allclose(by_series.x, by_stages.x, rtol=1e-6, atol=1e-6 * np.max(np.abs(by_stages.x)))
    assert [*by_series.reactions, *by_series.outputs] == [*by_stages.reactions, *by_stages.outputs]
    certificate = by_series.certify()
    assert certificate.ok, str(certificate)


@needs_heyoka
def test_taylor_series_stop_at_an_event():
    """theta falls through zero at a quarter of the period, T = 4 K(sin(theta0/2)) sqrt(l/g)."""
    from scipy.special import ellipk

    model = eomgen.load(MODELS / "simple_pendulum.toml")
    run = eomgen.simulate(model, time=10, method="heyoka", until="theta = 0")
    values = dict(zip(run.coordinates, run.x[0], strict=False))
    rhs = eomgen.derive(model).rhs("numpy")
    p = dict(zip(rhs.parameters, rhs.p0, strict=True))
    quarter = ellipk(np.sin(values["theta"] / 2) ** 2) * np.sqrt(p["l"] / p["g"])
    assert run.t[-1] == pytest.approx(quarter, rel=1e-8)


@pytest.mark.parametrize(
    ("model", "why"),
    [
        (lambda: eomgen.load(MODELS / "bricard.toml"), "solve a linear system"),
        (lambda: eomgen.loads(PUSHED), "made of pieces"),
    ],
    ids=["dependent constraints", "samples"],
)
def test_what_has_no_series_is_refused_by_a_sentence(model, why):
    """A Solve, or an operation that has no derivatives of every order."""
    program = eomgen.derive(model()).program
    with pytest.raises(UsageError, match=f"no Taylor series of these equations: they .*{why}"):
        smooth(program)


def test_what_is_no_program_has_no_series():
    with pytest.raises(UsageError, match="more than the equations of motion is stepped"):
        smooth(None)
