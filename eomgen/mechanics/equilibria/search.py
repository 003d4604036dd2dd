"""System -> where it is at rest: every place at which all forces balance, exact where it can be, and how it keeps it.

In numbers first: equations without jumps in at most three coordinates have all their roots isolated, linear ones have
a single solution; of others those are found that many guesses lead to, and it is said that there may be more. Then in
closed form, taken where it agrees with the numbers and the equations hold exactly.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.bodies.places import Located
from eomgen.mechanics.bodies.system_scene import start_values
from eomgen.mechanics.constraints.closure import generic_state
from eomgen.mechanics.constraints.ties import Ties
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equilibria.closed_rest import ClosedForms
from eomgen.mechanics.equilibria.coordinates_at_rest import Chosen, chosen_coordinates, holds_velocities, unheld
from eomgen.mechanics.equilibria.families import Curve, along_curves, each_once, nearest_first
from eomgen.mechanics.equilibria.guesses import Guess
from eomgen.mechanics.equilibria.locked import is_balanced_in_locked
from eomgen.mechanics.equilibria.one_sided import pulling_contacts
from eomgen.mechanics.equilibria.rest_places import ANYWHERE, Places, places_of_rest
from eomgen.mechanics.equilibria.stability import Stability, stability_of
from eomgen.mechanics.equilibria.static_equations import StaticEquations, static_equations
from eomgen.mechanics.initial_state.numeric_value import known_exactly, shown_numbers
from eomgen.mechanics.initial_state.values_at_rest import values_of_parameters
from eomgen.model.values import exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on_any
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.dense import rank
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50


@dataclass(frozen=True)
class Equilibrium:
    """One place of rest.

    Args:
        statics: the equations that hold there.
        exact: coordinates, and multipliers of closing ties, as scalars of the parameters; those that are known so.
        numbers: all of them as numbers; {} without values of all parameters.
        stability: whether it stays there when it is disturbed.
        curve: of places of rest, of which it is one; None where it is alone.
    """

    statics: StaticEquations
    exact: State
    numbers: Mapping[Node, float]
    stability: Stability
    curve: Curve | None = None

    @property
    def is_exact(self) -> bool:
        """Whether every coordinate is known in closed form."""
        return all(q in self.exact for q in self.statics.system.symbols.q)

    @cached_property
    def pulling(self) -> tuple[str, ...]:
        """The one-sided ties that would have to pull there; () where that is not known."""
        system = self.statics.system
        state: dict[Node, Scalar] = {system.symbols.t: 0, **dict.fromkeys((*system.symbols.u, *system.symbols.a), 0)}
        state |= self.exact if self.is_exact else {q: Fraction(self.numbers[q]) for q in system.symbols.q}
        values = {node: float(x) for node, x in values_of_parameters(system.scope, None).items()}
        return pulling_contacts(system, state, values)

    def refuse_pulling(self) -> None:
        """Refuse a place that a one-sided contact would have to hold.

        Raises:
            DerivationError: one pulls.
        """
        if pulls := self.pulling:
            raise DerivationError(
                f"'{pulls[0]}' would have to pull where the other forces balance",
                f"constraints.{pulls[0]}",
                "without it the system rests elsewhere",
            )


@dataclass(frozen=True)
class Equilibria:
    """The places of rest of a system.

    Args:
        statics: the equations.
        found: each place.
        complete: whether there are no others, where `where` says.
        where: in which range they were sought, in words.
        indifferent: coordinates that no force holds anywhere: they stay where they start.
        chosen: coordinates that velocity ties let it rest at any value of, near the start: they stay there.
    """

    statics: StaticEquations
    found: tuple[Equilibrium, ...]
    complete: bool
    where: str
    indifferent: tuple[Node, ...]
    chosen: tuple[Node, ...] = ()

    def nearest(self, guess: Mapping[str, float] | None = None) -> Equilibrium:
        """The place of rest that is reached from a guess (None: from the start).

        Raises:
            DerivationError: there is none.
        """
        if not self.found:
            raise nowhere(self.complete, self.statics.system.ties)
        return self.found[0]


NO_PLACE = "no place was found at which all forces balance"
MOST_NAMED = 4  # coordinates


def nowhere(complete: bool, ties: Ties) -> DerivationError:
    """That there is no place of rest, that none was found, or that ties do not close anywhere near."""
    try:
        generic_state(ties)
    except DerivationError as error:
        return error
    except MissingValues:  # whether they close cannot be told without values
        pass
    free = [q.name for q in ties.motion.scope.symbols.q if not ties.motion.scope.model.coordinates[q.name].driven]
    along = "".join(f" along '{name}'" for name in free) if len(free) == 1 else ""
    along = f" (of {', '.join(map(repr, free[:MOST_NAMED]))})" if free[1:] else along
    what = f"{NO_PLACE}{along}{': there is none' if complete else ''}"
    mend = "hold by a spring or a tie what nothing balances, or say by `near` where it rests"
    return DerivationError(what, "coordinates", mend)


def all_equilibria(system: System, guess: Mapping[str, float] | None = None) -> Equilibria:
    """Every place of rest that is found, and whether there are others; the nearest to the guess first.

    Args:
        guess: values of coordinates in place of `near` and `start`.
    Raises:
        UsageError: a name in the guess that is no coordinate.
        DerivationError: the forces hold an unknown; dry friction; a drive that turns steadily.
    """
    return equilibria_of(static_equations(system), guess)


def equilibria_of(statics: StaticEquations, guess: Mapping[str, float] | None = None) -> Equilibria:
    """Every place at which static equations hold; see `all_equilibria`.

    Raises:
        UsageError: a name in the guess that is no coordinate.
        DerivationError: the forces hold an unknown.
    """
    return _search(statics, guess).equilibria()


def nearest_equilibrium(statics: StaticEquations, guess: Mapping[str, float] | None = None) -> Equilibrium:
    """The place at which static equations hold that is nearest to a guess (None: to the start).

    Raises:
        UsageError: a name in the guess that is no coordinate.
        DerivationError: there is none; the forces hold an unknown.
    """
    return _search(statics, guess).nearest()


def _search(statics: StaticEquations, guess: Mapping[str, float] | None) -> _Search:
    if statics.loaded:
        what = f"the forces hold the unknown '{statics.loaded[0].name}': it is what holds the system where it starts"
        raise DerivationError(what, f"unknowns.{statics.loaded[0].name}", "give it a value to seek places of rest")
    return _Search(statics.at_the_values(), dict(guess or {}))


@dataclass(frozen=True)
class _Search:
    """Places of rest that are sought.

    Args:
        whole: the equations.
        guess: where, by name.
    """

    whole: StaticEquations
    guess: Mapping[str, float]

    @property
    def system(self) -> System:
        return self.whole.system

    @cached_property
    def statics(self) -> StaticEquations:
        """Without the coordinates that no equation holds, and those that may be chosen."""
        found, open_ = self._held_by_forces, self._chosen.coordinates
        return found.holding({q: self._fixed[q] for q in open_}) if open_ else found

    @cached_property
    def _held_by_forces(self) -> StaticEquations:
        """Without the coordinates that no equation holds."""
        found, scope = self.whole.without(self.whole.indifferent), self.system.scope
        idle = unheld(found) if self._slides else ()
        return found.holding(start_values(scope, idle)) if idle else found

    @property
    def _indifferent(self) -> tuple[Node, ...]:
        return tuple(q for q in self.whole.q if q not in self._held_by_forces.q)

    @cached_property
    def _chosen(self) -> Chosen:
        statics = self._held_by_forces
        if not self._slides:
            return Chosen()
        return replace(
            chosen_coordinates(statics, self.values, self._guess.of(statics.q)), indifferent=self._indifferent
        )

    @cached_property
    def _slides(self) -> bool:
        """Whether velocity ties leave it free to go where none of its coordinates says."""
        return bool(self.whole.J) and holds_velocities(self.whole, self.values, self._guess.of(self.whole.q))

    @cached_property
    def valued(self) -> bool:
        """Whether all parameters that matter have values."""
        known = exact_parameters(self.system.scope.model)
        needed = [x for name, x in self.system.symbols.parameters.items() if name not in known]
        return not depends_on_any((*self.whole.equations, *self._fixed.values()), needed)

    @cached_property
    def values(self) -> dict[Node, Any]:
        """Of the parameters, 50 digits; of those without one, a value to try."""
        return values_of_parameters(self.system.scope, Random(3))

    @cached_property
    def floats(self) -> dict[Node, float]:
        return {node: float(x) for node, x in self.values.items()}

    @cached_property
    def _fixed(self) -> dict[Node, Scalar]:
        """Driven coordinates, those that nothing holds and those chosen, where they start; these at their guess."""
        scope, free = self.system.scope, {*self._held_by_forces.q} - {*self._chosen.coordinates}
        fixed = start_values(scope, (q for q in scope.symbols.q if q not in free))
        return fixed | {q: self._guess.exact(q) for q in self._chosen.coordinates}

    @cached_property
    def _guess(self) -> Guess:
        return Guess(self.system, self.values, self.guess)

    @cached_property
    def _places(self) -> Places:
        """Where the forces balance, the nearest to the guess first."""
        first = self._guess.of(self.statics.q)
        places = places_of_rest(self.statics, self.values, first)
        found = [z for z in places.found if is_balanced_in_locked(self.whole, self._at(z))]
        return replace(places, found=tuple(nearest_first(self.statics, found, first)))

    def _at(self, z: np.ndarray) -> dict[Node, float]:
        """Values of everything at a place."""
        fixed = dict(zip(self._fixed, evaluate(tuple(self._fixed.values()), self.floats, FLOAT), strict=True))
        return {**self.floats, **fixed, **dict(zip(self.statics.unknowns, map(float, z), strict=True))}

    @cached_property
    def _forms(self) -> ClosedForms:
        return ClosedForms(self.statics, self.values, self._places.turning)

    def nearest(self) -> Equilibrium:
        """The place nearest to the guess, alone.

        Raises:
            DerivationError: there is none.
        """
        each = (self._equilibrium(z, self._forms) for z in self._places.found)
        found = next((place for place in each if place is not None), None)
        if found is None:
            raise nowhere(self._places.complete, self.system.ties)
        return found

    def equilibria(self) -> Equilibria:
        places = self._places
        places = replace(places, found=tuple(each_once(self.statics, places.found, self.floats)))
        curves = along_curves(self.statics, places.found, self.floats, places.turning)
        places = replace(places, found=tuple(z for z, _ in curves))
        pairs = [(self._equilibrium(z, self._forms), curve) for z, curve in curves]
        found = [replace(each, curve=curve) for each, curve in pairs if each is not None]
        complete = places.complete and (self.valued or len(found) == len(places.found))
        certain = self.valued or places.where == ANYWHERE
        where = places.where if certain else f"{places.where}, for values like those tried for the parameters"
        return Equilibria(
            self._held_by_forces, tuple(found), complete, where, self._indifferent, self._chosen.coordinates
        )

    def _equilibrium(self, z: np.ndarray, forms: ClosedForms) -> Equilibrium | None:
        """The place, exact where it can be; None where only trial values of the parameters lead to it."""
        numbers = {**self.floats, **dict(zip(self.statics.unknowns, map(float, z), strict=True))}
        located = Located(numbers, self.system.scope.positive)
        held = forms.at(located)
        if not self.valued and held is None:
            return None
        exact = {**self._fixed, **({} if held is None else held.state)}
        fixed = {q: located.value(x) for q, x in self._fixed.items()}
        stability = stability_of(
            self.whole if self._slides else self.statics,
            {**exact, **({} if held is None else held.particular)},
            {**fixed, **numbers},
            self.values if self.valued else None,
            self._chosen if self._slides else None,
        )
        own = fixed | self._determined(z)
        if self.valued:  # what is known in closed form has all its digits
            known = [q for q in own if q in exact]
            sure = shown_numbers([exact[q] for q in known], known_exactly(self.system.scope))
            own |= {q: x for q, x in zip(known, sure, strict=True) if x is not None and math.isfinite(x)}
        return Equilibrium(self.statics, exact, own if self.valued else {}, stability)

    def _determined(self, z: np.ndarray) -> dict[Node, float]:
        """Coordinates, and the multipliers that have a single value."""
        statics, whole, n, at = self.statics, self.whole, len(self.statics.q), self._at(z)
        J = whole.slopes(whole.J, np.array([at[q] for q in whole.q]), self.floats)
        single = [rank(np.delete(J, i, axis=0)) < rank(J) for i in range(len(J))]
        kept = dict(zip(statics.q, z[:n], strict=True))
        kept |= {lam: x for lam, x, one in zip(statics.lam, z[n:], single, strict=True) if one}
        return {node: 0.0 if abs(x) < ZERO_AT_50 else float(x) for node, x in kept.items()}
