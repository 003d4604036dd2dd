# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Bodies in space: a bicycle, a tumbling body, a gyrostat
#
# ## A bicycle that balances by itself
#
# Four rigid bodies, two wheels that roll without slip, and no formula for the contact points: the engine finds them.

# %%
from pathlib import Path

import eomgen

here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
bicycle = eomgen.load(here.parent / "models" / "whipple_bicycle.toml")
bicycle

# %%
small = eomgen.linearize(bicycle)
print(bicycle.about)
print(small.spectrum.stability, "at 5 m/s")

# %% [markdown]
# It rides straight on, and lean and steer are small: M q'' + C q' + K q = 0, exact, with the speed v as a symbol.

# %%
import sympy

s = {symbol.name: symbol for matrix in small.exact.values() for symbol in matrix.free_symbols}
v, g = s["v"], s["g"]
known = {name: each.value.text for name, each in bicycle.parameters.items() if name not in ("v", "g")}
M, C, K = (small.exact[letter].subs(known) for letter in "MCK")
C1, K0, K2 = C.diff(v), K.diff(g), K.diff(v).diff(v) / 2
K2.evalf(12)

# %% [markdown]
# The numbers of the benchmark: Meijaard, Papadopoulos, Ruina and Schwab, Proc. R. Soc. A 463 (2007), section 5(b).

# %%
import numpy as np

published = {
    "C1": [[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]],
    "K0": [[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]],
    "K2": [[0, 76.59734589573222], [0, 2.65431523794604]],
}
for name, matrix in (("C1", C1), ("K0", K0), ("K2", K2)):
    assert np.allclose(np.array(matrix, dtype=float), published[name], rtol=1e-12, atol=1e-12), name

# %% [markdown]
# How the eigenvalues move with the speed. Left of the green band the bicycle weaves more and more; right of it it falls
# slowly to one side; within it nobody need steer.

# %%
import matplotlib.pyplot as plt

matrices = sympy.lambdify(v, [M, C, K.subs(g, 9.81)])


def eigenvalues(speed):
    """s of det(s^2 M + s C + K) = 0"""
    m, c, k = matrices(speed)
    return np.linalg.eigvals(np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(m, np.hstack([k, c]))]]))


speeds = np.linspace(0.01, 10, 600)
found = np.array([np.sort_complex(eigenvalues(speed)) for speed in speeds])
growing = found.real.max(axis=1) > 0
weave, capsize = speeds[~growing][0], speeds[~growing][-1]
assert abs(weave - 4.292) < 0.02 and abs(capsize - 6.024) < 0.02

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
oscillates = abs(found.imag) > 1e-9
axes.plot(speeds, np.where(oscillates, np.nan, found.real), ".", color="tab:blue", markersize=2)
axes.plot(speeds, np.where(oscillates, found.real, np.nan), ".", color="tab:red", markersize=2)
axes.plot(speeds, np.where(found.imag > 1e-9, found.imag, np.nan), ".", color="tab:red", markersize=2, alpha=0.2)
axes.axvspan(weave, capsize, color="tab:green", alpha=0.15)
axes.axhline(0, color="grey", linewidth=0.8)
axes.text(1.6, 3.9, "weave", color="tab:red")
axes.text(4.5, 7.5, "its frequency", color="tab:red", alpha=0.4)
axes.text(7.6, 0.5, "capsize", color="tab:blue")
axes.text(3.4, -9.4, "castering", color="tab:blue")
axes.text(weave + 0.1, -4.5, "balances\nby itself", color="tab:green")
axes.set(xlabel="v [m/s]", ylabel="eigenvalue [1/s]", ylim=(-11, 11), xlim=(0, 10))
figure

# %% [markdown]
# The same bicycle, not linearized, is pushed to the side: below the weave speed, and above it.

# %%
figure, axes = plt.subplots(figsize=(7, 3), layout="constrained")
for speed in (3.8, 5.0):
    run = eomgen.simulate(bicycle, time=4, start={"phi'": 0.2}, parameters={"v": speed})
    assert run.drift < 1e-6 and run.gap < 1e-8
    axes.plot(run.t, np.degrees(run["phi"]), label=f"v = {speed} m/s")
axes.set(xlabel="t [s]", ylabel="lean [deg]")
axes.legend()
figure

# %%
run.animate(trail="front_wheel.center")

# %% [markdown]
# ## A tumbling body
#
# A free body turned about its middle axis turns over, again and again (Dzhanibekov's wing nut). Its orientation is a
# unit quaternion, its speeds are the angular velocity in its own axes, so that the equations are Euler's.

# %%
body = eomgen.load(here.parent / "models" / "tumbling_body.toml")
equations = eomgen.derive(body)
assert equations.certify().ok
equations

