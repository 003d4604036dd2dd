"""Model -> Situation: the equations of one phase, and what a formula of the model is worth in it, exactly.

A formula may hold coordinates, rates, accelerations, and functions of the motion and of the reactions. As a function of
the state, accelerations and multipliers are replaced by the equations of motion. At one instant the instant's values
are put into the equations first, and these are solved there: so nothing is divided by what vanishes only in between.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from eomgen.codegen.factorization import solved
from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.assembly import Assembly, Row
from eomgen.mechanics.contacts import Modes
from eomgen.mechanics.explicit import bordered_rows, by_determinants, regular_rows
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.friction import with_friction
from eomgen.mechanics.loads import start_value, with_unit_quaternions
from eomgen.mechanics.loops.closure import number as precise
from eomgen.mechanics.loops.freedom import freedoms
from eomgen.mechanics.loops.start import fixed_by_position, start_speeds
from eomgen.mechanics.masses.inertia_about import FUNCTIONS as OF_MASSES
from eomgen.mechanics.outputs import Quantities
from eomgen.mechanics.positive import positive_parameters
from eomgen.mechanics.reacting.balance_solution import values_at_a_state
from eomgen.mechanics.reacting.reaction_outputs import ASKING_REACTIONS
from eomgen.mechanics.reacting.reduced import FEW, by_independent
from eomgen.mechanics.statics.unknown_loads import still
from eomgen.mechanics.system import System, system_of
from eomgen.mechanics.ties import holds_identically
from eomgen.mechanics.wellposed import refuse_massless
from eomgen.model.parts import Model
from eomgen.model.unknowns import in_loads, refuse_motion
from eomgen.symbolic import cramer, linear
from eomgen.symbolic.derivative import depends_on, substituted
from eomgen.symbolic.evaluation import FLOAT, NoValue, evaluate, fifty_digits
from eomgen.symbolic.expressions import Call, Expression
from eomgen.symbolic.functions import inner
from eomgen.symbolic.graph import Node, Scalar, is_zero
from eomgen.symbolic.normal_form import legible, readable_all

WORK = 50_000  # products of terms for making one formula readable
LONG = 400  # characters from which a formula is no easier to read than it came
SAME = 1e-9  # between a value in floats and one with 50 digits, where nothing vanishes in between
State = Mapping[Node, Scalar]


@dataclass(frozen=True)
class Situation:
    """The equations of motion of one phase.

    Args:
        system: motion, loads and ties.
    """

    system: System

    @property
    def model(self) -> Model:
        return self.system.scope.model

    @cached_property
    def assembly(self) -> Assembly:
        """The equations of motion, friction included.

        Raises:
            ModelError: a free coordinate moves no mass.
            DerivationError: a force is unknown.
        """
        refuse_motion(self.model)
        assembly = with_friction(self.system, recursive.assemble(self.system))
        refuse_massless(self.system, assembly)
        return assembly

    @cached_property
    def positive(self) -> frozenset[Node]:
        """The parameters that stand for positive numbers: declared so, or given so."""
        return positive_parameters(self.system.scope)

    @cached_property
    def unknowns(self) -> dict[Node, Scalar]:
        """Accelerations and multipliers as functions of q, u, t and inputs."""
        return accelerations_and_multipliers(self.system, self.assembly)

    @property
    def accelerations(self) -> Row:
        return tuple(self.unknowns[a] for a in self.system.symbols.a)

    @cached_property
    def _quantities(self) -> Quantities:
        return Quantities(self.system)

    # -- as functions of the state ---------------------------------------------------------------

    def raw(self, formula: Expression) -> Scalar:
        """The formula as it stands: accelerations and multipliers are symbols."""
        return formula.evaluate(self.system.scope.names, self._quantities.value)

    def of_state(self, formula: Expression) -> Scalar:
        """The formula as a function of q, u and t; each function of the motion in it is readable by itself."""

        def value(call: Call) -> Scalar:
            return self.simple(self.eliminated(self._quantities.value(call)))

        return self.eliminated(formula.evaluate(self.system.scope.names, value))

    def eliminated(self, scalar: Scalar) -> Scalar:
        """A scalar with accelerations and multipliers replaced by the equations of motion, unknowns by the balance."""
        scalar = self._known(scalar, self._quantities)
        if self._stands_still:
            (scalar,) = substituted((scalar,), still(self.system))
        if not depends_on(scalar, (*self.system.symbols.a, *self.system.symbols.lam)):
            return scalar
        return substituted((scalar,), self.unknowns)[0]

    @cached_property
    def _stands_still(self) -> bool:
        """Whether the ties hold every coordinate where it is: J u = 0 with as many independent rows as speeds."""
        ties = self.system.ties
        if not ties.closing or not all(holds_identically(x) for x in ties.sigma):
            return False
        try:
            return freedoms(ties) == 0
        except MissingValues:
            return False

    def _known(self, scalar: Scalar, quantities: Quantities) -> Scalar:
        """A scalar with the unknowns of loads replaced by what they are at rest."""
        symbols = self.system.symbols.unknowns
        held = [p for p in symbols.values() if depends_on(scalar, (p,))]
        return substituted((scalar,), {p: quantities.reactions.unknown(p.name) for p in held})[0] if held else scalar

    def simple(self, scalar: Scalar) -> Scalar:
        """A scalar in its most readable form; as it came where multiplying out made it longer still."""
        known = self._legible
        if scalar not in known:
            found = legible(scalar, WORK, self.positive, LONG)
            known |= {scalar: found, found: found}
        return known[scalar]

    @cached_property
    def _legible(self) -> dict[Scalar, Scalar]:
        """What was made readable once: also that it is, or could not be."""
        return {}

    # -- at an instant ---------------------------------------------------------------------------

    def number(self, formula: Expression, numbers: Mapping[Node, float]) -> float:
        """The formula at a state in floating point, accelerations and reactions found there.

        Args:
            numbers: of t, q, u and the parameters.
        """
        inputs = self.system.symbols.inputs
        values = dict(numbers)
        for name, node in inputs.items():
            values[node] = evaluate((self.system.inputs[name],), values, FLOAT)[0]
        closed = (self.eliminated(self.raw(formula)),)
        found = evaluate(closed, values, FLOAT)[0]
        if math.isfinite(found) and self._agrees(found, closed, values):
            return found
        scalar = self._solved_at(formula, exact_numbers(numbers), readable=False)  # a pivot vanishes there
        try:
            return float(evaluate((scalar,), {x: precise(value) for x, value in values.items()}, fifty_digits())[0])
        except (NoValue, ZeroDivisionError):
            return evaluate((scalar,), values, FLOAT)[0]

    def _agrees(self, found: float, closed: tuple[Scalar], values: Mapping[Node, float]) -> bool:
        """Whether a form that divides by what may vanish there has the same value with 50 digits."""
        if not self.system.ties.closing:
            return True
        try:
            sharp = evaluate(closed, {x: precise(value) for x, value in values.items()}, fifty_digits())[0]
        except (NoValue, ZeroDivisionError):
            return False
        return math.isclose(found, float(sharp), rel_tol=SAME, abs_tol=SAME)

    def at(self, formula: Expression, state: State) -> Scalar:
        """The formula at a state that is given exactly, in the parameters alone.

        Args:
            state: exact scalars of t, q and u; of those that are missing the formula may hold none.
        Raises:
            MissingValues: it holds one; the names tell which.
        """
        return self.simple(self._solved_at(formula, state))

    def _solved_at(self, formula: Expression, state: State, *, readable: bool = True) -> Scalar:
        """The formula at a state, the equations of motion solved anew there.

        Args:
            readable: whether it is to be read; a number is found sooner from what is not.
        """
        state = self.complete(state, formula, readable=readable)
        quantities = Quantities(self.system, state)
        scalar = formula.evaluate(self.system.scope.names, quantities.value)
        (scalar,) = substituted((scalar,), state)
        (scalar,) = substituted((self._known(scalar, quantities),), state)
        symbols = self.system.symbols
        left = [x.name for x in (symbols.t, *symbols.q, *symbols.u, *symbols.a, *symbols.lam)
                if depends_on(scalar, (x,))]  # fmt: skip
        if left:
            raise MissingValues(tuple(left))
        return scalar

    def complete(self, state: State, formula: Expression | None = None, *, readable: bool = True) -> State:
        """The state with accelerations, multipliers and inputs, as far as they are needed and determined."""
        inputs = {node: self.system.inputs[name] for name, node in self.system.symbols.inputs.items()}
        state = {**state, **dict(zip(inputs, substituted(tuple(inputs.values()), state), strict=True))}
        if in_loads(self.model):
            return {**state, **still(self.system)}
        if formula is not None and not self.needs_equations(formula):
            return state
        return {**state, **self._unknowns_at(state, readable)}

    def method_for(self, formula: Expression) -> str:
        """What eliminates reactions and accelerations from the formula, or what it asks; "" for positions and rates."""
        unknown = not formula.names.isdisjoint(self.system.symbols.unknowns)
        if unknown or any(call.name in ASKING_REACTIONS for call in formula.calls):
            return "balance of the bodies"
        if self.needs_equations(formula):
            return "equations of motion"
        return "distribution of mass" if any(call.name in OF_MASSES for call in formula.calls) else ""

    def needs_equations(self, formula: Expression) -> bool:
        """Whether accelerations, multipliers or reactions stand in the formula."""
        if any(call.name in ASKING_REACTIONS for call in formula.calls):
            return True
        return depends_on(self.raw(formula), (*self.system.symbols.a, *self.system.symbols.lam))

    def _unknowns_at(self, state: State, readable: bool) -> dict[Node, Scalar]:
        """Accelerations and multipliers at a state: the equations solved there."""
        symbols, assembly = self.system.symbols, self.assembly
        if assembly.friction:
            values = substituted(tuple(self.unknowns.values()), state)
            return dict(zip(self.unknowns, (self.simple(x) if readable else x for x in values), strict=True))
        kept = regular_rows(self.system)
        rows, right = bordered_rows(assembly, kept)
        entries = substituted([x for row in rows for x in row.values()], state)
        needed = substituted(right, state)
        if readable:
            entries, needed = (readable_all(x, WORK, self.positive) for x in (entries, needed))
        flat = iter(entries)
        rows = [{j: next(flat) for j in row} for row in rows]
        solution = linear.solved(rows, needed, len(right), values_at_a_state(self.system, entries))
        names = (*symbols.a, *(symbols.lam[m] for m in kept))
        missing = [x for x in (symbols.t, *symbols.q, *symbols.u) if x not in state]  # what holds one is no answer
        found = {names[j]: x for j, x in solution.constants.items() if solution.determined(j)}
        return {name: self.simple(x) if readable and not depends_on(x, missing) else x for name, x in found.items()}


def situation_of(model: Model, modes: Modes | None = None) -> Situation:
    """The equations of a model in one configuration of its contacts."""
    return Situation(system_of(model, modes))


def accelerations_and_multipliers(system: System, assembly: Assembly) -> dict[Node, Scalar]:
    """a and lam of M a = forcing + J^T lam, J a + gamma = 0, as expressions; redundant rows are left out, their lam 0.

    a = X F + X J^T lam,  (J X J^T) lam = -(gamma + J X F),  X = M^-1, never formed: M is solved for each column.

    Raises:
        DerivationError: the mass matrix is singular whatever the state.
    """
    symbols = system.symbols
    if assembly.friction and assembly.accelerations is not None:
        found = dict(zip(symbols.a, assembly.accelerations, strict=True))
        return found | _multipliers(system, assembly, found)
    if not assembly.J:
        return dict(zip(symbols.a, solved(assembly.M, assembly.forcing), strict=True))
    kept = regular_rows(system)
    if len(symbols.a) + len(kept) <= cramer.LARGEST_BLOCK:
        return by_determinants(assembly, kept)
    if len(symbols.a) - len(kept) <= FEW:
        with suppress(DerivationError):
            return by_independent(system, assembly, kept)
    J = [assembly.J[i] for i in kept]
    M, forcing = _measured(assembly, kept) if _some_massless(assembly) else (assembly.M, assembly.forcing)
    free = solved(M, forcing)
    columns = [solved(M, row) for row in J]
    S = [[inner(row, column) for column in columns] for row in J]
    lam = solved(S, [-(assembly.gamma[i] + inner(row, free)) for i, row in zip(kept, J, strict=True)])
    a = tuple(a + inner(lam, [column[k] for column in columns]) for k, a in enumerate(free))
    multipliers = {symbols.lam[i]: value for i, value in zip(kept, lam, strict=True)}
    return dict(zip(symbols.a, a, strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}


def _some_massless(assembly: Assembly) -> bool:
    """Whether ties alone say what some acceleration is."""
    return any(is_zero(row[k]) for k, row in enumerate(assembly.M))


def _measured(assembly: Assembly, kept: Sequence[int]) -> tuple[Sequence[Row], Row]:
    """M + J^T J and F - J^T gamma, with the same a and lam as J a = -gamma, and regular where the ties make M so."""
    J, n = [assembly.J[i] for i in kept], range(len(assembly.M))
    gamma = [assembly.gamma[i] for i in kept]
    columns = [[row[k] for row in J] for k in n]
    M = [tuple(assembly.M[i][j] + inner(columns[i], columns[j]) for j in n) for i in n]
    return M, tuple(assembly.forcing[k] - inner(columns[k], gamma) for k in n)


def _multipliers(system: System, assembly: Assembly, a: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """lam of J^T lam = M a - forcing with the accelerations known."""
    if not assembly.J:
        return {}
    kept = regular_rows(system)
    n = len(assembly.M)
    if n + len(kept) <= cramer.LARGEST_BLOCK:  # what divides by a pivot of J has no value where that vanishes
        found = by_determinants(assembly, kept)
        return {x: found[x] for x in system.symbols.lam}
    rows = [{k: assembly.J[m][i] for k, m in enumerate(kept)} for i in range(n)]
    right = [inner(assembly.M[i], list(a.values())) - assembly.forcing[i] for i in range(n)]
    entries = [x for row in rows for x in row.values()]
    solution = linear.solved(rows, right, len(kept), values_at_a_state(system, entries))
    found = {system.symbols.lam[m]: solution.constants[k] for k, m in enumerate(kept)}
    return {x: found.get(x, 0) for x in system.symbols.lam}


def exact_numbers(values: Mapping[Node, float]) -> dict[Node, Scalar]:
    """Doubles as the exact numbers that they are."""
    return {node: Fraction(value) for node, value in values.items() if value == value}


def start_of(situation: Situation, *, at_rest: bool) -> dict[Node, Scalar]:
    """The start as exact scalars of the parameters: t, coordinates that are not sought by the ties, and speeds.

    Args:
        at_rest: all speeds are 0, whatever the model says.
    """
    scope, model = situation.system.scope, situation.model
    sought = set(fixed_by_position(situation.system))
    start: dict[Node, Scalar] = {scope.symbols.t: 0}
    for q in scope.symbols.q:
        if q not in sought:
            start[q] = start_value(scope, model.coordinates[q.name])
    start = with_unit_quaternions(scope, start)
    speeds = dict.fromkeys(scope.symbols.u, 0) if at_rest else start_speeds(situation.system)
    return start | dict(zip(scope.symbols.u, substituted(tuple(speeds.values()), start), strict=True))
