"""Model -> Case: everything that equations of somebody are held against, made once for all of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from eomgen.documents.equation_steps import multiplier_forces
from eomgen.errors import DerivationError, ExpressionError, MissingValues, ModelError
from eomgen.judge.contributions import Parts
from eomgen.judge.decision import Combination, combination, linear_row, vanishes
from eomgen.judge.reading import Reading, Written
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.first_integrals.speeds import rates_of
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.model.fields import AtRest, WrittenEquation
from eomgen.model.parts import Model, Output
from eomgen.model.table import Table
from eomgen.questions import answers
from eomgen.questions.answers import Answer
from eomgen.questions.in_phase import PhaseEquations
from eomgen.questions.motion_from_start import MotionFromStart
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.expressions import Call, Expression
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import ScalarRow


@dataclass(frozen=True)
class Case:
    """A model whose equations are judged.

    Args:
        model: the model.
        at_rest: its motion starts with all speeds 0.
    """

    model: Model
    at_rest: bool = False

    @cached_property
    def motion(self) -> MotionFromStart:
        return MotionFromStart(self.model, self.at_rest)

    @property
    def phase(self) -> PhaseEquations:
        return self.motion.phase

    @property
    def system(self) -> System:
        return self.phase.system

    @cached_property
    def reading(self) -> Reading:
        return Reading(self.system)

    @cached_property
    def quantities(self) -> Quantities:
        return Quantities(self.system)

    @cached_property
    def equations(self) -> EquationsOfMotion | None:
        """The equations of motion; None where the model has none."""
        try:
            return self.phase.equations if self.system.symbols.u else None
        except (DerivationError, ModelError):
            return None

    @cached_property
    def parts(self) -> Parts:
        return Parts(self.system, self.equations)

    @cached_property
    def rows(self) -> ScalarRow:
        """E = M a + c - Q - J^T lam, one for each speed."""
        e = self.equations
        if e is None:
            return ()
        forces = multiplier_forces(e)
        return tuple(
            sum((m * a for m, a in zip(row, e.symbols.a, strict=True)), start=0) - right - force
            for row, right, force in zip(e.M, e.forcing, forces, strict=True)
        )

    @cached_property
    def closing(self) -> ScalarRow:
        """J a + gamma, one for each closing row."""
        e = self.equations
        if e is None:
            return ()
        return tuple(
            sum((j * a for j, a in zip(row, e.symbols.a, strict=True)), start=gamma)
            for row, gamma in zip(e.J, e.gamma, strict=True)
        )

    # -- what formulas are worth -------------------------------------------------------------------

    def value(self, expression: Expression, also: Mapping[str, Scalar] | None = None) -> Scalar:
        """An expression over the symbols; accelerations and multipliers stay as they are.

        Args:
            also: what further names stand for; they win.
        Raises:
            ExpressionError: an unknown name or function.
        """
        return expression.evaluate({**self.system.scope.names, **(also or {})}, self._called)

    def _called(self, call: Call) -> Scalar:
        try:
            found = self.quantities.value(call)
        except (DerivationError, ModelError, KeyError, StopIteration, ValueError, IndexError, AssertionError) as error:
            what = error.what if isinstance(error, (DerivationError, ModelError)) else f"'{call}' names nothing of the model"
            raise ExpressionError(what, max(call.column, 0), getattr(error, "mend", ""), len(call.name)) from error
        symbols = self.system.symbols.unknowns
        held = [p for p in symbols.values() if depends_on(found, (p,))]
        known = {p: self.quantities.reactions.unknown(p.name) for p in held}
        return substituted((found,), known)[0] if held else found

    def unknown_names(self, written: Written) -> list[str]:
        """The names that the model does not have, without primes, in alphabetical order."""
        known = self.system.scope.names
        return sorted({name.rstrip("'") for name in written.names if name not in known and name not in ("t", "pi")})

    # -- what follows from what --------------------------------------------------------------------

    @property
    def forced(self) -> tuple[Node, ...]:
        """Accelerations and multipliers, in which equations of motion are linear."""
        return (*self.system.symbols.a, *self.system.symbols.lam)

    def follows(self, scalar: Scalar, rows: ScalarRow | None = None) -> Combination:
        """Whether a scalar vanishes by the equations of motion and the ties.

        Args:
            rows: equations in place of the model's own.
        """
        row, linear = linear_row(scalar, self.forced)
        if not linear:
            return vanishes(self.system, self.phase.eliminated(scalar)) if rows is None else Combination(None)
        own = self.rows if rows is None else rows
        return combination(self.system, row, [linear_row(x, self.forced)[0] for x in (*own, *self.closing)])

    @cached_property
    def speeds(self) -> dict[Node, Scalar] | None:
        """Every speed as a function of the coordinates, by the first integrals from the start; None: they do not."""
        if self.equations is None or not self.motion.start:
            return None
        try:
            return rates_of(self.equations, self.motion.start, accelerations=self.phase.accelerations)
        except (DerivationError, MissingValues, ModelError):
            return None

    # -- what the solver of outputs answers --------------------------------------------------------

    def answer(self, value: Expression, at: WrittenEquation | AtRest | None, model: Model | None = None) -> Answer:
        """An expression as an output: at an instant, at rest, of small motions, of one configuration.

        Raises:
            ExpressionError: the expression is wrong.
        """
        from_ = "rest" if self.at_rest and isinstance(at, WrittenEquation) else None
        output = Output(value=value, at=at, from_=from_)
        model = model or self.model
        return answers.solve(_asking(model, output))["judged"]

    def check(self, written: Written) -> None:
        """Refuses functions that ask for what the model does not have.

        Raises:
            ExpressionError: one does.
        """
        if written.calls:
            _asking(self.model, Output(value=written.difference))


def _asking(model: Model, output: Output) -> Model:
    """The model with one output alone, checked as a whole."""
    try:
        return replace(model, outputs=Table({"judged": output}))
    except ModelError as error:
        raise ExpressionError(error.what.partition(" in the ")[0], 0, error.mend) from error
