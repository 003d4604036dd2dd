"""System -> Linearization: the equations of small motions, exact where they can be, and in numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from eomgen.errors import DerivationError, EomgenError, MissingValues, NotYet
from eomgen.mechanics.constraints.bifurcations import fork_at
from eomgen.mechanics.equations.no_value import valueless
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equilibria.higher_derivatives import states_beside
from eomgen.mechanics.equilibria.standing import standing_system
from eomgen.mechanics.small_motions.dependent_values import with_followers
from eomgen.mechanics.small_motions.field import Exact, NumberField, Numbers
from eomgen.mechanics.small_motions.first_order import Choice, FirstOrder, choice_of, first_order_of
from eomgen.mechanics.small_motions.forms import (
    equations_without_rounding,
    floats,
    is_second_order,
    over_coordinates,
    restricted,
)
from eomgen.mechanics.small_motions.reduction import LinearEquations, Reducing, unsettled
from eomgen.mechanics.small_motions.reference import (
    EQUILIBRIUM,
    START,
    STEADY,
    ReferenceMotion,
    at_the_start,
    in_closed_form,
    place_of_rest,
    relative_rest,
)
from eomgen.mechanics.small_motions.spin_axes import spinning
from eomgen.mechanics.small_motions.steadiness import (
    reduced_equations,
    refuse_corners,
    refuse_singular,
    steady_coordinates,
)
from eomgen.mechanics.small_motions.steady import steady_start
from eomgen.mechanics.small_motions.steady_family import family_of
from eomgen.model.unknowns import refuse_motion
from eomgen.model.values import exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on_any
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.traversal import operations
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import COMPUTED, REGULAR

MOST_EXACT = 16  # speeds of equations that are written exactly
MOST_OPERATIONS = 40_000  # of the derivatives before the reference is put in, of what is written exactly
NEARBY = 0.5  # of a radian, metre, or of the start's own value: farther away the start means another place
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
        first: the equations of motion from which they come.
        choice: what stays independent in them.
        kept: the coordinates that carry the motion, by their places among the independent ones.
        wanted: the names of those that are asked; () for all.
    """

    reference: ReferenceMotion
    numbers: LinearEquations
    exact: LinearEquations | None
    whole: LinearEquations
    left_out: tuple[Node, ...]
    first: FirstOrder
    choice: Choice
    kept: tuple[int, ...]
    wanted: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<small motions of {self.reference.system.scope.model.name!r}>"

    def over(self, field: NumberField) -> LinearEquations:
        """The same equations with entries of another kind."""
        whole = over_coordinates(field, reduced_equations(self.first, self.choice, self.reference, field), self.kept)
        decided = over_coordinates(Numbers(self.reference.numbers), self.whole, self.kept)
        return restricted(field, whole, self.wanted, decided)

    @property
    def is_second_order(self) -> bool:
        """Whether they are M q'' + C q' + K q = B w."""
        return is_second_order(self.numbers)

    @property
    def forced(self) -> bool:
        """Whether forces change with t about a place of rest: they are taken as they are at t = 0."""
        equations = self.first.equations
        rows = (*equations.forcing, *equations.gamma, *equations.sigma)
        return self.reference.at_rest and depends_on_any(rows, (self.first.system.symbols.t,))

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
    if not system.symbols.u:
        raise DerivationError(
            "nothing is free to move: there are no small motions",
            "coordinates",
            mend="leave a coordinate free: neither `driven` nor 0 by a constraint",
        )
    reference, first = _balanced(system, about, guess, wanted)
    return _about(first, reference, wanted)


def motions_beside(small: SmallMotions, wanted: Sequence[str] = ()) -> Iterator[SmallMotions | None]:
    """The small motions about the others with the same values held, in numbers; None where angles have a pole."""
    reference = small.reference
    if reference.family is None:
        return
    system = reference.system
    first = first_order_of(system)
    here = {x.name: float(reference.numbers[x]) for x in (*system.symbols.q, *system.symbols.u)}
    for place in reference.family.others[1:]:
        given = here | {x.name: value for x, value in place.items()}
        try:
            there = at_the_start(system, at_rest=False, given=given)
            yield _about(first, replace(there, exact={}, about=reference.about), wanted)
        except (DerivationError, NoValue, ZeroDivisionError):  # angles at a pole
            yield None


def _about(first: FirstOrder, reference: ReferenceMotion, wanted: Sequence[str]) -> SmallMotions:
    first = first.looked_at(at_rest=reference.at_rest)
    choice = choice_of(first, reference, wanted)
    if not choice.u:
        raise DerivationError(
            "the ties leave no freedom: there are no small motions", "coordinates", mend="take a constraint away"
        )
    choice, raw, kept = _steady_equations(first, choice, reference, wanted)
    refuse_corners(first.looked_at(at_rest=False), choice, reference, raw, kept)
    _refuse_fork(reference)
    refuse_singular(Reducing(first, choice, Numbers(reference.numbers)), raw)
    decided = over_coordinates(Numbers(reference.numbers), raw, kept)
    numbers = restricted(Numbers(reference.numbers), decided, wanted, decided)
    left = tuple(q for k, q in enumerate(raw.coordinates) if k not in kept)
    small = SmallMotions(reference, numbers, None, raw, left, first, choice, kept, tuple(wanted))
    small = replace(small, numbers=equations_without_rounding(numbers, _stiffness_beside(small)))
    field = _exact_field(reference, first, choice)
    if field is None:
        _refuse_unvalued(reference)
        return small
    return replace(small, exact=small.over(field))


