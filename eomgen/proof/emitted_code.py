"""Emitted code, states -> checks: its results are put back into the equations from which it was generated.

    q' = N u + nu,    M a - J^T lam = forcing,    J a = -gamma

The coefficients are the symbols' with 50 digits; a is the code's, lam by least squares. So nothing is shared with the
code but the equations: neither the elimination, nor the order of its statements, nor its language or compiler.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import partial
from typing import Any

import numpy as np

from eomgen.codegen import Written
from eomgen.errors import RunFailed, TextRefused, ToolMissing
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics import EquationsOfMotion, System, exact_accelerations
from eomgen.proof.check import Check, attempted, checked, unchecked
from eomgen.proof.declared_loads import declared_state_rates
from eomgen.proof.free_bodies import moved_otherwise
from eomgen.proof.states import instant_of, with_inputs
from eomgen.symbolic.expression import Node, Scalar, State, order
from eomgen.symbolic.numeric import NoValue, evaluate, fifty_digits, floats_of, of_one_length, tolerances

WORK = 60_000  # graph nodes evaluated with 50 digits in one check, some 0.2 s; one state always
FAR = 1e-2  # of the least of the singular values of scaled rows, from which doubles solve them to COMPUTED
PUT = 2  # states at which accelerations are put to the free bodies: those take as long as the equations' whole proof
HOW = "equations with 50 digits, the code's accelerations put in"


Code = Callable[["TriedState"], np.ndarray]


@dataclass(frozen=True)
class TriedState:
    """A state at which code is tried.

    Args:
        t, x, p: time, (q, u, z), parameters.
        inputs: those that are given in place of the model's own, by name.
        a: accelerations, where these are given.
    """

    t: float
    x: np.ndarray
    p: Sequence[float] | np.ndarray
    inputs: Mapping[str, float] = field(default_factory=dict)
    a: np.ndarray = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class PhaseMotion:
    """The equations of one phase."""

    equations: EquationsOfMotion

    def values(self, at: TriedState) -> State:
        """Values of every symbol except a and lam at a state, with 50 digits; inputs of the model, or given ones."""
        symbols = self.equations.symbols
        nodes = (*symbols.x, *symbols.parameters.values())
        found = {node: fifty_digits().number(float(value)) for node, value in zip(nodes, (*at.x, *at.p), strict=True)}
        found[symbols.t] = instant_of(self.equations.system, float(at.t))
        given = {symbols.inputs[name]: fifty_digits().number(float(x)) for name, x in at.inputs.items()}
        return with_inputs(self.equations.system, found | given)

    @property
    def scalars(self) -> tuple[Scalar, ...]:
        """Scalars of the equations: rates, M, J, forcing, gamma, row after row."""
        equations = self.equations
        matrices = (x for row in (*equations.M, *equations.J) for x in row)
        return (*self.equations.system.scope.rates, *matrices, *equations.forcing, *equations.gamma)

    def torn(self, code: Code, at: TriedState) -> str | None:
        """Message if the code's accelerations violate the equations of the free bodies with all constraints; "".

        None at a state in which the constraints do not hold, and where no constraint closes. Where the code's numbers
        hang on the last digits of the state, this is held against it only if the rows themselves are far from singular.
        """
        equations, symbols = self.equations, self.equations.symbols
        system = equations.system
        if not (system.free or system).constraints.closing:
            return None
        given = self.values(at)
        found = _held(system, given)
        if found is None or any(abs(found[x] - given[x]) > tolerances.CARRIED * (1 + abs(given[x])) for x in symbols.x):
            return None
        state = replace(at, x=np.array(floats_of(found[x] for x in symbols.x)))
        a = code(state)[len(symbols.q) : len(symbols.q) + len(symbols.u)]
        if not np.all(np.isfinite(a)):
            return None
        moving = found | dict(zip(symbols.a, map(fifty_digits().number, a.tolist()), strict=True))
        friction = evaluate(equations.friction, moving, fifty_digits())
        wrong = moved_otherwise(system, moving, friction)
        return wrong if not wrong or _sure(code, state) else moved_otherwise(system, moving, friction, regular=FAR)

    def numbers(self, at: TriedState) -> RunNumbers:
        """The coefficients at a state.

        Raises:
            NoValue: some have none there.
        """
        found = np.array(floats_of(evaluate(self.scalars, self.values(at), fifty_digits())))
        n, k = len(self.equations.M), len(self.equations.J)
        rates, M, J, forcing, gamma = np.split(found, np.cumsum([len(self.equations.N), n * n, k * n, n]))
        declared = partial(self.declared_rates, at)
        return RunNumbers(rates, M.reshape(n, n), J.reshape(k, n), forcing, gamma, declared)

    def declared_rates(self, at: TriedState, a: np.ndarray) -> np.ndarray:
        """z' of the states of first order at a state with given accelerations, by the file's own texts."""
        symbols, number = self.equations.symbols, fifty_digits().number
        known = self.values(at) | dict(zip(symbols.a, map(number, a.tolist()), strict=True))
        return np.array([float(x) for x in declared_state_rates(self.equations.system, known).values()])


@dataclass(frozen=True)
class RunNumbers:
    """The coefficients of the equations at one state."""

    rates: np.ndarray
    M: np.ndarray
    J: np.ndarray
    forcing: np.ndarray
    gamma: np.ndarray
    declared: Callable[[np.ndarray], np.ndarray] = lambda _: np.zeros(0)

    def left(self, dx: np.ndarray) -> tuple[float, str]:
        """Residual of the equations with dx, relative to the largest of their terms, and the equation; nan without dx.

        Raises:
            NoValue: a coefficient, or its square, is beyond doubles.
        """
        if not all(
            np.all(np.abs(x) < tolerances.LARGEST_SQUARED)
            for x in (self.rates, self.M, self.J, self.forcing, self.gamma)
        ):
            raise NoValue("a coefficient of the equations is beyond doubles")
        rates, a, further = np.split(np.asarray(dx, dtype=float), np.cumsum([len(self.rates), len(self.M)]))
        sizes = 1 + np.max(np.abs(self.rates), initial=0.0)
        parts = {"q' = N u + nu": np.max(np.abs(rates - self.rates), initial=0.0) / sizes}
        parts["M a = forcing + J^T lam"] = self.left_of_forces(a)
        rows = np.abs(self.J @ a + self.gamma)
        terms = 1 + np.abs(self.J) @ np.abs(a) + np.abs(self.gamma)
        parts["J a + gamma = 0"] = float(np.max(rows / terms, initial=0.0))
        if len(further):
            right = self.declared(a)
            apart = np.abs(further - right) / (1 + np.abs(right))
            parts["z' = its rate"] = float(np.max(np.where(np.isfinite(further), apart, np.nan), initial=0.0))
        self.refuse_contradiction()
        worst = max(parts, key=lambda name: np.inf if np.isnan(parts[name]) else parts[name])
        return float(parts[worst]), worst

    def refuse_contradiction(self) -> None:
        """Redundant rows contradict one another where the constraints are open.

        Raises:
            NoValue: no a fulfils J a + gamma = 0.
        """
        if not len(self.J):
            return
        sizes = np.linalg.norm(self.J, axis=1)
        J = of_one_length(self.J)
        gamma = self.gamma / np.where(sizes > 0, sizes, 1.0)
        least = J @ np.linalg.lstsq(J, -gamma, rcond=tolerances.COMPUTED)[0] + gamma
        if np.max(np.abs(least)) > tolerances.COMPUTED * (1 + np.max(np.abs(gamma))):
            raise NoValue("the constraints contradict one another")

    def left_of_forces(self, a: np.ndarray, acting: np.ndarray | float = 0.0) -> float:
        """Relative residual of M a - J^T lam = forcing + acting, rows weighted by 1/sqrt(M_kk), lam by least squares.

        A term counts as no smaller than that of an acceleration of 1 m/s^2 or rad/s^2; nan where a has no value.

        Raises:
            NoValue: the terms are beyond doubles.
        """
        weights = np.diag(self.M)
        weights = 1 / np.sqrt(np.where(weights > 0, weights, np.max(weights, initial=0.0) or 1.0))
        needed = weights * (self.M @ a - self.forcing - acting)
        terms = weights * (np.abs(self.M) @ (1 + np.abs(a)) + np.abs(self.forcing) + np.abs(acting))
        if not np.all(np.isfinite(a)):
            return float("nan")
        if len(self.J):
            J = of_one_length(self.J * weights)
            lam = np.linalg.lstsq(J.T, needed, rcond=tolerances.COMPUTED)[0]
            needed, terms = needed - J.T @ lam, terms + np.abs(J.T) @ np.abs(lam)
        left = float(np.max(np.abs(needed), initial=0.0) / max(np.max(terms, initial=0.0), np.finfo(float).tiny))
        if np.isnan(left):
            raise NoValue("the terms of the equations are beyond doubles")
        return left


def _held(system: System, given: State) -> State | None:
    """The nearest state at which all constraints hold, positions and speeds; None where none is near."""
    found = Closure(system.constraints).closed(given, system.constraints.movable)
    if found is None or system.free is None or system.declared:
        return None if found is None else Closure(system.constraints).with_speeds(found)
    free = system.free
    rates = evaluate(system.free_rates(free), found, fifty_digits())
    return Closure(free.constraints).with_speeds(found | dict(zip(free.scope.symbols.u, rates, strict=True)))


def equations_hold(motion: PhaseMotion, code: Code, at: Iterable[TriedState], name: str) -> Check:
    """Check that the code's accelerations satisfy the equations at states; one next to a singular position is left out.

    Where the constraints hold they are put to the free bodies too, which choose no rows: at the first PUT states.
    """
    put: list[str] = []

    def torn(instant: TriedState) -> str:
        with suppress(NoValue, ZeroDivisionError):
            found = motion.torn(code, instant) if len(put) < PUT else None
            put.extend([] if found is None else [found])
            return f"{found} at t = {instant.t:.6g} s" if found else ""
        return ""

    def wrong(instant: TriedState) -> str | None:
        numbers = motion.numbers(instant)
        left, where = numbers.left(code(instant))
        if left <= tolerances.COMPUTED or not _sure(code, instant):
            return torn(instant) or ("" if left <= tolerances.COMPUTED else None)
        return f"{where} is left with {left:.1e} of its terms at t = {instant.t:.6g} s"

    return at_states(name, HOW, at, wrong, cost=len(order(motion.scalars)))


def _sure(code: Code, instant: TriedState) -> bool:
    """True if the code's numbers hardly change when the state does by a part in 1e12, or are not finite there."""
    here, *nearby = (code(each) for each in (instant, *_nearby(instant)))
    if not np.all(np.isfinite(here)):
        return not any(np.all(np.isfinite(each)) for each in nearby)
    change = max(float(np.max(np.abs(each - here), initial=0.0)) for each in nearby)
    return bool(change <= tolerances.COMPUTED * (1 + np.max(np.abs(here), initial=0.0)))


