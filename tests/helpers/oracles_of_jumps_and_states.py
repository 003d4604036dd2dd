"""Machines with states, friction, stops and impacts, by numpy and scipy alone: what machines_of_strangers.toml asks.

Of a run the last state by its names; `t1`, `P1` are instant and impulse of its first impact, `end1` is the end of its
first phase. What slides, sticks and meets is decided here by hand, each event found by solve_ivp.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.optimize import brentq, lsq_linear

G = 9.81
Law = Callable[[float, np.ndarray], Sequence[float]]
Gap = Callable[[float, np.ndarray], float]


def until(rates: Law, t: float, end: float, x, *events: tuple[Gap, int], **options) -> tuple[float, np.ndarray, int]:
    """(instant, state, number of the event that comes first or -1) of x' = rates(t, x)."""
    watched = []
    for function, direction in events:

        def event(t, x, function=function):
            return function(t, x)

        event.terminal, event.direction = True, direction
        watched.append(event)
    how = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13} | options
    found = solve_ivp(rates, (t, end), x, events=watched or None, **how)
    hit = [k for k, instants in enumerate(found.t_events or ()) if len(instants)]
    return float(found.t[-1]), found.y[:, -1].copy(), hit[0] if hit and found.t[-1] < end else -1


def coulomb(m, force, kinetic, static, start, end: float, rates=lambda t, x, v, z: []):
    """(x, v, z) at the end, and the ends of phases, of m x'' = force(t, x, v, z) - kinetic(t, x, v) sign v."""
    kinetic, static = (f if callable(f) else lambda t, x, v, f=f: f for f in (kinetic, static))
    t, y, ends = 0.0, np.array(start, float), []
    sense = float(np.sign(y[1])) or _loose(force(t, y[0], 0.0, y[2:]), static(t, y[0], 0.0))
    while True:
        if sense:

            def moves(t, y, sense=sense):
                a = (force(t, y[0], y[1], y[2:]) - sense * kinetic(t, y[0], y[1])) / m
                return [y[1], a, *rates(t, y[0], y[1], y[2:])]

            t, y, hit = until(moves, t, end, y, (lambda t, y: y[1], -int(sense)))
        else:

            def stays(t, y):
                return [0.0, 0.0, *rates(t, y[0], 0.0, y[2:])]

            def grip(t, y):
                return static(t, y[0], 0.0) - abs(force(t, y[0], 0.0, y[2:]))

            t, y, hit = until(stays, t, end, y, (grip, -1))
        if hit < 0:
            return y, ends
        ends.append(t)
        push = force(t, y[0], 0.0, y[2:])
        sense, y[1] = (_loose(push, static(t, y[0], 0.0)) if sense else float(np.sign(push))), 0.0


def _loose(push: float, static: float) -> float:
    return 0.0 if abs(push) <= static else float(np.sign(push))


def impacts(found: Sequence[tuple[float, float]], most: int = 4) -> dict[str, float]:
    """t1, P1, t2, ... of the first impacts."""
    return {f"{letter}{k}": x for k, hit in enumerate(found[:most], 1) for letter, x in zip("tP", hit, strict=True)}


def first(function: Callable[[float], float], low: float, high: float, steps: int = 4000) -> float | None:
    """The first place where a function comes down to 0."""
    places = np.linspace(low, high, steps)
    values = [function(x) for x in places]
    for (a, b), (f, g) in zip(itertools.pairwise(places), itertools.pairwise(values), strict=True):
        if f > 0 >= g:
            return float(brentq(function, a, b, xtol=1e-16))
    return None


# -- motors, valves, tyres ---------------------------------------------------------------------------


def drop_hammer():
    """A motor lets its ram slip at 0.1 s: m v' = km i/rp - m g - F sign v, La i' = U - R i - km v/rp; v_r -> -e v_r."""
    m, Ma, k, c, F, e, R, La, km, rp = 40, 300, 4e5, 2e3, 20, 0.4, 0.8, 0.02, 0.9, 0.05
    y, ends = coulomb(
        m,
        lambda t, x, v, z: km * z[0] / rp - m * G,
        F,
        30,
        [0.6, 0, 21.8],
        0.1,
        lambda t, x, v, z: [(24 - R * z[0] - km * v / rp) / La],
    )
    t, x, hits, sense = 0.1, np.array([y[0], y[1], y[2], 0, 0]), [], 1.0
    while True:

        def falls(t, x, sense=sense):
            return [
                x[1],
                (km * x[2] / rp - m * G - F * sense) / m,
                (-R * x[2] - km * x[1] / rp) / La,
                x[4],
                (-k * x[3] - c * x[4]) / Ma,
            ]

        t, x, hit = until(falls, t, 0.97, x, (lambda t, x: x[0] - x[3], -1), (lambda t, x: x[1], -int(sense)))
        if hit < 0:
            return {"y": x[0], "z": x[3], "i": x[2], "end1": ends[0]} | impacts(hits)
        if hit == 0:
            P = -(1 + e) * (x[1] - x[4]) * m * Ma / (m + Ma)
            hits.append((t, P))
            x[1] += P / m
            x[4] -= P / Ma
            sense = float(np.sign(x[1]))
        else:
            sense = -sense


def stribeck_motor():
    """J w' = km i - S(w), La i' = U - R i - km w, S a cubic through values with a third derivative at its ends."""
    S = CubicSpline([0, 1, 3, 8, 20, 60], [0.24, 0.2, 0.15, 0.12, 0.13, 0.2])
    x = until(
        lambda t, x: [x[1], (0.2 * x[2] - float(S(x[1]))) / 0.02, (3 - 1.5 * x[2] - 0.2 * x[1]) / 4e-3],
        0,
        0.4,
        [0, 3, 0.8],
    )[1]
    return {"a": x[0], "a'": x[1], "i": x[2]}


