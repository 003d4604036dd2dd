"""Regressor, fit -> checks of them by the equations of motion, and by numbers that share nothing with them.

Y pi + y0 = M a + c - Q without inputs              exactly
Y pi = Y_base K pi                                  of any pi, at states that keep the constraints, along their motions
formula as printed, read back = sum of its numbers times any pi
W^T (b - W beta) = 0                                of the samples: the residual is orthogonal to every column
Z^T (M a - forcing) = W pi - b                      of some samples, pi the model's, Z the motions that the constraints
allow
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import islice
from random import Random
from typing import Any, Protocol

import numpy as np

from eomgen.frozen import dataclass
from eomgen.identification.base_parameters import BaseParameters, Group, columns_along, constrained_states, in_50_digits
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.free_bodies import equations_of_motion
from eomgen.proof import Certificate, Check, PhaseMotion, Tally, TriedState, attempted, certify, checked, first_wrong
from eomgen.symbolic.exact import equal_at_random_states
from eomgen.symbolic.expression import Fraction, ScalarRow, parse, substituted
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

POOR = 1e6  # a condition beyond which its square is lost in doubles
NEARLY = 1e-3  # share by which two ways of least squares may differ
STACKED = "samples give the forces of the model as its equations do"
SEED, STATES = 11, 3  # others than those at which the groups were found
FAR, UNSURE = 10.0, 10.0  # times its change by more noise, and the spread of that: a bias is not so large
ENOUGH = 2  # rows of a base parameter, which distinguish them


class LinearForces(Protocol):
    """tau + J^T lam = Y pi + y0, and its groups."""

    @property
    def system(self) -> System: ...
    @property
    def parameters(self) -> tuple[str, ...]: ...
    @property
    def rows(self) -> tuple[ScalarRow, ...]: ...
    @property
    def tau(self) -> ScalarRow: ...
    @property
    def base(self) -> BaseParameters: ...


def certify_regressor(found: LinearForces) -> Certificate:
    """Proof of the regressor and its groups, based on the proof of the equations of motion."""
    equations = equations_of_motion(found.system)
    name = "Y pi + y0 are the forces that motions take"
    checks = [attempted(name, "prime field, or 50 digits", partial(_other_forces, found, equations))]
    checks += groups_checked(found)
    return Certificate((*certify(equations).checks, *checks))


def _other_forces(found: LinearForces, equations: EquationsOfMotion) -> str:
    """Y pi + y0 against M a + c - Q."""
    symbols, rows = equations.symbols, zip(equations.M, equations.c, equations.Q, strict=True)
    needed = tuple(sum((m * a for m, a in zip(row, symbols.a, strict=True)), start=c - Q) for row, c, Q in rows)
    needed = substituted(needed, dict.fromkeys(symbols.inputs.values(), 0))
    verdict = equal_at_random_states(list(zip(found.tau, needed, strict=True)))
    return "" if verdict.equal else f"row {(verdict.culprit or 0) + 1} is another force"


def groups_checked(found: LinearForces) -> Iterator[Check]:
    """Y pi against Y_base K pi, and the texts of K."""
    tally = Tally("base parameters give the forces that all parameters give", "50 digits, any parameters")
    for k, (state, along) in enumerate(islice(constrained_states(found.system, Random(SEED)), STATES)):
        tally.add(f"state {k + 1}", partial(_another_force, found, state, along, Random(SEED + k)))
    yield from tally.checks()
    yield attempted(
        "no base parameter follows from the others", "50 digits, orthogonal columns", partial(_followers, found)
    )
    tally = Tally("formulas of base parameters, read back, give their numbers", "our grammar, 50 digits")
    for group in found.base.groups:
        tally.add(group.name, partial(_misread, found, group))
    yield from tally.checks()


def _another_force(found: LinearForces, state: Any, along: np.ndarray, rng: Random) -> str:
    Y = columns_along(found.system, found.rows, range(len(found.parameters)), state, along)
    pi = [in_50_digits(Fraction(rng.randrange(-999, 1000), 100)) for _ in found.parameters]
    value = dict(zip(found.parameters, pi, strict=True))
    base = [sum(in_50_digits(f) * value[p] for p, f in group.numbers.items()) for group in found.base.groups]
    leads = [found.parameters.index(group.name) for group in found.base.groups]
    for row in Y:
        whole, short = sum(row * pi), sum(row[leads] * base)
        size = sum(map(abs, row * pi))
        if abs(whole - short) > tolerances.COMPUTED * size:
            return f"{float(short):.10g} for {float(whole):.10g}"
    return ""


def _followers(found: LinearForces) -> str:
    """Message with the number of columns of Y_base that depend on the others at many states; "".

    A part of one freedom gives one row a state, however many rows the others give: as long as columns follow, there
    are to be as many states as rows.
    """
    leads = [found.parameters.index(group.name) for group in found.base.groups]
    rows: list[np.ndarray] = []
    due = enough = ENOUGH * len(leads)
    few = len(leads)
    for k, (state, along) in enumerate(islice(constrained_states(found.system, Random(SEED + STATES)), enough + 1)):
        rows += [*columns_along(found.system, found.rows, leads, state, along)]
        if rows and (len(rows) > due or k == enough):
            due = 2 * len(rows)
            few = len(leads) - _rank(np.array(rows, dtype=object))
            if not few:
                break
    return f"{few} of {len(leads)} follow" if few and len(rows) >= len(leads) else ""


def _rank(W: np.ndarray) -> int:
    """Number of independent columns: by doubles where these decide it, else by orthogonalization with 50 digits."""
    columns = [column / max(map(abs, column)) for column in W.T if any(column)]
    values = np.linalg.svd(np.array(columns, dtype=float), compute_uv=False) if columns else np.zeros(0)
    if len(columns) == W.shape[1] and all(values > tolerances.RANK * values[0]):
        return len(columns)
    rank = 0
    while columns:
        squares = [column.dot(column) for column in columns]
        longest = max(range(len(columns)), key=squares.__getitem__)
        if squares[longest] <= tolerances.FOLLOWS_AT_50**2:
            break
        rank += 1
        along, square = columns.pop(longest), squares[longest]
        columns = [column - column.dot(along) / square * along for column in columns]
    return rank


def _misread(found: LinearForces, group: Group) -> str:
    """The formula as it is printed, with numbers for its parameters, against the group's numbers."""
    scope, rng = found.system.scope, Random(group.name)
    pi = {name: Fraction(rng.randrange(100, 1000), 100) for name in group.terms}
    named = "|".join(map(re.escape, sorted(pi, key=len, reverse=True))) or "(?!)"
    text = re.sub(rf"(?<!\w)({named})", lambda name: f"({pi[name[1]]})", group.formula)
    (read,) = evaluate((scope.value(parse(text or "0")),), scope.values_of_parameters(None), fifty_digits())
    terms = [group.numbers[name] * float(value) for name, value in pi.items()]
    if abs(read - sum(terms)) > tolerances.COMPUTED * (1 + sum(map(abs, terms))):
        return f"{group.formula} is {float(read):.10g}, not {sum(terms):.10g}, for parameters by lot"
    return ""


