"""Small motions -> their responses: to inputs, as state space and transfer functions; to changes of a parameter."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.linearization.linearization import SmallMotions
from eomgen.mechanics.linearization.reduction import LinearEquations, Reducing, floats
from eomgen.mechanics.linearization.reference import ReferenceMotion
from eomgen.mechanics.start import Seeds
from eomgen.mechanics.state import Entries, Exact, NumberField, Numbers
from eomgen.symbolic.exact import Polynomial, cramer
from eomgen.symbolic.expression import Fraction, Node, Scalar, is_zero, jacobian, operations, tangent
from eomgen.symbolic.numeric import evaluate, fifty_digits, floats_of, tolerances

# -------- transfer --------------------------------------------------------------------------------------------
# LinearEquations with inputs -> transfer functions, exact by Cramer's rule, or in floats.


@dataclass(frozen=True)
class TransferFunction:
    """q/w = above(s)/below(s), of one coordinate and one input."""

    coordinate: Node
    input: Node
    above: Polynomial
    below: Polynomial


def transfer_functions(
    e: LinearEquations, positive: Collection[Node], trial: Mapping[Node, Any]
) -> tuple[TransferFunction, ...]:
    """Transfer functions from every input to every coordinate, by Cramer's rule; () where it is too much work.

    Args:
        trial: values of the parameters, at which the leading coefficient below is positive, as det M is.
    """
    s = e.laplace_variable
    pencil = e.pencil(s) if e.inputs else None
    if pencil is None:
        return ()
    below = Polynomial.of(cramer.determinant(pencil), s, positive)
    right = [*(e.D if len(pencil) > len(e.B) else ()), *e.B]
    found = []
    for k, w in enumerate(e.inputs):
        for j, q in enumerate(e.coordinates):
            column = [[right[i][k] if m == j else x for m, x in enumerate(row)] for i, row in enumerate(pencil)]
            above = Polynomial.of(cramer.determinant(column), s, positive)
            if above is None or below is None:
                return ()
            found.append(TransferFunction(q, w, *_shortened(above, below, s, positive, trial)))
    return tuple(found)


def _shortened(
    above: Polynomial, below: Polynomial, s: Node, positive: Collection[Node], trial: Mapping[Node, Any]
) -> tuple[Polynomial, Polynomial]:
    """Numerator and denominator without common factors; only powers of s are cancelled where it is too much work."""
    a, b = list(above.coefficients), list(below.coefficients)
    while len(a) > 1 and len(b) > 1 and is_zero(a[0]) and is_zero(b[0]):
        a, b = a[1:], b[1:]
    plain = Polynomial(tuple(a)), Polynomial(tuple(b))
    found = plain[0].over(plain[1], s, positive)
    if found is None:
        return plain
    upper, lower = found
    leading = evaluate((lower.coefficients[-1],), trial, fifty_digits())[0]
    return (upper, lower) if leading > 0 else (upper.negative(positive), lower.negative(positive))


def transfers_in_numbers(e: LinearEquations, A: np.ndarray, B: np.ndarray) -> tuple[TransferFunction, ...]:
    """The same of x' = A x + B w in floats, x = (q, ...): det(s 1 - A + b c) = det(s 1 - A) (1 + c (s 1 - A)^-1 b)."""
    below = np.poly(A)
    found = []
    for k, w in enumerate(e.inputs):
        for j, q in enumerate(e.coordinates):
            coupled = A.copy()
            coupled[:, j] -= B[:, k]
            closed = np.poly(coupled)
            above = np.where(
                abs(closed - below) > tolerances.ITERATED * (abs(closed) + abs(below)), closed - below, 0.0
            )
            found.append(TransferFunction(q, w, *map(_of_floats, (np.trim_zeros(above, "f"), below))))
    return tuple(found)


def _of_floats(highest_first: np.ndarray) -> Polynomial:
    return Polynomial(tuple(float(c) for c in reversed(highest_first)) or (0.0,))


