"""Motions, by numpy, mpmath and scipy alone: what systems_of_strangers.toml asks."""

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


def plank_on_two_rollers():
    """x'' = -mu g x/a on rollers that turn towards one another, N by moments (Timoshenko)."""
    m, a, mu, x = (3, 0.6, 0.2, 0.1)
    NB = m * G * (a + x) / (2 * a)
    NA = m * G - NB
    return dict(x2=(mu * NA - mu * NB) / m, NA=NA, NB=NB, M=mu * NB * 0.1)


def block_on_a_running_belt():
    """It sticks until k x = mu m g, then swings about there with the speed of the belt."""
    x1 = 0.3 * G / 25
    return dict(x_max=x1 + 0.5 / 5, x=x1 + 0.1 * math.sin(5 * (1.0 - x1 / 0.5)))


def locked_rear_wheels():
    """a = mu g a/(a + b + mu h) of a car that is braked behind (Meriam)."""
    m, a, b, h, mu = (1200, 1.2, 1.5, 0.55, 0.7)
    N = m * G * a / (a + b + mu * h)
    return dict(a=-mu * N / m, N_rear=N, stop=200 / (mu * N / m))


def yo_yo_from_a_rising_hand():
    """T r = J w', y'' = A - r w'."""
    m, r, J, A = (0.1, 0.006, 4e-05, 2)
    w = (A + G) / (r + J / (m * r))
    T = J * w / r
    return dict(y2=A - r * w, T=T, P=T)


def yo_yo_despin():
    """Cords with masses leave a hub: (J + 2 m R^2) psi'' = 2 m R l w^2, J psi'' = 2 T R (Fedor 1961)."""
    J, m, R, l, w = (10, 0.5, 0.5, 0.2, 5)
    w2 = 2 * m * l * R * w * w / (J + 2 * m * R * R)
    return dict(w2=w2, T1=J * w2 / (2 * R), T2=J * w2 / (2 * R))


def hartnell_governor():
    """Bell cranks, arms upright: (2 m a^2 + M b^2) al'' = 2 m w^2 r a - (S + M g) b."""
    m, a, b, r, w, k, M = (1.5, 0.12, 0.1, 0.14, 25, 3000, 4)
    al2 = (2 * m * w * w * r * a - (k * 0.05 + M * G) * b) / (2 * m * a * a + M * b * b)
    return dict(al2=al2)


def rate_gyro():
    """A th'' = (B - C) Om^2 s c + Ip (w + Om s) Om c - k th."""
    Om, ws, k, th = (0.5, 800, 0.6, 0.05)
    A, B, C = (1e-05 + 4e-05, 2e-05, 3e-05 + 4e-05)
    s, c = (math.sin(th), math.cos(th))
    Q = (B - C) * Om**2 * s * c + 8e-05 * (ws + Om * s) * Om * c - k * th
    return dict(th2=Q / A, M=0.0)


def bead_in_a_cone():
    """r'' = r p'^2 sin^2 al - g cos al, N = m (r p'^2 sin al cos al + g sin al) (Goldstein)."""
    a = math.radians(40)
    r, rd, w, m = (0.5, 0.3, 4, 0.7)
    N = m * (r * math.sin(a) * w * w * math.cos(a) + G * math.sin(a))
    return dict(r2=r * math.sin(a) ** 2 * w * w - G * math.cos(a), p2=-2 * rd * w / r, lam=N * math.cos(a), N=N)


def spring_in_a_turning_tube():
    """sqrt(k/m - Om^2) (Meirovitch)."""
    return dict(f=math.sqrt(90 / 0.4 - 36))


def string_with_five_beads():
    """2 sqrt(T/(m l)) sin(k pi/12) (Lagrange)."""
    return {f"f{k}": 2 * math.sqrt(50 / (0.02 * 0.1)) * math.sin(k * math.pi / 12) for k in range(1, 6)}


def three_storey_frame():
    """2 sqrt(k/m) sin((2 k - 1) pi/14): 0.4450, 1.2470, 1.8019 (Rao, Mechanical Vibrations, ch. 6)."""
    return {f"f{k}": 2 * math.sin((2 * k - 1) * math.pi / 14) for k in (1, 2, 3)}