def _nearby(instant: TriedState) -> tuple[TriedState, ...]:
    """The state, each of its numbers a part in 1e12 larger or smaller by turns."""
    turns = np.where(np.arange(len(instant.x)) % 2, -tolerances.SOLVED, tolerances.SOLVED)
    return tuple(replace(instant, x=instant.x * (1 + sign * turns)) for sign in (1, -1))


def values_agree(
    name: str,
    motion: PhaseMotion,
    scalars: Mapping[str, Scalar],
    code: Code,
    at: Iterable[TriedState],
    further: Callable[[TriedState], Mapping[Node, float]] = lambda _: {},
) -> Check:
    """Code against the symbols with 50 digits, entry by entry, relative to the largest.

    Args:
        scalars: quantities that it computes, by name, in the order of its results.
        further: values of symbols that the states do not have: accelerations.
    """

    def wrong(instant: TriedState) -> str | None:
        known = motion.values(instant) | {node: fifty_digits().number(float(x)) for node, x in further(instant).items()}
        right = np.array([float(x) for x in evaluate(tuple(scalars.values()), known, fifty_digits())])
        found = np.asarray(code(instant), dtype=float)
        apart = np.abs(found - right) / (1 + np.max(np.abs(right), initial=0.0))
        if np.all(apart <= tolerances.COMPUTED):
            return ""
        if not _sure(code, instant):
            return None
        k = int(np.argmax(np.where(np.isnan(apart), np.inf, apart)))
        return f"{list(scalars)[k]} is {found[k]:.12g} for {right[k]:.12g} at t = {instant.t:.6g} s"

    return at_states(name, "symbols with 50 digits", at, wrong, cost=len(order(tuple(scalars.values()))))


