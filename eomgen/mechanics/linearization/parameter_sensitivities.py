"""SmallMotions, a parameter -> derivatives of the reference and of the equations of small motions with respect to it.

The laws are those of the numbers, over values that carry their slopes: y + y_p dp. Of an equilibrium

    Z^T (M a - forcing) = 0,   G = 0:   K dq_i + d/dp Z^T (M a - forcing) = 0,   q' = P dq_i + the part due to G_p

(of states of first order z' = 0 beside it)

and of a simple eigenvalue, with A r = lambda r and l^H A = lambda l^H,

    d lambda/dp = l^H (dA/dp) r / l^H r.

Source: Lancaster, On eigenvalues of matrices dependent on a parameter, Numer. Math. 6 (1964) 377-387.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.linearization.linearization import SmallMotions
from eomgen.mechanics.linearization.reduction import LinearEquations, Reducing, floats
from eomgen.mechanics.linearization.reference import ReferenceMotion
from eomgen.mechanics.start import Seeds
from eomgen.mechanics.state import NumberField, Numbers
from eomgen.symbolic.expression import Fraction, Node, Scalar, jacobian, tangent
from eomgen.symbolic.numeric import evaluate, fifty_digits, floats_of, tolerances


@dataclass(frozen=True, eq=False)
class Sloped:
    """A number and its slope; two of them are never equal, so that none is taken for 0."""

    value: float
    slope: float = 0.0

    def __add__(self, other: Any) -> Sloped:
        other = sloped(other)
        return Sloped(self.value + other.value, self.slope + other.slope)

    __radd__ = __add__

    def __neg__(self) -> Sloped:
        return Sloped(-self.value, -self.slope)

    def __sub__(self, other: Any) -> Sloped:
        other = sloped(other)
        return Sloped(self.value - other.value, self.slope - other.slope)

    def __rsub__(self, other: Any) -> Sloped:
        other = sloped(other)
        return Sloped(other.value - self.value, other.slope - self.slope)

    def __mul__(self, other: Any) -> Sloped:
        other = sloped(other)
        return Sloped(self.value * other.value, self.slope * other.value + self.value * other.slope)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Sloped:
        other = sloped(other)
        value: float = self.value / other.value
        return Sloped(value, (self.slope - value * other.slope) / other.value)

    def __rtruediv__(self, other: Any) -> Sloped:
        found: Sloped = sloped(other) / self
        return found

    def __float__(self) -> float:
        return self.value


def sloped(x: Any) -> Sloped:
    """A number with its slope; of a plain one 0."""
    return x if isinstance(x, Sloped) else Sloped(float(x))


def slopes_in(A: Sequence[Sequence[Any]]) -> np.ndarray:
    """The slopes of the entries, rows x columns."""
    return np.array([[sloped(x).slope for x in row] for row in A]).reshape(len(A), -1)


@dataclass(frozen=True)
class WithSlopes(NumberField):
    """Numbers with their slopes.

    Args:
        state: values of all symbols, with 50 digits.
        seeds: the slopes of symbols that have one.
    """

    state: Mapping[Node, Any]
    seeds: Seeds = field(default_factory=dict)

    def of(self, scalars: Iterable[Scalar]) -> list[Any]:
        scalars = tuple(scalars)
        found = floats_of(evaluate((*scalars, *tangent(scalars, self.seeds)), self.state, fifty_digits()))
        pairs = zip(scalars, found[: len(scalars)], found[len(scalars) :], strict=True)
        return [x if type(x) is not Node else Sloped(value, slope) for x, value, slope in pairs]

    def with_values(self, more: Mapping[Node, Any]) -> WithSlopes:
        known = {node: sloped(x) for node, x in more.items()}
        number = fifty_digits().number
        state = {**self.state, **{node: number(x.value) for node, x in known.items()}}
        return WithSlopes(state, {**self.seeds, **{node: Fraction(x.slope) for node, x in known.items()}})


@dataclass(frozen=True)
class ParameterSlopes:
    """Derivatives of the reference and of the matrices with respect to a parameter.

    Args:
        small: the small motions; all parameters have values.
        parameters: the direction in which the parameters change.
    """

    small: SmallMotions
    parameters: Seeds

    @property
    def _reference(self) -> ReferenceMotion:
        return self.small.reference

    @cached_property
    def state(self) -> dict[Node, float]:
        """Derivatives of q, u and z of the reference.

        Raises:
            DerivationError: the place does not change smoothly, or a steady motion has no closed form.
        """
        reference = self._reference
        symbols = reference.system.symbols
        if reference.about_equilibrium and not reference.moving:
            found = dict(zip(symbols.places, self._rest().tolist(), strict=True))
            return found | dict.fromkeys(symbols.u, 0.0)
        if not reference.is_exact:
            raise DerivationError(
                "a steady motion without a closed form has no exact slope by a parameter",
                fix="take a sweep over the parameter",
            )
        nodes = symbols.x
        rates = tangent(tuple(reference.exact[x] for x in nodes), self.parameters)
        return dict(zip(nodes, floats_of(evaluate(rates, reference.numbers, fifty_digits())), strict=True))

    @property
    def seeds(self) -> dict[Node, Scalar]:
        """The slopes of all symbols at the reference: of inputs, too, that hold the parameter."""
        found = dict(self.parameters) | {x: Fraction(slope) for x, slope in self.state.items()}
        return found | _of_inputs(self._reference, found)

    def _rest(self) -> np.ndarray:
        first, reference, choice = self.small.first, self._reference, self.small.choice
        here: dict[Node, Scalar] = dict(self.parameters)
        here |= _of_inputs(reference, here)
        aside = np.zeros(len(reference.system.symbols.q))
        if choice.places.rows:
            part = WithSlopes(reference.numbers, here)
            requested = part.of([first.relations[i] for i in choice.places.rows if i < len(first.relations)])
            numbers = Numbers(reference.numbers)
            rows = numbers.matrix([first.derivatives["G"][i] for i in choice.places.rows])
            pushed = [[sloped(x).slope] for x in requested] + [[0.0]] * (len(choice.places.rows) - len(requested))
            G_d = [[row[k] for k in choice.places.following] for row in rows]
            aside[list(choice.places.following)] = floats(numbers.solution(G_d, numbers.negative(pushed)))[:, 0]
        symbols, rates = reference.system.symbols, reference.system.scope.state_rates
        moved = {x: Fraction(slope) for x, slope in zip(symbols.q, aside.tolist(), strict=True)}
        left = slopes_in([Reducing(first, choice, WithSlopes(reference.numbers, here | moved)).at.unbalanced])[0]
        reducing = Reducing(first, choice, Numbers(reference.numbers))
        e = reducing.equations
        K = floats(e.K)
        if rates:
            still = Numbers({**reference.numbers, **dict.fromkeys(symbols.a, fifty_digits().number(0))})
            Z = still.array(jacobian(rates, symbols.places), len(symbols.places))
            K = np.vstack([K, Z @ floats(e.P)])
            left = np.append(left, still.of(tangent(rates, here | moved)))
            aside = np.append(aside, np.zeros(len(symbols.z)))
        step = -np.linalg.lstsq(K, left, rcond=tolerances.RANK)[0]
        if np.max(abs(K @ step + left), initial=0.0) > tolerances.CARRIED * np.max(abs(left), initial=0.0):
            raise DerivationError(
                "the equilibrium ends, or forks, at these values: it has no slope",
                fix="take other values of the parameters",
            )
        found = aside + floats(e.P) @ step
        return np.where(abs(found) < tolerances.COORDINATE_AT_50, 0.0, found)

    @cached_property
    def equations(self) -> LinearEquations:
        """M, C, K, ... of the small motions with their slopes."""
        return self.small.over(WithSlopes(self._reference.numbers, self.seeds))

    def entry(self, function: str, row: int, column: int) -> Sloped:
        """An entry of the matrix of an output function: mass, damping or stiffness."""
        return sloped(self.equations.matrix(function)[row][column])

    @cached_property
    def state_matrix(self) -> tuple[np.ndarray, np.ndarray]:
        """(A, dA/dp) of x' = A x."""
        e, none = self.equations, WithSlopes({})
        below = [[*(-x for x in k), *(-x for x in c)] for k, c in zip(e.K, e.C, strict=True)]
        lower = none.solution(e.M, below)
        upper = [[*f, *x] for f, x in zip(e.F, e.E, strict=True)]
        return floats([[float(x) for x in row] for row in (*upper, *lower)]), slopes_in([*upper, *lower])

    def eigenvalue(self, near: complex) -> complex:
        """d lambda/dp of the eigenvalue that is nearest.

        Raises:
            DerivationError: it is not simple: several eigenvalues go their own ways from there.
        """
        import scipy.linalg

        A, change = self.state_matrix
        values, left, right = scipy.linalg.eig(A, left=True, right=True)
        k = int(np.argmin(abs(values - near)))
        l, r = left[:, k].conj(), right[:, k]
        if (
            abs(l @ r) < tolerances.NEARLY_SINGULAR
            or np.sum(abs(values - values[k]) <= tolerances.NEARLY_SINGULAR * abs(values[k])) > 1
        ):
            raise DerivationError(
                "several motions have this frequency: each changes in its own way",
                fix="take values at which they differ",
            )
        return complex(l @ change @ r / (l @ r))


def _of_inputs(reference: ReferenceMotion, seeds: Seeds) -> dict[Node, Scalar]:
    """Derivatives of the inputs."""
    system = reference.system
    inputs = [(node, system.inputs[name]) for name, node in system.symbols.inputs.items()]
    changes = tangent(tuple(value for _, value in inputs), seeds)
    numbers = floats_of(evaluate(changes, reference.numbers, fifty_digits()))
    return {node: Fraction(x) for (node, _), x in zip(inputs, numbers, strict=True)}
