"""Model -> PhaseEquations: the equations of one phase, and the exact value of a formula of the model in it.

A formula may contain coordinates, rates, accelerations, and functions of the motion and of the reactions. As a function
of the state, its accelerations and multipliers are replaced by the equations of motion. At one instant the state is
substituted into the equations first, and these are solved there: so nothing is divided by a pivot of the general
solution that vanishes at this state.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

from eomgen.codegen.programs import accelerations_and_multipliers
from eomgen.errors import MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints.rank import degrees_of_freedom
from eomgen.mechanics.constraints.rows import holds_identically
from eomgen.mechanics.dynamics.explicit_accelerations import bordered_rows, by_short_rows, regular_rows
from eomgen.mechanics.dynamics.pieces import refuse_jump, signs_of_rates
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System, system_of
from eomgen.mechanics.dynamics.wellposed import refuse_massless
from eomgen.mechanics.free_bodies.balance import still
from eomgen.mechanics.free_bodies.friction import equations_of_motion
from eomgen.mechanics.free_bodies.solution import values_at_a_state
from eomgen.mechanics.instant.quantities import Quantities, requests_of
from eomgen.mechanics.kinematics.scene import ContactModes
from eomgen.model.outputs.base import BALANCE, MASSES
from eomgen.model.parts import Model
from eomgen.model.unknowns import in_loads, refuse_motion
from eomgen.symbolic.exact.normal_form import legible, readable_all
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.formula import Call, Expression
from eomgen.symbolic.expression.node import Node, Scalar, ScalarRow, State
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.sure_numbers import number_of, numbers_of
from eomgen.symbolic.numeric.tolerances import COMPUTED
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size
from eomgen.symbolic.solve.linear import LinearSystem, general_solution

LONG = 400  # characters from which a formula is no easier to read than it came
NO_FORMULA = 10 * LONG  # characters of an unreadable formula: rows are shortened before they are eliminated


@dataclass(frozen=True)
class PhaseEquations:
    """The equations of motion of one phase.

    Args:
        system: motion, loads and constraints.
    """

    system: System

    @property
    def model(self) -> Model:
        return self.system.scope.model

    @cached_property
    def equations(self) -> EquationsOfMotion:
        """The equations of motion, friction included.

        Raises:
            ModelError: a free coordinate moves no mass.
            DerivationError: a load contains an unknown.
        """
        refuse_motion(self.model)
        equations = equations_of_motion(self.system)
        refuse_massless(equations)
        return equations

    @cached_property
    def unknowns(self) -> dict[Node, Scalar]:
        """Accelerations and multipliers as functions of q, u, t and inputs."""
        found = accelerations_and_multipliers(self.equations)
        size = max(map(text_size, found.values()), default=0)
        if size <= NO_FORMULA or not self.equations.J or self.equations.friction:
            return found
        short = by_short_rows(self.equations, self.simple)
        return found if short is None or max(map(text_size, short.values())) > size else short

    @property
    def accelerations(self) -> ScalarRow:
        return tuple(self.unknowns[a] for a in self.system.symbols.a)

    @cached_property
    def moves_by_time(self) -> bool:
        """True if time stands in the equations of motion."""
        e, t = self.equations, (self.system.symbols.t,)
        entries = (x for row in (*e.M, *e.J) for x in row)
        inputs = (self.system.inputs[name] for name in self.system.symbols.inputs)
        return any(depends_on(x, t) for x in (*entries, *e.forcing, *e.gamma, *inputs))

    @cached_property
    def _quantities(self) -> Quantities:
        return Quantities(self.system)

    # -- as functions of the state ---------------------------------------------------------------

    def raw(self, formula: Expression) -> Scalar:
        """Scalar of the formula, in which accelerations and multipliers are still symbols."""
        return self._quantities.of(formula)

    def of_state(self, formula: Expression) -> Scalar:
        """The formula as a function of q, u and t; each function of the motion in it is simplified by itself."""

        def value(call: Call) -> Scalar:
            return self.simple(self.eliminated(self._quantities.value(call)))

        return self.eliminated(self._quantities.of(formula, value))

    def eliminated(self, scalar: Scalar) -> Scalar:
        """Scalar with accelerations and multipliers replaced by the equations of motion, unknown loads by statics."""
        scalar = self._known(scalar, self._quantities)
        if self._stands_still:
            (scalar,) = substituted((scalar,), still(self.system))
        if not depends_on(scalar, (*self.system.symbols.a, *self.system.symbols.lam)):
            return scalar
        return substituted((scalar,), self.unknowns)[0]

    @cached_property
    def _stands_still(self) -> bool:
        """True if the constraints fix every coordinate: J u = 0 with as many independent rows as speeds."""
        constraints = self.system.constraints
        if not constraints.closing or not all(holds_identically(x) for x in constraints.sigma):
            return False
        try:
            return degrees_of_freedom(constraints) == 0
        except MissingValues:
            return False

    def _known(self, scalar: Scalar, quantities: Quantities) -> Scalar:
        """Scalar with the unknowns of loads replaced by their values at rest."""
        symbols = self.system.symbols.unknowns
        held = [p for p in symbols.values() if depends_on(scalar, (p,))]
        return substituted((scalar,), {p: quantities.reactions.unknown(p.name) for p in held})[0] if held else scalar

    def simple(self, scalar: Scalar) -> Scalar:
        """Scalar in its most readable form; unchanged where simplifying does not make it shorter."""
        known = self._legible
        if scalar not in known:
            found = legible(scalar, Work.ANSWER, self.system.scope.positive, LONG)
            known |= {scalar: found, found: found}
        return known[scalar]

    @cached_property
    def _legible(self) -> dict[Scalar, Scalar]:
        """Cache of `simple`: scalar -> its most readable form."""
        return {}

    # -- at an instant ---------------------------------------------------------------------------

    def number(self, formula: Expression, numbers: Mapping[Node, Scalar | float]) -> float:
        """Number of the formula at a state, accelerations and reactions solved there.

        Args:
            numbers: of t, q, u and the parameters.
        """
        return self.numbers((formula,), numbers)[0]

    def numbers(self, formulas: Sequence[Expression], numbers: Mapping[Node, Scalar | float]) -> list[float]:
        """Numbers of several formulas at a state; common subexpressions are evaluated once."""
        if signs_of_rates(self.system) and any(map(self.needs_equations, formulas)):
            refuse_jump(self.system, exact_numbers(numbers))
        inputs = {node: self.system.inputs[name] for name, node in self.system.symbols.inputs.items()}
        closed = substituted(tuple(self.eliminated(self.raw(formula)) for formula in formulas), inputs)
        found = numbers_of(closed, numbers)
        stable = self._are_stable(found, closed, numbers)
        for k, formula in enumerate(formulas):
            if not (math.isfinite(found[k]) and stable[k]):
                found[k] = number_of(self._solved_at(formula, exact_numbers(numbers), readable=False), numbers)
        return found

    def _are_stable(
        self, found: Sequence[float], closed: Sequence[Scalar], numbers: Mapping[Node, Scalar | float]
    ) -> list[bool]:
        """True for each closed form whose value in floats is the same: no pivot by which it divides vanishes there."""
        if not self.system.constraints.closing:
            return [True] * len(found)
        exact = exact_numbers(numbers)
        floats = dict(zip(exact, numbers_of(exact.values()), strict=True))
        rounded = evaluate(tuple(closed), floats, FLOAT)
        pairs = zip(found, rounded, strict=True)
        return [math.isclose(x, y, rel_tol=COMPUTED, abs_tol=COMPUTED) for x, y in pairs]

    def at(self, formula: Expression, state: Mapping[Node, Any]) -> Scalar:
        """The formula at a state that is given exactly, in the parameters alone.

        Args:
            state: exact scalars of t, q and u; the formula must not depend on those that are missing.
        Raises:
            MissingValues: it depends on one; the error names them.
        """
        return self.simple(self._solved_at(formula, state))

    def _solved_at(self, formula: Expression, state: Mapping[Node, Any], *, readable: bool = True) -> Scalar:
        """The formula at a state, the equations of motion solved anew there.

        Args:
            readable: True if the result is printed; an unsimplified one is faster where only its number is needed.
        """
        cached = self._cached(state)
        state = self.complete(state, formula, readable=readable)
        quantities = cached.setdefault((Quantities, readable, len(state)), Quantities(self.system, state))
        scalar = quantities.of(formula)
        (scalar,) = substituted((scalar,), state)
        (scalar,) = substituted((self._known(scalar, quantities),), state)
        symbols = self.system.symbols
        left = [
            x.name for x in (symbols.t, *symbols.q, *symbols.u, *symbols.a, *symbols.lam) if depends_on(scalar, (x,))
        ]
        if left:
            raise MissingValues(tuple(left))
        return scalar

    def complete(self, state: Mapping[Node, Any], formula: Expression | None = None, *, readable: bool = True) -> State:
        """The state with accelerations, multipliers and inputs, as far as they are needed and determined."""
        given, inputs = state, {node: self.system.inputs[name] for name, node in self.system.symbols.inputs.items()}
        state = {**state, **dict(zip(inputs, substituted(tuple(inputs.values()), state), strict=True))}
        if in_loads(self.model):
            return {**state, **still(self.system)}
        if formula is not None and not self.needs_equations(formula):
            return state
        cached = self._cached(given)
        if readable not in cached:
            refuse_jump(self.system, state)
            cached[readable] = self._unknowns_at(state, readable)
        return {**state, **cached[readable]}

    def _cached(self, state: Mapping[Node, Any]) -> dict[Any, Any]:
        """Cache of solutions at a state, for several formulas there; only the last state is cached."""
        key = tuple(state.items())
        if self._at_one_state.get("state") != key:
            self._at_one_state.clear()
            self._at_one_state["state"] = key
        return self._at_one_state

    @cached_property
    def _at_one_state(self) -> dict[Any, Any]:
        """Solutions at the last requested state."""
        return {}

    def method_for(self, formula: Expression) -> str:
        """Name of the method that the formula needs; "" for positions and rates.

        It is the method by which reactions and accelerations are eliminated, or that of the functions of masses.
        """
        unknown = not formula.names.isdisjoint(self.system.symbols.unknowns)
        if unknown or requests_of(formula, BALANCE):
            return BALANCE
        if self.needs_equations(formula):
            return "equations of motion"
        return MASSES if requests_of(formula, MASSES) else ""

    def needs_equations(self, formula: Expression) -> bool:
        """True if accelerations, multipliers or reactions stand in the formula."""
        if requests_of(formula, BALANCE):
            return True
        return depends_on(self.raw(formula), (*self.system.symbols.a, *self.system.symbols.lam))

    def _unknowns_at(self, state: Mapping[Node, Any], readable: bool) -> dict[Node, Scalar]:
        """Accelerations and multipliers at a state, by solving the equations there."""
        symbols, equations = self.system.symbols, self.equations
        if equations.friction:
            values = substituted(tuple(self.unknowns.values()), state)
            return dict(zip(self.unknowns, (self.simple(x) if readable else x for x in values), strict=True))
        kept = regular_rows(self.system)
        rows, right = bordered_rows(equations, kept)
        entries = substituted([x for row in rows for x in row.values()], state)
        needed = substituted(right, state)
        if readable:
            entries, needed = (readable_all(x, Work.ANSWER, self.system.scope.positive) for x in (entries, needed))
        flat = iter(entries)
        rows = [{j: next(flat) for j in row} for row in rows]
        solution = general_solution(LinearSystem(rows, needed, len(right), values_at_a_state(self.system, entries)))
        names = (*symbols.a, *(symbols.lam[m] for m in kept))
        missing = [x for x in (symbols.t, *symbols.q, *symbols.u) if x not in state]  # results with one are not used
        found = {names[j]: x for j, x in solution.constants.items() if solution.determined(j)}
        return {name: self.simple(x) if readable and not depends_on(x, missing) else x for name, x in found.items()}


def phase_equations_of(model: Model, modes: ContactModes | None = None) -> PhaseEquations:
    """The equations of a model in one configuration of its contacts."""
    return PhaseEquations(system_of(model, modes))


def exact_numbers(values: Mapping[Node, Scalar | float]) -> dict[Node, Scalar]:
    """Exact rational values of doubles; nan is left out."""
    found = {node: Fraction(x) if isinstance(x, float) and math.isfinite(x) else x for node, x in values.items()}
    return {node: x for node, x in found.items() if not isinstance(x, float)}