# %%
run = eomgen.simulate(body, time=20, samples=2001)
assert run.drift < 1e-8
run.animate()

# %%
figure = plt.figure(figsize=(8, 3.2))
axes = figure.add_axes([0.08, 0.15, 0.5, 0.74])
for name in ("w1", "w2", "w3"):
    axes.plot(run.t, run[name], label=name)
axes.set(xlabel="t [s]", ylabel="angular velocity [rad/s]")
axes.legend(loc="upper center", bbox_to_anchor=(0.5, 1.14), ncols=3, frameon=False)
momentum = np.array([run[name] * inertia for name, inertia in zip(("w1", "w2", "w3"), (3e-4, 2e-4, 1e-4), strict=True)])
sphere = figure.add_axes([0.62, 0.02, 0.36, 0.96], projection="3d")
sphere.plot(*momentum * 1e3, color="tab:red")
radius = np.linalg.norm(momentum[:, 0]) * 1e3
a, b = np.mgrid[0 : 2 * np.pi : 24j, 0 : np.pi : 13j]
sphere.plot_wireframe(
    radius * np.cos(a) * np.sin(b), radius * np.sin(a) * np.sin(b), radius * np.cos(b), color="grey", linewidth=0.3
)
sphere.set_box_aspect((1, 1, 1))
sphere.set_axis_off()
figure

# %% [markdown]
# The angular momentum runs along a curve on a sphere, in the body's axes. A quarter of the period is a complete
# elliptic integral; the engine finds the instant by integration.

# %%
from scipy.special import ellipk

A1, A2, A3, w0, eps = 3e-4, 2e-4, 1e-4, 6.0, 0.05
energy, square = A1 * eps**2 + A2 * w0**2, (A1 * eps) ** 2 + (A2 * w0) ** 2
if square < energy * A2:  # the curve encloses the axis of the least moment, else that of the greatest
    A1, A3 = A3, A1
k2 = (A2 - A3) * (A1 * energy - square) / ((A1 - A2) * (square - A3 * energy))
p = np.sqrt((A1 - A2) * (square - A3 * energy) / (A1 * A2 * A3))
quarter = eomgen.solve(body)["quarter"]
assert abs(quarter.value - ellipk(k2) / p) < 1e-6
quarter

# %% [markdown]
# ## A gyrostat
#
# A wheel in a satellite, kept turning about the same middle axis, can steady that spin.

# %%
satellite = """
eomgen = 1
name = "Satellite with a wheel"
space = "space"

[parameters]
A = { value = 3, unit = "kg*m^2", about = "principal moments, the wheel's included" }
B = { value = 4, unit = "kg*m^2" }
C = { value = 5, unit = "kg*m^2" }
J = { value = 0.02, unit = "kg*m^2", about = "of the wheel about its axis" }
Omega = { value = 1, unit = "rad/s", about = "of the satellite" }
sigma = { value = 80, unit = "rad/s", about = "of the wheel against the satellite" }

[coordinates]
e0 = 1
e1 = 0
e2 = 0
e3 = 0
alpha = { motion = "sigma*t", about = "angle of the wheel" }

[speeds]
w1 = { start = 0 }
w2 = { start = "Omega" }
w3 = { start = 0 }

[bodies.satellite]
mass = 40
inertia = ["A - J/2", "B - J", "C - J/2"]

[bodies.satellite.joint]
kind = "spherical"
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]

[bodies.wheel]
mass = 0
inertia = ["J/2", "J", "J/2"]
joint = { kind = "revolute", on = "satellite", axis = [0, 1, 0], angle = "alpha" }

[linearize]
about = "start"
"""
steady = eomgen.linearize(eomgen.loads(satellite))
steady

# %% [markdown]
# The stiffness says it: stable where `B*Omega - C*Omega + J*sigma > 0`, above 50 rad/s of the wheel.

# %%
verdict = {}
for wheel in (0, 49, 51, 80):
    slower = eomgen.loads(satellite.replace("value = 80", f"value = {wheel}"))
    verdict[wheel] = eomgen.linearize(slower).spectrum.stability
assert [word.partition(" ")[0] for word in verdict.values()] == ["unstable", "unstable", "stable", "stable"]
verdict

# %%
figure, axes = plt.subplots(figsize=(7, 3), layout="constrained")
for wheel in (0, 80):
    run = eomgen.simulate(eomgen.loads(satellite), time=60, start={"w1": 0.02}, parameters={"sigma": wheel})
    axes.plot(run.t, run["w2"], label=f"wheel at {wheel} rad/s")
axes.set(xlabel="t [s]", ylabel="w2 [rad/s]")
axes.legend()
figure
