"""A steady motion in numbers -> the family that it belongs to: its conditions, and what follows from what is held.

The equations of a steady motion, with the coordinates and speeds that say which one it is as symbols, are

    Z^T (M a - forcing) = 0  at  a_i = 0,   phi = 0,   q_k' = 0 of the coordinates that are seen

multipliers, dependent speeds and accelerations eliminated, which stand in them linearly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.places import Located, places_of
from eomgen.mechanics.equilibria.rest_places import places_of_rest
from eomgen.mechanics.equilibria.static_equations import StaticEquations
from eomgen.mechanics.small_motions.family import Family
from eomgen.mechanics.small_motions.field import Exact
from eomgen.mechanics.small_motions.first_order import Choice, FirstOrder, choice_of
from eomgen.mechanics.small_motions.reduction import Reducing, dependent_speeds
from eomgen.mechanics.small_motions.reference import ReferenceMotion
from eomgen.mechanics.small_motions.steady import Here
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.traversal import operations
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import BEST
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size
from eomgen.symbolic.solve.solving import vanishes

MOST_OPERATIONS = 600  # of the equations of motion that are written as conditions
MOST_OF_TIES = 250  # of the rows by which speeds are taken out
MOST_FOLLOWING = 4  # dependent coordinates and speeds
LONGEST = 1_200  # characters of conditions that are solved
MOST_SOUGHT = 2  # unknowns of which all values are sought


def family_of(
    first: FirstOrder, reference: ReferenceMotion, wanted: Sequence[str], following: Sequence[Node]
) -> Family | None:
    """The family of a steady motion; None where its conditions are too long to be written.

    Args:
        reference: the motion in numbers, what is held of the start exact.
        wanted: coordinates that are to stay independent.
        following: independent coordinates and speeds that are not held.
    """
    choice = choice_of(first, reference, wanted)
    if not _is_small(first, choice):
        return None
    try:
        return _Writing(first, reference, choice, tuple(following)).family()
    except (DerivationError, NoValue, ZeroDivisionError):  # too large, or a pivot that is 0 as a formula
        return None


def _is_small(first: FirstOrder, choice: Choice) -> bool:
    """Whether the conditions are written in a second or two."""
    driven = sum(part.driven for part in first.system.scope.model.coordinates.values())
    if len(choice.dq) - driven + len(choice.du) > MOST_FOLLOWING or operations(first.residual).total > MOST_OPERATIONS:
        return False
    rows = [x for i in choice.ties for x in (*first.equations.J[i], first.equations.gamma[i])]
    return operations(rows).total <= MOST_OF_TIES


@dataclass(frozen=True)
class _Writing:
    """The conditions, and what they say.

    Args:
        first: the equations of motion.
        reference: the motion in numbers.
        choice: what stays independent there.
        moved: independent coordinates and speeds that are not held.
    """

    first: FirstOrder
    reference: ReferenceMotion
    choice: Choice
    moved: tuple[Node, ...]

    def family(self) -> Family | None:
        if self._fixed is None:
            return None
        held = tuple(x for x in self._independent if x not in self._unknowns and _any_depends(self._conditions, x))
        formulas = self._solved(self._conditions)
        family = Family(held, self._unknowns, self._conditions, formulas, self._state(held, formulas), self._zeros)
        return self._with_others(family)

    @cached_property
    def _independent(self) -> tuple[Node, ...]:
        symbols = self.first.system.symbols
        return (*(symbols.q[k] for k in self.choice.q), *(symbols.u[k] for k in self.choice.u))

    @cached_property
    def _seen(self) -> tuple[Node, ...]:
        """The independent coordinates that stand still."""
        q = self.first.system.symbols.q
        return tuple(q[self.choice.q[j]] for j in Here.at(self.first, self.choice, self.reference.numbers).still)

    @cached_property
    def _following(self) -> tuple[Node, ...]:
        """Dependent coordinates that are not driven."""
        symbols, coordinates = self.first.system.symbols, self.first.system.scope.model.coordinates
        return tuple(q for k in self.choice.dq if not coordinates[(q := symbols.q[k]).name].driven)

    @cached_property
    def _fixed(self) -> State | None:
        """What need not be sought: coordinates on which nothing depends, drives, inputs, speeds that are 0; all exact.

        None where the start does not say them exactly.
        """
        symbols, exact, numbers = self.first.system.symbols, self.reference.exact, self.reference.numbers
        still = {u: 0 for u in self._independent if u in symbols.u and numbers[u] == 0}
        sought = {*self._seen, *self._following, *symbols.u}
        others = [x for x in (*symbols.q, symbols.t, *symbols.inputs.values()) if x not in sought]
        if any(x not in exact for x in others):
            return None
        fixed = {x: exact[x] for x in others} | still
        return fixed | dependent_speeds(self.first, self.choice, self._at(fixed))

    def _at(self, state: State) -> Exact:
        return Exact(state, self.first.system.scope.positive, self.reference.numbers)

    @cached_property
    def _unknowns(self) -> tuple[Node, ...]:
        fixed = self._fixed or {}
        return (*(x for x in self.moved if x not in fixed), *self._following)

    @cached_property
    def _zeros(self) -> tuple[Node, ...]:
        """Held coordinates that are 0, where conditions are more than unknowns: some are kept by them, by symmetry."""
        if len(self._all) <= len(self._unknowns):
            return ()
        exact = self.reference.exact
        held = (x for x in self._independent if x not in self._unknowns and _any_depends(self._all, x))
        return tuple(x for x in held if x in exact and is_zero(exact[x]))

    @cached_property
    def _conditions(self) -> tuple[Scalar, ...]:
        """What vanishes, beside what is 0."""
        if not self._zeros:
            return self._all
        left = substituted(self._all, dict.fromkeys(self._zeros, 0))
        positive = self.first.system.scope.positive
        return tuple(simplest(x, Work.VALUE, positive) for x in left if not is_zero(x) and not vanishes(x))

    @cached_property
    def _all(self) -> tuple[Scalar, ...]:
        """What vanishes."""
        first, choice = self.first, self.choice
        field = self._at(self._fixed or {})
        rates = [first.system.scope.rates[first.system.symbols.q.index(q)] for q in self._seen]
        relations = [first.relations[i] for i in choice.relations if i < len(first.relations)]
        left = (*Reducing(first, choice, field).unbalanced, *field.of((*rates, *relations)))
        return tuple(x for x in left if not is_zero(x))

    @cached_property
    def _located(self) -> Located:
        numbers = {x: float(v) for x, v in self.reference.numbers.items()}
        return Located(numbers, self.first.system.scope.positive)

    def _solved(self, conditions: Sequence[Scalar], located: Located | None = None) -> State:
        """The unknowns in closed form; {} where there is none."""
        if sum(map(text_size, conditions)) > LONGEST:
            return {}
        try:
            found = places_of(conditions, self._unknowns, located or self._located)
            left = substituted(tuple(conditions), found)
        except (DerivationError, NoValue, ZeroDivisionError):
            return {}
        return found if len(found) == len(self._unknowns) and all(map(vanishes, left)) else {}

    def _state(self, held: Sequence[Node], formulas: State) -> State:
        """Everything at the start's values of what is held; {} where that is not known in closed form."""
        exact, symbols = self.reference.exact, self.first.system.symbols
        if any(x not in exact for x in held) or self._fixed is None:
            return {}
        start = {x: exact[x] for x in self._independent if x in exact and x not in self._unknowns}
        found = formulas or self._solved(substituted(self._conditions, start))
        if not found:
            return {}
        at = start | dict(zip(found, substituted(tuple(found.values()), start), strict=True))
        whole = {**at, **dict(zip(self._fixed, substituted(tuple(self._fixed.values()), at), strict=True))}
        positive = self.first.system.scope.positive
        state = {x: simplest(whole[x], Work.VALUE, positive) for x in (*symbols.q, *symbols.u) if x in whole}
        return state if all(self._located.agrees(value, x) for x, value in state.items()) else {}

    def _with_others(self, family: Family) -> Family:
        """With every motion that has the same values held, as far as they are found."""
        unknowns, conditions = self._unknowns, self._conditions
        if not unknowns or len(unknowns) != len(conditions) or len(unknowns) > MOST_SOUGHT:
            return family
        numbers = self.reference.numbers
        sought = StaticEquations(
            system=self.first.system, held=(), q=unknowns, given={}, Q=conditions, unbalanced=(), J=(), lam=(), phi=()
        )
        at = np.array([float(numbers[x]) for x in unknowns])
        places = places_of_rest(sought, {x: v for x, v in numbers.items() if x not in unknowns}, at)
        others = tuple(
            {x: float(v) if abs(v) > BEST else 0.0 for x, v in zip(unknowns, z, strict=True)} for z in places.found
        )
        closed = tuple(self._solved(conditions, self._beside(at)) for at in others)
        return replace(family, others=others, closed=closed, complete=places.complete, where=places.where)

    def _beside(self, at: Mapping[Node, float]) -> Located:
        return Located({**self._located.numbers, **at}, self._located.positive)


def _any_depends(scalars: Sequence[Scalar], x: Node) -> bool:
    return any(depends_on(each, (x,)) for each in scalars)
