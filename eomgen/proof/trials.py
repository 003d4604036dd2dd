"""System, Assembly -> checks at states, in numbers: what the routes share, free bodies, reactions, the emitted code.

Every check is made at the model's own start, then inside each piece of what it is made of, then at a random state.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from random import Random
from typing import Any

from eomgen.codegen.rhs import RightHandSide
from eomgen.errors import DerivationError
from eomgen.mechanics.balance.friction import frictions, push_sizes, rubbing_contacts
from eomgen.mechanics.bodies.contact_modes import CLOSED
from eomgen.mechanics.bodies.kinematics import spin_between
from eomgen.mechanics.equations.accelerations import exact_accelerations
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.equilibrium import imbalance
from eomgen.mechanics.reactions.reactions import reactions_of
from eomgen.proof.check import Check, checked, unchecked
from eomgen.proof.contact_geometry import apart, meetings_of
from eomgen.proof.free_bodies import demand_of
from eomgen.proof.passive_elements import PassiveElements
from eomgen.proof.states import States, in_doubles
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import apply, matrix_of, transposed, vector_of
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, DIFFERENCE_AT_50, ZERO_AT_50

NOWHERE = "no state with values was found, at the start, near it or at random"


@dataclass(frozen=True)
class Trials:
    """The equations of a system, to be tried at states."""

    system: System
    assembly: Assembly

    @cached_property
    def states(self) -> States:
        """The states of the system; poses and equations are looked at for pieces."""
        e, links = self.assembly, self.system.motion.links
        poses = (x for link in links for row in (*link.pose.R, link.pose.p) for x in row)
        entries = (x for rows in (e.M, e.J, e.N) for row in rows for x in row)
        return States(self.system, (*poses, *entries, *e.nu, *e.c, *e.Q, *e.forcing, *e.sigma, *e.gamma, e.T, e.V))

    def _at_states(self, name: str, how: str, check: Callable[[State], str]) -> Check:
        """A check at the first state of each supply where everything has a value; `check` names what differs."""
        seen: dict[str, int] = {}
        for where, supply in self.states.supplies:
            for place in supply:
                try:
                    wrong = check(place.state)
                except (NoValue, ZeroDivisionError):
                    continue
                if wrong:
                    return checked(name, wrong + place.remark, how)
                seen[where] = seen.get(where, 0) + 1
                break
        if not seen:
            return unchecked(name, NOWHERE, how)
        pieces = seen.pop("in a piece", 0)
        told = [*seen, *([f"in {pieces} piece{'s' * (pieces > 1)}"] if pieces else [])]
        return checked(name, "", f"{how}, {', '.join(told)}")

    @cached_property
    def _solved(self) -> dict[int, tuple[State, State]]:
        return {}

    def _moving(self, state: State) -> State:
        """The state with the accelerations of the equations of motion."""
        if id(state) not in self._solved:
            a = exact_accelerations(self.assembly, state)
            self._solved[id(state)] = state, state | dict(zip(self.assembly.symbols.a, a, strict=True))
        return self._solved[id(state)][1]

    def eliminated_rows(self) -> Check:
        """W^T xi + s_t = 0 and dphi/dt = 0 whatever the independent speeds: what dependent rates were solved from.

        Rows that follow from others do so where the ties hold, and are looked at there.
        """
        scope = self.system.scope
        rows = [row for row in self.system.ties.rows if row.status == "eliminated"]
        gaps = [(row, row.gap) for row in rows if row.gap is not None]
        owners = [*rows, *(row for row, _ in gaps)]
        rates = (*(row.velocity for row in rows), *scope.time_derivative(tuple(gap for _, gap in gaps)))

        def check(state: State) -> str:
            size = 1 + sum(abs(x) for x in evaluate(scope.rates, state, fifty_digits()))
            for row, value in zip(owners, evaluate(rates, state, fifty_digits()), strict=True):
                if abs(value) > DIFFERENCE_AT_50 * size:
                    return f"row {row.number} of '{row.tie}' opens"
            return ""

        return self._at_states("eliminated rows hold whatever the speeds", "50 digits", check)

    def twists(self) -> Check:
        """Twists against central differences of the poses along the motion."""
        links, digits = self.system.motion.links, fifty_digits()
        poses = tuple(x for link in links for x in (*(x for row in link.pose.R for x in row), *link.pose.p))
        twists = tuple(x for link in links for x in (*link.twist.w, *link.twist.v))
        h = digits.number(1) / 10**15

        def check(state: State) -> str:
            late, early = (evaluate(poses, _moved(self.system, state, sign * h), digits) for sign in (1, -1))
            all_rates = [(a - b) / (2 * h) for a, b in zip(late, early, strict=True)]
            now, motions = evaluate(poses, state, digits), evaluate(twists, state, digits)
            for k, link in enumerate(links):
                rates, here, twist = all_rates[12 * k :], now[12 * k :], motions[6 * k : 6 * k + 6]
                R_now = matrix_of((here[0:3], here[3:6], here[6:9]))
                spin = spin_between(R_now, matrix_of((rates[0:3], rates[3:6], rates[6:9])))
                velocity = apply(transposed(R_now), vector_of(rates[9:12]))
                pairs = zip(twist, (*spin, *velocity), strict=True)
                if any(abs(a - b) > DIFFERENCE_AT_50 * (1 + abs(a)) for a, b in pairs):
                    return f"the twist of '{link.name}' is not the rate of its pose"
            return ""

        return self._at_states("twists are the rates of the poses", "differences at 50 digits", check)

    def free_bodies(self) -> Check:
        """M a + c - Q - J^T lam and J a + gamma at any a and lam, by the free bodies, which use no B and no energy."""
        e, symbols, closing = self.assembly, self.assembly.symbols, self.system.ties.closing
        friction = e.friction or (0,) * len(e.Q)
        inertia = [inner(row, symbols.a) - b + f for row, b, f in zip(e.M, e.forcing, friction, strict=True)]
        forces = [x - inner(column, symbols.lam) for x, column in zip(inertia, _columns(e), strict=True)]
        rows = [inner(row, symbols.a) + bias for row, bias in zip(e.J, e.gamma, strict=True)]
        names = [
            *(f"M a + c - Q - J^T lam [{u.name}]" for u in symbols.u),
            *(f"J a + gamma of {x}" for x in symbols.lam),
        ]

        def check(state: State) -> str:
            needed = demand_of(self.system, state)
            own = evaluate((*forces, *rows), state, fifty_digits())
            rates = [needed.rates[row.tie, row.number] for row in closing]
            sizes = [*needed.sizes, *(1 + abs(x) for x in rates)]
            found = zip(own, (*needed.forces, *rates), sizes, strict=True)
            wrong = [i for i, (x, y, size) in enumerate(found) if abs(x - y) > DIFFERENCE_AT_50 * size]
            return f"{names[wrong[0]]} differs" if wrong else ""

        name = "the equations are those of the free bodies, at any accelerations and multipliers"
        return self._at_states(name, "differences at 50 digits", check)

    def friction(self) -> Check:
        """Whatever rubs is braked: factor * v < 0 for a contact that pushes, v its sliding velocity.

        What holds on all sides rubs with F = factor sqrt(N_1^2 + N_2^2), N_1 and N_2 those of the bodies' balance.
        """
        laws = _laws_of_round(self.system) if push_sizes(self.system) else []

        def check(state: State) -> str:
            for name, law in laws:
                if not self._holds(law, state):
                    return f"the friction of '{name}' is not that of its normal force"
            for name, factor, sliding in frictions(self.system):
                mode = self.system.modes.get(name, CLOSED)
                v = sliding if mode.sense is None else mode.sense
                speed, power, factor_at = evaluate((v, mode.push * factor * v, factor), state, fifty_digits())
                if speed == 0:
                    raise NoValue("nothing slides")
                if power > 0 or (power == 0 and factor_at != 0):
                    return f"friction drives '{name}' on"
            return ""

        return self._at_states("friction takes power from what slides", "50 digits", check)

    def _holds(self, law: tuple[Scalar, ...], state: State) -> bool:
        """F = factor sqrt(N_1^2 + N_2^2) with the accelerations of the equations of motion."""
        F, factor, *N = map(float, evaluate(law, self._moving(state), fifty_digits()))
        return math.isclose(F, factor * math.hypot(*N), rel_tol=COMPUTED, abs_tol=COMPUTED)

    def contacts(self) -> Iterable[Check]:
        """What touches touches, where it is declared; none where nothing does."""
        if meetings_of(self.system):
            name = "contacts lie on both surfaces, and neither part nor slip"
            yield self._at_states(name, "50 digits", lambda state: apart(self.system, state))

    def passive_elements(self) -> Iterable[Check]:
        """Dampers take power, springs have no energy at their rest length; none where there are none."""
        found = PassiveElements(self.system)
        if found.brakes:
            yield self._at_states("dampers take power", "50 digits", found.driven_on)
        if found.springs:
            yield self._at_states("springs have no energy at their rest length", "50 digits", found.stretched)

    def balance(self) -> Iterable[Check]:
        """D'Alembert's principle for every body, every pair and the whole; none where reactions do not follow."""
        try:
            reactions = reactions_of(self.system)
        except DerivationError:
            return
        shares = (x for own in reactions.solution.shares.values() for x in own.values())
        formulas = (*reactions.solution.constants.values(), *shares)

        def check(state: State) -> str:
            moving = self._moving(state)
            _refuse_noise(formulas, moving)
            return imbalance(reactions, moving, Random(7))

        if reactions.components:
            yield self._at_states("every body is in balance with its reactions", "floating point", check)

    def code(self, rhs: RightHandSide) -> Check:
        """The emitted code returns the symbols' numbers, at states that are numbers of double precision."""
        symbols, digits = self.assembly.symbols, fifty_digits()
        groups = ((*symbols.q, *symbols.u), symbols.parameters.values(), symbols.inputs.values())

        def check(state: State) -> str:
            rounded = in_doubles(state)
            state = state if state == rounded else rounded
            x, p, inputs = ([float(state[s]) for s in group] for group in groups)
            rates = [float(v) for v in evaluate(self.system.scope.rates, state, digits)]
            dx = rhs(float(state[symbols.t]), x, p, inputs)
            a = [float(self._moving(state)[a]) for a in symbols.a]
            return _difference("dx", dx, [*rates, *a], COMPUTED)

        name = f"the emitted code ({rhs.target}) returns the symbols' numbers"
        return self._at_states(name, "floating point", check)


