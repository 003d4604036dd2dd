"""Structures, linkages, by numpy and mpmath alone: what systems_of_strangers.toml asks."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np

G = 9.81
mp.mp.dps = 40


def sign_on_two_cables():
    """Moments about A (Beer & Johnston, Statics, sample problem 4.8): 101.3 lb, 315 lb, A = (338, 101.2, -22.5) lb."""
    B, E, D, C, Gp = map(np.array, ([8.0, 0, 0], [6.0, 0, 0], [0, 4.0, -8], [0, 3.0, 2], [4, -2.5, 0]))
    u, v = ((D - B) / 12, (C - E) / 7)
    W = np.array([0, -270.0, 0])
    M = np.column_stack([np.cross(B, u), np.cross(E, v)])[1:]
    T = np.linalg.solve(M, -np.cross(Gp, W)[1:])
    A = -(W + T[0] * u + T[1] * v)
    return dict(BD=T[0], EC=T[1], Ax=A[0], Ay=A[1], Az=A[2])


def lazy_tongs():
    """Two storeys of crossed bars of length l: T d(l cos th) + W d(2 l sin th) = 0 (Meriam, Statics, ch. 7)."""
    th = math.radians(35)
    return dict(T=1200 * 2 / math.tan(th), N=-400.0, R=400.0)


def pratt_truss():
    """Every joint of a Pratt truss in balance, 16 equations; its roller on a slope of 1 in 3."""
    xs = [0, 3, 6, 9, 12]
    nodes = {f"L{i}": (x, 0.0) for i, x in enumerate(xs)} | {f"U{i}": (x, 4.0) for i, x in enumerate(xs) if 0 < i < 4}
    mem = [
        "L0-L1",
        "L1-L2",
        "L2-L3",
        "L3-L4",
        "U1-U2",
        "U2-U3",
        "L0-U1",
        "L4-U3",
        "L1-U1",
        "L2-U2",
        "L3-U3",
        "U1-L2",
        "U3-L2",
    ]
    P = {"L1": (0, -20), "L2": (5, -30), "U3": (-7, -11)}
    idx = {n: i for i, n in enumerate(nodes)}
    A = np.zeros((16, 16))
    b = np.zeros(16)
    for j, m in enumerate(mem):
        p, q = m.split("-")
        d = np.subtract(nodes[q], nodes[p])
        d = d / np.hypot(*d)
        A[2 * idx[p] : 2 * idx[p] + 2, j] += d
        A[2 * idx[q] : 2 * idx[q] + 2, j] -= d
    A[0, 13] = A[1, 14] = 1
    n = np.array([1, 3]) / math.sqrt(10)
    k = 2 * idx["L4"]
    A[k : k + 2, 15] = n
    for m, f in P.items():
        b[2 * idx[m] : 2 * idx[m] + 2] -= f
    x = np.linalg.solve(A, b)
    return {f"m{i}": x[i] for i in range(13)} | {"N": x[15]}


def space_truss():
    """Six bars hold two joints in space: the balance of both."""
    nodes = dict(A=(0, 0, 0), B=(3, 0, 0), C=(0, 4, 0), D=(1, 1, 5), E=(2, -1, 6))
    mem = ["A-D", "B-D", "C-D", "A-E", "B-E", "D-E"]
    F = (100, -200, -900)
    P = {k: np.array(v, float) for k, v in nodes.items()}
    M = np.zeros((6, 6))
    b = np.zeros(6)
    b[3:] = [-f for f in F]
    for j, m in enumerate(mem):
        p, q = m.split("-")
        d = P[q] - P[p]
        d /= np.linalg.norm(d)
        for s, n in ((1, p), (-1, q)):
            if n in "DE":
                k = 3 * "DE".index(n)
                M[k : k + 3, j] += s * d
    x = np.linalg.solve(M, b)
    return {f"m{i}": x[i] for i in range(6)}


def screw_jack():
    """M = (W + m g) lead/2 pi of a thread without friction."""
    return dict(M=(8000 + 4 * G) * 0.006 / (2 * math.pi))


def gate_with_water():
    """A sloping gate under water: q = gamma b h/2 at its foot, S h = q L^2/3 (Beer & Johnston, ch. 5)."""
    q = 9810 * 2 * 3 * math.sqrt(3) / 2
    S = q * 3 / 2 * 2 / (3 * math.sqrt(3) / 2)
    n = np.array([math.sqrt(3) / 2, 0.5])
    A = -(q * 1.5 * n + S * np.array([-1, 0]))
    An = A @ n
    M = An * 1.5 + q / 2 * 1.5 / 2 * 0.5
    return {name: x / 1000 for name, x in dict(S=S, Ax=A[0], Ay=A[1], M=M).items()}  # kN


def chebyshev_lambda():
    """The coupler point of Chebyshev's lambda by two circles; M(th) by differences, drive = M'(th) w^2/2."""

    def mid(th):
        A = (mp.cos(th), mp.sin(th))
        dx, dy = (2 - A[0], -A[1])
        d = mp.hypot(dx, dy)
        r = mp.mpf("2.5")
        h = mp.sqrt(r * r - d * d / 4)
        return (next((A[0] + dx / 2 - s * h * dy / d, A[1] + dy / 2 + s * h * dx / d) for s in (1,)), A)

    def tip(th):
        B, A = mid(th)
        return (2 * B[0] - A[0], 2 * B[1] - A[1])

    th0 = mp.mpf("0.9")
    x, y = tip(th0)

    def D(f, n):
        return mp.diff(f, th0, n)

    def T(th):

        def part(f):
            return mp.diff(f, th)

        c = 0

        def ang_c(s):
            return mp.atan2(mid(s)[0][1] - mp.sin(s), mid(s)[0][0] - mp.cos(s))

        def ang_r(s):
            return mp.atan2(mid(s)[0][1], mid(s)[0][0] - 2)

        c += mp.mpf(1) / 3
        c += part(lambda s: mid(s)[0][0]) ** 2 + part(lambda s: mid(s)[0][1]) ** 2 + mp.mpf(25) / 12 * part(ang_c) ** 2
        c += mp.mpf("6.25") / 3 * part(ang_r) ** 2
        return c

    M = mp.diff(T, th0) / 2 * 4
    return dict(
        x=float(x),
        y=float(y),
        vx=float(2 * D(lambda s: tip(s)[0], 1)),
        ay=float(4 * D(lambda s: tip(s)[1], 2)),
        M=float(M),
    )


def tusi_couple():
    """A wheel in a ring twice its size: its rim keeps to a diameter; 3/2 m R^2 p'' = -m g R cos p."""
    R, m, p, w = (0.3, 2, 0.4, 3)
    p2 = -G * math.cos(p) * m * R / (1.5 * m * R * R)
    ax = -2 * R * (math.cos(p) * w * w + math.sin(p) * p2)
    t = 0.5 * m * R * R * -p2 / R
    return dict(y=0.0, ax=ax, t=t, p2=p2)


def scott_russell():
    """x = 2 l cos th, y = 2 l sin th: F dx = P dy."""
    return dict(F=-50 / math.tan(0.6), xQ=0.0)
