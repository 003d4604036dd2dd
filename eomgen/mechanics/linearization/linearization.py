"""System -> Linearization: the equations of small motions, exact where they can be, and in numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, EomgenError, MissingValues, NotYet, RunFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Assembly
from eomgen.mechanics.dynamics import System, Valueless
from eomgen.mechanics.equilibrium import Equilibrium, StaticEquations
from eomgen.mechanics.free_bodies import SystemFriction
from eomgen.mechanics.kinematics import Located
from eomgen.mechanics.linearization.reduction import (
    LinearEquations,
    Reducing,
    carrying,
    dependent_speeds,
    equations_without_rounding,
    floats,
    is_second_order,
    over_coordinates,
    over_turns,
    restricted,
    seen_beside_own,
    spinning,
    turned_on,
    unsettled,
)
from eomgen.mechanics.linearization.reference import (
    EQUILIBRIUM,
    START,
    STEADY,
    Choice,
    FirstOrder,
    ReferenceMotion,
    about_place,
    at_the_start,
    choice_of,
    in_closed_form,
    place_of_rest,
    relative_rest,
)
from eomgen.mechanics.linearization.steady import family_of, steady_start
from eomgen.mechanics.state import Exact, NumberField, Numbers
from eomgen.symbolic.expression import Node, ScalarRow, depends_on, jacobian, operations, order, substituted
from eomgen.symbolic.numeric import NoValue, dense, evaluate, fifty_digits, tolerances

# -------- linearization ---------------------------------------------------------------------------------------
# System -> Linearization: the equations of small motions, exact where they can be, and in numbers.


MOST_EXACT = 16  # speeds of equations that are written exactly
MOST_OPERATIONS = 40_000  # of the derivatives before the reference is put in, of what is written exactly
NEARBY = 0.5  # of a radian, metre, or of the start's own value: farther away the start means another place
MOST_FOLLOWING = 8  # dependent coordinates or speeds that are eliminated exactly


@dataclass(frozen=True)
class SmallMotions:
    """The equations of small motions about a reference.

    Args:
        reference: the equilibrium or the steady motion.
        numbers: the equations in floats; where parameters have no values, at values to try.
        exact: the same as scalars of the parameters; None where the reference is not known so, or it is too much work.
        whole: those in floats of every coordinate and speed, of which `numbers` are a part.
        left_out: coordinates on which nothing depends, and which have no speed of their own.
        first: the equations of motion from which they come.
        choice: what stays independent in them.
        kept: the coordinates that carry the motion, by their places among the independent ones.
        wanted: the names of the requested coordinates; () for all.
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
    def equations(self) -> LinearEquations:
        """M, C, K, B, F, E: exact where they are known so, else floats."""
        return self.exact or self.numbers

    @property
    def is_second_order(self) -> bool:
        """True if the equations have the form M q'' + C q' + K q = B w."""
        return is_second_order(self.numbers)

    @property
    def forced(self) -> bool:
        """True if forces change with t about an equilibrium: they are taken as they are at t = 0."""
        equations = self.first.equations
        rows = (*equations.forcing, *equations.gamma, *equations.sigma)
        return self.reference.at_rest and depends_on(rows, (self.first.system.symbols.t,))

    @cached_property
    def state_matrix(self) -> np.ndarray:
        """A of x' = A x + B w, x = (q_i, u_i)."""
        return self.numbers.state_matrix

    @cached_property
    def input_matrix(self) -> np.ndarray:
        """B of x' = A x + B w."""
        e = self.numbers
        n, w = len(e.coordinates), len(e.inputs)
        below = np.linalg.solve(floats(e.M), np.array(e.B, dtype=float).reshape(len(e.speeds), w))
        return np.vstack([np.array(e.D, dtype=float).reshape(n, w), below])

    def roots_over(self, parameter: str, values: Sequence[float]) -> np.ndarray:
        """The eigenvalues at each value of a parameter, a row each; nan where the reference has none.

        Raises:
            RunFailed: the equations are only known at the values of the parameters.
        """
        rows = []
        for value in values:
            try:
                rows.append(np.sort_complex(np.linalg.eigvals(self._matrix_at(parameter, value))))
            except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
                rows.append(np.full(len(self.state_matrix), np.nan, dtype=complex))
        return np.array(rows)

    def _matrix_at(self, parameter: str, value: float) -> np.ndarray:
        """A at another value of a parameter, by the exact equations."""
        exact, scope = self.exact, self.reference.system.scope
        if exact is None:
            what = "the small motions are known in numbers only, at the values of the parameters"
            raise RunFailed(f"{what}: there are no roots over '{parameter}'", fix="take a place in closed form")
        known = scope.model.exact_parameters({parameter: value})  # and those that are expressions of it
        state = {scope.symbols.parameters[name]: float(x) for name, x in known.items()}
        numbers: dict[str, Any] = {name: [evaluate(row, state) for row in getattr(exact, name)] for name in "MCKBFE"}
        return replace(exact, **numbers).state_matrix

    @staticmethod
    def of(
        system: System, about: str, wanted: Sequence[str] = (), guess: Mapping[str, float] | None = None
    ) -> SmallMotions:
        """The equations of small motions of a system.

        Args:
            about: "equilibrium", "start" or "steady".
            wanted: the coordinates in which they are requested; () for all.
            guess: values of coordinates in place of `near` and `start`.
        Raises:
            DerivationError: no equilibrium; the start is no steady motion; nothing can move; the requested
                coordinates do not move by themselves.
        """
        system.scope.model.refuse_motion()
        if not system.symbols.u:
            raise DerivationError(
                "nothing is free to move: there are no small motions",
                "coordinates",
                fix="leave a coordinate free: neither `driven` nor 0 by a constraint",
            )
        reference, first = _balanced(system, about, guess, wanted)
        return _about(first, reference, wanted)