# -------- state space -----------------------------------------------------------------------------------------
# Small motions -> their state space, x' = A x + B w, y = C_y x + D_y w, exact where that is little work.
#
# x = (dq_i, du_i),   A = [F, E; -M^-1 K, -M^-1 C],   B = [D; M^-1 B_w];   for users x = (dq_i, du_i, dz)


MOST = 4  # speeds of a state space that is written exactly
MOST_OPERATIONS = 120  # of the entries of M, C, K and B before they are solved


@dataclass(frozen=True)
class StateMatrices:
    """A, B, C_y, D_y as rows, of scalars of the parameters or of floats.

    Args:
        states, inputs, outputs: what their rows and columns belong to.
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    A: Entries
    B: Entries
    C_y: Entries
    D_y: Entries

    @staticmethod
    def exact(small: SmallMotions, outputs: Sequence[str]) -> StateMatrices | None:
        """State-space matrices in scalars of the parameters; None where unknown in closed form, or too much work."""
        e = small.exact
        if e is None or len(e.speeds) > MOST:
            return None
        right = [[*k, *c, *b] for k, c, b in zip(e.K, e.C, e.B, strict=True)]
        if operations(x for row in (*e.M, *right) for x in row).total > MOST_OPERATIONS:
            return None
        reference = small.reference
        field = Exact({}, reference.system.scope.positive, reference.trial)
        solved = field.solution(e.M, right)
        width = len(e.coordinates) + len(e.speeds)
        A = [[*f, *g] for f, g in zip(e.F, e.E, strict=True)] + [
            [field.tidy(-x) for x in row[:width]] for row in solved
        ]
        B: Entries = [*([*row] for row in e.D), *(row[width:] for row in solved)]
        return StateMatrices.of(e, A, B, outputs)

    @staticmethod
    def of(e: LinearEquations, A: Entries, B: Entries, outputs: Sequence[str]) -> StateMatrices:
        """The state space whose outputs are states, or rates of them.

        Args:
            A, B: rows and columns in the order of the coordinates, states and speeds of the equations.
            outputs: names of coordinates, speeds, or their derivatives: theta, theta', theta''.
        Raises:
            UsageError: another name.
        """
        A = [[A[i][j] for j in e.order] for i in e.order]
        B = [B[i] for i in e.order]
        states = tuple(x.name for x in e.moving)
        rows = [_output(name, states, A, B) for name in outputs]
        C_y, D_y = [row for row, _ in rows], [through for _, through in rows]
        return StateMatrices(states, tuple(w.name for w in e.inputs), tuple(outputs), A, B, C_y, D_y)


def _output(name: str, states: tuple[str, ...], A: Entries, B: Entries) -> tuple[list[object], list[object]]:
    """(its row of C_y, its row of D_y): a state by itself, the rate of one by the equations."""
    if name in states:
        return [int(x == name) for x in states], [0 for _ in B[0]] if B else []
    if name.endswith("'") and name[:-1] in states:
        k = states.index(name[:-1])
        return list(A[k]), list(B[k])
    raise UsageError(f"no output '{name}' of small motions", fix=f"{', '.join(states)}, or the rate of one of them")


# -------- parameter sensitivities ------------------------------------------------------------------------------
# SmallMotions, a parameter -> derivatives of the reference and of the equations of small motions with respect to it.
#
# The laws are those of the numbers, over values that carry their slopes: y + y_p dp. Of an equilibrium
#
#     Z^T (M a - forcing) = 0,   G = 0:   K dq_i + d/dp Z^T (M a - forcing) = 0,   q' = P dq_i + the part due to G_p
#
# (of states of first order z' = 0 beside it)
#
# and of a simple eigenvalue, with A r = lambda r and l^H A = lambda l^H,
#
#     d lambda/dp = l^H (dA/dp) r / l^H r.
#
# Source: Lancaster, On eigenvalues of matrices dependent on a parameter, Numer. Math. 6 (1964) 377-387.


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