def dumbbell_in_orbit():
    """V'' /2 m l^2 of two masses that a centre pulls, 40 digits; nearly sqrt(3) n."""
    L = mp.mpf("0.001")

    def V(a):
        return -1 / mp.sqrt(1 + L * L + 2 * L * mp.cos(a)) - 1 / mp.sqrt(1 + L * L - 2 * L * mp.cos(a))

    return dict(f=float(mp.sqrt(mp.diff(V, 0, 2) / (2 * L * L))), al2=float(-mp.diff(V, mp.mpf("0.1")) / (2 * L * L)))


def lagrange_point():
    """lam^4 + lam^2 + 27/4 mu (1 - mu) = 0 about L4."""
    d = math.sqrt(1 - 27 * 0.01 * 0.99)
    return dict(f1=math.sqrt((1 - d) / 2), f2=math.sqrt((1 + d) / 2), x2=0.0)


def figure_eight():
    """Three masses on one curve (Chenciner & Montgomery 2000), after one period by scipy."""
    x = (0.97000436, -0.24308753)
    v = (-0.93240737, -0.86473146)
    P = [x, (-x[0], -x[1]), (0, 0)]
    V = [(-v[0] / 2, -v[1] / 2)] * 2 + [v]

    def rates(_, s):
        q = s[:6].reshape(3, 2)
        a = np.zeros((3, 2))
        for i in range(3):
            for j in range(3):
                if i != j:
                    d = q[j] - q[i]
                    a[i] += d / np.hypot(*d) ** 3
        return np.concatenate([s[6:], a.ravel()])

    e = end_of(rates, np.concatenate([np.ravel(P), np.ravel(V)]), 6.32591398)
    return dict(x0=e[0], y0=e[1], x1=e[2], y2=e[5])


def watt_straight_line():
    """M p'' + M' p'^2/2 + V' = 0 with both circles in 40 digits."""
    mp.mp.dps = 40

    def pts(p):
        A = mp.mpc(-1 + mp.cos(p), mp.mpf("0.25") + mp.sin(p))
        O = mp.mpc(1, mp.mpf("-0.25"))
        d = O - A
        D = abs(d)
        r1, r2 = (mp.mpf("0.5"), 1)
        a = (r1 * r1 - r2 * r2 + D * D) / (2 * D)
        h = mp.sqrt(r1 * r1 - a * a)
        u = d / D
        return (A, [A + a * u + s * 1j * h * u for s in (1, -1)], O)

    p0 = mp.mpf("0.2")
    k = min((0, 1), key=lambda i: abs(mp.arg(pts(p0)[1][i] - pts(p0)[0]) - 1.3))

    def B(p):
        return pts(p)[1][k]

    def mid(p):
        return (pts(p)[0] + B(p)) / 2

    def b(p):
        return mp.arg(B(p) - pts(p)[0])

    def q(p):
        return mp.arg((B(p) - pts(p)[2]) * -1)

    def D(f):
        return mp.diff(f, p0)

    def M(p):
        def d(f):
            return mp.diff(f, p)

        return (
            mp.mpf("0.5") / 3 * (1 + d(q) ** 2)
            + mp.mpf("0.3") * (d(lambda s: mid(s).real) ** 2 + d(lambda s: mid(s).imag) ** 2)
            + mp.mpf("0.3") * mp.mpf("0.25") / 12 * d(b) ** 2
        )

    def V(p):
        return mp.mpf("9.81") * (
            mp.mpf("0.5") * (mp.sin(p) / 2 + (B(p) - pts(p)[2]).imag / 2) + mp.mpf("0.3") * mid(p).imag
        )

    p2 = -(D(V) + D(M) / 2 * mp.mpf("2.25")) / M(p0)
    return dict(x=float(mid(p0).real), y=float(mid(p0).imag), p2=float(p2))


def ravigneaux():
    """Willis' equations; powers and couples add up to 0."""
    c = -300 / 54
    s2 = c - 30 * (10 - c) / 36
    M = 5 * c / 10
    return dict(wc=c, ws=s2, M=M, R=5 - M)


def gear_pair_on_springs():
    """n sqrt(k/(J1 + n^2 J2))."""
    return dict(f=math.sqrt(300 * 0.16 / (0.2 + 0.16 * 1.5)))


