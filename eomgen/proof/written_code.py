"""Files of generated code -> checks: the very text that is written is run and held against the symbols."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from eomgen.codegen.program import Program
from eomgen.codegen.rhs import target_named
from eomgen.codegen.targets.base import RHS, FileContent, Role, TestVector
from eomgen.errors import RunFailed, TextRefused, ToolMissing
from eomgen.mechanics.bodies.armature import joint_row
from eomgen.mechanics.equations.accelerations import accelerations_at
from eomgen.mechanics.equations.system import System
from eomgen.proof import emitted_code
from eomgen.proof.check import Check, checked, unchecked
from eomgen.proof.emitted_code import Code, PhaseMotion, RunNumbers, TriedState
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import CARRIED, COMPUTED, SEVEN_DIGITS

LITERAL = re.compile(r"(?<![\w.])(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?")  # a number of any language, without its sign
MOST_TOLERANCE = 10 * COMPUTED  # that a test vector may allow


@dataclass(frozen=True)
class Written:
    """One function of generated code.

    Args:
        target: name of the language.
        texts: its files, {path: content}.
        program, stem, role: what was written, under which names.
        vectors: the states of its test vectors.
    """

    target: str
    texts: Mapping[str, FileContent]
    program: Program
    stem: str
    role: Role
    vectors: tuple[TestVector, ...]

    @property
    def name(self) -> str:
        return f"{self.role.main(self.stem)} in {self.target}"

    @property
    def instants(self) -> tuple[TriedState, ...]:
        """The states of the vectors."""
        inputs = tuple(self.program.symbols.inputs)
        return tuple(
            TriedState(
                v.t, np.array(v.x), v.p, dict(zip(inputs, v.inputs, strict=True)) if v.inputs else {}, np.array(v.a)
            )
            for v in self.vectors
        )

    def code(self) -> Code | None:
        """The function as it is written; None where nothing runs the language.

        Raises:
            ToolMissing, RunFailed: its compiler is not there, or refuses it.
        """
        run = target_named(self.target).run
        if run is None:
            return None
        called, inputs = run(self.texts, self.program, self.stem, self.role), tuple(self.program.symbols.inputs)

        def at(instant: TriedState) -> np.ndarray:
            given = [instant.inputs[name] for name in inputs] if inputs and instant.inputs else None
            return np.array(called(instant.t, instant.x.tolist(), instant.a.tolist(), list(instant.p), given))

        return at


def unwritten(texts: Mapping[str, FileContent], vectors: Iterable[TestVector]) -> Iterator[Check]:
    """A contradiction where a number of test vectors stands in no self-test of a language; else nothing.

    A number is found wherever one like it to the digits of floats stands, in any language's form.
    """
    tests = [text for name, text in texts.items() if isinstance(text, str) and _is_test(name, text)]
    tests += [
        x for name, x in texts.items() if isinstance(x, str) and any(name in text for text in tests)
    ]  # read there
    told = np.array(sorted({0.0, *(float(x.lower().replace("d", "e")) for x in LITERAL.findall("\n".join(tests)))}))
    for v in vectors if tests else ():
        numbers = np.array([v.t, *v.x, *v.a, *v.p, *(v.inputs or ()), *v.result])
        numbers = np.abs(numbers[np.isfinite(numbers)])
        k = np.clip(np.searchsorted(told, numbers), 1, max(len(told) - 1, 1))
        apart = np.min(np.abs(np.take(told, [k, k - 1], mode="clip") - numbers), axis=0)
        missing = numbers[(apart > SEVEN_DIGITS * numbers) & (numbers > np.finfo(np.float32).tiny)]
        if len(missing):
            what = f"{missing[0]:.9g} at t = {v.t:.6g} s is not written"
            yield checked("test vectors stand in the self-tests of the code", what, "numbers of their texts")
            return


def _is_test(name: str, text: str) -> bool:
    """Whether a file is a self-test, or has one at its end, as those of C."""
    last = name.rpartition("/")[2]
    return not last.endswith((".json", ".md")) and ("test" in name or (last.endswith(".c") and "vectors[] = {" in text))


@dataclass(frozen=True)
class Judged:
    """What a function of generated code is held against.

    Args:
        motion: the equations of motion.
        values: of the role "reactions": its outputs by name, in q, u and a.
        actuators: of the role "inverse": what its outputs act along.
        slopes: of the role "jacobian": (t, x, p, inputs) -> (A, B), solved for in numbers.
        parameters: of the role "regressor": pi, the columns of the first block of `values`; the second is y0.
    """

    motion: PhaseMotion
    values: Mapping[str, Scalar]
    actuators: Sequence[str] = ()
    slopes: Callable[..., tuple[np.ndarray, np.ndarray]] | None = None
    parameters: ScalarRow | None = None

    def check(self, written: Written, start: Sequence[TriedState]) -> Check:
        """The written function at the start and at the states of its test vectors."""
        name = f"{written.name} gives the symbols' numbers"
        try:
            code = written.code()
        except TextRefused as error:
            return checked(name, error.what, "run")
        except (ToolMissing, RunFailed) as error:
            return unchecked(name, error.what, "run")
        if code is None:
            return unchecked(name, f"nothing here runs {written.target}", "run")
        if self.parameters is not None:
            return self._regressor(code, written.instants, name, self.parameters)
        if self.actuators:
            return self._inverse(code, written.instants, name)
        return self._by_symbols(written, code, start, name)

    def shipped(self, written: Written) -> Check | None:
        """The test vectors that are written beside it; None of those that are given accelerations."""
        if not written.vectors or self.actuators or self.parameters is not None:
            return None
        name = f"the test vectors of {written.role.main(written.stem)} are the symbols' numbers"
        wide = [v for v in written.vectors if not 0 < v.tolerance <= MOST_TOLERANCE]
        if wide:
            return checked(name, f"a tolerance of {wide[0].tolerance:.2g} at t = {wide[0].t:.6g} s", "as written")

        def told(at: TriedState) -> np.ndarray:
            nearest = min(written.vectors, key=lambda v: abs(v.t - at.t) + np.abs(np.array(v.x) - at.x).max(initial=0))
            return np.array(nearest.result)

        return self._by_symbols(written, told, (), name)

    def _by_symbols(self, written: Written, code: Code, start: Sequence[TriedState], name: str) -> Check:
        """What is given at a state, against the symbols there."""
        if written.role is RHS:
            return emitted_code.equations_hold(self.motion, code, (*start, *written.instants), name)
        if self.slopes is not None:
            return self._slopes(code, written.instants, name, self.slopes)
        return emitted_code.values_agree(
            name, self.motion, self.values, code, (*start, *written.instants), self._accelerations
        )

    def _slopes(self, code: Code, at: Iterable[TriedState], name: str, slopes: Callable[..., Any]) -> Check:
        """A and B against the linearized equations, solved in doubles at the same states."""

        def wrong(instant: TriedState) -> str | None:
            inputs = [instant.inputs[name] for name in self.motion.equations.symbols.inputs] if instant.inputs else None
            right = np.concatenate([x.ravel() for x in slopes(instant.t, instant.x, instant.p, inputs)])
            known = np.isfinite(right)
            if not np.any(known):
                return None
            apart = np.max(np.abs(code(instant) - right)[known]) / (1 + np.max(np.abs(right[known])))
            return "" if apart <= CARRIED else f"a slope is off by {apart:.1e} at t = {instant.t:.6g} s"

        how = "the linearized equations solved in numbers"
        return emitted_code.at_states(name, how, at, wrong, cost=len(order(self.motion.scalars)))

    def _regressor(self, code: Code, at: Iterable[TriedState], name: str, pi: ScalarRow) -> Check:
        """Every entry against the symbols; and Y pi + y0 put into the equations without inputs, as what pushes."""
        e = self.motion.equations
        still, size, entries = dict.fromkeys(e.symbols.inputs, 0.0), len(e.symbols.u), tuple(self.values.values())

        def wrong(instant: TriedState) -> str | None:
            a = self._allowed(instant)
            found, unmoved = code(replace(instant, a=a)), replace(instant, inputs=still)
            values = {**self.motion.values(unmoved), **dict(zip(e.symbols.a, map(float, a), strict=True))}
            right = np.array([float(x) for x in evaluate((*entries, *pi), values, fifty_digits())])
            apart = np.max(np.abs(found - right[: len(entries)]), initial=0) / (1 + np.max(np.abs(right), initial=0))
            if not apart <= COMPUTED:
                return f"an entry is off by {apart:.1e} at t = {instant.t:.6g} s"
            Y, y0 = found[: size * len(pi)].reshape(size, -1), found[size * len(pi) :][:size]
            return _left(self.motion.numbers(unmoved), instant.t, a, Y @ right[len(entries) :] + y0)

        how = "symbols with 50 digits; Y pi + y0 put into the equations"
        return emitted_code.at_states(name, how, at, wrong, cost=len(order(self.motion.scalars)))

    def _allowed(self, at: TriedState) -> np.ndarray:
        """The accelerations of a state, the nearest that J a + gamma = 0 allows."""
        free = self.motion.numbers(at)
        away = np.linalg.lstsq(free.J, free.J @ at.a + free.gamma, rcond=COMPUTED)[0] if len(free.J) else 0.0
        return np.asarray(at.a - away)

    def _accelerations(self, at: TriedState) -> Mapping[Node, float]:
        """a by dense linear algebra.

        Raises:
            NoValue: redundant ties contradict one another at the state.
        """
        self.motion.numbers(at).refuse_contradiction()
        found = accelerations_at(self.motion.equations, self.motion.values(at))
        return dict(zip(self.motion.equations.symbols.a, found.tolist(), strict=True))

    def _inverse(self, code: Code, at: Iterable[TriedState], name: str) -> Check:
        """tau put back as forces and inputs: M a - J^T lam = forcing(tau) + columns tau, with J a + gamma = 0."""
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
        return emitted_code.at_states(name, how, at, wrong, cost=len(order(self.motion.scalars)))


def _left(numbers: RunNumbers, t: float, a: np.ndarray, push: np.ndarray) -> str:
    left = numbers.left_of_forces(a, push)
    return "" if left <= COMPUTED else f"M a + c = Q is left with {left:.1e} of its terms at t = {t:.6g} s"


def acting(system: System, name: str) -> tuple[Scalar, ...]:
    """The generalized forces of a unit force along a coordinate or a speed, or in a body's joint."""
    symbols = system.symbols
    if name in [u.name for u in symbols.u]:
        return tuple(int(u.name == name) for u in symbols.u)
    if name in [q.name for q in symbols.q]:
        return tuple(system.scope.N[[q.name for q in symbols.q].index(name)])
    row = joint_row(system.motion, name, 0)
    return tuple(row.get(k, 0) for k in range(len(symbols.u)))


def start_state_tried(t: float, x0: np.ndarray | None, p0: np.ndarray | None) -> tuple[TriedState, ...]:
    """The model's own start; () where a value is missing."""
    return () if x0 is None or p0 is None else (TriedState(t, x0, p0),)
