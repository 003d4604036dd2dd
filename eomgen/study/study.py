"""Model -> Study: everything that is derived of a model while its contacts stay as they are, each once, by its name.

    study_of(model)                     contacts as they are at the start; one study a model and process
    study_at_rest(model)                contacts as they are at rest
    study_of_modes(model, modes)        contacts as they are named

A verb is a study, one question, one document: the system, its equations of motion, reactions, start and program are
taken from here, and nowhere made again. What is never asked for is never derived.

A study also evaluates formulas of the model exactly. A formula may hold coordinates, rates, accelerations, functions
of the motion and of the reactions. As a function of the state, accelerations and multipliers are replaced by the
equations of motion. At one instant the instant's values are put into the equations first, and these are solved there:
so nothing is divided by what vanishes only in between.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import islice, product
from typing import TYPE_CHECKING, Any

import numpy as np

from eomgen.errors import DerivationError, MissingValues, ModelError, UsageError
from eomgen.frozen import RECALLED, dataclass, recalled
from eomgen.mechanics.constraints import Rank, holds_identically
from eomgen.mechanics.dynamics import (
    EquationsOfMotion,
    Explicit,
    ForceJumps,
    System,
    WellPosed,
    assembled_by_recursion,
    with_accelerations,
    with_nodes_balanced,
)
from eomgen.mechanics.free_bodies import (
    Balance,
    NamedReaction,
    SystemFriction,
    equations_of_motion,
    values_at_a_state,
    with_friction,
)
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.integrals import FirstIntegrals
from eomgen.mechanics.kinematics import ContactMode, ContactModes
from eomgen.mechanics.start import ExactStart, Start
from eomgen.mechanics.statics import ContactsAtStart
from eomgen.model import Model, ModelOrPath, OutputSource, Table, Values, WrittenEquation, model_at
from eomgen.resources import growing
from eomgen.symbolic.exact import LinearSystem, legible, readable_all
from eomgen.symbolic.expression import (
    Call,
    Expression,
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    State,
    depends_on,
    substituted,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, NoValue, Work, evaluate, number_of, numbers_of, tolerances
from eomgen.symbolic.print import text_size

if TYPE_CHECKING:  # loaded where they are asked for: `check` writes no code
    from eomgen.codegen import Program
    from eomgen.mechanics.dynamics import Extent
    from eomgen.mechanics.equilibrium import Equilibria, Equilibrium, StaticEquations
    from eomgen.mechanics.free_bodies import Reactions
    from eomgen.mechanics.linearization import FirstOrder
    from eomgen.study.programs import Matrices, RequestedOutputs

LONG = 400  # characters from which a formula is no easier to read than it came
NO_FORMULA = 10 * LONG  # characters of an unreadable formula: rows are shortened before they are eliminated


@dataclass(frozen=True)
class Study:
    """Lazy value of a model in one configuration of its contacts: what is derived of it, once, by name.

    Args:
        system: motion, loads and constraints.
        of_contacts: what had to be assumed of them: "floor assumed closed: h has no value".
        replaced: equations of motion in place of those of the system, with rows that pull back what has opened.
    """

    system: System
    of_contacts: tuple[str, ...] = ()
    replaced: EquationsOfMotion | None = None

    def __getstate__(self) -> dict[str, Any]:
        """State to be pickled, without what is recalled."""
        return {name: value for name, value in self.__dict__.items() if name != RECALLED}

    @property
    def model(self) -> Model:
        return self.system.scope.model

    @property
    def assumptions(self) -> tuple[str, ...]:
        """Assumptions about massless nodes and contacts."""
        return (*self.model.assumed_by_constraints, *self.of_contacts)

    @cached_property
    def derived(self) -> EquationsOfMotion:
        """The equations of motion as they stand, friction included, also where a coordinate moves no mass."""
        return self.replaced or equations_of_motion(self.system)

    @cached_property
    def equations(self) -> EquationsOfMotion:
        """The equations of motion of what can move.

        Raises:
            ModelError: a free coordinate moves no mass.
            DerivationError: a load contains an unknown.
        """
        self.model.refuse_motion()
        WellPosed(self.derived).refuse_massless()
        return self.derived

    def pulled(self, rates: tuple[float, float]) -> Study:
        """The same with stabilized constraints after Baumgarte: accelerations that close open constraints.

        Args:
            rates: alpha, beta [1/s].
        Raises:
            UsageError: see `stabilized`.
        """
        return replace(self, replaced=with_friction(assembled_by_recursion(self.system).stabilized(rates)))

    @cached_property
    def explicit(self) -> EquationsOfMotion:
        """The equations of motion as code has them: explicit where that is shorter, finite where nothing slides."""
        equations = self.explicit_while_sliding
        if not equations.friction or equations.accelerations is None:
            return equations
        return replace(equations, accelerations=SystemFriction(self.system).with_rest(equations.accelerations))

    @cached_property
    def explicit_while_sliding(self) -> EquationsOfMotion:
        """The same without a value where nothing slides and friction has no direction: there a run of them ends."""
        return with_accelerations(self.derived)

    @cached_property
    def program(self) -> Program:
        """The right-hand side x' = f(t, x, p, inputs) as a straight-line program.

        Raises:
            ModelError: a free coordinate moves no mass.
        """
        from eomgen.codegen import Program

        WellPosed(self.derived).refuse_massless()
        with growing():
            return Program.right_hand_side(self.explicit)

    @cached_property
    def slopes(self) -> Matrices:
        """A = d x'/d x, B = d x'/d inputs as graph scalars, and the systems behind the unknowns that they hold.

        Raises:
            DerivationError: the mass matrix is singular whatever the state.
        """
        from eomgen.study.programs import slopes_of

        WellPosed(self.derived).refuse_massless()
        return slopes_of(self.explicit)

    @cached_property
    def first_order(self) -> FirstOrder:
        """The linearized equations beside any motion, for numbers at a state."""
        from eomgen.mechanics.linearization import FirstOrder

        WellPosed(self.derived).refuse_massless()
        return FirstOrder(self.derived, ())

    # -- reactions and outputs ---------------------------------------------------------------------

    @cached_property
    def reactions(self) -> Reactions:
        """Every reaction of joints and constraints, in q, u and the accelerations.

        Raises:
            DerivationError: an unsupported body; a force that acts at no place.
        """
        from eomgen.mechanics.free_bodies import Reactions

        return Reactions.of(self.system)

    @cached_property
    def named_reactions(self) -> tuple[NamedReaction, ...]:
        """The reactions as outputs name them, each with its unit and the components of which it consists.

        Raises:
            DerivationError: an unsupported body; a force that acts at no place.
        """
        return tuple(NamedReaction.all_of(Balance.of(self.system)))

    @property
    def units(self) -> dict[str, dict[str, str]]:
        """{"names", "equations", "reactions", "outputs": {name: unit}}; no reactions where none are determined."""
        found = self.model.units_of_everything(u.name for u in self.derived.symbols.u)
        try:
            return {**found, "reactions": {named.name: named.unit for named in self.named_reactions}}
        except DerivationError:
            return {**found, "reactions": {}}

    @property
    def reactions_at_start(self) -> dict[str, float]:
        """The reactions that have a single value at the start, in numbers.

        Raises:
            MissingValues: a parameter that they need has no value.
            DerivationError: a force jumps there; an unsupported body.
            ModelError: a free coordinate moves no mass.
        """
        from eomgen.codegen import RightHandSide
        from eomgen.simulation import ReactionColumns

        p, symbols, start = (
            RightHandSide.parameter_values(self.model),
            self.system.symbols,
            list(self.state_at_start.values()),
        )
        known = {x: Fraction(value) for x, value in zip(symbols.x, start, strict=True)}
        ForceJumps(self.system).refuse(known | {symbols.t: Fraction(0)})
        columns = ReactionColumns(self.reactions, RightHandSide.of(self.program, "numpy"))
        values = columns.along(np.zeros(1), np.array([start]), p)[0]
        rounding = tolerances.ROUNDING * max((abs(x) for x in values if math.isfinite(x)), default=0.0)
        return {
            name: float(x) if abs(x) > rounding else 0.0
            for name, x in zip(columns.names, values, strict=True)
            if math.isfinite(x)
        }

    @cached_property
    def reaction_values(self) -> dict[str, Scalar]:
        """{name: value in q, u and a} of the reactions that have a single value, finite where nothing slides."""

        values = self.reactions.determinate()
        return dict(zip(values, SystemFriction(self.system).with_rest(tuple(values.values())), strict=True))

    @cached_property
    def reactions_program(self) -> tuple[tuple[str, ...], Program]:
        """(names, program) of the reactions that have a single value; accelerations as in the right-hand side."""
        from eomgen.study.programs import reactions_program

        WellPosed(self.derived).refuse_massless()
        return reactions_program(self.reaction_values, self.explicit)

    @cached_property
    def requested_outputs(self) -> RequestedOutputs:
        """The outputs of the model that are functions of the state, in q, u and a; and why the others are none."""
        from eomgen.study.programs import outputs_of_state

        found = outputs_of_state(self.system)
        values = dict(
            zip(found.values, SystemFriction(self.system).with_rest(tuple(found.values.values())), strict=True)
        )
        return replace(found, values=values)

    @cached_property
    def outputs_program(self) -> Program:
        """The outputs that are functions of the state; accelerations as in the right-hand side."""
        from eomgen.study.programs import reactions_program

        WellPosed(self.derived).refuse_massless()
        return reactions_program(self.requested_outputs.values, self.explicit)[1]

    # -- parameters and the start --------------------------------------------------------------------

    @cached_property
    def parameters(self) -> dict[Node, Scalar]:
        """The parameters that have a value, exactly."""
        return self.system.scope.known_exactly

    @property
    def numeric_parameters(self) -> dict[Node, float]:
        """The same as doubles."""
        values = self.model.numeric_parameters()
        return {self.system.symbols.parameters[name]: float(x) for name, x in values.items()}

    @cached_property
    def start(self) -> ExactStart:
        """The start at which the constraints hold: exact where it has a closed form, in numbers else."""
        return ExactStart(self.system)

    @cached_property
    def start_from_rest(self) -> ExactStart:
        """The same with all speeds 0."""
        return ExactStart(self.system, True)

    def stays_constant(self, x: Scalar) -> bool:
        """True if a function of the state is proven to keep its value along every motion."""
        return FirstIntegrals(self.equations).stay_constant((x,))[0]

    def start_of(self, *, at_rest: bool) -> ExactStart:
        """The start, or the same with all speeds 0."""
        return self.start_from_rest if at_rest else self.start

    @cached_property
    def state_at_start(self) -> dict[str, float]:
        """q and u at the start, in numbers.

        Raises:
            MissingValues: a parameter that it needs has no value.
        """
        return Start.of(self.system).values

    @cached_property
    def values_at_start(self) -> dict[str, Scalar | float]:
        """q and u at the start by name, exact where they have a closed form, so that zeros are exact.

        Raises:
            MissingValues: a parameter that they need has no value.
        """
        values: dict[str, Scalar | float] = {**self.state_at_start}
        exact = {**self.start.exact, **self.system.loads.begun}
        closed = zip(exact, substituted(tuple(exact.values()), self.parameters), strict=True)
        return values | {x.name: value for x, value in closed if x.name in values and not symbols_of((value,))}

    @cached_property
    def unknowns(self) -> dict[Node, Scalar]:
        """Accelerations and multipliers as functions of q, u, t and inputs."""
        from eomgen.study.programs import accelerations_and_multipliers

        found = accelerations_and_multipliers(self.equations)
        size = max(map(text_size, found.values()), default=0)
        if size <= NO_FORMULA or not self.equations.J or self.equations.friction:
            return found
        short = Explicit(self.equations).by_short_rows(self.simple)
        return found if short is None or max(map(text_size, short.values())) > size else short

    def rates(self, *, at_rest: bool) -> tuple[dict[Node, Scalar], Extent] | None:
        """(every speed as a function of the coordinates, where that holds), by the first integrals; None: by none.

        Raises:
            DerivationError: a coordinate has no value at the start.
        """
        from eomgen.mechanics.integrals import rates_and_extent

        start = self.start_of(at_rest=at_rest).values
        return recalled(
            self, ("rates", at_rest), lambda: rates_and_extent(self.equations, start, accelerations=self.accelerations)
        )

    def rates_by_one(self, *, at_rest: bool) -> tuple[dict[Node, Scalar], Extent] | None:
        """(the speeds that momenta from the start and constraints give by one of them, where); None: several are free.

        Raises:
            DerivationError: a coordinate has no value at the start.
        """
        from eomgen.mechanics.integrals import Relations

        start = self.start_of(at_rest=at_rest).values

        def found() -> tuple[dict[Node, Scalar], Extent] | None:
            relations = Relations.of(self.equations, start)
            return None if relations is None else (relations.speeds, FirstIntegrals(self.equations).where_momenta_hold)

        return recalled(self, ("rates by one", at_rest), found)

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
    def quantities(self) -> Quantities:
        """The values of output functions, accelerations and multipliers as symbols."""
        return Quantities(self.system)

    # -- at rest ---------------------------------------------------------------------------------

    @cached_property
    def statics(self) -> StaticEquations:
        """The equations of rest."""
        from eomgen.mechanics.equilibrium import StaticEquations

        return StaticEquations.of(self.system)

    @cached_property
    def equilibria(self) -> Equilibria:
        """Every equilibrium that is found, the nearest to the start first.

        Raises:
            DerivationError: the forces hold an unknown; dry friction; a drive that turns steadily.
        """
        from eomgen.mechanics.equilibrium import Equilibria

        return Equilibria.of(self.statics)

    # -- as functions of the state ---------------------------------------------------------------

    def raw(self, formula: Expression) -> Scalar:
        """Scalar of the formula, in which accelerations and multipliers are still symbols."""
        return self.quantities.of(formula)

    def of_state(self, formula: Expression) -> Scalar:
        """The formula as a function of q, u and t; each function of the motion in it is simplified by itself."""

        def value(call: Call) -> Scalar:
            return self.simple(self.eliminated(self.quantities.value(call)))

        return self.eliminated(self.quantities.of(formula, value))

    def difference(self, equation: WrittenEquation) -> Scalar:
        """Left side minus right side of an equation as a function of q, u and t."""
        return self.of_state(equation.left) - self.of_state(equation.right)

    def eliminated(self, scalar: Scalar) -> Scalar:
        """Scalar with accelerations and multipliers replaced by the equations of motion, unknown loads by statics."""
        scalar = self._known(scalar, self.quantities)
        if self._stands_still:
            (scalar,) = substituted((scalar,), self.system.still)
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
            return Rank(constraints).degrees_of_freedom() == 0
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

    def refuse_jump(self, formulas: Sequence[Expression], numbers: Mapping[Node, Scalar | float]) -> None:
        """Refuses accelerations and reactions in formulas at a state where they jump with the sign of a rate."""
        if ForceJumps(self.system).signs and any(map(self.needs_equations, formulas)):
            ForceJumps(self.system).refuse(exact_numbers(numbers))

    def numbers(self, formulas: Sequence[Expression], numbers: Mapping[Node, Scalar | float]) -> list[float]:
        """Numbers of several formulas at a state; common subexpressions are evaluated once."""
        self.refuse_jump(formulas, numbers)
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
        return [math.isclose(x, y, rel_tol=tolerances.COMPUTED, abs_tol=tolerances.COMPUTED) for x, y in pairs]

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
        left = [x.name for x in (symbols.t, *symbols.x, *symbols.a, *symbols.lam) if depends_on(scalar, (x,))]
        if left:
            raise MissingValues(tuple(left))
        return scalar

    def complete(self, state: Mapping[Node, Any], formula: Expression | None = None, *, readable: bool = True) -> State:
        """The state with accelerations, multipliers and inputs, as far as they are needed and determined."""
        given, inputs = state, {node: self.system.inputs[name] for name, node in self.system.symbols.inputs.items()}
        state = {**state, **dict(zip(inputs, substituted(tuple(inputs.values()), state), strict=True))}
        if self.model.unknowns_in_loads():
            return {**state, **self.system.still}
        if formula is not None and not self.needs_equations(formula):
            return state
        cached = self._cached(given)
        if readable not in cached:
            ForceJumps(self.system).refuse(state)
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
        if unknown or Quantities.requested_by(formula, OutputSource.BALANCE):
            return OutputSource.BALANCE
        if self.needs_equations(formula):
            return "equations of motion"
        return OutputSource.MASSES if Quantities.requested_by(formula, OutputSource.MASSES) else ""

    def needs_equations(self, formula: Expression) -> bool:
        """True if accelerations, multipliers or reactions stand in the formula."""
        if Quantities.requested_by(formula, OutputSource.BALANCE):
            return True
        return depends_on(self.raw(formula), (*self.system.symbols.a, *self.system.symbols.lam))

    def _unknowns_at(self, state: Mapping[Node, Any], readable: bool) -> dict[Node, Scalar]:
        """Accelerations and multipliers at a state, by solving the equations there."""
        symbols, equations = self.system.symbols, self.equations
        if equations.friction:
            values = substituted(tuple(self.unknowns.values()), state)
            return dict(zip(self.unknowns, (self.simple(x) if readable else x for x in values), strict=True))
        kept = Rank(self.system.constraints).regular()
        rows, right = Explicit(equations).bordered(kept)
        entries = substituted([x for row in rows for x in row.values()], state)
        needed = substituted(right, state)
        if readable:
            entries, needed = (readable_all(x, Work.ANSWER, self.system.scope.positive) for x in (entries, needed))
        flat = iter(entries)
        rows = [{j: next(flat) for j in row} for row in rows]
        solution = LinearSystem(rows, needed, len(right), values_at_a_state(self.system, entries)).solution()
        names = (*symbols.a, *(symbols.lam[m] for m in kept))
        missing = [x for x in (symbols.t, *symbols.x) if x not in state]  # results with one are not used
        found = {names[j]: x for j, x in solution.constants.items() if solution.determined(j)}
        return {name: self.simple(x) if readable and not depends_on(x, missing) else x for name, x in found.items()}


def model_to_study(model: ModelOrPath, parameters: Values | None = None, start: Values | None = None) -> Model:
    """The model whose motion is studied: each massless node is held by the balance of what pushes it.

    Args:
        parameters, start: values that replace the model's, each as `model_at` takes it.
    """
    return with_nodes_balanced(model_at(model, parameters, start))


def study_of(model: Model) -> Study:
    """The study of a model with its contacts as they are at the start; of one frozen model it is made once."""

    def made() -> Study:
        contacts = ContactsAtStart.of(model)
        return Study(Quantities.put_into_rates(System.of(model, contacts.modes)), contacts.assumptions)

    return recalled(model, study_of, made)


def study_at_rest(model: Model) -> Study:
    """The study of a model with its contacts as they are where it rests; of one frozen model it is made once."""

    def made() -> Study:
        modes, assumptions = _contacts_at_rest(model)
        return Study(Quantities.put_into_rates(System.of(model, modes)), assumptions)

    return recalled(model, study_at_rest, made)


def study_of_modes(model: Model, modes: ContactModes | None = None) -> Study:
    """The study of a model with its contacts as they are named, what is not named closed."""
    return Study(Quantities.put_into_rates(System.of(model, modes or {})))


def exact_numbers(values: Mapping[Node, Scalar | float]) -> dict[Node, Scalar]:
    """Exact rational values of doubles; nan is left out."""
    found = {node: Fraction(x) if isinstance(x, float) and math.isfinite(x) else x for node, x in values.items()}
    return {node: x for node, x in found.items() if not isinstance(x, float)}


# -------- contacts at rest ------------------------------------------------------------------------------------
# Model -> the states of its contacts where it rests: one choice for every verb that asks for rest.


ROUNDS = 6  # of contacts that a place of rest contradicts
MOST_TRIED = 16  # choices of contacts


def _contacts_at_rest(model: Model) -> tuple[ContactModes, tuple[str, ...]]:
    """(the contacts that are open at the equilibrium nearest to the start, or stick there; what was assumed).

    As at the start let go, where every choice contradicts something. Without coordinates nothing is open.
    """
    ending = [contact.name for contact in model.contacts if contact.unilateral]
    if not model.coordinates or not ending:
        return ContactsAtStart.at_rest(model), ()
    if model.rough_contacts:
        return ContactsAtStart.held_by_friction(_let_go(model)), ()
    begun = ContactsAtStart.of(_let_go(model))
    tried: list[frozenset[str]] = []
    wanted: frozenset[str] | None = frozenset(name for name, mode in begun.modes.items() if not mode.closed)
    while wanted is not None and wanted not in tried and len(tried) < ROUNDS:
        tried.append(wanted)
        place = _place(model, _opened(wanted))
        if place is not None and not place.contradicted:
            return _opened(wanted), begun.assumptions
        wanted = None if place is None else wanted.symmetric_difference(place.contradicted)
    for open_ in islice(_choices(ending), MOST_TRIED):
        place = None if open_ in tried else _place(model, _opened(open_))
        if place is not None and not place.contradicted:
            return _opened(open_), begun.assumptions
    return begun.modes, begun.assumptions


def _choices(names: list[str]) -> Iterator[frozenset[str]]:
    """The contacts that are open, in every choice of them."""
    for closed in product(*((True, False) for _ in names)):
        yield frozenset(name for name, holds in zip(names, closed, strict=True) if not holds)


def _opened(names: frozenset[str]) -> ContactModes:
    return dict.fromkeys(sorted(names), ContactMode(closed=False))


def _place(model: Model, modes: ContactModes) -> Equilibrium | None:
    """The equilibrium nearest to the start with these contacts; None where there is none, or it cannot be sought."""
    from eomgen.mechanics.equilibrium import Equilibrium, StaticEquations

    try:
        return Equilibrium.nearest(StaticEquations.of(System.of(model, modes)))
    except (DerivationError, MissingValues, ModelError, UsageError, NoValue, ZeroDivisionError):
        return None


def _let_go(model: Model) -> Model:
    """The model with no speed at its start."""
    coordinates = {
        name: part if part.driven or part.speed is None else part.altered(speed=None)
        for name, part in model.coordinates.items()
    }
    speeds = {name: part if part.start is None else part.altered(start=None) for name, part in model.speeds.items()}
    return model.altered(coordinates=Table(coordinates), speeds=Table(speeds))
