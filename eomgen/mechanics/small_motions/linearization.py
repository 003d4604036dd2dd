"""System -> Linearization: the equations of small motions, exact where they can be, and in numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from eomgen.errors import DerivationError, EomgenError, NotYet
from eomgen.mechanics.positive import positive_parameters
from eomgen.mechanics.small_motions.field import Exact, Numbers
from eomgen.mechanics.small_motions.first_order import Choice, FirstOrder, choice_of, first_order_of
from eomgen.mechanics.small_motions.forms import (
    carrying,
    floats,
    is_second_order,
    over_coordinates,
    restricted,
    without_rounding,
)
from eomgen.mechanics.small_motions.reduction import REST, LinearEquations, Reducing, unsettled
from eomgen.mechanics.small_motions.reference import (
    START,
    STEADY,
    Reference,
    at_the_start,
    place_of_rest,
    relative_rest,
)
from eomgen.mechanics.small_motions.steadiness import reduced, refuse_corners, refuse_unsteady
from eomgen.mechanics.small_motions.steady import steady_start
from eomgen.mechanics.system import System
from eomgen.model.unknowns import refuse_motion
from eomgen.symbolic import dense
from eomgen.symbolic.evaluation import NoValue, operations
from eomgen.symbolic.graph import Node

PRIME = "'"
REGULAR = 1e-12  # of the scaled mass matrix, below which it is singular
MOST_EXACT = 16  # speeds of equations that are written exactly
MOST_OPERATIONS = 40_000  # of the derivatives before the reference is put in, of what is written exactly
MOST_FOLLOWING = 8  # dependent coordinates or speeds that are taken out exactly


@dataclass(frozen=True)
class SmallMotions:
    """The equations of small motions about a reference.

    Args:
        reference: the place of rest or the steady motion.
        numbers: the equations in floats; where parameters have no values, at values to try.
        exact: the same as scalars of the parameters; None where the reference is not known so, or it is too much work.
        whole: those in floats of every coordinate and speed, of which `numbers` are a part.
        left_out: coordinates on which nothing depends, and which have no speed of their own.
    """

    reference: Reference
    numbers: LinearEquations
    exact: LinearEquations | None
    whole: LinearEquations
    left_out: tuple[Node, ...]

    @property
    def is_second_order(self) -> bool:
        """Whether they are M q'' + C q' + K q = B w."""
        return is_second_order(self.numbers)

    @cached_property
    def state_matrix(self) -> np.ndarray:
        """A of x' = A x + B w, x = (q_i, u_i)."""
        return state_matrix_of(self.numbers)

    @cached_property
    def input_matrix(self) -> np.ndarray:
        """B of x' = A x + B w."""
        e = self.numbers
        n, w = len(e.coordinates), len(e.inputs)
        below = np.linalg.solve(floats(e.M), np.array(e.B, dtype=float).reshape(len(e.speeds), w))
        return np.vstack([np.zeros((n, w)), below])


