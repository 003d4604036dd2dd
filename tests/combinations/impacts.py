"""The oracle of an impact with friction at a contact that is hit alone: Routh's graph, followed in small steps of p.

D of (v_n, v_t) for unit impulses comes from the maximal coordinates: joints, constraints and drives hold.

    v_n' = D_nn + D_nt F,   v_t' = D_tn + D_tt F       by the normal impulse p;   F = - mu v_t/|v_t|, or it sticks

Imports nothing of eomgen.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import laws
import numpy as np
from oracle import NoAnswer, Oracle, Row, State, least_squares

STEPS = 200  # of the impulse that would stop the approach without friction
STILL = 1e-10  # of the speed before: it has stopped to slide


@dataclass(frozen=True)
class Course:
    """An impact so far: the speeds (v_n, v_t), the impulses, the work of the normal one."""

    v: np.ndarray
    p: np.ndarray
    W: float = 0.0


def after(o: Oracle, s: State, name: str, law: str) -> tuple[State, np.ndarray]:
    """(the state after the impact of a contact with friction, its impulses (p_n, p_t))."""
    constraint, now = o.model.constraints[name], o.maximal(s)
    others = [row for row in (*o.joint_rows(now), *o.constraint_rows(now, dict.fromkeys(o.modes, False)))]
    others += [Row(f"drive {q}", now.q[q], role="drive") for q in o.drives(s.t)]
    own = [Row(name, c, rate, role) for c, rate, role in laws.constraint_rows(name, constraint, now, o) if role == "n"]
    own += [Row(name, slip, True, "t") for slip in laws.slips(now, constraint)]
    L, J = (np.array([row.parts()[0] for row in rows]) for rows in (own, others))
    before = np.array([row.parts()[2] for row in own])
    M, _ = o._masses(now, s)
    k = len(J)
    A = np.block([[M, -J.T], [J, np.zeros((k, k))]])
    changed = np.array([least_squares(A, np.concatenate([row, np.zeros(k)]))[0][: len(M)] for row in L])
    D = L @ changed.T
    mu, e = (o.model.number(constraint[x]) for x in ("friction", "restitution"))
    p = routh((D + D.T) / 2, before, laws.IMPACTS["cone"](mu), e, law)
    return replace(s, v=s.v + (p @ changed)[6 * len(o.bodies) :]), p


def routh(D: np.ndarray, v: np.ndarray, mu: float, e: float, law: str) -> np.ndarray:
    """The impulses of a contact that is approached with v = (v_n, v_t)."""
    now = Course(np.array(v, dtype=float), np.zeros(len(v)))
    if v[0] >= 0:
        return now.p
    step, still = -v[0] / D[0, 0] / STEPS, STILL * float(np.linalg.norm(v))
    now = _until(lambda c: c.v[0], D, now, mu, step, still)
    p, W = now.p[0], now.W
    left = {
        "newton": lambda c: c.v[0] + e * v[0],
        "poisson": lambda c: c.p[0] - (1 + e) * p,
        "energetic": lambda c: c.W - (1 - e**2) * W,
    }[law]
    return _until(left, D, now, mu, step, still).p


def _until(left, D: np.ndarray, now: Course, mu: float, step: float, still: float) -> Course:
    """The course up to where what is left is 0."""
    for _ in range(100 * STEPS):
        h = step
        if np.linalg.norm(now.v[1:]) <= still:
            now = replace(now, v=np.array([now.v[0], *(0 * now.v[1:])]))
            stick = -np.linalg.solve(D[1:, 1:], D[1:, 0])
            if np.linalg.norm(stick) > mu:
                now = replace(now, v=np.array([now.v[0], *(2 * still * _leaving(D, mu))]))
        else:
            b = _slope(D, now.v, mu)[1:]
            if b @ now.v[1:] < 0:
                h = min(h, 0.2 * float(np.linalg.norm(now.v[1:]) / np.linalg.norm(b)))
        later = _step(D, now, mu, h)
        if left(later) >= 0:
            low, high = 0.0, h
            for _ in range(60):
                half = (low + high) / 2
                low, high = (low, half) if left(_step(D, now, mu, half)) >= 0 else (half, high)
            return _step(D, now, mu, high)
        now = later
    raise NoAnswer("an impact that does not end")


def _leaving(D: np.ndarray, mu: float) -> np.ndarray:
    s = D[1:, 0] / np.linalg.norm(D[1:, 0])
    for _ in range(2000):
        b = D[1:, 0] - mu * D[1:, 1:] @ s
        s = s + 0.2 * (b / np.linalg.norm(b) - s)
        s = s / np.linalg.norm(s)
    if np.linalg.norm(b / np.linalg.norm(b) - s) > 1e-9:
        raise NoAnswer("no direction in which it begins to slide")
    return s


def _force(D: np.ndarray, v: np.ndarray, mu: float) -> np.ndarray:
    if np.any(v[1:]):
        return -mu * v[1:] / np.linalg.norm(v[1:])
    return -np.linalg.solve(D[1:, 1:], D[1:, 0])


def _slope(D: np.ndarray, v: np.ndarray, mu: float) -> np.ndarray:
    return D @ np.concatenate([[1.0], _force(D, v, mu)])


def _step(D: np.ndarray, now: Course, mu: float, h: float) -> Course:
    """By Runge and Kutta; what sticks goes on so."""

    sticks = not np.any(now.v[1:])  # then it stays so: no rounding of its speed makes it slide

    def rate(x: np.ndarray) -> np.ndarray:
        F = np.concatenate([[1.0], _force(D, now.v if sticks else x[: len(D)], mu)])
        return np.concatenate([D @ F, F, [x[0]]])

    x = np.concatenate([now.v, now.p, [now.W]])
    a = rate(x)
    b = rate(x + h / 2 * a)
    c = rate(x + h / 2 * b)
    d = rate(x + h * c)
    x = x + h / 6 * (a + 2 * b + 2 * c + d)
    v = x[: len(D)]
    if sticks:
        v[1:] = 0.0
    return Course(v, x[len(D) : 2 * len(D)], float(x[-1]))
