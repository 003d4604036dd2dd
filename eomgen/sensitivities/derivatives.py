"""Model -> Sensitivity: exact derivatives of requested formulas by parameters and start values.

They are taken at the start, at an equilibrium, of small motions, or along a run: in closed form where one exists, as a
number always, by differentiating the equations that define them: without a step or a difference.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property, partial
from itertools import takewhile
from typing import Any

import numpy as np

from eomgen.documents import Document, Found, Listing, Quantity, Result, plain_document
from eomgen.errors import DerivationError, EomgenError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.instant import Quantities
from eomgen.mechanics.linearization import ParameterSlopes
from eomgen.mechanics.start import ExactStart, Seeds, Start
from eomgen.mechanics.state import Numbers, Split
from eomgen.model import (
    AtRest,
    Model,
    ModelOrPath,
    Output,
    OutputSource,
    Requests,
    Typed,
    Unit,
    Values,
    seconds,
)
from eomgen.proof import Certificate, Check, Tally, checked, differing
from eomgen.resources import doing
from eomgen.results import Linearization, linearize
from eomgen.sensitivities.runs import ChangingRun, ChangingState, Derivatives, changing_run, checks_of
from eomgen.simulation import instants_of
from eomgen.study import Study, model_to_study, study_of
from eomgen.symbolic.exact import book_form, legible
from eomgen.symbolic.expression import Call, Expression, Fraction, Node, Scalar, jacobian, parse, substituted, tangent
from eomgen.symbolic.numeric import NoValue, Work, evaluate, fifty_digits, tolerances
from eomgen.symbolic.print import LONGEST_RESULT, readable_text, text_size

RHS, STATE, FREQUENCIES, REST = "rhs", "state", "frequencies", "equilibrium"
MOST_WRITTEN = 6  # speeds of equations whose slopes are written out
SAMPLES, LAST = 101, 2
NO_VALUE = "it has no finite value"
SLOPE = re.compile(r"d\((?P<of>.+)\)/d\((?P<to>[^()]+)\)")


@dataclass(frozen=True)
class Sensitivity(Result):
    """Requested formulas and their derivatives.

    Args:
        model: the model.
        of: the requested formulas.
        to: the parameters and starts.
        values: value of each formula, in its unit.
        slopes: derivative by (formula, name): exact where it has a closed form; its number in the formula's unit over
            the name's.
        run: values and derivatives along a motion; None where none was requested.
        in_si: the derivatives in SI.
        wanted: the requests as they were written: "rhs" is several formulas.
    """

    model: Model
    of: tuple[str, ...]
    to: tuple[str, ...]
    values: Mapping[str, Quantity]
    slopes: Mapping[tuple[str, str], Quantity]
    run: ChangingRun | None = None
    in_si: Mapping[tuple[str, str], float] = field(default_factory=dict, repr=False)
    wanted: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<sensitivities of {self.model.name!r}: {len(self.of)} by {', '.join(self.to)}>"

    def __getitem__(self, pair: tuple[str, str]) -> Quantity:
        """The derivative of a formula by a name."""
        if pair not in self.slopes:
            raise UsageError(f"no derivative of '{pair[0]}' by '{pair[1]}' was requested", fix="request it in the call")
        return self.slopes[pair]

    @property
    def matrix(self) -> np.ndarray:
        """The derivatives in SI, len(of) x len(to); nan where there is none."""
        return np.array([[self.in_si.get((of, to), np.nan) for to in self.to] for of in self.of])

    @property
    def failed(self) -> str:
        """Message that names the derivatives without a value; "" where there are none."""
        missing = [named(of, to) for (of, to), slope in self.slopes.items() if not slope.answered]
        return f"not answered: {', '.join(missing)}" if missing else ""

    @property
    def derivation(self) -> Document:
        """Each derivative by its name."""
        rows = [Found(named(of, to), slope) for (of, to), slope in self.slopes.items()]
        return plain_document(self.model, self.entries, Listing(tuple(rows)))

    def entries(self) -> dict[str, Any]:
        """Entries for machines; for a run the values at its end, and the columns."""
        found: dict[str, Any] = {"name": self.model.name, "to": list(self.to), "values": dict(self.values)}
        found["slopes"] = {of: {to: self.slopes[of, to] for to in self.to} for of in self.of}
        if self.run is not None:
            columns = {of: {to: self.run.slopes[of, to].tolist() for to in self.to} for of in self.of}
            found["run"] = {"t": self.run.t.tolist(), "values": {of: self.run.values[of].tolist() for of in self.of}}
            found["run"]["slopes"] = columns
        return found

    def to_pandas(self) -> Any:
        """The matrix as a DataFrame, a row for each formula (needs pandas)."""
        import pandas

        return pandas.DataFrame(self.matrix, index=list(self.of), columns=list(self.to))

    def certify(self) -> Certificate:
        """Proof of each derivative and formula by central differences of the whole computation, made anew.

        Reported values in units and texts are compared with the numbers in SI, and formulas with the requests.
        """
        off = (
            f"{named(*pair)} is {found.value * Unit.parse(found.unit or '1').size:.9g} in SI for {self.in_si[pair]:.9g}"
            for pair, found in self.slopes.items()
            if found.value is not None and pair in self.in_si and not self._as_reported(pair, found)
        )
        reported = [checked("reported derivatives are those in SI", next(off, ""), "floating point")]
        reported.append(
            checked("derivatives are of the requested quantities", self._of_others(), "names that the file declares")
        )
        if self.run is not None:
            reported.append(
                checked("values at the end are those of the last instant", self._not_at_the_end(), "its columns")
            )
        texts = Tally("closed forms of derivatives, read back, give the numbers", "our grammar, floating point")
        for pair, slope in self.slopes.items():
            if slope.exact is not None and pair in self.in_si:
                texts.add(named(*pair), partial(self._misread, slope.exact, self.in_si[pair]))
        values = {of: x.value * Unit.parse(x.unit or "1").size for of, x in self.values.items() if x.value is not None}
        slopes = checks_of(self.model, Derivatives(values, self.in_si, self.run))
        return Certificate((*slopes.checks, *reported, *texts.checks()))

    def _not_at_the_end(self) -> str:
        """Message that names a value or derivative which is not that of the run's latest instant; ""."""
        assert self.run is not None
        last = int(np.argmax(self.run.t))
        for pair, slope in self.in_si.items():
            if not np.array_equal(slope, self.run.slopes[pair][last], equal_nan=True):
                return f"{named(*pair)} is {slope:.9g} for {self.run.slopes[pair][last]:.9g}"
        for of, found in self.values.items():
            due = float(self.run.values[of][last])
            if found.value is not None and differing(found.value * Unit.parse(found.unit or "1").size, due):
                return f"{of} is {found.value:.9g} {found.unit or ''} for {due:.9g} in SI"
        return ""

    def _misread(self, text: str, due: float) -> str:
        """The text at the parameters, and where the motion starts."""
        formula, known = parse(text), {**self.model.numeric_parameters(), "pi": math.pi, "t": 0.0}
        if formula.names - known.keys():
            known |= _Asking(self.model).phase.state_at_start
        if missing := formula.names - known.keys():
            raise NoValue(f"no value of {', '.join(sorted(missing))}")
        return differing(float(formula.evaluate(known)), due)

    def _of_others(self) -> str:
        """Message if the formulas are not the requested ones; ""."""
        left = self.of
        for text in self.wanted:
            due = self._meant(text, left)
            if left[: len(due)] != due:
                return f"{', '.join(left)} for {text}"
            left = left[len(due) :]
        return f"{', '.join(left)} in addition to {', '.join(self.wanted)}" if left and self.wanted else ""

    def _meant(self, text: str, left: tuple[str, ...]) -> tuple[str, ...]:
        """Formulas for which a text stands, by names of the file; `left` gives the number of speeds and frequencies."""
        parts = self.model.coordinates
        if text in self.model.outputs or text not in (RHS, STATE, FREQUENCIES, REST):
            return (text,)
        if text == REST:
            free_ones = (q for q, part in parts.items() if not part.driven)
            return tuple(f"{x} at {AtRest.text}" for x in (*free_ones, *self.model.states))
        if text == FREQUENCIES:
            return tuple(f"frequency({k})" for k, _ in enumerate(takewhile(lambda x: "frequency(" in x, left), start=1))
        dot = "'" if text == RHS else ""
        speeds = dict.fromkeys(f"{name}{dot}" for name in (*self.model.speeds, *(f"{q}'" for q in parts)))
        free = [f"{q}'{dot}" for q, part in parts.items() if not (part.driven or part.dependent or self.model.speeds)]
        reported = tuple(takewhile(speeds.__contains__, left[len(parts) :]))
        own = reported if set(free) <= set(reported) else free
        return (*(f"{q}{dot}" for q in parts), *own, *(f"{z}{dot}" for z in self.model.states))

    def _as_reported(self, pair: tuple[str, str], found: Quantity) -> bool:
        due = self.in_si[pair]
        return found.value is not None and math.isclose(
            found.value * Unit.parse(found.unit or "1").size,
            due,
            rel_tol=tolerances.COMPUTED,
            abs_tol=tolerances.COMPUTED**2,
        )