def at_states(
    name: str, how: str, at: Iterable[TriedState], wrong: Callable[[TriedState], str | None], *, cost: int
) -> Check:
    """A check at states, as many as the work allows.

    Args:
        wrong: what is wrong at a state, or ""; None where the state decides nothing.
        cost: graph nodes that one state takes.
    """
    count, work = 0, 0
    for instant in at:
        if work and work + cost > WORK:
            break
        work += cost
        try:
            found = wrong(instant)
        except (NoValue, ZeroDivisionError):
            continue
        if found:
            return checked(name, found, how)
        count += found is not None
    if not count:
        return unchecked(name, "at none of the states have the equations sure values", how)
    return Check(name, "holds", how, f"at {count} state{'s' * (count > 1)}")


# -------- written code ----------------------------------------------------------------------------------------
# Files of generated code -> checks: the very text that is written is run and held against the symbols.


LITERAL = re.compile(r"(?<![\w.])(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?")  # a number of any language, without its sign
MOST_TOLERANCE = 10 * tolerances.COMPUTED  # that a test vector may allow


def _instants(written: Written) -> tuple[TriedState, ...]:
    """The states of the test vectors of a function."""
    inputs = tuple(written.program.symbols.inputs)
    return tuple(
        TriedState(v.t, np.array(v.x), v.p, dict(zip(inputs, v.inputs, strict=True)) if v.inputs else {}, np.array(v.a))
        for v in written.vectors
    )


