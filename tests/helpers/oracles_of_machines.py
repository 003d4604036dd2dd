"""Machines, by numpy, mpmath and scipy alone: what systems_of_strangers.toml asks."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

G = 9.81
mp.mp.dps = 40


def end_of(rates, start, time: float) -> np.ndarray:
    """Of a motion x' = rates(t, x)."""
    return solve_ivp(rates, (0, time), start, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]


def cylindrical_robot():
    """(I + m r^2) a'' = T - 2 m r r' a', m r'' = P + m r a'^2 (Spong, ch. 7)."""
    I = 0.2 + 0.15 + 0.05 + 2 * 0.36
    return dict(a2=(1.5 - 2 * 2 * 0.6 * -0.4 * 0.7) / I, h2=(60 - 5 * G) / 5, r2=(-4 + 2 * 0.6 * 0.49) / 2)


def sarrus_lift():
    """Two hinged chains across one another: z = 2 l sin a; M(a) a'' + M' a'^2/2 = -V'."""
    l, th = (0.4, 0.7)
    s = l * math.sin(th)
    m = 3

    def M(a):
        return (
            2 * (l * l / 3)
            + 2 * (l * l / 12 + l * l / 4 * math.sin(a) ** 2 + 2.25 * l * l * math.cos(a) ** 2)
            + m * 4 * l * l * math.cos(a) ** 2
        )

    a2 = -G * (m * 2 * l + 2 * l / 2 + 2 * 1.5 * l) * math.cos(th) / M(th)
    return dict(a2=a2, z2=2 * l * math.cos(th) * a2, z=2 * s)


def bead_on_a_cycloid():
    """4 pi sqrt(R/g) whatever the height (Huygens)."""
    return dict(T=4 * math.pi * math.sqrt(0.5 / G))


def rod_in_a_bowl():
    """sqrt(g d/(d^2 + l^2/3)) (Beer & Johnston, ch. 19)."""
    d = 0.8
    return dict(f=math.sqrt(G * d / (d * d + 0.36 / 3)), N=2 * G / 2 / d)


def ball_on_a_sloped_turntable():
    """7/2 v' = Om z x v + 5/2 g (Milne)."""
    v = np.array([0.2, -0.1])
    g = np.array([G * math.sin(0.05), 0])
    a = 2 / 7 * (2 * np.array([-v[1], v[0]]) + 2.5 * g)
    return dict(ax=a[0], ay=a[1], N=0.5 * G * math.cos(0.05))


def humpage_reducer():
    """Willis' equations of a bevel reducer."""
    c = 240 / 96
    p = -76 * c / 56
    return dict(wo=c + 24 * p / 35, wc=c)


def two_pendulums_and_a_spring():
    """sqrt(g/l), sqrt(g/l + 2 k a^2/(m l^2)) (Den Hartog)."""
    return dict(f1=math.sqrt(G), f2=math.sqrt(G + 2 * 8 * 0.25))


def lacoste_suspension():
    """k a h = m g b: the arm rests anywhere (LaCoste 1934)."""
    return dict(p2=0.0)


def force_tip_of_a_nanometre():
    """sqrt(k/m) of 1e-15 kg that starts 1e-9 m aside."""
    return dict(f=math.sqrt(0.2 / 1e-15), x2=-0.2 * 1e-09 / 1e-15)


def earth_and_moon():
    """G M/r^2 of 6e24 kg and 4e8 m."""
    return dict(u2=-6.6743e-11 * 5.972e24 / 384400000.0**2, x2=6.6743e-11 * 7.342e22 / 384400000.0**2)


def geneva_while_engaged():
    """tan q = sin p/(cos p - sqrt 2), differences in 30 digits."""

    def q(p):
        return mp.atan2(mp.sin(p), mp.cos(p) - mp.sqrt(2))

    p0 = -mp.pi / 9
    return dict(w2=float(5 * mp.diff(q, p0)), e2=float(25 * mp.diff(q, p0, 2)))


def quick_return_at_its_dead_angle():
    """tan q = (d + a sin p)/(a cos p), differences in 30 digits."""
    a, d = (mp.mpf("0.2"), mp.mpf("0.4"))
    p0 = mp.pi / 6

    def q(p):
        return mp.atan2(d + a * mp.sin(p), a * mp.cos(p))

    w, e = (10 * mp.diff(q, p0), 100 * mp.diff(q, p0, 2))
    I = 3 * mp.mpf("0.81") / 3
    return dict(w=float(w), e=float(e), M=float(I * e * mp.diff(q, p0)))