def fit_checked(W: np.ndarray, b: np.ndarray, beta: np.ndarray) -> Check:
    """Check of least squares: the residual is orthogonal to every column."""
    left, size = b - W @ beta, np.linalg.norm(W, axis=0) * (np.linalg.norm(b) + np.linalg.norm(W @ beta))
    worst = float(np.max(np.abs(W.T @ left) / np.where(size > 0, size, 1), initial=0.0))
    wrong = (
        ""
        if worst <= tolerances.COMPUTED
        else f"the residual of the forces is not orthogonal to a column, by {worst:.1e}"
    )
    return checked(
        "the residual of the fit is orthogonal to the columns of the base parameters",
        wrong,
        "floating point, all samples",
    )


def bias_checked(bias: np.ndarray, moved: np.ndarray, deviations: np.ndarray) -> Check:
    """Check of the bias by noise: noise of the same size once more moves the fit about as far.

    Args:
        moved: change of each base parameter in every fit to noisier samples, draws x parameters.
    """
    usual, spread = np.mean(moved, axis=0), np.std(moved, axis=0) + deviations
    far = np.abs(bias) > FAR * np.abs(usual) + UNSURE * spread
    wrong = [f"{bias[k]:.3g} for {usual[k]:.3g}" for k in np.flatnonzero(far)]
    return checked("noise once more moves the fit by about its bias", first_wrong(wrong), f"{len(moved)} draws")


