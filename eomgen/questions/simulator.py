"""Equations -> Simulator: one motion after another, from other values and starts; derived and compiled once."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property

import numpy as np

from eomgen.codegen.rhs import parameter_vector
from eomgen.equations import Equations
from eomgen.errors import DerivationError, ExpressionError, UsageError
from eomgen.model.fields import WrittenEquation
from eomgen.model.findings import nearest
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.outputs.base import BALANCE
from eomgen.model.part import altered
from eomgen.model.parts import Model
from eomgen.model.replaced import Valued, Values, with_values
from eomgen.proof.kept_ties import rows_that_stay
from eomgen.questions.of_a_run import asked_of
from eomgen.questions.run import phase_models, run
from eomgen.records import dataclass
from eomgen.simulation.configuration import has_phases
from eomgen.simulation.derived_at import DerivedAt
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.output_columns import formulas_of
from eomgen.simulation.phase_change import at_start
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.expression.expressions import Expression, single_call
from eomgen.symbolic.expression.typed import Typed, seconds

SAMPLES = 101
MOST_BASES = 4  # derivations that are looked at whether they hold at other values
MOST_KEPT = 16  # models whose ties or contacts were derived at other values of the parameters
REACTIONS, OUTPUTS = "reactions", "outputs"


@dataclass(frozen=True)
class Simulator:
    """simulator(time=10) -> Trajectory, again and again.

    A model is derived once for all values of its parameters at which the same comes of it (see `DerivedAt`): which ties
    depend on one another may depend on the values, and then it is derived anew.

    Args:
        model: whose values hold where none are given.
        derive: model -> its equations.
        how: the integrator's way; its tolerances are those of the run.
        target: of the emitted code.
        known: what was derived, by the values that it depends on.
        bases: what was derived, and may hold at other values.
    """

    model: Model
    derive: Callable[[Model], Equations] = field(repr=False)
    how: Stepping = Stepping()
    target: str | None = None
    known: OrderedDict[object, tuple[Equations, PhaseModels]] = field(default_factory=OrderedDict, repr=False)
    bases: list[KnownEquations] = field(default_factory=list, repr=False)

    def __call__(
        self,
        time: Typed = 10.0,
        parameters: Values | None = None,
        start: Values | None = None,
        samples: int | Sequence[Typed] = SAMPLES,
        columns: Sequence[str] = (),
        *,
        until: WrittenEquation | str | None = None,
    ) -> Trajectory:
        """The motion from the start values of the model.

        Args:
            time: how long, as `eomgen.simulate` takes it.
            parameters, start: values that replace the model's, as `eomgen.simulate` takes them.
            samples: how many instants are given, or the instants themselves, in SI or with a unit.
            columns: what is wanted beside the states: names of reactions, "reactions" for all, names of outputs or
                formulas like them, "outputs" for all of the model.
            until: an equation: the end, where it first holds.
        Raises:
            MissingValues: parameters without a value, all named.
            UsageError: what is asked makes no sense.
        """
        valued = with_values(self.model, parameters, start)
        equations, models = self._at(valued)
        own = {} if equations.model is valued.model else given_parameters(valued.model)
        asked = (columns,) if isinstance(columns, str) else tuple(columns)
        formulas = _formulas(valued.model, asked)
        reactions = any(name not in formulas for name in asked if name != OUTPUTS)
        found = run(
            equations,
            time=seconds(time),
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

    def prepared(self, parameters: Values, start: Values) -> None:
        """Derives and compiles what a run from these values takes."""
        self._at(with_values(self.model, parameters, start))

    def _at(self, valued: Valued) -> tuple[Equations, PhaseModels]:
        """The equations, and their phases, at the values of a model."""
        if valued.model is self.model:
            return self._own
        if self.keeps_start:
            return self._found(valued)
        return self._found(replace(valued, model=altered(self.model, parameters=valued.model.parameters)))

    @cached_property
    def _own(self) -> tuple[Equations, PhaseModels]:
        """Those at the model's own values."""
        return self._found(Valued(self.model))

    def _found(self, valued: Valued) -> tuple[Equations, PhaseModels]:
        model, known = valued.model, self.known
        key = (model.parameters, model.coordinates, model.speeds)
        if key not in known:
            known[key] = self._shared(valued) or self._derived(model)
            if len(known) > MOST_KEPT:
                known.popitem(last=False)
        return known[key]

    def _shared(self, valued: Valued) -> tuple[Equations, PhaseModels] | None:
        """Equations that were derived at other values, where these are the same; None where there are none."""
        p = parameter_vector(valued.model)
        for base in self.bases:
            models = base.models.at(p)
            if base.holds(models, valued):
                return base.equations, models
        return None

    def _derived(self, model: Model) -> tuple[Equations, PhaseModels]:
        """The equations of a model, derived at its values."""
        anew = self.is_tied or self.keeps_start
        equations = self.derive(model) if anew else self.equations
        models = phase_models(equations, parameter_vector(model), self.how, self.target)
        if len(self.bases) < MOST_BASES:
            self.bases.append(KnownEquations(equations, models, self.keeps_start and self._follows_start))
        return equations, models

    @cached_property
    def _follows_start(self) -> bool:
        """Whether what starts somewhere else has other equations."""
        elements = (force.element for force in self.model.forces.values())
        if any(each.slack == "start" for each in elements if each is not None):
            return True
        return bool(rows_that_stay(self.equations.graph.system))

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
        return has_phases(self.model) or self._follows_start


@dataclass(frozen=True)
class KnownEquations:
    """Equations and phases as they were derived at values of a model.

    Args:
        follows_start: whether what starts somewhere else has other equations.
    """

    equations: Equations
    models: PhaseModels
    follows_start: bool

    def holds(self, models: PhaseModels, valued: Valued) -> bool:
        """Whether they are those of other values; `models` are these phases at such."""
        system, own = self.equations.graph.system, self.equations.model
        model, p = valued.model, models.p[None, :]
        given = () if self.follows_start else {name.rstrip("'") for name in valued.start}
        tables = ((model.coordinates, own.coordinates), (model.speeds, own.speeds))
        if any(part != there[name] for here, there in tables for name, part in here.items() if name not in given):
            return False
        derived = self.derived
        places = derived.declared.many(0.0, np.zeros((1, len(system.symbols.q) + len(system.symbols.u))), p)
        for k, q in enumerate(system.symbols.q):
            places[0, k] = valued.start.get(q.name, places[0, k])
        if not derived.holds(p, places)[0]:
            return False
        if not derived.asks(p)[0]:
            return True
        try:
            here = at_start(models, 0.0, given_parameters(model), valued.start)
        except DerivationError:
            return False
        return bool(derived.is_regular(p, models.of(here.configuration).state(here.values)[None, :])[0])

    @cached_property
    def derived(self) -> DerivedAt:
        return DerivedAt(self.equations.graph.system, self.models.p, has_phases(self.equations.model))


def given_parameters(model: Model) -> dict[str, Expression]:
    """The values of all parameters that have one, in place of those of a model that was derived."""
    return {name: part.value for name, part in model.parameters.items() if part.value is not None}


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
