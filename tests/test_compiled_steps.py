"""Steps with their stages in C against scipy's own, on right-hand sides in C."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.integrate

import eomgen
from eomgen.codegen.build import compiler
from eomgen.simulation.solvers import EXPLICIT, quick, solver_of

MODELS = Path(__file__).parent.parent / "models"

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")


def rate(name: str = "double_pendulum"):
    rhs = eomgen.derive(eomgen.load(MODELS / f"{name}.toml")).rhs("c")
    return rhs.at(rhs.p0), rhs.x0


@pytest.mark.parametrize("method", EXPLICIT)
@pytest.mark.parametrize("name", ["double_pendulum", "spherical_pendulum", "arm3"])
def test_steps_in_c_are_those_of_scipy(method, name):
    """The same instants, states, rates, states between the steps and numbers of evaluations, to rounding."""
    f, x0 = rate(name)
    options = {"rtol": 1e-7, "atol": 1e-9}
    own = quick(method)(f, 0.0, x0, 1.0, at=f.address, **options)
    other = getattr(scipy.integrate, method)(f, 0.0, x0, 1.0, **options)
    for _ in range(60):
        if other.status != "running":
            break
        own.step(), other.step()
        assert own.t == pytest.approx(other.t, rel=1e-6) and own.nfev == other.nfev
        between = (other.t_old + other.t) / 2
        for found, expected in (
            (own.y, other.y),
            (own.f, other.f),
            (own.dense_output()(between), other.dense_output()(between)),
        ):
            assert found == pytest.approx(expected, rel=1e-5, abs=1e-5 * np.max(np.abs(expected)))
    assert own.status == other.status and other.t > 0


@pytest.mark.parametrize("method", EXPLICIT)
def test_what_runs_in_c_takes_such_steps(method):
    f, x0 = rate()
    assert isinstance(solver_of(method, f, (0.0, 1.0), x0, rtol=1e-6, atol=1e-6), quick(method))
    assert not isinstance(solver_of(method, lambda t, x: f(t, x), (0.0, 1.0), x0, rtol=1e-6, atol=1e-6), quick(method))


def test_a_step_shrinks_until_it_goes_no_further():
    """x' = sqrt(1 - t) has no value after t = 1."""
    text = """
        eomgen = 1
        space = "plane"
        coordinates = { x = { rate = "sqrt(1 - t)" }, y = 0.1 }
        bodies.frame = { joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
        [bodies.load]
        mass = 1
        inertia = 1
        joint = { kind = "prismatic", on = "frame", axis = [0, 1], displacement = "y" }
    """
    run = eomgen.simulate(eomgen.loads(text), time=2, target="c")
    assert run.status in ("not finite", "step too small") and run.t[-1] == pytest.approx(1, abs=1e-6)
