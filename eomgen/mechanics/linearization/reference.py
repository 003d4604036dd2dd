"""System -> Reference: the equilibrium, or the steady motion, about which small motions are sought."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.equilibrium import Equilibrium, StaticEquations, over_rates
from eomgen.mechanics.integrals import position_equations
from eomgen.mechanics.kinematics import Located
from eomgen.mechanics.start import Start
from eomgen.symbolic.expression import Node, Scalar, State, depends_on, holds_many_digits, is_zero, substituted
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

# -------- reference -------------------------------------------------------------------------------------------
# System -> Reference: the equilibrium, or the steady motion, about which small motions are sought.


EQUILIBRIUM, START, STEADY = "equilibrium", "start", "steady"


@dataclass(frozen=True)
class ReferenceMotion:
    """The state about which the equations are linearized.

    Args:
        system: of the model; about an equilibrium its drives are held.
        about: EQUILIBRIUM, START or STEADY.
        exact: t, q, u, z and inputs as scalars of the parameters, as far as they are known so.
        numbers: t, q, u, z, inputs and parameters, with 50 digits; parameters without a value have one to try.
        place: the equilibrium, where it was sought.
        family: the steady motions that one belongs to, where it was sought and they could be written.
        beside: the requested start, which is no equilibrium or steady motion but is near this one; None where no start
            was requested.
    """

    system: System
    about: str
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, Any]
    place: Equilibrium | None = None
    family: Family | None = None
    beside: Mapping[Node, float] | None = None

    @property
    def about_equilibrium(self) -> bool:
        """True if the state is an equilibrium."""
        return self.about == EQUILIBRIUM

    @property
    def about_steady_motion(self) -> bool:
        """True if the state is one of a steady motion."""
        return self.about == STEADY

    @property
    def is_exact(self) -> bool:
        """True if all coordinates and speeds are known in closed form."""
        symbols = self.system.symbols
        return all(x in self.exact for x in symbols.x)

    @property
    def at_rest(self) -> bool:
        """True if all speeds are exactly 0."""
        return all(is_zero(self.exact.get(u, u)) for u in self.system.symbols.u)

    @property
    def valued(self) -> bool:
        """True if all parameters have values."""
        return not self.system.symbols.parameters.keys() - self.system.scope.model.exact_parameters().keys()

    @cached_property
    def moving(self) -> dict[Node, Any]:
        """The coordinates that move in the reference, and their rates."""
        rates = evaluate(self.system.scope.rates, self.numbers, fifty_digits())
        return {q: rate for q, rate in zip(self.system.symbols.q, rates, strict=True) if abs(rate) > tolerances.SOLVED}

    @property
    def trial(self) -> dict[Node, Any]:
        """The values of the parameters."""
        return {x: self.numbers[x] for x in self.system.symbols.parameters.values()}


def place_of_rest(system: System, guess: Mapping[str, float] | None = None) -> ReferenceMotion:
    """The equilibrium nearest to the guess.

    Args:
        guess: values of coordinates in place of `near` and `start`.
    Raises:
        DerivationError: none was found; a one-sided contact would have to pull.
        NotYet: speeds that are not rates.
    """
    place = Equilibrium.nearest(StaticEquations.of(system), guess)
    if system.scope.model.contacts:
        place.refuse_contradicted()
    return _place(place)


def relative_rest(equations: EquationsOfMotion, guess: Mapping[str, float] | None = None) -> ReferenceMotion:
    """Relative equilibrium, at rest relative to what the model drives at a steady rate: a bead on a turning hoop.

    forcing + J^T lam = 0 at u = 0, forcing with the inertia forces of the drives' motion.

    Raises:
        DerivationError: none was found.
    """
    system = equations.system
    symbols, coordinates = system.symbols, system.scope.model.coordinates
    start = system.scope.start_values()
    driven = [q for q in symbols.q if coordinates[q.name].driven]
    given = system.standing({q: start[q] for q in driven})
    forcing = substituted(equations.forcing, given)
    system.refuse_states("relative rest is not sought", 'ask about = "start"')
    own = {q: k for k, u in enumerate(symbols.u) for q in symbols.q if u.name == f"{q.name}'"}
    if len(own) != len(symbols.u) or len(own) + len(driven) != len(symbols.q):
        raise DerivationError(
            "relative rest is sought only where every coordinate is free or driven",
            "coordinates",
            fix='ask about = "start"',
        )
    statics = StaticEquations(
        system,
        (),
        tuple(own),
        given,
        tuple(forcing[k] for k in own.values()),
        tuple(forcing[k] for k in own.values()),
        tuple(substituted(row, given) for row in equations.J),
        symbols.lam,
        substituted(tuple(x for x in position_equations(system, start) if depends_on(x, own)), given),
    )
    return _place(Equilibrium.nearest(statics, guess))


def _place(place: Equilibrium) -> ReferenceMotion:
    system = over_rates(place.statics.system)
    symbols = system.symbols
    still: dict[Node, Scalar] = {symbols.t: 0, **dict.fromkeys(symbols.u, 0)}
    found = {q: place.exact[q] for q in symbols.places if q in place.exact}
    exact = (_short(found) if place.numbers else found) | still
    trial = system.scope.values_of_parameters(Random(3))
    numbers: dict[Node, Any] = {**trial, **_numbers(still, trial)}
    for q in symbols.places:
        numbers[q] = _numbers({q: exact[q]}, trial)[q] if q in exact else fifty_digits().number(place.numbers[q])
    return _with_inputs(ReferenceMotion(system, EQUILIBRIUM, exact, numbers, place))


def at_the_start(system: System, *, at_rest: bool, given: Mapping[str, float] | None = None) -> ReferenceMotion:
    """The start of the model, without its speeds where it is to be an equilibrium.

    Args:
        given: coordinates and speeds in place of the model's.
    Raises:
        DerivationError: a constraint that does not hold there.
    """
    symbols, scope, model = system.symbols, system.scope, system.scope.model
    trial = scope.values_of_parameters(Random(3))
    parameters = {name: float(trial[node]) for name, node in symbols.parameters.items()}
    state = Start.of(system, parameters, given).values
    numbers: dict[Node, Any] = {**trial, symbols.t: fifty_digits().number(0)}
    sought = system.constraints.fixed_by_position
    exact = {symbols.t: 0} | scope.start_values(q for q in symbols.q if q not in sought)
    for u in symbols.u:
        speed = model.coordinates[u.name[:-1]].speed if u.name.endswith("'") else model.speeds[u.name].start
        exact[u] = 0 if at_rest else scope.value(speed)
    exact |= scope.start_values(symbols.z)
    located = Located(
        {
            **{x: float(v) for x, v in numbers.items()},
            **{x: 0.0 if at_rest and x in symbols.u else state[x.name] for x in symbols.x},
        },
        scope.positive,
    )
    gaps = [gap for row in system.constraints.rows if (gap := _gap(row)) is not None]
    exact |= located.places(substituted(tuple(gaps), exact), sought) if sought else {}
    exact = {x: value for x, value in exact.items() if x is symbols.t or located.agrees(value, x)}
    exact = exact if symbols.parameters.keys() - model.exact_parameters().keys() else _short(exact)
    for x in symbols.x:
        numbers[x] = _numbers({x: exact[x]}, trial)[x] if x in exact else fifty_digits().number(located.numbers[x])
    return _with_inputs(ReferenceMotion(system, EQUILIBRIUM if at_rest else START, exact, numbers))


def in_closed_form(reference: ReferenceMotion, state: Mapping[Node, Scalar]) -> ReferenceMotion:
    """The reference with coordinates and speeds that are known as scalars of the parameters."""
    numbers = {**reference.numbers, **_numbers(state, reference.trial)}
    return replace(reference, exact={**reference.exact, **state}, numbers=numbers)


def _short(state: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """Entries of a state that can be in a formula; a double with all its digits is a number, and no part of one."""
    return {node: x for node, x in state.items() if not holds_many_digits(x)}


def _gap(row: Row) -> Scalar | None:
    return None if row.identical else row.gap


def _with_inputs(reference: ReferenceMotion) -> ReferenceMotion:
    """Inputs as they are at t = 0.

    Raises:
        DerivationError: a coordinate is so far away that nothing small is left of it.
    """
    system = reference.system
    Start.refuse_lost({q: reference.numbers[q] for q in system.symbols.q})
    given = {node: system.inputs[name] for name, node in system.symbols.inputs.items()}
    exact = dict(zip(given, substituted(tuple(given.values()), reference.exact), strict=True))
    exact = {x: value for x, value in exact.items() if not depends_on(value, system.symbols.x)}
    numbers = dict(reference.numbers)
    for node, value in given.items():
        numbers[node] = evaluate((value,), numbers, fifty_digits())[0]
    return replace(reference, exact={**reference.exact, **exact}, numbers=numbers)


def _numbers(state: Mapping[Node, Scalar], trial: Mapping[Node, Any]) -> dict[Node, Any]:
    return dict(zip(state, evaluate(tuple(state.values()), trial, fifty_digits()), strict=True))


# -------- family ----------------------------------------------------------------------------------------------
# The family of steady motions that one belongs to: top, governor, rolling disc in a circle.


@dataclass(frozen=True)
class Family:
    """The steady motions that one belongs to.

    Args:
        held: coordinates and speeds that say which of them it is.
        following: those that follow from these.
        conditions: what vanishes, of both.
        formulas: those that follow, as functions of the held; {}: no closed form.
        state: everything in closed form at the values of the start; {}: not known so.
        zeros: coordinates that are held at 0, by which other conditions are satisfied.
        others: those that follow, in all the motions with the same values held that were found, this one first.
        closed: the same as functions of the held; {} for one that has no closed form.
        complete: True if there are no others in the region that `where` names.
    """

    held: tuple[Node, ...]
    following: tuple[Node, ...]
    conditions: tuple[Scalar, ...]
    formulas: State
    state: State
    zeros: tuple[Node, ...] = ()
    others: tuple[Mapping[Node, float], ...] = ()
    closed: tuple[State, ...] = ()
    complete: bool = False
    where: str = ""
