"""An equilibrium -> the verdict on its stability."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.equilibrium.equations import StaticEquations
from eomgen.mechanics.equilibrium.places import place_near
from eomgen.mechanics.state import Split
from eomgen.symbolic.exact import LinearSystem, cramer, readable, sign_of_terms, simplest, vanishes
from eomgen.symbolic.expression import Node, Scalar, gradient, is_zero, jacobian, substituted
from eomgen.symbolic.numeric import (
    NoValue,
    Work,
    balanced,
    dense,
    evaluate,
    fifty_digits,
    rank,
    tolerances,
    without_noise,
)

# -------- stability -------------------------------------------------------------------------------------------
# An equilibrium -> whether it is stable: the second variation of the potential energy along the constraints.
#
#     K = Z^T H Z,   H = -d(Q + J^T lam)/dq,   J Z = 0
#
# H is d2V/dq2 - sum lam d2phi/dq2 where all forces have a potential. K > 0: V has a minimum there, and the place is
# stable (Lagrange and Dirichlet); a negative direction: it is unstable. With one degree of freedom and K = 0, the next
# derivatives decide. With several, and forces without a potential, K has another meaning and decides nothing.


MOST_EXACT = 6  # degrees of freedom of a K that is written exactly

StiffnessRows = tuple[tuple[Any, ...], ...]
"""Of scalars, or of floats where they are not known exactly."""


@dataclass(frozen=True)
class Stability:
    """Verdict on the stability of an equilibrium, with its reason.

    Args:
        kind: "stable", "unstable", "indifferent", "depends on the parameters", "undecided" or "no potential energy".
        why: the reason in words.
        along: the coordinates whose variations are free; the others follow by the constraints.
        K: second variation, exact where the place is exact, else numbers; () where there is none.
        minors: det of the leading parts of K, exact, where they decide; else ().
    """

    kind: str
    why: str
    along: tuple[Node, ...] = ()
    K: StiffnessRows = ()
    minors: tuple[Scalar, ...] = ()


def stability_of(
    statics: StaticEquations,
    exact: Mapping[Node, Scalar],
    numbers: Mapping[Node, float],
    values: Mapping[Node, Any] | None,
    chosen: Chosen | None = None,
) -> Stability:
    """The stability of an equilibrium.

    Args:
        exact: coordinates and multipliers in closed form, as far as they are known.
        numbers: all of them, and the parameters.
        values: of the parameters with 50 digits; None: some have none, and K is judged by the signs of its terms.
        chosen: where constraints restrict velocities and no positions, the coordinates that they leave open: the
            neighbouring equilibria are at d with K d = 0.
    """
    if statics.system.symbols.z:
        why = "states of first order move with it; `linearize` decides on the stability"
        return Stability(
            "undecided", f"places beside it are at rest, too; {why}" if _has_neighbours(statics, numbers) else why
        )
    if not statics.q:
        return Stability(INDIFFERENT, "nothing can move" if not statics.system.symbols.u else "no force holds it")
    try:
        return _Place(statics, exact, numbers, values, chosen).stability()
    except (NoValue, ZeroDivisionError):  # as of x^(1/3) at 0
        return Stability("undecided", "the forces have no derivatives there")


def _has_neighbours(statics: StaticEquations, numbers: Mapping[Node, Any]) -> bool:
    """True if to first order all that vanishes at a place stays 0 along some direction of coordinates and states."""
    rows, many = jacobian(statics.equations, statics.unknowns), len(statics.q)
    try:
        slopes = statics.slopes(rows, np.array([float(numbers[q]) for q in statics.q]), numbers)
    except (KeyError, NoValue, ZeroDivisionError):  # a parameter has no value
        return False
    return rank(slopes) - rank(slopes[:, many:]) < many


@dataclass(frozen=True)
class _Place:
    statics: StaticEquations
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, float]
    values: Mapping[Node, Any] | None
    chosen: Chosen | None

    @property
    def known(self) -> bool:
        """True if all coordinates and multipliers of the place are exact."""
        return all(x in self.exact for x in self.statics.unknowns)

    @cached_property
    def state(self) -> dict[Node, Any]:
        """Values of everything at the place: with 50 digits where it is exact and the parameters have values."""
        if not self.known or self.values is None:
            return {node: fifty_digits().number(x) for node, x in self.numbers.items()}
        keys = [*self.statics.unknowns]
        found = evaluate([self.exact[x] for x in keys], self.values, fifty_digits())
        return {**self.values, **dict(zip(keys, found, strict=True))}

    def stability(self) -> Stability:
        statics = self.statics
        J = self._numbers(statics.J)
        along = self._independent(J)
        if along is None:
            return Stability("undecided", "the constraints are singular there")
        if not along:
            return Stability(INDIFFERENT, "the constraints leave no degree of freedom")
        if statics.sigma:
            return Stability(
                "undecided", "velocity constraints demand a velocity near it; `linearize` decides on the stability"
            )
        nodes = tuple(statics.q[k] for k in along)
        K = self._exact_K(along) if self.known and len(along) <= MOST_EXACT else None
        shown: StiffnessRows = K if K is not None else _as_exact(self._numeric_K(J, along), self._size_of_terms)
        minors = _minors(K) if K is not None and self.values is None else ()
        if len(along) > 1 and not self._has_potential(along):
            why = "velocity constraints push there" if self._is_conservative else "forces without a potential act"
            return Stability("no potential energy", f"{why}, and K is not symmetric", nodes, shown)
        if self.values is None:
            kind, why = self._by_terms(K, minors)
        else:
            kind, why = self._by_numbers(self._numeric_K(J, along), len(along) == 1)
        return Stability(kind, why, nodes, shown, minors)

    # -- the constraints ------------------------------------------------------------------------------------

    def _numbers(self, rows: Sequence[Sequence[Scalar]]) -> np.ndarray:
        flat = evaluate([x for row in rows for x in row], self.state, fifty_digits())
        return np.array([float(x) for x in flat]).reshape(len(rows), len(self.statics.q))

    def _independent(self, J: np.ndarray) -> list[int] | None:
        """Coordinates by which all others move; those of the model's own where they can be. None: J is singular."""
        n = len(self.statics.q)
        if not len(J):
            return list(range(n))
        scaled = balanced(without_noise(J, tolerances.ROUNDING, axis=1))[0]
        r = int(np.linalg.matrix_rank(scaled, tol=tolerances.RANK_NEARBY))
        if r < self._generic_rank:
            return None
        following: list[int] = []
        for k in sorted(range(n), key=self._late):  # columns of the dependent coordinates, one by one
            more = [*following, k]
            if len(following) < r and np.linalg.matrix_rank(scaled[:, more], tol=tolerances.RANK_NEARBY) > len(
                following
            ):
                following = more
        return [k for k in range(n) if k not in following]

    def _late(self, k: int) -> tuple[bool, float, int]:
        """Sort key of a coordinate: those with the smallest become dependent first.

        Those marked dependent come first, then of a quaternion the largest of its four components. Where velocity
        constraints leave places open, coordinates that no force holds come before the others, the last declared first.
        """
        q, scope = self.statics.q[k], self.statics.system.scope
        own = not scope.model.coordinates[q.name].dependent
        if self.chosen is not None:
            return own, float(q not in (*self.chosen.indifferent, *self.chosen.coordinates)), -k
        turning = any(q in four for four in scope.quaternions)
        return own, -abs(float(self.state[q])) if turning else 1.0, k

    @property
    def _generic_rank(self) -> int:
        """Rank of J where the constraints are not in a special position."""
        if self.statics.beside:  # J is without some of its columns
            rng = Random(6)
            away = np.array([self.numbers[q] + rng.uniform(0.1, 0.3) for q in self.statics.q])
            return rank(self.statics.slopes(self.statics.J, away, self.numbers))
        return Rank((self.statics.system.free or self.statics.system).constraints).rank() + self.statics.norms

    @cached_property
    def _H(self) -> StiffnessRows:
        """-d(Q + J^T lam)/dq."""
        return tuple(tuple(-x for x in row) for row in jacobian(self.statics.forces, self.statics.q))

    # -- K -------------------------------------------------------------------------------------------

    def _numeric_K(self, J: np.ndarray, along: Sequence[int]) -> np.ndarray:
        Z = np.zeros((len(self.statics.q), len(along)))
        Z[list(along), range(len(along))] = 1
        others = [k for k in range(len(self.statics.q)) if k not in along]
        if others:
            Z[others] = -np.linalg.lstsq(J[:, others], J[:, list(along)], rcond=tolerances.LEAST_CHANGE)[0]
        return np.asarray(Z.T @ self._numbers(self._H) @ Z)

    def _exact_K(self, along: Sequence[int]) -> StiffnessRows | None:
        positive = self.statics.system.scope.positive
        try:
            Z = self._exact_Z(along)
            H = [substituted(row, self.exact) for row in self._H]
            rows = [
                [
                    sum(
                        (
                            Z[i][a] * H[i][j] * Z[j][b]
                            for i in range(len(Z))
                            for j in range(len(Z))
                            if not is_zero(Z[i][a]) and not is_zero(Z[j][b]) and not is_zero(H[i][j])
                        ),
                        start=0,
                    )
                    for b in range(len(along))
                ]
                for a in range(len(along))
            ]
            return tuple(tuple(simplest(x, Work.VALUE, positive) for x in row) for row in rows)
        except (DerivationError, NoValue, ZeroDivisionError):
            return None

    def _exact_Z(self, along: Sequence[int]) -> list[list[Scalar]]:
        """The coordinates' displacements for a unit of each independent one."""
        n = len(self.statics.q)
        others = [k for k in range(n) if k not in along]
        J = [substituted(row, self.exact) for row in self.statics.J]
        Z: list[list[Scalar]] = [[int(k == a) for a in along] for k in range(n)]
        values = self.values or self.statics.system.scope.values_of_parameters(Random(3))
        for column, a in enumerate(along):
            rows = [{j: row[k] for j, k in enumerate(others)} for row in J]
            solution = LinearSystem(
                rows, [-row[a] for row in J], len(others), partial(evaluate, values=values, arithmetic=fifty_digits())
            ).solution()
            if len(solution.constants) < len(others):
                raise NoValue("the constraints do not determine the other coordinates there")
            for j, k in enumerate(others):
                Z[k][column] = solution.constants[j]
            moved = (sum((x * Z[k][column] for k, x in enumerate(row)), start=0) for row in J)
            if not all(map(vanishes, moved)):
                raise NoValue("the displacements are those of these parameters alone")
        return Z

    def _has_potential(self, along: Sequence[int]) -> bool:
        """True if the forces have a potential energy along the free variations: dQ_i/dq_j = dQ_j/dq_i."""
        if self._is_conservative and self.chosen is None:
            return True
        K = self._numeric_K(self._numbers(self.statics.J), along)
        return bool(np.all(abs(K - K.T) <= tolerances.COMPUTED * np.max(abs(K), initial=0)))

    @property
    def _is_conservative(self) -> bool:
        """True if the forces that are no gradients by themselves have a potential together."""
        Q = self.statics.unbalanced
        slopes = jacobian(Q, self.statics.q)
        pairs = [(slopes[i][j], slopes[j][i]) for i in range(len(Q)) for j in range(i)]
        return all(is_zero(a - b) or vanishes(a - b) for a, b in pairs)

    # -- signs ---------------------------------------------------------------------------------------

    def _by_terms(self, K: StiffnessRows | None, minors: Sequence[Scalar]) -> tuple[str, str]:
        """Kind and reason from the signs of the terms of K, where the parameters have no values."""
        depends = "depends on the parameters", "stable where V has a minimum there"
        if K is None:
            return depends
        positive = self.statics.system.scope.positive
        signs = [sign_of_terms(x, positive) for x in minors]
        if all(sign == 1 for sign in signs):
            return STABLE, "V has a minimum there"
        if any(sign_of_terms(K[i][i], positive) == -1 for i in range(len(K))):
            return UNSTABLE, "V falls from there"
        if signs and signs[-1] == -1 and len(K) % 2 == 0:
            return UNSTABLE, "V falls from there"
        return depends

    def _by_numbers(self, K: np.ndarray, single: bool) -> tuple[str, str]:
        size = np.abs(np.diagonal(K)) + np.max(np.abs(K), axis=1, initial=0)
        terms = self._size_of_terms
        scale = 1 / np.sqrt(np.where(size > tolerances.COMPUTED * terms, size, max(terms, tolerances.TINIEST)))
        eigenvalues = np.linalg.eigvalsh((K + K.T) / 2 * np.outer(scale, scale))
        if np.min(eigenvalues) > tolerances.COMPUTED:
            return STABLE, "V has a minimum there"
        if np.min(eigenvalues) < -tolerances.COMPUTED:
            highest = np.max(eigenvalues)
            if abs(highest) <= tolerances.COMPUTED:
                return UNSTABLE, "V falls from there"
            return UNSTABLE, f"V has a {'maximum' if highest < 0 else 'saddle'} there"
        if self.chosen is not None and self.chosen.smooth:
            return _drifting(int(np.sum(eigenvalues <= tolerances.COMPUTED)), len(K))
        if single and self.chosen is None:
            return by_higher_derivatives(self.statics, self.state)
        return "undecided", "the second variation of V vanishes in some direction"

    @property
    def _size_of_terms(self) -> float:
        """The largest second derivative there and near it, against which K is compared."""
        found = [0.0]
        for state in (self.state, *self.statics.states_beside(self.state)):
            try:
                entries = [x for row in self._H for x in row]
                found += [abs(float(x)) for x in evaluate(entries, state, fifty_digits())]
            except NoValue:
                continue
        return max(found)


