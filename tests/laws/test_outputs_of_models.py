"""The classics in models/: what their outputs answer is what the textbooks say, in symbols and in numbers."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import mpmath
import pytest
from derivations import answers as answers_of
from derivations import loaded as loaded_model
from derivations import model_path
from slow_run import sampled, usual_models

import eomgen
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

MODELS = Path(__file__).parents[2] / "models"
HEIGHT = "(L*sin(alpha) + R*(1 - cos(alpha)))"
KNOWN = {
    "simple_pendulum": {"theta_dd": "-g/l*sin(theta)", "kinetic_energy": "m*l^2/2*theta'^2", "v": "l*abs(theta')"},
    "elastic_pendulum": {
        "r_dd": "r*theta'^2 + g*cos(theta) - k/m*(r - l0)",
        "theta_dd": "-(2*r'*theta' + g*sin(theta))/r",
    },
    "spherical_pendulum": {
        "p_phi": "m*l^2*sin(theta)^2*phi'",
        "tension": "m*g*cos(theta) + m*l*(theta'^2 + sin(theta)^2*phi'^2)",
    },
    "bead_on_turning_hoop": {
        "theta_dd": "sin(theta)*(omega^2*cos(theta) - g/R)",
        "torque": "2*m*R^2*omega*sin(theta)*cos(theta)*theta'",
        "N_centre": "m*R*theta'^2 + m*R*omega^2*sin(theta)^2 + m*g*cos(theta)",
        "N_across": "2*m*R*omega*cos(theta)*theta'",
    },
    "atwood": {
        "s_dd": "(m1 - m2)*g/(m1 + m2 + M/2)",
        "omega_pulley": "s'/R",
        "v_after_fall": "sqrt(2*h*(m1 - m2)*g/(m1 + m2 + M/2))",
        "T_left": "m1*g*(4*m2 + M)/(2*m1 + 2*m2 + M)",
        "T_right": "m2*g*(4*m1 + M)/(2*m1 + 2*m2 + M)",
        "axle": "M*g + (8*m1*m2 + (m1 + m2)*M)*g/(2*m1 + 2*m2 + M)",
    },
    "sliding_ladder": {
        "N_wall": "3/4*m*g*sin(theta)*(3*cos(theta) - 2*cos(theta_0))",
        "N_floor": "m*g/4*(1 + 9*cos(theta)^2 - 6*cos(theta)*cos(theta_0))",
        "cos_leaves": "2/3*cos(theta_0)",
        "v_leaves": "sqrt(g*l*cos(theta_0)^3)/3",
    },
    "rough_incline": {
        "N": "m*g*cos(alpha)",
        "F_sliding": "-mu*m*g*cos(alpha)",
        "t_stop": "v0/(g*(sin(alpha) + mu*cos(alpha)))",
        "s_stop": "v0^2/(2*g*(sin(alpha) + mu*cos(alpha)))",
        "F_resting": "m*g*sin(alpha)",
    },
    "loop_the_loop": {
        "N_before": "m*g*cos(alpha)",
        "N_after": "m*g*(cos(alpha) + 2*L*sin(alpha)/R)",
        "N_low": f"m*g*(1 + 2*{HEIGHT}/R)",
        "N_top": f"m*g*(2*{HEIGHT}/R - 5)",
        "v_out": f"sqrt(2*g*{HEIGHT})",
    },
}
REQUESTED = [(name, output) for name, outputs in KNOWN.items() for output in outputs]


@cache
def loaded(name: str) -> tuple[eomgen.Model, dict[str, Any]]:
    path = model_path(name)
    return loaded_model(path), answers_of(path)


def value_of(text: str, state: dict[str, Any]) -> Any:
    """A text of the grammar at a state, with 50 digits."""
    graph, digits = Graph(), fifty_digits()
    symbols = {name: graph.symbol(name) for name in state}
    scalar = parse(text).evaluate(symbols | {"pi": graph.pi})
    return evaluate((scalar,), {symbols[name]: digits.number(x) for name, x in state.items()}, digits)[0]


def states(model: eomgen.Model) -> list[dict[str, Any]]:
    """Parameters near those of the file, coordinates and rates at random."""
    rng = Random(model.name)
    own = {name: Fraction(x) for name, x in model.numeric_parameters().items()}
    near = [{name: x * Fraction(rng.randint(950, 1050), 1000) for name, x in own.items()} for _ in range(3)]
    return [
        state
        | {q: Fraction(rng.randint(100, 1000), 1000) for q in model.coordinates}
        | {f"{q}'": Fraction(rng.randint(-2000, 2000), 1000) for q in model.coordinates}
        for state in near
    ]


@pytest.mark.parametrize(("name", "output"), REQUESTED)
def test_an_answer_is_the_textbooks(name, output):
    """exact = known at random states, 30 digits."""
    model, answers = loaded(name)
    assert answers[output].exact is not None, answers[output].message
    for state in states(model):
        ours, book = value_of(answers[output].exact, state), value_of(KNOWN[name][output], state)
        assert mpmath.almosteq(ours, book, rel_eps=mpmath.mpf(10) ** -30, abs_eps=mpmath.mpf(10) ** -40)


def test_the_ladder_takes_its_time_to_the_wall():
    """t = integral of dtheta/theta' from theta_0 to where N = 0, theta'^2 = 3 g/l (cos theta_0 - cos theta)."""
    model, answers = loaded("sliding_ladder")
    l, g, start = (model.numeric_parameters()[name] for name in ("l", "g", "theta_0"))
    end = mpmath.sqrt(mpmath.acos(2 * mpmath.cos(start) / 3) - start)

    def slowness(x: Any) -> Any:
        """dt/dx of theta = start + x^2, finite at the start; cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2)."""
        return 2 * x / mpmath.sqrt(6 * g / l * mpmath.sin(start + x**2 / 2) * mpmath.sin(x**2 / 2))

    assert answers["t_leaves"].value == pytest.approx(float(mpmath.quad(slowness, [0, end])), rel=1e-9)


@sampled(3)
@pytest.mark.parametrize("path", usual_models(sorted(MODELS.glob("*.toml")), 1), ids=lambda path: path.stem)
def test_the_outputs_of_every_classic_are_answered(path):
    """Exactly or as a number."""
    left = {name: answer.message for name, answer in answers_of(path).items() if not answer.answered}
    assert not left


def test_a_four_bar_keeps_its_energy_to_another_position():
    """T + V at alpha = pi is that of the start, though its loop closes in no short formula there."""
    energy = "kinetic_energy() + potential_energy()"
    requested = {"before": {"value": energy, "at": "t = 0"}, "there": {"value": energy, "at": "alpha = pi"}}
    answers = eomgen.solve(replace(loaded("four_bar")[0], outputs=requested))
    assert answers["there"].method == "energy theorem", answers["there"].message
    assert answers["there"].value == pytest.approx(answers["before"].value, rel=1e-12)


def test_a_normal_force_is_not_asked_of_a_piece_or_a_side():
    """reaction_n(bead.loop) would be a force that the bead has somewhere else: it is refused, with what to ask."""
    model = replace(loaded("loop_the_loop")[0], outputs={"N": "reaction_n(bead.loop)"})
    message = eomgen.solve(model)["N"].message
    assert message is not None and "ask reaction_n(bead), at an instant" in message