def tape_drive():
    """Two reels on an elastic tape with losses, a motor each: of six eigenvalues one pair oscillates."""
    J, k, c, R, La, km = 1e-4, 2e3 * 0.02**2, 5 * 0.02**2, 2, 1e-3, 0.03
    A = np.zeros((6, 6))
    A[0, 2] = A[1, 3] = 1
    A[2] = np.array([-k, k, -c, c, km, 0]) / J
    A[3] = np.array([k, -k, c, -c, 0, km]) / J
    A[4, 2] = A[5, 3] = -km / La
    A[4, 4] = A[5, 5] = -R / La
    return {"f": max(np.linalg.eigvals(A).imag)}


def tyre():
    """Relaxation: F' sigma/V + F = -C alpha (von Schlippe), a wheel that trails its hinge."""
    m, I, V, C, sigma, a, k, c = 200.001, 1.2, 20, 3e4, 0.4, 0.1, 3e4, 0.5

    def rates(t, x):
        psi, y, w, v, F = x
        slip = psi + (v - a * w) / V
        return [w, v, (-a * F * math.cos(psi) - c * w) / I, (F - k * y) / m, V / sigma * (-C * slip - F)]

    x = until(rates, 0, 0.3, [0.02, 0, 0, 0, 0])[1]
    return {"psi": x[0], "y": x[1], "F": x[4]}


def doorbell():
    """L(q) i' + i L' q' = U or 0 behind its contact, J q'' = i^2 L'/2 - k (q - q0), at the bell q' -> -e q'."""
    J, k, R, L0, b, e, V, bell, q0 = 2e-5, 0.05, 4, 0.03, 0.2, 0.3, 3, 0.06, -0.02
    t, x, hits, on = 0.0, np.zeros(3), [], 1
    while True:

        def rates(t, x, on=on):
            d = 1 + (bell - x[0]) / b
            L, slope = L0 / d, L0 / b / d**2
            force = x[2] ** 2 / 2 * slope - k * (x[0] - q0)
            return [x[1], force / J, (V * on - R * x[2] - x[2] * slope * x[1]) / L]

        opens = (lambda t, x: x[0] - q0 - 0.04, 1 if on else -1)
        t, x, hit = until(rates, t, 0.09, x, (lambda t, x: x[0] - bell, 1), opens)
        if hit < 0:
            return {"q": x[0], "i": x[2]} | impacts(hits)
        if hit == 0:
            hits.append((t, (1 + e) * J * x[1]))
            x[1] *= -e
        else:
            on = 1 - on


def hydraulic_cylinder():
    """p' = E/(V0 + A x) (C y sqrt(pS - p) - A x'), m x'' = A p - F - R sign x', which sticks once."""
    A, E = 2e-3, 1.2e9

    def flow(t, x, v, z):
        p = z[0]
        valve = 1e-7 * min(1, 20 * t) * math.sqrt(abs(1e7 - p)) * np.sign(1e7 - p)
        return [E / (2e-4 + A * x) * (valve - A * v)]

    y, ends = coulomb(50, lambda t, x, v, z: A * z[0] - 5000, 200, 200, [0, 0, 3e6], 0.03, flow)
    return {"x": y[0], "p": y[2], "end1": ends[0], "end2": ends[1]}


# -- brakes, clutches, screws --------------------------------------------------------------------------


def elevator_brake():
    """(J/r^2 + mc + mw) s'' = (mc - mw) g - T/r until it stands; C Th' = T s'/r - h (Th - T0) goes on."""
    J, r, mc, mw, T, C, h = 12, 0.4, 900, 700, 1500, 4000, 15
    a = ((mc - mw) * G - T / r) / (J / r**2 + mc + mw)
    stop = -2 / a
    heat = until(lambda t, x: [(T * (2 + a * t) / r - h * x[0]) / C], 0, stop, [0])[1][0]
    return {
        "s": stop,
        "Th": 293 + heat * math.exp(-h / C * (3 - stop)),
        "B": -(mc - mw) * G * r,
        "T1": mc * G,
        "T2": mw * G,
        "end1": stop,
    }


def elevator_that_slips():
    """The same at its start, and its way to rest in closed form."""
    J, r, mc, mw, T = 12, 0.4, 900, 700, 1500
    a = ((mc - mw) * G - T / r) / (J / r**2 + mc + mw)
    return {"T1": mc * (G - a), "T2": mw * (G + a), "B": -T, "stop": -2 / a, "way": -2 / a}


def inertia_starter():
    """A clutch slips until both turn alike, then both coast: w = a2 t1, and heats by T times the slip."""
    a1, a2 = -40 / 0.8, 35 / 2.5
    t = 100 / (a2 - a1)
    w = a2 * t
    coasts = w * 3.3 / 5
    return {
        "Th": 300 + 40 * 100 * t / 2 / 900,
        "a": (100 + w) * t / 2 + w * coasts / 2,
        "b": w * t / 2 + w * coasts / 2,
        "end1": t,
        "end2": t + coasts,
    }


def lead_screw():
    """(J + m h^2) phi'' = k (w t - phi) - F h - T sign phi': it sticks and slips."""
    y, ends = coulomb(2e-4 + 8 * 4e-6, lambda t, x, v, z: 3 * (0.4 * t - x) - 0.02, 0.05, 0.12, [0, 0], 0.5)
    return {"phi": y[0], "x": 2e-3 * y[0], "end1": ends[0], "end2": ends[1], "end3": ends[2]}


def pendulum_clock():
    """m g l (cos B - cos A) + 2 b Te = Tf (A + B) from swing to swing."""
    ml, A = 0.2 * G * 0.25, math.radians(8)
    for _ in range(4):
        A = brentq(lambda B, A=A: ml * (math.cos(B) - math.cos(A)) + 8e-3 * math.radians(1) - 4e-4 * (A + B), 0.05, 0.3)
    return {"swing": A}