def _drifting(neutral: int, degrees_of_freedom: int) -> tuple[str, str]:
    """Kind and reason for a place in a family of equilibria, where V falls in no direction."""
    if neutral == degrees_of_freedom:
        return INDIFFERENT, "every place that the constraints allow is an equilibrium"
    return STABLE, "V rises in every motion that leaves the equilibria"


def _as_exact(K: np.ndarray, size: float) -> StiffnessRows:
    """The entries, what is rounding of their terms 0."""
    return tuple(tuple(float(x) if abs(x) > tolerances.ROUNDING * size else 0.0 for x in row) for row in K)


def _minors(K: StiffnessRows) -> tuple[Scalar, ...]:
    """det of the leading parts."""
    return tuple(simplest(cramer.determinant([row[:n] for row in K[:n]]), Work.VALUE) for n in range(1, len(K) + 1))


# -------- higher derivatives ----------------------------------------------------------------------------------
# An equilibrium of one degree of freedom at which V'' = 0 -> its stability, by the next derivatives of V.
#
# The force along the way that the constraints leave is P = Q . w with J w = 0; V' = -P, and d/ds is w . d/dq.


HIGHEST = 8  # derivative of V that is looked at
MULTIPLE = 4  # from this derivative on a place where the lower ones vanish is known to a part of its digits only
AWAY = (-0.3, 0.2, 0.4)  # [SI] where what vanishes at the place has its usual size
MOST_COORDINATES = 6  # of constraints along which derivatives are taken

