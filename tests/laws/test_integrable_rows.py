"""What a condition on velocities keeps constant is constant along every motion that it allows."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from each import each

import eomgen
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.dynamics import System
from eomgen.symbolic.expression import gradient, inner, is_zero, substituted
from eomgen.symbolic.numeric import FLOAT, evaluate

MODELS = Path(__file__).parents[2] / "models"


@each("name", ["seeds/ch9_p1", "rolling_disc_and_bar", "epicyclic_gear", "rolling_cone"])
def test_an_integral_of_velocities_stays_along_what_the_row_allows(name):
    """Differences of the printed function over short steps, rates as given functions of time included, t not 0."""
    model = eomgen.load(MODELS / f"{name}.toml")
    system = System.of(model, eomgen.derive(model).graph.system.modes, with_laws=True)  # as it is printed
    system = system.free or system
    scope, symbols, rng = system.scope, system.symbols, random.Random(3)
    found = Rank(system.constraints).integrability
    assert found is not None
    looked = 0
    for row in found.rows:
        if row.integral is None:
            continue
        (own,) = (x for x in system.constraints.closing if (x.constraint, x.number) == (row.constraint, row.number))
        state = {x: float(v) for x, v in scope.values_of_parameters(None).items()}
        state |= {x: rng.uniform(0.4, 1.1) for x in (symbols.t, *symbols.q, *symbols.u)}
        velocity = substituted((own.velocity,), scope.laws)[0]
        slopes = gradient(velocity, symbols.u)
        k = next(k for k, slope in enumerate(slopes) if not is_zero(slope))
        at_rest, slope = evaluate(
            (velocity - inner(slopes, symbols.u) + inner([*slopes[:k], 0, *slopes[k + 1 :]], symbols.u), slopes[k]),
            state,
            FLOAT,
        )
        state[symbols.u[k]] = -at_rest / slope
        rates = [inner(n, symbols.u) + nu for n, nu in zip(scope.N, scope.nu, strict=True)]
        rates = evaluate(substituted(rates, scope.laws), state, FLOAT)

        def moved(h: float, state=state, rates=rates, integral=row.integral) -> float:
            there = state | {symbols.t: state[symbols.t] + h}
            there |= {q: state[q] + h * rate for q, rate in zip(symbols.q, rates, strict=True)}
            return float(evaluate(substituted((integral,), scope.laws), there, FLOAT)[0])

        assert (moved(1e-4) - moved(-1e-4)) / 2e-4 == pytest.approx(0, abs=1e-6)
        looked += 1
    assert looked