def wedge():
    """On a slope of 20 deg with mu = 0.25 < tan 20 deg: F = mu m g cos, s'' = -g (sin - mu cos)."""
    al = math.radians(20)
    return {"F": 0.25 * 10 * G * math.cos(al), "a": -G * (math.sin(al) - 0.25 * math.cos(al))}


def brake_squeal():
    """A pad on springs that slides: K is not symmetric by mu k3 (Hoffmann's model)."""
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    K = np.array([[11 + 5 * c * c, 5 * s * c + 0.3 * 11], [5 * s * c, 31 + 5 * s * s]])
    low, high = np.sort(np.sqrt(np.linalg.eigvals(K)))
    return {"f1": low, "f2": high}


def slider_crank_pin_friction():
    """Newton and Euler of three bodies, with mu r |R| in the crank pin and mu |N| in the guide, found by iteration."""

    def forces(al, w, r=0.1, l=0.3, m1=0.5, m2=1.2, m3=2):
        be = -math.asin(r * math.sin(al) / l)
        bd = -r * w * math.cos(al) / (l * math.cos(be))
        ca, sa, cb, sb = math.cos(al), math.sin(al), math.cos(be), math.sin(be)
        xd = -r * w * sa - l * bd * sb
        M, F = 0.0, 0.0
        for _ in range(100):  # of al'', be'', x'', B on the rod, P on the rod, N
            A = [
                [m1 * r * r / 3, 0, 0, -r * sa, r * ca, 0, 0, 0],
                [-m2 * r * sa, -m2 * l / 2 * sb, 0, -1, 0, -1, 0, 0],
                [m2 * r * ca, m2 * l / 2 * cb, 0, 0, -1, 0, -1, 0],
                [0, m2 * l * l / 12, 0, -l / 2 * sb, l / 2 * cb, l / 2 * sb, -l / 2 * cb, 0],
                [0, 0, m3, 0, 0, 1, 0, 0],
                [0, 0, 0, 0, 0, 0, 1, -1],
                [r * sa, l * sb, 1, 0, 0, 0, 0, 0],
                [r * ca, l * cb, 0, 0, 0, 0, 0, 0],
            ]
            gx, gy = r * ca * w * w + l * cb * bd**2, r * sa * w * w + l * sb * bd**2
            hx, hy = r * ca * w * w + l / 2 * cb * bd**2, r * sa * w * w + l / 2 * sb * bd**2
            b = [60 - 2 * w - M - m1 * G * r / 2 * ca, m2 * hx, m2 * hy - m2 * G, M, F - 30 * xd, -m3 * G, -gx, gy]
            u = np.linalg.solve(A, b)
            now = -0.2 * 0.02 * math.hypot(u[3], u[4]) * np.sign(bd - w), -0.1 * abs(u[7]) * np.sign(xd)
            if abs(now[0] - M) + abs(now[1] - F) < 1e-13:
                break
            M, F = now
        return u, M

    u, M = forces(0.7, 20)

    def rates(t, x):
        return [x[1], forces(x[0], x[1])[0][0]]

    t, x, _ = until(rates, 0, 0.11, [0.7, 20], (lambda t, x: x[0] - math.pi, 1), rtol=1e-10, atol=1e-11)
    x = until(rates, t, 0.11, np.add(x, [1e-13, 0]), rtol=1e-10, atol=1e-11)[1]
    return {"al": x[0], "al'": x[1], "end1": t, "M0": M, "N0": u[7]}


def chain():
    """Three rods that hang on one another, a dry hinge each, which rest by Gauss's principle (in relative angles)."""
    n, m, l, T, end = 3, 0.3, 0.2, 0.02, 0.3
    D, idx = np.tril(np.ones((n, n))), np.arange(n)
    later = n - 1 - np.maximum.outer(idx, idx)

    def parts(x):
        q, w = D @ x[:n], D @ x[n:]
        M = m * l * l * (later + 0.5) * np.cos(q[:, None] - q[None, :])
        M[idx, idx] = m * l * l * (n - 1 - idx + 1 / 3)
        C = m * l * l * (later + 0.5) * np.sin(q[:, None] - q[None, :])
        Q = -C @ (w * w) - m * G * l * (n - idx - 0.5) * np.cos(q)
        return D.T @ M @ D, D.T @ Q

    def senses(x):
        s = np.where(np.abs(x[n:]) > 1e-9, np.sign(x[n:]), 0)
        rest = np.flatnonzero(s == 0)
        M, Q = parts(x)
        inverse = np.linalg.inv(M)
        if len(rest):
            root = np.linalg.cholesky(inverse[np.ix_(rest, rest)])
            b = (inverse @ (Q - T * s))[rest]
            tau = lsq_linear(root.T, -np.linalg.solve(root, b), (-T, T), method="bvls").x
            s[rest] = np.where(np.abs(tau) >= T * (1 - 1e-9), -np.sign(tau), 0)
        return s

    t, x, ends = 0.0, np.r_[0.6, 0.7, 0.8, np.zeros(n)], []
    s = senses(x)
    while True:
        slips = s != 0

        def acceleration(x, s=s, slips=slips):
            M, Q = parts(x)
            a = np.zeros(n)
            a[slips] = np.linalg.solve(M[np.ix_(slips, slips)], (Q - T * s)[slips])
            return a, M @ a - Q

        def left(t, x, k, s=s, slips=slips):
            return x[n + k] * s[k] if slips[k] else T - abs(acceleration(x)[1][k])

        events = [((lambda t, x, k=k: left(t, x, k)), -1) for k in range(n)]
        t, x, k = until(lambda t, x: [*x[n:], *acceleration(x)[0]], t, end, x, *events, rtol=1e-11)
        if k < 0:
            return {f"q{i + 1}": x[i] for i in range(n)} | {f"end{i + 1}": at for i, at in enumerate(ends[:2])}
        ends.append(t)
        x[n + k] = 0.0 if slips[k] else x[n + k]
        loose = 0.0 if slips[k] else -np.sign(acceleration(x)[1][k])
        s = senses(x)
        s[k] = s[k] or loose