@dataclass(frozen=True)
class StackedSamples:
    """Samples as they were stacked.

    Args:
        t, states, inputs: instants; q, u and a of each; and the inputs that the data give, by name.
        rows: of each W and b, along the motions that the constraints allow there.
        pi: the model's own parameters, p those of its symbols.
    """

    t: np.ndarray
    states: np.ndarray
    inputs: Mapping[str, np.ndarray]
    rows: Sequence[tuple[np.ndarray, np.ndarray]]
    pi: np.ndarray
    p: Sequence[float]


def samples_checked(found: LinearForces, samples: StackedSamples) -> Check:
    """W pi - b of the first, middle and last sample, by the equations of motion with the forces applied there."""
    motion, tally = PhaseMotion(equations_of_motion(found.system)), Tally(STACKED, "equations of motion, 50 digits")
    for k in dict.fromkeys((0, len(samples.t) // 2, len(samples.t) - 1)):
        tally.add(f"sample {k + 1}", partial(_left_otherwise, motion, samples, k))
    return next(tally.checks())


def _left_otherwise(motion: PhaseMotion, samples: StackedSamples, k: int) -> str:
    symbols = motion.equations.symbols
    x, a = np.split(samples.states[k], [len(symbols.x)])
    given = {name: float(column[k]) for name, column in samples.inputs.items()}
    here = motion.numbers(TriedState(float(samples.t[k]), x, samples.p, given))
    left, terms = here.M @ a - here.forcing, np.abs(here.M) @ np.abs(a) + np.abs(here.forcing)
    W, b = samples.rows[k]
    due, size = W @ samples.pi - b, 1 + float(np.max(terms, initial=0.0))
    if len(here.J):  # the length of the residual along the constraints does not depend on axes
        along = left - here.J.T @ np.linalg.lstsq(here.J.T, left, rcond=tolerances.RANK_NEARBY)[0]
        due, left = np.array([np.linalg.norm(due)]), np.array([np.linalg.norm(along)])
    worst = int(np.argmax(np.abs(due - left)))
    return (
        "" if abs(due[worst] - left[worst]) <= tolerances.COMPUTED * size else f"{due[worst]:.9g} for {left[worst]:.9g}"
    )


def spread_checked(W: np.ndarray, b: np.ndarray, deviations: np.ndarray, condition: float, residual: float) -> Check:
    """Check by W = Q R: beta = R^-1 Q^T b, deviations |rows of R^-1| s, s^2 = |b - Q Q^T b|^2/(n - k).

    The condition is the root of the largest over the least eigenvalue of the Gram matrix of columns of length 1.
    """
    n, k = W.shape
    Q, R = np.linalg.qr(W)
    left = b - Q @ (Q.T @ b)
    rms = float(np.sqrt(left @ left / n))
    s = np.linalg.norm(left) / np.sqrt(max(1, n - k))
    due = np.linalg.norm(np.linalg.inv(R), axis=1) * s
    columns = W / np.linalg.norm(W, axis=0)
    squares = np.linalg.eigvalsh(columns.T @ columns)
    found = float(np.sqrt(squares[-1] / squares[0])) if squares[0] > 0 else math.inf
    rounding = tolerances.COMPUTED * float(np.abs(b).max(initial=0.0))
    wrong = [
        f"{what} is {a:.6g} for {right:.6g}"
        for what, a, right, sure in (
            *((f"deviation {j + 1}", x, y, s > rounding) for j, (x, y) in enumerate(zip(deviations, due, strict=True))),
            ("the condition", condition, found, found < POOR),
            ("the residual", residual, rms, rms > rounding),
        )
        if sure and not abs(a - right) <= NEARLY * abs(right)
    ]
    name = "deviations, condition and residual of the fit are those of W = Q R"
    return checked(name, first_wrong(wrong), "floating point, all samples")
