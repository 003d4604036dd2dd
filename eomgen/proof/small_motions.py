"""Modes -> checks of small motions: the printed matrices against differences of the equations of motion.

A motion near the reference starts at q_0 + h d, u_0 + h e, inputs w_0 + h f in a random direction; the equations of
motion say how it goes on. Its difference from the reference, divided by h, must satisfy the printed equations:

    M dq'' + C dq' + K dq = B dw,      or  M du' + C du + K dq = B dw,  dq' = F dq + E du,      x' = A x + B_x w

M against the kinetic energy: d . M d is the second difference of T along d. Shared with the linearization are the state
of the reference, the equations of motion (proven by themselves) and the choice of coordinates, but no derivative and no
elimination of constraints.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import product
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.linearization import Modes, SmallMotions
from eomgen.proof.certificate import certify
from eomgen.proof.check import Certificate, Check, attempted, checked, first_wrong, unchecked
from eomgen.proof.degrees_of_freedom import Numbers50
from eomgen.proof.neighbouring_motions import Differences, DigitColumn, MotionDifference
from eomgen.proof.reported_small_motions import PrintedModes, linear_entries, small_motions_reported
from eomgen.symbolic.expression import Node
from eomgen.symbolic.numeric import (
    NoValue,
    evaluate,
    fifty_digits,
    sums_of_products,
    tolerances,
)

DIRECTIONS = 3  # random ones: a wrong entry is seen by each of them
BY_DIFFERENCES = "differences at 50 digits"


# -- the matrices --------------------------------------------------------------------------------------------------


def certify_small_motions(modes: Modes, entries: Mapping[str, Any], printed: PrintedModes) -> Certificate:
    """Check the equations of motion, the small motions against differences of these, and what is reported of them.

    Args:
        entries: as machines get them.
        printed: the texts of the derivation.
    """
    small = modes.small
    values = small.reference.system.scope.model.exact_parameters()
    equations = certify(small.first.equations, begins=not small.reference.about_equilibrium)
    valued = small.reference.valued
    reported = linear_entries(entries, small.state_matrix, small.input_matrix) if valued else ()
    printed_checks = small_motions_reported(entries, printed, values)
    return Certificate((*equations.checks, *small_motion_checks(modes), *reported, *printed_checks))


def small_motion_checks(modes: Modes) -> Iterator[Check]:
    """Checks of the reference state, the matrices, and the modes."""
    small = modes.small
    differences = Differences(small)
    try:
        yield _reference(differences)
        yield from _matrices(modes, differences)
        if small.is_second_order:
            yield checked("C = D + G and K = S + H, D and S symmetric, G and H skew", _wrong_parts(modes), "50 digits")
        yield from mode_checks(modes)
    except (NoValue, ZeroDivisionError) as error:
        yield unchecked("small motions are those of the equations of motion", str(error), BY_DIFFERENCES)


def _reference(differences: Differences) -> Check:
    """Check that the reference state is without acceleration, and at rest without velocity."""
    small, origin = differences.small, differences.origin
    A = abs(small.state_matrix)
    state = [abs(float(origin.state.get(x, 0))) for x in (*small.numbers.coordinates, *small.numbers.speeds)]
    usual = dict(zip(small.numbers.speeds, A[-len(small.numbers.speeds) :] @ np.maximum(1.0, state), strict=True))
    most = max(usual.values())
    wrong = [
        f"{u.name} changes by {float(origin.a[u]):.3g}"
        for u in differences.nearby.u
        if abs(origin.a[u])
        > tolerances.COMPUTED * (usual.get(u) or most) + tolerances.ZERO_AT_50  # without a row: the largest
    ]
    size = A[: len(small.numbers.coordinates)] @ np.maximum(1.0, state)
    moving = dict(zip(small.numbers.coordinates, size, strict=True))
    seen = {z for z in small.numbers.states if A[:, small.numbers.coordinates.index(z)].any()}  # the others may grow
    wrong += [
        f"{z.name} changes by {float(origin.q1[z]):.3g}"
        for z in small.numbers.states
        if z in seen and abs(origin.q1[z]) > tolerances.COMPUTED * moving[z] + tolerances.ZERO_AT_50
    ]
    name = "the equations of motion hold at the reference, without acceleration"
    return checked(name, "; ".join(wrong), "50 digits")


def _matrices(modes: Modes, differences: Differences) -> Iterator[Check]:
    """M, C, K, B (F, E) and the state matrix."""
    small, rng = differences.small, Random(11)
    if differences.is_part:
        yield _of_part(differences)
        return
    exact, tolerance = _entries(modes), tolerances.DIFFERENCE_AT_50 if small.exact is not None else tolerances.COMPUTED
    nearby, energies = [], []
    for _ in range(DIRECTIONS):
        moved = (*small.whole.coordinates, *small.whole.speeds, *small.whole.inputs)
        nearby.append(differences.along(_random(moved, rng)))
        energies.append(differences.energy_along(_random(small.whole.speeds, rng)))
    wrong = {
        "motion": _in_equations(small, exact, nearby, tolerance),
        "state": _in_state_form(small, nearby),
        "mass": _in_energy(small, exact["M"], energies, tolerance),
    }
    form = "M q'' + C q' + K q = B w" if small.is_second_order else "M u' + C u + K q = B w, q' = F q + E u"
    form += " + D w" if small.numbers.states else ""
    yield checked(f"motions near the reference satisfy {form}", wrong["motion"], BY_DIFFERENCES)
    yield checked("they satisfy x' = A x + B w", wrong["state"], BY_DIFFERENCES)
    yield checked("M is the second derivative of the kinetic energy along them", wrong["mass"], BY_DIFFERENCES)


def _of_part(differences: Differences) -> Check:
    """Check of a part of the coordinates: they respond to forces on them as they do in the whole system.

    (s^2 M + s C + K)^-1 is their part of the first rows of (s 1 - A)^-1 [0; M^-1] of the whole, A and M by differences.
    """
    small, e = differences.small, differences.small.numbers
    requested = [differences.moved.index(q) for q in e.coordinates]
    whole = differences.whole()
    wrong = ""
    for s in (0.7 + 0.9j, -0.4 + 2.3j):
        s *= abs(small.state_matrix).max() ** 0.5 or 1.0
        pencil = sum((s**k * np.array(A, dtype=float) for k, A in enumerate((e.K, e.C, e.M))))
        answer = np.linalg.inv(pencil)
        away = abs(answer - whole(s)[np.ix_(requested, requested)]).max() / abs(answer).max()
        wrong = wrong or ("" if away <= tolerances.CARRIED else f"their answers differ by {away:.2g}")
    return checked("requested coordinates move as they do in the whole system", wrong, "differences, floating point")


def _entries(modes: Modes) -> dict[str, list[list[Any]]]:
    """The printed matrices in numbers: exact ones with 50 digits; C of second order is printed in its parts."""
    small = modes.small
    e = small.equations
    whole = {"C": _numbers(small, e.C)} if small.is_second_order else {}
    return {letter: _numbers(small, getattr(e, letter), modes) for letter in "MCKBFED" if letter not in whole} | whole


def _numbers(small: SmallMotions, rows: Sequence[Sequence[Any]], modes: Modes | None = None) -> list[list[Any]]:
    flat: Sequence[Any] = [x for row in rows for x in row]
    if small.exact is not None:
        flat = [x if modes is None else modes.written(x) for x in flat]
        flat = evaluate(tuple(flat), small.reference.trial, fifty_digits())
    return _in_rows(flat, rows)


def _in_rows(flat: Sequence[Any], rows: Sequence[Sequence[Any]]) -> list[list[Any]]:
    """The numbers with 50 digits, in rows as these are."""
    one = fifty_digits().number(1)
    zero = 0 * one
    values = iter([one * x if x else zero for x in flat])
    return [[next(values) for _ in row] for row in rows]


def _wrong_parts(modes: Modes) -> str:
    """Message if a printed part of C or K is not symmetric or skew as its letter says, or not part of the sum; ""."""
    small = modes.small
    whole = {letter: _numbers(small, getattr(small.equations, letter)) for letter in "CK"}
    parts = {
        name: _numbers(small, A if name == "S" else _printed_half(modes, A))
        for name, A in modes.symmetric_parts.items()
    }
    tolerance = tolerances.ZERO_AT_50 if small.exact is not None else tolerances.ROUNDING
    for letter, even, odd in (("C", "D", "G"), ("K", "S", "H")):
        for i, j in product(range(len(whole[letter])), repeat=2):
            (a, b), (c, d) = ((parts[name][i][j], parts[name][j][i]) for name in (even, odd))
            if not any((a, b, c, d, whole[letter][i][j])):
                continue
            left = max(abs(a + c - whole[letter][i][j]), abs(a - b), abs(c + d))
            if left > tolerance * (abs(a) + abs(c)):
                return f"entry {i + 1}, {j + 1} of {even} or {odd}"
    return ""


def _printed_half(modes: Modes, A: list[list[Any]]) -> list[list[Any]]:
    """Symmetric or skew matrix, from its part above the diagonal as it is printed."""
    return [[modes.written(x) if j >= i else x for j, x in enumerate(row)] for i, row in enumerate(A)]


def _random(nodes: Sequence[Node], rng: Random) -> Numbers50:
    return {x: fifty_digits().number(rng.choice((-1, 1)) * rng.randint(50, 100)) / 100 for x in nodes}


def _in_equations(
    small: SmallMotions, A: Mapping[str, list[list[Any]]], nearby: Sequence[MotionDifference], tolerance: float
) -> str:
    """Message for the first row in which M a + C u + K q = B w or q' = F q + E u + D w does not hold; ""."""
    pushed = [[-x for x in row] for row in A["B"]]
    left = [[*m, *c, *k, *b] for m, c, k, b in zip(A["M"], A["C"], A["K"], pushed, strict=True)]
    units = [sum(map(abs, row)) for row in A["M"]]
    balances = sums_of_products(left, [[*a, *u, *at.q, *at.w] for at, u, a in _moving(small, nearby)])
    rates = sums_of_products(
        [[*f, *e, *d] for f, e, d in zip(A["F"], A["E"], A["D"], strict=True)],
        [[*at.q, *u, *at.w] for at, u, _ in _moving(small, nearby)],
    )
    for at, rows, also in zip(nearby, balances, rates, strict=True):
        for speed, row, unit in zip(small.numbers.speeds, rows, units, strict=True):
            if wrong := _left(0, row, tolerance, unit):
                return f"the equation of {speed.name.rstrip(chr(39))}: {wrong}"
        for q, rate, row in zip(small.numbers.coordinates, at.q1, also, strict=True):
            if wrong := _left(-rate, row, tolerance):
                return f"the rate of {q.name}: {wrong}"
    return ""


