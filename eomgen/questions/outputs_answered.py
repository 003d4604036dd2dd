"""Model -> {name: Answer}: the outputs that the model requests in [outputs], exact and as numbers.

A function of coordinates and rates is exact, the accelerations in it replaced by the equations of motion. Requested
`from` the start it is a function of the coordinates alone, rates eliminated by the energy theorem and the momenta. At
an instant it is exact where the motion can be followed in closed form, else a number by integration.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

from eomgen.documents import Document, Found, Listing, Quantity, Result, answer_text, listing_markdown, plain_document
from eomgen.errors import (
    DerivationError,
    EomgenError,
    ExpressionError,
    MissingValues,
    ModelError,
    RunFailed,
)
from eomgen.frozen import dataclass
from eomgen.mechanics.instant import InstantKinematics, Quantities
from eomgen.model import (
    FUNCTIONS,
    AtRest,
    Model,
    ModelOrPath,
    Output,
    OutputSource,
    Values,
)
from eomgen.proof import AnswerSolver, Certificate, certify_answers
from eomgen.resources import PatienceEnded, doing, keep_what_there_is
from eomgen.results import Linearization, linearize, why_not_at_rest
from eomgen.simulation import WholeRun
from eomgen.study import MotionFromStart, StateAtInstant, Study, model_to_study, study_at_rest
from eomgen.symbolic.expression import Call, Expression, Node, Scalar, depends_on, order, substituted, symbols_of
from eomgen.symbolic.numeric import number_of, transplanted
from eomgen.symbolic.print import LONGEST_RESULT, text_size

Answer = Quantity  # of an output

NO_VALUE = "it has no finite value {}"


class Answers(dict[str, Answer], Result):
    """{name: answer}, in the order of the model's outputs.

    Args:
        solver: the solver that found them.
        stopped: "interrupted" or "out of patience", where only the outputs before it were sought; "" for a whole run.
    """

    def __init__(self, found: Mapping[str, Answer], solver: AnswerSolver, stopped: str = "") -> None:
        super().__init__(found)
        self._solver, self.stopped = solver, stopped

    def __repr__(self) -> str:
        return f"<answers: {', '.join(self) or 'none requested'}>"

    def _repr_markdown_(self) -> str:
        """Answers by name, exact and as numbers, typeset."""
        return listing_markdown(self._rows, self._solver.model)

    @property
    def _rows(self) -> tuple[Found, ...]:
        """Every answer under its name, and as its author sets it."""
        outputs = self._solver.model.outputs
        return tuple(Found(name, answer, symbol=outputs[name].symbol) for name, answer in self.items())

    @property
    def derivation(self) -> Document:
        """Answers by name: exact, as a number, and the method."""
        notes = () if self else ("the model requests nothing: it has no [outputs]",)
        return plain_document(self._solver.model, self.entries, Listing(self._rows), notes=notes)

    @property
    def failed(self) -> str:
        """Message that names the outputs without an answer, those of a whole run left out; "" where there are none."""
        outputs = self._solver.model.outputs
        unanswered = [
            name for name, answer in self.items() if not answer.answered and not WholeRun.answers(outputs[name])
        ]
        return f"not answered: {', '.join(unanswered)}" if unanswered else ""

    def entries(self) -> dict[str, Any]:
        """Contents of `solve --json`."""
        return {"name": self._solver.model.name, "outputs": dict(self)}

    def certify(self) -> Certificate:
        """Proof of the equations, then of every number by the motion in numbers and of every text by its number."""
        with doing("the proof of the answers"):
            return certify_answers(self._solver, self)


def solve(model: ModelOrPath, *, parameters: Values | None = None, start: Values | None = None) -> Answers:
    """Every output of the model, in its order; one that cannot be answered has its message.

    Answers found before an interruption are kept.

    Args:
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        ModelError: no output can be answered as the model is wrong: say, a coordinate that moves no mass.
    """
    model = model_to_study(model, parameters, start)
    solver, found, wrong, stopped = _solver_of(model), dict[str, Answer](), [], ""
    for name, output in model.outputs.items():
        if stopped:
            found[name] = solver.unanswered(output, DerivationError(f"not sought: {stopped}"))
            continue
        try:
            with doing(f"the output '{name}'"):
                found[name] = solver.answer(output)
        except ModelError as error:
            wrong.append(error)
            found[name] = solver.unanswered(output, error)
        except (KeyboardInterrupt, PatienceEnded) as stop:
            if not any(answer.answered for answer in found.values()):
                raise
            keep_what_there_is()
            stopped = "interrupted" if isinstance(stop, KeyboardInterrupt) else "out of patience"
            found[name] = solver.unanswered(output, DerivationError(stopped))
    if wrong and not any(answer.answered for answer in found.values()):
        raise wrong[0]
    return Answers(found, solver, stopped)


def _solver_of(model: Model) -> _Solver:
    motions = {at_rest: MotionFromStart(model, at_rest) for at_rest in (False, True)}
    return _Solver(model, motions, {output: unit.text for output, unit in model.output_units.items()})


@dataclass(frozen=True)
class _Solver:
    """Solver of outputs: the equations of a model, derived where an output needs them.

    Args:
        motions: the motion from the start, and from rest at the start.
        units: of the outputs that have one.
    """

    model: Model
    motions: Mapping[bool, MotionFromStart]
    units: Mapping[Output, str]

    @property
    def phase(self) -> Study:
        """The first phase: contacts as they are at the start."""
        return self.motions[False].phase

    def answer(self, output: Output) -> Answer:
        """Answer to one output; an error becomes its message."""
        try:
            return replace(self._answer(output), unit=self._unit(output), digits=output.digits)
        except (DerivationError, RunFailed, ExpressionError, MissingValues) as error:
            return self.unanswered(output, error)

    def unanswered(self, output: Output, error: EomgenError) -> Answer:
        """Answer without a value, whose message is the error."""
        return Answer(unit=self._unit(output), message=f"{error.what}; {error.fix}" if error.fix else error.what)

    def _unit(self, output: Output) -> str:
        return self.units.get(output, "")

    def _answer(self, output: Output) -> Answer:
        if WholeRun.answers(output):
            raise DerivationError("it is a function of a whole run", fix="`eomgen simulate` gives it")
        if Quantities.requested_by(output.value, OutputSource.SMALL_MOTIONS):
            return self._of_small_motions(output)
        if output.at is not None:
            return self._at(output)
        if output.from_ is not None:
            return self._of_configuration(output)
        if self.is_of_the_instant(output):
            return self._of_the_instant(output)
        return self._of_state(output)

    # -- at the one instant of a model with [given] -----------------------------------------------

    def is_of_the_instant(self, output: Output) -> bool:
        """True if the output needs the one instant of a model with [given], or of bodies and constraints alone."""
        given, formula = self.model.given, output.value
        if given is None:
            return not self.model.coordinates and requests_motion(formula)
        texts = [
            side
            for equations in (given.velocity, given.acceleration)
            for equation in equations or ()
            for side in (equation.left, equation.right)
        ]
        unknown = self.model.unknowns.keys() & {name for text in texts for name in text.names}
        return requests_motion(formula) or not {*unknown, *self.model.speeds}.isdisjoint(formula.names)

    @cached_property
    def instant_kinematics(self) -> InstantKinematics:
        return InstantKinematics.of(self.model, by_coordinates=True)

    def _of_the_instant(self, output: Output) -> Answer:
        scalar = self.instant_kinematics.value(output.value)
        found = self._started(self.instant_kinematics.simple(scalar), "velocities under the constraints", output)
        return found if self.instant_kinematics.exact else replace(found, exact=None)

    # -- of the linearized system ------------------------------------------------------------------

    @cached_property
    def linearization(self) -> Linearization:
        return linearize(self.model)

    def _of_small_motions(self, output: Output) -> Answer:
        """A formula of the matrices and frequencies of the linearized system; exact where all of them are."""
        if output.from_ or output.side or (output.at is not None and not isinstance(output.at, AtRest)):
            raise DerivationError("small motions have the state of [linearize]", fix="leave out `at`, `from`, `side`")
        scope = self.phase.system.scope
        exact = True

        def value(call: Call) -> Scalar:
            nonlocal exact
            if FUNCTIONS[call.name].source != OutputSource.SMALL_MOTIONS:
                raise DerivationError(
                    f"'{call}' is a function of the state, next to functions of the linearized system",
                    fix="request it in an output of its own",
                )
            found, is_exact = self.linearization.value(call)
            exact = exact and is_exact
            return transplanted((found,), scope.graph, dict(scope.symbols.parameters))[0]

        scalar = output.value.evaluate(scope.names, value)
        found = self._started(self.phase.simple(scalar), OutputSource.SMALL_MOTIONS, output)
        return found if exact else replace(found, exact=None)

    # -- functions of the state, and of the configuration ---------------------------------------

    def _of_state(self, output: Output) -> Answer:
        """A function of coordinates and rates."""
        phase = self.phase
        scalar = phase.of_state(output.value)
        method = phase.method_for(output.value) or ("kinematics" if symbols_of((scalar,)) else "arithmetic")
        if self._not_at_rest:
            raise DerivationError(
                f"the bodies are not at rest: {self._not_at_rest}",
                fix="let the constraints hold them, or request it at an instant: `at`",
            )
        answer = self._started(phase.simple(scalar), method, output)
        if jump := _jump(phase, output, self.motions[False].numbers):
            return replace(answer, value=None, message=jump)
        answer = self._regular(answer, output)
        failure = self.motions[False].failure
        if failure and any(node.op == "sign" for node in order((scalar,))):
            return replace(answer, value=None, message=f"no number: at the start {failure}")
        without = answer.value is None and answer.message == NO_VALUE.format("at the start")
        if without and (resting := self.motions[False].at_rest_on()):
            what = f"on the surface of {resting} nothing slides yet at the start, and friction has no direction there"
            return replace(answer, message=f"{what}; request it at a later instant: `at`")
        return answer

    def _regular(self, answer: Answer, output: Output) -> Answer:
        """Answer whose value is found at the start itself, where its closed form may divide by zero there."""
        phase = self.phase
        if not phase.system.constraints.closing or not phase.needs_equations(output.value):
            return answer
        symbols = phase.system.symbols
        try:
            state = phase.state_at_start
            numbers = {x: state[x.name] for x in symbols.x} | {symbols.t: 0.0}
            return self._defined(answer, output, phase, numbers)
        except (KeyError, MissingValues):
            return answer

    def _defined(self, answer: Answer, output: Output, phase: Study, numbers: Mapping[Node, float]) -> Answer:
        """Answer with the value of the formula itself at the start, instead of that of its closed form.
        Raises:
            MissingValues: a parameter that it needs has no value.
        """
        found = phase.number(output.value, {**phase.parameters, **numbers})
        value = found if output.unit is None else float(output.unit.from_si(found, math.pi))
        message = None if answer.value is None else answer.message
        return _valued(replace(answer, value=None, message=message), value, "at the start")

    @cached_property
    def _not_at_rest(self) -> str:
        """Reason why bodies without coordinates are not in equilibrium on their contacts; "" where they are."""
        return why_not_at_rest(self.model, self.phase.system)

    def _of_configuration(self, output: Output) -> Answer:
        """A function of the coordinates, rates eliminated by the energy theorem."""
        motion = self.motions[output.from_ == "rest"]
        phase = motion.phase
        scalar = phase.of_state(output.value)
        if not depends_on(scalar, phase.system.symbols.u):
            method = phase.method_for(output.value) or "kinematics"
            answer = self._started(phase.simple(scalar), method, output)
            jump = _jump(phase, output, motion.numbers)
            return replace(answer, value=None, message=jump) if jump else answer
        if not motion.start:
            raise DerivationError("a coordinate at the start has no closed form", fix="request it at an instant: `at`")
        found = phase.rates(at_rest=motion.at_rest)
        if found is None:
            raise DerivationError(
                "no integrals of the motion give the rates as functions of the coordinates",
                fix="request it at an instant: `at`",
            )
        rates, held = found
        motion.refuse_leaving(held)
        (scalar,) = substituted((scalar,), rates)
        method = "energy theorem" if held.everywhere else f"energy theorem, while {held.text}"
        answer = self._started(phase.simple(scalar), method, output)
        singular = answer.value is None and answer.message == NO_VALUE.format("at the start")
        return self._defined(answer, output, phase, motion.numbers) if singular and motion.numbers else answer

    def _started(self, scalar: Scalar, method: str, output: Output) -> Answer:
        """Answer with the text of a scalar, and its value at the start in the output's unit."""
        exact = answer_text(scalar, self.phase.system.scope.positive)
        message = None if exact is not None else f"the exact form is longer than {LONGEST_RESULT} characters"
        try:
            return _valued(Answer(exact, None, "", method, message), self._at_start(scalar, output), "at the start")
        except MissingValues as error:
            return Answer(exact, None, "", method, error.what)

    def _at_start(self, quantity: Scalar, output: Output) -> float:
        """Value at the start in the output's unit; parameters on which it does not depend may have no value.

        Raises:
            MissingValues: a parameter that it needs has no value.
        """
        scalar = self._in_unit(quantity, output)
        known: dict[str, Scalar | float] = {x.name: v for x, v in self.phase.parameters.items()}
        names = {x.name for x in symbols_of((scalar,))}
        if names <= known.keys():
            return number_of(scalar, {x: known[x.name] for x in symbols_of((scalar,))})
        if names <= self.model.parameters.keys():
            raise MissingValues(tuple(name for name in self.model.parameters if name in names and name not in known))
        system = self.phase.system
        names |= {x.name for name in names & self.model.inputs.keys() for x in symbols_of((system.inputs[name],))}
        missing = tuple(name for name in self.model.parameters if name in names and name not in known)
        if missing:
            raise MissingValues(missing)
        values = {"t": 0.0, **known}
        moving = {x.name for x in system.symbols.x}
        if names & moving:
            values |= self.phase.values_at_start
        for name in names & self.model.inputs.keys():
            state = {x: values[x.name] for x in symbols_of((system.inputs[name],))}
            values[name] = number_of(system.inputs[name], state)
        return number_of(scalar, {x: values[x.name] for x in symbols_of((scalar,))})

    def _in_unit(self, quantity: Scalar, output: Output) -> Scalar:
        """Quantity in the unit of the output, exactly."""
        if output.unit is None:
            return quantity
        graph = quantity.graph if isinstance(quantity, Node) else self.phase.system.scope.graph
        found: Scalar = output.unit.from_si(quantity, graph.pi)
        return found

    # -- at an instant -------------------------------------------------------------------------

    def _at(self, output: Output) -> Answer:
        """Answer at the instant of a condition: exact where the motion can be followed exactly, else a number."""
        assert output.at is not None
        if isinstance(output.at, AtRest):
            if output.from_ or output.side:
                raise DerivationError("no motion leads to an equilibrium", fix="leave out `from` and `side`")
            moment = self.at_rest
        else:
            moment = self.motions[output.from_ == "rest"].until(output.at, output.side)
        phase, method = moment.phase, moment.method
        found = self._exactly(moment, output)
        if found is None:
            found, method = self._constant(moment, output), "constant of motion"
        if found is None:
            return _valued(Answer(method=moment.method), self._number_at(moment, output), "at the instant")
        exact = phase.simple(found)
        text = answer_text(exact, self.phase.system.scope.positive)
        try:
            return _valued(Answer(text, None, "", method), self._at_start(exact, output), "at the instant")
        except MissingValues as error:
            return Answer(text, None, "", method, error.what)

    def _exactly(self, moment: StateAtInstant, output: Output) -> Scalar | None:
        """Exact value at the instant; None where too little of its state is known exactly."""
        if self._is_long_and_open(moment, output):
            return None
        try:
            return moment.phase.at(output.value, moment.exact)
        except MissingValues:
            return None

    def _is_long_and_open(self, moment: StateAtInstant, output: Output) -> bool:
        """True if a formula too long to be shown depends on values that are known at the instant only as numbers."""
        phase, symbols = moment.phase, moment.phase.system.symbols
        missing = [x for x in (symbols.t, *symbols.x) if x not in moment.exact]
        if isinstance(output.at, AtRest) or not missing or not moment.numbers:
            return False
        closed = phase.eliminated(phase.raw(output.value))
        return depends_on(closed, missing) and text_size(closed) > LONGEST_RESULT

    def _constant(self, moment: StateAtInstant, output: Output) -> Scalar | None:
        """Value at the start of a formula that is constant along every motion; None: it changes, or a contact has."""
        motion = self.motions[output.from_ == "rest"]
        phase = motion.phase
        if moment.phase is not phase or not motion.start:
            return None
        requested = phase.eliminated(phase.raw(output.value))
        if not phase.stays_constant(requested):
            return None
        return substituted((requested,), motion.start)[0]

    @cached_property
    def at_rest(self) -> StateAtInstant:
        """Equilibrium, or the start held by the unknowns of the loads."""
        return StateAtInstant.resting(study_at_rest(self.model))

    def _number_at(self, moment: StateAtInstant, output: Output) -> float:
        """The value in floating point.

        Raises:
            RunFailed: a parameter has no value, and the state at the instant is not known.
        """
        if not moment.numbers:
            raise RunFailed(
                "the instant has no closed form, and without values of all parameters no number",
                fix="give every parameter a value in [parameters]",
            )
        phase = moment.phase
        value = phase.number(output.value, {**phase.parameters, **moment.numbers})
        return value if output.unit is None else float(output.unit.from_si(value, math.pi))


def _jump(phase: Study, output: Output, numbers: Mapping[Node, float]) -> str:
    """Message if accelerations and reactions have no number at the start: a force jumps with the sign of a rate."""
    try:
        phase.refuse_jump((output.value,), numbers)
    except DerivationError as error:
        return f"no number: {error.what}; {error.fix}"
    return ""


def _valued(answer: Answer, value: float, where: str) -> Answer:
    if math.isfinite(value):
        return replace(answer, value=float(value) + 0.0)  # -0 is 0
    return replace(answer, message=NO_VALUE.format(where))


def requests_motion(formula: Expression) -> bool:
    """True if a formula contains velocities or accelerations: functions of them, or rates of coordinates."""
    moves = any(call.name in FUNCTIONS and FUNCTIONS[call.name].moves for call in formula.calls)
    return moves or any(name.endswith("'") for name in formula.names)
