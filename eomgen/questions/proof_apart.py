"""Answers that are of no state of a motion -> checks: of small motions, and of one instant to which no motion leads.

What they are made of is proven as `linearize` and `kinematics` prove it; then each answer is found again from that, by
the matrices in floats and the eigenvalues of A, and by the formula at the proven instant with 50 digits.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

import numpy as np

from eomgen.documents.linearize.result import Linearization
from eomgen.documents.quantity import Quantity
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.numeric_value import known_exactly
from eomgen.mechanics.instant.kinematic_state import KinematicState
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.mechanics.small_motions.modes import MATRICES
from eomgen.model.outputs.base import names_of
from eomgen.model.parts import Model, Output
from eomgen.proof.at_a_state import read_back
from eomgen.proof.check import Check, Tally, differing
from eomgen.proof.instant import instant_checks, values_of
from eomgen.proof.small_motions import small_motion_checks
from eomgen.questions.velocities import state_of
from eomgen.symbolic.expression.expressions import Call
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.sure_numbers import number_of
from eomgen.symbolic.numeric.tolerances import COMPUTED, SAME_PLACE

Asked = tuple[Output, Quantity]


def in_unit(value: float, output: Output) -> float:
    """An SI value in the unit in which the output is given."""
    return value if output.unit is None else float(output.unit.from_si(value, math.pi))


# -- of the linearized system ----------------------------------------------------------------------------


def of_small_motions(
    found: Linearization, system: System, asked: Mapping[str, Asked], proven: Sequence[Check]
) -> Iterator[Check]:
    """Matrices and modes as `linearize` proves them, and what is asked of them.

    Args:
        system: of the start, whose equations are `proven`: they are those of the small motions if the contacts are.
    """
    same = proven and found.small.first.system.modes == system.modes
    yield from small_motion_checks(found.modes) if same else found.certify().checks
    tally = Tally("answers of small motions are those of the matrices in numbers", "eigenvalues of A in doubles")
    for name, (output, answer) in asked.items():
        if answer.value is not None:
            tally.add(name, partial(_by_matrices, found, system, output, answer.value))
    yield from tally.checks()


def _by_matrices(found: Linearization, system: System, output: Output, value: float) -> str:
    """By the entries in floats, and by the Im of A's eigenvalues in their order, motions of the whole first."""
    small = found.small

    def second(call: Call) -> Scalar:
        if call.name != "frequency":
            row, column = found.modes.place(call.name, *names_of(call))
            return Fraction(getattr(small.numbers, MATRICES[call.name])[row][column])
        return Fraction(_rates(found)[int(found.number_of(call)) - 1])

    right = number_of(output.value.evaluate(system.scope.names, second), known_exactly(system.scope))
    frequency = any(call.name == "frequency" for call in output.value.calls)
    return differing(value, in_unit(right, output), SAME_PLACE if frequency else COMPUTED)


def _rates(found: Linearization) -> list[float]:
    """The frequencies by A's eigenvalues, the slowest first; as many zeros as there are motions of the whole."""
    modes = found.modes.spectrum.oscillating
    still = sum(mode.frequency == 0 for mode in modes)
    turning = sorted(np.linalg.eigvals(found.small.state_matrix).imag, reverse=True)[: len(modes) - still]
    return [0.0] * still + [float(x) for x in reversed(turning)]


# -- of one instant ----------------------------------------------------------------------------------------


def of_one_instant(model: Model, asked: Mapping[str, Asked]) -> Iterator[Check]:
    """The state as `kinematics` proves it, and what is asked of it, as numbers and, read back, as texts."""
    state = state_of(model)
    yield from instant_checks(state)
    tally = Tally("answers of the instant are those of its proven state", "50 digits")
    for name, (output, answer) in asked.items():
        tally.add(name, partial(_by_state, state, output, answer))
    yield from tally.checks()


def _by_state(state: KinematicState, output: Output, answer: Quantity) -> str:
    system, values = state.system, values_of(state)
    formula = output.value.evaluate(system.scope.names, Quantities(system).value)
    right = in_unit(float(evaluate((formula,), values, fifty_digits())[0]), output)
    told = [] if answer.value is None else [answer.value]
    if answer.exact is not None:
        text = evaluate((read_back(system, answer.exact),), values, fifty_digits())[0]
        told.append(in_unit(float(text), output))
    return next(filter(None, (differing(x, right) for x in told)), "")