def _code(written: Written) -> Code | None:
    """The written function, compiled; None where the language cannot be run here.

    Raises:
        ToolMissing, RunFailed: its compiler is not there, or refuses it.
    """
    called, inputs = written.called(), tuple(written.program.symbols.inputs)
    if called is None:
        return None

    def at(instant: TriedState) -> np.ndarray:
        given = [instant.inputs[name] for name in inputs] if inputs and instant.inputs else None
        return np.array(called(instant.t, instant.x.tolist(), instant.a.tolist(), list(instant.p), given))

    return at


def unwritten(texts: Mapping[str, str | bytes], functions: Iterable[Written]) -> Iterator[Check]:
    """A failing check where a number of the test vectors is missing in the self-test of a language; else none.

    A number is found wherever one like it to the digits of floats stands, in any language's form.
    """
    tests = [text for name, text in texts.items() if isinstance(text, str) and _is_test(name, text)]
    tests += [
        x for name, x in texts.items() if isinstance(x, str) and any(name in text for text in tests)
    ]  # read there
    reported = np.array(sorted({0.0, *(float(x.lower().replace("d", "e")) for x in LITERAL.findall("\n".join(tests)))}))
    for v in (v for each in functions for v in each.vectors) if tests else ():
        numbers = np.array([v.t, *v.x, *v.a, *v.p, *(v.inputs or ()), *v.result])
        numbers = np.abs(numbers[np.isfinite(numbers)])
        k = np.clip(np.searchsorted(reported, numbers), 1, max(len(reported) - 1, 1))
        apart = np.min(np.abs(np.take(reported, [k, k - 1], mode="clip") - numbers), axis=0)
        missing = numbers[(apart > tolerances.SEVEN_DIGITS * numbers) & (numbers > np.finfo(np.float32).tiny)]
        if len(missing):
            what = f"{missing[0]:.9g} at t = {v.t:.6g} s is not written"
            yield checked("test vectors stand in the self-tests of the code", what, "numbers of their texts")
            return


def _is_test(name: str, text: str) -> bool:
    """True if a file is a self-test, or ends with one, as in C."""
    last = name.rpartition("/")[2]
    return not last.endswith((".json", ".md")) and ("test" in name or (last.endswith(".c") and "vectors[] = {" in text))


