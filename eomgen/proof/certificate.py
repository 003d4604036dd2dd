"""Equations of motion -> Certificate: what was checked about the equations, by which arithmetic, and whether it holds.

Independent routes must agree: energies and their derivatives (Lagrange), twists and wrenches
(projection), recursion over the tree. What they share is checked by itself: twists against
differences of poses, accelerations against free bodies in numbers, the energy identity, reactions by the balance of
every body and of the whole, the emitted code.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from eomgen.errors import DerivationError, ModelError
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.mechanics.free_bodies import SystemFriction
from eomgen.mechanics.start import Start
from eomgen.proof.check import Certificate
from eomgen.proof.identities import identity_checks
from eomgen.proof.masses import other_data
from eomgen.proof.printed import Printed
from eomgen.proof.trials import Trials
from eomgen.resources import doing, growing

if TYPE_CHECKING:
    from eomgen.codegen import RightHandSide
from collections.abc import Iterator, Mapping
from functools import partial

from eomgen.mechanics.free_bodies import Reactions
from eomgen.proof.at_a_state import NumericState, moving_states, off_by, place_of, read_back
from eomgen.proof.check import Check, Tally
from eomgen.symbolic.numeric import NoValue, tolerances


@growing()
@doing("the proof of the equations")
def certify(
    equations: EquationsOfMotion,
    rhs: RightHandSide | None = None,
    derived: EquationsOfMotion | None = None,
    *,
    printed: Printed | None = None,
    begins: bool = True,
) -> Certificate:
    """Check the equations of a system.

    Args:
        equations: those that a user gets.
        rhs: emitted code to be compared with the symbols.
        derived: the same by the way in which a derivation is written.
        printed: a derivation as it is printed.
        begins: True if their motion begins as the model's does; what is requested at rest has no start speeds.
    """
    trials = Trials(equations)
    checks = [*identity_checks(equations, derived, trials.states), trials.places(), trials.twists()]
    if trials.given:
        checks.append(trials.given_motions())
    if equations.symbols.z:
        checks.append(trials.state_rates())
    if equations.system.elimination is not None:
        checks.append(trials.eliminated_rows())
    checks += [trials.free_bodies(), *trials.accelerations()]
    if trials.rubs:
        checks.append(trials.friction())
    if SystemFriction(equations.system).exists:
        checks += trials.pushes()
    checks += trials.begun_contacts() if begins else ()
    checks += [
        *trials.tensors(),
        *trials.contacts(),
        *trials.threads(),
        *trials.kept_constraints(),
        *trials.slack_springs(),
        *trials.elements(),
        *trials.declared(),
        *trials.energies(),
        *trials.balance(),
    ]
    checks += [] if printed is None else trials.printed(printed)
    if rhs is not None:
        checks.append(trials.code(rhs))
    return Certificate((*checks, *other_data(equations.system.motion)))


@doing("the proof of what stands")
def certify_standing(equations: EquationsOfMotion) -> Certificate:
    """Check what no coordinate moves: where it stands, what is applied to it, the balance of every body."""
    trials = Trials(equations)
    checks = (trials.places(), *trials.kept_constraints(), *trials.elements(), *trials.declared(), *trials.balance())
    return Certificate((*checks, *other_data(equations.system.motion)))


# -------- reactions -------------------------------------------------------------------------------------------


def certify_reactions(
    equations: EquationsOfMotion, texts: Mapping[str, str], values: Mapping[str, float]
) -> Certificate:
    """Check the equations, every formula of a reaction, and its number at the start, where that is known.

    Args:
        texts: of each reaction by its name, a function of q, u, t and accelerations.
        values: of each reaction by its name, at the start.
    """
    found = certify(equations) + reaction_texts(equations, texts)
    try:
        symbols, begun = equations.symbols, Start.of(equations.system).values
        numbers = {symbols.t: 0.0, **{x: begun[x.name] for x in symbols.x}}
        start = NumericState(equations, equations.system.scope.known_exactly, numbers)
    except (ModelError, DerivationError):
        return found
    return found + reaction_numbers(start, texts, values)


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