def _in_state_form(small: SmallMotions, nearby: Sequence[MotionDifference]) -> str:
    names = [x.name for x in (*small.numbers.coordinates, *small.numbers.speeds)]
    both = np.hstack([small.state_matrix, small.input_matrix]).tolist()
    found = sums_of_products(both, [[*at.q, *u, *at.w] for at, u, _ in _moving(small, nearby)])
    for (at, _, a), rows in zip(_moving(small, nearby), found, strict=True):
        for name, rate, row in zip(names, (*at.q1, *a), rows, strict=True):
            if wrong := _left(-rate, row, tolerances.COMPUTED):
                return f"the row of {name}: {wrong}"
    return ""


def _moving(
    small: SmallMotions, nearby: Sequence[MotionDifference]
) -> list[tuple[MotionDifference, DigitColumn, DigitColumn]]:
    """Each with the speeds and their rates that the equations speak of."""
    return [(at, at.q1, at.q2) if small.is_second_order else (at, at.u, at.a) for at in nearby]


def _in_energy(
    small: SmallMotions, M: list[list[Any]], energies: Sequence[tuple[Any, DigitColumn, DigitColumn]], tolerance: float
) -> str:
    """Message if d . M d = T'' does not hold along some direction d; ""."""
    along = [q1 if small.is_second_order else u for _, q1, u in energies]
    for (T, _, _), d, rows in zip(energies, along, sums_of_products(M, along), strict=True):
        products = [(x * y, abs(x) * size) for x, (y, size) in zip(d, rows, strict=True)]
        if wrong := _left(-T, (sum(x for x, _ in products), sum(size for _, size in products)), tolerance):
            return wrong
    return ""