# -- stops and impacts -------------------------------------------------------------------------------


def gate_on_a_ship():
    """A gate hinged on the mast of a ship that rolls, with dry friction and a yielding stop."""
    m, b, d = 80, 1.2, 0.6
    Ix, Iy, Iz = m / 12 * (0.05**2 + 1), m / 12 * (b * b + 1), m / 12 * (b * b + 0.05**2)

    def moment(t, q, v, z):
        roll, rate = 0.05 * math.sin(2 * t), 0.1 * math.cos(2 * t)
        s, c = math.sin(q), math.cos(q)
        stop = max(0, 5e3 * (q - 1.4) + 60 * v) if q > 1.4 else 0
        return (m * d * d - Ix + Iy) * s * c * rate**2 - m * G * d * c * math.sin(roll) + 30 - 12 * v - stop

    y, ends = coulomb(Iz + m * d * d, moment, 4, 4, [0, 0.5], 2.6)
    return {"th": y[0], "th'": y[1], "end1": ends[0]}


def ratchet():
    """A pawl pushes while J a'' + T > 0 of its lever a = 0.8 sin 6 t; then the wheel coasts to rest."""
    t = math.asin(1 / (0.05 * 28.8)) / 6
    b, v = 0.8 * math.sin(6 * t), 4.8 * math.cos(6 * t)
    return {"b": b + v * v / 40, "end1": t, "end2": t + v / 20}


def hopping_leg():
    """Free fall, k (l0 - s) - c s' on the trunk until the floor lets go, then both masses until the leg is long."""
    M, m, k, c = 5, 0.5, 3000, 8
    t = math.sqrt(0.8 / G)
    lands = t
    t, x, _ = until(
        lambda t, x: [x[1], (k * (0.5 - x[0]) - c * x[1]) / M - G],
        t,
        5,
        [0.5, -G * t],
        (lambda t, x: m * G + k * (0.5 - x[0]) - c * x[1], -1),
    )
    leaves = t

    def flight(t, x):
        F = max(0, k * (0.5 - x[0] + x[2])) - c * (x[1] - x[3])
        return [x[1], F / M - G, x[3], -F / m - G]

    t, x, _ = until(flight, t, 5, [*x, 0, 0], (lambda t, x: x[0] - x[2] - 0.5, 1))
    P, v, later = M * m / (M + m) * (x[1] - x[3]), (M * x[1] + m * x[3]) / (M + m), 0.6 - t
    return {
        "y": x[0] + v * later - G / 2 * later**2,
        "y'": v - G * later,
        "end1": lands,
        "end2": leaves,
        "t1": lands,
        "P1": m * G * lands,
        "t2": t,
        "P2": P,
    }


def pile_driver():
    """v = sqrt(2 g h), P = (1 + e) v mr mp/(mr + mp); it slows by R/mp - g, and while it moves they meet again."""
    v, m = math.sqrt(2 * G * 1.5), 240
    P = 1.3 * v * m
    a, u, w = 6e4 / 400 - G, -P / 400, -v + P / 600
    t = math.sqrt(3 / G)
    return {"t1": t, "P1": P, "t2": t + 2 * (w - u) / (G + a), "P2": 1.3 * m * (w - u)}


def pile_driver_answers():
    """The same, asked at y = 0 just after the blow."""
    P = 1.3 * math.sqrt(2 * G * 1.5) * 240
    return {"P": P, "vp": -P / 400}


def quarter_car():
    """Two masses on springs, a tyre that may leave the road, bump stops that only push; kinks by small steps."""
    places = [0, 0.2, 0.25, 0.3, 0.35, 0.4, 3]
    road = PchipInterpolator(places, [0, 0, 0.08, 0.1, 0.08, 0, 0])

    def rates(t, x):
        zu, vu, s, v = x
        tyre = max(0, 2e5 * (float(road(t)) - zu) + 340 * G)
        strut = -2e4 * s + 300 * G - 1.2e3 * v
        strut += max(0, 3e5 * (-0.04 - s) - 3e3 * v) if s < -0.04 else 0
        strut -= max(0, 3e5 * (s - 0.03) + 3e3 * v) if s > 0.03 else 0
        below, above = (tyre - strut) / 40 - G, strut / 300 - G
        return [vu, below, v, above - below]

    x = np.zeros(4)
    for a, b in itertools.pairwise([*places[:-1], 0.5]):
        x = until(rates, a, b, x, max_step=2e-3, rtol=1e-9, atol=1e-11)[1]
    return {"zu": x[0], "s": x[2]}


def tow_rope():
    """A truck accelerates 2 m, the rope rebounds with e; at last both drive on with F - Fr over both masses."""
    a, fr = 4000 / 1500, 0.3
    v, m = math.sqrt(4 * a), 600
    t = math.sqrt(4 / a)
    flight = 2 * 0.25 * v / (a + fr)
    V = (4000 * 3 - 300 * (3 - t)) / 2500
    return {
        "t1": t,
        "P1": 1.25 * v * m,
        "t2": t + flight,
        "P2": 1.25 * 0.25 * v * m,
        "x1'": V,
        "x2'": V,
        "T": 300 + 1000 * 3700 / 2500,
    }


