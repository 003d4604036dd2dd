"""System, state in numbers -> values of formulas there, found without the simplifications of their printed forms.

Accelerations come from dense linear algebra with more than 20 digits, reactions from the bodies' equations solved in
doubles; every other function is evaluated as it is defined, with 50 digits. Nothing was simplified before.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System, exact_accelerations, with_accelerations
from eomgen.mechanics.free_bodies import Indeterminate, Reactions
from eomgen.mechanics.instant import Quantities
from eomgen.model import FUNCTIONS, OutputSource
from eomgen.proof.check import differing
from eomgen.proof.declared_loads import balanced_least
from eomgen.proof.printed import least_multipliers
from eomgen.proof.states import TrialState, pushes_of, with_inputs
from eomgen.proof.trials import Trials, refuse_noise
from eomgen.simulation import ReactionColumns
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Fraction,
    Node,
    Scalar,
    State,
    depends_on,
    order,
    parse,
    substituted,
)
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, tolerances

MOST = 3  # states at which all formulas are compared
AWAY = 10  # times the change between nearby states, by which a number may be wrong


@dataclass(frozen=True)
class NumericState:
    """A system in one phase, at a state.

    Args:
        equations: its equations of motion.
        parameters: their values, exact constants.
        numbers: t, q and u.
    """

    equations: EquationsOfMotion
    parameters: Mapping[Node, Scalar]
    numbers: Mapping[Node, float]

    @cached_property
    def values(self) -> State:
        """t, q, u, parameters and inputs with 50 digits."""
        values = evaluate(tuple(self.parameters.values()), {}, fifty_digits())
        known = dict(zip(self.parameters, values, strict=True))
        return with_inputs(
            self.equations.system, known | {x: fifty_digits().number(float(v)) for x, v in self.numbers.items()}
        )

    @cached_property
    def unknowns(self) -> dict[Node, Any]:
        """Accelerations, and the multipliers of least size.

        Raises:
            NoValue: they are not determined there.
        """
        a = exact_accelerations(self.equations, self.values)
        found = dict(zip(self.equations.symbols.a, a, strict=True))
        return found | least_multipliers(self.equations, self.values | found)

    def value_of(self, formula: Expression) -> float:
        """Value of a formula at the state.

        Raises:
            NoValue: it has none.
            MissingValues, DerivationError: it contains a quantity that is not known at the state.
        """
        quantities = Quantities(self.equations.system)

        def value(call: Call) -> Scalar:
            found = self.reactions.get(str(call)) if FUNCTIONS[call.name].source == OutputSource.BALANCE else None
            return quantities.value(call) if found is None else Fraction(found)

        try:
            return self.number(formula.evaluate(self.equations.system.scope.names, value))
        except Indeterminate:
            return self._together(quantities, formula)

    def _together(self, quantities: Quantities, formula: Expression) -> float:
        """Value of a formula of reactions of least norm that hold every body in equilibrium.

        Self-stresses, which may be added to these reactions, must not change it.

        Raises:
            NoValue: it does.
        """
        if quantities.reactions.balance.unknowns:
            raise NoValue("unknown loads hold it")
        least, added = self._balancing
        scalar, symbols = quantities.over_components(formula), quantities.reactions.by_components[1]

        def value_with(components: np.ndarray) -> float:
            numbers = dict(zip(symbols, map(Fraction, components.tolist()), strict=True))
            return self.number(substituted((scalar,), numbers)[0])

        found, size = value_with(least), np.abs(least).max(initial=0.0) or 1.0
        others = [value_with(least + size * column) for column in added.T]
        if any(abs(x - found) > tolerances.COMPUTED * size for x in others):
            raise NoValue(f"the equilibrium of the bodies does not determine '{formula.text}'")
        return found

    @cached_property
    def _balancing(self) -> tuple[np.ndarray, np.ndarray]:
        known = self.values | (self.unknowns if self.equations.symbols.u else {})
        return balanced_least(Reactions.of(self.equations.system, short=True).balance, known)

    def number(self, scalar: Scalar) -> float:
        """A function of the state, of accelerations and multipliers."""
        symbols, known = self.equations.symbols, self.values
        if depends_on(scalar, (*symbols.a, *symbols.lam)):
            known = known | self.unknowns
        return float(evaluate((scalar,), known, fifty_digits())[0])

    def decides(self, scalar: Scalar) -> bool:
        """True if the value of a function at the state is determined by it and not by rounding: no 0/0."""
        try:
            refuse_noise((scalar,), self.values | self.unknowns)
        except (NoValue, ZeroDivisionError):
            return False
        return True

    @cached_property
    def reactions(self) -> dict[str, float]:
        """Every reaction that has a single value, by its name in outputs."""
        try:
            columns = ReactionColumns(Reactions.of(self.equations.system), self._rhs)
            found = columns.along(np.array([self.t]), self.x[None, :], self.p)[0]
        except DerivationError:
            return {}
        return {name: float(x) for name, x in zip(columns.names, found, strict=True) if np.isfinite(x)}

    def rounding(self, formula: Expression) -> float:
        """Rounding error of reactions in doubles, by the size of the forces [N, N m]; 0 without reactions."""
        if not any(FUNCTIONS[call.name].source == OutputSource.BALANCE for call in formula.calls):
            return 0.0
        forces = evaluate(tuple(self.equations.forcing), self.values, fifty_digits()) or self._applied
        return tolerances.ROUNDING * max((abs(float(x)) for x in forces), default=0.0)

    @property
    def _applied(self) -> list[Any]:
        """Wrenches applied to each body of a structure, about the ground's origin."""
        loads = self.equations.system.loads
        placed = [load for force in loads.applied for load in force.loads]
        pushes = pushes_of(self.equations.system.motion, self.values, (*placed, *loads.weights))
        return [x for moment, force in pushes.values() for x in (*moment, *force)]

    @property
    def t(self) -> float:
        return float(self.numbers[self.equations.symbols.t])

    @property
    def x(self) -> np.ndarray:
        """(q, u)"""
        symbols = self.equations.symbols
        return np.array([self.numbers[node] for node in symbols.x], dtype=float)

    @property
    def p(self) -> np.ndarray:
        values = evaluate(tuple(self.parameters.values()), {}, fifty_digits())
        known = dict(zip(self.parameters, values, strict=True))
        return np.array([float(known.get(node, np.nan)) for node in self.equations.symbols.parameters.values()])

    @cached_property
    def _rhs(self) -> RightHandSide:
        return RightHandSide.of(Program.right_hand_side(with_accelerations(self.equations)), "numpy")

    @cached_property
    def jumps(self) -> bool:
        """True if an applied force jumps with the sign of a rate: its values on either side differ, however near."""
        symbols, digits = self.equations.symbols, fifty_digits()
        signs = (x for x in order(self.equations.forcing) if x.op == "sign")
        if not any(depends_on(x.args[0], symbols.u) for x in signs):
            return False
        apart = []
        for away in (tolerances.COMPUTED, tolerances.COMPUTED * tolerances.BESIDE_A_PLACE):
            sides = ({**self.values, **{u: self.values[u] + sign * away for u in symbols.u}} for sign in (1, -1))
            first, last = (evaluate(self.equations.forcing, side, digits) for side in sides)
            apart.append([abs(x - y) for x, y in zip(first, last, strict=True)])
        return any(near > tolerances.COMPUTED and 2 * near > far for far, near in zip(*apart, strict=True))

    def nearby(self) -> tuple[NumericState, NumericState]:
        """Two states that differ from it by rounding errors of several steps in doubles."""
        turns = {
            node: (-1) ** k * tolerances.COMPUTED * (1 + abs(x)) for k, (node, x) in enumerate(self.numbers.items())
        }
        moved = ({node: x + sign * turns[node] for node, x in self.numbers.items()} for sign in (1, -1))
        first, last = (replace(self, numbers=numbers) for numbers in moved)
        return first, last