@dataclass(frozen=True)
class Judged:
    """Reference values by which a function of generated code is checked.

    Args:
        motion: the equations of motion.
        values: of the role "reactions": its outputs by name, in q, u and a.
        actuators: of the role "inverse": coordinates along which its outputs act.
        slopes: of the role "jacobian": (t, x, p, inputs) -> (A, B), solved for in numbers.
        parameters: of the role "regressor": pi, the columns of the first block of `values`; the second is y0.
    """

    motion: PhaseMotion
    values: Mapping[str, Scalar]
    actuators: Sequence[str] = ()
    slopes: Callable[..., tuple[np.ndarray, np.ndarray]] | None = None
    parameters: Sequence[Scalar] | None = None

    def check(self, written: Written, start: Sequence[TriedState]) -> Check:
        """Check of the written function at the start and at the states of its test vectors."""
        name = f"{written.name} in {written.target} gives the symbols' numbers"
        try:
            code = _code(written)
        except TextRefused as error:
            return checked(name, error.what, "run")
        except (ToolMissing, RunFailed) as error:
            return unchecked(name, error.what, "run")
        if code is None:
            return unchecked(name, f"nothing here runs {written.target}", "run")
        if self.parameters is not None:
            return self._regressor(code, _instants(written), name, self.parameters)
        if self.actuators:
            return self._inverse(code, _instants(written), name)
        return self._by_symbols(written, code, start, name)

    def shipped(self, written: Written) -> Check | None:
        """Check of the test vectors that are written with it; None for a function of given accelerations."""
        if not written.vectors or self.actuators or self.parameters is not None:
            return None
        name = f"the test vectors of {written.name} are the symbols' numbers"
        wide = [v for v in written.vectors if not 0 < v.tolerance <= MOST_TOLERANCE]
        if wide:
            return checked(name, f"a tolerance of {wide[0].tolerance:.2g} at t = {wide[0].t:.6g} s", "as written")

        def reported(at: TriedState) -> np.ndarray:
            nearest = min(written.vectors, key=lambda v: abs(v.t - at.t) + np.abs(np.array(v.x) - at.x).max(initial=0))
            return np.array(nearest.result)

        return self._by_symbols(written, reported, (), name)

    def _by_symbols(self, written: Written, code: Code, start: Sequence[TriedState], name: str) -> Check:
        """Check of the code at given states against the symbols there."""
        if written.is_right_hand_side:
            return equations_hold(self.motion, code, (*start, *_instants(written)), name)
        if self.slopes is not None:
            return self._slopes(code, _instants(written), name, self.slopes)
        return values_agree(name, self.motion, self.values, code, (*start, *_instants(written)), self._accelerations)

    def _slopes(self, code: Code, at: Iterable[TriedState], name: str, slopes: Callable[..., Any]) -> Check:
        """A and B against the linearized equations, solved in doubles at the same states."""

        def wrong(instant: TriedState) -> str | None:
            inputs = [instant.inputs[name] for name in self.motion.equations.symbols.inputs] if instant.inputs else None
            right = np.concatenate([x.ravel() for x in slopes(instant.t, instant.x, instant.p, inputs)])
            known = np.isfinite(right)
            if not np.any(known):
                return None
            apart = np.max(np.abs(code(instant) - right)[known]) / (1 + np.max(np.abs(right[known])))
            return "" if apart <= tolerances.CARRIED else f"a slope is off by {apart:.1e} at t = {instant.t:.6g} s"

        how = "the linearized equations solved in numbers"
        return at_states(name, how, at, wrong, cost=len(order(self.motion.scalars)))

    def _regressor(self, code: Code, at: Iterable[TriedState], name: str, pi: Sequence[Scalar]) -> Check:
        """Check of every entry against the symbols, and of Y pi + y0 as forces in the equations without inputs."""
        e = self.motion.equations
        still, size, entries = dict.fromkeys(e.symbols.inputs, 0.0), len(e.symbols.u), tuple(self.values.values())

        def wrong(instant: TriedState) -> str | None:
            a = self._allowed(instant)
            found, unmoved = code(replace(instant, a=a)), replace(instant, inputs=still)
            values = {**self.motion.values(unmoved), **dict(zip(e.symbols.a, map(float, a), strict=True))}
            right = np.array([float(x) for x in evaluate((*entries, *pi), values, fifty_digits())])
            apart = np.max(np.abs(found - right[: len(entries)]), initial=0) / (1 + np.max(np.abs(right), initial=0))
            if not apart <= tolerances.COMPUTED:
                return f"an entry is off by {apart:.1e} at t = {instant.t:.6g} s"
            Y, y0 = found[: size * len(pi)].reshape(size, -1), found[size * len(pi) :][:size]
            return _left(self.motion.numbers(unmoved), instant.t, a, Y @ right[len(entries) :] + y0)

        how = "symbols with 50 digits; Y pi + y0 put into the equations"
        return at_states(name, how, at, wrong, cost=len(order(self.motion.scalars)))

    def _allowed(self, at: TriedState) -> np.ndarray:
        """The accelerations of a state, the nearest that J a + gamma = 0 allows."""
        free = self.motion.numbers(at)
        away = np.linalg.lstsq(free.J, free.J @ at.a + free.gamma, rcond=tolerances.COMPUTED)[0] if len(free.J) else 0.0
        return np.asarray(at.a - away)

    def _accelerations(self, at: TriedState) -> Mapping[Node, float]:
        """a by dense linear algebra.

        Raises:
            NoValue: redundant constraints contradict one another at the state.
        """
        self.motion.numbers(at).refuse_contradiction()
        found = map(float, exact_accelerations(self.motion.equations, self.motion.values(at)))
        return dict(zip(self.motion.equations.symbols.a, found, strict=True))

    def _inverse(self, code: Code, at: Iterable[TriedState], name: str) -> Check:
        """Check of tau as forces and inputs: M a - J^T lam = forcing(tau) + columns tau, with J a + gamma = 0."""
        system = self.motion.equations.system
        columns = {actuator: acting(system, actuator) for actuator in self.actuators if actuator not in system.inputs}

        def wrong(instant: TriedState) -> str | None:
            a = self._allowed(instant)
            tau = dict(zip(self.actuators, code(replace(instant, a=a)).tolist(), strict=True))
            moved = replace(instant, inputs={**instant.inputs, **{n: x for n, x in tau.items() if n in system.inputs}})
            numbers, values = self.motion.numbers(moved), self.motion.values(moved)
            push = np.zeros(len(a))
            for actuator, column in columns.items():
                push += tau[actuator] * np.array([float(x) for x in evaluate(column, values, fifty_digits())])
            return _left(numbers, instant.t, a, push)

        how = "its forces put into the equations with 50 digits"
        return at_states(name, how, at, wrong, cost=len(order(self.motion.scalars)))