def train():
    """Five wagons that slow by friction and meet with e: v_r -> -e v_r between equal masses."""
    n, gap, e, a, end = 5, 0.1, 0.6, 1500 / 2e4, 1.2
    x, u, t, hits = -gap * np.arange(1.0, n + 1), np.array([0.0, 0, 0, 0, 1.5]), 0.0, []

    def place(k, s):
        s = min(s, abs(u[k]) / a)
        return x[k] + u[k] * s - np.sign(u[k]) * a * s * s / 2

    while True:
        best = (end - t, -1)
        for k in range(n - 1):
            if u[k + 1] > u[k] + 1e-12:
                s = first(lambda s, k=k: place(k, s) - place(k + 1, s), 1e-9, best[0])
                best = best if s is None else (s, k)
        s, k = best
        x, u, t = (
            np.array([place(j, s) for j in range(n)]),
            np.sign(u) * np.maximum(0, np.abs(u) - a * s),
            t + s,
        )
        if k < 0:
            return {f"x{j + 1}": x[j] for j in range(n)} | impacts(hits)
        P = (1 + e) * (u[k + 1] - u[k]) * 1e4
        hits.append((t, P))
        u[k] += P / 2e4
        u[k + 1] -= P / 2e4


def bouncing_on_a_shaker():
    """A ball on a table A sin w t: v - v_t -> -e (v - v_t)."""
    A, w, e = 0.005, 60, 0.8
    t, y, v, hits = 0.0, 0.02, 0.0, []
    for _ in range(4):

        def gap(s, t=t, y=y, v=v):
            return y + v * s - G / 2 * s * s - A * math.sin(w * (t + s))

        s = first(gap, 1e-9 * len(hits), 0.4)
        before, y, t = v - G * s, y + v * s - G / 2 * s * s, t + s
        table = A * w * math.cos(w * t)
        v = table - e * (before - table)
        hits.append((t, 0.01 * (v - before)))
    return impacts(hits)


def knee():
    """A double pendulum meets the stop of its knee: M (u+ - u-) = J^T Lam, k' -> -e k'; impulses by its momenta."""
    m1, m2, l1, l2, e, T = 2, 1.2, 0.5, 0.45, 0.2, 0.05

    def mass(k):
        own, both = m2 * l2 * l2 / 3, m2 * l1 * l2 * math.cos(k)
        return np.array([[m1 * l1 * l1 / 3 + m2 * l1 * l1 + own + both, own + both / 2], [own + both / 2, own]])

    def rates(t, x):
        a, k, w, u = x
        s = m2 * l1 * l2 / 2 * math.sin(k)
        below = m2 * l2 / 2 * G * math.sin(a + k)
        Q = [s * (2 * w * u + u * u) - (m1 / 2 + m2) * l1 * G * math.sin(a) - below, -s * w * w - below - T]
        return [w, u, *np.linalg.solve(mass(k), Q)]

    x = until(rates, 0, 1, [*np.radians([40, -70]), 0, 0], (lambda t, x: x[1], 1))[1]
    inverse = np.linalg.inv(mass(0))
    P = (1 + e) * x[3] / inverse[1, 1]
    change = -inverse[:, 1] * P
    knee_, thigh = l1 * change[0] + l2 / 2 * change.sum(), l1 / 2 * change[0]
    c = math.cos(x[0])
    return {"L": P, "Hx": (m1 * thigh + m2 * knee_) * c, "Kx": m2 * knee_ * c}


def bead_in_a_turning_tube():
    """m s'' = m w^2 s - mu |N| sign s', N^2 = (2 m w s')^2 + (m g)^2, between stops that yield."""
    m, mu, w = 0.1, 0.3, 5

    def force(t, s, v, z):
        return m * w * w * s - (max(0, 400 * (s - 0.8) + 0.5 * v) if s > 0.8 else 0)

    y, ends = coulomb(m, force, lambda t, s, v: mu * m * math.hypot(2 * w * v, G), mu * m * G, [0.1, 1.5], 0.6)
    return {"s": y[0], "s'": y[1], "end1": ends[0], "end2": ends[1]}


def emergency_stop():
    """A brake stops the sheave, the counterweight flies on until the rope is taut: J/r^2 + mc and mw meet."""
    m = 900 + 8 / 0.09
    a = 900 * G / m - 12000 / 0.3 / m
    stands, s = -3 / a, -9 / 2 / a
    t = (3 + math.sqrt(9 - 2 * G * s)) / G
    return {"end1": stands, "t1": t, "P1": 1.1 * (G * t - 3) * m * 700 / (m + 700)}


def four_bar_stop():
    """M(al) al'' + M' al'^2/2 = 2 - T |ga'/al'| sign al' of a four-bar, at the stop of its rocker."""
    a, b, c, d, m, J, e, T = 0.2, 0.5, 0.4, 0.6, 1.5, 0.1, 0.4, 0.3

    def angles(al):
        B = np.array([a * math.cos(al), a * math.sin(al)])
        v = np.array([d, 0]) - B
        L = math.hypot(*v)
        x = (b * b - c * c + L * L) / (2 * L)
        u = v / L
        C = B + x * u + math.sqrt(b * b - x * x) * np.array([-u[1], u[0]])
        be, ga = math.atan2(*(C - B)[::-1]), math.atan2(C[1], C[0] - d)
        A = [[-b * math.sin(be), c * math.sin(ga)], [b * math.cos(be), -c * math.cos(ga)]]
        return be, ga, *np.linalg.solve(A, [a * math.sin(al), -a * math.cos(al)])

    def inertia(al):
        be, _, bp, gp = angles(al)
        vx, vy = -a * math.sin(al) - b / 2 * math.sin(be) * bp, a * math.cos(al) + b / 2 * math.cos(be) * bp
        return J + m * (vx * vx + vy * vy) + m * b * b / 12 * bp * bp + m * c * c / 3 * gp * gp

    def rates(t, x):
        h = 1e-3
        M = {k: inertia(x[0] + k * h) for k in (-3, -2, -1, 1, 2, 3)}
        slope = (45 * (M[1] - M[-1]) - 9 * (M[2] - M[-2]) + M[3] - M[-3]) / (60 * h)
        gp = angles(x[0])[3]
        return [x[1], (2 - T * abs(gp) - slope * x[1] ** 2 / 2) / inertia(x[0])]

    start = [math.pi / 3, math.radians(200)]
    turning = (lambda t, x: angles(x[0])[3], 0)
    t, x, hit = until(rates, 0, 0.5, start, (lambda t, x: angles(x[0])[1] - 2.2, 1), turning, rtol=1e-11)
    while hit == 1:  # the rocker turns back: |ga'| has a corner
        t, x, hit = until(
            rates, t, 0.5, np.add(x, [1e-12, 0]), (lambda t, x: angles(x[0])[1] - 2.2, 1), turning, rtol=1e-11
        )
    return {"t1": t, "P1": (1 + e) * inertia(x[0]) * x[1] / angles(x[0])[3]}