def space_bent_pipe():
    """R = -P, M = -(r x P + C)."""
    M = -(np.cross([0.3, 0.4, -0.2], [80, -40, 110]) + np.array([5, 0, -12]))
    return dict(Rx=-80.0, Mx=M[0], My=M[1], Mz=M[2])


def three_legged_table():
    """N by moments about two edges."""
    s = np.linalg.solve([[1, 1, 1], [0, 2, 0.5], [0, 0, 1.5]], [300, 240, 120])
    return dict(NA=s[0], NB=s[1], NC=s[2], H=10 * 0.4 / 2)


def beam_with_inner_hinges_and_couple():
    """The free bodies of both parts, from the tip."""
    R = 5.5
    Ay = 9 - 1.5
    M = 9 * 2 - 1.5 * 3
    return dict(M=M, R=R, V=Ay - 4, m=-M + Ay * 2 - 8 / 3)


def ladder_at_rest():
    """S = W/(2 tan al)."""
    S = 75 / math.tan(math.radians(65))
    return dict(N=150.0, F=-S, S=S)


def bicycle_wheel_precession_steady():
    """J th'' = C w Om - m g a."""
    J = 0.05 + 3 * 0.04
    return dict(p2=0.0, th2=(0.09 * 60 * 1 - 3 * G * 0.2) / J)


def coin_held_upright():
    """3/2 m r^2 s'' = T, th'' = 0."""
    r, m = (0.2, 1.2)
    s2 = 0.5 / (m * r * r * 1.5)
    return dict(s2=s2, th2=0.0, x2=r * (s2 * math.cos(0.4) - 3 * 0.9 * math.sin(0.4)))


def trammel_with_springs():
    """m l^2/3 p'' = -V'; the wall holds the mass centre."""
    m, l, k, p = (2, 0.8, 500, 0.1)
    p2 = -(m * G * l / 2 * math.cos(p) + k * l * l * math.sin(p) * math.cos(p)) / (m * l * l / 3)

    def dV2(q):
        return -m * G * l / 2 * math.sin(q) + k * l * l * math.cos(2 * q)

    s0 = -m * G / (2 * k * l)
    q0 = math.asin(s0)
    return dict(p2=p2, NA=-m * l / 2 * math.sin(p) * p2, f=math.sqrt(dV2(q0) / (m * l * l / 3)))


def unbalanced_motor_on_springs():
    """Two equations of Newton and Euler (Sommerfeld 1902)."""
    M, m, e, k, J, T = (10, 0.4, 0.05, 4000, 0.01, 0.8)
    s, c = (math.sin(0.6), math.cos(0.6))
    A = [[M + m, -m * e * s], [-m * e * s, J + m * e * e]]
    a = np.linalg.solve(A, [m * e * c * 225 - k * 0.01 - 30 * 0.2, T - m * G * e * c])
    return dict(x2=a[0], p2=a[1], N=(M + m) * G + m * e * (c * a[1] - s * 225))


def rack_and_pinion_press():
    """(M + 3 m/8) s'' = F."""
    s2 = 30 / (5 + 0.75)
    return dict(s2=s2, t=2 * s2 / 2 - (30 - 5 * s2))


def spring_pendulum_in_a_lift():
    """Newton's equations by scipy."""

    def rates(t, s):
        d = np.array([s[0], s[1] - 0.2 * math.sin(6 * t)])
        r = np.hypot(*d)
        f = -60 * (r - 0.7) * d / r / 0.5
        return [s[2], s[3], f[0], f[1] - G]

    e = end_of(rates, [0.3, -0.8, 0, 0], 1.5)
    return {"x": e[0], "y": e[1]}


def crate_on_a_truck_that_brakes():
    """m (b^2 + h^2)/3 p'' = m (a h - g b)/2 (Meriam)."""
    m, b, h, a = (80, 0.4, 1.2, 5)
    J = m * (b * b + h * h) / 3
    p2 = (m * a * h / 2 - m * G * b / 2) / J
    return dict(p2=p2, Rx=m * (-a + p2 * h / 2), Ry=m * (G + p2 * b / 2))


