"""Events of an integration: located where they are, in the order in which they come, and none that is rounding."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipk

import eomgen
from eomgen.simulation.event_location import Events
from eomgen.simulation.integrator import Run, Stepping, march
from eomgen.simulation.solvers import METHODS

G = 9.81


def run(f, x0, values, *, end=10.0, floor=1e-9, **how) -> Run:
    """x' = f(t, x) until one of the functions values(t, x) -> (g, ...) falls to zero."""

    def many(t, x):
        return np.array([np.atleast_1d(values(t, x)) for t, x in zip(t, x, strict=True)], dtype=float)

    x0 = np.array(x0, dtype=float)
    events = Events(many, np.full(many([0.0], [x0]).shape[1], floor))
    return march(f, (0.0, end), x0, how=Stepping(**how), events=events)


def falling(t, x):
    return np.array([x[1], -G])


@pytest.mark.parametrize("method", METHODS)
def test_a_fall_ends_where_the_floor_is(method):
    """y = h - g t^2 / 2 reaches 0 at sqrt(2h/g)."""
    tight = method in ("DOP853", "RK45")
    found = run(falling, [2.0, 0.0], lambda t, x: x[0], method=method)
    assert found.status == "event" and found.crossing.index == 0 and found.t[-1] == found.end
    assert found.end == pytest.approx(math.sqrt(4 / G), abs=1e-12 if tight else 1e-6)
    assert found.x[-1] == pytest.approx([0, -math.sqrt(4 * G)], abs=1e-11 if tight else 1e-5)


def test_the_time_of_an_event_converges_with_the_tolerance():
    """Measured: sin t = 1/2 downwards at 5 pi/6; the error falls by the tolerance's own order."""
    tolerances = [1e-4, 1e-6, 1e-8, 1e-10]
    errors = [
        abs(
            run(
                lambda t, x: np.array([x[1], -x[0]]),
                [0.0, 1.0],
                lambda t, x: [x[1] + math.sqrt(3) / 2],
                rtol=tol,
                atol=tol,
            ).end
            - 5 * math.pi / 6
        )
        for tol in tolerances
    ]
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert errors[-1] < 1e-9 and 0.7 < slope < 1.4


def test_the_first_of_several_events_counts():
    """Two walls, at x = -3 and at x = 2: whichever is reached first, whatever their order."""
    for values, index in ((lambda t, x: [x[0] + 3, 2 - x[0]], 1), (lambda t, x: [2 - x[0], x[0] + 3], 0)):
        found = run(lambda t, x: np.ones(1), [0.0], values)
        assert found.crossing.index == index and found.end == pytest.approx(2, abs=1e-12)


def test_what_starts_at_zero_must_have_been_positive_first():
    """A ball thrown up from the floor lands after 2 v/g; it does not land as it leaves."""
    assert run(falling, [0.0, 3.0], lambda t, x: x[0]).end == pytest.approx(6 / G, abs=1e-12)
    assert run(falling, [-1e-13, 3.0], lambda t, x: x[0]).end == pytest.approx(6 / G, abs=1e-10)


def test_what_starts_at_zero_and_falls_is_an_event_at_once():
    """From rest on a floor that is not there: below it by its floor after sqrt(2 floor/g)."""
    found = run(falling, [0.0, 0.0], lambda t, x: x[0], floor=1e-10)
    assert found.end == pytest.approx(math.sqrt(2e-10 / G), rel=1e-3)


def test_rounding_about_zero_is_no_event():
    """1e-16 this way and that, below the floor: the run goes to its end."""
    noise = np.random.default_rng(1)
    found = run(falling, [1.0, 0.0], lambda t, x: 1e-16 * noise.normal(), end=1.0)
    assert found.status == "finished" and found.end == 1.0


def test_a_dip_between_two_looks_is_seen():
    """y = (t - 1)^2 - 1e-6 is negative for 0.002 s of a step that takes seconds."""
    found = run(lambda t, x: np.zeros(1), [0.0], lambda t, x: (t - 1.0123) ** 2 - 1e-6)
    assert found.end == pytest.approx(1.0113, abs=1e-9)
    assert run(lambda t, x: np.zeros(1), [0.0], lambda t, x: (t - 1.0123) ** 2 + 1e-6).status == "finished"