def named(of: str, to: str) -> str:
    """A derivative by its name."""
    return f"d({of})/d({to})"


def slope_requested(text: str) -> tuple[str, str] | None:
    """("frequency(1)", "k") of "d(frequency(1))/d(k)"; None of any other text."""
    found = SLOPE.fullmatch(text.strip())
    return None if found is None else (found["of"].strip(), found["to"].strip())


def unit_of_slope(model: Model, of: str, to: str) -> Unit:
    """The unit of a derivative: of the formula over that of the name, as the model has them; 1 of a number."""
    above, below = _unit_of(model, of), _unit_of(model, to)
    if below is None:
        return above or Unit.parse("1")
    under = f"({below.text})" if set(below.text) & set("*/") else below.text
    return Unit.parse(f"{'1' if above is None else above.text}/{under}")


def _unit_of(model: Model, text: str) -> Unit | None:
    """The unit of a name or formula."""
    output = Requests(model).output(text)
    declared = (*model.coordinates, *model.states, *model.parameters)
    own = model.units_of([text]).get(text) if text in declared else None
    if own is not None or text in model.parameters:
        return own
    if output.at is not None and output.value.text in declared and output.unit is None:
        return model.units_of([output.value.text]).get(output.value.text)
    return model.requesting({"asked": output}).units_of(["asked"]).get("asked")