STABLE, UNSTABLE, INDIFFERENT = "stable", "unstable", "indifferent"


def by_higher_derivatives(statics: StaticEquations, state: Mapping[Node, Any]) -> tuple[str, str]:
    """(the kind of stability, the reason).

    Args:
        state: values of everything at the place, with 50 digits.
    """
    return _Way(statics, state).verdict()


@dataclass(frozen=True)
class _Way:
    statics: StaticEquations
    state: Mapping[Node, Any]

    def verdict(self) -> tuple[str, str]:
        """The first derivative of V along the way that does not vanish."""
        w = self._way()
        if w is None:
            return "undecided", "the second variation of V vanishes"
        P = readable(sum((a * b for a, b in zip(self.statics.Q, w, strict=True)), start=0), Work.VALUE)
        for order in range(1, HIGHEST + 1):
            if order > 1 and (value := self._value(P, order)):
                kind = STABLE if order % 2 == 0 and value < 0 else UNSTABLE
                return kind, f"the first derivative of V that does not vanish is number {order}"
            P = sum((a * b for a, b in zip(gradient(P, self.statics.q), w, strict=True)), start=0)
        return INDIFFERENT, f"the first {HIGHEST} derivatives of V vanish"

    def _way(self) -> tuple[Scalar, ...] | None:
        """A vector along the constraints: its entries are the minors of J, with signs; 1 without constraints."""
        J, n = self.statics.J, len(self.statics.q)
        if n == 1:
            return (1,)
        if len(J) != n - 1 or n > MOST_COORDINATES:
            return None
        return tuple(
            (-1) ** k * cramer.determinant([[row[j] for j in range(n) if j != k] for row in J]) for k in range(n)
        )

    def _value(self, P: Scalar, order: int) -> float:
        """P there; 0 where it vanishes against its size near the place, and against its terms further away."""
        value = self._at(P, self.state)
        near = max(self._at(P, state, 0.0) for state in self.statics.states_beside(self.state))
        away = ({**self.state, **{q: self.state[q] + shift for q in self.statics.q}} for shift in AWAY)
        far = max(self._at(P, state, 0.0) for state in away)
        share = tolerances.COMPUTED if order < MULTIPLE else tolerances.AT_A_MULTIPLE_ROOT
        return value if abs(value) > max(share * near, tolerances.ZERO_AT_50 * far) else 0.0

    def _at(self, P: Scalar, state: Mapping[Node, Any], otherwise: float | None = None) -> float:
        """P; its size, or this where it has none."""
        try:
            value = float(evaluate((P,), state, fifty_digits())[0])
        except NoValue:
            if otherwise is None:
                raise
            return otherwise
        return value if otherwise is None else abs(value)