def _refuse_noise(scalars: Sequence[Scalar], state: State) -> None:
    """Nothing, where the scalars stay the same at a state 1e-30 away.

    Raises:
        NoValue: they do not: 0/0 at the state, where rounding stands for both zeros.
    """
    beside = {x: value + fifty_digits().number(Fraction(1, 10**30)) for x, value in state.items()}
    here, there = (evaluate(scalars, at, fifty_digits()) for at in (state, beside))
    size = max(map(abs, here), default=0)
    if any(abs(x - y) > ZERO_AT_50 + COMPUTED * size for x, y in zip(here, there, strict=True)):
        raise NoValue("rounding decides")


def _moved(system: System, state: State, h: Any) -> State:
    """The state h later, to first order."""
    symbols = system.scope.symbols
    rates = evaluate(system.scope.rates, state, fifty_digits())
    later = {q: state[q] + h * rate for q, rate in zip(symbols.q, rates, strict=True)}
    return state | later | {symbols.t: state[symbols.t] + h}


def _columns(assembly: Assembly) -> Iterable[Sequence[Scalar]]:
    """The columns of J, also where it has no rows."""
    return zip(*assembly.J, strict=True) if assembly.J else ((),) * len(assembly.M)


def _laws_of_round(system: System) -> list[tuple[str, tuple[Scalar, ...]]]:
    """(contact, (F, factor, N_1, N_2)) of everything that rubs and holds on all sides."""
    reactions = reactions_of(system)
    rounds = [rub for rub in rubbing_contacts(system, reactions.components) if rub.normals]
    return [(r.name, (reactions.value(r.component), r.factor, *map(reactions.value, r.normals))) for r in rounds]


def _difference(name: str, a: Any, b: Any, tolerance: float) -> str:
    """Which entry of two vectors differs, or ""."""
    scale = 1 + max((abs(x) for x in b), default=0)
    wrong = [i for i, (x, y) in enumerate(zip(a, b, strict=True)) if not abs(x - y) <= tolerance * scale]
    return f"{name}[{wrong[0]}] is {a[wrong[0]]:.15g} against {b[wrong[0]]:.15g}" if wrong else ""
