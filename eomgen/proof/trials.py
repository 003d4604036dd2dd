"""Equations of motion -> checks at states, in numbers: what the routes share, free bodies, reactions, the emitted code.

Every check is made at the model's own start, then in each piece of its piecewise functions, then at a random state.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property
from random import Random
from typing import TYPE_CHECKING, Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System, exact_accelerations
from eomgen.mechanics.free_bodies import Reactions, SystemFriction, imbalance
from eomgen.mechanics.kinematics import ContactMode
from eomgen.proof.check import Check, attempted, checked, unchecked
from eomgen.proof.contact_phases import leaving_at_start, other_friction, pushing_otherwise
from eomgen.proof.declared_loads import (
    acting_otherwise,
    declared_state_rates,
    has_elements,
    rates_of_fluids,
    undeclared,
    working_otherwise,
)
from eomgen.proof.declared_threads import STRUNG, has_threads, strung_otherwise
from eomgen.proof.degrees_of_freedom import open_at_start, pulled_at_start, rows_that_stay, springs_of_the_start
from eomgen.proof.free_bodies import (
    Demand,
    demand_of,
    driven_otherwise,
    drives_beside,
    moved_otherwise,
    named_otherwise,
)
from eomgen.proof.motion import other_energies
from eomgen.proof.posed_model import apart, meetings_of, misplaced
from eomgen.proof.printed import Printed, ReadBack, least_multipliers
from eomgen.proof.states import (
    FINER_STEP,
    STEP,
    States,
    TrialState,
    consistent_states,
    in_doubles,
    is_open,
    own_start,
    refuse_open,
    way_through,
)
from eomgen.symbolic.exact import rounding_decides
from eomgen.symbolic.expression import Matrix, Scalar, State, Vector, inner, is_zero
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, floats_of, tolerances

if TYPE_CHECKING:
    from eomgen.codegen import RightHandSide

DIRECTIONS = (Vector((2, 3, 5)), Vector((7, -4, 3)))  # about which moments of inertia are compared
NOWHERE = "no state with values was found, at the start, near it or at random"


@dataclass(frozen=True)
class Given:
    """Motion that is given of a coordinate.

    Args:
        coordinate: its name.
        slopes: (f, g) with f' = g.
        same: pairs that are equal at every t.
        first: pairs that are equal at t = 0.
    """

    coordinate: str
    slopes: list[tuple[Scalar, Scalar]]
    same: list[tuple[Scalar, Scalar]]
    first: Sequence[tuple[Scalar, Scalar]] = ()


@dataclass(frozen=True)
class Trials:
    """The equations of a system, to be tried at states."""

    equations: EquationsOfMotion

    @cached_property
    def states(self) -> States:
        """States of the system, in every piece of its poses and equations."""
        e, links = self.equations, self.equations.system.motion.links
        poses = (x for link in links for row in (*link.pose.R, link.pose.p) for x in row)
        entries = (x for rows in (e.M, e.J, e.N) for row in rows for x in row)
        return States(e.system, (*poses, *entries, *e.nu, *e.c, *e.Q, *e.forcing, *e.sigma, *e.gamma, e.T, e.V))

    def _at_states(
        self,
        name: str,
        how: str,
        check: Callable[[State], str],
        moving: bool = False,
        supplies: Iterable[tuple[str, Iterable[TrialState]]] = (),
    ) -> Check:
        """A check at the first state of each supply where everything has a value; `check` names what differs.

        Args:
            moving: whether it takes accelerations, which contradict one another where constraints are open.
            supplies: of states; () for those of the system.
        """
        seen: dict[str, int] = {}
        for where, supply in supplies or self.states.supplies:
            for place in supply:
                try:
                    wrong = check(place.state)
                except (NoValue, ZeroDivisionError):
                    continue
                if wrong and moving and is_open(self.equations.system, place.state):
                    continue
                if wrong:
                    return checked(name, wrong + place.remark, how)
                seen[where] = seen.get(where, 0) + 1
                break
        if not seen:
            return unchecked(name, NOWHERE, how)
        pieces = seen.pop("in a piece", 0)
        reported = [*seen, *([f"in {pieces} piece{'s' * (pieces > 1)}"] if pieces else [])]
        return checked(name, "", f"{how}, {', '.join(reported)}")

    @cached_property
    def _solved(self) -> dict[int, tuple[State, State]]:
        return {}

    def _moving(self, state: State) -> State:
        """The state with the accelerations of the equations of motion."""
        if id(state) not in self._solved:
            a = exact_accelerations(self.equations, state)
            self._solved[id(state)] = state, state | dict(zip(self.equations.symbols.a, a, strict=True))
        return self._solved[id(state)][1]

    def _pushed(self, state: State) -> State:
        """A state of the motion with the multipliers of the equations of motion."""
        return state | least_multipliers(self.equations, state)

    def eliminated_rows(self) -> Check:
        """W^T xi + s_t = 0 and dphi/dt = 0 at any independent speeds: equations for the dependent rates.

        Rows that follow from others do so where the constraints hold, and are looked at there.
        """
        scope = self.equations.system.scope
        rows = [row for row in self.equations.system.constraints.rows if row.status == "eliminated"]
        gaps = [(row, row.gap) for row in rows if row.gap is not None]
        owners = [*rows, *(row for row, _ in gaps)]
        rates = (*(row.velocity for row in rows), *scope.time_derivative(tuple(gap for _, gap in gaps)))

        def check(state: State) -> str:
            size = 1 + sum(abs(x) for x in evaluate(scope.rates, state, fifty_digits()))
            for row, value in zip(owners, evaluate(rates, state, fifty_digits()), strict=True):
                if abs(value) > tolerances.DIFFERENCE_AT_50 * size:
                    return f"row {row.number} of '{row.constraint}' opens"
            return ""

        return self._at_states("eliminated rows hold whatever the speeds", "50 digits", check)

    def places(self) -> Check:
        """Every body against its parent, by the moves that its joint is declared to be."""
        name = "bodies stand against one another as their joints are declared"
        return self._at_states(name, "50 digits", lambda state: misplaced(self.equations.system, state))

    def twists(self) -> Check:
        """Twists against central differences of the poses along the motion."""
        links, digits = self.equations.system.motion.links, fifty_digits()
        poses = tuple(x for link in links for x in (*(x for row in link.pose.R for x in row), *link.pose.p))
        twists = tuple(x for link in links for x in (*link.twist.w, *link.twist.v))
        moving = self.equations.system.scope.rates

        def check(state: State) -> str:
            fastest = max((abs(x) for x in evaluate(moving, state, digits)), default=0)
            h = 1 / (digits.number(10**15) * (1 + fastest))  # what moves fast is compared over as short a way
            all_rates = way_through(self.equations.system, state, h).rates(poses)
            now, motions = evaluate(poses, state, digits), evaluate(twists, state, digits)
            for k, link in enumerate(links):
                rates, here, twist = all_rates[12 * k :], now[12 * k :], motions[6 * k : 6 * k + 6]
                R_now = Matrix.of((here[0:3], here[3:6], here[6:9]))
                W = R_now.T @ Matrix.of((rates[0:3], rates[3:6], rates[6:9]))
                spin = Vector((W[2][1], W[0][2], W[1][0]))
                velocity = R_now.T @ Vector(rates[9:12])
                pairs = zip(twist, (*spin, *velocity), strict=True)
                if any(abs(a - b) > tolerances.DIFFERENCE_AT_50 * (1 + abs(a)) for a, b in pairs):
                    return f"the twist of '{link.name}' is not the rate of its pose"
            return ""

        return self._at_states("twists are the rates of the poses", "differences at 50 digits", check)

    @property
    def given(self) -> list[Given]:
        """Given motions of every driven coordinate, with nu = q' and (q')' = q''."""
        scope, found = self.equations.system.scope, []
        for q, nu in zip(self.equations.symbols.q, self.equations.nu, strict=True):
            part, name = scope.model.coordinates[q.name], q.name
            rate, acceleration = scope.names[f"{name}'"], scope.names[f"{name}''"]
            if part.motion is not None:
                found.append(Given(name, [(scope.value(part.motion), rate), (rate, acceleration)], [(nu, rate)]))
            elif part.rate is not None:
                found.append(Given(name, [(rate, acceleration)], [(nu, rate), (scope.value(part.rate), rate)]))
            elif part.acceleration is not None:
                same = [(nu, rate), (scope.value(part.acceleration), acceleration)]
                found.append(Given(name, [(rate, acceleration)], same, [(rate, scope.value(part.speed))]))
        return found

    def given_motions(self) -> Check:
        """q' and q'' of driven coordinates against the functions of t that are given, by central differences."""
        t, digits = self.equations.symbols.t, fifty_digits()
        h = STEP

        def slope(f: Scalar, state: State) -> Any:
            early, now, late = (evaluate((f,), {**state, t: state[t] + by}, digits)[0] for by in (-h, 0 * h, h))
            if abs(late - 2 * now + early) > tolerances.COMPUTED * h * (1 + abs(now)):
                raise NoValue("two pieces meet there")
            return (late - early) / (2 * h)

        def check(state: State) -> str:
            begun = {**state, t: digits.number(0)}
            for given in self.given:
                pairs: list[Sequence[Any]] = []
                pairs += [(slope(f, state), evaluate((g,), state, digits)[0]) for f, g in given.slopes]
                pairs += [evaluate(pair, state, digits) for pair in given.same]
                pairs += [evaluate(pair, begun, digits) for pair in given.first]
                if any(abs(a - b) > tolerances.DIFFERENCE_AT_50 * (1 + abs(a) + abs(b)) for a, b in pairs):
                    return f"'{given.coordinate}' moves differently"
            return ""

        return self._at_states("driven coordinates move as given", "differences at 50 digits", check)

    def free_bodies(self) -> Check:
        """M a + c - Q - J^T lam and J a + gamma at any a and lam, by the free bodies, which use no B and no energy."""
        e, symbols, closing = self.equations, self.equations.symbols, self.equations.system.constraints.closing
        friction = e.friction or (0,) * len(e.Q)
        inertia = [inner(row, symbols.a) - b + f for row, b, f in zip(e.M, e.forcing, friction, strict=True)]
        forces = [x - inner(column, symbols.lam) for x, column in zip(inertia, _columns(e), strict=True)]
        rows = [inner(row, symbols.a) + bias for row, bias in zip(e.J, e.gamma, strict=True)]
        names = [
            *(f"M a + c - Q - J^T lam [{u.name}]" for u in symbols.u),
            *(f"J a + gamma of {x}" for x in symbols.lam),
        ]

        def differ(own: Sequence[Any], needed: Demand) -> list[int]:
            rates = [needed.rates[row.constraint, row.number] for row in closing]
            sizes = [*needed.sizes, *(1 + abs(x) for x in rates)]
            found = zip(own, (*needed.forces, *rates), sizes, strict=True)
            return [i for i, (x, y, size) in enumerate(found) if abs(x - y) > tolerances.DIFFERENCE_AT_50 * size]

        def check(state: State) -> str:
            own, needed = evaluate((*forces, *rows), state, fifty_digits()), demand_of(self.equations.system, state)
            if not differ(own, needed):
                return ""
            finer = demand_of(self.equations.system, state, FINER_STEP)
            wrong = differ(own, finer)
            if wrong and differ((*needed.forces, *(needed.rates[r.constraint, r.number] for r in closing)), finer):
                raise NoValue("differences depend on their step: next to a dead centre")
            return f"{names[wrong[0]]} differs" if wrong else ""

        name = "the equations are those of the free bodies, at any accelerations and multipliers"
        return self._at_states(name, "differences at 50 digits", check)

    def accelerations(self) -> Iterable[Check]:
        """Check of a by the equations of the free bodies with all constraints; none where no constraint closes."""
        if self._whole.constraints.closing:
            name = "accelerations are those of the free bodies, all constraints holding at once"
            how = "differences at 50 digits, rank of all rows at the state"
            supplies = self._consistent
            yield self._at_states(name, how, lambda state: self._torn(state, self._moving(state)), supplies=supplies)

    @property
    def _consistent(self) -> Iterable[tuple[str, Iterable[TrialState]]]:
        """States at which every constraint holds: those of the other checks where no coordinate is dependent."""
        at_start, *random = consistent_states(self.equations.system)
        return (at_start, *(random if self.equations.system.free is not None else self.states.supplies[-1:]))

    @property
    def _whole(self) -> System:
        """The system in which dependent coordinates are free."""
        return self.equations.system.free or self.equations.system

    def _torn(self, state: State, moving: State) -> str:
        """Message if accelerations violate the equations of the free bodies at a state; "".

        Raises:
            NoValue: they do not hold there.
        """
        refuse_open(self.equations.system, state)
        return moved_otherwise(self.equations.system, moving, evaluate(self.equations.friction, moving, fifty_digits()))

    def friction(self) -> Check:
        """Friction brakes: factor * v < 0 for a contact that pushes, v its sliding velocity.

        That of a bilateral contact is F = factor P, P = sqrt(N_1^2 + N_2^2), N_1 and N_2 those of the free bodies, of
        a guide with a length the sum of those at its ends.
        """
        laws = _laws_of_round(self.equations.system) if SystemFriction(self.equations.system).push_sizes() else []

        def check(state: State) -> str:
            if wrong := other_friction(self.equations.system, state):
                return wrong
            for name, law in laws:
                if not self._holds(law, state):
                    return f"the friction of '{name}' is not that of its normal force"
            for name, factor, sliding in (*SystemFriction(self.equations.system).named, *self._of_joints):
                mode = self.equations.system.modes.get(name, ContactMode())
                v = sliding if mode.sense is None else mode.sense
                speed, power, factor_at = evaluate((v, mode.push * factor * v, factor), state, fifty_digits())
                if speed == 0:
                    raise NoValue("nothing slides")
                if power > 0 or (power == 0 and factor_at != 0):
                    return f"friction drives '{name}' on"
            return ""

        return self._at_states("friction takes power from sliding bodies", "50 digits", check, moving=True)

    @property
    def rubs(self) -> bool:
        """True if anything has friction of which the power can be looked at."""
        return SystemFriction(self.equations.system).exists or bool(self._of_joints)

    @property
    def _of_joints(self) -> list[tuple[str, Scalar, Scalar]]:
        """(name, friction, rate) of every joint and force with friction of a given size that does not stick."""
        system = self.equations.system
        found = [(each.name, each.friction, each.slip) for each in system.loads.applied if not is_zero(each.friction)]
        for effort in system.loads.efforts:
            link = system.motion.link(effort.body)
            names = [link.joint.named_contact(link.name, x) for k, x, _ in link.joint.frictions if k == effort.variable]
            if not is_zero(effort.friction):
                found.append((names[0], effort.friction, link.s_rate[effort.variable]))
        return found

    def pushes(self) -> Iterable[Check]:
        """A contradiction where friction is taken with another sign of N than the start has; else nothing."""
        start = own_start(self.equations.system)
        if start is not None and self.states.inside(start):
            found = attempted(
                "friction at the start is that of the contacts' own pushes",
                "50 digits",
                lambda: pushing_otherwise(self.equations, start, self._moving),
            )
            yield from (found,) if found.status == "fails" else ()

    def begun_contacts(self) -> Iterable[Check]:
        """A contradiction where a contact is closed that opens as the motion starts; else nothing."""
        name = "closed contacts stay closed where the motion starts"
        found = attempted(name, "speeds of the start, 50 digits", lambda: leaving_at_start(self.equations))
        yield from (found,) if found.status == "fails" else ()

    def _holds(self, law: tuple[Scalar, ...], state: State) -> bool:
        """F = factor (|N/2 + D/L| + |N/2 - D/L|) with the accelerations of the equations of motion."""
        F, factor, L, *parts = map(float, evaluate(law, self._moving(state), fifty_digits()))
        pairs = list(zip(parts[::2], parts[1::2], strict=True))
        P = sum(math.hypot(*(N / 2 + sign * D / L for N, D in pairs)) for sign in (1, -1))
        return math.isclose(F, factor * P, rel_tol=tolerances.COMPUTED, abs_tol=tolerances.COMPUTED)

    def tensors(self) -> Iterable[Check]:
        """n . I n is the declared [xx, yy, zz, xy, yz, zx] times the products of n; none where none is declared."""
        scope = self.equations.system.scope
        plain = {name: part for name, part in scope.model.bodies.items() if part.shape is None and part.parts is None}
        pairs = []
        for name, inertia in ((name, part.inertia or ()) for name, part in plain.items()):
            if len(inertia) <= 1:  # about z alone
                continue
            tensor = scope.mass_properties(name).I
            for direction in DIRECTIONS:
                x, y, z = direction
                products = (x * x, y * y, z * z, 2 * x * y, 2 * y * z, 2 * z * x)
                typed = inner([scope.value(e) for e in inertia], products[: len(inertia)])
                pairs.append((name, typed, direction @ (tensor @ direction)))

        def check(state: State) -> str:
            values = iter(evaluate([x for _, *both in pairs for x in both], state, fifty_digits()))
            for name, _, _ in pairs:
                typed, held = next(values), next(values)
                if abs(typed - held) > tolerances.ZERO_AT_50 * (abs(typed) + abs(held)):
                    return f"that of '{name}'"
            return ""

        if pairs:
            yield self._at_states("moments and products of inertia stand where they are declared", "50 digits", check)

    def contacts(self) -> Iterable[Check]:
        """Check that declared contacts touch, and neither open nor slip; none without contacts."""
        if meetings_of(self.equations.system):
            name = "contacts lie on both surfaces, and neither open nor slip"
            yield self._at_states(name, "50 digits", lambda state: apart(self.equations.system, state))

    def threads(self) -> Iterable[Check]:
        """Check that strings and links run and pull as they are declared; none without them."""
        if has_threads(self.equations.system):
            yield self._at_states(STRUNG, "50 digits", lambda state: strung_otherwise(self.equations.system, state))

    def kept_constraints(self) -> Iterable[Check]:
        """Check that constraints which keep a start value are satisfied at the start; none without such constraints."""
        if rows_that_stay(self.equations.system):
            name = "constraints that keep a start value are satisfied at the start"
            yield self._at_states(name, "50 digits", lambda state: open_at_start(self.equations.system, state))

    def slack_springs(self) -> Iterable[Check]:
        """Check that springs with the length of the start have it there; none without such springs."""
        system = self.equations.system
        if springs_of_the_start(system) and system.constraints.rows:
            name = "springs declared slack at the start are so where the motion starts"
            yield attempted(name, "the start that the constraints complete", lambda: pulled_at_start(system))

    def elements(self) -> Iterable[Check]:
        """Check that springs, dampers and pulls act as they are declared; none without them."""
        if has_elements(self.equations.system) or self.equations.system.loads.efforts:
            name = "springs, dampers and drives act as they are declared, equal and opposite"
            yield self._at_states(name, "50 digits", lambda state: undeclared(self.equations.system, state))

    def declared(self) -> Iterable[Check]:
        """Check that applied loads act, and do virtual work, as they are declared; none where nothing is applied."""
        e = self.equations
        if e.system.loads.applied or e.system.loads.efforts or not all(map(is_zero, e.Q)):
            name = "applied loads act, and do virtual work, as their fields declare"
            check = lambda state: acting_otherwise(e.system, state) or working_otherwise(e, state)  # noqa: E731
            yield self._at_states(name, "differences at 50 digits", check)

    def energies(self) -> Iterable[Check]:
        """A contradiction where T or V has a part too much or too little, a constant even; else nothing."""
        name = "T and V are the energies of the bodies"
        found = self._at_states(name, "50 digits", lambda state: other_energies(self.equations, state))
        return (found,) if found.status == "fails" else ()

    def printed(self, printed: Printed) -> Iterable[Check]:
        """Check of printed formulas, read back; none where nothing can be read."""
        text = ReadBack(self.equations, printed)
        if text.equalities:
            name = "printed formulas, read back, hold along the motion"
            yield self._at_states(name, "50 digits", lambda state: text.wrong(self._moving(state)), moving=True)
        if printed.texts:
            name = "texts for machines, read back, are the equations"
            yield self._at_states(name, "50 digits", text.wrong_data)
        if text.constants:
            name = "first integrals as they are printed stay constant along the motion"
            yield self._at_states(
                name, "differences at 50 digits", lambda state: text.drifting(self._moving(state)), moving=True
            )

        if printed.laws:
            name = "laws of motion, read back, are the motion from the start"
            with suppress(NoValue, ZeroDivisionError, DerivationError):
                yield checked(name, text.wrong_law(), "differences at 50 digits, soon after the start")

    def balance(self) -> Iterable[Check]:
        """D'Alembert's principle for every body, every pair and the whole; none where reactions do not follow."""
        try:
            reactions = Reactions.of(self.equations.system)
        except DerivationError:
            return
        shares = (x for own in reactions.solution.shares.values() for x in own.values())
        formulas = (*reactions.solution.constants.values(), *shares)

        def check(state: State) -> str:
            moving = self._moving(state)
            refuse_noise(formulas, moving)
            return imbalance(reactions, moving, Random(7), rates_of_fluids(self.equations.system))

        if reactions.components:
            yield self._at_states("every body is in equilibrium with its reactions", "floating point", check)
            if self.equations.system.scope.model.space == "space":
                name = "reactions named by x, y and z are those along the ground's axes"
                yield self._somewhere(name, lambda state: named_otherwise(reactions.balance, state))
            if drives_beside(reactions):
                name = "drives are the forces that the bodies need along their motion"
                yield self._somewhere(name, lambda state: driven_otherwise(reactions, self._pushed(state)))

    def _somewhere(self, name: str, wrong: Callable[[State], str]) -> Check:
        """Check of the meaning of names, at one state along the motion, as they mean the same at all."""
        for _, supply in self.states.supplies:
            for place in supply:
                try:
                    return checked(name, wrong(self._moving(place.state)), "50 digits")
                except (NoValue, ZeroDivisionError):
                    continue
        return unchecked(name, NOWHERE, "50 digits")

    def state_rates(self) -> Check:
        """z' of the states of first order is what the file's own text says at a state of the motion."""
        scope = self.equations.system.scope

        def check(state: State) -> str:
            moving = self._moving(state)
            found = evaluate(scope.state_rates, moving, fifty_digits())
            right = declared_state_rates(self.equations.system, moving)
            size = 1 + max(map(abs, right.values()))
            apart = (
                name
                for x, (name, y) in zip(found, right.items(), strict=True)
                if abs(x - y) > size * tolerances.ZERO_AT_50
            )
            return next((f"the rate of '{name}' is another one" for name in apart), "")

        return self._at_states("rates of states are those declared", "50 digits, by their texts", check, moving=True)

    def code(self, rhs: RightHandSide) -> Check:
        """The emitted code returns the symbols' numbers, at states that are numbers of double precision."""
        symbols, digits = self.equations.symbols, fifty_digits()
        groups = (symbols.x, symbols.parameters.values(), symbols.inputs.values())

        def check(state: State) -> str:
            rounded = in_doubles(state)
            state = state if state == rounded else rounded
            x, p, inputs = ([float(state[s]) for s in group] for group in groups)
            rates = floats_of(evaluate(self.equations.system.scope.rates, state, digits))
            dx = rhs(float(state[symbols.t]), x, p, inputs)
            moving = self._moving(state)
            a = floats_of(moving[a] for a in symbols.a)
            further = floats_of(declared_state_rates(self.equations.system, moving).values())
            return _difference("dx", dx, [*rates, *a, *further], tolerances.COMPUTED)

        name = f"the emitted code ({rhs.target}) returns the symbols' numbers"
        return self._at_states(name, "floating point", check, moving=True)