# -------- coordinates that may be chosen ----------------------------------------------------------------------
# Static equations -> the coordinates that may be chosen where velocity constraints let a system rest in many places.
#
# A knife edge or a wheel restricts velocities and no positions: where Q + J^T lam = 0, phi = 0 hold at one place they
# hold near it too. With A the derivatives of these equations by (lam, q), the coordinates whose columns of A depend
# linearly on the columns before them may have any value near: they stay where they start, and the others follow.


ASIDE = 0.01  # distance from the first equilibrium at which another one is sought


@dataclass(frozen=True)
class Chosen:
    """Coordinates whose values at rest may be chosen.

    Args:
        coordinates: those that may have any value near their start.
        smooth: True if two neighbouring equilibria have as many of them: they belong to one family.
        indifferent: coordinates on which no equation depends.
    """

    coordinates: tuple[Node, ...] = ()
    smooth: bool = True
    indifferent: tuple[Node, ...] = ()


def holds_velocities(statics: StaticEquations, values: Mapping[Node, Any], guess: np.ndarray) -> bool:
    """True if a constraint restricts velocities but no positions: d phi/dq has less rank than J."""
    aside = guess + ASIDE * np.random.default_rng(3).uniform(1, 2, len(guess))
    floats = {node: float(x) for node, x in values.items()}
    relations = jacobian(statics.phi, statics.q) if statics.phi else ()
    held = rank(statics.slopes(relations, aside, floats)) if relations else 0
    return held < rank(statics.slopes(statics.J, aside, floats))


