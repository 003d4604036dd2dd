"""Modes -> checks of what is said of small motions: put back into the matrices, which are proven by themselves.

(lambda^2 M + lambda C + K) v = 0,   sum lambda = tr A,   sum lambda^2 = tr A^2,   p(s) = det(s^2 M + s C + K)
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.mechanics.small_motions.modes import Modes
from eomgen.mechanics.small_motions.polynomial import Polynomial
from eomgen.proof.check import Check, attempted, checked, first_wrong
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import CARRIED, COMPUTED, DIFFERENCE_AT_50, SAME_PLACE, SLOW

SAMPLES = (
    0.7 + 0.9j,
    -0.4 + 2.3j,
)  # s, of the geometric mean of all eigenvalues, at which functions of it are compared
FLOATS = "floating point"
ASIDE = 0.1  # of a displacement along what drifts
DRAWS = 24  # of other parameters, at which conditions of stability are compared with roots
STEPS, MET = 20, 0.1  # looks on a way between parameters; a part of both ends that is near 0
SURELY = 1e-3  # of the largest root, by which another one surely grows or fades


def mode_checks(modes: Modes) -> Iterator[Check]:
    """Of modes, eigenvalues, characteristic polynomial, closed frequencies, stability, transfer functions."""
    proof = _Proof(modes)
    yield checked("every mode satisfies (lambda^2 M + lambda C + K) v = 0", proof.wrong_mode, FLOATS)
    yield checked("the eigenvalues are all there: their sums are the traces of A and A^2", proof.wrong_sums, FLOATS)
    if modes.spectrum.oscillating:
        name = "after a period 1/f a free motion is back, smaller by what its damping ratio says"
        yield checked(name, proof.wrong_period, FLOATS)
    if modes.polynomial is not None:
        yield checked("the characteristic polynomial is the determinant", proof.wrong_polynomial, "50 digits")
    if proof.closed:
        name = "frequencies in closed form are those of eigenvalues in numbers"
        yield checked(name, proof.wrong_frequency, FLOATS)
    yield checked("what is said of stability is so of the eigenvalues of A", proof.wrong_stability, FLOATS)
    if modes.conditions.expressions:
        yield proof.conditions()
    if modes.transfers:
        yield checked("transfer functions are (s 1 - A)^-1 B", proof.wrong_transfer, FLOATS)


@dataclass(frozen=True)
class _Proof:
    """What is wrong with each, in words.

    Args:
        modes: of the small motions.
    """

    modes: Modes

    @property
    def A(self) -> np.ndarray:
        return self.modes.small.state_matrix

    @cached_property
    def values(self) -> np.ndarray:
        """The eigenvalues of A, found again."""
        found: np.ndarray = np.linalg.eigvals(self.A)
        return found

    @cached_property
    def largest(self) -> float:
        return float(abs(self.values).max(initial=0))

    @cached_property
    def rate(self) -> float:
        """What is usual of the eigenvalues that are not 0."""
        sizes = abs(self.values)
        sizes = sizes[sizes > SAME_PLACE * self.largest]
        return float(np.exp(np.log(sizes).mean())) if len(sizes) else 1.0

    # -- modes -----------------------------------------------------------------------------------------------

    @cached_property
    def wrong_mode(self) -> str:
        """(A - lambda) x = 0 with the printed coordinates of the shape; the speeds of x as they then must be.

        Beside a steady motion A^2 x = 0: some motions of the eigenvalue 0 lead to others, which go on at other rates.
        """
        n = len(self.modes.small.numbers.coordinates)
        for k, mode in enumerate(self.modes.spectrum.modes, start=1):
            v = self._coordinates(mode.shape)
            if v is None or not abs(v).max(initial=0):
                continue
            pencil = self.A - mode.eigenvalue * np.eye(len(self.A))
            pencil = pencil if mode.eigenvalue or mode.pair else pencil @ pencil / self.rate
            scale = 1 / (abs(pencil).max(axis=1) + SLOW * self.rate)  # of each row, in its own unit
            pencil = pencil * scale[:, None]
            u = np.linalg.lstsq(pencil[:, n:], -pencil[:, :n] @ v, rcond=None)[0]
            x = np.concatenate([v, u])
            left = abs(pencil @ x)
            if left.max() > SAME_PLACE * abs(x).max():
                return f"mode {k}: {left.max():.2g} is left"
        return ""

    @cached_property
    def wrong_period(self) -> str:
        """exp(lambda/f) = exp(-2 pi zeta/sqrt(1 - zeta^2)), by the printed f and zeta."""
        for k, mode in enumerate(self.modes.spectrum.modes, start=1):
            if not mode.hertz or mode.damping_ratio is None:
                continue
            back = np.exp(mode.eigenvalue / mode.hertz)
            left = np.exp(-math.tau * mode.damping_ratio / math.sqrt(1 - mode.damping_ratio**2))
            if not abs(back - left) <= SAME_PLACE * abs(left):
                return f"mode {k}: {back:.6g} against {left:.6g}"
        return ""

    def _coordinates(self, shape: Any) -> np.ndarray | None:
        """Of the printed coordinates; None where small turns stand in their place."""
        labels = self.modes.small.numbers.coordinates
        return np.array([shape[q] for q in labels]) if all(q in shape for q in labels) else None

    @cached_property
    def wrong_sums(self) -> str:
        values = np.array(self.modes.spectrum.eigenvalues)
        if len(values) != len(self.A):
            return f"{len(values)} for {len(self.A)} states"
        for k, trace in ((1, np.trace(self.A)), (2, np.trace(self.A @ self.A))):
            size = (abs(values) ** k).sum() + (abs(self.A).max(initial=0) * SLOW) ** k
            if abs((values**k).sum() - trace) > SAME_PLACE * size:
                return f"the sum of lambda^{k} is {(values**k).sum():.10g}, the trace {trace:.10g}"
        return ""

    # -- in closed form --------------------------------------------------------------------------------------

    @cached_property
    def wrong_polynomial(self) -> str:
        """p(s) against the determinant of the pencil, at numbers s."""
        small, polynomial = self.modes.small, self.modes.polynomial
        assert small.exact is not None and polynomial is not None
        digits, trial, e = fifty_digits(), small.reference.trial, small.exact
        flat = [x for A in (e.M, e.C, e.K, e.F, e.E) for row in A for x in row]
        *values, one = evaluate((*flat, *polynomial.coefficients, 1), trial, digits)
        entries, n, m = iter(values), len(e.speeds), len(e.coordinates)
        M, C, K, F, E = (
            [[next(entries) for _ in range(k)] for _ in range(rows)]
            for rows, k in ((n, n), (n, n), (n, m), (m, m), (m, n))
        )
        p = Polynomial(tuple(entries))
        for part in (7, -13):
            s = one * self.rate * part / 10
            upper = [[s * int(i == j) - x for j, x in enumerate(row)] + [-x for x in E[i]] for i, row in enumerate(F)]
            lower = [[*K[i], *(s * x + c for x, c in zip(M[i], C[i], strict=True))] for i in range(n)]
            rows = upper + lower
            sizes = [max(map(abs, row)) or one for row in rows]  # mpmath takes for singular what is small beside 1
            scaled = [[x / size for x in row] for row, size in zip(rows, sizes, strict=True)]
            det = one.context.det(one.context.matrix(scaled)) * one.context.fprod(sizes)
            size = sum(abs(c * s**k) for k, c in enumerate(p.coefficients))
            if abs(det - p.at(s)) > DIFFERENCE_AT_50 * size:
                return f"p({float(s):.6g}) = {float(p.at(s)):.10g} against {float(det):.10g}"
        return ""

    @cached_property
    def closed(self) -> list[float]:
        """The frequencies in closed form, in numbers."""
        return [number for number, _ in self.modes.closed if number >= 0]

    @cached_property
    def wrong_frequency(self) -> str:
        for w in self.closed:
            away = abs(self.values.imag - w).min()
            if away > SAME_PLACE * max(w, SLOW * self.largest):
                return f"{w:.10g} rad/s is the frequency of no eigenvalue"
        printed = [f for f in self.modes.spectrum.oscillating if f.frequency]
        for mode in printed:
            assert mode.frequency is not None
            if abs(self.values.imag - mode.frequency).min() > SAME_PLACE * self.largest:
                return f"{mode.frequency:.10g} rad/s is the frequency of no eigenvalue"
        return ""

    # -- stability -------------------------------------------------------------------------------------------

    @cached_property
    def growth(self) -> float:
        """The largest real part, of the largest eigenvalue; those that are 0 left out."""
        zeros = sum(x == 0 for x in self.modes.spectrum.eigenvalues)
        left = self.values[np.argsort(abs(self.values))[zeros:]]
        return float(left.real.max(initial=-np.inf)) / self.largest if self.largest else 0.0

    @cached_property
    def wrong_stability(self) -> str:
        said = self.modes.spectrum.stability
        if said == "unstable":
            return "none of them grows" if self.growth < -CARRIED else ""
        if said == "unstable to first order":
            return "" if self._has_chains else "said to grow like t, and the eigenvalue 0 has all its modes"
        if said in ("stable", "asymptotically stable") and self._has_chains:
            return f"said to be {said}, and a motion grows like t"
        if said == "stable to first order" and self._drifts_away:
            return f"said to be {said}, and a motion grows like t into others"
        return f"said to be {said}, and one of them grows" if said != "undecided" and self.growth > SAME_PLACE else ""

    @property
    def _has_chains(self) -> bool:
        """Whether A^2 lets more motions stay than A: they grow like t."""
        zeros = sum(x == 0 for x in self.modes.spectrum.eigenvalues)
        sizes = np.linalg.svd(self.A, compute_uv=False)
        return zeros > 0 and int(np.sum(sizes <= COMPUTED * sizes.max(initial=0))) < zeros

    @property
    def _drifts_away(self) -> bool:
        """Whether what grows like t comes to where the equations are others; of ties and small turns none is said."""
        small = self.modes.small
        system, e, numbers = small.first.system, small.first.equations, small.reference.numbers
        tied = system.ties.closing or system.elimination is not None
        if tied or not {*small.numbers.coordinates} <= numbers.keys() or not self._has_chains:
            return False
        sizes, columns = np.linalg.svd(self.A @ self.A)[1:]
        slow = columns[sizes <= COMPUTED * sizes.max(initial=0)]
        drifts = (self.A @ slow.T).T
        drift = max(drifts, key=lambda x: float(np.linalg.norm(x)))[: len(small.numbers.coordinates)]
        if not np.linalg.norm(drift) > SAME_PLACE * self.rate:
            return False
        drift = drift / abs(drift).max()
        there = {q: numbers[q] + ASIDE * float(x) for q, x in zip(small.numbers.coordinates, drift, strict=True)}
        entries = (*(x for row in e.M for x in row), *e.forcing)
        here, moved = (evaluate(entries, {**numbers, **more}, fifty_digits()) for more in ({}, there))
        return any(abs(x - y) > COMPUTED * (1 + abs(x)) for x, y in zip(here, moved, strict=True))

    def conditions(self) -> Check:
        """All are positive where nothing grows, and one is not where something does."""
        name = "the conditions of stability hold where nothing grows, and only there"
        return attempted(name, FLOATS, lambda: self._wrong_conditions)

    @property
    def _wrong_conditions(self) -> str:
        return self._wrong_here or first_wrong(map(self._wrong_elsewhere, range(DRAWS)))

    def _wrong_elsewhere(self, seed: int) -> str:
        """With other parameters: the roots of the characteristic polynomial in numbers, which is proven by itself."""
        rng, polynomial, conditions = Random(seed), self.modes.polynomial, self.modes.conditions
        if polynomial is None:
            return ""
        trial = self.modes.small.reference.trial
        drawn = {x: v * _factor(rng, x in self.modes.positive) for x, v in trial.items()}
        try:
            scalars = (*polynomial.coefficients, *conditions.expressions)
            first = float(evaluate(polynomial.coefficients[-1:], trial, fifty_digits())[0])
            values = [float(x) for x in evaluate(scalars, drawn, fifty_digits())]
        except (NoValue, ZeroDivisionError, OverflowError):
            return ""
        n = len(polynomial.coefficients)
        c, least = np.array(values[conditions.zeros : n]), min(values[n:])
        if first * c[-1] <= 0 or self._meets_zero(trial, drawn):  # leading coefficients keep their signs, as det M does
            return ""
        roots = np.roots(c[::-1])
        grows = float(roots.real.max(initial=-np.inf)) / float(abs(roots).max(initial=1))
        if least > 0 and grows > SURELY:
            return "all hold for other parameters, and a root grows"
        if least < 0 and (grows < -SURELY or (not conditions.fading and grows < CARRIED)):
            return "one does not hold for other parameters, and no root grows"
        return ""

    def _meets_zero(self, trial: Mapping[Node, Any], drawn: Mapping[Node, Any]) -> bool:
        """True if the leading coefficient comes near 0 on the way: (R - r)^2 keeps its sign, and its root does not."""
        assert self.modes.polynomial is not None
        leading = self.modes.polynomial.coefficients[-1:]
        try:
            ways = [{x: float(v) + k / STEPS * float(drawn[x] - v) for x, v in trial.items()} for k in range(STEPS + 1)]
            sizes = [abs(float(evaluate(leading, way, FLOAT)[0])) for way in ways]
        except (NoValue, ZeroDivisionError, OverflowError):
            return True
        return min(sizes) < MET * min(sizes[0], sizes[-1])

    @property
    def _wrong_here(self) -> str:
        least = min(evaluate(self.modes.conditions.expressions, self.modes.small.reference.trial, fifty_digits()))
        if least > 0 and self.growth > SAME_PLACE:
            return "all hold, and an eigenvalue grows"
        fading = least < 0 and self.growth < -SAME_PLACE
        return "one does not hold, and all eigenvalues fade" if fading else ""

    # -- inputs ----------------------------------------------------------------------------------------------

    @cached_property
    def wrong_transfer(self) -> str:
        small, names = self.modes.small, self.modes.small.numbers
        trial = {x: float(v) for x, v in small.reference.trial.items()}
        for s in (self.rate * x for x in SAMPLES):
            answers = np.linalg.solve(s * np.eye(len(self.A)) - self.A, small.input_matrix.astype(complex))
            for f in self.modes.transfers:
                i, j = names.coordinates.index(f.coordinate), names.inputs.index(f.input)
                found = _value(f.above, s, trial) / _value(f.below, s, trial)
                if abs(found - answers[i, j]) > SAME_PLACE * abs(answers[:, j]).max():
                    return f"{f.coordinate.name}/{f.input.name}: {found:.6g} against {answers[i, j]:.6g}"
        return ""


def _value(polynomial: Polynomial, s: complex, trial: dict[Node, Any]) -> complex:
    digits = {x: fifty_digits().number(1) * v for x, v in trial.items()}
    floats = [
        c if isinstance(c, float) else float(evaluate((c,), digits, fifty_digits())[0]) for c in polynomial.coefficients
    ]
    return complex(Polynomial(tuple(floats)).at(s))


def _factor(rng: Random, positive: bool) -> Any:
    """By which a parameter is changed: between a seventh and seven times, of what may be negative at times below 0."""
    size = fifty_digits().number(round(10**6 * math.exp(rng.uniform(-2, 2)))) / 10**6
    return -size if not positive and rng.random() < 0.3 else size
