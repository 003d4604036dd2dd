"""Model -> {name: Answer}: what the file asks in [outputs], exact and as a number.

A function of coordinates and rates is exact, the accelerations in it replaced by the equations of
motion. At an instant `t = ...` it is exact where the motion is given, else a number by integration.
What needs reactions, the energy theorem, events or linearization says so.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen.factorization import solved
from eomgen.codegen.program import right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import DerivationError, ExpressionError, MissingValues, NotYet, RunFailed
from eomgen.mechanics.assembly import Assembly, Row
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.freedom import redundant_rows
from eomgen.mechanics.outputs import Quantities, later
from eomgen.mechanics.scope import integral_from_zero
from eomgen.mechanics.system import System, system_of
from eomgen.mechanics.wellposed import refuse_massless
from eomgen.model.parts import Model, Output
from eomgen.model.values import exact_parameters, numeric_parameters, start_values
from eomgen.simulation.integrate import integrate
from eomgen.symbolic.derivative import depends_on, substituted, symbols_of
from eomgen.symbolic.evaluation import FLOAT, evaluate
from eomgen.symbolic.expressions import Call, Expression
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.normal_form import cancelled, readable
from eomgen.symbolic.text import text_size, to_text

LONGEST = 20_000  # characters of an exact answer
WORK = 50_000  # products of terms for making one readable
TOLERANCE = 1e-12  # of the integration to an instant


@dataclass(frozen=True)
class Answer:
    """One output's result.

    Args:
        exact: text of the grammar with every parameter as a symbol, or None.
        value: a number, parameters and start (or instant) put in, or None.
        unit: of both; "" for SI.
        method: how it was found.
        message: what is missing, or None.
    """

    exact: str | None = None
    value: float | None = None
    unit: str = ""
    method: str = ""
    message: str | None = None

    @property
    def answered(self) -> bool:
        return self.exact is not None or self.value is not None

    def as_dict(self) -> dict[str, Any]:
        """For `--json`."""
        return asdict(self)

    def _repr_markdown_(self) -> str:
        parts = [f"`{self.exact}`" if self.exact is not None else "", _number(self)]
        return " = ".join(part for part in parts if part) or (self.message or "")


def solve(model: Model) -> dict[str, Answer]:
    """Every output of the model, in its order; one that cannot be answered has its message.

    Raises:
        ModelError: an output needs accelerations and a free coordinate moves no mass.
    """
    solver = _Solver(model)
    return {name: solver.answer(output) for name, output in model.outputs.items()}


def table(answers: dict[str, Answer]) -> str:
    """The answers as text: exact, then the number and the way to it."""
    width = max((len(name) for name in answers), default=0)
    lines = []
    for name, answer in answers.items():
        first, *more = _lines(answer)
        lines.append(f"{name:<{width}}  {first}")
        lines += [f"{'':<{width}}  {line}" for line in more]
    return "".join(f"{line}\n" for line in lines)


def _lines(answer: Answer) -> list[str]:
    """One answer, a line for each thing that is known of it."""
    if not answer.answered:
        return [f"not answered: {answer.message}"]
    found = [f"= {part}" for part in (answer.exact, _number(answer)) if part]
    found[-1] += f"   [{answer.method}]"
    return [*found, f"({answer.message})"] if answer.message else found


def _number(answer: Answer) -> str:
    if answer.value is None:
        return ""
    shown = f"{answer.value:.10g}"
    return f"{shown} {answer.unit}" if answer.unit else shown


@dataclass(frozen=True)
class _Solver:
    """The equations of a model, made where an output asks for them."""

    model: Model

    @cached_property
    def system(self) -> System:
        return system_of(self.model)

    @cached_property
    def assembly(self) -> Assembly:
        assembly = recursive.assemble(self.system)
        refuse_massless(assembly)
        return assembly

    @cached_property
    def inputs(self) -> dict[str, Scalar]:
        """The model's own expression of each input."""
        return {name: self.system.scope.value(part.value) for name, part in self.model.inputs.items()}

    @cached_property
    def accelerations(self) -> Row:
        """a in q, u, t and inputs."""
        return explicit_accelerations(self.system, self.assembly)

    @cached_property
    def rhs(self) -> RightHandSide:
        return compiled(right_hand_side(self.assembly, self.inputs))

    def answer(self, output: Output) -> Answer:
        """One output; what goes wrong with it is its message."""
        unit = "" if output.unit is None else output.unit.text
        try:
            return replace(self._answer(output), unit=unit)
        except (DerivationError, RunFailed, ExpressionError, MissingValues) as error:
            return Answer(unit=unit, message=f"{error.what}; {error.mend}" if error.mend else error.what)

    def _answer(self, output: Output) -> Answer:
        _refuse_later(output)
        instant = None if output.at is None else _instant_of(output)
        scope = self.system.scope
        scalar = output.value.evaluate(scope.names, Quantities(self.system).value)
        if output.unit is not None:
            scalar = output.unit.from_si(scalar, scope.graph.pi)
        if instant is None:
            return self._function(scalar)
        return self._at(scalar, scope.value(instant), output)

    # -- functions of coordinates and rates ----------------------------------------------------

    def _function(self, scalar: Scalar) -> Answer:
        symbols = self.system.symbols
        if not depends_on(scalar, symbols.a):
            return self._started(readable(scalar, WORK), "kinematics" if symbols_of((scalar,)) else "arithmetic")
        (scalar,) = substituted((scalar,), dict(zip(symbols.a, self.accelerations, strict=True)))
        return self._started(cancelled(scalar, WORK), "equations of motion")

    def _started(self, scalar: Scalar, method: str) -> Answer:
        """The text, and the value at the start."""
        exact = to_text(scalar) if text_size(scalar) <= LONGEST else None
        message = None if exact is not None else f"the exact form is longer than {LONGEST} characters"
        try:
            return _valued(Answer(exact, None, "", method, message), self._at_start(scalar), "at the start")
        except MissingValues as error:
            return Answer(exact, None, "", method, error.what)

    def _at_start(self, scalar: Scalar) -> float:
        """The value at the start; what it does not depend on may be missing.

        Raises:
            MissingValues: a parameter that it needs has no value.
        """
        symbols = self.system.symbols
        (scalar,) = substituted((scalar,), {node: self.inputs[name] for name, node in symbols.inputs.items()})
        used = set(symbols_of((scalar,)))
        known = exact_parameters(self.model)
        missing = tuple(name for name, node in symbols.parameters.items() if node in used and name not in known)
        if missing:
            raise MissingValues(missing)
        state = {node: float(known[name]) for name, node in symbols.parameters.items() if name in known}
        state[symbols.t] = 0.0
        if used & {*symbols.q, *symbols.u}:
            q, u = start_values(self.model)
            state |= {node: (q | u)[node.name] for node in (*symbols.q, *symbols.u)}
        return evaluate((scalar,), state, FLOAT)[0]

    # -- at an instant -------------------------------------------------------------------------

    def _at(self, scalar: Scalar, instant: Scalar, output: Output) -> Answer:
        """At t = instant: exact where only given motions come in, else by integration."""
        symbols = self.system.symbols
        given = self._given(scalar)
        if given is not None:
            (exact,) = substituted((given,), {symbols.t: instant})
            return self._started(readable(exact, WORK), "given motion" if given is not scalar else "arithmetic")
        p = numeric_parameters(self.model)
        end = evaluate((instant,), {symbols.parameters[name]: value for name, value in p.items()}, FLOAT)[0]
        if not end >= 0:
            raise DerivationError(f"the instant t = {end:g} s is before the start")
        state = self._reached(end, p, output.from_ == "rest")
        return _valued(Answer(method="integration in time"), evaluate((scalar,), state, FLOAT)[0], "at the instant")

    def _given(self, scalar: Scalar) -> Scalar | None:
        """The scalar as a function of t and parameters alone; None where free motion, or no closed form, is in it."""
        symbols = self.system.symbols
        own = {node: self.inputs[name] for name, node in symbols.inputs.items()}
        (scalar,) = substituted((scalar,), own)
        if depends_on(scalar, (*symbols.u, *symbols.a)):
            return None
        laws: dict[Node, Scalar] = {}
        for node, rate in zip(symbols.q, self.system.scope.rates, strict=True):
            if not depends_on(scalar, (node,)):
                continue
            law = self._law(node, rate)
            if law is None:
                return None
            laws[node] = law
        return substituted((scalar,), laws)[0] if laws else scalar

    def _law(self, node: Node, rate: Scalar) -> Scalar | None:
        """q(t) of a driven coordinate in closed form."""
        coordinate, scope = self.model.coordinates[node.name], self.system.scope
        if coordinate.motion is not None:
            return scope.value(coordinate.motion)
        if not coordinate.driven:
            return None
        try:
            return scope.value(coordinate.start) + integral_from_zero(rate, scope.symbols.t, node.name)
        except DerivationError:
            return None

    def _reached(self, end: float, p: dict[str, float], from_rest: bool) -> dict[Node, float]:
        """Every symbol's value at t = end, by integrating from the start."""
        symbols, rhs = self.system.symbols, self.rhs
        q, u = start_values(self.model)
        speeds = [0.0 if from_rest else u[node.name] for node in symbols.u]
        x0, parameters = np.array([*(q[node.name] for node in symbols.q), *speeds]), np.array(list(p.values()))
        run = integrate(rhs, time=end, x0=x0, p=parameters, rtol=TOLERANCE, atol=TOLERANCE, samples=2 if end else None)
        if not run.ok:
            raise RunFailed(run.message)
        x = run.x[-1]
        state = {symbols.parameters[name]: value for name, value in p.items()} | {symbols.t: end}
        for name, node in symbols.inputs.items():
            state[node] = evaluate((self.inputs[name],), state, FLOAT)[0]
        a = rhs(end, x, parameters)[len(symbols.q) :]
        numbers = [float(value) for value in (*x, *a)]
        return state | dict(zip((*symbols.q, *symbols.u, *symbols.a), numbers, strict=True))


