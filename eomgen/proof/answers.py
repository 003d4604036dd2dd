"""Answers -> Certificate: each number is checked by the motion in numbers, each text by its number.

The exact method (closed laws, energy theorem, simplified reactions) and the numerical one share the poses, the
equations of motion, which are proven first, and the definitions of the functions that outputs request.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, partial
from random import Random
from typing import Any, Protocol

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, ModelError, RunFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.instant import KinematicState, Quantities
from eomgen.mechanics.linearization import Modes
from eomgen.mechanics.start import Start
from eomgen.model import FUNCTIONS, Model, Output, OutputSource
from eomgen.proof.at_a_state import NumericState, moving_states, off_by, place_of, read_back
from eomgen.proof.certificate import certify, certify_standing
from eomgen.proof.check import Certificate, Check, Tally, differing
from eomgen.proof.emitted_code import PhaseMotion, TriedState
from eomgen.proof.instant import instant_checks, second_definition, values_of
from eomgen.proof.masses import other_data
from eomgen.proof.runs import run_checks
from eomgen.proof.small_motions import small_motion_checks
from eomgen.simulation import Trajectory
from eomgen.study import MotionFromStart, StateAtInstant, Study, kinematic_state
from eomgen.symbolic.expression import Call, Fraction, Node, Scalar, depends_on, symbols_of
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, has_pieces, number_of, tolerances

WAY = 1.0  # s, of the motion along which functions of the configuration are checked
ROWS = 21  # samples of it
LONG_WAY = 10.0  # s, of a motion through pieces of min, max, abs, sign, cases and samples
TRIED = 8  # about so many rows of it are checked, and
LAST = 3  # so many before a speed changes its sign
ASIDE = 1e-3  # relative change of a parameter, at which a closed form is checked too


class Reported(Protocol):
    """Answer to one output: a text, a number in its unit, either, or neither."""

    @property
    def exact(self) -> str | None: ...

    @property
    def value(self) -> float | None: ...

    @property
    def answered(self) -> bool: ...


class Linearized(Protocol):
    """Small motions, as `linearize` finds and proves them."""

    @property
    def modes(self) -> Modes: ...

    def number_of(self, call: Call) -> int:
        """k of frequency(k)."""

    def certify(self) -> Certificate:
        """Checks of the equations, and of the small motions."""


class AnswerSolver(Protocol):
    """Solver from which answers came."""

    @property
    def model(self) -> Model: ...

    @property
    def motions(self) -> Mapping[bool, MotionFromStart]: ...

    def is_of_the_instant(self, output: Output) -> bool: ...

    @property
    def at_rest(self) -> StateAtInstant: ...

    @property
    def linearization(self) -> Linearized: ...


def certify_answers(solver: AnswerSolver, answers: Mapping[str, Reported]) -> Certificate:
    """Proof of the equations, where an answer needs them, then of every answer."""
    proof = _Proof(solver, answers)
    of_a_motion = (*proof.begins(), *proof.numbers(), *proof.formulas(), *proof.instants(), *proof.ways())
    return Certificate((*proof.equations, *proof.texts(), *of_a_motion, *proof.apart()))


@dataclass(frozen=True)
class _Proof:
    solver: AnswerSolver
    answers: Mapping[str, Reported]

    @cached_property
    def requested(self) -> dict[str, Requested]:
        """Outputs that were answered, with their answers."""
        outputs = self.solver.model.outputs
        return {name: (outputs[name], found) for name, found in self.answers.items() if found.answered}

    @cached_property
    def equations(self) -> tuple[Check, ...]:
        """Checks of the equations of the first phase; where nothing moves, of the loads on the bodies."""
        phase = self.solver.motions[False].phase
        if self.requested:
            proven = certify if phase.system.symbols.q else certify_standing
            with suppress(ModelError, DerivationError):  # without mass, or with unknown loads: answers at rest alone
                return proven(phase.equations).checks
        return tuple(other_data(phase.system.motion))

    def begins(self) -> Iterator[Check]:
        """Check of the start of a motion that is described by all rates: that of the model by its own speeds."""
        own = self.solver.motions[False].phase.system
        if not self.requested or own.free is not None or not own.scope.dependent:
            return
        tally = Tally("answers begin where the motion of the model does", "the start over its own speeds")
        here = Start.of(own).values
        for name, x in Start.of(System.of(self.solver.model, own.modes)).values.items():
            tally.add(name, partial(differing, here[name], x))
        yield from tally.checks()

    # -- what is printed ---------------------------------------------------------------------------

    def texts(self) -> Iterator[Check]:
        """Checks that the exact text, read back by our grammar, has the number that is printed with it."""
        tally = Tally("exact texts, read back, give the numbers", "our grammar, the text alone, sure digits")
        for name, (output, found) in self.requested.items():
            if found.exact is not None and found.value is not None:
                tally.add(name, partial(self._read_back, output, found))
        return tally.checks()

    def _read_back(self, output: Output, found: Reported) -> str:
        phase = self.solver.motions[False].phase
        number = number_of(read_back(phase.system, found.exact or ""), self._start_values)
        if math.isnan(number):
            raise NoValue("the text contains a symbol without a value at the start")
        return differing(found.value or 0.0, in_unit(number, output))

    @cached_property
    def _start_values(self) -> dict[Node, Scalar | float]:
        """Values of the symbols of a text: parameters, the state at the start, inputs there."""
        motion = self.solver.motions[False]
        system = motion.phase.system
        known: dict[Node, Scalar | float] = {**system.scope.known_exactly, system.symbols.t: 0.0, **_start(motion)}
        for name, node in system.symbols.inputs.items():
            if set(symbols_of((system.inputs[name],))) <= known.keys():
                known[node] = number_of(system.inputs[name], known)
        return known

    # -- values ------------------------------------------------------------------------------------

    def numbers(self) -> Iterator[Check]:
        """Checks that the number of an answer is the value of its formula at the state in numbers."""
        tally = Tally("numbers are those of the formulas at the state", "50 digits, reactions in doubles")
        for name, (output, found) in self.requested.items():
            at_start = found.value is not None and output.from_ is None
            if (at_start or output.at is not None) and not self._is_apart(name):
                tally.add(name, partial(self._against_state, output, found))
        return iter((*tally.checks(), *self._differences()))

    def _differences(self) -> Iterator[Check]:
        """Checks that the value of each function of the motion follows from its second definition too."""
        tally = Tally("functions of the motion hold by their second definitions", "differences of poses, particles")
        for name, (output, found) in self.requested.items():
            if self._is_apart(name):
                continue
            calls = [call for call in output.value.calls if FUNCTIONS[call.name].second is not None]
            if found.value is None or (output.from_ is not None and output.at is None) or not calls:
                continue
            with suppress(RunFailed, ModelError, DerivationError):  # no state: reported by the check of the numbers
                state = self._state_of(output)
                for call in calls:
                    tally.add(str(call), partial(second_definition, state, call))
        return tally.checks()

    def formulas(self) -> Iterator[Check]:
        """Checks of each formula at other states too: terms that vanish at the start are checked there."""
        tally = Tally(
            "formulas, read back, hold at other states", "50 digits, second definitions, reactions in doubles"
        )
        for name, (output, found) in self.requested.items():
            own = output.at is None and output.from_ is None and not self._is_apart(name)
            if own and found.exact is not None and self._others:
                tally.add(name, partial(self._elsewhere, output, found.exact))
        return tally.checks()

    def _elsewhere(self, output: Output, text: str) -> str:
        judged, scalar = False, read_back(self.solver.motions[False].phase.system, text)
        for state in self._others:
            try:
                reported, right = (in_unit(x, output) for x in (state.number(scalar), state.value_of(output.value)))
                if differing(reported, right) and abs(reported - right) > in_unit(state.rounding(output.value), output):
                    near = [in_unit(near.value_of(output.value), output) for near in state.nearby()]
                    if wrong := off_by(reported, right, near):
                        return f"{wrong} at t = {state.t:.6g} s, {place_of(state)}"
                for call in output.value.calls:
                    if FUNCTIONS[call.name].second is not None and (wrong := second_definition(state, call)):
                        return f"{call}: {wrong} at t = {state.t:.6g} s, {place_of(state)}"
                judged = True
            except (NoValue, ZeroDivisionError, DerivationError):
                continue
        if not judged:
            raise NoValue("it has a value at none of the states tried")
        return ""

    @cached_property
    def _others(self) -> list[NumericState]:
        """States of the first phase other than the start; none where no motion follows."""
        phase = self.solver.motions[False].phase
        if not phase.system.symbols.u:
            return []
        try:
            return list(moving_states(phase.equations))[1:]
        except (ModelError, DerivationError):  # a coordinate moves no mass, or loads are unknown: at rest alone
            return []

    def _against_state(self, output: Output, found: Reported) -> str:
        if found.value is None:
            raise DerivationError("it has no number", fix="give every parameter a value in [parameters]")
        state = self._state_of(output)
        right = in_unit(state.value_of(output.value), output)
        if self._requests_forces(output) and state.jumps:
            return "a force jumps there, and it has no one value"
        if not differing(found.value, right) or abs(found.value - right) <= in_unit(
            state.rounding(output.value), output
        ):
            return ""
        return off_by(found.value, right, [in_unit(near.value_of(output.value), output) for near in state.nearby()])

    def _requests_forces(self, output: Output) -> bool:
        """True if an output contains accelerations or reactions."""
        return self.solver.motions[False].phase.needs_equations(output.value)

    def _state_of(self, output: Output) -> NumericState:
        """State at which an output is requested.

        Raises:
            DerivationError, RunFailed: there is no such state, or it is not known in numbers.
        """
        moment = self._moment(output)
        if moment is None:
            phase, numbers = self.solver.motions[False].phase, _start(self.solver.motions[False])
        else:
            phase, numbers = moment.phase, dict(moment.numbers)
        t = phase.system.symbols.t
        if math.isnan(numbers.get(t, 0.0)) and not phase.moves_by_time:
            numbers[t] = 0.0
        if any(math.isnan(x) for x in numbers.values()) or (phase.system.symbols.u and not numbers):
            raise RunFailed("the state is not known in numbers", fix="give every parameter a value in [parameters]")
        return self._state(phase, numbers)

    def _moment(self, output: Output) -> StateAtInstant | None:
        """Instant at which an output is requested; None: the start."""
        if output.rests:
            return self.solver.at_rest
        at = output.condition
        return None if at is None else self.solver.motions[output.from_ == "rest"].until(at, output.side)

    def _state(self, phase: Study, numbers: Mapping[Node, float]) -> NumericState:
        key = id(phase), tuple(numbers.values())
        if key not in self._states:
            state = {phase.system.symbols.t: 0.0, **numbers}
            self._states[key] = NumericState(phase.equations, phase.system.scope.known_exactly, state)
        return self._states[key]

    @cached_property
    def _states(self) -> dict[Any, NumericState]:
        return {}

    # -- answers that belong to no state of the motion -----------------------------------------------

    @cached_property
    def _apart(self) -> tuple[dict[str, Requested], dict[str, Requested]]:
        """Answers by matrices and frequencies of small motions; answers at one instant to which no motion leads."""
        linear = {
            name: pair
            for name, pair in self.requested.items()
            if Quantities.requested_by(pair[0].value, OutputSource.SMALL_MOTIONS)
        }
        left = {name: pair for name, pair in self.requested.items() if name not in linear and pair[0].at is None}
        return linear, {name: pair for name, pair in left.items() if self.solver.is_of_the_instant(pair[0])}

    def _is_apart(self, name: str) -> bool:
        return any(name in group for group in self._apart)

    def apart(self) -> Iterator[Check]:
        """Checks of the answers of small motions, and of those at one instant."""
        linear, instant = self._apart
        system = self.solver.motions[False].phase.system
        if linear:
            yield from of_small_motions(self.solver.linearization, system, linear, self.equations)
        if instant:
            yield from of_one_instant(self.solver.model, instant)

    # -- when ----------------------------------------------------------------------------------------

    def instants(self) -> Iterator[Check]:
        """Checks that a run from the start leads to the state at the instant, and not to the condition before it."""
        tally = Tally("a run in time leads to the requested instants", "integrated from the start")
        rest = Tally("at rest all forces balance", "equations of motion with u = 0, a = 0, 50 digits")
        requested = {
            (output.condition.text, output.from_): output
            for output, _ in self.requested.values()
            if output.condition is not None
        }
        for (text, _), output in requested.items():
            tally.add(text, partial(self._on_the_way, output))
        resting = [name for name, (output, _) in self.requested.items() if output.rests]
        if resting:
            rest.add("the equilibrium", self._balanced)
        return iter((*tally.checks(), *rest.checks()))

    def _on_the_way(self, output: Output) -> str:
        motion = self.solver.motions[output.from_ == "rest"]
        moment = self._moment(output)
        assert moment is not None
        if motion.goes_through_phases:
            return wrong_way(motion, output, moment)
        t = moment.numbers.get(moment.phase.system.symbols.t, math.nan)
        if not (math.isfinite(t) and motion.numbers):
            raise RunFailed("the instant is not known in numbers", fix="give every parameter a value in [parameters]")
        if t == 0:
            return ""
        if wrong := _by_coincidence(moment, output):
            return wrong
        run = motion.run(t)
        symbols = motion.phase.system.symbols
        there = np.array([moment.numbers[node] for node in symbols.x])
        apart = np.abs(run.x[-1] - there) / (1 + np.max(np.abs(run.x), axis=0, initial=0.0))
        k = int(np.argmax(apart)) if len(apart) else 0
        if len(apart) and not apart[k] <= tolerances.RUNS_AGREE:
            name = symbols.x[k].name
            return f"{name} = {there[k]:.10g} for {run.x[-1][k]:.10g} at t = {t:.10g} s"
        return self._too_late(motion, output, run, t)

    def _too_late(self, motion: MotionFromStart, output: Output, run: Trajectory, t: float) -> str:
        """Message if the difference of the sides of the condition changes its sign before the instant; ""."""
        phase, condition = motion.phase, output.condition
        assert condition is not None
        difference, system = phase.difference(condition), phase.system
        function = RightHandSide.of(Program.of((difference,), system.symbols, inputs=system.inputs), "numpy")
        with np.errstate(all="ignore"):
            values = function.many(run.t, run.x, motion.p)[:, 0]
        size = float(np.max(np.abs(values), initial=0.0))
        before = [float(v) for v, when in zip(values, run.t, strict=True) if when < t * (1 - tolerances.SAME_PLACE)]
        signs = {v > 0 for v in before if abs(v) > tolerances.CARRIED * size}
        smooth = np.max(np.abs(np.diff(values)), initial=0.0) < size
        return f"'{condition.text}' holds before t = {t:.10g} s" if len(signs) > 1 and smooth else ""

    def _balanced(self) -> str:
        moment = self.solver.at_rest
        if not moment.numbers:
            raise RunFailed(
                "the equilibrium is not known in numbers", fix="give every parameter a value in [parameters]"
            )
        state = self._state(moment.phase, moment.numbers)
        return _left_at_rest(state) or _by_coincidence(moment)

    # -- on the way --------------------------------------------------------------------------------

    def ways(self) -> Iterator[Check]:
        """Checks that a function of the configuration has, along the motion, the value of the formula there."""
        tally = Tally("functions of the configuration hold along the motion", "integrated from the start")
        for name, (output, found) in self.requested.items():
            if output.from_ is not None and output.at is None and found.exact is not None:
                tally.add(name, partial(self._along, output, found))
        return tally.checks()

    @staticmethod
    def _way(motion: MotionFromStart) -> Trajectory:
        """Run of the motion, longer where its equations consist of several pieces."""
        with suppress(RunFailed):
            if any(map(has_pieces, (*motion.phase.equations.forcing, motion.phase.equations.V))):
                return motion.run(LONG_WAY)  # at its own steps: a stiff floor is touched for milliseconds
        return motion.run(WAY, ROWS)

    def _along(self, output: Output, found: Reported) -> str:
        motion = self.solver.motions[output.from_ == "rest"]
        phase, run = motion.phase, self._way(motion)
        scalar, symbols = read_back(phase.system, found.exact or ""), phase.system.symbols
        if depends_on(scalar, symbols.u):
            return ""  # a function of the state: its number is compared
        nodes, parameters = symbols.x, phase.system.scope.known_exactly
        one_way = _before_a_turn(run, len(symbols.q))
        rows = list(zip(run.t.tolist(), run.x.tolist(), strict=True))[1:one_way]
        for t, x in (*rows[:: max(4, one_way // TRIED)], *rows[-LAST:]):
            state = self._state(phase, {symbols.t: t, **dict(zip(nodes, x, strict=True))})
            right = in_unit(state.value_of(output.value), output)
            here: dict[Node, Scalar | float] = {**parameters, symbols.t: t, **dict(zip(nodes, x, strict=True))}
            reported = in_unit(number_of(scalar, here), output)
            wrong = differing(reported, right, tolerances.CARRIED) and off_by(
                reported, right, [in_unit(near.value_of(output.value), output) for near in state.nearby()]
            )
            if wrong:
                return f"{wrong} at t = {t:.6g} s"
        return ""


def _left_at_rest(state: NumericState) -> str:
    """Message if the forces are not in equilibrium while nothing moves; ""."""
    numbers = PhaseMotion(state.equations).numbers(TriedState(0.0, state.x, state.p))
    left, where = numbers.left(np.zeros(len(state.x)))
    return f"{where} is left with {left:.1e} of its terms" if left > tolerances.COMPUTED else ""


def _by_coincidence(moment: StateAtInstant, output: Output | None = None) -> str:
    """Message if a state in closed form is right at the parameters' own values by coincidence only; "".

    At slightly different parameters constraints must be satisfied, an equilibrium must stay one, and the condition of
    an instant must hold.

    Args:
        output: by whose condition the instant is; None: an equilibrium.
    """
    system = moment.phase.system
    symbols, model, rng = system.symbols, system.scope.model, Random(4)
    nodes = symbols.x
    if not symbols.parameters or any(node not in moment.exact for node in nodes):
        return ""
    own = {name: float(x) for name, x in model.exact_parameters().items()}
    parts = {name: model.parameters[name] for name in own}
    free = [name for name, part in parts.items() if part.value is not None and part.value.literal is not None]
    known = model.exact_parameters({name: own[name] * (1 + rng.uniform(0.2, 1) * ASIDE) for name in free})
    if len(known) < len(symbols.parameters):
        return ""
    p = {symbols.parameters[name]: Fraction(float(x)) for name, x in known.items()}
    t = moment.exact.get(symbols.t, 0)
    numbers = {symbols.t: number_of(t, p)} | {node: number_of(moment.exact[node], p) for node in nodes}
    if any(math.isnan(x) for x in numbers.values()):
        return ""  # near the parameters' own values it has no value
    state = NumericState(moment.phase.equations, p, numbers)
    gaps = [row.gap for row in system.constraints.rows if row.gap is not None and not row.identical]
    if any(abs(state.number(gap)) > tolerances.COMPUTED * (1 + max(map(abs, numbers.values()))) for gap in gaps):
        return "its closed form holds by coincidence: near these parameters the constraints are not satisfied"
    condition = None if output is None else output.condition
    if condition is None:
        left = _left_at_rest(state)
        return f"its closed form holds by coincidence: near these parameters {left}" if left else ""
    sides = [state.number(moment.phase.of_state(x)) for x in (condition.left, condition.right)]
    wrong = differing(*sides)
    return f"its closed form holds by coincidence: near these parameters {wrong}" if wrong else ""


def _start(motion: MotionFromStart) -> dict[Node, float]:
    """t, q and u at the start; {} where they are not known."""
    try:
        return motion.numbers
    except (ModelError, DerivationError):
        return {}


def _before_a_turn(run: Trajectory, coordinates: int) -> int:
    """Number of rows before a speed changes its sign."""
    signs = np.sign(run.x[1:, coordinates:])
    turned = np.any(signs * signs[:1] < 0, axis=1) if len(signs) else np.zeros(0, dtype=bool)
    return int(np.argmax(turned)) + 1 if turned.any() else len(run.t)


# -------- proof of phases -------------------------------------------------------------------------------------
# An instant after several phases -> what contradicts it: the proof of the run that was followed up to it.
#
# In each phase steps are taken again by another method, energy, constraints and contacts must be those of the phase,
# and between phases only impulses that push change the momentum. The state must be that at the end, and the condition
# must not hold before.


def wrong_way(motion: MotionFromStart, output: Output, moment: StateAtInstant) -> str:
    """Contradiction to an instant of a motion with phases, in words; "" without one.

    Raises:
        DerivationError: nothing of the motion can be checked.
    """
    assert output.condition is not None and motion.models is not None
    t = moment.numbers.get(moment.phase.system.symbols.t, math.nan)
    if t == 0:
        return ""
    found = Certificate(run_checks(motion.run_to(output.condition), motion.models, motion.stepping))
    if found.ok is None:
        raise DerivationError(
            "the motion has phases of which nothing could be checked",
            fix="give every parameter a value in [parameters]",
        )
    failing = [f"{check.name}: {check.detail}" for check in found.checks if check.ok is False]
    return next(iter(failing), "") or _elsewhere(motion, output, moment) or _met_before(motion, output)


def _elsewhere(motion: MotionFromStart, output: Output, moment: StateAtInstant) -> str:
    """Message if the state is not that at the end of the runs, or, with side "after", that after its event; ""."""
    assert output.condition is not None
    last = motion.runs_to(output.condition)[-1]
    end = last.after.values if output.side == "after" and last.after is not None else last.end
    symbols, numbers = moment.phase.system.symbols, moment.numbers
    wrong = [node for node in symbols.x if _apart(numbers[node], end.get(node.name, 0.0))]
    wrong += [symbols.t] if _apart(numbers[symbols.t], last.run.end) else []
    return "".join(f"{node.name} is {numbers[node]:.10g} there" for node in wrong[:1])


def _apart(x: float, y: float) -> bool:
    return not abs(x - y) <= tolerances.RUNS_AGREE * (1 + abs(y))


def _met_before(motion: MotionFromStart, output: Output) -> str:
    """Message if left - right changes its sign within a phase, at the integrator's steps; ""."""
    condition = output.condition
    assert condition is not None
    for run in motion.runs_to(condition):
        phase = run.phase
        scalar = Study(phase.system).difference(condition)
        if type(scalar) is not Node:
            continue
        track = run.run.tracks[0] if run.run.tracks else None
        t, x = (run.run.t, run.run.x) if track is None else track.all
        with np.errstate(all="ignore"):
            values = phase.functions.function((scalar,)).many(t, phase.functions.inner(x), phase.p)[:, 0]
        sure = values[np.abs(values) > tolerances.CARRIED * np.max(np.abs(values), initial=0.0)]
        if np.any(sure > 0) and np.any(sure < 0):
            return f"'{condition.text}' holds before t = {run.run.end:.10g} s"
    return ""