def _left(numbers: RunNumbers, t: float, a: np.ndarray, push: np.ndarray) -> str:
    left = numbers.left_of_forces(a, push)
    return "" if left <= tolerances.COMPUTED else f"M a + c = Q is left with {left:.1e} of its terms at t = {t:.6g} s"


def acting(system: System, name: str) -> tuple[Scalar, ...]:
    """The generalized forces of a unit force along a coordinate or a speed, or in a body's joint."""
    symbols = system.symbols
    if name in [u.name for u in symbols.u]:
        return tuple(int(u.name == name) for u in symbols.u)
    if name in [q.name for q in symbols.q]:
        return tuple(system.scope.N[[q.name for q in symbols.q].index(name)])
    row = system.motion.joint_row(name, 0)
    return tuple(row.get(k, 0) for k in range(len(symbols.u)))


def start_state_tried(t: float, x0: np.ndarray | None, p0: np.ndarray | None) -> tuple[TriedState, ...]:
    """The model's own start; () where a value is missing."""
    return () if x0 is None or p0 is None else (TriedState(t, x0, p0),)


# -------- shipped fmu -----------------------------------------------------------------------------------------
# An FMU as it is shipped -> check that its description gives every variable the meaning of its name.
#
# der(x) is the derivative of x; the derivatives of the states are all states' and nothing else; each state and
# parameter starts where it does in the model.


def fmu_reported(packed: bytes, states: Mapping[str, float], parameters: Mapping[str, float]) -> Check:
    """The description of variables.

    Args:
        states, parameters: where they start, by name; {} where the model has no start, or no values.
    """
    name = "the FMU's variables have the meaning of their names, and start as the model does"
    return attempted(name, "its description, read back", lambda: _wrong(_description(packed), states, parameters))


def _description(packed: bytes) -> str:
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        return archive.read("modelDescription.xml").decode()


def _wrong(text: str, states: Mapping[str, float], parameters: Mapping[str, float]) -> str:
    from xml.etree import ElementTree

    found = ElementTree.fromstring(text)
    variables = {v.get("valueReference"): v for v in found.iter("Float64")}
    named = {str(v.get("name")): v for v in variables.values()}
    if len(named) != len(variables):
        return "two variables have one name"
    rates = {reference: v for reference, v in variables.items() if v.get("derivative") is not None}
    for v in rates.values():
        of = variables.get(v.get("derivative"))
        if of is None or v.get("name") != f"der({of.get('name')})":
            return f"'{v.get('name')}' is said to be the derivative of '{'' if of is None else of.get('name')}'"
    listed = {each.get("valueReference") for each in found.iter("ContinuousStateDerivative")}
    if listed != set(rates):
        return "the derivatives that are listed are not those of the states"
    if not states and not parameters:
        raise NoValue("the model has no start")
    for name, right in (*states.items(), *parameters.items()):
        reported = named[name].get("start") if name in named else None
        if reported is None or abs(float(reported) - right) > tolerances.SOLVED * (1 + abs(right)):
            return f"'{name}' starts at {reported} for {right:.12g}"
    missing = [name for name in states if f"der({name})" not in named]
    return f"'{missing[0]}' has no derivative" if missing else ""
