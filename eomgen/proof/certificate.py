"""Certificates: of the equations of motion, of their reactions, and of their equilibria; what was checked, and how.

Independent routes must agree: energies and their derivatives (Lagrange), twists and wrenches
(projection), recursion over the tree. What they share is checked by itself: twists against
differences of poses, accelerations against free bodies in numbers, the energy identity, reactions by the balance of
every body and of the whole, the emitted code.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, partial
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np

from eomgen.errors import DerivationError, ModelError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.mechanics.equilibrium import Equilibrium
from eomgen.mechanics.free_bodies import Reactions, SystemFriction
from eomgen.mechanics.linearization import FirstOrder
from eomgen.mechanics.start import Start
from eomgen.proof.at_a_state import NumericState, moving_states, off_by, place_of, read_back
from eomgen.proof.check import Certificate, Check, Tally, attempted, checked, first_wrong, unchecked
from eomgen.proof.declared_loads import declared_state_rates
from eomgen.proof.degrees_of_freedom import Nearby
from eomgen.proof.free_bodies import demand_of
from eomgen.proof.identities import identity_checks
from eomgen.proof.masses import other_data
from eomgen.proof.printed import Printed
from eomgen.proof.states import STEP, with_inputs
from eomgen.proof.trials import Trials
from eomgen.resources import doing, growing
from eomgen.symbolic.expression import Node, jacobian
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

if TYPE_CHECKING:
    from eomgen.codegen import RightHandSide


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


# -------- resting ----------------------------------------------------------------------------------------------
# Equilibria -> checks by the equations of motion: no acceleration there, and the stated stability.
#
#     a = 0 at u = 0;      d a_i/dq_j, by differences, has the eigenvalues -w^2 of small motions about the place
#
# The places come from the equations of statics, Q + J^T lam = 0, phi = 0; the equations of motion are another way.

MOST = 12  # places that are looked at
ASIDE = (
    fifty_digits().number(1) / 100
)  # of a coordinate or 1: near an equilibrium where the restoring force begins with a higher power
BY_MOTION = "50 digits"
NOTHING_ACCELERATED = "no acceleration at the equilibria"


def certify_equilibria(places: Sequence[Equilibrium]) -> Certificate:
    """Check the places by the balance of forces, and by the equations of motion: nothing is accelerated there."""
    if not places:
        return Certificate(())
    balanced = (balance_check(places), _pushes_check(places))
    try:
        first = FirstOrder.of(places[0].statics.still)
        equations = certify(first.equations, begins=False)
    except (ModelError, DerivationError) as error:  # a massless coordinate, say: there is rest, and no motion
        return Certificate((*balanced, unchecked(NOTHING_ACCELERATED, error.what, BY_MOTION)))
    return Certificate((*equations.checks, *balanced, *_resting_checks(first, places)))


def balance_check(places: Sequence[Equilibrium]) -> Check:
    """Check that Q + J^T lam = 0 and phi = 0 hold at each equilibrium."""
    name = "forces balance and constraints are satisfied at every equilibrium"
    return attempted(name, BY_MOTION, lambda: _first_at(places, _unbalanced))


def _unbalanced(place: Equilibrium) -> str:
    """Message if an equation of statics has a residual, compared with its change along each coordinate; ""."""
    statics, digits = place.statics, fifty_digits()
    known: dict[Node, Any] = statics.system.scope.values_of_parameters(Random(3))
    known |= _places(place, statics.unknowns, known)
    left = evaluate(statics.equations, known, digits)
    for i, (x, usual) in enumerate(zip(left, _usual(place, known), strict=True)):
        if abs(x) > tolerances.COMPUTED * usual + tolerances.ZERO_AT_50:
            return f"{float(x):.3g} is left of equation {i + 1}"
    return _unbalanced_along(place, known)


def _unbalanced_along(place: Equilibrium, known: Mapping[Node, Any]) -> str:
    """Message for an equation that does not hold at other places of a curve of equilibria; ""."""
    statics, digits = place.statics, fifty_digits()
    curve = place.curve
    points: Any = () if curve is None else curve.points[:: 1 + len(curve.points) // MOST]
    for z in points:
        there = {**known, **{x: digits.number(float(v)) for x, v in zip(statics.unknowns, z, strict=True)}}
        left = evaluate(statics.equations, there, digits)
        for x, usual in zip(left, _usual(place, there), strict=True):
            if abs(x) > tolerances.SAME_PLACE * usual + tolerances.ZERO_AT_50:
                return f"{float(x):.3g} is left along the family, at {statics.q[0].name} = {z[0]:.6g}"
    return ""


def _usual(place: Equilibrium, known: Mapping[Node, Any]) -> list[Any]:
    """Usual size of each equation: its change when every unknown changes by its own size, or by 1."""
    statics = place.statics
    slopes = jacobian(statics.equations, statics.unknowns)
    values = iter(evaluate(tuple(x for row in slopes for x in row), known, fifty_digits()))
    sizes = [max(1, abs(known[x])) for x in statics.unknowns]
    return [sum(abs(next(values)) * size for size in sizes) for _ in slopes]


def _pushes_check(places: Sequence[Equilibrium]) -> Check:
    """Check that the free bodies are in equilibrium: weights, loads and constraint forces add up to nothing."""
    name = "the multipliers at every equilibrium hold the free bodies"
    return attempted(name, BY_MOTION, lambda: _first_at(places[:MOST], _pushed))


def _pushed(place: Equilibrium) -> str:
    """Message that names a speed of the free bodies along which they are not in equilibrium; "".

    Multipliers that stand in no equation are set to 0.
    """
    statics = place.statics
    standing = statics.still
    free = standing.free or standing
    symbols, digits = free.symbols, fifty_digits()
    known: dict[Node, Any] = free.scope.values_of_parameters(Random(3))
    still = (symbols.t, *symbols.x, *symbols.a, *symbols.lam)
    known = {**dict.fromkeys(still, digits.number(0)), **known}
    held = {q: value for q, value in statics.given.items() if q in symbols.q}
    known |= dict(zip(held, evaluate(tuple(held.values()), known, digits), strict=True))
    stays = [q for q in symbols.places if q not in statics.q and (q in place.exact or q in place.numbers)]
    known |= _places(place, (*statics.unknowns, *stays), known)
    most = max(_usual(place, known), default=0)
    left = dict(zip((u.name for u in symbols.u), demand_of(free, with_inputs(free, known)).forces, strict=True))
    for four in free.scope.quaternions:  # along itself a quaternion cannot change: what is left there pushes nothing
        rates = {f"{e.name}'": known[e] for e in four}
        if rates.keys() <= left.keys():
            radial = sum(left[rate] * e for rate, e in rates.items())
            left |= {rate: left[rate] - radial * e for rate, e in rates.items()}
    wrong = ((name, x) for name, x in left.items() if abs(x) > tolerances.COMPUTED * most + tolerances.ZERO_AT_50)
    return next((f"{float(x):.3g} is left along {name}" for name, x in wrong), "")


def _places(place: Equilibrium, wanted: Sequence[Node], known: Mapping[Node, Any]) -> dict[Node, Any]:
    """Coordinates and multipliers with 50 digits, as far as they are known so."""
    exact = {x: place.exact[x] for x in wanted if x in place.exact}
    missing = [x.name for x in wanted if x not in exact and x not in place.numbers]
    if missing:
        raise NoValue(f"'{missing[0]}' has no value")
    found = dict(zip(exact, evaluate(tuple(exact.values()), known, fifty_digits()), strict=True))
    return found | {x: fifty_digits().number(place.numbers[x]) for x in wanted if x not in exact}


def _resting_checks(first: FirstOrder, places: Sequence[Equilibrium]) -> Iterator[Check]:
    """Checks of the equilibria of a system by its equations of motion."""
    proofs = [_Proof(first, place) for place in places[:MOST]]
    yield _of_all(NOTHING_ACCELERATED, proofs, _Proof.wrong, BY_MOTION)
    said = [proof for proof in proofs if proof.place.stability.kind in ("stable", "unstable")]
    if said:
        what = "stated stability is that of small motions"
        yield _of_all(what, said, _Proof.wrong_stability, "differences at 50 digits")


def _of_all(name: str, proofs: Sequence[_Proof], wrong: Callable[[_Proof], str], how: str) -> Check:
    """Check at every equilibrium; unchecked where one has no value and none is wrong."""
    open_ = ""
    for k, proof in enumerate(proofs, start=1):
        try:
            if found := wrong(proof):
                return checked(name, _at(k, found), how)
        except (NoValue, ZeroDivisionError) as error:
            open_ = _at(k, str(error) or "no value")
    return unchecked(name, open_, how) if open_ else checked(name, "", how)


def _first_at(places: Sequence[Equilibrium], wrong: Callable[[Equilibrium], str]) -> str:
    return first_wrong(_at(k, wrong(place)) for k, place in enumerate(places, start=1))


def _at(k: int, wrong: str) -> str:
    return wrong and f"place {k}: {wrong}"


@dataclass(frozen=True)
class _Proof:
    """Tests of one equilibrium; each gives what is wrong in words, or "".

    Args:
        first: the equations of motion of its system.
        place: where it is.
    """

    first: FirstOrder
    place: Equilibrium

    @cached_property
    def numbers(self) -> Mapping[Node, Any]:
        """Every symbol at rest there, with 50 digits."""
        system, digits = self.first.system, fifty_digits()
        symbols = system.symbols
        known: dict[Node, Any] = system.scope.values_of_parameters(Random(3))
        known |= {x: digits.number(0) for x in (symbols.t, *symbols.u)}
        known |= _places(self.place, symbols.places, known)
        return with_inputs(system, known)

    @cached_property
    def nearby(self) -> Nearby:
        """States near it, all speeds 0."""
        system = self.first.system
        along = self.place.stability.along or tuple(q for q in system.symbols.q if q in self.place.statics.q)
        return Nearby(self.first.equations, self.first.relations, self.numbers, tuple(along), system.symbols.u)

    def _accelerations(self, given: Mapping[Node, Any]) -> np.ndarray:
        going = self.nearby.going(self.nearby.state({**given, **self._still}))
        return np.array([going.a[u] for u in self.first.system.symbols.u], dtype=object)

    @property
    def _still(self) -> dict[Node, Any]:
        return {u: self.numbers[u] for u in self.first.system.symbols.u}

    @property
    def slopes(self) -> np.ndarray:
        """d a/dq of the coordinates whose variations are free, all speeds x these."""
        columns = []
        for q in self.nearby.q:
            late, early = (self._accelerations({q: self.numbers[q] + sign * STEP}) for sign in (1, -1))
            columns.append((late - early) / (2 * STEP))
        return np.array(columns, dtype=object).reshape(len(columns), -1).T.astype(float)

    def wrong_rates(self) -> str:
        """Message that names a coordinate or velocity constraint whose rate is not 0 with all speeds 0; ""."""
        system = self.first.system
        rows = [row for row in system.constraints.closing if row.gap is None]
        names = (*(f"{q.name}'" for q in system.symbols.q), *(f"'{row.constraint}'" for row in rows))
        rates = evaluate((*system.scope.rates, *(row.velocity for row in rows)), self.numbers, fifty_digits())
        for name, (x, usual) in self._state_rates().items():
            if abs(x) > tolerances.COMPUTED * usual + tolerances.ZERO_AT_50:
                return f"{name}' is {float(x):.3g} at rest"
        size = 1 + max((abs(self.numbers[q]) for q in system.symbols.q), default=0)
        moving = (
            f"{name} is {float(x):.3g} at rest"
            for name, x in zip(names, rates, strict=True)
            if abs(x) > tolerances.COMPUTED * size
        )
        return next(moving, "")

    def _state_rates(self) -> dict[str, tuple[Any, Any]]:
        """{state: (z' at rest by the file's own text, how fast it changes with the place)}."""
        system = self.first.system
        numbers: dict[Node, Any] = {**self.numbers, **dict.fromkeys(system.symbols.a, 0)}
        rng = Random(7)  # each moves by a share of its own: all by the same, q - z would not change
        shares = {x: STEP * rng.choice((-1, 1)) * rng.randrange(50, 100) / 100 for x in system.symbols.places}
        moved = {x: numbers[x] + fifty_digits().number(by) * max(1, abs(numbers[x])) for x, by in shares.items()}
        here, there = (declared_state_rates(system, state) for state in (numbers, numbers | moved))
        return {name: (x, abs(there[name] - x) / STEP) for name, x in here.items()}

    def wrong(self) -> str:
        """Message if the system accelerates at the equilibrium, compared with that after a displacement; ""."""
        if moving := self.wrong_rates():
            return moving
        rng, numbers = Random(5), self.numbers
        aside = {q: rng.choice((-1, 1)) * STEP * max(1, abs(numbers[q])) for q in self.first.system.symbols.q}
        usual = self._moved(aside, 1)
        for u, x in self.nearby.going(numbers).a.items():
            if abs(x) > tolerances.COMPUTED * usual + tolerances.ZERO_AT_50:
                with suppress(NoValue, ZeroDivisionError):
                    if abs(x) <= tolerances.COMPUTED * self._moved(aside, ASIDE / STEP):
                        continue
                nearby = self.nearby.going({**numbers, **{q: numbers[q] + STEP * d for q, d in aside.items()}}).a[u]
                if abs(nearby - x) > tolerances.SHARE * abs(x):
                    raise NoValue(f"{u.name} is 0/0 there")
                return f"{u.name} changes by {float(x):.3g}"
        return ""

    def _moved(self, aside: Mapping[Node, Any], farther: Any) -> Any:
        """Largest acceleration of a displacement that is larger by a factor, divided by this displacement.

        Where the derivatives of all forces vanish, as of k (x - sin x) at 0, a large displacement gives the scale.
        """
        late, early = (
            self.nearby.going({**self.numbers, **{q: self.numbers[q] + s * farther * d for q, d in aside.items()}}).a
            for s in (1, -1)
        )
        return max((abs(late[u] - early[u]) / (2 * STEP * farther) for u in late), default=0)

    def wrong_stability(self) -> str:
        """Message if the stated stability is wrong; "".

        For one degree of freedom the motion after a displacement decides, for several the eigenvalues of da/dq of the
        free coordinates: a positive one grows. With states of first order those of everything that moves.
        """
        kind = self.place.stability.kind
        if self.first.system.symbols.z:
            return self._wrong_growth(kind)
        rows = {u.name.removesuffix("'"): i for i, u in enumerate(self.first.system.symbols.u)}
        along = [q.name for q in self.place.stability.along]
        if not along or any(name not in rows for name in along):
            return ""
        if len(along) == 1:
            return self._wrong_when_pushed(self.nearby.q[0], rows[along[0]])
        values = np.linalg.eigvals(self.slopes[[rows[name] for name in along]]).real
        largest = abs(values).max(initial=0)
        if kind == "stable" and values.max() > tolerances.SAME_PLACE * largest:
            return "said to be stable, and a small motion grows"
        if kind == "unstable" and largest and values.max() < -tolerances.SAME_PLACE * largest:
            return "said to be unstable, and all small motions oscillate"
        return ""

    def _wrong_growth(self, kind: str) -> str:
        """Message if the eigenvalues of x' = A x, x = (q, u, z), are not those of the stated stability; ""."""
        symbols, nearby = self.first.system.symbols, self.nearby
        places = (*nearby.q, *symbols.z)
        columns = []
        for x in (*places, *symbols.u):
            sides = (nearby.going(nearby.state({**self._still, x: self.numbers[x] + sign * STEP})) for sign in (1, -1))
            late, early = ([*(going.q1[q] for q in places), *going.a.values()] for going in sides)
            columns.append([float((b - a) / (2 * STEP)) for a, b in zip(early, late, strict=True)])
        values = np.linalg.eigvals(np.array(columns).T).real
        least = tolerances.SAME_PLACE * abs(values).max(initial=0)
        if kind == "stable" and values.max() > least:
            return "said to be stable, and a small motion grows"
        return "said to be unstable, and no small motion grows" if kind == "unstable" and values.max() < least else ""

    def _wrong_when_pushed(self, q: Node, row: int) -> str:
        """Message if a displacement along q is not followed by what the stated stability says; "".

        Stable: it returns from both sides. Unstable: from one of them it does not.
        """
        kind = self.place.stability.kind
        goes_back = [sign * pull < 0 for sign, pull in zip((1, -1), self._pulls(q, row), strict=True)]
        if kind == "stable" and not all(goes_back):
            return "said to be stable, and a displacement does not return"
        if kind == "unstable" and all(goes_back):
            return "said to be unstable, and every displacement returns"
        return ""

    def _pulls(self, q: Node, row: int) -> list[Any]:
        """The accelerations from both sides, of the least push at which they are more than is left at the place."""
        place, left = self.numbers[q], abs(self._accelerations({})[row])
        size = max(1, abs(place))
        for push in (STEP, STEP / tolerances.SHARE, tolerances.DIFFERENCE_STEP * size, ASIDE * size):
            pulls = [self._accelerations({q: place + sign * push})[row] for sign in (1, -1)]
            if min(map(abs, pulls)) > left / tolerances.COMPUTED:
                return pulls
        if left:
            raise NoValue("what is left at the place hides what pushes back")
        return pulls