# -- lengths of time, parts that repeat --------------------------------------------------------------


def elevator_rope():
    """m y'' = EA/l (-y - l) - c y' - m g on a rope that is wound up, l = l0 - v t."""
    m, EA, l0, v = 800, 4e6, 60, 2.5
    x = until(
        lambda t, x: [x[1], (EA / (l0 - v * t) * (-x[0] - l0 + v * t) - 400 * x[1]) / m - G],
        0,
        4,
        [-l0 - m * G * l0 / EA, 2.5],
    )[1]
    return {"y": x[0], "y'": x[1], "T": EA / 50 * (-x[0] - 50)}


def pulled_pendulum():
    """(l^2 th')' = l^2 ph'^2 sin cos - g l sin, l^2 ph' sin^2 = h, l = l0 - v t; x', z' at the start by the cord."""
    m, l0, v, th = 0.4, 1.5, 0.3, 0.6
    h = 1.2 * l0 * math.sin(th)
    w = -v / math.sin(th) * math.cos(th) / l0  # x' sin th = - v, z' = 0

    def rates(t, x):
        l = l0 - v * t
        turn = h / (l * math.sin(x[0])) ** 2
        return [x[1], (2 * v * x[1] - G * math.sin(x[0])) / l + turn**2 * math.sin(x[0]) * math.cos(x[0]), turn]

    th, w, ph = until(rates, 0, 1.5, [th, w, 0])[1]
    l = l0 - 1.5 * v
    across = (h / (l * math.sin(th))) ** 2 / l
    return {
        "x": l * math.sin(th) * math.cos(ph),
        "z": -l * math.cos(th),
        "T": m * (G * math.cos(th) + l * w * w + across),
        "Lz": m * h,
    }


def truss_of_n_bays():
    """Joints of a truss of six bays, a load P at each lower one, by numpy."""
    n, a, h, P = 6, 2.0, 1.5, 1e4
    place = {f"L{k}": (k * a, 0.0) for k in range(n + 1)} | {f"U{k}": (k * a, h) for k in range(n + 1)}
    bars = [(f"{c}{i - 1}", f"{d}{i}") for c, d in ("LL", "UU", "LU") for i in range(1, n + 1)]
    bars += [(f"L{k}", f"U{k}") for k in range(n + 1)]
    row = {name: 2 * k for k, name in enumerate(place)}
    A, b = np.zeros((2 * len(place), len(bars) + 3)), np.zeros(2 * len(place))
    for k, (p, q) in enumerate(bars):
        way = np.subtract(place[q], place[p])
        way /= np.linalg.norm(way)
        A[row[p] : row[p] + 2, k], A[row[q] : row[q] + 2, k] = way, -way
    A[row["L0"], -3] = A[row["L0"] + 1, -2] = A[row[f"L{n}"] + 1, -1] = 1
    b[[row[f"L{k}"] + 1 for k in range(n + 1)]] = P
    found = np.linalg.solve(A, b)
    force = dict(zip(bars, found, strict=False))
    upper = {f"U{i}": force[f"U{i - 1}", f"U{i}"] for i in range(1, n + 1)}
    return {"B": found[-1], "mid": force["L2", "L3"], "diag": force["L0", "U1"]} | upper


def hexapod_leg():
    """One leg of six on a trunk that tilts: two links by Newton and Euler in the trunk's axes, motors, dry hinges."""
    la, ma, lb, mb, T, end = 0.2, 0.4, 0.15, 0.2, 0.1, 0.012
    x, y, z = np.eye(3)

    def about(n, angle):
        K = np.cross(np.eye(3), n)
        return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K

    seat = about(z, math.pi / 3)
    n, hip = seat @ y, 0.25 * seat @ x

    def loads(t, q, w, a):
        """Torques about both hinges that motions q, w, a take."""
        tilt, spin, change = 0.1 * math.sin(3 * t), 0.3 * math.cos(3 * t) * x, -0.9 * math.sin(3 * t) * x
        weight = about(x, tilt).T @ (-G * z)
        A, B = seat @ about(y, q[0]), seat @ about(y, q[0] + q[1])

        def moved(r, w, e):
            return np.cross(e, r) + np.cross(w, np.cross(w, r))

        w1, w2 = spin + n * w[0], spin + n * (w[0] + w[1])
        e1, e2 = (change + np.cross(spin, n * v) + n * b for v, b in ((w[0], a[0]), (w[0] + w[1], a[0] + a[1])))
        base, ca, knee_, cb = moved(hip, spin, change), A @ x * la / 2, A @ x * la, B @ x * lb / 2
        Ia, Ib = (R @ np.diag([1e-4, i, i]) @ R.T for R, i in ((A, ma * la**2 / 12), (B, mb * lb**2 / 12)))
        f2 = mb * (base + moved(knee_, w1, e1) + moved(cb, w2, e2) - weight)
        f1 = ma * (base + moved(ca, w1, e1) - weight)
        t2 = Ib @ e2 + np.cross(w2, Ib @ w2) + np.cross(cb, f2)
        t1 = Ia @ e1 + np.cross(w1, Ia @ w1) + np.cross(ca, f1) + t2 + np.cross(knee_, f2)
        return np.array([n @ t1, n @ t2])

    def acceleration(t, s, X):
        """(a, the friction that each hinge needs) with senses s, 0 where it sticks."""
        q, w, still = X[:2], X[2:4], np.zeros(2)
        rest = loads(t, q, w, still)
        M = np.column_stack([loads(t, q, w, e) - rest for e in np.eye(2)])
        due, a, slips = 0.5 * X[4:] - rest, np.zeros(2), s != 0
        a[slips] = np.linalg.solve(M[np.ix_(slips, slips)], (due - T * s)[slips])
        return a, due - M @ a

    def rates(t, X, s):
        return [
            *X[2:4],
            *acceleration(t, s, X)[0],
            *((80 * (np.array([0.3, -0.2]) - X[:2]) - 1.5 * X[4:] - X[2:4] / 2) / 2e-3),
        ]

    t, X, s = 0.0, np.zeros(6), np.zeros(2)
    s = np.where(np.abs(acceleration(0, s, X)[1]) > T, np.sign(acceleration(0, s, X)[1]), 0)
    while True:

        def left(t, X, k, s=s):
            return X[2 + k] * s[k] if s[k] else T - abs(acceleration(t, s, X)[1][k])

        events = [((lambda t, X, k=k: left(t, X, k)), -1) for k in range(2)]
        t, X, k = until(lambda t, X, s=s: rates(t, X, s), t, end, X, *events, rtol=1e-10, atol=1e-11)
        if k < 0:
            return {"qa": X[0], "qb": X[1], "ia": X[4], "ib": X[5]}
        trial = s.copy()
        trial[k], X[2 + k] = 0, X[2 + k] * (s[k] == 0)
        needed = acceleration(t, trial, X)[1][k]
        s = trial
        s[k] = np.sign(needed) if abs(needed) > T * (1 - 1e-9) else 0