def explicit_accelerations(system: System, assembly: Assembly) -> Row:
    """a of M a = forcing + J^T lam, J a + gamma = 0, as expressions; redundant rows are left out.

    a = X F + X J^T lam,  (J X J^T) lam = -(gamma + J X F),  X = M^-1, never formed: M is solved for each column.
    """
    free = solved(assembly.M, assembly.forcing)
    if not assembly.J:
        return free
    dropped = {(row.tie, row.number) for row in redundant_rows(system.ties)}
    kept = [i for i, row in enumerate(system.ties.closing) if (row.tie, row.number) not in dropped]
    J = [assembly.J[i] for i in kept]
    columns = [solved(assembly.M, row) for row in J]
    S = [[_dot(row, column) for column in columns] for row in J]
    lam = solved(S, [-(assembly.gamma[i] + _dot(row, free)) for i, row in zip(kept, J, strict=True)])
    return tuple(a + _dot(lam, [column[k] for column in columns]) for k, a in enumerate(free))


def _dot(a: Any, b: Any) -> Scalar:
    return sum((x * y for x, y in zip(a, b, strict=True)), start=0)


def _valued(answer: Answer, value: float, where: str) -> Answer:
    if math.isfinite(value):
        return replace(answer, value=float(value) + 0.0)  # -0 is 0
    return replace(answer, message=f"it has no finite value {where}")


# -- what an output asks ---------------------------------------------------------------------------


def _refuse_later(output: Output) -> None:
    """Outputs that this version cannot answer.

    Raises:
        NotYet: one of their functions, or the way to their instant, comes later.
    """
    sides = [] if output.at is None else [output.at.left, output.at.right]
    for call in _calls((output.value, *sides)):
        if waits := later(call.name):
            raise NotYet(waits)
    if output.at is not None and _instant_of(output) is None:
        raise NotYet("an instant that is given by a condition comes with a later version")
    if output.at is None and output.from_ is not None:
        raise NotYet("the energy theorem, which gives rates as functions of coordinates, comes with a later version")


def _calls(expressions: tuple[Expression, ...]) -> Iterator[Call]:
    for expression in expressions:
        for call in expression.calls:
            yield call
            yield from _calls(tuple(a for a in call.args if isinstance(a, Expression)))


def _instant_of(output: Output) -> Expression | None:
    """e of `t = e` or `e = t`, e of parameters; None for any other condition."""
    assert output.at is not None
    left, right = output.at.left, output.at.right
    for t, e in ((left, right), (right, left)):
        if t.code == (("name", "t"),) and not e.calls and not any("'" in name for name in e.names):
            return e if "t" not in e.names else None
    return None
