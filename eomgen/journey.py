"""Situation, condition -> Moment: the state at which a motion first meets a condition, exactly where it can be.

A motion may pass through several phases: contacts end, rub, stick, a path goes over from one piece to the next. Each
phase is followed in numbers first; the instants between are then sought in closed form, and taken where they agree.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eomgen.codegen.program import right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import MissingValues
from eomgen.instants import Instant, reached
from eomgen.mechanics.articulated import with_accelerations
from eomgen.mechanics.start import start_state
from eomgen.model.values import numeric_parameters
from eomgen.situation import Situation, start_of
from eomgen.symbolic.derivative import depends_on, substituted, symbols_of
from eomgen.symbolic.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.solving import roots

SAME = 1e-8  # of an exact place against the located one
TURN = 6.283185307179586


@dataclass(frozen=True)
class Moment:
    """One instant of a motion.

    Args:
        situation: the equations of the phase.
        exact: t, q and u as scalars of the parameters, those that are known so.
        numbers: t, q and u as numbers; {} where parameters are missing.
        method: how it was found.
    """

    situation: Situation
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, float]
    method: str


@dataclass(frozen=True)
class Journey:
    """A motion from the start.

    Args:
        situation: its first phase.
        at_rest: all speeds are 0 at the start, whatever the model says.
    """

    situation: Situation
    at_rest: bool

    @cached_property
    def numbers(self) -> dict[Node, float]:
        """t, q and u at the start; {} where parameters are missing."""
        symbols = self.situation.system.symbols
        try:
            at_rest = {u.name: 0.0 for u in symbols.u} if self.at_rest else {}
            numeric_parameters(self.situation.model)
            values = start_state(self.situation.system, start=at_rest)
        except MissingValues:
            return {}
        return {symbols.t: 0.0} | {node: values[node.name] for node in (*symbols.q, *symbols.u)}

    @cached_property
    def start(self) -> dict[Node, Scalar]:
        """t, q and u at the start as scalars of the parameters; {} where a coordinate has no closed form there."""
        known = start_of(self.situation, at_rest=self.at_rest)
        known = placed(self.situation, known, self.numbers)
        return known if all(q in known for q in self.situation.system.symbols.q) else {}

    @cached_property
    def rhs(self) -> RightHandSide | None:
        """The right-hand side; None where parameters are missing."""
        if not self.numbers:
            return None
        system, assembly = self.situation.system, self.situation.assembly
        return compiled(right_hand_side(with_accelerations(system, assembly), system.inputs))

    def until(self, condition: Scalar) -> Moment:
        """The first time after the start at which the condition, a function of q, u and t, is 0.

        Raises:
            RunFailed: it is never met.
        """
        situation = self.situation
        instant: Instant = reached(
            situation.system, situation.assembly, situation.accelerations, condition, self.start, self.numbers, self.rhs
        )
        exact = placed(situation, instant.exact, instant.numbers)
        return Moment(situation, exact, instant.numbers, instant.method)


def placed(situation: Situation, known: Mapping[Node, Scalar], numbers: Mapping[Node, float]) -> dict[Node, Scalar]:
    """What is known of a state, and the coordinates that the ties then fix, one by one, where that has a closed form.

    Args:
        numbers: the same state in numbers, by which one of several places is chosen; {}: only where there is one.
    """
    found = dict(known)
    symbols = situation.system.symbols
    gaps = [row.gap for row in situation.system.ties.rows if row.gap is not None and not row.identical]
    while True:
        before = len(found)
        for gap in substituted(tuple(gaps), found):
            unknown = [q for q in symbols.q if q not in found and depends_on(gap, (q,))]
            if len(unknown) == 1:
                place = _place(situation, gap, unknown[0], numbers)
                if place is not None:
                    found[unknown[0]] = place
                    break
        if len(found) == before:
            return found


def _place(situation: Situation, gap: Scalar, q: Node, numbers: Mapping[Node, float]) -> Scalar | None:
    """The root of a gap that is the located place."""
    candidates = roots(gap, q, situation.positive)
    if not numbers:
        return candidates[0] if len(candidates) == 1 else None
    p = {node: value for node, value in _parameters(situation).items()}
    for candidate in candidates:
        if not set(symbols_of((candidate,))) <= p.keys():
            continue
        try:
            value = evaluate((candidate,), p, FLOAT)[0]
        except (NoValue, ZeroDivisionError):
            continue
        turns = round((numbers[q] - value) / TURN) if _is_angle(gap, q) else 0
        if abs(value + turns * TURN - numbers[q]) <= SAME * (1 + abs(numbers[q])):
            return candidate + 2 * turns * q.graph.pi if turns else candidate
    return None


def _is_angle(gap: Scalar, q: Node) -> bool:
    """Whether the gap is the same a full turn on."""
    from eomgen.symbolic.exact import equal_at_random_states

    (turned,) = substituted((gap,), {q: q + 2 * q.graph.pi})
    return equal_at_random_states([(gap, turned)]).equal


def _parameters(situation: Situation) -> dict[Node, float]:
    values = numeric_parameters(situation.model)
    return {situation.system.symbols.parameters[name]: float(np.float64(x)) for name, x in values.items()}
