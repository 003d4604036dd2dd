"""Equations -> Simulator: one motion after another, from other values and starts; derived and compiled once."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property

from eomgen.codegen.rhs import parameter_vector
from eomgen.equations import Equations
from eomgen.errors import ExpressionError, UsageError
from eomgen.model.fields import WrittenEquation
from eomgen.model.findings import nearest
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.outputs.base import BALANCE
from eomgen.model.parts import Model
from eomgen.model.replaced import Values, with_values
from eomgen.proof.kept_ties import rows_that_stay
from eomgen.questions.of_a_run import asked_of
from eomgen.questions.run import phase_models, run
from eomgen.records import dataclass
from eomgen.simulation.configuration import has_phases
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.output_columns import formulas_of
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.expression.expressions import Expression, single_call

SAMPLES = 101
MOST_KEPT = 16  # models whose ties or contacts were derived at other values of the parameters
REACTIONS, OUTPUTS = "reactions", "outputs"


@dataclass(frozen=True)
class Simulator:
    """simulator(time=10) -> Trajectory, again and again.

    A model without ties is derived once for all values of its parameters. Which ties depend on one another, and which
    contacts are closed at the start, depends on the values: with other ones such a model is derived anew.

    Args:
        model: whose values hold where none are given.
        derive: model -> its equations.
        how: the integrator's way; its tolerances are those of the run.
        target: of the emitted code.
        known: what was derived, by the values that it depends on.
    """

    model: Model
    derive: Callable[[Model], Equations] = field(repr=False)
    how: Stepping = Stepping()
    target: str | None = None
    known: OrderedDict[object, tuple[Equations, PhaseModels]] = field(default_factory=OrderedDict, repr=False)

    def __call__(
        self,
        time: float = 10.0,
        parameters: Values | None = None,
        start: Values | None = None,
        samples: int | Sequence[float] = SAMPLES,
        columns: Sequence[str] = (),
        *,
        until: WrittenEquation | str | None = None,
    ) -> Trajectory:
        """The motion from the start values of the model.

        Args:
            time: how long [s].
            parameters, start: values that replace the model's, as `eomgen.simulate` takes them.
            samples: how many instants are given, or the instants themselves.
            columns: what is wanted beside the states: names of reactions, "reactions" for all, names of outputs or
                formulas like them, "outputs" for all of the model.
            until: an equation: the end, where it first holds.
        Raises:
            MissingValues: parameters without a value, all named.
            UsageError: what is asked makes no sense.
        """
        valued = with_values(self.model, parameters, start)
        equations, models = self._at(valued.model if self.keeps_start else with_values(self.model, parameters).model)
        own = {name: valued.model.parameters[name].value for name in parameters or {}}
        asked = (columns,) if isinstance(columns, str) else tuple(columns)
        formulas = _formulas(valued.model, asked)
        reactions = any(name not in formulas for name in asked if name != OUTPUTS)
        found = run(
            equations,
            time=time,
            parameters=own,
            start=valued.start,
            samples=samples,
            how=self.how,
            until=until,
            models=models,
            reactions=reactions,
            outputs=None if OUTPUTS in asked and formulas == formulas_of(valued.model) else formulas,
        )
        return found if not reactions or REACTIONS in asked else _with_columns(found, asked, formulas)

    def _at(self, model: Model) -> tuple[Equations, PhaseModels]:
        """The equations, and their phases, at the values of a model."""
        return self._own if model is self.model else self._found(model)

    @cached_property
    def _own(self) -> tuple[Equations, PhaseModels]:
        """Those at the model's own values."""
        return self._found(self.model)

    def _found(self, model: Model) -> tuple[Equations, PhaseModels]:
        known, key = self.known, (model.parameters, model.coordinates, model.speeds)
        if key not in known:
            anew = self.is_tied or self.keeps_start
            equations = self.derive(model) if anew else self.equations
            p = parameter_vector(model)
            if known and not anew:
                models = next(iter(known.values()))[1].at(p)
            else:
                models = phase_models(equations, p, self.how, self.target)
            known[key] = equations, models
            if len(known) > MOST_KEPT:
                known.popitem(last=False)
        return known[key]

    @cached_property
    def equations(self) -> Equations:
        """Those of the model at its own values."""
        return self.derive(self.model)

    @cached_property
    def is_tied(self) -> bool:
        """Whether what is derived depends on values."""
        return has_phases(self.model) or bool(self.equations.graph.system.ties.rows)

    @cached_property
    def keeps_start(self) -> bool:
        """Whether what is derived depends on where the motion starts: contacts, ties and springs that keep a length."""
        elements = (force.element for force in self.model.forces.values())
        if has_phases(self.model) or any(each.slack == "start" for each in elements if each is not None):
            return True
        return bool(rows_that_stay(self.equations.graph.system))


def _formulas(model: Model, asked: tuple[str, ...]) -> dict[str, Expression]:
    """The outputs among what is asked, and formulas that are no lone reaction."""
    found = formulas_of(model) if OUTPUTS in asked else {}
    for name in asked:
        if name in model.outputs:
            found[name] = model.outputs[name].value
        elif name not in (OUTPUTS, REACTIONS) and not _is_reaction(name):
            try:
                found[name] = asked_of(model, name).value
            except UsageError as error:
                raise UsageError(
                    f"no column {error.what}", mend=f"a reaction, an output, a formula, '{REACTIONS}'"
                ) from error
    return found


def _is_reaction(text: str) -> bool:
    """Whether it is a function of the balance alone, which is found by its name among the reactions."""
    try:
        call = single_call(text)
    except ExpressionError:
        return False
    return call is not None and call.name in FUNCTIONS and FUNCTIONS[call.name].source == BALANCE


def _with_columns(found: Trajectory, asked: tuple[str, ...], formulas: Mapping[str, Expression]) -> Trajectory:
    """The run with these reactions alone."""
    names = [name for name in asked if name not in formulas and name != OUTPUTS]
    for name in names:
        if name not in found.reactions:
            raise UsageError(f"no column '{name}'", mend=nearest(name, found.reactions) or f"ask for '{REACTIONS}'")
    return replace(found, reactions={name: found.reactions[name] for name in names})