def unheld(statics: StaticEquations) -> tuple[Node, ...]:
    """Coordinates that occur in the equations although none depends on them: sin^2 + cos^2."""
    slopes = zip(*jacobian(statics.equations, statics.q), strict=True) if statics.equations else iter(())
    return tuple(q for q, column in zip(statics.q, slopes, strict=False) if all(map(vanishes, column)))


def chosen_coordinates(statics: StaticEquations, values: Mapping[Node, Any], guess: np.ndarray) -> Chosen:
    """The coordinates that may be chosen near the equilibrium that is reached from a guess.

    Args:
        values: of the parameters, with 50 digits.
        guess: of the coordinates.
    """
    here = place_near(statics, values, guess)
    return Chosen() if here is None else _Near(statics, values, guess, here).chosen()


@dataclass(frozen=True)
class _Near:
    statics: StaticEquations
    values: Mapping[Node, Any]
    guess: np.ndarray
    here: np.ndarray

    def chosen(self) -> Chosen:
        beside = place_near(self.statics, self.values, self._shifted)
        loose = [self._loose(z) for z in (self.here, self.here if beside is None else beside)]
        return Chosen(tuple(loose[1]), len(loose[0]) == len(loose[1]))

    @cached_property
    def _shifted(self) -> np.ndarray:
        """A place near the family's tangent."""
        n = len(self.statics.q)
        free = [self.statics.q.index(q) for q in self._loose(self.here)]
        moved = self.here[:n].copy()
        moved[free] += ASIDE * np.random.default_rng(4).uniform(1, 2, len(free))
        return moved

    def _loose(self, place: np.ndarray) -> list[Node]:
        """The coordinates whose columns of A follow from those of the multipliers and of other coordinates."""
        floats = {node: float(x) for node, x in self.values.items()}
        floats |= dict(zip(self.statics.unknowns, map(float, place), strict=True))
        slopes = jacobian(self.statics.equations, self.statics.unknowns)
        A = self.statics.slopes(slopes, place[: len(self.statics.q)], floats)
        n = len(self.statics.q)
        order = [*range(n, A.shape[1]), *sorted(range(n), key=self._place_in_order)]
        free = Split.in_order(dense.without_noise(A, tolerances.SUMMED, axis=1), order).free
        return [q for k, q in enumerate(self.statics.q) if k in free]

    def _place_in_order(self, k: int) -> tuple[bool, bool, int]:
        """Key of a coordinate in the choice: first those that move away from the guess, then those only guessed."""
        still = abs(self.here[k] - self.guess[k]) <= tolerances.SAME_PLACE * (1 + abs(self.guess[k]))
        return bool(still), not self.statics.system.scope.model.is_guess(self.statics.q[k].name), -k
