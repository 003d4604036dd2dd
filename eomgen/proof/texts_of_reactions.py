"""Formulas of reactions as they are printed -> a check: read back, they are the reactions solved in numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.mechanics.free_bodies import Reactions
from eomgen.proof.at_a_state import NumericState, moving_states, off_by, place_of, read_back
from eomgen.proof.check import Check, Tally
from eomgen.symbolic.numeric import NoValue, tolerances


def reaction_texts(equations: EquationsOfMotion, texts: Mapping[str, str]) -> Iterator[Check]:
    """Check of each text at the start, in pieces and at random, by the bodies' equations solved there in doubles.

    Args:
        texts: of each reaction by its name, a function of q, u, t and accelerations.
    """
    tally = Tally("formulas, read back, are the reactions of the free bodies", "50 digits against doubles")
    states = list(moving_states(equations))

    def compared(name: str, text: str) -> str:
        scalar, judged = read_back(equations.system, text), 0
        for state in states:
            if name not in state.reactions:
                continue
            size = max(map(abs, state.reactions.values()))
            found, right = state.number(scalar), state.reactions[name]
            if abs(found - right) > tolerances.COMPUTED * (1 + size):
                near = [near.reactions.get(name, right) for near in state.nearby()]
                wrong = off_by(found, right, near)
                if wrong and not state.decides(scalar):
                    continue
                if wrong:
                    return f"{wrong} at t = {state.t:.6g} s, {place_of(state)}"
            judged += 1
        if not judged:
            raise NoValue("at none of the states tried it has a single value")
        return ""

    for name, text in texts.items():
        tally.add(name, partial(compared, name, text))
    return tally.checks()


def reaction_numbers(start: NumericState, texts: Mapping[str, str], values: Mapping[str, float]) -> Iterator[Check]:
    """Checks that each number at the start is the value of its formula with 50 digits, printed or as it was solved."""
    tally = Tally("formulas, read back, give the numbers at the start", "50 digits against doubles")
    unreported = Tally("numbers without a printed formula are those of the free bodies", "50 digits against doubles")
    solved = {} if values.keys() <= texts.keys() else Reactions.of(start.equations.system).determinate()
    size = max(map(abs, values.values()), default=0.0)

    def compared(name: str) -> str:
        scalar = read_back(start.equations.system, texts[name]) if name in texts else solved[name]
        found, right = values[name], start.number(scalar)
        if start.jumps and (found or right):
            return "a force jumps there, and it has no one value"
        if abs(found - right) <= tolerances.COMPUTED * (1 + size):
            return ""
        return off_by(found, right, [near.number(scalar) for near in start.nearby()])

    for name in values:
        if name in texts or name in solved:
            (tally if name in texts else unreported).add(name, partial(compared, name))
    return iter((*tally.checks(), *unreported.checks()))