def mixed_units_and_long_names():
    """t, kN/mm, N s/cm, mm: a, and sqrt(k/m - (d/2m)^2) of a damped motion."""
    m, k, d = (2000, 3000000.0, 4000)
    return dict(a=1000 * (-(k * 0.002 + d * 0.1) / m - G * 0.8), f=math.sqrt(k / m - (d / 2 / m) ** 2) / 2 / math.pi)


def springs_in_series_by_a_constraint():
    """k1 k2/(k1 + k2) by a constraint of coordinates."""
    return dict(f=math.sqrt(75 / 2), x2=-75 * 0.2 / 2)


def inverted_rod_on_a_spring():
    """(k - m g l)/J - (c/2J)^2."""
    J = 1 / 3
    return dict(f=math.sqrt((6 - G / 2) / J - (0.2 / 2 / J) ** 2))


def differential_screw():
    """Leads of 8 and 6 mm: the nut goes 2 mm a turn (Artobolevsky)."""
    k, k1 = (0.002 / (2 * math.pi), 0.008 / (2 * math.pi))
    I = 0.003 + 1 * k1**2 + 4 * k * k
    a2 = 2 / I
    return dict(v=5 * k, a2=a2)


def hooke_joint_steady():
    """tan q = cos al tan p, differences in 30 digits."""

    def q(p):
        return mp.atan2(mp.cos(mp.pi / 6) * mp.sin(p), mp.cos(p))

    p0 = mp.pi / 5
    w, e = (20 * mp.diff(q, p0), 400 * mp.diff(q, p0, 2))
    return dict(w2=float(w), e2=float(e), M=float(0.3 * e * w / 20))


def bifilar_pendulum():
    """sqrt(12 g/h) d/L (Beer & Johnston, ch. 19)."""
    return dict(f=math.sqrt(G * 0.16 / (1.5 / 12)), T=2 * G)


def atwood_on_a_wedge():
    """Momentum along the floor, and along the thread (Meshchersky, 48)."""
    ca, sa, cb, sb = (math.cos(math.pi / 6), 0.5, 0.5, math.sin(math.pi / 3))
    A = [[9, -(2 * ca + cb)], [-(2 * ca + cb), 3]]
    X2, s2 = np.linalg.solve(A, [0, G * (2 * sa - sb)])
    return dict(X2=X2, s2=s2, T=2 * (G * sa - s2 + X2 * ca))


def chaos_pendulum():
    """Kane's plate on a bar (PyDy's example): Lagrange by hand."""
    mA, mB, lB, w, h, lA = (0.01, 0.1, 0.1, 0.2, 0.1, 0.075)
    d = (lB - h / 2) / 2
    IA, Ix, Iy, Iz = (mA * lA**2 / 3, mB * h * h / 12, mB * (w * w + h * h) / 12, mB * w * w / 12)
    s, c, t, p = (math.sin(0.5), math.cos(0.5), 0.4, 2)
    J = IA + mA * d * d + mB * lB**2 + Ix * s * s + Iy * c * c
    th2 = (-(2 * (Ix - Iy) * s * c) * t * p - (mA * d + mB * lB) * G * math.sin(1.5)) / J
    return dict(th2=th2, ph2=(Ix - Iy) * s * c * t * t / Iz)


def man_who_walks_on_a_boat():
    """x = -m s/(M + m) (Meshchersky, 36)."""
    k = 80 / 280
    return dict(x2=-k * 0.5, F=80 * 0.5 * (1 - k), x=-k * 0.5 * (2 - 1 + math.exp(-2)))


def two_rods_on_ice():
    """Newton and Euler of both, eight equations (Routh)."""
    M = np.zeros((8, 8))
    r = np.zeros(8)
    M[0, [0, 6]] = (1, 1)
    M[1, [1, 7]] = (1, 1)
    r[1] = 6
    M[2, [2, 7]] = (1 / 12, 0.5)
    r[2] = -3
    M[3, [3, 6]] = (1, -1)
    M[4, [4, 7]] = (1, -1)
    M[5, [5, 6]] = (1 / 12, -0.5)
    M[6, [0, 3, 5]] = (1, -1, -0.5)
    M[7, [1, 2, 4]] = (1, 0.5, -1)
    s = np.linalg.solve(M, r)
    return dict(a2=s[2], b2=s[5], Ry=s[7])