def about_places(places: Sequence[Equilibrium]) -> Iterator[SmallMotions | DerivationError]:
    """The small motions about equilibria of one system, or why there are none."""
    first: FirstOrder | None = None
    for place in places:
        try:
            reference = about_place(place)
            first = FirstOrder.of(reference.system) if first is None else first
            yield _about(first, reference, ())
        except DerivationError as error:
            yield error
        except (NoValue, ZeroDivisionError):
            yield _without_value(reference)


def motions_beside(small: SmallMotions, wanted: Sequence[str] = ()) -> Iterator[SmallMotions | None]:
    """The small motions about the others with the same values held, in numbers; None where angles have a pole."""
    reference = small.reference
    if reference.family is None:
        return
    system = reference.system
    first = FirstOrder.of(system)
    here = {x.name: float(reference.numbers[x]) for x in system.symbols.x}
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
    if not choice.speeds.free:
        raise DerivationError(
            "the constraints leave no degree of freedom: there are no small motions",
            "coordinates",
            fix="remove a constraint",
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
    """Refuses a place where constraints depend on one another that are independent near it.

    What they leave free to first order is no motion.

    Raises:
        DerivationError: it is one.
    """
    try:
        fork = Assembly(reference.system.constraints).fork_at(dict(reference.numbers))
    except (DerivationError, MissingValues):  # the constraints close nowhere near: there is but this place
        return
    if fork is not None:
        what = f"the place is {fork.words}: near it there are no small motions of one kind"
        raise DerivationError(
            what, f"constraints.{fork.constraints[0]}", "give `near` values that lead to another place"
        )


def _stiffness_beside(small: SmallMotions) -> np.ndarray:
    """Largest size of each entry of K at states near an equilibrium that is known in numbers only; 0 otherwise."""
    largest, reference = np.zeros_like(floats(small.numbers.K)), small.reference
    if reference.place is None or reference.is_exact:
        return largest
    for there in reference.place.statics.states_beside(reference.numbers):
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
    """Refuses equations that are known in numbers only, where a parameter has no value.

    Raises:
        DerivationError: those without one are named.
    """
    model = reference.system.scope.model
    missing = [f"'{name}'" for name in reference.system.symbols.parameters if name not in model.exact_parameters()]
    if missing:
        what = f"the reference, or the equations about it, have no closed form: {', '.join(missing)} need values"
        raise DerivationError(what, "parameters", fix="give them values in [parameters]")


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
    lost = [str(each) for each in solved if abs(value([each.determinant])[0]) <= tolerances.REGULAR]
    part = None if lost else Valueless.in_state(reference.system, {x: float(y) for x, y in reference.numbers.items()})
    if part is not None:
        fix = "let what acts be regular there, or start elsewhere"
        return DerivationError(f"{part.what}, the place of reference", part.where, fix)
    what = lost[0] if lost else "the equations of motion, or their derivatives, have no value"
    fix = "describe the motion by coordinates, speeds and forces that are regular there"
    return DerivationError(f"{what} at the place of reference", "linearize", fix)


def _exact_field(reference: ReferenceMotion, first: FirstOrder, choice: Choice) -> Exact | None:
    """Exact entries, where the reference is known so and the work is bounded; None elsewhere."""
    small = (
        len(choice.speeds.free) <= MOST_EXACT
        and max(len(choice.places.following), len(choice.speeds.following)) <= MOST_FOLLOWING
    )
    long = operations(x for row in first.derivatives["R_q"] for x in row).total > MOST_OPERATIONS
    if not reference.is_exact or not small or long:
        return None
    return Exact(reference.exact, reference.system.scope.positive, reference.trial)


# -- test of the reference --------------------------------------------------------------------------------------


def _balanced(
    system: System, about: str, guess: Mapping[str, float] | None, wanted: Sequence[str]
) -> tuple[ReferenceMotion, FirstOrder]:
    """The reference, at which forces and inertia balance, and the equations of its system.

    Where no equilibrium can be sought, or there are many, it is the start if all is at rest there.
    """
    if about in (START, STEADY):
        reference = at_the_start(system, at_rest=False)
        first = FirstOrder.of(system)
        try:
            reference = _steady(first, reference, wanted) if about == STEADY else with_followers(first, reference)
            wrong = _accelerated(first, reference)
        except (NoValue, ZeroDivisionError) as error:
            raise _without_value(reference) from error
        return _near(system, first, reference, wrong, wanted) if wrong else (reference, first)
    try:
        reference = place_of_rest(system, guess)
        first = FirstOrder.of(reference.system)
        _refuse_carried(first, reference)
        return reference, first
    except (DerivationError, NotYet) as error:
        return _other_rest(system, guess, error)


def _near(
    system: System, first: FirstOrder, start: ReferenceMotion, wrong: str, wanted: Sequence[str]
) -> tuple[ReferenceMotion, FirstOrder]:
    """The equilibrium, or of a start that moves the steady motion, near a start that is none.

    Raises:
        DerivationError: the nearest such motion is far away, which the message gives, or none is found.
    """
    what = f"the start is no steady motion: '{wrong}' is accelerated there"
    symbols, number = system.symbols, {x: float(value) for x, value in start.numbers.items()}
    at_rest = not start.moving and all(number[u] == 0 for u in symbols.u)
    kind, a = ("equilibrium", "an") if at_rest else ("steady motion", "a")
    try:
        found = (
            place_of_rest(system, {q.name: number[q] for q in symbols.q}) if at_rest else _steady(first, start, wanted)
        )
        first = FirstOrder.of(found.system)
        if _accelerated(first, found):
            raise DerivationError(what, fix="start from an equilibrium, or a steady motion")
    except (DerivationError, NotYet, NoValue, ZeroDivisionError) as error:
        fix = f'start from {a} {kind}, or let it be sought: about = "{EQUILIBRIUM if at_rest else STEADY}"'
        if symbols.z:
            fix = f"start from {a} {kind}: where the system settles into it, the end of a run has its values"
            fix += f', or let a steady motion be sought: about = "{STEADY}"' if at_rest else ""
        raise DerivationError(f"{what}, and no {kind} was found near it", "linearize.about", fix) from error
    shown = (*found.system.symbols.q, *(() if at_rest else found.system.symbols.u))
    away = {x: float(found.numbers[x]) - number[x] for x in shown}
    if any(abs(d) > NEARBY * max(1.0, abs(number[x])) for x, d in away.items()):
        values = ", ".join(f"{x.name} = {float(found.numbers[x]):.6g} ({d:+.6g})" for x, d in away.items() if d)
        fix = f'start there, or ask about = "{EQUILIBRIUM if at_rest else STEADY}"'
        raise DerivationError(f"{what}; the {kind} nearest to it is not near: {values}", "linearize.about", fix)
    return replace(found, beside={x: number[x] for x in shown}), first


def _refuse_carried(first: FirstOrder, reference: ReferenceMotion) -> None:
    """Refuses a place where all forces balance, but a motion given in t, as of the seat of a joint, accelerates others.

    Raises:
        DerivationError: it does.
    """
    if StaticEquations.standing(reference.system) is reference.system:
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
    """Relative rest, with the family of all places of the same kind."""
    choice = choice_of(first, reference, ())
    kept = [*(first.system.symbols.q[k] for k in choice.places.free), *first.system.symbols.z]
    return replace(reference, family=family_of(first, reference, (), kept))


def _other_rest(
    system: System, guess: Mapping[str, float] | None, why: EomgenError
) -> tuple[ReferenceMotion, FirstOrder]:
    """Rest relative to what the model drives at a steady rate, or the start with all speeds 0.

    Raises:
        EomgenError: `why`, where neither is balanced.
    """
    first = FirstOrder.of(system)
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
    if system.symbols.z and isinstance(why, DerivationError):
        fix = f'{why.fix}; or let a steady motion be sought: about = "{STEADY}"'
        raise DerivationError(why.what, why.where, fix) from why
    raise why


def _accelerated(first: FirstOrder, reference: ReferenceMotion) -> str:
    """The speed that does not stay as it is; "" where all do."""
    reducing = Reducing(first, choice_of(first, reference, ()), Numbers(reference.numbers))
    wrong = unsettled(reducing, tolerances.COMPUTED)
    if wrong:
        return first.system.symbols.u[reducing.choice.speeds.free[wrong[0]]].name
    return _changing_state(first, reference, reducing)


def _changing_state(first: FirstOrder, reference: ReferenceMotion, reducing: Reducing) -> str:
    """The first state of first order whose rate does not vanish there; "" where all do.

    A state on which nothing depends, as a worn volume, may grow.
    """
    symbols, scope = first.system.symbols, first.system.scope
    seen = [z for z in symbols.z if depends_on((*first.residual, *scope.state_rates), (z,))]
    known = {**reference.numbers, **dict(zip(symbols.a, map(fifty_digits().number, reducing.at.a), strict=True))}
    slopes = iter(evaluate([x for row in jacobian(scope.state_rates, symbols.x) for x in row], known, fifty_digits()))
    sizes = [max(1, abs(known[x])) for x in symbols.x]
    for z, rate in zip(symbols.z, evaluate(scope.state_rates, known, fifty_digits()), strict=True):
        usual = sum(abs(next(slopes)) * size for size in sizes)
        if z in seen and abs(rate) > tolerances.COMPUTED * usual:
            return str(z.name)
    return ""


# -------- dependent values ------------------------------------------------------------------------------------
# Reference -> the same with what its constraints say of coordinates and speeds that nobody stated, in closed form.


MOST = 8  # dependent speeds that are eliminated exactly


def with_followers(first: FirstOrder, reference: ReferenceMotion) -> ReferenceMotion:
    """The reference with dependent coordinates by phi = 0 and dependent speeds by J u + sigma = 0, as far as these are
    determined by what is known in closed form; a wheel's place from its turning."""
    symbols, choice = first.system.symbols, choice_of(first, reference, ())
    guessed = _guessed(first, choice)
    if (reference.is_exact and not guessed) or len(choice.speeds.following) > MOST:
        return reference
    positive = first.system.scope.positive
    located = Located({x: float(v) for x, v in reference.numbers.items()}, positive)
    known = {x: value for x, value in reference.exact.items() if x not in guessed}
    try:
        unknown = [q for q in symbols.q if q not in known]
        exact = {**reference.exact, **located.places(substituted(first.relations, known), unknown)}
        if all(x in exact for x in (*symbols.q, *(symbols.u[k] for k in choice.speeds.free))):
            exact |= dependent_speeds(first, choice, Exact(exact, positive, reference.trial))
    except (DerivationError, NoValue, ZeroDivisionError):  # too large, or a pivot that is 0 as a formula
        return reference
    found = {x: value for x, value in exact.items() if x in symbols.x and located.agrees(value, x)}
    return in_closed_form(reference, found)


def _guessed(first: FirstOrder, choice: Choice) -> frozenset[Node]:
    """Dependent coordinates of which the model only has a guess."""
    symbols, coordinates = first.system.symbols, first.system.scope.model.coordinates
    return frozenset(q for k in choice.places.following if coordinates[(q := symbols.q[k]).name].near is not None)


# -------- steadiness ------------------------------------------------------------------------------------------
# Reference -> whether it is one: a state at which the equations are smooth, and later look the same as now.


TIMES = (0.3717281828, 1.1931415926)  # later states of a steady motion, at which it must look the same [of one unit]
CORNERS = frozenset(("abs", "sign", "min", "max", "select"))
SIDES = 4  # directions that are tried, with their opposites
PRIME = "'"
LATER = (13.4142135623, 1717.7724538509)  # the same, where t itself stands in the equations


def reduced_equations(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, field: NumberField
) -> LinearEquations:
    """The equations at a state of the reference, small turns in the place of quaternions that move in it."""
    return reduced_of(Reducing(first, choice, field), reference)


def reduced_of(reducing: Reducing, reference: ReferenceMotion) -> LinearEquations:
    """`reduced_equations`, of what is known of the state.

    Raises:
        DerivationError: dependent coordinates are not determined there.
    """
    system = reference.system
    system.refuse_undetermined(reference.exact, "at the place of reference")
    turns = spinning(reference, reducing.choice)
    return over_turns(reducing.field, reducing.first.system, reducing.equations, turns)


def refuse_corners(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, raw: LinearEquations, kept: Sequence[int]
) -> None:
    """Refuses forces that are not smooth at the reference, as k |x| at x = 0: the equations on both sides must agree.

    Raises:
        DerivationError: they are not.
    """
    if not _cornered((*first.residual, *first.equations.state_rates)):
        return
    symbols, rng = first.system.symbols, Random(7)
    changes = _changed(first, choice, reference, raw, kept)
    for _ in range(SIDES):
        aside = {x: fifty_digits().number(1) * tolerances.SQUARED_SINE * rng.uniform(-1, 1) for x in symbols.x}
        if changes(aside) or changes({x: -d for x, d in aside.items()}):
            rough = [
                f"the friction of '{name}'"
                for name, factor, _ in SystemFriction(first.system).named
                if _cornered((factor,))
            ]
            rates = zip(symbols.z, first.equations.state_rates, strict=True)
            rough += [f"the rate of '{z.name}'" for z, rate in rates if _cornered((rate,))]
            named = [*filter(None, [first.system.loads.acting(_cornered)]), *dict.fromkeys(rough)]
            dry = any(contact.size is not None for contact in first.system.scope.model.rough_contacts)
            raise DerivationError(
                f"{' and '.join(named) or 'the forces'}: a corner or a jump at the place of reference",
                "linearize",
                "choose a place near it, or forces that are smooth there" + ", as dry friction with `smooth`" * dry,
            )


def _cornered(row: ScalarRow) -> bool:
    return any(node.op in CORNERS for node in order(row))


def steady_coordinates(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, raw: LinearEquations, wanted: Sequence[str]
) -> tuple[int, ...]:
    """The coordinates over which the equations stay as they are with time: those that carry the motion.

    Where the reference moves, a coordinate on which nothing depends may have a rate that changes, as the place of a car
    that turns in a circle: it is then left out.

    Raises:
        DerivationError: the coordinate that moves, and on which the others depend, is named.
    """
    coordinates = reference.system.scope.model.coordinates
    kept = carrying(raw, wanted, [name for name, part in coordinates.items() if part.dependent])
    if not (shifts := _unsteady(first, choice, reference, raw, kept)):
        return kept
    fewer = seen_beside_own(raw, kept)
    if len(fewer) < len(kept) and not _unsteady(first, choice, reference, raw, fewer):
        return fewer
    changes = _changed(first, choice, reference, raw, kept)
    t = first.system.symbols.t
    culprit = next((x for x in shifts[0] if changes({x: shifts[0][x]})), t)
    if culprit is t:
        named = first.system.loads.acting(lambda row: depends_on(row, (t,)))
        driven = [f"'{name}'" for name, part in coordinates.items() if part.driven]
        timed = [row.constraint for row in first.system.constraints.rows if depends_on((row.velocity,), (t,))]
        by = " and ".join((*driven, *(f"'{name}'" for name in dict.fromkeys(timed)), *([named] if named else ())))
        raise DerivationError(
            f"coefficients of the small motions change with time{f', by {by}' if by else ''}: there are no modes",
            "linearize",
            "let nothing but inputs depend on t",
        )
    what = f"no steady motion: '{culprit.name}' moves, and the equations depend on it"
    raise DerivationError(what, f"coordinates.{culprit.name}", "only coordinates on which nothing depends may move")


def _unsteady(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, raw: LinearEquations, kept: Sequence[int]
) -> list[dict[Node, Any]]:
    """Changes of coordinates and t up to later states, if the equations differ at one of these; else none."""
    moving, t, graph = reference.moving, first.system.symbols.t, first.equations
    unit = 1 / max((abs(rate) for rate in moving.values()), default=1)
    timed = depends_on((*graph.forcing, *graph.gamma, *graph.sigma), (t,))
    times = (*TIMES, *LATER) if timed else TIMES
    shifts = [{x: rate * unit * time for x, rate in {**moving, t: 1}.items()} for time in times]
    turns = spinning(reference, choice)
    for shift in shifts:
        shift |= {e: x - reference.numbers[e] for e, x in turned_on(turns, reference.numbers, shift[t]).items()}
    return shifts if any(map(_changed(first, choice, reference, raw, kept), shifts)) else []


def refuse_singular(reducing: Reducing, equations: LinearEquations) -> None:
    """Refuses coordinates that do not describe motions there, as angles at a pole.

    Raises:
        DerivationError: the speed that moves nothing is named, where it is one.
    """
    M, Z = floats(equations.M), abs(floats(reducing.at.Z))
    least = np.maximum(
        tolerances.REGULAR * np.diagonal(Z.T @ abs(floats(reducing.at.M)) @ Z), tolerances.SQUARED_SINE * abs(M).max()
    )
    idle = [u.name for u, x, size in zip(equations.speeds, np.diagonal(M), least, strict=True) if abs(x) <= size]
    if idle or dense.scaled_condition(M) > 1 / tolerances.REGULAR:
        moved = f"'{idle[0].rstrip(PRIME)}' moves nothing there" if idle else "two coordinates move the same there"
        raise DerivationError(
            f"the mass matrix is singular at the place: {moved}",
            "linearize",
            "describe the motion by coordinates that are regular there",
        )


def _changed(
    first: FirstOrder, choice: Choice, reference: ReferenceMotion, raw: LinearEquations, kept: Sequence[int]
) -> Callable[[Mapping[Node, Any]], bool]:
    """Test of a shift: True if the equations differ at the shifted state from those at the reference.

    Only symbols that occur in the equations count. At rest a force that changes with t alone does not count: it is on
    the right side, as an input is.
    """
    t = first.system.symbols.t
    here, held = list(_compared(raw, kept)), first.held

    @cache
    def found(shift: tuple[tuple[Node, Any], ...]) -> bool:
        reducing = Reducing(first, choice, Numbers({**reference.numbers, **dict(shift)}))
        try:
            if (not reference.at_rest or any(x is not t for x, _ in shift)) and unsettled(
                reducing, tolerances.COMPUTED
            ):
                return True
            there = list(_compared(reduced_of(reducing, reference), kept)) if shift else here
        except (NoValue, ZeroDivisionError):
            return True
        pairs = zip(here, there, strict=True)
        return any(np.any(abs(A - B) > tolerances.COMPUTED * (abs(A).max(initial=0) + 1e-3)) for A, B in pairs)

    return lambda shift: found(tuple((x, reference.numbers[x] + d) for x, d in shift.items() if x in held))


def _compared(equations: LinearEquations, kept: Sequence[int]) -> Iterator[np.ndarray]:
    yield floats(equations.M)
    yield floats(equations.C)
    yield floats(equations.K)[:, list(kept)]
    yield floats(equations.F)[np.ix_(kept, kept)]
    yield floats(equations.E)[list(kept)]
    if equations.states and equations.inputs:
        yield floats(equations.D)[list(kept)]