def _left(other: Any, sums: tuple[Any, Any], tolerance: float, unit: Any = 1) -> str:
    """Message if terms do not cancel one another within rounding, of them or of a rate of one unit; "".

    Args:
        other: one of them.
        sums: of the others, and of their sizes.
    """
    left, size = other + sums[0], abs(other) + sums[1]
    if abs(left) <= tolerance * (size + tolerances.SLOW * unit):
        return ""
    return f"{float(left):.3g} is left, of terms of {float(size):.3g}"


# -------- modes -----------------------------------------------------------------------------------------------
# Modes -> checks of small motions: modes and values are put back into the matrices, which are proven by themselves.
#
# (lambda^2 M + lambda C + K) v = 0,   sum lambda = tr A,   sum lambda^2 = tr A^2,   p(s) = det(s^2 M + s C + K)


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
    """Checks of modes, eigenvalues, characteristic polynomial, closed frequencies, stability, transfer functions."""
    proof = _Proof(modes)
    yield checked("every mode satisfies (lambda^2 M + lambda C + K) v = 0", proof.wrong_mode, FLOATS)
    yield checked("the eigenvalues are all there: their sums are the traces of A and A^2", proof.wrong_sums, FLOATS)
    if modes.spectrum.oscillating:
        name = "after a period 1/f a free motion returns, reduced as its damping ratio says"
        yield checked(name, proof.wrong_period, FLOATS)
    if modes.polynomial is not None:
        yield checked("the characteristic polynomial is the determinant_in_digits", proof.wrong_polynomial, "50 digits")
    if proof.closed:
        name = "frequencies in closed form are those of eigenvalues in numbers"
        yield checked(name, proof.wrong_frequency, FLOATS)
    yield checked("stated stability is that of the eigenvalues of A", proof.wrong_stability, FLOATS)
    if modes.conditions.expressions:
        yield proof.conditions()
    if modes.transfers:
        yield checked("transfer functions are (s 1 - A)^-1 B", proof.wrong_transfer, FLOATS)


