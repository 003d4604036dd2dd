"""Modes -> checks of small motions: the printed matrices against differences of the equations of motion.

A motion beside the reference starts at q_0 + h d, u_0 + h e, inputs w_0 + h f in a random direction; the equations of
motion say how it goes on. What it does against the reference, over h, must satisfy what is printed:

    M dq'' + C dq' + K dq = B dw,      or  M du' + C du + K dq = B dw,  dq' = F dq + E du,      x' = A x + B_x w

M against the kinetic energy: d . M d is the second difference of T along d. Shared with what is proven: the state of
the reference, the equations of motion (proven by themselves) and the choice of coordinates; no derivative, nothing of
how ties are taken out.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from random import Random
from typing import Any

import numpy as np

from eomgen.mechanics.small_motions.linearization import SmallMotions
from eomgen.mechanics.small_motions.modes import Modes
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.proof.check import Check, checked, unchecked
from eomgen.proof.modes import mode_checks
from eomgen.proof.motions_beside import Beside, Differences, DigitColumn
from eomgen.proof.nearby import State
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits, sums_of_products
from eomgen.symbolic.numeric.tolerances import (
    CARRIED,
    COMPUTED,
    DIFFERENCE_AT_50,
    ROUNDING,
    SLOW,
    ZERO_AT_50,
)

DIRECTIONS = 3  # random ones: a wrong entry is seen by each of them
BY_DIFFERENCES = "differences at 50 digits"


# -- the matrices --------------------------------------------------------------------------------------------------


def small_motion_checks(modes: Modes) -> Iterator[Check]:
    """Of the reference, the matrices, and the modes."""
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
    """Nothing is accelerated there; at rest nothing moves."""
    small, origin = differences.small, differences.origin
    A = abs(small.state_matrix)
    state = [abs(float(origin.state.get(x, 0))) for x in (*small.numbers.coordinates, *small.numbers.speeds)]
    usual = dict(zip(small.numbers.speeds, A[-len(small.numbers.speeds) :] @ np.maximum(1.0, state), strict=True))
    most = max(usual.values())
    wrong = [
        f"{u.name} changes by {float(origin.a[u]):.3g}"
        for u in differences.nearby.u
        if abs(origin.a[u]) > COMPUTED * (usual.get(u) or most) + ZERO_AT_50  # of one that nothing asks: the others
    ]
    name = "the equations of motion hold at the reference, without acceleration"
    return checked(name, "; ".join(wrong), "50 digits")


def _matrices(modes: Modes, differences: Differences) -> Iterator[Check]:
    """M, C, K, B (F, E) and the state matrix."""
    small, rng = differences.small, Random(11)
    if differences.is_part:
        yield _of_part(differences)
        return
    exact, tolerance = _entries(modes), DIFFERENCE_AT_50 if small.exact is not None else COMPUTED
    beside, energies = [], []
    for _ in range(DIRECTIONS):
        moved = (*small.whole.coordinates, *small.whole.speeds, *small.whole.inputs)
        beside.append(differences.along(_random(moved, rng)))
        energies.append(differences.energy_along(_random(small.whole.speeds, rng)))
    wrong = {
        "motion": _in_equations(small, exact, beside, tolerance),
        "state": _in_state_form(small, beside),
        "mass": _in_energy(small, exact["M"], energies, tolerance),
    }
    form = "M q'' + C q' + K q = B w" if small.is_second_order else "M u' + C u + K q = B w, q' = F q + E u"
    yield checked(f"motions beside the reference satisfy {form}", wrong["motion"], BY_DIFFERENCES)
    yield checked("they satisfy x' = A x + B w", wrong["state"], BY_DIFFERENCES)
    yield checked("M is the second derivative of the kinetic energy along them", wrong["mass"], BY_DIFFERENCES)


def _of_part(differences: Differences) -> Check:
    """Of the coordinates that are asked alone: they answer to forces on them as they do in the whole.

    (s^2 M + s C + K)^-1 is their part of the first rows of (s 1 - A)^-1 [0; M^-1] of the whole, A and M by differences.
    """
    small, e = differences.small, differences.small.numbers
    asked = [differences.moved.index(q) for q in e.coordinates]
    whole = differences.whole()
    wrong = ""
    for s in (0.7 + 0.9j, -0.4 + 2.3j):
        s *= abs(small.state_matrix).max() ** 0.5 or 1.0
        pencil = sum((s**k * np.array(A, dtype=float) for k, A in enumerate((e.K, e.C, e.M))))
        answer = np.linalg.inv(pencil)
        away = abs(answer - whole(s)[np.ix_(asked, asked)]).max() / abs(answer).max()
        wrong = wrong or ("" if away <= CARRIED else f"their answers differ by {away:.2g}")
    return checked("the coordinates that are asked move as they do in the whole", wrong, "differences, floating point")


def _entries(modes: Modes) -> dict[str, list[list[Any]]]:
    """The printed matrices in numbers: exact ones with 50 digits; C of second order is printed in its parts."""
    small = modes.small
    e: LinearEquations = small.exact or small.numbers
    whole = {"C": _numbers(small, e.C)} if small.is_second_order else {}
    return {letter: _numbers(small, getattr(e, letter), modes) for letter in "MCKBFE" if letter not in whole} | whole


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
    """Which of the printed parts of C and K is not what its letter says, or ""."""
    small = modes.small
    whole = {letter: _numbers(small, getattr(small.exact or small.numbers, letter)) for letter in "CK"}
    parts = {
        name: _numbers(small, A if name == "S" else _printed_half(modes, A))
        for name, A in modes.symmetric_parts.items()
    }
    tolerance = ZERO_AT_50 if small.exact is not None else ROUNDING
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
    """A symmetric or skew matrix, above the diagonal as it is printed."""
    return [[modes.written(x) if j >= i else x for j, x in enumerate(row)] for i, row in enumerate(A)]


def _random(nodes: Sequence[Node], rng: Random) -> State:
    return {x: fifty_digits().number(rng.choice((-1, 1)) * rng.randint(50, 100)) / 100 for x in nodes}


def _in_equations(
    small: SmallMotions, A: Mapping[str, list[list[Any]]], beside: Sequence[Beside], tolerance: float
) -> str:
    """Of M a + C u + K q - B w and -q' + F q + E u the first row of which something is left, or ""."""
    pushed = [[-x for x in row] for row in A["B"]]
    left = [[*m, *c, *k, *b] for m, c, k, b in zip(A["M"], A["C"], A["K"], pushed, strict=True)]
    units = [sum(map(abs, row)) for row in A["M"]]
    balances = sums_of_products(left, [[*a, *u, *at.q, *at.w] for at, u, a in _moving(small, beside)])
    rates = sums_of_products(
        [[*f, *e] for f, e in zip(A["F"], A["E"], strict=True)], [[*at.q, *u] for at, u, _ in _moving(small, beside)]
    )
    for at, rows, also in zip(beside, balances, rates, strict=True):
        for speed, row, unit in zip(small.numbers.speeds, rows, units, strict=True):
            if wrong := _left(0, row, tolerance, unit):
                return f"the equation of {speed.name.rstrip(chr(39))}: {wrong}"
        for q, rate, row in zip(small.numbers.coordinates, at.q1, also, strict=True):
            if wrong := _left(-rate, row, tolerance):
                return f"the rate of {q.name}: {wrong}"
    return ""