# -- two or three kinds in each ----------------------------------------------------------------------


def launched_rocket() -> dict[str, float]:
    """On its pad till the thrust of a table beats its weight; m v' = F - m g - rho/4 A |v| v, m' = -F/c."""
    table = PchipInterpolator([0, 0.3, 0.5, 2, 3, 3.2], [0, 40, 180, 150, 120, 0])

    def thrust(t):
        return float(table(min(t, 3.2)))

    def flies(t, y):
        m = 3 + y[2]
        return [y[1], thrust(t) / m - G - 0.6 * 0.5 * 0.008 * abs(y[1]) * y[1] / m, -thrust(t) / 2000]

    t, y, _ = until(
        lambda t, y: [0, 0, -thrust(t) / 2000], 0, 3, [0, 0, 0.3], (lambda t, y: flies(t, [0, 0, y[2]])[1], 1)
    )
    leaves = t
    for end in (0.3, 0.5, 2, 3, 3.2, 6):
        t, y, _ = until(flies, t, end, y)
    return {"end1": leaves, "y": y[0], "y'": y[1], "p": y[2]}


def sand_conveyor() -> dict[str, float]:
    """The belt of the drive slips all the time: F = 2 T0 tanh(mu phi/2); sand takes q v of the conveyor."""
    places = np.array([0, 500, 1000, 1400, 1500]) * math.pi / 30
    motor, F = PchipInterpolator(places, [14, 18, 24, 20, 0]), 2 * 120 * math.tanh(0.35 * 2.6 / 2)

    def rates(t, y):
        drum = (0.2 * F - 60 * 0.25 - 40 * 0.25**2 * y[3]) / (0.5 + 120 * 0.25**2)
        return [y[1], (float(motor(y[1])) - 0.06 * F) / 0.2, y[3], drum]

    y = until(rates, 0, 4, np.zeros(4))[1]
    return {"a": y[0], "a'": y[1], "b": y[2], "b'": y[3]}


def locked_wheel() -> dict[str, float]:
    """A brake that is pressed through a lag locks a wheel on a magic tyre with relaxation."""

    def grip(k):
        return 3500 * math.sin(1.6 * math.atan(10 * k - 0.5 * (10 * k - math.atan(10 * k))))

    def rates(rolls):
        def law(t, y):
            _, v, _, w, k, M = y
            spin = (-0.3 * grip(k) - M) / 1.1 if rolls else 0.0
            return [v, grip(k) / 365, w * rolls, spin, (0.3 * w * rolls - v - abs(v) * k) / 0.15, (1500 - M) / 0.03]

        return law

    t, y, _ = until(rates(True), 0, 0.8, [0, 25, 0, 25 / 0.3, 0, 0], (lambda t, y: y[3], -1))
    locks, y[3] = t, 0
    y = until(rates(False), t, 0.8, y)[1]
    return {"end1": locks, "x": y[0], "x'": y[1], "a": y[2], "road_kappa": y[4]}


def door_closer() -> dict[str, float]:
    """A cylinder that breathes through an orifice slows a door with a dry hinge, which rebounds three times."""
    J, kinetic, static, A, V, p0, seat = 12, 1.5, 2.2, 12e-4, 40e-6, 1.013e5, np.array([-0.2, 0.3])

    def reach(q):
        B = np.array([0.3 * math.cos(q) - 0.05 * math.sin(q), 0.3 * math.sin(q) + 0.05 * math.cos(q)])
        way = B - seat
        return math.hypot(*way), float(way @ [-B[1], B[0]]) / math.hypot(*way)

    def push(y):
        return -15 * (y[0] + 0.3) + A * (y[2] - p0) * reach(y[0])[1]

    def rates(sense):
        def law(t, y):
            length, arm = reach(y[0])
            w = y[1] * bool(sense)
            filled = 287 * 293 * 8e-9 * (p0 - y[2]) - y[2] * A * arm * w
            return [w, (push(y) - sense * kinetic) / J * bool(sense), 1.4 / (V + A * (length - 0.05)) * filled]

        return law

    t, y, sense, found = 0.0, np.array([math.radians(80), 0, p0]), -1, []
    while len(found) < 3:
        events = (
            [(lambda t, y: y[1], -sense), (lambda t, y: y[0], -1)]
            if sense
            else [(lambda t, y: static - abs(push(y)), -1)]
        )
        t, y, hit = until(rates(sense), t, 6, y, *events)
        if sense and hit == 1:
            found.append((t, -1.3 * J * y[1]))
            y[1], sense = -0.3 * y[1], 1
        else:
            y[1] = 0
            sense = int(np.sign(push(y))) if not sense or abs(push(y)) > static else 0
    return impacts(found)