@dataclass(frozen=True)
class _Proof:
    """Tests of the modes; each gives what is wrong in words, or "".

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

    @property
    def largest(self) -> float:
        return float(abs(self.values).max(initial=0))

    @cached_property
    def rate(self) -> float:
        """Geometric mean of the absolute values of the eigenvalues that are not 0."""
        sizes = abs(self.values)
        sizes = sizes[sizes > tolerances.SAME_PLACE * self.largest]
        return float(np.exp(np.log(sizes).mean())) if len(sizes) else 1.0

    # -- modes -----------------------------------------------------------------------------------------------

    @property
    def wrong_mode(self) -> str:
        """(A - lambda) x = 0 with the printed coordinates of the shape; the speeds of x as they then must be.

        Near a steady motion A^2 x = 0: some motions of the eigenvalue 0 lead to others, which go on at other rates.
        """
        n = len(self.modes.small.numbers.coordinates)
        for k, mode in enumerate(self.modes.spectrum.modes, start=1):
            v = self._coordinates(mode.shape)
            if v is None or not abs(v).max(initial=0):
                continue
            pencil = self.A - mode.eigenvalue * np.eye(len(self.A))
            pencil = pencil if mode.eigenvalue or mode.pair else pencil @ pencil / self.rate
            scale = 1 / (abs(pencil).max(axis=1) + tolerances.SLOW * self.rate)  # of each row, in its own unit
            pencil = pencil * scale[:, None]
            u = np.linalg.lstsq(pencil[:, n:], -pencil[:, :n] @ v, rcond=None)[0]
            x = np.concatenate([v, u])
            left = abs(pencil @ x)
            if left.max() > tolerances.SAME_PLACE * abs(x).max():
                return f"mode {k}: {left.max():.2g} is left"
        return ""

    @property
    def wrong_period(self) -> str:
        """exp(lambda/f) = exp(-2 pi zeta/sqrt(1 - zeta^2)), by the printed f and zeta."""
        for k, mode in enumerate(self.modes.spectrum.modes, start=1):
            if not mode.hertz or mode.damping_ratio is None:
                continue
            back = np.exp(mode.eigenvalue / mode.hertz)
            left = np.exp(-math.tau * mode.damping_ratio / math.sqrt(1 - mode.damping_ratio**2))
            if not abs(back - left) <= tolerances.SAME_PLACE * abs(left):
                return f"mode {k}: {back:.6g} against {left:.6g}"
        return ""

    def _coordinates(self, shape: Any) -> np.ndarray | None:
        """Vector of a shape over the printed coordinates; None where small rotations replace some of them."""
        labels = self.modes.small.numbers.coordinates
        return np.array([shape[q] for q in labels]) if all(q in shape for q in labels) else None

    @property
    def wrong_sums(self) -> str:
        values = np.array(self.modes.spectrum.eigenvalues)
        if len(values) != len(self.A):
            return f"{len(values)} for {len(self.A)} states"
        for k, trace in ((1, np.trace(self.A)), (2, np.trace(self.A @ self.A))):
            size = (abs(values) ** k).sum() + (abs(self.A).max(initial=0) * tolerances.SLOW) ** k
            if abs((values**k).sum() - trace) > tolerances.SAME_PLACE * size:
                return f"the sum of lambda^{k} is {(values**k).sum():.10g}, the trace {trace:.10g}"
        return ""

    # -- in closed form --------------------------------------------------------------------------------------

    @property
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
        coefficients = tuple(entries)
        for part in (7, -13):
            s = one * self.rate * part / 10
            upper = [[s * int(i == j) - x for j, x in enumerate(row)] + [-x for x in E[i]] for i, row in enumerate(F)]
            lower = [[*K[i], *(s * x + c for x, c in zip(M[i], C[i], strict=True))] for i in range(n)]
            rows = upper + lower
            det, p = _determinant(rows), _at(coefficients, s)
            size = sum(abs(c * s**k) for k, c in enumerate(coefficients))
            if abs(det - p) > tolerances.DIFFERENCE_AT_50 * size:
                return f"p({float(s):.6g}) = {float(p):.10g} against {float(det):.10g}"
        return ""

    @property
    def closed(self) -> list[float]:
        """The frequencies in closed form, in numbers."""
        return [number for number, _ in self.modes.closed if number >= 0]

    @property
    def wrong_frequency(self) -> str:
        for w in self.closed:
            away = abs(self.values.imag - w).min()
            if away > tolerances.SAME_PLACE * max(w, tolerances.SLOW * self.largest):
                return f"{w:.10g} rad/s is the frequency of no eigenvalue"
        printed = [f for f in self.modes.spectrum.oscillating if f.frequency]
        for mode in printed:
            assert mode.frequency is not None
            if abs(self.values.imag - mode.frequency).min() > tolerances.SAME_PLACE * self.largest:
                return f"{mode.frequency:.10g} rad/s is the frequency of no eigenvalue"
        return ""

    # -- stability -------------------------------------------------------------------------------------------

    @property
    def growth(self) -> float:
        """The largest real part, of the largest eigenvalue; those that are 0 left out."""
        zeros = sum(x == 0 for x in self.modes.spectrum.eigenvalues)
        left = self.values[np.argsort(abs(self.values))[zeros:]]
        return float(left.real.max(initial=-np.inf)) / self.largest if self.largest else 0.0

    @property
    def wrong_stability(self) -> str:
        said = self.modes.spectrum.stability
        if said == "unstable":
            return "none of them grows" if self.growth < -tolerances.CARRIED else ""
        if said == "unstable to first order":
            return "" if self._has_chains else "said to grow like t, and the eigenvalue 0 has all its modes"
        if said in ("stable", "asymptotically stable") and self._has_chains:
            return f"said to be {said}, and a motion grows like t"
        if said == "stable to first order" and self._drifts_away:
            return f"said to be {said}, and a motion grows like t into others"
        return (
            f"said to be {said}, and one of them grows"
            if said != "undecided" and self.growth > tolerances.SAME_PLACE
            else ""
        )

    @property
    def _has_chains(self) -> bool:
        """True if A has Jordan chains at 0: A^2 has a larger null space than A, so some motions grow like t."""
        zeros = sum(x == 0 for x in self.modes.spectrum.eigenvalues)
        sizes = np.linalg.svd(self.A, compute_uv=False)
        return zeros > 0 and int(np.sum(sizes <= tolerances.COMPUTED * sizes.max(initial=0))) < zeros

    @property
    def _drifts_away(self) -> bool:
        """True if a motion that grows like t leads to where the equations are others.

        With constraints and small rotations this is not decided, and False.
        """
        small = self.modes.small
        system, e, numbers = small.first.system, small.first.equations, small.reference.numbers
        constrained = system.constraints.closing or system.elimination is not None
        if constrained or not {*small.numbers.coordinates} <= numbers.keys() or not self._has_chains:
            return False
        sizes, columns = np.linalg.svd(self.A @ self.A)[1:]
        slow = columns[sizes <= tolerances.COMPUTED * sizes.max(initial=0)]
        drifts = (self.A @ slow.T).T
        drift = max(drifts, key=lambda x: float(np.linalg.norm(x)))[: len(small.numbers.coordinates)]
        if not np.linalg.norm(drift) > tolerances.SAME_PLACE * self.rate:
            return False
        drift = drift / abs(drift).max()
        there = {q: numbers[q] + ASIDE * float(x) for q, x in zip(small.numbers.coordinates, drift, strict=True)}
        entries = (*(x for row in e.M for x in row), *e.forcing)
        here, moved = (evaluate(entries, {**numbers, **more}, fifty_digits()) for more in ({}, there))
        return any(abs(x - y) > tolerances.COMPUTED * (1 + abs(x)) for x, y in zip(here, moved, strict=True))

    def conditions(self) -> Check:
        """All are positive where nothing grows, and one is not where something does."""
        name = "the conditions of stability hold where nothing grows, and only there"
        return attempted(name, FLOATS, lambda: self._wrong_conditions)

    @property
    def _wrong_conditions(self) -> str:
        return self._wrong_here or first_wrong(map(self._wrong_elsewhere, range(DRAWS)))

    def _wrong_elsewhere(self, seed: int) -> str:
        """Message if a statement on stability is wrong at other parameters, by roots of the proven polynomial; ""."""
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
        if least < 0 and (grows < -SURELY or (not conditions.fading and grows < tolerances.CARRIED)):
            return "one does not hold for other parameters, and no root grows"
        return ""

    def _meets_zero(self, trial: Mapping[Node, Any], drawn: Mapping[Node, Any]) -> bool:
        """True if the leading coefficient comes near 0 on the way: (R - r)^2 keeps its sign, and its root does not."""
        assert self.modes.polynomial is not None
        leading = self.modes.polynomial.coefficients[-1:]
        try:
            ways = [{x: float(v) + k / STEPS * float(drawn[x] - v) for x, v in trial.items()} for k in range(STEPS + 1)]
            sizes = [abs(float(evaluate(leading, way)[0])) for way in ways]
        except (NoValue, ZeroDivisionError, OverflowError):
            return True
        return min(sizes) < MET * min(sizes[0], sizes[-1])

    @property
    def _wrong_here(self) -> str:
        least = min(evaluate(self.modes.conditions.expressions, self.modes.small.reference.trial, fifty_digits()))
        if least > 0 and self.growth > tolerances.SAME_PLACE:
            return "all hold, and an eigenvalue grows"
        fading = least < 0 and self.growth < -tolerances.SAME_PLACE
        return "one does not hold, and all eigenvalues fade" if fading else ""

    # -- inputs ----------------------------------------------------------------------------------------------

    @property
    def wrong_transfer(self) -> str:
        small, names = self.modes.small, self.modes.small.numbers
        trial = {x: float(v) for x, v in small.reference.trial.items()}
        for s in (self.rate * x for x in SAMPLES):
            answers = np.linalg.solve(s * np.eye(len(self.A)) - self.A, small.input_matrix.astype(complex))
            for f in self.modes.transfers:
                i, j = names.coordinates.index(f.coordinate), names.inputs.index(f.input)
                found = _value(f.above.coefficients, s, trial) / _value(f.below.coefficients, s, trial)
                if abs(found - answers[i, j]) > tolerances.SAME_PLACE * abs(answers[:, j]).max():
                    return f"{f.coordinate.name}/{f.input.name}: {found:.6g} against {answers[i, j]:.6g}"
        return ""


def _determinant(rows: Sequence[Sequence[Any]]) -> Any:
    """det A by elimination with the largest pivot of each column."""
    left, product = [list(row) for row in rows], fifty_digits().number(1)
    while left:
        k = max(range(len(left)), key=lambda i: abs(left[i][0]))
        pivot = left.pop(k)
        if not pivot[0]:
            return pivot[0]
        product *= -pivot[0] if k % 2 else pivot[0]
        left = [[x - row[0] / pivot[0] * y for x, y in zip(row[1:], pivot[1:], strict=True)] for row in left]
    return product


def _value(coefficients: Sequence[Any], s: complex, trial: dict[Node, Any]) -> complex:
    digits = {x: fifty_digits().number(v) for x, v in trial.items()}
    numbers = (c if isinstance(c, float) else float(evaluate((c,), digits, fifty_digits())[0]) for c in coefficients)
    return complex(_at([*numbers], s))


def _at(coefficients: Sequence[Any], s: Any) -> Any:
    """Value of a polynomial, the constant first."""
    value: Any = 0
    for c in reversed(coefficients):
        value = value * s + c
    return value


def _factor(rng: Random, positive: bool) -> Any:
    """Random factor of a parameter, between 1/7 and 7; now and then negative where the parameter may be."""
    size = fifty_digits().number(round(10**6 * math.exp(rng.uniform(-2, 2)))) / 10**6
    return -size if not positive and rng.random() < 0.3 else size