def robot_of_two_driven_wheels():
    """m v' = M d w^2 + F1 + F2, I w' = -M d v w + b (F2 - F1), Jw p'' = T - r F (Siciliano, ch. 11)."""
    M, mw, r, b, d, Iz, Jw, Jd, T1, T2 = (12, 0.8, 0.1, 0.2, 0.07, 0.5, 0.004, 0.003, 1.2, 0.3)
    mt = M + 2 * mw
    I = Iz + M * d * d + 2 * (Jd + mw * b * b)
    w = 0.8
    v = 0.66
    A = np.array([[mt, 0, -1, -1], [0, I, b, -b], [0, 0, 0, 0], [0, 0, 0, 0]], float)
    A[2] = [Jw / r, -Jw * b / r, r, 0]
    A[3] = [Jw / r, Jw * b / r, 0, r]
    s = np.linalg.solve(A, [M * d * w * w, -M * d * v * w, T1, T2])
    return dict(a1=(s[0] - b * s[1]) / r, a2=(s[0] + b * s[1]) / r, v=0.66)


def suslov():
    """I w' + w x I w = lam e, w . e = 0 (Suslov 1902)."""
    I = np.array([[2, 0, -0.3], [0, 3, 0.5], [-0.3, 0.5, 4]], float)
    w = np.array([0.7, -0.4, 0])
    A = np.zeros((4, 4))
    A[:3, :3] = I
    A[2, 3] = -1
    A[3, 2] = 1
    s = np.linalg.solve(A, [*-np.cross(w, I @ w), 0])
    return dict(w1d=s[0], w2d=s[1])


def heisenberg():
    """z' = x y' - y x' (Bloch, Nonholonomic Mechanics and Control, 1.6)."""
    x, y, m = (0.5, -0.2, 2)
    J = np.array([y, -x, 1.0])
    F = np.array([1, 3, -2.0])
    lam = -(J @ F / m) / (J @ J / m)
    a = (F + lam * J) / m
    return dict(x2=a[0], y2=a[1], z2=a[2], lam=lam)


def knife_edge_on_a_turntable():
    """v' = Om^2 r . e along the edge."""
    return dict(a=0.64 * (0.5 * math.cos(0.3) + 0.1 * math.sin(0.3)), th2=0.0)


def hoop_with_a_heavy_spot():
    """2 R^2 (M + m (1 + cos p)) p'' = m R sin p (g + R p'^2); N, F of the whole (Littlewood's hoop)."""
    M, m, R, p, w = (1, 0.6, 0.4, 0.5, -3)
    c, s = (math.cos(p), math.sin(p))
    p2 = (m * G * R * s + m * R * R * s * w * w) / (2 * R * R * (M + m * (1 + c)))
    ay = -R * (s * p2 + c * w * w)
    ax = -R * p2 - R * (c * p2 - s * w * w)
    return dict(p2=p2, N=(M + m) * G + m * ay, F=-M * R * p2 + m * ax)


def weston_differential_hoist():
    """y' = (r - R) a'/2; T2 - T1 turns the lower pulley."""
    R, r, J, W, mp_, Jp, F = (0.12, 0.1, 0.03, 50, 4, 0.02, 40)
    rho = (R + r) / 2
    I = J + (W + mp_) * ((r - R) / 2) ** 2 + Jp
    a2 = (F * R - (W + mp_) * G * (r - R) / 2) / I
    y2 = (r - R) / 2 * a2
    S = (W + mp_) * (G + y2)
    Dd = Jp * a2 / rho
    return dict(a2=a2, y2=y2, T1=(S - Dd) / 2, T2=(S + Dd) / 2)


def pendulum_drawn_in():
    """l th'' = 2 v th' - g sin th, l = l0 - v t."""
    e = end_of(lambda t, s: [s[1], (0.6 * s[1] - G * math.sin(s[0])) / (1.5 - 0.3 * t)], [0.4, 0], 2.0)
    return {"th": e[0], "th'": e[1]}


def rod_slips_off_a_table_edge():
    """tan th = mu/(1 + 36 (c/L)^2) (Meriam); when, by quadrature."""
    L, c, mu = (1, 0.125, 0.4)
    th = math.atan(mu * L * L / (L * L + 36 * c * c))

    def rates(t, s):
        return [s[1], 12 * c * G * math.cos(s[0]) / (L * L + 12 * c * c)]

    def ev(t, s):
        return s[0] - th

    ev.terminal = True
    r = solve_ivp(rates, (0, 2), [0, 0], events=ev, method="DOP853", rtol=1e-12, atol=1e-14)
    return dict(t_slip=r.t[-1])
