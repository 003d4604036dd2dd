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
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
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
    A, B = (_in_rows(x.ravel().tolist(), x.tolist()) for x in (small.state_matrix, small.input_matrix))
    exact, tolerance = _entries(modes), DIFFERENCE_AT_50 if small.exact is not None else COMPUTED
    wrong: dict[str, str] = {"motion": "", "state": "", "mass": ""}
    for _ in range(DIRECTIONS):
        beside = differences.along(_random((*small.whole.coordinates, *small.whole.speeds, *small.whole.inputs), rng))
        wrong["motion"] = wrong["motion"] or _in_equations(small, exact, beside, tolerance)
        wrong["state"] = wrong["state"] or _in_state_form(small, A, B, beside)
        wrong["mass"] = wrong["mass"] or _in_energy(differences, exact["M"], rng, tolerance)
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
    values = iter([one * x for x in flat])
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
            left = max(abs(a + c - whole[letter][i][j]), abs(a - b), abs(c + d))
            if left > tolerance * (abs(a) + abs(c)):
                return f"entry {i + 1}, {j + 1} of {even} or {odd}"
    return ""


def _printed_half(modes: Modes, A: list[list[Any]]) -> list[list[Any]]:
    """A symmetric or skew matrix, above the diagonal as it is printed."""
    return [[modes.written(x) if j >= i else x for j, x in enumerate(row)] for i, row in enumerate(A)]


def _random(nodes: Sequence[Node], rng: Random) -> State:
    return {x: fifty_digits().number(rng.choice((-1, 1)) * rng.randint(50, 100)) / 100 for x in nodes}


def _in_equations(small: SmallMotions, A: Mapping[str, list[list[Any]]], at: Beside, tolerance: float) -> str:
    u, a = (at.q1, at.q2) if small.is_second_order else (at.u, at.a)
    for i, speed in enumerate(small.numbers.speeds):
        pushes = [-x for x in _terms(A["B"][i], at.w)]
        terms = [*_terms(A["M"][i], a), *_terms(A["C"][i], u), *_terms(A["K"][i], at.q), *pushes]
        if wrong := _left(terms, tolerance, sum(map(abs, A["M"][i]))):
            return f"the equation of {speed.name.rstrip(chr(39))}: {wrong}"
    for i, q in enumerate(small.numbers.coordinates):
        if wrong := _left([-at.q1[i], *_terms(A["F"][i], at.q), *_terms(A["E"][i], u)], tolerance):
            return f"the rate of {q.name}: {wrong}"
    return ""


def _in_state_form(small: SmallMotions, A: list[list[Any]], B: list[list[Any]], at: Beside) -> str:
    u, a = (at.q1, at.q2) if small.is_second_order else (at.u, at.a)
    names = [x.name for x in (*small.numbers.coordinates, *small.numbers.speeds)]
    rows = zip(names, A, B, (*at.q1, *a), strict=True)
    for name, row, push, rate in rows:
        if wrong := _left([-rate, *_terms(row, (*at.q, *u)), *_terms(push, at.w)], COMPUTED):
            return f"the row of {name}: {wrong}"
    return ""


def _in_energy(differences: Differences, M: list[list[Any]], rng: Random, tolerance: float) -> str:
    small = differences.small
    T, q1, u = differences.energy_along(_random(small.whole.speeds, rng))
    d = q1 if small.is_second_order else u
    return _left(
        [-T, *(x * y * m for x, row in zip(d, M, strict=True) for y, m in zip(d, row, strict=True))], tolerance
    )


def _terms(row: DigitColumn, x: DigitColumn) -> list[Any]:
    """The terms of row x, but for those that are 0."""
    return [a * b for a, b in zip(row, x, strict=True) if a]


def _left(terms: DigitColumn, tolerance: float, unit: Any = 1) -> str:
    """What is left of terms that cancel one another; "" where it is rounding, of them or of a rate of one unit."""
    left, size = sum(terms), sum(map(abs, terms))
    return (
        ""
        if abs(left) <= tolerance * (size + SLOW * unit)
        else f"{float(left):.3g} is left, of terms of {float(size):.3g}"
    )
