"""Model -> Case: everything that equations of somebody are held against, made once for all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import Any

from eomgen.errors import DerivationError, ExpressionError, MissingValues, ModelError
from eomgen.frozen import dataclass
from eomgen.judge.decision import Follows, combination, is_zero_everywhere, linear_row, vanish_at
from eomgen.judge.mistakes import Mistakes, ModelEdit, edited_models
from eomgen.judge.reading import DERIVED, MULTIPLIER, HandEquation, Reading, side_value
from eomgen.judge.terms import Edits
from eomgen.mechanics.dynamics import Contributions, Extent, System
from eomgen.mechanics.impacts import ImpactEquations
from eomgen.mechanics.instant import Quantities
from eomgen.model import AtRest, Model, Output, Table, WrittenEquation
from eomgen.questions import Answer, solve
from eomgen.results import impact
from eomgen.study import MotionFromStart, Study, study_of
from eomgen.symbolic.expression import (
    SLOPE,
    Call,
    Expression,
    Node,
    Reference,
    Scalar,
    ScalarRow,
    depends_on,
    derivative,
    gradient,
    is_zero,
    parse,
    substituted,
)
from eomgen.symbolic.print import to_text


@dataclass(frozen=True)
class Case:
    """A model whose equations are judged.

    Args:
        model: the model.
        at_rest: its motion starts with all speeds 0.
        begun: contacts slide as they do just after the start: the sign of what slides is a number.
        side: "after": equations about an instant are about what is just after it, where a quantity jumps.
    """

    model: Model
    at_rest: bool = False
    begun: bool = False
    side: str | None = None

    @cached_property
    def phase(self) -> Study:
        """The equations as `derive` gives them; of a motion that has begun those of its first phase."""
        if self._as_at_start:
            return study_of(self.model)
        return MotionFromStart(self.model, self.at_rest).phase

    @property
    def _as_at_start(self) -> bool:
        """True if contacts, which may change, are taken as they are before anything moves."""
        return not self.begun and bool(self.model.coordinates) and self.model.has_phases

    @property
    def system(self) -> System:
        return self.phase.system

    @property
    def start(self) -> Mapping[Node, Scalar]:
        """t, q and u at the start as scalars of the parameters, numbers without a closed form; {}: it is not known."""
        return self.phase.start_of(at_rest=self.at_rest).values

    @property
    def starts_exactly(self) -> bool:
        """True if the start has a closed form."""
        return self.phase.start_of(at_rest=self.at_rest).is_exact

    def starts_at_zero(self, *scalars: Scalar) -> bool | None:
        """True if scalars are 0 at the start, in numbers where it has no closed form; None: the start is not known."""
        if not self.start:
            return None
        if self.starts_exactly:
            return is_zero_everywhere(self.system, *substituted(scalars, self.start)).holds
        numbers = self.phase.start_of(at_rest=self.at_rest).numbers
        return vanish_at(scalars, {**self.system.scope.known_parameters, **numbers})

    def begins_otherwise(self, scalar: Scalar) -> bool:
        """True if a scalar of positions and speeds is not 0 at the start in numbers, which are sooner there."""
        with suppress(DerivationError, MissingValues, ModelError):
            numbers = self.phase.start_of(at_rest=self.at_rest).numbers
            return vanish_at((scalar,), {**self.system.scope.known_parameters, **numbers}) is False
        return False

    def put_into_rate(
        self, name: str, x: Scalar, values: Mapping[Node, Scalar]
    ) -> tuple[dict[Node, Scalar], Scalar, Scalar, bool]:
        """A state, or its rate, as a function x of time: (what is known, what is left, what is 0 at the start, alone).

        The state is put into its rate, the rate into the derivative of that; not alone: what else moves is left.

        Args:
            name: of the state, with a prime of its rate.
            values: of parameters, put in too.
        """
        symbols, scope = self.system.symbols, self.system.scope
        z = scope.names[name.removesuffix("'")]
        assert type(z) is Node, "a state is a symbol"
        inputs = {node: self.system.inputs[n] for n, node in symbols.inputs.items()}
        (rate,) = substituted((scope.names[f"{z.name}'"],), inputs)
        known: dict[Node, Scalar] = {}
        if name.endswith("'"):
            given, left = rate - x, derivative(rate, z) * x + derivative(rate, symbols.t) - derivative(x, symbols.t)
        else:
            given, left, known = z - x, rate - derivative(x, symbols.t), {z: x}
        (left,) = substituted((left,), {**known, **values})
        (given,) = substituted(substituted((given,), self.start), values) if values else (given,)
        others = [other for other in (*symbols.x, *self.forced) if other is not z]
        return known, left, given, not depends_on(rate, others) and not depends_on(left, (z,))

    @cached_property
    def as_begun(self) -> Case | None:
        """The same just after the start; None where nothing begins there."""
        return replace(self, begun=True) if self._as_at_start else None

    @cached_property
    def loosened(self) -> Case | None:
        """The model with what is driven or dependent as free as the rest, so that its rates stand by their names.

        None where nothing is.
        """
        coordinates = self.model.coordinates
        if not any(q.driven or q.dependent for q in coordinates.values()):
            return None
        with suppress(ModelError):
            scope = self.system.scope
            free = {
                name: replace(scope.let_go(name) if q.driven else q, dependent=False) for name, q in coordinates.items()
            }
            return Case(replace(self.model.requesting({}), coordinates=Table(free)), self.at_rest)
        return None

    @property
    def steady(self) -> frozenset[str]:
        """The accelerations of driven coordinates that are 0."""
        names = self.system.scope.names
        return frozenset(f"{q}''" for q, x in self.model.coordinates.items() if x.driven and is_zero(names[f"{q}''"]))

    @property
    def laws_of_time(self) -> dict[Node, Scalar]:
        """The function of time of each coordinate that is driven by one."""
        scope, coordinates = self.system.scope, self.model.coordinates
        motions = {q: coordinates[q.name].motion for q in self.system.symbols.q}
        return {q: scope.value(law) for q, law in motions.items() if law is not None}

    @property
    def constrained_rates(self) -> tuple[ScalarRow, ScalarRow]:
        """J u + sigma and J a + gamma of every constraint."""
        constraints, symbols = self.system.constraints, self.system.symbols
        found = []
        for unknowns, bias in ((symbols.u, constraints.sigma), (symbols.a, constraints.gamma)):
            rows = (sum((x * y for x, y in zip(J, unknowns, strict=True)), start=0) for J in constraints.J)
            found.append(tuple(x + b for x, b in zip(rows, bias, strict=True)))
        return found[0], found[1]

    @cached_property
    def reading(self) -> Reading:
        return Reading(self.system)

    @property
    def quantities(self) -> Quantities:
        return self.phase.quantities

    def dimension(self, name: str) -> str:
        """Dimension of a declared name, as far as it follows from the model; "" else."""
        return str(self.edits.dimensions.get(name, ""))

    @property
    def rests(self) -> bool:
        """True if an equilibrium is found."""
        with suppress(DerivationError, MissingValues):
            return bool(self.phase.equilibria.found)
        return False

    @property
    def places_of_rest(self) -> tuple[Mapping[Node, Scalar], ...]:
        """The equilibria that have a closed form."""
        return self._at_equilibria(self.system.symbols.q)

    @property
    def multipliers_at_rest(self) -> tuple[Mapping[Node, Scalar], ...]:
        """The multipliers at each of these equilibria, those that are determined."""
        return self._at_equilibria(self.system.symbols.lam)

    def _at_equilibria(self, symbols: tuple[Node, ...]) -> tuple[Mapping[Node, Scalar], ...]:
        named = {x.name: x for x in symbols}
        found = [place.exact for place in self.phase.equilibria.found if place.is_exact] if self.rests else []
        return tuple(
            {named[x.name]: self.own(value) for x, value in place.items() if x.name in named} for place in found
        )

    def own(self, x: Scalar) -> Scalar:
        """A scalar of another system of the model over the symbols of this one."""
        if type(x) is not Node or x.graph is self.system.scope.graph:
            return x
        text = to_text(x)
        return parse(text, longest=len(text) + 1, tables=self.model.functions).evaluate(self.system.scope.names)

    @cached_property
    def parts(self) -> Contributions:
        """Contributions of which the equations of motion are the sum; without these where the model has none."""
        with suppress(DerivationError, ModelError):
            return Contributions(self.system, self.phase.equations if self.system.symbols.u else None)
        return Contributions(self.system)

    @property
    def edits(self) -> Edits:
        """The mistakes that are looked for in formulas of the model."""
        return Edits.of_system(self.system)

    @cached_property
    def edited(self) -> tuple[ModelEdit, ...]:
        """The models of which somebody may have thought, each with one change of the file."""
        return edited_models(self.model, self.parts)

    @cached_property
    def _found(self) -> dict[Any, Any]:
        """Mistakes by what they are in, answers by what is requested: each found once."""
        return {}

    def mistakes(self, what: str, of: tuple[str, ...] = (), start: Mapping[Node, Scalar] | None = None) -> Mistakes:
        """Possible mistakes in equations, energies or forces, found once for all equations that are judged."""
        found = Mistakes(self.parts, what, of, start or {})
        kept: Mistakes = self._found.setdefault((what, of), found)
        return kept

    def impact(self, contacts: tuple[str, ...]) -> ImpactEquations:
        """The impact where contacts close, derived once.

        Raises:
            DerivationError: it has no equations.
        """
        if (ImpactEquations, contacts) not in self._found:
            self._found[ImpactEquations, contacts] = impact(self.model, contacts).equations
        found: ImpactEquations = self._found[ImpactEquations, contacts]
        return found

    @property
    def rows(self) -> ScalarRow:
        """E = M a + c - Q - J^T lam, one for each speed."""
        return () if self.parts.equations is None else self.parts.equations.residual[0]

    @property
    def closing(self) -> ScalarRow:
        """J a + gamma, one for each constraint row."""
        return () if self.parts.equations is None else self.parts.equations.residual[1]

    @cached_property
    def gained(self) -> Scalar | None:
        """T + V less what they are at the start, work of constant forces counted as a potential; None: it changes."""
        parts = self.parts.elementary
        if not self.start or any(part.Q or part.row is not None for part in parts):
            return None
        energy = sum((self.parts.operator.energy(part.T) + part.V for part in parts), start=0)
        gained: Scalar = energy - substituted((energy,), self.start)[0]
        with suppress(DerivationError):
            return gained if self.follows(self.system.scope.with_accelerations((gained,))[0]).holds else None
        return None

    # -- values of formulas -------------------------------------------------------------------

    def value(self, expression: Expression, also: Mapping[str, Scalar] | None = None) -> Scalar:
        """An expression over the symbols; accelerations and multipliers stay as they are.

        Args:
            also: what further names stand for; they win.
        Raises:
            ExpressionError: an unknown name or function.
        """
        return self.evaluated(expression, {**self.names, **(also or {})}, self.called)

    @cached_property
    def names(self) -> Mapping[str, Scalar]:
        """Values of names; a parameter that stands nowhere in the model and is a formula of others is that formula."""
        leaves = (leaf for leaf in self.model.leaves(()) if leaf.path[0] not in ("parameters", "outputs"))
        used = {name for leaf in leaves if isinstance(leaf.value, Expression) for name in leaf.value.names}
        return {**self.system.scope.names, **{x.name: y for x, y in self.definitions.items() if x.name not in used}}

    @property
    def definitions(self) -> dict[Node, Scalar]:
        """Each parameter that the file gives by a formula, in terms of those that it gives by numbers."""
        scope, parts = self.system.scope, self.model.parameters
        formulas = {name: formula for name, part in parts.items() if (formula := part.formula)}
        known = {scope.symbols.parameters[name]: scope.value(formula) for name, formula in formulas.items()}
        for _ in known:  # formulas of formulas
            known = dict(zip(known, substituted(tuple(known.values()), known), strict=True))
        return known

    def meant_by_numbers(self, written: HandEquation, scalars: ScalarRow) -> dict[Node, Scalar]:
        """Values of parameters in scalars that an equation does not name; {}: none of its numbers is one of these."""
        missing = self._values_in(scalars, {n: x for n, x in self._values.items() if n not in written.names})
        numbers = {abs(what) for side in (written.left, written.right) for kind, what in side.code if kind == "number"}
        return missing if numbers & {abs(x) for x in missing.values() if x not in (0, 1, -1)} else {}

    def meant_as_a_whole(self, written: HandEquation, scalars: ScalarRow) -> dict[Node, Scalar]:
        """Values of all parameters in scalars, the first that of an equation which speaks in numbers; {}: it does not.

        A term without any name, the 2 of m r^2 phi' = 2, has its unit by the file alone; so has every number of an
        equation that names no parameter, phi'' + 4.905 sin(phi) = 0: there a 1 is not put in, which nobody sees.
        """
        terms = scalars[0].args if type(scalars[0]) is Node and scalars[0].op == "add" else ()
        if any(type(x) is not Node for x in terms):
            return self._values_in(scalars, self._values)
        named = self.system.symbols.parameters.keys() & written.names
        return {} if named else self._values_in(scalars, {n: x for n, x in self._values.items() if x not in (1, -1)})

    @property
    def _values(self) -> dict[str, Any]:
        """Exact values of the parameters, by name; those in doubles left out."""
        return {name: x for name, x in self.model.exact_parameters().items() if not isinstance(x, float)}

    def _values_in(self, scalars: ScalarRow, values: Mapping[str, Any]) -> dict[Node, Scalar]:
        """Values of the parameters that stand in scalars."""
        parameters = self.system.symbols.parameters
        return {
            x: values[n] for n, x in parameters.items() if n in values and any(depends_on(y, (x,)) for y in scalars)
        }

    def evaluated(
        self, expression: Expression, names: Mapping[str, Scalar], called: Callable[[Call], Scalar]
    ) -> Scalar:
        """The same, functions of the motion as they are given."""
        return side_value(expression, names, called, lambda x: self.system.scope.with_accelerations((x,))[0])

    def called(self, call: Call) -> Scalar:
        """A function of the outputs, or a multiplier by its name: lam(constraint, 1)."""
        if call.name == MULTIPLIER and (multiplier := self._multiplier(call)) is not None:
            return multiplier
        if call.name == SLOPE:
            return self._slope(call)
        if call.name == DERIVED:
            return self._derived(call)
        try:
            found = self.quantities.value(call)
        except (DerivationError, ModelError, KeyError, StopIteration, ValueError, IndexError, AssertionError) as error:
            what = (
                error.what
                if isinstance(error, (DerivationError, ModelError))
                else f"'{call}' names nothing of the model"
            )
            raise ExpressionError(what, max(call.column, 0), getattr(error, "fix", ""), len(call.name)) from error
        return self.solved(found)

    def solved(self, x: Scalar) -> Scalar:
        """The scalar with the values of the unknowns of the model.

        Raises:
            DerivationError: the balance does not fix one.
        """
        held = [p for p in self.system.symbols.unknowns.values() if depends_on(x, (p,))]
        known = {p: self.quantities.reactions.unknown(p.name) for p in held}
        return substituted((x,), known)[0] if held else x

    def _derived(self, call: Call) -> Scalar:
        """A quantity that derivations name; with every coordinate free where that is meant."""
        name, *free = call.args
        assert isinstance(name, Reference)
        quantity = self.reading.derived.quantities.get(name.name)
        if quantity is None or (value := quantity.value) is None:
            raise ExpressionError(
                f"'{name.name}' names nothing of the model", max(call.column, 0), length=len(name.name)
            )
        system = self.system.free if free and self.system.free else self.system
        return self.solved(self.own(value(self.phase, system)))

    def _slope(self, call: Call) -> Scalar:
        """dT/du, or dT/dq as Lagrange's equations have it: N^T dT/dq; of the free system by the speeds of this."""
        energy, by, *free = call.args
        system = self.system.free if free and self.system.free else self.system
        assert isinstance(energy, Expression)
        value, symbols = Quantities(system).of(energy), system.symbols
        names = [u.name for u in symbols.u]
        if str(by) not in names and f"{by}'" not in names:
            what = f"'{by}' is neither a coordinate that is free nor its rate"
            raise ExpressionError(what, max(call.column, 0), length=len(str(call)))
        if str(by) in names:
            slope = derivative(value, symbols.u[names.index(str(by))])
        else:
            slope = system.motion.scope.per_speed(gradient(value, symbols.q))[names.index(f"{by}'")]
        if system is self.system:
            return self.solved(slope)
        return substituted((slope,), dict(zip(symbols.u, self.system.free_rates(system), strict=True)))[0]

    def _multiplier(self, call: Call) -> Scalar | None:
        label = f"{MULTIPLIER}({', '.join(a.name if isinstance(a, Reference) else a.text for a in call.args)})"
        return next((x for x in self.system.symbols.lam if x.name == label), None)

    def unknown_names(self, written: HandEquation) -> list[str]:
        """The names that the model does not have, without primes, in alphabetical order."""
        known = self.system.scope.names
        return sorted({name.rstrip("'") for name in written.names if name not in known and name not in ("t", "pi")})

    # -- what follows from what --------------------------------------------------------------------

    @property
    def forced(self) -> tuple[Node, ...]:
        """Accelerations and multipliers, in which equations of motion are linear."""
        return (*self.system.symbols.a, *self.system.symbols.lam)

    def leading(self, row: Scalar, absent: ScalarRow = ()) -> Node | None:
        """The first acceleration or multiplier that a row really holds: its coefficient is not 0 everywhere.

        Args:
            absent: rows that do not hold it; None: there is none.
        """
        for x in self.forced:
            held = depends_on(row, (x,)) and not is_zero_everywhere(self.system, derivative(row, x)).holds
            if held and is_zero_everywhere(self.system, *(derivative(each, x) for each in absent)).holds:
                return x
        return None

    def follows(self, scalar: Scalar, rows: ScalarRow | None = None, *, within: bool = False) -> Follows:
        """True if a scalar vanishes by the equations of motion and the constraints.

        Args:
            rows: equations in place of the model's own.
            within: where it is not in every piece, the pieces in which it is are sought.
        """
        row, linear = linear_row(scalar, self.forced)
        if not linear:
            return is_zero_everywhere(self.system, self.phase.eliminated(scalar)) if rows is None else Follows(None)
        own, closing = self._linear
        mine = own if rows is None else [linear_row(x, self.forced)[0] for x in rows]
        return combination(self.system, row, mine, closing, within=within)

    @cached_property
    def _linear(self) -> tuple[list[ScalarRow], list[ScalarRow]]:
        """Slopes and rests of the equations of motion, and of the constraint rows."""
        rows, closing = ([linear_row(x, self.forced)[0] for x in some] for some in (self.rows, self.closing))
        return rows, closing

    @property
    def speeds(self) -> tuple[dict[Node, Scalar], Extent] | None:
        """(every speed as a function of the coordinates, where that holds), by the first integrals; None: by none."""
        if self.parts.equations is None or not self.start:
            return None
        try:
            return self.phase.rates(at_rest=self.at_rest)
        except (DerivationError, MissingValues, ModelError):
            return None

    @property
    def by_momenta(self) -> tuple[dict[Node, Scalar], Extent] | None:
        """(the speeds that the momenta from the start and the constraints give by one of them, where); None: none."""
        if self.parts.equations is None or not self.start:
            return None
        with suppress(DerivationError, MissingValues, ModelError):
            return self.phase.rates_by_one(at_rest=self.at_rest)
        return None

    # -- what the solver of outputs answers --------------------------------------------------------

    def sides(self, written: HandEquation, at: WrittenEquation | AtRest | None) -> tuple[Answer, Answer]:
        """Both sides as outputs: at an instant, at rest, of small motions, of one configuration.

        Raises:
            ExpressionError: a side has no meaning, or no dimension.
        """
        from_ = "rest" if self.at_rest and isinstance(at, WrittenEquation) else None
        requested = {
            name: Output(value=value, at=at, from_=from_, side=self.side if isinstance(at, WrittenEquation) else None)
            for name, value in (("left", written.left), ("right", written.right))
        }
        found = solve(_asking(self.model, requested))
        return found["left"], found["right"]

    def answer(self, output: Output) -> Answer:
        """The answer to an output, found once."""
        key = f"{output.value.text} at {output.at} from {output.from_} {output.side} {output.event} {output.unit}"
        if key not in self._found:
            self._found[key] = solve(_asking(self.model, {"asked": output}))["asked"]
        answer: Answer = self._found[key]
        return answer

    def exact(self, answer: Answer) -> Scalar | None:
        """The exact value of an answer over the symbols; None where it has none."""
        if answer.exact is None:
            return None
        try:
            read = parse(answer.exact, longest=len(answer.exact) + 1, tables=self.model.functions)
            return read.evaluate(self.system.scope.names)
        except ExpressionError:
            return None

    def check(self, written: HandEquation) -> None:
        """Refuses functions that ask for what the model does not have.

        Raises:
            ExpressionError: one does.
        """
        for call in (call for call in written.calls if call.name not in (MULTIPLIER, SLOPE, DERIVED)):
            value = Expression(str(call), (("call", call),), (max(call.column, 0),))
            _asking(self.model, {"asked": Output(value=value)})

    def clash(self, written: HandEquation) -> str:
        """The error in the dimensions, in words; "" where there is none."""
        names = self.model.dimensions.names
        left, right = (replace(names.walk(), strict=True) for _ in range(2))
        needed = left.of(written.left)
        right.of(written.right, needed=needed)
        return next((clash.what for clash in (*left.clashes, *right.clashes)), "")


def _asking(model: Model, outputs: Mapping[str, Output]) -> Model:
    """The model with these outputs alone, checked as a whole."""
    try:
        return model.requesting(outputs)
    except ModelError as error:
        raise ExpressionError(error.what.partition(" in the ")[0], 0, error.fix) from error