def test_samples_go_up_to_the_event():
    """The instants asked for, and the event itself as the last one."""
    events = Events(lambda t, x: x[:, :1], np.array([1e-9]))
    found = march(
        falling, (0.0, 1.0), np.array([1.0, 0.0]), how=Stepping(), instants=np.linspace(0, 1, 11), events=events
    )
    assert found.t[:-1] == pytest.approx(np.linspace(0, 0.4, 5)) and found.t[-1] == pytest.approx(math.sqrt(2 / G))
    assert found.x[:, 0] == pytest.approx(1 - G * found.t**2 / 2, abs=1e-12)


LEVEL = """
eomgen = 1
space = "plane"
parameters = { L = 0.8, g = 9.81 }
coordinates = { x = "L", y = 0 }
points.O = [0, 0]
bodies.bob = { shape = { kind = "particle", mass = 0.5 }, joint = { kind = "placed", at = ["x", "y"] } }
constraints.rod = { kind = "link", points = ["O", "bob.center"], length = "L" }
forces.w = { kind = "gravity", acceleration = [0, "-g"] }
"""


@pytest.mark.slow
@pytest.mark.parametrize("condition", ["x' = 0", "speed(bob.center) = 0", "y = 0", "x = -L"])
def test_a_root_of_any_order_is_found_to_all_digits(condition):
    """Let go level, it is so after 2 K(1/sqrt 2) sqrt(L/g): x' has a triple root, x one of order 4, |v| an edge."""
    half = 2 * ellipk(0.5) * np.sqrt(0.8 / 9.81)
    found = eomgen.simulate(eomgen.loads(LEVEL), time=2, until=condition, rtol=1e-11, atol=1e-11, target="numpy")
    assert found.status == "event" and found.phases[-1].end == pytest.approx(half, abs=1e-11)


def test_two_roots_that_the_run_tells_apart_are_not_taken_for_one():
    """cos w t = -(1 - d) just before the turn, at (pi - sqrt(2 d))/w; the error of x divides by w sqrt(2 d)."""
    w = 4.0
    for d in (1e-2, 1e-4, 1e-6):
        events = Events(lambda t, x, d=d: x[:, :1] + 1 - d, np.array([1e-9]), (0,))
        oscillates = lambda t, x: np.array([x[1], -w * w * x[0]])  # noqa: E731
        found = march(oscillates, (0.0, 3.0), np.array([1.0, 0.0]), how=Stepping(rtol=1e-12, atol=1e-12), events=events)
        assert found.end == pytest.approx(np.arccos(-(1 - d)) / w, abs=1e-11 / np.sqrt(2 * d))


def test_no_step_is_too_long_for_a_condition():
    """theta' is constant, so steps grow without end; sin(theta) = 1/2 is met at pi/6 all the same."""
    found = march(
        lambda t, x: np.ones(1),
        (0.0, 1e4),
        np.zeros(1),
        how=Stepping(),
        events=Events(lambda t, x: np.sin(x) - 0.5, np.array([1e-9]), (0,)),
    )
    assert found.end == pytest.approx(np.pi / 6, abs=1e-14)


def test_a_start_that_doubles_cannot_hold_is_refused():
    """At 1e15 rad neighbouring doubles are 0.125 rad apart; 1e9 m of free flight are fine."""
    rod = 'constraints.rod = { kind = "link", points = ["O", "bob.center"], length = "L" }'
    flight = LEVEL.replace(rod, "")
    turning = flight.replace('x = "L", y = 0', "a = 1e15").replace(
        '"placed", at = ["x", "y"]', '"revolute", angle = "a"'
    )
    turning = turning.replace('"particle"', '"rod", length = 1')
    with pytest.raises(eomgen.DerivationError, match=r"neighbouring doubles are 0\.125 apart"):
        eomgen.simulate(eomgen.loads(turning), time=1, target="numpy")
    assert eomgen.simulate(eomgen.loads(flight.replace('x = "L"', "x = 1e9")), time=1, target="numpy").ok