# -------- proof apart -----------------------------------------------------------------------------------------
# Answers that belong to no state of a motion -> checks: of small motions, and of one instant to which no motion leads.
#
# Matrices and state are proven as `linearize` and `kinematics` prove them; then each answer is found again from them,
# by the matrices in floats and the eigenvalues of A, and by the formula at the proven instant with 50 digits.


Requested = tuple[Output, Reported]


def in_unit(value: float, output: Output) -> float:
    """SI value in the unit of the output."""
    return value if output.unit is None else float(output.unit.from_si(value, math.pi))


# -- answers of the linearized system -------------------------------------------------------------------


def of_small_motions(
    found: Linearized, system: System, requested: Mapping[str, Requested], proven: Sequence[Check]
) -> Iterator[Check]:
    """Checks of matrices and modes, as `linearize` proves them, and of the answers that contain them.

    Args:
        system: the system at the start; with the same contacts its equations are those of the small motions.
        proven: checks of the equations of that system.
    """
    same = proven and found.modes.small.first.system.modes == system.modes
    yield from small_motion_checks(found.modes) if same else found.certify().checks
    tally = Tally("answers of small motions are those of the matrices in numbers", "eigenvalues of A in doubles")
    for name, (output, answer) in requested.items():
        if answer.value is not None:
            tally.add(name, partial(_by_matrices, found, system, output, answer.value))
    yield from tally.checks()