def refuse_noise(scalars: Sequence[Scalar], state: State) -> None:
    """Refuses a state at which rounding decides: scalars change when it moves by 1e-30.

    Raises:
        NoValue: they do not: 0/0 at the state, where rounding stands for both zeros.
    """
    if rounding_decides(scalars, state):
        raise NoValue("rounding decides")


def _columns(equations: EquationsOfMotion) -> Iterable[Sequence[Scalar]]:
    """The columns of J, also where it has no rows."""
    return zip(*equations.J, strict=True) if equations.J else ((),) * len(equations.M)


def _laws_of_round(system: System) -> list[tuple[str, tuple[Scalar, ...]]]:
    """(contact, (F, factor, L, N_1, D_1, N_2, D_2, ...)) of every bilateral contact with friction."""
    reactions = Reactions.of(system)
    rounds = [contact for contact in SystemFriction(system).contacts(reactions.components) if contact.ends]
    pressed = [_at_ends(reactions, r.name) or (1, *_of_one_force(reactions, r.ends)) for r in rounds]
    return [(r.name, (reactions.value(r.component), r.factor, *each)) for r, each in zip(rounds, pressed, strict=True)]


def _at_ends(reactions: Reactions, name: str) -> tuple[Scalar, ...]:
    """(L, N_1, D_1, ...) of a guide with a length L, N = n x (R x n) of all the force R of its joint, D = M x n of all
    its couple M, n along it, in the ground's axes; () of all else."""
    motion, value = reactions.balance.system.motion, reactions.balance.system.scope.value
    link = motion.link(name) if name in motion.index else None
    for k, _, law in () if link is None or link.joint is None else link.joint.frictions:
        if link is not None and law.guide is not None:
            n = link.pose.R @ link.S[k][1]
            N, D = n.cross(reactions.force(name).cross(n)), reactions.couple(name).cross(n)
            return (value(law.guide), *(x for pair in zip(N, D, strict=True) for x in pair))
    return ()


def _of_one_force(reactions: Reactions, ends: Sequence[Sequence[Sequence[tuple[int, Scalar]]]]) -> Iterator[Scalar]:
    """N_1, 0, N_2, 0, ... of a contact that one force presses."""
    ((*parts,),) = ends
    for ((j, _),) in parts:
        yield from (reactions.value(j), 0)


def _difference(name: str, a: Any, b: Any, tolerance: float) -> str:
    """Message that names an entry in which two vectors differ; ""."""
    scale = 1 + max((abs(x) for x in b), default=0)
    wrong = [i for i, (x, y) in enumerate(zip(a, b, strict=True)) if not abs(x - y) <= tolerance * scale]
    return f"{name}[{wrong[0]}] is {a[wrong[0]]:.15g} against {b[wrong[0]]:.15g}" if wrong else ""