def _refuse_fork(reference: ReferenceMotion) -> None:
    """A place at which ties depend on one another that do not beside it: what they leave to first order is no motion.

    Raises:
        DerivationError: it is one.
    """
    try:
        fork = fork_at(reference.system.ties, dict(reference.numbers))
    except (DerivationError, MissingValues):  # the ties close nowhere near: there is but this place
        return
    if fork is not None:
        what = f"the place is {fork.words}: beside it there are no small motions of one kind"
        raise DerivationError(what, f"constraints.{fork.ties[0]}", "give `near` values that lead to another place")


def _stiffness_beside(small: SmallMotions) -> np.ndarray:
    """How large the entries of K are beside a place of rest that is known in numbers only."""
    largest, reference = np.zeros_like(floats(small.numbers.K)), small.reference
    if reference.place is None or reference.is_exact:
        return largest
    for there in states_beside(reference.numbers, reference.place.statics.q):
        try:
            found = floats(small.over(Numbers(there)).K)
        except (DerivationError, NoValue, ZeroDivisionError, np.linalg.LinAlgError):
            continue
        if found.shape == largest.shape:
            largest = np.maximum(largest, abs(found))
    return largest


def _steady_equations(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, wanted: Sequence[str]
) -> tuple[Choice, LinearEquations, tuple[int, ...]]:
    """The equations in numbers, and the coordinates over which they stay as they are; where bodies spin about axes that
    stand still if they do not stay so about their own."""
    raw = _equations(first, choice, reference)
    try:
        return choice, raw, steady_coordinates(first, choice, reference, raw, wanted)
    except DerivationError as error:
        standing = replace(choice, standing=True)
        if not any(turn.standing for turn in spinning(reference, standing)):
            raise
        raw = _equations(first, standing, reference)
        try:
            return standing, raw, steady_coordinates(first, standing, reference, raw, wanted)
        except DerivationError:
            raise error from None


def _refuse_unvalued(reference: ReferenceMotion) -> None:
    """Equations that are only known in numbers need values of all parameters.

    Raises:
        DerivationError: those without one are named.
    """
    model = reference.system.scope.model
    missing = [f"'{name}'" for name in reference.system.symbols.parameters if name not in exact_parameters(model)]
    if missing:
        what = f"the reference, or the equations about it, have no closed form: {', '.join(missing)} need values"
        raise DerivationError(what, "parameters", mend="give them values in [parameters]")


def _equations(first: FirstOrder, choice: Choice, reference: ReferenceMotion) -> LinearEquations:
    """The equations in numbers.

    Raises:
        DerivationError: they have no value there: rates that declared speeds do not determine are named.
    """
    try:
        return reduced_equations(first, choice, reference, Numbers(reference.numbers))
    except (NoValue, ZeroDivisionError) as error:
        raise _without_value(reference) from error


def _without_value(reference: ReferenceMotion) -> DerivationError:
    solved, value = reference.system.declared, Numbers(reference.numbers).of
    lost = [str(each) for each in solved if abs(value([each.determinant])[0]) <= REGULAR]
    part = None if lost else valueless(reference.system, {x: float(y) for x, y in reference.numbers.items()})
    if part is not None:
        mend = "let what acts be regular there, or start elsewhere"
        return DerivationError(f"{part.what}, the place of reference", part.where, mend)
    what = lost[0] if lost else "the equations of motion, or their derivatives, have no value"
    mend = "describe the motion by coordinates, speeds and forces that are regular there"
    return DerivationError(f"{what} at the place of reference", "linearize", mend)


def _exact_field(reference: ReferenceMotion, first: FirstOrder, choice: Choice) -> Exact | None:
    """Exact entries, where the reference is known so and the work is bounded; None elsewhere."""
    small = len(choice.u) <= MOST_EXACT and max(len(choice.dq), len(choice.du)) <= MOST_FOLLOWING
    long = operations(x for row in first.derivatives["R_q"] for x in row).total > MOST_OPERATIONS
    if not reference.is_exact or not small or long:
        return None
    return Exact(reference.exact, reference.system.scope.positive, reference.trial)


# -- whether it is a reference ---------------------------------------------------------------------------------