def _in_state_form(small: SmallMotions, beside: Sequence[Beside]) -> str:
    names = [x.name for x in (*small.numbers.coordinates, *small.numbers.speeds)]
    both = np.hstack([small.state_matrix, small.input_matrix]).tolist()
    found = sums_of_products(both, [[*at.q, *u, *at.w] for at, u, _ in _moving(small, beside)])
    for (at, _, a), rows in zip(_moving(small, beside), found, strict=True):
        for name, rate, row in zip(names, (*at.q1, *a), rows, strict=True):
            if wrong := _left(-rate, row, COMPUTED):
                return f"the row of {name}: {wrong}"
    return ""


def _moving(small: SmallMotions, beside: Sequence[Beside]) -> list[tuple[Beside, DigitColumn, DigitColumn]]:
    """Each with the speeds and their rates that the equations speak of."""
    return [(at, at.q1, at.q2) if small.is_second_order else (at, at.u, at.a) for at in beside]


def _in_energy(
    small: SmallMotions, M: list[list[Any]], energies: Sequence[tuple[Any, DigitColumn, DigitColumn]], tolerance: float
) -> str:
    """Of d . M d - T'' along each d what is left, or ""."""
    along = [q1 if small.is_second_order else u for _, q1, u in energies]
    for (T, _, _), d, rows in zip(energies, along, sums_of_products(M, along), strict=True):
        products = [(x * y, abs(x) * size) for x, (y, size) in zip(d, rows, strict=True)]
        if wrong := _left(-T, (sum(x for x, _ in products), sum(size for _, size in products)), tolerance):
            return wrong
    return ""


def _left(other: Any, sums: tuple[Any, Any], tolerance: float, unit: Any = 1) -> str:
    """What is left of terms that cancel one another; "" where it is rounding, of them or of a rate of one unit.

    Args:
        other: one of them.
        sums: of the others, and of their sizes.
    """
    left, size = other + sums[0], abs(other) + sums[1]
    if abs(left) <= tolerance * (size + SLOW * unit):
        return ""
    return f"{float(left):.3g} is left, of terms of {float(size):.3g}"