def moving_states(equations: EquationsOfMotion) -> Iterator[NumericState]:
    """The first state of each supply where the motion has accelerations."""
    count = 0
    for _, supply in Trials(equations).states.supplies:
        for place in supply:
            state = state_in_numbers(equations, place)
            try:
                state.unknowns.keys()
            except (NoValue, ZeroDivisionError, DerivationError):
                continue
            yield state
            count += 1
            break
        if count == MOST:
            return


def place_of(state: NumericState) -> str:
    """Time and first coordinates of a state, in words."""
    moving = [f"{node.name} = {x:.6g}" for node, x in state.numbers.items()]
    return ", ".join(moving[1:4])


def state_in_numbers(equations: EquationsOfMotion, place: TrialState) -> NumericState:
    """A state at which equations are tried, in doubles."""
    symbols, values = equations.symbols, place.state
    parameters = {node: Fraction(float(values[node])) for node in symbols.parameters.values()}
    return NumericState(equations, parameters, {x: float(values[x]) for x in (symbols.t, *symbols.x)})


def read_back(system: System, text: str) -> Scalar:
    """A printed formula as a scalar of the system.

    Raises:
        ExpressionError: our grammar does not read it.
        DerivationError: a function of the motion stands in it.
    """

    def none(call: Call) -> Scalar:
        raise DerivationError(f"'{call}' stands in the text")

    found: Scalar = parse(text, tables=system.scope.model.functions).evaluate(system.scope.names, none)
    return found


def off_by(found: float, right: float, near: list[float]) -> str:
    """Message if a number is wrong by more than its change between nearby states; "".

    Raises:
        NoValue: next to a singular position nearby states are far apart.
    """
    change = max(abs(x - right) for x in near)
    off = abs(found - right)
    if off <= AWAY * change <= tolerances.SAME_PLACE * (1 + abs(right)):
        return ""
    if off <= AWAY * change:
        raise NoValue("the state is next to a singular position, and doubles say too little of it")
    return differing(found, right)