def _balanced(
    system: System, about: str, guess: Mapping[str, float] | None, wanted: Sequence[str]
) -> tuple[ReferenceMotion, FirstOrder]:
    """The reference, at which forces and inertia balance, and the equations of its system.

    Where no place of rest can be sought, or there are many, it is the start if all is at rest there.
    """
    if about in (START, STEADY):
        reference = at_the_start(system, at_rest=False)
        first = first_order_of(system)
        try:
            reference = _steady(first, reference, wanted) if about == STEADY else with_followers(first, reference)
            wrong = _accelerated(first, reference)
        except (NoValue, ZeroDivisionError) as error:
            raise _without_value(reference) from error
        return _near(system, first, reference, wrong, wanted) if wrong else (reference, first)
    try:
        reference = place_of_rest(system, guess)
        first = first_order_of(reference.system)
        _refuse_carried(first, reference)
        return reference, first
    except (DerivationError, NotYet) as error:
        return _other_rest(system, guess, error)


def _near(
    system: System, first: FirstOrder, start: ReferenceMotion, wrong: str, wanted: Sequence[str]
) -> tuple[ReferenceMotion, FirstOrder]:
    """The place of rest, or of a start that moves the steady motion, near a start that is none.

    Raises:
        DerivationError: the start is told, and what is nearest to it where that is far away, or not found.
    """
    what = f"the start is no steady motion: '{wrong}' is accelerated there"
    symbols, number = system.symbols, {x: float(value) for x, value in start.numbers.items()}
    at_rest = not start.moving and all(number[u] == 0 for u in symbols.u)
    kind = "place of rest" if at_rest else "steady motion"
    try:
        found = (
            place_of_rest(system, {q.name: number[q] for q in symbols.q}) if at_rest else _steady(first, start, wanted)
        )
        first = first_order_of(found.system)
        if _accelerated(first, found):
            raise DerivationError(what, mend="start from a place of rest, or a steady motion")
    except (DerivationError, NotYet, NoValue, ZeroDivisionError) as error:
        mend = f'start from a {kind}, or let it be sought: about = "{EQUILIBRIUM if at_rest else STEADY}"'
        raise DerivationError(f"{what}, and no {kind} was found near it", "linearize.about", mend) from error
    shown = (*found.system.symbols.q, *(() if at_rest else found.system.symbols.u))
    away = {x: float(found.numbers[x]) - number[x] for x in shown}
    if any(abs(d) > NEARBY * max(1.0, abs(number[x])) for x, d in away.items()):
        values = ", ".join(f"{x.name} = {float(found.numbers[x]):.6g} ({d:+.6g})" for x, d in away.items() if d)
        mend = f'start there, or ask about = "{EQUILIBRIUM if at_rest else STEADY}"'
        raise DerivationError(f"{what}; the {kind} nearest to it is not near: {values}", "linearize.about", mend)
    return replace(found, beside={x: number[x] for x in shown}), first


def _refuse_carried(first: FirstOrder, reference: ReferenceMotion) -> None:
    """What an explicit time moves, as the seat of a joint, may accelerate the others where all forces balance.

    Raises:
        DerivationError: it does.
    """
    if standing_system(reference.system) is reference.system:
        return
    if wrong := _accelerated(first, reference):
        what = f"what moves by an explicit time accelerates '{wrong}' where all forces balance: nothing is at rest"
        raise DerivationError(what, "linearize", "hold it, or let an input push in its place")


def _steady(first: FirstOrder, start: ReferenceMotion, wanted: Sequence[str]) -> ReferenceMotion:
    """The steady motion nearest to the start, in closed form where its family has one."""
    found = steady_start(first, start, wanted)
    there = replace(at_the_start(first.system, at_rest=False, given=found.values), about=STEADY)
    family = family_of(first, there, wanted, found.following)
    return there if family is None else in_closed_form(replace(there, family=family), family.state)


def _with_family(first: FirstOrder, reference: ReferenceMotion) -> ReferenceMotion:
    """Rest beside drives with all its places."""
    choice = choice_of(first, reference, ())
    return replace(reference, family=family_of(first, reference, (), [first.system.symbols.q[k] for k in choice.q]))


def _other_rest(
    system: System, guess: Mapping[str, float] | None, why: EomgenError
) -> tuple[ReferenceMotion, FirstOrder]:
    """Rest beside what the model drives steadily, or the start without speeds."""
    first = first_order_of(system)
    driven = any(part.driven for part in system.scope.model.coordinates.values())
    ways: tuple[Callable[[], ReferenceMotion], ...] = (
        lambda: relative_rest(first.equations, guess),
        lambda: at_the_start(system, at_rest=True),
    )
    for way in ways[0 if driven else 1 :]:
        try:
            reference = way()
            if not _accelerated(first, reference):
                return _with_family(first, reference) if reference.moving else reference, first
        except (DerivationError, MissingValues, NoValue, ZeroDivisionError):
            continue
    raise why


def _accelerated(first: FirstOrder, reference: ReferenceMotion) -> str:
    """The speed that does not stay as it is; "" where all do."""
    reducing = Reducing(first, choice_of(first, reference, ()), Numbers(reference.numbers))
    wrong = unsettled(reducing, COMPUTED)
    return first.system.symbols.u[reducing.choice.u[wrong[0]]].name if wrong else ""