def _by_matrices(found: Linearized, system: System, output: Output, value: float) -> str:
    """Difference of a value from the same formula of matrices in floats and imaginary parts of A's eigenvalues; ""."""
    small = found.modes.small

    def second(call: Call) -> Scalar:
        if call.name != "frequency":
            row, column = found.modes.place(call.name, *call.names)
            return Fraction(small.numbers.matrix(call.name)[row][column])
        return Fraction(_rates(found)[found.number_of(call) - 1])

    right = number_of(output.value.evaluate(system.scope.names, second), system.scope.known_exactly)
    frequency = any(call.name == "frequency" for call in output.value.calls)
    return differing(value, in_unit(right, output), tolerances.SAME_PLACE if frequency else tolerances.COMPUTED)


def _rates(found: Linearized) -> list[float]:
    """Frequencies by the eigenvalues of A, the lowest first; a zero for each rigid-body motion."""
    modes = found.modes.spectrum.oscillating
    still = sum(mode.frequency == 0 for mode in modes)
    turning = sorted(np.linalg.eigvals(found.modes.small.state_matrix).imag, reverse=True)[: len(modes) - still]
    return [0.0] * still + [float(x) for x in reversed(turning)]


# -- answers at one instant ----------------------------------------------------------------------------------


def of_one_instant(model: Model, requested: Mapping[str, Requested]) -> Iterator[Check]:
    """Checks of the state, as `kinematics` proves it, and of the answers at it: numbers, and texts read back."""
    state = kinematic_state(model)
    yield from instant_checks(state)
    tally = Tally("answers of the instant are those of its proven state", "50 digits")
    for name, (output, answer) in requested.items():
        tally.add(name, partial(_by_state, state, output, answer))
    yield from tally.checks()


def _by_state(state: KinematicState, output: Output, answer: Reported) -> str:
    system, values = state.system, values_of(state)
    formula = output.value.evaluate(system.scope.names, Quantities(system).value)
    right = in_unit(float(evaluate((formula,), values, fifty_digits())[0]), output)
    reported = [] if answer.value is None else [answer.value]
    if answer.exact is not None:
        text = evaluate((read_back(system, answer.exact),), values, fifty_digits())[0]
        reported.append(in_unit(float(text), output))
    return next(filter(None, (differing(x, right) for x in reported)), "")
