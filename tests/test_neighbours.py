"""Values from pint, runs to pandas and xarray: in and out without glue."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import eomgen

MODELS = Path(__file__).parent.parent / "models"


@pytest.mark.slow
def test_quantities_of_pint_are_values():
    """80 cm, 2 lb, 30 deg and 20 rpm of pint's own are what they are in SI; a wrong one is refused."""
    pint = pytest.importorskip("pint")
    ureg = pint.UnitRegistry()
    model = MODELS / "simple_pendulum.toml"
    typed = {"l": ureg.Quantity(80, "cm"), "m": 2 * ureg.pound}
    start = {"theta": 30 * ureg.degree, "theta'": ureg.Quantity(20, "rpm")}
    found = eomgen.simulate(model, time=1, parameters=typed, start=start, samples=11)
    plain = {"l": 0.8, "m": 2 * 0.45359237}
    other = eomgen.simulate(
        model, time=1, parameters=plain, start={"theta": np.pi / 6, "theta'": 20 * np.pi / 30}, samples=11
    )
    assert np.allclose(found.x, other.x, rtol=0, atol=1e-12)
    with pytest.raises(eomgen.UsageError, match="l"):
        eomgen.derive(model, parameters={"l": 2 * ureg.second})


@pytest.mark.slow
def test_a_run_goes_to_pandas_and_xarray_as_it_is():
    """The same columns by the same names, over t, and how it went."""
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    run = eomgen.simulate(MODELS / "double_pendulum.toml", time=1, samples=5)
    frame, data = run.to_pandas(), run.to_xarray()
    assert list(frame.columns) == list(data.data_vars) == [name for name in run.columns() if name != "t"]
    for name in frame.columns:
        assert np.array_equal(frame[name].to_numpy(), data[name].to_numpy()) and np.array_equal(frame[name], run[name])
    assert np.array_equal(frame.index, run.t) and np.array_equal(data["time"], run.t)
    assert data.attrs["status"] == run.status == "finished"
