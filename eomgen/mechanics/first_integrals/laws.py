"""Accelerations, start -> laws of motion: q(t) and u(t) in closed form, where there is one.

Coordinates are taken one after the other: as soon as all that the acceleration of one holds are t, itself, and others
whose laws are known, it is one equation in one unknown, and is solved where it is linear with constant coefficients; so
are pairs that have no damping. A coordinate whose rate is a known function of time is integrated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from random import Random

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.scope import integral_from_zero
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.first_integrals.coupled_motion import CoupledEquations, pair_solution
from eomgen.mechanics.first_integrals.linear_motion import LinearEquation, MotionConstants, law_of_motion
from eomgen.model.values import exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.exact.signs import sign_of_terms
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size
from eomgen.symbolic.solve.solving import vanishes

SEEN = 1e-3  # relative: a change that rounding does not make


def laws_of_motion(system: System, accelerations: Sequence[Scalar], start: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """q(t) and u(t) of every coordinate and speed that has a law in closed form.

    Args:
        accelerations: a as expressions of q, u, t and inputs.
        start: q and u at the start, scalars of the parameters; t where that is not 0.
    """
    return _Laws(system, start, system.scope.positive).found(tuple(accelerations))


@dataclass(frozen=True)
class _Laws:
    """The search for laws; inside it time counts from the start.

    Args:
        system, start: whose, and from where.
        positive: parameters that are positive.
    """

    system: System
    start: Mapping[Node, Scalar]
    positive: frozenset[Node]

    def found(self, accelerations: tuple[Scalar, ...]) -> dict[Node, Scalar]:
        """The laws, one after the other, as long as there is one."""
        symbols = self.system.symbols
        own = {node: self.system.inputs[name] for name, node in symbols.inputs.items()}
        begin = {symbols.t: symbols.t + self.start.get(symbols.t, 0)}
        speeds = dict(zip(symbols.u, self._replaced(accelerations, own, begin), strict=True))
        rates = dict(zip(symbols.q, self._replaced(self.system.scope.rates, own, begin), strict=True))
        laws: dict[Node, Scalar] = {}
        while new := self._by_rate(rates, laws) or self._by_line(speeds, laws) or self._by_pair(speeds, laws):
            laws |= {
                node: min(law, simplest(law, Work.VALUE, self.positive), key=text_size) for node, law in new.items()
            }
            speeds = {u: a for u, a in speeds.items() if u not in laws}
            rates = {q: rate for q, rate in rates.items() if q not in laws}
        later = {symbols.t: symbols.t - self.start.get(symbols.t, 0)}
        return {node: substituted((law,), later)[0] for node, law in laws.items()}

    def _replaced(self, scalars: tuple[Scalar, ...], *each: Mapping[Node, Scalar]) -> tuple[Scalar, ...]:
        for replacements in each:
            scalars = substituted(scalars, replacements)
        return scalars

    def _by_rate(self, rates: Mapping[Node, Scalar], laws: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """A coordinate whose rate is a known function of time: driven, or dependent on known ones."""
        for q, rate in rates.items():
            (rate,) = substituted((rate,), laws)
            if depends_on(rate, self._moving):
                continue
            try:
                return {q: self.start[q] + integral_from_zero(rate, self.system.symbols.t, q.name)}
            except DerivationError:
                continue
        return {}

    def _by_line(self, speeds: Mapping[Node, Scalar], laws: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """A coordinate with a linear equation of its own."""
        for u, a in speeds.items():
            q = self._coordinate(u)
            line = None if q is None or q in laws else self._line(substituted((a,), laws)[0], q, u)
            if q is None or line is None:
                continue
            law = law_of_motion(line, self.start[q], self.start[u], self._constants)
            if law is not None:
                return {q: law, u: derivative(law, self.system.symbols.t)}
        return {}

    def _by_pair(self, speeds: Mapping[Node, Scalar], laws: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
        """Two coordinates with linear equations of their own."""
        for two in combinations(speeds, 2):
            q = [x for u in two if (x := self._coordinate(u)) is not None]
            if len(q) < 2:
                continue
            a = substituted([speeds[u] for u in two], laws)
            pair = self._pair(a, q, two)
            if pair is None:
                continue
            law = pair_solution(pair, [self.start[x] for x in q], [self.start[u] for u in two], self._constants)
            if law is not None:
                rates = (derivative(x, self.system.symbols.t) for x in law)
                return dict(zip((*q, *two), (*law, *rates), strict=True))
        return {}

    def _line(self, a: Scalar, q: Node, u: Node) -> LinearEquation | None:
        """a as A q + B u + f(t) with constants A and B, or None."""
        A, B = derivative(a, q), derivative(a, u)
        if self._vary([[A], [B], [a, -A * q, -B * u]]):
            return None
        a = simplest(a, Work.VALUE, self.positive)
        A, B = derivative(a, q), derivative(a, u)
        if any(depends_on(x, (*self._moving, self.system.symbols.t)) for x in (A, B)):
            return None
        f = simplest(a - A * q - B * u, Work.VALUE, self.positive)
        return None if depends_on(f, self._moving) else LinearEquation(A, B, f)

    def _pair(self, a: Sequence[Scalar], q: Sequence[Node], u: Sequence[Node]) -> CoupledEquations | None:
        """a as A q + B u + b with constants, or None."""
        slopes = [[derivative(x, y) for y in (*q, *u)] for x in a]
        rests = [[x, *(-k * y for k, y in zip(row, (*q, *u), strict=True))] for x, row in zip(a, slopes, strict=True)]
        if self._vary([*([k] for row in slopes for k in row), *rests]):
            return None
        a = tuple(simplest(x, Work.VALUE, self.positive) for x in a)
        A, B = ([[derivative(x, y) for y in of] for x in a] for of in (q, u))
        rest = [x - sum(derivative(x, y) * y for y in (*q, *u)) for x in a]
        b = [simplest(x, Work.VALUE, self.positive) for x in rest]
        constants = (*A[0], *A[1], *B[0], *B[1], *b)
        return (
            None
            if any(depends_on(x, (*self._moving, self.system.symbols.t)) for x in constants)
            else CoupledEquations(A, B, b)
        )

    def _vary(self, sums: Sequence[Sequence[Scalar]]) -> bool:
        """Whether numbers at two states show that one of the sums of terms changes with what moves."""
        rng = Random(1)
        terms = [x for each in sums for x in each]
        fixed = {x: rng.uniform(0.5, 1.5) for x in symbols_of(terms) if x not in self._moving}
        states = [fixed | {x: rng.uniform(0.3, 1.1) for x in self._moving} for _ in range(2)]
        try:
            one, other = (iter(evaluate(terms, state, FLOAT)) for state in states)
        except (NoValue, ZeroDivisionError):
            return False
        for each in sums:
            pairs = [(next(one), next(other)) for _ in each]
            if abs(sum(x - y for x, y in pairs)) > SEEN * max(max(abs(x), abs(y)) for x, y in pairs):
                return True
        return False

    def _coordinate(self, u: Node) -> Node | None:
        """The coordinate whose rate the speed is."""
        rates = zip(self.system.symbols.q, self.system.scope.rates, strict=True)
        return next((q for q, rate in rates if rate is u), None)

    @property
    def _moving(self) -> tuple[Node, ...]:
        return (*self.system.symbols.q, *self.system.symbols.u)

    @property
    def _constants(self) -> MotionConstants:
        return MotionConstants(self.system.symbols.t, self._sign, lambda x: simplest(x, Work.VALUE, self.positive))

    def _sign(self, x: Scalar) -> int | None:
        """The sign of a constant: of its value, or the one that all of its terms have."""
        if type(x) is not Node:
            return (x > 0) - (x < 0)
        if vanishes(x):
            return 0
        values = exact_parameters(self.system.scope.model)
        parameters = self.system.symbols.parameters
        known = {node: float(values[name]) for name, node in parameters.items() if name in values}
        if any(symbol not in known for symbol in symbols_of((x,))):
            return sign_of_terms(x, self.positive)
        value = evaluate((x,), known, FLOAT)[0]
        return int(value > 0) - int(value < 0)