def absorber_with_stops() -> dict[str, float]:
    """A tuned mass with dry friction strikes the stops of its housing: P = 3/2 M m/(M + m) |v|."""
    M, m, K, k, c, F = 10, 1, 4000, 360, 1, 0.5

    def moves(sense):
        def law(t, y):
            pull = -k * y[2] - c * y[3] - sense * F
            a = (30 * math.sin(19 * t) - K * y[0] - pull) / M
            return [y[1], a, y[3], pull / m - a]

        return law

    def stays(t, y):
        return [y[1], (30 * math.sin(19 * t) - K * y[0]) / (M + m), 0, 0]

    def needed(t, y):
        return m * stays(t, y)[1] + k * y[2]

    t, y, sense, found = 0.0, np.zeros(4), 0, []
    while t < 2:
        if not sense:
            t, y, hit = until(stays, t, 2, y, (lambda t, y: F - abs(needed(t, y)), -1))
            sense = -int(np.sign(needed(t, y)))
            continue
        t, y, hit = until(moves(sense), t, 2, y, (lambda t, y: y[3], -sense), (lambda t, y: 0.025 - abs(y[2]), -1))
        if hit == 1:
            P = 1.5 * M * m / (M + m) * y[3]
            found.append((t, abs(P)))
            y[1], y[3], sense = y[1] + P / M, -0.5 * y[3], -sense
        elif hit == 0:
            y[3], sense = 0, -_loose_sense(needed(t, y), F)
    return {"x": y[0], "x'": y[1], "y": y[2], "y'": y[3], **impacts(found)}


def _loose_sense(push: float, static: float) -> int:
    return int(_loose(push, static))


def slipping_elevator() -> dict[str, float]:
    """A rope slips over a braked sheave that turns the wrong way: that turns round, the rope sticks, all rests."""
    car, weight, J, R, grip = 1200, 900, 15, 0.3, math.exp(0.12 * math.pi)

    def shoe(t):
        return 0.4 * 0.3 * 8000 * (1 - math.exp(-t / 0.05))

    def slips(sense):
        def law(t, y):
            T = 2 * weight * G / (grip + weight / car)
            return [y[1], (-(grip - 1) * T * R - sense * shoe(t)) / J, y[3], T / car - G]

        return law

    def sticks(t, y):
        a = (-(car - weight) * G - shoe(t) / R) / (car + weight + J / R**2)
        return [y[1], -a / R, y[3], a]

    t, y, _ = until(slips(1), 0, 1.5, [0, 4, -5, 1.2], (lambda t, y: y[1], -1))
    turns, y[1] = t, 0
    t, y, _ = until(slips(-1), t, 1.5, y, (lambda t, y: y[3] + R * y[1], -1))
    holds = t
    t, y, _ = until(sticks, t, 1.5, y, (lambda t, y: y[3], -1))
    return {"end1": turns, "end2": holds, "end3": t, "q": y[0], "y": y[2], "y'": 0.0}


def sailing_boat() -> dict[str, float]:
    """Sail and keel by tables of lift and drag, a hull with added mass (Kirchhoff), a rudder behind a lag."""
    places = np.radians([-180, -90, -25, -12, 0, 12, 25, 90, 180])
    lift = PchipInterpolator(places, [0, 0, -1.1, -1, 0, 1, 1.1, 0, 0])
    drag = PchipInterpolator(np.radians([-180, -90, -25, 0, 25, 90, 180]), [0.02, 1.2, 0.4, 0.02, 0.4, 1.2, 0.02])
    sail = (0.4, 1.2 * 9, np.array([0, -7]), np.array([math.cos(0.6), -math.sin(0.6)]))
    keel = (0.2, 1000 * 0.35, np.zeros(2), np.array([1, 0]))

    def rates(t, s):
        R = np.array([[math.cos(s[2]), -math.sin(s[2])], [math.sin(s[2]), math.cos(s[2])]])
        v, w = s[3:5], s[5]
        F, turn = -0.5 * 1000 * 0.06 * 0.5 * math.sqrt(v @ v + 0.05**2) * v, 400 * s[6] * v[0]
        for ahead, size, medium, chord in (sail, keel):
            d = R @ [ahead, 0]
            u, c = v + w * np.array([-d[1], d[0]]) - medium, R @ chord
            alpha = math.atan2(u[0] * c[1] - u[1] * c[0], u @ c)
            push = size / 2 * math.hypot(*u) * (lift(alpha) * np.array([-u[1], u[0]]) - drag(alpha) * u)
            F, turn = F + push, turn + d[0] * push[1] - d[1] * push[0]
        (x, y), (X, Y) = R.T @ v, R.T @ F
        a = np.array([(X + 330 * w * y) / 200 - w * y, (Y - 200 * w * x) / 330 + w * x])
        return [*v, w, *(R @ a), (turn - 130 * x * y) / 440, (0.8 * (0.2 - s[2]) - w - s[6]) / 0.3]

    s = until(rates, 0, 4, [0, 0, math.radians(10), 0.5, 0, 0, 0])[1]
    return {"x": s[0], "y": s[1], "psi": s[2], "x'": s[3], "rud": s[6]}