def state_matrix_of(e: LinearEquations) -> np.ndarray:
    """A of x' = A x, x = (q_i, u_i)."""
    M, C, K = (floats(x) for x in (e.M, e.C, e.K))
    return np.block([[floats(e.F), floats(e.E)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])


def small_motions_of(
    system: System, about: str, wanted: Sequence[str] = (), guess: Mapping[str, float] | None = None
) -> SmallMotions:
    """The equations of small motions of a system.

    Args:
        about: "equilibrium", "start" or "steady".
        wanted: the coordinates in which they are asked; () for all.
        guess: values of coordinates in place of `near` and `start`.
    Raises:
        DerivationError: no place of rest; the start is no steady motion; nothing can move; the coordinates asked do not
            move by themselves.
    """
    refuse_motion(system.scope.model)
    reference, first = _balanced(system, about, guess, wanted)
    if not first.system.symbols.u:
        raise DerivationError("nothing is free to move: there are no small motions")
    choice = choice_of(first, reference, wanted)
    if not choice.u:
        raise DerivationError("the ties leave no freedom: there are no small motions")
    raw = _equations(first, choice, reference)
    kept = carrying(raw, wanted)
    refuse_corners(first, choice, reference, raw, kept)
    refuse_unsteady(first, choice, reference, raw, kept)
    _refuse_singular(raw)
    decided = over_coordinates(Numbers(reference.numbers), raw, kept)
    numbers = without_rounding(restricted(Numbers(reference.numbers), decided, wanted, decided))
    field = _exact_field(reference, first, choice)
    exact = None
    if field is not None:
        whole = over_coordinates(field, reduced(first, choice, reference, field), kept)
        exact = restricted(field, whole, wanted, decided)
    left = tuple(q for k, q in enumerate(raw.coordinates) if k not in kept)
    return SmallMotions(reference, numbers, exact, raw, left)


def _equations(first: FirstOrder, choice: Choice, reference: Reference) -> LinearEquations:
    """The equations in numbers.

    Raises:
        DerivationError: they have no value there: rates that declared speeds do not determine are named.
    """
    try:
        return reduced(first, choice, reference, Numbers(reference.numbers))
    except (NoValue, ZeroDivisionError) as error:
        raise _without_value(reference) from error


def _without_value(reference: Reference) -> DerivationError:
    solved, value = reference.system.declared, Numbers(reference.numbers).of
    lost = [str(each) for each in solved if abs(value([each.determinant])[0]) <= REGULAR]
    what = lost[0] if lost else "the equations of motion, or their derivatives, have no value"
    mend = "describe the motion by coordinates, speeds and forces that are regular there"
    return DerivationError(f"{what} at the place of reference", "linearize", mend)


def _exact_field(reference: Reference, first: FirstOrder, choice: Choice) -> Exact | None:
    """Exact entries, where the reference is known so and the work is bounded; None elsewhere."""
    small = len(choice.u) <= MOST_EXACT and max(len(choice.dq), len(choice.du)) <= MOST_FOLLOWING
    long = operations(x for row in first.derivatives["R_q"] for x in row).total > MOST_OPERATIONS
    if not reference.is_exact or not small or long:
        return None
    return Exact(reference.exact, positive_parameters(reference.system.scope), reference.trial)


def _refuse_singular(equations: LinearEquations) -> None:
    """Coordinates that do not describe motions there, as angles at a pole.

    Raises:
        DerivationError: the speed that moves nothing is named, where it is one.
    """
    M = floats(equations.M)
    idle = [u.name for u, x in zip(equations.speeds, np.diagonal(M), strict=True) if abs(x) <= REGULAR * abs(M).max()]
    if idle or dense.scaled_condition(M) > 1 / REGULAR:
        moved = f"'{idle[0].rstrip(PRIME)}' moves nothing there" if idle else "two coordinates move the same there"
        raise DerivationError(f"the mass matrix is singular at the place: {moved}", "linearize",
                              "describe the motion by coordinates that are regular there")  # fmt: skip


# -- whether it is a reference ---------------------------------------------------------------------------------


def _balanced(system: System, about: str, guess: Mapping[str, float] | None, wanted: Sequence[str]
              ) -> tuple[Reference, FirstOrder]:  # fmt: skip
    """The reference, at which forces and inertia balance, and the equations of its system.

    Where no place of rest can be sought, or there are many, it is the start if all is at rest there.
    """
    if about in (START, STEADY):
        reference = at_the_start(system, at_rest=False)
        first = first_order_of(system)
        try:
            if about == STEADY:
                found = at_the_start(system, at_rest=False, given=steady_start(first, reference, wanted))
                reference = replace(found, about=STEADY)
            wrong = _accelerated(first, reference)
        except (NoValue, ZeroDivisionError) as error:
            raise _without_value(reference) from error
        if wrong:
            raise DerivationError(f"the start is no steady motion: '{wrong}' is accelerated there", "linearize.about",
                                  'start from a steady motion, or let it be sought: about = "steady"')  # fmt: skip
        return reference, first
    try:
        reference = place_of_rest(system, guess)
        return reference, first_order_of(reference.system)
    except (DerivationError, NotYet) as error:
        return _other_rest(system, guess, error)


def _other_rest(
    system: System, guess: Mapping[str, float] | None, why: EomgenError
) -> tuple[Reference, FirstOrder]:
    """Rest beside what the model drives steadily, or the start without speeds."""
    first = first_order_of(system)
    driven = any(part.driven for part in system.scope.model.coordinates.values())
    ways = (lambda: relative_rest(system, first.assembly, guess), lambda: at_the_start(system, at_rest=True))
    for way in ways[0 if driven else 1 :]:
        try:
            reference = way()
            if not _accelerated(first, reference):
                return reference, first
        except (EomgenError, NoValue, ZeroDivisionError):
            continue
    raise why


def _accelerated(first: FirstOrder, reference: Reference) -> str:
    """The speed that does not stay as it is; "" where all do."""
    reducing = Reducing(first, choice_of(first, reference, ()), Numbers(reference.numbers))
    wrong = unsettled(reducing, REST)
    return first.system.symbols.u[reducing.choice.u[wrong[0]]].name if wrong else ""