@doing("the sensitivities")
def sensitivity(
    model: ModelOrPath,
    of: Sequence[str] | str = (),
    to: Sequence[str] | str = (),
    *,
    time: Typed | None = None,
    samples: int | Sequence[Typed] = SAMPLES,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Sensitivity:
    """Exact derivatives of formulas of a model.

    Args:
        of: outputs by name and formulas as outputs have them: "theta''", "reaction_y(A)", "frequency(1)",
            "x(B) at equilibrium"; "rhs" for q' and u' at the start; "frequencies"; "equilibrium" for every
            coordinate at rest. (): the model's outputs. The start moves along, as its expressions and the constraints
            say.
        to: parameters, those that depend on one following it; coordinates and speeds, for where they start; (): all
            parameters.
        time: how long a motion is followed, 5 s or "500 ms"; then `of` are functions of the state along it, "state" for
            all coordinates and speeds (()), and the derivatives are those at its end.
        samples: of the run, how many, or at which instants, in SI or with a unit.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: a name that the model does not have.
        MissingValues: a parameter without a value.
        NotYet: contacts may change along the run, or a force jumps.
    """
    model = model_to_study(model, parameters, start)
    asking = _Asking(model)
    names = (
        (to,)
        if isinstance(to, str)
        else tuple(to) or tuple(name for name in model.parameters if name not in model.counts)
    )
    wanted = (of,) if isinstance(of, str) else tuple(of)
    asking.refuse_unknown(names)
    if time is not None:
        wanted = wanted or (STATE,)
        return replace(asking.along(wanted, names, seconds(time), samples), wanted=wanted)
    wanted = wanted or tuple(model.outputs) or (RHS,)
    return replace(asking.now(tuple(asking.formulas(wanted)), names), wanted=wanted)


def _alone(model: Model, of: str, to: str, time: float) -> Sensitivity:
    """One derivative; of "last(F)" that of F at the end of a run."""
    call = parse(of, references=True).call
    if call is not None and call.name == "last":
        return sensitivity(model, of[of.index("(") + 1 : -1], to, time=time, samples=LAST)
    return sensitivity(model, of, to)


def slope_in_si(model: Model, of: str, to: str, time: float) -> tuple[float | None, str]:
    """(one derivative in SI, the reason why there is none).

    Args:
        of: a formula as `sensitivity` takes it, or "last(F)", F at the end of a run.
        time: of the run [s].
    """
    found = _alone(model, of, to, time)
    value = float(found.matrix[0, 0])
    return (value, "") if np.isfinite(value) else (None, next(iter(found.slopes.values())).message or NO_VALUE)


def checks_of_slope(model: Model, of: str, to: str, time: float) -> Sequence[Check]:
    """Its proof; arguments as of `slope_in_si`."""
    return _alone(model, of, to, time).certify().checks


Derived = tuple[float, float, Scalar | None]
"""value, derivative in SI, and this in closed form where it has one"""


@dataclass(frozen=True)
class _Asking:
    """Model and the systems that its derivatives need."""

    model: Model

    @property
    def phase(self) -> Study:
        return study_of(self.model)

    @cached_property
    def small(self) -> Linearization:
        return linearize(self.model)

    def refuse_unknown(self, names: Sequence[str]) -> None:
        """Refuses names that are neither parameters nor start values."""
        symbols = self.phase.system.symbols
        known = (*self.model.parameters, *(x.name for x in symbols.x))
        for name in names:
            if name in self.model.counts:
                raise UsageError(f"'{name}' counts things of the model: nothing is differentiated by it", fix="set it")
            if name not in known:
                kinds = "coordinate, speed or state" if symbols.z else "coordinate or speed"
                raise UsageError(f"no parameter, {kinds} '{name}'", fix=f"one of {', '.join(known)}")

    def formulas(self, wanted: Sequence[str]) -> Iterator[str]:
        """Requested formulas, one by one."""
        symbols = self.phase.system.symbols
        for text in wanted:
            if text == RHS and text not in self.model.outputs:
                yield from (f"{x.name}'" for x in symbols.x)
            elif text == STATE and text not in self.model.outputs:
                yield from (x.name for x in symbols.x)
            elif text == FREQUENCIES:
                yield from (f"frequency({k})" for k, _ in enumerate(self.small.frequencies, start=1))
            elif text == REST:
                parts = self.model.coordinates
                free = (q for q in symbols.q if not parts[q.name].driven)
                yield from (f"{x.name} at {AtRest.text}" for x in (*free, *symbols.z))
            else:
                yield text

    # -- at one state ----------------------------------------------------------------------------------------

    def now(self, of: tuple[str, ...], to: tuple[str, ...]) -> Sensitivity:
        """Derivatives at the start, at rest, and of small motions."""
        values: dict[str, Quantity] = {}
        slopes: dict[tuple[str, str], Quantity] = {}
        in_si: dict[tuple[str, str], float] = {}
        for text in of:
            output = Requests(self.model).output(text)
            for name in to:
                unit = unit_of_slope(self.model, text, name)
                try:
                    value, slope, exact = self._slope(output, name)
                except EomgenError as error:
                    slopes[text, name] = Quantity(unit=unit.text, message=error.what)
                    continue
                in_si[text, name] = slope
                written = None if exact is None or text_size(exact) > LONGEST_RESULT else self._written(exact)
                slopes[text, name] = Quantity(written, slope / unit.size, unit.text, "derivative of the equations")
                values.setdefault(text, self._in_unit(text, value))
        return Sensitivity(self.model, of, to, values, slopes, None, in_si)

    def _in_unit(self, text: str, value: float) -> Quantity:
        """Value of a formula in its unit."""
        own = _unit_of(self.model, text)
        return Quantity(None, value, "") if own is None else Quantity(None, value / own.size, own.text)

    def _slope(self, output: Output, name: str) -> Derived:
        """One derivative.

        Raises:
            DerivationError: it is of a whole run, or of an instant.
        """
        if (
            Quantities.requested_by(output.value, OutputSource.OF_A_RUN)
            or output.from_ is not None
            or output.event is not None
        ):
            raise DerivationError(
                "it is of a whole run, or of one instant of it: no derivative is sought of that",
                fix="request last(...), or sweep over the parameter",
            )
        rest = output.rests
        if output.at is not None and not rest:
            raise DerivationError("it is requested at an instant", fix="give `time`: derivatives along the run")
        if Quantities.requested_by(output.value, OutputSource.SMALL_MOTIONS):
            return self._of_small_motions(output.value, name)
        return self._at_rest(output.value, name) if rest else self._at_the_start(output.value, name)

    def _changed(self, name: str, phase: Study | None = None) -> Seeds:
        """Derivatives of the parameters by a name; {} where the name is no parameter."""
        scope = (phase or self.phase).system.scope
        return scope.parameter_seeds(name) if name in self.model.parameters else {}

    def _at_the_start(self, formula: Expression, name: str) -> Derived:
        phase = self.phase
        symbols = phase.system.symbols
        numbers, seeds = self._start(name)
        value, slope = ChangingState(phase, numbers, seeds).formula(formula)
        stays = name in self.model.parameters and not any(seeds.get(x, 0) for x in symbols.x)
        if not stays or len(symbols.u) > MOST_WRITTEN:
            return value, slope, None
        closed = substituted((phase.of_state(formula),), _own_inputs(phase))[0]
        return value, slope, tangent((closed,), self._changed(name))[0]

    def _start(self, name: str) -> tuple[dict[Node, Any], Seeds]:
        """(the state at the start, how it changes with a name)."""
        system = self.phase.system
        numbers = self._numbers
        changed = dict(self._changed(name))
        changed |= _seeds_of_inputs(self.phase, numbers, changed)
        begun = ExactStart.derivatives(system, numbers, changed, "" if name in self.model.parameters else name)
        seeds = {**changed, **begun}
        return numbers, seeds | _seeds_of_inputs(self.phase, numbers, seeds)

    @cached_property
    def _numbers(self) -> dict[Node, Any]:
        """t, parameters, inputs, q and u at the start, with 50 digits."""
        system, number = self.phase.system, fifty_digits().number
        symbols, p = system.symbols, self.model.numeric_parameters()
        given = {symbols.t: 0.0} | {symbols.parameters[name]: x for name, x in p.items()}
        state = Start.of(system).values
        given |= {x: state[x.name] for x in symbols.x}
        found = {x: number(Fraction(value)) for x, value in given.items()}
        inputs = _own_inputs(self.phase)
        return found | dict(zip(inputs, evaluate(tuple(inputs.values()), found, fifty_digits()), strict=True))

    def _at_rest(self, formula: Expression, name: str) -> Derived:
        """Value and derivative at the equilibrium, which moves with the parameter."""
        reference = self.small.small.reference
        phase = Study(reference.system)
        changed = self._changed(name, phase)
        if not changed and not self._rests_alone:
            raise DerivationError(
                "it has many equilibria next to one another, of which the start selects one",
                fix="hold it by a spring or a constraint",
            )
        seeds = ParameterSlopes(self.small.small, changed).seeds if changed else {}
        value, slope = ChangingState(phase, reference.numbers, seeds).formula(formula)
        known = {x: y for x, y in reference.exact.items() if type(y) is not float}
        closed = formula.evaluate(phase.system.scope.names, _refused) if not formula.calls else None
        if closed is None or not reference.is_exact or not changed:
            return value, slope, None
        return value, slope, tangent(substituted((closed,), known), changed)[0]

    @cached_property
    def _rests_alone(self) -> bool:
        """True if the equilibrium is isolated: no other one near it."""
        if self.small.equations.states:
            return bool(np.linalg.matrix_rank(A := self.small.A) == len(A))
        K, reference = self.small.K, self.small.small.reference
        constraints = [row.velocity for row in reference.system.constraints.closing]
        u = reference.system.symbols.u
        J = Numbers(reference.numbers).array(jacobian(constraints, u), len(u))
        free = len(Split.of(J, smallest=tolerances.RANK_NEARBY).free)
        return bool(K.shape == (free, free) and np.linalg.matrix_rank(K) == free)

    def _of_small_motions(self, formula: Expression, name: str) -> Derived:
        """A formula of frequencies and entries of M, C and K."""
        small = self.small.small
        phase = Study(small.reference.system)
        scope, changed = phase.system.scope, self._changed(name, phase)
        changing = ParameterSlopes(small, changed)
        found: dict[Node, tuple[float, float, Scalar | None]] = {}

        def value(call: Call) -> Scalar:
            node = scope.graph.symbol(str(call))
            found[node] = self._called(call, changing)
            return node

        scalar = formula.evaluate(scope.names, value)
        number = fifty_digits().number
        numbers = {**small.reference.numbers, **{x: number(Fraction(y)) for x, (y, _, _) in found.items()}}
        seeds = {**changed, **{x: Fraction(slope) for x, (_, slope, _) in found.items()}}
        ((at, slope),) = ChangingState(phase, numbers, seeds).of([scalar])
        exact = {x: y for x, (_, _, y) in found.items() if y is not None}
        if len(exact) < len(found) or not changed:
            return at, slope, None
        return at, slope, tangent(substituted((scalar,), exact), changed)[0]

    def _called(self, call: Call, changing: ParameterSlopes) -> Derived:
        """A frequency, or an entry of a matrix: (value, slope, the value in closed form)."""
        if call.name == "frequency":
            frequency = self.small.modes.frequency(int(call.args[0].literal or 0))  # type: ignore[union-attr]
            value = frequency.mode.frequency or 0.0
            if value == 0:
                raise DerivationError(
                    "a motion that does not swing has no frequency that would change", fix="request an eigenvalue"
                )
            slope = changing.eigenvalue(frequency.mode.eigenvalue).imag if changing.parameters else 0.0
            return value, slope, frequency.exact
        modes, names = self.small.modes, call.names
        entry, exact = modes.entry(call.name, *names)
        found = changing.entry(call.name, *modes.place(call.name, *names))
        return found.value, found.slope, entry if exact else None

    def _written(self, scalar: Scalar) -> str | None:
        """The text of a closed form."""
        positive = self.phase.system.scope.positive
        return readable_text(book_form(legible(scalar, Work.ANSWER, positive, LONGEST_RESULT), Work.FORMULA, positive))

    # -- along a run -----------------------------------------------------------------------------------------

    def along(
        self, of: tuple[str, ...], to: tuple[str, ...], time: float, samples: int | Sequence[Typed]
    ) -> Sensitivity:
        """Derivatives along a motion, and at its end."""
        if not time > 0:
            raise UsageError(f"the time {time:g} s makes no sense", fix="give one above 0")
        texts = tuple(self.formulas(of))
        formulas = {text: Requests(self.model).output(text).value for text in texts}
        instants = instants_of(samples, 0.0, time)
        symbols = self.phase.system.symbols
        x = symbols.x
        begun: dict[str, Any] = {name: self._start(name)[1] for name in to}
        start = np.array([float(self._numbers[node]) for node in x])
        changes = {name: np.array([float(seeds.get(node, 0)) for node in x]) for name, seeds in begun.items()}
        run = changing_run(self.phase, (start, changes), {name: self._changed(name) for name in to}, formulas, instants)
        in_si = {pair: float(column[-1]) for pair, column in run.slopes.items()}
        slopes = {}
        for pair, slope in in_si.items():
            unit = unit_of_slope(self.model, *pair)
            slopes[pair] = Quantity(None, slope / unit.size, unit.text, "variational equations")
        values = {text: self._in_unit(text, float(run.values[text][-1])) for text in texts}
        return Sensitivity(self.model, texts, to, values, slopes, run, in_si)


def _refused(call: Call) -> Scalar:
    raise DerivationError(f"'{call}' has no closed form", fix="give every parameter a value in [parameters]")


def _own_inputs(phase: Study) -> dict[Node, Scalar]:
    """The inputs by the model's own expressions."""
    return {node: phase.system.inputs[name] for name, node in phase.system.symbols.inputs.items()}


def _seeds_of_inputs(phase: Study, numbers: Mapping[Node, Any], seeds: Seeds) -> dict[Node, Fraction]:
    inputs = _own_inputs(phase)
    found = evaluate(tangent(tuple(inputs.values()), seeds), numbers, fifty_digits())
    return {x: Fraction(float(rate)) for x, rate in zip(inputs, found, strict=True)}
